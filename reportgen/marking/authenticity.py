"""Detect sheets that are probably not the student's own work: `check_authenticity`.

Five patterns are searched for: one number throughout, rows or columns that do not vary, data of another assignment, and
values of a classmate. Each result is a `Notice` with its places and its reason. Marks are deducted only for a certain
result, and only if the policy allows it.

Copying shows in personal values: they differ from the key and from the consequence of the student's own values by more
than rounding. Honest values sometimes equal a classmate's. The number of such matches by chance follows a binomial
tail, multiplied by the numbers of classmates, chapters and positions compared. A run is reported only if it is rarer
than `CHANCE`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.case.answer_key import Key, KeyRow, Role
from reportgen.formula import vocabulary
from reportgen.formula.evaluation import evaluate
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.marking_data import Cells, Marked, Notice, Place, Submission, Verdict
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.mistakes import WRONG_DATUM
from reportgen.marking.student_values import Working, last_half_unit
from reportgen.marking.tolerance_bands import is_direction

FOREIGN_SHARE = 0.8
"""Share of a sheet's, a column's or a chapter's values that must be foreign for a notice."""

ALL = 0.95
"""Share that counts as all values, allowing for a slip or two."""

FEWEST = 4
"""Smallest number of matching values; fewer may agree by chance."""

FEWEST_ROWS = 8
"""Smallest number of rows that can show that two columns are equal."""

APART = 3.0
"""Number of tolerances by which two values must differ to be certainly different."""

OTHER_DATA = 3
"""Number of misread given data from which the sheet counts as one with other data; one or two are misread."""

NAMED = 2
"""Smallest number of these that are identified by the datum that explains them."""

INVENTED = 5
"""Number of wrong values computed from given data alone, of any kind, that also counts as other data."""

CHANCE = 3e-4
"""Largest probability that an honest sheet is reported as copied; the test suite checks it to 1 in 1000."""

NEAR, FAR = 0.3, 0.02
"""Probabilities that a value equals a classmate's in all figures: right within the drawing's tolerance, or wrong.

A length of 0.1 mm read to ± 0.3 mm equals another reading of it in one case of four. A wrong value may be any of about
a hundred three-figure numbers nearby.
"""

LAST = 1.5
"""Number of units of the last figure that rounding can explain."""

DEGREE = 1.0
"""Step (°) to which a direction is read."""

STEPS = (1.0, 0.5)
TENTH = 0.1
"""Step (mm) to which lengths on paper are read if they show it; otherwise they are read to 1 mm or 0.5 mm."""


class Classmate(Record):
    """Another student's assignment, and the sheet submitted for it."""

    key: Key
    submission: Submission | None = None


def check_authenticity(
    scheme: MarkingScheme, cells: Cells, classmates: Sequence[Classmate]
) -> tuple[dict[Place, Marked], tuple[Notice, ...]]:
    """Return the cells after the policy's deductions, and a notice of each pattern found."""
    result, flags = dict(cells), []
    for search in (_one_number, _same_columns, _constant_rows):
        flags += list(search(scheme, cells))
    flags += _other_data(scheme, cells, classmates)
    flags += _copied(scheme, cells, classmates)
    policy = scheme.policy
    for number, flag in enumerate(flags):
        places = flag.spoiled if policy.takes(flag.kind, scheme.key.id) else ()
        taken = [place for place in places if result[place].points]
        if taken:
            flags[number] = replace(flag, taken=tuple(taken))
            result |= {place: replace(result[place], verdict=Verdict.implausible, points=0.0) for place in taken}
        for place in flag.places:
            if flag.classmate:
                names = (*result[place].classmates, flag.classmate)
                result[place] = replace(result[place], classmates=tuple(dict.fromkeys(names)))
    return result, tuple(flags)


def unseen_text(cells: Iterable[Marked], submission: Submission) -> tuple[Notice, ...]:
    """Return a notice of values in hidden text of a report. These values are not read and earn no points."""
    places = tuple(place for cell in cells if (place := (cell.id, cell.position)) in submission.unseen)
    return (Notice("unseen", places),) if places else ()


def _filled(cells: Cells) -> list[Place]:
    return [place for place, cell in cells.items() if cell.written is not None]


# --- the sheet alone ------------------------------------------------------------------------------


