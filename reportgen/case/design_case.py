"""Case and templates of a design (a cam, a gear pair, a planetary train): `DesignCase` and `DesignPage`.

A new kind of design derives from both.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import Any, ClassVar, Generic, TypeVar

from reportgen.case import AskedFor, LoadedAssignment
from reportgen.case.answer_key import Span
from reportgen.case.finished_document import finished
from reportgen.case.missing_chapters import MissingChapter, heading_of
from reportgen.case.quantity_wording import positive_sense
from reportgen.document import (
    Block,
    Cell,
    Column,
    Document,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    PageBreak,
    Section,
    Table,
    Text,
    Value,
)
from reportgen.document.layout import contents
from reportgen.document.template_rendering import Prose
from reportgen.drawing import Scene
from reportgen.formula import Symbol
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import Ledger
from reportgen.formula.printed_decimals import carried
from reportgen.formula.vocabulary import in_language

DATA = (95.0, 25.0, 40.0)
"""Widths (mm) of the columns of the given data."""
Designed = TypeVar("Designed", bound=LoadedAssignment)


@dataclass(frozen=True)
class DesignCase(LoadedAssignment):
    """Case of a design: one calculation gives its numbers, one `DesignPage` its documents."""

    PAGE: ClassVar[type[DesignPage[Any]]]
    SAME: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Groups of ids that are printed with equally many decimals."""

    @property
    @abstractmethod
    def calculation(self) -> Calculation:
        """The calculation: every quantity with its formula."""

    @cached_property
    def ledger(self) -> Ledger:
        sheet = self.calculation
        made = Ledger(sheet.families, sheet.positions, units=self.unit_names, same=self.SAME, lines=sheet.lines)
        return made.in_language(self.words["symbols"])

    @cached_property
    def printed(self) -> Ledger:
        return carried(self.ledger)

    @property
    def count(self) -> int:
        """Number of its positions."""
        return self.calculation.positions

    @property
    def worked(self) -> tuple[int, ...]:
        """The positions calculated in full."""
        return (1,)

    @property
    def span(self) -> Span:
        return Span(tuple(map(str, range(1, self.count + 1))), self.count, self.worked)

    def sense(self, id: str) -> str:
        return positive_sense(id, self.ledger, self.words)

    def document(self) -> Document:
        return self.bounded(self.PAGE.report)

    @property
    def missing_chapters(self) -> Sequence[MissingChapter]:
        return self.PAGE(self).missing

    def summary(self) -> Sequence[Block]:
        return self.bounded(self.PAGE.summary)

    def question(self, asked: AskedFor) -> tuple[Sequence[Block], Sequence[Block]]:
        page = self.PAGE(self)
        names = {
            **page.names(),
            "answer_tables": asked.answers,
            "sheet_apart": asked.by_section,
            "self_check": asked.self_check,
            "is_part": self.assignment.is_part,
            **page.asked(asked),
        }
        title = Section(1, (Text(page.words["task"].format(title=self.title)),), numbered=False)
        return (title,), page.section(page.TASK, names)


