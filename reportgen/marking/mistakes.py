"""Named mistakes in calculations (`mistakes_in`), each defined as a change of the ledger, which is evaluated with it.

A `Mistake` says in which quantity it is made, which quantities of the ledger change, and to which value. The new value
(SI) is computed from the right value and all values before it. `slips_of_writing` and `mistakes_of_working` name the
first wrong values of a sheet.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from reportgen.base.records import Record
from reportgen.case.answer_key import Role
from reportgen.formula import Call, Expression, Negative, Sum, ids, rebuild, refs, walk
from reportgen.formula.calculation import Family
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import follow
from reportgen.machine import DRIVER
from reportgen.marking.marking_data import Cells, Marked, Place, Verdict
from reportgen.marking.marking_scheme import MarkingScheme, Values
from reportgen.marking.special_point_mistakes import of_special_points
from reportgen.marking.student_values import ChangeValue, Working
from reportgen.marking.tolerance_bands import half_unit, is_direction

WRONG_DATUM = "wrong-datum"
"""Name of the mistake of a misread given datum."""

NO_CORIOLIS = "no-coriolis"
"""Name of the mistake of an omitted Coriolis acceleration."""

OF_POSITION = frozenset({"counted-backwards", "shifted-forward", "shifted-back"})
"""Mistakes about the position; a single value may match another position's by chance."""

DECIMAL_PLACES = (1, 2, 3, 4, 5)
"""Numbers of decimals that are lost if a decimal mark is read as a thousands mark."""

TRIGONOMETRIC = {"sin", "cos", "tan"}
INVERSE = {"arcsin", "arccos", "arctan", "arctan2"}


class Mistake(Record):
    """A mistake that can be made in one quantity.

    `name` is a key of `mistakes` in `words.yaml`, `where` the id of the quantity in which it is made.
    """

    name: str
    where: str
    changes: Mapping[str, ChangeValue]


def mistakes_in(scheme: MarkingScheme, id: str, scales: Values) -> Iterator[Mistake]:
    """Yield all mistakes that can be made in computing one quantity.

    `scales` (SI) [1] or [N] are the student's own. A value printed for every position (the crank's angle) can only be
    taken from another position.
    """
    family = scheme.ledger[id]
    if family.exact and len(family.values) > 1:
        return
    for name, change in _changes_of(scheme, family, scales):
        yield Mistake(name, id, {id: change})


def general_mistakes(scheme: MarkingScheme) -> Iterator[Mistake]:
    """Yield mistakes about the positions, and an omitted Coriolis acceleration."""
    ledger = scheme.ledger
    read = [id for id, family in ledger.families.items() if family.definition is None and len(family.values) > 1]
    if read:
        count = len(ledger[read[0]].values)
        order = np.arange(count)
        for name, taken in (
            ("counted-backwards", -order % count),
            ("shifted-forward", np.roll(order, -1)),
            ("shifted-back", np.roll(order, 1)),
        ):
            yield Mistake(name, read[0], {id: _replaced_by(ledger[id].values[taken]) for id in read})
    for id, family in ledger.families.items():
        if family.kind == "acceleration" and family.symbol.sup == "k":
            yield Mistake(NO_CORIOLIS, id, {id: _times(0)})
    yield from _of_an_accelerated_driver(scheme)
    yield from (Mistake(*made) for made in of_special_points(ledger))


def _of_an_accelerated_driver(scheme: MarkingScheme) -> Iterator[Mistake]:
    """Yield the mistakes of an accelerated driver: aᵗ of the crank pin omitted, J₁ε₁ forgotten."""
    if ids.signed("eps", DRIVER) not in scheme.ledger:
        return
    for id in scheme.ledger.families:
        if (names := ids.acceleration.read(id)) and names["part"] == "t" and len(ids.points(names["point"])) == 1:
            yield Mistake("no-tangential", id, {id: _times(0)})
    if (couple := ids.inertia_couple(DRIVER)) in scheme.ledger:
        both = (couple, ids.couple(ids.inertia_force(DRIVER)))
        yield Mistake("no-couple-of-driver", couple, {id: _times(0) for id in both})


