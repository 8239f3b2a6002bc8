"""Where a group's links lie, kind by kind, and the order in which a group is entered."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Mapping

from reportgen.ledger.kinematics import points, rates
from reportgen.ledger.kinematics.linkage import Kinematics, What
from reportgen.ledger.kinematics.sides import Side, image, sides, under
from reportgen.mechanism.structure import Dyad, DyadKind, Guide
from reportgen.notation.constructions import circle_circle, circle_line, meet, turned
from reportgen.notation.expressions import Expression, Ref, call, sqrt
from reportgen.notation.symbols import drawn_length


def group(k: Kinematics, dyad: Dyad) -> None:
    """Enter a group: its places, velocities, accelerations, and those of its links' points."""
    both = sides(k.scheme, dyad)
    PLACES[dyad.kind](k, dyad)
    turns = {link: points.turn_of(link, both) for link in dyad.links}
    for link, turn in turns.items():
        points.places(k, link, turn)
    _motion(k, dyad, "v", turns, lambda: rates.velocity(k, *both))
    _motion(k, dyad, "a", turns, lambda: rates.acceleration(k, *both))


def _motion(
    k: Kinematics, dyad: Dyad, what: What, turns: Mapping[int, Side | None], solve: Callable[[], None]
) -> None:
    solve()
    for link in dyad.links:
        k.share_rotation(what, link)
    if dyad.kind == "RPP":
        _middle_of_rpp(k, dyad, what)
    for link, turn in turns.items():
        points.images(k, what, link, turn)


def _pin(end: str | Guide) -> str:
    assert isinstance(end, str)
    return end


def _guide(end: str | Guide) -> Guide:
    assert isinstance(end, Guide)
    return end


def _rod(k: Kinematics, link: int, start: str, middle: str, length: Ref) -> None:
    """A rod of fixed length from an outer joint to the inner one; its unit axis, if it carries a guide."""
    rod = k.q.construct(f"rod.{link}", k.place(middle) - k.place(start))
    k.drawn(start, middle)
    ends = (end for dyad in k.scheme.linkage.dyads for end in (dyad.start, dyad.end))
    carries = any(isinstance(end, Guide) and end.link == link for end in ends)
    k.put(link, start, k.q.construct(f"axis.{link}", rod / length) if carries else None, middle)


def _rrr(k: Kinematics, dyad: Dyad) -> None:
    start, end, middle = _pin(dyad.start), _pin(dyad.end), dyad.middle
    first = k.length(start, middle, dyad.lengths[0])
    second = k.length(end, middle, dyad.lengths[1])
    k.q.construct(f"p.{middle}", circle_circle(k.place(start), first, k.place(end), second, float(dyad.sign)))
    _rod(k, dyad.links[0], start, middle, first)
    _rod(k, dyad.links[1], end, middle, second)


def _rrp(k: Kinematics, dyad: Dyad) -> None:
    start, middle = _pin(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = k.guide(j, _guide(dyad.end))
    length = k.length(start, middle, dyad.lengths[0])
    k.q.construct(f"p.{middle}", circle_line(k.place(start), length, at, along, float(dyad.sign)))
    _rod(k, i, start, middle, length)
    k.put(j, middle, along)


def _rpr(k: Kinematics, dyad: Dyad) -> None:
    """The slot's line is a tangent from P to the circle of radius e about T: u = TP/(s + i e)."""
    start, end, middle = _pin(dyad.start), _pin(dyad.end), dyad.middle
    i, j = dyad.links
    q, offset, mu = k.q, dyad.lengths[1], k.q["mu.l"]
    q.construct(f"p.{middle}", k.place(start))
    rod = q.construct(f"rod.{j}", k.place(start) - k.place(end))
    drawn = q.define(f"drawn.{end}{middle}", abs(rod) / mu, drawn_length(end, middle), scale=k.span())
    q.define(f"l.{end}{middle}", mu * drawn)
    along: Expression = float(dyad.sign) * abs(rod)
    if offset:
        e = k.length(end, f"H{j}", abs(offset))
        reach = sqrt(call("max", 0.0, abs(rod) ** 2 - e**2))
        along = float(dyad.sign) * reach + (1.0 if offset > 0 else -1.0) * turned(e)
    slot = q.construct(f"slot.{j}", rod / along)
    k.put(i, start, slot)
    k.put(j, end, slot, middle)


def _prp(k: Kinematics, dyad: Dyad) -> None:
    (at1, along1), (at2, along2) = (
        k.guide(link, _guide(end)) for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
    )
    k.q.construct(f"p.{dyad.middle}", meet(at1, along1, at2, along2))
    for link, along in zip(dyad.links, (along1, along2), strict=True):
        k.put(link, dyad.middle, along)


def _rpp(k: Kinematics, dyad: Dyad) -> None:
    start, middle = _pin(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = k.guide(j, _guide(dyad.end))
    slot = k.q.construct(f"slot.{j}", along * k.constant(f"slot.{j}.local", cmath.exp(1j * dyad.slide_angle)))
    k.q.construct(f"p.{middle}", meet(at, along, k.place(start), slot))
    k.q.construct(f"p.{under(start, j, k.scheme.owner)}", k.place(start))
    k.put(i, start, along)
    k.put(j, middle, along)


def _middle_of_rpp(k: Kinematics, dyad: Dyad, what: What) -> None:
    """The guided point Q of link j, from the point of j under P: they differ by j's rotation only."""
    middle, (_, j) = dyad.middle, dyad.links
    known = under(_pin(dyad.start), j, k.scheme.owner)
    arm = k.place(middle) - k.place(known)
    placed = k.links[j]
    k.put(j, known, placed.axis)
    k.vertex(what, image(middle), k.image_at(what, j, arm))
    k.links[j] = placed
    k.absolute(what, middle)


PLACES: Mapping[DyadKind, Callable[[Kinematics, Dyad], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