def _one_number(scheme: MarkingScheme, cells: Cells) -> Iterator[Notice]:
    """Yield a notice if nearly all cells have the same number and most of them should not."""
    filled = _filled(cells)
    number, _ = Counter(cells[place].written for place in filled).most_common(1)[0] if filled else (None, 0)
    same = tuple(place for place in filled if cells[place].written == number)
    wrong = [place for place in same if cells[place].verdict is not Verdict.right]
    if len(same) >= FOREIGN_SHARE * len(filled) and len(wrong) >= max(FEWEST, len(same) / 2):
        yield Notice("stock", same, tuple(filled))


def _constant_rows(scheme: MarkingScheme, cells: Cells) -> Iterator[Notice]:
    """Yield a notice for each row with the same number throughout if the key varies by more than its bands."""
    rows: dict[str, list[Place]] = {}
    for place in _filled(cells):
        rows.setdefault(place[0], []).append(place)
    for places in rows.values():
        row = [cells[place] for place in places]
        varies = np.ptp([cell.on_sheet.expected for cell in row]) > APART * max(cell.on_sheet.band for cell in row)
        if len(row) >= FEWEST and len({cell.written for cell in row}) == 1 and varies:
            yield Notice("constant", tuple(places))


def _same_columns(scheme: MarkingScheme, cells: Cells) -> Iterator[Notice]:
    """Yield a notice for each position whose values equal another's digit for digit though the key's differ."""
    positions = sorted({position for _, position in _filled(cells) if position})
    copies: set[int] = set()
    for first, second in combinations(positions, 2):
        distinguishing = [
            id for id, position in cells if position == first and _differ(cells, (id, first), (id, second))
        ]
        same = [id for id in distinguishing if cells[id, first].written == cells[id, second].written]
        if (
            len(distinguishing) < FEWEST_ROWS
            or len(same) < FOREIGN_SHARE * len(distinguishing)
            or {first, second} <= copies
        ):
            continue
        right = {k: sum(cells[id, k].verdict is Verdict.right for id in same) for k in (first, second)}
        copy = first if first in copies or (second not in copies and right[first] < right[second]) else second
        copies.add(copy)
        # Values that are right all the same keep their points.
        spoiled = tuple(place for place in cells if place[1] == copy and cells[place].verdict is Verdict.follows)
        yield Notice("columns", tuple((id, copy) for id in same), spoiled, classmate="", count=len(distinguishing))


def _differ(cells: Cells, first: Place, second: Place) -> bool:
    """Return True if both places have a value and their values in the key differ clearly."""
    if second not in cells or cells[first].written is None or cells[second].written is None:
        return False
    band = max(cells[first].on_sheet.band, cells[second].on_sheet.band)
    return abs(cells[first].on_sheet.expected - cells[second].on_sheet.expected) >= APART * band


def _other_data(scheme: MarkingScheme, cells: Cells, classmates: Sequence[Classmate]) -> Iterator[Notice]:
    """Yield a notice if the values belong to other data than the assignment's.

    Two data are enough if the whole sheet is right for a classmate's assignment that has these data.
    """
    first = [place for place, cell in cells.items() if cell.first and cell.position == 0]
    named = [place for place in first if cells[place].mistake == WRONG_DATUM]
    # A wrong value computed from given data alone, without a known mistake, may also come from other data.
    alone = [place for place in first if not any(id in scheme.rows for id in scheme.before[place[0]])]
    unnamed = [place for place in alone if not cells[place].mistake]
    misread = {cells[place].where for place in named}
    classmate_id = ""
    if len(misread) >= NAMED:
        classmate_id = next((one.key.id for one in classmates if _is_right_for(scheme, cells, one)), "")
    if classmate_id or len(misread) + len(unnamed) >= (OTHER_DATA if len(misread) >= NAMED else INVENTED):
        causes = {*named, *unnamed}
        follows = (place for place, cell in cells.items() if cell.verdict is Verdict.follows)
        spoiled = (one for one in follows if scheme.depends_on(one, causes) or misread & {*scheme.before[one[0]]})
        # In the order of the sheet, so that every run gives the same result.
        yield Notice(
            "other-data", tuple(place for place in first if place in causes), tuple(spoiled), classmate=classmate_id
        )


def _is_right_for(scheme: MarkingScheme, cells: Cells, classmate: Classmate) -> bool:
    """Return True if nearly all values that distinguish a classmate's assignment from this one are the classmate's."""
    distinguishing = met = 0
    for cell in cells.values():
        row = _row(classmate, cell)
        if cell.written is None or row is None or _is_drawn(row):
            continue
        theirs = float(row.values[row.at(cell.position)])
        if _apart(scheme, cell, theirs, cell.on_sheet.expected) >= APART * cell.on_sheet.band:
            distinguishing += 1
            met += _apart(scheme, cell, cell.written, theirs) <= cell.on_sheet.band
    return distinguishing >= FEWEST_ROWS and met >= ALL * distinguishing


