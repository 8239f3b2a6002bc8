"""Sheets of students who work by hand (`hand`): tasks of the repository's machines, and what is handed in."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np

from reportgen.base.errors import Location
from reportgen.base.records import replace
from reportgen.case.answer_key import Role
from reportgen.cases import opened
from reportgen.marking.marking_data import Answer, Submission
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.toleranced_key import Ask
from tests.marking import students
from tests.marking.hand import Change, Hand
from tests.marking.machines import WAYS

TWIN, SLIDER, FOUR_BAR = "engine-twin-05", "slider-crank-01", "four-bar-01"
DRAWING = {"engine-twin", "slider-crank"}
"""Kinds of which the student hands in the whole sheet, plans and closed formulas too."""

WRONG_AT = 4
"""The position at which one value is wrong."""


def asked(scheme: MarkingScheme) -> MarkingScheme:
    """A guide to what a student hands in: the whole sheet of `DRAWING`, or what a class is asked."""
    return scheme if scheme.key.kind in DRAWING else replace(scheme, key=Ask().of(scheme.key))


def handed_in(scheme: MarkingScheme, worked: Mapping[int, Hand]) -> Submission:
    """The sheet of a student who worked so at each position."""
    values = {}
    for row in scheme.key.asked:
        for position in row.positions:
            hand = worked[position] if position else next(iter(worked.values()))
            value = hand.written.get(row.id)
            if value is not None and np.isfinite(value):
                values[row.id, position] = Answer(value, str(value), Location("sheet.csv"))
    return Submission(scheme.key.id, "sheet.csv", values, {})


def at_work(scheme: MarkingScheme, position: int, **how: Any) -> Hand:
    """A student's work at one position: the data, the crank's angle, the loads and the scales as the task has them."""
    ledger = scheme.ledger

    def si(id: str) -> float:
        values = ledger[id].values
        return float(values[position - 1 if len(values) > 1 else 0].real)

    given = {id: si(id) for id, family in ledger.families.items() if not (family.is_plane or family.kind == "segment")}
    first, second = ledger["phi.1" if "phi.1" in ledger else "s.1"].values[:2]
    chosen = {
        "plan_scales": {what: si(f"mu.{what}") for what in "va" if ledger[f"mu.{what}"].definition is None},
        "force_scale": {id.removeprefix("mu.R"): si(id) for id in ledger.families if id.startswith("mu.R")},
    }
    paper = [id for id, family in ledger.families.items() if id.startswith("drawn.") and family.definition is None]
    if paper:
        chosen["paper"] = si(paper[0])
    hand = Hand(given=given, turn=int(np.sign(np.sin(second - first))), **chosen | how)
    WAYS[scheme.key.kind](hand)
    return hand


def work(scheme: MarkingScheme, positions: Iterable[int], seed: int = 0, **how: Any) -> Submission:
    """The sheet of a student who works every position alike, with other luck in drawing."""
    return handed_in(scheme, {k: at_work(scheme, k, seed=100 * seed + k, **how) for k in positions})


def one_wrong(scheme: MarkingScheme, id: str, factors: Iterable[float], **how: Any) -> Submission | None:
    """A sheet with one value so many times too large, at position 4 if it has several; None if none can be drawn so.

    Of the `factors` the first with which the machine still goes together is taken.
    """
    for factor in factors:
        changes = {id: partial(operator.mul, factor)}
        with suppress(ValueError):
            worked = {
                k: at_work(scheme, k, changes=changes if k == WRONG_AT or scheme.rows[id].single else {}, seed=k, **how)
                for k in {WRONG_AT, *(position for row in scheme.judged for position in row.positions if position)}
            }
            return handed_in(scheme, worked)
    return None


def data_used(scheme: MarkingScheme) -> list[str]:
    """The data of the task that a student of the machine needs, in the order of the task."""
    used = at_work(scheme, WRONG_AT).used
    return [
        id for id in scheme.ledger.families if id in used and id not in scheme.rows and scheme.ledger[id].values.any()
    ]


# --- a class --------------------------------------------------------------------------------------

PLACES = (2, 4, 7)
"""Positions that the class works: asked for on every sheet."""

BLUNT = (0.2e-3, 0.3e-3, 0.5e-3)
"""How far beside a drawn point the members of a class read it (m)."""

MISTAKES: dict[str, Change] = {
    "omega.1": lambda value: 60 * value,
    "R": lambda value: 2 * value,
    "F": lambda value: 4 * value,
    "m.2": lambda value: 9.81 * value,
    "a.A": lambda value: 1.3 * value,
    "v.BA": lambda value: value / 10,
    "J.2": lambda value: 12 * value,
    "Pqt3": lambda value: 1.15 * value,
    "R.12.t": lambda value: -value,
    "M.eq": lambda value: -value,
    "p.3": lambda value: 1.5 * value,
    "seg.v.pb": lambda value: value + 4e-3,
    "seg.23.R12": lambda value: 0.8 * value,
    "n": lambda value: value + 100,
    "H": lambda value: value + 5e-3,
    "G2": lambda value: value + 5,
    "D": lambda value: value - 10e-3,
    "s": lambda value: value + 0.05,
    # of the four-bar linkage
    "l.AD": lambda value: value + 20e-3,
    "sum.ends": lambda value: 0.9 * value,
    "v.E": lambda value: 1.2 * value,
    "turn.omega.3": lambda value: -value,
    "R.03.t": lambda value: -value,
    "M3": lambda value: 1.25 * value,
}
"""One mistake that a member of a class makes: in a value or in reading a datum."""


DRAWN: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    TWIN: {
        "H": ("85 mm", "90 mm", "95 mm", "100 mm", "105 mm"),
        "n": ("2000 rpm", "2100 rpm", "2200 rpm", "2300 rpm"),
        "lambda": ("1/3.5", "1/3.6", "1/3.8", "1/4"),
        "D": ("92 mm", "95 mm", "98 mm", "100 mm"),
        "G2": ("18 N", "20 N", "24 N"),
        "G3": ("20 N", "22 N", "25 N"),
    },
    SLIDER: {
        "r": ("130 mm", "140 mm", "150 mm", "160 mm"),
        "l": ("560 mm", "580 mm", "600 mm", "620 mm", "640 mm"),
        "n": ("280 rpm", "300 rpm", "320 rpm", "350 rpm"),
        "G2": ("36 N", "40 N", "45 N", "50 N"),
        "G3": ("55 N", "60 N", "65 N"),
    },
    FOUR_BAR: {
        "AB": ("110 mm", "115 mm", "120 mm", "125 mm"),
        "BC": ("330 mm", "340 mm", "350 mm", "360 mm"),
        "CD": ("270 mm", "280 mm", "290 mm"),
        "omega1": ("18 rad/s", "20 rad/s", "22 rad/s", "25 rad/s"),
        "G2": ("26 N", "30 N", "34 N"),
        "G3": ("22 N", "25 N", "28 N"),
    },
}
"""The lists that the data of a class are drawn from, as a lecturer's table has them."""


