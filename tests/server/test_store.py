"""What is stored stays: once, in its order, at times that never go back, in every version of the tables."""

from __future__ import annotations

import datetime
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from reportgen.server import database as databases
from reportgen.server.backups import back_up
from reportgen.server.class_folder import ClassFolder
from reportgen.server.database import Clock, Database
from reportgen.server.links import Links
from reportgen.server.serving import forget_class
from reportgen.server.store import ClosedError, Store, TypedCell, UsedUpError, Window
from reportgen.server.tables import metadata
from tests.server.served import ADDRESS, Served

ALWAYS = Window(None)
OVER = Window(datetime.datetime(2020, 1, 1).astimezone())


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    database = Database(tmp_path)
    Links(database, tmp_path).add("S1", "student", "S1", "An", "1")
    yield Store(database)
    database.close()


def texts(store: Store) -> list[str]:
    return [row.text for row in store.cells("S1", "1")]


def test_a_cell_that_is_sent_again_is_stored_once(store: Store) -> None:
    first = store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1.5")], ALWAYS)
    store.save("S1", "1", [TypedCell("client-2", "v.B", 2, "1.6")], ALWAYS)
    again = store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1.5")], ALWAYS)
    assert [(one.at, one.revision) for one in again] == [(one.at, one.revision) for one in first]
    assert texts(store) == ["1.6"], "what was sent late again does not replace what was typed since"
    # The browser did not hear that it was saved: it is told so, even when the time is over.
    assert store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1.5")], OVER)[0].revision == first[0].revision


def test_the_cells_of_one_message_are_stored_together_or_not_at_all(store: Store) -> None:
    store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1")], ALWAYS)
    with pytest.raises(ClosedError):
        store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1"), TypedCell("client-2", "v.C", 2, "2")], OVER)
    assert texts(store) == ["1"]


