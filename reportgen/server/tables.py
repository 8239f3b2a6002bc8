"""Tables of a class in the browser. A change here needs a new file in `migrations/versions/`."""

from __future__ import annotations

from sqlalchemy import Boolean, Column, ForeignKey, Index, Integer, LargeBinary, MetaData, String, Table, Text

TIME = 40
"""Length of a time in ISO 8601 with microseconds and offset."""
metadata = MetaData()

people = Table(
    "people",
    metadata,
    *(
        Column("folder", String(80), primary_key=True),
        Column("role", String(12), nullable=False),
        Column("id", Text, nullable=False),
        Column("name", Text, nullable=False, server_default=""),
        Column("nonce", LargeBinary(16), nullable=False, unique=True),
        Column("opened_at", String(TIME)),
        Column("closes", String(TIME)),
        Column("drawn", String(64), nullable=False, server_default=""),
        Column("dropped", Boolean, nullable=False, server_default="0"),
    ),
)
"""Students by their folder, and instructors. `nonce` is the secret of the personal link; `drawn` names the variant that
the cells belong to."""

sessions = Table(
    "sessions",
    metadata,
    *(
        Column("digest", String(64), primary_key=True),
        Column("folder", ForeignKey("people.folder"), nullable=False),
        Column("nonce", LargeBinary(16), nullable=False),
        Column("ends", String(TIME), nullable=False),
    ),
)

saves = Table(
    "saves",
    metadata,
    *(
        Column("revision", Integer, primary_key=True),
        Column("folder", ForeignKey("people.folder"), nullable=False),
        Column("client", String(64), nullable=False),
        Column("drawn", String(64), nullable=False),
        Column("quantity", String(120), nullable=False),
        Column("position", Integer, nullable=False),
        Column("text", Text, nullable=False),
        Column("at", String(TIME), nullable=False),
        Index("saves_client", "folder", "client", unique=True),
    ),
    sqlite_autoincrement=True,
)
"""Every cell that was ever saved."""

cells = Table(
    "cells",
    metadata,
    *(
        Column("folder", ForeignKey("people.folder"), primary_key=True),
        Column("drawn", String(64), primary_key=True),
        Column("quantity", String(120), primary_key=True),
        Column("position", Integer, primary_key=True),
        Column("revision", ForeignKey("saves.revision"), nullable=False),
        Column("text", Text, nullable=False),
        Column("at", String(TIME), nullable=False),
    ),
)
"""The present text of each cell."""

uploads = Table(
    "uploads",
    metadata,
    *(
        Column("number", Integer, primary_key=True),
        Column("folder", ForeignKey("people.folder"), nullable=False),
        Column("client", String(64), nullable=False),
        Column("drawn", String(64), nullable=False),
        Column("name", Text, nullable=False),
        Column("size", Integer, nullable=False),
        Column("sha256", String(64), nullable=False),
        Column("at", String(TIME), nullable=False),
        Column("state", String(12), nullable=False, server_default="queued"),
        Column("values_read", Integer, nullable=False, server_default="0"),
        Column("lines", Text, nullable=False, server_default="[]"),
        Index("uploads_client", "folder", "client", unique=True),
    ),
    sqlite_autoincrement=True,
)

handins = Table(
    "handins",
    metadata,
    *(
        Column("number", Integer, primary_key=True),
        Column("folder", ForeignKey("people.folder"), nullable=False),
        Column("client", String(64), nullable=False),
        Column("drawn", String(64), nullable=False),
        Column("revision", Integer, nullable=False),
        Column("filled", Integer, nullable=False),
        Column("sha256", String(64), nullable=False),
        Column("at", String(TIME), nullable=False),
        Index("handins_client", "folder", "client", unique=True),
    ),
    sqlite_autoincrement=True,
)
"""Hand-ins of the sheet; `revision` is the last save that belongs to it."""

checks = Table(
    "checks",
    metadata,
    *(
        Column("number", Integer, primary_key=True),
        Column("folder", ForeignKey("people.folder"), nullable=False),
        Column("client", String(64), nullable=False),
        Column("asked", Text, nullable=False),
        Column("answer", Text, nullable=False, server_default=""),
        Column("at", String(TIME), nullable=False),
        Index("checks_client", "folder", "client", unique=True),
    ),
    sqlite_autoincrement=True,
)

marks = Table(
    "marks",
    metadata,
    *(
        Column("folder", ForeignKey("people.folder"), primary_key=True),
        Column("mark", Text, nullable=False),
        Column("content", Text, nullable=False),
        Column("at", String(TIME), nullable=False),
    ),
)
"""What the last marking says of each student, as JSON."""

settings = Table(
    "settings", metadata, *(Column("name", String(40), primary_key=True), Column("value", Text, nullable=False))
)

log = Table(
    "log",
    metadata,
    *(
        Column("number", Integer, primary_key=True),
        Column("at", String(TIME), nullable=False),
        Column("who", String(80), nullable=False),
        Column("what", String(40), nullable=False),
        Column("folder", String(80), nullable=False, server_default=""),
        Column("detail", Text, nullable=False, server_default=""),
    ),
    sqlite_autoincrement=True,
)
"""What instructors did, and what was refused."""
