"""Against sheets that are no work of their own: what follows from stock values earns nothing.

Marking that follows a student's own values through would reward any consistent set of numbers.  So
nothing is earned by a sheet that holds one number throughout, by a row of one number where the key
varies, by what follows from a classmate's values, from another variant's, or from one that is out of
all proportion.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reportgen.answers.key import Key
from reportgen.grading.guide import Guide
from reportgen.grading.marks import Marked, Place, Verdict
from reportgen.grading.working import Working

SAME = 0.8
"""The share of a sheet's values that one number fills in a stock answer."""

FEWEST = 4
"""Fewer values show no pattern."""

APART = 3.0
"""Two keys differ where they lie this many tolerances apart."""

OUT_OF_PROPORTION = 20.0
"""A first wrong value without a name that is this many times too large or too small is no working."""

ROOTS = 2
"""So many unnamed wrong values that come from the given data alone belong to another variant."""

Cells = Mapping[Place, Marked]


def guard(working: Working, cells: Cells, classmates: Sequence[Key]) -> tuple[dict[Place, Marked], tuple[str, ...]]:
    """The cells without what stock answers would earn, and the warnings: ids in `words.yaml`."""
    guide, warnings = working.guide, []
    result = dict(cells)
    filled = [place for place, cell in cells.items() if cell.given is not None]
    commonest = Counter(cells[place].given for place in filled).most_common(1)
    if len(filled) >= FEWEST and commonest and commonest[0][1] >= SAME * len(filled):
        return _emptied(result, filled), ("stock",)
    constant = _constant_rows(guide, cells)
    if constant:
        warnings.append("constant")
        result = _emptied(result, [place for place in filled if place[0] in constant])
    result = {place: replace(cell, classmates=_equal_to(guide, cell, classmates)) for place, cell in result.items()}
    copied = Counter(name for cell in result.values() for name in cell.classmates)
    sources = {name for name, count in copied.items() if count >= FEWEST}
    causes = {place for place, cell in result.items() if sources & set(cell.classmates)}
    if causes:
        warnings.append("classmate")
    roots = [place for place in _roots(guide, result) if not result[place].mistake]
    if len(roots) >= ROOTS:
        warnings.append("other-variant")
        causes |= set(roots)
    wild = {place for place, cell in result.items() if cell.first and not cell.mistake and _is_wild(guide, cell)}
    if wild:
        warnings.append("proportion")
    causes |= wild | {place for place in filled if place[0] in constant}
    return _emptied(result, [place for place in filled if _is_spoiled(guide, result, place, causes)]), tuple(warnings)


def _emptied(cells: dict[Place, Marked], places: Sequence[Place]) -> dict[Place, Marked]:
    """The cells with nothing earned at `places`; a wrong value stays wrong."""
    earned = (Verdict.right, Verdict.follows)
    spoiled = {
        place: replace(cells[place], verdict=Verdict.implausible, points=0.0)
        for place in places
        if cells[place].verdict in earned
    }
    return cells | spoiled


def _constant_rows(guide: Guide, cells: Cells) -> set[str]:
    """Rows of one number throughout where the key varies by more than its bands."""
    rows: dict[str, list[Marked]] = {}
    for cell in cells.values():
        if cell.given is not None:
            rows.setdefault(cell.id, []).append(cell)
    return {
        id
        for id, row in rows.items()
        if len(row) >= FEWEST
        and len({cell.given for cell in row}) == 1
        and np.ptp([cell.expected for cell in row]) > APART * max(cell.band for cell in row)
    }


def _equal_to(guide: Guide, cell: Marked, classmates: Sequence[Key]) -> tuple[str, ...]:
    """Classmates whose key this value equals, where the two keys differ by three tolerances."""
    if cell.given is None or cell.verdict is Verdict.right:
        return ()
    found = []
    for key in classmates:
        row = key.find(cell.id)
        if row is None or key.id == guide.key.id or cell.position > len(row.values):
            continue
        theirs = float(row.values[row.at(cell.position)])
        if abs(theirs - cell.expected) >= APART * cell.band and abs(cell.given - theirs) <= cell.band:
            found.append(key.id)
    return tuple(found)


def _roots(guide: Guide, cells: Cells) -> list[Place]:
    """First wrong values that come from the given data alone, one for each row."""
    asked = guide.rows.keys()
    roots: dict[str, Place] = {}
    for place, cell in cells.items():
        if cell.first and not asked & set(guide.before[cell.id]):
            roots.setdefault(cell.id, place)
    return list(roots.values())


def _is_wild(guide: Guide, cell: Marked) -> bool:
    """Whether a value is out of all proportion to what it should be, and to the quantity's size."""
    if cell.given is None or cell.id.startswith("dir."):
        return False
    size = guide.size(cell.id) / guide.ledger[cell.id].how.scale
    largest, least = max(abs(cell.own), size), abs(cell.own)
    nothing = cell.given == 0 and least > APART * cell.band
    return nothing or abs(cell.given) > OUT_OF_PROPORTION * largest or (
        abs(cell.given) * OUT_OF_PROPORTION < least and least > APART * cell.band
    )


def _is_spoiled(guide: Guide, cells: Cells, place: Place, causes: set[Place]) -> bool:
    """Whether a value that earns by following stands on one of `causes`, or is one."""
    cell = cells[place]
    if cell.verdict is not Verdict.follows:
        return False
    rows = guide.rows
    return place in causes or any(
        (before, guide.place(rows[before], place[1])) in causes for before in guide.before[cell.id] if before in rows
    )
