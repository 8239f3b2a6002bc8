"""Write the output of a marked class: files for each student, for the instructor and for the learning platform.

`put` writes all files, `put_gradebook` the platform's table.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import groupby, islice
from pathlib import Path

from reportgen import api
from reportgen.api.report_fonts import Engine
from reportgen.base.errors import Fault, Location, Problem
from reportgen.base.files import overwritten, put_files, reported, scratch
from reportgen.base.kinds import title
from reportgen.base.output_formats import file_names
from reportgen.base.pdf_standards import STANDARDS, Standards
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.base.words import as_problem, counted, word
from reportgen.case.answer_key import Key
from reportgen.classes.archives import zipped
from reportgen.classes.class_marking import Graded
from reportgen.classes.fault_isolation import isolated
from reportgen.classes.gradebooks import Gradebook, StudentResult
from reportgen.classes.one_pdf import bind_feedback
from reportgen.classes.own_files import renewable
from reportgen.classes.platforms import Handed
from reportgen.classes.reading_sheets import marked_copies
from reportgen.classes.roster import folder_name
from reportgen.handin import FileReading
from reportgen.handin.reading_book import NAME, reading_book
from reportgen.handin.self_check import summary as summary_of_reading
from reportgen.marking.class_marks import grade_rows, open_cells, person
from reportgen.marking.class_page import class_document
from reportgen.marking.feedback import feedback_book, feedback_document
from reportgen.marking.item_statistics import question_rows
from reportgen.marking.marking_data import Marking
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import key_asked
from reportgen.marking.summary_comment import comment, unmarked_comment
from reportgen.marking.variant_fairness import groups, variant_rows
from reportgen.workbook import write_csv, write_xlsx

CLASS_PAGE = Path("class.pdf")


def files_of(
    graded: Graded,
    policy: Policy,
    engine: Engine,
    language: Language | None,
    out: Path | None = None,
    standards: Standards = STANDARDS,
    problems: list[Problem] | None = None,
) -> Iterator[tuple[Path, bytes]]:
    """Yield every file of a graded class with its content: three for each student, and those of the instructor.

    For a student's own files there are also marked copies, and a sheet prefilled with the values that were read, unless
    one was completed below `out`. A file that cannot be written for a student is left out, added to `problems` and
    reported in the student's row of grades.csv. Files for a learning platform are also put into `feedback.zip`, under
    the names by which it knows its students. A PDF by typst conforms to the `standards`.
    """
    returned: dict[str, bytes] = {}
    markings: list[Marking] = []
    problems = [] if problems is None else problems
    copied = marked_copies(_own_files(graded), policy, language)
    for marking in graded.markings:
        key = marking.key
        files, missing = _feedback(marking, policy, engine, standards, language)
        copies, refused = _copies(
            islice(copied, len(graded.own[key.id].files) if key.id in graded.own else 0), language
        )
        missing += refused
        problems += missing
        said = (f"{Path(problem.location.file).name}: {problem.message}" for problem in missing)
        markings.append(replace(marking, unwritten=tuple(said)))
        folder = _folder(key)
        yield from ((folder / name, content) for name, content in {**copies, **files}.items())
        if owner := graded.owners.get(key.id):
            given_back = {name: files[name] for name in ("feedback.xlsx", "feedback.pdf") if name in files} | copies
            returned |= {f"{owner.prefix}{name}": content for name, content in given_back.items()}
    for student in graded.unsettled:
        text = _text(unmarked_comment(student))
        yield _folder(student.key) / "feedback.txt", text
        if owner := graded.owners.get(student.key.id):
            returned[f"{owner.prefix}feedback.txt"] = text
    yield from _readings(graded, policy, out, language)
    if returned:
        yield Path("feedback.zip"), zipped(returned)
    read = [*(marking.key for marking in markings), *(one.key for one in graded.unsettled)]
    if read:
        key = read[0]
        spoken = language or key.language
        yield Path("grades.csv"), write_csv(grade_rows(markings, spoken, graded.unmarked, policy))
        if markings:
            yield Path("questions.csv"), write_csv(question_rows(markings, spoken))
        if markings and (compared := groups(markings, policy, spoken)):
            yield Path("by-variant.csv"), write_csv(variant_rows(compared, spoken))
        named = title(key.kind, spoken)
        overview = class_document(markings, named, spoken, graded.unmarked, policy)
        yield CLASS_PAGE, api.typeset(overview, engine, None, standards)[1]


def _folder(key: Key) -> Path:
    """Return the folder of a student as the batch names it, or else the assignment's stem."""
    return Path(folder_name(key.student["id"]) if "id" in key.student else key.id)


def _own_files(graded: Graded) -> Iterator[tuple[Handed, FileReading, Marking]]:
    """Yield the own files of the marked students, in their order."""
    for marking in graded.markings:
        if (work := graded.own.get(marking.key.id)) is not None:
            yield from ((file, reading, marking) for file, reading in work.files)


def _copies(
    copied: Iterable[tuple[Handed, tuple[str, bytes] | list[Problem]]], language: Language | None
) -> tuple[dict[str, bytes], list[Problem]]:
    """Return the marked copies of one student's files by name, and the files that could not be annotated."""
    files: dict[str, bytes] = {}
    problems: list[Problem] = []
    numbers: Counter[str] = Counter()
    for _, copy in copied:
        if isinstance(copy, list):
            problems += (_unwritten(problem, language) for problem in copy)
            continue
        name, content = copy
        numbers[name] += 1
        files[name.format(number=numbers[name])] = content
    return files, problems


