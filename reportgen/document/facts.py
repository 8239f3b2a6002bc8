"""Lists of quantities that templates walk through: what to work out, what to tabulate, by kind of quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.analysis import Analysis
from reportgen.document.views import CentreView, DriverView, GroupView
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces import Polygon
from reportgen.ledger.report import Books
from reportgen.notation.expressions import Number


@dataclass(frozen=True, slots=True)
class BodyView:
    """A link with an inertia couple: its number, mass centre, the pin it is measured from, the ids to show."""

    link: int
    centre: str
    start: str
    ids: tuple[str, ...]


@dataclass(frozen=True)
class Facts:
    """What a report has of each kind of quantity; ids in the order of the report."""

    analysis: Analysis
    books: Books
    groups: tuple[GroupView, ...]
    driver: DriverView
    worked: tuple[int, ...]

    @property
    def ledger(self) -> Ledger:
        return self.books.ledger

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
        return self.has(
            [f"v.{group.Q}", f"v.{group.relative}", *(f"v.{s.name}" for s in group.points), f"omega.{group.i}"]
        )

    def acceleration_lines(self, group: GroupView) -> list[str]:
        names = (s.name for s in group.points)
        return self.has(
            [f"a.{group.Q}", f"a.{group.relative}.t", *(f"a.{name}" for name in names), f"eps.{group.i}"]
        )

    def similar(self, what: str, group: GroupView) -> list[str]:
        """Segments that the similarity theorem gives, e.g. as₂."""
        return self.has([f"seg.{what}.{group.p}{place.image}" for place in group.points])

    def names(self, places: Sequence[CentreView]) -> list[str]:
        return [place.name for place in places]

    @property
    def velocity_segments(self) -> list[str]:
        return self._segments("v", ("p{q}", "{p}{q}"))

    @property
    def acceleration_segments(self) -> list[str]:
        return self._segments("a", ("p{q}", "n.{relative}", "t.{relative}"))

    def _segments(self, what: str, patterns: Sequence[str]) -> list[str]:
        result: list[str] = []
        for group in self.groups:
            fields = {"p": group.p, "q": group.q, "relative": group.relative}
            result += [f"seg.{what}.{pattern.format(**fields)}" for pattern in patterns]
            result += [f"seg.{what}.p{place.image}" for place in group.points]
        return self.has(result)

    @property
    def velocity_columns(self) -> list[str]:
        ids = [id for group in self.groups for id in (f"v.{group.Q}", f"v.{group.relative}", *self._centres("v", group))]
        return self.has([*ids, *self.turning("turn.omega.")])

    @property
    def acceleration_columns(self) -> list[str]:
        ids = [
            id
            for group in self.groups
            for id in (
                f"a.{group.Q}",
                f"a.{group.relative}.n",
                f"a.{group.relative}.t",
                *self._centres("a", group),
            )
        ]
        return self.has([*ids, *self.turning("turn.eps.")])

    def _centres(self, what: str, group: GroupView) -> list[str]:
        return [f"{what}.{place.name}" for place in group.points]

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
            start = next((group.P for group in self.groups if group.i == body.link), "")
            if len(ids) == 2:
                views.append(BodyView(body.link, body.centre, start, tuple(ids)))
        return tuple(views)

    def arm_ids(self, group: GroupView) -> list[str]:
        """Arms about the inner pin of the loads on the group's first link."""
        return [
            id for id in self.ledger.families if id.startswith("h.") and id.endswith(f".{group.Q}")
        ]

    def negative(self, id: str, position: int) -> bool:
        return self.ledger.number(id, position).value < 0

    def zero(self, id: str, position: int) -> bool:
        return self.ledger.number(id, position).value == 0

    @property
    def reaction_ids(self) -> list[str]:
        ids = [
            id
            for group in reversed(self.groups)
            for id in (f"R.{group.outer}.t", f"R.{group.outer}", f"R.{group.inner}", f"R.{group.guide}")
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
        return self.books.polygons[-1]

    @property
    def crank_lines(self) -> list[str]:
        arms = [id for id in self.ledger.families if id.startswith("h.") and id.endswith(f".{self.driver.centre}")]
        return [*arms, "M.eq"]

    def drawn(self, group: GroupView, name: str, position: int) -> Number:
        """The drawn length of a force in its group's plan."""
        return self.ledger.number(f"seg.{group.name}.{name}", position)
