"""Synthesize a crank-rocker or a slider-crank from its two extreme positions.

K is the ratio of the mean speeds of the return and the working stroke. While the driven link goes one way, the crank
turns through 180° + θ with θ = 180° (K − 1)/(K + 1). The two extreme places of the pin B are seen from the centre A of
the crank under θ, so A is on a circle through both.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

SAMPLES = 2001
REFINEMENTS = 60
GOLDEN = (math.sqrt(5) - 1) / 2


def crank_angle_between(K: float) -> float:
    """Return θ (rad), the angle between both extreme directions of the rod: π (K − 1)/(K + 1)."""
    return math.pi * (K - 1) / (K + 1)


@dataclass(frozen=True)
class FourBar:
    """Lengths (m) of a four-bar: crank, coupler, rocker and frame."""

    crank: float
    coupler: float
    rocker: float
    frame: float

    @property
    def crank_turns(self) -> bool:
        """True if the crank turns fully, by Grashof's condition with the crank as the shortest link."""
        lengths = sorted((self.crank, self.coupler, self.rocker, self.frame))
        return self.crank == lengths[0] and lengths[0] + lengths[3] < lengths[1] + lengths[2]

    @property
    def transmission(self) -> float:
        """The least transmission angle over a turn (rad), at one of the positions in line with the frame."""
        a, b, c, d = self.crank, self.coupler, self.rocker, self.frame
        cosines = ((b**2 + c**2 - (d + s * a) ** 2) / (2 * b * c) for s in (-1, 1))
        return min(min(angle, math.pi - angle) for angle in map(math.acos, cosines))


@dataclass(frozen=True)
class CrankRockerTask:
    """A crank-rocker wanted: K, swing ψ of the rocker (rad) and its length c (m).

    The rocker turns about D = 0 between c e^{i(π/2 ± ψ/2)}. A is on the circle through both places of B from which they
    are seen under θ. `along` (rad) is its place there: the angle about the circle's centre, anticlockwise from +y.
    """

    K: float
    swing: float
    rocker: float

    @property
    def angle(self) -> float:
        return crank_angle_between(self.K)

    @property
    def ends(self) -> tuple[complex, complex]:
        """Both extreme places of B, the left one first."""
        turn = complex(math.cos(self.swing / 2), math.sin(self.swing / 2))
        return 1j * self.rocker * turn, 1j * self.rocker / turn

    @property
    def radius(self) -> float:
        """Radius of the circle of A: half the chord over sin θ."""
        return self.rocker * math.sin(self.swing / 2) / math.sin(self.angle)

    @property
    def centre(self) -> complex:
        """Centre of the circle of A, which sees the chord under 2θ, on the side of D."""
        return 1j * (self.rocker * math.cos(self.swing / 2) - self.radius * math.cos(self.angle))

    def pivot(self, along: float) -> complex:
        """Return the place of A on its circle (m)."""
        return self.centre + 1j * cmath.rect(self.radius, along)

    def four_bar(self, along: float) -> FourBar | None:
        """Return the lengths with A at this place; None if the crank does not turn or the swing or K is another.

        On the arc between the places of B, they are seen under 180° − θ: there is no solution. On the other arc the
        swing between both places may contain A's side, with the links folded over: then the swing is another.
        """
        A = self.pivot(along)
        near, far = sorted(abs(end - A) for end in self.ends)
        made = FourBar((far - near) / 2, (far + near) / 2, self.rocker, abs(A))
        if near == far or not made.crank_turns:
            return None
        return made if self._returns(made) else None

    def _returns(self, made: FourBar) -> bool:
        """Return True if the linkage with these lengths has the swing and the K of the task."""
        a, b, c, d = made.crank, made.coupler, made.rocker, made.frame
        rocker, crank = (
            [math.acos((d**2 + side**2 - other**2) / (2 * d * side)) for side, other in pairs]
            for pairs in (((c, b + a), (c, b - a)), ((b + a, c), (b - a, c)))
        )
        swing, between = abs(rocker[0] - rocker[1]), abs(crank[0] - crank[1])
        return math.isclose(swing, self.swing, abs_tol=1e-9) and math.isclose(between, self.angle, abs_tol=1e-9)

    def best(self) -> tuple[float, FourBar] | None:
        """Return the place of A with the greatest least transmission angle, and the lengths; None without a solution.

        The whole circle is scanned; the search then narrows the interval about its best place by golden sections.
        """
        grid = np.linspace(0, 2 * math.pi, SAMPLES)

        def quality(along: float) -> float:
            made = self.four_bar(along)
            return -1.0 if made is None else made.transmission

        values = [quality(float(along)) for along in grid]
        top = int(np.argmax(values))
        if values[top] < 0:
            return None
        step = float(grid[1])
        low, high = float(grid[top]) - step, float(grid[top]) + step
        for _ in range(REFINEMENTS):
            first, second = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            if quality(first) < quality(second):
                low = first
            else:
                high = second
        along = max((float(grid[top]), (low + high) / 2), key=quality)
        made = self.four_bar(along)
        return None if made is None else (along, made)


@dataclass(frozen=True)
class SliderCrank:
    """Lengths (m) of a slider-crank: crank, rod and offset of the guide from the centre of the crank."""

    crank: float
    rod: float
    offset: float

    @property
    def crank_turns(self) -> bool:
        return self.rod > self.crank + self.offset

    @property
    def transmission(self) -> float:
        """The least transmission angle (rad), where the pin of the crank is farthest from the guide."""
        return math.acos((self.crank + self.offset) / self.rod)

    @property
    def stroke(self) -> float:
        L, R, e = self.rod, self.crank, self.offset
        return math.sqrt((L + R) ** 2 - e**2) - math.sqrt((L - R) ** 2 - e**2)


def slider_crank(K: float, stroke: float, offset: float) -> SliderCrank | None:
    """Return the slider-crank with this K > 1, stroke H and offset e > 0 (m); None if no crank turns.

    Both extreme places of B are seen from A under θ: with the distances l + r and l − r the triangle has the area
    H e/2 = (l² − r²) sin θ/2, and H² = (l + r)² + (l − r)² − 2 (l² − r²) cos θ.
    """
    θ = crank_angle_between(K)
    product = stroke * offset / math.sin(θ)
    squares = stroke**2 + 2 * product * math.cos(θ)
    if squares < 2 * product:
        return None
    total, difference = math.sqrt(squares + 2 * product), math.sqrt(squares - 2 * product)
    # (l + r) and (l − r) have this sum 2l and this difference 2r.
    made = SliderCrank(difference / 2, total / 2, offset)
    if not made.crank_turns or not math.isclose(made.stroke, stroke, rel_tol=1e-9):
        return None
    return made
