"""Document → Typst source → PDF, by the typesetter that comes embedded in its Python package.

The source is one self-standing file: the frame `templates/frames/typst/report.typ`, which holds the
look and defines short names, then the report as calls of these names, a block a line.  In formulas names
and numbers travel as string literals, so nothing in them can become markup, and every operator stands
between spaces, because identifiers of Typst may hold a hyphen.
"""

from __future__ import annotations

import json
import re
import tempfile
import unicodedata
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar

from reportgen import report as tree
from reportgen.base.errors import TypesetterError
from reportgen.base.units import Language, by_power_of_ten
from reportgen.base.words import templates
from reportgen.drawing import Scene
from reportgen.drawing.geometry import moved
from reportgen.drawing.sheet import DrawingSheet
from reportgen.formula import Chain, Expression, Product, Sum, Symbol, VectorEquation, walk
from reportgen.formula.setting import (
    NAMED,
    NARROW,
    PRIMES,
    Sign,
    TextSetter,
    Written,
    columns,
    displayed,
    parted,
    sides,
    written,
)
from reportgen.formula.vocabulary import numbered, runs
from reportgen.writers.drawing import paint_typst


def literal(text: str) -> str:
    """A string literal of Typst that reads back as `text`."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\n", "\\n").replace("\r", "\\r").replace("\t", "\\t") + '"'


class TypstFormulas(TextSetter):
    BELOW = "%s_(script(%s))"
    RAISED = POWER = "%s^(%s)"
    QUOTIENT, RADICAL = "frac(%s, %s)", "sqrt(%s)"
    FENCES: ClassVar = {"": "%s", "(": "(%s)", "|": "abs(%s)", "[": 'mat(delim: "[", %s)'}
    ENTRY, LINE = ", ", "; "
    APPLIED = CALL = "%s %s"
    NOTE = " quad %s"
    SIGNS: ClassVar = {"·": "dot.c", "×": "times"}

    def text(self, text: str) -> str:
        return literal(text)

    def inline(self, mathematics: str) -> str:
        return f"${mathematics}$"

    def number(self, number: Written) -> str:
        return f"{literal(number.digits)} thin {literal(number.unit)}" if number.spaced else literal(number.text(""))

    def sign(self, sign: Sign) -> str:
        match sign.role:
            case "prefix":
                return sign.of
            case "slash":
                return literal(sign.of)
            case "separator":
                return f' class("punctuation", "{sign.of}") '
            case _:
                return f" {self.SIGNS.get(sign.of, sign.of)} "

    def function(self, name: str) -> str:
        return name if name in NAMED else f"op({literal(name)})"

    def symbol(self, node: Symbol) -> str:
        """A symbol with its marks: base in italics, sub- and superscript upright, a bar over the whole of it."""
        letters, above = parted(node)
        single = len(letters) == 1 and letters.isalpha()
        base = letters if single else self.lowered(runs(letters), lambda part: f"italic({literal(part)})")
        if node.over == "vector":
            base = f"arrow({base})"
        below = f"_({self.lowered(numbered(node.sub), literal)})" if node.sub else ""
        marked = base + below + (f"^({_superscript(above)})" if above else "")
        return f"overline({marked})" if node.over == "segment" else marked


def _superscript(text: str) -> str:
    """Primes as Typst's own symbol, which has the right size, everything else upright."""
    letters = text.lstrip(PRIMES)
    primes = {"′": "prime", "″": "prime.double"}
    names = [primes[char] for char in text[: len(text) - len(letters)]]
    return " ".join([*names, literal(letters)] if letters else names)


LIST_INDENT = 12.0
"""What a list takes from the width of its items at most, mm."""
PPI = 220
"""Dots an inch of pictures."""
SHEET_LOOK = """#set text(font:"New Computer Modern",ligatures:false)
#show math.equation: set text(font:"New Computer Modern Math")"""


