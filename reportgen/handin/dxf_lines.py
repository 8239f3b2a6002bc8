"""Lines and texts of a DXF drawing in its own units; blocks are expanded after their content is counted.

Points are complex numbers x + jy in drawing units. An affine map of the plane is a z + b z̄ + c, with complex a, b, c.
"""

from __future__ import annotations

import cmath
import codecs
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from reportgen.base.errors import Fault, Location
from reportgen.base.records import Record, replace
from reportgen.handin.dxf_tags import MOST, Entities, Entity, read_entities
from reportgen.workbook.zip_package import RefusedError

UNITS = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 14: 100.0}
"""Millimetres per unit, by the unit codes of a drawing."""
DEEPEST = 32
"""Deepest nesting of blocks."""
STRAIGHT = 1e-3
"""Largest angle (rad) between segments of a polyline that count as one line."""
Line = tuple[complex, complex]
"""The two ends of a line (drawing units)."""
BARB = 0.1
"""Length of the strokes of an arrowhead that an entity draws itself, as a share of its line."""


class DrawnText(Record):
    """A text with its start or, depending on its alignment, its middle, and the height of its letters, in one unit.

    They are in drawing units when a file is read, in mm when plans are searched for.
    """

    text: str
    at: complex
    height: float


class DrawnLines(Record):
    """All straight lines [M, 2] in the model space of a drawing and its texts, in its own units.

    `unit` is the drawing unit that the file names (mm), None if it names no known one. `notes` report ignored content.
    `sheets` are the contents of paper sheets, each with the name of its block as `space`.
    """

    ends: np.ndarray
    texts: tuple[DrawnText, ...] = ()
    unit: float | None = None
    notes: tuple[Fault, ...] = ()
    space: bytes = b""
    sheets: tuple[DrawnLines, ...] = ()

    @property
    def all_texts(self) -> tuple[DrawnText, ...]:
        """The texts of model space and of all paper sheets (drawing units)."""
        return (*self.texts, *(text for sheet in self.sheets for text in sheet.texts))


def read_lines(data: bytes, file: str) -> DrawnLines:
    """Return the lines and texts of a DXF in drawing units.

    Raises `RefusedError` if the file is not a DXF, is damaged or too large, or nests its blocks too deeply.
    """
    contents = read_entities(data, file)
    encoding = encoding_of(contents.header)
    unfolding = _Unfolding(contents, encoding, file)
    pieces = {name: unfolding.pieces_of(entities) for name, entities in contents.spaces.items()}
    unfolding.check(pieces.values())
    spaces = {name: unfolding.unfolded(own) for name, own in pieces.items()}
    model = spaces.pop(b"")
    unit = UNITS.get(contents.number(b"$INSUNITS"))
    location = Location(file)
    notes = [Fault("drawing-pictures", location, {"count": f"{contents.pictures}"})] if contents.pictures else []
    names = [name.decode(encoding, "replace") for name, block in contents.blocks.items() if block.external]
    notes += [Fault("drawing-external", location, {"text": name}) for name in names]
    hidden = unfolding.hidden
    notes += [Fault("drawing-hidden", location, {"count": f"{hidden}"})] if hidden else []
    sheets = [
        DrawnLines(own.lines, tuple(own.texts), unit, space=name)
        for name, own in spaces.items()
        if len(own.lines) or own.texts
    ]
    return DrawnLines(model.lines, tuple(model.texts), unit, tuple(notes), sheets=tuple(sheets))


def encoding_of(header: Mapping[bytes, bytes]) -> str:
    """Return the encoding of the texts: UTF-8 since R2007, before that the code page that the header names."""
    if header.get(b"$ACADVER", b"") >= b"AC1021":
        return "utf-8"
    page = header.get(b"$DWGCODEPAGE", b"").decode("ascii", "replace").upper().replace("ANSI_", "cp")
    try:
        # Python also knows encodings that are not for text, and some that cannot replace undecodable bytes.
        bytes(range(256)).decode(page or "cp1252", "replace")
        return codecs.lookup(page or "cp1252").name
    except (LookupError, UnicodeError, ValueError):
        return "cp1252"


# --- blocks ---------------------------------------------------------------------------------------


