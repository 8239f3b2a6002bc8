"""Values of a file that place an end of a coil on the frame, and new values for an end that is pulled: `AnchorPull`.

No kind and no topic names its values here. A value is varied a little, and the ends of the machine's coils that have no
name show which of them it moves. Ends at named points are pulled as points. Values that change the linkage are left
out.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import numpy as np

from reportgen import catalogue
from reportgen.base.errors import Where
from reportgen.base.records import Record
from reportgen.base.units import measures
from reportgen.base.yaml_source import MappingNode, Source
from reportgen.machine.analysis import Machine
from reportgen.page.linkage_numbers import numbers
from reportgen.page.pulled_values import MOST_VALUES, TypedNumber, bounds, leaves, rounded, texts, varied_machine

UNIT = "mm"
"""A unit like those of the values that are examined: making a machine for each value of a file takes long."""
ALONG = 1e-6
"""Sine of the angle between the shifts of an end below which two values move it along one line."""


class AnchorValue(Record):
    """A value of a file that moves the end of a coil by `shift` (m) for a unit of it."""

    where: Where
    typed: TypedNumber
    low: float
    high: float
    shift: complex


class KnownAnchor(Record):
    """An end of a coil at a place (m) of the frame, and the one or two values that move it."""

    place: complex
    values: tuple[AnchorValue, ...] = ()

    def moved_by(self, value: AnchorValue) -> KnownAnchor:
        """Return the end with a further value, or the same if its values already move it along this line."""
        across = all(
            abs((old.shift.conjugate() * value.shift).imag) > ALONG * abs(old.shift * value.shift)
            for old in self.values
        )
        return KnownAnchor(self.place, (*self.values, value)) if across and len(self.values) < 2 else self


def anchors(machine: Machine) -> dict[str, complex]:
    """Return the places (m) of the frame without a name to which coils are attached, by names that no point has."""
    return {
        f"coil {coil.number} {index}": end.place
        for coil in machine.coils
        for index, end in enumerate(coil.ends, 1)
        if not end.name
    }


def known_anchors(source: Source, path: Path) -> Mapping[str, KnownAnchor]:
    """Return the ends of coils that values of a file move, by name, each with these values in the order of the file."""
    top, machine = source.top, catalogue.machine_of(source, path)
    data = top.find("parameters") if isinstance(top, MappingNode) else None
    if machine is None or data is None:
        return {}
    here = anchors(machine)
    known = {name: KnownAnchor(place) for name, place in here.items()}
    for where, scalar in list(leaves(data[1], ("parameters",)))[:MOST_VALUES] if known else ():
        typed = TypedNumber.of(scalar.text)
        if typed is None or not measures(typed.unit.strip(), UNIT):
            continue
        varied = varied_machine(source, path, (where, scalar), typed)
        if not varied or not np.array_equal(numbers(varied[0].linkage), numbers(machine.linkage)):
            continue
        for name, place in anchors(varied[0]).items():
            if name in known and place != here[name]:
                shift = (place - here[name]) / varied[1]
                known[name] = known[name].moved_by(AnchorValue(where, typed, *bounds(source, where, typed), shift))
    return {name: anchor for name, anchor in known.items() if anchor.values}


class AnchorPull(Record, dict=True):
    """The end of a coil that is pulled from its place `start` (m) of the frame, and the values that follow."""

    start: complex
    values: tuple[AnchorValue, ...]

    @cached_property
    def shifts(self) -> np.ndarray:
        """How far the end goes (m) for a unit of each value [values]."""
        return np.array([value.shift for value in self.values], dtype=np.complex128)

    def to(self, target: complex, guess: np.ndarray) -> np.ndarray:
        """Return the differences of the values [values] that bring the end to a place (m), or as near as they can."""
        missing = target - self.start
        equations = np.array([self.shifts.real, self.shifts.imag])
        return np.asarray(np.linalg.lstsq(equations, np.array([missing.real, missing.imag]))[0])

    def at(self, offsets: np.ndarray) -> complex:
        """Return the place of the end (m) for differences of the values [values]."""
        return self.start + complex(self.shifts @ offsets)

    def ways(self, offsets: np.ndarray) -> np.ndarray:
        """Return how far the end goes (m) for a unit of each value [values], the same everywhere."""
        return self.shifts

    def rounded(self, offsets: np.ndarray) -> np.ndarray:
        """Return the differences [values] of numbers in whole steps within their bounds."""
        return rounded(self.values, offsets)

    def texts(self, offsets: np.ndarray) -> list[tuple[Where, str]]:
        """Return the values as they are typed, in whole steps within their bounds; unchanged ones as they were."""
        return texts(self.values, offsets)
