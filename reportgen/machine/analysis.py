"""Compute an `Analysis` of a `Machine` with `analyse`: motion, loads, gas and forces at its positions."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from functools import cached_property, partial
from string import ascii_lowercase
from typing import Any, TypeVar, cast

import numpy as np

from reportgen.base.records import Record, field
from reportgen.formula import Chain, ids
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Linkage
from reportgen.machine.force_analysis import Forces, Load, inertia_loads, solve_forces, virtual_work_torque, weights
from reportgen.machine.gas_pressure import indicated_work, stroke_at
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.load_laws import FULL_TURN, STEPS, Stroke
from reportgen.machine.loads import Applied, Piston, Torque
from reportgen.machine.quadrature import mean_over
from reportgen.machine.spring_geometry import Coil

Derived = TypeVar("Derived")
Subject = TypeVar("Subject")


class GasState(Record):
    """The gas in one cylinder over positions [N]: cycle angle (rad), s/H, stroke number 0…3, gauge pressure (Pa)."""

    piston: Piston
    angle: np.ndarray
    fraction: np.ndarray
    stroke: np.ndarray
    pressure: np.ndarray


class Analysis(Record, dict=True):
    """Everything computed for a machine at its cycle angles [N] (rad; 0 at position 1, growing with the rotation)."""

    machine: Machine
    cycle_angle: np.ndarray
    motion: Motion
    weights: tuple[Load, ...]
    inertia: tuple[Load, ...]
    applied: tuple[Load, ...]
    forces: Forces
    torque: np.ndarray
    """Balancing torque [N] by equilibrium of the driver (N·m, anticlockwise positive); the force (N) on a slide."""
    torque_by_work: np.ndarray
    """The same by virtual work; shares no code with `torque`."""

    @cached_property
    def _derived(self) -> dict[Callable[[Analysis], object], object]:
        return {}

    @property
    def loads(self) -> tuple[Load, ...]:
        """All loads: inertia, applied loads, weights."""
        return (*self.inertia, *self.applied, *self.weights)

    def derived(self, compute: Callable[[Analysis], Derived]) -> Derived:
        """Return the result of a function of this analysis; each function is computed once."""
        if compute not in self._derived:
            self._derived[compute] = compute(self)
        return cast(Derived, self._derived[compute])

    @cached_property
    def gas(self) -> Mapping[str, GasState]:
        """The gas in each cylinder, by the id of its force."""
        pistons = self.machine.pistons
        return {piston.name: gas_in(piston, self.motion, self.cycle_angle) for piston in pistons}

    @cached_property
    def summary(self) -> Summary:
        """The cycle as a whole, computed at the first access."""
        return summarise(self.machine)


class Summary(Record):
    """The cycle as a whole, from continuous quadrature: mean torque (N·m), power (W), work of the loads (J).

    `extremes` are (cycle angle in rad, torque) of the least and the greatest torque, to a thousandth of a degree. A
    sliding driver has forces (N) instead of torques.
    """

    mean_torque: float
    power: float
    work: float
    energy_error: float
    """|sgn(ω1)·mean(M_cb) + (W − ΔE)/travel| over the greatest torque of the cycle.

    The travel is 2π·turns of a crank, or the span of a slide; ΔE is the energy that the links gain on the span.
    """
    extremes: tuple[tuple[float, float], tuple[float, float]]


def gas_in(piston: Piston, motion: Motion, cycle_angle: np.ndarray) -> GasState:
    """Return the gas at cycle angles [N] (rad): s/H from the pin's place, pressure (Pa) from the indicator table."""
    angle = piston.phase + cycle_angle
    return GasState(
        piston,
        angle,
        piston.fraction(motion),
        stroke_at(angle, piston.dead_centres),
        piston.law.reading(cycle_angle, motion),
    )


def analyse(machine: Machine, cycle_angle: np.ndarray | None = None) -> Analysis:
    """Solve motion, loads, forces and both torques at the machine's positions, or at other cycle angles [N] (rad)."""
    angles = machine.cycle_angles if cycle_angle is None else np.asarray(cycle_angle, dtype=float)
    linkage = machine.linkage
    motion = motion_at(machine, angles)
    applied = tuple(load.load(angles, motion) for load in machine.loads)
    heavy, inert = weights(linkage, motion), inertia_loads(linkage, motion)
    loads = (*heavy, *inert, *applied)
    forces = solve_forces(linkage, motion, loads)
    return Analysis(
        machine=machine,
        cycle_angle=angles,
        motion=motion,
        weights=heavy,
        inertia=inert,
        applied=applied,
        forces=forces,
        torque=forces.torque,
        torque_by_work=virtual_work_torque(linkage, motion, loads),
    )


