"""Drawing sheets: plates in true size, put in rows on as many sheets of one size as they need.

A sheet's origin is its lower left corner; lengths are millimetres of paper.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
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


@dataclass(frozen=True, slots=True)
class Column:
    """Parts below one another."""

    parts: tuple[Part, ...]
    width: float
    height: float

    @classmethod
    def of(cls, part: Part) -> Column:
        return cls((part,), part.scene.width, part.scene.height)

    def with_below(self, part: Part) -> Column:
        width = max(self.width, part.scene.width)
        return Column((*self.parts, part), width, self.height + GAP + part.scene.height)


@dataclass(slots=True)
class Row:
    """Columns side by side that begin at one height, `top`, as close to the left of the room as they may stand."""

    room: Room
    top: float
    columns: list[Column] = field(default_factory=list)
    height: float = 0.0
    end: float = 0.0
    """Where the last column begins, from the left of the room."""

    def take(self, part: Part) -> bool:
        """Whether a part found a place: below the last column if the row gets no taller so, else beside it."""
        if self.columns:
            last = self.columns[-1].with_below(part)
            if last.height <= self.height and self._stands(last, self.end):
                self.columns[-1] = last
                return True
        beside = Column.of(part)
        at = self.end + self.columns[-1].width + GAP if self.columns else GAP
        if not self._stands(beside, at):
            return False
        self.columns.append(beside)
        self.height, self.end = max(self.height, beside.height), at
        return True

    def _stands(self, column: Column, left: float, top: float | None = None) -> bool:
        x, high = self.room.low.real + left, self.top if top is None else top
        return self.room.has(complex(x, high - column.height), complex(x + column.width, high))

    def stands(self, lefts: Sequence[float], top: float) -> bool:
        """Whether the columns may begin at another height, with their left edges at some places."""
        return all(self._stands(column, left, top) for column, left in zip(self.columns, lefts, strict=True))

    def close(self) -> list[float]:
        """The left edges of columns that stand as close to the left as they may."""
        return self._lefts(GAP)

    def apart(self) -> list[float]:
        """The left edges of columns that share the width."""
        free = (self.room.high - self.room.low).real - sum(column.width for column in self.columns)
        return self._lefts(free / (len(self.columns) + 1))

    def _lefts(self, white: float) -> list[float]:
        return list(accumulate((column.width + white for column in self.columns[:-1]), initial=white))

    def placed(self, top: float) -> Iterator[Part]:
        """The parts in their places; those of a column share the height of the row."""
        lefts = self.apart()
        if not self.stands(lefts, top):
            lefts = self.close()
        for left, column in zip(lefts, self.columns, strict=True):
            x = self.room.low.real + left
            # Beside the title block the lowest of a column stays where it has room.
            whole = self.room.has(complex(x, top - self.height), complex(x + column.width, top))
            free = self.height - column.height if whole else 0.0
            y = top
            for part in column.parts:
                yield replace(part, at=complex(x + (column.width - part.scene.width) / 2, y - part.scene.height))
                y -= part.scene.height + GAP + free / len(column.parts)


def packed(parts: Sequence[Part], room: Room, enough: float = 1.0) -> list[list[Row]]:
    """The parts in rows from the top, on one sheet after another, each filled to a share that is `enough`.

    They keep their order, but where the next one has no place in a row, one of those behind it may have.  Where the
    tallest of a row leaves room, parts stand below one another in a column.  Raises `TooLargeError` for a part that
    fits no sheet.
    """
    sheets: list[list[Row]] = []
    rest = list(parts)
    while rest:
        count = _first_filling(rest, room, enough)
        rows, left = _rows(rest[:count], room)
        if not rows:
            raise TooLargeError(rest[0])
        sheets.append(rows)
        rest = [*left, *rest[count:]]
    return sheets


def _first_filling(parts: Sequence[Part], room: Room, enough: float) -> int:
    """How many of the parts fill a sheet to a share; all if they do not."""
    area = 0.0
    for number, part in enumerate(parts, start=1):
        area += _area(part)
        if area >= enough * room.area:
            return number
    return len(parts)


def _rows(parts: list[Part], room: Room) -> tuple[list[Row], list[Part]]:
    """The rows that one sheet takes of the parts, and the parts that are left."""
    rows: list[Row] = []
    top = room.high.imag - GAP
    while True:
        row, parts = _row(parts, Row(room, top))
        if not row.columns:
            return rows, parts
        rows.append(row)
        top -= row.height + GAP


def _row(parts: list[Part], row: Row) -> tuple[Row, list[Part]]:
    """A row filled with the parts, as long as the first has a place there, and what is left of them."""
    left: list[Part] = []
    for number, part in enumerate(parts):
        if row.take(part):
            continue
        left.append(part)
        if not row.columns or len(left) > AHEAD:
            return row, [*left, *parts[number + 1 :]]
    return row, left


def spread(rows: Sequence[Row], room: Room) -> tuple[Part, ...]:
    """The parts of a sheet in their places: rows share the height, the columns of each the width."""
    top = room.high.imag - GAP
    left = top - room.low.imag - GAP - sum(row.height for row in rows) - GAP * (len(rows) - 1)
    # Moving a row down must not bring it beside the title block when it was laid out above it.
    for between in (GAP + share * left / len(rows) for share in (1.0, 0.75, 0.5, 0.25, 0.0)):
        at = [top - part for part in accumulate((row.height + between for row in rows[:-1]), initial=0.0)]
        if all(row.stands(row.close(), y) for row, y in zip(rows, at, strict=True)):
            break
    return tuple(part for row, y in zip(rows, at, strict=True) for part in row.placed(y))


def filled(rows: Iterable[Row], room: Room) -> float:
    """The share of a sheet's free area that plates with half the white around them take."""
    return sum(_area(part) for row in rows for column in row.columns for part in column.parts) / room.area


def _area(part: Part) -> float:
    return (part.scene.width + GAP) * (part.scene.height + GAP)
