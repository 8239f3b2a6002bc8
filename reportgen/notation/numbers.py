"""Rounding and writing of numbers: decimal comma or point, no negative zero, no rounding dust."""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import ROUND_HALF_UP, Decimal
from typing import Literal

Language = Literal["vi", "en"]

MINUS = "\N{MINUS SIGN}"


def rounded(value: float, decimals: int) -> Decimal:
    """`value` rounded half up (as by hand) to `decimals`; never a negative zero.

    Rounding starts from the shortest decimal form of the float, so 2.675 becomes 2.68.
    """
    quantum = Decimal(1).scaleb(-decimals)
    result = Decimal(repr(float(value))).quantize(quantum, rounding=ROUND_HALF_UP)
    return abs(result) if result == 0 else result


def printed(value: float, decimals: int) -> float:
    """The number a reader sees: `value` rounded to `decimals`."""
    return float(rounded(value, decimals))


def write(value: float, decimals: int | None, language: Language) -> str:
    """The text of a number: fixed `decimals`, or the shortest exact form when None.

    The Vietnamese text has a decimal comma; both use a true minus sign and no thousands mark.
    """
    if not math.isfinite(value):
        return "–"
    if decimals is None:
        number = Decimal(repr(float(value))).normalize()
        number = abs(number) if number == 0 else number
    else:
        number = rounded(value, decimals)
    text = f"{number:f}".replace("-", MINUS)
    return text.replace(".", ",") if language == "vi" else text


def significant_decimals(value: float, digits: int) -> int:
    """Decimals that show `value` with `digits` significant figures; 0 for a value of zero."""
    if value == 0 or not math.isfinite(value):
        return 0
    return digits - 1 - math.floor(math.log10(abs(value)))


SERIES = (1.0, 2.0, 2.5, 4.0, 5.0)
"""Scales one measures with are these times a power of ten."""


def nice_up(value: float, series: Sequence[float] = SERIES) -> float:
    """The smallest s·10ⁿ, s of the series, that is not below `value`.

    Raises `ValueError` unless `value` is positive and finite.
    """
    if not (value > 0 and math.isfinite(value)):
        raise ValueError("a scale is a positive number")
    decade = math.floor(math.log10(value))
    choices = (float(f"{step}e{power}") for power in (decade, decade + 1, decade + 2) for step in sorted(series))
    # A value that is a member but for its last binary digits is that member.
    return next(choice for choice in choices if choice >= value * (1 - 1e-12))


def nice_down(value: float, series: Sequence[float] = SERIES) -> float:
    """The largest s·10ⁿ, s of the series, that is not above `value`; raises `ValueError` as `nice_up` does."""
    if not (value > 0 and math.isfinite(value)):
        raise ValueError("a scale is a positive number")
    decade = math.floor(math.log10(value))
    choices = (float(f"{step}e{power}") for power in (decade + 1, decade, decade - 1) for step in sorted(series)[::-1])
    return next(choice for choice in choices if choice <= value * (1 + 1e-12))
