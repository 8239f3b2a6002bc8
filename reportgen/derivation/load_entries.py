"""Loads in the ledger: weights, inertia, applied forces and couples, reactions of later groups.

For a load X: `F.X` is its vector, the size has the id X itself (`P3`, `G2`, `Pqt2`; `R.42` for a reaction
R42), `couple.X` its couple if it has one, `h.X.D` its signed arm about a point D in metres on paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import IntEnum

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.base.records import Record
from reportgen.derivation.equation_sides import Scheme, image
from reportgen.derivation.kinematic_entries import NOWHERE, Sizes, longest
from reportgen.derivation.plan_scales import LEAST_FORCES, Scaling, extents, own_scales
from reportgen.formula import (
    Expression,
    Number,
    Ref,
    Sum,
    Symbol,
    call,
    cross,
    heading,
    ids,
    quotient,
    sign,
    turned,
    unit,
)
from reportgen.formula.calculation import Calculation
from reportgen.formula.evaluation import evaluate
from reportgen.formula.vocabulary import segment
from reportgen.machine import DRIVER, GROUND, Crank, Group, Guide, Inertia, Triad

FAINT = 1e-12
"""A reaction below this share of the loads is rounding and has no line of action."""

Applied = Mapping[str, tuple[int, str, Complexes | complex]]
"""Applied forces: id → (link, point, unit vector of the positive sense, at each position [N] or one for all)."""


class Origin(IntEnum):
    """Origin of a load, in the order in which a link's loads are drawn in its plan."""

    reaction = 0
    inertia = 1
    applied = 2
    weight = 3


class LoadOn(Record):
    """A load: its name, its link, its point of action ("" for a couple alone), its size, and its `letters` in symbols.

    `read_at` is the scale of the plan from which a force of another group was read.
    """

    name: str
    link: int
    point: str
    size: Ref
    origin: Origin
    letters: str = ""
    read_at: Ref | None = None


EnterGuide = Callable[["Statics", str, int], None]


class Statics(Record):
    """The calculation `q`, the linkage and the loads while reactions are entered group by group."""

    q: Calculation
    scheme: Scheme
    turn: int
    sizes: Sizes
    loads: tuple[LoadOn, ...] = ()
    scales: Scaling = own_scales
    guides: tuple[EnterGuide, ...] = ()
    """Functions by which topics enter quantities of a slider in its guide, called with the digits of its reaction
    and its link.
    """

    @property
    def force(self) -> float:
        """The largest load (N); a load below a billionth of it is negligible."""
        sizes = (np.abs(self.q.value(load.size)) for load in self.loads if load.point)
        return max((float(size[np.isfinite(size)].max(initial=0.0)) for size in sizes), default=0.0)

    @property
    def span(self) -> float:
        """Reference size of arms (m on paper): the drawn crank, or the longest length with a sliding driver."""
        driver = self.scheme.linkage.driver
        if isinstance(driver, Crank):
            return self.q.si(ids.drawn(driver.centre, driver.pin))
        return longest(self.scheme.linkage) / self.q.si("mu.l")

    @property
    def torque(self) -> float:
        """The moment (N·m) of the largest load on the crank, or on the longest length with a sliding driver."""
        driver = self.scheme.linkage.driver
        return self.force * (driver.length if isinstance(driver, Crank) else longest(self.scheme.linkage))

    def on(self, link: int) -> tuple[LoadOn, ...]:
        """Return the loads of a link."""
        return tuple(load for load in self.loads if load.link == link)

    def image(self, what: str, name: str) -> Expression:
        """Return a point's image on the plan "v" or "a" (m on paper); 0, the pole, for a fixed point."""
        return NOWHERE if self.scheme.still(name) else self.q[ids.plan_point(what, image(name))]

    def vector(self, load: LoadOn) -> Ref:
        """Return the vector of a force (N)."""
        return self.q[ids.force_vector(load.name)]

    def couple(self, load: LoadOn) -> Ref | None:
        """Return the couple of a load (N·m); None if it has no couple."""
        return self.q.find(ids.couple(load.name))

    def beside(self, load: LoadOn, divisor: Expression) -> Expression:
        """Return the distance (m) by which a load is moved sideways for its couple, h = M/F, signed as the couple."""
        laid, couple = self.q.find(ids.beside(load.name)), self.couple(load)
        return laid or (Number(0.0) if couple is None else quotient(couple, divisor))


