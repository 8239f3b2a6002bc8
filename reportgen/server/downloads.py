"""What an instructor takes away: links, papers, marks, whole folders, a copy of the class, a filled gradebook."""

from __future__ import annotations

import asyncio
import json
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import UploadFile
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response

from reportgen.base.errors import ReportgenError
from reportgen.server import handed, work_calls
from reportgen.server.backups import back_up
from reportgen.server.class_folder import safe_name
from reportgen.server.guards import Refusal
from reportgen.server.instructor import with_lines
from reportgen.server.links import Person
from reportgen.server.site import Site
from reportgen.server.student import sent
from reportgen.workbook import write_csv

PROBLEMS = "X-Problems"
"""Header of a filled table with the sentences about what was not filled in, as percent-encoded JSON."""
SOON = 2.0
"""Seconds that a browser waits for a file before it gets a page instead."""
PAPERS = {"tasks.pdf": "task", "keys.pdf": "key"}
MARKED = ("feedback.pdf", "class.pdf", "grades.csv", "questions.csv")
ZIPS: dict[str, tuple[str, ...]] = {
    "class.zip": (
        "spec.yaml",
        "roster.csv",
        "policy.yaml",
        "corrections.csv",
        "handed-in.csv",
        "variants",
        "tasks",
        "handed",
        "marked",
    ),
    "handed.zip": ("handed",),
    "marked.zip": ("marked",),
}
"""Archives with the files and folders of the class in each."""


async def download(request: Request, site: Site, person: Person) -> Response:
    name = request.path_params["name"]
    if name == "links.csv":
        return sent(await run_in_threadpool(link_table, site), name)
    if name == "corrections.csv":
        return await _file(site.folder.corrections)
    if name in MARKED:
        return await _file(site.folder.marked / name)
    if name in PAPERS:
        return await _papers(request, site, person, name)
    if name in ZIPS:
        if name != "marked.zip":
            await handed.lay_out_all(site)
        return await run_in_threadpool(_zipped, site, name)
    raise Refusal("unknown")


async def _file(path: Path) -> Response:
    if not path.is_file():
        raise Refusal("unknown")
    return sent(await run_in_threadpool(path.read_bytes), path.name, attached=True)


def link_table(site: Site) -> bytes:
    """Return everybody's personal link and code as a table; the instructor's is not in it."""
    people = [row for row in site.store.people().values() if row.role == "student"]
    rows: list[Sequence[str]] = [("id", "name", "link", "code")]
    rows += [(row.id, row.name, site.link(row.folder), site.links.code(row.folder)) for row in people]
    return write_csv(rows)


async def _papers(request: Request, site: Site, person: Person, name: str) -> Response:
    """Return the PDF of a class; to a browser, while it is being made, a page that comes back for it."""
    out = site.folder.tasks if name == "tasks.pdf" else site.folder.keys
    making = site.papers.get(name)
    if making is None:
        made = site.queue.run(work_calls.make_products, site.folder, PAPERS[name], out, kind="class")
        site.papers[name] = making = asyncio.ensure_future(made)
    if "text/html" in request.headers.get("accept", ""):
        await asyncio.wait({making}, timeout=SOON)
        if not making.done():
            return site.page(request, "preparing", person, 202, file=name, queue=site.queue.waiting)
    else:
        await asyncio.wait({making})
    # What is asked for later is made anew: variants may have changed.
    site.papers.pop(name, None)
    try:
        making.result()
    except ReportgenError as error:
        raise with_lines(error) from None
    return await _file(out / name)


def _zipped(site: Site, name: str) -> Response:
    """Return an archive of folders; it is made in a file, since it may be large."""
    handle = tempfile.NamedTemporaryFile(suffix=".zip", delete=False)  # noqa: SIM115
    remove: Callable[[], None] = partial(Path(handle.name).unlink, missing_ok=True)
    try:
        with handle, zipfile.ZipFile(handle, "w", zipfile.ZIP_DEFLATED) as archive:
            for top in ZIPS[name]:
                place = site.folder.path / top
                files = [place] if place.is_file() else sorted(place.rglob("*"))
                for file in files:
                    if file.is_file() and not file.is_symlink():
                        archive.write(file, file.relative_to(site.folder.path).as_posix())
    except BaseException:
        remove()
        raise
    return FileResponse(handle.name, media_type="application/zip", filename=name, background=BackgroundTask(remove))


async def backup(request: Request, site: Site, person: Person) -> Response:
    async with site.backing_up:
        made = await run_in_threadpool(back_up, site.folder, site.folder.server / "backups")
    return JSONResponse({"file": made.name})


async def gradebook(request: Request, site: Site, person: Person) -> Response:
    async with request.form(max_files=1, max_fields=5) as form:
        site.check_token(request, person, form)
        file, column = form.get("file"), form.get("column", "")
        if not isinstance(file, UploadFile) or not isinstance(column, str):
            raise Refusal("malformed")
        name, content = safe_name(file.filename or ""), await file.read()
    await run_in_threadpool(handed.put_handed_roster, site)
    try:
        filled, lines = await site.queue.run(
            work_calls.fill_gradebook, site.folder, name, content, column.strip(), kind="class"
        )
    except ReportgenError as error:
        raise with_lines(error) from None
    answer = sent(filled, name, attached=True)
    # The body is the table: what it has no row for is said beside it.
    answer.headers[PROBLEMS] = quote(json.dumps(lines, ensure_ascii=False))
    return answer


async def notices(request: Request, site: Site, person: Person) -> Response:
    """What the marking noticed, with the students that it concerns."""
    seen: list[dict[str, Any]] = []
    for folder, mark in (await run_in_threadpool(site.store.marks)).items():
        for notice in mark.get("notices", []):
            mate = notice["classmate"]
            students = [folder, *([mate] if mate and mate != folder else [])]
            seen.append({"kind": notice["kind"], "count": notice["count"], "students": students})
    return JSONResponse({"notices": seen})
