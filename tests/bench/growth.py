"""How cost grows: with positions, worked positions and students; each step costs what the one before it did.

`python -m tests.bench.growth [--plot FILE]` runs each command in a cold process and prints time and peak memory of
its main process; the plot shows both.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

from .measure import Cost, run

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
SPEC = ROOT / "assignments" / "class-demo" / "spec.yaml"
POSITIONS = 8, 36, 90, 360
WORKED = 1, 2, 4, 8
STUDENTS = 12, 250, 1000, 5000
REPORTS = 10, 25, 60
PROGRAM = "from reportgen.cli import main; main()"
ALONE = """
import os, sys
from pathlib import Path
from reportgen.cli import main
from tests.bench.batch import peak
try:
    main()
finally:
    Path({note!r}).write_text(str(peak(os.getpid())))
"""
"""The command, and the peak memory (MB) of its own process: what it starts, and what started it, do not count."""


@dataclass(frozen=True, slots=True)
class Growth:
    """What a command costs over the size of what it is given."""

    what: str
    unit: str
    costs: Mapping[int, Cost]

    @property
    def slope(self) -> float:
        """Seconds for one more, by least squares."""
        return float(np.polyfit(list(self.costs), [cost.seconds for cost in self.costs.values()], 1)[0])

    @property
    def bend(self) -> float:
        """How much more the last stretch costs by the piece than the whole: 1 for a cost that is linear."""
        (n0, first), *_, (n1, before), (n2, last) = self.costs.items()
        whole = (last.seconds - first.seconds) / (n2 - n0)
        return (last.seconds - before.seconds) / (n2 - n1) / whole


@dataclass(frozen=True, slots=True)
class Trial:
    """Commands on files of a scratch folder."""

    folder: Path

    def command(self, *arguments: str) -> Cost:
        """One command in a cold process, with the peak memory of its main process alone."""
        note = self.folder / "memory"
        program = ALONE.format(note=str(note))
        seconds = run((sys.executable, "-c", program, *arguments), self.folder, _importable()).seconds
        return Cost(seconds, float(note.read_text()))

    def build(self, count: int = 0, worked: int = 0) -> Cost:
        """The sample's report with so many positions, or so many worked ones."""
        content = yaml.safe_load(SAMPLE.read_text(encoding="utf-8"))
        if count:
            content["positions"]["count"] = count
        if worked:
            content["report"]["worked_positions"] = list(range(1, worked + 1))
        file = self.folder / f"sample-{count}-{worked}.yaml"
        file.write_text(yaml.safe_dump(content, allow_unicode=True), encoding="utf-8")
        return self.command("build", str(file), "--out", str(self.folder / "out"))

    def roster(self, count: int) -> Path:
        path = self.folder / f"class-{count}.csv"
        path.write_text("id\n" + "".join(f"K{k:05}\n" for k in range(count)), encoding="utf-8")
        return path

    def variants(self, count: int) -> Cost:
        """The assignment files of a class."""
        given = self.folder / f"given-{count}"
        return self.command("variants", str(SPEC), str(self.roster(count)), "-o", str(given))

    def reports(self, count: int) -> Cost:
        """The reports of a class whose files are drawn, by two workers."""
        given, out = self.folder / f"drawn-{count}", self.folder / f"reports-{count}"
        self.command("variants", str(SPEC), str(self.roster(count)), "-o", str(given))
        options = ("--make", "report", "--jobs", "2", "--out", str(out))
        return self.command("batch", str(self.roster(count)), "--assignments", str(given), *options)


def measured(trial: Trial) -> Iterator[Growth]:
    """Every growth, the smallest first; a first build that warms the disk is not counted."""
    trial.build()
    each: tuple[tuple[str, str, Sequence[int], Callable[[int], Cost]], ...] = (
        ("build", "positions", POSITIONS, lambda count: trial.build(count=count)),
        ("build", "worked positions", WORKED, lambda worked: trial.build(worked=worked)),
        ("variants", "students", STUDENTS, trial.variants),
        ("batch, two workers", "reports", REPORTS, trial.reports),
    )
    for what, unit, sizes, cost in each:
        yield Growth(what, unit, {size: cost(size) for size in sizes})


def plot(grown: Sequence[Growth], target: Path) -> None:
    """Time and memory over size, a panel each."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(2, 2, figsize=(7.2, 5.0), layout="constrained")
    for one, axes in zip(grown, panels.flat, strict=True):
        sizes = list(one.costs)
        axes.plot(sizes, [cost.seconds for cost in one.costs.values()], "o-", color="#123c7c")
        axes.set(title=one.what, xlabel=one.unit, ylabel="s", xlim=(0, None), ylim=(0, None))
        memory = axes.twinx()
        memory.plot(sizes, [cost.memory for cost in one.costs.values()], "s--", color="#9c1c1c", markersize=4)
        memory.set_ylabel("MB", color="#9c1c1c")
        memory.set_ylim(0, 1.25 * max(cost.memory for cost in one.costs.values()))
    figure.savefig(target, dpi=100, metadata={"Software": None})
    plt.close(figure)


def _importable() -> dict[str, str]:
    """The checkout before whatever is installed."""
    return {"PYTHONPATH": os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))}


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print and, if asked, plot."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.growth", description=__doc__)
    parser.add_argument("--plot", type=Path, help="where to draw it")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="reportgen-bench-") as name:
        grown = []
        for one in measured(Trial(Path(name))):
            grown.append(one)
            print(
                f"{one.what}, by {one.unit}: {1e3 * one.slope:.1f} ms more for each, last stretch {one.bend:.2f} of it"
            )
            for size, cost in one.costs.items():
                print(f"  {size:5} {cost.seconds:7.2f} s {cost.memory:5.0f} MB", flush=True)
    if chosen.plot:
        plot(grown, chosen.plot)


if __name__ == "__main__":
    main()
