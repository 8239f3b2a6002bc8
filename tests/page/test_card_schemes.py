"""Schemes on the cards of machines of the user's folder: drawn once, when their cards are shown, and without text."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen.api.serving import _drawn_scheme
from reportgen.base.template_folders import ATLAS_VARIABLE
from reportgen.cases import starter_case
from reportgen.page.kind_cards import CardDrawing, cards, scheme
from reportgen.page.kind_chooser import Chooser
from reportgen.page.scheme_drawings import machine_scheme
from tests.lanes import proof
from tests.page.browser import Browser, axe
from tests.page.test_edit import editing, until
from tests.page.test_first_view import schemes

SLIDER_CRANK = """
words:
  en:
    title: Pump <script>alert(1)</script>
    description: Crank 1 drives the piston 3.
    parameters: {r: crank, l: rod}
parameters:
  r: {default: 50 mm, least: 20 mm, most: 90 mm}
  l: {default: 200 mm}
linkage:
  frame: {A: [0 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: r, n: 60 rpm}
  groups:
    - {type: RRP, links: [2, 3], joints: [B, C], length: l, guide: {at: [0 mm, 0 mm]}, end: far}
"""
STROKES = """
const place = document.querySelector(`[data-kind="${arguments[0]}"] .scheme`);
place.scrollIntoView();
return place.querySelectorAll("svg path").length;
"""
"""The number of the strokes of a kind's drawing, which is scrolled into view."""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a machine, with a faulty one, and with one that replaces a machine of the program."""
    made = tmp_path / "machines"
    made.mkdir()
    (made / "pump.yaml").write_text(SLIDER_CRANK, "utf-8")
    (made / "faulty.yaml").write_text(SLIDER_CRANK.replace("length: l", "length: l/(r - r)"), "utf-8")
    (made / "wiper.yaml").write_text(SLIDER_CRANK, "utf-8")
    monkeypatch.setenv(ATLAS_VARIABLE, str(made))
    return made


def test_a_machine_of_a_folder_is_drawn_once_and_only_when_it_is_asked_for(folder: Path) -> None:
    drawn: list[str] = []

    def draws(kind: str) -> CardDrawing:
        drawn.append(kind)
        return _drawn_scheme(kind)

    chooser = Chooser(lambda: starter_case("shaper"), "en", draws=draws)
    page = chooser.page()
    assert drawn == []
    assert page.count('<span class="scheme"></span>') == 2
    assert "<script>alert" not in page
    kinds = {card.kind: card for members in cards("en").values() for card in members}
    assert "atlas/faulty" not in kinds
    assert kinds["atlas/wiper"].samples == (), "samples of the program need not fit another machine"
    first = chooser.scheme({"kind": "atlas/pump"})
    assert chooser.scheme({"kind": "atlas/pump"}) == first
    assert drawn == ["atlas/pump"]
    assert re.fullmatch(r"0 0 [\d.]+ [\d.]+", first["box"])
    assert not re.search(r"<(?!/?(path|circle|line|g)\b)", first["elements"]), "neither texts nor scripts"
    for kind in ("atlas/jaw-crusher", "shaper", "../pump", "atlas/none"):
        with pytest.raises(KeyError):
            chooser.scheme({"kind": kind})
    assert chooser.scheme({"kind": "atlas/faulty"}) == {}


def test_the_scheme_of_a_folder_is_that_of_its_report(folder: Path) -> None:
    """The figure of the report is made by the templates; the card's is drawn without them."""
    assert machine_scheme(starter_case("atlas/pump")) == schemes().scheme_in(starter_case("atlas/pump").document())
    assert scheme("atlas/wiper") is None, "the program's drawing shows another machine"


@proof
def test_a_browser_shows_the_scheme_of_a_machine_of_a_folder(browser: Browser, folder: Path, tmp_path: Path) -> None:
    with editing("--lang", "en", "--atlas", folder, folder=tmp_path) as address:
        browser.show(address, width=1000, height=700, still=True)
        until(lambda: browser.run(STROKES, "atlas/pump") > 2)
        assert browser.violations(axe()) == []
        assert browser.messages() == []
