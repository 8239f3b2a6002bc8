"""The true motion of a machine in a browser: steady, start and stop as time goes, the working point of the drive."""

from __future__ import annotations

import time

import numpy as np
import pytest

from reportgen.motion.true_motion import motion_in
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import Made, made
from tests.page.test_moving import PATIENCE
from tests.report import built

pytestmark = proof

CHOOSE = """
const select = document.getElementById("run");
select.value = arguments[0];
select.dispatchEvent(new Event("change"));
"""
TOLD = 'return document.getElementById("told").textContent'
DOT = """
const [chart] = [...document.querySelectorAll("[data-chart]")].slice(-1);
return chart.querySelector(".dot").getAttribute("transform");
"""


@pytest.fixture(scope="module")
def driven() -> Made:
    return made(built.ROOT / "assignments" / "slider-crank-03.yaml", "en")


def test_runs_are_those_of_the_solver(driven: Made) -> None:
    runs = {run.key: run for run in driven.animation.runs}
    motion = motion_in(driven.case.analysis)
    assert set(runs) == {"steady", "start", "stop"}
    assert runs["steady"].time[-1] == pytest.approx(motion.alone.period)
    assert runs["stop"].speed[-1] == 0
    for run in runs.values():
        assert (np.diff(run.time) >= 0).all()


def test_a_stop_plays_to_its_end_and_the_steady_motion_is_at_each_place(driven: Made, browser: Browser) -> None:
    browser.show(driven.file)
    assert browser.run("return document.getElementById('run').options.length") == 4
    browser.run("if (moving.playing()) document.getElementById('play').click()")
    browser.run(CHOOSE, "1")
    assert "t = 0.000 s" in browser.run(TOLD)
    assert "ω = 0.00 rad/s" in browser.run(TOLD)
    at_rest = browser.run(DOT)
    # The shortest of the three: slow frames on a busy machine make it no longer than patience.
    browser.run(CHOOSE, "2")
    assert browser.run(DOT) != at_rest
    browser.run("document.getElementById('play').click()")
    patient = time.monotonic() + PATIENCE
    while browser.run("return moving.playing()"):
        assert time.monotonic() < patient, "it does not come to an end"
        time.sleep(0.1)
    assert "t = 0.123 s, ω = 0.00 rad/s" in browser.run(TOLD)
    assert browser.run("return moving.angle()") == pytest.approx(108.13068, abs=1e-3)
    # A numbered position is shown at constant speed again.
    browser.run("document.querySelector('[data-position=\"2\"]').click()")
    assert "t =" not in browser.run(TOLD)
    browser.run(CHOOSE, "0")
    browser.run("document.querySelector('[data-position=\"2\"]').click()")
    assert "ω = 24.82 rad/s" in browser.run(TOLD)
    assert browser.messages() == []
