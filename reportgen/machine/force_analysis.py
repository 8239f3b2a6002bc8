"""Weights and inertia forces, the reactions in every joint, and the driver's balancing torque.

Every joint has two unknowns: the two components of a force in a revolute joint, the force across the guide and a
couple in a prismatic one. Two links and three joints give six equations with six unknowns for a group of class II of
any kind; four links and six joints give twelve for a group of class III.
All positions are solved in one batch. Groups are solved in reverse order of assembly, so that the reactions of each
become loads on the links that it hangs on. The work of the same loads gives the torque a second time, without any
reaction.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.formula import ids
from reportgen.machine import DRIVER, GROUND, Dyad, Group, Joint, Linkage, joints
from reportgen.machine.kinematics import Motion
from reportgen.machine.rigid_motion import cross, dot, solve2


@dataclass(frozen=True, slots=True)
class Load:
    """A force (N) at a point (m) of a link, and a couple (N·m); arrays over positions [N]."""

    name: str
    link: int
    force: Complexes
    point: Complexes
    couple: Floats

    def moment(self, about: Complexes | complex) -> Floats:
        """Return the moment about a point (N·m) [N]: (point − about) × force + couple."""
        return cross(self.point - about, self.force) + self.couple

    def power(self, motion: Motion) -> Floats:
        """Return F·v + M ω (W) [N]."""
        moved = motion.of(self.link, self.point).v
        return dot(self.force, moved) + self.couple * motion.links[self.link].omega


def weights(linkage: Linkage, motion: Motion) -> tuple[Load, ...]:
    """Return the weights m·g (N) [N] at the mass centres, named "G" and the link's number.

    Links without mass are skipped; without gravity there are no weights.
    """
    still = np.zeros_like(motion.driver)
    return tuple(
        Load(
            ids.weight(body.link),
            body.link,
            np.full(still.shape, body.mass * linkage.gravity, dtype=np.complex128),
            motion.points[body.centre].p,
            still,
        )
        for body in linkage.inertias
        if body.mass and linkage.gravity
    )


def inertia_loads(linkage: Linkage, motion: Motion) -> tuple[Load, ...]:
    """Return D'Alembert's loads [N], named "Pqt" and the link's number: −m a_S (N) at S with the couple −J ε (N·m)."""
    return tuple(
        Load(
            ids.inertia_force(body.link),
            body.link,
            -body.mass * motion.points[body.centre].a,
            motion.points[body.centre].p,
            -body.moment * motion.links[body.link].epsilon,
        )
        for body in linkage.inertias
        if body.mass or body.moment
    )


def as_single_force(load: Load) -> Complexes:
    """Return the point (m) [N] where a force F at S with couple M acts as the force alone: S − i F M / F².

    It lies at the distance |M|/|F| = J|ε|/(m|a_S|) from S, square to the force, on the side that gives
    M.  It is S itself where M = 0, and nan where F = 0 with M ≠ 0: a pure couple.
    """
    square = np.abs(load.force) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = -1j * load.force * (load.couple / np.where(square > 0, square, np.nan))
    return np.where(load.couple == 0, load.point, load.point + arm)


def percussion_points(
    a: Complexes, s: Complexes, a_a: Complexes, a_s: Complexes, l_sk: float
) -> tuple[Complexes, Complexes]:
    """Return the centre of percussion K of a link and the point Q of its single inertia force (m) [N], as found by
    drawing.

    Split a_S = a_A + a_SA: the part −m a_A acts along the line through S parallel to a_A, and the part of the turning
    about A along the line through K parallel to a_SA; K lies on AS, `l_sk` (m) beyond S.  The lines meet in Q, which is
    nan where they are parallel.  `a` and `s` are the places [N] of A and S (m), `a_a` and `a_s` their accelerations [N]
    (m/s²).
    """
    k = s + (s - a) / np.abs(s - a) * l_sk
    along, _ = solve2(a_a, a_a - a_s, k - s)
    return k, s + along * a_a


# --- work -------------------------------------------------------------------------------


