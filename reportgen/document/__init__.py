"""The tree of a finished document: blocks, and the inlines inside them.

Everything that makes or writes a document uses these types. The package knows blocks and words, but no machine and no
case. Texts are plain strings exactly as they appear in print; writers escape them. Lengths are in millimetres. A
block's `key` is unique in the document, and other blocks refer to it. `document.numbering` fills in its `number`, so
that all writers print the same numbers.

`text_of` returns a document as plain text, which snapshots compare. Symbols are written base_sub^sup, numbers as
printed in the document's language, drawings by their captions.
"""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Literal, Self

from reportgen.base.languages import UnitNames, setting_of
from reportgen.base.records import Record, field, uncompared
from reportgen.base.units import Language
from reportgen.document.cjk_punctuation import set_out
from reportgen.document.inlines import DOTS as DOTS
from reportgen.document.inlines import Blank as Blank
from reportgen.document.inlines import Emph as Emph
from reportgen.document.inlines import Inline as Inline
from reportgen.document.inlines import InlineMath as InlineMath
from reportgen.document.inlines import Inlines as Inlines
from reportgen.document.inlines import LineBreak as LineBreak
from reportgen.document.inlines import Reference as Reference
from reportgen.document.inlines import Strong as Strong
from reportgen.document.inlines import Text as Text
from reportgen.document.inlines import Value as Value
from reportgen.drawing import Scene
from reportgen.formula import Expression
from reportgen.formula.plain_text import formula, quantity

# --- blocks ---------------------------------------------------------------------------------------


@uncompared("opens")
class Section(Record):
    """A heading; level 1 is a part of the report, 4 is a run-in heading.

    `numbered=False` is for a foreword, a conclusion and the like, which are listed in the contents but not counted. A
    heading that begins a section of the templates has its name in `opens`, which is not printed.
    """

    level: int
    title: Inlines
    key: str = ""
    numbered: bool = True
    number: str = ""
    opens: str = ""


class Paragraph(Record):
    """A paragraph of inlines; `align` is "" for the document's usual alignment."""

    inlines: Inlines
    align: Literal["", "center", "right"] = ""


class List(Record):
    """A list whose items are blocks; an `ordered` one counts from `start`."""

    items: tuple[tuple[Block, ...], ...]
    ordered: bool = False
    start: int = 1


class Equation(Record):
    """One or more displayed lines; each row is one expression.

    With a `key` the group is numbered, once, on its last row. A row too wide for the text block is
    broken by the writers before an "=" of its chain, aligned after the first.
    """

    rows: tuple[Expression, ...]
    key: str = ""
    number: str = ""


TEXT_WIDTH = 160.0
"""Width of the text on an A4 page (mm)."""
FIRST_COLUMN = 16.0
"""Width (mm) of the column of a table that names the positions."""


class Column(Record):
    """A column of a table: its width (mm) and the alignment of its cells."""

    width: float
    align: Literal["left", "center", "right"] = "center"


class Cell(Record):
    """A cell of a table; `span` is the number of columns that it covers."""

    inlines: Inlines = ()
    span: int = 1


class Table(Record):
    """A ruled table; where it continues on the next page, its number and its `head` rows are repeated.

    A cell spans columns only; one across the whole table is a heading of the rows below it. A `framed` table has a
    frame around its head and rows, like a boxed answer. If it continues over pages, the last page has at least `last`
    rows.
    """

    columns: tuple[Column, ...]
    head: tuple[tuple[Cell, ...], ...]
    rows: tuple[tuple[Cell, ...], ...]
    caption: Inlines = ()
    key: str = ""
    number: str = ""
    framed: bool = False
    last: int = 3


class Figure(Record):
    """One scene, or several side by side in rows as they fit, with one caption, in true size.

    If the page has no room for it, the text continues to the end of the page before it. A figure `turned` by 90° has
    its own page. `at` is the label of the position that it shows, or "". A figure marked `here` keeps its place between
    tables that continue over pages.
    """

    scenes: tuple[Scene, ...]
    caption: Inlines = ()
    key: str = ""
    number: str = ""
    turned: bool = False
    at: str = ""
    here: bool = False
    rest: str = ""
    """Number of the table that has the facts of its drawings and more; numbering fills it in if there is one."""


class Plate(Record):
    """A figure on a separate page of its paper size (mm), too large in true size for the A4 text block, even turned.

    Plates are collected at the end of their chapter. With `continues`, it is a further page of the figure before it,
    whose number it shares. `at` is the label of the position that it shows, or ""; `rest` is as in a figure.
    """

    scene: Scene
    paper: tuple[float, float]
    caption: Inlines = ()
    key: str = ""
    number: str = ""
    continues: bool = False
    at: str = ""
    rest: str = ""


class Cover(Record):
    """The title page: institution lines on top, title lines in the middle, labelled fields, place and date."""

    institution: tuple[str, ...]
    title: tuple[str, ...]
    subtitle: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    """(label, value); an empty value prints a dotted line to fill in."""
    place_and_date: str


