"""The first view of the form: kinds as cards with their schemes, found by name or use, and their samples."""

from __future__ import annotations

import importlib.util
import re
import shutil
import threading
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.base.errors import OutputError
from reportgen.base.kinds import kinds
from reportgen.base.template_folders import languages
from reportgen.base.yaml_source import read_source
from reportgen.case import Case
from reportgen.cases import open_case
from reportgen.document import Document
from reportgen.page import html
from reportgen.page.kind_cards import REST, cards, samples_of, scheme_file
from reportgen.page.kind_chooser import Chooser
from reportgen.page.live_view import LiveSession
from tests.documents import ROOT
from tests.kinds import KINDS
from tests.lanes import matrix, proof
from tests.page.browser import Browser, axe
from tests.page.test_edit import editing, until

FOUND = """
const [text] = arguments, search = document.getElementById("search");
search.value = text;
search.dispatchEvent(new Event("input", { bubbles: true }));
const shown = (one) => one.offsetParent !== null;
return [
  [...document.querySelectorAll(".card > button")].filter(shown).map((one) => one.dataset.kind),
  document.querySelector("#found[role=status]").textContent,
  [...document.querySelectorAll("[data-sample]")].filter(shown).map((one) => one.dataset.sample),
];
"""
"""The kinds that are shown after this text was typed, what a screen reader says, the samples that are shown."""


def schemes() -> ModuleType:
    """Return the module `docs/schemes.py`, which draws the schemes."""
    spec = importlib.util.spec_from_file_location("schemes", ROOT / "docs" / "schemes.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("kind", matrix(sorted(KINDS), ["friction"]))
def test_the_scheme_of_a_kind_is_the_one_of_its_example(kind: str) -> None:
    """If not, run `python docs/schemes.py`."""
    assert scheme_file(kind).read_text(encoding="utf-8") == schemes().drawn(kind)


def test_every_kind_has_a_card_with_its_scheme_and_uses() -> None:
    shown = {language: cards(language) for language in languages()}
    groups = {(group, card.kind) for group, members in shown["en"].items() for card in members}
    assert {kind for _, kind in groups} == kinds().keys()
    for language, offered in shown.items():
        assert {(group, card.kind) for group, members in offered.items() for card in members} == groups, language
        assert REST not in offered
        for card in (card for members in offered.values() for card in members):
            assert card.uses, (language, card.kind)
            assert card.scheme is not None, card.kind
            assert card.samples, card.kind


def test_a_page_is_made_without_opening_an_example(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(catalogue, "load", None)
    page = Chooser(lambda: open_case(Path()), "vi").page()
    assert page.count('<span class="scheme"><svg') == len(kinds())


def test_the_page_of_kinds_has_no_buttons_of_a_form() -> None:
    """Its styles do not hide closed notices, and its scripts do not open them."""
    page = Chooser(lambda: open_case(Path()), "vi").page()
    assert re.findall(r"<button(?![^>]*data-(?:kind|sample))[^>]*>", page) == []


@proof
def test_every_sample_offered_is_right_by_itself(tmp_path: Path) -> None:
    """A copy in a folder without other files has no errors."""
    for kind, samples in samples_of().items():
        for sample in samples:
            file = tmp_path / f"{kind.replace('/', '-')}-{sample.name}.yaml"
            shutil.copy(catalogue.examples(kind)[sample.name], file)
            assert sample.remark, sample
            assert catalogue.understood(read_source(file), file)[1] == [], sample


def test_a_file_that_cannot_be_written_is_reported_and_another_may_be_chosen(tmp_path: Path) -> None:
    begun: list[tuple[str, str]] = []

    def begins(kind: str, sample: str) -> Path:
        begun.append((kind, sample))
        if len(begun) == 1:
            raise OutputError("shaper.yaml: the disk is full")
        return tmp_path / f"{kind}.yaml"

    chooser = Chooser(lambda: open_case(tmp_path), "en", begins=begins)
    chooser.ready.set()
    with pytest.raises(KeyError):
        chooser.begin({"kind": "shaper", "sample": "../shaper-01"})
    refused = chooser.begin({"kind": "shaper", "sample": "shaper-01"})
    assert refused["refused"] == "The file could not be created: shaper.yaml: the disk is full"
    assert chooser.begin({"kind": "shaper", "sample": "shaper-02"}) == {"begun": True}
    assert begun == [("shaper", "shaper-01"), ("shaper", "shaper-02")]


@proof
def test_a_kind_is_found_and_its_sample_becomes_the_file(browser: Browser, tmp_path: Path) -> None:
    """By a phone, in Vietnamese without accents, in English, by the id, by what it is used for."""
    with editing("--lang", "vi", folder=tmp_path) as address:
        browser.show(address, width=390, height=844, dark=True, still=True)
        assert browser.run("return document.documentElement.scrollWidth") == 390
        assert browser.violations(axe()) == []
        for text, kind in {
            "banh rang": "planetary-train",
            "Tay  QUAY trượt": "slider-crank",
            "crank slider": "slider-crank",
            "toggle-pr": "toggle-press",
            "may nen khi": "slider-crank",
            "windscreen": "four-bar",
        }.items():
            found, said, _ = browser.run(FOUND, text)
            assert kind in found, text
            assert said == f"Tìm thấy: {len(found)}"
            assert len(found) < len(kinds()) / 2
        assert browser.run(FOUND, "ram wide")[2] == ["shaper-03"]
        assert browser.run(FOUND, "xyz")[:2] == [
            [],
            "Không tìm thấy. Hãy thử tên khác, chẳng hạn “tay quay” hoặc “bánh răng”.",
        ]
        assert len(browser.run(FOUND, "")[0]) == len(kinds())
        browser.run("document.querySelector('[data-sample=toggle-press-02]').click()")
        until(lambda: browser.run("return document.getElementById('saved') !== null"))
        assert browser.messages() == []
    written = (tmp_path / "toggle-press.yaml").read_text(encoding="utf-8")
    assert written == catalogue.example(catalogue.examples("toggle-press")["toggle-press-02"], "vi")


def test_a_report_waits_for_a_page_that_is_being_made(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the report, which takes longer, the first view would come twice as late."""
    begun, together = threading.Event(), []
    case = open_case(ROOT / "assignments" / "four-bar-01.yaml")
    document, write = type(case).document, html.write

    def document_noted(self: Case) -> Document:
        begun.set()
        return document(self)

    monkeypatch.setattr(type(case), "document", document_noted)

    def write_slowly(*arguments: Any) -> str:
        together.append(begun.wait(1.0))
        return write(*arguments)

    monkeypatch.setattr(html, "write", write_slowly)
    session = LiveSession(lambda: case)
    page = threading.Thread(target=session.page)
    page.start()
    session.open()
    page.join()
    assert together == [False]
    until(lambda: session.revision.reports == 1)
    session.close()
