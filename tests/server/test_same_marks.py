"""The marks of the server are those of `grade`: on the same cells, to the last one, and on the files that it leaves."""

from __future__ import annotations

import csv
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reportgen.classes.class_marking import Graded, grade
from reportgen.classes.roster import folder_name
from reportgen.marking.marking_policy import read_policy
from reportgen.server.desk_work import corrections
from reportgen.server.serving import make_class
from reportgen.workbook import write_csv
from tests.lanes import proof
from tests.marking import demo
from tests.server.served import Browser, Served

Cells = Mapping[tuple[str, int], str]


def marked(desk: Browser) -> dict[str, Any]:
    """The table of the class after a marking."""
    assert desk.post("/desk/mark").status_code == 200
    end = time.monotonic() + 120
    while (table := desk.json("/desk/table"))["marking"] and time.monotonic() < end:
        time.sleep(0.05)
    assert not table["marking"]
    return {row["folder"]: row for row in table["students"]} | {"problems": table["problems"]}


def verdicts_of(graded: Graded) -> dict[str, list[list[Any]]]:
    return {
        folder_name(marking.key.student["id"]): [
            [cell.id, cell.position, str(cell.verdict), round(cell.points, 9), round(cell.worth, 9)]
            for cell in marking.cells
        ]
        for marking in graded.markings
    }


def verdicts(served: Served) -> dict[str, list[list[Any]]]:
    return {folder: mark["cells"] for folder, mark in served.site.store.marks().items() if "cells" in mark}


def right_values(served: Served, folder: str) -> dict[tuple[str, int], str]:
    sheet = served.desk.json(f"/desk/students/{folder}/sheet")
    rows = [row for section in sheet["sections"] for row in section["rows"]]
    return {(row["id"], cell["position"]): cell["key"] for row in rows for cell in row["cells"] if cell.get("key")}


def sheet_of(folder: str, cells: Cells) -> bytes:
    """A sheet with these cells, as a student may save it without the server."""
    rows: list[list[str]] = [["Assignment", folder], ["id", "Value", "Position 2"]]
    rows += [[id, "", text] if position else [id, text, ""] for (id, position), text in cells.items()]
    return write_csv(rows)


def test_typed_cells_get_the_marks_of_a_sheet(served: Served, tmp_path: Path) -> None:
    right = {folder: right_values(served, folder) for folder in ("S1", "S2", "S3")}
    typed = {
        "S1": right["S1"],
        # A wrong value with what follows from it, a unit, a comma, words.
        "S2": {**right["S2"], ("v.B", 0): "0.123", ("v.CB", 2): "abc", ("seg.v.pb", 0): "30,0 mm"},
    }
    for folder, cells in typed.items():
        student = served.person(folder)
        answer = student.save(cells)
        assert (answer.status_code, answer.json()["refused"]) == (200, []), answer.text
        assert student.hand_in().json()["filled"] == len(cells)
    # S3 uploads a sheet in place of typing.
    content = sheet_of("S3", right["S3"])
    receipt = served.person("S3").upload("answers.csv", content).json()
    assert receipt["sha256"] in {file.name for file in served.folder.uploads.iterdir()}

    given = tmp_path / "given"
    given.mkdir()
    for folder, cells in {**typed, "S3": right["S3"]}.items():
        (given / f"{folder}.csv").write_bytes(sheet_of(folder, cells))
    table = marked(served.desk)
    by_hand = grade([given], served.folder.variants, served.folder.policy())
    assert verdicts(served) == verdicts_of(by_hand)
    assert table["S1"]["mark"] == 10 > table["S2"]["mark"]
    assert table["S3"]["mark"] == 10
    assert {cell[2] for cell in verdicts(served)["S2"]} >= {"right", "wrong", "unreadable"}

    # The command line takes its turn on the same folder.
    again = grade(
        [served.folder.handed], served.folder.variants, served.folder.policy(), roster=served.folder.handed_roster
    )
    assert verdicts_of(again) == verdicts(served)

    # Marks and files are seen after the release, not before.
    student = served.person("S2")
    assert student.get("/me/result").status_code == 409
    served.desk.post("/desk/release", {"released": True})
    result = student.json("/me/result")
    assert result["mark"] == table["S2"]["mark"]
    assert student.get("/me/result/feedback.pdf").content.startswith(b"%PDF")


