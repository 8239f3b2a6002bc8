"""Curves over the cycle: motion, torque, load of the crank pins, and the diagrams of the flywheel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.analysis import FULL_TURN
from reportgen.document.figures import MM, Drawn, figure
from reportgen.document.groups import GroupView
from reportgen.document.report import SAME, Report, lower_digits
from reportgen.figures import charts
from reportgen.figures.scene import Scene
from reportgen.flywheel import Flywheel
from reportgen.ledger.kinematics.sides import scheme
from reportgen.mechanism.structure import DRIVER, GROUND
from reportgen.notation.expressions import Symbol

THINNED = 4
"""Every fourth of the samples is enough for a curve of the flywheel."""
SEVERAL = 55.0
"""Size of polar diagrams (mm) of which two stand side by side."""
NARROW = 1e-3
"""Below this share of J_r its variation is no width for a diagram, and the lines are drawn from the axis on."""

# --- motion over a turn


@figure("motion")
def motion(report: Report) -> Drawn:
    """Velocity and acceleration of what slides on the ground, ω and ε of what turns, over one turn."""
    names, moved = report.words["figure"], report.dense_cycle.motion
    # Along its guide a slider's course counts away from the crank.
    along = {group.Q: np.exp(1j * float(report.analysis.motion.links[group.j].angle[0])) for group in _sliding(report)}
    spins = scheme(report.machine.linkage).spins
    turning = [link for link, other in spins.items() if link == other > DRIVER]

    def of_points(base: str) -> list[tuple[Symbol, np.ndarray]]:
        vectors = {name: getattr(moved.points[name], base) for name in along}
        return [(Symbol(base, name), np.real(np.conj(u) * vectors[name])) for name, u in along.items()]

    def of_links(base: str, quantity: str) -> list[tuple[Symbol, np.ndarray]]:
        return [(Symbol(base, str(link)), getattr(moved.links[link], quantity)) for link in turning]

    drawings = (
        (of_points("v"), names["velocity"]),
        (of_points("a"), names["acceleration"]),
        (of_links("ω", "omega"), names["omega"]),
        (of_links("ε", "epsilon"), names["epsilon"]),
    )
    return Drawn(tuple(_over_a_turn(report, curves, title) for curves, title in drawings if curves))


@figure("displacement")
def displacement(report: Report) -> Drawn:
    """The coordinates of what slides on the ground, along its guide, over one turn."""
    slides = report.dense_cycle.motion.slides
    curves = [(Symbol("x", group.Q), MM * slides[GROUND, group.j].s) for group in _sliding(report)]
    return Drawn((_over_a_turn(report, curves, report.words["figure"]["displacement"]),))


def _sliding(report: Report) -> tuple[GroupView, ...]:
    """Groups whose last link slides along a fixed guide."""
    on_ground = {slider for carrier, slider in report.analysis.motion.slides if carrier == GROUND}
    return tuple(group for group in report.groups if group.kind in ("RRP", "RPP") and group.j in on_ground)


def _marks(report: Report) -> tuple[int, ...]:
    """Which samples of the dense cycle are the numbered positions."""
    places = np.searchsorted(report.dense_cycle.cycle_angle, report.machine.cycle_angles)
    return tuple(map(int, places))


def _across(report: Report) -> np.ndarray:
    """Where the samples stand: the angle turned (degrees), of a sliding driver the way gone (mm)."""
    angle, span = report.dense_cycle.cycle_angle, report.machine.span
    return angle * (span * MM / FULL_TURN) if span else np.degrees(angle)


def _over_a_turn(report: Report, curves: Sequence[tuple[Symbol, np.ndarray]], title: str) -> Scene:
    """Curves over one turn of the driver, the numbered positions marked."""
    count = int(np.searchsorted(report.dense_cycle.cycle_angle, FULL_TURN + SAME))
    slides, names = bool(report.machine.span), report.words["figure"]
    x, marks = _across(report)[:count], _marks(report)[: report.count]
    series = [charts.Series(shown, x, values[:count], marks) for shown, values in curves]
    return charts.chart(series, names["way"] if slides else names["angle"], title, turn=not slides)


# --- torque and forces over the cycle


@figure("torque", "fig.M")
def torque(report: Report) -> Drawn:
    """What balances the driver: a torque over the angle of a crank, a force over the way of a slider."""
    ledger, names, slides = report.ledger, report.words["figure"], bool(report.machine.span)
    curve = charts.Series(ledger.symbol("M.eq"), _across(report), report.dense_cycle.torque, _marks(report))
    title, across = ("balancing_force", "way") if slides else ("torque", "cycle_angle")
    levels = ((ledger.number("M.mean").value, ledger.symbol("M.mean")),)
    return Drawn((charts.chart((curve,), names[across], names[title], levels=levels, turn=not slides),))


@figure("polar")
def polar(report: Report) -> Drawn:
    """The load of each crank pin in axes that turn with the crank, its radius upwards.

    Where several links hang on one pin, each of their reactions has its diagram, and their resultant.
    """
    fine, names = report.dense_cycle, report.words["figure"]
    numbers = tuple(map(str, report.all_positions))
    assert report.driver_polygon is not None
    loads: dict[str, dict[str, np.ndarray]] = {}
    for edge in report.driver_polygon.edges:
        if edge.unknown or not edge.is_reaction:
            continue
        pin = next(group.P for group in report.groups if edge.name == f"R{group.i}{DRIVER}")
        radius = fine.motion.points[pin].p - fine.motion.points[report.driver.centre].p
        load = fine.forces.reactions[edge.name].force * np.conj(radius / np.abs(radius)) * 1j
        loads.setdefault(pin, {})[lower_digits(edge.name)] = load
    scenes = []
    size = charts.POLAR_SIZE if sum(map(len, loads.values())) == 1 else SEVERAL
    for name, parts in loads.items():
        shown = dict(parts)
        if len(parts) > 1:
            shown[" + ".join(parts)] = np.sum(list(parts.values()), axis=0)
        along = names["along_crank"].format(arm=lower_digits(f"{report.driver.centre}{name}"))
        for forces, load in shown.items():
            series = charts.Series("", load.real, load.imag, _marks(report), numbers)
            title = f"{names['pin']} {lower_digits(name)}: {forces}"
            scenes.append(charts.polar(series, names["across_crank"], along, title=title, size=size))
    return Drawn(tuple(scenes))


# --- the flywheel


def _wheel(report: Report) -> Flywheel:
    assert report.flywheel is not None
    return report.flywheel


def _over_cycle(report: Report, values: np.ndarray, name: str, levels: tuple[tuple[float, Symbol], ...] = ()) -> Scene:
    names = report.words["figure"]
    kept = np.union1d(np.arange(0, values.size, THINNED), values.size - 1)
    curve = charts.Series("", np.degrees(_wheel(report).angle[kept]), values[kept])
    return charts.chart((curve,), names["cycle_angle"], names[name], levels=levels)


@figure("flywheel-torque", "fig.Mr")
def flywheel_torque(report: Report) -> Drawn:
    """M_r and the torque that balances its mean."""
    wheel = _wheel(report)
    level = (-wheel.constant, Symbol("−M", "c"))
    return Drawn((_over_cycle(report, wheel.torque, "reduced_torque", (level,)),))


@figure("flywheel-work", "fig.Jr")
def flywheel_work(report: Report) -> Drawn:
    """J_r, if moving links have mass, and A over the cycle."""
    wheel = _wheel(report)
    inertia = (_over_cycle(report, wheel.inertia, "reduced_inertia"),) if report.has_reduced_inertia else ()
    return Drawn((*inertia, _over_cycle(report, wheel.work, "excess_work")))


@figure("wittenbauer")
def wittenbauer(report: Report) -> Drawn:
    """A over J_r with the two lines whose slopes are half the squares of the bounds of speed."""
    wheel, names = _wheel(report), report.words["figure"]
    ends = np.array([wheel.inertia.min(), wheel.inertia.max()])
    if np.ptp(ends) < NARROW * ends[1]:
        ends = np.array([0.0, 1.2 * ends[1]])
    lines = [
        charts.Series(report.ledger.symbol(id), ends, height + bound**2 / 2 * ends)
        for id, height, bound in (("omega.max", wheel.upper, wheel.fastest), ("omega.min", wheel.lower, wheel.slowest))
    ]
    curve = charts.Series(Symbol("A"), wheel.inertia, wheel.work, (wheel.high, wheel.low))
    return Drawn((charts.chart((curve, *lines), names["reduced_inertia"], names["excess_work"], turn=False),))


@figure("flywheel-speed", "fig.speed")
def flywheel_speed(report: Report) -> Drawn:
    """How far the speed is from its mean, in percent, with the flywheel."""
    wheel = _wheel(report)
    mean = (wheel.fastest + wheel.slowest) / 2
    return Drawn((_over_cycle(report, (wheel.speed / mean - 1) * 100, "speed_deviation"),))
