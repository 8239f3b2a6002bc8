"""Decide whether the scale of a plan without lengths on the sheet was chosen or computed: `best_working`.

The crank's own plans have a computed scale, μ_v = ω₁μ_l. A number written for it may be a free choice, at which the
same velocities are drawn longer or shorter. It may also be the result of the student's own wrong ω₁, with which every
velocity of the plan grows. The number alone does not decide; the values read from the plan do.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.case.answer_key import Role
from reportgen.formula import refs, vocabulary
from reportgen.formula.evaluation import evaluate
from reportgen.marking.marking_data import Cells, Marked, Place, Submission, Verdict
from reportgen.marking.marking_scheme import MarkingScheme, Values
from reportgen.marking.student_values import CONFIRMED, ScaleReading, Working, working_of

Fitting = Callable[[Working], tuple[int, int]]
"""Returns the number of values of a sheet that a working explains, and the number of values."""


def best_working(scheme: MarkingScheme, submission: Submission, fitting: Fitting) -> Working:
    """Return the working of a submission in which each open scale has the reading that explains most values.

    The scales are read one after the other in the ledger's order, since μ_v and μ_a depend on μ_l.
    """
    scales = _open_scales(scheme, submission)
    if not scales:
        return working_of(scheme, submission)
    stated = _stated(scheme, submission, scales)
    blank = working_of(scheme, without_cells(submission, {(id, 0) for id in scales}))
    possible = _Possible(scheme, blank.all_values, stated)
    taken: dict[str, ScaleReading] = {}
    best: Working | None = None
    for index, scale in enumerate(scales):
        candidates = possible.readings(scale, taken)
        tried: list[tuple[int, ScaleReading, Working]] = []
        for reading in candidates if len(candidates) > 1 else ():
            working = working_of(scheme, submission, possible.completed({**taken, scale: reading}, scales[index + 1 :]))
            explained, count = fitting(working)
            if explained == count:
                return working
            tried.append((explained, reading, working))
        if tried:
            _, taken[scale], best = max(tried, key=lambda one: one[0])
        else:
            taken[scale] = candidates[0]
    return best or working_of(scheme, submission, taken)


def optional_scales(working: Working) -> frozenset[Place]:
    """Return the filled-in scales that earn no marks, if any of them does not follow from the student's own values."""
    scheme = working.scheme
    places = frozenset(
        (row.id, position)
        for row in scheme.judged
        for position in row.positions
        if row.role is Role.scale
        and not scheme.policy.worth(row.id)
        and (row.id, position) in working.submission.values
    )
    chosen = any((np.abs(working.drawn[id] - 1) > CONFIRMED).any() for id, _ in places)
    mistaken = any(not working.readings[id].own for id, _ in places if id in working.readings)
    return places if chosen or mistaken else frozenset()


def left_out(working: Working, blank: Working) -> Working:
    """Return the working of a sheet without its scales, with tolerances as narrow as these make them."""
    drawn = {id: np.minimum(factor, 1.0) for id, factor in working.drawn.items()}
    return replace(blank, drawn=drawn)


def without_cells(submission: Submission, places: Container[Place]) -> Submission:
    """Return a submission with some of its cells left empty."""
    return replace(submission, values={at: answer for at, answer in submission.values.items() if at not in places})


def charged_for_scales(working: Working, cells: Cells) -> dict[Place, Marked]:
    """Return the first value of each plan that is drawn at a wrong scale, if the scale itself earns no marks.

    A slip in the scale is one mistake: it costs one mark, in the first value that it spoils.
    """
    scheme, charged = working.scheme, dict[Place, Marked]()
    order = {row.id: index for index, row in enumerate(scheme.judged)}
    for (id, _), cell in cells.items():
        if not (cell.first and not cell.worth and scheme.rows[id].role is Role.scale):
            continue
        spoilt = [
            place
            for place, affected in cells.items()
            if affected.verdict is Verdict.follows and affected.worth and id in scheme.before[place[0]]
        ]
        for place in sorted(spoilt, key=lambda place: (order[place[0]], place[1]))[:1]:
            charged[place] = replace(cells[place], verdict=Verdict.wrong, points=0.0)
    return charged


class _Possible(Record):
    """The values (SI) that open scales may have for a student.

    `all_values` has all values (SI) [N] without the scales, `stated` the written scales (SI).
    """

    scheme: MarkingScheme
    all_values: Values
    stated: Mapping[str, float]

    def readings(self, scale: str, taken: Mapping[str, ScaleReading]) -> list[ScaleReading]:
        """Return the readings of a scale: from own values by its formula or as v_A/pa, then the written number."""
        definition = self.scheme.ledger[scale].definition
        assert definition is not None, "an open scale is worked out"
        inputs = {id: np.array([taken[id].value]) if id in taken else self.all_values[id] for id in refs(definition)}
        readings = [ScaleReading(float(np.atleast_1d(evaluate(definition, inputs))[0].real), own=True)]
        further = []
        if scale in self.scheme.scale_definitions:
            size, length = self.scheme.scale_definitions[scale]
            further.append(float((self.all_values[size] / self.all_values[length])[0].real))
        if scale in self.stated:
            further.append(self.stated[scale])
        for value in further:
            unlike = (abs(value / reading.value - 1) >= CONFIRMED for reading in readings)
            if 0 < value < np.inf and all(unlike):
                readings.append(ScaleReading(value, own=False))
        return readings

    def completed(self, taken: Mapping[str, ScaleReading], later: Sequence[str]) -> dict[str, ScaleReading]:
        """Return the scales that are taken, and the later ones as they follow from these."""
        scales = dict(taken)
        for scale in later:
            scales[scale] = self.readings(scale, scales)[0]
        return scales


def _open_scales(scheme: MarkingScheme, submission: Submission) -> list[str]:
    """Return the computed scales of plans without a length on the sheet, in the ledger's order."""
    filled_plans = {vocabulary.plan(id) for id, _ in submission.values.keys() - submission.measured.keys()}
    scales = {
        row.id
        for row in scheme.key.rows
        if row.role is Role.scale and row.kind != "segment" and scheme.ledger[row.id].definition is not None
    }
    return [id for id in scheme.ledger.families if id in scales - filled_plans and len(scheme.ledger[id].values) == 1]


def _stated(scheme: MarkingScheme, submission: Submission, scales: Sequence[str]) -> dict[str, float]:
    """Return the scales (SI) that are written as a positive number."""
    numbers = {id: submission.values[id, 0].value for id in scales if (id, 0) in submission.values}
    return {id: number * scheme.ledger[id].how.scale for id, number in numbers.items() if 0 < number < np.inf}
