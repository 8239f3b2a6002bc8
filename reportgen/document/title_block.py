"""Title blocks: a file of cells in mm, whose fields are filled from `report:` of the assignment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, Line
from reportgen.assignment.reading import read_model
from reportgen.case import Case
from reportgen.errors import AssignmentError, Mark, Problem
from reportgen.figures import frame
from reportgen.figures.scene import Scene
from reportgen.notation.numbers import Language
from reportgen.words import templates, word

FOLDER = "blocks"
DEFAULT: Mapping[Language, str] = {"vi": "tcvn", "en": "tcvn"}
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

    def scene(self, fields: Mapping[str, str]) -> Scene:
        """The block with its fields filled in; a field without a value stays blank."""
        filled = tuple(
            frame.Cell(c.x, c.y, c.width, c.height, _filled(c.text, fields), c.letters, c.align, c.heavy)
            for c in self.cells
        )
        return frame.title_block(filled, self.size)


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
    cells = []
    for number, cell in enumerate(content.cells, start=1):
        for problem in _faults(cell, content, number, language):
            raise AssignmentError([Problem("block-cell", problem, Mark(str(path)))])
        cells.append(frame.Cell(*(getattr(cell, name) for name in frame.Cell.__slots__)))
    margins = frame.Margins(content.margins.left, content.margins.other)
    return TitleBlock((content.width, content.height), margins, tuple(cells))


def _faults(cell: _Cell, block: _File, number: int, language: Language | None) -> list[str]:
    """What is wrong with a cell beside its single values: it leaves the block, or names an unknown field."""
    found = []
    if cell.x + cell.width > block.width or cell.y + cell.height > block.height:
        found.append(word("block_outside", language, number=number))
    unknown = _filled(cell.text, dict.fromkeys(FIELDS, ""))
    if "{" in unknown:
        found.append(word("block_field", language, number=number, known=", ".join(sorted(FIELDS))))
    return found


def fields_of(case: Case) -> dict[str, str]:
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