class Affine(Record):
    """The map z → a z + b z̄ + c of points of any shape (drawing units); a and b are dimensionless."""

    a: complex = 1.0
    b: complex = 0.0
    c: complex = 0.0

    def __call__(self, z: np.ndarray) -> np.ndarray:
        return self.a * z + self.b * z.conj() + self.c


MIRROR = Affine(0.0, -1.0)
"""The plane of an entity whose own z axis points away from the viewer."""


class Insertion(Record):
    """An inserted block: its name, and a map to the drawing for each of its copies."""

    name: bytes
    maps: tuple[Affine, ...]


@dataclass
class Pieces:
    """The content of a block or of model space: lines [M, 2] (drawing units), texts, inserted blocks."""

    lines: np.ndarray
    texts: list[DrawnText] = field(default_factory=list)
    insertions: list[Insertion] = field(default_factory=list)


@dataclass
class _Unfolding:
    contents: Entities
    encoding: str
    file: str
    pieces: dict[bytes, Pieces] = field(default_factory=dict)
    counts: dict[bytes, int] = field(default_factory=dict)
    whole: dict[bytes, Pieces] = field(default_factory=dict)
    hidden: int = 0
    """Number of invisible entities."""

    def pieces_of(self, entities: Sequence[Entity]) -> Pieces:
        """Return the visible content of some entities."""
        seen = [entity for entity in entities if self.contents.is_seen(entity)]
        self.hidden += len(entities) - len(seen)
        return _pieces(seen, self.encoding)

    def check(self, several: Iterable[Pieces]) -> None:
        """Check the size before expanding: a file of a few kB may have millions of lines in nested blocks.

        Raises `RefusedError` if there are more than `MOST` lines and texts.
        """
        if sum(self.count(pieces, ()) for pieces in several) > MOST:
            raise RefusedError("drawing-elements", Location(self.file), most=f"{MOST}")

    def count(self, pieces: Pieces, within: tuple[bytes, ...]) -> int:
        """Return the number of lines and texts, including those of all inserted blocks."""
        if len(within) > DEEPEST:
            raise RefusedError("drawing-deep", Location(self.file), most=f"{DEEPEST}")
        total = len(pieces.lines) + len(pieces.texts)
        for insertion in pieces.insertions:
            name = insertion.name
            # No program can draw a block that contains itself.
            if name in within or (inner := self.block(name)) is None:
                continue
            if name not in self.counts:
                self.counts[name] = self.count(inner, (*within, name))
            total += len(insertion.maps) * self.counts[name]
        return total

    def block(self, name: bytes) -> Pieces | None:
        """Return the content of a block relative to its base point; None if it is unknown or refers to another file."""
        block = self.contents.blocks.get(name)
        if block is None or block.external:
            return None
        if name not in self.pieces:
            pieces = self.pieces_of(block.entities)
            self.pieces[name] = _moved(pieces, Affine(c=-block.base)) if block.base else pieces
        return self.pieces[name]

    def unfolded(self, pieces: Pieces, within: tuple[bytes, ...] = ()) -> Pieces:
        """Return the lines and texts of some content with all inserted blocks expanded."""
        lines, texts = [pieces.lines], list(pieces.texts)
        for insertion in pieces.insertions:
            name = insertion.name
            if name in within or (inner := self.block(name)) is None:
                continue
            if name not in self.whole:
                self.whole[name] = self.unfolded(inner, (*within, name))
            for place in insertion.maps:
                copy = _moved(self.whole[name], place)
                lines.append(copy.lines)
                texts += copy.texts
        return Pieces(np.concatenate(lines), texts)


def _moved(pieces: Pieces, by: Affine) -> Pieces:
    texts = [replace(text, at=complex(by(np.array(text.at)))) for text in pieces.texts]
    insertions = [replace(one, maps=tuple(_after(by, place) for place in one.maps)) for one in pieces.insertions]
    return Pieces(by(pieces.lines), texts, insertions)


def _after(outer: Affine, inner: Affine) -> Affine:
    """Return the composition that applies the inner map first."""
    a = outer.a * inner.a + outer.b * inner.b.conjugate()
    b = outer.a * inner.b + outer.b * inner.a.conjugate()
    return Affine(a, b, outer.a * inner.c + outer.b * inner.c.conjugate() + outer.c)


# --- entities -------------------------------------------------------------------------------------


