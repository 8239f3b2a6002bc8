"""The class: a CSV or XLSX table with a row for each student, and the assignment files that belong to them.

Columns are id, name, class, section, email, handed_in (or their Vietnamese names, see `columns` of `messages.yaml`),
and any path such as `parameters.H`, `positions.start` or `report.supervisor`, which sets that value for the student.
Other columns are ignored, and so is a second one for the same field (a class and a class of the course). A name may be
in two columns, one for the family name and one for the given name, and is joined in their order. Headings may follow a
title; empty rows are skipped. A table of variants is read by the same headings. Without a column of ids the e-mails
give them. The participants' lists of Moodle and the gradebook of Canvas are valid rosters.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path

from pydantic_core import PydanticCustomError

from reportgen import catalogue
from reportgen.assignment import parts
from reportgen.assignment.fields import RESERVED, TypedText
from reportgen.base import chinese
from reportgen.base.errors import Fault, Location, Problem
from reportgen.base.files import contents
from reportgen.base.kinds import kinds, program_kinds
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import languages
from reportgen.base.units import NUMBER, UNIT, Language
from reportgen.base.words import as_error, as_problem, close_or_known, messages
from reportgen.base.yaml_source import Scalar, read_source
from reportgen.base.yaml_values import at
from reportgen.workbook import Page, SheetCell, read

FIRST_ROWS = 20
"""Number of rows, below a title, among which the headings are searched for."""
_WITH_UNIT = re.compile(rf"(.*?)\s*[(\[（]\s*({UNIT})\s*[)\]）]")
_NUMBER = re.compile(NUMBER)


class RosterColumn(Record):
    """A heading: `name` is a known column or the typed text, `unit` the text in brackets after it."""

    index: int
    name: str
    unit: str
    location: Location


class RosterRow(Record):
    """A row: the value under each heading, without empty cells; `location` is that of its first cell.

    `cells` are the locations of all its cells, `refused` the columns whose cell shows no value.
    """

    values: Mapping[str, Scalar]
    location: Location
    cells: Mapping[str, Location]
    refused: frozenset[str] = frozenset()


@cache
def _known_columns() -> Mapping[str, str]:
    """Return the name of a column by each of its folded headings in every language."""
    return {
        folded(heading): name
        for language in languages()
        for name, headings in messages(language)["columns"].items()
        for heading in (name, *headings)
    }


def folded(text: str) -> str:
    """Return a heading normalised for comparison: case, blanks, composition and trailing marks are removed."""
    return chinese.joined(" ".join(unicodedata.normalize("NFC", text).casefold().split())).rstrip(" .:*：")


def columns(row: Sequence[SheetCell]) -> list[RosterColumn]:
    """Return the headings of a row, without empty ones."""
    headed = []
    for index, cell in enumerate(row):
        title = unicodedata.normalize("NFC", cell.text).strip()
        known = _known_columns().get(folded(title))
        match = None if known else _WITH_UNIT.fullmatch(title)
        name, unit = (match[1], match[2]) if match else (title, "")
        if title:
            headed.append(RosterColumn(index, known or _known_columns().get(folded(name)) or name, unit, cell.location))
    return headed


def heading_row(page: Page, wanted: str) -> int | None:
    """Return the index of the first row near the top that has a column `wanted`, or None."""
    rows = enumerate(page.rows[:FIRST_ROWS])
    return next((k for k, row in rows if any(column.name == wanted for column in columns(row))), None)


def records(page: Page, headings: Sequence[RosterColumn], start: int, faults: list[Fault]) -> Iterator[RosterRow]:
    """Yield the non-empty rows from index `start`.

    Faults are added for repeated headings and for cells that show no value.
    """
    seen: set[str] = set()
    for column in headings:
        if column.name in seen:
            faults.append(Fault("column-twice", column.location, {"key": column.name}))
        seen.add(column.name)
    for row in page.rows[start:]:
        values: dict[str, Scalar] = {}
        refused: set[str] = set()
        present = [(column, row[column.index]) for column in headings if column.index < len(row)]
        for column, cell in present:
            text = (cell.label if column.name in PERSONAL else cell.text).strip()
            if not (text or cell.kind == "formula"):
                continue
            if cell.kind in ("error", "formula") and (cell.value is None or str(cell.value).startswith("#")):
                faults.append(Fault("no-cell-value", cell.location, {"text": cell.formula or cell.text}))
                refused.add(column.name)
                continue
            # A bare number has the unit of its heading.
            bare = column.unit and _NUMBER.fullmatch(text)
            values[column.name] = Scalar(f"{text} {column.unit}" if bare else text, cell.location)
        first = next((cell for cell in row if not cell.blank), None)
        if first is not None:
            cells = {column.name: cell.location for column, cell in present}
            yield RosterRow(values, first.location, cells, frozenset(refused))


CANVAS_ID = "SIS User ID"
"""Heading in Canvas's gradebook of the number that the school gave a student."""
PERSONAL = ("name", "id", "class", "section", "email")
NAME_PARTS = ("family", "given")
HANDED_IN = "handed_in"
SECTIONS = ("parameters", "positions", "drawing", "indicator", "report")
ASSIGNMENT_SUFFIXES = frozenset({".yaml", ".yml"})
_PATH = re.compile(r"([A-Za-z_]+)((?:\.\w+)+)")

