"""A linkage of the user's own: whatever a driver and groups of class II can make.

The file declares frame points, the driver, the groups in the order of their assembly, points, masses and
loads; `linkage_file` says what each key means.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.faults import Finding
from reportgen.catalogue import linkage_checks, linkage_file, linkage_loads, linkage_told, regulation
from reportgen.catalogue.course import FULL_TURN, Floats
from reportgen.catalogue.driven import outline
from reportgen.catalogue.laws import MotionAt
from reportgen.catalogue.linkage_build import linkage
from reportgen.catalogue.linkage_file import Parameters
from reportgen.catalogue.machine import Applied, Item, Machine, Torque, lettered, mass_items, speed_items
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.structure import Linkage
from reportgen.notation.expressions import Symbol
from reportgen.notation.numbers import nice_up

KIND = "linkage"
TITLES = {"vi": "Cơ cấu phẳng nhiều khâu", "en": "Plane linkage"}
TURNS = 1
"""A cycle of two turns counts the second turn's positions among those added to the first."""

LARGEST_CRANK = 0.05
"""A crank is drawn no longer than this (m on paper)."""
BOX = (0.210, 0.260)
"""What a mechanism may take of a large page (m)."""
STEPS = 72


def _check_speed(draft: Draft) -> Iterator[Finding]:
    """A crank has a speed, in one way."""
    parameters = draft.raw.get("parameters")
    driver = parameters.get("driver") if isinstance(parameters, dict) else None
    if not isinstance(driver, dict) or driver.get("type") != "crank":
        return
    given = [key for key in driver if key in {"n", "omega1"} and driver[key] is not None]
    if len(given) > 1:
        both = {"first": given[0], "second": given[1]}
        yield Finding("both-given", ("parameters", "driver", given[1]), both, at="key")
    elif not given:
        yield Finding("missing-key", ("parameters", "driver", "n"), {"key": "n | omega1"})


def _check_flywheel(draft: Draft) -> Iterator[Finding]:
    """A flywheel turns with a crank."""
    given: Parameters | None = draft.sections.get("parameters")
    if given is not None and given.flywheel is not None and isinstance(given.driver, linkage_file.SlideDriver):
        yield Finding("flywheel-of-slide", ("parameters", "flywheel"), at="key")


CHECKS = (_check_speed, regulation.needs_loads(("masses", "loads")), _check_flywheel, linkage_checks.check)


def added_positions(parameters: Parameters, positions: Positions) -> int:
    """Positions of the cycle beside the evenly spaced ones of its first turn."""
    places, _ = _places(parameters, positions)
    each = len(places) or positions.count
    return each * parameters.turns - positions.count


def _start(positions: Positions) -> float:
    """The crank's angle at the first position: along +x unless the file says otherwise."""
    return 0.0 if positions.start is None else positions.start.si


def _places(given: Parameters, positions: Positions) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Uneven positions and their labels; none where every position is an even one."""
    if not given.also_at or not isinstance(given.driver, linkage_file.CrankDriver):
        return (), ()
    extra = (positions.sign * (angle.si - _start(positions)) for angle in dict.fromkeys(given.also_at))
    return lettered(positions.count, given.turns, extra)


# --- the machine ----------------------------------------------------------------------------------


def machine(assignment: Assignment) -> Machine:
    """The linkage of an assignment with its loads and the report's outline."""
    given: Parameters = assignment.parameters
    positions, made = assignment.positions, linkage(assignment.parameters)
    places, labels = _places(given, positions)
    crank = isinstance(given.driver, linkage_file.CrankDriver)
    start, turn, span = _start(positions), positions.sign, 0.0
    if isinstance(given.driver, linkage_file.SlideDriver):
        start, span = given.driver.start.si, given.driver.span
        turn = 1 if given.driver.end.si > start else -1
        places = tuple(np.linspace(0.0, FULL_TURN, positions.count))
    built = Machine(
        kind=KIND,
        linkage=made,
        start=start,
        turn=turn,
        speed=given.driver.rate,
        count=len(places) or positions.count,
        turns=given.turns if crank else 1,
        span=span,
        given=(),
        formulas=(),
        outline=(),
        paths=given.paths,
        places=places,
        labels=labels,
    )
    loads = linkage_loads.laid_on(given, made, _motion_at(built))
    drawn = assignment.drawing.crank
    items = _items(given, made, built, drawn.si if drawn else None)
    return replace(
        built,
        given=items,
        applied=tuple(load for load in loads if isinstance(load, Applied)),
        torques=tuple(load for load in loads if isinstance(load, Torque)),
        outline=outline(bool(made.inertias), bool(loads), given.flywheel, driver="crank" if crank else "slide"),
        unevenness=None if given.flywheel is None else given.flywheel.delta.si,
        facts=linkage_told.facts(given, tuple(load.name for load in loads)),
    )


