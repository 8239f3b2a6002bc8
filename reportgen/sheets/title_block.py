"""Frame and title block of a drawing sheet as scenes, the common source of all writers; title block files.

Sizes are those of ISO 216. The frame is that of ISO 5457, with a filing edge on the left and centring marks in the
middle of each side. Letters have the heights of ISO 3098.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Literal

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, OneLine
from reportgen.assignment.reading import placed, read_model
from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.base.words import as_error, close_or_known
from reportgen.base.yaml_source import read_source
from reportgen.case import Case
from reportgen.drawing import Anchor, Description, Item, Label, Line, Pen, Polyline, Scene
from reportgen.drawing.drawing_description import fact
from reportgen.drawing.drawing_sheet import DrawingSheet, PlacedScene, Room, font_size
from reportgen.drawing.label_size import box

SIZES: Mapping[str, tuple[float, float]] = {
    "A0": (1189.0, 841.0),
    "A1": (841.0, 594.0),
    "A2": (594.0, 420.0),
    "A3": (420.0, 297.0),
}
"""Width and height (mm) of each paper size in landscape."""

HEAVY, FINE, EDGE = Pen(0.7), Pen(0.35), Pen(0.18)
CENTRING = 5.0
"""Length of a centring mark inside the frame, mm."""
HEIGHTS = (7.0, 5.0, 3.5, 2.5, 1.8)
"""Heights of capital letters, mm; the last in narrow cells of a title block only."""
NARROW = 0.75
"""Smallest share of their width to which letters are narrowed before smaller ones are used, like type A beside B."""
PADDING, BESIDE = 0.6, 0.25
"""White space around a text in its cell (mm), and at least this share of its height before and after it."""
LEADING = 1.6
"""Distance between lines, in heights of capitals."""

LINE = 1.3
"""Height of a line with its descenders, in heights of capitals."""

Align = Literal["left", "center"]


class BlockCell(Record):
    """A cell of a title block with a printed text or a field; x and y (mm) lead from the block's lower left corner."""

    x: float
    y: float
    width: float
    height: float
    text: str = ""
    letters: float = 2.5
    """Height of capitals, mm; a field that needs more room takes a smaller one."""
    align: Align = "center"
    heavy: bool = False
    turned: bool = False
    """True if the text goes upwards."""


class Margins(Record):
    """Distances (mm) from the edges of the paper to the frame; `other` is for all edges but the left one."""

    left: float = 20.0
    other: float = 10.0


FRAME = "frame"
"""Layer of the items that belong to the sheet itself."""


def room(size: str, block: TitleBlock) -> Room:
    """Return the room that the frame and the title block leave free on a sheet."""
    low, high = _frame(size, block.margins)
    return Room(low, high, complex(*block.size))


def _frame(size: str, margins: Margins) -> tuple[complex, complex]:
    """Return the lower left and the upper right corner of the frame."""
    width, height = SIZES[size]
    return complex(margins.left, margins.other), complex(width - margins.other, height - margins.other)


def frame_scene(size: str, block: TitleBlock, fields: Mapping[str, str]) -> Scene:
    """Return the paper's edge, the frame with its centring marks, the columns beside it, and the format below it."""
    width, height = SIZES[size]
    low, high = _frame(size, block.margins)
    middle = (low + high) / 2
    marks = (
        (complex(0, middle.imag), complex(low.real + CENTRING, middle.imag)),
        (complex(width, middle.imag), complex(high.real - CENTRING, middle.imag)),
        (complex(middle.real, 0), complex(middle.real, low.imag + CENTRING)),
        (complex(middle.real, height), complex(middle.real, high.imag - CENTRING)),
    )
    note = _filled(block.below, fields)
    # Columns of the upper half are counted from the top.
    beside = [
        replace(cell, x=low.real + cell.x, y=(low.imag if cell.y >= 0 else high.imag) + cell.y, text=text)
        for cell, text in ((cell, _filled(cell.text, fields)) for cell in block.beside)
    ]
    items: tuple[Item, ...] = (
        Polyline(_corners(0j, complex(width, height)), EDGE, closed=True),
        Polyline(_corners(low, high), HEAVY, closed=True),
        *(Line(start, end, HEAVY) for start, end in marks),
        *_cells(beside),
        *([Label(complex(high.real, low.imag / 2), note, "right", font_size(HEIGHTS[-2]))] if note else []),
    )
    return Scene(width, height, items, description=_description(items))


