"""Steps that compute accelerations: relative to a base point, by vector equations with two unknown magnitudes.

Each step projects its equation on an axis.  A `Parts` lists the vectors that add up to the acceleration of each point;
a point that slides along a line of a moving body has the Coriolis acceleration among them.  `enter_accelerations` runs
the steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from reportgen.base.records import Record
from reportgen.exercise import file
from reportgen.exercise.derivation import Derivation, DerivationEquation, Projected, Step, Vector, components
from reportgen.exercise.point_positions import direction_of, parallel, perpendicular, unit
from reportgen.exercise.rate_conditions import GROUND
from reportgen.formula import ids, sqrt


@dataclass
class Parts:
    """The acceleration of each point as vectors that add up to it; `()` for a point at rest or in uniform motion."""

    derivation: Derivation
    of: dict[str, tuple[Vector, ...]] = field(default_factory=dict)


def relative(parts: Parts, body: int, point: str, base: str) -> tuple[Vector, Vector]:
    """Return the normal and the tangential acceleration of a point relative to another point of its body."""
    derivation = parts.derivation
    arm = direction_of(derivation.layout.points[point] - derivation.layout.points[base])
    pivot = derivation.layout.centres.get(body)
    fixed = pivot is not None and pivot.rule == "pivot" and pivot.name == base
    return _turning(derivation, body, point if fixed else point + base, arm)


def _turning(derivation: Derivation, body: int, name: str, arm: complex) -> tuple[Vector, Vector]:
    """Return aⁿ and aᵗ at the end of an arm of a body, a complex number of any length; `name` is the index of both
    symbols.
    """
    across = 1j * arm * (1 if derivation.motion.epsilon(body) >= 0 else -1)
    return Vector(ids.acceleration(name, "n"), -arm), Vector(ids.acceleration(name, "t"), across)


def enter_normal(parts: Parts, body: int, point: str, base: str, normal: Vector) -> tuple[str, ...]:
    """Enter aⁿ = ω² l (m/s²) and return the ids of its lines; `()` if the body does not rotate."""
    return _enter_part(parts, normal.id, ids.angular_velocity(body), 2, base, point)


def enter_tangential(parts: Parts, body: int, point: str, base: str, tangential: Vector) -> tuple[str, ...]:
    """Enter aᵗ = ε l (m/s²) and return the ids of its lines; `()` if the angular velocity is constant."""
    return _enter_part(parts, tangential.id, ids.angular_acceleration(body), 1, base, point)


def _enter_part(parts: Parts, id: str, rate: str, power: int, base: str, point: str) -> tuple[str, ...]:
    """Enter a component of an acceleration from a rate of the body; return the ids of its lines, `()` for a zero
    component.
    """
    derivation = parts.derivation
    if derivation.knows(id):
        return ()
    if derivation.q.si(rate) == 0:
        derivation.q.give(id, 0.0)
        return ()
    arm = derivation.length(base, point)
    derivation.q.define(id, (derivation.q[rate] if power == 1 else derivation.q[rate] ** power) * arm)
    return (arm.id, id)


class AccelerationPath(Record):
    """The known vectors of a point's acceleration, its component of unknown magnitude, and the body and base point."""

    known: tuple[Vector, ...]
    unknown: Vector
    body: int = GROUND
    base: str = ""
    lines: tuple[str, ...] = ()


def known_path(parts: Parts, point: str, body: int) -> AccelerationPath | None:
    """Return the acceleration of a point on a known path; None if its path is not known.

    On a straight line of the ground no vector is known; about a pivot, or another point with known motion, the normal
    acceleration is.
    """
    derivation, layout = parts.derivation, parts.derivation.layout
    actual = derivation.motion.a(point) if point in derivation.motion.system.points else 0j
    if point in layout.slots:
        u = layout.slots[point]
        return AccelerationPath((), Vector(ids.acceleration(point), u if (u.conjugate() * actual).real >= 0 else -u))
    for leader, centre in layout.centres.items():
        if leader != body and centre.rule == "pivot" and point in layout.own(leader) and derivation.knows_omega(leader):
            normal, tangential = relative(parts, leader, point, centre.name)
            lines = enter_normal(parts, leader, point, centre.name, normal)
            return AccelerationPath(parts.derivation.nonzero(normal), tangential, leader, centre.name, lines)
    for leader in layout.members:
        names = layout.own(leader)
        base = next((name for name in names if name in parts.of), "")
        if leader != body and point in names and base and derivation.knows_omega(leader):
            normal, tangential = relative(parts, leader, point, base)
            lines = enter_normal(parts, leader, point, base, normal)
            return AccelerationPath(
                (*parts.of[base], *parts.derivation.nonzero(normal)), tangential, leader, base, lines
            )
    return None


