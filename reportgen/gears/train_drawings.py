"""Drawings of a planetary train true to scale: scheme, velocity triangles, animation and drawing sheet."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise

import numpy as np

from reportgen.base.records import replace
from reportgen.base.units import MM, nice_up
from reportgen.drawing import Arrow, Circle, Item, Line, Pen, Polyline, Scene, style
from reportgen.drawing.animation import (
    Animation,
    BarScale,
    Errors,
    MomentValue,
    MovingBody,
    MovingItem,
    Pane,
    Track,
    extent,
)
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import PaperLength, arrow, direction, fact
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.labels import Request, label
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.formula import Number, Ref, Symbol
from reportgen.formula.evaluation import evaluate
from reportgen.formula.vocabulary import KINDS
from reportgen.gears import train_ids
from reportgen.gears.tooth_numbers import ALPHA, turned
from reportgen.gears.train_formulas import OTHER, reference_radius
from reportgen.gears.train_ledger import SolvedTrain, pole_distance
from reportgen.sheets.plates import on_sheet

FRONT = 80.0
"""Largest size of the scheme seen along its axis on a page (mm)."""
WHEEL = Pen(0.4)
SATELLITE = Pen(0.25, style.BLUE)
CARRIER = Pen(0.5, style.RED, style.DASHED)
RIM, BESIDE = 2.6, 0.45
"""Half the width of a rim in the side view, and distance from a reference line to its rim (mm)."""
STEP = 13.0
"""Distance from one plane of wheels to the next, and to the carrier (mm)."""
SHAFT = 14.0
LEG = 4.0
BEYOND = 6.0
"""Length of the lines of the triangles beyond their ends (mm)."""
APART = 16.0
"""Gap between the triangles and the plan of angular velocities (mm)."""
SAMPLES = 360
RADIUS = reference_radius(Ref("m"), Ref("z"))
FILMED = 110.0
"""Largest size of the wheels on a page (mm)."""


def radii(case: SolvedTrain) -> dict[str, float]:
    """Return the reference radii of the wheels (m) by name, and the radius of the satellites' axes as H."""
    given, z = case.given, case.train.teeth
    m, m2 = given.m.si, given.second_module.si
    wheels = {"1": (m, z.z1), "2": (m, z.z2), OTHER: (m2, z.z2_prime), "3": (m2, z.z3)}
    radius = {wheel: float(evaluate(RADIUS, {"m": module, "z": teeth})) for wheel, (module, teeth) in wheels.items()}
    return radius | {"H": float(case.ledger["train.a.1"].values[0])}


def outermost(r: dict[str, float]) -> float:
    """Return the reach of wheels from the axis, by their reference circles, in the unit of the radii."""
    return max(r["1"], r["3"], r["H"] + max(r["2"], r[OTHER]))


# --- two views of the scheme ------------------------------------------------------------------------------


def scheme_views(case: SolvedTrain, size: FigureSize = IN_REPORT) -> Scene:
    """Return the scheme seen along the axis and from the side, at one height."""
    usual = nice_up(2 * outermost(radii(case)) * MM / FRONT)
    r = {wheel: radius * MM * size.per_unit(usual) for wheel, radius in radii(case).items()}
    front, named = _along(case, r)
    side, beside = _from_side(case, r, complex(outermost(r) + 36.0, 0))
    wheels = [("1", r["1"]), ("2", r["2"]), *(() if case.scheme.single else (("2′", r[OTHER]),)), ("3", r["3"])]
    facts = (
        *(fact("wheel", wheel, PaperLength(radius)) for wheel, radius in wheels),
        fact("carrier", "H", PaperLength(r["H"]), Number(case.given.k)),
        fact("held", "3"),
    )
    draft = Canvas((*front, *side), (*named, *beside), facts)
    return finish(draft, notes=(size.note(Symbol("μ", "l"), usual),), margin=2.0)


