"""The analytic method of the four-bar linkage ABCD: proportions, closed position, matrices of the rates.

x runs along AD, y is x turned by 90° in the direction of rotation, so that ω₁ > 0; φ are the angles of AB,
BC and DC from x.  With the diagonal BD and the angle δ at D, C on the left of BD (s = +1) or right of it:
φ₂ = sβ − δ, φ₃ = 180° − δ − sγ.  The closed loop, differentiated once and twice:
[A][ω₂ ω₃] = [B]ω₁,  [A][ε₂ ε₃] = −[Ȧ][ω₂ ω₃] + [Ḃ]ω₁.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from reportgen.catalogue.course import FULL_TURN, Floats
from reportgen.catalogue.machine import Item
from reportgen.mechanism.structure import LinkPoint
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Matrix,
    Number,
    Product,
    Ref,
    Root,
    Symbol,
    add,
    call,
    column,
    divide,
    multiply,
    negative,
    power,
    subtract,
)

AB, BC, CD, AD = "l.AB", "l.BC", "l.DC", "l.AD"
STRAIGHT = Number(180.0, None, "°")
ROUND = 1e-12


@dataclass(frozen=True, slots=True)
class Sides:
    """Lengths (m) of a four-bar linkage whose crank AB turns fully: AB or AD is the shortest."""

    ab: float
    bc: float
    cd: float
    ad: float

    @property
    def rocks(self) -> bool:
        """Whether CD only swings: the crank, not the frame, is the shortest."""
        return self.ab < self.ad


@dataclass(frozen=True, slots=True)
class Couplings:
    """Points of the coupler, the rotation ±1, and the side ±1 on which C lies in axes that turn with it."""

    points: tuple[LinkPoint, ...]
    turn: int
    side: int


# --- proportions ----------------------------------------------------------------------------------


def proportions(sides: Sides) -> tuple[Item, ...]:
    """Grashof's two sums; for a rocker the extreme positions C₁, C₂, its swing ψ and the ratio of times K."""
    ids = {AB: sides.ab, BC: sides.bc, CD: sides.cd, AD: sides.ad}
    first, *between, last = sorted(ids, key=lambda id: ids[id])
    sums = (
        Item("sum.ends", Symbol("l", "", "′"), "length", definition=add(first, last)),
        Item("sum.others", Symbol("l", "", "″"), "length", definition=add(*between)),
    )
    return (*sums, *_extremes(sides)) if sides.rocks else sums


def _extremes(sides: Sides) -> tuple[Item, ...]:
    """AC₁ = BC + AB and AC₂ = BC − AB with the angles at A and D; θ, K = (180° + θ)/(180° − θ), ψ."""
    reach = {"1": sides.bc + sides.ab, "2": sides.bc - sides.ab}
    items: list[Item] = []
    at_a: dict[str, float] = {}
    for number, length in reach.items():
        ac = f"l.AC{number}"
        with_ab = add(BC, AB) if number == "1" else subtract(BC, AB)
        items += [
            Item(ac, Symbol("l", f"AC{number}"), "length", definition=with_ab),
            _angle(f"alpha.{number}", Symbol("α", number), call("arccos", _cosine(ac, AD, CD))),
            _angle(f"psi.{number}", Symbol("ψ", number), call("arccos", _cosine(AD, CD, ac))),
        ]
        at_a[number] = math.acos((length**2 + sides.ad**2 - sides.cd**2) / (2 * length * sides.ad))
    larger, smaller = sorted(at_a, key=lambda number: -at_a[number])
    theta = subtract(f"alpha.{larger}", f"alpha.{smaller}")
    return (
        *items,
        _angle("theta", Symbol("θ"), theta),
        Item("K", Symbol("K"), "ratio", definition=divide(add(STRAIGHT, "theta"), subtract(STRAIGHT, "theta"))),
        _angle("swing", Symbol("ψ"), subtract("psi.1", "psi.2")),
    )


def triangle(name: str, off_line: bool) -> tuple[Item, ...]:
    """l_BE² = x² + y² of a coupler point given by x along BC and y across it; off BC, l_CE² = (l − x)² + y²."""
    along, across = f"{name}.along", f"{name}.across"

    def side(start: str, x: Expression) -> Item:
        length = Root(add(power(x, 2), power(across, 2)))
        return Item(f"l.{start}{name}", Symbol("l", f"{start}{name}"), "length", definition=length)

    if not off_line:
        return (Item(f"l.B{name}", Symbol("l", f"B{name}"), "length", definition=call("abs", along)),)
    return side("B", Ref(along)), side("C", subtract(BC, along))


