"""The torque that friction takes from the crank over the cycle, for drives whose speed varies.

The friction of the joints follows their reactions at the planned speed ω₁: the power lost there, divided by ω₁, is

    M_loss(φ) = |M_cb^fr| − |M_cb| = Σ ρ R ω_rel/ω₁ + Σ f R v_rel/ω₁,

counted in the sense of rotation. At the planned speed the balance of power with it is exact. The inertia forces of
a speed that differs by a few hundredths change the friction by twice as much of their share in the reactions.
"""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.friction.cycle_effects import turning_back
from reportgen.friction.joints import friction_of, with_friction
from reportgen.machine.analysis import Machine, analyse, breaks
from reportgen.machine.cycle_torque import SAME_ANGLE, CycleTorque
from reportgen.machine.load_laws import FULL_TURN

PARTS = 180
"""Smallest number of parts of a turn."""
ORDER = 6
"""Number of nodes in a part."""
ACCURATE = 1e-9
"""Largest contribution of the highest polynomials in a part to the torque, as a share of its greatest value."""
MOST_HALVINGS = 12
"""Largest number of halvings of a part beside a corner that no law names, for example where a slider begins to tilt."""
NODES = np.polynomial.legendre.leggauss(ORDER)[0]
MODES = np.linalg.inv(np.polynomial.legendre.legvander(NODES, ORDER - 1))


class LocksError(Exception):
    """The mechanism locks by friction at a cycle `angle` (rad)."""

    def __init__(self, angle: float) -> None:
        super().__init__(angle)
        self.angle = angle


def friction_loss(machine: Machine) -> CycleTorque | None:
    """Return the torque (N·m) that friction takes from the crank over the cycle; None for a machine without friction.

    Raises `LocksError`.
    """
    friction = friction_of(machine)
    if friction is None:
        return None
    whole = machine.turns * FULL_TURN
    turns = [angle for joint in friction.joints(machine.linkage) for angle in turning_back(machine, joint)]
    corners = np.mod(np.concatenate((turns, breaks(machine))), whole)
    edges = np.sort(np.concatenate((np.linspace(0.0, whole, machine.turns * PARTS + 1), corners)))
    edges = np.append(edges[:-1][np.diff(edges) > SAME_ANGLE], whole)
    edges[0] = 0.0
    coefficients = _coefficients(machine, edges[:-1], edges[1:])
    for _ in range(MOST_HALVINGS):
        size = float(np.abs(coefficients).max())
        rough = np.flatnonzero(np.abs(coefficients[:, -2:]).max(axis=1) > ACCURATE * size)
        if not rough.size:
            break
        middles = (edges[rough] + edges[rough + 1]) / 2
        halves = np.column_stack((edges[rough], middles, middles, edges[rough + 1])).reshape(-1, 2)
        finer = _coefficients(machine, halves[:, 0], halves[:, 1]).reshape(len(rough), 2, ORDER)
        coefficients[rough] = finer[:, 0]
        coefficients = np.insert(coefficients, rough + 1, finer[:, 1], axis=0)
        edges = np.insert(edges, rough + 1, middles)
    return CycleTorque(edges, coefficients)


def _coefficients(machine: Machine, low: Floats, high: Floats) -> Floats:
    """Return the Legendre coefficients [n, 6] of M_loss (N·m) in the parts [n] between `low` and `high` (rad)."""
    angle = low[:, None] + (high - low)[:, None] * (NODES + 1) / 2
    analysis = analyse(machine, angle.ravel())
    solved = with_friction(analysis)
    lost = machine.turn * (solved.torque - analysis.torque)
    if not np.isfinite(lost).all():
        raise LocksError(float(angle.ravel()[int(np.argmin(np.isfinite(lost)))]))
    return np.asarray(lost.reshape(angle.shape) @ MODES.T)
