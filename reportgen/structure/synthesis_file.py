"""Model of the file of a synthesis: the task, the wanted motion, and the datum that selects a solution."""

from __future__ import annotations

from typing import Annotated, Literal

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Length, SpeedRatio, SwingAngle, quantity
from reportgen.base.template_access import template_members
from reportgen.base.units import Given

CRANK_ROCKER, SLIDER_CRANK = "crank-rocker", "slider-crank"
OF_TASK = {CRANK_ROCKER: ("psi", "c", "a", "d", "A"), SLIDER_CRANK: ("H", "e")}
"""Keys of a task that the others do not have; the first are required."""
REQUIRED = {CRANK_ROCKER: ("psi", "c"), SLIDER_CRANK: ("H",)}

TransmissionAngle = Annotated[Given, quantity("deg", least=1, most=89)]
USUAL = Given(0.6981317007977318, 40.0, "deg", "40 deg")
"""Usual least transmission angle."""


@template_members("task", "a", "d", "e", "best")
class Parameters(Part):
    """The wanted motion of a mechanism, and what selects a solution.

    A crank-rocker has the swing `psi` and the length `c` of its rocker; the crank `a`, the frame `d` or the `best`
    transmission selects a solution; its A may be required to be `beyond` the chord of the rocker's pin or `before` it.
    A slider-crank has the stroke `H`; the offset `e` or the `best` transmission selects a solution.
    """

    task: Literal["crank-rocker", "slider-crank"]
    K: SpeedRatio
    psi: SwingAngle | None = None
    c: Length | None = None
    a: Length | None = None
    d: Length | None = None
    H: Length | None = None
    e: Length | None = None
    best: Literal["transmission"] | None = None
    A: Literal["beyond", "before"] | None = None
    gamma: TransmissionAngle = USUAL
