"""Compute quantities over a range of parameters: the ledger is evaluated once, with a further first axis.

This requires that every number on which a quantity depends is given, has a formula, or is the same for all values.
Other dependencies have no formula in the ledger, for example the load of a stroke that becomes longer. Then each value
has its own case, as its own file would have. The scales of plans do not matter, because lengths are laid off and
measured at the same scale.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property

import numpy as np

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.records import Record
from reportgen.case import Case
from reportgen.derivation.equation_sides import image
from reportgen.export.quantities import QuantityArray, quantity
from reportgen.formula import ids
from reportgen.formula.calculation import Family
from reportgen.formula.ledger import Ledger

SAME = 1e-13
"""Relative difference below which two numbers are the same number computed twice."""
PROBED = 5
"""Number of values of the range, its ends included, that show whether a number changes with it."""


class Study(Record, dict=True):
    """Assignments that differ in values of parameters; None for a value that `check` rejects."""

    variants: Sequence[Assignment | None]
    opened: Callable[[Assignment], Case]

    def values(self, of: Sequence[str]) -> dict[str, QuantityArray]:
        """Return quantities by id as arrays (SI) [variants, positions], with NaN for rejected values.

        Raise `UnknownNameError` for an unknown id.
        """
        quantities = [quantity(self._base, id) for id in of]
        together = [source.id for source in quantities if source.case is self._base and self.is_determined(source.id)]
        values = self._evaluated(together)
        for source in quantities:
            if source.id not in values:
                values[source.id] = self._one_by_one(source.id)
        return {
            id: QuantityArray.of(values[source.id], source.family) for id, source in zip(of, quantities, strict=True)
        }

    # --- a case a value

    @cached_property
    def _sound(self) -> list[Assignment]:
        return [one for one in self.variants if one is not None]

    @cached_property
    def _probes(self) -> list[Case]:
        """Cases of some values, the ends of the range among them."""
        count = len(self._sound)
        return [self.opened(self._sound[at]) for at in sorted({*np.linspace(0, count - 1, PROBED).astype(int)})]

    @property
    def _base(self) -> Case:
        return self._probes[0]

    def _one_by_one(self, id: str) -> np.ndarray:
        rows = [None if one is None else quantity(self.opened(one), id).values for one in self.variants]
        empty = np.full_like(next(row for row in rows if row is not None), np.nan)
        return np.array([empty if row is None else row for row in rows])

    # --- all values at once

    @cached_property
    def _given(self) -> Mapping[str, np.ndarray]:
        """Values that a file gives, or its machine computes from it, for each sound value, by ids: [values, 1 or
        positions].
        """
        machine = getattr(catalogue.module(self._sound[0].kind), "machine", None)
        if machine is None or self._sound[0].parts:
            return {}
        sheets = [machine(one).calculation.families for one in self._sound]
        wanted = [id for id, family in self._base.ledger.families.items() if family.definition is None]
        return {
            id: np.array([sheet[id].values for sheet in sheets])
            for id in wanted
            if all(id in sheet and sheet[id].values.shape == sheets[0][id].values.shape for sheet in sheets)
        }

    def _needed(self, id: str) -> frozenset[str]:
        """Return a quantity with all its dependencies, including the corner of its plan if it has a sign along a
        line.
        """
        ledger, signed = self._base.ledger, self._signed(id)
        own = [id] if signed is None else [id, *signed[:2]]
        return frozenset(other for one in own for other in (one, *ledger.ancestors(one)))

    def _signed(self, id: str) -> tuple[str, str, complex] | None:
        """Return the corner of the plan, the plan's scale and the direction of a quantity with a sign along a line."""
        motion = self._base.driver_motion
        if motion is None or id not in motion.signed:
            return None
        rate, point = next((rate, read["point"]) for rate, name in ids.POINT_RATE.items() if (read := name.read(id)))
        return ids.plan_point(rate, image(point)), ids.scale(rate), motion.signed[id][1]

    def is_determined(self, id: str) -> bool:
        """Return True if formulas and given data determine a quantity for every value, without other changing
        numbers.
        """
        family = self._base.ledger[id]
        if not self._given or family.is_plane or family.kind == "segment" or _is_scale(family):
            return False
        motions = [case.driver_motion for case in self._probes]
        directions = {motion.signed[id][1] for motion in motions if motion is not None and id in motion.signed}
        ledgers = [case.ledger for case in self._probes]
        return len(directions) <= 1 and all(self._is_same(one, ledgers) for one in self._needed(id))

    def _is_same(self, id: str, ledgers: Sequence[Ledger]) -> bool:
        """Return True if a number has one formula for all values or, without a formula, is the same for all."""
        first, *others = ledgers
        if not all(id in ledger for ledger in others):
            return False
        family = first[id]
        if family.definition is not None:
            return all(ledger[id].definition == family.definition for ledger in others)
        scale = np.abs(family.values).max()
        return (
            id in self._given
            or _is_scale(family)
            or all(
                ledger[id].values.shape == family.values.shape
                and np.abs(ledger[id].values - family.values).max() <= SAME * scale
                for ledger in others
            )
        )

    def _evaluated(self, wanted: Collection[str]) -> dict[str, np.ndarray]:
        if not wanted:
            return {}
        ledger = self._base.ledger
        needed = frozenset(other for id in wanted for other in self._needed(id))
        changes = {id: values for id, values in self._given.items() if id in needed}
        values_of = ledger.evaluate(changes, only=needed)
        made = {}
        for id in wanted:
            values = values_of[id]
            if signed := self._signed(id):
                corner, scale, direction = signed
                values = np.real(np.conj(direction) * values_of[corner]) * values_of[scale]
            size = len(ledger[id].values)
            rows = np.full((len(self.variants), size), np.nan, dtype=values.dtype)
            rows[[one is not None for one in self.variants]] = values
            made[id] = rows
        return made


def _is_scale(family: Family) -> bool:
    """Return True if it is the scale of a plan, which is chosen and changes by jumps."""
    return family.kind.endswith(("scale", "on paper"))
