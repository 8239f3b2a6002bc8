"""`CamCase`: a cam as a `Case`, the source of all its outputs."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.cam import animation, views
from reportgen.cam import sheets as sheet_of_cam
from reportgen.cam.file import exceeded
from reportgen.cam.solution import SolvedCam
from reportgen.case import DriverMotion, Misconceptions
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.drawing.animation import Animation
from reportgen.drawing.drawing_sheet import DrawingSheet
from reportgen.drawing.plates import DrawingPlate


@dataclass(frozen=True)
class CamCase(SolvedCam):
    """A solved cam, as a `Case`."""

    PAGE = views.CamPage

    @property
    def driver_motion(self) -> DriverMotion:
        return DriverMotion(self.solution.φ, 2 * np.pi, str(self.words["cam"]["angle"]), self.speed)

    @property
    def misconceptions(self) -> Misconceptions:
        return self.solution.misconceptions

    def fault(self) -> str:
        designed = self.solution.designed
        if designed.cam.undercut:
            return "not-to-be-cut"
        return "pressure-angle" if any(exceeded(designed)) else ""

    @property
    def shafts(self) -> Sequence[Shaft]:
        return (Shaft(self.words["cam"]["shaft"], self.speed, self.solution.cam.turn, fixed=True, datum="n"),)

    @cached_property
    def entries(self) -> ResultEntries:
        """Return the chosen lengths of the cam, then its motion and its profile position by position."""
        cam, profile, designed = self.solution.cam, self.solution.profile, self.solution.designed
        names = ("s", "ds", "dds", "v", "a") if cam.translating else ("psi", "dpsi", "ddpsi", "omega", "epsilon")
        omega = self.speed
        positions = []
        for k, phase in enumerate(one.phase for one in self.solution.intervals):
            motion = dict(zip(names[:3], (part[k] for part in (profile.s, profile.ds, profile.dds)), strict=True))
            if omega is not None:
                motion |= {names[3]: omega * motion[names[1]], names[4]: omega**2 * motion[names[2]]}
            positions.append(
                {
                    "number": k + 1,
                    "crank_angle": profile.φ[k],
                    "phase": phase,
                    "follower" if cam.translating else "swing": motion,
                    "pressure_angle": profile.alpha[k],
                    "curvature_radius": profile.rho[k] if np.isfinite(profile.rho[k]) else None,
                    "pitch": profile.pitch[k],
                    "profile": profile.working[k],
                }
            )
        sizes = {key: getattr(cam, key) for key in ("r0", "e", "a", "arm", "roller")}
        least = (
            None if designed.least is None else {"r0": designed.least.r0, "e": designed.least.e, "a": designed.least.a}
        )
        return ResultEntries(positions, {"cam": sizes, "least": least, "undercut": list(cam.undercut)})

    def animations(self) -> tuple[Animation, ...]:
        return (animation.animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the drawings; there are no sets to choose from."""
        return {"cam": list(sheet_of_cam.plates(self))}

    def true_sizes(self) -> Sequence[DrawingSheet]:
        return (sheet_of_cam.true_size(self.solution.cam),)
