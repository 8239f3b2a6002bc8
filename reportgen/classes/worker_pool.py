"""Jobs and the local processes that run them; a process that dies harms no job but its own.

A job is one product of one student. It has everything that determines its result, including the bytes of the assignment
file. So it can run in this process, in another, or on another machine, and its result need not be made twice. Each job
has its own process, started by pebble: its outcome arrives on its own pipe, and all its memory is freed at its end.
Submitted files are also read in processes, each call within limits of time and memory.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import tempfile
import threading
import time
import warnings
from collections import deque
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from dataclasses import field
from itertools import islice
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
from reportgen.base.records import record
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.base.words import speak, spoken, templates_hash, unexpected, word
from reportgen.classes import cleanup

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext


SYSTEM = 3
"""Exit code of a failure that no change of the assignment can fix."""


@record
class Making:
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


@record
class Job:
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


@record
class Outcome:
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

    It runs in its own folder, whose name is removed from messages of failures.
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
"""Number of attempts: a job whose process died is tried again once, then it has failed."""
LIMIT = 900.0
"""Seconds after which a job counts as hung and its process is killed."""
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
    start: Callable[[Job], Future[Outcome]] = process(
        name=NAME, timeout=LIMIT, context=_context((READY,) if samples else (*LOADED, READY), samples, out)
    )(_work)

    def pool(jobs: Iterable[Job], retried: Retried) -> Results:
        waiting = deque((job, 1) for job in jobs)
        running: dict[Future[Outcome], tuple[Job, int]] = {}

        def fill() -> None:
            while waiting and len(running) < workers:
                job, tries = waiting.popleft()
                with _uninterrupted():
                    running[start(job)] = job, tries

        try:
            fill()
            while running:
                results: list[tuple[Job, Outcome]] = []
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    job, tries = running.pop(future)
                    if future.exception() is None:
                        results.append((job, future.result()))
                    elif tries < TRIES:
                        waiting.appendleft((job, tries + 1))
                        retried(job)
                    else:
                        results.append((job, failed(word("worker_died", job.making.language))))
                # Start the next ones before results are written.
                fill()
                yield from results
        finally:
            _dismiss(running)

    return pool


def _dismiss(running: Iterable[Future[Outcome]]) -> None:
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


def _work(job: Job) -> Outcome:
    """Return the outcome, in a process that ends after it."""
    # Exit through every `finally`, so that no scratch folder and no typesetter is left behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    # There is already a process for each core.
    os.environ["RAYON_NUM_THREADS"] = "1"
    warnings.simplefilter("always", OutputWarning)
    warnings.showwarning = lambda message, *_: print(f"reportgen: {job.folder}: {message}", file=sys.stderr, flush=True)
    outcome = run_job(job)
    # There is nothing left to clean up.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    parent = parent_process()
    if parent is not None and not parent.is_alive():
        # The parent is gone, so the result could not be sent.
        os._exit(0)
    return outcome


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


# --- the same jobs on an existing Dask scheduler --------------------------------------------------
# The only module that knows Dask.

AHEAD_OF_EACH = 2
"""Number of jobs submitted for each of the cluster's threads, so that none waits for the next one."""
ANSWER = 10
"""Seconds within which a scheduler must answer."""
BEAT = 0.05
"""Seconds between two polls of the futures."""
WORKERLESS = 60
"""Seconds without any worker after which waiting is given up."""

_one_at_a_time = threading.Lock()


class ClusterError(ReportgenError):
    """The scheduler cannot be used: Dask is not installed, it does not answer, or it has gone; exit code 3."""

    exit_code = SYSTEM


class WorkersLostError(Exception):
    """No worker was present for `WORKERLESS` seconds."""


def cluster(address: str, language: Language | None) -> Pool:
    """Return a pool of the workers of a Dask scheduler; raise `ClusterError` without Dask.

    Jobs and files are sent as bytes: workers need this package in the same version, but no access to local files. A
    worker may die; the scheduler gives its jobs to another one, at most `distributed.scheduler.allowed-failures` times.
    Jobs of workers that all died are tried again one at a time at the end, because they may only have been queued
    behind the one that killed them.
    """
    try:
        import distributed
    except ImportError as error:
        raise ClusterError(word("no_dask", language)) from error

    def pool(jobs: Iterable[Job], retried: Retried) -> Results:
        try:
            client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
        except (OSError, ValueError) as error:
            raise ClusterError(word("no_scheduler", language, address=address)) from error
        with client:
            try:
                suspects: list[Job] = []
                yield from _results(client, iter(jobs), suspects.append)
                for job in suspects:
                    retried(job)
                    (future,) = _first_done(client, [client.submit(_run, job, pure=False)])
                    outcome = _received(job, future)
                    yield job, outcome or failed(word("worker_died", job.making.language))
            except WorkersLostError as error:
                raise ClusterError(word("workers_lost", language, address=address)) from error
            except (distributed.client.FutureCancelledError, OSError) as error:
                raise ClusterError(word("scheduler_lost", language, address=address)) from error

    return pool


def _results(client: Any, jobs: Iterator[Job], suspect: Callable[[Job], None]) -> Results:
    """Yield results as they arrive; few jobs are submitted at a time, so that results never pile up on workers."""
    handed_out: dict[Any, Job] = {}

    def hand_out() -> None:
        room = AHEAD_OF_EACH * max(_threads(client), 1) - len(handed_out)
        handed_out.update({client.submit(_run, job, pure=False): job for job in islice(jobs, max(room, 0))})

    hand_out()
    while handed_out:
        for future in _first_done(client, list(handed_out)):
            job = handed_out.pop(future)
            outcome = _received(job, future)
            hand_out()
            if outcome is None:
                suspect(job)
            else:
                yield job, outcome


def _first_done(client: Any, futures: Sequence[Any]) -> set[Any]:
    """Return the futures that are done, at least one.

    Raises `WorkersLostError` if there has been no worker for `WORKERLESS` seconds; dead workers may come back before
    that.
    """
    seen = time.monotonic()
    while True:
        done = {future for future in futures if future.done()}
        if done:
            return done
        time.sleep(BEAT)
        if _threads(client):
            seen = time.monotonic()
        elif time.monotonic() - seen > WORKERLESS:
            raise WorkersLostError


def _received(job: Job, future: Any) -> Outcome | None:
    """Return the outcome of a job, which the cluster may then forget; None if its workers died.

    Raises `OSError` or `FutureCancelledError` if the scheduler has gone.
    """
    from distributed import KilledWorker
    from distributed.client import FutureCancelledError

    try:
        outcome: Outcome = future.result()
    except KilledWorker:
        return None
    except (FutureCancelledError, OSError):
        raise
    except Exception as error:
        # A job raises nothing itself: the worker could not even receive it, for example with another version.
        return failed(unexpected(error, job.making.language))
    finally:
        future.release()
    return outcome


def _threads(client: Any) -> int:
    """Return the number of threads of all current workers; workers may come and go."""
    return sum(worker["nthreads"] for worker in client.scheduler_info(n_workers=-1)["workers"].values())


def _run(job: Job) -> Outcome:
    """Run a job on a worker; a process has one scratch folder, so it runs one job at a time."""
    with _one_at_a_time:
        return run_job(job)
