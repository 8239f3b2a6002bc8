"""Forces group by group, as the textbook solves them: definitions from the dyad kinds alone.

For a load X: `F.X` is its vector, the size has the load's own id (`P3`, `G2`, `Pqt2`); its arm about a
point D is `h.X.D`.  For a joint: `R.12.t`, `R.12.n`, `R.12`, and vectors `F.R12`.  A group's force plan
has vertices `plan.R23.e`, … (metres on paper) and a scale `mu.R23`.  Arms are signed, anticlockwise
moments positive, in metres on paper (lengths drawn at μ_l).  The plan is laid out in `Polygon`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.ledger.core import Builder
from reportgen.ledger.kinematics import image, segment_symbol
from reportgen.mechanism.structure import DRIVER, Crank, Dyad, Guide, Linkage
from reportgen.notation.expressions import (
    Expression,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    subtract,
)
from reportgen.notation.numbers import nice_up

PLAN_BOX = (0.160, 0.200)
"""Every force plan of a group fits into this box on paper (m): one scale serves them all."""


@dataclass(frozen=True, slots=True)
class Side:
    """One force of a polygon, from vertex to vertex; `unknown` sides are found by closing it."""

    name: str
    start: str
    end: str
    unknown: bool = False


@dataclass(frozen=True, slots=True)
class Polygon:
    """A group's force plan: its sides head to tail and the joints read from it.

    `reads` are further vectors read between vertices, e.g. the reaction in the inner joint.
    """

    name: str
    sides: tuple[Side, ...]
    reads: tuple[Side, ...] = ()


@dataclass(frozen=True, slots=True)
class LoadOn:
    """A load as the ledger knows it: its name, its link, the point it acts at, and its moment of inertia term."""

    name: str
    link: int
    point: str
    inertial: bool = False


def enter_loads(b: Builder, linkage: Linkage, gas: Mapping[str, tuple[int, str, complex]]) -> tuple[LoadOn, ...]:
    """Enter vectors of weights, inertia forces and applied forces; ids `G2`, `Pqt2` and those of `gas` exist.

    `gas` maps a force's id to (link, point, unit vector of its positive sense).  Inertia forces and couples
    follow from `m.k`, `J.k` and the acceleration plan: F = −m a_S, couple −J ε; both together are one force
    at arm h = M/F.  Loads of a link without mass are absent.
    """
    loads = []
    for body in linkage.inertias:
        link, centre = body.link, body.centre
        if body.mass > 0:
            down = linkage.gravity / abs(linkage.gravity) if linkage.gravity else -1j
            b.give(f"down.{link}", Symbol("g"), "ratio", complex(down))
            b.construct(f"F.G{link}", multiply(f"G{link}", f"down.{link}"))
            loads.append(LoadOn(f"G{link}", link, centre))
        if body.mass <= 0 and body.moment <= 0 or link == DRIVER and centre == _centre(linkage):
            continue
        name = f"Pqt{link}"
        b.define(
            name,
            Symbol("P", f"qt{link}"),
            "force",
            multiply(f"m.{link}", f"a.{centre}"),
            scale=_force_scale(b, link),
        )
        b.construct(
            f"F.{name}", negative(multiply(f"m.{link}", "mu.a", f"plan.a.{image(centre)}"))
        )
        if f"turn.eps.{link}" in b and body.moment > 0:
            b.define(
                f"M.{name}",
                Symbol("M", f"qt{link}"),
                "torque",
                multiply(f"J.{link}", f"eps.{link}"),
                scale=body.moment * float(b.value("omega.1")[0]) ** 2,
            )
            b.construct(f"couple.{name}", negative(multiply(f"J.{link}", f"turn.eps.{link}")))
            if body.mass > 0:
                _line_of_action(b, linkage, link, centre)
        loads.append(LoadOn(name, link, centre, inertial=True))
    for name, (link, place, sense) in gas.items():
        b.give(f"sense.{name}", Symbol(name), "ratio", complex(sense))
        b.construct(f"F.{name}", multiply(name, f"sense.{name}"))
        loads.append(LoadOn(name, link, place))
    order = {kind: rank for rank, kind in enumerate(("Pqt", "P", "G"))}
    return tuple(sorted(loads, key=lambda load: (load.link, order[load.name.rstrip("0123456789")])))


def _line_of_action(b: Builder, linkage: Linkage, link: int, centre: str) -> None:
    """How far the one inertia force passes from S, e = M/P, and the centre of percussion, l_SK = J/(m l_AS)."""
    name = f"Pqt{link}"
    b.define(f"e.{name}", Symbol("e", f"qt{link}"), "length", divide(f"M.{name}", name), scale=1e-3)
    start = next((dyad.start for dyad in linkage.dyads if dyad.links[0] == link), None)
    arm = f"l.{start}{centre}"
    if arm in b and float(b.value(arm)[0]) > 0:
        b.define(
            f"l.{centre}K{link}",
            Symbol("l", f"{centre}K{link}"),
            "length",
            divide(f"J.{link}", multiply(f"m.{link}", arm)),
        )


def _centre(linkage: Linkage) -> str:
    return linkage.driver.centre if isinstance(linkage.driver, Crank) else ""


def _force_scale(b: Builder, link: int) -> float:
    return float(b.value(f"m.{link}")[0]) * float(np.abs(b.value("seg.a.p" + _pin(b))).max() * b.value("mu.a")[0])


def _pin(b: Builder) -> str:
    return next(id for id in b.families if id.startswith("seg.a.p")).removeprefix("seg.a.p")


def moment_about(load: LoadOn, centre: str, couples: bool) -> Expression:
    """The moment of a load about a point, its couple included."""
    lever: Expression = call("cross", subtract(f"p.{load.point}", f"p.{centre}"), f"F.{load.name}")
    return add(lever, f"couple.{load.name}") if couples else lever


def arm(b: Builder, load: LoadOn, centre: str) -> str:
    """The signed arm, measured on the drawing, of a load about a point: h = M/(F μ_l)."""
    id = f"h.{load.name}.{centre}"
    moment = moment_about(load, centre, f"couple.{load.name}" in b)
    b.define(
        id,
        Symbol("h", load.name),
        "segment",
        divide(call("quotient", moment, load.name), "mu.l"),
        arm=True,
        scale=float(b.value("drawn." + _crank_name(b))[0]),
    )
    return id


def _crank_name(b: Builder) -> str:
    return next(id for id in b.families if id.startswith("drawn.")).removeprefix("drawn.")


def _moments(b: Builder, loads: tuple[LoadOn, ...], centre: str, pushes: list[Expression]) -> Expression | None:
    """Moments about a point as printed: (ΣF·h)·μ_l, and couples whose force vanishes; None if there are none.

    `pushes` are further products of a force and its arm.
    """
    terms, couples = list(pushes), []
    for load in loads:
        if load.point == centre and f"couple.{load.name}" not in b:
            continue
        terms.append(multiply(load.name, arm(b, load, centre)))
        if f"couple.{load.name}" in b:
            couples.append(_lone_couple(b, load))
    if not terms:
        return None
    turned = multiply(add(*terms), "mu.l")
    return add(turned, *couples) if couples else turned


def _lone_couple(b: Builder, load: LoadOn) -> Expression:
    """The couple of a load at positions where its force is nothing; left out of a line elsewhere."""
    id = f"lone.{load.name}"
    if id not in b:
        b.define(
            id,
            Symbol("M", load.name.removeprefix("P")),
            "torque",
            call("if_zero", load.name, f"couple.{load.name}"),
            optional=True,
        )
    return add(id)


LETTERS = "efghijklmqrtuvwxyz"
"""Vertices of a force plan in the order of drawing; n is where the unknown sides meet."""


def _joint(one: int, other: int) -> str:
    return f"{one}{other}"


def rrp(b: Builder, dyad: Dyad, carrier: int, loads: tuple[LoadOn, ...]) -> Polygon:
    """Reactions of a rod i (outer pin P, inner pin Q) and its slider j on a fixed guide.

    Moments of link i about Q give R^t in P; the polygon of both links, closed by R^n along the rod and by
    the guide's reaction across the guide, gives the rest; the part that belongs to link j gives R_ij.
    """
    assert isinstance(dyad.start, str) and isinstance(dyad.end, Guide)
    link, slider = dyad.links
    start, middle = dyad.start, dyad.middle
    rod, group = f"rod.{link}", f"{link}{slider}"
    outer, inner, guide = _joint(carrier, link), _joint(link, slider), _joint(dyad.end.link, slider)
    on_rod = tuple(load for load in loads if load.link == link)
    on_slider = tuple(load for load in loads if load.link == slider)

    length = f"l.{start}{middle}"
    moments = _moments(b, on_rod, middle, [])
    b.define(
        f"R.{outer}.t",
        Symbol("R", outer, "τ"),
        "force",
        0.0 if moments is None else divide(moments, length),
        scale=_load_size(b, loads),
    )
    b.construct(f"F.R{outer}.t", multiply(f"R.{outer}.t", call("turned", divide(rod, length))))

    known = [*on_slider, *on_rod]
    ends: dict[str, Expression] = {}
    reached: Expression = _nothing()
    letters = iter(LETTERS)
    first = next(letters)
    sides, previous, between = [], first, first
    for load in known:
        reached = add(reached, f"F.{load.name}")
        letter = next(letters)
        ends[letter] = reached
        sides.append(Side(load.name, previous, letter))
        previous = letter
        if load in on_slider:
            between = letter
    before_tangent, last = previous, next(letters)
    ends[last] = add(reached, f"F.R{outer}.t")
    sides.append(Side(f"R{outer}.t", before_tangent, last))

    across = call("turned", f"guide.{slider}")
    b.construct(f"closing.{group}", call("meet", ends[last], rod, 0.0, across))
    corners = {first: _nothing(), **ends, "n": add(f"closing.{group}")}
    mu = _force_plan(b, group, corners)
    _read(b, group, "R" + outer, Symbol("R", outer), f"R.{outer}", before_tangent, "n", loads)
    _read(b, group, f"R{outer}.n", Symbol("R", outer, "n"), f"R.{outer}.n", last, "n", loads)
    _read(b, group, "R" + guide, Symbol("R", guide), f"R.{guide}", "n", first, loads)
    _read(b, group, f"R{slider}{link}", Symbol("R", f"{slider}{link}"), f"R.{slider}{link}", "n", between, loads)
    for side in sides:
        b.define(
            f"seg.{group}.{side.name}",
            segment_symbol(side.start, side.end),
            "segment",
            call("abs", divide(f"F.{side.name}", mu)),
            scale=PLAN_BOX[1],
        )
    # The slider alone: the moments about Q say where along the guide its reaction acts.
    offset = [moment_about(load, middle, f"couple.{load.name}" in b) for load in on_slider]
    b.define(
        f"x.{guide}",
        Symbol("x", guide),
        "length",
        call("quotient", add(*offset) if offset else 0.0, f"R.{guide}"),
        scale=float(b.value(length)[0]),
    )
    return Polygon(
        group,
        (*sides, Side(f"R{outer}.n", last, "n", True), Side(f"R{guide}", "n", first, True)),
        (Side(f"R{outer}", before_tangent, "n", True), Side(f"R{slider}{link}", "n", between, True)),
    )


def _nothing() -> Expression:
    return multiply(0.0)


def _load_size(b: Builder, loads: tuple[LoadOn, ...]) -> float:
    return max((float(np.abs(b.value(load.name)).max()) for load in loads), default=0.0)


def _force_plan(b: Builder, group: str, corners: Mapping[str, Expression]) -> str:
    """Choose μ_R so that the plan fits its box at every position, and enter the vertices on paper."""
    from reportgen.notation.expressions import evaluate

    values = {id: family.values for id, family in b.families.items()}
    places = np.array(
        [np.broadcast_to(evaluate(corner, values), (b.positions,)) for corner in corners.values()]
    )
    places = places[:, np.isfinite(places).all(axis=0)]
    width, height = np.ptp(places.real, axis=0).max(), np.ptp(places.imag, axis=0).max()
    needed = max(width / PLAN_BOX[0], height / PLAN_BOX[1])
    mu = f"mu.R{group}"
    b.give(mu, Symbol("μ", f"R({','.join(group)})"), "force scale", nice_up(max(needed, 1e-9) / 1e3) * 1e3)
    for letter, corner in corners.items():
        b.construct(f"plan.R{group}.{letter}", divide(corner, mu))
    return mu


def _read(
    b: Builder, group: str, name: str, symbol: Symbol, id: str, start: str, end: str, loads: tuple[LoadOn, ...]
) -> None:
    """A force read from a plan between two vertices: its segment, its size and its vector."""
    mu, along = f"mu.R{group}", subtract(f"plan.R{group}.{end}", f"plan.R{group}.{start}")
    scale = _load_size(b, loads)
    segment = f"seg.{group}.{name}"
    b.define(
        segment,
        segment_symbol(start, end),
        "segment",
        call("abs", along),
        scale=scale / float(b.value(mu)[0]),
    )
    b.define(id, symbol, "force", multiply(mu, segment), scale=scale)
    b.construct(f"F.{name}", multiply(mu, along))
    b.define(f"dir.{name}", Symbol("α", symbol.sub), "angle", call("heading", f"F.{name}"), scale=1.0)


def crank(b: Builder, linkage: Linkage, turn: int, loads: tuple[LoadOn, ...]) -> Polygon:
    """The driver: reactions of the groups on it, R01 by its polygon, and the balancing torque by moments.

    M_cb = −Σ R h μ_l about the crank centre.
    """
    assert isinstance(linkage.driver, Crank)
    centre = linkage.driver.centre
    own = tuple(load for load in loads if load.link == DRIVER)
    pushes: list[tuple[str, str, str]] = []
    for dyad in linkage.dyads:
        for link, outer in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            if isinstance(outer, str) and _carried_by(linkage, outer) == DRIVER:
                id = f"R.{link}{DRIVER}"
                b.define(id, Symbol("R", f"{link}{DRIVER}"), "force", f"R.{DRIVER}{link}")
                b.construct(f"F.R{link}{DRIVER}", negative(f"F.R{DRIVER}{link}"))
                pushes.append((f"R{link}{DRIVER}", id, outer))
    terms: list[Expression] = []
    crank_drawn = float(b.value("drawn." + _crank_name(b))[0])
    for name, id, place in pushes:
        moment = call("cross", subtract(f"p.{place}", f"p.{centre}"), f"F.{name}")
        lever = b.define(
            f"h.{name}.{centre}",
            Symbol("h", name.removeprefix("R")),
            "segment",
            divide(call("quotient", moment, id), "mu.l"),
            arm=True,
            scale=crank_drawn,
        )
        terms.append(multiply(id, lever))
    moments = _moments(b, own, centre, terms)
    balance = 0.0 if moments is None else negative(moments)
    b.define("M.eq", Symbol("M", "cb"), "torque", balance, scale=_torque_scale(b, loads))

    letters = iter(LETTERS)
    first = previous = next(letters)
    corners: dict[str, Expression] = {first: _nothing()}
    reached: Expression = _nothing()
    sides = []
    for name in (*(name for name, _, _ in pushes), *(load.name for load in own)):
        reached = add(reached, f"F.{name}")
        letter = next(letters)
        corners[letter] = reached
        sides.append(Side(name, previous, letter))
        previous = letter
    mu = _force_plan(b, "1", corners)
    for side in sides:
        b.define(
            f"seg.1.{side.name}",
            segment_symbol(side.start, side.end),
            "segment",
            call("abs", divide(f"F.{side.name}", mu)),
            scale=PLAN_BOX[1],
        )
    _read(b, "1", "R01", Symbol("R", "01"), "R.01", previous, first, loads)
    return Polygon("1", (*sides, Side("R01", previous, first, True)))


def _torque_scale(b: Builder, loads: tuple[LoadOn, ...]) -> float:
    return _load_size(b, loads) * float(b.value("l." + _crank_name(b))[0])


def _carried_by(linkage: Linkage, name: str) -> int:
    """The link whose motion gives a named joint point."""
    driver = linkage.driver
    if name == driver.pin:
        return DRIVER
    for place in linkage.points:
        if place.name == name:
            return place.link
    for dyad in linkage.dyads:
        if dyad.middle == name:
            return dyad.links[1]
    return 0


def lever(b: Builder, linkage: Linkage, turn: int, loads: tuple[LoadOn, ...]) -> tuple[str, ...]:
    """Zhukovsky's lever: the turned velocity plan with every load at its image, balanced by M_cb.

    Σ F v cos α + M_cb ω₁ = 0 with v = μ_v · (segment) and μ_v = ω₁ μ_l gives M_cb = −Σ F h′ μ_l for an
    anticlockwise crank; h′ is the arm of a load about the pole, drawn at its image on the turned plan.
    Returns the ids of the arms.
    """
    terms: list[Expression] = []
    couples: list[Expression] = []
    arms = []
    for load in loads:
        work: Expression = call("dot", f"F.{load.name}", f"plan.v.{image(load.point)}")
        if f"couple.{load.name}" in b:
            work = add(work, divide(multiply(f"couple.{load.name}", f"turn.omega.{load.link}"), "mu.v"))
        id = f"h.{load.name}.p"
        b.define(
            id,
            Symbol("h", load.name, "′"),
            "segment",
            call("quotient", work, load.name),
            arm=True,
            scale=float(b.value("drawn." + _crank_name(b))[0]),
        )
        arms.append(id)
        terms.append(multiply(load.name, id))
        if f"couple.{load.name}" in b:
            couples.append(divide(multiply(_lone_couple(b, load), f"turn.omega.{load.link}"), "omega.1"))
    turned = multiply(add(*terms), "mu.l")
    total = add(turned, *couples) if couples else turned
    b.define(
        "M.vw",
        Symbol("M", "cb"),
        "torque",
        negative(total) if turn > 0 else total,
        scale=_torque_scale(b, loads),
    )
    return tuple(arms)


DYADS: dict[str, Callable[[Builder, Dyad, int, tuple[LoadOn, ...]], Polygon]] = {"RRP": rrp}


def describe(
    b: Builder, linkage: Linkage, turn: int, gas: Mapping[str, tuple[int, str, complex]]
) -> tuple[Polygon, ...]:
    """Enter all force quantities, the outermost group first; returns the force plans in that order."""
    loads = enter_loads(b, linkage, gas)
    polygons = []
    for dyad in reversed(linkage.dyads):
        carrier = _carried_by(linkage, dyad.start) if isinstance(dyad.start, str) else dyad.start.link
        polygons.append(DYADS[dyad.kind](b, dyad, carrier, loads))
    polygons.append(crank(b, linkage, turn, loads))
    lever(b, linkage, turn, loads)
    return tuple(polygons)
