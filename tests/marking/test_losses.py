"""One mistake costs one mark, two at most, whatever stands on it; a plan at any sensible scale costs nothing."""

from __future__ import annotations

import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking
from reportgen.marking.mistakes import Mistake
from tests.lanes import matrix
from tests.marking import hands, students
from tests.marking.hand import Change
from tests.marking.published import FIGURES, POSITION
from tests.marking.rates import lost

AT = (4,)
MOST = 2
"""Marks that one mistake may cost: its own, and one that the drawing's errors keep from being met."""


MADE: dict[str, tuple[str, Change]] = {
    "2πn without /60": ("omega.1", lambda value: 60 * value),
    "ω = n": ("omega.1", lambda value: value * 30 / np.pi),
    "R = H": ("R", lambda value: 2 * value),
    "F a ten-thousandth": ("F", lambda value: 1e-4 * value),
    "a_A wrong": ("a.A", lambda value: 1.3 * value),
    "a_A = ωR": ("a.A", lambda value: value / 230.4),
    "μ_l wrong": ("mu.l", lambda value: 1.3 * value),
    "μ_a wrong": ("mu.a", lambda value: 10 * value),
    "L wrong": ("L", lambda value: 1.2 * value),
    "s read as 0.36": ("s", lambda _: 0.36),
    "v_BA wrong": ("v.BA", lambda value: 1.2 * value),
    "a_S2 wrong": ("a.S2", lambda value: 1.2 * value),
    "S2 laid wrongly": ("seg.a.as2", lambda value: 1.4 * value),
    "a force laid wrongly": ("seg.23.Pqt3", lambda value: 1.4 * value),
    "the rod drawn too long": ("drawn.AB", lambda value: 1.2 * value),
    "n misread": ("n", lambda _: 2000.0),
    "H misread": ("H", lambda _: 0.085),
    "G2 misread": ("G2", lambda _: 25.0),
}


@pytest.mark.parametrize("blunt", matrix([0.0, 0.3e-3], [0.3e-3]))
@pytest.mark.parametrize("what", MADE)
def test_one_mistake_costs_one_mark(what: str, blunt: float) -> None:
    scheme = students.scheme(hands.TWIN, AT)
    id, change = MADE[what]
    marking = mark(scheme, hands.work(scheme, AT, changes={id: change}, blunt=blunt))
    assert 1 <= lost(marking) <= MOST
    assert marking.flags == ()


@pytest.mark.parametrize("blunt", matrix([0.0, 0.3e-3], [0.3e-3]))
@pytest.mark.parametrize("name", ["Pqt3", "Pqt2", "Pqt5", "P5"])
@pytest.mark.parametrize("how", ["left_out", "turned"])
def test_a_force_wrong_in_its_plan_is_one_mistake_with_a_name(name: str, how: str, blunt: float) -> None:
    scheme = students.scheme(hands.TWIN, AT)
    marking = mark(scheme, hands.work(scheme, AT, blunt=blunt, **{how: frozenset({name})}))
    assert 1 <= lost(marking) <= MOST
    named = "force-left-out" if how == "left_out" else "force-reversed"
    assert (named, name) in {(cell.mistake, cell.where) for cell in marking.first_errors}


def test_a_normal_part_left_out_is_one_mistake_with_a_name() -> None:
    scheme = students.scheme(hands.TWIN, AT)
    marking = mark(scheme, hands.work(scheme, AT, left_out=frozenset({"n.BA"})))
    assert lost(marking) == 1
    assert [(cell.mistake, cell.where) for cell in marking.first_errors] == [("part-left-out", "a.BA.n")]


@pytest.mark.parametrize("machine", ["four-bar-01", "lever-six-bar-01", "shaper-02"])
def test_a_working_load_forgotten_is_one_mistake_with_a_name(machine: str) -> None:
    """The load is printed on the task, so no cell of the sheet shows it."""
    scheme = students.scheme(machine, (2,))
    load = next(one for one in scheme.misconceptions.loads if not one.startswith(("G", "Pqt")))
    world = students.worked_out(scheme, Mistake("", load, {load: lambda value, _: value * 0}))
    marking = mark(scheme, students.written(scheme, world))
    assert 1 <= lost(marking) <= MOST
    assert "load-forgotten" in {cell.mistake for cell in marking.first_errors}


SCALES = (
    {"paper": 0.03},
    {"paper": 0.025},
    {"paper": 0.08},
    {"force_scale": 20920.0},
    {"force_scale": 5e5},
    {"force_scale": 2e3},
    {"force_scale": 1e5, "plan_scales": {"v": 400.0, "a": 1e5}},
)


@pytest.mark.parametrize("blunt", matrix([0.0, 0.3e-3, 0.5e-3], [0.5e-3]))
@pytest.mark.parametrize("scale", SCALES, ids=str)
def test_a_freely_chosen_scale_costs_nothing(scale: dict[str, float], blunt: float) -> None:
    scheme = students.scheme(hands.TWIN, AT)
    for seed in range(2):
        assert lost(mark(scheme, hands.work(scheme, AT, blunt=blunt, seed=seed, **scale))) == 0


