"""Where a pulled point leaves a machine that assembles and runs through its whole travel: `region`.

The machine of each place is checked as a file is. Places are those of values in equal steps, so that each region is
bounded by lines along which one value is constant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from reportgen.base.arrays import Complexes, Flags
from reportgen.catalogue import assembly_checks
from reportgen.catalogue.assembly_checks import WHOLE_TURN, DriverTravel
from reportgen.machine import Linkage
from reportgen.machine.analysis import Machine
from reportgen.page.pulled_values import Pull, place_of

REACH = 0.35
"""Distance from the point to the edge of the region, as a share of the drawing's larger side."""
FINER_LINE = 4
"""Factor by which a line has more steps than a side of an area."""
LEAST = 0.1
"""Least share of a value that a region shows."""


@dataclass(frozen=True)
class Requirement:
    """What a machine must do: go through its `travel`, or assemble at single `places` of the driver (rad, or m)."""

    travel: DriverTravel = WHOLE_TURN
    places: tuple[float, ...] = ()

    @classmethod
    def of(cls, machine: Machine) -> Requirement:
        """Return what the checks require of a machine."""
        if machine.instants:
            return cls(places=tuple(map(float, machine.angles(machine.cycle_angles))))
        if machine.span:
            ends = machine.angles(np.array([0.0, 2 * np.pi]))
            return cls(DriverTravel(float(ends[0]), float(ends[1]), turning=False))
        return cls()

    def met(self, linkage: Linkage, turning: bool) -> bool:
        """Return True if a linkage does that."""
        try:
            if self.places:
                return next(assembly_checks.at_instants(linkage, np.array(self.places), turning), None) is None
            return assembly_checks.goes_through(linkage, self.travel)
        except ValueError:
            return False


def region(
    pull: Pull, required: Requirement, reach: float, count: int, going: Callable[[], bool]
) -> list[Complexes] | None:
    """Return the outlines [corners] (m) of the places that are possible, in strips; of one value, the lines along them.

    The region extends by `reach` (m) about the point in `count` steps of each value. Return None as soon as `going` is
    no longer true.
    """
    ways = np.abs(pull.ways(np.zeros(len(pull.values))))
    axes = []
    for value, far in zip(pull.values, ways.tolist(), strict=True):
        half = min(reach / far, max(abs(value.typed.number) * (1 - LEAST), reach / far * LEAST))
        low, high = max(-half, value.low - value.typed.number), min(reach / far, value.high - value.typed.number)
        steps = count * (FINER_LINE if len(pull.values) == 1 else 1)
        axes.append(np.linspace(low, high, steps + 1))
    places = np.full((len(axes[0]), *(len(axis) for axis in axes[1:])), complex(np.nan, np.nan))
    for index in np.ndindex(places.shape):
        if not going():
            return None
        offsets = np.array([axis[step] for axis, step in zip(axes, index, strict=True)])
        linkage = pull.made(offsets)
        if required.met(linkage, required.travel.turning):
            places[index] = place_of(linkage, pull.point, pull.driver)
    strips = _lines if len(axes) == 1 else _strips
    return list(strips(places))


def _lines(places: Complexes) -> Iterator[Complexes]:
    """Yield the unbroken lines of places [N], nan between them."""
    for first, last in _runs(np.isfinite(places)):
        yield places[first:last]


def _strips(places: Complexes) -> Iterator[Complexes]:
    """Yield the outlines of whole quadrangles between places [N, M], those beside each other as one."""
    whole = np.isfinite(places)
    quadrangles = whole[:-1, :-1] & whole[1:, :-1] & whole[:-1, 1:] & whole[1:, 1:]
    for row, line in enumerate(quadrangles):
        for first, last in _runs(line):
            yield np.concatenate((places[row, first : last + 1], places[row + 1, first : last + 1][::-1]))


def _runs(flags: Flags) -> Iterator[tuple[int, int]]:
    """Yield start and end of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False]))))
    yield from ((int(first), int(last)) for first, last in edges.reshape(-1, 2))
