"""A product without a typesetter, whose assignment file says how its making goes; and a batch of such.

`python -m tests.classes.little ROSTER ASSIGNMENTS OUT` makes it on two processes, to be killed from outside.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path

from reportgen.api import Engine
from reportgen.base.errors import AssignmentError, Location, Problem
from reportgen.base.units import Language
from reportgen.classes.batch_run import Order, run_batch


def little(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """Two files; lines `key: value` of the assignment file make it slow, wrong or deadly before, or of fewer files."""
    text = path.read_text(encoding="utf-8")
    orders = dict(line.split(": ", 1) for line in text.splitlines())
    if "log" in orders:
        with open(orders["log"], "a", encoding="utf-8") as log:
            log.write(f"{path.stem} begun\n")
    time.sleep(float(orders.get("seconds", "0")))
    if "wrong" in orders:
        raise AssignmentError([Problem("wrong", orders["wrong"], Location(str(path), 1, 8))])
    if "crash" in orders:
        raise ZeroDivisionError(f"in {path}")
    if orders.get("dies") == "always":
        os.kill(os.getpid(), signal.SIGKILL)
    if "dies" in orders:
        flag = Path(orders["dies"])
        if not flag.exists():
            flag.touch()
            os.kill(os.getpid(), signal.SIGKILL)
    digest = sha256(f"{text}{engine}{language}".encode()).hexdigest()
    files = {"a.pdf": f"{path.stem} {digest}".encode(), "b.xlsx": digest.encode()}
    return {name: files[name] for name in orders.get("files", "a.pdf b.xlsx").split()}


def main() -> int:
    roster, assignments, out = map(Path, sys.argv[1:4])
    order = Order(roster, None, assignments, out, ("little",), language="en", jobs=2)
    done = run_batch(order, sys.stderr, {"little": little})
    print(*done.summary("en"), sep="\n")
    return done.exit_code


if __name__ == "__main__":
    sys.exit(main())
