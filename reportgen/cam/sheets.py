"""The drawing sheets of a cam: motion, S–S′ diagram, pressure angle and profile on one, the profile alone in true size.

The second sheet has nothing but the profile 1:1 on layers of its own, as a machine that cuts it needs it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from reportgen.base.errors import SheetError
from reportgen.base.units import MM
from reportgen.base.words import word
from reportgen.cam.diagrams import law_diagrams, pressure_chart
from reportgen.cam.drawings import inversion, limit_diagram
from reportgen.cam.profile import Cam
from reportgen.cam.solved import SolvedCam
from reportgen.drawing import Circle, Item, Line, Pen, Polyline, Scene
from reportgen.drawing.sheet import ENLARGED, GAP, DrawingSheet, PlacedScene, Room, headed, lettered
from reportgen.sheets.frame import DEFAULT, SIZES, TitleBlock, blocks, fields_of, frame_scene, read_block, room

USUAL_SIZES = ("A2", "A1", "A0")
CHORD = 1e-6
"""How far the polyline of the profile may lie from the curve (m)."""
MARGIN = 15.0
"""White around the profile that is cut (mm)."""
LARGER = {"A3": 0.7, "A2": 1.0, "A1": 1.4, "A0": 2.0}
"""How many times as large plates are on a sheet as on one of size A2."""
TURN = 1.2
"""There the turn of the diagrams is so many times as long as in a report,"""
LIMITS_ROOM, PROFILE_ROOM = 58 + 50j, 86 + 92j
"""and diagrams of limits and profiles fill no more than this (mm) before they are enlarged as all figures of sheets."""
PROFILES = (2.0, 1.6, 1.25, 1.0, 0.75)
"""So many times as large profiles are tried."""
AXES = Pen(0.18, "#6b6b6b", (5.0, 1.0, 0.8, 1.0))
CONTOUR = Pen(0.5)


def drawing_sheets(case: SolvedCam, size: str = "", block: Path | None = None) -> list[DrawingSheet]:
    """The sheet of a size, else of the file's, else of the least that has room, and the profile in true size.

    Raises `SheetError` where the plates have no room.
    """
    language = case.assignment.language
    frame = read_block(block or blocks(case.assignment.report.school or "")[DEFAULT[language]], language)
    wanted = size or case.assignment.report.sheets or ""
    tried = (wanted,) if wanted else USUAL_SIZES
    for paper in tried:
        space = room(paper, frame.margins, frame.size)
        found = (_placed(_plates(case, LARGER[paper], share), space) for share in PROFILES)
        if parts := next(filter(None, found), None):
            return [_sheet(case, paper, frame, parts), _true_size(case.solution.cam)]
    raise SheetError(word("cam_sheet", language, size=tried[-1]))


def _sheet(case: SolvedCam, paper: str, block: TitleBlock, parts: list[PlacedScene]) -> DrawingSheet:
    width, height = SIZES[paper]
    fields = fields_of(case) | {"title": str(case.words["cam"]["sheet"]), "sheet": "1", "sheets": "1", "format": paper}
    space = room(paper, block.margins, block.size)
    corner = complex(space.high.real - block.size[0], space.low.imag)
    own = (
        PlacedScene("frame", "frame", frame_scene(paper, block.margins, block.note(fields))),
        PlacedScene("title block", "frame", block.scene(fields), corner),
    )
    return DrawingSheet(paper, width, height, (*own, *parts), fields)


def _plates(case: SolvedCam, larger: float, share: float) -> Iterator[tuple[str, str, Scene]]:
    """Name, layer and drawing of each plate, as they are set in columns; scales are round once plates are enlarged."""
    captions = case.words["cam"]["captions"]
    rooms = larger * LIMITS_ROOM, share * larger * PROFILE_ROOM
    yield "law", "curves", _titled(law_diagrams(case, larger * TURN / ENLARGED), str(captions["figure-law"]))
    if not case.solution.cam.flat and case.solution.designed.least is not None:
        yield "limits", "scheme", _titled(limit_diagram(case, rooms[0], ENLARGED), str(captions["figure-limits"]))
    yield (
        "inversion",
        "positions",
        _titled(inversion(case, rooms[1], True, ENLARGED), str(captions["figure-inversion"])),
    )
    yield "profile", "profile", _titled(inversion(case, rooms[1], False, ENLARGED), str(captions["figure-profile"]))
    if not case.solution.cam.flat:
        chart = pressure_chart(case, half=larger <= 1.0)
        yield "pressure", "curves", _titled(chart.scene, str(captions["figure-pressure"]))


def _titled(scene: Scene, title: str) -> Scene:
    return headed(lettered(scene), title, "")


def _placed(plates: Iterable[tuple[str, str, Scene]], space: Room) -> list[PlacedScene]:
    """The plates in columns, each as high as there is room above the title block; none where they do not fit."""
    parts: list[PlacedScene] = []
    left, top, widest = space.low.real + GAP, space.high.imag - GAP, 0.0
    for name, layer, scene in plates:
        while True:
            below = space.low.imag + GAP
            if left + scene.width > space.high.real - space.block.real:
                below += space.block.imag
            if top - scene.height >= below:
                break
            if top == space.high.imag - GAP:
                return []
            left, top, widest = left + widest + GAP, space.high.imag - GAP, 0.0
        if left + scene.width > space.high.real - GAP:
            return []
        parts.append(PlacedScene(name, layer, scene, complex(left, top - scene.height)))
        top, widest = top - scene.height - GAP, max(widest, scene.width)
    return parts


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
    profile = Polyline(tuple(complex(p) for p in points + shift), CONTOUR, closed=True, smooth=True)
    parts = (
        PlacedScene("axes", "axes", Scene(size.real, size.imag, axes)),
        PlacedScene("profile", "profile", Scene(size.real, size.imag, (profile,))),
    )
    return DrawingSheet("1:1", size.real, size.imag, parts)
