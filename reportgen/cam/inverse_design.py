"""Inverse design: the least cam that keeps the pressure angle within its limits, and round lengths above it.

A translating follower is designed on the S–S′ diagram: (s′ − e)/(s₀ + s) ≤ tan [α] in the rise is a half-plane for the
cam's centre, −(s′ − e)/(s₀ + s) ≤ tan [α′] in the return another.  For an oscillating one tan α = ±(lk − a cos q)/(a
sin q), q = ψ₀ + ψ, k = 1 ± ψ′, with + if cam and arm turn in opposite senses.  Then the rise needs cos(q − [α]) ≥ (l
k/a) cos [α] and the return cos(q + [α′]) ≤ (l k/a) cos [α′]; if they turn in the same sense, rise and return exchange
their conditions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Literal

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record, replace
from reportgen.base.units import MM
from reportgen.cam import formulas
from reportgen.cam.formulas import valued
from reportgen.cam.motion_laws import FollowerMotion
from reportgen.cam.profile import Cam, greatest
from reportgen.formula import Ref
from reportgen.formula.evaluation import evaluate

LimitingLine = Literal["apex", "rise", "return"]
"""The deciding limit: both lines together, or that of one phase."""
SHARE_OF_RHO, SHARE_OF_R0 = 0.8, 0.4
"""A roller is at most these shares of the least radius of curvature and of the base circle."""
GOLDEN = (math.sqrt(5) - 1) / 2
USUAL_RISE = {True: math.radians(40), False: math.radians(45)}
"""The usual largest pressure angle (rad) in the rise, of a translating follower (True) and of an oscillating one."""
USUAL_BY_SPRING = math.radians(80)
"""The usual largest pressure angle (rad) in a return driven by a spring."""
TALLEST = 400
"""Largest number of steps by which a base circle grows until nothing is undercut."""
STEPS = 60
"""Number of base circles under an oscillating face that are tried until one is large enough."""


class CamLimits(Record):
    """Permissible pressure angles (rad) of rise and return, and the least radius of curvature of the profile (m)."""

    rise: float | None
    back: float | None
    rho: float


class Touch(Record):
    """Point where the limit line of a phase touches: cam angle (rad), s and s′ there, and the resulting bound (c in m
    or ψ₀ in rad).
    """

    phi: float
    s: float
    ds: float
    bound: float


class Least(Record):
    """The least cam within the limits (m, rad): s₀ and e of a translating follower, a and ψ₀ of an oscillating one.

    `most` is the largest ψ₀ within them.
    """

    rule: LimitingLine
    r0: float
    e: float = 0.0
    s0: float = 0.0
    a: float = 0.0
    psi0: float = 0.0
    most: float = math.inf
    rise: Touch | None = None
    back: Touch | None = None
    apex: complex | None = None
    """Intersection of both limit lines, as e + i s₀ (m); a foot on one of them may be nearer to the cam's centre."""


class NoCamError(ValueError):
    """Raised if no cam keeps the limits; `key` is the key of the file that prevents it."""

    def __init__(self, code: str, key: str) -> None:
        super().__init__(code)
        self.code, self.key = code, key


def touch(motion: FollowerMotion, phase: str, of: Callable[[Floats, Floats], Floats]) -> Touch:
    """Return the point in a phase where a function (SI) of s and s′ [N] is greatest."""
    best: Touch | None = None
    for number, interval in enumerate(motion.intervals):
        if interval.phase == phase:

            def value(φ: Floats, number: int = number) -> Floats:
                s, ds, _ = motion(φ, np.full(φ.shape, number), derivatives=1)
                return of(s, ds)

            φ, bound = greatest(value, interval.start, interval.stop)
            if best is None or bound > best.bound:
                s, ds, _ = motion(np.array([φ]), np.array([number]))
                best = Touch(φ, float(s[0]), float(ds[0]), bound)
    assert best is not None, f"there is no {phase}"
    return best


