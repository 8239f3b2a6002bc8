"""Judge every value of a sheet (`mark`): right, following from the student's own earlier values, or wrong.

A wrong value costs its own mark once. Values that depend on it are computed again from the student's own values, and
earn their mark if they agree. A wrong value that depends on no wrong value is the first of its chain, and its mistake
is searched for by name. With `compare`, a student learns before submitting where a sheet first departs from the
assignment, without marks or answers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.case import Case
from reportgen.case.answer_key import KeyRow, Role
from reportgen.formula.ledger import Ledger
from reportgen.marking.answer_sheet import read_submission
from reportgen.marking.authenticity import Classmate, check_authenticity, not_from_own, unseen_text
from reportgen.marking.coursework_marking import joined, sheets_of
from reportgen.marking.exchanged_positions import Exchange, possible_exchanges
from reportgen.marking.marking_data import Cells, Marked, Marking, Notice, Place, Submission, Verdict, points_of
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme, Values, marking_scheme
from reportgen.marking.misread_data import misread_by_many, misread_data, mistakes_of_plans, redesigned
from reportgen.marking.mistakes import WRONG_DATUM, Mistake, mistakes_of_working, slips_of_writing
from reportgen.marking.scale_readings import best_working, charged_for_scales, left_out, optional_scales, without_cells
from reportgen.marking.student_values import Working
from reportgen.marking.tolerance_bands import half_unit, is_direction
from reportgen.marking.toleranced_key import Ask, symbol_text, words_of

SEARCHES: tuple[Callable[[Working, Cells], dict[Place, Mistake]], ...] = (
    slips_of_writing,
    mistakes_of_plans,
    misread_by_many,
    mistakes_of_working,
    misread_data,
)
"""Searches for named mistakes, in this order."""


@np.errstate(all="ignore")
def mark(scheme: MarkingScheme, submission: Submission, classmates: Sequence[Classmate] = ()) -> Marking:
    """Return the verdicts on a submission; `classmates` are those whose values must not appear in it.

    A sheet may contain any number, 0 or 10³⁰⁸; if a computation with it gives no number, that matches no value.
    """
    if scheme.parts:
        sheets = sheets_of(scheme, submission, classmates)
        parts = [(one.part, mark(one.scheme, one.submission, one.classmates)) for one in sheets]
        whole = joined(scheme, submission, parts)
        return replace(whole, flags=(*whole.flags, *unseen_text(whole.cells, submission)))
    working, cells, _, exchange = _best_order(scheme, submission)
    cells |= {place: replace(cells[place], elsewhere=True) for place in not_from_own(working, cells)}
    flags: tuple[Notice, ...] = ()
    if scheme.policy.guard:
        cells, flags = check_authenticity(scheme, cells, classmates)
    if exchange:
        cells, flags = exchange.as_handed_in(cells), exchange.noticed(flags)
    order = {row.id: index for index, row in enumerate(scheme.key.rows)}
    in_order = sorted(cells.values(), key=lambda cell: order[cell.id])
    flags = (*flags, *unseen_text(in_order, submission))
    return Marking(scheme.key, submission, tuple(in_order), flags)


@np.errstate(all="ignore")
def following_values(scheme: MarkingScheme, submission: Submission) -> tuple[Values, ...]:
    """Return all values (SI) [N] that follow from the student's wrong entries, and again with the misread data.

    Return () if nothing is wrong. For a coursework, these are the values of its machine.
    """
    if scheme.parts:
        machine = next(iter(sheets_of(scheme, submission, ())))
        return following_values(machine.scheme, machine.submission)
    working, _, mistakes, _ = _best_order(scheme, submission)
    changes = {id: change for one in mistakes for id, change in one.changes.items() if not working.shows(id)}
    if not mistakes:
        return ()
    return (working.all_values, *([working.all_values_with(changes)] if changes else []))


def _best_order(
    scheme: MarkingScheme, submission: Submission
) -> tuple[Working, dict[Place, Marked], list[Mistake], Exchange | None]:
    """Return the best working, its verdicts and mistakes, and the exchange of two positions if there is one.

    With an exchange, they are those of the corrected submission, and the places are where the values belong.
    """
    best = _best_verdicts(scheme, submission)
    for exchange in possible_exchanges(scheme, submission, best[1]):
        corrected = _best_verdicts(scheme, exchange.undone(submission))
        lost = exchange.charged(corrected[1])
        cost = corrected[1][lost].points if lost else 0.0
        if cost and exchange.explains(corrected[1]) and _points(corrected[1]) - cost > _points(best[1]):
            return *corrected, exchange
    return *best, None


def _points(cells: Cells) -> float:
    return points_of(cells.values())[0]


def _best_verdicts(scheme: MarkingScheme, submission: Submission) -> tuple[Working, dict[Place, Marked], list[Mistake]]:
    """Return the working that explains a submission best, its verdicts, and the named mistakes.

    An optional scale never costs marks: if the sheet earns more without it, it is left out.
    """
    working = best_working(scheme, submission, _fitting)
    cells, mistakes = _verdicts(working)
    wrong = any(cell.verdict is Verdict.wrong and cell.worth for cell in cells.values())
    optional = optional_scales(working) if wrong else frozenset()
    if optional:
        without = left_out(working, best_working(scheme, without_cells(submission, optional), _fitting))
        others, further = _verdicts(without)
        if points_of(others.values()) > points_of(cells.values()):
            kept = {place: replace(cells[place], first=False, mistake="", where="") for place in optional}
            return without, others | kept, further
    return working, cells, mistakes


def _verdicts(working: Working) -> tuple[dict[Place, Marked], list[Mistake]]:
    """Return the verdicts on a working, and the named mistakes."""
    scheme = working.scheme
    possible = [working.own_values(blank_from_key=True), working.own_values(blank_from_key=False)]
    cells = _judged_cells(working, possible)
    cells |= _by_approximation(working, cells)
    wrong = {place for place, cell in cells.items() if cell.verdict is Verdict.wrong}
    cells |= {place: replace(cells[place], first=True) for place in wrong if not scheme.depends_on(place, wrong)}
    named: list[Mistake] = []
    for search in SEARCHES:
        mistakes = search(working, cells)
        named += mistakes.values()
        for place, mistake in mistakes.items():
            cells[place] = replace(cells[place], mistake=mistake.name, where=mistake.where)
        cells |= _charged_once(working, cells, mistakes)
    cells |= charged_for_scales(working, cells)
    approximations = {name for known in scheme.misconceptions.approximations.values() for name, _ in known}
    accepted = {place for place, cell in cells.items() if cell.mistake in approximations}
    return cells | {place: _accepted(working, cells[place]) for place in accepted}, named


def _by_approximation(working: Working, cells: Cells) -> dict[Place, Marked]:
    """Return the wrong values that a textbook's approximation gives from the student's own values, with its name."""
    scheme, approximated = working.scheme, dict[Place, Marked]()
    for (id, position), cell in cells.items():
        known = scheme.misconceptions.approximations.get(id, ()) if cell.verdict is Verdict.wrong else ()
        for name, definition in known:
            row = scheme.rows[id]
            own = working.by_another_way(row, definition, row.at(position))
            if cell.given is not None and _follows(scheme, id, cell.given, own, cell.band):
                approximated[id, position] = _accepted(working, replace(cell, own=own, mistake=name, where=id))
                break
    return approximated


def _accepted(working: Working, cell: Marked) -> Marked:
    """Return a value by an approximation with its points if the policy accepts it, otherwise unchanged."""
    policy = working.scheme.policy
    if not policy.approximations:
        return cell
    return replace(cell, verdict=Verdict.follows, points=policy.worth(cell.id) * policy.right, first=False)


def _judged_cells(working: Working, possible: Sequence[Values]) -> dict[Place, Marked]:
    """Return the verdicts on all cells, each judged independently; `possible` are values that follow from own ones.

    The finer tolerance of a large drawing applies only to values that depend on no wrong value. After a wrong one, no
    tolerance is narrower than the report's.
    """
    scheme = working.scheme
    rows = [(row, position) for row in scheme.judged for position in row.positions]
    cells = {(row.id, at): _judged(working, row, at, possible, working.bands[row.id]) for row, at in rows}
    wrong = {place for place, cell in cells.items() if cell.verdict is Verdict.wrong}
    for row, at in rows:
        narrow, usual = working.bands[row.id], scheme.bands[row.id]
        if (row.id, at) in wrong and (narrow < usual).any() and scheme.depends_on((row.id, at), wrong):
            cells[row.id, at] = _judged(working, row, at, possible, np.maximum(narrow, usual))
    return cells


def _fitting(working: Working) -> tuple[int, int]:
    """Return the number of given values that are right or follow from own values, and the number of given values."""
    cells = _judged_cells(working, [working.own_values(blank_from_key=True)])
    met = sum(cell.verdict in (Verdict.right, Verdict.follows) for cell in cells.values())
    return met, met + sum(cell.verdict is Verdict.wrong for cell in cells.values())


def _judged(working: Working, row: KeyRow, position: int, possible: Sequence[Values], bands: np.ndarray) -> Marked:
    """Return the verdict on one cell by its tolerances (SI) [N] or [1].

    `possible` are the values that follow from the student's own.
    """
    scheme, submission, place = working.scheme, working.submission, (row.id, position)
    family, index = scheme.ledger[row.id], row.at(position)
    unit, worth = float(working.unit(row.id)[index]), scheme.policy.worth(row.id)
    band = float(bands[index if len(bands) > 1 else 0])
    key = float(family.at(position).real)
    following = [_own(scheme.ledger, values, row.id, index) for values in possible]
    following += working.accepted_alternatives(row, position)
    drawn = submission.measured.get(place)
    if drawn is not None:
        # The drawing's own fitting error counts if it is larger.
        band = max(band, drawn.error * family.how.scale)
        following.append(drawn.own * family.how.scale)
        unit = family.how.scale / (1.0 if is_direction(row.id) else drawn.times)

    value = float(working.values[row.id][index]) if row.id in working.values else float("nan")
    verdict, points, own = Verdict.wrong, 0.0, following[0]
    if place in submission.problems:
        verdict = Verdict.unreadable
    elif place in submission.unread:
        verdict = Verdict.unread
    elif np.isnan(value):
        verdict = Verdict.blank
    elif scheme.distance(row.id, value, key) <= band:
        verdict, points = Verdict.right, worth * scheme.policy.right
    elif met := [one for one in following if _follows(scheme, row.id, value, one, band)]:
        verdict, points, own = Verdict.follows, worth * scheme.policy.follows, met[0]
    return Marked(
        row.id,
        position,
        verdict=verdict,
        given=None if np.isnan(value) else value,
        expected=key,
        own=own,
        band=band,
        points=points,
        worth=worth * scheme.policy.right,
        unit=unit,
        written=None if np.isnan(value) else value / unit if drawn else submission.values[place].value,
    )


def _own(ledger: Ledger, values: Values, id: str, index: int) -> float:
    """Return the value of a quantity from own values; a signed one takes its size from the row before it."""
    own = float(values[id][index].real)
    before = ledger.size_of(id)
    size = values.get(before) if before != id else None
    return own if size is None else float(np.copysign(abs(size[index].real), own))


def _follows(scheme: MarkingScheme, id: str, value: float, own: float, band: float) -> bool:
    """Return True if a student's value (SI) is the one that the earlier values give.

    The band grows in proportion if that value is larger than any right value.
    """
    size = scheme.size(id)
    if size and np.isfinite(own):
        band = band * max(1.0, abs(own) / size) + float(half_unit(np.array([own]), scheme.policy.digits)[0])
    return bool(scheme.distance(id, value, own) <= band)


def _charged_once(working: Working, cells: Cells, mistakes: Mapping[Place, Mistake]) -> dict[Place, Marked]:
    """Deduct one mark per mistake: later values that come from the same unseen mistake are not charged again.

    For example, a student who uses the stroke as the radius without writing the radius made one mistake, although no
    value on the sheet depends on another one that shows it.
    """
    scheme, policy = working.scheme, working.scheme.policy
    order = {row.id: index for index, row in enumerate(scheme.judged)}
    changed: dict[Place, Marked] = {}
    unseen = {
        (mistake.name, mistake.where): mistake
        for mistake in mistakes.values()
        if not any(map(working.shows, mistake.changes or [mistake.where]))
    }
    for (name, where), mistake in unseen.items():
        worlds = (mistake.changes, *redesigned(working, mistake))
        possible = [working.own_values(changes=changes) for changes in worlds]
        once = len(scheme.ledger[where].values) == 1 or name == WRONG_DATUM
        caused = [place for place, one in mistakes.items() if (one.name, one.where) == (name, where)]
        charged: dict[int, Place] = {}
        for place in sorted(caused, key=lambda place: order[place[0]]):
            # In a quantity with a value at each position, the mistake counts separately at each of them.
            charged.setdefault(0 if once else place[1], place)
        for place, cell in cells.items():
            if cell.verdict is not Verdict.wrong or place in charged.values() or place in changed:
                continue
            index = scheme.rows[cell.id].at(cell.position)
            given = float(working.values[cell.id][index])
            following = (_own(scheme.ledger, values, cell.id, index) for values in possible)
            own = next((value for value in following if _follows(scheme, cell.id, given, value, cell.band)), None)
            if own is not None:
                points = policy.worth(cell.id) * policy.follows
                changed[place] = replace(
                    cell, verdict=Verdict.follows, own=own, points=points, first=False, mistake="", where=""
                )
    return changed


NEAREST = 4
"""Largest number of inputs of a quantity that a hint names."""


def compare(case: Case, sheet: Path, hint: bool = False) -> tuple[tuple[str, ...], bool]:
    """Return lines that say where a sheet departs from its assignment, and True if all its filled cells agree.

    With `hint`, the lines add where to look. Raise `AssignmentError` if the sheet cannot be read.
    """
    scheme = marking_scheme(case, Policy(guard=False))
    # The file's name does not matter: the given data show whose sheet it is.
    submission = read_submission(sheet, lambda _: scheme.key, scheme.key.language, by_data=True)
    return compared(scheme, submission, hint)


class Comparison(Record):
    """A submission compared with its assignment, for its student."""

    scheme: MarkingScheme
    marking: Marking

    @property
    def agrees(self) -> bool:
        """True if no value disagrees; a blank one does not, nor does one that follows from a right one."""
        unread = self.marking.submission.problems
        return not (unread or any(cell.verdict is Verdict.wrong for cell in self.marking.cells))

    def lines(self, hint: bool) -> Iterator[str]:
        """Yield a line for each first divergence."""
        return _lines(self.scheme, self.marking, hint, self.agrees)

    def hint(self, cell: Marked) -> str:
        """Return where to look for the mistake in a cell that is a first divergence."""
        return _hint(self.scheme, self.marking, cell)


def compared(scheme: MarkingScheme, submission: Submission, hint: bool = False) -> tuple[tuple[str, ...], bool]:
    """Return the same as `compare` for a submission that has been read."""
    comparison = comparison_of(scheme, submission)
    return tuple(comparison.lines(hint)), comparison.agrees


def comparison_of(scheme: MarkingScheme, submission: Submission) -> Comparison:
    """Return a submission that has been read, compared; every row of the sheet counts as requested."""
    # A quantity without a row on the sheet is not missing.
    scheme = replace(scheme, key=Ask(()).of(scheme.key, submission.rows))
    return Comparison(scheme, mark(scheme, submission))


def _lines(scheme: MarkingScheme, marking: Marking, hint: bool, agrees: bool) -> Iterator[str]:
    """Yield a line for each first divergence, with its cell; `hint` adds where to look, never the answer."""
    words = words_of(marking.key)["compare"]
    yield from map(str, (*marking.submission.problems.values(), *marking.submission.notes))
    yield from _unread(marking)
    counted = Counter(cell.verdict for cell in marking.cells)
    for cell in marking.first_errors:
        given = marking.submission.values[(cell.id, cell.position)]
        yield words["first"].format(mark=str(given.location), symbol=_named(marking, cell), text=given.text)
        if hint:
            yield f"    {_hint(scheme, marking, cell)}"
    later = counted[Verdict.wrong] - len(marking.first_errors)
    if later:
        yield words["later"].format(count=later)
    if counted[Verdict.follows] and marking.first_errors:
        yield words["follows"].format(count=counted[Verdict.follows])
    # A scale may be left empty.
    empty = (marking.key.row(cell.id) for cell in marking.cells if cell.verdict is Verdict.blank)
    blank = sum(row.role is not Role.scale for row in empty)
    if blank:
        yield words["blank"].format(count=blank)
    if agrees:
        yield words["agrees"].format(count=counted[Verdict.right] + counted[Verdict.follows])


def _unread(marking: Marking) -> Iterator[str]:
    """Yield the entries of the student's own files that were not read, place by place, and the share that was read."""
    submission, words = marking.submission, words_of(marking.key)["compare"]
    for (id, position), problem in submission.unread.items():
        symbol = symbol_text(marking.key.row(id), marking.key)
        named = words["at"].format(symbol=symbol, label=marking.key.label(position, id)) if position else symbol
        yield words["unread"].format(mark=str(problem.location), symbol=named, message=problem.message)
    if submission.own_files:
        yield words["read"].format(read=round(100 * submission.share_read), count=len(submission.values))


