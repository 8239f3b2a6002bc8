"""Numbers without the last bits of floating-point results, which differ from one processor to another.

Everything that is printed, drawn, described, hashed or chosen from computed numbers goes through one of these functions
first.  The steps are binary, so that no short decimal number and no simple fraction lies halfway between two of them.
"""

from __future__ import annotations

import math
from typing import Any, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike

from reportgen.base.units import rounded, significant_decimals

STEP = 2.0**-20
"""The usual step of `settled`: a millionth, of a millimetre on paper for example."""
ALIKE = 1e-9
"""Two values whose difference is below this share of the greatest one are equal."""

Array = TypeVar("Array", bound="np.ndarray")


@overload
def settled(values: float, step: float = STEP) -> float: ...
@overload
def settled(values: complex, step: float = STEP) -> complex: ...
@overload
def settled(values: Array, step: float = STEP) -> Array: ...
def settled(values: Any, step: float = STEP) -> Any:
    """Return a number, complex number or array (any shape and unit) rounded to whole multiples of `step`; never a
    negative zero.
    """
    if isinstance(values, np.ndarray):
        if np.iscomplexobj(values):
            parts = np.ascontiguousarray(values, dtype=np.complex128).view(np.float64)
            return settled(parts, step).view(np.complex128).reshape(values.shape)
        return np.rint(values / step) * step + 0.0
    if isinstance(values, complex):
        return complex(_rounded(values.real, step), _rounded(values.imag, step))
    return _rounded(values, step)


def _rounded(value: float, step: float) -> float:
    return round(value / step) * step + 0.0 if math.isfinite(value) else value


def significant(value: float, figures: int) -> float:
    """Return a number (any unit) rounded half up, as by hand, to `figures` significant figures."""
    if value == 0 or not math.isfinite(value):
        return value + 0.0
    decimals = significant_decimals(value, figures)
    return float(f"{rounded(value, decimals):.{figures}g}") + 0.0


def first_greatest(values: ArrayLike) -> int:
    """Return the index of the first value [N] (any unit) that equals the greatest up to rounding; ignore nan.

    Raises `ValueError` if there is no value.
    """
    known = np.asarray(values, dtype=np.float64)
    finite = np.where(np.isnan(known), -np.inf, known)
    greatest = finite.max()
    if not math.isfinite(greatest):
        return int(finite.argmax())
    size = np.max(np.abs(finite), initial=0.0, where=np.isfinite(finite))
    return int(np.argmax(finite >= greatest - ALIKE * size))


def first_least(values: ArrayLike) -> int:
    """Return the index of the first value [N] (any unit) that equals the least up to rounding; ignore nan."""
    return first_greatest(-np.asarray(values, dtype=np.float64))
