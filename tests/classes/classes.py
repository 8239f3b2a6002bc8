"""Classes of students who have little products, and what a batch of them left behind."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping
from pathlib import Path

from reportgen.classes.batch_run import Order, Result, run_batch
from reportgen.classes.worker_pool import Job, Pool, Results, Retried, run_job
from tests.classes.little import little

MAKERS = {"little": little, "other": little}


def write_class(folder: Path, assignments: Mapping[str, str]) -> tuple[Path, Path]:
    """The roster and the folder of assignment files of students by id."""
    files = folder / "given"
    files.mkdir(exist_ok=True)
    for name, text in assignments.items():
        (files / f"{name}.yaml").write_text(text, encoding="utf-8")
    roster = folder / "roster.csv"
    rows = "".join(f"{name},Sinh viên {name}\n" for name in assignments)
    roster.write_text(f"id,name\n{rows}", encoding="utf-8")
    return roster, files


def here(jobs: Iterable[Job], _retried: Retried) -> Results:
    """The pool without a process of its own."""
    for job in jobs:
        yield job, run_job(job)


class Batch:
    """Batches of one class into one folder; `events` are the lines of the latest."""

    def __init__(self, folder: Path, assignments: Mapping[str, str], out: str = "out") -> None:
        self.roster, self.given = write_class(folder, assignments)
        self.out = folder / out
        self.events: list[tuple[str, ...]] = []

    def run(self, *products: str, pool: Pool = here) -> Result:
        stream = io.StringIO()
        order = Order(self.roster, None, self.given, self.out, products or ("little",), language="en")
        try:
            return run_batch(order, stream, MAKERS, pool)
        finally:
            self.events = [tuple(line.split("\t")) for line in stream.getvalue().splitlines()]

    def students(self, event: str) -> list[str]:
        """The students of one kind of event, in order."""
        return [student for student, _, what in self.events if what == event]


def tree(folder: Path) -> dict[str, bytes]:
    """All that stands in a folder, hidden files too."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")
    }
