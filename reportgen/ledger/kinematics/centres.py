"""Instant centres of velocity, and what they and the projections on a link say of its motion.

For each link k with two moving points B (its base) and C: `ic.k` the centre P, where the normals to both
velocities meet; `ic.seg.k.B`, `ic.seg.k.C` its distances as drawn, nan where they are too short or too long to
measure; `ic.omega.k` = v_B/(μ_l·PB), `ic.v.k` = v_B·PC/PB; `ic.angle.k.B`, `ic.angle.k.C` the angles between
the velocities and BC, `ic.along.k.B` = v_B cos ψ_B, `ic.along.k.C` = v_C cos ψ_C.
"""

from __future__ import annotations

from reportgen.ledger.kinematics.names import image, segment_symbol
from reportgen.ledger.kinematics.sides import Scheme, Turn, sides
from reportgen.ledger.kinematics.site import Site
from reportgen.mechanism.structure import DRIVER, Crank
from reportgen.notation.expressions import Expression, Symbol, call, divide, multiply, subtract
from reportgen.notation.symbols import point

PREFIX = "ic."
NEAREST, FARTHEST = 0.002, 0.3
"""Distances from a centre (m on paper) that are measured: a shorter one has no exact length, a longer one no sheet."""


def centred(scheme: Scheme) -> tuple[Turn, ...]:
    """The links in plane motion with two points whose velocities are drawn, each as one point turning about another."""
    both = (side for dyad in scheme.linkage.dyads for side in sides(scheme, dyad))
    return tuple(side for side in both if isinstance(side, Turn) and not side.still)


def centre_symbol(link: int) -> Symbol:
    """P with the link's number."""
    return Symbol("P", str(link))


def describe(site: Site) -> None:
    """Enter the centres of all links in plane motion and the checks by them."""
    for turn in centred(site.scheme):
        _check(site, turn)


def _check(site: Site, turn: Turn) -> None:
    b, link, base, end = site.b, turn.link, turn.base, turn.point
    centre = f"{PREFIX}{link}"
    b.construct(centre, call("meet", f"p.{base}", _normal(site, base), f"p.{end}", _normal(site, end)))
    for name, nearest in ((base, NEAREST), (end, 0.0)):
        drawn = divide(call("abs", subtract(f"p.{name}", centre)), "mu.l")
        b.define(
            f"{PREFIX}seg.{link}.{name}",
            segment_symbol(centre_symbol(link), point(name)),
            "segment",
            call("within", drawn, nearest, FARTHEST),
            scale=site.span(),
        )
    by_centre = divide(f"v.{base}", multiply("mu.l", f"{PREFIX}seg.{link}.{base}"))
    b.define(
        f"{PREFIX}omega.{link}",
        Symbol("ω", str(link)),
        "angular velocity",
        by_centre,
        scale=site.sizes.rotation,
    )
    size = site.sizes.velocity
    in_proportion = multiply(f"v.{base}", divide(f"{PREFIX}seg.{link}.{end}", f"{PREFIX}seg.{link}.{base}"))
    b.define(f"{PREFIX}v.{link}", Symbol("v", end), "velocity", in_proportion, scale=size)
    for name in (base, end):
        angle = f"{PREFIX}angle.{link}.{name}"
        to_link = call("abs", call("arg", call("quotient", site.image("v", name), f"rod.{link}")))
        b.define(angle, Symbol("ψ", name), "angle", to_link, scale=1.0)
    for name in (base, end):
        along = multiply(f"v.{name}", call("cos", f"{PREFIX}angle.{link}.{name}"))
        b.define(f"{PREFIX}along.{link}.{name}", Symbol("u", name), "velocity", along, scale=size)


def _normal(site: Site, name: str) -> Expression:
    """A direction square to a point's velocity: by what leads it, so also where it stands still, else by the plan."""
    scheme, driver = site.scheme, site.scheme.linkage.driver
    owner = scheme.owner.get(name)
    if owner == DRIVER:
        if isinstance(driver, Crank):
            return subtract(f"p.{name}", f"p.{driver.centre}")
        return call("turned", "guide.1")
    for side in (side for dyad in scheme.linkage.dyads for side in sides(scheme, dyad) if side.still):
        if isinstance(side, Turn):
            if side.point == name or side.link == owner:
                return subtract(f"p.{name}", f"p.{side.base}")
        elif side.point == name or (side.guided and side.along == f"guide.{owner}"):
            return call("turned", side.along)
    return call("turned", f"plan.v.{image(name)}")
