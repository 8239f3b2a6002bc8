"""The Assur group of class III: three legs on a ternary link, its assembly modes, and its rates by special points.

Unknown is the pose of the plate, as in `formula.plate_pose`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence

import numpy as np

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.records import Record
from reportgen.formula.constructions import Value, circle_circle, cross, dot
from reportgen.formula.plate_pose import EXACT, SAME, Rows, refined_pose
from reportgen.machine import Triad
from reportgen.machine.rigid_motion import SINGULAR, LinkMotion, PointMotion, carried

ON_CIRCLE = 1e-4
"""A root of the equation of φ whose modulus differs from 1 by more than this is not an angle.

A double root splits by the square root of the rounding errors.
"""
STRAY = 0.1
"""Largest correction (relative, or rad) of a predicted pose; a larger one could lead to another assembly mode."""
STEPS = 180
"""Steps in which a mode is followed through the driver's travel, where it needs no smaller ones."""
LEAST_STEP = 2.0**-24
"""A step is halved down to this share of its size before the mode ends."""

# --- one pose -------------------------------------------------------------------------------------


def rows_of(triad: Triad, outer: Sequence[Value], d: Value, turn: Value) -> Rows:
    """Return the equations at the pose d, e^{iφ}, with legs from the `outer` joints (m)."""
    return Rows.of([leg.length for leg in triad.legs], triad.locals, outer, (d, turn))


def plate_size(triad: Triad) -> float:
    """Return the greatest distance (m) of two inner joints."""
    first, second, third = triad.locals
    return max(abs(second - first), abs(third - first), abs(third - second))


def reach(triad: Triad) -> float:
    """Return the length (m) of the longest leg."""
    return max(leg.length for leg in triad.legs)


def _refined(triad: Triad, outer: Sequence[complex], d: complex, turn: complex) -> tuple[complex, complex] | None:
    """Return the pose that Newton's iteration reaches from a place nearby; None if it diverges or strays.

    Each correction must be much smaller than the one before, so that the iteration stays with its mode.
    """
    size, before = reach(triad), STRAY
    for _ in range(12):
        try:
            rows = rows_of(triad, outer, d, turn)
            shift, angle = rows.solve(rows.misses)
        except ZeroDivisionError:
            return None
        change = abs(shift) / size + abs(angle)
        if not change <= before:
            return None
        d, turn = d + shift, turn * cmath.exp(1j * angle)
        if change < EXACT:
            return d, turn / abs(turn)
        before = max(change / 2, EXACT * 100)
    return (d, turn / abs(turn)) if change < SAME**2 * 100 else None


# --- all assembly modes ---------------------------------------------------------------------------


class Pose(Record):
    """A pose of the plate: the place `d` (m) of its first inner joint, the direction `turn` = e^{iφ} of its axes."""

    d: complex
    turn: complex

    def joints(self, triad: Triad) -> tuple[complex, complex, complex]:
        """Return the places of the inner joints (m)."""
        first, second, third = (self.d + local * self.turn for local in triad.locals)
        return first, second, third


def assemblies(triad: Triad, outer: Sequence[complex]) -> tuple[Pose, ...]:
    """Return all poses of the plate for given outer joints (m), at most six, by rising φ from −π.

    With r = Q_1 − P_1, |r| = l_1, the two other legs demand r·b = p and r·c = q, where b and c are known for a trial φ.
    Hence |q b − p c|² = l_1² (b × c)²: a trigonometric polynomial of the third degree in φ, whose roots are found as
    those of a polynomial of e^{iφ}.
    """
    size = reach(triad)
    turn = np.exp(2j * np.pi * np.arange(16) / 16)
    (b, p), (c, q) = (_side(triad, [one / size for one in outer], index, turn, size) for index in (1, 2))
    missing = np.abs(q * b - p * c) ** 2 - (triad.legs[0].length / size * cross(b, c)) ** 2
    series = np.fft.fft(missing) / missing.size
    poses: list[Pose] = []
    for root in np.roots([series[order] for order in (3, 2, 1, 0, -1, -2, -3)]):
        if abs(abs(root) - 1) > ON_CIRCLE:
            continue
        direction = complex(root / abs(root))
        first, second = outer[0], outer[1] - triad.locals[1] * direction
        for sign in (1.0, -1.0):
            with np.errstate(divide="ignore", invalid="ignore"):
                start = circle_circle(first, triad.legs[0].length, second, triad.legs[1].length, sign)
            pose = _refined(triad, outer, complex(start), direction) if np.isfinite(start) else None
            if pose is not None and all(_distance(Pose(*pose), known, size) > SAME for known in poses):
                poses.append(Pose(*pose))
    return tuple(sorted(poses, key=lambda pose: cmath.phase(pose.turn)))