def _cosine(one: str, other: str, opposite: str) -> Expression:
    """The law of cosines for the angle between two sides."""
    return divide(
        subtract(add(power(one, 2), power(other, 2)), power(opposite, 2)), multiply(2, one, other)
    )


# --- the analytic method --------------------------------------------------------------------------


def formulas(sides: Sides, phi: Floats, couplings: Couplings) -> tuple[Item, ...]:
    """Items at the crank angles `phi` [N] from x.

    Ids: `f.phi.1`, `l.BD`, `f.phi.2`, `f.phi.3`; entries `A.11`, `B.1`, `dA.11`, `dB.1`; `A.det`;
    `f.omega.2`, …, `q.2`, `f.eps.3`; of every coupler point `f.x.E.v`, `f.y.E.v`, `f.v.E`, likewise for a.
    """
    turned = np.mod(phi + ROUND, FULL_TURN) - ROUND
    given = Item("f.phi.1", Symbol("φ", "1"), "angle", turned, traits={"exact": _is_round(turned), "scale": 1.0})
    points = (item for point in couplings.points for item in _coupler_point(point, couplings.turn))
    return (given, *_position(sides, couplings.side), *_entries(), *_rates(), *points)


def _position(sides: Sides, side: int) -> tuple[Item, ...]:
    """BD, then φ₂ = sβ − δ and φ₃ = 180° − δ − sγ, each from BD at once: sums of rounded angles lose a digit."""
    phi = "f.phi.1"
    across, along = multiply(AB, call("sin", phi)), subtract(AD, multiply(AB, call("cos", phi)))
    delta = call("arctan", divide(across, along)) if sides.rocks else call("arctan2", across, along)
    diagonal = Root(
        subtract(add(power(AB, 2), power(AD, 2)), multiply(2, AB, AD, call("cos", phi)))
    )
    beta, gamma = call("arccos", _cosine(BC, "l.BD", CD)), call("arccos", _cosine(CD, "l.BD", BC))
    second = subtract(beta if side > 0 else negative(beta), delta)
    third = subtract(STRAIGHT, delta, gamma) if side > 0 else add(subtract(STRAIGHT, delta), gamma)
    return (
        Item("l.BD", Symbol("l", "BD"), "length", definition=diagonal),
        _angle("f.phi.2", Symbol("φ", "2"), second),
        _angle("f.phi.3", Symbol("φ", "3"), third),
    )


def _entries() -> tuple[Item, ...]:
    """The entries of [A] and [B], and the determinant of [A]."""
    s1, s2, s3 = (call("sin", f"f.phi.{link}") for link in "123")
    c1, c2, c3 = (call("cos", f"f.phi.{link}") for link in "123")
    named = {
        "A.11": negative(multiply(BC, s2)),
        "A.12": multiply(CD, s3),
        "A.21": multiply(BC, c2),
        "A.22": negative(multiply(CD, c3)),
        "B.1": multiply(AB, s1),
        "B.2": negative(multiply(AB, c1)),
    }
    items = [_entry(id, "length", definition, 0.1) for id, definition in named.items()]
    return (*items, Item("A.det", Symbol("Δ"), "product of lengths", definition=multiply(BC, CD, _between("2", "3"))))


def _between(one: str, other: str, function: str = "sin") -> Expression:
    """sin (φ₂ − φ₃), or another function of the difference of two links' angles."""
    return call(function, subtract(f"f.phi.{one}", f"f.phi.{other}"))


