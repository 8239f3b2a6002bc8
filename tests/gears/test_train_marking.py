"""A class of twelve with drawn trains: task, key, marking, and the usual mistakes by their names."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.classes.class_marking import Graded
from reportgen.gears import train_ids
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.mistakes import Mistake
from tests.marking import students
from tests.marking.designs import STUDENTS, check_named, drawn_class, graded_class, telling_and_texts, with_ranges
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "gears"
DRAWN = {"u: 14.5": "u: {from: 8, to: 14.5, step: 0.1}", "n_in: 1440 rpm": "n_in: [960 rpm, 1440 rpm, 2880 rpm]"}
TEETH = tuple(train_ids.teeth(wheel) for wheel in ("1", "2", "2′", "3"))


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of twelve variants, by ratios and speeds."""
    return drawn_class(tmp_path_factory.mktemp("trains"), with_ranges(FOLDER / "train-double.yaml", DRAWN))


@pytest.fixture(scope="module")
def graded(drawn: Path) -> Graded:
    """Sheets of three figures; the first student takes the ratio without the 1 and goes on from that."""
    return graded_class(drawn, "train-without-one", "train.u1H")


def test_variants_differ(drawn: Path) -> None:
    answers = {open_case(path).train for path in (drawn / "variants").glob("S*.yaml")}  # type: ignore[attr-defined]
    assert len(answers) > STUDENTS / 2


def test_right_sheets_get_all_marks_and_a_slip_costs_few(graded: Graded) -> None:
    assert graded.problems == ()
    full = {marking.key.id for marking in graded.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}
    slipped = next(one for one in graded.markings if one.key.id == "S01")
    assert {cell.id for cell in slipped.first_errors} == {"train.u1H"}
    assert {cell.mistake for cell in slipped.first_errors} == {"train-without-one"}
    assert slipped.out_of - slipped.points == 1


def test_the_task_holds_no_answer(drawn: Path) -> None:
    """None of the numbers asked for that have four figures stands in it; in the key each of them does."""
    file = drawn / "variants" / "S02.yaml"
    telling, texts = telling_and_texts(file)
    assert telling
    assert [text for text in telling if text in texts[0]] == []
    assert [text for text in telling if text not in texts[1]] == []


MISTAKES = [
    ("train-double", "train-without-one", ("train.u1H",)),
    ("train-double", "train-ratio-sign", ("train.u1H",)),
    ("train-double", "train-inverse", ("train.omega.H",)),
    ("train-rings", "train-inverse", ("train.omega.1",)),
    ("train-double", "train-carrier-still", ("train.omega.2",)),
    ("train-single", "train-carrier-added", ("train.omega.2",)),
    ("train-double", "train-tips", ("train.tip",)),
    ("train-double", "train-assembly", TEETH),
    ("train-single", "train-assembly", (TEETH[0], TEETH[1], TEETH[3])),
    ("train-rings", "train-neighbours", TEETH),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


@pytest.mark.parametrize("goes_on", [True, False])
def test_a_ratio_upside_down_has_its_name(goes_on: bool) -> None:
    """Written down, and gone on from or not."""
    scheme = marking_scheme(built.case(FOLDER / "train-double.yaml", "en"))
    right = students.worked_out(scheme)
    turned = 1 / right["train.u1H"]
    slip = Mistake("", "train.u1H", {"train.u1H": lambda *_: turned})
    world = students.worked_out(scheme, slip) if goes_on else {**right, "train.u1H": turned}
    (first,) = mark(scheme, students.written(scheme, world)).first_errors
    assert (first.id, first.mistake) == ("train.u1H", "ratio-inverted")


def test_mistakes_have_words_in_both_languages() -> None:
    for language in ("vi", "en"):
        case = built.case(FOLDER / "train-double.yaml", language)  # type: ignore[arg-type]
        misconceptions = case.misconceptions
        names = {
            name for many in (*misconceptions.changed.values(), *misconceptions.readings.values()) for name, _ in many
        }
        for name in names:
            assert "{symbol}" in case.words["mistakes"][name]
            assert case.words["mistake_names"][name]
