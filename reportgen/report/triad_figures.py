"""Figures of groups of class III: the special point of two legs, the assembly by the template curve."""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.document.figure_placement import FigureScenes
from reportgen.drawing import Scene
from reportgen.drawing.template_curve import TemplateCurve, special_point, template_curve
from reportgen.formula.constructions import circle_circle
from reportgen.report.context import ReportContext
from reportgen.report.mechanism_figures import as_large_as_asked, drawing_scale, looks
from reportgen.report.triad_views import TriadView

TRIALS = np.radians([-15.0, -9.0, -3.0, 3.0, 9.0, 15.0])
"""Angles (rad) of the plate from where it is assembled, at which points of the template curve are drawn."""
CLOSE = 1e-9
"""Relative distance within which a joint is on its arc."""
BETWEEN = 61
"""Points of the template curve itself."""


def special(report: ReportContext, k: int, group: TriadView) -> FigureScenes:
    """Draw the mechanism at a position at the scale μ_l, with the special point where the lines of two legs meet."""

    def draw(factor: float) -> Scene:
        scale = drawing_scale(report) * factor
        at = report.place(group.S, k) * scale
        on_lines = [str(leg.Q) for leg in group.pair]
        measured = [*on_lines, str(group.third.Q)]
        return special_point(
            report.machine.linkage,
            report.analysis.motion,
            k - 1,
            scale,
            special=(str(group.S), at),
            joints=(on_lines, measured),
            looks=looks(report, scale, factor),
        )

    return as_large_as_asked(report, draw)


def assemblies(report: ReportContext, k: int, group: TriadView) -> FigureScenes:
    """Draw the assembly of a group at a position: two joints on their arcs, the template curve of the third one."""

    def draw(factor: float) -> Scene:
        scale = drawing_scale(report) * factor
        outer = [report.place(leg.P, k) * scale for leg in group.legs]
        inner = [report.place(leg.Q, k) * scale for leg in group.legs]
        trials = placed(outer, inner, TRIALS)
        path = placed(outer, inner, np.linspace(TRIALS[0], TRIALS[-1], BETWEEN))[2]
        curve = TemplateCurve(outer, inner, trials, path)
        look = looks(report, scale, factor)
        return template_curve(report.machine.linkage, report.analysis.motion, k - 1, scale, curve, look)

    return as_large_as_asked(report, draw)


def placed(outer: list[complex], inner: list[complex], angles: np.ndarray) -> Complexes:
    """Return the joints of the plate [3, N] with the plate turned by some angles and the first two on their arcs.

    Angles at which the first two legs do not reach are left out.
    """
    d, e, f = inner
    turn = np.exp(1j * angles)
    # Seen from the first joint, the second one runs on an arc about a centre moved by the plate's side.
    centre = outer[1] - (e - d) * turn
    radii = abs(d - outer[0]), abs(e - outer[1])
    side = 1 if ((outer[1] - (e - d) - outer[0]).conjugate() * (d - outer[0])).imag > 0 else -1
    with np.errstate(invalid="ignore"):
        first = circle_circle(outer[0], radii[0], centre, radii[1], side)
        reached = np.abs(np.abs(first - centre) - radii[1]) < CLOSE * radii[1]
    places: Complexes = np.array([first, first + (e - d) * turn, first + (f - d) * turn])
    return places[:, reached]
