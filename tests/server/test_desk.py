"""What an instructor changes while the class works: deadlines, variants, students; and what can be downloaded."""

from __future__ import annotations

import asyncio
import csv
import datetime
import io
import os
import re
import threading
import time
import zipfile
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest
from sqlalchemy import Row
from starlette.concurrency import run_in_threadpool

from reportgen.classes.variants import make_variants
from reportgen.server import database as databases
from reportgen.server import downloads, handed, work
from reportgen.server.class_folder import ClassFolder
from reportgen.server.handed import put_handed_roster
from reportgen.server.links import DESK
from reportgen.server.serving import make_class
from reportgen.server.site import Site
from reportgen.server.store import TypedCell, Window
from tests.server.served import ADDRESS, POLICY, ROSTER, Served
from tests.server.test_same_marks import marked, right_values


def local(days: float) -> str:
    return f"{datetime.datetime.now() + datetime.timedelta(days=days):%Y-%m-%d %H:%M}"


def policy(served: Served, text: str) -> None:
    file = served.folder.path / "policy.yaml"
    file.write_text(POLICY + text, encoding="utf-8")
    # Two changes within one tick of a coarse clock are two changes.
    os.utime(file, ns=(time.time_ns(), time.time_ns()))


def test_after_the_deadline_nothing_is_accepted_but_from_whom_it_was_extended(served: Served) -> None:
    student, late = served.person("S1"), served.person("S2")
    place = student.places[0]
    assert student.save({place: "1"}).status_code == 200
    policy(served, f"browser: {{closes: {local(-1)}}}\n")
    for answer in (student.save({place: "2"}), student.hand_in(), student.upload("a.pdf", b"a")):
        assert (answer.status_code, answer.json()["error"]) == (409, "closed")
    assert served.desk.post("/desk/students/S2/deadline", {"closes": local(1)}).status_code == 200
    assert late.save({late.places[0]: "2"}).status_code == 200
    state = student.json("/me/state")
    assert not state["open"]
    assert [cell["text"] for cell in state["cells"]] == ["1"]
    assert not served.folder.uploads.exists()
    rows = {row["id"]: row["extended"] for row in served.desk.json("/desk/table")["students"]}
    assert rows == {"S1": False, "S2": True, "S3": False}
    assert served.desk.post("/desk/students/S2/deadline", {"closes": None}).status_code == 200
    assert late.save({late.places[0]: "3"}).status_code == 409


def test_checks_and_uploads_are_limited_by_the_policy(served: Served) -> None:
    student = served.person("S1")
    student.save({student.places[0]: "1"})
    policy(served, f"browser: {{checks: 1, uploads: 1, hints: false, checks_from: {local(1)}}}\n")
    assert student.post("/me/check", {"client": "check-01"}).json()["error"] == "too_early"
    policy(served, "browser: {checks: 1, uploads: 1, hints: false}\n")
    first = student.post("/me/check", {"client": "check-01"})
    assert first.json()["checks_left"] == 0
    assert student.post("/me/check", {"client": "check-01"}).json() == first.json()
    assert student.post("/me/check", {"client": "check-02"}).json()["error"] == "used_up"
    assert student.upload("a.pdf", b"a").status_code == 200
    assert student.upload("b.pdf", b"b").json()["error"] == "used_up"
    assert len(list(served.folder.uploads.iterdir())) == 1