def motion_at(machine: Machine, cycle_angle: np.ndarray) -> Motion:
    """Return the motion of a machine at cycle angles [N] (rad), at its own speed and acceleration."""
    rate, acceleration = machine.turn * machine.speed, machine.turn * machine.acceleration
    return solve_motion(machine.linkage, machine.angles(cycle_angle), rate, acceleration)


SAME_BREAK = 1e-9
"""Corners of loads nearer than this (rad) count as one corner."""


def breaks(machine: Machine) -> np.ndarray:
    """Return the rising cycle angles [K] (rad) where the loads bend or jump, as at nodes of tables."""
    corners = [corner for load in machine.loads for corner in load.law.breaks(partial(motion_at, machine))]
    whole = machine.turns * FULL_TURN
    angles = np.sort(np.mod(np.asarray(corners, dtype=float) + SAME_BREAK, whole) - SAME_BREAK)
    return angles[np.diff(angles, prepend=-np.inf) > SAME_BREAK]


ROUNDING = 1e-13
"""A torque below this share of the `possible` torque of the loads is a rounding error of the sum."""


def possible(motion: Motion, loads: Iterable[Load]) -> float:
    """Return the torque (N·m) of loads if all acted on the fastest point and link, along their motion.

    It is an upper bound, by which rounding errors are judged. Of a sliding driver it is a force (N).
    """
    loads = tuple(loads)
    fastest = max(float(np.abs(point.v).max()) for point in motion.points.values())
    turning = max(float(np.abs(link.omega).max()) for link in motion.links.values())
    force = sum(float(np.abs(load.force).max()) for load in loads)
    couple = sum(float(np.abs(load.couple).max()) for load in loads)
    return (force * fastest + couple * turning) / float(np.abs(motion.rate).max())


def _work(machine: Machine) -> float:
    """Return the work of the loads over the cycle (J): of gas exact from its table, else ∫ F·v dt and ∫ M ω dt."""
    whole = machine.turns * FULL_TURN
    pistons = {piston.name: piston for piston in machine.pistons}
    total = 0.0
    for load in machine.loads:
        if load.name in pistons:
            total += _indicated(machine, pistons[load.name])
            continue

        def power(angle: np.ndarray, load: Applied | Torque = load) -> np.ndarray:
            motion = motion_at(machine, angle)
            return load.load(angle, motion).power(motion)

        corners = load.law.breaks(partial(motion_at, machine))
        motion = motion_at(machine, angle := np.linspace(0.0, whole, STEPS))
        least = ROUNDING * possible(motion, [load.load(angle, motion)]) * machine.speed
        total += (
            mean_over(power, np.mod(list(corners), whole), 0.0, whole, least) * machine.cycle_travel / machine.speed
        )
    return total


def _indicated(machine: Machine, piston: Piston) -> float:
    def rate(angle: np.ndarray) -> np.ndarray:
        return piston.fraction_rate(motion_at(machine, angle - piston.phase))

    return indicated_work(piston.indicator, piston.area, piston.stroke, rate)


def _energy_gained(machine: Machine) -> float:
    """Return the kinetic and potential energy (J) that the links gain while a sliding driver travels; 0 over a turn."""
    if not machine.span:
        return 0.0
    linkage, motion = machine.linkage, motion_at(machine, np.array([0.0, FULL_TURN]))
    total = np.zeros(2)
    for body in linkage.inertias:
        centre = motion.points[body.centre]
        height = np.real(np.conj(linkage.gravity) * centre.p)
        total += body.mass * (np.abs(centre.v) ** 2 / 2 - height)
        total += body.moment * motion.links[body.link].omega ** 2 / 2
    return float(total[1] - total[0])


def summarise(machine: Machine) -> Summary:
    """Return the mean, extremes and energy balance of a machine over its cycle: sgn(ω1)·mean(M_cb) = −W/(2π·turns)."""
    whole = machine.turns * FULL_TURN
    fine = np.linspace(0.0, whole, 360 * machine.turns, endpoint=False)
    sampled = analyse(machine, fine)
    torque, least = sampled.torque, ROUNDING * possible(sampled.motion, sampled.loads)
    mean = mean_over(lambda angle: analyse(machine, angle).torque_by_work, breaks(machine), 0.0, whole, least)
    work, gained = _work(machine), _energy_gained(machine)
    return Summary(
        float(mean),
        abs(float(mean)) * machine.speed,
        float(work),
        abs(machine.turn * mean + (work - gained) / machine.cycle_travel)
        / max(float(np.nanmax(np.abs(torque))), 1e-300),
        (_extreme(machine, fine, torque, -1), _extreme(machine, fine, torque, 1)),
    )