def variants(count: int, rng: np.random.Generator, name: str = TWIN) -> list[MarkingScheme]:
    """The assignments of a class."""
    found = []
    for number in range(count):
        drawn = {id: str(rng.choice(values)) for id, values in DRAWN[name].items()}
        scheme = asked(students.marking_scheme(opened(students.assignment(name, PLACES, **drawn))))
        found.append(replace(scheme, key=replace(scheme.key, id=f"SV{number:02}")))
    return found


def possible(scheme: MarkingScheme) -> list[str]:
    """The mistakes of `MISTAKES` that can be made on a sheet; a given speed needs no formula."""
    given = {row.id for row in scheme.key.rows if row.role is Role.given} - {"omega.1"}
    return [id for id in MISTAKES if id in given or id in scheme.rows]


def honest(scheme: MarkingScheme, rng: np.random.Generator, mistake: str = "") -> Submission:
    """The sheet of a member of a class who worked alone, with one mistake or none."""
    how = {"blunt": float(rng.choice(BLUNT)), "figures": int(rng.choice([3, 4])), "seed": int(rng.integers(1 << 30))}
    changes = {mistake: MISTAKES[mistake]} if mistake else {}
    if scheme.key.kind in DRAWING:
        how["by_lengths"] = bool(rng.integers(2))
    return work(scheme, PLACES, changes=changes, **how)


def with_cells(sheet: Submission, other: Submission, taken: Callable[[str, int], bool]) -> Submission:
    """A sheet in which some cells are another's."""
    cells = {place: answer for place, answer in other.values.items() if taken(*place) and place in sheet.values}
    return replace(sheet, values={**sheet.values, **cells})
