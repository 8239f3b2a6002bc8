"""What machines with a crank at constant speed share: speed, gravity, masses, the flywheel, the outline.

A kind declares what of it there is: `class Parameters(Driven, masses=(2, 3), moments=(2,), shares=(2,))` reads the
weight `G2` or the mass `m2`, the moment of inertia `J2` and the place `s2` of the mass centre, with their checks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Any, ClassVar

import numpy as np

from reportgen.assignment.checks import one_of
from reportgen.assignment.common import Assignment, Check, Draft, Part, Positions
from reportgen.assignment.fields import (
    Acceleration,
    AngularVelocity,
    Coordinate,
    Interval,
    Mass,
    MomentOfInertia,
    Ratio,
    RotationalSpeed,
    Share,
    Weight,
)
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.formula import NOTHING, PI, Expression, Number, Operand, Ref, Symbol, ids, turned, vocabulary
from reportgen.formula.sheet import Sheet
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import Inertia, Linkage, LinkPoint
from reportgen.machine.analysis import Machine
from reportgen.machine.laws import FULL_TURN
from reportgen.machine.loads import LoadsByKind

OPENING = ("contents", "given", "scheme", "overview", "foreword", "symbols", "structure", "motion")
CLOSING = ("conclusion", "references", "checks")
CRANK_DRAWN = 0.04
"""Drawn length of the crank (m on paper) when none is asked for."""
MIDDLE = 0.5
"""Where the mass centre of a uniform bar lies."""

Unevenness = Annotated[Given, Ratio(Interval(least=1e-4, most=0.5))]


class FixedPoint(Part):
    """A fixed point by its coordinates from the crank's centre, x to the right and y upwards."""

    x: Coordinate
    y: Coordinate


class Flywheel(Part):
    """How uneven the speed may be: δ = (ω_max − ω_min)/ω_m."""

    delta: Unevenness


OF_LINK: Mapping[str, Any] = {"G": Weight, "m": Mass, "J": MomentOfInertia, "s": Share}
"""What a file may give of a link, by the letter before its number."""


class Driven(Part):
    """The crank's speed in one of two ways, gravity, the flywheel that is asked for, and masses if declared.

    Of the links `masses` the weight or the mass may be given, of those `required` it must be; `moments` and `shares`
    are the links with J and s.  A flywheel needs a mass or one of the keys `loads`.
    """

    n: RotationalSpeed | None = None
    omega1: AngularVelocity | None = None
    g: Acceleration = Given(9.81, 9.81, "m/s2", "9.81 m/s2")
    flywheel: Flywheel | None = None

    links: ClassVar[Mapping[str, tuple[int, ...]]] = {}
    required: ClassVar[tuple[int, ...]] = ()
    loads: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(
        cls,
        masses: Iterable[int] = (),
        required: Iterable[int] = (),
        moments: Iterable[int] = (),
        shares: Iterable[int] = (),
        loads: Iterable[str] = (),
        **rest: Any,
    ) -> None:
        cls.links = {"G": tuple(masses), "m": tuple(masses), "J": tuple(moments), "s": tuple(shares)}
        cls.required, cls.loads = tuple(required), tuple(loads)
        # A field of pydantic is an annotation with a default, which the body of the class would have had.
        for letter, numbers in cls.links.items():
            for number in numbers:
                cls.__annotations__[f"{letter}{number}"] = OF_LINK[letter] | None
                setattr(cls, f"{letter}{number}", None)
        super().__init_subclass__(**rest)

    @property
    def speed(self) -> float:
        """|ω1| (rad/s)."""
        given = self.n or self.omega1
        assert given is not None, "a file without speed is refused by the kind's checks"
        return given.si

    @property
    def unevenness(self) -> float | None:
        """δ of the flywheel, a ratio; None if none is asked for."""
        return None if self.flywheel is None else self.flywheel.delta.si

    @classmethod
    def checks(cls) -> tuple[Check, ...]:
        """One speed, one of weight and mass, something for a flywheel to even out."""
        one_mass = (
            one_of("parameters", f"G{link}", f"m{link}", required=link in cls.required) for link in cls.links["G"]
        )
        evened = (*(f"{letter}{link}" for letter in "GmJ" for link in cls.links[letter]), *cls.loads)
        return one_of("parameters", "n", "omega1"), *one_mass, needs_loads(evened)


def needs_loads(keys: Iterable[str]) -> Check:
    """A flywheel is asked for only where one of the parameters `keys` gives a mass or a load to even out."""
    known = tuple(keys)

    def check(draft: Draft) -> Iterator[Finding]:
        wanted = draft.at("parameters", "flywheel") is not None
        if wanted and not any(draft.at("parameters", key) for key in known):
            yield Finding("flywheel-without-loads", ("parameters", "flywheel"), at="key")

    return check


UNITS = {"deg": "°", "degree": "°", "N m": "N·m", "kg m2": "kg·m²", "m/s2": "m/s²", "N/cm2": "N/cm²"}
"""Units as they are printed, by what is typed."""


