"""Fonts of a report: the one that its file asks for, and those that its language requires."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from reportgen.assignment import Assignment
from reportgen.assignment.reading import placed
from reportgen.base.errors import Finding
from reportgen.base.languages import setting_of
from reportgen.base.words import as_error
from reportgen.base.yaml_source import read_source

if TYPE_CHECKING:
    from reportgen.document.layout import Letter

Engine = Literal["typst", "latex"]


def letter_of(assignment: Assignment, engine: Engine) -> Letter:
    """Return the letter of a file; raise `AssignmentError` if the engine lacks its font or its language's."""
    from reportgen.document.layout import Letter

    if engine == "typst":
        letters_of(assignment)
    font = assignment.report.font or ""
    if font and font not in (known := _fonts(engine)):
        finding = Finding(
            "no-such-font", ("report", "font"), {"text": font, "engine": engine, "known": ", ".join(known)}
        )
        raise as_error(placed(read_source(assignment.source), [finding]), assignment.language)
    return Letter(font, float(assignment.report.size.removesuffix(" pt")))


def letters_of(assignment: Assignment) -> None:
    """Raise `AssignmentError`, at the language, if no font known to Typst has the letters of its script."""
    wanted = setting_of(assignment.language).typst.fonts
    if not wanted:
        return
    from reportgen.writers import typst_fonts

    if not typst_fonts.there_is_one_of(wanted):
        finding = Finding(
            "no-letters", ("report", "language"), {"text": assignment.language, "known": ", ".join(wanted)}
        )
        raise as_error(placed(read_source(assignment.source), [finding]), assignment.language)


def _fonts(engine: Engine) -> list[str]:
    """Return the font names that an engine knows."""
    if engine == "latex":
        from reportgen.writers import latex

        return list(latex.FAMILIES)
    from reportgen.writers import typst_fonts

    return typst_fonts.families()
