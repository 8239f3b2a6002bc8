"""Tooth numbers of planetary trains with one carrier: the ratio by Willis, and all numbers that can be built
(`choice`).

Wheel 1 meshes with satellite 2; satellite 2′ on the same shaft meshes with wheel 3, which is fixed; the carrier H bears
the satellites.  With a single satellite, 2′ is 2.  Relative to the carrier all axes are fixed, so that
 u₁₃(H) = (ω₁ − ω_H)/(ω₃ − ω_H) = ± z₂z₃/(z₁z₂′),  and with ω₃ = 0  u₁H = ω₁/ω_H = 1 − u₁₃(H).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Flags
from reportgen.base.records import Record, replace
from reportgen.base.template_access import template_members
from reportgen.formula.evaluation import inv
from reportgen.gears import train_formulas as formulas
from reportgen.gears.train_formulas import OTHER, WHEELS, TrainScheme, over_teeth

Wholes = NDArray[np.int64]

ALPHA = math.radians(20)
"""The profile angle of the basic rack (rad); its addendum is the module."""
LEAST_OUTER = 17
"""A wheel with fewer outer teeth is undercut: 2/sin²α = 17.1."""
LEAST_DIFFERENCE = 8
"""Least excess of an inner wheel's teeth over its satellite's, by the usual rule."""
MOST_SATELLITES = 8
DUST = 1e-12
"""Ratios of whole numbers that differ by less are equal."""
FITS = 1e-6
"""Largest distance (in pitches) of teeth from their gaps at which they still fit."""
CONDITIONS = ("ratio", "interference", "neighbours", "assembly")
"""Conditions on tooth numbers, in the order in which they are checked."""


SCHEMES: Mapping[str, TrainScheme] = {
    "single": TrainScheme((False, True), single=True),
    "double": TrainScheme((False, True)),
    "double-outer": TrainScheme((False, False)),
    "double-inner": TrainScheme((True, True)),
}


class Teeth(NamedTuple):
    """The numbers of teeth z₁, z₂, z₂′, z₃."""

    z1: int
    z2: int
    z2_prime: int
    z3: int


class Demand(Record):
    """A demand: a ratio u₁H within a relative tolerance, a number of satellites, limits of tooth numbers, and m/m₂.

    The tolerance applies to the ratio from the driving to the driven shaft: to u_H1 = 1/u₁H if the carrier drives.
    """

    scheme: str
    ratio: float
    tolerance: float
    satellites: int
    least: int
    most: int
    modules: Fraction = Fraction(1)
    by_carrier: bool = False
    outer: int = LEAST_OUTER
    """The least number of outer teeth; below `LEAST_OUTER` wheels are undercut unless their profiles are shifted."""

    @property
    def of(self) -> TrainScheme:
        return SCHEMES[self.scheme]

    def off(self, ratio: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """Return the relative error of trains with u₁H [...] against the requested ratio."""
        asked = np.asarray(ratio, float)
        with np.errstate(divide="ignore"):
            missed: NDArray[np.float64] = np.abs((self.ratio / asked if self.by_carrier else asked / self.ratio) - 1)
        return missed


class Train(Record):
    """Tooth numbers in a scheme, with their ratio and the quantities in the conditions."""

    scheme: str
    teeth: Teeth
    modules: Fraction = Fraction(1)

    @property
    def ratio(self) -> Fraction:
        """Return u₁H with wheel 3 at rest, exactly: only one fraction over z₁z₂′ lies within rounding error of its
        value.
        """
        z = self.teeth
        (exact,) = ratios(SCHEMES[self.scheme], np.array([z]).T)
        return Fraction(float(exact)).limit_denominator(z.z1 * z.z2_prime)

    @property
    def undercut(self) -> Mapping[str, int]:
        """Return the numbers of outer teeth below `LEAST_OUTER`, by their wheels."""
        z, scheme = self.teeth, SCHEMES[self.scheme]
        outer = {"1": not scheme.inner[0], "2": True, OTHER: not scheme.single, "3": not scheme.inner[1]}
        numbers = dict(zip(WHEELS, z, strict=True))
        return {wheel: numbers[wheel] for wheel in WHEELS if outer[wheel] and numbers[wheel] < LEAST_OUTER}

    @property
    def size(self) -> float:
        """Return the diameter of the circle that the satellites' reference circles touch from inside, in modules m₂."""
        return float(sizes(SCHEMES[self.scheme], np.array([self.teeth]).T, self.modules)[0])

    def turns(self, satellites: int) -> int | None:
        """Return the least P ≥ 0 that makes u₁H z₁ (1 + kP)/k whole, for k satellites; None if there is none."""
        lowest = self.ratio * self.teeth.z1 / satellites
        if math.gcd(lowest.denominator, satellites) > 1:
            return None
        return pow(-satellites, -1, lowest.denominator)

    @property
    def satellites(self) -> tuple[int, ...]:
        """Return the numbers of satellites that have room and can be assembled."""
        rows = np.array([self.teeth]).T
        return tuple(
            k
            for k in range(2, MOST_SATELLITES + 1)
            if _neighbours(SCHEMES[self.scheme], rows, k, self.modules)[0] and self.turns(k) is not None
        )


