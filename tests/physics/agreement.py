"""What is found beside the independent answer of `newton_euler`, quantity by quantity."""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Mapping, Sequence

import newton_euler as ne

from reportgen.machine.analysis import Analysis
from reportgen.machine.force_analysis import Forces
from reportgen.machine.kinematics import Motion

AGREEMENT = 1e-9
"""Of each quantity's greatest size over the positions."""
CONDITION = 1e4
"""The Jacobian mixes metres and radians: small machines condition it worse, and ε·10⁴·10² is still within 1e-9."""
ASSEMBLED = 1e-12
"""How far the joints may stand open (m, rad), as poses are made of other roundings."""

Pairs = dict[str, list[tuple[complex, complex]]]
"""Ours and theirs, by kind of quantity."""
Pose = Mapping[int, tuple[complex, float]]
"""The origin (m) and angle of each body."""
Acting = tuple[int, complex, complex, float]
"""A load as plain numbers: body, force, point, couple."""


def collect(pairs: Pairs, motion: Motion, forces: Forces, keys: Sequence[str], answer: ne.Answer, k: int) -> None:
    """Add velocities, accelerations, reactions (by their names in the order of the joints) and effort at index k."""
    for link, (velocity, omega) in answer.velocity.items():
        if link:
            acceleration, epsilon = answer.acceleration[link]
            pairs.setdefault("v", []).append((motion.origins[link].v[k], velocity))
            pairs.setdefault("a", []).append((motion.origins[link].a[k], acceleration))
            pairs.setdefault("ω", []).append((motion.links[link].omega[k], omega))
            pairs.setdefault("ε", []).append((motion.links[link].epsilon[k], epsilon))
    for key, (force, couple) in zip(keys, answer.wrenches, strict=True):
        pairs.setdefault("R", []).append((forces.reactions[key].force[k], force))
        pairs.setdefault("moment", []).append((forces.reactions[key].moment[k], couple))
    pairs.setdefault("effort", []).append((forces.torque[k], answer.effort))


def off(pairs: Pairs, floor: Mapping[str, float]) -> dict[str, float]:
    """The largest difference of each kind, over its own greatest size or a `floor` under that."""
    return {
        name: max(abs(ours - theirs) for ours, theirs in found)
        / max(floor[name], *(abs(theirs) for _, theirs in found))
        for name, found in pairs.items()
    }


def prove(
    analysis: Analysis,
    bodies: dict[int, ne.Body],
    joints: Sequence[ne.Pin | ne.Slot],
    keys: Sequence[str],
    poses: Iterable[Pose],
    loads: Iterable[Sequence[Acting]],
    turning: bool = True,
) -> None:
    """Assert that a whole analysis is what the witness has from plain numbers: at each position a pose and its loads.

    Places, rates, reactions by the names of the joints, and the driver's effort by equilibrium and by virtual work.
    """
    motion = analysis.motion
    pairs: Pairs = {}
    for k, (pose, acting) in enumerate(zip(poses, loads, strict=True)):
        answer = ne.solve(bodies, list(joints), turning, float(motion.rate[k]), dict(pose), list(acting), CONDITION)
        assert answer is not None
        assert answer.residual < ASSEMBLED
        collect(pairs, motion, analysis.forces, keys, answer, k)
        pairs.setdefault("p", []).extend((motion.origins[link].p[k], place) for link, (place, _) in pose.items())
        pairs["effort"].append((analysis.torque_by_work[k], answer.effort))
    # A couple in a guide may be nothing throughout: it is read against the forces at 1 m.
    floor = dict.fromkeys(pairs, 0.0) | {"moment": max(abs(theirs) for _, theirs in pairs["R"])}
    wrong = {name: part for name, part in off(pairs, floor).items() if not part <= AGREEMENT}
    assert wrong == {}


def weights(bodies: Mapping[int, ne.Body], pose: Pose, gravity: complex) -> list[Acting]:
    """The weights of bodies in a pose; `gravity` is a vector (m/s²)."""
    return [
        (body, it.mass * gravity, pose[body][0] + it.centre * cmath.rect(1.0, pose[body][1]), 0.0)
        for body, it in bodies.items()
        if it.mass
    ]
