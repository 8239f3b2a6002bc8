"""The results of an analysis as plain data: SI units, radians, unrounded (format reportgen-results/1)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from reportgen.analysis import Analysis
from reportgen.case import Case
from reportgen.mechanism.loads import Load
from reportgen.mechanism.structure import Crank

FORMAT = "reportgen-results/1"


def results(case: Case) -> dict[str, Any]:
    """The contract's JSON object of a case: one entry a position, null where it cannot be reached."""
    assignment, analysis = case.assignment, case.analysis
    machine = analysis.machine
    return {
        "format": FORMAT,
        "kind": assignment.kind,
        "variant": assignment.variant,
        "units": "SI",
        "dyad_signs": {f"{dyad.links[0]}{dyad.links[1]}": dyad.sign for dyad in machine.linkage.dyads},
        "positions": [_position(analysis, k) for k in range(len(analysis.cycle_angle))],
    }


def _position(analysis: Analysis, k: int) -> dict[str, Any] | None:
    motion, linkage = analysis.motion, analysis.machine.linkage
    crank = isinstance(linkage.driver, Crank)
    if not motion.reachable[k]:
        return None
    entry: dict[str, Any] = {
        "number": k + 1,
        **({"label": analysis.machine.labels[k]} if analysis.machine.labels else {}),
        "crank_angle": float(motion.driver[k]),
        **({} if crank else {"driver_way": float(abs(motion.driver[k] - analysis.machine.start))}),
        "cycle_angle": float(analysis.cycle_angle[k]),
        "points": {
            name: {"p": _pair(point.p[k]), "v": _pair(point.v[k]), "a": _pair(point.a[k])}
            for name, point in motion.points.items()
            if name not in linkage.ground
        },
        "links": {
            str(number): {
                "angle": float(motion.links[number].angle[k]),
                "omega": float(motion.links[number].omega[k]),
                "epsilon": float(motion.links[number].epsilon[k]),
            }
            for number in linkage.links
        },
    }
    if not analysis.loads:
        return entry
    entry["loads"] = _applied(analysis, k)
    entry["weights"] = _loads(analysis.weights, k)
    entry["inertia"] = _loads(analysis.inertia, k)
    if analysis.gas:
        entry["pressures"] = {
            name.replace("P", "p"): float(gas.pressure[k]) for name, gas in analysis.gas.items()
        }
    reactions = analysis.forces.reactions.items()
    entry["reactions"] = {name: _pair(reaction.force[k]) for name, reaction in reactions}
    entry["reactions_in_guides"] = {
        name: {"moment": float(reaction.moment[k]), "point": _pair(reaction.point[k])}
        for name, reaction in reactions
        if _slides(analysis, name)
    }
    entry["balancing_torque" if crank else "balancing_force"] = {
        "equilibrium": float(analysis.torque[k]),
        "virtual_work": float(analysis.torque_by_work[k]),
    }
    return entry


def _applied(analysis: Analysis, k: int) -> dict[str, Any]:
    """Forces as [x, y]; a torque, which has no force, as it is in `weights` and `inertia`."""
    torques = {torque.name for torque in analysis.machine.torques}
    forces = {load.name: _pair(load.force[k]) for load in analysis.applied if load.name not in torques}
    return {**forces, **_loads(tuple(load for load in analysis.applied if load.name in torques), k)}


def _loads(loads: tuple[Load, ...], k: int) -> Mapping[str, Any]:
    return {
        load.name: {
            "force": _pair(load.force[k]),
            "point": _pair(load.point[k]),
            "couple": float(load.couple[k]),
        }
        for load in loads
    }


def _slides(analysis: Analysis, name: str) -> bool:
    """Whether a reaction acts in a prismatic joint."""
    digits = name.removeprefix("R")
    one, other = digits.split(",") if "," in digits else (digits[0], digits[1:])
    pair = (int(one), int(other))
    return pair in analysis.motion.slides or pair[::-1] in analysis.motion.slides


def _pair(value: complex) -> list[float] | None:
    """[x, y], or null for a point that does not exist."""
    if not np.isfinite(value):
        return None
    return [float(np.real(value)), float(np.imag(value))]
