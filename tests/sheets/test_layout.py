"""Sheets that can be handed in: in the frame, apart, full, with standard letters, pens and scales."""

from __future__ import annotations

import math
from itertools import combinations

import pytest

from reportgen.document.title_block import DEFAULT, blocks, read_block
from reportgen.figures.frame import SIZES as PAPER
from reportgen.figures.frame import room
from reportgen.figures.geometry import bounds
from reportgen.figures.lettering import CAPITAL
from reportgen.figures.metrics import POINT, SCRIPT
from reportgen.figures.scene import Label
from reportgen.figures.sheet import GAP, Part
from reportgen.notation.expressions import Chain, Number, Symbol
from tests.sheets.laid import MACHINES, SIZES, laid, plates

EDGE = 1e-6
"""Rounding of places, mm."""
SERIES = {1.0, 2.0, 2.5, 4.0, 5.0}
PENS = {0.35, 0.7}
"""Widths of lines on a sheet (ISO 128), mm."""
LEAST = 2.49
"""Height of capitals of the smallest letters, mm: 2.5 by ISO 3098, with the last digit of a font size."""

sheets = pytest.mark.parametrize(("name", "size"), SIZES)


@sheets
def test_plates_keep_off_one_another_the_frame_and_the_title_block(name: str, size: str) -> None:
    for sheet in laid(name, size).sheets:
        block = next(part for part in sheet.parts if part.name == "title block")
        width, height = PAPER[size]
        for part in plates(sheet):
            inside(part.box, (complex(20, 10), complex(width - 10, height - 10)), part.name)
            inside(bounds(part.scene.items), (0j, complex(part.scene.width, part.scene.height)), part.name)
        for one, other in combinations([*plates(sheet), block], 2):
            assert apart(one, other) >= GAP / 2, (one.name, other.name)


Box = tuple[complex, complex]


def inside(box: Box, room: Box, name: str) -> None:
    below, above = box[0] - room[0], room[1] - box[1]
    assert min(below.real, below.imag, above.real, above.imag) >= -EDGE, name


def apart(one: Part, other: Part) -> float:
    """How much white lies between two parts, across or upwards; negative where they overlap."""
    (low, high), (its_low, its_high) = one.box, other.box
    across = max(its_low.real - high.real, low.real - its_high.real)
    return max(across, its_low.imag - high.imag, low.imag - its_high.imag)


@sheets
def test_letters_and_pens_are_those_of_the_standards(name: str, size: str) -> None:
    for sheet in laid(name, size).sheets:
        for part in plates(sheet):
            labels = [item for item in part.scene.items if isinstance(item, Label)]
            assert min(SCRIPT * CAPITAL * POINT * label.size for label in labels) >= LEAST, part.name
            strokes = (getattr(item, "stroke", None) for item in part.scene.items)
            assert {stroke.width for stroke in strokes if stroke is not None} <= PENS, part.name


@sheets
def test_every_scale_is_round(name: str, size: str) -> None:
    found = 0
    for sheet in laid(name, size).sheets:
        for part in plates(sheet):
            for item in part.scene.items:
                match item:
                    case Label(_, Chain((Symbol("μ"), Number(value)))):
                        found += 1
                        mantissa = value / 10 ** math.floor(math.log10(value) + 1e-9)
                        assert any(math.isclose(mantissa, step, rel_tol=1e-9) for step in SERIES), (part.name, value)
    assert found > 10


@sheets
def test_the_plates_are_numbered_in_the_order_of_the_work(name: str, size: str) -> None:
    numbers = [tuple(map(int, part.name.split("."))) for sheet in laid(name, size).sheets for part in plates(sheet)]
    assert len(numbers) == len(set(numbers))
    assert {number[0] for number in numbers} == set(range(1, max(numbers)[0] + 1))
    # A plate may be passed over for want of room, but not by the next but one sheet.
    firsts = [min(tuple(map(int, part.name.split("."))) for part in plates(one)) for one in laid(name, size).sheets]
    assert firsts == sorted(firsts)
    for sheet in laid(name, size).sheets:
        for part in plates(sheet):
            texts = [item.content for item in part.scene.items if isinstance(item, Label)]
            assert any(str(text).startswith(f"{part.name}. ") for text in texts)


@pytest.mark.parametrize("name", MACHINES)
def test_a_sheet_of_usual_size_is_filled(name: str) -> None:
    case = laid(name, "A1").case
    block = read_block(blocks()[DEFAULT[case.assignment.language]])
    area = room("A1", block.margins, block.size).area
    for sheet in laid(name, "A1").sheets:
        taken = sum((part.scene.width + GAP) * (part.scene.height + GAP) for part in plates(sheet))
        assert taken / area >= 0.595, sheet.name


@sheets
def test_the_title_block_says_which_sheet_of_how_many(name: str, size: str) -> None:
    found = laid(name, size).sheets
    for number, sheet in enumerate(found, start=1):
        block = next(part for part in sheet.parts if part.name == "title block")
        texts = [item.content for item in block.scene.items if isinstance(item, Label)]
        assert {f"Tờ {number}", f"Số tờ {len(found)}"} <= set(texts) or f"{number} / {len(found)}" in texts
        assert not any("{" in str(text) for text in texts)
