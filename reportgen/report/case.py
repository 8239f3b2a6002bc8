"""What an assignment comes to, whatever kind of work it is: the one thing that every output is made of.

Whoever makes files, marks or draws a class asks a `Case` and nothing else, and never which kind of case it is.  A
machine is one implementation (`reportgen.cases`), an exercise of plane motion another; a further kind of work is one
more and changes nobody else.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, Self, TypeVar, get_args

import numpy as np

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.errors import DocumentError, NotOfferedError, TemplateError
from reportgen.base.units import Language
from reportgen.base.words import load_words, search_path, word
from reportgen.base.words import title as kind_title
from reportgen.formula import Expression, Symbol
from reportgen.formula.ledger import Ledger
from reportgen.formula.rounding import printed
from reportgen.formula.sheet import Family
from reportgen.formula.vocabulary import Chapter
from reportgen.report import Cover, Document

if TYPE_CHECKING:
    import numpy as np

    from reportgen.drawing.film import Film
    from reportgen.drawing.sheet import DrawingSheet
    from reportgen.formula.ledger import Ledger
    from reportgen.machine.analysis import Analysis
    from reportgen.machine.flywheel import RegulatedCycle
    from reportgen.plans import PlannedLedger
    from reportgen.plans.loads import Polygon


@dataclass(frozen=True, slots=True)
class Pitfalls:
    """What of an assignment is easily taken for something else; marking looks for it.

    `applied` are the given loads by name, `loads` all of them, each of which may be forgotten or reversed.  `readings`
    are for a quantity that is read from a diagram the values [N] that it has when it is read wrongly, with the
    mistake's name.  `whole` is for a length from one end of a rod the length of the whole rod, by ids.  `changed` are
    for a quantity other definitions that are often used, with the mistake's name.
    """

    applied: frozenset[str] = frozenset()
    loads: tuple[str, ...] = ()
    readings: Mapping[str, Sequence[tuple[str, np.ndarray]]] = field(default_factory=dict)
    whole: Mapping[str, str] = field(default_factory=dict)
    changed: Mapping[str, Sequence[tuple[str, Expression]]] = field(default_factory=dict)


class Case(Protocol):
    """An assignment opened once; each part is computed when it is first asked for.

    Making a part raises `TemplateError` for a fault in the words, and `NotOfferedError` for what this kind has not.
    """

    @property
    def assignment(self) -> Assignment: ...

    @property
    def words(self) -> Mapping[str, Any]:
        """The short words of its language, kind and school."""

    @property
    def title(self) -> str:
        """What its kind is called, in its language."""

    @property
    def ledger(self) -> Ledger:
        """Every number by its id, unrounded."""

    @property
    def printed(self) -> Ledger:
        """Every number by its id as it is written down."""

    @property
    def families(self) -> Mapping[str, Family]:
        """What is worked out at its positions."""

    @property
    def used(self) -> Collection[Symbol] | None:
        """The symbols that its report uses, of quantities, points and general formulas; None where it alone tells."""

    @property
    def positions_of_a_turn(self) -> int:
        """After so many positions motion repeats."""

    @property
    def speed(self) -> float | None:
        """Of its driver (rad/s or m/s); None where nothing drives it."""

    @property
    def balance(self) -> np.ndarray | None:
        """The torque or force on the driver that balances the loads [N]; None without loads."""

    @property
    def pitfalls(self) -> Pitfalls:
        """What marking looks for beside the mistakes that any formula may have."""

    @property
    def parts(self) -> Mapping[str, Case]:
        """The cases that a coursework is made of, by name, that of the machine first; none of a work without parts."""

    def fault(self) -> str:
        """The code of a fault that shows only in the results, "" if they are sound; variants are judged by it."""

    def document(self) -> Document:
        """The finished, numbered report."""

    def key(self) -> Key:
        """The answer key, from the ledger that the report prints."""

    def task(self, key: Key, by_section: bool = False) -> Document:
        """What a student is handed, from the given data to the empty answer sheet of `key`; no answer is in it.

        `by_section` puts each section of the sheet on pages of its own, headed by whose it is.
        """

    def results(self) -> dict[str, Any]:
        """The contract's JSON object: an entry a position, null where it cannot be reached."""

    def films(self) -> tuple[Film, ...]:
        """What moves on its page, a film a part; none where nothing does."""

    def sheets(
        self, size: str = "", sets: Collection[str] = (), block: Path | None = None, every: bool = False
    ) -> list[DrawingSheet]:
        """Its drawing sheets, with `every` plate or those usually handed in.

        Raises `SheetError` where there is nothing to draw, and `AssignmentError` where a plate is too large.
        """


