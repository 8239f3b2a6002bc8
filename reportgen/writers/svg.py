"""Scene → inline SVG whose unit is the millimetre, so that a print at 100 % is true to scale.

Pens are classes, defined once for the whole page in its style sheet: colours there follow light and dark.  Labels
are text, set in the reader's fonts at the places that the report's fonts would take.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

from reportgen.figures import style
from reportgen.figures.geometry import frame
from reportgen.figures.metrics import POINT, SCRIPT, box
from reportgen.figures.scene import Arc, Arrow, Circle, Content, Hatch, Item, Label, Line, Polyline, Scene, Stroke
from reportgen.notation import setting
from reportgen.notation.expressions import Symbol
from reportgen.notation.numbers import Language
from reportgen.notation.vocabulary import numbered, runs
from reportgen.writers.drawing import Bezier, Triangle, arc_with_head, arrow_head, clip_hatch, decimal
from reportgen.writers.mathml import escape

COLOURS = {
    style.BLACK: "ink",
    style.GRAY: "gray",
    style.PALE: "pale",
    style.BLUE: "blue",
    style.RED: "red",
    style.PAPER: "paper",
    style.TINT: "tint",
}
"""The colours of figures by the names that the style sheet has for them; any other stays as it is."""
SUB, SUPER = 0.2, -0.38
"""Where the base lines of indices lie below and above that of their letter, in font sizes."""
OVER = 0.09
"""How far an arrow or a bar is above a letter, in font sizes."""


@dataclass(frozen=True, slots=True)
class Run:
    """Letters of one label that look alike: italic or not, their size and their base line's drop in font sizes.

    They stand so far `back` from the end of those before them, in their own font size.
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
        self._names: dict[tuple[Stroke | None, str | None], str] = {}
        self._sizes: dict[float, str] = {}

    def name(self, stroke: Stroke | None, fill: str | None = None) -> str:
        """The class of a pen with a fill."""
        return self._names.setdefault((stroke, fill), f"{self._letter}{len(self._names)}")

    def size(self, points: float) -> str:
        """The class of a font size."""
        return self._sizes.setdefault(points, f"{self._letter}s{len(self._sizes)}")

    def rules(self) -> str:
        """The style sheet's rules for all of them."""
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
        """A drawing in true size; `name` is what a reader who does not see it is told."""
        width, height = decimal(scene.width), decimal(scene.height)
        body = self.items(scene.items, scene.height)
        return (
            f'<svg class="scene" role="img" aria-label="{escape(name)}" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}">{body}</svg>'
        )

    def items(self, items: Iterable[Item], height: float = 0.0) -> str:
        """The elements of items, y turned over about the `height` of their sheet."""
        found = []
        shapes = (shape for item in items for shape in self._shapes(item, height))
        for (name, joins), group in groupby(shapes, key=lambda shape: shape[:2]):
            bodies = [body for _, _, body in group]
            found.append(f'<path class="{name}" d="{"".join(bodies)}"/>' if joins else "".join(bodies))
        return "".join(found)

    def _shapes(self, item: Item, height: float) -> Iterator[tuple[str, bool, str]]:
        """(class, whether it is a path's data, the data or the element) of what an item is drawn with."""

        def at(point: complex) -> str:
            return f"{decimal(point.real)} {decimal(height - point.imag)}"

        def path(points: Sequence[complex], end: str = "") -> str:
            return "M" + "L".join(map(at, points)) + end

        def head(triangle: Triangle | None, stroke: Stroke) -> Iterator[tuple[str, bool, str]]:
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
                    # A filled shape covers what is drawn before it, so it is an element of its own.
                    yield self.pens.name(outline, fill), fill is None, self._closed(path(points), closed, outline, fill)
            case Hatch(points, spacing, stroke, turn):
                yield self.pens.name(stroke), True, "".join(path(pair) for pair in clip_hatch(points, spacing, turn))
            case Label():
                yield "", False, self.label(item, height)

    def _closed(self, data: str, closed: bool, outline: Stroke | None, fill: str | None) -> str:
        data += "Z" * closed
        return data if fill is None else f'<path class="{self.pens.name(outline, fill)}" d="{data}"/>'

    # --- labels

    def label(self, label: Label, height: float = 0.0) -> str:
        """A label as text: its middle, left or right end where the scene has it, its base line as its metrics say."""
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
        """The arrow or bar over a label that is one symbol."""
        if not isinstance(content, Symbol) or not content.over:
            return ""
        em = size * POINT
        letters = box(replace(content, sub="", sup="", over=""), size)
        top = base + 1j * (letters.height + OVER * em)
        width = max(letters.width, 0.45 * em)
        stroke = Stroke(0.13)
        if content.over == "segment":
            return self.items((Line(top, top + box(replace(content, over=""), size).width, stroke),), height)
        start = top + 0.05 * em
        return self.items((Arrow(start, start + width, stroke, 0.28 * em),), height)

    def text(self, content: Content) -> str:
        """What a label says as the content of a text element."""
        shown, drop = [], 0.0
        for run in Runs(self.language).content(content):
            # A shift counts in the font size of the run that it moves.
            shift = (run.drop - drop) / run.size
            attributes = f' dx="{decimal(-run.back)}em"' if run.back else ""
            attributes += f' dy="{decimal(shift)}em"' if shift else ""
            names = ("i " if run.italic else "") + ("x" if run.size < 1 else "")
            attributes += f' class="{names.strip()}"' if names else ""
            text = escape(run.text)
            shown.append(f"<tspan{attributes}>{text}</tspan>" if attributes else text)
            drop = run.drop
        return "".join(shown)


class Runs(setting.Setter[tuple[Run, ...]]):
    """Formulas as labels have them: in one line, indices beside their letters."""

    linear = True

    def text(self, text: str) -> tuple[Run, ...]:
        return (Run(text),) if text else ()

    def part(self, part: setting.Part) -> tuple[Run, ...]:
        of, text = self.part, self.text
        match part:
            case Symbol():
                return tuple(_symbol(part))
            case setting.Written():
                return text(part.text(setting.NARROW))
            case setting.Sign():
                return text(part.text)
            case setting.Row(parts):
                return tuple(run for one in parts for run in of(one))
            case setting.Raised(base, exponent):
                return (*of(base), *_raised(of(exponent)))
            case setting.Quotient(top, bottom):
                return (*text("("), *of(top), *text(")/("), *of(bottom), *text(")"))
            case setting.Radical(inner):
                return (*text("√"), *of(inner))
            case setting.Fence(left, inner, right):
                return (*text(left), *of(inner), *text(right))
            case setting.Applied(name, exponent, to):
                return (*text(name), *(_raised(of(exponent)) if exponent else ()), *of(to))
            case setting.Grid(rows):
                lines = (_parted([of(entry) for entry in row], "; ") for row in rows)
                return _parted(list(lines), " | ")
            case setting.Note(note):
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
    """An index and an exponent over one another: the narrower first, then the other from where it began."""
    wide_below, wide_above = (box(text, 1.0).width / POINT for text in (below, above))
    first, second = _script(below, SUB), _script(above, SUPER)
    if wide_below > wide_above:
        first, second = second, first
    yield from first
    yield from (replace(run, back=min(wide_below, wide_above)) for run in second)


def _script(text: str, drop: float) -> Iterator[Run]:
    if text:
        yield Run(text, size=SCRIPT, drop=drop)
