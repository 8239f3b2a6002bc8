"""Read a Word report: its headings give the current position, its lines and tables the values there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.case.answer_key import Key, KeyRow
from reportgen.handin import FileReading
from reportgen.handin import text_statements as said
from reportgen.handin.entry_collection import Gathering
from reportgen.handin.symbol_matching import Symbols
from reportgen.handin.text_numbers import marks_of
from reportgen.handin.text_statements import Statement
from reportgen.handin.word_blanks import read_blanks
from reportgen.handin.word_nodes import XmlNode
from reportgen.handin.word_tables import read_table
from reportgen.handin.word_text import OBJECT, TextGrid, TextLine, WordBlock, WordLocation

FREE = 10
"""Level of a position that no heading gives; any heading ends it."""
SHORT = 80
"""Largest number of characters of a line in bold that serves as a heading."""


@dataclass(slots=True)
class _Hand:
    """The current position: its label, None if it is in doubt, and the level of the heading that gives it."""

    label: str | None = None
    level: int = FREE


def read_report(blocks: Sequence[WordBlock], key: Key, file: str, tree: XmlNode | None = None) -> FileReading:
    """Return the values of a key's quantities in a report; its `tree` is searched for the blanks of a blank report."""
    marks = marks_of((line.text for line in lines_of(blocks)), key.language)
    gathering = Gathering(key, file, marks, Symbols(key, key.rows))
    if tree is not None:
        read_blanks(tree, lines_of(blocks), gathering)
    reader = _Reader(gathering)
    for block in blocks:
        reader.block(block)
    reader.objects()
    return gathering.reading()


def lines_of(blocks: Sequence[WordBlock]) -> list[TextLine]:
    """Return all lines, including those of tables."""
    lines: list[TextLine] = []
    for block in blocks:
        if isinstance(block, TextLine):
            lines.append(block)
        else:
            for cell in dict.fromkeys(cell for row in block.rows for cell in row):
                lines += lines_of(cell.blocks)
    return lines


