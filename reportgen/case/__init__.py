"""Cases: an assignment with its solution, the source of every output.

Code that writes files, marks answers or draws variants works with a `Case` and never asks for its kind.
`reportgen.cases` has the case of a machine; every other kind has its case in its own package, so that a new kind
changes no shared code.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.errors import DocumentError, NotOfferedError, TemplateError
from reportgen.base.kinds import title as kind_title
from reportgen.base.languages import UnitNames, languages, setting_of
from reportgen.base.records import Record, asdict, field, replace
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

    from reportgen.case.missing_chapters import MissingChapter
    from reportgen.case.shafts import Shaft
    from reportgen.derivation import PlannedLedger
    from reportgen.derivation.load_entries import Polygon
    from reportgen.drawing.animation import Animation
    from reportgen.drawing.drawing_sheet import DrawingSheet
    from reportgen.drawing.plates import DrawingPlate
    from reportgen.formula.ledger import Ledger
    from reportgen.machine.analysis import Analysis


class Misconceptions(Record):
    """Common misconceptions about an assignment, which marking looks for.

    `applied` are the names of the given loads, `loads` those of all loads, each of which may be forgotten or reversed.
    `readings` gives, for a quantity read from a diagram, its wrongly read values [N] with the mistake's name.  `whole`
    maps a length from one end of a rod to the length of the whole rod, by ids.  `changed` gives other definitions of a
    quantity that students often use, with the mistake's name; `alternatives` gives equally right definitions of
    quantities that do not depend on it.  `approximations` gives definitions that books use instead of the exact one,
    with their names.  `designs` gives, for a datum that a design determines, the data that follow from another value of
    it (SI), one set for each way to continue; empty without a design.
    """

    applied: frozenset[str] = frozenset()
    loads: tuple[str, ...] = ()
    readings: Mapping[str, Sequence[tuple[str, np.ndarray]]] = field(default_factory=dict)
    whole: Mapping[str, str] = field(default_factory=dict)
    changed: Mapping[str, Sequence[tuple[str, Expression]]] = field(default_factory=dict)
    alternatives: Mapping[str, Sequence[Expression]] = field(default_factory=dict)
    approximations: Mapping[str, Sequence[tuple[str, Expression]]] = field(default_factory=dict)
    designs: Mapping[str, Callable[[float], Sequence[Mapping[str, np.ndarray]]]] = field(default_factory=dict)


def with_another(families: Mapping[str, Family], instead: Mapping[str, Operand]) -> Iterator[tuple[str, Expression]]:
    """Yield the definitions, by ids, in which another operand replaces a quantity: those of its dependents, and its
    own.

    Marking thus finds the mistake where its result is used, and also where it is only written down.
    """
    others = {id: as_expression(other) for id, other in instead.items()}

    def put(node: Expression, what: Mapping[str, Expression]) -> Expression:
        return substitute(node, lambda ref: what.get(ref.id, ref))

    for id, family in families.items():
        if family.definition is not None:
            taken = put(others[id], {id: family.definition}) if id in others else put(family.definition, others)
            if taken != family.definition:
                yield id, taken


class DriverMotion(Record):
    """Motion of a driver through the positions of a cycle, at constant speed.

    `gone` [N] is its travel since the first position and `whole` its travel in a cycle (rad, or m if it `slides` and
    does not start anew); `called` is the name of this travel with its unit, `speed` its speed (rad/s or m/s), None if
    it has none.  `signed` gives, by the ids of sizes of vectors along a line, their signed values [N] and the unit
    vector of the positive direction.
    """

    gone: np.ndarray
    whole: float
    called: str
    speed: float | None
    slides: bool = False
    signed: Mapping[str, tuple[np.ndarray, complex]] = field(default_factory=dict)


class AskedFor(Record):
    """Questions of a task for its templates."""

    answers: tuple[Block, ...]
    """The empty answer sheet."""
    positions: tuple[str, ...]
    """Labels of the positions at which the task asks for something."""
    known: tuple[Block, ...]
    """Given data at each position."""
    scales: bool
    """True if the student chooses scales."""
    by_section: bool = False
    """True if each section of the answer sheet begins a page."""
    self_check: bool = True
    """True if the student has the data to check an answer sheet."""


@dataclass(frozen=True)
class Case(ABC):
    """An opened assignment; each part is computed when it is first used.

    A case is data: `key`, `task`, `solve`, `sheet` and marking are functions of other packages.  Members raise
    `TemplateError` for a fault in the templates, and `NotOfferedError` for something that this kind does not have.
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
        """Every number by its id, rounded as it is printed."""

    @property
    @abstractmethod
    def entries(self) -> ResultEntries:
        """Entries at each of its positions, and those for all of them."""

    @property
    def span(self) -> Span:
        """Its positions."""
        return INSTANT

    def sense(self, id: str) -> str:
        """Return the phrase for the positive sense of a quantity; "" for a size, or if the general rule applies."""
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
        """Its shafts, the driving one first; () if nothing turns."""
        return ()

    @property
    def misconceptions(self) -> Misconceptions:
        """Misconceptions that marking looks for, in addition to the mistakes possible in any formula."""
        return Misconceptions()

    def fault(self) -> str:
        """Return the code of a fault that only the results show, "" if they are sound.  Variants with a fault are
        rejected.
        """
        return ""

    # --- its documents

    @abstractmethod
    def document(self) -> Document:
        """Return the finished, numbered report."""

    def summary(self) -> Sequence[Block]:
        """Return its main results for the summary of a coursework; () if it has none."""
        return ()

    @property
    def missing_chapters(self) -> Sequence[MissingChapter]:
        """Chapters that its report would have if the file gave more; in order."""
        return ()

    @property
    def used(self) -> Collection[Symbol] | None:
        """Symbols that its report uses: of quantities, points and general formulas.  None if they must be read from the
        report.
        """
        return None

    def animations(self) -> tuple[Animation, ...]:
        """Return the animations of its page, one for each part; empty if nothing moves."""
        return ()

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the plates of its drawing sheets, by the names of the sets.

        `every` selects all plates, not only those usually handed in.
        """
        return {}

    @property
    def redrawn(self) -> tuple[float, Callable[[float], Case]] | None:
        """The drawn length (mm) of its crank, and a function that returns the case with another one; None if no crank
        is drawn.
        """
        return None

    def true_sizes(self) -> Sequence[DrawingSheet]:
        """Return the drawings in true size (1:1), each on a separate drawing sheet without a border."""
        return ()

    # --- its parts

    @property
    def parts(self) -> Mapping[str, Case]:
        """The cases of a coursework by name, that of the machine first; {} if it has no parts."""
        return {}


@dataclass(frozen=True)
class CaseOfParts(Case):
    """A case made of cases: it joins the outputs of its parts, with ids, symbols and titles for each part."""

    @property
    @abstractmethod
    def lengths_of_parts(self) -> Mapping[str, str]:
        """The ids of the lengths that parts give, by the ids under which the machine's ledger has them."""

    @abstractmethod
    def joined_key(self, keys: Sequence[Key]) -> Key:
        """Return the answer key, joined from those of the parts."""

    @abstractmethod
    def joined_task(self, papers: Sequence[Document]) -> Document:
        """Return the task, joined from those of the parts."""

    @abstractmethod
    def joined_plates(self) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the plates of the drawing sheets of the parts, without those of the machine."""


# --- an assignment opened once with its words -----------------------------------------------------
# The case of a machine includes everything that is computed for it.


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

    root: Path | None = dataclass_field(default=None, kw_only=True, compare=False, repr=False)
    """The folder of its templates; None for the program's own."""

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
        """The short words from `words.yaml`.  Raises `TemplateError`."""
        return load_words(self.places)

    @property
    def unit_names(self) -> UnitNames:
        """Units as the report prints them, in the spelling of the language or of the school."""
        return UnitNames({**setting_of(self.assignment.language).units, **self.words["units"]})

    @property
    def course(self) -> str:
        """The course that the assignment names.  A standard name, whatever its language, appears in the case's own
        language.
        """
        standard: str = self.words["cover"]["course"]
        given = self.assignment.report.course
        if not given or given == standard:
            # Usual, and the words of other languages take long to read.
            return standard
        names = (common_words(language)["cover"]["course"] for language in languages())
        return standard if given in names else given

    @property
    def place_and_date(self) -> str:
        """Place and date as printed on the cover, with dots for a missing one."""
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
        """The title page, with a dotted line for each missing field."""
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
        """Return the title of the task, and its blocks from the given data to the empty answer sheet."""

    @property
    def variant_line(self) -> str:
        """The variant as page headers print it; "" without a variant."""
        variant = self.assignment.variant
        return str(self.words["variant"].format(variant=variant)) if variant else ""


