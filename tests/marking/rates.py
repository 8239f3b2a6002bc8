"""What marking makes of single mistakes on sheets of students whose chains are independent of it."""

from __future__ import annotations

import operator
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from statistics import median

import numpy as np

from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking, Verdict
from reportgen.marking.mistakes import WRONG_DATUM
from tests.marking import hands, students

WORKED = (hands.WRONG_AT,)


def lost(marking: Marking) -> float:
    """Marks lost among the cells that are filled in."""
    return sum(cell.worth - cell.points for cell in marking.cells if cell.given is not None)


def share(part: float, whole: float) -> str:
    return f"{part:.0f} of {whole:.0f} ({part / whole:.1%})" if whole else "–"


@dataclass
class Tally:
    """What came of single wrong values."""

    counted: Counter[str] = field(default_factory=Counter)
    marks: list[float] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        self.counted += other.counted
        self.marks += other.marks

    @property
    def rows(self) -> list[tuple[str, str]]:
        made, n = self.counted["made"], self.counted
        return [
            ("single wrong values: located", share(n["located"], made)),
            ("told as the only first error", share(n["exactly"], made)),
            ("told under a name of another mistake", share(n["false name"], made)),
            ("marks of the other cells kept", share(n["kept"], n["others"])),
            ("marks lost: median, most", f"{median(self.marks):.0f}, {max(self.marks):.0f}"),
        ]


def injected(name: str, rng: np.random.Generator, step: int = 1) -> Tally:
    """Each value of a sheet wrong by itself, one sheet a value (every `step`th of them)."""
    scheme = hands.asked(students.scheme(name, WORKED))
    tally = Tally()
    counted = tally.counted
    written = hands.at_work(scheme, hands.WRONG_AT).written
    for id in [id for id in written if id in scheme.rows and not id.startswith(("mu.R", "dir"))][::step]:
        factors = (float(rng.choice([0.7, 1.35, 1.6])), 1.1, 0.95)
        sheet = hands.one_wrong(scheme, id, factors, blunt=0.3e-3)
        if sheet is None:
            continue
        place = (id, 0 if scheme.rows[id].single else hands.WRONG_AT)
        cells = {(cell.id, cell.position): cell for cell in mark(scheme, sheet).cells}
        cell = cells.get(place)
        if cell is None or cell.given is None or abs(cell.given - cell.expected) <= 2 * cell.band:
            continue
        firsts = [one for one in cells.values() if one.first]
        counted["made"] += 1
        counted["located"] += cell.first
        counted["exactly"] += [(one.id, one.position) for one in firsts] == [place]
        counted["false name"] += any(one.mistake and one.mistake not in ("other-scale", WRONG_DATUM) for one in firsts)
        filled = [one for one in cells.values() if one.given is not None]
        others = [one for one in filled if (one.id, one.position) != place]
        counted["others"] += len(others)
        counted["kept"] += sum(one.points == one.worth for one in others)
        tally.marks.append(sum(one.worth - one.points for one in filled))
    return tally


def misread(name: str) -> list[float]:
    """Marks lost where one datum of the task is read as another of two figures, one sheet a datum."""
    scheme = hands.asked(students.scheme(name, hands.PLACES))
    lost_for = []
    for id in hands.data_used(scheme):
        value = scheme.ledger[id].values[0].real
        with suppress(ValueError):
            taken = float(f"{1.17 * value:.1e}")
            sheet = hands.work(scheme, hands.PLACES, changes={id: partial(operator.mul, taken / value)}, blunt=0.3e-3)
            lost_for.append(lost(mark(scheme, sheet)))
    return lost_for


STEADY: Mapping[str, float] = {"blunt": 0.3e-3, "askew": 0.5, "figures": 4}
"""A good hand: ± 0.3 mm at each end of a measured length, ± 0.5° in a direction, four figures."""


@dataclass
class Misjudged:
    """Cells of honest sheets: how many are filled in, which by id lose their mark, which lie beyond the key's band."""

    filled: int = 0
    wrong: Counter[str] = field(default_factory=Counter)
    beyond: Counter[str] = field(default_factory=Counter)

    def in_a_thousand(self, found: Counter[str]) -> float:
        return 1000 * found.total() / self.filled


def misjudged(name: str, sheets: int, hand: Mapping[str, float] = STEADY) -> Misjudged:
    """Whole sheets without a mistake, every row at every position, with other luck in reading on each."""
    positions = tuple(range(1, students.scheme(name).count + 1))
    scheme, found = students.scheme(name, positions), Misjudged()
    for seed in range(sheets):
        marking = mark(scheme, hands.work(scheme, positions, seed=seed, **hand))
        filled = [cell for cell in marking.cells if cell.given is not None]
        found.filled += len(filled)
        found.wrong.update(cell.id for cell in filled if cell.points < cell.worth)
        found.beyond.update(cell.id for cell in filled if cell.verdict is not Verdict.right)
    return found
