"""Syntheses through three points: published lengths and errors, linkages closed again, faults, marks, mistakes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen import catalogue, load, solve
from reportgen.base.template_folders import languages
from reportgen.structure import three_point_names as names
from reportgen.structure.three_pairs import ThreePairs
from tests.marking.designs import STUDENTS, check_named, drawn_class, graded_class
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "synthesis"
LOGARITHM, PAIRS = FOLDER / "three-points-logarithm.yaml", FOLDER / "three-points-pairs.yaml"
HEAD = "kind: synthesis\nreport: {language: en}\nparameters:\n"
FUNCTION = "task: three-points", "d: 100 mm", "function: ln", "x: [1, 2]", "driver: [90 deg, 150 deg]"
FOLLOWER = "follower: [30 deg, 90 deg]"
FAULTS = [
    ((*FUNCTION, FOLLOWER), ""),
    (FUNCTION, "3:1 missing-key"),
    (("task: three-points", *FUNCTION[2:], FOLLOWER), "3:1 missing-key"),
    (("task: three-points", "d: 100 mm"), "3:1 missing-key"),
    ((*FUNCTION, FOLLOWER, "K: 1.2"), "10:3 synthesis-other-task"),
    ((*FUNCTION, "follower: [30 deg, 30 deg]"), "9:13 synthesis-no-range"),
    ((*FUNCTION[:3], "x: [-1, 2]", FUNCTION[4], FOLLOWER), "7:6 synthesis-undefined"),
    (
        (*FUNCTION[:2], "function: power", "exponent: -1", "x: [-1, 2]", FUNCTION[4], FOLLOWER),
        "8:6 synthesis-undefined",
    ),
    (
        (*FUNCTION[:2], "function: power", "exponent: 2", "x: [-1, 1]", FUNCTION[4], FOLLOWER),
        "8:6 synthesis-equal-values",
    ),
    ((*FUNCTION[:2], "function: power", "x: [1, 2]", FUNCTION[4], FOLLOWER), "3:1 missing-key"),
    ((*FUNCTION[:2], "function: sin", "x: [0, 90 deg]", FUNCTION[4], FOLLOWER), "7:7 missing-unit"),
    ((*FUNCTION[:3], "x: [1, 90 deg]", FUNCTION[4], FOLLOWER), "7:10 unexpected-unit"),
    ((*FUNCTION[:2], "function: sin", "x: [30 deg, 150 deg]", FUNCTION[4], FOLLOWER), "7:6 synthesis-equal-values"),
    ((*FUNCTION[:2], "function: tan", "x: [60 deg, 130 deg]", FUNCTION[4], FOLLOWER), "7:6 synthesis-undefined"),
    ((*FUNCTION[:2], "function: tan", "x: [0 deg, 90 deg]", FUNCTION[4], FOLLOWER), "7:6 synthesis-undefined"),
    (
        (
            *FUNCTION[:2],
            "function: sin",
            "x: [0 deg, 90 deg]",
            "driver: [60 deg, 120 deg]",
            f"{FOLLOWER[:11]}100 deg, 160 deg]",
        ),
        "8:11 synthesis-short-range",
    ),
    ((*FUNCTION[:2], "pairs:"), "6:3 missing-key"),
    ((*FUNCTION[:2], "pairs: [[10 deg, 20 deg], [10 deg, 20 deg], [40 deg, 50 deg]]"), "6:10 synthesis-no-linkage"),
    ((*FUNCTION[:2], "pairs: [[0 deg, 60 deg], [120 deg, 300 deg], [240 deg, 10 deg]]"), "6:10 synthesis-branch"),
]


@pytest.mark.parametrize(("lines", "fault"), FAULTS, ids=[f"{k} {fault}" for k, (_, fault) in enumerate(FAULTS)])
def test_faults_are_at_their_places(tmp_path: Path, lines: tuple[str, ...], fault: str) -> None:
    file = tmp_path / "linkage.yaml"
    file.write_text(HEAD + "".join(f"  {line}\n" for line in lines), encoding="utf-8")
    faults = [one for one in catalogue.examine(file, "en") if one.level == "error"]
    assert [f"{one.location.line}:{one.location.column} {one.code}" for one in faults] == ([fault] if fault else [])


def position(file: Path) -> Any:
    return solve(load(file))["positions"][0]


def test_the_logarithm_has_the_published_linkage() -> None:
    """The reference case: lengths over d, angles of the points, largest errors, transmission angle (°)."""
    found = position(LOGARITHM)
    lengths = [found["lengths"][name] / 0.1 for name in ("crank", "coupler", "follower")]
    assert lengths == pytest.approx((0.71302405, 1.65815614, 0.71565657), abs=5e-8)
    driver = [math.degrees(found["pairs"][k]["driver"]) for k in "123"]
    follower = [math.degrees(found["pairs"][k]["follower"]) for k in "123"]
    assert driver == pytest.approx((94.019238, 120.0, 145.980762), abs=1e-6)
    assert follower == pytest.approx((35.612580, 65.097750, 87.051067), abs=1e-6)
    assert math.degrees(found["transmission"]) == pytest.approx(42.3772, abs=5e-5)
    assert math.degrees(found["errors"]["4"]) == pytest.approx(-0.103937, abs=1e-6)
    case: Any = built.case(LOGARITHM, "en")
    φ = np.radians(90 + 60 * (np.array([1.7571, 2.0]) - 1))
    assert np.degrees(case.error_at(φ)) == pytest.approx((0.097651, -0.103937), abs=1e-6)


def test_linkages_close_at_their_three_pairs() -> None:
    """2,000 four-bar linkages, analysed by meeting circles, at three crank angles: their lengths come back.

    Pairs that determine the lengths badly are measured by the closing of the linkage alone.
    """
    chance = np.random.default_rng(5)
    for _ in range(2000):
        a, b, c = chance.uniform(0.3, 2.5, 3)
        start, step = chance.uniform(-3, 3), chance.uniform(0.25, 0.6)
        driver = [start + k * step for k in range(3)]
        side = chance.choice([1, -1])
        follower = []
        for φ in driver:
            to_pin = a * cmath.exp(1j * φ) - 1
            cosine = (abs(to_pin) ** 2 + c**2 - b**2) / (2 * c * abs(to_pin))
            follower.append(cmath.phase(to_pin) + side * math.acos(cosine) if abs(cosine) < 1 else math.nan)
        if any(map(math.isnan, follower)):
            continue
        pairs = ThreePairs(driver, follower, 1.0)
        assert pairs.lengths is not None
        got = np.array(pairs.lengths)
        assert got == pytest.approx((a, b, c), rel=1e-6)
        closed = [
            abs(got[0] * cmath.exp(1j * φ) - 1 - got[2] * cmath.exp(1j * ψ)) - got[1]
            for φ, ψ in zip(driver, follower, strict=True)
        ]
        assert np.abs(closed).max() < 1e-9 * got.max()
        if pairs.side is not None:
            off = np.array(follower) - pairs.angle(np.array(driver), pairs.side)
            assert np.abs(np.remainder(off + math.pi, math.tau) - math.pi).max() < 1e-6


MISTAKES = [
    ("synthesis-whole-range", LOGARITHM, (names.argument(1), names.argument(3))),
    ("synthesis-without-function", LOGARITHM, (names.follower(2),)),
    ("synthesis-sum-of-angles", PAIRS, (names.right_side(2), names.right_side(3))),
    ("synthesis-factors-exchanged", PAIRS, (names.CRANK,)),
    ("synthesis-sign-of-product", PAIRS, (names.COUPLER,)),
]


@pytest.mark.parametrize(("mistake", "file", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(mistake: str, file: Path, where: tuple[str, ...]) -> None:
    check_named(file, mistake, where)


def test_a_class_of_twelve_gets_its_marks(tmp_path: Path) -> None:
    """Right sheets get all marks; the first student exchanges the angles' difference and sum, and goes on from that."""
    text = (
        "kind: synthesis\nreport: {language: en}\nparameters: {task: three-points, function: ln, x: [1, 2], "
        "driver: [90 deg, 150 deg], follower: [30 deg, 90 deg], d: {from: 100 mm, to: 210 mm, step: 10 mm}}\n"
    )
    folder = drawn_class(tmp_path, text)
    graded = graded_class(folder, "synthesis-sum-of-angles", names.right_side(2))
    assert graded.problems == ()
    full = {marking.key.id for marking in graded.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}


