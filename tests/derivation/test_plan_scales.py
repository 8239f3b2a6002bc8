"""Plans one measures on: worked ones fill their space, and what is printed of them is what is drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.base.units import SERIES, nice_down, nice_up
from reportgen.case.answer_key import KeyRow
from reportgen.cases import MachineCase
from reportgen.derivation.kinematic_entries import What
from reportgen.derivation.load_entries import Polygon
from reportgen.derivation.plan_scales import SHEET_BOXES, TEXT_BOX
from reportgen.drawing.vector_plan import Plan
from reportgen.marking.judging import mark
from reportgen.report.context import ReportContext
from reportgen.report.plan_figures import force_plan, motion_plan
from tests.marking import students
from tests.report import built

MM = 1e3
LEAST_MOTION, LEAST_FORCES = 60.0, 100.0
"""Millimetres that a lecturer asks of a worked plan."""
READ = 0.01
"""Millimetres to which a length is read: a plan drawn from rounded numbers is so much shorter."""
FINER = 2.0
"""From one member of the series to the next finer one a drawing grows at most so much."""


@pytest.fixture(params=built.FILES, ids=lambda file: file.stem, scope="module")
def case(request: pytest.FixtureRequest) -> MachineCase:
    return built.case(request.param, built.own_language(request.param))


def size(plan: Plan) -> tuple[float, float]:
    """Width and height (mm) of all that a plan draws."""
    ends = np.array([end for v in plan.drawn() for end in (v.start, v.end)] + [point.at for point in plan.points])
    return float(np.ptp(ends.real)), float(np.ptp(ends.imag))


def finer(scale: float) -> float:
    """How much a plan grows with the next smaller scale of the series."""
    return scale / nice_down(scale * (1 - 1e-9))


def has_room(plan: tuple[float, float], growth: float, box: tuple[float, float]) -> bool:
    return all(own * growth <= side * MM * (1 + 1e-9) for own, side in zip(plan, box, strict=True))


def read_from(case: MachineCase, polygon: Polygon) -> list[str]:
    """The plans that gave the reactions which are laid off in another one: R₂₁ in the driver's is R₁₂ of group 2, 3."""
    names = [edge.name[:1] + edge.name[:0:-1] for edge in polygon.carried]
    return [other.name for other in case.polygons for edge in (*other.edges, *other.reads) if edge.name in names]


def test_worked_force_plans_are_100_mm_long_or_as_long_as_the_page_allows(case: MachineCase) -> None:
    """Or as what is laid off in them was read: a longer plan would draw what a ruler left of it larger."""
    report = ReportContext(case)
    for k in report.worked_forces:
        for polygon in case.polygons:
            drawn = size(force_plan(report, polygon, k))
            scale = report.ledger.number(f"mu.R{polygon.name}", k).value
            read_at = [report.ledger.number(f"mu.R{plan}", k).value for plan in read_from(case, polygon)]
            assert scale >= max(read_at, default=0.0)
            if max(drawn) > 1e-6 and scale not in read_at:
                assert max(drawn) >= LEAST_FORCES - READ or not has_room(drawn, finer(scale), TEXT_BOX), polygon
                assert has_room(drawn, 1.0, TEXT_BOX)


@pytest.mark.parametrize("what", ["v", "a"])
def test_worked_motion_plans_are_60_mm_long_or_as_long_as_the_sheets_allow(case: MachineCase, what: What) -> None:
    report = ReportContext(case)
    every = [size(motion_plan(report, what, k)) for k in range(1, report.count + 1)]
    largest = max(width for width, _ in every), max(height for _, height in every)
    growth = finer(report.ledger.number(f"mu.{what}").value)
    for k in report.worked:
        drawn = every[k - 1]
        limited = not has_room(drawn, growth, TEXT_BOX) or not any(
            has_room(largest, growth, box) for box in SHEET_BOXES
        )
        assert max(drawn) >= LEAST_MOTION * (1 - 1e-9) or limited


def test_chosen_scales_are_of_the_series_and_of_one_size_for_all_velocities(case: MachineCase) -> None:
    ledger = case.ledger
    chosen = [id for id in ledger.families if id.startswith("mu.R") or id in ("mu.v", "mu.a")]
    for id in chosen:
        if ledger[id].definition is None:
            for value in ledger[id].values / ledger[id].how.scale:
                mantissa = value / 10 ** math.floor(math.log10(value) + 1e-12)
                assert min(abs(mantissa - member) for member in SERIES) < 1e-9
        assert id.startswith("mu.R") or len(ledger[id].values) == 1


def test_printed_segments_times_the_printed_scale_of_their_position_are_the_forces(case: MachineCase) -> None:
    """By vectors of the ledger alone: |F| / μ is the segment at every position, whatever scale it has."""
    ledger = case.ledger
    for polygon in case.polygons:
        for edge in (*polygon.edges, *polygon.reads):
            drawn = ledger[f"seg.{polygon.name}.{edge.name}"].values * ledger[f"mu.R{polygon.name}"].values
            true = np.abs(ledger[f"F.{edge.name}"].values)
            # Dust of forces that are nothing: a billionth of the largest.
            np.testing.assert_allclose(
                drawn, np.broadcast_to(true, drawn.shape), rtol=1e-9, atol=1e-9 * np.nanmax(true, initial=1e-9)
            )


def test_marking_takes_each_force_plan_at_the_scale_of_its_position() -> None:
    """Two worked positions, one plan drawn at 2.5 times the key's scale, the other at the key's."""
    guide = students.scheme("engine-v-02", (2, 18))
    scales = guide.rows["mu.R45"].values
    assert guide.rows["mu.R45"].positions == (2, 18)
    assert scales[1] != scales[17]

    def cell(row: KeyRow, k: int, value: float) -> float:
        if k != 18:
            return value
        return value * 2.5 if row.id == "mu.R45" else value / 2.5 if row.id.startswith("seg.45.") else value

    marking = mark(guide, students.sheet(guide, cell))
    assert marking.points == marking.out_of


@pytest.mark.parametrize("value", [0.0012, 0.6, 1.0, 3.999999, 7.3, 5e7])
def test_nice_down_is_the_member_just_below(value: float) -> None:
    below = nice_down(value)
    assert below <= value < FINER * below * (1 + 1e-9)
    assert nice_up(below) == below