class Contents(Record):
    """Table of contents with true page numbers: levels 1 to 3, or `brief`, levels 1 and 2.

    It has separate pages unless `alone` is False: then the document continues below it. If it is `short`, it certainly
    has room on one page.
    """

    title: str
    brief: bool = False
    alone: bool = True
    short: bool = False


class BlankLine(Record):
    """A dotted line to write on."""

    label: str = ""


class Listing(Record):
    """Lines of a program, printed verbatim in a monospaced font."""

    lines: tuple[str, ...]


class PageBreak(Record):
    """The end of a page."""


Block = (
    Section | Paragraph | List | Equation | Table | Figure | Plate | Cover | Contents | BlankLine | Listing | PageBreak
)


class Words(Record):
    """The few words that writers themselves print, in the report's language."""

    figure: str
    table: str
    contents: str
    page: str
    continued: str
    """Printed after the number of a table or plate that continues from the page before."""
    part: str
    """Label of a later part of a figure, on any page: part 2."""
    save: str
    """Label of the buttons below a figure on a page."""
    speech: Mapping[str, Any] = field(default_factory=dict)
    """Spoken words of formulas; units by their printed signs."""
    phrases: Mapping[str, str] = field(default_factory=dict)
    """Phrases of the descriptions of drawings, by name."""

    @classmethod
    def among(cls, words: Mapping[str, Any], language: Language) -> Self:
        """Return the document's words from all words of a language; a school may add more."""
        speech, printed = words["speech"], UnitNames({**setting_of(language).units, **words["units"]})
        units = {printed.get(unit, unit): said for unit, said in speech["units"].items()}
        own = words["document"] | {"speech": {**speech, "units": units}, "phrases": words["told"]}
        return cls(*(own[name] for name in cls.__struct_fields__))


class Document(Record):
    """A finished report: its blocks in order, and the texts that every page carries."""

    language: Language
    title: str
    author: str
    header: tuple[str, str]
    """Left and right text of the running header (not on the cover)."""
    footer: tuple[str, str]
    """Left text of the running footer, and the word before the page number."""
    words: Words
    blocks: tuple[Block, ...] = ()
    close: bool = False
    """True if it is set in smaller type with less room between lines and blocks."""
    date: datetime.date | None = None
    """Date of the document, or None if its file does not give one."""


def text_of(document: Document) -> str:
    """Return all text of a document, a line for each heading, paragraph, row and formula."""
    return "\n".join(line for block in document.blocks for line in lines_of(block, document)) + "\n"


def lines_of(block: Block, document: Document) -> Iterator[str]:
    """Yield the lines of one block as plain text, in the words and the language of its document."""
    language, words = document.language, document.words
    match block:
        case Section(_, title, number=number):
            yield f"{number} {plain(title, language)}".strip()
        case Paragraph(inlines):
            yield plain(inlines, language)
        case List(items, ordered, start):
            for index, item in enumerate(items):
                mark = f"{start + index}." if ordered else "•"
                for i, line in enumerate(line for inner in item for line in lines_of(inner, document)):
                    yield f"{mark} {line}" if i == 0 else f"{' ' * len(mark)} {line}"
        case Equation(rows, number=number):
            for row in rows:
                yield formula(row, language) + (f"  ({number})" if number and row is rows[-1] else "")
        case Table(_, head, rows):
            yield from _caption(block, words, language)
            for cells in (*head, *rows):
                yield _row(cells, language)
        case Plate(continues=True):
            yield f"{words.figure} {block.number}{setting_of(language).aside(words.continued)}"
        case Figure() | Plate():
            yield from _caption(block, words, language)
        case Cover(institution, title_lines, subtitle, fields, place_and_date):
            yield from (*institution, *title_lines, *subtitle)
            yield from (f"{label}{setting_of(language).colon}{value or '…'}" for label, value in fields)
            yield place_and_date
        case Contents(heading):
            yield heading
        case BlankLine(label):
            yield f"{label} …".strip()
        case Listing(code):
            yield from code
        case PageBreak():
            pass


def _caption(block: Table | Figure | Plate, words: Words, language: Language) -> Iterator[str]:
    if block.number or block.caption:
        word = words.table if isinstance(block, Table) else words.figure
        yield f"{word} {block.number}{setting_of(language).stop} {plain(block.caption, language)}".strip()


def _row(cells: tuple[Cell, ...], language: Language) -> str:
    return " | ".join(plain(cell.inlines, language) for cell in cells)


def listed(parts: Iterable[Inline]) -> Inlines:
    """Return inlines side by side, separated by commas."""
    return tuple(one for index, part in enumerate(parts) for one in ((Text(", "), part) if index else (part,)))


def plain(inlines: Inlines, language: Language) -> str:
    """Return inlines as plain text in one line, with the punctuation of the language."""
    result = []
    for inline in set_out(inlines, language):
        match inline:
            case Text(text) | Reference(text=text):
                result.append(text)
            case Emph(of) | Strong(of):
                result.append(plain(of, language))
            case InlineMath(expression):
                result.append(formula(expression, language))
            case Value(number):
                result.append(quantity(number, language))
            case LineBreak():
                result.append(" ")
            case Blank():
                result.append(DOTS)
    return "".join(result)
