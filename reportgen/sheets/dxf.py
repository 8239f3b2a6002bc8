"""Write a drawing sheet as DXF for CAD programs with ezdxf: `write_sheet`.

The items of the PDF are drawn 1:1 in millimetres in model space, one file per sheet; a paper-space layout shows them.
Layers follow the meaning of lines, each plate is a named group, and the same sheet gives the same bytes.
"""

from __future__ import annotations

import cmath
import io
import math
import re
from collections import OrderedDict
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from reportgen.base.languages import setting_of
from reportgen.base.units import Language, rounded
from reportgen.drawing import Anchor, Arc, Arrow, Circle, Hatch, Item, Label, Line, Pen, Polyline
from reportgen.drawing.drawing_sheet import CAPITAL, NARROW, DrawingSheet, PlacedScene
from reportgen.drawing.label_size import POINT
from reportgen.drawing.style import HEAD_SLENDERNESS, PAPER, arrow_head, clip_hatch
from reportgen.formula import Symbol
from reportgen.formula.plain_text import Plain
from reportgen.formula.vocabulary import runs

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
    "profile": 1,
    "spline": 5,
    "axes": 8,
    "hidden": 9,
    "text": 7,
    "frame": 7,
}
"""Colour index of each layer."""
AXIS, HIDDEN = "CENTER", "HIDDEN"
AXIS_PARTS = 4
"""A pen of four dashes and gaps is that of an axis, one of two that of a hidden or construction line."""
WIDTHS = (13, 18, 25, 35, 50, 70, 100)
"""Line weights of DXF in hundredths of a millimetre."""
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
HALIGN = {"left": 0, "center": 1}
"""Horizontal alignment of a line of text at its place; vertically it is centred."""
ORDERS = frozenset("%^\\")
"""Characters that begin a control code in a line of text."""
SHADE = 254
"""Colour index of the inside of a link, a light grey."""
CORNER = 0.1
"""Angle (rad) between successive chords of a curve above which they meet in a corner."""
FITTED = 360
"""Approximate largest number of points of a curve that a spline goes through."""
REALS = range(10, 60)
"""Group codes of real numbers; those from `FURTHER` on are no coordinates: sizes, angles, knots."""
FURTHER = 40
PLACE_DECIMALS, REAL_DECIMALS = 5, 8
HUGE = 1e9
"""Limit of the extents; those of an empty drawing are larger."""
STACK = 0.7
"""Size of indices beside the letters they belong to."""
_PAIR = re.compile("%(?=%)")


def write_sheet(sheet: DrawingSheet, language: Language) -> bytes:
    """Return the DXF file (R2010) of a sheet."""
    import ezdxf

    # Dates and serial numbers would make each file another one.
    ezdxf.options.write_fixed_meta_data_for_testing = True
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.header["$MEASUREMENT"] = 1
    document.header["$LTSCALE"] = 1.0
    # LibreCAD takes the style's name for the name of one of its stroke fonts. Its usual one lacks most letters of
    # Vietnamese, which are in the file of that name in `templates/frames/letters`; all other programs take the font.
    letters = setting_of(language).drawing
    document.styles.add(letters.style, font=letters.font)
    document.linetypes.add(AXIS, [8.0, 5.0, -1.0, 0.8, -1.2], description="axis ____ . ____")
    document.linetypes.add(HIDDEN, [3.0, 2.0, -1.0], description="hidden __ __ __")
    for name, colour in LAYERS.items():
        linetype = {"axes": AXIS, "hidden": HIDDEN}.get(name, "CONTINUOUS")
        document.layers.add(name, color=colour, linetype=linetype, lineweight=50 if name == "frame" else 35)
    for part in sheet.parts:
        _draw(document, part, MText(language))
    _layout(document, sheet)
    # ezdxf keeps the names of classes in a set, whose order is another one in each process.
    document.classes.add_required_classes(document.dxfversion)
    document.classes.classes = OrderedDict(sorted(document.classes.classes.items()))
    stream = io.StringIO()
    document.write(stream)
    return _rounded(stream.getvalue()).encode("utf-8")


def _rounded(text: str) -> str:
    """Return the text of a DXF file with its real numbers rounded, so that every processor gives the same bytes."""
    tags = text.split("\n")
    for place in range(0, len(tags) - 1, 2):
        code = int(tags[place])
        if code in REALS and abs(value := float(tags[place + 1])) < HUGE:
            tags[place + 1] = repr(rounded(value, PLACE_DECIMALS if code < FURTHER else REAL_DECIMALS))
    return "\n".join(tags)