# --- an assignment opened once with its words -----------------------------------------------------
# And a machine with all that is computed of it.


Made = TypeVar("Made")


def bounded(assignment: Assignment, make: Callable[..., Made], *arguments: Any) -> Made:
    """What `make`, named in a module, makes of arguments that can be pickled.

    Under a school's templates that is done in a process that can be ended.  Raises `TemplateError` where it was.
    """
    if assignment.school is None:
        return make(*arguments)
    from reportgen.base.limits import TEMPLATES, LimitError, call_within

    file = search_path(assignment.language, assignment.kind, assignment.school)[0]
    try:
        return call_within(TEMPLATES, partial(_called, make), arguments)
    except LimitError as error:
        told = word("template_limits", assignment.language, **asdict(TEMPLATES))
        raise TemplateError(f"{file}:1: {told}") from error
    except DocumentError as error:
        raise TemplateError("\n".join(f"{file}:1: {fault}" for fault in error.faults)) from error


def _called(make: Callable[..., Made], arguments: tuple[Any, ...]) -> Made:
    return make(*arguments)


@dataclass(frozen=True)
class Opened:
    """An assignment with its words; each part is computed when it is first asked for."""

    assignment: Assignment
    root: Path | None = field(default=None, kw_only=True, compare=False, repr=False)
    """The folder of its templates; None where it is the program's own."""

    def bounded(self, make: Callable[[Self], Made]) -> Made:
        """What `make`, named in a module, makes of this case and its words.

        A school's templates are rendered in a process that can be ended.  Raises `TemplateError` where that was done.
        """
        if self.assignment.school is None:
            return make(self)
        return bounded(self.assignment, make, type(self)(self.assignment, root=self.places[-1].parent))

    @property
    def places(self) -> tuple[Path, ...]:
        """Where the words of this language, machine and school are looked for."""
        assignment = self.assignment
        return search_path(assignment.language, assignment.kind, assignment.school or "", self.root)

    @cached_property
    def words(self) -> Mapping[str, Any]:
        """The short words of `words.yaml`.  Raises `TemplateError`."""
        return load_words(self.places)

    @property
    def course(self) -> str:
        """The course as the assignment names it; by its standard name, whatever the language, in the case's own."""
        standard: str = self.words["cover"]["course"]
        names = {load_words(search_path(language))["cover"]["course"] for language in get_args(Language)}
        given = self.assignment.report.course
        return given if given and given not in names else standard

    @property
    def place_and_date(self) -> str:
        """As they stand on the cover; what is not given is dotted."""
        labels, report = self.words["cover"], self.assignment.report
        place, day = report.place or "……………………", report.date
        if day is None:
            return str(labels["no_date"]).format(place=place)
        months = labels.get("months")
        return str(labels["date"]).format(
            place=place,
            day=day.day,
            month=day.month,
            year=day.year,
            month_name=months[day.month - 1] if months else day.month,
        )

    @property
    def cover(self) -> Cover:
        """The title page; a field without a value is a dotted line to fill in."""
        given, labels = self.assignment.report, self.words["cover"]
        student, variant = given.student, self.assignment.variant
        fields: tuple[tuple[Any, str | None], ...] = (
            (labels["student"], student.name),
            (labels["id"], student.id),
            (labels["class"], student.class_),
            (labels["section"], student.section),
            (labels["email"], student.email),
            (labels["supervisor"], given.supervisor),
        )
        return Cover(
            tuple(part for part in (given.university, given.faculty, given.department) if part),
            (labels["title"], self.course),
            (*((f"{labels['variant']}: {variant}",) if variant else ()), f"{labels['machine']}: {self.title}"),
            tuple((label, value or "") for label, value in fields),
            self.place_and_date,
        )

    @property
    def title(self) -> str:
        """The machine's name in the assignment's language."""
        return kind_title(self.assignment.kind, self.assignment.language)

    @property
    def parts(self) -> Mapping[str, Case]:
        """It is a work of one part."""
        return {}

    @property
    def used(self) -> Collection[Symbol] | None:
        """Nobody knows before its report is composed."""
        return None

    @property
    def variant_line(self) -> str:
        """The variant as headers name it."""
        variant = self.assignment.variant
        return str(self.words["variant"].format(variant=variant)) if variant else ""


