"""An engine in motion for a page: cranks and pistons, and the force of each order on the frame with its path."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from reportgen.balancing.engine_drawings import OUT, UP, banks, crank_at, piston_at
from reportgen.balancing.engine_sheet import ORDERS
from reportgen.balancing.solved_engine import SolvedEngine
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
from reportgen.formula.plain import formula
from reportgen.formula.sheet import ZERO
from reportgen.formula.vocabulary import KINDS

SAMPLES = 360
HIGH, FORCE = 100.0, 40.0
"""What the engine, and the greatest force, may fill (mm)."""
PENS = {1: Pen(0.5, style.RED), 2: Pen(0.5, style.BLUE, style.DASHED), 4: Pen(0.4, style.BLACK, style.DOTTED)}
WHOLE = Pen(0.6)
DIGITS = 4
CENTRE = Track(np.zeros(1, complex))
Turn = NDArray[np.float64]


def animation(case: SolvedEngine) -> Animation:
    """One turn of the crank."""
    φ = np.linspace(0, math.tau, SAMPLES + 1)
    reach = case.given.r.si + case.given.l.si
    per = HIGH / reach / (2 if len(banks(case)) > 1 else 1)
    drawn = case.given.r.si * per
    return Animation(
        units=case.ledger.units,
        knots=np.degrees(φ),
        turns=1,
        span=0.0,
        positions=(("1", 0.0),),
        shown=0,
        panes=(_engine(case, φ, per), _forces(case, φ)),
        charts=tuple(_charts(case, φ)),
        values=tuple(_values(case, φ)),
        errors=Errors(drawn * (1 - math.cos(math.pi / SAMPLES)), drawn, 1 - math.cos(ORDERS[-1] * math.pi / SAMPLES)),
    )


def _engine(case: SolvedEngine, φ: Turn, per: float) -> Pane:
    reach = (case.given.r.si + case.given.l.si) * per + OUT
    axes = [Line(0j, reach * UP * np.exp(1j * bank), style.AXIS) for bank in banks(case)]
    items: list[MovingItem] = [Still((Circle(0j, case.given.r.si * per, style.THIN), *axes))]
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


def _shown(case: SolvedEngine, φ: Turn) -> dict[int, NDArray[np.complex128]]:
    """The forces of the orders that are there."""
    least = ZERO * len(case.cylinders) * float(case.ledger["orders.K"].values[0])
    return {order: force for order, force in case.forces(φ).items() if np.abs(force).max() > least}


def _forces(case: SolvedEngine, φ: Turn) -> Pane:
    forces = _shown(case, φ)
    whole = np.asarray(sum(forces.values(), np.zeros(len(φ), complex)))
    most = max((float(np.abs(one).max()) for one in (*forces.values(), whole)), default=0.0) or FORCE
    newtons = most / FORCE
    ring = Circle(0j, FORCE, style.THIN)
    axes = Line(-UP * FORCE, UP * FORCE, style.AXIS), Line(-FORCE + 0j, FORCE + 0j, style.AXIS)
    path = Polyline(tuple(complex(at) for at in UP * whole / newtons), style.PATH)
    items: list[MovingItem] = [Still((ring, *axes, *([path] if forces else [])))]
    for order, force in forces.items():
        items.append(MovingVector(CENTRE, Track(UP * force / newtons), PENS[order], label=Symbol("F", str(order))))
    if len(forces) > 1:
        items.append(MovingVector(CENTRE, Track(UP * whole / newtons), WHOLE, label=Symbol("F")))
    low, high = extent(items)
    title = case.words["orders"]["panes"]["forces"]
    return Pane("forces", title, tuple(items), low=low, high=high, scales=(BarScale(newtons, "force"),))


def _charts(case: SolvedEngine, φ: Turn) -> Iterator[Chart]:
    """The parts of the forces along x and y over a turn."""
    language = case.assignment.language
    for axis, part in (("x", np.real), ("y", np.imag)):
        curves = [(Symbol("F", str(order)), part(force)) for order, force in _shown(case, φ).items()]
        if any(np.abs(values).max() > 0 for _, values in curves):
            name = Symbol("F", axis)
            across = Chain((Symbol("φ"),), str(case.words["orders"]["degrees"]))
            plots = tuple(PlottedCurve(symbol, np.degrees(φ), values) for symbol, values in curves)
            shown = plotted(
                Diagram(plots, across, Chain((name,), case.ledger.printed_unit(KINDS["force"].unit))), half=True
            )
            yield Chart(formula(name, language), shown, tuple(Curve(of, Track(values)) for of, values in curves))


def _values(case: SolvedEngine, φ: Turn) -> Iterator[MomentValue]:
    for order, force in _shown(case, φ).items():
        decimals = max(significant_decimals(float(np.abs(force).max()), DIGITS), 0)
        yield MomentValue(Symbol("F", str(order)), KINDS["force"].unit, Track(np.abs(force)), decimals)
