"""The profile of a cam by inversion: pitch and working curves, normals, pressure angle, curvature, undercut.

The plane is complex.  F(φ) is the follower's point (centre of the roller, edge of the knife, point of contact of a
flat face) in the fixed frame of a cam that turns anticlockwise about 0; in the cam's own frame it is F e^(−iφ).  With
dots for d/dφ the tangent there is (Ḟ − iF) e^(−iφ), so that N = F + iḞ is the outward normal in the fixed frame.  With
the way t in which the follower lifts, F + iḞ = F + it dS/dφ for a lift S, so that the pressure angle α = arg(N/t) grows
with the speed of the lift in either sense of an arm.  The profile of a cam that turns clockwise is the mirror image.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reportgen.cam.laws import NODE, Floats, FollowerMotion

Complexes = NDArray[np.complexfloating[Any, Any]]
Numbers = NDArray[np.intp]


@dataclass(frozen=True)
class Traced:
    """A cam over angles [N]: motion, the follower's point in both frames, normals, pressure angle, radii of curvature.

    `normal` is of length 1 in the cam's frame; `ρ` of the pitch curve, or the profile of a flat face, is positive where
    it is convex.  `pitch` and `working` are in the cam's frame, `outer` the other branch of the offset.
    """

    φ: Floats
    s: Floats
    ds: Floats
    dds: Floats
    at: Complexes
    pitch: Complexes
    normal: Complexes
    alpha: Floats
    rho: Floats
    working: Complexes


@dataclass(frozen=True)
class Cam:
    """A cam and its follower, lengths in m.

    `r0` is the least radius of the pitch curve, or of the profile of a flat face; `e` the offset of a translating
    follower on the side that eases the rise.  An oscillating one has its pivot at the distance `a` and an `arm`; it
    lifts `opposite` to the cam's rotation (+1) or with it (−1).  `turn` is +1 anticlockwise.
    """

    motion: FollowerMotion
    translating: bool
    flat: bool
    r0: float
    e: float = 0.0
    a: float = 0.0
    arm: float = 0.0
    opposite: int = 1
    roller: float = 0.0
    turn: int = 1

    @property
    def s0(self) -> float:
        """s₀ = √(r₀² − e²), the height of the lowest position of a translating follower."""
        return math.sqrt(max(self.r0**2 - self.e**2, 0.0))

    @property
    def psi0(self) -> float:
        """ψ₀ of arm and line of centres at the start: cos ψ₀ = (a² + l² − r₀²)/2al; of a face sin ψ₀ = r₀/a."""
        if self.flat:
            return math.asin(min(self.r0 / self.a, 1.0))
        cosine = (self.a**2 + self.arm**2 - self.r0**2) / (2 * self.a * self.arm)
        return math.acos(min(max(cosine, -1.0), 1.0))

    def traced(self, φ: Floats, of: Numbers | None = None) -> Traced:
        """The cam at angles [N]; `of` says in which stretch of the motion each is taken to be."""
        s, ds, dds = self.motion(φ, of)
        point, normal, alpha, rho = (self._translating if self.translating else self._oscillating)(s, ds, dds)
        turned = np.exp(-1j * φ)
        normal = normal / np.abs(normal)
        pitch, out = self.mirrored(point * turned), self.mirrored(normal * turned)
        return Traced(
            φ,
            s,
            ds,
            dds,
            at=self.mirrored(point),
            pitch=pitch,
            normal=out,
            alpha=alpha,
            rho=rho,
            working=pitch - self.roller * out,
        )

    def mirrored(self, points: Complexes) -> Complexes:
        """Points of a cam that turns anticlockwise as they are at one that turns as this does."""
        return points if self.turn > 0 else -points.conj()

    def _translating(self, s: Floats, ds: Floats, dds: Floats) -> tuple[Complexes, Complexes, Floats, Floats]:
        """Along +y at x = e: tan α = (s′ − e)/(s₀ + s); a flat face is touched at s′ from the axis."""
        if self.flat:
            high = self.r0 + s
            return ds + 1j * high, np.full(s.shape, 1j, dtype=np.complex128), np.zeros(s.shape), high + dds
        high, aside = self.s0 + s, self.e - ds
        with np.errstate(divide="ignore", invalid="ignore"):
            rho = (high**2 + aside**2) ** 1.5 / (high * (high - dds) + aside * (aside - ds))
        return self.e + 1j * high, aside + 1j * high, np.arctan2(-aside, high), rho

    def _oscillating(self, s: Floats, ds: Floats, dds: Floats) -> tuple[Complexes, Complexes, Floats, Floats]:
        """About σa: tan α = σ(l k − a cos q)/(a sin q) with q = ψ₀ + ψ and k = 1 + σψ′, σ = +1 for opposite senses.

        F = σ(a − l cos q) + il sin q gives N = F + iḞ = σ(a − lk cos q) + ilk sin q; the arm lifts along
        t = σ sin q + i cos q, and N·t = a sin q, t × N = σ(lk − a cos q).
        """
        σ, a, q = self.opposite, self.a, self.psi0 + s
        k = 1 + σ * ds
        cos, sin = np.cos(q), np.sin(q)
        if self.flat:
            along = a * cos / k
            rho = a * sin + (a * cos * dds - a * sin * ds**2 - σ * a * cos * ds * dds / k) / k**2
            return σ * a + along * (1j * sin - σ * cos), sin * σ + 1j * cos, np.zeros(s.shape), rho
        arm = self.arm
        u, w = arm * k * sin, a - arm * k * cos
        with np.errstate(divide="ignore", invalid="ignore"):
            bent = u * arm * (k**2 * sin - dds * cos) + w * (a - arm * (k**2 * cos + dds * sin))
            rho = (u**2 + w**2) ** 1.5 / bent
        alpha = np.arctan2(σ * (arm * k - a * cos), a * sin)
        return σ * (a - arm * cos) + 1j * arm * sin, σ * w + 1j * u, alpha, rho

    # --- curves

    def sampled(self, count: int = 720) -> Traced:
        """A whole turn, both sides of each corner of the motion: evenly spaced within each stretch."""
        angles, numbers = [], []
        for number, one in enumerate(self.motion.stretches):
            steps = max(math.ceil(count * (one.stop - one.start) / (2 * math.pi)), 8)
            angles.append(np.linspace(one.start, one.stop, steps + 1))
            numbers.append(np.full(steps + 1, number))
        return self.traced(np.concatenate(angles), np.concatenate(numbers))

    def outline(self, count: int = 720, side: int = -1) -> Complexes:
        """The closed profile that is cut [N], no point twice; with `side` +1 the outer flank of the roller's groove.

        Corners that a rigid impact leaves are rounded.
        """
        traced = self.sampled(count)
        points = traced.pitch + side * self.roller * traced.normal
        if self.roller:
            points = np.concatenate([*self._with_arcs(traced, points, side)])
        apart = np.abs(np.diff(np.append(points, points[0])))
        return points[apart > NODE * self.r0]

    def _with_arcs(self, traced: Traced, points: Complexes, side: int) -> Iterator[Complexes]:
        """The points with an arc about the roller's centre wherever its normal turns at once."""
        last = 0
        following = np.roll(traced.normal, -1)
        turned = np.angle(following / traced.normal)
        for number in map(
            int, np.flatnonzero((np.abs(np.roll(traced.pitch, -1) - traced.pitch) < NODE) & (abs(turned) > 1e-6))
        ):
            yield points[last : number + 1]
            between = np.exp(1j * np.linspace(0, turned[number], 12)[1:-1])
            yield traced.pitch[number] + side * self.roller * traced.normal[number] * between
            last = number + 1
        yield points[last:]

    @cached_property
    def undercut(self) -> tuple[float, ...]:
        """Angles of the cam at which the working profile has a cusp or is cut away, the worst of each stretch."""
        if not (self.flat or self.roller):
            return ()
        found = []
        for number in range(len(self.motion.stretches)):
            φ, least = self.worst(number, lambda cam: -cam.effective)
            if -least <= 0:
                found.append(φ)
        # Where a uniform law stops at once a convex corner is left.
        found += [one.angle for one in self.motion.impacts if one.kind == "rigid" and one.jump < 0]
        return tuple(sorted(set(found)))

    def worst(self, number: int, of: Callable[[Shown], Floats]) -> tuple[float, float]:
        """Where in a stretch a quantity of the cam is greatest, and how great it is."""
        one = self.motion.stretches[number]

        def value(φ: Floats) -> Floats:
            return of(Shown(self, self.traced(φ, np.full(φ.shape, number))))

        return greatest(value, one.start, one.stop)


@dataclass(frozen=True)
class Shown:
    """A cam traced, with what is judged of it."""

    cam: Cam
    traced: Traced

    @property
    def effective(self) -> Floats:
        """The radius of curvature (m) by which undercut is judged: ρ − r_T where the pitch curve is convex.

        Where it is concave the working one has a larger radius, and nothing is cut away.
        """
        rho = self.traced.rho
        if self.cam.flat:
            return rho
        return np.where((rho > 0) & np.isfinite(rho), rho - self.cam.roller, np.inf)


def greatest(of: Callable[[Floats], Floats], low: float, high: float) -> tuple[float, float]:
    """Where in an interval a function is greatest, and its value: sampled, then closer and closer about the best."""
    x = np.linspace(low, high, 361)
    for _ in range(8):
        y = np.nan_to_num(of(x), nan=-np.inf, posinf=np.inf, neginf=-np.inf)
        best = int(y.argmax())
        found = float(x[best]), float(y[best])
        x = np.linspace(x[max(best - 1, 0)], x[min(best + 1, x.size - 1)], 33)
    return found
