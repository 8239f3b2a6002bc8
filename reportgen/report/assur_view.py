"""What the views of all Assur groups have in common, for templates and figures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from typing import Any

from reportgen.base.template_access import template_members
from reportgen.derivation.equation_sides import Scheme, Side, image
from reportgen.derivation.load_entries import Polygon
from reportgen.formula import ids, refs
from reportgen.formula.ledger import Ledger
from reportgen.machine import Group
from reportgen.report.driver_view import DriverView, points_on


@template_members(
    *(
        "__str__",
        "kind",
        "links",
        "members",
        "plate",
        "name",
        "scale",
        "points",
        "polygon",
        "moving",
        "similar",
        "bodies",
    ),
    *("pulls_across", "across_by_moments", "components", "last_known"),
)
class AssurView(ABC):
    """What the views of all Assur groups have in common: links, points, force plan.

    `turns` are the sides whose point turns with a link of the group; `scale` is the id of the scale of the force plan;
    `plate` is the ternary link, or 0.
    """

    @property
    def across_by_moments(self) -> bool:
        """Return True if moments give the whole force between the links; the plan then treats it as a load."""
        return False

    bodies = "bodies"
    """Key of the caption of its separated links."""

    def __init__(
        self,
        group: Group,
        turns: Iterable[Side],
        plan: Scheme,
        driver: DriverView,
        polygons: Iterable[Polygon],
        ledger: Ledger,
    ) -> None:
        self.kind, self.links, self.ledger, self.turns = str(group.kind), group.links, ledger, tuple(turns)
        self.plate, self.name = 0, ids.members(group.links)
        self.scale = ids.force_scale(self.name)
        self.points = tuple(place for link in group.links for place in points_on(plan.linkage, link))
        self.polygon = next((polygon for polygon in polygons if polygon.name == self.name), None)
        self.on_driver = frozenset(driver.names)

    def __str__(self) -> str:
        return self.name

    @property
    def members(self) -> str:
        """The numbers of its links."""
        return ", ".join(map(str, self.links))

    def title(self, words: Mapping[str, Any]) -> str:
        """Return its name for titles, such as "Group (2,3)"; `words` are those of figures."""
        return str(words["group"]).format(links=str(words["between_links"]).join(map(str, self.links)))

    @property
    @abstractmethod
    def moving(self) -> tuple[Side, ...]:
        """The sides with a moving base whose vectors begin its plans."""

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

    def similar(self, what: str) -> list[str]:
        """Return the ids of a link's segment ab and of those that similarity gives: as₂, be."""
        segments: list[str] = []
        for place in self.points:
            for side in self.turns:
                if side.link == place.link:
                    ends = "p" if side.still else image(side.base), image(side.point)
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

    # --- forces

    @property
    @abstractmethod
    def tangential(self) -> list[str]:
        """Ids of the components across links that moments give."""

    @property
    @abstractmethod
    def by_moments(self) -> list[str]:
        """Ids of the signed parts of reactions that moments give before the force plan."""

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
