"""The drawing sheets of a cam: motion, S–S′ diagram, pressure angle and profile on one, the profile alone in true size.

The second sheet has nothing but the profile 1:1 on layers of its own, as a machine that cuts it needs it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from reportgen.cam.diagrams import law_diagrams, pressure_chart
from reportgen.cam.drawings import inversion, limit_diagram
from reportgen.cam.profile import Cam
from reportgen.cam.solved import SolvedCam
from reportgen.drawing.sheet import ENLARGED, DrawingSheet
from reportgen.sheets.columns import Plate, in_columns, titled, true_size

USUAL_SIZES = ("A2", "A1", "A0")
CHORD = 1e-6
"""How far the polyline of the profile may lie from the curve (m)."""
LARGER = {"A3": 0.7, "A2": 1.0, "A1": 1.4, "A0": 2.0}
"""How many times as large plates are on a sheet as on one of size A2."""
TURN = 1.2
"""There the turn of the diagrams is so many times as long as in a report,"""
LIMITS_ROOM, PROFILE_ROOM = 58 + 50j, 86 + 92j
"""and diagrams of limits and profiles fill no more than this (mm) before they are enlarged as all figures of sheets."""
PROFILES = (2.0, 1.6, 1.25, 1.0, 0.75)
"""So many times as large profiles are tried."""


def drawing_sheets(case: SolvedCam, size: str = "", block: Path | None = None) -> list[DrawingSheet]:
    """The sheet of a size, else of the file's, else of the least that has room, and the profile in true size.

    Raises `SheetError` where the plates have no room.
    """
    wanted = size or case.assignment.report.sheets or ""

    def drawn(paper: str) -> Iterator[Iterable[Plate]]:
        return (_plates(case, LARGER[paper], share) for share in PROFILES)

    title = str(case.words["cam"]["sheet"])
    sheet = in_columns(case, title, (wanted,) if wanted else USUAL_SIZES, block, drawn, "cam_sheet")
    return [sheet, true_size(contour(case.solution.cam))]


def _plates(case: SolvedCam, larger: float, share: float) -> Iterator[Plate]:
    """Name, layer and drawing of each plate, as they are set in columns; scales are round once plates are enlarged."""
    captions = case.words["cam"]["captions"]
    rooms = larger * LIMITS_ROOM, share * larger * PROFILE_ROOM
    yield "law", "curves", titled(law_diagrams(case, larger * TURN / ENLARGED), str(captions["figure-law"]))
    if not case.solution.cam.flat and case.solution.designed.least is not None:
        yield "limits", "scheme", titled(limit_diagram(case, rooms[0], ENLARGED), str(captions["figure-limits"]))
    yield (
        "inversion",
        "positions",
        titled(inversion(case, rooms[1], True, ENLARGED), str(captions["figure-inversion"])),
    )
    yield "profile", "profile", titled(inversion(case, rooms[1], False, ENLARGED), str(captions["figure-profile"]))
    if not case.solution.cam.flat:
        chart = pressure_chart(case, half=larger <= 1.0)
        yield "pressure", "curves", titled(chart.scene, str(captions["figure-pressure"]))


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
