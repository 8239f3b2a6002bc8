"""Machines to draw: the twin engine, a four-bar with a slider, a slotted lever, drives with two slides."""

from __future__ import annotations

import math

import numpy as np

from reportgen.drawing.vector_plan import Plan, PlanLine, PlanPoint, PlanVector
from reportgen.formula import Chain, Expression, Number, Symbol
from reportgen.formula.vocabulary import on_plan
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.machine.kinematics import Motion, solve_motion

R, L = 0.0475, 0.171
OMEGA = 2200 * math.pi / 30
VERTICAL = Guide(0j, math.pi / 2)


def twin_engine() -> Linkage:
    """Two pistons on one vertical, crank pins opposite; figures of the reference, section 1."""
    m2, m3 = 20 / 9.81, 22 / 9.81
    return Linkage(
        ground={"O1": 0j},
        driver=Crank("O1", "A", R),
        groups=(Dyad("RRP", (2, 3), "A", "B", VERTICAL, (L, 0.0)), Dyad("RRP", (4, 5), "C", "D", VERTICAL, (L, 0.0))),
        points=(LinkPoint("C", 1, -R), LinkPoint("S2", 2, 0.35 * L), LinkPoint("S4", 4, 0.35 * L)),
        inertias=(
            Inertia(2, "S2", m2, m2 * L**2 / 12),
            Inertia(3, "B", m3),
            Inertia(4, "S4", m2, m2 * L**2 / 12),
            Inertia(5, "D", m3),
        ),
    )


def four_bar() -> Linkage:
    """A crank-rocker with a coupler point and a rod to a slider: three kinds of joints on one link."""
    return Linkage(
        ground={"O1": 0j, "O3": 0.3 + 0.05j},
        driver=Crank("O1", "A", 0.1),
        groups=(
            Dyad("RRR", (2, 3), "A", "B", "O3", (0.28, 0.2)),
            Dyad("RRP", (4, 5), "E", "F", Guide(0.26j, 0.0), (0.3, 0.0)),
        ),
        points=(LinkPoint("E", 2, 0.15 + 0.09j), LinkPoint("S2", 2, 0.12 + 0.04j)),
    )


def slotted_lever() -> Linkage:
    """A block in a swinging lever, and the lever's end driving a ram through a short link."""
    return Linkage(
        ground={"O1": 0.27j, "O3": 0j},
        driver=Crank("O1", "A", 0.10309),
        groups=(Dyad("RPR", (2, 3), "A", "A3", "O3"), Dyad("RRP", (4, 5), "D", "E", Guide(0.52j, math.pi), (0.1, 0.0))),
        points=(LinkPoint("D", 3, 0.55), LinkPoint("S3", 3, 0.3)),
    )


def sine_drive() -> Linkage:
    """A crank's block in a slot across a ram: RPP; and a rod guided both ways: PRP."""
    return Linkage(
        ground={"O1": 0j},
        driver=Crank("O1", "A", 0.08),
        groups=(Dyad("RPP", (2, 3), "A", "Q", Guide(0j, 0.0), slide_angle=math.pi / 2),),
    )


def elliptic_drive() -> Linkage:
    """Two blocks pinned together, one in the coupler of a parallel crank, one in the frame: PRP."""
    return Linkage(
        ground={"O1": 0j, "O3": 0.2 + 0j},
        driver=Crank("O1", "A", 0.08),
        groups=(
            Dyad("RRR", (2, 3), "A", "B", "O3", (0.2, 0.081)),
            Dyad("PRP", (4, 5), Guide(0.03j, 0.0, link=2), "P", Guide(0.1 + 0j, math.pi / 2)),
        ),
    )


def at_positions(linkage: Linkage, start: float = math.pi / 2, count: int = 8, turns: int = 1) -> Motion:
    return solve_motion(linkage, start + np.arange(count) * turns * math.tau / count, OMEGA)


def dense(linkage: Linkage) -> Motion:
    return solve_motion(linkage, np.linspace(0, math.tau, 121), OMEGA)


def scale_note(name: str, value: float, unit: str) -> Expression:
    return Chain((Symbol("μ", name), Number(value, 5, unit)))


def velocity_plan(motion: Motion, k: int) -> Plan:
    """The engine's velocity plan at position index k, crank drawn 50 mm."""
    mu = OMEGA * R / 50
    v = {name: complex(motion.points[name].v[k]) / mu for name in ("A", "B", "C", "D", "S2", "S4")}
    p = {name: complex(motion.points[name].p[k]) for name in v}
    vectors, lines = [], []
    points = [PlanPoint(Symbol("p"), 0j)]
    for n, (pin, slider, centre) in enumerate((("A", "B", "S2"), ("C", "D", "S4"))):
        a, b, s = v[pin], v[slider], v[centre]
        low = pin.lower(), slider.lower(), centre.lower()
        vectors += [
            PlanVector("p" + low[0], 0j, a, stage=4 * n),
            PlanVector(low[0] + low[1], a, b, "relative", stage=4 * n + 2),
            PlanVector("p" + low[1], 0j, b, "found", stage=4 * n + 2),
            PlanVector("p" + low[2], 0j, s, "known", stage=4 * n + 3),
        ]
        turn = 1j * (p[slider] - p[pin]) / abs(p[slider] - p[pin])
        way = b - a if abs(b - a) > 1e-6 else turn
        lines += [PlanLine(a, a + way, 4 * n + 1), PlanLine(0j, b if abs(b) > 1e-6 else 1j, 4 * n + 1)]
        points += [
            PlanPoint(on_plan(pin), a, 4 * n),
            PlanPoint(on_plan(slider), b, 4 * n + 2),
            PlanPoint(on_plan(centre), s, 4 * n + 3),
        ]
    return Plan(tuple(vectors), tuple(points), tuple(lines), scale_note("v", mu, "m/(s·mm)"))


def acceleration_plan(motion: Motion, k: int) -> Plan:
    """The engine's acceleration plan at position index k."""
    mu = OMEGA**2 * R / 50
    points = [PlanPoint(Symbol("π"), 0j)]
    vectors = []
    for n, (pin, slider, centre, link) in enumerate((("A", "B", "S2", 2), ("C", "D", "S4", 4))):
        a, b, s = (complex(motion.points[name].a[k]) / mu for name in (pin, slider, centre))
        rod = complex(motion.points[slider].p[k] - motion.points[pin].p[k])
        normal = -rod * float(motion.links[link].omega[k]) ** 2 / mu
        vectors += [
            PlanVector("π" + pin.lower() + "′", 0j, a, stage=3 * n),
            PlanVector("n", a, a + normal, "relative", stage=3 * n + 1),
            PlanVector("t", a + normal, b, "relative", stage=3 * n + 2),
            PlanVector("π" + slider.lower() + "′", 0j, b, "found", stage=3 * n + 2),
            PlanVector("π" + centre.lower() + "′", 0j, s, stage=3 * n + 2),
        ]
        points += [
            PlanPoint(on_plan(pin, True), a, 3 * n),
            PlanPoint(Symbol("n", slider + pin), a + normal, 3 * n + 1),
            PlanPoint(on_plan(slider, True), b, 3 * n + 2),
            PlanPoint(on_plan(centre, True), s, 3 * n + 2),
        ]
    return Plan(tuple(vectors), tuple(points), (), scale_note("a", mu, "m/(s²·mm)"))
