"""Cold processes, timed: wall time and peak memory of each, run in turns and compared round by round."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter

BYTES_PER_MAXRSS = 1 if sys.platform == "darwin" else 1024


@dataclass(frozen=True, slots=True)
class Cost:
    """Wall time (s) and peak memory (MB) of a process with all that it started."""

    seconds: float
    memory: float


def run(command: Sequence[str], folder: Path, environment: Mapping[str, str] | None = None) -> Cost:
    """Cost of one command in a process of its own; raises `RuntimeError` with its words if it fails."""
    log = folder / "bench.log"
    with log.open("wb") as words:
        begun = perf_counter()
        process = subprocess.Popen(
            command,
            cwd=folder,
            env={**os.environ, **(environment or {})},
            stdin=subprocess.DEVNULL,
            stdout=words,
            stderr=subprocess.STDOUT,
        )
        _, status, usage = os.wait4(process.pid, 0)
        seconds = perf_counter() - begun
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        last = log.read_text(encoding="utf-8", errors="replace").splitlines()[-12:]
        raise RuntimeError(f"{' '.join(command)[:200]} ended with {process.returncode}\n" + "\n".join(last))
    return Cost(seconds, usage.ru_maxrss * BYTES_PER_MAXRSS / 1e6)


def in_turns(tasks: Mapping[str, Callable[[], Cost]], rounds: int) -> dict[str, tuple[Cost, ...]]:
    """Costs of each task; one run of each a round, so that a slow minute strikes all alike."""
    taken: dict[str, list[Cost]] = {name: [] for name in tasks}
    for _ in range(rounds):
        for name, task in tasks.items():
            taken[name].append(task())
    return {name: tuple(costs) for name, costs in taken.items()}


def middle(costs: Sequence[Cost]) -> Cost:
    """Median time and median memory."""
    return Cost(median(cost.seconds for cost in costs), median(cost.memory for cost in costs))


def ratio(above: Sequence[Cost], below: Sequence[Cost]) -> float:
    """Median over the rounds of one task's time over the other's in the same round."""
    return median(one.seconds / other.seconds for one, other in zip(above, below, strict=True))


def repeated(task: Callable[[], Cost], times: int) -> Cost:
    """The cost of a task run several times, one after the other."""
    costs = [task() for _ in range(times)]
    return Cost(sum(cost.seconds for cost in costs), max(cost.memory for cost in costs))
