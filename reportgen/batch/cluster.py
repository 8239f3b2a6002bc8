"""The same jobs on an existing Dask scheduler; the only module that knows Dask."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import Any

from reportgen.assignment.messages import word
from reportgen.batch.jobs import SYSTEM, Job, Outcome, run_job
from reportgen.batch.pool import Pool, Results, Retried
from reportgen.errors import ReportgenError
from reportgen.notation.numbers import Language

AHEAD = 2
"""Jobs that are handed out for each of the cluster's threads, so that none waits for the next one."""
ANSWER = 10
"""Seconds in which a scheduler answers."""

_one_at_a_time = threading.Lock()


class ClusterError(ReportgenError):
    """The scheduler cannot be used: Dask is not installed, nobody answers, or it has gone; exit code 3."""

    exit_code = SYSTEM


def cluster(address: str, language: Language) -> Pool:
    """A pool of the workers that a Dask scheduler has; raises `ClusterError` without Dask.

    Jobs go out as bytes and files come back as bytes: workers need this package in the same version, but
    no file of ours.  A worker may die; the scheduler gives its jobs to another one, at most
    `distributed.scheduler.allowed-failures` times.
    """
    try:
        import distributed
    except ImportError as error:
        raise ClusterError(word("no_dask", language)) from error

    def pool(jobs: Iterable[Job], _retried: Retried) -> Results:
        try:
            client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
        except (OSError, ValueError) as error:
            raise ClusterError(word("no_scheduler", language).format(address=address)) from error
        with client:
            yield from _results(client, iter(jobs), lost=lambda: _lost(address, language))

    return pool


def _results(client: Any, jobs: Iterator[Job], lost: Callable[[], ClusterError]) -> Results:
    """As they come; only so many are handed out that results never pile up on the workers."""
    from distributed import KilledWorker, as_completed
    from distributed.client import FutureCancelledError

    handed_out: dict[Any, Job] = {}

    def hand_out() -> list[Any]:
        room = AHEAD * max(_threads(client), 1) - len(handed_out)
        new = {client.submit(_run, job, pure=False): job for job in islice(jobs, max(room, 0))}
        handed_out.update(new)
        return list(new)

    running = as_completed(hand_out(), loop=client.loop)
    for future in running:
        job = handed_out.pop(future)
        try:
            outcome = future.result()
        except KilledWorker:
            text = word("worker_died", job.making.language or "vi")
            outcome = Outcome(problems=(text,), exit_code=SYSTEM)
        except (FutureCancelledError, OSError) as error:
            raise lost() from error
        future.release()
        running.update(hand_out())
        yield job, outcome


def _threads(client: Any) -> int:
    """Of all workers there are now; they may come and go."""
    return sum(worker["nthreads"] for worker in client.scheduler_info(n_workers=-1)["workers"].values())


def _lost(address: str, language: Language) -> ClusterError:
    return ClusterError(word("scheduler_lost", language).format(address=address))


def _run(job: Job) -> Outcome:
    """The outcome, on a worker; matplotlib is not made for threads, so a process does one job at a time."""
    with _one_at_a_time:
        return run_job(job)
