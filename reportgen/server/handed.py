"""What students hand in as files of the class folder, in `handed/ID/`: the sheet as typed, and the uploads.

`grade` reads the same files. The sheet counts as it was handed in; of a student who neither handed it in nor uploaded
values, the cells count as they were saved last.
"""

from __future__ import annotations

import asyncio
import datetime
import hashlib
import json
import os
import shutil
import tempfile
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sqlalchemy import Row
from sqlalchemy.exc import OperationalError
from starlette.concurrency import run_in_threadpool

from reportgen.base.errors import OutputError, ReportgenError
from reportgen.base.files import put_files, put_set
from reportgen.classes.roster import HANDED_IN, PERSONAL
from reportgen.server import work_calls
from reportgen.server.links import Person
from reportgen.server.marking_queue import PREPARING
from reportgen.server.store import Store
from reportgen.workbook import write_csv

if TYPE_CHECKING:
    from reportgen.server.site import Site

SHEET = "answers.xlsx"
VALUED = frozenset({"queued", "read"})
"""States of uploads that have values, or may have."""
AGAIN = 30.0
"""Seconds until a file that the disk did not take is written again."""
ENDING = 2.0
"""Seconds that a server waits at its end for tasks that are not finished."""
_running: set[asyncio.Task[None]] = set()
"""Tasks that are not finished: the loop itself would forget them."""


def hand_in(site: Site, person: Person, client: str) -> Row[Any]:
    """Store that the cells of now are handed in."""
    rows = site.store.cells(person.folder, person.drawn)
    filled = [[row.quantity, row.position, row.text] for row in rows if row.text]
    content = json.dumps(sorted(filled), ensure_ascii=False, separators=(",", ":")).encode()
    sheet = {
        "revision": rows[-1].revision if rows else 0,
        "filled": len(filled),
        "sha256": hashlib.sha256(content).hexdigest(),
    }
    return site.store.hand_in(person.folder, client, person.drawn, sheet, site.window(person))


def begin(task: Any) -> None:
    """Run a task in the background."""
    running = asyncio.get_running_loop().create_task(task)
    _running.add(running)
    running.add_done_callback(_running.discard)


async def end() -> None:
    """Wait for the tasks of this loop: a thread would write on after its task is cancelled."""
    loop = asyncio.get_running_loop()
    if tasks := [task for task in _running if task.get_loop() is loop]:
        await asyncio.wait(tasks, timeout=ENDING)


async def prepare_all(site: Site) -> None:
    """Make all sheets and keys one after another, where uploads are read: each of these waits for one key at most."""
    for folder, row in (await run_in_threadpool(site.store.people)).items():
        if row.role == "student":
            try:
                await site.queue.run(work_calls.prepare, site.folder, folder, kind=PREPARING)
            except Exception as error:
                site.log.error("%s not prepared: %s", folder, type(error).__name__, exc_info=error)


def read_soon(site: Site, row: Row[Any]) -> None:
    """Read an upload when its turn comes."""
    if row.state == "queued" and row.number not in site.reading:
        site.reading.add(row.number)
        begin(_read(site, row))


def lay_out_soon(site: Site, folder: str) -> None:
    begin(lay_out(site, folder))


async def _read(site: Site, row: Row[Any]) -> None:
    try:
        while not await _was_read(site, row):
            await asyncio.sleep(AGAIN)
    finally:
        site.reading.discard(row.number)


async def _was_read(site: Site, row: Row[Any]) -> bool:
    """Read an upload; return False if the disk does not take what belongs to it."""
    state, values, lines = "kept", 0, []
    try:
        # The files of the student may be written at the same time.
        async with _laying(site, row.folder):
            file = await run_in_threadpool(_put_upload, site, row)
    except (OSError, OutputError) as error:
        site.log.error("upload %s not written: %s", row.number, error)
        if (site.folder.uploads / row.sha256).exists():
            return False
    else:
        try:
            state, values, lines = await site.queue.run(
                work_calls.read_upload, site.folder, row.folder, file, kind="reading"
            )
        except Exception as error:
            site.log.error("upload %s not read: %s", row.number, type(error).__name__, exc_info=error)
    try:
        await run_in_threadpool(site.store.settle_upload, row.number, state, values, lines)
    except OperationalError as error:
        site.log.error("upload %s not settled: %s", row.number, error)
        return False
    return True


def upload_name(row: Row[Any]) -> str:
    """Return the name of an upload in the folder of its student."""
    return f"{row.number:05}-{row.name}"


def _laying(site: Site, folder: str) -> asyncio.Lock:
    return site.laying.setdefault(folder, asyncio.Lock())


async def lay_out(site: Site, folder: str) -> None:
    """Write the files of one student."""
    async with _laying(site, folder):
        cells, when = await run_in_threadpool(counted_cells, site.store, site.drawn(folder), folder)
        content: bytes | None = None
        current = bool(cells) and await run_in_threadpool(lambda: _is_current(site, folder, when))
        if current:
            content = await run_in_threadpool((site.folder.handed / folder / SHEET).read_bytes)
        elif cells:
            content = await site.queue.run(work_calls.filled_sheet, site.folder, folder, cells, kind="files")
        await run_in_threadpool(_put, site, folder, content, when)


