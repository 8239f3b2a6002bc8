"""Expressions → LaTeX mathematics, without the dollar signs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

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
    Term,
    VectorEquation,
    walk,
)
from reportgen.notation.numbers import MINUS, Language, write
from reportgen.writers import layout
from reportgen.writers.latex_text import MATHEMATICAL, escape

SignedTerm = tuple[str, Term]
"""A term of a vector equation with the sign or relation printed before it."""

NARROW_TERMS = 5
"""A vector equation of at most so many terms fits any line."""


def mathematics(node: Expression, language: Language) -> str:
    """The formula of an expression; sums and chains carry the places where a line may break.

    Raises `TypesetterError` for a reference nobody substituted or a character the fonts do not have.
    """
    match node:
        case Symbol():
            return _symbol(node)
        case Number(value, decimals, unit):
            return _digits(write(value, decimals, language)) + _unit(unit)
        case Ref(id):
            raise TypesetterError(f"quantity {id!r} came to the page without its symbol or value")
        case Sum(terms):
            return _sum(terms, language)
        case Product(factors):
            return r" \dotbreak\cdot ".join(_tight(factor, layout.PRODUCT, language) for factor in factors)
        case Negative(of):
            return f"-{_tight(of, layout.PRODUCT, language)}"
        case Fraction(top, bottom):
            return rf"\frac{{{mathematics(top, language)}}}{{{mathematics(bottom, language)}}}"
        case Power(base, exponent):
            return _power(base, mathematics(exponent, language), language)
        case Root(of):
            return rf"\sqrt{{{mathematics(of, language)}}}"
        case Call():
            return _call(node, "", language)
        case Matrix(rows):
            lines = (" & ".join(mathematics(entry, language) for entry in row) for row in rows)
            return _bracketed(r"\begin{matrix}" + r" \\ ".join(lines) + r"\end{matrix}")
        case Chain(parts, note):
            printed = mathematics(parts[0], language)
            for index, part in enumerate(parts[1:], 2):
                unparted = index == len(parts) and layout.short_end(node)
                printed += (" = " if unparted else r" \relbreak= ") + mathematics(part, language)
            return printed + (rf" \relbreak\quad\text{{({escape(note)})}}" if note else "")
        case VectorEquation():
            return " ".join(f"{_sign(sign)} {_symbol(term.symbol)}" for sign, term in layout.signed(node))


def _bracketed(inner: str) -> str:
    """Square brackets as tall as what they hold; copied from the page they are single characters."""
    strut = rf"\vphantom{{{inner}}}"
    opening = rf"\mathopen{{\reportactual{{005B}}{{\left[{strut}\right.\kern-\nulldelimiterspace}}}}"
    closing = rf"\mathclose{{\reportactual{{005D}}{{\kern-\nulldelimiterspace\left.{strut}\right]}}}}"
    return opening + inner + closing


def aligned(node: Expression, language: Language) -> tuple[str, str]:
    """A displayed line cut at its first relation: what stands left of it, and the rest.

    A vector equation is a grid and not cut.  Raises `TypesetterError` as `mathematics` does.
    """
    if isinstance(node, VectorEquation):
        return "", _vector_equation(list(layout.signed(node)), node.rows, language)
    if isinstance(node, Chain) and len(node.parts) > 1:
        relation = " = " if len(node.parts) == 2 and layout.short_end(node) else r" \relbreak= "
        return (
            mathematics(node.parts[0], language),
            relation + mathematics(Chain(node.parts[1:], node.note), language),
        )
    return "", mathematics(node, language)


# --- atoms ----------------------------------------------------------------------------------------


def _symbol(symbol: Symbol) -> str:
    letters = symbol.base.rstrip("".join(layout.PRIMES))
    primes = symbol.base[len(letters) :]
    base = letters if len(letters) == 1 and _is_mathematical(letters) else _word(letters, "it")
    if symbol.over == "vector":
        base = rf"\vec{{{base}}}" if len(letters) == 1 else rf"\overrightarrow{{{base}}}"
    elif symbol.over == "segment":
        base = rf"\overline{{{base}}}"
    below = f"_{{{_word(symbol.sub)}}}" if symbol.sub else ""
    above = f"^{{{_word(primes + symbol.sup)}}}" if primes or symbol.sup else ""
    return base + below + above


def _is_mathematical(text: str) -> bool:
    return all(char in MATHEMATICAL or (char.isascii() and char.isalnum()) for char in text)


def _word(text: str, shape: Literal["rm", "it"] = "rm") -> str:
    """A run of letters in one alphabet of TeX; whatever else a writer put there is set as text."""
    if text.isdigit() and text.isascii():
        return text
    primes = {"′": r"\prime", "″": r"\prime\prime"}
    if text and all(char in primes for char in text):
        return "".join(primes[char] for char in text)
    if _is_mathematical(text):
        return rf"\math{shape}{{{text}}}"
    return rf"\text{{\text{'it' if shape == 'it' else 'up'}{{{escape(text)}}}}}"


def _digits(text: str) -> str:
    """Digits in mathematics: no gap after the decimal comma, a true minus sign."""
    if not any(char.isdigit() for char in text):
        return rf"\text{{{escape(text)}}}"
    return text.replace(",", "{,}").replace(MINUS, "-")


def _unit(unit: str) -> str:
    gap = "" if unit in layout.UNSPACED else r"\,"
    return rf"{gap}\text{{{escape(unit)}}}" if unit else ""


# --- operations -----------------------------------------------------------------------------------


def _tight(node: Expression, least: int, language: Language) -> str:
    """The node, in parentheses if it binds less tightly than `least`."""
    return mathematics(node, language) if layout.level(node) >= least else _parentheses(node, language)


def _parentheses(node: Expression, language: Language) -> str:
    inner = mathematics(node, language)
    if any(isinstance(part, (Fraction, Root)) for part in walk(node)):
        return rf"\mathopen{{}}\left({inner}\right)"
    return f"({inner})"


def _sum(terms: tuple[Expression, ...], language: Language) -> str:
    printed = [mathematics(terms[0], language)] if terms else []
    for term in terms[1:]:
        if isinstance(term, Negative):
            printed.append(r"\binbreak- " + _tight(term.of, layout.PRODUCT, language))
        else:
            printed.append(r"\binbreak+ " + _tight(term, layout.PRODUCT, language))
    return " ".join(printed)


def _power(base: Expression, exponent: str, language: Language) -> str:
    if isinstance(base, Call) and base.name in layout.NAMED:
        return _call(base, f"^{{{exponent}}}", language)
    return f"{_tight(base, layout.ATOM, language)}^{{{exponent}}}"


def _call(node: Call, exponent: str, language: Language) -> str:
    match node.name, node.arguments:
        case "abs", (argument,):
            return rf"\left|{mathematics(argument, language)}\right|"
        case ("cross" | "dot") as product, (left, right):
            sign = r"\times" if product == "cross" else r"\cdot"
            return f"{_tight(left, layout.QUOTIENT, language)} {sign} {_tight(right, layout.QUOTIENT, language)}"
        case name, (argument,) if name in layout.NAMED and layout.level(argument) >= layout.MARKED:
            return f"{_function(name)}{exponent} {mathematics(argument, language)}"
        case name, (argument,):
            return f"{_function(name)}{exponent}{_parentheses(argument, language)}"
        case name, arguments:
            mark = "; " if language == "vi" else ", "
            inner = mark.join(mathematics(argument, language) for argument in arguments)
            return f"{_function(name)}{exponent}({inner})"


def _function(name: str) -> str:
    return rf"\{name}" if name in layout.NAMED else rf"\operatorname{{{escape(name)}}}"


# --- vector equations -----------------------------------------------------------------------------


def _vector_equation(terms: Sequence[SignedTerm], rows: Sequence[str], language: Language) -> str:
    """A grid; if it is too wide for the line, two grids of half the terms, one below the other."""
    whole = _grid(terms, rows, language)
    if len(terms) <= NARROW_TERMS:
        return whole
    half = (len(terms) + 1) // 2
    upper, lower = (_vector_equation(part, rows, language) for part in (terms[:half], terms[half:]))
    return rf"\fitting{{{whole}}}{{\storeys{{{upper}}}{{{lower}}}}}"


def _grid(terms: Sequence[SignedTerm], rows: Sequence[str], language: Language) -> str:
    """Terms on top, below each what is known of it; "?" marks an unknown."""
    lines = ["&" + "&".join(f"{_sign(sign)}&{_symbol(term.symbol)}" for sign, term in terms)]
    for row, name in enumerate(rows):
        entries = (term.known[row] if row < len(term.known) else "" for _, term in terms)
        known = "&".join(f"&{_known(entry, language)}" for entry in entries)
        lines.append(rf"\rowname{{{escape(name)}}}&{known}")
    if rows:
        lines[1] = rf"\cline{{2-{2 * len(terms) + 1}}}{lines[1]}"
    body = r"\\".join(lines)
    return rf"\begin{{vectorgrid}}{{{len(terms)}}}{body}\end{{vectorgrid}}"


def _sign(sign: str) -> str:
    return sign.replace(MINUS, "-")


def _known(entry: Expression | str | None, language: Language) -> str:
    if entry is None:
        return r"\known{?}"
    inner = escape(entry) if isinstance(entry, str) else f"${mathematics(entry, language)}$"
    return rf"\known{{{inner}}}"
