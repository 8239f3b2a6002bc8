"""Combine a student's values with the ledger of an assignment (`Working`), to compute what follows from them.

`working_of` makes the working of a submission, with every plan read at the scale at which it was drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from reportgen.base.records import Record, field, replace
from reportgen.case.answer_key import KeyRow, Role
from reportgen.formula import Expression, ids, refs, vocabulary
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import follow
from reportgen.marking.marking_data import Place, Submission
from reportgen.marking.marking_scheme import MarkingScheme, Values, makes_scale
from reportgen.marking.tolerance_bands import half_unit

ChangeValue = Callable[[np.ndarray, Values], np.ndarray]
"""Returns a quantity's value (SI) from its computed value and all values before it."""

LEAST_FIGURES = 3
"""Number of figures that a number was certainly written with, even if zeros at its end do not show them."""


class ScaleReading(NamedTuple):
    """The value (SI) of a plan's scale for a student, and True if the student's own values give it by its formula."""

    value: float
    own: bool


class Working(Record, dict=True):
    """The values of a sheet in SI, [N] or [1], by id of the row; NaN if no value is given.

    Lengths on paper are converted to the report's scales: the same vector, drawn at another μ. `scales` are those of
    the plans as they were drawn, by id, in SI. `drawn` are the multiples of the report's scales that determine the
    tolerances `bands`. `readings` are the values of scales of plans without lengths on the sheet.
    """

    scheme: MarkingScheme
    submission: Submission
    values: Values
    scales: Values
    drawn: Values
    readings: Mapping[str, ScaleReading] = field(default_factory=dict)

    @cached_property
    def _units(self) -> dict[str, np.ndarray]:
        """Cache of `unit`."""
        return {}

    @cached_property
    def factors(self) -> dict[str, np.ndarray]:
        """The scales as multiples of the report's, [N] or [1]."""
        return {id: scale / self.scheme.ledger[id].values for id, scale in self.scales.items()}

    @cached_property
    def bands(self) -> Mapping[str, np.ndarray]:
        """The tolerances (SI) [N] of every row, at the student's own scales."""
        own_scales = {id: factor for id, factor in self.drawn.items() if (np.abs(factor - 1) > CONFIRMED).any()}
        return self.scheme.bands_at(own_scales) if own_scales else self.scheme.bands

    def unit(self, id: str) -> np.ndarray:
        """Return the value in `values` [N] of one printed unit of a quantity; lengths are at the student's scale."""
        if id not in self._units:
            family = self.scheme.ledger[id]
            unit = family.how.scale * self.factors.get(vocabulary.plan(id), 1.0) / self.factors.get(id, 1.0)
            self._units[id] = np.broadcast_to(unit, family.values.shape)
        return self._units[id]

    def own_values(
        self, blank_from_key: bool = False, changes: Mapping[str, ChangeValue] | None = None
    ) -> dict[str, np.ndarray]:
        """Return the value of every judged quantity (SI) [N] that follows from the student's own earlier values.

        A blank value on the way is replaced by the key's, or else follows like the rest. `changes` are applied to
        quantities that the sheet does not show.
        """
        followed = self._from_key if blank_from_key and not changes else self._followed(blank_from_key, changes or {})
        return followed[0]

    @cached_property
    def all_values(self) -> dict[str, np.ndarray]:
        """All values (SI) [N] of a student by id: entered ones and those that follow from them.

        The key's for blank ones.
        """
        return self._from_key[1]

    @cached_property
    def _from_key(self) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        return self._followed(True, {})

    def all_values_with(self, changes: Mapping[str, ChangeValue]) -> dict[str, np.ndarray]:
        """Return all values (SI) [N] with changes of quantities that the sheet does not show."""
        return self._followed(True, changes)[1]

    def _followed(
        self, blank_from_key: bool, unseen: Mapping[str, ChangeValue]
    ) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        ledger = self.scheme.ledger
        result: dict[str, np.ndarray] = {}

        def entered(id: str) -> ChangeValue:
            def change(computed: np.ndarray, values: Values) -> np.ndarray:
                computed = unseen[id](computed, values) if id in unseen else computed
                known = ledger[id].values
                result[id] = np.broadcast_to(computed, known.shape)
                return self.entered_values(id, computed, known if blank_from_key else computed)

            return change

        values = follow(ledger, {**unseen, **{id: entered(id) for id in self.entered_ids}})
        return result, values

    def accepted_alternatives(self, row: KeyRow, position: int) -> list[float]:
        """Return other accepted values (SI) of a quantity at a position.

        They are those of equal quantities, and results of other methods, from the student's own values. A student who
        uses a_C for a_A, or μ_a for a_A/πa′, is not wrong again where a_A was. On the lever, M = F h′ μ_l if pa is the
        drawn crank, though the report has μ_v/ω₁ for a plan at another scale. A student who computes y from the own
        centre distance is as right as with the angle.
        """
        ledger, index = self.scheme.ledger, row.at(position)
        accepted = [
            float(self.values[equal][index].real) for equal in self.scheme.alike[row.id] if equal in self.values
        ]
        if row.role is Role.scale and row.id in self.scheme.scale_definitions:
            size, length = self.scheme.scale_definitions[row.id]
            if size in self.values and self.all_values[length][0]:
                accepted.append(float(self.values[size][0] / self.all_values[length][0].real))
        accepted += self._by_length_scale(row, index)
        alternatives = self.scheme.misconceptions.alternatives.get(row.id, ())
        accepted += [self.by_another_way(row, definition, index) for definition in alternatives]
        return [
            value
            for value in accepted
            if np.isfinite(value) and not self._is_right(row, ledger[row.id].values[index], value)
        ]

    def by_another_way(self, row: KeyRow, definition: Expression, index: int) -> float:
        """Return the value (SI) of another definition of a quantity, from the student's values.

        `index` counts the positions [N] from 0.
        """
        values = np.atleast_1d(evaluate(definition, {id: self.all_values[id] for id in refs(definition)}))
        return float(np.broadcast_to(values, self.scheme.ledger[row.id].values.shape)[index].real)

    def _by_length_scale(self, row: KeyRow, index: int) -> list[float]:
        """Return the moment of a load on the lever by its drawn arm and the written μ_l."""
        names = ids.lever_moment.read(row.id)
        if names is None:
            return []
        load, arm = names["force"], ids.lever_arm(names["force"])
        if not {arm, "mu.l"} <= self.values.keys():
            return []
        drawn = self.all_values[arm] / self.factors.get("mu.v", np.ones(1))
        return (
            [float((self.all_values[load] * drawn)[index].real) * self._stated("mu.l")]
            if load in self.all_values
            else []
        )

    def _stated(self, scale: str) -> float:
        """Return a scale (SI) as it is written, right or not."""
        return float(self.values[scale][0] * self.factors.get(scale, np.ones(1))[0])

    def _is_right(self, row: KeyRow, known: float, value: float) -> bool:
        return bool(np.isclose(known, value, rtol=1e-9))

    def unrounded(self, right: Container[Place]) -> Working:
        """Return the same working with the key's value at every place where the student's value is right."""
        ledger = self.scheme.ledger
        values = dict(self.values)
        for row in self.scheme.judged:
            if row.id in values:
                kept = [self.scheme.place(row, k + 1) for k in range(len(values[row.id]))]
                known = np.array([(row.id, position) in right for position in kept])
                values[row.id] = np.where(known, ledger[row.id].values.real, values[row.id])
        return replace(self, values=values)

    def shows(self, id: str) -> bool:
        """Return True if the sheet has a value of a quantity at any position."""
        return id in self.values or self.scheme.ledger.signed.get(id) in self.values

    @cached_property
    def entered_ids(self) -> tuple[str, ...]:
        """Ids of the ledger that have a value of the student's or are judged, including sizes of signed rotations."""
        judged = [row.id for row in self.scheme.judged]
        sizes = map(self.scheme.ledger.size_of, judged)
        return tuple(dict.fromkeys([*judged, *sizes, *self.values, *self.readings]))

    def entered_values(self, id: str, computed: np.ndarray, blank: np.ndarray) -> np.ndarray:
        """Return a student's values (SI) [N], `blank` where missing; an unjudged sign is the computed one."""
        if id in self.readings:
            reading = self.readings[id]
            return computed if reading.own else np.full(self.scheme.ledger[id].values.shape, reading.value)
        given = self.values.get(id)
        if given is None:
            signed = self.values.get(self.scheme.ledger.signed.get(id, ""))
            if signed is None:
                return blank
            given = np.abs(signed)
        elif self.scheme.is_unsigned(id):
            given = np.abs(given) * np.where(computed < 0, -1.0, 1.0)
        return np.where(np.isnan(given), blank, given)


