"""The stages in which plans are constructed: every panel adds something to look at, for all assignments."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.drawing import Arrow, Line
from reportgen.drawing.style import NEW
from reportgen.drawing.vector_plan import Plan, merged, stages
from reportgen.report.context import ReportContext
from reportgen.report.link_views import GroupView
from reportgen.report.plan_figures import force_stages, motion_plan
from tests.lanes import matrix
from tests.report import built

VISIBLE = 1e-6
"""What is shorter (mm) is a point on any paper."""
SAME = 0.05
"""Ends nearer than this (mm) are one for the eye."""


def additions(drawing: Plan, stage: int) -> list[tuple[complex, complex]]:
    """Arrows and lines of a stage that no arrow of an earlier stage covers."""
    pieces = [(v.start, v.end) for v in drawing.vectors if v.stage == stage]
    before = [(v.start, v.end) for v in drawing.vectors if v.stage < stage]
    new = [
        (start, end)
        for start, end in pieces
        if all(abs(start - one) + abs(end - other) >= SAME for one, other in before)
    ]
    lines = [(k.start, k.end) for k in drawing.lines if k.stage == stage]
    return [(start, end) for start, end in (*new, *lines) if abs(end - start) > VISIBLE]


@pytest.mark.parametrize("file", matrix(built.ALL, built.TYPESET), ids=lambda file: file.stem)
def test_force_plans_begin_with_what_is_known_without_moments(file: Path) -> None:
    report = ReportContext(built.case(file, built.own_language(file)))
    k = report.assignment.worked_positions[0]

    def is_drawn(group: GroupView, name: str) -> bool:
        return report.ledger.number(f"seg.{group.name}.{name}", k).value > SAME

    for group in report.groups:
        if group.polygon is None:
            continue
        known = [s for s in group.polygon.edges if not s.unknown and is_drawn(group, s.name)]
        by_moments = {s.start + s.end for s in known if s.name.endswith((".t", ".n"))}
        given = {s.start + s.end for s in known} - by_moments
        panels = force_stages(report, k, group).scenes
        arrows = [[item for item in panel.items if isinstance(item, Arrow)] for panel in panels]
        assert given <= {arrow.name for arrow in arrows[0]}
        assert not by_moments & {arrow.name for arrow in arrows[0]}
        second = {arrow.name for arrow in arrows[1] if arrow.stroke.colour == NEW.colour}
        assert by_moments <= second
        assert not by_moments or not second & {s.start + s.end for s in group.polygon.edges if s.unknown}


@pytest.mark.parametrize("file", matrix(built.ALL, built.TYPESET), ids=lambda file: file.stem)
def test_every_stage_adds_an_arrow_or_a_line(file: Path) -> None:
    report = ReportContext(built.case(file, built.own_language(file)))
    for k in range(1, report.count + 1):
        for drawing in (motion_plan(report, "v", k), motion_plan(report, "a", k)):
            parts = merged(drawing)
            assert all(additions(parts, stage) for stage in range(parts.last_stage + 1))
            # Nothing is lost or put before what it stands on.
            assert len(parts.vectors) == len(drawing.vectors)
            order = [piece.stage for piece in (*drawing.vectors, *drawing.lines, *drawing.points)]
            after = [piece.stage for piece in (*parts.vectors, *parts.lines, *parts.points)]
            renumbered = [new for _, new in sorted(zip(order, after, strict=True))]
            assert renumbered == sorted(after)
    for panel in stages(motion_plan(report, "v", report.worked[0]), 0.5):
        pens = [item.stroke.colour for item in panel.items if isinstance(item, Arrow | Line)]
        assert NEW.colour in pens
