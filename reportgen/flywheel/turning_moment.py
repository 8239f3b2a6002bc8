"""The kind `turning-moment`: a flywheel by the turning-moment diagram of a machine, and the checks of its data."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from reportgen.assignment.checks import of_parameters, one_of, same_length
from reportgen.base.errors import Finding
from reportgen.flywheel import turning_file
from reportgen.flywheel.turning_file import Torques

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.flywheel.turning_case import TurningCase

Parameters = turning_file.Parameters
TURNS = 1
PART = "turning"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
SIDES = ("driving", "resisting")
OPEN = 0.005
"""Largest sum of areas, as a share of the sum of their sizes, that counts as a slip of the planimeter."""
UNEVEN = 0.5
"""Largest fluctuation of speed of a machine with a flywheel."""


def case(assignment: Assignment) -> TurningCase:
    """Return the case of an assignment."""
    from reportgen.flywheel.turning_case import TurningCase

    return TurningCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the rows of results that `solve` prints: angles (°), areas and energies (J), the flywheel."""
    rows = {
        "intersections": {f"φ_{k}": math.degrees(at) for k, at in position.get("intersections", {}).items()},
        "areas": {f"A_{k}": area for k, area in position["areas"].items()},
        "energies": {f"E_{k}": energy for k, energy in position["energies"].items()},
    }
    symbols = {
        "mean": "M_m",
        "range": "ΔE",
        "power": "P",
        "speed": "ω_m",
        "delta": "δ",
        "inertia": "J",
        "mass": "m",
        "fastest": "ω_max",
        "slowest": "ω_min",
        "acceleration": "ε",
    }
    wheel = position["wheel"]
    rows["wheel"] = {symbol: wheel[name] for name, symbol in symbols.items() if name in wheel}
    return rows


