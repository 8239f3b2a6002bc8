"""Positions, velocities and accelerations as a plan solves them: definitions from the dyad kinds alone.

Ids: `p.B` a point; `drawn.AB` its drawn length; `seg.v.pb`, `seg.v.ab` segments of the velocity plan;
`v.B`, `v.BA`, `omega.2`; likewise `seg.a…`, `a.B`, `a.BA.n`, `a.BA.t`, `eps.2`.  Sizes are positive; a
signed angular velocity is `turn.omega.2` (anticlockwise positive).  Plan points `plan.v.b`, `plan.a.b`
are metres on paper.  Lengths `l.AB`, the crank angle `phi.1`, the crank's angular velocity `omega.1` and
its drawn length `drawn.O1A` are expected from the machine.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable

from reportgen.ledger.core import Builder
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Dyad, Guide, Linkage
from reportgen.notation.expressions import (
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)
from reportgen.notation.symbols import on_plan, point

def difference(middle: str, start: str) -> str:
    """The id of the vector from one point to another, e.g. BA for B relative to A."""
    return f"{middle}{start}"


def describe(b: Builder, linkage: Linkage, turn: int) -> None:
    """Enter every kinematic quantity of a crank-driven linkage, link by link in order of assembly."""
    if not isinstance(linkage.driver, Crank):
        raise NotImplementedError("plans of a sliding driver")
    for name, place in linkage.ground.items():
        b.give(f"p.{name}", point(name), "length", complex(place))
    _crank(b, linkage, linkage.driver, turn)
    for dyad in linkage.dyads:
        DYADS[dyad.kind](b, linkage, dyad)


def image(name: str) -> str:
    """A point's letter on a plan: S2 → s2."""
    return name.lower()


def segment_symbol(first: Symbol | str, second: Symbol | str) -> Symbol:
    """A length between two points of a drawing: a bar over both letters, e.g. over p b or O₁A."""
    one = first if isinstance(first, Symbol) else Symbol(first)
    two = second if isinstance(second, Symbol) else Symbol(second)
    return Symbol(one.base + one.sub.translate(_LOWERED) + one.sup + two.base, two.sub, two.sup, "segment")


_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def _crank(b: Builder, linkage: Linkage, crank: Crank, turn: int) -> None:
    centre, pin = crank.centre, crank.pin
    length, drawn = f"l.{centre}{pin}", f"drawn.{centre}{pin}"
    b.define("mu.l", Symbol("μ", "l"), "length scale", divide(length, drawn))
    b.construct(f"p.{pin}", add(f"p.{centre}", multiply(length, call("cis", "phi.1"))))
    on_link = [place for place in linkage.points if place.link == DRIVER]
    for place in on_link:
        turned = add("phi.1", cmath.phase(place.local))
        other = f"l.{centre}{place.name}"
        b.construct(f"p.{place.name}", add(f"p.{centre}", multiply(other, call("cis", turned))))
        _drawn(b, centre, place.name)

    b.define(f"v.{pin}", _sized("v", pin), "velocity", multiply("omega.1", length))
    segment = f"seg.v.p{image(pin)}"
    b.define(segment, segment_symbol("p", on_plan(pin)), "segment", drawn, exact=b[drawn].exact)
    b.define("mu.v", Symbol("μ", "v"), "velocity scale", multiply("omega.1", "mu.l"))
    b.define(f"a.{pin}", _sized("a", pin), "acceleration", multiply(power("omega.1", 2), length))
    segment = f"seg.a.p{image(pin)}"
    b.define(segment, segment_symbol("π", on_plan(pin, True)), "segment", drawn, exact=b[drawn].exact)
    b.define("mu.a", Symbol("μ", "a"), "acceleration scale", multiply(power("omega.1", 2), "mu.l"))

    for name in (pin, *(place.name for place in on_link)):
        arm = divide(subtract(f"p.{name}", f"p.{centre}"), "mu.l")
        b.construct(f"plan.v.{image(name)}", multiply(turn, call("turned", arm)))
        b.construct(f"plan.a.{image(name)}", negative(arm))
        if name != pin:
            b.define(f"v.{name}", _sized("v", name), "velocity", multiply("omega.1", f"l.{centre}{name}"))
            b.define(
                f"a.{name}", _sized("a", name), "acceleration", multiply(power("omega.1", 2), f"l.{centre}{name}")
            )
            for plan, pole, what, prime in (("v", "p", "v", False), ("a", "π", "a", True)):
                b.define(
                    f"seg.{plan}.p{image(name)}",
                    segment_symbol(pole, on_plan(name, prime)),
                    "segment",
                    divide(f"{what}.{name}", f"mu.{plan}"),
                )


