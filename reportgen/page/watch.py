"""A watched file from the first page to Ctrl-C: files are watched, editions made, a browser opened.

This is the only module that imports watchfiles, for the templates.
"""

from __future__ import annotations

import io
import json
import secrets
import socket
import sys
import threading
import time
import webbrowser
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, ClassVar, TextIO
from urllib.parse import urlsplit

from reportgen import report as tree
from reportgen.assignment import parts
from reportgen.base.errors import AssignmentError, ReportgenError
from reportgen.base.files import reported
from reportgen.base.source import read_source
from reportgen.base.units import Language
from reportgen.base.words import load_words, search_path, spoken, templates, unexpected
from reportgen.page import html, panels
from reportgen.page.html import Live, Panel, WrittenReport
from reportgen.report import Document
from reportgen.report.case import Case

# --- what a reader of a watched file sees ---------------------------------------------------------
# The latest editions of the moving part, of the report, and of a fault.
# The moving part is made first and stands at once; the report follows, made of the same case in another thread. A
# change meanwhile is taken up as soon as it comes: what is made of an older file is dropped.

NOBODY = "–"
"""What stands on the page of a file that was never right."""
AHEAD = 0.2
"""The time (s) that the moving part has to itself before the report is begun."""


@dataclass(frozen=True)
class Edition:
    """What is to be shown; `moving` and `report` count how often each of them has changed."""

    language: Language
    words: Mapping[str, Any]
    panels: tuple[Panel, ...] = ()
    report: WrittenReport | None = None
    document: tree.Document | None = None
    fault: str = ""
    moving: int = 0
    reports: int = 0
    busy: bool = False
    """Whether a report of the file as it stands is still to come."""

    @property
    def news(self) -> Mapping[str, Any]:
        """What a page is told at once; it asks for the rest where it has an older one."""
        return {
            "moving": self.moving,
            "report": self.reports,
            "fault": self.fault,
            "busy": self.busy,
            "language": self.language,
            "moves": [panel.own for panel in self.panels],
        }


@dataclass
class Desk:
    """Makes the editions of a file, which `opens`.  `told` is called with each finished report's case and document."""

    opens: Callable[[], Case]
    language: Language | None = None
    told: Callable[[Case, tree.Document], None] = lambda case, document: None
    changed: threading.Condition = field(default_factory=threading.Condition)
    closed: bool = False

    def __post_init__(self) -> None:
        first = self.language or spoken()
        self.edition = Edition(first, load_words(search_path(first)))
        self._asked = 0
        self._worker = threading.Thread(target=self._write_reports, daemon=True)
        self._to_write: tuple[int, Case] | None = None

    def open(self) -> None:
        """Make the first edition."""
        self._worker.start()
        self.renew()

    def close(self) -> None:
        """Let everybody go who waits for news."""
        with self.changed:
            self.closed = True
            self.changed.notify_all()

    def next_edition(self, known: Edition | None, patience: float) -> Edition:
        """The edition after the `known` one as soon as it is there, or what there is after so many seconds."""
        with self.changed:
            self.changed.wait_for(lambda: self.closed or self.edition is not known, patience)
            return self.edition

    def renew(self) -> None:
        """Make the moving part of the file as it stands, and leave the report to its thread."""
        self._asked += 1
        number = self._asked
        try:
            case = self.opens()
            moving = panels(case)
            language, words = case.assignment.language, case.words
        except Exception as error:
            self._to_write = None
            self._publish(fault=self._in_words(error), busy=False)
            return
        count = self.edition.moving + 1
        self._publish(language=language, words=words, panels=moving, moving=count, fault="", busy=True)
        with self.changed:
            self._to_write = number, case
            self.changed.notify_all()

    def _write_reports(self) -> None:
        """Write the report of the latest case, again and again."""
        while True:
            with self.changed:
                self.changed.wait_for(lambda: self.closed or self._to_write is not None)
                if self.closed or self._to_write is None:
                    return
                wanted = self._to_write
                # The moving part goes to the page first.
                if self.changed.wait_for(partial(self._overtaken, wanted), AHEAD):
                    continue
                self._to_write = None
            number, case = wanted
            try:
                document = case.document()
                if number != self._asked:
                    continue
                written = html.report(document)
                count = self.edition.reports + 1
                self._publish(report=written, document=document, reports=count, busy=False)
                self.told(case, document)
            except Exception as error:
                if number == self._asked:
                    self._publish(fault=self._in_words(error), busy=False)

    def _overtaken(self, wanted: tuple[int, Case]) -> bool:
        """Whether another report is to be written than this one, or none."""
        return self.closed or self._to_write is not wanted

    def _publish(self, **news: Any) -> None:
        with self.changed:
            self.edition = replace(self.edition, **news)
            self.changed.notify_all()

    def _in_words(self, error: Exception) -> str:
        if isinstance(error, AssignmentError):
            return "\n".join(map(str, error.problems))
        if isinstance(error, (ReportgenError, OSError)):
            return str(error)
        return unexpected(error, self.language or self.edition.language)

    # --- what is served

    def page(self) -> str:
        """The whole page as it stands; where no report is finished yet, an empty one."""
        now = self.edition
        document = now.document or _nothing(now)
        live = Live(now.words["live"], now.moving, now.reports)
        return html.write(document, now.words["page"], now.panels, live, now.report)

    def moving(self) -> Mapping[str, Any]:
        """The moving part for a page that has an older one."""
        now = self.edition.panels
        return {"rules": html.rules_of(now), "panels": [{"body": one.body, "data": one.data} for one in now]}

    def report(self) -> Mapping[str, Any]:
        """The report for a page that has an older one."""
        now = self.edition
        if now.report is None or now.document is None:
            return {}
        return {"body": now.report.body, "rules": now.report.rules, "title": now.document.title}


