"""Kinematics of the five Assur groups of class II, and the vectors of the plane they are written in.

Each kind has one function: it finds the position in closed form, then the two unknown rates along two
known directions with `solve2`, first for velocities, then for accelerations.  Nothing loops over
positions; what cannot be assembled is nan.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reportgen.mechanism.structure import Dyad, DyadKind
from reportgen.notation.constructions import SquareRoot, along_line, circle_circle, cross, shares

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Flags = NDArray[np.bool_]

SINGULAR = 1e-5
"""Sine of the angle below which two directions count as parallel.

A position found near such a place carries a relative error of about ε/sin² (ε = 2e-16): past this
bound its rates would be wrong in the sixth digit, so none are given.
"""

TOUCHING = 1e-13
"""A square root of minus this, relative, is a flat position met exactly, not an unreachable one."""

COINCIDENT = 1e-9
"""Points nearer than this, relative to their distance from the origin, give no direction."""

RODS: Mapping[DyadKind, int] = {"RRR": 2, "RRP": 1, "RPR": 0, "PRP": 0, "RPP": 0}
"""How many of a kind's `lengths` are lengths of rods."""


# --- vectors of the plane, as complex numbers of any shape ---------------------------------------


def unit(angle: Floats | float) -> Complexes:
    """Unit vector e^{iθ} at `angle` (rad)."""
    return np.asarray(np.exp(1j * np.asarray(angle, dtype=np.float64)), dtype=np.complex128)


def solve2(u: Complexes | complex, w: Complexes | complex, rhs: Complexes | complex) -> tuple[Floats, Floats]:
    """The real x, y with x·u + y·w = rhs; nan where u and w are parallel to within `SINGULAR`."""
    regular = np.abs(cross(u, w)) > SINGULAR * np.abs(u) * np.abs(w)
    return shares(rhs, np.where(regular, u, np.nan), w)


# --- groups ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class LinkMotion:
    """Angle (rad), angular velocity (rad/s) and acceleration (rad/s²) of a link, each [N]."""

    angle: Floats
    omega: Floats
    epsilon: Floats


@dataclass(frozen=True, slots=True)
class PointMotion:
    """Position (m), velocity (m/s) and acceleration (m/s²) of a point, complex [N]."""

    p: Complexes
    v: Complexes
    a: Complexes


@dataclass(frozen=True, slots=True)
class SlideMotion:
    """Relative motion in a prismatic joint: s (m) along the unit vector `direction`, ṡ and s̈."""

    s: Floats
    v: Floats
    a: Floats
    direction: Complexes


@dataclass(frozen=True, slots=True)
class Rail:
    """A guide as it moves: its point `at`, its direction, and the link that carries it."""

    link: int
    at: PointMotion
    direction: Complexes
    carrier: LinkMotion

    def carried(self, p: Complexes) -> PointMotion:
        """The point of the guide's own link that lies at `p`: v = v_G + iω r, a = a_G + (iε − ω²) r."""
        return carried(self.at, self.carrier, p)


@dataclass(frozen=True, slots=True)
class Assembled:
    """A group in motion: its middle point, its two links with their frames' origins, its slides."""

    middle: PointMotion
    links: tuple[LinkMotion, LinkMotion]
    origins: tuple[PointMotion, PointMotion]
    slides: Mapping[tuple[int, int], SlideMotion]


End = PointMotion | Rail


def carried(base: PointMotion, link: LinkMotion, p: Complexes) -> PointMotion:
    """The point at `p` of a rigid link that moves with `base` and turns as `link` does."""
    r = p - base.p
    return PointMotion(p, base.v + 1j * link.omega * r, base.a + (1j * link.epsilon - link.omega**2) * r)


def assemble(dyad: Dyad, start: End, end: End, sign: Floats) -> Assembled:
    """The group on its two ends; `sign` [N] is its orientation.

    Raises `TypeError` when an end is a guide where the kind has a revolute joint, or the reverse, and
    `ValueError` for a rod without length.
    """
    if min(dyad.lengths[: RODS[dyad.kind]], default=1.0) <= 0:
        raise ValueError(f"dyad {dyad.links}: a rod must have a length")
    match dyad.kind, start, end:
        case "RRR", PointMotion(), PointMotion():
            return _rrr(dyad, start, end, sign)
        case "RRP", PointMotion(), Rail():
            return _rrp(dyad, start, end, sign)
        case "RPR", PointMotion(), PointMotion():
            return _rpr(dyad, start, end, sign)
        case "PRP", Rail(), Rail():
            return _prp(dyad, start, end)
        case "RPP", PointMotion(), Rail():
            return _rpp(dyad, start, end)
    raise TypeError(f"dyad {dyad.links}: the ends do not fit the kind {dyad.kind}")


def _root(scale: Floats | float) -> SquareRoot:
    """The square root that is nan where the square is negative by more than rounding of `scale`²."""

    def root(square: Floats) -> Floats:
        touching = (square < 0) & (square >= -TOUCHING * np.square(scale))
        return np.sqrt(np.where(touching, 0.0, np.where(square < 0, np.nan, square)))

    return root


