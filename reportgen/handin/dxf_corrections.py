"""Write corrections into a DXF drawing: a new layer with the right vectors in red and lines of text.

The new lines are inserted into the file's text, so that every byte of the student's drawing is preserved. Only the
number from which the file counts its next objects increases.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from reportgen.base.errors import Location
from reportgen.base.records import Record
from reportgen.handin.dxf_lines import encoding_of
from reportgen.handin.dxf_tags import PAPER, Tags, pairs
from reportgen.workbook.zip_package import RefusedError

LAYER = "CORRECTIONS"
RED = 1
FONT = "arial.ttf"
"""A font with all Vietnamese letters, which the default stroke fonts of CAD programs lack."""
HEIGHT, LINE, HEAD = 3.5, 5.5, 4.0
"""The height of letters, the distance of lines of text, and the length of an arrowhead (mm)."""
SLIM = math.radians(10.0)
"""The angle of a stroke of an arrowhead with its line (rad)."""
MODEL = b"*MODEL_SPACE"
"""The block of model space."""
_HANDLES = frozenset({5, 105})
_OLD = b"AC1009"
_LINKS = frozenset({102, 330, 360, 1000, 1001, 1002, 1003, 1005, 1070, 1071, 1040})
"""Codes that a copy of a layer omits, because they link to other objects."""


class RedVector(Record):
    """The right vector from the start of the student's vector (drawing units), and the lines of text at its middle.

    Without an end, only the text is written.
    """

    start: complex
    end: complex | None
    lines: tuple[str, ...]
    space: bytes = b""
    """Block of the paper sheet that it is written to, "" for model space."""


def with_corrections(data: bytes, vectors: Sequence[RedVector], millimetre: float) -> bytes:
    """Return the drawing with the vectors on their own layer; `millimetre` is the length of 1 mm in drawing units.

    Raises `RefusedError` if the file is damaged.
    """
    file = _Layout.of(data)
    writer = _Writer(file, b"\r\n" if b"\r\n" in data[:200] else b"\n", millimetre)
    pieces: dict[int, list[bytes]] = {file.entities_end: []}
    for vector in vectors:
        pieces.setdefault(file.ends.get(vector.space, file.entities_end), []).extend(writer.vector(vector))
    inserted = [(end, b"".join(new)) for end, new in pieces.items()]
    inserted += [(table.end, writer.record(table)) for table in file.tables.values() if table.wanting]
    changed = bytearray()
    done = 0
    seed = [(*file.seed, b"%X" % writer.handle)] if file.seed else []
    for first, last, new in sorted([*((at, at, new) for at, new in inserted), *seed]):
        changed += data[done:first] + new
        done = last
    return bytes(changed + data[done:])


@dataclass
class _Table:
    """The table of layers or of text styles: the record that every file has, and the byte where the table ends."""

    name: bytes
    first: bytes
    record: Tags = field(default_factory=list)
    owner: bytes = b""
    end: int = -1
    wanting: bool = True


@dataclass
class _Layout:
    """The positions in a file where new lines are inserted, and the objects that new ones refer to."""

    old: bool = True
    encoding: str = "cp1252"
    entities_end: int = -1
    ends: dict[bytes, int] = field(default_factory=dict)
    """Ends of the blocks of inactive paper sheets; the active sheet's lines are among the entities."""
    owners: dict[bytes, bytes] = field(default_factory=dict)
    """The handles of model space, "", and of the sheets."""
    greatest: int = 0
    seed: tuple[int, int] | None = None
    tables: dict[bytes, _Table] = field(default_factory=dict)

    @classmethod
    def of(cls, data: bytes) -> _Layout:
        reader = _Layouting(cls())
        for code, value, _, offset in pairs(data, lambda code, line: RefusedError(code, Location("", line))):
            reader.pair(code, value, offset, data)
        if reader.layout.entities_end < 0:
            raise RefusedError("drawing-none", Location(""))
        reader.layout.encoding = encoding_of(reader.header)
        reader.layout.tables = {name: one for name, one in reader.layout.tables.items() if one.end >= 0 and one.record}
        return reader.layout


_RECORDS = {b"LAYER": b"0", b"STYLE": b"STANDARD"}


@dataclass
class _Layouting:
    """Reads a file once, pair by pair."""

    layout: _Layout
    header: dict[bytes, bytes] = field(default_factory=dict)
    section: bytes = b""
    variable: bytes = b""
    block: bytes = b""
    table: _Table | None = None
    kind: bytes = b""
    tags: Tags = field(default_factory=list)

    def pair(self, code: int, value: bytes, offset: int, data: bytes) -> None:
        layout = self.layout
        if code in _HANDLES and self.section != b"HEADER":
            layout.greatest = max(layout.greatest, _number(value))
        if code == 0:
            self.finish(offset)
            self.kind, self.tags = value, []
            if value == b"ENDSEC" and self.section == b"ENTITIES":
                layout.entities_end = offset
            elif value == b"ENDBLK" and self.block.startswith(PAPER) and self.block != PAPER:
                layout.ends[self.block] = offset
            elif value == b"ENDTAB" and self.table is not None:
                self.table.end = offset
                self.table = None
            return
        if self.kind == b"SECTION" and code == 2:
            self.section, self.kind = value.upper(), b""
        elif self.section == b"HEADER":
            if code == 9:
                self.variable = value
                return
            self.header.setdefault(self.variable, value)
            if self.variable == b"$ACADVER":
                layout.old = value <= _OLD
            elif self.variable == b"$HANDSEED" and code == 5:
                layout.greatest = max(layout.greatest, _number(value) - 1)
                start = data.index(value, offset + data[offset:].index(b"\n"))
                layout.seed = start, start + len(value)
        elif self.section == b"TABLES":
            self.tags.append((code, value))
        elif self.kind == b"BLOCK" and code == 2:
            self.block = value.upper()

    def finish(self, offset: int) -> None:
        """Store the data of a table object that ends here."""
        names = dict(reversed(self.tags))
        if self.kind == b"TABLE" and (name := names.get(2, b"")) in _RECORDS:
            self.table = _Table(name, _RECORDS[name], owner=names.get(5, b""))
            self.layout.tables[name] = self.table
        elif self.table is not None and self.kind == self.table.name:
            name = names.get(2, b"").upper()
            if name == self.table.first:
                self.table.record = self.tags
            self.table.wanting &= name != LAYER.encode()
        elif self.kind == b"BLOCK_RECORD" and (name := names.get(2, b"").upper()).startswith((MODEL, PAPER)):
            self.layout.owners[name.removeprefix(MODEL)] = names.get(5, b"")
        self.tags = []


