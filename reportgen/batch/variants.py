"""Spec and roster → an assignment file a student, and a table that tells the instructor how alike they are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from reportgen import api
from reportgen.assignment import Fault
from reportgen.assignment.faults import Where
from reportgen.assignment.messages import as_problem, word
from reportgen.assignment.source import Scalar, read_source
from reportgen.batch.alike import FIGURES, Effort, Spread, compare, effort, shown, table
from reportgen.batch.draw import Draw, Drawn, draw, shared
from reportgen.batch.freeze import Frozen, freeze
from reportgen.batch.nodes import at, path_text
from reportgen.batch.roster import read_roster
from reportgen.batch.spec import Spec, read_spec
from reportgen.batch.trial import trial
from reportgen.errors import AssignmentError
from reportgen.notation.numbers import Language
from reportgen.workbook import write_csv

TABLE = "variants.csv"


@dataclass(frozen=True, slots=True)
class Variants:
    """What was made: the files in the order of the roster, remarks, and how alike the variants are, in words."""

    files: tuple[Frozen, ...]
    remarks: tuple[str, ...]
    summary: tuple[str, ...]


def make_variants(
    spec_path: Path, roster_path: Path, out: Path, force: bool = False, language: Language | None = None
) -> Variants:
    """Draw for the class of a roster and freeze each student's assignment in `out`.

    Files appear whole; one that was edited since it was made is kept unless `force`.  Also writes
    `out`/variants.csv, which is the instructor's alone.  Raises `AssignmentError` with the faults of spec and
    roster, before anything is written.
    """
    spec = read_spec(spec_path, language)
    roster = read_roster(roster_path, spec.language)
    _refuse(spec.column_faults(roster.columns), spec)
    result = draw(spec, roster, trial(spec))
    _refuse(result.faults, spec)
    out.mkdir(parents=True, exist_ok=True)
    files = tuple(freeze(spec, one, out, force) for one in result.drawn)
    for file in files:
        if file.state in ("new", "changed"):
            api.replace(file.path, file.text.encode())
    remarks, efforts = _efforts(files, result.drawn, spec.language)
    spreads = compare([one for one in efforts if one is not None])
    api.replace(out / TABLE, _csv(files, result.drawn, efforts))
    remarks = [*remarks, *_sharing(result, spec)]
    known = [one for one, figures in zip(result.drawn, efforts, strict=True) if figures is not None]
    return Variants(files, tuple(remarks), tuple(_summary(spreads, known, efforts, spec.language)))


def _refuse(faults: Sequence[Fault], spec: Spec) -> None:
    if faults:
        raise AssignmentError([as_problem(fault, spec.language) for fault in faults])


def _efforts(
    files: Iterable[Frozen], drawn: Iterable[Drawn], language: Language
) -> tuple[list[str], list[Effort | None]]:
    """The figures of the files as they now stand, and what is to be said of those that were kept."""
    remarks: list[str] = []
    efforts: list[Effort | None] = []
    for file, one in zip(files, drawn, strict=True):
        if file.state == "kept":
            remarks.append(word("variants_kept", language).format(path=file.path))
        try:
            efforts.append(effort(api.load(file.path)))
        except AssignmentError:
            remarks.append(word("variants_unchecked", language).format(id=one.student.id))
            efforts.append(None)
    return remarks, efforts


def _sharing(result: Draw, spec: Spec) -> list[str]:
    """Who has the same variant, if anybody has."""
    groups = shared(result.drawn)
    if not groups:
        return []
    head = word("variants_shared", spec.language).format(size=result.usable, students=len(result.drawn))
    lines = [
        word("variants_same", spec.language).format(
            variant=spec.label(group[0].combination), ids=", ".join(one.student.id for one in group)
        )
        for group in groups
    ]
    return [head, *lines]


def _summary(
    spreads: Sequence[Spread], drawn: Sequence[Drawn], efforts: Sequence[Effort | None], language: Language
) -> list[str]:
    known = [one for one in efforts if one is not None]
    lines = [word("variants_table", language).format(count=len(known)), *table(spreads, language)]
    for spread in spreads:
        values = {drawn[k].student.id: known[k].figure(spread.name) or 0.0 for k in spread.apart}
        if values:
            told = ", ".join(f"{id} ({shown(value)})" for id, value in values.items())
            about = {"name": word(spread.name, language), "median": shown(spread.median)}
            lines.append(word("variants_apart", language).format(ids=told, **about))
    return lines


def _csv(files: Sequence[Frozen], drawn: Sequence[Drawn], efforts: Sequence[Effort | None]) -> bytes:
    """One row a student: id, file, variant, values drawn or set, as the file now has them, and its figures."""
    places: list[Where] = list(dict.fromkeys(where for one in drawn for where in one.settings))
    rows: list[list[str | float | None]] = [["id", "file", "variant", *map(path_text, places), *FIGURES]]
    for file, one, figures in zip(files, drawn, efforts, strict=True):
        top = read_source(file.path).top
        found = (at(top, where) for where in (("variant",), *places))
        values = [node.text if isinstance(node, Scalar) else None for node in found]
        tail = [_rounded(None if figures is None else figures.figure(name)) for name in FIGURES]
        rows.append([one.student.id, file.path.name, *values, *tail])
    return write_csv(rows)


def _rounded(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.6g}")
