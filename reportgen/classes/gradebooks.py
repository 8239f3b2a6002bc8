"""Marks filled into the table that a learning platform gave for it: Moodle's grading worksheet, Canvas's gradebook.

All else in the file stays byte for byte.  Moodle's grading worksheet has its headings in the teacher's language, so its
columns are found by their place and content: the first one ends in each participant's number, and the grade stands
before the column of the greatest grade, which is one number throughout; behind it come the dates of the submission and
of the grade, and then the comment that the student reads.  Canvas's gradebook has English headings, a row
"Points Possible", and a column `Title (id)` for each assignment.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from reportgen.base.errors import Fault, Mark
from reportgen.base.moments import moment
from reportgen.base.source import encoding_of
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.workbook import read
from reportgen.workbook.reading import BOOKS, SEPARATORS

OWN = '<p class="reportgen">'
"""How what the program wrote into a comment begins: it is replaced where the table comes back."""
_OWN = re.compile(rf"{OWN}.*?</p>", re.DOTALL)
DECIMALS = 2
"""Of a grade, where the table does not show how many it has."""

SUBMITTED, COMMENTS = "last modified (submission)", "feedback comments"
"""How Moodle heads the date of the submission and the comments in English."""

_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
_PARTICIPANT = re.compile(r"\D+(\d+)")
_TITLE = re.compile(r"(.+?)\s*\((\d+)\)")


@dataclass(frozen=True, slots=True)
class Participant:
    """A student by what a platform's table may know of him or her: ids, and the platform's number, "" if unknown."""

    who: str
    ids: frozenset[str]
    number: str


@dataclass(frozen=True, slots=True)
class StudentResult:
    """The result of one student: the `mark` as a share of the highest one, and a comment in lines."""

    student: Participant
    mark: float
    comment: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class _Cell:
    """A cell of the file's text: where it begins and ends, what it says, whether in quotation marks."""

    start: int
    end: int
    text: str
    quoted: bool


@dataclass(frozen=True, slots=True)
class _Row:
    """A student of the table: the cell of the grade, the platform's number, what else the row says of the student.

    `handed_in` says when, as the platform writes it, and `comment` is the cell that the student reads.
    """

    grade: _Cell
    number: str
    names: frozenset[str]
    handed_in: str = ""
    comment: _Cell | None = None


@dataclass(frozen=True, slots=True)
class _Table:
    """The table's students and the greatest grade, as the table writes it.

    `called` is the word before the number of each student, in small letters.
    """

    rows: tuple[_Row, ...]
    highest: str
    called: str = ""


@dataclass(frozen=True, slots=True)
class Gradebook:
    """A platform's table: its text between the `mark` of its encoding and the end, and where its grades go."""

    path: Path
    text: str
    mark: bytes
    encoding: str
    separator: str
    table: _Table

    @property
    def has_comments(self) -> bool:
        """Whether it has a column of comments that the students read."""
        return any(row.comment for row in self.table.rows)

    def filled(self, results: Sequence[StudentResult]) -> tuple[bytes, list[Fault]]:
        """The file with the grades and comments, and faults for students that it has no row for."""
        changes: dict[_Cell, str] = {}
        faults: list[Fault] = []
        for result in results:
            row = self._row_of(result.student)
            if row is None:
                faults.append(Fault("gradebook-no-row", Mark(str(self.path)), {"text": result.student.who}))
                continue
            changes[row.grade] = _grade(result.mark, self.table.highest)
            if row.comment and result.comment:
                changes[row.comment] = _commented(row.comment.text, result.comment)
        return self.mark + _changed(self.text, changes, self.separator).encode(self.encoding), faults

    def handed_in(self, student: Participant) -> str:
        """When a student handed in, as the platform writes it; "" where it does not say it."""
        row = self._row_of(student)
        return row.handed_in if row else ""

    def names(self, number: str) -> frozenset[str]:
        """What the row of a platform's number says of its student."""
        return next((row.names for row in self.table.rows if number and row.number == number), frozenset())

    @property
    def hidden_names(self) -> frozenset[str]:
        """What it calls the students of whom it knows a number alone, in small letters."""
        return frozenset({self.table.called}) - {""}

    def _row_of(self, student: Participant) -> _Row | None:
        """The one row that is a student's: by the platform's number if it is known, else by id or e-mail."""
        rows = [row for row in self.table.rows if student.number and row.number == student.number]
        rows = rows or [row for row in self.table.rows if row.names & student.ids]
        return rows[0] if len(rows) == 1 else None


