"""The plain text of a document, in order: what snapshots compare and what a text-only reader sees.

Symbols are written base_sub^sup, numbers as printed in the document's language, drawings by their captions.
"""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.document import tree
from reportgen.notation import expressions as ex
from reportgen.notation.numbers import MINUS, Language, write

_UNSPACED = ("", "°", "%")


def text_of(document: tree.Document) -> str:
    """All text of a document, a line for each heading, paragraph, row and formula."""
    return "\n".join(line for block in document.blocks for line in lines_of(block, document)) + "\n"


def lines_of(block: tree.Block, document: tree.Document) -> Iterator[str]:
    """The lines of one block, in the words and the language of its document."""
    language, words = document.language, document.words
    match block:
        case tree.Section(_, title, number=number):
            yield f"{number} {plain(title, language)}".strip()
        case tree.Paragraph(inlines):
            yield plain(inlines, language)
        case tree.List(items, ordered, start):
            for index, item in enumerate(items):
                mark = f"{start + index}." if ordered else "•"
                for i, line in enumerate(line for inner in item for line in lines_of(inner, document)):
                    yield f"{mark} {line}" if i == 0 else f"{' ' * len(mark)} {line}"
        case tree.Equation(rows, number=number):
            for row in rows:
                yield formula(row, language) + (f"  ({number})" if number and row is rows[-1] else "")
        case tree.Table(_, head, rows):
            yield from _caption(block, words, language)
            for cells in (*head, *rows):
                yield _row(cells, language)
        case tree.Figure() | tree.Plate():
            yield from _caption(block, words, language)
        case tree.Cover(institution, title_lines, subtitle, fields, place_and_date):
            yield from (*institution, *title_lines, *subtitle)
            yield from (f"{label}: {value or '…'}" for label, value in fields)
            yield place_and_date
        case tree.Contents(heading):
            yield heading
        case tree.BlankLine(label):
            yield f"{label} …".strip()
        case tree.PageBreak():
            pass


def _caption(block: tree.Table | tree.Figure | tree.Plate, words: tree.Words, language: Language) -> Iterator[str]:
    if block.number or block.caption:
        word = words.table if isinstance(block, tree.Table) else words.figure
        yield f"{word} {block.number}. {plain(block.caption, language)}".strip()


def _row(cells: tuple[tree.Cell, ...], language: Language) -> str:
    return " | ".join(plain(cell.inlines, language) for cell in cells)


def plain(inlines: tree.Inlines, language: Language) -> str:
    """The text of inlines in one line."""
    result = []
    for inline in inlines:
        match inline:
            case tree.Text(text) | tree.Reference(text=text):
                result.append(text)
            case tree.Emph(of) | tree.Strong(of):
                result.append(plain(of, language))
            case tree.InlineMath(expression):
                result.append(formula(expression, language))
            case tree.Value(number):
                result.append(quantity(number, language))
            case tree.LineBreak():
                result.append(" ")
    return "".join(result)


def quantity(number: ex.Number, language: Language) -> str:
    """A number as printed, with its unit."""
    gap = "" if number.unit in _UNSPACED else " "
    return f"{write(number.value, number.decimals, language)}{gap}{number.unit}"


def formula(node: ex.Expression, language: Language) -> str:
    """An expression in one line: `v_BA = ω_2·l_AB`, parentheses wherever the line would be misread."""
    match node:
        case ex.Symbol(base, sub, sup):
            return base + (f"_{sub}" if sub else "") + (f"^{sup}" if sup else "")
        case ex.Number():
            return quantity(node, language)
        case ex.Ref(id):
            return f"[{id}]"
        case ex.Sum(terms):
            return "".join(_term(term, index == 0, language) for index, term in enumerate(terms))
        case ex.Product(factors):
            return "·".join(_tight(factor, ex.Product, language) for factor in factors)
        case ex.Negative(of):
            return MINUS + _tight(of, ex.Product, language)
        case ex.Fraction(top, bottom):
            return f"{_tight(top, ex.Product, language)}/{_tight(bottom, None, language)}"
        case ex.Power(base, exponent):
            return f"{_tight(base, None, language)}^{_tight(exponent, None, language)}"
        case ex.Root(of):
            return f"√({formula(of, language)})"
        case ex.Call(name, arguments):
            return f"{name}({'; '.join(formula(argument, language) for argument in arguments)})"
        case ex.Matrix(rows):
            return f"[{' | '.join('; '.join(formula(entry, language) for entry in row) for row in rows)}]"
        case ex.Chain(parts, note):
            return " = ".join(formula(part, language) for part in parts) + (f" ({note})" if note else "")
        case ex.VectorEquation(sides, rows):
            equation = " = ".join(_side(side, language) for side in sides)
            return "\n".join([equation, *(_known(sides, i, row, language) for i, row in enumerate(rows))])


def _tight(node: ex.Expression, loosest: type[ex.Product] | None, language: Language) -> str:
    """The node, in parentheses unless it is one piece (or as tight as `loosest`)."""
    inner = formula(node, language)
    single = isinstance(node, (ex.Symbol, ex.Ref, ex.Root, ex.Call, ex.Matrix))
    if isinstance(node, ex.Number):
        single = node.shown >= 0
    elif loosest is ex.Product:
        single = single or isinstance(node, (ex.Product, ex.Fraction, ex.Power))
    return inner if single else f"({inner})"


def _term(term: ex.Expression, first: bool, language: Language) -> str:
    match term:
        case ex.Negative(of):
            sign, inner = MINUS, _tight(of, ex.Product, language)
        case _:
            sign, inner = "+", formula(term, language) if first else _tight(term, ex.Product, language)
    if first:
        return sign.removeprefix("+") + inner
    return f" {sign} {inner}"


def _side(terms: tuple[ex.Term, ...], language: Language) -> str:
    return "".join(
        _term(term.symbol if term.sign > 0 else ex.Negative(term.symbol), index == 0, language)
        for index, term in enumerate(terms)
    )


def _known(sides: tuple[tuple[ex.Term, ...], ...], index: int, row: str, language: Language) -> str:
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
