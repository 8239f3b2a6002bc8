"""From the command's words to a batch: who is on the roster, what is made for them, and by whom."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from reportgen.api import Engine
from reportgen.assignment.messages import word
from reportgen.batch.jobs import making
from reportgen.batch.matching import Assigned, matched
from reportgen.batch.pool import Pool, local
from reportgen.batch.roster import Roster, read_roster
from reportgen.batch.run import Result, held, run, sweep
from reportgen.batch.variants import make_variants
from reportgen.errors import Problem
from reportgen.notation.numbers import Language
from reportgen.products import MAKERS, Maker

DRAWN = "assignments"
"""The folder, among the results, of the assignment files that are drawn."""


@dataclass(frozen=True, slots=True)
class Order:
    """What is asked for: assignments drawn of `spec` into `out`, or found in `assignments`; one of both.

    `jobs` processes of this machine (0: one for each core), unless a scheduler's address `cluster` is given.
    """

    roster: Path
    spec: Path | None = None
    assignments: Path | None = None
    out: Path = Path("out")
    products: tuple[str, ...] = tuple(MAKERS)
    engine: Engine = "typst"
    language: Language | None = None
    jobs: int = 0
    cluster: str | None = None


@dataclass(frozen=True, slots=True)
class Done:
    """The result with what is worth knowing besides, in words."""

    result: Result
    notes: tuple[str, ...]


def start(
    order: Order, stream: TextIO, makers: Mapping[str, Maker] = MAKERS, pool: Pool | None = None
) -> Done:
    """The batch, on another `pool` than the order's if one is given; events go to `stream` as they happen.

    Raises `AssignmentError` for a faulty roster, spec or folder of assignments, `OutputError` where nothing
    can be written, `ClusterError` where there is no cluster.
    """
    language = order.language or "vi"
    roster = read_roster(order.roster, language)
    chosen = {name: makers[name] for name in order.products}
    workers = pool or _pool(order, language)
    with held(order.out, language):
        assigned, notes = _assigned(order, roster, language)
        result = run(assigned, order.out, chosen, making(order.engine, order.language), workers, stream)
    if result.gone:
        notes = (*notes, word("batch_gone", language).format(count=result.gone))
    return Done(result, notes)


def told(done: Done, language: Language) -> Iterator[str]:
    """The batch's end in lines: notes, what went wrong, each once with all whom it met, a summary."""
    result = done.result
    yield from done.notes
    if result.failures:
        yield word("batch_failed", language).format(count=len(result.failures))
    met: dict[Problem | str, list[str]] = {}
    for failure in result.failures:
        for problem in failure.problems:
            met.setdefault(problem, []).append(f"{failure.student} {failure.product}")
    for problem, whom in met.items():
        # A problem of a file says by its place whose it is.
        yield f"{', '.join(whom)}: {problem}" if isinstance(problem, str) else str(problem)
    failed = len(result.failures)
    yield word("batch_ended", language).format(made=result.made, kept=result.kept, failed=failed)


def _pool(order: Order, language: Language) -> Pool:
    if order.cluster is None:
        return local(order.jobs or cores())
    from reportgen.batch.cluster import cluster

    return cluster(order.cluster, language)


def cores() -> int:
    """Of this machine, as many as this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _assigned(
    order: Order, roster: Roster, language: Language
) -> tuple[Sequence[Assigned], tuple[str, ...]]:
    """Each student with a file, and what to say besides, as of files and columns that served nobody."""
    if order.spec is not None:
        folder = order.out / DRAWN
        sweep(folder)
        variants = make_variants(order.spec, order.roster, folder, language=order.language)
        files = zip(roster.students, variants.files, strict=True)
        return [Assigned(student, file.path) for student, file in files], variants.remarks
    if order.assignments is None:
        raise ValueError("assignments are either drawn or given")
    assigned, nobodys = matched(roster.students, order.assignments, language)
    notes = [word("batch_nobodys", language).format(path=path) for path in nobodys]
    if roster.columns:
        names = ", ".join(column.name for column in roster.columns)
        notes.append(word("batch_columns", language).format(columns=names))
    return assigned, tuple(notes)
