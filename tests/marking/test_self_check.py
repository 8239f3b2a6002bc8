"""The task leads to the self-check: how to do it, what it needs, whatever the files are called."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pymupdf
import pytest

from reportgen import api
from reportgen.api import Engine
from reportgen.assignment.student_copy import handed_out
from reportgen.base.errors import AssignmentError
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.marking.answer_sheet import answer_book
from reportgen.marking.judging import compare
from reportgen.marking.marking_policy import read_policy
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.workbook import write_xlsx
from tests.lanes import matrix
from tests.marking.filled import filled
from tests.marking.students import ASSIGNMENTS

FILE = ASSIGNMENTS / "slider-crank-02.yaml"
KINDS = ("", "cam", "gears", "coursework")
NAMES = [str(path.relative_to(ASSIGNMENTS)) for kind in KINDS for path in sorted((ASSIGNMENTS / kind).glob("*.yaml"))]
MACHINES = [name for name in NAMES if "/" not in name]
SHORT_ENDED = [
    *(("latex", "vi", f"{name}.yaml") for name in ("engine-v-02", "slotted-lever-02", "toggle-press-01")),
    *(("latex", "en", f"{name}.yaml") for name in ("cam/knife-01", "coursework/shaper-whole")),
]
"""Tasks of LaTeX of which some page once had two rows or three lines alone."""


@cache
def task_files(name: str, engine: Engine, language: Language) -> dict[str, bytes]:
    return api.task_files(ASSIGNMENTS / name, engine, language)


def put_task(name: str, folder: Path, engine: Engine = "typst", language: Language = "en") -> dict[str, Path]:
    made = task_files(name, engine, language)
    for file, content in made.items():
        (folder / file).write_bytes(content)
    return {file: folder / file for file in made}


@pytest.mark.parametrize(
    ("engine", "language", "name"),
    matrix([*(("typst", "en", name) for name in NAMES), *SHORT_ENDED], [("typst", "en", "shaper-02.yaml")]),
)
def test_the_task_has_the_way_to_the_self_check_and_no_page_that_is_nearly_empty(
    engine: Engine, language: Language, name: str, tmp_path: Path
) -> None:
    """Without its foot: the last line stands below the first quarter of the page, on the last page, too."""
    made = put_task(name, tmp_path, engine, language)
    with pymupdf.open(made["task.pdf"]) as task:
        assert "reportgen compare assignment.yaml answers.xlsx" in " ".join(
            " ".join(page.get_text() for page in task).split()
        )
        for page in task:
            words = [word for word in page.get_text("words") if word[3] < 0.93 * page.rect.height]
            assert max(word[3] for word in words) > 0.25 * page.rect.height, page.number


@pytest.mark.parametrize("name", matrix(MACHINES, ["slider-crank-02.yaml"]))
def test_what_lies_beside_the_task_is_enough_to_check_oneself(name: str, tmp_path: Path) -> None:
    made = put_task(name, tmp_path)
    lines, agrees = compare(open_case(made["assignment.yaml"], "en"), made["answers.xlsx"])
    assert (agrees, len(lines)) == (True, 2)


def test_the_student_gets_data_alone_whatever_the_instructor_wrote_beside_them(tmp_path: Path) -> None:
    """No comment, so neither salt nor notes; no font that another computer may lack; the parts in one file."""
    whole, part = tmp_path / "whole.yaml", ASSIGNMENTS / "coursework" / "feed-cam.yaml"
    (tmp_path / part.name).write_bytes(part.read_bytes())
    text = (ASSIGNMENTS / "coursework" / "shaper.yaml").read_text(encoding="utf-8")
    named = text.replace("report:\n", "report:\n  font: Font of the Office  # bought in 2026\n", 1)
    whole.write_text(f"# from spec.yaml, salt winter\n{named}", encoding="utf-8")
    told = handed_out(whole)
    assert not [word for word in ("winter", "bought", "#", "Font of", "file:") if word in told]
    (tmp_path / "elsewhere").mkdir()
    own = tmp_path / "elsewhere" / "own.yaml"
    own.write_text(told, encoding="utf-8")
    whole.write_text(text, encoding="utf-8")
    theirs, mine = (key_of(open_case(file, "en")) for file in (whole, own))
    assert len(mine.parts) == 2
    for (_, page), (_, other) in zip(theirs.pages, mine.pages, strict=True):
        assert [f"{row.id} {row.values}" for row in page.rows] == [f"{row.id} {row.values}" for row in other.rows]


def test_a_scale_that_may_be_left_empty_is_not_missing(tmp_path: Path) -> None:
    """The force plan of one position is drawn, with its scale; the reactions of the other one are left to do."""
    own, sheet = tmp_path / "two.yaml", tmp_path / "sheet.xlsx"
    text = FILE.read_text(encoding="utf-8")
    own.write_text(text.replace("worked_positions: [2]", "worked_positions: [1, 2]", 1), encoding="utf-8")
    key = Ask().on_paper(key_of(open_case(own, "en")))
    scale = key.row("mu.R23")
    assert scale.positions == (1, 2)
    one_scale = replace(key, rows=tuple(replace(row, positions=(1,)) if row is scale else row for row in key.rows))
    sheet.write_bytes(filled(one_scale))
    lines, agrees = compare(open_case(own, "en"), sheet)
    assert (agrees, len(lines)) == (True, 1), lines


def test_an_instructor_may_keep_the_self_check_back(tmp_path: Path) -> None:
    policy = tmp_path / "policy.yaml"
    policy.write_text("self_check: false\n", encoding="utf-8")
    ask = read_policy(policy).ask
    made = api.task_files(FILE, "typst", "en", ask)
    assert set(made) == {"task.pdf", "answers.xlsx"}
    with pymupdf.open("pdf", made["task.pdf"]) as task:
        assert "compare" not in " ".join(page.get_text() for page in task)
    first, *_ = answer_book(ask.of(key_of(open_case(FILE))), self_check=False).sheets
    assert not [entry.value for row in first.rows for entry in row if "compare" in str(entry.value)]
    assert str(ask) != str(Ask()), "a batch makes its tasks anew"


def test_a_sheet_is_known_by_its_data_whatever_the_files_are_called(tmp_path: Path) -> None:
    own, sheet = tmp_path / "bài của tôi.yaml", tmp_path / "sheet.xlsx"
    own.write_bytes(FILE.read_bytes())
    sheet.write_bytes(write_xlsx(answer_book(Ask().of(key_of(open_case(FILE))))))
    assert compare(open_case(own, "en"), sheet)[1]
    text = own.read_text(encoding="utf-8")
    (length,) = [line for line in text.splitlines() if line.lstrip().startswith("r:")]
    own.write_text(text.replace(length, "  r: 0.25 m", 1), encoding="utf-8")
    with pytest.raises(AssignmentError) as found:
        compare(open_case(own, "en"), sheet)
    first = found.value.problems[0]
    assert (first.code, first.location.file) == ("sheet-other-data", str(sheet))
    assert "is 0.2 on the sheet and 0.25 m in the assignment" in first.message
