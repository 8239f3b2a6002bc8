"""Write figures and curves of assignment files as separate files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from reportgen import catalogue
from reportgen.api import load
from reportgen.assignment import Assignment
from reportgen.base.errors import NotOfferedError
from reportgen.base.output_formats import chosen, names, usual
from reportgen.base.units import Language
from reportgen.base.words import word
from reportgen.case import Case
from reportgen.case.quantity_wording import phrase
from reportgen.cases import open_case, opened
from reportgen.document.named_figures import NamedFigure, safe
from reportgen.export import curves, figures, quantities
from reportgen.export.curves import Over
from reportgen.export.figures import FORMATS as FIGURE_FORMATS
from reportgen.export.figures import MOVING, MovingFigure
from reportgen.formula.plain_text import formula
from reportgen.writers import matplotlib_figures

__all__ = [
    "FIGURE_FORMATS",
    "MOVING",
    "PLOT_FORMATS",
    "figure_files",
    "figure_list",
    "plot_files",
    "plot_list",
    "worked_at",
]

PLOT_FORMATS = names("plots")
"""Formats of a plot."""


def figure_list(
    path: Path | str, language: Language | None = None
) -> tuple[tuple[NamedFigure, ...], tuple[MovingFigure, ...]]:
    """Return the figures of a file's report in order, and the moving figures of its page."""
    return figures.listed(open_case(path, language))


def figure_files(
    path: Path | str,
    names: Sequence[str] = (),
    at: str = "",
    formats: Sequence[str] = usual("figures"),
    dpi: int = 0,
    layers: Sequence[str] = ("paths",),
    language: Language | None = None,
) -> Mapping[str, bytes]:
    """Return figures as files in some of `FIGURE_FORMATS`, by name; all of the report unless `names` are given.

    With `at` (the label or the number of a position), that position is worked out, and of several drawings those that
    show it are chosen. Raises `UnknownNameError`, `NotOfferedError`, `TypesetterError`.
    """
    case = open_case(path, language)
    case, labels = worked_at(case.assignment, at) if at else (case, ())
    query = figures.FigureQuery(names, labels, formats, dpi, tuple(layers))
    return figures.figure_files(case, query)


def plot_list(path: Path | str, language: Language | None = None) -> tuple[tuple[str, str, str], ...]:
    """Return the id, the symbol with its unit, and the name in words of each quantity that can be plotted."""
    case = open_case(path, language)
    spoken = case.assignment.language
    listed = [quantities.quantity(case, id) for id in quantities.visible_ids(case)]
    return tuple(
        (
            source.id,
            f"{formula(source.family.symbol, spoken)} ({source.case.ledger.printed_unit(source.family.how.unit)})",
            phrase(source.id, source.case.ledger, source.case.words),
        )
        for source in listed
    )


def plot_files(
    paths: Sequence[Path],
    of: Sequence[str],
    over: Over = "phi",
    measured: Path | None = None,
    formats: Sequence[str] = usual("plots"),
    dpi: int = 220,
    language: Language | None = None,
) -> Mapping[str, bytes]:
    """Return quantities, given by their ids, as curves of each file, a chart for each unit, in some of `PLOT_FORMATS`.

    They are plotted over the driver's displacement or over time; a table of `measured` values is drawn as points.
    Raises `UnknownNameError`, `NotOfferedError`, and `AssignmentError`, also for the table.
    """
    cases = [opened(curves.dense(load(path, language))) for path in paths]
    curves.check_turning(cases)
    points = curves.read_measured(measured, cases[0], of) if measured is not None else ()
    spoken = cases[0].assignment.language
    made = {
        safe(name): matplotlib_figures.chart(diagram, spoken)
        for name, diagram in curves.diagrams(cases, of, over, points).items()
    }
    rows = chosen("plots", formats)
    return {
        f"{name}.{row.suffix}": row.load()(diagram, row.name, dpi) for name, diagram in made.items() for row in rows
    }


def worked_at(assignment: Assignment, at: str) -> tuple[Case, tuple[str, ...]]:
    """Return the case with one position worked out, and its labels: its own, and that of its place in a turn.

    Raises `UnknownNameError` if there is no such position, `NotOfferedError` for a kind without positions.
    """
    if not catalogue.kind(assignment.kind).has_positions:
        raise NotOfferedError(word("no_at", assignment.language, kind=assignment.kind))
    number = assignment.position(at)
    # What repeats from turn to turn is drawn once.
    turn = assignment.cycle_positions // assignment.turns
    labels = dict.fromkeys(assignment.labels[k] for k in (number - 1, (number - 1) % turn))
    return opened(assignment.with_worked(number)), tuple(labels)
