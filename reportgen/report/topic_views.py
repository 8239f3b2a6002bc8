"""Names, figures, tables and passages that topics add to a machine's report (`ViewHooks`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from reportgen.base.records import Record, field
from reportgen.base.topics import HookModule
from reportgen.document.figure_placement import FigureScenes
from reportgen.report.context import ReportContext

Passages = Callable[[ReportContext], Sequence[str]]
"""Function that returns the template sections a topic inserts at a place of a shared chapter; none if it has nothing to
say.
"""
DrawnFigure = tuple[str, Callable[..., FigureScenes]]
"""The beginning of a figure's keys, and the function that draws it."""


def always(*sections: str) -> Passages:
    """Return passages that appear whenever the machine has the topic."""
    return lambda report: sections


def _no_residuals(report: ReportContext) -> Mapping[str, float]:
    return {}


class ViewHooks(Record):
    """Names that a topic adds to the templates of a machine's report, by kind of name."""

    values: Mapping[str, Callable[[ReportContext], object]] = field(default_factory=dict)
    functions: Mapping[str, Callable[..., object]] = field(default_factory=dict)
    figures: Mapping[str, DrawnFigure] = field(default_factory=dict)
    tables: Mapping[str, Callable[..., object]] = field(default_factory=dict)
    passages: Mapping[str, Passages] = field(default_factory=dict)
    """Passages that the topic adds to shared chapters, by the names of the places there."""
    residuals: Callable[[ReportContext], Mapping[str, float]] = _no_residuals
    """Function that returns the largest residual of each independent check as a share of the greatest value."""
    letters: str = ""
    """Letters in diagrams that do not denote a quantity of the machine."""


VIEWS = HookModule("views", ViewHooks)


def passages(report: ReportContext, place: str) -> list[str]:
    """Return the template sections that the topics of a machine insert at a place of a shared chapter."""
    named = (hooks.passages[place](report) for hooks in VIEWS.among(report.machine.topics) if place in hooks.passages)
    return [section for sections in named for section in sections]


def merged(report: ReportContext, part: Callable[[ViewHooks], Mapping[str, Any]]) -> dict[str, Any]:
    """Return one part of the hooks of all topics of a machine, merged into one table."""
    return _united(part(hooks) for hooks in VIEWS.among(report.machine.topics))


def _united(tables: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    return {name: of for table in tables for name, of in table.items()}
