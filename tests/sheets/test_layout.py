"""Sheets that can be handed in: in the frame, apart, full, with standard letters, pens and scales."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from reportgen.drawing import Label, Line, Scene
from reportgen.drawing.sheet import GAP, TooLargeError
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets import sheets_of
from reportgen.sheets.frame import SIZES as PAPER
from reportgen.sheets.plates import Plates
from tests.lanes import matrix
from tests.sheets.handed_in import check
from tests.sheets.laid import EVERY, block_of, drawn, laid, plates, space

SERIES = {1.0, 2.0, 2.5, 4.0, 5.0}
TELLING = [("four-bar-02", "A0"), ("shaper-01", "A1"), ("engine-twin-05", "A2"), ("linkage-slide", "A3")]
"""Each size of paper, both languages, rods, sliding blocks, two cylinders, a sliding driver."""


@pytest.mark.parametrize(
    ("name", "size"),
    matrix([pytest.param(one, size, id=f"{one}-{size}") for one in EVERY for size in PAPER], telling=TELLING),
)
def test_sheets_can_be_handed_in(name: str, size: str) -> None:
    check(name, size)


@pytest.mark.parametrize(("name", "only", "size"), [("four-bar-01", "kinematics", "A3"), ("shaper-01", "forces", "A2")])
def test_sheets_of_one_set_are_filled_too(name: str, only: str, size: str) -> None:
    check(name, size, only)


sheets = pytest.mark.parametrize(
    ("name", "size"), matrix([("four-bar-02", "A0"), ("shaper-01", "A1"), ("engine-v-02", "A3")], TELLING[:2])
)


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
    # Only on a small sheet may they change places.
    assert size == "A3" or numbers == sorted(numbers)
    # Each sheet shows a run of them.
    runs = [sorted(tuple(map(int, part.name.split("."))) for part in plates(one)) for one in laid(name, size).sheets]
    assert [number for run in runs for number in run] == sorted(numbers)
    for sheet in laid(name, size).sheets:
        for part in plates(sheet):
            texts = [item.content for item in part.scene.items if isinstance(item, Label)]
            assert any(str(text).startswith(f"{part.name}. ") for text in texts)


@pytest.mark.parametrize("size", PAPER)
def test_a_plate_larger_than_the_paper_is_told(size: str) -> None:
    """One that no scale makes smaller."""
    found = drawn("four-bar-02")
    room = space("four-bar-02", size)
    wide = (room.high - room.low).real - 2 * GAP + 1
    line = Scene(wide, 10.0, (Line(0j, complex(wide, 0)),))
    scheme = replace(found.series[0], draw=lambda report: iter([("", line)]), scale="", size=0.0)
    with pytest.raises(TooLargeError) as caught:
        sheets_of(Plates(found.report, [scheme]), [0], size, block_of("four-bar-02"))
    assert caught.value.part.name == "1"


@pytest.mark.parametrize(
    ("name", "size"),
    matrix([(one, size) for one in EVERY for size in ("A1", "A3")], [("shaper-01", "A1"), ("linkage-slide", "A3")]),
)
def test_the_scheme_is_not_larger_than_the_position_plan(name: str, size: str) -> None:
    """But for its slider and guide, and round scales: it shows less than the plan."""
    sheet = laid(name, size).sheets[0]
    scheme, positions = (next(part.scene for part in plates(sheet) if part.name == number) for number in "12")
    assert max(scheme.width, scheme.height) <= 1.3 * max(positions.width, positions.height)


@sheets
def test_the_title_block_says_which_sheet_of_how_many(name: str, size: str) -> None:
    found = laid(name, size).sheets
    for number, sheet in enumerate(found, start=1):
        block = next(part for part in sheet.parts if part.name == "title block")
        texts = [item.content for item in block.scene.items if isinstance(item, Label)]
        assert {f"Tờ {number}", f"Số tờ {len(found)}"} <= set(texts) or f"{number} / {len(found)}" in texts
        assert not any("{" in str(text) for text in texts)
