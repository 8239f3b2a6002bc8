"""Error of the true motion by the trapezoid rule over the positions, compared with the whole curve."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.formula import ids
from reportgen.formula.ledger import Ledger
from reportgen.marking.tolerance_bands import DIGITS, half_unit
from reportgen.marking.topic_marking import MarkHooks

TRUE_MOTION = "run."


OF_CURVE = frozenset({"max", "min", "mean", "delta"})


def errors_of_positions(ledger: Ledger) -> Mapping[str, np.ndarray]:
    """Return the errors (SI) [N], by id, of values that use integrals of the true motion by the trapezoid rule over the
    positions.

    The bounds of the speed are those of its curve, independently of the positions.
    """
    rests = [id for id in ledger.families if (names := ids.rest.read(id)) and names["id"].startswith(TRUE_MOTION)]
    if not rests:
        return {}
    following = [
        id
        for id, family in ledger.families.items()
        if id.startswith(TRUE_MOTION) and not (family.residue or id.split(".")[1] in OF_CURVE)
    ]
    values = ledger.evaluate(dict.fromkeys(rests, 0.0))
    errors = {id: np.abs(np.real(values[id]) - ledger[id].values.real) for id in following}
    for id in following:
        speed = id.replace(".Md", ".omega")
        if ledger[id].definition is None and speed != id and speed in ledger:
            # A torque is read off its characteristic at a speed that has so many figures.
            read, at = ledger[id].values.real, ledger[speed].values.real
            with np.errstate(all="ignore"):
                slopes = np.abs(np.diff(read, append=read[:1]) / np.diff(at, append=at[:1]))
            steepest = float(np.max(slopes, initial=0.0, where=np.isfinite(slopes)))
            errors[id] = steepest * half_unit(at, DIGITS)
    return {id: error for id, error in errors.items() if error.max() > 0}


def integral_of(ledger: Ledger, id: str) -> str:
    """Return the id of the work of all torques for a value that is computed from it; any other id unchanged."""
    if not id.startswith(TRUE_MOTION) or ledger[id].definition is None or id not in errors_of_positions(ledger):
        return id
    return f"{TRUE_MOTION}A{id[id.rindex('.') :]}" if id.count(".") > 1 else f"{TRUE_MOTION}A"


HOOKS = MarkHooks(errors_of_positions=errors_of_positions, integral_of=integral_of)
