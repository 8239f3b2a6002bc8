"""Interface by which a topic adds entries to the ledger of a machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from reportgen.base.records import Record
from reportgen.base.topics import HookModule
from reportgen.derivation.load_entries import EnterGuide, Statics
from reportgen.formula import Expression, Ref
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import Ledger
from reportgen.machine.analysis import Analysis, Machine

Changed = Mapping[str, Sequence[tuple[str, Expression]]]
"""Wrong definitions of quantities, by id, each with the name of the mistake that leads to it."""


def _enter_nothing(q: Calculation, analysis: Analysis) -> None:
    """Enter nothing: the default for a topic without such entries."""


def _not_worked_out(q: Calculation, analysis: Analysis, worked: Sequence[int]) -> None:
    """Enter nothing: the default for a topic without values at the worked positions."""


def _no_guide(statics: Statics, digits: str, link: int) -> None:
    """Enter nothing: the default for a topic without entries of sliders."""


def _not_reduced(q: Calculation, largest: float) -> Ref | None:
    return None


def _no_mistakes(ledger: Ledger, machine: Machine) -> Changed:
    return {}


class LedgerHooks(Record):
    """The entries of a topic, in the order in which they are made, and mistakes that marking looks for."""

    enter_guide: EnterGuide = _no_guide
    """Enters further quantities of a slider in its guide, from the digits of its reaction and its link."""
    enter_forces: Callable[[Calculation, Analysis, Sequence[int]], None] = _not_worked_out
    """Enters quantities that depend on the forces at the positions; the last argument are the worked positions."""
    enter_cycle: Callable[[Calculation, Analysis], None] = _enter_nothing
    """Enters quantities of the cycle as a whole."""
    enter_last: Callable[[Calculation, Analysis], None] = _enter_nothing
    """Enters quantities that depend on all other results."""
    reduced: Callable[[Calculation, float], Ref | None] = _not_reduced
    """Enters and returns the part of the reduced torque (N·m) that the topic adds; None if it adds none.

    The float is the largest torque (N·m), the reference size.
    """
    mistakes: Callable[[Ledger, Machine], Changed] = _no_mistakes
    """Returns the definitions that follow from common mistakes."""


LEDGER = HookModule("ledger", LedgerHooks)
