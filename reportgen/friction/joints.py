"""Friction in the joints: friction circles of pins, friction angles of guides, and the torque that overcomes them.

The reaction R of a pin with friction is tangent to the circle of radius ρ = f r about its centre, and that of a guide
leans by arctan f against the sliding. So each joint contributes a couple or a force that depends on its reaction,

    M_ij = −sgn(ω_j − ω_i) ρ R_ij,   F_ij = −sgn(v_ji) f |N_ij|,

on link j, and the opposite on link i. They are applied to the links as further loads, and the links are balanced again,
round after round, until the reactions converge (Artobolevsky's method of successive approximations). If the rounds do
not converge, `bearing_equations` solves the equations of the position exactly; the mechanism locks only if they have no
solution.

A joint whose links never move against each other has no friction. `with_friction(analysis)` returns the result for a
machine.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.records import Record, field
from reportgen.formula import ids
from reportgen.friction.bearing_equations import BearingEquations
from reportgen.machine import GROUND, Joint, Linkage, joints
from reportgen.machine.analysis import Analysis, Machine
from reportgen.machine.force_analysis import Equilibrium, Forces, Load, Reaction, reaction_name
from reportgen.machine.kinematics import Motion
from reportgen.machine.motion_sense import pace, sense_of
from reportgen.machine.rigid_motion import LinkMotion, cross
from reportgen.machine.slider_faces import Faces

STANDS = 1e-12
"""A round that changes the reactions by less than this share of the greatest has converged."""
MOST_ROUNDS = 40
"""Largest number of rounds: if each halves the change, they converge by then; otherwise the equations are solved."""


class Friction(Record):
    """The friction of the joints: radius ρ (m) of the friction circle by pin, coefficient f by the slider of a
    guide.
    """

    circles: Mapping[str, float] = field(default_factory=dict)
    coefficients: Mapping[int, float] = field(default_factory=dict)
    faces: Mapping[int, Faces] = field(default_factory=dict)
    """Faces of wide sliders, by their links: friction acts on each end in contact."""

    def joints(self, linkage: Linkage) -> tuple[Joint, ...]:
        """Return the joints with friction, in the order of assembly."""
        return tuple(
            joint
            for joint in joints(linkage)
            if (joint.point in self.circles if joint.kind == "R" else joint.links[1] in self.coefficients)
        )


class FrictionForces(Record):
    """Reactions and balancing torque with friction, and the course of the solution; arrays over positions [N]."""

    rounds: tuple[Forces, ...]
    """Reactions of each round: the first are those without friction, the last have converged."""
    loads: tuple[Load, ...]
    """Friction loads on each link of each joint: couples of pins, forces of guides."""
    held: Mapping[str, Flags]
    """Flags [N] by the joint's reaction, True where it cannot be determined: the mechanism locks."""
    exact: Flags
    """Flags [N], True where the rounds do not converge and the equations give the last round."""

    @property
    def forces(self) -> Forces:
        """The reactions with friction, and the torque."""
        return self.rounds[-1]

    @property
    def in_equilibrium(self) -> Flags:
        """Flags [N], True where reactions with friction exist; elsewhere the mechanism locks."""
        return np.asarray(~np.any(list(self.held.values()), axis=0))

    @property
    def torque(self) -> Floats:
        """The balancing torque with friction (N·m) [N], nan where the mechanism locks."""
        return np.where(self.in_equilibrium, self.forces.torque, np.nan)


def relative_motion(joint: Joint, motion: Motion) -> tuple[Floats, Floats]:
    """Return the relative rate of a joint's second link against the first [N] (rad/s, or m/s for a slide) and its
    derivative.
    """
    if joint.kind == "P":
        slide = motion.slides[joint.links]
        return slide.v, slide.a
    still = np.zeros_like(motion.driver)
    first, second = (motion.links.get(link, LinkMotion(still, still, still)) for link in joint.links)
    return second.omega - first.omega, second.epsilon - first.epsilon


