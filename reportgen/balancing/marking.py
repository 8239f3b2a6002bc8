"""Tolerance for a counterweight that is computed from the positions, compared with the ledger's, from the whole curve.

A student knows the force on the frame at the positions only, and uses their mean, or the smallest circle round them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.balancing import balance_ids
from reportgen.balancing.shaking_force import round_points
from reportgen.formula.ledger import Ledger
from reportgen.machine import DRIVER
from reportgen.marking.topic_marking import MarkHooks


def errors_of_positions(ledger: Ledger) -> Mapping[str, np.ndarray]:
    """Return the errors (SI) [1] of U, its angle and their dependent values, by id, for the rules that use the whole
    curve.
    """
    along, across = balance_ids.seen("x"), balance_ids.seen("y")
    if along not in ledger:
        return {}
    seen = ledger[along].values.real + 1j * ledger[across].values.real
    even = np.broadcast_to(ledger["even"].values.real, seen.shape)
    by_positions = {"rms": complex(np.average(seen, weights=even)), "max": round_points(seen)[0]}
    errors: dict[str, np.ndarray] = {}
    for rule, origin in by_positions.items():
        if (id := balance_ids.rule_product(rule)) not in ledger:
            continue
        parts = (float(ledger[balance_ids.rule_component(rule, axis)].values[0].real) for axis in "xy")
        U = complex(*parts)
        off = np.array([abs(abs(origin) - abs(U))])
        turned = np.array([abs(float(np.angle(-origin / U)))]) if U else np.zeros(1)
        errors |= {id: off, balance_ids.rule_angle(rule): turned}
        errors |= dict(zip((balance_ids.rule_component(rule, axis) for axis in "xy"), _apart(-origin, U), strict=True))
        if balance_ids.product(DRIVER) in ledger and _is_first(ledger, rule):
            errors |= {balance_ids.product(DRIVER): off, balance_ids.angle(DRIVER): turned}
            for name in (balance_ids.mass, balance_ids.weight, balance_ids.centrifugal):
                if (further := name(DRIVER)) in ledger:
                    errors[further] = off * (ledger[further].values.real / abs(U) if U else 0.0)
    return errors


def _apart(here: complex, there: complex) -> tuple[np.ndarray, np.ndarray]:
    return np.array([abs(here.real - there.real)]), np.array([abs(here.imag - there.imag)])


def _is_first(ledger: Ledger, rule: str) -> bool:
    """Return True if a rule is the one that is applied."""
    return balance_ids.rule_product(rule) in ledger.inputs[balance_ids.product(DRIVER)]


HOOKS = MarkHooks(errors_of_positions=errors_of_positions)
