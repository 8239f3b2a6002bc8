"""Keep the page of a watched file current: revisions of the animation, of the report, and of a fault.

A file is checked first, and its faults are shown at once, while the animation or the report of an older file may still
be made. The animation is shown as soon as it is made. The report of the same case follows in another thread. A change
in between is processed at once, and reports of an older file are dropped.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from functools import partial
from typing import Any

from reportgen import document as tree
from reportgen.base.errors import AssignmentError, ReportgenError
from reportgen.base.records import Record, field, replace
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words, spoken, unexpected
from reportgen.case import Case
from reportgen.page import html, panels
from reportgen.page.html import Live, Panel, WrittenReport

NOBODY = "–"
"""Title on the page of a file that was never valid."""
PART = "part/"
"""Path of the pages of parts that are in separate files."""
AHEAD = 0.2
"""Seconds that the animation has to itself before the report is begun."""
LONGEST = 5.0
"""Longest time (s) that a report waits for pages that are being made."""


class Revision(Record):
    """Current content of a page; `moving` and `report` count how often each of them has changed."""

    language: Language
    words: Mapping[str, Any]
    panels: tuple[Panel, ...] = ()
    report: WrittenReport | None = None
    document: tree.Document | None = None
    case: Case | None = None
    """Animated case: that of the last valid state of the file."""
    fault: str = ""
    moving: int = 0
    reports: int = 0
    reads: int = 0
    """Number of times the file was read: an unchanged fault may be that of another text."""
    busy: bool = False
    """True if a report of the current file is still to come."""
    making: Mapping[str, Any] = field(default_factory=dict)
    """Product that is being made of the file, or was made last."""

    @property
    def news(self) -> Mapping[str, Any]:
        """State that a page receives at once; it requests the rest if it has an older one."""
        return {
            "moving": self.moving,
            "report": self.reports,
            "reads": self.reads,
            "fault": self.fault,
            "busy": self.busy,
            "language": self.language,
            "moves": [panel.own for panel in self.panels],
            **({"making": self.making} if self.making else {}),
        }


@dataclass
class LiveSession:
    """Makes the revisions of a file that `opens` reads.

    `tell` is called with the case and the document of each finished report.
    """

    opens: Callable[[], Case]
    language: Language | None = None
    tell: Callable[[Case, tree.Document], None] = lambda case, document: None
    changed: threading.Condition = dataclass_field(default_factory=threading.Condition)
    closed: bool = False
    touched: threading.Event = dataclass_field(default_factory=threading.Event)
    """Set when the form itself has changed the file."""

    def __post_init__(self) -> None:
        first = self.language or spoken()
        self.revision = Revision(first, load_words(search_path(first)))
        self._asked = 0
        self._worker = threading.Thread(target=self._write_reports, daemon=True)
        self._to_write: tuple[int, Case] | None = None
        self._pages_in_work = 0

    def open(self) -> None:
        """Make the first revision."""
        self._worker.start()
        self.renew()

    def close(self) -> None:
        """Close the session and release everybody who waits for news."""
        with self.changed:
            self.closed = True
            self.changed.notify_all()

    def next_revision(self, known: Revision | None, patience: float) -> Revision:
        """Return the revision after the `known` one as soon as it exists.

        Return the current one after `patience` seconds.
        """
        with self.changed:
            self.changed.wait_for(lambda: self.closed or self.revision is not known, patience)
            return self.revision

    def renew(self) -> None:
        """Check the current file, make its animation, and leave the report to its thread."""
        if checked := self.check():
            self.show(*checked)

    def check(self) -> tuple[int, Case] | None:
        """Open the current file; return the number of this reading and its case, or show its faults and return None."""
        with self.changed:
            self._asked += 1
            number = self._asked
        try:
            return number, self.opens()
        except Exception as error:
            self._fail(number, error)
            return None

    def show(self, number: int, case: Case) -> None:
        """Make the animation of a checked case, and leave the report to its thread.

        If the file has been read again meanwhile, its faults stay, and no report is written.
        """
        try:
            moving = panels(case)
        except Exception as error:
            self._fail(number, error)
            return
        with self.changed:
            count = self.revision.moving + 1
            self._publish(language=case.assignment.language, words=case.words, panels=moving, case=case, moving=count)
            if number == self._asked:
                self._publish(fault="", busy=True, reads=number)
                self._to_write = number, case

    def _fail(self, number: int, error: Exception) -> None:
        """Show the faults of a reading, unless the file has been read again."""
        with self.changed:
            if number == self._asked:
                self._to_write = None
                self._publish(fault=self._in_words(error), busy=False, reads=number)

    def _write_reports(self) -> None:
        """Write the report of the latest case, repeatedly, until the session is closed."""
        while True:
            with self.changed:
                self.changed.wait_for(lambda: self.closed or self._to_write is not None)
                if self.closed or self._to_write is None:
                    return
                wanted = self._to_write
                # The animation is sent to the page first.
                if self.changed.wait_for(partial(self._overtaken, wanted), AHEAD):
                    continue
                # So is a page that is being made: both would take twice as long beside each other.
                self.changed.wait_for(partial(self._undisturbed, wanted), LONGEST)
                if self._overtaken(wanted):
                    continue
                self._to_write = None
            number, case = wanted
            try:
                document = case.document()
                if number != self._asked:
                    continue
                written = html.report(document)
                count = self.revision.reports + 1
                self._publish(report=written, document=document, reports=count, busy=False)
                self.tell(case, document)
            except Exception as error:
                if number == self._asked:
                    self._publish(fault=self._in_words(error), busy=False)

    def _overtaken(self, wanted: tuple[int, Case]) -> bool:
        """Return True if another report is wanted than this one, or none."""
        return self.closed or self._to_write is not wanted

    def _undisturbed(self, wanted: tuple[int, Case]) -> bool:
        """Return True if no page is being made, or if this report need not be written."""
        return not self._pages_in_work or self._overtaken(wanted)

    def _publish(self, **news: Any) -> None:
        with self.changed:
            if "reads" in news and self.revision.making.get("state") != "running":
                # What was made was made of an older file.
                news["making"] = {}
            self.revision = replace(self.revision, **news)
            self.changed.notify_all()

    def _in_words(self, error: Exception) -> str:
        if isinstance(error, AssignmentError):
            return "\n".join(map(str, error.problems))
        if isinstance(error, (ReportgenError, OSError)):
            return str(error)
        return unexpected(error, self.language or self.revision.language)

    # --- requests of the page

    def made(self, name: str) -> bytes | None:
        """Return the content of a file that was made on the page, by its name; None for any other name."""
        return None

    def below(self, name: str) -> LiveSession | None:
        """Return the session of a part's page, by its name; None for any other name."""
        return None

    @property
    def answers(self) -> Mapping[str, Callable[[], Mapping[str, Any]]]:
        """Requests that a page may make, by names."""
        return {"moving.json": self.moving, "report.json": self.report}

    @property
    def takes(self) -> Mapping[str, Callable[[Mapping[str, Any]], Mapping[str, Any] | bytes]]:
        """Messages that a page may send, by names: none if a file is only watched.

        Bad messages are no fault of the program: `ValueError`, `KeyError` and `TypeError` refuse them.
        """
        return {}

    def page(self) -> str:
        """Return the whole current page; with an empty document if no report is finished yet."""
        with self.changed:
            self._pages_in_work += 1
        try:
            return self._written_page()
        finally:
            with self.changed:
                self._pages_in_work -= 1
                self.changed.notify_all()

    def _written_page(self) -> str:
        now = self.revision
        document = now.document or empty_document(now)
        live = Live(now.words["live"], now.moving, now.reports)
        return html.write(document, now.words["page"], now.panels, live, now.report)

    def moving(self) -> Mapping[str, Any]:
        """Return the animation, for a page that has an older one."""
        now = self.revision.panels
        return {"rules": html.rules_of(now), "panels": [{"body": one.body, "data": one.data} for one in now]}

    def report(self) -> Mapping[str, Any]:
        """Return the report, for a page that has an older one."""
        now = self.revision
        if now.report is None or now.document is None:
            return {}
        return {"body": now.report.body, "rules": now.report.rules, "title": now.document.title}


def empty_document(revision: Revision) -> tree.Document:
    """Return the document of a file without a report yet."""
    words = tree.Words.among(revision.words, revision.language)
    return tree.Document(revision.language, NOBODY, "", ("", ""), ("", ""), words)