def _nothing(edition: Edition) -> tree.Document:
    words = tree.Words.among(edition.words["document"])
    return tree.Document(edition.language, NOBODY, "", ("", ""), ("", ""), words)


# --- a server for one page on this machine --------------------------------------------------------
# A few fixed addresses under a secret one, and news as they come.
# Other machines cannot reach it; other pages in the same browser do not know the token, and a request under another
# name of this machine is refused, so that no site can pose as this one.

HOST = "127.0.0.1"
BEAT = 10.0
"""A page that has had no news for so long (s) hears that the server is there."""
REQUEST = 10.0
"""A connection has so long (s) to send a whole request, or to take a part of the answer."""
RESPITE = 0.2
"""Where no connection can be accepted, the server looks again after so long (s)."""
HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
}


class Server(ThreadingHTTPServer):
    """Serves the editions of a desk on a free port, each request in a thread of its own."""

    daemon_threads = True

    def __init__(self, desk: Desk, port: int = 0) -> None:
        self.desk = desk
        self.token = secrets.token_urlsafe(16)
        super().__init__((HOST, port), _Request)

    @property
    def address(self) -> str:
        return f"http://{HOST}:{self.server_port}/{self.token}/"

    def get_request(self) -> tuple[socket.socket, Any]:
        """The next connection; where no more files can be opened it waits, and would be asked at once again."""
        try:
            return super().get_request()
        except OSError:
            time.sleep(RESPITE)
            raise

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A page that was closed while it was answered is nobody's fault."""


