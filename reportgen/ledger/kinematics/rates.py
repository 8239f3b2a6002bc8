"""Velocities and accelerations of the point where the two sides of a group's equations meet."""

from __future__ import annotations

from reportgen.ledger.kinematics.names import image, segment_symbol
from reportgen.ledger.kinematics.sides import Side, Slide, Turn
from reportgen.ledger.kinematics.site import KINDS, NOWHERE, POLES, Site, What
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


def velocity(site: Site, one: Side, two: Side) -> None:
    """v_M = v_P + v_MP, each side with one unknown size along a known direction: two lines meet in m."""
    q = image(one.point)
    for side in (one, two):
        _guide_point(site, "v", side)
    site.b.construct(
        f"plan.v.{q}",
        call("meet", _start(site, "v", one), _across(one), _start(site, "v", two), _across(two)),
    )
    for side in (one, two):
        if not side.still:
            _relative_velocity(site, side)
    absolute(site, "v", one.point)
    for side in (one, two):
        if side.still:
            _from_rest(site, side)


def acceleration(site: Site, one: Side, two: Side) -> None:
    """a_M = a_P + aⁿ_MP + aᵗ_MP or a_G + aᵏ_MG + aʳ_MG: known vectors first, then two lines meet in m′."""
    q = image(one.point)
    for side in (one, two):
        _guide_point(site, "a", side)
    starts = [_known_acceleration(site, side) for side in (one, two)]
    site.b.construct(f"plan.a.{q}", call("meet", starts[0], _across(one), starts[1], _across(two)))
    alike = _known_part(one) == _known_part(two)
    for side, start in zip((one, two), starts, strict=True):
        _unknown_acceleration(site, side, start, alike)
    absolute(site, "a", one.point)


def absolute(site: Site, what: What, name: str) -> None:
    """The segment from the pole to a point's image, and the velocity or acceleration it stands for."""
    plan, segment = f"plan.{what}.{image(name)}", f"seg.{what}.p{image(name)}"
    if segment not in site.b:
        site.segment(segment, POLES[what], on_plan(name, what == "a"), call("abs", plan), what)
    size = site.sizes.of(what)
    site.b.define(
        f"{what}.{name}", Symbol(what, name), KINDS[what], multiply(f"mu.{what}", segment), scale=size
    )
    site.b.define(f"dir.{what}.{name}", Symbol("α", f"{what}{name}"), "angle", call("heading", plan), scale=1.0)


def _guide_point(site: Site, what: What, side: Side) -> None:
    """The point of a moving guide's link that lies under the sliding point."""
    if isinstance(side, Slide) and side.carrier is not None and not side.still:
        arm = subtract(f"p.{side.point}", f"p.{site.bodies[side.carrier].origin}")
        site.b.construct(f"plan.{what}.{image(side.base)}", site.carried(what, side.carrier, arm))
        absolute(site, what, side.base)


def _start(site: Site, what: What, side: Side) -> Expression:
    return NOWHERE if side.still else site.image(what, side.base)


def _across(side: Side) -> Expression:
    """The direction of the unknown velocity or acceleration of a side."""
    return call("turned", f"rod.{side.link}") if isinstance(side, Turn) else Ref(side.along)


def _along(site: Site, side: Side) -> Expression:
    """The relative velocity on the plan, from the base's image to the point's."""
    return subtract(f"plan.v.{image(side.point)}", _start(site, "v", side))


def _vector(base: str, side: Side, sup: str = "") -> Symbol:
    return Symbol(base, f"{side.point}{side.shown}", sup)


def _relative_velocity(site: Site, side: Side) -> None:
    """The velocity of the point relative to its base, and ω of the link that turns with it."""
    p, q = image(side.base), image(side.point)
    segment = f"seg.v.{p}{q}"
    letters = on_plan(side.base), on_plan(side.point)
    site.segment(segment, *letters, _along(site, side), "v")
    _define_relative(site, side, multiply("mu.v", segment))


def _from_rest(site: Site, side: Side) -> None:
    """Relative to a fixed point the velocity is the velocity itself."""
    if isinstance(side, Turn) or side.turning:
        _define_relative(site, side, Ref(f"v.{side.point}"))