def test_a_check_that_is_sent_again_is_the_same_check(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    student, right = served.person("S1"), right_values(served, "S1")
    first, second = [place for place in student.places if place in right and place[0].startswith("v.")][:2]
    student.save({first: "12345", second: right[second]})
    with monkeypatch.context() as patch:
        # The server is killed before it knows the answer.
        patch.setattr(served.site.store, "end_check", lambda *_: None)
        student.post("/me/check", {"client": "check-01", "id": first[0], "position": first[1]})
    student.save({first: right[first]})
    again = student.post("/me/check", {"client": "check-01", "id": second[0], "position": second[1]}).json()
    said = [(cell["id"], cell["position"], cell["verdict"]) for cell in again["cells"]]
    assert said == [(*first, "wrong")]


def test_a_mistake_in_the_policy_does_not_stop_the_class(served: Served) -> None:
    student = served.person("S1")
    policy(served, "browser: {checks: many}\n")
    assert student.save({student.places[0]: "1"}).status_code == 200


def test_a_student_who_comes_later_gets_a_variant_and_the_others_keep_theirs(served: Served) -> None:
    before = {file.name: file.read_bytes() for file in served.folder.variants.glob("S*.yaml")}
    row = served.desk.post("/desk/students", {"id": "S4", "name": "Dũng Phạm", "class": "K2"}).json()
    assert (row["folder"], row["asked"] > 0) == ("S4", True)
    assert served.person("S4").places
    assert {name: (served.folder.variants / name).read_bytes() for name in before} == before
    assert "Dũng Phạm,S4" in served.folder.roster.read_text("utf-8-sig")
    again = served.desk.post("/desk/students", {"id": "s4", "name": "Another"})
    assert again.status_code == 400
    assert again.json()["lines"]
    assert served.folder.roster.read_text("utf-8-sig").count("S4") == 1


def test_another_variant_has_an_empty_sheet_and_the_old_cells_are_kept(served: Served) -> None:
    student, desk = served.person("S1"), served.desk
    place = student.places[0]
    student.save({place: "1"})
    student.upload("answers.csv", b"id,Value\r\n")
    before = served.folder.assignment("S1").read_text()
    assert desk.post("/desk/students/S1/redraw").status_code == 200
    assert served.folder.assignment("S1").read_text() != before
    assert student.json("/me/state")["cells"] == []
    # A page that still shows the old sheet cannot fill in the new one.
    sent = {"client": student.name(), "id": place[0], "position": place[1], "text": "2"}
    assert student.post("/me/cells", {"variant": "1", "cells": [sent]}).json()["error"] == "redrawn"
    assert [row.text for row in served.site.store.cells("S1", "1")] == ["1"]
    assert not any((served.folder.handed / "S1").iterdir())
    # The file was for the old variant: it is shown, but nothing is handed in.
    row = next(row for row in desk.json("/desk/table")["students"] if row["id"] == "S1")
    assert (row["uploads"], row["earlier"], row["state"]) == (0, 1, "")
    assert [receipt["earlier"] for receipt in student.json("/me/state")["uploads"]] == [True]
    put_handed_roster(served.site)
    rows = list(csv.DictReader(io.StringIO(served.folder.handed_roster.read_text("utf-8-sig"))))
    assert rows[0]["handed_in"] == ""


def test_a_fixed_file_keeps_the_cells_and_a_wrong_one_is_not_kept(served: Served) -> None:
    student, desk = served.person("S1"), served.desk
    student.save({student.places[0]: "1"})
    text = desk.json("/desk/students/S1/file")["yaml"]
    wrong = desk.post("/desk/students/S1/fix", {"yaml": text.replace("n: 300 rpm", "n: fast")})
    assert wrong.status_code == 400
    assert wrong.json()["lines"]
    assert desk.json("/desk/students/S1/file")["yaml"] == text
    assert desk.post("/desk/students/S1/fix", {"yaml": text.replace("n: 300 rpm", "n: 310 rpm")}).status_code == 200
    assert "310 rpm" in served.folder.assignment("S1").read_text()
    assert [cell["text"] for cell in student.json("/me/state")["cells"]] == ["1"]


def test_lateness_is_counted_from_the_hand_in_and_forgiven_up_to_an_extension(served: Served) -> None:
    policy(served, f"late: {{due: {local(-2.5)}, per_day: 1}}\n")
    for folder in ("S1", "S2"):
        student = served.person(folder)
        student.save(right_values(served, folder))
        student.hand_in()
    served.desk.post("/desk/students/S2/deadline", {"closes": local(1)})
    table = marked(served.desk)
    assert (table["S1"]["mark"], table["S2"]["mark"]) == (7, 10)
    put_handed_roster(served.site)
    rows = list(csv.DictReader(io.StringIO(served.folder.handed_roster.read_text("utf-8-sig"))))
    assert [bool(row["handed_in"]) for row in rows] == [True, True, False]


def test_what_can_be_downloaded(served: Served) -> None:
    desk, student = served.desk, served.person("S1")
    student.save(right_values(served, "S1"))
    student.upload("bản vẽ.jpg", b"a photo")
    student.hand_in()
    marked(desk)
    links = list(csv.DictReader(io.StringIO(desk.get("/desk/download/links.csv").content.decode("utf-8-sig"))))
    assert [row["id"] for row in links] == ["S1", "S2", "S3"]
    assert links[0]["link"] == served.site.link("S1")
    for name in ("feedback.pdf", "class.pdf"):
        assert desk.get(f"/desk/download/{name}").content.startswith(b"%PDF")
    names = zipfile.ZipFile(io.BytesIO(desk.get("/desk/download/class.zip").content)).namelist()
    assert {"spec.yaml", "roster.csv", "variants/S1.yaml", "handed/S1/answers.xlsx", "marked/grades.csv"} <= {*names}
    assert "handed/S1/00001-bản vẽ.jpg" in names
    assert not [name for name in names if name.startswith("server")], "no secret leaves the server"
    worksheet = (
        "Identifier,Full name,ID number,Status,Grade,Maximum Grade,Feedback comments\r\n"
        "Participant 1,An Nguyễn,S1,Submitted,,10.00,\r\nParticipant 2,Bình Lê,S2,Submitted,,10.00,\r\n"
    )
    form = {"column": "", "csrf": desk.token}
    filled = desk.client.post("/desk/gradebook", data=form, files={"file": ("worksheet.csv", worksheet.encode())})
    assert filled.status_code == 200, filled.text
    rows = list(csv.DictReader(io.StringIO(filled.content.decode("utf-8-sig"))))
    assert [row["Grade"] for row in rows] == ["10.00", ""]
    # Without id and e-mail the name counts; who has no row is named.
    for name, grades, told in (("An Nguyễn", ["10.00", ""], False), ("An Nguyen", ["", ""], True)):
        named = worksheet.replace("S1", "").replace("An Nguyễn", name)
        filled = desk.client.post("/desk/gradebook", data=form, files={"file": ("worksheet.csv", named.encode())})
        rows = list(csv.DictReader(io.StringIO(filled.content.decode("utf-8-sig"))))
        assert [row["Grade"] for row in rows] == grades
        assert ("An Nguyễn" in unquote(filled.headers["x-problems"])) == told
    wrong = desk.client.post("/desk/gradebook", data=form, files={"file": ("other.csv", b"a,b\r\n1,2\r\n")})
    assert (wrong.status_code, bool(wrong.json()["lines"])) == (400, True)


def test_the_files_of_a_student_tell_no_answer(served: Served) -> None:
    student = served.person("S1")
    right = right_values(served, "S1")
    # Where the machine stands is drawn; its velocities are not.
    answers = {text for (id, _), text in right.items() if "v." in id and id[:4] != "dir." and len(text) > 4}
    assert answers
    machine = student.get("/me/files/machine.html")
    assert machine.status_code == 200
    assert "sandbox" in machine.headers["content-security-policy"]
    assert "<svg" in machine.text
    sheet = student.get("/me/sheet").text
    data = student.get("/me/files/assignment.yaml").text
    for answer in answers:
        for text in (sheet, data, machine.text):
            assert not re.search(rf"(?<![\d.]){re.escape(answer)}(?![\d])", text)
    assert student.get("/me/files/task.pdf").content.startswith(b"%PDF")


def test_without_self_check_a_student_does_not_get_the_data(served: Served) -> None:
    student = served.person("S1")
    assert "/me/files/assignment.yaml" in student.open("/me").text
    assert student.get("/me/files/assignment.yaml").status_code == 200
    policy(served, "self_check: false\n")
    assert "/me/files/assignment.yaml" not in student.open("/me").text
    assert student.get("/me/files/assignment.yaml").status_code == 404


def test_who_can_still_hand_in_does_not_see_the_marks(served: Served) -> None:
    student, late, desk = served.person("S1"), served.person("S2"), served.desk
    served.site.store.put_marks({name: ("10", {"mark": 10, "files": []}) for name in ("S1", "S2")})
    desk.post("/desk/students/S2/deadline", {"closes": local(1)})
    desk.post("/desk/release", {"released": True})
    assert (student.get("/me/result").status_code, student.json("/me/state")["open"]) == (200, False)
    assert student.save({student.places[0]: "1"}).json()["error"] == "closed"
    assert late.save({late.places[0]: "1"}).status_code == 200
    assert not late.json("/me/state")["released"]
    for path in ("/me/result", "/me/result/feedback.pdf"):
        assert late.get(path).json()["error"] == "not_released"
    policy(served, f"browser: {{closes: {local(1)}}}\n")
    assert student.get("/me/result").json()["error"] == "not_released"
    policy(served, f"browser: {{closes: {local(-1)}}}\n")
    desk.post("/desk/students/S2/deadline", {"closes": None})
    assert late.json("/me/result")["mark"] == 10
    policy(served, "")
    desk.post("/desk/release", {"released": False})
    assert student.save({student.places[0]: "1"}).status_code == 200


def test_a_photo_does_not_outweigh_saved_cells(served: Served) -> None:
    store, about = served.site.store, {"drawn": "1", "size": 1, "sha256": "0" * 64}
    served.folder.add_upload(b"a", "0" * 64)
    store.add_upload("S1", "upload-01", {**about, "name": "photo.jpg"}, Window(None), None)
    (saved,) = store.save("S1", "1", [TypedCell("client-01", "v.B", 2, "1")], Window(None))
    assert handed.counted_cells(store, "1", "S1") == ({}, ""), "it may have values"
    store.settle_upload(1, "kept", 0, [])
    assert handed.counted_cells(store, "1", "S1") == ({("v.B", 2): "1"}, saved.at)
    # What counts was saved after the photo came.
    put_handed_roster(served.site)
    rows = list(csv.DictReader(io.StringIO(served.folder.handed_roster.read_text("utf-8-sig"))))
    local_time = datetime.datetime.fromisoformat(saved.at).astimezone()
    assert rows[0]["handed_in"] == f"{local_time:%Y-%m-%d %H:%M:%S}"
    store.settle_upload(1, "read", 3, [])
    assert handed.counted_cells(store, "1", "S1") == ({}, "")


@pytest.mark.parametrize("text", [None, "kind: slider-crank\n"], ids=["missing", "invalid"])
def test_one_bad_variant_does_not_stop_the_marking_of_the_others(served: Served, text: str | None) -> None:
    for folder in ("S1", "S2"):
        served.person(folder).save(right_values(served, folder))
    served.folder.assignment("S1").unlink()
    if text is not None:
        served.folder.assignment("S1").write_text(text, "utf-8")
    table = marked(served.desk)
    assert table["S2"]["mark"] == 10
    assert any("S1" in problem for problem in table["problems"])


def test_who_left_the_class_outside_of_the_server_cannot_sign_in(made_class: Path, tmp_path: Path) -> None:
    with Served.copied(made_class, tmp_path / "class") as served:
        gone, off = served.site.link("S1"), served.site.link("S3")
        folder = served.folder
    make_variants(folder.spec, folder.roster, folder.variants, language="en", drop=["S1"])
    folder.roster.write_text("".join(line for line in ROSTER.splitlines(True) if "S3" not in line), "utf-8")
    with Served.of(tmp_path / "class") as again:
        assert set(again.site.store.people()) == {DESK, "S2"}
        for link in (gone, off):
            assert "/me" not in again.stranger().get(link.removeprefix(ADDRESS)).text
        assert again.person("S2").places
    # Who is in the roster again has the old link.
    folder.roster.write_text(ROSTER, "utf-8")
    with Served.of(tmp_path / "class") as again:
        assert set(again.site.store.people()) == {DESK, "S2", "S3"}
        assert again.site.link("S3") == off


def test_what_waited_when_the_server_ended_is_done_by_the_next(made_class: Path, tmp_path: Path) -> None:
    with Served.copied(made_class, tmp_path / "class") as served:
        student = served.person("S1")
        student.save(right_values(served, "S1"))
        student.hand_in()
        served.site.store.add_upload(
            "S1",
            "upload-01",
            {"drawn": "1", "name": "a.pdf", "size": 1, "sha256": served.folder.add_upload(b"a", "f" * 64).name},
            served.site.window(served.site.links.of_cookie(student.client.cookies[served.site.cookie])),  # type: ignore[arg-type]
            None,
        )
    for file in (served.folder.handed / "S1").iterdir():
        file.unlink()
    with Served.of(tmp_path / "class") as again:
        student = again.person("S1")
        end = time.monotonic() + 20
        while student.json("/me/uploads/1")["state"] == "queued" and time.monotonic() < end:
            time.sleep(0.05)
        assert student.json("/me/uploads/1")["state"] == "kept"
        while len(list((again.folder.handed / "S1").iterdir())) < 2 and time.monotonic() < end:
            time.sleep(0.05)
        assert {file.name for file in (again.folder.handed / "S1").iterdir()} == {"answers.xlsx", "00001-a.pdf"}


def test_files_that_the_server_did_not_write_stay(served: Served) -> None:
    student, own = served.person("S1"), served.folder.handed / "S1"
    own.mkdir(parents=True, exist_ok=True)
    (own / "answers.xlsx").write_bytes(b"from the command line")
    (own / "late.pdf").write_bytes(b"from the instructor")
    asyncio.run(handed.lay_out(served.site, "S1"))
    assert {file.name for file in own.iterdir()} == {"answers.xlsx", "late.pdf"}
    student.save({student.places[0]: "1"})
    for _ in range(2):
        asyncio.run(handed.lay_out(served.site, "S1"))
    assert {file.name for file in own.iterdir()} == {"answers.xlsx", "answers-1.xlsx", "late.pdf"}
    assert (own / "answers-1.xlsx").read_bytes() == b"from the command line"
    # The server replaces and removes its own sheet.
    student.save({student.places[0]: "2"})
    asyncio.run(handed.lay_out(served.site, "S1"))
    assert len(list(own.iterdir())) == 3
    served.site.store.change_person("S1", {"drawn": "2"})
    asyncio.run(handed.lay_out(served.site, "S1"))
    assert {file.name for file in own.iterdir()} == {"answers-1.xlsx", "late.pdf"}


def test_an_upload_that_the_disk_did_not_take_is_read_later(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    student, put = served.person("S1"), handed._put_upload
    failed, locked = [], []

    def full_once(site: Site, row: Row[Any]) -> Path:
        locked.append(site.laying["S1"].locked())
        if not failed:
            failed.append(row)
            raise OSError(28, "No space left on device")
        return put(site, row)

    monkeypatch.setattr(handed, "_put_upload", full_once)
    monkeypatch.setattr(handed, "AGAIN", 0.01, raising=False)
    student.upload("photo.jpg", b"a photo")
    end = time.monotonic() + 10
    while student.json("/me/state")["uploads"][0]["state"] == "queued" and time.monotonic() < end:
        time.sleep(0.02)
    assert student.json("/me/state")["uploads"][0]["state"] == "kept"
    assert (served.folder.handed / "S1" / "00001-photo.jpg").read_bytes() == b"a photo"
    assert locked == [True, True]


def test_sheets_of_a_large_class_are_made_while_it_is_served(
    made_class: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "FEW", 2)
    beside = made_class.with_name("class-files")
    make_class(tmp_path / "class", *(beside / name for name in ("spec.yaml", "roster.csv", "policy.yaml")), "en")
    folder = ClassFolder(tmp_path / "class")
    assert [folder.sheet(student) for student in ("S1", "S2", "S3")] == [None] * 3
    with Served.of(folder.path) as served:
        # Nobody has to wait for the others.
        assert served.person("S2").places
        asyncio.run(handed.prepare_all(served.site))
        assert all(folder.sheet(student) for student in ("S1", "S2", "S3"))
        monkeypatch.setattr(work, "open_case", None)
        upload = folder.path / "answers.csv"
        upload.write_bytes(b"Assignment,S3\r\nid,Value\r\nv.B,1.5\r\n")
        assert work.read_upload(folder, "S3", upload)[:2] == ("read", 1), "its key is there"


def test_papers_that_take_long_come_by_themselves(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    desk, run, gate = served.desk, served.site.queue.run, threading.Event()

    async def slow(function: Any, *arguments: Any, kind: str = "short") -> Any:
        if kind != "class":
            return await run(function, *arguments)
        await run_in_threadpool(gate.wait, 20)
        served.folder.tasks.mkdir()
        return (served.folder.tasks / "tasks.pdf").write_bytes(b"%PDF")

    monkeypatch.setattr(served.site.queue, "run", slow)
    monkeypatch.setattr(downloads, "SOON", 0.01)
    waiting = desk.open("/desk/download/tasks.pdf")
    assert waiting.status_code == 202
    assert 'http-equiv="refresh"' in waiting.text
    gate.set()
    end = time.monotonic() + 20
    while (answer := desk.open("/desk/download/tasks.pdf")).status_code == 202 and time.monotonic() < end:
        time.sleep(0.02)
    assert answer.content == b"%PDF"


def test_an_instructor_hears_of_a_clock_in_doubt(
    served: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert served.desk.json("/desk/table")["clock"] is None
    later = databases.wall_time() + datetime.timedelta(days=400)
    monkeypatch.setattr(databases, "wall_time", lambda: later)
    policy(served, f"browser: {{closes: {local(1)}}}\n")
    with Served.of(served.folder.path) as again:
        desk, student = again.desk, again.person("S1")
        assert desk.json("/desk/table")["clock"]["now"] == later.isoformat()
        assert student.json("/me/state")["open"]
        assert desk.post("/desk/clock").json() == {"clock": None}
        assert desk.json("/desk/table")["clock"] is None
        assert not student.json("/me/state")["open"]


def test_a_receipt_that_was_lost_is_given_again_after_the_deadline(served: Served) -> None:
    student = served.person("S1")
    first = student.upload("a.pdf", b"a", "upload-01").json()
    policy(served, f"browser: {{closes: {local(-1)}}}\n")
    again = student.upload("a.pdf", b"a", "upload-01")
    assert again.status_code == 200
    assert [again.json()[name] for name in ("number", "at", "sha256")] == [
        first[name] for name in ("number", "at", "sha256")
    ]
    assert student.upload("a.pdf", b"a", "upload-02").json()["error"] == "closed"


def test_a_time_before_the_last_is_never_on_a_receipt(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    student = served.person("S1")
    first = student.upload("a.pdf", b"a").json()["at"]
    past = databases.wall_time() - datetime.timedelta(days=3)
    monkeypatch.setattr(databases, "wall_time", lambda: past)
    assert student.upload("b.pdf", b"b").json()["at"] > first
