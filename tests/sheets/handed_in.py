"""What is asked of every drawing sheet: plates in the frame and apart, standard letters and pens."""

from __future__ import annotations

from itertools import combinations

from reportgen.base.errors import AssignmentError
from reportgen.drawing import Label
from reportgen.drawing.drawing_sheet import CAPITAL, GAP, DrawingSheet, PlacedScene
from reportgen.drawing.geometry import bounds
from reportgen.drawing.label_size import POINT, SCRIPT
from tests.sheets.laid import laid, plates

EDGE = 1e-6
"""Rounding of places, mm."""
PENS = {0.35, 0.7}
"""Widths of lines on a sheet (ISO 128), mm."""
LEAST = 2.49
"""Height of capitals of the smallest letters, mm: 2.5 by ISO 3098, with the last digit of a font size."""

Box = tuple[complex, complex]


def check(name: str, size: str, every: bool = False) -> None:
    """A plate that the size cannot hold is told."""
    try:
        laid(name, size, every)
    except AssignmentError as error:
        codes = {problem.code for problem in error.problems}
    else:
        codes = set()
    assert codes <= {"plate-too-large"}
    for number, sheet in enumerate([] if codes else laid(name, size, every).sheets, start=1):
        where = f"{name}, {size}, sheet {number}"
        plates_keep_apart(sheet, where)
        letters_and_pens_are_standard(sheet, where)


def plates_keep_apart(sheet: DrawingSheet, where: str) -> None:
    """From one another, from the frame and from the title block; what a plate draws stays in its box."""
    frame, block = (next(part for part in sheet.parts if part.name == name) for name in ("frame", "title block"))
    rim = bounds([item for item in frame.scene.items if getattr(item, "closed", False)][1:2])
    for part in plates(sheet):
        inside(part.box, rim, f"{where}, {part.name}")
        inside(bounds(part.scene.items), (0j, complex(part.scene.width, part.scene.height)), f"{where}, {part.name}")
    for one, other in combinations([*plates(sheet), block], 2):
        white = 0.0 if plate_of(one) == plate_of(other) else GAP
        assert apart(one, other) >= white - EDGE, (where, one.name, other.name)


def plate_of(part: PlacedScene) -> str:
    return part.name.partition(".")[0]


def letters_and_pens_are_standard(sheet: DrawingSheet, where: str) -> None:
    for part in plates(sheet):
        sizes = [item.size for item in part.scene.items if isinstance(item, Label)]
        assert SCRIPT * CAPITAL * POINT * min(sizes) >= LEAST, (where, part.name)
        strokes = (getattr(item, "stroke", None) for item in part.scene.items)
        assert {stroke.width for stroke in strokes if stroke is not None} <= PENS, (where, part.name)


def inside(box: Box, room: Box, name: str) -> None:
    below, above = box[0] - room[0], room[1] - box[1]
    assert min(below.real, below.imag, above.real, above.imag) >= -EDGE, name


def apart(one: PlacedScene, other: PlacedScene) -> float:
    """How much white lies between two parts, across or upwards; negative where they overlap."""
    (low, high), (its_low, its_high) = one.box, other.box
    across = max(its_low.real - high.real, low.real - its_high.real)
    return max(across, its_low.imag - high.imag, low.imag - its_high.imag)
