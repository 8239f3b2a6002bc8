"""`make bench`: what a report costs, as ratios measured in one run.

The build in a cold process over the typesetter alone on the finished source; a plain script that makes a
document of the same size over the build; motion and forces over a closed form by hand; peak memory.  Then where the
time of each command goes, step by step.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from . import steps
from .measure import Cost, in_turns, middle, ratio, repeated, run

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
CLASS_III = ROOT / "assignments" / "linkage" / "class-iii.yaml"
SIX_LINKS = Path(__file__).with_name("six-links.yaml")
POSITIONS = 3600
EIGHT_LINKS = ROOT / "assignments" / "linkage-8.yaml"
RUBBING = 360
"""Positions of it with friction in every joint."""
SUFFIX = {"typst": ".typ", "latex": ".tex"}
TYPST_ALONE = "import sys, typst; typst.compile(sys.argv[1], sys.argv[2], ignore_system_fonts=True)"
BUILD = "from reportgen.cli import main; main()"
PASSES = (
    "import sys, pathlib; from reportgen.writers import pdflatex; "
    "print(pdflatex.compile(pathlib.Path(sys.argv[1]).read_text(encoding='utf-8')).passes)"
)
STARTED = {
    "check": (("check", "{file}"), "import numpy, yaml, pydantic"),
    "kinds": (("kinds",), "import typer"),
    "--help": (("--help",), "import typer"),
}
"""Commands that are over before one notices: their arguments, and the imports that they are held against."""
CLASSES = 250, 1000
SAME_DATE = {"SOURCE_DATE_EPOCH": "0", "FORCE_SOURCE_DATE": "1"}


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table: what was measured, the aim, the result and the figures behind it."""

    what: str
    aim: str
    result: str
    detail: str = ""


