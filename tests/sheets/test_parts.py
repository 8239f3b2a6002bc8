"""The sheets of designs and of a coursework's parts: standard scales, the report's beside them, and little white."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest

from reportgen.cam.solution import SolvedCam
from reportgen.case import Case
from reportgen.drawing import Label, Polyline, Scene
from reportgen.drawing.drawing_sheet import DrawingSheet
from reportgen.formula import Chain, Number, Symbol
from reportgen.gears import train_ids
from reportgen.gears.train_ledger import pole_distance
from reportgen.marking.toleranced_key import key_of
from reportgen.sheets import drawing_sheets
from tests.lanes import matrix
from tests.report import built
from tests.sheets.laid import ROOT

FOLDER = ROOT / "assignments"
WORKS = sorted(
    str(path.relative_to(FOLDER).with_suffix(""))
    for folder in ("cam", "gears", "coursework")
    for path in (FOLDER / folder).glob("*.yaml")
    if "{of: n" not in path.read_text() or folder == "coursework"
)
TELLING = ["cam/roller-01", "gears/train-double", "gears/pair-equal-sliding", "coursework/shaper-whole"]
STANDARD = (1.0, 2.0, 2.5, 4.0, 5.0)


def opened(name: str) -> Case:
    return built.case(FOLDER / f"{name}.yaml")


@cache
def sheets(name: str, size: str = "") -> list[DrawingSheet]:
    return drawing_sheets(opened(name), size)


def framed(name: str, size: str = "") -> list[DrawingSheet]:
    return [sheet for sheet in sheets(name, size) if sheet.fields]


@cache
def of_parts(name: str, size: str = "") -> list[DrawingSheet]:
    """The sheets of a design, or of the parts of a coursework: those of its machine come first."""
    case = opened(name)
    machine = len(drawing_sheets(case.parts["machine"], size)) if case.parts else 0
    return framed(name, size)[machine:]


def scales(scene: Scene) -> Iterator[Chain]:
    for item in scene.items:
        if isinstance(item, Label) and isinstance(item.content, Chain) and len(item.content.parts) > 1:
            first = item.content.parts[0]
            if isinstance(first, Symbol) and first.base == "μ":
                yield item.content


def is_standard(value: float) -> bool:
    mantissa = value / 10 ** math.floor(math.log10(value) + 1e-9)
    return any(math.isclose(mantissa, one, rel_tol=1e-9) for one in STANDARD)


@pytest.mark.parametrize("name", matrix(WORKS, TELLING))
def test_every_scale_is_a_standard_one(name: str) -> None:
    """ISO 5455 and GOST 2.302: 1, 2, 2.5, 4, 5 times a power of ten; that of an angle in degrees."""
    met = 0
    for sheet in of_parts(name):
        for part in sheet.parts:
            for chain in scales(part.scene):
                number = chain.parts[1]
                assert isinstance(number, Number)
                assert is_standard(number.value), chain
                assert not number.unit[0].isdigit(), "0,04 1/mm reads as 0,041"
                met += 1
    assert met


@pytest.mark.parametrize("name", matrix(WORKS, TELLING))
def test_a_drawing_says_its_ratio_and_the_report_s_scale(name: str) -> None:
    """The ratio is that of its own scale; no drawing is smaller than in the report."""
    language, told = opened(name).assignment.language, 0
    for sheet in of_parts(name):
        for part in sheet.parts:
            for chain in scales(part.scene):
                if part.layer == "curves" or chain.parts[1].unit != "mm/mm":
                    continue
                above, below, usual = re.fullmatch(r"([\d,.]+):([\d,.]+); .+: ([\d,.]+).mm/mm", chain.note).groups()
                sizes = [float(one.replace(",", ".") if language == "vi" else one) for one in (above, below, usual)]
                assert sizes[1] / sizes[0] == pytest.approx(chain.parts[1].value)
                assert chain.parts[1].value <= sizes[2] * (1 + 1e-9)
                told += 1
    assert told


@pytest.mark.parametrize("name", matrix([one for one in WORKS if one.startswith("coursework/shaper")
                                         or one.endswith("engine-twin")], ["coursework/shaper-whole"]))  # fmt: skip
def test_all_parts_stand_on_one_a1(name: str) -> None:
    """Cam, gears and train together; the plates cover most of what the frame leaves."""
    (sheet,) = of_parts(name)
    assert sheet.name == "A1"
    assert {one.name for one in framed(name)} == {"A1"}
    plates = [part for part in sheet.parts if part.layer != "frame"]
    boxes = np.array([[low.real, low.imag, high.real, high.imag] for low, high in (part.box for part in plates)])
    grid = np.zeros((int(sheet.width), int(sheet.height)), bool)
    for left, low, right, high in boxes.astype(int):
        grid[left:right, low:high] = True
    # They covered a fifth to two fifths before; heads, gutters and the title block take about a quarter.
    assert grid.sum() > 0.45 * (sheet.width - 30) * (sheet.height - 20)
    titles = [int(part.name) for part in plates if "." not in part.name]
    assert sorted(titles) == list(range(1, len(titles) + 1)), "numbered through all parts"


def test_a_larger_paper_shows_larger_drawings() -> None:
    """On A1 each scale of a cam's drawings is at least as fine as on A2, and one is finer; on A3 none is too large."""

    def found(size: str) -> list[float]:
        (sheet,) = of_parts("cam/roller-01", size)
        return [
            chain.parts[1].value
            for part in sheet.parts
            for chain in scales(part.scene)
            if chain.parts[1].unit == "mm/mm" and part.layer != "curves"
        ]

    small, large = found("A2"), found("A1")
    assert all(one >= other for one, other in zip(small, large, strict=True))
    assert sum(small) > sum(large)


