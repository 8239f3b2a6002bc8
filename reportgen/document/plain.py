"""The plain text of a document, in order: what snapshots compare and what a text-only reader sees.

Symbols are written base_sub^sup, numbers as printed in the document's language, drawings by their captions.
"""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.document.tree import (
    BlankLine,
    Block,
    Cell,
    Contents,
    Cover,
    Document,
    Emph,
    Equation,
    Figure,
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
    Words,
)
from reportgen.notation.expressions import (
    Call,
    Chain,
    Expression,
    Fraction,
    Matrix,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    Symbol,
    Term,
    VectorEquation,
)
from reportgen.notation.numbers import MINUS, Language, write

_UNSPACED = ("", "°", "%")


def text_of(document: Document) -> str:
    """All text of a document, a line for each heading, paragraph, row and formula."""
    return "\n".join(line for block in document.blocks for line in lines_of(block, document)) + "\n"


def lines_of(block: Block, document: Document) -> Iterator[str]:
    """The lines of one block, in the words and the language of its document."""
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
        case Figure() | Plate():
            yield from _caption(block, words, language)
        case Cover(institution, title_lines, subtitle, fields, place_and_date):
            yield from (*institution, *title_lines, *subtitle)
            yield from (f"{label}: {value or '…'}" for label, value in fields)
            yield place_and_date
        case Contents(heading):
            yield heading
        case BlankLine(label):
            yield f"{label} …".strip()
        case PageBreak():
            pass


def _caption(block: Table | Figure | Plate, words: Words, language: Language) -> Iterator[str]:
    if block.number or block.caption:
        word = words.table if isinstance(block, Table) else words.figure
        yield f"{word} {block.number}. {plain(block.caption, language)}".strip()


def _row(cells: tuple[Cell, ...], language: Language) -> str:
    return " | ".join(plain(cell.inlines, language) for cell in cells)


def plain(inlines: Inlines, language: Language) -> str:
    """The text of inlines in one line."""
    result = []
    for inline in inlines:
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
    return "".join(result)


def quantity(number: Number, language: Language) -> str:
    """A number as printed, with its unit."""
    gap = "" if number.unit in _UNSPACED else " "
    return f"{write(number.value, number.decimals, language)}{gap}{number.unit}"


def formula(node: Expression, language: Language) -> str:
    """An expression in one line: `v_BA = ω_2·l_AB`, parentheses wherever the line would be misread."""
    match node:
        case Symbol(base, sub, sup):
            return base + (f"_{sub}" if sub else "") + (f"^{sup}" if sup else "")
        case Number():
            return quantity(node, language)
        case Ref(id):
            return f"[{id}]"
        case Sum(terms):
            return "".join(_term(term, index == 0, language) for index, term in enumerate(terms))
        case Product(factors):
            return "·".join(_tight(factor, Product, language) for factor in factors)
        case Negative(of):
            return MINUS + _tight(of, Product, language)
        case Fraction(top, bottom):
            return f"{_tight(top, Product, language)}/{_tight(bottom, None, language)}"
        case Power(base, exponent):
            return f"{_tight(base, None, language)}^{_tight(exponent, None, language)}"
        case Root(of):
            return f"√({formula(of, language)})"
        case Call(name, arguments):
            return f"{name}({'; '.join(formula(argument, language) for argument in arguments)})"
        case Matrix(rows):
            return f"[{' | '.join('; '.join(formula(entry, language) for entry in row) for row in rows)}]"
        case Chain(parts, note):
            return " = ".join(formula(part, language) for part in parts) + (f" ({note})" if note else "")
        case VectorEquation(sides, rows):
            equation = " = ".join(_side(side, language) for side in sides)
            return "\n".join([equation, *(_known(sides, i, row, language) for i, row in enumerate(rows))])


def _tight(node: Expression, loosest: type[Product] | None, language: Language) -> str:
    """The node, in parentheses unless it is one piece (or as tight as `loosest`)."""
    inner = formula(node, language)
    single = isinstance(node, (Symbol, Ref, Root, Call, Matrix)) or (isinstance(node, Number) and node.shown >= 0)
    if loosest is Product:
        single = single or isinstance(node, (Product, Fraction, Power))
    return inner if single else f"({inner})"


def _term(term: Expression, first: bool, language: Language) -> str:
    match term:
        case Negative(of):
            sign, inner = MINUS, _tight(of, Product, language)
        case _:
            sign, inner = "+", formula(term, language) if first else _tight(term, Product, language)
    if first:
        return sign.removeprefix("+") + inner
    return f" {sign} {inner}"


def _side(terms: tuple[Term, ...], language: Language) -> str:
    return "".join(
        _term(term.symbol if term.sign > 0 else Negative(term.symbol), index == 0, language)
        for index, term in enumerate(terms)
    )


def _known(sides: tuple[tuple[Term, ...], ...], index: int, row: str, language: Language) -> str:
    """A line below a vector equation: what is known of each term, "?" where nothing is."""
    cells = []
    for term in (term for side in sides for term in side):
        known = term.known[index] if index < len(term.known) else ""
        match known:
            case None:
                cells.append("?")
            case str(text):
                cells.append(text)
            case expression:
                cells.append(formula(expression, language))
    return f"{row}: {' | '.join(cells)}"
