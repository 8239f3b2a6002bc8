"""Ledgers of linkages to test with, beside the arrays they have to equal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reportgen.ledger import Builder, Ledger, forces, kinematics, precision
from reportgen.ledger.forces import Polygon
from reportgen.mechanism.forces import Forces, solve_forces
from reportgen.mechanism.loads import Load, inertia_loads, weights
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.power import virtual_work_torque
from reportgen.mechanism.structure import Crank, Linkage
from reportgen.notation.expressions import Symbol

RATE = 7.0
"""The driver's speed, rad/s or m/s."""
Push = tuple[int, str, complex, float]
"""A force on a link: link, point, unit vector, size (N)."""


@dataclass(frozen=True)
class Book:
    """A linkage solved twice: in arrays and in a ledger."""

    motion: Motion
    loads: tuple[Load, ...]
    forces: Forces
    work: np.ndarray
    b: Builder
    polygons: tuple[Polygon, ...]

    def ledger(self) -> Ledger:
        decimals, cancellations = precision.choose(self.b.families, (("M.eq", "M.vw"),))
        return Ledger(self.b.families, decimals, self.b.positions, cancellations)


def keep(
    linkage: Linkage,
    driver: np.ndarray,
    turn: int = 1,
    pushes: tuple[Push, ...] = (),
    torques: tuple[tuple[int, float], ...] = (),
) -> Book:
    """Enter a linkage's motion and forces at driver coordinates; weights and inertia are the linkage's."""
    motion = solve_motion(linkage, driver, turn * RATE)
    still = np.zeros_like(motion.driver)
    applied = [
        Load(f"P{link}", link, still + size * sense, motion.points[point].p, still)
        for link, point, sense, size in pushes
    ]
    applied += [Load(f"M{link}", link, still + 0j, still + 0j, still + torque) for link, torque in torques]
    loads = (*weights(linkage, motion), *inertia_loads(linkage, motion), *applied)
    b = Builder(len(driver))
    if isinstance(linkage.driver, Crank):
        b.give("phi.1", Symbol("φ", "1"), "angle", driver)
        b.give("omega.1", Symbol("ω", "1"), "angular velocity", RATE)
    else:
        b.give("s.1", Symbol("s", "1"), "length", driver)
        b.give(f"v.{linkage.driver.pin}", Symbol("v", linkage.driver.pin), "velocity", RATE)
    for body in linkage.inertias:
        link = str(body.link)
        b.give(f"m.{link}", Symbol("m", link), "mass", body.mass)
        b.give(f"J.{link}", Symbol("J", link), "moment of inertia", body.moment)
        b.give(f"G{link}", Symbol("G", link), "weight", body.mass * abs(linkage.gravity))
    for link, _, _, size in pushes:
        b.give(f"P{link}", Symbol("P", str(link)), "force", size)
    for link, torque in torques:
        b.give(f"M{link}", Symbol("M", str(link)), "torque", torque)
    kinematics.describe(b, linkage, turn)
    polygons = forces.describe(
        b,
        linkage,
        turn,
        {f"P{link}": (link, point, sense) for link, point, sense, _ in pushes},
        {f"M{link}": link for link, _ in torques},
    )
    solved = solve_forces(linkage, motion, loads)
    return Book(motion, loads, solved, virtual_work_torque(linkage, motion, loads), b, polygons)
