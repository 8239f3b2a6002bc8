"""The torques of a file as a diagram, and the steady run of the machine: points of intersection, areas, speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import reduce

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.flywheel.turning_diagram import Harmonic, StraightPart, TurningDiagram, added, lines_of
from reportgen.flywheel.turning_file import Parameters, Torques

DRIVING, RESISTING = "d", "r"
CLOSE = 1e-9
"""Relative difference below which two mean torques are equal."""
STEP = math.radians(1.0)
"""Longest panel of the integration with a resisting torque that follows the speed (rad)."""
ORDER = 10
"""Gauss nodes of a panel."""
MOST_ROUNDS, SETTLED = 400, 1e-14


def period_of(*of: Torques | None) -> float:
    """Return the period (rad) of the harmonics of torques: 2π over the greatest common measure of their orders."""
    halves = [round(2 * term.order) for torques in of if torques is not None for term in torques.harmonics]
    return 4 * math.pi / reduce(math.gcd, halves) if halves else 0.0


def cycle_of(given: Parameters) -> float:
    """Return the cycle (rad): that of a table, else the period of all harmonics."""
    tables = [one.nodes[-1][0] for one in (given.driving, given.resisting) if one is not None and one.nodes]
    return max(tables) if tables else period_of(given.driving, given.resisting)


def mean_of(torques: Torques) -> float:
    """Return the mean (N·m) of a torque over its cycle."""
    if torques.terms:
        return 0.0 if torques.mean is None else torques.mean.si
    lines = lines_of(torques.nodes)
    return sum((one.stop - one.start) * (one.first + one.last) / 2 for one in lines) / torques.nodes[-1][0]


def level_of(given: Parameters) -> float:
    """Return the mean torque (N·m) of the driver: its own, else that of the load."""
    leading = given.driving if given.driving is not None else given.resisting
    assert leading is not None
    return mean_of(leading)


def factor_of(given: Parameters) -> float:
    """Return the factor that brings a second diagram, the resisting one, to the mean of the driving one."""
    load, driving = given.resisting, given.driving
    if load is None or driving is None or not load.varies or (load.terms and load.mean is None):
        return 1.0
    factor = mean_of(driving) / mean_of(load)
    return 1.0 if abs(factor - 1) <= CLOSE else factor


def diagram_of(given: Parameters) -> TurningDiagram:
    """Return the excess of the driving torque over the resisting one, each taken from the mean."""
    cycle, level, κ = cycle_of(given), level_of(given), factor_of(given)
    harmonics: list[Harmonic] = []
    tables: list[tuple[float, list[StraightPart]]] = []
    for torques, factor in ((given.driving, 1.0), (given.resisting, -κ)):
        if torques is None:
            continue
        harmonics += [Harmonic(term.order, factor * term.cos.si, factor * term.sin.si) for term in torques.harmonics]
        if torques.nodes:
            tables.append((factor, lines_of(torques.nodes)))
            tables.append((-math.copysign(level, factor), [StraightPart(0.0, cycle, 1.0, 1.0)]))
    tables = tables or [(0.0, [StraightPart(0.0, cycle, 1.0, 1.0)])]
    return TurningDiagram(cycle, tuple(harmonics), added(tables, cycle))


@dataclass(frozen=True)
class SteadyRun:
    """The steady run of a machine: where the torques are equal (rad), the areas between (J), and the excess torque.

    `per_speed` is the resisting torque over the speed (N·m·s/rad) if it is proportional to the speed, else 0.
    """

    points: tuple[float, ...]
    areas: tuple[float, ...]
    excess: Callable[[float], float] = field(repr=False)
    per_speed: float = 0.0


def steady_run(given: Parameters) -> SteadyRun:
    """Return the steady run of a machine with diagrams."""
    diagram = diagram_of(given)
    if given.follows_speed:
        return _run_by_speed(given, diagram)
    ends = np.array([*diagram.points, diagram.cycle])
    areas = tuple(float(area) for area in np.diff(diagram.integral(ends)))

    def excess(angle: float) -> float:
        line = next(one for one in reversed(diagram.lines) if one.start <= angle % diagram.cycle)
        return float(diagram.on_line(line, angle % diagram.cycle))

    return SteadyRun(diagram.points, areas, excess)


SAMPLES = 361


def both_torques(given: Parameters, run: SteadyRun) -> tuple[Floats, Floats, Floats]:
    """Return angles (rad), driving and resisting torque (N·m), each [N], for drawing.

    The points of the run and the corners of tables are among the angles; a jump has two values at one angle.
    """
    cycle, level, κ = cycle_of(given), level_of(given), factor_of(given)
    corners = [angle for one in (given.driving, given.resisting) if one is not None for angle, _ in one.nodes]
    jumps = [angle for angle in {*corners} if corners.count(angle) > 1]
    φ = np.unique(np.concatenate((np.linspace(0.0, cycle, SAMPLES), run.points, corners)))
    φ = np.sort(np.concatenate((φ, jumps)))
    after = np.concatenate(([False], np.diff(φ) == 0))

    def curve(torques: Torques | None, factor: float) -> Floats:
        if torques is None or not (torques.terms or torques.nodes):
            return np.full_like(φ, level)
        if torques.nodes:
            x, y = np.array(torques.nodes).T
            left = np.array([y[np.searchsorted(x, at, side="left")] if at in x else np.interp(at, x, y) for at in φ])
            right = np.array(
                [y[np.searchsorted(x, at, side="right") - 1] if at in x else np.interp(at, x, y) for at in φ]
            )
            return factor * np.where(after, right, left)
        waves = [Harmonic(term.order, term.cos.si, term.sin.si) for term in torques.harmonics]
        return level + factor * TurningDiagram(cycle, tuple(waves), ()).waves(φ)

    driving = curve(given.driving, 1.0)
    if given.follows_speed:
        return φ, driving, driving - np.array([run.excess(float(at)) for at in φ])
    return φ, driving, curve(given.resisting, κ)


# --- a resisting torque proportional to the speed -----------------------------------------------------


def _run_by_speed(given: Parameters, diagram: TurningDiagram) -> SteadyRun:
    """Solve dK/dφ = M_d − cω over the cycle, K = Jω²/2, with (ω_max + ω_min)/2 = ω_m and δ or J as given.

    The excess work A of the last speed gives the next one: c = ∫M_d dφ/∫ω dφ, ω² = ω_max² − 2(A_max − A)/J. Panels of
    Gauss nodes, divided at the corners of the torque, make the integrals exact to rounding.
    """
    knots = np.unique(
        np.concatenate(
            [
                np.linspace(line.start, line.stop, math.ceil((line.stop - line.start) / STEP) + 1)
                for line in diagram.lines
            ]
        )
    )
    starts, widths = knots[:-1], np.diff(knots)
    x, w = np.polynomial.legendre.leggauss(ORDER)
    nodes = (x + 1) / 2
    inverse: Floats = np.asarray(np.linalg.inv(np.vander(nodes, ORDER, increasing=True)), np.float64)
    powers = np.arange(1, ORDER + 1)
    inner = (nodes[:, None] ** powers / powers) @ inverse  # integrals of a panel from its start to each node
    at = starts[:, None] + widths[:, None] * nodes
    line_at = np.searchsorted([one.start for one in diagram.lines], (knots[:-1] + knots[1:]) / 2) - 1
    driving = level_of(given) + np.array(
        [diagram.on_line(diagram.lines[i], row) for i, row in zip(line_at, at, strict=True)]
    )
    ω_m, level = given.n.si, level_of(given)

    def integrated(values: Floats) -> tuple[Floats, Floats]:
        """Return the integral from the start of the cycle to the knots [K + 1], and to the nodes of the panels."""
        whole = widths * (values @ w) / 2
        to_knots = np.concatenate(([0.0], np.cumsum(whole)))
        return to_knots, to_knots[:-1, None] + widths[:, None] * (values @ inner.T)

    ω, c = np.full_like(at, ω_m), level / ω_m
    points: tuple[float, ...] = ()
    areas: tuple[float, ...] = ()
    J = None if given.delta is not None else _inertia(given)
    for _ in range(MOST_ROUNDS):
        before = ω
        c = level * diagram.cycle / integrated(ω)[0][-1]
        excess = driving - c * ω
        to_knots, to_nodes = integrated(excess)
        points = _zeros(excess, inverse, starts, widths, to_knots)
        work = np.array([_work_to(φ, knots, widths, excess @ inverse.T, to_knots) for φ in points])
        high, low = float(work.max()), float(work.min())
        if given.delta is not None:
            J = (high - low) / (given.delta.si * ω_m**2)
            fastest = ω_m * (1 + given.delta.si / 2)
        else:
            assert J is not None
            fastest = ω_m + (high - low) / (2 * J * ω_m)
        ω = np.sqrt(fastest**2 - 2 * (high - to_nodes) / J)
        areas = tuple(float(area) for area in np.diff([*work, to_knots[-1]]))
        if float(np.abs(ω - before).max()) <= SETTLED * ω_m:
            break
    coefficients = (driving - c * ω) @ inverse.T

    def excess_at(angle: float) -> float:
        φ = angle % diagram.cycle
        i = min(int(np.searchsorted(knots, φ, side="right")) - 1, len(widths) - 1)
        return float(np.polynomial.polynomial.polyval((φ - starts[i]) / widths[i], coefficients[i]))

    return SteadyRun(points, areas, excess_at, float(c))


def _inertia(given: Parameters) -> float:
    if given.J is not None:
        return given.J.si
    assert given.m is not None
    assert given.k is not None
    return given.m.si * given.k.si**2


def _zeros(values: Floats, inverse: Floats, starts: Floats, widths: Floats, to_knots: Floats) -> tuple[float, ...]:
    """Return the start of the cycle and the angles (rad) at which a torque on panels [P, nodes] changes its sign."""
    coefficients = values @ inverse.T
    ends = np.stack((coefficients[:, 0], coefficients.sum(axis=1)), axis=1)
    zeros = [0.0]
    before = 0.0
    for i, (first, last) in enumerate(ends):
        for side, value in ((0, float(first)), (1, float(last))):
            if before * value < 0:
                place = 0.0 if side == 0 else _zero_in(coefficients[i], before)
                zeros.append(float(starts[i] + widths[i] * place))
            before = value or before
    return tuple(φ for i, φ in enumerate(zeros) if not i or 1e-9 < φ < float(starts[-1] + widths[-1]) - 1e-9)


def _zero_in(coefficients: Floats, first: float) -> float:
    """Return the place from 0 to 1 at which a polynomial that begins with the sign of `first` is zero."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        if first * float(np.polynomial.polynomial.polyval(middle, coefficients)) > 0:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _work_to(φ: float, knots: Floats, widths: Floats, coefficients: Floats, to_knots: Floats) -> float:
    """Return the integral of a torque on panels from the start of the cycle to an angle (rad)."""
    i = min(int(np.searchsorted(knots, φ, side="right")) - 1, len(widths) - 1)
    integral = np.polynomial.polynomial.polyint(coefficients[i])
    place = (φ - knots[i]) / widths[i]
    return float(to_knots[i] + widths[i] * np.polynomial.polynomial.polyval(place, integral))
