"""The steps of an exercise's solution as templates read them: keys of phrases, points, equations, senses.

This module also decides for the whole page whether a quantity is printed by numbers or by symbols, and which letter
each axis of projection has.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import Any

from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.base.units import MM
from reportgen.document import Equation, Inline, InlineMath, Inlines, Text, Value, listed
from reportgen.document.template_rendering import NamedPoint
from reportgen.exercise.derivation import Axis, Step, Vector
from reportgen.exercise.file import Asked
from reportgen.exercise.instant_centres import SAME_PLACE
from reportgen.exercise.ledger import Worked
from reportgen.exercise.literal_solution import SolvedExercise
from reportgen.exercise.literal_symbols import symbol
from reportgen.exercise.point_positions import parallel
from reportgen.formula import Chain, Expression, Number, Symbol, Term, VectorEquation, ids, refs, substitute, vocabulary

AT = 1
"""The number of the only position of an exercise."""
COORDINATES = ("x", "y")


@view()
class StepView(Record):
    """A step as templates read it.

    `sense` is the sense of the body's angular velocity or acceleration in words; `way` is the direction of the point's
    velocity or acceleration in words. `lines` and `equation` have one element, or none if there is nothing to print.
    """

    kind: str
    of_accelerations: bool
    body: int
    point: NamedPoint
    base: NamedPoint
    centre: NamedPoint
    one: NamedPoint
    other: NamedPoint
    """The points whose normals meet in the centre; a second base point replaces the other one."""
    lines: tuple[Equation, ...]
    equation: tuple[Equation, ...]
    angles: tuple[Inlines, ...]
    sense: str
    way: str
    place: Inlines
    """The coordinates of the instant centre."""
    frame: int
    """The body that is the frame of reference."""
    system: tuple[Equation, ...]
    results: tuple[Equation, ...]
    along: Symbol
    across: Symbol
    """The axes of projection ξ and η."""
    on_line: bool
    """True if the step projects on ξ."""
    on_coordinates: bool
    """True if it projects on x or y."""
    contact: NamedPoint | str
    """The point in which the body rolls on the ground, if the step is about it."""
    turns: Inlines
    """The computed rotations, each with its sense."""
    has_angles: bool
    """True if angles of bodies are printed for the first time."""
    has_ways: bool
    """True if travels along straight lines are printed for the first time."""
    has_right_sides: bool
    """True if the right sides of equations are computed first."""
    has_distance: bool
    """True if the distance of the outer ends of two bodies is printed."""


@view()
class Unfound(Record):
    """Requested quantities that a method alone does not find; the reason is the key of a phrase."""

    reason: str
    symbols: Inlines


@view()
class FurtherView(Record):
    """A further solution as templates read it."""

    name: str
    steps: tuple[StepView, ...]
    unfound: tuple[Unfound, ...]


class Solution(Record):
    """A solution of an exercise, step by step: `worked` is one of the solutions of the `case`."""

    case: SolvedExercise
    worked: Worked

    @property
    def steps(self) -> tuple[StepView, ...]:
        return tuple(map(self._step, self.worked.steps))

    def steps_beside(self, first: Worked) -> tuple[StepView, ...]:
        """Return the steps without those that another solution contains already."""
        return tuple(self._step(step) for step in self.worked.steps if step not in first.steps)

    @property
    def axes(self) -> Axes:
        """Return the axes of projection of all solutions of the case."""
        return Axes((self.case.worked, *self.case.further))

    @property
    def method(self) -> str:
        """Return the name of the method; "" if it is chosen for each step."""
        return str(self.case.words["instant"]["methods"][self.worked.method]) if self.worked.method else ""

    def unfound(self, alone: Worked) -> tuple[Unfound, ...]:
        """Return the requested velocities that the method `alone` does not find, by reason."""
        missing: dict[str, list[Symbol]] = {}
        for asked in self.case.exercise.asked:
            if asked.what in ("v", "omega") and asked.id not in alone.ledger:
                missing.setdefault(self._why_unfound(asked, alone), []).append(vocabulary.symbol(asked.id))
        return tuple(Unfound(reason, listed(map(InlineMath, symbols))) for reason, symbols in missing.items())

    def _why_unfound(self, asked: Asked, alone: Worked) -> str:
        """Return the reason: projections give no rotation, and no velocity of a point in line with all guided
        points.
        """
        if alone.method != "projection":
            return "way"
        return "turn" if asked.of_body else "in-line" if alone.layout.in_line(asked.of) else "way"

    def _step(self, step: Step) -> StepView:
        worked, motion = self.worked, self.case.exercise.motion
        ledger, layout = worked.printed, worked.layout
        printed = [id for id in (*step.read, *step.ids) if id in ledger and not self._is_declared_length(id)]
        # The results of a system are printed after it, so it needs no lines.
        lines = [id for id in printed if not (step.results and ledger[id].constructed)]
        centre = layout.centres.get(step.body)
        rate = motion.omega(step.body) if step.body else 0.0
        if any(id in ids.angular_acceleration for id in printed):
            rate = motion.epsilon(step.body)
        rolling = centre is not None and centre.rule == "contact" and centre.name in (step.point, step.base)
        others = (*(centre.points if centre is not None else ()), "", "")
        angles = dict.fromkeys(id for one in printed for id in self._angles_of(one))
        return StepView(
            kind=step.kind,
            of_accelerations=step.of_accelerations,
            body=step.body,
            point=NamedPoint(step.point),
            base=NamedPoint(step.base),
            centre=NamedPoint(centre.name if centre is not None else ""),
            one=NamedPoint(others[0]),
            other=NamedPoint(step.second_base or others[1]),
            lines=(Equation(tuple(map(self._chain, lines))),) if lines else (),
            equation=(self._equation(step),) if step.equation is not None and step.equation.left else (),
            angles=tuple((InlineMath(Chain((ledger.symbol(id), ledger.number(id)))),) for id in angles),
            sense=self._sense(rate) if rate else str(self.case.words["instant"]["no_sense"]),
            way=self._heading(step),
            place=self._coordinates(step.body) if centre is not None and centre.rule in ("normals", "rate") else (),
            frame=step.frame,
            system=(Equation(step.system),) if step.system else (),
            results=(Equation(step.results),) if step.results else (),
            along=self.axes.symbol(step, "ξ"),
            across=self.axes.symbol(step, "η"),
            on_line=any(axis.letter == "ξ" for axis in step.axes),
            on_coordinates=any(axis.letter in COORDINATES for axis in step.axes),
            contact=NamedPoint(centre.name) if rolling and centre is not None else "",
            turns=self._turns(printed),
            has_angles=self._is_first(step, ids.formula_angle),
            has_ways=self._is_first(step, ids.slide_way),
            has_right_sides=any(id in ids.right_side for id in printed),
            has_distance=any(id in ids.loop_distance and ledger.symbol(id).base == "d" for id in printed),
        )

    def _is_first(self, step: Step, family: ids.Name) -> bool:
        """Return True if a step is the first that prints a quantity of a family."""
        telling = (one for one in self.worked.steps if any(id in family for id in (*one.read, *one.ids)))
        return next(telling, None) is step

    def _turns(self, printed: Sequence[str]) -> Inlines:
        """Return the rotations of bodies among some ids, each with its sense: ω₂ anticlockwise, ω₃ clockwise."""
        motion, turns = self.case.exercise.motion, list[Inline]()
        for rate, family in ids.LINK_RATE.items():
            for id in printed:
                names = family.read(id)
                if names is not None and (body := int(names["link"])) in motion.system.bodies:
                    sense = Text(f" {self._sense(motion.turn(rate, body))}")
                    turns += [*([Text(", ")] if turns else []), InlineMath(self.worked.printed.symbol(id)), sense]
        return tuple(turns)

    def _angles_of(self, id: str) -> list[str]:
        definition = self.worked.printed[id].definition
        return [one for one in refs(definition) if one in ids.inner_angle] if definition is not None else []

    def _heading(self, step: Step) -> str:
        """Return the direction of the step's vector in words; "" for several points or a zero vector."""
        motion, layout = self.case.exercise.motion, self.worked.layout
        if step.kind.startswith("acceleration") and step.point in motion.system.points:
            return self._towards(motion.a(step.point))
        if step.point not in layout.points:
            return ""
        # A point of contact moves with the step's body.
        known = step.point in motion.system.points
        v = motion.v(step.point) if known else motion.velocities.at(step.body, layout.points[step.point])
        return self._towards(v)

    def _equation(self, step: Step) -> Equation:
        assert step.equation is not None
        sides = tuple(
            tuple(self._term(one, one.id in step.equation.unknown) for one in side)
            for side in (step.equation.left, step.equation.right)
        )
        return Equation((VectorEquation(sides, tuple(self.case.words["vector"]["rows"])),))

    def _term(self, vector: Vector, unknown: bool) -> Term:
        """Return a vector with what is known of it: its line, its sense by the angle from +x, its magnitude."""
        ledger = self.worked.printed
        degrees = round(math.degrees(cmath.phase(vector.direction)) % 360.0, 2) % 360.0
        line = Number(round(degrees % 180.0, 2), None, "°")
        symbol = ledger.symbol(vector.id) if vector.id in ledger else vocabulary.symbol(vector.id)
        size: Expression | None = None if unknown or vector.id not in ledger else ledger.number(vector.id, AT)
        if size is not None:
            size = self._literal(vector.id) or size
        sense = None if unknown else Number(degrees, None, "°")
        return Term(vocabulary.vector(symbol), (line, sense, size))

    @property
    def put_in(self) -> bool:
        """Return True if lines end with numbers: by the choice of the file, or because an answer has no expression."""
        wanted = all(symbol.put_in for symbol in self.case.exercise.given.symbols.values())
        return wanted or any(shown is None for _, shown in self._by_symbols())

    def _by_symbols(self) -> list[tuple[str, Expression | None]]:
        """Return the requested quantities by the symbols of the file; None for one that is too long."""
        if self.case.literal is None:
            return []
        return [(one.id, self._literal(one.id)) for one in self.case.exercise.asked if one.what != "centre"]

    def _literal(self, id: str) -> Expression | None:
        """Return a quantity by the symbols of the file; None if it has no such expression."""
        known = self.case.literal[id] if self.case.literal is not None else None
        return None if known is None else lettered(known)

    def _chain(self, id: str) -> Chain:
        """Return the worked line with numbers, or with symbols that numbers follow if they are put in."""
        chain = self.worked.printed.chain(id, AT)
        if self.case.literal is None:
            return chain
        literal = self._literal(id)
        *formula, _ = chain.parts[:3] if len(chain.parts) > 2 else (chain.parts[0], None)
        if self.worked.printed[id].definition is None:
            formula = [chain.parts[0]]
        result = chain.parts[-1:] if self.put_in or (literal is None and len(formula) == 1) else ()
        if isinstance(literal, Number) and literal.value == 0 and result:
            literal = None
        steps = [*formula, *([] if literal is None else [literal]), *result]
        return Chain(tuple(one for place, one in enumerate(steps) if place == 0 or one != steps[place - 1]))

    def _is_declared_length(self, id: str) -> bool:
        """Return True if it is the distance of declared points, rather than of an instant centre."""
        names = ids.length.read(id)
        centres = {centre.name for centre in self.worked.layout.centres.values() if centre.rule in ("normals", "rate")}
        centres -= set(self.case.exercise.given.points)
        return names is not None and centres.isdisjoint(ids.points(names["line"]))

    def _angle(self, radians: float) -> Inlines:
        return (Value(Number(round(math.degrees(radians) % 360.0, 2), None, "°")),)

    def _towards(self, vector: complex) -> str:
        if vector == 0:
            return ""
        degrees = round(math.degrees(cmath.phase(vector)) % 360.0, 2) % 360.0
        quadrant, within = divmod(degrees, 90.0)
        return str(self.case.words["headings"][int(2 * quadrant) + (within > 0)])

    def _sense(self, value: float, known: bool = True) -> str:
        words = self.case.words["sense"]
        if not known:
            return str(self.case.words["instant"]["open_sense"])
        return str(words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"])

    def _coordinate(self, value: float) -> Number:
        """Return a coordinate in mm, without rounding errors."""
        return Number(round(value * MM, 6 - math.ceil(math.log10(self.case.exercise.motion.size * MM))) + 0.0)

    def _coordinates(self, body: int) -> Inlines:
        """Return the coordinates x and y of a body's instant centre, as in the table of points."""
        centre = self.worked.layout.centres[body]
        numbers = [
            Number(self._coordinate(part).value, None, self.case.unit_names.get("mm"))
            for part in (centre.at.real, centre.at.imag)
        ]
        literal = self.case.literal
        coordinates = None if literal is None else literal.place(centre.name)
        formulas = None if coordinates is None else [*map(lettered, coordinates)]
        listing: list[Any] = []
        for index, axis in enumerate("xy"):
            parts: list[Expression] = [] if formulas is None else [formulas[index]]
            # 0 is printed without regard to its unit.
            if not parts or (self.put_in and numbers[index].value):
                parts.append(numbers[index])
            chain = Chain((Symbol(axis, centre.name), *parts))
            listing += [*([Text("; ")] if listing else []), InlineMath(chain, slashed=True)]
        return tuple(listing)


def lettered(formula: Expression) -> Expression:
    """Return a formula with the printed letters of its symbols."""
    return substitute(formula, lambda ref: symbol(ref.id))


# --- axes: one number for each line, in the text as in the figures ---------------------------------


class DrawnAxis(Record):
    """An axis of projection towards `direction`, from `start` to `end` of its points (mm), which may coincide."""

    symbol: Symbol
    direction: complex
    start: complex
    end: complex


class Axes(Record):
    """The axes of all solutions of an exercise.

    All ξ on one line are one axis, whichever step uses it; its η is at the point of its first step.
    """

    solutions: Sequence[Worked]

    def symbol(self, step: Step, letter: str) -> Symbol:
        """Return the letter of a step's axis, with a number if ξ lies on several lines."""
        if not step.axes or step.axes[0].letter in COORDINATES:
            return Symbol(letter)
        return self._symbol(step.axes[0], letter)

    def drawn(self, accelerations: bool, scale: float) -> Iterator[DrawnAxis]:
        """Yield the axes ξ and η of the steps for velocities or accelerations; `scale` is the mm of paper for
        a metre.
        """
        letters: set[Symbol] = set()
        for step, axis in self._of(accelerations):
            symbol = self._symbol(axis, axis.letter)
            if axis.letter not in COORDINATES and symbol not in letters:
                letters.add(symbol)
                at = self._at(self._first(axis).point)
                along = [0.0, *self._on_it(step.body, axis.direction, at)]
                ends = (scale * (at + reach * axis.direction) for reach in (min(along), max(along)))
                yield DrawnAxis(symbol, axis.direction, *ends)

    def has_coordinates(self, accelerations: bool) -> bool:
        """Return True if anything is projected on x or y."""
        return any(axis.letter in COORDINATES for _, axis in self._of(accelerations))

    def _on_it(self, body: int, direction: complex, at: complex) -> Iterator[float]:
        """Yield the coordinates of the body's points along an axis, which extends beyond them."""
        for name in self.solutions[0].layout.members.get(body, ()):
            there = direction.conjugate() * (self._at(name) - at)
            if abs(there.imag) < SAME_PLACE:
                yield there.real

    def _of(self, accelerations: bool | None = None) -> Iterator[tuple[Step, Axis]]:
        for worked in self.solutions:
            for step in worked.steps:
                if accelerations is None or step.of_accelerations == accelerations:
                    yield from ((step, axis) for axis in step.axes)

    def _at(self, point: str) -> complex:
        return self.solutions[0].layout.points[point]

    def _lines(self) -> list[Axis]:
        """Return one axis for each line of ξ."""
        lines: list[Axis] = []
        for _, axis in self._of():
            if axis.letter not in COORDINATES and not any(self._same(axis, line) for line in lines):
                lines.append(axis)
        return lines

    def _same(self, first: Axis, second: Axis) -> bool:
        """Return True if the ξ of both lie on one line."""
        apart = self._at(second.point) - self._at(first.point)
        return parallel(first.along, second.along) and abs((first.along.conjugate() * apart).imag) < SAME_PLACE

    def _first(self, axis: Axis) -> Axis:
        return next((line for line in self._lines() if self._same(axis, line)), axis)

    def _symbol(self, axis: Axis, letter: str) -> Symbol:
        lines = self._lines()
        if axis.letter in COORDINATES or len(lines) == 1:
            return Symbol(letter)
        return Symbol(letter, str(1 + lines.index(self._first(axis))))
