"""Where the time of a command goes, step by step: `python -m tests.bench.steps COMMAND ARGUMENTS…`.

A step is a function of the program, timed without the steps within it.  Prints JSON, in milliseconds, of one run in
this cold process.
"""

from __future__ import annotations

import builtins
import json
import os
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout
from functools import wraps
from importlib import import_module
from statistics import median
from time import perf_counter
from typing import Any

REST = "all else"
LOADED = "loading libraries and modules"
STEPS = {
    "reportgen.catalogue.read_source": "reading the file",
    "reportgen.catalogue.assess": "checking its data",
    "reportgen.machine.analysis.solve_motion": "motion",
    "reportgen.machine.analysis.solve_forces": "forces",
    "reportgen.machine.analysis.virtual_work_torque": "torque by virtual work",
    "reportgen.machine.analysis.summarise": "figures of the cycle",
    "reportgen.derivation.write_ledger": "numbers and their lines",
    "reportgen.case.printed": "values as written down",
    "reportgen.marking.toleranced_key.drawn_bands": "tolerance bands",
    "reportgen.marking.toleranced_key.computed_bands": "tolerance bands",
    "reportgen.report.composing.compose": "text and figures",
    "reportgen.drawing.labels.place": "places of labels",
    "reportgen.writers.typst.write": "source",
    "reportgen.writers.typst_compiler.compile": "typesetting",
    "reportgen.writers.latex.write": "source",
    "reportgen.writers.pdflatex.compile": "typesetting",
}
"""Functions by where they are called from, and the steps that they are."""


class Clock:
    """Time (s) by steps; a step within another is not counted twice."""

    def __init__(self) -> None:
        self.taken: dict[str, float] = defaultdict(float)
        self._running = [REST]
        self._since = perf_counter()

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        """What runs meanwhile counts for this step."""
        self._turn()
        self._running.append(name)
        try:
            yield
        finally:
            self._turn()
            self._running.pop()

    def timed(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function as a step."""

        @wraps(function)
        def run(*arguments: Any, **options: Any) -> Any:
            with self.step(name):
                return function(*arguments, **options)

        return run

    def stop(self) -> Mapping[str, float]:
        """The steps in the order in which they ended first."""
        self._turn()
        return dict(self.taken)

    def _turn(self) -> None:
        now = perf_counter()
        self.taken[self._running[-1]] += now - self._since
        self._since = now


def steps(arguments: Sequence[str]) -> dict[str, float]:
    """Milliseconds by steps of one command of `reportgen`, run in this process.

    Raises `AttributeError` for a function that is no longer where `STEPS` says.
    """
    clock = Clock()
    with clock.step(LOADED):
        main = import_module("reportgen.cli").main
    # A command loads what it needs and no more, so functions are timed as their modules come.
    load, pending = builtins.__import__, dict(STEPS)

    def loaded(*named: Any, **options: Any) -> Any:
        with clock.step(LOADED):
            module = load(*named, **options)
        for path in list(pending):
            home, _, function = path.rpartition(".")
            found = sys.modules.get(home)
            if found is not None and not getattr(found.__spec__, "_initializing", False):
                setattr(found, function, clock.timed(pending.pop(path), getattr(found, function)))
        return module

    builtins.__import__ = loaded
    asked, sys.argv = sys.argv, ["reportgen", *arguments]
    try:
        with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere):
            main()
    except SystemExit as end:
        if end.code:
            raise RuntimeError(f"reportgen {' '.join(arguments)} ended with {end.code}") from end
    finally:
        builtins.__import__, sys.argv = load, asked
    return {name: 1e3 * seconds for name, seconds in clock.stop().items()}


def middle(runs: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Medians by steps of several runs of one command, the longest first."""
    medians = {name: median(run.get(name, 0.0) for run in runs) for name in runs[0]}
    return dict(sorted(medians.items(), key=lambda step: -step[1]))


def told(command: str, taken: Mapping[str, float]) -> str:
    """A command with its steps in a line, those below a fiftieth of the whole together."""
    whole = sum(taken.values())
    large = {name: time for name, time in taken.items() if name != REST and time >= whole / 50}
    shown = {**large, REST: whole - sum(large.values())}
    return f"{command}: " + ", ".join(f"{name} {time:.0f} ms ({time / whole:.0%})" for name, time in shown.items())


if __name__ == "__main__":
    json.dump(steps(sys.argv[1:]), sys.stdout)
