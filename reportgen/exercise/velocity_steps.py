"""Steps that compute velocities: from a body with known rates over its points to the next body.

They use fixed points, instant centres, base points, projections, and the lines of moving bodies.  Each returns True if
it entered something.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import combinations, permutations

from reportgen.exercise import file
from reportgen.exercise.derivation import Derivation, Projected, Step, Vector, along, angle, size_of, towards
from reportgen.exercise.instant_centres import SAME_PLACE, InstantCentre
from reportgen.exercise.point_positions import direction_of, parallel, perpendicular
from reportgen.formula import Negative, Symbol, cos, ids, sin, sqrt, total


def enter_given(derivation: Derivation) -> None:
    """Enter the rates that the file gives."""
    for rate in derivation.layout.given.given:
        match rate:
            case file.OmegaOf(body=body, value=value):
                derivation.given(ids.angular_velocity(body), value.si)
            case file.VelocityOf(point=point, size=size) if size is not None:
                derivation.given(ids.velocity(point), size.si)
            case file.FromRest(point=point, acceleration=acceleration, time=time):
                a = derivation.given(ids.acceleration(point), acceleration.si)
                t = derivation.given("t", time.si)
                v = derivation.q.define(ids.velocity(point), a * t)
                derivation.steps.append(Step("from-rest", (v.id,), point=point))


def derive(derivation: Derivation) -> bool:
    """Enter the rate of one more body or the velocities of its points; return False if none follows."""
    known = _about(derivation, derivation.layout.centres.values()) or _by_belt(derivation)
    return known or by_parallels(derivation) or by_moving_frame(derivation)


def about_joints(derivation: Derivation) -> bool:
    """Enter the same for a body that a joint makes rotate about a fixed point or move in translation."""
    return _about(derivation, (centre for centre in derivation.layout.centres.values() if centre.by_joint)) or _by_belt(
        derivation
    )


def by_centre(derivation: Derivation) -> bool:
    """Enter the same for a body in plane motion, about its instant centre."""
    return _about(derivation, (one for one in derivation.layout.centres.values() if not one.by_joint)) or by_parallels(
        derivation
    )


def by_parallels(derivation: Derivation) -> bool:
    """Enter ω of one more body from two parallel velocities."""
    return any(_parallel(derivation, body, names) for body, names in derivation.layout.members.items())


def by_moving_frame(derivation: Derivation) -> bool:
    """Enter the velocity of one more point along a line of a moving body."""
    return _along_slots(derivation, derivation.layout.directions)


def by_guided_frame(derivation: Derivation) -> bool:
    """Enter the same if joints or data give the direction of the point, without instant centres."""
    return _along_slots(derivation, derivation.layout.guided)


def _along_slots(derivation: Derivation, directions: Mapping[str, complex]) -> bool:
    slots = derivation.layout.given.slots
    return any(_slot(derivation, joint, directions) for joint in slots) or enter_blocks(derivation, "omega")


def enter_blocks(derivation: Derivation, what: str) -> bool:
    """Enter the rotation of one more body that turns with its guide; `what` is omega or eps."""
    rate = ids.LINK_RATE[what]
    for joint in derivation.layout.given.joints:
        if isinstance(joint, file.Slider) and joint.on:
            for known, new in permutations((joint.body, joint.on)):
                if derivation.knows(rate(known)) and not derivation.knows(rate(new)):
                    same = derivation.q.define(rate(new), derivation.q[rate(known)])
                    derivation.steps.append(Step(f"block-{what}", (same.id,), new, frame=known))
                    return True
    return False


def _by_belt(derivation: Derivation) -> bool:
    """Enter ω of one more disc with a fixed centre whose rim moves as fast as the belt."""
    for index, ends in derivation.layout.belts.items():
        joint = derivation.layout.given.joints[index]
        if not (isinstance(joint, file.Belt) and derivation.layout.turn_on_ground(joint.discs)):
            continue
        for (base, _), (point, body) in permutations(zip(ends, joint.discs, strict=True)):
            if derivation.knows_velocity(base) and not derivation.knows_velocity(point):
                v = derivation.q.define(ids.velocity(point), derivation.q[ids.velocity(base)])
                derivation.steps.append(Step("belt", (v.id,), body, point, base))
                return True
    return False


def _about(derivation: Derivation, centres: Iterable[InstantCentre]) -> bool:
    for centre in centres:
        if centre.rule == "translation":
            if _translation(derivation, centre.body, centre):
                return True
        elif _rate(derivation, centre.body, centre) or _points(derivation, centre.body, centre):
            return True
    return False


def _translation(derivation: Derivation, body: int, centre: InstantCentre) -> bool:
    """Enter one velocity for all points of a body in translation."""
    q, names = derivation.q, derivation.layout.members[body]
    known = next((name for name in names if derivation.knows_velocity(name)), "")
    new = [name for name in names if known and not derivation.knows_velocity(name)]
    if not known or (not new and derivation.knows_omega(body)):
        return False
    if not derivation.knows_omega(body):
        q.give(ids.angular_velocity(body), 0.0)
    lines = tuple(q.define(ids.velocity(name), q[ids.velocity(known)]).id for name in new)
    if lines or centre.points:
        derivation.steps.append(Step("translation", lines, body, ", ".join(new), known))
    return True


def _rate(derivation: Derivation, body: int, centre: InstantCentre) -> bool:
    """Enter ω = v/l about the centre, from one velocity."""
    if derivation.knows_omega(body):
        return False
    names = derivation.layout.members[body]
    known = [
        name for name in names if derivation.knows_velocity(name) and not derivation.layout.is_centre(centre, name)
    ]
    if not known:
        return False
    arm = derivation.length(centre.name, known[0], centre.at)
    omega = derivation.q.define(ids.angular_velocity(body), derivation.q[ids.velocity(known[0])] / arm)
    derivation.steps.append(Step(f"rate-{centre.rule}", (arm.id, omega.id), body, known[0], centre.name))
    return True


def _points(derivation: Derivation, body: int, centre: InstantCentre) -> bool:
    """Enter v = ω l of every point about the centre; a point at the centre is at rest."""
    q, layout = derivation.q, derivation.layout
    new = [name for name in layout.members[body] if not derivation.knows_velocity(name)]
    if not new or not derivation.knows_omega(body):
        return False
    for name in new:
        if layout.is_centre(centre, name):
            q.give(ids.velocity(name), 0.0)
            if centre.rule == "normals":
                derivation.steps.append(Step("at-rest", (), body, name, centre.name))
        else:
            arm = derivation.length(centre.name, name, centre.at)
            v = q.define(ids.velocity(name), q[ids.angular_velocity(body)] * arm)
            derivation.steps.append(Step(f"speed-{centre.rule}", (arm.id, v.id), body, name, centre.name))
    return True


def is_across(derivation: Derivation, *names: str) -> bool:
    """Return True if points lie on one line and their velocities are all perpendicular to it."""
    points, directions = derivation.layout.points, derivation.layout.directions
    line = direction_of(points[names[1]] - points[names[0]])
    if not line or any(name not in directions for name in names):
        return False
    in_line = all(abs((line.conjugate() * (points[name] - points[names[0]])).imag) < SAME_PLACE for name in names)
    return in_line and all(perpendicular(directions[name], line) for name in names)


def _parallel(derivation: Derivation, body: int, names: list[str]) -> bool:
    """Enter ω from two velocities that are perpendicular to the line of their points."""
    q = derivation.q
    if body in derivation.layout.centres:
        return False
    known = [name for name in names if derivation.knows_velocity(name)]
    for base, tip in combinations(known, 2):
        if not is_across(derivation, base, tip):
            continue
        if not derivation.knows_omega(body):
            here, there = derivation.at(base), derivation.at(tip)
            faster, slower = (base, tip) if abs(here) >= abs(there) else (tip, base)
            v, w = q[ids.velocity(faster)], q[ids.velocity(slower)]
            same = (here.conjugate() * there).real >= 0
            omega = q.define(ids.angular_velocity(body), (v - w if same else v + w) / derivation.length(base, tip))
            derivation.steps.append(Step("rate-parallel", (omega.id,), body, base, tip))
            return True
    return False


# --- a point along the line of a moving body --------------------------------------------------------


def _slot(derivation: Derivation, joint: file.SlotJoint, directions: Mapping[str, complex]) -> bool:
    """Solve v_P = v_X + v_PX + v_r for a point P on a line of a body with a known point X, with two unknown magnitudes.

    `directions` are the directions of velocities that may be used.
    """
    body, point, q, layout = joint.on, joint.point, derivation.q, derivation.layout
    if derivation.knows(ids.sliding_velocity(point)):
        return False
    base = _base(derivation, body)
    if base is None or not (derivation.knows_velocity(point) or derivation.knows_omega(body)):
        return False
    u = layout.geometry.direction(joint)
    arm_way = layout.points[point] - layout.points[base]
    if abs(arm_way) < SAME_PLACE or (not derivation.knows_omega(body) and perpendicular(u, arm_way / abs(arm_way))):
        # As the body turns, its own point moves along the line, which gives no speed.
        return False
    known_rate, new = derivation.knows_omega(body), not derivation.knows_velocity(point)
    if new and (point not in directions or parallel(directions[point], u)):
        return False
    own = derivation.at(point, body)
    turning = Vector(ids.velocity(point + base), direction_of(own - derivation.at(base, body)))
    sliding = Vector(ids.sliding_velocity(point), direction_of(derivation.at(point) - own))
    bases, whole, arm = (
        derivation.nonzero(derivation.velocity(base)),
        derivation.velocity(point),
        derivation.length(base, point),
    )
    lines = (q.define(turning.id, q[ids.angular_velocity(body)] * arm).id,) if known_rate else ()
    equation = Projected(derivation, (whole,), (*bases, turning, sliding), lines)
    if new:
        equation.find(whole, 1j * u, "η", point)
    elif not known_rate:
        size = equation.find(turning, 1j * u, "η", point)
        equation.then(q.define(ids.angular_velocity(body), size / arm))
    symbol = Symbol("v", point, "r")
    if sliding.direction:
        equation.find(sliding, towards(u, arm_way), "ξ", point, symbol)
    else:
        q.give(sliding.id, 0.0, symbol)
    equation.step("slot-speed" if known_rate else "slot-rate", body, point, base)
    return True


def _base(derivation: Derivation, body: int) -> str | None:
    """Return a point of a body with known velocity: its pivot, or a point that another body carries; None
    without one.
    """
    centre = derivation.layout.centres.get(body)
    if centre is not None and centre.rule in ("pivot", "contact"):
        if not derivation.knows_velocity(centre.name):
            derivation.q.give(ids.velocity(centre.name), 0.0)
        return centre.name
    return next((name for name in derivation.layout.members[body] if derivation.knows_velocity(name)), None)


# --- by a base point ------------------------------------------------------------------------------


def by_base_point(derivation: Derivation) -> bool:
    """Enter v_M = v_A + v_MA of one more point of a body with known ω, or the rates of two such bodies."""
    bodies = {body: names for body, names in derivation.layout.members.items() if body not in derivation.layout.centres}
    for body, names in bodies.items():
        known = [name for name in names if derivation.knows_velocity(name)]
        # A base point that was itself computed by components is the last choice.
        base = min(known, key=lambda name: _by_components(derivation, name), default="")
        new = next((name for name in names if name not in known), "")
        if base and new and derivation.knows_omega(body) and _point(derivation, body, new, base):
            return True
    for body, names in bodies.items():
        for partner, others in bodies.items():
            shared = [name for name in names if name in others and not derivation.knows_velocity(name)]
            if body < partner and shared and _between(derivation, body, partner, shared[0]):
                return True
    return False


def _by_components(derivation: Derivation, point: str) -> bool:
    return any(derivation.knows(ids.velocity_component(point, axis)) for axis in "xy")


def from_base_point(derivation: Derivation) -> bool:
    """Enter ω of one more body in plane motion from a base point, or one more point of a body with known ω."""
    layout = derivation.layout
    for body, names in layout.members.items():
        centre = layout.centres.get(body)
        if centre is not None and centre.by_joint:
            continue
        if centre is not None and centre.rule == "contact" and not derivation.knows_velocity(centre.name):
            derivation.q.give(ids.velocity(centre.name), 0.0)
        known = [name for name in names if derivation.knows_velocity(name)]
        new = [name for name in names if not derivation.knows_velocity(name)]
        if derivation.knows_omega(body):
            moving = [name for name in known if derivation.q.si(ids.velocity(name))]
            if known and new and _point(derivation, body, new[0], (moving or known)[0]):
                return True
            continue
        for base in sorted(known, key=lambda name: derivation.q.si(ids.velocity(name)) == 0):
            guided = [name for name in new if name in layout.guided]
            if any(_rate_from_base(derivation, body, point, base) for point in (*known, *guided) if point != base):
                return True
    return False


def _rate_from_base(derivation: Derivation, body: int, point: str, base: str) -> bool:
    """Enter ω from v_B = v_A + v_BA, with v_B or its line known, by projection on AB and on the perpendicular to it."""
    q, layout = derivation.q, derivation.layout
    arm = layout.points[point] - layout.points[base]
    line, new = direction_of(arm), not derivation.knows_velocity(point)
    turn = derivation.motion.omega(body)
    direction = direction_of(derivation.at(point)) or layout.guided.get(point, 0j)
    if not line or (new and perpendicular(direction, line)):
        return False
    whole = Vector(ids.velocity(point), direction)
    relative = Vector(ids.velocity(point + base), 1j * line * (1 if turn >= 0 else -1))
    bases = derivation.nonzero(derivation.velocity(base))
    if not new and not bases and not q.si(whole.id):
        return False
    equation = Projected(derivation, (whole,), (*bases, relative))
    if new:
        equation.find(whole, line, "ξ", point)
    if turn:
        size = equation.find(relative, relative.direction, "η", point)
        equation.then(q.define(ids.angular_velocity(body), size / derivation.length(base, point)))
    else:
        q.give(ids.angular_velocity(body), 0.0)
    kind = "base-rate" if turn else "base-translation"
    equation.step(kind if new else "base-known", body, point, base)
    return True


def _relative(derivation: Derivation, body: int, point: str, base: str) -> Vector:
    arm = derivation.layout.points[point] - derivation.layout.points[base]
    return Vector(ids.velocity(point + base), direction_of(1j * derivation.motion.omega(body) * arm))


def _point(derivation: Derivation, body: int, point: str, base: str) -> bool:
    """Enter v_B = v_A + v_BA with v_A and ω known, by its components along x and y."""
    q, relative = derivation.q, _relative(derivation, body, point, base)
    lines: tuple[str, ...] = ()
    if not derivation.knows(relative.id):
        lines = (q.define(relative.id, q[ids.angular_velocity(body)] * derivation.length(base, point)).id,)
    parts = derivation.nonzero(derivation.velocity(base), relative)
    if not parts:
        q.give(ids.velocity(point), 0.0)
        return True
    equation = Projected(derivation, (derivation.velocity(point),), parts, lines)
    equation.find_sum("v", point)
    equation.step("base-point", body, point, base)
    return True


def _between(derivation: Derivation, body: int, partner: int, point: str) -> bool:
    """Solve v_A + v_CA = v_B + v_CB for two unknown magnitudes, the first by projection on the line CB."""
    q, members = derivation.q, derivation.layout.members
    bases = [next((n for n in members[one] if derivation.knows_velocity(n)), "") for one in (body, partner)]
    if "" in bases or derivation.knows_omega(body) or derivation.knows_omega(partner):
        return False
    first, second = (_relative(derivation, one, point, base) for one, base in zip((body, partner), bases, strict=True))
    line = direction_of(derivation.layout.points[point] - derivation.layout.points[bases[1]])
    if not (first.direction and second.direction) or abs((line.conjugate() * first.direction).real) < 1e-9:
        return False
    v_a, two = (derivation.nonzero(derivation.velocity(base)) for base in bases)
    equation = Projected(derivation, (*v_a, first), (*two, second))
    sizes = equation.find(first, line, "ξ", point), equation.find(second, second.direction, "η", point)
    for turning, size, base in zip((body, partner), sizes, bases, strict=True):
        equation.then(q.define(ids.angular_velocity(turning), size / derivation.length(base, point)))
    equation.step("two-bases", body, point, bases[0])
    return True


# --- by projection --------------------------------------------------------------------------------


def by_projection(derivation: Derivation) -> bool:
    """Enter one more velocity of a body in plane motion by the theorem of projections."""
    layout = derivation.layout
    for body, names in layout.members.items():
        if body in layout.centres and layout.centres[body].by_joint:
            continue
        known = [name for name in names if derivation.knows_velocity(name)]
        for point in names:
            if point not in known and (
                any(_on_one_line(derivation, body, point, base) for base in known)
                or any(_on_two_lines(derivation, body, point, *bases) for bases in combinations(known, 2))
            ):
                return True
    return False


def _on_one_line(derivation: Derivation, body: int, point: str, base: str) -> bool:
    """Enter v_B from v_B cos β = v_A cos α for a point B that moves along a known line, not across AB."""
    points, directions = derivation.layout.points, derivation.layout.guided
    line = direction_of(points[point] - points[base])
    if point not in directions or not line or perpendicular(directions[point], line):
        return False
    whole = Vector(ids.velocity(point), direction_of(derivation.at(point)) or directions[point])
    relative = Vector(ids.velocity(point + base), 1j * line)
    equation = Projected(derivation, (whole,), (derivation.velocity(base), relative))
    equation.find(whole, line, "ξ", point)
    equation.step("projection", body, point, base)
    return True


def _on_two_lines(derivation: Derivation, body: int, point: str, base_a: str, base_b: str) -> bool:
    """Enter v_M from its projections p on AM and BM, which equal those of v_A and v_B, if A, B, M are not in line.

    The lines enclose γ, and v_M² sin²γ = p_A² + p_B² − 2 p_A p_B cos γ.
    """
    q, points = derivation.q, derivation.layout.points
    u, w = (direction_of(points[point] - points[base]) for base in (base_a, base_b))
    if not u or not w or parallel(u, w):
        return False
    w = towards(w, u)
    sizes = [
        q.define(ids.velocity_projection(point, base + point), part)
        for base, axis in ((base_a, u), (base_b, w))
        if (part := along(q, derivation.velocity(base), axis)) is not None
    ]
    if not sizes:
        q.give(ids.velocity(point), 0.0)
        derivation.steps.append(Step("projection-nothing", (), body, point, base_a, second_base=base_b))
        return True
    whole = size_of(q, sizes)
    if not perpendicular(u, w):
        γ = angle(q, math.acos((u.conjugate() * w).real))
        if len(sizes) == 2:
            p, r = sizes
            whole = sqrt(total([p**2, r**2, Negative(2 * p * r * cos(γ))]))
        whole = whole / sin(γ)
    v = q.define(ids.velocity(point), whole)
    derivation.steps.append(
        Step("projections", (*(size.id for size in sizes), v.id), body, point, base_a, second_base=base_b)
    )
    return True