def enter_end(parts: Parts, point: str, path: AccelerationPath, equation: Projected) -> None:
    """Enter the whole acceleration of a point whose unknown component has been found, and ε of the body that it belongs
    to.
    """
    derivation, size = parts.derivation, parts.derivation.q[path.unknown.id]
    parts.of[point] = (*path.known, *derivation.nonzero(path.unknown))
    if path.body and not derivation.knows_epsilon(path.body):
        equation.then(
            derivation.q.define(ids.angular_acceleration(path.body), size / derivation.length(path.base, point))
        )


AccelerationStep = Callable[[Parts], bool]
"""A step that enters one more rate of a body or the acceleration of one more point; returns False if it cannot."""


def enter_accelerations(derivation: Derivation, finders: Sequence[AccelerationStep]) -> None:
    """Enter the given rates, then all rates that follow from them and the velocities, each by the first step that
    applies.
    """
    parts = Parts(derivation)
    _given(parts)
    while any(find(parts) for find in finders):
        pass
    for asked in derivation.layout.given.find:
        if asked.what == "a" and asked.of in parts.of and not derivation.knows(asked.id):
            _whole(parts, asked.of)


def _given(parts: Parts) -> None:
    derivation = parts.derivation
    for rate in derivation.layout.given.given:
        match rate:
            case file.EpsilonOf(body=body, value=value):
                derivation.given(ids.angular_acceleration(body), value.si)
            case file.AccelerationOf(point=point, size=size, direction=angle) if size is not None:
                a = derivation.given(ids.acceleration(point), size.si)
                direction = unit(angle.si) * (1 if size.si >= 0 else -1)
                parts.of[point] = (Vector(a.id, direction),) if size.si else ()
            case file.FromRest(point=point, acceleration=acceleration, direction=angle):
                direction = unit(angle.si) * (1 if acceleration.si >= 0 else -1)
                parts.of[point] = (Vector(ids.acceleration(point), direction),)
    for body, centre in derivation.layout.centres.items():
        if centre.rule == "pivot":
            parts.of[centre.name] = ()
        if centre.rule == "translation" and not derivation.knows_epsilon(body) and _held(derivation, body):
            derivation.q.give(ids.angular_acceleration(body), 0.0)


def _held(derivation: Derivation, body: int) -> bool:
    """Return True if a joint keeps a body from turning, not only at the instant."""
    joints = derivation.layout.given.joints
    return any(
        joint.body == body and (isinstance(joint, file.Translation) or joint.on == GROUND)
        for joint in joints
        if isinstance(joint, file.Slider | file.Translation)
    )


def about_points(parts: Parts) -> bool:
    """Enter ε of one more body, or the acceleration of one of its points relative to another; return False if none
    follows.
    """
    for body in parts.derivation.layout.members:
        names = parts.derivation.layout.own(body)
        if _free(parts, body, names) or _rolling(parts, body) or _points(parts, body, names):
            return True
        if _by_base(parts, body, names):
            return True
    return False


def by_slots(parts: Parts) -> bool:
    """Enter one more rate by a point that slides along a line of a moving body; return False if none follows."""
    return any(by_slot(parts, joint) for joint in parts.derivation.layout.given.slots)


# --- about a known point --------------------------------------------------------------------------


def _points(parts: Parts, body: int, names: list[str]) -> bool:
    """Enter the accelerations of points of a body with known ω and ε, relative to a point with known acceleration."""
    derivation = parts.derivation
    # The base point whose acceleration has the fewest parts, as the centre of a wheel or a pivot.
    known = [name for name in _with_pivot(parts, body, names) if name in parts.of]
    base = min(known, key=lambda name: len(parts.of[name]), default=None)
    new = [name for name in names if name not in parts.of]
    if base is None or not new or not (derivation.knows_omega(body) and derivation.knows_epsilon(body)):
        return False
    point = new[0]
    normal, tangential = relative(parts, body, point, base)
    lines = enter_normal(parts, body, point, base, normal) + enter_tangential(parts, body, point, base, tangential)
    own = parts.derivation.nonzero(normal, tangential)
    parts.of[point] = (*parts.of[base], *own)
    equation = DerivationEquation((), parts.of[point])
    kind = "acceleration-point" if parts.of[base] else "acceleration-pivot"
    derivation.steps.append(Step(kind, lines, body, point, base, equation))
    return True


