"""Contents of the tables of results: motion, forces, and independent checks of the calculation.

Functions return ids of columns or yield rows; `named_tables` makes tables of them.  `residuals` computes the checks.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from reportgen.base.units import MM
from reportgen.derivation.equation_sides import Side, image
from reportgen.derivation.kinematic_entries import What
from reportgen.document import FIRST_COLUMN, TEXT_WIDTH, Column, InlineMath, Inlines, Table, Text
from reportgen.document.tables import list_table, side_by_side
from reportgen.formula import Chain, Number, Power, Symbol, ids
from reportgen.formula.calculation import ZERO
from reportgen.formula.vocabulary import KeyChapter
from reportgen.machine import Crank
from reportgen.report.context import ReportContext
from reportgen.report.guide_couples import guide_couples
from reportgen.report.link_views import GroupView
from reportgen.report.quantity_tables import bare
from reportgen.report.table_remarks import AT_REST
from reportgen.report.topic_views import VIEWS
from reportgen.report.triad_views import TriadView

MOST_COORDINATES, MOST_WIDE = 10, 8
"""Largest number of coordinate columns in one table, and the number if a coordinate is −100 mm or less."""
WIDE = -0.1
"""A coordinate (m) that needs the widest column."""
NARROWEST = 16.0
"""Columns of words narrower than this (mm) are printed as rows instead."""

AGREED = -9
"""Two methods agree to ten to this power of the greatest value; smaller differences are rounding noise."""

# --- motion


def coordinates(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> tuple[Table, ...]:
    """Return x and y of every moving point at the positions of one turn, in mm; several tables if there are many.

    A coordinate that a formula also gives is printed as in the formula's line, any other as read from the plan.
    """
    linkage, motion = report.machine.linkage, report.analysis.motion
    at = [k - 1 for k in report.positions]
    # The point of a lever under a block's pin coincides with the pin.
    under = {dyad.middle for dyad in linkage.dyads if dyad.kind == "RPR"}
    names = [name for name in motion.points if name not in {*linkage.ground, *under}]
    courses = [
        (Symbol(axis, name), part)
        for name in names
        for axis, part in (("x", motion.points[name].p.real), ("y", motion.points[name].p.imag))
    ]
    kept = [(shown, values) for shown, values in courses if np.abs(values).max() > 1e-12]
    wide = any(values.min() <= WIDE for _, values in kept)
    written = [(shown, _as_written(report, shown.sub, values)) for shown, values in kept]
    columns = [(shown, *(values[index] for index in at)) for shown, values in written]
    titles = [report.words["table"]["position"], *map(str, report.positions)]
    first, most = Column(FIRST_COLUMN), MOST_WIDE if wide else MOST_COORDINATES
    return side_by_side(
        report.prose, key, caption, first, titles=titles, columns=columns, most=most, widest=22.0, together=2
    )


def _as_written(report: ReportContext, point: str, course: np.ndarray) -> list[Number]:
    """Return the coordinate (m) [N] of a point at all positions as printed numbers in mm."""
    values, decimals = course, 5
    for id, family in report.case.ledger.families.items():
        alike = (family.kind, family.symbol.sub, family.values.shape) == ("length", point, course.shape)
        if alike and np.allclose(family.values, course, rtol=0, atol=ZERO * np.abs(course).max()):
            values, decimals = report.ledger[id].values, report.ledger.decimals[id] or 5
    return [Number(value * MM, max(decimals - 3, 0)) if abs(value) > 1e-12 else Number(0.0) for value in values]


def _two_decimals(value: float) -> Number:
    """Return a number with two decimals, or unchanged if it has no more than two."""
    short = abs(value * 100 - round(value * 100)) < 1e-7
    return Number(float(f"{value:.10g}")) if short else Number(value, 2)


def dead_centres(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield the dead centres of each slider: the crank angle from position 1, and the pin's distance from the crank
    centre.
    """
    words = report.words["tables"]["dead"]
    for piston in report.machine.sliders:
        for name, angle, place in (
            (words["top"], piston.top_angle, piston.top),
            (words["bottom"], piston.bottom_angle, piston.bottom),
        ):
            turn = math.degrees((angle - piston.phase) % (2 * math.pi))
            turn = 0.0 if abs(turn - 360) < 1e-9 else turn
            yield str(piston.link), name, _two_decimals(turn), _two_decimals(abs(place) * MM)