# --- conditions over many trains, z [4, N] ---------------------------------------------------------------


def ratios(scheme: TrainScheme, z: Wholes) -> NDArray[np.float64]:
    """Return u₁H = 1 ± z₂z₃/(z₁z₂′) [N] of tooth numbers [4, N], by Willis with ω₃ = 0."""
    return over_teeth(formulas.ratio, scheme, z)


def axis(scheme: TrainScheme, z: Wholes) -> NDArray[np.float64]:
    """Return twice the distance between the axes of wheel 1 and satellite 2 [N], in modules."""
    return over_teeth(formulas.first_axes, scheme, z)


def _interference(scheme: TrainScheme, z: Wholes, outer: int) -> Flags:
    """Return flags [N]: outer wheels have at least `outer` teeth, inner wheels exceed their satellites by the usual
    number of teeth.
    """
    holds: Flags = (z[1] >= outer) & (z[2] >= outer)
    for inner, wheel, satellite in zip(scheme.inner, (z[0], z[3]), (z[1], z[2]), strict=True):
        holds &= wheel - satellite >= LEAST_DIFFERENCE if inner else wheel >= outer
    return holds


def _neighbours(scheme: TrainScheme, z: Wholes, k: int, modules: Fraction) -> Flags:
    """Return flags [N]: the tips of neighbouring satellites leave a gap, (z + 2)/(z₁ ± z₂) < sin(π/k) for both
    wheels.
    """
    room = math.sin(math.pi / k) * axis(scheme, z)
    tip = over_teeth(formulas.tip_of_satellite, scheme, z)
    other_tip = over_teeth(formulas.tip_of_other_satellite, scheme, z)
    holds: Flags = (tip < room) & (other_tip / float(modules) < room)
    return holds


def _assembly(u: NDArray[np.float64], z: Wholes, k: int) -> Flags:
    """Return flags [N]: u₁H z₁ (1 + kP)/k is whole for some whole P; then the denominator of u₁H z₁/k has no factor of
    k.
    """
    z1, _, z2p, _ = z
    # Willis's ratio is a fraction over z₁z₂′, which rounding recovers exactly.
    above = np.rint(u * z1 * z2p).astype(np.int64)
    below = k * z2p // np.gcd(above, k * z2p)
    holds: Flags = np.gcd(below, k) == 1
    return holds


def unshifted(scheme: TrainScheme, z: Wholes) -> Flags:
    """Return flags [N] of the trains whose inner meshes work without profile shift.

    No tip passes beyond an involute: the inner wheel's tip circle passes outside the point where the line of action
    touches the satellite's base circle.  No tips collide elsewhere: where both tip circles meet, the satellite's tooth
    has passed that of the inner wheel.  The report prints only the result, so the formulas are not in the calculation.
    """
    holds = np.ones(len(z[0]), bool)
    for inner, wheel, satellite in zip(scheme.inner, (z[0], z[3]), (z[1], z[2]), strict=True):
        if not inner:
            continue
        a = (wheel - satellite) / 2
        base2, base3 = satellite / 2 * math.cos(ALPHA), wheel / 2 * math.cos(ALPHA)
        tip2, tip3 = satellite / 2 + 1, wheel / 2 - 1
        with np.errstate(all="ignore"):
            at2, at3 = np.arccos(base2 / tip2), np.arccos(base3 / tip3)
            δ2 = np.arccos((tip3**2 - tip2**2 - a**2) / (2 * a * tip2))
            δ3 = np.arccos((tip3**2 + a**2 - tip2**2) / (2 * a * tip3))
            past = satellite * (inv(at2) + δ2) - wheel * (inv(at3) + δ3) + (wheel - satellite) * inv(ALPHA)
        involute = tip3**2 >= base3**2 + (a * math.sin(ALPHA)) ** 2
        # Where the tip circles do not meet, δ is NaN and tips cannot meet either.
        holds &= involute & ~(past < 0)
    return holds


