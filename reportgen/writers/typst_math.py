"""Expressions → Typst mathematics, without the dollar signs.

Names and numbers travel as string literals, so nothing in them can become markup, and every operator
stands between spaces, because identifiers of Typst may hold a hyphen.
"""

from __future__ import annotations

from reportgen.errors import TypesetterError
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
    VectorEquation,
)
from reportgen.notation.numbers import Language, write
from reportgen.writers import layout


def literal(text: str) -> str:
    """A string literal of Typst that reads back as `text`."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\n", "\\n").replace("\r", "\\r").replace("\t", "\\t") + '"'


def quantity(number: Number, language: Language) -> str:
    """The plain text of a number and its unit, with a narrow unbreakable space between."""
    gap = "" if number.unit in layout.UNSPACED else "\N{NARROW NO-BREAK SPACE}"
    return write(number.value, number.decimals, language) + gap + number.unit


def math(node: Expression, language: Language) -> str:
    """The formula of an expression, in one line.

    Raises `TypesetterError` for a reference that nobody has substituted.
    """
    match node:
        case Symbol():
            return symbol(node)
        case Number(value, decimals, unit):
            digits = write(value, decimals, language)
            return literal(digits + unit) if unit in layout.UNSPACED else f"{literal(digits)} thin {literal(unit)}"
        case Ref(id):
            raise TypesetterError(f"quantity {id!r} came to the page without its symbol or value")
        case Sum() | Product():
            return " ".join(pieces(node, language))
        case Negative(of):
            return f"−{_tight(of, layout.PRODUCT, language)}"
        case Fraction(top, bottom):
            return f"frac({math(top, language)}, {math(bottom, language)})"
        case Power(base, exponent):
            return _power(base, math(exponent, language), language)
        case Root(of):
            return f"sqrt({math(of, language)})"
        case Call():
            return _call(node, "", language)
        case Matrix(rows):
            printed = (", ".join(math(entry, language) for entry in row) for row in rows)
            return f'mat(delim: "[", {"; ".join(printed)})'
        case Chain(parts):
            return " = ".join(math(part, language) for part in parts) + note(node)
        case VectorEquation():
            return " ".join(f"{sign} {symbol(term.symbol)}" for sign, term in layout.signed(node))


def pieces(node: Expression, language: Language) -> list[str]:
    """A formula's pieces, between which a displayed line may break: terms of a sum, factors of a product."""
    match node:
        case Sum(terms):
            return [_term(term, index == 0, language) for index, term in enumerate(terms)]
        case Product(factors):
            printed = [_tight(factor, layout.PRODUCT, language) for factor in factors]
            return [*printed[:1], *(f"dot.c {factor}" for factor in printed[1:])]
        case Negative(Product() as of):
            first, *others = pieces(of, language)
            return [f"−{first}", *others]
        case _:
            return [math(node, language)]


def note(chain: Chain) -> str:
    """The reason printed in parentheses after a chain's result."""
    return f" quad {literal(f'({chain.note})')}" if chain.note else ""


# --- atoms ----------------------------------------------------------------------------------------


def symbol(node: Symbol) -> str:
    """A symbol with its marks: base in italics, sub- and superscript upright."""
    letters = node.base.rstrip("".join(layout.PRIMES))
    base = letters if len(letters) == 1 and letters.isalpha() else f"italic({literal(letters)})"
    if node.over:
        base = f"{'arrow' if node.over == 'vector' else 'overline'}({base})"
    below = f"_{literal(node.sub)}" if node.sub else ""
    above = node.base[len(letters) :] + node.sup
    return base + below + (f"^({_raised(above)})" if above else "")


def _raised(text: str) -> str:
    """A superscript: primes as Typst's own symbol, which has the right size, everything else upright."""
    letters = text.lstrip("".join(layout.PRIMES))
    primes = {"′": "prime", "″": "prime.double"}
    names = [primes[char] for char in text[: len(text) - len(letters)]]
    return " ".join([*names, literal(letters)] if letters else names)


# --- operations -----------------------------------------------------------------------------------


def _tight(node: Expression, least: int, language: Language) -> str:
    """The node, in parentheses if it binds less tightly than `least`."""
    inner = math(node, language)
    return inner if layout.level(node) >= least else f"({inner})"


def _term(term: Expression, first: bool, language: Language) -> str:
    if first:
        return math(term, language)
    if isinstance(term, Negative):
        return f"− {_tight(term.of, layout.PRODUCT, language)}"
    return f"+ {_tight(term, layout.PRODUCT, language)}"


def _power(base: Expression, exponent: str, language: Language) -> str:
    if isinstance(base, Call) and base.name in layout.NAMED:
        return _call(base, f"^({exponent})", language)
    return f"{_tight(base, layout.ATOM, language)}^({exponent})"


def _call(node: Call, exponent: str, language: Language) -> str:
    name = node.name if node.name in layout.NAMED else f"op({literal(node.name)})"
    match node.name, node.arguments:
        case "abs", (argument,):
            return f"abs({math(argument, language)})"
        case ("cross" | "dot") as product, (left, right):
            sign = "times" if product == "cross" else "dot.c"
            return f"{_tight(left, layout.QUOTIENT, language)} {sign} {_tight(right, layout.QUOTIENT, language)}"
        case _, (argument,) if node.name in layout.NAMED and layout.level(argument) >= layout.MARKED:
            return f"{name}{exponent} {math(argument, language)}"
        case _, arguments:
            # A comma is the decimal mark in Vietnamese.
            mark = ' class("punctuation", ";") ' if language == "vi" else ' class("punctuation", ",") '
            return f"{name}{exponent} ({mark.join(math(argument, language) for argument in arguments)})"
