"""The task leads to the self-check: how to do it, what it needs, whatever the files are called."""

from __future__ import annotations

from pathlib import Path

import pymupdf
import pytest

from reportgen import api
from reportgen.base.errors import AssignmentError
from reportgen.cases import open_case
from reportgen.marking.key import Ask, key_of
from reportgen.marking.marking import compare
from reportgen.marking.sheet import answer_book
from reportgen.workbook import write_xlsx
from tests.lanes import matrix
from tests.marking.students import ASSIGNMENTS

FILE = ASSIGNMENTS / "slider-crank-02.yaml"
MACHINES = [path.stem for path in sorted(ASSIGNMENTS.glob("*.yaml"))]
"""Every machine there is: shaper-01 and engine-twin-05 had a page of three lines before the sheet."""


def put_task(name: str, folder: Path) -> dict[str, Path]:
    made = api.task_files(ASSIGNMENTS / f"{name}.yaml", "typst", "en")
    for file, content in made.items():
        (folder / file).write_bytes(content)
    return {file: folder / file for file in made}


@pytest.mark.parametrize("name", matrix(MACHINES, ["shaper-01"]))
def test_the_task_has_the_way_to_the_self_check_and_no_page_that_is_nearly_empty(name: str, tmp_path: Path) -> None:
    made = put_task(name, tmp_path)
    assert made["assignment.yaml"].read_bytes() == (ASSIGNMENTS / f"{name}.yaml").read_bytes()
    with pymupdf.open(made["task.pdf"]) as task:
        assert "reportgen compare assignment.yaml answers.xlsx" in " ".join(
            " ".join(page.get_text() for page in task).split()
        )
        # The last page ends where the answer sheet does.
        for page in list(task)[:-1]:
            # Without the foot: the last line stands below the first quarter of the page.
            words = [word for word in page.get_text("words") if word[3] < 0.93 * page.rect.height]
            assert max(word[3] for word in words) > 0.25 * page.rect.height, page.number
    lines, agrees = compare(open_case(made["assignment.yaml"], "en"), made["answers.xlsx"])
    assert (agrees, len(lines)) == (True, 2)


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
    assert (first.code, first.mark.file) == ("sheet-other-data", str(sheet))
    assert "is 0.2 on the sheet and 0.25 m in the assignment" in first.message
