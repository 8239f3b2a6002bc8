"""A moving rotor for the page: the forces on its bearings, before and after balancing, turn with it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from reportgen.balancing.rotor_calculation import AFTER, BEFORE
from reportgen.balancing.rotor_drawings import (
    ARM,
    BEYOND,
    CORRECTION,
    DISC,
    SHAFT,
    PlacedMass,
    bearing,
    mass_on_arm,
    placed_masses,
    stations,
)
from reportgen.balancing.rotor_file import BEARINGS
from reportgen.balancing.rotor_solution import SolvedRotor
from reportgen.drawing import Circle, Diagram, Line, Pen, PlottedCurve, style
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
from reportgen.formula.vocabulary import KINDS

SAMPLES = 180
ACROSS, ALONG, FORCE = 80.0, 150.0, 45.0
"""Largest sizes of both views and of the greatest force (mm)."""
PENS = {BEFORE: Pen(0.5, style.RED), AFTER: Pen(0.5, style.BLUE, style.DASHED)}
CENTRE = Track(np.zeros(1, complex))
RotorTurns = NDArray[np.complex128]


def animation(case: SolvedRotor) -> Animation:
    """Return one turn of the rotor, across its axis and along it, with the forces on its bearings."""
    knots = np.linspace(0, math.tau, SAMPLES + 1)
    turn = np.exp(1j * knots)
    far = max(abs(mass.at) for mass in placed_masses(case))
    drawn = ACROSS / 2
    return Animation(
        units=case.ledger.units,
        knots=np.degrees(knots),
        turns=1,
        span=0.0,
        positions=(("1", 0.0),),
        opening=0,
        panes=(_across(case, turn, drawn / far), _along(case, turn)),
        charts=tuple(_charts(case, knots)),
        values=tuple(_values(case, turn)),
        errors=Errors(drawn * (1 - math.cos(math.pi / SAMPLES)), drawn, 1 - math.cos(math.pi / SAMPLES)),
    )


def forces(case: SolvedRotor) -> Iterator[tuple[str, str, complex]]:
    """Yield the state, the bearing and the force on it (N) in the axes that turn with the rotor; zero forces are left
    out.
    """
    for place in BEARINGS if case.given.bearings else ():
        for when in (BEFORE, AFTER):
            if force := case.force_on(when, place):
                yield when, place, force


def force_symbol(when: str, place: str) -> Symbol:
    return Symbol("N", place, "′" if when == AFTER else "")


def _per_force(case: SolvedRotor) -> float:
    """Return the scale of forces (N per mm of the drawing)."""
    return max((abs(force) for _, _, force in forces(case)), default=FORCE) / FORCE


def _across(case: SolvedRotor, turn: RotorTurns, per: float) -> Pane:
    masses = placed_masses(case)
    far = max(abs(mass.at) for mass in masses) * per
    angle = Track(np.unwrap(np.angle(turn)))
    carried = [item for mass in masses for item in mass_on_arm(0j, mass.at * per, mass)]
    items: list[MovingItem] = [
        Still((Circle(0j, far + DISC, style.THIN), Line(-far - 6 + 0j, far + 6 + 0j, style.AXIS))),
        MovingBody(tuple(carried), CENTRE, angle),
        MovingBody((style.joint(0j),), CENTRE),
    ]
    items += [MovingName(mass.name, Track(mass.at * per * turn), (CENTRE,), DISC + 0.5) for mass in masses]
    newtons = _per_force(case)
    for when, place, force in forces(case):
        tip = Track(force / newtons * turn)
        items.append(MovingVector(CENTRE, tip, PENS[when], label=force_symbol(when, place)))
    return _pane("across", case, items, per, newtons)


def _along(case: SolvedRotor, turn: RotorTurns) -> Pane:
    masses, places = placed_masses(case), stations(case)
    ends = [*(mass.station for mass in masses), *places.values()]
    far = max(abs(mass.at) for mass in masses)
    per = ALONG / max(max(ends) - min(ends), 2 * far) * 1.0
    x = {name: (place - min(ends)) * per for name, place in places.items()}
    end = (max(ends) - min(ends)) * per
    still = [Line(-BEYOND + 0j, end + BEYOND + 0j, SHAFT)]
    high = far * per + 6
    planes = [Line(complex(x[name], -high), complex(x[name], high), style.PROJECTION) for name in case.planes]
    supports = [item for name in BEARINGS if name in x for item in bearing(x[name] + 0j)]
    items: list[MovingItem] = [Still((*planes, *still, *supports))]
    items += [MovingName(Symbol(name), Track(np.array([complex(x[name], high)])), (), 0.8) for name in case.planes]
    for mass in masses:
        foot = (mass.station - min(ends)) * per + 0j
        items += _seen_from_the_side(mass, foot, Track(foot + 1j * (mass.at * turn).imag * per))
    newtons = _per_force(case)
    for when, place, force in forces(case):
        start = Track(np.array([x[place] + 0j]))
        tip = Track(x[place] + 1j * (force * turn).imag / newtons)
        items.append(MovingVector(start, tip, PENS[when], label=force_symbol(when, place)))
    return _pane("along", case, items, per, newtons)


def _seen_from_the_side(mass: PlacedMass, foot: complex, at: Track) -> Iterator[MovingItem]:
    start = Track(np.array([foot]))
    yield MovingVector(start, at, CORRECTION if mass.corrects else ARM, 0.0)
    yield MovingBody((Circle(0j, DISC, mass.pen, style.PAPER if mass.corrects else style.TINT),), at)
    yield MovingName(mass.name, at, (start,), DISC + 0.5)


def _pane(key: str, case: SolvedRotor, items: list[MovingItem], per: float, newtons: float) -> Pane:
    low, high = extent(items)
    scales = [BarScale(1 / per, "segment")]
    if case.given.bearings is not None:
        scales.append(BarScale(newtons, "force"))
    return Pane(key, case.words["rotor"]["panes"][key], tuple(items), low=low, high=high, scales=tuple(scales))


# --- curves and numbers -------------------------------------------------------------------------------------


def _charts(case: SolvedRotor, knots: NDArray[np.float64]) -> Iterator[Chart]:
    """Yield charts of the upward force on each bearing over a turn."""
    degrees = np.degrees(knots)
    for bearing_name in BEARINGS:
        curves = [
            (force_symbol(when, place), (force * np.exp(1j * knots)).imag)
            for when, place, force in forces(case)
            if place == bearing_name
        ]
        if curves:
            across = Chain((Symbol("φ"),), str(case.words["rotor"]["degrees"]))
            up = Chain((Symbol("N", f"{bearing_name}y"),), case.ledger.printed_unit(KINDS["force"].unit))
            plots = tuple(PlottedCurve(symbol, degrees, values) for symbol, values in curves)
            scene = plotted(Diagram(plots, across, up), half=True)
            yield Chart(scene, tuple(Curve(symbol, Track(values)) for symbol, values in curves))


def _values(case: SolvedRotor, turn: RotorTurns) -> Iterator[MomentValue]:
    for when, place, force in forces(case):
        symbol = force_symbol(when, place)
        for axis, values in (("x", (force * turn).real), ("y", (force * turn).imag)):
            yield MomentValue(Symbol("N", f"{place}{axis}", symbol.sup), KINDS["force"].unit, Track(values), 1)
