"""Pack plates on drawing sheets in columns, in the order of the work: `Packing.sheets`.

A column is rows of plates; the next plate is placed beside one that leaves room. Columns begin at the top, with one
distance between rows and one between columns on the whole sheet. Columns above the title block are shorter by its
height.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate

from reportgen.base.records import Record, replace
from reportgen.drawing.drawing_sheet import GAP, PlacedScene, Room, TooLargeError
from reportgen.drawing.plates import DUST, Arranged, DrawingPlate

MOST = 20.0
"""Largest distance between rows, mm."""
SHARES = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5)
"""Shares of the sheet's height that are tried for columns."""
STEP = 4.0
"""Step (mm) in which widths of columns are tried."""


PlateRow = list[tuple[DrawingPlate, Arranged]]


class PlateColumn(Record, dict=True):
    """Rows of plates with a common width."""

    width: float
    rows: Sequence[PlateRow]

    @classmethod
    def of(cls, plates: Sequence[DrawingPlate], width: float) -> PlateColumn:
        """Return the plates in rows, side by side where that makes the column lower.

        None may be wider than `width` (mm).
        """
        rows: list[PlateRow] = []
        used = 0.0
        for plate in plates:
            alone = plate.arrangements[plate.within(width) - 1]
            beside = plate.within(width - used - GAP) if rows else 0
            if beside and plate.arrangements[beside - 1].height - _height(rows[-1]) < alone.height + GAP:
                rows[-1].append((plate, plate.arrangements[beside - 1]))
                used += GAP + rows[-1][-1][1].width
            else:
                rows.append([(plate, alone)])
                used = alone.width
        return cls(max(sum(how.width for _, how in row) + GAP * (len(row) - 1) for row in rows), rows)

    @cached_property
    def height(self) -> float:
        """Height of all rows (mm), without the space between them."""
        return sum(map(_height, self.rows))

    def fits(self, high: float) -> bool:
        """Return True if it fits a height (mm), white above, below and between the rows included."""
        return self.height + GAP * (len(self.rows) + 1) <= high + DUST

    def placed(self, corner: complex, apart: float) -> Iterator[PlacedScene]:
        """Yield the scenes of its plates with `apart` (mm) between rows; the heads of a row are aligned."""
        top = corner
        for row in self.rows:
            free = self.width - sum(how.width for _, how in row)
            between = free / (len(row) - 1) if len(row) > 1 else 0.0
            left = free / 2 if len(row) == 1 else 0.0
            for plate, how in row:
                yield from plate.placed(how, top + left)
                left += how.width + between
            top -= 1j * (_height(row) + apart)


def _height(row: PlateRow) -> float:
    return max(how.height for _, how in row)


