"""Schemes, groups and position plans of linkages of every kind."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from reportgen.base.arrays import Complexes
from reportgen.drawing import Arc, Circle, Hatch, Label, Line, Polyline
from reportgen.drawing.canvas import finish
from reportgen.drawing.indicator import Branch, ChartFrame, Reading, beside, indicator
from reportgen.drawing.position_plan import PositionPlan, position_plan
from reportgen.drawing.scheme import Looks, driver_arrow, groups, scheme, skeleton
from reportgen.formula import Symbol
from reportgen.machine import Linkage
from tests.drawing.machines import (
    L,
    R,
    at_positions,
    dense,
    elliptic_drive,
    four_bar,
    sine_drive,
    slotted_lever,
    twin_engine,
)
from tests.drawing.overlaps import overlaps

Machine = Callable[[], Linkage]
MACHINES: dict[Machine, tuple[float, Looks, PositionPlan]] = {
    twin_engine: (
        50 / R,
        Looks(centres=("S2", "S4"), blocks={3: (20, 30), 5: (20, 30)}),
        PositionPlan(("A", "C", "B", "D"), ("S2", "S4"), 3),
    ),
    four_bar: (400, Looks(centres=("S2",)), PositionPlan(("A", "B", "F"), ("E", "S2"), 2)),
    slotted_lever: (300, Looks(centres=("S3",)), PositionPlan(("A", "D", "E"), ("S3",), 1)),
    sine_drive: (400, Looks(), PositionPlan(("A", "Q"), (), 1)),
    elliptic_drive: (400, Looks(), PositionPlan(("A", "B", "P"), (), 5)),
}
every_machine = pytest.mark.parametrize("machine", MACHINES, ids=lambda machine: machine.__name__)


@every_machine
def test_schemes_and_groups_are_clear_at_every_position(machine: Machine) -> None:
    linkage = machine()
    motion = at_positions(linkage)
    _, looks, _ = MACHINES[machine]
    for k in range(8):
        for scene in (scheme(linkage, motion, k, 300, looks), *groups(linkage, motion, k, 300, looks)):
            assert overlaps(scene) == [], f"position {k + 1}"


@every_machine
def test_a_scheme_shows_every_link_and_joint_once(machine: Machine) -> None:
    linkage = machine()
    scene = scheme(linkage, at_positions(linkage), 1, 300, Looks())
    numbers = sorted(
        item.content
        for item in scene.items
        if isinstance(item, Label) and isinstance(item.content, str) and item.content.isdigit()
    )
    assert numbers == [str(link) for link in linkage.links]
    assert any(isinstance(item, Hatch) for item in scene.items)


@every_machine
def test_position_plans_are_clear_and_true_to_scale(machine: Machine) -> None:
    linkage = machine()
    motion = at_positions(linkage)
    scale, looks, shows = MACHINES[machine]
    scene = position_plan(linkage, motion, dense(linkage), scale, shows, looks.notes)
    assert overlaps(scene) == []
    lines = [abs(item.end - item.start) for item in scene.items if isinstance(item, Line)]
    drawn = abs(motion.points["A"].p[0] - motion.points["O1"].p[0]) * scale
    if machine is twin_engine:
        drawn *= 2  # the crank goes on to the opposite pin
    assert sum(abs(length - drawn) < 1e-9 for length in lines) >= 8


def test_coinciding_positions_share_one_label() -> None:
    linkage = twin_engine()
    scale, looks, shows = MACHINES[twin_engine]
    scene = position_plan(linkage, at_positions(linkage), dense(linkage), scale, shows, looks.notes)
    contents = [item.content for item in scene.items if isinstance(item, Label)]
    place = contents.index(Symbol("B", "1"))
    assert contents[place : place + 3] == [Symbol("B", "1"), ", ", Symbol("D", "5")]
    # 16 numbered pins in 8 places, 16 sliders in 5.
    assert sum(isinstance(item, Circle) and item.radius < 0.6 for item in scene.items) == 13


@every_machine
def test_the_skeleton_keeps_the_lengths_of_links(machine: Machine) -> None:
    linkage = machine()
    motion = at_positions(linkage)
    first = skeleton(linkage, motion, 0, 1000)
    for k in range(1, 8):
        bones = skeleton(linkage, motion, k, 1000)
        for joints in bones.bars.values():
            for a, b in pairwise(joints):
                here, there = bones.points[b] - bones.points[a], first.points[b] - first.points[a]
                assert abs(here) == pytest.approx(abs(there), abs=1e-6)
        for slide in bones.slides:
            # A block lies on its guide, between the ends of its way.
            along = (slide.at - slide.low) / cmath.exp(1j * slide.angle)
            assert along.imag == pytest.approx(0, abs=1e-6)
            assert -1e-6 <= along.real <= abs(slide.high - slide.low) + 1e-6


def rod_heights() -> Complexes:
    return at_positions(twin_engine()).points["B"].p.astype(np.complex128)


@pytest.mark.parametrize("side", [1 + 0j, -1 + 0j])
def test_the_indicator_diagram_stands_in_line_with_the_piston(side: complex) -> None:
    scale = 50 / R
    top, bottom = 1j * (L + R) * scale, 1j * (L - R) * scale
    axis_top, axis_bottom, mu = beside(top, bottom, side, 30.0, 40.0)
    frame = ChartFrame(axis_top, axis_bottom, side, mu, Symbol("p"))
    x = tuple(np.linspace(0, 1, 11))
    rows = {"a": [-2.5] * 11, "b": [28 * (1 - s) ** 2 - 2.5 for s in x], "c": [40 * (1 - s) + 3.6 for s in x]}
    branches = [Branch(name, x, tuple(row)) for name, row in rows.items()]
    pins = rod_heights()
    readings = [
        Reading(str(k + 1), float((L + R - pin.imag) / (2 * R)), -2.5, complex(pin) * scale)
        for k, pin in enumerate(pins)
    ]
    linkage = twin_engine()
    draft = indicator(frame, branches, readings)
    for reading in readings:
        place = frame.at(reading.fraction, reading.pressure)
        assert reading.from_point is not None
        assert place.imag == pytest.approx(reading.from_point.imag, abs=1e-9)
        assert (place - axis_top).real * side.real == pytest.approx(-2.5 / mu)
    curves = [item for item in draft.items if isinstance(item, Polyline)]
    assert len(curves) == len(branches)
    _, looks, shows = MACHINES[twin_engine]
    scene = position_plan(linkage, at_positions(linkage), dense(linkage), scale, shows, looks.notes, beside=draft)
    assert overlaps(scene) == []


@pytest.mark.parametrize("degrees", range(0, 360, 15))
def test_the_indicator_diagram_is_clear_on_both_sides_of_a_cylinder_in_any_direction(degrees: int) -> None:
    up = cmath.exp(1j * math.radians(degrees))
    top, bottom = 150 * up, 80 * up
    for side in (1j * up, -1j * up):
        start, end, mu = beside(top, bottom, side, 75.0, 640.0)
        assert abs(end - start) == pytest.approx(70)
        branches = (Branch("Expansion", (0, 0.1, 0.4, 1), (640, 400, 120, 30)), Branch("Exhaust", (0, 1), (2, 30)))
        readings = [Reading(Symbol(str(n), "(3)"), n / 8, 640 * (1 - n / 8) ** 2) for n in range(9)]
        frame = ChartFrame(start, end, side, mu, "p, N/cm²")
        assert overlaps(finish(indicator(frame, branches, readings))) == []


def test_the_arrow_of_the_crank_keeps_clear_of_the_lever_behind_it() -> None:
    """At every position of a slotted lever; an arrow over the lever is taken for one of its marks."""
    linkage = slotted_lever()
    motion = at_positions(linkage, count=24)
    for k in range(24):
        bones = skeleton(linkage, motion, k, 300)
        (arc,) = driver_arrow(linkage, motion, bones).items
        assert isinstance(arc, Arc)
        low, high = bones.points["O3"], bones.points["D"]
        turns = np.linspace(arc.start, arc.stop, 19)
        across = ((arc.centre + arc.radius * np.exp(1j * turns) - low) / (high - low)).imag * abs(high - low)
        assert len(set(np.sign(across))) == 1
        assert np.abs(across).min() > 0.9