def read_gradebook(path: Path, column: str = "", language: Language | None = None) -> Gradebook:
    """A platform's table; `column` chooses one of Canvas's assignments by its heading, title or id.

    Raises `AssignmentError` if the file cannot be read or is neither of the two tables.
    """
    if path.suffix.lower() in BOOKS:
        raise as_error([Fault("gradebook-no-csv", Mark(str(path)))], language)
    # What cannot be read as CSV is refused here, with its place.
    read(path, language)
    data = path.read_bytes()
    mark, encoding = encoding_of(data)
    text = data.removeprefix(mark).decode(encoding)
    separator = _separator(text)
    rows = [row for row in _rows(text, separator) if any(cell.text.strip() for cell in row)]
    table = _canvas(rows, column, path) if _is_canvas(rows) else _moodle(rows, path)
    if isinstance(table, Fault):
        raise as_error([table], language)
    return Gradebook(path, text, mark, encoding, separator, table)


def _grade(share: float, highest: str) -> str:
    """A grade with the decimal mark and the decimals of the greatest one."""
    whole, point, decimals = highest.partition("," if "," in highest else ".")
    value = share * float(f"{whole}.{decimals or 0}")
    shown = f"{value:.{len(decimals) if point else DECIMALS}f}"
    return shown.replace(".", point or ".")


def _commented(present: str, lines: Sequence[str]) -> str:
    """A comment as a platform shows it, HTML in one line, behind what somebody else wrote there before."""
    own = f"{OWN}{'<br>'.join(map(html.escape, lines))}</p>"
    return _OWN.sub("", present).rstrip() + own


def _names(texts: Sequence[str]) -> frozenset[str]:
    return frozenset(text.strip().casefold() for text in texts if text.strip())


# --- Moodle -----------------------------------------------------------------------------------------


def _moodle(rows: Sequence[Sequence[_Cell]], path: Path) -> _Table | Fault:
    """Moodle's grading worksheet: the grade is the column before that of the greatest grade."""
    head, *body = rows or [()]
    full = [row for row in body if len(row) == len(head)]
    numbers = [match[1] if row and (match := _PARTICIPANT.fullmatch(row[0].text.strip())) else "" for row in full]
    if not full or len(full) < len(body) or not all(numbers) or len(set(numbers)) < len(numbers):
        return Fault("gradebook-unknown", Mark(str(path)))
    columns = [[row[k].text.strip() for row in full] for k in range(len(head))]
    # A scale of words has no greatest grade, and Moodle takes no numbers for it.
    graded = [k for k in range(2, len(head)) if _is_greatest(columns[k], columns[k - 1])]
    if len(graded) != 1:
        return Fault("gradebook-no-column", Mark(str(path)))
    (greatest,) = graded
    heads = [" ".join(cell.text.casefold().split()) for cell in head]
    dated = [k for k in range(greatest + 1, len(head)) if _is_dated(columns[k])]
    # One date alone may be that of the grade.
    submitted = heads.index(SUBMITTED) if SUBMITTED in heads else dated[0] if len(dated) > 1 else None
    # The comments stand behind the date of the grade.
    last = max(dated, default=len(head))
    comments = heads.index(COMMENTS) if COMMENTS in heads else last + 1 if last + 1 < len(head) else None
    return _Table(
        tuple(
            _Row(
                row[greatest - 1],
                number,
                _names([cell.text for cell in row[1 : greatest - 1]]),
                "" if submitted is None else row[submitted].text.strip(),
                None if comments is None else row[comments],
            )
            for row, number in zip(full, numbers, strict=True)
        ),
        columns[greatest][0],
        full[0][0].text.strip().rstrip("0123456789").strip().casefold(),
    )


