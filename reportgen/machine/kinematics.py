"""Kinematics of the five Assur groups of class II, and of a whole linkage.

One function for each kind finds the position in closed form. It then solves for the two unknown rates along two
known directions with `solve2`, first velocities, then accelerations. All positions are computed as arrays, without
loops; positions that cannot be assembled are nan.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.records import Record, astuple
from reportgen.formula.constructions import SquareRoot, along_line, circle_circle
from reportgen.machine import (
    DRIVER,
    GROUND,
    Crank,
    Dyad,
    DyadKind,
    Group,
    Guide,
    Linkage,
    LinkPoint,
    SlidingDriver,
    Triad,
)
from reportgen.machine.rigid_motion import LinkMotion, PointMotion, Rail, SlideMotion, at_rest, carried, solve2, unit
from reportgen.machine.triads import ModeCourse, followed, moving, poses_on

TOUCHING = 1e-13
"""A square that is negative by less than this, relative, counts as 0: a dead point, not an unreachable position."""

COINCIDENT = 1e-9
"""Points nearer than this, relative to their distance from the origin, give no direction."""

RODS: Mapping[DyadKind, int] = {"RRR": 2, "RRP": 1, "RPR": 0, "PRP": 0, "RPP": 0}
"""Number of a kind's `lengths` that are lengths of rods."""


# --- groups ---------------------------------------------------------------------------------------


class Assembled(Record):
    """A group in motion: its middle point, its two links with their frames' origins, its slides."""

    middle: PointMotion
    links: tuple[LinkMotion, LinkMotion]
    origins: tuple[PointMotion, PointMotion]
    slides: Mapping[tuple[int, int], SlideMotion]


End = PointMotion | Rail


def assemble(dyad: Dyad, start: End, end: End, sign: Floats) -> Assembled:
    """Return the motion of a group on its two ends; `sign` [N] is its orientation, +1 or −1.

    Raises `TypeError` when an end is a guide where the kind has a revolute joint, or the reverse, and
    `ValueError` for a rod without length.
    """
    if min(dyad.lengths[: RODS[dyad.kind]], default=1.0) <= 0:
        raise ValueError(f"dyad {dyad.links}: a rod must have a length")
    match dyad.kind, start, end:
        case "RRR", PointMotion(), PointMotion():
            return _rrr(dyad, start, end, sign)
        case "RRP", PointMotion(), Rail():
            return _rrp(dyad, start, end, sign)
        case "RPR", PointMotion(), PointMotion():
            return _rpr(dyad, start, end, sign)
        case "PRP", Rail(), Rail():
            return _prp(dyad, start, end)
        case "RPP", PointMotion(), Rail():
            return _rpp(dyad, start, end)
    raise TypeError(f"dyad {dyad.links}: the ends do not fit the kind {dyad.kind}")


def _root(scale: Floats | float) -> SquareRoot:
    """Return the square root that is nan where the square is negative by more than rounding of `scale`²."""

    def root(square: Floats) -> Floats:
        touching = (square < 0) & (square >= -TOUCHING * np.square(scale))
        return np.sqrt(np.where(touching, 0.0, np.where(square < 0, np.nan, square)))

    return root


def _rrr(dyad: Dyad, p: PointMotion, t: PointMotion, sign: Floats) -> Assembled:
    """Solve v_P + iω_i PQ = v_T + iω_j TQ."""
    first, second = dyad.lengths
    with np.errstate(divide="ignore", invalid="ignore"):
        q = circle_circle(p.p, first, t.p, second, sign, _root(first))
    r, s = q - p.p, q - t.p
    omega_i, omega_j = solve2(1j * r, -1j * s, t.v - p.v)
    epsilon_i, epsilon_j = solve2(1j * r, -1j * s, t.a - p.a + omega_i**2 * r - omega_j**2 * s)
    i = LinkMotion(np.angle(r), omega_i, epsilon_i)
    j = LinkMotion(np.angle(s), omega_j, epsilon_j)
    return Assembled(carried(p, i, q), (i, j), (p, t), {})


