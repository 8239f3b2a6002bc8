"""Sheets that can be handed in: so many as asked for, plates in the frame, apart and in order, even gutters."""

from __future__ import annotations

from contextlib import suppress
from itertools import pairwise

import pytest

from reportgen.base.errors import AssignmentError
from reportgen.drawing import Label, Line, Scene
from reportgen.drawing.drawing_sheet import GAP, Room, TooLargeError
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets import laid as divided
from reportgen.sheets import plates_by_set
from reportgen.sheets.packing import Packing
from reportgen.sheets.title_block import SIZES as PAPER
from tests.lanes import matrix
from tests.report.built import TYPESET
from tests.sheets.handed_in import check
from tests.sheets.laid import EVERY, EXERCISES, block_of, laid, numbers, opened, plates

TELLING = [("four-bar-02", "A0"), ("shaper-01", "A1"), ("engine-twin-05", "A2"), ("linkage-slide", "A3"), ("16", "A3")]
"""Each size of paper, both languages, rods, sliding blocks, two cylinders, a sliding driver, an exercise."""
THREE = {"engine-v-02": 3, "engine-friction": 3, "slider-crank-04": 3, "four-bar-04": 3}
THREE |= {"engine-single-load": 3, "toggle-press-02": 3}
"""On A1: two cylinders at 14 positions a turn, and 28 in a cycle, with plans of both; an engine with its friction
circles; a set for balancing; curves of the true motion beside many plans.  All others have two sheets at most."""

CHOSEN = [name for name in EVERY if name in EXERCISES or name in {path.stem for path in TYPESET}]
"""Machines of one kind take much the same paper."""
ON_PAPER = [
    pytest.param(name, size, id=f"{name}-{size}")
    for turn, name in enumerate(EVERY)
    for number, size in enumerate(PAPER)
    if (turn + number) % (2 if name in CHOSEN else 4) == 0 or (name, size) in TELLING
]
"""Every file on one of the four sizes, by turns; the first of each kind on two."""


@pytest.mark.parametrize(("name", "size"), matrix(ON_PAPER, telling=TELLING))
def test_sheets_can_be_handed_in(name: str, size: str) -> None:
    check(name, size)


@pytest.mark.parametrize("name", matrix(EVERY, telling=["four-bar-01"]))
def test_sheets_with_every_plate_can_be_handed_in(name: str) -> None:
    if name not in EXERCISES:
        check(name, "A1", every=True)


@pytest.mark.parametrize("name", matrix(EVERY, telling=["engine-twin-05", "shaper-01", "16"]))
def test_each_set_is_one_sheet_a1(name: str) -> None:
    """A sheet of the motion, and one of the forces where there are any."""
    forces = name not in EXERCISES and bool(opened(name).analysis.loads)
    assert len(laid(name, "A1").sheets) == THREE.get(name, 2 if forces else 1)


@pytest.mark.parametrize("name", matrix(CHOSEN, telling=["slotted-lever-01", "01"]))
def test_without_a_size_it_is_the_smallest_that_holds_each_set(name: str) -> None:
    """No smaller one does."""
    found = laid(name, "").sheets
    chosen = found[0].name
    sets = {"motion": None} if name in EXERCISES else plates_by_set(opened(name))
    assert len(found) == len(sets)
    for size in ("A3", "A2", "A1", "A0")[: ("A3", "A2", "A1", "A0").index(chosen)]:
        with suppress(AssignmentError):  # a plate that is too large
            assert len(laid(name, size).sheets) > len(sets)


@pytest.mark.parametrize(
    ("name", "size"), matrix([("four-bar-02", "A0"), ("shaper-01", "A1"), ("engine-v-02", "A2")], TELLING[:2])
)
def test_plates_stand_in_the_order_of_the_work(name: str, size: str) -> None:
    found = [number for sheet in laid(name, size).sheets for number in numbers(sheet)]
    assert found == sorted(found)
    assert set(found) == set(range(1, max(found) + 1))
    for sheet in laid(name, size).sheets:
        for part in plates(sheet):
            if "." not in part.name:
                texts = [str(item.content) for item in part.scene.items if isinstance(item, Label)]
                assert texts[0].startswith(f"{part.name}. ")


