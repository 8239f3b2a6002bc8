"""Animation of a cam: the cam turns, the follower moves, with the point of contact and the normal."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.units import significant_decimals
from reportgen.cam.diagrams import angle_axis, axis, motion_charts, pressure_chart
from reportgen.cam.drawings import PITCH, fitting, follower_parts, guide_walls, pivot_of
from reportgen.cam.motion_laws import NODE
from reportgen.cam.profile import CamProfile
from reportgen.cam.solution import SolvedCam
from reportgen.drawing import Circle, Diagram, Item, Line, PlottedCurve, Polyline, style
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
    Spot,
    Still,
    Track,
    extent,
)
from reportgen.drawing.charts import plotted
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import KINDS

SAMPLES = 360
ROOM = 120 + 110j
"""Largest width and height of cam and follower (mm)."""
NORMAL = 30.0
"""The drawn length of the normal (mm)."""
CENTRE = Track(np.zeros(1, complex))
"""The cam's axis."""
DIGITS, MOST_DECIMALS = 5, 4
BESIDE = 2e-5
"""Distance from a jump of the motion (rad) at which both its sides are sampled."""


def animation(case: SolvedCam) -> Animation:
    """Return the animation on the page of a cam."""
    knots = _knots(case)
    profile = case.solution.cam.profile_at(knots)
    pane = _pane(case, profile)
    return Animation(
        knots=np.degrees(knots),
        turns=1,
        span=0.0,
        positions=tuple((str(k), angle) for k, angle in enumerate(case.solution.degrees, start=1)),
        opening=case.worked[0] - 1,
        panes=(pane,),
        charts=tuple(_charts(case, profile)),
        values=tuple(_values(case, profile)),
        units=case.ledger.units,
        errors=_errors(case, knots, 1 / _scale(case)),
        layers=("paths",) if case.solution.cam.roller else (),
    )


def _knots(case: SolvedCam) -> Floats:
    """Return the sampled angles (rad) [N]: equal steps of a turn, the positions, and both sides of each jump."""
    grid = np.linspace(0, 2 * math.pi, SAMPLES + 1)
    jumps = np.array([one.angle for one in case.solution.motion.impacts])
    wanted = np.concatenate((case.solution.φ, *((np.mod(jumps + side * BESIDE, 2 * math.pi)) for side in (-1, 1))))
    near = np.abs(grid[:, None] - wanted).min(axis=1) <= BESIDE / 10
    near[[0, -1]] = False
    angles = np.sort(np.concatenate((grid[~near], wanted)))
    return angles[np.concatenate(([True], np.diff(angles) > BESIDE / 10))]


def _scale(case: SolvedCam) -> float:
    """Return the length (m) of a millimetre of the drawing."""
    cam = case.solution.cam
    reach = float(np.abs(cam.outline()).max())
    ring = reach * np.exp(1j * np.linspace(0, 2 * math.pi, 24))
    return 1 / fitting([*ring, *([] if cam.translating else [pivot_of(cam)])], ROOM)[1]


def _pane(case: SolvedCam, profile: CamProfile) -> Pane:
    """Return the cam on its shaft with its follower, the point of contact and the common normal."""
    cam = case.solution.cam
    at = 1 / _scale(case)
    turn = Track(cam.turn * profile.φ)
    outline: list[Item] = [Polyline(tuple(cam.outline() * at), style.VISIBLE, closed=True, fill=style.TINT)]
    outline.append(Line(0j, 0.6 * cam.r0 * at * 1j, style.THIN))
    items: list[MovingItem] = [
        Still((Circle(0j, cam.r0 * at, style.THIN),)),
        MovingBody(tuple(outline), CENTRE, turn),
        *(
            [MovingBody((Polyline(tuple(cam.sampled().pitch * at), PITCH, closed=True),), CENTRE, turn, "paths")]
            * bool(cam.roller)
        ),
        Still(style.pivot(0j)),
    ]
    items += _follower(case, profile, at)
    contact, normal = _contact(profile, cam.roller, cam.turn)
    place = Track(contact * at)
    items += [
        MovingVector(
            Track(contact * at - NORMAL / 2 * normal), Track(contact * at + NORMAL * normal), style.NORMAL, 0.0
        ),
        MovingBody((Circle(0j, 0.7, None, style.RED),), place),
        MovingName(Symbol("K"), place, (Track(contact * at + normal),), 1.0),
        MovingName(Symbol("O"), CENTRE, (Track(np.array([-3 - 5j])), Track(np.array([3 - 5j]))), 1.6),
    ]
    low, high = extent(items)
    spots: tuple[Spot, ...] = ()
    if cam.translating and not cam.flat and (ω := case.speed):
        rates = Track(1j * ω * profile.ds), Track(1j * ω**2 * profile.dds)
        spots = (Spot("B", Track(profile.at * at), Track(profile.at), *rates),)
    return Pane("cam", case.title, tuple(items), low=low, high=high, scales=(BarScale(1 / at, "segment"),), spots=spots)


