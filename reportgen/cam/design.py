"""Inverse design: the least cam that keeps the pressure angle within its limits, and a choice as a person rounds it.

A translating follower is designed on the S–S′ diagram: (s′ − e)/(s₀ + s) ≤ tan [α] in the rise is a straight line above
whose end the cam's centre lies, −(s′ − e)/(s₀ + s) ≤ tan [α′] in the return another.  Of an oscillating one
cos(q − [α]) ≥ (l k/a) cos [α] in the rise and cos(q + [α′]) ≤ (l k/a) cos [α′] in the return, q = ψ₀ + ψ, k = 1 ± ψ′.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from reportgen.base.units import MM
from reportgen.cam.laws import Floats, FollowerMotion
from reportgen.cam.profile import Cam, greatest

Rule = Literal["apex", "rise", "return"]
"""What decides: both lines together, or that of one phase."""
SHARE_OF_RHO, SHARE_OF_R0 = 0.8, 0.4
"""A roller is no larger than these shares of the least radius of curvature and of the base circle."""
GOLDEN = (math.sqrt(5) - 1) / 2
TALLEST = 400
"""So many steps a base circle grows at most until nothing is undercut."""


@dataclass(frozen=True)
class CamLimits:
    """Permissible pressure angles (rad) of rise and return, and the least radius of curvature of the profile (m)."""

    rise: float | None
    back: float | None
    rho: float


@dataclass(frozen=True)
class Touch:
    """Where the limit line of a phase touches: angle of the cam, s and s′ there, and what the line leaves (c or ψ₀)."""

    phi: float
    s: float
    ds: float
    bound: float


@dataclass(frozen=True)
class Least:
    """The least cam within the limits (m, rad): of a translating follower s₀ and e, of an oscillating one a and ψ₀."""

    rule: Rule
    r0: float
    e: float = 0.0
    s0: float = 0.0
    a: float = 0.0
    psi0: float = 0.0
    rise: Touch | None = None
    back: Touch | None = None
    apex: complex | None = None
    """Where both limit lines meet, as e + i s₀; nearer to the cam's centre there may be a foot on one of them."""


class NoCamError(ValueError):
    """No cam keeps the limits; `key` is what of the file stands against it."""

    def __init__(self, code: str, key: str) -> None:
        super().__init__(code)
        self.code, self.key = code, key


def touch(motion: FollowerMotion, phase: str, of: Callable[[Floats, Floats], Floats]) -> Touch:
    """Where in a phase a function of s and s′ is greatest."""
    best: Touch | None = None
    for number, one in enumerate(motion.stretches):
        if one.phase == phase:

            def value(φ: Floats, number: int = number) -> Floats:
                s, ds, _ = motion(φ, np.full(φ.shape, number))
                return of(s, ds)

            φ, bound = greatest(value, one.start, one.stop)
            if best is None or bound > best.bound:
                s, ds, _ = motion(np.array([φ]), np.array([number]))
                best = Touch(φ, float(s[0]), float(ds[0]), bound)
    assert best is not None, f"there is no {phase}"
    return best


def least_translating(motion: FollowerMotion, limits: CamLimits, e: float | None) -> Least:
    """The least cam of a translating follower with a knife or a roller, at a given offset or at the best one.

    c₁ = max(s′ − s tan [α]) and c₂ = max(−s′ − s tan [α′]) lead to s₀ ≥ (c₁ − e)/tan [α] and s₀ ≥ (c₂ + e)/tan [α′].
    """
    assert limits.rise is not None
    t1 = math.tan(limits.rise)
    rise = touch(motion, "rise", lambda s, ds: ds - t1 * s)
    back, t2 = None, math.inf
    if limits.back is not None:
        t2 = math.tan(limits.back)
        back = touch(motion, "return", lambda s, ds: -ds - t2 * s)
    c1, c2 = rise.bound, back.bound if back else 0.0

    high = (c1 + c2) / (t1 + t2)
    apex = complex(c1 - t1 * high, high) if back else None

    def at(rule: Rule, s0: float, offset: float) -> Least:
        return Least(rule, math.hypot(s0, offset), offset, s0, rise=rise, back=back, apex=apex)

    if e is not None:
        by_rise, by_return = (c1 - e) / t1, (c2 + e) / t2
        return at("rise", by_rise, e) if by_rise >= by_return else at("return", by_return, e)
    # The nearest point of the region to the origin: the foot on one line, if the other allows it, else the apex.
    foot = c1 / (1 + t1**2)
    if -foot + t2 * (foot * t1) >= c2:
        return at("rise", foot * t1, foot)
    foot = c2 / (1 + t2**2)
    if -foot + t1 * (foot * t2) >= c1:
        return at("return", foot * t2, -foot)
    return at("apex", high, c1 - t1 * high)


