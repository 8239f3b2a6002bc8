"""Edge cases of the assignment file, each a change of the engine's sample."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import yaml

from tests.report import built

Change = Callable[[dict[str, Any]], None]
SAMPLE = built.SAMPLE


def put(path: str, value: Any) -> Change:
    """Sets an entry, e.g. `positions.count`; None takes it away."""
    *above, last = path.split(".")

    def change(content: dict[str, Any]) -> None:
        table = content
        for name in above:
            table = table[name]
        table.pop(last, None)
        if value is not None:
            table[last] = value

    return change


def both(*changes: Change) -> Change:
    def change(content: dict[str, Any]) -> None:
        for one in changes:
            one(content)

    return change


def indicator_by_angle(content: dict[str, Any]) -> None:
    """A smooth made-up curve over 720°: compression and expansion as polytropes about top dead centre."""
    angles = range(0, 721, 20)
    pressures = [
        round(28 / (1 + 6 * math.sin(math.radians((angle - 360) / 2)) ** 2) ** 1.5 * (1.6 if angle > 360 else 1), 2)
        if 180 <= angle <= 540
        else -1.0
        for angle in angles
    ]
    content["indicator"] = {
        "unit": "N/cm2",
        "reference": "gauge",
        "by": "crank_angle",
        "angle": [f"{angle} deg" for angle in angles],
        "p": pressures,
    }


def absolute_indicator(content: dict[str, Any]) -> None:
    table = content["indicator"]
    table["reference"] = "absolute"
    for row in ("intake", "compression", "expansion", "exhaust"):
        table[row] = [round(float(p) + 10.1325, 4) for p in table[row]]


CHANGES: dict[str, Change] = {
    "clockwise": put("positions.direction", "clockwise"),
    "clockwise all worked": both(put("positions.direction", "clockwise"), put("report.worked_positions", [3, 5, 16])),
    **{f"count {count}": put("positions.count", count) for count in (4, 5, 7, 12, 36)},
    "all of four": both(put("positions.count", 4), put("report.worked_positions", "all")),
    "the last": put("report.worked_positions", [16]),
    "start": both(put("positions.start", "25 deg"), put("indicator.firing", None)),
    "crank angle 0": both(put("parameters.crank_angle", "0 deg"), put("indicator.firing", None)),
    "crank angle 90": both(put("parameters.crank_angle", "90 deg"), put("indicator.firing", None)),
    "crank angle 270": both(put("parameters.crank_angle", "270 deg"), put("indicator.firing", None)),
    "centre at the crankpin": put("parameters.s", 0),
    "centre at the piston pin": put("parameters.s", 1),
    "J2": put("parameters.J2", "6.0e-3 kg m2"),
    "masses": both(
        put("parameters.G2", None),
        put("parameters.G3", None),
        put("parameters.m2", "2.04 kg"),
        put("parameters.m3", "2.24 kg"),
    ),
    "omega": both(put("parameters.n", None), put("parameters.omega1", "230 rad/s")),
    "short rods": put("parameters.lambda", 0.95),
    "long rods": both(put("parameters.lambda", 0.05), put("drawing.crank", "40 mm")),
    "indicator by angle": indicator_by_angle,
    "absolute pressures": absolute_indicator,
}

ON_PAPER = ("clockwise", "crank angle 90")
"""Variants that are typeset, too."""
TELLING = ("clockwise", "count 5", "crank angle 90", "centre at the crankpin", "indicator by angle")
"""Variants that `make test` has: of the direction, the positions, the crank, the masses, the diagram."""


def content(name: str) -> str:
    """The assignment file of a variant."""
    table = yaml.safe_load(SAMPLE.read_text(encoding="utf-8"))
    # Dates and quantities stay texts.
    table["report"]["date"] = str(table["report"]["date"])
    CHANGES[name](table)
    return str(yaml.safe_dump(table, allow_unicode=True, sort_keys=False))
