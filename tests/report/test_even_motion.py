"""True motion at a constant reduced inertia or a constant speed: its figures have scales of the values' size."""

from __future__ import annotations

import re
from typing import Any

import pytest

import reportgen
from reportgen import catalogue
from reportgen.base.kinds import program_kinds
from reportgen.cases import MachineCase
from reportgen.catalogue.topic_sections import TopicParameters
from reportgen.drawing import Label, Scene
from reportgen.formula import Number
from reportgen.motion import curves
from reportgen.motion.true_motion import motion_in
from reportgen.report.context import ReportContext
from tests.topics.test_topic_pairs import sample

MACHINES = [kind for kind in program_kinds() if issubclass(catalogue.kind(kind).base, TopicParameters)]
MASS = re.compile("[GmJ][0-9]")
LOADS = {"cutting", "force", "loads", "torque"}
KEEP_MASSES = {"engine-single", "engine-twin", "linkage"}
"""Kinds whose masses stay: the links of an engine always have one, those of a linkage are the user's own."""
MOTOR = {"motion": {"drive": {"constant": "find", "J": "20 kg m2"}}}
TURNING: dict[str, dict[str, Any]] = {
    "mass": {"m1": "1 kg"},
    "moment": {"J1": "0.05 kg m2"},
    "both": {"m1": "1 kg", "J1": "0.05 kg m2"},
    "motor": {"m1": "1 kg", **MOTOR},
}
"""What turns with the crank and is all that has inertia."""
CASES = [(kind, "motor") for kind in sorted(KEEP_MASSES)]
CASES += [(kind, turning) for kind in MACHINES if kind not in KEEP_MASSES for turning in TURNING]
OVER_ANGLE = curves.inertia, curves.speed, curves.acceleration, curves.torques


def even(kind: str, turning: str) -> ReportContext:
    """A machine without further loads, of which only the crank and the motor have a mass, in a horizontal plane."""
    data = sample(kind)
    given = {key: one for key, one in data["parameters"].items() if key not in LOADS}
    asked: dict[str, Any] = MOTOR
    if kind not in KEEP_MASSES:
        given = {key: one for key, one in given.items() if not MASS.fullmatch(key)}
        asked = {"motion": {"drive": {"constant": "find"}}, "plane": "horizontal", **TURNING[turning]}
    case = reportgen.open({**data, "parameters": {**given, **asked}}).case
    assert isinstance(case, MachineCase)
    return ReportContext(case)


@pytest.mark.parametrize(("kind", "turning"), CASES)
def test_the_figures_of_an_even_motion_are_scaled(kind: str, turning: str) -> None:
    """The reduced inertia of a crank differs from position to position in its last digits only."""
    report = even(kind, turning)
    for draw in OVER_ANGLE:
        assert draw(report).scenes or draw is curves.inertia
    (scene,) = curves.energy(report).scenes
    run = motion_in(report.analysis).alone.run
    J, T = (_ticks(scene, side) for side in ("center", "right"))
    # Not every tick has a number.
    for ticks, values in ((J, run.inertia), (T, run.energy)):
        assert min(ticks) <= values.max() * 1.001
        assert values.max() * 0.999 <= max(ticks) <= 2.5 * values.max()


def _ticks(scene: Scene, side: str) -> list[float]:
    figured = [item for item in scene.items if isinstance(item, Label) and item.anchor == side]
    return [item.content.value for item in figured if isinstance(item.content, Number)]
