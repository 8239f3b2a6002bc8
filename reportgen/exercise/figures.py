"""Figures of an exercise: the system to scale with velocities and instant centres, and with accelerations."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import nice_up
from reportgen.drawing import Arc, Arrow, Circle, Content, Item, Line, Pen, Scene, style
from reportgen.drawing.canvas import Canvas, finish, settle
from reportgen.drawing.drawing_description import Fact, PaperLength, alignment, arrow, direction, fact, listed, turning
from reportgen.drawing.geometry import bounds, clusters
from reportgen.drawing.labels import Request, joined, label
from reportgen.exercise import file
from reportgen.exercise.literal_solution import SolvedExercise
from reportgen.exercise.rate_conditions import GROUND
from reportgen.exercise.views import Axes, DrawnAxis
from reportgen.formula import Chain, Number, Symbol, ids, vocabulary

BOX = (105.0, 85.0)
"""Largest width and height of the system (mm)."""
LONGEST = 30.0
"""The longest arrow of a velocity or an acceleration (mm)."""
TOGETHER = 0.3
"""Points nearer than this (mm) share one label."""
GUIDE = 9.0
"""Half the length (mm) of the piece of a guide that is drawn, beside the block."""
WALL = 16.0
"""Half the length (mm) of the ground that a disc rolls on."""
BEYOND = 6.0
"""Length (mm) of a guide on a body beyond its points."""
CORNER, COORDINATE = 6.0, 9.0
"""Distance (mm) of the axes of the coordinates left of the drawing, and their length."""
BEFORE, AFTER = 5.0, 14.0
"""Lengths (mm) of an axis of projection beyond its points, backward and forward."""
AXIS_HEAD = 2.0
DRIVER_ARROW = 7.0
"""Radius (mm) of the arrow of an angular velocity."""
ARROWS_APART = 3.2
"""Between the arrows of several bodies about one point."""


# --- a system in mm, and its scene ----------------------------------------------------------------


class DrawnRail(Record):
    """A point guided along a direction; on the ground, its guide has walls and the block of a slider is drawn."""

    at: complex
    direction: complex
    on_ground: bool


class DrawnDisc(Record):
    centre: complex
    radius: float
    fixed: bool = False


class DrawnGround(Record):
    """Ground that a disc rolls on, at the point of contact; `out` points into the ground."""

    at: complex
    out: complex


class DrawnRotation(Record):
    """The arrow of a body's rotation about a point; `sense` is positive anticlockwise."""

    at: complex
    sense: float
    symbol: Content


class DrawnSystem(Record):
    """A system to draw, in mm of paper about any origin.

    `bodies` are the outlines by the points of each; `joints` and `pivots` are names of points, other points are dots.
    `normals` are lines from points to instant centres, `vectors` arrows by their starting points, `axes` the axes that
    the solution projects on; with `coordinates`, x and y are drawn beside the system.
    """

    points: Mapping[str, complex]
    bodies: Mapping[int, Sequence[complex]]
    discs: Sequence[DrawnDisc] = ()
    pivots: Sequence[str] = ()
    joints: Sequence[str] = ()
    rails: Sequence[DrawnRail] = ()
    slots: Sequence[tuple[complex, complex]] = ()
    """Lines on bodies along which points slide."""
    cords: Sequence[tuple[complex, complex]] = ()
    """Taut cords, and the straight parts of belts."""
    grounds: Sequence[DrawnGround] = ()
    normals: Sequence[tuple[complex, complex]] = ()
    vectors: Sequence[tuple[complex, complex, Content]] = ()
    rotations: Sequence[DrawnRotation] = ()
    axes: Sequence[DrawnAxis] = ()
    coordinates: bool = False
    pen: Pen = style.ACTIVE


