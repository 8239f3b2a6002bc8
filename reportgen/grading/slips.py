"""Slips of writing down: too few figures, a value in another's cell, angles by another convention.

Nothing was worked out wrongly, so these are told from the sheet alone and looked for before mistakes of working.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

from reportgen.answers.key import Role
from reportgen.grading.guide import Guide
from reportgen.grading.marks import Marked, Place, Verdict
from reportgen.grading.mistakes import Site
from reportgen.grading.working import Working

FEW = 2
"""Significant figures that are too few, but still tell the value; one figure tells next to nothing."""

FEWEST = 4
"""Fewer angles show no convention."""

AGREED = 0.8
"""The share of the angles not right that one convention explains."""

CONVENTIONS: tuple[tuple[str, float, float], ...] = (
    ("angle-clockwise", -1.0, 0.0),
    ("angle-from-vertical", 1.0, -90.0),
    ("angle-from-vertical", -1.0, 90.0),
    ("angle-from-vertical", 1.0, 90.0),
)
"""How angles are measured otherwise: name, factor and summand (°) of the angle asked for."""

Cells = Mapping[Place, Marked]


def name_slips(working: Working, cells: Cells) -> dict[Place, Site]:
    """The slips behind first wrong values, where they are known."""
    first = {place: cell for place, cell in cells.items() if cell.first}
    guide = working.guide
    return _misplaced(guide, first, cells) | _too_short(first) | _unlike(guide, first) | _conventions(first, cells)


def _site(mistake: str, id: str) -> Site:
    """A slip in a value that stands on the sheet: nothing else comes from it unseen."""
    return Site(mistake, id, {})


def _too_short(first: Cells) -> dict[Place, Site]:
    """Values that are right but for their figures."""
    return {
        place: _site("too-few-figures", place[0])
        for place, cell in first.items()
        if cell.given and any(_is_cut(cell.given, one, cell.band) for one in (cell.own, cell.expected))
    }


def _is_cut(given: float, value: float, band: float) -> bool:
    return given == float(f"{value:.{FEW}g}") and abs(given - value) > band


def _unlike(guide: Guide, first: Cells) -> dict[Place, Site]:
    """Scales taken from the task while the plan was drawn at another."""
    return {
        place: _site("other-scale", place[0])
        for place, cell in first.items()
        if guide.rows[place[0]].role is Role.scale
        and cell.given is not None
        and abs(cell.given - cell.expected) <= cell.band
    }


def _misplaced(guide: Guide, first: Cells, cells: Cells) -> dict[Place, Site]:
    """Two values of one unit in each other's rows; a value beside its own cell, which was left empty."""
    found: dict[Place, Site] = {}
    for (one, mine), (other, theirs) in combinations(first.items(), 2):
        same = one[1] == other[1] and guide.rows[one[0]].unit == guide.rows[other[0]].unit
        # Of two values that differ in sign alone, both signs were reversed.
        opposite = abs(mine.expected + theirs.expected) <= mine.band
        if same and not opposite and _is(mine, theirs.expected, theirs.band) and _is(theirs, mine.expected, mine.band):
            found |= {place: _site("rows-swapped", place[0]) for place in (one, other)}
    for place, cell in first.items():
        for position in guide.rows[place[0]].positions:
            beside = cells[place[0], position]
            if beside.verdict is Verdict.blank and _is(cell, beside.expected, beside.band):
                found[place] = _site("wrong-column", place[0])
    return found


def _is(cell: Marked, value: float, band: float) -> bool:
    return cell.given is not None and abs(cell.given - value) <= band < abs(cell.expected - value)


def _conventions(first: Cells, cells: Cells) -> dict[Place, Site]:
    """Directions that one other convention explains, if it explains most of those that are not right."""
    angles = {place: cell for place, cell in first.items() if place[0].startswith("dir.")}
    off = sum(
        cell.given is not None and cell.verdict is not Verdict.right
        for place, cell in cells.items()
        if place[0].startswith("dir.")
    )
    best: dict[Place, Site] = {}
    for mistake, factor, summand in CONVENTIONS:
        met = [place for place, cell in angles.items() if _is_measured(cell, factor, summand)]
        if len(met) >= max(FEWEST, AGREED * off, len(best) + 1):
            best = {place: _site(mistake, place[0]) for place in met}
    return best


def _is_measured(cell: Marked, factor: float, summand: float) -> bool:
    if cell.given is None:
        return False
    apart = (cell.given - factor * cell.expected - summand + 180) % 360 - 180
    return abs(apart) <= cell.band