def write(document: tree.Document, letter: tree.Letter = tree.OWN_LETTER) -> str:
    """The complete Typst source of a document; it needs no other file but fonts of the system.

    Raises `TypesetterError` if the frame is missing.
    """
    opening = ", ".join(
        (
            f"title: {literal(document.title)}",
            f"author: {literal(document.author)}",
            f"lang: {literal(document.language)}",
            f"header: {_array(map(literal, document.header))}",
            f"footer: {_array(map(literal, document.footer))}",
            *_in(letter),
            *(("close: true",) if document.close else ()),
        )
    )
    body = _Blocks(document.language, document.words, close=document.close).write(document.blocks)
    return f"{_frame()}\n#show: report.with({opening})\n\n{body}\n"


def _in(letter: tree.Letter) -> Iterator[str]:
    """The letter as the frame is told it; tables in a broad font are set smaller, since their columns are as wide."""
    if letter.font:
        yield f"font: {literal(letter.font)}"
        yield f"narrower: {breadth(letter.font):.4g}"
    if letter.size != tree.TEXT_SIZE:
        yield f"size: {letter.size:g}pt"


def write_sheet(sheet: DrawingSheet, title: str, language: Language) -> str:
    """The Typst source of a drawing sheet, one page of its own size; it needs no other file."""
    items = tuple(moved(item, part.at) for part in sheet.parts for item in part.scene.items)
    drawing = paint_typst(Scene(sheet.width, sheet.height, items), TypstFormulas(language))
    page = f"#page(width:{sheet.width:g}mm,height:{sheet.height:g}mm,margin:0pt)[#{drawing}]"
    return "\n".join((_frame(), f"#set document(title:{literal(title)},date:none)", SHEET_LOOK, page, ""))


def _frame() -> str:
    """The frame's source: from the installed package, or beside it in a checkout."""
    path = templates() / "frames" / "typst" / "report.typ"
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise TypesetterError(f"{path}: {error.strerror}") from error


def _array(items: Iterable[str]) -> str:
    """An array of Typst; the closing comma makes one of a single item, too."""
    return "(" + "".join(f"{item}," for item in items) + ")"


