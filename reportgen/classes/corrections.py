"""The instructor's corrections, a table that is applied at each marking: `corrections.csv`.

`read_corrections` reads it, `applied` applies it. A row names a student by id, e-mail or name. It names a quantity by
id, pattern or symbol, a section, or a part of a coursework; an empty cell means the whole sheet. It names a position;
an empty cell means all. Then it gives `right`, `wrong` or the total points, and the reason. The person and the date may
be added and are shown with the reason. With a `value`, the row applies only to cells with that value. Of two rows for
one cell the later one counts. Rows that no longer fit are reported.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

from reportgen.base.chinese import narrow
from reportgen.base.errors import Fault, Location, Problem
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import languages
from reportgen.base.timestamps import moment
from reportgen.base.typed_characters import plain_signs
from reportgen.base.units import NUMBER, Language, write
from reportgen.base.words import as_error, as_problem, close_or_known, common_words, messages, word
from reportgen.case.answer_key import Key, headed_chapters
from reportgen.classes.roster import RosterRow, columns, comparable, folded, folder_name, heading_row, records
from reportgen.document import InlineMath, Inlines, Text
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.marking_data import Amendment, Marked, Marking, Verdict, points_of
from reportgen.marking.toleranced_key import symbol_text, words_of
from reportgen.workbook import read

NEEDED = ("judgement", "reason")
"""Columns that each row must fill in, in addition to the student's."""
SIGNED, DATED = "judged_by", "judged_on"
"""Optional columns for the person and the date of a correction."""


class Correction(Record):
    """A row: student, quantity and position as typed.

    `judgement` is right, wrong or a number of points; `locations` are those of its cells.
    """

    who: str
    quantity: str
    position: str
    judgement: Verdict | float
    reason: str
    value: str
    locations: Mapping[str, Location]
    signed: tuple[str, ...] = ()
    """The person and the date of the correction, as typed."""

    def reason_in(self, language: Language) -> str:
        """Return the reason with the person and the date."""
        if not self.signed:
            return self.reason
        return word("correction_signed", language, reason=self.reason, signed=", ".join(self.signed))


def read_corrections(path: Path, language: Language | None = None) -> tuple[Correction, ...]:
    """Return the rows of a table, CSV or XLSX; raise `AssignmentError` with all its faults, located."""
    for page in read(path, language):
        head = heading_row(page, "reason")
        if head is None or page.hidden:
            continue
        faults: list[Fault] = []
        headed = columns(page.rows[head])
        names = {column.name for column in headed}
        who = next((name for name in ("id", "email", "name") if name in names), "id")
        lacking = [name for name in (who, *NEEDED) if name not in names]
        faults += [Fault("correction-column", headed[0].location, {"key": name}) for name in lacking]
        rows = [] if lacking else list(records(page, headed, head + 1, faults))
        made = [_correction(row, who, faults) for row in rows]
        if faults:
            raise as_error(faults, language)
        return tuple(one for one in made if one is not None)
    raise as_error([Fault("correction-column", Location(str(path)), {"key": "reason"})], language)


def _correction(row: RosterRow, who: str, faults: list[Fault]) -> Correction | None:
    texts = {name: " ".join(value.text.split()) for name, value in row.values.items()}
    lacking = [name for name in (who, *NEEDED) if not texts.get(name) and name not in row.refused]
    faults += [Fault("correction-lacks", row.cells.get(name, row.location), {"key": name}) for name in lacking]
    judgement = None if "judgement" in lacking else _judgement(texts.get("judgement", ""))
    if judgement is None and "judgement" in texts:
        faults.append(Fault("correction-judgement", row.cells["judgement"], {"text": texts["judgement"]}))
    if (date := texts.get(DATED)) and moment(date) is None:
        faults.append(Fault("moment", row.cells[DATED], {"text": date}))
    if judgement is None or lacking:
        return None
    quantity, position, value = (texts.get(name, "") for name in ("quantity", "position", "value"))
    locations = {name: row.cells.get(name, row.location) for name in ("quantity", "position", "judgement", "value")}
    locations["who"] = row.cells[who]
    signed = tuple(texts[name] for name in (SIGNED, DATED) if texts.get(name))
    return Correction(
        texts[who], quantity, position, judgement, texts["reason"], value=value, locations=locations, signed=signed
    )


def _judgement(text: str) -> Verdict | float | None:
    if verdict := _verdicts().get(folded(text)):
        return verdict
    plain = plain_signs(narrow(text)).strip().replace(",", ".")
    return float(plain) if re.fullmatch(NUMBER, plain) and math.isfinite(float(plain)) else None


@cache
def _verdicts() -> Mapping[str, Verdict]:
    """Return right and wrong by their words in every language."""
    return {
        word: verdict
        for language in languages()
        for verdict in (Verdict.right, Verdict.wrong)
        for word in messages(language)["judgements"][verdict]
    }


# --- applied ----------------------------------------------------------------------------------------