def judged(demand: Demand, z: Wholes) -> Mapping[str, Flags]:
    """Return flags [N] of the trains that fulfil each of the conditions, by the name of the condition."""
    scheme, k = demand.of, demand.satellites
    u = ratios(scheme, z)
    return {
        "ratio": demand.off(u) <= demand.tolerance + DUST,
        "interference": _interference(scheme, z, demand.outer),
        "neighbours": _neighbours(scheme, z, k, demand.modules),
        "assembly": _assembly(u, z, k),
    }


# --- all tooth numbers ------------------------------------------------------------------------------------


def coaxial(demand: Demand) -> Iterator[Wholes]:
    """Yield all tooth numbers within the limits that have one axis, m(z₁ ± z₂) = m₂(z₃ ± z₂′), in blocks [N, 4]."""
    scheme = demand.of
    first, second = scheme.signs
    every = np.arange(demand.least, demand.most + 1, dtype=np.int64)
    z2, z2p = (every, every) if scheme.single else (part.ravel() for part in np.meshgrid(every, every))
    top, below = demand.modules.numerator, demand.modules.denominator
    for z1 in every:
        apart = top * (z1 - first * z2)
        z3 = apart // below + second * z2p
        kept = (apart > 0) & (apart % below == 0) & (z3 >= demand.least) & (z3 <= demand.most)
        yield np.column_stack((np.full(kept.sum(), z1), z2[kept], z2p[kept], z3[kept]))


@template_members("first", "left")
@dataclass(frozen=True, eq=False)
class TrainChoice:
    """Tooth numbers [N, 4] that fulfil a demand, by size, with the number left after each condition."""

    demand: Demand
    sets: Wholes
    free: Flags
    """Flags [N] of the trains that need no profile shift."""
    left: Mapping[str, int]
    nearest: Train | None
    """The coaxial train, free of interference, whose ratio is nearest."""
    refused: Mapping[str, Train]
    """The smallest train that fulfils every condition except the named one, by name."""

    @property
    def first(self) -> int:
        """Return the number (from 0) of the smallest train, preferably one that needs no profile shift."""
        return int(np.argmax(self.free)) if self.free.any() else 0

    def train(self, number: int) -> Train:
        return _train(self.demand, self.sets[number])

    @property
    def chosen(self) -> Train:
        return self.train(self.first)


def _train(demand: Demand, row: Wholes) -> Train:
    return Train(demand.scheme, Teeth(*map(int, row)), demand.modules)


def sizes(scheme: TrainScheme, z: Wholes, modules: Fraction) -> NDArray[np.float64]:
    """Return the diameter [N] of the circle around the satellites' reference circles, in modules m₂; an inner wheel
    lies on it.
    """
    m = float(modules)
    circle: NDArray[np.float64] = axis(scheme, z) * m + np.maximum(z[1] * m, z[2])
    return circle


def in_order(demand: Demand, sets: Wholes) -> Wholes:
    """Return sets [N, 4] ordered by size, then by error of the ratio, then by their numbers."""
    z, scheme = sets.T, demand.of
    off = demand.off(ratios(scheme, z))
    keys = (z[2], z[1], z[0], np.round(off, 12), np.round(sizes(scheme, z, demand.modules), 9))
    return sets[np.lexsort(keys)]