def title_block(cells: Sequence[BlockCell], size: tuple[float, float]) -> Scene:
    """Return a title block of a size (mm) with its cells filled in; the texts stay inside their cells."""
    outline = Polyline(_corners(0j, complex(*size)), HEAVY, closed=True)
    items = tuple(_cells(cells))
    return Scene(*size, (*items, outline), description=_description(items))


def _description(items: Iterable[Item]) -> Description:
    """Return a description with the texts of a frame, in the order of its cells."""
    return tuple(fact("line", item.content) for item in items if isinstance(item, Label))


def _cells(cells: Sequence[BlockCell]) -> Iterator[Item]:
    """Yield the boxes of some cells, then their texts."""
    for cell in cells:
        low, pen = complex(cell.x, cell.y), HEAVY if cell.heavy else FINE
        yield Polyline(_corners(low, low + complex(cell.width, cell.height)), pen, closed=True)
    for cell in cells:
        # Of a cell whose fields have no values nothing is written.
        if cell.text.strip():
            yield from _letters(cell)


def _corners(low: complex, high: complex) -> tuple[complex, ...]:
    return low, complex(high.real, low.imag), high, complex(low.real, high.imag)


def _letters(cell: BlockCell) -> Iterator[Label]:
    """Yield the cell's text in the largest letters that fit, not above the cell's own.

    It may take several lines; sizes at which letters need not be narrower come first. In the smallest size the whole
    text is kept: its letters are as narrow as necessary.
    """
    along, across = (cell.height, cell.width) if cell.turned else (cell.width, cell.height)
    heights = [height for height in HEIGHTS if height <= cell.letters] or [HEIGHTS[-1]]
    tried = [_broken(cell.text, height, along - 2 * _beside(height), across - 2 * PADDING) for height in heights]
    height, lines, narrow = next((one for one in tried if one[2] >= NARROW), tried[-1])
    anchor: Anchor = "left" if cell.align == "left" else "center"
    u = 1j if cell.turned else 1 + 0j
    middle = complex(cell.x + cell.width / 2, cell.y + cell.height / 2)
    start = middle - u * (along / 2 - _beside(height)) if cell.align == "left" else middle
    for number, line in enumerate(lines):
        down = LEADING * height * (number - (len(lines) - 1) / 2)
        yield Label(start - 1j * u * down, line, anchor, font_size(height), 90 * cell.turned, narrow=narrow)


def _beside(height: float) -> float:
    """Return the white space (mm) before and after a text in letters of a height (mm)."""
    return max(PADDING, BESIDE * height)


def _broken(text: str, height: float, along: float, across: float) -> tuple[float, list[str], float]:
    """Return how a text fits a cell of `along` × `across` mm: height of letters, lines, and narrowing (≤ 1)."""
    most = max(int((across / height - LINE) / LEADING) + 1, 1) if across >= LINE * height else 0
    words = text.split()
    best = (height, [text], 0.0)
    for count in range(1, min(most, len(words)) + 1):
        lines = _evenly(words, count, height)
        narrow = min(along / max(_width(line, height) for line in lines), 1.0)
        if narrow > best[2]:
            best = height, lines, narrow
    return best


def _evenly(words: Sequence[str], count: int, height: float) -> list[str]:
    """Return words in `count` lines, the longest of them as short as possible."""
    if count == 1:
        return [" ".join(words)]
    divisions = (
        [" ".join(words[:first]), *_evenly(words[first:], count - 1, height)]
        for first in range(1, len(words) - count + 2)
    )
    return min(divisions, key=lambda lines: max(_width(line, height) for line in lines))


