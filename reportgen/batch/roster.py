"""The class: a CSV or XLSX table with a row for each student.

Columns are id, name, class, section, email (or their Vietnamese names, see `columns` of `messages.yaml`), and any
path such as `parameters.H`, `positions.start` or `report.supervisor`, which sets that value for the student.  Other
columns are left alone, and so is a second one for the same thing (a class and a class of the course).  A name may
stand in two columns, one for the family name and one for the given name, and is put together in their order.
Headings may follow a title; rows without anything in them are passed over.
"""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic_core import PydanticCustomError

from reportgen.assignment.faults import Fault
from reportgen.assignment.fields import Text
from reportgen.assignment.messages import as_problem
from reportgen.assignment.source import Scalar
from reportgen.batch.names import folder_name
from reportgen.batch.table import Column, Record, columns, heading_row, records, twice
from reportgen.errors import AssignmentError, Mark
from reportgen.notation.numbers import Language
from reportgen.workbook import Page, read

PERSONAL = ("id", "name", "class", "section", "email")
NAME_PARTS = ("family", "given")
SECTIONS = ("parameters", "positions", "drawing", "indicator", "report")
_DOTTED = re.compile(r"([A-Za-z_]+)((?:\.\w+)+)")


@dataclass(frozen=True, slots=True)
class Student:
    """A row of the roster; `overrides` are values with their cells by path ("parameters.H")."""

    id: str
    name: str
    class_: str
    section: str
    email: str
    overrides: Mapping[str, Scalar]
    mark: Mark

    @property
    def folder(self) -> str:
        """The name of the student's files and folders."""
        return folder_name(self.id)


@dataclass(frozen=True, slots=True)
class Roster:
    """The students in the order of the table; `columns` are the headings of values they override."""

    students: tuple[Student, ...]
    columns: tuple[Column, ...] = ()
    file: str = ""


def read_roster(path: Path, language: Language = "vi") -> Roster:
    """The class of a table file; raises `AssignmentError` with all its faults, in `language`."""
    pages = read(path, language)
    page, start = _page(pages)
    faults: list[Fault] = []
    if start is None:
        first = next((cell.mark for row in page.rows for cell in row if not cell.blank), Mark(str(path)))
        raise AssignmentError([as_problem(Fault("no-id-column", first), language)])
    headings = [_dotted(column, faults) for column in columns(page.rows[start])]
    used = _used(headings)
    faults += twice(used)
    rows: list[Record] = []
    for one in records(page, used, start + 1):
        if isinstance(one, Fault):
            faults.append(one)
        elif one.values or one.refused:
            rows.append(one)
    faults += [fault for row in rows for fault in _unfit(row)]
    faults += _ids(rows)
    if not rows:
        faults.append(Fault("empty-roster", headings[0].mark))
    if faults:
        raise AssignmentError([as_problem(fault, language) for fault in faults])
    overriding = tuple(column for column in used if _DOTTED.fullmatch(column.name))
    return Roster(tuple(map(_student, rows)), overriding, str(path))


def _page(pages: Sequence[Page]) -> tuple[Page, int | None]:
    """The first sheet in view with an id column and the index of its headings; else the first with anything."""
    full = [page for page in pages if any(page.rows) and not page.hidden] or list(pages)
    for page in full:
        start = heading_row(page, "id")
        if start is not None:
            return page, start
    return (full[0] if full else Page("", ())), None


def _used(headings: Sequence[Column]) -> list[Column]:
    """The headings that count: ids and paths, of which there may be one each, and the first of the others."""
    used: list[Column] = []
    taken: set[str] = set()
    for column in headings:
        optional = column.name in (*PERSONAL[1:], *NAME_PARTS)
        if column.name == "id" or _DOTTED.fullmatch(column.name) or (optional and column.name not in taken):
            used.append(column)
            taken.add(column.name)
    return used


def _dotted(column: Column, faults: list[Fault]) -> Column:
    """A column whose heading is a path, its section's name in small letters; a misspelt section is a fault."""
    match = _DOTTED.fullmatch(column.name)
    if match is None:
        return column
    section = match[1].casefold()
    if section not in SECTIONS:
        close = difflib.get_close_matches(section, SECTIONS, n=1, cutoff=0.7)
        if close:
            about = {"key": column.name, "close": f"{close[0]}{match[2]}"}
            faults.append(Fault("unknown-column", column.mark, about))
        return Column(column.index, "", "", column.mark)
    return Column(column.index, f"{section}{match[2]}", column.unit, column.mark)


def _unfit(row: Record) -> Iterable[Fault]:
    """Personal data that no assignment file could hold."""
    for name in (*PERSONAL, *NAME_PARTS):
        if name in row.values:
            try:
                Text().read(row.values[name].text)
            except PydanticCustomError as error:
                context = {key: str(value) for key, value in (error.context or {}).items()}
                yield Fault(context.pop("code"), row.values[name].mark, context)


def _ids(rows: Iterable[Record]) -> Iterable[Fault]:
    """Ids that are missing, or there already but for case and composition."""
    seen: dict[str, Mark] = {}
    for row in rows:
        id = row.values.get("id")
        if id is None:
            if "id" not in row.refused:
                yield Fault("missing-id", row.cells.get("id", row.mark))
            continue
        same = unicodedata.normalize("NFC", id.text.casefold())
        if same in seen:
            place = str(seen[same]).removeprefix(f"{seen[same].file}:")
            yield Fault("duplicate-id", id.mark, {"text": id.text, "place": place})
        seen.setdefault(same, id.mark)


def _student(row: Record) -> Student:
    personal = {name: row.values[name].text if name in row.values else "" for name in PERSONAL}
    parts = (value.text for name, value in row.values.items() if name in NAME_PARTS)
    personal["name"] = personal["name"] or " ".join(parts)
    overrides = {name: value for name, value in row.values.items() if _DOTTED.fullmatch(name)}
    class_ = personal.pop("class")
    return Student(**personal, class_=class_, overrides=overrides, mark=row.mark)
