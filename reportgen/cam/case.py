"""A cam as a case: what every output of it is made of."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from reportgen.cam import animation, views
from reportgen.cam import sheets as sheet_of_cam
from reportgen.cam.file import exceeded
from reportgen.cam.solved import SolvedCam
from reportgen.drawing.animation import Animation
from reportgen.drawing.plates import DrawingPlate
from reportgen.drawing.sheet import DrawingSheet
from reportgen.formula import vocabulary
from reportgen.formula.sheet import Family
from reportgen.report import Block, Document
from reportgen.report.case import DriverMotion, Misconceptions
from reportgen.report.key import Key, Span
from reportgen.report.shafts import Shaft
from reportgen.sheets import on_sheets


@dataclass(frozen=True)
class CamCase(SolvedCam):
    """A cam, as a `Case`."""

    @property
    def families(self) -> Mapping[str, Family]:
        return self.ledger.families

    @property
    def positions_of_a_turn(self) -> int:
        return self.count

    @property
    def driver_motion(self) -> DriverMotion:
        return DriverMotion(self.solution.φ, 2 * np.pi, self.speed)

    @property
    def balance(self) -> None:
        """It has no forces."""

    @property
    def misconceptions(self) -> Misconceptions:
        return self.solution.misconceptions

    def fault(self) -> str:
        found = self.solution.designed
        if found.cam.undercut:
            return "not-to-be-cut"
        return "pressure-angle" if any(exceeded(found)) else ""

    def document(self) -> Document:
        return self.bounded(views.CamPage.report)

    def summary(self) -> Sequence[Block]:
        return self.bounded(views.CamPage.summary)

    @property
    def shafts(self) -> Sequence[Shaft]:
        return (Shaft(self.words["cam"]["shaft"], self.speed, self.solution.cam.turn, fixed=True, datum="n"),)

    def key(self) -> Key:
        from reportgen.marking.key import make_key

        count = self.positions_of_a_turn
        labels = tuple(map(str, range(1, count + 1)))
        return make_key(self, self.ledger, self.printed, Span(labels, count, self.worked), self._sense)

    def _sense(self, id: str) -> str:
        family = self.ledger[id]
        return str(next(vocabulary.words_of(self.words["positive"], id, family.kind, family.symbol), ""))

    def task(self, key: Key, by_section: bool = False) -> Document:
        from reportgen.marking.paper import design_task

        return self.bounded(partial(design_task, of=views.CamPage, key=key, by_section=by_section))

    def results(self) -> dict[str, Any]:
        """The choice of the cam, then its motion and its profile position by position."""
        from reportgen.marking.results import pair, results

        cam, profile, found = self.solution.cam, self.solution.profile, self.solution.designed
        names = ("s", "ds", "dds", "v", "a") if cam.translating else ("psi", "dpsi", "ddpsi", "omega", "epsilon")
        omega = self.speed
        positions = []
        for k, phase in enumerate(one.phase for one in self.solution.intervals):
            motion = dict(
                zip(names[:3], (float(part[k]) for part in (profile.s, profile.ds, profile.dds)), strict=True)
            )
            if omega is not None:
                motion |= {names[3]: omega * motion[names[1]], names[4]: omega**2 * motion[names[2]]}
            rho = float(profile.rho[k])
            positions.append(
                {
                    "number": k + 1,
                    "crank_angle": float(profile.φ[k]),
                    "phase": phase,
                    "follower" if cam.translating else "swing": motion,
                    "pressure_angle": float(profile.alpha[k]),
                    "curvature_radius": rho if np.isfinite(rho) else None,
                    "pitch": pair(complex(profile.pitch[k])),
                    "profile": pair(complex(profile.working[k])),
                }
            )
        sizes = {key: getattr(cam, key) for key in ("r0", "e", "a", "arm", "roller")}
        least = None if found.least is None else {"r0": found.least.r0, "e": found.least.e, "a": found.least.a}
        return results(self, positions, cam=sizes, least=least, undercut=list(cam.undercut))

    def animations(self) -> tuple[Animation, ...]:
        return (animation.animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """There are no sets of them to choose from."""
        return {"cam": list(sheet_of_cam.plates(self))}

    def true_sizes(self) -> Sequence[DrawingSheet]:
        return (sheet_of_cam.true_size(self.solution.cam),)

    def sheets(
        self, size: str = "", sets: Collection[str] = (), block: Path | None = None, every: bool = False
    ) -> list[DrawingSheet]:
        return [*on_sheets(self, self.plates(), size, block), *self.true_sizes()]
