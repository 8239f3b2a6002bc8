"""Drawing of a machine with its counterweights: each is a disc on an arm from the centre that its link turns about."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.drawing import Circle, Content, Item, Line, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import Fact, PaperLength, direction, fact
from reportgen.drawing.labels import Request, label
from reportgen.drawing.scheme import Looks, driver_marks, mechanism, skeleton
from reportgen.machine import GROUND, Linkage
from reportgen.machine.kinematics import Motion

LARGEST, LEAST = 5.0, 2.0
"""Radii of discs (mm): of the heaviest counterweight, and the smallest one; areas are proportional to masses."""
ARM = 1.0
"""Half the width of an arm (mm)."""


class CounterweightDisc(Record):
    """A counterweight: its centre and the centre of its link (m), its mass (kg), its label."""

    at: complex
    pivot: complex
    mass: float
    label: Content


def with_discs(
    linkage: Linkage, motion: Motion, index: int, scale: float, looks: Looks, discs: Sequence[CounterweightDisc]
) -> Scene:
    """Draw the scheme at position `index` with counterweights; `scale` is in mm of paper per m."""
    bones = skeleton(linkage, motion, index, scale)
    heaviest = max(disc.mass for disc in discs)
    items: list[Item] = []
    requests: list[Request] = []
    facts: list[Fact] = []
    for disc in discs:
        radius = max(LARGEST * float(np.sqrt(disc.mass / heaviest)), LEAST)
        centre, pivot = disc.at * scale, disc.pivot * scale
        along = (centre - pivot) / abs(centre - pivot)
        end = centre - radius * along
        items += [Line(pivot + side, end + side, style.VISIBLE) for side in (1j * ARM * along, -1j * ARM * along)]
        items.append(Circle(centre, radius, style.VISIBLE, style.TINT))
        requests.append(label(centre, disc.label, gap=radius + 0.4))
        arm = centre - pivot
        facts.append(fact("counterweight", disc.label, PaperLength(abs(arm)), direction(arm)))
    whole = mechanism(bones, (GROUND, *linkage.links), looks) + driver_marks(linkage, motion, bones)
    return finish(Canvas(tuple(items), tuple(requests), tuple(facts)) + whole, notes=looks.notes)
