"""Which sense of a quantity counts as positive, in words, as the report has it; the rows of the papers say so.

The phrases stand in `words.yaml` under `positive`, by patterns of kind and id, of which the first that fits decides;
those of a machine come before the common ones.
"""

from __future__ import annotations

import re

import numpy as np

from reportgen.document.equations import heading_words
from reportgen.document.report import Report
from reportgen.ledger.core import Ledger
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Expression, refs

MAGNITUDE = "magnitude"
"""Stands in place of a phrase where the sign of a quantity says nothing."""


def positive_sense(id: str, report: Report) -> str:
    """The phrase of a quantity, `MAGNITUDE`, or "" where no words say anything."""
    family, ledger = report.ledger[id], report.ledger
    known = _points(id, ledger) | _way(id, report)
    for pattern, phrase in report.words["positive"].items():
        if re.fullmatch(pattern, f"{family.kind} {id}"):
            try:
                return str(phrase).format(**known)
            except KeyError:
                # It speaks of something that this quantity has not.
                continue
    return ""


def _points(id: str, ledger: Ledger) -> dict[str, str]:
    """Both ends, and the letters, of the rod or slot that a projection or an assumed sense goes by."""
    link = id.split(".")[2] if id.startswith("ic.along.") else ""
    assumed = ledger.known([f"assumed.{id.replace('.', '', 1)}"])
    if assumed:
        along = refs(_definition(ledger, assumed[0]))[0]
        link = along.partition(".")[2] if along.startswith(("rod.", "slot.")) else ""
    rod = f"rod.{link}"
    if rod not in ledger:
        return {}
    end, start = (vocabulary.lowered(point.removeprefix("p.")) for point in refs(_definition(ledger, rod)))
    return {"start": start, "end": end, "line": f"{start}{end}"}


def _definition(ledger: Ledger, id: str) -> Expression:
    definition = ledger[id].definition
    assert definition is not None, f"{id} is constructed from nothing"
    return definition


def _way(id: str, report: Report) -> dict[str, str]:
    """Where a slider's motion counts as positive, in words."""
    way = report.slider_senses.get(id.rpartition(".")[2])
    return {} if way is None else {"way": heading_words(report, float(np.degrees(np.angle(way))))}


def is_open(values: np.ndarray, sense: str) -> bool:
    """Whether the papers leave the sign of values open: there are negative ones, and no words about them."""
    return sense == MAGNITUDE or (not sense and bool(np.nanmin(values, initial=0.0) < 0))
