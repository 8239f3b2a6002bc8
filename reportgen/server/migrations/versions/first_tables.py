"""The tables of the first version."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None


def upgrade() -> None:
    op.create_table(
        "log",
        *(
            sa.Column("number", sa.Integer(), nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.Column("who", sa.String(length=80), nullable=False),
            sa.Column("what", sa.String(length=40), nullable=False),
            sa.Column("folder", sa.String(length=80), server_default="", nullable=False),
            sa.Column("detail", sa.Text(), server_default="", nullable=False),
            sa.PrimaryKeyConstraint("number"),
        ),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "people",
        *(
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("role", sa.String(length=12), nullable=False),
            sa.Column("id", sa.Text(), nullable=False),
            sa.Column("name", sa.Text(), server_default="", nullable=False),
            sa.Column("nonce", sa.LargeBinary(length=16), nullable=False),
            sa.Column("opened_at", sa.String(length=40), nullable=True),
            sa.Column("closes", sa.String(length=40), nullable=True),
            sa.Column("drawn", sa.String(length=64), server_default="", nullable=False),
            sa.Column("dropped", sa.Boolean(), server_default="0", nullable=False),
            sa.PrimaryKeyConstraint("folder"),
            sa.UniqueConstraint("nonce"),
        ),
    )
    op.create_table(
        "settings",
        *(
            sa.Column("name", sa.String(length=40), nullable=False),
            sa.Column("value", sa.Text(), nullable=False),
            sa.PrimaryKeyConstraint("name"),
        ),
    )
    op.create_table(
        "checks",
        *(
            sa.Column("number", sa.Integer(), nullable=False),
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("client", sa.String(length=64), nullable=False),
            sa.Column("asked", sa.Text(), nullable=False),
            sa.Column("answer", sa.Text(), server_default="", nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.PrimaryKeyConstraint("number"),
        ),
        sqlite_autoincrement=True,
    )
    op.create_index("checks_client", "checks", ["folder", "client"], unique=True)
    op.create_table(
        "handins",
        *(
            sa.Column("number", sa.Integer(), nullable=False),
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("client", sa.String(length=64), nullable=False),
            sa.Column("drawn", sa.String(length=64), nullable=False),
            sa.Column("revision", sa.Integer(), nullable=False),
            sa.Column("filled", sa.Integer(), nullable=False),
            sa.Column("sha256", sa.String(length=64), nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.PrimaryKeyConstraint("number"),
        ),
        sqlite_autoincrement=True,
    )
    op.create_index("handins_client", "handins", ["folder", "client"], unique=True)
    op.create_table(
        "marks",
        *(
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("mark", sa.Text(), nullable=False),
            sa.Column("content", sa.Text(), nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.PrimaryKeyConstraint("folder"),
        ),
    )
    op.create_table(
        "saves",
        *(
            sa.Column("revision", sa.Integer(), nullable=False),
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("client", sa.String(length=64), nullable=False),
            sa.Column("drawn", sa.String(length=64), nullable=False),
            sa.Column("quantity", sa.String(length=120), nullable=False),
            sa.Column("position", sa.Integer(), nullable=False),
            sa.Column("text", sa.Text(), nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.PrimaryKeyConstraint("revision"),
        ),
        sqlite_autoincrement=True,
    )
    op.create_index("saves_client", "saves", ["folder", "client"], unique=True)
    op.create_table(
        "sessions",
        *(
            sa.Column("digest", sa.String(length=64), nullable=False),
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("nonce", sa.LargeBinary(length=16), nullable=False),
            sa.Column("ends", sa.String(length=40), nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.PrimaryKeyConstraint("digest"),
        ),
    )
    op.create_table(
        "uploads",
        *(
            sa.Column("number", sa.Integer(), nullable=False),
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("client", sa.String(length=64), nullable=False),
            sa.Column("drawn", sa.String(length=64), nullable=False),
            sa.Column("name", sa.Text(), nullable=False),
            sa.Column("size", sa.Integer(), nullable=False),
            sa.Column("sha256", sa.String(length=64), nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.Column("state", sa.String(length=12), server_default="queued", nullable=False),
            sa.Column("values_read", sa.Integer(), server_default="0", nullable=False),
            sa.Column("lines", sa.Text(), server_default="[]", nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.PrimaryKeyConstraint("number"),
        ),
        sqlite_autoincrement=True,
    )
    op.create_index("uploads_client", "uploads", ["folder", "client"], unique=True)
    op.create_table(
        "cells",
        *(
            sa.Column("folder", sa.String(length=80), nullable=False),
            sa.Column("drawn", sa.String(length=64), nullable=False),
            sa.Column("quantity", sa.String(length=120), nullable=False),
            sa.Column("position", sa.Integer(), nullable=False),
            sa.Column("revision", sa.Integer(), nullable=False),
            sa.Column("text", sa.Text(), nullable=False),
            sa.Column("at", sa.String(length=40), nullable=False),
            sa.ForeignKeyConstraint(["folder"], ["people.folder"]),
            sa.ForeignKeyConstraint(["revision"], ["saves.revision"]),
            sa.PrimaryKeyConstraint("folder", "drawn", "quantity", "position"),
        ),
    )
