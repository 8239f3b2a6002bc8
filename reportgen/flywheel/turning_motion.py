"""The moving page of a turning-moment diagram: a flywheel that turns, with curves of torque, energy and speed."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.drawing import Circle, Diagram, Item, Line, Pen, PlottedCurve, style
from reportgen.drawing.animation import (
    Animation,
    Chart,
    Curve,
    Errors,
    MomentValue,
    MovingBody,
    Pane,
    Still,
    Track,
    extent,
)
from reportgen.drawing.charts import plotted
from reportgen.flywheel import turning_ids as names
from reportgen.flywheel.turning_drawings import angle_axis, axis, energy, torques
from reportgen.flywheel.turning_solution import SolvedTurning
from reportgen.formula import Symbol

RADIUS, HUB, RIM = 38.0, 5.0, 6.0
"""Radii of the wheel and of its hub, and the width of its rim (mm)."""
SPOKES = 6
CENTRE = Track(np.zeros(1, complex))


def animation(case: SolvedTurning) -> Animation:
    """Return one cycle of the flywheel."""
    φ, driving, resisting = case.curves
    kept = np.concatenate(([True], np.diff(φ) > 1e-9))
    φ, driving, resisting, work = φ[kept], driving[kept], resisting[kept], case.work[kept]
    speed = speeds(case, work)
    step = float(np.diff(φ).max())
    return Animation(
        units=case.ledger.units,
        knots=np.degrees(φ),
        turns=max(1, math.ceil(case.cycle / (2 * math.pi) - 1e-9)),
        span=0.0,
        positions=(("1", 0.0),),
        opening=0,
        panes=(_wheel(case, φ),),
        charts=tuple(_charts(case, φ, (driving, resisting), work, speed)),
        values=tuple(_values(driving, resisting, work, speed)),
        errors=Errors(RADIUS * (1 - math.cos(step / 2)), RADIUS, 1 - math.cos(step / 2)),
    )


def speeds(case: SolvedTurning, work: Floats) -> Floats:
    """Return the angular velocity (rad/s) with these works (J) [N] of the flywheel."""
    J, fastest = (float(case.ledger[id].at(1)) for id in (names.J, names.speed("max")))
    speed: Floats = np.sqrt(np.maximum(fastest**2 - 2 * (max(case.energies) - work) / J, 0.0))
    return speed


def _wheel(case: SolvedTurning, φ: Floats) -> Pane:
    pen = Pen(0.5)
    spokes: list[Item] = [
        Line(cmath.rect(HUB, angle), cmath.rect(RADIUS - RIM, angle), pen)
        for angle in np.linspace(0, 2 * math.pi, SPOKES, endpoint=False).tolist()
    ]
    mark = Circle(complex(RADIUS - RIM / 2), 1.6, None, style.RED)
    rim: list[Item] = [Circle(0j, RADIUS, pen, style.TINT), Circle(0j, RADIUS - RIM, pen, style.PAPER)]
    items = [MovingBody((*rim, *spokes, Circle(0j, HUB, pen, style.TINT), mark), CENTRE, Track(φ))]
    ground = Still((Line(complex(0), complex(RADIUS + 8), style.AXIS),))
    low, high = extent([ground, *items])
    return Pane("wheel", case.words["turning-moment"]["panes"]["wheel"], (ground, *items), low, high, ())


def _charts(
    case: SolvedTurning, φ: Floats, both: tuple[Floats, Floats], work: Floats, speed: Floats
) -> Iterator[Chart]:
    moving = [Curve(case.torque_symbol(side), Track(values)) for side, values in zip("dr", both, strict=True)]
    yield Chart(torques(case, half=True), tuple(moving))
    yield Chart(energy(case, half=True), (Curve(Symbol("E"), Track(work)),))
    up = axis(Symbol("ω"), case.ledger.printed_unit("rad/s"))
    curve = PlottedCurve(Symbol("ω"), np.degrees(φ), speed)
    level = (case.speed, case.printed.symbol(names.OMEGA))
    chart = plotted(Diagram((curve,), angle_axis(case), up, levels=(level,), zero=False), half=True)
    yield Chart(chart, (Curve(Symbol("ω"), Track(speed)),))


def _values(driving: Floats, resisting: Floats, work: Floats, speed: Floats) -> Iterator[MomentValue]:
    yield MomentValue(Symbol("M", "d"), "N·m", Track(driving), 1)
    yield MomentValue(Symbol("M", "r"), "N·m", Track(resisting), 1)
    yield MomentValue(Symbol("E"), "J", Track(work), 1)
    yield MomentValue(Symbol("ω"), "rad/s", Track(speed), 3)
