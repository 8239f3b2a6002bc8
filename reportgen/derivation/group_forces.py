"""Forces group by group, as the textbook solves them: definitions from the dyad kinds alone.

Ids: `R.12.t`, `R.12.n`, `R.12` sizes of reactions and `F.R12` their vectors; `assumed.R12.t` the unit vector of
the sense in which a signed component counts as positive, and is drawn on its link; `M.03`, `x.03` the moment about
the pin that a slide's reaction balances and its distance from the pin.  A group's force plan has vertices
`plan.R23.e`, … (metres on paper) and a scale `mu.R23`.  Arms are signed, anticlockwise moments positive, in
metres on paper (lengths drawn at μ_l).  `M.eq` and `M.vw` balance the driver.  A plan is laid out in `Polygon`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.derivation.equation_sides import scheme
from reportgen.derivation.kinematic_entries import natural_sizes
from reportgen.derivation.load_entries import (
    Applied,
    Edge,
    EnterGuide,
    ForceChain,
    LoadOn,
    Origin,
    Polygon,
    Statics,
    above,
    carried_reactions,
    enter_loads,
    force_plan,
    lone_couple,
    moments,
    opposite,
    read,
    tangential,
)
from reportgen.derivation.plan_scales import Scaling, own_scales
from reportgen.derivation.triad_forces import ternary_group
from reportgen.formula import Expression, Ref, Sum, Symbol, call, dot, ids, meet, quotient, sign, total, turned
from reportgen.formula.calculation import ZERO, Calculation
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import DRIVER, Crank, Dyad, DyadKind, Guide, Linkage, Triad


def enter_forces(
    q: Calculation,
    linkage: Linkage,
    turn: int,
    applied: Applied,
    torques: Mapping[str, int] | None = None,
    scales: Scaling = own_scales,
    guides: tuple[EnterGuide, ...] = (),
) -> tuple[Polygon, ...]:
    """Enter all force quantities, the outermost group first, and return the force plans in that order.

    The driver's plan is the last.  `applied` maps a force's id to (link, point, unit vector of its positive sense),
    `torques` a signed torque's id to its link.  `scales` chooses the scales of the plans from their sizes.  With the
    functions `guides`, topics enter further quantities of sliders.
    """
    statics = Statics(q, scheme(linkage), turn, natural_sizes(q, linkage), scales=scales, guides=guides)
    loads = enter_loads(statics, applied, torques or {})
    statics = replace(statics, loads=loads)
    polygons = []
    for member in reversed(linkage.groups):
        carried = carried_reactions(statics, member.links)
        under = replace(statics, loads=(*carried, *loads))
        polygons.append(ternary_group(under, member) if isinstance(member, Triad) else group(under, member))
    carried = carried_reactions(statics, (DRIVER,))
    polygons.append(driver(replace(statics, loads=(*carried, *loads))))
    lever(statics, loads)
    return tuple(polygons)


# --- reactions of a group in the textbook's order, two unknowns or fewer a step -------------------
# A group has its outer joints in P (link i) and T (link j) and its inner joint in Q. Its loads are laid head to tail,
# link j's first (e … b), then link i's (b … c). Vertex n closes the plan: R_ci = cn acts on i in its outer joint,
# R_dj = ne on j in its outer joint, R_ji = nb on i in the inner joint.
#
# ==== ================================= ====================================================
# kind computed by moments               n lies on
# ==== ================================= ====================================================
# RRR  Rᵗ in both outer joints, about Q  a line along PQ and a line along TQ
# RRP  Rᵗ in P, about Q                  a line along PQ and a line from e across the guide
# RPR  R_ij across the slot, about T     the end of R_ij, which is laid off from b
# PRP  –                                 a line from c and a line from e, each across the link's guide
# RPP  –                                 a line from b across the slot and a line from e across the guide
# ==== ================================= ====================================================
#
# A line along a rod starts at the free end of the rod's Rᵗ, which is laid before e (joint T) or after c (joint P).
# In a slide, M is the moment of all other loads on the link about the pin; the reaction acts at the distance M/R.
# After the groups, the driver is solved under their reactions, and the balance by virtual work on Zhukovsky's lever.

CLEAR = 1e-3
"""A slide's reaction that stays above this share of the loads has a distance printed as M/R."""


class Group(Record):
    """A dyad with the digits of its joints' reactions and the loads on its links i and j."""

    statics: Statics
    dyad: Dyad
    i: int
    j: int
    outer: str
    inner: str
    end: str
    on_i: tuple[LoadOn, ...]
    on_j: tuple[LoadOn, ...]

    @property
    def q(self) -> Calculation:
        return self.statics.q

    @property
    def name(self) -> str:
        return ids.joint(self.i, self.j)

    @property
    def start(self) -> str:
        """The outer pin of link i."""
        assert isinstance(self.dyad.start, str)
        return self.dyad.start


