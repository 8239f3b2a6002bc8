"""What a case comes to besides its ledger: what holds at each position, and what holds for all of them, by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reportgen.case.balancing_entries import balancing_summary, shaken_entries
from reportgen.formula import ids
from reportgen.machine import Crank
from reportgen.machine.analysis import Analysis, Machine
from reportgen.machine.balance import BalancedTurn
from reportgen.machine.forces import Load
from reportgen.machine.joint_friction import FrictionForces
from reportgen.machine.true_motion import TrueMotion, at_positions, at_true_speeds

Entries = Mapping[str, Any]
"""Numbers (SI, radians), vectors of the plane as complex numbers, and tables of them, by name."""


@dataclass(frozen=True)
class ResultEntries:
    """The entries of each position, None where it cannot be reached, and those `besides`, which have no position."""

    positions: Sequence[Entries | None]
    besides: Entries = field(default_factory=dict)


def entries_of(analysis: Analysis, motion: TrueMotion | None = None, turn: BalancedTurn | None = None) -> ResultEntries:
    """The entries of a machine, with its true motion and its balancing if these are asked for."""
    signs = {f"{dyad.links[0]}{dyad.links[1]}": dyad.sign for dyad in analysis.machine.linkage.dyads}
    positions = [_position(analysis, k) for k in range(len(analysis.cycle_angle))]
    besides: dict[str, Any] = {"dyad_signs": signs}
    further: list[list[Entries]] = []
    if motion is not None:
        further.append([{"true_motion": of} for of in true_motion_entries(analysis, motion)])
        besides["true_motion"] = true_motion_summary(analysis.machine, motion)
    if turn is not None:
        further.append(list(shaken_entries(analysis, turn)))
        besides["balancing"] = balancing_summary(turn)
    for entries in further:
        positions = [None if entry is None else {**entry, **of} for entry, of in zip(positions, entries, strict=True)]
    return ResultEntries(positions, besides)


STATES = {"": "alone", "wheel": "with_flywheel"}


def true_motion_entries(analysis: Analysis, motion: TrueMotion) -> list[Entries]:
    """What holds at each position of the steady motion, by itself and with the flywheel; its reactions if asked for."""
    machine = analysis.machine
    at = {state: at_positions(machine, steady) for state, steady in motion.states.items()}
    true = at_true_speeds(analysis, motion.states[motion.shown]) if motion.asked.forces else None
    alone = motion.alone.run
    return [
        {
            "reduced_inertia": alone.inertia[at[""][k]] - motion.asked.inertia,
            "inertia_slope": alone.slope[at[""][k]],
            "reduced_torque": alone.torque[at[""][k]],
            **{
                STATES[state]: {
                    "drive": steady.run.drive[at[state][k]],
                    "energy": steady.run.energy[at[state][k]],
                    "omega": steady.run.speed[at[state][k]],
                    "epsilon": steady.run.acceleration[at[state][k]],
                    "time": steady.run.time[at[state][k]],
                }
                for state, steady in motion.states.items()
            },
            **({} if true is None else {"reactions": _reactions(true, k)}),
        }
        for k in range(machine.positions)
    ]


def _reactions(analysis: Analysis, k: int) -> Entries:
    return {name: reaction.force[k] for name, reaction in analysis.forces.reactions.items()}


def true_motion_summary(machine: Machine, motion: TrueMotion) -> Entries:
    """What the cycle comes to, start and stop, the choice of a motor."""
    entries: dict[str, Any] = {
        STATES[state]: {
            "fastest": {"omega": steady.fastest.speed, "cycle_angle": steady.fastest.angle},
            "slowest": {"omega": steady.slowest.speed, "cycle_angle": steady.slowest.angle},
            "mean": steady.mean,
            "unevenness": steady.unevenness,
            "period": steady.period,
            "work": steady.work,
            "power": steady.power,
        }
        for state, steady in motion.states.items()
    }
    if motion.started is not None:
        run, cycles = motion.started.run, len(motion.started.ends)
        entries["start"] = {"time": run.time[-1], "angle": run.angle[-1] - run.angle[0], "cycles": cycles}
    if motion.stopped is not None:
        run = motion.stopped
        entries["stop"] = {"time": run.time[-1], "angle": run.angle[-1] - run.angle[0]}
    if motors := motion.motors(machine):
        demand = motion.demand(machine)
        entries["motor"] = {
            "chosen": next((each.motor.name for each in motors if each.fits), None),
            "mean": demand.mean,
            "effective": demand.effective,
            "greatest": demand.most,
            "resistance": demand.resistance,
        }
    return entries


def _position(analysis: Analysis, k: int) -> Entries | None:
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
    entry["weights"] = _loads(analysis.weights, k)
    entry["inertia"] = _loads(analysis.inertia, k)
    if analysis.gas:
        entry["pressures"] = {f"p{gas.piston.link}": gas.pressure[k] for gas in analysis.gas.values()}
    reactions = analysis.forces.reactions.items()
    entry["reactions"] = {name: reaction.force[k] for name, reaction in reactions}
    entry["reactions_in_guides"] = {
        name: {"moment": reaction.moment[k], "point": reaction.point[k]}
        for name, reaction in reactions
        if _slides(analysis, name)
    }
    for name, tilts, first, last in map(analysis.at_ends, analysis.machine.faces):
        entry["reactions_in_guides"][name] |= {"tilts": bool(tilts[k]), "ends": [first[k], last[k]] if tilts[k] else []}
    entry["balancing_torque" if crank else "balancing_force"] = {
        "equilibrium": analysis.torque[k],
        "virtual_work": analysis.torque_by_work[k],
    }
    if analysis.with_friction is not None:
        entry["friction"] = _with_friction(analysis, analysis.with_friction, k)
    return entry


def _with_friction(analysis: Analysis, found: FrictionForces, k: int) -> Entries:
    """Reactions without the force along a guide, what friction does to the links, the torque and the efficiency.

    They are None where the mechanism locks.
    """
    balance = "torque" if isinstance(analysis.machine.linkage.driver, Crank) else "force"
    if not found.stands[k]:
        return {"reactions": dict.fromkeys(found.forces.reactions), "loads": {}, balance: None, "efficiency": None}
    torque = float(found.torque[k])
    drives = analysis.machine.turn * analysis.torque[k] > 0
    return {
        "reactions": {name: reaction.force[k] for name, reaction in found.forces.reactions.items()},
        "loads": _loads(found.loads, k),
        balance: torque,
        "efficiency": analysis.torque[k] / torque if drives else None,
    }


def _applied(analysis: Analysis, k: int) -> Entries:
    """Forces as vectors; a torque, which has no force, as it is in `weights` and `inertia`."""
    torques = {torque.name for torque in analysis.machine.torques}
    forces = {load.name: load.force[k] for load in analysis.applied if load.name not in torques}
    return {**forces, **_loads(tuple(load for load in analysis.applied if load.name in torques), k)}


def _loads(loads: tuple[Load, ...], k: int) -> Entries:
    return {load.name: {"force": load.force[k], "point": load.point[k], "couple": load.couple[k]} for load in loads}


def _slides(analysis: Analysis, name: str) -> bool:
    """Whether a reaction acts in a prismatic joint."""
    acting, on = ids.links_of(name)
    return (acting, on) in analysis.motion.slides or (on, acting) in analysis.motion.slides
