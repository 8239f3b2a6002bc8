"""Arrowheads among the lines of a drawing: two short strokes, or two sides of a triangle, about the end of a line.

However they were drawn, they say where a vector ends, and they are no vectors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reportgen.handin.line_set import Lines

SLIMMEST, WIDEST = np.radians(3.0), np.radians(50.0)
"""The angles that a stroke of an arrowhead may have with its line."""
LONGEST = 16.0
"""A stroke is no longer than so many errors of an end (8 mm): an arrowhead is small, and vectors may lie alike."""
SNAPPED = 0.1
"""The strokes of an arrowhead, and the line that has it, end no farther from one another (mm)."""
ALIKE = 0.15
"""The strokes of one arrowhead differ in length and angle by no more than this share."""


@dataclass(frozen=True)
class Arrowheads:
    """Which lines [M] are strokes of arrowheads, and whether each end [M, 2] of a line has one."""

    strokes: np.ndarray
    heads: np.ndarray


def arrowheads(lines: Lines) -> Arrowheads:
    """The arrowheads of a drawing.  Lines that one side of a head alone belongs to stay lines."""
    count = len(lines.ends)
    strokes, heads = np.zeros(count, dtype=bool), np.zeros(2 * count, dtype=bool)
    line, stroke = lines.touching
    length, angle = np.abs(lines.ways), np.angle(lines.ways[stroke] / lines.ways[line])
    # The strokes begin at the very end that they mark, as the program snaps to it.
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
    # Of several ends about a tip it is of that which it was drawn at; a line that has one is no stroke of another one.
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
