"""A small class and its people, as they use the server: browsers without a browser."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from itertools import count
from pathlib import Path
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.testclient import TestClient

from reportgen.server.app import application
from reportgen.server.class_folder import ClassFolder
from reportgen.server.links import DESK
from reportgen.server.serving import make_class, open_site
from reportgen.server.site import Site

ADDRESS = "http://127.0.0.1:8080"
SPEC = """\
kind: slider-crank
report: {language: en, worked_positions: [2]}
positions: {count: 8}
parameters: {r: [100 mm, 110 mm, 120 mm, 130 mm], l: [400 mm, 450 mm], n: 300 rpm, s: 0.5, G2: 40 N, G3: 50 N}
"""
ROSTER = "id,name,class\nS1,An Nguyễn,K1\nS2,Bình Lê,K1\nS3,Chi Trần,K2\n"
POLICY = 'ask: ["velocity", "geometry"]\n'


def begun(folder: Path) -> Path:
    """A new class."""
    beside = folder.with_name(f"{folder.name}-files")
    beside.mkdir(parents=True)
    files = {"spec.yaml": SPEC, "roster.csv": ROSTER, "policy.yaml": POLICY}
    for name, text in files.items():
        (beside / name).write_text(text, encoding="utf-8")
    make_class(folder, *(beside / name for name in files), language="en")
    return folder


@dataclass
class Here:
    """A queue that works in threads of the test."""

    waiting: int = 0

    async def run(self, function: Callable[..., Any], *arguments: Any, kind: str = "short") -> Any:
        return await run_in_threadpool(function, *arguments)

    def warm(self) -> None:
        """Nothing has to start."""

    def close(self) -> None:
        """Nothing has to end."""


@dataclass
class Browser:
    """Somebody with a link."""

    client: TestClient
    page: str = ""
    _names: Iterator[int] = field(default_factory=lambda: count(1))

    @property
    def token(self) -> str:
        found = re.search('name="csrf" content="(.*?)"', self.page)
        assert found, "each page has the token"
        return found[1]

    def open(self, path: str) -> Any:
        answer = self.client.get(path, headers={"accept": "text/html"})
        self.page = answer.text
        return answer

    def get(self, path: str) -> Any:
        return self.client.get(path)

    def json(self, path: str) -> Any:
        answer = self.client.get(path)
        assert answer.status_code == 200, answer.text
        return answer.json()

    def post(self, path: str, content: Mapping[str, Any] | None = None, **more: Any) -> Any:
        return self.client.post(path, json=content or {}, headers={"x-csrf-token": self.token}, **more)

    def name(self) -> str:
        return f"client-{next(self._names):04}"

    # --- a student

    @cached_property
    def places(self) -> list[tuple[str, int]]:
        """The cells to fill in."""
        sections = self.json("/me/sheet")["sections"]
        rows = [row for section in sections for row in section["rows"]]
        return [(row["id"], cell["position"]) for row in rows for cell in row["cells"] if cell["open"]]

    def save(self, values: Mapping[tuple[str, int], str]) -> Any:
        sent = [
            {"client": self.name(), "id": id, "position": position, "text": text}
            for (id, position), text in values.items()
        ]
        return self.post("/me/cells", {"cells": sent})

    def upload(self, name: str, content: bytes, client: str | None = None) -> Any:
        form = {"client": client or self.name(), "csrf": self.token}
        return self.client.post("/me/uploads", data=form, files={"file": (name, content)})

    def hand_in(self) -> Any:
        return self.post("/me/hand-in", {"client": self.name()})


@dataclass
class Served:
    """A class that is served within a test."""

    folder: ClassFolder
    site: Site
    client: TestClient
    _open: ExitStack

    @classmethod
    @contextmanager
    def copied(cls, made: Path, target: Path) -> Iterator[Served]:
        """Serve a copy of a class that was made."""
        shutil.copytree(made, target)
        with cls.of(target) as served:
            yield served

    @classmethod
    @contextmanager
    def of(cls, folder: Path) -> Iterator[Served]:
        with ExitStack() as stack:
            site = open_site(folder, ADDRESS, Here())
            client = stack.enter_context(TestClient(application(site), base_url=ADDRESS, follow_redirects=False))
            yield cls(site.folder, site, client, stack)

    def stranger(self) -> TestClient:
        """Somebody without a link, in the running class."""
        made = TestClient(self.client.app, base_url=ADDRESS, follow_redirects=False)
        # The class runs in the loop of the first client.
        made.portal = self.client.portal
        return made

    def person(self, folder: str) -> Browser:
        """Somebody who has opened the personal link."""
        browser = Browser(self.stranger())
        answer = browser.open(self.site.link(folder).removeprefix(ADDRESS))
        assert answer.status_code == 200, answer.text
        assert browser.open("/desk" if folder == DESK else "/me").status_code == 200, browser.page
        return browser

    @property
    def desk(self) -> Browser:
        return self.person(DESK)
