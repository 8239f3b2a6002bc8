"""Placement of labels on any crowd of strokes."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen.drawing import Arrow, Circle, Item, Label, Line, Scene
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.labels import label
from reportgen.formula import Symbol
from tests.drawing.overlaps import overlaps

FEW = 8
"""So many names find room wherever they stand, even all at one point."""

points = st.builds(complex, st.floats(0, 120), st.floats(0, 120))


@st.composite
def drafts(draw: st.DrawFn) -> Canvas:
    """A fan of strokes with a label at each end, as crowded as a busy plan."""
    ends = draw(st.lists(points, min_size=2, max_size=14))
    ways = list(pairwise(ends))
    items: list[Item] = [Line(*way) for way in ways[::2]]
    items += [Arrow(*way) for way in ways[1::2]]
    items.append(Circle(60 + 60j, 25))
    return Canvas(tuple(items), tuple(label(p, Symbol("A", str(n))) for n, p in enumerate(ends)))


@settings(max_examples=60, deadline=None)
@given(drafts())
def test_labels_keep_clear_of_strokes_each_other_and_the_edge(draft: Canvas) -> None:
    scene = finish(draft)
    # A dozen names of one point find no room in a corner: the scene says so, and its figure takes a finer scale.
    assert scene.crowded or overlaps(scene) == []
    assert len(draft.requests) > FEW or not overlaps(scene)
    assert sum(isinstance(item, Label) for item in scene.items) == len(draft.requests)


@settings(max_examples=10, deadline=None)
@given(drafts())
def test_placing_is_deterministic(draft: Canvas) -> None:
    assert finish(draft) == finish(draft)


def test_the_checker_sees_every_kind_of_fault() -> None:
    names = Label(10 + 10j, "AAA"), Label(11 + 10j, "BBB"), Label(39.5 + 5j, "CCC")
    faults = overlaps(Scene(40, 20, (Line(0j, 20 + 20j), *names)))
    assert any("stands on the stroke" in fault for fault in faults)
    assert any("stands on AAA" in fault for fault in faults)
    assert any("off the sheet" in fault for fault in faults)


def test_a_label_with_no_room_near_moves_out_on_a_leader() -> None:
    wall = tuple(Line(complex(0, y), complex(12, y)) for y in range(13))
    scene = finish(Canvas(wall, (label(6 + 6j, Symbol("A", "1")),)))
    assert overlaps(scene) == []
    assert sum(isinstance(item, Line) for item in scene.items) == len(wall) + 1


def test_parts_of_a_row_stand_on_one_baseline_side_by_side() -> None:
    scene = finish(Canvas((), (label(0j, Symbol("p"), " ≡ ", Symbol("b")),)))
    row = [item for item in scene.items if isinstance(item, Label)]
    assert [item.content for item in row] == [Symbol("p"), " ≡ ", Symbol("b")]
    assert row[0].at.real < row[1].at.real < row[2].at.real
