"""The profile of a cam by inversion: pitch and working curves, normals, pressure angle, curvature, undercut.

The plane is complex.  F(φ) is the follower's point (centre of the roller, edge of the knife, point of contact of a flat
face) in the fixed frame of a cam that turns anticlockwise about 0; in the cam's own frame it is F e^(−iφ).  With dots
for d/dφ the tangent there is (Ḟ − iF) e^(−iφ), so that N = F + iḞ is the outward normal in the fixed frame. If the
follower lifts in the direction t, F + iḞ = F + it dS/dφ for a lift S, so that the pressure angle α = arg(N/t) grows
with the speed of the lift in either sense of an arm.  The profile of a clockwise cam is the mirror image.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record
from reportgen.base.stable_digits import ALIKE, first_greatest
from reportgen.cam import cam_ids
from reportgen.cam.formulas import CamKind, enter_lengths, enter_lowest, enter_profile
from reportgen.cam.motion_laws import NODE, FollowerMotion
from reportgen.formula.array_evaluation import model
from reportgen.formula.calculation import Calculation

Numbers = NDArray[np.intp]


class Cam(Record, dict=True):
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

    @cached_property
    def kind(self) -> CamKind:
        """Return the kind of the cam, which selects its formulas."""
        return CamKind(self.translating, self.flat, bool(self.e), bool(self.roller), self.opposite, self.turn)

    @property
    def lengths(self) -> Mapping[str, float]:
        """Return its lengths (m) by their ids."""
        return {"cam.e": self.e, "cam.a": self.a, "cam.l": self.arm, "cam.r0": self.r0, "cam.roller": self.roller}

    @cached_property
    def calculation(self) -> Calculation:
        """Return the formulas of the report at one angle, which trace the cam."""
        q = Calculation()
        enter_lengths(q, self.kind, self.lengths)
        for id in ("cam.phi", *self.kind.moved):
            q.give(id, 0.0)
        if self.translating and not self.flat:
            enter_lowest(q, self.kind)
        enter_profile(q, self.kind)
        return q

    @property
    def s0(self) -> float:
        """Return s₀ (m), the height of the lowest position of a translating follower with a tip."""
        return self.calculation.si("cam.s0")

    @property
    def psi0(self) -> float:
        """Return ψ₀ (rad), the angle between arm or face and line of centres at the start."""
        return self.calculation.si("cam.psi0")

    def profile_at(self, φ: Floats, of: Numbers | None = None) -> CamProfile:
        """Return the cam at angles φ [N] (rad).

        `of` [N] are the indices, from 0, of the motion's interval at each angle; None finds them. At a corner, where
        two intervals meet, the index selects one side.
        """
        return CamProfile(self, φ, *self.motion(φ, of))

    def lifting(self, s: Floats) -> Complexes:
        """Return the unit direction [N] in which the follower lifts, in the fixed frame of an anticlockwise cam."""
        if self.translating:
            return np.full(s.shape, 1j)
        lifting: Complexes = 1j * np.exp(-1j * self.opposite * (self.psi0 + s))
        return lifting

    def mirrored(self, points: Complexes) -> Complexes:
        """Return points [N] of an anticlockwise cam, mirrored if this cam turns clockwise."""
        return points if self.turn > 0 else -points.conj()

    # --- curves

    def sampled(self, count: int = 720) -> CamProfile:
        """Return a whole turn with both sides of each corner of the motion, in equal steps within each interval."""
        angles, numbers = [], []
        for number, interval in enumerate(self.motion.intervals):
            # Whole degrees make whole steps, whatever rounding errors remain.
            steps = max(math.ceil(count * (interval.stop - interval.start) / (2 * math.pi) - 1e-6), 8)
            angles.append(np.linspace(interval.start, interval.stop, steps + 1))
            numbers.append(np.full(steps + 1, number))
        return self.profile_at(np.concatenate(angles), np.concatenate(numbers))

    def outline(self, count: int = 720, side: int = -1) -> Complexes:
        """Return the closed profile that is cut (m) [N], without repeated points; `side` +1 is the outer flank of the
        roller's groove.

        Corners left by a rigid impact are rounded.
        """
        profile = self.sampled(count)
        points = profile.pitch + side * self.roller * profile.normal
        if self.roller:
            points = np.concatenate([*self._with_arcs(profile, points, side)])
        apart = np.abs(np.diff(np.append(points, points[0])))
        return points[apart > NODE * self.r0]

    def _with_arcs(self, profile: CamProfile, points: Complexes, side: int) -> Iterator[Complexes]:
        """Yield the points (m) with an arc about the roller's centre wherever its normal jumps."""
        last = 0
        following = np.roll(profile.normal, -1)
        turned = np.angle(following / profile.normal)
        for number in map(
            int, np.flatnonzero((np.abs(np.roll(profile.pitch, -1) - profile.pitch) < NODE) & (abs(turned) > 1e-6))
        ):
            yield points[last : number + 1]
            between = np.exp(1j * np.linspace(0, turned[number], 12)[1:-1])
            yield profile.pitch[number] + side * self.roller * profile.normal[number] * between
            last = number + 1
        yield points[last:]

    @cached_property
    def undercut(self) -> tuple[float, ...]:
        """Return cam angles (rad) where the working profile has a cusp or is cut away, the worst of each interval."""
        if not (self.flat or self.roller):
            return ()
        angles = []
        for number in range(len(self.motion.intervals)):
            φ, least = self.worst(number, lambda cam: -cam.effective)
            if -least <= 0:
                angles.append(φ)
        # A convex corner remains where a uniform law stops abruptly.
        angles += [impact.angle for impact in self.motion.impacts if impact.kind == "rigid" and impact.jump < 0]
        return tuple(sorted(set(angles)))

    def worst(self, number: int, of: Callable[[CamProfile], Floats]) -> tuple[float, float]:
        """Return the place in an interval (rad) where a quantity of the cam is greatest, and its value (SI)."""
        interval = self.motion.intervals[number]

        def value(φ: Floats) -> Floats:
            return of(self.profile_at(φ, np.full(φ.shape, number)))

        return greatest(value, interval.start, interval.stop)


