"""Accelerations, inertia forces and reactions of the true motion, beside those at constant speed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from reportgen.formula import Number, Symbol, ids, size
from reportgen.machine.analysis import Analysis, Position
from reportgen.machine.true_motion import at_true_speeds
from reportgen.report import Table
from reportgen.report.report import Report
from reportgen.report.running_curves import motion_of
from reportgen.report.tables import list_table

WIDTHS = (36.0, 40.0, 40.0, 30.0)


def asks_forces(report: Report) -> bool:
    """Whether the forces of the true motion are asked for."""
    motion = report.case.true_motion
    return motion is not None and motion.asked.forces


def forces_table(report: Report, key: str, caption: str, head: Sequence[str], k: Position) -> Table:
    """What each is at a position at constant speed, and in the true motion, with its unit."""
    motion = motion_of(report)
    true = at_true_speeds(report.analysis, motion.states[motion.shown])
    return list_table(report, key, caption, head, list(_rows(report, true, k)), WIDTHS)


def _rows(report: Report, true: Analysis, k: Position) -> Iterator[Sequence[object]]:
    """Of points, links, inertia and joints what the report has at constant speed, which is as it is written there."""
    at = k - 1
    for name, point in true.motion.points.items():
        yield from _row(report, ids.acceleration(name), abs(point.a[at]), k)
    for number, link in true.motion.links.items():
        yield from _row(report, ids.signed("eps", number), float(link.epsilon[at]), k)
    for load in true.inertia:
        yield from _row(report, load.name, abs(load.force[at]), k)
        yield from _row(report, ids.inertia_couple(load.link), abs(float(load.couple[at])), k)
    shown: set[frozenset[int]] = set()
    for name, reaction in true.forces.reactions.items():
        joint = frozenset(ids.links_of(name))
        if joint not in shown and ids.of_force(name) in report.ledger:
            shown.add(joint)
            yield from _row(report, ids.of_force(name), abs(reaction.force[at]), k)


def _row(report: Report, id: str, true: float, k: Position) -> Iterator[tuple[object, ...]]:
    """A quantity with its value at constant speed and the true one, in the decimals that the report has for it."""
    ledger = report.ledger
    if id not in ledger:
        return
    how, signed = ledger[id].how, ledger[id].is_signed_rotation
    even = ledger.number(id, k, size=not signed)
    unit = ledger.units.get(how.unit, how.unit)
    symbol: Symbol = ledger.symbol(id)
    shown = (Number(even.value, even.decimals), Number(true / how.scale, even.decimals))
    yield (symbol if signed else size(symbol), *shown, unit)
