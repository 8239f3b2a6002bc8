"""Infer which given datum the student misread, from the values that depend on it.

`misread_by_many` and `misread_data` are searches of `judging`. Many values show the crank, a fixed point, a rod of a
plan or the size of a load: everything that depends on such a datum is wrong at every position. These values do not
depend on each other, and nearly all of them agree on the misread value. Few values show a mass or a diameter; the
misread value must then be a number that somebody would have given. `mistakes_of_plans` finds vectors that were reversed
or omitted.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.formula import ids, refs, vocabulary
from reportgen.formula.ledger import follow
from reportgen.marking.marking_data import Cells, Marked, Place, Verdict
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.mistakes import WRONG_DATUM, Mistake, foreseen, unseen_mistakes
from reportgen.marking.student_values import ChangeValue, Working, last_half_unit
from reportgen.marking.tolerance_bands import half_unit, is_direction

FACTORS = np.geomspace(1 / 4, 4, 120)
WIDE = np.geomspace(1 / 5, 5, 400)
"""Range of multiples of the right datum in which a misread one is searched for."""

FEWEST = 3
"""Smallest number of values that must agree on a datum; fewer may agree by chance."""

SAME_DATUM = 0.04
"""Relative difference below which two values of a datum count as one, because each is found from a drawing."""

UNLIKE = 0.005
"""Relative difference from the right datum below which a datum does not count as misread."""

NEAT = 2
"""Significant figures of a plausible given datum; half of the last one is allowed if the right datum has it."""

APART = 3.0
"""Number of tolerances by which another datum must move a right value to prove that the datum was read correctly."""


# --- behind many values ---------------------------------------------------------------------------


def misread_by_many(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """Return the misread data behind first wrong values without a named mistake, if many values agree on them."""
    open_ones = [place for place, cell in cells.items() if cell.first and not cell.mistake]
    if len(open_ones) < FEWEST:
        return {}
    candidates = [*_worked_out(working, open_ones), *_candidates(working, open_ones)]
    return behind_many(working, cells, open_ones, candidates, FEWEST)


def _worked_out(working: Working, places: Sequence[Place]) -> Iterator[Mistake]:
    """Yield named mistakes in unseen quantities before several places; at equal counts they precede misread data."""
    scheme = working.scheme
    before = Counter(id for place in places for id in scheme.before[place[0]])
    for id in scheme.ledger.families:
        if before[id] >= FEWEST and scheme.ledger[id].definition is not None:
            yield from unseen_mistakes(working, id)


def _candidates(working: Working, places: Sequence[Place]) -> Iterator[Mistake]:
    """Yield each datum that several of the places depend on, with the values on which most of them agree."""
    for id in _data(working.scheme):
        behind = [place for place in places if id in working.scheme.before[place[0]]]
        if len(behind) < FEWEST:
            continue
        crossings = list(_crossings(working, id, behind))
        factors = np.array([factor for factor, _ in crossings])
        near = np.abs(factors[:, None] / factors[None, :] - 1) < SAME_DATUM
        if not crossings or near.sum(axis=1).max() < FEWEST:
            continue
        together = near[near.sum(axis=1).argmax()]
        # A single value shows the datum more precisely than one from a drawing.
        exact = [factor for (factor, single), one in zip(crossings, together, strict=True) if one and single]
        for factor in (*exact[:1], float(np.median(factors[together]))):
            if abs(factor - 1) > UNLIKE:
                yield Mistake(WRONG_DATUM, id, {id: _times(factor)})


def _times(factor: float) -> ChangeValue:
    return lambda value, _: value * factor


def _data(scheme: MarkingScheme) -> Iterator[str]:
    """Yield the ids of given data, and of loads of a given size, that the sheet does not ask for."""
    for id, family in scheme.ledger.families.items():
        # A ratio is given as 1/3.6, which the ledger evaluates.
        given = not scheme.ledger.inputs[id]
        unseen = not (family.hidden or family.is_plane or id in scheme.rows)
        if (
            given
            and unseen
            and (len(family.values) == 1 or id in scheme.misconceptions.applied)
            and np.any(family.values)
        ):
            yield id


def _crossings(working: Working, id: str, places: Sequence[Place]) -> Iterator[tuple[float, bool]]:
    """Yield the multiples of a datum that give the student's values, and True for single values."""
    scheme = working.scheme
    wanted = {name for place in places for name in (place[0], *scheme.before[place[0]])}
    worlds = follow(scheme.ledger, {id: FACTORS[:, None] * scheme.ledger[id].values}, only=wanted)
    for row, position in places:
        index = scheme.rows[row].at(position)
        column = np.broadcast_to(worlds[row].real, (len(FACTORS), len(scheme.ledger[row].values)))[:, index]
        given = float(working.values[row][index])
        if scheme.is_unsigned(row):
            column, given = np.abs(column), abs(given)
        apart = column - given
        for at in np.flatnonzero(np.diff(np.sign(apart)) != 0):
            before, after = apart[at], apart[at + 1]
            if np.isfinite(before) and np.isfinite(after):
                share = before / (before - after)
                yield float(FACTORS[at] * (1 - share) + FACTORS[at + 1] * share), position == 0


