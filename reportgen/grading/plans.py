"""Mistakes in drawing a plan: one vector reversed or left out moves every point behind it.

Nothing that the sheet shows holds such a mistake, and no value read from the plan stands on another one; so it is
sought in all values at once that are read there, and counts if it explains nearly all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reportgen.grading.guide import Guide
from reportgen.grading.marks import Cells, Place
from reportgen.grading.mistakes import Mistake
from reportgen.grading.naming import foreseen
from reportgen.grading.working import Working
from reportgen.notation import ids, vocabulary
from reportgen.notation.expressions import refs

FEWEST = 2
"""One value alone may have been read wrongly."""

AGREED = 0.7
"""The share of the first wrong values behind a vector that a mistake in it explains."""


def mistakes_of_plans(working: Working, cells: Cells) -> dict[Place, Mistake]:
    """The vectors reversed or left out behind first wrong values that have no name yet."""
    open_ones = [place for place, cell in cells.items() if cell.first and not cell.mistake and place[1]]
    candidates = list(_candidates(working.guide))
    found: dict[Place, Mistake] = {}
    for position in dict.fromkeys(position for _, position in open_ones):
        here = [place for place in open_ones if place[1] == position]
        found |= behind_many(working, cells, here, candidates, FEWEST)
    return found


def behind_many(
    working: Working, cells: Cells, places: Sequence[Place], candidates: Sequence[Mistake], fewest: int
) -> dict[Place, Mistake]:
    """The mistakes that explain nearly all wrong values behind them, `fewest` at least, those of the most first."""
    guide = working.guide
    first = list(dict.fromkeys(id for id, _ in places))
    before = {id: {*guide.before[id]} for id in first}
    candidates = [one for one in candidates if any(one.changes.keys() & before[id] for id in first)]
    if len(places) < fewest or not candidates:
        return {}
    values = foreseen(working, first, candidates)
    met = {place: _met(working, cells, place, values[place[0]]) for place in places}
    found: dict[Place, Mistake] = {}
    left = list(places)
    while best := _best(candidates, left, met, before, fewest):
        mistake, explained = best
        found |= dict.fromkeys(explained, mistake)
        left = [place for place in left if place not in explained]
    return found


def _candidates(guide: Guide) -> Iterator[Mistake]:
    """Each vector that is laid in a plan, and each load as a whole, left out or reversed."""
    ledger = guide.ledger
    for id, family in ledger.families.items():
        if family.definition is not None and vocabulary.is_laid(id) and family.is_plane and not family.of:
            # The vector of a force, or the length of aⁿ on paper, which a line says of aⁿ itself.
            source = ledger[refs(family.definition)[0]]
            if source.of:
                yield from _either("force-left-out", "force-reversed", source.of, id)
            elif source.definition is not None:
                yield from _either("part-left-out", "part-reversed", refs(source.definition)[0], id)
    for load in guide.analysis.loads if guide.analysis else ():
        vector = ids.force_vector(load.name)
        yield from _either("load-forgotten", "load-reversed", load.name, vector if vector in ledger else load.name)


def _either(left_out: str, reversed_: str, where: str, id: str) -> Iterator[Mistake]:
    yield Mistake(left_out, where, {id: lambda value, _: value * 0})
    yield Mistake(reversed_, where, {id: lambda value, _: -value})


def _met(working: Working, cells: Cells, place: Place, values: np.ndarray) -> np.ndarray:
    """Which of the candidates' values [candidates, positions] a student's value is, and not the right one."""
    guide, cell = working.guide, cells[place]
    index = guide.rows[place[0]].at(place[1])
    unit = float(working.unit(place[0])[index])
    given, band = float(working.values[place[0]][index]), cell.band * unit
    expected = values[:, index]
    with np.errstate(all="ignore"):
        wider = np.maximum(1.0, np.abs(expected) / max(abs(cell.own) * unit, band))
        near = guide.distance(place[0], given, expected) <= band * wider
        shows = guide.distance(place[0], cell.own * unit, expected) > band
    return np.asarray(near & shows)


def _best(
    candidates: list[Mistake], left: list[Place], met: dict[Place, np.ndarray], before: dict[str, set[str]], fewest: int
) -> tuple[Mistake, list[Place]] | None:
    """The mistake that explains most of the values that are left, if it explains nearly all that it moves."""
    best: tuple[Mistake, list[Place]] | None = None
    for number, mistake in enumerate(candidates):
        behind = [place for place in left if mistake.changes.keys() & before[place[0]]]
        explained = [place for place in behind if met[place][number]]
        if len(explained) >= max(fewest, AGREED * len(behind), len(best[1]) + 1 if best else 0):
            best = mistake, explained
    return best