class _InTime(io.RawIOBase):
    """What a connection sends until its time is up; then reading raises `TimeoutError`, however much has come."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self.begin()

    def begin(self) -> None:
        """Let the time for a request begin."""
        self._end = time.monotonic() + REQUEST

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        left = self._end - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self._connection.settimeout(left)
        try:
            return self._connection.recv_into(buffer)
        finally:
            self._connection.settimeout(REQUEST)


class _Request(BaseHTTPRequestHandler):
    server: Server
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "reportgen", ""
    answers: ClassVar[Mapping[str, Callable[[Desk], Mapping[str, Any]]]] = {
        "moving.json": Desk.moving,
        "report.json": Desk.report,
    }

    def setup(self) -> None:
        super().setup()
        self._incoming = _InTime(self.connection)
        self.rfile.close()
        self.rfile = io.BufferedReader(self._incoming)

    def handle_one_request(self) -> None:
        self._incoming.begin()
        # Nobody is told: what takes too long ends, as what is closed does.
        with suppress(ConnectionError):
            super().handle_one_request()

    def do_GET(self) -> None:
        if not self._known():
            self._refuse(HTTPStatus.FORBIDDEN)
            return
        folder, _, name = urlsplit(self.path).path[1:].partition("/")
        if not secrets.compare_digest(folder.encode(), self.server.token.encode()):
            self._refuse(HTTPStatus.NOT_FOUND)
        elif name == "":
            self._send(self.server.desk.page().encode(), "text/html; charset=utf-8")
        elif name == "news":
            self._tell()
        elif name in self.answers:
            found = self.answers[name](self.server.desk)
            self._send(json.dumps(found, ensure_ascii=False).encode(), "application/json")
        else:
            self._refuse(HTTPStatus.NOT_FOUND)

    def _known(self) -> bool:
        """Whether a request is for this server by its own name, and from no other page."""
        own = {f"{HOST}:{self.server.server_port}", f"localhost:{self.server.server_port}"}
        origin = self.headers.get("Origin")
        return self.headers.get("Host") in own and (origin is None or origin.removeprefix("http://") in own)

    def _refuse(self, status: HTTPStatus) -> None:
        self._send(status.phrase.encode(), "text/plain; charset=utf-8", status)

    def _send(self, body: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def _tell(self) -> None:
        """Tell each edition as it appears, until the page goes or the server ends."""
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        desk, known = self.server.desk, None
        while not desk.closed:
            current = desk.next_edition(known, BEAT)
            line = f"data: {json.dumps(current.news, ensure_ascii=False)}\n\n" if current is not known else ":\n\n"
            known = current
            try:
                self.wfile.write(line.encode())
                self.wfile.flush()
            except OSError:
                return

    def log_message(self, format: str, *args: Any) -> None:
        """Requests are not printed: the page says what there is to say."""


# --- from the first page to Ctrl-C ------------------------------------------------------------

QUIET, LONGEST = 20, 200
"""Changes are taken together until nothing changes for the first time (ms), and no longer than the second."""

LOOKING = 0.05
"""From one look at the file to the next (s)."""
HEARING = 0.5
"""How long (s) an interruption may have to wait."""
_ONE_AT_A_TIME = threading.Lock()


Opener = Callable[[Path, Language | None], Case]
"""Opens the case of an assignment file; raises `AssignmentError` with its faults."""


def nobody(case: Case, document: Document) -> None:
    """Takes no notice of a finished report."""


def watch(
    path: Path,
    opens: Opener,
    language: Language | None = None,
    told: Callable[[Case, Document], None] = nobody,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve the page of a file and renew it until the program is interrupted; `told` of each finished report.

    A faulty file has a page that tells its faults.  Raises `AssignmentError` if there is no file, `OutputError`.
    """
    if not path.is_file():
        # A name mistyped is no file to wait for, nor is a pipe.
        opens(path, language)
    path = path.absolute()
    desk = Desk(partial(opens, path, language), language, told)
    with reported():
        server = Server(desk, port)
    stop = threading.Event()
    threads = (
        threading.Thread(target=server.serve_forever, args=(0.1,), daemon=True),
        threading.Thread(target=_follow, args=(path, desk, stop, _states(path)), daemon=True),
        threading.Thread(target=_follow_templates, args=(desk, stop, _school(path, opens)), daemon=True),
    )
    try:
        for thread in threads:
            thread.start()
        with _ONE_AT_A_TIME:
            desk.open()
        print(server.address, file=stream, flush=True)
        if browser:
            webbrowser.open(server.address)
        while not stop.wait(HEARING):
            pass
    except KeyboardInterrupt:
        pass
    finally:
        stop.set()
        desk.close()
        server.shutdown()
        server.server_close()


def _school(path: Path, opens: Opener) -> Path | None:
    """The school's folder that a file names when it is opened first."""
    with suppress(ReportgenError):
        return opens(path, None).assignment.school
    return None


def _follow(path: Path, desk: Desk, stop: threading.Event, shown: object) -> None:
    """Renew the desk whenever the file of a path is not as it was `shown`.

    The path is asked again and again: what watches files holds on to a folder that was renamed, does not follow links
    and hears nothing of changes that another computer makes.
    """
    while not stop.wait(LOOKING):
        if _states(path) != shown:
            stop.wait(QUIET / 1000)
            shown = _states(path)
            with _ONE_AT_A_TIME:
                desk.renew()


def _states(path: Path) -> tuple[tuple[float, ...], ...]:
    """What changes with a file and with the files of its parts."""
    own = _state(path)
    return own, *map(_state, _beside(path, own))


@lru_cache(maxsize=4)
def _beside(path: Path, _: tuple[float, ...]) -> tuple[Path, ...]:
    """The files of the parts of a file, read once for as long as it stays the same."""
    return tuple(parts.files(read_source(path), path))


def _state(path: Path) -> tuple[float, ...]:
    """What changes with a file, or with what its path leads to; nothing where it leads nowhere."""
    try:
        about = path.stat()
    except OSError:
        return ()
    return about.st_dev, about.st_ino, about.st_mode, about.st_size, about.st_mtime_ns, about.st_ctime_ns


def _follow_templates(desk: Desk, stop: threading.Event, school: Path | None) -> None:
    """Renew the desk whenever a file of the templates changes, or of a school's folder."""
    from watchfiles import watch as changes

    for _ in changes(
        *filter(None, (templates(), school and templates() / school)),
        watch_filter=None,
        debounce=LONGEST,
        step=QUIET,
        stop_event=stop,
        rust_timeout=500,
        raise_interrupt=False,
    ):
        with _ONE_AT_A_TIME:
            desk.renew()
