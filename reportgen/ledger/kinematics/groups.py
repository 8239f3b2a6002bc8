"""Where a group's links lie, kind by kind, and the order in which a group is entered."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Mapping

from reportgen.ledger.kinematics import points, rates
from reportgen.ledger.kinematics.names import image, length_symbol, under
from reportgen.ledger.kinematics.sides import Turn, sides
from reportgen.ledger.kinematics.site import Site, What
from reportgen.mechanism.structure import Dyad, DyadKind, Guide
from reportgen.notation.expressions import (
    Root,
    Symbol,
    add,
    call,
    divide,
    multiply,
    power,
    subtract,
)


def group(site: Site, dyad: Dyad) -> None:
    """Enter a group: its places, velocities, accelerations, and those of its links' points."""
    both = sides(site.scheme, dyad)
    PLACES[dyad.kind](site, dyad)
    turns = {link: points.turn_of(link, both) for link in dyad.links}
    for link, turn in turns.items():
        points.place(site, link, turn)
    _motion(site, dyad, "v", turns, lambda: rates.velocity(site, *both))
    _motion(site, dyad, "a", turns, lambda: rates.acceleration(site, *both))


def _motion(
    site: Site, dyad: Dyad, what: What, turns: Mapping[int, Turn | None], solve: Callable[[], None]
) -> None:
    solve()
    for link in dyad.links:
        site.share_rotation(what, link)
    if dyad.kind == "RPP":
        _middle_of_rpp(site, dyad, what)
    for link, turn in turns.items():
        points.images(site, what, link, turn)


def _outer(end: str | Guide) -> str:
    assert isinstance(end, str)
    return end


def _rail(end: str | Guide) -> Guide:
    assert isinstance(end, Guide)
    return end


def _rod(site: Site, link: int, start: str, middle: str, length: float) -> None:
    """A rod of fixed length from an outer joint to the inner one."""
    site.length(start, middle, length)
    site.b.construct(f"rod.{link}", subtract(f"p.{middle}", f"p.{start}"))
    site.drawn(start, middle)
    site.body(link, start, f"axis.{link}", middle)


def _axis(site: Site, link: int, length: str) -> None:
    """The unit vector along a rod, for what is carried by it."""
    ends = (end for dyad in site.scheme.linkage.dyads for end in (dyad.start, dyad.end))
    if any(isinstance(end, Guide) and end.link == link for end in ends):
        site.b.construct(f"axis.{link}", divide(f"rod.{link}", length))


def _rrr(site: Site, dyad: Dyad) -> None:
    start, end, q = _outer(dyad.start), _outer(dyad.end), dyad.middle
    first = site.length(start, q, dyad.lengths[0])
    second = site.length(end, q, dyad.lengths[1])
    site.b.construct(
        f"p.{q}", call("circle_circle", f"p.{start}", first, f"p.{end}", second, float(dyad.sign))
    )
    for link, outer, length in zip(dyad.links, (start, end), dyad.lengths, strict=True):
        _rod(site, link, outer, q, length)
        _axis(site, link, f"l.{outer}{q}")


def _rrp(site: Site, dyad: Dyad) -> None:
    start, q = _outer(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = site.guide(j, _rail(dyad.end))
    length = site.length(start, q, dyad.lengths[0])
    site.b.construct(f"p.{q}", call("circle_line", f"p.{start}", length, at, along, float(dyad.sign)))
    _rod(site, i, start, q, dyad.lengths[0])
    _axis(site, i, length)
    site.body(j, q, along)


def _rpr(site: Site, dyad: Dyad) -> None:
    """The slot's line is a tangent from P to the circle of radius e about T: u = TP/(s + i e)."""
    start, end, q = _outer(dyad.start), _outer(dyad.end), dyad.middle
    i, j = dyad.links
    b, rod, offset = site.b, f"rod.{j}", dyad.lengths[1]
    b.construct(f"p.{q}", add(f"p.{start}"))
    b.construct(rod, subtract(f"p.{start}", f"p.{end}"))
    b.define(
        f"drawn.{end}{q}", length_symbol(end, q), "segment", divide(call("abs", rod), "mu.l"), scale=site.span()
    )
    b.define(f"l.{end}{q}", Symbol("l", f"{end}{q}"), "length", multiply("mu.l", f"drawn.{end}{q}"))
    reach = call("abs", rod)
    if offset:
        e = site.length(end, f"H{j}", abs(offset))
        under_root = subtract(power(reach, 2), power(e, 2))
        along = add(
            multiply(float(dyad.sign), Root(call("max", 0.0, under_root))),
            multiply(1.0 if offset > 0 else -1.0, call("turned", e)),
        )
    else:
        along = multiply(float(dyad.sign), reach)
    b.construct(f"slot.{j}", divide(rod, along))
    site.body(i, start, f"slot.{j}")
    site.body(j, end, f"slot.{j}", q)


def _prp(site: Site, dyad: Dyad) -> None:
    first, second = (
        site.guide(link, _rail(end)) for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
    )
    site.b.construct(f"p.{dyad.middle}", call("meet", *first, *second))
    for link, (_, along) in zip(dyad.links, (first, second), strict=True):
        site.body(link, dyad.middle, along)


def _rpp(site: Site, dyad: Dyad) -> None:
    start, q = _outer(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = site.guide(j, _rail(dyad.end))
    slope = site.plane(f"slot.{j}.local", cmath.exp(1j * dyad.slide_angle))
    site.b.construct(f"slot.{j}", multiply(along, slope))
    site.b.construct(f"p.{q}", call("meet", at, along, f"p.{start}", f"slot.{j}"))
    site.b.construct(f"p.{under(start, j, site.scheme.owner)}", add(f"p.{start}"))
    site.body(i, start, along)
    site.body(j, q, along)


def _middle_of_rpp(site: Site, dyad: Dyad, what: What) -> None:
    """The guided point Q of link j, from the point of j under P: they differ by j's rotation only."""
    q, (_, j) = dyad.middle, dyad.links
    known = under(_outer(dyad.start), j, site.scheme.owner)
    arm = subtract(f"p.{q}", f"p.{known}")
    body = site.bodies[j]
    site.body(j, known, body.axis)
    site.b.construct(f"plan.{what}.{image(q)}", site.carried(what, j, arm))
    site.bodies[j] = body
    rates.absolute(site, what, q)


PLACES: Mapping[DyadKind, Callable[[Site, Dyad], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
