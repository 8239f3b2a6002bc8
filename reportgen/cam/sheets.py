"""The drawing sheets of a cam: motion, S–S′ diagram, pressure angle and profile on one, the profile alone in true size.

The second sheet has nothing but the profile 1:1 on layers of its own, as a machine that cuts it needs it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from reportgen.base.units import MM
from reportgen.cam.diagrams import law_diagrams, pressure_chart
from reportgen.cam.drawings import inversion, limit_diagram
from reportgen.cam.profile import Cam
from reportgen.cam.solved import SolvedCam
from reportgen.drawing import Circle, Item, Line, Pen, Polyline, Scene, style
from reportgen.drawing.sheet import ENLARGED, DrawingSheet, PlacedScene, lettered
from reportgen.sheets import on_sheets
from reportgen.sheets.packing import DrawingPlate

CHORD = 1e-6
"""How far the polyline of the profile may lie from the curve (m)."""
MARGIN = 15.0
"""White around the profile that is cut (mm)."""
TURN = 1.2
"""A turn of the diagrams is so many times as long as in a report,"""
LIMITS_ROOM, PROFILE_ROOM = 58 + 50j, 86 + 92j
"""and diagrams of limits and profiles fill no more than this (mm) before they are enlarged as all figures of sheets."""
AXES = Pen(0.18, "#6b6b6b", (5.0, 1.0, 0.8, 1.0))


def drawing_sheets(case: SolvedCam, size: str = "", block: Path | None = None) -> list[DrawingSheet]:
    """The sheet of its plates, and the profile alone; raises `AssignmentError` as `on_sheets` does."""
    return [*on_sheets(case, {"cam": list(_plates(case))}, size, block), _true_size(case.solution.cam)]


def _plates(case: SolvedCam) -> Iterator[DrawingPlate]:
    """Diagrams of the motion, of the limits and of the pressure angle, the construction of the profile, the cam."""
    found = case.solution.designed
    yield _plate(case, "law", "curves", law_diagrams(case, TURN / ENLARGED, ENLARGED))
    if found.least is not None and not found.cam.flat:
        yield _plate(case, "limits", "scheme", limit_diagram(case, LIMITS_ROOM, ENLARGED))
    yield _plate(case, "inversion", "positions", inversion(case, "profile by inversion", PROFILE_ROOM, ENLARGED))
    yield _plate(case, "profile", "profile", inversion(case, "cam", PROFILE_ROOM, ENLARGED))
    if not found.cam.flat:
        yield _plate(case, "pressure", "curves", pressure_chart(case, half=True).scene)


def _plate(case: SolvedCam, name: str, layer: str, scene: Scene) -> DrawingPlate:
    """A figure as sheets show it, scales round once it is enlarged; its name is the caption in the report."""
    return DrawingPlate(str(case.words["cam"]["captions"][f"figure-{name}"]), (), layer, (lettered(scene),))


# --- the profile that is cut ------------------------------------------------------------------------


def contour(cam: Cam) -> np.ndarray:
    """The profile (m) as corners of a closed polyline that lies within `CHORD` of it: an arc's sagitta is s²/8ρ."""
    count = 720
    points = cam.outline(count)
    while _sagitta(points) > CHORD and count < 50_000:
        count *= 2
        points = cam.outline(count)
    return points


def _sagitta(points: np.ndarray) -> float:
    """How far the curve is from its chords at most, by the turning at each corner."""
    chords = np.diff(np.append(points, points[0]))
    turned = np.abs(np.angle(np.roll(chords, -1) / chords))
    # Corners that are meant turn by much.
    smooth = turned < 0.1
    return float((np.abs(chords) * np.tan(turned / 4) / 2)[smooth].max(initial=0.0))


def _true_size(cam: Cam) -> DrawingSheet:
    """The profile 1:1 with its axes, on paper as large as it needs."""
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
    parts = (
        PlacedScene("axes", "axes", Scene(size.real, size.imag, axes)),
        PlacedScene("profile", "profile", Scene(size.real, size.imag, (profile,))),
    )
    return DrawingSheet("1:1", size.real, size.imag, parts)
