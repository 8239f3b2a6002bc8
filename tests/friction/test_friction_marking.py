"""Tasks with friction as a student and for a class: key, marks, and the usual mistakes by their names."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.classes import class_marking
from reportgen.classes.variants import make_variants
from reportgen.marking.judging import mark
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask
from tests.lanes import proof
from tests.marking import demo, students
from tests.marking.designs import named, telling_and_texts
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "friction"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))
DRAWN = {
    "incline": {
        "Q: 1200 N": "Q: {from: 900 N, to: 2000 N, step: 50 N}",
        "f: 0.18": "f: {from: 0.1, to: 0.6, step: 0.02}",
    },
    "wedge": {"alpha: 10 deg": "alpha: {from: 4 deg, to: 22 deg, step: 1 deg}"},
    "screw-jack": {
        "p: 7 mm": "p: [5 mm, 6 mm, 7 mm, 8 mm, 10 mm]",
        "Q: 20 kN": "Q: {from: 10 kN, to: 40 kN, step: 1 kN}",
    },
    "belt": {"theta: 210 deg": "theta: {from: 150 deg, to: 270 deg, step: 5 deg}"},
    "band-brake": {"M: 120 N m": "M: {from: 80 N m, to: 200 N m, step: 10 N m}"},
    "shoe-brake": {"c: 60 mm": "c: {from: 20 mm, to: 120 mm, step: 5 mm}"},
}
STUDENTS = 5

MISTAKES = [
    ("incline", "coefficient-for-angle", ("phi",)),
    ("incline", "friction-sense", ("P",)),
    ("incline", "friction-sense", ("lowering.P",)),
    ("incline", "friction-force-along", ("P",)),
    ("incline", "friction-normal-without-force", ("N",)),
    ("incline", "friction-weight-for-normal", ("F",)),
    ("wedge", "friction-sense", ("P",)),
    ("wedge", "friction-sense", ("lowering.P",)),
    ("screw-jack", "friction-starts", ("lead",)),
    ("screw-jack", "friction-starts", ("gamma",)),
    ("screw-jack", "friction-profile", ("phi",)),
    ("screw-jack", "diameter-for-radius", ("Mt",)),
    ("screw-jack", "diameter-for-radius", ("Mc",)),
    ("screw-jack", "friction-sense", ("lowering.Mt",)),
    ("belt", "degrees-for-radians", ("k",)),
    ("belt", "friction-tensions-exchanged", ("S1",)),
    ("band-brake", "friction-tensions-exchanged", ("S1", "S2")),
    ("band-brake", "friction-senses-exchanged", ("backward.P",)),
    ("shoe-brake", "friction-senses-exchanged", ("P",)),
    ("shoe-brake", "friction-multiplied", ("N",)),
    ("shoe-brake", "diameter-for-radius", ("F",)),
]


def of_task(name: str, *ends: str) -> tuple[str, ...]:
    """The ids of quantities of a sample."""
    return tuple(f"friction.{name.partition('-')[0]}.{end}" for end in ends)


@pytest.mark.parametrize(("name", "mistake", "ends"), MISTAKES, ids=lambda value: str(value))
def test_the_usual_mistakes_have_names(name: str, mistake: str, ends: tuple[str, ...]) -> None:
    """Whoever makes one and goes on rightly has that error alone, by its name."""
    where = of_task(name, *ends)
    scheme = marking_scheme(built.case(FOLDER / f"{name}.yaml", "en"))
    sheet = students.written(scheme, students.worked_out(scheme, named(scheme, mistake, *where)))
    first = mark(scheme, sheet).first_errors
    assert {cell.mistake for cell in first} == {mistake}
    assert {cell.id for cell in first} <= set(where)


def test_what_the_sheet_asks_for() -> None:
    """All that is worked out; no scale of a drawing, which everybody chooses."""
    for name in NAMES:
        scheme = marking_scheme(built.case(FOLDER / f"{name}.yaml", "en"))
        worked = {id for id, family in scheme.ledger.families.items() if family.definition is not None}
        assert {row.id for row in Ask().of(scheme.key).asked} == worked


@proof
@pytest.mark.parametrize("name", NAMES)
def test_a_class_from_variants_to_marks(name: str, tmp_path: Path) -> None:
    """Whoever has everything right has all points, on paper of three figures; variants differ."""
    text = (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
    for old, new in DRAWN[name].items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    (tmp_path / "spec.yaml").write_text(text, encoding="utf-8")
    rows = "".join(f"S{number:02d},Student {number}\n" for number in range(1, STUDENTS + 1))
    (tmp_path / "roster.csv").write_text(f"id,name\n{rows}", encoding="utf-8")
    made = make_variants(tmp_path / "spec.yaml", tmp_path / "roster.csv", tmp_path / "variants", False, "en")
    assert len(made.files) == STUDENTS
    (tmp_path / "sheets").mkdir()
    for path in sorted((tmp_path / "variants").glob("S*.yaml")):
        scheme = marking_scheme(open_case(path))
        filled = demo.workbook(scheme.key, students.written(scheme, students.worked_out(scheme)))
        (tmp_path / "sheets" / f"{path.stem}.xlsx").write_bytes(filled)
    graded = class_marking.grade([tmp_path / "sheets"], tmp_path / "variants", Policy())
    assert graded.problems == ()
    assert [marking.points for marking in graded.markings] == [marking.out_of for marking in graded.markings]


@proof
@pytest.mark.parametrize("name", NAMES)
def test_the_task_holds_no_answer(name: str) -> None:
    telling, texts = telling_and_texts(FOLDER / f"{name}.yaml")
    assert telling
    assert [text for text in telling if text in texts[0]] == []
    assert [text for text in telling if text not in texts[1]] == []
