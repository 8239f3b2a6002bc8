"""Fill marks into a table of a learning platform (`read_gradebook`, `Gradebook.filled`): of Moodle or of Canvas.

The rest of the file stays byte for byte. Moodle's worksheet has headings in the teacher's language, so its columns are
found by position and content. The first column ends in each participant's number. The grade precedes the column of the
maximum grade, which has the same number throughout. Then come the dates of the submission and of the grade, and the
comment for the student. Canvas's gradebook has English headings, a row "Points Possible", and a column `Title (id)` for
each assignment.
"""

from __future__ import annotations

import html
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from reportgen.base.errors import Fault, Location
from reportgen.base.records import Record
from reportgen.base.timestamps import moment
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.base.yaml_source import encoding_of
from reportgen.workbook import read
from reportgen.workbook.table_reading import BOOKS, SEPARATORS

OWN = '<p class="reportgen">'
"""Beginning of the program's own text in a comment; it is replaced when the table is filled in again."""
_OWN = re.compile(rf"{OWN}.*?</p>", re.DOTALL)
DECIMALS = 2
"""Number of decimals of a grade if the table does not show it."""

SUBMITTED, COMMENTS = "last modified (submission)", "feedback comments"
"""Moodle's English headings of the submission date and of the comments."""

_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
_PARTICIPANT = re.compile(r"\D+(\d+)")
_TITLE = re.compile(r"(.+?)\s*\((\d+)\)")


class Participant(Record):
    """A student's identification in a platform's table: ids, and the platform's number, "" if unknown.

    `name` is the full name, "" if it is unknown or several students of the class have it.
    """

    who: str
    ids: frozenset[str]
    number: str
    name: str = ""


class StudentResult(Record):
    """The result of one student: the `mark` as a share of the highest one, and a comment in lines."""

    student: Participant
    mark: float
    comment: Sequence[str] = ()


class _Cell(Record):
    """A cell of the file: its start and end in the text, its content, and whether it is quoted."""

    start: int
    end: int
    text: str
    quoted: bool


class _Row(Record):
    """A student's row: the cell of the grade, the platform's number, and the other texts that identify the student.

    `handed_in` is the submission time as the platform writes it, `comment` the cell that the student reads.
    """

    grade: _Cell
    number: str
    names: frozenset[str]
    handed_in: str = ""
    comment: _Cell | None = None
    full_names: frozenset[tuple[str, ...]] = frozenset()
    """Texts that may be the student's full name, as sorted words."""

    def is_of(self, student: Participant) -> bool:
        """Return True if the row has the number or an id of a student."""
        return bool(student.number and student.number == self.number) or bool(self.names & student.ids)


class _Table(Record):
    """The table's students and the maximum grade, as the table writes it.

    `called` is the word before the number of each student, in lower case.
    """

    rows: tuple[_Row, ...]
    highest: str
    called: str = ""


class Gradebook(Record):
    """A platform's table: its text after the byte order mark `bom`, its encoding, and the cells for its grades."""

    path: Path
    text: str
    bom: bytes
    encoding: str
    separator: str
    table: _Table

    @property
    def has_comments(self) -> bool:
        """True if the table has a column of comments for the students."""
        return any(row.comment for row in self.table.rows)

    def filled(self, results: Sequence[StudentResult]) -> tuple[bytes, list[Fault]]:
        """Return the file with the grades and comments, and a fault for each student without a row."""
        changes: dict[_Cell, str] = {}
        faults: list[Fault] = []
        rows = [self._row_of(result.student) for result in results]
        for result, row in zip(results, rows, strict=True):
            # A name may fit the row of somebody else, who is known by the id.
            if row is None or (rows.count(row) > 1 and not row.is_of(result.student)):
                faults.append(Fault("gradebook-no-row", Location(str(self.path)), {"text": result.student.who}))
                continue
            changes[row.grade] = _grade(result.mark, self.table.highest)
            if row.comment and result.comment:
                changes[row.comment] = _commented(row.comment.text, result.comment)
        return self.bom + _changed(self.text, changes, self.separator).encode(self.encoding), faults

    def handed_in(self, student: Participant) -> str:
        """Return the submission time of a student as the platform writes it, or "" if it is missing."""
        row = self._row_of(student)
        return row.handed_in if row else ""

    def names(self, number: str) -> frozenset[str]:
        """Return the texts that identify the student in the row of a platform's number."""
        return next((row.names for row in self.table.rows if number and row.number == number), frozenset())

    @property
    def hidden_names(self) -> frozenset[str]:
        """The word, in lower case, that the table uses for students whose names are hidden."""
        return frozenset({self.table.called}) - {""}

    def _row_of(self, student: Participant) -> _Row | None:
        """Return the only row of a student: by the platform's number, the id or the e-mail, else by the full name."""
        rows = [row for row in self.table.rows if student.number and row.number == student.number]
        rows = rows or [row for row in self.table.rows if row.is_of(student)]
        name = name_words(student.name)
        rows = rows or [row for row in self.table.rows if name and name in row.full_names]
        return rows[0] if len(rows) == 1 else None