def _unwritten(problem: Problem, language: Language | None) -> Problem:
    """Return the warning that a file is marked but no copy is returned, with the reason."""
    fault = Fault("own-not-written", problem.location, {"text": problem.message})
    return replace(as_problem(fault, language, "warning"), hint=problem.hint)


def _readings(
    graded: Graded, policy: Policy, out: Path | None, language: Language | None
) -> Iterator[tuple[Path, bytes]]:
    """Yield prefilled sheets with the values read from own files; one that somebody has changed is kept."""
    read = [(marking.key, marking.submission) for marking in graded.markings]
    read += [(one.key, one.unsettled) for one in graded.unmarked if one.unsettled is not None]
    for key, submission in read:
        target = _folder(key) / NAME
        if (
            submission.own_files
            and not submission.fingerprint
            and (out is None or renewable(graded.kept, out / target))
        ):
            yield target, reading_book(key_asked(policy, key, submission)[0], submission)


def _feedback(
    marking: Marking, policy: Policy, engine: Engine, standards: Standards, language: Language | None
) -> tuple[dict[str, bytes], list[Problem]]:
    """Return the files of one student (sheet, page and text to paste), and problems for those that are missing."""
    key = marking.key

    def page() -> bytes:
        return api.typeset(feedback_document(marking, title(key.kind, key.language), policy), engine, None, standards)[
            1
        ]

    makers: Mapping[str, Callable[[], bytes]] = {
        "feedback.xlsx": lambda: write_xlsx(feedback_book(marking, policy.show_answers)),
        "feedback.pdf": page,
        "feedback.txt": lambda: _text(comment(marking, policy)),
    }
    files: dict[str, bytes] = {}
    problems: list[Problem] = []
    for name, make in makers.items():
        made = isolated(make, _folder(key) / name, language)
        if isinstance(made, list):
            problems += made
        else:
            files[name] = made
    return files, problems


def _text(lines: Iterable[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()


def put(
    graded: Graded,
    policy: Policy,
    out: Path,
    engine: Engine,
    language: Language | None,
    standards: Standards = STANDARDS,
    problems: list[Problem] | None = None,
) -> Iterator[Path]:
    """Write every file of a graded class below `out`, those of a folder together, the class page last.

    A file that could not be written for a single student is added to `problems`. Raises `OutputError`, and
    `TypesetterError` if the class page cannot be typeset.
    """
    with reported(out), scratch(out):
        made = files_of(graded, policy, engine, language, out, standards=standards, problems=problems)
        # The marks are written even if the typesetter fails.
        for (folder, _), files in groupby(made, key=lambda file: (file[0].parent, file[0] == CLASS_PAGE)):
            yield from put_files(out / folder, {path.name: content for path, content in files})


def put_one_pdf(graded: Graded, out: Path) -> Iterator[Path]:
    """Write one PDF of all feedback pages below `out`; raise `OutputError` or `TypesetterError`."""
    yield from bind_feedback(out, [(str(_folder(one.key)), person(one.key)) for one in graded.markings])


def filled_gradebook(path: Path, out: Path) -> Path:
    """Return the path of the filled-in platform table; the downloaded file is never overwritten."""
    taken = re.fullmatch(file_names("class"), path.name) or any(overwritten([out / path.name], [path]))
    return out / (f"filled-{path.name}" if taken else path.name)


def put_gradebook(
    graded: Graded, gradebook: Gradebook, policy: Policy, out: Path, language: Language | None
) -> tuple[Path, list[Problem]]:
    """Write a platform's table with marks and comments below `out`, under its own name.

    Return its path and problems: students without a row, and a note if there is no column for comments. Raises
    `OutputError`.
    """
    results = [
        StudentResult(
            graded.known[marking.key.id],
            policy.mark(marking.share, marking.days_late) / policy.scale.highest,
            tuple(comment(marking, policy)),
        )
        for marking in graded.markings
    ]
    content, faults = gradebook.filled(results)
    (written,) = put_files(out, {filled_gradebook(gradebook.path, out).name: content})
    problems = [as_problem(fault, language) for fault in faults]
    if not gradebook.has_comments:
        fault = Fault("gradebook-no-comments", Location(str(gradebook.path)))
        problems.append(as_problem(fault, language, "note"))
    return written, problems


def student_lines(graded: Graded, language: Language | None) -> Mapping[Path, str]:
    """Return the line of each student whose work was read, by the student's folder below the results."""
    lines: dict[Path, str] = {}
    for marking in graded.markings:
        points, out_of = f"{marking.points:g}", f"{marking.out_of:g}"
        who, firsts = person(marking.key), len(marking.first_errors)
        line = word("graded", language, id=who, points=points, out_of=out_of, firsts=firsts)
        line += summary_of_reading(marking.submission, language) + _open(marking, language)
        lines[_folder(marking.key)] = line
    for student in graded.unsettled:
        assert student.unsettled is not None
        state = "graded_unrecognised" if student.unsettled.is_unrecognised else "graded_unsettled"
        line = word(state, language, id=person(student.key)) + summary_of_reading(student.unsettled, language)
        lines[_folder(student.key)] = line
    return lines


def without_marks(graded: Graded, language: Language | None) -> Iterator[str]:
    """Yield the numbers of missing and rejected submissions."""
    if graded.missing:
        yield counted("graded_missing", language, len(graded.missing))
    if graded.refused:
        yield counted("graded_refused", language, len(graded.refused))


def _open(marking: Marking, language: Language | None) -> str:
    """Return the values of a sheet that were not read; those of own files are counted as values to settle."""
    if not marking.submission.problems or not marking.open:
        return ""
    return word("graded_open", language, cells=open_cells(marking))
