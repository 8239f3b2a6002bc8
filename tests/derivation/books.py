"""Ledgers of linkages to test with, beside the arrays they have to equal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reportgen.base.records import replace
from reportgen.derivation import ONE_QUANTITY
from reportgen.derivation.group_forces import enter_forces
from reportgen.derivation.group_motion import enter_kinematics
from reportgen.derivation.load_entries import Polygon
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import Ledger
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.machine.force_analysis import Forces, Load, inertia_loads, solve_forces, virtual_work_torque, weights
from reportgen.machine.kinematics import Motion, solve_motion

RATE = 7.0
"""The driver's speed, rad/s or m/s."""
Push = tuple[int, str, complex, float]
"""A force on a link: link, point, unit vector, size (N)."""


@dataclass(frozen=True)
class Book:
    """A linkage solved twice: in arrays and in a ledger."""

    linkage: Linkage
    motion: Motion
    loads: tuple[Load, ...]
    forces: Forces
    work: np.ndarray
    b: Calculation
    polygons: tuple[Polygon, ...]

    def ledger(self) -> Ledger:
        return Ledger(self.b.families, self.b.positions, same=ONE_QUANTITY)


def keep(
    linkage: Linkage,
    driver: np.ndarray,
    turn: int = 1,
    pushes: tuple[Push, ...] = (),
    torques: tuple[tuple[int, float], ...] = (),
    rate: float = RATE,
) -> Book:
    """Enter a linkage's motion and forces at driver coordinates; weights and inertia are the linkage's."""
    motion = solve_motion(linkage, driver, turn * rate)
    still = np.zeros_like(motion.driver)
    applied = [
        Load(f"P{link}", link, still + size * sense, motion.points[point].p, still)
        for link, point, sense, size in pushes
    ]
    applied += [Load(f"M{link}", link, still + 0j, still + 0j, still + torque) for link, torque in torques]
    loads = (*weights(linkage, motion), *inertia_loads(linkage, motion), *applied)
    b = Calculation(len(driver))
    if isinstance(linkage.driver, Crank):
        b.give("phi.1", driver)
        b.give("omega.1", rate)
    else:
        b.give("s.1", driver)
        b.give(f"v.{linkage.driver.pin}", rate)
    for body in linkage.inertias:
        b.give(f"m.{body.link}", body.mass)
        b.give(f"J.{body.link}", body.moment)
        b.give(f"G{body.link}", body.mass * abs(linkage.gravity))
    for link, _, _, size in pushes:
        b.give(f"P{link}", size)
    for link, torque in torques:
        b.give(f"M{link}", torque)
    enter_kinematics(b, linkage, turn)
    polygons = enter_forces(
        b,
        linkage,
        turn,
        {f"P{link}": (link, point, sense) for link, point, sense, _ in pushes},
        {f"M{link}": link for link, _ in torques},
    )
    solved = solve_forces(linkage, motion, loads)
    return Book(linkage, motion, loads, solved, virtual_work_torque(linkage, motion, loads), b, polygons)


def _machines() -> dict[str, Linkage]:
    """One ordinary linkage of every kind, with loads on all that moves, that turns the whole way round."""
    crank = Crank("A", "B", 0.1)
    lever = Dyad("RPR", (2, 3), "B", "B3", "C")
    four_bar = Dyad("RRR", (2, 3), "B", "C", "D", (0.3, 0.25))
    block = Inertia(2, "B", 1.0, 0.001)
    beam = (LinkPoint("S3", 3, 0.3 + 0j),)
    on_beam = Inertia(3, "S3", 3.0, 0.05)
    ground, low = {"A": 0j, "D": 0.3 + 0j}, {"A": 0j, "C": -0.25j}
    corner = LinkPoint("E", 2, 0.15 + 0.1j)
    return {
        "RRR": Linkage(ground, crank, (four_bar,), (corner,), (Inertia(2, "E", 2.0, 0.02), Inertia(3, "C", 1.0, 0.03))),
        "RRP": Linkage(
            {"A": 0j},
            crank,
            (Dyad("RRP", (2, 3), "B", "C", Guide(0.02j, 0.0), (0.3, 0.0)),),
            (LinkPoint("S2", 2, 0.12 + 0j),),
            (Inertia(2, "S2", 2.0, 0.02), Inertia(3, "C", 3.0)),
        ),
        "RPR": Linkage(low, crank, (lever,), beam, (block, on_beam)),
        "RPR with offset": Linkage(low, crank, (replace(lever, lengths=(0.0, 0.05)),), beam, (block, on_beam)),
        "RPR and PRP": Linkage(
            low,
            crank,
            (lever, Dyad("PRP", (4, 5), Guide(0j, 0.0, 3), "E", Guide(0.2j, 0.0))),
            beam,
            (block, on_beam, Inertia(5, "E", 4.0)),
        ),
        "RPP": Linkage(
            {"A": 0j},
            crank,
            (Dyad("RPP", (2, 3), "B", "D", Guide(0j, 0.0), slide_angle=np.pi / 2),),
            (),
            (Inertia(2, "B", 1.0), Inertia(3, "D", 3.0)),
        ),
        "RRR and RRP on its rocker": Linkage(
            ground,
            crank,
            (four_bar, Dyad("RRP", (4, 5), "E", "F", Guide(0.05j, 0.3, 3), (0.3, 0.0), -1)),
            (corner,),
            (Inertia(2, "E", 1.0), Inertia(4, "F", 3.0, 0.03)),
        ),
    }


MACHINES = _machines()
"""Lengths are round numbers, as those of an assignment are."""
