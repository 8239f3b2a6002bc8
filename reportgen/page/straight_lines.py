"""Errors of the straight lines that a page draws between two samples of a machine."""

from __future__ import annotations

import numpy as np

from reportgen.base.units import MM
from reportgen.drawing.animation import Errors
from reportgen.machine.analysis import Analysis, analyse
from reportgen.machine.load_laws import FULL_TURN


def errors_between(at: Analysis, scale: float, beside: float) -> Errors:
    """Return the errors of straight lines between the samples `at`, for a drawing of `scale` mm per metre.

    For places, the bound (mm) is h²/8 times the largest second derivative by the driver's angle, the acceleration
    over ω². For rates and forces, it is the largest difference (share) in the middle between samples, without jumps:
    the two sides of a jump are less than 4 `beside` (rad) apart.
    """
    machine, angles = at.machine, at.cycle_angle
    steps = np.diff(angles)
    wide = steps > 4 * beside
    between = analyse(machine, (angles[1:] + angles[:-1]) / 2)
    rate = FULL_TURN * machine.speed / (machine.cycle_travel / machine.turns)
    bound = 0.0
    for name, moved in at.motion.points.items():
        here = np.abs(np.concatenate((moved.a, between.motion.points[name].a)))
        bound = max(bound, float(np.nanmax(here)) / rate**2 * float(steps.max()) ** 2 / 8)
    pairs = [
        (getattr(at.motion.points[name], what), getattr(moved, what))
        for name, moved in between.motion.points.items()
        for what in ("v", "a")
    ]
    pairs += [(at.forces.reactions[name].force, one.force) for name, one in between.forces.reactions.items()]
    share = 0.0
    for samples, true in pairs:
        greatest = float(np.nanmax(np.abs(samples)))
        if greatest > 0:
            off = np.abs((samples[1:] + samples[:-1]) / 2 - true)[wide]
            share = max(share, float(np.nanmax(off)) / greatest)
    crank = machine.drawn * MM or machine.span * scale or 1.0
    return Errors(bound * scale, crank, share)
