"""What a machine of the catalogue turns its parameters into: plain data that the rest of the house reads.

A catalogue file gives a `Machine`; nothing downstream asks which kind it is.  Quantities of its own
(synthesis, closed formulas) are `Item`s: definitions over other quantities of the ledger.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

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


@dataclass(frozen=True, slots=True)
class Piston:
    """A piston and the gas on it.

    `pin` is its point and `crank_pin` the other end of its rod; `top` and `bottom` are the pin's places at
    the dead centres, `top_angle` and `bottom_angle` the crank's turn there, in the direction of rotation.
    `phase` is its cycle angle at position 1, from its top dead centre at the start of intake.  A positive
    pressure pushes it along `inward`.
    """

    link: int
    rod: int
    pin: str
    crank_pin: str
    top: complex
    bottom: complex
    top_angle: float
    bottom_angle: float
    phase: float
    inward: complex
    bore: float
    indicator: Indicator

    @property
    def name(self) -> str:
        """The id of its gas force."""
        return f"P{self.link}"

    @property
    def stroke(self) -> float:
        return abs(self.top - self.bottom)

    @property
    def area(self) -> float:
        return float(np.pi * self.bore**2 / 4)


@dataclass(frozen=True, slots=True)
class Machine:
    """A mechanism with its drive, its loads and the outline of its report.

    Positions are numbered 1…`count` from driver angle `start` in the direction `turn` (+1 anticlockwise);
    the cycle of loads takes `turns` turns of the driver.  `given` items enter the ledger first, `formulas`
    after the plans; `drawn_crank` is the drawn length of the driver (m on paper).  `outline` names the
    report's sections in order.
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
    paths: tuple[str, ...] = ()
    """Points whose paths the position plan shows."""
    compared: tuple[tuple[str, str], ...] = ()
    """Pairs of a plan's quantity and its closed formula, compared in the report."""

    @property
    def positions(self) -> int:
        """Number of positions of the whole cycle."""
        return self.count * self.turns

    def angles(self, cycle_angle: np.ndarray) -> np.ndarray:
        """Driver angles at the given cycle angles."""
        return self.start + self.turn * cycle_angle


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