# --- behind single values -------------------------------------------------------------------------
# A datum is inferred backwards: the ledger is evaluated with many values of it at once. The one that gives the
# student's value counts if it is a plausible given number, as round as the right one. Otherwise some datum could
# explain almost any slip of arithmetic.


class _Datum(Record):
    """A given quantity and the value (SI) that the student seems to have used for it."""

    id: str
    value: float

    @property
    def mistake(self) -> Mistake:
        return Mistake(WRONG_DATUM, self.id, {self.id: lambda value, _: np.full_like(value, self.value)})


def misread_data(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """Return the misread data behind first wrong values without a name; of several, the one that explains most values.

    Only quantities that are the same at all positions are traced back: a length, a mass, the crank's speed.
    """
    scheme = working.scheme
    left = [place for place, cell in cells.items() if cell.first and not cell.mistake and scheme.rows[place[0]].single]
    possible = {
        place: [one for one in _possible_data(working, cells[place]) if _explains(working, cells[place], one)]
        for place in left
    }
    mistakes: dict[Place, Mistake] = {}
    candidates = list(dict.fromkeys(one for data in possible.values() for one in data))
    candidates = [one for one in candidates if not _is_contradicted(scheme, cells, one)]
    while left and candidates:
        explained = {one: [place for place in left if _explains(working, cells[place], one)] for one in candidates}
        most = max(map(len, explained.values()))
        equal = [one for one in candidates if len(explained[one]) == most]
        if not most:
            break
        # Values that also depend on wrong values decide between two data that explain equally many.
        best = equal[0] if len(equal) == 1 else max(equal, key=lambda one: _following(working, cells, one))
        mistakes |= dict.fromkeys(explained[best], best.mistake)
        left = [place for place in left if place not in explained[best]]
        candidates.remove(best)
    for place in left:
        # Other values show the right datum, so this is a copying slip: one figure differs, and the result matches
        # fully.
        slip = next((one for one in possible[place] if _is_slip(working, cells[place], one)), None)
        if slip is not None:
            mistakes[place] = slip.mistake
    return mistakes


def _following(working: Working, cells: Cells, datum: _Datum) -> int:
    """Return the number of wrong values that follow from the student's own values with this value of the datum."""
    values, scheme = working.own_values(changes=datum.mistake.changes), working.scheme
    count = 0
    for cell in cells.values():
        if cell.verdict is Verdict.wrong:
            index = _index(scheme, cell)
            apart = scheme.distance(cell.id, values[cell.id][index].real, _given(working, cell))
            count += bool(apart <= cell.band)
    return count


def _possible_data(working: Working, cell: Marked) -> Iterator[_Datum]:
    """Yield round values of each datum at which a quantity equals the student's value."""
    scheme = working.scheme
    for id in scheme.before[cell.id]:
        family = scheme.ledger[id]
        single = len(family.values) == 1 and not (family.hidden or family.is_plane)
        if not single or id in scheme.rows or not family.values[0] > 0:
            continue
        right = float(family.values[0])
        values = _at(scheme, cell, id, WIDE * right) - _given(working, cell)
        crossing = np.flatnonzero(np.diff(np.sign(values)) != 0)
        for index in crossing[np.isfinite(values[crossing]) & np.isfinite(values[crossing + 1])]:
            before, after = values[index], values[index + 1]
            share = before / (before - after)
            lower, upper = WIDE[index], WIDE[index + 1]
            factor = float(lower + share * (upper - lower))
            yield _Datum(id, _neat(scheme, id, right * factor))


def _explains(working: Working, cell: Marked, datum: _Datum) -> bool:
    """Return True if this value of the datum gives the student's value of the quantity, and not the key's."""
    scheme = working.scheme
    if datum.id not in scheme.before[cell.id]:
        return False
    with_it = float(_at(scheme, cell, datum.id, np.array([datum.value]))[0])
    key = float(scheme.ledger[cell.id].values[_index(scheme, cell)].real)
    return abs(with_it - _given(working, cell)) <= cell.band < abs(with_it - key)


def _is_slip(working: Working, cell: Marked, datum: _Datum) -> bool:
    """Return True if the datum differs from the given one by one in its last figure and gives the value as written."""
    right = float(working.scheme.ledger[datum.id].values[0])
    last = 2 * float(half_unit(np.array([right]), NEAT)[0])
    with_it = float(_at(working.scheme, cell, datum.id, np.array([datum.value]))[0])
    assert cell.written is not None, "a wrong value is given"
    written = last_half_unit(cell.written) * cell.unit
    return abs(abs(datum.value - right) - last) < last / 10 and abs(with_it - _given(working, cell)) <= written


def _is_contradicted(scheme: MarkingScheme, cells: Cells, datum: _Datum) -> bool:
    """Return True if a right value that depends on nothing wrong would be far off with this value of the datum.

    Lengths on paper prove nothing, because they are read at the student's own scale.
    """
    values = follow(scheme.ledger, {datum.id: np.array([datum.value])})
    wrong = {place[0] for place, cell in cells.items() if cell.verdict is Verdict.wrong}
    for (id, position), cell in cells.items():
        before = set(scheme.before[id])
        proves = cell.verdict is Verdict.right and not _is_on_paper(scheme, id)
        if proves and datum.id in before and not wrong & before:
            column = np.broadcast_to(values[id].real, len(scheme.ledger[id].values))
            moved = float(column[scheme.rows[id].at(position)]) - cell.expected
            if abs(moved) > APART * cell.band:
                return True
    return False


def _is_on_paper(scheme: MarkingScheme, id: str) -> bool:
    kind = scheme.ledger[id].kind
    return kind == "segment" or kind.endswith("scale") or is_direction(id)


def _at(scheme: MarkingScheme, cell: Marked, id: str, values: np.ndarray) -> np.ndarray:
    """Return a quantity (SI) for several values of a datum [M]."""
    wanted = {*scheme.before[cell.id], cell.id}
    result = follow(scheme.ledger, {id: values[:, None]}, only=wanted)[cell.id].real
    return np.broadcast_to(result, (len(values), len(scheme.ledger[cell.id].values)))[:, _index(scheme, cell)]


def _given(working: Working, cell: Marked) -> float:
    return float(working.values[cell.id][_index(working.scheme, cell)])


def _index(scheme: MarkingScheme, cell: Marked) -> int:
    return scheme.rows[cell.id].at(cell.position)


def _neat(scheme: MarkingScheme, id: str, value: float) -> float:
    """Return the nearest number (SI) as round as the right one in the datum's printed unit.

    For a ratio such as 1/3.6, round its inverse.
    """
    family = scheme.ledger[id]
    # The ledger has lengths in metres, the page in millimetres; the figures are the same.
    taken, right = (one / family.how.scale for one in (value, float(family.values[0])))
    # A ratio that the ledger evaluates was given as 1/3.6.
    if family.kind == "ratio" and taken < 1 and family.definition is not None:
        return family.how.scale / _rounded(1 / taken, 1 / right)
    return _rounded(taken, right) * family.how.scale


def _rounded(value: float, like: float) -> float:
    """Return a number rounded to `NEAT` figures.

    Round to halves of the last figure if `like` has more figures than these or begins with 1.
    """
    begins_with_1 = f"{like:.0e}".startswith("1")
    parts = 1 if np.isclose(like, float(f"{like:.{NEAT - 1}e}"), rtol=1e-9) and not begins_with_1 else 2
    step = 10.0 ** (np.floor(np.log10(value)) - NEAT + 1) / parts
    return float(round(value / step) * step)


# --- a design found by a misread datum -------------------------------------------------------------


def redesigned(working: Working, mistake: Mistake) -> Iterator[Mapping[str, ChangeValue]]:
    """Yield the further changes caused by a misread datum of a design: a mapping for each way to continue."""
    scheme, id = working.scheme, mistake.where
    design = scheme.misconceptions.designs.get(id) if mistake.name == WRONG_DATUM else None
    if design is None:
        return
    taken = float(mistake.changes[id](scheme.ledger[id].values, {})[0])
    # A datum inferred from three-figure values is not exact.
    near = _neat(scheme, id, taken)
    value = near if abs(near / taken - 1) < UNLIKE else taken
    for others in design(value):
        if not any(map(working.shows, others)):
            yield {other: _fixed(values) for other, values in {id: np.array([value]), **others}.items()}


def _fixed(values: np.ndarray) -> ChangeValue:
    return lambda computed, _: np.broadcast_to(values, np.shape(computed))


# --- mistakes in drawing a plan -------------------------------------------------------------------
# A reversed or omitted vector moves every point after it.
# No value on the sheet shows such a mistake directly, and no value read from the plan depends on another one. So all
# values read there are searched together, and a mistake counts if it explains nearly all of them.

FEWEST_READ = 2
"""Smallest number of readings that must agree; one value alone may have been read wrongly."""

AGREED = 0.7
"""Share of the first wrong values behind a vector that a mistake in it must explain."""


def mistakes_of_plans(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """Return the reversed or omitted vectors behind first wrong values that have no name yet."""
    open_ones = [place for place, cell in cells.items() if cell.first and not cell.mistake and place[1]]
    candidates = list(_vectors_laid(working.scheme))
    mistakes: dict[Place, Mistake] = {}
    for position in dict.fromkeys(position for _, position in open_ones):
        here = [place for place in open_ones if place[1] == position]
        mistakes |= behind_many(working, cells, here, candidates, FEWEST_READ)
    return mistakes


def behind_many(
    working: Working, cells: Cells, places: Sequence[Place], candidates: Sequence[Mistake], fewest: int
) -> dict[Place, Mistake]:
    """Return the mistakes that explain nearly all wrong values behind them, `fewest` at least.

    The mistakes that explain most values come first.
    """
    scheme = working.scheme
    first = list(dict.fromkeys(id for id, _ in places))
    before = {id: {*scheme.before[id]} for id in first}
    candidates = [one for one in candidates if any(one.changes.keys() & before[id] for id in first)]
    if len(places) < fewest or not candidates:
        return {}
    values = foreseen(working, first, candidates)
    met = {place: _met(working, cells, place, values[place[0]]) for place in places}
    mistakes: dict[Place, Mistake] = {}
    left = list(places)
    while best := _best(candidates, left, met, before, fewest):
        mistake, explained = best
        mistakes |= dict.fromkeys(explained, mistake)
        left = [place for place in left if place not in explained]
    return mistakes


def _vectors_laid(scheme: MarkingScheme) -> Iterator[Mistake]:
    """Yield each vector of a plan, and each load as a whole, omitted or reversed."""
    ledger = scheme.ledger
    for id, family in ledger.families.items():
        if family.definition is not None and vocabulary.is_laid(id) and family.is_plane and not family.of:
            # This is the vector of a force, or the length of aⁿ on paper; a line of the report gives it for aⁿ itself.
            source = ledger[refs(family.definition)[0]]
            if source.of:
                yield from _either("force-left-out", "force-reversed", source.of, id)
            elif source.definition is not None:
                yield from _either("part-left-out", "part-reversed", refs(source.definition)[0], id)
    for load in scheme.misconceptions.loads:
        vector = ids.force_vector(load)
        yield from _either("load-forgotten", "load-reversed", load, vector if vector in ledger else load)


def _either(left_out: str, reversed_: str, where: str, id: str) -> Iterator[Mistake]:
    yield Mistake(left_out, where, {id: lambda value, _: value * 0})
    yield Mistake(reversed_, where, {id: lambda value, _: -value})


def _met(working: Working, cells: Cells, place: Place, values: np.ndarray) -> np.ndarray:
    """Return a mask of the candidates whose value [candidates, positions] is the student's and not the right one."""
    scheme, cell = working.scheme, cells[place]
    index = scheme.rows[place[0]].at(place[1])
    given, band = float(working.values[place[0]][index]), cell.band
    expected = values[:, index]
    wider = np.maximum(1.0, np.abs(expected) / max(abs(cell.own), band))
    near = scheme.distance(place[0], given, expected) <= band * wider
    shows = scheme.distance(place[0], cell.own, expected) > band
    return np.asarray(near & shows)


def _best(
    candidates: list[Mistake], left: list[Place], met: dict[Place, np.ndarray], before: dict[str, set[str]], fewest: int
) -> tuple[Mistake, list[Place]] | None:
    """Return the mistake that explains most of the remaining values, if it explains nearly all that it changes."""
    best: tuple[Mistake, list[Place]] | None = None
    for number, mistake in enumerate(candidates):
        behind = [place for place in left if mistake.changes.keys() & before[place[0]]]
        explained = [place for place in behind if met[place][number]]
        if len(explained) >= max(fewest, AGREED * len(behind), len(best[1]) + 1 if best else 0):
            best = mistake, explained
    return best
