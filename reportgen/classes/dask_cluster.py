"""The jobs of a batch on an existing Dask scheduler; the only module that knows Dask."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import Any

from reportgen.base.errors import ReportgenError
from reportgen.base.units import Language
from reportgen.base.words import unexpected, word
from reportgen.classes.worker_pool import SYSTEM, Job, Outcome, Pool, Results, Retried, failed, run_job

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