# --- classmates -----------------------------------------------------------------------------------


def _copied(scheme: MarkingScheme, cells: Cells, classmates: Sequence[Classmate]) -> list[Notice]:
    """Return notices of runs of values equal to a classmate's sheet or key, by chapter, by position and overall."""
    step = _read_to(scheme, cells)
    own = {
        place: cell for place, cell in cells.items() if cell.written is not None and _is_personal(scheme, cell, step)
    }
    right = [cell for cell in cells.values() if cell.verdict is Verdict.right]
    others = [one for one in classmates if one.key.id != scheme.key.id and not _is_source(scheme, right, one)]
    runs: dict[KeyChapter | int, list[Place]] = {}
    for place in own:
        runs.setdefault(scheme.rows[place[0]].part, []).append(place)
        if place[1]:
            runs.setdefault(place[1], []).append(place)
    parts = [*runs.values(), list(own)]
    compared = 2 * len(others) * len(parts)
    flags: list[Notice] = []
    for classmate in others:
        meets = {place: _meets(scheme, cell, classmate) for place, cell in own.items()}
        copied: dict[Place, None] = {}
        chance = 1.0
        wrong = [[place for place in part if not _is_near(own[place])] for part in parts]
        for part in (*parts, *wrong):
            distinguishing = [place for place in part if meets[place] is not None]
            met = [place for place in distinguishing if meets[place]]
            if len(met) < max(FEWEST, FOREIGN_SHARE * len(distinguishing)):
                continue
            by_chance = compared * _tail([NEAR if _is_near(own[place]) else FAR for place in distinguishing], len(met))
            if by_chance < CHANCE:
                copied |= dict.fromkeys(met)
                chance = min(chance, by_chance)
        if copied:
            flags.append(Notice("classmate", tuple(copied), classmate=classmate.key.id, chance=chance))
    # If several classmates have the same values, the closest is named first. A sheet is copied whole if nearly all its
    # values match.
    flags.sort(key=lambda flag: -len(flag.places))
    by_id = {one.key.id: one for one in others}
    filled = tuple(_filled(cells))
    for number, flag in enumerate(flags):
        classmate = by_id[flag.classmate]
        if _is_whole(scheme, cells, classmate):
            flags[number] = replace(flag, kind="classmate-sheet", spoiled=filled)
        elif copied_on := _of_key(scheme, cells, own, classmate):
            flags[number] = replace(flag, kind="classmate-key", spoiled=copied_on)
    return flags


def _of_key(scheme: MarkingScheme, cells: Cells, own: Cells, classmate: Classmate) -> tuple[Place, ...]:
    """Return the places that follow only from values of the same classmate's key, if most wrong values are from it.

    Wrong values without a named mistake do not come from the student's own data, and neither do values that depend on
    them. A student who misread a datum has few of them, because the rest follows from the misread datum.
    """
    unexplained = [place for place, cell in own.items() if cell.verdict is Verdict.wrong and not cell.mistake]
    meets = {place: met for place in unexplained if (met := _meets(scheme, cells[place], classmate)) is not None}
    if sum(meets.values()) < max(FEWEST_ROWS, ALL * len(meets)):
        return ()
    causes = {place for place, met in meets.items() if met}
    follows = [place for place, cell in cells.items() if cell.verdict is Verdict.follows and cell.written is not None]
    return tuple(
        place for place in follows if scheme.depends_on(place, causes) and _meets(scheme, cells[place], classmate)
    )


def _is_whole(scheme: MarkingScheme, cells: Cells, classmate: Classmate) -> bool:
    """Return True if a sheet has nearly all those values of a classmate's that are wrong on it."""
    distinguishing = [
        cell
        for place, cell in cells.items()
        if cell.written is not None
        and (theirs := _theirs(classmate, place)) is not None
        and _apart(scheme, cell, theirs, cell.on_sheet.expected) > cell.on_sheet.band
    ]
    met = sum(_equal(cell, _theirs(classmate, (cell.id, cell.position))) for cell in distinguishing)
    return len(distinguishing) > FEWEST_ROWS and met >= FOREIGN_SHARE * len(distinguishing)


