"""Detect that a student exchanged two positions: all values of each are in the column of the other.

This counts as one mistake. The values are judged as if they were in their own places, and one of them loses its points.
The exchange is recognised only if most values of both positions are wrong as written, and nearly all are right or
follow after the exchange is undone. Values that are then still wrong are treated as usual.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from reportgen.base.records import Record, replace
from reportgen.marking.marking_data import Cells, Marked, Notice, Place, Submission, Verdict
from reportgen.marking.marking_scheme import MarkingScheme

NAME = "positions-exchanged"

FEWEST = 3
"""Smallest number of values that must distinguish the two positions."""

MOST, NEARLY_ALL = 0.5, 0.9
"""Required shares of the distinguishing values.

More than `MOST` must equal the other position's; at least `NEARLY_ALL` must be right or follow after the exchange.
"""

APART = 3.0
"""Number of tolerances by which the key's values must differ for a value to distinguish two positions."""


class Exchange(Record):
    """Two exchanged positions: the ids of the rows whose values were exchanged, and the distinguishing places.

    A distinguishing place has a value, and the key's value at the other position differs from its own.
    """

    positions: tuple[int, int]
    rows: frozenset[str]
    distinguishing: tuple[Place, ...]

    def home(self, place: Place) -> Place:
        """Return the place where the value of a place belongs."""
        id, position = place
        if id not in self.rows or position not in self.positions:
            return place
        return id, sum(self.positions) - position

    def undone(self, submission: Submission) -> Submission:
        """Return the submission with each value in its own place."""
        return replace(
            submission,
            values={self.home(place): one for place, one in submission.values.items()},
            problems={self.home(place): one for place, one in submission.problems.items()},
            unread={self.home(place): one for place, one in submission.unread.items()},
        )

    def explains(self, cells: Cells) -> bool:
        """Return True if nearly all distinguishing values are right or follow, judged on the corrected submission."""
        met = sum(cells[place].verdict in (Verdict.right, Verdict.follows) for place in self.distinguishing)
        return met >= NEARLY_ALL * len(self.distinguishing)

    def charged(self, cells: Cells) -> Place | None:
        """Return the place (of the corrected submission) of the value that loses its points: the first with any."""
        return next((place for place in self.distinguishing if cells[place].points), None)

    def as_handed_in(self, cells: Cells) -> dict[Place, Marked]:
        """Return the verdicts on a corrected submission at the places as written, one of them wrong."""
        placed = {at: replace(cell, position=at[1]) for place, cell in cells.items() for at in [self.home(place)]}
        lost = self.charged(cells)
        if lost is None:
            return placed
        at = self.home(lost)
        # The feedback shows the expected value of the place where the value was written.
        beside, wrong = cells[at], replace(placed[at], verdict=Verdict.wrong, points=0.0, first=True, elsewhere=False)
        wrong = replace(wrong, expected=beside.expected, own=beside.own, band=beside.band)
        return placed | {at: replace(wrong, mistake=NAME, where=at[0], exchanged=lost[1])}

    def noticed(self, flags: Sequence[Notice]) -> tuple[Notice, ...]:
        """Return the notices with the places where the values were written."""

        def placed(places: Sequence[Place]) -> tuple[Place, ...]:
            return tuple(map(self.home, places))

        return tuple(
            replace(flag, places=placed(flag.places), spoiled=placed(flag.spoiled), taken=placed(flag.taken))
            for flag in flags
        )


def possible_exchanges(scheme: MarkingScheme, submission: Submission, cells: Cells) -> Iterator[Exchange]:
    """Yield the pairs of positions in which each has mostly the values of the other."""
    given: dict[int, list[Marked]] = {}
    for cell in cells.values():
        if cell.position and cell.given is not None:
            given.setdefault(cell.position, []).append(cell)
    off = [k for k, here in given.items() if sum(one.verdict is not Verdict.right for one in here) >= FEWEST]
    for pair in combinations(sorted(off), 2):
        # A value measured on a drawing belongs to the plan that it was found on.
        rows = frozenset(
            row.id
            for row in scheme.key.asked
            if {*pair} <= {*row.positions} and not any((row.id, k) in submission.measured for k in pair)
        )
        distinguishing: list[Place] = []
        shares = []
        for here, there in (pair, pair[::-1]):
            tell = [one for one in given[here] if one.id in rows and _distinguishes(scheme, one, cells[one.id, there])]
            met = [one for one in tell if _has_value_of(scheme, one, cells[one.id, there])]
            shares.append(len(met) / len(tell) if len(tell) >= FEWEST else 0.0)
            distinguishing += [(one.id, there) for one in tell]
        if min(shares) > MOST:
            order = {row.id: index for index, row in enumerate(scheme.judged)}
            distinguishing.sort(key=lambda place: (order[place[0]], -place[1]))
            yield Exchange(pair, rows, tuple(distinguishing))


def _distinguishes(scheme: MarkingScheme, cell: Marked, partner: Marked) -> bool:
    """Return True if the key's values of two positions differ clearly."""
    return bool(scheme.distance(cell.id, cell.expected, partner.expected) >= APART * max(cell.band, partner.band))


def _has_value_of(scheme: MarkingScheme, cell: Marked, partner: Marked) -> bool:
    """Return True if a value is that of another position."""
    assert cell.given is not None
    return bool(scheme.distance(cell.id, cell.given, partner.expected) <= partner.band)
