"""Plates of drawing sheets: one drawing, or several that belong together, in rows below one head."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

from reportgen.base.records import Record, replace
from reportgen.drawing import Content, Scene
from reportgen.drawing.drawing_sheet import GAP, PlacedScene, headed

DUST = 1e-6
"""Rounding of places (mm)."""


class Arranged(Record):
    """The scenes of a plate in rows, by their numbers, with the width and height (mm) of all below its head."""

    width: float
    height: float
    rows: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, eq=False)
class DrawingPlate:
    """Drawings under one title on paper, the lines below the title, and their layer.

    Plates of one `family` belong together; `spare` ones only fill the rest of a sheet.  They are numbered on the
    sheets; a plate that fits no sheet is divided, and `further` is the note that it continues.
    """

    title: str
    lines: tuple[Content, ...]
    layer: str
    scenes: tuple[Scene, ...]
    family: str = ""
    spare: bool = False
    further: str = ""
    number: int = 0
    first: int = 1
    """Number of the first scene: earlier ones may be on the sheet before."""
    axis: str = ""
    """Name of an axis: plates with the same one are enlarged together, so that their diagrams can be compared."""
    larger: Callable[[], DrawingPlate | None] | None = None
    """Function that returns the plate at the next larger standard scale; None if the plate has a fixed scale."""

    @cached_property
    def top(self) -> Scene:
        """Return its head alone."""
        return headed(f"{self.number}. {self.title}", *self.lines)

    @property
    def area(self) -> float:
        """Return the area of its scenes (mm²)."""
        return sum(scene.width * scene.height for scene in self.scenes)

    @cached_property
    def arrangements(self) -> list[Arranged]:
        """Return the arrangements of the scenes in rows, each wider and lower than the one before."""
        widths = [scene.width + GAP for scene in self.scenes]
        ends = list(accumulate(widths, initial=0.0))
        sums = {end - start - GAP for at, end in enumerate(ends) for start in ends[:at]}
        least = max(*(scene.width for scene in self.scenes), self.top.width)
        arrangements: list[Arranged] = []
        for width in sorted({least, *(one for one in sums if one > least)}):
            arranged = self._arranged(width)
            if not arrangements or arranged.height < arrangements[-1].height - DUST:
                arrangements.append(arranged)
        return arrangements

    def _arranged(self, width: float) -> Arranged:
        rows: list[list[int]] = []
        used = math.inf
        for number, scene in enumerate(self.scenes):
            used += GAP + scene.width
            if used > width + DUST:
                rows.append([])
                used = scene.width
            rows[-1].append(number)
        heights = [max(self.scenes[number].height for number in row) for row in rows]
        return Arranged(width, self.top.height + sum(heights) + GAP * (len(rows) - 1), tuple(map(tuple, rows)))

    def within(self, width: float) -> int:
        """Return the number of arrangements that are not wider (mm); the last of them is the lowest."""
        return bisect_right(self.arrangements, width + DUST, key=lambda one: one.width)

    def divided(self, count: int) -> tuple[DrawingPlate, DrawingPlate]:
        """Return the plate with its first `count` scenes and one with the others, whose first line is `further`."""
        lines = (self.further, *(line for line in self.lines if line != self.further))
        rest = replace(self, lines=lines, scenes=self.scenes[count:], first=self.first + count)
        return replace(self, scenes=self.scenes[:count]), rest

    def placed(self, how: Arranged, corner: complex) -> Iterator[PlacedScene]:
        """Yield the parts of the plate, arranged as in `how`: the head, then the scenes of each row, evenly spread.

        `corner` is the upper left corner of the plate's box (mm).
        """
        top = corner - 1j * self.top.height
        yield PlacedScene(f"{self.number}", self.layer, self.top, top + (how.width - self.top.width) / 2)
        for row in how.rows:
            scenes = [self.scenes[number] for number in row]
            top -= 1j * max(scene.height for scene in scenes)
            space = (how.width - sum(scene.width for scene in scenes)) / (len(scenes) + 1)
            left = space
            for number, scene in zip(row, scenes, strict=True):
                yield PlacedScene(f"{self.number}.{self.first + number}", self.layer, scene, top + left)
                left += scene.width + space
            top -= 1j * GAP


MOST_STEPS = 5
"""Largest number of standard scales by which a plate is larger than in the report."""


def enlargeable(draw: Callable[[int], DrawingPlate], most: int = MOST_STEPS, steps: int = 0) -> DrawingPlate:
    """Return a plate drawn by `steps` standard scales larger than in the report, which may be enlarged up to `most`."""
    larger = None if steps == most else lambda: enlargeable(draw, most, steps + 1)
    return replace(draw(steps), larger=larger)


def changed(plate: DrawingPlate, change: Callable[[DrawingPlate], DrawingPlate]) -> DrawingPlate:
    """Return a plate with a change that also applies to its larger versions."""
    larger = plate.larger
    if larger is None:
        return change(plate)

    def next_one() -> DrawingPlate | None:
        plate = larger()
        return plate and changed(plate, change)

    return replace(change(plate), larger=next_one)