def _along(case: SolvedTrain, r: dict[str, float]) -> tuple[list[Item], list[Request]]:
    """Return the reference circles, with equally spaced satellites, the first above the axis."""
    k, single = case.given.k, case.scheme.single
    places = [r["H"] * cmath.rect(1, math.pi / 2 + number * math.tau / k) for number in range(k)]
    items: list[Item] = [Circle(0j, r["H"], style.AXIS)]
    items += [Circle(0j, r[wheel], WHEEL) for wheel in ("1", "3")]
    for place in places:
        items += [Circle(place, r[wheel], SATELLITE) for wheel in dict.fromkeys(("2", "2" if single else OTHER))]
        items += [Line(0j, place, CARRIER), style.joint(place)]
    items.append(style.joint(0j))
    ring = outermost(r)
    items += [*_held(-1j * r["3"]), Line(complex(-ring - 4, 0), complex(ring + 4, 0), style.AXIS)]
    requests = [
        label(0j, Symbol("O"), gap=1.8, prefer=(-0.5, -2.6)),
        label(places[0], Symbol("B"), gap=1.8, prefer=(0.5, 2.6)),
        label([r["1"] * cmath.rect(1, φ) for φ in (-0.6, -2.5, 0.2, 2.9)], "1", gap=0.8),
        label([places[0] + r["2"] * cmath.rect(1, φ) for φ in (0.4, 2.7, 1.2)], "2", gap=0.8),
        label([r["3"] * cmath.rect(1, φ) for φ in (-1.0, -2.1, 0.3, 2.8)], "3", gap=0.8),
        label([places[0] * share for share in (0.6, 0.5, 0.7)], "H", gap=0.8),
    ]
    if not single:
        spots = [places[0] + r[OTHER] * cmath.rect(1, φ) for φ in (-0.4, -2.7, 0.8, 2.3)]
        requests.append(label(spots, Symbol("2", sup="′"), gap=0.8))
    return items, requests


def _from_side(case: SolvedTrain, r: dict[str, float], at: complex) -> tuple[list[Item], list[Request]]:
    """Return the side view: the axis horizontal, each wheel a line with its rims, one satellite above the axis."""
    first, last = at, at + (0 if case.scheme.single else STEP)
    carrier = last + STEP
    B = complex(0, r["H"])
    start, end = first - SHAFT, carrier + SHAFT
    inner1, inner3 = case.scheme.inner
    items: list[Item] = [Line(start - 4, end + 4, style.AXIS)]
    items += [*_wheel(first, r["1"], WHEEL, inner1, first - STEP / 2 if inner1 else first)]
    items += [*_wheel(first + B, r["2"], SATELLITE)]
    if not case.scheme.single:
        items += [*_wheel(last + B, r[OTHER], SATELLITE)]
    items += [*_fixed(last, r["3"], inner3)]
    items += [Line(start, first - (STEP / 2 if inner1 else 0), WHEEL)]
    items += [
        Line(first + B - 3, carrier + B, SATELLITE),
        Line(carrier + B, carrier, CARRIER),
        Line(carrier, end, CARRIER),
    ]
    for place in (start + SHAFT / 3, end - SHAFT / 3):
        for up in (1j, -1j):
            items += style.ground(place + 1.1 * up - 2.5, place + 1.1 * up + 2.5, round(up.imag))
    requests = [
        label([first - 1j * r["1"] * share for share in (0.7, 0.5, 0.9)], "1", gap=0.8),
        label([first + B + 1j * r["2"] * share for share in (0.6, 0.4, 0.8)], "2", gap=0.8, prefer=(math.pi, 0.0)),
        label([last - 1j * (r["3"] + LEG / 2), last - 1j * r["3"]], "3", gap=1.0),
        label([carrier + B * share for share in (0.5, 0.35, 0.65)], "H", gap=0.8, prefer=(0.0,)),
        label(first + B - 3, Symbol("B"), gap=0.8, prefer=(math.pi, 2.6)),
        label(start, Symbol("O"), gap=0.8, prefer=(2.6, -2.6)),
    ]
    if not case.scheme.single:
        spots = [last + B + 1j * r[OTHER] * share for share in (0.6, 0.4, 0.8)]
        requests.append(label(spots, Symbol("2", sup="′"), gap=0.8, prefer=(0.0, math.pi)))
    return items, requests


def _wheel(at: complex, r: float, pen: Pen, inner: bool = False, disc: complex = 0j) -> Iterator[Item]:
    """Draw a wheel from the side; the disc of an inner wheel is beside it and its rims are outside the
    reference line.
    """
    if not inner:
        yield Line(at - 1j * r, at + 1j * r, pen)
    for up in (1j, -1j):
        rim = at + up * (r + (BESIDE if inner else -BESIDE))
        yield Line(rim - RIM, rim + RIM, pen)
        if inner:
            yield Polyline((disc, disc + up * (r + BESIDE + 2), rim + up * 2, rim), pen)


def _fixed(at: complex, r: float, inner: bool) -> Iterator[Item]:
    """Draw wheel 3 with the ground that holds it below, and for an inner wheel also above."""
    if not inner:
        yield from _wheel(at, r, WHEEL)
    for up in (1j, -1j) if inner else (-1j,):
        rim = at + up * (r + (BESIDE if inner else -BESIDE))
        yield Line(rim - RIM, rim + RIM, WHEEL)
        yield from _held(rim, up)


def _held(rim: complex, up: complex = -1j) -> Iterator[Item]:
    """Draw the support of the rim of wheel 3, which is fixed."""
    foot = rim + up * LEG
    yield Line(rim, foot, WHEEL)
    yield from style.ground(foot - 4, foot + 4, round(up.imag))


# --- triangles of velocities --------------------------------------------------------------------------------


