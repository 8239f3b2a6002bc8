"""Lists of quantities that templates walk through: what to work out, what to tabulate, by kind of quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.analysis import Analysis
from reportgen.case import Case
from reportgen.document.views import CentreView, DriverView, GroupView, known_part, sought_part
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics.sides import Side, Turn
from reportgen.notation.expressions import Number, refs


@dataclass(frozen=True, slots=True)
class BodyView:
    """A link with an inertia couple: its number, mass centre, the pin it is measured from, the ids to show."""

    link: int
    centre: str
    start: str
    ids: tuple[str, ...]
    still: bool = False
    """Whether that pin is fixed to the frame."""


@dataclass(frozen=True, slots=True)
class CarriedView:
    """A point of a link that turns about `origin` without a segment of its own on the plan.

    `relative` is its name with the origin's, e.g. S2B; `still` says whether the origin is fixed to the
    frame, `swings` whether the link has an angular acceleration.
    """

    name: str
    image: str
    link: int
    origin: str
    relative: str
    still: bool
    swings: bool


@dataclass(frozen=True)
class Facts:
    """What a report has of each kind of quantity; ids in the order of the report."""

    case: Case
    groups: tuple[GroupView, ...]
    driver: DriverView

    @property
    def analysis(self) -> Analysis:
        return self.case.analysis

    @property
    def ledger(self) -> Ledger:
        return self.case.ledger

    @property
    def worked(self) -> tuple[int, ...]:
        return self.case.assignment.worked_positions

    def has(self, ids: Sequence[str]) -> list[str]:
        """Those of the ids that the ledger knows."""
        return [id for id in ids if id in self.ledger]

    def driver_others(self, prefix: str) -> list[str]:
        """Velocities or accelerations of the crank's further pins."""
        return self.has([f"{prefix}{place.name}" for place in self.driver.others])

    def turning(self, prefix: str) -> list[str]:
        """Signed angular quantities of the links that turn."""
        return self.has([f"{prefix}{link}" for link in self.analysis.machine.linkage.links])

    def velocity_lines(self, group: GroupView) -> list[str]:
        """What is worked out from a group's velocity plan: points, relative velocities, rotations."""
        return self._in_order(
            *(f"v.{side.base}" for side in group.under),
            f"v.{group.M}",
            *(f"v.{side.relative}" for side in group.sides),
            f"v.{group.Q}",
            *self._point_lines("v", group),
            *self._measured(group),
            f"omega.{group.i}",
            f"omega.{group.j}",
        )

    def acceleration_lines(self, group: GroupView) -> list[str]:
        """What is worked out from a group's acceleration plan."""
        return self._in_order(
            *(f"a.{side.base}" for side in group.under),
            f"a.{group.M}",
            *(f"a.{side.relative}.{sought_part(side)}" for side in group.sides),
            f"a.{group.Q}",
            *self._point_lines("a", group),
            f"eps.{group.i}",
            f"eps.{group.j}",
        )

    def _in_order(self, *ids: str) -> list[str]:
        """The ids, but before each what it is worked out from."""
        known = self._once(*ids)
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

    def carried(self, group: GroupView) -> list[CarriedView]:
        """Points that similarity does not give, as on a block: they turn about a joint at the link's rate."""
        views = []
        for place in (*group.points, *group.points_j):
            origin = self._origin(group, place.link)
            relative = f"{place.name}{origin}"
            if f"v.{relative}" in self.ledger:
                swings = f"a.{relative}.t" in self.ledger
                still = origin in self._fixed
                views.append(CarriedView(place.name, place.image, place.link, origin, relative, still, swings))
        return views

    def _once(self, *ids: str) -> list[str]:
        return self.has(list(dict.fromkeys(ids)))

    def _measured(self, group: GroupView) -> list[str]:
        """Lengths that change and are measured on the position drawing."""
        rods = [side.rod for side in group.sides if isinstance(side, Turn) and side.measured]
        return [f"{what}.{rod}" for rod in rods for what in ("drawn", "l")]

    def _point_lines(self, what: str, group: GroupView) -> list[str]:
        ids: list[str] = []
        for place in (*group.points, *group.points_j):
            origin = self._origin(group, place.link)
            parts = ("",) if what == "v" else (".n", ".t")
            ids += [f"{what}.{place.name}{origin}{part}" for part in parts]
            ids.append(f"{what}.{place.name}")
        return ids

    def _origin(self, group: GroupView, link: int) -> str:
        """The joint that a link's points are measured from."""
        if link == group.i:
            return group.P
        return group.T or group.Q

    def similar(self, what: str, group: GroupView) -> list[str]:
        """Segments that the similarity theorem gives, e.g. as₂, and be where E is off the line of joints."""
        ids: list[str] = []
        for place in (*group.points, *group.points_j):
            for side in group.sides:
                if isinstance(side, Turn) and side.link == place.link:
                    base = "p" if side.still else side.base.lower()
                    ids += [f"seg.{what}.{base}{place.image}", f"seg.{what}.{group.m}{place.image}"]
        return self._once(*ids)

    def names(self, places: Sequence[CentreView]) -> list[str]:
        return [place.name for place in places]

    @property
    def velocity_segments(self) -> list[str]:
        ids: list[str] = []
        for group in self.groups:
            ids += [f"seg.v.p{group.m}", *(f"seg.v.{side.base.lower()}{group.m}" for side in group.moving)]
            ids += self._images("v", group)
        return self._once(*ids)

    @property
    def acceleration_segments(self) -> list[str]:
        ids: list[str] = []
        for group in self.groups:
            ids.append(f"seg.a.p{group.m}")
            ids += [f"seg.a.{part}.{side.relative}" for side in group.sides for part in _parts(side)]
            ids += self._images("a", group)
        return self._once(*ids)

    def _images(self, what: str, group: GroupView) -> list[str]:
        places = (group.q, *(place.image for place in (*group.points, *group.points_j)))
        return [f"seg.{what}.p{place}" for place in places]

    @property
    def velocity_columns(self) -> list[str]:
        ids: list[str] = []
        for group in self.groups:
            # Relative to a fixed point a velocity is the point's own.
            ids += [f"v.{group.M}", *(f"v.{side.relative}" for side in group.moving), f"v.{group.Q}"]
            ids += self._centres("v", group)
        return self._once(*ids, *self.turning("turn.omega."))

    @property
    def acceleration_columns(self) -> list[str]:
        ids: list[str] = []
        for group in self.groups:
            ids.append(f"a.{group.M}")
            ids += [f"a.{side.relative}.{part}" for side in group.sides for part in _parts(side)]
            ids += [f"a.{group.Q}", *self._centres("a", group)]
        return self._once(*ids, *self.turning("turn.eps."))

    def _centres(self, what: str, group: GroupView) -> list[str]:
        return [f"{what}.{place.name}" for place in (*group.points, *group.points_j)]

    def centre_lines(self, rod: int, what: str) -> list[str]:
        """Closed formulas of a rod's mass centre by components."""
        centres = [place.name for group in self.groups for place in group.points if group.i == rod]
        return self.has(
            [id for name in centres for id in (f"f.x.{name}.{what}", f"f.y.{name}.{what}", f"f.{what}.{name}")]
        )

    # --- forces

    @property
    def mass_lines(self) -> list[str]:
        links = [str(body.link) for body in self.analysis.machine.linkage.inertias]
        return self.has([*(f"m.{link}" for link in links), *(f"J.{link}" for link in links)])

    @property
    def inertia_lines(self) -> list[str]:
        links = [str(body.link) for body in self.analysis.machine.linkage.inertias]
        return self.has([*(f"Pqt{link}" for link in links), *(f"M.Pqt{link}" for link in links)])

    @property
    def couples(self) -> tuple[BodyView, ...]:
        """Links whose inertia is a force and a couple, replaced by one force off the mass centre."""
        views = []
        for body in self.analysis.machine.linkage.inertias:
            ids = self.has([f"e.Pqt{body.link}", f"l.{body.centre}K{body.link}"])
            # A block turns about no base of a plan: the pin it sits on is its first joint.
            start = next(
                (side.base for group in self.groups for side in group.sides if _turns(side, body.link)),
                next((group.P for group in self.groups if group.i == body.link), ""),
            )
            if len(ids) == 2:
                views.append(BodyView(body.link, body.centre, start, tuple(ids), start in self._fixed))
        return tuple(views)

    @property
    def _fixed(self) -> frozenset[str]:
        return frozenset(self.analysis.machine.linkage.ground)

    def arm_ids(self, group: GroupView, centre: str = "", link: int = 0) -> list[str]:
        """Arms about a point (else the inner pin) of the loads on one link of a group (else the first)."""
        if group.polygon is None:
            return []
        about, carrier = centre or group.Q, link or group.i
        known = [(side.name, side.link) for side in group.polygon.sides if not side.unknown]
        known.append((f"R{group.across}", group.j))
        return self.has([f"h.{name}.{about}" for name, owner in known if owner == carrier])

    def negative(self, id: str, position: int) -> bool:
        return self.ledger.number(id, position).value < 0

    def zero(self, id: str, position: int) -> bool:
        return self.ledger.number(id, position).value == 0

    @property
    def reaction_ids(self) -> list[str]:
        ids = [
            id
            for group in reversed(self.groups)
            for id in (
                f"R.{group.outer}.t",
                f"R.{group.guide}.t",
                f"R.{group.outer}",
                f"R.{group.inner}",
                f"R.{group.guide}",
            )
        ]
        return self.has([*ids, "R.01"])

    @property
    def reaction_angles(self) -> list[str]:
        ids = [
            id
            for group in reversed(self.groups)
            for id in (f"dir.R{group.outer}", f"dir.R{group.inner}", f"dir.R{group.guide}")
        ]
        return self.has([*ids, "dir.R01"])

    @property
    def driver_polygon(self) -> Polygon:
        return self.case.polygons[-1]

    @property
    def crank_lines(self) -> list[str]:
        arms = [id for id in self.ledger.families if id.startswith("h.") and id.endswith(f".{self.driver.centre}")]
        return [*arms, "M.eq"]

    @property
    def crank_pins(self) -> list[str]:
        """The crank's pin, and further points of the crank that a group hangs on."""
        hung = {pin for group in self.groups for pin in (group.P, group.T)}
        return [self.driver.pin, *(place.name for place in self.driver.others if place.name in hung)]

    @property
    def lever_couples(self) -> list[str]:
        """What torques, which have no arm, contribute to the balance by virtual work."""
        names = [torque.name for torque in self.analysis.machine.torques]
        return self.has([f"M.{name}.p" for name in names])

    def drawn(self, group: GroupView, name: str, position: int) -> Number:
        """The drawn length of a force in its group's plan."""
        return self.ledger.number(f"seg.{group.name}.{name}", position)


def _parts(side: Side) -> list[str]:
    """Suffixes of a side's relative accelerations, the known one first."""
    return [part for part in (known_part(side), sought_part(side)) if part]


def _turns(side: Side, link: int) -> bool:
    return isinstance(side, Turn) and side.link == link
