"""What a machine of the catalogue turns its parameters into: plain data that the rest of the house reads.

A catalogue file gives a `Machine`; nothing downstream asks which kind it is.  Quantities of its own
(synthesis, closed formulas) are `Item`s: definitions over other quantities of the ledger.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from reportgen.catalogue.course import Course
from reportgen.catalogue.laws import Law, TableLaw
from reportgen.cycle.indicator import Indicator
from reportgen.mechanism.structure import Linkage
from reportgen.notation.expressions import PI, Expression, Symbol, divide, multiply
from reportgen.units import Given


@dataclass(frozen=True, slots=True)
class Item:
    """A quantity that a machine adds to the ledger: given (`value`, SI) or defined over other ids."""

    id: str
    symbol: Symbol
    kind: str
    value: Any = None
    definition: Expression | None = None
    traits: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Piston(Course):
    """A piston and the gas on it; its cycle angle counts from its top at the start of intake.

    A positive pressure pushes it along `inward`, towards the crank.
    """

    bore: float
    indicator: Indicator

    @property
    def name(self) -> str:
        """The id of its gas force."""
        return f"P{self.link}"

    @property
    def area(self) -> float:
        """A = π D²/4 (m²)."""
        return float(np.pi * self.bore**2 / 4)

    @property
    def law(self) -> TableLaw:
        """Pressure times area."""
        return TableLaw(self, self.indicator, self.area)


@dataclass(frozen=True)
class Applied:
    """A force that is neither weight nor inertia: its law times the unit vector `direction`, at `point`."""

    name: str
    link: int
    point: str
    direction: complex
    law: Law


def gas_forces(pistons: Iterable[Piston]) -> tuple[Applied, ...]:
    """The gas on each piston."""
    return tuple(Applied(one.name, one.link, one.pin, one.inward, one.law) for one in pistons)


class Position(int):
    """The number of a position, from 1, that is written as its label."""

    label: str

    def __new__(cls, number: int, label: str = "") -> Position:
        position = super().__new__(cls, number)
        position.label = label or str(int(number))
        return position

    def __str__(self) -> str:
        return self.label


@dataclass(frozen=True, slots=True)
class Machine:
    """A mechanism with its drive, its loads and the outline of its report.

    A turn has `count` positions, numbered from driver angle `start` in the direction `turn` (+1
    anticlockwise); the cycle of loads takes `turns` turns of the driver.  `given` items enter the ledger
    first, `formulas` after the plans.  `outline` names the report's sections in order.
    """

    kind: str
    linkage: Linkage
    start: float
    turn: int
    speed: float
    count: int
    turns: int
    given: tuple[Item, ...]
    formulas: tuple[Item, ...]
    outline: tuple[str, ...]
    pistons: tuple[Piston, ...] = ()
    applied: tuple[Applied, ...] = ()
    """All forces that are neither weight nor inertia, the gas on `pistons` among them."""
    sliders: tuple[Course, ...] = ()
    """Sliders with dead centres, the pistons among them."""
    paths: tuple[str, ...] = ()
    """Points whose paths the position plan shows."""
    compared: tuple[tuple[str, str], ...] = ()
    """Pairs of a plan's quantity and its closed formula, compared in the report."""
    places: tuple[float, ...] = ()
    """Cycle angles of the positions of one turn; empty: evenly spaced from 0."""
    labels: tuple[str, ...] = ()
    """What the positions of the cycle are called; empty: their numbers."""

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
        """Driver angles at the given cycle angles."""
        return self.start + self.turn * cycle_angle

    def position(self, number: int) -> Position:
        """A position by its number from 1."""
        return Position(number, self.labels[number - 1] if self.labels else "")

    def numbered(self, numbers: Iterable[int]) -> tuple[Position, ...]:
        return tuple(map(self.position, numbers))


def ratio_item(id: str, symbol: Symbol, given: Given) -> Item:
    """A ratio as typed: `1/3.6` is worked out on the page, `0.35` is given."""
    top, slash, bottom = given.text.partition("/")
    if slash:
        return Item(id, symbol, "ratio", definition=divide(float(top), float(bottom)))
    return Item(id, symbol, "ratio", given.si)


def speed_items(n: Given | None, omega: Given | None) -> tuple[Item, ...]:
    """The driver's angular velocity ω₁ (its size): given, or ω₁ = 2πn/60 from the speed in rpm."""
    symbol = Symbol("ω", "1")
    if n is None:
        assert omega is not None, "a file without speed is refused by the kind's checks"
        return (Item("omega.1", symbol, "angular velocity", omega.si),)
    rpm = n.value if n.unit == "rpm" else n.si * 30 / np.pi
    return (
        Item("n", Symbol("n"), "speed of rotation", rpm),
        Item("omega.1", symbol, "angular velocity", definition=divide(multiply(2, PI, "n"), 60)),
    )
