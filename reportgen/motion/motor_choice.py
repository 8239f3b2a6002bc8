"""The choice of a motor: the requirements of the steady motion, and each motor of the list with its checks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from reportgen.base.units import significant_decimals
from reportgen.document import Inline, Inlines, Table, Text, Value
from reportgen.document.tables import list_table
from reportgen.formula import Number
from reportgen.motion.motors import MotorChecks
from reportgen.motion.true_motion import motion_in
from reportgen.report.context import ReportContext

WIDTHS = (24.0, 22.0, 34.0, 34.0, 34.0, 14.0)
FIGURES = 4


def _checks(report: ReportContext) -> Sequence[MotorChecks]:
    motion = motion_in(report.analysis)
    return motion.motors(report.machine)


def has_motors(report: ReportContext) -> bool:
    """Return True if motors are given to choose from."""
    return bool(_checks(report))


def chosen_motor(report: ReportContext) -> Inlines:
    """Return the smallest motor that passes all checks, by name and power; () if there is none."""
    fitting = next((checked_motor for checked_motor in _checks(report) if checked_motor.fits), None)
    if fitting is None:
        return ()
    return Text(f"{fitting.motor.name}, "), Value(_typed(fitting.motor.power, "kW"))


def motor_list(report: ReportContext) -> Inlines:
    """Return the motors to choose from, with all their given data."""
    motion, words = motion_in(report.analysis), report.words["motors"]
    parts: list[Inline] = []
    for motor in motion.asked.motors:
        rpm = Number(float(f"{motor.speed * 30 / math.pi:.9g}"), None, report.ledger.units.get("rpm", "rpm"))
        parts += [Text("; ")] if parts else []
        parts += [Text(f"{motor.name} ("), Value(_typed(motor.power, "kW")), Text(", "), Value(rpm)]
        for key, torque in (("start", motor.start), ("breakdown", motor.breakdown)):
            parts += [
                Text(f", {words[key]} "),
                Value(Number(float(f"{torque:.9g}"), None, report.ledger.printed_unit("N·m"))),
            ]
        parts.append(Text(")"))
    return tuple(parts)


def demand_lines(report: ReportContext) -> list[str]:
    """Return the ids of the requirements for the motor, at the crank."""
    return report.known(["run.Mmean", "run.Meff", "run.Mmost", "run.Mres"])


def motors_table(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> Table:
    """Return a table of each motor with its torques at the crank and the result of each check."""
    return list_table(report.prose, key, caption, head, _rows(report), WIDTHS)


def _rows(report: ReportContext) -> Iterator[Sequence[object]]:
    words = report.words["motors"]

    def checked(torque: float, wanted: float) -> Inlines:
        return Value(_number(torque)), Text(" ≥ " if torque >= wanted else " < "), Value(_number(wanted))

    for checked_motor in _checks(report):
        yield (
            checked_motor.motor.name,
            _typed(checked_motor.motor.power),
            checked(checked_motor.rated, checked_motor.demand.effective),
            checked(checked_motor.start, checked_motor.demand.resistance),
            checked(checked_motor.breakdown, checked_motor.demand.most),
            words["fits" if checked_motor.fits else "fits_not"],
        )


def _typed(power: float, unit: str = "") -> Number:
    """Return a power (W) in kW, as it was typed."""
    return Number(float(f"{power / 1e3:.9g}"), None, unit)


def _number(value: float) -> Number:
    return Number(float(f"{value:.{FIGURES}g}"), max(significant_decimals(value, FIGURES), 0))


VALUES: Mapping[str, Callable[[ReportContext], Any]] = {
    "has_motors": has_motors,
    "chosen_motor": chosen_motor,
    "motor_list": motor_list,
    "demand_lines": demand_lines,
}
TABLES: Mapping[str, Callable[..., Any]] = {"run.motors": motors_table}
