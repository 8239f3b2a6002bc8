"""The first wrong values by name: slips of writing, mistakes of working; data taken wrongly have their own module.

Each search looks at the first wrong values that have no name yet; `marking.SEARCHES` is their order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from reportgen.answers.bands import is_direction
from reportgen.document.key import Role
from reportgen.grading.guide import Guide, Values
from reportgen.grading.marks import Cells, Marked, Place, Verdict
from reportgen.grading.mistakes import NO_CORIOLIS, OF_POSITION, Mistake, general_mistakes, mistakes_in
from reportgen.grading.working import Change, Working
from reportgen.ledger.core import follow

FEW_FIGURES = 2
"""Significant figures that are too few, but still show the value; one figure shows too little."""

FEWEST_ANGLES = 4
"""Fewer angles show no convention."""

AGREED = 0.8
"""The share of the angles not right that one convention explains."""

CONVENTIONS: tuple[tuple[str, float, float], ...] = (
    ("angle-clockwise", -1.0, 0.0),
    ("angle-from-vertical", 1.0, -90.0),
    ("angle-from-vertical", -1.0, 90.0),
    ("angle-from-vertical", 1.0, 90.0),
)
"""How angles are measured otherwise: name, factor and summand (°) of the angle asked for."""

OWN_FIGURES = 0.1
"""A value within the tolerance of nothing shows a mistake that gives it to this share of itself."""

OF_WRITING = frozenset({"thousands-mark", "sign-reversed"})
"""Slips of writing down, which nobody makes in what is not written down; by chance one of hundreds would fit."""


# --- slips of writing -----------------------------------------------------------------------------
# Too few figures, a value in another cell, angles by another convention: nothing was worked out wrongly, so
# they are found on the sheet alone, before mistakes of working are sought.


def slips_of_writing(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """The slips behind first wrong values, where they are known."""
    guide = working.guide
    first = {place: cell for place, cell in cells.items() if cell.first}
    found = (
        *_misplaced(guide, first, cells),
        *(("too-few-figures", place) for place, cell in first.items() if _has_too_few_figures(cell)),
        # A scale was taken from the task while the plan was drawn at another.
        *(
            ("other-scale", place)
            for place, cell in first.items()
            if guide.rows[place[0]].role is Role.scale and _is_other_scale(guide, cell)
        ),
        *_by_another_convention(first, cells),
    )
    # Nothing else comes from a slip of writing unseen, so it changes no other quantity.
    return {place: Mistake(name, place[0], {}) for name, place in found}


def _is_other_scale(guide: Guide, cell: Marked) -> bool:
    """Whether a scale is the task's, or chosen freely, but not that of the drawing."""
    usual = float(guide.key.row(cell.id).values[0])
    return cell.equals(usual, cell.band) or guide.ledger[cell.id].kind == "force scale"


def _has_too_few_figures(cell: Marked) -> bool:
    """Whether a value is right but for its figures."""
    given = cell.given
    return bool(given) and any(
        given == float(f"{value:.{FEW_FIGURES}g}") and abs(given - value) > cell.band
        for value in (cell.own, cell.expected)
    )


def _misplaced(guide: Guide, first: Cells, cells: Cells) -> Iterator[tuple[str, Place]]:
    """Two values of one unit in each other's rows; a value beside its own cell, which was left empty."""
    for (one, mine), (other, theirs) in combinations(first.items(), 2):
        same = one[1] == other[1] and guide.rows[one[0]].unit == guide.rows[other[0]].unit
        # Of two values that differ in sign alone, both signs were reversed.
        opposite = abs(mine.expected + theirs.expected) <= mine.band
        if same and not opposite and _belongs_to(mine, theirs) and _belongs_to(theirs, mine):
            yield "rows-swapped", one
            yield "rows-swapped", other
    for place, cell in first.items():
        beside = [cells[place[0], position] for position in guide.rows[place[0]].positions]
        if any(one.verdict is Verdict.blank and _belongs_to(cell, one) for one in beside):
            yield "wrong-column", place


def _belongs_to(cell: Marked, other: Marked) -> bool:
    """Whether a value is that of another cell, not of its own."""
    return cell.equals(other.expected, other.band) and abs(cell.expected - other.expected) > other.band


def _by_another_convention(first: Cells, cells: Cells) -> Iterable[tuple[str, Place]]:
    """Directions that one other convention explains, if it explains most of those that are not right."""
    angles = {place: cell for place, cell in cells.items() if is_direction(place[0]) and cell.given is not None}
    off = sum(cell.verdict is not Verdict.right for cell in angles.values())
    best: list[tuple[str, Place]] = []
    for name, factor, summand in CONVENTIONS:
        met = [(name, place) for place in first if place in angles and _is_measured(angles[place], factor, summand)]
        if len(met) >= max(FEWEST_ANGLES, AGREED * off, len(best) + 1):
            best = met
    return best


def _is_measured(cell: Marked, factor: float, summand: float) -> bool:
    assert cell.given is not None
    apart = (cell.given - factor * cell.expected - summand + 180) % 360 - 180
    return abs(apart) <= cell.band


# --- mistakes of working --------------------------------------------------------------------------
# A mistake may have been made in the wrong quantity itself, or in one before it that the sheet does not show.
# All of them are evaluated at once, [mistakes, positions]; the one that meets most of the wrong values of a
# quantity, and meets them best, gives its name.


