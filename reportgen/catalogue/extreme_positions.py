"""Synthesize a crank-rocker or a slider-crank from its two extreme positions.

While the driven link goes one way, the crank turns through 180° + θ, while it returns, through 180° − θ; K is the
ratio of both. The chord C₁C₂ of the extreme places of the driven pin subtends the angle θ at the centre A of the crank,
so A is on a circle through C₁ and C₂, at whose centre the chord subtends 2θ. With β, the angle at the circle's centre
from the middle of the arc to A,

    AC₁ = 2ρ cos((β − θ)/2),  AC₂ = 2ρ cos((β + θ)/2),

crank = (AC₁ − AC₂)/2, coupler = (AC₁ + AC₂)/2. Source: inscribed angles and the law of sines.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.base.arrays import Flags, Floats
from reportgen.base.records import Record

SAMPLES = 2001
"""Places on an arc in a search."""
REFINEMENTS = 80
"""Steps of a search by golden section; each leaves 0.62 of the interval."""
GOLDEN = (math.sqrt(5) - 1) / 2
ON_CHORD = 1e-9
"""A place of A nearer to an end of its arc (rad) is the end itself: the arc cosine and the arc sine that give the place
have at least nine digits. At an end A is at C₂, crank and coupler are equal, and the mechanism folds up.
"""
NEAR = 1e-9
"""Two least transmission angles that differ by less (rad) are equal."""
BEYOND, BEFORE = 1, -1
"""Sides of the chord C₁C₂ on which A may be, seen from the fixed end of the rocker."""
SIDES = {"beyond": BEYOND, "before": BEFORE}


def crank_angle_between(K: float) -> float:
    """Return θ (rad), the angle between both extreme directions of the rod: π (K − 1)/(K + 1)."""
    return math.pi * (K - 1) / (K + 1)


class PivotPlace(Record):
    """A place of A: the side of the chord, and the angle β (rad) from the middle of its arc."""

    side: int
    along: float


@dataclass(frozen=True)
class ExtremePositions(ABC):
    """Wanted extreme positions of a mechanism with the ratio K > 1 of its strokes."""

    K: float

    @property
    def angle(self) -> float:
        """θ (rad)."""
        return crank_angle_between(self.K)

    @property
    @abstractmethod
    def chord(self) -> float:
        """Distance of both extreme places of the driven pin (m)."""

    @property
    @abstractmethod
    def sides(self) -> Sequence[int]:
        """The sides of the chord on which A may be."""

    @property
    def radius(self) -> float:
        """Radius ρ of the circle of A (m): half the chord over sin θ."""
        return self.chord / 2 / math.sin(self.angle)

    def crank(self, along: Floats) -> Floats:
        """Return the lengths of the crank (m) for places β."""
        return 2 * self.radius * math.sin(self.angle / 2) * np.sin(along / 2)

    def coupler(self, along: Floats) -> Floats:
        """Return the lengths of the coupler (m) for places β."""
        return 2 * self.radius * math.cos(self.angle / 2) * np.cos(along / 2)

    @abstractmethod
    def frame(self, side: int, along: Floats) -> Floats:
        """Return the length (m) that places A beside the driven link: the frame, or the offset of the guide."""

    @abstractmethod
    def works(self, side: int, along: Floats) -> Flags:
        """Return True for places β at which one assembly passes through both extreme positions."""

    @abstractmethod
    def transmission(self, side: int, along: Floats) -> Floats:
        """Return the least transmission angles over a turn (rad); nan where the crank does not turn."""

    @cached_property
    def grid(self) -> Floats:
        """Places β over the arc at whose points the chord subtends θ, without its ends."""
        return np.linspace(0.0, math.pi - self.angle, SAMPLES + 2)[1:-1]

    def interval(self, side: int) -> tuple[float, float] | None:
        """Return the least and the greatest β of mechanisms that work; None if there are none on this side."""
        grid = self.grid
        works = np.flatnonzero(self.works(side, grid))
        if not works.size:
            return None
        first, last = int(works[0]), int(works[-1])
        low = self._border(side, float(grid[first]), float(grid[first - 1]) if first else 0.0)
        end = math.pi - self.angle
        high = self._border(side, float(grid[last]), float(grid[last + 1]) if last + 1 < len(grid) else end)
        return low, high

    def _border(self, side: int, inside: float, outside: float) -> float:
        """Return the last β between both at which the mechanism works, by bisection."""
        for _ in range(REFINEMENTS):
            middle = (inside + outside) / 2
            if bool(self.works(side, np.array(middle))):
                inside = middle
            else:
                outside = middle
        return inside

    def frames(self) -> tuple[float, float] | None:
        """Return the least and the greatest frame (or offset) of mechanisms that work (m); None without any."""
        return self._extent(self.frame)

    def cranks(self) -> tuple[float, float] | None:
        """Return the least and the greatest crank of mechanisms that work (m); None without any."""
        return self._extent(lambda side, along: self.crank(along))

    def _extent(self, length: Callable[[int, Floats], Floats]) -> tuple[float, float] | None:
        values: list[float] = []
        for side in self.sides:
            if (ends := self.interval(side)) is not None:
                inside = self.grid[(self.grid > ends[0]) & (self.grid < ends[1])]
                values += [float(value) for value in length(side, np.array([ends[0], *inside, ends[1]]))]
        return (min(values), max(values)) if values else None

    def best(self, side: int) -> PivotPlace | None:
        """Return the place of A with the greatest least transmission angle; None if no mechanism works on this side.

        The arc is scanned; golden sections then narrow the interval about its best place.
        """
        if (ends := self.interval(side)) is None:
            return None
        grid = np.linspace(*ends, SAMPLES)
        top = int(np.nanargmax(self.transmission(side, grid)))
        low, high = float(grid[max(top - 1, 0)]), float(grid[min(top + 1, SAMPLES - 1)])
        for _ in range(REFINEMENTS):
            pair = np.array([high - GOLDEN * (high - low), low + GOLDEN * (high - low)])
            first, second = self.transmission(side, pair)
            if first < second:
                low = float(pair[0])
            else:
                high = float(pair[1])
        return PivotPlace(side, (low + high) / 2)

    def with_crank(self, length: float) -> list[PivotPlace]:
        """Return the places of A for a crank of this length (m) that give a mechanism which works."""
        sine = length / (2 * self.radius * math.sin(self.angle / 2))
        return self._working(PivotPlace(side, 2 * math.asin(sine)) for side in self.sides if sine <= 1)

    @abstractmethod
    def with_frame(self, length: float) -> list[PivotPlace]:
        """Return the places of A for a frame (or offset) of this length (m) that give a mechanism which works."""

    def places(
        self, crank: float | None = None, frame: float | None = None, side: int | None = None
    ) -> list[PivotPlace]:
        """Return the places of A that give a mechanism which works; [] without any.

        A length (m) selects them, of the crank or of the frame (or offset), else the best transmission on each side of
        the chord; with a `side` the other one is left out.
        """
        if crank is not None:
            every = self.with_crank(crank)
        elif frame is not None:
            every = self.with_frame(frame)
        else:
            every = [place for one in self.sides if (place := self.best(one)) is not None]
        return [place for place in every if side in (None, place.side)]

    def least_transmission(self, place: PivotPlace) -> float:
        """Return the least transmission angle of a solution (rad)."""
        return float(self.transmission(place.side, np.array(place.along)))

    def chosen(self, places: Sequence[PivotPlace]) -> PivotPlace:
        """Return the place with the greatest least transmission angle; of equal ones, the first."""
        greatest = max(map(self.least_transmission, places))
        return next(place for place in places if self.least_transmission(place) > greatest - NEAR)

    def _working(self, places: Iterable[PivotPlace]) -> list[PivotPlace]:
        end = math.pi - self.angle - ON_CHORD
        return [one for one in places if 0 < one.along < end and bool(self.works(one.side, np.array(one.along)))]


@dataclass(frozen=True)
class CrankRocker(ExtremePositions):
    """A crank-rocker wanted: the swing ψ of its rocker (rad) and the rocker's length c (m).

    The rocker turns about D = 0 between C₂ = c e^{i(π/2 + ψ/2)} and C₁ = c e^{i(π/2 − ψ/2)}, A is on the left.
    """

    swing: float
    rocker: float

    @property
    def sides(self) -> Sequence[int]:
        return BEYOND, BEFORE

    @property
    def chord(self) -> float:
        return 2 * self.rocker * math.sin(self.swing / 2)

    def centre(self, side: int) -> float:
        """Return the height of the circle's centre above D on the bisector of the swing (m)."""
        return self.rocker * math.cos(self.swing / 2) + side * self.radius * math.cos(self.angle)

    def frame(self, side: int, along: Floats) -> Floats:
        y, ρ = self.centre(side), self.radius
        return np.sqrt(y**2 + ρ**2 + 2 * side * y * ρ * np.cos(along))

    def works(self, side: int, along: Floats) -> Flags:
        """C₁ and C₂ have to be on one side of the line AD, or the links would overlap between them."""
        height = self.centre(side) + side * self.radius * np.cos(along)
        δ = np.arctan2(self.radius * np.sin(along), height)
        return (self.swing / 2 < δ) & (δ < math.pi - self.swing / 2)

    def transmission(self, side: int, along: Floats) -> Floats:
        """Its extremes are those with the crank in line with the frame."""
        a, b, c, d = self.crank(along), self.coupler(along), self.rocker, self.frame(side, along)
        with np.errstate(invalid="ignore"):
            near, far = (np.arccos((b**2 + c**2 - (d + s * a) ** 2) / (2 * b * c)) for s in (-1, 1))
        return np.minimum(near, math.pi - far)

    def with_frame(self, length: float) -> list[PivotPlace]:
        """Return the places of A at this distance from D (m) that give a mechanism which works.

        At the distance of the rocker's pin, A is at C₁ or C₂. About D as the centre of the circle, the distance does
        not select a place. Both give [].
        """
        places: list[PivotPlace] = []
        if math.isclose(length, self.rocker, rel_tol=ON_CHORD):
            return places
        for side in self.sides:
            y, ρ = self.centre(side), self.radius
            cosine = side * (length**2 - y**2 - ρ**2) / (2 * y * ρ) if y else math.inf
            if abs(cosine) < 1:
                places.append(PivotPlace(side, math.acos(cosine)))
        return self._working(places)


