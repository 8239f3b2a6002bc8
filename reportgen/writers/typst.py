"""Write a document as Typst source.

The source is one self-contained file: the frame `templates/frames/typst/report.typ`, which contains the layout and
defines short names, then the report as calls of these names, one block per line. Measurements that the typesetter would
have to make are given to it where our own estimate is certain: that an equation fits, that a row is one line high.
"""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise

from reportgen import document as tree
from reportgen.base.errors import TypesetterError
from reportgen.base.languages import PageMargins, setting_of
from reportgen.base.records import asdict
from reportgen.base.template_folders import templates
from reportgen.base.units import Language, by_power_of_ten
from reportgen.document import layout, spoken_formulas
from reportgen.document.alt_text import figure_text, sentences, within
from reportgen.drawing import Scene
from reportgen.drawing.drawing_sheet import DrawingSheet
from reportgen.drawing.geometry import moved
from reportgen.drawing.label_size import box
from reportgen.formula import Chain, Expression, Product, Sum, Symbol, VectorEquation, walk
from reportgen.formula.formula_layout import EQUALS, NARROW, MathRow, Part, columns, displayed, laid, sides, written
from reportgen.formula.formula_speech import Speech
from reportgen.writers.scene_source import paint_typst
from reportgen.writers.typst_fonts import FONT, breadth
from reportgen.writers.typst_math import TypstFormulas, literal

LIST_INDENT = 12.0
"""Largest reduction of the width of a list's items (mm)."""
LONG_HEAD = 0.45
"""Share of the room above which a left side prevents aligning the rows of an equation, as in the frame."""
NUMBER_ROOM = 20.0
"""Largest width of an equation's number with the gap before it (mm)."""
LOW = 0.9
"""Share of its cell's room up to which an estimated line is certainly a single line."""
CAPITAL, OUT = 2.4, 0.8
"""Height of capitals there, and largest overshoot of a formula above them or below the line (mm)."""
CELL, CELL_INSET = 10.0, 3.0
"""Font size in tables (points), and the total white space on both sides of a cell (mm)."""
SINGLE = re.compile(r'#("(?:[^"\\]|\\.)*")')
"""A single string in markup."""
UNDATED = datetime.date(1980, 1, 1)
"""Date of a file without a known date, equal to that of the parts of a Word file."""


def write(document: tree.Document, letter: layout.Letter = layout.OWN_LETTER) -> str:
    """Return the complete Typst source of a document; it needs no other files except system fonts.

    Raises `TypesetterError` if the frame is missing.
    """
    opening = ", ".join(
        (
            f"title: {literal(document.title)}",
            f"author: {literal(document.author)}",
            f"date: {_date(document.date)}",
            *_of_language(document.language),
            f"header: {_array(map(literal, document.header))}",
            f"footer: {_array(map(literal, document.footer))}",
            *_in(letter),
        )
    )
    body = _Blocks(document.language, document.words, spoken_formulas.speech(document), letter, document.close).write(
        document.blocks
    )
    return f"{frame(document.language, document.close)}\n#show: report.with({opening})\n\n{body}\n"


def _of_language(language: Language) -> Iterator[str]:
    """Yield the frame's arguments for a language that differ from the frame's defaults."""
    setting = setting_of(language)
    own, page = setting.typst, setting.page
    yield f"lang: {literal(own.lang or language)}"
    if own.region:
        yield f"region: {literal(own.region)}"
    if own.hyphenate:
        yield "hyphenate: true"
    if page != PageMargins():
        sides = ", ".join(f"{side}: {width:g}mm" for side, width in asdict(page).items())
        yield f"margin: ({sides})"


def _in(letter: layout.Letter) -> Iterator[str]:
    """Yield the frame's arguments for the letter; tables in a broad font are set smaller to fit their columns."""
    if letter.font:
        yield f"font: {literal(letter.font)}"
        yield f"narrower: {breadth(letter.font):.4g}"
    if letter.size != layout.TEXT_SIZE:
        yield f"size: {letter.size:g}pt"


