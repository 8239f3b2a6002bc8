"""Sign-in by a personal link, or by id and code."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Row
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from reportgen.base.template_folders import languages
from reportgen.classes.roster import comparable
from reportgen.server import pages
from reportgen.server.guards import Refusal
from reportgen.server.links import SESSION
from reportgen.server.site import LANGUAGE, Site

HOME = {"student": "/me", "instructor": "/desk"}
LONGEST = 200
"""Longest id, code or link that is looked at."""


async def start(request: Request) -> Response:
    """The page to sign in on, or that of somebody who has."""
    site: Site = request.app.state.site
    cookie = request.cookies.get(site.cookie, "")
    person = await run_in_threadpool(site.links.of_cookie, cookie) if cookie else None
    return (
        RedirectResponse(HOME[person.role], 303)
        if person
        else site.page(request, "sign_in", None, failed=False, number="")
    )


async def by_link(request: Request) -> Response:
    site: Site = request.app.state.site
    token = request.path_params["token"]
    row = await run_in_threadpool(site.links.of_token, token) if len(token) <= LONGEST else None
    if row is None:
        return _wrong(request, site)
    # The browser sends the cookie only if the next page is opened from here; a redirect still comes from elsewhere.
    page = site.page(request, "enter", None, home=HOME[row.role])
    page.headers["Referrer-Policy"] = "no-referrer"
    return await _signed_in(site, row, page)


async def by_code(request: Request) -> Response:
    site: Site = request.app.state.site
    form = await request.form(max_files=0, max_fields=5)
    id, code = form.get("id"), form.get("code")
    if not isinstance(id, str) or not isinstance(code, str) or len(id) > LONGEST or len(code) > LONGEST:
        raise Refusal("malformed")
    who = comparable(id.strip())
    site.guesses.check(who)
    row = await run_in_threadpool(site.links.of_code, id, code)
    if row is None:
        site.guesses.count(who)
        return _wrong(request, site, id)
    return await _signed_in(site, row, RedirectResponse(HOME[row.role], 303))


def _wrong(request: Request, site: Site, number: str = "") -> Response:
    site.attempts.count(request.client.host if request.client else "-")
    return site.page(request, "sign_in", None, 403, failed=True, number=number)


async def _signed_in(site: Site, row: Row[Any], answer: Response) -> Response:
    cookie = await run_in_threadpool(site.links.sign_in, row)
    age = int(SESSION.total_seconds())
    answer.set_cookie(site.cookie, cookie, age, path="/", secure=site.secure, httponly=True, samesite="strict")
    return answer


async def sign_out(request: Request) -> Response:
    site: Site = request.app.state.site
    form = await request.form(max_files=0, max_fields=5)
    cookie = request.cookies.get(site.cookie, "")
    person = await run_in_threadpool(site.links.of_cookie, cookie) if cookie else None
    if person is not None:
        site.check_token(request, person, form)
        await run_in_threadpool(site.links.sign_out, person)
    answer = RedirectResponse("/", 303)
    answer.delete_cookie(site.cookie, path="/")
    return answer


async def language(request: Request) -> Response:
    form = await request.form(max_files=0, max_fields=5)
    chosen = form.get("language")
    if chosen not in languages():
        raise Refusal("malformed")
    back = form.get("back")
    # Only a path of this server: no address leads elsewhere.
    place = back if isinstance(back, str) and back.startswith("/") and not back.startswith(("//", "/\\")) else "/"
    answer = RedirectResponse(place, 303)
    answer.set_cookie(LANGUAGE, str(chosen), 400 * 86400, path="/", httponly=True, samesite="strict")
    return answer


async def static(request: Request) -> Response:
    content = pages.static(request.path_params["name"])
    if content is None:
        raise Refusal("unknown")
    headers = {"Cache-Control": "public, max-age=31536000, immutable"} if request.url.query else {}
    return Response(content[0], media_type=content[1], headers=headers)
