"""Instant centres: as a point of its link the centre stands still, and the lines by it say what the plan says."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.derivation.equation_sides import Side, scheme
from reportgen.derivation.kinematic_entries import links_in_plane_motion
from reportgen.formula.ledger import Ledger
from reportgen.machine.analysis import Analysis

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
EXACT = 1e-9
"""Of the velocities that cancel."""
WITH_CENTRES = (
    *("engine-twin-05", "engine-single-I", "engine-v-01", "slider-crank-02", "four-bar-01", "four-bar-02"),
    *("lever-six-bar-01", "shaper-02", "linkage-8", "linkage-slide"),
)
"""At least one file of every kind but the slotted lever, none of whose links is in plane motion."""


def solved(name: str) -> tuple[Analysis, Ledger, tuple[Side, ...]]:
    analysis = api.analyse(api.load(ASSIGNMENTS / f"{name}.yaml"))
    return analysis, write_ledger(analysis).ledger, links_in_plane_motion(scheme(analysis.machine.linkage))


@pytest.mark.parametrize("name", WITH_CENTRES)
def test_the_centre_stands_still(name: str) -> None:
    """v_B + iω(P − B) = 0 by the numerical motion, wherever the centre can be measured."""
    analysis, ledger, turns = solved(name)
    motion = analysis.motion
    assert turns
    for turn in turns:
        base, link = motion.points[turn.base], motion.links[turn.link]
        measured = np.isfinite(ledger[f"ic.seg.{turn.link}.{turn.base}"].values)
        assert measured.any()
        arm = (ledger[f"ic.{turn.link}"].values - base.p)[measured]
        left = base.v[measured] + 1j * link.omega[measured] * arm
        assert np.abs(left).max() <= EXACT * np.abs(base.v).max()


@pytest.mark.parametrize("name", WITH_CENTRES)
def test_all_three_ways_agree(name: str) -> None:
    """ω and v by the centre are those of the motion; projections on the link are equal, as its length is."""
    analysis, ledger, turns = solved(name)
    motion = analysis.motion
    for turn in turns:
        link = turn.link
        base, end, omega = motion.points[turn.base].v, motion.points[turn.point].v, motion.links[link].omega
        for id, expected in ((f"ic.omega.{link}", np.abs(omega)), (f"ic.v.{link}", np.abs(end))):
            values = ledger[id].values
            measured = np.isfinite(values)
            assert values[measured] == pytest.approx(expected[measured], abs=EXACT * expected.max())
        along = [ledger[f"ic.along.{link}.{point}"].values for point in (turn.base, turn.point)]
        if not turn.measured:
            assert along[0] == pytest.approx(along[1], abs=EXACT * np.abs(base).max())
        else:
            # A slot's point under the pin is rigid with the slotted link all the same.
            assert along[0] == pytest.approx(along[1], abs=1e-7 * np.abs(base).max())


def test_a_link_without_rotation_has_no_centre() -> None:
    """At the middle of the stroke of a central slider-crank the rod is parallel to itself."""
    analysis, ledger, (turn,) = solved("slider-crank-01")
    still = np.abs(analysis.motion.links[turn.link].omega) < 1e-12 * analysis.machine.speed
    for id in (f"ic.seg.{turn.link}.{turn.base}", f"ic.omega.{turn.link}"):
        assert np.isnan(ledger[id].values[still]).all()


def test_the_slotted_lever_has_none() -> None:
    assert solved("slotted-lever-02")[2] == ()


def test_a_textbook_rod_turns_about_the_corner_of_a_square(tmp_path: Path) -> None:
    """Crank 0.2 m at 45° and 10 rad/s, rod 1 m square to it, level guide: PA = 1 m, so ω = 2 rad/s, v_B = 2√2 m/s.

    A worked example of plane motion (crank OA, rod AB, slider B), by the instant centre.
    """
    file = tmp_path / "example.yaml"
    e = 1e3 * (0.2 - 1.0) * math.sin(math.pi / 4)
    file.write_text(
        "kind: slider-crank\npositions: {count: 4, start: 45 deg}\nparameters: {r: 200 mm, l: 1000 mm, "
        f"e: {e:.12f} mm, omega1: 10 rad/s}}\ndrawing: {{crank: 40 mm}}\n",
        encoding="utf-8",
    )
    analysis = api.analyse(api.load(file))
    ledger = write_ledger(analysis).ledger
    assert ledger["ic.2"].values[0] == pytest.approx((1 + 1j) * 1.2 / math.sqrt(2), rel=1e-9)
    assert ledger["ic.seg.2.B"].values[0] == pytest.approx(0.2)
    assert ledger["ic.omega.2"].values[0] == pytest.approx(2.0, rel=1e-9)
    assert ledger["ic.v.2"].values[0] == pytest.approx(2 * math.sqrt(2), rel=1e-9)
