"""Named mistakes are found where they are made: injected everywhere they can occur, in drawn variants."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import pytest

from reportgen.cases import opened
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking, Submission
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.mistakes import WRONG_DATUM, Mistake, general_mistakes, mistakes_in
from tests.lanes import proof
from tests.marking import students
from tests.marking.students import NAMES, OF_FURTHER_KEYS, World

MACHINES = (
    "engine-twin-05",
    "engine-single-III",
    "slider-crank-01",
    "four-bar-01",
    "shaper-02",
    "slotted-lever-01",
    "lever-six-bar-01",
    "four-bar-03",
    "lever-six-bar-02",
    "slider-crank-friction",
)
"""Two turning kinds of group, a slot, a guide, four strokes, an accelerated crank, a spring, friction: each mistake can
occur in some of them."""

WORKED = (2, 3, 5, 8)
INSTANTS = ("four-bar-03", "lever-six-bar-02")
"""Of these the single instant is worked out."""

SAMPLE = 6
"""Mistakes drawn for each variant beside one of each name; `python -m tests.bench.mistakes` takes all."""


def variant(name: str, rng: np.random.Generator) -> MarkingScheme:
    """A random variant of a machine, some of its positions worked out."""
    return students.marking_scheme(opened(students.varied(name, rng, None if name in INSTANTS else WORKED)))


def possible_mistakes(scheme: MarkingScheme) -> list[Mistake]:
    """Every mistake at every place where it can occur, once where two names mean one deed.

    The sign of a rotation's size is the direction of the rotation.
    """
    found: list[Mistake] = []
    for id, family in scheme.ledger.families.items():
        read = family.definition is None and len(family.values) > 1
        if family.hidden or family.is_plane or (family.definition is None and not read):
            continue
        twin = f"turn.{id}" in scheme.ledger
        found += [one for one in mistakes_in(scheme, id, {}) if not (twin and one.name == "sign-reversed")]
    return [*found, *general_mistakes(scheme)]


def is_found(scheme: MarkingScheme, mistake: Mistake, world: World, first: students.Effect, marking: Marking) -> bool:
    """Whether the first error is told where it shows, under its name or under one that gives the same values."""
    hits = [cell for cell in marking.first_errors if cell.id == first.id]
    if any(cell.mistake == mistake.name for cell in hits):
        return True
    row = scheme.rows[first.id]
    named = {(cell.mistake, cell.where) for cell in hits if cell.mistake}
    same = [other for other in possible_mistakes(scheme) if (other.name, other.where) in named]
    return any(
        all(students.off(scheme, row, students.worked_out(scheme, other), k, world) <= 1 for k in first.positions)
        for other in same
    )


def shows(scheme: MarkingScheme, mistake: Mistake, first: students.Effect) -> bool:
    """Whether a mistake shows where it is made, if that is asked for at all."""
    judged = {row.id for row in scheme.judged}
    at = next((id for id in (mistake.where, f"turn.{mistake.where}") if id in judged), None)
    return len(mistake.changes) > 1 or at is None or at == first.id or mistake.name == "no-coriolis"


@dataclass
class Rates:
    """How many mistakes of each name were made, and how many of them were told."""

    made: Counter[str] = field(default_factory=Counter)
    found: Counter[str] = field(default_factory=Counter)

    def inject(self, scheme: MarkingScheme, mistake: Mistake, rng: np.random.Generator) -> bool:
        """One student with one mistake, drawing by hand; False for one that shows nowhere, which is none."""
        clean = students.worked_out(scheme, mistake)
        first = students.effect(scheme, clean)
        if first is None or not shows(scheme, mistake, first):
            return False
        world = students.worked_out(scheme, mistake, drawn=rng)
        self.made[mistake.name] += 1
        self.found[mistake.name] += is_found(
            scheme, mistake, clean, first, mark(scheme, students.written(scheme, world))
        )
        return True

    @property
    def rate(self) -> float:
        return self.found.total() / self.made.total()

    def __str__(self) -> str:
        lines = [f"{name:20} {self.found[name]:5} of {self.made[name]:5}" for name in sorted(self.made)]
        return "\n".join([*lines, f"{'all':20} {self.found.total():5} of {self.made.total():5}: {self.rate:.1%}"])


@proof
def test_named_mistakes_are_found() -> None:
    """With drawn tolerances: the first error and its name in 95 of 100, as the specification aims."""
    rng = np.random.default_rng(20261121)
    rates = Rates()
    for name in MACHINES:
        scheme = variant(name, rng)
        possible = possible_mistakes(scheme)
        for name in sorted({mistake.name for mistake in possible}):
            of_it = [mistake for mistake in possible if mistake.name == name]
            # The first that shows, in any order.
            any(rates.inject(scheme, of_it[k], rng) for k in rng.permutation(len(of_it)))
        for k in rng.choice(len(possible), SAMPLE, replace=False):
            rates.inject(scheme, possible[k], rng)
    print(rates)
    # Of a small coefficient arctan f is f but for less than a tolerance drawn: made with a large one elsewhere.
    assert set(rates.made) | {"coefficient-for-angle"} == NAMES | OF_FURTHER_KEYS
    assert rates.rate >= 0.95, str(rates)
    # Each by itself is told in most of the places where it can be made.
    assert all(rates.found[name] >= 0.5 * rates.made[name] for name in rates.made), str(rates)


@pytest.mark.parametrize(
    ("machine", "id", "name"),
    [
        ("engine-twin-05", "R", "stroke-for-radius"),
        ("engine-twin-05", "L", "ratio-inverted"),
        ("engine-twin-05", "omega.1", "rpm-for-radians"),
        ("engine-twin-05", "omega.1", "minute-for-second"),
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
        ("four-bar-03", "a.B.t", "no-tangential"),
        ("four-bar-03", "turn.eps.1", "direction-reversed"),
        ("four-bar-03", "M.Pqt1", "no-couple-of-driver"),
        ("lever-six-bar-02", "P5a", "no-free-length"),
        ("slider-crank-friction", "friction.rho.B", "radius-for-circle"),
        ("slider-crank-friction", "friction.omega.12", "one-link"),
        ("slider-crank-friction", "friction.eta", "efficiency-inverted"),
    ],
)
def test_each_mistake_on_a_sheet_of_one_position(machine: str, id: str, name: str) -> None:
    scheme = students.scheme(machine, (1 if machine in INSTANTS else 4,))
    mistake = next(one for one in possible_mistakes(scheme) if (one.where, one.name) == (id, name))
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme, mistake)))
    firsts = {(cell.id, cell.mistake, cell.where) for cell in marking.first_errors}
    assert (id, name, id) in firsts


def test_mistake_before_the_first_value_on_the_sheet() -> None:
    """Who hands in velocities only, worked out with the stroke for the radius, is told so."""
    scheme = students.scheme("engine-twin-05", (4,))
    mistake = next(one for one in possible_mistakes(scheme) if one.name == "stroke-for-radius")
    world = students.worked_out(scheme, mistake)
    filled = students.written(scheme, world)
    kept = {place: given for place, given in filled.values.items() if place[0] in ("v.A", "v.B", "a.A")}
    marking = mark(scheme, Submission(filled.assignment, filled.file, kept, {}))
    assert {(cell.id, cell.mistake, cell.where) for cell in marking.first_errors} >= {("v.A", "stroke-for-radius", "R")}


@pytest.mark.parametrize(("datum", "taken"), [("H", 0.11), ("n", 2400.0), ("D", 0.09), ("G3", 28.0)])
def test_misread_datum_is_told(datum: str, taken: float) -> None:
    scheme = students.scheme("engine-twin-05", (4,))
    mistake = Mistake("", datum, {datum: lambda value, _: value * 0 + taken})
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme, mistake)))
    assert {(cell.mistake, cell.where) for cell in marking.first_errors} == {(WRONG_DATUM, datum)}
    assert marking.points == marking.out_of - len(marking.first_errors)
