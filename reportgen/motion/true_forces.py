"""Accelerations, inertia forces and reactions of the true motion, compared with those at constant speed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reportgen.base.units import figure_decimals
from reportgen.document import Table
from reportgen.document.tables import list_table
from reportgen.formula import Number, Symbol, ids, size
from reportgen.formula.calculation import ZERO
from reportgen.machine.analysis import Analysis, Position
from reportgen.motion.curves import motion_of
from reportgen.motion.true_motion import at_true_speeds, motion_in
from reportgen.report.context import ReportContext

WIDTHS = (36.0, 40.0, 40.0, 30.0)


def asks_forces(report: ReportContext) -> bool:
    """Return True if the forces of the true motion are requested."""
    motion = motion_in(report.analysis)
    return motion is not None and motion.asked.forces


def forces_table(report: ReportContext, key: str, caption: str, head: Sequence[str], k: Position) -> Table:
    """Return a table of values at a position, at constant speed and in the true motion, with their units."""
    motion = motion_of(report)
    true = at_true_speeds(report.analysis, motion.states[motion.main_state])
    return list_table(report.prose, key, caption, head, list(_rows(report, true, k)), WIDTHS)


def _rows(report: ReportContext, true: Analysis, k: Position) -> Iterator[Sequence[object]]:
    """Yield rows for the quantities of points, links, inertia and joints, as the report prints them for
    constant speed.
    """
    values = {id: course for id, course in _courses(report, true) if id in report.ledger}
    greatest: dict[str, float] = {}
    for id, course in values.items():
        kind = report.ledger[id].kind
        greatest[kind] = max(greatest.get(kind, 0.0), _greatest(course))
    for id, course in values.items():
        noise = ZERO * greatest[report.ledger[id].kind]
        yield _row(report, id, np.where(np.abs(course) > noise, course, 0.0), k)


def _courses(report: ReportContext, true: Analysis) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the ids of all quantities that depend on the acceleration, with the true values (SI) [N]."""
    for name, point in true.motion.points.items():
        yield ids.acceleration(name), np.abs(point.a)
    for number, link in true.motion.links.items():
        yield ids.signed("eps", number), link.epsilon
    for load in true.inertia:
        yield load.name, np.abs(load.force)
        yield ids.inertia_couple(load.link), np.abs(load.couple)
    entered_joints: set[frozenset[int]] = set()
    for name, reaction in true.forces.reactions.items():
        joint = frozenset(ids.links_of(name))
        if joint not in entered_joints and ids.of_force(name) in report.ledger:
            entered_joints.add(joint)
            yield ids.of_force(name), np.abs(reaction.force)


def _row(report: ReportContext, id: str, true: np.ndarray, k: Position) -> tuple[object, ...]:
    """Return a quantity with its value at constant speed and the true one of [N], with the decimals of the report.

    A value that is negligible at constant speed has the significant figures of its kind.
    """
    ledger = report.ledger
    how, signed = ledger[id].how, ledger[id].is_signed_rotation
    even, decimals = ledger.number(id, k, size=not signed), ledger.decimals[id]
    if decimals is None or not _greatest(ledger[id].values):
        decimals = figure_decimals(_greatest(true) / how.scale, how.digits) if how.decimals is None else how.decimals
    symbol: Symbol = ledger.symbol(id)
    there = float(true[k - 1]) / how.scale
    numbers = (Number(even.value, even.decimals), Number(there, decimals if there else None))
    return (symbol if signed else size(symbol), *numbers, ledger.units.get(how.unit, how.unit))


def _greatest(values: np.ndarray) -> float:
    return float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))
