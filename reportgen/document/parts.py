"""Parts of a machine as templates name them: points, driver, sides of a vector equation, slides, bodies."""

from __future__ import annotations

from dataclasses import dataclass, field

from reportgen.document.prose import PointName
from reportgen.ledger.core import Ledger
from reportgen.ledger.kinematics.sides import Side, Turn


@dataclass(frozen=True, slots=True)
class PointView:
    """A named point on a link, e.g. a mass centre: `name` S2, `image` s2."""

    name: PointName
    image: str
    link: int

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True)
class DriverView:
    """The driver as templates name it: centre O1, pin A, further points on it, their plan letters.

    A sliding driver has neither centre nor arm.  `velocity_lines` and `acceleration_lines` are those of its
    points; `drawn`, `velocity`, `velocity_segment` and `acceleration_segment` the ids of the arm's drawn
    length, of the pin's velocity and of the segments that stand for the pin's velocity and acceleration.
    """

    centre: PointName
    pin: PointName
    image: str
    arm: str
    others: tuple[PointView, ...]
    ledger: Ledger = field(repr=False)

    @property
    def drawn(self) -> str:
        return f"drawn.{self.arm}"

    @property
    def velocity(self) -> str:
        return f"v.{self.pin}"

    @property
    def velocity_segment(self) -> str:
        return f"seg.v.p{self.image}"

    @property
    def acceleration_segment(self) -> str:
        return f"seg.a.p{self.image}"

    @property
    def velocity_lines(self) -> list[str]:
        return self._lines("v.")

    @property
    def acceleration_lines(self) -> list[str]:
        return self._lines("a.")

    def _lines(self, prefix: str) -> list[str]:
        others = [f"{prefix}{place.name}" for place in self.others]
        return [f"{prefix}{self.pin}", *(id for id in others if id in self.ledger)]


@dataclass(frozen=True, slots=True)
class CarriedPoint:
    """A point of a link that turns about `origin` without a segment of its own on the plan.

    `relative` is its name with the origin's, e.g. S2B; `still` says whether the origin is fixed to the
    frame, `swings` whether the link has an angular acceleration.
    """

    name: PointName
    image: str
    link: int
    origin: PointName
    relative: str
    still: bool
    swings: bool

    @property
    def omega(self) -> str:
        return f"omega.{self.link}"

    @property
    def epsilon(self) -> str:
        return f"eps.{self.link}"


@dataclass(frozen=True, slots=True)
class SideView:
    """One of the two ways in which the motion of M is written: `point` turns about `base` on `link`, or slides over it.

    `shown` names the base in vectors and `pair` the point relative to it, `relative` the same in ids.  `rod` is
    their distance where the point `turns`; else `turning` is the link whose turning gives a Coriolis acceleration,
    and `carrier` the link with the guide whose point the base is, None over a pin.  `part` is the suffix of the
    relative acceleration that velocities give, n or k, and `sought` of the one sought on the plan, t or r.
    """

    point: PointName
    base: PointName
    shown: str
    relative: str
    still: bool
    turns: bool
    link: int = 0
    rod: str = ""
    measured: bool = False
    turning: int = 0
    carrier: int | None = None

    @property
    def pair(self) -> str:
        return f"{self.point}{self.shown}"

    @property
    def guided(self) -> bool:
        """Whether the base is the guide's own point, not a pin."""
        return self.carrier is not None

    @property
    def part(self) -> str:
        return "n" if self.turns else "k" if self.turning else ""

    @property
    def sought(self) -> str:
        """The suffix sought; "" where the point's own acceleration stands for it."""
        return "t" if self.turns else "r" if self.turning or not self.still else ""

    @property
    def known(self) -> str:
        """The segment of the relative acceleration that velocities give."""
        return f"seg.a.{self.part}.{self.relative}"

    @property
    def velocity(self) -> str:
        return f"v.{self.relative}"

    @property
    def omega(self) -> str:
        return f"omega.{self.turning}"


def side_view(side: Side) -> SideView:
    common = PointName(side.point), PointName(side.base), side.shown, side.relative, side.still, side.turns
    if isinstance(side, Turn):
        return SideView(*common, link=side.link, rod=side.rod, measured=side.measured)
    return SideView(*common, turning=side.turning, carrier=side.carrier)


@dataclass(frozen=True, slots=True)
class Contact:
    """The reaction `digits` of a slide on `link`: `moment` and `place` are the ids of its moment about the
    pin and of its distance from the pin, `arms` those of the forces that have this moment.
    """

    digits: str
    pin: PointName
    link: int
    moment: str
    place: str
    arms: list[str]
    displaced: bool
    """Whether other forces have a moment about the pin, so that the reaction may act beside it."""

    @property
    def moments(self) -> list[str]:
        return [*self.arms, self.moment] if self.displaced else self.arms

    @property
    def lines(self) -> list[str]:
        """What is worked out for the moment and for the place."""
        return [*self.moments, self.place]


@dataclass(frozen=True, slots=True)
class BodyView:
    """A link with an inertia couple: its number, mass centre, the pin it is measured from, the ids to show."""

    link: int
    centre: PointName
    start: PointName
    ids: tuple[str, ...]
    still: bool = False
    """Whether that pin is fixed to the frame."""

    @property
    def force(self) -> str:
        return f"Pqt{self.link}"

    @property
    def couple(self) -> str:
        return f"M.Pqt{self.link}"


@dataclass(frozen=True, slots=True)
class PlaneLink:
    """A link in plane motion: its number, two points with drawn velocities, their `rod` and their `group`.

    The other members are the ids that the section on instant centres works out for it.
    """

    link: int
    base: PointName
    point: PointName
    rod: str
    group: str

    @property
    def omega(self) -> str:
        return f"omega.{self.link}"

    @property
    def distances(self) -> list[str]:
        return self._of_points("seg")

    @property
    def rates(self) -> list[str]:
        return [f"ic.omega.{self.link}", f"ic.v.{self.link}"]

    @property
    def angles(self) -> list[str]:
        return self._of_points("angle")

    @property
    def projections(self) -> list[str]:
        return self._of_points("along")

    def _of_points(self, what: str) -> list[str]:
        return [f"ic.{what}.{self.link}.{name}" for name in (self.base, self.point)]