LONGEST_NAME = 64
KEPT_CHARACTERS = 32
"""Number of characters kept of a changed id; the hash after them distinguishes it from all others."""
HASH_DIGITS = 12
_ORDINARY = re.compile(rf"[A-Z0-9][A-Z0-9_-]{{0,{LONGEST_NAME - 1}}}")
_LIKE_HASHED = re.compile(rf".*-[0-9A-F]{{{HASH_DIGITS}}}")


class RosterEntry(Record):
    """A row of the roster.

    `card` is its data of the student, by the keys of `report.student`. `overrides` are values with their cells by path
    ("parameters.H"). `handed_in` is the submission time as typed.
    """

    card: Mapping[str, str]
    overrides: Mapping[str, Scalar]
    location: Location
    handed_in: Scalar | None = None

    @property
    def id(self) -> str:
        return self.card["id"]

    @property
    def title(self) -> str:
        """The id with the name: K225520103001 Nguyễn Văn An."""
        return " ".join(filter(None, (self.id, self.card.get("name", ""))))

    @property
    def folder(self) -> str:
        """The name of the student's files and folders."""
        return folder_name(self.id)


class Roster(Record):
    """The students in the order of the table; `columns` are the headings of values they override."""

    students: tuple[RosterEntry, ...]
    columns: tuple[RosterColumn, ...] = ()
    notes: tuple[Problem, ...] = ()
    """Notes on rows that are not students."""


Assigned = tuple[RosterEntry, Path | Problem]
"""A student with the assignment file, or with the reason why there is none."""


def read_roster(path: Path, language: Language | None = None) -> Roster:
    """Return the class of a table file; raise `AssignmentError` with all its faults, in `language`."""
    page, start = _page(read(path, language))
    faults: list[Fault] = []
    if start is None:
        first = next((cell.location for row in page.rows for cell in row if not cell.blank), Location(str(path)))
        raise as_error([Fault("no-id-column", first)], language)
    headed = columns(page.rows[start])
    of_canvas = any(cell.text.strip() == CANVAS_ID for cell in page.rows[start])
    if of_canvas:
        # Canvas's column "ID" is the platform's own number.
        headed = [column for column in headed if column.name != "id" or page.rows[start][column.index].text != "ID"]
    headings = [_normal(column, faults) for column in headed]
    used = _used(headings)
    by_mail = not any(column.name == "id" for column in used)
    rows = [row for row in records(page, used, start + 1, faults) if row.values or row.refused]
    if of_canvas:
        # The row of possible points and the test student have no student number.
        rows = [_in_spoken_order(row) for row in rows if "id" in row.values]
    if by_mail:
        rows = _identified(rows)
    rows, left_out = _students_rows(rows)
    faults += [fault for row in rows for fault in _unfit(row)]
    faults += _id_faults(rows)
    if not rows:
        faults.append(Fault("empty-roster", headings[0].location))
    if faults:
        raise as_error(faults, language)
    overriding = tuple(column for column in used if _PATH.fullmatch(column.name))
    by_address = (
        [Fault("roster-ids-mail", headings[0].location, {"text": rows[0].values["id"].text})] if by_mail else []
    )
    left = (Fault("roster-row-left", row.location, {"text": _quoted(row)}) for row in left_out)
    notes = (as_problem(fault, language, "note") for fault in (*by_address, *left))
    return Roster(tuple(map(_student, rows)), overriding, tuple(notes))


def _identified(rows: Sequence[RosterRow]) -> list[RosterRow]:
    """Return the rows with ids: the local part of each e-mail, or the whole e-mail if two share a local part."""
    mails = [row.values.get("email") for row in rows]
    counts = Counter(comparable(mail.text.partition("@")[0]) for mail in mails if mail is not None)
    identified: list[RosterRow] = []
    for row, mail in zip(rows, mails, strict=True):
        if mail is None:
            identified.append(row)
            continue
        local = mail.text.partition("@")[0]
        id = local if counts[comparable(local)] == 1 and local else mail.text
        identified.append(replace(row, values={**row.values, "id": Scalar(id, mail.location)}))
    return identified