def _pieces(entities: list[Entity], encoding: str) -> Pieces:
    """Return the lines, texts and insertions of entities; the vertices of a polyline follow it."""
    texts: list[DrawnText] = []
    insertions: list[Insertion] = []
    lines: list[Line] = []
    corners: list[_Corner] | None = None
    polyline: Entity | None = None
    for entity in entities:
        if entity.type == b"VERTEX":
            if corners is not None and polyline is not None:
                widths = polyline.get(40), polyline.get(41)
                corners.append(
                    _Corner(_at(entity), entity.get(40, widths[0]), entity.get(41, widths[1]), _bulge(entity))
                )
            continue
        if polyline is not None and corners:
            lines += _seen(polyline, _path(corners, bool(polyline.whole(70) & 1)))
        polyline = corners = None
        if (plane := _plane(entity)) is None:
            continue
        match entity.type:
            case b"LINE":
                lines.append((_at(entity), _at(entity, 11)))
            case b"LWPOLYLINE":
                lines += _seen(entity, _path(_corners(entity), bool(entity.whole(70) & 1)))
            case b"POLYLINE" if not entity.whole(70) & (16 | 64):
                polyline, corners = entity, []
            case b"MLINE":
                lines += _path(_corners(entity, 11), bool(entity.whole(71) & 2))
            case b"SPLINE":
                lines += _straight(entity)
            case b"SOLID" | b"TRACE":
                outline = [_at(entity, code) for code in (10, 11, 13, 12) if any(tag == code for tag, _ in entity.tags)]
                lines += _seen(entity, list(pairwise([*outline, *outline[:1]])))
            case b"LEADER":
                points = [corner.at for corner in _corners(entity)]
                head = _head(points[1], points[0], 2 * BARB * abs(points[1] - points[0])) if len(points) > 1 else []
                lines += _seen(entity, [*pairwise(points), *head])
            case b"TEXT" | b"MTEXT" | b"ATTRIB":
                texts.append(_text(entity, plane, encoding))
            case b"INSERT":
                insertions.append(Insertion(entity.text(2).strip().upper(), tuple(_places(entity, plane))))
    if polyline is not None and corners:
        lines += _seen(polyline, _path(corners, bool(polyline.whole(70) & 1)))
    return Pieces(np.array(lines, dtype=complex).reshape(-1, 2), texts, insertions)


class _Corner(Record):
    """A vertex of a polyline, the widths at both ends of the segment that begins there, and True if it is an arc."""

    at: complex
    start_width: float = 0.0
    end_width: float = 0.0
    bent: bool = False


def _at(entity: Entity, code: int = 10) -> complex:
    return complex(entity.get(code), entity.get(code + 10))


def _bulge(entity: Entity) -> bool:
    return abs(entity.get(42)) > STRAIGHT


def _plane(entity: Entity) -> Affine | None:
    """Return the map of an entity's own plane; None if the plane is not seen from above."""
    x, y, z = entity.get(210), entity.get(220), entity.get(230, 1.0)
    if math.hypot(x, y) > STRAIGHT * abs(z):
        return None
    # The ends of a line are in the plane of the drawing, whatever its own plane is.
    return Affine() if z > 0 or entity.type in (b"LINE", b"LEADER", b"MLINE", b"SPLINE") else MIRROR


def _corners(entity: Entity, place: int = 10) -> list[_Corner]:
    """Return the vertices of a polyline in one entity, whose coordinate pairs have codes from `place`."""
    corners: list[_Corner] = []
    constant = entity.get(43) if entity.type == b"LWPOLYLINE" else 0.0
    x = None
    for code, value in entity.tags:
        if code == place:
            x = float(value)
        elif code == place + 10 and x is not None:
            corners.append(_Corner(complex(x, float(value)), constant, constant))
            x = None
        elif corners and code == 40 and entity.type == b"LWPOLYLINE":
            corners[-1] = replace(corners[-1], start_width=float(value))
        elif corners and code == 41 and entity.type == b"LWPOLYLINE":
            corners[-1] = replace(corners[-1], end_width=float(value))
        elif corners and code == 42 and entity.type == b"LWPOLYLINE":
            corners[-1] = replace(corners[-1], bent=abs(float(value)) > STRAIGHT)
    return corners


