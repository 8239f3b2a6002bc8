"""What went wrong, by name: the mistakes that could have been made, run through the ledger and compared.

A mistake may have been made in the wrong quantity itself, or in one before it that the sheet does not show.
All of them are evaluated at once, [sites, positions]; the one that meets most of the wrong values of a
quantity, and meets them best, gives its name.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from reportgen.grading.guide import Guide
from reportgen.grading.marks import Marked, Place, Verdict
from reportgen.grading.mistakes import ELSEWHERE, Site, sites_anywhere, sites_in
from reportgen.grading.working import SIGNED, Change, Working
from reportgen.ledger.following import follow


def name_mistakes(working: Working, cells: Mapping[Place, Marked]) -> dict[Place, Site]:
    """The mistakes behind the first wrong values of each chain that have no name yet, where they are known."""
    by_row: dict[str, list[int]] = {}
    for (id, position), cell in cells.items():
        if cell.first and not cell.mistake:
            by_row.setdefault(id, []).append(position)
    return {
        (id, position): site
        for id, positions in by_row.items()
        for position, site in _explained(working, cells, id, positions).items()
    }


def _explained(
    working: Working, cells: Mapping[Place, Marked], id: str, positions: Sequence[int]
) -> dict[int, Site]:
    guide = working.guide
    sites = list(_candidates(working, id))
    if not sites:
        return {}
    row = guide.rows[id]
    index = [row.at(position) for position in positions]
    given = working.values[id][index]
    unit = guide.ledger[id].how.scale
    band = np.array([cells[(id, position)].band for position in positions]) * unit
    expected = np.array([[cells[(id, p)].own, cells[(id, p)].expected] for p in positions]).T * unit
    # A student goes on from the rounded value written down, or from the one left in the calculator.
    gone_on_from = (working, working.unrounded({one for one in cells if cells[one].verdict is Verdict.right}))
    foreseen = np.concatenate([_foreseen(one, id, sites)[:, index] for one in gone_on_from])
    sites = [*sites, *sites]
    with np.errstate(all="ignore"):
        # What a mistake makes larger, it makes less certain in the same measure.
        wider = np.maximum(1.0, np.abs(foreseen) / np.maximum(np.abs(expected[0]), band))
        off = _apart(guide, id, given, foreseen) / (band * wider)
        plain = np.min([_apart(guide, id, one, foreseen) for one in expected], axis=0)
    met = (off <= 1) & (plain > band)
    chosen: dict[int, Site] = {}
    worth = met.sum(axis=1)
    needs_more = [len(row.positions) > 1 and site.mistake in ELSEWHERE for site in sites]
    for column, position in enumerate(positions):
        fitting = [s for s in np.flatnonzero(met[:, column]) if worth[s] > 1 or not needs_more[s]]
        if fitting:
            best = min(fitting, key=lambda s: (-worth[s], round(float(off[s, column]), 2), s))
            chosen[position] = sites[best]
    return chosen


def _apart(guide: Guide, id: str, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """How far values lie apart: directions around the circle, arms by their sizes."""
    if id.startswith("dir."):
        return np.asarray(np.abs(np.mod(one - other + np.pi, 2 * np.pi) - np.pi))
    return np.asarray(np.abs(np.abs(one) - np.abs(other)) if guide.ledger[id].arm else np.abs(one - other))


def _candidates(working: Working, id: str) -> Iterator[Site]:
    """Mistakes in the quantity itself, then in unseen ones before it, nearest first, then about positions."""
    guide = working.guide
    yield from sites_in(guide, id, working.scales)
    size = id.removeprefix(SIGNED)
    if size != id:
        yield from sites_in(guide, size, working.scales)
    before = guide.before[id]
    for other in before:
        family = guide.ledger[other]
        if not working.shows(other) and other != size and not (family.hidden or family.is_plane):
            yield from sites_in(guide, other, working.scales)
    above = {*before, id}
    for site in sites_anywhere(guide):
        if above & site.changes.keys():
            yield site


def _foreseen(working: Working, id: str, sites: Sequence[Site]) -> np.ndarray:
    """What a quantity comes to with each mistake, from the student's own earlier values [sites, positions]."""
    guide = working.guide
    ledger = guide.ledger
    made: dict[str, list[tuple[int, Change]]] = {}
    for number, site in enumerate(sites):
        for name, change in site.changes.items():
            made.setdefault(name, []).append((number, change))
    judged = {id, id.removeprefix(SIGNED)}

    def laid(name: str) -> Change:
        def change(computed: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
            base = computed if name in judged else working.over(name, computed, computed)
            if name not in made:
                return base
            rows = np.array(np.broadcast_to(base, (len(sites), np.shape(base)[-1])), copy=True)
            width = max(rows.shape[1], len(ledger[name].values))
            rows = np.array(np.broadcast_to(rows, (len(sites), width)), dtype=np.result_type(rows, float))
            for number, mistaken in made[name]:
                rows[number] = mistaken(rows[number], _Case(values, number))
            return rows

        return change

    wanted = {*guide.before[id], id}
    names = {name for name in (*working.entered, *made) if name in wanted}
    values = follow(ledger, {name: laid(name) for name in names}, only=wanted)
    return np.broadcast_to(values[id], (len(sites), len(ledger[id].values))).real


class _Case(Mapping[str, np.ndarray]):
    """One case of values that have a row for each."""

    def __init__(self, values: Mapping[str, np.ndarray], number: int) -> None:
        self.values_of_all, self.number = values, number

    def __getitem__(self, id: str) -> np.ndarray:
        value = self.values_of_all[id]
        return value if value.ndim == 1 else value[self.number % len(value)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.values_of_all)

    def __len__(self) -> int:
        return len(self.values_of_all)
