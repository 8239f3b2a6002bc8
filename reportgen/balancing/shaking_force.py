"""The shaking force of a machine's inertia on its frame, and the counterweights that reduce it.

The moving links shake the frame with the force F = −Σ m a_S and, about the crank's centre O, with the moment M = −Σ
(r_S × m a_S + J ε). Seen from a crank that turns evenly, F e^{−iφ}/ω² is a closed curve (kg·m), and a counterweight
U = m_c r_c on the crank only shifts its origin: its centrifugal force is U ω² e^{iφ}. So minus the mean of the
curve gives the least mean square, and minus the centre of the smallest circle round it gives the least maximum. The
circle's touching points prove that nothing is better.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from itertools import combinations

import numpy as np

from reportgen.balancing.counterweights import (
    Balancing,
    Counterweight,
    CounterweightRule,
    balanced,
    force_balance,
    reciprocating_part,
    turning_part,
)
from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record, replace
from reportgen.machine import DRIVER, GROUND, Crank, Linkage, joints
from reportgen.machine.analysis import Analysis, Machine, analyse, motion_at
from reportgen.machine.force_analysis import inertia_loads, reaction_name, solve_forces
from reportgen.machine.kinematics import Motion
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.rigid_motion import cross, unit

SAMPLES, MOST_SAMPLES = 1440, 46080
"""Smallest and largest number of samples of the curve over a turn; a curve with corners needs more samples."""
FADED = 1e-13
"""The samples suffice if the last eighth of the harmonics is below this share of the greatest one."""
ROUNDING = 1e-15
"""A harmonic below this share of the greatest is a rounding error."""
ON_THE_CIRCLE = 1e-12
"""Largest distance of a point outside a circle, as a share of its radius, that counts as on the circle."""
NEIGHBOURS = 1.5
"""Places of the curve within this number of steps belong to one touching point."""
REFINEMENTS = 40
SETTLED = 1e-12
"""The search for a touching point ends with a step (rad) below this."""
DIFFERENCE = 1e-6
"""Step (rad) of the differences that approximate derivatives; they only steer the search, whose zero is exact."""


# --- force and moment on the frame ------------------------------------------------------------------


def shaking_force(linkage: Linkage, motion: Motion) -> Complexes:
    """Return F = −Σ m a_S (N, x + iy) [N], the force that the links' inertia exerts on the frame."""
    total = np.zeros_like(motion.driver, dtype=np.complex128)
    for body in linkage.inertias:
        total -= body.mass * motion.points[body.centre].a
    return total


def shaking_moment(linkage: Linkage, motion: Motion) -> Floats:
    """Return M = −Σ (r_S × m a_S + J ε) (N·m) [N] about the crank's centre, anticlockwise positive.

    Raises `TypeError` for a driver that slides.
    """
    centre = motion.points[_crank(linkage).centre].p
    total = np.zeros_like(motion.driver)
    for body in linkage.inertias:
        there = motion.points[body.centre]
        total -= body.mass * cross(there.p - centre, there.a) + body.moment * motion.links[body.link].epsilon
    return total


def frame_reactions(linkage: Linkage, motion: Motion) -> Complexes:
    """Return the sum of the forces (N) [N] on the frame in all its joints if only inertia acts: F by another method."""
    reactions = solve_forces(linkage, motion, inertia_loads(linkage, motion)).reactions
    on_frame = [joint.links[1] for joint in joints(linkage) if joint.links[0] == GROUND]
    return sum(
        (reactions[reaction_name(link, GROUND)].force for link in on_frame), np.zeros_like(motion.driver, complex)
    )


def _crank(linkage: Linkage) -> Crank:
    if not isinstance(linkage.driver, Crank):
        raise TypeError("a driver that slides has no centre")
    return linkage.driver


# --- the curve that the crank sees ------------------------------------------------------------------