def _side(triad: Triad, outer: Sequence[complex], index: int, turn: Complexes, size: float) -> tuple[Complexes, Floats]:
    """Return b and p of a leg's demand r·b = p, for lengths divided by `size`."""
    first, leg = triad.legs[0].length / size, triad.legs[index].length / size
    b = triad.locals[index] / size * turn - (outer[index] - outer[0])
    return b, -(np.abs(b) ** 2 + first**2 - leg**2) / 2


def _distance(a: Pose, b: Pose, size: float) -> float:
    return abs(a.d - b.d) / size + abs(a.turn - b.turn)


def misfit(triad: Triad, pose: Pose) -> float:
    """Return the root mean square (m) of the distances of the joints from the points that the group is to be near."""
    places = dict(zip((leg.inner for leg in triad.legs), pose.joints(triad), strict=True))
    return math.sqrt(sum(abs(places[name] - near) ** 2 for name, near in triad.near) / len(triad.near))


# --- a mode over the driver's travel --------------------------------------------------------------

Outer = Callable[[Floats], tuple[Complexes, Complexes]]
"""Places (m) and rates (m per unit of the driver's coordinate) of the outer joints, [3, N], at its coordinates [N]."""


class ModeCourse(Record):
    """An assembly mode over the driver's travel: poses with their rates at rising coordinates `driver` [K].

    It ends before the travel does where the group comes to a dead point or where its outer joints do not exist. K is 0
    if the group cannot be assembled at `near_at`.
    """

    driver: Floats
    d: Complexes
    angle: Floats
    """φ (rad) without jumps."""
    shift: Complexes
    """Rate of d (m per unit of the driver's coordinate)."""
    turning: Floats
    """Rate of φ (rad per unit of the driver's coordinate)."""
    determinant: Floats
    """Determinant of the legs (m) over the size of the plate."""
    period: float
    """Period of the driver's coordinate: 2π of a crank, 0 of a slide."""
    low: float
    high: float
    """The travel that was asked for."""

    def inside(self, driver: Floats) -> tuple[Floats, Flags]:
        """Return the coordinates [N] within the course, moved by whole turns, and flags of those that it reaches."""
        if not self.driver.size:
            return driver, np.zeros(driver.shape, dtype=np.bool_)
        low, high = self.driver[0], self.driver[-1]
        if self.period:
            driver = low + np.mod(driver - low, self.period)
        return driver, (driver >= low) & (driver <= high)

    @property
    def whole(self) -> bool:
        """True if the mode goes on for a whole turn of the crank, or through the whole travel of a slide."""
        return self.driver.size > 0 and self.driver[0] == self.low and self.driver[-1] == self.high

    @property
    def closes(self) -> bool:
        """True if the crank, after a whole turn, finds the group in the same mode; True for a slide.

        A group can change to another mode without a dead point, so that the crank would need several turns.
        """
        if not (self.period and self.whole):
            return self.whole
        moved = abs(self.d[-1] - self.d[0]) / np.abs(self.d - self.d[0]).max(initial=1e-300)
        return bool(moved + abs(np.exp(1j * (self.angle[-1] - self.angle[0])) - 1) < math.sqrt(SAME))


def followed(triad: Triad, outer: Outer, low: float, high: float, period: float) -> ModeCourse:
    """Return the course of the mode nearest to `near`, from `near_at` down to `low` and up to `high`.

    A crank has the `period` 2π and `low` = `near_at`: if it cannot turn up to `high`, the course also goes down from
    there.
    """
    start = triad.near_at
    places, _ = outer(np.array([start]))
    first = [complex(place) for place in places[:, 0]]
    modes = assemblies(triad, first) if np.isfinite(places).all() else ()
    if not modes:
        empty, nowhere = np.zeros(0), np.zeros(0, np.complex128)
        return ModeCourse(
            driver=empty,
            d=nowhere,
            angle=empty,
            shift=nowhere,
            turning=empty,
            determinant=empty,
            period=period,
            low=low,
            high=high,
        )
    walk = _Walk(triad, outer)
    anchor = walk.anchor(start, min(modes, key=lambda mode: misfit(triad, mode)))
    up = walk.along(anchor, high)
    down = walk.along(anchor, up[-1][0] - period if period and up[-1][0] < high else low)
    rows = [*reversed(down[1:]), *up]
    driver, turning, determinant = (np.array([row[index] for row in rows], np.float64) for index in (0, 4, 5))
    d, turn, shift = (np.array([row[index] for row in rows], np.complex128) for index in (1, 2, 3))
    return ModeCourse(
        driver=driver,
        d=d,
        angle=np.unwrap(np.angle(turn)),
        shift=shift,
        turning=turning,
        determinant=determinant / plate_size(triad),
        period=period,
        low=low,
        high=high,
    )