def least_translating(motion: FollowerMotion, limits: CamLimits, e: float | None) -> Least:
    """Return the least cam of a translating knife or roller follower, at an offset e (m), or at the best one if it is
    None.

    c₁ = max(s′ − s tan [α]) and c₂ = max(−s′ − s tan [α′]) give s₀ ≥ (c₁ − e)/tan [α] and s₀ ≥ (c₂ + e)/tan [α′]. If
    the limit of the rise alone leaves s₀ free (e ≥ c₁), the return decides, with the usual limit of a spring.
    """
    assert limits.rise is not None
    α1, α2 = limits.rise, limits.back or USUAL_BY_SPRING
    rise = touch(motion, "rise", lambda s, ds: valued(formulas.rise_intercept, s, ds, α1))
    c1, back, apex = rise.bound, None, None
    if limits.back is not None or (e is not None and e >= c1):
        back = touch(motion, "return", lambda s, ds: valued(formulas.return_intercept, s, ds, α2))
        high = float(valued(formulas.apex_height, c1, back.bound, α1, α2))
        apex = complex(float(valued(formulas.apex_offset, c1, high, α1)), high)

    def by_rise(offset: float) -> float:
        return float(valued(formulas.height_by_rise, c1, offset, α1))

    def by_return(offset: float) -> float:
        # If nothing limits the return, the follower only has to stay above the cam's centre.
        return 0.0 if back is None else float(valued(formulas.height_by_return, back.bound, offset, α2))

    def at(rule: LimitingLine, s0: float, offset: float) -> Least:
        r0 = float(valued(formulas.base_radius, s0, offset))
        return Least(rule, r0, offset, s0, rise=rise, back=back, apex=apex)

    if e is not None:
        return at("rise", by_rise(e), e) if by_rise(e) >= by_return(e) else at("return", by_return(e), e)
    # The point of the region nearest to the origin: the foot on one line, if the other allows it, else the apex.
    foot = float(valued(formulas.foot_of_rise, c1, α1))
    if (s0 := float(valued(formulas.height_on_rise, foot, α1))) >= by_return(foot):
        return at("rise", s0, foot)
    if back is not None:
        foot = float(valued(formulas.foot_of_return, back.bound, α2))
        if (s0 := float(valued(formulas.height_on_return, foot, α2))) >= by_rise(foot):
            return at("return", s0, foot)
    assert apex is not None, "without a limit of the return the foot on the line of the rise is the nearest"
    return at("apex", apex.imag, apex.real)


def least_oscillating(motion: FollowerMotion, limits: CamLimits, arm: float, opposite: int, a: float) -> Least | None:
    """Return the least cam of an oscillating follower, arm and pivot distance `a` in m; None if no ψ₀ keeps the limits.

    If the limit of the rise alone leaves ψ₀ free, down to an arm in line with the centres, the return decides, with the
    usual limit of a spring.
    """
    assert limits.rise is not None
    bounds = [bounded(motion, "rise", limits.rise, arm, opposite, a)]
    if limits.back is not None or bounds[0][0].bound <= 0:
        bounds.append(bounded(motion, "return", limits.back or USUAL_BY_SPRING, arm, opposite, a))
    touches, most = [touch for touch, _ in bounds], min(most for _, most in bounds)
    back = touches[1] if len(touches) > 1 else None
    rule: LimitingLine = "return" if back is not None and back.bound > touches[0].bound else "rise"
    ψ0 = max(touch.bound for touch in touches)
    if not 0 < ψ0 <= most or ψ0 + motion.stroke >= math.pi:
        return None
    r0 = float(valued(formulas.base_radius_of_arm, a, arm, ψ0))
    return Least(rule, r0, a=a, psi0=ψ0, most=most, rise=touches[0], back=back)


def bounded(
    motion: FollowerMotion, phase: str, limit: float, arm: float, opposite: int, a: float
) -> tuple[Touch, float]:
    """Return the range of ψ₀ (rad) in which a phase keeps its limit: where the lower bound is touched, and the upper
    bound.

    With c = lk cos(limit)/a it is cos(q − limit) ≥ c in the rise against the cam and in the return with it: q from
    limit − arccos c to limit + arccos c; else cos(q + limit) ≤ c: q from arccos c − limit to 2π − arccos c − limit.
    """
    side = opposite if phase == "rise" else -opposite
    lowest_by = formulas.lowest_against if side > 0 else formulas.lowest_with
    highest_by = formulas.highest_against if side > 0 else formulas.highest_with
    cosine = formulas.cosine_aside(Ref("l"), formulas.factor(Ref("ds"), opposite), Ref("limit"), Ref("a"))
    known = {"l": arm, "limit": limit, "a": a}

    def share(ds: Floats) -> Floats:
        return np.asarray(evaluate(cosine, {"ds": ds, **known}))

    def lowest(s: Floats, ds: Floats) -> Floats:
        c = share(ds)
        aside = np.arccos(np.clip(c, -1, 1))
        return np.where(side * c > 1, np.inf, valued(lowest_by, limit, aside, s))

    def highest(s: Floats, ds: Floats) -> Floats:
        aside = np.arccos(np.clip(share(ds), -1, 1))
        return np.asarray(valued(highest_by, limit, aside, s))

    return touch(motion, phase, lowest), -touch(motion, phase, lambda s, ds: -highest(s, ds)).bound


