"""Drawing sheets → DXF: the items of the PDF, as a CAD program draws them; ezdxf writes the file.

Everything stands 1:1 in model space, in millimetres, one sheet beside another's file; a paper-space layout
shows it.  Layers go by meaning, a plate is a named group, and the same sheet gives the same bytes.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from reportgen.figures.lettering import CAPITAL
from reportgen.figures.metrics import POINT
from reportgen.figures.scene import Anchor, Arc, Arrow, Circle, Hatch, Item, Label, Line, Polyline, Stroke
from reportgen.figures.sheet import Part, Sheet
from reportgen.notation.expressions import Chain, Expression, Number, Power, Symbol
from reportgen.notation.numbers import Language, write
from reportgen.writers.drawing import arrow_head, clip_hatch
from reportgen.writers.layout import UNSPACED, Formulas

if TYPE_CHECKING:
    from ezdxf.document import Drawing

LAYERS: dict[str, int] = {
    "scheme": 7,
    "positions": 7,
    "velocity": 5,
    "acceleration": 3,
    "forces": 1,
    "indicator": 6,
    "curves": 4,
    "tables": 7,
    "axes": 8,
    "hidden": 9,
    "text": 7,
    "frame": 7,
}
"""The colour index of each layer."""
AXIS_PARTS = 4
"""A pen of four dashes and gaps is that of an axis, one of two that of a hidden or construction line."""
FONT = "Arial"
"""The text style's name, which some programs take for the font; it has all letters of Vietnamese."""
WIDTHS = (13, 18, 25, 35, 50, 70, 100)
"""Line weights that DXF knows, hundredths of a millimetre."""
ATTACHMENT: dict[Anchor, int] = {
    "top-left": 1,
    "top": 2,
    "top-right": 3,
    "left": 4,
    "center": 5,
    "right": 6,
    "bottom-left": 7,
    "bottom": 8,
    "bottom-right": 9,
}
STACK = 0.7
"""Size of indices beside the letters they belong to."""


def write_sheet(sheet: Sheet, language: Language) -> bytes:
    """The DXF file (R2010) of a sheet."""
    from ezdxf._options import options
    from ezdxf.document import Drawing

    options.write_fixed_meta_data_for_testing = True
    document = Drawing.new("R2010")
    document.header["$INSUNITS"] = 4
    document.header["$MEASUREMENT"] = 1
    document.header["$LTSCALE"] = 1.0
    document.styles.add(FONT, font="arial.ttf")
    document.linetypes.add("REPORT_AXIS", [8.0, 5.0, -1.0, 0.8, -1.2], description="axis ____ . ____")
    document.linetypes.add("REPORT_HIDDEN", [3.0, 2.0, -1.0], description="hidden __ __ __")
    for name, colour in LAYERS.items():
        linetype = {"axes": "REPORT_AXIS", "hidden": "REPORT_HIDDEN"}.get(name, "CONTINUOUS")
        document.layers.add(name, color=colour, linetype=linetype, lineweight=50 if name == "frame" else 35)
    for part in sheet.parts:
        _draw(document, part, MText(language))
    _layout(document, sheet)
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode("utf-8")


def _draw(document: Drawing, part: Part, texts: MText) -> None:
    """The items of a part in model space, as one named group."""
    model: Any = document.modelspace()
    group: list[Any]
    with document.groups.new(part.name).edit_data() as group:
        for item in part.scene.items:
            group.extend(_entities(model, item, part, texts))


def _layout(document: Drawing, sheet: Sheet) -> None:
    """A page of the sheet's size with one window on all of it, 1:1."""
    paper: Any = document.layout("Layout1")
    paper.page_setup(size=(sheet.width, sheet.height), margins=(0, 0, 0, 0), units="mm")
    size, middle = (sheet.width, sheet.height), (sheet.width / 2, sheet.height / 2)
    paper.add_viewport(center=middle, size=size, view_center_point=middle, view_height=sheet.height)


# --- items ----------------------------------------------------------------------------------------


