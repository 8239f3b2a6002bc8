"""What a template sees of a machine: its groups, points and joints by name."""

from __future__ import annotations

from dataclasses import dataclass

from reportgen.analysis import Analysis
from reportgen.ledger.forces.loads import joint
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics.sides import Side, Slide, Turn, image, scheme, sides
from reportgen.mechanism.structure import DRIVER, Crank, Dyad, Guide


@dataclass(frozen=True, slots=True)
class CentreView:
    """A named point on a link, e.g. a mass centre: `name` S2, `image` s2."""

    name: str
    image: str
    link: int


@dataclass(frozen=True, slots=True)
class GroupView:
    """An Assur group as templates name it.

    `i`, `j` are its links; `P`, `Q` the outer and the inner pin (A, B), `T` the outer pin of j ("" on a guide),
    `M` the point whose motion is written in two ways, and `p`, `q`, `t`, `m` their plan letters; `one` and
    `two` those ways; `relative` is MP as in v_BA and `rod` PQ; `outer`, `inner`, `guide` the joints' digits as
    in R12, R32, R03, `across` those of R23; `points` and `points_j` the named points of links i and j.
    """

    kind: str
    i: int
    j: int
    P: str
    Q: str
    T: str
    M: str
    p: str
    q: str
    t: str
    m: str
    relative: str
    rod: str
    one: Side
    two: Side
    carrier: int
    outer: str
    inner: str
    across: str
    guide: str
    offset: bool
    points: tuple[CentreView, ...]
    points_j: tuple[CentreView, ...]
    polygon: Polygon | None

    @property
    def name(self) -> str:
        return joint(self.i, self.j)

    @property
    def sides(self) -> tuple[Side, Side]:
        return self.one, self.two

    @property
    def moving(self) -> tuple[Side, ...]:
        """The ways whose base moves."""
        return tuple(side for side in self.sides if not side.still)

    @property
    def under(self) -> tuple[Slide, ...]:
        """The ways over a moving guide: their base is the guide's point under M."""
        return tuple(
            side for side in self.moving if isinstance(side, Slide) and side.carrier is not None
        )

    @property
    def normals(self) -> list[str]:
        """Ids of the known relative accelerations and their segments, to be worked out before the plan."""
        parts = [(side.relative, known_part(side)) for side in self.sides if known_part(side)]
        return [id for name, part in parts for id in (f"a.{name}.{part}", f"seg.a.{part}.{name}")]

    @property
    def turning(self) -> tuple[Slide, ...]:
        """The ways with a Coriolis acceleration."""
        return tuple(side for side in self.sides if isinstance(side, Slide) and side.turning)


def known_part(side: Side) -> str:
    """The suffix of the relative acceleration that velocities give: n, k, or "" where there is none."""
    if isinstance(side, Turn):
        return "n"
    return "k" if side.turning else ""


def sought_part(side: Side) -> str:
    """The suffix of the relative acceleration sought on the plan; "" where the point's own stands for it."""
    if isinstance(side, Turn):
        return "t"
    return "r" if side.turning or not side.still else ""


def groups(analysis: Analysis, polygons: tuple[Polygon, ...]) -> tuple[GroupView, ...]:
    """The groups of a machine in the order of assembly."""
    linkage = analysis.machine.linkage
    plan = scheme(linkage)
    plans = {polygon.name: polygon for polygon in polygons}

    def on(link: int) -> tuple[CentreView, ...]:
        places = (place.name for place in linkage.points if place.link == link)
        return tuple(CentreView(name, image(name), link) for name in places)

    def view(dyad: Dyad) -> GroupView:
        i, j = dyad.links
        start = dyad.start if isinstance(dyad.start, str) else dyad.middle
        end = dyad.end if isinstance(dyad.end, str) else ""
        first, last = (
            end.link if isinstance(end, Guide) else plan.owner[end] for end in (dyad.start, dyad.end)
        )
        one, two = sides(plan, dyad)
        return GroupView(
            kind=dyad.kind,
            i=i,
            j=j,
            P=start,
            Q=dyad.middle,
            T=end,
            M=one.point,
            p=image(start),
            q=image(dyad.middle),
            t=image(end),
            m=image(one.point),
            relative=one.relative,
            rod=one.rod if isinstance(one, Turn) else "",
            one=one,
            two=two,
            carrier=first,
            outer=joint(first, i),
            inner=joint(j, i),
            across=joint(i, j),
            guide=joint(last, j),
            offset=dyad.kind == "RPR" and bool(dyad.lengths[1]),
            points=on(i),
            points_j=on(j),
            polygon=plans.get(joint(i, j)),
        )

    return tuple(view(dyad) for dyad in linkage.dyads)


@dataclass(frozen=True, slots=True)
class DriverView:
    """The driver as templates name it: centre O1, pin A, further points on it, their plan letters.

    A sliding driver has neither centre nor arm.
    """

    centre: str
    pin: str
    image: str
    arm: str
    others: tuple[CentreView, ...]


def driver(analysis: Analysis) -> DriverView:
    """The driver of a machine."""
    linkage = analysis.machine.linkage
    moved = linkage.driver
    centre = moved.centre if isinstance(moved, Crank) else ""
    return DriverView(
        centre,
        moved.pin,
        image(moved.pin),
        f"{centre}{moved.pin}" if centre else "",
        tuple(CentreView(place.name, image(place.name), DRIVER) for place in linkage.points if place.link == DRIVER),
    )
