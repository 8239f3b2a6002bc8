"""What the marking of every design (a cam, a gear pair, a train) is tried with."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pymupdf

from reportgen import api
from reportgen.base.units import write
from reportgen.cases import open_case
from reportgen.classes import class_marking
from reportgen.classes.class_marking import Graded
from reportgen.classes.variants import make_variants
from reportgen.formula.evaluation import evaluate
from reportgen.marking.judging import mark
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.mistakes import Mistake
from reportgen.marking.toleranced_key import key_of
from tests.marking import demo, students
from tests.report import built

STUDENTS = 12


def with_ranges(file: Path, drawn: Mapping[str, str]) -> str:
    """The text of a sample with ranges in place of some of its values."""
    text = file.read_text(encoding="utf-8")
    for old, new in drawn.items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    return text


def drawn_class(folder: Path, specification: str) -> Path:
    """The folder of a class of twelve with a variant each."""
    (folder / "spec.yaml").write_text(specification, encoding="utf-8")
    roster = "id,name,class\n" + "".join(f"S{number:02d},Student {number},K1\n" for number in range(1, STUDENTS + 1))
    (folder / "roster.csv").write_text(roster, encoding="utf-8")
    made = make_variants(folder / "spec.yaml", folder / "roster.csv", folder / "variants", False, "en")
    assert len(made.files) == STUDENTS
    return folder


def graded_class(folder: Path, mistake: str, where: str) -> Graded:
    """Marks of right sheets of three figures; the first student makes a mistake at a place and goes on from that."""
    (folder / "sheets").mkdir()
    for path in sorted((folder / "variants").glob("S*.yaml")):
        scheme = marking_scheme(open_case(path))
        slip = named(scheme, mistake, where) if path.stem == "S01" else None
        sheet = students.written(scheme, students.worked_out(scheme, slip))
        (folder / "sheets" / f"{path.stem}.xlsx").write_bytes(demo.workbook(scheme.key, sheet))
    return class_marking.grade([folder / "sheets"], folder / "variants", Policy())


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


def check_named(file: Path, mistake: str, where: tuple[str, ...]) -> None:
    """Check that marking names a mistake made in some quantities, and only there."""
    scheme = marking_scheme(built.case(file, "en"))
    sheet = students.written(scheme, students.worked_out(scheme, named(scheme, mistake, *where)))
    first = mark(scheme, sheet).first_errors
    assert first
    assert {cell.mistake for cell in first} == {mistake}
    assert {cell.id for cell in first} <= set(where)


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
