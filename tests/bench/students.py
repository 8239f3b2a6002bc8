"""What one student costs an instructor, in milliseconds: `python -m tests.bench.students [STUDENTS…]`.

In one warm process: the results, the key, the answer sheet, the marking of a sheet; then `variants` for classes of the
sizes named, each in a process of its own, by the student.  Prints JSON.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

from reportgen import api
from reportgen.cases import open_case, opened
from reportgen.marking.answer_sheet import answer_book
from reportgen.marking.judging import mark
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.workbook import write_xlsx
from tests.marking import students

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
SPEC = ROOT / "assignments" / "class-demo" / "spec.yaml"
VARIANTS = "from reportgen.cli import main; main()"
ROUNDS = 5


def one_student(path: Path = SAMPLE) -> dict[str, float]:
    """Medians in ms of what is made for one student, from the assignment file on."""
    scheme = marking_scheme(open_case(path), Policy())
    rng = np.random.default_rng(1)
    sheets = [students.written(scheme, students.worked_out(scheme, None, rng)) for _ in range(ROUNDS)]
    handed = iter(sheets)
    tasks: dict[str, Callable[[], Any]] = {
        "solve": lambda: api.solve(api.load(path)),
        "key": lambda: key_of(opened(api.load(path))),
        "sheet": lambda: write_xlsx(answer_book(Ask().of(scheme.key))),
        "guide": lambda: marking_scheme(open_case(path), Policy()),
        "mark": lambda: mark(scheme, next(handed)),
    }
    return {name: median(_timed(task) for _ in range(ROUNDS)) for name, task in tasks.items()}


def per_variant(count: int) -> float:
    """Milliseconds a student that `variants` takes for a class of so many, beyond one of two."""
    return 1e3 * (_class(count) - _class(2)) / (count - 2)


def _class(count: int) -> float:
    with tempfile.TemporaryDirectory(prefix="reportgen-bench-") as name:
        roster = Path(name) / "roster.csv"
        roster.write_text("id\n" + "".join(f"K{k:05}\n" for k in range(count)), encoding="utf-8")
        command = (sys.executable, "-c", VARIANTS, "variants", str(SPEC), str(roster), "-o", str(Path(name) / "given"))
        begun = perf_counter()
        subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
        return perf_counter() - begun


def _timed(task: Callable[[], Any]) -> float:
    begun = perf_counter()
    task()
    return 1e3 * (perf_counter() - begun)


def main(sizes: Sequence[str]) -> None:
    json.dump({**one_student(), **{size: per_variant(int(size)) for size in sizes}}, sys.stdout)


if __name__ == "__main__":
    main(sys.argv[1:])