def least_oscillating(motion: FollowerMotion, limits: CamLimits, arm: float, opposite: int, a: float) -> Least | None:
    """The least cam of an oscillating roller at a distance a of the pivot; None where no ψ₀ keeps the limits."""
    assert limits.rise is not None
    α1, α2 = limits.rise, limits.back

    def share(ds: Floats, α: float) -> Floats:
        return arm * (1 + opposite * ds) * math.cos(α) / a

    def lowest(s: Floats, ds: Floats) -> Floats:
        found = share(ds, α1)
        return np.where(found > 1, np.inf, α1 - np.arccos(np.clip(found, -1, 1)) - s)

    def highest(s: Floats, ds: Floats) -> Floats:
        return -(α1 + np.arccos(np.clip(share(ds, α1), -1, 1)) - s)

    def of_return(s: Floats, ds: Floats) -> Floats:
        assert α2 is not None
        return np.arccos(np.clip(share(ds, α2), -1, 1)) - α2 - s

    rise, most = touch(motion, "rise", lowest), -touch(motion, "rise", highest).bound
    back = touch(motion, "return", of_return) if α2 is not None else None
    rule: Rule = "return" if back is not None and back.bound > rise.bound else "rise"
    ψ0 = max(rise.bound, back.bound if back else -math.inf)
    if not 0 < ψ0 <= most or ψ0 + motion.stroke >= math.pi:
        return None
    r0 = math.sqrt(a**2 + arm**2 - 2 * a * arm * math.cos(ψ0))
    return Least(rule, r0, a=a, psi0=ψ0, rise=rise, back=back)


def best_distance(motion: FollowerMotion, limits: CamLimits, arm: float, opposite: int) -> Least:
    """The least cam of an oscillating roller at the best distance a of the pivot, between 0.4 and 3 arms.

    The region of the centres is convex, so that r₀ over a has one valley: a golden section finds it.
    """

    def of(a: float) -> float:
        found = least_oscillating(motion, limits, arm, opposite, a)
        return math.inf if found is None else found.r0

    grid = np.linspace(0.4 * arm, 3 * arm, 53)
    sizes = [of(float(a)) for a in grid]
    best = int(np.argmin(sizes))
    if not math.isfinite(sizes[best]):
        raise NoCamError("cam-no-centre", "limits")
    low, high = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    while high - low > 1e-9 * arm:
        one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        low, high = (low, other) if of(one) <= of(other) else (one, high)
    found = least_oscillating(motion, limits, arm, opposite, (low + high) / 2)
    assert found is not None
    return found


def least_flat(cam: Cam, rho: float) -> float:
    """The least r₀ with which the profile under a flat face is convex with a radius of curvature ρ at least.

    A translating face: r₀ = ρ − min(s + s″).
    """

    def flattest(r0: float) -> float:
        tried = replace(cam, r0=r0)
        every = range(len(cam.motion.stretches))
        return min(-tried.worst(number, lambda one: -one.traced.rho)[1] for number in every)

    if cam.translating:
        return max(rho - flattest(0.0), rho)
    low, high = 0.0, 0.999 * cam.a * math.sin(min(math.pi / 2, max(math.pi - cam.motion.stroke, 0.0)))
    if flattest(high) < rho:
        raise NoCamError("cam-not-convex", "r0")
    while high - low > 1e-9 * cam.a:
        middle = (low + high) / 2
        low, high = (low, middle) if flattest(middle) >= rho else (middle, high)
    return high


# --- a choice as a person rounds it ---------------------------------------------------------------


def step_of(length: float) -> float:
    """What a length (m) is rounded to: half a millimetre below 5 mm, then 1 mm, 5 mm from 20 mm and 10 mm from 200."""
    sizes = ((0.005, 0.5), (0.020, 1.0), (0.200, 5.0))
    return next((step for most, step in sizes if length < most), 10.0) / MM


def rounded_up(length: float) -> float:
    """The least round length that is no less."""
    step = step_of(length)
    return round(math.ceil(length / step - 1e-9) * step, 9)


def rounded_down(length: float) -> float:
    """The greatest round length that is no more, to whole millimetres where it has several."""
    step = min(step_of(length), 1.0 / MM)
    return round(math.floor(length / step + 1e-9) * step, 9)


def grown(cam: Cam, rho: float) -> Cam:
    """The cam with so large a base circle, by round steps, that no radius of curvature of its profile is below ρ."""
    for _ in range(TALLEST):
        if sharpest(cam) >= rho - 1e-12:
            return cam
        cam = replace(cam, r0=rounded_up(cam.r0 + step_of(cam.r0) * 0.999))
        if not cam.translating and cam.r0 >= cam.a + cam.arm:
            break
    raise NoCamError("cam-not-convex", "r0")


def sharpest(cam: Cam) -> float:
    """The least radius of curvature where the working profile is convex; infinite where it nowhere is."""
    every = range(len(cam.motion.stretches))
    return min(-cam.worst(number, lambda one: -one.effective)[1] for number in every)


def largest_roller(cam: Cam, rho: float) -> float:
    """r_T ≤ 0.8 ρ_min and ≤ 0.4 r₀, and so that ρ is left of the profile's convex curvature, rounded down."""
    bare = replace(cam, roller=0.0)
    least = sharpest(bare)
    found = rounded_down(min(SHARE_OF_RHO * least, SHARE_OF_R0 * cam.r0, least - rho))
    if found <= 0:
        raise NoCamError("cam-no-roller", "roller")
    return found
