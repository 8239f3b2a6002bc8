"""A class of twelve with drawn gear pairs: task, key, marking, mistakes by name; wrong files and their faults."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen import catalogue
from reportgen.cases import open_case
from reportgen.classes.class_marking import Graded
from reportgen.formula import refs
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import standing_on
from reportgen.marking.judging import compare, mark
from reportgen.marking.marking_data import Marking, Verdict
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.mistakes import Mistake
from reportgen.marking.student_values import ChangeValue
from tests.lanes import matrix
from tests.marking import students
from tests.marking.designs import STUDENTS, check_named, drawn_class, graded_class, telling_and_texts
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "gears"
PARAMETERS = "parameters: {m: [3 mm, 4 mm, 5 mm], z1: {from: 12, to: 16, step: 1}, z2: {from: 28, to: 40, step: 1}}\n"


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of twelve variants, by modules and numbers of teeth."""
    text = f"kind: gear-pair\nreport: {{language: en}}\n{PARAMETERS}"
    return drawn_class(tmp_path_factory.mktemp("gears"), text)


@pytest.fixture(scope="module")
def graded(drawn: Path) -> Graded:
    """Right sheets; the first student forgets the tip shortening and goes on from that."""
    return graded_class(drawn, "gear-truncation", "gears.h_a.1")


@pytest.mark.proof
def test_right_sheets_get_all_marks_and_a_slip_costs_few(graded: Graded) -> None:
    assert graded.problems == ()
    full = {marking.key.id for marking in graded.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}
    slipped = next(one for one in graded.markings if one.key.id == "S01")
    assert {cell.id for cell in slipped.first_errors} == {"gears.h_a.1"}
    assert {cell.mistake for cell in slipped.first_errors} == {"gear-truncation"}
    assert slipped.out_of - slipped.points == len(slipped.first_errors)


def test_the_task_holds_no_answer(drawn: Path) -> None:
    """None of the numbers asked for that have four figures stands in it; in the key each of them does."""
    file = drawn / "variants" / "S02.yaml"
    telling, texts = telling_and_texts(file)
    assert len(telling) > 30
    assert [text for text in telling if text in texts[0]] == []
    assert [text for text in telling if text not in texts[1]] == []


MISTAKES = [
    ("pair-equal-sliding", "gear-degrees", ("gears.inv",)),
    ("pair-equal-sliding", "gear-degrees", ("gears.inv_a.1",)),
    ("pair-centre-distance", "gear-degrees", ("gears.inv_w",)),
    ("pair-equal-sliding", "gear-shift-sign", ("gears.d_f.1",)),
    ("pair-equal-sliding", "gear-shift-sign", ("gears.s.2",)),
    ("pair-equal-sliding", "gear-base-circle", ("gears.alpha_a.1",)),
    ("pair-equal-sliding", "gear-truncation", ("gears.h_a.1", "gears.h_a.2")),
    ("pair-equal-sliding", "gear-standard-angle", ("gears.epsilon",)),
    ("pair-equal-sliding", "gear-ratio", ("gears.lambda.1", "gears.lambda.2")),
]


OWN = [
    ("pair-equal-sliding", "gear-base-circle", "gears.d_b.1", lambda pair: pair["gears.d.1"]),
    ("pair-centre-distance", "gear-base-circle", "gears.d_b.2", lambda pair: pair["gears.d.2"]),
    ("pair-equal-sliding", "gear-ratio", "gears.u", lambda pair: 1 / pair["gears.u"]),
    ("pair-centre-distance", "gear-ratio", "gears.u", lambda pair: 1 / pair["gears.u"]),
    ("pair-equal-sliding", "gear-standard-angle", "gears.a_w", lambda pair: pair["gears.a"]),
    ("pair-least-shift", "gear-standard-angle", "gears.alpha_w", lambda pair: pair["gears.alpha"]),
    ("pair-equal-sliding", "gear-standard-angle", "gears.d_w.2", lambda pair: pair["gears.d.2"]),
    ("pair-equal-sliding", "gear-truncation", "gears.dy", lambda pair: 0 * pair["gears.dy"]),
]
"""What is written in place of a value, all other values being right or following from it."""


