"""Which values follow the tip of a load's arrow that is pulled, and what they then are."""

from __future__ import annotations

import cmath
import json
import math
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen.base.errors import Where
from reportgen.base.yaml_source import read_source
from reportgen.cases import open_case
from reportgen.machine.analysis import motion_at
from reportgen.page.edit_session import EditSession
from reportgen.page.pulled_loads import load_values

FOLDER = Path(__file__).parents[2] / "assignments"
LOAD = "    - {by: constant, link: 3, M: 4 N m, against: motion}\n"
TURNED = "    - {by: constant, link: 2, at: E, F: 300 N, direction: 40 deg}\n"
SIZE: Where = ("parameters", "loads", 1, "F")
ANGLE: Where = ("parameters", "loads", 1, "direction")


def turned_load(folder: Path) -> Path:
    """A linkage with a force in a direction of its own."""
    text = (FOLDER / "linkage-8.yaml").read_text(encoding="utf-8")
    assert LOAD in text
    (file := folder / "mine.yaml").write_text(text.replace(LOAD, TURNED), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("name", "following"),
    [
        ("slider-crank-02", {"P3": ("force", "F")}),
        ("shaper-01", {"P5": ("cutting", "F")}),
        ("slider-crank-01", {}),
        ("engine-single-I", {}),
    ],
)
def test_only_a_load_of_one_size_has_a_value_that_follows(name: str, following: dict[str, tuple[str, ...]]) -> None:
    """A table and the pressure of a gas have none, and no value of the linkage counts."""
    file = FOLDER / f"{name}.yaml"
    values = load_values(read_source(file), file)
    assert {load: [value.where for value in of_load] for load, of_load in values.items()} == {
        load: [("parameters", *keys)] for load, keys in following.items()
    }


def answered(answer: Any) -> dict[str, Any]:
    assert isinstance(answer, bytes)
    told = json.loads(answer[4 : 4 + int.from_bytes(answer[:4], "little")])
    assert told["runs"], "the arrow moves"
    return {told_where[-1]: text for told_where, text in told["values"]} | {"at": told["at"]}


def test_the_tip_changes_the_size_and_the_direction(tmp_path: Path) -> None:
    """Both follow where both are free, in steps of their fields; of a locked one the other is as near as it can be."""
    edited = EditSession(partial(open_case, file := turned_load(tmp_path)), "en", path=file)
    try:
        edited.renew()
        before = file.read_bytes()
        grips = edited.grips()
        ((load, places),) = grips["loads"].items()
        assert places == [list(SIZE), list(ANGLE)]
        resident = edited.pulls.resident()
        assert resident is not None
        samples, angle = resident.samples, np.array([math.radians(30.0)])
        acting = next(each for each in samples.machine.applied if each.name == load)
        start = complex(acting.load(angle, motion_at(samples.machine, angle)).point[0]) * samples.scale
        length = 300 / samples.kept["arrows of forces"]

        def pulled(grab: int, share: float, degrees: float, *locked: Where) -> dict[str, Any]:
            tip = start + cmath.rect(length * share, math.radians(degrees))
            asked = {"grab": grab, "load": load, "angle": 30.0, "to": [tip.real, -tip.imag]}
            return answered(edited.pull({**asked, "locked": list(map(list, locked))}))

        both = pulled(1, 1.5, 75.0)
        assert (both["F"], both["direction"]) == ("450 N", "75 deg")
        tip = start + cmath.rect(1.5 * length, math.radians(75.0))
        assert both["at"] == pytest.approx([tip.real, -tip.imag], abs=1e-6)
        assert pulled(2, 1.5, 75.0, SIZE)["direction"] == "75 deg"
        along = pulled(3, 3.0, 100.0, ANGLE)
        assert along["F"] == "450 N", "half of three times the size, as its line is 60° off"
        assert edited.pulls.region({"grab": 3, "load": load, "angle": 30.0, "locked": [list(ANGLE)], "count": 4}) == {}
        asked = {"grab": 4, "load": load, "angle": 30.0, "to": [0, 0], "locked": [list(SIZE), list(ANGLE)]}
        assert edited.pull(asked) == {"values": []}
        assert file.read_bytes() == before
    finally:
        edited.close()