def _rates() -> tuple[Item, ...]:
    """ω₂, ω₃ by Cramer's rule; the entries of [Ȧ], [Ḃ]; ε₂, ε₃ by Cramer's rule.

    ω₂ = ω₁ l_AB sin(φ₃ − φ₁)/(l_BC sin(φ₂ − φ₃)),  ω₃ = ω₁ l_AB sin(φ₂ − φ₁)/(l_CD sin(φ₂ − φ₃)),
    q₂ = ω₁² l_AB cos(φ₁ − φ₃) + ω₂² l_BC cos(φ₂ − φ₃) − ω₃² l_CD,  ε₂ = −q₂/(l_BC sin(φ₂ − φ₃)),
    q₃ = ω₁² l_AB cos(φ₁ − φ₂) + ω₂² l_BC − ω₃² l_CD cos(φ₂ − φ₃),  ε₃ = −q₃/(l_CD sin(φ₂ − φ₃)).
    """
    s1, s2, s3 = (call("sin", f"f.phi.{link}") for link in "123")
    c1, c2, c3 = (call("cos", f"f.phi.{link}") for link in "123")
    w1, w2, w3 = "omega.1", "f.omega.2", "f.omega.3"
    first = {
        "2": divide(multiply(w1, AB, _between("3", "1")), multiply(BC, _between("2", "3"))),
        "3": divide(multiply(w1, AB, _between("2", "1")), multiply(CD, _between("2", "3"))),
    }
    named = {
        "dA.11": negative(multiply(w2, BC, c2)),
        "dA.12": multiply(w3, CD, c3),
        "dA.21": negative(multiply(w2, BC, s2)),
        "dA.22": multiply(w3, CD, s3),
        "dB.1": multiply(w1, AB, c1),
        "dB.2": multiply(w1, AB, s1),
    }
    crank, coupler, output = multiply(power(w1, 2), AB), multiply(power(w2, 2), BC), multiply(power(w3, 2), CD)
    inward, between = _between("1", "3", "cos"), _between("2", "3", "cos")
    tops = {
        "2": add(_times(crank, inward), _times(coupler, between), negative(output)),
        "3": add(_times(crank, _between("1", "2", "cos")), coupler, negative(_times(output, between))),
    }
    swings = [
        item
        for (link, top), length in zip(tops.items(), (BC, CD), strict=True)
        for item in (
            _rate(f"q.{link}", Symbol("q", link), "acceleration", top),
            _rate(
                f"f.eps.{link}",
                Symbol("ε", link),
                "angular acceleration",
                negative(divide(f"q.{link}", multiply(length, _between("2", "3")))),
            ),
        )
    ]
    return (
        *(_rate(f"f.omega.{link}", Symbol("ω", link), "angular velocity", rate) for link, rate in first.items()),
        *(_entry(id, "velocity", definition, 1.0) for id, definition in named.items()),
        *swings,
    )


def _times(product: Expression, factor: Expression) -> Expression:
    assert isinstance(product, Product)
    return Product((*product.factors, factor))


def _coupler_point(point: LinkPoint, turn: int) -> tuple[Item, ...]:
    """v and a of a point P of the coupler by components, BP at the angle φ₂ + η from x."""
    name, arm = point.name, f"l.B{point.name}"
    items: list[Item] = []
    angle: Expression = Ref("f.phi.2")
    if point.local.imag:
        eta = f"eta.{name}"
        across, along = f"{name}.across", f"{name}.along"
        slope = call("arctan", divide(across, along)) if point.local.real > 0 else call("arctan2", across, along)
        items.append(_angle(eta, Symbol("η", name), slope if turn > 0 else negative(slope)))
        angle = add("f.phi.2", eta)
    phi, w1, w2, e2 = "f.phi.1", "omega.1", "f.omega.2", "f.eps.2"
    s1, c1, s2, c2 = call("sin", phi), call("cos", phi), call("sin", angle), call("cos", angle)
    v_x = negative(add(multiply(w1, AB, s1), multiply(w2, arm, s2)))
    v_y = add(multiply(w1, AB, c1), multiply(w2, arm, c2))
    a_x = negative(
        add(multiply(power(w1, 2), AB, c1), multiply(e2, arm, s2), multiply(power(w2, 2), arm, c2))
    )
    a_y = subtract(
        multiply(e2, arm, c2), multiply(power(w1, 2), AB, s1), multiply(power(w2, 2), arm, s2)
    )
    return (*items, *_components(name, "v", "velocity", v_x, v_y), *_components(name, "a", "acceleration", a_x, a_y))


def _components(name: str, what: str, kind: str, x: Expression, y: Expression) -> tuple[Item, ...]:
    along, across = f"f.x.{name}.{what}", f"f.y.{name}.{what}"
    size = Root(add(power(along, 2), power(across, 2)))
    return (
        _rate(along, Symbol(what, f"{name}x"), kind, x),
        _rate(across, Symbol(what, f"{name}y"), kind, y),
        Item(f"f.{what}.{name}", Symbol(what, name), kind, definition=size),
    )


def _angle(id: str, symbol: Symbol, definition: Expression) -> Item:
    return Item(id, symbol, "angle", definition=definition, traits={"scale": 1.0})