def labels(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield rows for the positions of one turn: label, crank angle, and the state of the first slider.

    The slider reverses at its "top" and "bottom", and is "fastest" where a = 0.
    """
    words = report.words["tables"]["labels"]
    machine, motion = report.machine, report.analysis.motion
    course = machine.sliders[0]
    pin, fraction = motion.points[course.pin], course.fraction(motion)
    still, steady = (np.abs(rate) < AT_REST * np.abs(rate).max() for rate in (pin.v, pin.a))
    for k in range(machine.count):
        end = ("top" if fraction[k] < 0.5 else "bottom") if still[k] else "fastest" if steady[k] else ""
        angle = _two_decimals(math.degrees(machine.cycle_angles[k]))
        yield str(machine.position(k + 1)), angle, words.get(end, "")


def angular_velocities(report: ReportContext, k: int) -> Iterator[Sequence[object]]:
    """Yield the angular velocities at position `k`: symbol, size, and sense in words."""
    if report.driver.centre:
        yield report.ledger.symbol("omega.1"), bare(report, "omega.1", k, size=True), report.turn_words
    yield from _rotations(report, "omega", k)


def angular_accelerations(report: ReportContext, k: int) -> Iterator[Sequence[object]]:
    """Yield the angular accelerations at position `k`: symbol, size, and sense in words."""
    return _rotations(report, "eps", k)


def _rotations(report: ReportContext, rate: str, k: int) -> Iterator[Sequence[object]]:
    for id in _of_links(report, rate):
        sense = report.sense(report.ledger.number(id, k).value)
        yield report.ledger.symbol(id), bare(report, id, k, size=True), sense


def summary(report: ReportContext, k: int) -> Iterator[Sequence[object]]:
    """Yield rows of "symbol = value" for quantities at one position."""
    ledger = report.ledger
    for row in report.own["summary"]:
        yield [Chain((ledger.symbol(id), ledger.number(id, k))) if id else "" for id in row]


def velocity_segments(report: ReportContext) -> list[str]:
    """Return the ids of the segments measured on the velocity plan."""
    columns: list[str] = []
    for group in report.groups:
        if isinstance(group, TriadView):
            columns += _segments_of_triad("v", group)
            continue
        columns += [
            ids.segment("v", "p", image(group.M)),
            *(ids.segment("v", image(side.base), image(group.M)) for side in group.moving),
        ]
        columns += _images("v", group)
    return report.known(columns)


def velocities(report: ReportContext) -> list[str]:
    """Return the ids of the velocities and angular velocities that the plan gives."""
    columns: list[str] = []
    for group in report.groups:
        if isinstance(group, TriadView):
            columns += _rates_of_triad(report, "v", group)
            continue
        # Relative to a fixed point a velocity is the point's own.
        relative = [side.velocity for side in group.moving if report.parts("relative")]
        columns += [ids.velocity(group.M), *relative, ids.velocity(group.Q)]
        columns += [ids.velocity(place) for place in group.points]
    return [*report.known(columns), *_of_links(report, "omega")]


def acceleration_segments(report: ReportContext) -> list[str]:
    """Return the ids of the segments measured on the acceleration plan."""
    columns: list[str] = []
    for group in report.groups:
        if isinstance(group, TriadView):
            columns += _segments_of_triad("a", group)
            continue
        columns.append(ids.segment("a", "p", image(group.M)))
        columns += [ids.relative_segment(part, side.relative) for side in group.sides for part in _parts(side)]
        columns += _images("a", group)
    return report.known(columns)


def accelerations(report: ReportContext) -> list[str]:
    """Return the ids of the accelerations and angular accelerations that the plan gives."""
    columns: list[str] = []
    for group in report.groups:
        if isinstance(group, TriadView):
            columns += _rates_of_triad(report, "a", group)
            continue
        columns.append(ids.acceleration(group.M))
        if report.parts("relative"):
            columns += [ids.acceleration(side.relative, part) for side in group.sides for part in _parts(side)]
        columns += [ids.acceleration(group.Q), *(ids.acceleration(place) for place in group.points)]
    return [*report.known(columns), *_of_links(report, "eps")]


def _of_links(report: ReportContext, rate: str) -> list[str]:
    """Return the ids of the signed angular quantities of the links that turn."""
    return report.known(ids.signed(rate, link) for link in report.machine.linkage.links)


def _images(what: str, group: GroupView) -> list[str]:
    return [ids.segment(what, "p", image(place)) for place in (group.Q, *(place.name for place in group.points))]


def _segments_of_triad(what: What, group: TriadView) -> list[str]:
    """Return the ids of the segments measured on a plan of a group of class III: S first, then the third joint."""
    legs = (group.third, *group.pair)
    sides = [group.about, *(leg.side for leg in legs)]
    if what == "v":
        relative = [ids.segment("v", image(side.base), image(side.point)) for side in sides if not side.still]
        of_special = [ids.segment("v", image(leg.P), image(group.S)) for leg in group.pair if not leg.side.still]
    else:
        relative = [ids.relative_segment(part, side.relative) for side in sides for part in "nt"]
        of_special = [leg.across.known for leg in group.pair]
    absolute = (group.S, *(leg.Q for leg in legs), *(place.name for place in group.points))
    return [*of_special, *(ids.segment(what, "p", image(name)) for name in absolute), *relative]


def _rates_of_triad(report: ReportContext, what: What, group: TriadView) -> list[str]:
    """Return the ids of the velocities or accelerations that a plan of a group of class III gives."""
    rate, legs = ids.POINT_RATE[what], (group.third, *group.pair)
    sides = [group.about, *(leg.side for leg in legs)]
    parts = [""] if what == "v" else ["n", "t"]
    relative = [rate(side.relative, part) if part else rate(side.relative) for side in sides for part in parts]
    columns = relative if report.parts("relative") else []
    names = [group.S, *(leg.Q for leg in legs), *(place.name for place in group.points)]
    return [*map(rate, names), *columns]


def _parts(side: Side) -> list[str]:
    """Return the suffixes of a side's relative accelerations, that of the known one first."""
    return [part for part in (side.part, side.sought) if part]


# --- forces


def strokes(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> Table:
    """Return the table of every piston's stroke between the dead centres of all pistons, or at each single instant."""
    positions, first = head
    gas, machine = report.analysis.gas, report.machine
    names = report.words["strokes"]
    courses = np.array([state.stroke for state in gas.values()])
    if machine.instants:
        starts = list(range(machine.positions))
        stretches = [str(machine.position(start + 1)) for start in starts]
    else:
        starts = [0, *(int(i) + 1 for i in np.flatnonzero(np.any(np.diff(courses, axis=1), axis=0)))]
        ends = [*starts[1:], machine.positions]
        stretches = [
            f"{machine.position(start + 1)}–{machine.position(end % machine.positions + 1)}"
            for start, end in zip(starts, ends, strict=True)
        ]
    of_pistons = [[names[int(state.stroke[start])] for start in starts] for state in gas.values()]
    pistons = [f"{first} {state.piston.link}" for state in gas.values()]
    width = (TEXT_WIDTH - 30) / len(starts)
    if width < NARROWEST:
        down = zip(stretches, *of_pistons, strict=True)
        widths = (30.0, *(40.0,) * len(pistons))
        return list_table(report.prose, key, caption, (positions, *pistons), down, widths)
    across = [(piston, *row) for piston, row in zip(pistons, of_pistons, strict=True)]
    widths = (30.0, *(min(width, 30.0),) * len(starts))
    return list_table(report.prose, key, caption, (positions, *stretches), across, widths)


def gas(report: ReportContext) -> list[str]:
    """Return the ids of each piston's displacement, of its pressure and of its gas force."""
    return report.known(
        id
        for piston in report.pistons
        for id in (ids.displacement(piston.link), ids.pressure(piston.link), piston.name)
    )


def inertia(report: ReportContext) -> list[str]:
    """Return the ids of the inertia forces and couples."""
    return report.inertia_lines


def reactions(report: ReportContext) -> list[str]:
    """Return the ids of the reactions in all joints, and of the moments of guide couples."""
    columns: list[str] = []
    for group in reversed(report.groups):
        columns += [*group.tangential, *(ids.reaction(joint) for joint in group.reaction_joints)]
    return report.known([*columns, "R.01", *(slide.moment for slide in guide_couples(report))])


def reaction_angles(report: ReportContext) -> list[str]:
    """Return the ids of the directions of all reactions."""
    joints = [name for group in reversed(report.groups) for name in group.reaction_joints]
    return report.known(ids.force_direction(ids.reaction_force(name)) for name in (*joints, "01"))


def lever(report: ReportContext, k: int) -> Iterator[Sequence[object]]:
    """Yield a row for each load on the turned velocity plan: size, arm, and moment about the pole (anticlockwise
    positive).
    """
    for id in report.arms_about("p"):
        load = report.ledger[id].of
        yield report.ledger.symbol(load), *(bare(report, one, k) for one in (load, id, ids.lever_moment(load)))


def balance(report: ReportContext) -> list[str]:
    """Return the ids of the balancing torque by both methods and of their difference."""
    return ["M.eq", "M.vw", "M.difference", "M.share"]


# --- checks


def checks(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield each independent check with the power of ten that bounds its residual."""
    largest = residuals(report)
    for id, name in report.words["tables"]["checks"]["rows"].items():
        if id in largest:
            yield name, _limit(largest[id])


def residuals(report: ReportContext) -> dict[str, float]:
    """Return the largest residual of each check as a share of the greatest value: closure, formulas, reactions,
    torques, …
    """
    analysis, values = report.analysis, report.case.ledger.families
    largest = {"closure": _closure(report)}
    for name, chapter in (("formulas", KeyChapter.velocity), ("formulas_a", KeyChapter.acceleration)):
        differences = [
            float(np.max(np.abs(np.abs(values[printed_id].values) - np.abs(values[formula_id].values))))
            / float(np.max(np.abs(values[printed_id].values)))
            for printed_id, formula_id in analysis.machine.closed_formulas.compared
            if values[printed_id].chapter is chapter
        ]
        if differences:
            largest[name] = max(differences)
    if analysis.loads:
        drawn = {
            name: values[ids.force_vector(name)].values
            for name in analysis.forces.reactions
            if ids.force_vector(name) in values
        }
        forces = [np.abs(analysis.forces.reactions[name].force - force) for name, force in drawn.items()]
        largest["ledger"] = _share(forces, map(np.abs, drawn.values()))
        difference, either = values["M.difference"], "force" if analysis.machine.span else "torque"
        largest[either] = float(np.nanmax(np.abs(analysis.torque - analysis.torque_by_work))) / (
            difference.scale or 1.0
        )
        if analysis.machine.cyclic:
            largest["energy"] = analysis.summary.energy_error
    for hooks in VIEWS.among(analysis.machine.topics):
        largest |= hooks.residuals(report)
    return largest


def _share(differences: Iterable[np.ndarray], values: Iterable[np.ndarray]) -> float:
    """Return the greatest difference as a share of the greatest value; 0 if there are no values."""
    greatest = max((float(np.nanmax(one, initial=0.0)) for one in values), default=0.0)
    off = max((float(np.nanmax(one, initial=0.0)) for one in differences), default=0.0)
    return off / greatest if greatest else 0.0


def _closure(report: ReportContext) -> float:
    """Return the largest error of a distance between two points of a link, as a share of the longest distance."""
    motion, families = report.analysis.motion, report.case.ledger.families
    pairs = [ends for group in report.groups for ends in group.rods]
    rods = [
        (motion.points[p].p - motion.points[q].p, families[ids.length(p, q)].values)
        for p, q in pairs
        if ids.length(p, q) in families
    ]
    rods += [
        (motion.points[point.name].p - motion.origins[point.link].p, np.array([abs(point.local)]))
        for point in report.machine.linkage.points
    ]
    if isinstance(driver := report.machine.linkage.driver, Crank):
        arm = motion.points[driver.pin].p - motion.points[driver.centre].p
        rods.append((arm, np.array([driver.length])))
    return _share((np.abs(np.abs(rod) - length) for rod, length in rods), (length for _, length in rods))


def _limit(share: float) -> Inlines:
    """Return the power of ten that bounds a residual: ≤ 10⁻⁹, which all results keep, or a larger one if needed."""
    exponent = AGREED if share <= 10.0**AGREED else math.ceil(math.log10(share) - 1e-6)
    return Text("≤ "), InlineMath(Power(Number(10), Number(exponent)))