def _changes_of(scheme: MarkingScheme, family: Family, scales: Values) -> Iterator[tuple[str, ChangeValue]]:
    """Yield the changed values of one quantity for each mistake, by name."""
    id = family.id
    for known in (scheme.misconceptions.changed, scheme.misconceptions.approximations):
        yield from ((name, _with(other, {})) for name, other in known.get(id, ()))
    if family.definition is not None:
        yield from _in_a_definition(scheme, family, family.definition, scales)
    for name, reading in scheme.misconceptions.readings.get(id, ()):
        yield name, _replaced_by(reading)
    if (rod := scheme.misconceptions.whole.get(id)) is not None:
        yield "wrong-end", lambda value, values: values[rod] - value
    if is_direction(id):
        yield "direction-reversed", lambda value, _: value + np.pi
        return
    if family.is_signed_rotation:
        yield "direction-reversed", lambda value, _: -value
    elif not family.arm and family.kind != "segment" and (family.definition is not None or not family.exact):
        yield "sign-reversed", lambda value, _: -value
    for places in DECIMAL_PLACES:
        yield "thousands-mark", _times(10.0**places)


def _in_a_definition(
    scheme: MarkingScheme, family: Family, definition: Expression, scales: Values
) -> Iterator[tuple[str, ChangeValue]]:
    used = [scheme.ledger[ref] for ref in dict.fromkeys(refs(definition))]
    for given in used:
        yield from _with_a_wrong_input(scheme, family, definition, given, scales)
    if family.kind == "ratio" and len(family.values) == 1:
        yield "ratio-inverted", lambda value, _: 1 / value
    if family.kind == "angle" and _calls(definition, INVERSE):
        yield "radians-for-degrees", _times(np.pi / 180)
    if _calls(definition, TRIGONOMETRIC):
        angles = [given.id for given in used if given.kind in ("angle", "direction")]
        yield "degrees-for-radians", _with(definition, {id: _degrees(id) for id in angles})
    if not family.constructed:
        for changed in _other_signs(definition):
            yield "sign-reversed", _with(changed, {})


def _with_a_wrong_input(
    scheme: MarkingScheme, family: Family, definition: Expression, given: Family, scales: Values
) -> Iterator[tuple[str, ChangeValue]]:
    """Yield the mistakes about one input of a definition."""
    ledger, id = scheme.ledger, given.id

    def as_printed(_: np.ndarray, values: Values) -> np.ndarray:
        """Return the printed number of the input, used as the result's printed number."""
        return values[id] / given.how.scale * family.how.scale

    def instead(wrong_input: Callable[[Values], np.ndarray]) -> ChangeValue:
        return _with(definition, {id: wrong_input})

    if id == "H" and family.kind == "length":
        yield "stroke-for-radius", lambda _, values: values[id]
    elif given.kind == "ratio" and not given.hidden and not given.is_plane:
        yield "ratio-inverted", instead(lambda values: 1 / values[id])
    elif given.kind == "diameter":
        yield "diameter-for-radius", instead(lambda values: 2 * values[id])
    elif given.kind == "speed of rotation":
        yield "rpm-for-radians", as_printed
        # 2πn without division by 60.
        yield "minute-for-second", _times(60.0)
    elif id == "omega.1" and "n" in ledger:
        yield "rpm-for-radians", instead(lambda values: values["n"])
    elif given.kind == "weight" and family.kind == "mass":
        yield "weight-for-mass", as_printed
    elif given.kind == "mass" and (weight := _weight(scheme, given)):
        yield "weight-for-mass", instead(lambda values: values[weight])
    elif given.kind.endswith("scale") and not family.constructed and (power := _power(scheme, definition, id)):
        number = scales.get(id, given.values) / given.how.scale
        # v = seg or v = μ²·seg in place of v = μ·seg.
        yield "scale-forgotten", _times(number**-power)
        yield "scale-twice", _times(number**power)


def _weight(scheme: MarkingScheme, mass: Family) -> str:
    """Return the id of the weight of the link that a mass belongs to, or "" if there is none."""
    weights = (one for one in scheme.ledger.families.values() if one.kind == "weight")
    return next((one.id for one in weights if one.symbol.sub == mass.symbol.sub), "")


