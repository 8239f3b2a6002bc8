"""Formulas as Word's own (OMML), and the line breaking of displayed ones.

Upright texts in formulas are `m:nor`. A word processor that reads a formula as its own source text must not find
keywords in it, so each letter of a name is a separate run.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import ClassVar

from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.document import TEXT_WIDTH
from reportgen.document.layout import ABREAST, fits, in_groups
from reportgen.drawing.label_size import POINT, Boxes
from reportgen.formula import Expression, Symbol, VectorEquation
from reportgen.formula.formula_layout import (
    EQUALS,
    NARROW,
    Fence,
    MathRow,
    Parenthesis,
    Part,
    Sign,
    TermColumn,
    Written,
    columns,
    displayed,
    parted,
)
from reportgen.formula.formula_setter import TextSetter
from reportgen.formula.vocabulary import numbered, runs
from reportgen.writers.word_elements import GRID, ITALIC, KEPT, LIGHT, MATH_FONT, escape, paragraph, rule, run, twips
from reportgen.writers.word_styles import EQUATION_SIZE, KNOWN_SIZE

QUAD, EMPTY = "\N{EM SPACE}", "\N{ZERO WIDTH SPACE}"
_UPRIGHT = f'<m:rPr><m:nor/></m:rPr><w:rPr><w:rFonts w:ascii="{MATH_FONT}" w:hAnsi="{MATH_FONT}"/></w:rPr>'
_FIGURES = frozenset("0123456789,.")
"""Characters of a number that any reader of formulas recognises as one."""


def letters(text: str) -> str:
    """Return letters of a formula, in the typeface that Word uses for them."""
    return f'<m:r><m:t xml:space="preserve">{escape(text)}</m:t></m:r>'


def upright(text: str) -> str:
    """Return an upright text within a formula."""
    return f'<m:r>{_UPRIGHT}<m:t xml:space="preserve">{escape(text)}</m:t></m:r>'


def displayed_formula(mathematics: str, align: str = "center") -> str:
    """Return a displayed formula, aligned within its paragraph."""
    jc = f'<m:oMathParaPr><m:jc m:val="{align}"/></m:oMathParaPr>'
    return f"<m:oMathPara>{jc}<m:oMath>{mathematics}</m:oMath></m:oMathPara>"


class OmmlFormulas(TextSetter):
    """Writer of expressions as OMML, in one language."""

    BELOW = "<m:sSub><m:e>%s</m:e><m:sub>%s</m:sub></m:sSub>"
    RAISED = POWER = "<m:sSup><m:e>%s</m:e><m:sup>%s</m:sup></m:sSup>"
    QUOTIENT = "<m:f><m:num>%s</m:num><m:den>%s</m:den></m:f>"
    RADICAL = '<m:rad><m:radPr><m:degHide m:val="1"/></m:radPr><m:deg/><m:e>%s</m:e></m:rad>'
    FENCES: ClassVar = {
        "": "%s",
        "(": "<m:d><m:e>%s</m:e></m:d>",
        "|": '<m:d><m:dPr><m:begChr m:val="|"/><m:endChr m:val="|"/></m:dPr><m:e>%s</m:e></m:d>',
        "[": '<m:d><m:dPr><m:begChr m:val="["/><m:endChr m:val="]"/></m:dPr>'
        "<m:e><m:m><m:mr><m:e>%s</m:e></m:mr></m:m></m:e></m:d>",
    }
    ENTRY, LINE = "</m:e><m:e>", "</m:e></m:mr><m:mr><m:e>"
    APPLIED = CALL = "<m:func><m:fName>%s</m:fName><m:e>%s</m:e></m:func>"
    NOTE = f"{upright(QUAD)}%s"

    def text(self, text: str) -> str:
        return upright(text)

    def content(self, content: Expression | str, slashed: bool = False) -> str:
        return self.inline(upright(content) if isinstance(content, str) else self.math(content, slashed))

    def inline(self, mathematics: str) -> str:
        return f"<m:oMath>{mathematics}</m:oMath>"

    def number(self, number: Written) -> str:
        digits = number.digits.lstrip("−")
        minus = letters("−") * (len(number.digits) - len(digits))
        digits_text = minus + (letters(digits) if _FIGURES.issuperset(digits) else upright(digits))
        gap = NARROW if number.spaced else ""
        return digits_text + (upright(gap + number.unit) if number.unit else "")

    def sign(self, sign: Sign) -> str:
        return upright(f"{sign.of} ") if sign.role == "separator" else letters(sign.of)

    def function(self, name: str) -> str:
        return upright(name)

    def mark(self, mark: Parenthesis) -> str:
        return letters(mark.of)

    def symbol(self, node: Symbol) -> str:
        """Return a symbol with its marks: base in italics, sub- and superscript upright, a bar over all of it."""
        name, above = parted(node)
        base = self.lowered(runs(name), lambda part: "".join(map(letters, part)))
        if node.over == "vector":
            base = f'<m:acc><m:accPr><m:chr m:val="\u20d7"/></m:accPr><m:e>{base}</m:e></m:acc>'
        below = self.lowered(numbered(node.sub), upright) if node.sub else ""
        marked = _scripted(base, below, upright(above) if above else "")
        if node.over == "segment":
            return f'<m:bar><m:barPr><m:pos m:val="top"/></m:barPr><m:e>{marked}</m:e></m:bar>'
        return marked

    def line(self, part: Part) -> str:
        """Return the content of a line; a sign at its head gets an empty text before it as its first operand."""
        mathematics = self.part(part)
        return upright(EMPTY) + mathematics if isinstance(_first(part), Sign) else mathematics


def _scripted(base: str, below: str, above: str) -> str:
    if below and above:
        return f"<m:sSubSup><m:e>{base}</m:e><m:sub>{below}</m:sub><m:sup>{above}</m:sup></m:sSubSup>"
    if below:
        return OmmlFormulas.BELOW % (base, below)
    return OmmlFormulas.RAISED % (base, above) if above else base


def _first(part: Part) -> Part:
    match part:
        case MathRow((first, *_)) | Fence("", first):
            return _first(first)
    return part


# --- displayed rows in lines ----------------------------------------------------------------------

EM = EQUATION_SIZE * POINT
LONG_HEAD = 0.45
"""Share of the room above which a left side prevents alignment, so that lines flow from the left."""
HANGING, WITHIN = 2.0, 1.6
"""Indentations (em) of a continuation line in a flow, and within a side of a row."""


class FormulaLine(Record):
    """A line of a displayed equation: the part left of the "=" that lines are aligned at, and the rest."""

    left: Part
    rest: Part
    indent: float = 0.0
    """Indentation of the rest (mm)."""

    @property
    def whole(self) -> Part:
        return MathRow((self.left, self.rest))

    @property
    def widths(self) -> tuple[float, float]:
        """Widths of both parts (mm)."""
        return width(self.left), self.indent + width(self.rest)


NOTHING = MathRow(())


def width(*parts: Part) -> float:
    """Return the width of parts side by side in a displayed formula (mm)."""
    return Boxes(EM, displayed=True).part(MathRow(parts)).width


def broken(rows: Sequence[Expression], language: Language, room: float) -> list[FormulaLine]:
    """Return the lines of displayed rows within a room (mm), aligned and broken as in the PDF."""
    sides = [displayed(row, language, fits) for row in rows]
    heads = [width(*first) if others else 0.0 for first, *others in sides]
    head = max(heads)
    formula_lines: list[FormulaLine] = []
    for first, *others in sides:
        # Without a relation to align at, or with a long left side, the row flows from the left.
        flowing = not others or head > LONG_HEAD * room
        equated = [_equated(side) for side in others]
        rest = tuple(chain.from_iterable(equated))
        if flowing and (head if others else 0.0) + width(*first, *rest) > room:
            formula_lines += _filled([*first, *rest], room, HANGING * EM)
        elif flowing and not others:
            formula_lines.append(FormulaLine(NOTHING, MathRow(tuple(first))))
        elif flowing or head + width(*rest) <= room:
            formula_lines.append(FormulaLine(MathRow(tuple(first)), MathRow(rest)))
        else:
            lines = _relations(equated, room - head)
            formula_lines += [FormulaLine(MathRow(tuple(first)), lines[0].rest, lines[0].indent), *lines[1:]]
    return formula_lines


def _equated(side: Sequence[Part]) -> list[Part]:
    """Return the pieces of a side, after its "="."""
    return [MathRow((EQUALS, side[0])), *side[1:]]


def _relations(equated: Sequence[Sequence[Part]], room: float) -> list[FormulaLine]:
    """Return the sides of a row in lines, each as full as possible; a side too wide for a line is broken inside."""
    lines: list[FormulaLine] = []
    for side in equated:
        if lines and lines[-1].widths[1] + width(*side) <= room:
            lines[-1] = replace(lines[-1], rest=MathRow((lines[-1].rest, *side)))
        else:
            lines += _filled(side, room, WITHIN * EM)
    return lines


def _filled(pieces: Sequence[Part], room: float, indent: float) -> list[FormulaLine]:
    """Return lines of pieces, within the room where a break can help; later ones are indented."""
    lines: list[list[Part]] = [[pieces[0]]]
    for piece in pieces[1:]:
        if width(*lines[-1], piece) + (indent if len(lines) > 1 else 0.0) <= room:
            lines[-1].append(piece)
        else:
            lines.append([piece])
    return [FormulaLine(NOTHING, MathRow(tuple(line)), indent if index else 0.0) for index, line in enumerate(lines)]


def abreast(lines: Sequence[FormulaLine], room: float) -> bool:
    """Return True if lines fit into the room (mm) in two columns."""
    widths = (max(line.widths[side] for line in lines[at::2]) for at in (0, 1) for side in (0, 1))
    return sum(widths) + ABREAST <= room


# --- vector equations -----------------------------------------------------------------------------

SPREAD = 1.25
"""Largest factor by which columns of a vector equation are widened, because fonts of formulas differ."""
BESIDE = 1.1
"""White space on either side of an entry of a vector equation (mm)."""
BEHIND_NAME = 4.0
"""White space after the name of a row (mm)."""


def name_width(name: str) -> float:
    """Return the width of the name of a row (mm)."""
    return Boxes(KNOWN_SIZE * POINT).text(name).width + BEHIND_NAME


def term_widths(term: TermColumn) -> tuple[float, float]:
    """Return the widths of the signs before a term and of the term with its known data (mm)."""
    small = Boxes(KNOWN_SIZE * POINT)
    entries = [small.content("?" if entry is None else entry, slashed=True).width for entry in term.known]
    return width(*term.signs) + 2 * BESIDE, max(width(term.term), *entries, 0.0) + 2 * BESIDE


def in_storeys(widths: Sequence[float], names: float, room: float) -> list[range]:
    """Return terms of these widths (mm) in as few grids as fit the room, each beside the names of the rows."""
    storeys: list[range] = []
    start, used = 0, names
    for index, term in enumerate(widths):
        if used + term > room and index > start:
            storeys.append(range(start, index))
            start, used = index, names
        used += term
    return [*storeys, range(start, len(widths))]


# --- equations in their places --------------------------------------------------------------------
# Lines are rows of tables without rules, so that all word processors align them alike.

GAP = paragraph("Gap", "")
"""Paragraph between two tables, which would merge without it."""
KEPT_GAP = paragraph("Gap", "", KEPT)
"""The same between tables that stay on one page."""
NUMBER_ROOM = 16.0
"""Width of an equation's number at the right (mm)."""
SLIVER = 1.0
"""Width of an empty column (mm)."""
NO_COLUMNS = range(0)