def scene_of(drawn: DrawnSystem, notes: Sequence[Content] = ()) -> Scene:
    """Return the scene of a system, with `notes`, such as scales, below it."""
    items: list[Item] = []
    for ground in drawn.grounds:
        along = 1j * ground.out * WALL
        items += style.ground(ground.at + along, ground.at - along, 1)
    items += [Circle(disc.centre, disc.radius, style.THIN if disc.fixed else style.VISIBLE) for disc in drawn.discs]
    items += [Line(start, end, style.HEAVY) for start, end in drawn.slots]
    items += [Line(start, end, style.VISIBLE) for start, end in drawn.cords]
    for rail in drawn.rails:
        on = rail.direction * GUIDE
        if rail.on_ground:
            items += style.guide(rail.at - on / 2, rail.at + on / 2, style.BLOCK)
        size = style.BLOCK if rail.on_ground else style.SMALL_BLOCK
        items.append(style.block(rail.at, cmath.phase(rail.direction), size))
    for points in drawn.bodies.values():
        items += style.body(points)
    items += [Line(start, end, style.NORMAL) for start, end in drawn.normals]
    for axis in drawn.axes:
        tip = axis.end + AFTER * axis.direction
        name = axis.symbol.base + axis.symbol.sub
        items.append(Arrow(axis.start - BEFORE * axis.direction, tip, style.PROJECTION, AXIS_HEAD, name))
    for name, at in drawn.points.items():
        if name in drawn.pivots:
            items += style.pivot(at)
        else:
            items.append(style.joint(at) if name in drawn.joints else style.point(at))
    requests = _names(drawn.points)
    for start, end, symbol in drawn.vectors:
        items.append(Arrow(start, end, drawn.pen, style.HEAD))
        angle = cmath.phase(end - start)
        on_it = [start + (end - start) * share for share in (1.0, 0.7, 0.5)]
        requests.append(label(on_it, symbol, prefer=(angle + cmath.pi / 2, angle - cmath.pi / 2), gap=0.8))
    for axis in drawn.axes:
        tip, across = axis.end + AFTER * axis.direction, cmath.phase(1j * axis.direction)
        places = tip, tip - 2 * axis.direction
        requests.append(label(places, axis.symbol, prefer=(across, across + cmath.pi), gap=0.8))
    for index, rotation in enumerate(drawn.rotations):
        start = 0.6 if rotation.sense > 0 else 2.5
        stop = start + rotation.sense * 1.9
        inner = sum(abs(other.at - rotation.at) < TOGETHER for other in drawn.rotations[:index])
        radius = DRIVER_ARROW + inner * ARROWS_APART
        items.append(Arc(rotation.at, radius, start, stop, Pen(0.25), style.HEAD))
        ends = [rotation.at + radius * cmath.exp(1j * (start + (stop - start) * share)) for share in (0.5, 0.8, 0.2)]
        requests.append(label(ends, rotation.symbol, prefer=((start + stop) / 2,)))
    draft = settle(Canvas(tuple(items), tuple(requests), tuple(system_facts(drawn))))
    if drawn.coordinates:
        draft += _coordinates(draft)
    return finish(draft, notes=notes)


def system_facts(drawn: DrawnSystem) -> Iterator[Fact]:
    """Yield the facts of a system for its description: bodies, discs, pivots, guides, vectors and senses of
    rotation.
    """
    names = {at: vocabulary.point(name) for name, at in drawn.points.items()}
    for number, points in drawn.bodies.items():
        for end in points[1:]:
            bar = end - points[0]
            called = (names.get(at, "") for at in (points[0], end))
            yield fact("bar", str(number), *called, PaperLength(abs(bar)), direction(bar))
    for disc in drawn.discs:
        yield fact("disc", names.get(disc.centre, ""), PaperLength(disc.radius))
    for rail in drawn.rails:
        phrase = "guide" if rail.on_ground else "block"
        yield fact(phrase, names.get(rail.at, ""), alignment(rail.direction))
    if drawn.pivots:
        yield fact("pivots", listed(map(vocabulary.point, drawn.pivots)))
    for start, end, symbol in drawn.vectors:
        yield arrow(symbol, end - start)
    for rotation in drawn.rotations:
        yield turning(rotation.symbol, rotation.sense)


def _coordinates(draft: Canvas) -> Canvas:
    """Return the coordinate axes, at the lower left corner of a drawing."""
    low, _ = bounds(draft.items)
    corner = low - CORNER - COORDINATE
    ends = {"x": corner + COORDINATE, "y": corner + 1j * COORDINATE}
    arrows = (Arrow(corner, end, style.PROJECTION, AXIS_HEAD, letter) for letter, end in ends.items())
    names = (label(end, Symbol(letter), prefer=(cmath.phase(end - corner),)) for letter, end in ends.items())
    return Canvas((*arrows,), (*names,))


def _names(points: Mapping[str, complex]) -> list[Request]:
    """Return the labels of points; points that coincide share one."""
    return [
        label(points[group[0]], *joined(map(vocabulary.point, group), " ≡ "), gap=style.JOINT + 0.5)
        for group in clusters(list(points), TOGETHER, points.__getitem__)
    ]


# --- contents of the figures of an exercise ------------------------------------------------------------


def system_figure(case: SolvedExercise, enlarged: float = 1.0) -> tuple[Scene, Chain | None] | None:
    """Return the system without rates, with its scale multiplied by `enlarged`; None if there is nothing to draw."""
    return _draw(case, enlarged, {}, "", {}, [])