def _is_source(scheme: MarkingScheme, right: Sequence[Marked], classmate: Classmate) -> bool:
    """Return True if the other sheet was copied from this one: its values are `right` here and wrong there.

    Values that depend on a scale are ignored, because the classmate may have chosen another scale than the key.
    """
    taken = 0
    for cell in right:
        # Few values are equal, so this is checked first: there may be hundreds of classmates.
        if not _equal(cell, _theirs(classmate, (cell.id, cell.position))):
            continue
        row = _row(classmate, cell)
        if row is not None and not _is_drawn(row):
            value = float(row.values[row.at(cell.position)])
            taken += _apart(scheme, cell, value, cell.on_sheet.expected) >= APART * cell.on_sheet.band
    return taken >= FEWEST_ROWS


def _is_drawn(row: KeyRow) -> bool:
    """Return True for a scale or a length on paper."""
    return row.role is Role.scale or bool(vocabulary.plan(row.id))


def _row(classmate: Classmate, cell: Marked) -> KeyRow | None:
    """Return the row of a classmate's key for a cell, or None if the key has no value there."""
    row = classmate.key.find(cell.id)
    return row if row is not None and row.has(cell.position) and cell.position <= len(row.values) else None


def _apart(scheme: MarkingScheme, cell: Marked, first: float, second: float) -> float:
    """Return the distance between two values of a cell, in printed units."""
    unit = scheme.ledger[cell.id].how.scale
    return float(scheme.distance(cell.id, first * unit, second * unit)) / unit


def _theirs(classmate: Classmate, place: Place) -> float | None:
    answer = classmate.submission.values.get(place) if classmate.submission else None
    return None if answer is None else answer.value


def _equal(cell: Marked, value: float | None) -> bool:
    return value is not None and cell.written is not None and math.isclose(cell.written, value, rel_tol=1e-9)


def _read_to(scheme: MarkingScheme, cells: Cells) -> float:
    """Return the step (mm) to which the lengths on paper of a sheet are read."""
    lengths = [cell.written for cell in cells.values() if cell.written and scheme.ledger[cell.id].kind == "segment"]
    for step in STEPS:
        on_it = sum(abs(math.remainder(one, step)) <= 1e-9 * abs(one) for one in lengths)
        if on_it >= FOREIGN_SHARE * len(lengths):
            return step
    return TENTH


def _is_personal(scheme: MarkingScheme, cell: Marked, step: float) -> bool:
    """Return True if a value, to its written precision, is neither the key's nor follows from the student's own values.

    Two students who read the same length to `step` (mm) write the same number; a short length has not even a second
    figure. A value computed correctly from a wrong one proves nothing, because anybody with the same mistake gets it.
    """
    assert cell.written is not None
    if cell.verdict is Verdict.follows or (cell.mistake and cell.mistake != WRONG_DATUM) or cell.written == 0:
        return False
    last = 2 * last_half_unit(cell.written)
    if scheme.ledger[cell.id].kind == "segment":
        last = max(last, step)
    elif is_direction(cell.id):
        last = max(last, DEGREE)
    known = (cell.on_sheet.expected, cell.on_sheet.own)
    return all(_apart(scheme, cell, cell.written, value) > LAST * last for value in known)


def _is_near(cell: Marked) -> bool:
    return cell.verdict is Verdict.right


def _meets(scheme: MarkingScheme, cell: Marked, classmate: Classmate) -> bool | None:
    """Return True if a value is the classmate's, False if not, None if the comparison proves nothing."""
    row, theirs = _row(classmate, cell), _theirs(classmate, (cell.id, cell.position))
    if row is None:
        return None
    assert cell.written is not None
    value = float(row.values[row.at(cell.position)])
    if _is_near(cell):
        # These are two readings of one drawing.
        return None if theirs is None else _equal(cell, theirs)
    # A slightly wrong direction has few whole degrees to choose from; any other value has about a hundred numbers.
    far = APART if is_direction(cell.id) else 1.0
    if _apart(scheme, cell, value, cell.on_sheet.expected) < far * cell.on_sheet.band:
        return None
    rounding = last_half_unit(cell.written) * (1 + 1e-9)
    return _equal(cell, theirs) or _apart(scheme, cell, cell.written, value) <= rounding


def _tail(chances: Sequence[float], met: int) -> float:
    """Return the probability that at least `met` of the independent events happen."""
    counts = np.array([1.0])
    for chance in chances:
        counts = np.convolve(counts, (1 - chance, chance))
    return float(counts[met:].sum())


