"""The flywheel as it is worked out on paper: integrals over the cycle by the trapezoid rule, from the positions alone.

The report integrates continuously.  With some ten positions a student cannot, so the difference belongs to the
tolerance; where it is large, the quantity cannot be worked out from the positions and is not asked for.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.ledger.core import Ledger

LARGE = 0.1
"""The share of a quantity's largest value that the rule may miss it by."""


def trapezoid_errors(ledger: Ledger) -> Mapping[str, np.ndarray]:
    """How far excess work [N], flywheel [1] and regulated speed [N] by the rule lie from those of the ledger (SI)."""
    if "J.d" not in ledger:
        return {}
    torque = ledger["M.r"].values.real
    angle = np.abs(np.unwrap(ledger["phi.1"].values.real))
    angle = np.abs(angle - angle[0])
    cycle = 2 * np.pi * np.ceil(angle[-1] / (2 * np.pi))
    steps = np.diff(np.append(angle, cycle))
    work = steps * (torque + np.roll(torque, -1)) / 2
    balanced = np.concatenate(([0.0], np.cumsum(work - work.sum() * steps / cycle)[:-1]))
    inertia = ledger["J.r"].values.real if "J.r" in ledger else np.zeros(len(torque))
    most, least = (float(ledger[id].values[0].real) for id in ("omega.max", "omega.min"))
    upper, lower = np.max(balanced - most**2 * inertia / 2), np.min(balanced - least**2 * inertia / 2)
    rates = float(ledger["unevenness"].values[0].real) * float(ledger["omega.1"].values[0].real) ** 2
    flywheel = (upper - lower) / rates
    found = {"A.excess": balanced, "J.d": np.array([flywheel])}
    if "omega.of" in ledger:
        energy = most**2 * flywheel / 2 - upper
        found["omega.of"] = np.sqrt(2 * (energy + balanced) / (flywheel + inertia))
    return {id: np.abs(values - ledger[id].values.real) for id, values in found.items()}


def is_workable(ledger: Ledger, id: str, errors: Mapping[str, np.ndarray]) -> bool:
    """Whether a quantity can be worked out from the positions alone; the speed only where the excess work can."""
    id = "A.excess" if id == "omega.of" else id
    return id not in errors or bool(np.nanmax(errors[id]) <= LARGE * np.nanmax(np.abs(ledger[id].values)))