def as_typed(given: Given) -> Number:
    """A quantity as its file has it."""
    return Number(given.value, unit=UNITS.get(given.unit, given.unit))


# --- on the sheet -----------------------------------------------------------------------------------


class GivenSheet(Sheet):
    """The sheet that a machine opens: its given data as typed, and what the file gives for its links."""

    def __init__(self, given: Driven | None = None) -> None:
        super().__init__()
        self.given = given

    def datum(self, id: str, given: Given, symbol: Symbol | str = "", kind: str = "") -> Ref:
        """Enter a quantity as typed; a ratio `1/3.6` is worked out on the page."""
        top, slash, bottom = given.text.partition("/")
        if slash and not given.unit:
            return self.define(id, Number(float(top)) / float(bottom), symbol, kind)
        self.typed[id] = as_typed(given)
        return self.give(id, given.si, symbol, kind)

    def speed(self, n: Given | None = None, omega1: Given | None = None, flywheel: Flywheel | None = None) -> None:
        """ω₁ (its size) as given, or ω₁ = 2πn/60 from the speed in rpm; δ if a flywheel is asked for.

        A file with neither is refused by the kind's checks.
        """
        if self.given is not None:
            n, omega1, flywheel = self.given.n, self.given.omega1, self.given.flywheel
        if n is not None:
            rpm = n.value if n.unit == "rpm" else n.si * 30 / np.pi
            self.define("omega.1", 2 * PI * self.give("n", rpm) / 60)
        elif omega1 is not None:
            self.give("omega.1", omega1.si)
        if flywheel is not None:
            self.datum("unevenness", flywheel.delta, Symbol("δ", "ω"), "ratio")

    def drawn(self, start: str, end: str, asked: Given | None, default: float = CRANK_DRAWN) -> None:
        """The crank's drawn length: as asked for, else `default` (m on paper)."""
        self.give(ids.drawn(start, end), asked.si if asked else default, drawn_length(start, end))

    def drawn_by(self, scale: float, start: str, end: str, crank: Ref) -> None:
        """The crank's drawn length (mm) by a round scale (m per mm) of the drawing."""
        μ = self.give("scale", scale, Symbol("μ", "l"), "length scale")
        self.define(ids.drawn(start, end), crank / μ, drawn_length(start, end))

    # --- links

    def of_link(self, letter: str, link: int) -> Given | None:
        """What the file gives for a link: its `G`, `m`, `J` or `s`."""
        given: Given | None = getattr(self.given, f"{letter}{link}", None)
        return given

    def gravity(self, letters: str = "Gm") -> None:
        """g, if one of these letters is given for any link."""
        assert self.given is not None, "a sheet without parameters has no links"
        if any(self.of_link(letter, link) for letter in letters for link in self.given.links[letter]):
            self.datum("g", self.given.g)

    def mass(self, link: int, weight: Given | None = None, mass: Given | None = None, like: int = 0) -> None:
        """Weight and mass of a link: one as typed, or as that of the link `like`, the other from it; else none."""
        weight, mass = weight or self.of_link("G", link), mass or self.of_link("m", link)
        G, m = ids.weight(link), ids.mass(link)
        if weight is not None:
            self.define(m, self.datum(G, weight) / self["g"])
        elif mass is not None:
            self.define(G, self.datum(m, mass) * self["g"])
        elif like and self.families[ids.weight(like)].definition is None:
            self.define(m, self.define(G, self[ids.weight(like)]) / self["g"])
        elif like:
            self.define(G, self.define(m, self[ids.mass(like)]) * self["g"])

    def moment(self, link: int, default: Operand | None) -> None:
        """J about the mass centre: as given, else its `default`, such as m l²/12; none where there is no default."""
        given = self.of_link("J", link)
        if given is not None:
            self.datum(ids.inertia(link), given)
        elif default is not None:
            self.define(ids.inertia(link), default)

    def bar(self, link: int, start: str, end: str, always: bool = False) -> None:
        """A straight link from pin `start` to pin `end`: the place of its mass centre, l_AS = s·l, its mass, its J.

        The centre of a link without mass is entered only if its place is given, or `always`.
        """
        self.set_out("places")
        if not (always or any(self.of_link(letter, link) for letter in "sGmJ")):
            return
        length, share = self[ids.length(start, end)], self.of_link("s", link)
        s = self.give(ids.mass_centre(link), MIDDLE if share is None else share.si, kind="ratio")
        self.set_out("places", self.define(ids.length(start, f"S{link}"), s * length))
        self.mass(link)
        m = self.find(ids.mass(link))
        self.moment(link, None if m is None else m * length**2 / 12)

    def point(self, name: str, place: FixedPoint) -> None:
        """The coordinates of a fixed point as typed."""
        x = self.datum(ids.coordinate(name, "x"), place.x, Symbol("x", name), "length")
        y = self.datum(ids.coordinate(name, "y"), place.y, Symbol("y", name), "length")
        self.construct(ids.place(name), x + turned(y))

    def coordinates(self, name: str) -> tuple[Expression, Expression]:
        """The coordinates of a fixed point as far as they stand here and are not 0."""
        x, y = (self.find(ids.coordinate(name, axis)) or self.find(ids.frame_coordinate(axis, name)) for axis in "xy")
        return x if x and self.si(x) else NOTHING, y if y and self.si(y) else NOTHING

    def fix(self, id: str, at: complex, length: Operand) -> None:
        """A fixed point or a guide's point `at` (m) that lies at a `length` from the origin, and so goes with it."""
        far = self.construct(ids.far(id), length)
        if self.si(far):
            self.construct(id, far * self.give(ids.unit(id), complex(at / self.si(far)), Symbol(id), "ratio"))

    def bodies(self, bars: Mapping[int, tuple[str, str]], slider: int, always: bool = False) -> None:
        """Gravity if anything has mass; the bars by the pins at their ends, as `bar` does; the slider's mass."""
        self.gravity("GmJ")
        for link, (start, end) in bars.items():
            self.bar(link, start, end, always)
        self.mass(slider)

    def centre_points(self, pins: Mapping[int, str]) -> tuple[LinkPoint, ...]:
        """The mass centres S2, … that stand here, by their links and the pins they are measured from."""
        arms = {link: self.find(ids.length(pin, f"S{link}")) for link, pin in pins.items()}
        return tuple(LinkPoint(f"S{link}", link, complex(self.si(arm))) for link, arm in arms.items() if arm)

    def inertias(self, centres: Mapping[int, str]) -> tuple[Inertia, ...]:
        """The links with a mass or a moment of inertia, by their mass centres."""

        def size(id: str) -> float:
            return self.si(id) if id in self else 0.0

        every = (
            Inertia(link, centre, size(ids.mass(link)), size(ids.inertia(link))) for link, centre in centres.items()
        )
        return tuple(one for one in every if one.mass or one.moment)


