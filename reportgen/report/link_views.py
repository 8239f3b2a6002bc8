"""Views of a machine's driver, groups, links and points for templates and figures, with the ids of their quantities.

Names of points are `NamedPoint`s, which templates print as symbols.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from reportgen.base.template_access import template_members, view
from reportgen.derivation.equation_sides import Scheme, Side, image, sides
from reportgen.derivation.load_entries import Polygon
from reportgen.document.template_rendering import NamedPoint
from reportgen.formula import ids, refs
from reportgen.formula.ids import Name
from reportgen.formula.ledger import Ledger
from reportgen.machine import DRIVER, Crank, Dyad, Guide, Inertia, Linkage, Mobility
from reportgen.machine.analysis import Machine, Position
from reportgen.machine.loads import Applied, Torque

# These classes belong to packages without templates, so their members are registered here.
template_members("__str__")(Position)
template_members("applied", "torques", "linkage", "sliders")(Machine)
template_members("inertias")(Linkage)
template_members("link", "centre")(Inertia)
template_members("n", "lower_pairs", "W", "higher_pairs", "passive", "redundant")(Mobility)
template_members("name", "link", "point")(Applied)
template_members("name", "link")(Torque)
view("turns", "way", "state", "guided", "relative", "rod", "known", "omega", "part", "pair", "velocity")(Side)
template_members("carried")(Polygon)


@template_members("__str__", "name", "link")
@dataclass(frozen=True, slots=True)
class PointView:
    """A named point on a link, such as a mass centre."""

    name: NamedPoint
    link: int

    def __str__(self) -> str:
        return self.name


def points_on(linkage: Linkage, link: int) -> tuple[PointView, ...]:
    """Return the named points of a link."""
    return tuple(PointView(NamedPoint(place.name), link) for place in linkage.points if place.link == link)


@template_members(
    *("centre", "pin", "others", "names", "arm", "kind", "rate", "drawn", "velocity"),
    *("velocity_segment", "acceleration_segment", "round_velocity", "round_acceleration"),
    *("velocity_lines", "acceleration_lines", "scale_lines"),
    *("rate2", "accelerated", "normal_segment", "component_lines", "component_segments"),
    *("component_scale_lines", "acceleration_scale_lines"),
)
class DriverView:
    """The driver for templates: its centre O1 and pin A, its `arm` O1A, and further points on it.

    `kind` is "crank" or "slide"; a slide has neither centre nor arm.  `rate` is the symbol of its speed, `rate2` that
    of its acceleration if it is `accelerated`.  `component_lines` are the two components of the crank pin's
    acceleration.  `round_velocity` and `round_acceleration` are True if the scale of a plan was chosen from the series
    of round scales.
    """

    def __init__(self, linkage: Linkage, ledger: Ledger) -> None:
        moved = linkage.driver
        self.centre = NamedPoint(moved.centre if isinstance(moved, Crank) else "")
        self.pin = NamedPoint(moved.pin)
        self.others = points_on(linkage, DRIVER)
        self.names = (self.pin, *(place.name for place in self.others))
        self.arm = f"{self.centre}{self.pin}" if self.centre else ""
        self.kind = "crank" if self.centre else "slide"
        self.rate = ledger.symbol("omega.1" if self.centre else ids.velocity(self.pin))
        self.drawn, self.velocity = ids.drawn(self.arm), ids.velocity(self.pin)
        self.velocity_segment, self.acceleration_segment = (ids.segment(what, "p", image(self.pin)) for what in "va")
        self.round_velocity, self.round_acceleration = (ledger[ids.scale(what)].definition is None for what in "va")
        self.velocity_lines, self.acceleration_lines = (
            [id for name in self.names if (id := rate(name)) in ledger] for rate in ids.POINT_RATE.values()
        )
        self.scale_lines = [self.velocity, "mu.v", self.velocity_segment]
        faster = ids.angular_acceleration(DRIVER) if self.centre else ids.acceleration(self.pin)
        self.accelerated = faster in ledger and bool(ledger[faster].values[0])
        self.rate2 = ledger.symbol(faster if self.accelerated else ids.velocity(self.pin))
        self.component_segments = [ids.relative_segment(part, self.pin) for part in "nt"]
        self.normal_segment, tangential = self.component_segments
        self.component_lines = ledger.known(ids.acceleration(self.pin, part) for part in "nt")
        self.component_scale_lines = ["mu.a", tangential]
        self.acceleration_scale_lines = ["mu.a", self.acceleration_segment]


@view("base", "omega", "epsilon")
@dataclass(frozen=True, slots=True)
class CarriedPoint:
    """A point of a link that turns about `origin`, without a separate segment on the plan.

    `relative` is its name with that of the origin, e.g. S2B.  `still` is True if the origin is fixed to the frame,
    `swings` if the link has an angular acceleration.
    """

    name: NamedPoint
    link: int
    origin: NamedPoint
    relative: str
    still: bool
    swings: bool

    @property
    def base(self) -> str:
        return self.origin

    @property
    def omega(self) -> str:
        return ids.angular_velocity(self.link)

    @property
    def epsilon(self) -> str:
        return ids.angular_acceleration(self.link)


@view("reaction", "lines")
@dataclass(frozen=True, slots=True)
class Contact:
    """The reaction `digits` of a slide on `link`.

    `moment` and `place` are the ids of the reaction's moment about the pin and of its distance from the pin; `moments`
    are the lines that give this moment.
    """

    digits: str
    pin: NamedPoint
    link: int
    moment: str
    place: str
    moments: list[str]
    displaced: bool
    """True if other forces have a moment about the pin, so that the reaction may act beside it."""

    @property
    def reaction(self) -> str:
        return ids.reaction(self.digits)

    @property
    def lines(self) -> list[str]:
        """Ids of the worked lines for the moment and the place."""
        return [*self.moments, self.place]


@template_members(
    *("__str__", "kind", "form", "i", "j", "P", "Q", "T", "M", "one", "two", "sides", "relative", "rod", "drawn"),
    *("carrier", "outer", "inner", "guide", "across", "name", "scale", "offset", "points_i", "points_j", "points"),
    *("unknowns", "normal_by_segments", "moving", "under", "turning", "normals", "velocity_lines"),
    *("acceleration_lines", "carried", "similar", "relative_segment"),
    *("polygon", "outer_lines", "guide_lines", "slot_lines", "reactions", "joints", "contacts", "across_by_moments"),
    *("pulls_across", "components", "last_known", "last_of_j", "opposite"),
)
class GroupView:
    """An Assur group for templates.

    `i`, `j` are its links; `P`, `Q` the outer and the inner pin (A, B), `T` the outer pin of j ("" on a guide); `M` is
    the point whose motion the `Side`s `one` and `two` express; `relative` is MP as in v_BA and `rod` PQ; `outer`,
    `inner`, `guide` are the joints' digits as in R12, R32, R03, `across` those of R23 and `opposite` its size, if a
    line needs it; `carrier` is the link to which i is joined, `scale` the id of the scale of the force plan.
    """

    def __init__(self, dyad: Dyad, plan: Scheme, driver: DriverView, polygons: Iterable[Polygon], ledger: Ledger):
        self.kind, (self.i, self.j), self.ledger = dyad.kind, dyad.links, ledger
        i, j = dyad.links
        self.one, self.two = self.sides = sides(plan, dyad)
        self.P = NamedPoint(dyad.start if isinstance(dyad.start, str) else dyad.middle)
        self.Q = NamedPoint(dyad.middle)
        self.T = NamedPoint(dyad.end if isinstance(dyad.end, str) else "")
        self.M, self.relative, self.rod = NamedPoint(self.one.point), self.one.relative, self.one.rod
        self.carrier, last = (end.link if isinstance(end, Guide) else plan.owner[end] for end in (dyad.start, dyad.end))
        self.outer, self.inner = ids.joint(self.carrier, i), ids.joint(j, i)
        self.guide, self.across = ids.joint(last, j), ids.joint(i, j)
        self.name, self.opposite = ids.joint(i, j), ledger.known([ids.reaction(self.across)])
        self.scale = ids.force_scale(self.name)
        self.offset = dyad.kind == "RPR" and bool(dyad.lengths[1])
        self.points_i, self.points_j = (points_on(plan.linkage, link) for link in dyad.links)
        self.points = (*self.points_i, *self.points_j)
        self.polygon = next((polygon for polygon in polygons if polygon.name == self.name), None)
        self.fixed, self.on_driver = frozenset(plan.linkage.ground), frozenset(driver.names)
        self.by_crank = driver.kind == "crank" and all(ledger[ids.scale(what)].definition is not None for what in "va")

    def __str__(self) -> str:
        return self.name

    # --- plans of velocity and acceleration

    @property
    def form(self) -> str:
        """Key of the phrases for its plans: its kind, or "RRP-moving" for an RRP with a moving guide."""
        return "RRP-moving" if self.kind == "RRP" and not self.two.still else self.kind

    @property
    def unknowns(self) -> tuple[str | Side, str | Side]:
        """The two velocities of unknown magnitude in the vector equation: points, relative velocities, sides."""
        first, second = (self.M if side.still else side.relative for side in self.sides)
        if self.kind == "RPR":
            return self.one, second
        if self.kind != "RRP":
            return first, second
        along = self.Q if self.two.still or self.one.still else self.two.relative
        return along, self.two.relative if self.one.still else self.relative

    @property
    def normal_by_segments(self) -> bool:
        """Return True if plans at the crank's scales give the normal acceleration of an RRP by segments."""
        return self.by_crank and not self.one.still

    @property
    def moving(self) -> tuple[Side, ...]:
        """The sides with a moving base."""
        return tuple(side for side in self.sides if not side.still)

    @property
    def under(self) -> tuple[Side, ...]:
        """The sides over a moving guide: their base is the guide's point under M."""
        return tuple(side for side in self.moving if side.guided)

    @property
    def turning(self) -> tuple[Side, ...]:
        """The sides with a Coriolis acceleration."""
        return tuple(side for side in self.sides if side.turning)

    @property
    def normals(self) -> list[str]:
        """Ids of the known relative accelerations and their segments, which are calculated before the plan."""
        known = [side for side in self.sides if side.part]
        return [id for side in known for id in (ids.acceleration(side.relative, side.part), side.known)]

    @property
    def velocity_lines(self) -> list[str]:
        """Ids of the lines that the velocity plan gives: points, relative velocities, rotations."""
        return self._in_order(
            *(ids.velocity(side.base) for side in self.under),
            ids.velocity(self.M),
            *(side.velocity for side in self.sides),
            ids.velocity(self.Q),
            *self._point_lines(ids.velocity),
            *self._measured(),
            ids.angular_velocity(self.i),
            ids.angular_velocity(self.j),
        )

    @property
    def acceleration_lines(self) -> list[str]:
        """Ids of the lines that the acceleration plan gives."""
        return self._in_order(
            *(ids.acceleration(side.base) for side in self.under),
            ids.acceleration(self.M),
            *(ids.acceleration(side.relative, side.sought) for side in self.sides),
            ids.acceleration(self.Q),
            *self._point_lines(ids.acceleration, "n", "t"),
            ids.angular_acceleration(self.i),
            ids.angular_acceleration(self.j),
        )

    def _in_order(self, *quantities: str) -> list[str]:
        """Return the ids that exist, each after those that its definition refers to."""
        known = self.ledger.known(quantities)
        ordered: dict[str, None] = {}

        def put(id: str) -> None:
            if id in ordered:
                return
            definition = self.ledger[id].definition
            for source in refs(definition) if definition is not None else ():
                if source in known:
                    put(source)
            ordered[id] = None

        for id in known:
            put(id)
        return list(ordered)

    def _point_lines(self, rate: Name, *parts: str) -> Iterator[str]:
        for place in self.points:
            relative = f"{place.name}{self._origin(place.link)}"
            yield from [rate(relative, part) for part in parts] or [rate(relative)]
            yield rate(place.name)

    def _measured(self) -> list[str]:
        """Return the ids of the lengths that change and are measured on the position plan."""
        rods = [side.rod for side in self.sides if side.measured]
        return [name(rod) for rod in rods for name in (ids.drawn, ids.length)]

    def _origin(self, link: int) -> NamedPoint:
        """Return the joint from which the points of a link are measured."""
        return self.P if link == self.i else self.T or self.Q

    @property
    def carried(self) -> list[CarriedPoint]:
        """Points without similarity, as on a block: they turn about a joint with the link."""
        points = []
        for place in self.points:
            origin = self._origin(place.link)
            relative = f"{place.name}{origin}"
            if ids.velocity(relative) in self.ledger:
                swings, still = ids.acceleration(relative, "t") in self.ledger, origin in self.fixed
                points.append(CarriedPoint(place.name, place.link, origin, relative, still, swings))
        return points

    def similar(self, what: str) -> list[str]:
        """Return the ids of a link's segment ab and of those that similarity gives: as₂, be."""
        segments: list[str] = []
        for place in self.points:
            for side in self.sides:
                if side.turns and side.link == place.link:
                    ends = "p" if side.still else image(side.base), image(self.M)
                    segments += [ids.segment(what, *ends), *(ids.segment(what, end, image(place.name)) for end in ends)]
        return self.ledger.known(segments)

    def base(self, what: str, side: Side, k: int) -> str:
        """Return the place of a base's vector on the plan: at the "pole", "drawn" before, or "new"."""
        if self.ledger.number(self.base_segment(what, side), k).value == 0:
            return "pole"
        return "new" if side.guided or side.base in self.on_driver else "drawn"

    def base_segment(self, what: str, side: Side) -> str:
        """Return the id of the plan's segment for the velocity or acceleration of a side's base."""
        return ids.segment(what, "p", image(side.base))

    @property
    def drawn(self) -> str:
        """Id of the drawn length of the rod."""
        return ids.drawn(self.rod)

    @property
    def relative_segment(self) -> str:
        """Id of the velocity plan's segment for the relative velocity of the rod's ends."""
        return ids.segment("v", image(self.P), image(self.Q))

    # --- forces

    def arms(self, about: str, link: int) -> list[str]:
        """Return the ids of the arms about a point for the known loads on a link of the group."""
        if self.polygon is None:
            return []
        known = [(edge.name, edge.link) for edge in self.polygon.edges if not edge.unknown]
        known.append((ids.reaction_force(self.across), self.j))
        return self.ledger.known(ids.arm(name, about) for name, carrier in known if carrier == link)

    @property
    def outer_lines(self) -> list[str]:
        """Ids of the moments on link i about the inner pin, and of the component that they give in its outer joint."""
        return [*self.arms(self.Q, self.i), ids.reaction(self.outer, "t")]

    @property
    def guide_lines(self) -> list[str]:
        """Ids of the moments on link j about the inner pin, and of the component that they give in its outer joint."""
        return [*self.arms(self.Q, self.j), ids.reaction(self.guide, "t")]

    @property
    def slot_lines(self) -> list[str]:
        """Ids of the moments on a slotted link about its outer pin, and of the block's reaction that they give."""
        H = f"H{self.j}"
        foot = [ids.drawn(H, self.Q), ids.length(H, self.Q)] if self.offset else []
        return [*self.arms(self.T, self.j), *foot, ids.reaction(self.across, "s")]

    @property
    def reactions(self) -> list[str]:
        """Ids of the reactions measured on the force plan, in the order of construction."""
        joints = {
            "RRR": ((self.outer, "n"), (self.guide, "n"), (self.outer,), (self.guide,), (self.inner,)),
            "RRP": ((self.outer, "n"), (self.guide,), (self.outer,), (self.inner,)),
            "RPR": ((self.guide,), (self.outer,), (self.inner,)),
            "PRP": ((self.outer,), (self.guide,), (self.inner,)),
            "RPP": ((self.inner,), (self.guide,), (self.outer,)),
        }
        return [ids.reaction(*joint) for joint in joints[self.kind]]

    @property
    def joints(self) -> tuple[str, str, str]:
        """The digits of the reactions in the two outer joints and in the inner one."""
        return self.outer, self.guide, self.inner

    @property
    def contacts(self) -> list[Contact]:
        """The reactions of slides, whose place on the slide is unknown."""
        first, last = (self.inner, self.P, self.i), (self.guide, self.Q, self.j)
        slides = {"RRP": [last], "RPR": [first], "PRP": [(self.outer, self.Q, self.i), last], "RPP": [first, last]}
        return [self._contact(*slide) for slide in slides.get(self.kind, [])]

    def _contact(self, digits: str, pin: NamedPoint, link: int) -> Contact:
        moment, arms = ids.reaction_couple(digits), self.arms(pin, link)
        displaced = moment in self.ledger and self.ledger[moment].definition is not None
        moments = [*arms, moment] if displaced else arms
        return Contact(
            digits=digits,
            pin=pin,
            link=link,
            moment=moment,
            place=ids.application(digits),
            moments=moments,
            displaced=displaced,
        )

    @property
    def by_moments(self) -> list[str]:
        """Ids of the signed components that equilibrium of moments gives."""
        return [*self.tangential, *self.ledger.known([ids.reaction(self.across, "s")])]

    @property
    def across_by_moments(self) -> bool:
        """Return True if moments give the whole force between the links; the plan then treats it as a load."""
        return ids.reaction(self.across, "s") in self.ledger

    @property
    def tangential(self) -> list[str]:
        """Ids of the components across links that moments give."""
        return self.ledger.known((ids.reaction(self.outer, "t"), ids.reaction(self.guide, "t")))

    @property
    def pulls_across(self) -> bool:
        """Return True if a tangential component is not zero at some position, so that tables have a column for it."""
        return any(self.ledger[id].values.any() for id in self.tangential)

    def components(self, k: int) -> list[str]:
        """Return the ids of the components that moments give before the plan; [] if all of them are zero."""
        components = self.by_moments
        return components if any(self.ledger.number(id, k).value != 0 for id in components) else []

    @property
    def last_known(self) -> str:
        """The vertex of the force plan at which the known forces end."""
        assert self.polygon is not None
        return self.polygon.edges[-2].start

    @property
    def last_of_j(self) -> str:
        """The vertex of the force plan at which the known forces on link j end."""
        assert self.polygon is not None
        return self.polygon.reads[-1].end


