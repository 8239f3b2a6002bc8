"""A planar mechanism as data: ground, a driver, and Assur dyads in the order of their assembly.

Link 0 is the ground and link 1 the driver.  Every moving link has a frame: its origin at the link's
first named point, its real axis towards the second.  A point on a link is a complex number in that
frame.  Everything here is plain frozen data; `motion` and `forces` compute.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

DyadKind = Literal["RRR", "RRP", "RPR", "PRP", "RPP"]

GROUND = 0
DRIVER = 1


@dataclass(frozen=True, slots=True)
class Guide:
    """A straight guide fixed in the frame of `link`: a line through `at` in direction `angle` (radians)."""

    at: complex
    angle: float
    link: int = GROUND


@dataclass(frozen=True, slots=True)
class Crank:
    """The rotating driver: link 1 turns about the ground point `centre`; its frame points to `pin`."""

    centre: str
    pin: str
    length: float


@dataclass(frozen=True, slots=True)
class SlidingDriver:
    """The sliding driver: link 1 moves along `guide`, its `pin` at the guide's `at` plus s·e^{i angle}."""

    pin: str
    guide: Guide


@dataclass(frozen=True, slots=True)
class LinkPoint:
    """A named point fixed in a moving link's frame (mass centre, coupler point, pin of a later dyad)."""

    name: str
    link: int
    local: complex


@dataclass(frozen=True, slots=True)
class Dyad:
    """An Assur group of class II: links i, j = `links`, two outer joints and the inner joint `middle`.

    ==== ============ ============== ============ ==============================================
    kind `start` (i)  inner joint    `end` (j)    geometry
    ==== ============ ============== ============ ==============================================
    RRR  point P      revolute Q     point T      `lengths` = (|PQ|, |TQ|)
    RRP  point P      revolute Q     guide        `lengths` = (|PQ|, 0); Q runs on the guide line
    RPR  point P      slide on j     point T      `lengths` = (0, e): P runs on the line of link j
                                                  that is parallel to its axis at distance e to the
                                                  left of T; `middle` names P as a point of link j
    PRP  guide        revolute Q     guide        Q runs on both guide lines
    RPP  point P      slide i on j   guide        `middle` names the point Q of link j that runs on
                                                  the guide; P runs on the line of link j through Q
                                                  turned by `slide_angle` from the guide
    ==== ============ ============== ============ ==============================================

    `start` and `end` name a point that already moves or stands (a revolute joint there), or give a
    `Guide` on ground or on a link already placed.  `sign` (+1, -1) is the stored orientation:
    RRR: Q to the left (+1) or right of the way from P to T; RRP: Q the farther (+1) or nearer of the
    two meeting points along the guide's direction; RPR: link j's axis points from T to the foot of P
    (+1) or away from it (-1); PRP and RPP assemble one way only and ignore it.

    Frames.  RRR: i at P towards Q, j at T towards Q.  RRP: i at P towards Q, j at Q with the guide's
    angle.  RPR: i at P and j at T, both with the angle of the line on j.  PRP: i and j at Q, each with
    its own guide's angle.  RPP: i at P, j at Q, both with the guide's angle.
    """

    kind: DyadKind
    links: tuple[int, int]
    start: str | Guide
    middle: str
    end: str | Guide
    lengths: tuple[float, float] = (0.0, 0.0)
    sign: int = 1
    slide_angle: float = 0.0


@dataclass(frozen=True, slots=True)
class Inertia:
    """Mass, mass centre (a named point of the link) and moment of inertia about it; kg, kg·m²."""

    link: int
    centre: str
    mass: float
    moment: float = 0.0


@dataclass(frozen=True, slots=True)
class Linkage:
    """A whole mechanism.

    `ground` gives the fixed points; `points` further points on moving links; the joint points are
    declared by the driver and the dyads themselves.
    """

    ground: Mapping[str, complex]
    driver: Crank | SlidingDriver
    dyads: tuple[Dyad, ...]
    points: tuple[LinkPoint, ...] = ()
    inertias: tuple[Inertia, ...] = ()
    gravity: complex = -9.81j

    @property
    def links(self) -> tuple[int, ...]:
        """Numbers of the moving links, the driver first."""
        return (DRIVER, *(link for dyad in self.dyads for link in dyad.links))
