"""A class that works at once: `python -m tests.server.load FOLDER [--students 300] [--cells 40] [--minutes 10]`.

It makes the class in FOLDER if there is none, serves it, lets each student open the page, type cells, send a sheet and
hand in, and prints the times of the answers, the errors, and the cells that were confirmed and are not there.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import sqlite3
import sys
import time
from collections.abc import Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from tests.server.running import HOST, PATIENCE, free_port, running, token_in
from tests.server.served import SPEC

READ_WITHIN = 120.0


@dataclass
class Figures:
    """Times (s) by kind of request, and what went wrong."""

    times: dict[str, list[float]] = field(default_factory=dict)
    errors: list[str] = field(default_factory=list)
    confirmed: dict[tuple[str, str], str] = field(default_factory=dict)

    def note(self, kind: str, seconds: float) -> None:
        self.times.setdefault(kind, []).append(seconds)

    def lines(self) -> list[str]:
        made = []
        for kind, times in self.times.items():
            ordered = sorted(times)
            shares = (0.5, 0.95, 0.99, 1.0)
            at = (ordered[min(int(share * len(ordered)), len(ordered) - 1)] for share in shares)
            said = "  ".join(f"{1000 * value:7.0f}" for value in at)
            made.append(f"{kind:10} {len(ordered):7}  {said} ms (median, p95, p99, largest)")
        return [*made, f"errors: {len(self.errors)} {self.errors[:5]}"]


class Connection:
    """One connection that is kept, with the cookie of its student; as little as a browser must do."""

    def __init__(self, port: int) -> None:
        self.port, self.cookie = port, ""
        self.streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def ask(self, method: str, path: str, body: bytes = b"", **headers: str) -> tuple[int, bytes]:
        for last in (False, True):
            try:
                return await self._ask(method, path, body, headers)
            except (OSError, asyncio.IncompleteReadError):
                # A connection that was idle may have been closed.
                self.streams = None
                if last:
                    raise
        raise AssertionError("the last round returns or raises")

    async def _ask(self, method: str, path: str, body: bytes, headers: dict[str, str]) -> tuple[int, bytes]:
        if self.streams is None:
            self.streams = await asyncio.open_connection(HOST, self.port)
        reader, writer = self.streams
        lines = [f"{method} {path} HTTP/1.1", f"Host: {HOST}:{self.port}", f"Content-Length: {len(body)}"]
        lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
        lines += [f"Cookie: {self.cookie}"] if self.cookie else []
        writer.write("\r\n".join((*lines, "", "")).encode() + body)
        await writer.drain()
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1")
        said = dict(line.lower().split(": ", 1) for line in head.split("\r\n")[1:] if ": " in line)
        for line in head.split("\r\n"):
            if line.lower().startswith("set-cookie: "):
                self.cookie = line[12:].partition(";")[0]
        content = await reader.readexactly(int(said.get("content-length", 0)))
        return int(head.split(" ", 2)[1]), content


async def student(number: int, id: str, link: str, port: int, order: argparse.Namespace, figures: Figures) -> None:
    """Open the link, type, send a sheet, hand in: each at some moment of the time given."""
    chance = random.Random(number)
    own, end = Connection(port), order.minutes * 60
    start = time.monotonic()

    async def ask(kind: str, method: str, path: str, content: Any = None, **headers: str) -> bytes:
        body = b"" if content is None else content if isinstance(content, bytes) else json.dumps(content).encode()
        begun = time.monotonic()
        status, answer = await own.ask(method, path, body, **headers)
        figures.note(kind, time.monotonic() - begun)
        if status != 200:
            figures.errors.append(f"{kind} {status} {answer[:80]!r}")
        return answer

    try:
        await asyncio.sleep(chance.uniform(0, 0.1 * end))
        await ask("link", "GET", urlsplit(link).path)
        token = token_in((await ask("page", "GET", "/me")).decode())
        sheet = json.loads(await ask("sheet", "GET", "/me/sheet"))
        rows = [row for section in sheet["sections"] for row in section["rows"]]
        places = [(row["id"], cell["position"]) for row in rows for cell in row["cells"] if cell["open"]]
        head = {"Content_Type": "application/json", "X_CSRF_Token": token}
        moments = sorted(chance.uniform(0.1, 0.9) * end for _ in range(order.cells))
        for k, moment in enumerate(moments):
            await asyncio.sleep(max(start + moment - time.monotonic(), 0))
            place, text = places[k % len(places)], f"{k}.5"
            cell = {"client": f"{order.run}-{number:04}-{k:04}", "id": place[0], "position": place[1], "text": text}
            answer = json.loads(await ask("cell", "POST", "/me/cells", {"cells": [cell]}, **head))
            for saved in answer.get("saved", []):
                figures.confirmed[(id, saved["client"])] = text
        if number % order.upload_each == 0:
            await _upload(ask, f"{order.run}-{number:04}", id, token, figures)
        await asyncio.sleep(max(start + chance.uniform(0.9, 1.0) * end - time.monotonic(), 0))
        await ask("hand in", "POST", "/me/hand-in", {"client": f"hand-in-{order.run}-{number:04}"}, **head)
    except (OSError, asyncio.IncompleteReadError, ValueError, AssertionError) as error:
        figures.errors.append(f"{type(error).__name__} {error}")


async def _upload(ask: Any, name: str, id: str, token: str, figures: Figures) -> None:
    """Send a sheet, and wait until it is read."""
    sheet = f"Assignment,{id}\r\nid,Value\r\nv.B,1.5\r\n"
    parts = (f'name="client"\r\n\r\nupload-{name}', f'name="file"; filename="answers.csv"\r\n\r\n{sheet}')
    body = "".join(f"--xyz\r\nContent-Disposition: form-data; {part}\r\n" for part in parts) + "--xyz--\r\n"
    head = {"Content_Type": "multipart/form-data; boundary=xyz", "X_CSRF_Token": token}
    begun = time.monotonic()
    receipt = json.loads(await ask("upload", "POST", "/me/uploads", body.encode(), **head))
    while receipt.get("state") == "queued" and time.monotonic() < begun + READ_WITHIN:
        await asyncio.sleep(0.2)
        receipt = json.loads(await ask("receipt", "GET", f"/me/uploads/{receipt['number']}"))
    figures.note("read", time.monotonic() - begun)
    if receipt.get("state") != "read":
        figures.errors.append(f"upload {receipt}")


async def work(links: Sequence[tuple[str, str]], port: int, order: argparse.Namespace) -> Figures:
    figures = Figures()
    people = (student(number, *one, port, order, figures) for number, one in enumerate(links))
    await asyncio.gather(*people)
    return figures


def lost(folder: Path, figures: Figures) -> tuple[int, int]:
    """Return how many confirmed cells are not in the database, and how many cells it has twice."""
    with closing(sqlite3.connect(folder / "server" / "class.db")) as connection:
        rows = connection.execute("SELECT folder, client, text FROM saves").fetchall()
    stored = {(folder, client): text for folder, client, text in rows}
    return sum(stored.get(name) != text for name, text in figures.confirmed.items()), len(rows) - len(stored)


def memory(process: int) -> int:
    """Return the memory of a process (MB), where the system tells it."""
    with suppress(OSError):
        for line in Path(f"/proc/{process}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) // 1024
    return 0


def processor(process: int) -> float:
    """Return the processor time (s) of a process, where the system tells it."""
    with suppress(OSError):
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return 0.0


def make(folder: Path, count: int) -> None:
    from reportgen.server.serving import make_class

    beside = folder.with_name(f"{folder.name}-files")
    beside.mkdir(parents=True, exist_ok=True)
    (beside / "spec.yaml").write_text(
        SPEC.replace("[100 mm, 110 mm, 120 mm, 130 mm]", "{from: 80 mm, to: 140 mm, step: 1 mm}")
    )
    roster = "".join(f"T{number:03},Student {number}\n" for number in range(count))
    (beside / "roster.csv").write_text(f"id,name\n{roster}")
    make_class(folder, beside / "spec.yaml", beside / "roster.csv", None, "en")


def prepared(folder: Path, count: int) -> None:
    """Wait until the server has made the sheets: students get their links later than that."""
    end = time.monotonic() + 10 * PATIENCE
    while len(list((folder / "server" / "sheets").glob("*.json"))) < count and time.monotonic() < end:
        time.sleep(0.5)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--students", type=int, default=300)
    parser.add_argument("--cells", type=int, default=40)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--upload-each", type=int, default=5)
    order = parser.parse_args()
    order.run = f"{int(time.time()):x}"
    if not order.folder.exists():
        make(order.folder, order.students)
    port = free_port()
    with running(order.folder, port) as server:
        prepared(order.folder, order.students)
        figures = asyncio.run(work(server.links()[: order.students], port, order))
        print(*figures.lines(), sep="\n")
        print(f"server: {memory(server.process.pid)} MB, {processor(server.process.pid):.1f} s of processor")
    gone, twice = lost(order.folder, figures)
    print(f"confirmed: {len(figures.confirmed)}, lost: {gone}, twice: {twice}")
    return 1 if figures.errors or gone or twice else 0


if __name__ == "__main__":
    sys.exit(main())
