"""Convert scenes to inline SVG in millimetres, true to scale in a print at 100 %, and formulas to MathML.

Pens are classes that the page's style sheet defines once, so that colours follow light and dark. Labels are text in the
reader's fonts, at the places that the report's fonts would take.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape as escaped
from itertools import groupby

from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.document.layout import fits
from reportgen.drawing import Arc, Arrow, Circle, Content, Hatch, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.geometry import frame
from reportgen.drawing.label_size import POINT, SCRIPT, box
from reportgen.drawing.style import Bezier, Triangle, arc_with_head, arrow_head, clip_hatch, decimal
from reportgen.formula import Expression, Sum, Symbol, VectorEquation, formula_layout, formula_setter
from reportgen.formula.formula_layout import (
    EQUALS,
    NARROW,
    NEGATIVE,
    PRIMES,
    Fence,
    MathRow,
    Parenthesis,
    Role,
    Sign,
    Written,
    columns,
    displayed,
    is_tall,
    laid,
    parted,
    pieces,
    sides,
)
from reportgen.formula.formula_setter import TextSetter
from reportgen.formula.vocabulary import numbered, runs

COLOURS = {
    style.BLACK: "ink",
    style.GRAY: "gray",
    style.PALE: "pale",
    style.BLUE: "blue",
    style.RED: "red",
    style.PAPER: "paper",
    style.TINT: "tint",
}
"""Names of the figures' colours in the style sheet; any other colour stays as it is."""
SUB, SUPER = 0.2, -0.38
"""Offsets of the base lines of indices below and above that of their letter, in font sizes."""
OVER, STROKE, BARB = 0.2, 0.065, (0.3, 0.12)
"""Distance of an arrow or a bar above a letter, its width, length and half the width of its head, in font sizes."""


class Run(Record):
    """Letters of one label that look alike: italic or not, their size and their base line's drop in font sizes.

    They begin at a distance `back` before the end of the previous run, in their own font size.
    """

    text: str
    italic: bool = False
    size: float = 1.0
    drop: float = 0.0
    back: float = 0.0


class Pens:
    """The classes of pens and fills, in the order in which drawings first use them; all begin with the same letter."""

    def __init__(self, letter: str = "p") -> None:
        self._letter = letter
        self._names: dict[tuple[Pen | None, str | None], str] = {}
        self._sizes: dict[float, str] = {}

    def name(self, stroke: Pen | None, fill: str | None = None) -> str:
        """Return the class of a pen with a fill."""
        return self._names.setdefault((stroke, fill), f"{self._letter}{len(self._names)}")

    def size(self, points: float) -> str:
        """Return the class of a font size (points)."""
        return self._sizes.setdefault(points, f"{self._letter}s{len(self._sizes)}")

    def rules(self) -> str:
        """Return the style sheet's rules for all of them."""
        lines = []
        for (stroke, fill), name in self._names.items():
            parts = [f"fill:{_colour(fill)}"]
            if stroke is not None:
                parts += [f"stroke:{_colour(stroke.colour)}", f"stroke-width:{decimal(stroke.width)}"]
                if stroke.dash:
                    parts.append(f"stroke-dasharray:{' '.join(map(decimal, stroke.dash))}")
            lines.append(f".{name}{{{';'.join(parts)}}}")
        lines += [f".{name}{{font-size:{decimal(points * POINT)}px}}" for points, name in self._sizes.items()]
        return "\n".join(lines)


def _colour(colour: str | None) -> str:
    if colour is None:
        return "none"
    return f"var(--{COLOURS[colour]})" if colour in COLOURS else colour