@lru_cache(maxsize=65536)
def last_half_unit(value: float) -> float:
    """Return half a unit of the last written figure of a number, in its own unit.

    A number counts as written with `LEAST_FIGURES` figures at least.
    """
    written = f"{abs(value):.11e}".partition("e")[0].replace(".", "").rstrip("0")
    return float(half_unit(np.array([value]), max(LEAST_FIGURES, len(written)))[0])


def working_of(
    scheme: MarkingScheme, submission: Submission, readings: Mapping[str, ScaleReading] | None = None
) -> Working:
    """Return the working of a submission, with every plan read as it was drawn, or at the scales in `readings`.

    Candidates for the scale of a plan are the one that its first length gives (μ = v_A/pa), the written one, and the
    report's. The chosen one is confirmed by another, or makes most of the plan right. A written scale that is not the
    plan's own is a wrong value like any other.
    """
    sheet = replace(
        submission, values={at: one for at, one in submission.values.items() if at not in submission.measured}
    )
    values = {row.id: _column(scheme, row, sheet) for row in scheme.key.asked}
    values = {id: column for id, column in values.items() if not np.isnan(column).all()}
    values |= {id: np.array([size]) for id, size in submission.of_parts.items()}
    asked = [row.id for row in scheme.key.asked if row.role is Role.scale and row.kind != "segment"]
    scales: dict[str, np.ndarray] = {}
    drawn: dict[str, np.ndarray] = {}
    read_as = readings or {}
    for scale in asked:
        usual = scheme.ledger[scale].values
        plan = [id for id in values if vocabulary.plan(id) == scale]
        first = next((id for id in plan if makes_scale(scheme.ledger, id, scale)), None)
        stated = values.get(scale, np.full(len(usual), np.nan))
        factor, drawn[scale] = np.ones(len(usual)), np.ones(len(usual))
        reading = read_as.get(scale)
        for place in range(len(usual)):
            # A scale for all positions is judged by all lengths, a position's own scale by those of its plan.
            own = slice(None) if len(usual) == 1 else slice(place, place + 1)
            tried = [float(one) for one in (stated[place] / usual[place], 1.0)]
            if reading is not None:
                # No length shows the size of the plan; the ratio of the written scale to its computed value does.
                tried = [float(stated[place] / reading.value), 1.0]
            elif (scale_used := in_use(scheme, values, scale, own, float(stated[place]))) is not None:
                tried.insert(0, float(scale_used / usual[place]))
            if first is not None:
                tried.insert(0, float(scheme.ledger[first].values[0] / values[first][0]))
            plan_of_place = [id for id in plan if id != first]
            factor[place], drawn_there = drawn_at(scheme, values, plan_of_place, tried, own)
            if any(np.isfinite(values[id][own]).any() for id in plan):
                # A scale at which nothing was drawn must not widen the tolerances.
                drawn[scale][place] = factor[place] if drawn_there else min(factor[place], 1.0)
            elif 1 / FURTHEST <= factor[place] <= FURTHEST:
                drawn[scale][place] = factor[place]
        scales[scale] = factor * usual
        values |= {id: values[id] * factor for id in plan}
        if scale in values:
            values[scale] = stated / factor
    if submission.measured:
        values |= _measured(scheme, submission, values, drawn)
    return Working(scheme, submission, values, scales, drawn, read_as)