def _is_current(site: Site, folder: str, when: str) -> bool:
    """Return True if the sheet of a student is the one of a time, and of the present assignment and policy."""
    policy = filter(None, [site.folder.policy_file])
    try:
        made = (site.folder.handed / folder / SHEET).stat()
        newest = max(file.stat().st_mtime for file in (site.folder.assignment(folder), *policy))
    except OSError:
        return False
    return abs(made.st_mtime - datetime.datetime.fromisoformat(when).timestamp()) < 1e-3 and made.st_ctime > newest


async def lay_out_all(site: Site) -> list[str]:
    """Write the files of all students, and the times of their hand-ins; return what is wrong with single students."""
    people = await run_in_threadpool(site.store.people)
    problems: list[str] = []
    for folder, row in people.items():
        if row.role == "student":
            try:
                await lay_out(site, folder)
            except ReportgenError as error:
                site.log.error("files of %s not written: %s", folder, error)
                problems.append(str(error))
    await run_in_threadpool(put_handed_roster, site)
    return problems


def counted_cells(store: Store, drawn: str, folder: str) -> tuple[dict[tuple[str, int], str], str]:
    """Return the cells that count, with their time: those handed in, or without any hand-in those saved.

    Saved cells give way to an upload with values, not to a photo.
    """
    handin = store.handin(folder, drawn)
    if handin is not None:
        cells = store.cells_at(folder, drawn, handin.revision)
        return {place: text for place, text in cells.items() if text}, handin.at
    rows = store.cells(folder, drawn)
    uploads = (row.state for row in store.uploads(folder) if row.drawn == drawn)
    if not rows or not VALUED.isdisjoint(uploads):
        return {}, ""
    return {(row.quantity, row.position): row.text for row in rows if row.text}, rows[-1].at


def _put(site: Site, folder: str, content: bytes | None, when: str) -> None:
    """Write the files of a student with their times, and remove what no longer counts."""
    target = site.folder.handed / folder
    drawn = site.drawn(folder)
    rows = site.store.uploads(folder)
    kept = {upload_name(row): row for row in rows if row.drawn == drawn}
    target.mkdir(parents=True, exist_ok=True)
    # Whatever the server did not write itself is an instructor's, or from the command line.
    stale = [target / name for row in rows if (name := upload_name(row)) not in kept and (target / name).exists()]
    if content is None and _is_own_sheet(site, folder):
        stale.append(target / SHEET)
    put_set({}, stale)
    for row in kept.values():
        _put_upload(site, row)
    if content is not None:
        if not _is_current(site, folder, when):
            _put_aside(site, folder, content)
            put_files(target, {SHEET: content})
        _dated(target / SHEET, when)


def _is_own_sheet(site: Site, folder: str) -> bool:
    """Return True if the server wrote the sheet of a student: such a sheet has the time of a save or a hand-in."""
    try:
        made = (site.folder.handed / folder / SHEET).stat().st_mtime
    except OSError:
        return False
    times = map(datetime.datetime.fromisoformat, site.store.times(folder))
    return any(abs(made - at.timestamp()) < 1e-3 for at in times)


def _put_aside(site: Site, folder: str, content: bytes) -> None:
    """Give the sheet that somebody else put into the folder of a student a free name."""
    sheet: Path = site.folder.handed / folder / SHEET
    if sheet.exists() and not _is_own_sheet(site, folder) and sheet.read_bytes() != content:
        names = (sheet.with_stem(f"{sheet.stem}-{number}") for number in count(1))
        sheet.rename(next(name for name in names if not name.exists()))


def _put_upload(site: Site, row: Row[Any]) -> Path:
    """Write an upload into the folder of its student; return its path."""
    target: Path = site.folder.handed / row.folder
    file = target / upload_name(row)
    if not file.exists():
        target.mkdir(parents=True, exist_ok=True)
        handle, part = tempfile.mkstemp(prefix=f"{row.sha256}.", suffix=".part", dir=target)
        try:
            with open(handle, "wb") as copied, open(site.folder.uploads / row.sha256, "rb") as upload:
                shutil.copyfileobj(upload, copied)
                copied.flush()
                os.fsync(handle)
            os.replace(part, file)
        finally:
            Path(part).unlink(missing_ok=True)
    _dated(file, row.at)
    return file


def _dated(file: Path, when: str) -> None:
    """Give a file the time at which it was handed in: of two sheets the policy chooses by it."""
    moment = datetime.datetime.fromisoformat(when).timestamp()
    os.utime(file, (moment, moment))


def put_handed_roster(site: Site) -> None:
    """Write the roster with the time of each hand-in, which lateness is counted from."""
    table, people = site.store.table(), site.store.people()
    due = site.folder.policy().late
    rows: list[list[str]] = [[*PERSONAL, HANDED_IN]]
    for student in site.folder.students(site.language):
        figures = table.get(student.folder, {})
        _, counted = counted_cells(site.store, site.drawn(student.folder), student.folder)
        handed = max(filter(None, (counted, figures.get("uploaded"))), default=None)
        at = None if handed is None else datetime.datetime.fromisoformat(handed).astimezone().replace(tzinfo=None)
        person = people.get(student.folder)
        if at is not None and due is not None and person is not None and person.closes:
            extended = datetime.datetime.fromisoformat(person.closes).astimezone().replace(tzinfo=None)
            # An extension of the deadline makes the time up to it no lateness.
            at = at if at > extended else min(at, due.due)
        own = [student.card.get(name, "") for name in PERSONAL]
        rows.append([*own, "" if at is None else f"{at:%Y-%m-%d %H:%M:%S}"])
    put_set({site.folder.handed_roster: write_csv(rows)})