class CamProfile(Record, dict=True):
    """A cam over angles φ [N] (rad) with the follower's motion there; other arrays [N] are computed on first use.

    Points and normals are in the cam's frame, except `at`.
    """

    cam: Cam
    φ: Floats
    s: Floats
    ds: Floats
    dds: Floats

    def _of(self, *wanted: str) -> list[Floats]:
        """Return quantities [N] (SI) of the cam's calculation, by their ids."""
        motion = zip(self.cam.kind.moved, (self.s, self.ds, self.dds), strict=True)
        evaluated = model(self.cam.calculation, wanted, **{"cam.phi": self.φ, **dict(motion)})
        return [np.broadcast_to(evaluated[id], self.φ.shape) for id in wanted]

    @cached_property
    def alpha(self) -> Floats:
        """Return the pressure angle (rad) [N]; 0 under a flat face."""
        return np.zeros(self.φ.shape) if self.cam.flat else self._of("cam.alpha")[0]

    @cached_property
    def rho(self) -> Floats:
        """Return the radius of curvature (m) [N] of the pitch curve, or of the profile of a face, positive where
        convex.
        """
        return self._of("cam.rho")[0]

    @cached_property
    def pitch(self) -> Complexes:
        """Return the follower's point (m) [N]."""
        x, y = self._of(*map(cam_ids.profile if self.cam.flat else cam_ids.pitch, "xy"))
        return x + 1j * y

    @cached_property
    def working(self) -> Complexes:
        """Return the point of the profile (m) [N]."""
        if not self.cam.roller:
            return self.pitch
        x, y = self._of(*map(cam_ids.profile, "xy"))
        return x + 1j * y

    @property
    def effective(self) -> Floats:
        """Return the radius of curvature (m) [N] that decides on undercut: ρ − r_T where the pitch curve is convex.

        Where it is concave, the working curve has a larger radius and nothing is cut away.
        """
        if self.cam.flat:
            return self.rho
        return np.where((self.rho > 0) & np.isfinite(self.rho), self.rho - self.cam.roller, np.inf)

    @cached_property
    def at(self) -> Complexes:
        """Return the follower's point in the fixed frame (m) [N]."""
        turned: Complexes = np.exp(1j * self.cam.turn * self.φ)
        return self.pitch * turned

    @cached_property
    def normal(self) -> Complexes:
        """Return the outward unit normal [N]: the direction of the lift, turned by the pressure angle."""
        return self.cam.mirrored(self.cam.lifting(self.s) * np.exp(1j * (self.alpha - self.φ)))


FLAT = 1e-6
"""Neighbouring values that differ by less than this share of the greatest locate the maximum only by their
curvature.
"""


def greatest(of: Callable[[Floats], Floats], low: float, high: float) -> tuple[float, float]:
    """Return the place in an interval where a function is greatest, and its value: sampled, then refined.

    Values that are nearly equal no longer locate the maximum: then the parabola through three of them does.
    """
    x = np.linspace(low, high, 361)
    for _ in range(8):
        y = of(x)
        y = np.where(np.isnan(y), -np.inf, y)
        best = first_greatest(y)
        near = slice(max(best - 1, 0), min(best + 1, x.size - 1) + 1)
        if np.isfinite(y[near]).all() and np.ptp(y[near]) < FLAT * abs(y[best]):
            return _vertex(x[near], y[near], best - near.start)
        x = np.linspace(x[near][0], x[near][-1], 33)
    return float(x[best]), float(y[best])


def _vertex(x: Floats, y: Floats, best: int) -> tuple[float, float]:
    """Return the top of the parabola through three equally spaced samples, otherwise the best sample: place
    and value.
    """
    if len(x) < 3:
        return float(x[best]), float(y[best])
    bend, slope = y[0] - 2 * y[1] + y[2], (y[2] - y[0]) / 2
    if not bend < -ALIKE * abs(y[best]) or abs(slope) > -bend:
        return float(x[best]), float(y[best])
    return float(x[1] - slope / bend * (x[1] - x[0])), float(y[1] - slope**2 / (2 * bend))