def applied(
    markings: Sequence[Marking], keys: Iterable[Key], corrections: Iterable[Correction], language: Language | None
) -> tuple[list[Marking], list[Problem]]:
    """Return the markings with all corrections; one that no longer fits is skipped and reported at its location."""
    by_id = {marking.key.id: marking for marking in markings}
    known = list(keys)
    problems: list[Problem] = []
    for correction in corrections:
        ids = [key.id for key in known if _is_of(correction.who, key)]
        about = correction.locations["who"], {"text": correction.who}
        if len(ids) != 1:
            problems.append(as_problem(Fault("correction-nobody", *about), language))
        elif (marking := by_id.get(ids[0])) is None:
            problems.append(as_problem(Fault("correction-no-sheet", *about), language))
        elif isinstance(made := corrected(marking, correction), Fault):
            problems.append(as_problem(made, language))
        else:
            if _verdicts_of(made) == _verdicts_of(marking):
                idle = Fault("correction-idle", correction.locations["judgement"])
                problems.append(as_problem(idle, language, "warning"))
            by_id[ids[0]] = made
    return [by_id[marking.key.id] for marking in markings], problems


def _verdicts_of(marking: Marking) -> list[tuple[Verdict, float]]:
    return [(cell.verdict, cell.points) for cell in marking.cells]


def _is_of(who: str, key: Key) -> bool:
    """Return True if an id, the stem of a file, an e-mail or a full name is that of the student of a key."""
    id = key.student.get("id", key.id)
    names = {comparable(one) for one in (key.id, id, folder_name(id), key.student.get("email", "")) if one}
    return comparable(who) in names or folded(who) == folded(key.student.get("name", ""))


def corrected(marking: Marking, correction: Correction) -> Marking | Fault:
    """Return the marking with one correction, or a fault that says why it does not fit the sheet."""
    named = _named(marking.key, correction.quantity)
    if named is None:
        names = [symbol_text(row, marking.key) for row in marking.key.asked] + [row.id for row in marking.key.asked]
        close = close_or_known(correction.quantity, names).get("close", "")
        about = {"text": correction.quantity, **({"close": close} if close else {})}
        return Fault("correction-no-quantity", correction.locations["quantity"], about)
    what, belongs = named
    wanted = correction.position.casefold()
    cells = [
        cell
        for cell in marking.cells
        if belongs(cell.id)
        and (not wanted or (cell.position and marking.key.label(cell.position, cell.id).casefold() == wanted))
    ]
    if not cells:
        text = correction.position or correction.quantity
        return Fault("correction-no-cell", correction.locations["position" if wanted else "quantity"], {"text": text})
    worth = points_of(cells)[1]
    if correction.value and (present := _other_value(marking, cells, correction.value)) is not None:
        about = {"text": correction.value, "found": present}
        return Fault("correction-value", correction.locations["value"], about)
    points = correction.judgement
    if isinstance(points, float) and not 0 <= points <= worth + 1e-9:
        most = {"text": f"{points:g}", "most": f"{worth:g}"}
        return Fault("correction-points", correction.locations["judgement"], most)
    reason = correction.reason_in(marking.key.language)
    places = {(cell.id, cell.position): _judged(cell, points, worth, reason) for cell in cells}
    label = (*what, Text(f" ({correction.position})")) if wanted else what
    return replace(
        marking,
        cells=tuple(places.get((cell.id, cell.position), cell) for cell in marking.cells),
        amendments=(*marking.amendments, Amendment(label, frozenset(places), reason)),
    )


def _named(key: Key, text: str) -> tuple[Inlines, Callable[[str], bool]] | None:
    """Return the name of the quantities that a text means and a test for their ids; None if it matches nothing."""
    if not text:
        return (Text(words_of(key)["feedback"]["whole"]),), lambda id: True
    rows = [row for row in key.rows if text in (row.id, symbol_text(row, key))]
    if rows:
        ids = {row.id for row in rows}
        return (InlineMath(rows[0].symbol),), ids.__contains__
    if any(fnmatchcase(row.id, text) for row in key.rows):
        return (Text(text),), lambda id: fnmatchcase(id, text)
    part = next((one for one in key.parts if folded(text) in (folded(one.name), folded(one.title))), None)
    if part is not None:
        return (Text(part.title),), lambda id: key.owner(id) == part.name
    own: Mapping[str, str] = words_of(key)["parts"]
    chapter = next((one for one in headed_chapters() if folded(text) in {*_titles(one), folded(own[one])}), None)
    if chapter is not None:
        return (Text(own[chapter]),), lambda id: key.row(id).part is chapter
    return None


@cache
def _titles(chapter: KeyChapter) -> frozenset[str]:
    """Return the names of a section: its own name, and its title in every language."""
    tables = [common_words(language)["parts"] for language in languages()]
    return frozenset({str(chapter), *(folded(table[chapter]) for table in tables)})


def _other_value(marking: Marking, cells: Iterable[Marked], value: str) -> str | None:
    """Return the text of the first cell that does not have a value, as typed; None if all have it."""
    for cell in cells:
        answer = marking.submission.values.get((cell.id, cell.position))
        if answer is None:
            return "–"
        plain = write(answer.value, None, marking.key.language)
        if value not in (" ".join(answer.text.split()), plain, f"{answer.value:g}"):
            return answer.text.strip()
    return None


def _judged(cell: Marked, judgement: Verdict | float, worth: float, reason: str) -> Marked:
    """Return a cell as the instructor judges it; points for several cells are shared in proportion to their worth."""
    if isinstance(judgement, Verdict):
        points = cell.worth if judgement is Verdict.right else 0.0
        verdict = judgement
    else:
        share = judgement / worth if worth else 0.0
        points = cell.worth * share
        verdict = {0.0: Verdict.wrong, 1.0: Verdict.right}.get(round(share, 9), cell.verdict)
    still = cell.first and verdict is Verdict.wrong
    judged = replace(cell, verdict=verdict, points=points, first=still, corrected=reason)
    return judged if still else replace(judged, mistake="", where="")