def _power(scheme: MarkingScheme, definition: Expression, scale: str) -> int:
    """Return the power (±1) of a scale in a whole definition; 0 if the definition is not proportional to one."""
    values = {id: scheme.ledger[id].values for id in refs(definition)}
    with np.errstate(all="ignore"):
        once = np.atleast_1d(evaluate(definition, values))
        twice = np.atleast_1d(evaluate(definition, values | {scale: 2 * values[scale]}))
        ratio = (twice / once)[np.isfinite(twice / once)]
    for power in (1, -1):
        if ratio.size and np.allclose(ratio, 2.0**power):
            return power
    return 0


# --- changes ----------------------------------------------------------------------------------------


def _times(factor: float | np.ndarray) -> ChangeValue:
    return lambda value, _: value * factor


def _replaced_by(values: np.ndarray) -> ChangeValue:
    return lambda _, __: values


def _degrees(id: str) -> Callable[[Values], np.ndarray]:
    return lambda values: np.degrees(values[id])


def _with(definition: Expression, others: Mapping[str, Callable[[Values], np.ndarray]]) -> ChangeValue:
    """Return the definition evaluated with other values of some of its inputs."""

    names = refs(definition)

    def change(_: np.ndarray, values: Values) -> np.ndarray:
        inputs = {id: others[id](values) if id in others else values[id] for id in names}
        return np.atleast_1d(evaluate(definition, inputs))

    return change


def _calls(definition: Expression, names: set[str]) -> bool:
    return any(isinstance(part, Call) and part.name in names for part in walk(definition))


def _other_signs(definition: Expression) -> Iterator[Expression]:
    """Yield the definition with the sign of one term reversed, for every term of its sums."""
    for part in walk(definition):
        if isinstance(part, Sum) and len(part.terms) > 1:
            for index, term in enumerate(part.terms):
                turned = term.of if isinstance(term, Negative) else Negative(term)
                changed = Sum((*part.terms[:index], turned, *part.terms[index + 1 :]))
                yield _put(definition, part, changed)


def _put(node: Expression, old: Expression, new: Expression) -> Expression:
    return new if node is old else rebuild(node, lambda child: _put(child, old, new))


# --- the first wrong values by name ---------------------------------------------------------------
# This section covers slips of writing and mistakes in calculations; misread data have their own module.

FEW_FIGURES = 2
"""Number of significant figures that is too few, but still shows the value; one figure shows too little."""

FEWEST_ANGLES = 4
"""Smallest number of angles that can show a convention."""

AGREED = 0.8
"""Share of the angles that are not right that one convention must explain."""

CONVENTIONS: tuple[tuple[str, float, float], ...] = (
    ("angle-clockwise", -1.0, 0.0),
    ("angle-from-vertical", 1.0, -90.0),
    ("angle-from-vertical", -1.0, 90.0),
    ("angle-from-vertical", 1.0, 90.0),
)
"""Other conventions for measuring angles: name, factor and summand (°) of the requested angle."""

OWN_FIGURES = 0.1
"""Share of itself to which a value that is zero within its tolerance must match a mistake's value."""

OF_WRITING = frozenset({"thousands-mark", "sign-reversed"})
"""Slips of writing, which are impossible in a value that is not written; by chance one of hundreds would match."""


# --- slips of writing -----------------------------------------------------------------------------
# Too few figures, a value in another cell, angles by another convention: no calculation was wrong, so these slips
# are found on the sheet alone, before mistakes in calculations are searched for.