def _sized(base: str, name: str, sup: str = "") -> Symbol:
    return Symbol(base, name, sup)


def _drawn(b: Builder, start: str, end: str) -> None:
    b.define(
        f"drawn.{start}{end}",
        segment_symbol(point(start), point(end)),
        "segment",
        divide(f"l.{start}{end}", "mu.l"),
    )


def _scale(b: Builder, kind: str) -> float:
    """The size of which a billionth counts as nothing: that of the crank pin."""
    driver = {"v": "v.", "a": "a."}[kind]
    pin = next(id for id in b.families if id.startswith(driver))
    return float(abs(b.value(pin)).max())


def _guide(guide: Guide) -> tuple[complex, complex]:
    if guide.link != GROUND:
        raise NotImplementedError("plans with a moving guide")
    return complex(guide.at), cmath.exp(1j * guide.angle)


def _plane(b: Builder, id: str, value: complex) -> str:
    """A constant point or direction as a quantity, entered once."""
    if id not in b:
        b.give(id, Symbol(id), "ratio", complex(value))
    return id


def rrp(b: Builder, linkage: Linkage, dyad: Dyad) -> None:
    """A rod i from the moving point P to Q, and Q on a slider j along a fixed guide.

    v_Q = v_P + v_QP with v_QP ⊥ PQ and v_Q ∥ guide; a_Q = a_P + aⁿ_QP + aᵗ_QP likewise.
    """
    assert isinstance(dyad.start, str) and isinstance(dyad.end, Guide)
    start, middle = dyad.start, dyad.middle
    link, slider = dyad.links
    at, along = _guide(dyad.end)
    _plane(b, f"guide.{slider}.at", at)
    direction = _plane(b, f"guide.{slider}", along)
    length = f"l.{start}{middle}"
    rod, relative = f"rod.{link}", difference(middle, start)
    b.construct(
        f"p.{middle}", call("circle_line", f"p.{start}", length, f"guide.{slider}.at", direction, float(dyad.sign))
    )
    b.construct(rod, subtract(f"p.{middle}", f"p.{start}"))
    _drawn(b, start, middle)
    _points_of(b, linkage, link, start, middle)

    p, q = image(start), image(middle)
    b.construct(f"plan.v.{q}", call("meet", f"plan.v.{p}", call("turned", rod), 0.0, direction))
    _relative_velocity(b, link, start, middle)
    _absolute(b, "v", middle)
    _images(b, linkage, "v", link, start, middle)

    normal = _normal_acceleration(b, link, start, middle)
    b.construct(f"plan.a.{q}", call("meet", normal, call("turned", rod), 0.0, direction))
    _tangential_acceleration(b, link, start, middle)
    _absolute(b, "a", middle)
    _images(b, linkage, "a", link, start, middle)


def _points_of(b: Builder, linkage: Linkage, link: int, start: str, middle: str) -> None:
    for place in linkage.points:
        if place.link == link:
            ratio = divide(f"l.{start}{place.name}", f"l.{start}{middle}")
            turned = cmath.exp(1j * cmath.phase(place.local)) if place.local else 1
            b.construct(
                f"p.{place.name}",
                add(f"p.{start}", multiply(ratio, _plane(b, f"turn.{place.name}", turned), f"rod.{link}")),
            )
            _drawn(b, start, place.name)


def _relative_velocity(b: Builder, link: int, start: str, middle: str) -> None:
    p, q = image(start), image(middle)
    relative, segment = difference(middle, start), f"seg.v.{p}{q}"
    along = subtract(f"plan.v.{q}", f"plan.v.{p}")
    scale = _scale(b, "v")
    b.define(
        segment,
        segment_symbol(on_plan(start), on_plan(middle)),
        "segment",
        call("abs", along),
        scale=scale / float(b.value("mu.v")[0]),
    )
    b.define(f"v.{relative}", _sized("v", relative), "velocity", multiply("mu.v", segment), scale=scale)
    length = f"l.{start}{middle}"
    b.define(
        f"omega.{link}",
        Symbol("ω", str(link)),
        "angular velocity",
        divide(f"v.{relative}", length),
        scale=float(b.value("omega.1")[0]),
    )
    b.define(
        f"turn.omega.{link}",
        Symbol("ω", str(link)),
        "angular velocity",
        multiply(f"omega.{link}", call("sign", call("cross", f"rod.{link}", along))),
        scale=float(b.value("omega.1")[0]),
    )


