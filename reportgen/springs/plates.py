"""Springs on the drawing sheets."""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.report.mechanism_figures import scheme
from reportgen.sheets.plate_sources import Drawn, Sources, grids
from reportgen.sheets.topic_plates import PlateHooks
from reportgen.springs.views import loads_over_cycle, spring_lines


def _springs(sources: Sources) -> Iterator[Drawn]:
    """Yield the machine with its springs, their loads over the cycle, and a table of their lengths."""
    if sources.report.machine.coils:
        over_cycle = loads_over_cycle(sources.small).scenes if sources.report.parts("spring-curves") else ()
        lengths = grids(sources.report, (spring_lines,), cycle=True)
        yield Drawn("springs", "scheme", (*scheme(sources.small).scenes, *over_cycle, *lengths))


HOOKS = PlateHooks(before_bodies=(_springs,))
