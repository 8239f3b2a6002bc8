"""Serve the page of a file until Ctrl-C and renew it whenever the file changes: `watch`, `edit`, `choose`.

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
from queue import SimpleQueue
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
from reportgen.page.kind_cards import CardDrawing
from reportgen.page.kind_chooser import Chooser
from reportgen.page.live_view import LiveSession
from reportgen.page.local_server import Server
from reportgen.page.preview_pages import Typesetting, no_pages

QUIET, LONGEST = 20, 200
"""Changes are collected until none arrives for the first time (ms), but no longer than the second."""

LOOKING = 0.05
"""Seconds between two looks at the file."""
HEARING = 0.5
"""Longest delay (s) of an interruption."""
_ONE_AT_A_TIME = threading.Lock()


Products = Callable[[Path], Mapping[str, Sequence[str]]]
"""Returns the commands that make something of a file, by the names of their products."""


class Opener(Protocol):
    """Opens the case of an assignment file, or of a part of a `whole`; raises `AssignmentError` with its faults."""

    def __call__(self, path: Path, language: Language | None = None, whole: Path | None = None) -> Case: ...


def ignore_report(case: Case, document: Document) -> None:
    """Ignore a finished report."""


def no_products(path: Path) -> Mapping[str, Sequence[str]]:
    """Return no products."""
    return {}


def watch(
    path: Path,
    opens: Opener,
    language: Language | None = None,
    tell: Callable[[Case, Document], None] = ignore_report,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve the page of a file and renew it until the program is interrupted; call `tell` with each finished report.

    A faulty file has a page that shows its faults. Raises `AssignmentError` if there is no file, `OutputError`.
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
    products: Products = no_products,
    pages: Typesetting = no_pages,
    browser: bool = True,
    port: int = 0,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve a page as `watch` does, with a form beside the animation that changes the file and makes `products`."""
    if not path.is_file():
        opens(path, language)
    with (
        suppress(KeyboardInterrupt),
        edited(path.absolute(), opens, language, products, pages=pages, port=port) as server,
    ):
        _announce(server, browser, stream)
        _wait()


@contextmanager
def edited(
    path: Path,
    opens: Opener,
    language: Language | None = None,
    products: Products = no_products,
    pages: Typesetting = no_pages,
    port: int = 0,
) -> Iterator[Server]:
    """Yield the server of a file's form, which answers requests and is renewed while the context is open."""
    with (
        _with_parts(path, opens, language, products, pages) as session,
        _served(session, port) as server,
        _followed(session, path, opens),
    ):
        yield server


def choose(
    begins: Callable[[str, str], Path],
    opens: Opener,
    language: Language | None = None,
    products: Products = no_products,
    pages: Typesetting = no_pages,
    draws: Callable[[str], CardDrawing] | None = None,
    browser: bool = True,
    stream: TextIO = sys.stdout,
) -> None:
    """Serve a page on which a kind is chosen, whose file is then edited; `begins` makes it of a kind and a sample.

    `draws` draws the scheme of a machine of the user's folder.
    """
    chooser = Chooser(partial(opens, Path(), language), language, begins=begins, draws=draws)
    with _served(chooser, 0) as server:
        _announce(server, browser, stream)
        with suppress(KeyboardInterrupt):
            while not chooser.chosen.wait(HEARING):
                pass
            path = chooser.path.absolute()
            with _with_parts(path, opens, language, products, pages) as session, _followed(session, path, opens):
                server.session = session
                chooser.ready.set()
                _wait()


@contextmanager
def _with_parts(
    path: Path, opens: Opener, language: Language | None, products: Products, pages: Typesetting
) -> Iterator[EditSession]:
    """Yield the session of an edited file; sessions of its parts' files open on request and are renewed from then."""
    with ExitStack() as followed:

        def of_part(file: Path) -> EditSession:
            # The part's file need not say its language, so faults are reported in that of the coursework.
            spoken = language or language_of(read_source(path))
            part = EditSession(
                partial(opens, file, spoken, path), spoken, path=file, products=products(file), whole=path, pages=pages
            )
            followed.enter_context(_followed(part, file, opens, path))
            return part

        yield EditSession(
            partial(opens, path, language), language, path=path, products=products(path), of_part=of_part, pages=pages
        )


def serve(
    session: LiveSession, path: Path, opens: Opener, browser: bool = True, port: int = 0, stream: TextIO = sys.stdout
) -> None:
    """Serve a live session, and renew it whenever its file changes, until the program is interrupted."""
    with _served(session, port) as server, suppress(KeyboardInterrupt), _followed(session, path, opens):
        _announce(server, browser, stream)
        _wait()


@contextmanager
def _served(session: LiveSession, port: int) -> Iterator[Server]:
    """Yield a server that answers requests while the context is open."""
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
    """Yield a session that is renewed with its file and with those `beside` it while the context is open."""
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
        # The first page is made while the browser starts.
        threading.Thread(target=server.session.page, daemon=True).start()
        webbrowser.open(server.address)


def _wait() -> None:
    """Wait for Ctrl-C in short sleeps, because a longer one would not be interrupted on every system."""
    never = threading.Event()
    while not never.wait(HEARING):
        pass


def _school(path: Path, opens: Opener) -> Path | None:
    """Return the folder of a school's templates that a file names when it is first opened, or None."""
    with suppress(ReportgenError):
        return opens(path, None).assignment.school
    return None


def _follow(states: Callable[[], object], session: LiveSession, stop: threading.Event, known: object) -> None:
    """Renew the live session whenever the states of its files differ from the `known` ones.

    The paths are polled, because a file watcher holds on to a renamed folder, does not follow links and misses changes
    made by another computer.
    """
    with _shown(session) as checked:
        while not stop.is_set():
            # What the form itself has written need not be waited for.
            own = session.touched.wait(LOOKING)
            session.touched.clear()
            if states() != known:
                stop.wait(0 if own else QUIET / 1000)
                known = states()
                if case := session.check():
                    checked.put(case)


@contextmanager
def _shown(session: LiveSession) -> Iterator[SimpleQueue[tuple[int, Case] | None]]:
    """Yield a queue of checked cases, which another thread shows, always the newest, while more are checked."""
    checked: SimpleQueue[tuple[int, Case] | None] = SimpleQueue()

    def show() -> None:
        while case := checked.get():
            while not checked.empty():
                newer = checked.get()
                if newer is None:
                    return
                case = newer
            with _ONE_AT_A_TIME:
                session.show(*case)

    threading.Thread(target=show, daemon=True).start()
    try:
        yield checked
    finally:
        checked.put(None)


def _states(path: Path, *beside: Path) -> tuple[tuple[float, ...], ...]:
    """Return values that change with a file and with the files of its parts, and with further ones."""
    own = _state(path)
    return own, *map(_state, (*_beside(path, own), *beside))


@lru_cache(maxsize=4)
def _beside(path: Path, _: tuple[float, ...]) -> tuple[Path, ...]:
    """Return the files of a file's parts, cached for as long as the file stays the same."""
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