@dataclass(frozen=True, slots=True)
class Bench:
    """The bench of one assignment file in a scratch folder."""

    file: Path
    folder: Path
    engines: tuple[str, ...]

    def report(self, engine: str) -> Path:
        """Where `engine` puts its report; the source stands beside it."""
        return self.folder / engine / self.file.stem / "report.pdf"

    def source(self, engine: str) -> Path:
        return self.report(engine).with_suffix(SUFFIX[engine])

    def build(self, engine: str) -> Cost:
        """One report by the command line, in a cold process."""
        options = ("--out", str(self.folder / engine), "--engine", engine, "--keep-source")
        return run((sys.executable, "-c", BUILD, "build", str(self.file), *options), self.folder, self.installed())

    def written(self, file: Path) -> Cost:
        """The report of another file by typst, in a cold process."""
        options = ("--out", str(self.folder / "other"), "--engine", "typst")
        return run((sys.executable, "-c", BUILD, "build", str(file), *options), self.folder, self.installed())

    def drawn(self) -> Cost:
        """All drawing sheets of the usual size, in both formats."""
        options = ("--out", str(self.folder / "sheets"), "--size", "A1")
        return run((sys.executable, "-c", BUILD, "sheet", str(self.file), *options), self.folder, self.installed())

    def solved(self) -> Cost:
        """The results alone."""
        options = ("--json", str(self.folder / "results.json"))
        return run((sys.executable, "-c", BUILD, "solve", str(self.file), *options), self.folder, self.installed())

    def started(self, arguments: Sequence[str]) -> Cost:
        """A short command, in a cold process."""
        given = (argument.format(file=self.file) for argument in arguments)
        return run((sys.executable, "-c", BUILD, *given), self.folder, self.installed())

    def imported(self, statement: str) -> Cost:
        """A process that loads some libraries and ends."""
        return run((sys.executable, "-c", statement), self.folder, self.installed())

    def installed(self) -> dict[str, str]:
        """The checkout before whatever is installed, with its bytecode kept as that of an installed package is."""
        bytecode = {"PYTHONPYCACHEPREFIX": str(self.folder / "bytecode"), "PYTHONDONTWRITEBYTECODE": ""}
        return {**_importable(), **bytecode}

    def typst_alone(self) -> Cost:
        """The finished source by a process that does nothing else."""
        alone = str(self.folder / "alone.pdf")
        return run((sys.executable, "-c", TYPST_ALONE, str(self.source("typst")), alone), self.folder)

    def latex_alone(self, passes: int) -> Cost:
        """As many passes over the finished source, from nothing, as the build makes."""
        fresh = Path(tempfile.mkdtemp(dir=self.folder))
        shutil.copy(self.source("latex"), fresh)
        command = ("pdflatex", "-interaction=nonstopmode", "-halt-on-error", self.source("latex").name)
        return repeated(lambda: run(command, fresh, SAME_DATE), passes)

    def plain(self, size: str) -> Cost:
        """A document of the same size by a script of its own."""
        fresh = tempfile.mkdtemp(dir=self.folder)
        return run((sys.executable, str(Path(__file__).with_name("plain.py")), fresh, size), self.folder)

    def ask(self, *arguments: str, **environment: str) -> str:
        """What a helper process prints; this process stays small, for children inherit its peak memory."""
        command, surroundings = (sys.executable, *arguments), {**os.environ, **_importable(), **environment}
        done = subprocess.run(command, cwd=ROOT, env=surroundings, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr.strip())
        return done.stdout

    def rows(self, rounds: int) -> Iterator[Row]:
        """Everything, measured; the first build of each engine keeps bytecode, warms the disk and is not counted."""
        for engine in self.engines:
            self.build(engine)
        size = self.ask("-m", "tests.bench.size", str(self.file), str(self.report(self.engines[0])))
        tasks: dict[str, Callable[[], Cost]] = {engine: partial(self.build, engine) for engine in self.engines}
        tasks |= {"typst alone": self.typst_alone, "sheets": self.drawn, "solve": self.solved}
        tasks |= {file.stem: partial(self.written, file) for file in (CLASS_III, SIX_LINKS)}
        passes = 0
        if "latex" in self.engines:
            # From nothing, as nobody has kept page numbers for it.
            passes = int(self.ask("-c", PASSES, str(self.source("latex")), XDG_CACHE_HOME=str(self.folder / "nothing")))
            tasks["latex alone"] = partial(self.latex_alone, passes)
            tasks["plain"] = partial(self.plain, size)
        for name, (arguments, statement) in STARTED.items():
            tasks |= {name: partial(self.started, arguments), statement: partial(self.imported, statement)}
        costs = in_turns(tasks, rounds)
        for engine in self.engines:
            yield _over_typesetter(engine, costs[engine], costs[f"{engine} alone"], passes)
        if "plain" in costs:
            yield from _against_plain(costs, json.loads(size))
        else:
            yield Row("rows with LaTeX, plain script", "", "skipped", "pdflatex is not installed")
        third, second = costs[CLASS_III.stem], costs[SIX_LINKS.stem]
        detail = f"{middle(third).seconds:.2f} s, six links of class II {middle(second).seconds:.2f} s"
        yield Row("report of a group of class III / of class II", "≤ 1.3", f"{ratio(third, second):.2f}", detail)
        count = len(list((self.folder / "sheets" / self.file.stem).glob("*.dxf")))
        yield _per_sheet(middle(costs["sheets"]), middle(costs["solve"]), middle(costs["typst alone"]), count)
        solving = ("-m", "tests.bench.solving", str(self.file), str(EIGHT_LINKS), str(POSITIONS), str(RUBBING))
        yield from _solving(json.loads(self.ask(*solving)))
        for name, (_, statement) in STARTED.items():
            detail = f"{middle(costs[name]).seconds:.2f} s, {statement} {middle(costs[statement]).seconds:.2f} s"
            yield Row(f"{name} / its libraries", "", f"{ratio(costs[name], costs[statement]):.2f}", detail)
        yield from _of_a_class(json.loads(self.ask("-m", "tests.bench.students", *map(str, CLASSES))))
        for engine in self.engines:
            yield _memory(engine, middle(costs[engine]), middle(costs[f"{engine} alone"]))

    def steps(self, rounds: int) -> Iterator[str]:
        """Commands and where their time goes, a line each."""
        file, out = str(self.file), ("--out", str(self.folder / "steps"))
        commands = {f"build, {engine}": ("build", file, *out, "--engine", engine) for engine in self.engines}
        commands |= {"check": ("check", file), "kinds": ("kinds",), "key": ("key", file, *out)}
        for name, arguments in commands.items():
            runs = [json.loads(self.ask("-m", "tests.bench.steps", *arguments)) for _ in range(rounds)]
            yield steps.told(name, steps.middle(runs))


def _over_typesetter(engine: str, build: Sequence[Cost], alone: Sequence[Cost], passes: int) -> Row:
    aim = {"typst": "≤ 1.6", "latex": "≤ 1.2"}[engine]
    how = f"{passes} passes" if engine == "latex" else "alone"
    detail = f"{middle(build).seconds:.2f} s, {how} {middle(alone).seconds:.2f} s"
    return Row(f"build / typesetter, {engine}", aim, f"{ratio(build, alone):.2f}", detail)


