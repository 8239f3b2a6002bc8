"""Find plans that are mirror images of earlier ones; the report mentions them and does not draw them again.

The positions k and N + 2 − k of a centric slider-crank mirror each other in the line of its slide.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from reportgen.base.records import Record
from reportgen.drawing.vector_plan import Plan

SAME_END = 0.01
"""Ends of vectors nearer than this (mm), the last digit of a measured length, coincide."""
FEWEST = 2
"""Least number of pairs of positions for which the report has a sentence."""
SAME_MIRROR = 1e-3
"""Two lines of mirroring coincide if twice their angle is at most this (rad)."""


class Mirrored(Record):
    """Positions, and in the same order the earlier positions whose plans theirs mirror."""

    at: tuple[int, ...]
    of: tuple[int, ...]


def mirrored(plans: Mapping[int, Plan]) -> Mirrored:
    """Return the positions whose plans mirror that of an earlier position, all in parallel lines.

    Of several such lines the one with most pairs counts; a single pair, as of the two dead centres, is ignored.
    """
    ends = {k: np.array([end for v in plan.vectors for end in (v.start, v.end)]) for k, plan in plans.items()}
    turns = [
        (earlier, later, turn)
        for earlier, later in combinations(sorted(ends), 2)
        if (turn := _turn(ends[earlier], ends[later])) is not None
    ]
    best: dict[int, int] = {}
    for *_, line in turns:
        pairs: dict[int, int] = {}
        for earlier, later, turn in turns:
            if abs(turn - line) < SAME_MIRROR and not {earlier, later} & {*pairs, *pairs.values()}:
                pairs[earlier] = later
        best = max(best, pairs, key=len)
    if len(best) < FEWEST:
        return Mirrored((), ())
    return Mirrored(tuple(best.values()), tuple(best))


def _turn(ends: np.ndarray, mirrored_ends: np.ndarray) -> complex | None:
    """Return the factor that turns the conjugates of points [N] into others; None without one, or if both sets are
    equal.
    """
    if not ends.size or abs(ends - mirrored_ends).max() < SAME_END:
        return None
    largest = int(abs(ends).argmax())
    turn = complex(mirrored_ends[largest] / ends[largest].conjugate())
    if abs(abs(ends[largest]) * (abs(turn) - 1)) > SAME_END:
        return None
    turn /= abs(turn)
    return turn if abs(mirrored_ends - turn * ends.conj()).max() < SAME_END else None
