"""Figures of a course: motion over a turn, torque and crank-pin loads over the cycle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from reportgen.analysis import FULL_TURN, Analysis, analyse
from reportgen.document.pictured import (
    DENSE,
    MM,
    SAME,
    Drawn,
    Pictured,
)
from reportgen.document.views import GroupView
from reportgen.figures import charts
from reportgen.figures.scene import Scene
from reportgen.ledger.kinematics.sides import scheme as scheme_of
from reportgen.mechanism.structure import DRIVER, GROUND
from reportgen.notation import symbols
from reportgen.notation.expressions import Symbol


class Curves(Pictured):
    """Curves over the crank's angle, the numbered positions marked."""

    @property
    def figures(self) -> dict[str, Callable[..., Drawn]]:
        return {
            "motion": self.motion,
            "displacement": self.displacement,
            "torque": self.torque,
            "polar": self.polar,
        }

    @cached_property
    def dense_cycle(self) -> Analysis:
        """The whole analysis over the cycle, finely, the numbered positions among the samples."""
        machine = self.analysis.machine
        own = machine.cycle_angles
        grid = np.linspace(0.0, machine.turns * FULL_TURN, machine.turns * (DENSE - 1) + 1)
        between = np.abs(grid[:, None] - own).min(axis=1) > SAME
        return analyse(machine, np.sort(np.concatenate((grid[between], own))))

    @property
    def _marks(self) -> tuple[int, ...]:
        """Which samples of `dense_cycle` are the numbered positions."""
        places = np.searchsorted(self.dense_cycle.cycle_angle, self.analysis.machine.cycle_angles)
        return tuple(map(int, places))

    @property
    def _across(self) -> np.ndarray:
        """Where the samples stand: the angle turned (degrees), of a sliding driver the way gone (mm)."""
        fine, span = self.dense_cycle, self.analysis.machine.span
        return fine.cycle_angle * (span * MM / FULL_TURN) if span else np.degrees(fine.cycle_angle)

    def motion(self) -> Drawn:
        """Velocity and acceleration of what slides on the ground, ω and ε of what turns, over one turn."""
        names, motion, sliding = self.words["figure"], self.dense_cycle.motion, self._sliding
        along = {group.Q: np.exp(1j * _guide_angle(self.analysis, group)) for group in sliding}
        spins = scheme_of(self.analysis.machine.linkage).spins
        turning = [link for link, other in spins.items() if link == other > DRIVER]

        def of_points(base: str) -> list[tuple[Symbol, np.ndarray]]:
            vectors = {name: getattr(motion.points[name], base) for name in along}
            return [(Symbol(base, name), np.real(np.conj(u) * vectors[name])) for name, u in along.items()]

        def of_links(base: str, quantity: str) -> list[tuple[Symbol, np.ndarray]]:
            return [(Symbol(base, str(link)), getattr(motion.links[link], quantity)) for link in turning]

        drawings = (
            (of_points("v"), names["velocity"]),
            (of_points("a"), names["acceleration"]),
            (of_links("ω", "omega"), names["omega"]),
            (of_links("ε", "epsilon"), names["epsilon"]),
        )
        return Drawn(tuple(self._over_a_turn(curves, title) for curves, title in drawings if curves))

    def displacement(self) -> Drawn:
        """The coordinates of what slides on the ground, along its guide, over one turn."""
        slides = self.dense_cycle.motion.slides
        curves = [(Symbol("x", group.Q), MM * slides[GROUND, group.j].s) for group in self._sliding]
        return Drawn((self._over_a_turn(curves, self.words["figure"]["displacement"]),))

    @property
    def _sliding(self) -> tuple[GroupView, ...]:
        """Groups whose inner pin runs along a fixed guide."""
        on_ground = {slider for carrier, slider in self.analysis.motion.slides if carrier == GROUND}
        return tuple(group for group in self.facts.groups if group.kind == "RRP" and group.j in on_ground)

    def _over_a_turn(self, curves: Sequence[tuple[Symbol, np.ndarray]], title: str) -> Scene:
        """Curves over one turn of the driver, the numbered positions marked."""
        fine = self.dense_cycle
        count = int(np.searchsorted(fine.cycle_angle, FULL_TURN + SAME))
        slides, name = bool(self.analysis.machine.span), self.words["figure"]["angle"]
        x = self._across[:count]
        marks = self._marks[: self.analysis.machine.count]
        series = [charts.Series(symbol, x, values[:count], marks) for symbol, values in curves]
        return charts.chart(series, self.words["figure"]["way"] if slides else name, title, turn=not slides)

    def torque(self) -> Drawn:
        """What balances the driver: a torque over the angle of a crank, a force over the way of a slider."""
        fine, names = self.dense_cycle, self.words["figure"]
        slides = bool(self.analysis.machine.span)
        curve = charts.Series(self.ledger.symbol("M.eq"), self._across, fine.torque, self._marks)
        mean = self.ledger.number("M.mean").value
        title, across = ("balancing_force", "way") if slides else ("torque", "cycle_angle")
        levels = ((mean, self.ledger.symbol("M.mean")),)
        return Drawn((charts.chart((curve,), names[across], names[title], levels=levels, turn=not slides),))

    def polar(self) -> Drawn:
        """The load of each crank pin in axes that turn with the crank, its radius upwards."""
        fine, machine = self.dense_cycle, self.analysis.machine
        scenes = []
        for side in self.facts.driver_polygon.sides:
            if side.unknown or not side.name.startswith("R"):
                continue
            pin = self.pin_of(side.name)
            radius = fine.motion.points[pin].p - fine.motion.points[self.facts.driver.centre].p
            load = fine.forces.reactions[side.name].force * np.conj(radius / np.abs(radius)) * 1j
            numbers = tuple(map(str, machine.numbered(range(1, machine.positions + 1))))
            series = charts.Series(
                symbols.vector(self.ledger.symbol(f"R.{side.name[1:]}")),
                load.real,
                load.imag,
                self._marks,
                numbers,
            )
            scenes.append(charts.polar(series, "N", title=f"{self.words['figure']['pin']} {pin}"))
        return Drawn(tuple(scenes))


def _guide_angle(analysis: Analysis, group: GroupView) -> float:
    """The direction in which a slider's course counts: away from the crank along its guide."""
    angle = analysis.motion.links[group.j].angle
    return float(angle[0])