class GridEntry(Record):
    """The content of a grid cell, its alignment, and its indentation (mm)."""

    content: str = ""
    align: str = "center"
    indent: float = 0.0
    style: str = "Equation"

    @property
    def lines(self) -> str:
        indent = f'<w:ind w:left="{twips(self.indent)}"/>' if self.indent else ""
        return f'{indent}<w:jc w:val="{self.align}"/>'


FREE = GridEntry()


def grid_cell(content: str, width: float, span: int = 1, borders: str = "", align: str = "center") -> str:
    """Return a cell of a width (mm) that spans some columns."""
    spans = f'<w:gridSpan w:val="{span}"/>' if span > 1 else ""
    ruled = f"<w:tcBorders>{borders}</w:tcBorders>" if borders else ""
    size = f'<w:tcW w:w="{twips(width)}" w:type="dxa"/>'
    return f'<w:tc><w:tcPr>{size}{spans}{ruled}<w:vAlign w:val="{align}"/></w:tcPr>{content}</w:tc>'


def grid_table(style: str, widths: Sequence[float], place: str, rows: str) -> str:
    """Return a table of columns of fixed widths (mm); `place` are its position and its own rules."""
    columns = "".join(f'<w:gridCol w:w="{twips(width)}"/>' for width in widths)
    size = f'<w:tblW w:w="{sum(map(twips, widths))}" w:type="dxa"/>'
    look = f'<w:tblPr><w:tblStyle w:val="{style}"/>{size}{place}<w:tblLayout w:type="fixed"/></w:tblPr>'
    return f"<w:tbl>{look}<w:tblGrid>{columns}</w:tblGrid>{rows}</w:tbl>"


