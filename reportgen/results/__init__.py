"""Results of `solve` as plain data, in the format reportgen-results/1.

They are in SI units and radians, unrounded. The values that the report prints, in its units, can be added.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import islice
from typing import Any

import numpy as np

from reportgen.case import Case
from reportgen.formula.calculation import Family
from reportgen.formula.ledger import Ledger

FORMAT = "reportgen-results/1"


def results(case: Case) -> dict[str, Any]:
    """Return the contract's JSON object of a case: an entry per position, null if it cannot be reached.

    For a coursework, it has the results of the machine, and those of each further part by its name.
    """
    assignment, entries = case.assignment, case.entries
    about = {"format": FORMAT, "kind": assignment.kind, "variant": assignment.variant, "units": "SI"}
    about_all = {**about, **plain(entries.besides), "positions": plain(entries.positions)}
    further = {name: results(part) for name, part in islice(case.parts.items(), 1, None)}
    return {**about_all, "parts": further} if further else about_all


def plain(value: Any) -> Any:
    """Return a value as JSON: a plane vector as [x, y] or null if it does not exist; numbers as floats."""
    match value:
        case Mapping():
            return {str(name): plain(one) for name, one in value.items()}
        case list() | tuple():
            return [plain(one) for one in value]
        case complex() | np.complexfloating():
            return [float(value.real), float(value.imag)] if np.isfinite(value) else None
        case np.generic():
            return value.item()
        case _:
            return value


def printed_values(written: Ledger) -> dict[str, Any]:
    """Return, by id, unit, decimals (null: as typed) and printed values of a report, one or one per position."""
    return {
        id: {
            "unit": family.how.unit,
            "decimals": written.decimals[id],
            "values": [_printed_value(written, family, k + 1) for k in range(len(family.values))],
        }
        for id, family in written.families.items()
        if not (family.hidden or family.is_plane)
    }


def _printed_value(written: Ledger, family: Family, position: int) -> float | None:
    """Return the printed value of a quantity at a position; None if there is none (a zero vector's direction)."""
    if family.is_of_vector and written[family.of].at(position) == 0:
        return None
    value = written.quantity(family.id, position).number.printed
    return value + 0.0 if math.isfinite(value) else None
