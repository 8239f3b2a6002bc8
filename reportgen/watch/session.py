"""A watched file from the first page to Ctrl-C: files are watched, editions made, a browser opened.

This is the only module that imports watchfiles.
"""

from __future__ import annotations

import sys
import threading
import webbrowser
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TextIO

from reportgen.document.case import Case
from reportgen.document.tree import Document
from reportgen.files import reported
from reportgen.notation.numbers import Language
from reportgen.watch.edition import Desk
from reportgen.watch.server import Server
from reportgen.words import templates

QUIET, LONGEST = 20, 200
"""Changes are taken together until nothing changes for the first time (ms), and no longer than the second."""

HEARING = 0.5
"""How long (s) an interruption may have to wait."""
_ONE_AT_A_TIME = threading.Lock()


Opener = Callable[[Path, Language | None], Case]
"""Opens the case of an assignment file; raises `AssignmentError` with its faults."""


def nobody(case: Case, document: Document) -> None:
    """Takes no notice of a finished report."""


def watch(
    path: Path,
    opens: Opener,
    language: Language | None = None,
    told: Callable[[Case, Document], None] = nobody,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve the page of a file and renew it until the program is interrupted; `told` of each finished report.

    A faulty file has a page that tells its faults.  Raises `AssignmentError` if there is no file, `OutputError`.
    """
    if not path.exists():
        # A name mistyped is no file to wait for.
        opens(path, language)
    path = path.absolute()
    desk = Desk(partial(opens, path, language), language, told)
    with reported():
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