# --- checks ---------------------------------------------------------------------------------------


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of the file, those of the run only if the diagrams themselves have none."""
    faults = [*_of_form(given), *_of_wheel(given)]
    for side in SIDES:
        if (torques := getattr(given, side)) is not None:
            faults += _of_torques(side, torques)
    yield from faults or _of_run(given)


def _of_form(given: Parameters) -> Iterator[Finding]:
    """Require areas, or a torque that varies."""
    driving, resisting, areas = given.driving, given.resisting, given.areas
    varies = driving is not None or (resisting is not None and resisting.varies)
    if areas is None and not varies:
        yield Finding("missing-key", (*TOP, "driving"), {"key": "driving | resisting | areas"})
    if areas is not None:
        for key in (*SIDES, "at"):
            if getattr(given, key) is not None:
                yield Finding("both-given", (*TOP, key), {"first": "areas", "second": key}, at="key")
        if areas.torque is not None and areas.angle is None:
            yield Finding("needs-besides", (*TOP, "areas", "torque"), {"key": "torque", "other": "angle"}, at="key")
        total, size = sum(areas.values), sum(map(abs, areas.values))
        if abs(total) > OPEN * size or not size:
            yield Finding("turning-areas-sum", (*TOP, "areas", "values"), {"sum": f"{total:g}"})
    if resisting is not None and resisting.law is not None:
        if resisting.varies:
            second = "terms" if resisting.terms else "phi"
            yield Finding("both-given", (*TOP, "resisting", second), {"first": "law", "second": second}, at="key")
        elif driving is None and areas is None:
            yield Finding("needs-besides", (*TOP, "resisting", "law"), {"key": "law", "other": "driving"}, at="key")


def _of_wheel(given: Parameters) -> Iterator[Finding]:
    if given.m is not None and given.k is None:
        yield Finding("needs-besides", (*TOP, "m"), {"key": "m", "other": "k"}, at="key")


def _of_torques(side: str, torques: Torques) -> Iterator[Finding]:
    """Require whole or half orders that differ, and a table that goes forward from 0."""
    where = (*TOP, side)
    orders = [term.order for term in torques.harmonics]
    for index, order in enumerate(orders):
        if (2 * order) % 1:
            yield Finding("turning-order", (*where, "terms", index, "order"), {"order": f"{order:g}"})
        elif order in orders[:index]:
            yield Finding("repeated", (*where, "terms", index, "order"), {"text": f"{order:g}"})
    if torques.terms and torques.mean is None and side == "driving":
        yield Finding("needs-besides", (*where, "terms"), {"key": "terms", "other": "mean"}, at="key")
    if torques.phi is None:
        return
    for key in ("M", "unit"):
        if getattr(torques, key) is None:
            yield Finding("needs-besides", (*where, "phi"), {"key": "phi", "other": key}, at="key")
            return
    angles = [angle.si for angle in torques.phi]
    if len(angles) > turning_file.MOST_NODES:
        yield Finding("too-many", (*where, "phi"), {"most": str(turning_file.MOST_NODES)})
    if angles[0]:
        yield Finding("table-end", (*where, "phi", 0), {"key": "phi", "end": "0 deg"})
    # Two rows at one angle are a jump, a third one is a slip.
    falls = [i + 1 for i, (one, following) in enumerate(pairwise(angles)) if following < one]
    falls += [i + 2 for i, ends in enumerate(zip(angles, angles[1:], angles[2:], strict=False)) if len({*ends}) == 1]
    if falls or not angles[-1]:
        yield Finding("not-increasing", (*where, "phi", min(falls, default=len(angles) - 1)), {"key": "phi"})


def _of_run(given: Parameters) -> Iterator[Finding]:
    """Require one cycle for both torques, work over it, and a flywheel that does not stall."""
    from reportgen.flywheel.turning_torques import cycle_of, diagram_of, mean_of, period_of, steady_run

    if given.areas is not None:
        return
    cycle, period = cycle_of(given), period_of(given.driving, given.resisting)
    for side in SIDES:
        torques = getattr(given, side)
        if torques is None or not (torques.terms or torques.nodes):
            continue
        own = torques.nodes[-1][0] if torques.nodes else period
        turns = cycle / own
        if abs(turns - round(turns)) > 1e-9 or (torques.nodes and own < cycle - 1e-9):
            ends = {"first": f"{np.degrees(own):g}", "second": f"{np.degrees(cycle):g}"}
            yield Finding("turning-cycles", (*TOP, side), ends, at="key")
            return
        if (torques.nodes or torques.mean is not None) and mean_of(torques) <= 0:
            yield Finding("turning-no-work", (*TOP, side), {"mean": f"{mean_of(torques):.4g}"}, at="key")
            return
    if given.driving is None and given.resisting is not None and given.resisting.terms and not given.resisting.mean:
        yield Finding("needs-besides", (*TOP, "resisting", "terms"), {"key": "terms", "other": "mean"}, at="key")
        return
    diagram = diagram_of(given)
    varies = "driving" if given.driving is not None else "resisting"
    if not diagram.crossings:
        yield Finding("turning-uniform", (*TOP, varies), at="key")
        return
    ω, J = given.n.si, given.J.si if given.J else None
    if given.m is not None and given.k is not None:
        J = given.m.si * given.k.si**2
    if J is not None:
        work = diagram.integral(np.array(diagram.points))
        δ = float(np.ptp(work)) / (J * ω**2)
        if δ > UNEVEN:
            key = "J" if given.J else "m"
            yield Finding("turning-light", (*TOP, key), {"delta": f"{δ:.3g}", "most": f"{UNEVEN:g}"})
            return
    if given.follows_speed:
        steady_run(given)


CHECKS = (
    one_of("parameters", "delta", "J", "m"),
    *(one_of(f"parameters.{side}", "terms", "phi", required=side == "driving") for side in SIDES),
    *(same_length(f"parameters.{side}", "phi", ("M",)) for side in SIDES),
    one_of("parameters.areas", "unit", "torque"),
    of_parameters(check),
)
