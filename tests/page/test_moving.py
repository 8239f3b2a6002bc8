"""The machine in motion, in a browser: what it draws is what the solver says and what the report's figures show."""

from __future__ import annotations

import random
import time
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import reportgen
from reportgen import api
from reportgen.drawing.vector_plan import Construction, Plan
from reportgen.page import page as page_of
from reportgen.report.plan_figures import POLE, force_construction, motion_construction
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import MM, Made

PATIENCE = 20.0
"""Seconds that a browser on a busy machine may take to its next frame."""

pytestmark = proof

ANGLES = 20
SEEN = 0.03
"""A shorter vector (mm) is not drawn."""
ROUND = 0.002
"""The thousandths of a millimetre that a page writes."""
MEASURED = 1.0
"""A shorter vector (mm) is not compared with the report's figure."""
COVERED = 0.5
"""What letters may reach into one another by what a screen rounds (px)."""
BAR = """
const bar = document.querySelector(`[data-stage='${arguments[0]}'] [data-bar]:not([hidden])`);
return [bar.querySelector("path").getBBox().width, /[\\d.,]+/.exec(bar.textContent)[0]];
"""
"""The length (mm) of the bar of a pane and the number beside it."""


def angles(page: Made) -> np.ndarray:
    """Angles of the cycle that are no samples, the same in every run."""
    chance = random.Random(page.file.stem)
    return np.array([chance.uniform(0.0, 360.0 * page.animation.turns) for _ in range(ANGLES)])


def vectors(pane: dict[str, list[list[float]]]) -> dict[str, list[tuple[complex, complex]]]:
    """(start, end) of each vector by its name, y upwards."""
    return {
        name: [(complex(x1, -y1), complex(x2, -y2)) for x1, y1, x2, y2 in ends]
        for name, ends in pane["vectors"].items()
    }


INSTANTS = """
kind: four-bar
report: {language: en, extent: short}
positions: {at: [50 deg, 110 deg, 200 deg]}
parameters:
  {AB: 120 mm, BC: 350 mm, CD: 300 mm, AD: 400 mm, omega1: 12 rad/s, epsilon1: 60 rad/s2, m2: 5 kg,
   springs: [{link: 3, at: C, to: [300 mm, 420 mm], c: 4 N/mm, free: 90 mm}]}
"""
STEP = """
document.getElementById("angle").dispatchEvent(new KeyboardEvent("keydown", { key: arguments[0], bubbles: true }));
return document.getElementById("told").textContent;
"""


def test_single_instants_are_stepped_from_one_to_the_next(tmp_path: Path, browser: Browser) -> None:
    """There is nothing between them: a key steps on, and any other angle is the nearest of them."""
    case, file = reportgen.open(INSTANTS).case, tmp_path / "report.html"
    file.write_text(page_of(case, api.document(case.assignment)), encoding="utf-8")
    browser.show(file)
    browser.run("if (moving.playing()) document.getElementById('play').click(); moving.seek(0)")
    told = [browser.run(STEP, key) for key in ("ArrowRight", "ArrowRight", "ArrowLeft")]
    assert told == ["II: 110°", "III: 200°", "II: 110°"]
    browser.run("moving.seek(10)")
    assert browser.run("return document.getElementById('told').textContent") == "I: 50°"
    assert browser.messages() == []


def test_it_opens_in_silence_asks_for_nothing_and_plays(page: Made, browser: Browser) -> None:
    browser.show(page.file)
    assert browser.run("return moving.playing()")
    before = browser.run("return moving.angle()")
    patient = time.monotonic() + PATIENCE
    while browser.run("return moving.angle()") == before:
        assert time.monotonic() < patient, "it stands"
        time.sleep(0.05)
    browser.run("document.getElementById('play').click()")
    assert not browser.run("return moving.playing()")
    # Each numbered position has its button, the way on from one to the next a key.
    angle = page.animation.positions[0][1]
    browser.run("document.querySelector('[data-position=\"0\"]').click()")
    assert browser.run("return moving.angle()") == pytest.approx(angle, abs=1e-6)
    assert browser.messages() == []
    assert [url for url in browser.requests() if not url.startswith("data:")] == [page.file.as_uri()]


def test_drawn_points_are_where_the_solver_has_them(page: Made, browser: Browser) -> None:
    """Every point has a corner or a sign of a link there, to 0.1 % of the crank; links are drawn rigid by that."""
    browser.keep(page.file)
    at = angles(page)
    motion = page.solved(at).motion
    ground = page.case.analysis.machine.linkage.ground
    for index, shown in enumerate(browser.drawn(at)):
        corners = np.array([complex(x, -y) for x, y in shown["machine"]["carried"]])
        for name, point in motion.points.items():
            if name not in ground:
                off = np.abs(corners - complex(point.p[index]) * page.scale).min()
                assert off < 1e-3 * page.crank, (name, at[index])


def test_plans_show_the_rates_and_close(page: Made, browser: Browser) -> None:
    browser.keep(page.file)
    at = angles(page)
    solved = page.solved(at)
    for index, shown in enumerate(browser.drawn(at)):
        for what in "va":
            per = page.per(what, at[index])
            greatest = max(float(np.abs(getattr(p, what)).max()) for p in solved.motion.points.values())
            for name, ((start, end),) in vectors(shown[what]).items():
                if name in solved.motion.points:
                    true = complex(getattr(solved.motion.points[name], what)[index])
                    assert (end - start) * per == pytest.approx(true, abs=2e-3 * greatest), (what, name, at[index])
        for polygon in page.case.polygons:
            drawn = vectors(shown[f"R{polygon.name}"])
            size = max((abs(end - start) for ends in drawn.values() for start, end in ends), default=0.0)
            ways = [drawn.get(edge.start + edge.end) for edge in polygon.edges]
            closing = sum(way[0][1] - way[0][0] for way in ways if way)
            # What is too short to be drawn may be missing.
            assert abs(closing) < len(ways) * (ROUND + SEEN * ways.count(None)) + 1e-4 * size