def relative_sense(joint: Joint, motion: Motion) -> Floats:
    """Return the sign of a joint's relative motion [N]; at rest, that of the motion that follows.

    It is 0 where both are only rounding errors relative to the speed of the mechanism: the links do not move against
    each other.
    """
    rate, change = relative_motion(joint, motion)
    moves, hastens = pace(motion, joint.kind)
    sense = sense_of(rate, moves)
    return np.asarray(np.where(sense != 0, sense, sense_of(change, hastens)))


def reactions_that_press(friction: Friction, joint: Joint, motion: Motion, forces: Forces) -> tuple[Complexes, ...]:
    """Return the reactions (N) [N] whose sizes press a joint's links together: R of a pin; N of a guide, as a number.

    A wide slider has two, N₁ and N₂ at its ends, which add up to N unless it tilts.
    """
    reaction = forces.reactions[reaction_name(*joint.links)]
    if joint.kind == "R":
        return (reaction.force,)
    normal = cross(motion.slides[joint.links].direction, reaction.force)
    faces = friction.faces.get(joint.links[1])
    of_ends = (normal,) if faces is None else faces.ends(normal, reaction.moment)
    return tuple(np.asarray(end, dtype=np.complex128) for end in of_ends)


def pressing(friction: Friction, joint: Joint, motion: Motion, forces: Forces) -> Floats:
    """Return the force (N) [N] that presses a joint's links together: R, |N|, or |N₁| + |N₂| for the ends of a
    slider.
    """
    return np.asarray(sum(np.abs(each) for each in reactions_that_press(friction, joint, motion, forces)))


def _rubbing(friction: Friction, joint: Joint, sense: Floats, motion: Motion, pressed: Floats) -> tuple[Load, ...]:
    """Return the friction loads of a joint that is `pressed` together (N) [N], against the `sense` [N] of its motion.

    M = −sgn(ω_rel) ρ R for a pin, F = −sgn(v) f |N| along a guide, at the face of a wide slider.
    """
    at = motion.points[joint.point].p
    if joint.kind == "R":
        return _on_both(joint, np.zeros_like(at), at, -sense * friction.circles[joint.point] * pressed)
    along, slider = motion.slides[joint.links].direction, joint.links[1]
    if slider in friction.faces:
        at = at - 1j * along * friction.faces[slider].below
    return _on_both(joint, -sense * friction.coefficients[slider] * pressed * along, at, np.zeros_like(pressed))


def _on_both(joint: Joint, force: Complexes, at: Complexes, couple: Floats) -> tuple[Load, ...]:
    """Return a load on the second link of a joint, and the opposite on the first unless that is the frame."""
    first, second = joint.links
    on = [Load(ids.reaction_force(ids.joint(first, second)), second, force, at, couple)]
    if first != GROUND:
        on.append(Load(ids.reaction_force(ids.joint(second, first)), first, -force, at, -couple))
    return tuple(on)


