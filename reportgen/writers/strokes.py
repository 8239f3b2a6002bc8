"""Geometry that every drawing needs: arrow heads, arcs as Bézier curves, clipped hatching.

Points are complex numbers in mm, x to the right and y up.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from reportgen.figures.scene import Arc

Segment = tuple[complex, complex]
Bezier = tuple[complex, complex, complex, complex]
Triangle = tuple[complex, complex, complex]

HEAD_SLENDERNESS = 0.32
"""Width of an arrow head over its length."""
HEAD_SHARE = 0.75
"""The largest share of a short arrow that its head may take."""


def arrow_head(start: complex, end: complex, length: float) -> tuple[complex, Triangle | None]:
    """(where the shaft ends, the head's triangle tip first) of an arrow whose tip lies on `end`.

    The shaft ends inside the head, so that no square pen end shows beside the tip; the head shrinks
    on an arrow shorter than itself.  An arrow of no length has no head.
    """
    span = abs(end - start)
    if span == 0 or length <= 0:
        return end, None
    head = min(length, HEAD_SHARE * span)
    along = (end - start) / span
    back = end - head * along
    side = 0.5 * HEAD_SLENDERNESS * head * along * 1j
    return end - 0.7 * head * along, (end, back + side, back - side)


def arc_to_beziers(centre: complex, radius: float, start: float, stop: float) -> list[Bezier]:
    """Cubic Bézier pieces of an arc from `start` to `stop` (radians), each of at most 45°.

    The handles are (4/3) tan(Δ/4) of the radius; the error stays below 5e-6 of the radius.
    """
    count = max(1, math.ceil(abs(stop - start) / (math.pi / 4) - 1e-9))
    step = (stop - start) / count
    handle = 4 / 3 * math.tan(step / 4)
    pieces = []
    for index in range(count):
        first = cmath.rect(radius, start + index * step)
        last = cmath.rect(radius, start + (index + 1) * step)
        pieces.append(
            (
                centre + first,
                centre + first * (1 + 1j * handle),
                centre + last * (1 - 1j * handle),
                centre + last,
            )
        )
    return pieces


def arc_with_head(arc: Arc) -> tuple[list[Bezier], Triangle | None]:
    """(pieces of the arc, its head's triangle or None): the head is a chord whose tip is the arc's stop."""
    sweep = arc.stop - arc.start
    if arc.head <= 0 or arc.radius <= 0 or sweep == 0:
        return arc_to_beziers(arc.centre, arc.radius, arc.start, arc.stop), None
    # The chord of the head spans this angle; no more than the arc itself has to give.
    chord = min(arc.head / arc.radius, HEAD_SHARE * abs(sweep), 1.0)
    angle = math.copysign(2 * math.asin(chord / 2), sweep)
    tip = arc.centre + cmath.rect(arc.radius, arc.stop)
    tail = arc.centre + cmath.rect(arc.radius, arc.stop - angle)
    _, triangle = arrow_head(tip + (tail - tip) / HEAD_SHARE, tip, abs(tip - tail))
    return arc_to_beziers(arc.centre, arc.radius, arc.start, arc.stop - 0.7 * angle), triangle


def clip_hatch(points: Sequence[complex], spacing: float) -> list[Segment]:
    """Strokes at 45° inside a convex polygon, `spacing` mm apart, counted from the sheet's origin.

    Neighbouring hatches thus run into each other.  Raises `ValueError` for a spacing that is not positive.
    """
    if spacing <= 0:
        raise ValueError("the spacing of a hatch must be positive")
    turned = [point * cmath.exp(-0.25j * math.pi) for point in points]
    heights = [point.imag for point in turned]
    if not turned:
        return []
    strokes = []
    for index in range(math.ceil(min(heights) / spacing), math.floor(max(heights) / spacing) + 1):
        height = index * spacing
        crossings = [
            a.real + (b.real - a.real) * (height - a.imag) / (b.imag - a.imag)
            for a, b in zip(turned, turned[1:] + turned[:1], strict=True)
            if (a.imag <= height) != (b.imag <= height)
        ]
        if len(crossings) == 2 and abs(crossings[0] - crossings[1]) > 1e-6:
            left, right = sorted(crossings)
            back = cmath.exp(0.25j * math.pi)
            strokes.append((complex(left, height) * back, complex(right, height) * back))
    return strokes


def decimal(value: float) -> str:
    """A length to a thousandth of a millimetre, without trailing zeros and without a negative zero."""
    return f"{round(value, 3) + 0.0:.3f}".rstrip("0").rstrip(".")
