"""A watched file from the first page to Ctrl-C: files are watched, revisions made, a browser opened.

This is the only module that imports watchfiles, for the templates.
"""

from __future__ import annotations

import sys
import threading
import webbrowser
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import lru_cache, partial
from pathlib import Path
from typing import Protocol, TextIO

from reportgen.assignment import parts
from reportgen.base.errors import ReportgenError
from reportgen.base.files import reported
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.base.words import language_of
from reportgen.base.yaml_source import read_source
from reportgen.case import Case
from reportgen.document import Document
from reportgen.page.edit_session import EditSession
from reportgen.page.kind_chooser import Chooser
from reportgen.page.live_view import LiveSession
from reportgen.page.local_server import Server

QUIET, LONGEST = 20, 200
"""Changes are taken together until nothing changes for the first time (ms), and no longer than the second."""

LOOKING = 0.05
"""From one look at the file to the next (s)."""
HEARING = 0.5
"""Longest delay (s) of an interruption."""
_ONE_AT_A_TIME = threading.Lock()


Products = Callable[[Path], Mapping[str, Sequence[str]]]
"""The commands that make something of a file, by the names of their products."""


class Opener(Protocol):
    """Opens the case of an assignment file, or of a part of a `whole`; raises `AssignmentError` with its faults."""

    def __call__(self, path: Path, language: Language | None = None, whole: Path | None = None) -> Case: ...


def nobody(case: Case, document: Document) -> None:
    """Takes no notice of a finished report."""


def nothing(path: Path) -> Mapping[str, Sequence[str]]:
    """Makes nothing of a file."""
    return {}


