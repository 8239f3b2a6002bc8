"""Closed formulas of the second cylinder of a V engine, whose rod hangs on the main rod or on the crank pin.

Seen from the main cylinder's axis, y along it away from the crank and x to the side to which the crank
turns from its top, the joint J of rod 4 lies at (x, y).  On the second axis, at δ in the direction of
rotation: h = x cos δ − y sin δ across and y cos δ + x sin δ along, likewise for its velocity and
acceleration; with sin γ = h/l₄:  v_E = v∥ − v⊥ tan γ;  ω₄ = v⊥/(l₄ cos γ);
a_E = a∥ − a⊥ tan γ − v⊥²/(l₄ cos³γ);  ε₄ = (a⊥ + l₄ω₄² sin γ)/(l₄ cos γ).
"""

from __future__ import annotations

from reportgen.catalogue.machine import Item
from reportgen.notation.expressions import (
    Expression,
    Ref,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)

COS, SIN = call("cos", "phi.3"), call("sin", "phi.3")


def _item(id: str, symbol: Symbol, kind: str, definition: Expression) -> Item:
    return Item(id, symbol, kind, definition=definition, traits={"scale": 1.0})


def crank_pin() -> tuple[Item, ...]:
    """The velocity and acceleration of the crank pin B by components, for a rod that hangs on it."""
    speed, force = multiply("omega.1", "R"), multiply(power("omega.1", 2), "R")
    return (
        _item("f.x.B.v", Symbol("v", "Bx"), "velocity", multiply(speed, COS)),
        _item("f.y.B.v", Symbol("v", "By"), "velocity", negative(multiply(speed, SIN))),
        _item("f.x.B.a", Symbol("a", "Bx"), "acceleration", negative(multiply(force, SIN))),
        _item("f.y.B.a", Symbol("a", "By"), "acceleration", negative(multiply(force, COS))),
    )


def place(joint: str) -> tuple[Item, ...]:
    """x and y of the joint of rod 4: D on the main rod at l_BD from B, or B itself."""
    x: Expression = multiply("R", SIN)
    y: Expression = multiply("R", COS)
    if joint != "B":
        along = f"l.B{joint}"
        x = multiply("R", subtract(1.0, divide(along, "L")), SIN)
        y = add(y, multiply(along, call("cos", "beta.2")))
    return (
        _item(f"f.x.{joint}", Symbol("x", joint), "length", x),
        _item(f"f.y.{joint}", Symbol("y", joint), "length", y),
    )


def second(joint: str, rod: str) -> tuple[Item, ...]:
    """The second cylinder: `beta.4`, `f.v.E`, `f.omega.4`, `f.a.E`, `f.eps.4`; uses `delta` and `l.` of the rod."""
    length = f"l.{rod}"
    cos, sin = call("cos", "delta"), call("sin", "delta")
    steep, tan = call("cos", "beta.4"), call("tan", "beta.4")

    def across(suffix: str) -> Expression:
        return subtract(multiply(f"f.x.{joint}{suffix}", cos), multiply(f"f.y.{joint}{suffix}", sin))

    def along(suffix: str) -> Expression:
        return add(multiply(f"f.y.{joint}{suffix}", cos), multiply(f"f.x.{joint}{suffix}", sin))

    return (
        _item("f.h", Symbol("h"), "length", across("")),
        _item("beta.4", Symbol("γ"), "angle", call("arcsin", divide("f.h", length))),
        _item("f.across.v", Symbol("v", "⊥"), "velocity", across(".v")),
        _item("f.along.v", Symbol("v", "∥"), "velocity", along(".v")),
        _item("f.v.E", Symbol("v", "E"), "velocity", subtract("f.along.v", multiply("f.across.v", tan))),
        _item(
            "f.omega.4", Symbol("ω", "4"), "angular velocity", divide("f.across.v", multiply(length, steep))
        ),
        _item("f.across.a", Symbol("a", "⊥"), "acceleration", across(".a")),
        _item("f.along.a", Symbol("a", "∥"), "acceleration", along(".a")),
        _item(
            "f.a.E",
            Symbol("a", "E"),
            "acceleration",
            subtract(
                "f.along.a",
                multiply("f.across.a", tan),
                divide(power("f.across.v", 2), multiply(length, power(steep, 3))),
            ),
        ),
        _item(
            "f.eps.4",
            Symbol("ε", "4"),
            "angular acceleration",
            divide(
                add(
                    "f.across.a",
                    multiply(length, power(Ref("f.omega.4"), 2), call("sin", "beta.4")),
                ),
                multiply(length, steep),
            ),
        ),
    )
