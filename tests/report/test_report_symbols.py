"""Names with digits, bars and indices as they are set by hand, read from the printed pages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import pytest

from reportgen.formula import Symbol
from reportgen.formula.plain_text import formula
from reportgen.formula.vocabulary import in_language, numbered, runs
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Report
from tests.report.pages import Glyph

pytest.importorskip("pymupdf")

LOWER = 0.5
"""Points by which a digit set below the line lies lower at least; on one line baselines differ by 0.1."""


def with_digits(report: Report) -> set[tuple[str, str]]:
    """The points of the machine that have a number: (O, 1), (S, 2)."""
    names = report.written.case.analysis.motion.points
    return {pair for name in names for pair in numbered(name) if pair[1]}


def on_the_line(glyphs: Sequence[Glyph], names: set[tuple[str, str]]) -> Iterator[str]:
    """Names whose first digit stands beside the letter, as large as it and on its line."""
    firsts = {(letter, number[0]) for letter, number in names}
    for letter, digit in pairwise(glyphs):
        beside = letter.word == digit.word and (letter.char, digit.char) in firsts
        if beside and digit.size > 0.95 * letter.size and digit.origin[1] < letter.origin[1] + LOWER:
            yield letter.char + digit.char


def test_the_number_of_a_point_stands_below_the_line(report: Report) -> None:
    names = with_digits(report)
    assert {name: None for page in report.bodies for name in on_the_line(page, names)} == {}


def test_a_number_on_the_line_is_seen() -> None:
    line = [Glyph(char, (0, 0, 5, 8), 12, (0, 8), False, False, 1) for char in "O1A"]
    assert list(on_the_line(line, {("O", "1")})) == ["O1"]


@pytest.mark.parametrize(
    ("index", "pieces"),
    [
        ("O1A", [("O", "1"), ("A", "")]),
        ("S2", [("S", "2")]),
        ("Pqt5", [("P", "qt5")]),
        ("12", [("12", "")]),
        ("qt5", [("qt5", "")]),
        ("Bx", [("Bx", "")]),
        ("B3B", [("B", "3"), ("B", "")]),
    ],
)
def test_an_index_comes_apart_into_names_with_numbers(index: str, pieces: list[tuple[str, str]]) -> None:
    assert numbered(index) == pieces


def test_letters_come_apart_before_what_stands_below() -> None:
    assert runs("O₁A") == [("O", "1"), ("A", "")]


INDICES = {"cb": "bal", "qt": "in", "k": "c"}


@pytest.mark.parametrize(
    ("symbol", "shown"),
    [
        (Symbol("M", "cb"), "M_bal"),
        (Symbol("P", "qt5"), "P_in5"),
        (Symbol("h", "Pqt5", "′"), "h_Pin5^′"),
        (Symbol("a", "B3B", "k"), "a_B3B^c"),
        (Symbol("v", "BA"), "v_BA"),
    ],
)
def test_indices_are_those_of_the_language(symbol: Symbol, shown: str) -> None:
    assert formula(in_language(symbol, INDICES), "en") == shown


def words_of(symbols: Iterable[Symbol]) -> set[str]:
    """The words in the indices of symbols, in small letters."""
    return {word for symbol in symbols for word in re.findall("[a-zđ]+", f"{symbol.sub} {symbol.sup}")}


VIETNAMESE = {"cb", "qt", "tt", "đ"}


@pytest.mark.parametrize("path", matrix(built.ALL, built.TYPESET[:2]), ids=lambda path: path.stem)
def test_an_english_report_has_english_indices(path: Path) -> None:
    """In the ledger, of which report, key and sheet are made."""
    english = built.case(path, "en").ledger
    assert words_of(family.symbol for family in english.families.values() if not family.hidden) & VIETNAMESE == set()
