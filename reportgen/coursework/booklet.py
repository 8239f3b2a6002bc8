"""Join the reports of several cases into one booklet: one cover, task, contents and conclusion, with common numbering.

Each report is a finished document tree.  A section that begins the task, symbols or conclusion is marked
(`Section.opens`).  `booklet` joins reports, `handout` joins tasks; both number the result again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import dropwhile
from typing import Any

from reportgen.base.records import Record, replace
from reportgen.case.quantity_wording import sentence
from reportgen.coursework.symbol_renaming import changed
from reportgen.document import (
    BlankLine,
    Block,
    Cell,
    Column,
    Contents,
    Cover,
    Document,
    Equation,
    Figure,
    Inlines,
    PageBreak,
    Paragraph,
    Plate,
    Reference,
    Section,
    Table,
    Text,
)
from reportgen.document.layout import contents
from reportgen.document.numbering import Blocks, number

RUN_IN = 4
"""Level of a run-in heading, which is printed in its paragraph."""
SYMBOLS = (34.0, 96.0, 30.0)
"""Widths (mm) of the columns of the table of the parts' symbols."""
GIVEN = "tab.given"
"""Key of the table of a machine's given data."""
NAMED = (Section, Equation, Table, Figure, Plate, Reference)
"""Types of nodes that have a key or refer to one."""


class PartReport(Record):
    """Report of a part: its `name` among the parts, its title, its finished tree.

    `taken` lists the data from the machine, `lettered` the symbols with the part's index.  `symbols` are rows (symbols,
    meaning, unit) for its quantities that are not explained where they are used; `summary` are its main results.
    `lengths` are those that it gives the machine; the chapters of such a part come before the machine's.
    """

    name: str
    title: str
    document: Document
    taken: Blocks = ()
    lettered: Blocks = ()
    symbols: tuple[tuple[Inlines, Inlines, Inlines], ...] = ()
    summary: Blocks = ()
    lengths: Blocks = ()

    def group(self, what: str) -> Blocks:
        """Return the blocks below the heading that opens a section; "" for the chapters, their headings included."""
        blocks: list[Block] = []
        for group in self._groups:
            if topic(group[0]) == what:
                blocks += group[1:]
            elif not what and topic(group[0]) not in ("given", "conclusion"):
                blocks += group
        return tuple(blocks)

    @property
    def _groups(self) -> Iterator[Blocks]:
        """Yield the groups of its report after cover and contents, with headings one level lower and keys that begin
        with its name.
        """
        for group in groups(self.document.blocks):
            if isinstance(group[0], Section):
                yield tuple(map(lowered, renamed(group, self.name)))


def booklet(machine: Document, parts: Sequence[PartReport], words: Mapping[str, Any], senses: Blocks = ()) -> Document:
    """Return the joined, numbered document; `words` are those of the machine, `senses` the block on the shafts' senses
    of rotation.
    """
    sections = list(groups(machine.blocks))
    # A short report has no summary.
    last_topic = "overview" if any(topic(head) == "overview" for head, *_ in sections) else "conclusion"
    counted = [index for index, (head, *_) in enumerate(sections) if isinstance(head, Section) and head.numbered]
    last = counted[-1] if counted else len(sections) - 1
    first = counted[0] if counted else last
    blocks: list[Block] = []
    for index, (head, *below) in enumerate(sections):
        if index == first:
            for part in parts:
                blocks += chapter_of(part) if part.lengths else ()
        below = list(with_parts_named(below, parts, words)) if topic(head) == "foreword" else below
        blocks += (with_titles(head, parts) if isinstance(head, Cover) else head, *below)
        if topic(head) == "symbols":
            blocks += symbols(parts, words)
        for part in parts:
            match topic(head):
                case "given":
                    blocks += (heading(part.title, 2), *part.group("given"), *part.taken)
                case "overview":
                    blocks += (heading(f"{part.title}.", RUN_IN), *part.summary)
                case "conclusion":
                    blocks += (heading(f"{part.title}.", RUN_IN), *part.group("conclusion"))
        if topic(head) == last_topic:
            blocks += senses
        if index == last:
            for part in parts:
                blocks += () if part.lengths else chapter_of(part)
    listed = (
        contents(block.title, blocks, block.brief, machine.language) if isinstance(block, Contents) else block
        for block in blocks
    )
    return number(replace(machine, blocks=tuple(listed)))