def best_distance(motion: FollowerMotion, limits: CamLimits, arm: float, opposite: int) -> Least:
    """Return the least cam of an oscillating follower, arm in m, at the best distance a of the pivot: 0.4 to 3 arms.

    The region of the centres is convex, so r₀ over a has one minimum, which a golden-section search finds.
    """

    def of(a: float) -> float:
        least_there = least_oscillating(motion, limits, arm, opposite, a)
        return math.inf if least_there is None else least_there.r0

    grid = np.linspace(0.4 * arm, 3 * arm, 53)
    sizes = [of(float(a)) for a in grid]
    index = int(np.argmin(sizes))
    best, size = float(grid[index]), sizes[index]
    if not math.isfinite(size):
        raise NoCamError("cam-no-centre", "limits")
    low, high = float(grid[max(index - 1, 0)]), float(grid[min(index + 1, len(grid) - 1)])
    # Beyond the ends of the valley there is no cam: the best one so far always stays within the bracket.
    while high - low > 1e-9 * arm:
        tried = best + (1 - GOLDEN) * (high - best) if high - best > best - low else best - (1 - GOLDEN) * (best - low)
        tried_size = of(tried)
        worse, best, size = (best, tried, tried_size) if tried_size < size else (tried, best, size)
        low, high = (low, worse) if worse > best else (worse, high)
    least_there = least_oscillating(motion, limits, arm, opposite, best)
    assert least_there is not None
    return least_there


def least_flat(cam: Cam, rho: float) -> float:
    """Return the least r₀ (m) at which the profile under a flat face is convex with a radius of curvature of at least ρ
    (m).

    For a translating face: r₀ = ρ − min(s + s″).
    """

    def flattest(r0: float) -> float:
        tried = replace(cam, r0=r0)
        every = range(len(cam.motion.intervals))
        return min(-tried.worst(number, lambda one: -one.rho)[1] for number in every)

    if cam.translating:
        return max(rho - flattest(0.0), rho)
    # The face stays short of a right angle to the line of centres.
    tried = cam.a * np.sin(np.linspace(0, math.pi / 2 - cam.motion.stroke, STEPS + 2)[1:-1])
    enough = next((i for i, r0 in enumerate(tried) if flattest(float(r0)) >= rho), None)
    if enough is None:
        raise NoCamError("cam-not-convex", "r0")
    low, high = float(tried[enough - 1]) if enough else 0.0, float(tried[enough])
    while high - low > 1e-9 * cam.a:
        middle = (low + high) / 2
        low, high = (low, middle) if flattest(middle) >= rho else (middle, high)
    return high


def reaches(cam: Cam) -> bool:
    """Return True if an oscillating face stays short of a right angle to the line of centres."""
    return cam.r0 < cam.a and cam.psi0 + cam.motion.stroke < math.pi / 2


# --- round lengths -------------------------------------------------------------------------------


def step_of(length: float) -> float:
    """Return the step of rounding a length (m): 0.5 mm below 5 mm, then 1 mm, 5 mm from 20 mm and 10 mm from 200."""
    sizes = ((0.005, 0.5), (0.020, 1.0), (0.200, 5.0))
    return next((step for most, step in sizes if length < most), 10.0) / MM


def rounded_up(length: float) -> float:
    """Return the least round length (m) that is not below a length."""
    step = step_of(length)
    return round(math.ceil(length / step - 1e-9) * step, 9)


def rounded_down(length: float) -> float:
    """Return the greatest round length (m) that is not above a length; a multiple of a millimetre if it has several."""
    step = min(step_of(length), 1.0 / MM)
    return round(math.floor(length / step + 1e-9) * step, 9)


def round_ups(length: float) -> Iterator[float]:
    """Yield lengths (m) that are not below a length, the roundest first: its own step, 1, 0.5, 0.1 mm, and itself."""
    yield rounded_up(length)
    for step in (1.0 / MM, 0.5 / MM, 0.1 / MM):
        yield round(math.ceil(length / step - 1e-9) * step, 9)
    yield length


def enlarged_until(cam: Cam, enough: Callable[[Cam], bool], error: NoCamError) -> Cam:
    """Return the cam with a base circle enlarged by round steps until it is `enough`; raise the error if none is."""
    for _ in range(TALLEST):
        if enough(cam):
            return cam
        cam = replace(cam, r0=rounded_up(cam.r0 + step_of(cam.r0) * 0.999))
        if not cam.translating and (cam.r0 >= cam.a + cam.arm or cam.psi0 + cam.motion.stroke >= math.pi):
            break
    raise error


def least_convex_radius(cam: Cam) -> float:
    """Return the least radius of curvature (m) where the working profile is convex; infinite if it is convex
    nowhere.
    """
    every = range(len(cam.motion.intervals))
    return min(-cam.worst(number, lambda one: -one.effective)[1] for number in every)


def largest_roller(cam: Cam, rho: float) -> float:
    """Return r_T ≤ 0.8 ρ_min, ≤ 0.4 r₀, leaving ρ of the convex curvature (all m), rounded down; 0 or less if there is
    none.
    """
    least = least_convex_radius(replace(cam, roller=0.0))
    return rounded_down(min(SHARE_OF_RHO * least, SHARE_OF_R0 * cam.r0, least - rho))
