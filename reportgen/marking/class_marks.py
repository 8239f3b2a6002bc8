"""The marks of a class as rows of `grades.csv` (`grade_rows`), and texts about students and cells for all outputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.case.answer_key import Key, KeyRow
from reportgen.document import plain
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.feedback import amended
from reportgen.marking.marking_data import Marked, Marking, Submission, Unmarked, points_of
from reportgen.marking.marking_policy import Policy
from reportgen.marking.toleranced_key import symbol_text

CellValue = str | float | None

DECIMALS = 3
"""Number of decimals of shares and statistics in a table."""


def grade_rows(
    markings: Sequence[Marking], language: Language, unmarked: Sequence[Unmarked] = (), policy: Policy | None = None
) -> tuple[tuple[CellValue, ...], ...]:
    """Return the head and the rows of `grades.csv`.

    The columns are: student, points, mark, points by part, all first errors, warnings, flags, remarks, the submission,
    its lateness and deduction, and the instructor's corrections. If reports or drawings were read in place of sheets,
    two more columns give the share that was read and the number of open values. A column lists the values that were not
    read; they earn no points until somebody settles them. If feedback could not be written, the last column gives the
    file and the reason.

    The points of `unmarked` students are empty.
    """
    rules = policy or Policy()
    words = load_words(search_path(language))
    names = words["grades"]
    judged = {marking.key.row(cell.id).part for marking in markings for cell in marking.cells}
    parts = [part for part in KeyChapter if part in judged]
    owners = {part.name: part.title for marking in markings for part in marking.key.parts}
    # A class of one kind has the headings of its sheets.
    kinds = {marking.key.kind for marking in markings}
    titles = _words(search_path(language, kinds.pop()))["parts"] if len(kinds) == 1 and not owners else words["parts"]
    head = (
        *(names[name] for name in ("id", "name", "class", "points", "out_of", "percent", "mark")),
        *(str(titles[part]) for part in parts),
        *owners.values(),
        *(
            names[name]
            for name in ("firsts", "warnings", "flags", "elsewhere", "state", "late", "deducted", "corrections")
        ),
    )
    submissions = {marking.key.id: marking.submission for marking in markings}
    submissions |= {one.key.id: one.unsettled for one in unmarked if one.unsettled is not None}
    of_files = any(submission.own_files for submission in submissions.values())
    head += tuple(names[name] for name in ("read", "to_settle")) if of_files else ()
    head += (names["unread"],)
    head += (names["unwritten"],) if (unwritten := any(marking.unwritten for marking in markings)) else ()
    keys = (*(marking.key for marking in markings), *(one.key for one in unmarked))
    people = {key.id: person(key) for key in keys}
    rows: list[tuple[CellValue, ...]] = [head]
    rows += [
        (
            *identity_of(marking.key),
            round(marking.points, 2),
            round(marking.out_of, 2),
            round(100 * marking.share, 1),
            rules.mark(marking.share, marking.days_late),
            *(_points_of(marking, part) for part in parts),
            *(_points_of_owner(marking, owner) for owner in owners),
            "; ".join(_error_text(marking.key, cell, language) for cell in marking.first_errors),
            ", ".join(words["warning_names"][warning] for warning in marking.warnings),
            _flags(marking, words, people),
            ", ".join(_cell_text(marking.key, cell) for cell in marking.elsewhere),
            words["states"]["marked"],
            marking.days_late,
            rules.deducted(marking.share, marking.days_late),
            "; ".join(plain(amended(marking, one, words), language) for one in marking.amendments),
        )
        for marking in markings
    ]
    rows += [
        (
            *identity_of(student.key),
            *(None,) * 4,
            *(None for _ in (*parts, *owners)),
            "",
            words["warning_names"]["unseen"] if student.unsettled is not None and student.unsettled.unseen else "",
            *("",) * 2,
            state(student, words),
            None,
            None,
            "",
        )
        for student in unmarked
    ]
    if of_files:
        ids = [*(marking.key.id for marking in markings), *(one.key.id for one in unmarked)]
        rows[1:] = [(*row, *_read(submissions.get(id))) for row, id in zip(rows[1:], ids, strict=True)]
    unread = [*(open_cells(marking) for marking in markings), *(_open_places(one) for one in unmarked)]
    rows[1:] = [(*row, text) for row, text in zip(rows[1:], unread, strict=True)]
    if unwritten:
        remarks = ["; ".join(marking.unwritten) for marking in markings] + [""] * len(unmarked)
        rows[1:] = [(*row, text) for row, text in zip(rows[1:], remarks, strict=True)]
    return tuple(rows)


def open_cells(marking: Marking) -> str:
    """Return the values of a sheet that were not read, each with the text of its cell: v_B (3): 1.2.3."""
    return "; ".join(open_text(marking, cell) for cell in marking.open)


def open_text(marking: Marking, cell: Marked) -> str:
    """Return a value that was not read, with the reason: v_B (3): “1.2.3” is no number."""
    problem = marking.submission.problem((cell.id, cell.position))
    return f"{cell_text(marking.key, cell.id, cell.position)}: {problem.message}"


def _open_places(student: Unmarked) -> str:
    """Return the same for a submission without a mark yet."""
    if student.unsettled is None:
        return ""
    places = {**student.unsettled.problems, **student.unsettled.unread}
    return "; ".join(f"{cell_text(student.key, *place)}: {problem.message}" for place, problem in places.items())


def _read(submission: Submission | None) -> tuple[CellValue, CellValue]:
    """Return the share of a student's own files that was read (per cent), and the number of values to settle."""
    if submission is None or not submission.own_files:
        return None, None
    return round(100 * submission.share_read, 1), float(len(submission.unread))


