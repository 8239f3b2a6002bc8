"""What a machine of the catalogue turns its parameters into: plain data that the rest of the house reads.

A catalogue file gives a `Machine`; nothing downstream asks which kind it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase
from typing import Any

import numpy as np

from reportgen.catalogue.loads import Applied, Course, Piston, Torque
from reportgen.mechanism.structure import Crank, Linkage
from reportgen.notation import ids
from reportgen.notation.expressions import Chain
from reportgen.notation.sheet import Sheet

NEAR = 1e-6
"""Positions nearer than this (rad) are one."""


class Position(int):
    """The number of a position, from 1, that is written as its label."""

    label: str

    def __new__(cls, number: int, label: str = "") -> Position:
        position = super().__new__(cls, number)
        position.label = label or str(int(number))
        return position

    def __str__(self) -> str:
        return self.label


def no_formulas(q: Sheet) -> None:
    """A machine without closed formulas."""


@dataclass(frozen=True, slots=True)
class Machine:
    """A mechanism with its drive, its loads and the outline of its report.

    A turn has `count` positions, numbered from driver angle `start` in the direction `turn` (+1
    anticlockwise); the cycle of loads takes `turns` turns of the driver.  `sheet` holds the given data and what
    follows from them; `formulas` writes the closed formulas on it once the plans are there.  `outline` names the
    report's sections in order.
    """

    kind: str
    linkage: Linkage
    start: float
    turn: int
    speed: float
    count: int
    turns: int
    sheet: Sheet
    outline: tuple[str, ...]
    formulas: Callable[[Sheet], None] = no_formulas
    pistons: tuple[Piston, ...] = ()
    applied: tuple[Applied, ...] = ()
    """All forces that are neither weight nor inertia, the gas on `pistons` among them."""
    torques: tuple[Torque, ...] = ()
    """Torques other than inertia couples."""
    idle: tuple[str, ...] = ()
    """Names of loads that the file gives as zero throughout; they are in neither of the two above."""
    sliders: tuple[Course, ...] = ()
    """Sliders with dead centres, the pistons among them."""
    positive: Mapping[str, complex] = field(default_factory=dict)
    """Unit vectors along which the motion of sliders counts as positive, by their pins; else along their guides."""
    paths: tuple[str, ...] = ()
    """Points whose paths the position plan shows."""
    compared: tuple[tuple[str, str], ...] = ()
    """Pairs of a plan's quantity and its closed formula, compared in the report."""
    equations: Mapping[str, tuple[Chain, ...]] = field(default_factory=dict)
    """Equations by name that the words of its analytic method show."""
    unevenness: float | None = None
    """δ of the speed that a flywheel is to keep to, if the report has its chapter."""
    places: tuple[float, ...] = ()
    """Cycle angles of the positions of one turn; empty: evenly spaced from 0."""
    labels: tuple[str, ...] = ()
    """What the positions of the cycle are called; empty: their numbers."""
    span: float = 0.0
    """The way (m) of a sliding driver over the cycle, which then stands for one turn; 0 for a crank."""
    facts: Mapping[str, Any] = field(default_factory=dict)
    """What the kind's own words may name beside quantities."""

    @property
    def way(self) -> float:
        """The driver's way over the cycle: an angle (rad), or the span of a sliding driver (m)."""
        return self.span or self.turns * 2 * np.pi

    @property
    def positions(self) -> int:
        """Number of positions of the whole cycle."""
        return self.count * self.turns

    @property
    def cycle_angles(self) -> np.ndarray:
        """Cycle angles of all positions [count·turns], 0 at position 1, growing with the rotation."""
        step = 2 * np.pi / self.count
        if not self.places:
            return np.arange(self.positions) * step
        turns = np.arange(self.turns)[:, None] * (2 * np.pi)
        return np.asarray((turns + np.asarray(self.places)).ravel())

    def angles(self, cycle_angle: np.ndarray) -> np.ndarray:
        """Driver angles at the given cycle angles; the coordinates (m) of a sliding driver."""
        return self.start + self.turn * cycle_angle * (self.span / (2 * np.pi) if self.span else 1.0)

    @property
    def drawn(self) -> float:
        """The crank's drawn length (m on paper) where the file or the kind sets it, else 0."""
        driver = self.linkage.driver
        id = ids.drawn(driver.centre, driver.pin) if isinstance(driver, Crank) else ""
        return self.sheet.si(id) if id in self.sheet else 0.0

    def position(self, number: int) -> Position:
        """A position by its number from 1."""
        return Position(number, self.labels[number - 1] if self.labels else "")

    def numbered(self, numbers: Iterable[int]) -> tuple[Position, ...]:
        return tuple(map(self.position, numbers))


def lettered(count: int, turns: int, extra: Iterable[float]) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Cycle angles of one turn's positions, and labels of the cycle's: `count` even ones 0, 1, …, others a, b, ….

    Of the `extra` angles those that coincide with an even one are left out; the letters follow the angle and
    go on from turn to turn, as the numbers do.
    """
    even = np.arange(count) * (2 * np.pi / count)
    turned = np.mod(np.asarray(list(extra)) + NEAR, 2 * np.pi) - NEAR
    new = [float(angle) for angle in turned if np.abs(even - angle).min() > NEAR]
    places = sorted([*map(float, even), *new])
    numbers, letters = iter(range(count * turns)), iter(ascii_lowercase)
    labels = [next(letters) if place in new else str(next(numbers)) for _ in range(turns) for place in places]
    return tuple(places), tuple(labels)
