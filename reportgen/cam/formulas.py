"""Formulas of a cam, each written once: a calculation evaluates them over arrays, and the report prints them.

The follower's point is the centre of its roller, the edge of a knife or the point of contact of a flat face.  The kinds
of follower and end and the senses of rotation (`CamKind`) select the formulas.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

from reportgen.base.records import Record
from reportgen.cam import cam_ids
from reportgen.formula import PI, Expression, Ref, acos, asin, atan, cos, signed, sin, sqrt, tan
from reportgen.formula.calculation import Calculation
from reportgen.formula.constructions import Value
from reportgen.formula.evaluation import evaluate


class CamKind(Record):
    """Kind of a cam, which selects its formulas; `opposite` and `turn` are the senses of `Cam`."""

    translating: bool
    flat: bool
    offset: bool
    roller: bool
    opposite: int
    turn: int

    @property
    def moved(self) -> tuple[str, str, str]:
        """Return the ids of s, s′ and s″, or of ψ, ψ′ and ψ″."""
        return ("cam.s", "cam.ds", "cam.dds") if self.translating else ("cam.psi", "cam.dpsi", "cam.ddpsi")

    @property
    def lengths(self) -> tuple[str, ...]:
        """Return the ids of the lengths of such a cam."""
        has = {
            "cam.a": not self.translating,
            "cam.l": not (self.translating or self.flat),
            "cam.e": self.translating and not self.flat,
            "cam.r0": True,
            "cam.roller": self.roller,
        }
        return tuple(id for id, wanted in has.items() if wanted)


def enter_lengths(q: Calculation, kind: CamKind, lengths: Mapping[str, float]) -> None:
    """Enter the lengths (m) of such a cam, by their ids."""
    for id in kind.lengths:
        q.give(id, lengths[id])


def enter_lowest(q: Calculation, kind: CamKind) -> None:
    """Enter s₀ = √(r₀² − e²), the height of the lowest position of a translating follower with a tip."""
    q.define("cam.s0", sqrt(q["cam.r0"] ** 2 - q["cam.e"] ** 2) if kind.offset else q["cam.r0"])


def valued(formula: Callable[..., Expression], *numbers: Value) -> Value:
    """Return the value of a formula of this module with numbers, or arrays of any shape, for its symbols."""
    return evaluate(_written(formula, len(numbers)), {str(place): number for place, number in enumerate(numbers)})


@lru_cache(maxsize=64)
def _written(formula: Callable[..., Expression], count: int) -> Expression:
    """Return a formula of `count` symbols, each named by its index."""
    return formula(*(Ref(str(place)) for place in range(count)))


# --- the least cam of a translating follower: s₀ ≥ (c₁ − e)/tan [α] and s₀ ≥ (c₂ + e)/tan [α′] ----


def rise_intercept(s: Expression, ds: Expression, α: Expression) -> Expression:
    """Return c₁ = s′ − s tan [α], greatest where the limit line of the rise touches."""
    return ds - s * tan(α)


def return_intercept(s: Expression, ds: Expression, α: Expression) -> Expression:
    """Return c₂ = −s′ − s tan [α′], greatest where the limit line of the return touches."""
    return -ds - s * tan(α)


def height_by_rise(c: Expression, e: Expression, α: Expression) -> Expression:
    """Return the least s₀ that the rise allows at an offset e."""
    return (c - e) / tan(α)


def height_by_return(c: Expression, e: Expression, α: Expression) -> Expression:
    """Return the least s₀ that the return allows at an offset e."""
    return (c + e) / tan(α)


def apex_height(c1: Expression, c2: Expression, α1: Expression, α2: Expression) -> Expression:
    """Return s₀ of the intersection of both limit lines."""
    return (c1 + c2) / (tan(α1) + tan(α2))


def apex_offset(c1: Expression, high: Expression, α1: Expression) -> Expression:
    """Return e of the intersection of both limit lines."""
    return c1 - high * tan(α1)


def foot_of_rise(c: Expression, α: Expression) -> Expression:
    """Return e of the point of the rise's limit line nearest to the follower's lowest point."""
    return c / (1 + tan(α) ** 2)


def foot_of_return(c: Expression, α: Expression) -> Expression:
    """Return e of the point of the return's limit line nearest to the follower's lowest point."""
    return -(c / (1 + tan(α) ** 2))


def height_on_rise(e: Expression, α: Expression) -> Expression:
    """Return s₀ of the point of the rise's limit line at e."""
    return e * tan(α)


