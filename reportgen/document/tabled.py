"""What all tables of a report share: the report's facts, and how a number stands in a cell."""

from __future__ import annotations

from dataclasses import dataclass

from reportgen.assignment import Assignment
from reportgen.document.facts import Facts
from reportgen.document.tree import Value
from reportgen.document.voice import Voice
from reportgen.notation.expressions import Number


@dataclass(frozen=True)
class Tabled:
    """A report that tables are made of."""

    assignment: Assignment
    facts: Facts
    voice: Voice


def lowered(text: str) -> str:
    """Digits of point names as lowered digits: O1A → O₁A."""
    return text.translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))


def tidy(value: float) -> tuple[Value, ...]:
    """A number to two decimals, or as it is when it has no more than two."""
    return (
        Value(
            Number(float(f"{value:.10g}"))
            if abs(value * 100 - round(value * 100)) < 1e-7
            else Number(value, 2)
        ),
    )
