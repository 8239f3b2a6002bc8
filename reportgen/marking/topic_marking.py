"""Hooks by which a topic adds to marking: errors of values that students find by a coarser rule than the key."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from reportgen.base.records import Record
from reportgen.base.topics import HookModule
from reportgen.formula.ledger import Ledger


def _no_errors(ledger: Ledger) -> Mapping[str, np.ndarray]:
    return {}


def _itself(ledger: Ledger, id: str) -> str:
    return id


class MarkHooks(Record):
    """Hooks for values that a student finds from the positions alone, whereas the key integrates or reads a curve."""

    errors_of_positions: Callable[[Ledger], Mapping[str, np.ndarray]] = _no_errors
    """Returns, by id, how far such values (SI) [N] are from those of the ledger."""
    integral_of: Callable[[Ledger, str], str] = _itself
    """Returns the id of the integral that a quantity is computed from, else its own id."""


MARKS = HookModule("marking", MarkHooks)
