"""Detect arrowheads among the lines of a drawing: two short strokes or two sides of a triangle at the end of a line.

Arrowheads show where a vector ends, and are not vectors themselves.
"""

from __future__ import annotations

import numpy as np

from reportgen.base.records import Record
from reportgen.handin.line_set import Lines

SLIMMEST, WIDEST = np.radians(3.0), np.radians(50.0)
"""Smallest and largest angle between a stroke of an arrowhead and its line."""
LONGEST = 16.0
"""Largest length of a stroke in errors of an end (8 mm): arrowheads are small, and vectors may look alike."""
SNAPPED = 0.1
"""Largest distance (mm) between the ends of the strokes of an arrowhead and of its line."""
ALIKE = 0.15
"""Largest relative difference in length and angle between the strokes of one arrowhead."""


class Arrowheads(Record):
    """Masks: True for each line [M] that is a stroke of an arrowhead, and for each end [M, 2] that has one."""

    strokes: np.ndarray
    heads: np.ndarray


def arrowheads(lines: Lines) -> Arrowheads:
    """Return the arrowheads among lines [M, 2] (mm); a single-sided head remains a line."""
    count = len(lines.ends)
    strokes, heads = np.zeros(count, dtype=bool), np.zeros(2 * count, dtype=bool)
    line, stroke = lines.touching
    length, angle = np.abs(lines.vectors), np.angle(lines.vectors[stroke] / lines.vectors[line])
    # The strokes begin exactly at the end that they mark, because the program snaps to it.
    at_end = np.abs(lines.points[line] - lines.points[stroke]) <= lines.reach
    slim = (np.abs(angle) >= SLIMMEST) & (np.abs(angle) <= WIDEST)
    kept = np.flatnonzero(slim & at_end & (length[stroke] < np.minimum(length[line], LONGEST * lines.error)))
    sides: dict[int, tuple[list[int], list[int]]] = {}
    for pair in kept:
        sides.setdefault(int(line[pair]), ([], []))[int(angle[pair] > 0)].append(int(pair))
    pairs: list[tuple[float, int, int, int]] = []
    for end, (right, left) in sides.items():
        for first in right:
            for second in left:
                a, b = int(stroke[first]), int(stroke[second])
                if abs(lines.points[a] - lines.points[b]) > SNAPPED:
                    continue
                alike = abs(length[a] - length[b]) <= ALIKE * max(length[a], length[b])
                if alike and abs(angle[first] + angle[second]) <= ALIKE * abs(angle[first] - angle[second]) / 2:
                    off = abs(lines.points[end] - (lines.points[a] + lines.points[b]) / 2)
                    pairs.append((float(off), end, a, b))
    # If several ends meet at a tip, the head belongs to the closest. A line with a head is not a stroke of another one.
    headed: set[int] = set()
    tips: dict[tuple[int, int], float] = {}
    for off, end, a, b in sorted(pairs):
        if (
            (lines.pieces[a % count] | lines.pieces[b % count]) & headed
            or strokes[end % count]
            or off > tips.get((a, b), off) + SNAPPED
        ):
            continue
        tips.setdefault((a, b), off)
        heads[end] = True
        headed |= lines.pieces[end % count]
        strokes[[a % count, b % count]] = True
    return Arrowheads(strokes, heads.reshape(2, count).T)
