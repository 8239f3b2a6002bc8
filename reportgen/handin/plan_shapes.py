"""Velocity, acceleration and force plans as shapes to search for in a drawing: corners and vectors.

The corners are those of the report's figures, from the key's values or from a student's own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import MM
from reportgen.case import Case, MachineAnalysis
from reportgen.derivation.kinematic_entries import What
from reportgen.formula import Symbol, ids
from reportgen.marking.marking_scheme import Values
from reportgen.report.context import ReportContext
from reportgen.report.plan_figures import POLE, force_construction, motion_construction

NOTHING = 0.01
"""Length (mm) below which a vector is a point on any paper."""
PAIR = 2
_PARTS = {"n": "n", "τ": "t", "k": "k", "r": "r"}


class ShapeVector(Record):
    """A vector of a plan between two of its corners, with the ids of its length and, if it has one, its direction.

    A vector that is not `drawn` in the report, such as the whole relative acceleration, is optional.
    """

    length: str
    direction: str
    start: int
    end: int
    names: tuple[str, ...] = ()
    drawn: bool = True


@dataclass(frozen=True, eq=False)
class PlanShape:
    """A plan at a position: corners [n] (complex, mm at the report's scale) and E vectors, none of which is a point.

    `scale` is the id of μ, `unit` the value of a millimetre (SI); `letters` are the labels of each corner.
    """

    scale: str
    position: int
    unit: float
    corners: np.ndarray
    vectors: tuple[ShapeVector, ...]
    letters: tuple[tuple[str, ...], ...] = ()

    @property
    def is_of_motion(self) -> bool:
        """True for a velocity or acceleration plan, which has one scale at all positions."""
        names = ids.scale.read(self.scale)
        return names is not None and names["plan"] in ("v", "a")

    @property
    def starts(self) -> np.ndarray:
        """The starts of its vectors [E] (mm)."""
        return self.corners[[vector.start for vector in self.vectors]]

    @property
    def ends(self) -> np.ndarray:
        """The ends of its vectors [E] (mm)."""
        return self.corners[[vector.end for vector in self.vectors]]


class SketchedVector(Record):
    """A vector of a plan between two corners, by their ids; otherwise like a `ShapeVector`."""

    length: str
    direction: str
    start: str
    end: str
    names: tuple[str, ...] = ()
    drawn: bool = True


class PlanSketch(Record):
    """A plan independent of its values, at the first `count` positions."""

    scale: str
    count: int
    vectors: tuple[SketchedVector, ...]
    letters: Mapping[str, tuple[str, ...]]

    def shapes(self, values: Values) -> Iterator[PlanShape]:
        """Yield the plan at each position, from SI values by id, [1] or at least [count] over the positions.

        Corners are in mm, vectors up to `NOTHING` (mm) are left out. A position is skipped if a corner is not finite,
        the scale is not positive or no vector is left. Raises `KeyError` if a corner or the scale has no value.
        """
        ends = dict.fromkeys(corner for vector in self.vectors for corner in (vector.start, vector.end))
        index = {id: number for number, id in enumerate(ends)}
        places = MM * np.array([self._over(np.zeros(1) if id == POLE else values[id]) for id in ends])
        units = self._over(values[self.scale]).real / MM
        letters = tuple(self.letters.get(id, ()) for id in ends)
        for k, at in enumerate(places.T):
            vectors = tuple(
                ShapeVector(
                    vector.length, vector.direction, index[vector.start], index[vector.end], vector.names, vector.drawn
                )
                for vector in self.vectors
                if abs(at[index[vector.end]] - at[index[vector.start]]) > NOTHING
            )
            if np.isfinite(at).all() and units[k] > 0 and vectors:
                yield PlanShape(self.scale, k + 1, float(units[k]), at, vectors, letters)

    def _over(self, values: np.ndarray) -> np.ndarray:
        """Return values, [1] or longer, at the positions [count]."""
        return np.broadcast_to(values, (self.count,)) if values.size == 1 else values[: self.count]


def sketches(case: Case) -> tuple[PlanSketch, ...]:
    """Return the plans of a machine: velocities, accelerations, and the forces of each dyad and of the driver."""
    if not isinstance(case, MachineAnalysis):
        return ()
    report = ReportContext(case)
    plans = [_of_motion(report, what, case.span.count) for what in ("v", "a")]
    return (*plans, *(_of_forces(report, number, len(case.span.labels)) for number in range(len(case.polygons))))


def _of_motion(report: ReportContext, what: What, count: int) -> PlanSketch:
    """Return the velocity or acceleration plan of one turn, including lengths that are not among its vectors."""
    ledger, construction = report.ledger, motion_construction(report, what)
    corners = {corner: corner.rpartition(".")[2] for corner in construction.corners if corner != POLE}
    named = {ids.POLE: POLE} | {letter: corner for corner, letter in corners.items()}
    lengths: dict[frozenset[str], str] = {}
    for id in ledger.families:
        names = ids.segment.read(id)
        if names and names["what"] == what and {names["start"], names["end"]} <= named.keys():
            lengths[frozenset((named[names["start"]], named[names["end"]]))] = id
    vectors = []
    for vector in construction.vectors:
        ends = frozenset((vector.start, vector.end))
        part, relative = _PARTS.get(vector.name[:1], ""), vector.name[1:]
        own = ids.relative_segment(part, relative) if part else ""
        length = own if own in ledger else lengths.pop(ends, "")
        direction = ids.direction(what, vector.name) if vector.start == POLE else ""
        known = direction if direction in ledger else ""
        vectors.append(SketchedVector(length, known, vector.start, vector.end, _plain(vector.label)))
    further = [(id, *sorted(ends)) for ends, id in lengths.items() if len(ends) == PAIR]
    vectors += [SketchedVector(id, "", start, end, drawn=False) for id, start, end in further]
    letters = _letters((point.at, point.label) for point in construction.points)
    return PlanSketch(ids.scale(what), count, tuple(vectors), letters)


def _of_forces(report: ReportContext, number: int, count: int) -> PlanSketch:
    """Return the force plan of a dyad or of the driver, by its number, over the cycle."""
    polygon = report.case.polygons[number]
    ledger, construction = report.ledger, force_construction(report, polygon)
    vectors = []
    for vector, edge in zip(construction.vectors, (*polygon.edges, *polygon.reads), strict=True):
        length, direction = ids.force_segment(polygon.name, edge.name), ids.force_direction(edge.name)
        known = [id if id in ledger else "" for id in (length, direction)]
        vectors.append(SketchedVector(known[0], known[1], vector.start, vector.end, _plain(vector.label)))
    letters = _letters((point.at, point.label) for point in construction.points)
    return PlanSketch(ids.force_scale(polygon.name), count, tuple(vectors), letters)


def _letters(points: Iterable[tuple[str, object]]) -> dict[str, tuple[str, ...]]:
    """Return the letters at each corner."""
    letters: dict[str, tuple[str, ...]] = {}
    for corner, label in points:
        letters[corner] = (*letters.get(corner, ()), *_plain(label))
    return letters


def _plain(label: object) -> tuple[str, ...]:
    """Return a symbol as a drawing has it, without marks of indices, exponents or vectors."""
    if not isinstance(label, Symbol):
        return ()
    return tuple(dict.fromkeys((f"{label.base}{label.sup}{label.sub}", f"{label.base}{label.sub}{label.sup}")))
