"""Structure exercises: faults at their places, what a sheet asks for, results of the examples, marks and mistakes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from reportgen import api, load, solve
from reportgen.base.template_folders import languages
from reportgen.classes.variants import make_variants
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask
from reportgen.results.result_files import result_rows
from reportgen.structure import structure_ids as names
from reportgen.structure.structure_solution import formula_of
from tests.marking import students
from tests.marking.designs import check_named
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "structure"
FILES = sorted(FOLDER.glob("*.yaml"))
HEAD = "kind: structure\nreport: {language: en}\nparameters:\n"
FOUR_BAR = "pairs: [[0, 1], [1, 2], [2, 3], [3, 0]]"
CAM = "pairs: [[0, 1], [2, 3], [3, 0]]"
FAULTS = [
    (("pairs: [[0, 1], [1, 2], [2, 3], [3, 3]]",), "4:35 repeated"),
    (("pairs: [[0, 1], [1, 2], [2, 4], [4, 0]]",), "4:10 structure-no-pair"),
    (("pairs: [[3, 1], [1, 2], [2, 3]]",), "4:10 structure-no-pair"),
    ((FOUR_BAR, "driver: 2"), "5:11 structure-driver"),
    ((FOUR_BAR, "passive: [5]"), "5:13 structure-passive"),
    ((FOUR_BAR, "passive: [1]"), "5:13 structure-passive"),
    ((FOUR_BAR, "rollers: [2]"), "5:13 structure-roller"),
    ((CAM, "higher: [[1, 2]]"), "4:10 structure-loose"),
    ((FOUR_BAR.replace("]]", "], [2, 4], [4, 0]]"),), "4:10 structure-overdetermined"),
    ((FOUR_BAR.replace("[3, 0]", "[3, 4], [4, 0]"),), "4:10 structure-loose"),
    ((FOUR_BAR.replace("]]", "], [3, 4], [4, 5], [5, 3]]"),), "4:10 structure-rigid"),
]


def checked(tmp_path: Path, *lines: str) -> list[Any]:
    file = tmp_path / "mechanism.yaml"
    file.write_text(HEAD + "".join(f"  {line}\n" for line in lines), encoding="utf-8")
    return api.check(file, "en")


@pytest.mark.parametrize(("lines", "fault"), FAULTS, ids=[f"{k} {fault}" for k, (_, fault) in enumerate(FAULTS)])
def test_faults_are_at_their_places(tmp_path: Path, lines: tuple[str, ...], fault: str) -> None:
    faults = checked(tmp_path, *lines)
    assert [f"{one.location.line}:{one.location.column} {one.code}" for one in faults] == [fault]


def test_rollers_and_passive_links_are_left_out(tmp_path: Path) -> None:
    """The roller of a cam, and the third crank of a parallelogram."""
    assert not checked(tmp_path, CAM, "higher: [[1, 2]]", "rollers: [2]")
    third = FOUR_BAR.replace("]]", "], [2, 4], [4, 0]]")
    assert not checked(tmp_path, third, "passive: [4]")
    case: Any = built.case(tmp_path / "mechanism.yaml", "en")
    assert case.chain.mobility == 1
    assert case.ledger[names.LINKS].at(1) == 3


RESULTS = {
    "class-two": (1, 2, "I(0, 1) → II(2, 3) → II(4, 5)", {3: 2, 5: 3}),
    "class-three": (1, 3, "I(0, 1) → III(2, 3, 4, 5)", {4: 2, 5: 2}),
    "class-four": (1, 4, "I(0, 1) → IV(2, 3, 4, 5)", {}),
    "eleven-links": (1, 3, "I(0, 1) → III(2, 3, 4, 5) → III(6, 7, 8, 9) → II(10, 11)", {}),
    "cam-roller": (1, 2, "I(0, 1) → II(3, 6) → II(4, 5)", {}),
    "geared-bars": (1, 2, "I(0, 1) → II(2, 7) → II(3, 4) → II(5, 6)", {}),
}


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_examples_have_their_groups_and_classes(file: Path) -> None:
    mobility, grade, formula, others = RESULTS[file.stem]
    position = solve(load(file))["positions"][0]
    assert (position["structure"]["mobility"], position["structure"]["class"]) == (mobility, grade)
    case: Any = built.case(file, "en")
    assert formula_of(case.splitting) == formula
    assert {int(link): by["class"] for link, by in position.get("drivers", {}).items()} == others


def test_what_the_sheet_asks_for() -> None:
    """The counts, of each link its group and the class of it, the class of the mechanism; nothing is given away."""
    scheme = marking_scheme(built.case(FOLDER / "cam-roller.yaml", "en"))
    counts = {names.LINKS, names.LOWER, names.HIGHER, names.MOBILITY, names.GROUPS, names.MECHANISM_CLASS}
    equivalent = {names.EQUIVALENT_LINKS, names.EQUIVALENT_PAIRS, names.EQUIVALENT_MOBILITY}
    of_links = {family(link) for link in (3, 4, 5, 6) for family in (names.group, names.group_class)}
    assert {row.id for row in Ask().of(scheme.key).asked} == counts | equivalent | of_links


MISTAKES = [
    ("class-two", "structure-frame", (names.LINKS,)),
    ("class-two", "structure-driver-as-group", (names.GROUPS,)),
    ("geared-bars", "structure-multiple", (names.LOWER,)),
    ("geared-bars", "structure-higher-left-out", (names.MOBILITY,)),
    ("cam-roller", "structure-roller-kept", (names.LINKS, names.LOWER)),
    ("eleven-links", "structure-lowest-class", (names.MECHANISM_CLASS,)),
    ("class-four", "structure-order-for-class", tuple(names.group_class(link) for link in (2, 3, 4, 5))),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_right_sheets_get_all_marks_and_mistakes_have_words(file: Path) -> None:
    scheme = marking_scheme(built.case(file, "en"))
    marked = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert marked.points == marked.out_of
    for language in languages():
        case = built.case(file, language)
        for mistake in {name for many in case.misconceptions.changed.values() for name, _ in many}:
            assert "{symbol}" in case.words["mistakes"][mistake]
            assert case.words["mistake_names"][mistake]


@pytest.mark.parametrize("language", languages())
def test_reports_and_tasks_are_complete_documents(language: str) -> None:
    """Every example becomes a numbered report and a task in each language, with the formula of structure in both."""
    for file in FILES:
        case: Any = built.case(file, language)
        assert formula_of(case.splitting) in str(case.document())
        assert case.plates()["structure"]


SPEC = """kind: structure
salt: spring
report: {language: en}
parameters:
  pairs: [[0, 1], [1, 2], [2, 3], [3, 0], [[1, 2, 3], 4], [4, 5], [5, [0, 1, 2, 3]]]
  driver: [1, 3]