def group(statics: Statics, dyad: Dyad) -> Polygon:
    """Enter a group's reactions and return its force plan; `statics.loads` contains those of later groups."""
    i, j = dyad.links
    carriers = [end.link if isinstance(end, Guide) else statics.scheme.owner[end] for end in (dyad.start, dyad.end)]
    parts = Group(
        statics,
        dyad,
        i,
        j,
        outer=ids.joint(carriers[0], i),
        inner=ids.joint(j, i),
        end=ids.joint(carriers[1], j),
        on_i=statics.on(i),
        on_j=statics.on(j),
    )
    return DYADS[dyad.kind](parts)


def _rrr(g: Group) -> Polygon:
    assert isinstance(g.dyad.end, str)
    middle = g.dyad.middle
    tangential(g.statics, g.i, g.outer, (g.start, middle), g.on_i)
    tangential(g.statics, g.j, g.end, (g.dyad.end, middle), g.on_j)
    return _close(g, g.q[ids.rod(g.i)], g.q[ids.rod(g.j)], tangents=(True, True))


def _rrp(g: Group) -> Polygon:
    middle = g.dyad.middle
    tangential(g.statics, g.i, g.outer, (g.start, middle), g.on_i)
    polygon = _close(g, g.q[ids.rod(g.i)], turned(g.q[ids.guide(g.j)]), tangents=(True, False))
    _slide(g, g.end, middle, g.on_j, g.j)
    return polygon


def _rpr(g: Group) -> Polygon:
    """Solve lever j about T: R_ij l = ΣM_T(j) + ΣM_P(i), l the distance of T from the line of R_ij."""
    assert isinstance(g.dyad.end, str)
    q, across = g.q, ids.joint(g.i, g.j)
    couple = _moment(g, g.inner, g.start, g.on_i)
    moment = moments(g.statics, g.on_j, g.dyad.end)
    # The sum must be flat: an inner sum would vanish as soon as one of its terms is left out.
    known = [*(moment.terms if isinstance(moment, Sum) else [moment] if moment else []), *([couple] if couple else [])]
    size = total(known) / _reach(g) if known else 0.0
    reaction = q.define(ids.reaction(across, "s"), size, Symbol("R", across), scale=g.statics.force)
    assumed = q.construct(ids.assumed(ids.reaction_force(across, "s")), -float(g.dyad.sign) * turned(q[ids.slot(g.j)]))
    laid = q.construct(ids.force_vector(ids.reaction_force(across, "s")), reaction * assumed, of=reaction.id)
    polygon = _close(g, None, None, laid=laid)
    _offset(g, g.inner)
    return polygon


def _prp(g: Group) -> Polygon:
    middle = g.dyad.middle
    polygon = _close(g, turned(g.q[ids.guide(g.i)]), turned(g.q[ids.guide(g.j)]))
    _slide(g, g.outer, middle, g.on_i, g.i)
    _slide(g, g.end, middle, g.on_j, g.j)
    return polygon


def _rpp(g: Group) -> Polygon:
    """Solve link j under its loads, R_ij across the slot and R_kj across the guide; then block i."""
    polygon = _close(g, turned(g.q[ids.slot(g.j)]), turned(g.q[ids.guide(g.j)]), from_between=True)
    _slide(g, g.inner, g.start, g.on_i)
    q, back = g.q, ids.joint(g.i, g.j)
    reaction = opposite(q, back, g.inner, g.j, g.start, g.name)
    if ids.reaction_couple(g.inner) in q:
        q.construct(ids.couple(ids.reaction_force(back)), q[ids.reaction_couple(g.inner)])
    _slide(g, g.end, g.dyad.middle, (reaction, *g.on_j), g.j)
    return polygon


# --- steps ----------------------------------------------------------------------------------------


def _reach(g: Group) -> Ref:
    """Return the length from T to the line of R_ij: TP itself, or from the foot H of T on the slot's line."""
    q, middle, end = g.q, g.dyad.middle, g.dyad.end
    if not g.dyad.lengths[1]:
        return q[ids.length(end, middle)]
    foot, μ_l = f"H{g.j}", q["mu.l"]
    along = abs(dot(q[ids.rod(g.j)], q[ids.slot(g.j)])) / q["drawing"]
    drawn = q.define(ids.drawn(foot, middle), along, drawn_length(foot, middle), scale=g.statics.span)
    return q.define(ids.length(foot, middle), μ_l * drawn)


