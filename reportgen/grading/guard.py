"""Against sheets that are not the student's own work: what follows from stock values earns nothing.

Marking that follows a student's own values through would reward any consistent set of numbers.  So
nothing is earned by a sheet that holds one number throughout, by a row of one number where the key
varies, by what follows from a classmate's values, from another variant's, or from one that is out of
all proportion.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reportgen.answers.key import Key, is_direction
from reportgen.grading.marks import Cells, Marked, Place, Verdict
from reportgen.grading.mistakes import WRONG_DATUM
from reportgen.grading.working import Guide

SAME = 0.8
"""The share of a sheet's values that one number fills in a stock answer."""

FEWEST = 4
"""Fewer values may agree by chance."""

APART = 3.0
"""Two keys differ where they lie this many tolerances apart."""

OUT_OF_PROPORTION = 20.0
"""A first wrong value without a name that is this many times too large or too small was made up."""

MISREAD = 2
"""So many given data taken wrongly, all else following from them, make another variant."""

CONSISTENT = 0.9
"""The share of the values not right that follow, where a sheet is another's."""


def guard(guide: Guide, cells: Cells, classmates: Sequence[Key]) -> tuple[dict[Place, Marked], tuple[str, ...]]:
    """The cells without what stock answers would earn, and the warnings: ids in `words.yaml`."""
    warnings: list[str] = []
    result = dict(cells)
    filled = [place for place, cell in cells.items() if cell.given is not None]
    commonest = Counter(cells[place].given for place in filled).most_common(1)
    if len(filled) >= FEWEST and commonest and commonest[0][1] >= SAME * len(filled):
        return _without_points(result, filled), ("stock",)
    constant = _constant_rows(cells)
    if constant:
        warnings.append("constant")
        result = _without_points(result, [place for place in filled if place[0] in constant])
    equal, copied = _copied_from(guide, result, classmates)
    result |= {place: replace(result[place], classmates=tuple(names)) for place, names in equal.items()}
    if copied:
        return _without_points(result, filled), (*warnings, "classmate")
    causes = {place for place in filled if place[0] in constant} | equal.keys()
    misread = {cell.where for cell in result.values() if cell.mistake == WRONG_DATUM}
    if len(misread) >= MISREAD and _follows_throughout(result):
        return _without_points(result, filled), (*warnings, "other-variant")
    wild = {place for place, cell in result.items() if cell.first and not cell.mistake and _is_wild(guide, cell)}
    if wild:
        warnings.append("proportion")
    causes |= wild
    follows = [place for place in filled if result[place].verdict is Verdict.follows]
    spoiled = [place for place in follows if place in causes or guide.stands_on(place, causes)]
    return _without_points(result, spoiled), tuple(warnings)


def _without_points(cells: dict[Place, Marked], places: Sequence[Place]) -> dict[Place, Marked]:
    """The cells with no points at `places`; a wrong value stays wrong."""
    earned = (Verdict.right, Verdict.follows)
    spoiled = {
        place: replace(cells[place], verdict=Verdict.implausible, points=0.0)
        for place in places
        if cells[place].verdict in earned
    }
    return cells | spoiled


def _constant_rows(cells: Cells) -> set[str]:
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


def _theirs(guide: Guide, cell: Marked, key: Key) -> float | None:
    """A classmate's value of a cell, where the two keys differ by three tolerances."""
    row = key.find(cell.id)
    if cell.given is None or row is None or key.id == guide.key.id or cell.position > len(row.values):
        return None
    # A mistake that has a name is the student's own; it may meet many a number by chance.
    if cell.mistake and cell.mistake != WRONG_DATUM:
        return None
    theirs = float(row.values[row.at(cell.position)])
    return theirs if abs(theirs - cell.expected) >= APART * cell.band else None


def _copied_from(guide: Guide, cells: Cells, classmates: Sequence[Key]) -> tuple[dict[Place, list[str]], bool]:
    """The classmates whose key each value equals, and whether one of them is the source of the sheet.

    Left out are classmates whose key only a few values equal, which may happen by chance.
    """
    equal: dict[Place, list[str]] = {}
    source = False
    for key in classmates:
        telling = {place: theirs for place, cell in cells.items() if (theirs := _theirs(guide, cell, key)) is not None}
        met = [
            place
            for place, theirs in telling.items()
            if (cell := cells[place]).verdict is not Verdict.right and cell.equals(theirs, cell.band)
        ]
        for place in met if len(met) >= FEWEST else ():
            equal.setdefault(place, []).append(key.id)
        source = source or len(met) >= max(FEWEST, SAME * len(telling))
    return equal, source


def _follows_throughout(cells: Cells) -> bool:
    """Whether all but the values with a misread datum follow, as they do in a sheet made for other data."""
    off = [cell for cell in cells.values() if cell.given is not None and cell.verdict is not Verdict.right]
    other = [cell for cell in off if cell.mistake != WRONG_DATUM]
    following = sum(cell.verdict is Verdict.follows for cell in other)
    return following >= CONSISTENT * len(other)


def _is_wild(guide: Guide, cell: Marked) -> bool:
    """Whether a value is out of all proportion to what it should be, and to the quantity's size."""
    if cell.given is None or is_direction(cell.id):
        return False
    size = guide.size(cell.id) / guide.ledger[cell.id].how.scale
    largest, least = max(abs(cell.own), size), abs(cell.own)
    zero = cell.given == 0 and least > APART * cell.band
    return (
        zero
        or abs(cell.given) > OUT_OF_PROPORTION * largest
        or (abs(cell.given) * OUT_OF_PROPORTION < least and least > APART * cell.band)
    )
