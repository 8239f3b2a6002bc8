"""Drawing sheets: plates in true size on paper, and the room that frame and title block leave them.

A sheet's origin is its lower left corner; lengths are millimetres of paper.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from reportgen.figures.scene import Scene

GAP = 5.0
"""White between plates, and between them and the frame, mm."""


@dataclass(frozen=True, slots=True)
class Part:
    """A scene on a sheet with its lower left corner `at`; `name` groups its items, `layer` says what it shows.

    `table` is the width and height of what of it may be stretched, nothing if it is no table.
    """

    name: str
    layer: str
    scene: Scene
    at: complex = 0j
    table: complex = 0j

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


class TooLargeError(ValueError):
    """A plate has no place on a sheet of the size asked for."""

    def __init__(self, part: Part) -> None:
        super().__init__(part.name)
        self.part = part


def filled(parts: Iterable[Part], room: Room) -> float:
    """The share of a sheet's free area that the boxes of plates, captions included, take."""
    return sum(part.scene.width * part.scene.height for part in parts) / room.area
