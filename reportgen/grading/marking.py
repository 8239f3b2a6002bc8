"""Every value of a sheet judged: right, following from the student's own earlier values, or wrong.

A wrong value costs its own mark once.  What stands on it is worked out again from the student's own
values; where that is met, it earns its mark.  A wrong value with nothing wrong before it is the first
of its chain, and the mistake behind it is sought by name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reportgen.answers.key import Key, Row
from reportgen.grading.guard import guard
from reportgen.grading.guide import Guide
from reportgen.grading.marks import Marked, Marking, Place, Submission, Verdict
from reportgen.grading.misread import name_misread
from reportgen.grading.naming import name_mistakes
from reportgen.grading.working import SIGNED, Working, lay_out


def mark(guide: Guide, submission: Submission, classmates: Sequence[Key] = ()) -> Marking:
    """The verdicts on a submission; `classmates` are the keys that none of its values should come from."""
    working = lay_out(guide, submission)
    chances = [working.own(blank_from_key=True), working.own(blank_from_key=False)]
    cells = {
        (row.id, position): _judged(working, submission, row, position, chances)
        for row in guide.judged
        for position in row.positions
    }
    cells |= {place: replace(cells[place], first=True) for place in _firsts(guide, cells)}
    cells |= name_mistakes(working, cells)
    cells |= name_misread(working, cells)
    warnings: tuple[str, ...] = ()
    if guide.policy.guard:
        cells, warnings = guard(working, cells, classmates)
    order = {row.id: index for index, row in enumerate(guide.key.rows)}
    judged = sorted(cells.values(), key=lambda cell: order[cell.id])
    return Marking(guide.key, submission, tuple(judged), warnings)


def _judged(
    working: Working,
    submission: Submission,
    row: Row,
    position: int,
    chances: Sequence[dict[str, np.ndarray]],
) -> Marked:
    guide = working.guide
    family, index = guide.ledger[row.id], row.at(position)
    unit, worth = family.how.scale, guide.policy.worth(row.id)
    band = float(np.broadcast_to(guide.bands[row.id], family.values.shape)[index])
    key = float(family.at(position).real)
    mine = [_own(guide, chance, row.id, index) for chance in chances]
    column = working.values.get(row.id)
    value = float("nan") if column is None else float(column[index])
    place = (row.id, position)
    verdict, points, own = Verdict.wrong, 0.0, mine[0]
    if place in submission.problems:
        verdict = Verdict.unreadable
    elif np.isnan(value):
        verdict = Verdict.blank
    elif distance(row.id, family.arm, value, key) <= band:
        verdict, points = Verdict.right, worth * guide.policy.right
    else:
        met = [
            one
            for one in mine
            if distance(row.id, family.arm, value, one) <= band * _wider(one, guide.size(row.id))
        ]
        if met:
            verdict, points, own = Verdict.follows, worth * guide.policy.follows, met[0]
    return Marked(
        row.id,
        position,
        verdict,
        None if np.isnan(value) else submission.values[place].value,
        key / unit,
        own / unit,
        band / unit,
        points,
        worth * guide.policy.right,
    )


def distance(id: str, arm: bool, value: float, other: float) -> float:
    """How far two values (SI) lie apart: directions around the circle, arms by their sizes."""
    if id.startswith("dir."):
        return abs((value - other + np.pi) % (2 * np.pi) - np.pi)
    return abs(abs(value) - abs(other)) if arm else abs(value - other)


def _own(guide: Guide, chance: dict[str, np.ndarray], id: str, index: int) -> float:
    """What a quantity comes to from the student's own values; a signed one has its size from before it."""
    own = float(chance[id][index].real)
    size = chance.get(id.removeprefix(SIGNED)) if id.startswith(SIGNED) else None
    return own if size is None else float(np.copysign(abs(size[index].real), own))


def _wider(own: float, size: float) -> float:
    """A band grows with what it is measured from, where that is larger than anything right."""
    return max(1.0, abs(own) / size) if size and np.isfinite(own) else 1.0


def _firsts(guide: Guide, cells: dict[Place, Marked]) -> list[Place]:
    """Wrong values that stand on nothing wrong."""
    wrong = {place for place, cell in cells.items() if cell.verdict is Verdict.wrong}
    rows = guide.rows
    return [
        (id, position)
        for id, position in wrong
        if not any(
            (before, guide.place(rows[before], position)) in wrong
            for before in guide.before[id]
            if before in rows
        )
    ]
