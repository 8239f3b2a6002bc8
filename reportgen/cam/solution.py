"""`SolvedCam`: a cam with its words and its numbers, the source of its drawings and texts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.cam.file import Parameters
from reportgen.cam.ledger import CamSolution
from reportgen.case.design_case import DesignCase
from reportgen.formula.calculation import Calculation


@dataclass(frozen=True)
class SolvedCam(DesignCase):
    """An assignment of a cam with its ledger; each value is computed on first use."""

    @cached_property
    def solution(self) -> CamSolution:
        given: Parameters = self.assignment.parameters
        return CamSolution(given)

    @property
    def calculation(self) -> Calculation:
        return self.solution.calculation

    @property
    def speed(self) -> float | None:
        """Return the cam's speed (rad/s); None if it is not given."""
        return self.ledger["cam.omega"].at(1) if "cam.omega" in self.ledger else None

    @property
    def worked(self) -> tuple[int, ...]:
        """Return the positions worked out in full: one within the rise and one within the return, unless the file names
        others.
        """
        report, count = self.assignment.report, self.count
        if report.worked_positions is None:
            return tuple(range(1, count + 1))
        if "worked_positions" in report.model_fields_set:
            return tuple(one for one in map(int, report.worked_positions) if one <= count)
        starts, φ = self.solution.motion.starts, self.solution.φ
        phases = self.solution.motion.phases
        # Away from the middle, where most laws have no acceleration.
        wanted = (0.3 * phases[0], starts["return"] + 0.3 * phases[2])
        return tuple(dict.fromkeys(int(np.abs(φ - at).argmin()) + 1 for at in wanted))
