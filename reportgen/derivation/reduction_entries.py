"""Ledger entries that reduce the masses and loads of a machine to its driver."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reportgen.derivation.topic_ledger import LEDGER
from reportgen.derivation.unprinted_values import with_rest
from reportgen.formula import NOTHING, Expression, Number, Ref, Symbol, ids, total
from reportgen.formula.calculation import Calculation
from reportgen.machine import Inertia, Linkage
from reportgen.machine.analysis import Analysis
from reportgen.machine.load_laws import FULL_TURN

TERMS = 4
"""Largest number of terms that fit in one line of a page."""


def enter_reduced(
    q: Calculation, analysis: Analysis, torque: np.ndarray, largest: float
) -> tuple[Expression, Ref, Ref]:
    """Enter and return J_r (kg·m²), M_r (N·m) with the values `torque` [N], and the steps between positions (rad) [N].

    J_r is 0, and not entered, if no link with mass moves; `largest` (N·m) is the reference size of torques.
    """
    machine = analysis.machine
    inertia = _reduced(q, machine.linkage)
    J_r: Expression = NOTHING if inertia is None else q.define("J.r", inertia, Symbol("J", "tt"))
    on_lever = [
        q[ids.lever_moment(load.name)]
        for load in (*analysis.weights, *analysis.applied)
        if ids.lever_moment(load.name) in q
    ]
    angles = np.diff(np.append(machine.cycle_angles, machine.turns * FULL_TURN))
    steps = q.give("steps", angles, Symbol("φ"), "ratio", hidden=True)
    by_lever: Expression = machine.turn * total(on_lever) if on_lever else Number(0.0)
    symbol = Symbol("M", "tt")
    for hooks in LEDGER.among(machine.topics):
        if (further := hooks.reduced(q, largest)) is not None:
            by_lever = by_lever + further
    M_r = with_rest(q, "M.r", values=torque, by_rule=by_lever, symbol=symbol, kind="torque", scale=largest)
    return J_r, M_r, steps


def moving_bodies(q: Calculation, linkage: Linkage) -> Iterator[tuple[Inertia, str, str]]:
    """Yield each moving body with the ids of the velocity of its mass centre and of its angular velocity.

    An id is "" if the body has no mass, or no moment of inertia, to move at that velocity, or does not move so.
    """
    for body in linkage.inertias:
        centre, rotation = ids.velocity(body.centre), ids.angular_velocity(body.link)
        moving = centre if body.mass > 0 and centre in q else ""
        turning = rotation if body.moment > 0 and rotation in q else ""
        if moving or turning:
            yield body, moving, turning


def _reduced(q: Calculation, linkage: Linkage) -> Expression | None:
    """Return J_r = Σ m v_S²/ω₁² + J ω²/ω₁² over the moving links; None if no link with mass moves.

    If that is too long for a line, each link's part of it is entered as `J.r.` and its number.
    """
    ω1 = q["omega.1"]
    parts: dict[int, list[Expression]] = {}
    for body, moving, turning in moving_bodies(q, linkage):
        own: list[Expression] = []
        if moving:
            own.append(q[ids.mass(body.link)] * q[moving] ** 2)
        if turning:
            own.append(q[ids.inertia(body.link)] * q[turning] ** 2)
        parts[body.link] = own
    terms = [term for own in parts.values() for term in own]
    if not terms:
        return None
    if len(terms) <= TERMS or len(parts) == 1:
        return total(terms) / ω1**2
    each = [
        q.define(ids.reduced_inertia(link), total(own) / ω1**2, Symbol("J", f"tt{link}")) for link, own in parts.items()
    ]
    return total(each)