@view("force", "couple")
@dataclass(frozen=True, slots=True)
class BodyView:
    """A link with an inertia couple: its number, mass centre, the pin from which it is measured, the ids to show."""

    link: int
    centre: NamedPoint
    start: NamedPoint
    ids: list[str]
    still: bool
    """True if that pin is fixed to the frame."""

    @property
    def force(self) -> str:
        return ids.inertia_force(self.link)

    @property
    def couple(self) -> str:
        return ids.inertia_couple(self.link)


@template_members(
    *("__str__", "link", "rod", "group", "base", "point", "omega", "velocities", "rates"),
    *("distances", "angles", "projections"),
)
class PlaneLink:
    """A link in plane motion: its number, two points with drawn velocities, their `rod`, and its `group`.

    The other members are ids of the quantities in the section on instant centres.
    """

    def __init__(self, turn: Side, group: str) -> None:
        self.link, self.rod, self.group = turn.link, turn.rod, group
        self.base, self.point = NamedPoint(turn.base), NamedPoint(turn.point)
        self.omega = ids.angular_velocity(self.link)
        self.velocities = [ids.velocity(point) for point in (self.base, self.point)]
        self.rates = [ids.centre_omega(self.link), ids.centre_velocity(self.link)]
        self.distances, self.angles, self.projections = (
            [name(self.link, point) for point in (self.base, self.point)]
            for name in (ids.centre_distance, ids.rod_angle, ids.projection)
        )

    def __str__(self) -> str:
        return str(self.link)


def displaced_inertia(linkage: Linkage, groups: Iterable[GroupView], ledger: Ledger) -> tuple[BodyView, ...]:
    """Return the links whose inertia is a force and a couple, which a single force off the mass centre replaces."""
    # A block turns about no base of a plan: the pin it sits on is its first joint.
    starts = {group.i: group.P for group in groups}
    starts |= {side.link: NamedPoint(side.base) for group in groups for side in group.sides if side.turns}
    if isinstance(linkage.driver, Crank):
        starts[DRIVER] = NamedPoint(linkage.driver.centre)
    bodies = []
    for body in linkage.inertias:
        known = ledger.known((ids.inertia_offset(body.link), ids.percussion(body.centre, body.link)))
        if len(known) == 2:
            start = starts[body.link]
            bodies.append(BodyView(body.link, NamedPoint(body.centre), start, known, start in linkage.ground))
    return tuple(bodies)
