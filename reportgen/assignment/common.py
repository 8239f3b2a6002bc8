"""Models of the part of an assignment file that every kind of machine shares."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from reportgen.assignment.fields import (
    Angle,
    Date,
    Flag,
    Instant,
    Interval,
    LanguageName,
    OneLine,
    Ratio,
    SchoolFolder,
    Whole,
    WorkedPositions,
    quantity,
)
from reportgen.base.errors import Finding, UnknownNameError
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import DEFAULT_LANGUAGE
from reportgen.base.units import Given, Language
from reportgen.base.words import named_school, unknown

POSITIONS = "positions"
"""The section or parameter with the number of positions of a turn."""
FEWEST_POSITIONS, MOST_POSITIONS = 4, 360
Count = Annotated[int, Whole(FEWEST_POSITIONS, MOST_POSITIONS)]
MOST_INSTANTS = 24
TENS, ONES = ("", "X", "XX"), ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX")
ROMAN = tuple(ten + one for ten in TENS for one in ONES)[: MOST_INSTANTS + 1]
"""Roman numbers up to that of the last instant; index 0 is unused."""
Extent = Literal["full", "short"]


class Part(BaseModel):
    """A section of the file: frozen, its keys known."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, defer_build=True, populate_by_name=True, arbitrary_types_allowed=True
    )

    @model_validator(mode="before")
    @classmethod
    def _without_empty(cls, content: Any) -> Any:
        """Drop known keys without a value, as if they were absent."""
        if not isinstance(content, dict):
            return content
        known = {field.alias or name for name, field in cls.model_fields.items()}
        return {key: value for key, value in content.items() if value is not None or key not in known}


class Student(Part):
    """The student who hands the report in; a missing value becomes a blank line to fill in."""

    name: OneLine | None = None
    id: OneLine | None = None
    class_: OneLine | None = Field(default=None, alias="class")
    section: OneLine | None = None
    email: OneLine | None = None


class ReportSection(Part):
    """The report's language, cover and the positions calculated in full, by number or label (None: all).

    `extent` is the amount that the report of a machine contains; an exercise has one extent and ignores it. `school`
    names a folder of templates whose words override the common ones, `templates` one beside the file. `sheets` is the
    paper size of the drawing sheets that are handed in with the report; `listing` adds a program of the closed
    formulas.  `font` and `size` are those of the text.
    """

    language: Annotated[Language, LanguageName()] = DEFAULT_LANGUAGE
    extent: Extent = "full"
    school: Annotated[str, SchoolFolder()] | None = None
    templates: OneLine | None = None
    font: OneLine | None = None
    size: Literal["11 pt", "12 pt", "13 pt", "14 pt"] = "12 pt"
    university: OneLine | None = None
    faculty: OneLine | None = None
    department: OneLine | None = None
    course: OneLine | None = None
    student: Student = Student()
    supervisor: OneLine | None = None
    place: OneLine | None = None
    date: Date | None = None
    worked_positions: Annotated[tuple[int | str, ...] | None, WorkedPositions()] = (2,)
    sheets: Literal["A0", "A1", "A2", "A3"] | None = None
    listing: Annotated[bool, Flag()] = False


class Positions(Part):
    """Number of positions of a turn, sense of the driver, and start.

    `start` is the driver's angle from +x; None is the usual start of the kind.  Instants `at` places of the driver
    (angles of a crank from +x, displacements of a slider) replace the evenly spaced positions.
    """

    count: Count = 8
    direction: Literal["anticlockwise", "clockwise"] = "anticlockwise"
    start: Angle | None = None
    at: Annotated[tuple[Instant, ...], Field(min_length=1, max_length=MOST_INSTANTS)] | None = None

    @property
    def number(self) -> int:
        """Number of positions in a turn, or of instants."""
        return len(self.at) if self.at else self.count

    @property
    def first(self) -> Given | None:
        """The driver's angle or displacement in position 1; None for the usual start of the kind."""
        return self.at[0] if self.at else self.start

    def instants(self, turns: int = 1) -> tuple[float, ...]:
        """Return the angles (rad) of a crank from the first instant to each, within a cycle of `turns` turns."""
        whole = turns * 2 * math.pi
        at = self.at or ()
        return tuple(self.sign * (one.si - at[0].si) % whole if one is not at[0] else 0.0 for one in at)

    @property
    def sign(self) -> int:
        """+1 anticlockwise, −1 clockwise."""
        return 1 if self.direction == "anticlockwise" else -1

    def start_or(self, natural: float = 0.0) -> float:
        """Return the driver's angle in position 1 (rad): as given, else the `natural` one."""
        return natural if self.first is None else self.first.si


