"""The machine in motion, in a browser: what it draws is what the solver says and what the report's figures show."""

from __future__ import annotations

import random
import re
import time

import numpy as np
import pytest

from reportgen.drawing.plan import INVISIBLE
from reportgen.report.plans import force_plan, motion_plan
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import MM, Made

pytestmark = proof

ANGLES = 20
SEEN = 0.03
"""A shorter vector (mm) is not drawn."""
ROUND = 0.002
"""The thousandths of a millimetre that a page writes."""


def angles(page: Made) -> np.ndarray:
    """Angles of the cycle that are no samples, the same in every run."""
    chance = random.Random(page.file.stem)
    return np.array([chance.uniform(0.0, 360.0 * page.film.turns) for _ in range(ANGLES)])


def vectors(stage: dict[str, list[list[float]]]) -> dict[str, list[tuple[complex, complex]]]:
    """(start, end) of each vector by its name, y upwards."""
    return {
        name: [(complex(x1, -y1), complex(x2, -y2)) for x1, y1, x2, y2 in ends]
        for name, ends in stage["vectors"].items()
    }


def test_it_opens_in_silence_asks_for_nothing_and_plays(page: Made, browser: Browser) -> None:
    browser.show(page.file)
    assert browser.run("return moving.playing()")
    before = browser.run("return moving.angle()")
    time.sleep(0.3)
    after = browser.run("return moving.angle()")
    assert before != after
    browser.run("document.getElementById('play').click()")
    assert not browser.run("return moving.playing()")
    # Each numbered position has its button, the way on from one to the next a key.
    angle = page.film.positions[0][1]
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
    solved, ledger = page.solved(at), page.case.ledger
    for index, shown in enumerate(browser.drawn(at)):
        for what in "va":
            per = float(ledger[f"mu.{what}"].values[0]) / MM
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


def test_at_numbered_positions_plans_are_the_report_s_figures(page: Made, browser: Browser) -> None:
    browser.keep(page.file)
    report, machine = page.report, page.case.analysis.machine
    numbers = sorted({*page.case.assignment.worked_positions, 1, machine.positions})
    found = browser.drawn([page.film.positions[k - 1][1] for k in numbers])
    for k, shown in zip(numbers, found, strict=True):
        turn = (k - 1) % machine.count + 1
        expected = {what: motion_plan(report, what, turn) for what in ("v", "a")}
        for polygon in page.case.polygons:
            expected[f"R{polygon.name}"] = force_plan(report, polygon, k)
        for key, plan in expected.items():
            drawn = vectors(shown[key])
            for vector in plan.vectors:
                if vector.length > max(SEEN, INVISIBLE):
                    ends = drawn[vector.name]
                    off = min(abs(start - vector.start) + abs(end - vector.end) for start, end in ends)
                    assert off < ROUND * 2, (key, vector.name, k)


def test_a_force_plan_says_the_scale_that_it_has_at_the_moment(page: Made, browser: Browser) -> None:
    """At a numbered position that of the report's figure; a vector's length times it is the force."""
    browser.keep(page.file)
    shown = "return document.querySelector(`[data-stage='${arguments[0]}'] [data-scale]:not([hidden])`).textContent"
    for polygon in page.case.polygons:
        family = page.case.ledger[f"mu.R{polygon.name}"]
        for k in sorted({1, page.case.analysis.machine.positions, *page.case.assignment.worked_positions}):
            browser.run("moving.pause(); moving.seek(arguments[0])", page.film.positions[k - 1][1])
            number = re.search(r"=([\d.,]+)", re.sub(r"\s", "", browser.run(shown, f"R{polygon.name}")))
            assert number is not None
            assert float(number[1].replace(",", ".")) == pytest.approx(float(family.at(k)) / family.how.scale)


def test_between_samples_the_error_is_below_the_one_stated(page: Made) -> None:
    chance = random.Random(page.file.stem)
    at = np.array([chance.uniform(0.0, 360.0) for _ in range(400)])
    at.sort()
    motion = page.solved(at).motion
    worst = 0.0
    for spot in page.film.stages[0].spots:
        true = motion.points[spot.name]
        worst = max(worst, float(np.abs(page.between(spot.on_stage, at) - true.p * page.scale).max()))
        for shown, rate in ((spot.velocity, true.v), (spot.acceleration, true.a)):
            off = np.abs(page.between(shown, at) - rate).max()
            assert off <= 1.05 * page.film.errors.share * np.abs(rate).max() + 1e-12, spot.name
    assert worst <= page.film.errors.place
    # It is no idle bound: somewhere a curve is so much bent.
    assert worst > page.film.errors.place / 4
    assert page.film.errors.place < 1e-3 * page.crank


def test_a_point_tells_its_motion(page: Made, browser: Browser) -> None:
    browser.keep(page.file)
    spots = page.film.stages[0].spots
    angle = page.film.positions[1][1]
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