def enter_loads(statics: Statics, applied: Applied, torques: Mapping[str, int]) -> tuple[LoadOn, ...]:
    """Enter vectors of weights, inertia forces and applied forces; ids `G2`, `m.2` and those of `applied` exist.

    Inertia forces and couples follow from `m.k`, `J.k` and the acceleration plan: F = −m a_S, couple −J ε;
    both together are one force at arm h = M/F.  Loads of a link without mass are absent.  `torques` maps
    the id of a signed torque to its link.
    """
    q, linkage, loads = statics.q, statics.scheme.linkage, []
    for body in linkage.inertias:
        link, centre, name = body.link, body.centre, ids.weight(body.link)
        if body.mass > 0 and linkage.gravity:
            down = linkage.gravity / abs(linkage.gravity)
            downwards = q.give(ids.down(link), complex(down), "g", "ratio")
            q.construct(ids.force_vector(name), q[name] * downwards, of=name)
            loads.append(LoadOn(name, link, centre, q[name], Origin.weight, name))
        # A crank with its mass centre on the axis that turns evenly has no inertia load.
        idle = link == DRIVER and statics.scheme.still(centre) and ids.signed("eps", DRIVER) not in q
        if (body.mass > 0 or body.moment > 0) and not idle:
            loads.append(_inertia(statics, body))
    for name, (link, place, sense) in applied.items():
        # The machine has already entered the sense of a force along a guide, which is given by its angle.
        senses = np.atleast_1d(np.asarray(sense, dtype=complex))
        fixed = bool(np.all(senses == senses[0]))
        positive = q.find(ids.sense(name)) or q.give(ids.sense(name), senses[:1] if fixed else senses, name, "ratio")
        q.construct(ids.force_vector(name), q[name] * positive, of=name)
        loads.append(LoadOn(name, link, place, q[name], Origin.applied, name))
    loads += [LoadOn(name, link, "", q[name], Origin.applied) for name, link in torques.items()]
    return tuple(sorted(loads, key=lambda load: (load.link, load.origin)))


def _inertia(statics: Statics, body: Inertia) -> LoadOn:
    """Enter P_qt = m a_S against a_S, and M_qt = J ε against ε."""
    q, link, centre = statics.q, body.link, body.centre
    name = ids.inertia_force(link)
    nothing = statics.scheme.still(centre) or body.mass <= 0
    size = 0.0 if nothing else q[ids.mass(link)] * q[ids.acceleration(centre)]
    force = q.define(name, size, scale=body.mass * statics.sizes.acceleration)
    vector = Number(0.0) if nothing else -(q[ids.mass(link)] * q["mu.a"] * statics.image("a", centre))
    q.construct(ids.force_vector(name), vector, of=name)
    if ids.signed("eps", link) in q and body.moment > 0:
        J = q[ids.inertia(link)]
        couple = q.define(
            ids.inertia_couple(link),
            J * q[ids.angular_acceleration(link)],
            scale=body.moment * statics.sizes.rotation**2,
        )
        turning = q.construct(ids.couple(name), -(J * q[ids.signed("eps", link)]), of=couple.id)
        if not nothing:
            # M/P, written out of mass and acceleration: a quotient of two products has more figures than they print.
            written = J * q[ids.angular_acceleration(link)] / (q[ids.mass(link)] * q[ids.acceleration(centre)])
            e = q.define(ids.inertia_offset(link), couple / force, scale=1e-3, written=written)
            q.construct(ids.beside(name), quotient(turning, force), of=e.id)
            _centre_of_percussion(statics, link, centre)
    return LoadOn(name, link, centre, force, Origin.inertia, name)


def _centre_of_percussion(statics: Statics, link: int, centre: str) -> None:
    """Enter the distance l_SK = J/(m l_AS) of the centre of percussion from S, on a link that turns about a pin A."""
    q = statics.q
    driver = statics.scheme.linkage.driver
    ends: dict[int, str | Guide] = {DRIVER: driver.centre} if isinstance(driver, Crank) else {}
    ends |= {
        moved: end
        for dyad in statics.scheme.linkage.dyads
        for moved, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
    }
    ends |= {leg.link: leg.outer for triad in statics.scheme.linkage.triads for leg in triad.legs}
    start = ends.get(link)
    if start is None:
        return
    arm = ids.length(start, centre)
    if isinstance(start, str) and arm in q and q.si(arm) > 0:
        q.define(ids.percussion(centre, link), q[ids.inertia(link)] / (q[ids.mass(link)] * q[arm]))


def _outer_joints(group: Group) -> Iterator[tuple[int, str | Guide, str]]:
    """Yield the links of a group that hang on others, with their outer joint or guide, and the point of that joint."""
    if isinstance(group, Triad):
        yield from ((leg.link, leg.outer, leg.outer) for leg in group.legs)
        return
    for link, outer in zip(group.links, (group.start, group.end), strict=True):
        yield link, outer, outer if isinstance(outer, str) else group.middle


