"""What students do, stored: cells, uploads, hand-ins, checks. Each has the `client` name by which it is stored once."""

from __future__ import annotations

import datetime
import json
from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Row, Table, func, select, update
from sqlalchemy.dialects.sqlite import insert

from reportgen.base.records import Record
from reportgen.server.database import Database, Writing
from reportgen.server.tables import cells, checks, handins, log, marks, people, saves, settings, uploads


class ClosedError(Exception):
    """The student's time is over."""


class UsedUpError(Exception):
    """The policy allows no more uploads or checks."""


class TypedCell(Record):
    """A cell as the browser sends it."""

    client: str
    quantity: str
    position: int
    text: str


class Saved(Record):
    """A stored cell."""

    entry: TypedCell
    at: str
    revision: int


class Window(Record):
    """Until when a student may work; None for no end."""

    closes: datetime.datetime | None

    def check(self, now: datetime.datetime) -> None:
        """Raise `ClosedError` if the time is over."""
        if self.closes is not None and now > self.closes:
            raise ClosedError


class Store:
    """The rows of a class."""

    def __init__(self, database: Database) -> None:
        self.database = database

    # --- cells --------------------------------------------------------------------------------------

    def save(self, folder: str, drawn: str, entries: Sequence[TypedCell], window: Window) -> list[Saved]:
        """Store cells in one transaction, in their order; a `client` that was stored before is not stored again."""
        stored: list[Saved] = []
        with self.database.writing() as writing:
            for entry in entries:
                known = self._known(writing, saves, folder, entry.client)
                if known is not None:
                    stored.append(Saved(entry, known.at, known.revision))
                    continue
                window.check(writing.earliest)
                row = {
                    "folder": folder,
                    "drawn": drawn,
                    "quantity": entry.quantity,
                    "position": entry.position,
                    "text": entry.text,
                    "at": writing.at,
                }
                made = writing.execute(insert(saves).values(client=entry.client, **row))
                (revision,) = made.inserted_primary_key
                present = insert(cells).values(revision=revision, **row)
                new = {"revision": revision, "text": entry.text, "at": writing.at}
                keys = ["folder", "drawn", "quantity", "position"]
                writing.execute(present.on_conflict_do_update(index_elements=keys, set_=new))
                stored.append(Saved(entry, writing.at, revision))
        return stored

    def cells(self, folder: str, drawn: str, since: int = 0) -> Sequence[Row[Any]]:
        """Return the present cells of a student's variant that were saved after a revision."""
        wanted = (cells.c.folder == folder) & (cells.c.drawn == drawn) & (cells.c.revision > since)
        with self.database.reading() as connection:
            return connection.execute(select(cells).where(wanted).order_by(cells.c.revision)).all()

    def cells_at(self, folder: str, drawn: str, revision: int) -> dict[tuple[str, int], str]:
        """Return the cells as they were at a revision."""
        wanted = (saves.c.folder == folder) & (saves.c.drawn == drawn) & (saves.c.revision <= revision)
        with self.database.reading() as connection:
            rows = connection.execute(select(saves).where(wanted).order_by(saves.c.revision)).all()
        return {(row.quantity, row.position): row.text for row in rows}

    def times(self, folder: str) -> set[str]:
        """Return the times of all saves and hand-ins of a student."""
        with self.database.reading() as connection:
            made = (select(table.c.at).where(table.c.folder == folder) for table in (saves, handins))
            return {at for statement in made for at in connection.scalars(statement)}

    # --- uploads ------------------------------------------------------------------------------------

    def add_upload(
        self, folder: str, client: str, about: Mapping[str, Any], window: Window, most: int | None
    ) -> Row[Any]:
        """Store an upload whose file is on the disk; `about` has its variant, name, size and SHA-256."""
        with self.database.writing() as writing:
            known = self._known(writing, uploads, folder, client)
            if known is not None:
                return known
            window.check(writing.earliest)
            if most is not None and self._count(writing, uploads, folder) >= most:
                raise UsedUpError
            writing.execute(insert(uploads).values(folder=folder, client=client, at=writing.at, **about))
            made = self._known(writing, uploads, folder, client)
            assert made is not None, "it was inserted"
            return made

    def settle_upload(self, number: int, state: str, values: int, lines: Sequence[str]) -> None:
        """Store what was read in an upload."""
        with self.database.writing() as writing:
            text = json.dumps(list(lines), ensure_ascii=False)
            said = {"state": state, "values_read": values, "lines": text}
            writing.execute(update(uploads).where(uploads.c.number == number).values(said))

    def uploads(self, folder: str | None = None, state: str | None = None) -> Sequence[Row[Any]]:
        """Return the uploads of a student, or of all, in their order."""
        statement = select(uploads).order_by(uploads.c.number)
        if folder is not None:
            statement = statement.where(uploads.c.folder == folder)
        if state is not None:
            statement = statement.where(uploads.c.state == state)
        with self.database.reading() as connection:
            return connection.execute(statement).all()

    # --- hand-ins and checks ------------------------------------------------------------------------

    def hand_in(self, folder: str, client: str, drawn: str, sheet: Mapping[str, Any], window: Window) -> Row[Any]:
        """Store a hand-in; `sheet` has its revision, the number of filled cells and the SHA-256 of its content."""
        with self.database.writing() as writing:
            if (known := self._known(writing, handins, folder, client)) is not None:
                return known
            window.check(writing.earliest)
            writing.execute(insert(handins).values(folder=folder, client=client, drawn=drawn, at=writing.at, **sheet))
            made = self._known(writing, handins, folder, client)
            assert made is not None, "it was inserted"
            return made

    def handin(self, folder: str, drawn: str) -> Row[Any] | None:
        """Return the last hand-in of a student's variant."""
        wanted = (handins.c.folder == folder) & (handins.c.drawn == drawn)
        with self.database.reading() as connection:
            return connection.execute(select(handins).where(wanted).order_by(handins.c.number.desc())).first()

    def begin_check(self, folder: str, client: str, asked: str, window: Window, most: int | None) -> Row[Any]:
        """Count a check, unless it was sent before; its `answer` is "" until it is known."""
        with self.database.writing() as writing:
            if (known := self._known(writing, checks, folder, client)) is not None:
                return known
            window.check(writing.earliest)
            if most is not None and self._count(writing, checks, folder) >= most:
                raise UsedUpError
            writing.execute(insert(checks).values(folder=folder, client=client, asked=asked, at=writing.at))
            made = self._known(writing, checks, folder, client)
            assert made is not None, "it was inserted"
            return made

    def end_check(self, folder: str, client: str, answer: str) -> None:
        """Store the answer of a check."""
        with self.database.writing() as writing:
            wanted = (checks.c.folder == folder) & (checks.c.client == client)
            writing.execute(update(checks).where(wanted).values(answer=answer))

    def count_checks(self, folder: str) -> int:
        with self.database.reading() as connection:
            return connection.scalar(select(func.count()).select_from(checks).where(checks.c.folder == folder)) or 0

    # --- the class ----------------------------------------------------------------------------------

    def people(self) -> dict[str, Row[Any]]:
        """Return everybody who has not left, by folder."""
        with self.database.reading() as connection:
            return {row.folder: row for row in connection.execute(select(people).where(~people.c.dropped))}

    def everybody(self) -> dict[str, Row[Any]]:
        """Return everybody, also those who have left, by folder."""
        with self.database.reading() as connection:
            return {row.folder: row for row in connection.execute(select(people))}

    def change_person(self, folder: str, values: Mapping[str, Any]) -> None:
        with self.database.writing() as writing:
            writing.execute(update(people).where(people.c.folder == folder).values(**values))
        self.database.people_changes += 1

    def put_draw(self, folder: str, draw: str, drawn: str | None = None) -> None:
        """Store which variant the files of a student have, and the name of a new one."""
        with self.database.writing() as writing:
            self._set(writing, f"redrawn:{folder}", draw)
            if drawn is not None:
                writing.execute(update(people).where(people.c.folder == folder).values(drawn=drawn))
        self.database.people_changes += 1

    def match_draw(self, row: Row[Any], draw: str) -> None:
        """Give a student's variant a new name if it was redrawn since `put_draw`; an edited file is no new variant."""
        known = self.setting(f"redrawn:{row.folder}")
        if known != draw:
            anew = known and all(was != now for was, now in zip(known.split(), draw.split(), strict=True))
            self.put_draw(row.folder, draw, str(int(row.drawn or "0") + 1) if anew else None)

    def table(self) -> dict[str, dict[str, Any]]:
        """Return figures of each student's variant: the time of the last save, filled cells, hand-in, uploads.

        Uploads for an earlier variant are only counted, as `earlier`.
        """
        table: dict[str, dict[str, Any]] = {}
        filled = (
            select(
                people.c.folder,
                func.max(cells.c.at).label("saved"),
                func.max(cells.c.revision).label("revision"),
                func.count().filter(cells.c.text != "").label("filled"),
            )
            .join(cells, (cells.c.folder == people.c.folder) & (cells.c.drawn == people.c.drawn))
            .group_by(people.c.folder)
        )
        last = (
            select(handins)
            .join(people, (handins.c.folder == people.c.folder) & (handins.c.drawn == people.c.drawn))
            .order_by(handins.c.number)
        )
        with self.database.reading() as connection:
            for row in connection.execute(filled):
                table.setdefault(row.folder, {}).update(saved=row.saved, filled=row.filled, revision=row.revision)
            for row in connection.execute(last):
                table.setdefault(row.folder, {}).update(handed_in=row.at, handed_revision=row.revision)
            joined = select(uploads, people.c.drawn.label("current")).join(people, uploads.c.folder == people.c.folder)
            for row in connection.execute(joined.order_by(uploads.c.number)):
                own = table.setdefault(row.folder, {})
                if row.drawn == row.current:
                    own.update(uploads=own.get("uploads", 0) + 1, state=row.state, uploaded=row.at)
                else:
                    own.update(earlier=own.get("earlier", 0) + 1)
        return table

    def put_marks(self, made: Mapping[str, tuple[str, Mapping[str, Any]]]) -> None:
        """Replace the marks of the class by those of a new marking."""
        with self.database.writing() as writing:
            writing.execute(marks.delete())
            rows = [
                {"folder": folder, "mark": mark, "content": json.dumps(content, ensure_ascii=False), "at": writing.at}
                for folder, (mark, content) in made.items()
            ]
            if rows:
                writing.execute(insert(marks), rows)
            self._set(writing, "marked_at", writing.at)

    def marks(self) -> dict[str, dict[str, Any]]:
        with self.database.reading() as connection:
            return {row.folder: json.loads(row.content) for row in connection.execute(select(marks))}

    def setting(self, name: str) -> str:
        with self.database.reading() as connection:
            return connection.scalar(select(settings.c.value).where(settings.c.name == name)) or ""

    def put_setting(self, name: str, value: str) -> None:
        with self.database.writing() as writing:
            self._set(writing, name, value)

    def release(self, released: bool) -> None:
        """Release the marks, or take the release back."""
        with self.database.writing() as writing:
            self._set(writing, "released", "yes" if released else "no")
            self._set(writing, "released_at", writing.at)

    def note(self, who: str, what: str, folder: str = "", detail: str = "") -> None:
        """Add a line to the log of the class."""
        with self.database.writing() as writing:
            writing.execute(insert(log).values(at=writing.at, who=who, what=what, folder=folder, detail=detail))

    def _set(self, writing: Writing, name: str, value: str) -> None:
        statement = insert(settings).values(name=name, value=value)
        writing.execute(statement.on_conflict_do_update(index_elements=["name"], set_={"value": value}))

    def _known(self, writing: Writing, table: Table, folder: str, client: str) -> Row[Any] | None:
        row: Row[Any] | None = writing.execute(
            select(table).where((table.c.folder == folder) & (table.c.client == client))
        ).first()
        return row

    def _count(self, writing: Writing, table: Table, folder: str) -> int:
        statement = select(func.count()).select_from(table).where(table.c.folder == folder)
        return int(writing.connection.scalar(statement) or 0)
