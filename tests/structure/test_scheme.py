"""The scheme of a structure exercise: faults of its points, what is drawn, labels without overlap, where it appears."""

from __future__ import annotations

import math
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.template_folders import languages
from reportgen.document import Document, Figure
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Label, Line, Polyline, Scene, style
from reportgen.drawing.geometry import frame
from reportgen.formula.plain_text import formula
from reportgen.structure.scheme_drawing import Sketch, replacement, scheme, steps
from reportgen.structure.structure_solution import formula_of
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "structure"
FILES = sorted(FOLDER.glob("*.yaml"))
SLIDER_CRANK = """kind: structure
report: {language: en}
parameters:
  pairs: [[0, 1], [1, 2], [2, 3], [3, 0]]
  points:
    A: {links: [0, 1], at: [0 mm, 0 mm]}
    B: {links: [1, 2], at: [20 mm, 30 mm]}
    C: {links: [2, 3], at: [90 mm, 0 mm]}
    D: {links: [3, 0], at: [90 mm, 0 mm], slide: 0 deg}
"""
GEARS = """kind: structure
report: {language: en}
parameters:
  pairs: [[0, 1], [0, 2]]
  higher: [[1, 2]]
  points:
    A: {links: [0, 1], at: [0 mm, 0 mm]}
    B: {links: [0, 2], at: [70 mm, 0 mm]}
    K: {links: [1, 2], at: [30 mm, 0 mm], teeth: 20 deg}
"""
FAULTS = [
    (SLIDER_CRANK, "", "", []),
    (SLIDER_CRANK, "[1, 2], at", "[1, 3], at", ["structure-point-missing 6:5", "structure-point-pair 7:16"]),
    (SLIDER_CRANK, "{links: [2, 3]", "{links: [2, 1]", ["structure-point-missing 6:5", "structure-point-twice 8:16"]),
    (SLIDER_CRANK, "    B: {links: [1, 2], at: [20 mm, 30 mm]}\n", "", ["structure-point-missing 6:5"]),
    (SLIDER_CRANK, "[20 mm, 30 mm]", "[0 mm, 0 mm]", ["structure-point-length 7:28"]),
    (SLIDER_CRANK, "30 mm]}", "30 mm], teeth: 20 deg}", ["structure-point-lower 7:51"]),
    (SLIDER_CRANK, ", slide: 0 deg", "", ["structure-point-length 9:28"]),
    (GEARS, "", "", []),
    (GEARS, ", teeth: 20 deg", "", ["structure-point-profile 9:8"]),
    (GEARS, "teeth: 20 deg", "teeth: 20 deg, slide: 0 deg", ["structure-point-slide 9:65"]),
    (GEARS, "teeth:", "centres: [[0 mm, 0 mm]], teeth:", ["both-given 9:68"]),
    (GEARS, "at: [30 mm, 0 mm]", "at: [30 mm, 2 mm]", ["structure-point-contact 9:28"]),
    (GEARS, "teeth: 20 deg", "centres: [[30 mm, 0 mm]]", ["structure-point-radius 9:28"]),
    (GEARS, "[70 mm, 0 mm]", "[1 mm, 0 mm]", ["structure-point-close 8:28"]),
]


def case_of(tmp_path: Path, text: str) -> Any:
    file = tmp_path / "drawn.yaml"
    file.write_text(text, encoding="utf-8")
    return built.case(file, "en")


@pytest.mark.parametrize(("text", "old", "new", "codes"), FAULTS, ids=[str(k) for k in range(len(FAULTS))])
def test_faults_of_points_are_at_their_places(tmp_path: Path, text: str, old: str, new: str, codes: list[str]) -> None:
    file = tmp_path / "points.yaml"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    faults = [f"{one.code} {one.location.line}:{one.location.column}" for one in api.check(file, "en")]
    assert sorted(faults) == sorted(codes)


def texts(scene: Scene) -> list[str]:
    """Return the labels of a scene as plain text."""
    labels = [item.content for item in scene.items if isinstance(item, Label)]
    return [label if isinstance(label, str) else formula(label, "en") for label in labels]


