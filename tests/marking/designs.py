"""What the marking of every design (a cam, a gear pair, a train) is tried with."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pymupdf

from reportgen import api
from reportgen.base.units import write
from reportgen.cases import open_case
from reportgen.formula.evaluation import evaluate
from reportgen.marking.key import key_of
from reportgen.marking.mistakes import Mistake
from reportgen.marking.scheme import MarkingScheme


def named(scheme: MarkingScheme, name: str, *where: str) -> Mistake:
    """A mistake of that name in some quantities, as the case knows it."""
    changes = {}
    for id in where:
        for called, definition in scheme.misconceptions.changed.get(id, ()):
            if called == name:
                changes[id] = lambda _, values, made=definition: np.atleast_1d(evaluate(made, values))
        for called, values in scheme.misconceptions.readings.get(id, ()):
            if called == name:
                changes[id] = lambda _, __, read=values: read
    assert changes, name
    return Mistake(name, where[0], changes)


def telling_and_texts(file: Path) -> tuple[list[str], list[str]]:
    """The numbers asked for that have four figures, and the texts of task and key."""
    pdfs = api.task_files(file, "typst", "en")["task.pdf"], api.key_files(file, "typst", "en", ("pdf",))["key.pdf"]
    texts = ["".join(page.get_text() for page in pymupdf.open(stream=pdf)) for pdf in pdfs]
    rows = key_of(open_case(file, "en")).asked
    shown = [
        write(abs(float(row.printed[row.at(k)])), row.decimals, "en")
        for row in rows
        for k in row.positions
        if row.decimals is not None
    ]
    return [text for text in shown if len(text.replace(".", "").strip("0")) >= 4], texts
