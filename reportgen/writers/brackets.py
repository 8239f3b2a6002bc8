"""How tightly printed expressions hold together: where a formula needs parentheses, for any writer."""

from __future__ import annotations

from reportgen.notation.expressions import (
    Call,
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Root,
    Sum,
    Symbol,
    VectorEquation,
)

RELATION, SUM, PRODUCT, QUOTIENT, MARKED, ATOM = range(6)
"""Levels of binding, the loosest first; MARKED is an atom that already carries a unit or superscript."""

PRIMES = ("′", "″")


def level(node: Expression) -> int:
    """The level at which a node holds together; a parent that needs more puts it in parentheses."""
    match node:
        case Chain() | VectorEquation():
            return RELATION
        case Sum() | Negative():
            return SUM
        case Number():
            return SUM if node.shown < 0 else MARKED if node.unit else ATOM
        case Product():
            return PRODUCT
        case Fraction() | Call() | Power() | Root():
            return QUOTIENT
        case Symbol():
            return MARKED if node.sup or node.base.endswith(PRIMES) else ATOM
        case _:
            return ATOM