def drawn(file: Path) -> tuple[Any, Scene]:
    case: Any = built.case(file, "en")
    return case, scheme(case.placed, case.given.driver)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_link_and_pair_of_a_scheme_is_named_once(file: Path) -> None:
    case, scene = drawn(file)
    names = texts(scene)
    links = [str(link) for link in case.given.whole_chain.links]
    assert sorted(name for name in names if name.isdigit()) == sorted(links)
    assert {name for name in names if name.isalpha()} == set(case.given.points)
    assert not scene.crowded


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_labels_of_a_scheme_do_not_overlap(file: Path) -> None:
    frames = [frame(item) for item in drawn(file)[1].items if isinstance(item, Label)]
    for (at, half), (other, half2) in combinations(frames, 2):
        apart, room = at - other, half + half2
        assert abs(apart.real) >= room.real - 1e-6 or abs(apart.imag) >= room.imag - 1e-6


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_pairs_with_the_frame_are_hatched_and_the_driver_has_an_arrow(file: Path) -> None:
    """A pivot has one strip of ground; a guide has a strip on each side, more if a bar crosses it."""
    case, scene = drawn(file)
    standing = [joint for joint in case.placed.joints if 0 in joint.links and not joint.profiles]
    guides = sum(joint.slide is not None for joint in standing)
    hatches = sum(isinstance(item, Hatch) for item in scene.items)
    assert hatches >= len(standing) + guides
    assert hatches == len(standing) + guides or guides
    assert sum(isinstance(item, Arc) and item.head > 0 for item in scene.items) == 1


def test_a_sliding_driver_has_a_straight_arrow_and_a_moving_guide_a_rail(tmp_path: Path) -> None:
    """A block 1 on the frame drives lever 3 through block 2, which slides on the lever."""
    case = case_of(
        tmp_path,
        "kind: structure\nreport: {language: en}\nparameters:\n  pairs: [[0, 1], [1, 2], [2, 3], [3, 0]]\n"
        "  points:\n"
        "    A: {links: [1, 0], at: [0 mm, 60 mm], slide: 0 deg}\n    B: {links: [1, 2], at: [0 mm, 60 mm]}\n"
        "    C: {links: [2, 3], at: [0 mm, 60 mm], slide: 60 deg}\n"
        f"    D: {{links: [3, 0], at: [{-60 / math.tan(math.pi / 3):.6f} mm, 0 mm]}}\n",
    )
    scene = scheme(case.placed, 1)
    arrow = next(item for item in scene.items if isinstance(item, Arrow))
    assert (arrow.end - arrow.start).imag == pytest.approx(0)
    # The lever is one straight bar from its pivot to its guide, which lies on the line to the pivot.
    sketch = Sketch(case.placed.scaled(1000), 1)
    start, end = sketch.body_points(3)
    assert math.degrees(math.atan2((end - start).imag, (end - start).real)) == pytest.approx(60, abs=1e-3)


def test_gears_touch_and_their_centres_of_curvature_are_on_the_base_circles(tmp_path: Path) -> None:
    """The line of action touches the base circles, whose radius is r cos α."""
    joint = next(joint for joint in case_of(tmp_path, GEARS).placed.joints if joint.gears)
    for profile, radius in zip(joint.profiles, (0.030, 0.040), strict=True):
        assert abs(joint.at - profile.axis) == pytest.approx(radius)
        assert abs(profile.centre - profile.axis) == pytest.approx(radius * math.cos(math.radians(20)))
    normal = joint.profiles[1].centre - joint.profiles[0].centre
    assert abs(normal) == pytest.approx(0.070 * math.sin(math.radians(20)))


PLANETARY = """kind: structure
report: {language: en}
parameters:
  pairs: [[0, 1, 3], [3, 2]]
  higher: [[1, 2], [2, 0]]
  points:
    A: {links: [0, 1, 3], at: [0 mm, 0 mm]}
    B: {links: [3, 2], at: [30 mm, 20 mm]}
    C: {links: [1, 2], at: [18 mm, 12 mm], teeth: 20 deg}
    D: {links: [2, 0], at: [42 mm, 28 mm], teeth: 20 deg}
"""


def test_a_fixed_internal_gear_is_hatched_outside_and_behind_the_wheels(tmp_path: Path) -> None:
    """Its radius is that of the sun plus the diameter of the planet."""
    case = case_of(tmp_path, PLANETARY)
    scene = scheme(case.placed, 1)
    wheels = [item for item in scene.items if isinstance(item, Circle) and item.fill == style.TINT]
    ring = max((item for item in scene.items if isinstance(item, Circle)), key=lambda circle: circle.radius)
    sun, planet = sorted({round(wheel.radius, 6) for wheel in wheels}, reverse=True)
    assert ring.radius == pytest.approx(sun + 2 * planet, abs=1e-5)
    assert scene.items.index(ring) < min(map(scene.items.index, wheels))
    hatches = [item for item in scene.items if isinstance(item, Hatch)]
    # All but the strip of the pivot are outside, up to the sag of a chord.
    outside = [all(abs(p - ring.centre) > 0.99 * ring.radius for p in hatch.points) for hatch in hatches]
    assert outside.count(False) == 1
    assert len(outside) > 12