def test_a_finer_drawing_is_read_more_finely() -> None:
    """R03 = 492 N is within ± 180 N where 1 mm is 100 N, within a third of that where it is 21 N."""
    scheme = students.scheme(hands.TWIN, AT)
    coarse, fine = (mark(scheme, hands.work(scheme, AT, force_scale=scale)) for scale in (1e5, 20920.0))
    wide, narrow = (next(cell.band for cell in one.cells if cell.id == "R.03") for one in (coarse, fine))
    assert narrow < wide / 2
    length = next(cell for cell in fine.cells if cell.id == "seg.23.R03")
    assert length.on_sheet.expected == pytest.approx(492.11 / 20.92, rel=1e-3)


def test_the_bands_of_an_engine_know_its_strokes_and_the_scale_of_its_plans() -> None:
    """In the intake stroke p₃ = 2 N/cm², though combustion comes to 280; R03 is read more finely at a finer scale."""
    scheme = students.scheme("engine-single-III")
    usual = scheme.bands
    finer = scheme.bands_at({"mu.R23": np.full(len(scheme.ledger["mu.R23"].values), 0.2)})
    pressure, reaction = scheme.key.row("p.3").values, np.abs(scheme.ledger["R.03"].values)
    assert pressure[2] == 2
    assert usual["p.3"][2] / scheme.ledger["p.3"].how.scale < 0.15
    assert np.median(finer["R.03"] / usual["R.03"]) < 0.7
    assert (usual["R.03"] < reaction).mean() > 0.9


def test_a_slip_in_writing_the_scale_is_named_and_costs_one_mark() -> None:
    scheme = students.scheme(hands.TWIN, AT)
    sheet = hands.work(scheme, AT, blunt=0.3e-3, force_scale=20920.0)
    given = replace(sheet.values["mu.R23", AT[0]], value=0.92, text="0.92")
    marking = mark(scheme, replace(sheet, values={**sheet.values, ("mu.R23", AT[0]): given}))
    assert lost(marking) == 1
    assert [(cell.id, cell.mistake) for cell in marking.first_errors] == [("mu.R23", "other-scale")]


FROM_ELSEWHERE: dict[str, tuple[str, Change]] = {
    "two per cent beside its own length": ("R.05", lambda value: 1.02 * value),
    "a_B for the tangential part": ("turn.eps.2", lambda value: 1.03 * value),
    "figures exchanged": ("Pqt4", lambda value: value * 4433 / 4343),
}


@pytest.mark.parametrize("what", FROM_ELSEWHERE)
def test_a_right_value_that_the_own_ones_do_not_give_is_told_and_costs_nothing(what: str) -> None:
    scheme = students.scheme(hands.TWIN, AT)
    id, change = FROM_ELSEWHERE[what]
    marking = mark(scheme, hands.work(scheme, AT, changes={id: change}, blunt=0.3e-3))
    assert lost(marking) == 0
    assert [cell.id for cell in marking.elsewhere] == [id]


@pytest.mark.parametrize("name", matrix([hands.TWIN, hands.SLIDER], [hands.SLIDER]))
def test_who_went_on_from_the_own_values_hears_of_nothing(name: str) -> None:
    scheme = students.scheme(name, AT)
    # At 2 N to a millimetre a plan is 4 m wide, and what is told is finer than a reading.
    scales = [scale for scale in SCALES if scale != {"force_scale": 2e3}]
    for seed, how in enumerate(({}, {"figures": 3}, {"by_lengths": False}, *scales)):
        assert mark(scheme, hands.work(scheme, AT, blunt=0.5e-3, seed=seed, **how)).elsewhere == []


# --- a published student report -------------------------------------------------------------------


def published(**other: float) -> Marking:
    """The report's figures on a sheet, perhaps with some of them otherwise."""
    scheme = students.scheme("engine-twin-05", (POSITION,))
    figures = FIGURES | other
    assert figures.keys() <= scheme.rows.keys()
    return mark(scheme, students.sheet(scheme, lambda row, position, value: figures.get(row.id)))


def test_the_published_report_has_two_mistakes_and_a_remark() -> None:
    """p3 positive in the intake stroke, 0.36 for s in the centres of percussion (once), R05 beside its polygon."""
    marking = published()
    assert lost(marking) == 2
    assert {(cell.id, cell.mistake, cell.where) for cell in marking.first_errors} == {
        ("l.S2K2", "wrong-datum", "s"),
        ("p.3", "sign-reversed", "p.3"),
    }
    assert [cell.id for cell in marking.elsewhere] == ["seg.45.R05"]
    assert marking.flags == ()


def test_its_slip_in_writing_the_scale_is_named() -> None:
    """0.92 stands in one line of it for 20.92."""
    marking = published(**{"mu.R45": 0.92})
    assert lost(marking) == 3
    assert ("mu.R45", "other-scale") in {(cell.id, cell.mistake) for cell in marking.first_errors}


def test_a_reaction_that_its_own_length_does_not_give_is_told() -> None:
    marking = published(**{"seg.45.R05": 66.13})
    assert lost(marking) == 2
    assert [cell.id for cell in marking.elsewhere] == ["R.05"]
