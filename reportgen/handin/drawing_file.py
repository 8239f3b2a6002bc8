"""Read a submitted drawing for an assignment, and return a copy with the right vectors in red."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from reportgen.base.template_folders import languages
from reportgen.base.words import common_words
from reportgen.case import Case, MachineAnalysis
from reportgen.case.answer_key import Key
from reportgen.handin import FileReading
from reportgen.handin.drawing_reader import DrawnLocation, WantedPlans, read_drawing
from reportgen.handin.dxf_corrections import RedVector, with_corrections
from reportgen.handin.dxf_lines import read_lines
from reportgen.handin.plan_labels import spoken
from reportgen.handin.plan_shapes import sketches
from reportgen.marking.feedback import cell_comment
from reportgen.marking.marking_data import Marked, Marking, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import Values
from reportgen.marking.toleranced_key import symbol_text, words_of

MARKED = "marked-sheet-{number}.dxf"
AT_FAULT = frozenset({Verdict.wrong, Verdict.implausible})


def wanted_plans(case: Case, key: Key, worlds: Sequence[Values] = ()) -> WantedPlans | None:
    """Return the plans of an assignment for all cells of its key; None if it has no plans.

    They have the case's values, and a student's own values `worlds` (SI, [1] or [N] over the positions, by id). For a
    coursework, these are the plans of its machine, whose ids have no prefix.
    """
    machines = [part for part in (case, *case.parts.values()) if isinstance(part, MachineAnalysis)]
    if not machines:
        return None
    plans = sketches(machines[0])
    ids = {plan.scale for plan in plans} | {
        end for plan in plans for vector in plan.vectors for end in (vector.start, vector.end)
    }

    def chosen(values: Values) -> Values:
        return {id: values[id] for id in ids if id in values}

    known = chosen({id: family.values for id, family in machines[0].ledger.families.items()})
    return WantedPlans(key, plans, known, tuple(map(chosen, worlds)), frozenset(_words()))


def _words() -> Iterator[str]:
    """Yield the word for “position” in every language."""
    for language in languages():
        yield spoken(str(common_words(language)["table"]["position"]))


def read(path: Path, data: bytes, key: Key, plans: WantedPlans | None) -> FileReading:
    """Return the reading of the plans in a drawing; raise `RefusedError`."""
    return read_drawing(read_lines(data, str(path)), str(path), plans or WantedPlans(key, (), {}))


def names(path: Path, data: bytes, known: Collection[str]) -> Collection[str]:
    """Return the given names that occur in a drawing as words; raise `RefusedError`."""
    text = "\n".join(text.text for text in read_lines(data, str(path)).all_texts).casefold()
    return [name for name in known if name and re.search(rf"(?<!\w){re.escape(name.casefold())}(?!\w)", text)]


def marked(path: Path, data: bytes, reading: FileReading, marking: Marking, policy: Policy) -> tuple[str, bytes]:
    """Return the name and the content of the drawing with the right vector and a comment wherever a vector is wrong.

    Without permission to show answers, only comments are written. Raises `RefusedError` if the drawing is damaged.
    """
    words = words_of(marking.key)
    said: dict[DrawnLocation, list[str]] = {}
    for cell in marking.cells:
        answer = reading.values.get((cell.id, cell.position))
        if answer is None or not isinstance(answer.location, DrawnLocation):
            continue
        # If a sheet or a report has the value too, that one counts.
        judged = (cell.id, cell.position) in marking.submission.measured
        if judged and (cell.verdict in AT_FAULT or (cell.corrected and not cell.points)):
            lines = said.setdefault(answer.location, [])
            lines.append(_comment_line(cell, marking, cell_comment(cell, marking, words, policy.show_answers)))
        elif judged and answer.location.wrong:
            said.setdefault(answer.location, [])
    for (id, position), mark in reading.beside.items():
        row = marking.key.find(id)
        if isinstance(mark, DrawnLocation) and row is not None:
            named = f"{symbol_text(row, marking.key)} ({marking.key.label(position, id)})"
            said.setdefault(mark, []).append(f"{named}: {words['drawing']['wrong']}")
    if not policy.show_answers:
        vectors = [RedVector(mark.at, None, tuple(lines), mark.space) for mark, lines in said.items() if lines]
    else:
        turned = (words["drawing"]["turned"],)
        vectors = [RedVector(mark.at, mark.right, tuple(lines) or turned, mark.space) for mark, lines in said.items()]
    units = {answer.location.unit for answer in reading.values.values() if isinstance(answer.location, DrawnLocation)}
    return MARKED, with_corrections(data, vectors, 1 / next(iter(units), 1.0))


def _comment_line(cell: Marked, marking: Marking, comment: str) -> str:
    """Return the comment on a value as one line: v_C (3): wrong …"""
    row = marking.key.row(cell.id)
    label = marking.key.label(cell.position, cell.id)
    return f"{symbol_text(row, marking.key)} ({label}): {' '.join(comment.splitlines())}"
