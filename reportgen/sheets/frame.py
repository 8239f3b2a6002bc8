"""The frame of a drawing sheet and its title block, as scenes: one source for every writer.

Sizes are those of ISO 216, the frame that of ISO 5457: a filing edge at the left, centring marks in the
middle of each side.  Letters have the heights of ISO 3098.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Literal

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, OneLine
from reportgen.assignment.reading import placed, read_model
from reportgen.base.errors import Finding
from reportgen.base.source import read_source
from reportgen.base.units import Language
from reportgen.base.words import as_error, close_or_known, templates
from reportgen.drawing import Anchor, Item, Label, Line, Pen, Polyline, Scene
from reportgen.drawing.geometry import box
from reportgen.drawing.sheet import DrawingSheet, Room, font_size
from reportgen.report.case import Opened

SIZES: Mapping[str, tuple[float, float]] = {
    "A0": (1189.0, 841.0),
    "A1": (841.0, 594.0),
    "A2": (594.0, 420.0),
    "A3": (420.0, 297.0),
}
"""Width and height of each size of paper, lying, mm."""

HEAVY, FINE, EDGE = Pen(0.7), Pen(0.35), Pen(0.18)
CENTRING = 5.0
"""How far a centring mark reaches into the frame, mm."""
HEIGHTS = (7.0, 5.0, 3.5, 2.5, 1.8)
"""Heights of capital letters, mm; the last in narrow cells of a title block only."""
PADDING = 0.6
"""White beside a text in its cell, mm."""
LEADING = 1.6
"""From line to line, in heights of capitals."""

LINE = 1.3
"""Of a line with what reaches below it, in heights of capitals."""

Align = Literal["left", "center"]


@dataclass(frozen=True, slots=True)
class BlockCell:
    """A box of a title block, its lower left corner from that of the block, with a printed text or a field."""

    x: float
    y: float
    width: float
    height: float
    text: str = ""
    letters: float = 2.5
    """Height of capitals, mm; a field that needs more room takes a smaller one."""
    align: Align = "center"
    heavy: bool = False


@dataclass(frozen=True, slots=True)
class Margins:
    """From each edge of the paper to the frame, mm."""

    left: float = 20.0
    other: float = 10.0


def room(size: str, margins: Margins, block: tuple[float, float]) -> Room:
    """What the frame and the title block leave free on a sheet."""
    width, height = SIZES[size]
    low, high = complex(margins.left, margins.other), complex(width - margins.other, height - margins.other)
    return Room(low, high, complex(*block))


def frame_scene(size: str, margins: Margins, note: str = "") -> Scene:
    """The edge of the paper, the frame and its centring marks; the format as a `note` below it."""
    width, height = SIZES[size]
    low, high = complex(margins.left, margins.other), complex(width - margins.other, height - margins.other)
    middle = (low + high) / 2
    marks = (
        (complex(0, middle.imag), complex(low.real + CENTRING, middle.imag)),
        (complex(width, middle.imag), complex(high.real - CENTRING, middle.imag)),
        (complex(middle.real, 0), complex(middle.real, low.imag + CENTRING)),
        (complex(middle.real, height), complex(middle.real, high.imag - CENTRING)),
    )
    items: tuple[Item, ...] = (
        Polyline(_corners(0j, complex(width, height)), EDGE, closed=True),
        Polyline(_corners(low, high), HEAVY, closed=True),
        *(Line(start, end, HEAVY) for start, end in marks),
        *([Label(complex(high.real, low.imag / 2), note, "right", font_size(HEIGHTS[-2]))] if note else []),
    )
    return Scene(width, height, items)


def title_block(cells: Sequence[BlockCell], size: tuple[float, float]) -> Scene:
    """The title block with its cells filled in; the texts keep inside their cells."""
    items: list[Item] = []
    for cell in cells:
        low = complex(cell.x, cell.y)
        pen = HEAVY if cell.heavy else FINE
        items.append(Polyline(_corners(low, low + complex(cell.width, cell.height)), pen, closed=True))
    items.append(Polyline(_corners(0j, complex(*size)), HEAVY, closed=True))
    items += [label for cell in cells for label in _letters(cell)]
    return Scene(*size, tuple(items))


def _corners(low: complex, high: complex) -> tuple[complex, ...]:
    return low, complex(high.real, low.imag), high, complex(low.real, high.imag)


def _letters(cell: BlockCell) -> Iterator[Label]:
    """The cell's text in the largest letters, not above its own, with which it has room."""
    if not cell.text.strip():
        # Its fields have no values.
        return
    heights = [height for height in HEIGHTS if height <= cell.letters] or [HEIGHTS[-1]]
    height, lines = next(
        ((height, lines) for height in heights if _fits(lines := _lines(cell, height), cell, height)),
        (heights[-1], [_shortened(cell, heights[-1])]),
    )
    anchor: Anchor = "left" if cell.align == "left" else "center"
    x = cell.x + (PADDING if cell.align == "left" else cell.width / 2)
    top = cell.y + cell.height / 2 + LEADING * height * (len(lines) - 1) / 2
    for number, line in enumerate(lines):
        yield Label(complex(x, top - LEADING * height * number), line, anchor, font_size(height))


def _lines(cell: BlockCell, height: float) -> list[str]:
    """The text's words in lines no wider than the cell."""
    lines: list[str] = []
    for word in cell.text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and _width(longer, height) <= cell.width - 2 * PADDING:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _fits(lines: Sequence[str], cell: BlockCell, height: float) -> bool:
    wide = max(_width(line, height) for line in lines) <= cell.width - 2 * PADDING
    return wide and (LEADING * (len(lines) - 1) + LINE) * height + 2 * PADDING <= cell.height


