"""Drawings of a synthesis: the construction of each solution, and the transmission angle over the place of A."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from functools import cached_property

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import MM
from reportgen.catalogue.extreme_positions import BEYOND, PivotPlace
from reportgen.drawing import Arc, Circle, Content, Diagram, Item, Line, Pen, PlottedCurve, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.charts import Area, plotted
from reportgen.drawing.drawing_description import angle as angle_told
from reportgen.drawing.drawing_description import fact
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import polar
from reportgen.drawing.labels import Request, label
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets.plates import on_sheet
from reportgen.structure import synthesis_ids as names
from reportgen.structure.synthesis_solution import SolvedSynthesis, number_of

ROOM = complex(130.0, 108.0)
"""Largest width and height of a construction on a page (mm)."""
CIRCLE = Pen(0.2, style.RED, style.CHAIN)
FIRST, SECOND = Pen(0.6), Pen(0.45, style.BLUE, style.DASHED)
"""Pens of the links at C₁ and at C₂."""
ANGLE, OVER = 9.0, 4.0
"""Radius of the arc of an angle, and the length of arcs beyond their ends (mm)."""
FAR = 1.2
"""The circle's centre is drawn if its radius is less than this multiple of the size of the mechanism."""
BLOCKS = 12.0
"""Length of the guide beyond the ends of the stroke (mm)."""
SAMPLES = 241
AREAS = (90.0, 45.0), (144.0, 64.0)
"""Areas of the chart on a drawing sheet (mm), the smallest first."""


class ExtremeConstruction(Record, dict=True):
    """The points of a solution (m), from the printed values: D, or the middle of the stroke, in the origin."""

    case: SolvedSynthesis
    place: PivotPlace

    @property
    def number(self) -> int:
        return number_of(self.place)

    def value(self, id: str) -> float:
        return float(self.case.printed[id].values[0])

    @property
    def radius(self) -> float:
        return self.value(names.RADIUS)

    @property
    def along(self) -> float:
        return self.value(names.along(self.case.number_of_crank(self.number)))

    @property
    def crank(self) -> float:
        return self.value(names.CRANK if self.case.shares_crank else names.crank(self.number))

    @cached_property
    def ends(self) -> tuple[complex, complex]:
        """C₁, at which crank and coupler are extended, and C₂, at which they overlap."""
        if self.case.has_rocker:
            c, half = self.value(names.ROCKER), self.value(names.SWING) / 2
            return c * polar(math.pi / 2 - half), c * polar(math.pi / 2 + half)
        half = self.value(names.STROKE) / 2
        return complex(half, 0), complex(-half, 0)

    @property
    def centre(self) -> complex:
        """The centre of the circle of A."""
        if self.case.has_rocker:
            return 1j * self.value(names.centre(self.number))
        return 1j * self.radius * math.cos(self.value(names.ANGLE))

    @cached_property
    def pivot(self) -> complex:
        """A."""
        return self.centre + self.radius * complex(-math.sin(self.along), self.place.side * math.cos(self.along))

    @cached_property
    def pins(self) -> tuple[complex, complex]:
        """B₁ and B₂: on the ray from A to C₁, and on the line AC₂ beyond A."""
        first, second = ((end - self.pivot) / abs(end - self.pivot) for end in self.ends)
        return self.pivot + self.crank * first, self.pivot - self.crank * second

    @property
    def shows_centre(self) -> bool:
        """True if the circle's centre is near enough to the mechanism to be drawn."""
        return self.radius < FAR * max(abs(self.pivot - end) for end in (*self.ends, 0j))

    @property
    def extent(self) -> list[complex]:
        """The points that the drawing has to show."""
        points = [*self.ends, self.pivot, *(self.pivot + self.crank * turn for turn in (1, -1, 1j, -1j))]
        if self.case.has_rocker:
            points.append(0j)
        if self.shows_centre:
            points += [self.centre + self.radius * turn for turn in (1, -1, 1j, -1j)]
        return points


def construction(case: SolvedSynthesis, place: PivotPlace, size: FigureSize = IN_REPORT) -> Scene:
    """Draw the construction of a solution: extreme positions, the circle of A, the crank's circle, θ and ψ."""
    points = ExtremeConstruction(case, place)
    usual, per_mm = size.fitting([point * MM for point in points.extent], ROOM)
    prime = case.mark(points.number)
    drawing = _drawn(points, per_mm * MM, prime)
    return finish(
        drawing, notes=(size.note(Symbol("μ", "l"), usual),), title=f"{points.number})" if len(case.solved) > 1 else ""
    )