def _number(handle: bytes) -> int:
    try:
        return int(handle, 16)
    except ValueError:
        return 0


@dataclass
class _Writer:
    layout: _Layout
    newline: bytes
    millimetre: float
    handle: int = 0
    space: bytes = b""
    """Space of the vector that is being written."""

    def __post_init__(self) -> None:
        self.handle = self.layout.greatest + 1

    def vector(self, vector: RedVector) -> Iterator[bytes]:
        """Yield the lines of a vector with its arrowhead, and its texts beside its middle."""
        self.space = vector.space
        if vector.end is not None and vector.end != vector.start:
            yield self.line(vector.start, vector.end)
            back = (vector.start - vector.end) / abs(vector.start - vector.end)
            length = min(HEAD * self.millimetre, abs(vector.end - vector.start) / 2)
            for side in (SLIM, -SLIM):
                yield self.line(vector.end, vector.end + length * back * cmath.rect(1.0, side))
        at = vector.start
        if vector.end is not None and vector.end != vector.start:
            across = 1j * (vector.end - vector.start) / abs(vector.end - vector.start)
            across = across if across.real + across.imag > 0 else -across
            # Beside its middle, on the right or above.
            at = (vector.start + vector.end) / 2 + HEAD * self.millimetre * across
        for number, text in enumerate(vector.lines):
            yield self.text(at - 1j * LINE * self.millimetre * number, text)

    def line(self, start: complex, end: complex) -> bytes:
        ends = [(10, start.real), (20, start.imag), (30, 0.0), (11, end.real), (21, end.imag), (31, 0.0)]
        return self.entity("LINE", [("AcDbLine", ends)])

    def text(self, at: complex, text: str) -> bytes:
        place = [(10, at.real), (20, at.imag), (30, 0.0), (40, HEIGHT * self.millimetre), (1, self.said(text))]
        style = [(7, LAYER)] if b"STYLE" in self.layout.tables else []
        return self.entity("TEXT", [("AcDbText", [*place, *style]), ("AcDbText", [])])

    def said(self, text: str) -> str:
        """Return a text as the file encodes it: before R2007, other letters than ASCII are escaped by their numbers."""
        plain = text.replace("\n", " ").replace("%%", "% %")
        if self.layout.encoding == "utf-8":
            return plain
        return "".join(one if one.isascii() else f"\\U+{ord(one):04X}" for one in plain)

    def entity(self, kind: str, parts: Sequence[tuple[str, Sequence[tuple[int, object]]]]) -> bytes:
        tags: list[tuple[int, object]] = [(0, kind)]
        paper: list[tuple[int, object]] = [(67, 1)] if self.space else []
        if self.layout.old:
            tags += [*paper, (8, LAYER), (62, RED)]
            tags += [tag for _, own in parts for tag in own]
            return self.pairs(tags)
        tags.append((5, self.next()))
        if owner := self.layout.owners.get(self.space):
            tags.append((330, owner))
        tags += [(100, "AcDbEntity"), *paper, (8, LAYER), (62, RED)]
        for marker, own in parts:
            tags += [(100, marker), *own]
        return self.pairs(tags)

    def record(self, table: _Table) -> bytes:
        """Return the layer, or its text style, as a copy of the record that every file has."""
        changed: dict[int, object] = {2: LAYER}
        changed |= {62: RED, 70: 0} if table.name == b"LAYER" else {3: FONT, 4: "", 70: 0, 40: "0.0"}
        tags: list[tuple[int, object]] = [(0, table.name)]
        if not self.layout.old:
            tags.append((5, self.next()))
            if table.owner:
                tags.append((330, table.owner))
        kept = [(code, value) for code, value in table.record if code != 5 and code not in _LINKS]
        tags += [(code, changed.get(code, value)) for code, value in kept]
        return self.pairs(tags)

    def next(self) -> str:
        self.handle += 1
        return f"{self.handle - 1:X}"

    def pairs(self, tags: Sequence[tuple[int, object]]) -> bytes:
        return b"".join(b"%3d%s%s%s" % (code, self.newline, self.value(value), self.newline) for code, value in tags)

    def value(self, value: object) -> bytes:
        if isinstance(value, bytes):
            return value
        return (f"{value:.6f}" if isinstance(value, float) else str(value)).encode(self.layout.encoding, "replace")
