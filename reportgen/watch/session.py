"""A watched file from the first page to Ctrl-C: files are watched, editions made, a browser opened.

This is the only module that imports watchfiles.
"""

from __future__ import annotations

import sys
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

from reportgen import api
from reportgen.case import Case, ExerciseCase
from reportgen.document.tree import Document
from reportgen.errors import ReportgenError
from reportgen.notation.numbers import Language
from reportgen.watch.edition import Desk
from reportgen.watch.server import Server
from reportgen.words import templates, word

QUIET, LONGEST = 20, 200
"""Changes are taken together until nothing changes for the first time (ms), and no longer than the second."""

HEARING = 0.5
"""How long (s) an interruption may have to wait."""
_ONE_AT_A_TIME = threading.Lock()


def watch(
    path: Path,
    language: Language | None = None,
    out: Path = Path("out"),
    pdf: bool = False,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve the page of a file and renew it until the program is interrupted.

    A faulty file has a page that tells its faults.  Raises `AssignmentError` if there is no file, `OutputError`.
    """
    if not path.exists():
        # A name mistyped is no file to wait for.
        api.load(path, language)
    path = path.absolute()
    renewed = _pdf_writer(path, out, stream) if pdf else _nobody
    desk = Desk(path, language, renewed)
    with api.reported():
        server = Server(desk, port)
    stop = threading.Event()
    threads = [threading.Thread(target=server.serve_forever, args=(0.1,), daemon=True)]
    threads += [
        threading.Thread(target=_follow, args=(root, wanted, desk, stop), daemon=True)
        for root, wanted in ((path.parent, path), (templates(), None))
    ]
    try:
        for thread in threads:
            thread.start()
        with _ONE_AT_A_TIME:
            desk.open()
        print(server.address, file=stream, flush=True)
        if browser:
            webbrowser.open(server.address)
        while not stop.wait(HEARING):
            pass
    except KeyboardInterrupt:
        pass
    finally:
        stop.set()
        desk.close()
        server.shutdown()
        server.server_close()


def _follow(root: Path, wanted: Path | None, desk: Desk, stop: threading.Event) -> None:
    """Renew the desk whenever the file `wanted` changes, or whatever file below `root` if none is named."""
    from watchfiles import watch as changes

    def concerns(change: object, name: str) -> bool:
        return wanted is None or Path(name) == wanted

    # An editor replaces a file by another one: its folder is watched, not the file.
    for _ in changes(
        root,
        watch_filter=concerns,
        recursive=wanted is None,
        debounce=LONGEST,
        step=QUIET,
        stop_event=stop,
        rust_timeout=500,
        raise_interrupt=False,
    ):
        with _ONE_AT_A_TIME:
            desk.renew()


def _nobody(case: Case | ExerciseCase, document: Document) -> None:
    """Takes no notice of a finished report."""


def _pdf_writer(path: Path, out: Path, stream: TextIO) -> Callable[[Case | ExerciseCase, Document], None]:
    """Writes each finished report as PDF, too, whole or not at all; says in a line what keeps it from that."""

    def write(case: Case | ExerciseCase, document: Document) -> None:
        try:
            written = api.put(out / path.stem, {"report.pdf": api.typeset(document, "typst")[1]})
            print(*written, file=stream, flush=True)
        except ReportgenError as error:
            text = word("system", case.assignment.language, text=error)
            print(f"reportgen: {text}", file=sys.stderr, flush=True)

    return write
