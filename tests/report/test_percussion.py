"""The one force of a link's inertia: the text names K and Q where the figure has them, and Q only where lines meet."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from reportgen import api, cases
from reportgen.document import Figure, InlineMath, Paragraph, text_of
from reportgen.drawing import Label, Scene
from reportgen.formula import Expression, Symbol, walk
from reportgen.report.context import ReportContext
from reportgen.report.percussion import percussion
from tests.lanes import matrix
from tests.report import built

ENGINE = """
kind: engine-single
report: {worked_positions: [1, 2, 3]}
positions: {count: 8, direction: anticlockwise}
parameters: {H: 260 mm, D: 190 mm, e: 45 mm, K: 1.05, n: 680 rpm, s: 0.35, G1: 160 N, G2: 95 N, G3: 140 N, rho: 0.19}
indicator:
  by: ordinates
  scale: 2.5 N/cm2
  angle: [0 deg, 340 deg, 360 deg, 380 deg, 450 deg, 720 deg]
  height: [0, 52, 118, 118, 28, 0]
"""
"""At position 3 the acceleration of the piston is zero: the rod's accelerations turn about C."""


@pytest.fixture(scope="module")
def engine(tmp_path_factory: pytest.TempPathFactory) -> ReportContext:
    file = tmp_path_factory.mktemp("engine") / "engine.yaml"
    file.write_text(ENGINE.lstrip(), encoding="utf-8")
    return ReportContext(cases.opened(api.load(file, "en")))


def test_where_the_piston_has_no_acceleration_no_two_lines_meet(engine: ReportContext) -> None:
    """Where a_C = 0, a_B and a_SB lie along a_BC; the force passes through the centre of percussion seen from C."""
    (body,) = engine.couples
    motion, B, C, S = engine.analysis.motion, *(engine.analysis.motion.points[name] for name in ("B", "C", "S2"))
    assert abs(C.a[2]) < 1e-9 * np.abs(B.a[2])
    how = percussion(engine, body, 3)
    assert how.state == "parallel"
    inertia = engine.machine.linkage.inertias[1]
    # About C, whose acceleration is zero, the rod is a pendulum: its force passes through K of C, beyond S.
    beyond = S.p[2] + (S.p[2] - C.p[2]) / abs(S.p[2] - C.p[2]) * inertia.moment / inertia.mass / abs(S.p[2] - C.p[2])
    across = (how.at - beyond) * np.conj(S.a[2])
    assert across.imag == pytest.approx(0.0, abs=1e-9 * abs(S.a[2]))
    assert abs(motion.links[2].epsilon[2]) > 0


def test_its_text_says_that_they_are_parallel(engine: ReportContext) -> None:
    text = text_of(engine.case.document())
    third = text[text.index("Inertia forces at position a") :]
    third = third[: third.index("Inertia forces at all positions")]
    assert "are parallel" in third
    assert "Q_2" not in third


@pytest.mark.parametrize(
    "path",
    matrix(built.TYPESET, [built.SAMPLE, built.ROOT / "assignments" / "four-bar-01.yaml"]),
    ids=lambda path: path.stem,
)
def test_points_of_the_text_are_in_the_figures(path: Path) -> None:
    document = built.written(path, built.own_language(path)).document
    blocks = list(built.walk(document.blocks))
    named = {
        symbol
        for one in blocks
        if isinstance(one, Paragraph)
        for symbol in points(part.expression for part in one.inlines if isinstance(part, InlineMath))
    }
    drawn = {symbol for one in blocks if isinstance(one, Figure) for scene in one.scenes for symbol in labels(scene)}
    assert named <= drawn


def labels(scene: Scene) -> set[Symbol]:
    shown = (item.content for item in scene.items if isinstance(item, Label))
    return points(part for content in shown for part in (content if isinstance(content, tuple) else (content,)))


def points(shown: Iterable[object]) -> set[Symbol]:
    """The symbols K₂, Q₂, … among expressions."""
    nodes = (node for one in shown if isinstance(one, Expression) for node in walk(one))
    return {node for node in nodes if isinstance(node, Symbol) and node.base in ("K", "Q") and node.sub.isdigit()}
