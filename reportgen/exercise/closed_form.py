"""Coordinates of a loop in closed form: two unknown coordinates as functions of the known ones.

==================== ============================================================ ==========================
unknown              loop, with k the known legs                                  found by
==================== ============================================================ ==========================
two angles           k + l₁ e₁ + l₂ e₂ = 0                                        the cosine rule
an angle and travel  k + l e + s e_α = 0 along a line of known direction α        the distance from the line
both of one body     k + s e + h n = 0 along a line that turns with the body      the length of the travel
==================== ============================================================ ==========================
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from itertools import permutations

from reportgen.exercise.chain_derivatives import RateFormulas
from reportgen.exercise.position_chains import (
    Closure,
    Direction,
    GeneralizedCoordinate,
    LoopVector,
    SlideTravel,
    Turn,
    legs_of,
)
from reportgen.exercise.rate_conditions import GROUND
from reportgen.formula import (
    NOTHING,
    ONE,
    Expression,
    Number,
    Ref,
    Sum,
    Symbol,
    acos,
    asin,
    atan2,
    ids,
    is_zero,
    minus,
    over,
    plus,
    signed,
    sqrt,
    square,
)
from reportgen.formula.constructions import cross

STRAIGHT = Number(180.0, unit="°")
FLAT = 0.02
"""Below this sine a triangle is near a dead centre and its angles lose all digits, so they are read off the figure."""
X_AXIS = Direction(GROUND, 0.0)


def closed_form(
    k: RateFormulas, loop: Closure, legs: Sequence[LoopVector], unknown: Sequence[GeneralizedCoordinate]
) -> tuple[str, ...]:
    """Enter the unknown coordinates of a loop and return the ids of the lines; `()` if there is no closed form."""
    known = [leg for leg in legs_of(loop) if leg not in legs]
    vectors = []
    for axis in range(2):
        fixed = plus(loop.outward.fixed[axis], minus(loop.back.fixed[axis]))
        if fixed != NOTHING:
            vectors.append(LoopVector(fixed, 0.0, X_AXIS, axis))
    vectors += known
    for turn, second in permutations(unknown):
        own = [leg for leg in legs if isinstance(turn, Turn) and leg.direction.body == turn.body]
        rest = [leg for leg in legs if leg not in own]
        if not isinstance(turn, Turn):
            continue
        if isinstance(second, Turn) and len(own) == len(rest) == 1 and all(leg.slide is None for leg in legs):
            return _two_angles(k, loop.point, vectors, own[0], rest[0])
        if isinstance(second, SlideTravel) and len(own) == len(rest) == 1 and own[0].slide is None:
            return _angle_and_travel(k, vectors, own[0], rest[0], second)
        ways = [leg for leg in own if leg.slide == second]
        if isinstance(second, SlideTravel) and not rest and len(ways) == 1 and len(own) <= 2:
            return _line_that_turns(k, loop.point, vectors, ways[0], [leg for leg in own if leg not in ways], second)
    return ()


def _two_angles(
    k: RateFormulas, point: str, vectors: list[LoopVector], e1: LoopVector, e2: LoopVector
) -> tuple[str, ...]:
    """Enter φ₁ and φ₂: e₁ is at the angle of the cosine rule from d = −k, with the sense of l₁; e₂ leads from its tip
    back.
    """
    first, second = (leg.value * cmath.exp(1j * k.linked.heading(leg.direction)) for leg in (e1, e2))
    if abs(cross(first, second)) < FLAT * abs(first) * abs(second):
        return ()
    lines, x, y = _lead(k, point, [_turned(vector, -e1.value) for vector in vectors], (e1, e2))
    l_1, l_2 = (signed(leg.value, leg.length) for leg in (e1, e2))
    d = k.derivation.q.define(_number(e1, e2), sqrt(plus(square(x), square(y))), Symbol("d", point))
    corner = acos((l_1**2 + d**2 - l_2**2) / (2 * l_1 * d))
    angle = _angle(k, e1, atan2(y, x) + signed(cross(first + second, first) or 1.0, corner))
    tip = [LoopVector(minus(l_1), 0.0, e1.direction)]
    rest = (plus(part, k.component(tip, axis)) for axis, part in (("x", x), ("y", y)))
    x, y = (part if e1.value * e2.value > 0 else minus(part) for part in rest)
    return *lines, d.id, angle, _angle(k, e2, atan2(y, x))


def _number(e1: LoopVector, e2: LoopVector, *axis: int) -> str:
    """Return the id of the distance between the outer ends of two legs, or of its component along an axis."""
    return ids.loop_distance(",".join(map(str, (0, e1.direction.body, e2.direction.body, *axis))))


def _lead(
    k: RateFormulas, point: str, vectors: list[LoopVector], legs: tuple[LoopVector, LoopVector]
) -> tuple[tuple[str, ...], Expression, Expression]:
    """Return the ids of the lines entered and the components of the sum of known legs along x and y."""
    lines, parts = list[str](), list[Expression]()
    for number, axis in enumerate("xy"):
        part = k.component(vectors, axis)
        if isinstance(part, Sum):
            symbol = Symbol("d", f"{point}{axis}")
            part = k.derivation.q.define(_number(*legs, number), part, symbol, scale=k.derivation.motion.size)
            lines.append(part.id)
        parts.append(part)
    return tuple(lines), parts[0], parts[1]


def _angle_and_travel(
    k: RateFormulas, vectors: list[LoopVector], rod: LoopVector, slide: LoopVector, of: SlideTravel
) -> tuple[str, ...]:
    """Enter φ from sin(φ − α) = the distance of the known legs from the line, divided by l; then the travel s."""
    along, across = ([LoopVector(ONE, 1.0, slide.direction, quarters)] for quarters in range(2))
    now = math.remainder(k.linked.heading(rod.direction) - k.linked.heading(slide.direction), 2 * math.pi)
    if abs(math.cos(now)) < FLAT:
        return ()
    legs = [_turned(vector, -rod.value) for vector in vectors]
    dip = asin(over(k.dot(legs, across), signed(rod.value, rod.length)))
    from_line = dip if math.cos(now) > 0 else STRAIGHT - dip
    α = k.linked.angle(slide.direction)
    angle = _angle(k, rod, from_line if is_zero(α) else plus(α, from_line))
    tip = [_turned(vector, 1.0 if _is_reversed(slide) else -1.0) for vector in (*vectors, rod)]
    s = k.derivation.q.define(
        k.linked.travel_id(of),
        k.dot(tip, along),
        k.linked.read_off[k.linked.travel_id(of)][1],
        scale=k.derivation.motion.size,
    )
    return angle, s.id


def _line_that_turns(
    k: RateFormulas, point: str, vectors: list[LoopVector], slide: LoopVector, off: list[LoopVector], of: SlideTravel
) -> tuple[str, ...]:
    """Enter s and φ: |d|² = s² + h², and the angle of the line is the angle of d minus that of (s, h)."""
    if abs(slide.value) < FLAT * math.hypot(slide.value, *(leg.value for leg in off)):
        return ()
    sense = 1.0 if _is_reversed(slide) else -1.0
    lines, x, y = _lead(k, point, [_turned(vector, sense) for vector in vectors], (slide, slide))
    h = minus(signed(sense, off[0].length)) if off else NOTHING
    value, symbol = k.linked.read_off[k.linked.travel_id(of)]
    size = sqrt(plus(square(x), square(y), minus(square(h))))
    s = k.derivation.q.define(k.linked.travel_id(of), signed(value, size), symbol)
    whole = atan2(y, x)
    if off:
        return *lines, s.id, _angle(k, slide, whole - atan2(h, s))
    return *lines, s.id, _angle(k, slide, whole if value > 0 else whole + STRAIGHT)


def _angle(k: RateFormulas, leg: LoopVector, heading: Expression) -> str:
    """Enter φ of a body from the heading of a direction that turns with it."""
    body, offset = leg.direction.body, k.linked.angle(Direction(GROUND, leg.direction.offset))
    formula = heading if not leg.direction.offset else plus(heading, minus(offset))
    return k.derivation.q.define(ids.formula_angle(body), formula, Symbol("φ", k.linked.letter(body))).id


def _is_reversed(slide: LoopVector) -> bool:
    return not isinstance(slide.length, Ref)


def _turned(vector: LoopVector, sense: float) -> LoopVector:
    """Return the vector, or its opposite if `sense` is negative."""
    if sense > 0:
        return vector
    return vector.reversed()
