"""Ledger entries for the cycle of a machine reduced to its crank, and for the flywheel."""

from __future__ import annotations

import numpy as np

from reportgen.derivation.plan_scales import DIAGRAM, fitting_axis
from reportgen.derivation.reduction_entries import enter_reduced, moving_bodies
from reportgen.derivation.topic_ledger import LedgerHooks
from reportgen.derivation.unprinted_values import with_rest
from reportgen.flywheel.regulation import regulated_in
from reportgen.formula import NOTHING, Expression, Ref, Symbol, atan, call, ids, sqrt, total
from reportgen.formula.calculation import Calculation
from reportgen.machine import DRIVER, Linkage
from reportgen.machine.analysis import Analysis
from reportgen.machine.regulated_cycle import RegulatedCycle

CONSTANT = 1e-9
"""A speed that varies by less than this share of its size is constant."""


def enter(q: Calculation, analysis: Analysis) -> None:
    """Enter the flywheel of a machine; δ is `unevenness`.

    A value integrated over the cycle is the trapezoid rule over the positions plus the remainder of the integral. Ids:
    `J.r` reduced inertia (only if a moving link has mass), `M.r` reduced torque, `A.excess` excess work, `omega.of` the
    regulated speed at each position; `M.c` the constant torque, `omega.max`, `omega.min`, `A.upper`, `A.lower`, and
    `J.d` the flywheel; the scales of the energy–mass diagram, and Mertsalov's `J.I`.
    """
    machine, regulated = analysis.machine, regulated_in(analysis)
    at = np.searchsorted(regulated.angle, machine.cycle_angles - 1e-9)
    J_r, M_r, steps = enter_reduced(q, analysis, regulated.torque[at], float(np.abs(regulated.torque).max()))
    inertia = None if J_r is NOTHING else J_r
    largest, δ, ω1 = float(np.abs(regulated.torque).max()), q["unevenness"], q["omega.1"]
    with_rest(
        q, "M.c", values=regulated.constant, by_rule=-call("level", M_r, steps), symbol="", kind="torque", scale=largest
    )
    most = float(np.abs(regulated.work).max())
    A = with_rest(
        q,
        "A.excess",
        values=regulated.work[at],
        by_rule=call("excess", M_r, steps),
        symbol="A",
        kind="work",
        scale=most,
    )
    most_energy, least_energy = (
        A - q.define(ids.bound_of_speed(name), ω1 * share) ** 2 * J_r / 2
        for name, share in (("max", 1 + δ / 2), ("min", 1 - δ / 2))
    )
    a = with_rest(q, "A.upper", regulated.upper, call("highest", most_energy), Symbol("A", "a"), "work")
    b = with_rest(q, "A.lower", regulated.lower, call("lowest", least_energy), Symbol("A", "b"), "work")
    J_d = q.define("J.d", (a - b) / (δ * ω1**2))
    if inertia is not None:
        _energy_mass(q, regulated)
    if inertia is not None and regulated.moment > 0:
        _constant_group(q, machine.linkage, regulated, machine.speed)
    if regulated.moment > 0:
        energy = q["omega.max"] ** 2 * J_d / 2 - a + A
        with_rest(q, "omega.of", regulated.speed[at], sqrt(2 * energy / (J_d + J_r)), "ω")


def _energy_mass(q: Calculation, regulated: RegulatedCycle) -> None:
    """Enter the scales of the energy–mass diagram and the inclinations of its tangents, tan ψ = μ_J ω²/(2 μ_A)."""
    heights = np.append(regulated.work, (regulated.upper, regulated.lower, 0.0))
    μ_J = q.give("mu.J", fitting_axis(float(regulated.inertia.max()), DIAGRAM[0]))
    μ_A = q.give("mu.A", fitting_axis(float(np.ptp(heights)), DIAGRAM[1]))
    for name in ("max", "min"):
        q.define(ids.tangent(name), atan(μ_J * q[ids.bound_of_speed(name)] ** 2 / (2 * μ_A)))


def _constant_group(q: Calculation, linkage: Linkage, regulated: RegulatedCycle, speed: float) -> None:
    """Enter Mertsalov's method: the energy of the group with constant inertia, with that of the others at the mean
    speed.

    Group I is the flywheel and the links of constant reduced inertia J_0, including the crank; J_r − J_0 is that of
    group II. T_I = A − (J_r − J_0) ω₁²/2 up to a constant, J_I = ΔT_I/(δ ω₁²), J_d = J_I − J_0.
    """
    J_0, fixed = _constant(q, linkage)
    energy = regulated.work - speed**2 / 2 * (regulated.inertia - fixed)
    most, range_ = float(np.abs(energy).max()), float(np.ptp(energy))
    J_II = q["J.r"] if J_0 is None else q["J.r"] - J_0
    T = q.define("T.I", q["A.excess"] - J_II * q["omega.1"] ** 2 / 2, scale=most)
    ΔT = with_rest(q, "T.range", range_, call("highest", T) - call("lowest", T), Symbol("ΔT", "I"), "work")
    J_I = q.define("J.I", ΔT / (q["unevenness"] * q["omega.1"] ** 2))
    if J_0 is not None:
        J_I = q.define("J.rest", J_I - J_0, Symbol("J", "I,d"), "moment of inertia")
    q.define("J.share", abs(J_I - q["J.d"]) / q["J.d"], Symbol("δ", "J"), "share", scale=1.0, residue=True)


def _constant(q: Calculation, linkage: Linkage) -> tuple[Ref | None, float]:
    """Return the reduced inertia J_0 (kg·m²) of the links whose speeds are constant beside the crank's; None without
    any.
    """
    ω1 = q["omega.1"]
    terms: list[Expression] = []
    for body, moving, turning in moving_bodies(q, linkage):
        rates = [q.value(rate) for rate in (moving, turning) if rate]
        if any(np.ptp(rate) > CONSTANT * np.abs(rate).max() for rate in rates):
            continue
        if moving:
            terms.append(q[ids.mass(body.link)] * call("highest", q[moving]) ** 2 / ω1**2)
        if turning:
            J = q[ids.inertia(body.link)]
            terms.append(J if body.link == DRIVER else J * call("highest", q[turning]) ** 2 / ω1**2)
    if not terms:
        return None, 0.0
    J_0 = q.define("J.0", total(terms), Symbol("J", "0"), "moment of inertia")
    return J_0, float(q.value("J.0")[0])


HOOKS = LedgerHooks(enter_cycle=enter)