def _path(corners: list[_Corner], closed: bool) -> list[Line]:
    """Return the straight lines of a polyline, joined if collinear; a tapering segment draws an arrowhead."""
    ring = [*corners, *(corners[:1] if closed else ())]
    lines: list[Line] = []
    heads: list[Line] = []
    joined = False
    for first, second in pairwise(ring):
        along = second.at - first.at
        if first.bent or not along:
            joined = joined and not first.bent
            continue
        last = lines[-1][1] - lines[-1][0] if lines and joined else 0j
        if last and abs(cmath.phase(along / last)) < STRAIGHT:
            lines[-1] = (lines[-1][0], second.at)
        else:
            lines.append((first.at, second.at))
        joined = True
        if first.start_width > 2 * first.end_width:
            heads += _head(first.at, second.at, first.start_width, whole=True)
        elif first.end_width > 2 * first.start_width:
            heads += _head(second.at, first.at, first.end_width, whole=True)
    return [*lines, *heads]


def _straight(entity: Entity) -> list[Line]:
    """Return a spline as a line if all points that define it lie on one, in order; else []."""
    points = [corner.at for corner in _corners(entity)]
    if not points and not any(code in (12, 13) for code, _ in entity.tags):
        # Without end tangents, it is straight if its points lie on a line.
        points = [corner.at for corner in _corners(entity, 11)]
    if len(points) < 2 or entity.whole(70) & 1 or points[0] == points[-1]:
        return []
    span = points[-1] - points[0]
    along = [(point - points[0]) / span for point in points]
    # A control point may occur twice.
    in_order = all(second.real - first.real >= -STRAIGHT for first, second in pairwise(along))
    return [(points[0], points[-1])] if in_order and all(abs(one.imag) <= STRAIGHT for one in along) else []


def _head(back: complex, tip: complex, width: float, whole: bool = False) -> list[Line]:
    """Return the two strokes of an arrowhead, as long as its segment (`whole`) or 1.5 times its width."""
    along = (back - tip) / abs(back - tip) if back != tip else 0j
    base = back if whole else tip + 1.5 * width * along
    return [(tip, base + side * width / 2 * 1j * along) for side in (1, -1)]


def _seen(entity: Entity, lines: list[Line]) -> list[Line]:
    """Return lines of an entity's own plane as they are seen from above."""
    return [(-a.conjugate(), -b.conjugate()) for a, b in lines] if _plane(entity) is MIRROR else lines


def _places(entity: Entity, plane: Affine) -> Iterator[Affine]:
    """Yield the maps of an inserted block, for each copy in its rows and columns."""
    sx, sy = entity.get(41, 1.0), entity.get(42, 1.0)
    turn = cmath.rect(1.0, math.radians(entity.get(50)))
    rows, columns = max(entity.whole(71), 1), max(entity.whole(70), 1)
    if rows * columns > MOST:
        rows, columns = MOST + 1, 1
    for row in range(rows):
        for column in range(columns):
            apart = turn * complex(column * entity.get(44), row * entity.get(45))
            own = Affine(turn * (sx + sy) / 2, turn * (sx - sy) / 2, _at(entity) + apart)
            yield _after(plane, own)


# --- texts ----------------------------------------------------------------------------------------

_CODE = re.compile(r"\\[Uu]\+([0-9A-Fa-f]{4})")
_STACKED = re.compile(r"\\S([^;]*);")
_ORDER = re.compile(r"\\[ACFHQTWfp][^;]*;|\\[LlOoKkN~]|[{}]")
_SIGN = re.compile("%%[cdpuoCDPUO]")


def _text(entity: Entity, plane: Affine, encoding: str) -> DrawnText:
    written = b"".join(value for code, value in entity.tags if code in (3, 1))
    text = _CODE.sub(lambda code: chr(int(code[1], 16)), written.decode(encoding, "replace"))
    if entity.type == b"MTEXT":
        text = _STACKED.sub(lambda stacked: stacked[1].replace("^", "").replace(" ", ""), text)
        text = _ORDER.sub("", text.replace("\\P", "\n"))
    else:
        text = _SIGN.sub("", text)
    aligned = entity.type != b"MTEXT" and (entity.whole(72) or entity.whole(73)) and entity.whole(72) not in (3, 5)
    at = complex(plane(np.array(_at(entity, 11 if aligned else 10))))
    return DrawnText(text.strip(), at, entity.get(40))
