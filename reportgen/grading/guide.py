"""What one assignment is marked by: its key, the ledger behind it, and the bands in SI."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.analysis import Analysis
from reportgen.answers import bands
from reportgen.answers.key import Key, Role, Row, make_key
from reportgen.assignment import Assignment
from reportgen.case import Case
from reportgen.grading.policy import Policy
from reportgen.ledger.core import Ledger
from reportgen.ledger.following import carried, standing_on

ALMOST = 1e-12
"""Room for rounding in a comparison with a band."""


@dataclass(frozen=True)
class Guide:
    """An assignment opened for marking.

    `bands` [N] (SI) are the tolerances: the widest of drawing, rounding and a share of the quantity's
    maximum over the turn, for every row of the key.
    """

    key: Key
    ledger: Ledger
    analysis: Analysis
    policy: Policy

    @cached_property
    def bands(self) -> dict[str, np.ndarray]:
        policy, ledger = self.policy, self.ledger
        drawn, computed = bands.drawn(ledger, policy.paper), bands.computed(ledger, policy.digits)
        return {
            row.id: np.maximum(np.maximum(drawn[row.id], computed[row.id]), policy.share * self.size(row.id))
            * (1 + ALMOST)
            for row in self.key.rows
        }

    def size(self, id: str) -> float:
        """The largest value of a quantity over the turn (SI); of an angle, a full turn."""
        if id.startswith("dir."):
            return 2 * np.pi
        values = np.abs(self.ledger[id].values)
        return float(values[np.isfinite(values)].max(initial=0.0))

    @cached_property
    def rows(self) -> dict[str, Row]:
        """The rows that a sheet may fill in."""
        return {row.id: row for row in self.key.asked}

    @cached_property
    def judged(self) -> tuple[Row, ...]:
        """The rows that earn marks, in the ledger's order; how long the crank is drawn is the student's own choice."""
        order = {id: index for index, id in enumerate(self.ledger.families)}
        kept = (row for row in self.key.asked if row.kind != "segment" or row.role is not Role.scale)
        return tuple(sorted(kept, key=lambda row: order[row.id]))

    @cached_property
    def before(self) -> dict[str, tuple[str, ...]]:
        """Every quantity that a judged one stands on, nearest first."""
        vectors = carried(self.ledger)
        return {row.id: standing_on(self.ledger, row.id, vectors) for row in self.judged}

    @property
    def count(self) -> int:
        """Positions of one turn."""
        return self.analysis.machine.count

    def repeats(self, row: Row) -> bool:
        """Whether a quantity is asked for in the first turn only, because all turns are alike."""
        return not row.single and max(row.positions, default=0) <= self.count < len(row.values)

    def place(self, row: Row, position: int) -> int:
        """The position at which the sheet asks for a quantity that one at `position` stands on."""
        if row.single:
            return 0
        return (position - 1) % self.count + 1 if self.repeats(row) else position


def open_guide(assignment: Assignment, policy: Policy | None = None) -> Guide:
    """The marking guide of an assignment, computed as its report is."""
    case = Case(assignment)
    return Guide(make_key(case), case.ledger, case.analysis, policy or Policy())
