"""Where a group's links lie, kind by kind, the order in which a group is entered, and the points of its links."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Mapping

from reportgen.ledger.kinematics import rates
from reportgen.ledger.kinematics.linkage import NOWHERE, POLES, Kinematics, PlacedLink, What
from reportgen.ledger.kinematics.sides import Side, image, sides, under
from reportgen.mechanism.structure import Dyad, DyadKind, Guide, LinkPoint
from reportgen.notation.expressions import (
    Expression,
    Ref,
    Symbol,
    call,
    circle_circle,
    circle_line,
    meet,
    sqrt,
    turned,
)
from reportgen.notation.symbols import drawn_length, on_plan, segment

OFF_LINE = 1e-9
"""A point nearer to the line of a link's joints than this share of its distance lies on it."""


def group(k: Kinematics, dyad: Dyad) -> None:
    """Enter a group: its places, velocities, accelerations, and those of its links' points."""
    both = sides(k.scheme, dyad)
    PLACES[dyad.kind](k, dyad)
    turns = {link: _turn_of(link, both) for link in dyad.links}
    for link, turn in turns.items():
        places(k, link, turn)
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
        images(k, what, link, turn)


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


# --- points of links --------------------------------------------------------------------------------


def _points(k: Kinematics, link: int) -> tuple[LinkPoint, ...]:
    """The named points of a link besides its joints."""
    return tuple(place for place in k.scheme.linkage.points if place.link == link)


def _off_line(point: LinkPoint) -> bool:
    """Whether a point forms a triangle with its link's joints."""
    return abs(point.local.imag) > OFF_LINE * abs(point.local)


def _turn_of(link: int, sides: tuple[Side, Side]) -> Side | None:
    """The side that a link turns on, None for one that slides."""
    return next((side for side in sides if side.turns and side.link == link), None)


def places(k: Kinematics, link: int, turn: Side | None) -> None:
    """Enter the places of a link's points: on a rod by the ratio of lengths, else along the frame's axis."""
    q, placed = k.q, k.links[link]
    for point in _points(k, link):
        length = k.length(placed.origin, point.name, abs(point.local))
        angle = k.constant(f"turn.{point.name}", cmath.exp(1j * cmath.phase(point.local)) if point.local else 1)
        if turn is not None and not turn.measured:
            whole = q[f"l.{turn.rod}"]
            reach: Expression = length / whole * angle * q[f"rod.{link}"]
            if _off_line(point):
                k.length(turn.point, point.name, abs(point.local - q.si(whole)))
        else:
            reach = length * angle * k.axis(link)
        q.construct(f"p.{point.name}", k.place(placed.origin) + reach)
        k.drawn(placed.origin, point.name)


def images(k: Kinematics, what: What, link: int, turn: Side | None) -> None:
    """Enter velocities or accelerations of a link's points."""
    placed = k.links[link]
    for point in _points(k, link):
        if turn is not None:
            _by_similarity(k, what, point, turn)
        elif placed.omega is not None:
            _by_rotation(k, what, point, placed)
        else:
            _by_translation(k, what, point, placed)


def _by_similarity(k: Kinematics, what: What, point: LinkPoint, turn: Side) -> None:
    """The similarity theorem: the plan's figure is similar to the link's and turned in the same way."""
    q, base, tip = k.q, turn.base, turn.point
    first, last, new = "p" if turn.still else image(base), image(tip), image(point.name)
    along = k.image(what, tip) - k.image(what, base)
    ratio = q[f"l.{base}{point.name}"] / q[f"l.{turn.rod}"]
    angle = q[f"turn.{point.name}"]
    if turn.measured:
        id = f"similar.{point.name}"
        if id not in q:
            q.construct(id, angle * k.axis(point.link) * q[f"l.{turn.rod}"] / q[f"rod.{point.link}"])
        angle = q[id]
    k.vertex(what, new, k.image(what, base) + ratio * angle * along)
    whole = f"seg.{what}.{first}{last}"
    letters = k.letter(what, base), on_plan(tip, what == "a")
    if whole not in q:
        k.segment(whole, *letters, along, what)
    target = on_plan(point.name, what == "a")
    q.define(f"seg.{what}.{first}{new}", ratio * q[whole], segment(letters[0], target))
    if _off_line(point) and not turn.measured:
        other = q[f"l.{tip}{point.name}"] / q[f"l.{turn.rod}"]
        q.define(f"seg.{what}.{last}{new}", other * q[whole], segment(letters[1], target))
    k.absolute(what, point.name)


def _by_rotation(k: Kinematics, what: What, point: LinkPoint, placed: PlacedLink) -> None:
    """v_E = v_O + ω l_OE, a_E = a_O + ω² l_OE + ε l_OE, as the link turns about its origin."""
    q, name, link = k.q, point.name, point.link
    length, relative = q[f"l.{placed.origin}{name}"], f"{name}{placed.origin}"
    if point.local:
        omega, size = q[f"omega.{link}"], k.sizes.of(what)
        if what == "v":
            q.define(f"v.{relative}", omega * length, scale=size)
        else:
            q.define(f"a.{relative}.n", omega**2 * length, scale=size)
            if placed.eps is not None:
                q.define(f"a.{relative}.t", q[f"eps.{link}"] * length, scale=size)
    arm = k.place(name) - k.place(placed.origin)
    k.vertex(what, image(name), k.image_at(what, link, arm))
    k.absolute(what, name)


def _by_translation(k: Kinematics, what: What, point: LinkPoint, placed: PlacedLink) -> None:
    """All points of a link that does not turn have one velocity and one acceleration."""
    q, name = k.q, point.name
    plan = k.vertex(what, image(name), k.image(what, placed.origin))
    k.segment(f"seg.{what}.p{image(name)}", Symbol(POLES[what]), on_plan(name, what == "a"), abs(plan), what)
    same = NOWHERE if k.scheme.still(placed.origin) else q[f"{what}.{placed.origin}"]
    q.define(f"{what}.{name}", same, scale=k.sizes.of(what))
    k.direction(what, name)
