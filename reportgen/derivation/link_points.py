"""Ledger entries for rods and for the named points of a link besides its joints: their places, velocities and
accelerations.
"""

from __future__ import annotations

import cmath

from reportgen.derivation.equation_sides import Side, image
from reportgen.derivation.kinematic_entries import NOWHERE, POLES, Kinematics, PlacedLink, What
from reportgen.formula import Expression, Symbol, ids, quotient, unit
from reportgen.formula.vocabulary import on_plan, segment
from reportgen.machine import Guide, LinkPoint

OFF_LINE = 1e-9
"""A point counts as on the line of a link's joints if its distance from the line is below this share of its distance
from the origin.
"""


def _points(k: Kinematics, link: int) -> tuple[LinkPoint, ...]:
    """Return the named points of a link besides its joints."""
    return tuple(place for place in k.scheme.linkage.points if place.link == link)


def _off_line(point: LinkPoint) -> bool:
    """Return True if a point forms a triangle with its link's joints."""
    return abs(point.local.imag) > OFF_LINE * abs(point.local)


def enter_rod(k: Kinematics, link: int, start: str, middle: str) -> None:
    """Enter a rod of fixed length from an outer joint to the inner one; its unit axis, if it carries a guide."""
    rod = k.q.construct(ids.rod(link), k.place(middle) - k.place(start))
    ends = (end for dyad in k.scheme.linkage.dyads for end in (dyad.start, dyad.end))
    carries = any(isinstance(end, Guide) and end.link == link for end in ends)
    k.put(link, start, k.q.construct(ids.link_axis(link), unit(rod)) if carries else None, middle)


def places(k: Kinematics, link: int, turn: Side | None) -> None:
    """Enter the places of a link's named points besides its joints.

    On a rod their axis is the line of the rod, otherwise the axis of the link's frame; `turn` is the side that the link
    turns on, None for a link that slides.
    """
    q, placed = k.q, k.links[link]
    for point in _points(k, link):
        x, y = point.local.real, point.local.imag
        k.distance(placed.origin, point.name, x, y)
        angle = k.constant(ids.point_turn(point.name), cmath.exp(1j * cmath.phase(point.local)) if point.local else 1)
        if turn is not None and not turn.measured:
            if _off_line(point):
                k.distance(turn.point, point.name, x, y, q[ids.length(turn.rod)])
            axis: Expression = unit(q[ids.rod(link)])
        else:
            axis = k.axis(link)
        length = k.drawn(placed.origin, point.name)
        q.construct(ids.place(point.name), k.place(placed.origin) + length * angle * axis)


def images(k: Kinematics, what: What, link: int, turn: Side | None) -> None:
    """Enter velocities or accelerations of a link's named points besides its joints.

    They follow by similarity if the link turns on a side (`turn`), otherwise from its rotation, or are those of its
    origin if it does not rotate.
    """
    placed = k.links[link]
    for point in _points(k, link):
        if turn is not None:
            _by_similarity(k, what, point, turn)
        elif placed.omega is not None:
            _by_rotation(k, what, point, placed)
        else:
            _by_translation(k, what, point, placed)


def _by_similarity(k: Kinematics, what: What, point: LinkPoint, turn: Side) -> None:
    """Enter a point by the similarity theorem: the figure in the plan is similar to that of the link, with the same
    sense.
    """
    q, base, tip = k.q, turn.base, turn.point
    first, last, new = "p" if turn.still else image(base), image(tip), image(point.name)
    along = k.image(what, tip) - k.image(what, base)
    ratio = q[ids.length(base, point.name)] / q[ids.length(turn.rod)]
    angle = q[ids.point_turn(point.name)]
    if turn.measured:
        id = ids.similar(point.name)
        if id not in q:
            q.construct(id, angle * quotient(k.axis(point.link), unit(q[ids.rod(point.link)])))
        angle = q[id]
    whole = ids.segment(what, first, last)
    letters = k.letter(what, base), on_plan(tip, what == "a")
    if whole not in q:
        k.segment(whole, *letters, along, what)
    target = on_plan(point.name, what == "a")
    part = q.define(ids.segment(what, first, new), ratio * q[whole], segment(letters[0], target))
    laid = q.construct(ids.laid(what, f"{first}{new}"), ratio * angle * along, of=part.id)
    k.vertex(what, new, k.image(what, base) + laid)
    if _off_line(point) and not turn.measured:
        leg_ratio = q[ids.length(tip, point.name)] / q[ids.length(turn.rod)]
        q.define(ids.segment(what, last, new), leg_ratio * q[whole], segment(letters[1], target))
    k.absolute(what, point.name)


def _by_rotation(k: Kinematics, what: What, point: LinkPoint, placed: PlacedLink) -> None:
    """Enter v_E = v_O + ω l_OE, a_E = a_O + ω² l_OE + ε l_OE, as the link turns about its origin."""
    q, name, link = k.q, point.name, point.link
    length, relative = q[ids.length(placed.origin, name)], f"{name}{placed.origin}"
    if point.local:
        omega, size = q[ids.angular_velocity(link)], k.sizes.of(what)
        if what == "v":
            q.define(ids.velocity(relative), omega * length, scale=size)
        else:
            q.define(ids.acceleration(relative, "n"), omega**2 * length, scale=size)
            if placed.eps is not None:
                q.define(ids.acceleration(relative, "t"), q[ids.angular_acceleration(link)] * length, scale=size)
    arm = k.place(name) - k.place(placed.origin)
    k.vertex(what, image(name), k.image_at(what, link, arm))
    k.absolute(what, name)


def _by_translation(k: Kinematics, what: What, point: LinkPoint, placed: PlacedLink) -> None:
    """Enter a point of a link that does not turn: all its points have one velocity and one acceleration."""
    q, name = k.q, point.name
    plan = k.vertex(what, image(name), k.image(what, placed.origin))
    k.segment(ids.segment(what, "p", image(name)), Symbol(POLES[what]), on_plan(name, what == "a"), abs(plan), what)
    rate = ids.POINT_RATE[what]
    same = NOWHERE if k.scheme.still(placed.origin) else q[rate(placed.origin)]
    q.define(rate(name), same, scale=k.sizes.of(what))
    k.direction(what, name)