@pytest.mark.parametrize(("name", "size"), [("shaper-01", "A1"), ("four-bar-02", "A3")])
def test_the_title_block_says_which_sheet_of_how_many(name: str, size: str) -> None:
    found = laid(name, size).sheets
    for number, sheet in enumerate(found, start=1):
        block = next(part for part in sheet.parts if part.name == "title block")
        texts = [str(item.content) for item in block.scene.items if isinstance(item, Label)]
        assert {f"Tờ {number}", f"Số tờ {len(found)}"} <= set(texts) or f"{number} / {len(found)}" in texts
        assert not any("{" in text for text in texts)


# --- packing


def boxes(*sizes: tuple[float, float], **more: object) -> list[DrawingPlate]:
    """Plates of boxes, with heads no wider than these."""
    line = Line(0j, 1 + 0j)
    return [DrawingPlate("P", (), "scheme", (Scene(wide, high, (line,)),), **more) for wide, high in sizes]  # type: ignore[arg-type]


ROOM = Room(0j, 300 + 200j, 100 + 50j)


def test_rows_are_as_far_apart_as_all_others() -> None:
    (sheet,) = Packing(ROOM, ROOM).sheets(boxes((180, 20), (160, 30), (170, 25)))
    parts = {part.name: part for part in sheet}
    whites = [parts[f"{n}.1"].at.imag - parts[f"{n + 1}"].box[1].imag for n in (1, 2)]
    whites.append(ROOM.high.imag - parts["1"].box[1].imag)
    assert max(whites) - min(whites) < 1e-6
    assert min(whites) >= GAP


def test_columns_are_as_far_apart_as_all_others() -> None:
    (sheet,) = Packing(ROOM, ROOM).sheets(boxes((60, 150), (50, 160), (40, 100)))
    parts = sorted((part for part in sheet if "." in part.name), key=lambda part: part.at.real)
    whites = [parts[0].at.real]
    whites += [other.at.real - one.box[1].real for one, other in pairwise(parts)]
    whites += [300 - parts[-1].box[1].real]
    # The second is as high as the sheet and ends before the title block.
    assert max(whites[:-1]) - min(whites[:-1]) < 1e-6
    assert len({part.box[1].imag for part in sheet if "." not in part.name}) == 1
    assert min(whites) >= GAP


def test_what_belongs_together_stays_together() -> None:
    """The last two would be parted; together they have room on the next sheet."""
    plates = [*boxes((200, 100)), *boxes((180, 60), (180, 60), family="v")]
    sheets = list(Packing(ROOM, ROOM).sheets(plates))
    assert [[part.name for part in sheet if "." not in part.name] for sheet in sheets] == [["1"], ["2", "3"]]


def test_the_small_plans_of_all_positions_are_as_large_as_the_sheet_holds() -> None:
    """In the report they are drawn to a tenth, and letters of points 2 mm apart stand in one row."""
    first, *_ = laid("shaper-01", "A1").sheets
    told = [
        item.content
        for part in plates(first)
        for item in part.scene.items
        if isinstance(item, Label)
        and isinstance(item.content, Chain)
        and item.content.note.split()[-2:] == ["0,1", "m/(s·mm)"]
    ]
    assert [str(chain.parts[0]) for chain in told] == [str(Symbol("μ", "v"))]
    ((_, shown),) = (chain.parts for chain in told)
    assert isinstance(shown, Number)
    assert shown.value <= 0.05


def test_a_table_of_results_only_fills_what_is_left() -> None:
    plates = [*boxes((150, 100)), *boxes((290, 150), (80, 80), spare=True)]
    (sheet,) = Packing(ROOM, ROOM).sheets(plates)
    assert [part.scene.width for part in sheet if "." in part.name] == [150, 80]


def test_a_plate_that_no_sheet_holds_is_divided() -> None:
    line = Line(0j, 1 + 0j)
    plate = DrawingPlate("P", (), "scheme", tuple(Scene(90, 60, (line,)) for _ in range(9)), further="on")
    sheets = list(Packing(ROOM, ROOM).sheets([plate]))
    assert [part.name for sheet in sheets for part in sheet if "." in part.name] == [f"1.{n}" for n in range(1, 10)]
    assert len(sheets) == 2


@pytest.mark.parametrize("size", PAPER)
def test_a_plate_larger_than_the_paper_is_told(size: str) -> None:
    wide = PAPER[size][0] - 30 - 2 * GAP + 1
    with pytest.raises(TooLargeError) as caught:
        divided({"kinematics": boxes((wide, 10))}, size, block_of("four-bar-02"))
    assert caught.value.name == "P"