def velocity_triangles(case: SolvedTrain, size: FigureSize = IN_REPORT) -> Scene:
    """Return velocities over the distance of their points from the axis; below, the plan of angular velocities.

    A velocity in the sense of the driving shaft points to the right.  In the plan each ray from the pole K is parallel
    to the line of its body; it cuts off the angular velocity, measured from the foot of K, which is that of wheel 3.
    """
    ledger = case.ledger
    symbols = {of: ledger.symbol(train_ids.scale(of)) for of in ("l", "v", "omega")}
    usual = {of: case.printed.number(train_ids.scale(of)) for of in symbols}
    larger = {of: usual[of].value / size.scale(usual[of].value) for of in ("l", "v")}

    def mm(id: str, of: str) -> float:
        return float(ledger[id].values[0]) * MM * larger[of] / size.enlarged

    p1, p3, pH = (mm(train_ids.line(line), "l") for line in ("OA", "OP", "OB"))
    Aa, Bb = (mm(train_ids.line(line), "v") for line in ("A", "B"))
    slopes = {"1": Aa / p1, "2": Aa / (p1 - p3), "H": Bb / pH}
    h = float(ledger["train.pole"].values[0]) * MM
    if size.steps:
        rate = size.scale(usual["v"].value) / size.scale(usual["l"].value)
        h = pole_distance(rate, max(*slopes.values(), 0.0) - min(*slopes.values(), 0.0), larger["l"])
    μ_ω = usual["omega"].value * float(ledger["train.pole"].values[0]) * MM / h * larger["l"] / larger["v"]
    h /= size.enlarged
    A, P, B = complex(0, p1), complex(0, p3), complex(0, pH)
    a, b = A + Aa, B + Bb
    ends = sorted((a, b, P), key=lambda one: one.imag)
    items: list[Item] = [Line(-8j, complex(0, max(p1, p3, pH) + BEYOND), style.AXIS)]
    items += [Line(0j, a, WHEEL), Line(0j, b, CARRIER), Line(ends[0], ends[-1], SATELLITE)]
    items += [Arrow(A, a, style.VISIBLE, name="Aa"), Arrow(B, b, style.VISIBLE, name="Bb")]
    items += [style.point(one) for one in (0j, A, B, P)]
    left = {"O": Aa > 0, "A": Aa > 0, "B": Bb > 0, "P": Bb > 0, "a": Aa < 0, "b": Bb < 0}
    requests = [
        label(at, Symbol(name), gap=1.0, prefer=(math.pi if left[name] else 0.0,))
        for at, name in ((0j, "O"), (A, "A"), (B, "B"), (P, "P"), (a, "a"), (b, "b"))
    ]
    requests += [label([end * share for share in (0.55, 0.4, 0.7)], name) for end, name in ((a, "1"), (b, "H"))]
    parts = sorted(pairwise(ends), key=lambda pair: -abs(pair[1] - pair[0]))
    requests.append(label([(one + other) / 2 for one, other in parts], "2"))
    # The plan of angular velocities is below: K is under the common level of all ends.
    K = complex(0, -APART - h)
    level = K + 1j * h
    tips = {wheel: level + h * slope for wheel, slope in slopes.items()}
    reach = [0.0, *(tip.real for tip in tips.values())]
    items += [
        Line(level + min(reach) - BEYOND, level + max(reach) + BEYOND, style.VISIBLE),
        Line(K, level, style.AXIS),
        style.point(K),
        *(style.point(tip) for tip in (level, *tips.values())),
    ]
    for wheel, pen in (("1", WHEEL), ("2", SATELLITE), ("H", CARRIER)):
        items.append(Arrow(K, tips[wheel], pen, 0.0, name=f"s{wheel}"))
        requests.append(label(tips[wheel], wheel, gap=1.0, prefer=(math.pi / 2,)))
    requests += [
        label(level, "3", gap=1.0, prefer=(math.pi / 2,)),
        label(K, Symbol("K"), gap=1.0, prefer=(-math.pi / 2,)),
        label([K + 0.5j * h, K + 0.35j * h, K + 0.7j * h], Symbol("h"), gap=0.6, prefer=(math.pi, 0.0)),
    ]
    notes = [size.note(symbols[of], usual[of].value, usual[of].unit) for of in ("l", "v")]
    rates = replace(usual["omega"], value=float(f"{μ_ω:.6g}"), decimals=None)
    notes.append(size.compared(symbols["omega"], rates, usual["omega"]))
    facts = [arrow(Symbol("Aa"), a - A), arrow(Symbol("Bb"), b - B)]
    facts += (
        fact("ray", Symbol("K"), wheel, PaperLength(abs(tip - K)), direction(tip - K)) for wheel, tip in tips.items()
    )
    return finish(Canvas(tuple(items), tuple(requests), tuple(facts)), notes=notes, margin=2.0)


