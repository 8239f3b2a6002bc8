"""Cells pasted from a workbook: what commas and points mean is read from all of them, or asked once."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.page.edit_session import EditSession
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.typist import Typist, form_alone, until, value

READ = """
const read = pasting.read(arguments[0]);
return [read.cells, read.doubt && Object.values(read.doubt.means).map(({ shown }) => shown)];
"""
PASTE = """
const clipboardData = new DataTransfer();
clipboardData.setData("text", arguments[1]);
document.querySelector(arguments[0]).dispatchEvent(
  new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
"""
CELL = '.tabled [data-row="1"][data-column="1"]'
QUESTION = "return [...document.querySelectorAll('[data-reading]')].map((one) => one.textContent)"
ANSWER = "document.querySelector(`[data-reading='${arguments[0]}']`).click()"


def paste_over(browser: Browser, name: str, cells: str) -> None:
    """Paste into the field of a list with an id, in the place of all that it has."""
    browser.run("const list = document.getElementById(arguments[0]); list.focus(); list.select()", name)
    browser.run(PASTE, f"[id='{name}']", cells)


def written(file: Path, where: tuple[str, ...], text: str) -> bool:
    return value(file, where) == text


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (made := tmp_path / "twin.yaml").write_text(catalogue.sample("engine-twin", "en"), encoding="utf-8")
    return made


@proof
def test_what_pasted_numbers_mean(browser: Browser, file: Path) -> None:
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        for text, cells, doubt in (
            ("-2,4\t24\r\n", [["-2.4", "24"]], None),
            ("1,200\n0,5", [["1.2"], ["0.5"]], None),
            ("0,125\n0,25", [["0.125"], ["0.25"]], None),
            ("1.234,5\t1.234.567", [["1234.5", "1234567"]], None),
            ("1.200\n0.5", [["1.200"], ["0.5"]], None),
            ("90 deg\t0,5 mm\tA,B", [["90 deg", "0.5 mm", "A,B"]], None),
            (
                "\u22122,4\t1\u00a0234,5\n\u22121\u202f234\u2009567 mm\t5",
                [["-2.4", "1234.5"], ["-1234567 mm", "5"]],
                None,
            ),
            ("\u22122,4", [["-2.4"]], ["-2.4", "-2, 4"]),
            ("1 234,5\n2", None, ["1234,5", "1, 234,5"]),
            ("0,5\t1.200", None, ["1200", "1.2"]),
            ("1,200\n2", None, ["1.2", "1200"]),
        ):
            read = browser.run(READ, text)
            assert read[1] == doubt, text
            assert cells is None or read[0] == cells, text


@proof
def test_pasted_numbers_of_two_readings_are_asked_about_once(browser: Browser, file: Path) -> None:
    """Nothing is written before the answer; one step back takes all that was pasted."""
    begun = file.read_text(encoding="utf-8")
    where = "indicator", "intake"
    with form_alone(file, lambda: 0.1) as server:
        browser.show(server.address, still=True)
        browser.run(PASTE, CELL, "-2,4\t1.200\n-2,5\t1.300\n")
        until(lambda: browser.run(QUESTION) == ["Use 1.200 = 1200", "Use 1.200 = 1.2"])
        assert file.read_text(encoding="utf-8") == begun
        browser.run(ANSWER, ",")
        Typist(browser).idle()
        assert value(file, where).split(", ")[1] == "-2.4"
        assert value(file, ("indicator", "compression")).split(", ")[1:3] == ["1200", "1300"]
        assert browser.run(QUESTION) == []
        browser.run("document.getElementById('undo').click()")
        until(lambda: file.read_text(encoding="utf-8") == begun)


@proof
def test_pasted_cells_are_written_all_or_none(browser: Browser, file: Path) -> None:
    """What was refused is tried again as one change when the file has changed."""
    with form_alone(file) as server:
        session, asked = server.session, []
        assert isinstance(session, EditSession)
        edit = session.edit

        def later(body: Any) -> Any:
            asked.append(body)
            return edit(body) if len(asked) > 1 else {**session.numbered_form(), "refused": "not now"}

        session.edit = later  # type: ignore[method-assign, assignment]
        browser.show(server.address, still=True)
        browser.run(PASTE, CELL, "-2.4\t24\n-2.5\t25\n")
        until(lambda: browser.run("return document.getElementById('refused').textContent") == "not now")
        file.write_text("# more\n" + file.read_text(encoding="utf-8"), encoding="utf-8")
        Typist(browser).idle()
        assert [(body["op"], len(body["changes"])) for body in asked] == [("set all", 2)] * 2
        assert value(file, ("indicator", "intake")).split(", ")[1:3] == ["-2.4", "-2.5"]
        assert value(file, ("indicator", "compression")).split(", ")[1:3] == ["24", "25"]


@proof
def test_a_column_is_pasted_into_the_field_of_a_list(browser: Browser, file: Path) -> None:
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        paste_over(browser, "f:indicator.s", "0\n0,5\n1\n")
        Typist(browser).idle()
        assert value(file, ("indicator", "s")) == "0, 0.5, 1"


@proof
def test_signs_and_blanks_of_a_workbook_divide_no_number(browser: Browser, file: Path) -> None:
    """What may be one number or two, of which there is no other sign, is asked about."""
    where = "indicator", "intake"
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        for cells, asked, reading, expected in (
            ("\u22122,4\n1\u00a0234,5\n", [], "", "-2.4, 1234.5"),
            ("\u22122,5", ["Use -2,5 = -2.5", "Use -2,5 = -2, 5"], ",", "-2.5"),
            ("1,5", ["Use 1,5 = 1.5", "Use 1,5 = 1, 5"], "two", "1, 5"),
            ("1 234\n0,5\n", ["Use 1 234 = 1234", "Use 1 234 = 1, 234"], "one", "1234, 0.5"),
            ("1\u202f234,25", [], "", "1234.25"),
        ):
            paste_over(browser, "f:indicator.intake", cells)
            assert browser.run(QUESTION) == asked
            if asked:
                browser.run(ANSWER, reading)
            until(partial(written, file, where, expected))
            typist.idle()


@proof
def test_what_is_typed_after_pasting_is_undone_by_itself(browser: Browser, file: Path) -> None:
    where = "indicator", "s"
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        paste_over(browser, "f:indicator.s", "0\n0,5\n1\n")
        typist.idle()
        typist.type(", 2")
        typist.press("Enter")
        typist.idle()
        assert value(file, where) == "0, 0.5, 1, 2"
        browser.run("document.getElementById('undo').click()")
        typist.idle()
        assert value(file, where) == "0, 0.5, 1"


@proof
def test_pasted_cells_take_the_place_of_what_was_begun(browser: Browser, file: Path) -> None:
    """What is typed after them is undone by itself."""
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        browser.run("document.querySelector('.tabled').open = true; document.querySelector(arguments[0]).focus()", CELL)
        typist = Typist(browser)
        typist.type("7")
        assert browser.run("return drafts.places().length") == 1
        browser.run(PASTE, CELL, "-2.4\t24\n-2.3\t25\n")
        typist.idle()
        assert value(file, ("indicator", "intake")).split(", ")[1:3] == ["-2.4", "-2.3"]
        assert browser.run("return document.querySelector('.conflict') === null")
        pasted = file.read_bytes()
        typist.press("End")
        typist.type("1")
        typist.press("Tab")
        typist.idle()
        assert value(file, ("indicator", "intake")).split(", ")[1] == "-2.41"
        browser.run("document.getElementById('undo').click()")
        until(lambda: file.read_bytes() == pasted)