PoseAnchor = tuple[float, complex, complex, complex, float, float]
"""The driver's coordinate, d, e^{iφ}, their rates and the determinant."""


class _Walk(Record):
    """Follows an assembly mode from anchor to anchor: prediction by the rates, correction by Newton's iteration."""

    triad: Triad
    outer: Outer

    def anchor(self, driver: float, pose: Pose, known: tuple[Complexes, Complexes] | None = None) -> PoseAnchor:
        """Return the anchor of a pose; `known` are the outer joints and their rates [3]."""
        if known is None:
            places, rates = self.outer(np.array([driver]))
            known = places[:, 0], rates[:, 0]
        rows = rows_of(self.triad, [complex(place) for place in known[0]], pose.d, pose.turn)
        right = [dot(complex(rate), e) for rate, e in zip(known[1], rows.along, strict=True)]
        try:
            shift, turning = rows.solve(right)
        except ZeroDivisionError:
            shift, turning = 0j, 0.0
        return driver, pose.d, pose.turn, shift, turning, rows.determinant

    def along(self, start: PoseAnchor, end: float) -> list[PoseAnchor]:
        """Return the anchors from `start` towards the driver's coordinate `end`, as far as the mode goes."""
        anchors = [start]
        if end == start[0]:
            return anchors
        grid = np.linspace(start[0], end, STEPS + 1)
        places, rates = self.outer(grid)
        for index in range(1, STEPS + 1):
            known = places[:, index], rates[:, index]
            reached = self._step(anchors[-1], float(grid[index]), known)
            if reached is not None:
                anchors.append(reached)
                continue
            smaller = list(self._smaller(anchors[-1], float(grid[index]), known))
            anchors += smaller
            if not smaller or smaller[-1][0] != grid[index]:
                break
        return anchors

    def _smaller(self, start: PoseAnchor, end: float, last: tuple[Complexes, Complexes]) -> Sequence[PoseAnchor]:
        """Return anchors on the way to `end` in smaller steps, as far as the mode goes."""
        anchors, step, least = [start], (end - start[0]) / 2, abs(end - start[0]) * LEAST_STEP
        while anchors[-1][0] != end and abs(step) >= least:
            there = anchors[-1][0] + step
            final = (end - there) * step <= 0
            if final:
                there, known = end, last
            else:
                places, rates = self.outer(np.array([there]))
                known = places[:, 0], rates[:, 0]
            reached = self._step(anchors[-1], there, known)
            if reached is None:
                step /= 2
                continue
            anchors.append(reached)
            step *= 2
        return anchors[1:]

    def _step(self, start: PoseAnchor, there: float, known: tuple[Complexes, Complexes]) -> PoseAnchor | None:
        """Return the anchor at the driver's coordinate `there`; None if the mode cannot be followed in one step."""
        if not (np.isfinite(known[0]).all() and np.isfinite(known[1]).all()):
            return None
        driver, d, turn, shift, turning, determinant = start
        step = there - driver
        if not abs(turning * step) <= 1.0:
            return None
        outer = [complex(place) for place in known[0]]
        pose = _refined(self.triad, outer, d + shift * step, turn * cmath.exp(1j * turning * step))
        if pose is None:
            return None
        reached = self.anchor(there, Pose(*pose), known)
        return reached if reached[-1] * determinant > 0 else None


