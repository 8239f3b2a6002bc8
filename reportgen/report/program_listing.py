"""The closed formulas of a machine as a standalone Python program, printed in the report."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping

import numpy as np

from reportgen.base.errors import NotOfferedError
from reportgen.base.words import word
from reportgen.document import Listing
from reportgen.document.python_lines import (
    DRAWN,
    KINDS_SI,
    LONGEST,
    TABULATED,
    assigned,
    comment,
    given_values,
    python_name,
)
from reportgen.formula.plain_text import python
from reportgen.formula.vocabulary import KeyChapter
from reportgen.machine.load_laws import FULL_TURN
from reportgen.report.context import ReportContext

CURVES = ("s", "v", "a", "M"), ("x", "y", "v", "a", "M"), ("ω", "ε")
"""Letters of the quantities that the program plots: the first of these sets whose first letter the formulas give."""


def program(report: ReportContext) -> Listing:
    """Return the closed formulas as a program: given data, the formulas in order, and a table of their results.

    It ends with curves over the driver's motion.  Its quantities are in SI units and rad, not rounded.  A quantity
    without a formula is given by its values.  Raises `NotOfferedError` for a machine without closed formulas.
    """
    ledger, kind = report.case.ledger, report.assignment.kind
    changing = [id for id, one in ledger.families.items() if one.chapter is KeyChapter.formulas and len(one.values) > 1]
    worked_out = (one for one in changing if ledger[one].definition is not None)
    changing_lines = [id for id in worked_out if not (ledger[id].hidden or ledger[id].trial)]
    if not changing_lines:
        raise NotOfferedError(word("no_listing", report.assignment.language, kind=kind))
    needed = {other for id in changing_lines for other in (id, *ledger.ancestors(id))}
    data: list[str] = []
    formulas: list[str] = []
    names: dict[str, str] = {}
    for id, family in ledger.families.items():
        if id not in needed:
            continue
        names[id] = name = python_name(id, names.values())
        note = f"  {comment(', '.join(filter(None, (KINDS_SI.get(family.kind, ''), report.given_names.get(id, '')))))}"
        try:
            assert family.definition is not None
            formulas += assigned(name, python(family.definition, names), note)
        except (AssertionError, KeyError):
            data += assigned(name, given_values(family.values, report.machine.count), note)
    table = textwrap.wrap(", ".join(f"{names[id]}={names[id]}" for id in changing_lines), LONGEST - 4)
    title, given, worked, tabulated, drawn = report.words["listing"]
    return Listing(
        (
            comment(title.format(machine=report.case.title, id=report.assignment.id)),
            "import numpy as np",
            "",
            f"N = {report.cycle_count}",
            comment(given),
            *data,
            comment(worked),
            *formulas,
            comment(tabulated),
            "table = dict(",
            *(f"    {line}" for line in table),
            ")",
            *TABULATED.splitlines(),
            comment(drawn),
            *_curves(report, {id: names[id] for id in changing_lines}),
            *DRAWN.splitlines(),
        )
    )


def _curves(report: ReportContext, names: Mapping[str, str]) -> Iterator[str]:
    """Yield the lines of the program that plot curves: the abscissa, and the curves by unit."""
    ledger, machine = report.case.ledger, report.machine
    bases = {id: ledger.symbol(id).base for id in names}
    letters = next((one for one in CURVES if one[0] in bases.values()), CURVES[-1])
    # A slider is recognised by its displacement; v and a of other points are only intermediate results.
    points = {ledger.symbol(id).sub for id in names if bases[id] == letters[0]}
    own = {letter for letter in letters if any(bases[id] == letter and ledger.symbol(id).sub in points for id in names)}
    by_unit: dict[str, list[str]] = {}
    for letter in letters:
        for id, name in names.items():
            if bases[id] == letter and (letter not in own or ledger.symbol(id).sub in points):
                by_unit.setdefault(KINDS_SI.get(ledger[id].kind, ""), []).append(name)
    gone = machine.cycle_angles * (machine.span / FULL_TURN if machine.span else math.degrees(1.0))
    step = float(f"{gone[1]:.12g}")
    even = step * np.arange(len(gone))
    law = f"{step!r} * np.arange(N)" if np.allclose(gone, even, rtol=1e-12) else given_values(gone, len(gone))
    yield from assigned("driver", law, "")
    yield f"DRIVER = {'s (m)' if machine.span else 'phi (deg)'!r}"
    yield from assigned("curves", repr(by_unit), "")