def _students_rows(rows: Sequence[RosterRow]) -> tuple[list[RosterRow], list[RosterRow]]:
    """Return the rows of students, and the others: rows without id and name, or separate ones below the table.

    Below the table, after an empty row, are the date, the author of the list and signatures: names without ids.
    """
    last = max((number for number, row in enumerate(rows) if "id" in row.values or row.refused), default=len(rows))
    apart = False
    students: list[RosterRow] = []
    left_out: list[RosterRow] = []
    for number, row in enumerate(rows):
        apart |= number > last and row.location.line > rows[number - 1].location.line + 1
        named = any(name in row.values for name in ("name", *NAME_PARTS))
        is_student = "id" in row.values or row.refused or (named and not apart)
        (students if is_student else left_out).append(row)
    return students, left_out


def _quoted(row: RosterRow) -> str:
    """Return the content of a row for quoting."""
    return " ".join(value.text for value in row.values.values())


def _in_spoken_order(row: RosterRow) -> RosterRow:
    """Return a row of Canvas, which writes "An, Nguyễn Văn", with the name in spoken order."""
    name = row.values.get("name")
    if name is None or name.text.count(", ") != 1:
        return row
    last, _, first = name.text.partition(", ")
    spoken = chinese.full_name(first, last)
    # A Chinese name begins with the family name.
    spoken = spoken if " " in spoken else f"{last}{first}"
    return replace(row, values={**row.values, "name": Scalar(spoken, name.location)})


def _page(pages: Sequence[Page]) -> tuple[Page, int | None]:
    """Return the first visible sheet with a column of ids, else of e-mails, and the index of its headings.

    If there is neither, return the first non-empty sheet and None.
    """
    full = [page for page in pages if any(page.rows) and not page.hidden] or list(pages)
    for wanted in ("id", "email"):
        for page in full:
            start = heading_row(page, wanted)
            if start is not None:
                return page, start
    return (full[0] if full else Page("", ())), None


def _used(headings: Sequence[RosterColumn]) -> list[RosterColumn]:
    """Return the headings that count: all ids and paths, which must not be repeated, and the first of each other."""
    used: list[RosterColumn] = []
    taken: set[str] = set()
    for column in headings:
        optional = column.name in (*PERSONAL, *NAME_PARTS, HANDED_IN)
        if column.name == "id" or _PATH.fullmatch(column.name) or (optional and column.name not in taken):
            used.append(column)
            taken.add(column.name)
    return used


def _normal(column: RosterColumn, faults: list[Fault]) -> RosterColumn:
    """Return a column whose heading is a path with its section in lower case; a misspelt section is a fault."""
    match = _PATH.fullmatch(column.name)
    if match is None:
        return column
    section = match[1].casefold()
    if section in SECTIONS:
        return RosterColumn(column.index, f"{section}{match[2]}", column.unit, column.location)
    if close := close_or_known(section, SECTIONS).get("close"):
        faults.append(Fault("unknown-column", column.location, {"key": column.name, "close": f"{close}{match[2]}"}))
    return RosterColumn(column.index, "", "", column.location)


def _unfit(row: RosterRow) -> Iterable[Fault]:
    """Yield faults of personal data that are not valid in an assignment file."""
    for name in (*PERSONAL, *NAME_PARTS):
        if name in row.values:
            try:
                TypedText().read(row.values[name].text)
            except PydanticCustomError as error:
                context = {key: str(value) for key, value in (error.context or {}).items()}
                yield Fault(context.pop("code"), row.values[name].location, context)


def _id_faults(rows: Iterable[RosterRow]) -> Iterable[Fault]:
    """Yield faults of ids that are missing, or that differ from an earlier one only in case and composition."""
    seen: dict[str, Location] = {}
    for row in rows:
        id = row.values.get("id")
        if id is None:
            if "id" not in row.refused:
                yield Fault("missing-id", row.cells.get("id", row.location))
            continue
        first = seen.setdefault(comparable(id.text), id.location)
        if first is not id.location:
            yield Fault(
                "duplicate-id", id.location, {"text": id.text, "place": str(first).removeprefix(f"{first.file}:")}
            )


