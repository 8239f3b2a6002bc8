"""What stands before every route: the host, sizes, times and rates of requests, headers of answers, errors in one line.

A refusal is a `Refusal`; nothing of an unexpected error reaches the browser but its being one.
"""

from __future__ import annotations

import asyncio
import errno
import json
import logging
import time
from collections import OrderedDict, deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy.exc import OperationalError
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOGGER = logging.getLogger("reportgen.server")
SMALL, LARGE = 300_000, 50_000_000
"""Largest request (bytes): cells and forms, and an upload."""
FILES = frozenset({"/me/uploads", "/desk/gradebook"})
"""Paths to which files are sent."""
SLOW, SLOWEST = 20.0, 300.0
"""Seconds for the next piece of a request, and for the whole of it."""
CONTENT_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "frame-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": CONTENT_POLICY,
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    # With "no-referrer", forms would be sent from the origin "null".
    "Referrer-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
STATUS = {
    "malformed": 400,
    "signed_out": 401,
    "forbidden": 403,
    "unknown": 404,
    "closed": 409,
    "redrawn": 409,
    "used_up": 409,
    "too_early": 409,
    "not_released": 409,
    "too_large": 413,
    "file_too_large": 413,
    "too_often": 429,
    "failed": 500,
    "no_room": 507,
}
"""Codes of refusals; the words have a sentence for each."""


class Refusal(Exception):
    """A request that is not answered, with the code of the reason."""

    def __init__(self, code: str, **more: Any) -> None:
        self.code, self.status, self.more = code, STATUS[code], more
        super().__init__(code)


@dataclass
class RateLimit:
    """Counts what somebody does within a time."""

    most: int
    seconds: float
    _times: OrderedDict[str, deque[float]] = field(default_factory=OrderedDict)

    def check(self, who: str) -> None:
        """Raise `Refusal` if somebody was counted too often."""
        times = self._times.get(who, deque())
        now = time.monotonic()
        while times and times[0] < now - self.seconds:
            times.popleft()
        if len(times) >= self.most:
            raise Refusal("too_often")

    def count(self, who: str) -> None:
        """Count once more; raise `Refusal` for too often."""
        self.check(who)
        self._times.setdefault(who, deque()).append(time.monotonic())
        self._times.move_to_end(who)
        while len(self._times) > 10_000:
            self._times.popitem(last=False)


class Guard:
    """The middleware around all routes."""

    def __init__(self, app: ASGIApp, hosts: frozenset[str], explain: Callable[[Request, Refusal], Response]) -> None:
        self.app, self.hosts, self.explain = app, hosts, explain

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        begun = False

        async def headed(message: Message) -> None:
            nonlocal begun
            if message["type"] == "http.response.start":
                begun = True
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
                self._tell(scope, message["status"])
            await send(message)

        try:
            self._admit(scope)
            await self.app(scope, self._limited(scope, receive), headed)
        except Exception as error:
            refusal = self._refusal(scope, error)
            if not begun:
                await self._answer(scope, refusal)(scope, receive, headed)

    def _refusal(self, scope: Scope, error: Exception) -> Refusal:
        if isinstance(error, Refusal):
            return error
        if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
            return Refusal("no_room")
        if isinstance(error, OperationalError) and "full" in str(error.orig):
            return Refusal("no_room")
        LOGGER.error("%s failed: %s", _named(scope), type(error).__name__, exc_info=error)
        return Refusal("failed")

    def _answer(self, scope: Scope, refusal: Refusal) -> Response:
        answer = self.explain(Request(scope), refusal)
        if refusal.status in (413, 400):
            # What was not read would be taken for the next request.
            answer.headers["Connection"] = "close"
        return answer

    def _admit(self, scope: Scope) -> None:
        headers = Headers(scope=scope)
        if headers.get("host", "") not in self.hosts:
            raise Refusal("forbidden")
        if scope["method"] not in ("GET", "HEAD", "POST"):
            raise Refusal("malformed")
        if scope["method"] == "POST":
            origin, site = headers.get("origin"), headers.get("sec-fetch-site")
            if (origin is not None and origin.split("//")[-1] not in self.hosts) or site in ("cross-site", "same-site"):
                raise Refusal("forbidden")
            length = headers.get("content-length")
            if length is not None and (not length.isascii() or not length.isdecimal()):
                raise Refusal("malformed")
            if length is not None and int(length) > self._most(scope):
                raise self._too_large(scope)

    def _most(self, scope: Scope) -> int:
        return LARGE + SMALL if scope["path"] in FILES else SMALL

    def _too_large(self, scope: Scope) -> Refusal:
        return Refusal("file_too_large" if scope["path"] in FILES else "too_large")

    def _limited(self, scope: Scope, receive: Receive) -> Receive:
        most, got, end = self._most(scope), 0, time.monotonic() + SLOWEST
        whole = False

        async def limited() -> Message:
            nonlocal got, whole
            if whole:
                return await receive()
            try:
                message = await asyncio.wait_for(receive(), min(SLOW, max(end - time.monotonic(), 0.1)))
            except TimeoutError:
                raise Refusal("malformed") from None
            got += len(message.get("body", b""))
            whole = not message.get("more_body", False)
            if got > most:
                raise self._too_large(scope)
            return message

        return limited

    def _tell(self, scope: Scope, status: int) -> None:
        who = scope.get("state", {}).get("folder", "-")
        level = logging.WARNING if status in (400, 401, 403, 404, 413, 429) or status >= 500 else logging.INFO
        LOGGER.log(level, "%s %s %s", _named(scope), status, who)


def _named(scope: Scope) -> str:
    """Return the request for the log: its route, never the path, which may be a personal link."""
    route = scope.get("route")
    path = getattr(route, "path", None)
    return f"{scope['method']} {path or '-'}"


async def json_of(request: Request) -> dict[str, Any]:
    """Return the object that a request sends."""
    if request.headers.get("content-type", "").partition(";")[0].strip() != "application/json":
        raise Refusal("malformed")
    try:
        content = json.loads(await request.body())
    except (ValueError, RecursionError):
        raise Refusal("malformed") from None
    if not isinstance(content, dict):
        raise Refusal("malformed")
    return content
