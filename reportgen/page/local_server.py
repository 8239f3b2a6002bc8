"""A local server for one page: a few addresses below a secret token, and a stream of events.

Other machines cannot reach it, and other pages in the same browser do not know the token. A request under another name
of this machine is refused, so that no site can pose as this one.
"""

from __future__ import annotations

import io
import json
import mimetypes
import secrets
import socket
import time
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import urlsplit

from reportgen.base.yaml_source import LARGEST
from reportgen.page.live_view import PART, LiveSession

HOST = "127.0.0.1"
BEAT = 10.0
"""Seconds without news after which a page receives a sign of life."""
REQUEST = 10.0
"""Seconds that a connection has to send a whole request, or to accept a piece of the answer."""
MADE = "made/"
"""Path of the files that were made on a page."""
RESPITE = 0.2
"""Delay (s) before the server retries if no connection can be accepted."""
HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
}


class Server(ThreadingHTTPServer):
    """Serves the revisions of a live session on a free port, each request in a separate thread."""

    daemon_threads = True

    def __init__(self, session: LiveSession, port: int = 0) -> None:
        self.session = session
        self.token = secrets.token_urlsafe(16)
        super().__init__((HOST, port), _Request)

    @property
    def address(self) -> str:
        return f"http://{HOST}:{self.server_port}/{self.token}/"

    def asked_of(self, name: str) -> tuple[LiveSession | None, str]:
        """Return the session that answers a name below the secret address, and the name that it knows."""
        if not name.startswith(PART):
            return self.session, name
        part, _, rest = name.removeprefix(PART).partition("/")
        return self.session.below(part), rest

    def get_request(self) -> tuple[socket.socket, Any]:
        """Return the next connection; wait if no more files can be opened, which would otherwise be retried at once."""
        try:
            connection, address = super().get_request()
            # An answer of a few bytes is sent at once.
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return connection, address
        except OSError:
            time.sleep(RESPITE)
            raise

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore a connection that was closed while it was answered."""


class _InTime(io.RawIOBase):
    """The data of a connection until its time is up; then reading raises `TimeoutError`, whatever has arrived."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self.begin()

    def begin(self) -> None:
        """Start the time of a request."""
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

    def setup(self) -> None:
        super().setup()
        self._incoming = _InTime(self.connection)
        self.rfile.close()
        self.rfile = io.BufferedReader(self._incoming)

    def handle_one_request(self) -> None:
        self._incoming.begin()
        # A request that takes too long ends silently, like a connection that was closed.
        with suppress(ConnectionError):
            super().handle_one_request()

    def do_GET(self) -> None:
        if not self._known():
            self._refuse(HTTPStatus.FORBIDDEN)
            return
        folder, _, name = urlsplit(self.path).path[1:].partition("/")
        if not secrets.compare_digest(folder.encode(), self.server.token.encode()):
            self._refuse(HTTPStatus.NOT_FOUND)
            return
        session, name = self.server.asked_of(name)
        if session is None:
            self._refuse(HTTPStatus.NOT_FOUND)
        elif name == "":
            self._send(session.page().encode(), "text/html; charset=utf-8")
        elif name == "news":
            self._send_revisions(session)
        elif name.startswith(MADE) and (made := session.made(name.removeprefix(MADE))) is not None:
            self._send(made, mimetypes.guess_type(name)[0] or "application/octet-stream")
        elif name in (answers := session.answers):
            answer = answers[name]()
            self._send(json.dumps(answer, ensure_ascii=False).encode(), "application/json")
        else:
            self._refuse(HTTPStatus.NOT_FOUND)

    def do_POST(self) -> None:
        """Answer a message of the page: JSON, not larger than a file may be."""
        folder, _, name = urlsplit(self.path).path[1:].partition("/")
        length, foreign = (
            self.headers.get("Content-Length", ""),
            not self._known() or self.headers.get("Origin") is None,
        )
        secret = secrets.compare_digest(folder.encode(), self.server.token.encode())
        # Nothing is opened for who may not ask.
        session, name = self.server.asked_of(name) if secret and not foreign else (None, name)
        takes = session.takes if session is not None else {}
        refused = (
            (HTTPStatus.FORBIDDEN, foreign),
            (HTTPStatus.NOT_FOUND, name not in takes),
            (HTTPStatus.UNSUPPORTED_MEDIA_TYPE, self.headers.get("Content-Type") != "application/json"),
            (HTTPStatus.LENGTH_REQUIRED, not length.isascii() or not length.isdecimal()),
            (HTTPStatus.REQUEST_ENTITY_TOO_LARGE, len(length) > len(str(LARGEST)) or int(length or 0) > LARGEST),
        )
        if status := next((status for status, holds in refused if holds), None):
            # What was not read would be taken for the next request.
            self.close_connection = True
            self._refuse(status)
            return
        try:
            asked = json.loads(self.rfile.read(int(length)))
            answer = takes[name](asked) if isinstance(asked, dict) else None
        except (ValueError, KeyError, TypeError, RecursionError):
            answer = None
        match answer:
            case None:
                self._refuse(HTTPStatus.BAD_REQUEST)
            case bytes():
                self._send(answer, "application/octet-stream")
            case _:
                self._send(json.dumps(answer, ensure_ascii=False).encode(), "application/json")

    def _known(self) -> bool:
        """Return True if a request is for this server by its own name, and from no other page."""
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

    def _send_revisions(self, session: LiveSession) -> None:
        """Send each revision as it appears, until the page closes or the server ends."""
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        known = None
        while not session.closed:
            current = session.next_revision(known, BEAT)
            line = f"data: {json.dumps(current.news, ensure_ascii=False)}\n\n" if current is not known else ":\n\n"
            known = current
            try:
                self.wfile.write(line.encode())
                self.wfile.flush()
            except OSError:
                return

    def log_message(self, format: str, *args: Any) -> None:
        """Print nothing, because the page reports everything itself."""
