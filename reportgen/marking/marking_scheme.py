"""One assignment prepared for marking (`marking_scheme`): requested cells, tolerances, and dependencies of values."""

from __future__ import annotations

from collections.abc import Container, Mapping
from functools import cached_property

import numpy as np

from reportgen.base.records import Record, field, replace
from reportgen.case import Case, CaseOfParts, Misconceptions
from reportgen.case.answer_key import Key, KeyRow, Role
from reportgen.formula import Product, Ref, vocabulary
from reportgen.formula.ledger import Ledger, standing_on
from reportgen.marking.marking_data import Place, Submission
from reportgen.marking.marking_policy import Policy
from reportgen.marking.tolerance_bands import computed_bands, drawn_bands, is_chosen_length, is_direction
from reportgen.marking.toleranced_key import key_of

Values = Mapping[str, np.ndarray]
"""Values (SI) by id, each [N] over all positions of the cycle, or [1] if it is the same at all of them."""

ALMOST = 1e-12
"""Relative allowance for rounding in a comparison with a band."""


class MarkingScheme(Record, dict=True):
    """An assignment prepared for marking."""

    key: Key
    ledger: Ledger
    misconceptions: Misconceptions
    count: int
    """Number of positions of one turn."""
    policy: Policy
    parts: tuple[MarkingScheme, ...] = ()
    """Schemes of the parts of a coursework, each by its own ids."""
    sources: Mapping[str, str] = field(default_factory=dict)
    """For a coursework: the ids of lengths that parts give, by the ids under which the machine's ledger has them."""

    @cached_property
    def bands(self) -> dict[str, np.ndarray]:
        """The tolerances (SI) [N] of every row of the key.

        Each is the widest of three: drawing, rounding, and a share of the quantity's maximum within a quarter turn.
        """
        return self.bands_at({})

    @cached_property
    def _computed(self) -> dict[str, np.ndarray]:
        return computed_bands(self.ledger, self.policy.digits)

    def bands_at(self, scales: Values) -> dict[str, np.ndarray]:
        """Return the tolerances (SI) [N] if plans are drawn at multiples of the report's scales."""
        policy = self.policy
        drawn, computed = drawn_bands(self.ledger, policy.paper, scales), self._computed
        return {
            row.id: np.maximum(np.maximum(drawn[row.id], computed[row.id]), policy.share * self._size_near(row.id))
            * (1 + ALMOST)
            for row in self.key.rows
        }

    def size(self, id: str) -> float:
        """Return the largest value of a quantity over the turn (SI); for an angle, a full turn."""
        if is_direction(id):
            return 2 * np.pi
        values = np.abs(self.ledger[id].values)
        return float(values[np.isfinite(values)].max(initial=0.0))

    def _size_near(self, id: str) -> np.ndarray:
        """Return the largest value within a quarter turn of each position (SI) [N]; for an angle, a full turn.

        So the pressure of combustion does not widen the tolerance in the intake stroke.
        """
        values = np.nan_to_num(np.abs(self.ledger[id].values))
        if is_direction(id) or len(values) == 1:
            return np.full(len(values), self.size(id))
        reach = min(-(-self.count // 4), len(values) // 2)
        near: np.ndarray = np.max([np.roll(values, shift) for shift in range(-reach, reach + 1)], axis=0)
        return near

    def distance(self, id: str, values: np.ndarray | float, references: np.ndarray | float) -> np.ndarray:
        """Return the distances (SI) between values and references, in their common shape [N].

        Directions are compared around the circle, unsigned quantities by absolute value.
        """
        if self.is_unsigned(id):
            values, references = np.abs(values), np.abs(references)
        return np.asarray(vocabulary.distance(id, np.asarray(values), np.asarray(references)))

    def is_unsigned(self, id: str) -> bool:
        """Return True if the sign of a quantity is not judged: an arm, or a quantity with an open sense."""
        row = self.key.find(id)
        return self.ledger[id].arm or (row is not None and row.open_sense)

    @cached_property
    def rows(self) -> dict[str, KeyRow]:
        """The rows that a sheet may fill in, by id."""
        return {row.id: row for row in self.key.asked}

    @cached_property
    def judged(self) -> tuple[KeyRow, ...]:
        """The rows that earn marks, in the ledger's order; the drawn length of the crank is the student's choice."""
        order = {id: index for index, id in enumerate(self.ledger.families)}
        kept = (row for row in self.key.asked if row.kind != "segment" or row.role is not Role.scale)
        return tuple(sorted(kept, key=lambda row: order[row.id]))

    @cached_property
    def before(self) -> dict[str, tuple[str, ...]]:
        """The ids of the quantities that each judged one depends on, the nearest first."""
        return {row.id: standing_on(self.ledger, row.id) for row in self.judged}

    @cached_property
    def alike(self) -> dict[str, tuple[str, ...]]:
        """For each judged row, the earlier rows that have equal values at all positions."""
        alike: dict[str, tuple[str, ...]] = {}
        for number, row in enumerate(self.judged):
            own = self.ledger[row.id]
            before = (
                earlier
                for earlier in self.judged[:number]
                if earlier.kind == row.kind and len(earlier.values) == len(row.values)
            )
            alike[row.id] = tuple(
                earlier.id
                for earlier in before
                if np.allclose(own.values, self.ledger[earlier.id].values, rtol=1e-9, atol=0, equal_nan=True)
            )
        return alike

    @cached_property
    def scale_definitions(self) -> dict[str, tuple[str, str]]:
        """For each scale of a plan, the ids of the size and the length that define it: v_A and pa for μ_v."""
        ledger, scale_definitions = self.ledger, dict[str, tuple[str, str]]()
        single = [one for one in ledger.families.values() if len(one.values) == 1 and not (one.hidden or one.is_plane)]
        sizes = [one for one in single if one.kind in ("velocity", "acceleration")]
        for length in single:
            scale = vocabulary.plan(length.id)
            if scale in ledger and scale not in scale_definitions and makes_scale(ledger, length.id, scale):
                value = ledger[scale].values[0] * length.values[0]
                size = next((one.id for one in sizes if np.isclose(one.values[0], value, rtol=1e-9)), "")
                if size:
                    scale_definitions[scale] = size, length.id
        return scale_definitions

    @cached_property
    def sizes(self) -> dict[str, set[str]]:
        """For each length of a plan, the ids of the quantities that it represents.

        They are the product of μ and the length, and the size of its vector.
        """
        sizes: dict[str, set[str]] = {id: set() for id in self.ledger.families if vocabulary.plan(id)}
        for id, family in self.ledger.families.items():
            if isinstance(family.definition, Product) and len(family.definition.factors) == 2:
                used = [factor.id for factor in family.definition.factors if isinstance(factor, Ref)]
                for length in used:
                    if vocabulary.plan(length) in used:
                        sizes[length].add(id)
            if id in sizes and family.of in self.ledger:
                sizes[id].add(self.ledger[family.of].of)
        return sizes

    def depends_on(self, place: Place, places: Container[Place]) -> bool:
        """Return True if a value on the sheet depends on one at any of `places`."""
        id, position = place
        rows = (self.rows[before] for before in self.before[id] if before in self.rows)
        return any((row.id, self.place(row, position)) in places for row in rows)

    @cached_property
    def _repeated(self) -> dict[str, bool]:
        return {
            row.id: not row.single and max(row.positions, default=0) <= self.count < len(row.values)
            for row in self.key.rows
        }

    def repeats(self, row: KeyRow) -> bool:
        """Return True if a quantity is asked for in the first turn only, because all turns are the same."""
        return self._repeated[row.id]

    def place(self, row: KeyRow, position: int) -> int:
        """Return the position of the sheet for a quantity that one at `position` depends on."""
        if row.single:
            return 0
        return (position - 1) % self.count + 1 if self.repeats(row) else position


def marking_scheme(case: Case, policy: Policy | None = None) -> MarkingScheme:
    """Return the marking scheme of an assignment, computed in the same way as its report."""
    parts = tuple(marking_scheme(part, policy) for part in case.parts.values())
    sources = case.lengths_of_parts if isinstance(case, CaseOfParts) else {}
    return MarkingScheme(
        key_of(case),
        case.ledger,
        case.misconceptions,
        count=case.span.count,
        policy=policy or Policy(),
        parts=parts,
        sources=sources,
    )


def makes_scale(ledger: Ledger, id: str, scale: str) -> bool:
    """Return True if a length on paper is the one that defines a scale: the drawn crank, pa."""
    if scale == "mu.l":
        return is_chosen_length(ledger, ledger[id])
    definition = ledger[id].definition
    return isinstance(definition, Ref) and ledger[definition.id].definition is None


def key_asked(policy: Policy, key: Key, submission: Submission) -> tuple[Key, frozenset[str]]:
    """Return a key with the cells that a policy asks for and the filled ones, and the ids of the requested rows.

    For a drawing, its lengths and directions are requested where it must show them. A sheet prefilled from own files
    and completed by hand has no other cells.
    """
    filled = (*submission.values, *submission.problems)
    drawn = frozenset(filled) if submission.fingerprint else submission.drawn
    rows = []
    for row in policy.ask.of(key, {id for id, _ in (*filled, *drawn)}).rows:
        filled_at = {k for id, k in (*filled, *drawn) if id == row.id}
        further = any(id == row.id for id, _ in drawn) and not policy.ask.wants(row)
        rows.append(replace(row, positions=tuple(k for k in row.positions if k in filled_at)) if further else row)
    asked = {row.id for row in rows if policy.ask.wants(row)} | {id for id, _ in drawn}
    return replace(key, rows=tuple(rows)), frozenset(asked)
