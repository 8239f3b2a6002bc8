"""The analytic method of the four-bar linkage ABCD: proportions, closed position, matrices of the rates.

x runs along AD, y is x turned by 90° in the direction of rotation, so that ω₁ > 0; φ are the angles of AB,
BC and DC from x.  With the diagonal BD and the angle δ at D, C on the left of BD (s = +1) or right of it:
φ₂ = sβ − δ, φ₃ = 180° − δ − sγ.  The closed loop, differentiated once and twice:
[A][ω₂ ω₃] = [B]ω₁,  [A][ε₂ ε₃] = −[Ȧ][ω₂ ω₃] + [Ḃ]ω₁.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from reportgen.catalogue.loads import Floats
from reportgen.catalogue.sliders import components
from reportgen.mechanism.structure import LinkPoint
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Matrix,
    Number,
    Ref,
    Symbol,
    acos,
    atan,
    atan2,
    column,
    cos,
    sin,
    sqrt,
)
from reportgen.notation.sheet import Sheet

STRAIGHT = Number(180.0, None, "°")


@dataclass(frozen=True, slots=True)
class FourBar:
    """Crank angles φ₁ from x [N], points of the coupler, the rotation ±1, the side ±1 on which C lies in these axes."""

    φ1: Floats
    points: tuple[LinkPoint, ...]
    turn: int
    side: int


def _rocks(q: Sheet) -> bool:
    """Whether CD only swings: the crank, not the frame, is the shortest."""
    return q.si("l.AB") < q.si("l.AD")


def _cosine(one: Expression, other: Expression, opposite: Expression) -> Expression:
    """The law of cosines for the angle between two sides."""
    return (one**2 + other**2 - opposite**2) / (2 * one * other)


# --- proportions ----------------------------------------------------------------------------------


def proportions(q: Sheet) -> None:
    """Grashof's two sums; for a rocker the extreme positions C₁, C₂, its swing ψ and the ratio of times K.

    AC₁ = BC + AB and AC₂ = BC − AB with the angles α at A and ψ at D; θ = α₁ − α₂, K = (180° + θ)/(180° − θ).
    """
    AB, BC, CD, AD = sides = tuple(q[f"l.{id}"] for id in ("AB", "BC", "DC", "AD"))
    first, one, other, last = sorted(sides, key=q.si)
    q.define("sum.ends", first + last, Symbol("l", "", "′"), "length")
    q.define("sum.others", one + other, Symbol("l", "", "″"), "length")
    if not _rocks(q):
        return
    angle = partial(q.define, kind="angle", scale=1.0)
    α, ψ = [], []
    for number, length in (("1", BC + AB), ("2", BC - AB)):
        AC = q.define(f"l.AC{number}", length)
        α.append(angle(f"alpha.{number}", acos(_cosine(AC, AD, CD)), Symbol("α", number)))
        ψ.append(angle(f"psi.{number}", acos(_cosine(AD, CD, AC)), Symbol("ψ", number)))
    larger, smaller = sorted(α, key=q.si, reverse=True)
    θ = angle("theta", larger - smaller)
    q.define("K", (STRAIGHT + θ) / (STRAIGHT - θ))
    angle("swing", ψ[0] - ψ[1], "ψ")


def triangle(q: Sheet, name: str) -> None:
    """l_BE² = x² + y² of a coupler point given by x along BC and y across it; off BC, l_CE² = (l − x)² + y²."""
    x, y, BC = q[f"{name}.along"], q[f"{name}.across"], q["l.BC"]
    if q.si(y):
        q.define(f"l.B{name}", sqrt(x**2 + y**2))
        q.define(f"l.C{name}", sqrt((BC - x) ** 2 + y**2))
    else:
        q.define(f"l.B{name}", abs(x))


# --- the analytic method --------------------------------------------------------------------------


def analytic_method(q: Sheet, bar: FourBar) -> None:
    """Enter positions, entries of the matrices and rates.

    Ids: `f.phi.1`, `l.BD`, `f.phi.2`, `f.phi.3`; entries `A.11`, `B.1`, `dA.11`, `dB.1`; `A.det`;
    `f.omega.2`, …, `q.2`, `f.eps.3`; of every coupler point `f.x.E.v`, `f.y.E.v`, `f.v.E`, likewise for a.
    """
    AB, BC, CD, ω1 = q["l.AB"], q["l.BC"], q["l.DC"], q["omega.1"]
    φ1, φ2, φ3 = _positions(q, bar)
    a, b = partial(_entries, q, "A", "a", "length", 0.1), partial(_entries, q, "B", "b", "length", 0.1)
    a({"11": -BC * sin(φ2), "12": CD * sin(φ3), "21": BC * cos(φ2), "22": -CD * cos(φ3)})
    b({"1": AB * sin(φ1), "2": -AB * cos(φ1)})
    q.define("A.det", BC * CD * sin(φ2 - φ3), "Δ", "product of lengths")
    # Cramer's rule, with what stands in both numerators and in Δ left out.
    ω2 = q.define("f.omega.2", ω1 * AB * sin(φ3 - φ1) / (BC * sin(φ2 - φ3)), scale=1.0)
    ω3 = q.define("f.omega.3", ω1 * AB * sin(φ2 - φ1) / (CD * sin(φ2 - φ3)), scale=1.0)
    a, b = partial(_entries, q, "dA", "ȧ", "velocity", 1.0), partial(_entries, q, "dB", "ḃ", "velocity", 1.0)
    a({"11": -ω2 * BC * cos(φ2), "12": ω3 * CD * cos(φ3), "21": -ω2 * BC * sin(φ2), "22": ω3 * CD * sin(φ3)})
    b({"1": ω1 * AB * cos(φ1), "2": ω1 * AB * sin(φ1)})
    top2 = ω1**2 * AB * cos(φ1 - φ3) + ω2**2 * BC * cos(φ2 - φ3) - ω3**2 * CD
    top3 = ω1**2 * AB * cos(φ1 - φ2) + ω2**2 * BC - ω3**2 * CD * cos(φ2 - φ3)
    for link, top, length in (("2", top2, BC), ("3", top3, CD)):
        q_k = q.define(f"q.{link}", top, Symbol("q", link), "acceleration", scale=1.0)
        q.define(f"f.eps.{link}", -q_k / (length * sin(φ2 - φ3)), scale=1.0)
    for point in bar.points:
        _coupler_point(q, point, bar.turn)


def _positions(q: Sheet, bar: FourBar) -> tuple[Ref, Ref, Ref]:
    """BD, then φ₂ = sβ − δ and φ₃ = 180° − δ − sγ, each from BD at once: sums of rounded angles lose a digit."""
    AB, BC, CD, AD = q["l.AB"], q["l.BC"], q["l.DC"], q["l.AD"]
    φ1 = q.angle("f.phi.1", bar.φ1)
    across, along = AB * sin(φ1), AD - AB * cos(φ1)
    δ = atan(across / along) if _rocks(q) else atan2(across, along)
    BD = q.define("l.BD", sqrt(AB**2 + AD**2 - 2 * AB * AD * cos(φ1)))
    β, γ = acos(_cosine(BC, BD, CD)), acos(_cosine(CD, BD, BC))
    φ2 = q.define("f.phi.2", β - δ if bar.side > 0 else -β - δ, scale=1.0)
    φ3 = q.define("f.phi.3", STRAIGHT - δ - γ if bar.side > 0 else STRAIGHT - δ + γ, scale=1.0)
    return φ1, φ2, φ3


def _entries(q: Sheet, matrix: str, letter: str, kind: str, scale: float, entries: Mapping[str, Expression]) -> None:
    """The entries of a matrix by their places: a₁₁ of [A], ȧ₁₁ of [Ȧ]."""
    for place, entry in entries.items():
        q.define(f"{matrix}.{place}", entry, Symbol(letter, place), kind, scale=scale)


def _coupler_point(q: Sheet, point: LinkPoint, turn: int) -> None:
    """v and a of a point P of the coupler by components, BP at the angle φ₂ + η from x."""
    name, AB, BP, φ1, ω1 = point.name, q["l.AB"], q[f"l.B{point.name}"], q["f.phi.1"], q["omega.1"]
    ω2, ε2 = q["f.omega.2"], q["f.eps.2"]
    φ: Expression = q["f.phi.2"]
    if point.local.imag:
        x, y = q[f"{name}.along"], q[f"{name}.across"]
        slope = atan(y / x) if point.local.real > 0 else atan2(y, x)
        φ = φ + q.define(f"eta.{name}", slope if turn > 0 else -slope, Symbol("η", name), "angle", scale=1.0)
    components(q, "v", name, -(ω1 * AB * sin(φ1) + ω2 * BP * sin(φ)), ω1 * AB * cos(φ1) + ω2 * BP * cos(φ))
    a_x = -(ω1**2 * AB * cos(φ1) + ε2 * BP * sin(φ) + ω2**2 * BP * cos(φ))
    a_y = ε2 * BP * cos(φ) - ω1**2 * AB * sin(φ1) - ω2**2 * BP * sin(φ)
    components(q, "a", name, a_x, a_y)


# --- what the words show --------------------------------------------------------------------------


def equations() -> dict[str, tuple[Chain, ...]]:
    """The closed loop by components; the matrix equations in symbols, and `-numbers` with entries to fill in."""
    AB, BC, CD, AD = (Symbol("l", name) for name in ("AB", "BC", "CD", "AD"))
    φ1, φ2, φ3 = (Symbol("φ", link) for link in "123")
    ω1, ω2, ω3 = (Symbol("ω", link) for link in "123")
    ω, ε = column(ω2, ω3), column(Symbol("ε", "2"), Symbol("ε", "3"))
    A = Matrix(((-BC * sin(φ2), CD * sin(φ3)), (BC * cos(φ2), -CD * cos(φ3))))
    dA = Matrix(((-ω2 * BC * cos(φ2), ω3 * CD * cos(φ3)), (-ω2 * BC * sin(φ2), ω3 * CD * sin(φ3))))
    B, dB = column(AB * sin(φ1), -AB * cos(φ1)), column(ω1 * AB * cos(φ1), ω1 * AB * sin(φ1))
    a11, a12, a21, a22 = (Symbol("a", place) for place in ("11", "12", "21", "22"))
    filled_A, filled_dA = (
        Matrix(tuple(tuple(Ref(f"{name}.{i}{j}") for j in "12") for i in "12")) for name in ("A", "dA")
    )
    filled_B, filled_dB = (column(Ref(f"{name}.1"), Ref(f"{name}.2")) for name in ("B", "dB"))
    filled_ω, filled_ω1 = column(Ref("f.omega.2"), Ref("f.omega.3")), Ref("omega.1")
    return {
        "closure": (
            Chain((AB * cos(φ1) + BC * cos(φ2), AD + CD * cos(φ3))),
            Chain((AB * sin(φ1) + BC * sin(φ2), CD * sin(φ3))),
        ),
        "velocity": (Chain((A * ω, B * ω1)),),
        "determinant": (Chain((Symbol("Δ"), a11 * a22 - a12 * a21, BC * CD * sin(φ2 - φ3))),),
        "velocity-numbers": (Chain((filled_A * ω, filled_B * filled_ω1)),),
        "acceleration": (Chain((A * ε, -(dA * ω) + dB * ω1)),),
        "acceleration-numbers": (Chain((filled_A * ε, -(filled_dA * filled_ω) + filled_dB * filled_ω1)),),
    }
