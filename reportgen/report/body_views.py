"""Views of single links for templates: links whose inertia is a force and a couple, links in plane motion."""

from __future__ import annotations

from collections.abc import Iterable

from reportgen.base.records import Record
from reportgen.base.template_access import template_members, view
from reportgen.derivation.equation_sides import Side
from reportgen.document.template_rendering import NamedPoint
from reportgen.formula import ids
from reportgen.formula.ledger import Ledger
from reportgen.machine import DRIVER, Crank, Linkage
from reportgen.report.link_views import GroupView
from reportgen.report.triad_views import TriadView


@view("force", "couple")
class BodyView(Record):
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


def displaced_inertia(
    linkage: Linkage, groups: Iterable[GroupView | TriadView], ledger: Ledger
) -> tuple[BodyView, ...]:
    """Return the links whose inertia is a force and a couple, which a single force off the mass centre replaces."""
    # A block turns about no base of a plan: the pin it sits on is its first joint.
    every = tuple(groups)
    starts = {group.i: group.P for group in every if isinstance(group, GroupView)}
    starts |= {side.link: NamedPoint(side.base) for group in every for side in group.turns}
    if isinstance(linkage.driver, Crank):
        starts[DRIVER] = NamedPoint(linkage.driver.centre)
    bodies = []
    for body in linkage.inertias:
        known = ledger.known((ids.inertia_offset(body.link), ids.percussion(body.centre, body.link)))
        if len(known) == 2:
            start = starts[body.link]
            bodies.append(BodyView(body.link, NamedPoint(body.centre), start, known, start in linkage.ground))
    return tuple(bodies)
