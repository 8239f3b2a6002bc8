"""What a sheet asks for can be chosen; the key holds everything, and a fuller sheet is read all the same."""

from __future__ import annotations

from pathlib import Path

import pytest
from openpyxl import load_workbook

from reportgen import api
from reportgen.base.errors import AssignmentError
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.case.answer_key import Key
from reportgen.cases import open_case, opened
from reportgen.document import PageBreak, text_of
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.answer_sheet import answer_book, read_submission
from reportgen.marking.marking_data import Verdict
from reportgen.marking.marking_policy import Policy, Scale, read_policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.task_paper import answer_tables, task_of
from reportgen.marking.toleranced_key import EVERYTHING, Ask, key_of
from reportgen.workbook import write_csv, write_xlsx
from tests.lanes import matrix, proof
from tests.marking import students
from tests.marking.keys import csv_rows, small_key
from tests.marking.test_wording import FILES, TELLING, key


def ids(patterns: tuple[str, ...], found: Key) -> set[str]:
    return {row.id for row in Ask(patterns).of(found).asked}


def test_the_last_pattern_that_fits_decides() -> None:
    found = small_key()
    assert ids(("*",), found) == {"mu.l", "omega.1", "v.B", "dir.v.B", "M.eq"}
    assert ids(("*", "-velocity"), found) == {"mu.l", "M.eq"}
    assert ids(("*", "-velocity", "v.*"), found) == {"mu.l", "v.B", "M.eq"}
    assert ids(("velocity", "-dir.*"), found) == {"omega.1", "v.B"}
    # A choice that begins by leaving out takes from the default, which asks for no scales.
    assert ids(("-torque",), found) == {"omega.1", "v.B", "dir.v.B"}


@pytest.mark.parametrize("name", matrix(FILES, TELLING))
def test_what_is_asked_by_default_is_a_sheet_that_a_student_can_fill_in(name: str) -> None:
    """Some 20 to 80 cells for one position where there were up to 224; every section with a result keeps some.

    Nothing is left out of the key.  Without masses the section of dimensions has drawn lengths only.
    """
    full = key(name, "en")
    asked = Ask().of(full)
    cells = sum(len(row.positions) for row in asked.asked)
    assert 15 <= cells <= 90
    assert cells < 0.55 * sum(len(row.positions) for row in full.asked)
    assert [row.id for row in asked.rows] == [row.id for row in full.rows]
    assert {row.part for row in full.asked} - {row.part for row in asked.asked} <= {
        KeyChapter.formulas,
        KeyChapter.geometry,
    }


def test_paper_and_file_ask_for_the_same(tmp_path: Path) -> None:
    asked = Ask().of(key("engine-twin-05", "en"))
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(write_xlsx(answer_book(asked)))
    page = load_workbook(path).worksheets[0]
    unlocked = sum(not cell.protection.locked for row in page.iter_rows() for cell in row)
    assert unlocked == sum(len(row.positions) for row in asked.asked)
    rows = [row for table in answer_tables(asked) for row in table.rows if len(row) > 1]
    assert len(rows) == len(asked.asked)


def test_each_section_can_be_printed_by_itself(tmp_path: Path) -> None:
    case = open_case("assignments/slider-crank-01.yaml", "en")
    asked = Ask().of(key_of(case))
    sections = len({row.part for row in asked.asked})
    plain, parted = (task_of(case, asked, by_section) for by_section in (False, True))
    breaks = [sum(isinstance(block, PageBreak) for block in tree.blocks) for tree in (plain, parted)]
    assert breaks[1] - breaks[0] == sections
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(write_xlsx(answer_book(asked, by_section=True)))
    page = load_workbook(path).worksheets[0]
    after = [page.cell(one.id + 1, 2).value for one in page.row_breaks.brk]
    titles = (
        "Velocities",
        "Accelerations",
        "Loads and inertia forces",
        "Reactions in the joints",
        "Balance of the driving",
    )
    # The data and the first section begin the sheet.
    assert after[0] == "Dimensions and drawn lengths"
    assert all(str(one).startswith(title) for one, title in zip(after[1:], titles, strict=True))
    # Fitting to the width would leave the breaks out.
    assert not page.sheet_properties.pageSetUpPr.fitToPage


# --- the policy -------------------------------------------------------------------------------------


def test_a_policy_says_what_is_asked_and_how_marks_are_told(tmp_path: Path) -> None:
    file = tmp_path / "policy.yaml"
    file.write_text('ask: ["*", -cycle]\nby_section: true\nmark: {highest: 4, step: 0.5}\n', encoding="utf-8")
    policy = read_policy(file)
    assert policy.ask == Ask(("*", "-cycle"), True)
    assert policy.scale == Scale(4, 0.5)
    file.write_text("ask: []\nmark: {step: 0}\n", encoding="utf-8")
    with pytest.raises(AssignmentError) as found:
        read_policy(file, "en")
    assert [str(problem.location).rpartition("policy.yaml")[2] for problem in found.value.problems] == [":1:6", ":2:14"]


@pytest.mark.parametrize(
    ("share", "scale", "mark"),
    [
        (0.85, Scale(), 8.5),
        (0.8449, Scale(), 8.4),
        (0.845, Scale(), 8.5),
        (0.5, Scale(4, 0.5), 2),
        (1, Scale(10, 0.25), 10),
    ],
)
def test_half_a_step_is_rounded_up(share: float, scale: Scale, mark: float) -> None:
    assert scale.mark(share) == mark