def _drawn(points: ExtremeConstruction, per: float, prime: str) -> Canvas:
    """Return the construction at `per` mm of paper per m."""
    case = points.case
    A, O = points.pivot * per, points.centre * per  # noqa: E741
    C1, C2 = (end * per for end in points.ends)
    B1, B2 = (pin * per for pin in points.pins)
    ρ, crank = points.radius * per, points.crank * per
    items: list[Item] = [Line(C1, C2, style.CONSTRUCTION), Circle(A, crank, style.THIN)]
    facts = [fact("radius", Symbol("ρ"), Number(float(f"{points.radius * MM:.5g}"), unit="mm"))]
    requests: list[Request] = []
    outside = (A - O) / abs(A - O)
    if points.shows_centre:
        items += [Circle(O, ρ, CIRCLE), style.point(O), *(Line(O, end, style.CONSTRUCTION) for end in (C1, C2, A))]
        requests.append(label(O, Symbol("O", "", prime), gap=1.2))
        β = cmath.phase((A - O) / (1j * points.place.side))
        start = math.pi / 2 * points.place.side
        items.append(Arc(O, ANGLE, start, start + β, style.DIMENSION, style.DIMENSION_HEAD))
        items.append(Line(O, O + 1j * points.place.side * ρ, style.CONSTRUCTION))
        requests.append(label(O + ANGLE * polar(start + β / 2), Symbol("β", "", prime), size=style.SMALL))
        facts.append(angle_told(Symbol("β", "", prime), β))
    else:
        turns = sorted(cmath.phase((one - O) / (C1 - O)) for one in (C1, C2, A))
        begin, over = cmath.phase(C1 - O), OVER / ρ
        items.append(Arc(O, ρ, begin + turns[0] - over, begin + turns[-1] + over, CIRCLE))
    if case.has_rocker:
        items += _rocker(points, per)
        requests.append(label(0j, Symbol("D"), gap=2.0, prefer=(0.0, -0.6, math.pi)))
        half = points.value(names.SWING) / 2
        items.append(Arc(0j, ANGLE, math.pi / 2 - half, math.pi / 2 + half, style.DIMENSION))
        requests.append(label(ANGLE * 1j, Symbol("ψ"), prefer=(math.pi / 2, 1.2, 1.9), size=style.SMALL))
        facts.append(angle_told(Symbol("ψ"), 2 * half))
    else:
        left, right = C2 - BLOCKS, C1 + BLOCKS
        items += [Line(left, right, style.AXIS), *(style.block(end, 0.0, style.BLOCK) for end in (C1, C2))]
        foot = complex(A.real, 0)
        items.append(Line(A, foot, style.DIMENSION))
        requests.append(label((A + foot) / 2, Symbol("e"), size=style.SMALL))
    for pin, end, pen in ((B1, C1, FIRST), (B2, C2, SECOND)):
        items += [Line(A, end, style.CONSTRUCTION), Line(pin, end, pen), Line(A, pin, pen)]
    start, turn = cmath.phase(C1 - A), cmath.phase((C2 - A) / (C1 - A))
    reach = 0.55 * abs(C2 - A)
    items.append(Arc(A, reach, start, start + turn, style.DIMENSION))
    requests.append(label(A + reach * polar(start + turn / 2), Symbol("θ"), size=style.SMALL))
    facts.append(angle_told(Symbol("θ"), turn))
    items += [*style.pivot(A), *(style.joint(at) for at in (B1, B2, C1, C2))]
    requests.append(label(A, Symbol("A", "", prime), gap=2.0, prefer=(cmath.phase(outside),)))
    for at, name in ((B1, Symbol("B", "1", prime)), (B2, Symbol("B", "2", prime)), (C1, Symbol("C", "1"))):
        requests.append(label(at, name, gap=1.6))
    requests.append(label(C2, Symbol("C", "2"), gap=1.6))
    return Canvas(tuple(items), tuple(requests), tuple(facts))


def _rocker(points: ExtremeConstruction, per: float) -> Iterator[Item]:
    """Yield the rocker at both ends of its swing with the arc of its pin, and the bisector of the swing."""
    first, second = points.ends
    c = abs(first) * per
    yield Line(0j, 1j * (c + OVER), style.AXIS)
    yield Arc(0j, c, cmath.phase(first) - OVER / c, cmath.phase(second) + OVER / c, style.THIN)
    yield Line(0j, first * per, FIRST)
    yield Line(0j, second * per, SECOND)
    yield from style.pivot(0j)


# --- the transmission angle -----------------------------------------------------------------------


def transmission(case: SolvedSynthesis, half: bool = False, area: Area | None = None) -> Scene:
    """Draw the least transmission angle over β for each side of the chord, the solutions marked, with γ permitted."""
    curves: list[PlottedCurve] = []
    for side in case.wanted.sides:
        if (ends := case.wanted.interval(side)) is None:
            continue
        own = [place for place in case.solved if place.side == side]
        grid = np.unique([*np.linspace(*ends, SAMPLES), *(place.along for place in own)])
        marks = tuple(int(np.searchsorted(grid, place.along)) for place in own)
        γ = np.degrees(case.wanted.transmission(side, grid))
        # A curve with a solution is named by its mark.
        text = "" if own else str(case.words["synthesis"]["sides"]["beyond" if side == BEYOND else "before"])
        named = tuple(Symbol("A", "", case.mark(number_of(place))) for place in own)
        curves.append(PlottedCurve(text, np.degrees(grid), γ, marks, named))
    degrees = str(case.words["synthesis"]["degrees"])
    across: Content = Chain((Symbol("β"),), degrees)
    up: Content = Chain((Symbol("γ", "min"),), "°")
    level = (math.degrees(case.given.gamma.si), case.printed.symbol(names.PERMITTED))
    return plotted(Diagram(tuple(curves), across, up, levels=(level,)), half=half, area=area).scene


def plates(case: SolvedSynthesis) -> Iterator[DrawingPlate]:
    """Yield the constructions, at standard scales, and the diagram of the transmission angle."""
    captions = case.words["synthesis"]["captions"]

    def constructions(steps: int) -> DrawingPlate:
        size = on_sheet(case, steps)
        scenes = tuple(lettered(construction(case, place, size)) for place in case.solved)
        return DrawingPlate(captions["figure-construction"], (), "scheme", scenes)

    def curves(steps: int) -> DrawingPlate:
        size = on_sheet(case, steps)
        area = Area(*AREAS[size.steps], size.enlarged, mm=case.ledger.printed_unit("mm"))
        chart = lettered(transmission(case, area=area))
        return DrawingPlate(captions["figure-transmission"], (), "curves", (chart,))

    yield enlargeable(constructions)
    yield enlargeable(curves, len(AREAS) - 1)
