"""Instant centres of velocity, and what they and the projections on a link say of its motion.

For each link k with two moving points B (its base) and C: `ic.k` the centre P, where the normals to both
velocities meet; `ic.seg.k.B`, `ic.seg.k.C` its distances as drawn, nan where they are too short or too long to
measure; `ic.omega.k` = v_B/(μ_l·PB), `ic.v.k` = v_B·PC/PB; `ic.angle.k.B`, `ic.angle.k.C` the angles between
the velocities and BC, `ic.along.k.B` = v_B cos ψ_B, `ic.along.k.C` = v_C cos ψ_C.
"""

from __future__ import annotations

from reportgen.ledger.kinematics.linkage import Kinematics
from reportgen.ledger.kinematics.sides import Scheme, Side, image, sides
from reportgen.mechanism.structure import DRIVER, Crank
from reportgen.notation.expressions import Expression, Symbol, arg, call, cos, meet, quotient, turned
from reportgen.notation.vocabulary import point, segment

PREFIX = "ic."
NEAREST, FARTHEST = 0.002, 0.3
"""Distances from a centre (m on paper) that are measured: a shorter one has no exact length, a longer one no sheet."""


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
    centre, μ_l = q.construct(f"ic.{link}", meet(*normals)), q["mu.l"]

    def distance(name: str, nearest: float) -> Expression:
        within = call("within", abs(k.place(name) - centre) / q["drawing"], nearest, FARTHEST)
        return q.define(f"ic.seg.{link}.{name}", within, segment(centre_symbol(link), point(name)), scale=k.span())

    PB, PC, v = distance(base, NEAREST), distance(end, 0.0), q[f"v.{base}"]
    q.define(f"ic.omega.{link}", v / (μ_l * PB), scale=sizes.rotation)
    q.define(f"ic.v.{link}", v * (PC / PB), Symbol("v", end), scale=sizes.velocity)
    for name in (base, end):
        to_link = abs(arg(quotient(k.image("v", name), q[f"rod.{link}"])))
        q.define(f"ic.angle.{link}.{name}", to_link, scale=1.0)
    for name in (base, end):
        along = q[f"v.{name}"] * cos(q[f"ic.angle.{link}.{name}"])
        q.define(f"ic.along.{link}.{name}", along, scale=sizes.velocity)


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
        elif side.point == name or (side.carrier is not None and side.along == f"guide.{owner}"):
            return turned(k.q[side.along])
    return turned(k.q[f"plan.v.{image(name)}"])
