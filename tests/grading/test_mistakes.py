"""Named mistakes are found where they are made: injected everywhere they can occur, in drawn variants."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import pytest

from reportgen.grading.guide import Guide
from reportgen.grading.marking import mark
from reportgen.grading.marks import Marking
from reportgen.grading.misread import WRONG_DATUM
from reportgen.grading.mistakes import Site, sites_anywhere, sites_in
from tests.grading import students
from tests.grading.students import NAMES, World

MACHINES = (
    "engine-twin-05",
    "engine-single-III",
    "slider-crank-01",
    "four-bar-01",
    "shaper-02",
    "slotted-lever-01",
    "lever-six-bar-01",
)
"""Two turning kinds of group, a slot, a guide, four strokes: each mistake can occur in some of them."""

WORKED = (2, 3, 5, 8)

SAMPLE = 30
"""Sites drawn for each variant beside one of each name; `python -m tests.bench.mistakes` takes all."""


def sites(guide: Guide) -> list[Site]:
    """Every mistake at every place where it can occur, once where two names mean one deed.

    The sign of a rotation's size is the direction of the rotation.
    """
    found: list[Site] = []
    for id, family in guide.ledger.families.items():
        read = family.definition is None and len(family.values) > 1
        if family.hidden or family.is_plane or (family.definition is None and not read):
            continue
        twin = f"turn.{id}" in guide.ledger
        found += [site for site in sites_in(guide, id, {}) if not (twin and site.mistake == "sign-reversed")]
    return [*found, *sites_anywhere(guide)]


def is_found(guide: Guide, site: Site, world: World, first: students.Effect, marking: Marking) -> bool:
    """Whether the first error is told where it shows, under its name or under one that gives the same values."""
    hits = [cell for cell in marking.firsts if cell.id == first.id]
    if any(cell.mistake == site.mistake for cell in hits):
        return True
    row = guide.rows[first.id]
    named = {(cell.mistake, cell.where) for cell in hits if cell.mistake}
    alike = [other for other in sites(guide) if (other.mistake, other.where) in named]
    return any(
        all(students.off(guide, row, students.worked_out(guide, other), k, world) <= 1 for k in first.positions)
        for other in alike
    )


def shows(guide: Guide, site: Site, first: students.Effect) -> bool:
    """Whether a mistake shows where it is made, if that is asked for at all."""
    judged = {row.id for row in guide.judged}
    at = next((id for id in (site.where, f"turn.{site.where}") if id in judged), None)
    return len(site.changes) > 1 or at is None or at == first.id or site.mistake == "no-coriolis"


@dataclass
class Rates:
    """How many mistakes of each name were made, and how many of them were told."""

    made: Counter[str] = field(default_factory=Counter)
    found: Counter[str] = field(default_factory=Counter)

    def inject(self, guide: Guide, site: Site, rng: np.random.Generator) -> None:
        """One student with one mistake, drawing by hand; a mistake that shows nowhere is none."""
        clean = students.worked_out(guide, site)
        first = students.effect(guide, clean)
        if first is None or not shows(guide, site, first):
            return
        world = students.worked_out(guide, site, drawn=rng)
        self.made[site.mistake] += 1
        self.found[site.mistake] += is_found(guide, site, clean, first, mark(guide, students.written(guide, world)))

    @property
    def rate(self) -> float:
        return self.found.total() / self.made.total()

    def __str__(self) -> str:
        lines = [f"{name:20} {self.found[name]:5} of {self.made[name]:5}" for name in sorted(self.made)]
        return "\n".join([*lines, f"{'all':20} {self.found.total():5} of {self.made.total():5}: {self.rate:.1%}"])


def test_named_mistakes_are_found() -> None:
    """With drawn tolerances: the first error and its name in 95 of 100, as the specification aims."""
    rng = np.random.default_rng(20261121)
    rates = Rates()
    for name in MACHINES:
        guide = students.open_guide(students.varied(name, rng, WORKED))
        possible = sites(guide)
        one_of_each = {site.mistake: site for site in possible}
        drawn = [possible[k] for k in rng.choice(len(possible), SAMPLE, replace=False)]
        for site in (*one_of_each.values(), *drawn):
            rates.inject(guide, site, rng)
    print(rates)
    assert set(rates.made) == NAMES
    assert rates.rate >= 0.95, str(rates)
    # Each by itself is told in most of the places where it can be made.
    assert all(rates.found[name] >= 0.5 * rates.made[name] for name in NAMES), str(rates)


@pytest.mark.parametrize(
    ("name", "id", "mistake"),
    [
        ("engine-twin-05", "R", "stroke-for-radius"),
        ("engine-twin-05", "L", "ratio-inverted"),
        ("engine-twin-05", "omega.1", "rpm-for-radians"),
        ("engine-twin-05", "m.3", "weight-for-mass"),
        ("engine-twin-05", "Pqt3", "weight-for-mass"),
        ("engine-twin-05", "F", "diameter-for-radius"),
        ("engine-twin-05", "f.v.B", "degrees-for-radians"),
        ("engine-twin-05", "beta.2", "radians-for-degrees"),
        ("engine-twin-05", "turn.omega.2", "direction-reversed"),
        ("engine-twin-05", "M.eq", "sign-reversed"),
        ("engine-twin-05", "p.3", "other-piston"),
        ("engine-twin-05", "p.3", "wrong-stroke"),
        ("engine-twin-05", "l.AS2", "wrong-end"),
        ("engine-twin-05", "v.BA", "scale-forgotten"),
        ("engine-twin-05", "a.B", "scale-twice"),
        ("engine-twin-05", "v.B", "thousands-mark"),
        ("slotted-lever-01", "a.B3B.k", "no-coriolis"),
    ],
)
def test_each_mistake_on_a_sheet_of_one_position(name: str, id: str, mistake: str) -> None:
    guide = students.guide(name, (4,))
    site = next(site for site in sites(guide) if (site.where, site.mistake) == (id, mistake))
    marking = mark(guide, students.written(guide, students.worked_out(guide, site)))
    firsts = {(cell.id, cell.mistake, cell.where) for cell in marking.firsts}
    assert (id, mistake, id) in firsts


def test_mistake_before_the_first_value_on_the_sheet() -> None:
    """Who hands in velocities only, worked out with the stroke for the radius, is told so."""
    guide = students.guide("engine-twin-05", (4,))
    site = next(site for site in sites(guide) if site.mistake == "stroke-for-radius")
    world = students.worked_out(guide, site)
    filled = students.written(guide, world)
    kept = {place: given for place, given in filled.values.items() if place[0] in ("v.A", "v.B", "a.A")}
    marking = mark(guide, students.Submission(filled.assignment, filled.file, kept, {}))
    assert {(cell.id, cell.mistake, cell.where) for cell in marking.firsts} >= {
        ("v.A", "stroke-for-radius", "R")
    }


@pytest.mark.parametrize(("datum", "taken"), [("H", 0.11), ("n", 2400.0), ("D", 0.09), ("G3", 28.0)])
def test_misread_datum_is_told(datum: str, taken: float) -> None:
    guide = students.guide("engine-twin-05", (4,))
    site = Site("", datum, {datum: lambda value, _: value * 0 + taken})
    marking = mark(guide, students.written(guide, students.worked_out(guide, site)))
    assert {(cell.mistake, cell.where) for cell in marking.firsts} == {(WRONG_DATUM, datum)}
    assert marking.points == marking.out_of - len(marking.firsts)
