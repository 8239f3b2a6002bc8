"""Run a batch (`run_batch`): make the products that are missing or changed and write each one when it is done.

A run can be killed at any time; the next one continues.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TextIO

from reportgen import api
from reportgen.api import ASKING, MAKERS, TYPESET, USUAL, Maker
from reportgen.api.report_fonts import Engine
from reportgen.assignment.reading import inputs
from reportgen.base.errors import Fault, Location, OutputError, Problem
from reportgen.base.files import cause, held, put_set, remove_unfinished, reported, scratch
from reportgen.base.pdf_standards import STANDARDS, Standards, other_than_usual
from reportgen.base.records import Record, replace
from reportgen.base.units import Language, write
from reportgen.base.words import as_problem, counted, spoken, word
from reportgen.classes import preload
from reportgen.classes.batch_manifest import ManifestEntry, entry_of, journal, read_manifest, write_manifest
from reportgen.classes.roster import Assigned, Roster, RosterEntry, match_files, read_roster
from reportgen.classes.variants import make_variants
from reportgen.classes.worker_pool import Job, Making, Outcome, Pool, failed, local, making
from reportgen.marking.toleranced_key import Ask

if TYPE_CHECKING:
    from rich.progress import ProgressColumn


DRAWN = "assignments"
"""Folder, below the results, of the drawn assignment files."""
NO_ROOM = frozenset({errno.ENOSPC, errno.EROFS, errno.EIO, getattr(errno, "EDQUOT", errno.ENOSPC)})
"""Errors that would affect every other student too."""

Event = Literal["kept", "retried", "done", "failed"]
"""`kept`: made by an earlier run; `retried`: its worker died and another one starts again."""
Watch = Callable[[str, str, Event], None]
"""Receives the student's folder, the product and the event; no names, no content."""


class Order(Record):
    """The request of a batch: assignments drawn from `spec` into `out`, or found in `assignments`; exactly one of both.

    `jobs` is the number of local processes (0: one for each core), unless `cluster` gives a scheduler's address. `ask`
    is the selection of the answer sheets, None for the default. The spec's table may be below a `shared` folder. A PDF
    by typst conforms to the `standards`.
    """

    roster: Path
    spec: Path | None = None
    assignments: Path | None = None
    out: Path = Path("out")
    products: tuple[str, ...] = USUAL
    engine: Engine = "typst"
    language: Language | None = None
    jobs: int = 0
    cluster: str | None = None
    ask: Ask | None = None
    shared: tuple[Path, ...] = ()
    standards: Standards = STANDARDS


class Failure(Record):
    """A product that could not be made; its problems name the file by a path that can be opened from here."""

    student: str
    product: str
    problems: tuple[Problem | str, ...]


@dataclass(slots=True)
class Result:
    """The result of a batch: counts of products, the failures by student, and the resulting exit code.

    `notes` are messages about unused files and columns, and about students of an earlier run who are gone.
    """

    manifest: Path
    notes: list[str]
    students: list[tuple[str, str]] = field(default_factory=list)
    """The folder of each student, in the order of the roster, and the student's title."""
    made: int = 0
    kept: int = 0
    failures: list[Failure] = field(default_factory=list)
    exit_code: int = 0

    def summary(self, language: Language | None) -> Iterator[str]:
        """Yield the summary lines: notes, each problem once with all affected students, the counts."""
        yield from self.notes
        if self.failures:
            yield word("batch_failed", language, count=len(self.failures))
        met: dict[Problem | str, list[str]] = {}
        for failure in self.failures:
            for problem in failure.problems:
                met.setdefault(problem, []).append(f"{failure.student} {failure.product}")
        for problem, products in met.items():
            # A located problem already names the student's file.
            yield f"{', '.join(products)}: {problem}" if isinstance(problem, str) else str(problem)
        yield word("batch_ended", language, made=self.made, kept=self.kept, failed=len(self.failures))


def run_batch(order: Order, stream: TextIO, makers: Mapping[str, Maker] = MAKERS, pool: Pool | None = None) -> Result:
    """Make the ordered products of each student, in `out`/<folder>/, and `manifest.json`.

    Products that the manifest of an earlier run confirms are kept. Events are written to `stream` as they happen;
    `pool` may replace the order's. A student's failure is part of the result. Raises `AssignmentError` for an invalid
    roster, spec or folder of assignments, `OutputError` if nothing can be written, `ClusterError` if the cluster is
    unavailable.
    """
    roster = read_roster(order.roster, order.language)
    chosen = {
        name: partial(makers[name], **special) if (special := _special(order, name)) else makers[name]
        for name in order.products
    }
    workers = pool or _pool(order, len(roster.students))
    with locked(order.out, order.language), reported(order.out), scratch(order.out) as temporary:
        return _run(order, roster, chosen, workers, stream, None if order.cluster else temporary)


