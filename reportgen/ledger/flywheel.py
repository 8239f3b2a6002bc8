"""The flywheel's quantities: what a report derives it from, position by position and over the cycle.

Ids: `J.r` reduced inertia (only where a moving link has mass; `J.r.2` a link's part of it), `M.r` reduced torque,
`A.excess` excess work, `omega.of` the regulated speed at each position; `M.c` the constant torque, `omega.max`,
`omega.min`, `A.upper`, `A.lower`, and `J.d` the flywheel.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.cycle.flywheel import Flywheel
from reportgen.ledger.core import Builder
from reportgen.mechanism.structure import Linkage
from reportgen.notation.expressions import (
    Expression,
    Symbol,
    add,
    divide,
    multiply,
    power,
    subtract,
)

TERMS = 4
"""More terms than these are no longer one line of a page."""


def describe(b: Builder, linkage: Linkage, flywheel: Flywheel, positions: np.ndarray) -> None:
    """Enter the flywheel of a machine whose positions are the cycle angles `positions`; δ is `unevenness`."""
    at = np.searchsorted(flywheel.angle, positions - 1e-9)
    inertia = _reduced(b, linkage)
    if inertia is not None:
        b.define("J.r", Symbol("J", "r"), "moment of inertia", inertia)
    size = _size(flywheel.torque)
    b.give("M.r", Symbol("M", "r"), "torque", flywheel.torque[at], exact=False, scale=size)
    b.give("M.c", Symbol("M", "c"), "torque", flywheel.constant, exact=False, scale=size)
    b.give("A.excess", Symbol("A"), "work", flywheel.work[at], exact=False, scale=_size(flywheel.work))
    half = divide("unevenness", 2)
    b.define("omega.max", Symbol("ω", "max"), "angular velocity", multiply("omega.1", add(1, half)))
    b.define("omega.min", Symbol("ω", "min"), "angular velocity", multiply("omega.1", subtract(1, half)))
    b.give("A.upper", Symbol("a"), "work", flywheel.upper, exact=False)
    b.give("A.lower", Symbol("b"), "work", flywheel.lower, exact=False)
    b.define(
        "J.d",
        Symbol("J", "d"),
        "moment of inertia",
        divide(subtract("A.upper", "A.lower"), multiply("unevenness", power("omega.1", 2))),
    )
    if flywheel.moment > 0:
        b.give("omega.of", Symbol("ω"), "angular velocity", flywheel.speed[at], exact=False)


def _reduced(b: Builder, linkage: Linkage) -> Expression | None:
    """J_r = Σ m v_S²/ω₁² + J ω²/ω₁² over the links that move so; None where no link with mass moves.

    Where that is too long for a line, each link's part of it is entered as `J.r.` and its number.
    """
    parts: dict[int, list[Expression]] = {}
    for body in linkage.inertias:
        own: list[Expression] = []
        if body.mass > 0 and f"v.{body.centre}" in b:
            own.append(multiply(f"m.{body.link}", power(f"v.{body.centre}", 2)))
        if body.moment > 0 and f"omega.{body.link}" in b:
            own.append(multiply(f"J.{body.link}", power(f"omega.{body.link}", 2)))
        if own:
            parts[body.link] = own
    terms = [term for own in parts.values() for term in own]
    if not terms:
        return None
    if len(terms) <= TERMS or len(parts) == 1:
        return _over_square(terms)
    for link, own in parts.items():
        b.define(f"J.r.{link}", Symbol("J", f"r{link}"), "moment of inertia", _over_square(own))
    return add(*(f"J.r.{link}" for link in parts))


def _over_square(terms: Sequence[Expression]) -> Expression:
    """The sum of the terms over ω₁²."""
    return divide(add(*terms) if len(terms) > 1 else terms[0], power("omega.1", 2))


def _size(values: np.ndarray) -> float:
    return float(np.abs(values).max())
