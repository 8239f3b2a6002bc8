"""What moves on a page, as data: plans in their panels, scale bars, the names of forces, Zhukovsky's lever."""

from __future__ import annotations

import numpy as np
import pytest

from reportgen.drawing.animation import BARS, LEAST, MARGIN, PANEL, BarScale, MovingVector, Pane, Track
from reportgen.formula import ids
from reportgen.report.result_tables import reactions
from tests.lanes import matrix
from tests.page.made import MACHINES, Made, made
from tests.report import built

CASES = matrix(
    [pytest.param((path, language), id=f"{path.stem}-{language}") for path, language in MACHINES],
    telling=[(built.SAMPLE, "vi"), (built.SLIDE, built.own_language(built.SLIDE))],
)
ROUND = 1e-6
"""Tracks are of double precision here; what is left is the arithmetic."""


@pytest.fixture(params=CASES, scope="module")
def page(request: pytest.FixtureRequest) -> Made:
    return made(*request.param)


def over(track: Track, samples: int) -> np.ndarray:
    return np.broadcast_to(track.values, samples)


def vectors(pane: Pane) -> list[MovingVector]:
    return [item for item in pane.items if isinstance(item, MovingVector) and not item.beyond]


def test_a_plan_is_as_large_as_its_panel_holds_and_in_its_middle(page: Made) -> None:
    """At the moment at which it is largest it touches two edges; at every other it is within them, at one scale."""
    assert [pane.key for pane in page.animation.panes][:3] == ["machine", "v", "a"]
    room = PANEL - 2 * complex(MARGIN, MARGIN)
    for pane in page.animation.panes[1:]:
        ends = [track for vector in vectors(pane) for track in (vector.start, vector.end)]
        samples = max(track.values.size for track in ends)
        places = np.array([over(track, samples) for track in ends])
        places = np.where(np.isfinite(places), places, 0.0)
        width, height = np.ptp(places.real, axis=0), np.ptp(places.imag, axis=0)
        share = np.maximum(width / room.real, height / room.imag)
        assert share.max() == pytest.approx(1.0, abs=ROUND), pane.key
        middle = (places.real.max(axis=0) + places.real.min(axis=0)) / 2
        assert np.abs(middle).max() < ROUND * room.real
        # A second, finer scale is there only for moments that would be too small to be read.
        assert len(pane.scales) == 1 + (share < LEAST - ROUND).any(), pane.key


def test_bars_have_round_values_and_their_true_lengths(page: Made) -> None:
    for pane in page.animation.panes:
        room = (pane.high - pane.low).real / BARS
        for scale in pane.scales:
            number, length = scale.bar(room)
            assert f"{number.value:e}"[0] in "125"
            assert float(f"{number.value:.0e}") == number.value
            assert 0.25 * room < length < 0.8 * room
    # Where a millimetre of the drawing is 2 mm of the machine.
    number, length = BarScale(2e-3, "segment").bar(100.0)
    assert number.value == pytest.approx(2 * length)


def test_forces_are_called_as_the_report_calls_them(page: Made) -> None:
    """R54, R32: the reaction that a force plan finds, in each joint one."""
    listed = [id for id in reactions(page.report) if "." not in id.removeprefix("R.")]
    on_machine = [v.name for v in vectors(page.animation.panes[0]) if v.layer == "reactions"]
    assert sorted(map(ids.of_force, on_machine)) == sorted(listed)
    told = [value.symbol for value in page.animation.values if value.symbol.base == "R"]
    assert sorted(symbol.sub for symbol in told) == sorted(id.removeprefix("R.") for id in listed)


def test_the_lever_balances(page: Made) -> None:
    """Σ F h′ of all loads about the pole is the power that the driver has to give: Σ F·v + M_cb ω₁ = 0."""
    if not any(pane.key == "lever" for pane in page.animation.panes):
        pytest.skip("nothing loads it")
    pane, animation, machine = page.pane("lever"), page.animation, page.case.analysis.machine
    turns = [animation.knots[:-1] + 360.0 * turn for turn in range(animation.turns)]
    solved = page.solved(np.append(np.concatenate(turns), 360.0 * animation.turns))
    pole, samples = vectors(pane)[0].start, solved.motion.driver.size
    arrows = {vector.name: vector for vector in vectors(pane) if vector.name}
    power = np.zeros(samples)
    for load in solved.loads:
        if load.name not in arrows:
            # A torque alone has no place on the lever.
            power += load.couple * solved.motion.links[load.link].omega
            continue
        start, end = (over(track, samples) for track in (arrows[load.name].start, arrows[load.name].end))
        with np.errstate(invalid="ignore"):
            way = (end - start) / np.abs(end - start)
        arm = ((start - over(pole, samples)).conjugate() * way).imag
        # A force that is nothing has no arrow.
        power += machine.turn * np.nan_to_num(np.abs(load.force) * arm * pane.scales[0].per)
    given = machine.turn * machine.speed * animation.values[-1].values.values
    assert np.abs(power + given).max() < 1e-6 * np.abs(given).max()
