"""Proof sheet of a language: its texts beside those of the reference language, numbered for a proofreader's remarks.

Every section is printed with all its conditions and, where possible, with the data of one machine. A value that this
machine does not have is printed as the template names it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count, zip_longest
from pathlib import Path
from typing import Any

from jinja2 import Environment, StrictUndefined

from reportgen.base.kinds import SAMPLE
from reportgen.base.records import Record, field
from reportgen.base.template_folders import MACHINES, REFERENCE, templates
from reportgen.base.units import Language
from reportgen.base.words import sections
from reportgen.document import (
    Block,
    Cell,
    Column,
    Document,
    Emph,
    Inline,
    InlineMath,
    Inlines,
    Paragraph,
    Reference,
    Strong,
    Table,
    Text,
    Words,
)
from reportgen.document import Section as Heading
from reportgen.document.numbering import number
from reportgen.document.translation_check import TABLES, read_table, read_words_in
from reportgen.document.value_insertion import inlines
from reportgen.formula import Symbol

NUMBER_WIDTH = 12.0
SIDE = 74.0
"""Widths (mm) of the columns: the number, and each language."""
_BRACES = re.compile(r"(\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\})", re.DOTALL)
_MARKUP = re.compile(r"#{2,4} |\*\*")
_ID = re.compile(r"\w+\.[\w.]+")
_OPENED = re.compile(r"(if|elif|for)\s+(.*)", re.DOTALL)

TemplateNames = Callable[[str, Language], Mapping[str, Any]]
"""Returns the names that templates of a kind see in a language, for one machine; {} if the kind is not a machine."""


class ProofReader(Record):
    """Reads sections in one language, with the values of one machine by their `names`."""

    names: Mapping[str, Any]
    environment: Environment = field(default_factory=lambda: Environment(undefined=StrictUndefined, autoescape=True))

    def paragraphs(self, text: str) -> list[Inlines]:
        """Return the paragraphs of a section."""
        parts = (part.strip() for part in re.split(r"\n\s*\n", text))
        return [self._paragraph(" ".join(part.split("\n"))) for part in parts if part]

    def _paragraph(self, text: str) -> Inlines:
        """Return a paragraph; a heading is in bold letters."""
        line = tuple(self._pieces(text.lstrip("# ")))
        return (Strong(line),) if text.startswith("#") else line

    def _pieces(self, text: str) -> Iterator[Inline]:
        for piece in _BRACES.split(text):
            inner = piece[2:-2].strip(" -+")
            if piece.startswith("{{"):
                yield from self._value(inner)
            elif piece.startswith("{%"):
                yield from _condition(inner)
            elif piece and not piece.startswith("{#"):
                yield from self._text(piece)

    def _text(self, text: str) -> Iterator[Inline]:
        """Yield words as text, and a letter or the id of a quantity between dollar signs as a symbol."""
        for index, part in enumerate(text.split("$")):
            if index % 2:
                symbol = InlineMath(Symbol(*part.partition("_")[::2]))
                yield from self._value(f'symbol("{part}")') if _ID.fullmatch(part) else (symbol,)
            elif part:
                yield Text(_MARKUP.sub("", part))

    def _value(self, expression: str) -> Inlines:
        """Return the value of an expression in braces.

        Return its text if this machine has no value for it, or if the value cannot be part of a line.
        """
        try:
            value = self.environment.compile_expression(expression, undefined_to_none=False)(**self.names)
            # A proof sheet has no targets of references.
            printed = inlines(value)
            return tuple(Text(f"@{one.key}") if isinstance(one, Reference) else one for one in printed)
        except Exception:
            # Whatever this machine cannot say is read as it is written.
            return (Emph((Text(f"‹{expression}›"),)),)


def _condition(statement: str) -> Iterator[Inline]:
    opened = _OPENED.match(statement)
    if opened and opened[1] == "if":
        yield Emph((Text(f"[{opened[2]}: "),))
    elif opened and opened[1] == "elif":
        yield Emph((Text(f" | {opened[2]}: "),))
    elif opened:
        yield Emph((Text(f"[… {opened[2]}: "),))
    elif statement == "else":
        yield Emph((Text(" | – : "),))
    elif statement.startswith("end"):
        yield Emph((Text("]"),))
    elif statement.startswith("include"):
        yield Emph((Text(statement.replace("include", "→").replace('"', "")),))


def proof(folder: Path, language: Language, words: Mapping[str, Any], named: TemplateNames) -> Document:
    """Return the proof sheet of a language's folder; the columns are headed by the languages."""
    numbers = count(1)
    blocks: list[Block] = [Heading(1, (Text(words["title"].format(language=language)),), numbered=False)]
    blocks.append(Paragraph((Text(words["how"]),)))
    for file in sorted(folder.rglob("*.md"), key=lambda path: (path.parent.name == MACHINES, path.name)):
        name = file.relative_to(folder)
        model = templates() / REFERENCE / name
        if not model.is_file():
            continue
        kind = file.stem if file.parent.name == MACHINES else ""
        readers = ProofReader(named(kind, REFERENCE)), ProofReader(named(kind, language))
        rows = [row for section in sections(model) for row in _section(section, model, file, readers, numbers)]
        blocks += [Heading(2, (Text(name.as_posix()),), numbered=False), _table(rows, language)]
    own = folder / "words.yaml"
    if own.is_file():
        table = _words(read_table(templates() / REFERENCE / own.name), read_table(own), numbers)
        blocks += [Heading(2, (Text(own.name),), numbered=False), _table(list(table), language)]
    title = words["title"].format(language=language)
    return number(
        Document(
            language=language,
            title=title,
            author="",
            header=(title, ""),
            footer=("", words["document"]["page"]),
            words=Words.among(words, language),
            blocks=tuple(blocks),
        )
    )


