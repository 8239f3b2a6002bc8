"""Jobs and the local processes that run them; a process that dies harms no job but the one that killed it.

A job is one product of one student. It has everything that determines its result, including the bytes of the assignment
file. So it can run in this process, in another, or on another machine, and its result need not be made twice. pebble
starts the processes. Each runs a few jobs, returns their outcomes through a pipe of its own and ends, which frees all
its memory. If it dies, each of its jobs runs again in a separate process. Submitted files are also read in processes,
with limits of time and memory for each call.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import tempfile
import warnings
from collections import deque
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from multiprocessing.process import BaseProcess, parent_process
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pebble import ProcessExpired, ProcessPool, concurrent

from reportgen.api import Maker
from reportgen.api.report_fonts import Engine
from reportgen.base.errors import AssignmentError, OutputWarning, Problem, ReportgenError
from reportgen.base.files import version
from reportgen.base.process_limits import ONE_THREAD, Limits, limit_memory
from reportgen.base.provenance import assignment_hash
from reportgen.base.records import Record, field
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.base.words import speak, spoken, templates_hash, unexpected, word
from reportgen.classes import cleanup

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext


SYSTEM = 3
"""Exit code of a failure that no change of the assignment can fix."""


class Making(Record):
    """The inputs of a result besides the assignment.

    `version` is that of this package, `templates` a SHA-256 of all words and frames. `language` is None to use each
    file's own. `ask` is the answer sheet's selection if a policy gives one, `standards` those of the PDF if they are
    not the default.
    """

    version: str
    templates: str
    engine: Engine
    language: Language | None
    ask: str = ""
    standards: str = ""


class Job(Record):
    """One product of one student: `content` is the assignment file, `file` its name, `folder` that of the results."""

    student: str
    folder: str
    product: str
    maker: Maker
    file: str
    content: bytes
    making: Making
    beside: Mapping[str, bytes] = field(default_factory=dict)
    """A school's words and the files of the parts, by their paths relative to the assignment file."""
    scratch: Path | None = None
    """Folder for temporary files; None for the system's, on other machines."""

    @property
    def assignment(self) -> str:
        """SHA-256 of the assignment file and the files beside it."""
        return assignment_hash(self.content, self.beside)


class Outcome(Record):
    """The files of a product by name; or, with an exit code other than 0, the problems that prevented them.

    Locations of `problems` name the assignment file without its folder.
    """

    files: Mapping[str, bytes] = field(default_factory=dict)
    problems: tuple[Problem | str, ...] = ()
    exit_code: int = 0


def making(engine: Engine, language: Language | None, ask: str = "", standards: str = "") -> Making:
    """Return the inputs with which this installation would make a product now."""
    return Making(version(), templates_hash(), engine, language, ask, standards)


def failed(problem: str) -> Outcome:
    """Return the outcome of a job that failed for a reason outside the assignment."""
    return Outcome(problems=(problem,), exit_code=SYSTEM)


def run_job(job: Job) -> Outcome:
    """Run a job and return its outcome; any failure becomes an outcome too.

    It runs in its own folder, whose name is removed from messages of failures. Raises `MemoryError`, since there may be
    enough memory in a process without earlier jobs.
    """
    engine, language = job.making.engine, job.making.language
    scratch, before = "", tempfile.tempdir

    def without_paths(text: str) -> str:
        return text.replace(f"{scratch}{os.sep}", "").replace(str(templates()), "templates")

    try:
        if making(engine, language, job.making.ask, job.making.standards) != job.making:
            return failed(word("other_templates", language))
        with tempfile.TemporaryDirectory(prefix="reportgen-", dir=job.scratch) as scratch:
            tempfile.tempdir = scratch
            file = Path(scratch, job.file)
            for name, content in {**job.beside, job.file: job.content}.items():
                Path(scratch, name).parent.mkdir(parents=True, exist_ok=True)
                Path(scratch, name).write_bytes(content)
            return Outcome(files=dict(job.maker(file, engine, language)))
    except AssignmentError as error:
        # Its folder is gone, so a location names the file as the job does.
        own = {str(Path(scratch, name)): name for name in job.beside}
        problems = tuple(problem.in_file(own.get(problem.location.file, job.file)) for problem in error.problems)
        return Outcome(problems=problems, exit_code=error.exit_code)
    except ReportgenError as error:
        return Outcome(problems=(without_paths(str(error)),), exit_code=error.exit_code)
    except OSError as error:
        return failed(word("system", language, text=error.strerror or error))
    except MemoryError:
        raise
    except Exception as error:
        # A bug of the program must not cost the others their results.
        return failed(without_paths(unexpected(error, language)))
    finally:
        tempfile.tempdir = before


