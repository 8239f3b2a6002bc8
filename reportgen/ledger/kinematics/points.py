"""Named points of a link: their places, and their images by similarity or by the link's rotation."""

from __future__ import annotations

import cmath

from reportgen.ledger.kinematics.linkage import NOWHERE, POLES, Kinematics, PlacedLink, What
from reportgen.ledger.kinematics.sides import Side, image
from reportgen.mechanism.structure import LinkPoint
from reportgen.notation.expressions import Expression, Symbol
from reportgen.notation.symbols import on_plan, segment

OFF_LINE = 1e-9
"""A point nearer to the line of a link's joints than this share of its distance lies on it."""


def _points(k: Kinematics, link: int) -> tuple[LinkPoint, ...]:
    """The named points of a link besides its joints."""
    return tuple(place for place in k.scheme.linkage.points if place.link == link)


def _off_line(point: LinkPoint) -> bool:
    """Whether a point forms a triangle with its link's joints."""
    return abs(point.local.imag) > OFF_LINE * abs(point.local)


def turn_of(link: int, sides: tuple[Side, Side]) -> Side | None:
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