def velocity_figure(case: SolvedExercise, enlarged: float = 1.0) -> tuple[Scene, Chain | None] | None:
    """Return the system with velocities and the normals through instant centres, by a factor `enlarged`."""
    motion, layout = case.exercise.motion, case.worked.layout
    vectors = {
        name: (motion.v(name), vocabulary.symbol(id))
        for name in motion.system.points
        if (id := ids.velocity(name)) in case.worked.ledger and motion.v(name)
    }
    if not vectors:
        return None
    centres = [centre for centre in layout.centres.values() if centre.rule in ("normals", "rate")]
    bodies = {step.body for step in case.worked.steps}
    centres = [centre for centre in centres if centre.body in bodies]
    contacts = {step.point for step in case.worked.steps} - set(motion.system.points)
    extra = {name: at for name, at in layout.points.items() if name in contacts}
    extra |= {centre.name: centre.at for centre in centres}
    normals = [(layout.points[name], centre.at) for centre in centres for name in centre.points]
    return _draw(case, enlarged, vectors, "v", extra, normals)


def acceleration_figure(case: SolvedExercise, enlarged: float = 1.0) -> tuple[Scene, Chain | None] | None:
    """Return the system with the accelerations that are asked for or used, by a factor `enlarged`; None if there are
    none.
    """
    motion, ledger = case.exercise.motion, case.worked.ledger
    # A component of an acceleration belongs to its first point: a.BA.n to B.
    used = {ids.points(found["point"])[0] for found in map(ids.acceleration.read, ledger.families) if found}
    names = [name for name in motion.system.points if name in used]
    known = [name for name in names if motion.system.body_of(name) and motion.knows_acceleration(name)]
    vectors = {name: (motion.a(name), Symbol("a", name)) for name in known if motion.a(name)}
    return _draw(case, enlarged, vectors, "a", {}, []) if vectors else None


def _draw(
    case: SolvedExercise,
    enlarged: float,
    vectors: dict[str, tuple[complex, Symbol]],
    what: str,
    extra: dict[str, complex],
    normals: list[tuple[complex, complex]],
) -> tuple[Scene, Chain | None]:
    """Return the system in mm, with vectors to the scale that is printed below.

    Scales are those of the drawing after enlargement by `enlarged`, as on a drawing sheet.
    """
    exercise = case.exercise
    system, given = exercise.motion.system, exercise.given
    projections = Axes((case.worked, *case.further))
    true = _scale(case, [*extra.values()])
    scale = true / enlarged
    points = {name: at * scale for name, at in {**system.points, **extra}.items()}
    per_mm = nice_up(max((abs(vector) for vector, _ in vectors.values()), default=1.0) / LONGEST)
    arrows = [
        (points[name], points[name] + vector / per_mm / enlarged, vocabulary.vector(symbol))
        for name, (vector, symbol) in vectors.items()
    ]
    discs = [
        DrawnDisc(points[body.disc.centre], body.disc.radius.si * scale, number == GROUND)
        for number, body in given.bodies.items()
        if body.disc is not None
    ]
    pins = [joint for joint in given.joints if isinstance(joint, file.Pin)]
    rods = {body: names for body, names in system.bodies.items() if given.disc(body) is None}
    drawn = DrawnSystem(
        points=points,
        bodies={body: [points[name] for name in names] for body, names in rods.items()},
        discs=discs,
        pivots=[joint.at for joint in pins if GROUND in joint.bodies],
        joints=[joint.at for joint in pins if GROUND not in joint.bodies],
        rails=[*_rails(case, points, scale)],
        slots=[*_slots(case, points), *((at - WALL * u, at + WALL * u) for at, u in _racks(case, scale))],
        cords=[*_cords(case, points, scale)],
        grounds=[*_grounds(case, scale)],
        normals=[(start * scale, end * scale) for start, end in normals],
        vectors=arrows,
        rotations=[*_rotations(case, points)] if what == "v" else [],
        axes=[*projections.drawn(what == "a", scale)] if what else [],
        coordinates=what != "" and projections.has_coordinates(what == "a"),
        pen=style.ACTIVE if what == "v" else style.REACTION,
    )
    unit = "m/(s·mm)" if what == "v" else "m/(s²·mm)"
    length = Chain((Symbol("μ", "l"), Number(float(f"{1 / true:.6g}"), None, "m/mm")))
    note = Chain((Symbol("μ", what), Number(float(f"{per_mm:.6g}"), None, unit))) if vectors else None
    return scene_of(drawn, (length,)), note