class _Blocks:
    """Writes blocks in one language; `room` is the width that lists leave for equations, in mm."""

    def __init__(
        self, language: Language, words: tree.Words, room: float = tree.TEXT_WIDTH, close: bool = False
    ) -> None:
        self.language = language
        self.formulas = TypstFormulas(language)
        self.words = words
        self.room, self.close = room, close

    def write(self, blocks: Sequence[tree.Block]) -> str:
        lines: list[str] = []
        run_in = ""
        for block, following in pairwise((*blocks, None)):
            assert block is not None
            if isinstance(block, tree.Section) and block.level > 3:
                run_in = self.run_in(block)
                if not isinstance(following, tree.Paragraph):
                    lines.append(f"#K[{run_in}]")
                    run_in = ""
                continue
            if not tree.leads(block, following, self.language):
                lines.append(run_in + self.block(block))
            elif isinstance(block, tree.List):
                *others, last = tree.parted(block)
                lines += [self.block(part) for part in others]
                lines.append(f"#K(above:{'0.72em' if others else 'auto'})[{self.block(last)}]")
            else:
                lines.append(f"#K[{run_in}{self.block(block)}]")
            run_in = ""
        return "\n\n".join(lines)

    def block(self, block: tree.Block) -> str:
        match block:
            case tree.Section(level, title, key, _, number):
                return f"#N({level},{literal(number)},{self.content(title)})" + _label(key)
            case tree.Paragraph(inlines, align):
                body = self.inlines(inlines)
                return f"#align({align})[{body}]" if align else body
            case tree.List():
                return self.items(block)
            case tree.Equation():
                return self.equation(block)
            case tree.Table():
                return self.table(block)
            case tree.Figure(scenes, _, key, turned=turned):
                label = self.caption(self.words.figure, block)
                if turned:
                    return f"#Q({literal(key)},{label},\n{paint_typst(scenes[0], self.formulas)})"
                first, *others = tree.in_parts(block)
                again = f"{self.again(self.words.figure, block)},[]"
                figures = [f"#W({literal(key)},{label},\n{self.rows(first)})"]
                figures += (f'#W("",{again},\n{self.rows(rows)})' for rows in others)
                return "\n".join(figures)
            case tree.Plate(scene, (width, height), _, key, continues=continues):
                again = f"{self.again(self.words.figure, block)},[]"
                label = again if continues else self.caption(self.words.figure, block)
                across = f"{width:g},{height:g},{scene.height:g},{label}"
                return f"#plate({across},\n{paint_typst(scene, self.formulas)})" + _label(key)
            case tree.Cover(institution, title, subtitle, fields, foot):
                lines = (_array(map(literal, part)) for part in (institution, title, subtitle))
                pairs = _array(f"({literal(label)},{literal(value)})" for label, value in fields)
                return f"#cover({','.join(lines)},{pairs},{literal(foot)})"
            case tree.Contents(title, brief):
                return f"#contents({literal(title)}{',brief:true' if brief else ''})"
            case tree.BlankLine(label):
                return f"#blank({literal(label)})"
            case tree.Listing(code):
                return f"#listing({literal(chr(10).join(code))})"
            case tree.PageBreak():
                return "#pagebreak(weak: true)"

    # --- inlines ----------------------------------------------------------------------------------

    def inlines(self, inlines: Sequence[tree.Inline]) -> str:
        return "".join(map(self.inline, inlines))

    def content(self, inlines: Sequence[tree.Inline]) -> str:
        return f"[{self.inlines(inlines)}]"

    def inline(self, inline: tree.Inline) -> str:
        match inline:
            case tree.Text(text):
                return _text(text)
            case tree.Emph(of):
                return f"#emph{self.content(of)}"
            case tree.Strong(of):
                return f"#strong{self.content(of)}"
            case tree.InlineMath(expression, slashed):
                return self.formula(expression, slashed)
            case tree.Value(number) if by_power_of_ten(number.value, number.decimals):
                return self.formula(number)
            case tree.Value(number):
                shown = literal(written(number, self.language).text(NARROW))
                return f"#box({shown})" if "/" in number.unit else f"#{shown}"
            case tree.Reference(key, text):
                return f"#link(label({literal(key)}),{literal(text)})"
            case tree.LineBreak():
                return "#linebreak()"

    def formula(self, expression: Expression, slashed: bool = False) -> str:
        """A formula in a line, which may break before a second "=" and between the terms of a sum only."""
        parts = expression.parts if isinstance(expression, Chain) else (expression,)
        products = any(isinstance(node, Product) for node in walk(expression))
        if any(isinstance(part, Sum) for part in parts[:2]) or not (products or len(parts) > 1):
            return self.formulas.content(expression, slashed)
        printed = list(map(self.formulas.part, sides(expression, self.language, slashed)))
        # What stands left of "=" never stands alone at the end of a line.
        printed[:2] = [" = ".join(printed[:2])]
        return " ".join(f"#box(${'= ' if index else ''}{part}$)" for index, part in enumerate(printed))

    def run_in(self, section: tree.Section) -> str:
        number = f"#{literal(section.number)}#h(0.5em)" if section.number else ""
        return f"#strong[{number}{self.inlines(section.title)}]{_label(section.key)}#h(0.6em)"

    # --- blocks -----------------------------------------------------------------------------------

    def items(self, block: tree.List) -> str:
        inner = _Blocks(self.language, self.words, self.room - LIST_INDENT, self.close)
        name = f"enum(start:{block.start}," if block.ordered else "list("
        return f"#{name}{','.join(f'[{inner.write(item)}]' for item in block.items)})"

    def equation(self, equation: tree.Equation) -> str:
        """Rows that are set alike in one block each; the number on the last."""
        groups = tree.in_groups(equation.rows, tree.room_for(self.room, self.close))
        lines = []
        for index, group in enumerate(groups):
            number = literal(equation.number if index == len(groups) - 1 else "")
            first = group[0]
            if isinstance(first, VectorEquation):
                lines.append(f"#V({number},{self.room:g},{self.vector_equation(first)})")
            else:
                rows = ",".join(_array(self.row(row)) for row in group)
                lines.append(f"#E({number},{self.room:g},{tree.ABREAST:g},{rows})")
        return "\n".join(lines) + _label(equation.key)

    def row(self, row: Expression) -> list[str]:
        """A displayed row: the parts between "=", each in the pieces between which it may break."""
        part = self.formulas.part
        return [_array(f"${part(piece).strip()}$" for piece in side) for side in displayed(row, self.language)]

    def vector_equation(self, equation: VectorEquation) -> str:
        known, part = self.formulas.known, self.formulas.part
        terms = (
            _array((f"${''.join(sign.of for sign in one.signs)}$", f"${part(one.term)}$", *map(known, one.known)))
            for one in columns(equation)
        )
        return ",".join((_array(map(literal, equation.rows)), *terms))

    def table(self, table: tree.Table) -> str:
        label = self.caption(self.words.table, table) if table.caption or table.number else "none,none"
        columns = _array(f"{column.width:g}" for column in table.columns)
        aligns = _array(column.align for column in table.columns)
        head = _array(_array(self.cell(cell, "U") for cell in row) for row in table.head)
        rows = ",\n".join(_array(self.cell(cell, "X") for cell in row) for row in table.rows)
        whole = "0" if len(table.rows) <= tree.WHOLE_TABLE else str(tree.TOGETHER)
        again = self.again(self.words.table, table) if table.number else "none"
        framed = "framed:true," if table.framed else ""
        return f"#R({framed}{label},{again},{columns},{aligns},{head},{whole},\n{rows})" + _label(table.key)

    def cell(self, cell: tree.Cell, spanned: str) -> str:
        body = self.content(cell.inlines)
        return f"{spanned}({cell.span},{body})" if cell.span > 1 else body

    def rows(self, rows: Sequence[Sequence[Scene]]) -> str:
        return ",".join(_array(map(self.scene, row)) for row in rows)

    def scene(self, scene: Scene) -> str:
        return f"({paint_typst(scene, self.formulas)},{literal(scene.title)})"

    def caption(self, word: str, block: tree.Table | tree.Figure | tree.Plate) -> str:
        """The two arguments of a caption: its label, and what it says."""
        return f"{literal(f'{word} {block.number}'.strip())},{self.content(block.caption)}"

    def again(self, word: str, block: tree.Table | tree.Figure | tree.Plate) -> str:
        """The label of what goes on from the page before."""
        return literal(f"{word} {block.number} ({self.words.continued})")


