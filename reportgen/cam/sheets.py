"""Drawing sheets of a cam: one with motion, S–S′ diagram, pressure angle and construction, one with the profile 1:1.

The second sheet has only the profile on separate layers, as a cutting machine needs it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from reportgen.base.units import MM
from reportgen.cam.diagrams import DEGREES_PER_MM, law_diagrams, pressure_chart
from reportgen.cam.drawings import inversion, limit_diagram
from reportgen.cam.profile import Cam
from reportgen.cam.solution import SolvedCam
from reportgen.drawing import Circle, Item, Line, Pen, Polyline, Scene, style
from reportgen.drawing.charts import Area
from reportgen.drawing.drawing_description import PaperLength, fact
from reportgen.drawing.drawing_sheet import DrawingSheet, PlacedScene, lettered
from reportgen.drawing.figure_scale import FigureSize
from reportgen.drawing.plates import MOST_STEPS, DrawingPlate, enlargeable
from reportgen.sheets.plates import on_sheet

CHORD = 1e-6
"""Largest distance of the profile's polyline from the curve (m)."""
MARGIN = 15.0
"""Margin around the profile that is cut (mm)."""
AREAS = ((90.0, 45.0), (144.0, 64.0), (180.0, 80.0))
"""Areas of the curve of the pressure angle (mm), the smallest first."""
AXES = Pen(0.18, "#6b6b6b", (5.0, 1.0, 0.8, 1.0))


def plates(case: SolvedCam) -> Iterator[DrawingPlate]:
    """Yield diagrams of the motion, the limits and the pressure angle, the construction of the profile, and the cam."""
    design = case.solution.designed

    def pressure(case: SolvedCam, size: FigureSize) -> Scene:
        return pressure_chart(
            case, area=Area(*AREAS[size.steps], size.enlarged, mm=case.ledger.printed_unit("mm"))
        ).scene

    drawn: list[tuple[str, str, Callable[[SolvedCam, FigureSize], Scene], int]] = [
        ("law", "curves", law_diagrams, len(DEGREES_PER_MM) - 1),
        ("limits", "scheme", limit_diagram, MOST_STEPS),
        ("inversion", "positions", lambda case, size: inversion(case, "profile by inversion", size), MOST_STEPS),
        ("profile", "profile", lambda case, size: inversion(case, "cam", size), MOST_STEPS),
        ("pressure", "curves", pressure, len(AREAS) - 1),
    ]
    left_out = {"limits", "pressure"} if design.cam.flat else {"limits"} if design.least is None else set()
    for name, layer, draw, most in drawn:
        if name not in left_out:
            yield enlargeable(partial(_plate, case, name, layer, draw), most)


def _plate(
    case: SolvedCam, name: str, layer: str, draw: Callable[[SolvedCam, FigureSize], Scene], steps: int
) -> DrawingPlate:
    """Return a figure for a sheet, up to `steps` standard scales larger than in the report; its name is its caption."""
    scene = lettered(draw(case, on_sheet(case, steps)))
    return DrawingPlate(str(case.words["cam"]["captions"][f"figure-{name}"]), (), layer, (scene,))


# --- the profile that is cut ------------------------------------------------------------------------


def contour(cam: Cam) -> np.ndarray:
    """Return the profile (m) [N] as corners of a closed polyline within `CHORD` of it: an arc's sagitta is s²/8ρ."""
    count = 720
    points = cam.outline(count)
    while _sagitta(points) > CHORD and count < 50_000:
        count *= 2
        points = cam.outline(count)
    return points


def _sagitta(points: np.ndarray) -> float:
    """Return the largest distance of the curve from its chords, from the turning at each corner, in the unit of the
    points.
    """
    chords = np.diff(np.append(points, points[0]))
    turned = np.abs(np.angle(np.roll(chords, -1) / chords))
    # Intended corners turn by a large angle.
    smooth = turned < 0.1
    return float((np.abs(chords) * np.tan(turned / 4) / 2)[smooth].max(initial=0.0))


def true_size(cam: Cam) -> DrawingSheet:
    """Return the profile 1:1 with its axes, on paper as large as it needs."""
    points = contour(cam) * MM
    low = complex(points.real.min(), points.imag.min()) - MARGIN * (1 + 1j)
    high = complex(points.real.max(), points.imag.max()) + MARGIN * (1 + 1j)
    size = complex(math.ceil((high - low).real), math.ceil((high - low).imag))
    shift = -low
    axes: tuple[Item, ...] = (
        Line(complex(0, shift.imag), complex(size.real, shift.imag), AXES),
        Line(complex(shift.real, 0), complex(shift.real, size.imag), AXES),
        Circle(shift, 1.0, Pen(0.25)),
    )
    profile = Polyline(tuple(complex(p) for p in points + shift), style.HEAVY, closed=True, smooth=True)
    farthest = fact("profile", PaperLength(float(np.abs(points).max())))
    parts = (
        PlacedScene("axes", "axes", Scene(size.real, size.imag, axes)),
        PlacedScene("profile", "profile", Scene(size.real, size.imag, (profile,), description=(farthest,))),
    )
    return DrawingSheet("1:1", size.real, size.imag, parts)
