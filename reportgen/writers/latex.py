"""Document → LaTeX → PDF: the words and numbers of the tree, the looks of the frame.

The body is PyLaTeX fragments and short macros that the Jinja2 frame `templates/frames/latex` defines.
Contents, links and outline use pdfTeX's own primitives: the titles are known here, so that only page
numbers wait for a second pass.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

from reportgen import installation
from reportgen.document.tree import (
    BlankLine,
    Block,
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
from reportgen.writers.flow import leads
from reportgen.writers.latex_math import aligned, mathematics
from reportgen.writers.latex_outline import entries_of, hexadecimal, keys_of, plain
from reportgen.writers.latex_table import height, table
from reportgen.writers.latex_text import declarations, escape
from reportgen.writers.pdflatex import Compiled, compile, overfull

if TYPE_CHECKING:
    from jinja2 import Template

__all__ = ["Compiled", "compile", "overfull", "render", "write"]

TEXT_WIDTH = 160
SCENE_GAP = 4
"""Millimetres: the width of the text block, and between scenes of a row."""


def write(document: Document) -> str:
    """The complete LaTeX source, which compiles as it stands.

    Raises `TypesetterError` for a character the fonts do not have.
    """
    body = _Writer(document).body()
    return _frame().render(
        title=hexadecimal(document.title),
        author=hexadecimal(document.author),
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
        loader=FileSystemLoader(installation.templates() / "frames" / "latex"),
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


def _command(name: str, *arguments: str) -> str:
    from pylatex import Command, NoEscape

    source: str = Command(name, arguments=[NoEscape(argument) for argument in arguments]).dumps()
    return source


class _Writer:
    """The blocks of one document as LaTeX; holds what a block must know of the others."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.language = document.language
        self.entries = {id(entry.section): entry for entry in entries_of(document.blocks)}
        self.places: Mapping[str, str] = {
            **{key: f"k{index}" for index, key in enumerate(keys_of(document.blocks))},
            **{entry.section.key: entry.place for entry in self.entries.values() if entry.section.key},
        }

    def body(self) -> str:
        return self.blocks(self.document.blocks)

    def blocks(self, blocks: Sequence[Block]) -> str:
        return "\n".join(
            self.led(block, following) if leads(block, following, self.language) else self.block(block)
            for block, following in pairwise((*blocks, None))
            if block is not None
        )

    def led(self, block: Block, following: Block | None) -> str:
        """Words and what they lead to, on one page: lists and equations see to it, tables begin with a break."""
        if isinstance(block, List):
            return self.list(block, r"\keeplist")
        needed = _command("needed", f"{height(following)}mm") if isinstance(following, Table) else ""
        return f"{needed}{self.block(block)}\\par\\nobreak"

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
            words = f"{section.number} {plain(section.title)}".strip()
            marks += _command("outlineentry", place, str(-entry.below), hexadecimal(words))
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

    def list(self, block: List, end: str = "") -> str:
        from pylatex import Command, Itemize, NoEscape

        environment = Itemize()
        for number, item in enumerate(block.items, block.start):
            environment.append(Command("item", options=f"{number}." if block.ordered else None))
            # A text that begins with a bracket is no option of the command before it.
            environment.append(NoEscape(r"\relax " + self.blocks(item).strip()))
        if end:
            environment.append(NoEscape(end))
        return str(environment.dumps())

    def cover(self, cover: Cover) -> str:
        institution = [escape(line) for line in cover.institution]
        lines = [
            _command("coverinstitution", line if index else rf"\textbf{{{line}}}")
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

    def table(self, block: Table) -> str:
        return table(block, self.caption(self.document.words.table, block), self.inlines)

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
