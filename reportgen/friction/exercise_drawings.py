"""Drawings of the inclined plane, the wedge and the screw: schemes with their forces, force plans to scale."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence

from reportgen.case.design_case import DesignCase
from reportgen.drawing import Arc, Arrow, Content, Item, Line, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import angle, names_of, pointing
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import polar, rectangle
from reportgen.drawing.labels import Request, label
from reportgen.drawing.vector_plan import Plan, PlanPoint, PlanVector, VectorStyle, plan
from reportgen.formula import Fraction, Number, Product, Symbol

DOWN = -1j
FORCE = 19.0
"""Length of a force on a scheme (mm), where only its line of action matters."""
BASE, HIGHEST = 72.0, 46.0
"""Length of a slope's base, and the largest height of a slope (mm)."""
ARC = 13.0
"""The radius of the arc of an angle (mm)."""


def force(
    at: complex, angle: float, *name: Content, reaction: bool = False, pushes: bool = False, length: float = FORCE
) -> Canvas:
    """Draw a force along an angle (rad) from a place (mm), or up to the place if it `pushes`, with its name at the free
    end.
    """
    along = length * polar(angle)
    start, tip = (at - along, at) if pushes else (at, at + along)
    arrow = Arrow(start, tip, style.REACTION if reaction else style.ACTIVE, style.HEAD)
    free, outward = (start, angle + math.pi) if pushes else (tip, angle)
    return Canvas((arrow,), (label(free, *name, prefer=(outward,), gap=0.8),), (pointing(names_of(name), along),))


def angle_mark(at: complex, start: float, stop: float, name: Content, radius: float = ARC) -> Canvas:
    """Draw the arc of an angle from `start` to `stop` (rad) about a place (mm), with its name outside."""
    middle = at + radius * polar((start + stop) / 2)
    arc = Arc(at, radius, start, stop, style.DIMENSION)
    return Canvas((arc,), (label(middle, name, prefer=((start + stop) / 2,), gap=0.8),), (angle(name, stop - start),))


def slope_base(α: float) -> float:
    """Return the drawn length of the base of a slope (mm)."""
    return min(BASE, HIGHEST / math.tan(α))


# --- the inclined plane -----------------------------------------------------------------------------


def incline_scheme(case: DesignCase) -> Scene:
    """Draw the body on its plane as it is raised: Q, P, the normal force and friction."""
    ledger = case.printed
    α = ledger["friction.incline.alpha"].at(1)
    β = ledger["friction.incline.beta"].at(1) if "friction.incline.beta" in ledger else 0.0
    base = slope_base(α)
    length, up = base / math.cos(α), polar(α)
    half, high = min(8.0, length / 6), min(9.0, length / 5)
    foot = 0.56 * length * up
    centre = foot + high / 2 * 1j * up
    items: list[Item] = [
        Line(0j, base + 8 + 0j, style.THIN),
        *style.ground(0j, length * up, -1),
        Polyline(rectangle(centre, 2 * half, high, α), style.VISIBLE, closed=True, fill=style.TINT),
    ]
    draft = Canvas(tuple(items))
    draft += angle_mark(0j, 0.0, α, Symbol("α"), min(ARC, base / 2))
    if β:
        draft += Canvas((Line(centre, centre + (FORCE - 3) * up, style.CONSTRUCTION),))
        start, stop = sorted((α, α + β))
        draft += angle_mark(centre, start, stop, Symbol("β"), FORCE - 6)
    draft += force(centre, -math.pi / 2, Symbol("Q"))
    draft += force(centre, α + β, Symbol("P"), length=FORCE + 3)
    draft += force(foot, α + math.pi / 2, Symbol("N"), reaction=True, length=FORCE + high / 2)
    draft += force(foot - half * up, α + math.pi, Symbol("F"), reaction=True, length=FORCE - 6)
    return finish(draft)


def incline_plans(case: DesignCase, size: FigureSize = IN_REPORT) -> tuple[Scene, ...]:
    """Draw the triangles of Q, P and the full reaction R of the plane: raised, then lowered."""
    ledger = case.printed
    α = ledger["friction.incline.alpha"].at(1)
    β = ledger["friction.incline.beta"].at(1) if "friction.incline.beta" in ledger else 0.0
    Q = ledger["friction.incline.Q"].at(1)
    scenes = []
    for end, mark in (("", ""), ("lowering.", "′")):
        P = ledger[f"friction.incline.{end}P"].at(1)
        sides: list[Side] = [
            ("Q", Q * DOWN, Symbol("Q"), "known"),
            (f"P{mark}", P * polar(α + β), Symbol("P", "", mark), "relative"),
        ]
        scenes.append(closed(case, "incline", sides, (f"R{mark}", Symbol("R", "", mark)), end, size))
    return tuple(scenes)