def _entities(model: Any, item: Item, part: Part, texts: MText) -> Iterator[Any]:
    def at(point: complex) -> tuple[float, float]:
        moved = point + part.at
        return round(moved.real, 6), round(moved.imag, 6)

    def line(start: complex, end: complex, stroke: Stroke) -> Any:
        return model.add_line(at(start), at(end), dxfattribs=_pen(part.layer, stroke))

    match item:
        case Line(start, end, stroke):
            yield line(start, end, stroke)
        case Arrow(start, end, stroke, head):
            # The shaft goes on to the tip, so that a distance query finds the vector's own length.
            yield line(start, end, stroke)
            yield from _heads(model, arrow_head(start, end, head)[1], part, at)
        case Circle(centre, radius, outline, fill):
            if fill is not None and fill != WHITE:
                yield _filled(model, [at(centre + radius * _unit(k)) for k in range(24)], part.layer)
            if outline is not None:
                yield model.add_circle(at(centre), radius, dxfattribs=_pen(part.layer, outline))
        case Arc(centre, radius, start, stop, stroke, head):
            low, high = sorted((math.degrees(start), math.degrees(stop)))
            yield model.add_arc(at(centre), radius, low, high, dxfattribs=_pen(part.layer, stroke))
            tip = centre + radius * complex(math.cos(stop), math.sin(stop))
            tangent = complex(-math.sin(stop), math.cos(stop)) * math.copysign(1.0, stop - start)
            if head > 0:
                yield from _heads(model, arrow_head(tip - 4 * head * tangent, tip, head)[1], part, at)
        case Polyline(points, outline, closed, fill):
            if fill is not None and fill != WHITE and len(points) > 2:
                yield _filled(model, list(map(at, points)), part.layer)
            if outline is not None and points:
                corners = list(map(at, points))
                yield model.add_lwpolyline(corners, close=closed, dxfattribs=_pen(part.layer, outline))
        case Hatch(points, spacing, stroke, turn):
            for start, end in clip_hatch(points, spacing, turn):
                yield line(start, end, stroke)
        case Label(where, content, anchor, size, turn):
            attributes = {
                "layer": "text",
                "style": FONT,
                "char_height": round(CAPITAL * POINT * size, 4),
                "attachment_point": ATTACHMENT[anchor],
                "insert": at(where),
                "rotation": turn,
            }
            yield model.add_mtext(texts.content(content), dxfattribs=attributes)


WHITE = "#ffffff"


def _unit(k: int) -> complex:
    angle = math.tau * k / 24
    return complex(math.cos(angle), math.sin(angle))


def _heads(model: Any, triangle: Sequence[complex] | None, part: Part, at: Any) -> Iterator[Any]:
    if triangle is not None:
        tip, left, right = map(at, triangle)
        yield model.add_solid([tip, left, right], dxfattribs={"layer": part.layer})


def _filled(model: Any, corners: Sequence[tuple[float, float]], layer: str) -> Any:
    hatch = model.add_hatch(color=254, dxfattribs={"layer": layer})
    hatch.paths.add_polyline_path(corners, is_closed=True)
    return hatch


def _pen(layer: str, stroke: Stroke) -> dict[str, Any]:
    """A pen's layer and weight; axes and hidden lines have layers of their own."""
    if stroke.dash and layer != "frame":
        layer = "axes" if len(stroke.dash) >= AXIS_PARTS else "hidden"
    weight = min(WIDTHS, key=lambda width: abs(width - 100 * stroke.width))
    return {"layer": layer, "lineweight": weight}


# --- text -----------------------------------------------------------------------------------------


class MText(Formulas):
    """Formulas as MTEXT: Unicode, with indices stacked and set smaller."""

    PLUS, MINUS, NEGATIVE = "+", "−", "−"
    TIMES, DOT, CROSS = "·", "·", "×"
    FRACTION, RAISED, ROOT, ABSOLUTE = "(%s)/(%s)", "", "√(%s)", "|%s|"

    def content(self, content: Expression | str) -> str:
        return self.text(content) if isinstance(content, str) else self.math(content)

    def text(self, text: str) -> str:
        """A text with what MTEXT takes for orders made plain."""
        escaped = text.replace("\\", "\\\\").replace("{", "\\{").replace("}", "\\}")
        return escaped.replace("\n", "\\P").replace("^", "^ ")

    def math(self, node: Expression) -> str:
        if isinstance(node, Power):
            return self.tight(node.base, 5) + self.stacked("", self.math(node.exponent))
        return super().math(node)

    def stacked(self, below: str, above: str) -> str:
        """An index and an exponent over one another."""
        return f"{{\\H{STACK}x;\\S{above}^{below};}}" if below or above else ""

    def symbol(self, node: Symbol) -> str:
        # A vector is told by a bar, which MTEXT draws over the letter.
        base = self.lettered(node.base)
        over = f"\\O{base}\\o" if node.over else base
        # Digits within an index stand in its line: stacks do not nest.
        return over + self.stacked(self.text(node.sub), self.text(node.sup))

    def italic(self, text: str) -> str:
        return self.text(text)

    def upright(self, text: str) -> str:
        return self.text(text)

    def lowered(self, text: str) -> str:
        return self.stacked(self.text(text), "")

    def number(self, node: Number) -> str:
        gap = "" if node.unit in UNSPACED else " "
        return self.text(write(node.value, node.decimals, self.language) + gap + node.unit)

    def parentheses(self, node: Expression) -> str:
        return f"({self.math(node)})"

    def function(self, name: str) -> str:
        return name

    def arguments(self, nodes: Sequence[Expression]) -> str:
        return f"({'; '.join(map(self.math, nodes))})"

    def matrix(self, rows: Iterable[Sequence[str]]) -> str:
        return "[" + "; ".join(", ".join(row) for row in rows) + "]"

    def chain(self, node: Chain) -> str:
        return " = ".join(map(self.math, node.parts))
