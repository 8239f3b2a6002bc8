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


def wall_time() -> datetime.datetime:
    """Return the time of the machine's clock with its offset from UTC."""
    return datetime.datetime.now().astimezone()


class Clock:
    """Times that only grow: the machine's clock, or just after the last time that was stored."""

    def __init__(self, last: str = "") -> None:
        self._last = datetime.datetime.fromisoformat(last) if last else None

    def now(self) -> datetime.datetime:
        """Return the present time."""
        now = wall_time()
        return now if self._last is None or now > self._last else self._last + TICK

    def stored(self, now: datetime.datetime) -> None:
        """Remember a time that was committed."""
        self._last = now


class Writing:
    """A transaction with its time."""

    def __init__(self, connection: Connection, now: datetime.datetime) -> None:
        self.connection, self.now = connection, now
        self.at = now.isoformat()

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
                yield Writing(connection, now)
                row = {"name": LAST, "value": now.isoformat()}
                statement = insert(settings).values(row)
                connection.execute(
                    statement.on_conflict_do_update(index_elements=["name"], set_={"value": row["value"]})
                )
            self.clock.stored(now)

    def close(self) -> None:
        self.engine.dispose()


def _prepare(connection: Any, _: Any) -> None:
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", f"busy_timeout={WAIT * 1000}"):
        connection.execute(f"PRAGMA {pragma}")


def _begin(connection: Connection) -> None:
    # A writer takes its lock at once: one that read first could not write after another writer.
    writes = connection.get_execution_options().get("writes")
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
