"""Analysis → Ledger: enters everything in the order in which a report derives it, then chooses decimals.

Decimals are chosen so that every printed line recomputes: a reader's calculator, fed with the printed numbers
x̂₁, x̂₂, … of a line y = f(x₁, x₂, …), comes to the printed ŷ within one unit of its last digit, at every
position.  To first order f(x̂) − ŷ = Σ ∂f/∂xᵢ (x̂ᵢ − xᵢ) − (ŷ − y).  Inputs get one more decimal, the largest
contribution first, as far as their kind allows; where that is not enough the result gets one fewer.  A whole
number keeps its units, of which the figures of the inputs may leave the last ones open.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache

import numpy as np

from reportgen import flywheel
from reportgen.analysis import Analysis
from reportgen.catalogue.loads import TableLaw
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces import enter_forces
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics import centres, enter_kinematics
from reportgen.mechanism.structure import Crank, Linkage
from reportgen.notation.evaluation import evaluate
from reportgen.notation.expressions import PI, Expression, Symbol, call, circle_line, refs, total
from reportgen.notation.expressions import size as size_of
from reportgen.notation.sheet import ZERO, Family, Sheet, is_short
from reportgen.notation.vocabulary import Chapter

LEAST_DIGITS = 3
"""A family's largest value keeps at least these; a line that needs fewer is a listed cancellation."""


@dataclass(frozen=True, slots=True)
class _Line:
    id: str
    inputs: tuple[str, ...]
    slopes: np.ndarray
    """∂f/∂xᵢ in printed units, [inputs, positions]."""


def _largest(family: Family) -> float:
    finite = np.abs(family.values[np.isfinite(family.values)]) / family.how.scale
    return float(finite.max()) if finite.size else 0.0


def _digits_to_decimals(family: Family, digits: int, at_least: float = 0.0) -> int:
    """Decimals that show the largest value, or one of size `at_least`, with so many figures."""
    largest = max(_largest(family), at_least)
    if largest == 0:
        return max(digits - 1, 0) if family.how.decimals is None else family.how.decimals
    return digits - 1 - math.floor(math.log10(largest) + 1e-12)


def _wanted(family: Family) -> int:
    """The decimals aimed at: those of its kind, counted from what it stands beside (its scale)."""
    if family.how.decimals is not None:
        return family.how.decimals
    return _digits_to_decimals(family, family.how.digits, family.scale / family.how.scale)


def _is_short(family: Family) -> bool:
    """Whether one value serves all positions and has few enough digits to be printed as it is (0.171 m)."""
    if len(family.values) > 1 or family.definition is None:
        return False
    return is_short(float(family.values[0].real) / family.how.scale)


def _shown_decimals(family: Family) -> int:
    value = float(family.values[0].real) / family.how.scale
    return -int(Decimal(f"{value:.12g}").normalize().as_tuple().exponent)


def _slopes(family: Family, inputs: tuple[str, ...], families: Mapping[str, Family]) -> np.ndarray:
    """∂f/∂xᵢ by central differences, both sides in printed units."""
    assert family.definition is not None
    values = {id: families[id].values for id in inputs}
    rows = []
    for id in inputs:
        source = families[id]
        step = 1e-6 * max(_largest(source) * source.how.scale, 1e-30)
        with np.errstate(all="ignore"):
            up = evaluate(family.definition, values | {id: source.values + step})
            down = evaluate(family.definition, values | {id: source.values - step})
        slope = (np.asarray(up) - down) / (2 * step) * source.how.scale / family.how.scale
        slope = np.nan_to_num(slope, posinf=0.0, neginf=0.0)
        rows.append(np.broadcast_to(slope, np.broadcast_shapes(slope.shape, (1,))))
    width = max((row.size for row in rows), default=1)
    return np.array([np.broadcast_to(row, (width,)) for row in rows])


