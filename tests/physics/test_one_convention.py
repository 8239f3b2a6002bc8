"""One sign a quantity: closed formulas, tables and curves count the same sense as positive, clockwise machines too."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.cases import MachineCase
from reportgen.report.report import Report

ROOT = Path(__file__).parents[2]
KINDS = (
    "engine-single-III",
    "engine-twin-05",
    "engine-v-01",
    "engine-v-02",
    "four-bar-01",
    "four-bar-02",
    "scotch-yoke-01",
    "shaper-01",
    "slider-crank-02",
    "slotted-lever-01",
    "toggle-press-01",
)
"""Every kind with closed formulas."""
AGREE = 1e-9
"""Of the greatest value: two ways of calculation of some hundred operations each."""


def turning(name: str, direction: str, folder: Path) -> Report:
    """The report of an assignment whose crank turns in a direction."""
    text = (ROOT / "assignments" / f"{name}.yaml").read_text(encoding="utf-8")
    if "direction:" in text.partition("positions:")[2].partition("}")[0]:
        text = re.sub(r"direction: *\w*clockwise", f"direction: {direction}", text)
    else:
        text = re.sub(r"positions: *\{", f"positions: {{direction: {direction}, ", text)
    file = folder / f"{name}.yaml"
    file.write_text(text, encoding="utf-8")
    return Report(MachineCase(api.load(file)))


@pytest.fixture(params=["anticlockwise", "clockwise"])
def direction(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.mark.parametrize("name", KINDS)
def test_formulas_have_the_sign_of_tables_and_curves(name: str, direction: str, tmp_path: Path) -> None:
    report = turning(name, direction, tmp_path)
    machine, motion, values = report.machine, report.analysis.motion, report.case.ledger.families
    assert machine.turn == (1 if direction == "anticlockwise" else -1)
    compared = []
    for plan, formula in machine.compared:
        what, _, of = plan.partition(".")
        if what in ("omega", "eps"):
            link = motion.links[int(of)]
            # What tables and curves show, anticlockwise.
            expected = link.omega if what == "omega" else link.epsilon
        elif of in report.slider_senses:
            expected = np.real(np.conj(report.slider_senses[of]) * getattr(motion.points[of], what))
        else:
            continue
        given = values[formula].values
        assert np.abs(given - expected[: given.size]).max() <= AGREE * np.abs(expected).max(), formula
        compared.append(formula)
    assert compared


def test_a_piston_counts_its_way_as_its_velocity(tmp_path: Path) -> None:
    """x grows from the top dead centre on towards the crank, and so v = dx/dt is positive on the way there."""
    report = turning("engine-twin-05", "anticlockwise", tmp_path)
    for pin, link in (("B", 3), ("D", 5)):
        x, v = (report.case.ledger[id].values for id in (f"x.{link}", f"f.v.{pin}"))
        # From top to bottom dead centre the way grows; the positions stand evenly, the dead centres among them.
        falling = np.flatnonzero(np.roll(x, -1) > x + 1e-12)
        assert (v[falling] >= -AGREE).all()
        # A slider on the page moves down there.
        assert report.slider_senses[pin] == pytest.approx(-1j)
