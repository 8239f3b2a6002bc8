"""Quantities of a case by their ids, as arrays with their metadata, over the driver's travel: `quantity`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from reportgen.base.errors import NotOfferedError, UnknownNameError
from reportgen.base.records import Record
from reportgen.base.units import Language
from reportgen.base.words import unknown, word
from reportgen.case import Case, DriverMotion
from reportgen.formula import Symbol
from reportgen.formula.calculation import Family
from reportgen.formula.vocabulary import KINDS

_IN_SI = {"°": "rad", "%": "", "cm": "m", "cm²": "m²", "N/cm²": "Pa", "N/(cm²·mm)": "Pa/m"}
"""SI units of printed units, except for those in mm."""


def si_unit(kind: str) -> str:
    """Return the SI unit of a kind's values: m if it is printed in mm."""
    unit = KINDS[kind].unit
    return unit if KINDS[kind].scale == 1.0 else _IN_SI.get(unit, unit.replace("mm", "m"))


class QuantityArray(np.ndarray):
    """The values of a quantity in SI units; a vector of the plane is a complex number."""

    name: str
    symbol: Symbol | None
    unit: str

    @classmethod
    def of(cls, values: np.ndarray, family: Family) -> QuantityArray:
        """Return values (SI) [N] as an array with the metadata of a family.

        They need not be the family's own values.
        """
        made = np.asarray(values).view(cls)
        made.name, made.symbol, made.unit = family.id, family.symbol, si_unit(family.kind)
        return made

    def __array_finalize__(self, other: Any) -> None:
        self.name, self.symbol = getattr(other, "name", ""), getattr(other, "symbol", None)
        self.unit = getattr(other, "unit", "")

    def __reduce__(self) -> tuple[Any, ...]:
        reduced: tuple[Any, ...] = tuple(super().__reduce__())
        return *reduced[:2], (reduced[2], (self.name, self.symbol, self.unit))

    def __setstate__(self, state: Any) -> None:
        values, (self.name, self.symbol, self.unit) = state
        super().__setstate__(values)

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        """Return the result of a computation as a plain array, because its unit differs."""
        plain = np.asarray(array)
        return plain[()] if return_scalar else plain


class CaseQuantity(Record):
    """A quantity of a case, or of one of its parts."""

    id: str
    case: Case

    @property
    def family(self) -> Family:
        return self.case.ledger[self.id]

    @property
    def values(self) -> np.ndarray:
        """Its values (SI) [N]; motion on a line is signed along it, as in the report's curves."""
        over = self.case.driver_motion
        return over.signed[self.id][0] if over is not None and self.id in over.signed else self.family.values

    @property
    def array(self) -> QuantityArray:
        """Its values (SI) [N] with their metadata."""
        return QuantityArray.of(self.values, self.family)

    def over(self, language: Language) -> DriverMotion:
        """Return the driver's motion; raise `NotOfferedError` if the quantity is not a curve over its way."""
        over = self.case.driver_motion
        if over is None or len(self.family.values) != len(over.gone):
            raise NotOfferedError(word("no_curve", language, text=self.id))
        return over


def quantity(case: Case, id: str) -> CaseQuantity:
    """Return a quantity by its id, or by its symbol as text (M.cb for M_cb); the machine precedes its parts.

    Raise `UnknownNameError`.
    """
    cases = list(case.parts.values()) or [case]
    for part in cases:
        if id in part.ledger:
            return CaseQuantity(id, part)
    for part in cases:
        for own, family in part.ledger.families.items():
            if not family.hidden and id == f"{family.symbol.base}.{family.symbol.sub}":
                return CaseQuantity(own, part)
    raise UnknownNameError(unknown("no_quantity", id, list(visible_ids(case)), case.assignment.language))


def visible_ids(case: Case) -> Iterator[str]:
    """Yield the ids of quantities that are printed at the positions and are not vectors of the plane."""
    for part in case.parts.values() or [case]:
        over = part.driver_motion
        for id, family in part.ledger.families.items():
            if over is not None and len(family.values) == len(over.gone) and not (family.hidden or family.is_plane):
                yield id
