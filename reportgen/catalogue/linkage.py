"""A user-defined linkage: any mechanism of a driver and groups of class II or III.

The file declares frame points, the driver, the groups in the order of their assembly, points, masses and loads;
`linkage_file` documents each key.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from functools import partial

import numpy as np

from reportgen.assignment.checks import one_of
from reportgen.assignment.common import ROMAN, Assignment, Draft, Positions
from reportgen.base.arrays import Floats
from reportgen.base.errors import Finding
from reportgen.base.records import replace
from reportgen.base.units import nice_up
from reportgen.catalogue import assembly_checks, declared_loads, linkage_checks
from reportgen.catalogue import linkage_file as file
from reportgen.catalogue.driven_machine import KindSections, outline
from reportgen.catalogue.given_data import GivenData
from reportgen.catalogue.linkage_file import Parameters
from reportgen.catalogue.linkage_words import arms, facts
from reportgen.catalogue.parameters import weightless
from reportgen.catalogue.topic_sections import Opening, entered
from reportgen.catalogue.typed_quantities import size_of
from reportgen.catalogue.vector_loops import ClosedLoops
from reportgen.formula import Symbol, ids, turned
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import Linkage
from reportgen.machine.analysis import ClosedFormulas, Machine, lettered
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.load_laws import FULL_TURN, GasLaw, MotionAt, TableLaw, by_stroke
from reportgen.machine.loads import Applied, LoadsByKind, Torque, course, fixed, rails

TURNS = 1
"""In a cycle of two turns, the positions of the second turn count among the further ones."""

LARGEST_CRANK = 0.05
"""A crank is drawn no longer than this (m on paper)."""
BOX = (0.210, 0.260)
"""Largest width and height of a mechanism on a large page (m)."""
STEPS = 72


def _check_weights(draft: Draft) -> Iterator[Finding]:
    """Yield faults for a weight in a horizontal plane, where a body has only a mass."""
    masses = draft.at("parameters", "masses")
    count = len(masses) if isinstance(masses, list) else 0
    yield from weightless([("parameters", "masses", index, "G") for index in range(count)])(draft)


CHECKS = (one_of("parameters.driver", "n", "omega1", form=("type", "crank")), _check_weights, linkage_checks.check)


def position_labels(parameters: Parameters, positions: Positions) -> tuple[str, ...]:
    """Return the labels of the positions of the cycle: their numbers, if all are evenly spaced."""
    _, labels = _places(parameters, positions)
    return labels or tuple(map(str, range(1, positions.count * parameters.turns + 1)))


def _places(given: Parameters, positions: Positions) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Return uneven positions and their labels; empty if every position is an even one."""
    if positions.at:
        return positions.instants(given.turns), ROMAN[1 : len(positions.at) + 1]
    if not given.also_at or not isinstance(given.driver, file.CrankDriver):
        return (), ()
    extra = (positions.sign * (angle.si - positions.start_or()) for angle in dict.fromkeys(given.also_at))
    return lettered(positions.count, given.turns, extra)


# --- the machine ----------------------------------------------------------------------------------


def machine(assignment: Assignment) -> Machine:
    """Return the linkage of an assignment with its loads and the report's outline."""
    given: Parameters = assignment.parameters
    positions, driver, linkage = assignment.positions, given.driver, given.linkage
    places, labels = _places(given, positions)
    crank = isinstance(driver, file.CrankDriver)
    start, turn, span = positions.start_or(), positions.sign, 0.0
    if isinstance(driver, file.SlideDriver):
        start, span = driver.start.si, driver.span
        turn = 1 if driver.end.si > start else -1
        places = tuple(np.linspace(0.0, FULL_TURN, positions.count))
        if positions.at:
            places = tuple((at.si - start) * turn / span * FULL_TURN for at in positions.at)
    built = Machine(
        kind=assignment.kind,
        linkage=linkage,
        start=start,
        turn=turn,
        speed=driver.rate,
        acceleration=driver.rate2,
        instants=bool(positions.at),
        count=len(places) or positions.count,
        turns=given.turns if crank else 1,
        span=span,
        calculation=Calculation(),
        outline=(),
        paths=given.paths,
        places=places,
        labels=labels,
    )
    declared = _loads(given, linkage, _motion_at(built), through=not positions.at, span=span)
    q = _calculation(given, linkage, built, drawn.si if (drawn := assignment.drawing.crank) else None)
    topics = entered(Opening(given, linkage, q.datum, declared, _motion_at(built)))
    loads = LoadsByKind.of((*declared, *topics.loads))
    acting = tuple(load.name for load in declared if load.name not in loads.idle)
    q.set_out("lengths", *(ids.length(arm) for arm in arms(given)))
    q.set_out("loads", *acting)
    fixed_points = {name: q.coordinates(name) for name in linkage.ground}
    outlined = partial(outline, curves=not positions.at, words=KindSections(driver="crank" if crank else "slide"))
    loops = ClosedLoops(linkage, turn, fixed_points, accelerates=float(np.sign(built.acceleration)))
    return replace(
        built,
        calculation=q,
        topics=topics.subjects,
        beside=tuple(load.name for load in topics.loads),
        closed_formulas=ClosedFormulas(loops.write, tuple(loops.compared), loops.equations),
        applied=loads.applied,
        torques=loads.torques,
        idle=loads.idle,
        outline=outlined(bool(linkage.inertias), loads.act, topics.subjects),
        outlined=outlined,
        facts=facts(given, tuple(load.name for load in declared), acting),
    )


