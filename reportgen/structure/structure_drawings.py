"""Drawing of a mechanism's structure: its links on a circle, a line for each pair, the groups by their pens."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping

from reportgen.drawing import Circle, Item, Label, Line, Pen, Scene, style
from reportgen.drawing.drawing_description import fact
from reportgen.formula import Number
from reportgen.structure.splitting import FRAME
from reportgen.structure.structure_solution import SolvedStructure

BESIDE = 15.0
"""Least distance between the centres of neighbouring links (mm)."""
LINK, POINT, MARGIN = 3.6, 0.9, 2.0
"""Radii of a link and of the point of a multiple joint, and white around the drawing (mm)."""
INWARD = 0.6
"""Place of the point of a multiple joint between the middle of the drawing (0) and that of its links (1)."""
GROUP_PENS = (
    Pen(0.5, style.BLUE),
    Pen(0.5, style.RED, style.DASHED),
    Pen(0.5, style.BLUE, style.CHAIN),
    Pen(0.5, style.RED),
)
PAIR = Pen(0.25)


def diagram(case: SolvedStructure) -> Scene:
    """Draw the links as circles, in the order of assembly from the frame at the bottom, and the pairs as lines.

    The lines of a multiple joint meet in a point. A group's circles have one pen; its inner pairs have it too.
    """
    order = [FRAME, case.given.driver, *(link for group in case.groups for link in group.links)]
    radius = max(BESIDE / 2 / math.sin(math.pi / len(order)), BESIDE)
    middle = complex(1, 1) * (radius + LINK + MARGIN)
    places = {
        link: middle + cmath.rect(radius, -math.pi / 2 - 2 * math.pi * k / len(order)) for k, link in enumerate(order)
    }
    pens: Mapping[int, Pen] = {
        link: GROUP_PENS[k % len(GROUP_PENS)] for k, group in enumerate(case.groups) for link in group.links
    }
    group_of = {link: group.links[0] for group in case.groups for link in group.links}
    lines, points = list[Item](), list[Item]()
    for joint in case.lower_chain.joints:
        ends = [places[link] for link in joint.links]
        first = joint.links[0]
        inside = first in group_of and len({group_of.get(link) for link in joint.links}) == 1
        pen = pens[first] if inside else PAIR
        if len(ends) == 2:
            lines.append(Line(ends[0], ends[1], pen))
        else:
            centre = middle + INWARD * (sum(ends) / len(ends) - middle)
            lines += [Line(end, centre, pen) for end in ends]
            points.append(Circle(centre, POINT, None, style.BLACK))
    circles = [Circle(at, LINK, pens.get(link, style.VISIBLE), "#ffffff") for link, at in places.items()]
    labels = [Label(at, Number(float(link)), "center", style.SMALL) for link, at in places.items()]
    size = 2 * middle.real
    facts = [fact("structure-chain", Number(float(len(order))), Number(float(case.lower_chain.lower_pairs)))]
    facts += [fact("structure-group", tuple(Number(float(link)) for link in group.links)) for group in case.groups]
    return Scene(size, size, (*lines, *points, *circles, *labels), margin=MARGIN, description=tuple(facts))