def figures(document: Document) -> list[str]:
    return [block.key for block in document.blocks if isinstance(block, Figure)]


@pytest.mark.parametrize("language", languages())
def test_the_scheme_is_in_report_and_sheets_if_there_are_points(language: str, tmp_path: Path) -> None:
    with_points = FOLDER / "class-two.yaml"
    without = tmp_path / "no-points.yaml"
    without.write_text(with_points.read_text(encoding="utf-8").split("  points:")[0], encoding="utf-8")
    for file, count in ((with_points, 1), (without, 0)):
        case: Any = built.case(file, language)
        assert "fig.diagram" in figures(case.document())
        assert figures(case.document()).count("fig.scheme") == count
        plates = [plate.title for plate in case.plates()["structure"]]
        assert plates.count(case.words["structure"]["captions"]["figure-scheme"]) == count


# --- replacement and steps ------------------------------------------------------------------------


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_placed_joints_are_those_of_the_equivalent_mechanism(file: Path) -> None:
    """Rollers and passive links are removed, and higher pairs replaced, in the drawing as in the count."""
    case: Any = built.case(file, "en")
    equivalent = case.placed_active.with_lower_pairs
    joints = [frozenset(joint.links) for joint in equivalent.joints]
    assert sorted(map(sorted, joints)) == sorted(sorted(joint.links) for joint in case.lower_chain.joints)
    assert equivalent.added == tuple(case.replacements)


def blue_bars(scene: Scene) -> list[Any]:
    return [item for item in scene.items if isinstance(item, Line | Polyline) and item.stroke.colour == style.BLUE]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_each_step_emphasizes_its_group_and_the_titles_are_the_formula(file: Path) -> None:
    case: Any = built.case(file, "en")
    scenes = list(steps(case.placed_active.with_lower_pairs, case.splitting))
    assert " → ".join(scene.title for scene in reversed(scenes)) == formula_of(case.splitting)
    links = [*(group.links for group in reversed(case.groups)), (case.given.driver,)]
    for scene, group in zip(scenes, links, strict=True):
        assert sorted(name for name in texts(scene) if name.isdigit()) == sorted(map(str, group))
        assert blue_bars(scene)
    # What is split off is not drawn again: the last step has the driver's pivot, and its bar to the next pair.
    assert sum(isinstance(item, Hatch) for item in scenes[-1].items) == 1
    assert len(blue_bars(scenes[-1])) == 1


@pytest.mark.parametrize("name", ["cam-roller", "geared-bars"])
def test_a_replacement_adds_a_bar_between_the_centres_of_curvature(name: str) -> None:
    case: Any = built.case(FOLDER / f"{name}.yaml", "en")
    before, after = replacement(case.placed_active, case.given.driver)
    added = [str(link) for link in case.replacements]
    assert not blue_bars(before)
    assert sorted({*texts(after)} - {*texts(before)}) == added
    (bar,) = blue_bars(after)
    contact = next(joint for joint in case.placed_active.joints if joint.profiles)
    scale = case.placed_active.step_scale
    between = contact.profiles[1].centre - contact.profiles[0].centre
    assert abs(bar.end - bar.start) == pytest.approx(abs(between) * scale)


FLAT = """kind: structure
report: {language: en}
parameters:
  pairs: [[0, 1], [2, 0]]
  higher: [[1, 2]]
  points:
    A: {links: [0, 1], at: [0 mm, 0 mm]}
    B: {links: [2, 0], at: [10 mm, 90 mm], slide: 90 deg}
    K: {links: [1, 2], at: [10 mm, 40 mm], centres: [[10 mm, 10 mm]]}
"""


def test_a_flat_follower_gets_a_block_at_the_centre_of_the_cam(tmp_path: Path) -> None:
    """The added link turns about the centre of curvature of the cam and slides along the straight profile."""
    case = case_of(tmp_path, FLAT)
    assert formula_of(case.splitting) == "I(0, 1) → II(2, 3)"
    pin, slide = case.placed_active.with_lower_pairs.joints[-2:]
    assert (pin.links, slide.links) == ((1, 3), (3, 2))
    assert pin.at == slide.at == pytest.approx(0.010 + 0.010j)
    assert math.degrees(slide.slide) % 180 == pytest.approx(0)
    # The follower is a rod with a guide across it, on which the block of the added link slides.
    assert {"1", "2", "3"} <= {*texts(replacement(case.placed_active, 1)[1])}
    rod = Sketch(case.placed_active.with_lower_pairs.scaled(1000), 1).body_points(2)
    assert [point.imag for point in rod] == pytest.approx([90, 10])
