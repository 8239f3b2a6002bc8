"""Document → LaTeX → PDF: the words and numbers of the tree, the looks of the frame.

The body is PyLaTeX fragments and short macros that the Jinja2 frame `templates/frames/latex` defines.
Contents, links and outline use pdfTeX's own primitives: the titles are known here, so that only page
numbers wait for a second pass.
"""

from __future__ import annotations

import hashlib
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from reportgen.document.prose import template_root
from reportgen.document.tree import (
    BlankLine,
    Block,
    Cell,
    Column,
    Contents,
    Cover,
    Document,
    Emph,
    Equation,
    Figure,
    Inline,
    InlineMath,
    Inlines,
    LineBreak,
    List,
    PageBreak,
    Paragraph,
    Plate,
    Reference,
    Section,
    Strong,
    Table,
    Text,
    Value,
)
from reportgen.figures.scene import Scene
from reportgen.paint.tex import paint
from reportgen.writers.latex_math import aligned, mathematics
from reportgen.writers.latex_text import declarations, escape
from reportgen.writers.pdflatex import Compiled, compile, overfull

if TYPE_CHECKING:
    from jinja2 import Template

__all__ = ["Compiled", "compile", "overfull", "render", "write"]

CONTENTS_LEVEL = 3
"""The deepest level of heading that the contents and the outline list."""

TEXT_WIDTH = 160
SCENE_GAP = 4
"""Millimetres: the width of the text block, and between scenes of a row."""

UNBROKEN_ROWS = 12
"""A table of at most so many rows stays on one page."""


def write(document: Document) -> str:
    """The complete LaTeX source, which compiles as it stands.

    Raises `TypesetterError` for a character the fonts do not have.
    """
    body = _Writer(document).body()
    return _frame().render(
        title=_hexadecimal(document.title),
        author=_hexadecimal(document.author),
        identity=hashlib.sha256(body.encode()).hexdigest()[:32],
        language=document.language,
        header=[escape(text) for text in document.header],
        footer=[escape(text) for text in document.footer],
        characters=declarations(),
        body=body,
    )


def render(document: Document) -> bytes:
    """The finished PDF; the same document gives the same bytes.

    Raises `TypesetterError` as `write` and `compile` do.
    """
    return compile(write(document)).pdf


@cache
def _frame() -> Template:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(template_root() / "frames" / "latex"),
        block_start_string="<%",
        block_end_string="%>",
        variable_start_string="<(",
        variable_end_string=")>",
        comment_start_string="<#",
        comment_end_string="#>",
        trim_blocks=True,
        undefined=StrictUndefined,
        autoescape=False,
    )
    return environment.get_template("report.tex.j2")


def _hexadecimal(text: str) -> str:
    """A text as a PDF string's content in UTF-16, in hexadecimal digits."""
    return "FEFF" + unicodedata.normalize("NFC", text).encode("utf-16-be").hex().upper()


def _command(name: str, *arguments: str) -> str:
    from pylatex import Command, NoEscape

    source: str = Command(name, arguments=[NoEscape(argument) for argument in arguments]).dumps()
    return source


@dataclass(frozen=True, slots=True)
class _Entry:
    """A heading as contents and outline need it; `below` counts the headings directly under it."""

    section: Section
    place: str
    below: int


