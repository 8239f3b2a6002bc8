"""The zip package of an XLSX or a Word file, checked before other code reads any of it.

Packages are refused if they are encrypted, contain macros or links to other files, or unpack to more than the
limit; parts of XML are refused if they have a document type, which alone can declare entities. `measure` refuses
parts for which openpyxl would need too much memory.
"""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from bisect import bisect_right
from collections.abc import Callable, Iterator
from typing import Any, Literal
from xml.parsers import expat

from reportgen.base.errors import Fault, Location
from reportgen.base.records import Record

MOST_PARTS = 2_000
MOST_UNPACKED = 60_000_000
"""Largest number of bytes of all parts together."""
MOST_RATIO = 250
"""Largest ratio of unpacked to packed size of a part of more than `SMALL` bytes; sheets of numbers reach 40."""
SMALL = 1_000_000
MOST_ELEMENTS = 100_000
"""Largest number of elements of a part that lists other parts."""
CONTENT_TYPES = "[Content_Types].xml"
CHUNK = 1 << 16
MOST_HELD = 1 << 18
"""Largest number of elements and attributes in memory; the longest possible row, of styled empty cells, has 50 000."""
MOST_GROUPS = 1 << 20
"""Largest number of rows of a sheet, or strings of a table; no sheet can have more rows."""
MOST_TRANSLATED = 20_000_000
"""Largest number of characters of all formulas that repeat a shared one, each counted as the longest shared one."""

UNREADABLE_ZIP = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError, OverflowError)
"""Exceptions of `zipfile` for an archive that is damaged, cut off, encrypted or packed in an unknown way."""

_EMPTY_CELL = re.compile(rb"<((?:\w+:)?c)(?=\s)[^<>]*?(?:/>|>\s*</\1\s*>)")
"""A cell with a style but without content."""
_UNPLACED_CELL = re.compile(rb"<(?:\w+:)?c(?=[\s/>])(?![^<>]*\sr\s*=)")
"""A cell that does not give its place: it follows the one before it."""
_OLD = b"\xd0\xcf\x11\xe0"
_ENCRYPTED = "EncryptedPackage".encode("utf-16-le")
_MACROS = re.compile(r"vbaproject|/macrosheets/|/activex/|\.bas$", re.IGNORECASE)
_LINKS = re.compile(r"(^|/)externallinks/|(^|/)connections\.xml$", re.IGNORECASE)
_FORBIDDEN_TYPES = re.compile(r"macroenabled|vbaproject|intlmacrosheet", re.IGNORECASE)
_TRAITS = re.compile(r"\.(xml|rels|vml)$", re.IGNORECASE)


class Bounds(Record):
    """Limits of a package: bytes of all its parts together, and the kinds of relations that may lead outside."""

    unpacked: int = MOST_UNPACKED
    links: frozenset[str] = frozenset({"hyperlink"})


Attributes = dict[str, str]
Start = Callable[[str, Attributes], None]


class Relation(Record):
    """Relation of a part to another: the last word of its type, its target, and whether that is outside the package."""

    kind: str
    target: str
    external: bool