def choose_decimals(
    families: Mapping[str, Family],
    same: tuple[tuple[str, str], ...] = (),
    fixed: Mapping[str, int | None] | None = None,
) -> tuple[dict[str, int | None], tuple[str, ...]]:
    """Decimals for every family (None: exact) and the ids of lines that cannot be made to recompute.

    Pairs of the `same` number, reached in two ways, are printed with the decimals of the coarser.  Decimals `fixed`
    before stay as they are, and the lines of those families are not judged again.
    """
    fixed = fixed or {}
    decimals: dict[str, int | None] = {}
    ceiling: dict[str, int] = {}
    floor: dict[str, int] = {}
    for id, family in families.items():
        if id in fixed:
            decimals[id], ceiling[id] = fixed[id], fixed[id] or 0
            continue
        if family.exact or family.is_plane or family.hidden or _is_short(family):
            decimals[id] = None
            continue
        most, wanted = _digits_to_decimals(family, family.how.most), _wanted(family)
        if family.how.finest is not None:
            most = min(most, family.how.finest)
        # A whole number is shown whole: 3970 for 3965 would be read as exact to its last nought.
        floor[id], ceiling[id] = max(min(_digits_to_decimals(family, LEAST_DIGITS), wanted), 0), max(most, 0)
        decimals[id] = min(max(wanted, 0), ceiling[id])

    lines = [
        _Line(id, inputs, _slopes(family, inputs, families))
        for id, family in families.items()
        if id not in fixed
        and family.definition is not None
        and not (family.constructed or family.is_plane or family.hidden)
        for inputs in (refs(family.definition),)
        if inputs and not any(families[name].is_plane for name in inputs)
    ]

    def shown(id: str) -> int:
        """Decimals as printed; a result printed as it is (0.171 m) is read to its own last digit."""
        digits = decimals[id]
        return _shown_decimals(families[id]) if digits is None else digits

    @cache
    def rounding(id: str, digits: int) -> np.ndarray:
        """x̂ − x at every position, in printed units."""
        values = np.nan_to_num(families[id].values.real / families[id].how.scale)
        return np.asarray(np.round(values, digits) - values)

    def shares(line: _Line) -> list[tuple[str, np.ndarray]]:
        """What the rounding of each input that is not exact does to the line, ∂f/∂xᵢ (x̂ᵢ − xᵢ)."""
        known = ((id, slope, decimals[id]) for id, slope in zip(line.inputs, line.slopes, strict=True))
        return [(id, slope * rounding(id, digits)) for id, slope, digits in known if digits is not None]

    def over(line: _Line) -> np.ndarray:
        """How far a line is off at each position, in units of its last digit."""
        off = sum((share for _, share in shares(line)), -rounding(line.id, shown(line.id)))
        return np.asarray(np.abs(off) * 10.0 ** shown(line.id))

    def holds(line: _Line) -> bool:
        return bool(over(line).max() <= 1 + 1e-6)

    cancellations: dict[str, None] = {}
    whole: set[str] = set()
    settled = False
    while not settled:
        settled = True
        for line in reversed(lines):
            while not (line.id in cancellations or line.id in whole or holds(line)):
                worst = int(over(line).argmax())
                raisable = [
                    (abs(share[worst % share.size]), id)
                    for id, share in shares(line)
                    if (decimals[id] or 0) < ceiling[id]
                ]
                settled = False
                if raisable and max(raisable)[0] > 0:
                    chosen = max(raisable)[1]
                    decimals[chosen] = (decimals[chosen] or 0) + 1
                elif (own := decimals[line.id]) is not None and own > floor[line.id]:
                    decimals[line.id] = ceiling[line.id] = own - 1
                elif own == 0 and _largest(families[line.id]) >= 10 ** (LEAST_DIGITS - 1):
                    # Its last units are what the printed figures of its inputs leave open.
                    whole.add(line.id)
                else:
                    cancellations[line.id] = None
    # Decimals that were raised in vain, before the result gave way, are given back.
    uses: dict[str, list[_Line]] = {}
    for line in lines:
        for id in line.inputs:
            uses.setdefault(id, []).append(line)
    own_lines = {line.id: line for line in lines}
    for id in reversed([id for id in families if id not in fixed]):
        concerned = [*uses.get(id, []), *([own_lines[id]] if id in own_lines else [])]
        concerned = [line for line in concerned if line.id not in cancellations and line.id not in whole]
        aim = max(_wanted(families[id]), 0)
        while (digits := decimals[id]) is not None and digits > aim:
            decimals[id] = digits - 1
            if not all(map(holds, concerned)):
                decimals[id] = digits
                break
    for pair in same:
        known = [digits for id in pair if (digits := decimals.get(id)) is not None]
        for id in pair:
            if decimals.get(id) is not None:
                decimals[id] = min(known)
    return decimals, tuple(cancellations)


TERMS = 4
"""More terms than these are no longer one line of a page."""


