"""Model of the file of a synthesis: the task, the wanted motion, and the datum that selects a solution."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import (
    Angle,
    Decimal,
    Interval,
    Length,
    NumberOrAngle,
    SpeedRatio,
    SwingAngle,
    quantity,
)
from reportgen.base.template_access import template_members
from reportgen.base.units import Given

CRANK_ROCKER, SLIDER_CRANK, THREE_POINTS = "crank-rocker", "slider-crank", "three-points"
OF_FUNCTION = "x", "driver", "follower"
"""Keys that a function requires."""
OF_ANGLES = "sin", "tan"
"""Functions whose argument is an angle."""
KEYS = {
    CRANK_ROCKER: ("K", "psi", "c", "a", "d", "best", "A"),
    SLIDER_CRANK: ("K", "H", "e", "best"),
    THREE_POINTS: ("function", "exponent", *OF_FUNCTION, "pairs", "d"),
}
"""Keys that a task can have, besides `gamma`."""
REQUIRED = {CRANK_ROCKER: ("K", "psi", "c"), SLIDER_CRANK: ("K", "H"), THREE_POINTS: ("d",)}

Argument = Annotated[Given, NumberOrAngle(Interval(least=-1e6, most=1e6), quantity("deg", least=-720, most=720))]
Arguments = Annotated[tuple[Argument, ...], Field(min_length=2, max_length=2)]
Exponent = Annotated[float, Decimal(Interval(least=-10, most=10))]
TwoAngles = Annotated[tuple[Angle, ...], Field(min_length=2, max_length=2)]
ThreePairs = Annotated[tuple[TwoAngles, ...], Field(min_length=3, max_length=3)]
TransmissionAngle = Annotated[Given, quantity("deg", least=1, most=89)]
USUAL = Given(0.6981317007977318, 40.0, "deg", "40 deg")
"""Usual least transmission angle."""


@template_members("task", "a", "d", "e", "best", "function")
class Parameters(Part):
    """The wanted motion of a mechanism, and what selects a solution.

    A crank-rocker has the swing `psi` and the length `c` of its rocker; the crank `a`, the frame `d` or the `best`
    transmission selects a solution; its A may be required to be `beyond` the chord of the rocker's pin or `before` it.
    A slider-crank has the stroke `H`; the offset `e` or the `best` transmission selects a solution. A four-bar linkage
    through three points has the frame `d` and three `pairs` of angles of crank and follower from the frame line AD, or
    a `function` of `x` (an angle for sin and tan), which runs from end to end while the crank turns over the range
    `driver` and the follower over the range `follower`.
    """

    task: Literal["crank-rocker", "slider-crank", "three-points"]
    K: SpeedRatio | None = None
    psi: SwingAngle | None = None
    c: Length | None = None
    a: Length | None = None
    d: Length | None = None
    H: Length | None = None
    e: Length | None = None
    best: Literal["transmission"] | None = None
    A: Literal["beyond", "before"] | None = None
    function: Literal["ln", "exp", "power", "sin", "tan"] | None = None
    exponent: Exponent | None = None
    x: Arguments | None = None
    driver: TwoAngles | None = None
    follower: TwoAngles | None = None
    pairs: ThreePairs | None = None
    gamma: TransmissionAngle = USUAL
