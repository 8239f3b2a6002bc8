"""The flywheel's quantities: what a report derives it from, position by position and over the cycle.

Ids: `J.r` reduced inertia (only where a moving link has mass; `J.r.2` a link's part of it), `M.r` reduced torque,
`A.excess` excess work, `omega.of` the regulated speed at each position; `M.c` the constant torque, `omega.max`,
`omega.min`, `A.upper`, `A.lower`, and `J.d` the flywheel.
"""

from __future__ import annotations

import numpy as np

from reportgen.cycle.flywheel import Flywheel
from reportgen.mechanism.structure import Linkage
from reportgen.notation.expressions import Expression, Symbol, total
from reportgen.notation.sheet import Sheet

TERMS = 4
"""More terms than these are no longer one line of a page."""


def enter_flywheel(q: Sheet, linkage: Linkage, flywheel: Flywheel, positions: np.ndarray) -> None:
    """Enter the flywheel of a machine whose positions are the cycle angles `positions`; δ is `unevenness`."""
    at = np.searchsorted(flywheel.angle, positions - 1e-9)
    inertia = _reduced(q, linkage)
    if inertia is not None:
        q.define("J.r", inertia)
    largest, δ, ω1 = float(np.abs(flywheel.torque).max()), q["unevenness"], q["omega.1"]
    q.give("M.r", flywheel.torque[at], exact=False, scale=largest)
    q.give("M.c", flywheel.constant, exact=False, scale=largest)
    most = float(np.abs(flywheel.work).max())
    q.give("A.excess", flywheel.work[at], "A", "work", exact=False, scale=most)
    q.define("omega.max", ω1 * (1 + δ / 2))
    q.define("omega.min", ω1 * (1 - δ / 2))
    a = q.give("A.upper", flywheel.upper, "a", "work", exact=False)
    b = q.give("A.lower", flywheel.lower, "b", "work", exact=False)
    q.define("J.d", (a - b) / (δ * ω1**2))
    if flywheel.moment > 0:
        q.give("omega.of", flywheel.speed[at], "ω", exact=False)


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
    each = [
        q.define(f"J.r.{link}", total(own) / ω1**2, Symbol("J", f"r{link}")) for link, own in parts.items()
    ]
    return total(each)
