"""The key as data: unrounded values in the units of the report, null for what does not exist."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from reportgen.answers.key import Key
from reportgen.answers.sheet import symbol_text

FORMAT = "reportgen-key/1"


def key_data(key: Key) -> dict[str, Any]:
    """The key as a JSON object.

    `values`, `drawn`, `computed` (half widths of the bands) and `sense` have an entry for each of `positions`,
    or a single one; `asked` are the positions of the answer sheet by label, [""] for a single value.
    """
    return {
        "format": FORMAT,
        "id": key.id,
        "kind": key.kind,
        "variant": key.variant,
        "language": key.language,
        "student": dict(key.student),
        "positions": list(key.labels),
        "rows": [
            {
                "id": row.id,
                "part": row.part.value,
                "role": row.role.value,
                "symbol": symbol_text(row, key),
                "kind": row.kind,
                "unit": row.unit,
                "decimals": row.decimals,
                "asked": [key.labels[k - 1] if k else "" for k in row.positions],
                "values": _numbers(row.values),
                "drawn": _numbers(row.drawn),
                "computed": _numbers(row.computed),
                "sense": list(row.sense),
            }
            for row in key.rows
        ],
    }


def _numbers(values: Iterable[float]) -> list[float | None]:
    return [float(value) if value == value else None for value in values]
