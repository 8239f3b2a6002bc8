"""Which values follow the end of a spring that is pulled from a place of the frame, and what they then are."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from reportgen.base.errors import Where
from reportgen.base.yaml_source import read_source
from reportgen.cases import open_case
from reportgen.page.edit_session import EditSession
from reportgen.page.pulled_anchors import known_anchors

FOLDER = Path(__file__).parents[2] / "assignments"
FILE = FOLDER / "lever-six-bar-02.yaml"
X: Where = ("parameters", "springs", 0, "to", 0)
Y: Where = ("parameters", "springs", 0, "to", 1)


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
        assert edited.pulls.region({**asked, "grab": 4, "locked": [], "count": 4}) == {}
        assert file.read_bytes() == before
    finally:
        edited.close()
