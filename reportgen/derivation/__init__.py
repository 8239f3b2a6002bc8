"""Build the ledger of an analysis: all entries in the order in which a report derives them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import rounded, significant_decimals
from reportgen.derivation.group_forces import enter_forces
from reportgen.derivation.group_motion import enter_kinematics
from reportgen.derivation.load_entries import Polygon
from reportgen.derivation.plan_scales import no_scales, own_scales
from reportgen.derivation.topic_ledger import LEDGER
from reportgen.formula import PI, Expression, Ref, Symbol, call, circle_line, ids, vocabulary
from reportgen.formula import size as size_of
from reportgen.formula.calculation import ZERO, Calculation, is_short
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import Ledger
from reportgen.formula.vocabulary import KINDS, KeyChapter
from reportgen.machine import Crank, Linkage
from reportgen.machine.analysis import Analysis, Machine, no_formulas, possible
from reportgen.machine.gas_pressure import Bracket
from reportgen.machine.load_laws import Stroke
from reportgen.machine.loads import Applied, Torque

ONE_QUANTITY = (("M.eq", "M.vw", "M.least", "M.greatest", "M.difference"), ("M.mean", "M.energy"))
"""Groups of ids of one quantity, printed with the same decimals: both torques with the extremes of their curve, and the
mean by the curve and by the work.
"""


class PlannedLedger(Record):
    """The ledger of an analysis, and the force plans that are laid out in it.

    There is a plan for each group, and the last is the driver's; without loads there are none.
    """

    ledger: Ledger
    polygons: tuple[Polygon, ...] = ()


def write_ledger(
    analysis: Analysis, units: Mapping[str, str] | None = None, worked: Sequence[int] = ()
) -> PlannedLedger:
    """Return the ledger of an analysis: given data, plans, closed formulas, forces, both torques, values of the cycle.

    `units` are the printed forms of units that depend on the language.  The plans of the `worked` positions, counted
    from 1, fill their paper; if none is named, those of all positions do.
    """
    machine = analysis.machine
    q, polygons = enter_plans(analysis, worked, machine.closed_formulas.write)
    if analysis.loads:
        topics = tuple(LEDGER.among(machine.topics))
        for hooks in topics:
            hooks.enter_forces(q, analysis, worked)
        with q.within(KeyChapter.cycle):
            _cycle(q, analysis)
            for hooks in topics:
                hooks.enter_cycle(q, analysis)
        for hooks in topics:
            hooks.enter_last(q, analysis)
    ledger = Ledger(q.families, machine.positions, units=units or {}, same=ONE_QUANTITY, lines=q.lines)
    return PlannedLedger(ledger, polygons)


def enter_plans(
    analysis: Analysis,
    worked: Sequence[int] = (),
    formulas: Callable[[Calculation], None] = no_formulas,
    scaled: bool = True,
) -> tuple[Calculation, tuple[Polygon, ...]]:
    """Return the calculation of an analysis at all its positions, and its force plans; without loads there are none.

    The calculation has the given data, the plans, the closed `formulas` and the forces. The plans of the `worked`
    positions, counted from 1, fill their paper; if none is named, those of all positions do. Plans that are not
    `scaled` are drawn elsewhere at another scale, so theirs is arbitrary.
    """
    machine = analysis.machine
    q = enter_motion(machine, analysis.cycle_angle, worked, scaled)
    with q.within(KeyChapter.formulas):
        formulas(q)
    if not analysis.loads:
        return q, ()
    _masses(q, analysis)
    _applied(q, analysis)
    applied = {one.name: (one.link, one.point, one.direction(analysis.motion)) for one in machine.applied}
    torques = {torque.name: torque.link for torque in machine.torques}
    guides = tuple(hooks.enter_guide for hooks in LEDGER.among(machine.topics))
    scales = own_scales if scaled else no_scales
    return q, enter_forces(q, machine.linkage, machine.turn, applied, torques, scales=scales, guides=guides)


def enter_motion(
    machine: Machine, cycle_angle: np.ndarray, worked: Sequence[int] = (), scaled: bool = True
) -> Calculation:
    """Return the calculation of a machine at cycle angles [N] (rad): given data, and the plans of its motion.

    `worked` and `scaled` are those of `enter_plans`.
    """
    q = Calculation(len(cycle_angle))
    if machine.span:
        q.give("s.1", machine.angles(cycle_angle), exact=False)
    else:
        q.give("phi.1", machine.angles(cycle_angle))
    q.extend(machine.calculation)
    sense = -1 if machine.acceleration < 0 else 1
    enter_kinematics(q, machine.linkage, machine.turn, worked, sense, scaled)
    return q


def _masses(q: Calculation, analysis: Analysis) -> None:
    """Enter the mass m = G/g of a body whose weight is given, and the weight G = m g of one whose mass is given."""
    for body in analysis.machine.linkage.inertias:
        weight, mass = ids.weight(body.link), ids.mass(body.link)
        if body.mass > 0 and weight in q and mass not in q:
            q.define(mass, q[weight] / q["g"])
        elif mass in q and weight not in q and "g" in q:
            q.define(weight, q[mass] * q["g"])


def _between_nodes(
    q: Calculation, among: Bracket, of: str | int, course: Stroke | None, symbol: Symbol, kind: str
) -> Expression:
    """Return a value interpolated between the adjacent points x′, p′ and x″, p″ of a table at each position.

        p = p′ + (p″ − p′)/(x″ − x′)·(x − x′)

    x is s/H of the `course`, the angle φ of the cycle, or the travel s of a sliding driver; `of` names the load in ids.
    """
    letter, sort = {"ratio": ("x", "ratio"), "angle": ("φ", "angle"), "length": ("s", "length")}[among.kind]

    node = ids.node if isinstance(of, int) else ids.load_node

    def give(mark: str, place: np.ndarray, size: np.ndarray) -> tuple[Ref, Ref]:
        x = q.give(node(f"x{mark}", of), place, Symbol(letter, sup=mark), sort, hidden=True)
        p = q.give(node(f"p{mark}", of), size, Symbol(symbol.base, sup=mark), kind, hidden=True)
        return x, p

    x: Expression
    if course is not None and among.kind == "ratio":
        x = q[ids.displacement(course.link)] / _stroke(q, course)
    else:
        places = (
            np.radians(rounded(np.degrees(among.at), KINDS["angle"].decimals or 0)) if sort == "angle" else among.at
        )
        x = q.give(node("x", of), places, Symbol(letter), sort, hidden=True)
    x1, p1 = give("′", among.before, among.pressure_before)
    x2, p2 = give("″", among.after, among.pressure_after)
    return p1 + (p2 - p1) / (x2 - x1) * (x - x1)


def _stroke(q: Calculation, course: Stroke) -> Ref:
    """Return the stroke of a slider (m): H as given, or rounded from the distance of its dead centres."""
    if "H" in q and abs(q.si("H") - course.stroke) <= ZERO * course.stroke:
        return q["H"]
    if (entered := q.find(ids.stroke(course.link))) is not None:
        return entered
    stroke = rounded(course.stroke, significant_decimals(course.stroke, KINDS["length"].digits))
    return q.give(ids.stroke(course.link), stroke, Symbol("H", str(course.link)), "length", hidden=True)


def _enter_displacement(q: Calculation, linkage: Linkage, link: int, values: np.ndarray, stroke: float) -> None:
    """Enter a slider's distances from its dead centre, the `values` [N] (m), as measured on the drawing.

    At the dead centre crank and rod lie in one line.
    """
    driver, id = linkage.driver, ids.displacement(link)
    dyad = next((one for one in linkage.dyads if one.kind == "RRP" and one.links[1] == link), None)
    if dyad is not None and isinstance(driver, Crank) and ids.length(driver.centre, dyad.start) in q:
        on_paper = q.find(ids.laid_line(driver.centre, dyad.start)) or q[ids.drawn(driver.centre, dyad.start)]
        crank, rod = q["drawing"] * on_paper, q["drawing"] * q[ids.laid_line(dyad.start, dyad.middle)]
        for reach in (rod + crank, rod - crank):
            line = q[ids.guide_place(link)], q[ids.guide(link)], float(dyad.sign)
            stop = circle_line(q[ids.place(driver.centre)], reach, *line)
            displacement = abs((q[ids.place(dyad.middle)] - stop) * (q["mu.l"] / q["drawing"]))
            measured = evaluate(displacement, {name: family.values for name, family in q.families.items()})
            if np.allclose(measured, values, rtol=0, atol=ZERO * stroke):
                q.define(id, displacement, scale=stroke)
                return
    drawn = q.give(
        ids.displacement_on_paper(link), values / q.si("mu.l"), Symbol("s"), "ratio", exact=False, hidden=True
    )
    q.define(id, abs(q["mu.l"] * drawn), scale=stroke)


def _applied(q: Calculation, analysis: Analysis) -> None:
    """Enter forces, positive along their own direction, and torques, anticlockwise positive, with the values by which
    they are read from tables.
    """
    machine = analysis.machine
    # A slider has one displacement. If gas acts on it, the gas pressure is computed from that, and a working force on
    # it is read from a table of its own.
    gassed = {force.link for force in machine.applied if force.name in analysis.gas}
    for force in machine.applied:
        if force.name in q:
            continue
        course = force.law.read_along
        own = force.name in analysis.gas or force.link not in gassed
        if course is not None and own and ids.displacement(force.link) not in q:
            displacements = course.fraction(analysis.motion) * course.stroke
            _enter_displacement(q, machine.linkage, force.link, displacements, course.stroke)
        if force.name in analysis.gas:
            state, link = analysis.gas[force.name], force.link
            piston = state.piston
            among = piston.indicator.bracket(state.angle, state.fraction, piston.dead_centres)
            written = _between_nodes(q, among, link, piston, Symbol("p"), "pressure")
            q.give(ids.pressure(link), state.pressure, exact=False, written=written)
        _size(q, force, analysis)
    for torque in machine.torques:
        _size(q, torque, analysis)


def _size(q: Calculation, load: Applied | Torque, analysis: Analysis, symbol: Symbol | str = "") -> None:
    """Enter the size [N] (N or N·m) of a load by the formula of its law, or as it is given."""
    formula = load.law.formula(q, load.link)
    if formula is not None:
        with q.within(KeyChapter.loads):
            q.define(load.name, formula, symbol)
    else:
        size = load.law.value(analysis.cycle_angle, analysis.motion)
        written, course = None, load.law.read_along
        among = None if load.law.constant else load.law.bracket(analysis.cycle_angle, analysis.motion)
        if among is not None and np.any(among.between):
            printed = vocabulary.symbol(load.name) if isinstance(symbol, str) else symbol
            written = _between_nodes(q, among, load.name, course, printed, vocabulary.row(load.name).kind)
        q.give(load.name, size, symbol, exact=written is None and is_short(size), written=written)


def _cycle(q: Calculation, analysis: Analysis) -> None:
    """Enter the mean, extremes, power and energy of the cycle."""
    machine = analysis.machine
    size, most = float(np.nanmax(np.abs(analysis.torque))), possible(analysis.motion, analysis.loads)
    if size < ZERO * most:
        # The whole torque is a rounding error, for example if a guide carries the whole load.
        size = most
    # A force balances a sliding driver, and its travel replaces the angle.
    letter, kind = ("P", "force") if machine.span else ("M", "torque")
    q.define("M.difference", abs(q["M.eq"] - q["M.vw"]), Symbol(f"Δ{letter}", "cb"), kind, scale=size, residue=True)
    nothing = abs(float(np.nanmean(q.value("M.eq")))) < ZERO * size
    largest = call("highest", call("abs", q["M.eq"]))
    q.define("M.share", q["M.difference"] / largest, Symbol("δ", letter), "share", scale=1.0, residue=True)
    if not machine.cyclic:
        return
    summary = analysis.summary
    rate = q[ids.velocity(machine.linkage.driver.pin)] if machine.span else q["omega.1"]
    angle = q["span"] if machine.span else 2.0 * machine.turns * PI
    even = q.give("even", machine.even, Symbol("even"), "ratio", hidden=True)
    q.define(
        "M.mean.positions", call("mean", q["M.eq"], even), Symbol(letter, "N"), kind, scale=size if nothing else 0.0
    )
    mean = q.give("M.mean", _without_dust(summary.mean_torque, size), Symbol(letter, "m"), kind, exact=False)
    (_, least), (_, greatest) = summary.extremes
    # An extreme is never inside the range of the values in the table.
    for id, index, extreme, of_two, of_all in (
        ("M.least", "min", least, "min", "lowest"),
        ("M.greatest", "max", greatest, "max", "highest"),
    ):
        read = q.give(ids.reading(id), extreme, Symbol(letter, index), kind, hidden=True)
        line = call(of_two, read, call(of_all, q["M.eq"]))
        q.give(id, extreme, Symbol(letter, index), kind, exact=False, scale=size, written=line)
    work = q.give("W", _without_dust(summary.work, size * machine.cycle_travel), exact=False)
    q.define("power", size_of(mean) * rate)
    q.define("M.energy", work / angle, Symbol(letter, "W"), kind)


def _without_dust(value: float, size: float) -> float:
    """Return a mean, or 0 if it is negligible beside the `size` of the averaged values."""
    return 0.0 if abs(value) < ZERO * size else value
