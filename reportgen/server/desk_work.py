"""What an instructor sees and does: the table of the class, a sheet beside its key, corrections, the marking."""

from __future__ import annotations

import datetime
import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from sqlalchemy import Row
from starlette.concurrency import run_in_threadpool

from reportgen.base.errors import ReportgenError
from reportgen.base.files import contents, put_set
from reportgen.server import handed, work_calls
from reportgen.server.guards import Refusal
from reportgen.workbook import read, write_csv

if TYPE_CHECKING:
    from reportgen.server.site import Site

CORRECTED = ("id", "quantity", "position", "judgement", "reason", "value", "judged_by", "judged_on")
"""Columns of the corrections that are made in the browser."""


def table(site: Site) -> dict[str, Any]:
    """Return the class as a table."""
    figures, people, marks = site.store.table(), site.store.people(), site.store.marks()
    closes = site.browser.closes
    common = None if closes is None else closes.astimezone().isoformat()
    rows = []
    for student in site.folder.students(site.language):
        person = people.get(student.folder)
        if person is None:
            continue
        own, mark = figures.get(student.folder, {}), marks.get(student.folder, {})
        sheet = site.sheet(student.folder)
        rows.append(
            {
                "folder": student.folder,
                "id": student.id,
                "name": student.card.get("name", ""),
                "class": student.card.get("class", ""),
                "opened": person.opened_at,
                "saved": own.get("saved"),
                "filled": own.get("filled", 0),
                "asked": sheet["asked"] if sheet else 0,
                "handed_in": own.get("handed_in"),
                "changed": "handed_in" in own and own.get("revision", 0) > own["handed_revision"],
                "uploads": own.get("uploads", 0),
                "earlier": own.get("earlier", 0),
                "state": own.get("state", ""),
                "mark": mark.get("mark"),
                "points": mark.get("points"),
                "out_of": mark.get("out_of"),
                "warnings": mark.get("warnings", []),
                "lines": mark.get("lines", []),
                "closes": person.closes or common,
                "extended": person.closes is not None,
            }
        )
    return {
        "now": site.database.clock.now().isoformat(),
        "closes": common,
        "clock": site.clock_doubt,
        "released": site.released,
        "queue": site.queue.waiting,
        "marked_at": site.store.setting("marked_at") or None,
        "marking": site.marking,
        "students": rows,
        "problems": json.loads(site.store.setting("problems") or "[]"),
    }


def beside_key(site: Site, folder: str, sheet: Mapping[str, Any], keys: Sequence[Any]) -> dict[str, Any]:
    """Return a sheet with the student's cells, the key and the verdicts of the last marking."""
    drawn = site.drawn(folder)
    cells, _ = handed.counted_cells(site.store, drawn, folder)
    if not cells:
        cells = {(row.quantity, row.position): row.text for row in site.store.cells(folder, drawn)}
    right = {(id, position): text for id, position, text in keys}
    mark = site.store.marks().get(folder, {})
    verdicts = {(id, position): rest for id, position, *rest in mark.get("cells", [])}
    sections = []
    for section in sheet["sections"]:
        rows = []
        for row in section["rows"]:
            places = []
            for cell in row["cells"]:
                place = row["id"], cell["position"]
                verdict, points, worth = verdicts.get(place, ("", None, None))
                about = {"text": cells.get(place, ""), "key": right.get(place, "")}
                places.append({**cell, **about, "verdict": verdict, "points": points, "worth": worth})
            rows.append({**row, "cells": places})
        sections.append({**section, "rows": rows})
    from reportgen.server.student import receipt

    uploads = [receipt(site, row, drawn) for row in site.store.uploads(folder)]
    own = [row for row in corrections(site) if row["id"] == site.store.people()[folder].id]
    result = {name: mark.get(name) for name in ("mark", "highest", "points", "out_of")}
    said = {name: mark.get(name, []) for name in ("warnings", "lines")}
    return {**sheet, "sections": sections, "uploads": uploads, "corrections": own, **result, **said}


# --- corrections ------------------------------------------------------------------------------------


