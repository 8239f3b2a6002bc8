"""Plans: lengths exact on paper, stages, insets, labels, at every position."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reportgen.drawing import Arrow, Circle, Label, Line, Scene
from reportgen.drawing.vector_plan import TARGET, TINY, Plan, PlanPoint, PlanVector, enlargement, plan, stages
from reportgen.formula import Symbol
from reportgen.machine.kinematics import Motion
from tests.drawing.machines import acceleration_plan, at_positions, twin_engine, velocity_plan
from tests.drawing.overlaps import overlaps

POSITIONS = range(16)
"""Two turns: kinematics repeats, the gas forces do not."""


@cache
def motion() -> Motion:
    return at_positions(twin_engine(), count=16, turns=2)


def arrows(scene: Scene) -> dict[str, complex]:
    return {item.name: item.end - item.start for item in scene.items if isinstance(item, Arrow)}


@pytest.mark.parametrize("k", POSITIONS)
@pytest.mark.parametrize("make", [velocity_plan, acceleration_plan])
def test_nothing_overlaps_at_any_position(make: object, k: int) -> None:
    assert callable(make)
    drawing = make(motion(), k)
    assert overlaps(plan(drawing)) == []
    for panel in stages(drawing, 0.45):
        assert overlaps(panel) == []


@pytest.mark.parametrize("k", POSITIONS)
def test_vectors_are_true_to_scale(k: int) -> None:
    drawing = velocity_plan(motion(), k)
    drawn = arrows(plan(drawing))
    for vector in drawing.drawn():
        # Moving the figure onto its sheet costs the last binary digits only.
        assert drawn[vector.name] == pytest.approx(vector.end - vector.start, abs=1e-9)


def test_segments_of_the_reference_engine() -> None:
    # Printed at position 4, drawn by hand: 0.5 %.
    lengths = {name: abs(way) for name, way in arrows(plan(velocity_plan(motion(), 3))).items()}
    for name, printed in {"pa": 50, "pb": 28.20, "ab": 35.91, "ps2": 40.11, "pd": 42.41, "ps4": 44.26}.items():
        assert lengths[name] == pytest.approx(printed, rel=5e-3)
    lengths = {name: abs(way) for name, way in arrows(plan(acceleration_plan(motion(), 3))).items()}
    for name, printed in {"πb′": 35.10, "πd′": 35.62, "πs2′": 42.08, "πs4′": 42.23, "n": 7.20}.items():
        assert lengths[name] == pytest.approx(printed, rel=5e-3)


def test_nothing_is_drawn_of_a_vector_that_is_nothing() -> None:
    drawn = arrows(plan(velocity_plan(motion(), 0)))
    assert "pb" not in drawn
    assert "pd" not in drawn
    assert "pa" in drawn


def test_coinciding_points_share_a_label() -> None:
    contents = [item.content for item in plan(velocity_plan(motion(), 0)).items if isinstance(item, Label)]
    assert contents.count(" ≡ ") == 2  # p ≡ b ≡ d: both pistons stand at a dead centre


@pytest.mark.parametrize("length", [0.012, 0.099, 0.1, 0.5, 2.99, 3.0, 8.0])
def test_short_vectors_get_an_enlarged_inset(length: float) -> None:
    vectors = (PlanVector("long", 0j, 40 + 0j), PlanVector("short", 40 + 0j, 40 + length * 1j))
    points = (PlanPoint(Symbol("e"), 0j), PlanPoint(Symbol("f"), 40 + 0j), PlanPoint(Symbol("g"), 40 + length * 1j))
    scene = plan(Plan(vectors, points))
    drawn = arrows(scene)
    assert drawn["short"] == pytest.approx(length * 1j, abs=1e-9)
    ratios = [item.content for item in scene.items if isinstance(item, Label) and str(item.content).endswith(":1")]
    assert len(ratios) == (1 if 0.1 <= length < TINY else 0)
    if ratios:
        ratio = float(str(ratios[0]).removesuffix(":1"))
        enlarged = next(way for name, way in drawn.items() if name.startswith("short ×"))
        assert enlarged == pytest.approx(ratio * length * 1j)
        assert 8 <= abs(enlarged) <= 20  # readable with a ruler
    assert overlaps(scene) == []


@pytest.mark.parametrize("lengths", [(2.5, 2.0), (2.9, 0.3), (2.0, 0.2)])
def test_every_short_vector_is_readable_in_some_inset(lengths: tuple[float, ...]) -> None:
    way = np.cumsum([0, *lengths])
    vectors = [PlanVector(f"v{n}", complex(way[n]), complex(way[n + 1])) for n in range(len(lengths))]
    scene = plan(Plan((*vectors, PlanVector("long", complex(way[-1]), 40 + 30j))))
    enlarged = {name: abs(size) for name, size in arrows(scene).items() if "×" in name}
    assert len(enlarged) == len(lengths)
    assert all(size >= TINY for size in enlarged.values())


@pytest.mark.parametrize("length", [1e-8, 0.004, 0.0099])
def test_what_a_measured_length_cannot_tell_from_nothing_is_not_drawn(length: float) -> None:
    scene = plan(Plan((PlanVector("long", 0j, 40 + 0j), PlanVector("dust", 40 + 0j, 40 + length * 1j))))
    assert list(arrows(scene)) == ["long"]


def test_stages_add_up_to_the_plan() -> None:
    drawing = velocity_plan(motion(), 3)
    panels = stages(drawing, 0.5)
    assert len(panels) == drawing.last_stage + 1
    assert len({(panel.width, panel.height) for panel in panels}) == 1
    counts = [len(arrows(panel)) for panel in panels]
    assert counts == sorted(counts)
    assert counts[-1] == len(drawing.drawn())
    assert abs(arrows(panels[-1])["pa"]) == pytest.approx(25)
    assert [panel.title for panel in panels[:3]] == ["a)", "b)", "c)"]


def test_the_scale_is_printed_and_the_pole_marked() -> None:
    drawing = velocity_plan(motion(), 3)
    scene = plan(drawing)
    assert any(isinstance(item, Label) and item.content == drawing.scale for item in scene.items)
    assert any(isinstance(item, Circle) for item in scene.items)
    assert sum(isinstance(item, Line) for item in scene.items) >= len(drawing.lines)


def test_the_same_plan_gives_the_same_scene() -> None:
    assert plan(velocity_plan(motion(), 5)) == plan(velocity_plan(motion(), 5))


def test_short_vectors_far_apart_at_their_ratio_get_insets_of_their_own() -> None:
    """Some 0.1 mm long, 2.5 mm from each other: enlarged a hundred times they would stand 250 mm apart."""
    short = PlanVector("ab", 0j, 0.12 + 0j), PlanVector("cd", 2.5j, 2.5j + 0.11)
    scene = plan(Plan((*short, PlanVector("ef", 0j, 30 + 0j)), pole=False))
    assert {name.split(" ")[0] for name in arrows(scene) if "×" in name} == {"ab", "cd"}
    assert scene.height < 150


def test_short_vectors_close_together_share_an_inset() -> None:
    short = PlanVector("ab", 0j, 1 + 0j), PlanVector("bc", 1 + 0j, 1 + 1j)
    scene = plan(Plan((*short, PlanVector("ef", 0j, 30j)), pole=False))
    ratios = [item.content for item in scene.items if isinstance(item, Label) and ":1" in str(item.content)]
    assert len(ratios) == 1


@given(st.floats(1e-6, 3.0))
def test_insets_are_never_longer_than_asked(length: float) -> None:
    assert TARGET / 2 * (1 - 1e-9) <= length * enlargement(length) <= TARGET * (1 + 1e-9)