@dataclass(frozen=True)
class SliderCrank(ExtremePositions):
    """A slider-crank wanted: the stroke H of its slider (m)."""

    stroke: float

    @property
    def sides(self) -> Sequence[int]:
        """One side: the other one is its mirror image."""
        return (BEYOND,)

    @property
    def chord(self) -> float:
        return self.stroke

    def frame(self, side: int, along: Floats) -> Floats:
        return self.radius * (np.cos(along) + math.cos(self.angle))

    def works(self, side: int, along: Floats) -> Flags:
        """C₁ and C₂ have to be on one side of the normal of the guide through A."""
        return (self.angle < along) & (along < math.pi - self.angle)

    def interval(self, side: int) -> tuple[float, float] | None:
        """Return the ends of θ < β < π − θ, at which the crank hardly turns; None from K = 3 on, where θ = 90°."""
        low, high = self.angle + ON_CHORD, math.pi - self.angle - ON_CHORD
        return (low, high) if low < high else None

    def transmission(self, side: int, along: Floats) -> Floats:
        """It is least where the pin of the crank is farthest from the guide."""
        with np.errstate(invalid="ignore"):
            return np.arccos((self.frame(side, along) + self.crank(along)) / self.coupler(along))

    def with_frame(self, length: float) -> list[PivotPlace]:
        """Return the place of A for this offset (m), if it gives a mechanism that works."""
        cosine = length / self.radius - math.cos(self.angle)
        return self._working([PivotPlace(BEYOND, math.acos(cosine))] if abs(cosine) < 1 else [])
