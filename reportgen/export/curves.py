"""Plot quantities of several files as curves over the driver's travel or over time, beside measured values."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from reportgen.assignment import Assignment
from reportgen.base.errors import Fault, Location, NotOfferedError
from reportgen.base.records import Record, replace
from reportgen.base.units import MM, Language, QuantityFault, read_number, read_unit
from reportgen.base.words import as_error, word
from reportgen.case import Case, DriverMotion
from reportgen.drawing import Content, Diagram, PlottedCurve
from reportgen.export.quantities import CaseQuantity, quantity
from reportgen.formula import Chain, Symbol
from reportgen.report.template_equations import heading_of
from reportgen.workbook import SheetCell, read

Over = Literal["phi", "time"]
POINTS = 360
"""Number of points per turn."""
AXES: Mapping[str, Over] = {"phi": "phi", "φ": "phi", "t": "time"}
"""Abscissas by the heading of a table's first column."""
_HEAD = re.compile(r"\s*(.+?)\s*(?:\(([^()]*(?:\([^()]*\)[^()]*)*)\))?\s*")
"""Head of a column: an id, and its unit in parentheses."""


def dense(assignment: Assignment, count: int = POINTS) -> Assignment:
    """Return an assignment with `count` positions per turn, also in its parts.

    A kind whose positions are not counted per turn is returned unchanged.
    """
    from reportgen import catalogue

    def counted(assignment: Assignment) -> Assignment:
        return assignment.with_positions(count) if catalogue.kind(assignment.kind).counts_positions else assignment

    parts = tuple(replace(part, alone=counted(part.alone)) for part in assignment.parts)
    return replace(counted(assignment), parts=parts)


class Measured(Record):
    """A column of a table of measured values of one quantity.

    The `values` (SI) [N] belong to `x` [N]: an angle (rad) or a time (s).
    """

    id: str
    over: Over
    x: np.ndarray
    values: np.ndarray
    name: str


def check_turning(cases: Sequence[Case]) -> None:
    """Raise `NotOfferedError` for a case that was opened for single instants and cannot go through its cycle."""
    for case in cases:
        if any(one.fault() for one in case.parts.values() or [case]):
            raise NotOfferedError(word("no_turn", cases[0].assignment.language, text=case.assignment.id))


def diagrams(
    cases: Sequence[Case], of: Sequence[str], over: Over = "phi", measured: Sequence[Measured] = ()
) -> dict[str, Diagram]:
    """Return a diagram for each unit of the quantities, by the ids that it shows, with a curve for each case.

    Raise `UnknownNameError`, or `NotOfferedError` for a quantity that is not a curve.
    """
    by_unit: dict[tuple[str, bool], list[str]] = {}
    for id in dict.fromkeys(quantity(cases[0], one).id for one in of):
        reference = quantity(cases[0], id)
        slides = reference.over(cases[0].assignment.language).slides
        by_unit.setdefault((reference.family.how.unit, slides), []).append(id)
    return {"-".join(ids): _diagram(cases, ids, over, measured) for ids in by_unit.values()}


def _diagram(cases: Sequence[Case], ids: Sequence[str], over: Over, measured: Sequence[Measured]) -> Diagram:
    curves = [
        curve(quantity(case, id), over, case.assignment.id if len(cases) > 1 else "", cases[0].assignment.language)
        for case in cases
        for id in ids
    ]
    first = quantity(cases[0], ids[0])
    motion = first.over(cases[0].assignment.language)
    for series in measured:
        if series.id in ids:
            symbol, how = first.case.ledger.symbol(series.id), first.case.ledger[series.id].how
            x = _across(series, over, motion, cases[0].assignment.language)
            curves.append(PlottedCurve(_labelled(symbol, series.name), x, series.values / how.scale, dots=True))
    turn = over == "phi" and not motion.slides
    return Diagram(tuple(curves), axis_across(motion, over), axis_up(first, ids), turn=turn)


def curve(source: CaseQuantity, over: Over, note: str, language: Language) -> PlottedCurve:
    """Return a quantity over the driver's travel (degrees, or mm) or over time (s), for the whole cycle.

    A `note` follows the symbol of the quantity.
    """
    motion, values = source.over(language), source.values / source.family.how.scale
    gone = motion.gone
    if not motion.slides:
        # A cycle ends where it begins.
        gone, values = np.append(gone, motion.whole), np.append(values, values[0])
    per = _speed(motion, language) if over == "time" else 1 / MM if motion.slides else math.pi / 180
    return PlottedCurve(_labelled(source.family.symbol, note), gone / per, values)


