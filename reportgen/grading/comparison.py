"""A student's own check before handing in: where the sheet first leaves the assignment, without marks or answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from reportgen.answers.key import symbol_text, words_of
from reportgen.catalogue import load
from reportgen.grading.marking import mark
from reportgen.grading.marks import Marked, Marking, Policy, Verdict
from reportgen.grading.submission import read_submission
from reportgen.grading.working import Guide, open_guide
from reportgen.notation.numbers import Language

NEAREST = 4
"""How many of the quantities that one is worked out from are named."""


def compare(
    file: Path, sheet: Path, hint: bool = False, language: Language | None = None
) -> tuple[tuple[str, ...], bool]:
    """Lines that say where a sheet leaves its assignment, and whether it agrees as far as it is filled in.

    Raises `AssignmentError` if the assignment or the sheet cannot be read.
    """
    guide = open_guide(load(file, language), Policy(guard=False))
    marking = mark(guide, read_submission(sheet, guide.key, guide.key.language))
    # A blank value does not disagree, nor does one that follows from a right one.
    agrees = not (marking.submission.problems or any(cell.verdict is Verdict.wrong for cell in marking.cells))
    return tuple(_lines(guide, marking, hint, agrees)), agrees


def _lines(guide: Guide, marking: Marking, hint: bool, agrees: bool) -> Iterator[str]:
    """A line for each first divergence, with the cell it stands in; `hint` adds where to look, never the answer."""
    words = words_of(marking.key)["compare"]
    for problem in marking.submission.problems.values():
        yield str(problem)
    counted = Counter(cell.verdict for cell in marking.cells)
    for cell in marking.first_errors:
        given = marking.submission.values[(cell.id, cell.position)]
        yield words["first"].format(mark=given.mark, symbol=_named(marking, cell), text=given.text)
        if hint:
            yield f"    {_hint(guide, marking, cell)}"
    later = counted[Verdict.wrong] - len(marking.first_errors)
    if later:
        yield words["later"].format(count=later)
    if counted[Verdict.follows] and marking.first_errors:
        yield words["follows"].format(count=counted[Verdict.follows])
    if counted[Verdict.blank]:
        yield words["blank"].format(count=counted[Verdict.blank])
    if agrees:
        yield words["agrees"].format(count=counted[Verdict.right] + counted[Verdict.follows])


def _hint(guide: Guide, marking: Marking, cell: Marked) -> str:
    """The mistake by name; else what the value is worked out from, and whether it is too large."""
    words = words_of(marking.key)
    if cell.mistake:
        where = marking.key.find(cell.where)
        symbol = symbol_text(where, marking.key) if where else _named(marking, cell)
        return str(words["mistakes"][cell.mistake]).format(symbol=symbol)
    assert cell.given is not None, "only a given value diverges"
    size = words["compare"]["larger" if abs(cell.given) > abs(cell.own) else "smaller"]
    shown = (marking.key.find(id) for id in guide.before[cell.id])
    nearest = [symbol_text(row, marking.key) for row in shown if row is not None][:NEAREST]
    return f"{size} {words['compare']['from'].format(symbols=', '.join(dict.fromkeys(nearest)))}" if nearest else size


def _named(marking: Marking, cell: Marked) -> str:
    """A quantity's symbol, with its position unless it is the same at all positions."""
    words, row = words_of(marking.key)["compare"], marking.key.row(cell.id)
    symbol = symbol_text(row, marking.key)
    if cell.position == 0:
        return symbol
    return str(words["at"].format(symbol=symbol, label=marking.key.label(cell.position)))