def _section(
    name: str, model: Path, file: Path, readers: tuple[ProofReader, ProofReader], numbers: Iterator[int]
) -> Iterator[tuple[Cell, ...]]:
    """Yield the rows of one section, below its name."""
    there, here = sections(model)[name], sections(file).get(name)
    if name == SAMPLE:
        return
    yield (Cell((Strong((Text(f"%% {name}"),)),), 3),)
    if name in TABLES:
        yield from _words(read_words_in(there), read_words_in(here) if here else {}, numbers)
        return
    first, second = readers[0].paragraphs(there.text), readers[1].paragraphs(here.text if here else "")
    for row in zip_longest(first, second, fillvalue=()):
        if any(map(_has_words, row)):
            yield (Cell((Text(str(next(numbers))),)), *map(Cell, row))


def _has_words(line: Inlines) -> bool:
    """Return True if there is anything to read: a line may be a table or a figure alone."""
    inner = (part.of if isinstance(part, Strong) else (part,) for part in line)
    return any(isinstance(one, Text) and re.search(r"[^\W\d_]", one.text) for parts in inner for one in parts)


def _words(there: Any, here: Any, numbers: Iterator[int], above: str = "") -> Iterator[tuple[Cell, ...]]:
    """Yield a row for each word of a table, by its key."""
    for key, value in there.items():
        own = here.get(key) if isinstance(here, Mapping) else None
        if isinstance(value, Mapping):
            yield from _words(value, own, numbers, f"{above}{key}.")
            continue
        both = (" · ".join(map(str, one)) if isinstance(one, list) else str(one or "") for one in (value, own))
        cells = [Cell((Text(text),)) for text in both]
        cells[0] = Cell((Emph((Text(f"{above}{key} "),)), *cells[0].inlines))
        yield (Cell((Text(str(next(numbers))),)), *cells)


def _table(rows: Sequence[tuple[Cell, ...]], language: Language) -> Table:
    head = tuple(Cell((Strong((Text(text),)),)) for text in ("", REFERENCE, language))
    return Table((Column(NUMBER_WIDTH), Column(SIDE, "left"), Column(SIDE, "left")), (head,), tuple(rows))
