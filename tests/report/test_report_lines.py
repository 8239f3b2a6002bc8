"""Printed lines hold: recomputed from the text of the PDF, and every one of them in the tree."""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from reportgen.base.units import write
from reportgen.report import text_of
from tests.lanes import matrix
from tests.report import built, recompute
from tests.report.built import Report, Written
from tests.report.printed_lines import NUMBER, PrintedLine, printed_lines

pytest.importorskip("pymupdf")


def rounded(written: Written) -> frozenset[str]:
    """Texts (with decimal points) that stand for rounded numbers.

    A text that stands for an exact number elsewhere counts as exact, but not if it has all six figures.
    """
    numbers = list(recompute.numbers(written.document))
    exact, others = (
        {write(abs(number.value), number.decimals, "en") for number in numbers if (number.decimals is None) is given}
        for given in (True, False)
    )
    return frozenset(text for text in others if text not in exact or len(re.sub(r"\D", "", text).lstrip("0")) > 5)


def lines(report: Report) -> list[PrintedLine]:
    return list(printed_lines(report))


def test_lines_read_from_the_pdf_recompute(report: Report) -> None:
    found = lines(report)
    assert len({(line.substitution, line.result) for line in found}) >= 10
    numbers = rounded(report.written)
    off = {line: line.misfit(numbers) for line in found}
    assert {line: misfit for line, misfit in off.items() if misfit > 1} == {}


def test_both_writers_print_the_same_lines(pair: tuple[Report, Report]) -> None:
    """But for the few that one of them breaks, so that the reader above does not see them as one."""
    typst, latex = (Counter((line.substitution, line.result) for line in lines(report)) for report in pair)
    assert (typst & latex).total() >= 0.9 * max(typst.total(), latex.total())


def corrupted(text: str, at: int) -> str:
    """The text with another digit at a place, half the decade away so that rounding cannot explain it."""
    return f"{text[:at]}{(int(text[at]) + 5) % 10}{text[at + 1 :]}"


@pytest.mark.parametrize("path", matrix(built.TYPESET, built.TELLING), ids=lambda path: path.stem)
def test_one_corrupted_digit_is_caught(path: Path) -> None:
    """Every digit of the results, and the first digit of what is put in, of lines read from a PDF."""
    report = built.report(path, "typst", "vi")
    numbers = rounded(report.written)
    tried = 0
    for line in lines(report):
        digits = re.match(rf"-?{NUMBER}", line.result)
        assert digits is not None
        number = digits.group().lstrip("-")
        # The last unit of a whole number is what the figures put in leave open.
        end = digits.end() - number.isdecimal()
        for at in (at for at in range(end) if line.result[at].isdigit()):
            wrong = replace(line, result=corrupted(line.result, at))
            # The corrupted number is as rounded as the true one.
            known = numbers | {corrupted(number, at - digits.end() + len(number))} if number in numbers else numbers
            assert wrong.misfit(known) > 1, wrong
            tried += 1
    assert tried > 30


# --- in the tree ----------------------------------------------------------------------------------


def test_every_chain_of_the_tree_recomputes(written: Written) -> None:
    assert sum(len(list(recompute.steps(chain))) for chain in recompute.chains(written.document)) > 10
    assert recompute.off(written) == []


def test_numbers_are_printed_as_they_should(written: Written) -> None:
    """Finite, no negative zero, no more than six significant figures of a rounded value."""
    for number in recompute.numbers(written.document):
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