def _measured(
    scheme: MarkingScheme, submission: Submission, values: Values, drawn: dict[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Return the values measured on a drawing, which are at the report's scales; update `drawn` for that drawing."""
    of_drawing = replace(submission, values={at: submission.values[at] for at in submission.measured})
    columns: dict[str, np.ndarray] = {}
    for id in {id for id, _ in submission.measured}:
        column = _column(scheme, scheme.key.row(id), of_drawing)
        columns[id] = np.where(np.isnan(column), values.get(id, np.nan), column)
    for (id, position), measured in submission.measured.items():
        scale = vocabulary.plan(id)
        if scale in scheme.ledger:
            factors = drawn.setdefault(scale, np.ones(len(scheme.ledger[scale].values)))
            factors[position - 1 if position and len(factors) > 1 else 0] = 1 / measured.times
    return columns


def _column(scheme: MarkingScheme, row: KeyRow, submission: Submission) -> np.ndarray:
    """Return a row's values in SI; those of the first turn are used for every turn if all turns are the same."""
    column = np.full(len(row.values), np.nan)
    scale = scheme.ledger[row.id].how.scale
    for position in row.positions:
        given = submission.values.get((row.id, position))
        if given is None:
            continue
        places = range(position - 1, len(column), scheme.count) if scheme.repeats(row) else [row.at(position)]
        column[list(places)] = given.value * scale
    return column


# --- at which scale a student drew a plan ---------------------------------------------------------
# The scale follows from the values read from the plan, or is a written one, or the report's.
# A length represents a quantity at a scale of the student's choice; only ratios of sizes to lengths can be judged.

FURTHEST = 5.0
"""Factor from the report's scale beyond which a scale without lengths on the sheet is a slip in its unit."""

LARGEST_SCALE = 1e6
"""Factor from the report's scale beyond which a student's own scale is rejected."""

MANY = 3
"""Number of ratios of force to length that can show the scale of a plan."""

READ_TO = 0.05e-3
"""Half of the last figure of a length on paper (m), which is read to a tenth of a millimetre."""

CONFIRMED = 0.02
"""Relative difference below which two scales count as one: a millimetre in the length of a drawn crank."""


def in_use(scheme: MarkingScheme, values: Values, scale: str, place: slice, stated: float) -> float | None:
    """Return the scale (SI) that a plan was drawn at, from the ratios of sizes to their lengths; None if unclear.

    `values` are those of the sheet (SI) [N]; `place` is the slice of positions drawn at the scale. Most ratios must
    agree. Only a freely chosen scale can be inferred in this way. If the ratios agree with the `stated` scale (SI), few
    are enough: the plan of a crank has two lengths.
    """
    if scheme.ledger[scale].definition is not None or scale == "mu.l":
        return None
    ratios_read: list[np.ndarray] = []
    for length in (id for id in values if vocabulary.plan(id) == scale):
        for size in scheme.sizes[length] & values.keys():
            # Rounding of a short length may exceed the difference between scales.
            rounding = READ_TO / np.abs(values[length])
            ratios_read.append(np.array([np.abs(values[size] / values[length]), rounding])[:, place])
    ratios, rounding = np.concatenate(ratios_read, axis=1) if ratios_read else np.zeros((2, 0))
    known = np.isfinite(ratios) & (ratios > 0)
    ratios, rounding = ratios[known], rounding[known]
    if not ratios.size:
        return None
    middle = float(np.median(ratios))
    if (np.abs(ratios / stated - 1) < CONFIRMED + rounding).mean() > 1 / 2:
        return stated
    agree = np.abs(ratios / middle - 1) < CONFIRMED
    return middle if agree.sum() >= MANY and agree.mean() > 1 / 2 else None


def drawn_at(
    scheme: MarkingScheme, values: Values, plan: Sequence[str], tried: Sequence[float], place: slice
) -> tuple[float, bool]:
    """Return the scale of a plan as a multiple of the report's, and True if the plan shows it.

    It is the first of `tried` if another one confirms it, else the best one. Only the lengths of the plan (SI) [N] at
    the slice `place` count. The scale is shown by another one, or by half of the lengths.
    """

    def right(factor: float) -> int:
        """Return the number of lengths of the plan that are right at that scale."""
        return sum(
            int(
                (np.abs(np.abs(values[id]) * factor - np.abs(scheme.ledger[id].values)) <= scheme.bands[id])[
                    place
                ].sum()
            )
            for id in plan
        )

    possible = [one for one in tried if np.isfinite(one) and 1 / LARGEST_SCALE < one < LARGEST_SCALE]
    first, *others = possible
    if any(abs(first / other - 1) < CONFIRMED for other in others):
        return first, True
    best = max(possible, key=right)
    return best, 2 * right(best) >= sum(int(np.isfinite(values[id][place]).sum()) for id in plan)
