"""What the server computes in other processes: sheets, checks, marks, files. Each call is a function of a folder.

The process of the pages loads none of this, so that saving a cell never waits for a calculation.
"""

from __future__ import annotations

import io
import tempfile
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from reportgen import api
from reportgen.assignment.student_copy import handed_out
from reportgen.base import units
from reportgen.base.errors import AssignmentError, Problem, ReportgenError
from reportgen.base.files import contents, put_file
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words, speak
from reportgen.case.answer_key import Key, KeyRow
from reportgen.cases import open_case
from reportgen.classes import class_marking, class_outputs, reading_sheets
from reportgen.classes.batch_run import Order, run_batch
from reportgen.classes.corrections import read_corrections
from reportgen.classes.gradebooks import read_gradebook
from reportgen.classes.one_pdf import bind_products
from reportgen.classes.platforms import Handed
from reportgen.classes.reading_sheets import read_own, read_sheets
from reportgen.classes.variants import make_variants
from reportgen.classes.worker_pool import each_within
from reportgen.document import plain
from reportgen.handin import file_kinds, submission
from reportgen.handin.drawing_file import wanted_plans
from reportgen.marking.answer_sheet import (
    answer_book,
    asked_positions,
    given_entry,
    grid,
    info_page,
    named_pages,
    open_cells,
    page,
    read_submission,
    sheet_rows,
)
from reportgen.marking.judging import comparison_of
from reportgen.marking.marking_data import Marking, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.summary_comment import comment
from reportgen.marking.toleranced_key import symbol_text, words_of
from reportgen.server.class_folder import ClassFolder
from reportgen.server.moving_machine import moving_machine
from reportgen.workbook import Book, Entry, read, write_xlsx

SHEETS = frozenset({".xlsx", ".xlsm", ".csv"})
"""Suffixes of answer sheets."""
TypedTexts = Mapping[tuple[str, int], str]
"""Texts as typed, by id and position."""


class Opened(Record):
    """A student's assignment, prepared for sheets and checks."""

    scheme: MarkingScheme
    key: Key
    """The requested cells, with the scales of the plans, as on paper."""
    policy: Policy


_opened: OrderedDict[tuple[str, str], Opened] = OrderedDict()
_keys: OrderedDict[tuple[str, str], tuple[Key, Policy]] = OrderedDict()
KEPT, KEPT_KEYS = 40, 1000
"""Numbers of prepared assignments, and of keys alone, that a process keeps."""
FEW = 20
"""Number of sheets that are made with their variants; of a larger class the server makes them while it runs."""


def opened(folder: ClassFolder, student: str) -> Opened:
    """Return a student's assignment; raise `AssignmentError` if it cannot be computed."""
    name = str(folder.assignment(student)), folder.content(student)
    if name in _opened:
        _opened.move_to_end(name)
        return _opened[name]
    case, policy = open_case(folder.assignment(student)), folder.policy()
    scheme = marking_scheme(case, replace(policy, guard=False))
    _opened[name] = made = Opened(scheme, policy.ask.on_paper(scheme.key), policy)
    _keys[name] = scheme.key, policy
    for kept, most in ((_opened, KEPT), (_keys, KEPT_KEYS)):
        if len(kept) > most:
            kept.popitem(last=False)
    return made


def key_for_reading(folder: ClassFolder, student: str) -> tuple[Key, Policy]:
    """Return the key by which a student's files are read, and the policy."""
    name = str(folder.assignment(student)), folder.content(student)
    if name not in _keys:
        opened(folder, student)
    return _keys[name]


def prepare(folder: ClassFolder, student: str) -> None:
    """Make the sheet of a student if there is none, and keep the key for the first upload."""
    try:
        key_for_reading(folder, student)
        if folder.sheet(student) is None:
            make_sheet(folder, student)
    except ReportgenError:
        # Whoever opens the sheet gets the reason.
        return


# --- sheets -----------------------------------------------------------------------------------------


