"""The own machine of a student, moving: its drawing and the paths of its points, without any value to be found."""

from __future__ import annotations

from pathlib import Path

from reportgen import document as tree
from reportgen.base.records import replace
from reportgen.cases import open_case
from reportgen.drawing.animation import Animation
from reportgen.page import html
from reportgen.page.animation_panel import panel
from reportgen.page.live_view import NOBODY

SHOWN = frozenset({"", "paths"})
"""Layers that answer nothing."""


def moving_machine(path: Path) -> str:
    """Return the page of an assignment's machine; an empty page if nothing moves."""
    case = open_case(path)
    language = case.assignment.language
    bare = [made for animation in case.animations() if (made := _bare(animation)) is not None]
    panels = [panel(animation, language, case.words) for animation in bare]
    words = tree.Words.among(case.words, language)
    empty = tree.Document(language, NOBODY, "", ("", ""), ("", ""), words)
    return html.write(empty, case.words["page"], panels)


def _bare(animation: Animation) -> Animation | None:
    """Return an animation with the drawing of the machine alone; None if that itself is an answer."""
    machine = next((pane for pane in animation.panes if pane.key == "machine"), None)
    if machine is None:
        return None
    items = tuple(item for item in machine.items if item.layer in SHOWN)
    scales = tuple(scale for scale in machine.scales if not scale.layers)
    pane = replace(machine, items=items, scales=scales, spots=())
    return replace(animation, panes=(pane,), charts=(), values=(), layers=("paths",), runs=())