@pytest.mark.parametrize("goes_on", matrix([True, False], [True]))
@pytest.mark.parametrize(("name", "mistake", "id", "taken"), OWN)
def test_a_mistake_is_named_by_its_own_result(
    name: str, mistake: str, id: str, taken: Callable[[Any], np.ndarray], goes_on: bool
) -> None:
    """The reference circle for the base circle, u upside down, a_w = a: written down, and gone on from or not."""
    scheme = marking_scheme(built.case(FOLDER / f"{name}.yaml", "en"))
    right = students.worked_out(scheme)
    wrong = taken(right)
    world = {**right, id: wrong}
    if goes_on:
        world = {**students.worked_out(scheme, Mistake("", id, {id: lambda *_: wrong}))}
    marking = mark(scheme, students.written(scheme, world))
    (first,) = marking.first_errors
    assert (first.id, first.mistake, first.where) == (id, mistake, id)
    assert marking.out_of - marking.points == 1


def test_a_round_value_of_a_mistake_is_no_rounded_one(tmp_path: Path) -> None:
    """a = 200 mm exactly, a_w about 204.7 mm: a_w = a is the mistake, and not a_w in too few figures."""
    file = tmp_path / "pair.yaml"
    file.write_text(
        "kind: gear-pair\nparameters: {m: 5 mm, z1: 19, z2: 61, shifts: {x1: 0.51, x2: 0.51}}\n", encoding="utf-8"
    )
    scheme = marking_scheme(open_case(file, "en"))
    right = students.worked_out(scheme)
    assert float(f"{right['gears.a_w'][0] * 1e3:.2g}") == 200
    (first,) = mark(scheme, students.written(scheme, {**right, "gears.a_w": right["gears.a"]})).first_errors
    assert (first.id, first.mistake) == ("gears.a_w", "gear-standard-angle")
    # So is d_w = d of 70 mm, which comes to 70.02 mm from d_b in three figures.
    scheme = marking_scheme(built.case(FOLDER / "pair-least-shift.yaml", "en"))
    right = students.worked_out(scheme)
    (first,) = mark(scheme, students.written(scheme, {**right, "gears.d_w.1": right["gears.d.1"]})).first_errors
    assert (first.id, first.mistake) == ("gears.d_w.1", "gear-standard-angle")


def test_who_compares_is_told_of_doubts_and_of_columns_that_nobody_asks_for(tmp_path: Path) -> None:
    """Notes of reading disagree with nothing, but a value that was not read has not been compared."""
    sheet = tmp_path / "sheet.csv"
    sheet.write_text("id;value;position 99\ngears.a;135.000;\ngears.d.1;70;3\n", encoding="utf-8")
    lines, agrees = compare(built.case(FOLDER / "pair-least-shift.yaml", "en"), sheet)
    assert agrees
    assert [line.split(" ")[1] for line in lines[:2]] == ["note[cell-no-position]:", "note[cell-thousands]:"]
    assert "135 or 135000" in lines[1]


def test_other_ways_to_a_value_are_as_right() -> None:
    """a_w = a, then y = (a_w − a)/m = 0 and d_w = 2 a_w z/(z₁ + z₂); a wrong ρ_a1, then g_α = ρ_a1 + ρ_a2 − g.

    Each mistake costs one mark, and is told alone.
    """
    scheme = marking_scheme(built.case(FOLDER / "pair-equal-sliding.yaml", "en"))

    def gone_on(**own: float) -> Marking:
        changes: dict[str, ChangeValue] = {
            f"gears.{id}": lambda was, _, f=factor: was * f for id, factor in own.items()
        }
        changes |= {
            "gears.y": lambda _, pair: (pair["gears.a_w"] - pair["gears.a"]) / pair["gears.m"],
            "gears.d_w.1": lambda _, pair: 2 * pair["gears.a_w"] * 13 / (13 + 36),
            "gears.d_w.2": lambda _, pair: 2 * pair["gears.a_w"] * 36 / (13 + 36),
        }
        world = {**students.worked_out(scheme, Mistake("", "", changes))}
        if "rho_a.1" in own:
            path = world["gears.rho_a.1"] + world["gears.rho_a.2"] - world["gears.g"]
            world |= {"gears.g_a": path, "gears.epsilon": path / world["gears.p_b"]}
        return mark(scheme, students.written(scheme, world))

    nominal = float(scheme.ledger["gears.a"].values[0] / scheme.ledger["gears.a_w"].values[0])
    for own, id in (({"a_w": nominal}, "gears.a_w"), ({"rho_a.1": 1.2}, "gears.rho_a.1"), ({"g": 0.9}, "gears.g")):
        marking = gone_on(**own)
        assert [one.id for one in marking.first_errors] == [id]
        assert marking.out_of - marking.points == 1
        follow = {"gears.a_w": {"gears.y", "gears.d_w.1"}, "gears.rho_a.1": {"gears.g_a", "gears.epsilon"}}
        assert follow.get(id, set()) <= {cell.id for cell in marking.cells if cell.verdict is Verdict.follows}


