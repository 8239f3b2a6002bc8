"""The steps of an exercise's solution as templates name them: words' keys, points, equations, senses.

How a quantity is shown, by numbers or by the symbols of the file, is decided here for the whole page.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Any

from reportgen.case import ExerciseCase
from reportgen.catalogue.plane_motion_symbols import symbol
from reportgen.document.exercise_axes import COORDINATES, Axes
from reportgen.document.prose import PointName
from reportgen.document.tree import Equation, InlineMath, Inlines, Text, Value
from reportgen.ledger.instant.board import Step, Vector
from reportgen.ledger.instant.write import Worked
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Chain, Expression, Number, Symbol, Term, VectorEquation, refs, substitute

AT = 1
"""The one position of an exercise."""
MM = 1e3


@dataclass(frozen=True)
class StepView:
    """A step as templates name it."""

    kind: str
    of_accelerations: bool
    body: int
    point: PointName
    base: PointName
    centre: PointName
    one: PointName
    other: PointName
    """The points whose normals meet in the centre."""
    lines: tuple[Equation, ...]
    equation: tuple[Equation, ...]
    angles: tuple[Inlines, ...]
    sense: str
    way: str
    place: Inlines
    """The coordinates of the instant centre."""
    frame: int
    """The body that the motion is seen from."""
    system: tuple[Equation, ...]
    results: tuple[Equation, ...]
    along: Symbol
    across: Symbol
    """The axes of projection ξ and η."""
    on_line: bool
    """Whether the step projects on ξ."""
    on_coordinates: bool
    """Whether it projects on x or y."""
    contact: PointName | str
    """The point that the body rolls on the ground with, if it is one of the two that the step is about."""


@dataclass(frozen=True)
class WayView:
    """A further solution as templates name it."""

    name: str
    steps: tuple[StepView, ...]


@dataclass(frozen=True)
class Solution:
    """A solution of an exercise, as it is set out step by step."""

    case: ExerciseCase
    worked: Worked

    @property
    def steps(self) -> tuple[StepView, ...]:
        return tuple(map(self._step, self.worked.steps))

    def steps_beside(self, first: Worked) -> tuple[StepView, ...]:
        """The steps without those that another solution has already."""
        return tuple(self._step(step) for step in self.worked.steps if step not in first.steps)

    @property
    def axes(self) -> Axes:
        """The axes of projection of all solutions of the case."""
        return Axes((self.case.worked, *self.case.further))

    @property
    def method(self) -> str:
        """What its method is called; "" where it is chosen for each step."""
        return str(self.case.words["instant"]["methods"][self.worked.method]) if self.worked.method else ""

    def _step(self, step: Step) -> StepView:
        worked, motion = self.worked, self.case.exercise.motion
        ledger, layout = worked.ledger, worked.layout
        shown = [id for id in step.ids if id in ledger and not (id.startswith("l.") and self._declared(id))]
        centre = layout.centres.get(step.body)
        rate = motion.omega(step.body) if step.body else 0.0
        if any(id.startswith("eps.") for id in shown):
            rate = motion.epsilon(step.body)
        rolling = centre is not None and centre.rule == "contact" and centre.name in (step.point, step.base)
        others = (*(centre.points if centre is not None else ()), "", "")
        angles = dict.fromkeys(id for one in shown for id in self._angles_of(one))
        return StepView(
            step.kind,
            step.of_accelerations,
            step.body,
            PointName(step.point),
            PointName(step.base),
            PointName(centre.name if centre is not None else ""),
            PointName(others[0]),
            PointName(others[1]),
            (Equation(tuple(map(self._chain, shown))),) if shown else (),
            (self._equation(step),) if step.equation is not None and step.equation.left else (),
            tuple((InlineMath(Chain((ledger.symbol(id), ledger.number(id)))),) for id in angles),
            self._sense(rate) if rate else str(self.case.words["instant"]["no_sense"]),
            self._heading(step),
            self._coordinates(step.body) if centre is not None and centre.rule in ("normals", "rate") else (),
            step.frame,
            (Equation(step.system),) if step.system else (),
            (Equation(step.results),) if step.results else (),
            self.axes.symbol(step, "ξ"),
            self.axes.symbol(step, "η"),
            any(axis.letter == "ξ" for axis in step.axes),
            any(axis.letter in COORDINATES for axis in step.axes),
            PointName(centre.name) if rolling and centre is not None else "",
        )

    def _angles_of(self, id: str) -> list[str]:
        definition = self.worked.ledger[id].definition
        return [one for one in refs(definition) if one.startswith("alpha.")] if definition is not None else []

    def _heading(self, step: Step) -> str:
        """Where the velocity or the acceleration of the step's point goes, in words; "" for several points."""
        motion, layout = self.case.exercise.motion, self.worked.layout
        if step.kind.startswith("acceleration") and step.point in motion.system.points:
            return self._way(motion.a(step.point))
        if step.point not in layout.points:
            return ""
        # A point of contact moves with the step's body.
        known = step.point in motion.system.points
        v = motion.v(step.point) if known else motion.velocities.at(step.body, layout.points[step.point])
        return self._way(v)

    def _equation(self, step: Step) -> Equation:
        assert step.equation is not None
        sides = tuple(
            tuple(self._term(one, one.id in step.equation.unknown) for one in side)
            for side in (step.equation.left, step.equation.right)
        )
        return Equation((VectorEquation(sides, tuple(self.case.words["vector"]["rows"])),))

    def _term(self, vector: Vector, unknown: bool) -> Term:
        """A vector with what is known of it: its line, its sense by the angle from +x, its size."""
        ledger = self.worked.ledger
        degrees = round(math.degrees(cmath.phase(vector.way)) % 360.0, 2) % 360.0
        line = Number(round(degrees % 180.0, 2), None, "°")
        symbol = ledger.symbol(vector.id) if vector.id in ledger else vocabulary.symbol(vector.id)
        size: Expression | None = None if unknown or vector.id not in ledger else ledger.number(vector.id, AT)
        if size is not None:
            size = self._literal(vector.id) or size
        sense = None if unknown else Number(degrees, None, "°")
        return Term(vocabulary.vector(symbol), (line, sense, size))

    @property
    def put_in(self) -> bool:
        """Whether numbers are put in, at the end of each line: also where the file wants none but an answer has one."""
        wanted = all(one.put_in for one in self.case.exercise.given.symbols.values())
        return wanted or any(shown is None for _, shown in self._by_symbols())

    def _by_symbols(self) -> list[tuple[str, Expression | None]]:
        """What is asked by the symbols of the file; None for what is too long."""
        if self.case.literal is None:
            return []
        return [(one.id, self._literal(one.id)) for one in self.case.exercise.asked if one.what != "centre"]

    def _literal(self, id: str) -> Expression | None:
        """A quantity by the symbols of the file; None where it is not known so."""
        found = self.case.literal[id] if self.case.literal is not None else None
        return None if found is None else lettered(found)

    def _chain(self, id: str) -> Chain:
        """The worked line: with numbers, or with symbols, behind which numbers stand if they are put in."""
        chain = self.worked.ledger.chain(id, AT)
        if self.case.literal is None:
            return chain
        found = self._literal(id)
        *formula, _ = chain.parts[:3] if len(chain.parts) > 2 else (chain.parts[0], None)
        if self.worked.ledger[id].definition is None:
            formula = [chain.parts[0]]
        result = chain.parts[-1:] if self.put_in or (found is None and len(formula) == 1) else ()
        if isinstance(found, Number) and found.value == 0 and result:
            found = None
        steps = [*formula, *([] if found is None else [found]), *result]
        return Chain(tuple(one for place, one in enumerate(steps) if place == 0 or one != steps[place - 1]))

    def _declared(self, id: str) -> bool:
        """Whether a distance is one of declared points."""
        centres = {one.name for one in self.worked.layout.centres.values() if one.rule in ("normals", "rate")}
        return not any(id.startswith(f"l.{name}") for name in centres - set(self.case.exercise.given.points))

    def _angle(self, radians: float) -> Inlines:
        return (Value(Number(round(math.degrees(radians) % 360.0, 2), None, "°")),)

    def _way(self, vector: complex) -> str:
        if vector == 0:
            return "–"
        degrees = round(math.degrees(cmath.phase(vector)) % 360.0, 2) % 360.0
        quadrant, within = divmod(degrees, 90.0)
        return str(self.case.words["headings"][int(2 * quadrant) + (within > 0)])

    def _sense(self, value: float) -> str:
        words = self.case.words["sense"]
        return str(words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"])

    def _coordinate(self, value: float) -> Number:
        """A coordinate in mm, without the dust of floats."""
        return Number(round(value * MM, 6 - math.ceil(math.log10(self.case.exercise.motion.size * MM))) + 0.0)

    def _coordinates(self, body: int) -> Inlines:
        """Where the instant centre of a body is: x and y, in numbers as in the table of points."""
        centre = self.worked.layout.centres[body]
        numbers = [Number(self._coordinate(part).value, None, "mm") for part in (centre.at.real, centre.at.imag)]
        literal = self.case.literal
        found = None if literal is None else literal.place(centre.name)
        formulas = None if found is None else [*map(lettered, found)]
        shown: list[Any] = []
        for index, axis in enumerate("xy"):
            parts: list[Expression] = [] if formulas is None else [formulas[index]]
            # Nothing is 0, whatever its unit.
            if not parts or (self.put_in and numbers[index].value):
                parts.append(numbers[index])
            chain = Chain((Symbol(axis, centre.name), *parts))
            shown += [*([Text("; ")] if shown else []), InlineMath(chain, slashed=True)]
        return tuple(shown)


def lettered(formula: Expression) -> Expression:
    """A formula over the names of symbols with the letters that are printed for them."""
    return substitute(formula, lambda ref: symbol(ref.id))
