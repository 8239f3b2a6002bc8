"""How points are named on plans, in ids and in print."""

from __future__ import annotations

from collections.abc import Collection

from reportgen.notation.expressions import Symbol
from reportgen.notation.symbols import point

_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def image(name: str) -> str:
    """A point's letter on a plan: S2 → s2."""
    return name.lower()


def difference(middle: str, start: str) -> str:
    """The id of the vector from one point to another, e.g. BA for B relative to A."""
    return f"{middle}{start}"


def under(name: str, link: int, taken: Collection[str]) -> str:
    """The name of the point of a link that lies under a pin now: B on link 3 → B3, B′3 where B3 is taken."""
    plain = f"{name}{link}"
    return f"{name}′{link}" if plain in taken else plain


def segment_symbol(first: Symbol | str, second: Symbol | str) -> Symbol:
    """A length between two points of a drawing: a bar over both letters, e.g. over p b or O₁A."""
    one = first if isinstance(first, Symbol) else Symbol(first)
    two = second if isinstance(second, Symbol) else Symbol(second)
    return Symbol(one.base + one.sub.translate(_LOWERED) + one.sup + two.base, two.sub, two.sup, "segment")


def length_symbol(first: str, second: str) -> Symbol:
    """The symbol of a length between two points on a drawing, e.g. AS₂ under a bar."""
    return segment_symbol(point(first), point(second))
