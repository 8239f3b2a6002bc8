"""Effects of friction over a whole cycle: the mean torque, and the dead zones in which a slider cannot move the
crank.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reportgen.base.arrays import Flags, Floats
from reportgen.base.records import Record, replace
from reportgen.friction.joints import Friction, friction_of, relative_motion, solve_with_friction, with_friction
from reportgen.machine import Joint
from reportgen.machine.analysis import ROUNDING, Machine, analyse, breaks, motion_at, possible
from reportgen.machine.force_analysis import Load
from reportgen.machine.load_laws import FULL_TURN, STEPS, Stroke, halved, opposing
from reportgen.machine.motion_sense import greatest_speed, moving
from reportgen.machine.quadrature import mean_over

HALVINGS = 40
"""Enough halvings to reach the spacing of floats."""
FARTHEST = np.radians(80.0)
"""A slider that cannot move its crank at this distance (rad) from a dead centre cannot move it anywhere."""


def turning_back(machine: Machine, joint: Joint) -> Iterator[float]:
    """Yield the cycle angles (rad) at which the relative rotation or sliding of a joint's links reverses."""

    def rate(angle: Floats) -> Floats:
        motion = motion_at(machine, angle)
        return moving(relative_motion(joint, motion)[0], greatest_speed(motion, joint.kind))

    if rate(np.linspace(0.0, FULL_TURN, 64)).any():
        for turn in range(machine.turns):
            yield from (turn * FULL_TURN + angle for angle in opposing(1.0, rate).reversals)


def mean_torque(machine: Machine) -> float:
    """Return the mean of the balancing torque with friction (N·m) over the cycle; nan if the mechanism locks anywhere.

    Raises `ValueError` for a machine without friction.
    """
    friction = friction_of(machine)
    if friction is None:
        raise ValueError("nothing rubs")
    corners = [angle for joint in friction.joints(machine.linkage) for angle in turning_back(machine, joint)]

    def torque(angle: Floats) -> Floats:
        solved = with_friction(analyse(machine, angle))
        if not solved.in_equilibrium.all():
            raise _LocksError
        return solved.torque

    whole = machine.turns * FULL_TURN
    sampled = analyse(machine, np.linspace(0.0, whole, STEPS))
    least = ROUNDING * possible(sampled.motion, sampled.loads)
    try:
        return mean_over(torque, np.mod([*corners, *breaks(machine)], whole), 0.0, whole, least)
    except _LocksError:
        return np.nan


class _LocksError(Exception):
    """The mechanism locks somewhere in the cycle."""


class DeadZone(Record):
    """Angles (rad) `before` and `behind` the dead centre at cycle angle `centre` within which a slider cannot move
    its crank.
    """

    centre: float
    before: float
    behind: float


def dead_zones(machine: Machine, friction: Friction, stroke: Stroke) -> tuple[DeadZone, ...]:
    """Return the dead zones of a slider that drives its crank with a constant force; other masses and loads are
    ignored.

    Within them friction consumes all work of the slider: the torque to apply to the crank no longer opposes its motion.
    The angles are nan if the slider cannot move the crank anywhere.
    """
    bare = replace(machine, applied=(), torques=(), linkage=replace(machine.linkage, inertias=()))

    def stuck(angle: Floats) -> Flags:
        motion = motion_at(bare, angle.ravel())
        pin = motion.points[stroke.pin]
        along = stroke.inward * np.where(stroke.fraction_rate(motion) >= 0, 1.0, -1.0)
        load = Load("P", stroke.link, along, pin.p, np.zeros(angle.size))
        solved = solve_with_friction(friction, bare.linkage, motion, [load])
        drives = np.asarray(machine.turn * solved.torque < 0)
        return np.asarray(~drives.reshape(angle.shape))

    def reach(centre: float, sense: int) -> float:
        _, high = halved(np.array([0.0]), np.array([FARTHEST]), lambda way: stuck(centre + sense * way), HALVINGS)
        moves = not stuck(centre + sense * np.array([FARTHEST]))[0]
        return float(high[0]) if moves else np.nan

    centres = [float(np.mod(angle - stroke.phase, FULL_TURN)) for angle in stroke.dead_centres[:2]]
    return tuple(DeadZone(centre, reach(centre, -1), reach(centre, 1)) for centre in centres)