def _width(text: str, height: float) -> float:
    return box(text, font_size(height)).width


# --- title blocks ---------------------------------------------------------------------------------
# A file of cells in mm, whose fields are filled from `report:` and `sheet:` of the assignment.

FOLDER = "blocks"
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
        "course",
        "variant",
    }
)
_FIELD = re.compile(rf"\{{({'|'.join(FIELDS)})\}}")

Size = Annotated[float, Decimal(Interval(above=0, most=400))]
SheetPosition = Annotated[float, Decimal(Interval(least=0, most=400))]


class _Cell(Part):
    x: SheetPosition
    y: SheetPosition
    width: Size
    height: Size
    text: OneLine = ""
    letters: Annotated[float, Decimal(Interval(least=2.5, most=20))] = 2.5
    align: Align = "center"
    heavy: Annotated[bool, Flag()] = False
    turned: Annotated[bool, Flag()] = False


class _SideCell(_Cell):
    """A cell beside the frame, from its lower left corner, or from its upper one if y is negative."""

    x: Annotated[float, Decimal(Interval(least=-40, most=0))]
    y: Annotated[float, Decimal(Interval(least=-400, most=400))]


class _Margins(Part):
    left: Size = 20.0
    other: Size = 10.0


class _Block(Part):
    width: Size
    height: Size
    cells: list[_Cell]


class _File(_Block):
    margins: _Margins = _Margins()
    format: OneLine = "{format}"
    designation: OneLine = "{course}.{variant}.{sheet}"
    beside: tuple[_SideCell, ...] = ()
    following: _Block | None = None


class TitleBlock(Record):
    """The cells of a title block, its size in mm, and the margins of its sheets."""

    size: tuple[float, float]
    margins: Margins
    cells: tuple[BlockCell, ...]
    below: str = ""
    """Text below the frame: the format."""
    beside: tuple[BlockCell, ...] = ()
    """Columns beside the frame."""
    designation: str = ""
    """Designation of a sheet if the assignment does not give it."""
    following: TitleBlock | None = None
    """Block of all sheets but the first, or None if it is the same."""

    def scene(self, fields: Mapping[str, str]) -> Scene:
        """Return the block with its fields filled in; a field without a value stays blank."""
        filled = tuple(replace(cell, text=_filled(cell.text, fields)) for cell in self.cells)
        return title_block(filled, self.size)


def _filled(text: str, fields: Mapping[str, str]) -> str:
    """Return the text with its fields filled in once: a value that looks like a field is not filled in again."""
    return _FIELD.sub(lambda found: fields.get(found[1], ""), text)


def blocks(school: Path | str = "", language: Language | None = None) -> dict[str, Path]:
    """Return the title blocks of the program and those of a school, by name.

    A block may have a separate file for a language, whose code is in the file's name: gb.zh.yaml.
    """
    folders = [templates() / "frames" / FOLDER, *([templates() / school / FOLDER] if school else [])]
    files = [(path.stem.partition("."), path) for folder in folders for path in sorted(folder.glob("*.yaml"))]
    usual = {name: path for (name, _, of), path in files if not of}
    return usual | {name: path for (name, _, of), path in files if of and of == language}


def read_block(path: Path, language: Language | None = None) -> TitleBlock:
    """Return the title block of a file; raise `AssignmentError` with all its faults, located."""
    content = read_model(path, _File, language)
    findings = [*_findings(content, ()), *(_findings(content.following, ("following",)) if content.following else ())]
    findings += [finding for index, cell in enumerate(content.beside) for finding in _texts(cell, ("beside", index))]
    if findings:
        raise as_error(placed(read_source(path), findings), language)
    margins = Margins(content.margins.left, content.margins.other)
    first = TitleBlock(
        (content.width, content.height),
        margins,
        _cells_of(content.cells),
        content.format,
        beside=_cells_of(content.beside),
        designation=content.designation,
    )
    if content.following is None:
        return first
    size = content.following.width, content.following.height
    return replace(first, following=replace(first, size=size, cells=_cells_of(content.following.cells)))


