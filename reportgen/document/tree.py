"""The document as data: blocks and inlines that every writer renders and none computes.

All texts are plain strings exactly as they shall appear; writers escape.  Lengths are millimetres.
`key` names a block for references and is unique in the document; `number` is filled in by
`document.numbering` and printed by the writers as it stands, so all writers number alike.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from reportgen.figures.scene import Scene
from reportgen.notation.expressions import Expression, Number
from reportgen.notation.numbers import Language

# --- inlines --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Text:
    text: str


@dataclass(frozen=True, slots=True)
class Emph:
    of: tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class Strong:
    of: tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class InlineMath:
    """A symbol or a short formula inside a line."""

    expression: Expression


@dataclass(frozen=True, slots=True)
class Value:
    """A number with its unit inside a line or a table cell."""

    number: Number


@dataclass(frozen=True, slots=True)
class Reference:
    """The number of the block called `key`, linked; `text` is filled in by numbering."""

    key: str
    text: str = ""


@dataclass(frozen=True, slots=True)
class LineBreak:
    pass


Inline = Text | Emph | Strong | InlineMath | Value | Reference | LineBreak
Inlines = tuple[Inline, ...]

# --- blocks ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Section:
    """A heading; level 1 is a part of the report and starts a page, 4 is a run-in heading.

    `numbered=False` is for foreword, conclusion and the like: listed in the contents, not counted.
    """

    level: int
    title: Inlines
    key: str = ""
    numbered: bool = True
    number: str = ""


@dataclass(frozen=True, slots=True)
class Paragraph:
    inlines: Inlines
    align: Literal["", "center", "right"] = ""


@dataclass(frozen=True, slots=True)
class List:
    """Items are blocks; `ordered` counts from `start`."""

    items: tuple[tuple[Block, ...], ...]
    ordered: bool = False
    start: int = 1


@dataclass(frozen=True, slots=True)
class Equation:
    """One or more displayed lines; each row is one expression.

    With a `key` the group is numbered, once, on its last row.  A row too wide for the text block is
    broken by the writers before an "=" of its chain, aligned after the first.
    """

    rows: tuple[Expression, ...]
    key: str = ""
    number: str = ""


TEXT_WIDTH = 160.0
"""What of an A4 page text takes across (mm)."""
FIRST_COLUMN = 16.0
"""The column of a table that names the positions (mm)."""


@dataclass(frozen=True, slots=True)
class Column:
    width: float
    align: Literal["left", "center", "right"] = "center"


@dataclass(frozen=True, slots=True)
class Cell:
    inlines: Inlines = ()
    span: int = 1


@dataclass(frozen=True, slots=True)
class Table:
    """A ruled table; `head` rows repeat where it continues on the next page.  A cell spans columns only."""

    columns: tuple[Column, ...]
    head: tuple[tuple[Cell, ...], ...]
    rows: tuple[tuple[Cell, ...], ...]
    caption: Inlines = ()
    key: str = ""
    number: str = ""


@dataclass(frozen=True, slots=True)
class Figure:
    """One scene, or several side by side in rows as they fit, under one caption, in true size."""

    scenes: tuple[Scene, ...]
    caption: Inlines = ()
    key: str = ""
    number: str = ""


@dataclass(frozen=True, slots=True)
class Plate:
    """A figure on a page of its own paper size (mm), for what the A4 text block cannot hold in true size."""

    scene: Scene
    paper: tuple[float, float]
    caption: Inlines = ()
    key: str = ""
    number: str = ""


@dataclass(frozen=True, slots=True)
class Cover:
    """The title page: institution lines on top, title lines in the middle, labelled fields, place and date."""

    institution: tuple[str, ...]
    title: tuple[str, ...]
    subtitle: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    """(label, value); an empty value prints a dotted line to fill in."""
    place_and_date: str


@dataclass(frozen=True, slots=True)
class Contents:
    """The table of contents (levels 1 to 3) with true page numbers."""

    title: str


@dataclass(frozen=True, slots=True)
class BlankLine:
    """A dotted line to write on."""

    label: str = ""


@dataclass(frozen=True, slots=True)
class PageBreak:
    pass


Block = (
    Section | Paragraph | List | Equation | Table | Figure | Plate | Cover | Contents | BlankLine | PageBreak
)


@dataclass(frozen=True, slots=True)
class Words:
    """The few words writers themselves print, in the report's language."""

    figure: str
    table: str
    contents: str
    page: str


@dataclass(frozen=True, slots=True)
class Document:
    """A finished report: its blocks in order and what every page carries."""

    language: Language
    title: str
    author: str
    header: tuple[str, str]
    """Left and right text of the running header (not on the cover)."""
    footer: tuple[str, str]
    """Left text of the running footer, and the word before the page number."""
    words: Words
    blocks: tuple[Block, ...] = field(default=())