@dataclass(frozen=True)
class MachineAnalysis(LoadedAssignment):
    """A machine's assignment with everything that is computed for it."""

    @cached_property
    def analysis(self) -> Analysis:
        """All computed values, as arrays over the positions.

        Raises `NotOfferedError` for a kind that is not a machine.
        """
        from reportgen.machine.analysis import analyse

        kind, language = self.assignment.kind, self.assignment.language
        machine = getattr(catalogue.module(kind), "machine", None)
        if machine is None:
            raise NotOfferedError(word("no_machine", language, kind=kind))
        return analyse(machine(self.assignment))

    @cached_property
    def written(self) -> PlannedLedger:
        """The ledger with the force plans, in the symbols and units of the assignment's language."""
        from reportgen.derivation import write_ledger

        written = write_ledger(self.analysis, self.unit_names, self.assignment.worked_positions)
        return replace(written, ledger=written.ledger.in_language(self.words["symbols"]))

    @property
    def ledger(self) -> Ledger:
        """Every number by its id, unrounded."""
        return self.written.ledger

    @cached_property
    def printed(self) -> Ledger:
        """Every number by its id, rounded as printed: all texts and drawings take their numbers from here."""
        return printed(self.ledger)

    @cached_property
    def entries(self) -> ResultEntries:
        """Entries at each of its positions."""
        return entries_of(self.analysis)

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The force plans, one for each group, the driver's last; () without loads."""
        return self.written.polygons