def _rate(id: str, symbol: Symbol, kind: str, definition: Expression) -> Item:
    return Item(id, symbol, kind, definition=definition, traits={"scale": 1.0})


def _entry(id: str, kind: str, definition: Expression, scale: float) -> Item:
    """A matrix entry: a₁₁ of [A], ȧ₁₁ of [Ȧ]."""
    matrix, place = id.split(".")
    letter = matrix[-1].lower()
    dotted = {"a": "ȧ", "b": "ḃ"}[letter] if matrix.startswith("d") else letter
    return Item(id, Symbol(dotted, place), kind, definition=definition, traits={"scale": scale})


def _is_round(angle: Floats) -> bool:
    """Whether all angles are whole hundredths of a degree, to be printed as they are."""
    hundredths = np.degrees(angle) * 100
    return bool(np.allclose(hundredths, np.round(hundredths), rtol=0, atol=1e-7))


# --- what the words show --------------------------------------------------------------------------


def compared(points: Iterable[LinkPoint]) -> tuple[tuple[str, str], ...]:
    """Plan quantities and those of the analytic method that must have the same sizes."""
    names = [point.name for point in points]
    plans = ("omega.2", "omega.3", *(f"v.{name}" for name in names))
    plans += ("eps.2", "eps.3", *(f"a.{name}" for name in names))
    return tuple((plan, f"f.{plan}") for plan in plans)


def equations() -> dict[str, tuple[Chain, ...]]:
    """The closed loop by components; the matrix equations in symbols, and `-numbers` with entries to fill in."""
    ab, bc, cd, ad = (Symbol("l", name) for name in ("AB", "BC", "CD", "AD"))
    s1, s2, s3 = (call("sin", Symbol("φ", link)) for link in "123")
    c1, c2, c3 = (call("cos", Symbol("φ", link)) for link in "123")
    w1, w2, w3 = (Symbol("ω", link) for link in "123")
    omega, epsilon = column(w2, w3), column(Symbol("ε", "2"), Symbol("ε", "3"))
    a = Matrix(
        ((negative(multiply(bc, s2)), multiply(cd, s3)), (multiply(bc, c2), negative(multiply(cd, c3))))
    )
    rate = Matrix(
        (
            (negative(multiply(w2, bc, c2)), multiply(w3, cd, c3)),
            (negative(multiply(w2, bc, s2)), multiply(w3, cd, s3)),
        )
    )
    b, b_rate = column(multiply(ab, s1), negative(multiply(ab, c1))), column(multiply(w1, ab, c1), multiply(w1, ab, s1))
    filled = {name: Matrix(tuple(tuple(Ref(f"{name}.{i}{j}") for j in "12") for i in "12")) for name in ("A", "dA")}
    columns = {name: column(f"{name}.1", f"{name}.2") for name in ("B", "dB")}
    return {
        "closure": (
            Chain((add(multiply(ab, c1), multiply(bc, c2)), add(ad, multiply(cd, c3)))),
            Chain((add(multiply(ab, s1), multiply(bc, s2)), multiply(cd, s3))),
        ),
        "velocity": (Chain((multiply(a, omega), multiply(b, w1))),),
        "determinant": (
            Chain(
                (
                    Symbol("Δ"),
                    subtract(
                        multiply(Symbol("a", "11"), Symbol("a", "22")), multiply(Symbol("a", "12"), Symbol("a", "21"))
                    ),
                    multiply(bc, cd, call("sin", subtract(Symbol("φ", "2"), Symbol("φ", "3")))),
                )
            ),
        ),
        "velocity-numbers": (Chain((multiply(filled["A"], omega), multiply(columns["B"], Ref("omega.1")))),),
        "acceleration": (_second(a, epsilon, rate, omega, b_rate, w1),),
        "acceleration-numbers": (
            _second(
                filled["A"],
                epsilon,
                filled["dA"],
                column("f.omega.2", "f.omega.3"),
                columns["dB"],
                Ref("omega.1"),
            ),
        ),
    }


def _second(
    a: Matrix, epsilon: Matrix, rate: Matrix, omega: Matrix, b_rate: Matrix, w1: Expression
) -> Chain:
    """[A][ε] = −[Ȧ][ω] + [Ḃ]ω₁."""
    return Chain((multiply(a, epsilon), add(negative(multiply(rate, omega)), multiply(b_rate, w1))))