def _rrr(dyad: Dyad, p: PointMotion, t: PointMotion, sign: Floats) -> Assembled:
    """v_P + iω_i PQ = v_T + iω_j TQ."""
    first, second = dyad.lengths
    with np.errstate(divide="ignore", invalid="ignore"):
        q = circle_circle(p.p, first, t.p, second, sign, _root(first))
    r, s = q - p.p, q - t.p
    omega_i, omega_j = solve2(1j * r, -1j * s, t.v - p.v)
    epsilon_i, epsilon_j = solve2(1j * r, -1j * s, t.a - p.a + omega_i**2 * r - omega_j**2 * s)
    i = LinkMotion(np.angle(r), omega_i, epsilon_i)
    j = LinkMotion(np.angle(s), omega_j, epsilon_j)
    return Assembled(carried(p, i, q), (i, j), (p, t), {})


def _rrp(dyad: Dyad, p: PointMotion, rail: Rail, sign: Floats) -> Assembled:
    """v_P + iω_i PQ = v_Qk + ṡ d, with 2iω_k ṡ d (Coriolis) on a turning guide."""
    length = dyad.lengths[0]
    d = rail.direction
    s = along_line(p.p, length, rail.at.p, d, sign, _root(length))
    q = rail.at.p + s * d
    r = q - p.p
    under = rail.carried(q)
    omega, rate = solve2(1j * r, -d, under.v - p.v)
    coriolis = 2j * rail.carrier.omega * rate * d
    epsilon, rate2 = solve2(1j * r, -d, under.a + coriolis - p.a + omega**2 * r)
    i = LinkMotion(np.angle(r), omega, epsilon)
    j = LinkMotion(np.angle(d), rail.carrier.omega, rail.carrier.epsilon)
    middle = PointMotion(q, under.v + rate * d, under.a + coriolis + rate2 * d)
    return Assembled(middle, (i, j), (p, middle), {(rail.link, dyad.links[1]): SlideMotion(s, rate, rate2, d)})


def _rpr(dyad: Dyad, p: PointMotion, t: PointMotion, sign: Floats) -> Assembled:
    """v_P = v_T + iω TP + ṡ u, a_P = a_T + (iε − ω²) TP + 2iωṡ u + s̈ u."""
    offset = dyad.lengths[1]
    r = p.p - t.p
    # A pin met by its own slider's centre leaves the direction to rounding.
    r = np.where(np.abs(r) > COINCIDENT * (np.abs(p.p) + np.abs(t.p)), r, np.nan)
    s = sign * _root(np.abs(r))(np.abs(r) ** 2 - offset**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = unit(np.angle(r / (s + 1j * offset)))
    omega, rate = solve2(1j * r, u, p.v - t.v)
    epsilon, rate2 = solve2(1j * r, u, p.a - t.a + omega**2 * r - 2j * omega * rate * u)
    link = LinkMotion(np.angle(u), omega, epsilon)
    i, j = dyad.links
    return Assembled(carried(t, link, p.p), (link, link), (p, t), {(j, i): SlideMotion(s, rate, rate2, u)})


def _prp(dyad: Dyad, first: Rail, second: Rail) -> Assembled:
    """v_Qk + ṡ₁ d₁ = v_Qm + ṡ₂ d₂."""
    d, e = first.direction, second.direction
    s, t = solve2(d, -e, second.at.p - first.at.p)
    q = first.at.p + s * d
    under, over = first.carried(q), second.carried(q)
    v, w = solve2(d, -e, over.v - under.v)
    turning, other = 2j * first.carrier.omega * v * d, 2j * second.carrier.omega * w * e
    a, b = solve2(d, -e, over.a + other - under.a - turning)
    middle = PointMotion(q, under.v + v * d, under.a + turning + a * d)
    i, j = dyad.links
    links = (
        LinkMotion(np.angle(d), first.carrier.omega, first.carrier.epsilon),
        LinkMotion(np.angle(e), second.carrier.omega, second.carrier.epsilon),
    )
    slides = {(first.link, i): SlideMotion(s, v, a, d), (second.link, j): SlideMotion(t, w, b, e)}
    return Assembled(middle, links, (middle, middle), slides)


def _rpp(dyad: Dyad, p: PointMotion, rail: Rail) -> Assembled:
    """v_P = v_Pk + ṡ d + ṫ w: both slides turn with the guide's link, 2iω_k (ṡ d + ṫ w) is Coriolis."""
    d = rail.direction
    w = d * unit(dyad.slide_angle)
    under = rail.carried(p.p)
    turning = 2j * rail.carrier.omega
    s, t = solve2(d, w, p.p - rail.at.p)
    v, vt = solve2(d, w, p.v - under.v)
    a, at = solve2(d, w, p.a - under.a - turning * (v * d + vt * w))
    q = rail.carried(rail.at.p + s * d)
    middle = PointMotion(q.p, q.v + v * d, q.a + turning * v * d + a * d)
    link = LinkMotion(np.angle(d), rail.carrier.omega, rail.carrier.epsilon)
    i, j = dyad.links
    slides = {(rail.link, j): SlideMotion(s, v, a, d), (j, i): SlideMotion(t, vt, at, w)}
    return Assembled(middle, (link, link), (p, middle), slides)
