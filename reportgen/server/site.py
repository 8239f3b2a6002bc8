"""What every route needs: the class, its store and links, the queue, and who asks."""

from __future__ import annotations

import asyncio
import datetime
import hmac
import re
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any
from urllib.parse import urlsplit

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response

from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.marking.marking_policy import Browser
from reportgen.server import pages
from reportgen.server.class_folder import ClassFolder
from reportgen.server.database import Database
from reportgen.server.guards import LOGGER, RateLimit, Refusal
from reportgen.server.links import DESK, Links, Person
from reportgen.server.marking_queue import MarkingQueue, Queue
from reportgen.server.store import Store, Window

LANGUAGE = "language"
CLIENT = re.compile(r"[A-Za-z0-9_-]{8,64}")


@dataclass
class Site:
    """A class that is being served at an address."""

    folder: ClassFolder
    base_url: str
    own_queue: Queue | None = None
    """Where work is done, if not in processes of its own."""
    database: Database = field(init=False)
    marking: bool = False
    """True while the class is being marked."""
    prepares: bool = False
    """True if all sheets and keys are made at the start, so that nobody waits for them later."""

    def __post_init__(self) -> None:
        self.database = Database(self.folder.server)
        self.store = Store(self.database)
        self.links = Links(self.database, self.folder.server)
        self.queue: Queue = self.own_queue or MarkingQueue(self.language)
        self.attempts = RateLimit(60, 60)
        """Links and codes that were wrong, for each address; a whole class may have one."""
        self.guesses = RateLimit(20, 3600)
        """Wrong codes for one id."""
        self.requests = RateLimit(600, 60)
        """Messages of one session."""
        self.files = RateLimit(30, 60)
        self.reading: set[int] = set()
        """Uploads that wait to be read."""
        self.laying: dict[str, asyncio.Lock] = {}
        """Each student's lock is held while the files of the student are written."""
        self.receiving = asyncio.Semaphore(4)
        """Held while an upload is in memory."""
        self.papers: dict[str, asyncio.Future[Any]] = {}
        """Files of the whole class that are being made, by name."""
        self.changing = asyncio.Lock()
        """Held while variants or the roster change."""
        self.backing_up = asyncio.Lock()
        """Held while a copy of the class is made."""
        self.log = LOGGER
        self._mistake = ""
        """A mistake in the policy that the log has."""
        self._sheets: dict[str, tuple[tuple[Any, ...], dict[str, Any]]] = {}

    @cached_property
    def language(self) -> Language:
        return self.folder.language

    @property
    def secure(self) -> bool:
        return self.base_url.startswith("https:")

    @property
    def cookie(self) -> str:
        """The name of the session's cookie: a browser sends those of all ports of a host to each."""
        return f"reportgen-{self.links.class_id}"

    @property
    def hosts(self) -> frozenset[str]:
        """The names under which the class may be asked for."""
        parts = urlsplit(self.base_url)
        own = {parts.netloc}
        if parts.hostname in ("127.0.0.1", "localhost"):
            port = f":{parts.port}" if parts.port else ""
            own |= {f"127.0.0.1{port}", f"localhost{port}"}
        return frozenset(own)

    @property
    def browser(self) -> Browser:
        """What students may do; after a mistake in the policy, what they could do before."""
        policy, mistake = self.folder.valid_policy()
        if mistake is not None and str(mistake) != self._mistake:
            self.log.error("%s", mistake)
        self._mistake = "" if mistake is None else str(mistake)
        return policy.browser

    def sheet(self, folder: str) -> dict[str, Any] | None:
        """Return the answer sheet of a student; None if it is not made yet."""
        try:
            files = (self.folder.assignment(folder), self.folder.sheets / f"{folder}.json")
            changed = (str(self.folder.policy().ask), *(file.stat().st_mtime_ns for file in files))
        except OSError:
            return None
        known = self._sheets.get(folder)
        if known is None or known[0] != changed:
            made = self.folder.sheet(folder)
            if made is None:
                return None
            self._sheets[folder] = known = changed, made
        return known[1]

    def window(self, person: Person) -> Window:
        """Return until when a student may work: the own deadline, or that of the class, or the release of the marks."""
        if person.closes:
            return Window(datetime.datetime.fromisoformat(person.closes))
        closes = self.browser.closes
        if closes is not None:
            return Window(closes.astimezone())
        at = self.store.setting("released_at") or self.store.setting("marked_at")
        return Window(datetime.datetime.fromisoformat(at) if self.released and at else None)

    def shows_result(self, person: Person) -> bool:
        """Return True if a student may see the marks, and with them right values: whose time is not over may not."""
        closes = self.window(person).closes
        return self.released and closes is not None and self.database.clock.earliest() > closes

    @property
    def clock_doubt(self) -> dict[str, str] | None:
        """What the machine's clock says and the last stored time, if they do not go together."""
        doubt = self.database.clock.doubt
        return None if doubt is None else {"now": doubt[0].isoformat(), "last": doubt[1].isoformat()}

    def link(self, folder: str) -> str:
        """Return a personal link."""
        return f"{self.base_url}/in/{self.links.token(folder)}"

    def drawn(self, folder: str) -> str:
        """Return the name of a student's present variant."""
        row = self.store.people().get(folder)
        return "" if row is None else str(row.drawn)

    @property
    def released(self) -> bool:
        return self.store.setting("released") == "yes"

    def explain(self, request: Request, refusal: Refusal) -> Response:
        """Return the answer to a refused request: a page for somebody who opens one, else JSON."""
        language = self.language_of(request)
        message = pages.explained(language, refusal.code)
        wants_page = request.method == "GET" and "text/html" in request.headers.get("accept", "")
        if wants_page and refusal.code == "signed_out":
            return self.page(request, "sign_in", None, refusal.status, failed=False, number="")
        if wants_page:
            said = {"code": refusal.code, "message": message, "lines": refusal.more.get("lines", [])}
            return self.page(request, "refused", None, refusal.status, **said)
        return JSONResponse({"error": refusal.code, "message": message, **refusal.more}, refusal.status)

    # --- who asks

    def language_of(self, request: Request) -> Language:
        """Return the language that somebody chose, or that of the class."""
        chosen = request.cookies.get(LANGUAGE)
        return chosen if chosen in languages() else self.language

    async def person(self, request: Request, role: str) -> Person:
        """Return who asks; raise `Refusal` for a stranger, and for somebody without this role."""
        cookie = request.cookies.get(self.cookie, "")
        person = self.links.known(cookie)
        if person is None and cookie:
            person = await run_in_threadpool(self.links.of_cookie, cookie)
        if person is None:
            raise Refusal("signed_out")
        request.scope.setdefault("state", {})["folder"] = person.folder
        if person.role != role:
            raise Refusal("unknown")
        return person

    def check_token(self, request: Request, person: Person, form: FormData | None = None) -> None:
        """Raise `Refusal` for a message that does not come from a page of the session."""
        token = request.headers.get("x-csrf-token") or (form.get("csrf") if form is not None else "")
        if not isinstance(token, str) or not hmac.compare_digest(token.encode(), person.csrf.encode()):
            raise Refusal("forbidden")
        self.requests.count(person.session)

    def page(self, request: Request, name: str, person: Person | None, status: int = 200, **content: Any) -> Response:
        """Return a page of the class."""
        csrf = person.csrf if person is not None else ""
        language = self.language_of(request)
        html = pages.page(name, language, csrf=csrf, person=person, **content)
        return HTMLResponse(html, status)


Route = Callable[[Request, Site, Person], Awaitable[Response]]


def by(role: str, route: Route, form: bool = False) -> Callable[[Request], Awaitable[Response]]:
    """Return a route that only people of a role reach; a POST must carry the token of the session.

    A route that takes a `form` looks for the token in it.
    """

    async def reached(request: Request) -> Response:
        site: Site = request.app.state.site
        person = await site.person(request, role)
        if request.method == "POST" and not form:
            site.check_token(request, person)
        return await route(request, site, person)

    return reached


def client_of(content: Mapping[str, Any]) -> str:
    """Return the name by which something is stored once."""
    client = content.get("client")
    if not isinstance(client, str) or not CLIENT.fullmatch(client):
        raise Refusal("malformed")
    return client


__all__ = ["DESK", "LANGUAGE", "Route", "Site", "by", "client_of"]
