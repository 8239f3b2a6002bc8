"""The flywheel as any assignment of a machine with loads over a cycle may ask for it."""

from __future__ import annotations

from typing import Annotated

from reportgen.assignment.common import Part
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
    return () if flywheel is None else (ratio_item("delta", Symbol("δ", "ω"), flywheel.delta),)


def with_chapter(outline: tuple[str, ...], flywheel: Flywheel | None) -> tuple[str, ...]:
    """The outline with the flywheel's chapter behind the driver's, if one is asked for and loads are known."""
    if flywheel is None or "crank" not in outline:
        return outline
    after = outline.index("crank") + 1
    return (*outline[:after], "flywheel", *outline[after:])