def _close(
    g: Group,
    first: Expression | None,
    second: Expression | None,
    *,
    tangents: tuple[bool, bool] = (False, False),
    laid: Expression | None = None,
    from_between: bool = False,
) -> Polygon:
    """Lay off the known forces, close the plan at n, and read every reaction from it.

    `first` and `second` are the directions towards n: from the last known vertex (or from b), and from e; `laid`
    instead is a force laid off from b.
    """
    path = ForceChain(g.q)
    if tangents[1]:
        path.lay(ids.reaction_force(g.end, "t"), g.j)
    after = path.last
    path.lay_loads(g.on_j)
    between = path.last
    path.lay_loads(g.on_i)
    before = path.last
    if tangents[0]:
        path.lay(ids.reaction_force(g.outer, "t"), g.i)
    start = between if from_between else path.last
    statics, name = g.statics, g.name

    def closing(at: Mapping[str, Expression], μ: Expression) -> Expression:
        if laid is not None:
            return at[between] + laid / μ
        assert first is not None
        assert second is not None
        return meet(at[start], first, 0.0, second)

    force_plan(statics, name, f"R({g.i},{g.j})", path, closing)

    def take(digits: str, part: str, begin: str, end: str) -> None:
        force = {"joint": digits, "part": part}
        read(
            statics,
            name,
            name=ids.reaction_force.of(force),
            symbol=Symbol("R", digits, part),
            id=ids.reaction.of(force),
            start=begin,
            end=end,
        )

    take(g.outer, "", before, "n")
    if tangents[0]:
        take(g.outer, "n", path.last, "n")
    if tangents[1]:
        take(g.end, "n", "n", path.first)
    take(g.end, "", "n", after)
    take(g.inner, "", "n", between)

    outer = Edge(
        ids.reaction_force(g.outer, "n") if tangents[0] else ids.reaction_force(g.outer), path.last, "n", True, g.i
    )
    end = Edge(ids.reaction_force(g.end, "n") if tangents[1] else ids.reaction_force(g.end), "n", path.first, True, g.j)
    reads = [Edge(ids.reaction_force(g.outer), before, "n", True, g.i)] if tangents[0] else []
    reads += [Edge(ids.reaction_force(g.end), "n", after, True, g.j)] if tangents[1] else []
    reads.append(Edge(ids.reaction_force(g.inner), "n", between, True, g.i))
    return Polygon(name, (*path.edges, outer, end), tuple(reads))


def _slide(g: Group, digits: str, pin: str, loads: tuple[LoadOn, ...], link: int = 0) -> None:
    """Enter the place where a slide's reaction acts, from the moments of all other loads of the link about the pin."""
    _moment(g, digits, pin, loads)
    _offset(g, digits)
    for enter in g.statics.guides:
        enter(g.statics, digits, link)


def _moment(g: Group, digits: str, pin: str, loads: tuple[LoadOn, ...]) -> Expression | None:
    """Enter the moment about the pin that a slide's reaction has to balance, if there is any."""
    moment = moments(g.statics, loads, pin)
    return None if moment is None else g.q.define(ids.reaction_couple(digits), moment, scale=g.statics.torque)


def _offset(g: Group, digits: str) -> None:
    """Enter the distance x = M/R from the pin to the line of a slide's reaction; nan where R = 0 and M is a couple."""
    q, statics, size, moment = g.q, g.statics, g.q[ids.reaction(digits)], g.q.find(ids.reaction_couple(digits))
    values = q.value(size)
    written: Expression | None = None
    formula: Expression = quotient(0.0, size)
    if moment is not None and np.all(values[np.isfinite(values)] > CLEAR * statics.force):
        formula = moment / size
    elif moment is not None:
        couple = moment * sign(above(abs(moment), ZERO * statics.torque))
        formula = call("single", couple, above(size, ZERO * statics.force))
        written = call("single", moment, size)
    q.define(ids.application(digits), formula, scale=statics.span, written=written)


DYADS: Mapping[DyadKind, Callable[[Group], Polygon]] = {"RRR": _rrr, "RRP": _rrp, "RPR": _rpr, "PRP": _prp, "RPP": _rpp}


def driver(statics: Statics) -> Polygon:
    """Enter R01 and the balance `M.eq` of the driver under the groups' reactions and its own loads; return its plan."""
    machine = statics.scheme.linkage.driver
    own = tuple(sorted(statics.on(DRIVER), key=lambda load: load.origin is not Origin.reaction))
    if isinstance(machine, Crank):
        return _driving_crank(statics, machine.centre, own)
    return _driving_slide(statics, machine.pin, own)


