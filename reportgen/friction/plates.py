"""Friction on the drawing sheets."""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.drawing.vector_plan import plan
from reportgen.friction import views
from reportgen.friction.force_plans import force_plan_with_friction
from reportgen.sheets.plate_sources import Drawn, Sources
from reportgen.sheets.topic_plates import PlateHooks


def _friction(sources: Sources) -> Iterator[Drawn]:
    """Yield the machine with its friction circles at the worked positions, and each circle enlarged."""
    report, small = sources.report, sources.small
    if not views.rubbing(report):
        return
    for k in report.worked_forces:
        scenes = (views.scheme_scene(small, k), *views.joints(small, k).scenes)
        yield Drawn("friction", "forces", scenes, (sources.place(k),))


def _friction_plans(sources: Sources) -> Iterator[Drawn]:
    """Yield the force plans with friction of the worked positions."""
    report, small = sources.report, sources.small
    for k in report.worked_forces if views.rubbing(report) else ():
        polygons = [(sources.called(group), group.polygon) for group in reversed(report.groups)]
        for called, polygon in (*polygons, (str(report.words["figure"]["driver"]), report.driver_polygon)):
            if polygon is not None:
                scene = plan(force_plan_with_friction(small, polygon, k))
                yield Drawn("friction-plan", "forces", (scene,), (sources.place(k, called),))


HOOKS = PlateHooks(after_bodies=(_friction, _friction_plans), further=frozenset((_friction_plans,)))
