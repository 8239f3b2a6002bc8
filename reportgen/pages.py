"""Case → page: the report for a browser, the machine in motion above it.

An exercise has one instant: nothing on its page moves.
"""

from __future__ import annotations

from reportgen.case import Case, ExerciseCase
from reportgen.document.outline import compose
from reportgen.document.tree import Document
from reportgen.writers import html
from reportgen.writers.html import Live, Panel


def panel(case: Case | ExerciseCase) -> Panel | None:
    """What moves on the page of a case, if anything does."""
    if not isinstance(case, Case):
        return None
    from reportgen.document.moving import film
    from reportgen.writers import html_moving

    return html_moving.panel(film(case), case.assignment.language, case.words["page"])


def page(case: Case | ExerciseCase, document: Document | None = None, live: Live | None = None) -> str:
    """The whole page of a case, of its `document` if that is composed already."""
    return html.write(document or compose(case), case.words["page"], panel(case), live)