def even_angles(positions: Positions, turns: int = 1) -> np.ndarray:
    """Cycle angles (rad) of evenly spaced positions [count·turns]."""
    return np.arange(positions.count * turns) * (FULL_TURN / positions.count)


def natural_sizes(r: float, ω: float) -> dict[str, float]:
    """What counts as one of each kind beside a crank of the length r (m) at ω (rad/s)."""
    return {
        "length": r,
        "velocity": ω * r,
        "acceleration": ω**2 * r,
        "angular velocity": ω,
        "angular acceleration": ω**2,
    }


def natural_lines(q: Sheet, crank: str) -> Callable[..., Ref]:
    """`q.define` with a scale by the kind of the quantity: what is natural to the crank of this id counts as one."""
    sizes = natural_sizes(q.si(crank), q.si("omega.1"))

    def define(id: str, definition: Operand, symbol: Symbol | str = "", kind: str = "") -> Ref:
        return q.define(id, definition, symbol, kind, scale=sizes.get(kind or vocabulary.row(id).kind, 0.0))

    return define


# --- the machine ------------------------------------------------------------------------------------


def outline(
    masses: bool,
    loads: bool,
    flywheel: Flywheel | None,
    *,
    sizes: str = "dimensions",
    load: str = "working",
    summary: tuple[str, ...] = (),
    course: tuple[str, ...] = (),
    driver: str = "crank",
) -> tuple[str, ...]:
    """The report's sections in order; without mass and load it ends with the kinematics.

    `sizes` and `load` tell where lengths and loads come from; `summary` follows the accelerations, `course` the
    kinematic diagrams.
    """
    kinematics = (*OPENING, sizes, "positions", "velocity", "acceleration", *summary, "diagrams", *course)
    if not (masses or loads):
        return (*kinematics, *CLOSING)
    inertia = ("loads",) if masses else ()
    wheel = () if flywheel is None else ("flywheel",)
    return (*kinematics, load, *inertia, "groups", driver, *wheel, *CLOSING)


def driven(
    assignment: Assignment,
    q: Sheet,
    linkage: Linkage,
    start: float,
    sections: Mapping[str, Any] | None = None,
    **own: Any,
) -> Machine:
    """The machine of an assignment whose crank stands at the angle `start` (rad) in position 1.

    `sections` go to `outline`, all further fields of its `Machine` are given by name; loads that are zero throughout
    are left out.
    """
    given, positions = assignment.parameters, assignment.positions
    loads = LoadsByKind.of((*own.pop("applied", ()), *own.pop("torques", ())))
    parts = dict(sections or {})
    if parts.get("load") == "cycle" and not loads.act:
        parts["load"] = "no-gas"
    fields: dict[str, Any] = {
        "count": positions.count,
        "turns": assignment.turns,
        "outline": outline(bool(linkage.inertias), loads.act, given.flywheel, **parts),
    }
    return Machine(
        kind=assignment.kind,
        linkage=linkage,
        start=start,
        turn=positions.sign,
        speed=given.speed,
        sheet=q,
        unevenness=given.unevenness,
        applied=loads.applied,
        torques=loads.torques,
        idle=loads.idle,
        **(fields | own),
    )
