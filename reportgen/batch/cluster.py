"""The same jobs on an existing Dask scheduler; the only module that knows Dask."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import Any

from reportgen.batch.pool import SYSTEM, Job, Outcome, Pool, Results, Retried, failed, run_job
from reportgen.errors import ReportgenError
from reportgen.notation.numbers import Language
from reportgen.words import unexpected, word

AHEAD_OF_EACH = 2
"""Jobs that are handed out for each of the cluster's threads, so that none waits for the next one."""
ANSWER = 10
"""Seconds in which a scheduler answers."""
BEAT = 0.05
"""Seconds between two looks at what is done."""
WORKERLESS = 60
"""Seconds without any worker after which nobody waits for one."""

_one_at_a_time = threading.Lock()


class ClusterError(ReportgenError):
    """The scheduler cannot be used: Dask is not installed, nobody answers, or it has gone; exit code 3."""

    exit_code = SYSTEM


class WorkersLostError(Exception):
    """No worker has been left for a while."""


def cluster(address: str, language: Language | None) -> Pool:
    """A pool of the workers that a Dask scheduler has; raises `ClusterError` without Dask.

    Jobs go out as bytes and files come back as bytes: workers need this package in the same version, but
    no file of ours.  A worker may die; the scheduler gives its jobs to another one, at most
    `distributed.scheduler.allowed-failures` times.  What had been given to all of those that died is tried
    again by itself at the end, for it may only have stood in line behind the one that killed them.
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
                    outcome = _told(job, future)
                    yield job, outcome or failed(word("worker_died", job.making.language))
            except WorkersLostError as error:
                raise ClusterError(word("workers_lost", language, address=address)) from error
            except (distributed.client.FutureCancelledError, OSError) as error:
                raise ClusterError(word("scheduler_lost", language, address=address)) from error

    return pool


def _results(client: Any, jobs: Iterator[Job], suspect: Callable[[Job], None]) -> Results:
    """Results as they come; only so many jobs are handed out that results never pile up on the workers."""
    handed_out: dict[Any, Job] = {}

    def hand_out() -> None:
        room = AHEAD_OF_EACH * max(_threads(client), 1) - len(handed_out)
        handed_out.update({client.submit(_run, job, pure=False): job for job in islice(jobs, max(room, 0))})

    hand_out()
    while handed_out:
        for future in _first_done(client, list(handed_out)):
            job = handed_out.pop(future)
            outcome = _told(job, future)
            hand_out()
            if outcome is None:
                suspect(job)
            else:
                yield job, outcome


def _first_done(client: Any, futures: Sequence[Any]) -> set[Any]:
    """Those of the futures that are done, one at least.

    Raises `WorkersLostError` when there has been no worker for `WORKERLESS` seconds: dead ones may come back, but
    nobody waits for ever.
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


def _told(job: Job, future: Any) -> Outcome | None:
    """The outcome of a job, which the cluster may then forget; None if its workers died.

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
        # A job raises nothing itself: the worker could not even receive it, as where it has another version.
        return failed(unexpected(error, job.making.language))
    finally:
        future.release()
    return outcome


def _threads(client: Any) -> int:
    """The threads of all workers there are now; workers may come and go."""
    return sum(worker["nthreads"] for worker in client.scheduler_info(n_workers=-1)["workers"].values())


def _run(job: Job) -> Outcome:
    """The outcome, on a worker; matplotlib is not made for threads, so a process does one job at a time."""
    with _one_at_a_time:
        return run_job(job)
