"""Friction at both ends of a wide slider that tilts: values for templates and figures of its two face reactions.

Each of them leans from its normal by the angle of friction; their resultant does not, since the two normals are opposed
and the two forces of friction are not.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.drawing import Arc, Arrow, Item, Line, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import arrow, direction, fact
from reportgen.drawing.geometry import polar
from reportgen.drawing.labels import label
from reportgen.formula import Symbol, ids
from reportgen.friction.joints import friction_of, reactions_that_press, with_friction
from reportgen.machine import Joint
from reportgen.report.context import ReportContext
from reportgen.report.slider_faces import ends_of

DETAIL = 26.0
"""The length (mm) of the greatest force in a drawing of a guide."""


class FaceForce(Record):
    """The force of a guide (N) on an end of a slider's face: `across` the guide, and `along` it against the sliding.

    `number` is that of the end, 1 or 2; `at` is its place (m).
    """

    number: int
    across: complex
    along: complex
    at: complex


def face_forces(report: ReportContext, joint: Joint, k: int) -> tuple[FaceForce, ...]:
    """Return the two face forces on the joint's second link at position `k` (from 1); () if it does not tilt."""
    friction, solved, link = friction_of(report.machine), with_friction(report.analysis), joint.links[1]
    if friction is None or solved is None or joint.kind != "P" or link not in friction.faces:
        return ()
    motion = report.analysis.motion
    sizes = [float(end.real[k - 1]) for end in reactions_that_press(friction, joint, motion, solved.forces)]
    if not sizes[0] * sizes[1] < 0:
        return ()
    guide = complex(motion.slides[joint.links].direction[k - 1])
    name = ids.reaction_force(ids.joint(*joint.links))
    rubs = next(load for load in solved.loads if (load.name, load.link) == (name, link))
    per_newton = complex(rubs.force[k - 1]) / sum(map(abs, sizes))
    places = ends_of(report, link, k)
    return tuple(
        FaceForce(number, 1j * guide * size, per_newton * abs(size), at)
        for number, size, at in zip((1, 2), sizes, places, strict=True)
    )


def tilting(report: ReportContext, k: int) -> list[str]:
    """Return the link numbers, as text, of the wide sliders with friction that tilt at position `k`."""
    friction = friction_of(report.machine)
    assert friction is not None, "the chapter is there where joints rub"
    return [str(joint.links[1]) for joint in friction.joints(report.machine.linkage) if face_forces(report, joint, k)]


def any_tilts(report: ReportContext) -> bool:
    """Return True if a wide slider with friction tilts at any position."""
    friction = friction_of(report.machine)
    return friction is not None and report.has_forces and any(tilting(report, k) for k in report.all_positions)


# --- drawings of a guide ----------------------------------------------------------------------------


class Leaning(Record):
    """A force of a guide with its components across and along it (N), and its place (mm).

    `names` has the symbols of the normal force, the friction and the whole force, or of the whole force alone.
    """

    across: complex
    along: complex
    at: complex
    names: Sequence[Symbol]


def leaning_forces(guide: complex, forces: Sequence[Leaning], φ: Symbol, title: str) -> Scene:
    """Draw the forces of a guide at one scale, each with its components and its lean φ.

    `guide` is the unit vector of the sliding.
    """
    size = DETAIL / max(abs(force.across + force.along) for force in forces)
    reach = DETAIL / 2 + max(abs(force.at) for force in forces)
    drawing = Canvas((Line(-reach * guide, reach * guide, style.AXIS),))
    for force in forces:
        drawing += _leaning(force, size, φ)
    return finish(drawing, title=title)


def _leaning(force: Leaning, size: float, φ: Symbol) -> Canvas:
    N, F, at = force.across * size, force.along * size, force.at
    R, radius = N + F, abs(N + F) / 2
    start, stop = cmath.phase(N), cmath.phase(N) + cmath.phase(R / N)
    items: tuple[Item, ...] = (
        Arrow(at, at + N, style.ACTIVE, style.HEAD),
        Arrow(at + N, at + R, style.ACTIVE, style.HEAD),
        Arrow(at, at + R, style.REACTION, style.HEAD),
        Arc(at, radius, start, stop, style.DIMENSION, style.DIMENSION_HEAD),
    )
    *parts, whole = force.names
    names = [label((at + R, at + R * 0.8), whole), label(at + radius * polar((start + stop) / 2), φ)]
    facts = [arrow(whole, R), fact("angle", φ, direction(polar(abs(stop - start))))]
    if parts:
        normal, rubbing = parts
        names = [label((at + N, at + N * 0.8), normal), label(at + N + F / 2, rubbing), *names]
        facts = [arrow(normal, N), arrow(rubbing, F), *facts]
    return Canvas(items, tuple(names), tuple(facts))


def at_both_ends(named: Iterable[tuple[FaceForce, Symbol]], guide: complex, φ: Symbol, title: str) -> Scene:
    """Draw the two forces (N) on a slider that tilts, at the ends of its face, whose drawn length suits them.

    `guide` is the unit vector of the sliding.
    """
    faces = list(named)
    places = np.array([force.at for force, _ in faces])
    middle, half = places.mean(), abs(places[1] - places[0]) / 2
    forces = [
        Leaning(force.across, force.along, (force.at - middle) / half * DETAIL / 2, (name,)) for force, name in faces
    ]
    return leaning_forces(guide, forces, φ, title)
