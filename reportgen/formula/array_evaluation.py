"""Evaluate the definitions of a sheet over arrays of other values, so that no formula is written a second time."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from reportgen.formula.calculation import Calculation
from reportgen.formula.constructions import Value
from reportgen.formula.evaluation import evaluate


def model(sheet: Calculation, wanted: Iterable[str], **known: Value) -> dict[str, Value]:
    """Return the values (SI) of some ids of a sheet with others in place of its own, over arrays of any shape.

    Only the inputs of the wanted ids are evaluated; undefined values are nan or infinite, as on the sheet. Raises
    `KeyError` for an id that is not on the sheet.
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