def carried_reactions(statics: Statics, links: tuple[int, ...]) -> tuple[LoadOn, ...]:
    """Enter the reactions of later groups on these links as loads, R42 = −R24; return them in the order of assembly."""
    q, loads = statics.q, []
    for group in statics.scheme.linkage.groups:
        for link, outer, place in _outer_joints(group):
            carrier = outer.link if isinstance(outer, Guide) else statics.scheme.owner[outer]
            if carrier == GROUND or carrier not in links:
                continue
            here, there = ids.joint(link, carrier), ids.joint(carrier, link)
            loads.append(opposite(q, here, there, carrier, place, ids.members(group.links)))
            if ids.reaction_couple(there) in q:
                q.construct(ids.couple(ids.reaction_force(here)), q[ids.reaction_couple(there)])
    return tuple(loads)


def opposite(q: Calculation, here: str, there: str, link: int, point: str, plan: str) -> LoadOn:
    """Enter a reaction from a group's plan as the opposite load on the other link, and return it: R42 = −R24."""
    size = q.define(ids.reaction(here), q[ids.reaction(there)], scale=q.families[ids.reaction(there)].scale)
    q.construct(ids.force_vector(ids.reaction_force(here)), -q[ids.force_vector(ids.reaction_force(there))], of=size.id)
    read_at = q[ids.force_scale(plan)]
    return LoadOn(ids.reaction_force(here), link, point, size, Origin.reaction, letters=here, read_at=read_at)


# --- moments --------------------------------------------------------------------------------------


def _divisor(statics: Statics, load: LoadOn) -> Expression:
    """Return the size of a load; 0 where a reaction with a couple is only a rounding error."""
    if load.origin is Origin.reaction and statics.couple(load) is not None:
        return above(load.size, FAINT * statics.force)
    return load.size


def above(size: Expression, floor: float) -> Expression:
    """Return a size (SI), 0 where it does not exceed `floor` (SI)."""
    return size * sign(call("max", 0.0, size - floor))


def arm(statics: Statics, load: LoadOn, centre: str) -> Ref:
    """Enter the signed arm (m on paper) of a load about a point, h = M/(F μ_l), its couple included, and return it."""
    q, couple = statics.q, statics.couple(load)
    moment = cross(q[ids.place(load.point)] - q[ids.place(centre)], statics.vector(load))
    divisor = _divisor(statics, load)
    drawn: Expression = quotient(moment, divisor) / q["drawing"]
    if couple is not None:
        drawn = drawn + statics.beside(load, divisor) / q["mu.l"]
    id, letters = ids.arm(load.name, centre), Symbol("h", load.letters)
    return q.define(id, drawn, letters, arm=True, of=load.name, about=centre, scale=statics.span)


def moment_terms(statics: Statics, loads: Iterable[LoadOn], centre: str) -> tuple[list[Expression], list[Expression]]:
    """Return the products of forces and their arms about a point, and the couples (N·m)."""
    terms: list[Expression] = []
    couples: list[Expression] = []
    for load in loads:
        couple = statics.couple(load)
        if not load.point:
            couples.append(load.size)
        elif load.point != centre or couple is not None:
            terms.append(load.size * arm(statics, load, centre))
            if couple is not None:
                couples.append(lone_couple(statics, load))
    return terms, couples


def moments(statics: Statics, loads: Iterable[LoadOn], centre: str) -> Expression | None:
    """Return the sum of moments (N·m) about a point as it is printed: (ΣF·h)·μ_l, and couples; None without moments."""
    terms, couples = moment_terms(statics, loads, centre)
    if not terms:
        return Sum(tuple(couples)) if couples else None
    turned = Sum(tuple(terms)) * statics.q["mu.l"]
    return Sum((turned, *couples)) if couples else turned


def lone_couple(statics: Statics, load: LoadOn) -> Expression:
    """Return the couple (N·m) of a load at positions where its force is zero; other positions leave out the term."""
    q, id, couple = statics.q, ids.lone_couple(load.name), statics.couple(load)
    assert couple is not None
    if id not in q:
        letters = load.letters.removeprefix("P")
        alone = call("if_zero", _divisor(statics, load), couple)
        q.define(id, alone, Symbol("M", letters), "torque", optional=True)
    return Sum((q[id],))  # a separate term, so that it can be left out


def tangential(statics: Statics, link: int, digits: str, rod: tuple[str, str], loads: tuple[LoadOn, ...]) -> Ref:
    """Enter the moments of a rod about its inner joint: Rᵗ l = ΣM, positive along the rod turned by 90°.

    `rod` are its outer and inner joint. Return Rᵗ.
    """
    q, length = statics.q, statics.q[ids.length(*rod)]
    moment = moments(statics, loads, rod[1])
    size = q.define(ids.reaction(digits, "t"), 0.0 if moment is None else moment / length, scale=statics.force)
    assumed = q.construct(ids.assumed(ids.reaction_force(digits, "t")), turned(unit(q[ids.rod(link)])))
    q.construct(ids.force_vector(ids.reaction_force(digits, "t")), size * assumed, of=size.id)
    return size


