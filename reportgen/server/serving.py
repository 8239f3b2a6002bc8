"""Start the server of a class, and make a new class: what the command `serve` calls."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import uvicorn

from reportgen import catalogue
from reportgen.base.errors import AssignmentError, Fault, Location
from reportgen.base.files import contents, held
from reportgen.base.template_folders import ATLAS, atlas_files
from reportgen.base.units import Language
from reportgen.base.words import as_error, word
from reportgen.classes.earlier_draw import read_earlier
from reportgen.classes.roster import RosterEntry, comparable
from reportgen.server.app import application
from reportgen.server.backups import forget
from reportgen.server.class_folder import ClassFolder
from reportgen.server.links import DESK
from reportgen.server.marking_queue import Queue
from reportgen.server.protocol import TimedProtocol
from reportgen.server.site import Site


def make_class(path: Path, spec: Path, roster: Path, policy: Path | None, language: Language | None) -> list[str]:
    """Make the folder of a new class and draw its variants; return remarks."""
    from reportgen.server import work

    folder = ClassFolder(path)
    folder.begin(spec, roster, policy, language)
    return work.draw(folder)


def open_site(path: Path, base_url: str, queue: Queue | None = None) -> Site:
    """Return a class with everybody of its roster known."""
    site = Site(ClassFolder(path), base_url.rstrip("/"), queue)
    known = site.store.everybody()
    if DESK not in known:
        site.links.add(DESK, "instructor", DESK, "")
    students = _present(site)
    if any(not site.folder.assignment(student.folder).exists() for student in students):
        # Somebody was added to the roster.
        from reportgen.server import work

        work.draw(site.folder)
    for student in students:
        row, name = known.get(student.folder), student.card.get("name", "")
        if row is None or row.name != name or row.dropped:
            site.links.add(student.folder, "student", student.id, name, row.drawn if row else "1")
    draws = site.folder.draws(site.language)
    for folder, row in site.store.people().items():
        if folder in draws:
            # Somebody may have redrawn the variant while nothing served the class.
            site.store.match_draw(row, draws[folder])
    return site


def _present(site: Site) -> list[RosterEntry]:
    """Return the students who have not left, and let no others sign in.

    Who has left is not in the roster any more, or was dropped, here or with `variants`.
    """
    dropped = read_earlier(site.folder.variants / "variants.csv", site.language).dropped
    listed = site.folder.students(site.language)
    present = [student for student in listed if comparable(student.id) not in dropped]
    folders = {student.folder for student in present}
    for folder, row in site.store.people().items():
        if row.role == "student" and folder not in folders:
            site.store.change_person(folder, {"dropped": True})
    return present


def desk_link(path: Path, base_url: str) -> str:
    """Return the instructor's link of a class."""
    site = open_site(path, base_url)
    try:
        return site.link(DESK)
    finally:
        site.database.close()


@contextmanager
def _alone(path: Path) -> Iterator[ClassFolder]:
    """Yield the folder of a class that nothing else serves; raise `AssignmentError` otherwise."""
    folder = ClassFolder(path)
    if not folder.spec.exists():
        raise as_error([Fault("serve-no-class", Location(str(path)))], None)
    folder.server.mkdir(parents=True, exist_ok=True, mode=0o700)
    try:
        with held(folder.server):
            yield folder
    except BlockingIOError:
        raise as_error([Fault("serve-running", Location(str(path)))], None) from None


def forget_class(path: Path) -> list[Path]:
    """Delete all personal data of a class that is not served; return what was deleted."""
    with _alone(path) as folder:
        return forget(folder)


def run(path: Path, base_url: str, host: str, port: int, tell: Callable[[str], None]) -> None:
    """Serve a class until the program is interrupted; `tell` gets the instructor's link.

    Raises `AssignmentError` if the class is served already, and for faults of its files.
    """
    with _alone(path) as folder:
        _find_machine(folder)
        site = open_site(path, base_url)
        site.prepares = True
        tell(site.link(DESK))
        _serve(site, host, port)


def _find_machine(folder: ClassFolder) -> None:
    """Raise `AssignmentError` if the machine of the class is not in the atlas, or its file is faulty.

    All variants have the kind of the first one. Other faults of a variant concern one student.
    """
    for file in sorted(folder.variants.glob("*.yaml"))[:1]:
        machines = {str(machine) for machine in atlas_files().values()}
        with suppress(OSError):
            if f"{ATLAS}/".encode() not in contents(file):
                continue
        problems = catalogue.check(file, folder.language)
        faulty = [one for one in problems if one.code == "unknown-machine" or one.location.file in machines]
        if faulty:
            raise AssignmentError(faulty)


def _serve(site: Site, host: str, port: int) -> None:
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    logging.getLogger("reportgen.server").addHandler(handler)
    logging.getLogger("reportgen.server").setLevel(logging.INFO)
    if (doubt := site.clock_doubt) is not None:
        site.log.warning("%s", word("serve_clock", site.language, **doubt))
    config = uvicorn.Config(
        application(site),
        host=host,
        port=port,
        access_log=False,
        server_header=False,
        log_level="warning",
        http=TimedProtocol,
        timeout_keep_alive=20,
        limit_concurrency=1000,
        h11_max_incomplete_event_size=32_768,
        proxy_headers=True,
        forwarded_allow_ips="127.0.0.1",
    )
    uvicorn.Server(config).run()
