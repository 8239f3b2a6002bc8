"""What keeps a reader busy: its time over that for half as much, `python -m tests.bench.reading`.

Work that grows with the size takes 2 times as long, work that grows with its square 4 times.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from timeit import Timer

from reportgen.base.yaml_source import LARGEST
from reportgen.catalogue import check
from reportgen.workbook import read
from reportgen.workbook.zip_package import guarded
from tests.bench.__main__ import Row, of_this_machine, table
from tests.broken.endless import ENDLESS, endless
from tests.workbook.tables import bordered

AIM = "≤ 3"
BLANKS, BORDERED = 30_000, 10_000
"""Blanks in one cell, and rows of a hundred empty cells."""


def rows(folder: Path) -> Iterator[Row]:
    """One row for each endless file, for a cell of blanks and for a sheet of empty cells."""
    for name in ENDLESS:
        yield _row(f"endless {name}", _checked(folder, name, LARGEST), _checked(folder, name, LARGEST // 2))
    yield _row("a cell of blanks", lambda: guarded("x" + "\n" * BLANKS), lambda: guarded("x" + "\n" * (BLANKS // 2)))
    yield _row("empty cells with a border", _sheet(folder, BORDERED), _sheet(folder, BORDERED // 2))


def _checked(folder: Path, name: str, size: int) -> Callable[[], object]:
    file = folder / f"{name.replace(' ', '-')}-{size}.yaml"
    file.write_text(endless(name, size), encoding="utf-8")
    return lambda: check(file, "en")


def _sheet(folder: Path, count: int) -> Callable[[], object]:
    file = folder / f"bordered-{count}.xlsx"
    file.write_bytes(bordered(count))
    return lambda: list(read(file))


def _row(what: str, whole: Callable[[], object], half: Callable[[], object]) -> Row:
    taken, before = seconds(whole), seconds(half)
    return Row(f"{what} / half of it", AIM, f"{taken / before:.1f}", f"{1e3 * taken:.1f} ms")


def seconds(task: Callable[[], object]) -> float:
    """The processor's time for a task, so that other work on the machine does not count."""
    count, taken = Timer(task, timer=time.process_time).autorange()
    return taken / count


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory(prefix="reportgen-bench-") as name:
        print(of_this_machine(), table(list(rows(Path(name)))), sep="\n")


if __name__ == "__main__":
    main()
