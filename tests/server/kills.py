"""Kill the server of a class at work: `python -m tests.server.kills FOLDER [--rounds 60] [--students 30]`.

It makes a class in FOLDER if there is none, kills the server in each round while students type and send files, and
prints how many confirmed cells and files are there, and how many of them twice.
"""

from __future__ import annotations

import argparse
import hashlib
import random
import sqlite3
import sys
import threading
import time
from collections import Counter
from contextlib import closing
from pathlib import Path

import httpx2

from tests.server.load import make
from tests.server.running import PATIENCE, free_port, running, token_in


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


def confirmed(typists: dict[str, Typist]) -> int:
    """Return the number of cells that the server said it has."""
    return sum(len(typist.confirmed) for typist in typists.values())


def killed(folder: Path, typists: dict[str, Typist], seconds: float) -> None:
    """Serve a class, let everybody type for a time from the first confirmed cell on, and kill the server."""
    with running(folder, free_port()) as server:
        for id, link in server.links():
            typists.setdefault(id, Typist("")).link = link
        threads = [
            threading.Thread(target=typist.run, args=(server.address,), daemon=True) for typist in typists.values()
        ]
        for thread in threads:
            thread.start()
        before, end = confirmed(typists), time.monotonic() + PATIENCE
        while confirmed(typists) == before and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(seconds)
        server.kill()
        for thread in threads:
            thread.join()


def faults(folder: Path, typists: dict[str, Typist]) -> list[str]:
    """Return what is wrong with a class after its server was killed: what was confirmed must be there once."""
    wrong: list[str] = []
    with closing(sqlite3.connect(folder / "server" / "class.db")) as connection:
        if connection.execute("PRAGMA integrity_check").fetchone() != ("ok",):
            wrong.append("the database is damaged")
        for id, typist in typists.items():
            rows = connection.execute("SELECT client, text FROM saves WHERE folder = ?", (id,)).fetchall()
            sent = connection.execute("SELECT client, sha256 FROM uploads WHERE folder = ?", (id,)).fetchall()
            for known, stored in ((typist.confirmed, rows), (typist.files, sent)):
                wrong += [f"{id}: {name} is lost" for name in known.items() - set(stored)]
                counts = Counter(client for client, _ in stored)
                wrong += [f"{id}: {name} is there twice" for name, count in counts.items() if count > 1]
            # At most the one cell that was under way is there without having been confirmed.
            if len(rows) - len(typist.confirmed) > 1:
                wrong.append(f"{id}: {len(rows)} cells are there, {len(typist.confirmed)} were confirmed")
            for _, sha256 in sent:
                content = (folder / "server" / "uploads" / sha256).read_bytes()
                if hashlib.sha256(content).hexdigest() != sha256:
                    wrong.append(f"{id}: {sha256} is damaged")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--students", type=int, default=30)
    order = parser.parse_args()
    if not order.folder.exists():
        make(order.folder, order.students)
    chance, typists = random.Random(1), dict[str, Typist]()
    for number in range(order.rounds):
        killed(order.folder, typists, chance.uniform(0.0, 4.0))
        cells = confirmed(typists)
        files = sum(len(typist.files) for typist in typists.values())
        wrong = faults(order.folder, typists)
        print(
            f"round {number + 1}: {cells} cells, {files} files confirmed, faults: {len(wrong)}", *wrong[:5], flush=True
        )
        if wrong:
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
