"""The solver against the closed form: milliseconds for the same positions, in one warm process.

`python -m tests.bench.solving ENGINE MACHINE POSITIONS FEW` prints the medians as JSON: of the engine at so many
positions, and of the machine at a few without and with friction in its joints.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

from reportgen import api, catalogue
from reportgen.base.records import replace
from reportgen.friction.joints import Friction
from reportgen.friction.joints import with_friction as forces_with_friction
from reportgen.machine import joints
from reportgen.machine.analysis import Machine, analyse, motion_at
from reportgen.machine.gas_pressure import StrokeIndicator

from .closed_form import Cylinder, Engine, solve

ROUNDS = 25
RADIUS = 0.002
"""Of the friction circle of every pin (m)."""


def machine(path: Path) -> tuple[Machine, Engine]:
    """An engine's assignment for the solver and, in plain numbers, for the closed form.

    Raises `TypeError` for an indicator diagram over the crank's angle, which the closed form does not read.
    """
    assignment = api.load(path)
    built: Machine = catalogue.module(assignment.kind).machine(assignment)
    given, table, q = assignment.parameters, built.pistons[0].indicator, built.calculation
    if not isinstance(table, StrokeIndicator):
        raise TypeError("the closed form reads an indicator diagram by stroke")
    cylinders = tuple(
        Cylinder(offset, piston.phase, q.si(f"m.{piston.rod}"), q.si(f"J.{piston.rod}"), q.si(f"m.{piston.link}"))
        for piston, offset in zip(built.pistons, (0.0, given.crank_angle.si), strict=True)
    )
    return built, Engine(
        radius=q.si("R"),
        rod=q.si("L"),
        share=given.s.si,
        area=built.pistons[0].area,
        gravity=given.g.si,
        start=built.start,
        omega=built.turn * built.speed,
        fractions=table.fractions,
        rows=table.rows,
        cylinders=cylinders,
    )


def compare(path: Path, positions: int, rounds: int = ROUNDS) -> dict[str, float]:
    """Medians in ms of the solver and of the closed form, run in turns over one cycle of `positions`."""
    built, engine = machine(path)
    angles = np.arange(positions, dtype=np.float64) * (2 * np.pi * built.turns / positions)
    tasks: dict[str, Callable[[], Any]] = {
        "solver": lambda: analyse(built, angles),
        "motion": lambda: motion_at(built, angles),
        "closed form": lambda: solve(engine, angles),
    }
    return _medians(tasks, rounds)


def with_friction(path: Path, positions: int, rounds: int = ROUNDS) -> dict[str, float]:
    """Medians in ms of the solver without friction and with friction in every joint of a machine."""
    assignment = api.load(path)
    bare: Machine = catalogue.module(assignment.kind).machine(assignment)
    angles = np.arange(positions, dtype=np.float64) * (2 * np.pi * bare.turns / positions)
    listed = joints(bare.linkage)
    circles = {joint.point: RADIUS for joint in listed if joint.kind == "R"}
    friction = Friction(circles, {joint.links[1]: 0.1 for joint in listed if joint.kind == "P"})
    rubbing = replace(bare, topics={**bare.topics, "friction": friction})
    tasks = {"without": lambda: analyse(bare, angles), "with": lambda: forces_with_friction(analyse(rubbing, angles))}
    return _medians(tasks, rounds)


def _medians(tasks: Mapping[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Medians in ms of tasks run in turns."""
    taken: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(rounds):
        for name, task in tasks.items():
            begun = perf_counter()
            task()
            taken[name].append(1e3 * (perf_counter() - begun))
    return {name: median(times) for name, times in taken.items()}


if __name__ == "__main__":
    engine, eight_links, positions, few = sys.argv[1:]
    rubbing = with_friction(Path(eight_links), int(few))
    json.dump(compare(Path(engine), int(positions)) | rubbing, sys.stdout)
