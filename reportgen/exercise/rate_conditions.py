"""Linear conditions on the rates of the bodies, from joints and given quantities.

The velocity of a point p that moves with a body is v(p) = v₀ + iω p, with v₀ of the body's point at the origin; its
acceleration is a(p) = a₀ + iε p − ω² p.  A condition is a sum of components of such vectors, and of angular rates, with
its value.  Velocities and accelerations share the coefficients; only the value differs: `drift` is the part of the
accelerations that is known once the velocities are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from reportgen.base.records import Record

GROUND = 0
"""The number of the body at rest, the ground."""


class Rates(Record):
    """The rates of a body: ω (rad/s) and v₀ (m/s) of its point at the origin, or ε (rad/s²) and a₀ (m/s²)."""

    turn: float
    origin: complex


STILL = Rates(0.0, 0j)


class Velocities(Record):
    """The rates of every body."""

    bodies: Mapping[int, Rates]

    def of(self, body: int) -> Rates:
        return STILL if body == GROUND else self.bodies[body]

    def omega(self, body: int) -> float:
        """Return ω of a body (rad/s)."""
        return self.of(body).turn

    def at(self, body: int, point: complex) -> complex:
        """Return v(p) = v₀ + iω p (m/s), the velocity of a point (m) that moves with a body."""
        rates = self.of(body)
        return rates.origin + rates.turn * (1j * point)


Drift = Callable[[Velocities], float]


def no_drift(_: Velocities) -> float:
    """Return 0: the drift of components that keep their value as the bodies move."""
    return 0.0


class Component(Record):
    """The component along the unit `direction` of the rate of a point (m) that moves with a body."""

    body: int
    point: complex
    direction: complex


class Condition(Record):
    """Σ components + Σ factor · turn = value, by body; a value of None puts no condition on that rate.

    `name` is the name in the file of the joint or given quantity to which the condition belongs.
    """

    name: str
    components: tuple[Component, ...] = ()
    turns: tuple[tuple[int, float], ...] = ()
    velocity: float | None = 0.0
    drift: Drift | None = no_drift


def _dot(a: complex, b: complex) -> float:
    return (a.conjugate() * b).real


def _between(
    name: str, direction: complex, point: complex, body: int, partner: int, drift: Drift | None = no_drift
) -> Condition:
    """Return the condition that two bodies' points at one place do not separate along a unit direction."""
    components = (Component(body, point, direction), Component(partner, point, -direction))
    return Condition(name, components, drift=drift)


# --- joints ---------------------------------------------------------------------------------------


def pin(name: str, point: complex, body: int, partner: int) -> tuple[Condition, ...]:
    """Return the conditions of two bodies that turn about a common point (m)."""
    return tuple(_between(name, axis, point, body, partner) for axis in (1 + 0j, 1j))


def slot(name: str, point: complex, body: int, carrier: int, angle: complex) -> tuple[Condition, ...]:
    """Return the condition of a point (m) of a body on a straight line of the carrier, with unit direction `angle`.

    Across the line the acceleration relative to the carrier's own point is the Coriolis acceleration, 2 ω v_r.
    """

    def coriolis(motion: Velocities) -> float:
        along = _dot(angle, motion.at(body, point) - motion.at(carrier, point))
        return 2 * motion.omega(carrier) * along

    return (_between(name, 1j * angle, point, body, carrier, coriolis),)


def no_turning(name: str, body: int, partner: int = GROUND) -> tuple[Condition, ...]:
    """Return the condition that two bodies rotate equally; with the ground, the body is in translation."""
    return (Condition(name, turns=((body, 1.0), (partner, -1.0))),)


def distance(name: str, first: complex, body: int, second: complex, partner: int) -> tuple[Condition, ...]:
    """Return the condition that two points (m), each of its own body, keep their distance: a rod or a taut cord."""
    span = first - second
    line = span / abs(span)

    def centripetal(motion: Velocities) -> float:
        apart = motion.at(body, first) - motion.at(partner, second)
        return -(abs(apart) ** 2 - _dot(line, apart) ** 2) / abs(span)

    return (Condition(name, (Component(body, first, line), Component(partner, second, -line)), drift=centripetal),)


def rolling_on_line(
    name: str, disc: int, centre: complex, radius: float, contact: complex, carrier: int
) -> tuple[Condition, ...]:
    """Return the conditions of a disc that rolls without slip on a line of the carrier, touching at `contact` (lengths
    in m).

    The centre keeps its distance from the line.  Along the line, neither the velocities nor the accelerations of the
    points in contact differ; across it the accelerations do, since the point of contact moves along the line.
    """
    across = (centre - contact) / radius
    return (*slot(name, centre, disc, carrier, -1j * across), _between(name, -1j * across, contact, disc, carrier))


def rolling_on_circle(
    name: str, disc: int, centre: complex, partner: int, other_centre: complex, contact: complex
) -> tuple[Condition, ...]:
    """Return the conditions of a disc that rolls without slip on the outside or inside of a circle of another
    body (m).
    """
    return (
        *distance(name, centre, disc, other_centre, partner),
        *meshing(name, disc, centre, partner, other_centre, contact),
    )


def meshing(
    name: str, disc: int, centre: complex, partner: int, other_centre: complex, contact: complex
) -> tuple[Condition, ...]:
    """Return the condition of two gears whose pitch circles touch at `contact` (m); other joints hold their centres."""
    along = 1j * (centre - other_centre) / abs(centre - other_centre)
    return (_between(name, along, contact, disc, partner),)


def belt(
    name: str, ends: tuple[complex, complex], centres: tuple[complex, complex], driving: int, driven: int
) -> tuple[Condition, ...]:
    """Return the condition of a belt without slip from a point (m) of one disc straight to one of another.

    The centres keep their distance, so the belt turns as the line of centres does.
    """
    span, between = ends[1] - ends[0], centres[1] - centres[0]
    line = span / abs(span)

    def turning(motion: Velocities) -> float:
        first, second = motion.at(driving, centres[0]), motion.at(driven, centres[1])
        rate = _dot(1j * between, second - first) / _dot(between, between)
        return -_dot(rate * (1j * line), first - second)

    return (Condition(name, (Component(driving, ends[0], line), Component(driven, ends[1], -line)), drift=turning),)


# --- given quantities -----------------------------------------------------------------------------


GivenComponent = Callable[[str, complex, int, complex, float], Condition]


def given_velocity(name: str, point: complex, body: int, direction: complex, size: float) -> Condition:
    """Return the condition for the component of a point's velocity (m/s) along a unit direction."""
    return Condition(name, (Component(body, point, direction),), velocity=size, drift=None)


def given_acceleration(name: str, point: complex, body: int, direction: complex, size: float) -> Condition:
    """Return the condition for the component of a point's acceleration (m/s²) along a unit direction."""
    return Condition(name, (Component(body, point, direction),), velocity=None, drift=lambda _: size)


def given_omega(name: str, body: int, omega: float) -> Condition:
    """Return the condition for ω of a body (rad/s)."""
    return Condition(name, turns=((body, 1.0),), velocity=omega, drift=None)


def given_epsilon(name: str, body: int, epsilon: float) -> Condition:
    """Return the condition for ε of a body (rad/s²)."""
    return Condition(name, turns=((body, 1.0),), velocity=None, drift=lambda _: epsilon)
