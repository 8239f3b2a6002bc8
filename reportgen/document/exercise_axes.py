"""The axes that the steps of an exercise project on: one number for each line, in the text as in the figures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from reportgen.catalogue.plane_motion_centres import NEAR
from reportgen.figures import instant
from reportgen.ledger.instant.board import Axis, Step
from reportgen.ledger.instant.write import Worked
from reportgen.notation.expressions import Symbol
from reportgen.plane_motion.ways import parallel

COORDINATES = ("x", "y")


@dataclass(frozen=True)
class Axes:
    """The axes of all solutions of an exercise.

    Axes ξ on one line are one axis, whichever step uses it, and each has its η at the point of its first step.
    """

    solutions: Sequence[Worked]

    def symbol(self, step: Step, letter: str) -> Symbol:
        """The letter of a step's axis, with a number where ξ lies on several lines."""
        if not step.axes or step.axes[0].letter in COORDINATES:
            return Symbol(letter)
        return self._symbol(step.axes[0], letter)

    def drawn(self, accelerations: bool, scale: float) -> Iterator[instant.Axis]:
        """The axes ξ and η of the steps for velocities or for accelerations; `scale` is the mm of a metre."""
        letters: set[Symbol] = set()
        for step, axis in self._of(accelerations):
            symbol = self._symbol(axis, axis.letter)
            if axis.letter not in COORDINATES and symbol not in letters:
                letters.add(symbol)
                at = self._at(self._first(axis).point)
                along = [0.0, *self._on_it(step.body, axis.way, at)]
                ends = (scale * (at + reach * axis.way) for reach in (min(along), max(along)))
                yield instant.Axis(symbol, axis.way, *ends)

    def has_coordinates(self, accelerations: bool) -> bool:
        """Whether anything is projected on x or y."""
        return any(axis.letter in COORDINATES for _, axis in self._of(accelerations))

    def _on_it(self, body: int, way: complex, at: complex) -> Iterator[float]:
        """Where points of the body lie on an axis, which is to show beyond them."""
        for name in self.solutions[0].layout.members.get(body, ()):
            there = way.conjugate() * (self._at(name) - at)
            if abs(there.imag) < NEAR:
                yield there.real

    def _of(self, accelerations: bool | None = None) -> Iterator[tuple[Step, Axis]]:
        for worked in self.solutions:
            for step in worked.steps:
                if accelerations is None or step.of_accelerations == accelerations:
                    yield from ((step, axis) for axis in step.axes)

    def _at(self, point: str) -> complex:
        return self.solutions[0].layout.points[point]

    def _lines(self) -> list[Axis]:
        """One axis of each line of ξ."""
        found: list[Axis] = []
        for _, axis in self._of():
            if axis.letter not in COORDINATES and not any(self._same(axis, one) for one in found):
                found.append(axis)
        return found

    def _same(self, one: Axis, other: Axis) -> bool:
        """Whether the ξ of both lie on one line."""
        apart = self._at(other.point) - self._at(one.point)
        return parallel(one.along, other.along) and abs((one.along.conjugate() * apart).imag) < NEAR

    def _first(self, axis: Axis) -> Axis:
        return next((one for one in self._lines() if self._same(axis, one)), axis)

    def _symbol(self, axis: Axis, letter: str) -> Symbol:
        lines = self._lines()
        if axis.letter in COORDINATES or len(lines) == 1:
            return Symbol(letter)
        return Symbol(letter, str(1 + lines.index(self._first(axis))))
