"""Sheets of students who work by hand (`hand`): tasks of the repository's machines, and what is handed in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from reportgen.errors import Mark
from reportgen.grading.marks import Answer, Submission
from reportgen.grading.working import Guide
from tests.grading.hand import Hand, Rod, Task

TWIN, SLIDER = "engine-twin-05", "slider-crank-01"


def task(guide: Guide, position: int) -> Task:
    """What the assignment gives, as the student reads it at one position: data, the crank's angle, the diagram."""
    rows = {row.id: row for row in guide.key.rows}

    def si(id: str) -> float:
        family = guide.ledger[id]
        return float(family.values[position - 1 if len(family.values) > 1 else 0].real)

    given = {id: si(id) for id in ("H", "lambda", "D", "s", "g", "n", "G2", "G3") if id in guide.ledger}
    angle = si("phi.1")
    if "H" in given:
        rods = (
            Rod("A", "B", "S2", (2, 3), 0.0, pressure=si("p.3")),
            Rod("C", "D", "S4", (4, 5), si("crank.angle"), pressure=si("p.5")),
        )
        return Task(given, rods, angle - np.pi / 2, 1j)
    given |= {"R": si("l.AB"), "L": si("l.BC")}
    assert rows["P3"].positions
    return Task(given, (Rod("B", "C", "S2", (2, 3), 0.0, force=si("P3")),), angle, 1 + 0j, "AB")


def handed_in(guide: Guide, worked: Mapping[int, Hand]) -> Submission:
    """The sheet of a student who worked so at each position."""
    values = {}
    for row in guide.key.asked:
        for position in row.positions:
            hand = worked[position] if position else next(iter(worked.values()))
            value = hand.written.get(row.id)
            if value is not None and np.isfinite(value):
                values[row.id, position] = Answer(value, str(value), Mark("sheet.csv"))
    return Submission(guide.key.id, "sheet.csv", values, {})


def work(guide: Guide, positions: Iterable[int], **how: object) -> Submission:
    """The sheet of a student who works every position alike, with other luck in drawing."""
    seed = int(how.pop("seed", 0))  # type: ignore[call-overload]
    hands = {k: Hand(task(guide, k), seed=100 * seed + k, **how) for k in positions}  # type: ignore[arg-type]
    return handed_in(guide, hands)