def test_what_is_measured_on_the_diagrams_of_a_cam_is_what_their_scales_say() -> None:
    """The height of a curve times its scale is the range of s, s′, s″; K₁ = μ_s′/(μ_s″ μ_φ), K₂ = μ_s/(μ_s′ μ_φ)."""
    case = opened("cam/roller-01")
    assert isinstance(case, SolvedCam)
    (sheet,) = of_parts("cam/roller-01")
    scene = next(part.scene for part in sheet.parts if any(len(chain.parts) == 3 for chain in scales(part.scene)))
    μ_φ, *others = [chain.parts[-1].value for chain in scales(scene)]
    curves = [item for item in scene.items if isinstance(item, Polyline) and len(item.points) > 1000]
    profile = case.solution.cam.sampled(1440)
    ranges = [np.ptp(one) * 1000 for one in (profile.s, profile.ds, profile.dds)]
    for curve, μ, wanted in zip(curves, others, ranges, strict=True):
        points = np.array(curve.points)
        assert np.ptp(points.imag) * μ == pytest.approx(wanted, rel=1e-6)
        # Six figures of the scale are printed.
        assert np.ptp(points.real) * μ_φ == pytest.approx(profile.φ[-1] - profile.φ[0], rel=1e-5)
    poles = {
        item.content.parts[0].sub: item.content.parts[1].value
        for item in scene.items
        if isinstance(item, Label) and isinstance(item.content, Chain) and item.content.parts[0].base == "K"
    }
    s, ds, dds = others
    assert poles["1"] == pytest.approx(ds / dds / μ_φ, abs=0.005)
    assert poles["2"] == pytest.approx(s / ds / μ_φ, abs=0.005)


@pytest.mark.parametrize("rate", [0.8, 16.0, 12.5, 6.25, 20.0, 3.2e3])
@pytest.mark.parametrize("wide", [0.5, 3.0, 30.0])
def test_the_pole_of_angular_velocities_gives_a_standard_scale(rate: float, wide: float) -> None:
    """μ_ω = μ_v/(μ_l h), and the plan keeps in its room of 110 mm."""
    h = pole_distance(rate, wide)
    assert is_standard(rate / h)
    assert h * wide <= 110 + 1e-9
    assert h <= 40


def test_no_mark_of_a_part_hangs_on_the_scale_of_a_drawing() -> None:
    """What a part's key asks for is computed, so no band has an error of measuring that a scale could change."""
    for name in ("cam/roller-01", "gears/train-double", "gears/pair-equal-sliding"):
        assert all(np.nanmax(row.drawn, initial=0.0) == 0 for row in key_of(opened(name)).rows)
    # What is measured on the machine's sheets has the scales of the report, from which its bands come.
    assert train_ids.scale("l") not in {row.id for row in key_of(opened("gears/train-double")).rows}