def _with_pivot(parts: Parts, body: int, names: list[str]) -> list[str]:
    """Return the points of a body, its pivot first."""
    centre = parts.derivation.layout.centres.get(body)
    return [centre.name, *names] if centre is not None and centre.rule == "pivot" else names


# --- two unknown sizes ----------------------------------------------------------------------------


def _by_base(parts: Parts, body: int, names: list[str]) -> bool:
    """Enter ε of a body from a point with known acceleration and another on a known path, by projection on
    their line.
    """
    derivation = parts.derivation
    if derivation.knows_epsilon(body) or not derivation.knows_omega(body):
        return False
    bases = [name for name in names if name in parts.of]
    for base in bases:
        for point in names:
            if point not in parts.of and (path := known_path(parts, point, body)) is not None:
                return _two_unknown(parts, body, point, base, path)
    return False


def _two_unknown(parts: Parts, body: int, point: str, base: str, path: AccelerationPath) -> bool:
    """a_P = a_B + aⁿ + aᵗ with two unknown sizes: along BP there is no aᵗ, and across it there is no aⁿ."""
    derivation, q = parts.derivation, parts.derivation.q
    normal, tangential = relative(parts, body, point, base)
    line = direction_of(derivation.layout.points[point] - derivation.layout.points[base])
    if perpendicular(line, path.unknown.direction):
        return False
    lines = path.lines + enter_normal(parts, body, point, base, normal)
    bases = (*parts.of[base], *derivation.nonzero(normal))
    equation = Projected(derivation, (*path.known, path.unknown), (*bases, tangential), lines)
    equation.find(path.unknown, line, "ξ", point)
    size = equation.find(tangential, tangential.direction, "η", point)
    equation.then(q.define(ids.angular_acceleration(body), size / derivation.length(base, point)))
    enter_end(parts, point, path, equation)
    equation.step("acceleration-base", body, point, base)
    return True


# --- discs, free bodies, slots --------------------------------------------------------------------


def _rolling(parts: Parts, body: int) -> bool:
    """Enter ε = aᵗ/r of a disc that rolls on the ground, with aᵗ of its centre along the line of contact."""
    derivation, q = parts.derivation, parts.derivation.q
    centre, disc = derivation.layout.centres.get(body), derivation.layout.given.disc(body)
    if centre is None or disc is None or centre.rule != "contact" or derivation.knows_epsilon(body):
        return False
    if disc.centre not in parts.of:
        return False
    along = 1j * direction_of(derivation.layout.points[disc.centre] - centre.at)
    terms = [one for one in parts.of[disc.centre] if parallel(one.direction, along)]
    if len(terms) > 1 or any(components(q, [one], along) for one in parts.of[disc.centre] if one not in terms):
        return False
    radius = derivation.length(centre.name, disc.centre, centre.at)
    id = ids.angular_acceleration(body)
    eps = q.define(id, q[terms[0].id] / radius) if terms else q.give(id, 0.0)
    derivation.steps.append(Step("acceleration-rolling", (radius.id, eps.id), body, disc.centre, centre.name))
    return True


def _free(parts: Parts, body: int, names: list[str]) -> bool:
    """Enter ω and ε of a body from the accelerations of two of its points."""
    derivation, q = parts.derivation, parts.derivation.q
    known = [name for name in names if name in parts.of]
    if derivation.knows_omega(body) or len(known) < 2 or body in derivation.layout.centres:
        return False
    base, point = known[0], known[1]
    arm, line = (
        derivation.length(base, point),
        direction_of(derivation.layout.points[point] - derivation.layout.points[base]),
    )
    normal, tangential = relative(parts, body, point, base)
    equation = Projected(derivation, parts.of[point], (*parts.of[base], normal, tangential))
    along = equation.find(normal, line, "ξ", point)
    equation.then(q.define(ids.angular_velocity(body), sqrt(along / arm)))
    across = equation.find(tangential, tangential.direction, "η", point)
    equation.then(q.define(ids.angular_acceleration(body), across / arm))
    equation.step("acceleration-free", body, point, base)
    return True