def make_sheet(folder: ClassFolder, student: str) -> dict[str, Any]:
    """Write the answer sheet of a student for the browser, without any answer, and return it."""
    key = opened(folder, student).key
    sections: list[dict[str, Any]] = []
    for title, part in key.pages:
        titles: Mapping[str, Any] = words_of(part)["parts"]
        cells = open_cells(part)
        for chapter, rows in groupby(sheet_rows(part), lambda row: row.part):
            made = [_row(part, row, cells.get(row.id, frozenset())) for row in rows]
            sections.append({"name": str(chapter), "title": str(titles[chapter]), "part": title, "rows": made})
    asked = sum(cell["open"] for section in sections for row in section["rows"] for cell in row["cells"])
    sheet = {
        "content": folder.content(student),
        "language": key.language,
        "kind": key.kind,
        "asked": asked,
        "positions": [{"position": k, "label": key.label(k)} for k in asked_positions(key)],
        "sections": sections,
    }
    folder.put_sheet(student, sheet)
    return sheet


def _row(key: Key, row: KeyRow, cells: frozenset[int]) -> dict[str, Any]:
    places = [0] if row.single else [k for k in asked_positions(key) if k in cells or row.has(k)]
    made = []
    for k in places:
        given = given_entry(row, k)
        if k in cells or given is not None:
            value = None if given is None else given.value
            text = units.write(value, row.decimals, key.language) if isinstance(value, float) else value
            made.append({"position": k, "label": key.label(k, row.id), "given": text, "open": k in cells})
    what = plain(row.described, key.language)
    return {"id": row.id, "symbol": symbol_text(row, key), "what": what, "unit": row.unit, "cells": made}


def filled_sheet(folder: ClassFolder, student: str, cells: TypedTexts) -> bytes:
    """Return the student's answer sheet as a workbook with the cells as typed."""
    made = opened(folder, student)
    key, ask = made.key, made.policy.ask
    sheet = words_of(key)["answer_sheet"]
    note = " ".join((sheet["note"], *((sheet["self_check"],) if ask.self_check else ())))
    pages = []
    for name, part in named_pages(key, sheet["answers"]):
        places = open_cells(part)

        def filling(row: KeyRow, k: int, places: Mapping[str, frozenset[int]] = places) -> Entry | None:
            if k in places.get(row.id, ()):
                return Entry(cells.get((row.id, k)) or None, "input", unlocked=True)
            return given_entry(row, k)

        rows = grid(part, sheet["title"], note, filling, sheet_rows(part), asked_positions(part))
        pages.append(page(name, rows, ask.by_section))
    if not cells:
        return write_xlsx(answer_book(key, ask.by_section, ask.self_check))
    return write_xlsx(Book((*pages, info_page(key)), f"{sheet['title']} {key.id}"))


# --- checks -----------------------------------------------------------------------------------------

SAID = {Verdict.right: "right", Verdict.follows: "right", Verdict.wrong: "wrong", Verdict.blank: "empty"}
"""What a student is told; everything else is unread."""


def check(folder: ClassFolder, student: str, cells: TypedTexts, asked: Mapping[str, Any]) -> dict[str, Any]:
    """Return the verdicts on one cell, on a section or on the sheet, as `compare` gives them, and its lines."""
    made, file = opened(folder, student), Path("answers.xlsx")
    key, hints = made.scheme.key, made.policy.browser.hints
    pages = read(file, key.language, filled_sheet(folder, student, cells))
    submission = read_submission(file, key, key.language, pages)
    comparison = comparison_of(made.scheme, submission)
    marking = comparison.marking
    wanted = _wanted(key, asked)
    said = []
    for cell in marking.cells:
        place = cell.id, cell.position
        if wanted(place) and cells.get(place):
            problem = marking.submission.problems.get(place)
            hint = comparison.hint(cell) if hints and cell.first else ""
            message = problem.message if problem is not None else hint
            verdict = SAID.get(cell.verdict, "unread")
            said.append({"id": cell.id, "position": cell.position, "verdict": verdict, "message": message})
    lines = list(comparison.lines(hints)) if not asked.get("id") and not asked.get("section") else []
    return {"cells": said, "lines": lines}