# --- right values that the student's own do not give ----------------------------------------------
# No marks are deducted for them, but student and instructor should know.
# The drawing's tolerance is wide: a reaction may be right within ± 180 N, and yet differ from the student's own length
# times the own scale. A value computed from values on the sheet can be compared with them more closely. So can a
# length measured on a force plan all of whose forces are on the sheet.

ROOM = 2.0
"""Largest multiple of the rounding of all written values by which a value may differ from the computed one."""


CLOSES = 1.5
"""Largest multiple of a length's measuring error by which it may differ from the length that closes the force plan."""


def not_from_own(working: Working, cells: Cells) -> frozenset[Place]:
    """Return the places of right values that do not follow from the student's own other values."""
    return frozenset(
        place for place, cell in cells.items() if cell.verdict is Verdict.right and _differs(working, cell)
    )


def _differs(working: Working, cell: Marked) -> bool:
    ledger, all_values = working.scheme.ledger, working.all_values
    id = ledger.size_of(cell.id)
    definition = ledger[id].definition
    assert cell.written is not None, "only a given value is right"
    kind = ledger[id].kind
    if kind == "segment":
        return _differs_on_plan(working, cell)
    if definition is None or id in ledger.constructed or kind.endswith("scale"):
        return False
    index = working.scheme.rows[cell.id].at(cell.position)

    def at(name: str) -> float:
        values = all_values[name]
        return float(values[index if len(values) > 1 else 0].real)

    inputs = {name: at(name) for name in ledger.inputs[id]}
    rounding = {name: _rounding(working, name, cell.position) for name in inputs}
    if not inputs or any(share is None for share in rounding.values()) or not any(rounding.values()):
        return False

    # The first row has the values as written; each further row changes one of them.
    moved = {name: share for name, share in rounding.items() if share}
    values = {name: np.full((len(moved) + 1, 1), value) for name, value in inputs.items()}
    for row, (name, share) in enumerate(moved.items(), start=1):
        values[name][row] *= 1 + share
    own, *others = (abs(float(one.real)) for one in np.asarray(evaluate(definition, values))[:, 0])
    moves = [abs(one - own) for one in others]
    value = abs(float(working.values[cell.id][index]))
    last = last_half_unit(cell.written) * cell.unit
    return bool(np.isfinite(own) and abs(value - own) > ROOM * (sum(moves) + last))


def _differs_on_plan(working: Working, cell: Marked) -> bool:
    """Return True if a length on a force plan disagrees with the student's own forces, all of them on the sheet."""
    scheme, plan = working.scheme, vocabulary.plan(cell.id)
    if scheme.ledger[plan].kind != "force scale" or not _is_filled_in(working, plan, cell.position):
        return False
    known = (scheme.ledger[one.of].of for id, one in scheme.ledger.families.items() if vocabulary.plan(id) == plan)
    laid = [id for id in known if id in scheme.rows and plan not in scheme.before[id]]
    assert cell.written is not None, "only a given value is right"
    if not all(_is_filled_in(working, id, cell.position) for id in laid):
        return False
    apart = abs(abs(cell.written) - abs(cell.on_sheet.own))
    # On a large plan, the rounding of the forces is visible too.
    forces = (working.submission.values[id, scheme.place(scheme.rows[id], cell.position)].value for id in laid)
    scale = working.submission.values[plan, scheme.place(scheme.rows[plan], cell.position)].value
    rounding = sum(map(last_half_unit, forces)) / abs(scale) if scale else np.inf
    error = 2 * scheme.policy.paper / scheme.ledger[cell.id].how.scale
    return bool(apart > CLOSES * error + rounding)


def _is_filled_in(working: Working, id: str, position: int) -> bool:
    """Return True if a requested value was filled in."""
    row = working.scheme.rows.get(id)
    return row is not None and (id, working.scheme.place(row, position)) in working.submission.values


def _rounding(working: Working, id: str, position: int) -> float | None:
    """Return the relative rounding of a value that was used further: 0 for a given value, None if it is not known."""
    scheme = working.scheme
    row = scheme.key.find(id)
    if row is None or row.id not in scheme.rows:
        family = scheme.ledger[id]
        given = not scheme.ledger.inputs[id]
        return 0.0 if given and not (family.hidden or family.is_plane) and row is not None else None
    answer = working.submission.values.get((row.id, scheme.place(row, position)))
    if answer is None:
        return None
    return last_half_unit(answer.value) / abs(answer.value) if answer.value else 0.0