def test_a_correction_counts_in_every_later_marking(served: Served) -> None:
    student, desk = served.person("S1"), served.desk
    right = right_values(served, "S1")
    place = "v.B", 0
    student.save({**right, place: "999"})
    before = marked(desk)["S1"]
    made = {"id": place[0], "position": place[1], "judgement": "right", "reason": "misread", "name": "Dr. Hà"}
    assert desk.post("/desk/students/S1/correct", made).status_code == 200
    after = marked(desk)["S1"]
    assert after["points"] > before["points"]
    (row,) = desk.json("/desk/students/S1/sheet")["corrections"]
    assert (row["quantity"], row["judgement"], row["judged_by"]) == (place[0], "right", "Dr. Hà")
    assert row["judged_on"]


def test_a_correction_is_for_the_value_that_was_judged(served: Served) -> None:
    student, desk, place = served.person("S1"), served.desk, ("v.B", 0)
    student.save({**right_values(served, "S1"), place: "-999,5"})
    made = {"id": place[0], "position": place[1], "judgement": "right", "reason": "misread", "name": "Dr. Hà"}
    assert desk.post("/desk/students/S1/correct", made).status_code == 200
    assert [row["value"] for row in corrections(served.site)] == ["-999,5"]
    full = marked(desk)["S1"]["points"]
    student.save({place: "-5"})
    table = marked(desk)
    assert table["S1"]["points"] < full
    assert table["problems"]


def test_cells_that_were_never_handed_in_count_as_they_were_saved(served: Served) -> None:
    student = served.person("S1")
    student.save(right_values(served, "S1"))
    table = marked(served.desk)
    assert table["S1"]["mark"] == 10
    assert table["S2"]["mark"] is None


def test_a_check_says_what_compare_says(served: Served) -> None:
    student = served.person("S1")
    right = right_values(served, "S1")
    student.save({**right, ("v.B", 0): "0.123"})
    one = student.post("/me/check", {"client": "check-01", "id": "v.B", "position": 0}).json()
    assert [(cell["id"], cell["verdict"]) for cell in one["cells"]] == [("v.B", "wrong")]
    assert one["cells"][0]["message"], "the hint that the policy allows"
    whole = student.post("/me/check", {"client": "check-02"}).json()
    wrong = {cell["id"] for cell in whole["cells"] if cell["verdict"] == "wrong"}
    assert "v.B" in wrong
    assert whole["lines"]
    answers = [text for place, text in right.items() if place[0] == "v.B"]
    assert not any(answer in str(whole) for answer in answers), "no check tells the right value"


@proof
def test_the_demo_class_gets_its_marks(tmp_path: Path) -> None:
    """The sheets of the demo class, typed cell by cell, get the verdicts that `grade` gives the files."""
    folder = tmp_path / "class"
    make_class(folder, demo.DEMO / "spec.yaml", demo.DEMO / "roster.csv", demo.DEMO / "policy.yaml", "vi")
    policy = read_policy(demo.DEMO / "policy.yaml")
    by_hand = grade([demo.SHEETS], folder / "variants", policy, roster=demo.DEMO / "roster.csv")
    with Served.of(folder) as served:
        for marking in by_hand.markings:
            student = served.person(marking.key.id)
            cells = {place: answer.text for place, answer in marking.submission.values.items()}
            # What is no number on the sheet is none in the browser.
            cells |= dict.fromkeys(marking.submission.problems, "khoảng 30")
            assert student.save(cells).json()["refused"] == []
            assert student.hand_in().status_code == 200
        marked(served.desk)
        assert verdicts(served) == verdicts_of(by_hand)
        with open(served.folder.marked / "grades.csv", encoding="utf-8-sig") as table:
            assert len(list(csv.reader(table))) == 1 + len(served.site.store.people()) - 1