@dataclass
class Packing:
    """Puts plates in the order of the work on sheets, a first and following ones; `count` have been numbered."""

    room: Room
    following: Room
    count: int = 0
    _columns: dict[tuple[object, ...], PlateColumn | None] = field(default_factory=dict)

    @property
    def wide(self) -> float:
        """The sheet's room across (mm)."""
        return (self.room.high - self.room.low).real

    @property
    def high(self) -> float:
        """The sheet's room upwards (mm)."""
        return (self.room.high - self.room.low).imag

    @property
    def beside(self) -> float:
        """The width (mm) to the left of the title block."""
        return self.wide - self.room.block.real

    @property
    def above(self) -> float:
        """The height (mm) above it."""
        return self.high - self.room.block.imag

    def sheets(self, plates: Iterable[DrawingPlate]) -> Iterator[tuple[PlacedScene, ...]]:
        """Yield the placed scenes of each sheet; raise `TooLargeError` for a plate that fits no sheet."""
        spare: list[DrawingPlate] = []
        waiting: list[DrawingPlate] = []
        for plate in plates:
            if plate.spare:
                spare.append(plate)
            else:
                waiting.append(self._numbered(plate))
        while waiting:
            count = _count(self._filled(waiting))
            if not count:
                waiting[:1] = self._divided(waiting[0])
                continue
            count = self._together(waiting, count)
            for plate in spare if count == len(waiting) else ():
                more = [*waiting, replace(plate, number=self.count + 1)]
                if _count(self._filled(more)) == len(more):
                    waiting, count = more, len(more)
                    self.count += 1
            yield tuple(self._spread(waiting[:count]))
            self.room = self.following
            waiting = waiting[count:]

    def _numbered(self, plate: DrawingPlate) -> DrawingPlate:
        self.count += 1
        return replace(plate, number=self.count)

    def _divided(self, plate: DrawingPlate) -> tuple[DrawingPlate, DrawingPlate]:
        """Return a plate with as many scenes as a sheet holds, and one with the remaining scenes."""
        for count in range(len(plate.scenes) - 1, 0, -1):
            parts = plate.divided(count)
            if self._filled(parts[:1]):
                return parts
        raise TooLargeError(plate.title, plate.arrangements[0].width, plate.arrangements[0].height)

    def _together(self, plates: Sequence[DrawingPlate], count: int) -> int:
        """Return the number of plates on a sheet, reduced so that no family is divided that fits on the next one."""
        if count == len(plates) or not plates[count].family:
            return count
        family = [plate for plate in plates if plate.family == plates[count].family]
        whole = _count(self._filled(family)) == len(family)
        return (plates.index(family[0]) if whole else 0) or count

    def _filled(self, plates: Sequence[DrawingPlate], share: float = 1.0) -> list[PlateColumn]:
        """Return as many plates as a share of the height holds, in columns that leave most room on the right."""
        high, above = share * self.high, min(share * self.high, self.above)
        ends = [0.0, *(math.inf for _ in plates)]
        columns_at: list[list[PlateColumn]] = [[] for _ in ends]
        for start in range(len(plates)):
            for end in range(start + 1, len(ends)):
                column = self._narrowest(plates[start:end], high) if ends[start] < math.inf else None
                if column is None:
                    break
                right = ends[start] + GAP + column.width
                if right + GAP > self.beside + DUST:
                    column = self._narrowest(plates[start:end], above)
                    right = ends[start] + GAP + column.width if column else math.inf
                if column and right + GAP <= self.wide + DUST and right <= ends[end] + DUST:
                    ends[end], columns_at[end] = right, [*columns_at[start], column]
        return next((columns for columns in reversed(columns_at) if columns), [])

    def _narrowest(self, plates: Sequence[DrawingPlate], high: float) -> PlateColumn | None:
        """Return the plates in the narrowest column of a height (mm); None if the sheet is not wide enough."""
        key = *plates, high
        if key not in self._columns:
            least = max(plate.arrangements[0].width for plate in plates)
            tried = range(math.floor((self.wide - 2 * GAP - least) / STEP) + 1)
            step = bisect_left(tried, True, key=lambda step: PlateColumn.of(plates, least + STEP * step).fits(high))
            self._columns[key] = PlateColumn.of(plates, least + STEP * step) if step < len(tried) else None
        return self._columns[key]

    def _spread(self, plates: Sequence[DrawingPlate]) -> Iterator[PlacedScene]:
        """Yield the scenes of a sheet.

        Its columns have the height at which the smaller of both gaps (between columns and between rows) is largest.
        """
        every = [self._filled(plates, share) for share in SHARES]
        columns = max(
            (columns for columns in every if _count(columns) == len(plates)),
            key=lambda columns: min(self._apart(columns)),
        )
        across, down = self._apart(columns)
        down = min(down, MOST)
        corner = complex(self.room.low.real + across, self.room.high.imag - down)
        for column in columns:
            yield from column.placed(corner, down)
            corner += column.width + across

    def _apart(self, columns: Sequence[PlateColumn]) -> tuple[float, float]:
        """Return the distances of columns that fill the width of a sheet, and of rows that fill its height."""
        rights = list(accumulate(column.width for column in columns))
        free = [(self.wide - rights[-1]) / (len(columns) + 1)]
        free += [
            (self.beside - GAP - right) / number
            for number, (column, right) in enumerate(zip(columns, rights, strict=True), start=1)
            if not column.fits(self.above)
        ]
        across = min(free)
        down = [
            ((self.high if across * number + right <= self.beside - GAP else self.above) - column.height)
            / (len(column.rows) + 1)
            for number, (column, right) in enumerate(zip(columns, rights, strict=True), start=1)
        ]
        return across, min(down)


def _count(columns: Sequence[PlateColumn]) -> int:
    """Return the number of plates in some columns."""
    return sum(len(row) for column in columns for row in column.rows)
