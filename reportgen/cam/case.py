"""A cam as a case: what every output of it is made of."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from reportgen.cam.cam import Parameters, exceeded
from reportgen.cam.solution import CamSolution
from reportgen.drawing.film import Film
from reportgen.drawing.sheet import DrawingSheet
from reportgen.formula import vocabulary
from reportgen.formula.ledger import Ledger
from reportgen.formula.rounding import printed
from reportgen.formula.sheet import Family
from reportgen.report import Document
from reportgen.report.case import Key, Opened, Pitfalls, Span

USUAL_POSITIONS = (2,)
"""What an assignment without positions of its own is understood to work out."""


@dataclass(frozen=True)
class CamCase(Opened):
    """A cam, as a `Case`."""

    @cached_property
    def solution(self) -> CamSolution:
        given: Parameters = self.assignment.parameters
        return CamSolution(given)

    @cached_property
    def ledger(self) -> Ledger:
        sheet = self.solution.sheet
        made = Ledger(sheet.families, sheet.positions, units=self.words["units"], lines=sheet.lines)
        return made.in_language(self.words["symbols"])

    @cached_property
    def printed(self) -> Ledger:
        return printed(self.ledger)

    @property
    def families(self) -> Mapping[str, Family]:
        return self.ledger.families

    @property
    def positions_of_a_turn(self) -> int:
        return len(self.solution.degrees)

    @property
    def speed(self) -> float | None:
        return self.ledger["cam.omega"].at(1) if "cam.omega" in self.ledger else None

    @property
    def balance(self) -> None:
        """It has no forces."""

    @property
    def pitfalls(self) -> Pitfalls:
        return self.solution.pitfalls

    @property
    def worked(self) -> tuple[int, ...]:
        """The positions written out in full: one amid the rise and one amid the return, unless others are named."""
        report, count = self.assignment.report, self.positions_of_a_turn
        if report.worked_positions is None:
            return tuple(range(1, count + 1))
        if "worked_positions" in report.model_fields_set:
            return tuple(int(one) for one in report.worked_positions)
        starts, φ = self.solution.motion.starts, self.solution.φ
        phases = self.solution.motion.phases
        # Beside the middle, where most laws have neither their largest velocity nor acceleration.
        wanted = (0.4 * phases[0], starts["return"] + 0.4 * phases[2])
        return tuple(dict.fromkeys(int(np.abs(φ - at).argmin()) + 1 for at in wanted))

    def fault(self) -> str:
        found = self.solution.designed
        if found.cam.undercut:
            return "cam-undercut"
        return "cam-pressure" if any(exceeded(found)) else ""

    def document(self) -> Document:
        from reportgen.cam.views import report

        return self.bounded(report)

    def key(self) -> Key:
        from reportgen.marking.key import make_key

        count = self.positions_of_a_turn
        labels = tuple(map(str, range(1, count + 1)))
        return make_key(self, self.ledger, self.printed, Span(labels, count, self.worked), self._sense)

    def _sense(self, id: str) -> str:
        family = self.ledger[id]
        return str(next(vocabulary.words_of(self.words["positive"], id, family.kind, family.symbol), ""))

    def task(self, key: Key, by_section: bool = False) -> Document:
        from reportgen.cam.views import task

        return self.bounded(partial(task, key=key, by_section=by_section))

    def results(self) -> dict[str, Any]:
        """The choice of the cam, then its motion and its profile position by position."""
        from reportgen.marking.results import pair, results

        cam, traced, found = self.solution.cam, self.solution.traced, self.solution.designed
        names = ("s", "ds", "dds") if cam.translating else ("psi", "dpsi", "ddpsi")
        omega = self.speed
        positions = []
        for k, phase in enumerate(one.phase for one in self.solution.stretches):
            motion = dict(zip(names, (float(part[k]) for part in (traced.s, traced.ds, traced.dds)), strict=True))
            if omega is not None:
                motion |= {"v": omega * motion[names[1]], "a": omega**2 * motion[names[2]]}
            rho = float(traced.rho[k])
            positions.append(
                {
                    "number": k + 1,
                    "crank_angle": float(traced.φ[k]),
                    "phase": phase,
                    "follower": motion,
                    "pressure_angle": float(traced.alpha[k]),
                    "curvature_radius": rho if np.isfinite(rho) else None,
                    "pitch": pair(complex(traced.pitch[k])),
                    "profile": pair(complex(traced.working[k])),
                }
            )
        sizes = {key: getattr(cam, key) for key in ("r0", "e", "a", "arm", "roller")}
        least = None if found.least is None else {"r0": found.least.r0, "e": found.least.e, "a": found.least.a}
        return results(self, positions, cam=sizes, least=least, undercut=list(cam.undercut))

    def film(self) -> Film:
        from reportgen.cam.film import film

        return film(self)

    def sheets(self, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[DrawingSheet]:
        from reportgen.cam.sheets import drawing_sheets

        return drawing_sheets(self, size, block)
