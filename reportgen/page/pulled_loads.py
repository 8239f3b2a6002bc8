"""Values of a file that give a load of constant size, and its direction, and new values for a tip that is pulled.

No kind names its values here. A value is varied a little, and the forces over the cycle show whether they become larger
or turn. Values that change the linkage, too, are left out.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from pathlib import Path

import numpy as np

from reportgen import catalogue
from reportgen.base.arrays import Complexes
from reportgen.base.errors import Where
from reportgen.base.records import Record
from reportgen.base.units import measures
from reportgen.base.yaml_source import MappingNode, Source
from reportgen.machine.analysis import Machine, motion_at
from reportgen.machine.kinematics import Motion
from reportgen.machine.loads import Applied
from reportgen.page.linkage_numbers import numbers
from reportgen.page.pulled_values import MOST_VALUES, TypedNumber, bounds, leaves, rounded, texts, varied_machine

TIMES = 72
"""Number of places of the cycle at which forces are compared."""
UNITS = "N", "deg"
"""Units like those of the values that are examined: making a machine for each value of a file takes long."""
SAME = 1e-6
"""Relative difference below which two forces are equal."""


class LoadValue(Record):
    """A value of a file on which a load depends: its size in proportion, or with `turn` (rad per unit) its angle."""

    where: Where
    typed: TypedNumber
    low: float
    high: float
    turn: float = 0.0


def load_values(source: Source, path: Path) -> dict[str, tuple[LoadValue, ...]]:
    """Return the values of each force of constant size, by its name: one for its size, one for its angle.

    Forces without such values are left out. Of several values for the same, the first one counts.
    """
    top, machine = source.top, catalogue.machine_of(source, path)
    data = top.find("parameters") if isinstance(top, MappingNode) else None
    if machine is None or data is None:
        return {}
    angles = machine.cycle_angles
    if not machine.instants:
        angles = np.linspace(0.0, machine.turns * 2 * np.pi, TIMES * machine.turns, endpoint=False)
    try:
        motion = motion_at(machine, angles)
    except ValueError:
        return {}
    forces = {name: force for name, force in _forces(machine, angles, motion) if _steady(force)}
    values: dict[str, list[LoadValue]] = {name: [] for name in forces}
    for where, scalar in list(leaves(data[1], ("parameters",)))[:MOST_VALUES] if forces else ():
        typed = TypedNumber.of(scalar.text)
        if typed is None or not any(measures(typed.unit.strip(), like) for like in UNITS):
            continue
        varied = varied_machine(source, path, (where, scalar), typed)
        if not varied or not np.array_equal(numbers(varied[0].linkage), numbers(machine.linkage)):
            continue
        for name, force in _forces(varied[0], angles, motion):
            of_load = values.get(name)
            turn = None if of_load is None else _turn(forces[name], force, typed, varied[1])
            if of_load is not None and turn is not None and all(bool(value.turn) != bool(turn) for value in of_load):
                of_load.append(LoadValue(where, typed, *bounds(source, where, typed), turn))
    return {name: tuple(of_load) for name, of_load in values.items() if of_load}


def _forces(machine: Machine, angles: np.ndarray, motion: Motion) -> Iterator[tuple[str, Complexes]]:
    """Yield the forces [N] but those of springs, which follow the motion."""
    for load in machine.applied:
        if load.law.coil is None:
            yield load.name, load.load(angles, motion).force


def _steady(force: Complexes) -> bool:
    """Return True if a force [N] has one size wherever it acts."""
    sizes = np.abs(force)
    greatest = float(np.nanmax(sizes, initial=0.0))
    acting = sizes > SAME * greatest
    return greatest > 0 and bool((sizes[acting] > (1 - SAME) * greatest).all())


def _turn(before: Complexes, after: Complexes, typed: TypedNumber, by: float) -> float | None:
    """Return by how much (rad) a force [N] turns for a unit of a value, 0 if it grows in proportion; else None."""
    acting = np.abs(before) > 0
    factor = complex(np.vdot(before[acting], after[acting]) / np.vdot(before[acting], before[acting]))
    if np.abs(after - factor * before).max() > SAME * np.abs(before).max() or abs(factor - 1) < SAME:
        return None
    if abs(abs(factor) - 1) < SAME:
        return math.atan2(factor.imag, factor.real) / by
    grown = typed.number and abs(factor - (1 + by / typed.number)) < SAME and not typed.over
    return 0.0 if grown else None


class LoadPull(Record):
    """The arrow of a load that is pulled by its tip, and the values that follow.

    The arrow begins at `start` (m) with the `force` (N) there; `scale` is the force (N) of a metre of it.
    """

    start: complex
    force: complex
    scale: float
    values: tuple[LoadValue, ...]

    @classmethod
    def of(
        cls, load: Applied, known: Collection[LoadValue], place: tuple[np.ndarray, Motion], scale: float
    ) -> LoadPull:
        """Return the pull of a load at a place of the cycle by `known` values; none follow where it does not act."""
        acting = load.load(*place)
        force = complex(acting.force[0])
        return cls(complex(acting.point[0]), force, scale, tuple(known) if abs(force) > 0 else ())

    def to(self, target: complex, guess: np.ndarray) -> np.ndarray:
        """Return the differences of the values [values] that bring the tip to a place (m), or as near as they can."""
        share = (target - self.start) * self.scale / self.force
        if not abs(share):
            return guess
        # Along its line only, the arrow can change its sense; what can turn keeps it.
        size, angle = (
            (abs(share), math.atan2(share.imag, share.real))
            if any(value.turn for value in self.values)
            else (share.real, 0.0)
        )
        return np.array(
            [
                _nearest(value, angle / value.turn) if value.turn else value.typed.number * (size - 1)
                for value in self.values
            ]
        )

    def at(self, offsets: np.ndarray) -> complex:
        """Return the place of the tip (m) for differences of the values [values]."""
        factor = 1 + 0j
        for value, by in zip(self.values, offsets.tolist(), strict=True):
            factor *= complex(math.cos(value.turn * by), math.sin(value.turn * by))
            factor *= 1 if value.turn else 1 + by / value.typed.number
        return self.start + self.force * factor / self.scale

    def rounded(self, offsets: np.ndarray) -> np.ndarray:
        """Return the differences [values] of numbers in whole steps within their bounds."""
        return rounded(self.values, offsets)

    def texts(self, offsets: np.ndarray) -> list[tuple[Where, str]]:
        """Return the values as they are typed, in whole steps within their bounds; unchanged ones as they were."""
        return texts(self.values, offsets)


def _nearest(value: LoadValue, by: float) -> float:
    """Return the difference of an angle, or that of the same direction a turn from it if only that is in bounds."""
    whole = 2 * math.pi / abs(value.turn)
    inside = (
        by + turns * whole for turns in (0, 1, -1) if value.low <= value.typed.number + by + turns * whole <= value.high
    )
    return next(inside, by)