def _hint(scheme: MarkingScheme, marking: Marking, cell: Marked) -> str:
    """Return the name of the mistake, or else the inputs of the value and whether it is too large."""
    words = words_of(marking.key)
    if cell.mistake:
        where = marking.key.find(cell.where)
        symbol = symbol_text(where, marking.key) if where else _named(marking, cell)
        named = str(words_of(marking.key.part(cell.id))["mistakes"][cell.mistake])
        return named.format(symbol=symbol, **cell.exchanged_labels(marking.key))
    assert cell.given is not None, "only a given value diverges"
    size = words["compare"]["larger" if abs(cell.given) > abs(cell.own) else "smaller"]
    earlier = (marking.key.find(id) for id in scheme.before[cell.id])
    nearest = [symbol_text(row, marking.key) for row in earlier if row is not None][:NEAREST]
    return f"{size} {words['compare']['from'].format(symbols=', '.join(dict.fromkeys(nearest)))}" if nearest else size


def _named(marking: Marking, cell: Marked) -> str:
    """Return a quantity's symbol, with its position unless it is the same at all positions."""
    words, row = words_of(marking.key)["compare"], marking.key.row(cell.id)
    symbol = symbol_text(row, marking.key)
    if cell.position == 0:
        return symbol
    return str(words["at"].format(symbol=symbol, label=marking.key.label(cell.position, cell.id)))