@pytest.mark.parametrize("language", languages())
def test_reports_have_the_linkage_and_the_error_of_a_function(language: str) -> None:
    for file, figures in ((LOGARITHM, {"fig.positions", "fig.error"}), (PAIRS, {"fig.positions"})):
        case: Any = built.case(file, language)
        keys = {getattr(block, "key", "") for block in case.document().blocks}
        assert {key for key in keys if key.startswith("fig.")} == figures


def test_the_drawing_has_the_lengths_of_the_linkage() -> None:
    from reportgen.structure.three_point_drawings import placed

    for file in (LOGARITHM, PAIRS):
        D, pins = placed(built.case(file, "en"))  # type: ignore[arg-type]
        b = position(file)["lengths"]["coupler"]
        # The printed angles have ten-thousandths of a degree.
        assert [abs(C - B) for B, C in pins] == pytest.approx([b] * 3, abs=1e-5 * abs(D))


@pytest.mark.parametrize(
    ("function", "x", "driver", "follower", "value"),
    [
        ("sin", (0, 90), (105, 165), (40, 100), lambda x: math.sin(math.radians(x))),
        ("tan", (0, 45), (60, 120), (20, 80), lambda x: math.tan(math.radians(x))),
    ],
)
def test_functions_of_an_angle_are_met_at_three_points(
    tmp_path: Path,
    function: str,
    x: tuple[int, int],
    driver: tuple[int, int],
    follower: tuple[int, int],
    value: Callable[[float], float],
) -> None:
    """Close the loop A B C D anew at each point, and at the ends with the follower off by the structural error."""
    ranges = {"x": x, "driver": driver, "follower": follower}
    lines = "".join(f"  {key}: [{first} deg, {last} deg]\n" for key, (first, last) in ranges.items())
    file = tmp_path / "linkage.yaml"
    file.write_text(f"{HEAD}  task: three-points\n  d: 100 mm\n  function: {function}\n{lines}", encoding="utf-8")
    solved = position(file)
    a, b, c, d = (solved["lengths"][name] for name in ("crank", "coupler", "follower", "frame"))
    low, high = value(x[0]), value(x[1])
    for k, share in (("1", 0.5 - math.sqrt(3) / 4), ("2", 0.5), ("3", 0.5 + math.sqrt(3) / 4)):
        y = value(x[0] + share * (x[1] - x[0]))
        φ = math.radians(driver[0] + share * (driver[1] - driver[0]))
        ψ = math.radians(follower[0] + (y - low) / (high - low) * (follower[1] - follower[0]))
        assert solved["pairs"][k] == pytest.approx({"driver": φ, "follower": ψ}, abs=1e-12)
        assert abs(d + cmath.rect(c, ψ) - cmath.rect(a, φ)) == pytest.approx(b, rel=1e-9)
    for end, place in enumerate(("1", "4")):
        φ, ψ = math.radians(driver[end]), math.radians(follower[end]) + solved["errors"][place]
        assert abs(d + cmath.rect(c, ψ) - cmath.rect(a, φ)) == pytest.approx(b, rel=1e-9)
