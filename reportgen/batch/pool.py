"""Jobs on the processes of this machine, which may die without taking more than their own job along."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from time import monotonic
from typing import TYPE_CHECKING

from reportgen.assignment.messages import word
from reportgen.batch.jobs import SYSTEM, Job, Outcome, run_job

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext

    _Context = ForkServerContext | SpawnContext

Retried = Callable[[Job], None]
Results = Generator[tuple[Job, Outcome], None, None]
Pool = Callable[[Iterable[Job], Retried], Results]
"""Yields jobs with their outcomes as they end; calls the function for each job that has to begin anew."""

MOST_JOBS = 8
"""A worker ends after so many jobs, because the typesetter keeps memory from one to the next."""
MOST_MEMORY = 600
"""A worker whose peak memory (MB) has passed this ends, too: one job more stays well under 1 GB."""
TRIES = 2
"""A job whose worker died is given to another one; after that it has failed."""
LIMIT = 900.0
"""Seconds after which a job counts as hung and its worker is killed."""
PATIENCE = 10.0
"""Seconds in which a worker that was told to end may tidy up."""


@dataclass(frozen=True, slots=True)
class _Task:
    job: Job
    tries: int = 0


@dataclass(slots=True)
class _Worker:
    process: BaseProcess
    connection: Connection
    task: _Task | None = None
    since: float = 0.0


def local(workers: int) -> Pool:
    """A pool of so many processes; what they come from gets ready at once, beside whatever is done first."""
    context = _context()

    def pool(jobs: Iterable[Job], retried: Retried) -> Results:
        crew = _Crew(context, workers, jobs, retried)
        try:
            yield from crew.results()
        finally:
            crew.dismiss()

    return pool


class _Crew:
    """Workers, the tasks that wait for one, and who has which."""

    def __init__(self, context: _Context, size: int, jobs: Iterable[Job], retried: Retried) -> None:
        self.size = size
        self.waiting = deque(_Task(job) for job in jobs)
        self.retried = retried
        self.workers: dict[Connection, _Worker] = {}
        self.leaving: list[BaseProcess] = []
        self.context = context

    def results(self) -> Results:
        self.give_work()
        while busy := [worker for worker in self.workers.values() if worker.task]:
            first = min(worker.since for worker in busy)
            for connection in wait(list(self.workers), max(0.0, first + LIMIT - monotonic())):
                assert isinstance(connection, Connection), "nothing else was waited for"
                ended = self.take(self.workers[connection])
                # The worker goes on while its result is written.
                self.give_work()
                if ended is not None:
                    yield ended
            for worker in busy:
                if worker.task and worker.since + LIMIT < monotonic():
                    worker.process.kill()

    def give_work(self) -> None:
        """Every waiting task to an idle worker, or to a new one while there may be more."""
        idle = deque(worker for worker in self.workers.values() if worker.task is None)
        while self.waiting and (idle or len(self.workers) < self.size):
            worker = idle.popleft() if idle else self.hire()
            worker.task, worker.since = self.waiting.popleft(), monotonic()
            # A worker that is dead already is noticed when its result is waited for.
            with suppress(OSError):
                worker.connection.send(worker.task.job)

    def hire(self) -> _Worker:
        ours, theirs = self.context.Pipe()
        process = self.context.Process(target=_serve, args=(theirs,), daemon=True)
        with _uninterrupted():
            process.start()
        theirs.close()
        worker = _Worker(process, ours)
        self.workers[ours] = worker
        return worker

    def take(self, worker: _Worker) -> tuple[Job, Outcome] | None:
        """What a worker has to say: a result, or by its end that it died."""
        task, worker.task = worker.task, None
        try:
            outcome, leaves = worker.connection.recv()
        except (EOFError, OSError):
            self.part_with(worker)
            return None if task is None else self.bereaved(task)
        if leaves:
            self.part_with(worker)
        assert task is not None, "a worker speaks only of the task it was given"
        return task.job, outcome

    def bereaved(self, task: _Task) -> tuple[Job, Outcome] | None:
        """The task of a dead worker: to be tried once more, or failed."""
        if task.tries + 1 < TRIES:
            self.waiting.appendleft(_Task(task.job, task.tries + 1))
            self.retried(task.job)
            return None
        text = word("worker_died", task.job.making.language or "vi")
        return task.job, Outcome(problems=(text,), exit_code=SYSTEM)

    def part_with(self, worker: _Worker) -> None:
        del self.workers[worker.connection]
        worker.connection.close()
        self.leaving.append(worker.process)

    def dismiss(self) -> None:
        """Ends all workers, busy or not."""
        for worker in tuple(self.workers.values()):
            if worker.task is not None:
                worker.process.terminate()
            self.part_with(worker)
        for process in self.leaving:
            process.join(PATIENCE)
            if process.exitcode is None:
                process.kill()
                process.join()


def _context() -> _Context:
    """New processes come from a server that has imported everything already, where the system allows it."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    from multiprocessing.forkserver import ensure_running

    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["reportgen.batch.warm"])
    with _uninterrupted():
        ensure_running()
    return context


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """What is started inside never sees Ctrl-C, which reaches all processes of a terminal: we tell them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(connection: Connection) -> None:
    """A worker: does the jobs it is sent until there are no more, nobody listens, or it has grown large."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Ends by way of every `finally`, so that no scratch folder and no typesetter is left behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    # There is a process for each core already.
    os.environ["RAYON_NUM_THREADS"] = "1"
    with suppress(EOFError, OSError):
        for count in itertools.count(1):
            outcome = run_job(connection.recv())
            leaves = count >= MOST_JOBS or peak_memory() > MOST_MEMORY
            connection.send((outcome, leaves))
            if leaves:
                return


def peak_memory() -> float:
    """Most memory (MB) that this process ever had; 0 where the system does not tell."""
    try:
        import resource
    except ImportError:
        return 0.0
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6