def chapter_of(part: PartReport) -> Blocks:
    """Return the chapter of a part, with the lengths that it gives the machine at its end."""
    return (Section(1, (Text(part.title),)), *part.lettered, *part.group(""), *part.lengths)


def with_lengths(machine: Document, lengths: Iterable[Block]) -> Document:
    """Return a report or task of a machine that names the lengths which parts give, below the table of its data."""
    blocks = list(machine.blocks)
    place = next((n for n, block in enumerate(blocks) if isinstance(block, Table) and block.key == GIVEN), None)
    if place is not None:
        blocks[place + 1 : place + 1] = lengths
    return replace(machine, blocks=tuple(blocks))


def handout(machine: Document, parts: Sequence[PartReport]) -> Document:
    """Return the joined task: that of the machine, then those of the parts, each on a new page and without its
    heading.
    """
    blocks = list(machine.blocks)
    for part in parts:
        head, *below = renamed(part.document.blocks, part.name)
        assert isinstance(head, Section), "a task begins with its title"
        # The first page already names the student.
        own = dropwhile(lambda block: isinstance(block, BlankLine), below[1:])
        blocks += (PageBreak(), heading(part.title, 1), *part.taken, *own)
    return number(replace(machine, blocks=tuple(blocks)))


def groups(blocks: Iterable[Block]) -> Iterator[Blocks]:
    """Yield the blocks before the first heading of level 1, then each such heading with all below it."""
    group: list[Block] = []
    for block in blocks:
        if isinstance(block, Section) and block.level == 1 and group:
            yield tuple(group)
            group = []
        group.append(block)
    if group:
        yield tuple(group)


def topic(block: Block) -> str:
    """Return the topic that a heading opens, for any kind of work: given, symbols, conclusion, …."""
    return block.opens.rpartition("-")[2] if isinstance(block, Section) else ""


def heading(title: str, level: int) -> Section:
    """Return a heading without a number."""
    return Section(level, (Text(title),), numbered=False)


def with_titles(cover: Cover, parts: Sequence[PartReport]) -> Cover:
    """Return the cover with the titles of the parts below that of the machine."""
    return replace(cover, subtitle=(*cover.subtitle, *(part.title for part in parts)))


def lowered(block: Block) -> Block:
    """Return a block; a heading is moved one level down."""
    return replace(block, level=min(block.level + 1, RUN_IN)) if isinstance(block, Section) else block


def renamed(blocks: Blocks, name: str) -> Blocks:
    """Return blocks whose keys, and references to them, begin with a part's name."""

    def own(block: Any) -> Any:
        return replace(block, key=f"{name}.{block.key}") if block.key else block

    # References are renamed first, because they occur inside nodes that have keys.
    return changed(changed(blocks, Reference, own), tuple(kind for kind in NAMED if kind is not Reference), own)


def with_parts_named(
    foreword: Sequence[Block], parts: Sequence[PartReport], words: Mapping[str, Any]
) -> Iterator[Block]:
    """Yield the foreword of the machine, with a sentence about the parts before its last paragraph."""
    own = words["coursework"]
    titles = [str(own["title"]).format(title=part.title) for part in parts]
    plain = [n for n, block in enumerate(foreword) if isinstance(block, Paragraph) and not block.align]
    text = str(own["foreword"] if len(titles) > 1 else own["foreword_one"]).format(titles=", ".join(titles))
    for place, block in enumerate(foreword):
        if place == plain[-1]:
            yield Paragraph((Text(text),))
        yield block


def symbols(parts: Sequence[PartReport], words: Mapping[str, Any]) -> Iterator[Block]:
    """Yield the table of the quantities of all parts that need an explanation, with its heading."""
    own, key = words["coursework"], "tab.symbols.parts"
    rows = tuple(tuple(map(Cell, row)) for part in parts for row in part.symbols)
    if rows:
        head = tuple(Cell((Text(str(text)),)) for text in words["tables"]["symbols"]["head"])
        columns = (Column(SYMBOLS[0]), Column(SYMBOLS[1], "left"), Column(SYMBOLS[2]))
        yield Paragraph(sentence(own["symbols"], table=Reference(key)))
        yield Table(columns, (head,), rows, (Text(str(own["caption"])),), key)