class CrankCurve(Record, dict=True):
    """The curve F e^{−iφ}/ω² (kg·m) over a turn as the sum of its harmonics, Σ c_k e^{ikθ}.

    θ (rad) is the crank's travel in its direction of rotation from position 1; `harmonics` c_k [N] are in the order of
    the discrete Fourier transform.
    """

    harmonics: Complexes

    @property
    def step(self) -> float:
        """The step (rad) between the N evenly spaced places of the curve."""
        return FULL_TURN / len(self.harmonics)

    @cached_property
    def places(self) -> Floats:
        """The evenly spaced places θ (rad) [N]."""
        return np.asarray(np.arange(len(self.harmonics)) * self.step, dtype=np.float64)

    @cached_property
    def samples(self) -> Complexes:
        """The curve at its evenly spaced places [N]."""
        return np.asarray(np.fft.ifft(self.harmonics) * len(self.harmonics))

    @cached_property
    def orders(self) -> Floats:
        """The order k of each harmonic [N]."""
        return np.asarray(np.fft.fftfreq(len(self.harmonics), 1 / len(self.harmonics)), dtype=np.float64)

    def at(self, angle: Floats | float, derivative: int = 0) -> Complexes:
        """Return the curve (kg·m), or a derivative with respect to θ, at angles θ (rad) [N]."""
        kept = self.harmonics != 0
        orders = self.orders[kept]
        waves = np.exp(1j * np.multiply.outer(np.asarray(angle), orders))
        return np.asarray(waves @ (self.harmonics[kept] * (1j * orders) ** derivative))

    @property
    def mean(self) -> complex:
        """The mean of the curve over the turn (kg·m)."""
        return complex(self.harmonics[0])

    def rms(self, counterweight: complex = 0j) -> float:
        """Return the root of the mean square of |F|/ω² (kg·m) with a counterweight U on the crank (Parseval)."""
        others = float(np.sum(np.abs(self.harmonics[1:]) ** 2))
        return float(np.sqrt(others + abs(self.mean + counterweight) ** 2))

    def farthest(self, centre: complex) -> tuple[float, Floats]:
        """Return the greatest distance (kg·m) of the curve from a point, and all places (rad) [M] of greatest distance.

        Places within a thousandth of the greatest distance are included, and each is refined.
        """
        away = np.abs(self.samples - centre)
        peaks = (away >= np.roll(away, 1)) & (away >= np.roll(away, -1)) & (away >= away.max() * (1 - 1e-3))
        angle = self.places[peaks]
        if angle.size > len(away) // 4:
            # A circle about this point is everywhere as far from it.
            return float(away.max()), angle[:1]
        low, high = angle - self.step, angle + self.step
        for _ in range(REFINEMENTS):
            arm, rate, rate2 = self.at(angle) - centre, self.at(angle, 1), self.at(angle, 2)
            slope = np.real(np.conj(arm) * rate)
            bend = np.real(np.conj(arm) * rate2) + np.abs(rate) ** 2
            low, high = np.where(slope > 0, angle, low), np.where(slope < 0, angle, high)
            newton = angle - slope / np.where(bend < 0, bend, 1.0)
            inside = (bend < 0) & (newton > low) & (newton < high)
            before, angle = angle, np.where(slope == 0, angle, np.where(inside, newton, (low + high) / 2))
            if np.all(np.abs(angle - before) < SETTLED):
                break
        return float(np.abs(self.at(angle) - centre).max()), angle

    def greatest(self, counterweight: complex = 0j) -> tuple[float, float]:
        """Return the greatest |F|/ω² (kg·m) of the turn with a counterweight U (kg·m) on the crank, and its place θ
        (rad).
        """
        size, places = self.farthest(-counterweight)
        first = places[int(np.abs(self.at(places) + counterweight).argmax())]
        return size, float(np.mod(first, FULL_TURN))

    @cached_property
    def circle(self) -> SmallestCircle:
        """The smallest circle round the curve."""
        return smallest_round(self)


