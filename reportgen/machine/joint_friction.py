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
from reportgen.machine.forces import Equilibrium, Forces, Load, reaction_name
from reportgen.machine.motion import Complexes, Flags, Floats, LinkMotion, Motion, cross

ROUNDING = 1e-12
"""A rate below this share of those that it is the difference of stands still."""
STANDS = 1e-12
"""Of the greatest reaction: what a round changes by less than this has come to stand."""
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

    rounds: tuple[Forces, ...]
    """The reactions of each round; the first are those without friction, the last have come to stand."""
    loads: tuple[Load, ...]
    """What friction does to each link of each joint: couples of pins, forces of guides."""
    held: Mapping[str, Flags]
    """The joints by their reactions, with the positions [N] at which theirs does not stand."""

    @property
    def forces(self) -> Forces:
        """The reactions with friction, and the torque."""
        return self.rounds[-1]

    @property
    def stands(self) -> Flags:
        """Where the reactions came to stand [N]; elsewhere the mechanism locks, or is near it."""
        return np.asarray(~np.any(list(self.held.values()), axis=0))

    @property
    def torque(self) -> Floats:
        """The balancing torque with friction (N·m) [N], nan where the mechanism locks."""
        return np.where(self.stands, self.forces.torque, np.nan)


def relative_motion(joint: Joint, motion: Motion) -> tuple[Floats, Floats]:
    """How fast the second link of a joint turns (rad/s) or slides (m/s) against the first [N], and that rate's rate."""
    if joint.kind == "P":
        slide = motion.slides[joint.links]
        return slide.v, slide.a
    still = np.zeros_like(motion.driver)
    first, second = (motion.links.get(link, LinkMotion(still, still, still)) for link in joint.links)
    return second.omega - first.omega, second.epsilon - first.epsilon


def relative_sense(joint: Joint, motion: Motion) -> Floats:
    """The sign of a joint's relative motion [N]; where that stands still, of the motion that follows.

    What is below 1e-12 of the rates that it is the difference of is rounding.
    """
    rate, change = relative_motion(joint, motion)
    links = [motion.links[link] for link in joint.links if link != GROUND]
    size, size_of_change = (
        (largest(rate), largest(change))
        if joint.kind == "P"
        else (max(largest(link.omega) for link in links), max(largest(link.epsilon) for link in links))
    )
    follows = np.where(np.abs(change) > ROUNDING * size_of_change, np.sign(change), 0.0)
    return np.where(np.abs(rate) > ROUNDING * size, np.sign(rate), follows)


def pressing(friction: Friction, joint: Joint, motion: Motion, forces: Forces) -> Floats:
    """The force (N) [N] that presses the links of a joint together: R of a pin, |N| of a guide.

    Both ends of a wide slider that tilts press: |N₁| + |N₂|.
    """
    reaction = forces.reactions[reaction_name(*joint.links)]
    if joint.kind == "R":
        return np.abs(reaction.force)
    normal = cross(motion.slides[joint.links].direction, reaction.force)
    faces = friction.faces.get(joint.links[1])
    if faces is None:
        return np.abs(normal)
    first, last = faces.ends(normal, reaction.moment)
    return np.where(faces.tilts(normal, reaction.moment), np.abs(first) + np.abs(last), np.abs(normal))


def _rubbing(friction: Friction, joint: Joint, sense: Floats, motion: Motion, forces: Forces) -> tuple[Load, ...]:
    """What friction does at given reactions, against the `sense` [N] of the motion in a joint.

    M = −sgn(ω_rel) ρ R of a pin, F = −sgn(v) f |N| along a guide, at the face of a wide slider.
    """
    at, pressed = motion.points[joint.point].p, pressing(friction, joint, motion, forces)
    if joint.kind == "R":
        return _on_both(joint, np.zeros_like(at), at, -sense * friction.circles[joint.point] * pressed)
    along, slider = motion.slides[joint.links].direction, joint.links[1]
    if slider in friction.faces:
        at = at - 1j * along * friction.faces[slider].below
    return _on_both(joint, -sense * friction.coefficients[slider] * pressed * along, at, np.zeros_like(pressed))


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
    equilibrium = Equilibrium.of(linkage, motion)
    rounds = [frictionless or equilibrium.under(loads)]
    senses = {joint: relative_sense(joint, motion) for joint in friction.joints(linkage)}
    names = [reaction_name(*joint.links) for joint in senses]
    rubbing: tuple[Load, ...] = ()
    before = _forces_in(rounds[0], names)
    for _ in range(MOST_ROUNDS):
        with np.errstate(over="ignore", invalid="ignore"):
            rubbing = tuple(
                load for joint, sense in senses.items() for load in _rubbing(friction, joint, sense, motion, rounds[-1])
            )
            rounds.append(equilibrium.under((*loads, *rubbing)))
            after = _forces_in(rounds[-1], names)
            off = np.abs(after - before)
            open_ = motion.reachable & ~(off <= STANDS * np.max(np.abs(after), axis=0, initial=0.0))
        if not open_.any():
            break
        before = after
    return FrictionForces(tuple(rounds), rubbing, dict(zip(names, open_, strict=True)))


def _forces_in(forces: Forces, names: Sequence[str]) -> Complexes:
    """The reactions of some joints [joints, N]."""
    return np.array([forces.reactions[name].force for name in names]).reshape(len(names), -1)


def largest(values: Floats) -> float:
    """The greatest size among values that may be nan, 0 of none."""
    return float(np.nanmax(np.abs(values), initial=0.0))
