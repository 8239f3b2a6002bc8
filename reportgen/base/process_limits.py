"""Run a function in a subprocess with limits on time, memory and the size of its result.

Use it for work that executes code or templates of others. The process is a fresh interpreter and can be started
from anywhere: a job, a worker of a cluster, beside threads.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from threading import Thread, Timer
from typing import Any, TypeVar

from reportgen.base.errors import OutputWarning
from reportgen.base.records import Record

Argument = TypeVar("Argument")
Result = TypeVar("Result")

PATIENCE = 3
"""Largest ratio of elapsed time to processor time, since the machine may do other work."""
GRACE = 2
"""Seconds of processor time between the time limit and the end of the process."""
LARGEST_ANSWER = 30_000_000
"""Largest size of the result (bytes)."""
ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Settings that limit libraries to one thread, since threads share the limit of processor time and do not survive a
fork.
"""
_BEGIN = "import sys; sys.path[:] = sys.argv[1:]; from reportgen.base.process_limits import serve; serve()"


class Limits(Record):
    """Limits of one call: seconds, and megabytes beyond those that its process starts with."""

    seconds: float
    megabytes: int


TEMPLATES = Limits(seconds=10, megabytes=500)
"""Limits for making a document with a school's templates."""


M_TRIM_THRESHOLD, KEPT_FREE = -1, 128 * 1024
"""An option of glibc's `mallopt`, and the bytes of freed memory that it then keeps."""


@cache
def give_memory_back() -> None:
    """Make glibc return freed memory to the system, which it does less and less by default."""
    import ctypes

    # Other libraries of C have no such option, and some systems no library that can be asked.
    with suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).mallopt(M_TRIM_THRESHOLD, KEPT_FREE)


class LimitError(Exception):
    """A call exceeded its time or memory, or its process died."""


_bounded = False
"""True in a process that serves a limited call."""


def call_within(limits: Limits, function: Callable[[Argument], Result], argument: Argument) -> Result:
    """Return the result of `function`, a function of a module, for an argument that can be pickled.

    Seconds are processor time. All processes that the call starts belong to its process group and end with it. A
    call within a call runs in the same process, under the limits of the outer one. Raises the exceptions of the
    call and `LimitError`; repeats the call's output warnings.
    """
    if _bounded:
        return function(argument)
    # Isolated: neither the folder that it runs in nor the environment says which modules are loaded.
    command = [sys.executable, "-I", "-W", "ignore", "-c", _BEGIN, *sys.path]
    request = pickle.dumps((limits, function, argument))
    with _group(command) as process:
        late = Timer(PATIENCE * limits.seconds, _end, (process,))
        late.daemon = True
        late.start()
        try:
            assert process.stdin
            assert process.stdout
            # Its standard input stays open: when it closes, the process knows that the caller no longer waits.
            with suppress(BrokenPipeError):
                process.stdin.write(request)
                process.stdin.flush()
            data = process.stdout.read()
            _await(process)
        finally:
            late.cancel()
    if process.returncode:
        raise LimitError
    answer, fault, warned = pickle.loads(data)
    for warning in warned:
        warnings.warn(warning, stacklevel=2)
    if fault is not None:
        raise fault
    result: Result = answer
    return result


@contextmanager
def _group(command: Sequence[str]) -> Iterator[subprocess.Popen[bytes]]:
    """Start a process with a process group, and end the whole group at the end of the block."""
    process = subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | ONE_THREAD,
        start_new_session=True,
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
    )
    try:
        yield process
    finally:
        _end(process)
        with suppress(BrokenPipeError):
            process.communicate()


def _await(process: subprocess.Popen[bytes]) -> None:
    """Wait for the end of a process; if possible without releasing its number, by which its group is ended."""
    if hasattr(os, "waitid"):
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    else:
        process.wait()


def _end(process: subprocess.Popen[bytes]) -> None:
    """Kill a process and its group."""
    if process.returncode is None:
        _end_group(process.pid)


def _end_group(number: int) -> None:
    if os.name == "nt":
        every = ("taskkill", "/F", "/T", "/PID", str(number))
        subprocess.run(every, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        return
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(number, signal.SIGKILL)


def is_bounded() -> bool:
    """Return True in a subprocess that runs a call with limits."""
    return _bounded


def serve() -> None:
    """Run one `call_within` in the subprocess: read the call from standard input, write its result to standard
    output.
    """
    global _bounded
    _bounded = True
    answer: Any = None
    fault: Exception | None = None
    stream = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output that a library prints must not become part of the answer
    limits, function, argument = pickle.load(sys.stdin.buffer)
    Thread(target=_end_alone, daemon=True).start()
    limit_memory(limits.megabytes)
    _limit_time(limits.seconds)
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always", OutputWarning)
        try:
            answer = function(argument)
        except MemoryError:
            fault = LimitError()
        except Exception as error:
            fault = error
    data = pickle.dumps((answer, fault, [one.message for one in warned]))
    if len(data) > LARGEST_ANSWER:
        data = pickle.dumps((None, LimitError(), []))
    with stream:
        stream.write(data)


def _end_alone() -> None:
    """Kill this process and its group after the calling process has ended, since nobody waits for the result."""
    with suppress(OSError):
        while os.read(0, 1):
            pass
    if os.name == "nt" or os.getpgid(0) == os.getpid():
        _end_group(os.getpid())


def limit_memory(megabytes: int) -> None:
    """Limit this process to `megabytes` more memory than it has; without system support only time is limited."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        taken = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        _, most = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (taken + megabytes * 1_000_000, most))


def _limit_time(seconds: float) -> None:
    """Raise `LimitError` after this much more processor time (s), and kill this process if that has no effect."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        used = resource.getrusage(resource.RUSAGE_SELF)
        most = int(used.ru_utime + used.ru_stime + seconds) + 1
        signal.signal(signal.SIGXCPU, _time_is_up)
        resource.setrlimit(resource.RLIMIT_CPU, (most, most + GRACE))


def _time_is_up(*_: object) -> None:
    signal.signal(signal.SIGXCPU, signal.SIG_IGN)
    raise LimitError
