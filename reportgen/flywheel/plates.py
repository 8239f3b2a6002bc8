"""The flywheel on the drawing sheets."""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.flywheel.views import flywheel_speed, flywheel_torque, flywheel_work, needs_flywheel, wittenbauer
from reportgen.sheets.plate_sources import Drawn, Sources
from reportgen.sheets.topic_plates import PlateHooks


def _flywheel(sources: Sources) -> Iterator[Drawn]:
    small = sources.small
    yield Drawn("flywheel-torque", "curves", flywheel_torque(small).scenes)
    yield Drawn("flywheel-work", "curves", flywheel_work(small).scenes)
    if small.has_reduced_inertia:
        yield Drawn("wittenbauer", "curves", wittenbauer(small).scenes)


def _flywheel_speed(sources: Sources) -> Iterator[Drawn]:
    report = sources.report
    if needs_flywheel(report) and report.parts("flywheel-speed"):
        yield Drawn("flywheel-speed", "curves", flywheel_speed(sources.small).scenes)


HOOKS = PlateHooks(curves=(_flywheel, _flywheel_speed), further=frozenset((_flywheel_speed,)))
