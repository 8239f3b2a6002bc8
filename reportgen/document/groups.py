"""An Assur group as templates, tables and figures see it, with the ids of its quantities in their order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from reportgen.analysis import Analysis
from reportgen.document.parts import CarriedPoint, Contact, DriverView, PointView, SideView, side_view
from reportgen.document.prose import PointName
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces.loads import joint
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics.sides import image, scheme, sides
from reportgen.mechanism.structure import DRIVER, Crank, Dyad, Guide
from reportgen.notation.expressions import refs


@dataclass(frozen=True, slots=True)
class GroupView:
    """An Assur group as templates name it.

    `i`, `j` are its links; `P`, `Q` the outer and the inner pin (A, B), `T` the outer pin of j ("" on a guide),
    `M` the point whose motion is written in two ways, and `p`, `q`, `m` their plan letters; `one` and `two`
    those ways; `relative` is MP as in v_BA and `rod` PQ; `outer`, `inner`, `guide` the joints' digits as in
    R12, R32, R03, `across` those of R23; `points_i` and `points_j` the named points of links i and j.
    """

    kind: str
    i: int
    j: int
    P: PointName
    Q: PointName
    T: PointName
    M: PointName
    p: str
    q: str
    m: str
    relative: str
    rod: str
    one: SideView
    two: SideView
    carrier: int
    outer: str
    inner: str
    across: str
    guide: str
    offset: bool
    points_i: tuple[PointView, ...]
    points_j: tuple[PointView, ...]
    polygon: Polygon | None
    fixed: frozenset[str] = field(repr=False)
    """The points of the frame."""
    on_driver: frozenset[str] = field(repr=False)
    ledger: Ledger = field(repr=False)

    def __str__(self) -> str:
        return self.name

    @property
    def name(self) -> str:
        return joint(self.i, self.j)

    @property
    def sides(self) -> tuple[SideView, SideView]:
        return self.one, self.two

    @property
    def points(self) -> tuple[PointView, ...]:
        return (*self.points_i, *self.points_j)

    # --- plans of velocity and acceleration

    @property
    def moving(self) -> tuple[SideView, ...]:
        """The ways whose base moves."""
        return tuple(side for side in self.sides if not side.still)

    @property
    def under(self) -> tuple[SideView, ...]:
        """The ways over a moving guide: their base is the guide's point under M."""
        return tuple(side for side in self.moving if side.guided)

    @property
    def turning(self) -> tuple[SideView, ...]:
        """The ways with a Coriolis acceleration."""
        return tuple(side for side in self.sides if side.turning)

    @property
    def normals(self) -> list[str]:
        """The known relative accelerations and their segments, to be worked out before the plan."""
        known = [side for side in self.sides if side.part]
        return [id for side in known for id in (f"a.{side.relative}.{side.part}", side.known)]

    @property
    def velocity_lines(self) -> list[str]:
        """What is worked out from the velocity plan: points, relative velocities, rotations."""
        return self._in_order(
            *(f"v.{side.base}" for side in self.under),
            f"v.{self.M}",
            *(side.velocity for side in self.sides),
            f"v.{self.Q}",
            *self._point_lines("v", ("",)),
            *self._measured(),
            f"omega.{self.i}",
            f"omega.{self.j}",
        )

    @property
    def acceleration_lines(self) -> list[str]:
        """What is worked out from the acceleration plan."""
        return self._in_order(
            *(f"a.{side.base}" for side in self.under),
            f"a.{self.M}",
            *(f"a.{side.relative}.{side.sought}" for side in self.sides),
            f"a.{self.Q}",
            *self._point_lines("a", (".n", ".t")),
            f"eps.{self.i}",
            f"eps.{self.j}",
        )

    def _in_order(self, *ids: str) -> list[str]:
        """The ids that exist, but before each what it is worked out from."""
        known = self.ledger_ids(ids)
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

    def ledger_ids(self, ids: Iterable[str]) -> list[str]:
        """Those of the ids that the ledger knows, each once."""
        return [id for id in dict.fromkeys(ids) if id in self.ledger]

    def _point_lines(self, what: str, parts: tuple[str, ...]) -> Iterator[str]:
        for place in self.points:
            yield from (f"{what}.{place.name}{self._origin(place.link)}{part}" for part in parts)
            yield f"{what}.{place.name}"

    def _measured(self) -> list[str]:
        """Lengths that change and are measured on the position drawing."""
        rods = [side.rod for side in self.sides if side.measured]
        return [f"{what}.{rod}" for rod in rods for what in ("drawn", "l")]

    def _origin(self, link: int) -> PointName:
        """The joint that a link's points are measured from."""
        return self.P if link == self.i else self.T or self.Q

    @property
    def carried(self) -> list[CarriedPoint]:
        """Points that similarity does not give, as on a block: they turn about a joint at the link's rate."""
        found = []
        for place in self.points:
            origin = self._origin(place.link)
            relative = f"{place.name}{origin}"
            if f"v.{relative}" in self.ledger:
                swings, still = f"a.{relative}.t" in self.ledger, origin in self.fixed
                found.append(CarriedPoint(place.name, place.image, place.link, origin, relative, still, swings))
        return found

    def similar(self, what: str) -> list[str]:
        """Segments that the similarity theorem gives, e.g. as₂, and be where E is off the line of joints."""
        ids: list[str] = []
        for place in self.points:
            for side in self.sides:
                if side.turns and side.link == place.link:
                    base = "p" if side.still else side.base.lower()
                    ids += [f"seg.{what}.{base}{place.image}", f"seg.{what}.{self.m}{place.image}"]
        return self.ledger_ids(ids)

    def base(self, what: str, side: SideView, k: int) -> str:
        """How the end of a base's vector comes on the plan: at the "pole", "drawn" before, or "new"."""
        if self.ledger.number(self.base_segment(what, side), k).value == 0:
            return "pole"
        return "new" if side.guided or side.base in self.on_driver else "drawn"

    def base_segment(self, what: str, side: SideView) -> str:
        """The segment of a plan that stands for the velocity or acceleration of a side's base."""
        return f"seg.{what}.p{side.base.lower()}"

    @property
    def drawn(self) -> str:
        """The drawn length of the rod."""
        return f"drawn.{self.rod}"

    @property
    def relative_segment(self) -> str:
        """The segment of the velocity plan that stands for the relative velocity of the rod's ends."""
        return f"seg.v.{self.p}{self.q}"

    # --- forces

    def arms(self, about: str, link: int) -> list[str]:
        """Arms about a point of the known loads on a link of the group."""
        if self.polygon is None:
            return []
        known = [(side.name, side.link) for side in self.polygon.sides if not side.unknown]
        known.append((f"R{self.across}", self.j))
        return self.ledger_ids(f"h.{name}.{about}" for name, carrier in known if carrier == link)

    @property
    def scale(self) -> str:
        """The scale of the force plan."""
        return f"mu.R{self.name}"

    @property
    def outer_lines(self) -> list[str]:
        """Moments on link i about the inner pin, which give the component across the link in its outer joint."""
        return [*self.arms(self.Q, self.i), f"R.{self.outer}.t"]

    @property
    def guide_lines(self) -> list[str]:
        """Moments on link j about the inner pin, which give the component across the link in its outer joint."""
        return [*self.arms(self.Q, self.j), f"R.{self.guide}.t"]

    @property
    def slot_lines(self) -> list[str]:
        """Moments on a slotted link about its outer pin, which give the reaction of the block."""
        foot = [f"drawn.H{self.j}{self.Q}", f"l.H{self.j}{self.Q}"] if self.offset else []
        return [*self.arms(self.T, self.j), *foot, f"R.{self.across}.s"]

    @property
    def reactions(self) -> list[str]:
        """What is measured on the force plan, in the order of the construction."""
        joints = {
            "RRR": (f"{self.outer}.n", f"{self.guide}.n", self.outer, self.guide, self.inner),
            "RRP": (f"{self.outer}.n", self.guide, self.outer, self.inner),
            "RPR": (self.guide, self.outer, self.inner),
            "PRP": (self.outer, self.guide, self.inner),
            "RPP": (self.inner, self.guide, self.outer),
        }
        return [f"R.{name}" for name in joints[self.kind]]

    @property
    def contacts(self) -> list[Contact]:
        """The reactions of slides, whose place on the slide is to be found."""
        first, last = (self.inner, self.P, self.i), (self.guide, self.Q, self.j)
        found = {"RRP": [last], "RPR": [first], "PRP": [(self.outer, self.Q, self.i), last], "RPP": [first, last]}
        return [self._contact(*slide) for slide in found.get(self.kind, [])]

    def _contact(self, digits: str, pin: PointName, link: int) -> Contact:
        moment, place = f"M.{digits}", f"x.{digits}"
        family = self.ledger.families.get(moment)
        displaced = family is not None and family.definition is not None
        return Contact(digits, pin, link, moment, place, self.arms(pin, link), displaced)

    def reversed(self, k: int) -> bool:
        """Whether the component found by moments has the sense opposite to the one assumed."""
        id = f"R.{self.across}.s" if self.kind == "RPR" else f"R.{self.outer}.t"
        return self.ledger.number(id, k).value < 0

    def components(self, k: int) -> int:
        """How many components are found by moments; none where all of them are zero."""
        digits = {"RRP": (self.outer,), "RRR": (self.outer, self.guide)}.get(self.kind, ())
        return len(digits) * any(self.ledger.number(f"R.{name}.t", k).value != 0 for name in digits)

    @property
    def last_known(self) -> str:
        """The vertex of the force plan at which the known forces end."""
        assert self.polygon is not None
        return self.polygon.sides[-2].start

    @property
    def last_of_j(self) -> str:
        """The vertex of the force plan at which the known forces on link j end."""
        assert self.polygon is not None
        return self.polygon.reads[-1].end

