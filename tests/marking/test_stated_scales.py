"""Plans drawn at other scales than the report's: the sheet asks for these, and tolerances follow them both ways."""

from __future__ import annotations

from collections import Counter
from functools import partial
from operator import mul
from typing import Any

import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.case.answer_key import Role
from reportgen.classes.class_marking import asked_of
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Answer, Marking, Submission, Verdict
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.toleranced_key import Ask
from tests.lanes import matrix
from tests.marking import hands, students
from tests.marking.machines import MACHINES
from tests.marking.rates import STEADY

POSITIONS = (2, 4, 7)
TELLING = [("four-bar-01", 3.0), ("shaper-02", 1 / 3)]


def drawn_at(scheme: MarkingScheme, factor: float, seed: int) -> Submission:
    """The sheet that a class is handed, of a good hand whose plans are all so many times coarser."""
    asked, ledger = replace(scheme, key=Ask().on_paper(scheme.key)), scheme.ledger

    def how(position: int) -> dict[str, Any]:
        def coarser(id: str) -> float:
            values = ledger[id].values
            return factor * float(values[position - 1 if len(values) > 1 else 0].real)

        chosen: dict[str, Any] = {
            "plan_scales": {what: coarser(f"mu.{what}") for what in "va" if ledger[f"mu.{what}"].definition is None},
            "force_scale": {id.removeprefix("mu.R"): coarser(id) for id in ledger.families if id.startswith("mu.R")},
        }
        paper = [id for id, family in ledger.families.items() if id.startswith("drawn.") and family.definition is None]
        return chosen | {"paper": float(ledger[paper[0]].values[0]) / factor} if paper else chosen

    return hands.handed_in(
        asked, {k: hands.at_work(scheme, k, seed=100 * seed + k, **STEADY | how(k)) for k in POSITIONS}
    )


def graded(scheme: MarkingScheme, sheet: Submission, stated: bool = True) -> Marking:
    """The sheet marked as `grade` marks it, with the scales left empty if they are not `stated`."""
    scales = {row.id for row in scheme.key.rows if row.role is Role.scale}
    values = {place: one for place, one in sheet.values.items() if stated or place[0] not in scales}
    sheet = replace(sheet, values=values)
    return mark(asked_of(scheme, sheet), sheet)


def wrong(marking: Marking) -> Counter[str]:
    return Counter(cell.id for cell in marking.cells if cell.given is not None and cell.points < cell.worth)


@pytest.mark.parametrize(("name", "factor"), matrix([(name, by) for name in MACHINES for by in (3.0, 1 / 3)], TELLING))
def test_who_states_the_scale_is_judged_by_it(name: str, factor: float) -> None:
    """± 0.3 mm at each end of a length, on paper a third or three times as large: no cell is marked wrong."""
    scheme = students.scheme(name, POSITIONS)
    for seed in range(2 if (name, factor) in TELLING else 6):
        assert wrong(graded(scheme, drawn_at(scheme, factor, seed))) == {}


def test_the_sheet_asks_for_the_scales_of_plans_that_carry_marks() -> None:
    """Of all plans that something asked for is read from, and of no other; the cells may be left empty."""
    full = students.scheme("four-bar-01", POSITIONS).key
    scales = {row.id: row for row in Ask().on_paper(full).asked if row.role is Role.scale}
    assert set(scales) == {"mu.l", "mu.v", "mu.a", "mu.R23", "mu.R1"}
    assert all(row.named.endswith("có thể để trống") for row in scales.values())
    # A velocity is read from its own plan; an acceleration takes n = v²/l from it, a force both.
    found = {
        section: {row.id for row in Ask((section,)).on_paper(full).asked if row.role is Role.scale}
        for section in ("velocity", "acceleration", "cycle")
    }
    assert {"mu.v"} <= found["velocity"] <= {"mu.v", "mu.l"}
    assert {"mu.v", "mu.a"} <= found["acceleration"]
    assert not any(one.startswith("mu.R") for one in found["acceleration"])
    everything = Ask(("*",)).on_paper(full)
    assert [row.described for row in everything.rows] == [row.described for row in full.rows]


def test_a_scale_costs_nothing() -> None:
    """Left empty, or with a slip in its unit, it changes no mark and is worth none."""
    scheme = students.scheme("four-bar-01", POSITIONS)
    sheet = drawn_at(scheme, 1.0, 0)
    right = graded(scheme, sheet)
    assert wrong(right) == {}
    for factor in (1e3, 1e-3, 0.0, -1.0):
        values = {
            place: Answer(factor * one.value, "", one.location) if place[0].startswith("mu.") else one
            for place, one in sheet.values.items()
        }
        slipped = graded(scheme, replace(sheet, values=values))
        assert (slipped.points, slipped.out_of) == (right.points, right.out_of)
    empty = graded(scheme, sheet, stated=False)
    assert (empty.points, empty.out_of) == (right.points, right.out_of)


@pytest.mark.parametrize(
    ("factor", "off", "is_right"), [(1 / 3, 0.9, False), (1.0, 0.9, True), (1.0, 2.5, False), (3.0, 2.5, True)]
)
def test_tolerances_follow_a_stated_scale_both_ways(factor: float, off: float, is_right: bool) -> None:
    """A velocity off by so many mm on the report's plan: within 1 mm at its scale, within a third or three times that.

    Three figures and a share of 0.5 % are added, far less than 0.1 mm or 1.5 mm at these scales.
    """
    scheme = students.scheme("four-bar-01", POSITIONS)
    sheet = drawn_at(scheme, 1.0, 0)
    values = {
        place: Answer(factor * one.value, "", one.location) if place[0].startswith("mu.") else one
        for place, one in sheet.values.items()
    }
    key = scheme.key.row("v.C")
    millimetre = float(scheme.key.row("mu.v").values[0])
    values["v.C", 4] = Answer(float(key.values[3]) + off * millimetre, "", sheet.values["v.C", 4].location)
    marking = graded(scheme, replace(sheet, values=values))
    (cell,) = (one for one in marking.cells if (one.id, one.position) == ("v.C", 4))
    assert (cell.verdict is Verdict.right) == is_right


