"""Results as tables on a terminal: a row for each position, vectors by their size."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from reportgen.assignment.messages import word
from reportgen.notation.numbers import Language, significant_decimals, write

DIGITS = 5
MOST_DECIMALS = 4

Row = dict[str, float | None]


def print_tables(results: Mapping[str, Any], language: Language) -> None:
    """Prints the tables of results in the form of `reportgen-results/1`, as wide as they need."""
    from rich.console import Console
    from rich.table import Table

    console = Console()
    for name, rows in tables(results["positions"]).items():
        table = Table(title=word(name, language), title_justify="left", title_style="bold")
        for heading in rows[0]:
            known = heading in {"position", "crank_angle", "cycle_angle", "equilibrium", "virtual_work"}
            table.add_column(word(heading, language) if known else heading, justify="right", no_wrap=True)
        for cells in zip(*(_column(rows, heading, language) for heading in rows[0]), strict=True):
            table.add_row(*cells)
        # A pipe has no width: columns must not be cut to a terminal's that is not there.
        console.print(table, width=None if console.is_terminal else 400)
        console.print()


def tables(positions: Sequence[Mapping[str, Any] | None]) -> dict[str, list[Row]]:
    """Name of each table and its rows; positions that cannot be reached are left out."""
    found: dict[str, list[Row]] = defaultdict(list)
    for position in positions:
        if position is None:
            continue
        lead: Row = {
            "position": position["number"],
            "crank_angle": math.degrees(position["crank_angle"]),
            "cycle_angle": math.degrees(position["cycle_angle"]),
        }
        points, links = position["points"], position["links"]
        rows: dict[str, Row] = {
            "velocities": {f"v {name}": _size(point["v"]) for name, point in points.items()},
            "accelerations": {f"a {name}": _size(point["a"]) for name, point in points.items()},
            "links": {
                f"{symbol}{name}": link[quantity]
                for symbol, quantity in (("ω", "omega"), ("ε", "epsilon"))
                for name, link in links.items()
            },
            "reactions": {name: _size(vector) for name, vector in position.get("reactions", {}).items()},
            "torque": dict(position.get("balancing_torque", {})),
        }
        for name, row in rows.items():
            if row:
                found[name].append(lead | row)
    return dict(found)


def _size(vector: Any) -> float | None:
    """The size of a vector [x, y]; of a reaction with further keys, that of its force."""
    parts = vector.get("force") if isinstance(vector, Mapping) else vector
    return None if parts is None else math.hypot(*parts)


def _column(rows: Sequence[Row], heading: str, language: Language) -> list[str]:
    """The column's numbers with one count of decimals, that shows the largest with `DIGITS` figures."""
    values = [row.get(heading) for row in rows]
    largest = max((abs(value) for value in values if value is not None), default=0.0)
    whole = all(value is None or float(value).is_integer() for value in values)
    decimals = 0 if whole else min(max(significant_decimals(largest, DIGITS), 0), MOST_DECIMALS)
    return ["–" if value is None else write(value, decimals, language) for value in values]
