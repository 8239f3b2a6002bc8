"""Title blocks: a file of cells in mm, whose fields are filled from `report:` of the assignment."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Literal

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, Line
from reportgen.assignment.reading import placed, read_model
from reportgen.case import Opened
from reportgen.errors import Finding
from reportgen.figures import frame
from reportgen.figures.scene import Scene
from reportgen.notation.numbers import Language
from reportgen.source import read_source
from reportgen.words import as_error, close_or_known, templates

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

Size = Annotated[float, Decimal(Interval(above=0, most=400))]
Place = Annotated[float, Decimal(Interval(least=0, most=400))]


class _Cell(Part):
    x: Place
    y: Place
    width: Size
    height: Size
    text: Line = ""
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
    format: Line = "{format}"
    cells: list[_Cell]


@dataclass(frozen=True, slots=True)
class TitleBlock:
    """The cells of a title block, its size in mm, and the margins of its sheets."""

    size: tuple[float, float]
    margins: frame.Margins
    cells: tuple[frame.Cell, ...]
    below: str = ""
    """What is printed below the frame: the format."""

    def scene(self, fields: Mapping[str, str]) -> Scene:
        """The block with its fields filled in; a field without a value stays blank."""
        filled = tuple(replace(cell, text=_filled(cell.text, fields)) for cell in self.cells)
        return frame.title_block(filled, self.size)

    def note(self, fields: Mapping[str, str]) -> str:
        """What is printed below the frame."""
        return _filled(self.below, fields)


def _filled(text: str, fields: Mapping[str, str]) -> str:
    for name in FIELDS:
        text = text.replace(f"{{{name}}}", fields.get(name, ""))
    return text


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
    cells = tuple(frame.Cell(*(getattr(cell, name) for name in frame.Cell.__slots__)) for cell in content.cells)
    margins = frame.Margins(content.margins.left, content.margins.other)
    return TitleBlock((content.width, content.height), margins, cells, content.format)


def _findings(cell: _Cell, index: int, block: _File) -> Iterator[Finding]:
    """What is wrong with a cell beside its single values: it leaves the block, or names an unknown field."""
    where = ("cells", index)
    if cell.x + cell.width > block.width or cell.y + cell.height > block.height:
        yield Finding("block-outside", where, {"width": f"{block.width:g}", "height": f"{block.height:g}"})
    for name in re.findall(r"\{([^{}]*)\}?", cell.text):
        if name not in FIELDS:
            yield Finding("block-field", (*where, "text"), {"text": name, **close_or_known(name, sorted(FIELDS))})


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
