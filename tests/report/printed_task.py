"""A printed task of a machine, in English: its sentences and tables, and their values as files have them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

STROKES = ("intake", "compression", "expansion", "exhaust")
COMMON = {"n": "n", "ω_1": "omega1", "g": "g"}

File = dict[str, Any]


def typed(value: str) -> str:
    """A printed quantity as a file has it: 0.5 kg·m² → 0.5 kg m2."""
    return value.replace("−", "-").replace("°", " deg").replace("·", " ").replace("²", "2").replace("³", "3")


def point_name(point: str) -> str:
    """The name of a point without the mark of its index: S_2 → S2."""
    return point.replace("_", "")


@dataclass(frozen=True)
class Task:
    """The lines of a task: sentences, and tables by their captions, each a list of rows."""

    text: str
    tables: Mapping[str, Sequence[Sequence[str]]]

    @classmethod
    def of(cls, text: str) -> Task:
        before = text.partition("Filling in the answer sheet")[0]
        tables: dict[str, list[list[str]]] = {}
        sentences, caption = [], ""
        for line in before.splitlines():
            if line.startswith("[") and line.endswith("]"):
                caption = line[1:-1]
                tables.setdefault(caption, [])
            elif " | " in line and caption:
                tables[caption].append([cell.strip() for cell in line.split("|")])
            else:
                sentences.append(line)
        return cls("\n".join(sentences), tables)

    def find(self, pattern: str) -> str | None:
        """The first group of a pattern among the sentences."""
        found = re.search(pattern, self.text)
        return found[1] if found else None

    def table(self, caption: str) -> Sequence[Sequence[str]]:
        """The table whose caption begins so; none if there is none."""
        return next((rows for name, rows in self.tables.items() if name.startswith(caption)), ())

    @property
    def data(self) -> dict[str, str]:
        """The given quantities by their symbols."""
        rows = self.table("Given data") or self.table("Lengths")
        return {symbol: typed(value) for _, symbol, value in rows[1:]}


# --- tables -----------------------------------------------------------------------------------------


def rows_by_name(rows: Sequence[Sequence[str]]) -> dict[str, list[str]]:
    """A table of rows with their names in the first column, its blocks below one another put together."""
    found: dict[str, list[str]] = {}
    for name, *values in rows:
        found.setdefault(name.lower(), []).extend(typed(value) for value in values if value)
    return found


def columns_by_name(rows: Sequence[Sequence[str]]) -> dict[str, list[str]]:
    """A table of columns folded into sets side by side."""
    head, *body = rows
    names = list(dict.fromkeys(head))
    width = len(names)
    sets = [row[first : first + width] for first in range(0, len(head), width) for row in body]
    return {name: [typed(one[i]) for one in sets if one[i]] for i, name in enumerate(names)}


def diagram(rows: Sequence[Sequence[str]]) -> File:
    """An indicator diagram by strokes, or over the crank angle."""
    if rows[0][0] == "s/H":
        values = rows_by_name(rows)
        return {"unit": "N/cm2", "by": "stroke", "s": values["s/h"]} | {name: values[name] for name in STROKES}
    columns = columns_by_name(rows)
    angles = [f"{angle} deg" for angle in columns["φ"]]
    return {"unit": "N/cm2", "by": "crank_angle", "angle": angles, "p": columns["p"]}


def force_table(rows: Sequence[Sequence[str]]) -> File:
    """A force by strokes, or over the crank angle."""
    if rows[0][0] == "s/H":
        values = rows_by_name(rows)
        return {"by": "stroke", "unit": "N", "s": values["s/h"]} | {way: values[way] for way in ("inward", "outward")}
    columns = columns_by_name(rows)
    return {"by": "crank_angle", "unit": "N", "angle": [f"{angle} deg" for angle in columns["φ"]], "F": columns["P"]}
