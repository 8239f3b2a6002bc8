"""Printed lines hold: recomputed from the text of the PDF, and every one of them in the tree."""

from __future__ import annotations

import math
import re
from collections import Counter
from pathlib import Path

import pytest

from reportgen.base.units import write
from reportgen.document import text_of
from tests.lanes import matrix
from tests.report import built, trees
from tests.report.built import Report, Written
from tests.report.calculator import Line, misses
from tests.report.printed_lines import printed_lines

pytest.importorskip("pymupdf")


def lines(report: Report) -> list[Line]:
    return list(printed_lines(report))


def test_lines_read_from_the_pdf_recompute(report: Report) -> None:
    found = lines(report)
    assert len({(line.substitution, line.result) for line in found}) >= 10
    assert misses(found) == []


def test_both_writers_print_the_same_lines(pair: tuple[Report, Report]) -> None:
    """But for the few that one of them breaks, so that the reader above does not see them as one."""
    typst, latex = (Counter((line.substitution, line.result) for line in lines(report)) for report in pair)
    assert (typst & latex).total() >= 0.9 * max(typst.total(), latex.total())


@pytest.mark.parametrize("path", matrix(built.TYPESET, built.TELLING), ids=lambda path: path.stem)
def test_one_corrupted_digit_is_caught(path: Path) -> None:
    """Every digit of the results of lines read from a PDF."""
    wrong = [wrong for line in lines(built.report(path, "typst", "vi")) for wrong in line.corrupted]
    assert [line for line in wrong if line.holds] == []
    assert len(wrong) > 30


# --- in the tree ----------------------------------------------------------------------------------


def test_every_chain_of_the_tree_recomputes(written: Written) -> None:
    found = trees.lines(trees.chains(written.document), written.language)
    assert len(found) > 10
    assert misses(found) == []


def test_numbers_are_printed_as_they_should(written: Written) -> None:
    """Finite, no negative zero, no more than six significant figures of a rounded value."""
    for number in trees.numbers(written.document):
        assert math.isfinite(number.value)
        text = write(number.value, number.decimals, written.language)
        digits = re.sub(r"\D", "", text).lstrip("0")
        assert digits or not text.startswith("−")
        assert number.decimals is None or len(digits) <= 6, text


def test_the_decimal_mark_is_that_of_the_language(written: Written) -> None:
    """A point between figures may only be that of a number of section, figure, table or equation."""
    text = text_of(written.document)
    if written.language == "vi":
        text = re.sub(r"(?m)^\d+(\.\d+)+ ", "", text)
        text = re.sub(
            r"(?i)(hình|bảng|mục|phần) (\d+\.\d+(\.\d+)?(, |, hình |, bảng | và |–)?)+|\(\d+\.\d+\)", "", text
        )
        assert re.findall(r".*\d\.\d.*", text) == []
    else:
        assert re.findall(r".*\d,\d.*", re.sub(r"\(\d,\d\)", "", text)) == []
