"""Decide which placement of a plan is certain, and which line of it is which vector.

The evidence for a fit is a logarithm of odds. An unrelated figure has an end at a third corner only by chance: one of
its lines would have to end within ±2.5 σ instead of anywhere in the figure, once in each direction. A plan is accepted
if the odds are `BY_CHANCE` against chance and `BEYOND_DOUBT` against every other plan at its place.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.handin.line_set import Lines
from reportgen.handin.plan_fit import ANYWHERE, FEWEST_CORNERS, LONG, SEEN, Beside, Fit, fits, fitted, named
from reportgen.handin.plan_labels import TITLE, Labels, names_of
from reportgen.handin.plan_shapes import PlanShape

BEYOND_DOUBT = float(np.log(1e5))
"""Required odds (logarithm) against another plan at the same place."""
BY_CHANCE = float(np.log(1e3))
"""Required odds (logarithm) against lines that meet in this way by chance, over all placements tried."""
WITHIN = 2.5
"""Number of deviations within which a right end lies: √(2π) σ is the width of a normal distribution."""
LEFT_OUT = float(np.log(20.0))
"""Odds (logarithm) against an omitted vector: students omit one in twenty."""
CLOSED = 1.0
"""Evidence of a line between two ends that already exist, as every polygon has one."""
OTHER_SCALE = float(np.log(0.05))
"""Odds (logarithm) of a plan drawn to another scale than most."""
MANY = 3
"""Number of plans of one kind that establish their common scale."""
FINEST = 0.03
"""Smallest assumed deviation (mm) of a drawing, because lengths are rounded before they are drawn."""
SHARED = 1 / 3
"""Share of common lines above which two fits are at the same place."""
UNLABELLED = Labels(())


class FoundPlans(Record):
    """The plans found with certainty, groups of fits that share a place, and the deviation of drawn ends (mm).

    The `deviation` is the standard deviation in each direction.
    """

    plans: tuple[Fit, ...]
    sure: tuple[np.ndarray, ...]
    """For each plan, a mask [E] of the vectors whose line is certain."""
    doubtful: tuple[tuple[Fit, ...], ...]
    deviation: float


def find(shapes: Sequence[PlanShape], lines: Lines, labels: Labels = UNLABELLED) -> FoundPlans:
    """Return the plans among the lines (mm), with masks [E] of their certain vectors and the deviation of ends (mm).

    All plans of a kind are expected at one scale: after a first search, the deviation and the common scales are
    determined from the clear plans, and the search is repeated with them.
    """
    every = [fit for shape in shapes for fit in fits(shape, lines)]
    judge = _Judge(lines, len(shapes), lines.error / np.sqrt(3), {}, labels)
    clear, _ = judge.decided(every)
    deviation = _deviation(clear, lines)
    judge = replace(judge, deviation=deviation)
    again = [fit for rough in every if (fit := _closer(rough, lines, deviation)) is not None]
    scales = _common_scales(again, judge) | _common_scales(judge.decided(again)[0], judge)
    judge = replace(judge, scales=scales)
    small = [
        fit
        for shape in shapes
        if shape.scale in scales
        for rough in fits(
            shape, lines, [scales[shape.scale] if shape.is_of_motion else shape.unit / scales[shape.scale]]
        )
        if (fit := _closer(rough, lines, deviation)) is not None
    ]
    plans, doubtful = judge.decided(_distinct([*again, *small]))
    sure = [named(fit, lines, deviation, BEYOND_DOUBT, _names(fit, lines, labels)) for fit in plans]
    return FoundPlans(tuple(plans), tuple(sure), tuple(doubtful), deviation)


def _names(fit: Fit, lines: Lines, labels: Labels) -> Beside:
    """Return a test by labels that distinguishes vectors of a plan that lie beside one another."""

    def beside(vector: int, line: int) -> bool:
        start, end = lines.ends[line]
        return labels.beside(names_of(fit.shape, vector), complex(start), complex(end))

    return beside


def _closer(fit: Fit, lines: Lines, deviation: float) -> Fit | None:
    return fitted(fit.shape, lines, fit.scale, fit.shift, deviation)


def _distinct(several: Sequence[Fit]) -> list[Fit]:
    distinct: dict[tuple[int, frozenset[int]], Fit] = {}
    for fit in several:
        key = id(fit.shape), fit.explained
        if key not in distinct or fit.square < distinct[key].square:
            distinct[key] = fit
    return list(distinct.values())


def _deviation(plans: Sequence[Fit], lines: Lines) -> float:
    """Return the standard deviation (mm) of ends in each direction over all plans, at most the usual one."""
    usual = lines.error / np.sqrt(3)
    count = sum(4 * len(fit.present) - 3 for fit in plans)
    if count < 4 * MANY:
        return float(usual)
    square = sum(fit.square for fit in plans)
    return float(np.clip(np.sqrt(square / count), FINEST, usual))


def _drawn_to(fit: Fit) -> float:
    """Return the scale of a plan relative to the report's (a ratio); for forces, whose scale varies, the scale itself.

    The scale of forces is in SI units per mm of the drawing.
    """
    return fit.scale if fit.shape.is_of_motion else fit.shape.unit / fit.scale


def _common_scales(plans: Sequence[Fit], judge: _Judge) -> dict[str, float]:
    """Return the scale that most plans of a kind share, as `_drawn_to` gives it, by kind."""
    scales: dict[str, float] = {}
    for kind in {fit.shape.scale for fit in plans}:
        own = [fit for fit in plans if fit.shape.scale == kind]
        drawn = np.log([_drawn_to(fit) for fit in own])
        room = np.array([WITHIN * fit.scale_error(judge.deviation) / fit.scale for fit in own])
        agree = np.abs(drawn[:, None] - drawn) <= room[:, None] + room
        names = np.array([id(fit.shape) for fit in own])
        votes = [len(set(names[row])) for row in agree]
        best = int(np.argmax(votes))
        if votes[best] >= MANY and 2 * votes[best] > len(set(names)):
            weights = 1 / np.maximum(room[agree[best]], 1e-6) ** 2
            scales[kind] = float(np.exp((drawn[agree[best]] * weights).sum() / weights.sum()))
    return scales


class _Judge(Record, dict=True):
    lines: Lines
    shapes: int
    deviation: float
    scales: Mapping[str, float]
    labels: Labels

    def for_it(self, fit: Fit) -> float:
        """Return the evidence for a fit (logarithm of odds), before it is corrected for chance."""
        corners, square = fit.corners_met(2 * self.lines.reach)
        closing = len(fit.explained) - (len(corners) - 1)
        of_scale = self._of_scale(fit)
        return (
            _of_corners(corners, WITHIN * self.deviation, of_scale > 0)
            + CLOSED * max(closing, 0)
            - LEFT_OUT * fit.missing(SEEN * self.lines.error)
            - square / (2 * self.deviation**2)
            + of_scale
        )

    def _of_scale(self, fit: Fit) -> float:
        """Return the evidence of the scale: 0 if none is common."""
        if fit.shape.scale not in self.scales:
            return 0.0
        off = abs(np.log(_drawn_to(fit) / self.scales[fit.shape.scale]))
        room = max(WITHIN * fit.scale_error(self.deviation) / fit.scale, 1e-4)
        return float(np.log(ANYWHERE / (2 * room))) if off <= room else OTHER_SCALE

    @cached_property
    def _long(self) -> tuple[np.ndarray, np.ndarray]:
        """The numbers of all pairs of lines with a common end that are both long enough to have a direction."""
        first, second = self.lines.touching
        length = np.abs(self.lines.vectors)
        long = np.minimum(length[first], length[second]) > LONG * self.lines.error
        count = len(self.lines.ends)
        return first[long] % count, second[long] % count

    def by_chance(self, taken: Collection[int], left: int) -> float:
        """Return the logarithm of the number of possible placements: free pairs of meeting lines times plans left."""
        free = np.zeros(len(self.lines.ends), dtype=bool)
        free[self.lines.without(taken)] = True
        first, second = self._long
        return float(np.log(max((free[first] & free[second]).sum() * left, 1)))

    def decided(self, every: Sequence[Fit]) -> tuple[list[Fit], list[tuple[Fit, ...]]]:
        """Return the certain fits, the best first, and the groups of fits at places where several plans fit.

        Each certain fit leaves fewer lines and plans, so the threshold against chance becomes lower.
        """
        odds = {id(fit): self.for_it(fit) for fit in every}
        # Labels support a figure, but are not enough alone.
        likely = [fit for fit in every if odds[id(fit)] >= BY_CHANCE]
        odds |= {id(fit): odds[id(fit)] + self.labels.speak_for(fit) for fit in likely}
        for at, positions in self.labels.owned(likely, self.lines.ends).items():
            if len(positions) == 1:
                odds[id(likely[at])] += TITLE if likely[at].shape.position in positions else -TITLE
        shaped = [fit for fit in likely if len(fit.corners_met(2 * self.lines.reach)[0]) >= FEWEST_CORNERS]
        order = sorted(shaped, key=lambda fit: -odds[id(fit)])
        by_line: dict[int, list[Fit]] = {}
        for fit in order:
            for line in fit.used:
                by_line.setdefault(line, []).append(fit)
        plans: list[Fit] = []
        doubtful: list[tuple[Fit, ...]] = []
        placed: set[int] = set()
        taken: set[int] = set()
        before = -1
        while len(taken) > before:
            before = len(taken)
            least = self.by_chance(taken, self.shapes - len(placed)) + BY_CHANCE
            for fit in order:
                if odds[id(fit)] < least:
                    break
                if id(fit.shape) in placed or len(fit.used & taken) > SHARED * len(fit.used):
                    continue
                others = {id(rival): rival for line in fit.used for rival in by_line[line]}.values()
                rivals = [
                    rival
                    for rival in others
                    if rival.shape is not fit.shape
                    and id(rival.shape) not in placed
                    and len(rival.used & fit.used) > SHARED * min(len(rival.used), len(fit.used))
                    and odds[id(rival)] > odds[id(fit)] - BEYOND_DOUBT
                ]
                taken |= fit.used
                if rivals:
                    doubtful.append((fit, *rivals))
                else:
                    placed.add(id(fit.shape))
                    plans.append(fit)
        return plans, doubtful


def _of_corners(corners: np.ndarray, width: float, scaled: bool) -> float:
    """Return the evidence that lines end at these corners [n] (mm), within a `width` (mm) in each direction.

    It is a logarithm of odds against chance. An end may lie anywhere around the nearest corner, within their distance.
    The first corner determines the place, the farthest one the scale. Corners on one line are not a figure: further
    corners on it count only at the common scale (`scaled`).
    """
    if len(corners) < FEWEST_CORNERS:
        return 0.0
    apart = np.abs(corners[:, None] - corners)
    reached, steps = apart[0].copy(), []
    left = np.ones(len(corners), dtype=bool)
    left[0] = False
    while left.any():
        following = int(np.where(left, reached, np.inf).argmin())
        steps.append(reached[following])
        left[following] = False
        reached = np.minimum(reached, apart[following])
    gains = np.maximum(np.log(np.array(steps) / width), 0.0)
    along = corners - corners[0]
    direction = along[np.abs(along).argmax()]
    off_line = np.abs((along * direction.conjugate()).imag) / np.abs(direction)
    on_line = off_line.max() < width and not scaled
    return float(gains.sum() if on_line else 2 * gains.sum() - gains.max())
