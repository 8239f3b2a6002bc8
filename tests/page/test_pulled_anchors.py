"""Which values follow the end of a spring that is pulled from a place of the frame, and what they then are."""

from __future__ import annotations

import json
import re
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen.base.errors import Where
from reportgen.base.yaml_source import read_source
from reportgen.cases import open_case
from reportgen.machine.kinematics import solve_motion
from reportgen.page.edit_session import EditSession
from reportgen.page.pull_regions import FINER_LINE, REACH
from reportgen.page.pulled_anchors import known_anchors

FOLDER = Path(__file__).parents[2] / "assignments"
FILE = FOLDER / "lever-six-bar-02.yaml"
X: Where = ("parameters", "springs", 0, "to", 0)
Y: Where = ("parameters", "springs", 0, "to", 1)
STEPS = 4


@pytest.mark.parametrize(("name", "moving"), [("lever-six-bar-02", [X, Y]), ("four-bar-01", None)])
def test_only_an_end_without_a_name_is_moved_by_its_coordinates(name: str, moving: list[Where] | None) -> None:
    """A torsion spring has no such end, and no length of the linkage counts."""
    file = FOLDER / f"{name}.yaml"
    known = known_anchors(read_source(file), file)
    assert [[value.where for value in anchor.values] for anchor in known.values()] == ([moving] if moving else [])


def test_an_end_on_the_frame_changes_its_coordinates(tmp_path: Path) -> None:
    """Both follow in steps of their field, nothing is written, and a locked one stays."""
    (file := tmp_path / "mine.yaml").write_bytes(before := FILE.read_bytes())
    edited = EditSession(partial(open_case, file), "en", path=file)
    try:
        edited.renew()
        grips = edited.grips()
        (end,) = (name for name, places in grips["points"].items() if places == [list(X), list(Y)])
        x, y = grips["ground"][end]
        resident = edited.pulls.resident()
        assert resident is not None
        scale = resident.samples.scale
        assert (x, y) == pytest.approx((-0.040 * scale, 0.073 * scale))

        def pulled(grab: int, *locked: Where) -> dict[str, Any]:
            to = [x - 0.010 * scale, y + 0.005 * scale]
            asked = {"grab": grab, "point": end, "angle": 30.0, "to": to, "locked": list(map(list, locked))}
            answer = edited.pull(asked)
            assert isinstance(answer, bytes)
            answered: dict[str, Any] = json.loads(answer[4 : 4 + int.from_bytes(answer[:4], "little")])
            assert answered["runs"], "the spring moves"
            assert answered["bodies"], "its ground moves"
            return answered

        both = pulled(1)
        assert both["values"] == [[list(X[:-1]), "-50 mm, -78 mm"]]
        assert both["at"] == pytest.approx([x - 0.010 * scale, y + 0.005 * scale])
        assert pulled(2, Y)["values"] == [[list(X[:-1]), "-50 mm, -73 mm"]]
        asked = {"grab": 3, "point": end, "angle": 30.0, "to": [0, 0], "locked": [list(X[:-1])]}
        assert edited.pull(asked) == {"values": []}
        assert file.read_bytes() == before
    finally:
        edited.close()


@pytest.mark.parametrize("locked", [(), (Y,), (X,)])
def test_an_end_has_a_region(tmp_path: Path, locked: tuple[Where, ...]) -> None:
    """A square about it, or a line along the only value; on the line along which slider F goes, it ends where F turns.

    F is the other end of the spring, and both ends of a spring must not meet.
    """
    (file := tmp_path / "mine.yaml").write_bytes(FILE.read_bytes())
    edited = EditSession(partial(open_case, file), "en", path=file)
    try:
        edited.renew()
        grips = edited.grips()
        (end,) = (name for name, places in grips["points"].items() if places == [list(X), list(Y)])
        resident = edited.pulls.resident()
        assert resident is not None
        scale, (low, high) = resident.samples.scale, resident.samples.kept["box"]
        reach = REACH * max((high - low).real, (high - low).imag)
        asked = {"grab": 1, "point": end, "angle": 30.0, "locked": list(map(list, locked)), "count": STEPS}
        region = edited.pulls.region(asked)
        assert region["lines"] == bool(locked)
        corners = np.array(re.findall(r"([-\d.]+) ([-\d.]+)", region["path"]), dtype=float)
        x, y = (corners - grips["ground"][end]).T
        turn = np.linspace(0.0, 2 * np.pi, 720)
        slider = solve_motion(resident.samples.machine.linkage, turn, 1.0).points["F"].p * scale
        # Places are written in tenths of a millimetre; of the line, each step is examined.
        exact = pytest.approx(0.0, abs=0.1)
        assert x.max() - reach * (X not in locked) == exact
        assert y.max() - reach * (Y not in locked) == exact
        assert y.min() + reach * (Y not in locked) == exact
        if locked == (Y,):
            assert 0 < x.min() - (slider.real.max() - grips["ground"][end][0]) < 2 * reach / (FINER_LINE * STEPS) + 0.1
        else:
            assert x.min() + reach * (X not in locked) == exact
    finally:
        edited.close()