class Drawing(Part):
    """Requested lengths on paper; None is chosen automatically."""

    crank: Annotated[Given, quantity("mm", least=0.1, most=150)] | None = None


class SheetSection(Part):
    """Texts of drawing sheets that the report does not contain: their designation, or the code of the course in it."""

    designation: OneLine | None = None
    course: OneLine | None = None


class Draft(Record):
    """An assignment during checking: plain content, and the sections that are valid on their own."""

    raw: Mapping[str, Any]
    sections: Mapping[str, Any]

    def at(self, *where: str) -> Any:
        """Return the content of the file at a path; None if there is none."""
        content: Any = self.raw
        for key in where:
            content = content.get(key) if isinstance(content, dict) else None
        return content


Check = Callable[[Draft], Iterator[Finding]]
Extended = tuple[type[Part], tuple[Check, ...]]
"""Parameters with the sections of topics, and the checks of these topics."""
Labels = Callable[[Any, Positions], Sequence[str]]
"""Function that returns the labels of the positions of the cycle, from the parameters and the positions of a turn."""


class Kind(Record):
    """Data of a kind of machine that the reader needs.

    `base` are the parameters of the kind itself, to which `topics` add sections: `extended` returns the parameters with
    the sections of some topics, and their checks. `turns` of the driver make a cycle; `indicator` is the type of the
    section of that name, None for a machine without one; `checks` examine several values together. `labels` exists for
    a kind that adds positions to the evenly spaced ones. A kind that is a single instant of a motion has no positions
    and no chosen drawn length. `part` is the prefix of the ids of a kind that can be a part of a coursework; "" for
    other kinds. `lengths` returns the lengths that such a part can give the machine, by their letters; None if it gives
    none. `lengths_of_parts` are the keys whose lengths parts can give a machine. `positions` and `drawing` are the
    sections of these names, in which a kind may have its own defaults.
    """

    name: str
    base: type[Part]
    indicator: Any = None
    turns: int = 1
    checks: tuple[Check, ...] = ()
    labels: Labels | None = None
    indicator_optional: bool = False
    has_positions: bool = True
    part: str = ""
    lengths: Callable[[Assignment], Mapping[str, SolvedLength]] | None = None
    lengths_of_parts: tuple[str, ...] = ()
    positions: type[Positions] = Positions
    drawing: type[Drawing] = Drawing
    topics: tuple[str, ...] = ()
    extended: Callable[[type[Part], tuple[str, ...]], Extended] | None = None

    @property
    def parameters(self) -> type[Part]:
        """The parameters with the sections of all its topics."""
        return self.base if self.extended is None else self.extended(self.base, self.topics)[0]

    @property
    def all_checks(self) -> tuple[Check, ...]:
        """The checks of the kind and of its topics."""
        return self.checks if self.extended is None else (*self.checks, *self.extended(self.base, self.topics)[1])

    def asking(self, keys: Collection[str]) -> Kind:
        """Return the same kind with only those topics that are among the keys of a file's parameters."""
        return replace(self, topics=tuple(topic for topic in self.topics if topic in keys))

    @property
    def counts_positions(self) -> bool:
        """True if the number of positions of a turn can be chosen, in a section or among the parameters."""
        return self.has_positions or POSITIONS in self.base.model_fields


