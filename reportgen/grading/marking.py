"""Every value of a sheet judged: right, following from the student's own earlier values, or wrong.

A wrong value costs its own mark once.  What stands on it is worked out again from the student's own
values; where that is met, it earns its mark.  A wrong value with nothing wrong before it is the first
of its chain, and the mistake behind it is sought by name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reportgen.answers.bands import half_unit
from reportgen.answers.key import Key, Row
from reportgen.grading.guard import guard
from reportgen.grading.guide import Guide
from reportgen.grading.marks import Marked, Marking, Place, Submission, Verdict
from reportgen.grading.misread import misread_data
from reportgen.grading.mistakes import Site
from reportgen.grading.naming import name_mistakes
from reportgen.grading.slips import name_slips
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
    for named in (name_slips, name_mistakes, misread_data):
        sites = named(working, cells)
        cells |= {place: _named(cells[place], site) for place, site in sites.items()}
        cells |= _charged_once(working, cells, sites)
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
            if distance(row.id, family.arm, value, one) <= _room(guide, row.id, band, one)
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


def _named(cell: Marked, site: Site) -> Marked:
    return replace(cell, mistake=site.mistake, where=site.where)


def _charged_once(
    working: Working, cells: Mapping[Place, Marked], sites: Mapping[Place, Site]
) -> dict[Place, Marked]:
    """Of all wrong values that come from one mistake before the sheet, only the first costs its mark.

    Whoever took the stroke for the radius without writing the radius down went wrong once, though no
    value on the sheet stands on another that shows it.
    """
    guide = working.guide
    order = {row.id: index for index, row in enumerate(guide.judged)}
    changed: dict[Place, Marked] = {}
    unseen = {(site.mistake, site.where): site for site in sites.values() if not working.shows(site.where)}
    for (mistake, where), site in unseen.items():
        single = len(guide.ledger[where].values) == 1
        own = working.own(made=site.changes)
        caused = [place for place, one in sites.items() if (one.mistake, one.where) == (mistake, where)]
        charged = {
            min((place for place in caused if single or place[1] == position), key=lambda place: order[place[0]])
            for position in {place[1] for place in caused}
        }
        charged = {min(charged, key=lambda place: order[place[0]])} if single else charged
        for place, cell in cells.items():
            if cell.verdict is Verdict.wrong and place not in charged and place not in changed:
                row = guide.rows[place[0]]
                here = _own(guide, own, row.id, row.at(place[1]))
                changed |= {place: _following(guide, cell, here)} if _meets(working, cell, here) else {}
    return changed


def _following(guide: Guide, cell: Marked, own: float) -> Marked:
    unit = guide.ledger[cell.id].how.scale
    points = guide.policy.worth(cell.id) * guide.policy.follows
    return replace(
        cell, verdict=Verdict.follows, own=own / unit, points=points, first=False, mistake="", where=""
    )


def _meets(working: Working, cell: Marked, own: float) -> bool:
    """Whether a student's value is `own` (SI) within its band."""
    guide = working.guide
    family, row = guide.ledger[cell.id], guide.rows[cell.id]
    value = float(working.values[cell.id][row.at(cell.position)])
    return distance(cell.id, family.arm, value, own) <= _room(guide, cell.id, cell.band * family.how.scale, own)


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


def _room(guide: Guide, id: str, band: float, own: float) -> float:
    """The band about a value that follows: as wide in proportion where that is larger than anything right."""
    size = guide.size(id)
    if not (size and np.isfinite(own)):
        return band
    return band * max(1.0, abs(own) / size) + float(half_unit(np.array([own]), guide.policy.digits)[0])


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
