"""What an assignment comes to, whatever kind of work it is: the one thing that every output is made of.

Whoever makes files, marks or draws a class asks a `Case` and nothing else, and never which kind of case it is.  A
machine is one implementation (`reportgen.cases`), an exercise of plane motion another; a further kind of work is one
more and changes nobody else.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
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
from reportgen.formula import Expression, Operand, Symbol, as_expression, substitute
from reportgen.formula.ledger import Ledger
from reportgen.formula.rounding import printed
from reportgen.formula.sheet import Family
from reportgen.report import Block, Cover, Document
from reportgen.report.key import Key

if TYPE_CHECKING:
    import numpy as np

    from reportgen.drawing.animation import Animation
    from reportgen.drawing.plates import DrawingPlate
    from reportgen.drawing.sheet import DrawingSheet
    from reportgen.formula.ledger import Ledger
    from reportgen.machine.analysis import Analysis
    from reportgen.machine.flywheel import RegulatedCycle
    from reportgen.plans import PlannedLedger
    from reportgen.plans.loads import Polygon
    from reportgen.report.shafts import Shaft


@dataclass(frozen=True, slots=True)
class Misconceptions:
    """What of an assignment is easily taken for something else; marking looks for it.

    `applied` are the given loads by name, `loads` all of them, each of which may be forgotten or reversed.  `readings`
    are for a quantity that is read from a diagram the values [N] that it has when it is read wrongly, with the
    mistake's name.  `whole` is for a length from one end of a rod the length of the whole rod, by ids.  `changed` are
    for a quantity other definitions that are often used, with the mistake's name; `ways` other definitions that are as
    right as its own, of quantities that do not stand on it.
    """

    applied: frozenset[str] = frozenset()
    loads: tuple[str, ...] = ()
    readings: Mapping[str, Sequence[tuple[str, np.ndarray]]] = field(default_factory=dict)
    whole: Mapping[str, str] = field(default_factory=dict)
    changed: Mapping[str, Sequence[tuple[str, Expression]]] = field(default_factory=dict)
    ways: Mapping[str, Sequence[Expression]] = field(default_factory=dict)


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
    `slides`, which does not begin anew), `speed` that of its motion (rad/s or m/s), if it has one.  `signed` are by
    their ids the values [N] of the sizes of vectors along a line, counted in the direction of a unit vector.
    """

    gone: np.ndarray
    whole: float
    speed: float | None
    slides: bool = False
    signed: Mapping[str, tuple[np.ndarray, complex]] = field(default_factory=dict)


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
    def driver_motion(self) -> DriverMotion | None:
        """How its driver goes through its positions; None where these are none of a driver's."""

    @property
    def balance(self) -> np.ndarray | None:
        """The torque or force on the driver that balances the loads [N]; None without loads."""

    @property
    def misconceptions(self) -> Misconceptions:
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

    def animations(self) -> tuple[Animation, ...]:
        """What moves on its page, an animation a part; none where nothing does."""

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """What its drawing sheets show, by the names of the sets."""

    def true_sizes(self) -> Sequence[DrawingSheet]:
        """What is drawn 1:1 on paper of its own, without a frame."""

    def summary(self) -> Sequence[Block]:
        """Its main results, for the summary of a coursework that it is a part of."""

    @property
    def shafts(self) -> Sequence[Shaft]:
        """Its shafts, that which drives it first; none of a work in which nothing turns."""

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
class LoadedAssignment:
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
    def driver_motion(self) -> DriverMotion | None:
        """It has no positions of a driver."""
        return None

    def true_sizes(self) -> Sequence[DrawingSheet]:
        """It has nothing that is made."""
        return ()

    def summary(self) -> Sequence[Block]:
        """Its own report has one."""
        return ()

    @property
    def shafts(self) -> Sequence[Shaft]:
        """Nothing turns."""
        return ()

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