def _wanted(key: Key, asked: Mapping[str, Any]) -> Callable[[tuple[str, int]], bool]:
    if asked.get("id"):
        return lambda place: place == (asked["id"], asked.get("position", 0))
    if asked.get("section"):
        return lambda place: str(key.row(place[0]).part) == asked["section"]
    return lambda place: True


# --- uploads ----------------------------------------------------------------------------------------


def begin_reading() -> None:
    """Start what opens uploads within limits, so that the first upload does not wait for it."""
    list(each_within(reading_sheets.LIMITS, len, [()], reading_sheets.__name__))


def read_upload(folder: ClassFolder, student: str, file: Path) -> tuple[str, int, list[str]]:
    """Return the state of an uploaded file, the number of values that were read, and remarks for its student.

    The file is opened in a process within limits, as when it is marked.
    """
    suffix, language = file.suffix.lower(), folder.language
    if suffix in file_kinds.NOT_READ or suffix not in {*file_kinds.OWN, *SHEETS}:
        return "kept", 0, []
    key, policy = key_for_reading(folder, student)
    handed = Handed(file)
    if suffix in file_kinds.OWN:
        case = open_case(folder.assignment(student))
        plans = wanted_plans(case, key, ()) if suffix == file_kinds.DRAWING else None
        (_, reading), *_ = read_own([(handed, policy.ask.of(key), plans)], language)
        if isinstance(reading, list):
            return "refused", 0, [problem.message for problem in reading]
        own = submission([reading], language)
        remarks = [problem.message for problem in (*own.unread.values(), *own.notes)]
        return ("kept" if own.is_unrecognised else "read"), len(own.values), remarks
    (_, sheets), *_ = read_sheets([handed], language)
    if isinstance(sheets, list):
        return "refused", 0, [problem.message for problem in sheets]
    try:
        sheet = read_submission(file, key, language, sheets)
    except AssignmentError as error:
        return "refused", 0, [problem.message for problem in error.problems]
    remarks = [f"{problem.location}: {problem.message}" for problem in (*sheet.problems.values(), *sheet.notes)]
    return "read", len(sheet.values), [line.removeprefix(f"{file}:") for line in remarks]


# --- the class --------------------------------------------------------------------------------------


def draw(folder: ClassFolder, redraw: Sequence[str] = (), drop: Sequence[str] = ()) -> list[str]:
    """Draw the variants as `variants` does, and make the sheets of a few students; return remarks."""
    drawn = make_variants(
        folder.spec, folder.roster, folder.variants, language=folder.language, redraw=redraw, drop=drop
    )
    students = [file.drawn.student.folder for file in drawn.files]
    lacking = [student for student in students if folder.sheet(student) is None]
    if len(lacking) <= FEW:
        for student in lacking:
            make_sheet(folder, student)
    return list(drawn.remarks)


def fix(folder: ClassFolder, student: str, text: str) -> list[str]:
    """Replace a student's assignment file by a valid one; return the problems of an invalid one, which is not kept."""
    target = folder.assignment(student)
    before = contents(target)
    try:
        put_file(target, text.encode())
        make_sheet(folder, student)
    except ReportgenError as error:
        put_file(target, before)
        problems = error.problems if isinstance(error, AssignmentError) else [error]
        return [str(problem).removeprefix(f"{target}:") for problem in problems]
    return []


def make_products(folder: ClassFolder, product: str, out: Path) -> list[str]:
    """Make a product of the class, as `batch` does, and bind it into one PDF; return what went wrong."""
    policy = folder.policy()
    order = Order(
        roster=folder.roster,
        assignments=folder.variants,
        out=out,
        products=(product,),
        language=None,
        ask=policy.ask if folder.policy_file is not None else None,
    )
    stream = io.StringIO()
    result = run_batch(order, stream)
    list(bind_products(out, result.students, (product,)))
    return [str(problem) for failure in result.failures for problem in failure.problems]


