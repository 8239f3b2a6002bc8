"""Named points of a link: their places, and their images by similarity or by the link's rotation."""

from __future__ import annotations

import cmath

from reportgen.ledger.kinematics.names import difference, image, segment_symbol
from reportgen.ledger.kinematics.rates import absolute
from reportgen.ledger.kinematics.sides import Side, Turn
from reportgen.ledger.kinematics.site import KINDS, NOWHERE, POLES, Body, Site, What
from reportgen.mechanism.structure import LinkPoint
from reportgen.notation.expressions import (
    Expression,
    Ref,
    Symbol,
    add,
    call,
    divide,
    multiply,
    power,
    subtract,
)
from reportgen.notation.symbols import on_plan

OFF_LINE = 1e-9
"""A point nearer to the line of a link's joints than this share of its distance lies on it."""


def points_of(site: Site, link: int) -> tuple[LinkPoint, ...]:
    """The named points of a link besides its joints."""
    return tuple(place for place in site.scheme.linkage.points if place.link == link)


def off_line(place: LinkPoint) -> bool:
    """Whether a point forms a triangle with its link's joints."""
    return abs(place.local.imag) > OFF_LINE * abs(place.local)


def place(site: Site, link: int, turn: Turn | None) -> None:
    """Enter the places of a link's points: on a rod by the ratio of lengths, else along the frame's axis."""
    body = site.bodies[link]
    for point in points_of(site, link):
        length = site.length(body.origin, point.name, abs(point.local))
        turned = cmath.exp(1j * cmath.phase(point.local)) if point.local else 1
        angle = site.plane(f"turn.{point.name}", turned)
        if turn is not None and not turn.measured:
            whole = f"l.{turn.rod}"
            reach: Expression = multiply(divide(length, whole), angle, f"rod.{link}")
            if off_line(point):
                site.length(turn.point, point.name, abs(point.local - float(site.b.value(whole)[0])))
        else:
            reach = multiply(length, angle, body.axis)
        site.b.construct(f"p.{point.name}", add(f"p.{body.origin}", reach))
        site.drawn(body.origin, point.name)


def images(site: Site, what: What, link: int, turn: Turn | None) -> None:
    """Enter velocities or accelerations of a link's points."""
    for point in points_of(site, link):
        if turn is not None:
            _similar(site, what, point, turn)
        elif site.bodies[link].spin is not None:
            _carried(site, what, point, site.bodies[link])
        else:
            _shifted(site, what, point, site.bodies[link])


def turn_of(link: int, sides: tuple[Side, Side]) -> Turn | None:
    """The side that a link turns on, None for one that slides."""
    return next((side for side in sides if isinstance(side, Turn) and side.link == link), None)


def _similar(site: Site, what: What, point: LinkPoint, turn: Turn) -> None:
    """The similarity theorem: the plan's figure is similar to the link's and turned alike."""
    base, tip, b = turn.base, turn.point, site.b
    first, last, new = image(base), image(tip), image(point.name)
    along = subtract(f"plan.{what}.{last}", site.image(what, base))
    ratio = divide(f"l.{base}{point.name}", f"l.{turn.rod}")
    angle = f"turn.{point.name}"
    if turn.measured:
        angle = f"similar.{point.name}"
        if angle not in b:
            axis = multiply(f"turn.{point.name}", site.bodies[point.link].axis)
            b.construct(angle, divide(multiply(axis, f"l.{turn.rod}"), f"rod.{point.link}"))
    b.construct(f"plan.{what}.{new}", add(site.image(what, base), multiply(ratio, angle, along)))
    from_base = "p" if turn.still else first
    whole = f"seg.{what}.{from_base}{last}"
    letters = site.letter(what, base), on_plan(tip, what == "a")
    if whole not in b:
        site.segment(whole, *letters, along, what)
    target = on_plan(point.name, what == "a")
    b.define(f"seg.{what}.{from_base}{new}", segment_symbol(letters[0], target), "segment", multiply(ratio, whole))
    if off_line(point) and not turn.measured:
        other = divide(f"l.{tip}{point.name}", f"l.{turn.rod}")
        b.define(f"seg.{what}.{last}{new}", segment_symbol(letters[1], target), "segment", multiply(other, whole))
    absolute(site, what, point.name)


def _carried(site: Site, what: What, point: LinkPoint, body: Body) -> None:
    """v_E = v_O + ω l_OE, a_E = a_O + ω² l_OE + ε l_OE, as the link turns about its origin."""
    name, link = point.name, point.link
    length, relative = f"l.{body.origin}{name}", difference(name, body.origin)
    size = site.sizes.of(what)
    parts: list[tuple[str, str, Expression]] = []
    if what == "v":
        parts.append(("", "", multiply(f"omega.{link}", length)))
    else:
        parts.append((".n", "n", multiply(power(f"omega.{link}", 2), length)))
        if body.swing is not None:
            parts.append((".t", "τ", multiply(f"eps.{link}", length)))
    if point.local:
        for suffix, sup, formula in parts:
            site.b.define(f"{what}.{relative}{suffix}", Symbol(what, relative, sup), KINDS[what], formula, scale=size)
    arm = subtract(f"p.{name}", f"p.{body.origin}")
    site.b.construct(f"plan.{what}.{image(name)}", site.carried(what, link, arm))
    absolute(site, what, name)


def _shifted(site: Site, what: What, point: LinkPoint, body: Body) -> None:
    """A link that does not turn moves alike in all its points."""
    new = image(point.name)
    site.b.construct(f"plan.{what}.{new}", add(site.image(what, body.origin)))
    target, along = on_plan(point.name, what == "a"), call("abs", f"plan.{what}.{new}")
    site.segment(f"seg.{what}.p{new}", POLES[what], target, along, what)
    alike = NOWHERE if site.scheme.still(body.origin) else Ref(f"{what}.{body.origin}")
    size = site.sizes.of(what)
    site.b.define(f"{what}.{point.name}", Symbol(what, point.name), KINDS[what], alike, scale=size)
    heading = call("heading", f"plan.{what}.{new}")
    site.b.define(f"dir.{what}.{point.name}", Symbol("α", f"{what}{point.name}"), "angle", heading, scale=1.0)