def unrounded(page: Made, construction: Construction[str], k: int) -> Plan:
    """A plan of the report at a position, in mm, of values that are not rounded as they are written down."""
    ledger = page.case.ledger
    return construction.placed(lambda id: 0j if id == POLE else complex(ledger[id].at(k)) * MM)


def test_at_numbered_positions_plans_are_the_report_s_figures(page: Made, browser: Browser) -> None:
    browser.keep(page.file)
    report, machine = page.report, page.case.analysis.machine
    constructions = {what: motion_construction(report, what) for what in ("v", "a")}
    constructions |= {f"R{polygon.name}": force_construction(report, polygon) for polygon in page.case.polygons}
    numbers = sorted({*page.case.assignment.worked_positions, 1, machine.positions})
    found = browser.drawn([page.animation.positions[k - 1][1] for k in numbers])
    for k, shown in zip(numbers, found, strict=True):
        turn = (k - 1) % machine.count + 1
        expected = {key: unrounded(page, one, k if key[0] == "R" else turn) for key, one in constructions.items()}
        for key, plan in expected.items():
            own = float(page.case.ledger[f"mu.{key}"].at(k if key.startswith("R") else None)) / MM
            larger = own / page.per(key, page.animation.positions[k - 1][1])
            drawn = vectors(shown[key])
            seen = [v for v in plan.vectors if v.length > MEASURED / larger]
            for vector in seen:
                # Each moment's plan is in the middle of its panel: its places are compared from one corner of it.
                base, expected_start = drawn[seen[0].name][0][0], larger * (vector.start - seen[0].start)
                way = larger * (vector.end - vector.start)
                off = min(abs(s - base - expected_start) + abs(e - s - way) for s, e in drawn[vector.name])
                assert off < 4 * ROUND, (key, vector.name, k)


def test_a_bar_says_what_the_arrows_beside_it_stand_for(page: Made, browser: Browser) -> None:
    """The one bar that is shown, by its drawn length and its value as read, against the solver."""
    browser.keep(page.file)
    for angle in (page.animation.positions[1][1], page.animation.positions[-1][1]):
        solved, (shown,) = page.solved([angle]), browser.drawn([angle])
        sizes = {what: {n: abs(getattr(p, what)[0]) for n, p in solved.motion.points.items()} for what in "va"}
        for polygon in page.case.polygons:
            edges = (*polygon.edges, *polygon.reads)
            found = ((edge, solved.forces.reactions.get(edge.name)) for edge in edges)
            sizes[f"R{polygon.name}"] = {edge.start + edge.end: abs(one.force[0]) for edge, one in found if one}
        for key, true in sizes.items():
            length, value = browser.run(BAR, key)
            per = float(value.replace(",", ".")) / length
            for name, ends in vectors(shown[key]).items():
                for start, end in ends if name in true else ():
                    assert abs(end - start) * per == pytest.approx(true[name], rel=1e-3, abs=0.02 * per), (key, name)


def test_no_label_covers_another(page: Made, browser: Browser) -> None:
    """At 36 moments of a page as it opens, on a wide and on a narrow screen; no point of the machine is unnamed."""
    for width in (1440, 390):
        browser.show(page.file, width=width, still=True)
        for moment, panes in enumerate(browser.labels([10.0 * page.animation.turns * n for n in range(36)])):
            # Its names and one bar.
            assert len(panes["machine"]) == len(page.case.analysis.motion.points) + 1, moment
            for key, boxes in panes.items():
                for (left, top, right, bottom, one), (*low, x, y, other) in combinations(boxes, 2):
                    apart = max(left - x, low[0] - right, top - y, low[1] - bottom)
                    assert apart > -COVERED, (key, moment, one, other)
    browser.leave()


def test_between_samples_the_error_is_below_the_one_stated(page: Made) -> None:
    chance = random.Random(page.file.stem)
    at = np.array([chance.uniform(0.0, 360.0) for _ in range(400)])
    at.sort()
    motion = page.solved(at).motion
    worst = 0.0
    for spot in page.animation.panes[0].spots:
        true = motion.points[spot.name]
        worst = max(worst, float(np.abs(page.between(spot.on_stage, at) - true.p * page.scale).max()))
        for shown, rate in ((spot.velocity, true.v), (spot.acceleration, true.a)):
            off = np.abs(page.between(shown, at) - rate).max()
            assert off <= 1.05 * page.animation.errors.share * np.abs(rate).max() + 1e-12, spot.name
    assert worst <= page.animation.errors.place
    # It is no idle bound: somewhere a curve is so much bent.
    assert worst > page.animation.errors.place / 4
    assert page.animation.errors.place < 1e-3 * page.crank


def test_a_point_tells_its_motion(page: Made, browser: Browser) -> None:
    browser.keep(page.file)
    spots = page.animation.panes[0].spots
    angle = page.animation.positions[1][1]
    browser.run("moving.pause(); moving.seek(arguments[0])", angle)
    motion = page.solved([angle]).motion
    chosen = "const s = document.getElementById('point'); s.value = arguments[0]; s.dispatchEvent(new Event('change'));"
    for index, spot in enumerate(spots):
        browser.run(chosen, str(index))
        for what in "va":
            shown = browser.run('return document.querySelector(`[data-of="${arguments[0]}"]`).textContent', what)
            true = float(np.abs(getattr(motion.points[spot.name], what)[0]))
            number = float(shown.replace(",", ".").replace("−", "-"))
            assert number == pytest.approx(true, rel=2e-4, abs=1e-5), (spot.name, what)
