"""Views of a machine's driver and of named points for templates, and the members of machines that templates may read.

Names of points are `NamedPoint`s, which templates print as symbols.
"""

from __future__ import annotations

import numpy as np

from reportgen.base.records import Record
from reportgen.base.template_access import template_members, view
from reportgen.derivation.equation_sides import Side, image
from reportgen.derivation.load_entries import Polygon
from reportgen.document.template_rendering import NamedPoint
from reportgen.formula import ids
from reportgen.formula.ledger import Ledger
from reportgen.machine import DRIVER, Crank, Inertia, Linkage, Mobility
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
class PointView(Record):
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
    *("large_velocity", "large_acceleration"),
    *("velocity_lines", "acceleration_lines", "scale_lines"),
    *("rate2", "accelerated", "normal_segment", "component_lines", "component_segments"),
    *("component_scale_lines", "acceleration_scale_lines"),
)
class DriverView:
    """The driver for templates: its centre O1 and pin A, its `arm` O1A, and further points on it.

    `kind` is "crank" or "slide"; a slide has neither centre nor arm.  `rate` is the symbol of its speed, `rate2` that
    of its acceleration if it is `accelerated`.  `component_lines` are the two components of the crank pin's
    acceleration.  `round_velocity` and `round_acceleration` are True if the scale of a plan was chosen from the series
    of round scales; `large_velocity` and `large_acceleration` are True if the crank pin's vector is then shorter
    than the crank on paper.
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
        normal = self.normal_segment if self.accelerated else self.acceleration_segment
        self.large_velocity = self._is_shorter(ledger, self.velocity_segment)
        self.large_acceleration = self._is_shorter(ledger, normal)

    def _is_shorter(self, ledger: Ledger, segment: str) -> bool:
        """Return True if a segment is shorter than the crank on paper at every position; False without a crank."""
        return bool(self.arm) and bool(np.nanmax(ledger[segment].values) < ledger[self.drawn].values[0])
