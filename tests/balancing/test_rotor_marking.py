"""A class of twelve with drawn rotors: task, key, marking, and the usual mistakes by their names."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.balancing import rotor_ids
from reportgen.balancing.rotor_calculation import BEFORE
from reportgen.base.template_folders import languages
from reportgen.cases import open_case
from reportgen.classes.class_marking import Graded
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask
from tests.lanes import proof
from tests.marking import students
from tests.marking.designs import STUDENTS, check_named, drawn_class, graded_class, telling_and_texts, with_ranges
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "rotor"
DRAWN = {
    "angle: 75 deg": "angle: {from: 60 deg, to: 100 deg, step: 5 deg}",
    "m: 3 kg": "m: {from: 2.5 kg, to: 3.5 kg, step: 0.1 kg}",
    "n: 1500 rpm": "n: [960 rpm, 1500 rpm, 2900 rpm]",
}
A, B = rotor_ids.unbalance("A"), rotor_ids.unbalance("B")
DIR_A, DIR_B = rotor_ids.direction("A"), rotor_ids.direction("B")


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of twelve variants, by an angle, a mass and the speed."""
    return drawn_class(tmp_path_factory.mktemp("rotors"), with_ranges(FOLDER / "rotor-two-planes.yaml", DRAWN))


@pytest.fixture(scope="module")
def graded(drawn: Path) -> Graded:
    """Sheets of three figures; the first student puts a correction on the wrong side and goes on from that."""
    return graded_class(drawn, "rotor-wrong-side", DIR_B)


def test_variants_differ(drawn: Path) -> None:
    answers = {open_case(path).ledger[A].at(1) for path in (drawn / "variants").glob("S*.yaml")}
    assert len(answers) > STUDENTS / 2


@proof
def test_right_sheets_get_all_marks_and_a_slip_costs_few(graded: Graded) -> None:
    assert graded.problems == ()
    full = {marking.key.id for marking in graded.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}
    slipped = next(one for one in graded.markings if one.key.id == "S01")
    assert {(cell.id, cell.mistake) for cell in slipped.first_errors} == {(DIR_B, "rotor-wrong-side")}
    assert slipped.out_of - slipped.points == 1


@proof
def test_the_task_holds_no_answer(drawn: Path) -> None:
    """None of the numbers asked for that have four figures stands in it; in the key each of them does."""
    telling, texts = telling_and_texts(drawn / "variants" / "S02.yaml")
    assert telling
    assert [text for text in telling if text in texts[0]] == []
    assert [text for text in telling if text not in texts[1]] == []


def test_what_the_sheet_asks_for() -> None:
    """Products, corrections with angles and masses, bearing forces, the grade; no components, no lengths on paper."""
    scheme = marking_scheme(built.case(FOLDER / "rotor-two-planes.yaml", "en"))
    masses = [family(str(k)) for family in (rotor_ids.unbalance, rotor_ids.moment) for k in (1, 2, 3, 4)]
    corrections = [
        family(plane) for family in (rotor_ids.unbalance, rotor_ids.direction, rotor_ids.mass) for plane in "AB"
    ]
    bearings = [family(BEFORE, place) for family in (rotor_ids.at_bearing, rotor_ids.bearing_force) for place in "CD"]
    grade = [rotor_ids.permitted("e"), rotor_ids.permitted("U"), rotor_ids.tolerance("A"), rotor_ids.tolerance("B")]
    wanted = {*masses, *corrections, *bearings, *grade, "rotor.omega"}
    assert {row.id for row in Ask().of(scheme.key).asked} == wanted


MISTAKES = [
    ("rotor-two-planes", "rotor-planes-exchanged", (A, B, DIR_A, DIR_B)),
    ("rotor-two-planes", "rotor-planes-exchanged", (A, B)),
    ("rotor-two-planes", "rotor-plane-z", (rotor_ids.moment("2"),)),
    ("rotor-two-planes", "rotor-plane-z", (B,)),
    ("rotor-two-planes", "rotor-static-only", (A, DIR_A)),
    ("rotor-two-planes", "rotor-static-only", (B,)),
    ("rotor-two-planes", "rotor-wrong-side", (DIR_A,)),
    ("rotor-two-planes", "rotor-wrong-side", (DIR_B,)),
    ("rotor-one-plane", "rotor-wrong-side", (DIR_A,)),
    (
        "rotor-two-planes",
        "rotor-speed-once",
        (rotor_ids.bearing_force(BEFORE, "C"), rotor_ids.bearing_force(BEFORE, "D")),
    ),
    ("rotor-two-planes", "degrees-for-radians", (B, DIR_B)),
    ("rotor-one-plane", "degrees-for-radians", (A, DIR_A)),
    ("disc", "degrees-for-radians", (A, DIR_A)),
    ("rotor-two-planes", "degrees-for-radians", (rotor_ids.at_bearing(BEFORE, "C"), rotor_ids.at_bearing(BEFORE, "D"))),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


def test_values_by_components_and_off_a_plan_are_right_alike() -> None:
    """Drawn by hand: a side off by half a millimetre, an angle by a degree."""
    scheme = marking_scheme(built.case(FOLDER / "rotor-two-planes.yaml", "en"))
    world = dict(students.worked_out(scheme))
    μ = scheme.ledger["rotor.mu.U"].values[0]
    world[A] = world[A] + 0.4e-3 * μ
    world[rotor_ids.mass("A")] = world[A] / 0.08
    world[DIR_A] = world[DIR_A] + 0.5 * 3.14159 / 180
    marked = mark(scheme, students.written(scheme, world))
    assert marked.points == marked.out_of


@pytest.mark.parametrize("name", ["rotor-two-planes", "rotor-one-plane", "disc"])
def test_mistakes_have_words_in_every_language(name: str) -> None:
    for language in languages():
        case = built.case(FOLDER / f"{name}.yaml", language)
        names = {name for many in case.misconceptions.changed.values() for name, _ in many}
        assert names
        for mistake in names:
            assert "{symbol}" in case.words["mistakes"][mistake]
            assert case.words["mistake_names"][mistake]