def poses_on(
    triad: Triad, course: ModeCourse, driver: Floats, outer: Sequence[Complexes]
) -> tuple[Complexes, Complexes]:
    """Return d (m) and e^{iφ} [N] at the driver's coordinates [N] with three `outer` joints (m) [N].

    Between the anchors of the course, a cubic with their rates is refined by Newton's iteration. Off the course both
    are nan.
    """
    at, reached = course.inside(driver)
    d, angle = np.full(driver.shape, np.nan + 0j), np.full(driver.shape, np.nan)
    if course.driver.size > 1 and reached.any():
        at = at[reached]
        k = np.clip(np.searchsorted(course.driver, at, side="right") - 1, 0, course.driver.size - 2)
        width = course.driver[k + 1] - course.driver[k]
        t = (at - course.driver[k]) / width
        d[reached] = _cubic(course.d[k], course.d[k + 1], course.shift[k] * width, course.shift[k + 1] * width, t)
        angle[reached] = _cubic(
            course.angle[k], course.angle[k + 1], course.turning[k] * width, course.turning[k + 1] * width, t
        )
    elif reached.any():
        d[reached], angle[reached] = course.d[0], course.angle[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        lengths = [leg.length for leg in triad.legs]
        return refined_pose(lengths, triad.locals, outer, (d, np.asarray(np.exp(1j * angle))))


def _cubic(a: Value, b: Value, rate_a: Value, rate_b: Value, t: Floats) -> Value:
    """Return Hermite's cubic between a and b at shares t of the way; the rates are per whole way."""
    return a + t * rate_a + t**2 * (3 * (b - a) - 2 * rate_a - rate_b) + t**3 * (2 * (a - b) + rate_a + rate_b)


# --- velocities and accelerations -----------------------------------------------------------------

PAIRS = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
"""Two legs whose lines meet in a special point, and the third leg."""


class AssembledTriad(Record):
    """A triad in motion: its inner joints, its links, and the origins of their frames."""

    points: dict[str, PointMotion]
    links: dict[int, LinkMotion]
    origins: dict[int, PointMotion]


def moving(triad: Triad, outer: Sequence[PointMotion], d: Complexes, turn: Complexes) -> AssembledTriad:
    """Return the motion of a triad on its outer joints, with the pose d (m), e^{iφ} of its plate [N].

    The special point S of two legs is where their lines meet, taken as a point of the plate. Its velocity has the
    projections v_P·e on both lines, its acceleration a_P·e − ω²l − ω₃² (S − Q)·e. The third leg then gives ω₃ and ε₃.
    Of the three special points, each position uses that of the two legs that are most nearly square to each other. The
    rates are nan where the lines of the legs meet in one point or are parallel.
    """
    if min(leg.length for leg in triad.legs) <= 0:
        raise ValueError(f"group {triad.links}: a rod must have a length")
    lengths = np.array([leg.length for leg in triad.legs])[:, None]
    p, v, a = (np.array([getattr(point, name) for point in outer]) for name in ("p", "v", "a"))
    q = d + np.array(triad.locals)[:, None] * turn
    e = (q - p) / lengths
    sines = np.abs([cross(e[i], e[j]) for i, j, _ in PAIRS])
    chosen = np.argmax(np.nan_to_num(sines), axis=0)
    order = np.array(PAIRS)[chosen].T

    def sorted_legs(values: Value) -> Value:
        """Return values of the legs [3, N] in the order: first and second of the pair, third."""
        return np.take_along_axis(np.broadcast_to(values, order.shape), order, axis=0)

    (p_i, p_j, _), (q_i, q_j, q_k), (e_i, e_j, e_k) = map(sorted_legs, (p, q, e))
    area = cross(e_i, e_j)
    area = np.where(np.abs(area) > SINGULAR, area, np.nan)
    s = p_i + e_i * (cross(p_j - p_i, e_j) / area)
    lever = cross(q_k - s, e_k)
    lever = np.where(np.abs(lever) > SINGULAR * np.maximum(np.abs(q_k - s), plate_size(triad)), lever, np.nan)

    def from_projections(along_i: Floats, along_j: Floats) -> Complexes:
        """Return the vector with these projections on the lines of the pair."""
        return np.asarray(1j * (along_j * e_i - along_i * e_j) * (1 / area))

    known_i, known_j, known_k = sorted_legs(dot(v, e))
    v_s = from_projections(known_i, known_j)
    omega = (known_k - dot(v_s, e_k)) / lever
    v_q = v_s + 1j * omega * (q - s)
    omegas = cross(e, v_q - v) / lengths
    known_i, known_j, known_k = sorted_legs(dot(a, e) - omegas**2 * lengths)
    a_s = from_projections(known_i - omega**2 * dot(s - q_i, e_i), known_j - omega**2 * dot(s - q_j, e_j))
    epsilon = (known_k - dot(a_s, e_k) + omega**2 * dot(q_k - s, e_k)) / lever
    plate = LinkMotion(np.angle(turn), omega, epsilon)
    special = PointMotion(s, v_s, a_s)
    joints = [carried(special, plate, place) for place in q]
    epsilons = cross(e, np.array([joint.a for joint in joints]) - a) / lengths
    legs = [LinkMotion(np.angle(e[n]), omegas[n], epsilons[n]) for n in range(3)]
    return AssembledTriad(
        {leg.inner: joint for leg, joint in zip(triad.legs, joints, strict=True)},
        {triad.plate: plate} | {leg.link: link for leg, link in zip(triad.legs, legs, strict=True)},
        {triad.plate: joints[0]} | {leg.link: point for leg, point in zip(triad.legs, outer, strict=True)},
    )
