"""Drawing sheets: plates in true size, put in rows on as many sheets of one size as they need.

A sheet's origin is its lower left corner; lengths are millimetres of paper.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

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

    def has(self, low: complex, high: complex) -> bool:
        """Whether the box between two corners lies inside, white around it included."""
        white = complex(GAP, GAP) * 0.999
        low, high = low - white, high + white
        inside = self.low.real <= low.real and self.low.imag <= low.imag
        inside = inside and high.real <= self.high.real and high.imag <= self.high.imag
        corner = complex(self.high.real - self.block.real, self.low.imag + self.block.imag)
        return inside and (high.real <= corner.real or low.imag >= corner.imag)


AHEAD = 8
"""So many parts that have no place in a row are passed over."""


class TooLargeError(ValueError):
    """A plate has no place on a sheet of the size asked for."""

    def __init__(self, part: Part) -> None:
        super().__init__(part.name)
        self.part = part


Column = list[Part]
Row = list[Column]


def arranged(parts: Sequence[Part], room: Room, enough: float = 1.0) -> list[tuple[Part, ...]]:
    """The parts in rows from the top, on one sheet after another, each filled to a share that is `enough`.

    They keep their order, but where the next one has no place in a row, one of those behind it may have.  Where the
    tallest of a row leaves room, parts stand below one another in a column.  Columns share the width of their row,
    rows the height of the sheet.  Raises `TooLargeError` for a part that fits no sheet.
    """
    sheets: list[tuple[Part, ...]] = []
    rest = list(parts)
    while rest:
        count = next((n for n in range(1, len(rest)) if filled(rest[:n], room) >= enough), len(rest))
        rows, left = _rows(rest[:count], room)
        if not rows:
            raise TooLargeError(rest[0])
        sheets.append(_spread(rows, room))
        rest = [*left, *rest[count:]]
    return sheets


def _rows(parts: list[Part], room: Room) -> tuple[list[Row], list[Part]]:
    """The rows that one sheet takes of the parts, and the parts that are left."""
    rows: list[Row] = []
    top = room.high.imag - GAP
    while True:
        row, left = _row(parts, top, room)
        if not row:
            return rows, parts
        rows.append(row)
        top -= _height(row) + GAP
        parts = left


def _row(parts: list[Part], top: float, room: Room) -> tuple[Row, list[Part]]:
    """The columns that stand side by side below `top`, none if the first part has no place there, and what is left."""
    row: Row = []
    left: list[Part] = []
    for number, part in enumerate(parts):
        longer = _longer(row, part, top, room)
        if longer is not None:
            row = longer
            continue
        left.append(part)
        if not row or len(left) > AHEAD:
            return row, [*left, *parts[number + 1 :]]
    return row, left


def _longer(row: Row, part: Part, top: float, room: Room) -> Row | None:
    """A row with a further part: below its last column if that gets no taller than the row, else beside it."""
    below: Row = [*row[:-1], [*row[-1], part]] if row else []
    if row and _high(below[-1]) <= _height(row) and _fits(below, top, room):
        return below
    beside = [*row, [part]]
    return beside if _fits(beside, top, room) else None


def _fits(row: Row, top: float, room: Room) -> bool:
    return _stands(row, _close(row, room), top, room)


def _stands(row: Row, places: Sequence[float], top: float, room: Room) -> bool:
    """Whether columns that begin at `top`, with their left edges at some places, keep off the frame and the block."""
    return all(
        room.has(complex(x, top - _high(column)), complex(x + _wide(column), top))
        for x, column in zip(places, row, strict=True)
    )


def _close(row: Row, room: Room) -> list[float]:
    """The left edges of columns that stand as close to the left as they may."""
    return list(accumulate((_wide(column) + GAP for column in row[:-1]), initial=room.low.real + GAP))


def _apart(row: Row, room: Room) -> list[float]:
    """The left edges of columns that share the width."""
    free = (room.high - room.low).real - sum(map(_wide, row))
    white = free / (len(row) + 1)
    return list(accumulate((_wide(column) + white for column in row[:-1]), initial=room.low.real + white))


def _high(column: Column) -> float:
    return sum(part.scene.height for part in column) + GAP * (len(column) - 1)


def _wide(column: Column) -> float:
    return max(part.scene.width for part in column)


def _height(row: Row) -> float:
    return max(map(_high, row))


def _spread(rows: Sequence[Row], room: Room) -> tuple[Part, ...]:
    """The rows with what is left of the height between them, and each row's columns with what is left of the width."""
    top = room.high.imag - GAP
    left = top - room.low.imag - GAP - sum(map(_height, rows)) - GAP * (len(rows) - 1)
    # Moving a row down must not bring it beside the title block when it was laid out above it.
    for between in (GAP + left / len(rows), GAP):
        at = [top - part for part in accumulate((_height(row) + between for row in rows[:-1]), initial=0.0)]
        if all(_fits(row, y, room) for row, y in zip(rows, at, strict=True)):
            break
    return tuple(part for row, y in zip(rows, at, strict=True) for part in _across(row, y, room))


def _across(row: Row, top: float, room: Room) -> Iterator[Part]:
    """The parts of a row in their places; parts below one another share the height of the row."""
    height, places = _height(row), _apart(row, room)
    if not _stands(row, places, top, room):
        places = _close(row, room)
    for x, column in zip(places, row, strict=True):
        # Beside the block the lowest of a column stays where it has room.
        low = complex(x, top - height)
        free = height - _high(column) if room.has(low, complex(x + _wide(column), top)) else 0.0
        y = top
        for part in column:
            yield replace(part, at=complex(x + (_wide(column) - part.scene.width) / 2, y - part.scene.height))
            y -= part.scene.height + GAP + free / len(column)


def filled(parts: Sequence[Part], room: Room) -> float:
    """The share of a sheet's free area that plates with half the white around them take."""
    return sum((part.scene.width + GAP) * (part.scene.height + GAP) for part in parts) / room.area
