"""No label of any drawing stands on a stroke, an arrow head or another label, below the typesetter.

Where the crank is drawn small the vectors of a plan shrink and the letters do not.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from reportgen import api
from reportgen.drawing import Arrow, Label, Scene
from reportgen.drawing.geometry import box
from tests.drawing.overlaps import overlaps
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Written

SMALL = ("30 mm", "34 mm")
CASES = [*built.TYPESET, built.ROOT / "assignments" / "shaper-02.yaml"]


def faults(written: Written) -> list[str]:
    return [
        f"{key} {scene.title}: {fault}" for key, scene in built.scenes(written.document) for fault in overlaps(scene)
    ]


@pytest.mark.parametrize("path", matrix(built.FILES, built.TYPESET), ids=lambda path: path.stem)
def test_labels_of_every_file_are_clear(path: Path) -> None:
    assert faults(built.written(path, built.own_language(path))) == []


@pytest.mark.parametrize("crank", matrix(SMALL, SMALL[:1]))
@pytest.mark.parametrize("path", matrix(CASES, CASES[-1:]), ids=lambda path: path.stem)
def test_labels_are_clear_where_the_crank_is_drawn_small(path: Path, crank: str, tmp_path: Path) -> None:
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    content["drawing"] = {"crank": crank}
    file = tmp_path / path.name
    file.write_text(yaml.safe_dump(content, allow_unicode=True), encoding="utf-8")
    assert faults(built.compose(api.load(file))) == []


def test_a_label_on_an_arrow_head_is_seen() -> None:
    """The head is 2.6 mm long and 0.94 mm wide: what clears the shaft by 0.3 mm stands on the head."""
    arrow, extent = Arrow(5 + 10j, 45 + 10j), box("a", 9.0)
    height = (extent.height + extent.depth) / 2 + 0.3
    beside_shaft, at_head = (Label(complex(x, 10 + height), "a") for x in (25, 42.6))
    assert overlaps(Scene(50, 20, (arrow, beside_shaft))) == []
    assert any("stroke" in fault for fault in overlaps(Scene(50, 20, (arrow, at_head))))