class Painter:
    """Draws scenes in one language with the pens of one page."""

    def __init__(self, language: Language, pens: Pens) -> None:
        self.language: Language = language
        self.pens = pens

    def scene(self, scene: Scene, name: str) -> str:
        """Return a drawing in true size; `name` is its description for readers who do not see it."""
        width, height = decimal(scene.width), decimal(scene.height)
        body = self.items(scene.items, scene.height)
        return (
            f'<svg class="scene" role="img" aria-label="{escape(name)}" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}">{body}</svg>'
        )

    def items(self, items: Iterable[Item], height: float = 0.0) -> str:
        """Return the elements of items, with y reversed about the `height` (mm) of their sheet."""
        paths = []
        shapes = (shape for item in items for shape in self._shapes(item, height))
        for (name, joins), group in groupby(shapes, key=lambda shape: shape[:2]):
            bodies = [body for _, _, body in group]
            paths.append(f'<path class="{name}" d="{"".join(bodies)}"/>' if joins else "".join(bodies))
        return "".join(paths)

    def _shapes(self, item: Item, height: float) -> Iterator[tuple[str, bool, str]]:
        """Yield the parts of an item: class, True for path data (False for an element), and the data or the element."""

        def at(point: complex) -> str:
            return f"{decimal(point.real)} {decimal(height - point.imag)}"

        def path(points: Sequence[complex], end: str = "") -> str:
            return "M" + "L".join(map(at, points)) + end

        def head(triangle: Triangle | None, stroke: Pen) -> Iterator[tuple[str, bool, str]]:
            if triangle:
                yield self.pens.name(None, stroke.colour), True, path(triangle, "Z")

        def curve(pieces: Sequence[Bezier]) -> str:
            return f"M{at(pieces[0][0])}" + "".join(f"C{at(b)} {at(c)} {at(d)}" for _, b, c, d in pieces)

        match item:
            case Line(start, end, stroke):
                yield self.pens.name(stroke), True, path((start, end))
            case Arrow(start, end, stroke, length):
                shaft, triangle = arrow_head(start, end, length)
                yield self.pens.name(stroke), True, path((start, shaft))
                yield from head(triangle, stroke)
            case Circle(centre, radius, outline, fill):
                x, y = at(centre).split()
                name = self.pens.name(outline, fill)
                yield name, False, f'<circle class="{name}" cx="{x}" cy="{y}" r="{decimal(radius)}"/>'
            case Arc(stroke=stroke):
                curves, triangle = arc_with_head(item)
                yield self.pens.name(stroke), True, curve(curves)
                yield from head(triangle, stroke)
            case Polyline(points, outline, closed, fill):
                if points:
                    # A filled shape covers what is drawn before it, so it has its own element.
                    yield self.pens.name(outline, fill), fill is None, self._closed(path(points), closed, outline, fill)
            case Hatch(points, spacing, stroke, turn):
                yield self.pens.name(stroke), True, "".join(path(pair) for pair in clip_hatch(points, spacing, turn))
            case Label():
                yield "", False, self.label(item, height)

    def _closed(self, data: str, closed: bool, outline: Pen | None, fill: str | None) -> str:
        data += "Z" * closed
        return data if fill is None else f'<path class="{self.pens.name(outline, fill)}" d="{data}"/>'

    # --- labels

    def label(self, label: Label, height: float = 0.0) -> str:
        """Return a label as text on a sheet of a `height` (mm), anchored at its middle or an end as in the scene."""
        extent, (centre, half) = box(label.content, label.size), frame(label)
        turned = label.turn == 90
        side = "s" if "left" in label.anchor else "e" if "right" in label.anchor else "m"
        if turned:
            base = complex(centre.real + half.real - extent.depth, centre.imag)
            side = "m"
        else:
            across = {"s": -half.real, "e": half.real, "m": 0.0}[side]
            base = complex(centre.real + across, centre.imag - half.imag + extent.depth)
        x, y = decimal(base.real), decimal(height - base.imag)
        turn = f' transform="rotate(-90 {x} {y})"' if turned else ""
        text = (
            f'<text class="{side} {self.pens.size(label.size)}" x="{x}" y="{y}"{turn}>{self.text(label.content)}</text>'
        )
        left = base.real - {"s": 0.0, "e": extent.width, "m": extent.width / 2}[side]
        text += self._accent(label.content, label.size, complex(left, base.imag), height)
        if label.background:
            low, high = centre - half, centre + half
            corners = (low, complex(high.real, low.imag), high, complex(low.real, high.imag))
            text = self.items((Polyline(corners, None, closed=True, fill=style.PAPER),), height) + text
        return text

    def _accent(self, content: Content, size: float, base: complex, height: float) -> str:
        """Return the arrow or bar over a label that is a single symbol."""
        if not isinstance(content, Symbol) or not content.over:
            return ""
        em = size * POINT
        letters = box(replace(content, sub="", sup="", over=""), size)
        top = base + 1j * (letters.height + OVER * em)
        width = max(letters.width, 0.55 * em)
        if content.over == "segment":
            end = top + box(replace(content, over=""), size).width
            return self.items((Line(top, end, Pen(round(STROKE * em, 3))),), height)
        start = top + 0.05 * em
        return self.items((Polyline(_accent_arrow(start, width, em), None, closed=True, fill=style.BLACK),), height)

    def text(self, content: Content) -> str:
        """Return a label as the content of a text element."""
        spans, drop = [], 0.0
        for run in Runs(self.language).content(content):
            # A shift counts in the font size of the run that it moves.
            shift = (run.drop - drop) / run.size
            attributes = f' dx="{decimal(-run.back)}em"' if run.back else ""
            attributes += f' dy="{decimal(shift)}em"' if shift else ""
            names = ("i " if run.italic else "") + ("x" if run.size < 1 else "")
            attributes += f' class="{names.strip()}"' if names else ""
            text = escape(run.text)
            spans.append(f"<tspan{attributes}>{text}</tspan>" if attributes else text)
            drop = run.drop
        return "".join(spans)


