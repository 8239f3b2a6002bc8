"""The page on which a user chooses a kind or one of its samples, before there is a file to edit."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from reportgen import catalogue
from reportgen.base.errors import ReportgenError
from reportgen.base.kinds import kinds
from reportgen.base.records import asdict
from reportgen.base.template_folders import is_users_machine
from reportgen.page import html
from reportgen.page.html import Live
from reportgen.page.kind_cards import CardDrawing, cards
from reportgen.page.live_view import LiveSession, empty_document

READY = 60.0
"""Seconds that the page waits for the form of the file that it has begun."""
WHOLE = ""
"""Name of the sample if the file begins with everything to fill in."""


@dataclass
class Chooser(LiveSession):
    """The session of the page that offers the kinds.

    `begins` makes the file of a kind, as a copy of the sample with a name, or `WHOLE`. `draws` draws the scheme of a
    machine of the user's folder.
    """

    begins: Callable[[str, str], Path] = field(default=lambda kind, sample: Path())
    draws: Callable[[str], CardDrawing] | None = None
    chosen: threading.Event = field(default_factory=threading.Event)
    ready: threading.Event = field(default_factory=threading.Event)
    path: Path = Path()
    _choosing: threading.Lock = field(default_factory=threading.Lock)
    _writing: threading.Lock = field(default_factory=threading.Lock)
    _drawing: threading.Lock = field(default_factory=threading.Lock)
    _drawn: dict[str, Mapping[str, str]] = field(default_factory=dict)

    def _written_page(self) -> str:
        # The first page is being made while the browser starts, and is not begun a second time.
        with self._writing:
            return self._cards_page()

    def _cards_page(self) -> str:
        now = self.revision
        words, offered = now.words["edit"], cards(now.language)
        groups = [(title, offered[group]) for group, title in words["groups"].items() if group in offered]
        form = html.template("choose.html.j2").render(words=words, groups=groups)
        schemes = [card.scheme for members in offered.values() for card in members if card.scheme is not None]
        live = Live(
            {**now.words["live"], **words},
            moving=0,
            report=0,
            scripts=("choose.js",),
            styles=("live.css", "choose.css"),
            form=form,
            rules="\n".join(scheme.rules for scheme in schemes),
        )
        return html.write(empty_document(now), now.words["page"], (), live)

    @property
    def answers(self) -> Mapping[str, Callable[[], Mapping[str, Any]]]:
        return {}

    @property
    def takes(self) -> Mapping[str, Callable[[Mapping[str, Any]], Mapping[str, Any] | bytes]]:
        return {"begin.json": self.begin, "scheme.json": self.scheme}

    def scheme(self, asked: Mapping[str, Any]) -> Mapping[str, str]:
        """Return the scheme of a machine of the user's folder, which is drawn once: its box, rules and elements.

        Return {} if it cannot be drawn. Raise `KeyError` for any other kind.
        """
        kind = str(asked["kind"])
        if kind not in kinds() or not is_users_machine(kind):
            raise KeyError(kind)
        with self._drawing:
            if kind not in self._drawn:
                self._drawn[kind] = self._scheme(kind)
        return self._drawn[kind]

    def _scheme(self, kind: str) -> Mapping[str, str]:
        try:
            return asdict(self.draws(kind)) if self.draws is not None else {}
        except (ReportgenError, ArithmeticError, ValueError, LookupError):
            return {}

    def begin(self, asked: Mapping[str, Any]) -> Mapping[str, Any]:
        """Begin the file of a kind, wait until its form is ready, and return `begun`: False after `READY` seconds.

        If the file cannot be written, `refused` says why, and another may be chosen. Raise `KeyError` for an unknown
        kind or sample.
        """
        kind, sample = str(asked["kind"]), str(asked.get("sample", WHOLE))
        if kind not in kinds():
            raise KeyError(kind)
        if sample != WHOLE and sample not in catalogue.examples(kind):
            raise KeyError(sample)
        with self._choosing:
            if not self.chosen.is_set():
                try:
                    self.path = self.begins(kind, sample)
                except (ReportgenError, OSError) as error:
                    reason = self._in_words(error)
                    return {"begun": False, "refused": self.revision.words["edit"]["not_begun"].format(reason=reason)}
                self.chosen.set()
        return {"begun": self.ready.wait(READY)}