def _extreme(machine: Machine, angles: np.ndarray, torque: np.ndarray, sense: int) -> tuple[float, float]:
    """Return the cycle angle (rad) and the value of the greatest (`sense` +1) or least (−1) torque.

    The best of the torques [N] at evenly spaced `angles` [N] is refined twice on a finer grid.
    """
    for _ in range(2):
        best, step = int(np.nanargmax(sense * torque)), float(angles[1] - angles[0])
        angles = np.linspace(angles[best] - step, angles[best] + step, 81)
        if machine.span:  # A slide stops at the end of its travel.
            angles = np.unique(np.clip(angles, 0.0, FULL_TURN))
        torque = analyse(machine, angles).torque
    best = int(np.nanargmax(sense * torque))
    # The end of a turn repeats its start; the end of a slide's travel is another position.
    return float(angles[best] if machine.span else angles[best] % (machine.turns * FULL_TURN)), float(torque[best])


# --- result of a catalogue module: a machine ------------------------------------------------------
# Plain data that the rest of the package reads.
# A module of the catalogue makes a `Machine`; later code does not depend on the kind.

SAME_POSITION = 1e-6
"""Positions nearer than this (rad) count as one position."""


class Position(int):
    """The number of a position, from 1, that is written as its label."""

    label: str

    def __new__(cls, number: int, label: str = "") -> Position:
        position = super().__new__(cls, number)
        position.label = label or str(int(number))
        return position

    def __str__(self) -> str:
        return self.label


def no_formulas(q: Calculation) -> None:
    """Enter nothing: the default for a machine without closed formulas."""


class ClosedFormulas(Record):
    """The closed formulas of a machine: `write` enters them in the calculation after the plans.

    `compared` are pairs of a plan's quantity and its closed formula, compared in the report; `equations` are those
    that templates of the analytic method show, by name.
    """

    write: Callable[[Calculation], None] = no_formulas
    compared: tuple[tuple[str, str], ...] = ()
    equations: Mapping[str, tuple[Chain, ...]] = field(default_factory=dict)