def _motion_at(machine: Machine) -> MotionAt:
    def motion_at(angle: Floats) -> Motion:
        return solve_motion(machine.linkage, machine.angles(angle), machine.turn * machine.speed)

    return motion_at


def _items(given: Parameters, made: Linkage, built: Machine, drawn: float | None) -> tuple[Item, ...]:
    """Fixed points, lengths, speed, drawn length, masses and moments of inertia, constant loads."""
    items = [
        Item(f"frame.{axis}.{name}", Symbol(axis, name), "length", value)
        for name, place in made.ground.items()
        for axis, value in (("x", place.real), ("y", place.imag))
    ]
    items += _driver_items(given, made, built, drawn)
    for group in given.groups:
        if isinstance(group, linkage_file.RRR):
            first, middle, last = group.joints
            ends = ((first, middle), (last, middle))
            items += [_length(*pair, length.si) for pair, length in zip(ends, group.lengths, strict=True)]
        elif isinstance(group, linkage_file.RRP):
            items.append(_length(group.joints[0], group.joints[1], group.length.si))
    if any(body.mass for body in made.inertias):
        items.append(Item("g", Symbol("g"), "gravity", given.g.si))
    for body in given.masses:
        items += mass_items(body.link, body.G, body.m)
        if body.J is not None:
            symbol = Symbol("J", body.at if body.at[0] == "S" else f"{body.at}{body.link}")
            items.append(Item(f"J.{body.link}", symbol, "moment of inertia", body.J.si))
    return tuple({item.id: item for item in items}.values())


def _length(start: str, end: str, value: float) -> Item:
    return Item(f"l.{start}{end}", Symbol("l", f"{start}{end}"), "length", value)


def _driver_items(given: Parameters, made: Linkage, built: Machine, drawn: float | None) -> list[Item]:
    driver = given.driver
    if isinstance(driver, linkage_file.CrankDriver):
        arm = f"{driver.centre}{driver.pin}"
        paper = _drawn(built, driver.length.si) if drawn is None else drawn
        return [
            _length(driver.centre, driver.pin, driver.length.si),
            *speed_items(driver.n, driver.omega1),
            *regulation.items(given.flywheel),
            Item(f"drawn.{arm}", Symbol(arm, over="segment"), "segment", paper),
        ]
    return [
        Item(f"v.{driver.pin}", Symbol("v", driver.pin), "velocity", driver.speed.si),
        Item("span", Symbol("H", "1"), "length", built.span),
    ]


def _drawn(built: Machine, crank: float) -> float:
    """The drawn length of the crank (m): μ_l is the least of the series with which the mechanism fits its box."""
    motion = _motion_at(built)(np.linspace(0.0, FULL_TURN, STEPS))
    places = np.array([point.p for point in motion.points.values()])
    width, height = np.ptp(places.real), np.ptp(places.imag)
    return crank / nice_up(max(width / BOX[0], height / BOX[1], crank / LARGEST_CRANK))
