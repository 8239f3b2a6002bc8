"""Values as people type them into fields: what they mean, and the nodes that are written for them."""

from __future__ import annotations

from collections.abc import Iterable

from reportgen.base.errors import Location, Problem, Where
from reportgen.base.units import QuantityFault, read_quantity, read_unit
from reportgen.base.yaml_edit import as_list
from reportgen.base.yaml_source import Node, Scalar, SequenceNode, read_text
from reportgen.base.yaml_values import at

HERE = Location("")
MENDED = frozenset({"decimal-comma", "unknown-unit", "wrong-unit"})
"""Codes of faults whose only remedy is written at once: a decimal comma, a unit in other letters or in words."""


def only_meaning(problems: Iterable[Problem]) -> str:
    """Return the text that a value must mean, by the problems at its place; "" if it has none or several meanings.

    1,6 is 1.6 and 0.8 KN is 0.8 kN; 1,600 may be 1.6 or 1600, which only the user knows.
    """
    remedies = [problem.remedies for problem in problems if problem.level == "error" and problem.code in MENDED]
    return remedies[0][0] if len(remedies) == 1 and len(remedies[0]) == 1 else ""


def value_node(text: str, where: Where, typed: str, as_items: bool) -> Node:
    if as_items:
        old = at(read_text(text).top, where)
        if typed.strip() in ("all", "find") and not isinstance(old, SequenceNode | None):
            return Scalar(typed.strip(), HERE)
        return Scalar("all", HERE) if typed.strip() == "all" else as_list(typed)
    return Scalar(typed, HERE, null=not typed)


def converted(text: str, unit: str) -> str:
    """Return a quantity in another unit of the same dimension, to three figures; "" if the dimension differs."""
    try:
        return f"{read_quantity(text, unit).si / read_unit(unit, unit):.3g} {unit}"
    except QuantityFault:
        return ""
