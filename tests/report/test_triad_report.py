"""The report of a machine with a group of class III: its sections, figures and plans, in all languages."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from reportgen.base.units import MM
from reportgen.cases import open_case
from reportgen.document import Cell, Figure, Plate, Table, Value
from reportgen.report.context import ReportContext
from reportgen.report.force_figures import separated
from reportgen.report.plan_figures import force_plan, motion_plan
from reportgen.report.triad_figures import TRIALS, placed

R1 = """\
kind: linkage
positions: {count: 8}
report: {worked_positions: [3], extent: short}
parameters:
  frame: {O: [0 mm, 0 mm], B: [300 mm, -30 mm], C: [70 mm, 300 mm]}
  driver: {type: crank, centre: O, pin: A, length: 50 mm, omega1: 20 rad/s}
  groups:
    - type: 3RRR
      plate: 3
      legs:
        - {link: 2, joints: [A, D], length: 130 mm}
        - {link: 4, joints: [B, E], length: 190 mm}
        - {link: 5, joints: [C, F], length: 150 mm}
      at: {E: [100 mm, 0 mm], F: [60 mm, 140 mm]}
      near: {D: [83 mm, 160 mm]}
      near_at: 60 deg
  points: {S3: {link: 3, at: [53.3 mm, 46.7 mm]}}
  masses: [{link: 3, at: S3, m: 4 kg, J: 0.012 kg m2}]
  loads: [{by: constant, link: 4, M: 30 N m, against: motion}]
"""


@cache
def report(folder: Path, language: str = "en", extent: str = "short") -> ReportContext:
    file = folder / f"r1-{extent}.yaml"
    file.write_text(R1.replace("short", extent), encoding="utf-8")
    return ReportContext(open_case(file, language=language))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("r1")


@pytest.mark.parametrize("language", ["en", "vi", "ru", "zh"])
def test_the_document_has_the_figures_of_the_group(folder: Path, language: str) -> None:
    """Each figure is made, so every word and every member that the sections name exists."""
    blocks = report(folder, language).case.document().blocks
    keys = {block.key for block in blocks if isinstance(block, Figure | Plate)}
    wanted = {"fig.assemblies.2345.3", "fig.special.2345.3", "fig.v.3", "fig.a.3", "fig.bodies.2345.3", "fig.R.2345.3"}
    assert wanted <= keys


@pytest.mark.parametrize("what", ["v", "a"])
def test_the_plans_measure_as_the_motion(folder: Path, what: str) -> None:
    """An arrow from the pole, measured and multiplied by the scale, is the velocity or acceleration of its point."""
    context = report(folder)
    motion, ledger = context.analysis.motion, context.ledger
    drawn = {vector.name: vector for vector in motion_plan(context, what, 3).vectors}
    scale = float(ledger[f"mu.{what}"].values[0]) / MM
    for name in "DEF":
        true = complex(getattr(motion.points[name], what)[2])
        # The scale is printed with its digits, the drawing has 1e-6 mm.
        assert abs((drawn[name].end - drawn[name].start) * scale - true) < 1e-3 * abs(true)


def test_the_force_plan_closes(folder: Path) -> None:
    """The forces laid head to tail come back to e, and each reaction measures as the forces from the arrays."""
    context = report(folder)
    (group,) = context.triads
    assert group.polygon is not None
    plan = force_plan(context, group.polygon, 3)
    arrows = {vector.name: vector.end - vector.start for vector in plan.vectors}
    around = [arrows[edge.start + edge.end] for edge in group.polygon.edges]
    assert abs(np.sum(around)) < 1e-6
    scale = float(context.ledger["mu.R2345"].at(3)) / MM
    for edge in group.polygon.reads:
        true = complex(context.analysis.forces.reactions[edge.name].force[2])
        assert abs(arrows[edge.start + edge.end] * scale - true) < 2e-3 * abs(true)


def test_links_are_separated_with_their_arms(folder: Path) -> None:
    """One drawing of the group with arms about the special point, and one of each leg."""
    context = report(folder)
    (group,) = context.triads
    assert len(separated(context, 3, group)) == 4


def test_the_template_curve_is_drawn_on_its_arcs(folder: Path) -> None:
    """At each trial the first two joints keep their rods and the plate its sides; the curve crosses the third arc."""
    context = report(folder)
    (group,) = context.triads
    outer = [context.place(leg.P, 3) for leg in group.legs]
    inner = [context.place(leg.Q, 3) for leg in group.legs]
    trials = placed(outer, inner, TRIALS)
    for centre, joint, places in zip(outer[:2], inner[:2], trials[:2], strict=True):
        assert np.abs(np.abs(places - centre) - abs(joint - centre)).max() < 1e-12
    assert np.abs(np.abs(trials[2] - trials[0]) - abs(inner[2] - inner[0])).max() < 1e-12
    misses = np.abs(trials[2] - outer[2]) - abs(inner[2] - outer[2])
    assert misses.min() < 0 < misses.max()


@pytest.mark.parametrize("language", ["en", "vi", "ru", "zh"])
def test_the_table_of_the_iteration_adds_up(folder: Path, language: str) -> None:
    """Each printed angle and its printed correction make the angle of the next column; the last gaps are zero."""
    blocks = report(folder, language, "full").case.document().blocks
    (table,) = (block for block in blocks if isinstance(block, Table) and block.key == "tab.iteration.2345.3")
    rows = [[_number(cell) for cell in row[2:]] for row in table.rows]
    assert [len(row) for row in rows] == [len(rows[0])] * 16
    for angle, correction in zip(rows[:2], rows[-2:], strict=True):
        for before, step, after in zip(angle, correction, angle[1:], strict=False):
            assert before is not None
            assert step is not None
            assert after == pytest.approx(before + step, abs=1e-9)
    assert [rows[n][-2] for n in (5, 11, 14, 15)] == [0.0] * 4


TOGGLE = """\
kind: linkage
positions: {at: [173 deg]}
parameters:
  frame: {O: [-112.773 mm, 34.845 mm], B: [300.226 mm, -27.643 mm], C: [67.642 mm, 300.541 mm]}
  driver: {type: crank, centre: O, pin: A, length: 2 mm, omega1: 20 rad/s}
  groups:
    - type: 3RRR
      plate: 3
      legs:
        - {link: 2, joints: [A, D], length: 130 mm}
        - {link: 4, joints: [B, E], length: 190 mm}
        - {link: 5, joints: [C, F], length: 150 mm}
      at: {E: [100 mm, 0 mm], F: [60 mm, 140 mm]}
      near: {D: [19 mm, 42 mm], F: [117 mm, 159 mm]}
