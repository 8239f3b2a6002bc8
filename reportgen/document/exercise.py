"""ExerciseCase → Document: what is given and asked, the figures, every step with its equation, the answer."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from reportgen.case import ExerciseCase
from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.plane_motion_symbols import Literal, symbol
from reportgen.document.exercise_figures import FIGURES
from reportgen.document.exercise_views import GivenItem, StepView, WayView, lettered, pretty
from reportgen.document.numbering import number
from reportgen.document.prose import PointName, Prose
from reportgen.document.tree import (
    Block,
    Cell,
    Column,
    Document,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    Table,
    Text,
    Value,
    Words,
)
from reportgen.ledger.instant.steps import Step
from reportgen.ledger.instant.vectors import Vector
from reportgen.ledger.instant.write import Worked
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Chain, Expression, Negative, Number, Symbol, Term, VectorEquation, refs
from reportgen.units import Given

TYPED = 6
"""Significant figures of given data; more of them are those of a root or of π."""
AT = 1
"""The one position of an exercise."""
MM = 1e3
PLACES = (25.0, 35.0, 35.0)
"""Widths (mm) of the columns of the coordinates."""
COMPARED = (25.0, 135.0)
"""Of the comparison of methods: its first column, and all others together."""
AGREED = 1e-9
"""Values that differ by less than this share are one."""
ANSWER = (25.0, 65.0, 70.0)
"""Widths (mm) of the columns of the answers."""


def solution(case: ExerciseCase) -> Document:
    """The finished, numbered document; raises `TemplateError`, and `NotOfferedError` where no steps are known."""
    words, assignment = case.words, case.assignment
    blocks = Prose(case.directories).render("exercise.md", names(case))
    return number(
        Document(
            assignment.language,
            case.title,
            assignment.report.student.name or "",
            (words["header"].format(course=case.course), case.variant_line),
            ("", words["document"]["page"]),
            Words(**words["document"]),
            blocks,
        )
    )


def task_names(case: ExerciseCase) -> Mapping[str, Any]:
    """What the templates of an exercise name that say what is given and asked."""
    page = Page(case, case.worked)
    return {
        "title": case.title,
        "variant": case.assignment.variant,
        "who": page.who,
        "whence": page.whence,
        "words": case.words,
        "symbols": page.symbols,
        "put_in": page.put_in,
        "places": page.places,
        "given": page.given,
        "asked": page.asked,
        "system_figure": page.figure("system"),
    }


def names(case: ExerciseCase) -> Mapping[str, Any]:
    """What the templates of its solution name."""
    page = Page(case, case.worked)
    further = [Page(case, worked) for worked in case.further]
    return {
        **task_names(case),
        "method": page.method,
        "further": [WayView(one.method, one.steps_beside(case.worked)) for one in further],
        "comparison": page.comparison(further) if further else (),
        "lengths": page.lengths,
        "steps": page.steps,
        "velocity_figure": page.figure("velocity"),
        "acceleration_figure": page.figure("acceleration"),
        "expressions": page.expressions,
        "answers": page.answers,
    }


@dataclass(frozen=True)
class Page:
    """An exercise as its page shows it."""

    case: ExerciseCase
    worked: Worked

    @property
    def who(self) -> str:
        """The student's name, and what is known of the class."""
        student = self.case.assignment.report.student
        return ", ".join(filter(None, (student.name, student.id, student.class_, student.section)))

    @property
    def whence(self) -> str:
        """The school and its parts, the one who set the exercise, and when, as far as the file names them."""
        report, labels = self.case.assignment.report, self.case.words["cover"]
        lecturer = f"{labels['supervisor']}: {report.supervisor}" if report.supervisor else None
        day = report.date.strftime("%d.%m.%Y") if report.date else None
        return ", ".join(filter(None, (report.university, report.faculty, report.department, lecturer, day)))

    # --- given and asked

    @property
    def given(self) -> tuple[GivenItem, ...]:
        return tuple(self._given_items())

    def _given_items(self) -> Iterator[GivenItem]:
        none = PointName("")
        for rate in self.case.exercise.given.given:
            match rate:
                case file.OmegaOf(body=body, value=value) | file.EpsilonOf(body=body, value=value):
                    id = f"omega.{body}" if isinstance(rate, file.OmegaOf) else f"eps.{body}"
                    sense = Text(self._sense(value.si))
                    form = ("omega" if isinstance(rate, file.OmegaOf) else "epsilon") + ("" if value.si else "-zero")
                    yield GivenItem(form, none, body, self._typed(id, value), (sense,))
                case file.VelocityOf(point=point, size=size) | file.AccelerationOf(point=point, size=size):
                    form = "velocity" if isinstance(rate, file.VelocityOf) else "acceleration"
                    id = f"{form[0]}.{point}"
                    if size is None:
                        yield GivenItem(
                            f"{form}-way", PointName(point), 0, vocabulary.symbol(id), self._angle(rate.direction.si)
                        )
                    else:
                        turned = rate.direction.si + (math.pi if size.si < 0 else 0.0)
                        shown = self._typed(id, size)
                        yield GivenItem(form, PointName(point), 0, shown, self._angle(turned))
                case file.FromRest(point=point, acceleration=acceleration, time=time):
                    shown = self._typed(f"a.{point}", acceleration)
                    after = (InlineMath(Chain((Symbol("t"), Number(time.value, None, time.unit)))),)
                    yield GivenItem("from-rest", PointName(point), 0, shown, after)

    def _typed(self, id: str, given: Given) -> Chain:
        """What is given, by its size: the formula of one that is stated by symbols."""
        size = Number(float(f"{abs(given.value):.{TYPED}g}"), None, pretty(given.unit))
        if not isinstance(given, Literal):
            return Chain((vocabulary.symbol(id), size))
        formula = lettered(given.formula)
        shown = (formula.of if isinstance(formula, Negative) else formula,)
        return Chain((vocabulary.symbol(id), *shown))

    @property
    def symbols(self) -> Inlines:
        """The symbols of the file with their values."""
        shown: list[Any] = []
        for name, one in self.case.exercise.given.symbols.items():
            value = Number(one.given.value, None, pretty(one.given.unit))
            shown += [*([Text(", ")] if shown else []), InlineMath(Chain((symbol(name), value)))]
        return tuple(shown)

    @property
    def put_in(self) -> bool:
        """Whether numbers are put in, at the end of each line."""
        return all(one.put_in for one in self.case.exercise.given.symbols.values())

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
        steps = [*formula, *([] if found is None else [found]), *result]
        return Chain(tuple(one for place, one in enumerate(steps) if place == 0 or one != steps[place - 1]))

    @property
    def expressions(self) -> tuple[Equation, ...]:
        """What was asked, by the symbols of the file."""
        if self.case.literal is None:
            return ()
        ledger = self.worked.ledger
        found = [(one.id, self._literal(one.id)) for one in self.case.exercise.asked if one.what != "centre"]
        rows = (Chain((ledger.symbol(id), shown)) for id, shown in found if shown is not None)
        return (Equation(tuple(rows)),)

    def _angle(self, radians: float) -> Inlines:
        return (Value(Number(round(math.degrees(radians) % 360.0, 2), None, "°")),)

    @property
    def asked(self) -> Inlines:
        """The symbols of what is asked."""
        shown: list[Any] = []
        for one in self.case.exercise.asked:
            centre = one.what == "centre"
            symbol = self._centre_symbol(one.body) if centre else vocabulary.symbol(one.id)
            shown += [*([Text(", ")] if shown else []), InlineMath(symbol)]
        return tuple(shown)

    def _centre_symbol(self, body: int) -> Symbol:
        return vocabulary.point(self.worked.layout.centres[body].name or "∞")

    @property
    def lengths(self) -> tuple[Equation, ...]:
        """The distances that the solution uses."""
        ledger = self.worked.ledger
        ids = [id for id in ledger.families if id.startswith("l.") and self._declared(id)]
        return (Equation(tuple(map(self._chain, ids))),) if ids else ()

    @property
    def places(self) -> Table:
        """The coordinates of the points."""
        words = self.case.words["instant"]
        head = tuple(
            Cell((Text(str(text)),)) for text in words["literal_heads" if self.case.literal else "place_heads"]
        )
        body = tuple(
            (Cell((InlineMath(vocabulary.point(name)),)), *map(Cell, self._place(name)))
            for name in self.case.exercise.motion.system.points
        )
        return Table(tuple(map(Column, PLACES)), (head,), body, (Text(str(words["places"])),), "tab.places")

    def _place(self, name: str) -> tuple[Inlines, Inlines]:
        """The coordinates of a point in mm, or by symbols."""
        if self.case.literal is not None:
            x, y = (lettered(one) for one in self.case.literal.place(name))
            return (InlineMath(x, slashed=True),), (InlineMath(y, slashed=True),)
        at = self.case.exercise.motion.system.points[name]
        return (Value(self._coordinate(at.real)),), (Value(self._coordinate(at.imag)),)

    def _coordinate(self, value: float) -> Number:
        """A coordinate in mm, without the dust of floats."""
        return Number(round(value * MM, 6 - math.ceil(math.log10(self.case.exercise.motion.size * MM))) + 0.0)

    def _declared(self, id: str) -> bool:
        """Whether a distance is one of declared points."""
        centres = {one.name for one in self.worked.layout.centres.values() if one.rule == "normals"}
        return not any(id.startswith(f"l.{name}") for name in centres - set(self.case.exercise.given.points))

    # --- steps

    @property
    def steps(self) -> tuple[StepView, ...]:
        return tuple(map(self._step, self.worked.steps))

    def steps_beside(self, first: Worked) -> tuple[StepView, ...]:
        """The steps without those that another solution has already."""
        return tuple(self._step(step) for step in self.worked.steps if step not in first.steps)

    @property
    def method(self) -> str:
        """What its method is called; "" where it is chosen for each step."""
        return str(self.case.words["instant"]["methods"][self.worked.method]) if self.worked.method else ""

    def comparison(self, further: Sequence[Page]) -> Table:
        """What is asked of velocities, by each method that leads to it.  Raises `ValueError` if two disagree."""
        words, pages = self.case.words["instant"], (self, *further)
        rows: list[tuple[Cell, ...]] = []
        for one in self.case.exercise.asked:
            ledgers = [page.worked.ledger for page in pages]
            found = [float(ledger[one.id].values[0]) for ledger in ledgers if one.id in ledger]
            if one.what not in ("v", "omega"):
                continue
            if max(found) - min(found) > AGREED * max(found):
                raise ValueError(f"methods disagree on {one.id}: {found}")
            shown = [(Value(ledger.number(one.id, AT)),) if one.id in ledger else (Text("–"),) for ledger in ledgers]
            rows.append((Cell((InlineMath(ledgers[0].symbol(one.id)),)), *map(Cell, shown)))
        head = (words["quantity"], *(page.method for page in pages))
        columns = (Column(COMPARED[0]), *(Column(COMPARED[1] / len(pages)) for _ in pages))
        heads = tuple(Cell((Text(str(text)),)) for text in head)
        return Table(columns, (heads,), tuple(rows), (Text(str(words["compared"])),), "tab.compared")

    def _step(self, step: Step) -> StepView:
        worked, motion = self.worked, self.case.exercise.motion
        ledger, layout = worked.ledger, worked.layout
        shown = [id for id in step.ids if id in ledger and not (id.startswith("l.") and self._declared(id))]
        centre = layout.centres.get(step.body)
        rate = motion.omega(step.body) if step.body else 0.0
        if any(id.startswith("eps.") for id in shown):
            rate = motion.epsilon(step.body)
        rolling = centre is not None and centre.rule == "contact" and centre.name in (step.point, step.base)
        others = centre.points if centre is not None and centre.points else ("", "")
        angles = dict.fromkeys(id for one in shown for id in self._angles_of(one))
        return StepView(
            step.kind,
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
            self._coordinates(step.body) if centre is not None and centre.rule == "normals" else (),
            (Equation(step.system),) if step.system else (),
            (Equation(step.results),) if step.results else (),
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

    def _way(self, vector: complex) -> str:
        if vector == 0:
            return "–"
        degrees = round(math.degrees(cmath.phase(vector)) % 360.0, 2) % 360.0
        quadrant, within = divmod(degrees, 90.0)
        return str(self.case.words["headings"][int(2 * quadrant) + (within > 0)])

    def _sense(self, value: float) -> str:
        words = self.case.words["sense"]
        return str(words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"])

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

    # --- figures and answers

    def figure(self, what: str) -> tuple[Block, ...]:
        """The system with its velocities or its accelerations; none where none are asked."""
        drawn = FIGURES[what](self.case)
        if drawn is None:
            return ()
        scene, scale = drawn
        caption = (Text(self.case.words["instant"][what]), *((Text("; "), InlineMath(scale)) if scale else ()))
        return (Figure((scene,), caption, f"fig.{what}"),)

    @property
    def answers(self) -> Table:
        """What was asked: symbol, number with its unit, sense or direction."""
        words = self.case.words["instant"]
        rows = tuple(tuple(map(Cell, row)) for row in self._answer_rows())
        columns = tuple(map(Column, ANSWER))
        head = (tuple(Cell((Text(str(text)),)) for text in words["answer_heads"]),)
        return Table(columns, head, rows, (Text(str(words["answers"])),), "tab.answers", framed=True)

    def _answer_rows(self) -> Iterator[tuple[Inlines, Inlines, Inlines]]:
        ledger, motion = self.worked.ledger, self.case.exercise.motion
        for one in self.case.exercise.asked:
            if one.what == "centre":
                yield self._centre_row(one.body)
                continue
            symbol = (InlineMath(ledger.symbol(one.id)),)
            number, shown = ledger.number(one.id, AT), self._literal(one.id)
            size: Inlines = (Value(number),) if self.put_in or shown is None else (InlineMath(shown, slashed=True),)
            if one.of_body:
                rate = motion.omega(one.body) if one.what == "omega" else motion.epsilon(one.body)
                yield symbol, size, (Text(self._sense(rate)),)
            else:
                vector = motion.v(one.of) if one.what == "v" else motion.a(one.of)
                degrees = round(math.degrees(cmath.phase(vector)) % 360.0, 2) % 360.0 if vector else 0.0
                angle = (Text(f"{self._way(vector)} ("), Value(Number(degrees, None, "°")), Text(")"))
                yield symbol, size, angle if vector else (Text("–"),)

    def _centre_row(self, body: int) -> tuple[Inlines, Inlines, Inlines]:
        centre = self.worked.layout.centres[body]
        if centre.rule == "translation":
            return (Text(str(body)),), (Text(str(self.case.words["instant"]["far"])),), ()
        return (InlineMath(vocabulary.point(centre.name)),), self._coordinates(body), ()

    def _coordinates(self, body: int) -> Inlines:
        """Where the instant centre of a body is: x and y, in numbers as in the table of points."""
        centre = self.worked.layout.centres[body]
        numbers = [Number(self._coordinate(part).value, None, "mm") for part in (centre.at.real, centre.at.imag)]
        literal = self.case.literal
        formulas = None if literal is None else [lettered(one) for one in literal.place(centre.name)]
        shown: list[Any] = []
        for index, axis in enumerate("xy"):
            parts: list[Expression] = [] if formulas is None else [formulas[index]]
            # Nothing is 0, whatever its unit.
            if not parts or (self.put_in and numbers[index].value):
                parts.append(numbers[index])
            chain = Chain((Symbol(axis, centre.name), *parts))
            shown += [*([Text("; ")] if shown else []), InlineMath(chain, slashed=True)]
        return tuple(shown)
