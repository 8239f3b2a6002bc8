"""Make the answer key (`key_of`): every quantity of a report at every position, with its tolerance bands.

Its rows are the families of the ledger, so that key, report and marking always agree. `Ask` selects the cells that an
answer sheet requests.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from reportgen.assignment.reading import placed
from reportgen.base.errors import Finding
from reportgen.base.records import Record, replace, uncompared
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import as_error, close_or_known, load_words
from reportgen.base.yaml_source import read_source
from reportgen.case import Case, CaseOfParts
from reportgen.case.answer_key import Key, KeyRow, Role, headed_chapters
from reportgen.case.quantity_wording import BY_FORMULA, OPEN, definition_of, phrase
from reportgen.formula import Expression, Number, ids, refs, substitute
from reportgen.formula.calculation import Family
from reportgen.formula.ledger import Ledger
from reportgen.formula.plain_text import formula
from reportgen.formula.vocabulary import KINDS, KeyChapter
from reportgen.marking.tolerance_bands import (
    computed_bands,
    drawn_bands,
    is_chosen_length,
    is_round_scale,
    is_workable,
    plans_read,
    trapezoid_errors,
)


def words_of(key: Key) -> Mapping[str, Any]:
    """Return the words of a key's language and machine."""
    return load_words(search_path(key.language, key.kind))


def symbol_text(row: KeyRow, key: Key) -> str:
    """Return a quantity's symbol in one line of plain text, for example v_BA."""
    return formula(row.symbol, key.language)


def typed_unit(row: KeyRow) -> str:
    """Return the unit assumed for a number typed without one, by its parser name; "" for a pure number."""
    return KINDS[row.kind].unit


def shown_number(row: KeyRow, value: float) -> Number:
    """Return a number as the report prints it in this row: to its decimals, or without floating-point noise."""
    return Number(value if row.decimals is not None else float(f"{value:.12g}"), row.decimals)


def key_of(case: Case) -> Key:
    """Return the key of a case from its ledger, both unrounded and as printed, over the positions of its span."""
    if isinstance(case, CaseOfParts):
        return case.joined_key([key_of(part) for part in case.parts.values()])
    ledger, printed, span = case.ledger, case.printed, case.span
    assignment, words, worked = case.assignment, case.words, span.worked
    by_rule = trapezoid_errors(ledger)
    on_paper, by_rounding, read = drawn_bands(ledger), computed_bands(ledger), plans_read(ledger)
    complete = set(worked) == set(range(1, len(span.labels) + 1))

    def row(id: str) -> KeyRow:
        family = ledger[id]
        scale = family.how.scale
        values, written = _values(ledger, id), _values(printed, id)
        sense = case.sense(id)
        # The component of a reaction on a link without loads is zero by definition: neither given nor asked for.
        nothing = family.definition is not None and not refs(family.definition) and not values.any()
        role = Role.asked if nothing else _role(ledger, family)
        part = KeyChapter.data if role is Role.given and len(values) == 1 else family.chapter
        # A value read from a diagram can be computed on paper; an integral over the cycle cannot.
        integral = family.definition is None or ids.rest(id) in ledger
        reached = part is not KeyChapter.cycle or complete
        workable = not family.residue and (len(values) > 1 or not integral) and is_workable(ledger, id, by_rule)
        chosen = role is Role.scale and not is_round_scale(family)
        # A length that a part of a coursework gives is asked for there.
        computed = role is Role.asked and workable and not (nothing or family.from_part)
        asked = reached and (chosen or computed)
        return KeyRow(
            id=id,
            part=part,
            role=role,
            symbol=family.symbol,
            kind=family.kind,
            unit=ledger.units.get(family.how.unit, family.how.unit),
            decimals=printed.decimals[id],
            values=values / scale,
            printed=written / scale,
            drawn=on_paper[id] / scale,
            computed=by_rounding[id] / scale,
            positions=_asked_at(values, worked, span.count, family.kind == "force scale") if asked else (),
            sense=tuple(_sense(family, value, words["sense"]) for value in values),
            size=family.of if family.is_signed_rotation else "",
            what=phrase(id, ledger, words),
            positive=words["signs"].get(sense, sense),
            open_sense=is_open(values, sense),
            plans=tuple(sorted(read[id])) if role is Role.asked else (),
            by_rule=part is KeyChapter.cycle and bool(np.any(by_rule.get(id, 0.0))),
            formula=formula_in_symbols(ledger, id) if sense in BY_FORMULA else None,
        )

    parts, families = list(KeyChapter), ledger.families.values()
    # No rows for points, optional quantities, steps of iterations and the sizes of signed rotations.
    seen = (one for one in families if not (one.hidden or one.is_plane or one.optional or one.trial))
    visible = (family.id for family in seen if family.id not in ledger.signed)
    rows = sorted([row(id) for id in visible], key=lambda row: parts.index(row.part))
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


