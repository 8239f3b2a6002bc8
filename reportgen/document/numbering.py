"""Number a finished tree and resolve its cross-references, in one last pass for all writers.

Parts (level 1) count 1, 2, …; sections below them 1.1 and 1.1.1; equations, tables and figures count by part, each
kind
separately. In a part without a number they count 1, 2, … through the whole document. These never equal the number of
a
counted part, which has two members.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from reportgen import document as tree
from reportgen.base.errors import DocumentError
from reportgen.base.records import replace
from reportgen.document import plain
from reportgen.document.cjk_punctuation import set_out

_COUNTED_LEVELS = 3

_Kind = Literal["equation", "table", "figure"]
Blocks = tuple[tree.Block, ...]
ChangeInlines = Callable[[tree.Inlines], tree.Inlines]


def number(document: tree.Document) -> tree.Document:
    """Return the document with every number and reference filled in.

    An equation's number is "1.2", a reference to it "(1.2)"; a reference to a section without a number is its title.
    Raise `DocumentError` with all duplicate keys, references to nothing, equations with a key that nothing refers to,
    and headings that skip a level.
    """
    count = _Count()
    numbered = tuple(count.block(block) for block in document.blocks)
    used = dict.fromkeys(_references(numbered))
    faults = [
        *count.faults,
        *(f"two blocks have the key {key!r}" for key, times in count.times.items() if times > 1),
        *(f"a reference to {key!r}, which is not in the document" for key in used if key not in count.times),
        *(f"nothing refers to the equation {key!r}" for key in count.equations if key not in used),
    ]
    if faults:
        raise DocumentError(faults)
    named = {key: plain(_filled(title, count.labels), document.language) for key, title in count.titles.items()}
    labels = count.labels | named
    filled = _each(numbered, lambda line: set_out(_filled(line, labels), document.language))
    return replace(document, blocks=tuple(_with_rest(block, count.labels) for block in filled))


def unreferenced(document: tree.Document) -> tuple[str, ...]:
    """Return the keys of the figures, plates and tables that no text refers to, in order."""
    used = set(_references(document.blocks))
    kinds = tree.Table, tree.Figure, tree.Plate
    keys = (block.key for block in _walk(document.blocks) if isinstance(block, kinds))
    return tuple(key for key in keys if key and key not in used)


# --- counting -------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Count:
    """State of the numbering pass."""

    path: tuple[int, ...] = ()
    """Numbers of the section now open, () in a part that is not counted."""
    level: int = 0
    of_sections: Counter[tuple[int, ...]] = field(default_factory=Counter)
    of_kinds: Counter[tuple[tuple[int, ...], _Kind]] = field(default_factory=Counter)
    times: Counter[str] = field(default_factory=Counter)
    labels: dict[str, str] = field(default_factory=dict)
    """Printed text of a reference, by key."""
    titles: dict[str, tree.Inlines] = field(default_factory=dict)
    """Titles of sections without a number, by key."""
    last_figure: str = ""
    equations: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)

    def block(self, block: tree.Block) -> tree.Block:
        match block:
            case tree.Section():
                return self.section(block)
            case tree.Equation(key=key) if key:
                self.equations.append(key)
                value = self.next("equation")
                self.name(key, f"({value})")
                return replace(block, number=value)
            case tree.Plate(continues=True):
                return replace(block, number=self.last_figure)
            case tree.Table() | tree.Figure() | tree.Plate() if block.key or block.caption:
                value = self.next("table" if isinstance(block, tree.Table) else "figure")
                self.name(block.key, value)
                self.last_figure = self.last_figure if isinstance(block, tree.Table) else value
                return replace(block, number=value)
            case tree.List(items):
                return replace(block, items=tuple(tuple(map(self.block, item)) for item in items))
        return block

    def section(self, section: tree.Section) -> tree.Section:
        level = section.level
        if level > _COUNTED_LEVELS:
            value = ""
        else:
            if level > self.level + 1:
                self.faults.append(f"a heading of level {level} follows one of level {self.level}")
            self.level = level
            above = self.path[: level - 1]
            counted = section.numbered and len(above) == level - 1
            if counted:
                self.of_sections[above] += 1
                self.path = (*above, self.of_sections[above])
            else:
                self.path = above
            value = _dotted(self.path) if counted else ""
        self.name(section.key, value)
        if section.key and not value:
            self.titles[section.key] = section.title
        return replace(section, number=value)

    def next(self, kind: _Kind) -> str:
        part = self.path[:1]
        self.of_kinds[part, kind] += 1
        return _dotted((*part, self.of_kinds[part, kind]))

    def name(self, key: str, label: str) -> None:
        if key:
            self.times[key] += 1
            self.labels[key] = label


def _dotted(numbers: tuple[int, ...]) -> str:
    return ".".join(map(str, numbers))


def _with_rest(block: tree.Block, labels: Mapping[str, str]) -> tree.Block:
    """Return a figure with the number of the table of its name, or of the longest beginning of its name that has one.

    The values of fig.v.stages.23.4 are in tab.v.
    """
    if not isinstance(block, tree.Figure | tree.Plate):
        return block
    names = block.key.replace("fig.", "tab.", 1).split(".")
    least = names.index("tab") + 2 if "tab" in names else len(names) + 1
    keys = (".".join(names[:count]) for count in range(len(names), least - 1, -1))
    return replace(block, rest=next((labels[key] for key in keys if key in labels), ""))


# --- walking --------------------------------------------------------------------------------------


def _walk(blocks: tuple[tree.Block, ...]) -> Iterator[tree.Block]:
    for block in blocks:
        yield block
        if isinstance(block, tree.List):
            for item in block.items:
                yield from _walk(item)


def _each(blocks: Blocks, change: ChangeInlines) -> Blocks:
    """Return the blocks with `change` applied to every line of text in them."""
    return tuple(_changed(block, change) for block in blocks)


def _changed(block: tree.Block, change: ChangeInlines) -> tree.Block:
    match block:
        case tree.Section(_, title):
            return replace(block, title=change(title))
        case tree.Paragraph(inlines):
            return replace(block, inlines=change(inlines))
        case tree.List(items):
            return replace(block, items=tuple(_each(item, change) for item in items))
        case tree.Table():

            def cells(rows: tuple[tuple[tree.Cell, ...], ...]) -> tuple[tuple[tree.Cell, ...], ...]:
                return tuple(tuple(tree.Cell(change(cell.inlines), cell.span) for cell in row) for row in rows)

            return replace(block, head=cells(block.head), rows=cells(block.rows), caption=change(block.caption))
        case tree.Figure() | tree.Plate():
            return replace(block, caption=change(block.caption))
    return block


def _filled(inlines: tree.Inlines, labels: dict[str, str]) -> tree.Inlines:
    """Return inlines with the text of every reference filled in from `labels`."""
    return tuple(
        replace(inline, text=labels[inline.key])
        if isinstance(inline, tree.Reference)
        else replace(inline, of=_filled(inline.of, labels))
        if isinstance(inline, (tree.Emph, tree.Strong))
        else inline
        for inline in inlines
    )


def _references(blocks: tuple[tree.Block, ...]) -> list[str]:
    """Return the keys referred to, in order."""
    keys: list[str] = []

    def note(inlines: tree.Inlines) -> tree.Inlines:
        for inline in inlines:
            if isinstance(inline, tree.Reference):
                keys.append(inline.key)
            elif isinstance(inline, (tree.Emph, tree.Strong)):
                note(inline.of)
        return inlines

    _each(blocks, note)
    return keys
