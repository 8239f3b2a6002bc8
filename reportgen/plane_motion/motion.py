"""The motion of a system at the instant: rates of bodies and points, and centres of rotation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from reportgen.plane_motion.conditions import GROUND, STILL, Rates, Velocities
from reportgen.plane_motion.solving import (
    SMALL,
    Accelerations,
    Conflict,
    Solved,
    System,
    solve_accelerations,
    solve_velocities,
)


@dataclass(frozen=True)
class Motion:
    """A system with its velocities and its accelerations, each solved when it is first asked for."""

    system: System

    @cached_property
    def _first(self) -> Solved:
        return solve_velocities(self.system)

    @cached_property
    def _second(self) -> Accelerations:
        return solve_accelerations(self.system, self._first)

    @cached_property
    def velocities(self) -> Velocities:
        return Velocities(self._second.velocities.rates)

    # --- what is determined

    @property
    def velocity_conflicts(self) -> tuple[Conflict, ...]:
        return self._first.conflicts

    @property
    def acceleration_conflicts(self) -> tuple[Conflict, ...]:
        """Conditions that rule each other out in the accelerations, where the velocities are in order."""
        return () if self._first.conflicts else self._second.solved.conflicts

    @property
    def parting(self) -> tuple[int, ...]:
        """Bodies whose points have accelerations away from each other, which no rigid body can have."""
        return () if self._first.conflicts else self._second.parting

    def knows_omega(self, body: int) -> bool:
        return body == GROUND or self._first.determines_turn(body) or self._knows_square(body)

    def knows_velocity(self, point: str) -> bool:
        body = self.system.body_of(point)
        return body == GROUND or self._first.determines_point(body, self.system.points[point])

    def knows_epsilon(self, body: int) -> bool:
        return body == GROUND or (self.knows_omega(body) and self._second.solved.determines_turn(body))

    def knows_acceleration(self, point: str) -> bool:
        body = self.system.body_of(point)
        at = self.system.points[point]
        return body == GROUND or (self.knows_omega(body) and self._second.solved.determines_point(body, at))

    def knows_centre(self, body: int) -> bool:
        """Whether the whole velocity of a body is known."""
        places = {self.system.points[point] for point in self.system.bodies.get(body, ())}
        return body != GROUND and all(self._first.determines_point(body, place) for place in places)

    def _knows_square(self, body: int) -> bool:
        """Whether the accelerations tell ω² of a body, and with it all of its motion but its sense."""
        solved = self._second.solved
        return body in solved.unknowns.squared and not solved.free.size

    # --- rates: what is nothing beside the others is 0

    def omega(self, body: int) -> float:
        return _without_dust(self.velocities.omega(body), self.fastest / self.size).real

    def epsilon(self, body: int) -> float:
        return _without_dust(self._acceleration_of(body).turn, self._steepest / self.size).real

    def v(self, point: str, body: int | None = None) -> complex:
        """The velocity of a point, as it moves with its own body or with another."""
        own = self.system.body_of(point) if body is None else body
        return _without_dust(self.velocities.at(own, self.system.points[point]), self.fastest)

    def a(self, point: str, body: int | None = None) -> complex:
        """The acceleration of a point, as it moves with its own body or with another."""
        own = self.system.body_of(point) if body is None else body
        return _without_dust(self._acceleration_at(own, self.system.points[point]), self._steepest)

    @property
    def size(self) -> float:
        """How far the points lie from their middle."""
        return self._first.unknowns.size

    @cached_property
    def fastest(self) -> float:
        """The scale of the velocities."""
        middle = self._first.unknowns.middle
        each = ((abs(self.velocities.at(body, middle)), self.velocities.omega(body)) for body in self.system.bodies)
        return max((speed + abs(turn) * self.size for speed, turn in each), default=0.0)

    @cached_property
    def _steepest(self) -> float:
        """The scale of the accelerations."""
        middle, bodies = self._first.unknowns.middle, self.system.bodies
        each = (
            abs(self._acceleration_at(body, middle)) + abs(self._acceleration_of(body).turn) * self.size
            for body in bodies
        )
        return max(each, default=0.0)

    def _acceleration_at(self, body: int, at: complex) -> complex:
        rates = self._acceleration_of(body)
        return rates.origin + 1j * rates.turn * at - self.velocities.omega(body) ** 2 * at

    def _acceleration_of(self, body: int) -> Rates:
        return STILL if body == GROUND else self._second.solved.rates[body]

    def centre(self, body: int) -> complex | None:
        """The instant centre of a body; None where it is in translation, whose centre is infinitely far."""
        rates = self.velocities.of(body)
        if self.omega(body) == 0:
            return None
        return _without_dust(1j * rates.origin / rates.turn, self.size)


def _without_dust(value: complex, scale: float) -> complex:
    """A vector whose components are 0 where they are nothing beside the scale."""
    least = SMALL * scale
    value = complex(value)
    return complex(value.real if abs(value.real) > least else 0.0, value.imag if abs(value.imag) > least else 0.0)