def _is_dated(column: Sequence[str]) -> bool:
    """Whether a column holds dates, or the stroke that stands for none, and nothing else."""
    return all(text in ("-", "–") or moment(text) for text in column)


def _is_greatest(column: Sequence[str], before: Sequence[str]) -> bool:
    """Whether a column is one number throughout, and the one before it empty or no greater."""
    if len(set(column)) != 1 or not _NUMBER.fullmatch(column[0]):
        return False
    return all(not text or (_NUMBER.fullmatch(text) and _value(text) <= _value(column[0])) for text in before)


def _value(text: str) -> float:
    return float(text.replace(",", "."))


# --- Canvas -----------------------------------------------------------------------------------------


def _is_canvas(rows: Sequence[Sequence[_Cell]]) -> bool:
    head = [cell.text for cell in rows[0]] if rows else []
    return "Section" in head and ("Student" in head[:1] or head[:2] == ["LastName", "FirstName"])


def _canvas(rows: Sequence[Sequence[_Cell]], wanted: str, path: Path) -> _Table | Fault:
    """Canvas's gradebook: one of its assignments, which `wanted` must name if there are several."""
    head = [cell.text for cell in rows[0]]
    mark = Mark(str(path))
    points = next((row for row in rows[1:] if "Points Possible" in row[0].text), None)
    if points is None or "ID" not in head:
        return Fault("gradebook-unknown", mark)
    titles = {k: match for k in range(head.index("Section") + 1, len(head)) if (match := _TITLE.fullmatch(head[k]))}
    open_ones = {
        k: match for k, match in titles.items() if k < len(points) and _NUMBER.fullmatch(points[k].text.strip())
    }
    chosen = [k for k, match in open_ones.items() if not wanted or wanted in (match[0], match[1], match[2])]
    if len(chosen) != 1:
        known = "; ".join(match[0] for match in open_ones.values())
        return Fault("gradebook-which-column", mark, {"known": known or "–"})
    (column,) = chosen
    people = [head.index(name) for name in ("SIS User ID", "SIS Login ID") if name in head]
    students = [
        row for row in rows[1:] if row is not points and len(row) > column and row[head.index("ID")].text.strip()
    ]
    return _Table(
        tuple(
            _Row(row[column], row[head.index("ID")].text.strip(), _names([row[k].text for k in people]))
            for row in students
        ),
        points[column].text.strip(),
    )


# --- the file ---------------------------------------------------------------------------------------


def _separator(text: str) -> str:
    header = next((line for line in text.splitlines() if line.strip()), "")
    outside = re.sub(r'"[^"]*"?', "", header)
    return max(SEPARATORS, key=outside.count)


def _rows(text: str, separator: str) -> Iterator[list[_Cell]]:
    """The cells of each line with their places; a quoted cell may hold separators and line ends."""
    cell = re.compile(rf'"([^"]*+(?:""[^"]*+)*+)"|([^{re.escape(separator)}\r\n]*+)')
    at = 0
    row: list[_Cell] = []
    while at < len(text):
        match = cell.match(text, at)
        assert match is not None, "any text begins with a cell, which may be empty"
        quoted = match[1] is not None
        row.append(_Cell(at, match.end(), match[1].replace('""', '"') if quoted else match[2], quoted))
        at = match.end()
        if text.startswith(separator, at):
            at += 1
            if at == len(text):
                row.append(_Cell(at, at, "", False))
            continue
        yield row
        row = []
        at += 2 if text.startswith("\r\n", at) else 1
    if row:
        yield row


def _changed(text: str, changes: Mapping[_Cell, str], separator: str) -> str:
    """The text with other contents in some cells."""
    parts: list[str] = []
    at = 0
    for cell in sorted(changes, key=lambda cell: cell.start):
        new = changes[cell]
        quoted = cell.quoted or any(sign in new for sign in (separator, '"', "\n"))
        parts += [text[at : cell.start], '"{}"'.format(new.replace('"', '""')) if quoted else new]
        at = cell.end
    return "".join((*parts, text[at:]))
