"""Figures of the mechanism: scheme, groups, positions, the gas beside the cylinder, Coriolis."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from reportgen.analysis import FULL_TURN, motion_at
from reportgen.catalogue.loads import Piston
from reportgen.catalogue.machine import Machine
from reportgen.cycle.applied import StrokeIndicator
from reportgen.document.pictured import (
    DENSE,
    SAME,
    SCHEME_BOX,
    SHOWN_AT,
    Drawn,
    Pictured,
    on_paper,
    short,
)
from reportgen.figures import indicator
from reportgen.figures.draft import Draft
from reportgen.figures.forces import Sliding, coriolis
from reportgen.figures.positions import PositionPlan, position_plan
from reportgen.figures.scene import Scene
from reportgen.figures.scheme import groups, scheme
from reportgen.ledger.kinematics.sides import Slide
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.notation import symbols
from reportgen.notation.expressions import Chain, Number, Symbol


class MachinePictures(Pictured):
    """The machine itself, at one position and over a turn."""

    @property
    def figures(self) -> dict[str, Callable[..., Drawn]]:
        return {
            "scheme": self.scheme,
            "groups": self.groups,
            "positions": self.positions,
            "extremes": self.extremes,
            "indicator": self.indicator,
            "coriolis": self.coriolis,
        }

    def scheme(self) -> Drawn:
        machine, motion = self.analysis.machine, self.analysis.motion
        factor = self._reduction()
        scale = self.scale * factor
        return Drawn((scheme(machine.linkage, motion, SHOWN_AT, scale, self.looks(scale, factor)),))

    def groups(self) -> Drawn:
        machine, motion = self.analysis.machine, self.analysis.motion
        factor = self._reduction()
        scale = self.scale * factor
        words = self.words["figure"]
        titles = (
            words["driver"],
            *(words["group"].format(i=group.i, j=group.j) for group in self.facts.groups),
        )
        looks = replace(self.looks(scale, factor), scale=None)
        return Drawn(groups(machine.linkage, motion, SHOWN_AT, scale, looks, titles))

    def _reduction(self) -> float:
        """The ratio 1, 1/2, 1/2.5, … at which the mechanism at μ_l fits the box of a scheme."""
        points = [point.p[SHOWN_AT] for point in self.analysis.motion.points.values()]
        size = np.array(points)[np.isfinite(points)] * self.scale
        needed = max(np.ptp(size.real) / SCHEME_BOX[0], np.ptp(size.imag) / SCHEME_BOX[1], 1.0)
        return 1.0 / float(
            next(step for step in (1, 2, 2.5, 4, 5, 10, 20, 25, 40, 50, 100, 1000) if step >= needed)
        )

    @cached_property
    def dense(self) -> Motion:
        """The motion over one turn, finely."""
        machine = self.analysis.machine
        angles = machine.angles(np.linspace(0.0, FULL_TURN, DENSE))
        return solve_motion(machine.linkage, angles, machine.turn * machine.speed)

    @cached_property
    def one_turn(self) -> Motion:
        """The motion at the numbered positions of one turn."""
        machine = self.analysis.machine
        angles = machine.angles(machine.cycle_angles[: machine.count])
        return solve_motion(machine.linkage, angles, machine.turn * machine.speed)

    def positions(self) -> Drawn:
        return on_paper(self._position_plan(None))

    def _position_plan(self, beside: Draft | None) -> Scene:
        machine = self.analysis.machine
        shows = PositionPlan(
            self._numbered,
            machine.paths if beside is None else (),
            self._first_worked(),
            labels=tuple(map(str, machine.numbered(range(1, machine.count + 1)))),
        )
        looks = replace(self.looks(self.scale), blocks={}, centres=())
        return position_plan(
            machine.linkage, self.one_turn, self.dense, self.scale, shows, looks, beside=beside
        )

    @property
    def _numbered(self) -> tuple[str, ...]:
        """Points that carry the positions' numbers: pins of the crank, joints, of a slotted lever its end."""
        centres = {body.centre for body in self.analysis.machine.linkage.inertias}
        names = [*self.facts.crank_pins]
        for group in self.facts.groups:
            ends = [place.name for place in group.points_j if place.name not in centres]
            names += ends if group.kind == "RPR" else [group.Q]
        return tuple(names)

    def extremes(self) -> Drawn:
        """The mechanism where its first slider turns back: I as its stroke begins, II as it ends."""
        machine = self.analysis.machine
        course = machine.sliders[0]
        motion = motion_at(machine, course.dead_centres[:2] - course.phase)
        shows = PositionPlan(self._numbered, machine.paths, labels=("I", "II"))
        looks = replace(self.looks(self.scale), blocks={}, centres=())
        return on_paper(position_plan(machine.linkage, motion, self.dense, self.scale, shows, looks))

    def _first_worked(self) -> int:
        return (self.facts.worked[0] - 1) % self.analysis.machine.count

    # --- the gas

    def indicator(self) -> Drawn:
        """The diagram in line with the first piston's stroke, every piston's positions read from it."""
        machine = self.analysis.machine
        first = machine.pistons[0]
        unit, scale = 1e4, self.scale
        top, bottom = first.top * scale, first.bottom * scale
        highest = max(float(np.max(gas.pressure)) for gas in self.analysis.gas.values())
        highest = max(highest, _highest(first.indicator)) / unit
        side = self._free_side(first)
        start, end, mu = indicator.beside(top, bottom, side, 75.0, highest)
        symbol = Symbol("μ", "p")
        frame = indicator.Frame(
            start,
            end,
            side,
            mu,
            self.words["figure"]["pressure"],
            Chain((symbol, short(Number(mu, 6, "N/(cm²·mm)")))),
        )
        branches = [
            indicator.Branch(name, x, tuple(p / unit for p in pressures))
            for name, x, pressures in _branches(first, machine, self.words["strokes"])
        ]
        readings = [
            indicator.Reading(
                Symbol(
                    str(machine.position(k + 1)), "" if len(machine.pistons) == 1 else f"({gas.piston.link})"
                ),
                float(gas.fraction[k]),
                float(gas.pressure[k]) / unit,
                top + (bottom - top) * float(gas.fraction[k]) if _in_line(first, gas.piston) else None,
            )
            for gas in self.analysis.gas.values()
            for k in range(machine.positions)
        ]
        return on_paper(self._position_plan(indicator.indicator(frame, branches, readings)))

    def _free_side(self, first: Piston) -> complex:
        """The side of a cylinder that is free for its diagram: away from other cylinders, else to its right."""
        right = 1j * first.inward
        ways = [((one.top + one.bottom) / 2 - first.bottom) / right for one in self.analysis.machine.pistons]
        return right if sum(way.real for way in ways) <= SAME else -right

    def coriolis(self, k: int, side: Slide) -> Drawn:
        """The relative velocity in a turning guide, turned by 90° in the sense of its ω."""
        ledger, pair = self.ledger, f"{side.point}{side.shown}"
        omega = float(ledger[f"turn.omega.{side.turning}"].at(k).real)
        base = complex(self.analysis.motion.points[side.base].v[k - 1])
        relative = complex(self.analysis.motion.points[side.point].v[k - 1]) - base
        sliding = Sliding(
            symbols.point(side.point),
            (Symbol("v", pair, over="vector"), relative),
            (Symbol("a", pair, "k", "vector"), 1j * omega * relative),
            (ledger.symbol(f"omega.{side.turning}"), float(np.sign(omega))),
        )
        return Drawn((coriolis(sliding),))


