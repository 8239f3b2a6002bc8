"""What a template sees of a machine: its groups, points and joints by name."""

from __future__ import annotations

from dataclasses import dataclass

from reportgen.analysis import Analysis
from reportgen.ledger.forces import Polygon
from reportgen.ledger.kinematics import image
from reportgen.mechanism.mobility import owners
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

    `i`, `j` are its links; `P`, `Q` the outer and the inner pin (A, B), `p`, `q` their plan letters;
    `relative` is QP as in v_BA and `rod` PQ; `outer`, `inner`, `guide` the joints' digits as in R12, R32,
    R03; `points` the named points of link i.
    """

    kind: str
    i: int
    j: int
    P: str
    Q: str
    p: str
    q: str
    relative: str
    rod: str
    carrier: int
    outer: str
    inner: str
    guide: str
    points: tuple[CentreView, ...]
    polygon: Polygon | None

    @property
    def name(self) -> str:
        return f"{self.i}{self.j}"


def groups(analysis: Analysis, polygons: tuple[Polygon, ...]) -> tuple[GroupView, ...]:
    """The groups of a machine in the order of assembly."""
    linkage = analysis.machine.linkage
    belongs = owners(linkage)
    plans = {polygon.name: polygon for polygon in polygons}

    def view(dyad: Dyad) -> GroupView:
        i, j = dyad.links
        start = dyad.start if isinstance(dyad.start, str) else dyad.middle
        carrier = dyad.start.link if isinstance(dyad.start, Guide) else belongs[start]
        ground = dyad.end.link if isinstance(dyad.end, Guide) else belongs[dyad.end]
        return GroupView(
            dyad.kind,
            i,
            j,
            start,
            dyad.middle,
            image(start),
            image(dyad.middle),
            f"{dyad.middle}{start}",
            f"{start}{dyad.middle}",
            carrier,
            f"{carrier}{i}",
            f"{j}{i}",
            f"{ground}{j}",
            tuple(CentreView(place.name, image(place.name), i) for place in linkage.points if place.link == i),
            plans.get(f"{i}{j}"),
        )

    return tuple(view(dyad) for dyad in linkage.dyads)


@dataclass(frozen=True, slots=True)
class DriverView:
    """The crank as templates name it: centre O1, pin A, further points on it, their plan letters."""

    centre: str
    pin: str
    image: str
    arm: str
    others: tuple[CentreView, ...]


def driver(analysis: Analysis) -> DriverView:
    """The driver of a crank-driven machine."""
    linkage = analysis.machine.linkage
    crank = linkage.driver
    assert isinstance(crank, Crank)
    return DriverView(
        crank.centre,
        crank.pin,
        image(crank.pin),
        f"{crank.centre}{crank.pin}",
        tuple(CentreView(place.name, image(place.name), DRIVER) for place in linkage.points if place.link == DRIVER),
    )
