"""A coursework of four parts by its form, as an instructor begins it: from the file of a kind to the key of all."""

from __future__ import annotations

import shutil
from functools import partial
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.cases import open_case
from reportgen.marking.toleranced_key import key_of
from reportgen.page.edit_session import EditSession
from tests.lanes import proof

FOLDER = Path(__file__).parents[2] / "assignments" / "coursework"


def session(file: Path, whole: Path | None = None) -> EditSession:
    return EditSession(partial(open_case, file, "en", whole), "en", path=file, whole=whole)


def answers(file: Path) -> dict[str, float]:
    """The first value of each quantity of the key."""
    return {row.id: float(row.values[0]) for row in key_of(open_case(file)).rows}


@proof
def test_four_parts_from_the_form_to_the_key(tmp_path: Path) -> None:
    """Added, ordered, removed and put back; the key of each part is that of the part alone, its own cam changed."""
    (file := tmp_path / "whole.yaml").write_text(catalogue.sample("shaper", "en"), encoding="utf-8")
    edited = session(file)
    for kind in ("cam", "gear-pair", "planetary-train"):
        assert "refused" not in edited.edit({"op": "add", "where": ["parts"], "kind": kind})
    edited.edit({"op": "move", "where": ["parts"], "first": 1})
    edited.edit({"op": "remove", "where": ["parts", 0]})
    edited.edit({"op": "undo"})
    place = ["parts", 0, "parameters", "h"]
    form = edited.edit({"op": "set", "where": place, "value": "41 mm", "was": "40 mm"})["form"]
    assert 'id="f:parts.1.parameters.scheme"' in form
    whole = answers(file)
    for kind in ("cam", "planetary-train", "gear-pair"):
        (alone := tmp_path / f"{kind}.yaml").write_text(catalogue.sample(kind, "en"), encoding="utf-8")
        if kind == "cam":
            session(alone).edit({"op": "set", "where": ["parameters", "h"], "value": "41 mm"})
        own = answers(alone)
        assert own == pytest.approx({id: whole[id] for id in own}, nan_ok=True), kind


@proof
def test_a_part_is_changed_on_its_own_page_and_the_key_of_the_whole_with_it(tmp_path: Path) -> None:
    """The feed cam sits on the crank of the shaper: its speed is the machine's, whatever page that is changed on."""
    for name in ("shaper-whole", "motor-train", "drive-pair", "feed-cam"):
        shutil.copy(FOLDER / f"{name}.yaml", tmp_path)
    file, cam = tmp_path / "shaper-whole.yaml", tmp_path / "feed-cam.yaml"
    before = answers(file)
    whole, part = session(file), session(cam, file)
    part.edit({"op": "set", "where": ["parameters", "arm"], "value": "140 mm", "was": "132 mm"})
    whole.edit({"op": "set", "where": ["parameters", "n"], "value": "160 rpm", "was": "80 rpm"})
    after = answers(file)
    assert {id.partition(".")[0] for id in after} >= {"cam", "gears", "train"}
    part.open()
    assert part.revision.fault == ""
    assert part.revision.case is not None
    own = {row.id: float(row.values[0]) for row in key_of(part.revision.case).rows}
    part.close()
    assert own == pytest.approx({id: after[id] for id in own}, nan_ok=True)
    assert own["cam.n"] == pytest.approx(2 * before["cam.n"])
