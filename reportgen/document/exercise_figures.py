"""The figures of an exercise: the system to scale with its velocities and centres, and with its accelerations."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from reportgen.case import ExerciseCase
from reportgen.catalogue import plane_motion_file as file
from reportgen.document.exercise_axes import Axes
from reportgen.figures import instant, style
from reportgen.figures.scene import Scene
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Chain, Number, Symbol
from reportgen.notation.numbers import nice_up
from reportgen.plane_motion.conditions import GROUND

BOX = (105.0, 85.0)
"""What the system may fill at most (mm)."""
LONGEST = 30.0
"""The longest arrow of a velocity or an acceleration (mm)."""
MM = 1e3


def system_figure(case: ExerciseCase) -> tuple[Scene, Chain | None] | None:
    """The system alone, with no rates on it."""
    return _draw(case, {}, "", {}, [])


def velocity_figure(case: ExerciseCase) -> tuple[Scene, Chain | None] | None:
    """The system with the velocities of its points and the normals through the instant centres."""
    motion, layout = case.exercise.motion, case.worked.layout
    shown = [name for name in motion.system.points if f"v.{name}" in case.worked.ledger and motion.v(name)]
    centres = [one for one in layout.centres.values() if one.rule in ("normals", "rate")]
    bodies = {step.body for step in case.worked.steps}
    centres = [one for one in centres if one.body in bodies]
    vectors = {name: (motion.v(name), vocabulary.symbol(f"v.{name}")) for name in shown}
    if not vectors:
        return None
    contacts = {step.point for step in case.worked.steps} - set(motion.system.points)
    extra = {name: at for name, at in layout.points.items() if name in contacts}
    extra |= {one.name: one.at for one in centres}
    normals = [(layout.points[name], one.at) for one in centres for name in one.points]
    return _draw(case, vectors, "v", extra, normals)


def acceleration_figure(case: ExerciseCase) -> tuple[Scene, Chain | None] | None:
    """The system with the accelerations that are asked or used; None where there are none."""
    motion, ledger = case.exercise.motion, case.worked.ledger
    names = [name for name in motion.system.points if any(id.startswith(f"a.{name}") for id in ledger.families)]
    known = [name for name in names if motion.system.body_of(name) and motion.knows_acceleration(name)]
    vectors = {name: (motion.a(name), Symbol("a", name)) for name in known if motion.a(name)}
    return _draw(case, vectors, "a", {}, []) if vectors else None


def _draw(
    case: ExerciseCase,
    vectors: dict[str, tuple[complex, Symbol]],
    what: str,
    extra: dict[str, complex],
    normals: list[tuple[complex, complex]],
) -> tuple[Scene, Chain | None]:
    """The system in mm; vectors are to the scale that is printed below."""
    exercise = case.exercise
    system, given = exercise.motion.system, exercise.given
    projections = Axes((case.worked, *case.further))
    scale = _scale(case, [*extra.values()])
    points = {name: at * scale for name, at in {**system.points, **extra}.items()}
    per_mm = nice_up(max((abs(vector) for vector, _ in vectors.values()), default=1.0) / LONGEST)
    arrows = [
        (points[name], points[name] + vector / per_mm, vocabulary.vector(symbol))
        for name, (vector, symbol) in vectors.items()
    ]
    discs = [
        instant.Disc(points[body.disc.centre], body.disc.radius.si * scale, number == GROUND)
        for number, body in given.bodies.items()
        if body.disc is not None
    ]
    pins = [joint for joint in given.joints if isinstance(joint, file.Pin)]
    drawn = instant.Drawn(
        points,
        {body: [points[name] for name in names] for body, names in system.bodies.items() if given.disc(body) is None},
        discs,
        [joint.at for joint in pins if GROUND in joint.bodies],
        [joint.at for joint in pins if GROUND not in joint.bodies],
        [*_rails(case, points, scale)],
        [*_slots(case, points), *((at - instant.WALL * u, at + instant.WALL * u) for at, u in _racks(case, scale))],
        [*_cords(case, points, scale)],
        [*_grounds(case, scale)],
        [(start * scale, end * scale) for start, end in normals],
        arrows,
        [*_rotations(case, points)] if what == "v" else [],
        [*projections.drawn(what == "a", scale)] if what else [],
        what != "" and projections.has_coordinates(what == "a"),
        style.ACTIVE if what == "v" else style.REACTION,
    )
    unit = "m/(s·mm)" if what == "v" else "m/(s²·mm)"
    length = Chain((Symbol("μ", "l"), Number(float(f"{1 / scale:.6g}"), None, "m/mm")))
    note = Chain((Symbol("μ", what), Number(float(f"{per_mm:.6g}"), None, unit))) if vectors else None
    return instant.instant(drawn, (length,)), note


def _scale(case: ExerciseCase, extra: list[complex]) -> float:
    """mm of paper for a metre, round: what is farther apart than twice the system itself does not count."""
    system = case.exercise.motion.system
    places = np.array([*system.points.values(), *extra])
    for body in case.exercise.given.bodies.values():
        if body.disc is not None:
            rim = body.disc.radius.si * np.exp(0.5j * np.pi * np.arange(4))
            places = np.append(places, system.points[body.disc.centre] + rim)
    needed = max(float(np.ptp(places.real)) / BOX[0], float(np.ptp(places.imag)) / BOX[1], 1e-6)
    return 1 / nice_up(needed)


def _racks(case: ExerciseCase, scale: float) -> Iterator[tuple[complex, complex]]:
    """Where discs roll on lines of moving bodies, with the directions of the lines."""
    layout = case.worked.layout
    for index, joint in enumerate(case.exercise.given.joints):
        if isinstance(joint, file.RollingOnLine) and joint.on != GROUND:
            yield layout.points[layout.contacts[index]] * scale, layout.geometry.direction(joint)


def _rails(case: ExerciseCase, points: dict[str, complex], scale: float) -> Iterator[instant.Rail]:
    given, system = case.exercise.given, case.exercise.motion.system
    racks = [*_racks(case, scale)]
    for joint in given.joints:
        if isinstance(joint, file.SlotJoint):
            yield instant.Rail(points[joint.point], case.worked.layout.geometry.direction(joint), joint.on == GROUND)
        elif isinstance(joint, file.Slider):
            first = system.bodies[joint.body][0]
            # A rack is drawn as the line that a disc rolls along.
            if any(abs(points[first] - at) < instant.TOGETHER for at, _ in racks):
                continue
            yield instant.Rail(points[first], case.worked.layout.geometry.direction(joint), joint.on == GROUND)


def _slots(case: ExerciseCase, points: dict[str, complex]) -> Iterator[tuple[complex, complex]]:
    """The lines of moving bodies along which points slide, on to beyond the block, with an arm to a point beside."""
    given, system = case.exercise.given, case.exercise.motion.system
    for joint in given.slots:
        u, at = case.worked.layout.geometry.direction(joint), points[joint.point]
        along = [0.0, *((u.conjugate() * (points[name] - at)).real for name in system.bodies[joint.on])]
        yield at + (min(along) - instant.BEYOND) * u, at + (max(along) + instant.BEYOND) * u
        beside = (points[name] for name in system.bodies[joint.on])
        far = next((one for one in beside if abs((u.conjugate() * (one - at)).imag) > instant.TOGETHER), None)
        if far is not None:
            yield at + (u.conjugate() * (far - at)).real * u, far


def _cords(case: ExerciseCase, points: dict[str, complex], scale: float) -> Iterator[tuple[complex, complex]]:
    """Cords, and both straight parts of each belt, mirrored in the line of its centres."""
    given, layout = case.exercise.given, case.worked.layout
    for index, joint in enumerate(given.joints):
        if isinstance(joint, file.Cord):
            yield points[joint.points[0]], points[joint.points[1]]
        elif isinstance(joint, file.Belt):
            first, second = (points[disc.centre] for disc in map(given.disc, joint.discs) if disc is not None)
            way = (second - first) / abs(second - first)
            start, end = (layout.points[name] * scale for name in layout.belts[index])
            yield start, end
            mirrored = [first + way * ((at - first) / way).conjugate() for at in (start, end)]
            yield mirrored[0], mirrored[1]


def _grounds(case: ExerciseCase, scale: float) -> Iterator[instant.Ground]:
    """The ground below discs that roll on a line of it."""
    given, layout = case.exercise.given, case.worked.layout
    for joint in given.joints:
        if isinstance(joint, file.RollingOnLine) and joint.on == GROUND:
            disc, centre = given.disc(joint.disc), layout.centres[joint.disc]
            if disc is not None:
                out = centre.at - layout.points[disc.centre]
                yield instant.Ground(centre.at * scale, out / abs(out))


def _rotations(case: ExerciseCase, points: dict[str, complex]) -> Iterator[instant.Rotation]:
    """The arrow of each angular velocity at a pivot."""
    motion = case.exercise.motion
    for body, centre in case.worked.layout.centres.items():
        if centre.rule == "pivot" and motion.omega(body) and f"omega.{body}" in case.worked.ledger:
            sense = math.copysign(1.0, motion.omega(body))
            yield instant.Rotation(points[centre.name], sense, Symbol("ω", str(body)))


FIGURES = {"system": system_figure, "velocity": velocity_figure, "acceleration": acceleration_figure}
"""The figures by the names of their captions."""
