"""The flywheel that keeps a machine's speed within bounds, by energy and reduced inertia.

M_r(φ) is the reduced torque of the loads, and a constant torque M_c = −mean M_r acts against it. The excess work is
A(φ) = ∫(M_r + M_c) dφ. With the reduced moment of inertia J_r(φ) of the links and J_d of the flywheel, ½(J_d + J_r)
ω² = E₀ + A. The bounds ω_m(1 ± δ/2) are just met where the lines of slope ½ω² touch the curve A over J_r
(Wittenbauer):  a = max(A − ½ω_max² J_r),  b = min(A − ½ω_min² J_r), J_d = (a − b)/(δ ω_m²).
"""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.machine.analysis import Analysis, Machine, analyse, breaks, possible
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.quadrature import accumulated
from reportgen.machine.reduction import reduced_inertia, reduced_torque
from reportgen.machine.regulated_cycle import RegulatedCycle
from reportgen.machine.shared_results import LOST_TORQUE, REGULATED_CYCLE

ORDER = 8
"""Gauss nodes between neighbouring angles: exact to rounding for a degree or less of a smooth torque."""


def regulate(
    angle: Floats, torque: Floats, work: Floats, inertia: Floats, speed: float, unevenness: float
) -> RegulatedCycle:
    """Return the flywheel for mean speed ω_m and unevenness δ, from M_r, its work ∫M_r dφ and J_r at angles [N].

    The angles span the whole cycle.  `moment` is 0 or less where the links alone are even enough; the speed is
    then not that of a flywheel, and nan.
    """
    mean = float(work[-1] / (angle[-1] - angle[0]))
    excess = work - mean * (angle - angle[0])
    fastest, slowest = speed * (1 + unevenness / 2), speed * (1 - unevenness / 2)
    above, below = excess - fastest**2 * inertia / 2, excess - slowest**2 * inertia / 2
    high, low = int(above.argmax()), int(below.argmin())
    upper, lower = float(above[high]), float(below[low])
    moment = (upper - lower) / (unevenness * speed**2)
    energy = fastest**2 * moment / 2 - upper
    squared = 2 * (energy + excess) / (moment + inertia) if moment > 0 else np.full(angle.shape, np.nan)
    return RegulatedCycle(
        angle=angle,
        torque=torque,
        constant=-mean,
        inertia=inertia,
        work=excess,
        upper=upper,
        lower=lower,
        moment=moment,
        speed=np.sqrt(squared),
        fastest=fastest,
        slowest=slowest,
        high=high,
        low=low,
        unevenness=unevenness,
    )


SAMPLES = 1440
"""Angles of a turn at which the extremes of energy are looked for: a quarter degree misses less than 1e-5."""
SAME_ANGLE = 1e-9
"""Angles closer than this (rad) are equal; a torque below this share of the possible torque is zero."""


def _torque(analysis: Analysis) -> Floats:
    """Return M_r [N] (N·m) of weights and applied loads."""
    return reduced_torque(analysis.machine, analysis.motion, (*analysis.weights, *analysis.applied))


def flywheel(machine: Machine, unevenness: float) -> RegulatedCycle:
    """Return the flywheel (kg·m²) for the unevenness δ, over angles among which are all positions and corners of the
    loads.

    The reduced torque is that of weights, loads and the friction of the joints.  Raises `LocksError`.
    """
    loss = LOST_TORQUE.of(machine)

    def torque_at(analysis: Analysis) -> Floats:
        lost = 0.0 if loss is None else loss.torque(analysis.cycle_angle)
        return _torque(analysis) - lost

    whole = machine.turns * FULL_TURN
    own = np.concatenate((machine.cycle_angles, breaks(machine), [0.0, whole], [] if loss is None else loss.edges))
    grid = np.linspace(0.0, whole, machine.turns * SAMPLES + 1)
    every = np.sort(np.concatenate((grid, own)))
    angle = every[np.concatenate(([True], np.diff(every) > SAME_ANGLE))]
    analysis = analyse(machine, angle)
    torque, least = torque_at(analysis), SAME_ANGLE * possible(analysis.motion, (*analysis.weights, *analysis.applied))
    idle = np.abs(torque).max() <= least
    return regulate(
        angle,
        np.zeros_like(torque) if idle else torque,
        np.zeros_like(torque) if idle else accumulated(lambda at: torque_at(analyse(machine, at)), angle, ORDER),
        reduced_inertia(machine, analysis.motion),
        machine.speed,
        unevenness,
    )


def regulated_cycle(machine: Machine) -> RegulatedCycle | None:
    """Return the regulated cycle of a machine, None if it has no flywheel."""
    unevenness = machine.topic("flywheel", float)
    return None if unevenness is None else flywheel(machine, unevenness)


def regulated_in(analysis: Analysis) -> RegulatedCycle:
    """Return the regulated cycle of a machine with a flywheel."""
    regulated = REGULATED_CYCLE.of(analysis.machine)
    assert regulated is not None, "the machine has a flywheel"
    return regulated