Side = tuple[str, complex, Symbol, VectorStyle]
"""A side of a force plan: its name, the force (N), its symbol, its pen."""


def closed(
    case: DesignCase, task: str, sides: Sequence[Side], closing: tuple[str, Symbol], end: str, size: FigureSize
) -> Scene:
    """Draw a force plan from the pole O: one side (N) after another, closed by the last one."""
    μ, per = scale_of(case, task, size)
    vectors, at = [], 0j
    for name, side, symbol, pen in sides:
        vectors.append(PlanVector(name, at, at + side * per, pen, symbol))
        at += side * per
    vectors.append(PlanVector(closing[0], at, 0j, "found", closing[1]))
    return drawn_plan(case, task, vectors, end, size.note(*μ))


def scale_of(case: DesignCase, task: str, size: FigureSize) -> tuple[tuple[Symbol, float, str], float]:
    """Return the scale of the forces of a task as printed in a note, and the number of mm of the figure for 1 N."""
    number = case.printed.number(f"friction.{task}.mu")
    symbol = case.printed.symbol(f"friction.{task}.mu")
    return (symbol, number.value, number.unit), size.per_unit(number.value)


def drawn_plan(case: DesignCase, task: str, vectors: Iterable[PlanVector[complex]], end: str, note: Content) -> Scene:
    """Return the scene of a plan, in units of paper (mm), titled as raising, or as lowering if `end` is given."""
    drawing = Plan(tuple(vectors), (PlanPoint(Symbol("O"), 0j),), scale=note)
    titles = case.words["friction"]["figures"][task]
    return plan(drawing, title=titles["lowering" if end else "raising"], margin=4.0)


# --- the wedge --------------------------------------------------------------------------------------


def wedge_scheme(case: DesignCase) -> Scene:
    """Draw the wedge under its load as it is driven: Q, P, the reactions at their angles of friction."""
    ledger = case.printed
    α, *φ = (
        ledger[f"friction.wedge.{name}"].at(1) if f"friction.wedge.{name}" in ledger else 0.0
        for name in ("alpha", "phi1", "phi2", "phi3")
    )
    base = slope_base(α)
    rise = base * math.tan(α)
    left, right = 0.34 * base, 0.72 * base
    top = rise + 16.0

    def on_slope(x: float) -> complex:
        return complex(x, rise - x * math.tan(α))

    load = (on_slope(left), on_slope(right), complex(right, top), complex(left, top))
    middle = (left + right) / 2
    items: list[Item] = [
        *style.ground(-10 + 0j, base + 12 + 0j, -1),
        Polyline((0j, base + 0j, 1j * rise), style.VISIBLE, closed=True, fill=style.TINT),
        Polyline(load, style.VISIBLE, closed=True, fill=style.PAPER),
        *style.ground(complex(left - style.PLAY, rise + 4), complex(left - style.PLAY, top + 4), 1),
        *style.ground(complex(right + style.PLAY, rise + 4), complex(right + style.PLAY, top + 4), -1),
    ]
    draft = Canvas(tuple(items))
    draft += angle_mark(base + 0j, math.pi - α, math.pi, Symbol("α"), min(ARC, base / 4))
    draft += force(complex(middle, top), -math.pi / 2, Symbol("Q"), pushes=True, length=FORCE - 5)
    draft += force(1j * rise / 2, 0.0, Symbol("P"), pushes=True)
    upright = math.pi / 2
    draft += force(on_slope(middle), upright - α - φ[0], Symbol("R", "1"), reaction=True, length=FORCE - 4)
    draft += force(complex(middle, 0), upright + φ[1], Symbol("R", "2"), reaction=True, pushes=True)
    wall = complex(right, (rise + 4 + top) / 2)
    draft += force(wall, math.pi + φ[2], Symbol("R", "3"), reaction=True, pushes=True)
    return finish(draft)


