"""The rule of 90°: a relative velocity turned with its guide's ω gives the direction of aᵏ = 2 ω × v_r."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from reportgen.figures.actions import Couple, Force, couples, forces
from reportgen.figures.draft import Draft, finish
from reportgen.figures.geometry import unit
from reportgen.figures.labels import label
from reportgen.figures.scene import Arc, Circle, Line, Scene
from reportgen.figures.style import CONSTRUCTION, DIMENSION_HEAD, OLD, PAPER, VISIBLE
from reportgen.notation.expressions import Symbol

BEYOND, BESIDE = 22.0, -34.0
"""Ends of the guide's line (mm from the point); the sense of ω is drawn at the second, clear of the vectors."""
QUARTER = 8.0


@dataclass(frozen=True, slots=True)
class Sliding:
    """A relative velocity along a guide that turns: labels, directions (any size), and the sense of ω (±1)."""

    point: Symbol
    velocity: tuple[Symbol, complex]
    coriolis: tuple[Symbol, complex]
    omega: tuple[Symbol, float]


def coriolis(sliding: Sliding) -> Scene:
    """The guide's line with both vectors at the sliding point, the quarter turn, and ω beside it."""
    along, sense = unit(sliding.velocity[1]), sliding.omega[1]
    start = cmath.phase(along)
    quarter = Arc(0j, QUARTER, start, start + sense * math.pi / 2, CONSTRUCTION, DIMENSION_HEAD)
    guide = Draft((Line(BESIDE * along, BEYOND * along, OLD), quarter))
    vectors = forces(
        (
            Force(sliding.velocity[0], 0j, sliding.velocity[1], "load", "v"),
            Force(sliding.coriolis[0], 0j, sliding.coriolis[1], "reaction", "a"),
        )
    )
    turning = couples((Couple(sliding.omega[0], BESIDE * along, sense),))
    ends = Draft(
        (Circle(0j, 0.7, VISIBLE, PAPER), Circle(BESIDE * along, 0.7, VISIBLE, PAPER)),
        (label(0j, sliding.point, gap=1.4),),
    )
    return finish(guide + ends + vectors + turning)
