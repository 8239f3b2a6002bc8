"""Place scenes on paper: in the text if they fit in true size, else turned, else on a separate page."""

from __future__ import annotations

from reportgen.base.records import Record, replace
from reportgen.document import TEXT_WIDTH
from reportgen.document.layout import FIGURE_HEIGHT
from reportgen.drawing import Scene
from reportgen.drawing.drawing_sheet import sheets
from reportgen.drawing.geometry import moved
from reportgen.formula import Chain

A3_UPRIGHT, A3_ACROSS = (297.0, 420.0), (420.0, 297.0)
LARGER = tuple(
    size for short, long in ((420.0, 594.0), (594.0, 841.0), (841.0, 1189.0)) for size in ((long, short), (short, long))
)
"""Sheets A2, A1 and A0, landscape and portrait."""
PLATES = (A3_ACROSS, A3_UPRIGHT, *LARGER)
FIGURE_ROOM = (TEXT_WIDTH, FIGURE_HEIGHT)
"""Width and height (mm) of an A4 page that a figure may fill."""
TURNED_ROOM = (254.0, 150.5)
"""Width and height (mm) that a figure turned by 90° may fill."""
PAPERS = {297.0: "A3", 420.0: "A2", 594.0: "A1", 841.0: "A0"}
"""Names of paper sizes by their shorter side (mm)."""
WHITE = (34.0, 64.0)
"""Margins, header and caption of a plate's page (mm)."""
CLOSE = 5.5
"""Width (mm) that scenes of one figure lose from their margins to fit side by side."""
LEAST_MARGIN = 0.5
"""White space (mm) that remains around a scene."""


class FigureScenes(Record):
    """Scenes of a figure; `paper` (mm) requests a separate page for each, `turned` an A4 landscape page."""

    scenes: tuple[Scene, ...]
    paper: tuple[float, float] | None = None
    note: Chain | None = None
    """A scale to print behind the caption."""
    turned: bool = False
    smaller: float = 1.0
    """Factor by which it is smaller than at the scales of the text; its caption says so."""


def in_text(*scenes: Scene) -> bool:
    """Return True if a figure is one scene that fits a text block in true size."""
    return len(scenes) == 1 and scenes[0].width <= FIGURE_ROOM[0] and scenes[0].height <= FIGURE_ROOM[1]


def across(scene: Scene) -> bool:
    """Return True if a scene fits a text block that is turned by 90°."""
    return scene.width <= TURNED_ROOM[0] and scene.height <= TURNED_ROOM[1]


def close(scene: Scene) -> Scene:
    """Return a scene without the outer part of its margin."""
    trim = scene.margin - LEAST_MARGIN
    if trim <= 0.0:
        return scene
    items = tuple(moved(item, complex(-trim, -trim)) for item in scene.items)
    width, height = scene.width - 2 * trim, scene.height - 2 * trim
    return replace(scene, width=width, height=height, items=items, margin=LEAST_MARGIN)


def fits(width: float, height: float, paper: tuple[float, float]) -> bool:
    """Return True if a drawing of a width and height (mm) has room on a plate."""
    return width <= paper[0] - WHITE[0] and height <= paper[1] - WHITE[1]


def on_paper(*scenes: Scene) -> FigureScenes:
    """Return scenes in the text if they fit there in true size, else turned, else each on a page that fits all."""
    for candidates in (scenes, tuple(map(close, scenes))):
        if all(map(in_text, candidates)):
            return FigureScenes(candidates)
        if len(candidates) == 1 and across(candidates[0]):
            return FigureScenes(candidates, turned=True)
    width, height = max(scene.width for scene in scenes), max(scene.height for scene in scenes)
    papers = (paper for paper in PLATES if fits(width, height, paper))
    return FigureScenes(scenes, next(papers, (width + WHITE[0], height + WHITE[1])))


def beside_one_another(*scenes: Scene) -> FigureScenes:
    """Return scenes close together if they then fit the text block, else as they are.

    If they do not fit the text, they share one page, turned or as large as necessary, so that a small scene never takes
    a large page for itself.
    """
    together = sheets(scenes, *FIGURE_ROOM, trim=CLOSE)
    if in_text(*together):
        return FigureScenes(together)
    if all(map(in_text, scenes)):
        return FigureScenes(scenes)
    turned = sheets(scenes, *TURNED_ROOM, trim=CLOSE)
    if len(turned) == 1 and across(turned[0]):
        return FigureScenes(turned, turned=True)
    for paper in PLATES:
        packed = sheets(scenes, paper[0] - WHITE[0], paper[1] - WHITE[1], trim=CLOSE)
        if len(packed) == 1 and fits(packed[0].width, packed[0].height, paper):
            return FigureScenes(packed, paper)
    return on_paper(*scenes)
