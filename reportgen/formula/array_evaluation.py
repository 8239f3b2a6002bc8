"""Evaluate definitions of a calculation for arrays of other values, so that no formula is written a second time."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from reportgen.formula.calculation import Calculation
from reportgen.formula.constructions import Value
from reportgen.formula.evaluation import evaluate


def model(sheet: Calculation, wanted: Iterable[str], **known: Value) -> dict[str, Value]:
    """Return the values (SI) of the `wanted` ids of a calculation with other values for the `known` ids.

    The known values (SI) are scalars or arrays of any shape that broadcast together; results have the broadcast shape.
    A given quantity of the calculation enters as a scalar if it has one value, else as [N] over the positions. Only
    inputs of the wanted ids are evaluated. Undefined values are nan or infinite, as in the calculation.

    Raises `KeyError` for a wanted id that is neither known nor in the calculation.
    """
    wanted, values = tuple(wanted), dict(known)
    needed = {*wanted} - {*known}
    for id in reversed(sheet.families):
        if id in needed:
            needed |= {*sheet.inputs(id)} - {*known}
    with np.errstate(all="ignore"):
        for id, family in sheet.families.items():
            if id in needed and family.definition is None:
                values[id] = family.values if len(family.values) > 1 else family.values[0]
            elif id in needed and family.definition is not None:
                values[id] = evaluate(family.definition, values)
    return {id: values[id] for id in wanted}
