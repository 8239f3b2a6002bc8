"""The view of an Assur group of class III for templates and figures, with its plans by a special point."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from reportgen.base.records import Record
from reportgen.base.template_access import template_members, view
from reportgen.catalogue import ternary_ids
from reportgen.derivation.equation_sides import Scheme, Side
from reportgen.derivation.load_entries import Polygon
from reportgen.derivation.triad_motion import entered_point
from reportgen.document.template_rendering import NamedPoint
from reportgen.formula import ids
from reportgen.formula.ledger import Ledger
from reportgen.machine import Triad, TriadLeg
from reportgen.report.assur_view import AssurView
from reportgen.report.driver_view import DriverView

WHOLE = 1e-6
"""Difference from a whole number of degrees that rounding in radians does not reach."""


@view("P", "Q", "rod")
class LegView(Record):
    """A leg of a triad: its `link` from the outer joint P to the joint Q on the plate.

    `side` is the motion of Q about P.  `outer` and `inner` are the digits of the reactions on the leg in P and Q.
    `special` is the motion of the special point about P, `across` that about Q.
    """

    link: int
    side: Side
    special: Side
    across: Side
    outer: str
    inner: str
    carrier: int
    lines: list[str]
    """Ids of the arms of the moments about Q, and of the component that they give in P."""

    @property
    def P(self) -> NamedPoint:
        return NamedPoint(self.side.base)

    @property
    def Q(self) -> NamedPoint:
        return NamedPoint(self.side.point)

    @property
    def rod(self) -> str:
        return self.side.rod


@template_members(
    *("form", "S", "pair", "third", "first", "last", "legs", "about", "pivoted", "normals", "later_normals"),
    *("velocity_lines", "acceleration_lines", "axial_lines", "reactions", "joints", "others", "later", "feet"),
    *("seen", "towards_third", "joint", "read_finely"),
)
class TriadView(AssurView):
    """An Assur group of class III for templates.

    `S` is the special point, in which the lines of the legs `first` and `last` (the `pair`) meet; `about` is the motion
    of the joint of the `third` leg about S.  `pivoted` is True if both legs of the pair turn about fixed points.
    """

    bodies = "bodies-triad"

    def __init__(self, triad: Triad, plan: Scheme, driver: DriverView, polygons: Iterable[Polygon], ledger: Ledger):
        special = entered_point(ledger, plan, triad)
        self.S, plate = NamedPoint(special.name), triad.plate
        first, second, _ = triad.legs
        self.body = Side(second.inner, first.inner, False, first.inner, plate)
        still = plan.still

        def turn(leg: TriadLeg) -> Side:
            return Side(leg.inner, leg.outer, still(leg.outer), leg.outer, leg.link)

        super().__init__(triad, [self.body, *map(turn, triad.legs)], plan, driver, polygons, ledger)
        self.plate = plate

        def leg_view(leg: TriadLeg) -> LegView:
            carrier = plan.owner[leg.outer]
            outer = ids.joint(carrier, leg.link)
            return LegView(
                leg.link,
                turn(leg),
                special=Side(self.S, leg.outer, still(leg.outer), leg.outer, plate),
                across=Side(self.S, leg.inner, False, leg.inner, plate),
                outer=outer,
                inner=ids.joint(plate, leg.link),
                carrier=carrier,
                lines=[*self.arms(leg.inner, [leg.link]), ids.reaction(outer, "t")],
            )

        self.legs = tuple(map(leg_view, triad.legs))
        by_link = {leg.link: leg for leg in self.legs}
        self.first, self.last = self.pair = tuple(by_link[leg.link] for leg in special.pair)
        self.third = by_link[special.third.link]
        self.about = Side(self.third.Q, self.S, False, self.S, plate)
        self.pivoted = all(leg.side.still for leg in self.pair)

    @property
    def form(self) -> str:
        """Key of the phrases for its plans."""
        return self.kind

    # --- plans of velocity and acceleration

    @property
    def moving(self) -> tuple[Side, ...]:
        """The sides of the pair with a moving outer joint."""
        return tuple(leg.side for leg in self.pair if not leg.side.still)

    @property
    def later(self) -> tuple[Side, ...]:
        """The side of the third leg if its outer joint moves."""
        return () if self.third.side.still else (self.third.side,)

    @property
    def others(self) -> tuple[NamedPoint, ...]:
        """The joints on the plate that follow by similarity."""
        return tuple(leg.Q for leg in self.pair)

    @property
    def feet(self) -> str:
        """The numbers of its legs."""
        return ", ".join(str(leg.link) for leg in self.legs)

    @property
    def joint(self) -> str:
        """The joint of the third leg of the file, whose template curve assembles the group."""
        return self.legs[2].Q

    def read_finely(self, k: int) -> bool:
        """Return True if the iteration begins with angles read more finely than to a degree at a position."""
        first, plate = (ternary_ids.trial_angle(0, link) for link in (self.legs[0].link, self.plate))
        return any(abs(np.sin(np.pi * np.degrees(self.ledger[id].at(k)))) > WHOLE for id in (first, plate))

    @property
    def seen(self) -> tuple[NamedPoint, ...]:
        """The special point and the joints of the plate, whose figure the plans show again."""
        return (self.S, self.third.Q, *self.others)

    @property
    def towards_third(self) -> tuple[Side, Side]:
        """The two motions whose known accelerations lead to the third joint."""
        return self.about, self.third.side

    @property
    def normals(self) -> list[str]:
        """Ids of the known accelerations of the special point and their segments, calculated before the plan."""
        quantities: list[str] = []
        for leg in self.pair:
            rod = f"{self.S}{leg.Q}"
            known = (ids.acceleration(leg.side.relative, "n"), leg.side.known, ids.drawn(rod), ids.length(rod))
            quantities += [*known, ids.acceleration(leg.across.relative, "n"), leg.across.known]
        return self.ledger.known(quantities)

    @property
    def later_normals(self) -> list[str]:
        """Ids of the known accelerations of the third leg's joint and their segments."""
        both = (self.about, self.third.side)
        return self.ledger.known(id for side in both for id in (ids.acceleration(side.relative, "n"), side.known))

    @property
    def velocity_lines(self) -> list[str]:
        """Ids of the lines that the velocity plan gives: points, relative velocities, rotations."""
        rod = f"{self.S}{self.third.Q}"
        legs = (self.third, *self.pair)
        return self._in_order(
            ids.velocity(self.S),
            *(leg.special.velocity for leg in self.pair),
            *(self.about.velocity, ids.drawn(rod), ids.length(rod), ids.angular_velocity(self.plate)),
            *(id for leg in legs for id in (ids.velocity(leg.Q), leg.side.velocity)),
            *(ids.velocity(place.name) for place in self.points),
            *(ids.angular_velocity(leg.link) for leg in self.legs),
        )

    @property
    def acceleration_lines(self) -> list[str]:
        """Ids of the lines that the acceleration plan gives."""
        legs = (self.third, *self.pair)
        return self._in_order(
            ids.acceleration(self.S),
            *(ids.acceleration(self.about.relative, "t"), ids.angular_acceleration(self.plate)),
            *(id for leg in legs for id in (ids.acceleration(leg.Q), ids.acceleration(leg.side.relative, "t"))),
            *(ids.acceleration(place.name) for place in self.points),
            *(ids.angular_acceleration(leg.link) for leg in self.legs),
        )

    # --- what all kinds of groups have

    @property
    def carriers(self) -> tuple[int, ...]:
        """The links to which its legs are joined."""
        return tuple(leg.carrier for leg in self.legs)

    @property
    def hung(self) -> tuple[tuple[int, NamedPoint], ...]:
        """The legs of the group with their outer pins."""
        return tuple((leg.link, leg.P) for leg in self.legs)

    @property
    def pins(self) -> tuple[NamedPoint, ...]:
        """The pins at the ends of its rods."""
        return tuple(pin for leg in self.legs for pin in (leg.P, leg.Q))

    @property
    def found_joints(self) -> tuple[NamedPoint, ...]:
        """The joints that the plans find."""
        return tuple(leg.Q for leg in self.legs)

    @property
    def rods(self) -> tuple[tuple[NamedPoint, NamedPoint], ...]:
        """The ends of its rods of constant length."""
        return tuple((leg.P, leg.Q) for leg in self.legs)

    @property
    def reaction_joints(self) -> tuple[str, ...]:
        """The digits of the reactions in its joints, in the order of tables."""
        return tuple(digits for leg in self.legs for digits in (leg.outer, leg.inner))

    # --- forces

    def arms(self, about: str, links: Iterable[int]) -> list[str]:
        """Return the ids of the arms about a point for the known forces on some links of the group."""
        if self.polygon is None:
            return []
        on = set(links)
        return self.ledger.known(
            ids.arm(edge.name, about) for edge in self.polygon.edges if edge.link in on and not edge.unknown
        )

    @property
    def axial_lines(self) -> list[str]:
        """Ids of the moments on the whole group about the special point, and of the component that they give."""
        axial = ids.arm(ids.reaction_force(self.third.outer, "n"), self.S)
        arms = [id for id in self.arms(self.S, self.links) if id != axial]
        return [*arms, *self.ledger.known([axial]), ids.reaction(self.third.outer, "n")]

    @property
    def reactions(self) -> list[str]:
        """Ids of the reactions measured on the force plan, in the order of construction."""
        axial = [ids.reaction(leg.outer, "n") for leg in (self.last, self.first)]
        return [*axial, *(ids.reaction(digits) for digits in self.joints)]

    @property
    def joints(self) -> tuple[str, ...]:
        """The digits of the reactions in its outer joints, then of those in the inner ones."""
        legs = (self.last, self.first, self.third)
        return (*(leg.outer for leg in legs), *(leg.inner for leg in legs))

    @property
    def tangential(self) -> list[str]:
        """Ids of the components across legs that moments give."""
        return self.ledger.known(ids.reaction(leg.outer, "t") for leg in self.legs)

    @property
    def by_moments(self) -> list[str]:
        """Ids of the components across legs, positive where their moment is clockwise."""
        return self.tangential