def _labelled(symbol: Symbol, name: str) -> Content:
    return Chain((symbol,), name) if name else symbol


def axis_across(motion: DriverMotion, over: Over) -> Chain:
    """Return the label of the axis of the driver's travel or of time."""
    if over == "time":
        return Chain((Symbol("t"),), "s")
    return Chain((Symbol("s" if motion.slides else "φ"),), motion.called)


def axis_up(source: CaseQuantity, ids: Sequence[str]) -> Content:
    """Return the label of the axis of the quantities.

    It has the symbol of a single quantity, the unit, and the positive direction if all have the same one.
    """
    unit, motion = source.family.how.unit, source.case.driver_motion
    directions = {motion.signed[id][1] if motion and id in motion.signed else None for id in ids}
    note, words = unit, source.case.words
    if len(directions) == 1 and (direction := directions.pop()) is not None:
        sense = heading_of(words, math.degrees(cmath.phase(direction)))
        note = str(words["figure"]["positive"]).format(title=unit, sense=sense)
    return Chain((source.family.symbol,), note) if len(ids) == 1 else note


# --- measured values --------------------------------------------------------------------------------


def _across(series: Measured, over: Over, motion: DriverMotion, language: Language) -> np.ndarray:
    """Return the abscissas of measured values [N]: degrees or seconds."""
    x = series.x
    if series.over != over:
        speed = _speed(motion, language)
        x = x * speed if over == "phi" else x / speed
    return np.degrees(x) if over == "phi" else x


def _speed(motion: DriverMotion, language: Language) -> float:
    """Return the driver's speed (rad/s or m/s); raise `NotOfferedError` if the file gives none."""
    if motion.speed is None:
        raise NotOfferedError(word("no_speed", language))
    return motion.speed


def read_measured(path: Path, case: Case, of: Sequence[str]) -> list[Measured]:
    """Return the columns of a table (CSV, XLSX) that a plot shows; headings are an id and its unit, v.E (m/s).

    The first column is phi (deg) from position 1, or t (s). Raise `AssignmentError` for a file that cannot be read and
    for a table without a plotted column.
    """
    page = read(path, case.assignment.language)[0]
    head, *rows = page.rows or ((),)
    faults: list[Fault] = []
    wanted = [quantity(case, one).id for one in of]
    measured: list[Measured] = []
    over = AXES.get(_name_and_unit(head[0])[0]) if head else None
    if over is None:
        where = head[0].location if head else Location(str(path))
        raise as_error([Fault("measured-no-axis", where)], case.assignment.language)
    x = _column(head[0], rows, 0, "rad" if over == "phi" else "s", faults)
    for place, cell in enumerate(head[1:], start=1):
        name, _ = _name_and_unit(cell)
        id = next((one for one, asked in zip(wanted, of, strict=True) if name in (one, asked)), None)
        if id is not None:
            unit = quantity(case, id).family.how.unit
            measured.append(Measured(id, over, x, _column(cell, rows, place, unit, faults), path.stem))
    if not measured:
        faults.append(Fault("measured-nothing", head[0].location, {"known": ", ".join(of)}))
    if faults:
        raise as_error(faults, case.assignment.language)
    return measured


def _name_and_unit(cell: SheetCell) -> tuple[str, str]:
    match = _HEAD.fullmatch(cell.text)
    return (match[1], match[2] or "") if match else ("", "")


def _column(
    head: SheetCell, rows: Sequence[Sequence[SheetCell]], place: int, unit: str, faults: list[Fault]
) -> np.ndarray:
    """Return the numbers of a column in SI units [N]; an empty cell gives NaN."""
    factor, given = 1.0, _name_and_unit(head)[1]
    if unit and not given:
        faults.append(Fault("missing-unit", head.location, {"text": head.text, "unit": unit}))
    elif given:
        try:
            factor = read_unit(given, unit)
        except QuantityFault as fault:
            faults.append(Fault(fault.code, head.location, fault.arguments))
    return np.array([_number(row[place], faults) if place < len(row) else math.nan for row in rows]) * factor


def _number(cell: SheetCell, faults: list[Fault]) -> float:
    if cell.blank or not cell.text.strip():
        return math.nan
    try:
        return read_number(cell.text)
    except QuantityFault as fault:
        faults.append(Fault(fault.code, cell.location, fault.arguments))
        return math.nan
