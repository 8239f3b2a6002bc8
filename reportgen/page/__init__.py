"""Make the browser page of a case, its animations above its report: `page` returns the HTML."""

from __future__ import annotations

from reportgen.case import Case, bounded
from reportgen.document import Document
from reportgen.page import html
from reportgen.page.html import Live, Panel


def panels(case: Case) -> tuple[Panel, ...]:
    """Return the animated panels of a case's page: one for the machine, one for each part that follows it."""
    animations = case.animations()
    if not animations:
        return ()
    from reportgen.page.animation_panel import panel

    return tuple(panel(animation, case.assignment.language, case.words) for animation in animations)


def page(case: Case, document: Document | None = None, live: Live | None = None) -> str:
    """Return the whole page of a case as HTML; `document` is its report if that is already composed."""
    tree = document or case.document()
    return bounded(case.assignment, html.write, tree, case.words["page"], panels(case), live)