class _Reader:
    """Reads a report from top to bottom."""

    def __init__(self, gathering: Gathering) -> None:
        self.gathering = gathering
        self.hand = _Hand()
        self.open: tuple[KeyRow, str | None] | None = None
        """The row whose statement may continue in the next line, and the label of its position."""
        self.hidden: dict[str | None, int] = {}
        """Number of equations at each position that cannot be opened."""
        self.first_object: WordLocation | None = None

    def block(self, block: WordBlock) -> None:
        if isinstance(block, TextGrid):
            read_table(block, self.gathering, self.statement_line, self.hand.label)
            return
        text = block.text
        if block.level:
            self.heading(block)
        elif not said.RELATION.search(text):
            self.sentence(block)
        else:
            self.statement_line(block, self.hand.label)
            self.opened_by(text)

    # --- the current position ---------------------------------------------------------------------

    def heading(self, line: TextLine) -> None:
        labels = said.labels_in(line.text)
        self.open = None
        if said.names_several(line.text):
            self.hand = _Hand(None, min(line.level, self.hand.level))
        elif labels:
            self.hand = _Hand(labels[0], line.level)
        elif line.level <= self.hand.level:
            self.hand = _Hand()

    def sentence(self, line: TextLine) -> None:
        """Process a line without “=”: it may name the position of the next ones, or begin something else."""
        text = line.text
        self.count_objects(line, self.hand.label)
        self.otherwise(line, self.hand.label)
        if not text.strip():
            return
        if OBJECT not in text:
            self.open = None
        labels = said.labels_in(text)
        compared = said.is_compared(text)
        if said.names_several(text):
            # The current position stays if a heading gave it and this line only compares.
            if (not compared and not said.begins_with(text, self.hand.label)) or self.hand.level == FREE:
                self.hand = _Hand(None, self.hand.level)
        elif labels and compared:
            return
        elif labels:
            self.hand = _Hand(labels[0], FREE)
        elif said.names_another(text) or (line.bold and len(text) < SHORT and not said.names_chapter(text)):
            self.hand = _Hand()

    def opened_by(self, text: str) -> None:
        """Process the beginning of a line with statements, which may name the position of the next ones too."""
        front = said.RELATION.split(text)[0]
        labels = said.labels_in(front)
        if len(labels) == 1 and not said.names_several(front) and labels[0] != self.hand.label:
            # Under the heading of another position, it is unclear if the position continues.
            self.hand = _Hand(labels[0] if self.hand.label is None or self.hand.level == FREE else None, FREE)

    # --- statements -------------------------------------------------------------------------------

    def statement_line(self, line: TextLine, label: str | None) -> None:
        """Read all statements of a line; those without a position belong to the one with the `label`."""
        gathering, text = self.gathering, line.text
        self.count_objects(line, label)
        self.otherwise(line, label)
        made = said.statements(text, gathering.symbols)
        if said.goes_on(text):
            end = made[0].at - len(made[0].symbol) if made else len(text)
            if self.open is not None:
                row, own = self.open
                self.open = None
                first = Statement("", "", "", text[: max(end, 0)], 0)
                self.statement(line, first, row, own, last=not made)
        else:
            self.open = None
        named = set(said.labels_in(text))
        carried: str | None = None
        for number, statement in enumerate(made):
            last = number == len(made) - 1
            self.open = None
            if number and said.is_broken(statement.front):
                carried = None
            own, unsure = self.own_position(statement, label, carried, named)
            carried = own if said.labels_in(statement.lead) else carried
            for_rows = [row for row in gathering.rows_of(statement.symbol) if row.positions]
            location = gathering.location(line, statement.at)
            quoted = f"{statement.symbol} {statement.clauses[0].strip()}"
            if len(for_rows) > 1:
                for row in for_rows:
                    if said.has_number(statement):
                        gathering.doubt(row, gathering.position(row, own), "unread-several", location, quoted)
                continue
            for row in for_rows:
                if said.is_supposed(statement):
                    if said.has_number(statement):
                        gathering.doubt(row, gathering.position(row, own), "unread-supposed", location, quoted)
                elif statement.doubt:
                    gathering.doubt(row, gathering.position(row, own), "unread-number", location, quoted)
                elif unsure and not row.single:
                    if said.has_number(statement):
                        gathering.doubt(row, None, "unread-positions", location, quoted)
                else:
                    self.statement(line, statement, row, own, last)

    def otherwise(self, line: TextLine, label: str | None) -> None:
        """Record values that are stated without “=” as unread."""
        for symbol, text, at in said.without_equality_sign(line.text):
            for row in self.gathering.rows_of(symbol):
                position = self.gathering.position(row, label)
                self.gathering.doubt(row, position, "unread-number", self.gathering.location(line, at), text)

    def own_position(
        self, statement: Statement, label: str | None, carried: str | None, named: set[str]
    ) -> tuple[str | None, bool]:
        """Return the label of the position of a statement, and True if two are named for it."""
        before, behind = said.labels_in(statement.lead), said.labels_in(statement.clauses[0])
        around = (statement.lead, statement.clauses[0])
        if any(said.names_several(text) or said.names_another(text) for text in around):
            return None, True
        own = statement.label or (before[0] if before else None)
        if behind:
            # A position from an earlier sentence yields to one that the statement names itself.
            firm = own or carried or (label if label != self.hand.label or self.hand.level < FREE else None)
            if firm not in (None, behind[0]):
                return None, True
            return behind[0], False
        if own or carried:
            return own or carried, False
        # A line of another position than the heading's leaves the position of an unlabelled statement open.
        return (label, False) if named <= {label} else (None, False)

    def statement(self, line: TextLine, statement: Statement, row: KeyRow, label: str | None, last: bool) -> None:
        """Read the value of a statement of a row; without one it may continue in the next line."""
        gathering = self.gathering
        position = gathering.position(row, label)
        value = said.value_of(statement)
        quoted = f"{statement.symbol} {statement.clauses[0].strip()}"
        location = gathering.location(line, value.at if value else statement.at)
        at_end = last and len(statement.clauses) == 1
        if value is None or value.withdrawn:
            if value is not None or said.is_worked(statement):
                gathering.doubt(row, position, "unread-number", location, quoted)
            if value is None and at_end:
                self.open = row, label
            return
        if position is None:
            gathering.doubt(row, None, "unread-no-position", location, quoted)
            return
        gathering.number(
            row, position, value.number, value.unit, location, words=statement.text, barred=statement.barred
        )
        if at_end and not value.unit:
            self.open = row, label

    # --- equations that cannot be opened -----------------------------------------------------------

    def count_objects(self, line: TextLine, label: str | None) -> None:
        count = line.text.count(OBJECT)
        if count:
            self.hidden[label] = self.hidden.get(label, 0) + count
            self.first_object = self.first_object or self.gathering.location(line, line.text.index(OBJECT))

    def objects(self) -> None:
        """Record doubts for missing values that may be in equations that cannot be opened."""
        if self.first_object is None:
            return
        gathering = self.gathering
        gathering.note("word-objects", self.first_object, count=str(sum(self.hidden.values())))
        for row in gathering.key.asked:
            for position in row.positions:
                labels = [label for label in self.hidden if label and gathering.position(row, label) == position]
                if None in self.hidden or labels or row.single:
                    gathering.doubt(row, position, "unread-object", self.first_object, "")