def _text(text: str) -> str:
    """A text as a string, but its units in boxes: lines would break behind a slash."""
    parts = tree.UNIT.split(text)
    return "".join(
        f"#box({literal(part)})" if index % 2 else f"#{literal(part)}"
        for index, part in enumerate(parts)
        if part or len(parts) == 1
    )


def _label(key: str) -> str:
    """An anchor behind the block before it, for links to `key`."""
    return f"#label({literal(key)})" if key else ""


# --- the typesetter, which runs once for each source -------------------------------------------------


def compile(source: str, system: bool = False) -> bytes:
    """The PDF of a Typst source, byte for byte the same from run to run; it may name fonts of the `system`.

    Raises `TypesetterError` with the message's first lines.
    """
    try:
        import typst
    except ModuleNotFoundError as error:
        raise TypesetterError("typst is not installed: pip install typst") from error
    except ImportError as error:
        raise TypesetterError(f"typst cannot be loaded, most likely for too little memory: {error}") from error
    own = not needs_system_fonts(source, lacking)
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        path = Path(folder) / "report.typ"
        path.write_text(source, encoding="utf-8", newline="")
        try:
            pdf = typst.compile(str(path), root=folder, ignore_system_fonts=own and not system)
        except typst.TypstError as error:
            lines = str(getattr(error, "message", error)).splitlines()
            raise TypesetterError("typst: " + "\n".join(lines[:4])) from error
    assert isinstance(pdf, bytes)
    return pdf


def pictures(scenes: Sequence[Scene], language: Language) -> list[tuple[bytes, bytes]]:
    """Scenes in true size as PNG and as SVG."""
    import typst

    if not scenes:
        return []
    formulas = TypstFormulas(language)
    pages = (
        f"#page(width:{scene.width}mm,height:{scene.height}mm,margin:0pt)[#{paint_typst(scene, formulas)}]"
        for scene in scenes
    )
    source = "\n".join((_frame(), SHEET_LOOK, *pages))
    own = not needs_system_fonts(source, lacking)
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        path = Path(folder) / "figures.typ"
        path.write_text(source, encoding="utf-8", newline="")
        compiler = typst.Compiler(str(path), root=folder, ignore_system_fonts=own)
        made: list[Any] = [compiler.compile(format="png", ppi=PPI), compiler.compile(format="svg")]
    # What has one page comes alone.
    pngs, svgs = made if len(scenes) > 1 else ([one] for one in made)
    # Letters are symbols that are used; groups that are used look the same, and more programs know them.
    grouped = (svg.replace(b"<symbol", b"<g").replace(b"</symbol>", b"</g>") for svg in svgs)
    return list(zip(pngs, grouped, strict=True))


