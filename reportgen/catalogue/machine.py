"""What a machine of the catalogue turns its parameters into: plain data that the rest of the house reads.

A catalogue file gives a `Machine`; nothing downstream asks which kind it is.  Quantities of its own
(synthesis, closed formulas) are `Item`s: definitions over other quantities of the ledger.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase
from typing import Any

import numpy as np

from reportgen.catalogue.course import Course
from reportgen.catalogue.laws import Law, TableLaw
from reportgen.cycle.applied import Indicator
from reportgen.mechanism.structure import Linkage
from reportgen.notation.expressions import PI, Chain, Expression, Symbol, divide, multiply
from reportgen.units import Given

NEAR = 1e-6
"""Positions nearer than this (rad) are one."""


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

    @classmethod
    def on(cls, course: Course, bore: float, indicator: Indicator) -> Piston:
        """The piston that is the slider of a course."""
        return cls(**vars(course), bore=bore, indicator=indicator)

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


@dataclass(frozen=True)
class Torque:
    """A torque on a link that is no inertia couple: its law (N·m), anticlockwise positive."""

    name: str
    link: int
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
    torques: tuple[Torque, ...] = ()
    """Torques other than inertia couples."""
    sliders: tuple[Course, ...] = ()
    """Sliders with dead centres, the pistons among them."""
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


def mass_items(link: int, weight: Given | None, mass: Given | None) -> tuple[Item, ...]:
    """Weight and mass of a link: one as typed, the other from it; none of a link without mass."""
    number = str(link)
    if weight is not None:
        return (
            Item(f"G{link}", Symbol("G", number), "weight", weight.si),
            Item(f"m.{link}", Symbol("m", number), "mass", definition=divide(f"G{link}", "g")),
        )
    if mass is not None:
        return (
            Item(f"m.{link}", Symbol("m", number), "mass", mass.si),
            Item(f"G{link}", Symbol("G", number), "weight", definition=multiply(f"m.{link}", "g")),
        )
    return ()


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
