"""A batch: makes what is missing or changed, writes it as it comes, and can be killed at any moment."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TextIO

from reportgen import api
from reportgen.assignment.faults import Fault
from reportgen.assignment.messages import as_problem, word
from reportgen.batch import manifest
from reportgen.batch.jobs import SYSTEM, Job, Making, Outcome
from reportgen.batch.manifest import Entry
from reportgen.batch.matching import Assigned
from reportgen.batch.pool import Pool
from reportgen.batch.progress import Watch, watching
from reportgen.errors import Mark, Problem
from reportgen.notation.numbers import Language
from reportgen.products import Maker

NO_ROOM = frozenset({errno.ENOSPC, errno.EROFS, errno.EIO, getattr(errno, "EDQUOT", errno.ENOSPC)})
"""What would meet every other student, too."""
NO_LOCKS = frozenset({errno.EBADF, errno.EINVAL, errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS})
_TEMPORARY = re.compile(r"\..+\.(?:pdf|xlsx|csv|json|yaml)\.[a-z0-9_]{8}")
"""What `api.replace` leaves when it is killed."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A product that could not be made; marks name the file as it can be opened from here."""

    student: str
    product: str
    problems: tuple[Problem | str, ...]


@dataclass(frozen=True, slots=True)
class Result:
    """What a batch came to: counts of products, the failures by student, the exit code they mean.

    `gone` counts students of an earlier run who are no longer on the roster; their folders are left alone.
    """

    manifest: Path
    made: int
    kept: int
    failures: tuple[Failure, ...]
    gone: int
    exit_code: int


def run(
    assigned: Sequence[Assigned],
    out: Path,
    makers: Mapping[str, Maker],
    making: Making,
    pool: Pool,
    stream: TextIO,
) -> Result:
    """Makes the products named by `makers` for each student, into `out`/<folder>/, and `manifest.json`.

    What the manifest of an earlier run vouches for is kept; events go to `stream`.  A student's failure
    is part of the result; raises `OutputError` when nothing can be written any more.  The caller holds
    `out` (`held`).
    """
    for folder in (out, *(out / one.student.folder for one in assigned)):
        sweep(folder)
    before = manifest.read(out)
    order = {one.student.id: number for number, one in enumerate(assigned)}
    entries = {key: found for key, found in before.items() if found.student in order}
    with api.reported():
        manifest.write(out, entries.values())
    opened = [_opened(one, making.language or "vi") for one in assigned]
    jobs: dict[bool, list[Job]] = {True: [], False: []}
    for one, content in opened:
        for job in _jobs(one, content, makers, making):
            jobs[_holds(entries.get((job.student, job.product)), job, out)].append(job)
    kept, todo = jobs[True], jobs[False]
    with (
        watching(len(assigned) * len(makers), stream, making.language or "vi") as watch,
        manifest.Journal(out) as record,
    ):
        book = _Book(entries, record, watch)
        for job in kept:
            watch(job.folder, job.product, "kept")
        for one, _ in opened:
            if one.problem is not None:
                for product in makers:
                    book.without_file(one, product, one.problem)
        files = {one.student.id: str(one.file) for one in assigned}
        with closing(pool(todo, lambda job: watch(job.folder, job.product, "retried"))) as outcomes:
            for job, outcome in outcomes:
                book.ended(job, _written(job, outcome, out), files[job.student])
    with api.reported():
        target = manifest.write(out, entries.values())
    failures = tuple(sorted(book.failures, key=lambda failure: order[failure.student]))
    gone = {found.student for found in before.values()} - order.keys()
    return Result(target, book.made, len(kept), failures, len(gone), book.exit_code)


@contextmanager
def held(out: Path, language: Language) -> Iterator[None]:
    """Makes the folder and keeps other batches away from it, without leaving a trace.

    Raises `OutputError` if there is another one, or if there can be no such folder.
    """
    with api.reported():
        out.mkdir(parents=True, exist_ok=True)
    try:
        import fcntl
    except ImportError:  # no such locks on this system
        yield
        return
    handle = os.open(out, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise api.OutputError(word("out_in_use", language).format(out=out)) from error
        except OSError as error:
            # Some network folders know no locks.
            if error.errno not in NO_LOCKS:
                raise
        yield
    finally:
        os.close(handle)


def sweep(folder: Path) -> None:
    """Removes what a killed run was writing just then."""
    if folder.is_dir():
        for path in folder.iterdir():
            if _TEMPORARY.fullmatch(path.name):
                path.unlink(missing_ok=True)


@dataclass(slots=True)
class _Book:
    """What has come so far; each entry is taken down before it is told."""

    entries: dict[tuple[str, str], Entry]
    record: Callable[[Entry], None]
    watch: Watch
    failures: list[Failure] = field(default_factory=list)
    made: int = 0
    exit_code: int = 0

    def ended(self, job: Job, outcome: Outcome, file: str) -> None:
        problems = tuple(_from_here(problem, file) for problem in outcome.problems)
        self._take_down(manifest.entry(job, outcome), problems, outcome.exit_code)

    def without_file(self, one: Assigned, product: str, problem: Problem) -> None:
        told = str(_from_here(problem, Path(problem.mark.file).name))
        made = Entry(one.student.id, one.student.folder, product, problems=(told,))
        self._take_down(made, (problem,), 1)

    def _take_down(self, made: Entry, problems: tuple[Problem | str, ...], code: int) -> None:
        self.entries[made.student, made.product] = made
        with api.reported():
            self.record(made)
        self.exit_code = max(self.exit_code, code)
        if problems:
            self.failures.append(Failure(made.student, made.product, problems))
        self.made += not problems
        self.watch(made.folder, made.product, "failed" if problems else "done")


def _opened(one: Assigned, language: Language) -> tuple[Assigned, bytes]:
    """A student's assignment with the content of its file; one that cannot be read is this student's matter."""
    if one.file is None:
        return one, b""
    try:
        return one, one.file.read_bytes()
    except OSError as error:
        fault = Fault("unreadable", Mark(str(one.file)), {"reason": type(error).__name__})
        return Assigned(one.student, None, as_problem(fault, language)), b""


def _jobs(one: Assigned, content: bytes, makers: Mapping[str, Maker], making: Making) -> list[Job]:
    if one.file is None:
        return []
    student = one.student
    return [
        Job(student.id, student.folder, product, maker, one.file.name, content, making)
        for product, maker in makers.items()
    ]


def _holds(found: Entry | None, job: Job, out: Path) -> bool:
    return found is not None and found.holds(job, out)


def _written(job: Job, outcome: Outcome, out: Path) -> Outcome:
    """The outcome once its files stand; if they cannot, and it is this student's matter alone, a failure.

    Raises `OutputError` where it is not.
    """
    try:
        if outcome.files:
            (out / job.folder).mkdir(exist_ok=True)
        for name, content in outcome.files.items():
            api.replace(out / job.folder / name, content)
    except OSError as error:
        if error.errno in NO_ROOM:
            raise api.OutputError(f"{error.filename or ''}: {error.strerror or error}") from error
        text = word("system", job.making.language or "vi").format(text=error.strerror or error)
        return Outcome(problems=(f"{job.folder}: {text}",), exit_code=SYSTEM)
    return outcome


def _from_here(problem: Problem | str, file: str) -> Problem | str:
    if isinstance(problem, str):
        return problem
    return replace(problem, mark=replace(problem.mark, file=file))
