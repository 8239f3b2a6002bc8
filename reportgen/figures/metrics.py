"""How much paper a label takes, from a table of glyph sizes.

The box of a label is the extent of its ink: advance widths, the tallest height above the baseline and
the greatest depth below it.  Scripts are set at 0.7 of the size, as both typesetters do.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

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
    return (650 if letter.isalpha() and letter < "\u2000" else 1000), 750, 200


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
            return line.beside(_text(" " + note, em)) if note else line
        case VectorEquation(sides):
            return _joined([_symbol(term.symbol, em) for side in sides for term in side], em, 0.78 + RELATION)


def _factor(node: Expression, em: float) -> Box:
    """A part of a product, in the parentheses that a sum or a negative gets there."""
    inner = _expression(node, em)
    negative = isinstance(node, Number) and node.shown < 0
    return _text("()", em).beside(inner) if negative or isinstance(node, (Sum, Negative)) else inner


# --- sizes of glyphs ------------------------------------------------------------------------------

# fmt: off
# (advance, height above the baseline, depth below it) in thousandths of the font size.  Read once, with
# fontTools, from the Latin Modern fonts that both typesetters set (New Computer Modern has the same widths):
# the upright letters from lmroman10-regular, signs, Greek and the mathematical italic from latinmodern-math;
# an advance is never less than the right edge of the glyph.
ROMAN: dict[str, tuple[int, int, int]] = {
    " ": (333, 0, 0), "!": (278, 716, 0), '"': (374, 705, -423), "#": (833, 694, 194), "$": (500, 750, 56),
    "%": (833, 750, 56), "&": (778, 716, 22), "'": (278, 705, -423), "(": (389, 750, 250),
    ")": (389, 750, 250), "*": (500, 750, -319), "+": (778, 583, 83), ",": (278, 106, 193),
    "-": (333, 245, -187), ".": (278, 106, 0), "/": (500, 750, 250), "0": (500, 666, 22),
    "1": (500, 666, 0), "2": (500, 666, 0), "3": (500, 666, 22), "4": (500, 677, 0), "5": (500, 666, 22),
    "6": (500, 666, 22), "7": (500, 676, 22), "8": (500, 666, 22), "9": (500, 666, 22), ":": (278, 431, 0),
    ";": (278, 431, 193), "<": (778, 540, 40), "=": (778, 367, -133), ">": (778, 540, 40),
    "?": (472, 705, 0), "@": (778, 705, 11), "A": (750, 716, 0), "B": (708, 683, 0), "C": (722, 705, 22),
    "D": (764, 683, 0), "E": (681, 680, 0), "F": (653, 680, 0), "G": (785, 705, 22), "H": (750, 683, 0),
    "I": (361, 683, 0), "J": (514, 683, 22), "K": (778, 683, 0), "L": (625, 683, 0), "M": (917, 683, 0),
    "N": (750, 683, 0), "O": (778, 705, 22), "P": (681, 683, 0), "Q": (778, 705, 194), "R": (736, 683, 22),
    "S": (556, 705, 22), "T": (722, 677, 0), "U": (750, 683, 22), "V": (750, 683, 22), "W": (1028, 683, 22),
    "X": (750, 683, 0), "Y": (750, 683, 0), "Z": (611, 683, 0), "[": (278, 750, 250), "\\": (500, 750, 250),
    "]": (278, 750, 250), "^": (561, 744, -562), "_": (750, -112, 138), "`": (500, 698, -510),
    "a": (500, 448, 11), "b": (556, 694, 11), "c": (444, 448, 11), "d": (556, 694, 11), "e": (444, 448, 11),
    "f": (357, 705, 0), "g": (500, 453, 206), "h": (556, 694, 0), "i": (278, 657, 0), "j": (306, 657, 205),
    "k": (528, 694, 0), "l": (278, 694, 0), "m": (833, 442, 0), "n": (556, 442, 0), "o": (500, 448, 11),
    "p": (556, 442, 194), "q": (528, 442, 194), "r": (392, 442, 0), "s": (394, 448, 11),
    "t": (389, 615, 11), "u": (556, 442, 11), "v": (528, 431, 11), "w": (722, 431, 11), "x": (528, 431, 0),
    "y": (528, 431, 205), "z": (444, 431, 0), "{": (500, 750, 250), "|": (278, 750, 250),
    "}": (500, 750, 250), "~": (556, 307, -193), "À": (750, 909, 0), "Á": (750, 909, 0), "Â": (750, 869, 0),
    "Ã": (750, 829, 0), "È": (681, 909, 0), "É": (681, 909, 0), "Ê": (681, 869, 0), "Ì": (361, 909, 0),
    "Í": (361, 909, 0), "Ò": (778, 909, 22), "Ó": (778, 909, 22), "Ô": (778, 869, 22), "Õ": (778, 829, 22),
    "Ù": (750, 909, 22), "Ú": (750, 909, 22), "Ý": (750, 909, 0), "à": (500, 698, 11), "á": (500, 698, 11),
    "â": (500, 692, 11), "ã": (500, 651, 11), "è": (444, 698, 11), "é": (444, 698, 11), "ê": (444, 692, 11),
    "ì": (278, 698, 0), "í": (278, 698, 0), "ò": (500, 698, 11), "ó": (500, 698, 11), "ô": (500, 692, 11),
    "õ": (500, 651, 11), "ù": (556, 698, 11), "ú": (556, 698, 11), "ý": (528, 698, 205), "Ă": (750, 918, 0),
    "ă": (500, 690, 11), "Đ": (764, 683, 0), "đ": (556, 694, 11), "Ĩ": (361, 829, 0), "ĩ": (306, 651, 0),
    "Ũ": (750, 829, 22), "ũ": (556, 651, 11), "Ơ": (778, 789, 22), "ơ": (500, 536, 11), "Ư": (750, 789, 22),
    "ư": (571, 536, 11), "Ạ": (750, 716, 200), "ạ": (500, 448, 200), "Ả": (750, 967, 0),
    "ả": (500, 709, 11), "Ấ": (750, 1052, 0), "ấ": (500, 832, 11), "Ầ": (750, 1052, 0), "ầ": (500, 832, 11),
    "Ẩ": (750, 1078, 0), "ẩ": (500, 858, 11), "Ẫ": (750, 1002, 0), "ẫ": (500, 782, 11),
    "Ậ": (750, 869, 200), "ậ": (500, 692, 200), "Ắ": (750, 1101, 0), "ắ": (500, 873, 11),
    "Ằ": (750, 1101, 0), "ằ": (500, 873, 11), "Ẳ": (750, 1127, 0), "ẳ": (500, 899, 11), "Ẵ": (750, 1051, 0),
    "ẵ": (500, 823, 11), "Ặ": (750, 918, 200), "ặ": (500, 690, 200), "Ẹ": (681, 680, 200),
    "ẹ": (444, 448, 200), "Ẻ": (681, 967, 0), "ẻ": (444, 709, 11), "Ẽ": (681, 829, 0), "ẽ": (444, 651, 11),
    "Ế": (681, 1052, 0), "ế": (444, 832, 11), "Ề": (681, 1052, 0), "ề": (444, 832, 11), "Ể": (681, 1078, 0),
    "ể": (444, 858, 11), "Ễ": (681, 1002, 0), "ễ": (444, 782, 11), "Ệ": (681, 869, 200),
    "ệ": (444, 692, 200), "Ỉ": (361, 967, 0), "ỉ": (278, 709, 0), "Ị": (361, 683, 200),
    "ị": (278, 657, 200), "Ọ": (778, 705, 200), "ọ": (500, 448, 200), "Ỏ": (778, 967, 22),
    "ỏ": (500, 709, 11), "Ố": (778, 1052, 22), "ố": (500, 832, 11), "Ồ": (778, 1052, 22),
    "ồ": (500, 832, 11), "Ổ": (778, 1078, 22), "ổ": (500, 858, 11), "Ỗ": (778, 1002, 22),
    "ỗ": (500, 782, 11), "Ộ": (778, 869, 200), "ộ": (500, 692, 200), "Ớ": (778, 909, 22),
    "ớ": (500, 698, 11), "Ờ": (778, 909, 22), "ờ": (500, 698, 11), "Ở": (778, 967, 22), "ở": (500, 709, 11),
    "Ỡ": (778, 829, 22), "ỡ": (500, 651, 11), "Ợ": (778, 789, 200), "ợ": (500, 536, 200),
    "Ụ": (750, 683, 200), "ụ": (556, 442, 200), "Ủ": (750, 967, 22), "ủ": (556, 709, 11),
    "Ứ": (750, 909, 22), "ứ": (571, 698, 11), "Ừ": (750, 909, 22), "ừ": (571, 698, 11), "Ử": (750, 967, 22),
    "ử": (571, 709, 11), "Ữ": (750, 829, 22), "ữ": (571, 651, 11), "Ự": (750, 789, 200),
    "ự": (571, 536, 200), "Ỳ": (750, 909, 0), "ỳ": (528, 698, 205), "Ỵ": (750, 683, 200),
    "ỵ": (528, 431, 205), "Ỷ": (750, 967, 0), "ỷ": (528, 709, 205), "Ỹ": (750, 829, 0),
    "ỹ": (528, 651, 205), "·": (778, 395, -289), "×": (778, 492, -9), "–": (500, 277, -255),
    "—": (1000, 277, -255), "±": (778, 666, 0), "°": (375, 683, -406), "²": (359, 705, -306),
    "³": (359, 705, -293), "…": (670, 106, 0), "α": (641, 442, 11), "β": (558, 706, 194),
    "γ": (586, 442, 215), "δ": (474, 712, 11), "ε": (535, 453, 22), "ζ": (530, 697, 205),
    "η": (530, 442, 216), "θ": (488, 705, 11), "ι": (308, 442, 11), "κ": (530, 442, 11),
    "λ": (563, 694, 13), "μ": (530, 442, 216), "ν": (502, 442, 0), "ξ": (530, 697, 205),
    "ο": (500, 448, 11), "π": (586, 431, 11), "ρ": (488, 442, 216), "σ": (599, 431, 11),
    "τ": (530, 431, 12), "υ": (530, 442, 11), "φ": (641, 442, 218), "χ": (641, 442, 205),
    "ψ": (641, 694, 205), "ω": (641, 442, 11), "Γ": (625, 680, 0), "Δ": (833, 716, 0), "Θ": (778, 705, 22),
    "Λ": (694, 716, 0), "Ξ": (667, 677, 0), "Π": (750, 680, 0), "Σ": (722, 683, 0), "Φ": (722, 683, 0),
    "Ψ": (778, 683, 0), "Ω": (722, 705, 0), "−": (778, 270, -230), "′": (311, 748, -430),
    "″": (511, 748, -430), "≡": (778, 464, -36), "≈": (773, 457, -43), "≤": (778, 631, 119),
    "≥": (778, 631, 119), "∞": (1000, 442, 11), "⋅": (278, 303, -197),
}
"""Upright letters, digits and signs."""

ITALIC: dict[str, tuple[int, int, int]] = {
    "a": (529, 442, 11), "b": (429, 694, 11), "c": (433, 442, 11), "d": (520, 694, 11), "e": (466, 442, 11),
    "f": (552, 705, 205), "g": (477, 442, 205), "h": (576, 694, 11), "i": (345, 661, 11),
    "j": (412, 661, 205), "k": (521, 694, 11), "l": (298, 694, 11), "m": (878, 442, 11),
    "n": (600, 442, 11), "o": (485, 442, 11), "p": (503, 442, 194), "q": (452, 442, 194),
    "r": (451, 442, 11), "s": (469, 442, 11), "t": (361, 626, 11), "u": (572, 442, 11), "v": (485, 442, 11),
    "w": (716, 442, 11), "x": (572, 442, 11), "y": (490, 442, 205), "z": (467, 442, 11), "A": (750, 716, 0),
    "B": (759, 683, 0), "C": (760, 705, 22), "D": (828, 683, 0), "E": (764, 680, 0), "F": (749, 680, 0),
    "G": (786, 705, 22), "H": (881, 683, 0), "I": (497, 683, 0), "J": (633, 683, 22), "K": (889, 683, 0),
    "L": (681, 683, 0), "M": (1044, 683, 0), "N": (881, 683, 0), "O": (763, 705, 22), "P": (754, 683, 0),
    "Q": (791, 705, 194), "R": (759, 683, 22), "S": (645, 705, 22), "T": (704, 677, 0), "U": (760, 683, 22),
    "V": (769, 683, 22), "W": (1048, 683, 22), "X": (851, 683, 0), "Y": (762, 683, 0), "Z": (723, 683, 0),
    "α": (640, 442, 11), "β": (574, 706, 194), "γ": (543, 442, 215), "δ": (452, 712, 11),
    "ε": (466, 453, 22), "ζ": (474, 697, 205), "η": (497, 442, 216), "θ": (469, 705, 11),
    "ι": (354, 442, 11), "κ": (576, 442, 11), "λ": (583, 694, 13), "μ": (603, 442, 216), "ν": (524, 442, 0),
    "ξ": (446, 697, 205), "ο": (485, 442, 11), "π": (570, 431, 11), "ρ": (517, 442, 216),
    "σ": (571, 431, 11), "τ": (511, 431, 12), "υ": (540, 442, 11), "φ": (654, 442, 218),
    "χ": (626, 442, 205), "ψ": (651, 694, 205), "ω": (622, 442, 11),
}
"""Letters of formulas."""
# fmt: on
