"""Analysis → Ledger: enters everything in the order in which a report derives it, then chooses decimals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from reportgen import regulation
from reportgen.analysis import Analysis
from reportgen.catalogue.laws import TableLaw
from reportgen.catalogue.machine import Item
from reportgen.cycle.flywheel import Flywheel
from reportgen.ledger import flywheel, forces, kinematics, precision
from reportgen.ledger.core import ZERO, Builder, Ledger
from reportgen.ledger.forces import Polygon
from reportgen.notation.expressions import Ref, Symbol, call, divide, multiply, subtract
from reportgen.notation.symbols import MAX_DIGITS


@dataclass(frozen=True)
class Books:
    """The ledger of a report and how its force plans are laid out."""

    ledger: Ledger
    polygons: tuple[Polygon, ...]
    flywheel: Flywheel | None = None


def enter(b: Builder, items: Iterable[Item]) -> None:
    """Enter a machine's own items."""
    for item in items:
        if item.definition is None:
            b.give(item.id, item.symbol, item.kind, item.value, **({"exact": True} | dict(item.traits)))
        else:
            b.define(item.id, item.symbol, item.kind, item.definition, **item.traits)


def keep(analysis: Analysis, units: Mapping[str, str] | None = None) -> Books:
    """The books of an analysis: given data, plans, closed formulas, forces, both torques, the cycle's figures."""
    machine = analysis.machine
    b = Builder(machine.positions)
    if machine.span:
        b.give("s.1", Symbol("s", "1"), "length", machine.angles(analysis.cycle_angle), exact=False)
    else:
        b.give("phi.1", Symbol("φ", "1"), "angle", machine.angles(analysis.cycle_angle))
    enter(b, machine.given)
    kinematics.describe(b, machine.linkage, machine.turn)
    enter(b, machine.formulas)
    polygons: tuple[Polygon, ...] = ()
    wheel: Flywheel | None = None
    if analysis.loads:
        _masses(b, analysis)
        _gas(b, analysis)
        _applied(b, analysis)
        applied = {one.name: (one.link, one.point, one.direction) for one in machine.applied}
        polygons = forces.describe(
            b, machine.linkage, machine.turn, applied, {one.name: one.link for one in machine.torques}
        )
        _cycle(b, analysis)
        if machine.unevenness is not None:
            wheel = regulation.flywheel(machine, machine.unevenness)
            flywheel.describe(b, machine.linkage, wheel, machine.cycle_angles)
    # The checks by instant centres take the other numbers as they are printed.
    main = {id: family for id, family in b.families.items() if not id.startswith(kinematics.PREFIX)}
    settled, listed = precision.choose(main, (("M.eq", "M.vw"),) if "M.eq" in b else ())
    decimals, more = precision.choose(b.families, fixed=settled)
    cancellations = listed + more
    return Books(Ledger(b.families, decimals, machine.positions, cancellations, units or {}), polygons, wheel)


def _masses(b: Builder, analysis: Analysis) -> None:
    """Mass m = G/g where the weight is given, weight G = m g where the mass is."""
    for body in analysis.machine.linkage.inertias:
        link = str(body.link)
        if body.mass > 0 and f"G{link}" in b and f"m.{link}" not in b:
            b.define(f"m.{link}", Symbol("m", link), "mass", divide(f"G{link}", "g"))
        elif f"m.{link}" in b and f"G{link}" not in b:
            b.define(f"G{link}", Symbol("G", link), "weight", multiply(f"m.{link}", "g"))


def _gas(b: Builder, analysis: Analysis) -> None:
    """s/H and pressure read from the diagram, gas force P = p F."""
    for name, state in analysis.gas.items():
        link = str(state.piston.link)
        stroke = state.piston.stroke
        b.give(f"s.{link}", Symbol("s", link), "length", state.fraction * stroke, exact=False, scale=stroke)
        b.give(f"p.{link}", Symbol("p", link), "pressure", state.pressure, exact=False)
        b.define(name, Symbol("P", link), "force", multiply(f"p.{link}", "F"))


def _applied(b: Builder, analysis: Analysis) -> None:
    """Forces other than of gas, positive along their own direction, and torques, anticlockwise positive."""
    loads = {load.name: load for load in analysis.applied}
    for force in analysis.machine.applied:
        if force.name not in b:
            link, size = str(force.link), np.real(np.conj(force.direction) * loads[force.name].force)
            if isinstance(force.law, TableLaw):
                course = force.law.course
                way = course.fraction(analysis.motion) * course.stroke
                b.give(f"s.{link}", Symbol("s", link), "length", way, exact=False, scale=course.stroke)
            b.give(force.name, Symbol("P", link), "force", size, exact=_short(size))
    for torque in analysis.machine.torques:
        size = loads[torque.name].couple
        b.give(torque.name, Symbol("M", str(torque.link)), "torque", size, exact=_short(size))


def _short(values: np.ndarray) -> bool:
    """Whether all values have few digits, as typed sizes have, and can be printed as they are."""
    return all(abs(float(f"{value:.{MAX_DIGITS - 1}g}") - value) <= 1e-12 * abs(value) for value in values)


def _cycle(b: Builder, analysis: Analysis) -> None:
    """Mean, extremes, power and energy of the cycle."""
    summary, machine = analysis.summary, analysis.machine
    size = float(np.nanmax(np.abs(analysis.torque)))
    # A sliding driver is balanced by a force, and its way takes the place of the angle.
    kind, letter = ("force", "P") if machine.span else ("torque", "M")
    rate = f"v.{machine.linkage.driver.pin}" if machine.span else "omega.1"
    turns = 2 * machine.turns
    way = Ref("span") if machine.span else multiply(float(turns), Symbol("π", value=np.pi))
    b.define(
        "M.difference", Symbol(f"Δ{letter}", "cb"), kind, call("abs", subtract("M.eq", "M.vw")), scale=size
    )
    nothing = abs(float(np.nanmean(b.value("M.eq")))) < ZERO * size
    b.define(
        "M.mean.positions", Symbol(letter, "N"), kind, call("mean", "M.eq"), scale=size if nothing else 0.0
    )
    b.give("M.mean", Symbol(letter, "m"), kind, _dustless(summary.mean_torque, size), exact=False)
    b.give("M.least", Symbol(letter, "min"), kind, summary.extremes[0][1], exact=False, scale=size)
    b.give("M.greatest", Symbol(letter, "max"), kind, summary.extremes[1][1], exact=False, scale=size)
    b.give("W", Symbol("W"), "work", _dustless(summary.work, size * machine.way), exact=False)
    b.define("power", Symbol("N"), "power", multiply(call("abs", "M.mean"), rate))
    b.define("M.energy", Symbol(letter, "W"), kind, divide("W", way))


def _dustless(value: float, size: float) -> float:
    """A mean that is nothing beside what it is the mean of is 0."""
    return 0.0 if abs(value) < ZERO * size else value
