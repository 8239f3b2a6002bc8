"""What the server refuses, and tells in the log: others' data, forged messages, path tricks, what is too large."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from reportgen.server import guards
from reportgen.server.class_folder import safe_name
from tests.server.served import ADDRESS, Browser, Served

Try = Callable[[Served, Browser], Any]


def upload_of(served: Served) -> int:
    """The number of a file that another student has sent."""
    number: int = served.person("S2").upload("secret.pdf", b"of S2").json()["number"]
    return number


def cell(browser: Browser, **changed: Any) -> dict[str, Any]:
    id, position = browser.places[0]
    return {"client": "client-01", "id": id, "position": position, "text": "1"} | changed


CELLS = "/me/cells"
OTHERS: dict[str, tuple[int, Try]] = {
    "another's upload": (404, lambda served, own: own.get(f"/me/uploads/{upload_of(served)}")),
    "another's file": (404, lambda served, own: own.get(f"/me/uploads/{upload_of(served)}/file")),
    "another's sheet": (404, lambda served, own: own.get("/desk/students/S2/sheet")),
    "another's assignment": (404, lambda served, own: own.get("/desk/students/S2/file")),
    "the desk": (404, lambda served, own: own.get("/desk")),
    "the table": (404, lambda served, own: own.get("/desk/table")),
    "all links": (404, lambda served, own: own.get("/desk/download/links.csv")),
    "the keys": (404, lambda served, own: own.get("/desk/download/keys.pdf")),
    "the class folder": (404, lambda served, own: own.get("/desk/download/class.zip")),
    "an own extension": (404, lambda served, own: own.post("/desk/students/S1/deadline", {"closes": None})),
    "an own judgement": (404, lambda served, own: own.post("/desk/students/S1/correct", {})),
    "a release": (404, lambda served, own: own.post("/desk/release", {"released": True})),
    "an early result": (409, lambda served, own: own.get("/me/result")),
    "an early feedback": (409, lambda served, own: own.get("/me/result/feedback.pdf")),
    "the key among the own files": (404, lambda served, own: own.get("/me/files/key.pdf")),
    "a report that is not allowed": (404, lambda served, own: own.get("/me/files/report.pdf")),
    "the instructor as a student": (404, lambda served, own: served.desk.get("/me")),
}
FORGED: dict[str, tuple[int, Try]] = {
    "no session": (401, lambda served, own: served.stranger().post(CELLS, json={"cells": []})),
    "no token": (403, lambda served, own: own.client.post(CELLS, json={"cells": [cell(own)]})),
    "another's token": (
        403,
        lambda served, own: own.client.post(
            CELLS, json={"cells": [cell(own)]}, headers={"x-csrf-token": served.person("S2").token}
        ),
    ),
    "no token in a form": (
        403,
        lambda served, own: own.client.post(
            "/me/uploads", data={"client": "client-01"}, files={"file": ("a.pdf", b"a")}
        ),
    ),
    "a form in place of JSON": (
        403,
        lambda served, own: served.desk.client.post("/desk/mark", files={"file": ("a", b"a")}),
    ),
    "another site": (
        403,
        lambda served, own: own.client.post(
            CELLS, json={"cells": [cell(own)]}, headers={"x-csrf-token": own.token, "origin": "http://evil.example"}
        ),
    ),
    "another page of the machine": (
        403,
        lambda served, own: own.client.post(
            CELLS, json={"cells": [cell(own)]}, headers={"x-csrf-token": own.token, "sec-fetch-site": "cross-site"}
        ),
    ),
    "another name of the server": (403, lambda served, own: own.client.get("/me", headers={"host": "evil.example"})),
    "another method": (400, lambda served, own: own.client.put(CELLS, json={})),
}
PATHS: dict[str, tuple[int, Try]] = {
    "up from the scripts": (404, lambda served, own: own.get("/static/..%2f..%2fpyproject.toml")),
    "a template": (404, lambda served, own: own.get("/static/base.html.j2")),
    "a folder": (404, lambda served, own: own.get("/static/")),
    "a script with a long name": (404, lambda served, own: own.get(f"/static/{'x' * 300}.js")),
    "up from the own files": (404, lambda served, own: own.get("/me/files/..%2f..%2froster.csv")),
    "up from the result": (404, lambda served, own: own.get("/me/result/..%2f..%2froster.csv")),
    "up from a student": (404, lambda served, own: served.desk.get("/desk/students/..%2f..%2fetc/file")),
    "up from a download": (404, lambda served, own: served.desk.get("/desk/download/..%2fserver%2fsecret")),
    "the secret": (404, lambda served, own: served.desk.get("/desk/download/secret")),
    "no number": (404, lambda served, own: own.get("/me/uploads/x")),
    "a huge number": (400, lambda served, own: own.get("/me/state?since=" + "9" * 400)),
    "a back door by language": (
        303,
        lambda served, own: own.client.post("/language", data={"language": "en", "back": "//evil.example/"}),
    ),
}
MALFORMED: dict[str, tuple[int, Try]] = {
    "no JSON": (400, lambda served, own: own.client.post(CELLS, content=b"{", headers=head(own))),
    "a list": (400, lambda served, own: own.client.post(CELLS, content=b"[]", headers=head(own))),
    "deep": (400, lambda served, own: own.client.post(CELLS, content=b"[" * 100_000, headers=head(own))),
    "text": (400, lambda served, own: own.client.post(CELLS, content=b"{}", headers={"x-csrf-token": own.token})),
    "no cells": (400, lambda served, own: own.post(CELLS, {"cells": []})),
    "too many": (400, lambda served, own: own.post(CELLS, {"cells": [cell(own)] * 201})),
    "a short name": (400, lambda served, own: own.post(CELLS, {"cells": [cell(own, client="x")]})),
    "a wild name": (400, lambda served, own: own.post(CELLS, {"cells": [cell(own, client="'; drop table cells")]})),
    "a number": (400, lambda served, own: own.post(CELLS, {"cells": [cell(own, text=1.5)]})),
    "a truth": (400, lambda served, own: own.post(CELLS, {"cells": [cell(own, position=True)]})),
    "an earlier variant": (409, lambda served, own: own.post(CELLS, {"variant": "0", "cells": [cell(own)]})),
    "too large": (413, lambda served, own: own.client.post(CELLS, content=b"x" * 400_000, headers=head(own))),
    "no file": (
        400,
        lambda served, own: own.client.post("/me/uploads", data={"client": "client-01", "csrf": own.token}),
    ),
}


def head(browser: Browser) -> dict[str, str]:
    return {"x-csrf-token": browser.token, "content-type": "application/json"}


@pytest.mark.parametrize("what", [*OTHERS, *FORGED, *PATHS, *MALFORMED])
def test_it_is_refused(served: Served, caplog: pytest.LogCaptureFixture, what: str) -> None:
    status, attempt = {**OTHERS, **FORGED, **PATHS, **MALFORMED}[what]
    own = served.person("S1")
    caplog.set_level("INFO", "reportgen.server")
    answer = attempt(served, own)
    assert answer.status_code == status, answer.text
    if status == 303:
        assert answer.headers["location"] == "/"
        return
    assert set(answer.json()) >= {"error", "message"}
    assert "Traceback" not in answer.text
    assert str(served.folder.path) not in answer.text
    assert any(record.levelname == "WARNING" for record in caplog.records) or status == 409
    assert served.person("S1").json("/me/state")["cells"] == []


def test_a_cell_that_nobody_asks_for_does_not_keep_the_others(served: Served) -> None:
    own = served.person("S1")
    sent = [
        cell(own, client="client-01", id="M.eq", position=99),
        cell(own, client="client-02", text="9" * 61),
        cell(own, client="client-03", text=" 1,5\x00\n"),
    ]
    answer = own.post(CELLS, {"cells": sent}).json()
    assert [(one["client"], one["error"]) for one in answer["refused"]] == [
        ("client-01", "unknown"),
        ("client-02", "too_large"),
    ]
    assert all(one["message"] for one in answer["refused"])
    assert [one["client"] for one in answer["saved"]] == ["client-03"]
    assert [one["text"] for one in own.json("/me/state")["cells"]] == ["1,5"]


def test_an_upload_that_is_too_large_is_not_kept(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guards, "LARGE", 100_000)
    own = served.person("S1")
    answer = own.upload("large.pdf", b"x" * 500_000)
    assert (answer.status_code, answer.json()["error"]) == (413, "file_too_large")
    assert "50 MB" in answer.json()["message"]
    # The page knows it before it sends the file.
    assert re.search(r'id="upload"[^>]* data-largest="\d+"', own.page)

    def pieces() -> Any:
        yield from (b"x" * 50_000 for _ in range(20))

    # Without its length said, it is counted while it comes.
    headers = {"x-csrf-token": own.token, "content-type": "multipart/form-data; boundary=x"}
    assert own.client.post("/me/uploads", content=pieces(), headers=headers).status_code == 413
    assert own.json("/me/state")["uploads"] == []
    assert not served.folder.uploads.exists()


def test_a_name_is_text_on_every_page(served: Served) -> None:
    desk = served.desk
    name = "<script>alert(1)</script>"
    answer = desk.post("/desk/students", {"id": "S4", "name": name})
    assert answer.status_code == 200, answer.text
    student = served.person("S4")
    student.upload('"><img src=x onerror=alert(1)>.pdf', b"a")
    for browser, path in ((student, "/me"), (desk, "/desk"), (desk, "/desk/students/S4")):
        page = browser.open(path)
        assert "<script>alert" not in page.text
        assert "<img src=x" not in page.text
        policy = page.headers["content-security-policy"]
        assert "unsafe" not in policy
        assert "default-src 'none'" in policy


def test_an_upload_comes_back_as_a_file_not_as_a_page(served: Served) -> None:
    own = served.person("S1")
    number = own.upload("page.html", b"<script>alert(1)</script>").json()["number"]
    answer = own.get(f"/me/uploads/{number}/file")
    assert answer.content == b"<script>alert(1)</script>"
    assert answer.headers["content-type"] == "application/octet-stream"
    assert answer.headers["content-disposition"].startswith("attachment")
    assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("../../etc/passwd", "passwd"),
        ("C:\\Users\\An\\bản vẽ.dxf", "bản vẽ.dxf"),
        ("a\x00b\n.pdf", "a_b_.pdf"),
        ('a"<>|?*.pdf', "a______.pdf"),
        ("..", "file"),
        ("", "file"),
        ("x" * 300 + ".docx", "x" * 75 + ".docx"),
    ],
)
def test_a_name_of_a_file_names_no_place(name: str, safe: str) -> None:
    assert safe_name(name) == safe


def test_nothing_unexpected_is_shown(
    served: Served, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    own = served.person("S1")

    def breaks(*_: object, **__: object) -> None:
        raise ZeroDivisionError("the secret of the server")

    monkeypatch.setattr(served.site.store, "save", breaks)
    answer = own.save({own.places[0]: "1"})
    assert (answer.status_code, answer.json()["error"]) == (500, "failed")
    assert "secret" not in answer.text
    assert "ZeroDivisionError" in caplog.text


def test_a_full_disk_is_said_and_nothing_is_half_saved(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    own = served.person("S1")

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("reportgen.server.class_folder.os.fsync", full)
        answer = own.upload("photo.jpg", b"a photo", "upload-01")
        assert (answer.status_code, answer.json()["error"]) == (507, "no_room")
    assert own.json("/me/state")["uploads"] == []
    assert list(served.folder.uploads.iterdir()) == []
    assert own.upload("photo.jpg", b"a photo", "upload-01").status_code == 200


def test_the_answers_say_nothing_of_the_server(served: Served) -> None:
    answer = served.stranger().get("/", headers={"accept": "text/html"})
    assert answer.status_code == 200
    assert "server" not in answer.headers
    assert ADDRESS not in answer.text
    assert 'src="http' not in answer.text
