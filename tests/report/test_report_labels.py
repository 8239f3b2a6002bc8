"""No label of any drawing stands on a stroke, an arrow head or another label, below the typesetter.

Where the crank is drawn small the vectors of a plan shrink and the letters do not.
"""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest
import yaml

from reportgen import api
from reportgen.assignment import Assignment
from reportgen.document import Figure
from reportgen.drawing import Arrow, Label, Line, Scene
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.label_size import box
from reportgen.drawing.labels import KEY, label
from reportgen.formula import Chain, Symbol
from tests.drawing.overlaps import astray, cross, overlaps, watched
from tests.lanes import matrix
from tests.report import built, variants
from tests.report.built import Written

SMALL = ("30 mm", "34 mm")
CASES = [*built.TYPESET, built.ROOT / "assignments" / "shaper-02.yaml"]


def faults(written: Written) -> list[str]:
    return [
        f"{key} {scene.title}: {fault}" for key, scene in built.scenes(written.document) for fault in overlaps(scene)
    ]


@pytest.mark.parametrize("path", matrix(built.ALL, built.TYPESET), ids=lambda path: path.stem)
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


def well_labelled(assignment: Assignment) -> None:
    """Leaders are short and cross none; every label's nearest point is its own, or its leader alone tells.

    So it does for marks of a curve, and where a small plan has points about 1 mm apart and white paper beyond them: a
    label there keeps clear of all other points.
    """
    with watched() as figures:
        built.compose(assignment)
    assert figures
    for figure in figures:
        leaders = [one.leader for one in figure if one.leader]
        assert max((abs(leader.end - leader.start) for leader in leaders), default=0.0) <= 12.0
        assert not any(cross(*pair) for pair in combinations(leaders, 2))
        led = [one for one in astray(figure) if not (one.mark and one.leader)]
        assert all(one.leader for one in led)
        assert all(one.to(point) > 1.5 for one in led for other in figure if other is not one for point in other.named)


@pytest.mark.parametrize("path", matrix(built.ALL, built.TELLING), ids=lambda path: path.stem)
def test_leaders_are_short_and_cross_none_and_labels_stand_at_their_own_points(path: Path) -> None:
    well_labelled(api.load(path))


@pytest.mark.parametrize("name", matrix(variants.CHANGES, variants.TELLING[:1]))
def test_labels_of_a_variant_stand_at_their_own_points(name: str, tmp_path: Path) -> None:
    file = tmp_path / "variant.yaml"
    file.write_text(variants.content(name), encoding="utf-8")
    well_labelled(api.load(file))


@pytest.mark.parametrize("path", matrix(built.ALL, built.TELLING), ids=lambda path: path.stem)
def test_small_plans_name_points_only_and_print_their_scale_once(path: Path) -> None:
    """The scale stands behind the caption, or once on a sheet; no panel repeats it."""
    document = built.written(path, built.own_language(path)).document
    for key, scene in built.scenes(document):
        if key.endswith((".plates", ".stages")):
            written = [item.content for item in scene.items if isinstance(item, Label)]
            assert not [one for one in written if isinstance(one, Symbol) and one.over == "vector"]
            assert sum(isinstance(one, Chain) for one in written) <= 1
    for block in built.walk(document.blocks):
        if isinstance(block, Figure) and block.key.endswith((".plates", ".stages")):
            parts = [item.content for scene in block.scenes for item in scene.items if isinstance(item, Label)]
            assert not [one for one in parts if isinstance(one, Chain)]


def test_what_finds_no_room_is_a_number_that_a_line_below_explains() -> None:
    """Between two walls there is room for a digit and none for the name."""
    walls = tuple(Line(complex(x, -20), complex(x, 20)) for x in (*range(-40, -1, 2), *range(2, 41, 2)))
    draft = Canvas(walls, (label(0j, Symbol("n", "CD"), short=KEY),))
    written = [item.content for item in finish(draft).items if isinstance(item, Label)]
    assert written == ["1", "1 – ", Symbol("n", "CD")]


def test_a_label_on_an_arrow_head_is_seen() -> None:
    """The head is 2.6 mm long and 0.94 mm wide: what clears the shaft by 0.3 mm stands on the head."""
    arrow, extent = Arrow(5 + 10j, 45 + 10j), box("a", 9.0)
    height = (extent.height + extent.depth) / 2 + 0.3
    beside_shaft, at_head = (Label(complex(x, 10 + height), "a") for x in (25, 42.6))
    assert overlaps(Scene(50, 20, (arrow, beside_shaft))) == []
    assert any("stroke" in fault for fault in overlaps(Scene(50, 20, (arrow, at_head))))