def watch(
    path: Path,
    opens: Opener,
    language: Language | None = None,
    tell: Callable[[Case, Document], None] = nobody,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve the page of a file and renew it until the program is interrupted; call `tell` with each finished report.

    A faulty file has a page that shows its faults.  Raises `AssignmentError` if there is no file, `OutputError`.
    """
    if not path.is_file():
        # A name mistyped is no file to wait for, nor is a pipe.
        opens(path, language)
    path = path.absolute()
    serve(LiveSession(partial(opens, path, language), language, tell), path, opens, browser, port, stream)


def edit(
    path: Path,
    opens: Opener,
    language: Language | None = None,
    products: Products = nothing,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """As `watch`, with a form beside what moves, by which the file is changed and its `products` are made."""
    if not path.is_file():
        opens(path, language)
    with suppress(KeyboardInterrupt), edited(path.absolute(), opens, language, products, port) as server:
        _announce(server, browser, stream)
        _wait()


@contextmanager
def edited(
    path: Path, opens: Opener, language: Language | None = None, products: Products = nothing, port: int = 0
) -> Iterator[Server]:
    """The server of a file's form, which answers and is renewed meanwhile."""
    with (
        _with_parts(path, opens, language, products) as session,
        _served(session, port) as server,
        _followed(session, path, opens),
    ):
        yield server


def choose(
    begins: Callable[[str], Path],
    opens: Opener,
    language: Language | None = None,
    products: Products = nothing,
    browser: bool = True,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve a page on which a kind is chosen, whose file is then edited; `begins` makes the file of a kind."""
    chooser = Chooser(partial(opens, Path(), language), language, begins=begins, example=opens)
    with _served(chooser, 0) as server:
        _announce(server, browser, stream)
        with suppress(KeyboardInterrupt):
            while not chooser.chosen.wait(HEARING):
                pass
            path = chooser.path.absolute()
            with _with_parts(path, opens, language, products) as session, _followed(session, path, opens):
                server.session = session
                chooser.ready.set()
                _wait()


@contextmanager
def _with_parts(path: Path, opens: Opener, language: Language | None, products: Products) -> Iterator[EditSession]:
    """The session of an edited file; those of its parts' files are open and renewed from when they are asked for."""
    with ExitStack() as followed:

        def of_part(file: Path) -> EditSession:
            # It is told in the language of the coursework, which its file need not say.
            spoken = language or language_of(read_source(path))
            part = EditSession(
                partial(opens, file, spoken, path), spoken, path=file, products=products(file), whole=path
            )
            followed.enter_context(_followed(part, file, opens, path))
            return part

        yield EditSession(partial(opens, path, language), language, path=path, products=products(path), of_part=of_part)


def serve(
    session: LiveSession, path: Path, opens: Opener, browser: bool = True, port: int = 0, stream: TextIO = sys.stdout
) -> None:
    """Serve a live session, and renew it whenever its file changes, until the program is interrupted."""
    with _served(session, port) as server, suppress(KeyboardInterrupt), _followed(session, path, opens):
        _announce(server, browser, stream)
        _wait()


@contextmanager
def _served(session: LiveSession, port: int) -> Iterator[Server]:
    """A server that answers meanwhile."""
    with reported():
        server = Server(session, port)
    thread = threading.Thread(target=server.serve_forever, args=(0.1,), daemon=True)
    try:
        thread.start()
        yield server
    finally:
        server.session.close()
        server.shutdown()
        server.server_close()


@contextmanager
def _followed(session: LiveSession, path: Path, opens: Opener, *beside: Path) -> Iterator[None]:
    """A session that is open and renewed meanwhile, with its file and with those `beside` it."""
    stop, states = threading.Event(), partial(_states, path, *beside)
    threads = (
        threading.Thread(target=_follow, args=(states, session, stop, states()), daemon=True),
        threading.Thread(target=_follow_templates, args=(session, stop, _school(path, opens)), daemon=True),
    )
    try:
        for thread in threads:
            thread.start()
        with _ONE_AT_A_TIME:
            session.open()
        yield
    finally:
        stop.set()
        session.close()


def _announce(server: Server, browser: bool, stream: TextIO) -> None:
    print(server.address, file=stream, flush=True)
    if browser:
        webbrowser.open(server.address)


def _wait() -> None:
    """Wait for Ctrl-C, which would not be heard in a longer sleep."""
    never = threading.Event()
    while not never.wait(HEARING):
        pass


def _school(path: Path, opens: Opener) -> Path | None:
    """The school's folder that a file names when it is opened first."""
    with suppress(ReportgenError):
        return opens(path, None).assignment.school
    return None


def _follow(states: Callable[[], object], session: LiveSession, stop: threading.Event, known: object) -> None:
    """Renew the live session whenever the states of its files are not as they were `known`.

    Their paths are asked again and again: what watches files holds on to a folder that was renamed, does not follow
    links and hears nothing of changes that another computer makes.
    """
    while not stop.is_set():
        # What the form itself has written need not be waited for.
        own = session.touched.wait(LOOKING)
        session.touched.clear()
        if states() != known:
            stop.wait(0 if own else QUIET / 1000)
            known = states()
            with _ONE_AT_A_TIME:
                session.renew()


def _states(path: Path, *beside: Path) -> tuple[tuple[float, ...], ...]:
    """Return values that change with a file and with the files of its parts, and with further ones."""
    own = _state(path)
    return own, *map(_state, (*_beside(path, own), *beside))


@lru_cache(maxsize=4)
def _beside(path: Path, _: tuple[float, ...]) -> tuple[Path, ...]:
    """The files of the parts of a file, read once for as long as it stays the same."""
    return tuple(parts.files(read_source(path), path))


def _state(path: Path) -> tuple[float, ...]:
    """Return values that change with a file, or with the target of its path; empty if there is none."""
    try:
        about = path.stat()
    except OSError:
        return ()
    return about.st_dev, about.st_ino, about.st_mode, about.st_size, about.st_mtime_ns, about.st_ctime_ns


def _follow_templates(session: LiveSession, stop: threading.Event, school: Path | None) -> None:
    """Renew the live session whenever a file of the templates changes, or of a school's folder."""
    from watchfiles import watch as changes

    for _ in changes(
        *filter(None, (templates(), school and templates() / school)),
        watch_filter=None,
        debounce=LONGEST,
        step=QUIET,
        stop_event=stop,
        rust_timeout=500,
        raise_interrupt=False,
    ):
        with _ONE_AT_A_TIME:
            session.renew()