def height_on_return(e: Expression, α: Expression) -> Expression:
    """Return s₀ of the point of the return's limit line at e."""
    return -(e * tan(α))


def base_radius(s0: Expression, e: Expression) -> Expression:
    """Return r₀ = √(s₀² + e²)."""
    return sqrt(s0**2 + e**2)


# --- the least cam of an oscillating follower -----------------------------------------------------


def cosine_aside(arm: Expression, k: Expression, α: Expression, a: Expression) -> Expression:
    """Return l k cos [α]/a, the cosine of the angle that the arm may deviate from the limit line."""
    return arm * k * cos(α) / a


def lowest_against(limit: Expression, aside: Expression, ψ: Expression) -> Expression:
    """Return the lowest ψ₀ of a phase in which the arm turns against the cam."""
    return limit - aside - ψ


def lowest_with(limit: Expression, aside: Expression, ψ: Expression) -> Expression:
    """Return the lowest ψ₀ of a phase in which the arm turns with the cam."""
    return aside - limit - ψ


def highest_against(limit: Expression, aside: Expression, ψ: Expression) -> Expression:
    """Return the highest ψ₀ of a phase in which the arm turns against the cam."""
    return limit + aside - ψ


def highest_with(limit: Expression, aside: Expression, ψ: Expression) -> Expression:
    """Return the highest ψ₀ of a phase in which the arm turns with the cam."""
    return 2 * PI - aside - limit - ψ


def base_radius_of_arm(a: Expression, arm: Expression, ψ0: Expression) -> Expression:
    """Return r₀ = √(a² + l² − 2al cos ψ₀), by the law of cosines."""
    return sqrt(a**2 + arm**2 - 2 * a * arm * cos(ψ0))


def lowest_of_face(r0: Expression, a: Expression) -> Expression:
    """Return ψ₀ = arcsin(r₀/a), where a flat face touches the base circle."""
    return asin(r0 / a)


# --- the cam --------------------------------------------------------------------------------------


def factor(dψ: Expression, opposite: int) -> Expression:
    """Return k = 1 ± ψ′, the rate of the arm relative to the cam: + if they turn in opposite senses."""
    return 1 + dψ if opposite > 0 else 1 - dψ


def enter_profile(q: Calculation, kind: CamKind) -> None:
    """Enter pitch curve by inversion, pressure angle, radius of curvature and profile from the motion at angles φ."""
    (_enter_under_face if kind.flat else _enter_under_tip)(q, kind)


