"""Cells belong to the variant that they were typed for, whoever draws another one and whenever."""

from __future__ import annotations

import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from reportgen.classes.variants import make_variants
from reportgen.server import handed
from reportgen.server.class_folder import ClassFolder
from tests.server.served import Served
from tests.server.test_same_marks import marked


def redrawn_outside(folder: ClassFolder) -> None:
    make_variants(folder.spec, folder.roster, folder.variants, language="en", redraw=["S1"])


def test_an_edited_file_is_not_redrawn_and_its_cells_stay(served: Served) -> None:
    student, desk = served.person("S1"), served.desk
    student.save({student.places[0]: "1"})
    text = desk.json("/desk/students/S1/file")["yaml"].replace("n: 300 rpm", "n: 310 rpm")
    assert desk.post("/desk/students/S1/fix", {"yaml": text}).status_code == 200
    for _ in range(2):
        answer = desk.post("/desk/students/S1/redraw")
        assert answer.status_code == 400
        (line,) = answer.json()["lines"]
        assert "S1.yaml" in line
        assert served.site.drawn("S1") == "1"
    assert [cell["text"] for cell in student.json("/me/state")["cells"]] == ["1"]


def test_two_redraws_at_once_are_two_variants(served: Served) -> None:
    desk = served.desk
    with ThreadPoolExecutor(2) as threads:
        calls = [threads.submit(desk.post, "/desk/students/S1/redraw") for _ in range(2)]
        assert [call.result().status_code for call in calls] == [200, 200]
    assert served.site.drawn("S1") == "3"


@pytest.mark.parametrize("edited", [False, True])
def test_a_variant_redrawn_while_nothing_serves_has_an_empty_sheet(
    made_class: Path, tmp_path: Path, edited: bool
) -> None:
    folder = ClassFolder(tmp_path / "class")
    shutil.copytree(made_class, folder.path)
    with Served.of(folder.path) as served:
        student = served.person("S1")
        student.save({student.places[0]: "1"})
        if edited:
            file = folder.assignment("S1")
            text = file.read_text("utf-8").replace("n: 300 rpm", "n: 310 rpm")
            assert served.desk.post("/desk/students/S1/fix", {"yaml": text}).status_code == 200
    redrawn_outside(folder)
    for _ in range(2):
        with Served.of(folder.path) as served:
            assert served.site.drawn("S1") == ("1" if edited else "2")
            assert len(served.person("S1").json("/me/state")["cells"]) == edited


def test_no_variant_changes_while_the_class_is_marked(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    lay_out_all, held = handed.lay_out_all, list[bool]()

    async def laid(site: Any) -> None:
        held.append(site.changing.locked())
        await lay_out_all(site)
        held.append(site.changing.locked())

    monkeypatch.setattr(handed, "lay_out_all", laid)
    marked(served.desk)
    assert held == [True, True]