def _against_plain(costs: Mapping[str, Sequence[Cost]], size: Mapping[str, int]) -> Iterator[Row]:
    by = "latexmk" if shutil.which("latexmk") else "pdflatex"
    held = ", ".join(f"{size[what]} {what}" for what in ("pages", "figures", "labels", "formulas", "tables"))
    details = (f"{middle(costs['plain']).seconds:.2f} s by pyplot and {by}", held)
    for engine, detail in zip(("typst", "latex"), details, strict=True):
        faster = ratio(costs["plain"], costs[engine])
        yield Row(f"plain script / build, {engine}", {"typst": "≥ 6", "latex": "≥ 9"}[engine], f"{faster:.2f}", detail)


def _per_sheet(sheets: Cost, solve: Cost, alone: Cost, count: int) -> Row:
    each = (sheets.seconds - solve.seconds) / count
    detail = f"{count} sheets A1, PDF and DXF, {sheets.seconds:.2f} s; results alone {solve.seconds:.2f} s"
    return Row("a drawing sheet beyond the analysis / typst alone", "≤ 1", f"{each / alone.seconds:.2f}", detail)


def _memory(engine: str, build: Cost, alone: Cost) -> Row:
    # Libraries and the report take some 90 MB beside what the typesetter takes by itself.
    aim = {"typst": "≤ 1.7"}.get(engine, "")
    detail = f"{build.memory:.0f} MB, alone {alone.memory:.0f} MB"
    return Row(f"peak memory / typesetter, {engine}", aim, f"{build.memory / alone.memory:.2f}", detail)


def _of_a_class(taken: Mapping[str, float]) -> Iterator[Row]:
    for size in CLASSES:
        each = taken[str(size)]
        yield Row(
            f"variants for {size} students / results", "≤ 1", f"{each / taken['solve']:.2f}", f"{each:.1f} ms a student"
        )
    for name in ("key", "sheet", "guide", "mark"):
        over = taken[name] / taken["solve"]
        yield Row(f"{name} of a student / results", "≤ 10", f"{over:.1f}", f"{taken[name]:.0f} ms")


def _solving(taken: dict[str, float]) -> Iterator[Row]:
    solver, closed = taken["solver"], taken["closed form"]
    detail = f"{solver:.1f} ms, of which motion {taken['motion']:.1f} ms, closed form {closed:.2f} ms"
    yield Row(f"motion and forces of {POSITIONS} positions", "≤ 4", f"{solver / closed:.1f}", detail)
    without, rubbing = taken["without"], taken["with"]
    detail = f"{rubbing:.1f} ms, without {without:.1f} ms"
    yield Row(f"friction in eight links, {RUBBING} positions", "≤ 10", f"{rubbing / without:.1f}", detail)


def _importable() -> dict[str, str]:
    """The checkout before whatever is installed."""
    return {"PYTHONPATH": os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))}


def table(rows: Sequence[Row]) -> str:
    """The rows in aligned columns under a head."""
    cells = [("", "aim", "result", ""), *((row.what, row.aim, row.result, row.detail) for row in rows)]
    widths = [max(len(cell[k]) for cell in cells) for k in range(3)]
    return "\n".join(
        f"{what:{widths[0]}}  {aim:>{widths[1]}}  {result:>{widths[2]}}  {detail}".rstrip()
        for what, aim, result, detail in cells
    )


def of_this_machine() -> str:
    """The machine in a line."""
    return f"{os.cpu_count()} CPUs, Python {platform.python_version()}, {platform.system()} {platform.machine()}"


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("file", nargs="?", type=Path, default=SAMPLE, help="assignment file")
    parser.add_argument("--rounds", type=int, default=5, help="runs of everything, taken in turns")
    chosen = parser.parse_args(arguments)
    engines = ("typst", "latex") if shutil.which("pdflatex") else ("typst",)
    with tempfile.TemporaryDirectory(prefix="reportgen-bench-") as name:
        bench = Bench(chosen.file.resolve(), Path(name), engines)
        rows = list(bench.rows(chosen.rounds))
        print(of_this_machine(), table(rows), "", *bench.steps(chosen.rounds), sep="\n")


if __name__ == "__main__":
    main()