def _shortened(cell: BlockCell, height: float) -> str:
    """A name in one line: initials before its last word, without titles; cut where even that is too long."""
    *before, last = cell.text.split()
    short = " ".join([*(f"{word[0]}." for word in before if not word.endswith(".")), last])
    while _width(short, height) > cell.width - 2 * PADDING and len(short) > 1:
        short = short.rstrip("…")[:-1] + "…"
    return short


def _width(text: str, height: float) -> float:
    return box(text, font_size(height)).width


# --- title blocks ---------------------------------------------------------------------------------
# A file of cells in mm, whose fields are filled from `report:` of the assignment.

FOLDER = "blocks"
DEFAULT: Mapping[Language, str] = {"vi": "tcvn", "en": "iso"}
"""The block of a report's language."""
FIELDS = frozenset(
    {
        "title",
        "machine",
        "designation",
        "sheet",
        "sheets",
        "scale",
        "mass",
        "stage",
        "organisation",
        "student",
        "supervisor",
        "class",
        "date",
        "format",
    }
)
_FIELD = re.compile(rf"\{{({'|'.join(FIELDS)})\}}")

Size = Annotated[float, Decimal(Interval(above=0, most=400))]
Place = Annotated[float, Decimal(Interval(least=0, most=400))]


class _Cell(Part):
    x: Place
    y: Place
    width: Size
    height: Size
    text: OneLine = ""
    letters: Annotated[float, Decimal(Interval(least=2.5, most=20))] = 2.5
    align: Literal["left", "center"] = "center"
    heavy: Annotated[bool, Flag()] = False


class _Margins(Part):
    left: Size = 20.0
    other: Size = 10.0


class _File(Part):
    width: Size
    height: Size
    margins: _Margins = _Margins()
    format: OneLine = "{format}"
    cells: list[_Cell]


@dataclass(frozen=True, slots=True)
class TitleBlock:
    """The cells of a title block, its size in mm, and the margins of its sheets."""

    size: tuple[float, float]
    margins: Margins
    cells: tuple[BlockCell, ...]
    below: str = ""
    """What is printed below the frame: the format."""

    def scene(self, fields: Mapping[str, str]) -> Scene:
        """The block with its fields filled in; a field without a value stays blank."""
        filled = tuple(replace(cell, text=_filled(cell.text, fields)) for cell in self.cells)
        return title_block(filled, self.size)

    def note(self, fields: Mapping[str, str]) -> str:
        """What is printed below the frame."""
        return _filled(self.below, fields)


def _filled(text: str, fields: Mapping[str, str]) -> str:
    """The text with its fields filled in, in one pass: a value that looks like a field stays as it is."""
    return _FIELD.sub(lambda found: fields.get(found[1], ""), text)


def blocks(school: str = "") -> dict[str, Path]:
    """The blocks that come with the program and those of a school, by name."""
    folders = [templates() / "frames" / FOLDER, *([templates() / school / FOLDER] if school else [])]
    return {path.stem: path for folder in folders for path in sorted(folder.glob("*.yaml"))}


def read_block(path: Path, language: Language | None = None) -> TitleBlock:
    """The title block of a file.  Raises `AssignmentError` with its faults, located."""
    content = read_model(path, _File, language)
    findings = [finding for index, cell in enumerate(content.cells) for finding in _findings(cell, index, content)]
    if findings:
        raise as_error(placed(read_source(path), findings), language)
    cells = tuple(BlockCell(*(getattr(cell, name) for name in BlockCell.__slots__)) for cell in content.cells)
    margins = Margins(content.margins.left, content.margins.other)
    return TitleBlock((content.width, content.height), margins, cells, content.format)


def _findings(cell: _Cell, index: int, block: _File) -> Iterator[Finding]:
    """What is wrong with a cell beside its single values: its place, blanks alone, or an unknown field."""
    where = ("cells", index)
    if cell.x + cell.width > block.width or cell.y + cell.height > block.height:
        yield Finding("block-outside", where, {"width": f"{block.width:g}", "height": f"{block.height:g}"})
    if cell.text and not cell.text.strip():
        yield Finding("block-blank", (*where, "text"))
    for name in re.findall(r"\{([^{}]*)\}?", cell.text):
        if name not in FIELDS:
            yield Finding("block-field", (*where, "text"), {"text": name, **close_or_known(name, sorted(FIELDS))})


def numbered(sheets: Sequence[DrawingSheet], block: TitleBlock) -> list[DrawingSheet]:
    """The sheets of several parts as one set: those with a title block numbered on."""
    total, number = sum(bool(sheet.fields) for sheet in sheets), 0
    found = []
    for sheet in sheets:
        if sheet.fields:
            number += 1
            fields = {**sheet.fields, "sheet": str(number), "sheets": str(total)}
            scenes = {
                "frame": frame_scene(sheet.name, block.margins, block.note(fields)),
                "title block": block.scene(fields),
            }
            parts = (replace(part, scene=scenes.get(part.name, part.scene)) for part in sheet.parts)
            sheet = replace(sheet, parts=tuple(parts), fields=fields)
        found.append(sheet)
    return found


def fields_of(case: Opened) -> dict[str, str]:
    """What the assignment says for a title block; the sheet adds its number, scale and format."""
    given = case.assignment.report
    organisation = ", ".join(part for part in (given.university, given.faculty, given.department) if part)
    student = given.student
    date = given.date
    return {
        "machine": case.title,
        "designation": " ".join(part for part in (student.id or case.assignment.id, case.assignment.variant) if part),
        "organisation": ", ".join(part for part in (organisation, student.class_) if part),
        "student": student.name or "",
        "supervisor": given.supervisor or "",
        "class": student.class_ or "",
        "date": f"{date.day}.{date.month}.{date:%y}" if date else "",
    }
