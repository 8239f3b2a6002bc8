"""Figures as files: which there are, true size in every format, what moves."""

from __future__ import annotations

import io
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from reportgen import api
from reportgen.api.figures import figure_files
from reportgen.base.errors import NotOfferedError, TypesetterError, UnknownNameError
from reportgen.document.named_figures import NamedFigure, named_figures
from reportgen.drawing import Arrow, Label, Scene
from reportgen.drawing.style import arrow_head
from reportgen.export.figures import MovingFigure, drawn, moving
from reportgen.formula import Expression, Number
from tests.lanes import matrix
from tests.report import built

pymupdf = pytest.importorskip("pymupdf")

ROOT = Path(__file__).parents[2]
SHAPER = ROOT / "assignments" / "shaper-01.yaml"
TWIN = ROOT / "assignments" / "engine-twin-05.yaml"
SLIDER_CRANK = ROOT / "assignments" / "slider-crank-01.yaml"
POINT = 25.4 / 72
RULER = 0.1
"""Millimetres: what a ruler on paper can tell apart."""
WORKED = ("v.6", "a.6", "R.23.6", "bodies.45.6", "crank.6")


def figures(file: Path) -> Mapping[str, NamedFigure]:
    return {one.name: one for one in named_figures(built.written(file, "vi").document)}


# --- true size in every format ----------------------------------------------------------------------


def _filled(scene: Scene, format: str, content: bytes) -> Iterator[list[complex]]:
    """The corners of what is filled in a file (mm, y upwards)."""
    if format == "eps":
        number = r"(-?[\d.]+) (-?[\d.]+)"
        for path in re.findall(rf"^{number} m\n{number} l\n{number} l\ncl\n", content.decode("latin-1"), re.M):
            x, y = np.array(path[::2], float), np.array(path[1::2], float)
            yield list((x + 1j * y) * POINT)
        return
    (page,) = pymupdf.open(stream=content, filetype=format)
    for path in page.get_drawings():
        if path["fill"] is not None:
            corners = [point for one in path["items"] if one[0] == "l" for point in one[1:]]
            yield [point.x * POINT + 1j * (scene.height - point.y * POINT) for point in corners]


@pytest.mark.parametrize("format", ["svg", "pdf", "eps"])
def test_arrows_are_where_the_scene_has_them(format: str) -> None:
    """Each head, tip and feet, within what a ruler tells apart; the page is as large as the scene."""
    for name in WORKED:
        (scene,) = figures(SHAPER)[name].scenes
        (content,) = drawn([scene], "vi", [format])[format]
        found = [np.array(corners) for corners in _filled(scene, format, content)]
        arrows = [item for item in scene.items if isinstance(item, Arrow)]
        assert arrows
        for arrow in arrows:
            _, head = arrow_head(arrow.start, arrow.end, arrow.head)
            off = (max(np.abs(corners - one).min() for one in head or ()) for corners in found if len(corners))
            assert min(off) < RULER, (name, arrow)


@pytest.mark.parametrize("format", ["svg", "pdf", "eps", "png"])
def test_a_figure_is_as_large_as_in_the_report(format: str) -> None:
    (scene,) = figures(SHAPER)["v.6"].scenes
    (content,) = drawn([scene], "vi", [format], 254)[format]
    if format == "eps":
        box = re.search(rb"%%HiResBoundingBox: \S+ \S+ (\S+) (\S+)", content)
        assert box is not None
        size = [float(side) * POINT for side in box.groups()]
    elif format == "png":
        # A tenth of a millimetre a dot.
        size = [side / 10 for side in pymupdf.Pixmap(content).irect[2:]]
    else:
        size = [side * POINT for side in pymupdf.open(stream=content, filetype=format)[0].rect[2:]]
    assert size == pytest.approx([scene.width, scene.height], abs=RULER)


def test_letters_of_an_svg_are_outlines() -> None:
    """So that they look alike wherever it is shown; the same bytes each time."""
    scenes = figures(SHAPER)["v.6"].scenes
    (once,), (again,) = (drawn(scenes, "vi")["svg"] for _ in range(2))
    assert once == again
    assert b"<text" not in once
    assert b"<symbol" not in once


def test_an_svg_says_what_it_shows() -> None:
    """Its vectors with their lengths, as they are drawn."""
    file = figure_files(SHAPER, ["v.6"], formats=["svg"])["v.6.svg"]
    said = ElementTree.fromstring(file).findtext("{http://www.w3.org/2000/svg}desc") or ""
    vectors = [one for one in figures(SHAPER)["v.6"].scenes[0].items if isinstance(one, Arrow) and one.name]
    assert len(vectors) > 2
    for one in vectors:
        assert f"{abs(one.end - one.start):.2f} mm".replace(".", ",") in said


BRIEF = {path.stem: path for path in (TWIN, SHAPER, ROOT / "assignments" / "linkage-8.yaml", SLIDER_CRANK)}


@pytest.mark.parametrize("name", matrix(BRIEF, [SLIDER_CRANK.stem]))
def test_every_label_can_be_set_by_matplotlib(name: str, caplog: pytest.LogCaptureFixture) -> None:
    """Each formula and each word of a report is understood as mathtext, and has all its letters, in both languages."""
    from reportgen.writers import matplotlib_figures

    labels = dict.fromkeys(
        item.content
        for language in ("vi", "en")
        for _, scene in built.scenes(built.document(BRIEF[name], language))  # type: ignore[arg-type]
        for item in scene.items
        if isinstance(item, Label)
    )
    shown = [one for one in labels if isinstance(one, Expression) or not one.isascii()]
    rows = tuple(Label(complex(1, 6 * number + 3), one, "left") for number, one in enumerate(shown))
    made = matplotlib_figures.figure(Scene(100.0, 6.0 * len(rows) + 6, rows), "vi")
    assert matplotlib_figures.saved(made, "png", 72).startswith(b"\x89PNG")
    assert [record.message for record in caplog.records if "glyph" in record.message] == []


