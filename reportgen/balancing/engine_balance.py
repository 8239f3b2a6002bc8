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
    longest = max((given.r, *(one.r for one in given.cylinders if one.r)), key=lambda r: r.si)
    if given.l.si < SHORTEST * longest.si:
        least = f"{SHORTEST * longest.si * 1e3:g}"
        yield Finding("rod-too-short", (*TOP, "l"), {"l": given.l.text, "r": longest.text, "least": least})
    rods: list[tuple[str | int, ...]] = [TOP] if given.m2 is not None else []
    rods += [(*TOP, "cylinders", k) for k, one in enumerate(given.cylinders) if one.m2 is not None]
    if given.s is None:
        for path in rods:
            yield Finding("needs-besides", (*path, "m2"), {"key": "m2", "other": "s"}, at="key")
    elif not rods:
        yield Finding("needs-besides", (*TOP, "s"), {"key": "s", "other": "m2"}, at="key")
    places: dict[tuple[float, float], int] = {}
    for number, cylinder in enumerate(given.cylinders):
        first = places.setdefault((cylinder.at.si, cylinder.bank.si), number)
        if first != number:
            yield Finding("cylinders-in-one-place", (*TOP, "cylinders", number), {"first": str(first + 1)})


CHECKS = (of_parameters(check),)
