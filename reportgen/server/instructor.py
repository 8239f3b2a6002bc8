"""The routes of an instructor. `reportgen/server/app.py` lists their JSON."""

from __future__ import annotations

import datetime
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from reportgen.base.errors import AssignmentError, ReportgenError
from reportgen.base.timestamps import moment
from reportgen.server import desk_work, handed, work_calls
from reportgen.server.guards import Refusal, json_of
from reportgen.server.links import DESK, Person
from reportgen.server.site import Site
from reportgen.server.student import sent_upload, sheet_of


async def page(request: Request, site: Site, person: Person) -> Response:
    table = await run_in_threadpool(desk_work.table, site)
    return site.page(request, "desk", person, table=table)


async def table(request: Request, site: Site, person: Person) -> Response:
    return JSONResponse(await run_in_threadpool(desk_work.table, site))


async def hand_in(request: Request, site: Site, person: Person) -> Response:
    """The page of one student's hand-in."""
    student = _student(request, site)
    table = await run_in_threadpool(desk_work.table, site)
    about = next((row for row in table["students"] if row["folder"] == student.folder), None)
    if about is None:
        raise Refusal("unknown")
    return site.page(request, "hand_in", person, student=about, sheet=await _sheet(site, student.folder))


async def sheet(request: Request, site: Site, person: Person) -> Response:
    return JSONResponse(await _sheet(site, _student(request, site).folder))


async def _sheet(site: Site, folder: str) -> dict[str, Any]:
    made = await sheet_of(site, folder, await run_in_threadpool(site.drawn, folder))
    keys = await site.queue.run(work_calls.key_values, site.folder, folder)
    return await run_in_threadpool(desk_work.beside_key, site, folder, made, keys)


def _student(request: Request, site: Site) -> Any:
    """Return the row of the student that a path names."""
    row = site.store.people().get(request.path_params["folder"])
    if row is None or row.role != "student":
        raise Refusal("unknown")
    return row


async def uploaded_file(request: Request, site: Site, person: Person) -> Response:
    student = _student(request, site)
    rows = await run_in_threadpool(site.store.uploads, student.folder)
    row = next((row for row in rows if row.number == request.path_params["number"]), None)
    if row is None:
        raise Refusal("unknown")
    return sent_upload(site, row)


async def assignment(request: Request, site: Site, person: Person) -> Response:
    student = _student(request, site)
    text = await run_in_threadpool(site.folder.assignment(student.folder).read_text, "utf-8")
    return JSONResponse({"yaml": text})


# --- changes ----------------------------------------------------------------------------------------


async def add(request: Request, site: Site, person: Person) -> Response:
    content = await json_of(request)
    card = {name: content[name] for name in ("id", "name", "class", "section", "email") if content.get(name)}
    if not card.get("id") or not all(isinstance(value, str) and len(value) <= 200 for value in card.values()):
        raise Refusal("malformed")
    async with site.changing:
        try:
            entry = await run_in_threadpool(site.folder.add, card, site.language)
            await site.queue.run(work_calls.draw, site.folder, kind="class")
        except ReportgenError as error:
            raise with_lines(error) from None
        await run_in_threadpool(site.links.add, entry.folder, "student", entry.id, entry.card.get("name", ""), "1")
    await _note(site, "add", entry.folder)
    rows = (await run_in_threadpool(desk_work.table, site))["students"]
    return JSONResponse(next(row for row in rows if row["folder"] == entry.folder))


async def deadline(request: Request, site: Site, person: Person) -> Response:
    student, content = _student(request, site), await json_of(request)
    closes = content.get("closes")
    at = None if closes is None else _moment(closes)
    text = None if at is None else at.isoformat()
    await run_in_threadpool(site.store.change_person, student.folder, {"closes": text})
    await _note(site, "deadline", student.folder, text or "")
    return JSONResponse({"closes": text})


def _moment(text: object) -> datetime.datetime:
    if not isinstance(text, str) or len(text) > 40:
        raise Refusal("malformed")
    try:
        read = datetime.datetime.fromisoformat(text) if "T" in text else moment(text, end=True)
    except ValueError:
        read = None
    if read is None:
        raise Refusal("malformed")
    return read.astimezone()