def wedge_plans(case: DesignCase, size: FigureSize = IN_REPORT) -> tuple[Scene, ...]:
    """Draw the triangles of the load (Q, R₃, R₁) and of the wedge (R₁, R₂, P) on their common side: driven, then
    released.
    """
    ledger = case.printed
    μ, per = scale_of(case, "wedge", size)
    Q, α = (ledger[f"friction.wedge.{name}"].at(1) for name in ("Q", "alpha"))
    scenes = []
    for end, mark, sign in (("", "", 1), ("lowering.", "′", -1)):
        P, R2, R3 = (ledger[f"friction.wedge.{end}{name}"].at(1) for name in ("P", "R2", "R3"))
        φ1, φ2, φ3 = (
            sign * ledger[f"friction.wedge.phi{place}"].at(1) if f"friction.wedge.phi{place}" in ledger else 0.0
            for place in "123"
        )
        # With α < φ₁ the load leans on the other side of its guide.
        side, of_guide = (1, φ3) if α + φ1 >= 0 else (-1, -φ3)
        a = Q * per * DOWN
        b = a + R3 * per * -side * polar(of_guide)
        c = b + R2 * per * 1j * polar(φ2)
        vectors = [
            PlanVector("Q", 0j, a, "known", Symbol("Q")),
            PlanVector(f"R3{mark}", a, b, "relative", Symbol("R", "3", mark)),
            PlanVector(f"R1{mark}", b, 0j, "found", Symbol("R", "1", mark)),
            PlanVector(f"R2{mark}", b, c, "relative", Symbol("R", "2", mark)),
            PlanVector(f"P{mark}", c, c + P * per, "found", Symbol("P", "", mark)),
        ]
        scenes.append(drawn_plan(case, "wedge", vectors, end, size.note(*μ)))
    return tuple(scenes)


# --- the screw --------------------------------------------------------------------------------------

UNROLLED, STEEP = 96.0, 60.0
"""Drawn length of one turn of the thread, and its largest height (mm)."""


def screw_scheme(case: DesignCase) -> Scene:
    """Draw the thread unrolled and to scale: its lead over the circumference, the load, the reaction at φ′."""
    ledger = case.printed
    γ, φ = (ledger[f"friction.screw.{name}"].at(1) for name in ("gamma", "phi"))
    around = min(UNROLLED, STEEP / math.tan(γ))
    rise, up = around * math.tan(γ), polar(γ)
    length = around / math.cos(γ)
    half, high = min(8.0, length / 6), 7.0
    foot = 0.5 * length * up
    centre = foot + high / 2 * 1j * up
    d, right = 1j * -9.0, complex(around, 0)
    items: list[Item] = [
        Polyline((0j, right, complex(around, rise)), style.VISIBLE, closed=True, fill=style.TINT),
        Polyline(rectangle(centre, 2 * half, high, γ), style.VISIBLE, closed=True, fill=style.PAPER),
        Line(d + 0j, d + right, style.DIMENSION),
        *(Line(x + 0j, x - 11j, style.DIMENSION) for x in (0.0, around)),
        *(Line(complex(around + 1, y), complex(around + 9, y), style.DIMENSION) for y in (0.0, rise)),
        Line(complex(around + 7, 0), complex(around + 7, rise), style.DIMENSION),
    ]
    requests: list[Request] = [
        label(d + around / 2, Symbol("π"), " ", Symbol("d", "2"), prefer=(-math.pi / 2,), gap=0.8),
        label(complex(around + 7, rise / 2), Symbol("l"), prefer=(0.0,), gap=0.8),
    ]
    draft = Canvas(tuple(items), tuple(requests))
    draft += angle_mark(0j, 0.0, γ, Symbol("γ"), around / 4)
    draft += force(centre + high / 2 * 1j * up, -math.pi / 2, Symbol("Q"), pushes=True, length=FORCE - 4)
    torque = Fraction(Product((Number(2.0), Symbol("M"))), Symbol("d", "2"))
    draft += force(centre - half * up, 0.0, torque, pushes=True)
    draft += Canvas((Line(foot, foot + (FORCE + 8) * 1j * up, style.CONSTRUCTION),))
    draft += force(foot, γ + φ + math.pi / 2, Symbol("R"), reaction=True, length=FORCE + 8)
    normal = cmath.phase(1j * up)
    draft += angle_mark(foot, normal, normal + φ, Symbol("φ", "", "′"), FORCE + 2)
    return finish(draft)