def _cells_of(cells: Sequence[_Cell]) -> tuple[BlockCell, ...]:
    return tuple(BlockCell(*(getattr(cell, name) for name in BlockCell.__struct_fields__)) for cell in cells)


def _findings(block: _Block, at: Where) -> Iterator[Finding]:
    """Yield the faults of a block's cells, except those of their single values."""
    for index, cell in enumerate(block.cells):
        where = (*at, "cells", index)
        if cell.x + cell.width > block.width or cell.y + cell.height > block.height:
            yield Finding("block-outside", where, {"width": f"{block.width:g}", "height": f"{block.height:g}"})
        yield from _texts(cell, where)


def _texts(cell: _Cell, where: Where) -> Iterator[Finding]:
    """Yield the faults of a cell's text: blanks alone, or an unknown field."""
    if cell.text and not cell.text.strip():
        yield Finding("block-blank", (*where, "text"))
    for name in re.findall(r"\{([^{}]*)\}?", cell.text):
        if name not in FIELDS:
            yield Finding("block-field", (*where, "text"), {"text": name, **close_or_known(name, sorted(FIELDS))})


def framed(parts: Iterable[PlacedScene], form: TitleBlock, fields: Mapping[str, str]) -> DrawingSheet:
    """Return a sheet with its frame and its title block.

    From the second sheet on, this is the `following` block if there is one.
    """
    paper = fields["format"]
    own = form if fields["sheet"] == "1" or form.following is None else form.following
    space = room(paper, own)
    corner = complex(space.high.real - own.size[0], space.low.imag)
    placed = (
        PlacedScene("frame", FRAME, frame_scene(paper, form, fields)),
        PlacedScene("title block", FRAME, own.scene(fields), corner),
    )
    return DrawingSheet(paper, *SIZES[paper], (*placed, *parts), fields)


def numbered(sheets: Sequence[DrawingSheet], form: TitleBlock, designation: str) -> list[DrawingSheet]:
    """Return the sheets of several parts as one set.

    Sheets with a title block are numbered consecutively, and all get the `designation` if one is given.
    """
    total, number = sum(bool(sheet.fields) for sheet in sheets), 0
    numbered_on = []
    for sheet in sheets:
        if sheet.fields:
            number += 1
            fields = {
                "designation": designation or _filled(form.designation, {**sheet.fields, "sheet": f"{number:02}"})
            }
            fields |= {"sheet": str(number), "sheets": str(total)}
            parts = (part for part in sheet.parts if part.layer != FRAME)
            sheet = framed(parts, form, {**sheet.fields, **fields})
        numbered_on.append(sheet)
    return numbered_on


def fields_of(case: Case, block: TitleBlock, number: int) -> dict[str, str]:
    """Return the assignment's fields for the title block of a sheet; the layout adds the sheets' count and format."""
    given, variant = case.assignment.report, case.assignment.variant
    organisation = ", ".join(part for part in (given.university, given.faculty, given.department) if part)
    student, date = given.student, given.date
    initials = "".join(word[0] for word in case.course.split())
    course = case.assignment.sheet.course or initials.upper()
    parts = {
        "course": course,
        "variant": variant.zfill(2) if variant.isdigit() else variant or "00",
        "sheet": f"{number:02}",
    }
    return {
        **parts,
        "machine": case.title,
        "designation": case.assignment.sheet.designation or _filled(block.designation, parts),
        "organisation": ", ".join(part for part in (organisation, student.class_) if part),
        "student": student.name or "",
        "supervisor": given.supervisor or "",
        "class": student.class_ or "",
        "date": f"{date:%d.%m.%y}" if date else "",
        "scale": case.words["plates"]["scale"],
        "sheet": str(number),
    }
