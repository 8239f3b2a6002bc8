"""The page of a solution: given data and questions, figures, every step with its equations, and the answers."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from reportgen.base.placeholders import NO_LETTER
from reportgen.base.records import Record, replace
from reportgen.base.template_access import view
from reportgen.base.units import Given
from reportgen.case.finished_document import finished
from reportgen.document import (
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
    listed,
)
from reportgen.document.template_rendering import NamedPoint, Prose
from reportgen.exercise import file
from reportgen.exercise.figures import FIGURES
from reportgen.exercise.literal_solution import SolvedExercise
from reportgen.exercise.literal_symbols import Literal, symbol
from reportgen.exercise.views import AT, FurtherView, Solution, lettered
from reportgen.formula import PI, Chain, Expression, Negative, Number, Symbol, ids, vocabulary

if TYPE_CHECKING:
    pass

TYPED = 6
"""Significant digits of given data; a number with more of them comes from a root or π."""
PLACES = (25.0, 35.0, 35.0)
"""Widths (mm) of the columns of the coordinates."""
COMPARED = (25.0, 135.0)
"""Widths (mm) in the comparison of methods: its first column, and the sum of the others."""
METHODS_AGREE = 1e-9
"""Values that differ by less than this share of the largest of their kind are equal."""
ANSWER = (25.0, 65.0, 70.0)
"""Widths (mm) of the columns of the answers."""


def solution(case: SolvedExercise) -> Document:
    """Return the finished, numbered document.

    Raises `TemplateError`, and `NotOfferedError` if no known steps lead to an answer.
    """
    return finished(case, Prose(case.places).render("exercise", names(case)), title=case.title)


def task_names(case: SolvedExercise) -> Mapping[str, Any]:
    """Return the names in the templates of an exercise for the given data and the questions."""
    page = SolutionPage(case, case.worked)
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
        "bodies": page.bodies,
        "joints": page.joints,
        "asked": page.asked,
        "system_figure": page.figure("system"),
    }


def names(case: SolvedExercise) -> Mapping[str, Any]:
    """Return the names in the templates of its solution."""
    page = SolutionPage(case, case.worked)
    further = [SolutionPage(case, worked) for worked in case.further]
    alone = case.alone
    return {
        **task_names(case),
        "method": page.method,
        "unfound": page.unfound(alone[0]) if alone else (),
        "gaps": any(one.missing for one in alone),
        "further": [FurtherView(one.method, one.steps_beside(case.worked), one.unfound(one.worked)) for one in further],
        "comparison": page.comparison if further else (),
        "lengths": page.lengths,
        "steps": page.steps,
        "velocity_figure": page.figure("velocity"),
        "acceleration_figure": page.figure("acceleration"),
        "expressions": page.expressions,
        "unwritten": page.unwritten,
        "answers": page.answers,
        "numbers": page.numbers,
        "directions": page.directions,
    }


@view()
class GivenItem(Record):
    """A given quantity: the key of its phrase, and the values in the phrase."""

    form: str
    point: NamedPoint
    body: int
    value: Chain | Symbol
    way: Inlines = ()
    time: Inlines = ()


@view()
class BodyItem(Record):
    """A body: its name, the points that move with it, and centre and radius if it is a disc."""

    name: str
    points: Inlines
    centre: NamedPoint | None = None
    radius: Number | Expression | None = None


@view()
class JointItem(Record):
    """A joint: the key of its phrase, its points, its bodies in words, and a direction."""

    form: str
    points: Sequence[NamedPoint]
    bodies: Sequence[str]
    way: Inlines = ()


class SolutionPage(Solution):
    """An exercise as its page prints it."""

    @property
    def who(self) -> str:
        """Return the student's name and class, as far as known."""
        student = self.case.assignment.report.student
        return ", ".join(filter(None, (student.name, student.id, student.class_, student.section)))

    @property
    def whence(self) -> str:
        """Return the school and department, the author of the exercise, and the date, as far as the file gives them."""
        report, labels = self.case.assignment.report, self.case.words["cover"]
        lecturer = f"{labels['supervisor']}: {report.supervisor}" if report.supervisor else None
        day = report.date.strftime("%d.%m.%Y") if report.date else None
        return ", ".join(filter(None, (report.university, report.faculty, report.department, lecturer, day)))

    # --- given and asked

    @property
    def given(self) -> tuple[GivenItem, ...]:
        return tuple(self._given_items())

    @property
    def bodies(self) -> tuple[BodyItem, ...]:
        """Return the bodies of the system, with the ground if it has a disc."""
        return tuple(self._body(number, one) for number, one in self.case.exercise.given.bodies.items())

    def _body(self, number: int, declared: file.BodyOf) -> BodyItem:
        name, points = self._called(number), listed(InlineMath(vocabulary.point(name)) for name in declared.points)
        if declared.disc is None:
            return BodyItem(name, points)
        given = declared.disc.radius
        number_typed = Number(float(f"{given.value:.{TYPED}g}"), None, pretty(given.unit))
        radius = lettered(given.formula) if isinstance(given, Literal) else number_typed
        return BodyItem(name, points, NamedPoint(declared.disc.centre), radius)

    def _called(self, body: int) -> str:
        words = self.case.words["instant"]
        return str(words["body"]).format(body) if body else str(words["ground"])

    @property
    def joints(self) -> tuple[JointItem, ...]:
        """Return the joints of the bodies."""
        return tuple(self._joint(joint) for joint in self.case.exercise.given.joints)

    def _joint(self, joint: file.Joint) -> JointItem:
        named = joint.model_dump(include={"at", "point", "through"}, exclude_none=True)
        points = [NamedPoint(name) for name in (*named.values(), *getattr(joint, "points", ()))]
        numbers = [getattr(joint, key) for key in ("body", "disc", "on") if hasattr(joint, key)]
        numbers += getattr(joint, "bodies", getattr(joint, "discs", ()))
        names = list(map(self._called, numbers))
        form = joint.type.replace(" ", "-") + ("-crossed" if getattr(joint, "crossed", False) else "")
        return JointItem(form, points, names, self._direction(joint) if isinstance(joint, file.Directed) else ())

    def _direction(self, joint: file.Directed) -> Inlines:
        """Return a direction in words: an angle to the +x axis, or a line through two points."""
        at_angle, along = self.case.words["instant"]["directions"]
        if joint.along is not None:
            return Text(f"{along} "), *(InlineMath(vocabulary.point(name)) for name in joint.along)
        before, _, after = at_angle.format(NO_LETTER).partition(NO_LETTER)
        return Text(before), *self._angle(joint.angle.si if joint.angle else 0.0), Text(after)

    def _given_items(self) -> Iterator[GivenItem]:
        for rate in self.case.exercise.given.given:
            match rate:
                case file.OmegaOf():
                    yield self._given_rotation("omega", ids.angular_velocity(rate.body), rate)
                case file.EpsilonOf():
                    yield self._given_rotation("epsilon", ids.angular_acceleration(rate.body), rate)
                case file.VelocityOf():
                    yield self._given_vector("velocity", ids.velocity(rate.point), rate)
                case file.AccelerationOf():
                    yield self._given_vector("acceleration", ids.acceleration(rate.point), rate)
                case file.FromRest(point=point, acceleration=acceleration, time=time, direction=direction):
                    typed = self._typed(ids.acceleration(point), acceleration)
                    after = (InlineMath(Chain((Symbol("t"), Number(time.value, None, time.unit)))),)
                    yield GivenItem("from-rest", NamedPoint(point), 0, typed, self._angle(direction.si), after)

    def _given_rotation(self, form: str, id: str, rate: file.OmegaOf | file.EpsilonOf) -> GivenItem:
        sense = (Text(self._sense(rate.value.si)),)
        form += "" if rate.value.si else "-zero"
        return GivenItem(form, NamedPoint(""), rate.body, self._typed(id, rate.value), sense)

    def _given_vector(self, form: str, id: str, rate: file.VelocityOf | file.AccelerationOf) -> GivenItem:
        point, size, angle = NamedPoint(rate.point), rate.size, rate.direction.si
        if size is None:
            return GivenItem(f"{form}-way", point, 0, vocabulary.symbol(id), self._angle(angle))
        turned = angle + (math.pi if size.si < 0 else 0.0)
        return GivenItem(form, point, 0, self._typed(id, size), self._angle(turned))

    def _typed(self, id: str, given: Given) -> Chain:
        """Return a given quantity by its size; by its formula if it is stated by symbols."""
        unit = self.case.unit_names.get(pretty(given.unit))
        size = Number(float(f"{abs(given.value):.{TYPED}g}"), None, unit)
        if not isinstance(given, Literal):
            if given.unit != "rpm" or id not in self.worked.printed:
                return Chain((vocabulary.symbol(id), size))
            # The lines of the solution use rad/s.
            turned = 2 * PI * Number(size.value) / 60
            return Chain((vocabulary.symbol(id), size, turned, self.worked.printed.number(id, AT)))
        formula = lettered(given.formula)
        parts = (formula.of if isinstance(formula, Negative) else formula,)
        return Chain((vocabulary.symbol(id), *parts))

    @property
    def symbols(self) -> Inlines:
        """Return the symbols of the file with their values."""
        listing: list[Any] = []
        for name, stated in self.case.exercise.given.symbols.items():
            value = Number(stated.given.value, None, pretty(stated.given.unit))
            listing += [*([Text(", ")] if listing else []), InlineMath(Chain((symbol(name), value)))]
        return tuple(listing)

    @property
    def expressions(self) -> tuple[Equation, ...]:
        """Requested quantities, by the symbols of the file."""
        symbol = self.worked.printed.symbol
        rows = tuple(Chain((symbol(id), shown)) for id, shown in self._by_symbols() if shown is not None)
        return (Equation(rows),) if rows else ()

    @property
    def unwritten(self) -> Inlines:
        """Return the symbols of requested quantities whose expressions are too long to print."""
        return listed(InlineMath(self.worked.printed.symbol(id)) for id, shown in self._by_symbols() if shown is None)

    @property
    def asked(self) -> Inlines:
        """Return the symbols of the requested quantities."""
        listing: list[Any] = []
        for asked in self.case.exercise.asked:
            centre = asked.what == "centre"
            symbol = self._centre_symbol(asked.body) if centre else self._asked_symbol(asked)
            listing += [*([Text(", ")] if listing else []), InlineMath(symbol)]
        return tuple(listing)

    def _asked_symbol(self, asked: file.Asked) -> Expression:
        """Return the symbol of a requested rate, in bars if the data leave its sense open."""
        symbol = vocabulary.symbol(asked.id)
        return symbol if self.case.exercise.determines_sense(asked) else abs(symbol)

    def _centre_symbol(self, body: int) -> Symbol:
        return vocabulary.point(self.worked.layout.centres[body].name or "∞")

    @property
    def lengths(self) -> tuple[Equation, ...]:
        """Return the distances that the solution uses."""
        ledger = self.worked.printed
        lines = tuple(self._chain(id) for id in ledger.families if self._is_declared_length(id))
        return (Equation(lines),) if lines else ()

    @property
    def places(self) -> Table:
        """Return the table of the points' coordinates."""
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
        """Return the coordinates of a point in mm, or by symbols."""
        literal = self.case.literal
        coordinates = None if literal is None else literal.place(name)
        if coordinates is not None:
            x, y = map(lettered, coordinates)
            return (InlineMath(x, slashed=True),), (InlineMath(y, slashed=True),)
        at, unit = (
            self.case.exercise.motion.system.points[name],
            "" if literal is None else self.case.unit_names.get("mm"),
        )
        across, up = (replace(self._coordinate(part), unit=unit) for part in (at.real, at.imag))
        return (Value(across),), (Value(up),)

    @property
    def comparison(self) -> Table:
        """Return the table of requested velocities by each method that finds them.

        Raises `ValueError` if two methods disagree.
        """
        words, pages = self.case.words["instant"], [SolutionPage(self.case, worked) for worked in self.case.alone]
        motion, rows = self.case.exercise.motion, list[tuple[Cell, ...]]()
        for asked in self.case.exercise.asked:
            sizes = [float(page.worked.ledger[asked.id].values[0]) for page in pages if asked.id in page.worked.ledger]
            ledgers = [page.worked.printed for page in pages]
            if asked.what not in ("v", "omega"):
                continue
            scale = motion.fastest / (motion.size if asked.of_body else 1.0)
            if sizes and max(sizes) - min(sizes) > METHODS_AGREE * scale:
                raise ValueError(f"methods disagree on {asked.id}: {sizes}")
            cells = [
                (Value(ledger.number(asked.id, AT)),) if asked.id in ledger else (Text("–"),) for ledger in ledgers
            ]
            rows.append((Cell((InlineMath(vocabulary.symbol(asked.id)),)), *map(Cell, cells)))
        head = (words["quantity"], *(page.method for page in pages))
        columns = (Column(COMPARED[0]), *(Column(COMPARED[1] / len(pages)) for _ in pages))
        heads = tuple(Cell((Text(str(text)),)) for text in head)
        return Table(columns, (heads,), tuple(rows), (Text(str(words["compared"])),), "tab.compared")

    # --- figures and answers

    def figure(self, what: str) -> tuple[Block, ...]:
        """Return the figure of velocities or accelerations; `()` if the exercise asks for none."""
        drawn = FIGURES[what](self.case)
        if drawn is None:
            return ()
        scene, scale = drawn
        caption = (Text(self.case.words["instant"][what]), *((Text("; "), InlineMath(scale)) if scale else ()))
        return (Figure((scene,), caption, f"fig.{what}"),)

    @property
    def numbers(self) -> tuple[Equation, ...]:
        """Return the results by symbols in numbers, for the values of the symbols; `()` if the lines have numbers
        already.
        """
        if self.case.literal is None or self.put_in:
            return ()
        ledger = self.worked.printed
        worked = (
            id
            for id, family in ledger.families.items()
            if family.definition is not None and not (family.hidden or family.is_plane or family.is_signed_rotation)
        )
        rows = tuple(Chain((ledger.symbol(id), ledger.number(id, AT))) for id in worked if not ids.direction.read(id))
        return (Equation(rows),) if rows else ()

    @property
    def directions(self) -> Inlines:
        """Return the angles of the requested vectors from the +x axis; a zero vector has none."""
        ledger = self.worked.printed
        known = [id for id in ledger.families if ids.direction.read(id)]
        angles = [(id, number) for id in known if math.isfinite((number := ledger.number(id, AT)).value)]
        chains = [InlineMath(Chain((ledger.symbol(id), number))) for id, number in angles]
        return tuple(part for chain in chains for part in (Text("; "), chain))[1:]

    @property
    def answers(self) -> Table:
        """Return the table of answers: symbol, number with unit, sense or direction."""
        words = self.case.words["instant"]
        rows = tuple(tuple(map(Cell, row)) for row in self._answer_rows())
        columns = tuple(map(Column, ANSWER))
        head = (tuple(Cell((Text(str(text)),)) for text in words["answer_heads"]),)
        return Table(columns, head, rows, (Text(str(words["answers"])),), "tab.answers", framed=True)

    def _answer_rows(self) -> Iterator[tuple[Inlines, Inlines, Inlines]]:
        ledger, motion = self.worked.printed, self.case.exercise.motion
        for asked in self.case.exercise.asked:
            if asked.what == "centre":
                yield self._centre_row(asked.body)
                continue
            symbol = (InlineMath(self._asked_symbol(asked)),)
            number, literal = ledger.number(asked.id, AT), self._literal(asked.id)
            size: Inlines = (Value(number),) if self.put_in or literal is None else (InlineMath(literal, slashed=True),)
            if asked.of_body:
                sense = self._sense(motion.turn(asked.what, asked.body), self.case.exercise.determines_sense(asked))
                yield symbol, size, (Text(sense),)
            else:
                vector = motion.v(asked.of) if asked.what == "v" else motion.a(asked.of)
                degrees = round(math.degrees(cmath.phase(vector)) % 360.0, 2) % 360.0 if vector else 0.0
                angle = (Text(f"{self._towards(vector)} ("), Value(Number(degrees, None, "°")), Text(")"))
                yield symbol, size, angle if vector else (Text("–"),)

    def _centre_row(self, body: int) -> tuple[Inlines, Inlines, Inlines]:
        centre = self.worked.layout.centres[body]
        if centre.rule == "translation":
            return (Text(str(body)),), (Text(str(self.case.words["instant"]["far"])),), ()
        return (InlineMath(vocabulary.point(centre.name)),), self._coordinates(body), ()


def pretty(typed: str) -> str:
    """Return a unit as printed, with raised powers: mm/s2 → mm/s²."""
    return typed.replace("s2", "s²").replace("^", "")
