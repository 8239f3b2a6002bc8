"""Who gets in: those with a link or a code, until it ends."""

from __future__ import annotations

import datetime
import re
from pathlib import Path

import pytest

from reportgen.server import database as databases
from reportgen.server.database import Database
from reportgen.server.links import DESK, SESSION, Links
from tests.server.served import ADDRESS, Served


def path_of(served: Served, folder: str) -> str:
    return served.site.link(folder).removeprefix(ADDRESS)


def test_a_link_opens_the_own_page(served: Served) -> None:
    student = served.person("S1")
    assert "An Nguyễn" in student.page
    assert student.get("/").headers["location"] == "/me"
    assert served.desk.get("/").headers["location"] == "/desk"


def test_the_cookie_is_for_this_site_and_not_for_scripts(served: Served) -> None:
    answer = served.stranger().get(path_of(served, "S1"))
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    # A strict cookie does not come along a redirect that began on another site, such as a page of mail.
    assert answer.status_code == 200
    assert 'http-equiv="refresh"' in answer.text


def test_id_and_code_do_the_same(served: Served) -> None:
    code = served.site.links.code("S1")
    stranger = served.stranger()
    answer = stranger.post("/in", data={"id": " s1 ", "code": f"{code[:5].upper()} {code[5:]}"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/me")
    assert stranger.get("/me").status_code == 200
    assert served.stranger().post("/in", data={"id": "S2", "code": code}).status_code == 403


@pytest.mark.parametrize("change", ["forged", "cut", "signature", "nothing", "long", "bytes"])
def test_a_changed_link_is_none(served: Served, change: str) -> None:
    token = served.site.links.token("S1")
    head, _, signature = token.partition(".")
    other = served.site.links.token("S2").partition(".")[0]
    wrong = {
        "forged": f"{other}.{signature}",
        "cut": token[:-1],
        "signature": head,
        "nothing": ".a",
        "long": "a" * 5000,
        "bytes": "%ff%00.%ff",
    }[change]
    stranger = served.stranger()
    answer = stranger.get(f"/in/{wrong}")
    assert answer.status_code == 403
    assert "set-cookie" not in answer.headers
    assert stranger.get("/me").status_code == 401


def test_a_new_link_ends_the_old_one_its_code_and_its_sessions(served: Served) -> None:
    student, old, code = served.person("S1"), path_of(served, "S1"), served.site.links.code("S1")
    made = served.desk.post("/desk/students/S1/link", {"renew": True}).json()
    assert made["link"].removeprefix(ADDRESS) != old
    assert student.get("/me").status_code == 401
    assert served.stranger().get(old).status_code == 403
    assert served.stranger().post("/in", data={"id": "S1", "code": code}).status_code == 403
    assert served.stranger().get(made["link"].removeprefix(ADDRESS)).status_code == 200


def test_a_cookie_ends_with_its_session(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    student = served.person("S1")
    cookie = student.client.cookies[served.site.cookie]
    assert student.client.post("/out", data={"csrf": student.token}).status_code == 303
    replayed = served.stranger()
    replayed.cookies.set(served.site.cookie, cookie)
    assert replayed.get("/me").status_code == 401
    second = served.person("S1")
    later = databases.wall_time() + SESSION + datetime.timedelta(minutes=1)
    monkeypatch.setattr(databases, "wall_time", lambda: later)
    assert second.get("/me").status_code == 401


def test_a_forged_cookie_is_none(served: Served) -> None:
    cookie = served.person("S1").client.cookies[served.site.cookie]
    for wrong in (cookie[:-1], cookie.partition(".")[0], f"x{cookie}", "é", ""):
        stranger = served.stranger()
        stranger.cookies.set(served.site.cookie, wrong.encode("ascii", "replace").decode())
        assert stranger.get("/me").status_code == 401


def test_classes_at_one_address_do_not_share_cookies_or_unsent_cells(served: Served, tmp_path: Path) -> None:
    database = Database(tmp_path / "other")
    other = Links(database, tmp_path / "other").class_id
    database.close()
    student = served.person("S1")
    # A browser sends the cookie of a server at another port of the host too.
    student.client.cookies.set(f"reportgen-{other}", "a session of the other class")
    assert student.open("/me").status_code == 200
    (owner,) = re.findall('data-owner="(.*?)"', student.page)
    assert owner.startswith(f"{served.site.links.class_id}:")
    assert served.site.links.class_id != other


def test_who_has_left_gets_in_no_more(served: Served) -> None:
    student, link = served.person("S1"), path_of(served, "S1")
    assert served.desk.post("/desk/students/S1/drop").status_code == 200
    assert student.get("/me").status_code == 401
    assert served.stranger().get(link).status_code == 403
    assert [row["id"] for row in served.desk.json("/desk/table")["students"]] == ["S2", "S3"]


def test_codes_cannot_be_tried_at_will(served: Served) -> None:
    code = served.site.links.code("S1")
    statuses = [
        served.stranger().post("/in", data={"id": "S1", "code": f"wrong{number}"}).status_code for number in range(25)
    ]
    assert statuses[:20] == [403] * 20
    assert set(statuses[20:]) == {429}
    assert served.stranger().post("/in", data={"id": "S1", "code": code}).status_code == 429
    # The link is not a guess, and nobody else is kept out.
    assert served.stranger().get(path_of(served, "S1")).status_code == 200
    own = served.site.links.code("S2")
    assert served.stranger().post("/in", data={"id": "S2", "code": own}).status_code == 303


def test_a_class_behind_one_address_signs_in_at_once(served: Served) -> None:
    assert {served.stranger().get(path_of(served, "S1")).status_code for _ in range(100)} == {200}


def test_links_are_never_in_the_log(served: Served, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", "reportgen.server")
    path = path_of(served, DESK)
    served.stranger().get(path)
    served.stranger().get(f"{path}x")
    said = "\n".join(record.getMessage() for record in caplog.records)
    assert "GET /in/{token} 200" in said
    assert path.rpartition("/")[2][:10] not in said
