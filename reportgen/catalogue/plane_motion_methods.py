"""By which methods the velocities of an exercise may be found, and why another one cannot apply to it.

What turns about a fixed point or is guided in translation needs no method.  Of a body in plane motion each method
needs something else to be known: that is seen from the joints and the given directions, before any number.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.plane_motion_centres import NEAR, Layout
from reportgen.plane_motion.ways import perpendicular


def why_not(method: file.Method, layout: Layout) -> str:
    """The code of the fault of a method that cannot apply; "" for one that can."""
    plane = [*_in_plane_motion(layout)]
    match method:
        case "moving frame":
            return "" if layout.given.slots else "no-moving-frame"
        case _ if not plane:
            return "no-plane-motion"
        case "instant centre":
            found = any(body in layout.centres or _across(layout, body) for body in plane)
            return "" if found else "no-directions"
        case "base point":
            told = any(_rolls(layout, body) or len(_guided(layout, body)) > 1 for body in plane)
            return "" if told or _two_bases(layout, plane) else "no-base-point"
        case "projection":
            # It tells no angular velocity.
            asked = any(one.what in ("v", "a") for one in layout.given.find)
            return "" if asked and any(_projects(layout, body) for body in plane) else "no-projection"


def _in_plane_motion(layout: Layout) -> Iterator[int]:
    for body in layout.members:
        if body not in layout.centres or not layout.centres[body].by_joint:
            yield body


def _rolls(layout: Layout, body: int) -> bool:
    return body in layout.centres and layout.centres[body].rule == "contact"


def _guided(layout: Layout, body: int) -> list[str]:
    """The points of a body that move along known lines."""
    given = {one.point for one in layout.given.given if isinstance(one, file.VelocityOf | file.FromRest)}
    return [name for name in layout.members[body] if name in layout.ways or name in given]


def _two_bases(layout: Layout, plane: list[int]) -> bool:
    """Whether two bodies that share a point have each another one that is guided."""
    for one, other in combinations(plane, 2):
        shared = {*layout.members[one]} & {*layout.members[other]}
        if shared and all({*_guided(layout, body)} - shared for body in (one, other)):
            return True
    return False


def _across(layout: Layout, body: int) -> bool:
    """Whether two points of a body move across the line between them: the centre lies on it."""
    for one, other in combinations(_guided(layout, body), 2):
        line = layout.points[other] - layout.points[one]
        if abs(line) > NEAR and all(perpendicular(layout.ways[name], line / abs(line)) for name in (one, other)):
            return True
    return False


def _projects(layout: Layout, body: int) -> bool:
    """Whether a body has two guided points of which one at least does not move across the line between them."""
    for one, other in combinations(_guided(layout, body), 2):
        line = layout.points[other] - layout.points[one]
        if abs(line) > NEAR and any(not perpendicular(layout.ways[name], line / abs(line)) for name in (one, other)):
            return True
    return False
