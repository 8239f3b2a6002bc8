"""Points of links where nothing is joined: coupler points, ends of levers."""

from __future__ import annotations

import pytest

from reportgen.drawing import Circle, Label, Line, Polyline, Scene
from reportgen.drawing.position_plan import PositionPlan, position_plan
from reportgen.drawing.scheme import Looks, groups, scheme
from reportgen.drawing.style import HEAVY, POINT, body
from reportgen.formula.vocabulary import point
from reportgen.machine import Crank, Dyad, Linkage, LinkPoint
from tests.drawing.machines import at_positions, dense
from tests.drawing.overlaps import overlaps

PER_METRE = 300.0
COUPLER = 0.15 + 0.11j
LINKAGE = Linkage(
    ground={"A": 0j, "D": 0.4 + 0j},
    driver=Crank("A", "B", 0.12),
    groups=(Dyad("RRR", (2, 3), "B", "C", "D", (0.34, 0.28)),),
    points=(LinkPoint("E", 2, COUPLER), LinkPoint("F", 2, 0.22 + 0j), LinkPoint("K", 3, 0.4 + 0j)),
)


def dots(scene: Scene) -> list[complex]:
    return [item.centre for item in scene.items if isinstance(item, Circle) and item.radius == POINT]


@pytest.mark.parametrize("k", range(8))
def test_each_point_is_drawn_where_the_motion_has_it_and_named(k: int) -> None:
    motion = at_positions(LINKAGE)
    drawn = scheme(LINKAGE, motion, k, PER_METRE, Looks())
    places = [complex(motion.points[name].p[k]) * PER_METRE for name in "EFK"]
    # The sheet's origin is anywhere: distances between the points tell.
    assert [abs(a - b) for a in dots(drawn) for b in dots(drawn)] == pytest.approx(
        [abs(a - b) for a in places for b in places]
    )
    names = [item.content for item in drawn.items if isinstance(item, Label)]
    assert all(names.count(point(name)) == 1 for name in "ABCDEFK")
    assert overlaps(drawn) == []


def test_a_point_off_its_link_makes_it_a_plate_and_one_beyond_its_end_makes_it_longer() -> None:
    _, group = groups(LINKAGE, at_positions(LINKAGE), 1, PER_METRE, Looks())
    plate = next(item for item in group.items if isinstance(item, Polyline) and item.closed and item.fill)
    sides = sorted(abs(plate.points[n] - plate.points[n - 1]) for n in range(len(plate.points)))
    wanted = sorted((0.34, abs(COUPLER), abs(COUPLER - 0.34)))
    assert sides == pytest.approx([PER_METRE * side for side in wanted])
    bars = [abs(item.end - item.start) for item in group.items if isinstance(item, Line)]
    assert PER_METRE * 0.4 in [pytest.approx(bar) for bar in bars]


def test_a_mass_centre_is_not_drawn_twice() -> None:
    motion = at_positions(LINKAGE)
    assert len(dots(scheme(LINKAGE, motion, 1, PER_METRE, Looks(centres=("F",))))) == 2


def test_a_plate_goes_round_all_its_points() -> None:
    """A square with a point inside and one on its side: the square."""
    (plate,) = body([0j, 4 + 0j, 1 + 1j, 2 + 0j, 4 + 4j, 4j])
    assert isinstance(plate, Polyline)
    assert set(plate.points) == {0j, 4 + 0j, 4 + 4j, 4j}


def test_the_position_drawn_heavy_shows_the_points_whose_paths_are_drawn() -> None:
    motion = at_positions(LINKAGE)
    drawn = position_plan(LINKAGE, motion, dense(LINKAGE), PER_METRE, PositionPlan(("B", "C"), ("E", "K"), 2))
    e, k = (complex(motion.points[name].p[2]) for name in "EK")
    first, second = dots(drawn)
    assert abs(first - second) == pytest.approx(PER_METRE * abs(e - k))
    heavy = [item for item in drawn.items if isinstance(item, Polyline) and item.closed and item.stroke == HEAVY]
    assert len(heavy) == 1
    assert min(abs(corner - first) for corner in heavy[0].points) < 1e-9
    assert overlaps(drawn) == []
