"""Positions, velocities and accelerations of a whole mechanism, over all positions at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.mechanism.dyads import (
    Complexes,
    End,
    Flags,
    Floats,
    LinkMotion,
    PointMotion,
    Rail,
    SlideMotion,
    assemble,
    carried,
    unit,
)
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Dyad, Guide, Linkage

__all__ = ["LinkMotion", "Motion", "PointMotion", "SlideMotion", "solve_motion"]

SUBSTEP = np.radians(2.0)
"""Largest step of a crank between two positions, so that angles unwrap the way the links really turn."""
SUBSTEPS_OF_A_SLIDE = 180

Places = NDArray[np.int64] | slice

Arrays = TypeVar("Arrays", LinkMotion, PointMotion, SlideMotion)


@dataclass(frozen=True)
class Motion:
    """The motion of every link, named point and slide over positions [N].

    `driver` is the crank's angle (rad) or the slide's coordinate (m), `rate` its constant rate.
    `slides` are keyed (guide link, slider link); `origins` are the origins of the links' frames.
    Positions where `reachable` is False have nan where nothing can be said.
    """

    driver: Floats
    rate: float
    links: Mapping[int, LinkMotion]
    points: Mapping[str, PointMotion]
    slides: Mapping[tuple[int, int], SlideMotion]
    origins: Mapping[int, PointMotion]
    reachable: Flags

    def of(self, link: int, at: Complexes | complex) -> PointMotion:
        """The material point of `link` that lies at `at` now: v = v_O + iω r, a = a_O + (iε − ω²) r."""
        p = np.broadcast_to(np.asarray(at, dtype=np.complex128), self.driver.shape)
        if link == GROUND:
            return PointMotion(p, np.zeros_like(p), np.zeros_like(p))
        return carried(self.origins[link], self.links[link], p)


def solve_motion(linkage: Linkage, driver: ArrayLike, rate: float) -> Motion:
    """The motion at driver coordinates `driver` [N], passed through in this order at the constant `rate`.

    Between positions far apart the solver takes substeps, so that link angles are continuous.
    Raises `ValueError` for a moving guide under a sliding driver and `KeyError` for a dyad that hangs
    on a point or link not yet placed.
    """
    given = np.atleast_1d(np.asarray(driver, dtype=np.float64))
    path, kept = _path(given, isinstance(linkage.driver, Crank))
    state = _State(linkage, path, rate)
    for dyad in linkage.dyads:
        state.add(dyad)
    return state.motion(given, kept)


def _path(driver: Floats, turning: bool) -> tuple[Floats, Places]:
    """The driver's way with substeps between far positions, and the places of the positions on it."""
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


class _State:
    """What is placed so far while the groups are assembled one after another."""

    def __init__(self, linkage: Linkage, path: Floats, rate: float) -> None:
        self.linkage, self.path, self.rate = linkage, path, rate
        zero = np.zeros_like(path)
        self.still: Complexes = zero.astype(np.complex128)
        self.links: dict[int, LinkMotion] = {GROUND: LinkMotion(zero, zero, zero)}
        self.origins: dict[int, PointMotion] = {GROUND: self._fixed(0)}
        self.points = {name: self._fixed(p) for name, p in linkage.ground.items()}
        self.slides: dict[tuple[int, int], SlideMotion] = {}
        self.reachable = np.isfinite(path)
        self._drive()

    def _fixed(self, p: complex) -> PointMotion:
        return PointMotion(np.full_like(self.still, p), self.still, self.still)

    def _drive(self) -> None:
        q, zero, driver = self.path, np.zeros_like(self.path), self.linkage.driver
        if isinstance(driver, Crank):
            link, origin = LinkMotion(q, zero + self.rate, zero), self.points[driver.centre]
            pin = carried(origin, link, origin.p + driver.length * unit(q))
        else:
            if driver.guide.link != GROUND:
                raise ValueError("the guide of a sliding driver must be fixed to the ground")
            d = unit(driver.guide.angle)
            pin = PointMotion(driver.guide.at + q * d, np.full_like(self.still, self.rate * d), self.still)
            link, origin = LinkMotion(zero + driver.guide.angle, zero, zero), pin
            self.slides[GROUND, DRIVER] = SlideMotion(q, zero + self.rate, zero, np.full_like(self.still, d))
        self.points[driver.pin] = pin
        self._place(DRIVER, link, origin)

    def _place(self, number: int, link: LinkMotion, origin: PointMotion) -> None:
        """Enter a link and the points fixed to it."""
        self.links[number], self.origins[number] = link, origin
        for point in self.linkage.points:
            if point.link == number:
                self.points[point.name] = carried(origin, link, origin.p + point.local * unit(link.angle))

    def _end(self, end: str | Guide) -> End:
        if isinstance(end, str):
            return self.points[end]
        carrier, origin = self.links[end.link], self.origins[end.link]
        turned = unit(carrier.angle)
        at = carried(origin, carrier, origin.p + end.at * turned)
        return Rail(end.link, at, turned * unit(end.angle), carrier)

    def add(self, dyad: Dyad) -> None:
        """Assemble one group and note where it cannot be."""
        sign = np.full(self.path.shape, float(dyad.sign))
        group = assemble(dyad, self._end(dyad.start), self._end(dyad.end), sign)
        parts = (group.middle.p, group.middle.a, *(part for link in group.links for part in (link.angle, link.epsilon)))
        self.reachable = self.reachable & np.isfinite(parts).all(axis=0)
        self.points[dyad.middle] = group.middle
        self.slides.update(group.slides)
        for number, link, origin in zip(dyad.links, group.links, group.origins, strict=True):
            self._place(number, LinkMotion(_continuous(link.angle), link.omega, link.epsilon), origin)

    def motion(self, driver: Floats, kept: Places) -> Motion:
        """The result at the positions asked for; the substeps are dropped."""
        return Motion(
            driver=driver,
            rate=self.rate,
            links={number: _take(link, kept) for number, link in self.links.items() if number != GROUND},
            points={name: _take(point, kept) for name, point in self.points.items()},
            slides={key: _take(slide, kept) for key, slide in self.slides.items()},
            origins={number: _take(origin, kept) for number, origin in self.origins.items()},
            reachable=self.reachable[kept],
        )


def _take(motion: Arrays, kept: Places) -> Arrays:
    if isinstance(kept, slice):
        return motion
    return type(motion)(*(getattr(motion, field.name)[kept] for field in fields(motion)))


def _continuous(angle: Floats) -> Floats:
    """The angle without jumps of 2π; gaps of nan are stepped over."""
    finite = np.isfinite(angle)
    if finite.all():
        return np.unwrap(angle)
    result = angle.copy()
    result[finite] = np.unwrap(angle[finite])
    return result