# --- force plans ----------------------------------------------------------------------------------
# Vertices head to tail, a scale for each position, forces read between vertices.

LETTERS = "efghijklmqrtuvwxyzabcd"
"""Vertices of a force plan in the order of drawing; n is where the unknown edges meet."""


class Edge(Record):
    """One force on a `link` in a polygon, from vertex to vertex; closing the polygon gives the `unknown` edges."""

    name: str
    start: str
    end: str
    unknown: bool = False
    link: int = 0

    @property
    def is_reaction(self) -> bool:
        """True for a reaction or a component of one."""
        return self.name in ids.reaction_force

    @property
    def part(self) -> str:
        """The component of a reaction, n or t, "" for a whole force."""
        read = ids.reaction_force.read(self.name)
        return read["part"] if read else ""


class Polygon(Record):
    """A group's force plan: its edges head to tail and the joints read from it.

    `reads` are further vectors read between vertices, e.g. the reaction in the inner joint.
    """

    name: str
    edges: tuple[Edge, ...]
    reads: tuple[Edge, ...] = ()

    @property
    def carried(self) -> tuple[Edge, ...]:
        """The reactions of groups solved before on the links of this group."""
        return tuple(edge for edge in self.edges if edge.is_reaction and not edge.unknown and not edge.part)


class ForceChain:
    """The known forces of a plan laid head to tail from vertex e."""

    def __init__(self, q: Calculation) -> None:
        self._q = q
        self._letters = iter(LETTERS)
        self.first = self.last = next(self._letters)
        self.corners: dict[str, Expression] = {self.first: Number(0.0)}
        self.edges: list[Edge] = []
        self.read_at: list[Ref] = []

    def lay_loads(self, loads: Iterable[LoadOn]) -> None:
        """Append the forces among some loads to the last vertex; couples alone are skipped."""
        for load in loads:
            if load.point:
                self.lay(load.name, load.link)
                self.read_at += [load.read_at] if load.read_at else []

    def lay(self, name: str, link: int) -> None:
        """Append the force `F.name` on a link to the last vertex."""
        letter = next(self._letters)
        self.corners[letter] = self.corners[self.last] + self._q[ids.force_vector(name)]
        self.edges.append(Edge(name, self.last, letter, link=link))
        self.last = letter


Closing = Callable[[Mapping[str, Expression], Expression], Expression]
"""Function that returns the meeting point of the unknown edges, from the vertices of the known ones and their scale."""


def force_plan(statics: Statics, name: str, title: str, path: ForceChain, closing: Closing | None = None) -> None:
    """Choose μ_R [N] so that the plan of each position fills its space; lay the known forces and close the plan at n.

    Enters the drawn lengths of the known forces and, in metres on paper, the forces as they are laid (`laid.23.P3`) and
    the vertices.  Without `closing`, the plan has no vertex n.
    """
    q = statics.q
    corners = path.corners | ({} if closing is None else {"n": closing(path.corners, Number(1.0))})
    values = {id: family.values for id, family in q.families.items()}
    sizes = extents([np.asarray(evaluate(corner, values)) for corner in corners.values()], q.positions)
    scales = statics.scales(sizes, LEAST_FORCES, [q.value(one) for one in path.read_at])
    μ = q.give(ids.force_scale(name), scales, Symbol("μ", title))
    vertices: dict[str, Expression] = {path.first: q.construct(ids.force_corner(name, path.first), Number(0.0))}
    for edge in path.edges:
        laid = q.construct(ids.laid_force(name, edge.name), q[ids.force_vector(edge.name)] / μ)
        letters = segment(edge.start, edge.end)
        q.define(
            ids.force_segment(name, edge.name), abs(laid), letters, scale=LEAST_FORCES, of=ids.force_vector(edge.name)
        )
        vertices[edge.end] = q.construct(ids.force_corner(name, edge.end), vertices[edge.start] + laid)
    if closing is not None:
        q.construct(ids.force_corner(name, "n"), closing(vertices, μ))


def read(statics: Statics, plan: str, name: str, symbol: Symbol, id: str, start: str, end: str) -> None:
    """Enter a force read from a plan between two vertices: its segment, its size, its vector and its direction."""
    q, scale = statics.q, statics.force
    μ, along = q[ids.force_scale(plan)], q[ids.force_corner(plan, end)] - q[ids.force_corner(plan, start)]
    drawn = q.define(
        ids.force_segment(plan, name), abs(along), segment(start, end), scale=LEAST_FORCES, of=ids.force_vector(name)
    )
    q.define(id, μ * drawn, symbol, scale=scale)
    vector = q.construct(ids.force_vector(name), μ * along, of=id)
    q.define(ids.force_direction(name), heading(vector), Symbol("α", symbol.sub), scale=1.0, of=id)