def _scale(case: SolvedExercise, extra: list[complex]) -> float:
    """Return a round scale (mm of paper per m); points farther away than twice the size of the system do not count."""
    system = case.exercise.motion.system
    places = np.array([*system.points.values(), *extra])
    for body in case.exercise.given.bodies.values():
        if body.disc is not None:
            rim = body.disc.radius.si * np.exp(0.5j * np.pi * np.arange(4))
            places = np.append(places, system.points[body.disc.centre] + rim)
    needed = max(float(np.ptp(places.real)) / BOX[0], float(np.ptp(places.imag)) / BOX[1], 1e-6)
    return 1 / nice_up(needed)


def _racks(case: SolvedExercise, scale: float) -> Iterator[tuple[complex, complex]]:
    """Yield the places where discs roll on lines of moving bodies, with the directions of the lines."""
    layout = case.worked.layout
    for index, joint in enumerate(case.exercise.given.joints):
        if isinstance(joint, file.RollingOnLine) and joint.on != GROUND:
            yield layout.points[layout.contacts[index]] * scale, layout.geometry.direction(joint)


def _rails(case: SolvedExercise, points: dict[str, complex], scale: float) -> Iterator[DrawnRail]:
    given, system = case.exercise.given, case.exercise.motion.system
    racks = [*_racks(case, scale)]
    for joint in given.joints:
        if isinstance(joint, file.SlotJoint):
            yield DrawnRail(points[joint.point], case.worked.layout.geometry.direction(joint), joint.on == GROUND)
        elif isinstance(joint, file.Slider):
            first = system.bodies[joint.body][0]
            # A rack is drawn as the line that a disc rolls along.
            if any(abs(points[first] - at) < TOGETHER for at, _ in racks):
                continue
            yield DrawnRail(points[first], case.worked.layout.geometry.direction(joint), joint.on == GROUND)


def _slots(case: SolvedExercise, points: dict[str, complex]) -> Iterator[tuple[complex, complex]]:
    """Yield the lines of moving bodies along which points slide, extended beyond the block, and arms to points beside
    them.
    """
    given, system = case.exercise.given, case.exercise.motion.system
    for joint in given.slots:
        u, at = case.worked.layout.geometry.direction(joint), points[joint.point]
        along = [0.0, *((u.conjugate() * (points[name] - at)).real for name in system.bodies[joint.on])]
        yield at + (min(along) - BEYOND) * u, at + (max(along) + BEYOND) * u
        beside = (points[name] for name in system.bodies[joint.on])
        far = next((one for one in beside if abs((u.conjugate() * (one - at)).imag) > TOGETHER), None)
        if far is not None:
            yield at + (u.conjugate() * (far - at)).real * u, far


def _cords(case: SolvedExercise, points: dict[str, complex], scale: float) -> Iterator[tuple[complex, complex]]:
    """Yield the cords, and both straight parts of each belt, mirrored in its line of centres."""
    given, layout = case.exercise.given, case.worked.layout
    for index, joint in enumerate(given.joints):
        if isinstance(joint, file.Cord):
            yield points[joint.points[0]], points[joint.points[1]]
        elif isinstance(joint, file.Belt):
            first, second = (points[disc.centre] for disc in map(given.disc, joint.discs) if disc is not None)
            line = (second - first) / abs(second - first)
            start, end = (layout.points[name] * scale for name in layout.belts[index])
            yield start, end
            mirrored = [first + line * ((at - first) / line).conjugate() for at in (start, end)]
            yield mirrored[0], mirrored[1]


def _grounds(case: SolvedExercise, scale: float) -> Iterator[DrawnGround]:
    """Yield the ground below discs that roll on it."""
    given, layout = case.exercise.given, case.worked.layout
    for joint in given.joints:
        if isinstance(joint, file.RollingOnLine) and joint.on == GROUND:
            disc, centre = given.disc(joint.disc), layout.centres[joint.disc]
            if disc is not None:
                out = centre.at - layout.points[disc.centre]
                yield DrawnGround(centre.at * scale, out / abs(out))


def _rotations(case: SolvedExercise, points: dict[str, complex]) -> Iterator[DrawnRotation]:
    """Yield the arrow of each angular velocity at a pivot."""
    motion = case.exercise.motion
    for body, centre in case.worked.layout.centres.items():
        id = ids.angular_velocity(body)
        if centre.rule == "pivot" and motion.omega(body) and id in case.worked.ledger:
            sense = math.copysign(1.0, motion.omega(body))
            yield DrawnRotation(points[centre.name], sense, vocabulary.symbol(id))


FIGURES = {"system": system_figure, "velocity": velocity_figure, "acceleration": acceleration_figure}
"""Functions that draw the figures, by the names of their captions."""
