"""The routes of a student. `reportgen/server/app.py` lists their JSON."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import partial
from typing import Any
from urllib.parse import quote

from sqlalchemy import Row
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import UploadFile
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response

from reportgen.server import handed, pages, work_calls
from reportgen.server.class_folder import safe_name
from reportgen.server.guards import LARGE, Refusal, json_of
from reportgen.server.links import Person
from reportgen.server.site import Site, client_of
from reportgen.server.store import ClosedError, Saved, TypedCell, UsedUpError

MOST_CELLS = 200
LONGEST = 60
"""Characters of a cell."""
MOST_UPLOADS = 100
"""Uploads of a student where the policy does not say."""
MOST_BYTES = 500_000_000
"""Bytes of all uploads of a student together."""
DATA = "assignment.yaml"
TASKS = ("task.pdf", "answers.xlsx", DATA, "machine.html")
TYPES = {
    ".pdf": "application/pdf",
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    ".yaml": "application/yaml; charset=utf-8",
    ".csv": "text/csv; charset=utf-8",
    ".txt": "text/plain; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".zip": "application/zip",
    ".docx": "application/vnd.openxmlformats-officedocument.wordprocessingml.document",
}
MOVING_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
)
"""Policy of the moving machine, which has its scripts in itself and lives in a sandbox of its own."""


async def page(request: Request, site: Site, person: Person) -> Response:
    sheet = await sheet_of(site, person.folder, person.drawn)
    state = await run_in_threadpool(state_of, site, person, sheet, 0)
    tasks = await run_in_threadpool(_tasks, site)
    return site.page(
        request, "student", person, student=_about(site, person), sheet=sheet, state=state, tasks=tasks, largest=LARGE
    )


def _tasks(site: Site) -> list[str]:
    """Return the names of the files that a student may have. Whoever has the data can compute every answer."""
    tasks = [name for name in TASKS if name != DATA or site.folder.policy().ask.self_check]
    return [*tasks, *(["report.pdf"] if site.browser.self_report else [])]


def _about(site: Site, person: Person) -> dict[str, str]:
    # Unsent cells in a browser belong to one class: another may be at the same address later.
    owner = f"{site.links.class_id}:{person.folder}"
    return {"id": person.id, "name": person.name, "folder": person.folder, "owner": owner}


async def sheet(request: Request, site: Site, person: Person) -> Response:
    return JSONResponse(await sheet_of(site, person.folder, person.drawn))


async def sheet_of(site: Site, folder: str, drawn: str) -> dict[str, Any]:
    """Return the answer sheet of a student, made now if it is not there."""
    known = await run_in_threadpool(site.sheet, folder)
    made: dict[str, Any] = known if known else await site.queue.run(work_calls.make_sheet, site.folder, folder)
    return {"variant": drawn, **made}


async def state(request: Request, site: Site, person: Person) -> Response:
    since = request.query_params.get("since", "0")
    if not since.isascii() or not since.isdecimal() or len(since) > 15:
        raise Refusal("malformed")
    sheet = await sheet_of(site, person.folder, person.drawn)
    return JSONResponse(await run_in_threadpool(state_of, site, person, sheet, int(since)))


def state_of(site: Site, person: Person, sheet: dict[str, Any], since: int) -> dict[str, Any]:
    """Return what a student has done, and still may do."""
    store, policy, window = site.store, site.browser, site.window(person)
    now, earliest = site.database.clock.now(), site.database.clock.earliest()
    cells = store.cells(person.folder, person.drawn)
    handin, files = store.handin(person.folder, person.drawn), store.uploads(person.folder)
    last = cells[-1].revision if cells else 0
    checks = store.count_checks(person.folder)
    return {
        "now": now.isoformat(),
        "closes": None if window.closes is None else window.closes.isoformat(),
        "open": window.closes is None or earliest <= window.closes,
        "revision": last,
        "released": site.shows_result(person),
        "cells": [
            {"id": row.quantity, "position": row.position, "text": row.text, "at": row.at, "revision": row.revision}
            for row in cells
            if row.revision > since
        ],
        "filled": sum(row.text != "" for row in cells),
        "asked": sheet["asked"],
        "handed_in": None if handin is None else handin.at,
        "changed": handin is not None and last > handin.revision,
        "uploads": [receipt(site, row, person.drawn) for row in files],
        "uploads_left": None if policy.uploads is None else max(policy.uploads - len(files), 0),
        "checks_left": None if policy.checks is None else max(policy.checks - checks, 0),
        "checks_from": None if policy.checks_from is None else policy.checks_from.astimezone().isoformat(),
        "hints": policy.hints,
        "self_report": policy.self_report,
        "queue": site.queue.waiting,
    }


def receipt(site: Site, row: Row[Any], drawn: str) -> dict[str, Any]:
    """Return the receipt of an upload of a student who has the variant `drawn` now."""
    fields = ("number", "client", "name", "size", "sha256", "at", "state")
    made: dict[str, Any] = {name: getattr(row, name) for name in fields}
    made |= {"values": row.values_read, "lines": json.loads(row.lines), "earlier": row.drawn != drawn}
    return made | {"queue": site.queue.waiting}


# --- cells ------------------------------------------------------------------------------------------


async def cells(request: Request, site: Site, person: Person) -> Response:
    content = await json_of(request)
    _same_variant(content, person)
    sent = content.get("cells")
    if not isinstance(sent, list) or not 0 < len(sent) <= MOST_CELLS:
        raise Refusal("malformed")
    refused: list[dict[str, str]] = []
    saved = await run_in_threadpool(_saved, site, person, sent, refused)
    if saved is None:
        await sheet_of(site, person.folder, person.drawn)
        saved = await run_in_threadpool(_saved, site, person, sent, refused) or []
    made = [
        {
            "client": cell.entry.client,
            "id": cell.entry.quantity,
            "position": cell.entry.position,
            "at": cell.at,
            "revision": cell.revision,
        }
        for cell in saved
    ]
    language = site.language_of(request)
    explained = [{**cell, "message": pages.explained(language, cell["error"])} for cell in refused]
    return JSONResponse({"saved": made, "refused": explained})


def _saved(site: Site, person: Person, sent: list[Any], refused: list[dict[str, str]]) -> list[Saved] | None:
    """Store cells; return None if the sheet with their places is not made yet."""
    sheet = site.sheet(person.folder)
    if sheet is None:
        return None
    places = open_places(sheet)
    entries = [entry for cell in sent if (entry := _entry(cell, places, refused)) is not None]
    try:
        return site.store.save(person.folder, person.drawn, entries, site.window(person))
    except ClosedError:
        raise Refusal("closed") from None


def _same_variant(content: dict[str, Any], person: Person) -> None:
    """Raise `Refusal` if a page still shows the sheet of an earlier variant."""
    if content.get("variant", person.drawn) != person.drawn:
        raise Refusal("redrawn")


def open_places(sheet: dict[str, Any]) -> frozenset[tuple[str, int]]:
    """Return the cells that a student may fill in."""
    rows = (row for section in sheet["sections"] for row in section["rows"])
    return frozenset((row["id"], cell["position"]) for row in rows for cell in row["cells"] if cell["open"])


def _entry(cell: Any, places: frozenset[tuple[str, int]], refused: list[dict[str, str]]) -> TypedCell | None:
    """Return a cell as sent; one that nobody asks for is refused, and does not keep the others from being saved."""
    if not isinstance(cell, dict):
        raise Refusal("malformed")
    client, id, position, text = client_of(cell), cell.get("id"), cell.get("position"), cell.get("text")
    if not isinstance(id, str) or type(position) is not int or not isinstance(text, str):
        raise Refusal("malformed")
    clean = "".join(sign for sign in text if sign.isprintable()).strip()
    code = "unknown" if (id, position) not in places else "too_large" if len(clean) > LONGEST else ""
    if code:
        refused.append({"client": client, "error": code})
        return None
    return TypedCell(client, id, position, clean)


async def check(request: Request, site: Site, person: Person) -> Response:
    content = await json_of(request)
    _same_variant(content, person)
    client, policy = client_of(content), site.browser
    asked = {name: content[name] for name in ("id", "position", "section") if content.get(name) is not None}
    if not all(isinstance(value, int if name == "position" else str) for name, value in asked.items()):
        raise Refusal("malformed")
    if policy.checks_from is not None and site.database.clock.earliest() < policy.checks_from.astimezone():
        raise Refusal("too_early")
    rows = await run_in_threadpool(site.store.cells, person.folder, person.drawn)
    # One check is one question about one state of the sheet, however often it is sent.
    question = json.dumps({**asked, "revision": rows[-1].revision if rows else 0, "variant": person.drawn})
    begin = partial(site.store.begin_check, person.folder, client, question, site.window(person))
    try:
        row = await run_in_threadpool(begin, policy.checks)
    except ClosedError:
        raise Refusal("closed") from None
    except UsedUpError:
        raise Refusal("used_up") from None
    known, asked = row.answer, json.loads(row.asked)
    if asked.pop("variant", person.drawn) != person.drawn:
        raise Refusal("redrawn")
    if not known:
        revision = asked.pop("revision", rows[-1].revision if rows else 0)
        cells = await run_in_threadpool(site.store.cells_at, person.folder, person.drawn, revision)
        present = {place: text for place, text in cells.items() if text}
        answer = await site.queue.run(work_calls.check, site.folder, person.folder, present, asked)
        known = json.dumps(answer, ensure_ascii=False)
        await run_in_threadpool(site.store.end_check, person.folder, client, known)
    count = await run_in_threadpool(site.store.count_checks, person.folder)
    left = None if policy.checks is None else max(policy.checks - count, 0)
    return JSONResponse({**json.loads(known), "checks_left": left})


# --- uploads and the hand-in ------------------------------------------------------------------------


async def upload(request: Request, site: Site, person: Person) -> Response:
    site.files.count(person.session)
    async with request.form(max_files=1, max_fields=5) as form:
        site.check_token(request, person, form)
        file, client = form.get("file"), client_of({"client": form.get("client")})
        if not isinstance(file, UploadFile):
            raise Refusal("malformed")
        if (file.size or 0) > LARGE:
            raise Refusal("file_too_large")
        async with site.receiving:
            content, name = await file.read(), safe_name(file.filename or "")
            row = await run_in_threadpool(_stored, site, person, client, name, content)
    handed.read_soon(site, row)
    return JSONResponse(receipt(site, row, person.drawn))


def _stored(site: Site, person: Person, client: str, name: str, content: bytes) -> Row[Any]:
    sha256 = hashlib.sha256(content).hexdigest()
    sent_before = site.store.uploads(person.folder)
    known = next((row for row in sent_before if row.client == client), None)
    if known is not None:
        # Its browser did not hear of it, maybe until after the deadline.
        return known
    try:
        site.window(person).check(site.database.clock.earliest())
        most = MOST_UPLOADS if site.browser.uploads is None else site.browser.uploads
        if len(sent_before) >= most:
            raise UsedUpError
        if sum(row.size for row in sent_before) + len(content) > MOST_BYTES:
            raise Refusal("file_too_large")
        site.folder.add_upload(content, sha256)
        about = {"drawn": person.drawn, "name": name, "size": len(content), "sha256": sha256}
        return site.store.add_upload(person.folder, client, about, site.window(person), most)
    except ClosedError:
        raise Refusal("closed") from None
    except UsedUpError:
        raise Refusal("used_up") from None


async def one_upload(request: Request, site: Site, person: Person) -> Response:
    return JSONResponse(receipt(site, await _own_upload(request, site, person), person.drawn))


async def uploaded_file(request: Request, site: Site, person: Person) -> Response:
    row = await _own_upload(request, site, person)
    return sent_upload(site, row)


def sent_upload(site: Site, row: Row[Any]) -> Response:
    """Return an uploaded file, to be saved: a browser never shows it as a page."""
    # Whatever its name says, nothing in a browser opens it.
    headers = _named(row.name, attached=True)
    return FileResponse(site.folder.uploads / row.sha256, media_type="application/octet-stream", headers=headers)


async def _own_upload(request: Request, site: Site, person: Person) -> Row[Any]:
    rows: Sequence[Row[Any]] = await run_in_threadpool(site.store.uploads, person.folder)
    row = next((row for row in rows if row.number == request.path_params["number"]), None)
    if row is None:
        raise Refusal("unknown")
    return row


async def hand_in(request: Request, site: Site, person: Person) -> Response:
    content = await json_of(request)
    _same_variant(content, person)
    client = client_of(content)
    sheet = await sheet_of(site, person.folder, person.drawn)
    try:
        row = await run_in_threadpool(handed.hand_in, site, person, client)
    except ClosedError:
        raise Refusal("closed") from None
    handed.lay_out_soon(site, person.folder)
    return JSONResponse({"at": row.at, "filled": row.filled, "asked": sheet["asked"], "sha256": row.sha256})


# --- files ------------------------------------------------------------------------------------------


async def own_file(request: Request, site: Site, person: Person) -> Response:
    name = request.path_params["name"]
    if name not in await run_in_threadpool(_tasks, site):
        raise Refusal("unknown")
    if name == "answers.xlsx":
        rows = await run_in_threadpool(site.store.cells, person.folder, person.drawn)
        present = {(row.quantity, row.position): row.text for row in rows if row.text}
        content = await site.queue.run(work_calls.filled_sheet, site.folder, person.folder, present)
    else:
        content = await site.queue.run(work_calls.make_file, site.folder, person.folder, name, kind="files")
    return sent(content, name)


def sent(content: bytes, name: str, attached: bool = False) -> Response:
    """Return a file; all but PDF and the moving machine are saved, not shown."""
    return Response(content, media_type=_type(name), headers=_named(name, attached))


def _type(name: str) -> str:
    return TYPES.get(_suffix(name), "application/octet-stream")


def _suffix(name: str) -> str:
    return "." + name.rpartition(".")[2].lower()


def _named(name: str, attached: bool = False) -> dict[str, str]:
    suffix = _suffix(name)
    inline = not attached and suffix in (".pdf", ".html")
    how = "inline" if inline else "attachment"
    headers = {"Content-Disposition": f"{how}; filename*=UTF-8''{quote(name, safe='')}"}
    if suffix == ".html" and inline:
        headers |= {"Content-Security-Policy": MOVING_POLICY, "X-Frame-Options": "SAMEORIGIN"}
    return headers


async def result(request: Request, site: Site, person: Person) -> Response:
    if not site.shows_result(person):
        raise Refusal("not_released")
    marks = await run_in_threadpool(site.store.marks)
    mark = marks.get(person.folder)
    if mark is None:
        raise Refusal("unknown")
    return JSONResponse({name: mark.get(name) for name in ("mark", "highest", "points", "out_of", "lines", "files")})


async def result_file(request: Request, site: Site, person: Person) -> Response:
    if not site.shows_result(person):
        raise Refusal("not_released")
    name = request.path_params["name"]
    mark = (await run_in_threadpool(site.store.marks)).get(person.folder)
    if mark is None or name not in mark.get("files", []):
        raise Refusal("unknown")
    file = site.folder.marked / person.folder / name
    return FileResponse(file, media_type=_type(name), headers=_named(name))
