"""The answer key: every quantity of a report at every position, with the bands within which it is right.

Its rows are the ledger's own families, so key, report and marker cannot disagree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from reportgen.answers.bands import computed_bands, drawn_bands, is_chosen_length, is_round_scale
from reportgen.answers.trapezoid import is_workable, trapezoid_errors
from reportgen.answers.wording import MAGNITUDE, is_open, phrase, positive_sense
from reportgen.case import Calculation, Opened
from reportgen.document.key import INSTANT, Key, Role, Row, Span
from reportgen.document.report import Report
from reportgen.ledger.core import Ledger
from reportgen.notation import ids
from reportgen.notation.expressions import Number, refs
from reportgen.notation.numbers import significant_decimals
from reportgen.notation.plain import formula
from reportgen.notation.sheet import Family, is_short
from reportgen.notation.vocabulary import MAX_DIGITS, Chapter
from reportgen.words import load_words, search_path


def words_of(key: Key) -> Mapping[str, Any]:
    """The words of a key's language and machine."""
    return load_words(search_path(key.language, key.kind))


def symbol_text(row: Row, key: Key) -> str:
    """A quantity's symbol in one line of plain text, e.g. v_BA."""
    return formula(row.symbol, key.language)


def shown_number(row: Row, value: float) -> Number:
    """A number of a row as the report prints it: to its decimals, or without the dust of floats."""
    return Number(value if row.decimals is not None else float(f"{value:.12g}"), row.decimals)


def machine_key(case: Calculation) -> Key:
    """The key of a machine, over all positions of its cycle."""
    machine, report = case.analysis.machine, Report(case)
    labels = tuple(str(machine.position(k)) for k in range(1, machine.positions + 1))
    printed = report.all_positions if report.thinned else ()
    span = Span(labels, machine.count, tuple(case.assignment.worked_positions), printed)
    return make_key(case, case.ledger, span, lambda id: positive_sense(id, report))


def make_key(case: Opened, ledger: Ledger, span: Span = INSTANT, sense_of: Callable[[str], str] = lambda id: "") -> Key:
    """The key of an assignment from the ledger that its report prints, over the positions of its `span`.

    `sense_of` a quantity is which sense of it counts as positive, in words; without it all are sizes.
    """
    assignment, words, worked = case.assignment, case.words, span.worked
    by_rule = trapezoid_errors(ledger)
    on_paper, by_rounding = drawn_bands(ledger), computed_bands(ledger)
    complete = set(worked) == set(range(1, len(span.labels) + 1))

    def row(id: str) -> Row:
        family = ledger[id]
        scale = family.how.scale
        values = np.array([family.at(k + 1).real for k in range(len(family.values))])
        sense = sense_of(id)
        if family.is_direction:
            # A vector of no length has none.
            exists = [ledger[family.of].at(k + 1) != 0 for k in range(len(values))]
            values = np.where(exists, np.abs(values), np.nan)
        if family.arm:
            values = np.abs(values)
        role = _role(ledger, family)
        part = Chapter.data if role is Role.given and len(values) == 1 else family.chapter
        # What is read from a diagram can be worked out on paper, an integral over the cycle cannot.
        integral = family.definition is None or ids.rest(id) in ledger
        workable = id != "M.difference" and (len(values) > 1 or not integral)
        workable = workable and (part is not Chapter.cycle or complete) and is_workable(ledger, id, by_rule)
        asked = (role is Role.scale and not is_round_scale(family)) or (role is Role.asked and workable)
        return Row(
            id=id,
            part=part,
            role=role,
            symbol=family.symbol,
            kind=family.kind,
            unit=ledger.units.get(family.how.unit, family.how.unit),
            decimals=_decimals(ledger.decimals[id], values / scale),
            values=values / scale,
            drawn=on_paper[id] / scale,
            computed=by_rounding[id] / scale,
            positions=_asked_at(values, worked, span.count, family.kind == "force scale") if asked else (),
            sense=tuple(_sense(family, value, words["sense"]) for value in values),
            size=family.of if family.is_signed_rotation else "",
            what=phrase(id, ledger, words),
            positive=words["magnitude"] if sense == MAGNITUDE else sense,
            open_sense=is_open(values, sense),
        )

    parts, families = list(Chapter), ledger.families.values()
    # No rows for points, optional quantities and the sizes of signed rotations.
    shown = (one.id for one in families if not (one.hidden or one.is_plane or one.optional or one.id in ledger.signed))
    rows = sorted([row(id) for id in shown], key=lambda row: parts.index(row.part))
    student = assignment.report.student
    fields = {"name": student.name, "id": student.id, "class": student.class_}
    return Key(
        id=assignment.id,
        kind=assignment.kind,
        variant=assignment.variant,
        language=assignment.language,
        student={name: text for name, text in fields.items() if text},
        labels=span.labels,
        rows=tuple(rows),
        printed=span.printed,
    )


def _role(ledger: Ledger, family: Family) -> Role:
    if is_chosen_length(ledger, family) or family.kind.endswith("scale"):
        return Role.scale
    typed = family.exact if family.definition is None else not refs(family.definition)
    return Role.given if typed else Role.asked


def _decimals(of_ledger: int | None, values: np.ndarray) -> int | None:
    """The ledger's; data of several positions that are exact but endless, such as 129.128571…°, get 6 figures."""
    if of_ledger is not None or len(values) == 1 or is_short(values):
        return of_ledger
    return significant_decimals(float(np.nanmax(np.abs(values))), MAX_DIGITS)


def _asked_at(values: np.ndarray, worked: tuple[int, ...], count: int, chosen: bool) -> tuple[int, ...]:
    """The worked positions; what repeats from turn to turn (all kinematics) is asked for in the first turn.

    What is `chosen` at each position, as a scale, may be another one though the report has the same.
    """
    if len(values) == 1:
        return (0,)
    turns = np.reshape(values, (-1, count)) if len(values) > count else np.empty((0, count))
    repeats = not chosen and len(turns) > 0 and np.allclose(turns, turns[0], rtol=1e-9, atol=1e-12, equal_nan=True)
    asked = ((k - 1) % count + 1 if repeats else k for k in worked)
    return tuple(dict.fromkeys(k for k in asked if np.isfinite(values[k - 1])))


def _sense(family: Family, value: float, words: Mapping[str, str]) -> str:
    """The sense of a rotation in words; "" for any other quantity."""
    if not family.is_signed_rotation:
        return ""
    return words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"]
