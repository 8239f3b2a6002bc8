"""Ledger entries for the forces of a group of class III, with the special point of its plans.

The part Rᵗ of the reaction in each outer joint follows from the moments of its leg about the joint on the plate. The
part Rⁿ of one leg follows from the moments of the whole group about the special point of the two others, whose own
parts Rⁿ pass through it. These two close the force plan of the four links: it has the loads head to tail, and vertex n
where the lines along both legs meet.
"""

from __future__ import annotations

from collections.abc import Iterable

from reportgen.derivation.load_entries import (
    Edge,
    ForceChain,
    LoadOn,
    Origin,
    Polygon,
    Statics,
    force_plan,
    moment_terms,
    read,
    tangential,
)
from reportgen.derivation.triad_motion import entered_point
from reportgen.formula import Expression, Number, Sum, Symbol, cross, ids, meet, unit
from reportgen.machine import Triad, TriadLeg


def ternary_group(statics: Statics, triad: Triad) -> Polygon:
    """Enter the reactions of a triad and return its force plan; `statics.loads` contains those of later groups."""
    q, name = statics.q, ids.members(triad.links)
    special = entered_point(q, statics.scheme, triad)
    (first, last), third = special.pair, special.third
    digits = {leg.link: ids.joint(statics.scheme.owner[leg.outer], leg.link) for leg in triad.legs}
    across = [_tangential(statics, leg, digits[leg.link]) for leg in triad.legs]
    # A leg without moments has no term for its part, which is zero whatever the position.
    turning = [
        load for load in across if not isinstance(q.families[ids.reaction(digits[load.link], "t")].definition, Number)
    ]
    _axial(statics, triad, third, digits[third.link], turning)

    path = ForceChain(q)
    path.lay(ids.reaction_force(digits[first.link], "t"), first.link)
    after_first = path.last
    path.lay_loads(statics.on(first.link))
    between_first = before_third = path.last
    for part in ("t", "n"):
        path.lay(ids.reaction_force(digits[third.link], part), third.link)
    after_third = path.last
    path.lay_loads(statics.on(third.link))
    between_third = path.last
    path.lay_loads(statics.on(triad.plate))
    between_last = path.last
    path.lay_loads(statics.on(last.link))
    before_last = path.last
    path.lay(ids.reaction_force(digits[last.link], "t"), last.link)
    start = path.last
    title = f"R({','.join(map(str, triad.links))})"
    force_plan(
        statics,
        name,
        title,
        path,
        lambda at, _: meet(at[start], q[ids.rod(last.link)], Number(0.0), q[ids.rod(first.link)]),
    )
    inner = {leg.link: ids.joint(triad.plate, leg.link) for leg in triad.legs}
    reads = (
        (digits[last.link], "n", start, "n", last),
        (digits[first.link], "n", "n", path.first, first),
        (digits[last.link], "", before_last, "n", last),
        (digits[first.link], "", "n", after_first, first),
        (digits[third.link], "", before_third, after_third, third),
        (inner[last.link], "", "n", between_last, last),
        (inner[first.link], "", between_first, "n", first),
        (inner[third.link], "", between_third, before_third, third),
    )
    edges: list[Edge] = []
    for joint, part, begin, end, leg in reads:
        force = {"joint": joint, "part": part}
        reaction = ids.reaction_force.of(force)
        symbol = Symbol("R", joint, part)
        read(statics, name, name=reaction, symbol=symbol, id=ids.reaction.of(force), start=begin, end=end)
        edges.append(Edge(reaction, begin, end, True, leg.link))
    return Polygon(name, (*path.edges, *edges[:2]), tuple(edges[2:]))


def _tangential(statics: Statics, leg: TriadLeg, digits: str) -> LoadOn:
    """Enter Rᵗ in the outer joint of a leg and return it as a load of the whole group."""
    size = tangential(statics, leg.link, digits, (leg.outer, leg.inner), statics.on(leg.link))
    return LoadOn(ids.reaction_force(digits, "t"), leg.link, leg.outer, size, Origin.reaction, letters=f"{digits},t")


def _share(statics: Statics, loads: Iterable[LoadOn], centre: str) -> tuple[Expression | None, list[Expression]]:
    """Return the sum of forces times their arms about a point for the loads on one link, and the couples (N·m)."""
    terms, couples = moment_terms(statics, loads, centre)
    return Sum(tuple(terms)) if terms else None, couples


def _axial(statics: Statics, triad: Triad, leg: TriadLeg, digits: str, across: list[LoadOn]) -> None:
    """Enter Rⁿ of the third leg, positive from its outer joint inwards: Rⁿ h = −ΣM about the special point."""
    q = statics.q
    special = entered_point(q, statics.scheme, triad)
    parts = [
        _share(statics, (*statics.on(link), *(load for load in across if load.link == link)), special.name)
        for link in triad.links
    ]
    name = ids.reaction_force(digits, "n")
    assumed = q.construct(ids.assumed(name), unit(q[ids.rod(leg.link)]))
    lever = cross(q[ids.place(leg.outer)] - q[ids.place(special.name)], assumed) / q["drawing"]
    h = q.define(
        ids.arm(name, special.name),
        lever,
        Symbol("h", f"{digits},n"),
        arm=True,
        of=name,
        about=special.name,
        scale=statics.span,
    )
    # A term for each link, so that the line can be broken between them.
    terms = [-turning / h for turning, _ in parts if turning is not None]
    terms += [-couple / (q["mu.l"] * h) for _, couples in parts for couple in couples]
    size = q.define(ids.reaction(digits, "n"), Sum(tuple(terms)) if terms else 0.0, scale=statics.force)
    q.construct(ids.force_vector(name), size * assumed, of=size.id)
