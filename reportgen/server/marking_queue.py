"""Processes that compute for the pages: sheets and checks at once, uploads and marks in their turn.

The queue has its length for all to see. What is queued is a row of the database: after a crash it is queued again.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import multiprocessing.connection
import os
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from typing import Any, Protocol, TypeVar

from reportgen.base.units import Language
from reportgen.server import work_calls

Result = TypeVar("Result")
PREPARING = "preparing"
"""Kind of work that nobody waits for: it is done where uploads are read, and is not counted."""
NICENESS = 5
"""How much these processes stand back behind that of the pages."""


class Queue(Protocol):
    """Where the work of the pages is done."""

    waiting: int
    """Number of calls that wait or run."""

    async def run(self, function: Callable[..., Any], *arguments: Any, kind: str = "short") -> Any: ...

    def warm(self) -> None:
        """Start what serves requests that somebody waits for."""

    def close(self) -> None:
        """End the processes without waiting for their work, which is queued again at the next start."""


def begin(language: Language) -> None:
    """Prepare a process: it loads what it computes with before the first request."""
    threading.Thread(target=_end_with_server, daemon=True).start()
    if hasattr(os, "nice"):
        # Saving a cell goes before every calculation.
        os.nice(NICENESS)
    from reportgen.base.words import speak
    from reportgen.server import work

    speak(language)
    assert work


def _end_with_server() -> None:
    """End this process when the server is gone, even if that was killed."""
    server = multiprocessing.parent_process()
    if server is not None:
        multiprocessing.connection.wait([server.sentinel])
        os._exit(0)


class MarkingQueue:
    """Processes for short and for long work, each with its own queue, so that a check does not wait for a marking."""

    def __init__(self, language: Language, workers: int | None = None) -> None:
        self._language = language
        self._workers = workers or max(os.cpu_count() or 1, 1)
        self._pools: dict[str, ProcessPoolExecutor] = {}
        self._closed = False
        self.waiting = 0

    def warm(self) -> None:
        for _ in range(self._workers):
            self._pool("short").submit(_nothing)
        self._pool("reading").submit(work_calls.begin_reading)

    def _pool(self, kind: str) -> ProcessPoolExecutor:
        if kind not in self._pools:
            workers = self._workers if kind == "short" else 1
            # Not forked from this process, which has threads and locks.
            context = multiprocessing.get_context("spawn")
            self._pools[kind] = ProcessPoolExecutor(workers, context, begin, (self._language,))
        return self._pools[kind]

    async def run(self, function: Callable[..., Result], *arguments: Any, kind: str = "short") -> Result:
        """Return the result of a function in another process; a process that dies is replaced, and its call repeated
        once."""
        counted = kind != PREPARING
        kind = kind if counted else "reading"
        self.waiting += counted
        try:
            for last in (False, True):
                pool = self._pool(kind)
                try:
                    return await asyncio.wrap_future(pool.submit(partial(function, *arguments)))
                except BrokenProcessPool:
                    if self._closed:
                        # The process was ended with the server.
                        raise asyncio.CancelledError from None
                    if self._pools.get(kind) is pool:
                        del self._pools[kind]
                    if last:
                        raise
            raise AssertionError("the last round returns or raises")
        finally:
            self.waiting -= counted

    def close(self) -> None:
        self._closed = True
        for pool in self._pools.values():
            processes = list((pool._processes or {}).values())
            pool.shutdown(wait=False, cancel_futures=True)
            for process in processes:
                process.terminate()


def _nothing() -> None:
    """Have a process start."""
