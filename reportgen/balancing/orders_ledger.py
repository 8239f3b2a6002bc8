"""Ledger entries for an engine's orders: A_n exactly and by the series in λ, the stars of the cranks, forces and
couples.

Angles of pins and cylinders are measured from those of the first cylinder. If cylinders are offset, or rods are
articulated on one another, only the orders of the whole force are entered, odd ones included.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reportgen.balancing import balance_ids
from reportgen.balancing.counterweights import CrankRod
from reportgen.balancing.orders import BACKWARD, FORWARD, Engine, EngineCylinder, engine, on_sliders
from reportgen.balancing.piston_orders import acceleration_factor, short_series
from reportgen.balancing.shaking_force import CrankCurve
from reportgen.formula import NOTHING, ONE, Expression, Number, Ref, Symbol, cos, ids, plus, sin, sqrt, total
from reportgen.formula.calculation import Calculation
from reportgen.formula.evaluation import evaluate
from reportgen.machine import Crank
from reportgen.machine.analysis import Analysis

ORDERS = (1, 2, 4)
"""Orders of forces and couples; the acceleration of a single piston also has the sixth."""
EXACT = (2, 4, 6)
OF_ALL = (1, 2, 3, 4, 5, 6)
SENSES = {"forward": FORWARD, "backward": BACKWARD}
SAME_ANGLE = 1e-9


PointMasses = Callable[[CrankRod], tuple[Expression, Expression]]
"""Function that returns the mass of a rod that turns with its pin, and the mass that reciprocates with its slider."""


def enter_orders(
    q: Calculation, analysis: Analysis, curve: CrankCurve, force: float, point_masses: PointMasses
) -> None:
    """Enter the orders of an engine, or of another machine of rods and sliders; `force` (N) is a reference size."""
    linkage = analysis.machine.linkage
    layout = engine(linkage)
    if layout is not None and isinstance(linkage.driver, Crank):
        _of_engine(q, layout, linkage.driver.centre, point_masses)
    elif on_sliders(linkage):
        count = len(curve.harmonics)
        for order in OF_ALL:
            # Seen from the crank, a vector that turns with nφ turns with (n − 1)φ.
            turn = analysis.machine.turn
            parts = (curve.harmonics[(turn * (sense * order - 1)) % count] for sense in SENSES.values())
            size = sum(map(abs, parts)) * analysis.machine.speed**2
            q.give(balance_ids.order_force(order), size, exact=False, scale=force)


def _of_engine(q: Calculation, layout: Engine, centre: str, point_masses: PointMasses) -> None:
    first = layout.rods[0]
    r, l = q[ids.length(centre, first.crank_pin)], q[ids.length(first.crank_pin, first.end)]  # noqa: E741
    λ = q.find("lambda") or q.define(balance_ids.RATIO, r / l, Symbol("λ"))
    A: dict[int, Expression] = {1: ONE}
    for order in EXACT:
        value = float(evaluate(acceleration_factor(order, λ, q.si(λ)), {λ.id: q.value(λ)})[0])
        exact = q.give(balance_ids.factor(order), value, exact=False)
        by_series = q.define(balance_ids.series(order), short_series(order, λ))
        # Of five figures each no error would be left.
        q.give(balance_ids.series_error(order), q.si(by_series) / value - 1, exact=False)
        A[order] = exact
    _, to_and_fro = point_masses(first)
    m = q.define(balance_ids.TO_AND_FRO, to_and_fro)
    for order in ORDERS:
        ω, size = q["omega.1"], layout.mass * layout.crank * q.si("omega.1") ** 2
        product = m * r * ω**2 if order == 1 else m * r * ω**2 * _size(A[order], order)
        if len(layout.cylinders) > 1:
            stars = [_star(q, layout, order, sense) for sense in (("forward",) if layout.in_line else SENSES)]
            product = product * (stars[0] if len(stars) == 1 else total(stars) / 2)
        q.define(balance_ids.order_force(order), product, scale=size)
        if layout.in_line and len(layout.cylinders) > 1:
            _couple(q, layout, order)


def _size(factor: Expression, order: int) -> Expression:
    """Return |A_n|: the fourth order is negative."""
    return -factor if order == 4 else factor


def _angles(q: Calculation, layout: Engine, cylinder: EngineCylinder) -> tuple[Expression, Expression]:
    """Enter β and γ = ψ − β of a cylinder, both relative to those of the first."""
    first = layout.cylinders[0]
    parts: list[Expression] = []
    for name, value in (
        (balance_ids.bank, cylinder.bank - first.bank),
        (balance_ids.pin_from_bank, (cylinder.pin - cylinder.bank) - (first.pin - first.bank)),
    ):
        turned = float(np.angle(np.exp(1j * value)))
        id = name(cylinder.slider)
        if abs(turned) < SAME_ANGLE:
            parts.append(NOTHING)
        else:
            parts.append(q.find(id) or q.give(id, turned, exact=_whole(turned)))
    return parts[0], parts[1]


def _whole(angle: float) -> bool:
    """Return True if an angle (rad) is a whole number of hundredths of a degree."""
    hundredths = np.degrees(angle) * 100
    return bool(abs(hundredths - round(hundredths)) < 1e-7)


def _star(q: Calculation, layout: Engine, order: int, sense: str) -> Ref:
    """Return the size of the sum of the cylinders' unit vectors, from its components."""
    across: list[Expression] = []
    up: list[Expression] = []
    for cylinder in layout.cylinders:
        β, γ = _angles(q, layout, cylinder)
        turning = NOTHING if γ == NOTHING else (γ if order == 1 else Number(float(order)) * γ)
        angle = β if turning == NOTHING else plus(β, turning if SENSES[sense] > 0 else -turning)
        across.append(ONE if angle == NOTHING else cos(angle))
        if angle != NOTHING:
            up.append(sin(angle))
    x = q.define(balance_ids.star(order, sense, "x"), total(across), scale=1.0)
    if not up:
        return q.define(balance_ids.star_size(order, sense), x, scale=1.0)
    y = q.define(balance_ids.star(order, sense, "y"), total(up), scale=1.0)
    return q.define(balance_ids.star_size(order, sense), sqrt(x**2 + y**2), scale=1.0)


def _couple(q: Calculation, layout: Engine, order: int) -> None:
    """Enter the couple of an order over m r ω² A_n and the pitch of the cylinders, about the middle of the shaft."""
    middle = (len(layout.cylinders) - 1) / 2
    across: list[Expression] = []
    up: list[Expression] = []
    for number, cylinder in enumerate(layout.cylinders):
        place = Number(number - middle)
        _, γ = _angles(q, layout, cylinder)
        angle = NOTHING if γ == NOTHING else (γ if order == 1 else Number(float(order)) * γ)
        across.append(place if angle == NOTHING else place * cos(angle))
        if angle != NOTHING:
            up.append(place * sin(angle))
    x, y = total(across), total(up) if up else NOTHING
    size = sqrt(x**2 + y**2) if up else sqrt(x**2)
    q.define(balance_ids.couple(order), size, scale=1.0)