@dataclass(frozen=True)
class DesignPage(ABC, Generic[Designed]):
    """A design for its templates: names, tables and figures."""

    case: Designed

    NAME: ClassVar[str]
    """Key of its words."""
    TASK: ClassVar[str]
    """The section with its task."""
    SUMMARY: ClassVar[str]
    """The section with its main results."""
    SECTIONS: ClassVar[Sequence[str]]
    SHORT: ClassVar[frozenset[str]] = frozenset()
    """The sections that a short report leaves out."""

    @property
    def words(self) -> Mapping[str, Any]:
        own_words: Mapping[str, Any] = self.case.words[self.NAME]
        return own_words

    @property
    def full(self) -> bool:
        return self.case.assignment.report.extent == "full"

    SWITCHES: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    """Paths of parameters, any of which brings a section; all other sections are always there."""

    def has(self, section: str) -> bool:
        """Return True if this design has a section."""
        return section not in self.SWITCHES or any(map(self._gives, self.SWITCHES[section]))

    def _gives(self, path: str) -> bool:
        """Return True if the file gives a parameter."""
        return reduce(getattr, path.split("."), self.case.assignment.parameters) not in (None, ())

    @property
    def missing(self) -> list[MissingChapter]:
        """The sections that the file could still bring."""
        absent = (section for section in self.SWITCHES if not self.has(section))
        return [
            MissingChapter(
                heading_of(section, self.case.places),
                (tuple(("parameters", *path.split(".")) for path in self.SWITCHES[section]),),
            )
            for section in absent
            if self.full or section not in self.SHORT
        ]

    @abstractmethod
    def names(self) -> dict[str, Any]:
        """Return all names that the templates may use."""

    @property
    def shared_names(self) -> dict[str, Any]:
        """The names that the templates of all designs use: its words, and what writes symbols, lines and figures."""
        return {
            "words": self.case.words,
            "quantity": self.quantity,
            "lines": self.lines,
            "math": self.math,
            "figure": self.figure,
        }

    def asked(self, asked: AskedFor) -> dict[str, Any]:
        """Return the further names that the task may use, from its questions."""
        return {}

    def scenes(self, name: str) -> Iterable[Scene]:
        """Return the drawings of a figure.  Raises `KeyError` for an unknown name."""
        raise KeyError(name)

    def section(self, name: str, names: Mapping[str, Any]) -> tuple[Block, ...]:
        return Prose(self.case.places).render(name, names)

    def caption(self, name: str) -> Inlines:
        return Prose(self.case.places).inlines(self.words["captions"][name])

    # --- symbols and lines

    def math(self, text: str) -> Symbol:
        """Return the symbol that a template writes as `$…$`: a quantity's by its id, else letters with their index."""
        if text in self.case.printed:
            return self.case.printed.symbol(text)
        base, _, sub = text.partition("_")
        return in_language(Symbol(base, sub), self.case.words["symbols"])

    def value(self, id: str, k: int | None = None) -> Value:
        """Return a result with its unit, at a position (from 1); in text it has as many figures as in tables."""
        return Value(self.case.printed.result(id, k))

    def quantity(self, id: str, k: int | None = None) -> Inlines:
        """Return a symbol with its number."""
        return InlineMath(self.case.printed.symbol(id)), Text(" = "), self.value(id, k)

    def lines(self, quantities: Iterable[str], k: int | None = None) -> tuple[Block, ...]:
        """Return worked lines in one equation; () if there are none."""
        rows = tuple(self.case.printed.chain(id, k) for id in quantities)
        return (Equation(rows),) if rows else ()

    # --- tables and figures

    def given_rows(self, without: Collection[str] = ()) -> Iterator[tuple[Inlines, Inlines, Inlines]]:
        """Yield the name, symbol and value of each given quantity, except those in `without`."""
        printed = self.case.printed
        for id, name in self.case.words["given"].items():
            if id in printed and id not in without and printed[id].definition is None:
                yield (Text(str(name)),), (InlineMath(printed.symbol(id)),), (self.value(id),)

    def data_table(self, rows: Iterable[Iterable[Inlines]]) -> Table:
        """Return the table of the given data."""
        name, *widths = DATA
        heads = tuple((Text(str(self.case.words["table"][key])),) for key in ("quantity", "symbol", "value"))
        return self.table("data", (Column(name, "left"), *map(Column, widths)), (heads,), rows)

    @property
    def data(self) -> Table:
        """The table of all given data."""
        return self.data_table(self.given_rows())

    def figure(self, name: str) -> Figure:
        return Figure(tuple(self.scenes(name)), self.caption(f"figure-{name}"), f"fig.{name}")

    def table(
        self,
        name: str,
        columns: Iterable[Column],
        heads: Iterable[Iterable[Inlines]],
        rows: Iterable[Iterable[Inlines]],
    ) -> Table:
        """Return a table of inlines with the caption of this name."""
        head, body = (tuple(tuple(map(Cell, row)) for row in part) for part in (heads, rows))
        return Table(tuple(columns), head, body, self.caption(name), f"tab.{name}")

    @classmethod
    def summary(cls, case: Designed) -> tuple[Block, ...]:
        """Return the main results in a few sentences."""
        page = cls(case)
        return page.section(cls.SUMMARY, page.names())

    @classmethod
    def report(cls, case: Designed) -> Document:
        """Return the finished, numbered report of a design."""
        page = cls(case)
        names, title = page.names(), case.words["document"]["contents"]
        blocks: list[Block] = []
        for section in cls.SECTIONS:
            if page.has(section) and (page.full or section not in cls.SHORT):
                blocks += page.section(section, names)
        ahead = case.cover, PageBreak(), contents(title, blocks, not page.full, case.assignment.language)
        return finished(case, (*ahead, *blocks), close=not page.full)
