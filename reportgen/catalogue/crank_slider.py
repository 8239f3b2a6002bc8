"""Closed formulas of the centred crank and slider, which every engine of the catalogue shares.

φ is the crank's angle from the slider's outer dead centre in the direction of rotation, β the rod's
angle to the cylinder axis, λ = R/L:  sin β = λ sin φ;  x = R(1 − cos φ) + L(1 − cos β);
v = ω₁R sin(φ + β)/cos β;  a = ω₁²R [cos(φ + β)/cos β + λ cos²φ/cos³β];  ω₂ = ω₁λ cos φ/cos β;
ε₂ = −ω₁²λ(1 − λ²) sin φ/cos³β.  x, v, a count from the dead centre towards the crank; ω₂, ε₂ count as β grows.
"""

from __future__ import annotations

import numpy as np

from reportgen.catalogue.machine import Item, Piston
from reportgen.notation.expressions import (
    Expression,
    Root,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)


def formulas(rod: int, slider: int, pin: str, joint: str, centre: str, angle: np.ndarray) -> tuple[Item, ...]:
    """Items for one slider: `phi.3` (given, per position), `beta.2`, `x.3`, `f.v.B`, `f.a.B`, `f.omega.2`,
    `f.eps.2` and the mass centre's `f.v.S2`, `f.a.S2` by components.  Uses R, L, lambda, omega.1.
    """
    phi, beta = f"phi.{slider}", f"beta.{rod}"
    length, along = "L", f"l.{pin}{centre}"
    number, link = str(slider), str(rod)
    cos_beta = call("cos", beta)

    def item(id: str, symbol: Symbol, kind: str, definition: Expression, scale: float = 0.0) -> Item:
        return Item(id, symbol, kind, definition=definition, traits={"scale": scale} if scale else {})

    rest = subtract(1.0, divide(along, length))
    x_of_s, y_of_s = f"f.x.{centre}", f"f.y.{centre}"
    return (
        Item(phi, Symbol("φ", number), "angle", angle, traits={"exact": _is_round(angle), "scale": 1.0}),
        item(beta, Symbol("β", link), "angle", call("arcsin", multiply("lambda", call("sin", phi))), 1.0),
        item(
            f"x.{slider}",
            Symbol("x", joint),
            "length",
            add(
                multiply("R", subtract(1.0, call("cos", phi))),
                multiply(length, subtract(1.0, cos_beta)),
            ),
            0.01,
        ),
        item(
            f"f.v.{joint}",
            Symbol("v", joint),
            "velocity",
            divide(multiply("omega.1", "R", call("sin", add(phi, beta))), cos_beta),
            1.0,
        ),
        item(
            f"f.omega.{rod}",
            Symbol("ω", link),
            "angular velocity",
            divide(multiply("omega.1", "lambda", call("cos", phi)), cos_beta),
            1.0,
        ),
        item(
            f"f.a.{joint}",
            Symbol("a", joint),
            "acceleration",
            multiply(
                power("omega.1", 2.0),
                "R",
                add(
                    divide(call("cos", add(phi, beta)), cos_beta),
                    divide(multiply("lambda", power(call("cos", phi), 2.0)), power(cos_beta, 3.0)),
                ),
            ),
            1.0,
        ),
        item(
            f"f.eps.{rod}",
            Symbol("ε", link),
            "angular acceleration",
            negative(
                divide(
                    multiply(
                        power("omega.1", 2.0),
                        "lambda",
                        subtract(1.0, power("lambda", 2.0)),
                        call("sin", phi),
                    ),
                    power(cos_beta, 3.0),
                )
            ),
            1.0,
        ),
        item(
            f"{x_of_s}.v",
            Symbol("v", f"{centre}x"),
            "velocity",
            multiply(rest, "omega.1", "R", call("cos", phi)),
            1.0,
        ),
        item(
            f"{y_of_s}.v",
            Symbol("v", f"{centre}y"),
            "velocity",
            negative(
                add(
                    multiply("omega.1", "R", call("sin", phi)),
                    multiply(along, f"f.omega.{rod}", call("sin", beta)),
                )
            ),
            1.0,
        ),
        item(
            f"f.v.{centre}",
            Symbol("v", centre),
            "velocity",
            Root(add(power(f"{x_of_s}.v", 2.0), power(f"{y_of_s}.v", 2.0))),
        ),
        item(
            f"{x_of_s}.a",
            Symbol("a", f"{centre}x"),
            "acceleration",
            negative(multiply(rest, power("omega.1", 2.0), "R", call("sin", phi))),
            1.0,
        ),
        item(
            f"{y_of_s}.a",
            Symbol("a", f"{centre}y"),
            "acceleration",
            negative(
                add(
                    multiply(power("omega.1", 2.0), "R", call("cos", phi)),
                    multiply(
                        along,
                        add(
                            multiply(f"f.eps.{rod}", call("sin", beta)),
                            multiply(power(f"f.omega.{rod}", 2.0), cos_beta),
                        ),
                    ),
                )
            ),
            1.0,
        ),
        item(
            f"f.a.{centre}",
            Symbol("a", centre),
            "acceleration",
            Root(add(power(f"{x_of_s}.a", 2.0), power(f"{y_of_s}.a", 2.0))),
        ),
    )


def _is_round(angle: np.ndarray) -> bool:
    """Whether all angles are whole hundredths of a degree, to be printed as they are."""
    hundredths = np.degrees(angle) * 100
    return bool(np.allclose(hundredths, np.round(hundredths), rtol=0, atol=1e-7))


def compared(pistons: tuple[Piston, ...]) -> tuple[tuple[str, str], ...]:
    """Plan quantities and the closed formulas that must give the same sizes."""
    return tuple(
        (plan, f"f.{plan}")
        for piston in pistons
        for plan in (
            f"v.{piston.pin}",
            f"omega.{piston.rod}",
            f"v.S{piston.rod}",
            f"a.{piston.pin}",
            f"eps.{piston.rod}",
            f"a.S{piston.rod}",
        )
    )
