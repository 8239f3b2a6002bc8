"""Drawing sheets: plates in true size, put in rows on as many sheets of one size as they need.

A sheet's origin is its lower left corner; lengths are millimetres of paper.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from reportgen.figures.scene import Scene

GAP = 10.0
"""White between plates, and between them and the frame, mm."""


@dataclass(frozen=True, slots=True)
class Part:
    """A scene on a sheet with its lower left corner `at`; `name` groups its items, `layer` says what it shows."""

    name: str
    layer: str
    scene: Scene
    at: complex = 0j

    @property
    def box(self) -> tuple[complex, complex]:
        """Its lower left and upper right corner on the sheet."""
        return self.at, self.at + complex(self.scene.width, self.scene.height)


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet of paper `width` × `height` with what is drawn on it; `name` is that of its size, such as A1."""

    name: str
    width: float
    height: float
    parts: tuple[Part, ...] = ()


@dataclass(frozen=True, slots=True)
class Room:
    """What a frame leaves free: from corner `low` to `high`, without the box from `low`'s height up at the right.

    `block` (width, height) is the title block in the lower right corner.
    """

    low: complex
    high: complex
    block: complex

    @property
    def area(self) -> float:
        size = self.high - self.low
        return size.real * size.imag - self.block.real * self.block.imag

    def width(self, bottom: float) -> float:
        """The width free for a row whose lower edge lies at a height."""
        beside_block = bottom < self.low.imag + self.block.imag + GAP
        return self.high.real - self.low.real - (self.block.real + GAP if beside_block else 0.0)


class TooLargeError(ValueError):
    """A plate has no place on a sheet of the size asked for."""

    def __init__(self, part: Part) -> None:
        super().__init__(part.name)
        self.part = part


def arranged(parts: Sequence[Part], room: Room) -> list[tuple[Part, ...]]:
    """The parts in their order, in rows from the top, on one sheet after another.

    The parts of a row stand on one base line and share the width; the rows share the height.  Raises
    `TooLargeError` for a part that fits no sheet.
    """
    sheets: list[tuple[Part, ...]] = []
    rest = list(parts)
    while rest:
        rows, count = _rows(rest, room)
        if not rows:
            raise TooLargeError(rest[0])
        sheets.append(_spread(rows, room))
        rest = rest[count:]
    return sheets


def _rows(parts: Sequence[Part], room: Room) -> tuple[list[list[Part]], int]:
    """The rows that one sheet takes of the parts, and how many parts they are."""
    rows: list[list[Part]] = []
    top, count = room.high.imag - GAP, 0
    while count < len(parts):
        row = _row(parts[count:], top, room)
        if not row:
            break
        rows.append(row)
        top -= _height(row) + GAP
        count += len(row)
    return rows, count


def _row(parts: Sequence[Part], top: float, room: Room) -> list[Part]:
    """The parts that stand side by side below `top`; none if the first has no place there."""
    row: list[Part] = []
    for part in parts:
        longer = [*row, part]
        bottom = top - _height(longer)
        across = sum(one.scene.width + GAP for one in longer) + GAP
        if bottom < room.low.imag + GAP or across > room.width(bottom):
            break
        row = longer
    return row


def _height(row: Sequence[Part]) -> float:
    return max(part.scene.height for part in row)


def _spread(rows: Sequence[Sequence[Part]], room: Room) -> tuple[Part, ...]:
    """The rows with what is left of the height between them, and each row's parts of the width."""
    top = room.high.imag - GAP
    heights = [_height(row) for row in rows]
    left = top - room.low.imag - GAP - sum(heights) - GAP * (len(rows) - 1)
    # Moving a row down must not bring it beside the title block when it was laid out above it.
    placed: list[Part] = []
    between = GAP + left / len(rows)
    for spread in (between, GAP):
        placed, at, fits = [], top, True
        for row, height in zip(rows, heights, strict=True):
            bottom = at - height
            width = room.width(bottom)
            free = width - sum(part.scene.width for part in row)
            fits = fits and free >= GAP * (len(row) + 1) - 1e-9 and bottom >= room.low.imag + GAP - 1e-9
            x = room.low.real + free / (len(row) + 1)
            for part in row:
                placed.append(replace(part, at=complex(x, bottom)))
                x += part.scene.width + free / (len(row) + 1)
            at = bottom - spread
        if fits:
            break
    return tuple(placed)


def filled(parts: Sequence[Part], room: Room) -> float:
    """The share of a sheet's free area that plates with half the white around them take."""
    return sum((part.scene.width + GAP) * (part.scene.height + GAP) for part in parts) / room.area
