"""Drawings of a cam true to scale: the S–S′ diagram with the region of centres, and the profile by inversion."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from reportgen.base.stable_digits import first_greatest, first_least
from reportgen.base.units import MM
from reportgen.cam import cam_ids
from reportgen.cam.profile import Cam, CamProfile
from reportgen.cam.solution import SolvedCam
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Item, Line, Pen, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import Fact, PaperLength, arrow, direction, fact, turning
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import HalfPlane, clipped, region, unit
from reportgen.drawing.labels import Request, label
from reportgen.formula import Number, Symbol

DIAGRAM_ROOM = 118 + 128j
"""Largest width and height of the S–S′ diagram on a page (mm)."""
PROFILE_ROOM = 150 + 172j
FOLLOWER = 26.0
"""The drawn length of a translating follower (mm)."""
LIMIT = Pen(0.3, style.RED, style.DASHED)
THIN_LIMIT = Pen(0.12, style.RED, style.DASHED)
REGION = Pen(0.1, style.GRAY)
PROFILE = Pen(0.5)
PITCH = Pen(0.25, style.BLUE, style.CHAIN)
ROLLER = Pen(0.13, style.GRAY)
RAY = Pen(0.1, style.GRAY)
NUMBER = 3.2
"""Distance from a roller's centre to its number (mm)."""
HALF_FACE = 8.0
CLEAR = 0.6
"""Part of the base circle that normals of faces leave free, for the signs at the cam's centre."""
FACE_MARGIN = 3.0
"""Length of a flat face beyond its farthest points of contact (mm)."""
GUIDE = 1.6
"""Distance from the axis of a translating follower to the walls of its guide (mm)."""
LINES = 7
"""Number of limit lines of an oscillating follower for each piece of a phase."""
Stage = Literal["displacements", "profile by inversion", "cam"]
SCALE = Symbol("μ", "l")


def fitting(points: Sequence[complex], room: complex, size: FigureSize = IN_REPORT) -> tuple[float, float]:
    """Return the report's scale (mm/mm) at which points (m) fit a room (mm), and the figure's mm per metre."""
    usual, at = size.fitting([point * MM for point in points], room)
    return usual, at * MM


# --- the S–S′ diagram -------------------------------------------------------------------------------


def limit_diagram(case: SolvedCam, size: FigureSize = IN_REPORT) -> Scene:
    """Return the region of the cam's centres that keeps both limits of the pressure angle."""
    cam = case.solution.cam
    return (_of_translating if cam.translating else _of_oscillating)(case, size)


