"""Positions that mirror others are known by the geometry of their machine, and their plans are told, not drawn."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.derivation.kinematic_entries import What
from reportgen.drawing.mirrored_plans import mirrored
from reportgen.drawing.vector_plan import Plan, PlanVector
from reportgen.report.context import ReportContext
from reportgen.report.plan_figures import motion_plan

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"


def plans_of(name: str, what: What) -> dict[int, Plan]:
    report = ReportContext(open_case(ASSIGNMENTS / f"{name}.yaml"))
    return {k: motion_plan(report, what, k) for k in range(1, report.count + 1)}


@pytest.mark.parametrize("what", ["v", "a"])
@pytest.mark.parametrize("name", ["engine-twin-05", "slider-crank-01"])
def test_a_centric_slider_crank_mirrors_itself_in_its_line(name: str, what: str) -> None:
    """Position k from the dead centre and N + 2 − k."""
    found = mirrored(plans_of(name, what))
    assert dict(zip(found.of, found.at, strict=True)) == {2: 8, 3: 7, 4: 6}


@pytest.mark.parametrize("name", ["four-bar-01", "slider-crank-02", "toggle-press-01", "engine-single-I"])
def test_what_is_not_symmetric_is_drawn(name: str) -> None:
    assert mirrored(plans_of(name, "a")).at == ()


def test_one_vector_off_is_no_mirror_image() -> None:
    def plan(*ends: complex) -> Plan:
        return Plan(tuple(PlanVector(str(n), 0j, end) for n, end in enumerate(ends)))

    pairs = {1: plan(30 + 10j, 20 - 5j), 2: plan(40 + 3j, 5j), 3: plan(40 - 3j, -5j), 4: plan(30 - 10j, 20 + 5j)}
    assert mirrored(pairs).at == (4, 3)
    assert mirrored(pairs | {3: plan(40 - 3j, -5.1j)}).at == ()
    assert mirrored(pairs | {4: plan(30 - 10j, 20 - 5j)}).at == ()
