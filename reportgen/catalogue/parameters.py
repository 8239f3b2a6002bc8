"""Parameters that machines with a crank share: speed, gravity, masses, loads, and their checks.

A kind declares which of them it has: `class Parameters(Driven, masses=(2, 3), moments=(2,), shares=(2,))` reads the
weight `G2` or the mass `m2`, the moment of inertia `J2` and the place of the mass centre, as a share `s2` of the
link or by two coordinates `S2`, with their checks.
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
    Mass,
    MomentOfInertia,
    PointCoordinates,
    RotationalSpeed,
    Share,
    Weight,
)
from reportgen.base.errors import Finding, Where
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import MOST_LOADS, CrankLoading
from reportgen.catalogue.topic_sections import TopicParameters
from reportgen.machine import DRIVER


class FixedPoint(Part):
    """A fixed point by its coordinates from the crank's centre, x to the right and y upwards."""

    x: Coordinate
    y: Coordinate


OF_LINK: Mapping[str, Any] = {"G": Weight, "m": Mass, "J": MomentOfInertia, "s": Share, "S": PointCoordinates}
"""Types of the values that a file may give for a link, by the letter before its number."""


class UnderGravity(TopicParameters):
    """Parameters of a machine under gravity; there is none in a horizontal plane."""

    g: Gravity = Given(9.81, 9.81, "m/s2", "9.81 m/s2")
    plane: Literal["horizontal"] | None = None

    @property
    def gravity(self) -> float:
        """g (m/s²), 0 in a horizontal plane."""
        return 0.0 if self.plane == "horizontal" else self.g.si


class Driven(UnderGravity):
    """The crank's speed in one of two forms and its acceleration; masses if declared.

    The weight or the mass of the crank and of the links `masses` may be given, and must be for the links `required`;
    `moments` are the links with J, `shares` those with s or S; `centres` are further links with S.  The keys `loads`
    give loads of the kind.
    """

    n: RotationalSpeed | None = None
    omega1: AngularVelocity | None = None
    epsilon1: AngularAcceleration | None = None
    loads: Annotated[tuple[CrankLoading, ...], Field(max_length=MOST_LOADS)] = ()

    links: ClassVar[Mapping[str, tuple[int, ...]]] = {}
    required: ClassVar[tuple[int, ...]] = ()
    acceleration_key: ClassVar[tuple[str, ...]] = ("parameters", "epsilon1")
    crank_on_axis: ClassVar[bool] = False
    """True if the crank's mass centre lies on its axis when `s1` is not given."""

    def __init_subclass__(
        cls,
        masses: Iterable[int] = (),
        required: Iterable[int] = (),
        moments: Iterable[int] = (),
        shares: Iterable[int] = (),
        centres: Iterable[int] = (),
        loads: Iterable[str] = (),
        **rest: Any,
    ) -> None:
        super().__init_subclass__(**rest)
        if cls.topic_names:
            # Everything else belongs to the class below, to which sections of topics are added.
            return
        given = masses, moments, shares, (*shares, *centres)
        of_masses, of_moments, of_shares, of_centres = (tuple(sorted({DRIVER, *links})) for links in given)
        cls.links = {"G": of_masses, "m": of_masses, "J": of_moments, "s": of_shares, "S": of_centres}
        cls.required = tuple(required)
        cls.mass_keys = tuple(f"{letter}{link}" for letter in "GmJ" for link in cls.links[letter])
        cls.moment_keys = tuple(f"J{link}" for link in cls.links["J"])
        cls.load_keys = (*cls.mass_keys, *loads, "loads")
        # A field of pydantic is an annotation with a default; here both are made without a class body.
        for letter, numbers in cls.links.items():
            for number in numbers:
                cls.__annotations__[f"{letter}{number}"] = OF_LINK[letter] | None
                setattr(cls, f"{letter}{number}", None)

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

    @classmethod
    def checks(cls) -> tuple[Check, ...]:
        """Return the checks that each link has one speed, one of weight and mass, and one place of its mass centre."""
        one_mass = (
            one_of("parameters", f"G{link}", f"m{link}", required=link in cls.required) for link in cls.links["G"]
        )
        one_place = (one_of("parameters", f"s{link}", f"S{link}", required=False) for link in cls.links["s"])
        weights = [("parameters", f"G{link}") for link in cls.links["G"]]
        return one_of("parameters", "n", "omega1"), *one_mass, *one_place, weightless(weights)


def weightless(weights: Iterable[Where]) -> Check:
    """Return a check that refuses weights in a horizontal plane: with g = 0 no mass follows from a weight."""
    places = tuple(weights)

    def check(draft: Draft) -> Iterator[Finding]:
        given: UnderGravity | None = draft.sections.get("parameters")
        if given is None:
            return
        if given.plane == "horizontal" and given.g.si and draft.at("parameters", "g") is not None:
            yield Finding("plane-with-gravity", ("parameters", "g"), {"text": given.g.text})
        for place in () if given.gravity else places:
            if _has_value(draft.raw, place):
                mass = str(place[-1]).replace("G", "m")
                yield Finding("weight-without-gravity", place, {"key": str(place[-1]), "mass": mass}, at="key")

    return check


def _has_value(content: Any, place: Where) -> bool:
    """Return True if a file has a value at a place, which may lead into lists."""
    for key in place:
        fits = isinstance(content, list) if isinstance(key, int) else isinstance(content, dict)
        if not fits or (isinstance(key, int) and key >= len(content)):
            return False
        content = content[key] if isinstance(key, int) else content.get(key)
    return content is not None