async def redraw(request: Request, site: Site, person: Person) -> Response:
    async with site.changing:
        await run_in_threadpool(_match_draw, site, _student(request, site))
        student = _student(request, site)
        try:
            remarks = await site.queue.run(work_calls.draw, site.folder, [student.id], kind="class")
        except ReportgenError as error:
            raise with_lines(error) from None
        await run_in_threadpool(_match_draw, site, student)
        if await run_in_threadpool(site.drawn, student.folder) == student.drawn:
            # The file was edited and is kept.
            about = [line for line in remarks if str(site.folder.assignment(student.folder)) in line]
            raise Refusal("malformed", lines=about or remarks)
    await handed.lay_out(site, student.folder)
    await _note(site, "redraw", student.folder)
    return JSONResponse({"folder": student.folder})


def _match_draw(site: Site, student: Any) -> None:
    site.store.match_draw(student, site.folder.draws(site.language)[student.folder])


async def fix(request: Request, site: Site, person: Person) -> Response:
    student, content = _student(request, site), await json_of(request)
    text = content.get("yaml")
    if not isinstance(text, str):
        raise Refusal("malformed")
    async with site.changing:
        problems = await site.queue.run(work_calls.fix, site.folder, student.folder, text, kind="class")
        await run_in_threadpool(_match_draw, site, student)
    if problems:
        raise Refusal("malformed", lines=problems)
    await _note(site, "fix", student.folder)
    return JSONResponse({"folder": student.folder})


async def drop(request: Request, site: Site, person: Person) -> Response:
    student = _student(request, site)
    async with site.changing:
        try:
            await site.queue.run(work_calls.draw, site.folder, [], [student.id], kind="class")
        except ReportgenError as error:
            raise with_lines(error) from None
        await run_in_threadpool(site.store.change_person, student.folder, {"dropped": True})
    await _note(site, "drop", student.folder)
    return JSONResponse({"folder": student.folder})


async def link(request: Request, site: Site, person: Person) -> Response:
    student, content = _student(request, site), await json_of(request)
    if content.get("renew") is True:
        await run_in_threadpool(site.links.renew, student.folder)
        await _note(site, "renew", student.folder)
    code = await run_in_threadpool(site.links.code, student.folder)
    return JSONResponse({"link": await run_in_threadpool(site.link, student.folder), "code": code})


async def correct(request: Request, site: Site, person: Person) -> Response:
    student, content = _student(request, site), await json_of(request)
    row = desk_work.correction(student, content, site.database.clock.now())
    row["value"] = await run_in_threadpool(desk_work.judged_text, site, student, content)
    async with site.changing:
        await run_in_threadpool(desk_work.add_correction, site, row)
    await _note(site, "correct", student.folder, f"{row['quantity']} {row['position']} {row['judgement']}")
    return JSONResponse({"folder": student.folder})


async def mark(request: Request, site: Site, person: Person) -> Response:
    if not site.marking:
        site.marking = True
        handed.begin(desk_work.mark_class(site))
    return JSONResponse({"marking": True})


async def release(request: Request, site: Site, person: Person) -> Response:
    content = await json_of(request)
    released = content.get("released")
    if not isinstance(released, bool):
        raise Refusal("malformed")
    await run_in_threadpool(site.store.release, released)
    await _note(site, "release", "", str(released))
    return JSONResponse({"released": released})


async def clock(request: Request, site: Site, person: Person) -> Response:
    """The instructor has looked at the clock: it is right."""
    await run_in_threadpool(site.database.trust_clock)
    await _note(site, "clock", "")
    return JSONResponse({"clock": None})


async def _note(site: Site, what: str, folder: str, detail: str = "") -> None:
    await run_in_threadpool(site.store.note, DESK, what, folder, detail)


def with_lines(error: ReportgenError) -> Refusal:
    """Return the refusal of something that the class folder does not allow, with its problems."""
    problems = error.problems if isinstance(error, AssignmentError) else [error]
    return Refusal("malformed", lines=[getattr(problem, "message", str(problem)) for problem in problems])
