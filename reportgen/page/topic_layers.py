"""Hooks by which a topic adds layers, runs, charts and numbers to the animated page of a machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.topics import HookModule
from reportgen.drawing.animation import BarScale, Chart, MovingItem, TimedRun
from reportgen.formula import Symbol
from reportgen.machine.analysis import Analysis
from reportgen.machine.kinematics import Motion
from reportgen.report.context import ReportContext

Box = tuple[complex, complex]
"""The lower left and the upper right corner of a drawing (mm)."""
Chosen = Callable[[str, Callable[[], float]], float]
"""Returns a number that is chosen once for a page, by its name."""


def _no_items(report: ReportContext, analysis: Analysis, scale: float, per: float, turn: int) -> Iterator[MovingItem]:
    yield from ()


def _no_items_with_bars(
    report: ReportContext, motion: Motion, scale: float, longest: float, chosen: Chosen
) -> tuple[Sequence[MovingItem], Sequence[BarScale]]:
    return (), ()


def _no_more_room(report: ReportContext, motion: Motion, scale: float, box: Box) -> Box:
    return box


def _no_runs(report: ReportContext) -> Sequence[TimedRun]:
    return ()


def _no_charts(report: ReportContext) -> Iterator[Chart]:
    yield from ()


def _no_values(report: ReportContext, motion: Motion) -> Iterator[tuple[Symbol, str, np.ndarray]]:
    yield from ()


class LayerHooks(Record):
    """The layers, charts, runs and numbers of a topic on the page.

    `with_forces(report, analysis, scale, per, turn)` yields items at the samples: `scale` is mm per metre, `per`
    newtons per mm, and the first `turn` samples are one turn. `with_bars` gives items over one turn with bars of their
    own scale.
    """

    layers: tuple[str, ...] = ()
    """The layers of the topic."""
    force_layers: tuple[str, ...] = ()
    """Layers whose arrows have the scale of the forces."""
    with_forces: Callable[[ReportContext, Analysis, float, float, int], Iterator[MovingItem]] = _no_items
    with_bars: Callable[
        [ReportContext, Motion, float, float, Chosen], tuple[Sequence[MovingItem], Sequence[BarScale]]
    ] = _no_items_with_bars
    room: Callable[[ReportContext, Motion, float, Box], Box] = _no_more_room
    """Returns the corners of a drawing that also has room for the items."""
    runs: Callable[[ReportContext], Sequence[TimedRun]] = _no_runs
    charts: Callable[[ReportContext], Iterator[Chart]] = _no_charts
    values: Callable[[ReportContext, Motion], Iterator[tuple[Symbol, str, np.ndarray]]] = _no_values


LAYERS = HookModule("layer", LayerHooks)
