"""Case → page: the report for a browser, what moves above it."""

from __future__ import annotations

from reportgen.page import html
from reportgen.page.html import Live, Panel
from reportgen.report import Document
from reportgen.report.case import Case


def moving_part(case: Case) -> Panel | None:
    """What moves on the page of a case, if anything does."""
    film = case.film()
    if film is None:
        return None
    from reportgen.page.panel import panel as panel_of

    return panel_of(film, case.assignment.language, case.words["page"])


def page(case: Case, document: Document | None = None, live: Live | None = None) -> str:
    """The whole page of a case, of its `document` if that is composed already."""
    return html.write(document or case.document(), case.words["page"], moving_part(case), live)
