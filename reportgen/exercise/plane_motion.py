"""The case of a `plane-motion` exercise, and the checks of its file.

The system has no driver, no positions and no forces, so it has its own kind of case.  Checks run in this order: names,
positions and contacts, whether the system can move as given and determines the answers, and whether the requested
methods can find them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from reportgen.assignment.common import Draft
from reportgen.base.errors import Finding, Where
from reportgen.exercise import file, literal_symbols
from reportgen.exercise.functions_of_angle import coordinates
from reportgen.exercise.instant_centres import SAME_PLACE, Layout, lay_out
from reportgen.exercise.point_positions import TOP, MisplacedError, direction_of, named, perpendicular, system
from reportgen.exercise.rate_conditions import GROUND
from reportgen.exercise.rate_solution import InstantMotion
from reportgen.formula import Negative, Ref

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.exercise.case import ExerciseCase

Parameters = file.Parameters
TURNS = 1
HAS_POSITIONS = False


def case(assignment: Assignment) -> ExerciseCase:
    """Return the case of an assignment."""
    from reportgen.exercise.case import ExerciseCase

    return ExerciseCase(assignment)


# --- checks across several values of a file -------------------------------------------------------


CHANGED = 0.0137
"""Relative change of the first symbol in the check that the system still moves; the next symbols change by more."""


def check(draft: Draft) -> Iterator[Finding]:
    """Yield findings about names, then positions, then motion; a later check runs only if the earlier ones passed."""
    given: file.Parameters | None = draft.sections.get("parameters")
    if given is None:
        return
    names = _Names(given)
    misnamed = [*names.points(), *names.bodies(), *names.joints(), *names.rates(), *names.asked(), *names.symbols()]
    yield from misnamed or _motion(given, draft.raw["parameters"])


class _Names:
    """Checks that every point, body and disc that is named is declared."""

    def __init__(self, given: file.Parameters) -> None:
        self.given = given

    def symbols(self) -> Iterator[Finding]:
        """Yield findings about symbols that are printed like the rotation of a body, such as ω₂, unless they
        mean that.
        """
        for name in self.given.symbols:
            symbol = literal_symbols.symbol(name)
            if symbol.base not in ("ω", "ε") or not symbol.sub or int(symbol.sub) not in self.given.bodies:
                continue
            kind = "omega" if symbol.base == "ω" else "epsilon"
            rates = [one for one in self.given.given if isinstance(one, file.OmegaOf | file.EpsilonOf)]
            stated = [rate.value for rate in rates if rate.type == kind and rate.body == int(symbol.sub)]
            formulas = [one.formula for one in stated if isinstance(one, literal_symbols.Literal)]
            if not any(formula in (Ref(name), Negative(Ref(name))) for formula in formulas):
                yield Finding("symbol-of-body", (*TOP, "symbols", name), {"text": name, "body": symbol.sub}, at="key")

    def points(self) -> Iterator[Finding]:
        for name, point in self.given.points.items():
            where = (*TOP, "points", name)
            forms = {"at": point.at, "lines": point.lines, "distances": point.distances, "from": point.from_}
            forms_given = [key for key, value in forms.items() if value is not None]
            yield from _one_of(forms_given, tuple(forms), where)
            if forms_given == ["from"]:
                if point.distance is None:
                    yield Finding("missing-key", where, {"key": "distance"})
                further = {"angle": point.angle, "on": point.on}
                yield from _one_of([key for key, value in further.items() if value is not None], tuple(further), where)

    def bodies(self) -> Iterator[Finding]:
        for number, body in self.given.bodies.items():
            where = (*TOP, "bodies", str(number))
            for index, name in enumerate(body.points):
                yield from self._point(name, (*where, "points", index))
            if body.disc is not None:
                yield from self._point(body.disc.centre, (*where, "disc", "centre"))
            if number != GROUND and not body.carried:
                yield Finding("missing-key", where, {"key": "points"})

    def joints(self) -> Iterator[Finding]:
        for index, joint in enumerate(self.given.joints):
            where = (*TOP, "joints", index)
            match joint:
                case file.Pin(at=at, bodies=bodies):
                    yield from self._point(at, (*where, "at"))
                    yield from self._pair(bodies, (*where, "bodies"))
                    for place, body in enumerate(bodies):
                        yield from self._carried(at, body, (*where, "bodies", place))
                case file.SlotJoint(point=point, body=body, on=carrier):
                    yield from self._point(point, (*where, "point"))
                    yield from self._pair((body, carrier), where, "body", "on")
                    yield from self._carried(point, body, (*where, "body"))
                case file.Slider(body=body, on=carrier):
                    yield from self._pair((body, carrier), where, "body", "on")
                case file.Translation(body=body):
                    yield from self._body(body, (*where, "body"))
                case file.RollingOnLine(disc=body, on=carrier, through=through):
                    yield from self._point(through, (*where, "through"))
                    yield from self._pair((body, carrier), where, "disc", "on")
                    yield from self._disc(body, (*where, "disc"))
                case file.RollingOnCircle(discs=discs) | file.Gears(discs=discs) | file.Belt(discs=discs):
                    yield from self._pair(discs, (*where, "discs"))
                    for place, body in enumerate(discs):
                        yield from self._disc(body, (*where, "discs", place))
                case file.Cord(points=points):
                    yield from self._ends(points, (*where, "points"))
            if isinstance(joint, file.Directed):
                given_as = [key for key in ("angle", "along") if getattr(joint, key) is not None]
                yield from _one_of(given_as, ("angle", "along"), where)
                if joint.along is not None:
                    yield from self._ends(joint.along, (*where, "along"))

    def rates(self) -> Iterator[Finding]:
        for index, rate in enumerate(self.given.given):
            where = (*TOP, "given", index)
            if isinstance(rate, file.OmegaOf | file.EpsilonOf):
                yield from self._body(rate.body, (*where, "body"))
            else:
                yield from self._moving(rate.point, (*where, "point"))

    def asked(self) -> Iterator[Finding]:
        for index, asked in enumerate(self.given.find):
            where = (*TOP, "find", index)
            yield from self._body(asked.body, where) if asked.of_body else self._moving(asked.of, where)

    def _point(self, name: str, where: Where) -> Iterator[Finding]:
        if name not in self.given.points:
            yield Finding("no-such-point", where, {"text": name, "known": ", ".join(self.given.points)})

    def _moving(self, name: str, where: Where) -> Iterator[Finding]:
        """Yield a finding if a rate of a point is given or asked and the point moves with no body."""
        moving = {point for number, body in self.given.bodies.items() if number for point in body.carried}
        if name in self.given.points and name not in moving:
            yield Finding("point-at-rest", where, {"text": name})
        else:
            yield from self._point(name, where)

    def _ends(self, names: tuple[str, ...], where: Where) -> Iterator[Finding]:
        for index, name in enumerate(names):
            yield from self._point(name, (*where, index))
        if names[0] == names[1]:
            yield Finding("same-point", (*where, 1), {"text": names[1]})

    def _body(self, number: int, where: Where) -> Iterator[Finding]:
        if number != GROUND and number not in self.given.bodies:
            known = ", ".join(map(str, sorted({GROUND, *self.given.bodies})))
            yield Finding("no-such-body", where, {"text": str(number), "known": known})

    def _pair(self, bodies: tuple[int, ...], where: Where, *keys: str) -> Iterator[Finding]:
        at: Iterable[str | int] = keys or (0, 1)
        places = [(*where, key) for key in at]
        for body, place in zip(bodies, places, strict=True):
            yield from self._body(body, place)
        if bodies[0] == bodies[1]:
            yield Finding("same-body", places[1], {"text": str(bodies[1])})

    def _carried(self, point: str, body: int, where: Where) -> Iterator[Finding]:
        if body and body in self.given.bodies and point not in self.given.bodies[body].carried:
            yield Finding("not-on-body", where, {"text": point, "body": str(body)})

    def _disc(self, body: int, where: Where) -> Iterator[Finding]:
        if body in self.given.bodies and self.given.disc(body) is None:
            yield Finding("no-disc", where, {"text": str(body)})


def _one_of(given: list[str], keys: tuple[str, ...], where: Where) -> Iterator[Finding]:
    if len(given) > 1:
        yield Finding("both-given", (*where, given[1]), {"first": given[0], "second": given[1]}, at="key")
    elif not given:
        yield Finding("missing-key", where, {"key": " | ".join(keys)})


# --- the motion -----------------------------------------------------------------------------------


def _motion(given: file.Parameters, raw: Mapping[str, Any]) -> Iterator[Finding]:
    """Yield findings if the system cannot move as given, or does not determine a requested quantity."""
    try:
        motion = InstantMotion(system(given))
    except MisplacedError as fault:
        yield fault.finding
        return
    known = named(given)
    for rank, conflicts in (
        ("velocities", motion.velocity_conflicts),
        ("accelerations", motion.acceleration_conflicts),
    ):
        for conflict in conflicts:
            where, called = known[conflict.name]
            others = ", ".join(known[name][1] for name in conflict.others) or "–"
            yield Finding("contradiction", where, {"text": called, "others": others, "reason": rank})
        if conflicts:
            return
    for body in motion.parting:
        given_of = (index for index, one in enumerate(given.given) if _is_acceleration_on(one, body, given))
        yield Finding("points-part", (*TOP, "given", max(given_of)), {"body": str(body)})
    if motion.parting:
        return
    knows = {
        "omega": lambda of: motion.knows_omega(int(of)),
        "eps": lambda of: motion.knows_epsilon(int(of)),
        "centre": lambda of: motion.knows_centre(int(of)),
        "v": motion.knows_velocity,
        "a": motion.knows_acceleration,
    }
    for index, asked in enumerate(given.find):
        if not knows[asked.what](asked.of):
            yield Finding("undetermined", (*TOP, "find", index), {"text": asked.id, "open": _open(motion, asked)})

    yield from _methods(given, lay_out(given, motion))
    yield from _by_symbols(given, raw)


def _by_symbols(given: file.Parameters, raw: Mapping[str, Any]) -> Iterator[Finding]:
    """Yield a finding if the system moves only at the values that the symbols have now."""
    if not given.symbols:
        return
    changes = {name: 1 + CHANGED * (index + 1) for index, name in enumerate(given.symbols)}
    changed = {
        name: f"{stated.given.si * changes[name]!r} {literal_symbols.si_unit(stated)}"
        for name, stated in given.symbols.items()
    }
    try:
        changed_motion = InstantMotion(system(file.Parameters.model_validate({**raw, "symbols": changed})))
        moves = not (changed_motion.velocity_conflicts or changed_motion.acceleration_conflicts)
    except (MisplacedError, ValidationError):
        moves = False
    if not moves:
        values = ", ".join(f"{name} = {text}" for name, text in changed.items())
        yield Finding("only-at-values", (*TOP, "symbols"), {"text": values})


def _methods(given: file.Parameters, layout: Layout) -> Iterator[Finding]:
    """Yield findings about requested methods that cannot apply or are requested twice."""
    for index, method in enumerate(given.methods):
        where = (*TOP, "methods", index)
        if method in given.methods[:index]:
            yield Finding("method-repeated", where, {"text": method})
        elif code := why_not(method, layout):
            yield Finding(code, where, {"text": method, "count": str(coordinates(layout))})


def _is_acceleration_on(rate: file.GivenRate, body: int, given: file.Parameters) -> bool:
    return isinstance(rate, file.AccelerationOf) and rate.point in given.bodies[body].carried


def _open(motion: InstantMotion, asked: file.Asked) -> str:
    """Return the numbers of the bodies whose motion is undetermined."""
    bodies = motion.system.bodies
    if asked.what in ("omega", "v", "centre"):
        loose = [body for body in bodies if not (motion.knows_omega(body) and motion.knows_centre(body))]
    else:
        loose = [
            body
            for body, points in bodies.items()
            if not (motion.knows_epsilon(body) and all(motion.knows_acceleration(point) for point in points))
        ]
    return ", ".join(map(str, loose)) or "–"


# --- the methods that can apply ---------------------------------------------------------------------


def why_not(method: file.Method, layout: Layout) -> str:
    """Return the fault code of a method that cannot apply; "" if it can."""
    plane = [*_in_plane_motion(layout)]
    match method:
        case "moving frame":
            return "" if layout.given.slots else "no-moving-frame"
        case "equations":
            return "" if coordinates(layout) == 1 else "no-equations"
        case _ if not plane:
            return "no-plane-motion"
        case "instant centre":
            has_directions = any(body in layout.centres or _across(layout, body) for body in plane)
            return "" if has_directions else "no-directions"
        case "base point":
            has_base = any(_rolls(layout, body) or len(_guided(layout, body)) > 1 for body in plane)
            return "" if has_base or _two_bases(layout, plane) else "no-base-point"
        case "projection":
            # Projections give no angular velocity.
            asked = any(one.what in ("v", "a") for one in layout.given.find)
            return "" if asked and any(_projects(layout, body) for body in plane) else "no-projection"


def _in_plane_motion(layout: Layout) -> Iterator[int]:
    for body in layout.members:
        if body not in layout.centres or not layout.centres[body].by_joint:
            yield body


def _rolls(layout: Layout, body: int) -> bool:
    return body in layout.centres and layout.centres[body].rule == "contact"


def _guided(layout: Layout, body: int) -> list[str]:
    """Return the points of a body whose line of motion is known from joints or the data."""
    return [name for name in layout.members[body] if name in layout.guided]


def _two_bases(layout: Layout, plane: list[int]) -> bool:
    """Return True if two bodies that share a point each have another one that is guided."""
    for first_body, partner in combinations(plane, 2):
        shared = {*layout.members[first_body]} & {*layout.members[partner]}
        if shared and all({*_guided(layout, body)} - shared for body in (first_body, partner)):
            return True
    return False


def _across(layout: Layout, body: int) -> bool:
    """Return True if two points of a body move across the line between them: the centre lies on it."""
    return any(all(across) for across in _pairs_across(layout, body, layout.directions))


def _projects(layout: Layout, body: int) -> bool:
    """Return True if a body has two guided points, at least one of which does not move across the line between them."""
    return any(not all(across) for across in _pairs_across(layout, body, layout.guided))


def _pairs_across(layout: Layout, body: int, directions: Mapping[str, complex]) -> Iterator[tuple[bool, bool]]:
    """Yield, for each pair of points of a body with known directions, whether each moves across the line
    between them.
    """
    for base, tip in combinations([name for name in layout.members[body] if name in directions], 2):
        line = layout.points[tip] - layout.points[base]
        if abs(line) > SAME_PLACE:
            u = direction_of(line)
            yield perpendicular(directions[base], u), perpendicular(directions[tip], u)


CHECKS = (check,)