def _accent_arrow(start: complex, width: float, em: float) -> tuple[complex, ...]:
    """Return the outline of an arrow over a letter, `width` mm long; one shape, so that its pen is never too thin."""
    half, (length, side) = STROKE * em / 2 * 1j, (part * em for part in BARB)
    tip, neck = start + width, start + width - length
    return start + half, neck + half, neck + side * 1j, tip, neck - side * 1j, neck - half, start - half


class Runs(formula_setter.Setter[tuple[Run, ...]]):
    """Formulas as labels have them: in one line, indices beside their letters."""

    linear = True

    def text(self, text: str) -> tuple[Run, ...]:
        return (Run(text),) if text else ()

    def part(self, part: formula_layout.Part) -> tuple[Run, ...]:
        of, text = self.part, self.text
        match part:
            case Symbol():
                return tuple(_symbol(part))
            case formula_layout.Written():
                return text(part.text(formula_layout.NARROW))
            case formula_layout.Sign():
                return text(part.text)
            case formula_layout.MathRow(parts):
                return tuple(run for one in parts for run in of(one))
            case formula_layout.Raised(base, exponent):
                return (*of(base), *_raised(of(exponent)))
            case formula_layout.Quotient(top, bottom):
                return (*text("("), *of(top), *text(")/("), *of(bottom), *text(")"))
            case formula_layout.Radical(inner):
                return (*text("√"), *of(inner))
            case formula_layout.Fence(left, inner, right):
                return (*text(left), *of(inner), *text(right))
            case formula_layout.Function(name, exponent, to):
                function = (*text(name), *(_raised(of(exponent)) if exponent else ()))
                return (
                    (*function, *of(to)) if isinstance(to, formula_layout.Fence) else (*function, *text(" "), *of(to))
                )
            case formula_layout.Grid(rows):
                lines = (_parted([of(entry) for entry in row], "; ") for row in rows)
                return _parted(list(lines), " | ")
            case formula_layout.Parenthesis(mark):
                return self.text(mark)
            case formula_layout.Note(note):
                return text(f"  ({note})")


