"""Drawings of a group of class III: its assembly by a template curve, and its special point."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from reportgen.base.arrays import Complexes
from reportgen.base.records import Record
from reportgen.drawing import Circle, Content, Item, Line, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import direction, fact
from reportgen.drawing.labels import label
from reportgen.drawing.scheme import Looks, driver_marks, mechanism, skeleton
from reportgen.formula import Symbol, vocabulary
from reportgen.machine import GROUND, Linkage
from reportgen.machine.kinematics import Motion

ARC = 60
"""Points of an arc."""
AROUND = math.radians(8)
"""Angle (rad) by which the arc of a joint goes on beyond the places that are drawn on it."""
BEYOND = 6.0
"""Length (mm) of the line of a leg beyond the special point."""


class TemplateCurve(Record):
    """Places on paper (mm) of the outer joints and of the joints of the plate as assembled.

    `trials` are the places of the plate's joints when the first two are on their arcs, one row each [3, N]; `path` is
    the curve of the third one through its trial places.
    """

    outer: Sequence[complex]
    inner: Sequence[complex]
    trials: Complexes
    path: Complexes


def template_curve(
    linkage: Linkage, motion: Motion, index: int, scale: float, curve: TemplateCurve, looks: Looks
) -> Scene:
    """Draw a group at position `index`, `scale` mm per m: its arcs and the numbered curve that cuts the third arc."""
    bones = skeleton(linkage, motion, index, scale)
    draft = mechanism(bones, (GROUND, *linkage.links), looks) + driver_marks(linkage, motion, bones)
    on_arcs = (*curve.trials[:2], curve.path)
    arcs = [
        Polyline(_arc(centre, joint, places), style.CONSTRUCTION)
        for centre, joint, places in zip(curve.outer, curve.inner, on_arcs, strict=True)
    ]
    items: list[Item] = [*arcs, Polyline(tuple(map(complex, curve.path)), style.PATH)]
    requests = []
    for number, places in enumerate(curve.trials.T, 1):
        first, second, third = map(complex, places)
        for at in (first, second, third):
            items.append(Circle(at, 0.45, style.THIN, style.PAPER))
        requests.append(label(third, Symbol(str(number)), gap=0.8, size=style.SMALL))
    whole = Canvas((*items, *draft.items), (*draft.requests, *requests), draft.says)
    return finish(whole, notes=looks.notes)


def special_point(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    special: tuple[str, complex],
    joints: tuple[Sequence[str], Sequence[str]],
    looks: Looks,
) -> Scene:
    """Draw the mechanism at position `index`, `scale` mm per m, with the special point of a group (name, place in mm).

    The first of the `joints` are those of the plate on the two lines that meet there, the second all that are measured.
    """
    bones = skeleton(linkage, motion, index, scale)
    draft = mechanism(bones, (GROUND, *linkage.links), looks) + driver_marks(linkage, motion, bones)
    name, at = special
    on_lines, measured = joints
    items: list[Item] = []
    for joint in measured:
        start = bones.points[joint]
        away = at - start
        beyond = BEYOND * away / abs(away) if joint in on_lines and abs(away) > style.JOINT else 0j
        items.append(Line(start, at + beyond, style.NORMAL if joint in on_lines else style.CONSTRUCTION))
    text: Content = vocabulary.point(name)
    mark = Circle(at, style.POINT, style.VISIBLE, style.PAPER)
    facts = tuple(fact("direction", vocabulary.point(joint), direction(at - bones.points[joint])) for joint in on_lines)
    whole = Canvas((*items, *draft.items, mark), (*draft.requests, label(at, text, gap=1.2)), (*draft.says, *facts))
    return finish(whole, notes=looks.notes)


def _arc(centre: complex, joint: complex, places: Complexes) -> tuple[complex, ...]:
    """Return an arc about a centre through a joint and along all places, and a little beyond."""
    turns = [0.0, *(cmath.phase((complex(place) - centre) / (joint - centre)) for place in places)]
    low, high = min(turns) - AROUND, max(turns) + AROUND
    steps = (low + (high - low) * n / ARC for n in range(ARC + 1))
    return tuple(centre + (joint - centre) * cmath.exp(1j * turn) for turn in steps)