def _motion_at(machine: Machine) -> MotionAt:
    def motion_at(angle: Floats) -> Motion:
        return solve_motion(machine.linkage, machine.angles(angle), machine.turn * machine.speed)

    return motion_at


def _calculation(given: Parameters, linkage: Linkage, built: Machine, drawn: float | None) -> GivenData:
    """Return the fixed points, lengths, speed, drawn length, masses and moments of inertia."""
    q, driver = GivenData(), given.driver
    for name, place in linkage.ground.items():
        x, y = (
            q.give(ids.frame_coordinate(axis, name), value, Symbol(axis, name), "length")
            for axis, value in (("x", place.real), ("y", place.imag))
        )
        q.construct(ids.place(name), x + turned(y))
    if isinstance(driver, file.CrankDriver):
        q.datum(ids.length(driver.centre, driver.pin), driver.length)
        q.speed(driver.n, driver.omega1, driver.epsilon1, given)
        paper = _drawn(built, driver.length.si) if drawn is None else drawn
        q.give(ids.drawn(driver.centre, driver.pin), paper, drawn_length(driver.centre, driver.pin))
    else:
        q.datum(ids.velocity(driver.pin), driver.speed)
        if driver.acceleration is not None and driver.rate2:
            q.datum(ids.acceleration(driver.pin), size_of(driver.acceleration))
        q.give("span", built.span, Symbol("H", "1"), "length")
    for group in given.groups:
        if isinstance(group, file.RRR):
            first, middle, last = group.joints
            for outer, length in zip((first, last), group.lengths, strict=True):
                q.datum(ids.length(outer, middle), length)
        elif isinstance(group, file.RRP):
            q.datum(ids.length(*group.joints), group.length)
        elif isinstance(group, file.TernaryGroup):
            for leg in group.legs:
                q.datum(ids.length(*leg.joints), leg.length)
    if given.gravity and any(body.G or body.m for body in given.masses):
        q.datum("g", given.g)
    for body in given.masses:
        q.mass(body.link, body.G, body.m)
        if body.J is not None:
            at = body.at if body.at[0] == "S" else f"{body.at}{body.link}"
            q.datum(ids.inertia(body.link), body.J, Symbol("J", at))
    return q


def _drawn(built: Machine, crank: float) -> float:
    """Return the drawn length of the crank (m): μ_l is the least of the series with which the mechanism fits its box.

    A crank that is drawn at instants need not get round.
    """
    angles = np.union1d(np.linspace(0.0, FULL_TURN, STEPS), built.cycle_angles)
    width, height = assembly_checks.room(built.linkage, built.angles(angles))
    return crank / nice_up(max(width / BOX[0], height / BOX[1], crank / LARGEST_CRANK))


# --- loads ----------------------------------------------------------------------------------------


def _loads(
    given: file.Parameters, linkage: Linkage, motion_at: MotionAt, *, through: bool, span: float
) -> tuple[Applied | Torque, ...]:
    """Return the loads in the order of the file, named P (forces) and M (torques) with their link's number."""
    loads: list[Applied | Torque] = []
    for load in given.loads:
        if isinstance(load, file.OverStroke | file.Gas):
            name = declared_loads.named(ids.applied_force, load.link, loads)
            loads.append(_on_slider(load, given, linkage, motion_at, name))
        else:
            law = declared_loads.law_of(load, motion_at, through=through, span=span)
            loads.append(declared_loads.applied(load, law, loads))
    return tuple(loads)


def _on_slider(
    load: file.OverStroke | file.Gas, given: file.Parameters, linkage: Linkage, motion_at: MotionAt, name: str
) -> Applied:
    dyad, guide = rails(linkage)[load.link]
    if isinstance(load, file.Gas):
        top = 1 if load.intake == "first top" else 2
        stroke = course(linkage, load.link, motion_at, given.turns, top)
        area = float(np.pi * load.D.si**2 / 4)
        return Applied(
            name, load.link, dyad.middle, fixed(stroke.inward), GasLaw(stroke, load.diagram.table, area=area)
        )
    unit = load.unit.si
    table = by_stroke(load.s, *(tuple(value * unit for value in row) for row in (load.inward, load.outward)))
    stroke = course(linkage, load.link, motion_at)
    return Applied(name, load.link, dyad.middle, fixed(cmath.exp(1j * guide.angle)), TableLaw(stroke, table, turns=1))