# --- a fuller sheet under a smaller choice ----------------------------------------------------------


@proof
def test_what_is_not_asked_for_but_filled_in_is_judged_and_earns_nothing(tmp_path: Path) -> None:
    from reportgen.classes import class_marking

    assignment = tmp_path / "a" / "slider-crank-01.yaml"
    assignment.parent.mkdir()
    assignment.write_bytes(Path("assignments/slider-crank-01.yaml").read_bytes())
    scheme = marking_scheme(open_case(assignment))
    work = students.written(scheme, students.worked_out(scheme, None, None))
    path = tmp_path / "slider-crank-01.xlsx"
    path.write_bytes(write_xlsx(students.filled_book(scheme.key, work)))
    wide, small = (
        class_marking.grade([path], assignment.parent, Policy(ask=ask)).markings[0] for ask in (Ask(EVERYTHING), Ask())
    )
    assert len(wide.cells) == len(small.cells)
    assert {cell.verdict for cell in small.cells} == {Verdict.right}
    wanted = {row.id for row in Ask().of(scheme.key).asked}
    assert small.out_of == small.points == sum(cell.id in wanted for cell in small.cells)
    # An empty sheet of the default choice has no cell for the rest.
    path.write_bytes(write_xlsx(answer_book(Ask().of(scheme.key))))
    empty = class_marking.grade([path], assignment.parent, Policy()).markings[0]
    assert {cell.id for cell in empty.cells} == wanted
    assert empty.out_of == small.out_of


def test_a_sheet_made_before_rows_had_words_is_read(tmp_path: Path) -> None:
    """Its columns are found by their heads: without the words of the rows the values stand one column earlier."""
    scheme = marking_scheme(opened(students.assignment("four-bar-01", (2,))))
    rows = csv_rows(scheme.key)
    head = next(row for row in rows if "Tên đại lượng" in row)
    at, last = head.index("Tên đại lượng"), len(head) - 1
    for number, row in enumerate(rows):
        if len(row) == len(head) and row is not head and row[0]:
            row[last] = number
    old = [row[:at] + row[at + 1 :] if len(row) > at + 1 else row for row in rows]
    for name, content in (("new.csv", rows), ("old.csv", old)):
        (tmp_path / name).write_bytes(write_csv(content))
    found = [read_submission(tmp_path / name, scheme.key).values for name in ("new.csv", "old.csv")]
    assert len(found[0]) > 10
    assert {place: one.value for place, one in found[0].items()} == {
        place: one.value for place, one in found[1].items()
    }


def test_the_batch_makes_tasks_anew_when_another_choice_is_ordered() -> None:
    from reportgen.classes import batch_manifest
    from reportgen.classes.worker_pool import Job, Outcome, making
    from tests.classes.little import little

    job = Job("7", "7", "task", little, "7.yaml", b"", making("typst", None))
    other = replace(job, making=making("typst", None, str(Ask(("velocity",)))))
    assert batch_manifest.made_of(job) != batch_manifest.made_of(other)
    assert batch_manifest.entry_of(other, Outcome({"a": b""})).made_of == batch_manifest.made_of(other)


@pytest.mark.parametrize(("language", "enter"), [("en", "enter them"), ("vi", "hãy ghi vào phiếu")])
def test_a_task_speaks_of_scales_only_where_they_are_asked_for(language: Language, enter: str) -> None:
    case = open_case("assignments/slider-crank-01.yaml", language)
    full = key_of(case)
    assert enter in text_of(task_of(case, full))
    assert enter not in text_of(task_of(case, Ask().of(full)))


def test_a_pattern_that_fits_nothing_is_a_located_fault(tmp_path: Path) -> None:
    """Neither a section nor an id of any of the machines; a section that one of them lacks is no fault."""
    policy = tmp_path / "policy.yaml"
    policy.write_text('ask:\n  - "*"\n  - "-cycle"\n  - "-sge.*"\n  - formula\n', encoding="utf-8")
    ask = read_policy(policy, "en").ask
    with pytest.raises(AssignmentError) as error:
        ask.check([key("four-bar-01", "en"), key("engine-twin-05", "en")], "en")
    found = [
        (problem.code, problem.location.line, problem.location.column, problem.hint) for problem in error.value.problems
    ]
    assert found[0][:3] == ("ask-fits-nothing", 4, 5)
    assert found[1] == ("ask-fits-nothing", 5, 5, "did you mean “formulas”?")
    assert "-sge.*" in str(error.value.problems[0])
    # What fits one machine of several is right, and so is all that nobody's file says.
    policy.write_text('ask: ["*", "-f.x.*", "-p.3"]\n', encoding="utf-8")
    read_policy(policy, "en").ask.check([key("four-bar-01", "en"), key("engine-twin-05", "en")], "en")
    Ask().check([small_key()], "en")


def test_every_command_tells_what_fits_nothing(tmp_path: Path) -> None:
    policy = tmp_path / "policy.yaml"
    policy.write_text('ask: ["*", "-segs.*"]\n', encoding="utf-8")
    ask = read_policy(policy, "vi").ask
    with pytest.raises(AssignmentError, match="segs"):
        api.check_ask(ask, [Path("assignments/four-bar-01.yaml")], "vi")
    api.check_ask(ask, [tmp_path / "missing.yaml"], "vi")
    api.check_ask(None, [Path("assignments/four-bar-01.yaml")], "vi")
