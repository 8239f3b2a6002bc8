"""Who somebody is: personal links, codes to type, and sessions.

A link has 128 random bits, signed. Only its nonce is stored; a new nonce ends the link, the code and all sessions that
began with it. The secret that signs is in `secret`, readable by its owner alone.
"""

from __future__ import annotations

import base64
import datetime
import hashlib
import hmac
import os
import secrets
from pathlib import Path
from typing import Any, Literal

from itsdangerous import BadSignature, Signer
from sqlalchemy import Row, delete, select, update
from sqlalchemy.dialects.sqlite import insert

from reportgen.base.records import Record
from reportgen.classes.roster import comparable
from reportgen.server.database import Database
from reportgen.server.tables import people, sessions

PersonRole = Literal["student", "instructor"]
DESK = "desk"
"""Folder of the instructor; a student's folder is never in lower case."""
SESSION = datetime.timedelta(days=30)
MOST_KNOWN = 5000
"""Sessions that are kept in memory."""
CODE = 10
"""Length of a code, 50 bits."""
ALPHABET = str.maketrans("ABCDEFGHIJKLMNOPQRSTUVWXYZ234567", "abcdefghjkmnpqrstuvwxyz023456789")


class Person(Record):
    """Somebody who has signed in; `csrf` is the token of the session's forms."""

    folder: str
    role: str
    id: str
    name: str
    drawn: str
    closes: str | None
    session: str
    csrf: str


class Links:
    """The links and sessions of a class."""

    def __init__(self, database: Database, folder: Path) -> None:
        self.database = database
        self.secret = _secret(folder / "secret")
        self._links = Signer(self.secret, salt="link", digest_method=hashlib.sha256)
        self._known: dict[str, tuple[int, Person | None, datetime.datetime | None]] = {}
        """Sessions by their cookies, as they were at a number of changes."""
        self._cookies = Signer(self.secret, salt="cookie", digest_method=hashlib.sha256)
        self.class_id = hmac.new(self.secret, b"class", hashlib.sha256).hexdigest()[:12]
        """Distinguishes this class in a browser from others at the same host or address."""

    def add(self, folder: str, role: PersonRole, id: str, name: str, drawn: str = "") -> None:
        """Add somebody, or renew the name and the variant of somebody known, whose link stays."""
        row = {"folder": folder, "role": role, "id": id, "name": name, "drawn": drawn, "dropped": False}
        statement = insert(people).values(nonce=secrets.token_bytes(16), **row)
        with self.database.writing() as writing:
            writing.execute(statement.on_conflict_do_update(index_elements=["folder"], set_=row))
        self.database.people_changes += 1

    def token(self, folder: str) -> str:
        """Return the last part of the personal link."""
        return self._links.sign(_text(self._nonce(folder))).decode()

    def code(self, folder: str) -> str:
        """Return the code that can be typed with the id."""
        return self._code(self._nonce(folder))

    def renew(self, folder: str) -> None:
        """End the link, the code and the sessions of somebody; a new link and code take their place."""
        with self.database.writing() as writing:
            writing.execute(update(people).where(people.c.folder == folder).values(nonce=secrets.token_bytes(16)))
            writing.execute(delete(sessions).where(sessions.c.folder == folder))
        self.database.people_changes += 1

    def of_token(self, token: str) -> Row[Any] | None:
        """Return who has a link; None for a forged or ended one."""
        try:
            nonce = _bytes(self._links.unsign(token).decode())
        except (BadSignature, ValueError):
            return None
        with self.database.reading() as connection:
            return connection.execute(select(people).where((people.c.nonce == nonce) & ~people.c.dropped)).first()

    def of_code(self, id: str, code: str) -> Row[Any] | None:
        """Return who has an id and a code."""
        typed = code.strip().lower().replace("-", "").replace(" ", "")
        with self.database.reading() as connection:
            rows = connection.execute(select(people).where(~people.c.dropped)).all()
        row = next((row for row in rows if comparable(row.id) == comparable(id.strip())), None)
        # The time of the comparison must not tell whether there is such an id.
        right = self._code(row.nonce if row is not None else bytes(16))
        return row if hmac.compare_digest(right.encode(), typed.encode()) and row is not None else None

    def sign_in(self, row: Row[Any]) -> str:
        """Begin a session; return its cookie."""
        session = secrets.token_urlsafe(16)
        with self.database.writing() as writing:
            ends = (writing.now + SESSION).isoformat()
            writing.execute(
                insert(sessions).values(digest=_digest(session), folder=row.folder, nonce=row.nonce, ends=ends)
            )
            if row.opened_at is None:
                writing.execute(update(people).where(people.c.folder == row.folder).values(opened_at=writing.at))
        return self._cookies.sign(session).decode()

    def known(self, cookie: str) -> Person | None:
        """Return who has a session without a look into the database; None if it has to be looked up."""
        changes, person, ends = self._known.get(cookie, (-1, None, None))
        current = changes == self.database.people_changes and ends is not None and self.database.clock.now() <= ends
        return person if current else None

    def of_cookie(self, cookie: str) -> Person | None:
        """Return who has a session; None for a forged, ended or expired one."""
        changes = self.database.people_changes
        try:
            session = self._cookies.unsign(cookie).decode()
        except (BadSignature, ValueError):
            return None
        digest = _digest(session)
        joined = select(people, sessions.c.ends).join(
            sessions, (sessions.c.folder == people.c.folder) & (sessions.c.nonce == people.c.nonce)
        )
        with self.database.reading() as connection:
            row = connection.execute(joined.where((sessions.c.digest == digest) & ~people.c.dropped)).first()
        if row is None or (ends := datetime.datetime.fromisoformat(row.ends)) < self.database.clock.now():
            return None
        csrf = hmac.new(self.secret, b"csrf" + session.encode(), hashlib.sha256).hexdigest()
        about = {name: getattr(row, name) for name in ("folder", "role", "id", "name", "drawn", "closes")}
        person = Person(**about, session=digest, csrf=csrf)
        if len(self._known) > MOST_KNOWN:
            self._known.clear()
        self._known[cookie] = changes, person, ends
        return person

    def sign_out(self, person: Person) -> None:
        with self.database.writing() as writing:
            writing.execute(delete(sessions).where(sessions.c.digest == person.session))
        self.database.people_changes += 1

    def _nonce(self, folder: str) -> bytes:
        with self.database.reading() as connection:
            nonce = connection.scalar(select(people.c.nonce).where(people.c.folder == folder))
        if nonce is None:
            raise KeyError(folder)
        return bytes(nonce)

    def _code(self, nonce: bytes) -> str:
        made = hmac.new(self.secret, b"code" + nonce, hashlib.sha256).digest()
        return base64.b32encode(made)[:CODE].decode().translate(ALPHABET)


def _digest(session: str) -> str:
    return hashlib.sha256(session.encode()).hexdigest()


def _text(nonce: bytes) -> str:
    return base64.urlsafe_b64encode(nonce).rstrip(b"=").decode()


def _bytes(text: str) -> bytes:
    return base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))


def _secret(path: Path) -> bytes:
    """Return the secret of a class, made on first use."""
    try:
        made = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)
    except FileExistsError:
        return path.read_bytes()
    with os.fdopen(made, "wb") as file:
        file.write(secrets.token_bytes(32))
        file.flush()
        os.fsync(file.fileno())
    return path.read_bytes()
