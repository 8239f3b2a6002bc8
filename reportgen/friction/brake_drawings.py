"""Drawings of friction on a drum: a belt or a band with its tensions, the lever of a brake, a shoe."""

from __future__ import annotations

import math

from reportgen.case.design_case import DesignCase
from reportgen.drawing import Arc, Arrow, Circle, Item, Line, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish, settle
from reportgen.drawing.drawing_description import PaperLength, fact, turning
from reportgen.drawing.geometry import bounds, polar, rectangle
from reportgen.drawing.labels import Request, label
from reportgen.formula import Symbol
from reportgen.friction.exercise_drawings import FORCE, angle_mark, force

RADIUS = 17.0
"""Radius of a drum on a scheme (mm)."""
FREE = 13.0
"""Length of a band beyond the point where it leaves the drum (mm)."""
LEVER = 92.0
"""Largest length of a lever (mm)."""
APART = 9.0
TURN = math.tau


def drum(θ: float, sense: int, name: Symbol) -> Canvas:
    """Draw a drum with the band wrapped on it by θ (rad), S₁ on the right; an arrow inside turns with `sense`."""
    angle = math.fmod(θ, TURN) or TURN
    right, left = math.pi / 2 - angle / 2, math.pi / 2 + angle / 2
    items: list[Item] = [
        Circle(0j, RADIUS, style.VISIBLE, style.TINT),
        Arc(0j, RADIUS + 0.4, right, right + min(θ, TURN), style.HEAVY),
        style.joint(0j),
    ]
    inner = RADIUS * 0.55
    start, stop = (-0.6, 0.6) if sense > 0 else (0.6, -0.6)
    items.append(Arc(0j, inner, start, stop, style.VISIBLE, style.HEAD))
    draft = Canvas(tuple(items), (label(inner * polar(stop), name, prefer=(0.0,), gap=1.0),), (turning(name, sense),))
    draft += angle_mark(0j, right, left, Symbol("θ"), RADIUS * 0.35)
    for at, along, number in ((right, right - math.pi / 2, "1"), (left, left + math.pi / 2, "2")):
        leaves = (RADIUS + 0.4) * polar(at)
        end = leaves + FREE * polar(along)
        draft += Canvas((Line(leaves, end, style.HEAVY),))
        draft += force(end, along, Symbol("S", number), length=FORCE - 8)
    return draft


def belt_scheme(case: DesignCase) -> Scene:
    """Draw the belt on its drum, which it turns from S₂ towards S₁."""
    return finish(drum(case.printed["friction.belt.theta"].at(1), -1, Symbol("M")))


def band_scheme(case: DesignCase) -> Scene:
    """Draw the drum with its band and, below, the separated lever, with its arms to scale."""
    ledger = case.printed
    above = settle(drum(ledger["friction.band.theta"].at(1), 1, Symbol("ω")))
    l, a, b = (ledger[f"friction.band.{name}"].at(1) for name in "lab")  # noqa: E741
    per = LEVER / (max(l, a, b) - min(0.0, a, b))
    low, high = min(0.0, a, b) * per, max(l, a, b) * per
    items: list[Item] = [Line(complex(low, 0), complex(high, 0), style.HEAVY), *style.pivot(0j)]
    draft = Canvas(tuple(items))
    for arm, number in ((a, "1"), (b, "2")):
        draft += force(complex(arm * per, 0), math.pi / 2, Symbol("S", number), length=FORCE - 6)
    draft += force(complex(l * per, 0), -math.pi / 2, Symbol("P"), length=FORCE - 6)
    for row, (arm, name) in enumerate(((a, "a"), (b, "b"), (l, "l"))):
        if arm:
            draft += across(complex(0, -11.5 - 6.5 * row), arm * per, Symbol(name))
    below = settle(draft)
    (_, top), (under, _) = bounds(below.items), bounds(above.items)
    return finish(above.moved(complex((low + high) / 2, top.imag + APART - under.imag)) + below)


def across(start: complex, length: float, name: Symbol) -> Canvas:
    """Draw a dimension of a length (mm) from a place (mm) to the right, or to the left if the length is negative."""
    end = start + length
    arrows = tuple(
        Arrow((start + end) / 2, to, style.DIMENSION, min(style.DIMENSION_HEAD, abs(length) / 3)) for to in (start, end)
    )
    marks = tuple(Line(at - 1.2j, at + 1.2j, style.DIMENSION) for at in (start, end))
    named = label((start + end) / 2, name, prefer=(math.pi / 2,), gap=0.6)
    return Canvas((*arrows, *marks), (named,), (fact("dimension", name, PaperLength(abs(length))),))


def shoe_scheme(case: DesignCase) -> Scene:
    """Draw the drum under its shoe and the lever to scale, in the sense of rotation in which friction presses
    the shoe.
    """
    ledger = case.printed
    l, a, d = (ledger[f"friction.shoe.{name}"].at(1) for name in "lad")  # noqa: E741
    c = ledger["friction.shoe.c"].at(1) if "friction.shoe.c" in ledger else 0.0
    per = LEVER / max(l, a + d / 2)
    R, pivot = d / 2 * per, complex(-a * per, d / 2 * per + c * per)
    block = max(4.0, min(R / 2, 10.0))
    bar = max(pivot.imag, R + 5.0)
    end = pivot.real + l * per
    items: list[Item] = [
        Circle(-0j, R, style.VISIBLE, style.TINT),
        Polyline(rectangle(complex(0, R + (bar - R) / 2), 2 * block, bar - R), style.VISIBLE, closed=True),
        Line(complex(pivot.real, bar), complex(end, bar), style.HEAVY),
        Line(complex(pivot.real, bar), pivot, style.HEAVY),
        *style.pivot(pivot),
        style.joint(0j),
        Arc(0j, R * 0.5, -0.6, 0.6, style.VISIBLE, style.HEAD),
    ]
    requests: list[Request] = [label(R * 0.5 * polar(0.6), Symbol("ω"), prefer=(0.0,), gap=1.0)]
    draft = Canvas(tuple(items), tuple(requests), (turning(Symbol("ω"), 1.0),))
    draft += force(complex(end, bar), -math.pi / 2, Symbol("P"), length=FORCE - 6)
    draft += force(1j * R, math.pi / 2, Symbol("N"), reaction=True, length=bar - R + FORCE - 6)
    draft += force(1j * R - block, math.pi, Symbol("F"), reaction=True, length=FORCE - 6)
    draft += across(complex(pivot.real, bar + FORCE), a * per, Symbol("a"))
    draft += across(complex(pivot.real, bar + FORCE + 7), l * per, Symbol("l"))
    if c * per > 2:
        at = pivot.real - 9
        items = [Line(complex(at - 2, y), complex(at + 2, y), style.DIMENSION) for y in (R, pivot.imag)]
        items.append(Line(complex(at, R), complex(at, pivot.imag), style.DIMENSION))
        items.append(Line(complex(at - 2, R), complex(-block, R), style.CONSTRUCTION))
        middle = complex(at, (R + pivot.imag) / 2)
        height = fact("dimension", Symbol("c"), PaperLength(c * per))
        draft += Canvas(tuple(items), (label(middle, Symbol("c"), prefer=(math.pi,), gap=0.8),), (height,))
    return finish(draft)
