"""What a class costs: reports a minute by two processes over twice what one makes and over what two typesetters set
alone, and the memory of each.

`python -m tests.bench.batch` makes the reports of 40 students, in turns by one process and by two.
"""

from __future__ import annotations

import argparse
import io
import math
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter

from reportgen import api
from reportgen.classes.batch_run import Order, run_batch
from reportgen.classes.variants import make_variants

from .measure import Cost, in_turns, middle, repeated, run

ROOT = Path(__file__).resolve().parents[2]
SPEC = ROOT / "assignments" / "class-demo" / "spec.yaml"
STUDENTS = 40
SAMPLING = 0.2
"""Seconds between two looks at the workers' memory; the system remembers each one's peak in between."""
SET_ALONE = "import sys, typst; typst.compile(sys.argv[1], sys.argv[2], ignore_system_fonts=True)"
TIMES = 5
"""Reports that each typesetter sets alone."""
BUSY = "sum(k * k % 7 for k in range(10_000_000))"


@dataclass(frozen=True, slots=True)
class Class:
    """A class whose assignment files are drawn, and a scratch folder to make its reports in."""

    folder: Path
    students: int
    spec: Path = SPEC

    def draw(self) -> None:
        roster = "id\n" + "".join(f"K{k:03}\n" for k in range(self.students))
        (self.folder / "roster.csv").write_text(roster, encoding="utf-8")
        make_variants(self.spec, self.folder / "roster.csv", self.folder / "given")

    def reports(self, workers: int) -> Cost:
        """Time of all reports, from the roster to the last file, and the peak memory of any one worker.

        Raises `RuntimeError` if one of them fails.
        """
        with tempfile.TemporaryDirectory(dir=self.folder) as out, _peaks() as peaks:
            order = Order(self.folder / "roster.csv", None, self.folder / "given", Path(out), ("report",), jobs=workers)
            begun = perf_counter()
            done = run_batch(order, io.StringIO())
            seconds = perf_counter() - begun
        if done.made != self.students:
            raise RuntimeError(f"{len(done.failures)} reports failed: {done.failures[:1]}")
        return Cost(seconds, max(peaks.values(), default=0.0))


def machine(folder: Path) -> float:
    """What two processes that share nothing reach here, over twice one: the most a pool can."""
    one = run((sys.executable, "-c", BUSY), folder).seconds
    command = "import subprocess, sys; one = [sys.executable, '-c', sys.argv[1]]; "
    both = "[p.wait() for p in [subprocess.Popen(one), subprocess.Popen(one)]]"
    return one / run((sys.executable, "-c", command + both, BUSY), folder).seconds


def efficiency(one: Sequence[Cost], two: Sequence[Cost]) -> float:
    """The rate of two workers over twice that of one: the median of rounds, each compared with itself."""
    return median(a.seconds / (2 * b.seconds) for a, b in zip(one, two, strict=True))


def plain(folder: Path, size: str) -> float:
    """Documents of the same size a minute by the plain script, one on each of two processors."""
    script = str(Path(__file__).with_name("plain.py"))
    targets = [tempfile.mkdtemp(dir=folder) for _ in range(2)]
    waiting = [partial(run, (sys.executable, script, target, size), Path(target)) for target in targets]
    begun = perf_counter()
    with ThreadPoolExecutor(2) as both:
        for cost in [both.submit(one) for one in waiting]:
            cost.result()
    return 2 * 60 / (perf_counter() - begun)


def typesetters(folder: Path, source: Path, times: int) -> Cost:
    """Time a report, and memory, if two typesetters at once set a source a number of `times` and do nothing else.

    Each time is a process of its own: within one, typst would remember the source.
    """
    targets = [Path(tempfile.mkdtemp(dir=folder)) for _ in range(2)]
    commands = [(sys.executable, "-c", SET_ALONE, str(source), str(target / "alone.pdf")) for target in targets]
    waiting = [partial(repeated, partial(run, *one), times) for one in zip(commands, targets, strict=True)]
    begun = perf_counter()
    with ThreadPoolExecutor(2) as both:
        costs = [cost.result() for cost in [both.submit(one) for one in waiting]]
    return Cost((perf_counter() - begun) / (2 * times), max(cost.memory for cost in costs))


def report_of_one(given: Path, folder: Path) -> tuple[Path, Path]:
    """The assignment file of one student, and its report, with the source beside it."""
    file = next(iter(sorted(given.glob("*.yaml"))))
    return file, api.build(file, folder / "one", keep_source=True)


def size(file: Path, pdf: Path) -> str:
    """How much a report holds, see `size.py`."""
    command = (sys.executable, "-m", "tests.bench.size", str(file), str(pdf))
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


@contextmanager
def _peaks() -> Iterator[dict[int, float]]:
    """Fills a table of the peak memory (MB) of every process that this one has below it, while it lasts.

    Needs /proc; the table stays empty elsewhere.
    """
    peaks: dict[int, float] = {}
    over = threading.Event()

    def look() -> None:
        while not over.wait(SAMPLING):
            for process in below(os.getpid()):
                peaks[process] = max(peaks.get(process, 0.0), peak(process))

    looking = threading.Thread(target=look, daemon=True)
    looking.start()
    try:
        yield peaks
    finally:
        over.set()
        looking.join()


def below(process: int) -> set[int]:
    """All processes that a process or its descendants have started."""
    parents: dict[int, int] = {}
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            parents[int(entry.parent.name)] = int(entry.read_text().rpartition(")")[2].split()[1])
        except (OSError, IndexError):
            continue
    found = {process}
    while new := {child for child, parent in parents.items() if parent in found} - found:
        found |= new
    return found - {process}


def peak(process: int) -> float:
    """Most memory (MB) that a process has had; 0 if it is gone."""
    try:
        status = Path(f"/proc/{process}/status").read_text()
    except OSError:
        return 0.0
    lines = (line.split() for line in status.splitlines())
    return next((float(words[1]) * 1024 / 1e6 for words in lines if words[0] == "VmHWM:"), 0.0)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.batch", description=__doc__)
    parser.add_argument("--students", type=int, default=STUDENTS)
    parser.add_argument("--rounds", type=int, default=1)
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="reportgen-bench-") as name:
        folder = Path(name)
        group = Class(folder, chosen.students)
        group.draw()
        free = machine(folder)
        costs = in_turns({str(n): lambda n=n: group.reports(n) for n in (1, 2)}, chosen.rounds)
        file, pdf = report_of_one(folder / "given", folder)
        alone = typesetters(folder, pdf.with_suffix(".typ"), TIMES)
        script = plain(folder, size(file, pdf)) if shutil.which("pdflatex") else math.nan
    print(f"reports of {chosen.students} students")
    for workers, taken in costs.items():
        cost = middle(taken)
        rate, over = 60 * chosen.students / cost.seconds, cost.memory / alone.memory
        memory = f"peak memory of a worker / typesetter {over:.1f} ({cost.memory:.0f} MB; aim ≤ 2)"
        print(f"  by {workers}: {rate:6.1f} a minute, {memory}")
    print(f"  two over twice one: {efficiency(costs['1'], costs['2']):.2f} (aim ≥ 0.85)")
    rate, most = 60 * chosen.students / middle(costs["2"]).seconds, 60 / alone.seconds
    print(f"  by two over two typesetters alone: {rate / most:.2f} ({most:.1f} a minute; aim ≥ 0.6)")
    print(f"  by two over a plain script on two processors: {rate / script:.1f} ({script:.1f} a minute; aim ≥ 9)")
    print(f"  two busy processes over twice one on this machine: {free:.2f}")


if __name__ == "__main__":
    main()