def _define_relative(site: Site, side: Side, definition: Expression) -> None:
    b, sizes = site.b, site.sizes
    b.define(f"v.{side.relative}", _vector("v", side), "velocity", definition, scale=sizes.velocity)
    if not isinstance(side, Turn):
        return
    link, symbol = side.link, Symbol("ω", str(side.link))
    by_length = divide(f"v.{side.relative}", f"l.{side.rod}")
    b.define(f"omega.{link}", symbol, "angular velocity", by_length, scale=sizes.rotation)
    sense = call("sign", call("cross", f"rod.{link}", _along(site, side)))
    signed = multiply(f"omega.{link}", sense)
    b.define(f"turn.omega.{link}", symbol, "angular velocity", signed, scale=sizes.rotation)


def _known_acceleration(site: Site, side: Side) -> Expression:
    """Enter aⁿ = v²/l towards the base, or aᵏ = 2ω v_r square to v_r; gives where the unknown part starts."""
    b, size = site.b, site.sizes.acceleration
    start = _start(site, "a", side)
    part = _known_part(side)
    if not part:
        return start
    id, relative = f"a.{side.relative}.{part}", f"v.{side.relative}"
    formula: Expression
    direction: Expression
    segment = f"seg.a.{part}.{side.relative}"
    if isinstance(side, Turn):
        formula = divide(power(relative, 2), f"l.{side.rod}")
        direction = multiply(segment, divide(f"rod.{side.link}", f"l.{side.rod}"))
    else:
        formula = multiply(2, f"omega.{side.turning}", relative)
        sense = call("sign", site.spin(side.turning))
        # The relative velocity turned by 90° in the sense of ω.
        turned = call("turned", call("quotient", _along(site, side), divide(relative, "mu.v")))
        direction = multiply(segment, sense, turned)
    b.define(id, _vector("a", side, part), "acceleration", formula, scale=size)
    letters = (
        Symbol(POLES["a"]) if side.still else on_plan(side.base, True),
        Symbol(part, f"{side.point}{side.shown}"),
    )
    b.define(segment, segment_symbol(*letters), "segment", divide(id, "mu.a"), scale=site.paper("a"))
    plan = f"plan.a.{part}.{side.relative}"
    return Ref(b.construct(plan, subtract(start, direction) if part == "n" else add(start, direction)))


def _known_part(side: Side) -> str:
    """The letter of a side's known relative acceleration, "" where there is none."""
    if isinstance(side, Turn):
        return "n"
    return "k" if side.turning else ""


def _unknown_acceleration(site: Site, side: Side, start: Expression, alike: bool) -> None:
    """The tangential or sliding part, from the end of what is known to the point's image; ε of a turning link.

    Where both sides are `alike`, two ends share the letter n or k and are told apart by their vectors.
    """
    if isinstance(side, Slide) and side.still and not side.turning:
        return
    b, sizes, relative = site.b, site.sizes, side.relative
    part, sup = ("t", "τ") if isinstance(side, Turn) else ("r", "r")
    along = subtract(f"plan.a.{image(side.point)}", start)
    begin, end = Symbol(_known_part(side)), on_plan(side.point, True)
    if not begin.base:
        begin = on_plan(side.base, True)
    elif alike:
        begin, end = end, Symbol(begin.base, f"{side.point}{side.shown}")
    segment = f"seg.a.{part}.{relative}"
    site.segment(segment, begin, end, along, "a")
    b.define(
        f"a.{relative}.{part}",
        _vector("a", side, sup),
        "acceleration",
        multiply("mu.a", segment),
        scale=sizes.acceleration,
    )
    if not isinstance(side, Turn):
        return
    link, symbol = side.link, Symbol("ε", str(side.link))
    size = sizes.rotation**2
    by_length = divide(f"a.{relative}.t", f"l.{side.rod}")
    b.define(f"eps.{link}", symbol, "angular acceleration", by_length, scale=size)
    sense = call("sign", call("cross", f"rod.{link}", along))
    b.define(f"turn.eps.{link}", symbol, "angular acceleration", multiply(f"eps.{link}", sense), scale=size)