def read_gradebook(path: Path, column: str = "", language: Language | None = None) -> Gradebook:
    """Return a platform's table; `column` selects one of Canvas's assignments by its heading, title or id.

    Raises `AssignmentError` if the file cannot be read or is neither of the two tables.
    """
    if path.suffix.lower() in BOOKS:
        raise as_error([Fault("gradebook-no-csv", Location(str(path)))], language)
    # A file that cannot be read as CSV is rejected here, with the location.
    read(path, language)
    data = path.read_bytes()
    bom, encoding = encoding_of(data)
    text = data.removeprefix(bom).decode(encoding)
    separator = _separator(text)
    rows = [row for row in _rows(text, separator) if any(cell.text.strip() for cell in row)]
    table = _canvas(rows, column, path) if _is_canvas(rows) else _moodle(rows, path)
    if isinstance(table, Fault):
        raise as_error([table], language)
    return Gradebook(path, text, bom, encoding, separator, table)


def _grade(share: float, highest: str) -> str:
    """Return a grade with the decimal mark and the number of decimals of the maximum grade."""
    whole, point, decimals = highest.partition("," if "," in highest else ".")
    value = share * float(f"{whole}.{decimals or 0}")
    text = f"{value:.{len(decimals) if point else DECIMALS}f}"
    return text.replace(".", point or ".")


def _commented(present: str, lines: Sequence[str]) -> str:
    """Return a comment as the platform shows it, one line of HTML, after text that others wrote there before."""
    own = f"{OWN}{'<br>'.join(map(html.escape, lines))}</p>"
    return _OWN.sub("", present).rstrip() + own


def _names(texts: Sequence[str]) -> frozenset[str]:
    return frozenset(text.strip().casefold() for text in texts if text.strip())


def name_words(name: str) -> tuple[str, ...]:
    """Return the words of a full name in a fixed order: platforms put the family name first or last."""
    return tuple(sorted(unicodedata.normalize("NFC", name).casefold().replace(",", " ").split()))


def _full_names(texts: Iterable[str]) -> frozenset[tuple[str, ...]]:
    return frozenset(words for text in texts if (words := name_words(text)))


# --- Moodle -----------------------------------------------------------------------------------------


def _moodle(rows: Sequence[Sequence[_Cell]], path: Path) -> _Table | Fault:
    """Return Moodle's grading worksheet: the grade is the column before that of the maximum grade."""
    head, *body = rows or [()]
    full = [row for row in body if len(row) == len(head)]
    numbers = [match[1] if row and (match := _PARTICIPANT.fullmatch(row[0].text.strip())) else "" for row in full]
    if not full or len(full) < len(body) or not all(numbers) or len(set(numbers)) < len(numbers):
        return Fault("gradebook-unknown", Location(str(path)))
    columns = [[row[k].text.strip() for row in full] for k in range(len(head))]
    # A scale of words has no maximum grade, and Moodle accepts no numbers for it.
    graded = [k for k in range(2, len(head)) if _is_greatest(columns[k], columns[k - 1])]
    if len(graded) != 1:
        return Fault("gradebook-no-column", Location(str(path)))
    (greatest,) = graded
    heads = [" ".join(cell.text.casefold().split()) for cell in head]
    dated = [k for k in range(greatest + 1, len(head)) if _is_dated(columns[k])]
    # A single date may be that of the grade.
    submitted = heads.index(SUBMITTED) if SUBMITTED in heads else dated[0] if len(dated) > 1 else None
    # The comments follow the date of the grade.
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
                _full_names(cell.text for cell in row[1 : greatest - 1]),
            )
            for row, number in zip(full, numbers, strict=True)
        ),
        columns[greatest][0],
        full[0][0].text.strip().rstrip("0123456789").strip().casefold(),
    )


def _is_dated(column: Sequence[str]) -> bool:
    """Return True if a column has only dates, or the dash for a missing one."""
    return all(text in ("-", "–") or moment(text) for text in column)


def _is_greatest(column: Sequence[str], before: Sequence[str]) -> bool:
    """Return True if a column is one number throughout, and the one before it is empty or not greater."""
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
    """Return Canvas's gradebook for one of its assignments, which `wanted` must name if there are several."""
    head = [cell.text for cell in rows[0]]
    location = Location(str(path))
    points = next((row for row in rows[1:] if "Points Possible" in row[0].text), None)
    if points is None or "ID" not in head:
        return Fault("gradebook-unknown", location)
    titles = {k: match for k in range(head.index("Section") + 1, len(head)) if (match := _TITLE.fullmatch(head[k]))}
    open_ones = {
        k: match for k, match in titles.items() if k < len(points) and _NUMBER.fullmatch(points[k].text.strip())
    }
    chosen = [k for k, match in open_ones.items() if not wanted or wanted in (match[0], match[1], match[2])]
    if len(chosen) != 1:
        known = "; ".join(match[0] for match in open_ones.values())
        return Fault("gradebook-which-column", location, {"known": known or "–"})
    (column,) = chosen
    people = [head.index(name) for name in ("SIS User ID", "SIS Login ID") if name in head]
    named = 1 if head[0] == "Student" else 2
    students = [
        row for row in rows[1:] if row is not points and len(row) > column and row[head.index("ID")].text.strip()
    ]
    return _Table(
        tuple(
            _Row(
                row[column],
                row[head.index("ID")].text.strip(),
                _names([row[k].text for k in people]),
                full_names=_full_names([" ".join(cell.text for cell in row[:named])]),
            )
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
    """Yield the cells of each line with their positions; a quoted cell may contain separators and line ends."""
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
    """Return the text with new contents in some cells."""
    parts: list[str] = []
    at = 0
    for cell in sorted(changes, key=lambda cell: cell.start):
        new = changes[cell]
        quoted = cell.quoted or any(sign in new for sign in (separator, '"', "\n"))
        parts += [text[at : cell.start], '"{}"'.format(new.replace('"', '""')) if quoted else new]
        at = cell.end
    return "".join((*parts, text[at:]))
