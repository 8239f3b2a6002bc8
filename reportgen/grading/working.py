"""One assignment opened for marking, and a student's values laid over its ledger."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from reportgen.analysis import Analysis
from reportgen.answers.bands import computed_bands, drawn_bands, half_unit, is_direction
from reportgen.answers.key import Key, Role, Row, make_key
from reportgen.assignment import Assignment
from reportgen.case import Case, opened
from reportgen.grading.drawn_scales import CONFIRMED, Values, drawn_at, in_use, makes_scale
from reportgen.grading.marks import Place, Policy, Submission
from reportgen.ledger.core import Ledger, follow, standing_on
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Product, Ref

Change = Callable[[np.ndarray, Values], np.ndarray]
"""A quantity's value (SI) from what it comes to and all values before it."""

ALMOST = 1e-12
"""Room for rounding in a comparison with a band."""

LEAST_FIGURES = 3
"""Figures that a number has been written with, though noughts at its end do not show them."""


@dataclass(frozen=True)
class Guide:
    """An assignment opened for marking."""

    key: Key
    ledger: Ledger
    analysis: Analysis | None
    """Of a machine; an exercise has none."""
    policy: Policy

    @cached_property
    def bands(self) -> dict[str, np.ndarray]:
        """The tolerances (SI) [N] of every row of the key.

        They are the widest of drawing, rounding and a share of the quantity's maximum within a quarter turn.
        """
        return self.bands_at({})

    @cached_property
    def _computed(self) -> dict[str, np.ndarray]:
        return computed_bands(self.ledger, self.policy.digits)

    def bands_at(self, scales: Values) -> dict[str, np.ndarray]:
        """The tolerances where plans are drawn at multiples of the report's scales."""
        policy = self.policy
        drawn, computed = drawn_bands(self.ledger, policy.paper, scales), self._computed
        return {
            row.id: np.maximum(np.maximum(drawn[row.id], computed[row.id]), policy.share * self._size_near(row.id))
            * (1 + ALMOST)
            for row in self.key.rows
        }

    def size(self, id: str) -> float:
        """The largest value of a quantity over the turn (SI); of an angle, a full turn."""
        if is_direction(id):
            return 2 * np.pi
        values = np.abs(self.ledger[id].values)
        return float(values[np.isfinite(values)].max(initial=0.0))

    def _size_near(self, id: str) -> np.ndarray:
        """The largest value of a quantity within a quarter turn of each position (SI) [N]; of an angle, a full turn.

        So the pressure of combustion makes no room in the intake stroke.
        """
        values = np.nan_to_num(np.abs(self.ledger[id].values))
        if is_direction(id) or len(values) == 1:
            return np.full(len(values), self.size(id))
        reach = min(-(-self.count // 4), len(values) // 2)
        near: np.ndarray = np.max([np.roll(values, shift) for shift in range(-reach, reach + 1)], axis=0)
        return near

    def distance(self, id: str, one: np.ndarray | float, other: np.ndarray | float) -> np.ndarray:
        """How far values (SI) lie apart: directions around the circle; what has no sense of its own by size."""
        if self.is_unsigned(id):
            one, other = np.abs(one), np.abs(other)
        return np.asarray(vocabulary.distance(id, np.asarray(one), np.asarray(other)))

    def is_unsigned(self, id: str) -> bool:
        """Whether the sign of a quantity is not judged: an arm's, or one of which the sheet leaves the sense open."""
        row = self.key.find(id)
        return self.ledger[id].arm or (row is not None and row.open_sense)

    @cached_property
    def rows(self) -> dict[str, Row]:
        """The rows that a sheet may fill in."""
        return {row.id: row for row in self.key.asked}

    @cached_property
    def judged(self) -> tuple[Row, ...]:
        """The rows that earn marks, in the ledger's order; how long the crank is drawn is the student's own choice."""
        order = {id: index for index, id in enumerate(self.ledger.families)}
        kept = (row for row in self.key.asked if row.kind != "segment" or row.role is not Role.scale)
        return tuple(sorted(kept, key=lambda row: order[row.id]))

    @cached_property
    def before(self) -> dict[str, tuple[str, ...]]:
        """Every quantity that a judged one stands on, nearest first."""
        return {row.id: standing_on(self.ledger, row.id) for row in self.judged}

    @cached_property
    def alike(self) -> dict[str, tuple[str, ...]]:
        """Of each judged row those before it that have its values at all positions."""
        found: dict[str, tuple[str, ...]] = {}
        for number, row in enumerate(self.judged):
            one = self.ledger[row.id]
            before = (
                other
                for other in self.judged[:number]
                if other.kind == row.kind and len(other.values) == len(row.values)
            )
            found[row.id] = tuple(
                other.id
                for other in before
                if np.allclose(one.values, self.ledger[other.id].values, rtol=1e-9, atol=0, equal_nan=True)
            )
        return found

    @cached_property
    def makers(self) -> dict[str, tuple[str, str]]:
        """Of each scale of a plan the size and the length that it was made from: v_A and pa of μ_v."""
        found: dict[str, tuple[str, str]] = {}
        for row in self.judged:
            scale = vocabulary.plan(row.id)
            if row.single and scale in self.ledger and scale not in found and makes_scale(self, row.id, scale):
                value = self.ledger[scale].values[0] * self.ledger[row.id].values[0]
                sizes = (one.id for one in self.judged if one.single and one.kind in ("velocity", "acceleration"))
                size = next((id for id in sizes if np.isclose(self.ledger[id].values[0], value, rtol=1e-9)), "")
                if size:
                    found[scale] = size, row.id
        return found

    @cached_property
    def sizes(self) -> dict[str, set[str]]:
        """The quantities that each length of a plan stands for: μ times it, and the size of the vector laid as it."""
        found: dict[str, set[str]] = {id: set() for id in self.ledger.families if vocabulary.plan(id)}
        for id, family in self.ledger.families.items():
            if isinstance(family.definition, Product) and len(family.definition.factors) == 2:
                used = [one.id for one in family.definition.factors if isinstance(one, Ref)]
                for length in used:
                    if vocabulary.plan(length) in used:
                        found[length].add(id)
            if id in found and family.of in self.ledger:
                found[id].add(self.ledger[family.of].of)
        return found

    def stands_on(self, place: Place, places: Container[Place]) -> bool:
        """Whether a value on the sheet stands on one at any of `places`."""
        id, position = place
        rows = (self.rows[before] for before in self.before[id] if before in self.rows)
        return any((row.id, self.place(row, position)) in places for row in rows)

    @property
    def count(self) -> int:
        """Positions of one turn."""
        return self.analysis.machine.count if self.analysis else 1

    @cached_property
    def _repeated(self) -> dict[str, bool]:
        return {
            row.id: not row.single and max(row.positions, default=0) <= self.count < len(row.values)
            for row in self.key.rows
        }

    def repeats(self, row: Row) -> bool:
        """Whether a quantity is asked for in the first turn only, because all turns are the same."""
        return self._repeated[row.id]

    def place(self, row: Row, position: int) -> int:
        """The position at which the sheet asks for a quantity that one at `position` stands on."""
        if row.single:
            return 0
        return (position - 1) % self.count + 1 if self.repeats(row) else position


def open_guide(assignment: Assignment, policy: Policy | None = None) -> Guide:
    """The marking guide of an assignment, computed as its report is."""
    case = opened(assignment)
    analysis = case.analysis if isinstance(case, Case) else None
    return Guide(make_key(case), case.ledger, analysis, policy or Policy())


# --- a student's values ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Working:
    """The values of a sheet in SI, [N] or [1], NaN where none is given, by id of the row.

    Lengths on paper are turned to the report's scales: the same vector, drawn at another μ.  `scales`
    are those of the plans as they were drawn, by id, in SI, `shown` where the sheet leaves no doubt of them; `bands`
    are the tolerances of such drawings.
    """

    guide: Guide
    submission: Submission
    values: Values
    scales: Values
    shown: Values

    @cached_property
    def _units(self) -> dict[str, np.ndarray]:
        """What `unit` has been asked for."""
        return {}

    @cached_property
    def factors(self) -> dict[str, np.ndarray]:
        """The scales as multiples of the report's, [N] or [1]."""
        return {id: scale / self.guide.ledger[id].values for id, scale in self.scales.items()}

    @cached_property
    def bands(self) -> Mapping[str, np.ndarray]:
        """The tolerances (SI) [N] of every row, at the student's own scales."""
        # Nobody gets wider tolerances by a scale that nothing was drawn at.
        factors = {id: np.where(self.shown[id], one, np.minimum(one, 1.0)) for id, one in self.factors.items()}
        other = {id: factor for id, factor in factors.items() if (np.abs(factor - 1) > CONFIRMED).any()}
        return self.guide.bands_at(other) if other else self.guide.bands

    def unit(self, id: str) -> np.ndarray:
        """What one printed unit of a quantity stands for in `values` [N]: lengths as drawn at the student's scale."""
        if id not in self._units:
            family = self.guide.ledger[id]
            unit = family.how.scale * self.factors.get(vocabulary.plan(id), 1.0) / self.factors.get(id, 1.0)
            self._units[id] = np.broadcast_to(unit, family.values.shape)
        return self._units[id]

    def own_values(
        self, blank_from_key: bool = False, changes: Mapping[str, Change] | None = None
    ) -> dict[str, np.ndarray]:
        """What every judged quantity comes to from the student's own earlier values.

        A blank one on the way is replaced by the key's, or else follows like the rest.  `changes` are
        made to quantities that the sheet does not show.
        """
        return self._followed(blank_from_key, changes or {})[0]

    @cached_property
    def world(self) -> dict[str, np.ndarray]:
        """All values as the student has them: entered, or following from these; the key's where a cell is blank."""
        return self._followed(True, {})[1]

    def _followed(
        self, blank_from_key: bool, unseen: Mapping[str, Change]
    ) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        ledger = self.guide.ledger
        result: dict[str, np.ndarray] = {}

        def entered(id: str) -> Change:
            def change(computed: np.ndarray, values: Values) -> np.ndarray:
                computed = unseen[id](computed, values) if id in unseen else computed
                known = ledger[id].values
                result[id] = np.broadcast_to(computed, known.shape)
                return self.entered_values(id, computed, known if blank_from_key else computed)

            return change

        values = follow(ledger, {**unseen, **{id: entered(id) for id in self.entered_ids}})
        return result, values

    def also(self, row: Row, position: int) -> list[float]:
        """What a quantity may be taken to be as well: another like it, or what another way of drawing gives.

        Whoever takes a_C for a_A, or μ_a for a_A/πa′, is not wrong again where a_A was.  On the lever M = F h′ μ_l
        where pa is the drawn crank, though the report has μ_v/ω₁ for a plan at another scale.
        """
        ledger, index = self.guide.ledger, row.at(position)
        found = [float(self.values[other][index].real) for other in self.guide.alike[row.id] if other in self.values]
        if row.role is Role.scale and row.id in self.guide.makers:
            size, length = self.guide.makers[row.id]
            if size in self.values and self.values.get(length, np.zeros(1))[0]:
                found.append(float(self.values[size][0] / self.values[length][0]))
        found += self._by_length_scale(row, index)
        return [one for one in found if np.isfinite(one) and not self._is_right(row, ledger[row.id].values[index], one)]

    def _by_length_scale(self, row: Row, index: int) -> list[float]:
        """The moment of a load on the lever by its drawn arm and μ_l as it is written down."""
        load, arm = vocabulary.vector_of(row.id), f"h.{row.id.removeprefix('M.')}"
        if vocabulary.row(row.id).name != "lever moment" or not {arm, "mu.l"} <= self.values.keys():
            return []
        drawn = self.world[arm] / self.factors.get("mu.v", np.ones(1))
        return [float((self.world[load] * drawn)[index].real) * self._stated("mu.l")] if load in self.world else []

    def _stated(self, scale: str) -> float:
        """A scale (SI) as it is written down, right or not."""
        return float(self.values[scale][0] * self.factors.get(scale, np.ones(1))[0])

    def _is_right(self, row: Row, known: float, value: float) -> bool:
        return bool(np.isclose(known, value, rtol=1e-9))

    def unrounded(self, right: Container[Place]) -> Working:
        """The same with the key's value at every place where the student's is right."""
        ledger = self.guide.ledger
        values = dict(self.values)
        for row in self.guide.judged:
            if row.id in values:
                kept = [self.guide.place(row, k + 1) for k in range(len(values[row.id]))]
                known = np.array([(row.id, position) in right for position in kept])
                values[row.id] = np.where(known, ledger[row.id].values.real, values[row.id])
        return replace(self, values=values)

    def shows(self, id: str) -> bool:
        """Whether the sheet has a value of a quantity at any position."""
        return id in self.values or self.guide.ledger.signed.get(id) in self.values

    @cached_property
    def entered_ids(self) -> tuple[str, ...]:
        """Ids of the ledger that hold a value of the student's or are judged, sizes of signed rotations too."""
        judged = [row.id for row in self.guide.judged]
        return tuple(dict.fromkeys([*judged, *map(self.guide.ledger.size_of, judged), *self.values]))

    def entered_values(self, id: str, computed: np.ndarray, blank: np.ndarray) -> np.ndarray:
        """The student's values of a quantity, `blank` where there are none; the computed sign where none is judged."""
        given = self.values.get(id)
        if given is None:
            signed = self.values.get(self.guide.ledger.signed.get(id, ""))
            if signed is None:
                return blank
            given = np.abs(signed)
        elif self.guide.is_unsigned(id):
            given = np.abs(given) * np.where(computed < 0, -1.0, 1.0)
        return np.where(np.isnan(given), blank, given)


@lru_cache(maxsize=65536)
def last_half_unit(value: float) -> float:
    """Half a unit of the last figure of a number as it was written, with three figures at least."""
    written = f"{abs(value):.11e}".partition("e")[0].replace(".", "").rstrip("0")
    return float(half_unit(np.array([value]), max(LEAST_FIGURES, len(written)))[0])


def lay_out(guide: Guide, submission: Submission) -> Working:
    """The working of a submission, with every plan read as it was drawn.

    The scale of a plan is what its first length stands for (μ = v_A/pa), the one written down, or the
    report's: the one that another confirms, or that makes most of the plan right.  A scale written down that
    is not the plan's own is a wrong value like any other.
    """
    values = {row.id: _column(guide, row, submission) for row in guide.key.asked}
    values = {id: column for id, column in values.items() if not np.isnan(column).all()}
    asked = [row.id for row in guide.key.asked if row.role is Role.scale and row.kind != "segment"]
    scales: dict[str, np.ndarray] = {}
    shown: dict[str, np.ndarray] = {}
    for scale in asked:
        usual = guide.ledger[scale].values
        plan = [id for id in values if vocabulary.plan(id) == scale]
        first = next((id for id in plan if makes_scale(guide, id, scale)), None)
        stated = values.get(scale, np.full(len(usual), np.nan))
        factor, shown[scale] = np.ones(len(usual)), np.zeros(len(usual), dtype=bool)
        for place in range(len(usual)):
            # A scale for all positions is judged by all lengths, a position's own by those of its plan.
            own = slice(None) if len(usual) == 1 else slice(place, place + 1)
            tried = [float(one) for one in (stated[place] / usual[place], 1.0)]
            if (found := in_use(guide, values, scale, own, float(stated[place]))) is not None:
                tried.insert(0, float(found / usual[place]))
            if first is not None:
                with np.errstate(divide="ignore"):
                    tried.insert(0, float(guide.ledger[first].values[0] / values[first][0]))
            plan_of_place = [id for id in plan if id != first]
            factor[place], shown[scale][place] = drawn_at(guide, values, plan_of_place, tried, own)
        scales[scale] = factor * usual
        values |= {id: values[id] * factor for id in plan}
        if scale in values:
            values[scale] = stated / factor
    return Working(guide, submission, values, scales, shown)


def _column(guide: Guide, row: Row, submission: Submission) -> np.ndarray:
    """A row's values in SI; those of the first turn hold for every turn where all turns are the same."""
    column = np.full(len(row.values), np.nan)
    scale = guide.ledger[row.id].how.scale
    for position in row.positions:
        given = submission.values.get((row.id, position))
        if given is None:
            continue
        places = range(position - 1, len(column), guide.count) if guide.repeats(row) else [row.at(position)]
        column[list(places)] = given.value * scale
    return column
