"""Vectors of the plane as complex numbers, of any shape."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Flags = NDArray[np.bool_]

SINGULAR = 1e-5
"""Sine of the angle below which two directions count as parallel.

A position found near such a place carries a relative error of about ε/sin² (ε = 2e-16): past this
bound its rates would be wrong in the sixth digit, so none are given.
"""


def unit(angle: Floats | float) -> Complexes:
    """Unit vector e^{iθ} at `angle` (rad)."""
    return np.asarray(np.exp(1j * np.asarray(angle, dtype=np.float64)), dtype=np.complex128)


def cross(a: Complexes | complex, b: Complexes | complex) -> Floats:
    """a × b = aₓb_y − a_y bₓ, the component along z."""
    a, b = np.asarray(a), np.asarray(b)
    return np.asarray(a.real * b.imag - a.imag * b.real, dtype=np.float64)


def dot(a: Complexes | complex, b: Complexes | complex) -> Floats:
    """a · b = aₓbₓ + a_y b_y."""
    a, b = np.asarray(a), np.asarray(b)
    return np.asarray(a.real * b.real + a.imag * b.imag, dtype=np.float64)


def solve2(u: Complexes | complex, w: Complexes | complex, rhs: Complexes | complex) -> tuple[Floats, Floats]:
    """The real x, y with x·u + y·w = rhs; nan where u and w are parallel to within `SINGULAR`."""
    area = cross(u, w)
    regular = np.abs(area) > SINGULAR * np.abs(u) * np.abs(w)
    area = np.where(regular, area, np.nan)
    return cross(rhs, w) / area, cross(u, rhs) / area