def _student(row: RosterRow) -> RosterEntry:
    parts = (value.text for name, value in row.values.items() if name in NAME_PARTS)
    texts = {"name": chinese.full_name(*parts), **{name: value.text for name, value in row.values.items()}}
    texts["name"] = chinese.joined(texts["name"])
    overrides = {name: value for name, value in row.values.items() if _PATH.fullmatch(name)}
    card = {name: texts[name] for name in PERSONAL if texts.get(name)}
    return RosterEntry(card, overrides, row.location, row.values.get(HANDED_IN))


def folder_name(id: str) -> str:
    """Return a path component that represents an id uniquely and is safe on any system.

    An id of capital letters, digits, - and _ is unchanged. Any other is reduced to letters and digits and gets "-" and
    the first 12 hexadecimal digits of the SHA-256 of its composed form (NFC, UTF-8). This includes ids in lower case,
    since some systems do not distinguish it from upper case.
    """
    composed = unicodedata.normalize("NFC", id)
    if _ORDINARY.fullmatch(composed) and not RESERVED.fullmatch(composed) and not _LIKE_HASHED.fullmatch(composed):
        return composed
    digest = hashlib.sha256(composed.encode("utf-8", "surrogatepass")).hexdigest()[:HASH_DIGITS]
    bare = unicodedata.normalize("NFD", composed.replace("đ", "d").replace("Đ", "D"))
    letters = "".join(letter for letter in bare if not unicodedata.combining(letter))
    kept = re.sub(r"[^A-Za-z0-9]+", "_", letters).strip("_")[:KEPT_CHARACTERS]
    return f"{kept or 'id'}-{digest}"


def comparable(name: str) -> str:
    """Return an id or the stem of a file in the normalised spelling for comparisons."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", name).casefold())


def assignment_files(folder: Path, language: Language | None) -> dict[str, Path]:
    """Return the assignment files in a folder and below by their `comparable` stems.

    Raises `AssignmentError` for two files with one stem and for a folder that does not exist.
    """
    if not folder.is_dir():
        raise as_error([Fault("no-folder", Location(str(folder)))], language)
    files: dict[str, Path] = {}
    faults: list[Fault] = []
    assignments = [path for path in sorted(folder.rglob("*")) if _is_assignment(path, folder) and not _is_frozen(path)]
    of_others = {part.resolve() for path in assignments for part in beside(path)}
    for path in assignments:
        if path.resolve() in of_others and _may_be_part(path):
            continue
        first = files.setdefault(comparable(path.stem), path)
        if first is not path:
            faults.append(Fault("same-stem", Location(str(path)), {"text": path.stem, "first": str(first)}))
    if faults:
        raise as_error(faults, language)
    return files


def beside(path: Path) -> list[Path]:
    """Return the files of a coursework's parts; [] for another assignment."""
    try:
        # Most files have no parts and need not be parsed.
        return parts.files(read_source(path), path) if b"parts:" in contents(path) else []
    except OSError:
        # The code that reads the file itself reports this error.
        return []


def _is_frozen(path: Path) -> bool:
    """Return True if a file is a student's part by its name, whatever its content."""
    return "." in path.stem and parts.is_frozen(path, _heads())


@cache
def _heads() -> frozenset[str]:
    """Return the prefixes of the names of parts."""
    return frozenset(filter(None, (catalogue.kind(name).part for name in program_kinds())))


def _may_be_part(path: Path) -> bool:
    """Return True if a file named by another one can be a part of it; a machine remains a student's own file."""
    name = at(read_source(path).top, ("kind",))
    return not isinstance(name, Scalar) or name.text not in kinds() or bool(catalogue.kind(name.text).part)


def match_files(
    students: Sequence[RosterEntry], folder: Path, language: Language | None
) -> tuple[list[Assigned], list[Path]]:
    """Return each student with the file in `folder` or below whose stem is the id, and the files of no student.

    A stem may spell the id as `folder_name` does or as the roster does, ignoring case. Raises `AssignmentError` like
    `assignment_files`.
    """
    files = assignment_files(folder, language)
    assigned: list[Assigned] = []
    for student in students:
        own_file = next((files[stem] for stem in map(comparable, (student.folder, student.id)) if stem in files), None)
        missing = Fault("no-assignment", student.location, {"text": student.id})
        assigned.append((student, own_file or as_problem(missing, language)))
    taken = {file for _, file in assigned}
    return assigned, [path for path in files.values() if path not in taken]


def _is_assignment(path: Path, folder: Path) -> bool:
    hidden = any(part.startswith(".") for part in path.relative_to(folder).parts)
    return path.suffix.lower() in ASSIGNMENT_SUFFIXES and not hidden and path.is_file()
