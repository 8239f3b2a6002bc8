"""Views of Assur groups of class II for templates and figures, with the ids of their quantities.

Names of points are `NamedPoint`s, which templates print as symbols.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from reportgen.base.records import Record
from reportgen.base.template_access import template_members, view
from reportgen.derivation.equation_sides import Scheme, Side, image, sides
from reportgen.derivation.load_entries import Polygon
from reportgen.document.template_rendering import NamedPoint
from reportgen.formula import ids
from reportgen.formula.ids import Name
from reportgen.formula.ledger import Ledger
from reportgen.machine import Dyad, Guide
from reportgen.report.assur_view import AssurView
from reportgen.report.driver_view import DriverView, points_on


@view("base", "omega", "epsilon")
class CarriedPoint(Record):
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
class Contact(Record):
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
    *("form", "i", "j", "P", "Q", "T", "M", "one", "two", "sides", "relative", "rod", "drawn"),
    *("carrier", "outer", "inner", "guide", "across", "offset", "points_i", "points_j"),
    *("unknowns", "normal_by_segments", "under", "turning", "normals", "velocity_lines"),
    *("acceleration_lines", "carried", "relative_segment"),
    *("outer_lines", "guide_lines", "slot_lines", "reactions", "joints", "contacts"),
    *("last_of_j", "opposite"),
)
class GroupView(AssurView):
    """An Assur group of class II, a dyad, for templates.

    `i`, `j` are its links; `P`, `Q` the outer and the inner pin (A, B), `T` the outer pin of j ("" on a guide); `M` is
    the point whose motion the `Side`s `one` and `two` express; `relative` is MP as in v_BA and `rod` PQ; `outer`,
    `inner`, `guide` are the joints' digits as in R12, R32, R03, `across` those of R23 and `opposite` its size, if a
    line needs it; `carrier` is the link to which i is joined, `scale` the id of the scale of the force plan.
    """

    def __init__(self, dyad: Dyad, plan: Scheme, driver: DriverView, polygons: Iterable[Polygon], ledger: Ledger):
        self.i, self.j = i, j = dyad.links
        self.one, self.two = self.sides = sides(plan, dyad)
        super().__init__(dyad, [side for side in self.sides if side.turns], plan, driver, polygons, ledger)
        self.P = NamedPoint(dyad.start if isinstance(dyad.start, str) else dyad.middle)
        self.Q = NamedPoint(dyad.middle)
        self.T = NamedPoint(dyad.end if isinstance(dyad.end, str) else "")
        self.M, self.relative, self.rod = NamedPoint(self.one.point), self.one.relative, self.one.rod
        self.carrier, last = (end.link if isinstance(end, Guide) else plan.owner[end] for end in (dyad.start, dyad.end))
        self.outer, self.inner = ids.joint(self.carrier, i), ids.joint(j, i)
        self.guide, self.across = ids.joint(last, j), ids.joint(i, j)
        self.opposite = ledger.known([ids.reaction(self.across)])
        self.offset = dyad.kind == "RPR" and bool(dyad.lengths[1])
        self.points_i, self.points_j = (points_on(plan.linkage, link) for link in dyad.links)
        self.fixed = frozenset(plan.linkage.ground)
        self.by_crank = driver.kind == "crank" and all(ledger[ids.scale(what)].definition is not None for what in "va")

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

    @property
    def drawn(self) -> str:
        """Id of the drawn length of the rod."""
        return ids.drawn(self.rod)

    @property
    def relative_segment(self) -> str:
        """Id of the velocity plan's segment for the relative velocity of the rod's ends."""
        return ids.segment("v", image(self.P), image(self.Q))

    # --- what all kinds of groups have

    @property
    def carriers(self) -> tuple[int, ...]:
        """The link to which the group's first link is joined."""
        return (self.carrier,)

    @property
    def hung(self) -> tuple[tuple[int, NamedPoint], ...]:
        """The links of the group with their outer pins."""
        return (self.i, self.P), (self.j, self.T)

    @property
    def pins(self) -> tuple[NamedPoint, ...]:
        """The pins at the ends of its rods."""
        return self.P, self.Q

    @property
    def found_joints(self) -> tuple[NamedPoint, ...]:
        """The joints that the plans find."""
        return (self.M,)

    @property
    def rods(self) -> tuple[tuple[NamedPoint, NamedPoint], ...]:
        """The ends of its rods of constant length."""
        return ((self.P, self.Q), (self.T, self.Q)) if self.kind == "RRR" else ((self.P, self.Q),)

    @property
    def reaction_joints(self) -> tuple[str, ...]:
        """The digits of the reactions in its joints, in the order of tables."""
        return self.outer, self.inner, self.guide

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
        """Ids of the signed parts of reactions that moments give before the force plan."""
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
    def last_of_j(self) -> str:
        """The vertex of the force plan at which the known forces on link j end."""
        assert self.polygon is not None
        return self.polygon.reads[-1].end
