"""Weights and inertia forces, the reactions in every joint, and the driver's balancing torque.

Groups are solved in reverse order of assembly (`machine.group_equilibrium`), so that the reactions of each become loads
on the links that it hangs on. The work of the same loads gives the torque a second time, without any reaction.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record
from reportgen.formula import ids
from reportgen.machine import DRIVER, GROUND, Joint, Linkage, joints
from reportgen.machine.group_equilibrium import NO_FORCE, DyadEquilibrium, TriadEquilibrium, Wrench, equilibrium_of
from reportgen.machine.kinematics import Motion
from reportgen.machine.rigid_motion import cross, dot, solve2


class Load(Record):
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
        return dot(self.force, motion.velocity(self.link, self.point)) + self.couple * motion.links[self.link].omega


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


class Reaction(Record):
    """The force of one link on another (N) [N] and, in a guide, its moment (N·m) [N] about the joint's point.

    `point` (m) [N] is the place of a revolute joint; in a guide it is where the single resultant crosses the guide's
    line, nan where the reaction is a pure couple.
    """

    force: Complexes
    point: Complexes
    moment: Floats


class Forces(Record):
    """Reactions "R12" (link 1 on link 2) and "R21" for every joint, and the torque or force that balances the driver.

    `torque` [N] is the torque on the crank (N·m), or for a sliding driver the force along its guide (N).
    """

    reactions: Mapping[str, Reaction]
    torque: Floats


def reaction_name(source: int, target: int) -> str:
    """Return the key of the force of link `source` on link `target`: "R12"; "R1,12" with long numbers."""
    return ids.reaction_force(ids.joint(source, target))


def solve_forces(linkage: Linkage, motion: Motion, loads: Sequence[Load]) -> Forces:
    """Return the reactions and the driver's torque or force that balance `loads`; nan where a position is unreachable.

    Raises `KeyError` for a load on a link that does not move.
    """
    return Equilibrium.of(linkage, motion).under(loads)


class Equilibrium(Record):
    """The equations of equilibrium of a linkage at the positions of a motion; `under` solves them for any loads."""

    motion: Motion
    links: tuple[int, ...]
    driving: Joint
    """The driver's joint with the ground."""
    groups: tuple[DyadEquilibrium | TriadEquilibrium, ...]
    """Groups from the outermost on: the reactions in a group's joints are loads on the links that it hangs on."""

    @classmethod
    def of(cls, linkage: Linkage, motion: Motion) -> Equilibrium:
        """Return the equations of every Assur group, and those of the driver."""
        listed = joints(linkage)
        groups = (
            equilibrium_of(group, tuple(joint for joint in listed if joint.group == group.links), motion)
            for group in reversed(linkage.groups)
        )
        return cls(motion, tuple(linkage.links), listed[0], tuple(groups))

    def under(self, loads: Iterable[Load]) -> Forces:
        """Return the reactions and the torque that balance `loads`.

        Raises `KeyError` for a load on a link that does not move.
        """
        motion = self.motion
        carried: dict[int, list[Wrench]] = {link: [] for link in self.links}
        for load in loads:
            carried[load.link].append(Wrench(load.force, load.point, load.couple))
        reactions: dict[str, Reaction] = {}
        for group in self.groups:
            wrenches = group.balance(carried)
            largest = max(float(np.max(np.abs(one.force), initial=0.0, where=motion.reachable)) for one in wrenches)
            for joint, wrench in zip(group.joints, wrenches, strict=True):
                _enter(reactions, joint, wrench, motion, NO_FORCE * largest)
                source = joint.links[0]
                if source not in group.links and source != GROUND:
                    carried[source].append(Wrench(-wrench.force, wrench.point, -wrench.couple))
        ground, torque = _drive(self.driving, motion, carried[DRIVER])
        _enter(reactions, self.driving, ground, motion, 0.0)
        return Forces(reactions, torque)


def _enter(reactions: dict[str, Reaction], joint: Joint, wrench: Wrench, motion: Motion, nothing: float) -> None:
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


def _drive(joint: Joint, motion: Motion, carried: Sequence[Wrench]) -> tuple[Wrench, Floats]:
    """Return the ground's wrench on the driver and its balance: M = −ΣM about the centre, or F = −ΣF·d."""
    at = motion.points[joint.point].p
    still = np.where(motion.reachable, 0.0, np.nan)
    force = sum((wrench.force for wrench in carried), still + 0j)
    moment = sum((wrench.moment(at) for wrench in carried), still)
    if joint.kind == "R":
        return Wrench(-force, at, 0.0), -moment
    d = motion.slides[joint.links].direction
    return Wrench(-1j * d * cross(d, force), at, -moment), -dot(d, force)
