"""Friction in the joints: friction circles of pins, friction angles of guides, and the torque that overcomes them.

The reaction R of a pin with friction is tangent to the circle of radius ρ = f r about its centre, and that of a guide
leans by arctan f against the sliding.  So each joint brings a couple or a force that goes by its reaction,

    M_ij = −sgn(ω_j − ω_i) ρ R_ij,   F_ij = −sgn(v_ji) f |N_ij|,

on link j, and the opposite on link i.  They are put on the links as further loads and the links are balanced anew,
round after round, until the reactions stand (Artobolevsky's method of successive approximations).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from reportgen.formula import ids
from reportgen.machine import GROUND, Joint, Linkage, joints
from reportgen.machine.faces import Faces
from reportgen.machine.forces import Forces, Load, reaction_name, solve_forces
from reportgen.machine.motion import Complexes, Flags, Floats, Motion, cross

STANDS = 1e-13
"""Of the greatest reaction: rounding alone moves it in later rounds."""
MOST_ROUNDS = 200
"""A joint that wants more turns each round's change into one at least nine tenths as large: it locks, or nearly so."""


@dataclass(frozen=True)
class Friction:
    """What joints have friction: the radius ρ (m) of the friction circle by pin, f by the slider of a guide."""

    circles: Mapping[str, float] = field(default_factory=dict)
    coefficients: Mapping[int, float] = field(default_factory=dict)
    faces: Mapping[int, Faces] = field(default_factory=dict)
    """How wide sliders are, by their links: friction acts on each end that bears."""

    def joints(self, linkage: Linkage) -> tuple[Joint, ...]:
        """The joints that have friction, in the order of assembly."""
        return tuple(
            joint
            for joint in joints(linkage)
            if (joint.point in self.circles if joint.kind == "R" else joint.links[1] in self.coefficients)
        )


@dataclass(frozen=True)
class FrictionForces:
    """Reactions and balancing torque with friction, and how they came out; arrays over positions [N]."""

    forces: Forces
    loads: tuple[Load, ...]
    """What friction does to each link of each joint: couples of pins, forces of guides."""
    rounds: tuple[Floats, ...]
    """The balancing torque (N·m) after each round [N]; the first is that without friction."""
    stands: Flags
    """Where the reactions came to stand [N]; elsewhere the mechanism locks, or is near it."""
    held: Mapping[str, Flags]
    """The joints by their reactions, with the positions [N] at which theirs does not stand."""

    @property
    def torque(self) -> Floats:
        """The balancing torque with friction (N·m) [N], nan where the mechanism locks."""
        return np.where(self.stands, self.forces.torque, np.nan)


def sense(rate: Floats, next_rate: Floats, scale: float) -> Floats:
    """The sign of a motion [N]; where it stands still, which a rate below 1e-12 of `scale` does, of that to follow."""
    moves = np.abs(rate) > 1e-12 * scale
    return np.asarray(np.sign(np.where(moves, rate, next_rate)))


def relative_sense(joint: Joint, motion: Motion) -> Floats:
    """The sign [N] with which the second link of a joint turns or slides against the first."""
    if joint.kind == "P":
        slide = motion.slides[joint.links]
        return sense(slide.v, slide.a, _largest(slide.v))
    still = np.zeros_like(motion.driver)

    def turning(link: int, name: str) -> Floats:
        return still if link == GROUND else np.asarray(getattr(motion.links[link], name))

    rates = [turning(link, "omega") for link in joint.links]
    changes = [turning(link, "epsilon") for link in joint.links]
    return sense(rates[1] - rates[0], changes[1] - changes[0], max(map(_largest, rates)))


def friction_loads(friction: Friction, linkage: Linkage, motion: Motion, forces: Forces) -> tuple[Load, ...]:
    """What friction does at given reactions: on the second link of each joint, and the opposite on the first."""
    return tuple(
        load
        for joint in friction.joints(linkage)
        for load in (_in_pin if joint.kind == "R" else _in_guide)(friction, joint, motion, forces)
    )


def _in_pin(friction: Friction, joint: Joint, motion: Motion, forces: Forces) -> tuple[Load, ...]:
    """M = −sgn(ω_rel) ρ R."""
    reaction = forces.reactions[reaction_name(*joint.links)].force
    couple = -relative_sense(joint, motion) * friction.circles[joint.point] * np.abs(reaction)
    return _on_both(joint, np.zeros_like(reaction), motion.points[joint.point].p, couple)


def _in_guide(friction: Friction, joint: Joint, motion: Motion, forces: Forces) -> tuple[Load, ...]:
    """F = −sgn(v) f |N| along the guide; f (|N₁| + |N₂|) where the slider tilts, at its face."""
    reaction = forces.reactions[reaction_name(*joint.links)]
    along = motion.slides[joint.links].direction
    at = motion.points[joint.point].p
    normal = cross(along, reaction.force)
    carried = np.abs(normal)
    if (faces := friction.faces.get(joint.links[1])) is not None:
        first, last = faces.ends(normal, reaction.moment)
        carried = np.where(faces.tilts(normal, reaction.moment), np.abs(first) + np.abs(last), carried)
        at = at - 1j * along * faces.below
    force = -relative_sense(joint, motion) * friction.coefficients[joint.links[1]] * carried * along
    return _on_both(joint, force, at, np.zeros_like(normal))


def _on_both(joint: Joint, force: Complexes, at: Complexes, couple: Floats) -> tuple[Load, ...]:
    """A load on the second link of a joint, and the opposite on the first unless that is the frame."""
    first, second = joint.links
    on = [Load(ids.reaction_force(ids.joint(first, second)), second, force, at, couple)]
    if first != GROUND:
        on.append(Load(ids.reaction_force(ids.joint(second, first)), first, -force, at, -couple))
    return tuple(on)


def solve_with_friction(
    friction: Friction, linkage: Linkage, motion: Motion, loads: Sequence[Load], frictionless: Forces | None = None
) -> FrictionForces:
    """Balance every link under `loads` and the friction of its joints, which goes by the reactions.

    Positions at which the reactions do not come to stand are told, not raised: the mechanism locks there, or nearly so.
    """
    forces = frictionless or solve_forces(linkage, motion, loads)
    names = [reaction_name(*joint.links) for joint in friction.joints(linkage)]
    rounds = [forces.torque]
    rubbing: tuple[Load, ...] = ()
    before = _wrenches(forces, names)
    off = np.zeros(before.shape)
    for _ in range(MOST_ROUNDS):
        with np.errstate(over="ignore", invalid="ignore"):
            rubbing = friction_loads(friction, linkage, motion, forces)
            forces = solve_forces(linkage, motion, (*loads, *rubbing))
            after = _wrenches(forces, names)
            off = np.abs(after - before)
        rounds.append(forces.torque)
        if not np.any(off > STANDS * np.max(np.abs(after), axis=0, initial=0.0)):
            break
        before = after
    largest = np.max(np.abs(before), axis=0, initial=0.0)
    open_ = (off > STANDS * largest) | ~(np.isfinite(off) | ~motion.reachable)
    return FrictionForces(forces, rubbing, tuple(rounds), ~open_.any(axis=0), dict(zip(names, open_, strict=True)))


def _wrenches(forces: Forces, names: Sequence[str]) -> Complexes:
    """The reactions of some joints [joints, N]."""
    return np.array([forces.reactions[name].force for name in names]).reshape(len(names), -1)


def _largest(values: Floats) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))
