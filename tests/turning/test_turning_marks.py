"""Turning-moment diagrams: faults at their places, what a sheet asks for, and the usual mistakes by their names."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.template_folders import languages
from reportgen.flywheel import turning_ids as names
from reportgen.marking.class_marks import grade_rows
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask
from tests.marking import students
from tests.marking.designs import check_named
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "turning-moment"
HEAD = "kind: turning-moment\nreport: {language: en}\nparameters:\n  n: 300 rpm\n"
CURVE = "driving: {mean: 500 N m, terms: [{order: 2, sin: 90 N m}]}"
TABLE = "driving: {phi: [0 deg, 60 deg, 120 deg], M: [45, 90, 45], unit: N m}"
FAULTS = [
    (("delta: 0.02",), "3:1 missing-key"),
    ((CURVE,), "3:1 missing-key"),
    ((CURVE, "delta: 0.02", "J: 4 kg m2"), "7:3 both-given"),
    ((CURVE, "m: 20 kg"), "6:3 needs-besides"),
    (("driving: {terms: [{order: 2, sin: 90 N m}]}", "delta: 0.02"), "5:13 needs-besides"),
    ((CURVE.replace("order: 2", "order: 1.3"), "delta: 0.02"), "5:44 turning-order"),
    ((CURVE.replace("}]", "}, {order: 2, cos: 1 N m}]"), "delta: 0.02"), "5:69 repeated"),
    ((CURVE.replace("90", "0"), "delta: 0.02"), "5:3 turning-uniform"),
    ((CURVE, "J: 0.01 kg m2"), "6:6 turning-light"),
    (
        (CURVE, "resisting: {law: speed, mean: 5 N m, terms: [{order: 1, sin: 9 N m}]}", "delta: 0.02"),
        "6:40 both-given",
    ),
    ((TABLE.replace("0 deg, 60", "5 deg, 60"), "delta: 0.02"), "5:19 table-end"),
    ((TABLE.replace("120 deg", "50 deg"), "delta: 0.02"), "5:34 not-increasing"),
    ((TABLE.replace("60 deg, 120", "0 deg, 0"), "delta: 0.02"), "5:33 not-increasing"),
    ((TABLE.replace("[45, 90, 45]", "[-45, 9, -45]"), "delta: 0.02"), "5:3 turning-no-work"),
    ((TABLE.replace("120 deg]", "100 deg]"), f"resisting{CURVE[7:]}", "delta: 0.02"), "6:3 turning-cycles"),
    (("areas: {values: [5, -4], unit: J}", "delta: 0.02"), "5:19 turning-areas-sum"),
    (("areas: {values: [5, -5], unit: J}", "delta: 0.02", "at: 9 deg"), "7:3 both-given"),
    (("areas: {values: [5, -5], torque: 5 N m}", "delta: 0.02"), "5:28 needs-besides"),
]


@pytest.mark.parametrize(("lines", "fault"), FAULTS, ids=[f"{k} {fault}" for k, (_, fault) in enumerate(FAULTS)])
def test_faults_are_at_their_places(tmp_path: Path, lines: tuple[str, ...], fault: str) -> None:
    file = tmp_path / "wheel.yaml"
    file.write_text(HEAD + "".join(f"  {line}\n" for line in lines), encoding="utf-8")
    found = api.check(file, "en")
    assert [f"{one.location.line}:{one.location.column} {one.code}" for one in found] == [fault]


def test_what_the_sheet_asks_for() -> None:
    """Points, areas and energies after the first, and everything about the flywheel; nothing that is given."""
    scheme = marking_scheme(built.case(FOLDER / "curve.yaml", "en"))
    points = [family(k) for family in (names.point, names.energy) for k in (2, 3)]
    single = (names.RANGE, names.WORK, names.SHARE, names.POWER, names.OMEGA, names.J, names.MASS)
    speeds = [family(bound) for family in (names.speed, names.extreme) for bound in ("max", "min")]
    wanted = {*points, *map(names.area, (1, 2, 3)), *single, *speeds, names.TORQUE_AT, names.ACCELERATION}
    assert {row.id for row in Ask().of(scheme.key).asked} == wanted


def test_the_sheet_follows_the_report_and_names_each_quantity() -> None:
    """Energies come before the flywheel that they size, the acceleration last; no row says the same twice."""
    for name in ("curve", "press", "areas"):
        rows = marking_scheme(built.case(FOLDER / f"{name}.yaml", "en")).key.rows
        first = {
            id: next((k for k, row in enumerate(rows) if row.id == id), -1) for id in (names.RANGE, names.speed("max"))
        }
        assert first[names.RANGE] < first[names.speed("max")]
        assert name != "curve" or rows[-1].id == names.ACCELERATION
        for row in rows:
            assert row.what
            assert "clockwise" not in row.positive
            assert not row.id.startswith("turning.E.2") or not row.positive


def test_the_table_of_a_class_has_the_headings_of_its_sheets() -> None:
    scheme = marking_scheme(built.case(FOLDER / "curve.yaml", "en"))
    head, _ = grade_rows([mark(scheme, students.written(scheme, students.worked_out(scheme)))], "en")
    sections = ["Mean torque and points of intersection", "Areas of the diagram", "Energies", "Flywheel"]
    assert list(head[7:11]) == sections


MISTAKES = [
    ("curve", "turning-delta-doubled", (names.J,)),
    ("curve", "turning-speed-once", (names.J,)),
    ("curve", "turning-rpm", (names.J,)),
    ("curve", "turning-radius-once", (names.MASS,)),
    ("curve", "turning-cycle", (names.WORK,)),
    ("curve", "turning-no-mean", (names.area(1), names.area(2), names.area(3))),
    ("areas", "turning-delta-doubled", (names.DELTA,)),
    ("areas", "turning-largest-area", (names.RANGE,)),
    ("areas", "turning-one-extreme", (names.RANGE,)),
    ("areas", "turning-area-for-energy", (names.energy(4),)),
    ("areas", "turning-not-signed", (names.energy(3),)),
    ("areas", "turning-degrees", (names.scale("A"),)),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


@pytest.mark.parametrize("name", ["curve", "areas", "press", "two-curves", "by-speed"])
def test_right_sheets_get_all_marks_and_mistakes_have_words(name: str) -> None:
    scheme = marking_scheme(built.case(FOLDER / f"{name}.yaml", "en"))
    marked = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert marked.points == marked.out_of
    for language in languages():
        case = built.case(FOLDER / f"{name}.yaml", language)
        for mistake in {name for many in case.misconceptions.changed.values() for name, _ in many}:
            assert "{symbol}" in case.words["mistakes"][mistake]
            assert case.words["mistake_names"][mistake]
