"""What the parameters of machines with a crank share: speed, gravity, masses, the flywheel, loads, and their checks.

A kind declares what of it there is: `class Parameters(Driven, masses=(2, 3), moments=(2,), shares=(2,))` reads the
weight `G2` or the mass `m2`, the moment of inertia `J2` and the place `s2` of the mass centre, with their checks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from reportgen.assignment.checks import one_of
from reportgen.assignment.common import Check, Draft, Part
from reportgen.assignment.fields import (
    AngularAcceleration,
    AngularVelocity,
    Coordinate,
    Gravity,
    Interval,
    Mass,
    MomentOfInertia,
    Ratio,
    RotationalSpeed,
    Share,
    Weight,
)
from reportgen.base.errors import Finding, Where
from reportgen.base.units import Given
from reportgen.catalogue import given_motion
from reportgen.catalogue.declared_loads import MOST_LOADS, CrankLoading, Link
from reportgen.catalogue.given_balancing import BalancingTask
from reportgen.catalogue.given_friction import JointFriction
from reportgen.catalogue.given_motion import MotionSection
from reportgen.catalogue.given_springs import Spring
from reportgen.catalogue.wide_sliders import Face
from reportgen.machine import DRIVER

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


class UnderGravity(Part):
    """Where a machine stands: gravity, none in a horizontal plane; its springs; how wide its sliders are, what rubs;
    whether what shakes the frame is worked out."""

    g: Gravity = Given(9.81, 9.81, "m/s2", "9.81 m/s2")
    plane: Literal["horizontal"] | None = None
    springs: Annotated[tuple[Spring, ...], Field(max_length=MOST_LOADS)] = ()
    faces: Annotated[dict[Link, Face], Field(max_length=MOST_LOADS)] = Field(default_factory=dict)
    balancing: BalancingTask | None = None
    friction: JointFriction | None = None

    @property
    def gravity(self) -> float:
        """g (m/s²), 0 in a horizontal plane."""
        return 0.0 if self.plane == "horizontal" else self.g.si


class Driven(UnderGravity):
    """The crank's speed in one of two ways and its acceleration, the flywheel that is asked for, masses if declared.

    Of the links `masses` and of the crank the weight or the mass may be given, of those `required` it must be;
    `moments` and `shares` are the links with J and s.  A flywheel needs a mass or one of the keys `loads`.
    """

    n: RotationalSpeed | None = None
    omega1: AngularVelocity | None = None
    epsilon1: AngularAcceleration | None = None
    flywheel: Flywheel | None = None
    motion: MotionSection | None = None
    loads: Annotated[tuple[CrankLoading, ...], Field(max_length=MOST_LOADS)] = ()

    links: ClassVar[Mapping[str, tuple[int, ...]]] = {}
    required: ClassVar[tuple[int, ...]] = ()
    evened: ClassVar[tuple[str, ...]] = ()
    crank_on_axis: ClassVar[bool] = False
    """Whether the crank's mass centre lies on its axis where `s1` is not given."""

    def __init_subclass__(
        cls,
        masses: Iterable[int] = (),
        required: Iterable[int] = (),
        moments: Iterable[int] = (),
        shares: Iterable[int] = (),
        loads: Iterable[str] = (),
        **rest: Any,
    ) -> None:
        of_masses, of_moments, of_shares = (tuple(sorted({DRIVER, *links})) for links in (masses, moments, shares))
        cls.links = {"G": of_masses, "m": of_masses, "J": of_moments, "s": of_shares}
        cls.required, cls.evened = tuple(required), (*loads, "loads", "springs")
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
    def acceleration(self) -> float:
        """ε₁ (rad/s²), positive in the sense of ω₁."""
        return 0.0 if self.epsilon1 is None else self.epsilon1.si

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
        evened = (*(f"{letter}{link}" for letter in "GmJ" for link in cls.links[letter]), *cls.evened)
        weights = [("parameters", f"G{link}") for link in cls.links["G"]]
        needed = needs_loads(evened), steady_flywheel("parameters", "epsilon1"), given_motion.check
        return one_of("parameters", "n", "omega1"), *one_mass, *needed, weightless(weights)


def needs_loads(keys: Iterable[str]) -> Check:
    """A flywheel is asked for only where one of the parameters `keys` gives a mass or a load to even out."""
    known = tuple(keys)

    def check(draft: Draft) -> Iterator[Finding]:
        wanted = draft.at("parameters", "flywheel") is not None
        if wanted and not any(draft.at("parameters", key) for key in known):
            yield Finding("flywheel-without-loads", ("parameters", "flywheel"), at="key")

    return check


def steady_flywheel(*acceleration: str) -> Check:
    """A flywheel evens a speed out that is constant in the mean, over a whole turn; true motion goes through one."""

    def check(draft: Draft) -> Iterator[Finding]:
        for asked in ("flywheel", "motion"):
            keys = ((acceleration, acceleration[-1]), (("positions", "at"), "at"))
            given = [key for place, key in keys if draft.at(*place) is not None]
            if given and draft.at("parameters", asked) is not None:
                yield Finding(f"{asked}-without-turn", ("parameters", asked), {"key": given[0]}, at="key")

    return check


def weightless(weights: Iterable[Where]) -> Check:
    """In a horizontal plane g is 0, and no mass follows from a weight."""
    places = tuple(weights)

    def check(draft: Draft) -> Iterator[Finding]:
        given: UnderGravity | None = draft.sections.get("parameters")
        if given is None:
            return
        if given.plane == "horizontal" and given.g.si and draft.at("parameters", "g") is not None:
            yield Finding("plane-with-gravity", ("parameters", "g"), {"text": given.g.text})
        for place in () if given.gravity else places:
            if _stands(draft.raw, place):
                mass = str(place[-1]).replace("G", "m")
                yield Finding("weight-without-gravity", place, {"key": str(place[-1]), "mass": mass}, at="key")

    return check


def _stands(content: Any, place: Where) -> bool:
    """Whether anything stands at a place of a file, which may lead into lists."""
    for key in place:
        fits = isinstance(content, list) if isinstance(key, int) else isinstance(content, dict)
        if not fits or (isinstance(key, int) and key >= len(content)):
            return False
        content = content[key] if isinstance(key, int) else content.get(key)
    return content is not None