def mistakes_of_working(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """The mistakes behind the first wrong values that have no name yet, where they are known."""
    by_row: dict[str, list[int]] = {}
    for (id, position), cell in cells.items():
        if cell.first and not cell.mistake:
            by_row.setdefault(id, []).append(position)
    # A student goes on from the rounded value written down, or from the one left in the calculator.
    right = {place for place, cell in cells.items() if cell.verdict is Verdict.right}
    gone_on_from = (working, working.unrounded(right)) if by_row else ()
    found = {
        (id, position): mistake
        for id, positions in by_row.items()
        for position, mistake in _explained(gone_on_from, cells, id, positions)
    }
    told = Counter(mistake.name for mistake in found.values())
    return {place: one for place, one in found.items() if one.name not in OF_POSITION or told[one.name] > 1}


def _explained(
    gone_on_from: Sequence[Working], cells: Cells, id: str, positions: Sequence[int]
) -> Iterator[tuple[int, Mistake]]:
    """The mistake at each of the positions at which a quantity is wrong, where one is found.

    The first working is the one handed in.
    """
    working = gone_on_from[0]
    guide = working.guide
    candidates = list(_candidates(working, id))
    if not candidates:
        return
    row = guide.rows[id]
    index = [row.at(position) for position in positions]
    given = working.values[id][index]
    unit = working.unit(id)[index]
    band = np.array([cells[id, position].band for position in positions]) * unit
    own, expected = np.array([[cells[id, k].own, cells[id, k].expected] for k in positions]).T * unit
    values = np.concatenate([foreseen(one, [id], candidates)[id][:, index] for one in gone_on_from])
    candidates = [*candidates, *candidates]
    with np.errstate(all="ignore"):
        # What a mistake makes larger, it makes less certain in the same measure.
        wider = np.maximum(1.0, np.abs(values) / np.maximum(np.abs(own), band))
        apart = guide.distance(id, given, values)
        off = apart / (band * wider)
        shows = np.min([guide.distance(id, one, values) for one in (own, expected)], axis=0) > band
    # What is nearly nothing is so by many a mistake: it shows one only if it is met in its own figures.
    left_out = np.array([[mistake.name == NO_CORIOLIS] for mistake in candidates])
    met = (off <= 1) & shows & (left_out | (np.abs(given) > band) | (apart <= OWN_FIGURES * np.abs(values)))
    count = met.sum(axis=1)
    needs_more = [len(row.positions) > 1 and mistake.name in OF_POSITION for mistake in candidates]
    for column, position in enumerate(positions):
        fitting = [n for n in np.flatnonzero(met[:, column]) if count[n] > 1 or not needs_more[n]]
        if fitting:
            best = min(fitting, key=lambda n: (-count[n], round(float(off[n, column]), 2), n))
            yield position, candidates[best]


def _candidates(working: Working, id: str) -> Iterator[Mistake]:
    """Mistakes in the quantity itself, then in unseen ones before it, nearest first, then general ones."""
    guide = working.guide
    yield from mistakes_in(guide, id, working.scales)
    size = guide.ledger.size_of(id)
    if size != id:
        yield from mistakes_in(guide, size, working.scales)
    before = guide.before[id]
    for other in before:
        if other != size:
            yield from unseen_mistakes(working, other)
    concerned = {*before, id}
    yield from (mistake for mistake in general_mistakes(guide) if concerned & mistake.changes.keys())


def unseen_mistakes(working: Working, id: str) -> Iterator[Mistake]:
    """Mistakes in a quantity that the sheet does not show; a plan many times too large is never drawn."""
    family = working.guide.ledger[id]
    drawn = family.kind == "segment" or family.kind.endswith("scale")
    if not (working.shows(id) or family.hidden or family.is_plane or drawn):
        yield from (one for one in mistakes_in(working.guide, id, working.scales) if one.name not in OF_WRITING)


def foreseen(working: Working, ids: Sequence[str], mistakes: Sequence[Mistake]) -> dict[str, np.ndarray]:
    """What quantities come to with each mistake, from the student's own earlier values [mistakes, positions]."""
    guide = working.guide
    ledger = guide.ledger
    made: dict[str, list[tuple[int, Change]]] = {}
    for number, mistake in enumerate(mistakes):
        for changed, change in mistake.changes.items():
            made.setdefault(changed, []).append((number, change))
    judged = {*ids, *map(ledger.size_of, ids)}

    def with_mistakes(name: str) -> Change:
        def change(computed: np.ndarray, values: Values) -> np.ndarray:
            base = computed if name in judged else working.entered_values(name, computed, computed)
            if name not in made:
                return base
            width = max(np.shape(base)[-1], len(ledger[name].values))
            rows = np.array(np.broadcast_to(base, (len(mistakes), width)), dtype=np.result_type(base, float))
            for number, changed in made[name]:
                rows[number] = changed(rows[number], _RowOf(values, number))
            return rows

        return change

    wanted = {*ids}.union(*(guide.before[id] for id in ids))
    names = {name for name in (*working.entered_ids, *made) if name in wanted}
    values = follow(ledger, {name: with_mistakes(name) for name in names}, only=wanted)
    return {id: np.broadcast_to(values[id], (len(mistakes), len(ledger[id].values))).real for id in ids}


class _RowOf(Mapping[str, np.ndarray]):
    """The values with one of several mistakes, of values that have a row for each."""

    def __init__(self, values: Values, number: int) -> None:
        self.all, self.number = values, number

    def __getitem__(self, id: str) -> np.ndarray:
        value = self.all[id]
        return value if value.ndim == 1 else value[self.number % len(value)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.all)

    def __len__(self) -> int:
        return len(self.all)
