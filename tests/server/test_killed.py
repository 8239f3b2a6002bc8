"""A server that is killed at any moment has every cell and upload that it confirmed, each of them once."""

from __future__ import annotations

import hashlib
import shutil
import sqlite3
import threading
from collections import Counter
from contextlib import closing
from pathlib import Path

import httpx2

from tests.lanes import proof
from tests.server.running import free_port, running, token_in

ROUNDS, STUDENTS = 6, ("S1", "S2", "S3")


class Typist:
    """A student who types and sends files until the server is gone; `confirmed` is what the server said it has.

    What was not confirmed is sent again, by the same name, in the next round.
    """

    def __init__(self, link: str) -> None:
        self.link = link
        self.confirmed: dict[str, str] = {}
        self.files: dict[str, str] = {}
        self.pending: tuple[str, str] | None = None
        self.count = 0

    def run(self, address: str) -> None:
        try:
            with httpx2.Client(base_url=address, timeout=30) as client:
                client.get(self.link)
                head = {"x-csrf-token": token_in(client.get("/me").text)}
                places = [
                    (row["id"], cell["position"])
                    for section in client.get("/me/sheet").json()["sections"]
                    for row in section["rows"]
                    for cell in row["cells"]
                    if cell["open"]
                ]
                while True:
                    self._type(client, head, places)
                    if self.count % 10 == 0:
                        self._send(client, head)
        except (httpx2.HTTPError, OSError):
            return

    def _type(self, client: httpx2.Client, head: dict[str, str], places: list[tuple[str, int]]) -> None:
        if self.pending is None:
            self.count += 1
            self.pending = f"cell-{self.count:06}", f"{self.count}"
        name, text = self.pending
        id, position = places[int(text) % len(places)]
        sent = {"client": name, "id": id, "position": position, "text": text}
        answer = client.post("/me/cells", json={"cells": [sent]}, headers=head)
        if answer.status_code == 200:
            (saved,) = answer.json()["saved"]
            self.confirmed[saved["client"]] = text
            self.pending = None

    def _send(self, client: httpx2.Client, head: dict[str, str]) -> None:
        content = f"{self.link} {self.count}".encode()
        form = {"client": f"file-{self.count:06}"}
        answer = client.post("/me/uploads", data=form, files={"file": ("photo.jpg", content)}, headers=head)
        if answer.status_code == 200:
            receipt = answer.json()
            assert receipt["sha256"] == hashlib.sha256(content).hexdigest()
            self.files[receipt["client"]] = receipt["sha256"]


@proof
def test_nothing_confirmed_is_lost_and_nothing_is_there_twice(made_class: Path, tmp_path: Path) -> None:
    folder = tmp_path / "class"
    shutil.copytree(made_class, folder)
    typists: dict[str, Typist] = {}
    for number in range(ROUNDS):
        with running(folder, free_port()) as server:
            for id, link in server.links():
                known = typists.setdefault(id, Typist(""))
                known.link = link
            threads = [threading.Thread(target=typist.run, args=(server.address,)) for typist in typists.values()]
            for thread in threads:
                thread.start()
            threads[0].join(0.6 + 0.35 * number)
            server.kill()
            for thread in threads:
                thread.join()
    assert set(typists) == set(STUDENTS)
    with closing(sqlite3.connect(folder / "server" / "class.db")) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        for id, typist in typists.items():
            assert len(typist.confirmed) > ROUNDS
            rows = connection.execute("SELECT client, text FROM saves WHERE folder = ?", (id,)).fetchall()
            assert max(Counter(client for client, _ in rows).values()) == 1
            stored = dict(rows)
            assert typist.confirmed.items() <= stored.items()
            # At most the one cell that was under way is there without having been confirmed.
            assert len(stored) - len(typist.confirmed) <= 1
            files = dict(connection.execute("SELECT client, sha256 FROM uploads WHERE folder = ?", (id,)).fetchall())
            assert typist.files.items() <= files.items()
            for sha256 in files.values():
                content = (folder / "server" / "uploads" / sha256).read_bytes()
                assert hashlib.sha256(content).hexdigest() == sha256
