"""The kind `engine-balance` and the checks of its data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters
from reportgen.balancing import engine_file
from reportgen.base.errors import Finding

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.balancing.engine_case import EngineCase

Parameters = engine_file.Parameters
TURNS = 1
PART = "orders"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
SHORTEST = 1.2
"""Smallest ratio of rod to crank: a shorter rod cannot pass the crank."""


def case(assignment: Assignment) -> EngineCase:
    """Return the case of an assignment."""
    from reportgen.balancing.engine_case import EngineCase

    return EngineCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the rows of results that `solve` prints: forces (N) and couples (N·m) by orders, the counterweight
    (kg·m).
    """
    orders, counterweight = position["orders"].items(), position["counterweight"]
    return {
        "forces": {f"F_{order}": entry["force"] for order, entry in orders},
        "couples": {f"M_{order}": entry["couple"] for order, entry in orders if "couple" in entry},
        "least_forces": {f"F_{order},min": entry["least_force"] for order, entry in orders if "least_force" in entry},
        "least_couples": {
            f"M_{order},min": entry["least_couple"] for order, entry in orders if "least_couple" in entry
        },
        "counterweight": {"U_c": counterweight["unbalance"]},
    }


def check(given: Parameters) -> Iterator[Finding]:
    """Require a sufficiently long rod, its mass with the place of its mass centre, and different places for all
    cylinders.
    """
    if given.l.si < SHORTEST * given.r.si:
        least = f"{SHORTEST * given.r.si * 1e3:g}"
        yield Finding("rod-too-short", (*TOP, "l"), {"l": given.l.text, "r": given.r.text, "least": least})
    for key, further in (("m2", "s"), ("s", "m2")):
        if getattr(given, key) is not None and getattr(given, further) is None:
            yield Finding("needs-besides", (*TOP, key), {"key": key, "other": further}, at="key")
    places: dict[tuple[float, float], int] = {}
    for number, cylinder in enumerate(given.cylinders):
        first = places.setdefault((cylinder.at.si, cylinder.bank.si), number)
        if first != number:
            yield Finding("cylinders-in-one-place", (*TOP, "cylinders", number), {"first": str(first + 1)})


CHECKS = (of_parameters(check),)
