"""Plane vectors as complex numbers, and the motion of rigid links, their points and their slides.

The groups of Assur in `machine.kinematics` and `machine.triads` are computed with these.
"""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record
from reportgen.machine import GROUND

SINGULAR = 1e-5
"""Sine of the angle below which two directions count as parallel.

A position found near such a place has a relative error of about ε/sin² (ε = 2e-16). Below this bound its rates
would be wrong in the sixth digit, so they are nan.
"""


# --- vectors of the plane, as complex numbers of any shape ---------------------------------------


def unit(angle: Floats | float) -> Complexes:
    """Return the unit vector e^{iθ} at `angle` (rad), in its shape."""
    return np.asarray(np.exp(1j * np.asarray(angle, dtype=np.float64)), dtype=np.complex128)


def cross(a: Complexes | complex, b: Complexes | complex) -> Floats:
    """Return the component a × b = aₓb_y − a_y bₓ along z, in the product of their units; arrays of any shape."""
    a, b = np.asarray(a), np.asarray(b)
    return np.asarray(a.real * b.imag - a.imag * b.real, dtype=np.float64)


def dot(a: Complexes | complex, b: Complexes | complex) -> Floats:
    """Return the scalar product a · b = aₓbₓ + a_y b_y, in the product of their units; arrays of any shape."""
    a, b = np.asarray(a), np.asarray(b)
    return np.asarray(a.real * b.real + a.imag * b.imag, dtype=np.float64)


def solve2(u: Complexes | complex, w: Complexes | complex, rhs: Complexes | complex) -> tuple[Floats, Floats]:
    """Solve x·u + y·w = rhs for real x, y [N] by Cramer's rule; nan where u and w are parallel to within `SINGULAR`."""
    area = cross(u, w)
    regular = np.abs(area) > SINGULAR * np.abs(u) * np.abs(w)
    area = np.where(regular, area, np.nan)
    return cross(rhs, w) / area, cross(u, rhs) / area


# --- motion ---------------------------------------------------------------------------------------


class LinkMotion(Record):
    """Angle (rad), angular velocity (rad/s) and acceleration (rad/s²) of a link, each [N]."""

    angle: Floats
    omega: Floats
    epsilon: Floats


class PointMotion(Record):
    """Position (m), velocity (m/s) and acceleration (m/s²) of a point, complex [N]."""

    p: Complexes
    v: Complexes
    a: Complexes


class SlideMotion(Record):
    """Relative motion in a prismatic joint: s (m) along the unit vector `direction`, ṡ (m/s) and s̈ (m/s²), each [N]."""

    s: Floats
    v: Floats
    a: Floats
    direction: Complexes


class Rail(Record):
    """A guide as it moves: its point `at`, its unit `direction` [N], and the motion of the link that carries it."""

    link: int
    at: PointMotion
    direction: Complexes
    carrier: LinkMotion

    def carried(self, p: Complexes) -> PointMotion:
        """Return the point of the guide's own link that lies at `p` (m) [N]: v = v_G + iω r, a = a_G + (iε − ω²) r."""
        if self.link == GROUND:
            return at_rest(p)
        return carried(self.at, self.carrier, p)


def carried(base: PointMotion, link: LinkMotion, p: Complexes) -> PointMotion:
    """Return the point at `p` (m) [N] of a rigid link that moves with `base`: v = v_O + iω r, a = a_O + (iε − ω²) r."""
    r = p - base.p
    return PointMotion(p, base.v + 1j * link.omega * r, base.a + (1j * link.epsilon - link.omega**2) * r)


def at_rest(p: Complexes) -> PointMotion:
    """Return the point of the ground that lies at `p` (m) [N]."""
    return PointMotion(p, np.zeros_like(p), np.zeros_like(p))
