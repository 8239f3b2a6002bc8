"""The drawing sheets of a cam: motion, S–S′ diagram, pressure angle and profile on one, the profile alone in true size.

The second sheet has nothing but the profile 1:1 on layers of its own, as a machine that cuts it needs it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
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
TURN = 1.5
"""So many times as long as in a report is the turn of its diagrams (180 mm)."""
LIMITS_ROOM, PROFILE_ROOM = 80 + 90j, 84 + 92j
"""What diagrams of limits and profiles may fill before they are enlarged (mm)."""
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
        parts = _placed(case, room(paper, frame.margins, frame.size))
        if parts:
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
    return DrawingSheet(paper, width, height, (*own, *parts))


def _plates(case: SolvedCam) -> Iterator[tuple[str, str, Scene]]:
    """Name, layer and drawing of each plate, as they are set from left to right and from above."""
    captions = case.words["cam"]["captions"]
    # Sheets enlarge what reports draw; scales are round once that is done.
    yield "law", "curves", _titled(law_diagrams(case, TURN / ENLARGED), str(captions["figure-law"]))
    if not case.solution.cam.flat:
        if case.solution.designed.least is not None:
            yield (
                "limits",
                "scheme",
                _titled(limit_diagram(case, LIMITS_ROOM, ENLARGED), str(captions["figure-limits"])),
            )
        yield "pressure", "curves", _titled(pressure_chart(case).scene, str(captions["figure-pressure"]))
    yield (
        "inversion",
        "positions",
        _titled(inversion(case, PROFILE_ROOM, enlarged=ENLARGED), str(captions["figure-inversion"])),
    )
    yield (
        "profile",
        "profile",
        _titled(inversion(case, PROFILE_ROOM, construction=False, enlarged=ENLARGED), str(captions["figure-profile"])),
    )


def _titled(scene: Scene, title: str) -> Scene:
    return headed(lettered(scene), title, "")


def _placed(case: SolvedCam, space: Room) -> list[PlacedScene]:
    """The plates in columns, each as high as there is room above the title block; none where they do not fit."""
    parts: list[PlacedScene] = []
    left, top, widest = space.low.real + GAP, space.high.imag - GAP, 0.0
    for name, layer, scene in _plates(case):
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