def _values(ledger: Ledger, id: str) -> np.ndarray:
    """Return the values of a quantity (SI) as a key stores them; directions and arms are absolute values."""
    family = ledger[id]
    values = np.array([family.at(k + 1).real for k in range(len(family.values))])
    if family.is_of_vector:
        # A vector of length zero has no direction.
        exists = [ledger[family.of].at(k + 1) != 0 for k in range(len(values))]
        values = np.where(exists, values, np.nan)
    return np.abs(values) if family.arm or family.is_direction else values


def _asked_at(values: np.ndarray, worked: tuple[int, ...], count: int, chosen: bool) -> tuple[int, ...]:
    """Return the worked positions; values that repeat from turn to turn (all kinematics) are asked in the first turn.

    A quantity `chosen` at each position, such as a scale, may differ between turns even if the report repeats it.
    """
    if len(values) == 1:
        return (0,)
    turns = np.reshape(values, (-1, count)) if len(values) > count else np.empty((0, count))
    repeats = not chosen and len(turns) > 0 and np.allclose(turns, turns[0], rtol=1e-9, atol=1e-12, equal_nan=True)
    asked = ((k - 1) % count + 1 if repeats else k for k in worked)
    return tuple(dict.fromkeys(k for k in asked if np.isfinite(values[k - 1])))


def _sense(family: Family, value: float, words: Mapping[str, str]) -> str:
    """Return the sense of a rotation in words; "" for any other quantity."""
    if not family.is_signed_rotation:
        return ""
    return words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"]


def formula_in_symbols(ledger: Ledger, id: str) -> Expression:
    """Return the definition of a quantity in symbols."""
    return substitute(definition_of(ledger, id), lambda ref: ledger.symbol(ref.id))


def is_open(values: np.ndarray, sense: str) -> bool:
    """Return True if the papers leave the sign of values [N] open: some are negative and no words explain the sign."""
    return sense in OPEN or (not sense and bool(np.nanmin(values, initial=0.0) < 0))


# --- what an answer sheet asks for ----------------------------------------------------------------
# Everything that can be computed, or a selection of it by sections and ids.
# The key always has every quantity; a selection only removes cells to be filled in.

NOT = "-"
"""Prefix of a pattern that excludes rows."""

DEFAULT = (
    "*",
    # Results of drawing: lengths and angles on paper, scales, arms.
    *("-drawn.*", "-seg.*", "-mu.*", "-h.*", "-ic.*"),
    # Second methods for the same result.
    *("-formulas", "-l.*K[0-9]*", "-e.Pqt*", "-M.*.p", "-T.*", "-J.I", "-J.0", "-J.rest", "-psi.*"),
    *("-run.Mc*", "-run.slip*", "-run.step", "-run.mean*"),
    # Values read from a force plan in addition to the size of a reaction.
    *("-dir.R*", "-R.*.n", "-x.*"),
    # The components of what balances a machine, and the rules that are only compared.
    *("-balance.[PMr].*", "-balance.rod.*", "-balance.*.x", "-balance.*.y", "-balance.*.[a-z]*[a-z]"),
    *("balance.F.?", "balance.F.dir", "balance.after.*"),
)
"""Default selection unless a policy overrides it: the results, not how they were drawn or checked."""

