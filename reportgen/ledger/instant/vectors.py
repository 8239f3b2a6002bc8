"""Vectors whose directions are known and whose sizes are quantities of a sheet, and what they come to along an axis."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from reportgen.notation.expressions import Expression, Negative, Number, Product, Ref, Symbol, cos, total
from reportgen.notation.sheet import Sheet
from reportgen.plane_motion.ways import SAME, parallel


@dataclass(frozen=True, slots=True)
class Vector:
    """A vector by the id of its size, which is positive, and its direction (of length 1)."""

    id: str
    way: complex


def along(q: Sheet, vector: Vector, axis: complex) -> Expression | None:
    """The component of a vector along an axis, as it is written: v cos 30° with its sign; None where it is nothing."""
    cosine = (axis.conjugate() * vector.way).real
    if abs(cosine) < SAME or q.si(vector.id) == 0:
        return None
    size: Expression = q[vector.id]
    if abs(cosine) < 1 - SAME**2 / 2 and not parallel(vector.way, axis):
        size = Product((size, cos(angle(q, math.acos(min(abs(cosine), 1.0))))))
    return size if cosine > 0 else Negative(size)


def components(q: Sheet, vectors: Iterable[Vector], axis: complex) -> list[Expression]:
    """The components along an axis of those vectors that have one."""
    found = (along(q, vector, axis) for vector in vectors)
    return [one for one in found if one is not None]


def solved_for(
    q: Sheet, unknown: complex, axis: complex, known: Sequence[Vector], opposite: Sequence[Vector]
) -> Expression:
    """The size of a vector of direction `unknown` from Σ opposite + unknown = Σ known, projected on an axis.

    The axis points so that the unknown's component is positive.
    """
    axis = towards(axis, unknown)
    cosine = (axis.conjugate() * unknown).real
    terms = components(q, known, axis)
    terms += [one.of if isinstance(one, Negative) else Negative(one) for one in components(q, opposite, axis)]
    sum_of = total(_positive_first(terms)) if terms else Number(0.0)
    if parallel(unknown, axis):
        return sum_of
    return sum_of / cos(angle(q, math.acos(min(cosine, 1.0))))


def towards(axis: complex, way: complex) -> complex:
    """The axis, or its opposite, along which a vector of that direction has a positive component."""
    return axis if (axis.conjugate() * way).real > 0 else -axis


def _positive_first(terms: list[Expression]) -> list[Expression]:
    """The terms with a plus before those with a minus."""
    return sorted(terms, key=lambda term: isinstance(term, Negative))


def angle(q: Sheet, value: float) -> Expression:
    """An angle (radians) as it stands in a formula: a round one as its degrees, any other by a symbol α of its own."""
    degrees = math.degrees(value)
    if abs(degrees - round(degrees, 2)) < 1e-9:
        return Number(round(degrees, 2), None, "°")
    others = [id for id in q.families if id.startswith("alpha.")]
    same = (id for id in others if abs(q.si(id) - value) < SAME)
    id = next(same, "")
    number = str(len(others) + 1)
    return Ref(id) if id else q.give(f"alpha.{number}", value, Symbol("α", number), "angle", exact=False)
