"""Drawings of a rotor to scale: along and across its axis, the plans of m r z and m r, the drawing sheet."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial

from reportgen.balancing import rotor_ids
from reportgen.balancing.rotor_file import BEARINGS, LEFT, RIGHT
from reportgen.balancing.rotor_solution import SolvedRotor
from reportgen.base.records import Record
from reportgen.base.units import MM, nice_up
from reportgen.drawing import Arc, Circle, Item, Line, Pen, Scene, style
from reportgen.drawing.canvas import Canvas, finish, settle
from reportgen.drawing.drawing_description import PaperLength, direction, fact
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import bounds
from reportgen.drawing.labels import Request, label
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.drawing.vector_plan import Plan, PlanPoint, PlanVector, plan
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets.plates import on_sheet

LONG, HIGH, WIDE = 140.0, 60.0, 64.0
"""Largest length and height of the view along the axis, and width of the view across it, on a page (mm)."""
SHAFT, MASS, ARM = Pen(0.8), Pen(0.35), Pen(0.25)
CORRECTION = Pen(0.4, style.RED, style.DASHED)
DISC = 1.7
"""Radius of the symbol of a mass (mm)."""
BEYOND = 7.0
"""Length of the shaft beyond the outermost planes and bearings (mm)."""
APART = 6.0
"""Space between both views (mm)."""
CLEAR = 8.0
"""Distance from the farthest mass to the ends of planes and to the axis of places (mm)."""
HALF_BEARING, PLAY = 3.0, 1.1
"""Half the width of a bearing, and its distance from the axis (mm)."""
SENSE = 0.45
"""The radius of the arrow of rotation, as a share of the farthest mass."""


class PlacedMass(Record):
    """A mass in the drawing: its name, its place from the axis (m), its station on the axis (m), its pen."""

    name: Symbol | str
    at: complex
    station: float
    pen: Pen

    @property
    def corrects(self) -> bool:
        return self.pen is CORRECTION


def placed_masses(case: SolvedRotor) -> list[PlacedMass]:
    """Return the unbalanced masses, then the correction masses if some of their data are known."""
    given, ledger = case.given, case.printed
    placed = [
        PlacedMass(number, cmath.rect(mass.r.si, mass.angle.si), mass.z.si, CORRECTION if mass.is_sought else MASS)
        for number, mass in zip(case.masses, given.masses, strict=True)
    ]
    for plane in case.planes if given.correction else ():
        r, α = (float(ledger[name(plane)].values[0]) for name in (rotor_ids.radius, rotor_ids.direction))
        if ledger[rotor_ids.unbalance(plane)].at(1):
            placed.append(PlacedMass(Symbol("m", plane), cmath.rect(r, α), stations(case)[plane], CORRECTION))
    return placed


def stations(case: SolvedRotor) -> dict[str, float]:
    """Return the places of planes and bearings on the axis (m)."""
    given = case.given
    planes = {plane: station.si for plane, station in given.planes_by_name.items()}
    if given.finds_plane:
        planes[RIGHT] = float(case.printed[rotor_ids.station(RIGHT)].values[0])
    return planes | {name: station.si for name, station in zip(BEARINGS, given.bearings or (), strict=False)}


# --- the scheme in two views -----------------------------------------------------------------------------


def two_views(case: SolvedRotor, size: FigureSize = IN_REPORT) -> Scene:
    """Draw the rotor from the side and, below, from its right end."""
    side, μ_l = _along_axis(case, size)
    front, μ_r = _across_axis(case, size)
    (low, high), (left, top) = bounds(side.items), bounds(front.items)
    below = complex((low.real + high.real - left.real - top.real) / 2, low.imag - APART - top.imag)
    return finish(side + front.moved(below), notes=(μ_l, μ_r))


def _along_axis(case: SolvedRotor, size: FigureSize) -> tuple[Canvas, Chain]:
    """Draw the shaft from the side, z to the right, with masses at their heights for the angle 0."""
    masses, places = placed_masses(case), stations(case)
    ends = [*(one.station for one in masses), *places.values()]
    far = max(abs(one.at) for one in masses)
    usual = nice_up(max((max(ends) - min(ends)) / LONG, 2 * far / HIGH) * MM)
    per = MM * size.per_unit(usual)
    high, start = far * per + CLEAR, min(ends)
    along = {name: (place - start) * per for name, place in places.items()}
    end = (max(ends) - start) * per
    items: list[Item] = [
        Line(-BEYOND - 5 + 0j, end + BEYOND + 5 + 0j, style.AXIS),
        Line(-BEYOND + 0j, end + BEYOND + 0j, SHAFT),
    ]
    requests: list[Request] = []
    for plane in case.planes:
        x = along[plane]
        items.append(Line(complex(x, -high), complex(x, high), style.PROJECTION))
        requests.append(label(complex(x, high), Symbol(plane), gap=0.8, prefer=(math.pi / 2,)))
    for name in BEARINGS if case.given.bearings else ():
        items += bearing(along[name] + 0j)
        below = complex(along[name], -PLAY - style.STRIP)
        requests.append(label(below, Symbol(name), gap=0.8, prefer=(-math.pi / 2, -2.4, -0.7)))
    for mass in masses:
        foot = complex((mass.station - start) * per, 0)
        at = foot + 1j * mass.at.imag * per
        items += mass_on_arm(foot, at, mass)
        away = math.copysign(math.pi / 2, mass.at.imag)
        requests.append(label(at, mass.name, gap=DISC + 0.5, prefer=(away, 0.0, math.pi)))
    held = [*places.values(), *(mass.z.si for mass in case.given.masses)]
    marks, numbers = ruler(held, per, -high - 5, case.ledger.printed_unit("mm"))
    stood = [(mass.name, mass.station) for mass in masses] + [(name, places[name]) for name in case.planes]
    stood += [(name, places[name]) for name in (BEARINGS if case.given.bearings else ())]
    facts = tuple(fact("station", name, Number(float(f"{place * MM:.9g}"), unit="mm")) for name, place in stood)
    return settle(Canvas((*items, *marks), (*requests, *numbers), facts)), size.note(Symbol("μ", "l"), usual)


def ruler(places: Collection[float], per: float, height: float, mm: str) -> tuple[list[Item], list[Request]]:
    """Draw the axis z below a shaft with ticks at some places (m), the first of them at 0.

    `per` is in mm/m, `height` in mm; `mm` is the printed unit.
    """
    start, end = min(places), (max(places) - min(places)) * per
    base, tip = complex(-BEYOND, height), complex(end + BEYOND + 5, height)
    items: list[Item] = [Line(base, tip, style.DIMENSION)]
    requests = [label(tip, Symbol("z"), f", {mm}", gap=0.8, prefer=(0.0,))]
    for place in sorted(set(places)):
        at = complex((place - start) * per, height)
        items.append(Line(at - 1j, at + 1j, style.DIMENSION))
        requests.append(label(at - 1j, Number(float(f"{place * MM:.9g}")), gap=0.6, prefer=(-math.pi / 2,)))
    return items, requests


def bearing(at: complex) -> Iterator[Item]:
    """Yield a bearing at a place of the shaft (mm), with its ground above and below."""
    for up in (1j, -1j):
        yield from style.ground(at + PLAY * up - HALF_BEARING, at + PLAY * up + HALF_BEARING, round(up.imag))


def mass_on_arm(axis: complex, at: complex, mass: PlacedMass) -> tuple[Item, ...]:
    """Draw a mass at the end of its arm, both places in mm."""
    disc = Circle(at, DISC, mass.pen, style.PAPER if mass.corrects else style.TINT)
    return Line(axis, at, CORRECTION if mass.corrects else ARM), disc


def _across_axis(case: SolvedRotor, size: FigureSize) -> tuple[Canvas, Chain]:
    """Draw the rotor from its right end: angles from the axis x, anticlockwise."""
    masses = placed_masses(case)
    far = max(abs(one.at) for one in masses)
    usual = nice_up(2 * far * MM / WIDE)
    per = MM * size.per_unit(usual)
    reach = far * per + CLEAR
    items: list[Item] = [
        Line(-reach + 0j, reach + 0j, style.AXIS),
        Line(-1j * reach, 1j * reach, style.AXIS),
        Arc(0j, SENSE * far * per, math.radians(20), math.radians(70), style.DIMENSION, style.DIMENSION_HEAD),
    ]
    requests = [
        label(reach + 0j, Symbol("x"), gap=0.8, prefer=(0.0, -0.7)),
        label(1j * reach, Symbol("y"), gap=0.8, prefer=(math.pi / 2, 2.4)),
        label(SENSE * far * per * cmath.rect(1, math.radians(45)), Symbol("ω"), gap=0.8),
    ]
    for mass in masses:
        at = mass.at * per
        items += mass_on_arm(0j, at, mass)
        requests.append(label(at, mass.name, gap=DISC + 0.5, prefer=(cmath.phase(at),)))
    items.append(style.joint(0j))
    facts = tuple(fact("mass", mass.name, PaperLength(abs(mass.at) * per), direction(mass.at)) for mass in masses)
    return settle(Canvas(tuple(items), tuple(requests), facts)), size.note(Symbol("μ", "r"), usual)


# --- plans ------------------------------------------------------------------------------------------------


def moments_plan(case: SolvedRotor, size: FigureSize = IN_REPORT) -> Scene:
    """Draw m r z of all masses, closed by the correction in plane B."""
    if case.given.sought_masses:
        first, second = case.given.sought_masses
        return plan(_polygon(case, "V", case.weighed, (first, second), size))
    return plan(_polygon(case, "V", case.masses, (RIGHT,), size))


def unbalance_plan(case: SolvedRotor, size: FigureSize = IN_REPORT) -> Scene:
    """Draw m r of all masses and of the correction in plane B, closed by the correction in plane A."""
    if case.given.finds_plane:
        return plan(_polygon(case, "U", case.masses, (LEFT, RIGHT), size))
    sides = (*case.masses, RIGHT) if case.two_planes else case.masses
    return plan(_polygon(case, "U", sides, (LEFT,), size))


def _polygon(case: SolvedRotor, of: str, sides: Sequence[str], closing: Sequence[str], size: FigureSize) -> Plan:
    """Return a plan from the printed values, one side after another from the pole O; the `closing` ones are found."""
    ledger, family = case.printed, rotor_ids.unbalance if of == "U" else rotor_ids.moment
    μ = ledger.number(rotor_ids.scale(of))
    on_paper = MM * μ.value / size.scale(μ.value) / size.enlarged
    scale = float(ledger[rotor_ids.scale(of)].values[0])

    def side(place: str) -> complex:
        direction = rotor_ids.direction(place) if place == RIGHT else rotor_ids.angle(place)
        length, angle = (float(ledger[id].values[0]) for id in (family(place), direction))
        return length / scale * on_paper * cmath.rect(1, angle)

    vectors, at = [], 0j
    for place in sides:
        end, corrects = at + side(place), place == RIGHT
        name = Symbol(of, place)
        vectors.append(PlanVector(f"{of}{place}", at, end, "relative" if corrects else "known", name))
        at = end
    for place in closing:
        end = at + complex(ledger[rotor_ids.drawn(of, place)].values[0]) * on_paper
        vectors.append(PlanVector(f"{of}{place}", at, end, "found", Symbol(of, place)))
        at = end
    symbol = ledger.symbol(rotor_ids.scale(of))
    return Plan(tuple(vectors), (PlanPoint(Symbol("O"), 0j),), scale=size.note(symbol, μ.value, μ.unit))


DrawRotor = Callable[[SolvedRotor, FigureSize], Scene]
FIGURES: Mapping[str, tuple[str, DrawRotor]] = {
    "scheme": ("scheme", two_views),
    "moments": ("plans", moments_plan),
    "unbalances": ("plans", unbalance_plan),
}
"""Layer of each figure on a drawing sheet, and the function that draws it."""


def plates(case: SolvedRotor) -> Iterator[DrawingPlate]:
    """Yield the scheme and the plans, at standard scales."""
    captions = case.words["rotor"]["captions"]

    def plate(name: str, layer: str, steps: int) -> DrawingPlate:
        _, draw = FIGURES[name]
        return DrawingPlate(captions[f"figure-{name}"], (), layer, (lettered(draw(case, on_sheet(case, steps))),))

    for name, (layer, _) in FIGURES.items():
        if name != "moments" or case.two_planes or case.finds:
            yield enlargeable(partial(plate, name, layer))
