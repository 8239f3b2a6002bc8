"""The region that is shaded while a point is pulled, against Grashof's theorem, and its end with the pull."""

from __future__ import annotations

import random
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from reportgen.base.yaml_source import read_source
from reportgen.cases import open_case
from reportgen.machine.kinematics import solve_motion
from reportgen.page.edit_session import EditSession
from reportgen.page.pull_regions import Requirement, _filtered, region
from reportgen.page.pulled_values import Pull, placing_values

FILE = Path(__file__).parents[2] / "assignments" / "four-bar-01.yaml"
CRANK, FRAME = 0.120, 0.400
ANGLE = 1.0
STEPS, REACH = 16, 0.14


def turns_fully(coupler: float, rocker: float, slack: float = 0.0) -> bool:
    """By Grashof: the crank is the shortest link, and it and the longest are shorter than the two others."""
    first, second, third, last = sorted((CRANK, coupler, rocker, FRAME))
    return first == CRANK and first + last < second + third - slack


def is_inside(place: complex, corners: np.ndarray) -> bool:
    """Whether a place is in a polygon: a ray from it meets the boundary an odd number of times."""
    odd = False
    for start, end in zip(corners, np.roll(corners, -1), strict=True):
        if (start.imag > place.imag) != (end.imag > place.imag):
            share = (place.imag - start.imag) / (end.imag - start.imag)
            odd ^= place.real < start.real + share * (end.real - start.real)
    return odd


def test_the_region_of_a_pin_is_that_of_grashof() -> None:
    linkage, values = placing_values(read_source(FILE), FILE)
    assert linkage is not None
    pull = Pull.of(linkage, values, "C", ANGLE, ())
    shapes = region(pull, Requirement(), REACH, STEPS, lambda: True)
    assert shapes
    points = solve_motion(linkage, ANGLE, 1.0).points
    crank_pin, pivot = complex(points["B"].p[0]), complex(points["D"].p[0])
    for place in np.concatenate(shapes):
        assert turns_fully(abs(place - crank_pin), abs(place - pivot))
    # Between two steps the region may end a step too early.
    chance, here, step = random.Random(1), pull.at(np.zeros(2)), 2 * REACH / STEPS
    told = 0
    for _ in range(300):
        place = here + REACH / 2 * complex(chance.uniform(-1, 1), chance.uniform(-1, 1))
        if turns_fully(abs(place - crank_pin), abs(place - pivot), 3 * step):
            told += 1
            assert any(is_inside(place, shape) for shape in shapes)
    assert told > 30


def test_a_region_ends_with_its_pull(tmp_path: Path) -> None:
    (file := tmp_path / "mine.yaml").write_bytes(FILE.read_bytes())
    edited = EditSession(partial(open_case, file), "en", path=file)
    try:
        edited.renew()
        takes = edited.takes
        asked = {"grab": 1, "point": "B", "angle": 30.0, "locked": []}
        shown = takes["region.json"]({**asked, "count": 4})
        assert isinstance(shown, dict)
        assert shown["lines"], "the crank pin goes along the crank"
        assert shown["path"].startswith("M")
        locked = takes["region.json"]({**asked, "grab": 2, "locked": [["parameters", "AB"]], "count": 4})
        assert locked == {}
        linkage, values = placing_values(read_source(FILE), FILE)
        assert linkage is not None
        pull = Pull.of(linkage, values, "C", ANGLE, ())
        assert region(pull, Requirement(), REACH, STEPS, lambda: False) is None
    finally:
        edited.close()


SHORT = {"AB: 120": "AB: 60", "BC: 340": "BC: 180", "CD: 280": "CD: 180", "AD: 400": "AD: 120", "BF: 220": "BF: 90"}


@pytest.mark.parametrize(
    ("name", "changes", "pulled", "least", "greatest"),
    [("four-bar-01", SHORT, "D", 0.060, 1.0), ("slotted-lever-01", {}, "B", 0.0, 0.150 - 0.080)],
)
def test_a_region_keeps_the_checks_of_the_kind(
    tmp_path: Path, name: str, changes: dict[str, str], pulled: str, least: float, greatest: float
) -> None:
    """Link 3 stays a rocker as the file says, though D nearer to A lets both links turn; the block stays in its slot.

    Faults that the file has already are no reason to shade nothing.
    """
    text = FILE.with_name(f"{name}.yaml").read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (file := tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    edited = EditSession(partial(open_case, file), "en", path=file)
    try:
        edited.renew()
        resident = edited.pulls.resident()
        assert resident is not None
        asked = {"point": pulled, "angle": 30.0, "locked": [], "count": 8}
        centre, scale = resident.samples.machine.linkage.ground["A"], resident.samples.scale

        def distances(grab: int) -> np.ndarray:
            answer = edited.takes["region.json"]({**asked, "grab": grab})
            assert isinstance(answer, dict)
            places = [complex(*map(float, corner.split())) for corner in re.split("[ML]", answer["path"]) if corner]
            return np.asarray(np.abs(np.array(places).conj() / scale - centre))

        found = distances(1)
        assert found.size > 4
        assert least < found.min() < found.max() < greatest
        file.write_text(text.replace("worked_positions: [2]", "worked_positions: [99]"), encoding="utf-8")
        assert distances(2) == pytest.approx(found)
    finally:
        edited.close()


def test_slow_checks_are_made_at_few_places() -> None:
    """All along a border, and in steps elsewhere."""
    x, y = np.meshgrid(np.arange(25), np.arange(25), indexing="ij")
    quick, slow = x + y > 5, 2 * x + y < 55
    asked: list[tuple[int, ...]] = []

    def check(index: tuple[int, ...]) -> bool:
        asked.append(index)
        return bool(slow[index])

    assert (_filtered(quick, check) == (quick & slow)).all()
    assert len(asked) == len(set(asked)) < 220


@pytest.mark.parametrize(("name", "point"), [("linkage-slide", "C"), ("slider-crank-01", "B")])
def test_other_drivers_have_regions_too(name: str, point: str) -> None:
    case = open_case(FILE.with_name(f"{name}.yaml"))
    machine = getattr(case, "machine", case).analysis.machine  # type: ignore[attr-defined]
    linkage, values = placing_values(read_source(FILE.with_name(f"{name}.yaml")), FILE.with_name(f"{name}.yaml"))
    assert linkage is not None
    pull = Pull.of(linkage, values, point, float(machine.angles(np.array(ANGLE))), ())
    shapes = region(pull, Requirement.of(machine), 0.05, 4, lambda: True)
    assert shapes
    assert np.isfinite(np.concatenate(shapes)).all()