EVERYTHING = ("*",)


@uncompared("file")
class Ask(Record):
    """A selection of sections and ids by patterns; the last matching pattern decides, and "-" excludes.

    A selection that begins with an exclusion is applied to `DEFAULT`. `by_section` puts each section of the printed
    sheet on separate pages. `self_check` lets students compare the sheet with their data. `file` is the policy that
    defines the patterns, or None.
    """

    patterns: tuple[str, ...] = DEFAULT
    by_section: bool = False
    self_check: bool = True
    file: Path | None = None

    def __str__(self) -> str:
        by_section = ("by section",) if self.by_section else ()
        return ", ".join((*self.patterns, *by_section, *(() if self.self_check else ("no self-check",))))

    def wants(self, row: KeyRow) -> bool:
        """Return True if the selection includes a row."""
        wanted = False
        for pattern in _whole(self.patterns):
            if _fits(pattern, row):
                wanted = not pattern.startswith(NOT)
        return wanted

    def of(self, key: Key, also: Container[str] = ()) -> Key:
        """Return the key with the selected cells, and those of the rows whose ids are in `also`."""
        rows = (row if row.id in also or self.wants(row) else replace(row, positions=()) for row in key.rows)
        return replace(key, rows=tuple(rows))

    def on_paper(self, key: Key) -> Key:
        """Return the key as a student gets it: with the scales of all plans that a requested value is read from.

        These scales may be left empty and earn no points; measured values are judged with them.
        """
        chosen = self.of(key)
        plans = {plan for row in chosen.asked for plan in row.plans}
        optional = words_of(key)["signs"]["optional"]
        rows = (
            replace(row, positive="; ".join(filter(None, (row.positive, optional))))
            if row.id in plans and not self.wants(row)
            else row
            for row in key.rows
        )
        return self.of(replace(key, rows=tuple(rows)), plans)

    def check(self, keys: Iterable[Key], language: Language | None = None) -> None:
        """Raise `AssignmentError`, located in the policy, for patterns that match nothing in any of the keys.

        The iterable of keys is consumed only as far as needed.
        """
        if self.file is None:
            return
        left = {
            index: pattern
            for index, pattern in enumerate(self.patterns)
            if pattern.removeprefix(NOT) not in headed_chapters()
        }
        known: dict[str, None] = dict.fromkeys(headed_chapters())
        tried = False
        for key in keys if left else ():
            tried = True
            known |= dict.fromkeys(row.id for row in key.asked)
            left = {
                index: pattern for index, pattern in left.items() if not any(_fits(pattern, row) for row in key.asked)
            }
            if not left:
                return
        findings = [
            Finding("ask-fits-nothing", ("ask", index), _about(pattern, list(known))) for index, pattern in left.items()
        ]
        if tried and findings:
            raise as_error(placed(read_source(self.file), findings), language)


def _fits(pattern: str, row: KeyRow) -> bool:
    """Return True if a pattern, without its `NOT`, is the section of a row or matches its id."""
    bare = pattern.removeprefix(NOT)
    return bare == row.part or (bare not in headed_chapters() and fnmatchcase(row.id, bare))


def _about(pattern: str, known: Sequence[str]) -> dict[str, str]:
    """Return the arguments of the error about a pattern without a match: the closest known name, or the sections."""
    close = close_or_known(pattern.removeprefix(NOT), known)
    return {"text": pattern, **(close if "close" in close else {"known": ", ".join(headed_chapters())})}


def _whole(patterns: Sequence[str]) -> Sequence[str]:
    return (*DEFAULT, *patterns) if patterns and patterns[0].startswith(NOT) else patterns
