"""A drawing read: which plans it has, how long their vectors are over the scale that each is drawn to, and where to.

The plans are those of the key first, and in what these leave those of the student's own values.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from reportgen.base.errors import Fault, Mark
from reportgen.base.units import MM
from reportgen.handin import FileReading
from reportgen.handin.arrowheads import arrowheads
from reportgen.handin.dxf_lines import DrawnLines, DrawnText
from reportgen.handin.plan_finder import FoundPlans, find
from reportgen.handin.plan_fit import SEEN, Fit, Lines
from reportgen.handin.plan_labels import Labels
from reportgen.handin.plan_shapes import PlanShape, PlanSketch, Values
from reportgen.handin.wrong_vectors import WrongVector, wrong_vectors
from reportgen.marking.bands import PAPER_ERROR
from reportgen.marking.marks import Answer, Measured, Place
from reportgen.report.key import Key
from reportgen.workbook.package import RefusedError

OFF = PAPER_ERROR * MM
"""How far off a drawn end may lie in each direction (mm), as for whoever measures on paper."""
MOST_LINES = 20_000
"""Lines among which plans are sought."""
USUAL = (1.0, 10.0, 1000.0, 25.4)
"""Units that people draw in (mm), whatever the file says."""


@dataclass(frozen=True)
class DrawnMark(Mark):
    """A place of a drawing, in its own units."""

    at: complex = 0j

    def __str__(self) -> str:
        return f"{self.file}:({self.at.real:.6g}, {self.at.imag:.6g})"

    @property
    def place(self) -> tuple[str, int, int, int]:
        return (self.file, 0, round(-self.at.imag), round(self.at.real))


@dataclass(frozen=True)
class DrawnVector:
    """A vector of a plan in the drawing: where it lies, and where it should end (drawing units)."""

    start: complex
    end: complex
    right_end: complex


@dataclass(frozen=True)
class DrawingReading:
    """What was read of a drawing, and the vectors that its values were read from, by places."""

    reading: FileReading
    vectors: Mapping[Place, DrawnVector] = field(default_factory=dict)
    plans: int = 0


@dataclass(frozen=True)
class Wanted:
    """What is looked for in a drawing: the plans of a key, from its own values and from those of a student."""

    key: Key
    sketches: Sequence[PlanSketch]
    known: Values
    worlds: Sequence[Values] = ()
    words: frozenset[str] = frozenset()
    """The words for “position”, plain and in small letters."""

    def shapes(self, values: Values) -> list[PlanShape]:
        return [shape for sketch in self.sketches for shape in sketch.shapes(values)]

    def labels(self, texts: Sequence[DrawnText]) -> Labels:
        names = {label.casefold(): k for k, label in enumerate(self.key.labels, start=1)}
        return Labels(tuple(texts), self.words, names)


def read_drawing(drawn: DrawnLines, file: str, wanted: Wanted) -> DrawingReading:
    """What a drawing shows of the plans that are wanted, in the unit that it names or else in a usual one.

    Raises `RefusedError` where it has more lines than any drawing of plans.
    """
    if len(drawn.ends) > MOST_LINES:
        raise RefusedError("drawing-lines", Mark(file), most=str(MOST_LINES))
    units = list(dict.fromkeys((*((drawn.unit,) if drawn.unit else ()), *USUAL)))
    first: _Search | None = None
    for unit in units:
        search = _Search.of(drawn, unit, wanted)
        first = first or search
        if search.found.plans:
            return _Reading(search, file).read(drawn.notes)
    assert first is not None
    return _Reading(first, file).read(drawn.notes)


@dataclass(frozen=True)
class _Search:
    """The lines of a drawing in mm, and the plans that were found among them."""

    unit: float
    lines: Lines
    wanted: Wanted
    found: FoundPlans
    wrong: tuple[WrongVector, ...] = ()

    @classmethod
    def of(cls, drawn: DrawnLines, unit: float, wanted: Wanted) -> _Search:
        ends = drawn.ends * unit
        every = Lines(ends[np.abs(ends[:, 1] - ends[:, 0]) > OFF], OFF)
        marked = arrowheads(every)
        kept = ~marked.strokes & (np.abs(every.ends[:, 1] - every.ends[:, 0]) > 2 * every.reach)
        lines, heads = Lines(every.ends[kept], OFF), marked.heads[kept]
        labels = wanted.labels([DrawnText(text.text, text.at * unit, text.height * unit) for text in drawn.texts])
        found = find(wanted.shapes(wanted.known), lines, labels)
        for world in wanted.worlds:
            found = _with_own(found, wanted.shapes(world), lines, labels)
        return cls(unit, lines, wanted, found, wrong_vectors(found, lines, heads, labels))


def _with_own(found: FoundPlans, shapes: Sequence[PlanShape], lines: Lines, labels: Labels) -> FoundPlans:
    """The same with plans of own values in place of those that were not found, or of which vectors are missing.

    They are sought among the lines that no complete plan has.
    """
    least = SEEN * lines.error
    before = {(fit.shape.scale, fit.shape.position): fit for fit in found.plans}
    whole = {place for place, fit in before.items() if not fit.missing(least)}
    used = [line for place in whole for line in before[place].used]
    index = np.setdiff1d(np.arange(len(lines.ends)), np.array(used, dtype=int))
    left = [shape for shape in shapes if (shape.scale, shape.position) not in whole]
    own = find(left, Lines(lines.ends[index], lines.error), labels)
    plans = {place: (fit, sure) for (place, fit), sure in zip(before.items(), found.sure, strict=True)}
    for fit, sure in zip(own.plans, own.sure, strict=True):
        place, full = (fit.shape.scale, fit.shape.position), replace(fit, lines=np.append(index, -1)[fit.lines])
        if place not in before or fit.missing(least) < before[place].missing(least):
            plans[place] = full, sure
    taken = {line for fit, _ in plans.values() for line in fit.used}
    doubtful = [several for several in found.doubtful if not several[0].used & taken]
    fits, sures = zip(*plans.values(), strict=True) if plans else ((), ())
    return FoundPlans(fits, sures, tuple(doubtful), max(found.deviation, own.deviation))


# --- what the vectors say -------------------------------------------------------------------------


@dataclass(frozen=True)
class _Reading:
    search: _Search
    file: str

    def read(self, notes: Sequence[Fault]) -> DrawingReading:
        key, found = self.search.wanted.key, self.search.found
        values: dict[Place, Answer] = {}
        measured: dict[Place, Measured] = {}
        unread: dict[Place, Fault] = {}
        vectors: dict[Place, DrawnVector] = {}
        wrong = {(id(one.plan), one.vector): one for one in self.search.wrong}
        for fit, sure in zip(found.plans, found.sure, strict=True):
            longest = int(max(fit.found, key=lambda n: abs(fit.shape.ends[n] - fit.shape.starts[n])))
            for number, vector in enumerate(fit.shape.vectors):
                places = [(name, place) for name in (vector.length, vector.direction) if (place := self.place(name, fit))]
                own = wrong.get((id(fit), number))
                if own is not None:
                    start, end = own.start, own.end
                elif sure[number]:
                    start, end = self.ends(fit, number)
                else:
                    unread |= {place: fault for _, place in places if (fault := self.doubt(fit, number))}
                    continue
                for name, place in places:
                    # The longest vector says what scale the plan has, and so says nothing of its own length.
                    if name == vector.length and number == longest:
                        continue
                    value, error = self.value(fit, number, name == vector.length, start, end)
                    values[place] = Answer(value, f"{value:.4g} {key.row(place[0]).unit}", self.mark(start))
                    measured[place] = Measured(fit.scale, error)
                    vectors[place] = self.drawn(fit, number, start, end)
        for several in found.doubtful:
            for fit in several:
                for vector in fit.shape.vectors:
                    for name in (vector.length, vector.direction):
                        if (place := self.place(name, fit)) and place not in values:
                            unread.setdefault(place, Fault("unread-two-plans", self.mark(fit.shift)))
        mark = Mark(self.file)
        told = [*notes, *([] if found.plans or found.doubtful else [Fault("drawing-no-plans", mark)])]
        reading = FileReading(
            key.id, self.file, values, unread, tuple(told), measured, frozenset((*values, *unread))
        )
        return DrawingReading(reading, vectors, len(found.plans))

    def place(self, id: str, fit: Fit) -> Place | None:
        """The place of a quantity at a plan's position, if the key has a cell for it there."""
        row = self.search.wanted.key.find(id) if id else None
        if row is None:
            return None
        position = 0 if row.single else fit.shape.position
        return (row.id, position) if position in row.positions else None

    def ends(self, fit: Fit, number: int) -> tuple[complex, complex]:
        """Where the line of a vector begins and ends (mm), in the vector's sense."""
        first, second = self.search.lines.ends[fit.lines[number]]
        return (complex(second), complex(first)) if fit.turned[number] else (complex(first), complex(second))

    def value(self, fit: Fit, number: int, length: bool, start: complex, end: complex) -> tuple[float, float]:
        """A vector's length (mm) as the report draws it, or its direction (°), and what either may be off by."""
        way, off = end - start, 2 * float(fit.reach[number])
        if length:
            return abs(way) / fit.scale, off / fit.scale
        return math.degrees(cmath.phase(way)), math.degrees(min(off / abs(way), math.pi))

    def doubt(self, fit: Fit, number: int) -> Fault | None:
        """Why a vector of a plan that was found is not read; None where nothing stands there, or nothing is seen."""
        a, b = fit.at(fit.shape.starts[number]), fit.at(fit.shape.ends[number])
        if abs(b - a) < SEEN * self.search.lines.error:
            return None
        if fit.lines[number] >= 0:
            return Fault("unread-beside", self.mark(complex(a)))
        return Fault("unread-vector", self.mark(complex(a)))

    def drawn(self, fit: Fit, number: int, start: complex, end: complex) -> DrawnVector:
        right = start + fit.scale * complex(fit.shape.ends[number] - fit.shape.starts[number])
        unit = self.search.unit
        return DrawnVector(start / unit, end / unit, right / unit)

    def mark(self, at: complex) -> DrawnMark:
        return DrawnMark(self.file, at=at / self.search.unit)
