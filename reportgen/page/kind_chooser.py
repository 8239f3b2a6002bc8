"""The page on which a user chooses a kind, with a picture of each, before there is a file to edit."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from reportgen import catalogue
from reportgen.base.kinds import kinds, titles
from reportgen.base.units import Language
from reportgen.case import Case
from reportgen.document import Figure
from reportgen.page import html
from reportgen.page.html import Live
from reportgen.page.live_view import LiveSession, empty_document
from reportgen.page.svg_elements import Painter, Pens

READY = 60.0
"""Seconds that the page waits for the form of the file that it has begun."""


@dataclass
class Chooser(LiveSession):
    """The session of the page that offers the kinds.

    `begins` makes the file of a kind, `example` opens the example whose figure is shown.
    """

    begins: Callable[[str], Path] = Path
    example: Callable[[Path, Language], Case] | None = None
    chosen: threading.Event = field(default_factory=threading.Event)
    ready: threading.Event = field(default_factory=threading.Event)
    path: Path = Path()

    def page(self) -> str:
        now = self.revision
        words = now.words["edit"]
        form = html.template("choose.html.j2").render(words=words, kinds=titles(now.language))
        live = Live({**now.words["live"], **words}, 0, 0, ("choose.js",), ("live.css", "choose.css"), form)
        return html.write(empty_document(now), now.words["page"], (), live)

    @property
    def answers(self) -> Mapping[str, Callable[[], Mapping[str, Any]]]:
        return {f"scheme-{kind}.json": partial(self.scheme, kind) for kind in kinds()}

    @property
    def takes(self) -> Mapping[str, Callable[[Mapping[str, Any]], Mapping[str, Any] | bytes]]:
        return {"begin.json": self.begin}

    def scheme(self, kind: str) -> Mapping[str, Any]:
        """Return the first figure of an example of a kind, as elements with the rules of their pens."""
        files = catalogue.examples(kind).values()
        if self.example is None or not files:
            return {}
        language = self.revision.language
        file = min(files, key=lambda path: path.stat().st_size)
        document = self.example(file, language).document()
        figure = next((block for block in document.blocks if isinstance(block, Figure)), None)
        if figure is None:
            return {}
        pens = Pens(f"{kind}-")
        drawing = Painter(language, pens).scene(figure.scenes[0], titles(language)[kind])
        return {"body": drawing, "rules": pens.rules()}

    def begin(self, asked: Mapping[str, Any]) -> Mapping[str, Any]:
        """Begin the file of a kind, wait until its form is ready, and return `begun`: False after `READY` seconds.

        Raise `KeyError` for an unknown kind.
        """
        kind = str(asked["kind"])
        if kind not in kinds():
            raise KeyError(kind)
        if not self.chosen.is_set():
            self.path = self.begins(kind)
            self.chosen.set()
        return {"begun": self.ready.wait(READY)}
