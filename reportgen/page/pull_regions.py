"""Where a pulled point leaves a machine that assembles, runs through its whole travel and passes the checks: `region`.

Places are those of values in equal steps, so that each region is bounded by lines along which one value is constant.
Whether the linkage runs is found at each place. The checks of the whole file are slow: they are made in steps of
`SPARSE` places, and between those only where they differ.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from itertools import pairwise, product
from pathlib import Path
from typing import Protocol

import numpy as np

from reportgen import catalogue
from reportgen.base.arrays import Complexes, Flags
from reportgen.base.errors import ReportgenError, Where
from reportgen.base.records import Record, replace
from reportgen.base.yaml_source import Source
from reportgen.catalogue import assembly_checks
from reportgen.catalogue.assembly_checks import WHOLE_TURN, DriverTravel
from reportgen.machine import Linkage
from reportgen.machine.analysis import Machine
from reportgen.page.pulled_values import Pull, Stepped, place_of, with_texts

REACH = 0.35
"""Distance from the point to the edge of the region, as a share of the drawing's larger side."""
FINER_LINE = 4
"""Factor by which a line has more steps than a side of an area."""
LEAST = 0.1
"""Least share of a value that a region shows."""
SPARSE = 3
"""Steps between the places at which the whole file is checked first."""


class Requirement(Record):
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


class PulledPlace(Protocol):
    """A pulled point or end of a coil, whose place follows values of a file."""

    @property
    def values(self) -> Sequence[Stepped]: ...
    def at(self, offsets: np.ndarray) -> complex: ...
    def ways(self, offsets: np.ndarray) -> np.ndarray: ...


class FileChecks(Record, dict=True):
    """The checks of a file for other values of a pull; faults of the file as it is are ignored."""

    source: Source
    path: Path
    pull: PulledPlace

    def met(self, offsets: np.ndarray) -> bool:
        """Return True if values that differ by so much [values] cause no fault."""
        try:
            return self._faults(offsets) <= self._before
        except (ReportgenError, ArithmeticError, ValueError, np.linalg.LinAlgError):
            return False

    @cached_property
    def _before(self) -> set[tuple[str, Where]]:
        return self._faults(np.zeros(len(self.pull.values)))

    def _faults(self, offsets: np.ndarray) -> set[tuple[str, Where]]:
        assert self.source.top is not None, "a pulled point has a file"
        moved = [
            (value.where, value.typed.unrounded(value.typed.number + by))
            for value, by in zip(self.pull.values, offsets.tolist(), strict=True)
        ]
        changed = replace(self.source, top=with_texts(self.source.top, moved))
        return {(fault.code, fault.where) for fault in catalogue.assess(changed, self.path)[1]}


def region(
    pull: PulledPlace,
    required: Requirement,
    reach: float,
    count: int,
    going: Callable[[], bool],
    checks: FileChecks | None = None,
) -> list[Complexes] | None:
    """Return the outlines [corners] (m) of the places that are possible, in strips; of one value, the lines along them.

    The region extends by `reach` (m) about the point in `count` steps of each value. Return None as soon as `going` is
    no longer true.
    """
    ways = np.abs(pull.ways(np.zeros(len(pull.values))))
    axes = []
    for value, far in zip(pull.values, ways.tolist(), strict=True):
        half = reach / far
        if isinstance(pull, Pull):
            # Lengths stay positive; the coordinates of an end of a coil may change their signs.
            half = min(half, max(abs(value.typed.number) * (1 - LEAST), half * LEAST))
        low, high = max(-half, value.low - value.typed.number), min(reach / far, value.high - value.typed.number)
        steps = count * (FINER_LINE if len(pull.values) == 1 else 1)
        axes.append(np.linspace(low, high, steps + 1))
    places = np.full((len(axes[0]), *(len(axis) for axis in axes[1:])), complex(np.nan, np.nan))

    def offsets(index: tuple[int, ...]) -> np.ndarray:
        return np.array([axis[step] for axis, step in zip(axes, index, strict=True)])

    for index in np.ndindex(places.shape):
        if not going():
            return None
        places[index] = _place(pull, offsets(index), required)
    if checks is not None:
        met = _filtered(np.isfinite(places), lambda index: going() and checks.met(offsets(index)))
        if not going():
            return None
        places[~met] = complex(np.nan, np.nan)
    strips = _lines if len(axes) == 1 else _strips
    return list(strips(places))


def _place(pull: PulledPlace, offsets: np.ndarray, required: Requirement) -> complex:
    """Return the place (m) of what is pulled for values that differ by so much [values]; nan if no machine runs then.

    The end of a coil on the frame leaves the linkage as it is.
    """
    if not isinstance(pull, Pull):
        return pull.at(offsets)
    linkage = pull.made(offsets)
    if not required.met(linkage, required.travel.turning):
        return complex(np.nan, np.nan)
    return place_of(linkage, pull.point, pull.driver)


def _filtered(flags: Flags, check: Callable[[tuple[int, ...]], bool]) -> Flags:
    """Return the flags [N] or [N, M] that a slow check of their places leaves True.

    Where the True corners of a block of `SPARSE` steps agree, the places in the block are not checked.
    """
    passed: dict[tuple[int, ...], bool] = {}

    def passes(index: tuple[int, ...]) -> bool:
        if index not in passed:
            passed[index] = check(index)
        return passed[index]

    met = flags.copy()
    axes = [pairwise([*range(0, size - 1, SPARSE), size - 1]) for size in flags.shape]
    for block in product(*axes):
        corners = {passes(corner) for corner in product(*block) if flags[corner]}
        for index in product(*(range(first, last + 1) for first, last in block)):
            if flags[index] and (index in passed or len(corners) != 1):
                met[index] = passes(index)
            elif flags[index]:
                met[index] = all(corners)
    return met


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
