"""Scales of drawings: true on paper and rounded to values one measures with.

With a rotating driver the plans take the scales μ_v = |ω1| μ_l and μ_a = ω1² μ_l, so that the images of the
crank pin lie as far from the pole as the crank is drawn long; otherwise scales are of the series
1, 2, 2.5, 4, 5 times a power of ten.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reportgen.notation.numbers import SERIES
from reportgen.notation.numbers import nice_up as nice

__all__ = [
    "INVISIBLE",
    "SERIES",
    "PlanScales",
    "choose_force_scale",
    "choose_scale",
    "crank_scales",
    "enlargement",
    "extent",
    "length_scale",
    "nice",
    "nice_below",
]

CRANK_DRAWN = 50.0
"""Drawn length of the crank in mm unless the assignment says otherwise."""
TINY = 3.0
"""Vectors drawn shorter than this (mm) get an enlarged inset."""
INVISIBLE = 0.001
"""What is drawn shorter than this (mm) is a point on any paper and gets no inset."""
NOTHING = 1e-9
"""A vector below this share of its figure's size is nothing and is not drawn."""


def nice_below(value: float, series: Sequence[float] = SERIES) -> float:
    """The largest s·10ⁿ, s of the series, that is not above `value`: ratios of enlargement."""
    above = nice(value, series)
    if above <= value * (1 + 1e-12):
        return above
    members = sorted(series)
    exponent = math.floor(math.log10(value))
    below = [float(f"{m}e{p}") for p in (exponent - 1, exponent) for m in members]
    return max(member for member in below if member <= value)


@dataclass(frozen=True, slots=True)
class PlanScales:
    """μ_l in m/mm, μ_v in m/s per mm, μ_a in m/s² per mm."""

    length: float
    velocity: float
    acceleration: float


def length_scale(real: float, drawn: float = CRANK_DRAWN) -> float:
    """μ_l = real / drawn: real in m, drawn in mm, result in m/mm."""
    return real / drawn


def crank_scales(radius: float, omega: float, drawn: float = CRANK_DRAWN) -> PlanScales:
    """The scales of a rotating driver: μ_l = R/drawn, μ_v = |ω1| μ_l, μ_a = ω1² μ_l."""
    mu = length_scale(radius, drawn)
    return PlanScales(mu, abs(omega) * mu, omega**2 * mu)


def extent(points: ArrayLike) -> tuple[float, float]:
    """Width and height of the box around complex points; nan is passed over."""
    p = np.asarray(points, dtype=np.complex128).ravel()
    p = p[np.isfinite(p)]
    return (float(np.ptp(p.real)), float(np.ptp(p.imag))) if p.size else (0.0, 0.0)


def choose_scale(drawings: Iterable[ArrayLike], box: tuple[float, float]) -> float:
    """The smallest scale of the series that fits every drawing into `box` mm.

    Drawings are arrays of complex points in real units; the result is real units per mm.
    Raises `ValueError` when nothing has any extent.
    """
    return nice(max(max(width / box[0], height / box[1]) for width, height in map(extent, drawings)))


def choose_force_scale(polygons: Iterable[ArrayLike], box: tuple[float, float] = (160.0, 200.0)) -> float:
    """μ_R in N/mm: one value for all polygons of a group; each is an array of vertices in N."""
    return choose_scale(polygons, box)


def enlargement(longest: float, target: float = 20.0) -> float:
    """The printed ratio of an inset that draws a vector of `longest` mm at most `target` mm long."""
    return nice_below(target / longest)