@dataclass(frozen=True)
class Calculation(Opened):
    """A machine: its assignment with all that is computed of it."""

    @cached_property
    def analysis(self) -> Analysis:
        """Everything computed, as arrays over the positions.

        Raises `NotOfferedError` for a kind that is no machine.
        """
        from reportgen.machine.analysis import analyse

        kind, language = self.assignment.kind, self.assignment.language
        machine = getattr(catalogue.module(kind), "machine", None)
        if machine is None:
            raise NotOfferedError(word("no_machine", language, kind=kind))
        return analyse(machine(self.assignment))

    @cached_property
    def written(self) -> PlannedLedger:
        """Every number with the force plans, in the symbols and units of the assignment's language."""
        from reportgen.plans import write_ledger

        written = write_ledger(self.analysis, self.words["units"], self.assignment.worked_positions)
        return replace(written, ledger=written.ledger.in_language(self.words["symbols"]))

    @property
    def ledger(self) -> Ledger:
        """Every number by its id, unrounded."""
        return self.written.ledger

    @cached_property
    def printed(self) -> Ledger:
        """Every number by its id as it is written down: all that is printed or drawn comes from here."""
        return printed(self.ledger)

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The force plans: one for each group, the driver's last; none without loads."""
        return self.written.polygons

    @property
    def flywheel(self) -> RegulatedCycle | None:
        """The flywheel, if the assignment asks for one."""
        return self.written.flywheel


# --- the answer key of an assignment, as data -----------------------------------------------------
# Its rows are the ledger's own families, so key, report and marker agree.


class Role(StrEnum):
    """What a row is to the student: printed on the task, to be worked out, or a scale of his or her own choice."""

    given = "given"
    asked = "asked"
    scale = "scale"


@dataclass(frozen=True, slots=True)
class KeyRow:
    """One quantity over the positions, in its printed unit.

    `values` [N] are unrounded, with the sign that is printed, and `printed` [N] what the report prints for them; both
    are NaN where the quantity does not exist (the direction of a vector of no length).  A `single` quantity has one
    value for all positions (N = 1).  `drawn` and `computed` [N] are the half widths of the two bands.  `positions` are
    the numbers (from 1) at which the answer sheet asks for it, empty if it does not; (0,) for a single quantity.
    `sense` [N] says the direction in words where the value has one, else "".
    """

    id: str
    part: Chapter
    role: Role
    symbol: Symbol
    kind: str
    unit: str
    decimals: int | None
    values: np.ndarray
    printed: np.ndarray
    drawn: np.ndarray
    computed: np.ndarray
    positions: tuple[int, ...]
    sense: tuple[str, ...]
    size: str = ""
    """The id of the size of a signed rotation."""
    what: str = ""
    """What it is in words: normal acceleration of B about A."""
    positive: str = ""
    """Which sense counts as positive, in words; "" where there is none, or where the general rule says it."""
    open_sense: bool = False
    """Whether its sign is not judged, because the papers do not say which sense is positive."""

    @property
    def single(self) -> bool:
        return len(self.values) == 1

    @property
    def described(self) -> str:
        """What it is and which sense of it counts as positive, as it stands beside the row."""
        return capitalised("; ".join(filter(None, (self.what, self.positive))))

    def has(self, position: int) -> bool:
        """Whether the quantity has a value at a position: from 1, or 0 for a single value."""
        return self.single == (position == 0)

    def at(self, position: int) -> int:
        """The index of a position (from 1, 0 for a single value) in `values`."""
        return 0 if self.single else position - 1


