"""Earlier draws recorded in `variants.csv`: students whose variant was redrawn, and students who have left the class.

Both are needed permanently: the others keep their variants only while the first variants count as taken.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from reportgen.base.errors import Location, UnknownNameError
from reportgen.base.records import Record, field, replace
from reportgen.base.units import Language
from reportgen.base.words import unknown
from reportgen.classes.roster import Roster, RosterEntry, comparable
from reportgen.workbook import read

REDRAWN, DROPPED = "redrawn", "dropped"
"""Columns: the number of the redrawn combination, from 1; a mark for students who have left."""
MARKED = "x"


class EarlierDraw(Record):
    """The students of an earlier table in its order, by `comparable` id, with the numbers and marks of its columns."""

    students: Mapping[str, RosterEntry] = field(default_factory=dict)
    redrawn: Mapping[str, int] = field(default_factory=dict)
    dropped: frozenset[str] = frozenset()

    def with_dropped(self, wanted: Sequence[str], roster: Roster, language: Language) -> EarlierDraw:
        """Return the same with further students who have left; raise `UnknownNameError` for an unknown one."""
        known = dict(self.students) | {comparable(student.id): student for student in roster.students}
        return replace(self, dropped=self.dropped | set(_known(wanted, known, language)))

    def whole(self, roster: Roster) -> Roster:
        """Return the roster including the students who have left and are no longer listed, at their old places."""
        present = [comparable(student.id) for student in roster.students]
        order = list(self.students)
        students: list[RosterEntry] = []
        gone = [id for id in order if id in self.dropped and id not in present]
        for id, student in zip(present, roster.students, strict=True):
            at = order.index(id) if id in self.students else len(order)
            before = [one for one in gone if order.index(one) < at]
            students += (self.students[one] for one in before)
            gone = gone[len(before) :]
            students.append(student)
        students += (self.students[one] for one in gone)
        return replace(roster, students=tuple(students))


def read_earlier(table: Path, language: Language | None) -> EarlierDraw:
    """Return the data of an earlier table, empty if there is none; raise `AssignmentError` if it cannot be read."""
    if not table.exists():
        return EarlierDraw()
    rows = [row for page in read(table, language) for row in page.rows]
    head = {cell.text: number for number, cell in enumerate(rows[0])} if rows else {}
    students: dict[str, RosterEntry] = {}
    redrawn: dict[str, int] = {}
    dropped: set[str] = set()
    for row in rows[1:]:
        said = {name: row[number].label.strip() for name, number in head.items() if number < len(row)}
        if not (id := said.get("id", "")):
            continue
        key = comparable(id)
        card = {name: said[name] for name in ("id", "name") if said.get(name)}
        students[key] = RosterEntry(card, {}, Location(str(table)))
        if said.get(REDRAWN, "").isdecimal():
            redrawn[key] = int(said[REDRAWN])
        if said.get(DROPPED):
            dropped.add(key)
    return EarlierDraw(students, redrawn, frozenset(dropped))


def students_named(wanted: Sequence[str], roster: Roster, language: Language) -> frozenset[str]:
    """Return the `comparable` ids of students of the roster; raise `UnknownNameError` for an unknown one."""
    known = {comparable(student.id): student for student in roster.students}
    return frozenset(_known(wanted, known, language))


def _known(wanted: Sequence[str], known: Mapping[str, RosterEntry], language: Language) -> Collection[str]:
    """Return the ids of students given by id, e-mail or name; raise `UnknownNameError` for an unknown one."""
    ids_found: list[str] = []
    for text in wanted:
        ids = [id for id, student in known.items() if id == comparable(text)]
        ids = ids or [
            id
            for id, student in known.items()
            if comparable(text) in {comparable(student.card.get(name, "")) for name in ("email", "name")}
        ]
        if len(ids) != 1:
            raise UnknownNameError(unknown("no_student", text, [one.id for one in known.values()], language))
        ids_found += ids
    return ids_found