def _special(order: Order, product: str) -> dict[str, Any]:
    """Return the additional arguments of a product's maker that differ from the default and matter to it."""
    asked = {"ask": order.ask} if order.ask is not None and product in ASKING else {}
    kept = {"standards": order.standards} if product in TYPESET and order.standards != STANDARDS else {}
    return {**asked, **kept}


def _how(order: Order, product: str) -> Making:
    """Return the inputs of a product on this machine, with its additional arguments as text for the manifest."""
    special = _special(order, product)
    ask = str(order.ask) if "ask" in special else ""
    return making(order.engine, order.language, ask, other_than_usual(special.get("standards", STANDARDS)))


def _run(
    order: Order, roster: Roster, makers: Mapping[str, Maker], pool: Pool, stream: TextIO, temporary: Path | None
) -> Result:
    assigned, notes = _assigned(order, roster)
    if order.ask is not None and ASKING & makers.keys():
        api.check_ask(order.ask, (file for _, file in assigned if isinstance(file, Path)), order.language)
    out = order.out
    for folder in (out, *(out / student.folder for student, _ in assigned)):
        remove_unfinished(folder)
    before = read_manifest(out)
    number = {student.id: number for number, (student, _) in enumerate(assigned)}
    entries = {key: entry for key, entry in before.items() if entry.student in number}
    with reported(out):
        people = [(student.folder, student.title) for student, _ in assigned]
        result = Result(write_manifest(out, entries.values()), notes, people)
    how = {name: _how(order, name) for name in makers}
    kept: list[Job] = []
    jobs: list[Job] = []
    refused: list[tuple[RosterEntry, Problem]] = []
    for student, file in assigned:
        read = _read(file, order.language)
        if isinstance(read, Problem):
            refused.append((student, read))
            continue
        for product, maker in makers.items():
            file_name, content, beside = read
            job = Job(
                *(student.id, student.folder, product, maker, file_name, content),
                making=how[product],
                beside=beside,
                scratch=temporary,
            )
            entry = entries.get((job.student, product))
            (kept if entry is not None and entry.holds(job, out) else jobs).append(job)
    result.kept = len(kept)
    with watching(len(assigned) * len(makers), stream, order.language or spoken()) as watch, journal(out) as record:

        def add(entry: ManifestEntry, problems: tuple[Problem | str, ...], exit_code: int) -> None:
            """Add an entry; it is in the journal before its event is shown."""
            earlier = entries.get((entry.student, entry.product))
            if problems and earlier is not None and earlier.folder == entry.folder:
                # Files of an earlier run stay recorded, because they may be edited.
                entry = replace(entry, files=earlier.files)
            entries[entry.student, entry.product] = entry
            with reported(out):
                record(entry)
            result.exit_code = max(result.exit_code, exit_code)
            if problems:
                result.failures.append(Failure(entry.student, entry.product, problems))
            else:
                result.made += 1
            watch(entry.folder, entry.product, "failed" if problems else "done")

        for job in kept:
            watch(job.folder, job.product, "kept")
        for student, problem in refused:
            # The manifest contains no folders.
            text = str(problem.in_file(Path(problem.location.file).name))
            for product in makers:
                add(ManifestEntry(student.id, student.folder, product, problems=(text,)), (problem,), exit_code=1)
        files = {student.id: str(file) for student, file in assigned}
        with closing(pool(jobs, lambda job: watch(job.folder, job.product, "retried"))) as outcomes:
            for job, made in outcomes:
                outcome = _put(job, made, out, entries.get((job.student, job.product)))
                file_name = files[job.student]
                problems = tuple(
                    entry
                    if isinstance(entry, str)
                    else entry.in_file(str(Path(file_name).parent / entry.location.file))
                    for entry in outcome.problems
                )
                add(entry_of(job, outcome), problems, outcome.exit_code)
    with reported(out):
        write_manifest(out, entries.values())
    edited = (path for student, _ in assigned for name in makers for path in entries[student.id, name].edited(out))
    result.notes += [word("batch_edited", order.language, path=path) for path in edited]
    result.failures.sort(key=lambda failure: number[failure.student])
    if gone := {entry.student for entry in before.values()} - number.keys():
        result.notes.append(counted("batch_gone", order.language, len(gone)))
    return result


# --- progress ---------------------------------------------------------------------------------------


@contextmanager
def watching(total: int, stream: TextIO, language: Language) -> Iterator[Watch]:
    """Show the events of `total` products on a stream: a bar on a terminal, else a tab-separated line for each."""
    if stream.isatty():
        with _bar(total, stream, language) as watch:
            yield watch
    else:
        yield lambda *event: print(*event, sep="\t", file=stream, flush=True)


