"""Size of labels on paper, from a table of glyph sizes (`box`).

The box of a label is the extent of its ink: advance widths, the greatest height above the baseline and the greatest
depth below it.  Scripts are set at 0.7 of the size, as in both typesetters.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from functools import lru_cache, reduce
from pathlib import Path

from reportgen.base.records import Record
from reportgen.drawing import Content
from reportgen.formula import Symbol, formula_layout, formula_setter
from reportgen.formula.vocabulary import numbered, runs

POINT = 25.4 / 72.27
"""A printer's point (mm)."""
SCRIPT = 0.7
SMALL_CUT = 1.17
"""Letters cut for 6 points, as LaTeX sets scripts, are wider by this factor than larger ones scaled down."""
SUPER_SHIFT, SUB_SHIFT = 0.38, 0.18
"""Shift of the baselines of scripts, in font sizes."""
OVER = 0.25
"""Height of an arrow or a bar above, in font sizes."""
RELATION = 0.56
"""Width of the space on both sides of a relation or a sign, in font sizes (thick spaces)."""
GAPS: Mapping[formula_layout.Role, float] = {"product": RELATION, "separator": 0.5}
"""Width of a sign with its space, in font sizes, where it is not as wide as a plus."""
BESIDE, BESIDE_HAN = 250, re.compile("(?<=[\u4e00-\u9fff])(?=[0-9A-Za-z])|(?<=[0-9A-Za-z])(?=[\u4e00-\u9fff])")
"""Gap between letters of Chinese and of another script, in thousandths of the font size, and the pattern of
its places.
"""
SQUARE = (1000, 860, 200)
"""Sizes of an East Asian letter, which fills a square, and of its punctuation."""
THIN = 0.17
"""Gap between a function and its argument, in font sizes."""


class Box(Record):
    """Width, height above and depth below the baseline (mm)."""

    width: float
    height: float
    depth: float

    def beside(self, box: Box) -> Box:
        """Return both boxes side by side on one baseline."""
        return Box(self.width + box.width, max(self.height, box.height), max(self.depth, box.depth))


NOTHING = Box(0.0, 0.0, 0.0)


@lru_cache(maxsize=4096)
def box(content: Content, size: float = 9.0, displayed: bool = False) -> Box:
    """Return the box of a label's content at a font size (pt); unknown letters count as one em.

    Fractions of a `displayed` formula have full size.
    """
    return Boxes(size * POINT, displayed).content(content)


@lru_cache(maxsize=4096)
def _text(text: str, em: float, italic: bool = False) -> Box:
    glyphs = [(italic and ITALIC.get(letter)) or ROMAN.get(letter) or _unknown(letter) for letter in text]
    if not glyphs:
        return NOTHING
    k = em / 1000
    advances, heights, depths = zip(*glyphs, strict=True)
    gaps = 0 if text.isascii() else len(BESIDE_HAN.findall(text))
    return Box(k * (sum(advances) + BESIDE * gaps), k * max(heights), k * max(depths))


def _unknown(letter: str) -> tuple[int, int, int]:
    """Return the sizes of a letter that the table lacks: a letter of an alphabet is as wide as a wide letter, any other
    one em.
    """
    if letter.isalpha() and letter < "\u2000":
        return (700 if letter.isupper() else 600), 750, 200
    return SQUARE if letter >= "\u2e80" else (1000, 750, 200)


def _gap(width: float) -> Box:
    return Box(width, 0.0, 0.0)


def _scripts(base: Box, sub: Box, sup: Box, em: float, cut: float = 1.0) -> Box:
    height, depth = base.height, base.depth
    if sup.width:
        height = max(height, sup.height + SUPER_SHIFT * em)
    if sub.width:
        depth = max(depth, sub.depth + SUB_SHIFT * em)
    return Box(base.width + cut * max(sub.width, sup.width), height, depth)


@lru_cache(maxsize=4096)
def _symbol(symbol: Symbol, em: float) -> Box:
    base = _letters(symbol.base, em)
    if symbol.over:
        base = Box(max(base.width, 0.5 * em), base.height + OVER * em, base.depth)
    sub, sup = (_text(script, SCRIPT * em) for script in (symbol.sub, symbol.sup))
    if any(number for _, number in numbered(symbol.sub)):
        sub = Box(sub.width, sub.height, sub.depth + SUB_SHIFT * SCRIPT * em)
    return _scripts(base, sub, sup, em, SMALL_CUT)