def _of_translating(case: SolvedCam, size: FigureSize) -> Scene:
    """Return s upwards over s′, both at one scale; the cam's centre is e to the right and s₀ below."""
    design, cam = case.solution.designed, case.solution.cam
    profile = cam.sampled()
    curve = profile.ds + 1j * profile.s
    centre = complex(cam.e, -cam.s0)
    places = [*curve, centre, 0j, complex(0, -1.25 * cam.s0)]
    least = design.least
    if least is not None:
        places += [complex(least.e, -least.s0)] + ([least.apex.conjugate()] if least.apex is not None else [])
    usual, at = fitting(places, DIAGRAM_ROOM, size)
    low = min(place.imag for place in places) * at - 10
    high = float(profile.s.max()) * at
    left, right = float(min(p.real for p in places)) * at - 14, float(max(p.real for p in places)) * at + 14
    box = (complex(left, low), complex(right, low), complex(right, high), complex(left, high))
    items: list[Item] = []
    requests: list[Request] = []
    lines: list[tuple[str, float, int, HalfPlane]] = []
    limits = (
        ("rise", design.limits.rise, 1, None if least is None else least.rise),
        ("return", design.limits.back, -1, None if least is None else least.back),
    )
    for phase, limit, side, touch in limits:
        if limit is None or touch is None:
            continue
        # Downwards s decreases and s′ has the opposite sign: the angle to the axis of s is the limit.
        down = complex(-side * math.sin(limit), -math.cos(limit))
        lines.append((phase, limit, side, HalfPlane(complex(touch.ds, touch.s) * at, 1j * side * down)))
    allowed = region([plane for *_, plane in lines], box)
    if len(allowed) > 2 and lines:
        items.append(Hatch(tuple(allowed), 2.0, REGION))
    for phase, limit, side, plane in lines:
        # The edge of the half-plane, from the upper edge of the drawing to the lower one.
        along = plane.inward * -1j * side
        ends = [plane.at + along * (level - plane.at.imag) / along.imag for level in (low, high)]
        start, end = (_within(end, plane.at, left, right) for end in ends)
        items.append(Line(start, end, LIMIT))
        items += style_point(plane.at)
        number = "1" if side > 0 else "2"
        requests.append(label(plane.at, Symbol("T", number), gap=1.2, prefer=(0.0 if side > 0 else math.pi,)))
        items.append(Line(plane.at, plane.at - 22j, style.CONSTRUCTION))
        turn = -math.pi / 2
        items.append(Arc(plane.at, 18.0, turn, turn - side * limit, style.DIMENSION))
        requests.append(
            label(
                plane.at + 20 * np.exp(1j * (turn - side * limit / 2)),
                case.ledger.symbol(cam_ids.limit(phase)),
                gap=0.4,
                prefer=(turn - side * limit / 2,),
            )
        )
    items.append(Arrow(complex(left, 0), complex(right, 0), style.DIMENSION, 1.8))
    items.append(Arrow(complex(0, low), complex(0, high + 6), style.DIMENSION, 1.8))
    requests += [
        label(complex(right, 0), Symbol("s′"), gap=0.8, prefer=(math.pi / 2,)),
        label(complex(0, high + 6), Symbol("s"), gap=0.8, prefer=(0.0,)),
        label(0j, Symbol("B", "0"), gap=1.0, prefer=(-2.4, -0.7)),
    ]
    items.append(Polyline(tuple(curve * at), Pen(0.4, style.BLUE), closed=True))
    for k in range(case.count):
        place = complex(case.solution.profile.ds[k], case.solution.profile.s[k]) * at
        if case.solution.intervals[k].piece is not None and abs(place) > 1:
            items.append(Circle(place, 0.5, Pen(0.2), style.PAPER))
            requests.append(label(place, str(k + 1), gap=0.8, size=style.SMALL))
    if least is not None and least.apex is not None:
        apex = least.apex.conjugate() * at
        items += style_point(apex)
        requests.append(label(apex, Symbol("A"), gap=1.0))
    if least is not None and case.solution.given.finds:
        lowest = complex(least.e, -least.s0) * at
        if least.apex is None or abs(lowest - least.apex.conjugate() * at) > 1:
            items += style_point(lowest)
            requests.append(label(lowest, Symbol("O", "min"), gap=1.0))
    items += _centre(centre * at)
    items.append(Line(0j, centre * at, style.VISIBLE))
    requests.append(label(centre * at, Symbol("O"), gap=1.6))
    requests.append(label([centre * at * share for share in (0.5, 0.4, 0.6, 0.7)], case.ledger.symbol("cam.r0")))
    facts = [fact("limit-diagram", Symbol("s"), Symbol("s′")), arrow(case.ledger.symbol("cam.r0"), centre * at)]
    facts += (
        fact("limit", Symbol("T", "1" if side > 0 else "2"), direction(cmath.rect(1, limit)))
        for phase, limit, side, _ in lines
    )
    if len(allowed) > 2 and lines:
        facts.append(fact("region"))
    draft = Canvas(tuple(items), tuple(requests), tuple(facts))
    return finish(draft, notes=(size.note(SCALE, usual),), margin=2.0)


def _within(end: complex, start: complex, left: float, right: float) -> complex:
    """Return the end of a line from a start, cut at two vertical lines."""
    for edge in (left, right):
        if (end.real - edge) * (start.real - edge) < 0:
            end = start + (end - start) * (edge - start.real) / (end.real - start.real)
    return end


def style_point(at: complex) -> tuple[Item, ...]:
    """Return a point of the construction at a place (mm)."""
    return (Circle(at, 0.6, None, style.BLACK),)


def _centre(at: complex) -> tuple[Item, ...]:
    """Return the cam's shaft at a place (mm)."""
    return Circle(at, 1.4, style.VISIBLE, style.PAPER), Circle(at, 0.4, None, style.BLACK)


