"""The legend of lines: a sample of each pen with what it stands for."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.figures import style
from reportgen.figures.draft import Draft, finish
from reportgen.figures.scene import Arrow, Item, Label, Line, Scene, Stroke

LINES: tuple[tuple[str, Stroke], ...] = (
    ("link", style.HEAVY),
    ("other", style.THIN),
    ("axis", style.AXIS),
    ("construction", style.CONSTRUCTION),
    ("path", style.PATH),
    ("normal", style.NORMAL),
)
"""Lines of the mechanism and of constructions, by the names of their words."""
ARROWS: tuple[tuple[str, Stroke], ...] = (
    ("known", style.KNOWN),
    ("relative", style.RELATIVE),
    ("found", style.FOUND),
    ("load", style.ACTIVE),
    ("reaction", style.REACTION),
    ("new", style.NEW),
)
"""Vectors of plans, forces on links, and what a step of a construction adds."""
SAMPLE, COLUMN, ROW, GAP = 18.0, 76.0, 6.5, 2.5
"""Length of a sample, from one column to the next, from one row to the next, between a sample and its words; mm."""


def line_styles(words: Mapping[str, str]) -> Scene:
    """Two columns of samples, lines and arrows; `words` has the text of each by its name."""
    items: list[Item] = []
    for column, pens in enumerate((LINES, ARROWS)):
        for row, (name, pen) in enumerate(pens):
            start = complex(column * COLUMN, -row * ROW)
            end = start + SAMPLE
            items.append(Arrow(start, end, pen, style.HEAD) if pens is ARROWS else Line(start, end, pen))
            items.append(Label(end + GAP, words[name], "left", style.LABEL))
    return finish(Draft(tuple(items)), margin=2.0)
