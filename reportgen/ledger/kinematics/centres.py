"""Instant centres of velocity, and what they and the projections on a link say of its motion.

For each link k with two moving points B (its base) and C: `ic.k` the centre P, where the normals to both
velocities meet; `ic.seg.k.B`, `ic.seg.k.C` its distances as drawn, nan where they are too short to measure or P
lies off every sheet that holds the mechanism; `ic.omega.k` = v_B/(μ_l·PB), `ic.v.k` = v_B·PC/PB; `ic.angle.k.B`,
`ic.angle.k.C` the angles between the velocities and BC, `ic.along.k.B` = v_B cos ψ_B, `ic.along.k.C` = v_C cos ψ_C.
"""

from __future__ import annotations

import numpy as np

from reportgen.ledger.kinematics.linkage import Kinematics
from reportgen.ledger.kinematics.sides import Scheme, Side, image, sides
from reportgen.ledger.scales import SHEET_BOXES, extents
from reportgen.mechanism.structure import DRIVER, Crank
from reportgen.notation import ids
from reportgen.notation.expressions import Expression, Symbol, arg, call, cos, meet, quotient, turned
from reportgen.notation.vocabulary import point, segment

NEAREST = 0.002
"""The shortest distance of a centre from the base (m on paper) that is measured: a shorter one has no exact length."""
FARTHEST = 0.4
"""No sheet holds a longer distance (m on paper)."""


def links_in_plane_motion(scheme: Scheme) -> tuple[Side, ...]:
    """The links with two points whose velocities are drawn, each as one point turning about another."""
    both = (side for dyad in scheme.linkage.dyads for side in sides(scheme, dyad))
    return tuple(side for side in both if side.turns and not side.still)


def centre_symbol(link: int) -> Symbol:
    """P with the link's number."""
    return Symbol("P", str(link))


def enter_centres(k: Kinematics) -> None:
    """Enter the centres of all links in plane motion and the checks by them."""
    for turn in links_in_plane_motion(k.scheme):
        _enter_centre(k, turn)


def _enter_centre(k: Kinematics, turn: Side) -> None:
    q, link, base, end, sizes = k.q, turn.link, turn.base, turn.point, k.sizes
    normals = k.place(base), _normal(k, base), k.place(end), _normal(k, end)
    centre, μ_l = q.construct(ids.centre(link), meet(*normals)), q["mu.l"]

    reach = q.give(ids.centre_reach(link), _reach(k, q.value(centre)), Symbol("reach"), "ratio", hidden=True)

    def distance(name: str, nearest: float) -> Expression:
        within = call("within", abs(k.place(name) - centre) / q["drawing"], nearest, reach)
        return q.define(
            ids.centre_distance(link, name), within, segment(centre_symbol(link), point(name)), scale=k.span()
        )

    PB, PC, v = distance(base, NEAREST), distance(end, 0.0), q[ids.velocity(base)]
    q.define(ids.centre_omega(link), v / (μ_l * PB), scale=sizes.rotation)
    q.define(ids.centre_velocity(link), v * (PC / PB), Symbol("v", end), scale=sizes.velocity)
    for name in (base, end):
        to_link = abs(arg(quotient(k.image("v", name), q[ids.rod(link)])))
        q.define(ids.rod_angle(link, name), to_link, scale=1.0)
    for name in (base, end):
        along = q[ids.velocity(name)] * cos(q[ids.rod_angle(link, name)])
        q.define(ids.projection(link, name), along, scale=sizes.velocity)


def _reach(k: Kinematics, centre: np.ndarray) -> np.ndarray:
    """How far a centre may lie (m on paper) at each position: 0 where no sheet holds it and the mechanism."""
    q = k.q
    points = [family.values for id, family in q.families.items() if id in ids.place]
    sizes = extents([*points, centre], q.positions) / q.si("mu.l")
    fits = [(sizes <= np.array(box)[:, None]).all(axis=0) for box in SHEET_BOXES]
    return np.where(np.any(fits, axis=0), FARTHEST, 0.0)


def _normal(k: Kinematics, name: str) -> Expression:
    """A direction square to a point's velocity: by what leads it, so also where it stands still, else by the plan."""
    scheme, driver = k.scheme, k.scheme.linkage.driver
    owner = scheme.owner.get(name)
    if owner == DRIVER:
        if isinstance(driver, Crank):
            return k.place(name) - k.place(driver.centre)
        return turned(k.q["guide.1"])
    for side in (side for dyad in scheme.linkage.dyads for side in sides(scheme, dyad) if side.still):
        if side.turns:
            if side.point == name or side.link == owner:
                return k.place(name) - k.place(side.base)
        elif side.point == name or (side.carrier is not None and side.along == ids.guide(owner)):
            return turned(k.q[side.along])
    return turned(k.q[ids.plan_point("v", image(name))])
