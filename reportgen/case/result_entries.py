"""Results of a machine for the command `solve`: a dictionary for each position, and one for the whole machine.

All values are in SI; points and forces are complex numbers x + iy.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from reportgen.base.records import Record, field
from reportgen.case.topic_results import RESULTS, Entries
from reportgen.formula import ids
from reportgen.machine import Crank
from reportgen.machine.analysis import Analysis
from reportgen.machine.force_analysis import Load


class ResultEntries(Record):
    """The entries of each position, None for one that the machine cannot reach, and the entries `besides` without a
    position.
    """

    positions: Sequence[Entries | None]
    besides: Entries = field(default_factory=dict)


def entries_of(analysis: Analysis) -> ResultEntries:
    """Return the entries of a machine; without loads, only its kinematics, else also forces and the topics' results."""
    signs = {f"{dyad.links[0]}{dyad.links[1]}": dyad.sign for dyad in analysis.machine.linkage.dyads}
    topics = tuple(RESULTS.among(analysis.machine.topics)) if analysis.loads else ()
    positions = [_position(analysis, k) for k in range(len(analysis.cycle_angle))]
    besides: dict[str, Any] = {"dyad_signs": signs}
    for hooks in topics:
        besides |= hooks.besides(analysis)
        for k, entry in enumerate(positions):
            if entry is not None:
                hooks.at_position(analysis, k, entry)
    return ResultEntries(positions, besides)


def _position(analysis: Analysis, k: int) -> dict[str, Any] | None:
    motion, linkage = analysis.motion, analysis.machine.linkage
    crank = isinstance(linkage.driver, Crank)
    if not motion.reachable[k]:
        return None
    entry: dict[str, Any] = {
        "number": k + 1,
        **({"label": analysis.machine.labels[k]} if analysis.machine.labels else {}),
        "crank_angle": motion.driver[k],
        **({} if crank else {"driver_way": abs(motion.driver[k] - analysis.machine.start)}),
        "cycle_angle": analysis.cycle_angle[k],
        "points": {
            name: {"p": point.p[k], "v": point.v[k], "a": point.a[k]}
            for name, point in motion.points.items()
            if name not in linkage.ground
        },
        "links": {
            number: {
                "angle": motion.links[number].angle[k],
                "omega": motion.links[number].omega[k],
                "epsilon": motion.links[number].epsilon[k],
            }
            for number in linkage.links
        },
    }
    if not analysis.loads:
        return entry
    entry["loads"] = _applied(analysis, k)
    entry["weights"] = load_entries(analysis.weights, k)
    entry["inertia"] = load_entries(analysis.inertia, k)
    if analysis.gas:
        entry["pressures"] = {f"p{gas.piston.link}": gas.pressure[k] for gas in analysis.gas.values()}
    reactions = analysis.forces.reactions.items()
    entry["reactions"] = {name: reaction.force[k] for name, reaction in reactions}
    entry["reactions_in_guides"] = {
        name: {"moment": reaction.moment[k], "point": reaction.point[k]}
        for name, reaction in reactions
        if _slides(analysis, name)
    }
    entry["balancing_torque" if crank else "balancing_force"] = {
        "equilibrium": analysis.torque[k],
        "virtual_work": analysis.torque_by_work[k],
    }
    return entry


def _applied(analysis: Analysis, k: int) -> Entries:
    """Return the applied forces as vectors; a torque, which has no force, has the same form as in `weights` and
    `inertia`.
    """
    torques = {torque.name for torque in analysis.machine.torques}
    forces = {load.name: load.force[k] for load in analysis.applied if load.name not in torques}
    return {**forces, **load_entries(tuple(load for load in analysis.applied if load.name in torques), k)}


def load_entries(loads: tuple[Load, ...], k: int) -> Entries:
    """Return force (N), point of application (m) and couple (N·m) of each load at the position of index `k`."""
    return {load.name: {"force": load.force[k], "point": load.point[k], "couple": load.couple[k]} for load in loads}


def _slides(analysis: Analysis, name: str) -> bool:
    """Return True if a reaction acts in a prismatic joint."""
    acting, on = ids.links_of(name)
    return (acting, on) in analysis.motion.slides or (on, acting) in analysis.motion.slides