def _draw(document: Drawing, part: PlacedScene, texts: MText) -> None:
    """Draw the items of a part in model space as one named group; each named vector is also a group: "9.1 pb"."""
    groups: dict[str, list[Any]] = {part.name: []}
    for item in part.scene.items:
        entities = list(_entities(document, item, part, texts))
        groups[part.name] += entities
        if isinstance(item, Arrow) and item.name:
            groups.setdefault(f"{part.name} {item.name}", []).extend(entities)
    for name, entities in groups.items():
        # A plate in several parts has its head above each of them; on one sheet they are one group.
        group = document.groups.get(name)
        (document.groups.new(name) if group is None else group).extend(entities)


def _layout(document: Drawing, sheet: DrawingSheet) -> None:
    """Add a page of the sheet's size with one viewport that shows all of it 1:1."""
    paper: Any = document.layout("Layout1")
    paper.page_setup(size=(sheet.width, sheet.height), margins=(0, 0, 0, 0), units="mm")
    size, middle = (sheet.width, sheet.height), (sheet.width / 2, sheet.height / 2)
    paper.add_viewport(center=middle, size=size, view_center_point=middle, view_height=sheet.height)


# --- items ----------------------------------------------------------------------------------------


def _entities(document: Drawing, item: Item, part: PlacedScene, texts: MText) -> Iterator[Any]:
    model: Any = document.modelspace()

    def at(point: complex) -> tuple[float, float]:
        moved = point + part.at
        return rounded(moved.real, PLACE_DECIMALS), rounded(moved.imag, PLACE_DECIMALS)

    def line(start: complex, end: complex, stroke: Pen) -> Any:
        return model.add_line(at(start), at(end), dxfattribs=_pen(part.layer, stroke))

    def head(start: complex, end: complex, length: float) -> Iterator[Any]:
        if triangle := arrow_head(start, end, length)[1]:
            tip, left, right = triangle
            back = (left + right) / 2 - tip
            how = {"layer": part.layer, "rotation": rounded(math.degrees(cmath.phase(back)), REAL_DECIMALS) % 360}
            how |= {"xscale": abs(back), "yscale": abs(back)}
            yield model.add_blockref(_arrowhead(document), at(tip), dxfattribs=how)

    match item:
        case Line(start, end, stroke):
            yield line(start, end, stroke)
        case Arrow(start, end, stroke, length):
            # The shaft continues to the tip, so that a distance query finds the vector's own length.
            yield line(start, end, stroke)
            yield from head(start, end, length)
        case Circle(centre, radius, outline, fill):
            if fill is not None and fill != PAPER:
                yield model.add_blockref(_disc(document, radius), at(centre), dxfattribs={"layer": part.layer})
            if outline is not None:
                yield model.add_circle(at(centre), radius, dxfattribs=_pen(part.layer, outline))
        case Arc(centre, radius, start, stop, stroke, length):
            low, high = sorted((math.degrees(start), math.degrees(stop)))
            yield model.add_arc(at(centre), radius, low, high, dxfattribs=_pen(part.layer, stroke))
            if length > 0:
                tip = centre + cmath.rect(radius, stop)
                tangent = 1j * cmath.rect(math.copysign(1.0, stop - start), stop)
                yield from head(tip - 4 * length * tangent, tip, length)
        case Polyline(points, outline, closed, fill, smooth):
            if fill is not None and fill != PAPER and len(points) > 2:
                hatch = model.add_hatch(color=SHADE, dxfattribs={"layer": part.layer})
                hatch.paths.add_polyline_path(list(map(at, points)), is_closed=True)
                yield hatch
            if outline is not None and points:
                corners = list(map(at, points))
                yield model.add_lwpolyline(corners, close=closed, dxfattribs=_pen(part.layer, outline))
            if smooth:
                yield from (_spline(model, list(map(at, piece))) for piece in _smooth(points, closed))
        case Hatch(points, spacing, stroke, turn):
            for start, end in clip_hatch(points, spacing, turn):
                yield line(start, end, stroke)
        case Label(where, content, anchor, size, turn, over, narrow):
            letters = {"layer": "text", "style": texts.style, "insert": at(where), "rotation": turn}
            height = round(CAPITAL * POINT * size, 4)
            if narrow < 1.0 and isinstance(content, str) and not set(content) & ORDERS:
                # Only a line of text has a width in every program.
                how = {"height": height, "width": round(narrow, 4), "halign": HALIGN[anchor], "valign": 2}
                yield model.add_text(content, dxfattribs={**letters, **how, "align_point": at(where)})
            else:
                attributes = {**letters, "char_height": height, "attachment_point": ATTACHMENT[anchor]}
                text = model.add_mtext(texts.content(content), dxfattribs=attributes)
                if over:
                    text.set_bg_color("canvas", scale=1.0)
                yield text