def _date(date: datetime.date | None) -> str:
    """Return a date in Typst; archival standards require one, and equal input gives equal bytes."""
    known = date or UNDATED
    return f"datetime(year:{known.year},month:{known.month},day:{known.day})"


def write_sheet(
    sheet: DrawingSheet,
    title: str,
    language: Language,
    phrases: Mapping[str, str],
    author: str = "",
    date: datetime.date | None = None,
) -> str:
    """Return the Typst source of a drawing sheet, one page in the sheet's size; it needs no other file.

    Each plate is a figure with a text alternative made from `phrases`; plates without one are decoration.
    """
    formulas, figures = TypstFormulas(language), []
    for _, parts in groupby(sheet.parts, key=lambda part: part.name.partition(".")[0]):
        plate = list(parts)
        items = tuple(moved(item, part.at) for part in plate for item in part.scene.items)
        drawing = paint_typst(Scene(sheet.width, sheet.height, items), formulas)
        facts = [said for part in plate for said in sentences(part.scene.description, phrases, language)]
        text = literal(within("", facts, language, phrases["rest-in-report"]))
        content = f"D({text},{drawing})" if facts else f"pdf.artifact({drawing})"
        figures.append(f"#place(top+left,{content})")
    page = f"#page(width:{sheet.width:g}mm,height:{sheet.height:g}mm,margin:0pt)[{''.join(figures)}]"
    opening = ",".join((*map(literal, (title, author, setting_of(language).typst.lang or language)), _date(date)))
    return "\n".join((frame(language), f"#show: described.with({opening})", sheet_look(language), page, ""))


def sheet_look(language: Language) -> str:
    """Return the fonts of a page with its own size, such as a drawing sheet or a single figure."""
    fonts = [literal(font) for font in (FONT, *setting_of(language).typst.fonts)]
    text = f"#set text(font:{_array(fonts)},ligatures:false)"
    return f"{text}\n#show math.equation: set text(font:{_array((literal(f'{FONT} Math'), *fonts))})"


def frame(language: Language, close: bool = False) -> str:
    """Return the frame's source, for a document that is set `close` or not, from the package or the checkout."""
    path = templates() / "frames" / "typst" / "report.typ"
    setting = setting_of(language)
    said = {
        "close": str(close).lower(),
        "further": _array(map(literal, setting.typst.fonts)),
        "further-strong": _array(map(literal, setting.typst.strong or setting.typst.fonts)),
        "caption-stop": literal(setting.stop),
        "colon": literal(setting.colon.strip()),
    }
    try:
        opening = "".join(f"#let {name} = {value}\n" for name, value in said.items())
        return opening + path.read_text(encoding="utf-8")
    except OSError as error:
        raise TypesetterError(f"{path}: {error.strerror}") from error


def _array(items: Iterable[str]) -> str:
    """Return a Typst array; the final comma makes an array of a single item, too."""
    return "(" + "".join(f"{item}," for item in items) + ")"


