"""Drawings of a synthesis through three points: the linkage in the three positions, and its structural error."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from reportgen.base.units import MM
from reportgen.drawing import Arc, Content, Diagram, Item, Line, Pen, PlottedCurve, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.charts import Area, plotted
from reportgen.drawing.drawing_description import PaperLength, fact
from reportgen.drawing.drawing_description import angle as angle_told
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import polar
from reportgen.drawing.labels import Request, label
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.formula import Chain, Symbol
from reportgen.sheets.plates import on_sheet
from reportgen.structure import synthesis_ids
from reportgen.structure import three_point_names as names
from reportgen.structure.three_point_solution import THREE, SolvedThreePoints

ROOM = complex(130.0, 108.0)
"""Largest width and height of the linkage on a page (mm)."""
PENS = Pen(0.6), Pen(0.45, style.BLUE, style.DASHED), Pen(0.45, style.RED, style.CHAIN)
"""Pens of the links in the three positions."""
OVER = 4.0
"""Length of the arcs of the pins beyond their ends (mm)."""
AREAS = (90.0, 45.0), (144.0, 64.0)
"""Areas of the chart on a drawing sheet (mm), the smallest first."""


def placed(case: SolvedThreePoints) -> tuple[complex, list[tuple[complex, complex]]]:
    """Return D and the places of B and C in the three positions (m), from the printed values; A is the origin."""

    def value(id: str) -> float:
        return float(case.printed[id].values[0])

    a, c, D = value(names.CRANK), value(names.FOLLOWER), complex(value(synthesis_ids.FRAME), 0)
    angles = [(value(names.driver(k)), value(names.follower(k))) for k in THREE]
    return D, [(a * polar(φ), D + c * polar(ψ)) for φ, ψ in angles]


def positions(case: SolvedThreePoints, size: FigureSize = IN_REPORT) -> Scene:
    """Draw the linkage in the three positions with the arcs of its pins."""
    D, pins = placed(case)
    extent = [0j, D, *(pin for pair in pins for pin in pair)]
    usual, per_mm = size.fitting([point * MM for point in extent], ROOM)
    drawing = _drawn(D * per_mm * MM, [(B * per_mm * MM, C * per_mm * MM) for B, C in pins])
    return finish(drawing, notes=(size.note(Symbol("μ", "l"), usual),))


def _drawn(D: complex, pins: list[tuple[complex, complex]]) -> Canvas:
    """Return the three positions in mm of paper, with A in the origin."""
    items: list[Item] = [Line(-OVER + 0j, D + OVER, style.AXIS)]
    requests: list[Request] = []
    facts = []
    for number, ((B, C), pen) in enumerate(zip(pins, PENS, strict=True), start=1):
        items += [Line(0j, B, pen), Line(B, C, pen), Line(D, C, pen)]
        items += [style.joint(B), style.joint(C)]
        requests += [label(B, Symbol("B", str(number)), gap=1.6), label(C, Symbol("C", str(number)), gap=1.6)]
        for base, pin, letter in ((0j, B, "φ"), (D, C, "ψ")):
            turn = math.atan2((pin - base).imag, (pin - base).real)
            facts.append(angle_told(Symbol(letter, str(number)), turn))
    for base, index in ((0j, 0), (D, 1)):
        arms = [pair[index] - base for pair in pins]
        turns = np.unwrap([math.atan2(arm.imag, arm.real) for arm in arms])
        radius = abs(arms[0])
        over = OVER / radius
        items.append(Arc(base, radius, float(turns.min()) - over, float(turns.max()) + over, style.THIN))
    items += [*style.pivot(0j), *style.pivot(D)]
    requests += [
        label(0j, Symbol("A"), gap=2.0, prefer=(-0.6, math.pi)),
        label(D, Symbol("D"), gap=2.0, prefer=(-0.6,)),
    ]
    facts.append(fact("dimension", Symbol("d"), PaperLength(abs(D))))
    return Canvas(tuple(items), tuple(requests), tuple(facts))


def errors(case: SolvedThreePoints, half: bool = False, area: Area | None = None) -> Scene:
    """Draw the structural error over the crank angle, the three points marked."""
    φ = np.unique([*np.linspace(*case.ends, 241), *case.pairs.driver])
    marks = tuple(int(np.searchsorted(φ, angle)) for angle in sorted(case.pairs.driver))
    order = np.argsort(case.pairs.driver)
    named = tuple(Symbol(str(k + 1)) for k in order)
    curve = PlottedCurve("", np.degrees(φ), np.degrees(case.error_at(φ)), marks, named)
    across: Content = Chain((Symbol("φ"),), "°")
    up: Content = Chain((Symbol("Δψ"),), "°")
    return plotted(Diagram((curve,), across, up), half=half, area=area).scene


def plates(case: SolvedThreePoints) -> Iterator[DrawingPlate]:
    """Yield the three positions, at a standard scale, and the diagram of the structural error of a function."""
    captions = case.words["three_points"]["captions"]

    def linkage(steps: int) -> DrawingPlate:
        return DrawingPlate(
            captions["figure-positions"], (), "scheme", (lettered(positions(case, on_sheet(case, steps))),)
        )

    def curve(steps: int) -> DrawingPlate:
        size = on_sheet(case, steps)
        area = Area(*AREAS[size.steps], size.enlarged, mm=case.ledger.printed_unit("mm"))
        return DrawingPlate(captions["figure-error"], (), "curves", (lettered(errors(case, area=area)),))

    yield enlargeable(linkage)
    if case.follows_function:
        yield enlargeable(curve, len(AREAS) - 1)