def _driving_crank(statics: Statics, centre: str, own: tuple[LoadOn, ...]) -> Polygon:
    """Close the polygon with R01; moments about the centre give M_cb = −Σ R h μ_l."""
    total = moments(statics, own, centre)
    balance = 0.0 if total is None else -total
    statics.q.define("M.eq", balance, Symbol("M", "cb", "(1)"), scale=statics.torque)
    path = _laid(statics, own)
    force_plan(statics, "1", "R(1)", path)
    read(statics, "1", name="R01", symbol=Symbol("R", "01"), id="R.01", start=path.last, end=path.first)
    return Polygon("1", (*path.edges, Edge("R01", path.last, path.first, True, DRIVER)))


def _driving_slide(statics: Statics, pin: str, own: tuple[LoadOn, ...]) -> Polygon:
    """Close the polygon with R01 across the guide and the balancing force P_cb along it."""
    q, path = statics.q, _laid(statics, own)
    guide = q["guide.1"]
    force_plan(statics, "1", "R(1)", path, lambda at, μ: meet(at[path.last], turned(guide), 0.0, guide))
    read(statics, "1", name="R01", symbol=Symbol("R", "01"), id="R.01", start=path.last, end="n")
    read(statics, "1", name="Rcb", symbol=Symbol("P", "cb"), id="R.cb", start="n", end=path.first)
    along = sign(dot(q["F.Rcb"], q.construct("assumed.Rcb", guide)))
    q.define("M.eq", q["R.cb"] * along, Symbol("P", "cb", "(1)"), "force", scale=statics.force)
    total = moments(statics, own, pin)
    if total is not None:
        q.define("M.01", total, scale=statics.torque)
    unknown = (Edge("R01", path.last, "n", True, DRIVER), Edge("Rcb", "n", path.first, True, DRIVER))
    return Polygon("1", (*path.edges, *unknown))


def _laid(statics: Statics, own: tuple[LoadOn, ...]) -> ForceChain:
    path = ForceChain(statics.q)
    path.lay_loads(own)
    return path


def lever(statics: Statics, loads: tuple[LoadOn, ...]) -> None:
    """Enter Zhukovsky's lever: the velocity plan turned 90° against ω₁, every load at its image, balanced by M_cb.

    Σ F v cos α + M_cb ω₁ = 0 with v = μ_v · (segment) gives M_cb = −Σ F h′ μ_v/ω₁, where μ_v/ω₁ = μ_l if pa is the
    drawn crank; h′ is the signed arm of a load about the pole. For a sliding driver P_cb = −Σ F h′ μ_v/v_A. Enters
    the arms `h.X.p`, the contribution of each load, `M.X.p`, and `M.vw`.
    """
    q, turning = statics.q, isinstance(statics.scheme.linkage.driver, Crank)
    rate = q["omega.1"] if turning else q[ids.velocity(statics.scheme.linkage.driver.pin)]
    # Where pa is the drawn crank, μ_v/ω₁ is μ_l.
    per = q["mu.v"] / rate if q.families["mu.v"].definition is None else q["mu.l"]
    letter, kind, scale = ("M", "torque", statics.torque) if turning else ("P", "force", statics.force)
    parts: list[Expression] = []

    def contribute(id: str, index: str, amount: Expression, optional: bool = False) -> None:
        parts.append(q.define(id, amount, Symbol(letter, index), kind, scale=scale, optional=optional))

    for load in loads:
        omega, couple = _omega(statics, load.link), statics.couple(load)
        if not load.point:
            if omega is not None:
                power = load.size * omega
                contribute(ids.lever_moment(load.name), load.name, (power if statics.turn > 0 else -power) / rate)
            continue
        work: Expression = dot(statics.vector(load), statics.image("v", load.point))
        drawn: Expression = quotient(work, load.size)
        if couple is not None and omega is not None:
            drawn = drawn + statics.beside(load, load.size) * omega / q["mu.v"]
        arm = q.define(
            ids.lever_arm(load.name),
            statics.turn * drawn,
            Symbol("h", load.name, "′"),
            arm=True,
            of=load.name,
            about="p",
            scale=statics.span,
        )
        contribute(ids.lever_moment(load.name), load.name, load.size * arm * per)
        if couple is not None and omega is not None:
            alone = statics.turn * lone_couple(statics, load) * omega
            of_couple = f"M{load.letters.removeprefix('P')}"
            contribute(ids.lone_moment(load.name), of_couple, alone / rate, optional=True)
    balance = -Sum(tuple(parts)) if parts else 0.0
    q.define("M.vw", balance, Symbol(letter, "cb", "(2)"), kind, scale=scale)


def _omega(statics: Statics, link: int) -> Expression | None:
    """Return a link's signed angular velocity; None if it does not turn."""
    q = statics.q
    if ids.signed("omega", link) in q:
        return q[ids.signed("omega", link)]
    if link == DRIVER and statics.scheme.spins[DRIVER]:
        return q["omega.1"] if statics.turn > 0 else -q["omega.1"]
    return None