class _Writer:
    """The blocks of one document as LaTeX; holds what a block must know of the others."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.language = document.language
        self.entries = {id(entry.section): entry for entry in _entries(document.blocks)}
        self.places: Mapping[str, str] = {
            **{key: f"k{index}" for index, key in enumerate(_keys(document.blocks))},
            **{entry.section.key: entry.place for entry in self.entries.values() if entry.section.key},
        }

    def body(self) -> str:
        return self.blocks(self.document.blocks)

    def blocks(self, blocks: Sequence[Block]) -> str:
        return "\n".join(map(self.block, blocks))

    def block(self, block: Block) -> str:
        match block:
            case Section():
                return self.section(block)
            case Paragraph(inlines, align):
                return self.paragraph(self.inlines(inlines), align)
            case List():
                return self.list(block)
            case Equation():
                return self.equation(block)
            case Table():
                return self.table(block)
            case Figure():
                return self.figure(block)
            case Plate(scene, (width, height)):
                caption = self.caption(self.document.words.figure, block)
                painted = paint(scene, self.language)
                return _command("plate", f"{width:g}mm", f"{height:g}mm", painted, caption)
            case Cover():
                return self.cover(block)
            case Contents(title):
                return self.contents(title)
            case BlankLine(label):
                return _command("blankline", escape(label) + r"\ " if label else "")
            case PageBreak():
                return r"\clearpage"

    # --- inlines ----------------------------------------------------------------------------------

    def inlines(self, inlines: Inlines) -> str:
        return "".join(map(self.inline, inlines))

    def inline(self, inline: Inline) -> str:
        match inline:
            case Text(text):
                return escape(text)
            case Emph(of):
                return rf"\emph{{{self.inlines(of)}}}"
            case Strong(of):
                return rf"\textbf{{{self.inlines(of)}}}"
            case InlineMath(expression):
                return f"${mathematics(expression, self.language)}$"
            case Value(number):
                return f"${mathematics(number, self.language)}$"
            case Reference(key, text):
                place = self.places.get(key)
                return rf"\link{{{place}}}{{{escape(text)}}}" if place else escape(text)
            case LineBreak():
                return r"\newline "

    def paragraph(self, source: str, align: str) -> str:
        if not align:
            return f"\n{source}\n"
        from pylatex import Center, FlushRight, NoEscape

        environment = Center if align == "center" else FlushRight
        return str(environment(data=NoEscape(source.replace(r"\newline ", r"\\[0pt] "))).dumps())

    # --- structure --------------------------------------------------------------------------------

    def section(self, section: Section) -> str:
        entry = self.entries.get(id(section))
        place = entry.place if entry else self.places.get(section.key, "")
        title = self.title(section)
        marks = rf"\place{{{place}}}" if place else ""
        if entry:
            plain = f"{section.number} {_plain(section.title)}".strip()
            marks += _command("outlineentry", place, str(-entry.below), _hexadecimal(plain))
        return _command("heading", str(section.level), marks, title)

    def title(self, section: Section) -> str:
        number = rf"{escape(section.number)}\quad " if section.number else ""
        return number + self.inlines(section.title)

    def contents(self, title: str) -> str:
        lines = [_command("headingone", escape(title))]
        lines += (
            _command("contentsentry", str(entry.section.level), entry.place, self.title(entry.section))
            for entry in self.entries.values()
        )
        return "\n".join([*lines, r"\clearpage"])

    def list(self, block: List) -> str:
        from pylatex import Command, Itemize, NoEscape

        environment = Itemize()
        for number, item in enumerate(block.items, block.start):
            environment.append(Command("item", options=f"{number}." if block.ordered else None))
            # A text that begins with a bracket is no option of the command before it.
            environment.append(NoEscape(r"\relax " + self.blocks(item).strip()))
        return str(environment.dumps())

    def cover(self, cover: Cover) -> str:
        institution = [escape(line) for line in cover.institution]
        lines = [
            _command("coverinstitution", rf"\textbf{{{line}}}" if index else line)
            for index, line in enumerate(institution)
        ]
        lines += [r"\coverrule", r"\vfill"]
        lines += (_command("covertitle", escape(line)) for line in cover.title)
        lines.append(r"\vskip5mm")
        lines += (_command("coversubtitle", escape(line)) for line in cover.subtitle)
        lines.append(r"\vfill")
        fields = (
            _command(
                "coverfield", escape(f"{label}:"), rf"\textbf{{{escape(value)}}}" if value else r"\dotline"
            )
            for label, value in cover.fields
        )
        lines += [_command("coverfields", "%\n".join(fields)), r"\vfill"]
        lines.append(_command("coverfoot", escape(cover.place_and_date)))
        return "\n".join([r"\begin{coverpage}", *lines, r"\end{coverpage}"])

    # --- equations --------------------------------------------------------------------------------

    def equation(self, equation: Equation) -> str:
        place = rf"\place{{{self.places[equation.key]}}}" if equation.key else ""
        number = place + (f"({escape(equation.number)})" if equation.number else "")
        rows = []
        for index, row in enumerate(equation.rows):
            macro = "L" if index == len(equation.rows) - 1 else "R"
            left, rest = aligned(row, self.language)
            rows.append(rf"\{macro}{{{left}}}{{{rest}}}")
        return f"\\EQ{{{number}}}{{%\n" + "%\n".join(rows) + "}"

    # --- tables and figures -----------------------------------------------------------------------

    def caption(self, word: str, block: Table | Figure | Plate) -> str:
        place = rf"\place{{{self.places[block.key]}}}" if block.key else ""
        if not (block.caption or block.number):
            return place
        label = f"{word} {block.number}".strip() + ("." if block.caption else "")
        return _command("captiontext", place, escape(label), self.inlines(block.caption))

    def table(self, table: Table) -> str:
        from pylatex import LongTable, NoEscape

        columns = "".join(_column(column.width, column.align) for column in table.columns)
        environment = LongTable(NoEscape(columns), width=len(table.columns))
        caption = self.caption(self.document.words.table, table)
        head = self.table_head(table)
        if caption:
            title = rf"\multicolumn{{{len(table.columns)}}}{{c}}{{\tablecaption{{{caption}}}}}\\*[0pt]"
            environment.append(NoEscape(title))
        environment.append(NoEscape(head + r"\endfirsthead"))
        environment.append(NoEscape(head + r"\endhead"))
        environment.append(NoEscape(r"\bottomrule\endfoot"))
        unbroken = len(table.rows) <= UNBROKEN_ROWS
        for index, row in enumerate(table.rows):
            end = r"\\*[0pt]"
            if index < len(table.rows) - 1:
                # The first and the last row never stand alone on a page.
                together = unbroken or index in (0, len(table.rows) - 2)
                end += _command("rowrule", str(len(table.columns)), "10000" if together else "0")
            environment.append(NoEscape(self.table_row(row, table.columns) + end))
        return f"{{\\tablesize\n{environment.dumps()}\n}}"

    def table_head(self, table: Table) -> str:
        # Every option is written out: a cell's text may begin with a bracket.
        lines = [r"\toprule[\heavyrulewidth]"]
        for index, row in enumerate(table.head):
            lines.append(self.table_row(row, table.columns, head=True) + r"\\*[0pt]")
            if index < len(table.head) - 1:
                lines.append(_rules_below(row))
        lines.append(r"\midrule" if table.head else "")
        return "\n".join(lines) + "\n"

    def table_row(self, row: Sequence[Cell], columns: Sequence[Column], head: bool = False) -> str:
        from pylatex import MultiColumn, NoEscape

        printed, at = [], 0
        for cell in row:
            source = self.inlines(cell.inlines)
            covered = columns[at : at + cell.span]
            if cell.span > 1 or (head and covered and covered[0].align != "center"):
                align = "center" if head else covered[0].align
                width = sum(column.width for column in covered)
                spec = NoEscape(_column(width, align))
                source = MultiColumn(cell.span, align=spec, data=NoEscape(source)).dumps()
            printed.append(source)
            at += cell.span
        return " & ".join(printed)

    def figure(self, figure: Figure) -> str:
        rows = "\n\\scenebreak\n".join(
            _command("scenerow", rf"\hskip{SCENE_GAP}mm ".join(map(self.scene, row)))
            for row in _scene_rows(figure.scenes)
        )
        caption = _command("figurecaption", self.caption(self.document.words.figure, figure))
        return "\n".join([r"\begin{scenes}", rows, caption, r"\end{scenes}"])

    def scene(self, scene: Scene) -> str:
        painted = paint(scene, self.language)
        return _command("titledscene", painted, escape(scene.title)) if scene.title else painted


def _keys(blocks: Sequence[Block]) -> Iterator[str]:
    """What blocks, and those inside lists, are called by references."""
    for block in blocks:
        match block:
            case List(items):
                for item in items:
                    yield from _keys(item)
            case Section() | Equation() | Table() | Figure() | Plate():
                if block.key:
                    yield block.key


def _scene_rows(scenes: Sequence[Scene]) -> Iterator[list[Scene]]:
    """The scenes in rows, each as full as the text block allows."""
    row: list[Scene] = []
    for scene in scenes:
        if row and sum(other.width + SCENE_GAP for other in row) + scene.width > TEXT_WIDTH:
            yield row
            row = []
        row.append(scene)
    if row:
        yield row


def _column(width: float, align: str) -> str:
    return f"{align[0].upper()}{{{width:g}mm}}"


def _rules_below(row: Sequence[Cell]) -> str:
    """A thin rule under every cell of a head row that stands over several columns."""
    rules, at = [], 1
    for cell in row:
        if cell.span > 1:
            rules.append(rf"\cmidrule(lr){{{at}-{at + cell.span - 1}}}")
        at += cell.span
    return "".join(rules)


def _entries(blocks: Sequence[Block]) -> Iterator[_Entry]:
    """The headings that contents and outline list, in order."""
    sections = [block for block in blocks if isinstance(block, Section) and block.level <= CONTENTS_LEVEL]
    for index, section in enumerate(sections):
        below = 0
        for later in sections[index + 1 :]:
            if later.level <= section.level:
                break
            below += later.level == section.level + 1
        yield _Entry(section, f"s{index}", below)


def _plain(inlines: Inlines) -> str:
    """The words of a title for the outline, which knows no formulas."""
    words = []
    for inline in inlines:
        match inline:
            case Text(text) | Reference(text=text):
                words.append(text)
            case Emph(of) | Strong(of):
                words.append(_plain(of))
            case InlineMath(expression):
                base, sub = getattr(expression, "base", ""), getattr(expression, "sub", "")
                words.append(f"{base}{sub}")
            case _:
                words.append(" ")
    return "".join(words)