class Equations:
    """Writer of displayed equations in one language."""

    def __init__(self, language: Language) -> None:
        self.language: Language = language
        self.formulas = OmmlFormulas(language)

    def displayed(self, rows: Sequence[Expression], number: str, indent: float, kept: str) -> str:
        """Return rows that are aligned together in one table each, indented (mm), with the number beside the last."""
        room = TEXT_WIDTH - indent
        *before, last = in_groups(rows, room)
        groups = [*((group, "", KEPT) for group in before), (last, number, kept)]
        return KEPT_GAP.join(self.group(group, shown, indent, lines) for group, shown, lines in groups)

    def group(self, rows: Sequence[Expression], number: str, indent: float, kept: str) -> str:
        """Return rows that are aligned together, indented (mm)."""
        if isinstance(rows[0], VectorEquation):
            return self.vector_equation(rows[0], number, indent, kept)
        return self.aligned(rows, number, indent, kept)

    def aligned(self, rows: Sequence[Expression], number: str, indent: float, kept: str) -> str:
        """Return rows aligned at their "=", indented (mm); a single line is centred if the number leaves room."""
        beside = NUMBER_ROOM if number else 0.0
        room = TEXT_WIDTH - indent - beside
        lines = broken(rows, self.language, room)
        if len(lines) == 1:
            formula = displayed_formula(self.formulas.line(lines[0].whole))
            if not number:
                indented = f'<w:ind w:left="{twips(indent)}"/>' if indent else ""
                return paragraph("Equation", formula, kept + indented)
            left = beside if sum(lines[0].widths) + beside <= room else SLIVER
            return grid((left, room - left), [[FREE, GridEntry(formula)]], number, indent, kept)
        # Short rows are set in two columns, read line by line.
        count = 2 if not number and len(lines) == len(rows) and abreast(lines, room) else 1
        columns = [max(line.widths[side] for line in lines[at::count]) for at in range(count) for side in (0, 1)]
        free = room - sum(columns) - ABREAST * (count - 1)
        columns[0] += max(SLIVER, min(free, (free + beside) / 2))
        columns[1:-1] = [one + ABREAST / 2 for one in columns[1:-1]]
        columns[-1] += room - sum(columns)
        grid_rows = [
            [place for line in lines[at : at + count] for place in self.sides(line)]
            for at in range(0, len(lines), count)
        ]
        return grid(columns, grid_rows, number, indent, kept)

    def sides(self, line: FormulaLine) -> list[GridEntry]:
        left, rest = self.formulas.line(line.left), self.formulas.line(line.rest)
        return [
            GridEntry(displayed_formula(left, "right") if left else "", "right"),
            GridEntry(displayed_formula(rest, "left"), "left", line.indent),
        ]

    def vector_equation(self, equation: VectorEquation, number: str, indent: float, kept: str) -> str:
        """Return terms in a row, indented (mm), with their known data below, in as many storeys as necessary."""
        room = TEXT_WIDTH - indent - (NUMBER_ROOM if number else 0.0)
        terms = columns(equation)
        widths = [term_widths(term) for term in terms]
        names = max((name_width(name) for name in equation.rows), default=SLIVER)
        storeys = in_storeys([sum(pair) for pair in widths], names, room)
        widest = max(names + sum(sum(widths[index]) for index in storey) for storey in storeys)
        spread = max(1.0, min(SPREAD, (room - SLIVER) / widest))
        names, widest = names * spread, widest * spread
        left = max(SLIVER, min(room - widest, (TEXT_WIDTH - indent - widest) / 2))
        grids = []
        for storey in storeys:
            shown_terms = [place for index in storey for place in self.term(terms[index])]
            rows = [[FREE, FREE, *shown_terms]]
            for row, name in enumerate(equation.rows):
                known = (
                    (FREE, GridEntry(self.formulas.known(terms[index].known[row]), style="Known")) for index in storey
                )
                title = GridEntry(run(name, ITALIC), "left", style="Known")
                rows.append([FREE, title, *chain.from_iterable(known)])
            ruled = range(2, len(rows[0])) if equation.rows else NO_COLUMNS
            sizes = [left, names, *(width * spread for index in storey for width in widths[index])]
            if storey is storeys[-1]:
                grids.append(grid(sizes, rows, number, indent, kept, ruled))
            else:
                grids.append(grid(sizes, rows, "", indent, KEPT, ruled))
        return KEPT_GAP.join(grids)

    def term(self, term: TermColumn) -> list[GridEntry]:
        signs = "".join(sign.of for sign in term.signs)
        return [
            GridEntry(self.formulas.content(signs) if signs else ""),
            GridEntry(displayed_formula(self.formulas.part(term.term))),
        ]


def grid(
    widths: Sequence[float],
    rows: Sequence[Sequence[GridEntry]],
    number: str,
    indent: float,
    kept: str,
    ruled: range = NO_COLUMNS,
) -> str:
    """Return a table whose rows stay together, ruled below `ruled` columns of the first; the number is at the right.

    Widths and `indent` are in mm.
    """
    widths = [*widths, TEXT_WIDTH - indent - sum(widths)] if number else widths
    lines = []
    for index, row in enumerate(rows):
        last = index == len(rows) - 1
        places = [*row, *[FREE] * (len(widths) - len(row))]
        if number and last:
            places[-1] = GridEntry(number, "right")
        cells = "".join(
            grid_cell(
                paragraph(place.style, place.content, (kept if last else KEPT) + place.lines),
                width,
                borders=rule("bottom", LIGHT) if index == 0 and at in ruled else "",
            )
            for at, (place, width) in enumerate(zip(places, widths, strict=True))
        )
        lines.append(f"<w:tr><w:trPr><w:cantSplit/></w:trPr>{cells}</w:tr>")
    return grid_table(GRID, widths, f'<w:tblInd w:w="{twips(indent)}" w:type="dxa"/>', "".join(lines))