def _parted(parts: Sequence[tuple[Run, ...]], mark: str) -> tuple[Run, ...]:
    return tuple(run for index, part in enumerate(parts) for run in ((Run(mark), *part) if index else part))


def _raised(runs: Iterable[Run]) -> Iterator[Run]:
    return (replace(run, size=SCRIPT, drop=SUPER) for run in runs)


def _symbol(node: Symbol) -> Iterator[Run]:
    for letters, digits in runs(node.base):
        yield Run(letters, italic=any(map(str.isalpha, letters)))
        yield from _script(digits, SUB)
    yield from _scripts("".join(letters + digits for letters, digits in numbered(node.sub)), node.sup)


def _scripts(below: str, above: str) -> Iterator[Run]:
    """Yield an index below an exponent: the narrower first, then the other from where the first began."""
    wide_below, wide_above = (box(text, 1.0).width / POINT for text in (below, above))
    first, second = _script(below, SUB), _script(above, SUPER)
    if wide_below > wide_above:
        first, second = second, first
    yield from first
    yield from (replace(run, back=min(wide_below, wide_above)) for run in second)


def _script(text: str, drop: float) -> Iterator[Run]:
    if text:
        yield Run(text, size=SCRIPT, drop=drop)


# --- formulas as MathML Core ----------------------------------------------------------------------
# The part of MathML that every browser sets by itself.
# Attributes have no style, because the page's security policy forbids it; the looks are in the frame's CSS.

WHITE: Mapping[Role, tuple[str, str]] = {"sum": (" ", " "), "product": (" ", " "), "bound": ("", " ")}
"""Spaces before and after a sign; no page shows them, but copied text has them."""


def escape(text: str) -> str:
    """Return a text that reads back as typed, in an element or in an attribute in double quotes."""
    return escaped(text, quote=True)


def row(*parts: str) -> str:
    """Return several elements as one."""
    return f"<mrow>{''.join(parts)}</mrow>"


