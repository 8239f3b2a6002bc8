"""Exercises of plane motion end to end: every file in both languages with both engines, and what their pages say."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import pymupdf
import pytest

from reportgen import api
from reportgen.base.units import write
from reportgen.cases import open_case
from reportgen.document import Document, Equation, Paragraph, Section, plain, text_of
from reportgen.exercise.case import ExerciseCase
from reportgen.exercise.solution_page import solution
from reportgen.exercise.views import lettered
from reportgen.formula import Chain, Number
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from reportgen.results.terminal_tables import print_tables
from tests.lanes import matrix
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
FILES = sorted(FOLDER.glob("*.yaml"))
WITH_SYMBOLS = [path for path in FILES if "symbols:" in path.read_text("utf-8")]
LANGUAGES: tuple[Any, ...] = ("vi", "en")
MOST_PAGES = 5


@cache
def document(path: Path, language: Any) -> Document:
    return solution(ExerciseCase(api.load(path, language)))


@pytest.mark.parametrize("engine", matrix(built.ENGINE_CASES, ["typst"]))
@pytest.mark.parametrize("path", matrix(FILES, FILES[3::4]), ids=lambda path: path.stem)
def test_every_exercise_builds(path: Path, engine: Any) -> None:
    """A few pages, with the answers on them as the ledger prints them.

    Each engine has every file, and each language half of them: what is said in it is a matter of the tree.
    """
    language = LANGUAGES[(FILES.index(path) + built.ENGINES.index(engine)) % 2]
    pages = pymupdf.open(stream=api.typeset(document(path, language), engine)[1])
    assert 1 <= len(pages) <= MOST_PAGES
    text = "".join(page.get_text() for page in pages)
    case = ExerciseCase(api.load(path, language))
    put_in = all(one.put_in for one in case.exercise.given.symbols.values())
    for asked in case.exercise.asked:
        if asked.what != "centre" and put_in:
            number = case.printed.number(asked.id)
            assert write(number.value, number.decimals, language) in text


def test_the_paper_begins_with_its_title() -> None:
    """As that of every other kind; whose it is stands below."""
    case = open_case(FOLDER / "05.yaml", "en")
    title, below, *_ = task_of(case, key_of(case)).blocks
    assert isinstance(title, Section)
    assert isinstance(below, Paragraph)
    assert plain(below.inlines, "en").startswith("Assignment: 05")


def test_no_figure_stands_above_the_title() -> None:
    """Where the heading of the solution goes to the next page with what follows it, its figure stays below the data."""
    pages = pymupdf.open(stream=api.typeset(document(FOLDER / "19.yaml", "en"), "typst")[1])
    first = pages[0].get_text(sort=True)
    assert first.index("Exercise of plane motion") < first.index("Table 1") < first.index("Figure 1")
    assert "Solution" in pages[1].get_text()


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("path", matrix(FILES, FILES[3::4]), ids=lambda path: path.stem)
def test_no_gap_is_left_in_the_words(path: Path, language: Any) -> None:
    text = text_of(document(path, language))
    assert re.search(r"\{|\}|\[[a-z]+\.|None", text) is None
    # What has no sense or direction has a dash of its own, in the answers alone.
    assert " –." not in text
    assert re.search(r"[^\d] [.,;]( |$)", text, re.MULTILINE) is None


@pytest.mark.parametrize("path", matrix(WITH_SYMBOLS, WITH_SYMBOLS[::3]), ids=lambda p: p.stem)
def test_a_literal_answer_is_an_expression(path: Path) -> None:
    """The answer says what was asked, by the symbols; numbers stand behind it only if put in, and else below."""
    case = ExerciseCase(api.load(path, "en"))
    assert case.literal is not None
    lines = [block.rows for block in document(path, "en").blocks if isinstance(block, Equation)]
    (rows,) = [
        rows for rows in lines if not all(isinstance(row, Chain) and isinstance(row.parts[-1], Number) for row in rows)
    ][-1:]
    asked = [one.id for one in case.exercise.asked if one.what != "centre"]
    assert len(rows) == len(asked)
    for row, id in zip(rows, asked, strict=True):
        assert isinstance(row, Chain)
        expected = case.literal[id]
        assert expected is not None
        assert row.parts == (case.ledger.symbol(id), lettered(expected))


def test_drawn_values_stay_out_of_the_solution() -> None:
    """In exercise 6 no number with a unit stands between the data and what the answer sheet asks."""
    text = text_of(document(FOLDER / "06.yaml", "en"))
    solution, _, numbers = text.partition("Solution")[2].partition("With l = 200 mm")
    assert "rad/s" not in solution
    assert "m/s" not in solution
    assert "0.6 m/s" in numbers


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_both_languages_write_the_same_steps(path: Path) -> None:
    vi, en = ([type(block).__name__ for block in document(path, language).blocks] for language in LANGUAGES)
    assert vi == en


def test_what_a_cover_would_say_stands_on_the_first_page(tmp_path: Path) -> None:
    told = "report: {language: en, university: Polytechnic, "
    told += "supervisor: R. Franke, date: 2026-11-22, student: {name: An}}\n"
    path = tmp_path / "file.yaml"
    path.write_text(told + (FOLDER / "18.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    text = text_of(document(path, "en"))
    assert all(word in text for word in ("An", "Polytechnic", "R. Franke", "22.11.2026"))


def test_results_are_tables_too(capsys: pytest.CaptureFixture[str]) -> None:
    """Without a crank's angle; where no velocity is known there is no table of them."""
    print_tables(api.solve(api.load(FOLDER / "17.yaml", "en")), "en")
    shown = capsys.readouterr().out
    assert "0.1075" in shown
    assert "φ" not in shown
    print_tables(api.solve(api.load(FOLDER / "19.yaml", "en")), "en")
    shown = capsys.readouterr().out
    assert "Accelerations" in shown
    assert "Velocities" not in shown
