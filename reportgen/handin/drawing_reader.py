"""Read a drawing: find its plans, and measure lengths and directions of their vectors at the scale of each plan.

Plans of the key are searched for first, then plans of the student's own values among the remaining lines. Coordinates
are complex: in drawing units in a file, in mm while plans are searched for.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from reportgen.base.errors import Fault, Location
from reportgen.base.records import Record, replace
from reportgen.base.units import MM
from reportgen.case.answer_key import Key
from reportgen.handin import FileReading
from reportgen.handin.dxf_lines import DrawnLines, DrawnText
from reportgen.handin.line_repair import distinct, meant
from reportgen.handin.line_set import Lines
from reportgen.handin.plan_finder import FoundPlans, find
from reportgen.handin.plan_fit import SEEN, Fit
from reportgen.handin.plan_labels import Labels
from reportgen.handin.plan_shapes import PlanShape, PlanSketch
from reportgen.handin.wrong_vectors import WrongVector, wrong_vectors
from reportgen.marking.marking_data import Answer, Place, ReadOff
from reportgen.marking.marking_scheme import Values
from reportgen.marking.tolerance_bands import PAPER_ERROR
from reportgen.workbook.zip_package import RefusedError

OFF = PAPER_ERROR * MM
"""Largest error (mm) of a drawn end in each direction, as for measuring on paper."""
MOST_LINES = 20_000
"""Largest number of lines in which plans are searched for."""
USUAL = (1.0, 10.0, 1000.0, 25.4)
"""Common drawing units (mm), which are tried if the unit that the file names gives no plans."""


class DrawnLocation(Location):
    """The start of a vector in a drawing (`at`) and its right end (`right`), both in drawing units of `unit` mm.

    `wrong` is True if the vector does not end there.
    """

    at: complex = 0j
    right: complex = 0j
    unit: float = 1.0
    wrong: bool = False
    space: bytes = b""
    """Block of the paper sheet that it is on, "" in model space."""

    def __str__(self) -> str:
        return f"{self.file}:({self.at.real:.6g}, {self.at.imag:.6g})"

    @property
    def place(self) -> tuple[str, int, int, int]:
        """Sort key, in whole drawing units: a drawing is read from top to bottom."""
        return (self.file, 0, round(-self.at.imag), round(self.at.real))


class WantedPlans(Record):
    """The plans of an assignment that are searched for in a drawing.

    `known` are the key's values and `worlds` a student's own ones (SI, [1] or [N] over the positions, by id).
    """

    key: Key
    sketches: Sequence[PlanSketch]
    known: Values
    worlds: Sequence[Values] = ()
    words: frozenset[str] = frozenset()
    """The words for “position”, plain and in lower case."""

    def shapes(self, values: Values) -> list[PlanShape]:
        """Return the plans at all positions, from SI values by id, [1] or [N] over the positions."""
        return [shape for sketch in self.sketches for shape in sketch.shapes(values)]

    def labels(self, texts: Sequence[DrawnText]) -> Labels:
        """Return the labels among texts, whose places and heights are in mm."""
        names = {label.casefold(): k for k, label in enumerate(self.key.labels, start=1)}
        return Labels(tuple(texts), self.words, names)


def read_drawing(drawn: DrawnLines, file: str, wanted: WantedPlans) -> FileReading:
    """Return the reading of the wanted plans in a drawing, in model space and on its paper sheets.

    The drawing is in its own units. Lengths read are in mm at the report's scale, directions in degrees. Raises
    `RefusedError` if it has more lines than any drawing of plans.
    """
    spaces = (drawn, *drawn.sheets)
    if sum(len(space.ends) for space in spaces) > MOST_LINES:
        raise RefusedError("drawing-lines", Location(file), most=str(MOST_LINES))
    readings = [_read_space(space, file, wanted) for space in spaces if len(space.ends)]
    whole = FileReading(wanted.key.id, file, {}, notes=drawn.notes)
    for reading in readings:
        whole = _with_space(whole, reading)
    if whole.drawn:
        return whole
    return replace(whole, notes=(*drawn.notes, Fault("drawing-no-plans", Location(file))))


def _with_space(first: FileReading, second: FileReading) -> FileReading:
    """Return both readings as one; a place whose two values differ by more than their errors is unread."""
    both = first.values.keys() & second.values.keys()
    clash = {
        place
        for place in both
        if abs(first.values[place].value - second.values[place].value)
        > first.measured[place].error + second.measured[place].error
    }
    values = {place: answer for place, answer in {**second.values, **first.values}.items() if place not in clash}
    unread = {place: fault for place, fault in {**second.unread, **first.unread}.items() if place not in values}
    unread |= {place: Fault("unread-two-plans", second.values[place].location) for place in clash}
    return replace(
        first,
        values=values,
        unread=unread,
        measured={place: {**second.measured, **first.measured}[place] for place in values},
        drawn=first.drawn | second.drawn,
        beside={**second.beside, **first.beside},
    )


def _read_space(drawn: DrawnLines, file: str, wanted: WantedPlans) -> FileReading:
    """Return the reading of one space of a drawing, in the unit that the file names or else in a usual one."""
    searches: list[_Search] = []
    for unit in dict.fromkeys((*((drawn.unit,) if drawn.unit else ()), *USUAL)):
        searches.append(_Search.of(drawn, unit, wanted))
        if searches[-1].plans.plans:
            break
    best = searches[-1] if searches[-1].plans.plans else searches[0]
    return _Reading(best, wanted.key, file, drawn.space).read()


class _Search(Record):
    """The lines of a drawing in mm, and the plans found among them."""

    unit: float
    lines: Lines
    plans: FoundPlans
    wrong: tuple[WrongVector, ...] = ()

    @classmethod
    def of(cls, drawn: DrawnLines, unit: float, wanted: WantedPlans) -> _Search:
        ends = drawn.ends * unit
        whole, heads = meant(Lines(distinct(ends[np.abs(ends[:, 1] - ends[:, 0]) > OFF]), OFF))
        kept = np.flatnonzero(np.abs(whole.ends[:, 1] - whole.ends[:, 0]) > 2 * whole.reach)
        lines, heads = whole.only(kept), heads[kept]
        texts = [DrawnText(text.text, text.at * unit, text.height * unit) for text in drawn.texts]
        labels = wanted.labels(texts)
        plans = find(wanted.shapes(wanted.known), lines, labels)
        for world in wanted.worlds:
            plans = _with_own(plans, wanted.shapes(world), lines, labels)
        return cls(unit, lines, plans, wrong_vectors(plans, lines, heads, labels))


def _with_own(plans: FoundPlans, shapes: Sequence[PlanShape], lines: Lines, labels: Labels) -> FoundPlans:
    """Return the plans found, with plans of a student's own values in place of missing or incomplete ones.

    They are searched for among the lines that no complete plan uses.
    """
    least = SEEN * lines.error
    before = {(fit.shape.scale, fit.shape.position): fit for fit in plans.plans}
    whole = {place for place, fit in before.items() if not fit.missing(least)}
    used = [line for place in whole for line in before[place].used]
    index = lines.without(used)
    left = [shape for shape in shapes if (shape.scale, shape.position) not in whole]
    own = find(left, lines.only(index), labels)
    placed = {place: (fit, sure) for (place, fit), sure in zip(before.items(), plans.sure, strict=True)}
    for fit, sure in zip(own.plans, own.sure, strict=True):
        place, full = (fit.shape.scale, fit.shape.position), replace(fit, lines=np.append(index, -1)[fit.lines])
        if place not in before or fit.missing(least) < before[place].missing(least):
            placed[place] = full, sure
    taken = {line for fit, _ in placed.values() for line in fit.used}
    doubtful = [several for several in plans.doubtful if not several[0].used & taken]
    fits, sures = zip(*placed.values(), strict=True) if placed else ((), ())
    return FoundPlans(fits, sures, tuple(doubtful), max(plans.deviation, own.deviation))


# --- values of the vectors ------------------------------------------------------------------------


class _Reading(Record):
    search: _Search
    key: Key
    file: str
    space: bytes

    def read(self) -> FileReading:
        plans = self.search.plans
        values: dict[Place, Answer] = {}
        measured: dict[Place, ReadOff] = {}
        unread: dict[Place, Fault] = {}
        beside: dict[Place, Location] = {}
        wrong = {(id(one.plan), one.vector): (one.start, one.end) for one in self.search.wrong}
        for fit, sure in zip(plans.plans, plans.sure, strict=True):
            lengths = np.abs(fit.shape.ends - fit.shape.starts)
            longest = fit.present[lengths[fit.present].argmax()]
            for number, vector in enumerate(fit.shape.vectors):
                line = wrong.get((id(fit), number), self.ends(fit, number) if sure[number] else None)
                if line is None:
                    unread |= self.doubts(fit, number)
                    continue
                # The longest vector determines the plan's scale, so its own length is not judged.
                own = self.place(vector.length, fit) if number != longest else None
                if (id(fit), number) in wrong and not (own or self.place(vector.direction, fit)):
                    beside[vector.length, fit.shape.position] = self.location(fit, number, line[0], wrong=True)
                for place, read in ((own, _length), (self.place(vector.direction, fit), _direction)):
                    if place is not None:
                        value, error, expected = read(fit, number, *line)
                        # A length is quoted as it is drawn.
                        quoted = value * fit.scale if place is own else value
                        text = f"{quoted:.4g} {self.key.row(place[0]).unit}"
                        location = self.location(fit, number, line[0], (id(fit), number) in wrong)
                        values[place] = Answer(value, text, location)
                        measured[place] = ReadOff(fit.scale, error, expected)
        for fit in (fit for several in plans.doubtful for fit in several):
            for number, vector in enumerate(fit.shape.vectors):
                for place in filter(None, (self.place(name, fit) for name in (vector.length, vector.direction))):
                    unread.setdefault(place, Fault("unread-two-plans", self.location(fit, number)))
        unread = {place: fault for place, fault in unread.items() if place not in values}
        drawn = frozenset((*values, *unread))
        return FileReading(self.key.id, self.file, values, unread, measured=measured, drawn=drawn, beside=beside)

    def place(self, id: str, fit: Fit) -> Place | None:
        """Return the place of a quantity at a plan's position, or None if the key has no cell for it there.

        A quantity that is the same at all positions is the drawn crank, to which the plans are scaled.
        """
        row = self.key.find(id) if id else None
        if row is None or row.single or fit.shape.position not in row.positions:
            return None
        return row.id, fit.shape.position

    def ends(self, fit: Fit, number: int) -> tuple[complex, complex]:
        """Return the start and the end of a vector's line (mm), in the vector's sense."""
        first, second = self.search.lines.ends[fit.lines[number]]
        return (complex(second), complex(first)) if fit.turned[number] else (complex(first), complex(second))

    def doubts(self, fit: Fit, number: int) -> dict[Place, Fault]:
        """Return the faults of a vector that is not read; none if it is too short or optional."""
        vector = fit.shape.vectors[number]
        length = fit.scale * abs(fit.shape.ends[number] - fit.shape.starts[number])
        here = fit.lines[number] >= 0
        if length < SEEN * self.search.lines.error or not (vector.drawn or here):
            return {}
        fault = Fault("unread-beside" if here else "unread-vector", self.location(fit, number))
        return {place: fault for name in (vector.length, vector.direction) if (place := self.place(name, fit))}

    def location(self, fit: Fit, number: int, start: complex | None = None, wrong: bool = False) -> DrawnLocation:
        """Return the location of a vector: its start and its right end.

        `start` (mm) is the start as drawn; None means the place where it should be.
        """
        unit, a = self.search.unit, complex(fit.at(fit.shape.starts[number])) if start is None else start
        along = fit.scale * complex(fit.shape.ends[number] - fit.shape.starts[number])
        return DrawnLocation(self.file, at=a / unit, right=(a + along) / unit, unit=unit, wrong=wrong, space=self.space)


def _length(fit: Fit, number: int, start: complex, end: complex) -> tuple[float, float, float]:
    """Return a vector's length (mm at the report's scale), its largest error and the plan's length, in that unit."""
    return abs(end - start) / fit.scale, 2 * float(fit.reach[number]) / fit.scale, abs(_vector(fit, number))


def _direction(fit: Fit, number: int, start: complex, end: complex) -> tuple[float, float, float]:
    """Return a vector's direction from the x axis, its largest error and the plan's direction, all in degrees."""
    off = min(2 * float(fit.reach[number]) / abs(end - start), math.pi)
    return _angle(end - start), math.degrees(off), _angle(_vector(fit, number))


def _vector(fit: Fit, number: int) -> complex:
    """Return a vector of the plan (mm) as the report draws it."""
    return complex(fit.shape.ends[number] - fit.shape.starts[number])


def _angle(vector: complex) -> float:
    """Return a vector's direction from the x axis, in [0°, 360°)."""
    return math.degrees(cmath.phase(vector)) % 360