def test_exponents_of_units_are_set_in_any_font(caplog: pytest.LogCaptureFixture) -> None:
    """A raised minus, 1/s² as s⁻², is not in every font."""
    from reportgen.writers import matplotlib_figures

    rows = (Label(30 + 10j, Number(2.5, 1, "mm·rad⁻²")), Label(30 + 30j, Number(2.5, 1, "m/s²")))
    assert matplotlib_figures.eps(Scene(60.0, 40.0, rows), "en").startswith(b"%!PS")
    assert caplog.records == []


# --- which figures there are ------------------------------------------------------------------------


def test_figures_go_by_their_keys() -> None:
    twin = figures(TWIN)
    assert {"v.4", "v.stages.45.4", "motion", "M", "positions", "R.plates.23"} <= twin.keys()
    assert (twin["v.4"].kind, twin["v.4"].at) == ("v", "4")
    assert twin["R.plates.23"].positions == tuple(map(str, range(1, 17)))
    assert list(twin["groups"].files) == ["groups-1", "groups-2", "groups-3"]
    assert list(twin["v.plates"].files)[:2] == ["v.plates-1", "v.plates-2"]
    keys = {key for key, _ in built.scenes(built.written(TWIN, "vi").document)}
    assert len(twin) == len(keys)


def test_a_position_that_the_report_does_not_work_out_is_drawn() -> None:
    """v at 3 is the plan of position 3; its tips are those of the ledger."""
    files = figure_files(SHAPER, ["v", "v.plates"], at="3", formats=["svg"])
    assert set(files) == {"v.3.svg", "v.plates-3.svg"}
    with pytest.raises(UnknownNameError, match="13"):
        figure_files(SHAPER, ["v"], at="13")
    with pytest.raises(UnknownNameError, match=r"v\.6"):
        figure_files(SHAPER, ["v.7"])
    with pytest.raises(NotOfferedError):
        figure_files(ROOT / "assignments" / "gears" / "train-single.yaml", at="3")


# --- what moves -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def shaper() -> Mapping[str, MovingFigure]:
    return {one.name: one for one in moving(built.case(SHAPER, "vi"))}


def _arrows(scene: Scene) -> dict[str, complex]:
    return {item.name: item.end - item.start for item in scene.items if isinstance(item, Arrow)}


def test_what_moves_at_a_position_is_as_solve_says(shaper: Mapping[str, MovingFigure]) -> None:
    """The arrows of velocities at position 4 have the directions and, to one scale, the sizes of the results."""
    scene = shaper["machine"].at("4", ("velocities",))
    position = api.solve(api.load(SHAPER))["positions"][3]
    told = {f"v.{name}": complex(*point["v"]) for name, point in position["points"].items() if name not in {"A", "C"}}
    arrows = _arrows(scene)
    assert arrows.keys() == told.keys()
    scales = np.array([arrows[name] / told[name] for name in told])
    assert scales == pytest.approx(np.full(scales.shape, abs(scales[0])), rel=1e-6)


def test_frames_go_once_round_with_their_layers(shaper: Mapping[str, MovingFigure]) -> None:
    frames = shaper["machine"].frames(("velocities",))
    assert len(frames) == 60
    assert {(frame.width, frame.height) for frame in frames} == {(frames[0].width, frames[0].height)}
    assert all("v.E" in _arrows(frame) for frame in frames[1:20])
    assert not any(_arrows(frame) for frame in shaper["machine"].frames(("paths",)))
    # What has forces of both turns of a cycle is shown through both.
    twin = {one.name: one for one in moving(built.case(TWIN, "vi"))}
    assert len(twin["R23"].frames(())) == 120
    assert len(twin["v"].frames(())) == 60


def test_no_label_lies_on_another_one(shaper: Mapping[str, MovingFigure]) -> None:
    from reportgen.drawing.geometry import frame

    for scene in shaper["machine"].frames(("velocities",))[::6]:
        boxes = [frame(item) for item in scene.items if isinstance(item, Label)]
        for number, (middle, half) in enumerate(boxes):
            for other, wide in boxes[:number]:
                off, room = middle - other, half + wide
                assert abs(off.real) >= room.real or abs(off.imag) >= room.imag


def test_a_gif_has_a_frame_for_each_scene() -> None:
    from PIL import Image

    files = figure_files(SHAPER, ["v"], formats=["gif"], dpi=50)
    with Image.open(io.BytesIO(files["v.gif"])) as film:
        assert (film.n_frames, film.info["duration"], film.info["loop"]) == (60, 50, 0)  # type: ignore[attr-defined]
        first = film.convert("RGB")
        film.seek(30)
        assert first.getpixel((0, 0)) == (255, 255, 255)
        assert first.tobytes() != film.convert("RGB").tobytes()


def test_what_stands_and_what_is_not_there_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(NotOfferedError, match="machine"):
        figure_files(SHAPER, ["motion"], formats=["gif"])
    with pytest.raises(UnknownNameError, match="velocities"):
        figure_files(SHAPER, ["machine"], formats=["gif"], layers=["velocity"])
    with pytest.raises(NotOfferedError):
        figure_files(ROOT / "assignments" / "plane-motion" / "01.yaml", formats=["gif"])
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(TypesetterError, match="ffmpeg"):
        figure_files(SHAPER, ["v"], formats=["mp4"], dpi=20)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_an_mp4_is_one() -> None:
    assert figure_files(SHAPER, ["v"], formats=["mp4"], dpi=50)["v.mp4"][4:8] == b"ftyp"