@dataclass(frozen=True)
class Key:
    """All rows of an assignment; `labels` [N] are what its positions are called, `students` fields of its student.

    Of very many positions only those in `printed` stand in the document.
    """

    id: str
    kind: str
    variant: str
    language: Language
    student: Mapping[str, str]
    labels: tuple[str, ...]
    rows: tuple[KeyRow, ...]
    printed: tuple[int, ...] = ()
    parts: tuple[PartOfKey, ...] = ()
    """The parts of a coursework in the order of their rows."""

    def label(self, position: int, id: str = "") -> str:
        """What a position (from 1) of a quantity is called; "" for 0, the one of single values."""
        labels = self.part(id).labels if id else self.labels
        return labels[position - 1] if position else ""

    def part(self, id: str) -> Key:
        """The key of the part that a quantity belongs to; of a work without parts itself."""
        return next((part.key for part in self.parts if part.name == self.owner(id)), self)

    def owner(self, id: str) -> str:
        """The name of the part that a quantity belongs to; the first has whatever no other has."""
        first, *others = self.parts or (None,)
        named = (part.name for part in others if part is not None and id.startswith(f"{part.name}."))
        return next(named, first.name if first else "")

    def title_of(self, name: str) -> str:
        """The title of a part; "" for what is no part."""
        return next((part.title for part in self.parts if part.name == name), "")

    @property
    def pages(self) -> tuple[tuple[str, Key], ...]:
        """The parts by their titles, each with its rows as they stand here; what has none is one part without title."""
        if not self.parts:
            return (("", self),)
        first = 0
        found = []
        for part in self.parts:
            rows = self.rows[first : first + len(part.key.rows)]
            first += len(rows)
            found.append((part.title, replace(part.key, rows=rows, student=self.student)))
        return tuple(found)

    def find(self, id: str) -> KeyRow | None:
        """The row of a quantity, or of the signed rotation whose size it is; None if there is none."""
        return self._by_id.get(id)

    def row(self, id: str) -> KeyRow:
        """The row of a quantity.  Raises `KeyError` if there is none."""
        return self._by_id[id]

    @cached_property
    def _by_id(self) -> Mapping[str, KeyRow]:
        return {row.size: row for row in self.rows} | {row.id: row for row in self.rows}

    @property
    def asked(self) -> tuple[KeyRow, ...]:
        """The rows of the answer sheet, in order."""
        return tuple(row for row in self.rows if row.positions)


@dataclass(frozen=True, slots=True)
class PartOfKey:
    """A part of a coursework: its name in front of its ids in place of the `head` that they have by themselves."""

    name: str
    key: Key
    title: str
    head: str = ""

    def own(self, id: str) -> str:
        """The id that a quantity has in the part by itself."""
        return self.head + id.removeprefix(self.name) if self.head and id else id

    def full(self, id: str) -> str:
        """The id in the coursework of a quantity of the part."""
        return self.name + id.removeprefix(self.head) if self.head and id else id


@dataclass(frozen=True, slots=True)
class Span:
    """The positions that a key has: those of the cycle by their labels, `count` of them in a turn.

    Those in `worked` are written out in full; of very many only those in `printed` stand in the document.
    """

    labels: tuple[str, ...]
    count: int
    worked: tuple[int, ...]
    printed: tuple[int, ...] = ()


INSTANT = Span(("1",), 1, (1,))
"""The one position of an exercise."""


def capitalised(text: str) -> str:
    """A phrase as it stands at the head of a row."""
    return text[:1].upper() + text[1:]