"""


def test_a_class_has_twelve_mechanisms_and_all_marks(tmp_path: Path) -> None:
    """The links that a dyad joins are drawn, never one link twice, which would make one body with the dyad."""
    (tmp_path / "spec.yaml").write_text(SPEC, encoding="utf-8")
    rows = "".join(f"S{number:02d},Student {number}\n" for number in range(1, 13))
    (tmp_path / "roster.csv").write_text(f"id,name\n{rows}", encoding="utf-8")
    files = make_variants(tmp_path / "spec.yaml", tmp_path / "roster.csv", tmp_path / "out").files
    cases: list[Any] = [built.case(file.path, "en") for file in files]
    assert len({(case.given.pairs, case.given.driver) for case in cases}) == 12
    assert all(case.given.pairs[4][0] != case.given.pairs[6][1] for case in cases)
    for case in cases:
        scheme = marking_scheme(case)
        marked = mark(scheme, students.written(scheme, students.worked_out(scheme)))
        assert marked.points == marked.out_of


def test_results_are_a_table_too() -> None:
    """A row with the links of each group as a text and with the formula of structure for each other driver."""
    heads, row = result_rows(solve(load(FOLDER / "class-three.yaml")))
    values = dict(zip(heads, row, strict=True))
    assert (values["groups.2.links"], values["groups.2.class"], values["groups.2.order"]) == ("2, 3, 4, 5", 3, 3)
    assert values["drivers.4.formula"] == "I(0, 4) → II(3, 5) → II(1, 2)"