class Assignment(Record):
    """A valid assignment file: text kept as typed, quantities in SI beside their typed text.

    `parameters` and `indicator` are models of the kind; `turns` of the driver make a cycle; `id` is the stem of the
    file.
    """

    kind: str
    variant: str
    report: ReportSection
    positions: Positions
    drawing: Drawing
    sheet: SheetSection
    parameters: Any
    indicator: Any
    source: Path
    id: str
    turns: int = 1
    names: Labels | None = None
    parts: tuple[AssignedPart, ...] = ()
    lengths: tuple[LengthOfPart, ...] = ()
    """Lengths of a machine that parts of its coursework give."""
    is_part: bool = False
    """True if it is itself a part of a coursework, whose common sections are in the coursework's file."""

    @property
    def language(self) -> Language:
        return self.report.language

    @property
    def school(self) -> Path | None:
        """The folder of a school's templates: the one named for the run, else the file's own, else that of its name."""
        report = self.report
        if (named := named_school()) is not None:
            return named
        if report.templates is not None:
            return (self.source.parent / report.templates).absolute()
        return None if report.school is None else Path(report.school)

    @property
    def labels(self) -> Sequence[str]:
        """Labels of the positions of a whole cycle: N, or 2N for four strokes, and those that the kind adds."""
        return labels_of(self.names, self.parameters, self.positions, self.turns)

    @property
    def cycle_positions(self) -> int:
        """Number of positions of a whole cycle."""
        return len(self.labels)

    @property
    def worked_positions(self) -> tuple[int, ...]:
        """Numbers, 1…`cycle_positions`, of the positions calculated in full."""
        worked = named_worked(self.report, self.positions)
        if worked is None:
            return tuple(range(1, self.cycle_positions + 1))
        return tuple(self.labels.index(one) + 1 if isinstance(one, str) else one for one in worked)

    def position(self, named: str) -> int:
        """Return the number of the position with a label or number; raises `UnknownNameError` if there is none."""
        position = number_of(named, self.labels) or (number_of(int(named), self.labels) if named.isdecimal() else 0)
        if not position:
            raise UnknownNameError(unknown("no_position", named, self.labels, self.language))
        return position

    def key_of_part(self, key: str) -> str:
        """Return a key of the parameters if a part of the coursework gives its length; else ""."""
        return key if any(length.key == key for length in self.lengths) else ""

    def with_positions(self, count: int) -> Assignment:
        """Return the same assignment with `count` positions per turn; worked positions beyond the new cycle are
        dropped.

        Raises `ValueError` for a count outside 4…360.
        """
        if not FEWEST_POSITIONS <= count <= MOST_POSITIONS:
            raise ValueError(f"{count} positions")
        if POSITIONS in type(self.parameters).model_fields:
            return replace(self, parameters=self.parameters.model_copy(update={POSITIONS: count}))
        counted = replace(self, positions=self.positions.model_copy(update={"count": count, "at": None}))
        worked = self.report.worked_positions
        labels = counted.labels
        kept = None if worked is None else tuple(one for one in worked if number_of(one, labels)) or (2,)
        return replace(counted, report=self.report.model_copy(update={"worked_positions": kept}))

    def with_worked(self, position: int) -> Assignment:
        """Return the same assignment with a single worked position, by its number."""
        return replace(self, report=self.report.model_copy(update={"worked_positions": (position,)}))

    def with_language(self, language: Language) -> Assignment:
        """Return the same assignment in another language."""
        return replace(self, report=self.report.model_copy(update={"language": language}))

    def with_extent(self, extent: Extent) -> Assignment:
        """Return the same assignment with another extent of the report."""
        return replace(self, report=self.report.model_copy(update={"extent": extent}))

    def with_listing(self) -> Assignment:
        """Return the same assignment with the program of its closed formulas in the report."""
        return replace(self, report=self.report.model_copy(update={"listing": True}))


class SolvedLength(Record):
    """A length that a part finds: its id in the part, and the length as the part prints it, with its unit."""

    id: str
    text: str


class LengthOfPart(Record):
    """A length that a machine takes from a part: the machine's key, the part by its index, the id in the part."""

    key: str
    part: int
    id: str


class TakenDatum(Record):
    """A value that a part takes from the machine: its key, the path of the machine's value, the ratio as typed."""

    key: str
    of: str
    times: str = "1"