def slips_of_writing(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """Return the known slips behind first wrong values."""
    scheme = working.scheme
    first = {place: cell for place, cell in cells.items() if cell.first}
    slips = (
        *_misplaced(scheme, first, cells),
        *(
            ("too-few-figures", place)
            for place, cell in first.items()
            if _has_too_few_figures(cell) and not _comes_of_a_misconception(working, place)
        ),
        # The scale was copied from the task while the plan was drawn at another one.
        *(
            ("other-scale", place)
            for place, cell in first.items()
            if scheme.rows[place[0]].role is Role.scale and _is_other_scale(scheme, cell)
        ),
        *_by_another_convention(first, cells),
    )
    # A slip of writing affects nothing unseen, so it changes no other quantity.
    return {place: Mistake(name, place[0], {}) for name, place in slips}


def _is_other_scale(scheme: MarkingScheme, cell: Marked) -> bool:
    """Return True if a scale is the task's, or freely chosen, but not the one of the drawing."""
    usual = float(scheme.key.row(cell.id).values[0])
    return cell.on_sheet.equals(usual, cell.on_sheet.band) or scheme.ledger[cell.id].kind == "force scale"


def _has_too_few_figures(cell: Marked) -> bool:
    """Return True if a value is right except for the number of its figures."""
    sheet = cell.on_sheet
    given = sheet.given
    return (
        given is not None
        and given != 0
        and any(
            given == float(f"{value:.{FEW_FIGURES}g}") and abs(given - value) > sheet.band
            for value in (sheet.own, sheet.expected)
        )
    )


def _comes_of_a_misconception(working: Working, place: Place) -> bool:
    """Return True if a known misconception gives the value to three figures: a_w = a of 200 mm is not rounded."""
    (id, position), scheme = place, working.scheme
    known = [Mistake(name, id, {id: _with(other, {})}) for name, other in scheme.misconceptions.changed.get(id, ())]
    index = scheme.rows[id].at(position)
    values, given = foreseen(working, [id], known)[id][:, index], working.values[id][index]
    return bool((np.abs(values - given) <= half_unit(given, FEW_FIGURES + 1)).any())


def _misplaced(scheme: MarkingScheme, first: Cells, cells: Cells) -> Iterator[tuple[str, Place]]:
    """Yield two values of one unit in each other's rows, and a value beside its own cell, which is empty."""
    for (here, mine), (there, theirs) in combinations(first.items(), 2):
        same = here[1] == there[1] and scheme.rows[here[0]].unit == scheme.rows[there[0]].unit
        # If two values differ only in sign, both signs were reversed.
        opposite = abs(mine.on_sheet.expected + theirs.on_sheet.expected) <= mine.on_sheet.band
        if same and not opposite and _belongs_to(mine, theirs) and _belongs_to(theirs, mine):
            yield "rows-swapped", here
            yield "rows-swapped", there
    for place, cell in first.items():
        beside = [cells[place[0], position] for position in scheme.rows[place[0]].positions]
        if any(one.verdict is Verdict.blank and _belongs_to(cell, one) for one in beside):
            yield "wrong-column", place


def _belongs_to(cell: Marked, neighbour: Marked) -> bool:
    """Return True if a value is the right one of another cell, and not of its own."""
    own, theirs = cell.on_sheet, neighbour.on_sheet
    return own.equals(theirs.expected, theirs.band) and abs(own.expected - theirs.expected) > theirs.band


def _by_another_convention(first: Cells, cells: Cells) -> Iterable[tuple[str, Place]]:
    """Return directions that one other convention explains, if it explains most of those that are not right."""
    angles = {place: cell for place, cell in cells.items() if is_direction(place[0]) and cell.given is not None}
    off = sum(cell.verdict is not Verdict.right for cell in angles.values())
    best: list[tuple[str, Place]] = []
    for name, factor, summand in CONVENTIONS:
        met = [(name, place) for place in first if place in angles and _is_measured(angles[place], factor, summand)]
        if len(met) >= max(FEWEST_ANGLES, AGREED * off, len(best) + 1):
            best = met
    return best


def _is_measured(cell: Marked, factor: float, summand: float) -> bool:
    sheet = cell.on_sheet
    assert sheet.given is not None
    apart = (sheet.given - factor * sheet.expected - summand + 180) % 360 - 180
    return abs(apart) <= sheet.band


# --- mistakes of working --------------------------------------------------------------------------
# A mistake may have been made in the wrong quantity itself, or in one before it that the sheet does not show.
# All of them are evaluated at once, [mistakes, positions]. The one that matches most of the wrong values of a
# quantity, and matches them best, gives its name.


def mistakes_of_working(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """Return the known mistakes behind the first wrong values that have no name yet."""
    by_row: dict[str, list[int]] = {}
    for (id, position), cell in cells.items():
        if cell.first and not cell.mistake:
            by_row.setdefault(id, []).append(position)
    # A student continues with the rounded value written down, or with the one left in the calculator.
    right = {place for place, cell in cells.items() if cell.verdict is Verdict.right}
    gone_on_from = (working, working.unrounded(right)) if by_row else ()
    explained = {
        (id, position): mistake
        for id, positions in by_row.items()
        for position, mistake in _explained(gone_on_from, cells, id, positions)
    }
    counts = Counter(mistake.name for mistake in explained.values())
    return {place: one for place, one in explained.items() if one.name not in OF_POSITION or counts[one.name] > 1}


def _explained(
    gone_on_from: Sequence[Working], cells: Cells, id: str, positions: Sequence[int]
) -> Iterator[tuple[int, Mistake]]:
    """Yield the mistake at each wrong position of a quantity, if one is found.

    The first working is the one handed in.
    """
    working = gone_on_from[0]
    scheme = working.scheme
    candidates = list(_candidates(working, id))
    if not candidates:
        return
    row = scheme.rows[id]
    index = [row.at(position) for position in positions]
    given = working.values[id][index]
    here = [cells[id, position] for position in positions]
    band, own, expected = (np.array([getattr(cell, name) for cell in here]) for name in ("band", "own", "expected"))
    values = np.concatenate([foreseen(one, [id], candidates)[id][:, index] for one in gone_on_from])
    # The candidates of each working follow each other; their names are repeated in the same order.
    candidates = candidates * len(gone_on_from)
    # A mistake that enlarges a value makes it less certain by the same factor.
    wider = np.maximum(1.0, np.abs(values) / np.maximum(np.abs(own), band))
    apart = scheme.distance(id, given, values)
    off = apart / (band * wider)
    shows = np.min([scheme.distance(id, one, values) for one in (own, expected)], axis=0) > band
    # Many mistakes give nearly zero: a value near zero shows one only if it matches in its own figures.
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
    """Yield mistakes in the quantity itself, then in unseen quantities before it (nearest first), then general ones."""
    scheme = working.scheme
    yield from mistakes_in(scheme, id, working.scales)
    size = scheme.ledger.size_of(id)
    if size != id:
        yield from mistakes_in(scheme, size, working.scales)
    before = scheme.before[id]
    for earlier in before:
        if earlier != size:
            yield from unseen_mistakes(working, earlier)
    concerned = {*before, id}
    yield from (mistake for mistake in general_mistakes(scheme) if concerned & mistake.changes.keys())


def unseen_mistakes(working: Working, id: str) -> Iterator[Mistake]:
    """Yield mistakes in a quantity that the sheet does not show.

    Lengths on paper and scales have none, because nobody draws a plan many times too large.
    """
    family = working.scheme.ledger[id]
    drawn = family.kind == "segment" or family.kind.endswith("scale")
    if not (working.shows(id) or family.hidden or family.is_plane or drawn):
        yield from (one for one in mistakes_in(working.scheme, id, working.scales) if one.name not in OF_WRITING)


def foreseen(working: Working, ids: Sequence[str], mistakes: Sequence[Mistake]) -> dict[str, np.ndarray]:
    """Return the values (SI) of quantities with each mistake, from the student's own values [mistakes, positions]."""
    scheme = working.scheme
    ledger = scheme.ledger
    made: dict[str, list[tuple[int, ChangeValue]]] = {}
    for number, mistake in enumerate(mistakes):
        for changed, change in mistake.changes.items():
            made.setdefault(changed, []).append((number, change))
    judged = {*ids, *map(ledger.size_of, ids)}

    def with_mistakes(name: str) -> ChangeValue:
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

    wanted = {*ids}.union(*(scheme.before[id] for id in ids))
    names = {name for name in (*working.entered_ids, *made) if name in wanted}
    values = follow(ledger, {name: with_mistakes(name) for name in names}, only=wanted)
    return {id: np.broadcast_to(values[id], (len(mistakes), len(ledger[id].values))).real for id in ids}


class _RowOf(Mapping[str, np.ndarray]):
    """The values for one of several mistakes, taken from arrays with a row for each mistake."""

    def __init__(self, values: Values, number: int) -> None:
        self.all, self.number = values, number

    def __getitem__(self, id: str) -> np.ndarray:
        value = self.all[id]
        return value if value.ndim == 1 else value[self.number % len(value)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.all)

    def __len__(self) -> int:
        return len(self.all)
