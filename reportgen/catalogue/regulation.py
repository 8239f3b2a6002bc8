"""The flywheel as any assignment of a machine with a crank may ask for it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Annotated

from reportgen.assignment.common import Check, Draft, Part
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import Interval, Ratio
from reportgen.catalogue.machine import Item, ratio_item
from reportgen.notation.expressions import Symbol
from reportgen.units import Given

Unevenness = Annotated[Given, Ratio(Interval(above=0, most=0.5))]


class Flywheel(Part):
    """How uneven the speed may be: δ = (ω_max − ω_min)/ω_m."""

    delta: Unevenness


def items(flywheel: Flywheel | None) -> tuple[Item, ...]:
    """δ among the given data, if a flywheel is asked for."""
    return () if flywheel is None else (ratio_item("unevenness", Symbol("δ", "ω"), flywheel.delta),)


def needs_loads(keys: Iterable[str]) -> Check:
    """A flywheel is asked for only where one of the parameters `keys` gives a mass or a load to even out."""
    known = tuple(keys)

    def check(draft: Draft) -> Iterator[Finding]:
        content = draft.raw.get("parameters")
        if not isinstance(content, dict) or content.get("flywheel") is None:
            return
        if not any(content.get(key) for key in known):
            where = ("parameters", "flywheel")
            yield Finding("flywheel-without-loads", where, at="key")

    return check