def _in_line(first: Piston, other: Piston) -> bool:
    """Whether a piston moves on the line of the first one, where its positions are projected from."""
    return abs(((other.top - first.top) / first.inward).imag) + abs((other.inward / first.inward).imag) < SAME


def _highest(table: Any) -> float:
    rows = table.rows if isinstance(table, StrokeIndicator) else (table.pressures,)
    return max(max(row) for row in rows)


def _branches(
    piston: Piston, machine: Machine, names: Sequence[str]
) -> list[tuple[str, tuple[float, ...], tuple[float, ...]]]:
    """Each stroke's line over s/H; a table by crank angle is carried over by the motion of the piston."""
    table = piston.indicator
    if isinstance(table, StrokeIndicator):
        return [(name, table.fractions, row) for name, row in zip(names, table.rows, strict=True)]
    result = []
    edges = (*piston.dead_centres, 2 * FULL_TURN)
    for name, (start, end) in zip(names, pairwise(edges), strict=True):
        angle = np.union1d(np.linspace(start, end, 91), [a for a in table.angles if start < a < end])
        fractions = piston.fraction(motion_at(machine, angle - piston.phase))
        pressure = np.interp(angle, table.angles, table.pressures)
        result.append((name, tuple(map(float, fractions)), tuple(map(float, pressure))))
    return result
