"""What a case comes to besides its ledger: what holds at each position, and what holds for all of them, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reportgen.formula import ids
from reportgen.machine import Crank
from reportgen.machine.analysis import Analysis, analyse
from reportgen.machine.balance import BalancedTurn, shaking_force, shaking_moment
from reportgen.machine.forces import Load

Entries = Mapping[str, Any]
"""Numbers (SI, radians), vectors of the plane as complex numbers, and tables of them, by name."""


@dataclass(frozen=True)
class ResultEntries:
    """The entries of each position, None where it cannot be reached, and those `besides`, which have no position."""

    positions: Sequence[Entries | None]
    besides: Entries = field(default_factory=dict)


def entries_of(analysis: Analysis, turn: BalancedTurn | None = None) -> ResultEntries:
    """The entries of a machine, with those of its balancing if that is asked for."""
    signs = {f"{dyad.links[0]}{dyad.links[1]}": dyad.sign for dyad in analysis.machine.linkage.dyads}
    positions = [_position(analysis, k) for k in range(len(analysis.cycle_angle))]
    if turn is None:
        return ResultEntries(positions, {"dyad_signs": signs})
    shaken = _shaken(analysis, turn)
    both = [None if entry is None else {**entry, **on_frame} for entry, on_frame in zip(positions, shaken, strict=True)]
    return ResultEntries(both, {"dyad_signs": signs, "balancing": _balancing(turn)})


def _shaken(analysis: Analysis, turn: BalancedTurn) -> Iterator[Entries]:
    """Force and moment on the frame at each position; with counterweights, what these change."""
    states = {"shaking": analysis} | ({"balanced": analyse(turn.balanced)} if turn.weights else {})
    arrays = {
        name: {
            "force": shaking_force(one.machine.linkage, one.motion),
            "moment": shaking_moment(one.machine.linkage, one.motion),
            **({} if name == "shaking" else {"R01": one.forces.reactions["R01"].force, "balancing_torque": one.torque}),
        }
        for name, one in states.items()
    }
    for k in range(len(analysis.cycle_angle)):
        yield {name: {what: values[k] for what, values in of.items()} for name, of in arrays.items()}


def _balancing(turn: BalancedTurn) -> Entries:
    """The force over the turn without a counterweight and by each rule, and the counterweights that are carried out."""
    speed2 = turn.machine.speed**2

    def over_the_turn(product: complex) -> Entries:
        greatest, angle = turn.curve.greatest(product)
        return {"greatest": greatest * speed2, "cycle_angle": angle, "rms": turn.curve.rms(product) * speed2}

    return {
        "unbalanced": over_the_turn(0j),
        "rules": {rule: {"product": product, **over_the_turn(product)} for rule, product in turn.products.items()},
        "counterweights": {
            str(weight.link): {"product": weight.product, "radius": weight.radius, "mass": weight.mass}
            for weight in turn.weights
        },
    }


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
    return entry


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
