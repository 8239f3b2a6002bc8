"""Parse a DXF drawing (R12 to R2018) into entities: pairs of a code and a value, grouped by their blocks.

Only entities that may be a vector, an arrowhead or a label are kept. Files that the drawing names are never opened.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from reportgen.base.errors import Location
from reportgen.base.records import Record
from reportgen.workbook.zip_package import RefusedError

LARGEST = 50_000_000
"""Largest size (bytes) of a drawing."""
MOST = 300_000
"""Largest number of lines and texts of a drawing, with its blocks expanded."""
KEPT = frozenset(
    b"LINE LWPOLYLINE POLYLINE VERTEX SEQEND MLINE SPLINE SOLID TRACE LEADER INSERT TEXT MTEXT ATTRIB".split()
)
"""Entities that are read."""
PICTURES = frozenset(b"IMAGE OLEFRAME OLE2FRAME PDFUNDERLAY DWFUNDERLAY DGNUNDERLAY".split())
"""Entities that are ignored, with a note."""
BINARY = b"AutoCAD Binary DXF"
DRAWING = b"AC10"
"""First bytes of a DWG."""
EXTERNAL = 4 | 8 | 16 | 32
"""Flags of a block that refers to another file."""
PAPER = b"*PAPER_SPACE"
"""Prefix of the names of the blocks of paper sheets; the block with exactly this name is the active sheet."""
_COMMENT = 999
_INVISIBLE, _PAPER, _LAYER = 60, 67, 8
_FROZEN = 1

Tags = list[tuple[int, bytes]]


class Entity(Record):
    """An entity: its type, its pairs in order, and the line of the file where it begins."""

    type: bytes
    tags: Tags
    line: int

    def get(self, code: int, otherwise: float = 0.0) -> float:
        """Return the first number with a code, in the unit of the code: drawing units, degrees or none.

        Returns `otherwise` if there is none.
        """
        return next((float(value) for tag, value in self.tags if tag == code), otherwise)

    def whole(self, code: int) -> int:
        """Return the first whole number with a code, 0 if there is none."""
        return int(self.get(code))

    def text(self, code: int) -> bytes:
        """Return the first text with a code, b"" if there is none."""
        return next((value for tag, value in self.tags if tag == code), b"")


@dataclass
class Block:
    """A block: its base point (drawing units) and its entities; an `external` one refers to another file."""

    base: complex = 0j
    external: bool = False
    entities: list[Entity] = field(default_factory=list)


@dataclass
class Entities:
    """A drawing's header, its blocks by name, and the entities of its model space; `pictures` are counted.

    Layers that are `off` hide their entities, except those on other layers inside a block inserted on them. `frozen`
    layers hide these too.
    """

    header: dict[bytes, bytes] = field(default_factory=dict)
    blocks: dict[bytes, Block] = field(default_factory=dict)
    entities: list[Entity] = field(default_factory=list)
    pictures: int = 0
    off: set[bytes] = field(default_factory=set)
    frozen: set[bytes] = field(default_factory=set)

    def is_seen(self, entity: Entity) -> bool:
        """Return True if an entity is visible."""
        layer = entity.text(_LAYER).strip().upper()
        hidden = layer in self.frozen or (layer in self.off and entity.type != b"INSERT")
        return not (hidden or entity.whole(_INVISIBLE))

    @property
    def spaces(self) -> dict[bytes, list[Entity]]:
        """The entities of model space, named "", and of paper sheets, by the names of their blocks."""
        spaces: dict[bytes, list[Entity]] = {b"": [], PAPER: []}
        spaces |= {name: [*block.entities] for name, block in self.blocks.items() if name.startswith(PAPER)}
        space = b""
        for entity in self.entities:
            # The vertices of a polyline are in the same space as the polyline.
            if entity.type not in (b"VERTEX", b"SEQEND"):
                space = PAPER if entity.whole(_PAPER) else b""
            spaces[space].append(entity)
        return spaces

    def number(self, variable: bytes) -> int:
        """Return a whole number of the header, 0 if it has none."""
        value = self.header.get(variable, b"")
        return int(float(value)) if _is_number(value) else 0


def read_entities(data: bytes, file: str) -> Entities:
    """Return the entities of a drawing; raise `RefusedError` if it is not a DXF, is damaged or too large."""

    def refuse(code: str, line: int = 1, **about: str) -> RefusedError:
        return RefusedError(code, Location(file, line), **about)

    if len(data) > LARGEST:
        raise refuse("drawing-large", largest=f"{LARGEST / 1e6:g}")
    if data.startswith(DRAWING):
        raise refuse("drawing-dwg")
    if data.startswith(BINARY):
        raise refuse("drawing-binary")
    contents, kept = Entities(), 0
    section = variable = b""
    block: Block | None = None
    entity: Entity | None = None
    sections = 0
    layer = _Layer(contents, False)
    for code, value, line, _ in pairs(data, refuse):
        if code == 0:
            entity = None
            layer = _Layer(contents, value == b"LAYER")
            if value == b"SECTION":
                section, sections = b"?", sections + 1
            elif value in (b"ENDSEC", b"EOF"):
                section, block = b"", None
            elif section == b"BLOCKS" and value in (b"BLOCK", b"ENDBLK"):
                block = Block() if value == b"BLOCK" else None
                entity = Entity(value, [], line) if block else None
            elif section == b"ENTITIES" or block is not None:
                contents.pictures += value in PICTURES
                if value in KEPT:
                    kept += 1
                    if kept > MOST:
                        raise refuse("drawing-elements", line, most=f"{MOST}")
                    entity = Entity(value, [], line)
                    (contents.entities if block is None else block.entities).append(entity)
        elif section == b"TABLES":
            layer.pair(code, value)
        elif section == b"?":
            section = value.upper() if code == 2 else section
        elif section == b"HEADER":
            if code == 9:
                variable = value
            else:
                contents.header.setdefault(variable, value)
        elif entity is not None:
            if entity.type == b"BLOCK":
                if code in (10, 20, 70) and not _is_number(value):
                    raise refuse("drawing-damaged", line + 1)
                _of_block(contents, block or Block(), code, value)
            else:
                if code in _NUMBERS and not _is_number(value):
                    raise refuse("drawing-damaged", line + 1)
                entity.tags.append((code, value))
    if not sections:
        raise refuse("drawing-none")
    return contents


@dataclass(slots=True)
class _Layer:
    """A record of the layer table, as far as it has been read."""

    contents: Entities
    is_layer: bool
    name: bytes = b""

    def pair(self, code: int, value: bytes) -> None:
        """Record that the layer is off (negative colour) or frozen."""
        if not self.is_layer:
            return
        if code == 2:
            self.name = value.upper()
        elif code == 62 and value.startswith(b"-"):
            self.contents.off.add(self.name)
        elif code == 70 and value.isdigit() and int(value) & _FROZEN:
            self.contents.frozen.add(self.name)


Refuse = Callable[..., RefusedError]


def pairs(data: bytes, refuse: Refuse) -> Iterator[tuple[int, bytes, int, int]]:
    """Yield codes and values, the line of each code and its byte, up to the EOF mark or the end of the file.

    Raises the error that `refuse` makes if a code is not a whole number.
    """
    lines, line, offset = io.BytesIO(data), 1, 0
    for code_line in lines:
        value = lines.readline()
        try:
            code = int(code_line)
        except ValueError:
            if not (code_line + value).strip() and not lines.read().strip():
                return
            raise refuse("drawing-damaged", line) from None
        if code != _COMMENT:
            yield code, value.strip(b"\r\n") if code in _TEXTS else value.strip(), line, offset
        if code == 0 and value.strip() == b"EOF":
            return
        line, offset = line + 2, offset + len(code_line) + len(value)


_TEXTS = frozenset({1, 3})
_NUMBERS = frozenset(range(10, 60)) | {60, 67, 70, 71, 210, 220, 230}
_FURTHEST = 1e12


def _is_number(value: bytes) -> bool:
    try:
        return abs(float(value)) < _FURTHEST
    except ValueError:
        return False


def _of_block(contents: Entities, block: Block, code: int, value: bytes) -> None:
    """Store the data of a pair in the header of a block."""
    if code == 2:
        contents.blocks.setdefault(value.upper(), block)
    elif code == 70:
        block.external = bool(int(float(value)) & EXTERNAL)
    elif code == 10:
        block.base += float(value)
    elif code == 20:
        block.base += 1j * float(value)
