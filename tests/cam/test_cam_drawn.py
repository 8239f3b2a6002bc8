"""What is drawn of cams: true scale, the profile for a machine that cuts it, and the page's samples."""

from __future__ import annotations

import io
import math
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from reportgen import api
from reportgen.cam.case import CamCase
from reportgen.cam.drawings import inversion
from reportgen.cam.inverse_design import CamLimits, least_translating
from reportgen.cam.motion_laws import FollowerMotion, law
from reportgen.cam.profile import Cam
from reportgen.cam.sheets import CHORD, contour
from reportgen.drawing import Arc, Circle, Label
from reportgen.drawing.style import arc_with_head
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets import drawing_sheets
from tests.lanes import matrix
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "cam"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))
MM = 1e3


def case_of(name: str) -> CamCase:
    case = built.case(FOLDER / f"{name}.yaml", "en")
    assert isinstance(case, CamCase)
    return case


def cam_of(name: str) -> Cam:
    return case_of(name).solution.cam


@pytest.mark.parametrize("name", matrix(NAMES, ["roller-01", "flat-01"]))
def test_the_dxf_has_the_profile_in_true_size(name: str) -> None:
    """The polyline is closed, one to one, within 0.001 mm of the curve; so is the spline, on a layer of its own."""
    files = api.sheet_files(FOLDER / f"{name}.yaml", language="en", formats=("dxf",))
    model = ezdxf.read(io.StringIO(files["sheet-2.dxf"].decode())).modelspace()
    (line,) = model.query('LWPOLYLINE[layer=="profile"]')
    assert line.closed
    points = np.array([complex(x, y) for x, y in line.get_points("xy")])
    corner = points[0] - contour(cam_of(name))[0] * MM
    fine = cam_of(name).outline(5_000) * MM + corner
    assert farthest(fine, points) < CHORD * MM
    for spline in model.query('SPLINE[layer=="spline"]'):
        curve = spline.construction_tool()
        shown = np.array([complex(p.x, p.y) for p in curve.points(np.linspace(0, curve.max_t, 1000))])
        # A spline through 360 points misses the corners of curvature that a soft impact leaves by some more.
        assert farthest(shown, fine) < 0.02
    assert len(model.query('SPLINE[layer=="spline"]')) >= 1


def farthest(points: np.ndarray, line: np.ndarray) -> float:
    """How far points lie from a closed polyline at most."""
    stop = np.roll(line, -1)
    found = 0.0
    for some in np.array_split(points, max(points.size // 200, 1)):
        along = stop - line
        share = ((some[:, None] - line) * along.conj()).real / np.maximum(np.abs(along) ** 2, 1e-30)
        off = np.abs(some[:, None] - line - np.clip(share, 0, 1) * along)
        found = max(found, float(off.min(axis=1).max()))
    return found


@pytest.mark.parametrize("name", NAMES)
def test_the_base_circle_is_true_to_the_scale_that_is_printed(name: str) -> None:
    scene = inversion(case_of(name))
    note = scene.items[-1]
    assert isinstance(note, Label)
    assert isinstance(note.content, Chain)
    number = note.content.parts[1]
    assert isinstance(number, Number)
    scale = number.value
    radii = [item.radius for item in scene.items if isinstance(item, Circle)]
    assert min(abs(radius * scale - cam_of(name).r0 * MM) for radius in radii) < 1e-9


@pytest.mark.parametrize("name", ["roller-01", "flat-01", "shaper-feed"])
def test_the_arrow_of_the_rotation_has_a_tip(name: str) -> None:
    """In each drawing the tip is more than twice as wide as the arc that ends in it, and points the cam's way."""
    for stage in ("displacements", "profile by inversion", "cam"):
        (arc,) = (
            one
            for one in inversion(case_of(name), stage).items
            if isinstance(one, Arc) and one.head  # type: ignore[arg-type]
        )
        _, tip = arc_with_head(arc)
        assert tip is not None
        assert abs(tip[1] - tip[2]) > 2 * arc.stroke.width
        assert np.sign(arc.stop - arc.start) == cam_of(name).turn


@pytest.mark.parametrize("name", NAMES)
def test_the_follower_touches_the_turning_cam(name: str) -> None:
    """On the page the point of contact, turned into the cam's frame, lies on the profile that turns."""
    case = built.case(FOLDER / f"{name}.yaml", "en")
    (animation,) = case.animations()
    assert animation.errors.place < 0.05
    cam = cam_of(name)
    profile = cam.profile_at(np.radians(animation.knots))
    outline = cam.outline(20_000)
    assert farthest(profile.working[::20], outline) < 1e-8
    for chart in animation.charts:
        low, high = chart.plotted.y
        for curve in chart.curves:
            assert low - 1e-6 <= curve.values.values.min()
            assert curve.values.values.max() <= high + 1e-6


@pytest.mark.proof
def test_the_least_cam_is_that_of_a_search() -> None:
    """Least r₀ over all e, from limits sampled at 400 000 angles: the same to 1e-9."""
    rng = np.random.default_rng(7)
    for _ in range(20):
        first, far, back = np.radians(rng.uniform((60, 0, 60), (140, 30, 140)))
        motion = FollowerMotion(
            0.04,
            (first, far, back, 2 * math.pi - first - far - back),
            law("sine"),
            law(rng.choice(["cosine", "3-4-5"])),
        )
        limits = CamLimits(*np.radians(rng.uniform((25, 30), (40, 75))), 0.003)
        least = least_translating(motion, limits, None)
        assert limits.rise is not None
        assert limits.back is not None
        t1, t2 = math.tan(limits.rise), math.tan(limits.back)
        s, ds, _ = motion(np.linspace(0, first, 400_000))
        c1 = np.max(ds - t1 * s)
        s, ds, _ = motion(np.linspace(first + far, first + far + back, 400_000))
        c2 = np.max(-ds - t2 * s)

        def r0(e: float, c1: float = c1, c2: float = c2, t1: float = t1, t2: float = t2) -> float:
            return math.hypot(e, max((c1 - e) / t1, (c2 + e) / t2))

        low, high = -0.2, 0.2
        for _ in range(200):
            one, other = low + (high - low) / 3, high - (high - low) / 3
            low, high = (low, other) if r0(one) < r0(other) else (one, high)
        assert least.r0 == pytest.approx(r0((low + high) / 2), rel=1e-9)


@pytest.mark.parametrize("name", ["roller-01", "shaper-feed", "flat-01"])
def test_sheets_print_their_own_scales(name: str) -> None:
    """On the drawing sheet the base circle times the scale below it is r₀, in each plate that shows it."""
    (sheet, profile) = drawing_sheets(built.case(FOLDER / f"{name}.yaml", "en"))
    met = 0
    for part in sheet.parts:
        scales = [
            item.content.parts[1].value
            for item in part.scene.items
            if isinstance(item, Label) and isinstance(item.content, Chain) and item.content.parts[0] == Symbol("μ", "l")
        ]
        radii = [item.radius for item in part.scene.items if isinstance(item, Circle)]
        if scales and part.layer in ("positions", "profile"):
            met += 1
            assert min(abs(radius * scales[0] - cam_of(name).r0 * MM) for radius in radii) < 1e-3
    assert met >= 2
    assert profile.name == "1:1"
