"""Reactions in every joint and the driver's balancing torque, by equilibrium of the links.

Every joint holds two unknowns: the two components of a force in a revolute joint, the force across
the guide and a couple in a prismatic one.  Two links and three joints make six equations with six
unknowns, whatever the kind of the group; all positions are solved in one batch.  Groups are taken in
the reverse of their assembly, so that each hands its reactions on to links not yet balanced.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from reportgen.mechanism.dyads import Complexes, Floats, cross, dot
from reportgen.mechanism.loads import Load
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import DRIVER, GROUND, Dyad, Joint, Linkage, joints

NOTHING = 1e-12
"""A force across a guide below this part of the group's largest is rounding."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """The force of one link on another (N) and, in a guide, its moment (N·m) about the joint's point.

    `point` (m) is the joint in a revolute joint; in a guide it is where the single resultant crosses
    the guide's line, nan where the reaction is a pure couple.
    """

    force: Complexes
    point: Complexes
    moment: Floats


@dataclass(frozen=True, slots=True)
class Forces:
    """Reactions "R12" (link 1 on link 2) and "R21" for every joint, and what balances the driver.

    `torque` is the torque on the crank (N·m), or for a sliding driver the force along its guide (N).
    """

    reactions: Mapping[str, Reaction]
    torque: Floats


class _Wrench(NamedTuple):
    """A force at a point with a couple."""

    force: Complexes
    point: Complexes
    couple: Floats | float

    def moment(self, about: Complexes) -> Floats:
        return cross(self.point - about, self.force) + self.couple


def reaction_name(source: int, target: int) -> str:
    """The key of the force of link `source` on link `target`: "R12"; "R1,12" with long numbers."""
    return f"R{source}{target}" if max(source, target) < 10 else f"R{source},{target}"


def solve_forces(linkage: Linkage, motion: Motion, loads: Sequence[Load]) -> Forces:
    """Balance every link under `loads`; nan where the position is unreachable.

    Raises `KeyError` for a load on a link that does not move.
    """
    carried: dict[int, list[_Wrench]] = {link: [] for link in linkage.links}
    for load in loads:
        carried[load.link].append(_Wrench(load.force, load.point, load.couple))
    reactions: dict[str, Reaction] = {}
    listed = joints(linkage)
    for dyad in reversed(linkage.dyads):
        own = tuple(joint for joint in listed if joint.group == dyad.links)
        wrenches = _balance(dyad, own, motion, carried)
        largest = max(
            float(np.max(np.abs(wrench.force), initial=0.0, where=motion.reachable)) for wrench in wrenches
        )
        for joint, wrench in zip(own, wrenches, strict=True):
            _enter(reactions, joint, wrench, motion, NOTHING * largest)
            source = joint.links[0]
            if source not in dyad.links and source != GROUND:
                carried[source].append(_Wrench(-wrench.force, wrench.point, -wrench.couple))
    ground, torque = _drive(listed[0], motion, carried[DRIVER])
    _enter(reactions, listed[0], ground, motion, 0.0)
    return Forces(reactions, torque)


def _balance(
    dyad: Dyad, own: tuple[Joint, ...], motion: Motion, carried: Mapping[int, list[_Wrench]]
) -> list[_Wrench]:
    """The wrenches of a group's joints on their second links.

    Rows: ΣF_x, ΣF_y, ΣM/l about the middle point, of the one link and of the other; columns: two
    unknowns of each joint.  The length l only brings forces and moments to one size.
    """
    pole = motion.points[dyad.middle].p
    valid = motion.reachable
    reach = max(
        float(np.max(np.abs(motion.points[joint.point].p - pole)[valid], initial=0.0)) for joint in own
    )
    length = reach or 1.0
    matrix = np.zeros((6, 6, pole.size))
    known = np.zeros((6, pole.size))
    columns = [column for joint in own for column in _unknowns(joint, motion, length)]
    for row, link in zip((0, 3), dyad.links, strict=True):
        for column, wrench in enumerate(columns):
            joint = own[column // 2]
            if link in joint.links:
                sense = 1.0 if link == joint.links[1] else -1.0
                matrix[row : row + 3, column] = _components(wrench, pole, length, sense)
        for wrench in carried[link]:
            known[row : row + 3] += _components(wrench, pole, length, -1.0)
    matrix[:, :, ~valid] = np.eye(6)[:, :, None]
    known[:, ~valid] = np.nan
    found = np.linalg.solve(np.moveaxis(matrix, 2, 0), known.T[:, :, None])[:, :, 0].T
    return [
        _Wrench(
            first.force * found[2 * k] + second.force * found[2 * k + 1],
            first.point,
            first.couple * found[2 * k] + second.couple * found[2 * k + 1],
        )
        for k, (first, second) in enumerate(zip(columns[::2], columns[1::2], strict=True))
    ]


def _unknowns(joint: Joint, motion: Motion, length: float) -> tuple[_Wrench, _Wrench]:
    """The two unit wrenches that a joint can hold, on its second link."""
    at = motion.points[joint.point].p
    still = np.zeros_like(at)
    if joint.kind == "R":
        return _Wrench(still + 1, at, 0.0), _Wrench(still + 1j, at, 0.0)
    return _Wrench(1j * motion.slides[joint.links].direction, at, 0.0), _Wrench(still, at, length)


def _components(wrench: _Wrench, pole: Complexes, length: float, sense: float) -> Floats:
    """ΣF_x, ΣF_y and ΣM/l of one wrench, [3, N]."""
    force = sense * wrench.force
    return np.stack((force.real, force.imag, sense * wrench.moment(pole) / length))


def _enter(
    reactions: dict[str, Reaction], joint: Joint, wrench: _Wrench, motion: Motion, nothing: float
) -> None:
    """List a joint's reaction in both directions; a force up to `nothing` has no line of action."""
    source, target = joint.links
    point = wrench.point
    moment = np.broadcast_to(np.asarray(wrench.couple, dtype=np.float64), point.shape)
    if joint.kind == "P":
        d = motion.slides[joint.links].direction
        across = cross(d, wrench.force)
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = moment / np.where(np.abs(across) > nothing, across, np.nan)
        point = np.where(moment == 0, point, point + d * offset)
    reactions[reaction_name(source, target)] = Reaction(wrench.force, point, moment)
    reactions[reaction_name(target, source)] = Reaction(-wrench.force, point, -moment)


def _drive(joint: Joint, motion: Motion, carried: Sequence[_Wrench]) -> tuple[_Wrench, Floats]:
    """The ground's wrench on the driver and what balances it: M = −ΣM about the centre, or F = −ΣF·d."""
    at = motion.points[joint.point].p
    still = np.where(motion.reachable, 0.0, np.nan)
    force = sum((wrench.force for wrench in carried), still + 0j)
    moment = sum((wrench.moment(at) for wrench in carried), still)
    if joint.kind == "R":
        return _Wrench(-force, at, 0.0), -moment
    d = motion.slides[joint.links].direction
    return _Wrench(-1j * d * cross(d, force), at, -moment), -dot(d, force)
