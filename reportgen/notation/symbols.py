"""The one table of units and of how finely each kind of quantity is printed.

A *kind* fixes the printed unit, what one such unit is in SI, and the preferred number of
significant figures; `ledger.precision` then raises or lowers decimals so that printed lines recompute.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from reportgen.notation.expressions import Symbol


@dataclass(frozen=True, slots=True)
class Kind:
    """How a kind of quantity is printed: SI value = printed value × `scale`.

    `digits` are the significant figures aimed at for the largest value of a family; `decimals`, if
    given, fixes the aim instead (a segment is measured to 0.01 mm whatever its length).
    """

    unit: str
    scale: float = 1.0
    digits: int = 4
    decimals: int | None = None


KINDS: dict[str, Kind] = {
    "ratio": Kind("", digits=5),
    "count": Kind("", decimals=0),
    "sign": Kind("", decimals=0),
    "angle": Kind("°", math.pi / 180, decimals=2),
    "speed of rotation": Kind("rpm", digits=5),
    "time": Kind("s", digits=4),
    "length": Kind("m", digits=4),
    "diameter": Kind("cm", 1e-2, digits=4),
    "area": Kind("cm²", 1e-4, digits=5),
    "product of lengths": Kind("m²", digits=4),
    "segment": Kind("mm", 1e-3, decimals=2),
    "length scale": Kind("m/mm", 1e3, digits=4),
    "velocity scale": Kind("m/(s·mm)", 1e3, digits=6),
    "acceleration scale": Kind("m/(s²·mm)", 1e3, digits=5),
    "force scale": Kind("N/mm", 1e3, digits=4),
    "pressure scale": Kind("N/(cm²·mm)", 1e7, digits=4),
    "velocity": Kind("m/s", digits=5),
    "acceleration": Kind("m/s²", digits=5),
    "angular velocity": Kind("rad/s", digits=5),
    "angular acceleration": Kind("rad/s²", digits=5),
    "weight": Kind("N", digits=4),
    "gravity": Kind("m/s²", digits=3),
    "mass": Kind("kg", digits=5),
    "moment of inertia": Kind("kg·m²", digits=4),
    "pressure": Kind("N/cm²", 1e4, digits=4),
    "force": Kind("N", digits=5),
    "torque": Kind("N·m", digits=4),
    "work": Kind("J", digits=5),
    "power": Kind("W", digits=5),
}

MAX_DIGITS = 6
"""No printed number has more significant figures (on the family's largest value)."""


def point(name: str) -> Symbol:
    """The symbol of a point called e.g. "A", "S2", "O1": letter and lowered number."""
    letters = name.rstrip("0123456789")
    return Symbol(letters, sub=name[len(letters) :])


def on_plan(name: str, prime: bool = False) -> Symbol:
    """The image of a point on a velocity plan (b, s2) or, primed, on an acceleration plan (b′, s2′)."""
    symbol = point(name)
    return Symbol(symbol.base.lower(), symbol.sub, "′" if prime else "")


def vector(symbol: Symbol) -> Symbol:
    """The same symbol as a vector."""
    return Symbol(symbol.base, symbol.sub, symbol.sup, "vector")


def lowered(text: str) -> str:
    """Digits of point names as lowered digits: B3 → B₃."""
    return text.translate(_LOWERED)


_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def segment(first: Symbol | str, second: Symbol | str) -> Symbol:
    """A length between two points of a drawing: a bar over both letters, e.g. over p b or O₁A."""
    one = first if isinstance(first, Symbol) else Symbol(first)
    two = second if isinstance(second, Symbol) else Symbol(second)
    return Symbol(one.base + lowered(one.sub) + one.sup + two.base, two.sub, two.sup, "segment")


def drawn_length(first: str, second: str) -> Symbol:
    """The symbol of a length between two points on a drawing, e.g. AS₂ under a bar."""
    return segment(point(first), point(second))
