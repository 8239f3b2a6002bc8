"""The database of a class: an SQLite file whose transactions are on the disk before they return.

Write with `writing()`, read with `reading()`. One thread writes at a time, so that no writer waits for a lock of the
file; readers never wait. Times come from `Clock`, which never goes back, not even when the machine's clock does.
"""

from __future__ import annotations

import datetime
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from sqlalchemy import Connection, create_engine, event, select
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.pool import QueuePool

from reportgen.server.tables import settings

NAME = "class.db"
WAIT = 30
"""Seconds to wait for another program that holds the database."""
LAST = "last_time"
"""Setting with the last time that was given out."""
TICK = datetime.timedelta(microseconds=1)
BEHIND, AHEAD = datetime.timedelta(days=1), datetime.timedelta(days=30)
"""How far the clock may be behind the last stored time, or at the start ahead of it, without being in doubt."""


def wall_time() -> datetime.datetime:
    """Return the time of the machine's clock with its offset from UTC."""
    return datetime.datetime.now().astimezone()


class Clock:
    """Times that only grow: the machine's clock, or just after the last time that was stored.

    The machine's clock is in doubt if it is far from the last stored time. Then that time stays the last one.
    """

    def __init__(self, last: str = "") -> None:
        self.last = datetime.datetime.fromisoformat(last) if last else None
        """The last stored time, None for a new class; not one of a clock that was ahead."""
        self._ahead = self.last is not None and wall_time() - self.last > AHEAD
        self._unsure: datetime.datetime | None = None
        """The last time that was stored while the clock was ahead."""

    def now(self) -> datetime.datetime:
        """Return the present time."""
        now = wall_time()
        last = (self._unsure if self._is_ahead(now) else None) or self.last
        return now if last is None or now > last else last + TICK

    def earliest(self) -> datetime.datetime:
        """Return the present time, or what it is at least while the clock is in doubt."""
        doubt = self.doubt
        return self.now() if doubt is None else min(doubt)

    @property
    def doubt(self) -> tuple[datetime.datetime, datetime.datetime] | None:
        """The time of the machine's clock and the last stored time if they are far from each other."""
        now = wall_time()
        if self.last is not None and (self._is_ahead(now) or self.last - now > BEHIND):
            return now, self.last
        return None

    def stored(self, now: datetime.datetime) -> None:
        """Remember a time that was committed."""
        if self.is_stored(now):
            self.last = now
        else:
            self._unsure = now

    def is_stored(self, now: datetime.datetime) -> bool:
        """Return True if a time may be the last one for later starts: that of a clock that is ahead may not."""
        return not self._is_ahead(now)

    def trust(self) -> None:
        """Take the machine's clock as right."""
        self.last, self._ahead = None, False

    def _is_ahead(self, now: datetime.datetime) -> bool:
        """Return True if the clock was ahead at the start and still is."""
        self._ahead = self._ahead and self.last is not None and now - self.last > AHEAD
        return self._ahead


class Writing:
    """A transaction with its time."""

    def __init__(self, connection: Connection, now: datetime.datetime, earliest: datetime.datetime) -> None:
        self.connection, self.now = connection, now
        self.at = now.isoformat()
        self.earliest = earliest
        """The time by which deadlines are judged: while the clock is in doubt, nobody is refused because of it."""

    def execute(self, statement: Any, rows: Any = None) -> Any:
        return self.connection.execute(statement, rows)


class Database:
    """The database in a folder, brought to the present version when it is opened."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        with suppress(PermissionError):
            folder.chmod(0o700)
        self.path = folder / NAME
        self._lock = threading.Lock()
        # The file has the data of a class: only its owner may read it.
        os.close(os.open(self.path, os.O_CREAT | os.O_RDWR, 0o600))
        self.engine = create_engine(
            f"sqlite:///{self.path}",
            # What students typed is in no error message.
            hide_parameters=True,
            poolclass=QueuePool,
            pool_size=8,
            max_overflow=40,
            connect_args={"timeout": WAIT, "check_same_thread": False, "isolation_level": None},
        )
        event.listen(self.engine, "connect", _prepare)
        event.listen(self.engine, "begin", _begin)
        self._writer = self.engine.execution_options(writes=True)
        self._migrate()
        with self.reading() as connection:
            last = connection.scalar(select(settings.c.value).where(settings.c.name == LAST))
        self.clock = Clock(last or "")
        self.people_changes = 0
        """Number of changes of people and of ends of sessions since the start."""

    def _migrate(self) -> None:
        config = Config()
        config.set_main_option("script_location", str(Path(__file__).parent / "migrations").replace("%", "%%"))
        with self._lock, self._writer.begin() as connection:
            config.attributes["connection"] = connection
            command.upgrade(config, "head")

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A snapshot of the tables."""
        with self.engine.begin() as connection:
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Writing]:
        """A transaction, on the disk when the block ends; an exception undoes it."""
        with self._lock:
            now = self.clock.now()
            with self._writer.begin() as connection:
                yield Writing(connection, now, self.clock.earliest())
                if self.clock.is_stored(now):
                    row = {"name": LAST, "value": now.isoformat()}
                    statement = insert(settings).values(row)
                    connection.execute(
                        statement.on_conflict_do_update(index_elements=["name"], set_={"value": row["value"]})
                    )
            self.clock.stored(now)

    def trust_clock(self) -> None:
        """Take the machine's clock as right from now on, and after the next start."""
        self.clock.trust()
        with self.writing():
            pass

    def close(self) -> None:
        self.engine.dispose()


def _prepare(connection: Any, _: Any) -> None:
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", f"busy_timeout={WAIT * 1000}"):
        connection.execute(f"PRAGMA {pragma}")


def _begin(connection: Connection) -> None:
    # A writer takes its lock at once: one that read first could not write after another writer.
    writes = connection.get_execution_options().get("writes")
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