def _rrp(dyad: Dyad, p: PointMotion, rail: Rail, sign: Floats) -> Assembled:
    """Solve v_P + iω_i PQ = v_Qk + ṡ d, with 2iω_k ṡ d (Coriolis) on a turning guide."""
    length = dyad.lengths[0]
    d = rail.direction
    s = along_line(p.p, length, rail.at.p, d, sign, _root(length))
    q = rail.at.p + s * d
    r = q - p.p
    under = rail.carried(q)
    omega, rate = solve2(1j * r, -d, under.v - p.v)
    coriolis = 2j * rail.carrier.omega * rate * d
    epsilon, rate2 = solve2(1j * r, -d, under.a + coriolis - p.a + omega**2 * r)
    i = LinkMotion(np.angle(r), omega, epsilon)
    j = LinkMotion(np.angle(d), rail.carrier.omega, rail.carrier.epsilon)
    middle = PointMotion(q, under.v + rate * d, under.a + coriolis + rate2 * d)
    return Assembled(middle, (i, j), (p, middle), {(rail.link, dyad.links[1]): SlideMotion(s, rate, rate2, d)})


def _rpr(dyad: Dyad, p: PointMotion, t: PointMotion, sign: Floats) -> Assembled:
    """Solve v_P = v_T + iω TP + ṡ u, a_P = a_T + (iε − ω²) TP + 2iωṡ u + s̈ u."""
    offset = dyad.lengths[1]
    r = p.p - t.p
    # A pin met by its own slider's centre leaves the direction to rounding.
    r = np.where(np.abs(r) > COINCIDENT * (np.abs(p.p) + np.abs(t.p)), r, np.nan)
    s = sign * _root(np.abs(r))(np.abs(r) ** 2 - offset**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = unit(np.angle(r / (s + 1j * offset)))
    omega, rate = solve2(1j * r, u, p.v - t.v)
    epsilon, rate2 = solve2(1j * r, u, p.a - t.a + omega**2 * r - 2j * omega * rate * u)
    link = LinkMotion(np.angle(u), omega, epsilon)
    i, j = dyad.links
    return Assembled(carried(t, link, p.p), (link, link), (p, t), {(j, i): SlideMotion(s, rate, rate2, u)})


def _prp(dyad: Dyad, first: Rail, second: Rail) -> Assembled:
    """Solve v_Qk + ṡ₁ d₁ = v_Qm + ṡ₂ d₂."""
    d, e = first.direction, second.direction
    s, t = solve2(d, -e, second.at.p - first.at.p)
    q = first.at.p + s * d
    under, over = first.carried(q), second.carried(q)
    v, w = solve2(d, -e, over.v - under.v)
    turning, turning_second = 2j * first.carrier.omega * v * d, 2j * second.carrier.omega * w * e
    a, b = solve2(d, -e, over.a + turning_second - under.a - turning)
    middle = PointMotion(q, under.v + v * d, under.a + turning + a * d)
    i, j = dyad.links
    links = (
        LinkMotion(np.angle(d), first.carrier.omega, first.carrier.epsilon),
        LinkMotion(np.angle(e), second.carrier.omega, second.carrier.epsilon),
    )
    slides = {(first.link, i): SlideMotion(s, v, a, d), (second.link, j): SlideMotion(t, w, b, e)}
    return Assembled(middle, links, (middle, middle), slides)


def _rpp(dyad: Dyad, p: PointMotion, rail: Rail) -> Assembled:
    """Solve v_P = v_Pk + ṡ d + ṫ w: both slides turn with the guide's link, 2iω_k (ṡ d + ṫ w) is Coriolis."""
    d = rail.direction
    w = d * unit(dyad.slide_angle)
    under = rail.carried(p.p)
    turning = 2j * rail.carrier.omega
    s, t = solve2(d, w, p.p - rail.at.p)
    v, vt = solve2(d, w, p.v - under.v)
    a, at = solve2(d, w, p.a - under.a - turning * (v * d + vt * w))
    q = rail.carried(rail.at.p + s * d)
    middle = PointMotion(q.p, q.v + v * d, q.a + turning * v * d + a * d)
    link = LinkMotion(np.angle(d), rail.carrier.omega, rail.carrier.epsilon)
    i, j = dyad.links
    slides = {(rail.link, j): SlideMotion(s, v, a, d), (j, i): SlideMotion(t, vt, at, w)}
    return Assembled(middle, (link, link), (p, middle), slides)


# --- positions ------------------------------------------------------------------------------------
# Velocities and accelerations of a whole mechanism, over all positions together.

SUBSTEP = np.radians(2.0)
"""Largest step (rad) of a crank between two positions, so that link angles continue in the sense of rotation."""
SUBSTEPS_OF_A_SLIDE = 180

Places = NDArray[np.int64] | slice

Arrays = TypeVar("Arrays", LinkMotion, PointMotion, SlideMotion)


class Motion(Record):
    """The motion of every link, named point and slide over positions [N].

    `driver` is the crank's angle (rad) or the slide's coordinate (m), `rate` its rate at each position [N].
    `slides` are keyed (guide link, slider link); `origins` are the origins of the links' frames. Undetermined
    values at positions where `reachable` is False are nan.
    """

    driver: Floats
    rate: Floats
    links: Mapping[int, LinkMotion]
    points: Mapping[str, PointMotion]
    slides: Mapping[tuple[int, int], SlideMotion]
    origins: Mapping[int, PointMotion]
    reachable: Flags

    def of(self, link: int, at: Complexes | complex) -> PointMotion:
        """Return the material point of `link` that lies at `at` (m) [N] now: v = v_O + iω r, a = a_O + (iε − ω²) r."""
        p = np.broadcast_to(np.asarray(at, dtype=np.complex128), self.driver.shape)
        if link == GROUND:
            return at_rest(p)
        return carried(self.origins[link], self.links[link], p)

    def velocity(self, link: int, at: Complexes | complex) -> Complexes:
        """Return the velocity (m/s) [N] of the point of a moving link that lies at `at` (m) [N]: v = v_O + iω r."""
        origin = self.origins[link]
        return origin.v + 1j * self.links[link].omega * (at - origin.p)


def solve_motion(linkage: Linkage, driver: ArrayLike, rate: ArrayLike, acceleration: ArrayLike = 0.0) -> Motion:
    """Return the motion at the driver's coordinates `driver` [N] (rad, or m of a slide), passed through in this order.

    `rate` (rad/s or m/s) and `acceleration` (rad/s² or m/s²) are one number or one for each position [N].  Between
    positions far apart the solver takes substeps, so that link angles are continuous.  Positions that cannot be
    assembled are nan.
    Raises `ValueError` for a moving guide under a sliding driver and `KeyError` for a dyad that hangs
    on a point or link not yet placed.
    """
    given = np.atleast_1d(np.asarray(driver, dtype=np.float64))
    path, kept = _path(given, isinstance(linkage.driver, Crank))
    rates, accelerations = _along(path, kept, rate), _along(path, kept, acceleration)
    state = _State(linkage, path, rates, accelerations, _travel(linkage, path))
    for group in linkage.groups:
        state.add(group)
    return state.motion(given, kept)


def _along(path: Floats, kept: Places, given: ArrayLike) -> Floats:
    """Return values, given once or per position, at every place of the path; a substep takes the value of the position
    before it.
    """
    values = np.asarray(given, dtype=np.float64)
    if values.ndim == 0 or isinstance(kept, slice):
        return np.zeros_like(path) + values
    return np.asarray(values[np.searchsorted(kept, np.arange(path.size), side="right") - 1])


def _path(driver: Floats, turning: bool) -> tuple[Floats, Places]:
    """Return the driver's path with substeps between far positions, and the indices of the positions on it."""
    steps = np.abs(np.diff(driver))
    if not steps.size or not np.isfinite(steps).all():
        return driver, slice(None)
    largest = SUBSTEP if turning else max(np.ptp(driver) / SUBSTEPS_OF_A_SLIDE, np.finfo(float).tiny)
    parts = np.maximum(np.ceil(steps / largest * (1 - 1e-12)).astype(np.int64), 1)
    if parts.max() == 1:
        return driver, slice(None)
    kept = np.concatenate(([0], np.cumsum(parts)))
    path = np.interp(np.arange(kept[-1] + 1), kept, driver)
    path[kept] = driver
    return path, kept


Travel = tuple[float, float]
"""Least and greatest coordinate (m) of a sliding driver."""


def course_of(linkage: Linkage, triad: Triad, travel: Travel | None = None) -> ModeCourse:
    """Return the course of a triad's assembly mode through a turn of the crank, or the `travel` of a sliding driver."""
    before = linkage.groups[: linkage.groups.index(triad)]
    return _course(tuple(linkage.ground.items()), linkage.driver, before, linkage.points, triad, travel)


@lru_cache(maxsize=64)
def _course(
    ground: tuple[tuple[str, complex], ...],
    driver: Crank | SlidingDriver,
    before: tuple[Group, ...],
    points: tuple[LinkPoint, ...],
    triad: Triad,
    travel: Travel | None,
) -> ModeCourse:
    carrying = Linkage(dict(ground), driver, before, points)

    def outer(at: Floats) -> tuple[Complexes, Complexes]:
        state = _State(carrying, at, np.ones_like(at), np.zeros_like(at), travel)
        for group in before:
            state.add(group)
        joints = [state.points[leg.outer] for leg in triad.legs]
        return np.array([joint.p for joint in joints]), np.array([joint.v for joint in joints])

    if travel is None:
        return followed(triad, outer, triad.near_at, triad.near_at + 2 * np.pi, 2 * np.pi)
    return followed(triad, outer, *travel, 0.0)


def _travel(linkage: Linkage, path: Floats) -> Travel | None:
    """Return the travel of a sliding driver over its path and to the places where assembly modes are given."""
    if isinstance(linkage.driver, Crank):
        return None
    ends = [*path[np.isfinite(path)], *(triad.near_at for triad in linkage.triads)]
    return (float(min(ends)), float(max(ends))) if ends else (0.0, 0.0)


class _State:
    """The links and points placed so far while the groups are assembled one after another."""

    def __init__(
        self, linkage: Linkage, path: Floats, rate: Floats, acceleration: Floats, travel: Travel | None
    ) -> None:
        self.linkage, self.path, self.rate, self.acceleration = linkage, path, rate, acceleration
        self.travel = travel
        zero = np.zeros_like(path)
        self.still: Complexes = zero.astype(np.complex128)
        self.links: dict[int, LinkMotion] = {GROUND: LinkMotion(zero, zero, zero)}
        self.origins: dict[int, PointMotion] = {GROUND: self._fixed(0)}
        self.axes: dict[int, Complexes] = {GROUND: np.ones_like(self.still)}
        """Unit vectors along the links, those that were needed."""
        self.points = {name: self._fixed(p) for name, p in linkage.ground.items()}
        self.slides: dict[tuple[int, int], SlideMotion] = {}
        self.reachable = np.isfinite(path)
        self._drive()

    def _fixed(self, p: complex) -> PointMotion:
        return PointMotion(np.full_like(self.still, p), self.still, self.still)

    def _drive(self) -> None:
        q, zero, driver = self.path, np.zeros_like(self.path), self.linkage.driver
        if isinstance(driver, Crank):
            link, origin = LinkMotion(q, self.rate, self.acceleration), self.points[driver.centre]
            pin = carried(origin, link, origin.p + driver.length * unit(q))
        else:
            if driver.guide.link != GROUND:
                raise ValueError("the guide of a sliding driver must be fixed to the ground")
            d = unit(driver.guide.angle)
            pin = PointMotion(driver.guide.at + q * d, self.rate * d, self.still + self.acceleration * d)
            link, origin = LinkMotion(zero + driver.guide.angle, zero, zero), pin
            self.slides[GROUND, DRIVER] = SlideMotion(q, self.rate, self.acceleration, np.full_like(self.still, d))
        self.points[driver.pin] = pin
        self._place(DRIVER, link, origin)

    def _place(self, number: int, link: LinkMotion, origin: PointMotion) -> None:
        """Enter a link and the points fixed to it."""
        self.links[number], self.origins[number] = link, origin
        for point in self.linkage.points:
            if point.link == number:
                self.points[point.name] = carried(origin, link, origin.p + point.local * self._axis(number))

    def _axis(self, link: int) -> Complexes:
        if link not in self.axes:
            self.axes[link] = unit(self.links[link].angle)
        return self.axes[link]

    def _end(self, end: str | Guide) -> End:
        if isinstance(end, str):
            return self.points[end]
        carrier, origin = self.links[end.link], self.origins[end.link]
        turned = self._axis(end.link)
        p = origin.p + end.at * turned
        at = at_rest(p) if end.link == GROUND else carried(origin, carrier, p)
        return Rail(end.link, at, turned * unit(end.angle), carrier)

    def add(self, group: Group) -> None:
        """Assemble one group; positions at which that is impossible become unreachable."""
        if isinstance(group, Triad):
            self._add_triad(group)
        else:
            self._add_dyad(group)

    def _add_dyad(self, dyad: Dyad) -> None:
        sign = np.full(self.path.shape, float(dyad.sign))
        group = assemble(dyad, self._end(dyad.start), self._end(dyad.end), sign)
        parts = (group.middle.p, group.middle.a, *(part for link in group.links for part in (link.angle, link.epsilon)))
        self.reachable = self.reachable & np.isfinite(parts).all(axis=0)
        self.points[dyad.middle] = group.middle
        self.slides.update(group.slides)
        for number, link, origin in zip(dyad.links, group.links, group.origins, strict=True):
            self._place(number, LinkMotion(_continuous(link.angle), link.omega, link.epsilon), origin)

    def _add_triad(self, triad: Triad) -> None:
        """Assemble a group of class III in the mode of its course."""
        outer = [self.points[leg.outer] for leg in triad.legs]
        course = course_of(self.linkage, triad, self.travel)
        pose = poses_on(triad, course, self.path, [point.p for point in outer])
        group = moving(triad, outer, *pose)
        parts = [part for link in group.links.values() for part in (link.angle, link.epsilon)]
        self.reachable = self.reachable & np.isfinite(parts).all(axis=0)
        self.points |= group.points
        for number, link in group.links.items():
            turned = LinkMotion(_continuous(link.angle), link.omega, link.epsilon)
            self._place(number, turned, group.origins[number])

    def motion(self, driver: Floats, kept: Places) -> Motion:
        """Return the result at the requested positions [N]; the substeps are dropped."""
        return Motion(
            driver=driver,
            rate=self.rate[kept],
            links={number: _take(link, kept) for number, link in self.links.items() if number != GROUND},
            points={name: _take(point, kept) for name, point in self.points.items()},
            slides={key: _take(slide, kept) for key, slide in self.slides.items()},
            origins={number: _take(origin, kept) for number, origin in self.origins.items()},
            reachable=self.reachable[kept],
        )


def _take(motion: Arrays, kept: Places) -> Arrays:
    if isinstance(kept, slice):
        return motion
    return type(motion)(*(values[kept] for values in astuple(motion)))


def _continuous(angle: Floats) -> Floats:
    """Return the angle without jumps of 2π; gaps of nan are stepped over."""
    finite = np.isfinite(angle)
    if finite.all():
        return _unwrapped(angle)
    result = angle.copy()
    result[finite] = _unwrapped(angle[finite])
    return result


def _unwrapped(angle: Floats) -> Floats:
    """Return what `np.unwrap` does, sooner for an angle without jumps."""
    if (np.abs(angle[1:] - angle[:-1]) >= np.pi).any():
        return np.unwrap(angle)
    result = angle.copy()
    # As there, −0 becomes 0.
    result[1:] += 0.0
    return result
