"""A server in a process of its own, to be killed, and people who use it over the network."""

from __future__ import annotations

import csv
import io
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx2

HOST = "127.0.0.1"
PATIENCE = 120


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])


@dataclass
class Running:
    """A server that was started by the command; `desk` is the instructor's link."""

    process: subprocess.Popen[str]
    address: str
    desk: str

    def kill(self) -> None:
        """End it as a power cut does, with all its processes."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()

    def links(self) -> list[tuple[str, str]]:
        """The id and the link of each student, as the instructor downloads them."""
        with httpx2.Client(base_url=self.address, timeout=PATIENCE) as client:
            client.get(self.desk)
            text = client.get("/desk/download/links.csv").content.decode("utf-8-sig")
        return [(row["id"], row["link"]) for row in csv.DictReader(io.StringIO(text))]


@contextmanager
def running(folder: Path, port: int) -> Iterator[Running]:
    """Serve a class until the block ends."""
    command = [sys.executable, "-m", "reportgen.cli", "serve", str(folder), "--port", str(port)]
    with open(folder.parent / "server.log", "a") as log:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True, start_new_session=True)
    assert process.stdout
    try:
        desk = process.stdout.readline().strip()
        assert desk, (folder.parent / "server.log").read_text()
        address = f"http://{HOST}:{port}"
        end = time.monotonic() + PATIENCE
        while True:
            try:
                httpx2.get(f"{address}/", timeout=5)
                break
            except httpx2.TransportError:
                assert time.monotonic() < end, "it answers"
                time.sleep(0.05)
        yield Running(process, address, desk)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        process.stdout.close()


def token_in(page: str) -> str:
    found = re.search('name="csrf" content="(.*?)"', page)
    assert found, "each page has the token"
    return found[1]
