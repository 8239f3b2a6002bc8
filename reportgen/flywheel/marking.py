"""Error of a flywheel by the trapezoid rule over the positions, compared with the whole curve.

Marking calls these hooks to widen the tolerances of values that a student can only integrate from position to position.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.formula.ledger import Ledger
from reportgen.marking.topic_marking import MarkHooks


def errors_of_positions(ledger: Ledger) -> Mapping[str, np.ndarray]:
    """Return the absolute errors (SI) that the trapezoid rule over the positions causes, by id.

    The ids are A.excess [N], J.d [1] and, if the ledger has it, omega.of [N]. Without a flywheel the result is empty.
    """
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
    by_rule = {"A.excess": balanced, "J.d": np.array([flywheel])}
    if "omega.of" in ledger:
        energy = most**2 * flywheel / 2 - upper
        by_rule["omega.of"] = np.sqrt(2 * (energy + balanced) / (flywheel + inertia))
    return {id: np.abs(values - ledger[id].values.real) for id, values in by_rule.items()}


def integral_of(ledger: Ledger, id: str) -> str:
    """Return "A.excess" for the regulated speed "omega.of", which is computed from it; any other id unchanged."""
    return "A.excess" if id == "omega.of" else id


HOOKS = MarkHooks(errors_of_positions=errors_of_positions, integral_of=integral_of)