def _contact(profile: CamProfile, roller: float, turn: int) -> tuple[Complexes, Complexes]:
    """Return the point of contact (m) and the outward unit normal in the fixed frame, each [N]."""
    turned = np.exp(1j * turn * profile.φ)
    normal = profile.normal * turned
    return profile.at - roller * normal, normal


def _follower(case: SolvedCam, profile: CamProfile, at: float) -> Iterator[MovingItem]:
    cam = case.solution.cam
    if cam.translating:
        start = complex(profile.at[0]) * at
        tip = complex(0.0, start.imag) if cam.flat else start
        parts = tuple(follower_parts(cam, tip, at, 0j, walls=False))
        lifted = Track(1j * (profile.s - profile.s[0]) * at)
        yield MovingBody(parts, lifted)
        yield Still(tuple(guide_walls(tip + 1j * cam.motion.stroke * at)))
        return
    pivot = pivot_of(cam) * at
    start = complex(profile.at[0]) * at
    parts = tuple(follower_parts(cam, start - pivot, at, 0j, walls=False))
    lifting = -cam.opposite * cam.turn
    yield MovingBody(parts, Track(np.array([pivot])), Track(lifting * (profile.s - profile.s[0])))
    yield Still(style.pivot(pivot))


# --- curves and numbers ---------------------------------------------------------------------------


def _charts(case: SolvedCam, profile: CamProfile) -> Iterator[Chart]:
    sampled = case.solution.cam.sampled()
    for (symbol, unit, values), now in zip(motion_charts(case), (profile.s, profile.ds, profile.dds), strict=True):
        plot = plotted(
            Diagram((PlottedCurve(symbol, np.degrees(sampled.φ), values),), angle_axis(case), axis(symbol, unit)),
            half=True,
        )
        scale = np.abs(values).max() / max(float(np.abs(now).max()), NODE)
        yield Chart(plot, (Curve(symbol, Track(now * scale)),))
    if not case.solution.cam.flat:
        yield Chart(pressure_chart(case, half=True), (Curve(Symbol("α"), Track(np.degrees(profile.alpha))),))


def _values(case: SolvedCam, profile: CamProfile) -> Iterator[MomentValue]:
    omega = case.speed
    for id, values in zip(case.solution.moved, (profile.s, profile.ds, profile.dds), strict=True):
        yield _value(case.ledger.symbol(id), case.ledger[id].kind, values)
    if omega is not None:
        rates = ("cam.v", "cam.acceleration") if case.solution.cam.translating else ("cam.omega.f", "cam.epsilon.f")
        for id, values in zip(rates, (omega * profile.ds, omega**2 * profile.dds), strict=True):
            yield _value(case.ledger.symbol(id), case.ledger[id].kind, values)
    if not case.solution.cam.flat:
        yield _value(Symbol("α"), "angle", profile.alpha)


def _value(symbol: Symbol, kind: str, values: Floats) -> MomentValue:
    how = KINDS[kind]
    displayed = values / how.scale
    decimals = min(max(significant_decimals(float(np.abs(displayed).max()), DIGITS), 0), MOST_DECIMALS)
    return MomentValue(symbol, how.unit, Track(displayed), decimals)


def _errors(case: SolvedCam, knots: Floats, at: float) -> Errors:
    """Return the errors of straight lines between samples, measured at their middles; jumps are left out."""
    cam = case.solution.cam
    wide = np.diff(knots) > 4 * BESIDE
    here, between = cam.profile_at(knots), cam.profile_at((knots[1:] + knots[:-1]) / 2)
    off = np.abs((here.at[1:] + here.at[:-1]) / 2 - between.at)[wide]
    share = 0.0
    for samples, true in ((here.ds, between.ds), (here.dds, between.dds)):
        most = float(np.abs(samples).max())
        if most:
            share = max(share, float(np.abs((samples[1:] + samples[:-1]) / 2 - true)[wide].max()) / most)
    return Errors(float(off.max()) * at, cam.r0 * at, share)
