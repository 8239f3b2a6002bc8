"""Two hundred spoilt reports, drawings and sheets go through the whole of `grade`, with feedback: all are listed."""

from __future__ import annotations

import csv
import random
from functools import cache
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import Problem
from reportgen.base.records import replace
from reportgen.case import MachineAnalysis
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.classes import class_marking, class_outputs
from reportgen.document import Document
from reportgen.marking.answer_sheet import answer_book
from reportgen.marking.marking_policy import Policy
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.workbook import write_xlsx
from tests.handin import wml
from tests.handin.drawings import Manner, draw, true_plans
from tests.handin.test_grading import report
from tests.lanes import proof
from tests.spoiling import element, extreme, letter, scaled, spoilt_bytes, spoilt_lines, spoilt_package, value

pytestmark = proof

PARTS, STUDENTS, SEED = 2, 100, 59
TYPESET_EVERY = 20
"""One page of feedback in so many is typeset; the others stop before the typesetter."""
GOOD = "S000"
CHANGES = (element, value, letter, scaled, extreme)
ENDINGS = (".docx", ".docx", ".dxf", ".xlsx")


@cache
def _text() -> str:
    text = Path("assignments/slider-crank-01.yaml").read_text(encoding="utf-8")
    return text.replace("count: 8", "count: 4")


def _sheet(key: Key, id: str) -> bytes:
    """The empty sheet of a student."""
    return write_xlsx(answer_book(replace(key, id=id)))


def _originals(file: Path) -> tuple[dict[str, bytes], Key]:
    """A right report with settings and a comment, and a drawing of all plans; and their key."""
    case = open_case(file)
    assert isinstance(case, MachineAnalysis)
    key = Ask().of(key_of(case))
    top = f'xmlns:w="{wml.W}"'
    parts = {
        "word/settings.xml": f'<w:settings {top}><w:zoom w:percent="100"/></w:settings>',
        "word/comments.xml": f'<w:comments {top}><w:comment w:id="0"><w:p/></w:comment></w:comments>',
    }
    relations = "".join(
        f'<Relationship Id="rIdOf{kind}" Type="{wml.R}/{kind}" Target="{kind}.xml"/>'
        for kind in ("settings", "comments")
    )
    drawing = draw(true_plans(case), Manner(clutter=5), 1)[0]
    return {".docx": report(key, parts=parts, relations=relations), ".dxf": drawing}, key


def _spoilt(data: bytes, ending: str, chance: random.Random) -> bytes:
    """A file damaged as its kind is damaged: in one part, in lines, in bytes, cut off."""
    manner = chance.random()
    if manner < 0.1:
        return data[: chance.randrange(len(data))]
    if manner < 0.25:
        return spoilt_bytes(data, chance)
    return spoilt_lines(data, chance) if ending == ".dxf" else spoilt_package(data, r"\.(xml|rels)$", CHANGES, chance)


@pytest.mark.parametrize("part", range(PARTS))
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_no_spoilt_file_ends_the_marking(part: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chance = random.Random(f"{SEED}/{part}")
    assignments, folder, out = (tmp_path / name for name in ("assignments", "handed", "out"))
    assignments.mkdir()
    folder.mkdir()
    students = [f"S{number:03d}" for number in range(STUDENTS + 1)]
    for id in students:
        (assignments / f"{id}.yaml").write_text(_text(), encoding="utf-8")
    originals, key = _originals(assignments / f"{GOOD}.yaml")
    (folder / f"{GOOD}.docx").write_bytes(originals[".docx"])
    for number, id in enumerate(students[1:]):
        ending = ENDINGS[number % len(ENDINGS)]
        original = _sheet(key, id) if ending == ".xlsx" else originals[ending]
        (folder / f"{id}{ending}").write_bytes(_spoilt(original, ending, chance))
    typeset, pages = api.typeset, 0

    def sparing(tree: Document, *how: object) -> tuple[str, bytes]:
        nonlocal pages
        pages += 1
        return typeset(tree, *how) if pages % TYPESET_EVERY == 1 else ("", b"")  # type: ignore[arg-type]

    monkeypatch.setattr(api, "typeset", sparing)
    rules = Policy(guard=False, least_read=0)
    graded = class_marking.grade([folder], assignments, rules, "en")
    told: list[Problem] = []
    written = set(class_outputs.put(graded, rules, out, "typst", "en", problems=told))
    rows = {row["id"]: row for row in csv.DictReader((out / "grades.csv").read_text("utf-8-sig").splitlines())}
    assert sorted(rows) == students
    assert rows[GOOD]["per cent"] == "100"
    assert out / GOOD / "marked.docx" in written
    # Many are read in spite of the damage, and of each there are marks, a state, or both.
    assert len(graded.markings) > STUDENTS / 4
    assert all(row["mark"] or row["state"] for row in rows.values())
    assert all(problem.location.file for problem in (*graded.problems, *told))