def test_another_way_stands_on_nothing_that_stands_on_its_result() -> None:
    """Else a wrong value would follow from what was worked out from it."""
    for name in ("pair-equal-sliding", "pair-centre-distance", "pair-least-shift"):
        case = built.case(FOLDER / f"{name}.yaml", "en")
        for id, ways in case.misconceptions.alternatives.items():
            for way in ways:
                value = np.atleast_1d(evaluate(way, {ref: case.ledger[ref].values for ref in refs(way)}))
                # What the ledger rounds away below 1e-9 of a module.
                assert value == pytest.approx(case.ledger[id].values, rel=1e-9, abs=1e-9)
                assert not any(id in (ref, *standing_on(case.ledger, ref)) for ref in refs(way))


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


def test_mistakes_have_words_in_both_languages() -> None:
    for language in ("vi", "en"):
        case = built.case(FOLDER / "pair-equal-sliding.yaml", language)
        for name in {name for many in case.misconceptions.changed.values() for name, _ in many}:
            assert "{symbol}" in case.words["mistakes"][name]
            assert case.words["mistake_names"][name]


# --- wrong files ------------------------------------------------------------------------------------

FAULTS = [
    ("m: 4 mm, z1: 13, z2: 36, shifts: {x1: 0.5}", "3:44 missing-key"),
    ("m: 4 mm, z1: 13, z2: 36, shifts: {x1: 0.5, x2: 0.4}, a_w: 100 mm", "3:54 gear-twice"),
    ("m: 4 mm, z1: 13, z2: 36, shifts: {x1: 0.5, x2: 0.4}, by: x_min", "3:64 gear-idle-by"),
    ("m: 4 mm, z1: 13, z2: 36, a_w: 80 mm", "3:43 gear-too-near"),
    ("m: 4 mm, z1: 13, z2: 36, alpha: 25 deg", "3:14 gear-rack"),
    ("m: 4 mm, z1: 5, z2: 5, limits: {epsilon: 1.9}", "3:14 gear-no-shifts"),
    ("m: 4 mm, z1: 13, z2: 36, shifts: {x1: 2, x2: 0}", "3:44 gear-beyond-point"),
    ("m: 4 mm, z1: 8, z2: 90, shifts: {x1: -0.4, x2: 0}", "3:43 gear-beyond-line"),
    ("m: 4 mm, z1: 4, z2: 36", "3:27 out-of-range"),
]
WARNINGS = [
    ("m: 4 mm, z1: 13, z2: 36, shifts: {x1: 0.1, x2: 0}", ["gear-undercut"]),
    ("m: 4 mm, z1: 10, z2: 40, shifts: {x1: 0.8, x2: 0.1}", ["gear-epsilon", "gear-tip"]),
    ("m: 4 mm, z1: 14, z2: 80, shifts: {x1: 0.2, x2: -0.2}, limits: {sliding: 2}", ["gear-sliding"]),
]


def told(text: str, tmp_path: Path, language: str) -> list[tuple[str, str, str]]:
    path = tmp_path / "pair.yaml"
    path.write_text(f"kind: gear-pair\nreport: {{language: {language}}}\nparameters: {{{text}}}\n", encoding="utf-8")
    found = catalogue.examine(path)
    return [(f"{one.location.line}:{one.location.column}", one.code, f"{one.message} {one.hint}") for one in found]


@pytest.mark.parametrize("language", ["vi", "en"])
@pytest.mark.parametrize(("text", "fault"), FAULTS)
def test_a_wrong_file_lists_its_faults(text: str, fault: str, language: str, tmp_path: Path) -> None:
    found = told(text, tmp_path, language)
    assert [code for _, code, _ in found] == [fault.split()[1]]
    assert [one for one in found if "{" in one[2] or "nan" in one[2]] == []


@pytest.mark.parametrize("language", ["vi", "en"])
@pytest.mark.parametrize(("text", "codes"), WARNINGS)
def test_what_is_hardly_meant_is_said(text: str, codes: list[str], language: str, tmp_path: Path) -> None:
    found = told(text, tmp_path, language)
    assert set(codes) <= {code for _, code, _ in found}
    assert [one for one in found if "{" in one[2] or "nan" in one[2]] == []