# --- the whole of a point's acceleration ------------------------------------------------------------


def _whole(parts: Parts, point: str) -> None:
    """Enter the magnitude of an acceleration from its components: one, two at a right angle, or those along x and y."""
    derivation, q, vectors = parts.derivation, parts.derivation.q, parts.derivation.nonzero(*parts.of[point])
    a = ids.acceleration(point)
    if not vectors:
        q.give(a, 0.0)
        return
    whole = Projected(derivation, (), vectors)
    if len(vectors) == 1:
        whole.then(q.define(a, q[vectors[0].id]))
    elif len(vectors) == 2 and perpendicular(vectors[0].direction, vectors[1].direction):
        whole.then(q.define(a, sqrt(q[vectors[0].id] ** 2 + q[vectors[1].id] ** 2)))
    else:
        whole.find_sum("a", point)
    whole.step("acceleration-whole", GROUND, point)


# --- along the line of a moving body --------------------------------------------------------------


def by_slot(parts: Parts, joint: file.SlotJoint) -> bool:
    """Enter ε of a body from the acceleration of a point that slides along its line, or that acceleration from ε.

    Both sides are projected on the normal to the line, along which the relative acceleration is zero.
    """
    derivation, q, body, point = parts.derivation, parts.derivation.q, joint.on, joint.point
    base = _base_of_slot(parts, body, point)
    omega, eps, v_r = ids.angular_velocity(body), ids.angular_acceleration(body), ids.sliding_velocity(point)
    if not base or not (derivation.knows(omega) and derivation.knows(v_r)):
        return False
    u, motion = derivation.layout.geometry.direction(joint), derivation.motion
    arm = direction_of(derivation.layout.points[point] - derivation.layout.points[base])
    eps_known = derivation.knows(eps)
    path = known_path(parts, point, body) if eps_known and point not in parts.of else None
    if (point in parts.of) == eps_known or (eps_known and path is None) or not arm:
        return False
    if perpendicular(1j * arm, 1j * u) if path is None else parallel(path.unknown.direction, u):
        return False
    name = point + (base if parts.of[base] else "e")
    gliding = derivation.at(point) - derivation.at(point, body)
    along = motion.a(point) - motion.a(point, body) - 2j * motion.omega(body) * gliding
    normal, tangential = _turning(derivation, body, name, arm)
    coriolis = Vector(ids.acceleration(point, "k"), direction_of(2j * motion.omega(body) * gliding))
    sliding = Vector(ids.acceleration(point, "r"), direction_of(complex((u.conjugate() * along).real) * u))
    lines = () if path is None else path.lines
    length = derivation.length(base, point)
    if q.si(omega):
        lines += (q.define(normal.id, q[omega] ** 2 * length).id,)
        if q.si(v_r):
            lines += (q.define(coriolis.id, 2 * q[omega] * q[v_r]).id,)
    if eps_known and q.si(eps):
        lines += (q.define(tangential.id, q[eps] * length).id,)
    known = (*parts.of[base], *derivation.nonzero(normal, coriolis, *((tangential,) if eps_known else ())))
    if path is None:
        equation = Projected(derivation, parts.of[point], (*known, tangential, sliding), lines)
        size = equation.find(tangential, 1j * u, "η", point)
        equation.then(q.define(eps, size / length))
        equation.step("acceleration-slot", body, point, base)
    else:
        equation = Projected(derivation, (*path.known, path.unknown), (*known, sliding), lines)
        equation.find(path.unknown, 1j * u, "η", point)
        enter_end(parts, point, path, equation)
        equation.step("acceleration-slot-point", body, point, base)
    return True


def _base_of_slot(parts: Parts, body: int, point: str) -> str:
    """Return a point of a body with known acceleration, its pivot first, but not the sliding point."""
    centre = parts.derivation.layout.centres.get(body)
    if centre is not None and centre.rule == "pivot":
        return centre.name
    return next((name for name in parts.derivation.layout.own(body) if name in parts.of and name != point), "")
