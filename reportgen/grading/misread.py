"""Given data taken wrongly: the one datum whose other value explains a wrong value that comes from the data alone.

A datum is sought by working backwards: the ledger is run over many values of it at once, and the one
that meets the student's value counts if it is a number that somebody would have given: as round as the
right one.  A slip of arithmetic could otherwise nearly always be put down to some datum.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.grading.guide import Guide
from reportgen.grading.marks import Marked, Place, Verdict
from reportgen.grading.mistakes import Site
from reportgen.grading.working import Working
from reportgen.ledger.following import follow

WRONG_DATUM = "wrong-datum"

NEAT = 2
"""Significant figures of a datum that somebody would have given; a half of the last one where the right one has it."""

APART = 3.0
"""A right value that would be this many tolerances off with another datum shows that the datum was right."""

FACTORS = np.geomspace(1 / 5, 5, 400)
"""A datum that is taken wrongly lies within these of the right one."""


@dataclass(frozen=True, slots=True)
class Datum:
    """A given quantity and the value (SI) that it seems to have been taken for."""

    id: str
    value: float

    @property
    def site(self) -> Site:
        return Site(WRONG_DATUM, self.id, {self.id: lambda value, _: np.full_like(value, self.value)})


def misread_data(working: Working, cells: Mapping[Place, Marked]) -> dict[Place, Site]:
    """The misread data behind first wrong values that have no other name.

    Only what is the same at all positions is traced back: a length, a mass, the crank's speed.
    """
    found: dict[Place, Site] = {}
    known: list[Datum] = []
    for place, cell in cells.items():
        if not cell.first or cell.mistake or not working.guide.rows[cell.id].single:
            continue
        datum = next((one for one in known if _explains(working, cell, one)), None)
        if datum is None:
            possible = (one for one in _possible(working, cell) if _explains(working, cell, one))
            datum = next((one for one in possible if not _is_contradicted(working.guide, cells, one)), None)
            known += [datum] if datum else []
        if datum is not None:
            found[place] = datum.site
    return found


def _possible(working: Working, cell: Marked) -> list[Datum]:
    """Neat values of each datum at which a quantity passes through the student's value."""
    found = []
    for id in _data(working.guide, cell.id):
        right = float(working.guide.ledger[id].values[0])
        values = _at(working.guide, cell, id, FACTORS * right) - _given(working, cell)
        crossing = np.flatnonzero(np.diff(np.sign(values)) != 0)
        for index in crossing[np.isfinite(values[crossing]) & np.isfinite(values[crossing + 1])]:
            one, other = values[index], values[index + 1]
            share = one / (one - other)
            factor = float(FACTORS[index : index + 2] @ (1 - share, share))
            found.append(Datum(id, _neat(working.guide, id, right * factor)))
    return found


def _data(guide: Guide, id: str) -> list[str]:
    """The numbers on the assignment page that a quantity stands on."""
    families = (guide.ledger[name] for name in guide.before[id])
    return [
        family.id
        for family in families
        if len(family.values) == 1
        and not (family.hidden or family.is_plane or family.id in guide.rows)
        and family.values[0] > 0
    ]


def _explains(working: Working, cell: Marked, datum: Datum) -> bool:
    """Whether the quantity comes to the student's value, not the key's, with this value of the datum."""
    guide = working.guide
    if datum.id not in guide.before[cell.id]:
        return False
    band = cell.band * guide.ledger[cell.id].how.scale
    foreseen = float(_at(guide, cell, datum.id, np.array([datum.value]))[0])
    key = float(guide.ledger[cell.id].values[_index(guide, cell)].real)
    return abs(foreseen - _given(working, cell)) <= band < abs(foreseen - key)


def _is_contradicted(guide: Guide, cells: Mapping[Place, Marked], datum: Datum) -> bool:
    """Whether a value that is right, and stands on nothing wrong, would lie far off with this value of the datum.

    Lengths on paper tell nothing: they are read at the student's own scale.
    """
    values = follow(guide.ledger, {datum.id: np.array([datum.value])})
    wrong = {place[0] for place, cell in cells.items() if cell.verdict is Verdict.wrong}
    for (id, position), cell in cells.items():
        before = set(guide.before[id])
        telling = cell.verdict is Verdict.right and not _on_paper(guide, id)
        if telling and datum.id in before and not wrong & before:
            column = np.broadcast_to(values[id].real, len(guide.ledger[id].values))
            moved = float(column[guide.rows[id].at(position)]) / guide.ledger[id].how.scale - cell.expected
            if abs(moved) > APART * cell.band:
                return True
    return False


def _on_paper(guide: Guide, id: str) -> bool:
    kind = guide.ledger[id].kind
    return kind == "segment" or kind.endswith("scale") or id.startswith("dir.")


def _at(guide: Guide, cell: Marked, id: str, values: np.ndarray) -> np.ndarray:
    """A quantity (SI) over values of a datum [M]."""
    wanted = {*guide.before[cell.id], cell.id}
    result = follow(guide.ledger, {id: values[:, None]}, only=wanted)[cell.id].real
    return np.broadcast_to(result, (len(values), len(guide.ledger[cell.id].values)))[:, _index(guide, cell)]


def _given(working: Working, cell: Marked) -> float:
    return float(working.values[cell.id][_index(working.guide, cell)])


def _index(guide: Guide, cell: Marked) -> int:
    return guide.rows[cell.id].at(cell.position)


def _neat(guide: Guide, id: str, value: float) -> float:
    """The nearest number (SI) as round as the right one in the datum's printed unit; for 1/3.6 that of its inverse."""
    family = guide.ledger[id]
    # Lengths stand in metres in the ledger and in millimetres on the page: the same figures.
    taken, right = (one / family.how.scale for one in (value, float(family.values[0])))
    if family.kind == "ratio" and taken < 1 and _is_inverse(guide, id):
        return family.how.scale / _rounded(1 / taken, 1 / right)
    return _rounded(taken, right) * family.how.scale


def _rounded(value: float, like: float) -> float:
    """A number to `NEAT` figures, to halves of the last one if `like` has more figures than these."""
    parts = 1 if np.isclose(like, float(f"{like:.{NEAT - 1}e}"), rtol=1e-9) else 2
    step = 10.0 ** (np.floor(np.log10(value)) - NEAT + 1) / parts
    return float(round(value / step) * step)


def _is_inverse(guide: Guide, id: str) -> bool:
    """Whether a ratio was given as 1/3.6, which the ledger works out."""
    return guide.ledger[id].definition is not None
