"""The application: routes and their JSON, in the order in which a class meets them.

Pages are HTML from `templates/frames/server/NAME.html.j2`, everything else is JSON or a file. Each template knows
`language`, `languages` (pairs of code and name), `words` (`server` in `words.yaml`; `language_name` is the language's
own name, `errors` has a sentence for each code of `guards.STATUS`), `static("name.css")` (an address), `csrf` and
`person` (`role`, `id`, `name`, `folder`; None on `sign_in`, `enter`, `refused`). No page has inline scripts or styles.
Each POST needs the token that the page shows as `csrf`, as the header `X-CSRF-Token` or as the form field `csrf`.
Times are ISO 8601 with the offset of
the machine (`2026-11-20T23:59:00+07:00`). `PLACE` is `{"id": "v.B", "position": 2}`; the position of a single value
is 0. A refusal is `{"error": CODE, "message": TEXT}` with the status: 400 malformed, 401 signed out, 403 forbidden or
without token, 404 unknown, 409 closed, used up, redrawn, 413 too large, 429 too often, 500 failed, 507 no room on the
disk; who opens a page sees `sign_in` (401) or the page `refused` with `code`, `message` and `lines`.
Only 413, 429, 500, 507 and a lost connection are worth sending again, with the same `client`: a text of 8 to 64
letters, digits, - and _ that the browser invents for each cell, upload, check and hand-in; it is stored once.

Sign-in
  GET  /                     page `sign_in` (`failed`, `number` as typed); signed in: 303 to /me or /desk
  GET  /in/{token}           a personal link: sets the cookie, page `enter` with `home` (/me or /desk), which leads
                             there by <meta http-equiv="refresh">, since no browser sends a strict cookie along a
                             redirect that began on another site; a wrong link: page `sign_in` with `failed`
  POST /in                   form `id`, `code`: sets the cookie, 303 to /me or /desk (this POST needs no `csrf`)
  POST /out                  form `csrf`: ends the session, 303 to /
  POST /language             form `language`, `back` (path of the page): sets the cookie, 303 to `back`
  GET  /static/{name}        style sheets and scripts

A student
  GET  /me                   page `student`: `student`, `sheet`, `state` (as the two below), `tasks` (names of files)
  GET  /me/sheet             {"variant": "1", "sections": [{"name": "velocity", "title": TEXT, "part": TEXT,
                             "rows": [ROW]}],
                              "positions": [{"position": 1, "label": "1"}]}
                             ROW: {"id", "symbol": TEXT, "what": TEXT, "unit": TEXT,
                                   "cells": [{"position", "label", "given": TEXT or null, "open": true}]}
  GET  /me/state?since=N     {"now", "closes": TIME or null, "open": true, "revision": N, "released": false,
                              "cells": [{"id", "position", "text", "at", "revision"}],   later than revision N (0: all)
                              "filled", "asked", "handed_in": TIME or null, "changed": true (cells are newer),
                              "uploads": [RECEIPT], "uploads_left": K or null, "checks_left": K or null,
                              "checks_from": TIME or null, "hints": true, "self_report": false, "queue": K}
  POST /me/cells             {"variant", "cells": [{"client", "id", "position", "text"}]} (at most 200) → {"saved":
                             [{"client", "id", "position", "at", "revision"}],
                             "refused": [{"client", "error", "message"}]}
                             409 redrawn: the sheet is of an earlier variant, load the page again
  POST /me/check             {"client", "id", "position"} or {"client", "section"} or {"client"} for all →
                             {"cells": [{"id", "position", "verdict": "right" | "wrong" | "unread" | "empty",
                              "message": TEXT}], "lines": [TEXT], "checks_left"}; with the same `client` the same
                             answer, which counts once
  POST /me/uploads           multipart `file`, `client`, (`csrf`) → RECEIPT
  GET  /me/uploads/{number}  RECEIPT; …/file: the file as it was sent
                             RECEIPT: {"number", "client", "name", "size", "sha256", "at", "state": "queued" | "read" |
                             "kept" (for the instructor's eyes) | "refused" (damaged), "values": K, "lines": [TEXT],
                             "earlier": false (sent for an earlier variant), "queue": K}
  POST /me/hand-in           {"client"} → {"at", "filled", "asked", "sha256"}; again until it closes, the last counts
  GET  /me/files/{name}      task.pdf, answers.xlsx (with the own cells), assignment.yaml (with self_check),
                             machine.html (the own machine moving, for a frame with sandbox="allow-scripts"),
                             report.pdf (with self_report)
  GET  /me/result            after the release, when the own time is over: {"mark" (null: no mark, the lines say why),
                             "highest", "points", "out_of", "lines": [TEXT], "files": [NAME]}
  GET  /me/result/{name}     feedback.pdf, feedback.xlsx, a marked copy

An instructor
  GET  /desk                 page `desk`: `table` as the next
  GET  /desk/table           {"now", "closes", "clock": null or {"now", "last"} (in doubt),
                              "released", "queue", "marked_at": TIME or null, "marking": true,
                              "students": [{"folder", "id", "name", "class", "opened", "saved": TIME or null, "filled",
                              "asked", "handed_in": TIME or null, "changed", "uploads", "earlier": K (uploads for an
                              earlier variant, which are not in "uploads"), "state": "" | "read" | "kept" |
                              "refused", "mark": NUMBER or null, "points", "out_of", "warnings": [TEXT], "closes":
                              TIME or null, "extended": true}], "problems": [TEXT]}
  GET  /desk/students/{folder}          page `hand_in`: `student`, `sheet` as the next
  GET  /desk/students/{folder}/sheet    as /me/sheet, each cell with "text", "key": TEXT, "verdict": TEXT, "points",
                                        "worth"; and "uploads", "lines", "corrections": [{"id", "position",
                                        "judgement", "reason", "judged_by", "judged_on"}]
  GET  /desk/students/{folder}/uploads/{number}/file
  GET  /desk/students/{folder}/file     {"yaml": TEXT}, the assignment file
  POST /desk/students                   {"id", "name", "class", "email"}: adds one → the row of the table
  POST /desk/students/{folder}/deadline {"closes": "2026-11-22 23:59" or null} → {"closes"}
  POST /desk/students/{folder}/redraw   {} → {"folder"}; cells of the old variant are kept aside, not marked
  POST /desk/students/{folder}/fix      {"yaml": TEXT} → {"folder"} or 400 with "lines": [TEXT]
  POST /desk/students/{folder}/drop     {} → {"folder"}
  POST /desk/students/{folder}/link     {"renew": false} → {"link", "code"}; with true, earlier links end
  POST /desk/students/{folder}/correct  {"id", "position", "judgement": "right" | "wrong" | NUMBER, "reason", "name",
                                        "text": the text judged, if it is shown}
  POST /desk/mark                       {} → {"marking": true}; /desk/table tells when it is done
  POST /desk/release                    {"released": true} → {"released"}
  POST /desk/clock                      {} → {"clock": null}; the machine's clock is right
  POST /desk/backup                     {} → {"file": TEXT}
  POST /desk/gradebook                  multipart `file`, (`csrf`), `column` → the table filled in, as a file; the
                                        header X-Problems has the sentences about students without a row, as JSON
  GET  /desk/download/{name}            links.csv, tasks.pdf, keys.pdf, feedback.pdf, class.pdf, grades.csv,
                                        corrections.csv, class.zip, handed.zip, marked.zip; while the tasks or keys
                                        are being made, a browser gets 202 with the page `preparing` (`file`, `queue`)
  GET  /desk/notices                    {"notices": [{"kind", "lines": [TEXT], "students": [FOLDER, …]}]}
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from reportgen.server import downloads, handed, instructor, sign_in, student
from reportgen.server.guards import Guard, Refusal
from reportgen.server.site import Route as Reached
from reportgen.server.site import Site, by

STUDENT = "/desk/students/{folder}"


def routes() -> list[Route]:
    """Return all routes."""

    def of(role: str, path: str, route: Reached, method: str = "GET", form: bool = False) -> Route:
        return Route(path, by(role, route, form), methods=[method])

    return [
        Route("/", sign_in.start),
        Route("/in/{token}", sign_in.by_link),
        Route("/in", sign_in.by_code, methods=["POST"]),
        Route("/out", sign_in.sign_out, methods=["POST"]),
        Route("/language", sign_in.language, methods=["POST"]),
        Route("/static/{name}", sign_in.static),
        of("student", "/me", student.page),
        of("student", "/me/sheet", student.sheet),
        of("student", "/me/state", student.state),
        of("student", "/me/cells", student.cells, "POST"),
        of("student", "/me/check", student.check, "POST"),
        of("student", "/me/uploads", student.upload, "POST", form=True),
        of("student", "/me/uploads/{number:int}", student.one_upload),
        of("student", "/me/uploads/{number:int}/file", student.uploaded_file),
        of("student", "/me/hand-in", student.hand_in, "POST"),
        of("student", "/me/files/{name}", student.own_file),
        of("student", "/me/result", student.result),
        of("student", "/me/result/{name}", student.result_file),
        of("instructor", "/desk", instructor.page),
        of("instructor", "/desk/table", instructor.table),
        of("instructor", "/desk/students", instructor.add, "POST"),
        of("instructor", STUDENT, instructor.hand_in),
        of("instructor", f"{STUDENT}/sheet", instructor.sheet),
        of("instructor", f"{STUDENT}/uploads/{{number:int}}/file", instructor.uploaded_file),
        of("instructor", f"{STUDENT}/file", instructor.assignment),
        of("instructor", f"{STUDENT}/deadline", instructor.deadline, "POST"),
        of("instructor", f"{STUDENT}/redraw", instructor.redraw, "POST"),
        of("instructor", f"{STUDENT}/fix", instructor.fix, "POST"),
        of("instructor", f"{STUDENT}/drop", instructor.drop, "POST"),
        of("instructor", f"{STUDENT}/link", instructor.link, "POST"),
        of("instructor", f"{STUDENT}/correct", instructor.correct, "POST"),
        of("instructor", "/desk/mark", instructor.mark, "POST"),
        of("instructor", "/desk/release", instructor.release, "POST"),
        of("instructor", "/desk/clock", instructor.clock, "POST"),
        of("instructor", "/desk/backup", downloads.backup, "POST"),
        of("instructor", "/desk/gradebook", downloads.gradebook, "POST", form=True),
        of("instructor", "/desk/notices", downloads.notices),
        of("instructor", "/desk/download/{name}", downloads.download),
    ]


def application(site: Site) -> Starlette:
    """Return the application that serves a class."""

    @asynccontextmanager
    async def living(_: Starlette) -> AsyncIterator[None]:
        site.queue.warm()
        # What was stored before the server was killed may not be in the class folder yet.
        handed.begin(handed.lay_out_all(site))
        for row in site.store.uploads(state="queued"):
            handed.read_soon(site, row)
        if site.prepares:
            handed.begin(handed.prepare_all(site))
        yield
        await handed.end()
        site.queue.close()
        site.database.close()

    async def missing(request: Request, error: Exception) -> Response:
        raise Refusal("unknown")

    app = Starlette(routes=routes(), lifespan=living, exception_handlers={404: missing, 405: missing})
    app.state.site = site
    app.add_middleware(Guard, hosts=site.hosts, explain=site.explain)
    return app