"""
"""An eccentric moves the legs of R1 beside a dead point, at a transmission angle of 0.11°."""


@pytest.mark.parametrize(
    ("language", "words"), [("en", "dead point"), ("vi", "vị trí chết"), ("ru", "мёртвому положению"), ("zh", "死点")]
)
def test_beside_a_dead_point_the_iteration_begins_with_finer_angles(tmp_path: Path, language: str, words: str) -> None:
    """The report says why its first angles are not whole degrees, and the last gaps are zero as elsewhere."""
    file = tmp_path / "toggle.yaml"
    file.write_text(TOGGLE, encoding="utf-8")
    blocks = open_case(file, language=language).document().blocks
    (place,) = (k for k, block in enumerate(blocks) if isinstance(block, Table) and "iteration" in block.key)
    table = blocks[place]
    assert isinstance(table, Table)
    rows = [[_number(cell) for cell in row[2:]] for row in table.rows]
    assert rows[0][0] == pytest.approx(-6.5)
    assert rows[1][0] == pytest.approx(-6.8)
    assert [rows[n][-2] for n in (5, 11, 14, 15)] == [0.0] * 4
    text = " ".join(str(block) for block in blocks[place - 2 : place])
    assert words in text


def test_plans_beside_a_dead_point_fit_a_sheet(tmp_path: Path) -> None:
    """With the acceleration of the crank pin as long as the crank, that of F would be a plan of 48 m."""
    file = tmp_path / "dead.yaml"
    lower = R1.replace("{count: 8}", "{at: [162.4 deg, 30 deg, 100 deg]}").replace("length: 50 mm", "length: 120 mm")
    file.write_text(lower.replace("[83 mm, 160 mm]", "[184 mm, 142 mm]"), encoding="utf-8")
    context = ReportContext(open_case(file, language="en"))
    assert abs(context.analysis.motion.points["F"].a[0]) > 900 * 20**2 * 0.12
    points = [family.values for id, family in context.ledger.families.items() if id.startswith("plan.a.")]
    drawn = np.array([np.broadcast_to(place, (3,)) for place in points]) * MM
    assert np.nanmax(np.ptp(drawn.real, axis=0)) < 1189
    assert np.nanmax(np.ptp(drawn.imag, axis=0)) < 1189
    vectors = motion_plan(context, "a", 1).vectors
    scale = float(context.ledger["mu.a"].values[0]) / MM
    (of_f,) = (vector for vector in vectors if vector.name == "F")
    assert abs(of_f.end - of_f.start) * scale == pytest.approx(abs(context.analysis.motion.points["F"].a[0]), rel=1e-3)
    assert (context.driver.large_velocity, context.driver.large_acceleration) == (False, True)


def _number(cell: Cell) -> float | None:
    """The number of a cell; None for an empty one."""
    (content,) = cell.inlines
    return content.number.printed if isinstance(content, Value) else None