def families() -> list[str]:
    """The fonts that a source may name: the typesetter's own and those of the system, in order."""
    import typst

    return sorted(typst.Fonts(include_system_fonts=True).families())


@lru_cache(maxsize=16)
def breadth(font: str) -> float:
    """How many times as broad as in the typesetter's own font a text is in another, at least 1."""
    import typst

    answer = typst.query(BREADTH.format(font=font, own=FONT).encode(), "<breadth>", field="value", one=True)
    return max(1.0, float(json.loads(answer)))


def lacking(letters: str, system: bool) -> str:
    """Those of the letters that none of the typesetter's own fonts, or the `system`'s either, has."""
    import typst

    if not letters:
        return ""
    asked = question(letters).encode()
    answer = typst.query(asked, "<lacking>", field="value", one=True, ignore_system_fonts=not system)
    return "".join(json.loads(answer))


# --- letters that Typst's own fonts do not have ---------------------------------------------------
# Names in Chinese, Thai, Lao and other scripts, emoji.
# Typst leaves out in silence what no font has. So its fonts are asked first, then those of the system; what neither
# has is told as a warning.

COMMON = re.compile("[\u0000-\u024f\u0300-\u052f\u1e00-\u2bff\u3000-\u3003\ufb00-\ufb06\ufe00-\ufe0f]+")
"""Latin (Vietnamese included), Greek, Cyrillic, punctuation, arrows and the signs of mathematics: never asked for."""
FONT = "New Computer Modern"
NOWHERE = r"\u{10fffe}"
"""No character, and therefore in no font: the typesetter sets the same in its place as for a letter it lacks."""
BATCH = 400
"""So many different letters are asked for at most; a text of more is not worth a warning."""

Lacking = Callable[[str, bool], str]
"""Those of some letters that none of the typesetter's own fonts has, or, if asked, the system's either."""

QUESTION = """\
#set text(font: "{font}", size: 10pt, top-edge: "bounds", bottom-edge: "bounds")
#context [
  #let size(letter) = {{ let box = measure(letter); (box.width, box.height) }}
  #metadata(({letters},).filter(letter => size(letter) == size("{nowhere}"))) <lacking>
]
"""


BREADTH = """\
#let breadth(font, weight) = measure(text(font: font, weight: weight, size: 10pt)[
  Hamburgefonstiv vận tốc góc của khâu 0123456789,0123456789]).width
#context [#metadata(calc.max(..("regular", "bold").map(weight =>
  breadth("{font}", weight) / breadth("{own}", weight)))) <breadth>]
"""
"""What the typesetter is asked about the letters of a font; words and numbers, as tables have them."""


class MissingLettersWarning(UserWarning):
    """Letters of a text have no place on the page, since no font has them."""

    def __init__(self, letters: str) -> None:
        self.letters = letters
        super().__init__(f"no font has {' '.join(letters)}: left out on the page")


def uncommon(text: str) -> str:
    """The letters, digits and signs of a text, each once, that the typesetter's own fonts may lack."""
    left = dict.fromkeys(COMMON.sub("", text))
    return "".join(letter for letter in left if unicodedata.category(letter)[0] in "LNPS")[:BATCH]


def question(letters: str) -> str:
    """What the typesetter is asked: which of the letters, one at least, it sets as it sets what no font has."""
    listed = ", ".join(f'"\\u{{{ord(letter):x}}}"' for letter in letters)
    return QUESTION.format(font=FONT, letters=listed, nowhere=NOWHERE)


def needs_system_fonts(text: str, lacking: Lacking) -> bool:
    """Whether a text has letters that only the system's fonts may have; warns of those that no font has."""
    wanted = lacking(uncommon(text), False)
    if not wanted:
        return False
    if missing := lacking(wanted, True):
        warnings.warn(MissingLettersWarning(missing), stacklevel=2)
    return missing != wanted
