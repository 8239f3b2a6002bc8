"""Additions of a topic to the results of a machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from reportgen.base.records import Record
from reportgen.base.topics import HookModule
from reportgen.machine.analysis import Analysis

Entries = Mapping[str, Any]
"""Numbers (SI, radians), vectors of the plane as complex numbers, and tables of them, by name."""


def _nothing_at(analysis: Analysis, k: int, entry: dict[str, Any]) -> None:
    """Add nothing: the default for a topic without results at positions."""


def _nothing_besides(analysis: Analysis) -> Entries:
    return {}


class ResultHooks(Record):
    """The results of a topic: those added to the entry of the position with index k, and those without a position."""

    at_position: Callable[[Analysis, int, dict[str, Any]], None] = _nothing_at
    besides: Callable[[Analysis], Entries] = _nothing_besides


RESULTS = HookModule("results", ResultHooks)
