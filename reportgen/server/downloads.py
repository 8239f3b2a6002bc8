"""What an instructor takes away: papers, tables, folders, the backup."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from reportgen.server.guards import Refusal
from reportgen.server.links import Person
from reportgen.server.site import Site


async def download(request: Request, site: Site, person: Person) -> Response:
    raise Refusal("unknown")


async def backup(request: Request, site: Site, person: Person) -> Response:
    raise Refusal("unknown")


async def gradebook(request: Request, site: Site, person: Person) -> Response:
    raise Refusal("unknown")


async def notices(request: Request, site: Site, person: Person) -> Response:
    return JSONResponse({"notices": []})