# --- a scale that a mistake has changed -------------------------------------------------------------

MISREAD: dict[str, dict[str, hands.Change]] = {
    "n misread": {"n": lambda _: 2000.0},
    "n and G2 misread": {"n": lambda _: 2000.0, "G2": lambda _: 25.0},
    "ω = 2πn without /60": {"omega.1": lambda value: 60 * value},
    "ω = n": {"omega.1": lambda value: value * 30 / np.pi},
    "H misread": {"H": lambda _: 0.085},
    "R = H": {"R": lambda value: 2 * value},
    "D misread": {"D": lambda _: 0.088},
    "v_A wrong": {"v.A": lambda value: 1.3 * value},
    "a_A wrong": {"a.A": lambda value: 1.3 * value},
}
"""Mistakes of a student of the twin engine before the plans: μ_v = ω₁μ_l and v_A/pa grow with them."""

FEWEST, MOST = 1, 3
"""Marks that a mistake may cost: its own, and what the drawing's errors keep from being met."""


def lost(marking: Marking) -> float:
    return sum(cell.worth - cell.points for cell in marking.cells if cell.given is not None)


@pytest.mark.parametrize("by_lengths", matrix([True, False], [True]))
@pytest.mark.parametrize("paper", matrix([0.05, 0.03, 0.08], [0.05]))
@pytest.mark.parametrize("what", MISREAD)
def test_a_mistake_before_the_plans_costs_the_same_with_the_scales_as_without(
    what: str, paper: float, by_lengths: bool
) -> None:
    """v_BA = μ_v·ab by the own μ_v, however that was found and however large the crank is drawn."""
    scheme = students.scheme(hands.TWIN, (4,))
    asked = replace(scheme, key=Ask().on_paper(scheme.key))
    how = {"paper": paper, "by_lengths": by_lengths, "plan_scales": {}, "blunt": 0.3e-3}
    sheet = hands.handed_in(asked, {4: hands.at_work(scheme, 4, changes=MISREAD[what], seed=4, **how)})
    with_scales, without = (lost(graded(scheme, sheet, stated)) for stated in (True, False))
    assert FEWEST <= with_scales <= MOST
    assert with_scales <= without
    if paper == 0.05:
        assert without <= MOST


def test_a_slip_in_a_scale_costs_one_mark() -> None:
    """μ_v 1.3 times too large spoils six velocities: it is one mistake, and is told as one in the scale."""
    scheme = students.scheme(hands.TWIN, (4,))
    asked = replace(scheme, key=Ask().on_paper(scheme.key))
    hand = hands.at_work(scheme, 4, changes={"mu.v": lambda value: 1.3 * value}, seed=4, plan_scales={}, blunt=0.3e-3)
    marking = graded(scheme, hands.handed_in(asked, {4: hand}))
    assert lost(marking) == 1
    assert [cell.id for cell in marking.first_errors] == ["mu.v"]


def made_up(scheme: MarkingScheme, rng: np.random.Generator) -> dict[str, Any]:
    """How a student works who misreads one datum or two, or takes a wrong ω₁, with the crank drawn smaller or not."""
    data = [id for id in hands.data_used(scheme) if id != "g"]
    chosen = rng.choice(data, size=1 + int(rng.random() < 0.3), replace=False)
    factors = rng.choice([0.8, 0.9, 1.1, 1.25], size=len(chosen))
    changes = {str(id): partial(mul, float(factor)) for id, factor in zip(chosen, factors, strict=True)}
    if "omega.1" in scheme.rows and rng.random() < 0.4:
        changes = {"omega.1": partial(mul, float(rng.choice([60.0, 30 / np.pi])))}
    how: dict[str, Any] = {"changes": changes, "by_lengths": bool(rng.integers(2)), "figures": int(rng.choice([3, 4]))}
    paper = [id for id, one in scheme.ledger.families.items() if id.startswith("drawn.") and one.definition is None]
    if paper and rng.random() < 0.5:
        # A larger drawing is read more finely, and its first values are judged so.
        how["paper"] = float(scheme.ledger[paper[0]].values[0]) / float(rng.choice([1.25, 1.6]))
    if scheme.ledger["mu.l"].definition is not None and rng.random() < 0.75:
        how["plan_scales"] = {}
    return how | {"blunt": 0.3e-3, "seed": int(rng.integers(1 << 30))}


@pytest.mark.parametrize(
    ("name", "count"),
    [
        # The twin engine has the most values behind a scale.
        *matrix([(name, 20 if name == "engine-twin-05" else 5) for name in MACHINES], []),
        *(("slider-crank-01", 6), ("four-bar-01", 3), ("engine-v-01", 3)),
    ],
)
def test_filling_in_a_scale_never_costs(name: str, count: int) -> None:
    scheme, rng = students.scheme(name, (4,)), np.random.default_rng(59)
    asked = replace(scheme, key=Ask().on_paper(scheme.key))
    tried = 0
    while tried < count:
        try:
            hand = hands.at_work(scheme, 4, **made_up(scheme, rng))
        except (ValueError, ZeroDivisionError):
            # With such lengths the machine does not go together.
            continue
        tried += 1
        sheet = hands.handed_in(asked, {4: hand})
        with_scales, without = (graded(scheme, sheet, stated) for stated in (True, False))
        assert with_scales.points >= without.points
        assert with_scales.out_of == without.out_of
