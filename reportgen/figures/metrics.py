"""How much paper a label takes, from a table of glyph sizes.

The box of a label is the extent of its ink: advance widths, the tallest height above the baseline and
the greatest depth below it.  Scripts are set at 0.7 of the size, as both typesetters do.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from reportgen.figures.scene import Content
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
from reportgen.notation.numbers import write
from reportgen.notation.vocabulary import numbered, runs

POINT = 25.4 / 72.27
"""One printer's point in mm."""
SCRIPT = 0.7
SMALL_CUT = 1.17
"""Letters cut for 6 points, as LaTeX sets scripts, are so much wider than larger ones scaled down."""
SUPER_SHIFT, SUB_SHIFT = 0.38, 0.18
"""Shift of the scripts' baselines, in font sizes."""
OVER = 0.25
"""What an arrow or a bar above takes, in font sizes."""
RELATION = 0.56
"""Width of the space on both sides of a relation or a sign, in font sizes (thick spaces)."""


@dataclass(frozen=True, slots=True)
class Box:
    """Width, height above and depth below the baseline, in mm."""

    width: float
    height: float
    depth: float

    def beside(self, other: Box) -> Box:
        """Both boxes on one baseline."""
        return Box(self.width + other.width, max(self.height, other.height), max(self.depth, other.depth))


@lru_cache(maxsize=4096)
def box(content: Content, size: float = 9.0) -> Box:
    """The box of a label's content at a font size in points; unknown letters count as one em."""
    em = size * POINT
    return _text(content, em) if isinstance(content, str) else _expression(content, em)


def _text(text: str, em: float, italic: bool = False) -> Box:
    glyphs = [(italic and ITALIC.get(letter)) or ROMAN.get(letter) or _unknown(letter) for letter in text]
    if not glyphs:
        return Box(0.0, 0.0, 0.0)
    k = em / 1000
    advances, heights, depths = zip(*glyphs, strict=True)
    return Box(k * sum(advances), k * max(heights), k * max(depths))


def _unknown(letter: str) -> tuple[int, int, int]:
    """A letter that the table lacks: one of an alphabet is as wide as a wide letter, any other as one em."""
    if letter.isalpha() and letter < "\u2000":
        return (700 if letter.isupper() else 600), 750, 200
    return 1000, 750, 200


def _joined(parts: list[Box], em: float, gap: float) -> Box:
    result = parts[0]
    for part in parts[1:]:
        result = result.beside(Box(gap * em, 0.0, 0.0)).beside(part)
    return result


def _scripts(base: Box, sub: Box, sup: Box, em: float, cut: float = 1.0) -> Box:
    height, depth = base.height, base.depth
    if sup.width:
        height = max(height, sup.height + SUPER_SHIFT * em)
    if sub.width:
        depth = max(depth, sub.depth + SUB_SHIFT * em)
    return Box(base.width + cut * max(sub.width, sup.width), height, depth)


def _symbol(symbol: Symbol, em: float) -> Box:
    base = _letters(symbol.base, em)
    if symbol.over:
        base = Box(max(base.width, 0.5 * em), base.height + OVER * em, base.depth)
    sub, sup = (_text(script, SCRIPT * em) for script in (symbol.sub, symbol.sup))
    if any(number for _, number in numbered(symbol.sub)):
        sub = Box(sub.width, sub.height, sub.depth + SUB_SHIFT * SCRIPT * em)
    return _scripts(base, sub, sup, em, SMALL_CUT)


def _letters(text: str, em: float) -> Box:
    """Letters of formulas, digits that stand below them in the size of scripts."""
    whole = Box(0.0, 0.0, 0.0)
    for letters, digits in runs(text):
        below = _text(digits, SCRIPT * em)
        whole = whole.beside(_scripts(_text(letters, em, italic=True), below, Box(0.0, 0.0, 0.0), em, SMALL_CUT))
    return whole


def _expression(node: Expression, em: float) -> Box:
    match node:
        case Symbol():
            return _symbol(node, em)
        case Number(value, decimals, unit):
            number = _text(write(value, decimals, "en"), em)
            return number.beside(_text(" " + unit, em)) if unit else number
        case Ref(id):
            return _text(id, em)
        case Sum(terms):
            return _joined([_expression(term, em) for term in terms], em, 0.78 + RELATION)
        case Product(factors):
            return _joined([_factor(factor, em) for factor in factors], em, RELATION)
        case Negative(of):
            return _text("−", em).beside(_factor(of, em))
        case Fraction(top, bottom):
            # In a line of text both typesetters set the parts of a fraction in the size of scripts.
            above, below = _expression(top, SCRIPT * em), _expression(bottom, SCRIPT * em)
            axis, gap = 0.25 * em, 0.12 * em
            return Box(
                max(above.width, below.width) + 0.24 * em,
                axis + gap + above.height + above.depth,
                below.height + below.depth + gap - axis,
            )
        case Power(base, exponent):
            return _scripts(_factor(base, em), Box(0, 0, 0), _expression(exponent, SCRIPT * em), em)
        case Root(of):
            inner = Box(0.85 * em, 0.2 * em, 0.0).beside(_expression(of, em))
            return Box(inner.width, inner.height + 0.1 * em, inner.depth - 0.1 * em)
        case Call("abs" | "size", (argument,)):
            return _text("||", em).beside(_expression(argument, em))
        case Call(name, arguments):
            inner = _joined([_expression(argument, em) for argument in arguments], em, 0.5)
            return _text(name + "()", em).beside(inner)
        case Matrix(rows):
            lines = [_joined([_expression(entry, em) for entry in row], em, 1.0) for row in rows]
            half = sum(line.height + line.depth for line in lines) / 2
            width = max((line.width for line in lines), default=0.0)
            return Box(width + em, half + 0.25 * em, half - 0.25 * em)
        case Chain(parts, note):
            line = _joined([_expression(part, em) for part in parts], em, 0.78 + RELATION)
            # Both typesetters set the note in parentheses, a quad away.
            return line.beside(Box(em, 0.0, 0.0)).beside(_text(f"({note})", em)) if note else line
        case VectorEquation(sides):
            return _joined([_symbol(term.symbol, em) for side in sides for term in side], em, 0.78 + RELATION)


def _factor(node: Expression, em: float) -> Box:
    """A part of a product, in the parentheses that a sum or a negative gets there."""
    inner = _expression(node, em)
    negative = isinstance(node, Number) and node.shown < 0
    return _text("()", em).beside(inner) if negative or isinstance(node, (Sum, Negative)) else inner


# --- sizes of glyphs ------------------------------------------------------------------------------

# (advance, height above the baseline, depth below it) in thousandths of the font size.  Read once, with
# fontTools, from the Latin Modern fonts that both typesetters set (New Computer Modern has the same widths):
# the upright letters from lmroman10-regular, signs, Greek and the mathematical italic from latinmodern-math;
# an advance is never less than the right edge of the glyph.
_GLYPHS = json.loads(Path(__file__).with_name("glyphs.json").read_text(encoding="utf-8"))
ROMAN: dict[str, tuple[int, int, int]] = {letter: tuple(sizes) for letter, sizes in _GLYPHS["roman"].items()}
"""Upright letters, digits and signs."""
ITALIC: dict[str, tuple[int, int, int]] = {letter: tuple(sizes) for letter, sizes in _GLYPHS["italic"].items()}
"""Letters of formulas."""
