"""The cycle of a machine whose speed a flywheel on the crank keeps within bounds."""

from __future__ import annotations

from reportgen.base.arrays import Floats
from reportgen.base.records import Record


class RegulatedCycle(Record):
    """The regulated cycle over angles φ [N] (rad, in the direction of rotation); all its arrays are [N].

    `torque` M_r and `constant` M_c (N·m), `inertia` J_r and `moment` J_d (kg·m²), `work` A, `upper` a and
    `lower` b (J), `speed` ω [N] and its bounds `fastest`, `slowest` (rad/s); `high`, `low` are the indices
    where the speed reaches them.
    """

    angle: Floats
    torque: Floats
    constant: float
    inertia: Floats
    work: Floats
    upper: float
    lower: float
    moment: float
    speed: Floats
    fastest: float
    slowest: float
    high: int
    low: int
    unevenness: float
    """The permitted δ = (ω_max − ω_min)/ω_m."""
