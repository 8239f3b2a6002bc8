"""Sheets on a group of class III: right ones score full, a careful drawing too, and its own mistakes are named."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from reportgen import api
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Verdict
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.mistakes import general_mistakes
from tests.marking import students

FILE = Path(__file__).parents[1] / "broken" / "files" / "linkage-triad.yaml"
MASSES = """
  points:
    S3: {link: 3, at: [53 mm, 47 mm]}
  masses:
    - {link: 3, at: S3, m: 4 kg, J: 0.012 kg m2}
  loads:
    - {by: constant, link: 4, M: 60 N m, against: motion}
"""


@cache
def scheme() -> MarkingScheme:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "triad.yaml"
        text = FILE.read_text(encoding="utf-8").replace(
            "kind: linkage", "kind: linkage\nreport: {worked_positions: [2]}"
        )
        file.write_text(text.rstrip() + MASSES, encoding="utf-8")
        return marking_scheme(api.open_case(file, "en"))


@pytest.mark.parametrize("digits", [12, 3])
def test_a_right_sheet_scores_full(digits: int) -> None:
    marking = mark(scheme(), students.sheet(scheme(), lambda row, k, value: students.figures(value, digits)))
    assert marking.points == marking.out_of > 0
    assert marking.warnings == ()


def test_a_careful_drawing_is_right() -> None:
    """Every point off by up to 0.5 mm: what leaves its band still follows from the student's own values."""
    world = students.worked_out(scheme(), drawn=np.random.default_rng(3))
    cells = mark(scheme(), students.written(scheme(), world)).cells
    assert sum(cell.verdict in {Verdict.right, Verdict.follows} for cell in cells) >= 0.997 * len(cells)


@pytest.mark.parametrize("name", sorted(students.OF_TRIADS))
def test_mistakes_about_the_special_point_are_named(name: str) -> None:
    mistake = next(mistake for mistake in general_mistakes(scheme()) if mistake.name == name)
    world = students.worked_out(scheme(), mistake)
    marking = mark(scheme(), students.written(scheme(), world))
    assert {cell.mistake for cell in marking.first_errors} == {name}