def corrections(site: Site) -> list[dict[str, str]]:
    """Return the rows of `corrections.csv` as the browser writes them; those of another form are not shown."""
    try:
        (page, *_) = read(site.folder.corrections, site.language)
    except (OSError, ReportgenError, ValueError):
        return []
    rows = [[cell.text.strip() for cell in row] for row in page.rows]
    if not rows or tuple(rows[0]) != CORRECTED:
        return []
    return [dict(zip(CORRECTED, [*row, *[""] * len(CORRECTED)], strict=False)) for row in rows[1:]]


def judged_text(site: Site, student: Row[Any], content: Mapping[str, Any]) -> str:
    """Return the value that a correction judges, so that it holds for no other; "" if no number can be told.

    It is the text that the page showed, if any. With uploads it is the value that was marked: it may be theirs.
    """
    place: tuple[str, int] = content["id"], content["position"]
    mark: dict[str, Any] = site.store.marks().get(student.folder, {})
    marked = next((str(text) for id, position, text in mark.get("values", []) if (id, position) == place), "")
    if marked and any(row.drawn == student.drawn for row in site.store.uploads(student.folder)):
        return marked
    verdict = next((rest[0] for id, position, *rest in mark.get("cells", []) if (id, position) == place), "")
    seen = content.get("text")
    if seen is None:
        seen = handed.counted_cells(site.store, student.drawn, student.folder)[0].get(place, "")
    readable = isinstance(seen, str) and any(sign.isdecimal() for sign in seen) and verdict != "unread"
    return " ".join(seen[:500].split()) if readable else marked


def correction(student: Row[Any], content: Mapping[str, Any], now: datetime.datetime) -> dict[str, str]:
    """Return a correction as a row, without its value; raise `Refusal` for a malformed one."""
    id, position, judgement = content.get("id"), content.get("position"), content.get("judgement")
    reason, name = content.get("reason"), content.get("name")
    texts = (id, reason, name)
    if not all(isinstance(text, str) and 0 < len(text.strip()) <= 500 for text in texts):
        raise Refusal("malformed")
    number = isinstance(judgement, (int, float)) and not isinstance(judgement, bool) and 0 <= judgement <= 1000
    if not (judgement in ("right", "wrong") or number) or type(position) is not int or position < 0:
        raise Refusal("malformed")
    values = (student.id, id, position or "", judgement, reason, "", name, f"{now:%Y-%m-%d %H:%M}")
    return dict(zip(CORRECTED, (" ".join(str(value).split()) for value in values), strict=True))


def add_correction(site: Site, row: Mapping[str, str]) -> None:
    """Add a row to `corrections.csv`; raise `Refusal` if that is a table of another form, which is left alone."""
    file = site.folder.corrections
    known = corrections(site)
    if file.exists() and not known and len(contents(file).split(b"\n")) > 2:
        raise Refusal("malformed")
    rows = [list(CORRECTED), *([one[name] for name in CORRECTED] for one in (*known, row))]
    put_set({file: write_csv(rows)})


# --- the marking ------------------------------------------------------------------------------------


async def mark_class(site: Site) -> None:
    """Mark the class as `grade` does, and store the marks."""
    try:
        async with site.changing:
            # No variant changes between its sheet and its marks.
            unwritten = await handed.lay_out_all(site)
            people = await run_in_threadpool(site.store.people)
            made = await site.queue.run(work_calls.grade, site.folder, kind="class")
        folders = {folder.casefold(): folder for folder in people}
        marks = {
            folders[name.casefold()]: (str(content.get("mark")), content)
            for name, content in made["marks"].items()
            if name.casefold() in folders
        }
        await run_in_threadpool(site.store.put_marks, marks)
        problems = [*dict.fromkeys([*unwritten, *made["problems"]])]
    except ReportgenError as error:
        problems = [str(error)]
    except Exception as error:
        site.log.error("marking failed: %s", type(error).__name__, exc_info=error)
        problems = [type(error).__name__]
    try:
        await run_in_threadpool(site.store.put_setting, "problems", json.dumps(problems, ensure_ascii=False))
    finally:
        site.marking = False