def write_ledger(analysis: Analysis, units: Mapping[str, str] | None = None, worked: Sequence[int] = ()) -> Ledger:
    """The ledger of an analysis: given data, plans, closed formulas, forces, both torques, the cycle's figures.

    The plans of the `worked` positions fill their paper, of all positions if none is named.
    """
    machine = analysis.machine
    q = Sheet(machine.positions)
    if machine.span:
        q.give("s.1", machine.angles(analysis.cycle_angle), exact=False)
    else:
        q.give("phi.1", machine.angles(analysis.cycle_angle))
    q.extend(machine.sheet)
    enter_kinematics(q, machine.linkage, machine.turn, worked)
    with q.within(Chapter.formulas):
        machine.formulas(q)
    polygons: tuple[Polygon, ...] = ()
    regulated: flywheel.Flywheel | None = None
    if analysis.loads:
        _masses(q, analysis)
        _gas(q, analysis)
        _applied(q, analysis)
        applied = {one.name: (one.link, one.point, one.direction) for one in machine.applied}
        torques = {one.name: one.link for one in machine.torques}
        polygons = enter_forces(q, machine.linkage, machine.turn, applied, torques)
        with q.within(Chapter.cycle):
            _cycle(q, analysis)
            if machine.unevenness is not None:
                regulated = flywheel.flywheel(machine, machine.unevenness)
                _flywheel(q, machine.linkage, regulated, machine.cycle_angles)
    # The checks by instant centres take the other numbers as they are printed.
    main = {id: family for id, family in q.families.items() if not id.startswith(centres.PREFIX)}
    settled, listed = choose_decimals(main, (("M.eq", "M.vw"),) if "M.eq" in q else ())
    decimals, more = choose_decimals(q.families, fixed=settled)
    return Ledger(q.families, decimals, machine.positions, listed + more, units or {}, polygons, regulated)


def _masses(q: Sheet, analysis: Analysis) -> None:
    """Mass m = G/g where the weight is given, weight G = m g where the mass is."""
    for body in analysis.machine.linkage.inertias:
        weight, mass = f"G{body.link}", f"m.{body.link}"
        if body.mass > 0 and weight in q and mass not in q:
            q.define(mass, q[weight] / q["g"])
        elif mass in q and weight not in q:
            q.define(weight, q[mass] * q["g"])


def _gas(q: Sheet, analysis: Analysis) -> None:
    """s/H and pressure read from the diagram, gas force P = p F."""
    machine = analysis.machine
    for name, state in analysis.gas.items():
        if name in analysis.machine.idle:
            continue
        link, stroke = state.piston.link, state.piston.stroke
        _way(q, machine.linkage, link, state.fraction * stroke, stroke)
        p = q.give(f"p.{link}", state.pressure, exact=False)
        q.define(name, p * q["F"])


def _way(q: Sheet, linkage: Linkage, link: int, values: np.ndarray, stroke: float) -> None:
    """A slider's way from its dead centre, measured on the drawing; there crank and rod lie in one line."""
    driver, id = linkage.driver, f"s.{link}"
    dyad = next((one for one in linkage.dyads if one.kind == "RRP" and one.links[1] == link), None)
    if dyad is not None and isinstance(driver, Crank) and f"l.{driver.centre}{dyad.start}" in q:
        on_paper = q.find(f"laid.{driver.centre}{dyad.start}") or q[f"drawn.{driver.centre}{dyad.start}"]
        crank, rod = q["drawing"] * on_paper, q["drawing"] * q[f"laid.{dyad.start}{dyad.middle}"]
        for reach in (rod + crank, rod - crank):
            line = q[f"guide.{link}.at"], q[f"guide.{link}"], float(dyad.sign)
            stop = circle_line(q[f"p.{driver.centre}"], reach, *line)
            way = abs((q[f"p.{dyad.middle}"] - stop) * (q["mu.l"] / q["drawing"]))
            found = evaluate(way, {name: family.values for name, family in q.families.items()})
            if np.allclose(found, values, rtol=0, atol=ZERO * stroke):
                q.define(id, way, scale=stroke)
                return
    drawn = q.give(f"way.{link}", values / q.si("mu.l"), Symbol("s"), "ratio", exact=False, hidden=True)
    q.define(id, abs(q["mu.l"] * drawn), scale=stroke)


def _applied(q: Sheet, analysis: Analysis) -> None:
    """Forces other than of gas, positive along their own direction, and torques, anticlockwise positive."""
    loads = {load.name: load for load in analysis.applied}
    for force in analysis.machine.applied:
        if force.name not in q:
            link, size = force.link, np.real(np.conj(force.direction) * loads[force.name].force)
            if isinstance(force.law, TableLaw):
                course = force.law.course
                way = course.fraction(analysis.motion) * course.stroke
                _way(q, analysis.machine.linkage, link, way, course.stroke)
            q.give(force.name, size, exact=is_short(size))
    for torque in analysis.machine.torques:
        size = loads[torque.name].couple
        q.give(torque.name, size, Symbol("M", str(torque.link)), exact=is_short(size))


