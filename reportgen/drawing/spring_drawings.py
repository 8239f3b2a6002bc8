"""Springs in the figures of a machine: a zigzag between two ends, a spiral about a pin."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.drawing import Circle, Item, Polyline, style
from reportgen.drawing.canvas import Canvas
from reportgen.drawing.drawing_description import Fact, PaperLength, direction, fact
from reportgen.drawing.geometry import polar, unit
from reportgen.drawing.labels import Request, label
from reportgen.formula import Symbol
from reportgen.machine import Linkage
from reportgen.machine.kinematics import Motion
from reportgen.machine.spring_geometry import Coil

LEAD, TEETH, SIDE = 0.18, 8, 1.7
"""Straight pieces at both ends (shares of the length), number of corners between them, and their offset (mm)."""
TURNS, INNER, OUTER = 2.25, style.JOINT, 5.6
"""Number of turns and radii (mm) of the spiral about a pin."""
PER_TURN = 24
"""Number of lines that draw a turn of the spiral."""
MOUNT = 4.6
"""Half the length of the ground at the end of a spring (mm), as wide as that below a pivot."""


def zigzag(start: Complexes, end: Complexes) -> list[Complexes]:
    """Return the corners of a zigzag spring between two ends [N] (mm), each corner [N] (mm).

    Its width is constant, and its coils separate as it is stretched.
    """
    along = end - start
    length = np.abs(along)
    across = 1j * SIDE * along / np.where(length > 0, length, 1.0)
    shares = (LEAD + (1 - 2 * LEAD) * (n + 0.5) / TEETH for n in range(TEETH))
    teeth = [start + share * along + (-1) ** n * across for n, share in enumerate(shares)]
    return [start, start + LEAD * along, *teeth, end - LEAD * along, end]


def spiral() -> Polyline:
    """Return a torsion spring about the origin (mm), which is attached to a link along +x."""
    rising = np.linspace(0.0, 1.0, round(TURNS * PER_TURN) + 1)
    places = (INNER + (OUTER - INNER) * rising) * np.exp(2j * math.pi * TURNS * (rising - 1))
    return Polyline((*map(complex, places),), style.VISIBLE)


def named(coil: Coil) -> Symbol:
    """Return the name of a spring in figures: the symbol of its stiffness."""
    return Symbol("c", str(coil.number))


def mounts(coil: Coil, linkage: Linkage, start: complex, end: complex, pivots: Collection[str]) -> list[Item]:
    """Return the ground, with a joint, at each end (mm) of a spring that is fixed to the frame and is not a pivot."""
    items: list[Item] = []
    for anchor, at, opposite in zip(coil.ends, (start, end), (end, start), strict=True):
        if not anchor.name or (anchor.name in linkage.ground and anchor.name not in pivots):
            along = -1j * unit(at - opposite) if at != opposite else 1.0
            items += style.ground(at - MOUNT * along, at + MOUNT * along, 1)
            items.append(Circle(at, style.POINT, style.VISIBLE, style.PAPER))
    return items


def coil_symbols(
    coils: Sequence[Coil], linkage: Linkage, motion: Motion, index: int, scale: float, pivots: Collection[str]
) -> Canvas:
    """Draw all springs at position `index`, `scale` mm of paper per m, with their names."""
    items: list[Item] = []
    requests: list[Request] = []
    facts: list[Fact] = []
    for coil in coils:
        start, end = (complex(place[index]) * scale for place in coil.at(motion))
        if coil.wound:
            towards = unit(end - start)
            wound = spiral()
            items.append(Polyline(tuple(start + point * towards for point in wound.points), style.VISIBLE))
            places = [start + OUTER * towards * polar(turn) for turn in (math.pi, 2.2, -2.2, 1.2, -1.2)]
            requests.append(label(places, named(coil)))
            facts.append(fact("torsion-spring", named(coil)))
            continue
        items += mounts(coil, linkage, start, end, pivots)
        corners = zigzag(np.array(start), np.array(end))
        items.append(Polyline(tuple(map(complex, corners)), style.VISIBLE))
        places = [start + share * (end - start) for share in (0.5, 0.4, 0.6, 0.3, 0.7)]
        across = float(np.angle(end - start)) + math.pi / 2
        requests.append(label(places, named(coil), prefer=(across, across + math.pi), gap=SIDE + 0.5))
        facts.append(fact("spring", named(coil), PaperLength(abs(end - start)), direction(end - start)))
    return Canvas(tuple(items), tuple(requests), tuple(facts))