class MathmlFormulas(TextSetter):
    """Writer of expressions as MathML, in one language."""

    BELOW = "<msub><mrow>%s</mrow>%s</msub>"
    RAISED = "<msup><mrow>%s</mrow><mrow>%s</mrow></msup>"
    POWER = "<msup>%s<mrow>%s</mrow></msup>"
    QUOTIENT, RADICAL = "<mfrac><mrow>%s</mrow><mrow>%s</mrow></mfrac>", "<msqrt>%s</msqrt>"
    ENTRY, LINE = "</mtd><mtd>", "</mtd></mtr><mtr><mtd>"
    CALL = "%s<mo>&#x2061;</mo>%s"
    APPLIED = '%s<mo>&#x2061;</mo><mrow><mspace width="0.17em"/>%s</mrow>'
    NOTE = '<mspace width="1em"/><mtext>%s</mtext>'

    def text(self, text: str) -> str:
        return escape(text)

    def upright(self, letters: str) -> str:
        return f"<mtext>{escape(letters)}</mtext>"

    def inline(self, mathematics: str) -> str:
        return f"<math>{mathematics}</math>"

    def displayed(self, mathematics: str) -> str:
        """Return a piece of a displayed formula, with fractions in full size."""
        return f'<math displaystyle="true">{mathematics}</math>'

    def number(self, number: Written) -> str:
        digits = f"<mn>{escape(number.digits)}</mn>"
        gap = NARROW if number.spaced else ""
        return row(digits, f"<mtext>{gap}{escape(number.unit)}</mtext>") if number.unit else digits

    def sign(self, sign: Sign) -> str:
        match sign.role:
            case "slash":
                return f"<mo>{sign.of}</mo>"
            case "separator":
                return f'<mo separator="true">{sign.of}</mo>'
            case "prefix":
                return f'<mo form="prefix">{sign.of}</mo>'
        before, behind = WHITE.get(sign.role, ("", ""))
        return f'{before}<mo form="infix">{sign.of}</mo>{behind}'

    def function(self, name: str) -> str:
        return f'<mi mathvariant="normal">{escape(name)}</mi>'

    def mark(self, mark: Parenthesis) -> str:
        form = "prefix" if mark.of == "(" else "postfix"
        size = ' minsize="2em" maxsize="2em"' if mark.tall else ' stretchy="false"'
        return f'<mo form="{form}"{size}>{mark.of}</mo>'

    def fence(self, fence: Fence) -> str:
        """Return an expression in parentheses, which are as high as it is."""
        inner = self.part(fence.of)
        match fence.left:
            case "":
                return row(inner)
            case "[":
                inner = f"<mtable><mtr><mtd>{inner}</mtd></mtr></mtable>"
        # Browsers set white beside parentheses that may be stretched, even where they need not be.
        still = ' stretchy="false"' if fence.left == "(" and not is_tall(fence.of) else ""
        opening, closing = (
            f'<mo form="prefix"{still}>{fence.left}</mo>',
            f'<mo form="postfix"{still}>{fence.right}</mo>',
        )
        enclosed = row(opening, inner, closing)
        return row(enclosed) if fence.left == "(" else enclosed

    def symbol(self, node: Symbol) -> str:
        letters, above = parted(node)
        base = self.lowered(runs(letters), _italic)
        if node.over == "vector":
            base = f'<mover accent="true">{row(base)}<mo stretchy="true">→</mo></mover>'
        marked = _scripted(base, self.lowered(numbered(node.sub), self.upright), self.above(above))
        return f'<mrow class="bar">{marked}</mrow>' if node.over == "segment" else marked

    def above(self, text: str) -> str:
        letters = text.lstrip(PRIMES)
        primes = text[: len(text) - len(letters)]
        return (f"<mo>{primes}</mo>" if primes else "") + (self.upright(letters) if letters else "")

    # --- lines

    def broken(self, node: Expression) -> list[str]:
        """Return the parts of an inline formula, which may break before "=" and between the terms of a sum."""
        if isinstance(node, Sum):
            return [self.part(piece).lstrip() for piece in pieces(laid(node, self.language))]
        first, *others = sides(node, self.language)
        return [self.part(first), *(self.part(MathRow((EQUALS, side))) for side in others)]

    def row(self, node: Expression) -> tuple[str, list[str]]:
        """Return a displayed row: the part left of its first "=", and the pieces between which the rest may break.

        A row without a relation has nothing on its left.
        """
        first, *others = (
            [self.part(piece).lstrip() for piece in side] for side in displayed(node, self.language, fits)
        )
        equals = self.part(EQUALS)
        rest = [equals * (index == 0) + piece for side in others for index, piece in enumerate(side)]
        return ("".join(first), rest) if rest else ("", first)

    def columns(self, equation: VectorEquation) -> list[tuple[str, list[str]]]:
        """Return each column of a vector equation: its term, and below it the known data in each row."""
        return [
            (self.leading(column.signs) + self.part(column.term), list(map(self.known, column.known)))
            for column in columns(equation)
        ]

    def leading(self, signs: tuple[Sign, ...]) -> str:
        """Return the signs before a term in its column: a minus alone is that of the term."""
        form = "prefix" if [sign.of for sign in signs] == [NEGATIVE.of] else "infix"
        return "".join(f'<mo form="{form}">{sign.of}</mo>' for sign in signs)


def _scripted(base: str, below: str, above: str) -> str:
    if below and above:
        return f"<msubsup>{row(base)}{row(below)}{row(above)}</msubsup>"
    if below:
        return f"<msub>{row(base)}{row(below)}</msub>"
    return f"<msup>{row(base)}{row(above)}</msup>" if above else base


def _italic(text: str) -> str:
    return "".join(f"<mi>{escape(char)}</mi>" if char.isalpha() else f"<mtext>{escape(char)}</mtext>" for char in text)
