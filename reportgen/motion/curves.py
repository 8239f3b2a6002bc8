"""Curves of the true motion of a machine, for its chapter and for the drawing sheet on dynamics."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.base.stable_digits import ALIKE
from reportgen.document.figure_placement import FigureScenes
from reportgen.drawing import Content, Diagram, PlottedCurve, Scene, charts
from reportgen.drawing.geometry import moved
from reportgen.formula import Chain, Symbol
from reportgen.motion import run_ids
from reportgen.motion.steady_running import MotionRun
from reportgen.motion.true_motion import TrueMotion, motion_in
from reportgen.report.context import ReportContext
from reportgen.report.cycle_curves import axis

THINNED = 3
"""Curves use every third sample."""
BEYOND = 1.15
"""End of the drawn characteristic, as a multiple of the speed of the fastest working point."""
DRAWN = 241
MOST = 4000
"""Largest number of samples in a curve of a long start or stop."""
SEEN = 0.15
"""Smallest share of the distance from the origin that a loop must cover to be visible together with the origin."""

Curve = tuple[Symbol | str, np.ndarray, np.ndarray]


def motion_of(report: ReportContext) -> TrueMotion:
    return motion_in(report.analysis)


def _thinned(run: MotionRun) -> np.ndarray:
    last = len(run.angle) - 1
    kept = np.unique(np.concatenate((np.arange(0, last, THINNED), run.at, [last])))
    return np.asarray(kept)


def _over_angle(report: ReportContext) -> Content:
    return Chain((Symbol("φ"),), report.words["figure"]["cycle_angle"])


def _axis_of(report: ReportContext, id: str) -> Chain:
    return axis(report, report.ledger.symbol(id), report.ledger[id].kind)


def _chart(report: ReportContext, curves: Sequence[Curve], across: Content, up: Content, **how: Any) -> Scene:
    return _plotted(report, curves, across, up, **how).scene


def _plotted(
    report: ReportContext,
    curves: Sequence[Curve],
    across: Content,
    up: Content,
    *,
    turn: bool = True,
    half: bool = False,
    zero: bool = True,
    levels: tuple[tuple[float, Symbol], ...] = (),
) -> charts.Plotted:
    drawn = tuple(PlottedCurve(name, x, y) for name, x, y in curves)
    diagram = Diagram(drawn, across, up, turn=turn, levels=levels, zero=zero)
    return charts.plotted(diagram, half=half, area=report.area)


def _steady_curves(report: ReportContext, id: str, values: str) -> list[Curve]:
    motion = motion_of(report)
    curves: list[Curve] = []
    for state, steady in motion.states.items():
        run, kept = steady.run, _thinned(steady.run)
        symbol = report.ledger.symbol(run_ids.in_state(id, state))
        curves.append((symbol, np.degrees(run.angle[kept]), getattr(run, values)[kept]))
    return curves


def inertia(report: ReportContext) -> FigureScenes:
    """Draw J_r and its slope over the cycle, if they exist."""
    run = motion_of(report).alone.run
    kept = _thinned(run)
    angle, own = np.degrees(run.angle[kept]), motion_of(report).asked.inertia
    across = _over_angle(report)
    every = ((run.inertia - own, "J.r"), (run.slope, "run.dJ"))
    drawings = [(values, id) for values, id in every if id in report.ledger]
    scenes = (
        _chart(report, [("", angle, values[kept])], across, _axis_of(report, id), half=True) for values, id in drawings
    )
    return FigureScenes(tuple(scenes))


def speed(report: ReportContext) -> FigureScenes:
    """Draw ω over the cycle, without and with the flywheel, with the mean of its bounds."""
    mean = report.ledger.number("run.mean").value
    level = ((mean, report.ledger.symbol("run.mean")),)
    curves, up = _steady_curves(report, "omega", "speed"), _axis_of(report, "run.omega")
    return FigureScenes((_chart(report, curves, _over_angle(report), up, zero=False, levels=level),))


def acceleration(report: ReportContext) -> FigureScenes:
    """Draw ε over the cycle, without and with the flywheel."""
    curves = _steady_curves(report, "eps", "acceleration")
    return FigureScenes((_chart(report, curves, _over_angle(report), _axis_of(report, "run.eps")),))


def torques(report: ReportContext) -> FigureScenes:
    """Draw M_r and the torque of the drive over the cycle."""
    run = motion_of(report).alone.run
    kept = _thinned(run)
    angle = np.degrees(run.angle[kept])
    curves = [
        (report.ledger.symbol("M.r"), angle, run.torque[kept]),
        (report.ledger.symbol("run.Md"), angle, run.drive[kept]),
    ]
    return FigureScenes((_chart(report, curves, _over_angle(report), _axis_of(report, "M.r")),))


def characteristic(report: ReportContext) -> FigureScenes:
    """Draw the torque of the drive over the speed, with the closed loop of the reduced torque of the loads."""
    return FigureScenes((characteristic_chart(report).scene,))


def characteristic_chart(report: ReportContext, half: bool = False) -> charts.Plotted:
    motion = motion_of(report)
    run = motion.alone.run
    kept = _thinned(run)
    speeds = np.linspace(0.0, BEYOND * float(run.speed.max()), DRAWN)
    loads = report.ledger.symbol("M.r")
    curves = [
        (report.ledger.symbol("run.Md"), speeds, motion.drive.torque(speeds)),
        (Symbol("−" + loads.base, loads.sub), run.speed[kept], -run.torque[kept]),
    ]
    across, up = _axis_of(report, "run.omega"), _axis_of(report, "run.Md")
    return _plotted(report, curves, across, up, turn=False, half=half)


def energy(report: ReportContext) -> FigureScenes:
    """Draw T over J: the closed loop between the lines T = ½ω²J of the greatest and the least speed."""
    motion = motion_of(report)
    steady = motion.alone
    run, kept = steady.run, _thinned(steady.run)
    low, high = float(run.inertia.min()), float(run.inertia.max())
    span = high - low
    if span <= ALIKE * high:
        # At a constant J the loop is upright: the share of T that it covers counts.
        span = high * (1 - float(run.energy.min()) / float(run.energy.max()))
    # A loop that would be a dot beside the origin fills the diagram; a single point has its line from the origin.
    begin = low - span / 4 if ALIKE * high < span < SEEN * high else 0.0
    ends = np.array([begin, high])
    curves: list[Curve] = [(Symbol("T"), run.inertia[kept], run.energy[kept])]
    for id, extreme in (("run.max", steady.fastest), ("run.min", steady.slowest)):
        curves.append((report.ledger.symbol(id), ends, extreme.speed**2 / 2 * ends))
    across = axis(report, Symbol("J"), "moment of inertia")
    up = _axis_of(report, "run.T")
    return FigureScenes((_chart(report, curves, across, up, turn=False, zero=begin == 0.0),))


def _of_run(report: ReportContext, run: MotionRun) -> FigureScenes:
    kept = _thinned(run)
    kept = kept[:: -(-len(kept) // MOST)] if len(kept) > MOST else kept
    kept = np.append(kept[kept < len(run.angle) - 1], len(run.angle) - 1)
    up, time = _axis_of(report, "run.omega"), axis(report, Symbol("t"), "time")
    over_angle = _chart(
        report, [("", np.degrees(run.angle[kept]), run.speed[kept])], _over_angle(report), up, half=True
    )
    over_time = _chart(report, [("", run.time[kept], run.speed[kept])], time, up, turn=False, half=True)
    return FigureScenes((over_angle, over_time))


def starting(report: ReportContext) -> FigureScenes:
    """Draw ω over φ and t from rest."""
    started = motion_of(report).started
    assert started is not None, "a start is drawn where it is asked for"
    return _of_run(report, started.run)


def stopping(report: ReportContext) -> FigureScenes:
    """Draw ω over φ and t to the stop."""
    stopped = motion_of(report).stopped
    assert stopped is not None, "a stop is drawn where it is asked for"
    return _of_run(report, stopped)


def sheet(report: ReportContext) -> Iterator[Scene]:
    """Yield torques, work, reduced inertia, speed and acceleration one below another over φ, and the energy beside
    them.
    """
    motion = motion_of(report)
    run = motion.alone.run
    kept = _thinned(run)
    angle = np.degrees(run.angle[kept])
    work: list[Curve] = [("", angle, run.energy[kept] - run.energy[0])]
    mass: list[Curve] = [("", angle, run.inertia[kept] - motion.asked.inertia)]
    load, driven = report.ledger.symbol("M.r"), report.ledger.symbol("run.Md")
    torques: list[Curve] = [(load, angle, run.torque[kept]), (driven, angle, run.drive[kept])]
    drawn = [(torques, "M.r", True), (work, "run.A", True)]
    drawn += [(mass, "J.r", True)] if report.has_reduced_inertia else []
    drawn += [(_steady_curves(report, "omega", "speed"), "run.omega", False)]
    drawn += [(_steady_curves(report, "eps", "acceleration"), "run.eps", True)]
    yield _one_below_another(
        [_plotted(report, of, _over_angle(report), _axis_of(report, id), zero=zero) for of, id, zero in drawn]
    )
    yield from energy(report).scenes


def _one_below_another(plots: Sequence[charts.Plotted]) -> Scene:
    """Return the charts with their frames one below another."""
    left = max(plot.low.real for plot in plots)
    height = sum(plot.scene.height for plot in plots)
    width = max(left - plot.low.real + plot.scene.width for plot in plots)
    items, top = [], height
    for plot in plots:
        top -= plot.scene.height
        items += [moved(item, complex(left - plot.low.real, top)) for item in plot.scene.items]
    description = tuple(said for plot in plots for said in plot.scene.description)
    return Scene(width, height, tuple(items), margin=plots[0].scene.margin, description=description)


FIGURES: Mapping[str, tuple[str, Callable[..., FigureScenes]]] = {
    "run-inertia": ("fig.run.J", inertia),
    "run-torques": ("fig.run.M", torques),
    "run-speed": ("fig.run.omega", speed),
    "run-acceleration": ("fig.run.eps", acceleration),
    "run-characteristic": ("fig.run.drive", characteristic),
    "run-energy": ("fig.run.T", energy),
    "run-start": ("fig.run.start", starting),
    "run-stop": ("fig.run.stop", stopping),
}