def test_writers_at_once_lose_nothing(store: Store) -> None:
    def write(number: int) -> None:
        for k in range(20):
            store.save("S1", "1", [TypedCell(f"client-{number}-{k}", f"v.{number}", k, str(k))], ALWAYS)

    threads = [threading.Thread(target=write, args=(number,)) for number in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    rows = store.cells("S1", "1")
    assert len(rows) == 100
    assert sorted(row.revision for row in rows) == list(range(1, 101))


def test_the_sheet_of_a_hand_in_is_the_one_of_its_moment(store: Store) -> None:
    store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1")], ALWAYS)
    sheet = {"revision": 1, "filled": 1, "sha256": "0" * 64}
    row = store.hand_in("S1", "hand-in-1", "1", sheet, ALWAYS)
    store.save("S1", "1", [TypedCell("client-2", "v.B", 2, "2")], ALWAYS)
    assert store.hand_in("S1", "hand-in-1", "1", sheet, OVER).number == row.number
    assert store.cells_at("S1", "1", row.revision) == {("v.B", 2): "1"}


def test_uploads_and_checks_are_counted_once(store: Store) -> None:
    about = {"drawn": "1", "name": "a.pdf", "size": 1, "sha256": "0" * 64}
    first = store.add_upload("S1", "upload-01", about, ALWAYS, 1)
    assert store.add_upload("S1", "upload-01", about, ALWAYS, 1).number == first.number
    with pytest.raises(UsedUpError):
        store.add_upload("S1", "upload-02", about, ALWAYS, 1)
    assert store.begin_check("S1", "check-01", "{}", ALWAYS, 1).answer == ""
    store.end_check("S1", "check-01", "answer")
    assert store.begin_check("S1", "check-01", "[]", ALWAYS, 1)[3:5] == ("{}", "answer")
    with pytest.raises(UsedUpError):
        store.begin_check("S1", "check-02", "{}", ALWAYS, 1)


def test_times_do_not_go_back_with_the_clock(store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (first,) = store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1")], ALWAYS)

    yesterday = databases.wall_time() - datetime.timedelta(days=1)
    monkeypatch.setattr(databases, "wall_time", lambda: yesterday)
    reopened = Store(Database(tmp_path))
    (second,) = reopened.save("S1", "1", [TypedCell("client-2", "v.B", 2, "2")], ALWAYS)
    assert second.at > first.at
    # Who waits for the clock to be set back gains no time.
    closed = Window(datetime.datetime.fromisoformat(first.at))
    with pytest.raises(ClosedError):
        reopened.save("S1", "1", [TypedCell("client-3", "v.B", 2, "3")], closed)
    reopened.database.close()


def test_a_clock_never_gives_a_time_before_the_last() -> None:
    future = datetime.datetime.now().astimezone() + datetime.timedelta(hours=1)
    assert Clock(future.isoformat()).now() > future


@pytest.mark.parametrize("days", [400, -400], ids=["ahead", "behind"])
def test_a_clock_in_doubt_closes_nothing(
    store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, days: int
) -> None:
    (first,) = store.save("S1", "1", [TypedCell("client-1", "v.B", 2, "1")], ALWAYS)
    store.database.close()
    real = databases.wall_time()
    monkeypatch.setattr(databases, "wall_time", lambda: real + datetime.timedelta(days=days))
    doubtful = Store(Database(tmp_path))
    assert doubtful.database.clock.doubt is not None
    (second,) = doubtful.save("S1", "1", [TypedCell("client-2", "v.B", 2, "2")], Window(real))
    assert second.at > first.at
    with pytest.raises(ClosedError):
        doubtful.save("S1", "1", [TypedCell("client-3", "v.B", 2, "3")], Window(real - datetime.timedelta(days=500)))
    doubtful.database.close()
    # The clock is set right: the wrong times end nothing later either.
    monkeypatch.setattr(databases, "wall_time", lambda: real + datetime.timedelta(minutes=1))
    again = Store(Database(tmp_path))
    assert again.database.clock.doubt is None
    again.save("S1", "1", [TypedCell("client-4", "v.B", 2, "4")], Window(real + datetime.timedelta(days=1)))
    # Or the instructor says that it was right.
    monkeypatch.setattr(databases, "wall_time", lambda: real + datetime.timedelta(days=days))
    again.database.close()
    confirmed = Store(Database(tmp_path))
    confirmed.database.trust_clock()
    assert confirmed.database.clock.doubt is None
    if days > 0:
        with pytest.raises(ClosedError):
            confirmed.save("S1", "1", [TypedCell("client-5", "v.B", 2, "5")], Window(real))
    confirmed.database.close()
    assert Database(tmp_path).clock.doubt is None


def test_every_transaction_is_synced_to_the_disk(store: Store) -> None:
    with store.database.reading() as connection:
        assert connection.exec_driver_sql("PRAGMA synchronous").scalar() == 2
        assert connection.exec_driver_sql("PRAGMA journal_mode").scalar() == "wal"
        assert connection.exec_driver_sql("PRAGMA foreign_keys").scalar() == 1


def test_the_migrations_make_the_tables_of_the_program(store: Store) -> None:
    from alembic.autogenerate import compare_metadata
    from alembic.migration import MigrationContext

    with store.database.reading() as connection:
        assert compare_metadata(MigrationContext.configure(connection), metadata) == []


def test_an_upload_is_on_the_disk_under_its_hash(tmp_path: Path) -> None:
    folder = ClassFolder(tmp_path)
    target = folder.add_upload(b"content", "abc")
    assert target.read_bytes() == b"content"
    assert folder.add_upload(b"content", "abc") == target
    assert [file.name for file in folder.uploads.iterdir()] == ["abc"]


def test_a_copy_of_a_class_in_use_can_be_served(served: Served, tmp_path: Path) -> None:
    student = served.person("S1")
    place = student.places[0]
    assert student.save({place: "12"}).status_code == 200
    student.upload("photo.jpg", b"a photo")
    made = back_up(served.folder, tmp_path / "copies")
    student.save({place: "13"})
    with Served.of(made) as copy:
        again = copy.person("S1").json("/me/state")
        assert [cell["text"] for cell in again["cells"]] == ["12"]
        assert [upload["name"] for upload in again["uploads"]] == ["photo.jpg"]
        # The links are those that were handed out.
        assert copy.site.link("S1") == served.site.link("S1")


def test_a_server_ends_when_an_upload_is_settled(
    made_class: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settle = Store.settle_upload

    def settle_late(store: Store, *settled: Any) -> None:
        time.sleep(0.3)
        settle(store, *settled)

    monkeypatch.setattr(Store, "settle_upload", settle_late)
    with Served.copied(made_class, tmp_path / "class") as served:
        served.person("S1").upload("photo.jpg", b"a photo of An")
    database = Database(served.folder.server)
    assert [row.state for row in Store(database).uploads()] == ["kept"]
    database.close()


def test_what_is_forgotten_names_nobody(made_class: Path, tmp_path: Path) -> None:
    # A class that is served still writes what was handed in: it is forgotten afterwards, as the command does.
    with Served.copied(made_class, tmp_path / "class") as served:
        student = served.person("S1")
        student.save({student.places[0]: "12"})
        student.upload("photo.jpg", b"a photo of An")
    forget_class(tmp_path / "class")
    left = {file.name for file in (tmp_path / "class").rglob("*") if file.is_file()}
    assert left == {"spec.yaml", "policy.yaml"}


def test_the_database_is_for_its_owner_alone(served: Served) -> None:
    for name in ("class.db", "secret"):
        assert (served.folder.server / name).stat().st_mode & 0o077 == 0
    with closing(sqlite3.connect(served.folder.server / "class.db")) as connection:
        dump = "\n".join(connection.iterdump())
    assert served.site.link("S1").removeprefix(f"{ADDRESS}/in/") not in dump