class _Blocks:
    """Writer of blocks in one language; `room` is the width that lists leave for equations (mm)."""

    def __init__(
        self,
        language: Language,
        words: tree.Words,
        speech: Speech,
        letter: layout.Letter = layout.OWN_LETTER,
        close: bool = False,
        room: float = tree.TEXT_WIDTH,
    ) -> None:
        self.language = language
        self.formulas = TypstFormulas(language)
        self.words, self.speech = words, speech
        self.letter, self.close = letter, close
        # In a document that is set close, the font is a point smaller, as in the frame.
        self.size = letter.size - close
        self.room = room

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
            if not layout.leads(block, following, self.language):
                lines.append(run_in + self.block(block))
            elif isinstance(block, tree.List):
                *others, last = layout.parted(block)
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
                    return f"#Q({literal(key)},{label},\n{self.drawing(scenes[0], block)})"
                first, *others = layout.in_parts(block)
                place = "#standing" if block.here else "#W"
                figures = [f"{place}({literal(key)},{label},\n{self.rows(first, block)})"]
                for part, rows in enumerate(others, 2):
                    where = setting_of(self.language).aside(self.words.part.format(part=part))
                    again = literal(f"{self.words.figure} {block.number}{where}")
                    figures.append(f'{place}("",{again},[],\n{self.rows(rows, block)})')
                return "\n".join(figures)
            case tree.Plate(scene, (width, height), _, key, continues=continues):
                again = f"{self.again(self.words.figure, block)},[]"
                label = again if continues else self.caption(self.words.figure, block)
                across = f"{width:g},{height:g},{scene.height:g},{label}"
                return f"#plate({across},\n{self.drawing(scene, block)})" + _label(key)
            case tree.Cover(institution, title, subtitle, fields, foot):
                lines = (_array(map(literal, part)) for part in (institution, title, subtitle))
                pairs = _array(f"({literal(label)},{literal(value)})" for label, value in fields)
                return f"#cover({','.join(lines)},{pairs},{literal(foot)})"
            case tree.Contents(title, brief, alone, short):
                look = (",brief:true" if brief else "") + ("" if alone else ",alone:false")
                look += ",short:true" if short and self.letter == layout.OWN_LETTER else ""
                return f"#contents({literal(title)}{look})"
            case tree.BlankLine(label):
                return f"#blank({literal(label)})"
            case tree.Listing(code):
                return f"#listing({literal(chr(10).join(code))})"
            case tree.PageBreak():
                return "#pagebreak(weak: true)"

    # --- inlines ----------------------------------------------------------------------------------

    def inlines(self, inlines: Sequence[tree.Inline]) -> str:
        written = [self.inline(inline) for inline in inlines]
        for place, (before, inline) in enumerate(pairwise(inlines), 1):
            # No line may begin with these Chinese marks, though Typst would break before them after a formula.
            if (
                isinstance(inline, tree.Text)
                and inline.text[:1] in ("；", "：")
                and isinstance(before, (tree.InlineMath, tree.Value))
            ):
                written[place] = f"#sym.wj{written[place]}"
        return "".join(written)

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
                digits = literal(written(number, self.language).text(NARROW))
                return f"#box({digits})" if "/" in number.unit else f"#{digits}"
            case tree.Reference(key, text):
                return f"#link(label({literal(key)}),{literal(text)})"
            case tree.LineBreak():
                return "#linebreak()"
            case tree.Blank():
                return f"#{literal(tree.DOTS)}"

    def formula(self, expression: Expression, slashed: bool = False) -> str:
        """Return an inline formula, which may break only before a second "=" and between the terms of a sum."""
        parts = expression.parts if isinstance(expression, Chain) else (expression,)
        products = any(isinstance(node, Product) for node in walk(expression))
        if any(isinstance(part, Sum) for part in parts[:2]) or not (products or len(parts) > 1):
            return f"#{self.heard([laid(expression, self.language, slashed)])}"
        first, *others = sides(expression, self.language, slashed=slashed)
        # The left side of "=" is never alone at the end of a line.
        pieces = [[first, EQUALS, *others[:1]] if others else [first], *([EQUALS, part] for part in others[1:])]
        return " ".join(f"#box({self.heard(piece)})" for piece in pieces)

    def heard(self, parts: Sequence[Part]) -> str:
        """Return a formula of parts with its spoken text."""
        printed = "".join(map(self.formulas.part, parts)).strip()
        return f"M({literal(self.speech.part(MathRow(tuple(parts))))},${printed}$)"

    def run_in(self, section: tree.Section) -> str:
        number = f"#{literal(section.number)}#h(0.5em)" if section.number else ""
        return f"#strong[{number}{self.inlines(section.title)}]{_label(section.key)}#h(0.6em)"

    # --- blocks -----------------------------------------------------------------------------------

    def items(self, block: tree.List) -> str:
        inner = _Blocks(self.language, self.words, self.speech, self.letter, self.close, self.room - LIST_INDENT)
        name = f"enum(start:{block.start}," if block.ordered else "list("
        return f"#{name}{','.join(f'[{inner.write(item)}]' for item in block.items)})"

    def equation(self, equation: tree.Equation) -> str:
        """Return rows that are aligned together in one block each, with the number on the last."""
        groups = layout.in_groups(equation.rows, layout.room_for(self.room, self.close))
        lines = []
        for index, group in enumerate(groups):
            number = equation.number if index == len(groups) - 1 else ""
            first = group[0]
            if isinstance(first, VectorEquation):
                heard = self.speech.equation([self.speech.vector_equation(first)], number)
                lines.append(f"#V({literal(heard)},{literal(number)},{self.room:g},{self.vector_equation(first)})")
            else:
                laid_out = [displayed(row, self.language, layout.fits) for row in group]
                heard = self.speech.equation(map(self.speech.row, laid_out), number)
                rows = ",".join(_array(self.row(sides)) for sides in laid_out)
                name, *further = self.setter(group, laid_out, number)
                lines.append(f"#{name}({','.join((literal(heard), literal(number), *further, rows))})")
        return "\n".join(lines) + _label(equation.key)

    def setter(self, rows: Sequence[Expression], laid_out: Sequence[Sequence[object]], number: str) -> list[str]:
        """Return the function of the frame that aligns rows, with further arguments; it measures what is in doubt.

        `F` sets rows below each other, `A` in two columns, `J` in the way for which there is room; `E` may break them.
        Rows without a number are set in two columns if they fit.
        """
        own = [box(row, self.size, displayed=True).width for row in rows]
        heads = [self.head(row, len(parts)) for row, parts in zip(rows, laid_out, strict=True)]

        def widths(start: int, step: int) -> list[float]:
            """Return the width (mm) to which each row brings those whose relations are aligned below each other."""
            left = heads[start::step]
            return [max(left) + row - head for row, head in zip(own[start::step], left, strict=True)]

        below, two = widths(0, 1), math.inf
        if len(rows) > 1 and not number:
            two = max(widths(0, 2)) + layout.ABREAST + max(widths(1, 2))
        room, gap = self.room - (NUMBER_ROOM if number else 0.0), f"{layout.ABREAST:g}"
        if two + _doubt(two) <= room:
            return ["A", gap]
        # Rows with a long left side are not aligned.
        short = max(heads) + _doubt(max(heads)) <= LONG_HEAD * room
        sure = [width + _doubt(width) <= room for width in below]
        may_be_two = two - _doubt(two) <= room
        if all(sure) and not may_be_two and (short or len(rows) == 1):
            return ["F"]
        if all(sure) and short:
            return ["J", gap, f"{self.room:g}"]
        known = _array(str(int(short and one)) for one in sure)
        return ["E", gap if may_be_two else "none", f"{self.room:g}", known]

    def head(self, row: Expression, parts: int) -> float:
        """Return the width before the first relation of a row displayed in `parts` parts (mm)."""
        if not isinstance(row, Chain) or parts == 1:
            return 0.0
        return box(row.parts[0], self.size, displayed=True).width

    def row(self, sides: Sequence[Sequence[Part]]) -> list[str]:
        """Return a displayed row: the parts between "=", each as the pieces between which it may break."""
        part = self.formulas.part
        return [_array(f"${part(piece).strip()}$" for piece in side) for side in sides]

    def vector_equation(self, equation: VectorEquation) -> str:
        known, part = self.formulas.known, self.formulas.part
        terms = (
            _array(
                (f"${''.join(sign.of for sign in column.signs)}$", f"${part(column.term)}$", *map(known, column.known))
            )
            for column in columns(equation)
        )
        return ",".join((_array(map(literal, equation.rows)), *terms))

    def table(self, table: tree.Table) -> str:
        label = self.caption(self.words.table, table) if table.caption or table.number else "none,none"
        columns = _array(f"{column.width:g}" for column in table.columns)
        aligns = _array(column.align for column in table.columns)
        head = _array(_array(self.cell(cell, "U") for cell in row) for row in table.head)
        rows = ",\n".join(_array(self.cell(cell, "X") for cell in row) for row in table.rows)
        together = _together(layout.held(table))
        again = self.again(self.words.table, table) if table.number else "none"
        framed = "framed:true," if table.framed else ""
        low = [not self.letter.font and self.is_low(row, table.columns) for row in table.rows]
        framed += f"low:{'true' if all(low) else _array(map(str, map(int, low)))}," if any(low) else ""
        return f"#R({framed}{label},{again},{columns},{aligns},{head},{together},\n{rows})" + _label(table.key)

    def is_low(self, row: Sequence[tree.Cell], columns: Sequence[tree.Column]) -> bool:
        """Return True if a table row certainly is one line high, with plain texts and symbols only."""
        at = 0
        for cell in row:
            width = 0.0
            for inline in cell.inlines:
                match inline:
                    case tree.Text(text):
                        width += box(text, CELL).width
                    case tree.Value(number) if not by_power_of_ten(number.value, number.decimals):
                        width += box(written(number, self.language).text(NARROW), CELL).width
                    case tree.InlineMath(Symbol(base, sup="", over="") as symbol) if base.isalpha():
                        extent = box(symbol, CELL)
                        width += extent.width
                        if max(extent.height - CAPITAL, extent.depth) > OUT:
                            return False
                    case _:
                        return False
            room = sum(column.width for column in columns[at : at + cell.span]) - CELL_INSET
            if width > LOW * room:
                return False
            at += cell.span
        return True

    def cell(self, cell: tree.Cell, spanned: str) -> str:
        """Return a cell as content, or as a string if it is plain text.

        The typesetter lays out equal strings once, but content of each place in the source anew.
        """
        body = self.content(cell.inlines)
        if single := SINGLE.fullmatch(body, 1, len(body) - 1):
            body = single[1]
        return f"{spanned}({cell.span},{body})" if cell.span > 1 else body

    def rows(self, rows: Sequence[Sequence[Scene]], block: tree.Figure) -> str:
        return ",".join(
            _array(f"({self.drawing(scene, block)},{literal(scene.title)})" for scene in row) for row in rows
        )

    def drawing(self, scene: Scene, block: tree.Figure | tree.Plate) -> str:
        """Return a scene with its text alternative."""
        return f"D({literal(figure_text(block, scene, self.words, self.language))},{paint_typst(scene, self.formulas)})"

    def caption(self, word: str, block: tree.Table | tree.Figure | tree.Plate) -> str:
        """Return the two arguments of a caption: its label and its text."""
        return f"{literal(f'{word} {block.number}'.strip())},{self.content(block.caption)}"

    def again(self, word: str, block: tree.Table | tree.Plate) -> str:
        """Return the label of a continuation from the page before."""
        return literal(f"{word} {block.number}{setting_of(self.language).aside(self.words.continued)}")


def _doubt(width: float) -> float:
    """Return the uncertainty of an estimated width (mm): a few letters plus a few per cent."""
    return 4.0 + 0.05 * width if width < math.inf else 0.0


def _together(groups: Sequence[int]) -> str:
    """Return the rows of a table that stay together: 0 for all, one number for both ends, or all group sizes."""
    first, *between, last = groups if len(groups) > 1 else (0, 0)
    return str(first) if first == last and set(between) <= {1} else _array(map(str, groups))


def _text(text: str) -> str:
    """Return a text as a string, with units and file names in boxes, since lines would break after a slash."""
    parts = layout.UNBROKEN.split(text)
    # After each piece of text come both groups, one of which is the match.
    return "".join(
        f"#box({literal(part)})" if index % 3 else f"#{literal(part)}"
        for index, part in enumerate(parts)
        if part or len(parts) == 1
    )


def _label(key: str) -> str:
    """Return an anchor after the block before it, for links to `key`."""
    return f"#label({literal(key)})" if key else ""
