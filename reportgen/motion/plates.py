"""The true motion on the drawing sheets."""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.motion.curves import characteristic, sheet
from reportgen.motion.true_motion import motion_in
from reportgen.sheets.plate_sources import Drawn, Sources
from reportgen.sheets.topic_plates import PlateHooks


def _true_motion(sources: Sources) -> Iterator[Drawn]:
    yield Drawn("run", "curves", tuple(sheet(sources.small)))
    if motion_in(sources.report.analysis).drive.governs:
        yield Drawn("run-characteristic", "curves", characteristic(sources.small).scenes)


HOOKS = PlateHooks(curves=(_true_motion,))
