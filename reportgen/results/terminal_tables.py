"""Results as tables on a terminal: a row for each position by its label, vectors by their size."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from reportgen.base.template_folders import kind_file, templates
from reportgen.base.units import (
    LARGE,
    MM,
    MOST_DECIMALS,
    Language,
    figure_decimals,
    rounded,
    significant_decimals,
    write,
)
from reportgen.base.words import load_words, of_topics, word
from reportgen.catalogue import module
from reportgen.formula import ids

DIGITS = 5
NOTHING = 1e-9
"""Share of its scale below which a value is a rounding error."""
LEADS = ("position", "crank_angle", "driver_way")
"""Headings in every table: the position, and the position of the driver."""
MOST_COLUMNS = 7
WORDS = frozenset({"position", "crank_angle", "driver_way", "equilibrium", "virtual_work"})
"""Headings that are words of a language; the others are symbols."""

ResultRow = dict[str, float | str | None]
RowsOf = Callable[[Mapping[str, Any]], Mapping[str, Mapping[str, float | None]]]


def print_tables(results: Mapping[str, Any], language: Language) -> None:
    """Print the tables of results in the form of `reportgen-results/1`, as wide as necessary."""
    from rich.console import Console
    from rich.table import Table

    # Numbers are never cut to the width of a terminal; `MOST_COLUMNS` keeps the tables narrow enough for most.
    console = Console(width=500)
    titles = load_words((kind_file(language, results["kind"]),)).get("results", {})
    topics = of_topics(templates() / language).get("results", {})
    rows_by_table = tables(results["positions"], _rows_of(results["kind"], titles, topics))
    titles = {**topics, **titles}
    scales = _scales(rows_by_table, results["positions"])
    for name, rows in rows_by_table.items():
        for headings in _split(rows[0]):
            table = Table(title=titles.get(name) or word(name, language), title_justify="left", title_style="bold")
            for heading in headings:
                text = word(heading, language) if heading in WORDS else heading
                table.add_column(text, justify="right", no_wrap=True)
            columns = [_column([row.get(one) for row in rows], scales[name, one], language) for one in headings]
            for cells in zip(*columns, strict=True):
                table.add_row(*cells)
            console.print(table)
            console.print()
    for name, part in results.get("parts", {}).items():
        console.print(name, style="bold")
        console.print()
        print_tables(part, language)


def _split(row: ResultRow) -> list[list[str]]:
    """Return the headings of the tables into which a row is split, each with the position and its angle."""
    lead, others = [heading for heading in row if heading in LEADS], [one for one in row if one not in LEADS]
    return [[*lead, *others[at : at + MOST_COLUMNS]] for at in range(0, len(others), MOST_COLUMNS)]


def _rows_of(kind: str, titles: Collection[str], topics: Collection[str]) -> RowsOf:
    """Return a function that gives the rows that a kind and its topics add to a position.

    Those of the kind come from its `table_rows`, else from the entries that its words have titles for. Those of topics
    are the entries that their words have titles for.
    """

    def as_they_are(position: Mapping[str, Any]) -> Mapping[str, Mapping[str, float | None]]:
        return {name: position.get(name, {}) for name in titles}

    rows_of: RowsOf = getattr(module(kind), "table_rows", as_they_are)
    return lambda position: {**rows_of(position), **{name: position.get(name, {}) for name in topics}}


def tables(
    positions: Sequence[Mapping[str, Any] | None], own: RowsOf = lambda position: {}
) -> dict[str, list[ResultRow]]:
    """Return the rows of each table by its name; unreachable positions are left out.

    `own` returns the rows that only this kind has at a position, by the names of their tables.
    """
    rows_by_table: dict[str, list[ResultRow]] = defaultdict(list)
    for position in positions:
        if position is None:
            continue
        lead: ResultRow = {"position": position.get("label", str(position["number"])), **_driver(position)}
        points, links = position.get("points", {}), position.get("links", {})
        rows: dict[str, ResultRow] = {
            "velocities": {f"v {name}": _size(point["v"]) for name, point in points.items()},
            "accelerations": {f"a {name}": _size(point["a"]) for name, point in points.items()},
            "links": {
                f"{symbol}{name}": link[quantity]
                for symbol, quantity in (("ω", "omega"), ("ε", "epsilon"))
                for name, link in links.items()
            },
            "loads": {name: _size(load) for name, load in position.get("loads", {}).items()},
            "reactions": _once({name: _size(force) for name, force in position.get("reactions", {}).items()}),
            "torque": dict(position.get("balancing_torque", {})),
            "force": dict(position.get("balancing_force", {})),
            **{name: dict(row) for name, row in own(position).items()},
        }
        for name, row in rows.items():
            if row:
                rows_by_table[name].append(lead | row)
    return {name: _without_zeros(rows) for name, rows in rows_by_table.items()}


def _driver(position: Mapping[str, Any]) -> ResultRow:
    """Return the position of the driver: a crank's angle in degrees, a slider's displacement in mm; {} without one."""
    if "driver_way" in position:
        return {"driver_way": position["driver_way"] * MM}
    if "crank_angle" not in position:
        return {}
    return {"crank_angle": round(math.degrees(position["crank_angle"]), 6) % 360}


def _once(reactions: ResultRow) -> ResultRow:
    """Return each pair R_ij, R_ji once, because their sizes are equal."""
    sizes: ResultRow = {}
    for name, size in reactions.items():
        if ids.reaction_force(ids.joint(*reversed(ids.links_of(name)))) not in sizes:
            sizes[name] = size
    return sizes


def _without_zeros(rows: list[ResultRow]) -> list[ResultRow]:
    """Return the rows without the columns that are zero at every position (a slider's angular velocity)."""
    heads = dict.fromkeys(key for row in rows for key in row)
    kept = [key for key in heads if any(row.get(key) for row in rows) or key in WORDS]
    return [{key: row.get(key) for key in kept} for row in rows]


def _size(vector: Any) -> float | None:
    """Return the size of a vector [x, y]; for a reaction with further keys, that of its force."""
    parts = vector.get("force") if isinstance(vector, Mapping) else vector
    return None if parts is None else math.hypot(*parts)


def _column(values: Sequence[float | str | None], scale: float, language: Language) -> list[str]:
    """Return the column's numbers with the decimals that give the largest of them `DIGITS` figures.

    A value negligible beside its `scale` is 0. A value that these decimals would round to 0 has its own number of
    decimals, and so have all values if the largest is very large or very small.
    """
    numbers = [value for value in values if not (value is None or isinstance(value, str))]
    largest = max(map(abs, numbers), default=0.0)
    whole = largest < LARGE and all(float(value).is_integer() for value in numbers)
    decimals = 0 if whole else figure_decimals(largest, DIGITS)

    def cell(value: float | str | None) -> str:
        if value is None or isinstance(value, str):
            return value or "–"
        if abs(value) <= NOTHING * max(scale, largest):
            return write(0.0, decimals if 0 <= decimals <= MOST_DECIMALS else 0, language)
        alike = 0 <= decimals <= MOST_DECIMALS and rounded(value, decimals) != 0
        return write(value, decimals if alike else significant_decimals(value, DIGITS), language)

    return [cell(value) for value in values]


SCALES: Mapping[str, str] = {
    **{name: name for name in ("velocities", "accelerations", "torque")},
    **dict.fromkeys(("loads", "reactions", "force"), "force"),
}
"""Common scale of all columns of a table, since they are computed from one another."""


def _scale(name: str, heading: str) -> str:
    """Return the scale that a column of a table shares with others, at least with those of its letter: ω1 and ω2."""
    letter = heading[:1]
    return letter if name == "links" else SCALES.get(name, f"{name} {letter}")


def _scales(
    rows_by_table: Mapping[str, Sequence[ResultRow]], positions: Sequence[Mapping[str, Any] | None]
) -> Mapping[tuple[str, str], float]:
    """Return the largest value among the columns that share a column's scale; 0 for the position of the driver.

    ε is also compared with ω², a torque with the forces and lengths that cause it.
    """
    largest: dict[str, float] = defaultdict(float)
    columns = {
        (name, heading): "" if heading in LEADS else _scale(name, heading)
        for name, rows in rows_by_table.items()
        for heading in rows[0]
    }
    for (name, heading), scale in columns.items():
        values = (row.get(heading) for row in rows_by_table[name])
        sizes = (abs(value) for value in values if not (value is None or isinstance(value, str)))
        largest[scale] = max(largest[scale], *sizes, 0.0)
    places = (point["p"] for position in positions if position for point in position.get("points", {}).values())
    largest["ε"] = max(largest["ε"], largest["ω"] ** 2)
    largest["torque"] = max(largest["torque"], largest["force"] * max((_size(p) or 0.0 for p in places), default=0.0))
    return {column: largest[scale] if scale else 0.0 for column, scale in columns.items()}
