"""Figures of the flywheel's chapter: torques, work and inertia over the cycle, Wittenbauer's diagram, speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from reportgen.cycle.flywheel import Flywheel
from reportgen.document.pictured import Drawn
from reportgen.figures import charts
from reportgen.figures.scene import Scene
from reportgen.ledger.core import Ledger
from reportgen.notation.expressions import Symbol

THINNED = 4
"""Every fourth of the samples is enough for a curve."""
NARROW = 1e-3
"""Below this share of J_r its variation is no width for a diagram, and the lines are drawn from the axis on."""


@dataclass(frozen=True)
class FlywheelFigures:
    """The four figures; `flywheel` is None for a machine without."""

    flywheel: Flywheel | None
    ledger: Ledger
    words: Mapping[str, Any]

    @property
    def figures(self) -> dict[str, Callable[..., Drawn]]:
        if self.flywheel is None:
            return {}
        return {
            "flywheel-torque": self.torque,
            "flywheel-work": self.work,
            "wittenbauer": self.wittenbauer,
            "flywheel-speed": self.speed,
        }

    @property
    def _found(self) -> Flywheel:
        assert self.flywheel is not None
        return self.flywheel

    def _over_cycle(
        self, values: np.ndarray, name: str, levels: tuple[tuple[float, Symbol], ...] = ()
    ) -> Scene:
        found, names = self._found, self.words["figure"]
        kept = np.union1d(np.arange(0, values.size, THINNED), values.size - 1)
        curve = charts.Series("", np.degrees(found.angle[kept]), values[kept])
        return charts.chart((curve,), names["cycle_angle"], names[name], levels=levels)

    def torque(self) -> Drawn:
        """M_r and the torque that balances its mean."""
        found = self._found
        level = (-found.constant, Symbol("−M", "c"))
        return Drawn((self._over_cycle(found.torque, "reduced_torque", (level,)),))

    def work(self) -> Drawn:
        """J_r, if moving links have mass, and A over the cycle."""
        found = self._found
        inertia = (self._over_cycle(found.inertia, "reduced_inertia"),) if "J.r" in self.ledger else ()
        return Drawn((*inertia, self._over_cycle(found.work, "excess_work")))

    def wittenbauer(self) -> Drawn:
        """A over J_r with the two lines whose slopes are half the squares of the bounds of speed."""
        found, names = self._found, self.words["figure"]
        ends = np.array([found.inertia.min(), found.inertia.max()])
        if np.ptp(ends) < NARROW * ends[1]:
            ends = np.array([0.0, 1.2 * ends[1]])
        lines = [
            charts.Series(self.ledger.symbol(id), ends, height + bound**2 / 2 * ends)
            for id, height, bound in (
                ("omega.max", found.upper, found.fastest),
                ("omega.min", found.lower, found.slowest),
            )
        ]
        touching = (found.high, found.low)
        curve = charts.Series(Symbol("A"), found.inertia, found.work, touching)
        return Drawn(
            (charts.chart((curve, *lines), names["reduced_inertia"], names["excess_work"], turn=False),)
        )

    def speed(self) -> Drawn:
        """How far the speed is from its mean, in percent, with the flywheel."""
        found = self._found
        mean = (found.fastest + found.slowest) / 2
        return Drawn((self._over_cycle((found.speed / mean - 1) * 100, "speed_deviation"),))
