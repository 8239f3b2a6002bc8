"""Velocities by projection: two points of a body have one component along the line between them."""

from __future__ import annotations

from itertools import permutations

from reportgen.ledger.instant.board import Board, Projected, Vector
from reportgen.plane_motion.ways import perpendicular


def by_projection(board: Board) -> bool:
    """v_B cos β = v_A cos α for one more point B that moves along a known line, not across AB."""
    layout = board.layout
    for body, names in layout.members.items():
        if body in layout.centres and layout.centres[body].by_joint:
            continue
        for base, point in permutations(names, 2):
            if not board.knows(f"v.{base}") or board.knows(f"v.{point}") or point not in layout.ways:
                continue
            line = board.way(layout.points[point] - layout.points[base])
            if line and not perpendicular(layout.ways[point], line):
                whole = Vector(f"v.{point}", board.way(board.at(point)) or layout.ways[point])
                equation = Projected(board, (whole,), (board.velocity(base), Vector(f"v.{point}{base}", 1j * line)))
                equation.find(whole, line, "ξ", point)
                equation.step("projection", body, point, base)
                return True
    return False