class Package:
    """An opened package whose directory has been found harmless; parts are read on demand, within limits."""

    def __init__(self, data: bytes, file: str, bounds: Bounds | None = None) -> None:
        """Open and check a package; raise `RefusedError` if it is refused."""
        self.location = Location(file)
        self.bounds = bounds or Bounds()
        if data.startswith(_OLD):
            raise self.refused("sheet-encrypted" if _ENCRYPTED in data else "sheet-old")
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(data))
        except UNREADABLE_ZIP:
            raise self.refused("sheet-no-zip") from None
        self._parts = {info.filename: info for info in self._zip.infolist()}
        self._thinned: dict[str, bytes] = {}
        self._judge(len(data))
        for name in self._parts:
            if _TRAITS.search(name):
                self.walk(name, prologue_only=True)
        self._judge_contents()

    def __contains__(self, name: str) -> bool:
        return name in self._parts

    @property
    def names(self) -> list[str]:
        """Names of all parts."""
        return list(self._parts)

    def size(self, name: str) -> int:
        """Return the number of bytes of a part, unpacked."""
        return self._parts[name].file_size

    def refused(self, code: str, **arguments: str) -> RefusedError:
        return RefusedError(code, self.location, **arguments)

    def bomb(self) -> RefusedError:
        return self.refused("sheet-bomb", largest=str(self.bounds.unpacked // 1_000_000))

    def _judge(self, size: int) -> None:
        """Refuse packages for reasons that the directory of the zip shows."""
        infos = self._zip.infolist()
        unpacked = sum(info.file_size for info in infos)
        # Parts that share their bytes unpack to more than any one of them shows.
        starts = [*sorted(info.header_offset for info in infos), size]
        ends = [info.header_offset + info.compress_size for info in infos]
        shared = len(set(starts)) < len(starts) or any(
            end > starts[min(bisect_right(starts, info.header_offset), len(infos))]
            for end, info in zip(ends, infos, strict=True)
        )
        if len(infos) > MOST_PARTS or unpacked > self.bounds.unpacked or shared:
            raise self.bomb()
        for info in infos:
            if info.file_size > SMALL and info.file_size > MOST_RATIO * max(info.compress_size, 1):
                raise self.bomb()
            if info.flag_bits & 1:
                raise self.refused("sheet-encrypted")
            if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise self.refused("sheet-damaged")
        if len(self._parts) < len(infos):
            raise self.refused("sheet-damaged")
        if CONTENT_TYPES not in self._parts:
            raise self.refused("sheet-no-zip")
        if any(_MACROS.search(name) for name in self._parts):
            raise self.refused("sheet-macros")
        if any(_LINKS.search(name) for name in self._parts):
            raise self.refused("sheet-links")

    def _judge_contents(self) -> None:
        """Refuse packages by their list of types and their relations; usually only hyperlinks may lead outside."""
        for _, attributes in self.elements(CONTENT_TYPES):
            if _FORBIDDEN_TYPES.search(attributes.get("ContentType", "")):
                raise self.refused("sheet-macros")
        for name in self._parts:
            if name.lower().endswith(".rels"):
                for relation in self.relations(name).values():
                    if relation.external and relation.kind not in self.bounds.links:
                        raise self.refused("sheet-links")

    def relations(self, name: str) -> dict[str, Relation]:
        """Return the relations of a .rels part by their ids; empty if there is no such part."""
        if name not in self._parts:
            return {}
        return {
            attributes.get("Id", ""): Relation(
                attributes.get("Type", "").rpartition("/")[2],
                attributes.get("Target", ""),
                attributes.get("TargetMode", "").lower() == "external",
            )
            for tag, attributes in self.elements(name)
            if tag == "Relationship"
        }

    def elements(self, name: str) -> list[tuple[str, Attributes]]:
        """Return all elements of a part, in order, with their attributes, names without namespaces."""
        elements: list[tuple[str, Attributes]] = []

        def start(tag: str, attributes: Attributes) -> None:
            elements.append((_local(tag), {_local(key): value for key, value in attributes.items()}))
            if len(elements) > MOST_ELEMENTS:
                raise self.bomb()

        self.walk(name, start)
        return elements

    def content(self, name: str) -> bytes:
        """Return the bytes of a part; raise `RefusedError` if it is damaged or larger than the directory announced."""
        return b"".join(self._chunks(name))

    def without_empty_cells(self, name: str) -> None:
        """Leave out the empty cells of a sheet, of which a program may write a million for one border."""
        content = self.content(name)
        if b"<![CDATA[" not in content and not _UNPLACED_CELL.search(content):
            self._thinned[name] = _EMPTY_CELL.sub(b"", content)

    def walk(
        self,
        name: str,
        start: Start | None = None,
        end: Callable[[str], None] | None = None,
        text: Callable[[str], None] | None = None,
        *,
        prologue_only: bool = False,
    ) -> None:
        """Pass the events of an XML part to the functions; a name has its namespace and a space before it.

        Raise `RefusedError` for a document type, damage, or more bytes than the directory announced.
        """
        parser: Any = expat.ParserCreate(namespace_separator=" ")
        parser.buffer_text = True
        entered = False

        def refuse(*_: object) -> None:
            raise self.refused("sheet-entities", text=name)

        def enter(*_: object) -> None:
            nonlocal entered
            entered = True

        parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
        parser.StartElementHandler = enter if prologue_only else start
        parser.EndElementHandler = end
        parser.CharacterDataHandler = text
        try:
            for chunk in self._chunks(name):
                parser.Parse(chunk, False)
                if prologue_only and entered:
                    return
            parser.Parse(b"", True)
        except (expat.ExpatError, UnicodeError, LookupError):
            if not prologue_only:
                raise self.refused("sheet-damaged", text=name) from None

    def _chunks(self, name: str) -> Iterator[bytes]:
        if name in self._thinned:
            yield from (self._thinned[name][at : at + CHUNK] for at in range(0, len(self._thinned[name]), CHUNK))
            return
        info = self._parts[name]
        left = info.file_size
        try:
            with self._zip.open(info) as stream:
                while chunk := stream.read(CHUNK):
                    left -= len(chunk)
                    if left < 0:
                        raise self.bomb()
                    yield chunk
        except (*UNREADABLE_ZIP, OSError):
            raise self.refused("sheet-damaged") from None


def _local(name: str) -> str:
    return name.rpartition(" ")[2]


# --- limits of a part -----------------------------------------------------------------------------
# openpyxl builds the tree of a part and frees each row of a sheet and each shared string once it is read:
# its memory grows with the largest of them and with everything outside of them.

_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_GROUPS = frozenset({f"{_MAIN} row", f"{_MAIN} si"})
_FORMULA = f"{_MAIN} f"
_PLACE = frozenset({"r", "spans"})


def measure(package: Package, name: str) -> tuple[int, int]:
    """Return the numbers of cells (elements right inside rows) and of formulas in a part.

    Raises `RefusedError` if it is damaged or needs more memory than the limit.
    """
    depth = held = outside = groups = cells = formulas = dependents = length = longest = 0
    shared = False

    def start(tag: str, attributes: Attributes) -> None:
        """Count an element.

        `depth` is 1 directly inside a row or a string and 0 outside of all; `outside` is never released.
        """
        nonlocal depth, held, outside, groups, cells, formulas, dependents, shared, length
        if depth:
            depth += 1
            cells += depth == 2
        elif tag in _GROUPS:
            # openpyxl keeps the other attributes of a row, such as its height.
            depth, groups, outside = 1, groups + 1, held + (not attributes.keys() <= _PLACE)
        held += 1 + len(attributes)
        shared, length = tag == _FORMULA and attributes.get("t") == "shared", 0
        formulas += tag == _FORMULA
        dependents += shared
        if held > MOST_HELD or groups > MOST_GROUPS:
            raise package.bomb()

    def end(_: str) -> None:
        nonlocal depth, held, shared
        shared = False
        if depth:
            depth -= 1
            if not depth:
                held = outside

    def text(data: str) -> None:
        """Measure the text of a formula; no cell could hold a longer one."""
        nonlocal length, longest
        if shared:
            length += len(data)
            longest = max(longest, length)
            if length > LONGEST_CELL:
                raise too_long(package.location)

    package.walk(name, start, end, text)
    if dependents * longest > MOST_TRANSLATED:
        raise package.bomb()
    return cells, formulas


# --- content of a table file ----------------------------------------------------------------------
# Pages of rows of cells; each cell knows its place.

CellKind = Literal["empty", "text", "number", "boolean", "date", "error", "formula"]

MOST_ROWS = 10_000
MOST_COLUMNS = 500
MOST_CELLS = 200_000
LONGEST_CELL = 32_767
"""Largest number of characters that any spreadsheet program writes into a cell."""

_LIVE = re.compile(r"'*\s*[=+\-@\t\r\n＝＋－＠]")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_SEPARATORS = ",;|\t\r\n"
"""All characters that some program uses to separate cells or rows."""
_INSIDE = re.compile(r"""(?<![,;|'"\s])[,;|'"\s]++(?=[=+\-@＝＋－＠])""")
"""Separators, quotation marks and blanks before a sign; each run of them is looked at once."""
_NUMBER_CELL = re.compile(rf"{_NUMBER.pattern}(?:[{_SEPARATORS}]|$)")


class SheetCell(Record):
    """A cell as displayed: `value` is a number of kind "number", None of kind "empty", else text.

    A date is ISO text, a boolean TRUE or FALSE, an error its code (#DIV/0!). For a formula, `formula` is its text
    with the equals sign and `value` the result stored with it, None if there is none. `code` is the displayed text
    of a number whose format makes it a code, "" for any other cell.
    """

    value: str | float | None
    location: Location
    kind: CellKind
    formula: str = ""
    code: str = ""

    @property
    def text(self) -> str:
        """The value as a reader of the table sees it: whole numbers without a decimal point, "" for an empty cell."""
        if self.value is None:
            return ""
        return self.value if isinstance(self.value, str) else number_text(self.value)

    @property
    def label(self) -> str:
        """The value as a name or a number by which somebody is known: with the zeros that its cell displays."""
        return self.code or self.text

    @property
    def blank(self) -> bool:
        return self.kind == "empty"


class Page(Record):
    """A sheet, or a whole CSV file: its rows in order, each up to its last cell with content."""

    name: str
    rows: tuple[tuple[SheetCell, ...], ...]
    hidden: bool = False


class RefusedError(Exception):
    """A file that is not read any further; carries the `Fault`."""

    def __init__(self, code: str, location: Location, **arguments: str) -> None:
        super().__init__(code)
        self.fault = Fault(code, location, arguments)


def exceeds(row: int, column: int, cells: int = 0) -> bool:
    """Return True if a table with that row, column or number of cells is larger than the limits."""
    return row > MOST_ROWS or column > MOST_COLUMNS or cells > MOST_CELLS


def too_large(location: Location) -> RefusedError:
    """Return the error for a table with more rows, columns or cells than the limits."""
    return RefusedError(
        "table-too-large", location, rows=str(MOST_ROWS), columns=str(MOST_COLUMNS), cells=str(MOST_CELLS)
    )


def too_long(location: Location) -> RefusedError:
    """Return the error for a cell with more than `LONGEST_CELL` characters."""
    return RefusedError("text-too-long", location, largest=str(LONGEST_CELL))


def number_text(value: float) -> str:
    """Return a number in the shortest form that reads back as the same number: 195520103001, 0.35, 1e-20."""
    return str(int(value)) if value.is_integer() and abs(value) < 1e16 else repr(value)


def guarded(text: str) -> str:
    """Return the text with an apostrophe before everything that a spreadsheet would read as a formula; numbers stay.

    Such a formula may also begin inside: programs of other countries separate cells at semicolons, tabs or bars,
    and ignore the quotation marks around a cell.
    """
    inside = _INSIDE.sub(_with_apostrophe, text)
    return f"'{inside}" if _LIVE.match(inside) and not _NUMBER.fullmatch(inside) else inside


def unguarded(text: str) -> str:
    """Return the text that `guarded` was given."""
    rest = text[1:]
    inside = rest if text.startswith("'") and _LIVE.match(rest) and not _NUMBER.fullmatch(rest) else text
    return _INSIDE.sub(_without_apostrophe, inside)


def _with_apostrophe(run: re.Match[str]) -> str:
    """Return the text before a sign that could begin a formula, with an apostrophe after its last separator."""
    before, after = _at_last_separator(run[0])
    number = not after and _NUMBER_CELL.match(run.string, run.end())
    return run[0] if not before or number else f"{before}'{after}"


def _without_apostrophe(run: re.Match[str]) -> str:
    before, after = _at_last_separator(run[0])
    return before + after.removeprefix("'") if before else after


def _at_last_separator(run: str) -> tuple[str, str]:
    cut = max(map(run.rfind, _SEPARATORS)) + 1
    return run[:cut], run[cut:]
