"""The command that serves a class in the browser."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from reportgen.cli.common import AT_FAULT, SYSTEM, AtlasOption, LangOption, complain, ending, say

NEEDED = ("starlette", "uvicorn", "multipart", "itsdangerous", "sqlalchemy", "alembic")
"""Modules of the packages that `reportgen[server]` installs."""


def serve(
    folder: Annotated[Path, typer.Argument(metavar="CLASS", help="Folder of the class.", show_default=False)],
    roster: Annotated[
        Path | None, typer.Argument(metavar="ROSTER", help="The class list of a new class.", show_default=False)
    ] = None,
    init: Annotated[bool, typer.Option("--init", help="Make a new class, and print the instructor's link.")] = False,
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
    atlas: AtlasOption = None,
) -> None:
    """Serve a CLASS in the browser: students fill in their sheets, instructors mark them."""
    if any(find_spec(name) is None for name in NEEDED):
        complain(say("serve_lacks", lang))
        raise typer.Exit(SYSTEM)
    from reportgen.server import backups, serving
    from reportgen.server.class_folder import ClassFolder

    address = base_url or f"http://{host}:{port}"
    with ending(lang), _private():
        if backup is not None:
            print(backups.back_up(ClassFolder(folder), backup))
            return
        if forget:
            if not _confirmed(say("serve_forget", lang, folder=folder)):
                raise typer.Exit(AT_FAULT)
            print(*serving.forget_class(folder), sep="\n")
            return
        if init:
            if spec is None or roster is None:
                raise typer.BadParameter(say("serve_init", lang))
            remarks = serving.make_class(folder, spec, roster, policy, lang)
            print(*remarks, sep="\n", end="\n" * bool(remarks), file=sys.stderr)
            print(serving.desk_link(folder, address))
            return
        serving.run(folder, address, host, port, lambda link: print(link, flush=True))


@contextmanager
def _private() -> Iterator[None]:
    """Make all files for their owner alone: they name students and have their work."""
    before = os.umask(0o077)
    try:
        yield
    finally:
        os.umask(before)


def _confirmed(question: str) -> bool:
    """Return True if somebody agrees; nobody does where nobody can answer."""
    try:
        return typer.confirm(question)
    except typer.Abort:
        return False