def make_file(folder: ClassFolder, student: str, name: str) -> bytes:
    """Return a file of one student: `task.pdf`, `assignment.yaml`, `machine.html`, `report.pdf`; it is made once."""
    content = folder.content(student)
    if (kept := folder.kept_file(student, content, name)).is_file():
        return contents(kept)
    made = _made_file(folder, student, name)
    put_file(kept, made)
    return made


def _made_file(folder: ClassFolder, student: str, name: str) -> bytes:
    path, policy = folder.assignment(student), folder.policy()
    if name == "assignment.yaml":
        return handed_out(path).encode()
    if name == "machine.html":
        return moving_machine(path).encode()
    if name == "report.pdf":
        return api.report_files(path, "typst", None)[name]
    return api.task_files(path, "typst", None, policy.ask)[name]


def grade(folder: ClassFolder) -> dict[str, Any]:
    """Mark the class as `grade` does, into `marked/`; return the marks by student and the problems."""
    language = folder.language
    policy, mistake = folder.valid_policy()
    speak(language)
    if mistake is not None:
        raise mistake
    corrections = read_corrections(folder.corrections, language) if folder.corrections.exists() else ()
    graded = class_marking.grade(
        [folder.handed], folder.variants, policy, None, folder.handed_roster, corrections, out=folder.marked
    )
    problems: list[Problem] = list(graded.problems)
    written: dict[str, list[str]] = {}
    for path in class_outputs.put(graded, policy, folder.marked, "typst", None, problems=problems):
        written.setdefault(path.parent.name, []).append(path.name)
    list(class_outputs.put_one_pdf(graded, folder.marked))
    names = load_words(search_path(language))["warning_names"]
    marks = {marking.key.id: _marked(marking, policy, names) for marking in graded.markings}
    for student, content in marks.items():
        content["files"] = sorted(written.get(student, []))
    for unmarked in graded.unmarked:
        marks[unmarked.key.id] = {"mark": None, "lines": list(unmarked.reasons), "warnings": [], "files": []}
    return {"marks": marks, "problems": [str(problem) for problem in problems]}


def _marked(marking: Marking, policy: Policy, names: Mapping[str, str]) -> dict[str, Any]:
    return {
        "mark": policy.mark(marking.share, marking.days_late),
        "highest": policy.scale.highest,
        "points": round(marking.points, 6),
        "out_of": round(marking.out_of, 6),
        "lines": list(comment(marking, policy)),
        "warnings": [str(names[warning]) for warning in marking.warnings],
        "notices": [
            {"kind": str(names[flag.kind]), "classmate": flag.classmate, "count": len(flag.places)}
            for flag in marking.flags
        ],
        "cells": [
            [cell.id, cell.position, str(cell.verdict), round(cell.points, 9), round(cell.worth, 9)]
            for cell in marking.cells
        ],
        "values": [[id, k, " ".join(answer.text.split())] for (id, k), answer in marking.submission.values.items()],
    }


def key_values(folder: ClassFolder, student: str) -> list[tuple[str, int, str]]:
    """Return the right values of a student's cells, for the instructor."""
    key = opened(folder, student).key
    return [
        (row.id, k, units.write(float(row.printed[row.at(k)]), row.decimals, key.language))
        for row in key.asked
        for k in row.positions
        if row.printed[row.at(k)] == row.printed[row.at(k)]
    ]


def fill_gradebook(folder: ClassFolder, name: str, content: bytes, column: str) -> tuple[bytes, list[str]]:
    """Return the table of a learning platform with the marks of the class, and what could not be filled in.

    Raises `AssignmentError` for another file.
    """
    language, policy = folder.language, folder.policy()
    with tempfile.TemporaryDirectory() as place:
        file = Path(place, name)
        file.write_bytes(content)
        table = read_gradebook(file, column, language)
        corrections = read_corrections(folder.corrections, language) if folder.corrections.exists() else ()
        graded = class_marking.grade(
            [folder.handed],
            folder.variants,
            policy,
            None,
            folder.handed_roster,
            corrections,
            gradebook=table,
            out=folder.marked,
        )
        written, problems = class_outputs.put_gradebook(graded, table, policy, Path(place, "filled"), language)
        return written.read_bytes(), [problem.message for problem in problems]