def solve_with_friction(
    friction: Friction, linkage: Linkage, motion: Motion, loads: Sequence[Load], frictionless: Forces | None = None
) -> FrictionForces:
    """Solve for the reactions (N) and the balancing torque (N·m) [N] under `loads` and the friction of the joints.

    `frictionless` are the reactions without friction, computed if not given.  Values are nan at positions where the
    mechanism locks: no reactions agree with the friction that they cause.
    """
    equilibrium = Equilibrium.of(linkage, motion)
    rounds = [frictionless or equilibrium.under(loads)]
    senses = {joint: relative_sense(joint, motion) for joint in friction.joints(linkage)}
    names = [reaction_name(*joint.links) for joint in senses]

    def rubbing(pressed: Sequence[Floats]) -> tuple[Load, ...]:
        """Return the friction of all joints, each `pressed` together (N) [N]."""
        each = zip(senses.items(), pressed, strict=True)
        return tuple(load for (joint, sense), p in each for load in _rubbing(friction, joint, sense, motion, p))

    def pressed_by(forces: Forces) -> list[Floats]:
        return [pressing(friction, joint, motion, forces) for joint in senses]

    rubs: tuple[Load, ...] = ()
    before, open_ = _forces_in(rounds[0], names), np.zeros((len(names), motion.driver.size), dtype=np.bool_)
    for _ in range(MOST_ROUNDS):
        rubs = rubbing(pressed_by(rounds[-1]))
        rounds.append(equilibrium.under((*loads, *rubs)))
        after = _forces_in(rounds[-1], names)
        off = np.abs(after - before)
        open_ = motion.reachable & ~(off <= STANDS * np.max(np.abs(after), axis=0, initial=0.0))
        if not open_.any():
            break
        before = after
    unsettled = open_.any(axis=0)
    locked = np.zeros_like(unsettled)
    if unsettled.any():
        exact = _exactly(friction, senses, motion, rounds[0], equilibrium, rubbing)
        pressed = np.where(unsettled, exact, pressed_by(rounds[-1]))
        locked = np.asarray(unsettled & np.isnan(pressed).any(axis=0))
        rubs = rubbing(list(np.where(locked, 0.0, pressed)))
        rounds.append(_without(equilibrium.under((*loads, *rubs)), locked))
    held = {name: each & locked for name, each in zip(names, open_, strict=True)}
    return FrictionForces(tuple(rounds), rubs, held, unsettled & ~locked)


def _exactly(
    friction: Friction,
    senses: Mapping[Joint, Floats],
    motion: Motion,
    frictionless: Forces,
    equilibrium: Equilibrium,
    rubbing: Callable[[Sequence[Floats]], tuple[Load, ...]],
) -> Floats:
    """Return the forces (N) that press the joints together [joints, N] by the exact equations, nan without a
    solution.
    """

    def reactions(forces: Forces) -> list[Complexes]:
        return [each for joint in senses for each in reactions_that_press(friction, joint, motion, forces)]

    still = np.zeros_like(motion.driver)
    ones = np.eye(len(senses))
    causes = [reactions(equilibrium.under(rubbing([still + each for each in row]))) for row in ones]
    counts = [len(reactions_that_press(friction, joint, motion, frictionless)) for joint in senses]
    return BearingEquations(
        joint=np.repeat(np.arange(len(senses)), counts),
        guides=np.repeat([joint.kind == "P" for joint in senses], counts),
        base=np.array(reactions(frictionless)),
        slope=np.moveaxis(np.array(causes), 0, 1),
    ).solve()


def _without(forces: Forces, at: Flags) -> Forces:
    """Return the forces with nan at some positions [N]."""
    unknown = np.where(at, np.nan, 0.0)
    return Forces(
        {
            name: Reaction(reaction.force + unknown, reaction.point + unknown, reaction.moment + unknown)
            for name, reaction in forces.reactions.items()
        },
        forces.torque + unknown,
    )


def friction_of(machine: Machine) -> Friction | None:
    """Return the friction of a machine's joints; None if there is none."""
    return machine.topic("friction", Friction)


def with_friction(analysis: Analysis) -> FrictionForces:
    """Return reactions and torque with friction, for a machine whose file requests friction; they are computed once."""
    return analysis.derived(_solved)


def _solved(analysis: Analysis) -> FrictionForces:
    friction = friction_of(analysis.machine)
    assert friction is not None, "nothing rubs"
    linkage = analysis.machine.linkage
    return solve_with_friction(friction, linkage, analysis.motion, analysis.loads, analysis.forces)


def _forces_in(forces: Forces, names: Sequence[str]) -> Complexes:
    """Return the reactions of some joints [joints, N]."""
    return np.array([forces.reactions[name].force for name in names]).reshape(len(names), -1)
