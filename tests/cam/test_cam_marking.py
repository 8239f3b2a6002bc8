"""A class of twelve with drawn cams: task, key, marking, and the usual mistakes by their names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen.base.errors import AssignmentError
from reportgen.base.records import replace
from reportgen.base.template_folders import languages
from reportgen.cases import open_case
from reportgen.classes.class_marking import Graded
from reportgen.classes.variants import make_variants
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import follow
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import key_of
from tests.marking import students
from tests.marking.designs import STUDENTS, check_named, drawn_class, graded_class, telling_and_texts, with_ranges
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "cam"
DRAWN = {
    "h: 40 mm": "h: {from: 30 mm, to: 45 mm, step: 1 mm}",
    "laws: {rise: cosine, return: 3-4-5}": "laws: {rise: [cosine, sine, 3-4-5], return: [3-4-5, parabolic, 4-5-6-7]}",
    "rise: 30 deg, return: 70 deg": "rise: [28 deg, 30 deg, 32 deg], return: [60 deg, 65 deg, 70 deg]",
}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of twelve variants, by laws, strokes and limits."""
    return drawn_class(tmp_path_factory.mktemp("cams"), with_ranges(FOLDER / "roller-01.yaml", DRAWN))


@pytest.fixture(scope="module")
def graded(drawn: Path) -> Graded:
    """Sheets of three figures; the first student takes the phase in degrees for s′ and goes on from that."""
    return graded_class(drawn, "cam-degrees", "cam.ds")


def test_variants_differ(drawn: Path) -> None:
    answers = {key_of(open_case(path)).row("cam.least.r0").values[0] for path in (drawn / "variants").glob("S*.yaml")}
    assert len(answers) > STUDENTS / 2


@pytest.mark.parametrize(
    ("roller", "limits", "told"),
    [
        ("roller: 35 mm", "rise: 85 deg, return: 85 deg", "undercut"),
        ("roller: 5 mm", "rise: 6 deg, return: 70 deg", "pressure"),
    ],
)
def test_no_variant_is_undercut_or_beyond_its_limit(tmp_path: Path, roller: str, limits: str, told: str) -> None:
    text = (FOLDER / "roller-01.yaml").read_text(encoding="utf-8")
    for old, new in {
        "h: 40 mm": "h: [38 mm, 40 mm]",
        "rise: 120 deg, far": "rise: 50 deg, far",
        "near: 120 deg": "near: 190 deg",
        "r0: find": "r0: 40 mm",
        "e: find": "e: 5 mm",
        "roller: find": roller,
        "rise: 30 deg, return: 70 deg": limits,
    }.items():
        text = text.replace(old, new)
    (tmp_path / "spec.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "roster.csv").write_text("id,name,class\nS1,Student,K1\n", encoding="utf-8")
    with pytest.raises(AssignmentError) as refused:
        make_variants(tmp_path / "spec.yaml", tmp_path / "roster.csv", tmp_path / "variants", False, "en")
    assert told in str(refused.value)


def test_right_sheets_get_all_marks_and_a_slip_costs_few(graded: Graded) -> None:
    assert graded.problems == ()
    full = {marking.key.id for marking in graded.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}
    slipped = next(one for one in graded.markings if one.key.id == "S01")
    assert {cell.id for cell in slipped.first_errors} == {"cam.ds"}
    assert {cell.mistake for cell in slipped.first_errors} == {"cam-degrees"}
    assert slipped.out_of - slipped.points == len(slipped.first_errors)


def test_the_task_holds_no_answer(drawn: Path) -> None:
    """None of the numbers asked for that have four figures stands in it; in the key each of them does."""
    file = drawn / "variants" / "S02.yaml"
    telling, texts = telling_and_texts(file)
    assert telling
    assert [text for text in telling if text in texts[0]] == []
    assert [text for text in telling if text not in texts[1]] == []


MISTAKES = [
    ("roller-01", "cam-degrees", ("cam.ds",)),
    ("roller-01", "cam-exchanged", ("cam.s", "cam.ds", "cam.dds")),
    ("roller-01", "cam-phase-sum", ("cam.start.return",)),
    ("roller-01", "cam-offset-side", ("cam.alpha",)),
    ("roller-01", "cam-offset-side", ("cam.pitch.x",)),
    ("roller-01", "cam-limits-exchanged", ("cam.c.1",)),
    ("roller-01", "cam-roller-outward", ("cam.profile.x", "cam.profile.y")),
    ("roller-01", "cam-roller-outward", ("cam.rho.working",)),
    ("shaper-feed", "cam-degrees", ("cam.dpsi",)),
    ("shaper-feed", "cam-wrong-sense", ("cam.k",)),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


def test_the_wrong_sign_is_far_off() -> None:
    """The feed cam's ψ′ with the other sign: the pressure angle is more than 38° off where the arm is fastest."""
    case = built.case(FOLDER / "shaper-feed.yaml", "en")
    wrong = dict(case.misconceptions.changed)["cam.k"][0][1]
    values = case.ledger.evaluate({"cam.k": lambda _, before: np.atleast_1d(evaluate(wrong, before))})
    right = case.ledger["cam.alpha"].values
    off = np.degrees(np.abs(values["cam.alpha"] - right))
    assert off.max() > 38


def test_mistakes_have_words_in_both_languages() -> None:
    for language in languages():
        case = built.case(FOLDER / "roller-01.yaml", language)
        misconceptions = case.misconceptions
        names = {
            name for many in (*misconceptions.changed.values(), *misconceptions.readings.values()) for name, _ in many
        }
        for name in names:
            assert "{symbol}" in case.words["mistakes"][name]
            assert case.words["mistake_names"][name]


@pytest.mark.parametrize(
    ("name", "stroke", "taken"), [("flat-01", 20, 24), ("knife-01", 30, 27), ("roller-01", 40, 48)]
)
@pytest.mark.parametrize("anew", [True, False], ids=["lengths found anew", "lengths as given"])
def test_a_misread_stroke_costs_one_value(tmp_path: Path, name: str, stroke: int, taken: int, anew: bool) -> None:
    """What is read off the diagrams follows from the stroke, and so do the lengths found by it."""
    text = (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
    assert f"h: {stroke} mm" in text
    file = tmp_path / f"{name}.yaml"
    file.write_text(text.replace(f"h: {stroke} mm", f"h: {taken} mm"), encoding="utf-8")
    scheme, other = marking_scheme(built.case(FOLDER / f"{name}.yaml", "en")), open_case(file, "en").ledger
    kept = () if anew else ("cam.r0", "cam.e", "cam.roller")
    read = {id: one.values for id, one in other.families.items() if one.definition is None and id not in kept}
    values = follow(scheme.ledger, {id: lambda _, __, own=own: own for id, own in read.items() if id in scheme.ledger})
    world = {id: np.broadcast_to(values[id], one.values.shape) for id, one in scheme.ledger.families.items()}
    sheet = students.written(scheme, world)
    marking = mark(scheme, sheet)
    assert [(cell.mistake, cell.where) for cell in marking.first_errors] == [("wrong-datum", "cam.h")]
    assert marking.points == marking.out_of - 1
    assert marking.warnings == ()
    # What is wrong beside it is still lost.
    place = ("cam.least.r0", 0)
    wrong = replace(sheet.values[place], value=1.3 * sheet.values[place].value)
    assert mark(scheme, replace(sheet, values={**sheet.values, place: wrong})).points == marking.points - 1
