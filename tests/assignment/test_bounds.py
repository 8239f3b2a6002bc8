"""Bounds: told in words that a user of the file has, and all in one table of the documents with their reasons."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, get_args

import pytest

from reportgen.assignment import common, fields
from reportgen.assignment.fields import Interval
from reportgen.base.errors import Fault, Location
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.catalogue import given_loads
from reportgen.flywheel.topic import Unevenness

DOCUMENT = Path(__file__).parents[2] / "docs" / "reference" / "bounds.md"
TYPES = {
    "positions a turn": common.Count,
    "length drawn for the crank": get_args(common.Drawing.model_fields["crank"].annotation)[0],
    "length": fields.Length,
    "coordinate": fields.Coordinate,
    "offset, small length": fields.Offset,
    "angle": fields.Angle,
    "angle in the cycle": fields.CycleAngle,
    "speed `n`": fields.RotationalSpeed,
    "speed `omega1`": fields.AngularVelocity,
    "force": fields.Force,
    "torque": given_loads.TorqueSize,
    "weight": fields.Weight,
    "mass": fields.Mass,
    "moment of inertia": fields.MomentOfInertia,
    "acceleration `g`": fields.Gravity,
    "angular acceleration `epsilon1`": fields.AngularAcceleration,
    "acceleration of a sliding driver": fields.Acceleration,
    "pressure": fields.Pressure,
    "ratio R/L": fields.RodRatio,
    "share": fields.Share,
    "unevenness": Unevenness,
}


def told(interval: Interval, unit: str, language: Language) -> str:
    arguments = {"text": "x", "unit": f" {unit}" if unit else "", **interval.words}
    return as_problem(Fault("out-of-range", Location(""), arguments), language).message.partition(": ")[2]


@pytest.mark.parametrize(
    ("ends", "english", "vietnamese"),
    [
        (
            {"least": 0, "most": 1e7, "tiny": 1e-6},
            "between 0.000001 and 10 000 000 N, or 0",
            "từ 0.000001 đến 10 000 000 N, hoặc 0",
        ),
        ({"least": 0.1, "below": 1e5}, "at least 0.1 and less than 100 000 N", "từ 0.1 đến dưới 100 000 N"),
        ({"above": 0, "most": 2}, "more than 0 and at most 2 N", "lớn hơn 0 và không quá 2 N"),
        ({"above": -1, "below": 1}, "more than −1 and less than 1 N", "lớn hơn −1 và nhỏ hơn 1 N"),
        (
            {"least": -1e9, "most": 1e9, "tiny": 1e-12},
            "between −10⁹ and 10⁹ N; 0, or at least 10⁻¹² N in size",
            "từ −10⁹ đến 10⁹ N; bằng 0 hoặc có độ lớn từ 10⁻¹² N trở lên",
        ),
    ],
)
def test_an_interval_is_told_in_words(ends: dict[str, float], english: str, vietnamese: str) -> None:
    found = [told(Interval(**ends), "N", language).replace("\N{NO-BREAK SPACE}", " ") for language in ("en", "vi")]
    assert found == [english, vietnamese]


def bounds(type_: Any) -> tuple[Interval, str]:
    """The interval of a field's type, and its unit."""
    (reader,) = type_.__metadata__
    if isinstance(reader, fields.Whole):
        return Interval(least=reader.least, most=reader.most), ""
    return reader.interval, getattr(reader, "unit", "")


def test_the_documents_tell_every_bound_with_its_reason() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| (.+?) \| (.+?) \| .{10,} \|$", text, re.MULTILINE))
    wanted = {name: told(*bounds(type_), "en").replace("\N{NO-BREAK SPACE}", " ") for name, type_ in TYPES.items()}
    assert {name: rows.get(name) for name in TYPES} == wanted