Retried = Callable[[Job], None]
Results = Generator[tuple[Job, Outcome], None, None]
Pool = Callable[[Iterable[Job], Retried], Results]
"""Yields jobs with their outcomes as they end; calls the function for each job that has to start again."""

TRIES = 2
"""Number of attempts: a job that died alone in its process is tried again once, then it has failed."""
TOGETHER = 3
"""Largest number of jobs of a process: starting one takes a tenth of a report, and the typesetter frees no memory."""
LIMIT = 900.0
"""Seconds after which a process counts as hung and is killed."""
PATIENCE = 10.0
"""Seconds that a terminated process has to clean up."""
NAME = "reportgen-job"
"""Name of the job processes, which distinguishes them from others."""


def local(workers: int, samples: Collection[str] = (), out: Path | None = None) -> Pool:
    """Return a pool of at most `workers` processes; the server that starts them begins to load immediately.

    It prepares `samples`, each as `kind:language:engine:product`, for all of them, and cleans up in `out` if this
    process is killed.
    """
    # It accepts `context` but is annotated with another name.
    process: Any = concurrent.process
    start: Callable[[Sequence[Job]], Future[list[Outcome]]] = process(
        name=NAME, timeout=LIMIT, context=_context((READY,) if samples else (*LOADED, READY), samples, out)
    )(_work)

    def pool(jobs: Iterable[Job], retried: Retried) -> Results:
        waiting = deque(jobs)
        alone: deque[tuple[Job, int]] = deque()
        running: dict[Future[list[Outcome]], tuple[Sequence[Job], int]] = {}

        def following() -> tuple[Sequence[Job], int]:
            """Return the next jobs of a process, fewer towards the end, so that no worker is idle for long; and the
            number of attempts.
            """
            if alone:
                job, tries = alone.popleft()
                return (job,), tries
            few = max(1, min(TOGETHER, len(waiting) // (2 * workers)))
            return [waiting.popleft() for _ in range(few)], 1

        def fill() -> None:
            while (alone or waiting) and len(running) < workers:
                together, tries = following()
                with _uninterrupted():
                    running[start(together)] = together, tries

        try:
            fill()
            while running:
                results: list[tuple[Job, Outcome]] = []
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    together, tries = running.pop(future)
                    if future.exception() is None:
                        results += zip(together, future.result(), strict=True)
                    elif len(together) > 1:
                        # Which of them killed the process is not known.
                        alone.extend((job, 1) for job in together)
                    elif tries < TRIES:
                        alone.append((together[0], tries + 1))
                        retried(together[0])
                    else:
                        died = failed(word("worker_died", together[0].making.language))
                        results.append((together[0], died))
                # Start the next ones before results are written.
                fill()
                yield from results
        finally:
            _dismiss(running)

    return pool


def _dismiss(running: Iterable[Future[list[Outcome]]]) -> None:
    """End all processes; return when none is left."""
    # A future that is cancelled while its result arrives would make its thread print a traceback.
    for end, seconds in ((BaseProcess.terminate, PATIENCE), (BaseProcess.kill, None)):
        for process in multiprocessing.active_children():
            if process.name == NAME:
                end(process)
        wait(running, seconds)


LOADED = (
    "reportgen.classes.worker_pool",
    "reportgen.catalogue.driven_machine",
    "reportgen.catalogue.crank_sliders",
    "reportgen.machine.analysis",
    "reportgen.derivation",
    "reportgen.report.composing",
    "reportgen.drawing.charts",
    "reportgen.writers.typst",
    "jinja2",
    "markdown_it",
    "numpy.polynomial",
    "typst",
)
"""Modules that the fork server imports for a few jobs, so that each worker starts with them loaded."""
READY = "reportgen.classes.preload"
"""Imported last there; it prepares the products that `SAMPLES` names in the environment, with all that they need."""
SAMPLES = "REPORTGEN_SAMPLES"


def _context(
    loaded: Sequence[str] = LOADED, samples: Iterable[str] = (), out: Path | None = None
) -> ForkServerContext | SpawnContext:
    """Return a context in which new processes come from a preloaded server, if the system allows it."""
    folder = cleanup.sockets() if "forkserver" in multiprocessing.get_all_start_methods() else None
    if folder is None:
        return multiprocessing.get_context("spawn")
    from multiprocessing import forkserver, resource_tracker

    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([cleanup.__name__, *loaded])
    # Once started, it restores Ctrl-C; the server would otherwise start it first.
    resource_tracker.ensure_running()
    surroundings = {**ONE_THREAD, SAMPLES: " ".join(sorted(samples)), **cleanup.environment(folder, out)}
    before = {name: os.environ.get(name) for name in surroundings}
    os.environ |= surroundings
    try:
        with _uninterrupted():
            forkserver.ensure_running()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
    return context


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Block Ctrl-C in processes started inside, because a terminal sends it to all; the parent ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(jobs: Sequence[Job]) -> list[Outcome]:
    """Return the outcomes of some jobs, in a process that ends after them."""
    # Exit through every `finally`, so that no scratch folder and no typesetter is left behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    # There is already a process for each core.
    os.environ["RAYON_NUM_THREADS"] = "1"
    warnings.simplefilter("always", OutputWarning)
    outcomes = [_told(job) for job in jobs]
    # There is nothing left to clean up.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    parent = parent_process()
    if parent is not None and not parent.is_alive():
        # The parent is gone, so the result could not be sent.
        os._exit(0)
    return outcomes


def _told(job: Job) -> Outcome:
    """Return the outcome of a job, whose warnings name its folder."""
    warnings.showwarning = lambda message, *_: print(f"reportgen: {job.folder}: {message}", file=sys.stderr, flush=True)
    return run_job(job)


# --- calls within limits --------------------------------------------------------------------------

AHEAD = 4
"""Number of waiting or running calls per process, so that none is idle while arguments arrive slowly."""
Argument = TypeVar("Argument")
Result = TypeVar("Result")


def each_within(
    limits: Limits, function: Callable[[Argument], Result], arguments: Iterable[Argument], preload: str
) -> Iterator[tuple[Argument, Result | None]]:
    """Yield each argument with the result of `function`, in order; None if the call exceeded its limits or died.

    A few calls run at a time, and arguments are consumed as needed. `preload` is the module of `function`.
    """
    workers = os.cpu_count() or 1
    running: deque[tuple[Argument, Future[Any]]] = deque()
    with _uninterrupted():
        # Some of its methods are annotated with other names, or not at all.
        make: Any = ProcessPool
        begun = limits.megabytes, spoken()
        pool = make(workers, initializer=_begin, initargs=begun, context=_context((preload,)))
    try:
        for argument in arguments:
            with _uninterrupted():
                running.append((argument, pool.schedule(function, (argument,), timeout=limits.seconds)))
            if len(running) > AHEAD * workers:
                yield _outcome(running.popleft())
        while running:
            yield _outcome(running.popleft())
    finally:
        pool.stop()
        pool.join()


def _begin(megabytes: int, language: Language) -> None:
    """Prepare a process: limit its memory, and set the language of the process that reads its results.

    The fork server may have been started in another language.
    """
    limit_memory(megabytes)
    speak(language)


def _outcome(call: tuple[Argument, Future[Any]]) -> tuple[Argument, Any]:
    argument, future = call
    fault = future.exception()
    if fault is not None and not isinstance(fault, (TimeoutError, MemoryError, ProcessExpired)):
        raise fault
    return argument, None if fault is not None else future.result()
