"""Cases: an assignment with its solution, as the data that every output is made from.

Code that writes files, marks answers or draws variants for a class works with a `Case` and never asks for its kind.
`reportgen.cases` has the case of a machine; every other kind of work has its case in its package, and a new kind
changes no shared code.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.errors import DocumentError, NotOfferedError, TemplateError
from reportgen.base.kinds import title as kind_title
from reportgen.base.languages import UnitNames, languages, setting_of
from reportgen.base.template_folders import search_path
from reportgen.base.words import common_words, load_words, word
from reportgen.case.answer_key import INSTANT, Key, Span
from reportgen.case.result_entries import ResultEntries, entries_of
from reportgen.document import Block, Cover, Document
from reportgen.formula import Expression, Operand, Symbol, as_expression, substitute
from reportgen.formula.calculation import Family
from reportgen.formula.rounded_ledger import printed

if TYPE_CHECKING:
    import numpy as np

    from reportgen.case.shafts import Shaft
    from reportgen.derivation import PlannedLedger
    from reportgen.derivation.load_entries import Polygon
    from reportgen.drawing.animation import Animation
    from reportgen.drawing.drawing_sheet import DrawingSheet
    from reportgen.drawing.plates import DrawingPlate
    from reportgen.formula.ledger import Ledger
    from reportgen.machine.analysis import Analysis


@dataclass(frozen=True, slots=True)
class Misconceptions:
    """Common misconceptions about an assignment, which marking looks for.

    `applied` are the given loads by name, `loads` all of them, each of which may be forgotten or reversed.  `readings`
    give, for a quantity read from a diagram, its values [N] if it is read wrongly, with the mistake's name.  `whole`
    maps a length from one end of a rod to the length of the whole rod, by ids.  `changed` gives other definitions of a
    quantity that are often used, with the mistake's name; `ways` other definitions that are equally right, of
    quantities
    that do not depend on it.  `approximations` gives definitions that books use in place of the exact one, with their
    names.  `designs` gives, for a datum that a design determines from other data, the data with another value of it
    (SI),
    in each way to continue; empty if there is no design.
    """

    applied: frozenset[str] = frozenset()
    loads: tuple[str, ...] = ()
    readings: Mapping[str, Sequence[tuple[str, np.ndarray]]] = field(default_factory=dict)
    whole: Mapping[str, str] = field(default_factory=dict)
    changed: Mapping[str, Sequence[tuple[str, Expression]]] = field(default_factory=dict)
    ways: Mapping[str, Sequence[Expression]] = field(default_factory=dict)
    approximations: Mapping[str, Sequence[tuple[str, Expression]]] = field(default_factory=dict)
    designs: Mapping[str, Callable[[float], Sequence[Mapping[str, np.ndarray]]]] = field(default_factory=dict)


def with_another(families: Mapping[str, Family], instead: Mapping[str, Operand]) -> Iterator[tuple[str, Expression]]:
    """The definitions, by ids, of one who takes something else for a quantity: of all that uses it, and its own.

    So the mistake is found where its result is used, and where it is written down and used no further.
    """
    others = {id: as_expression(other) for id, other in instead.items()}

    def put(node: Expression, what: Mapping[str, Expression]) -> Expression:
        return substitute(node, lambda ref: what.get(ref.id, ref))

    for id, family in families.items():
        if family.definition is not None:
            taken = put(others[id], {id: family.definition}) if id in others else put(family.definition, others)
            if taken != family.definition:
                yield id, taken


@dataclass(frozen=True, slots=True)
class DriverMotion:
    """Motion of a driver through the positions of a cycle, at constant speed.

    `gone` is its way since the first of them [N], `whole` its way through the cycle (rad, or m of one that
    `slides`, which does not begin anew), `called` the name of this way with its unit, in words, `speed` that of its
    motion
    (rad/s or m/s), if it has one.  `signed` gives by id the values [N] of the sizes of vectors along a line,
    counted in the direction of a unit vector.
    """

    gone: np.ndarray
    whole: float
    called: str
    speed: float | None
    slides: bool = False
    signed: Mapping[str, tuple[np.ndarray, complex]] = field(default_factory=dict)


@dataclass(frozen=True)
class AskedFor:
    """Questions of a task, as its words name them."""

    answers: tuple[Block, ...]
    """The empty answer sheet."""
    positions: tuple[str, ...]
    """The labels of the positions at which something is asked for."""
    known: tuple[Block, ...]
    """Given data at each position."""
    scales: bool
    """True if the student chooses scales."""
    by_section: bool = False
    """True if each section of the sheet begins a page."""
    self_check: bool = True
    """True if the student has the data to check a sheet."""


@dataclass(frozen=True)
class Case(ABC):
    """An assignment opened once; each part is computed when it is first asked for.

    It is data: `key`, `task`, `solve`, `sheet` and marking are functions over it, each in the room that owns it.
    Making a part raises `TemplateError` for a fault in the words, and `NotOfferedError` for what this kind has not.
    """

    assignment: Assignment

    @property
    @abstractmethod
    def words(self) -> Mapping[str, Any]:
        """The short words of its language, kind and school."""

    @property
    @abstractmethod
    def title(self) -> str:
        """Name of its kind, in its language."""

    @property
    @abstractmethod
    def course(self) -> str:
        """Name of its course, in its language."""

    # --- its numbers

    @property
    @abstractmethod
    def ledger(self) -> Ledger:
        """Every number by its id, unrounded."""

    @property
    @abstractmethod
    def printed(self) -> Ledger:
        """Every number by its id as it is written down."""

    @property
    @abstractmethod
    def entries(self) -> ResultEntries:
        """Entries at each of its positions, and those for all of them."""

    @property
    def span(self) -> Span:
        """Its positions."""
        return INSTANT

    def sense(self, id: str) -> str:
        """Return the positive sense of a quantity in words; "" for a size or if the general rule applies."""
        return ""

    @property
    def families(self) -> Mapping[str, Family]:
        """Families of the quantities computed at its positions."""
        return self.ledger.families

    @property
    def speed(self) -> float | None:
        """Speed of its driver (rad/s or m/s); None if it has no driver."""
        return None

    @property
    def driver_motion(self) -> DriverMotion | None:
        """Motion of its driver through its positions; None if they are not positions of a driver."""
        return None

    @property
    def balance(self) -> np.ndarray | None:
        """The torque or force on the driver that balances the loads [N]; None without loads."""
        return None

    @property
    def shafts(self) -> Sequence[Shaft]:
        """Its shafts, that which drives it first; none of a work in which nothing turns."""
        return ()

    @property
    def misconceptions(self) -> Misconceptions:
        """Misconceptions that marking looks for, beside the mistakes possible in any formula."""
        return Misconceptions()

    def fault(self) -> str:
        """The code of a fault that shows only in the results, "" if they are sound; variants are judged by it."""
        return ""

    # --- its papers

    @abstractmethod
    def document(self) -> Document:
        """The finished, numbered report."""

    def summary(self) -> Sequence[Block]:
        """Its main results, for the summary of a coursework that it is a part of."""
        return ()

    @property
    def used(self) -> Collection[Symbol] | None:
        """Symbols that its report uses, of quantities, points and general formulas; None if only the report itself
        shows them.
        """
        return None

    def animations(self) -> tuple[Animation, ...]:
        """Return the animations of its page, one for each part; empty if nothing moves."""
        return ()

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the plates of its drawing sheets, by the names of the sets; `every` plate or those usually handed
        in.
        """
        return {}

    @property
    def redrawn(self) -> tuple[float, Callable[[float], Case]] | None:
        """The length (mm) that its crank is drawn with, and the same with another; None where none is drawn."""
        return None

    def true_sizes(self) -> Sequence[DrawingSheet]:
        """Return the drawings in true size (1:1), each on a separate sheet without a frame."""
        return ()

    # --- its parts

    @property
    def parts(self) -> Mapping[str, Case]:
        """The cases that a coursework is made of, by name, that of the machine first; none of a work without parts."""
        return {}


