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

TRIALS = np.radians([-20.0, -12.0, -4.0, 4.0, 12.0, 20.0])
"""Angles (rad) of the first leg from where it is assembled, at which points of the template curve are drawn."""
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
        trials = _placed(outer, inner, TRIALS)
        path = _placed(outer, inner, np.linspace(TRIALS[0], TRIALS[-1], BETWEEN))[2]
        curve = TemplateCurve(outer, inner, trials, path)
        look = looks(report, scale, factor)
        return template_curve(report.machine.linkage, report.analysis.motion, k - 1, scale, curve, look)

    return as_large_as_asked(report, draw)


def _placed(outer: list[complex], inner: list[complex], angles: np.ndarray) -> Complexes:
    """Return the joints of the plate [3, N] with the first leg turned by some angles; unreachable ones are left out."""
    d, e, f = inner
    first = outer[0] + (d - outer[0]) * np.exp(1j * angles)
    side = 1 if ((outer[1] - d).conjugate() * (e - d)).imag > 0 else -1
    with np.errstate(invalid="ignore"):
        second = circle_circle(first, abs(e - d), outer[1], abs(e - outer[1]), side)
    third = first + (f - d) / (e - d) * (second - first)
    places: Complexes = np.array([first, second, third])
    return places[:, np.isfinite(second)]
