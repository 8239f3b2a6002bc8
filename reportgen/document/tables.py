"""The tables that templates may call, by name; what they show of the report is in the modules beside.

Given data: `given_tables`; motion: `motion_tables`; forces: `force_tables`; checks: `check_tables`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from reportgen.document.check_tables import CheckTables
from reportgen.document.force_tables import ForceTables
from reportgen.document.given_tables import GivenTables
from reportgen.document.motion_tables import MotionTables
from reportgen.document.tabled import Tabled
from reportgen.document.tree import Table

MOST_COLUMNS = 9


class Tables(Tabled):
    """All tables of one report."""

    @property
    def functions(self) -> dict[str, Callable[..., Any]]:
        """What templates may call, by name."""
        kinds = (GivenTables, MotionTables, ForceTables, CheckTables)
        found: dict[str, Callable[..., Any]] = {"tables": self.tables}
        for kind in kinds:
            found |= kind(self.assignment, self.facts, self.voice).functions
        return found

    def tables(
        self, key: str, caption: str, ids: Sequence[str], positions: Iterable[int]
    ) -> tuple[Table, ...]:
        """One table, or several below one another where the columns are too many; the key names the first."""
        wide = MOST_COLUMNS - 1
        count = max(-(-len(ids) // wide), 1)
        size = -(-len(ids) // count)
        parts = [ids[start : start + size] for start in range(0, len(ids), size)]
        rows = list(positions)
        return tuple(
            self.voice.table(
                key if index == 0 else f"{key}.{index + 1}",
                caption if count == 1 else f"{caption} ({index + 1}/{count})",
                part,
                rows,
            )
            for index, part in enumerate(parts)
        )
