"""A student's values laid over the ledger: what each later quantity comes to from them."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reportgen.answers.bands import is_chosen_length
from reportgen.answers.key import Role, Row
from reportgen.grading.guide import Guide
from reportgen.grading.marks import Place, Submission
from reportgen.ledger.following import follow
from reportgen.notation.expressions import Ref

Change = Callable[[np.ndarray, Mapping[str, np.ndarray]], np.ndarray]
"""A quantity's value (SI) from what it comes to and all values before it."""

SIGNED = "turn."
"""Ids of signed rotations begin so; the size stands before them under the rest of the id."""

LARGEST_SCALE = 1e6
"""A student's own scale that differs more than this from the report's is no scale."""


CONFIRMED = 0.02
"""Two scales nearer than this are one: a millimetre in the length of a drawn crank."""


@dataclass(frozen=True)
class Working:
    """The values of a sheet in SI, [N] or [1], NaN where none is given, by id of the row.

    Lengths on paper are turned to the report's scales: the same vector, drawn at another μ.  `scales`
    are those of the plans as they were drawn, by id, in SI.
    """

    guide: Guide
    values: Mapping[str, np.ndarray]
    scales: Mapping[str, float]

    def own(self, blank_from_key: bool = False, made: Mapping[str, Change] | None = None) -> dict[str, np.ndarray]:
        """What every judged quantity comes to from the student's own earlier values.

        A blank one on the way is replaced by the key's, or else follows like the rest.  `made` are
        changes of quantities that the sheet does not show.
        """
        expected: dict[str, np.ndarray] = {}
        mistaken = made or {}

        def laid(id: str) -> Change:
            def change(computed: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
                computed = mistaken[id](computed, values) if id in mistaken else computed
                known = self.guide.ledger[id].values
                expected[id] = np.broadcast_to(computed, known.shape)
                return self.over(id, computed, known if blank_from_key else computed)

            return change

        follow(self.guide.ledger, {**mistaken, **{id: laid(id) for id in self.entered}})
        return expected

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
        return id in self.values or SIGNED + id in self.values

    @property
    def entered(self) -> tuple[str, ...]:
        """Ids of the ledger that hold a value of the student's or are judged, sizes of signed rotations too."""
        judged = [row.id for row in self.guide.judged]
        return tuple(dict.fromkeys([*judged, *(id.removeprefix(SIGNED) for id in judged), *self.values]))

    def over(self, id: str, computed: np.ndarray, blank: np.ndarray) -> np.ndarray:
        """The student's values of a quantity, `blank` where there are none; an arm has the sign that is computed."""
        given = self.values.get(id)
        if given is None:
            signed = self.values.get(SIGNED + id)
            if signed is None:
                return blank
            given = np.abs(signed)
        elif self.guide.ledger[id].arm:
            given = np.abs(given) * np.where(computed < 0, -1.0, 1.0)
        return np.where(np.isnan(given), blank, given)


def lay_out(guide: Guide, submission: Submission) -> Working:
    """The working of a submission, with every plan read as it was drawn.

    The scale of a plan is what its first length stands for (μ = v_A/pa), the one written down, or the
    report's: the one that another confirms, or that makes most of the plan right.  A scale written down that
    is not the plan's own is a wrong value like any other.
    """
    values = {row.id: _column(guide, row, submission) for row in guide.key.asked}
    values = {id: column for id, column in values.items() if not np.isnan(column).all()}
    written = {row.id: float(values[row.id][0]) for row in guide.key.asked if row.id in values and _is_scale(row)}
    scales: dict[str, float] = {}
    for scale in (row.id for row in guide.key.asked if _is_scale(row)):
        usual = float(guide.ledger[scale].values[0])
        plan = [id for id in values if scale_of(guide, id) == scale]
        first = next((id for id in plan if _is_first(guide, id, scale)), None)
        tried = [written.get(scale, usual) / usual, 1.0]
        if first is not None:
            with np.errstate(divide="ignore"):
                tried.insert(0, float(guide.ledger[first].values[0] / values[first][0]))
        factor = _drawn_at(guide, values, [id for id in plan if id != first], tried)
        scales[scale] = factor * usual
        values |= {id: values[id] * factor for id in plan}
        if scale in written:
            values[scale] = np.array([written[scale] / factor])
    return Working(guide, values, scales)


def _drawn_at(
    guide: Guide, values: Mapping[str, np.ndarray], plan: Sequence[str], tried: Sequence[float]
) -> float:
    """The scale of a plan over the report's: of those `tried` the first that another confirms, else the best."""
    possible = [one for one in tried if np.isfinite(one) and 1 / LARGEST_SCALE < one < LARGEST_SCALE]
    first, *others = possible
    if any(abs(first / other - 1) < CONFIRMED for other in others):
        return first
    return max(possible, key=lambda one: _agree(guide, values, plan, one))


def _is_scale(row: Row) -> bool:
    return row.role is Role.scale and row.kind != "segment"


def _is_first(guide: Guide, id: str, scale: str) -> bool:
    """Whether a length on paper is the one that a scale was made from: the drawn crank, pa."""
    ledger = guide.ledger
    if scale == "mu.l":
        return is_chosen_length(ledger, ledger[id])
    definition = ledger[id].definition
    return isinstance(definition, Ref) and ledger[definition.id].definition is None


def scale_of(guide: Guide, id: str) -> str:
    """The scale that a length on paper is drawn at; "" for what is no such length."""
    if guide.ledger[id].kind != "segment":
        return ""
    first, _, rest = id.partition(".")
    if first == "seg":
        plan = rest.partition(".")[0]
        for scale in (f"mu.{plan}", f"mu.R{plan}"):
            if scale in guide.ledger:
                return scale
    # Arms on Zhukovsky's lever are measured on the velocity plan.
    return "mu.v" if first == "h" and id.endswith(".p") else "mu.l"


def _agree(guide: Guide, values: Mapping[str, np.ndarray], plan: Sequence[str], factor: float) -> int:
    """How many lengths of a plan are right when they are read at `factor` times the report's scale."""
    return sum(
        int((np.abs(np.abs(values[id]) * factor - np.abs(guide.ledger[id].values)) <= guide.bands[id]).sum())
        for id in plan
    )


def _column(guide: Guide, row: Row, submission: Submission) -> np.ndarray:
    """A row's values in SI; those of the first turn hold for every turn where all turns are alike."""
    column = np.full(len(row.values), np.nan)
    scale = guide.ledger[row.id].how.scale
    for position in row.positions:
        given = submission.values.get((row.id, position))
        if given is None:
            continue
        places = range(position - 1, len(column), guide.count) if guide.repeats(row) else [row.at(position)]
        column[list(places)] = given.value * scale
    return column