def seen_from_crank(machine: Machine) -> CrankCurve:
    """Return the curve F e^{−iφ}/ω² of a machine whose crank turns evenly, with enough samples for its harmonics to
    fade.
    """
    count = SAMPLES
    while True:
        motion = motion_at(machine, np.arange(count) * (FULL_TURN / count))
        curve = shaking_force(machine.linkage, motion) * unit(-motion.driver) / machine.speed**2
        harmonics = np.fft.fft(curve) / count
        sizes = np.abs(harmonics)
        last = sizes[count // 2 - count // 16 : count // 2 + count // 16]
        if count >= MOST_SAMPLES or last.max() <= FADED * sizes.max():
            return CrankCurve(np.where(sizes > ROUNDING * sizes.max(), harmonics, 0j))
        count *= 2


# --- the smallest circle ----------------------------------------------------------------------------


class SmallestCircle(Record):
    """The smallest circle round a curve: centre and radius (kg·m), and the two or three places θ (rad) where it
    touches.
    """

    centre: complex
    radius: float
    touching: tuple[float, ...]


def round_points(points: Complexes) -> tuple[complex, float, tuple[int, ...]]:
    """Return centre and radius of the smallest circle round points [N] (any unit), and the indices of the two or three
    points on it.

    The farthest point outside is added to the circle repeatedly. The circle grows each time, so the loop ends.
    """
    support: tuple[int, ...] = (0,)
    centre, radius = complex(points[0]), 0.0
    spread = float(np.abs(points - points[0]).max())
    while True:
        away = np.abs(points - centre)
        farthest = int(away.argmax())
        if away[farthest] <= radius * (1 + ON_THE_CIRCLE) + ROUNDING * spread:
            return centre, radius, support
        entered = (*support, farthest)
        grown = _round_few(points[list(entered)])
        if grown[1] <= radius:
            return centre, radius, support
        centre, radius = grown[:2]
        support = tuple(entered[place] for place in grown[2])


def _round_few(points: Complexes) -> tuple[complex, float, tuple[int, ...]]:
    """Return the smallest circle round up to four points, by trying all pairs and triples."""
    best: tuple[complex, float, tuple[int, ...]] = (0j, np.inf, ())
    for few in (*combinations(range(len(points)), 2), *combinations(range(len(points)), 3)):
        centre = through(points[list(few)])
        radius = float(np.abs(points[list(few)] - centre).max())
        if radius < best[1] and np.abs(points - centre).max() <= radius * (1 + ON_THE_CIRCLE):
            best = centre, radius, few
    return best


def through(points: Complexes) -> complex:
    """Return the centre of the circle through two points [2] as a diameter, or through three [3]; nan if the three lie
    in a line.
    """
    if len(points) == 2:
        return complex(points.mean())
    first, second = points[1] - points[0], points[2] - points[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = (abs(first) ** 2 * second - abs(second) ** 2 * first) / (2j * cross(first, second))
    return complex(points[0] + arm)


def smallest_round(curve: CrankCurve) -> SmallestCircle:
    """Return the smallest circle round a whole curve: the circle of its samples, with the touching points refined.

    Where the curve leaves the circle between the samples, its farthest places are added to them.
    """
    points, angles = curve.samples, curve.places
    for _ in range(REFINEMENTS):
        centre, radius, support = round_points(points)
        touching = _refined(curve, _merged(angles[list(support)], NEIGHBOURS * curve.step))
        if len(touching) > 1:
            met = curve.at(touching)
            finer = through(met)
            if abs(finer - centre) <= curve.step * radius:
                centre, radius = finer, float(np.abs(met - finer).max())
            else:
                touching = angles[list(support)]
        greatest, places = curve.farthest(centre)
        if greatest <= radius * (1 + ON_THE_CIRCLE) + ROUNDING * abs(centre):
            break
        points, angles = np.append(points, curve.at(places)), np.append(angles, places)
    return SmallestCircle(centre, radius, tuple(float(angle) for angle in np.sort(np.mod(touching, FULL_TURN))))


def _merged(touching: Floats, near: float) -> Floats:
    """Return places θ (rad) with those `near` each other (rad), on both sides of one touching point, merged."""
    kept: list[float] = []
    for angle in np.sort(np.mod(touching, FULL_TURN)):
        if kept and angle - kept[-1] < near:
            kept[-1] = (kept[-1] + angle) / 2
        else:
            kept.append(float(angle))
    if len(kept) > 1 and kept[0] + FULL_TURN - kept[-1] < near:
        last = kept.pop()
        kept[0] = (kept[0] + last - FULL_TURN) / 2
    return np.array(kept)


def _refined(curve: CrankCurve, touching: Floats) -> Floats:
    """Return the places θ (rad) next to the given ones at which the circle through the curve's points touches the
    curve.

    Touching means (c − z) ⊥ c′ at each point; Newton's method with differences instead of derivatives.
    """

    def slopes(angle: Floats) -> Floats:
        points = curve.at(angle)
        return np.real(np.conj(points - through(points)) * curve.at(angle, 1))

    if len(touching) < 2:
        return touching
    angle, steps = touching, np.eye(len(touching)) * DIFFERENCE
    for _ in range(REFINEMENTS):
        rates = np.array([slopes(angle + step) - slopes(angle - step) for step in steps]).T / (2 * DIFFERENCE)
        if not np.isfinite(rates).all():
            return touching
        # A curve that is itself a circle touches everywhere: the least step will do.
        step = -np.linalg.lstsq(rates, slopes(angle), rcond=1e-9)[0]
        angle = angle + np.clip(step, -curve.step, curve.step)
        if np.all(np.abs(step) < SETTLED):
            break
    return angle


# --- a turn with its counterweights -----------------------------------------------------------------

NOTHING = 1e-9
"""A counterweight below this share of all masses at the crank's pin is zero."""
FINE = 720
"""Number of places of a turn at which torques and moments with and without counterweights are compared."""


class BalancedTurn(Record, dict=True):
    """The curve seen from the crank, U (kg·m) by each requested rule, and the counterweights that are applied.

    These are the counterweight of the first rule, or those of the whole balance of a four-bar; () if they are zero.
    """

    machine: Machine
    curve: CrankCurve
    products: Mapping[CounterweightRule, complex]
    weights: tuple[Counterweight, ...]

    @cached_property
    def balanced(self) -> Machine:
        """The machine with its counterweights."""
        return replace(self.machine, linkage=balanced(self.machine.linkage, self.weights))

    @cached_property
    def cycles(self) -> tuple[Analysis, Analysis]:
        """The analysis at closely spaced angles of the cycle, without and with the counterweights."""
        angles = np.arange(FINE * self.machine.turns) * (FULL_TURN / FINE)
        return analyse(self.machine, angles), analyse(self.balanced, angles)

    @cached_property
    def left(self) -> float:
        """The greatest force on the frame (N) that remains with the counterweights."""
        after = self.cycles[1]
        return float(np.abs(shaking_force(after.machine.linkage, after.motion)).max())


def counterweight(machine: Machine, curve: CrankCurve, rule: CounterweightRule, share: float) -> complex:
    """Return U (kg·m) of the counterweight on the crank by a rule, in the crank's frame.

    "rms" gives the least mean square of F, "max" its least maximum. "rotating" balances the masses that turn with the
    crank; "share" balances these and a `share` of the reciprocating masses. The other rules ignore `share`.
    """
    match rule:
        case "rms":
            return -curve.mean
        case "max":
            return -curve.circle.centre
        case "rotating":
            return -turning_part(machine.linkage)
        case "share":
            return -(turning_part(machine.linkage) + share * reciprocating_part(machine.linkage))


def balanced_turn(machine: Machine) -> BalancedTurn:
    """Return the balancing that a machine's file requests; the crank must turn evenly."""
    asked, curve = machine.topic("balancing", Balancing) or Balancing(), seen_from_crank(machine)
    products = {rule: counterweight(machine, curve, rule, asked.share) for rule in asked.rules}
    carried_out = force_balance(machine.linkage) if asked.links else {}
    if products:
        carried_out = {DRIVER: products[asked.rules[0]]}
    # Reference size: all masses at the crank's pin.
    whole = _crank(machine.linkage).length * sum(body.mass for body in machine.linkage.inertias)
    weights = (
        Counterweight(link, product, asked.radius)
        for link, product in carried_out.items()
        if abs(product) > NOTHING * whole
    )
    return BalancedTurn(machine, curve, products, tuple(weights))


def balanced_in(analysis: Analysis) -> BalancedTurn:
    """Return the balancing of a machine whose file requests it; it is computed once."""
    return analysis.derived(_balanced)


def _balanced(analysis: Analysis) -> BalancedTurn:
    return balanced_turn(analysis.machine)