@lru_cache(maxsize=32)
def choice(demand: Demand) -> TrainChoice:
    """Return all trains that fulfil a demand."""
    kept: list[Wholes] = []
    left = dict.fromkeys(CONDITIONS, 0)
    nearest: tuple[float, Wholes | None] = (math.inf, None)
    misses: dict[str, list[Wholes]] = {name: [] for name in CONDITIONS[1:]}
    for sets in coaxial(demand):
        z = sets.T
        holds = judged(demand, z)
        together = np.ones(len(sets), bool)
        for name, fulfilled in holds.items():
            together &= fulfilled
            left[name] += int(together.sum())
        kept.append(sets[together])
        for name, rows in misses.items():
            others = np.logical_and.reduce([flags for other, flags in holds.items() if other != name])
            rows.append(sets[others & ~holds[name]])
        sound = sets[holds["interference"]]
        if len(sound):
            off = demand.off(ratios(demand.of, sound.T))
            nearest = min(nearest, (float(off.min()), sound[off.argmin()]), key=lambda one: one[0])
    trains = in_order(demand, np.concatenate(kept))
    refused = {name: in_order(demand, np.concatenate(rows)) for name, rows in misses.items()}
    return TrainChoice(
        demand,
        trains,
        unshifted(demand.of, trains.T),
        left,
        None if nearest[1] is None else _train(demand, nearest[1]),
        {name: _train(demand, rows[0]) for name, rows in refused.items() if len(rows)},
    )


def mended(demand: Demand) -> tuple[int, ...]:
    """Return the numbers of satellites with which the demand can be met."""
    others = (replace(demand, satellites=k) for k in range(2, MOST_SATELLITES + 1))
    return tuple(one.satellites for one in others if len(choice(one).sets))


# --- assembly ---------------------------------------------------------------------------------------------


def turned(train: Train, satellites: int) -> tuple[float, tuple[float | None, ...]]:
    """Return the angles (rad) of wheel 3 and of each satellite, with the carrier and a tooth of wheel 1 at 0.

    A tooth of every wheel lies at its angle 0.  Where two wheels meet, a tooth of one is in a gap of the other. An
    angle is None if no position of the satellite fits both wheels.
    """
    z, scheme = train.teeth, SCHEMES[train.scheme]

    def at_mesh(inner: bool, γ: float, wheel: float, number: int) -> tuple[float, float]:
        """Return the direction (rad) from the satellite's axis to the mesh, and how far (pitches) a tooth is
        before it.
        """
        passed = (γ - wheel) * number / math.tau
        return (γ, passed - 0.5) if inner else (γ + math.pi, 0.5 - passed)

    def fits(γ: float, ψ: float, wheel: float) -> float:
        towards, share = at_mesh(scheme.inner[1], γ, wheel, z.z3)
        return math.remainder((towards - ψ) * z.z2_prime / math.tau - share, 1)

    def first(γ: float) -> float:
        towards, share = at_mesh(scheme.inner[0], γ, 0.0, z.z1)
        return towards - share * math.tau / z.z2

    # Wheel 3 is turned by a fraction of a tooth until it meets the first satellite.
    missing = fits(0.0, first(0.0), 0.0)
    three = -missing * math.tau / z.z3 * scheme.signs[1]
    angles: list[float | None] = []
    for number in range(satellites):
        γ = number * math.tau / satellites
        tried = (first(γ) + tooth * math.tau / z.z2 for tooth in range(z.z2))
        angles.append(next((ψ for ψ in tried if abs(fits(γ, ψ, three)) < FITS), None))
    return three, tuple(angles)


# --- efficiency -------------------------------------------------------------------------------------------


def power_way(ratio: float, carrier_drives: bool) -> int:
    """Return +1 if, for the ratio u₁H, power flows from wheel 1 to wheel 3 as seen from the carrier, otherwise −1.

    Its sign is that of M₁(ω₁ − ω_H) = M₁ω₁ (1 − 1/u), where M₁ω₁ is positive if wheel 1 drives.
    """
    along = 1 - 1 / ratio
    return 1 if (along > 0) != carrier_drives else -1


def efficiency(ratio: float, of_meshes: float, carrier_drives: bool) -> float:
    """Return the efficiency of a train with the ratio u₁H, `of_meshes` η₀ with the carrier held; ≤ 0 if it locks."""
    u0 = 1 - ratio
    lost = 1 - u0 * of_meshes ** power_way(ratio, carrier_drives)
    return (1 - u0) / lost if carrier_drives and lost else lost / (1 - u0)
