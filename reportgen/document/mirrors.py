"""Positions that mirror others: their plans are mirror images and are told, not drawn again.

The positions k and N + 2 − k of a centric slider-crank mirror each other in the line of its slide.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.figures.plan import Plan

SAME = 0.01
"""Ends of vectors nearer than this (mm), the last digit of a measured length, are one for any reader."""
PARALLEL = 1e-3
"""Two lines of mirroring whose directions differ by no more (radians, twice) are one."""


@dataclass(frozen=True, slots=True)
class Mirrored:
    """Positions (numbers) and, in the same order, those whose plans are their mirror images."""

    at: tuple[int, ...]
    of: tuple[int, ...]


def mirrored(plans: Mapping[int, Plan]) -> Mirrored:
    """Which of the plans, at their positions, mirror one at an earlier position, all of them in parallel lines."""
    ends = {k: np.array([end for v in plan.vectors for end in (v.start, v.end)]) for k, plan in plans.items()}
    pairs: list[tuple[int, int]] = []
    line: complex | None = None
    for k, found in ends.items():
        taken = {number for pair in pairs for number in pair}
        for earlier in (number for number in ends if number < k and number not in taken):
            turn = _turn(ends[earlier], found)
            if turn is not None and (line is None or abs(turn - line) < PARALLEL):
                line = turn
                pairs.append((k, earlier))
                break
    pairs.sort(key=lambda pair: pair[1])
    return Mirrored(tuple(k for k, _ in pairs), tuple(earlier for _, earlier in pairs))


def _turn(one: np.ndarray, other: np.ndarray) -> complex | None:
    """What turns the conjugates of some points into others, if anything does; None if both are one without it."""
    if not one.size or abs(one - other).max() < SAME:
        return None
    largest = int(abs(one).argmax())
    turn = complex(other[largest] / one[largest].conjugate())
    if abs(abs(one[largest]) * (abs(turn) - 1)) > SAME:
        return None
    turn /= abs(turn)
    return turn if abs(other - turn * one.conj()).max() < SAME else None
