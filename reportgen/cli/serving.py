"""The command that serves a class in the browser."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from reportgen.cli.common import SYSTEM, LangOption, complain, ending, say

NEEDED = ("starlette", "uvicorn", "multipart", "itsdangerous", "sqlalchemy", "alembic")
"""Modules of the packages that `reportgen[server]` installs."""


def serve(
    folder: Annotated[Path, typer.Argument(metavar="CLASS", help="Folder of the class.")],
    roster: Annotated[
        Path | None, typer.Argument(metavar="[ROSTER]", help="The class list of a new class.", show_default=False)
    ] = None,
    init: Annotated[bool, typer.Option("--init", help="Make a new class, and print its links.")] = False,
    spec: Annotated[
        Path | None,
        typer.Option("--spec", metavar="SPEC", help="Assignment file with choices of a new class.", show_default=False),
    ] = None,
    policy: Annotated[
        Path | None, typer.Option("--policy", metavar="FILE", help="Policy of a new class.", show_default=False)
    ] = None,
    host: Annotated[str, typer.Option("--host", metavar="ADDRESS", help="Address to listen at.")] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", metavar="N", min=1, max=65535, help="Port to listen at.")] = 8080,
    base_url: Annotated[
        str | None,
        typer.Option("--base-url", metavar="URL", help="Address that people open, behind a proxy.", show_default=False),
    ] = None,
    backup: Annotated[
        Path | None,
        typer.Option("--backup", metavar="DIR", help="Copy the class, also while it is served.", show_default=False),
    ] = None,
    forget: Annotated[bool, typer.Option("--forget", help="Delete all personal data of the class.")] = False,
    lang: LangOption = None,
) -> None:
    """Serve a CLASS in the browser: students fill in their sheets, instructors mark them."""
    if any(find_spec(name) is None for name in NEEDED):
        complain(say("serve_lacks", lang))
        raise typer.Exit(SYSTEM)
    from reportgen.server import serving

    address = base_url or f"http://{host}:{port}"
    with ending(lang):
        if init:
            if spec is None or roster is None:
                raise typer.BadParameter(say("serve_init", lang))
            remarks = serving.make_class(folder, spec, roster, policy, lang)
            print(*remarks, sep="\n", end="\n" * bool(remarks))
            site = serving.open_site(folder, address)
            for id, name, link, code in serving.links(site):
                print(id, name, link, code, sep="\t")
            return
        site = serving.open_site(folder, address)
        print(next(iter(serving.links(site)))[2], flush=True)
        serving.run(site, host, port)
