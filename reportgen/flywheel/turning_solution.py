"""A turning-moment exercise with its ledger, its curves over the cycle, and common mistakes in its quantities."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.flywheel import turning_ids as names
from reportgen.flywheel.turning_calculation import TurningCalculation
from reportgen.flywheel.turning_file import Parameters
from reportgen.flywheel.turning_torques import DRIVING, RESISTING, SteadyRun, both_torques, cycle_of, steady_run
from reportgen.formula import PI, Expression, Number, Ref, Symbol, call
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import Ledger, MistakenValues


@dataclass(frozen=True)
class SolvedTurning(DesignCase):
    """An assignment of a turning-moment diagram with its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @cached_property
    def calculation(self) -> Calculation:
        return TurningCalculation(self.given).written()

    @cached_property
    def ledger(self) -> Ledger:
        sheet = self.calculation
        numbers = range(1, self.count_of_areas + 1)
        # An energy is a sum of areas, so both have one number of decimals, and equal energies look equal.
        same = ((*map(names.area, numbers), *map(names.energy, numbers), *self.extremes),)
        made = Ledger(sheet.families, sheet.positions, units=self.unit_names, same=same, lines=sheet.lines)
        return made.in_language(self.words["symbols"])

    @property
    def speed(self) -> float:
        """Mean angular velocity (rad/s)."""
        return self.given.n.si

    @cached_property
    def run(self) -> SteadyRun:
        """The steady run, of a machine with diagrams."""
        return steady_run(self.given)

    @cached_property
    def cycle(self) -> float:
        """The cycle (rad), of a machine with diagrams."""
        return cycle_of(self.given)

    @property
    def count_of_areas(self) -> int:
        return len(self.run.areas) if self.given.areas is None else len(self.given.areas.values)

    @property
    def extremes(self) -> tuple[str, str]:
        """Ids of the greatest and the least energy."""
        return names.extreme("max"), names.extreme("min")

    @cached_property
    def areas(self) -> tuple[float, ...]:
        """The areas in order (J)."""
        return tuple(float(self.ledger[names.area(k)].at(1)) for k in range(1, self.count_of_areas + 1))

    @cached_property
    def energies(self) -> tuple[float, ...]:
        """The energy at each point above that at the first (J)."""
        return tuple(float(self.ledger[names.energy(k)].at(1)) for k in range(1, self.count_of_areas + 1))

    @cached_property
    def curves(self) -> tuple[Floats, Floats, Floats]:
        """Angles (rad), driving and resisting torque (N·m), each [N]; a jump has two values at one angle."""
        return both_torques(self.given, self.run)

    @cached_property
    def work(self) -> Floats:
        """The energy (J) [N] taken up from the start of the cycle to each angle of `curves`."""
        φ, driving, resisting = self.curves
        above = driving - resisting
        work = np.concatenate(([0.0], np.cumsum((above[1:] + above[:-1]) / 2 * np.diff(φ))))
        # The trapezoid rule misses a little between two points; each piece gets its own area.
        known = np.array([*self.energies, self.energies[-1] + self.areas[-1]])
        at = np.append(np.searchsorted(φ, self.run.points), len(φ) - 1)
        corrected: Floats = work + np.interp(φ, φ[at], known - work[at])
        return corrected

    def torque_symbol(self, side: str) -> Symbol:
        """Return the symbol of the driving or the resisting torque: M_m for one that is constant at the mean."""
        torques = self.given.driving if side == DRIVING else self.given.resisting
        varies = torques is not None and bool(torques.terms or torques.nodes)
        varies = varies or (side == RESISTING and self.given.follows_speed)
        return Symbol("M", side) if varies else self.printed.symbol(names.MEAN)

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Common mistakes: δ as half the range, energies of one area, mean line left out, scales, rpm, degrees."""
        changed: dict[str, list[tuple[str, Expression]]] = {}
        for id, name, formula in (*self._of_wheel(), *self._of_energies(), *self._of_areas()):
            if id in self.ledger and self.ledger[id].definition is not None:
                changed.setdefault(id, []).append((name, formula))
        return Misconceptions(changed=changed)

    def _of_wheel(self) -> MistakenValues:
        ΔE, ω, δ = Ref(names.RANGE), Ref(names.OMEGA), Ref(names.DELTA)
        J, n, k = Ref(names.J), Ref(names.N), Ref(names.RADIUS)
        if self.given.delta is not None:
            yield J.id, "turning-delta-doubled", ΔE / (2 * δ * ω**2)
            yield J.id, "turning-delta-halved", 2 * ΔE / (δ * ω**2)
            yield J.id, "turning-speed-once", ΔE / (δ * ω)
            yield J.id, "turning-rpm", ΔE / (δ * n**2)
            yield names.MASS, "turning-radius-once", J / k
        else:
            yield δ.id, "turning-delta-doubled", ΔE / (2 * J * ω**2)
            yield δ.id, "turning-delta-halved", 2 * ΔE / (J * ω**2)
            yield δ.id, "turning-speed-once", ΔE / (J * ω)
            yield δ.id, "turning-rpm", ΔE / (J * n**2)
            yield J.id, "turning-radius-once", Ref(names.MASS) * k
        for bound, sense in (("max", 1.0), ("min", -1.0)):
            yield names.speed(bound), "turning-delta-doubled", ω * (1 + sense * δ)

    def _of_energies(self) -> MistakenValues:
        A = [Ref(names.area(k)) for k in range(1, self.count_of_areas + 1)]
        E = [Ref(names.energy(k)) for k in range(1, self.count_of_areas + 1)]
        sizes = [call("size", area) for area in A]
        high, low = map(Ref, self.extremes)
        yield names.RANGE, "turning-largest-area", call("max", *sizes)
        yield names.RANGE, "turning-one-extreme", high
        yield names.RANGE, "turning-one-extreme", -low
        yield names.RANGE, "turning-extremes-added", high + low
        yield high.id, "turning-area-for-energy", call("max", *A)
        yield low.id, "turning-area-for-energy", call("min", *A)
        for k in range(2, len(E)):
            yield E[k].id, "turning-area-for-energy", A[k - 1]
            yield E[k].id, "turning-not-signed", E[k - 1] + call("size", A[k - 1])
        if Ref(names.WORK).id in self.ledger:
            turn = Number(360.0, unit="°")
            if abs(self.cycle - 2 * np.pi) > 1e-9:
                yield names.WORK, "turning-cycle", Ref(names.MEAN) * turn

    def _of_areas(self) -> MistakenValues:
        for k in range(1, self.count_of_areas + 1):
            if names.on_paper(k) in self.ledger:
                F = Ref(names.on_paper(k))
                yield names.area(k), "turning-scale-left-out", F * 1.0
                yield names.area(k), "turning-torque-scale", F * Ref(names.scale("M"))
        if names.scale("A") in self.ledger:
            μ_M, μ_φ = Ref(names.scale("M")), Ref(names.scale("phi"))
            yield names.scale("A"), "turning-degrees", μ_M * μ_φ * Number(180.0) / PI
            if abs(np.degrees(float(self.ledger[μ_φ.id].at(1))) - 1) > 1e-9:
                yield names.scale("A"), "turning-torque-scale", μ_M
        yield from self._without_mean()

    def _without_mean(self) -> Iterator[tuple[str, str, Expression]]:
        """Yield areas that are measured from the axis, not from the mean line."""
        if names.MEAN not in self.ledger:
            return
        ends = [*map(names.point, range(1, self.count_of_areas + 1)), names.CYCLE]
        for k in range(1, self.count_of_areas + 1):
            definition = self.ledger[names.area(k)].definition
            if definition is not None:
                work = Ref(names.MEAN) * (Ref(ends[k]) - Ref(ends[k - 1]))
                yield names.area(k), "turning-no-mean", definition + work