class AssignedPart(Record):
    """A part of a coursework with its assignment.

    Its ids begin with `head`, like those of its kind; in the coursework they begin with `name`, which is unique among
    the parts. Without a `title` it has that of its kind.
    """

    name: str
    head: str
    title: str
    alone: Assignment
    taken: tuple[TakenDatum, ...] = ()

    def within(self, whole: Assignment) -> Assignment:
        """Return the part's assignment in the coursework of `whole`: with its cover, its language and its extent."""
        settings = {key: getattr(whole.report, key) for key in whole.report.model_fields_set - {"worked_positions"}}
        report = ReportSection.model_construct(**settings)
        return replace(self.alone, report=report, variant=whole.variant, id=whole.id, is_part=True)


class _Taken(Part):
    of: OneLine
    times: Annotated[Given, Ratio(Interval(least=1e-6, most=1e6))] | None = None


class NamedPart(Part):
    """A part as the file names it: by `file`, or with its sections in place.

    It takes data `from` the machine, and `gives` lengths to keys of the machine, by their letters in the part.
    """

    file: OneLine | None = None
    title: OneLine | None = None
    from_: dict[str, _Taken] = Field(default={}, alias="from")
    gives: dict[str, OneLine] = {}
    kind: OneLine | None = None
    variant: OneLine | None = None
    report: dict[str, Any] | None = None
    parameters: dict[str, Any] | None = None
    positions: dict[str, Any] | None = None
    drawing: dict[str, Any] | None = None


PARTS = "parts"
"""The section of a coursework's further parts."""


def sections(kind: Kind | None) -> dict[str, tuple[Any, Any]]:
    """Return the keys of the file besides `kind`: type and default (`...`: required); None gives the common ones."""
    common: dict[str, tuple[Any, Any]] = {
        "variant": (OneLine, ""),
        "report": (ReportSection, ReportSection()),
        "positions": (Positions, Positions()),
        "drawing": (Drawing, Drawing()),
        "sheet": (SheetSection, SheetSection()),
    }
    if kind is None:
        return common
    common["positions"], common["drawing"] = (kind.positions, kind.positions()), (kind.drawing, kind.drawing())
    if not kind.has_positions:
        shared = {name: common[name] for name in ("variant", "report", "sheet")}
        return {**shared, "parameters": (kind.parameters, ...)}
    parameters = {**common, "parameters": (kind.parameters, ...), PARTS: (tuple[NamedPart, ...], ())}
    if kind.indicator is None:
        return parameters
    optional = (kind.indicator | None, None)
    return {**parameters, "indicator": optional if kind.indicator_optional else (kind.indicator, ...)}


def file_model(kind: Kind) -> type[Part]:
    """Return the model of a whole file of one kind, for its JSON Schema."""
    name = "".join(word.title() for word in re.split("[-/]", kind.name))
    fields: dict[str, Any] = {"kind": (Literal[kind.name], ...), **sections(kind)}
    return create_model(f"{name}File", __base__=Part, **fields)


def named_worked(report: ReportSection, positions: Positions) -> tuple[int | str, ...] | None:
    """Return the positions calculated in full as the file names them (None: all); all instants if it names none."""
    untold = "worked_positions" not in report.model_fields_set
    return None if positions.at and untold else report.worked_positions


def labels_of(names: Labels | None, parameters: Any, positions: Positions, turns: int) -> Sequence[str]:
    """Return the labels of the positions of a cycle of `turns` turns: their numbers, if the kind has no labels.

    Instants have Roman numbers in any kind.
    """
    if positions.at:
        return ROMAN[1 : len(positions.at) + 1]
    if names is None or parameters is None:
        return tuple(map(str, range(1, positions.count * turns + 1)))
    return names(parameters, positions)


def number_of(named: int | str, labels: Sequence[str]) -> int:
    """Return the number, from 1, of the position of a number or a label; 0 if there is no such position."""
    if isinstance(named, str):
        return labels.index(named) + 1 if named in labels else 0
    return named if named <= len(labels) else 0
