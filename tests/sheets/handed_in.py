"""What is asked of every drawing sheet: plates in the frame, apart, standard letters and pens, little white."""

from __future__ import annotations

from itertools import combinations

from reportgen.drawing import Label
from reportgen.drawing.geometry import POINT, SCRIPT, bounds
from reportgen.drawing.sheet import CAPITAL, GAP, DrawingSheet, PlacedScene
from reportgen.sheets.frame import SIZES as PAPER
from tests.sheets.laid import block_of, laid, plates

EDGE = 1e-6
"""Rounding of places, mm."""
PENS = {0.35, 0.7}
"""Widths of lines on a sheet (ISO 128), mm."""
LEAST = 2.49
"""Height of capitals of the smallest letters, mm: 2.5 by ISO 3098, with the last digit of a font size."""
FULL = 0.45
"""What of the free area of a sheet its plates take at least, A3 apart; most take more than 0.6."""


def check(name: str, size: str, only: str = "") -> list[float]:
    """Check the sheets of an assignment; gives the share of each that is filled."""
    shares = check_but_filling(name, size, only)
    assert size == "A3" or min(shares) >= FULL, (name, size, only, shares)
    return shares


def check_but_filling(name: str, size: str, only: str = "") -> list[float]:
    found = laid(name, size, only).sheets
    for number, sheet in enumerate(found, start=1):
        plates_keep_apart(sheet, f"{size}, sheet {number}")
        letters_and_pens_are_standard(sheet, f"{size}, sheet {number}")
    return [filled(name, sheet) for sheet in found]


def filled(name: str, sheet: DrawingSheet) -> float:
    """The area of plates with their captions over that inside the frame without the title block."""
    paper, block = PAPER[sheet.name], block_of(name).size
    free = (paper[0] - 30) * (paper[1] - 20) - block[0] * block[1]
    return sum(part.scene.width * part.scene.height for part in plates(sheet)) / free


def plates_keep_apart(sheet: DrawingSheet, where: str) -> None:
    """From one another, from the frame and from the title block; what a plate draws stays in its box."""
    block = next(part for part in sheet.parts if part.name == "title block")
    width, height = PAPER[sheet.name]
    for part in plates(sheet):
        inside(part.box, (complex(20, 10), complex(width - 10, height - 10)), f"{where}, {part.name}")
        inside(bounds(part.scene.items), (0j, complex(part.scene.width, part.scene.height)), f"{where}, {part.name}")
    for one, other in combinations([*plates(sheet), block], 2):
        assert apart(one, other) >= GAP - EDGE, (where, one.name, other.name)


def letters_and_pens_are_standard(sheet: DrawingSheet, where: str) -> None:
    for part in plates(sheet):
        sizes = [item.size for item in part.scene.items if isinstance(item, Label)]
        assert SCRIPT * CAPITAL * POINT * min(sizes) >= LEAST, (where, part.name)
        strokes = (getattr(item, "stroke", None) for item in part.scene.items)
        assert {stroke.width for stroke in strokes if stroke is not None} <= PENS, (where, part.name)


Box = tuple[complex, complex]


def inside(box: Box, room: Box, name: str) -> None:
    below, above = box[0] - room[0], room[1] - box[1]
    assert min(below.real, below.imag, above.real, above.imag) >= -EDGE, name


def apart(one: PlacedScene, other: PlacedScene) -> float:
    """How much white lies between two parts, across or upwards; negative where they overlap."""
    (low, high), (its_low, its_high) = one.box, other.box
    across = max(its_low.real - high.real, low.real - its_high.real)
    return max(across, its_low.imag - high.imag, low.imag - its_high.imag)
