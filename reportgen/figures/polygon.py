"""Force polygons: arrows head to tail from vertex e, in mm, the unknown ones closing the figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.figures.labels import Content
from reportgen.figures.plan import Plan, PlanLine, PlanPoint, PlanVector
from reportgen.figures.scale import NOTHING
from reportgen.notation.expressions import Symbol

LETTERS = "efghijklmnopqrstuvwxyz"


@dataclass(frozen=True, slots=True)
class Side:
    """One force of a polygon in mm; `found` for one that closing the polygon gives."""

    label: Content
    vector: complex
    found: bool = False
    name: str = ""


@dataclass(frozen=True, slots=True)
class Chord:
    """A force read between two vertices (letters) of the finished polygon, e.g. an inner reaction."""

    label: Content
    start: str
    end: str
    name: str = ""


def vertices(sides: Sequence[Side]) -> tuple[complex, ...]:
    """The polygon's vertices in mm, from 0: one more than there are sides."""
    points = [0j]
    for side in sides:
        points.append(points[-1] + side.vector)
    return tuple(points)


def letters(sides: Sequence[Side]) -> tuple[str, ...]:
    """A letter for each vertex, from e; the last vertex of a closed polygon is e again.

    A force that is nothing has one vertex at both ends.
    """
    size = max((abs(side.vector) for side in sides), default=0.0)
    names = [LETTERS[0]]
    for side, at in zip(sides, vertices(sides)[1:], strict=True):
        if abs(side.vector) <= NOTHING * size:
            names.append(names[-1])
        elif side is sides[-1] and abs(at) <= 1e-6 * size:
            names.append(LETTERS[0])
        else:
            names.append(LETTERS[LETTERS.index(max(names)) + 1])
    return tuple(names)


def force_polygon(
    sides: Sequence[Side], *, chords: Sequence[Chord] = (), scale: Content | None = None
) -> Plan:
    """The polygon as a plan: known forces are its first stages, then come the directions of the unknown
    ones, the forces they cut off, and the chords.

    Draw it with `plan.plan` and `plan.stages`.  Raises `KeyError` for a chord between unknown vertices.
    """
    points, names = vertices(sides), letters(sides)
    known = sum(not side.found for side in sides)
    vectors, marks = [], [PlanPoint(Symbol(names[0]), points[0])]
    for n, side in enumerate(sides):
        # Whatever closes the polygon appears at once: one of its ends is found together with the other.
        stage = known + 1 if side.found else n
        vectors.append(
            PlanVector(
                side.name or names[n] + names[n + 1],
                points[n],
                points[n + 1],
                "found" if side.found else "known",
                side.label,
                stage,
            )
        )
        marks.append(PlanPoint(Symbol(names[n + 1]), points[n + 1], stage))
    found = [n for n, side in enumerate(sides) if side.found]
    ways = [(points[n], points[n + 1]) if n == found[0] else (points[n + 1], points[n]) for n in found]
    size = max((abs(side.vector) for side in sides), default=0.0)
    lines = tuple(PlanLine(a, b, known) for a, b in ways if abs(b - a) > NOTHING * size)
    where = dict(zip(names, points, strict=True))
    where[names[0]] = points[0]
    for chord in chords:
        name = chord.name or chord.start + chord.end
        vectors.append(
            PlanVector(name, where[chord.start], where[chord.end], "relative", chord.label, known + 2)
        )
    return Plan(tuple(vectors), tuple(marks), lines, scale, pole=False)