class Machine(Record, dict=True):
    """A mechanism with its drive, its loads and the outline of its report.

    A turn has `count` positions, numbered from the driver's coordinate `start` (rad, or m of a slide) in the direction
    `turn` (+1 anticlockwise); `speed` is positive (rad/s or m/s). The cycle of loads takes `turns` turns of the driver.
    The calculation `sheet` contains the given data and the values computed from them; `outline` names the report's
    sections in order.
    """

    kind: str
    linkage: Linkage
    start: float
    turn: int
    speed: float
    count: int
    turns: int
    calculation: Calculation
    outline: tuple[str, ...]
    closed_formulas: ClosedFormulas = ClosedFormulas()
    applied: tuple[Applied, ...] = ()
    """Forces other than weight and inertia, including the gas force on `pistons`."""
    torques: tuple[Torque, ...] = ()
    """Torques other than inertia couples."""
    idle: tuple[str, ...] = ()
    """Names of loads that the file gives as zero throughout; they are in neither of the two above."""
    sliders: tuple[Stroke, ...] = ()
    """Sliders with dead centres, the pistons of cylinders with gas among them."""
    positive: Mapping[str, complex] = field(default_factory=dict)
    """Unit vectors along which the motion of sliders counts as positive, by their pins; else along their guides."""
    paths: tuple[str, ...] = ()
    """Points whose paths the position plan shows."""
    topics: Mapping[str, object] = field(default_factory=dict)
    """The subjects of its topics, by the names of the topics."""
    beside: tuple[str, ...] = ()
    """The names of the loads that topics bring."""
    places: tuple[float, ...] = ()
    """Cycle angles (rad) of the positions of one turn; if empty, they are evenly spaced from 0."""
    labels: tuple[str, ...] = ()
    """Labels of the positions of the cycle; empty if they are numbered."""
    span: float = 0.0
    """Travel (m) of a sliding driver over the cycle, which then counts as one turn; 0 for a crank."""
    acceleration: float = 0.0
    """ε₁ (rad/s²) of a crank, or the acceleration (m/s²) of a slide, positive in the sense of its speed."""
    instants: bool = False
    """True if its positions, the `places`, are single instants; the report then does not describe the motion between
    them.
    """
    essential: tuple[str, ...] = ()
    """Sections that the task of the kind requires, so that a short report has them, too."""
    facts: Mapping[str, Any] = field(default_factory=dict)
    """Values besides quantities that the templates of its kind may name."""
    outlined: Callable[[bool, bool, Collection[str]], tuple[str, ...]] | None = None
    """Function that returns its outline with or without masses, with or without loads, with other topics."""

    @cached_property
    def results(self) -> dict[str, object]:
        """Results of topics that others have requested; each is computed once."""
        return {}

    def topic(self, name: str, of: type[Subject]) -> Subject | None:
        """Return the subject of a topic, None if the machine does not have the topic."""
        subject = self.topics.get(name)
        assert subject is None or isinstance(subject, of), f"the subject of {name} is not a {of.__name__}"
        return subject

    @property
    def pistons(self) -> tuple[Piston, ...]:
        """The sliders on which gas acts."""
        return tuple(slider for slider in self.sliders if isinstance(slider, Piston))

    @property
    def loads(self) -> tuple[Applied | Torque, ...]:
        """The forces and torques that act on it, beside weights and inertia."""
        return (*self.applied, *self.torques)

    @property
    def coils(self) -> tuple[Coil, ...]:
        """The springs that act on it, in the order of their numbers."""
        return tuple(sorted({coil for load in self.loads if (coil := load.law.coil)}, key=lambda coil: coil.number))

    @property
    def cycle_travel(self) -> float:
        """The driver's travel over the cycle: an angle (rad), or the span of a sliding driver (m)."""
        return self.span or self.turns * 2 * np.pi

    @property
    def positions(self) -> int:
        """Number of positions of the whole cycle."""
        return self.count if self.instants else self.count * self.turns

    @property
    def cyclic(self) -> bool:
        """True if the driver runs through the whole cycle at a constant speed, so that means and work are defined."""
        return not (self.instants or self.acceleration)

    @property
    def even(self) -> np.ndarray:
        """Flags of the positions [count·turns] that are evenly spaced over the cycle; False for lettered positions."""
        return np.array([not self.labels[k].isalpha() if self.labels else True for k in range(self.positions)])

    @property
    def cycle_angles(self) -> np.ndarray:
        """Cycle angles (rad) of all positions [count·turns], 0 at position 1, growing with the rotation."""
        step = 2 * np.pi / self.count
        if not self.places:
            return np.arange(self.positions) * step
        if self.instants:
            return np.asarray(self.places)
        turns = np.arange(self.turns)[:, None] * (2 * np.pi)
        return np.asarray((turns + np.asarray(self.places)).ravel())

    def angles(self, cycle_angle: np.ndarray) -> np.ndarray:
        """Return the driver's angles (rad) at cycle angles (rad), both [N]; of a sliding driver its coordinates (m)."""
        return self.start + self.turn * cycle_angle * (self.span / (2 * np.pi) if self.span else 1.0)

    @property
    def drawn(self) -> float:
        """The crank's drawn length (m on paper) where the file or the kind sets it, else 0."""
        driver = self.linkage.driver
        id = ids.drawn(driver.centre, driver.pin) if isinstance(driver, Crank) else ""
        return self.calculation.si(id) if id in self.calculation else 0.0

    def position(self, number: int) -> Position:
        """Return a position by its number from 1."""
        return Position(number, self.labels[number - 1] if self.labels else "")

    def numbered(self, numbers: Iterable[int]) -> tuple[Position, ...]:
        """Return positions by their numbers from 1."""
        return tuple(map(self.position, numbers))


def lettered(count: int, turns: int, extra: Iterable[float]) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Return the cycle angles (rad) of the positions of one turn, and the labels of those of the whole cycle.

    A turn has `count` evenly spaced positions, labelled 0, 1, …, and those at the `extra` angles (rad), labelled a, b,
    …, in the order of the angle; an extra angle that coincides with an even one is left out. Numbers and letters
    continue from turn to turn.
    """
    even = np.arange(count) * (2 * np.pi / count)
    turned = np.mod(np.asarray(list(extra)) + SAME_POSITION, 2 * np.pi) - SAME_POSITION
    new = [float(angle) for angle in turned if np.abs(even - angle).min() > SAME_POSITION]
    places = sorted([*map(float, even), *new])
    numbers, letters = iter(range(count * turns)), iter(ascii_lowercase)
    labels = [next(letters) if place in new else str(next(numbers)) for _ in range(turns) for place in places]
    return tuple(places), tuple(labels)
