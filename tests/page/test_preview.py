"""The preview of a PDF: its pages after each build, the first one that has changed at once."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pymupdf
import pytest

from reportgen import catalogue
from reportgen.api.typesetting import pages_of, typeset
from reportgen.base.progress import SOURCE
from reportgen.cases import open_case, opener
from reportgen.cli.student import _products
from reportgen.document import Section
from reportgen.page.background_builds import Maker
from reportgen.page.edit_session import EditSession
from reportgen.page.file_watch import edited
from reportgen.page.html import CONTENTS_LEVEL
from reportgen.page.preview_pages import Preview, first_changed
from tests.lanes import proof
from tests.page.browser import Browser, axe
from tests.page.typist import until

LEAVE = "from reportgen.base.progress import leave_source; import sys; leave_source(open(sys.argv[1]).read())"
SHOWN = "return document.querySelector('#preview img').naturalWidth > 0 && !document.getElementById('preview').hidden"
PAGE = "return document.querySelector('#preview [role=status]').textContent"


def built(preview: Preview, heard: list[Any], file: Path) -> Any:
    """What is told of the pages after a process has left its source."""
    maker = Maker({"pdf": (sys.executable, "-c", LEAVE, str(file))}, preview.hear, preview.source)
    heard.clear()
    assert maker.make("pdf")
    until(lambda: heard and "preview" in heard[-1])
    assert [message["state"] for message in heard] == ["running", "done", "done"], "the PDF is not waited for"
    return heard[-1]["preview"]


def test_the_first_changed_page_is_found_after_each_build(tmp_path: Path) -> None:
    heard: list[Any] = []
    preview = Preview(lambda source: ([page.encode() for page in source.split("|")], [1]), heard.append)
    file = tmp_path / "source"
    for build, (text, changed) in enumerate([("a|b|c", 1), ("a|x|y", 2), ("a|x|y", 0), ("a|x", 2)], start=1):
        file.write_text(text, encoding="utf-8")
        pages = text.split("|")
        assert built(preview, heard, file) == {"build": build, "pages": len(pages), "changed": changed, "headings": [1]}
        assert [preview.page(f"page-{build}-{number}.svg") for number in range(len(pages) + 2)] == [
            *(None, *(page.encode() for page in pages), None)
        ]
        assert preview.page(f"page-{build - 1}-1.svg") is None
    preview.close()
    assert not preview.source.parent.exists()
    assert first_changed("abc", "abcd") == 4


def test_pages_of_an_older_file_are_not_told(tmp_path: Path) -> None:
    """The file is read again while they are drawn."""

    def opens() -> Any:
        raise OSError

    def pages(source: str) -> tuple[list[bytes], list[int]]:
        if source == "late":
            session.renew()
        return [source.encode()], [1]

    session = EditSession(opens, "en", path=tmp_path / "a.yaml", pages=pages)
    for number, text in enumerate(("in time", "late"), start=1):
        session.preview.source.write_text(text, encoding="utf-8")
        session.preview.hear({"product": "pdf", "state": "done"})
        until(lambda: not session.preview.source.exists() and not session.preview.drawing.locked())
        assert ("preview" in session.revision.making) == (number == 1)
    assert session.revision.making == {}
    assert session.made("page-1-1.svg") == b"in time", "the pages that are shown can still be turned"
    session.close()


def test_the_pages_are_those_of_the_pdf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The process that makes a PDF leaves its source, from which the same pages are drawn."""
    monkeypatch.setenv(SOURCE, str(tmp_path / "left.typ"))
    file = tmp_path / "rotor.yaml"
    file.write_text(catalogue.sample("rotor", "en"), encoding="utf-8")
    document = open_case(file).document()
    source, pdf = typeset(document, "typst")
    left = (tmp_path / "left.typ").read_text(encoding="utf-8")
    assert left == source
    drawn, headings = pages_of(left)
    assert all(page.startswith(b"<svg") for page in drawn)
    with pymupdf.open(stream=pdf) as pages:
        assert len(drawn) == pages.page_count
        titles = [block for block in document.blocks if isinstance(block, Section) and block.level <= CONTENTS_LEVEL]
        assert len(headings) == len(titles)
        for page, title in zip(headings, titles, strict=True):
            assert title.number in pages[page - 1].get_text()


@proof
def test_a_changed_page_is_shown_beside_the_form(browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "rotor.yaml"
    file.write_text(catalogue.sample("rotor", "en"), encoding="utf-8")
    with edited(file, opener(), "en", lambda path: _products(path, tmp_path / "out", "en"), pages=pages_of) as server:
        browser.show(server.address, still=True)
        make = "document.querySelector('[data-make=pdf]').click()"
        browser.run(make)
        until(lambda: browser.run(SHOWN))
        assert browser.run(PAGE).startswith("Page 1 of ")
        browser.run("document.querySelector('#preview [data-turn=\"1\"]').click()")
        assert browser.run(PAGE).startswith("Page 2 of ")
        assert browser.violations(axe(), "#preview") == []
        browser.run("document.querySelector('#preview [data-close]').click()")
        assert browser.run("return 'preview' in document.activeElement.dataset")
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace("variant: 1", "variant: 27"), encoding="utf-8")
        browser.run(make)
        until(lambda: browser.run(SHOWN) and "first changed page" in browser.run(PAGE))
        assert browser.messages() == []
