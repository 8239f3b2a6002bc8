"""A spur wheel as a rack cuts it: its circles, the involute flank, and the fillet of the rack's rounded tip (`Wheel`).

Points are complex (m) about the wheel's centre; the middle of a tooth lies on the real axis.  The rack's datum line is
x m outside the reference circle, on which its pitch line rolls without slip; the normal at every point that the rack
cuts passes through the pitch point.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record
from reportgen.formula.array_evaluation import model
from reportgen.formula.constructions import Value
from reportgen.gears import gears_ids
from reportgen.gears.pair_formulas import Rack, pair_calculation

CHORD = 1e-6
"""Largest distance of a profile's polyline from it (m)."""
SPREAD, CURVED = 1.5, 6.0
"""A fillet turns by less than this (rad), and its radius of curvature is below this many modules."""


def crossing(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the zero of a function that is negative at `low` and positive at `high`, by bisection to the last bit."""
    while low != (middle := (low + high) / 2) and middle != high:
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return middle


class Wheel(Record, dict=True):
    """A wheel of `z` teeth of module `m` (m), cut by a rack shifted by x m, its tips turned to the radius `r_a` (m)."""

    rack: Rack
    m: float
    z: int
    x: float
    r_a: float

    def _of(self, *wanted: str, d_a: Value) -> list[Value]:
        """Return quantities of a wheel (SI) by the formulas of a pair, with tips turned to the diameter `d_a` (m)."""
        sheet = pair_calculation(self.rack, self.m, (self.z, self.z))
        names = [gears_ids.of_wheel(one, 1) for one in wanted]
        values = model(sheet, names, **{gears_ids.of_wheel("x", 1): self.x, gears_ids.of_wheel("d_a", 1): d_a})
        return [values[name] for name in names]

    @cached_property
    def _blank(self) -> tuple[float, ...]:
        """Return the radii (m) of the reference, base and root circles, and of curvature where the involute begins."""
        d, d_b, d_f, rho_f = self._of("d", "d_b", "d_f", "rho_f", d_a=2 * self.r_a)
        return float(d) / 2, float(d_b) / 2, float(d_f) / 2, float(rho_f)

    @property
    def r(self) -> float:
        """Return the reference radius (m)."""
        return self._blank[0]

    @property
    def r_b(self) -> float:
        """Return the base radius (m)."""
        return self._blank[1]

    @property
    def r_f(self) -> float:
        """Return the root radius (m)."""
        return self._blank[2]

    @property
    def pitch(self) -> float:
        """Return the angle of a tooth with its space (rad)."""
        return 2 * math.pi / self.z

    # --- the flank

    def half_angle(self, r: Floats) -> Floats:
        """Return half the angle of a tooth (rad) at radii [...] (m): s_a/d_a of a wheel turned to that radius."""
        turned_to = np.maximum(2 * np.asarray(r), 2 * self.r_b)
        (thickness,) = self._of("s_a", d_a=turned_to)
        return np.asarray(thickness / turned_to)

    def flank(self, r: Floats) -> Complexes:
        """Return points (m) [...] of the flank on the left of the tooth at radii [...] (m)."""
        return np.asarray(r * np.exp(1j * self.half_angle(r)))

    # --- the fillet

    def fillet(self, ψ: Floats) -> Complexes:
        """Return the points (m) [N] that the rack's rounding cuts where its outward normal has the angle ψ [N], −π/2 to
        −α (rad).

        The normal through the centre of the rounding, y below the pitch line, passes through the pitch point: their
        distance is y/sin ψ.
        """
        m, r, ρ = self.m, self.r, self.m * self.rack.rounding
        y = m * (self.x - self.rack.ha - self.rack.c) + ρ
        distance = y / np.sin(ψ)
        rolled = distance * np.cos(ψ) - m * self.rack.land
        cut = 1j * r + (distance + ρ) * np.exp(1j * np.asarray(ψ))
        # From the middle of a space upwards to the middle of a tooth, which is on the real axis.
        return np.asarray(cut * np.exp(1j * (rolled / r + self.pitch / 2 - math.pi / 2)))

    @cached_property
    def join(self) -> tuple[float, float]:
        """Return the direction ψ (rad) and radius (m) at which fillet and flank meet; they touch unless the tooth is
        undercut.
        """
        α, begun = self.rack.alpha, self._blank[3]
        if begun >= 0:
            return -α, math.hypot(self.r_b, begun)

        def beyond(ψ: float) -> float:
            cut = complex(self.fillet(np.array(ψ)))
            return float(np.angle(cut) - self.half_angle(np.array(abs(cut))))

        base = crossing(lambda ψ: abs(complex(self.fillet(np.array(ψ)))) - self.r_b, -math.pi / 2, -α)
        ψ = crossing(beyond, base, -α)
        return ψ, float(abs(self.fillet(np.array(ψ))))

    @property
    def undercut(self) -> bool:
        return self.join[0] != -self.rack.alpha

    # --- a tooth, the wheel

    def side(self, chord: float = CHORD) -> tuple[Complexes, Complexes]:
        """Return the fillet from the root circle and the flank to the tip (m) [N]; no chord is farther off than `chord`
        (m).
        """
        ψ, start = self.join
        steps = math.ceil(SPREAD * math.sqrt(CURVED * self.m / (8 * chord)))
        fillet = self.fillet(np.linspace(-math.pi / 2, ψ, steps + 1))
        # Equal steps of the roll angle t: ds = ρ dt, and the sagitta of a chord is ρ dt²/8.
        low, high = (math.sqrt(max(r**2 - self.r_b**2, 0.0)) / self.r_b for r in (start, self.r_a))
        steps = math.ceil((high - low) / math.sqrt(8 * chord / (self.r_b * high)))
        return fillet, self.flank(self.r_b * np.hypot(1.0, np.linspace(low, high, steps + 1)))

    def tooth(self, chord: float = CHORD) -> Complexes:
        """Return a tooth clockwise (m) [N], from the middle of the space on its left to the middle of that on its
        right.
        """
        fillet, flank = self.side(chord)
        steps = max(math.ceil(self.pitch * math.sqrt(self.r_a / (8 * chord)) / 2), 2)
        root = self.r_f * np.exp(1j * np.linspace(self.pitch / 2, np.angle(fillet[0]), steps))
        tip = self.r_a * np.exp(1j * np.linspace(np.angle(flank[-1]), 0.0, steps))
        left = np.concatenate((root[:-1], fillet[:-1], flank[:-1], tip))
        return np.concatenate((left, left[-2::-1].conjugate()))

    def outline(self, chord: float = CHORD) -> Complexes:
        """Return all teeth, clockwise, as a closed polyline (m) [N]."""
        turns = np.exp(-1j * self.pitch * np.arange(self.z))
        return np.asarray((turns[:, None] * self.tooth(chord)[:-1]).ravel())