def _of_oscillating(case: SolvedCam, size: FigureSize) -> Scene:
    """Return the limit lines: l k is laid off along each position of the arm; a line through its end at 90° − [α]
    bounds.
    """
    design, cam = case.solution.designed, case.solution.cam
    σ, pivot = cam.opposite, pivot_of(cam)
    planes: list[HalfPlane] = []
    drawn_limits: list[tuple[complex, complex, HalfPlane, str]] = []
    for phase, limit, sign, prime in (("rise", design.limits.rise, 1, ""), ("return", design.limits.back, -1, "′")):
        if limit is None:
            continue
        drawn = 0
        for number, interval in enumerate(cam.motion.intervals):
            if interval.phase != phase:
                continue
            φ = np.linspace(interval.start, interval.stop, 161)
            s, ds, _ = cam.motion(φ, np.full(φ.shape, number))
            for index, (ψ, rate) in enumerate(zip(s, ds, strict=True)):
                arm = _arm(cam, float(ψ))
                end = pivot + arm * cam.arm * (1 + σ * rate)
                # Into the region: to the cam's side, and along the arm in a rise against the cam or a return with it,
                # otherwise back along it.
                aside = arm * 1j * σ * cam.turn
                plane = HalfPlane(end, sign * σ * arm * math.cos(limit) + aside * math.sin(limit))
                planes.append(plane)
                # A piece of a phase begins where the previous one ends.
                if index % (160 // (LINES - 1)) == 0 and (index or not drawn):
                    drawn += 1
                    drawn_limits.append((pivot + arm * cam.arm, end, plane, f"{drawn}{prime}"))
    places = [pivot, 0j, *(one[0] for one in drawn_limits), *(one[1] for one in drawn_limits), 0.6 * -1j * cam.r0]
    usual, at = fitting(places, DIAGRAM_ROOM, size)
    array = np.array(places) * at
    left, right, low, high = array.real.min() - 12, array.real.max() + 12, array.imag.min() - 22, array.imag.max() + 8
    box = [complex(left, low), complex(right, low), complex(right, high), complex(left, high)]
    on_paper = [HalfPlane(plane.at * at, plane.inward) for plane in planes]
    items: list[Item] = []
    requests: list[Request] = []
    allowed = region(on_paper, box)
    if len(allowed) > 2:
        items.append(Hatch(tuple(allowed), 2.0, REGION))
        items.append(Polyline(tuple(allowed), REGION, closed=True))
    for tip, end, plane, prime in drawn_limits:
        items.append(Line(pivot * at, tip * at, RAY))
        along = 1j * unit(plane.inward) * abs(box[2] - box[0])
        if piece := clipped(end * at - along, end * at + along, box[0], box[2]):
            items.append(Line(*piece, THIN_LIMIT))
        items += [Circle(tip * at, 0.5, Pen(0.2), style.PAPER), Circle(end * at, 0.4, None, style.RED)]
        requests.append(label(end * at, prime, gap=0.6, size=style.SMALL))
    start = pivot + _arm(cam, 0.0) * cam.arm
    items.append(Line(pivot * at, start * at, style.VISIBLE))
    items += [
        *style.pivot(pivot * at),
        *_centre(0j),
        Line(0j, start * at, style.THIN),
        Line(0j, pivot * at, style.AXIS),
    ]
    requests += [
        label(0j, Symbol("O"), gap=1.8, prefer=(-2.4, -0.7)),
        label(pivot * at, Symbol("A"), gap=2.0, prefer=(0.5,)),
        label(start * at, Symbol("B", "0"), gap=1.0),
        label(start * at / 2, case.ledger.symbol("cam.r0")),
        label(pivot * at / 2, case.ledger.symbol("cam.a"), prefer=(-math.pi / 2,)),
    ]
    facts = [
        fact("limit-lines", Number(len(drawn_limits)), Symbol("A"), PaperLength(cam.arm * at)),
        arrow(case.ledger.symbol("cam.a"), pivot * at),
        arrow(case.ledger.symbol("cam.r0"), start * at),
    ]
    if len(allowed) > 2:
        facts.append(fact("region"))
    draft = Canvas(tuple(items), tuple(requests), tuple(facts))
    return finish(draft, notes=(size.note(SCALE, usual),), margin=2.0)


def _arm(cam: Cam, ψ: float) -> complex:
    """Return the unit direction of the arm from its pivot in the fixed frame, at the swing ψ (rad)."""
    q = cam.psi0 + ψ
    return complex(-cam.opposite * cam.turn * math.cos(q), math.sin(q))


# --- the profile by inversion -------------------------------------------------------------------------


def inversion(case: SolvedCam, stage: Stage = "profile by inversion", size: FigureSize = IN_REPORT) -> Scene:
    """Draw the profile in the cam's frame: the follower carried against the rotation, with numbered positions.

    The stage `displacements` lays off the displacements only, `profile by inversion` adds the profile; `cam` is the cam
    with its follower in the first position.
    """
    cam = case.solution.cam
    outline = cam.outline()
    ring = np.exp(1j * np.linspace(0, 2 * math.pi, 24))
    places = [*outline, *((float(np.abs(outline).max()) + cam.roller) * ring)]
    if not cam.translating:
        places += [pivot_of(cam)] if stage == "cam" else list(cam.a * ring)
    usual, at = fitting(places, PROFILE_ROOM - 6 * (1 + 1j), size)
    items: list[Item] = []
    requests: list[Request] = []
    if stage == "cam":
        items.append(Polyline(tuple(outline * at), PROFILE, closed=True, fill=style.TINT))
    items += [Circle(0j, radius * at, style.THIN) for radius in (cam.r0, abs(cam.e)) if radius]
    if stage == "cam":
        items += follower_parts(cam, complex(cam.profile_at(np.zeros(1)).at[0]) * at, at, pivot_of(cam) * at)
    else:
        items += _positions(case, stage, at, requests)
    if stage != "displacements":
        if cam.roller and case.solution.given.closed_by == "form":
            items.append(Polyline(tuple(cam.outline(side=1) * at), style.VISIBLE, closed=True))
        if cam.roller:
            items.append(Polyline(tuple(cam.sampled().pitch * at), PITCH, closed=True))
        if stage != "cam":
            items.append(Polyline(tuple(outline * at), PROFILE, closed=True))
    items += _centre(0j)
    requests.append(label(0j, Symbol("O"), gap=1.9, prefer=(-2.4, -0.7)))
    radius = max(0.45 * cam.r0 * at, 5.0)
    begin = math.pi / 2 + 0.5
    items.append(Arc(0j, radius, begin, begin + cam.turn * 0.9, Pen(0.25), style.HEAD))
    requests.append(label(radius * np.exp(1j * (begin + cam.turn * 0.45)), Symbol("ω"), gap=0.8))
    facts = tuple(_profile_facts(case, stage, outline * at, cam.r0 * at))
    draft = Canvas(tuple(items), tuple(requests), facts)
    return finish(draft, notes=(size.note(SCALE, usual),), margin=2.0)


def _profile_facts(case: SolvedCam, stage: Stage, outline: np.ndarray, base: float) -> Iterator[Fact]:
    """Yield the facts of the inversion: base circle, positions, the profile's distances (mm) from the centre."""
    cam, distances = case.solution.cam, np.abs(outline)
    yield turning(Symbol("ω"), cam.turn)
    yield fact("radius", case.ledger.symbol("cam.r0"), PaperLength(base))
    if stage != "cam":
        yield fact("follower-positions", Number(case.count))
    if stage != "displacements":
        for phrase, at in (("farthest", first_greatest(distances)), ("nearest", first_least(distances))):
            yield fact(phrase, PaperLength(float(distances[at])), direction(complex(outline[at])))
    elif cam.translating:
        yield fact("laid-off", Symbol("s"))
    else:
        yield fact("laid-off", Symbol("ψ"))


def _positions(case: SolvedCam, stage: Stage, at: float, requests: list[Request]) -> Iterator[Item]:
    """Yield the follower at all positions, with their numbers."""
    cam, profile = case.solution.cam, case.solution.profile
    for k in range(profile.φ.size):
        centre = complex(profile.pitch[k]) * at
        out = complex(profile.normal[k]) if cam.flat else centre
        if stage == "displacements":
            yield from _laid_off(cam, profile, k, at)
            place = centre
        else:
            yield from _position(cam, profile, k, at)
            place = centre + unit(out) * (cam.roller * at)
        prefer = (float(np.angle(out)),)
        requests.append(label(place, str(k + 1), size=style.SMALL, gap=0.9, prefer=prefer))


def _laid_off(cam: Cam, profile: CamProfile, k: int, at: float) -> Iterator[Item]:
    """Yield the displacement at a position, from the base circle along the follower's axis or about its pivot."""
    back = complex(np.exp(-1j * cam.turn * profile.φ[k]))
    first = cam.profile_at(np.zeros(1))
    start, end = complex(first.at[0]) * back * at, complex(profile.at[k]) * back * at
    if cam.flat and cam.translating:
        start, end = 1j * back * cam.r0 * at, 1j * back * (cam.r0 + profile.s[k]) * at
    if cam.translating:
        foot = CLEAR * start if cam.flat else complex(cam.turn * cam.e) * back * at
        yield Line(foot, start, RAY)
        yield Line(start, end, style.NEW)
    else:
        pivot = pivot_of(cam) * back * at
        yield Line(pivot, start, RAY)
        yield Line(pivot, end, style.VISIBLE)
        yield Circle(pivot, 0.7, Pen(0.15), style.PAPER)
        if not cam.flat:
            begin = cmath.phase(start - pivot)
            swing = math.remainder(cmath.phase(end - pivot) - begin, 2 * math.pi)
            yield Arc(pivot, cam.arm * at, begin, begin + swing, style.NEW)
    yield from style_point(end)


def pivot_of(cam: Cam) -> complex:
    """Return the pivot of an oscillating follower in the fixed frame (m)."""
    return complex(cam.mirrored(np.array([complex(cam.opposite * cam.a, 0)]))[0])


def _position(cam: Cam, profile: CamProfile, k: int, at: float) -> Iterator[Item]:
    """Yield one position of the follower in the cam's frame: its axis or arm, and its roller, edge or face."""
    back = complex(np.exp(-1j * cam.turn * profile.φ[k]))
    centre = complex(profile.pitch[k]) * at
    if cam.translating and not cam.flat:
        along = 1j * back
        foot = complex(cam.turn * cam.e) * back * at
        yield Line(foot, centre + along * 6.0, RAY)
    elif not cam.translating:
        pivot = pivot_of(cam) * back * at
        yield Line(pivot, centre, RAY)
        yield Circle(pivot, 0.7, Pen(0.15), style.PAPER)
    if cam.flat:
        out = complex(profile.normal[k])
        yield Line(CLEAR * cam.r0 * at * out, out * abs((centre * out.conjugate()).real), RAY)
        yield Line(centre - 1j * out * HALF_FACE, centre + 1j * out * HALF_FACE, style.VISIBLE)
        yield from style_point(centre)
    elif cam.roller:
        yield Circle(centre, cam.roller * at, ROLLER)
        yield Circle(centre, 0.45, None, style.BLACK)
    else:
        yield Circle(centre, 0.6, Pen(0.2), style.PAPER)


def follower_parts(cam: Cam, tip: complex, at: float, pivot: complex, walls: bool = True) -> Iterator[Item]:
    """Yield the follower, with its tip (centre of the roller, edge, point of contact) at a place of the paper (mm).

    With `walls`, its guide or support is drawn, too; `at` is the scale (mm per m).
    """
    if cam.translating:
        rise = 1j * cam.motion.stroke * at
        foot = complex(0.0, tip.imag) if cam.flat else tip
        if cam.flat:
            half = float(np.abs(cam.sampled().ds).max()) * at + FACE_MARGIN
            yield Line(foot - half, foot + half, style.HEAVY)
        yield Line(foot, foot + rise + 1j * FOLLOWER, style.HEAVY)
        if walls:
            yield from guide_walls(foot + rise)
    else:
        yield Line(pivot, tip + (unit(tip - pivot) * 8 if cam.flat else 0), style.HEAVY)
        if walls:
            yield from style.pivot(pivot)
    if cam.roller:
        yield Circle(tip, cam.roller * at, style.VISIBLE, style.PAPER)
        yield style.joint(tip)
    elif not cam.flat and cam.translating:
        yield Polyline((tip, tip + 2.5 + 5j, tip - 2.5 + 5j), style.VISIBLE, closed=True, fill=style.PAPER)


def guide_walls(tip: complex) -> Iterator[Item]:
    """Yield the guide (mm) of a translating follower whose end is in its highest position."""
    for side in (-1, 1):
        wall = tip + complex(side * GUIDE, 0.6 * FOLLOWER)
        yield from style.ground(wall - 4j, wall + 4j, 1 if side < 0 else -1)