def driver(analysis: Analysis, ledger: Ledger) -> DriverView:
    """The driver of a machine."""
    linkage = analysis.machine.linkage
    moved = linkage.driver
    centre = PointName(moved.centre if isinstance(moved, Crank) else "")
    others = tuple(
        PointView(PointName(place.name), image(place.name), DRIVER) for place in linkage.points if place.link == DRIVER
    )
    return DriverView(
        centre, PointName(moved.pin), image(moved.pin), f"{centre}{moved.pin}" if centre else "", others, ledger
    )


def groups(analysis: Analysis, polygons: tuple[Polygon, ...], ledger: Ledger) -> tuple[GroupView, ...]:
    """The groups of a machine in the order of assembly."""
    linkage = analysis.machine.linkage
    plan = scheme(linkage)
    plans = {polygon.name: polygon for polygon in polygons}
    moved = driver(analysis, ledger)
    on_driver = frozenset((moved.pin, *(place.name for place in moved.others)))

    def on(link: int) -> tuple[PointView, ...]:
        places = (place.name for place in linkage.points if place.link == link)
        return tuple(PointView(PointName(name), image(name), link) for name in places)

    def view(dyad: Dyad) -> GroupView:
        i, j = dyad.links
        start = dyad.start if isinstance(dyad.start, str) else dyad.middle
        first, last = (
            end.link if isinstance(end, Guide) else plan.owner[end] for end in (dyad.start, dyad.end)
        )
        one, two = map(side_view, sides(plan, dyad))
        return GroupView(
            kind=dyad.kind,
            i=i,
            j=j,
            P=PointName(start),
            Q=PointName(dyad.middle),
            T=PointName(dyad.end if isinstance(dyad.end, str) else ""),
            M=one.point,
            p=image(start),
            q=image(dyad.middle),
            m=image(one.point),
            relative=one.relative,
            rod=one.rod,
            one=one,
            two=two,
            carrier=first,
            outer=joint(first, i),
            inner=joint(j, i),
            across=joint(i, j),
            guide=joint(last, j),
            offset=dyad.kind == "RPR" and bool(dyad.lengths[1]),
            points_i=on(i),
            points_j=on(j),
            polygon=plans.get(joint(i, j)),
            fixed=frozenset(linkage.ground),
            on_driver=on_driver,
            ledger=ledger,
        )

    return tuple(view(dyad) for dyad in linkage.dyads)