def _normal_acceleration(b: Builder, link: int, start: str, middle: str) -> str:
    p, relative = image(start), difference(middle, start)
    b.define(
        f"a.{relative}.n",
        _sized("a", relative, "n"),
        "acceleration",
        divide(power(f"v.{relative}", 2), f"l.{start}{middle}"),
        scale=_scale(b, "a"),
    )
    segment = f"seg.a.n.{relative}"
    b.define(
        segment,
        segment_symbol(on_plan(start, True), Symbol("n", relative)),
        "segment",
        divide(f"a.{relative}.n", "mu.a"),
        scale=_scale(b, "a") / float(b.value("mu.a")[0]),
    )
    towards = divide(f"rod.{link}", f"l.{start}{middle}")
    return b.construct(f"plan.a.n.{relative}", subtract(f"plan.a.{p}", multiply(segment, towards)))


def _tangential_acceleration(b: Builder, link: int, start: str, middle: str) -> None:
    q, relative = image(middle), difference(middle, start)
    along = subtract(f"plan.a.{q}", f"plan.a.n.{relative}")
    segment, scale = f"seg.a.t.{relative}", _scale(b, "a")
    b.define(
        segment,
        segment_symbol("n", on_plan(middle, True)),
        "segment",
        call("abs", along),
        scale=scale / float(b.value("mu.a")[0]),
    )
    b.define(f"a.{relative}.t", _sized("a", relative, "τ"), "acceleration", multiply("mu.a", segment), scale=scale)
    natural = float(b.value("omega.1")[0]) ** 2
    b.define(
        f"eps.{link}",
        Symbol("ε", str(link)),
        "angular acceleration",
        divide(f"a.{relative}.t", f"l.{start}{middle}"),
        scale=natural,
    )
    b.define(
        f"turn.eps.{link}",
        Symbol("ε", str(link)),
        "angular acceleration",
        multiply(f"eps.{link}", call("sign", call("cross", f"rod.{link}", along))),
        scale=natural,
    )


def _absolute(b: Builder, what: str, name: str) -> None:
    """The segment from the pole to a point's image, and the velocity or acceleration it stands for."""
    pole, prime = ("p", False) if what == "v" else ("π", True)
    scale = _scale(b, what)
    segment = f"seg.{what}.p{image(name)}"
    b.define(
        segment,
        segment_symbol(pole, on_plan(name, prime)),
        "segment",
        call("abs", f"plan.{what}.{image(name)}"),
        scale=scale / float(b.value(f"mu.{what}")[0]),
    )
    kind = "velocity" if what == "v" else "acceleration"
    b.define(f"{what}.{name}", _sized(what, name), kind, multiply(f"mu.{what}", segment), scale=scale)
    plan = f"plan.{what}.{image(name)}"
    b.define(f"dir.{what}.{name}", Symbol("α", f"{what}{name}"), "angle", call("heading", plan), scale=1.0)


def _images(b: Builder, linkage: Linkage, what: str, link: int, start: str, middle: str) -> None:
    """Points of a link by the similarity theorem: the plan's figure is similar to the link's."""
    p, q = image(start), image(middle)
    prime = what == "a"
    for place in linkage.points:
        if place.link != link:
            continue
        ratio = divide(f"l.{start}{place.name}", f"l.{start}{middle}")
        along = subtract(f"plan.{what}.{q}", f"plan.{what}.{p}")
        b.construct(
            f"plan.{what}.{image(place.name)}",
            add(f"plan.{what}.{p}", multiply(ratio, f"turn.{place.name}", along)),
        )
        whole = f"seg.{what}.{p}{q}"
        if whole not in b:
            b.define(
                whole,
                segment_symbol(on_plan(start, prime), on_plan(middle, prime)),
                "segment",
                call("abs", along),
                scale=_scale(b, what) / float(b.value(f"mu.{what}")[0]),
            )
        b.define(
            f"seg.{what}.{p}{image(place.name)}",
            segment_symbol(on_plan(start, prime), on_plan(place.name, prime)),
            "segment",
            multiply(ratio, whole),
        )
        _absolute(b, what, place.name)


DYADS: dict[str, Callable[[Builder, Linkage, Dyad], None]] = {"RRP": rrp}
"""How each dyad kind is solved on a plan."""