@dataclass(frozen=True)
class CaseOfParts(Case):
    """Case made of cases: it joins the outputs of its parts, with ids, letters and titles for each part."""

    @abstractmethod
    def joined_key(self, keys: Sequence[Key]) -> Key:
        """The key, from those of its parts."""

    @abstractmethod
    def joined_task(self, papers: Sequence[Document]) -> Document:
        """The task, from those of its parts."""

    @abstractmethod
    def joined_plates(self) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the plates of the drawing sheets of the parts that follow its machine."""


# --- an assignment opened once with its words -----------------------------------------------------
# And a machine with all that is computed of it.


Made = TypeVar("Made")


def bounded(assignment: Assignment, make: Callable[..., Made], *arguments: Any) -> Made:
    """Return the result of `make`, a module-level function, for arguments that can be pickled.

    With a school's templates, it runs in a process with limits.  Raises `TemplateError` if a limit ended the process.
    """
    if assignment.school is None:
        return make(*arguments)
    from reportgen.base.process_limits import TEMPLATES, LimitError, call_within

    file = search_path(assignment.language, assignment.kind, assignment.school)[0]
    try:
        return call_within(TEMPLATES, partial(_called, make), arguments)
    except LimitError as error:
        message = word("template_limits", assignment.language, **asdict(TEMPLATES))
        raise TemplateError(f"{file}:1: {message}") from error
    except DocumentError as error:
        raise TemplateError("\n".join(f"{file}:1: {fault}" for fault in error.faults)) from error


def _called(make: Callable[..., Made], arguments: tuple[Any, ...]) -> Made:
    return make(*arguments)


@dataclass(frozen=True)
class LoadedAssignment(Case):
    """An assignment with its words, as a case of a single work."""

    root: Path | None = field(default=None, kw_only=True, compare=False, repr=False)
    """The folder of its templates; None where it is the program's own."""

    def bounded(self, make: Callable[[Self], Made]) -> Made:
        """Return the result of `make`, a module-level function, for this case and its words.

        A school's templates are rendered in a process with limits.  Raises `TemplateError` if a limit ended the
        process.
        """
        if self.assignment.school is None:
            return make(self)
        return bounded(self.assignment, make, type(self)(self.assignment, root=self.places[-1].parent))

    @property
    def places(self) -> tuple[Path, ...]:
        """Folders that are searched for the words of this language, machine and school."""
        assignment = self.assignment
        return search_path(assignment.language, assignment.kind, assignment.school or "", self.root)

    @cached_property
    def words(self) -> Mapping[str, Any]:
        """The short words of `words.yaml`.  Raises `TemplateError`."""
        return load_words(self.places)

    @property
    def unit_names(self) -> UnitNames:
        """Units as the report prints them: as the language does, or the school."""
        return UnitNames({**setting_of(self.assignment.language).units, **self.words["units"]})

    @property
    def course(self) -> str:
        """The course as the assignment names it; by its standard name, whatever the language, in the case's own."""
        standard: str = self.words["cover"]["course"]
        names = {common_words(language)["cover"]["course"] for language in languages()}
        given = self.assignment.report.course
        return given if given and given not in names else standard

    @property
    def place_and_date(self) -> str:
        """Place and date as on the cover; dots replace one that is not given."""
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
        setting = setting_of(self.assignment.language)
        title = labels["title"], self.course
        subtitles = {"variant": variant, "machine": self.title}
        return Cover(
            tuple(part for part in (given.university, given.faculty, given.department) if part),
            # Chinese names the course before what was made in it.
            title if setting.spaced else title[::-1],
            tuple(f"{labels[key]}{setting.colon}{text}" for key, text in subtitles.items() if text),
            tuple((label, value or "") for label, value in fields),
            self.place_and_date,
        )

    @property
    def title(self) -> str:
        """The machine's name in the assignment's language."""
        return kind_title(self.assignment.kind, self.assignment.language)

    @abstractmethod
    def question(self, asked: AskedFor) -> tuple[Sequence[Block], Sequence[Block]]:
        """Return the task from the given data to the empty answer sheet: the title, and the blocks below it."""

    @property
    def variant_line(self) -> str:
        """The variant as headers name it."""
        variant = self.assignment.variant
        return str(self.words["variant"].format(variant=variant)) if variant else ""


@dataclass(frozen=True)
class MachineAnalysis(LoadedAssignment):
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
        from reportgen.derivation import write_ledger

        written = write_ledger(self.analysis, self.unit_names, self.assignment.worked_positions)
        return replace(written, ledger=written.ledger.in_language(self.words["symbols"]))

    @property
    def ledger(self) -> Ledger:
        """Every number by its id, unrounded."""
        return self.written.ledger

    @cached_property
    def printed(self) -> Ledger:
        """Every number by its id as it is written down: all that is printed or drawn comes from here."""
        return printed(self.ledger)

    @cached_property
    def entries(self) -> ResultEntries:
        """Entries at each of its positions."""
        return entries_of(self.analysis)

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The force plans: one for each group, the driver's last; none without loads."""
        return self.written.polygons
