"""Large files pass through the server in pieces, and nobody can fill its memory or its disk with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.server import student
from reportgen.server.guards import RateLimit
from tests.server.served import Served


def test_an_upload_is_never_read_whole_from_the_disk(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    read, large = Path.read_bytes, list[Path]()

    def seen(path: Path) -> bytes:
        large.extend([path] * (path.parent in (served.folder.uploads, served.folder.marked / "S1")))
        return read(path)

    monkeypatch.setattr(Path, "read_bytes", seen)
    own = served.person("S1")
    number = own.upload("photo.jpg", b"a photo").json()["number"]
    answer = own.get(f"/me/uploads/{number}/file")
    assert (answer.content, answer.headers["content-type"]) == (b"a photo", "application/octet-stream")
    assert answer.headers["content-disposition"] == "attachment; filename*=UTF-8''photo.jpg"
    result = served.folder.marked / "S1" / "feedback.pdf"
    result.parent.mkdir(parents=True)
    result.write_bytes(b"%PDF")
    served.site.store.put_marks({"S1": ("5", {"files": ["feedback.pdf"]})})
    served.site.store.put_setting("released", "yes")
    answer = own.get("/me/result/feedback.pdf")
    assert (answer.content, answer.headers["content-type"]) == (b"%PDF", "application/pdf")
    assert answer.headers["content-disposition"].startswith("inline")
    assert not large
    assert [file.name for file in served.folder.path.rglob("*.part")] == []


def test_uploads_of_a_student_are_limited_together(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(student, "MOST_BYTES", 10)
    own = served.person("S1")
    assert own.upload("a.pdf", b"12345", "client-a1").status_code == 200
    assert own.upload("b.pdf", b"123456").status_code == 413
    assert own.upload("a.pdf", b"12345", "client-a1").status_code == 200
    assert own.upload("c.pdf", b"54321").status_code == 200
    assert served.person("S2").upload("d.pdf", b"12345").status_code == 200


def test_who_sends_files_too_often_is_refused_before_they_are_read(served: Served) -> None:
    own = served.person("S1")
    served.site.files = RateLimit(0, 60)
    headers = {"x-csrf-token": own.token, "content-type": "multipart/form-data; boundary=x"}
    # A form that cannot be read is not looked at.
    assert own.client.post("/me/uploads", content=b"no form", headers=headers).status_code == 429