def _enter_under_tip(q: Calculation, kind: CamKind) -> None:
    φ, r0 = q["cam.phi"], q.si("cam.r0")
    if kind.translating:
        s0, e, (s, ds, dds) = q["cam.s0"], q["cam.e"], (q[id] for id in kind.moved)
        x: Expression
        y: Expression
        u = q.define("cam.u", s0 + s)
        if kind.offset:
            w = q.define("cam.w", ds - e)
            x, y = (s0 + s) * sin(φ) + e * cos(φ), (s0 + s) * cos(φ) - e * sin(φ)
            α = q.define("cam.alpha", atan((ds - e) / (s0 + s)), scale=1.0)
            ρ = sqrt(u**2 + w**2) ** 3 / (u * (u - dds) + w * (w + ds))
        else:
            x, y = (s0 + s) * sin(φ), (s0 + s) * cos(φ)
            α = q.define("cam.alpha", atan(ds / (s0 + s)), scale=1.0)
            ρ = sqrt(u**2 + ds**2) ** 3 / (u * (u - dds) + 2 * ds**2)
        lean: Expression = φ - α
    else:
        a, arm, (ψ, dψ, ddψ) = q["cam.a"], q["cam.l"], (q[id] for id in kind.moved)
        ψ0 = q.define("cam.psi0", acos((a**2 + arm**2 - q["cam.r0"] ** 2) / (2 * a * arm)))
        at, k = q.define("cam.q", ψ0 + ψ), q.define("cam.k", factor(dψ, kind.opposite))
        # The sign depends on the sense in which the arm lifts: N = F + iF′ leans by l k − a cos q, mirrored in that
        # sense.
        aside = arm * k - a * cos(at) if kind.opposite > 0 else a * cos(at) - arm * k
        α = q.define("cam.alpha", atan(aside / (a * sin(at))), scale=1.0)
        x, y = _inverted(q, kind, a - arm * cos(at), arm * sin(at))
        u, w = q.define("cam.u", arm * k * sin(at)), q.define("cam.w", a - arm * k * cos(at))
        bend = q.define("cam.m.1", arm * (k**2 * sin(at) - ddψ * cos(at)))
        turn = q.define("cam.m.2", a - arm * (k**2 * cos(at) + ddψ * sin(at)))
        ρ = sqrt(u**2 + w**2) ** 3 / (u * bend + w * turn)
        lean = φ + at - α if kind.opposite > 0 else φ - at - α
    x_B = q.define(cam_ids.pitch("x"), signed(kind.turn, x), scale=r0)
    y_B = q.define(cam_ids.pitch("y"), y, scale=r0)
    ρ_B = q.define("cam.rho", ρ)
    if kind.roller:
        roller = q["cam.roller"]
        q.define(cam_ids.profile("x"), x_B - signed(kind.turn, roller * sin(lean)), scale=r0)
        q.define(cam_ids.profile("y"), y_B - roller * cos(lean), scale=r0)
        q.define("cam.rho.working", ρ_B - roller)


def _enter_under_face(q: Calculation, kind: CamKind) -> None:
    φ, r0, (s, ds, dds) = q["cam.phi"], q["cam.r0"], (q[id] for id in kind.moved)
    x: Expression
    y: Expression
    ρ: Expression
    if kind.translating:
        high = r0 + s
        x, y = high * sin(φ) + ds * cos(φ), high * cos(φ) - ds * sin(φ)
        ρ = r0 + s + dds
    else:
        a = q["cam.a"]
        ψ0 = q.define("cam.psi0", lowest_of_face(r0, a))
        at, k = q.define("cam.q", ψ0 + s), q.define("cam.k", factor(ds, kind.opposite))
        L = q.define("cam.contact", a * cos(at) / k)
        x, y = _inverted(q, kind, a - L * cos(at), L * sin(at))
        bend = q.define("cam.m.1", cos(at) * dds - sin(at) * ds**2, kind="ratio")
        turn = q.define("cam.m.2", cos(at) * ds * dds / k, kind="ratio")
        ρ = a * sin(at) + a * (bend - turn if kind.opposite > 0 else bend + turn) / k**2
    q.define(cam_ids.profile("x"), signed(kind.turn, x), scale=q.si(r0))
    q.define(cam_ids.profile("y"), y, scale=q.si(r0))
    q.define("cam.rho", ρ)


def _inverted(q: Calculation, kind: CamKind, across: Expression, up: Expression) -> tuple[Expression, Expression]:
    """Return a point of an oscillating follower, `across` towards the pivot and `up` from the cam's centre, turned by
    −φ.
    """
    φ = q["cam.phi"]
    if kind.opposite > 0:
        return up * sin(φ) + across * cos(φ), up * cos(φ) - across * sin(φ)
    return up * sin(φ) - across * cos(φ), up * cos(φ) + across * sin(φ)