def state(student: Unmarked, words: Mapping[str, Any]) -> str:
    """Return the reason why a student has no mark: nothing was submitted, or it could not be marked."""
    states = words["states"]
    if student.unsettled is not None and student.unsettled.is_unrecognised:
        return str(states["unrecognised"])
    if student.unsettled is not None:
        read = round(100 * student.unsettled.share_read)
        return str(states["to_settle"].format(read=read, count=len(student.unsettled.unread)))
    return str(states["refused"].format(reasons="; ".join(student.reasons)) if student.reasons else states["missing"])


def person(key: Key) -> str:
    """Return an assignment's id and its student: K225520103001 Nguyễn Văn An."""
    return " ".join(filter(None, (key.id, key.student.get("name", ""))))


def _error_text(key: Key, cell: Marked, language: Language) -> str:
    """Return a first error with the name of its mistake: v_BA (3): scale forgotten."""
    return f"{_cell_text(key, cell)}: {mistake_name(key, cell, language)}"


def mistake_name(key: Key, cell: Marked, language: Language) -> str:
    """Return the name of the mistake behind a cell, in the words of its kind of work."""
    return str(_words(search_path(language, key.part(cell.id).kind))["mistake_names"][cell.mistake or "none"])


def section_name(key: Key, row: KeyRow, language: Language) -> str:
    """Return the section of a quantity, after the title of its part."""
    section = str(_words(search_path(language, key.part(row.id).kind))["parts"][row.part])
    return ": ".join(filter(None, (key.title_of(key.owner(row.id)), section)))


@lru_cache(maxsize=8)
def _words(places: tuple[Path, ...]) -> Mapping[str, Any]:
    """Return the words of a kind of work, cached for all cells of a class."""
    return load_words(places)


def identity_of(key: Key) -> tuple[str, str, str]:
    """Return id (or else the assignment's id), name and class of a student, as far as they are known."""
    student = key.student
    return (student.get("id", key.id), student.get("name", ""), student.get("class", ""))


def _points_of(marking: Marking, part: KeyChapter) -> float:
    return round(points_of(cell for cell in marking.cells if marking.key.row(cell.id).part is part)[0], 2)


def _points_of_owner(marking: Marking, owner: str) -> float:
    return round(points_of(cell for cell in marking.cells if marking.key.owner(cell.id) == owner)[0], 2)


def _cell_text(key: Key, cell: Marked) -> str:
    return cell_text(key, cell.id, cell.position)


def cell_text(key: Key, id: str, position: int) -> str:
    """Return a quantity and its position in one line: v_BA (3)."""
    symbol = symbol_text(key.row(id), key)
    return f"{symbol} ({key.label(position, id)})" if position else symbol


SHOWN = 4
"""Largest number of places listed for a flag."""


def _flags(marking: Marking, words: Mapping[str, Any], people: Mapping[str, str]) -> str:
    """Return every flag in full: kind, other student, places, chance on an honest sheet, cells that it cost."""
    texts: list[str] = []
    for flag in marking.flags:
        cells = [cell for cell in marking.cells if (cell.id, cell.position) in {*flag.places[:SHOWN]}]
        where = ", ".join(_cell_text(marking.key, cell) for cell in cells) + (", …" if len(flag.places) > SHOWN else "")
        of = f" = {people.get(flag.classmate, flag.classmate)}" if flag.classmate else ""
        chance = f", p < {max(flag.chance, 1e-9):.0e}" if flag.kind.startswith("classmate") else ""
        taken = f", {words['warning_names']['taken']}: {len(flag.taken)}" if flag.taken else ""
        texts.append(f"{words['warning_names'][flag.kind]}{of} ({len(flag.places)}: {where}{chance}{taken})")
    return "; ".join(texts)
