"""Identify vectors drawn to a wrong end, by their start and one more witness.

The witness is the arrowhead, the name, or a neighbour that continues from the end. A line that may be an omitted
vector, or one of several, is not assigned.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.base.records import Record
from reportgen.handin.line_repair import goes_on
from reportgen.handin.line_set import Lines
from reportgen.handin.plan_finder import FoundPlans
from reportgen.handin.plan_fit import LONG, SEEN, Fit, off_place
from reportgen.handin.plan_labels import Labels, names_of


@dataclass(frozen=True, eq=False)
class WrongVector:
    """A vector of a plan, by its number, drawn from its right start to a wrong end.

    `line` is the number of its line, `start` and `end` are the ends as drawn (mm).
    """

    plan: Fit
    vector: int
    line: int
    start: complex
    end: complex


def wrong_vectors(plans: FoundPlans, lines: Lines, heads: np.ndarray, labels: Labels) -> tuple[WrongVector, ...]:
    """Return the wrong vectors of the plans found among the lines (mm), with the places of their ends as drawn (mm).

    `heads` [M, 2] is True for the ends of lines with an arrowhead.
    """
    used = {line for plan in plans.plans for line in plan.used}
    used |= {line for several in plans.doubtful for fit in several for line in fit.used}
    search = _Search(lines, heads, labels, lines.without(used))
    several = zip(plans.plans, plans.sure, strict=True)
    return tuple(wrong for plan, sure in several for wrong in search.of(plan, sure))


class _Search(Record):
    lines: Lines
    heads: np.ndarray
    labels: Labels
    free: np.ndarray

    def of(self, plan: Fit, sure: np.ndarray) -> Iterator[WrongVector]:
        """Yield, for each corner where a missing vector begins, the one free line that begins there."""
        shape = plan.shape
        a, b = plan.at(shape.starts), plan.at(shape.ends)
        # Of two vectors with one line, or with interchangeable lines, one may have been drawn elsewhere.
        count = Counter(plan.lines[plan.present].tolist())
        unplaced = [n for n, line in enumerate(plan.lines) if line < 0 or count[line] > 1 or not sure[n]]
        # A vector along pieces that other vectors use may be drawn in full.
        runs = self.lines.ends[self.lines.in_runs]
        in_pieces = np.any(off_place(runs, a, b)[0] <= plan.reach[:, None], axis=1)
        wanting = [n for n in unplaced if abs(b[n] - a[n]) >= SEEN * self.lines.error and not in_pieces[n]]
        for corner in {shape.vectors[number].start for number in wanting}:
            place = complex(plan.at(shape.corners[corner]))
            reach = max(float(plan.reach[number]) for number in wanting)
            # Corners within the error of the same ends count as one.
            begin = [int(number) for number in wanting if abs(a[number] - place) <= 2 * reach]
            lines = [line for line in self._from(place, reach) if abs(line.end - line.start) >= LONG * self.lines.error]
            # A construction line has no head, and a vector that ends here has its head here.
            telling = [line for line in lines if line.headed or self._named(plan, begin, line) is not None]
            for line in telling:
                named = self._named(plan, begin, line)
                alone = len(begin) == 1 and len(telling) == 1
                vector = named if named is not None else begin[0] if alone else self._alike(plan, begin, line)
                if vector is None or not shape.vectors[vector].drawn or plan.lines[vector] >= 0:
                    continue
                if abs(b[vector] - a[vector]) < LONG * self.lines.error:
                    continue
                rivals = [other for other in telling if other is not line and self._may_be(plan, vector, other)]
                if not rivals or named is not None:
                    yield WrongVector(plan, vector, line.number, line.start, line.end)

    def _from(self, place: complex, reach: float) -> list[_Begun]:
        """Return the free lines that begin within `reach` (mm) of a place, as vectors from there.

        A line with an arrowhead begins at its other end. A piece of a longer line, or a line without an arrowhead that
        continues after a gap, need not begin or end at the ends of a vector, and is left out.
        """
        begun = []
        for number in self.free:
            if self.lines.longer[number]:
                continue
            for end in (0, 1):
                start, far = complex(self.lines.ends[number, end]), complex(self.lines.ends[number, 1 - end])
                if abs(start - place) > reach or self.heads[number, end]:
                    continue
                headed = bool(self.heads[number, 1 - end])
                if headed or not goes_on(self.lines, start, far):
                    begun.append(_Begun(int(number), start, far, headed))
        return begun

    def _named(self, plan: Fit, begin: Sequence[int], line: _Begun) -> int | None:
        """Return the only vector whose name is beside a line, unless only another one has its length or direction.

        A wrong line may pass the label of another plan's vector.
        """
        named = [n for n in begin if self.labels.beside(names_of(plan.shape, n), line.start, line.end)]
        alike = [n for n in begin if self._may_be(plan, n, line)]
        return named[0] if len(named) == 1 and (named[0] in alike or not alike) else None

    def _may_be(self, plan: Fit, vector: int, line: _Begun) -> bool:
        """Return True if a line has the length or the direction of a vector, within the errors."""
        along = plan.scale * complex(plan.shape.ends[vector] - plan.shape.starts[vector])
        drawn, off = line.end - line.start, 2 * self.lines.reach
        across = abs((drawn * along.conjugate()).imag) / abs(along)
        return abs(abs(drawn) - abs(along)) <= off or across <= off

    def _alike(self, plan: Fit, begin: Sequence[int], line: _Begun) -> int | None:
        """Return the one of several vectors whose length or direction a line has.

        If several end at nearly the same place, it is the one that the report's figure has.
        """
        alike = [vector for vector in begin if self._may_be(plan, vector, line)]
        drawn = [vector for vector in alike if plan.shape.vectors[vector].drawn]
        if len(drawn) != 1:
            return None
        ends = plan.at(plan.shape.ends[alike])
        apart = np.abs(ends - plan.at(plan.shape.ends[drawn[0]])).max()
        return drawn[0] if apart <= 2 * self.lines.reach else None


class _Begun(Record):
    """A line as a vector from its start (mm), and True if it has an arrowhead at its end."""

    number: int
    start: complex
    end: complex
    headed: bool
