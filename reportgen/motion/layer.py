"""Page layer of the true motion: steady running, start and stop in time, the working point of the drive."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reportgen.drawing.animation import Chart, Curve, TimedRun, Track
from reportgen.motion.curves import characteristic_chart
from reportgen.motion.steady_running import MotionRun
from reportgen.motion.true_motion import motion_in
from reportgen.page.topic_layers import LayerHooks
from reportgen.report.context import ReportContext

MOST = 1500
"""Largest number of samples of a run on the page; its angle is interpolated linearly in time between them."""


def timed_runs(report: ReportContext) -> tuple[TimedRun, ...]:
    """Return the motions that a page plays in time; steady running includes the flywheel if start and stop do."""
    motion = motion_in(report.analysis)
    runs = {"steady": motion.states[motion.main_state].run}
    if motion.started is not None:
        runs["start"] = motion.started.run
    if motion.stopped is not None:
        runs["stop"] = motion.stopped
    return tuple(_timed(key, run) for key, run in runs.items())


def _timed(key: str, run: MotionRun) -> TimedRun:
    last = len(run.angle) - 1
    step = max(-(-last // MOST), 1)
    kept = np.unique(np.append(np.arange(0, last, step), last))
    return TimedRun(key, run.time[kept], np.degrees(run.angle[kept]), run.speed[kept], run.drive[kept])


def working_point(report: ReportContext) -> Iterator[Chart]:
    """Yield the characteristic with the moving working point of the drive; nothing for a constant torque."""
    motion = motion_in(report.analysis)
    if motion.drive.governs:
        symbol = report.ledger.symbol("run.Md")
        plotted = characteristic_chart(report, half=True)
        yield Chart(plotted, (Curve(symbol, Track(np.zeros(1))),), of_run=True)


HOOKS = LayerHooks(runs=timed_runs, charts=working_point)
