"""What machines with a crank at constant speed have in common: its speed, g, masses, the flywheel, the outline."""

from __future__ import annotations

from collections.abc import Iterable

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Acceleration, AngularVelocity, RotationalSpeed
from reportgen.catalogue import regulation
from reportgen.catalogue.machine import Item, speed_items
from reportgen.units import Given

OPENING = ("given", "contents", "foreword", "structure", "motion")
CLOSING = ("conclusion", "references", "checks")


class Driven(Part):
    """The crank's speed in one of two ways, gravity, and the flywheel that is asked for."""

    n: RotationalSpeed | None = None
    omega1: AngularVelocity | None = None
    g: Acceleration = Given(9.81, 9.81, "m/s2", "9.81 m/s2")
    flywheel: regulation.Flywheel | None = None

    @property
    def speed(self) -> float:
        """|ω1| (rad/s)."""
        given = self.n or self.omega1
        assert given is not None, "a file without speed is refused by the kind's checks"
        return given.si

    @property
    def unevenness(self) -> float | None:
        """δ of the flywheel, None if none is asked for."""
        return None if self.flywheel is None else self.flywheel.delta.si

    def mass(self, link: int) -> float:
        """m = G/g (kg) of a link whose weight G or mass m may be given, 0 if neither is."""
        weight: Given | None = getattr(self, f"G{link}")
        mass: Given | None = getattr(self, f"m{link}")
        return weight.si / self.g.si if weight is not None else mass.si if mass is not None else 0.0


def mass_keys(links: Iterable[int]) -> tuple[str, ...]:
    """The keys that give links a mass: weight, mass, moment of inertia."""
    return tuple(f"{letter}{link}" for link in links for letter in "GmJ")


def rate_items(given: Driven) -> tuple[Item, ...]:
    """ω₁ as given or from n, and δ if a flywheel is asked for."""
    return (*speed_items(given.n, given.omega1), *regulation.items(given.flywheel))


def outline(
    masses: bool,
    loads: bool,
    flywheel: regulation.Flywheel | None,
    *,
    sizes: str = "dimensions",
    load: str = "working",
    summary: tuple[str, ...] = (),
    course: tuple[str, ...] = (),
    driver: str = "crank",
) -> tuple[str, ...]:
    """The report's sections in order; without mass and load it ends with the kinematics.

    `sizes` and `load` tell where lengths and loads come from; `summary` follows the velocities, `course` the
    accelerations.
    """
    kinematics = (*OPENING, sizes, "positions", "velocity", *summary, "acceleration", *course)
    if not (masses or loads):
        return (*kinematics, *CLOSING)
    inertia = ("loads",) if masses else ()
    wheel = () if flywheel is None else ("flywheel",)
    return (*kinematics, load, *inertia, "groups", driver, *wheel, *CLOSING)
