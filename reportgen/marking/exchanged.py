"""Two positions that a student exchanged: each of all values stands where that of the other position belongs.

That is one mistake.  The values are judged as if they stood in their own places, and one of them is lost.  It is seen
only where most values of both positions are wrong as they stand, and nearly all are right or follow exchanged; what is
wrong then is wrong as on any sheet.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

from reportgen.marking.marks import Cells, Marked, Notice, Place, Submission, Verdict
from reportgen.marking.scheme import MarkingScheme

NAME = "positions-exchanged"

FEWEST = 3
"""So many values at least tell one position from the other."""

MOST, NEARLY_ALL = 0.5, 0.9
"""More of the telling values have to be those of the other position; this share has to be right or follow exchanged."""

APART = 3.0
"""A value tells two positions apart where the key's lie this many tolerances apart."""


@dataclass(frozen=True, slots=True)
class Exchange:
    """Two positions, the ids of the rows whose values were exchanged, and the places that tell one from the other.

    Telling places are those at which a value stands, whose key's value at the other position is another one.
    """

    positions: tuple[int, int]
    rows: frozenset[str]
    telling: tuple[Place, ...]

    def other(self, place: Place) -> Place:
        """Where the value of a place belongs."""
        id, position = place
        if id not in self.rows or position not in self.positions:
            return place
        return id, sum(self.positions) - position

    def undone(self, submission: Submission) -> Submission:
        """A submission with each value in its own place."""
        return replace(
            submission,
            values={self.other(place): one for place, one in submission.values.items()},
            problems={self.other(place): one for place, one in submission.problems.items()},
            unread={self.other(place): one for place, one in submission.unread.items()},
        )

    def explains(self, cells: Cells) -> bool:
        """Whether nearly all telling values are right or follow by the verdicts on the submission put right."""
        met = sum(cells[place].verdict in (Verdict.right, Verdict.follows) for place in self.telling)
        return met >= NEARLY_ALL * len(self.telling)

    def charged(self, cells: Cells) -> Place | None:
        """The place, of the submission put right, of the value that is lost: the first that earned its mark."""
        return next((place for place in self.telling if cells[place].points), None)

    def as_handed_in(self, cells: Cells) -> dict[Place, Marked]:
        """The verdicts on a submission put right at the places where the values stand, one of them lost."""
        placed = {at: replace(cell, position=at[1]) for place, cell in cells.items() for at in [self.other(place)]}
        lost = self.charged(cells)
        if lost is None:
            return placed
        at = self.other(lost)
        # It is told beside what belongs where it stands.
        beside, wrong = cells[at], replace(placed[at], verdict=Verdict.wrong, points=0.0, first=True, elsewhere=False)
        wrong = replace(wrong, expected=beside.expected, own=beside.own, band=beside.band)
        return placed | {at: replace(wrong, mistake=NAME, where=at[0], exchanged=lost[1])}

    def noticed(self, flags: Sequence[Notice]) -> tuple[Notice, ...]:
        """What was noticed, with the places where the values stand."""

        def placed(places: Sequence[Place]) -> tuple[Place, ...]:
            return tuple(map(self.other, places))

        return tuple(
            replace(flag, places=placed(flag.places), spoiled=placed(flag.spoiled), taken=placed(flag.taken))
            for flag in flags
        )


def possible_exchanges(scheme: MarkingScheme, submission: Submission, cells: Cells) -> Iterator[Exchange]:
    """The pairs of positions of which each has mostly the other's values."""
    given: dict[int, list[Marked]] = {}
    for cell in cells.values():
        if cell.position and cell.given is not None:
            given.setdefault(cell.position, []).append(cell)
    off = [k for k, here in given.items() if sum(one.verdict is not Verdict.right for one in here) >= FEWEST]
    for pair in combinations(sorted(off), 2):
        # What was measured on a drawing belongs to the plan that it was found on.
        rows = frozenset(
            row.id
            for row in scheme.key.asked
            if {*pair} <= {*row.positions} and not any((row.id, k) in submission.measured for k in pair)
        )
        telling: list[Place] = []
        shares = []
        for here, there in (pair, pair[::-1]):
            tell = [one for one in given[here] if one.id in rows and _tells(scheme, one, cells[one.id, there])]
            met = [one for one in tell if _is_of(scheme, one, cells[one.id, there])]
            shares.append(len(met) / len(tell) if len(tell) >= FEWEST else 0.0)
            telling += [(one.id, there) for one in tell]
        if min(shares) > MOST:
            order = {row.id: index for index, row in enumerate(scheme.judged)}
            telling.sort(key=lambda place: (order[place[0]], -place[1]))
            yield Exchange(pair, rows, tuple(telling))


def _tells(scheme: MarkingScheme, cell: Marked, other: Marked) -> bool:
    """Whether the key's values of two positions lie apart."""
    return bool(scheme.distance(cell.id, cell.expected, other.expected) >= APART * max(cell.band, other.band))


def _is_of(scheme: MarkingScheme, cell: Marked, other: Marked) -> bool:
    """Whether a value is that of another position."""
    assert cell.given is not None
    return bool(scheme.distance(cell.id, cell.given, other.expected) <= other.band)
