"""A case: an assignment solved, as the data that every output is made from.

Code that writes files, marks answers or draws variants for a class works with a `Case` and never asks for its kind.
`reportgen.cases` has the case of a machine; every other kind of work has its own in its package, and a new kind changes
no shared code.
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
from reportgen.case.key import INSTANT, Key, Span
from reportgen.case.result_entries import ResultEntries, entries_of
from reportgen.document import Block, Cover, Document
from reportgen.formula import Expression, Operand, Symbol, as_expression, substitute
from reportgen.formula.rounding import printed
from reportgen.formula.sheet import Family

if TYPE_CHECKING:
    import numpy as np

    from reportgen.case.shafts import Shaft
    from reportgen.derivation import PlannedLedger
    from reportgen.derivation.loads import Polygon
    from reportgen.drawing.animation import Animation
    from reportgen.drawing.plates import DrawingPlate
    from reportgen.drawing.sheet import DrawingSheet
    from reportgen.formula.ledger import Ledger
    from reportgen.machine.analysis import Analysis


@dataclass(frozen=True, slots=True)
class Misconceptions:
    """What of an assignment is easily taken for something else; marking looks for it.

    `applied` are the given loads by name, `loads` all of them, each of which may be forgotten or reversed.  `readings`
    are for a quantity that is read from a diagram the values [N] that it has when it is read wrongly, with the
    mistake's name.  `whole` is for a length from one end of a rod the length of the whole rod, by ids.  `changed` are
    for a quantity other definitions that are often used, with the mistake's name; `ways` other definitions that are as
    right as its own, of quantities that do not stand on it.  `approximations` are for a quantity definitions that books
    use in place of the exact one, with their names.  `designs` are for a datum that a design is found by what other
    data are with another value of it (SI), in each way in which one may go on; none where there is no design.
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
    """How a driver goes through the positions of a cycle, at constant speed.

    `gone` is how far it has gone since the first of them [N], `whole` its way through the cycle (rad, or m of one that
    `slides`, which does not begin anew), `called` what this way is with its unit, in words, `speed` that of its motion
    (rad/s or m/s), if it has one.  `signed` are by their ids the values [N] of the sizes of vectors along a line,
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
    """What a task asks for, as its words name it."""

    answers: tuple[Block, ...]
    """The empty answer sheet."""
    positions: tuple[str, ...]
    """The labels of the positions at which something is asked for."""
    known: tuple[Block, ...]
    """What is given at each position."""
    scales: bool
    """Whether scales are to be chosen."""
    by_section: bool = False
    """Whether each section of the sheet begins a page."""
    self_check: bool = True
    """Whether the student has what a sheet is checked by."""


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
        """What its kind is called, in its language."""

    @property
    @abstractmethod
    def course(self) -> str:
        """What its course is called, in its language."""

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
        """What holds at each of its positions, and besides."""

    @property
    def span(self) -> Span:
        """Its positions."""
        return INSTANT

    def sense(self, id: str) -> str:
        """Which sense of a quantity counts as positive, in words; "" for what is a size or follows the general rule."""
        return ""

    @property
    def families(self) -> Mapping[str, Family]:
        """What is worked out at its positions."""
        return self.ledger.families

    @property
    def speed(self) -> float | None:
        """Of its driver (rad/s or m/s); None where nothing drives it."""
        return None

    @property
    def driver_motion(self) -> DriverMotion | None:
        """How its driver goes through its positions; None where these are none of a driver's."""
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
        """What marking looks for beside the mistakes that any formula may have."""
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
        """The symbols that its report uses, of quantities, points and general formulas; None where it alone tells."""
        return None

    def animations(self) -> tuple[Animation, ...]:
        """What moves on its page, an animation a part; none where nothing does."""
        return ()

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """What its drawing sheets show, by the names of the sets; `every` plate or those usually handed in."""
        return {}

    @property
    def redrawn(self) -> tuple[float, Callable[[float], Case]] | None:
        """The length (mm) that its crank is drawn with, and the same with another; None where none is drawn."""
        return None

    def true_sizes(self) -> Sequence[DrawingSheet]:
        """What is drawn 1:1 on paper of its own, without a frame."""
        return ()

    # --- its parts

    @property
    def parts(self) -> Mapping[str, Case]:
        """The cases that a coursework is made of, by name, that of the machine first; none of a work without parts."""
        return {}


@dataclass(frozen=True)
class CaseOfParts(Case):
    """A case made of cases: how what is made of each becomes one, with ids, letters and titles of its own."""

    @abstractmethod
    def joined_key(self, keys: Sequence[Key]) -> Key:
        """The key, from those of its parts."""

    @abstractmethod
    def joined_task(self, papers: Sequence[Document]) -> Document:
        """The task, from those of its parts."""

    @abstractmethod
    def joined_plates(self) -> Mapping[str, Sequence[DrawingPlate]]:
        """What the drawing sheets of the parts show that follow its machine."""


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
class LoadedAssignment(Case):
    """An assignment with its words, as a case of a single work."""

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
        """What a student is handed, from the given data to the empty answer sheet: the title, and what follows it."""

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
        """What holds at each of its positions."""
        return entries_of(self.analysis)

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The force plans: one for each group, the driver's last; none without loads."""
        return self.written.polygons
