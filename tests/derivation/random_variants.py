"""Variants of an assignment file as a class would get them: every measure a little different, from a fixed seed."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from pathlib import Path

from reportgen import api
from reportgen.base.errors import ReportgenError
from reportgen.cases import MachineCase

MEASURE = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?(?:e-?\d+)?)(?= ?(?:mm|cm|m|kg|g|N|rpm|rad/s|N/cm2|MPa)\b)")
SPREAD = 0.08
"""Share by which a measure differs at most; of more, too many machines could not turn."""
DIGITS = 3
TRIES = 200


def cases(file: Path, count: int, folder: Path) -> Iterator[MachineCase]:
    """So many variants whose machines run; those that are refused are passed over."""
    head, parameters = re.split(r"(?m)^parameters:", file.read_text(encoding="utf-8"))
    found = 0
    for seed in range(TRIES):
        dice = random.Random(f"{file.stem} {seed}")

        def changed(measure: re.Match[str], dice: random.Random = dice) -> str:
            return f"{float(measure[0]) * dice.uniform(1 - SPREAD, 1 + SPREAD):.{DIGITS}g}"

        variant = folder / f"{file.stem}-{seed}.yaml"
        variant.write_text(f"{head}parameters:{MEASURE.sub(changed, parameters)}", encoding="utf-8")
        try:
            case = MachineCase(api.load(variant))
            assert case.ledger.families
        except ReportgenError:
            continue
        yield case
        found += 1
        if found == count:
            return
    raise AssertionError(f"{found} of {count} variants of {file.stem} run")