def _cycle(q: Sheet, analysis: Analysis) -> None:
    """Mean, extremes, power and energy of the cycle."""
    summary, machine = analysis.summary, analysis.machine
    size, possible = float(np.nanmax(np.abs(analysis.torque))), flywheel.possible(analysis, analysis.loads)
    if size < ZERO * possible:
        # All of it is rounding, as where a guide takes the whole load.
        size = possible
    # A sliding driver is balanced by a force, and its way takes the place of the angle.
    letter, kind = ("P", "force") if machine.span else ("M", "torque")
    rate = q[f"v.{machine.linkage.driver.pin}"] if machine.span else q["omega.1"]
    way = q["span"] if machine.span else 2.0 * machine.turns * PI
    q.define("M.difference", abs(q["M.eq"] - q["M.vw"]), Symbol(f"Δ{letter}", "cb"), kind, scale=size)
    nothing = abs(float(np.nanmean(q.value("M.eq")))) < ZERO * size
    mean_of_positions = call("mean", q["M.eq"])
    q.define("M.mean.positions", mean_of_positions, Symbol(letter, "N"), kind, scale=size if nothing else 0.0)
    mean = q.give("M.mean", _without_dust(summary.mean_torque, size), Symbol(letter, "m"), kind, exact=False)
    (_, least), (_, greatest) = summary.extremes
    q.give("M.least", least, Symbol(letter, "min"), kind, exact=False, scale=size)
    q.give("M.greatest", greatest, Symbol(letter, "max"), kind, exact=False, scale=size)
    work = q.give("W", _without_dust(summary.work, size * machine.way), exact=False)
    q.define("power", size_of(mean) * rate)
    q.define("M.energy", work / way, Symbol(letter, "W"), kind)


def _without_dust(value: float, size: float) -> float:
    """A mean that is nothing beside what it is the mean of is 0."""
    return 0.0 if abs(value) < ZERO * size else value


# --- the flywheel -----------------------------------------------------------------------------------


def _flywheel(q: Sheet, linkage: Linkage, regulated: flywheel.Flywheel, positions: np.ndarray) -> None:
    """Enter the flywheel of a machine whose positions are the cycle angles `positions`; δ is `unevenness`.

    Ids: `J.r` reduced inertia (only where a moving link has mass), `M.r` reduced torque, `A.excess` excess work,
    `omega.of` the regulated speed at each position; `M.c` the constant torque, `omega.max`, `omega.min`, `A.upper`,
    `A.lower`, and `J.d` the flywheel.
    """
    at = np.searchsorted(regulated.angle, positions - 1e-9)
    inertia = _reduced(q, linkage)
    if inertia is not None:
        q.define("J.r", inertia, Symbol("J", "tt"))
    largest, δ, ω1 = float(np.abs(regulated.torque).max()), q["unevenness"], q["omega.1"]
    q.give("M.r", regulated.torque[at], Symbol("M", "tt"), exact=False, scale=largest)
    q.give("M.c", regulated.constant, exact=False, scale=largest)
    most = float(np.abs(regulated.work).max())
    q.give("A.excess", regulated.work[at], "A", "work", exact=False, scale=most)
    q.define("omega.max", ω1 * (1 + δ / 2))
    q.define("omega.min", ω1 * (1 - δ / 2))
    a = q.give("A.upper", regulated.upper, "a", "work", exact=False)
    b = q.give("A.lower", regulated.lower, "b", "work", exact=False)
    q.define("J.d", (a - b) / (δ * ω1**2))
    if regulated.moment > 0:
        q.give("omega.of", regulated.speed[at], "ω", exact=False)


def _reduced(q: Sheet, linkage: Linkage) -> Expression | None:
    """J_r = Σ m v_S²/ω₁² + J ω²/ω₁² over the links that move so; None where no link with mass moves.

    Where that is too long for a line, each link's part of it is entered as `J.r.` and its number.
    """
    ω1 = q["omega.1"]
    parts: dict[int, list[Expression]] = {}
    for body in linkage.inertias:
        link, centre, rotation = body.link, f"v.{body.centre}", f"omega.{body.link}"
        own: list[Expression] = []
        if body.mass > 0 and centre in q:
            own.append(q[f"m.{link}"] * q[centre] ** 2)
        if body.moment > 0 and rotation in q:
            own.append(q[f"J.{link}"] * q[rotation] ** 2)
        if own:
            parts[link] = own
    terms = [term for own in parts.values() for term in own]
    if not terms:
        return None
    if len(terms) <= TERMS or len(parts) == 1:
        return total(terms) / ω1**2
    each = [q.define(f"J.r.{link}", total(own) / ω1**2, Symbol("J", f"tt{link}")) for link, own in parts.items()]
    return total(each)
