"""The kind `friction`: small mechanisms with dry friction, and the checks of their data."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.friction import friction_file as friction_file
from reportgen.friction.friction_file import TASKS, Band, BeltOnDrum, Incline, Screw, Wedge

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.friction.exercise_case import FrictionCase

Parameters = friction_file.Parameters
TURNS = 1
PART = "friction"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
STEEPEST = math.radians(89)
"""Largest angle (rad) between a force and the direction in which it would jam; closer to 90° the force could not be
drawn.
"""


def case(assignment: Assignment) -> FrictionCase:
    """Return the case of an assignment."""
    from reportgen.friction.exercise_case import CASES

    return CASES[assignment.parameters.task](assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the row of results that `solve` prints, in the units of the task's entries (SI)."""
    return {
        task: {name: value for name, value in position[task].items() if name != "self_locking"}
        for task in TASKS
        if task in position
    }


# --- checks ---------------------------------------------------------------------------------------


def of_incline(given: Incline) -> Iterator[Finding]:
    """Require a force that presses the body on the plane and can move it up and down."""
    where, φ, α = (*TOP, "incline"), math.atan(given.f), given.alpha.si
    β = -α if given.beta is None else given.beta.si
    at = (*where, "beta" if "beta" in given.model_fields_set else "alpha")
    if α + β > STEEPEST:
        yield Finding("friction-lifts", at, {"sum": degrees(α + β)})
    elif φ - β > STEEPEST:
        yield Finding("friction-jams", at, {"sum": degrees(φ - β)})
    elif φ + β > STEEPEST:
        yield Finding("friction-jams-down", at, {"sum": degrees(φ + β)})


def of_wedge(given: Wedge) -> Iterator[Finding]:
    """Require a wedge that can be driven: cos(α + φ₁ + φ₃) > 0."""
    jammed = given.alpha.si + math.atan(given.f1) + math.atan(given.f3)
    if jammed > STEEPEST:
        yield Finding("friction-wedge-jams", (*TOP, "wedge", "alpha"), {"sum": degrees(jammed)})


def of_screw(given: Screw) -> Iterator[Finding]:
    """Require a thread that a torque can raise: γ + φ′ below a right angle."""
    γ = math.atan(given.n * given.p.si / (math.pi * given.d.si))
    jammed = γ + math.atan(given.f / math.cos(given.beta.si))
    if jammed > STEEPEST:
        yield Finding("friction-screw-jams", (*TOP, "screw", "p"), {"sum": degrees(jammed)})


def of_belt(given: BeltOnDrum) -> Iterator[Finding]:
    """Yield faults unless the tensions are finite numbers."""
    yield from wrapped("belt", given.f, given.theta)


def of_band(given: Band) -> Iterator[Finding]:
    """Require a lever that tightens the band when it is pressed."""
    yield from wrapped("band", given.f, given.theta)
    if given.a.si + given.b.si <= 0:
        yield Finding("friction-slackens", (*TOP, "band", "b"), {"a": given.a.text, "b": given.b.text})


MOST_GRIP = 20.0
"""Largest f θ (θ in rad): beyond it one tension is less than a millionth of a thousandth of the other."""


def wrapped(task: str, f: float, theta: Given) -> Iterator[Finding]:
    """Yield a fault if the friction `f` and the wrap angle `theta` (rad) make e^{fθ} too large."""
    if f * theta.si > MOST_GRIP:
        most = f"{math.floor(math.degrees(MOST_GRIP / f)):g}"
        yield Finding("friction-grip", (*TOP, task, "theta"), {"theta": theta.text, "most": most})


def degrees(angle: float) -> str:
    """Return an angle (rad) in degrees as text for a message."""
    return f"{math.degrees(angle):.4g}"


CHECKED: Mapping[str, Callable[[Any], Iterator[Finding]]] = {
    "incline": of_incline,
    "wedge": of_wedge,
    "screw": of_screw,
    "belt": of_belt,
    "band": of_band,
}


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of a task that depend on several values."""
    for task, look in CHECKED.items():
        if (of_task := getattr(given, task)) is not None:
            yield from look(of_task)


CHECKS = (one_of("parameters", *TASKS), one_of("parameters.belt", "S1", "S2", "M"), of_parameters(check))
