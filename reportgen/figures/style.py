"""The pens of all figures: black mechanism, two accents, gray construction lines."""

from __future__ import annotations

from reportgen.figures.scene import Stroke

BLACK, GRAY, PALE = "#000000", "#6b6b6b", "#a8a8a8"
BLUE, RED = "#123c7c", "#9c1c1c"
PAPER, TINT = "#ffffff", "#eef1f5"

VISIBLE = Stroke(0.35)
"""Outlines of links and curves."""
HEAVY = Stroke(0.5)
THIN = Stroke(0.15, GRAY)
"""Circles, guides, lines of projection."""
AXIS = Stroke(0.13, GRAY, (5.0, 1.0, 0.8, 1.0))
"""Axes of symmetry and of guides."""
CONSTRUCTION = Stroke(0.13, GRAY, (1.6, 1.0))
"""Auxiliary directions of a plan, which go a little beyond their end."""
LEADER = Stroke(0.1, GRAY)
KNOWN = Stroke(0.3)
RELATIVE = Stroke(0.3, BLUE)
FOUND = Stroke(0.3, RED, (2.4, 0.9))
"""A vector that a plan gives by closing; dashed, to be told apart without colour."""
ACTIVE = Stroke(0.3, BLUE)
REACTION = Stroke(0.3, RED)
NEW = Stroke(0.45, BLUE)
"""What a stage of a construction adds."""
OLD = Stroke(0.2, GRAY)
DIMENSION = Stroke(0.13)

HEAD, DIMENSION_HEAD = 2.6, 1.6
LABEL, SMALL = 9.0, 8.0
"""Font sizes in points, the second where labels are dense."""