def virtual_work_torque(linkage: Linkage, motion: Motion, loads: Sequence[Load]) -> Floats:
    """Return the driver's balancing torque M = −(ΣF·v + ΣMω)/ω₁ (N·m) [N]; with a sliding driver the force (N) [N].

    It is nan at positions that cannot be reached.

    The `loads` on links of `linkage` must include the inertia forces (D'Alembert's principle). Raises `ValueError`
    if the driver does not move.
    """
    if np.any(motion.rate == 0):
        raise ValueError("virtual work needs a moving driver")
    power = np.where(motion.reachable, 0.0, np.nan)
    for load in loads:
        power = power + load.power(motion)
    return -power / motion.rate


NO_FORCE = 1e-12
"""A force across a guide below this share of the group's largest force counts as a rounding error."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """The force of one link on another (N) [N] and, in a guide, its moment (N·m) [N] about the joint's point.

    `point` (m) [N] is the place of a revolute joint; in a guide it is where the single resultant crosses the guide's
    line, nan where the reaction is a pure couple.
    """

    force: Complexes
    point: Complexes
    moment: Floats


@dataclass(frozen=True, slots=True)
class Forces:
    """Reactions "R12" (link 1 on link 2) and "R21" for every joint, and the torque or force that balances the driver.

    `torque` [N] is the torque on the crank (N·m), or for a sliding driver the force along its guide (N).
    """

    reactions: Mapping[str, Reaction]
    torque: Floats


class _Wrench(NamedTuple):
    """A force at a point with a couple."""

    force: Complexes
    point: Complexes
    couple: Floats | float

    def moment(self, about: Complexes) -> Floats:
        """Return the moment about a point (N·m) [N]."""
        return cross(self.point - about, self.force) + self.couple


def reaction_name(source: int, target: int) -> str:
    """Return the key of the force of link `source` on link `target`: "R12"; "R1,12" with long numbers."""
    return ids.reaction_force(ids.joint(source, target))


def solve_forces(linkage: Linkage, motion: Motion, loads: Sequence[Load]) -> Forces:
    """Return the reactions and the driver's torque or force that balance `loads`; nan where a position is unreachable.

    Raises `KeyError` for a load on a link that does not move.
    """
    return Equilibrium.of(linkage, motion).under(loads)


@dataclass(frozen=True, slots=True)
class Equilibrium:
    """The equations of equilibrium of a linkage at the positions of a motion; `under` solves them for any loads."""

    motion: Motion
    links: tuple[int, ...]
    driving: Joint
    """The driver's joint with the ground."""
    groups: tuple[_Equations, ...]
    """Groups from the outermost on: the reactions in a group's joints are loads on the links that it hangs on."""

    @classmethod
    def of(cls, linkage: Linkage, motion: Motion) -> Equilibrium:
        """Return the equations of every Assur group, and those of the driver."""
        listed = joints(linkage)
        groups = (
            _Equations.of(group, tuple(joint for joint in listed if joint.group == group.links), motion)
            for group in reversed(linkage.groups)
        )
        return cls(motion, tuple(linkage.links), listed[0], tuple(groups))

    def under(self, loads: Iterable[Load]) -> Forces:
        """Return the reactions and the torque that balance `loads`.

        Raises `KeyError` for a load on a link that does not move.
        """
        motion = self.motion
        carried: dict[int, list[_Wrench]] = {link: [] for link in self.links}
        for load in loads:
            carried[load.link].append(_Wrench(load.force, load.point, load.couple))
        reactions: dict[str, Reaction] = {}
        for group in self.groups:
            wrenches = group.balance(carried, motion.reachable)
            largest = max(float(np.max(np.abs(one.force), initial=0.0, where=motion.reachable)) for one in wrenches)
            for joint, wrench in zip(group.joints, wrenches, strict=True):
                _enter(reactions, joint, wrench, motion, NO_FORCE * largest)
                source = joint.links[0]
                if source not in group.links and source != GROUND:
                    carried[source].append(_Wrench(-wrench.force, wrench.point, -wrench.couple))
        ground, torque = _drive(self.driving, motion, carried[DRIVER])
        _enter(reactions, self.driving, ground, motion, 0.0)
        return Forces(reactions, torque)


