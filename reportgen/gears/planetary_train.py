"""The kind `planetary-train`: its case, faults of impossible trains, and warnings about unusual ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.base.errors import Finding
from reportgen.gears import train_file
from reportgen.gears.tooth_numbers import (
    CONDITIONS,
    DUST,
    LEAST_DIFFERENCE,
    LEAST_OUTER,
    SCHEMES,
    Train,
    efficiency,
    mended,
)
from reportgen.gears.train_file import undercut_wheels

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.gears.train_case import TrainCase

Parameters = train_file.Parameters
TURNS = 1
PART = "train"
"""Prefix of its ids, also in a coursework."""
HAS_POSITIONS = False
TOP = ("parameters",)


def case(assignment: Assignment) -> TrainCase:
    """Return the case of an assignment."""
    from reportgen.gears.train_case import TrainCase

    return TrainCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the row that `solve` prints for a position of the results: the angular velocities (rad/s)."""
    return {"wheels": {f"ω{name}": wheel["omega"] for name, wheel in position["wheels"].items()}}


# --- faults -------------------------------------------------------------------------------------


def teeth_of(train: Train) -> str:
    """Return tooth numbers as messages write them: z₁/z₂/z₃."""
    z = train.teeth
    return f"{z.z1}/{z.z2}/{z.z3}" if SCHEMES[train.scheme].single else "/".join(map(str, z))


def _rows(given: Parameters) -> Iterator[Finding]:
    """Yield findings for ordinary wheels with too few teeth, and for rows whose wheels cannot mesh."""
    for key, rows in (("before", given.before), ("behind", given.behind)):
        for i, row in enumerate(rows):
            for j, teeth in enumerate(row):
                outer = teeth > 0 or row[1 - j] < 0
                least = given.least_teeth if outer else row[1 - j] + LEAST_DIFFERENCE
                if (teeth if outer else -teeth) < least:
                    ends = f"≥ {least}" if outer else f"≤ −{least}"
                    yield Finding("out-of-range", (*TOP, key, i, j), {"text": str(teeth), "range": ends})
                    break


def _locked(given: Parameters, train: Train) -> Iterator[Finding]:
    """Yield a finding if torques are asked of a train that locks itself."""
    losses = given.efficiency
    if given.torque is None or losses is None:
        return
    of_meshes = tuple(losses.inner if inner else losses.outer for inner in SCHEMES[given.scheme].inner)
    if efficiency(float(train.ratio), of_meshes[0] * of_meshes[1], given.by_carrier) <= 0:
        yield Finding("train-locked", (*TOP, "torque"), at="key")


def check(given: Parameters) -> Iterator[Finding]:
    """Yield faults of keys and limits; then, if no tooth numbers fulfil the demand, the condition that fails."""
    if (given.u is None) == (given.n_out is None):
        return  # another check says so
    if SCHEMES[given.scheme].single and given.m2 is not None:
        yield Finding("train-one-module", (*TOP, "m2"), at="key")
        return
    if given.least > given.z.to:
        yield Finding("train-limits", (*TOP, "z", "to"), {"least": str(given.least), "most": str(given.z.to)})
        return
    if few := list(_rows(given)):
        yield from few
        return
    if given.u is not None and given.u.si in (0, 1):
        yield Finding("train-no-ratio", (*TOP, "u"), {"u": given.u.text})
        return
    choice = given.choice
    if len(choice.sets):
        yield from _locked(given, choice.chosen)
        return
    failed = next(name for name in CONDITIONS if not choice.left[name])
    wanted, limits = given.wanted, {"least": str(given.least), "most": str(given.z.to)}
    about = {"u": f"{wanted:.6g}", "k": str(given.k), "outer": str(given.least_teeth), **limits}
    if failed in ("ratio", "interference"):
        key = ("u",) if given.u is not None else ("n_out",)
        if choice.nearest is None:
            yield Finding("train-interference", (*TOP, "z"), about)
            return
        nearest = given.of_input(float(choice.nearest.ratio)) if choice.nearest.ratio else math.inf
        off = float(choice.demand.off(float(choice.nearest.ratio)))
        about |= {"nearest": f"{nearest:.6g}", "teeth": teeth_of(choice.nearest), "tolerance": given.tolerance.text}
        if off < 1:
            about |= {"enough": f"{math.ceil(off * 1e5) / 1e5:g}"}
        yield Finding("train-ratio", (*TOP, *key), about)
        return
    others = mended(choice.demand)
    mend = {"others": ", ".join(map(str, others))} if others else {}
    yield Finding(f"train-{failed}", (*TOP, "k"), about | mend)


CHECKS = (one_of("parameters", "u", "n_out"), of_parameters(check))


# --- warnings -----------------------------------------------------------------------------------


def physics(assignment: Assignment) -> Iterator[Finding]:
    """Yield warnings about a ratio that is not met exactly, and inner wheels that mesh only with profile shift."""
    given: Parameters = assignment.parameters
    choice = given.choice
    reached = float(choice.chosen.ratio)
    if abs(reached - choice.demand.ratio) > DUST * abs(reached):
        key = "u" if given.u is not None else "n_out"
        met = {"u": f"{given.wanted:.6g}", "reached": f"{given.of_input(reached):.6g}"}
        yield Finding("train-off", (*TOP, key), met)
    undercut = undercut_wheels(given, choice.chosen)
    if undercut:
        wheels = ", ".join(f"z{wheel} = {teeth}" for wheel, teeth in undercut.items())
        shift = (LEAST_OUTER - min(undercut.values())) / LEAST_OUTER
        yield Finding("train-undercut", (*TOP, "least_teeth"), {"wheels": wheels, "shift": f"{shift:.3f}"})
    if not choice.free[choice.first]:
        yield Finding("train-shift", (*TOP, "z"), {"teeth": teeth_of(choice.chosen)})


WARNINGS = (physics,)