def _letters(text: str, em: float) -> Box:
    """Return the box of letters of formulas; digits are set below them in the size of scripts."""
    whole = NOTHING
    for letters, digits in runs(text):
        below = _text(digits, SCRIPT * em)
        whole = whole.beside(_scripts(_text(letters, em, italic=True), below, NOTHING, em, SMALL_CUT))
    return whole


class Boxes(formula_setter.Setter[Box]):
    """A setter of formulas as the boxes that both typesetters make; em is the font size (mm)."""

    def __init__(self, em: float, displayed: bool = False) -> None:
        super().__init__("en")
        self.em = em
        self.displayed = displayed

    def text(self, text: str) -> Box:
        return _text(text, self.em)

    def part(self, part: formula_layout.Part) -> Box:
        em, of = self.em, self.part
        match part:
            case Symbol():
                return _symbol(part, em)
            case formula_layout.Written(digits, unit):
                return self.text(digits).beside(self.text(" " + unit)) if unit else self.text(digits)
            case formula_layout.Sign(sign, "prefix" | "slash"):
                return self.text(sign)
            case formula_layout.Sign(_, role):
                return _gap(GAPS.get(role, 0.78 + RELATION) * em)
            case formula_layout.MathRow(parts):
                return _row(map(of, parts))
            case formula_layout.Raised(base, exponent):
                return _scripts(of(base), NOTHING, self.script.part(exponent), em)
            case formula_layout.Quotient(top, bottom):
                return self.quotient(top, bottom)
            case formula_layout.Radical(inner):
                line = Box(0.85 * em, 0.2 * em, 0.0).beside(of(inner))
                return Box(line.width, line.height + 0.1 * em, line.depth - 0.1 * em)
            case formula_layout.Fence("[", inner):
                return of(inner).beside(_gap(em))
            case formula_layout.Fence(left, inner, right):
                return self.text(left + right).beside(of(inner))
            case formula_layout.Function(name, exponent, to):
                power = NOTHING if exponent is None else self.script.part(exponent)
                function = _scripts(self.text(name), NOTHING, power, em)
                return function.beside(
                    of(to) if isinstance(to, formula_layout.Fence) else _gap(THIN * em).beside(of(to))
                )
            case formula_layout.Grid(rows):
                lines = [_row(map(of, row)).beside(_gap((len(row) - 1) * em)) for row in rows]
                half = sum(line.height + line.depth for line in lines) / 2
                width = max((line.width for line in lines), default=0.0)
                return Box(width, half + 0.25 * em, half - 0.25 * em)
            case formula_layout.Parenthesis(mark, tall):
                return self.text(mark).beside(_gap(0.35 * em * tall))
            case formula_layout.Note(text):
                # Both typesetters set the note in parentheses, at a distance of a quad.
                return _gap(em).beside(self.text(f"({text})"))

    @property
    def script(self) -> Boxes:
        """Return the setter of scripts, at 0.7 of the size."""
        return Boxes(SCRIPT * self.em)

    def quotient(self, top: formula_layout.Part, bottom: formula_layout.Part) -> Box:
        """Return the box of a fraction; within a line of text, its parts have script size, and it has padding."""
        em, size, white = self.em, self if self.displayed else self.script, 0.0 if self.displayed else 0.24
        above, below = size.part(top), size.part(bottom)
        axis, gap = 0.25 * em, 0.12 * em
        width = max(above.width, below.width) + white * em
        return Box(width, axis + gap + above.height + above.depth, below.height + below.depth + gap - axis)


def _row(boxes: Iterable[Box]) -> Box:
    return reduce(Box.beside, boxes, NOTHING)


# --- sizes of glyphs ------------------------------------------------------------------------------

# (advance, height above the baseline, depth below it) in thousandths of the font size.  Read once, with
# fontTools, from the Latin Modern fonts that both typesetters set (New Computer Modern has the same widths):
# the upright letters from lmroman10-regular, signs, Greek and the mathematical italic from latinmodern-math;
# an advance is never less than the right edge of the glyph.  `tests/drawing/glyph_sizes.py` adds further letters.
_GLYPHS = json.loads(Path(__file__).with_name("glyphs.json").read_text(encoding="utf-8"))
ROMAN: dict[str, tuple[int, int, int]] = {letter: tuple(sizes) for letter, sizes in _GLYPHS["roman"].items()}
"""Upright letters, digits and signs."""
ITALIC: dict[str, tuple[int, int, int]] = {letter: tuple(sizes) for letter, sizes in _GLYPHS["italic"].items()}
"""Letters of formulas."""
