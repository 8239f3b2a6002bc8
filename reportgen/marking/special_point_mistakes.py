"""Mistakes about the special points of Assur by which the plans of a group of class III are drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from reportgen.formula import ids, refs
from reportgen.formula.ledger import Ledger
from reportgen.marking.student_values import ChangeValue


def of_special_points(ledger: Ledger) -> Iterator[tuple[str, str, Mapping[str, ChangeValue]]]:
    """Yield names of mistakes, the quantities in which they are made, and the changes of the ledger.

    The special point S is taken as fixed, or without acceleration, or the plate's ω is computed from v_S alone.
    """
    for plate in [
        names["link"] for id in ledger.families if (names := ids.plate_trial.read(id)) and names["of"] == "d"
    ]:
        rotation = ids.angular_velocity(plate)
        relative = next((names["point"] for id in _sources(ledger, rotation) if (names := ids.velocity.read(id))), "")
        joint, special = [*ids.points(relative), "", ""][:2]
        own, reach = ids.velocity(special), ids.length(special, joint)
        if own not in ledger or reach not in ledger:
            continue
        if np.any(ledger[own].values > 0):
            yield "special-point-fixed", own, {ids.plan_point("v", special.lower()): _nothing}
            yield "rotation-from-special-point", rotation, {rotation: _ratio(own, reach)}
        yield "special-point-even", ids.acceleration(special), {ids.plan_point("a", special.lower()): _nothing}


def _nothing(value: np.ndarray, _: Mapping[str, np.ndarray]) -> np.ndarray:
    return 0 * value


def _ratio(above: str, below: str) -> ChangeValue:
    """Return the change that makes a value the ratio of two others."""
    return lambda _, values: values[above] / values[below]


def _sources(ledger: Ledger, id: str) -> tuple[str, ...]:
    """Return the ids in the definition of a quantity."""
    definition = ledger[id].definition if id in ledger else None
    return () if definition is None else refs(definition)