@dataclass(frozen=True, slots=True)
class _Equations:
    """The three equations of each link of a group.

    Rows: ΣF_x, ΣF_y, ΣM/l about the middle point of a dyad or the first inner joint of a triad, link by link; columns:
    two unknowns of each joint.  The length l only brings forces and moments to one size.
    """

    links: tuple[int, ...]
    joints: tuple[Joint, ...]
    pole: Complexes
    length: float
    columns: tuple[_Wrench, ...]
    matrix: Floats
    """Coefficients [N, 6, 6] or [N, 12, 12]; the unit matrix where the position is unreachable."""

    @classmethod
    def of(cls, group: Group, own: tuple[Joint, ...], motion: Motion) -> _Equations:
        """Return the equations of a group with its joints."""
        pole = motion.points[group.middle if isinstance(group, Dyad) else group.legs[0].inner].p
        size, valid = 3 * len(group.links), motion.reachable

        def farthest(points: Iterable[str]) -> float:
            return max(float(np.max(np.abs(motion.points[name].p - pole)[valid], initial=0.0)) for name in points)

        # The joints may coincide except for rounding errors; then the size of the mechanism replaces their distance.
        reach, whole = farthest(joint.point for joint in own), farthest(motion.points)
        length = reach if reach > NO_FORCE * whole else whole or 1.0
        matrix = np.zeros((size, size, pole.size))
        columns = tuple(column for joint in own for column in _unknowns(joint, motion, length))
        for row, link in zip(range(0, size, 3), group.links, strict=True):
            for column, wrench in enumerate(columns):
                joint = own[column // 2]
                if link in joint.links:
                    sense = 1.0 if link == joint.links[1] else -1.0
                    matrix[row : row + 3, column] = _components(wrench, pole, length, sense)
        matrix[:, :, ~valid] = np.eye(size)[:, :, None]
        return cls(group.links, own, pole, length, columns, np.ascontiguousarray(np.moveaxis(matrix, 2, 0)))

    def balance(self, carried: Mapping[int, Sequence[_Wrench]], valid: Flags) -> list[_Wrench]:
        """Return the wrenches of the joints on their second links, for the loads `carried` by the links."""
        size = 3 * len(self.links)
        known = np.zeros((size, self.pole.size))
        for row, link in zip(range(0, size, 3), self.links, strict=True):
            for wrench in carried[link]:
                known[row : row + 3] += _components(wrench, self.pole, self.length, -1.0)
        known[:, ~valid] = np.nan
        shares = np.linalg.solve(self.matrix, known.T[:, :, None])[:, :, 0].T
        return [
            _Wrench(
                first.force * shares[2 * k] + second.force * shares[2 * k + 1],
                first.point,
                first.couple * shares[2 * k] + second.couple * shares[2 * k + 1],
            )
            for k, (first, second) in enumerate(zip(self.columns[::2], self.columns[1::2], strict=True))
        ]


def _unknowns(joint: Joint, motion: Motion, length: float) -> tuple[_Wrench, _Wrench]:
    """Return the two unit wrenches that a joint can transmit, on its second link."""
    at = motion.points[joint.point].p
    still = np.zeros_like(at)
    if joint.kind == "R":
        return _Wrench(still + 1, at, 0.0), _Wrench(still + 1j, at, 0.0)
    return _Wrench(1j * motion.slides[joint.links].direction, at, 0.0), _Wrench(still, at, length)


def _components(wrench: _Wrench, pole: Complexes, length: float, sense: float) -> Floats:
    """Return ΣF_x, ΣF_y and ΣM/l of one wrench, [3, N]."""
    force = sense * wrench.force
    return np.array((force.real, force.imag, sense * wrench.moment(pole) / length))


def _enter(reactions: dict[str, Reaction], joint: Joint, wrench: _Wrench, motion: Motion, nothing: float) -> None:
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
    """Return the ground's wrench on the driver and its balance: M = −ΣM about the centre, or F = −ΣF·d."""
    at = motion.points[joint.point].p
    still = np.where(motion.reachable, 0.0, np.nan)
    force = sum((wrench.force for wrench in carried), still + 0j)
    moment = sum((wrench.moment(at) for wrench in carried), still)
    if joint.kind == "R":
        return _Wrench(-force, at, 0.0), -moment
    d = motion.slides[joint.links].direction
    return _Wrench(-1j * d * cross(d, force), at, -moment), -dot(d, force)