def _smooth(points: tuple[complex, ...], closed: bool) -> list[list[complex]]:
    """Return the pieces of a curve between its corners, each with at most the points that a spline needs."""
    vertices = [*points, points[0]] if closed else list(points)
    sides = [cmath.phase(after - before) for before, after in pairwise(vertices)]
    turned = [abs(math.remainder(other - one, 2 * math.pi)) for one, other in pairwise(sides)]
    corners = [0, *(place for place, angle in enumerate(turned, start=1) if angle > CORNER), len(vertices) - 1]
    pieces = [vertices[first : last + 1] for first, last in pairwise(corners)]
    return [[*piece[: -1 : max(len(piece) // FITTED, 1)], piece[-1]] for piece in pieces]


def _spline(model: Any, points: list[tuple[float, float]]) -> Any:
    """Return the cubic B-spline through points, on a separate layer."""
    from ezdxf.math import global_bspline_interpolation

    degree = min(3, len(points) - 1)
    curve = global_bspline_interpolation([(x, y, 0.0) for x, y in points], degree=degree)
    return model.add_spline(dxfattribs={"layer": "spline"}).apply_construction_tool(curve)


def _arrowhead(document: Drawing) -> str:
    """Return the name of the block of all arrowheads: its tip at the origin, one unit long along x."""
    name = "ARROWHEAD"
    if name not in document.blocks:
        block: Any = document.blocks.new(name)
        half = HEAD_SLENDERNESS / 2
        block.add_solid([(0, 0), (1, half), (1, -half)])
    return name


def _disc(document: Drawing, radius: float) -> str:
    """Return the name of the block of a black point with a radius (mm)."""
    name = f"POINT_{1000 * radius:.0f}"
    if name not in document.blocks:
        block: Any = document.blocks.new(name)
        hatch = block.add_hatch()
        hatch.paths.add_edge_path().add_arc((0, 0), radius)
    return name


def _pen(layer: str, stroke: Pen) -> dict[str, Any]:
    """Return layer, weight and line type of a pen; thin axes and construction lines have their own layers."""
    weight = min(WIDTHS, key=lambda width: abs(width - 100 * stroke.width))
    if not stroke.dash or layer == "frame":
        return {"layer": layer, "lineweight": weight}
    own, linetype = ("axes", AXIS) if len(stroke.dash) >= AXIS_PARTS else ("hidden", HIDDEN)
    if stroke.width > NARROW:
        return {"layer": layer, "lineweight": weight, "linetype": linetype}
    return {"layer": own, "lineweight": weight}


# --- text -----------------------------------------------------------------------------------------


class MText(Plain):
    """Writer of formulas as MTEXT: Unicode, with indices stacked and set smaller."""

    BELOW = f"%s{{\\H{STACK}x;\\S^ %s;}}"
    RAISED = f"%s{{\\H{STACK}x;\\S%s^ ;}}"
    NOTE = "  %s"

    @property
    def style(self) -> str:
        """The name of the style that the letters have."""
        return setting_of(self.language).drawing.style

    def text(self, text: str) -> str:
        """Return a text with the characters escaped that MTEXT would take for control codes."""
        escaped = text.replace("\\", "\\\\").replace("{", "\\{").replace("}", "\\}")
        # Two percent signs begin an order, too: an empty group parts them.
        return _PAIR.sub("%{}", escaped).replace("\n", "\\P").replace("^", "^ ")

    def symbol(self, node: Symbol) -> str:
        # Without the arrow of a vector: overlining is an order that not every program knows and some print.
        # Digits within an index stay on its line, because stacks cannot be nested.
        return self.lowered(runs(node.base), self.text) + _stacked(self.text(node.sub), self.text(node.sup))


def _stacked(below: str, above: str) -> str:
    """Return an index below an exponent."""
    # Without the blank a caret and the letter after it would be a control character.
    return f"{{\\H{STACK}x;\\S{above}^ {below};}}" if below or above else ""