# --- the animation ------------------------------------------------------------------------------------------


def toothed(teeth: int, radius: float, inner: bool = False) -> Polyline:
    """Return a wheel with straight flanks (mm), its first tooth to the right: it shows the position of teeth, not
    their form.
    """
    m = 2 * radius / teeth
    steps = ((-1.25, 1), (1.0, 1), (1.0, -1), (-1.25, -1))
    points = []
    for number in range(teeth):
        for height, side in steps:
            half = (math.pi / 4 - height * math.tan(ALPHA)) * m
            r = radius - height * m if inner else radius + height * m
            points.append(cmath.rect(r, number * math.tau / teeth - side * half / r))
    return Polyline(tuple(points), Pen(0.2), closed=True)


def animation(case: SolvedTrain) -> Animation:
    """Return one turn of the carrier, however many turns the wheels make in it."""
    knots = np.linspace(0, math.tau, SAMPLES + 1)
    a = radii(case)["H"] * _at(case)
    return Animation(
        units=case.ledger.units,
        knots=np.degrees(knots),
        turns=1,
        span=0.0,
        positions=(("1", 0.0),),
        opening=0,
        panes=(_pane(case, knots),),
        charts=(),
        values=tuple(_values(case)),
        errors=Errors(a * (1 - math.cos(math.pi / SAMPLES)), a, 0.0),
    )


def _at(case: SolvedTrain) -> float:
    """Return the scale of the drawing (mm per m)."""
    return FILMED / 2 / outermost(radii(case))


def _pane(case: SolvedTrain, knots: np.ndarray) -> Pane:
    train, r, at = case.train, radii(case), _at(case)
    z, (inner1, inner3) = train.teeth, case.scheme.inner
    ω1, ω2, ωH = (float(case.ledger[train_ids.omega(wheel)].at(1)) for wheel in ("1", "2", "H"))
    θ = math.copysign(1, ωH) * knots
    wheel1, satellite = ω1 / ωH, ω2 / ωH
    still, placed = turned(train, case.given.k)
    centre, red = Track(np.zeros(1, complex)), Pen(0.35, style.RED)

    def marked(wheel: str, teeth: int, inner: bool) -> tuple[Item, ...]:
        """A wheel with a mark that shows how it turns; an inner one has its body around it."""
        radius = r[wheel] * at
        if inner:
            rim = Circle(0j, radius * 1.08 + 2, style.VISIBLE)
            return rim, toothed(teeth, radius, inner), Line(radius + 0j, radius * 1.08 + 0j, red)
        return toothed(teeth, radius), Line(0.25 * radius + 0j, 0.8 * radius + 0j, red)

    items: list[MovingItem] = [
        MovingBody(marked("3", z.z3, inner3), centre, Track(np.array([still]))),
        MovingBody(marked("1", z.z1, inner1), centre, Track(wheel1 * θ)),
    ]
    arm: list[Item] = [style.joint(0j)]
    for number, ψ in enumerate(placed):
        assert ψ is not None, "it can be assembled"
        axis = r["H"] * at * cmath.rect(1, number * math.tau / case.given.k)
        place = Track(axis * np.exp(1j * θ))
        for wheel, teeth in [("2", z.z2), (OTHER, z.z2_prime)][: 1 if case.scheme.single else 2]:
            items.append(MovingBody(marked(wheel, teeth, False), place, Track(ψ + satellite * θ)))
        arm += [Line(0j, axis, Pen(0.6, style.RED)), style.joint(axis)]
    items.append(MovingBody(tuple(arm), centre, Track(θ)))
    low, high = extent(items)
    return Pane("train", case.title, tuple(items), low=low, high=high, scales=(BarScale(1 / at, "segment"),))


def _values(case: SolvedTrain) -> Iterator[MomentValue]:
    for id in case.ledger.families:
        if id in train_ids.omega:
            number = case.printed.number(id)
            displayed = case.ledger[id].at(1) / KINDS["angular velocity"].scale
            yield MomentValue(case.ledger.symbol(id), number.unit, Track(np.array([displayed])), number.decimals or 2)


# --- the drawing sheet ------------------------------------------------------------------------------------


def plates(case: SolvedTrain) -> list[DrawingPlate]:
    """Return the scheme and the triangles at standard scales."""
    captions = case.words["train"]["captions"]
    drawn = (("scheme", "scheme", scheme_views), ("triangles", "plans", velocity_triangles))

    def plate(name: str, layer: str, draw: Callable[[SolvedTrain, FigureSize], Scene], steps: int) -> DrawingPlate:
        return DrawingPlate(captions[f"figure-{name}"], (), layer, (lettered(draw(case, on_sheet(case, steps))),))

    return [enlargeable(partial(plate, *one)) for one in drawn]