@contextmanager
def _bar(total: int, stream: TextIO, language: Language) -> Iterator[Watch]:
    """Show a bar with count, rate, remaining time and the number of failures; kept products reduce the total."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        _rate(language),
        TimeRemainingColumn(elapsed_when_finished=True),
        TextColumn("{task.fields[failed]}", style="red"),
    )
    with Progress(*columns, console=Console(file=stream)) as progress:
        task = progress.add_task("", total=total, failed="")
        failed = 0

        def watch(_folder: str, _product: str, event: Event) -> None:
            nonlocal total, failed
            if event == "kept":
                total -= 1
                progress.update(task, total=total)
            elif event != "retried":
                failed += event == "failed"
                text = word("bar_failed", language, count=failed) if failed else ""
                progress.update(task, advance=1, failed=text)

        yield watch


def _rate(language: Language) -> ProgressColumn:
    from rich.progress import ProgressColumn, Task
    from rich.text import Text

    class Rate(ProgressColumn):
        """Products per minute."""

        def render(self, task: Task) -> Text:
            speed = task.finished_speed or task.speed
            rate = "–" if speed is None else write(60 * speed, 0 if speed > 1 else 1, language)
            return Text(word("bar_rate", language, rate=rate), style="progress.data.speed")

    return Rate()


# --- students and processes -------------------------------------------------------------------------


def _assigned(order: Order, roster: Roster) -> tuple[list[Assigned], list[str]]:
    """Return each student with a file, and notes on files and columns that were not used."""
    if order.spec is not None:
        folder = order.out / DRAWN
        remove_unfinished(folder)
        variants = make_variants(order.spec, order.roster, folder, language=order.language, shared=order.shared)
        return [(file.drawn.student, file.path) for file in variants.files], list(variants.remarks)
    if order.assignments is None:
        raise ValueError("assignments are either drawn or given")
    assigned, unused = match_files(roster.students, order.assignments, order.language)
    notes = [*map(str, roster.notes), *(word("batch_nobodys", order.language, path=path) for path in unused)]
    if roster.columns:
        names = ", ".join(column.name for column in roster.columns)
        notes.append(word("batch_columns", order.language, columns=names))
    return assigned, notes


def _read(file: Path | Problem, language: Language | None) -> tuple[str, bytes, Mapping[str, bytes]] | Problem:
    """Return an assignment file's name and content, and the files beside it; a problem if it cannot be read."""
    if isinstance(file, Problem):
        return file
    try:
        return file.name, *inputs(file)
    except OSError as error:
        return as_problem(Fault("unreadable", Location(str(file)), {"reason": cause(error)}), language)


def _pool(order: Order, students: int) -> Pool:
    if order.cluster is not None:
        from reportgen.classes.dask_cluster import cluster

        return cluster(order.cluster, order.language)
    # Default: as many as the cores that this process may use.
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    given = (order.assignments or order.spec) if students >= preload.FEW else None
    samples = preload.samples(given, order.language, order.engine, order.products) if given else ()
    return local(order.jobs or cores, samples, order.out)


# --- files ------------------------------------------------------------------------------------------


@contextmanager
def locked(out: Path, language: Language | None) -> Iterator[None]:
    """Make the folder and lock it against other batches, without leaving a trace; a new folder that stays empty goes.

    Raises `OutputError` if another batch uses it, or if the folder cannot be made.
    """
    new = [folder for folder in (out, *out.parents) if not folder.exists()]
    try:
        with ExitStack() as lock:
            with reported():
                out.mkdir(parents=True, exist_ok=True)
                try:
                    lock.enter_context(held(out))
                except BlockingIOError as error:
                    raise OutputError(word("out_in_use", language, out=out)) from error
            yield
    finally:
        with suppress(OSError):  # not empty
            for folder in new:
                folder.rmdir()


def _put(job: Job, outcome: Outcome, out: Path, earlier: ManifestEntry | None) -> Outcome:
    """Write the files of an outcome and return it; return a failure if writing fails for this student alone.

    Files that an earlier run made and this one did not, such as a third sheet of two, are deleted; edited files are
    kept. Raises `OutputError` if every other student would be affected too.
    """
    if not outcome.files:
        return outcome
    try:
        (out / job.folder).mkdir(exist_ok=True)
        made = {out / job.folder / name: content for name, content in outcome.files.items()}
        if earlier is None or earlier.folder != job.folder:
            put_set(made)
        else:
            # A file that equals the new one is not edited: a run was killed before it recorded the file.
            edited = {*earlier.edited(out)} & {*entry_of(job, outcome).edited(out)}
            put_set(
                {path: made[path] for path in made.keys() - edited},
                tuple(earlier.made.outlived(outcome.files, out / earlier.folder)),
            )
    except OSError as error:
        if error.errno in NO_ROOM:
            raise OutputError(f"{error.filename or ''}: {error.strerror or error}") from error
        return failed(f"{job.folder}: {word('system', job.making.language, text=error.strerror or error)}")
    return outcome
