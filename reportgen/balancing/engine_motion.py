"""A moving engine for the page: cranks and pistons, force and couple of each order on the frame with their paths."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from reportgen.balancing.engine_calculation import ORDERS
from reportgen.balancing.engine_drawings import OUT, UP, banks, crank_at, piston_at
from reportgen.balancing.engine_solution import SolvedEngine
from reportgen.base.records import Record
from reportgen.base.units import significant_decimals
from reportgen.drawing import Circle, Diagram, Line, Pen, PlottedCurve, Polyline, style
from reportgen.drawing.animation import (
    Animation,
    BarScale,
    Chart,
    Curve,
    Errors,
    MomentValue,
    MovingBody,
    MovingItem,
    MovingName,
    MovingVector,
    Pane,
    Still,
    Track,
    extent,
)
from reportgen.drawing.charts import plotted
from reportgen.formula import Chain, Symbol
from reportgen.formula.calculation import ZERO
from reportgen.formula.vocabulary import KINDS

SAMPLES = 360
HIGH, FORCE = 100.0, 40.0
"""Sizes (mm) of the space for the engine, and of the greatest force or couple."""
ROTATING = "rot"
PENS = {
    "1": Pen(0.5, style.RED),
    "2": Pen(0.5, style.BLUE, style.DASHED),
    "4": Pen(0.4, style.BLACK, style.DOTTED),
    ROTATING: Pen(0.5, style.GRAY, style.CHAIN),
}
WHOLE = Pen(0.6)
DIGITS = 4
CENTRE = Track(np.zeros(1, complex))
EngineAngles = NDArray[np.float64]


class Shaking(Record):
    """The forces (N) or couples (N·m) on the frame over a turn [N], as x + iy, by order and for the rotating masses."""

    name: str
    letter: str
    kind: str
    parts: dict[str, NDArray[np.complex128]]
    """Values [N] by name, without the forces or couples that are zero over the whole turn."""
    least: float
    """Smaller values are rounding errors."""

    @property
    def whole(self) -> NDArray[np.complex128]:
        """Sum of all parts [N]."""
        return np.asarray(sum(self.parts.values()), complex)


def animation(case: SolvedEngine) -> Animation:
    """Return one turn of the crank."""
    φ = np.linspace(0, math.tau, SAMPLES + 1)
    reach = case.given.radius + case.given.l.si
    per = HIGH / reach / (2 if len(banks(case)) > 1 else 1)
    drawn = case.given.radius * per
    return Animation(
        units=case.ledger.units,
        knots=np.degrees(φ),
        turns=1,
        span=0.0,
        positions=(("1", 0.0),),
        opening=0,
        panes=(_engine(case, φ, per), *(_plan(case, one) for one in _shaking(case, φ))),
        charts=tuple(_charts(case, φ)),
        values=tuple(_values(case, φ)),
        errors=Errors(drawn * (1 - math.cos(math.pi / SAMPLES)), drawn, 1 - math.cos(ORDERS[-1] * math.pi / SAMPLES)),
    )


def _engine(case: SolvedEngine, φ: EngineAngles, per: float) -> Pane:
    reach = (case.given.radius + case.given.l.si) * per + OUT
    axes = [Line(0j, reach * UP * np.exp(1j * bank), style.AXIS) for bank in banks(case)]
    radii = sorted({case.given.of_cylinder(place, "r") for place in case.cylinders})
    circles = [Circle(0j, r * per, style.THIN) for r in radii]
    items: list[MovingItem] = [Still((*circles, *axes))]
    for place, cylinder in zip(case.cylinders, case.given.cylinders, strict=True):
        pin = Track(UP * per * np.array([piston_at(case, place, angle) for angle in φ]))
        crank = Track(UP * per * np.array([crank_at(case, place, angle) for angle in φ]))
        block = style.block(0j, float(np.angle(UP)) + cylinder.bank.si, style.BLOCK)
        items += [
            MovingVector(CENTRE, crank, style.HEAVY, 0.0),
            MovingVector(crank, pin, style.VISIBLE, 0.0),
            MovingBody((block,), pin),
            MovingBody((style.joint(0j),), pin),
            MovingBody((style.joint(0j),), crank),
            MovingName(place, crank, (CENTRE,), 1.7),
        ]
    items.append(Still(style.pivot(0j)))
    low, high = extent(items)
    title = case.words["orders"]["panes"]["engine"]
    return Pane("engine", title, tuple(items), low=low, high=high, scales=(BarScale(1 / per, "segment"),))


def _shaking(case: SolvedEngine, φ: EngineAngles) -> Iterator[Shaking]:
    """Yield the forces, and the couples if the cylinders are at several places."""
    K, places = float(case.ledger["orders.K"].values[0]), case.cylinders
    cylinders = sum(abs(case.length_of("f", 1, place)) for place in places)
    yield _kept("forces", case.forces(φ), case.rotating(φ), K * cylinders)
    if "couples" in case.stars:
        arms = sum(abs(case.length_of("p", 1, place)) for place in places)
        yield _kept("couples", case.couples(φ), case.rotating_couple(φ), K * arms)


def _kept(
    name: str, by_order: dict[int, NDArray[np.complex128]], rotating: NDArray[np.complex128], natural: float
) -> Shaking:
    """Return the parts that are not negligible compared with the sum if all cylinders pulled in one direction."""
    letter, kind = ("F", "force") if name == "forces" else ("M", "torque")
    every = {**{str(order): part for order, part in by_order.items()}, ROTATING: rotating}
    least = ZERO * natural
    return Shaking(name, letter, kind, {of: part for of, part in every.items() if np.abs(part).max() > least}, least)


def _plan(case: SolvedEngine, shaking: Shaking) -> Pane:
    """Return the vectors of the parts and of their sum, with the path of the sum, in N or N·m."""
    parts, letter, whole = shaking.parts, shaking.letter, shaking.whole
    most = max((float(np.abs(one).max()) for one in (*parts.values(), whole)), default=0.0) or FORCE
    per_mm = most / FORCE
    ring = Circle(0j, FORCE, style.THIN)
    axes = Line(-UP * FORCE, UP * FORCE, style.AXIS), Line(-FORCE + 0j, FORCE + 0j, style.AXIS)
    path = Polyline(tuple(complex(at) for at in UP * whole / per_mm), style.PATH) if parts else None
    items: list[MovingItem] = [Still((ring, *axes, *([path] if path else [])))]
    for of, part in parts.items():
        items.append(MovingVector(CENTRE, Track(UP * part / per_mm), PENS[of], label=Symbol(letter, of)))
    if len(parts) > 1:
        items.append(MovingVector(CENTRE, Track(UP * whole / per_mm), WHOLE, label=Symbol(letter)))
    low, high = extent(items)
    title = case.words["orders"]["panes"][shaking.name]
    return Pane(shaking.name, title, tuple(items), low=low, high=high, scales=(BarScale(per_mm, shaking.kind),))


def _charts(case: SolvedEngine, φ: EngineAngles) -> Iterator[Chart]:
    """Yield the parts of forces and couples along x and y over a turn."""
    across = Chain((Symbol("φ"),), str(case.words["orders"]["degrees"]))
    for shaking in _shaking(case, φ):
        unit = case.ledger.printed_unit(KINDS[shaking.kind].unit)
        for axis, along in (("x", np.real), ("y", np.imag)):
            curves = [(Symbol(shaking.letter, of), along(part)) for of, part in shaking.parts.items()]
            if any(np.abs(values).max() > shaking.least for _, values in curves):
                plots = tuple(PlottedCurve(symbol, np.degrees(φ), values) for symbol, values in curves)
                scene = plotted(Diagram(plots, across, Chain((Symbol(shaking.letter, axis),), unit)), half=True)
                yield Chart(scene, tuple(Curve(of, Track(values)) for of, values in curves))


def _values(case: SolvedEngine, φ: EngineAngles) -> Iterator[MomentValue]:
    for shaking in _shaking(case, φ):
        for of, part in shaking.parts.items():
            decimals = max(significant_decimals(float(np.abs(part).max()), DIGITS), 0)
            unit = KINDS[shaking.kind].unit
            yield MomentValue(Symbol(shaking.letter, of), unit, Track(np.abs(part)), decimals)
