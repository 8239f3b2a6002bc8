"""The numbers of a linkage as one array, and how they follow the values of a file: `numbers`, `rebuilt`, `Course`.

A pulled point needs linkages for many values at once. They are made from the linkages of a few values, without reading
the file again.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.base.records import Record, replace
from reportgen.machine import Crank, Group, Guide, Linkage, Triad

SAME = 1e-9
"""Relative difference below which two numbers are equal."""


def numbers(linkage: Linkage) -> Complexes:
    """Return fixed points (m), the driver's and the groups' lengths (m) and angles (rad), points of links (m) [N]."""
    return np.array([number for _, number in _entries(linkage)], dtype=np.complex128)


def placed(linkage: Linkage) -> list[str]:
    """Return the point that each of the `numbers` places [N]: the pin of a crank or group, or a point by its name."""
    return [point for point, _ in _entries(linkage)]


def _entries(linkage: Linkage) -> Iterator[tuple[str, complex]]:
    yield from linkage.ground.items()
    driver = linkage.driver
    if isinstance(driver, Crank):
        yield driver.pin, driver.length
    else:
        yield from _of_guide(driver.pin, driver.guide)
    for dyad in linkage.groups:
        if isinstance(dyad, Triad):
            yield from ((leg.inner, leg.length) for leg in dyad.legs)
            yield from zip((leg.inner for leg in dyad.legs[1:]), dyad.at, strict=True)
            yield from dyad.near
            yield dyad.legs[0].inner, dyad.near_at
            continue
        yield from ((dyad.middle, number) for number in (*dyad.lengths, dyad.slide_angle))
        for end in (dyad.start, dyad.end):
            if isinstance(end, Guide):
                yield from _of_guide(dyad.middle, end)
    yield from ((point.name, point.local) for point in linkage.points)


def _of_guide(point: str, guide: Guide) -> Iterator[tuple[str, complex]]:
    yield point, guide.at
    yield point, guide.angle


def rebuilt(linkage: Linkage, given: Complexes) -> Linkage:
    """Return a linkage of the same structure with other `numbers` [N]."""
    following = iter(given.tolist())

    def real() -> float:
        return float(next(following).real)

    def guide(old: Guide) -> Guide:
        return replace(old, at=complex(next(following)), angle=real())

    ground = {name: complex(next(following)) for name in linkage.ground}
    driver = linkage.driver
    driver = replace(driver, length=real()) if isinstance(driver, Crank) else replace(driver, guide=guide(driver.guide))

    def triad(old: Triad) -> Triad:
        first, second, third = (replace(leg, length=real()) for leg in old.legs)
        at = complex(next(following)), complex(next(following))
        near = tuple((name, complex(next(following))) for name, _ in old.near)
        return replace(old, legs=(first, second, third), at=at, near=near, near_at=real())

    groups: list[Group] = []
    for dyad in linkage.groups:
        if isinstance(dyad, Triad):
            groups.append(triad(dyad))
            continue
        lengths, slide = (real(), real()), real()
        start, end = (guide(end) if isinstance(end, Guide) else end for end in (dyad.start, dyad.end))
        groups.append(replace(dyad, lengths=lengths, slide_angle=slide, start=start, end=end))
    points = tuple(replace(point, local=complex(next(following))) for point in linkage.points)
    return replace(linkage, ground=ground, driver=driver, groups=tuple(groups), points=points)


class Course(Record):
    """How the numbers of a linkage [N] follow one value, by their differences at `-step` and `+step`.

    A number follows as (a + bh)/(1 + ch), which is exact for a sum, a product and a quotient, or as a parabola where
    no such curve exists.
    """

    step: float
    before: Complexes
    after: Complexes
    here: Complexes

    def change(self, by: float) -> Complexes:
        """Return the differences of the numbers [N] at another value, `by` in its unit from here."""
        h = by / self.step
        # f(h) = h (p + q h) as a parabola, f(h) = h p / (1 + c h) as a quotient with the same two differences.
        p, q = (self.after - self.before) / 2, (self.after + self.before) / 2
        parabola = h * (p + q * h)
        with np.errstate(divide="ignore", invalid="ignore"):
            c = -q / p
            quotient = h * (p + q * c) / (1 + c * h)
        # The numbers of quotients are real; beside the pole, and for an even curve, a parabola stays finite.
        fits = (self.here.imag == 0) & (np.abs(c.real) < 0.5) & (1 + c.real * h > 0.2)
        return np.where(fits & np.isfinite(quotient), quotient, parabola)

    @property
    def moves(self) -> np.ndarray:
        """Flags of the numbers [N] that follow the value."""
        size = np.maximum(np.abs(self.here), SAME)
        return np.asarray(np.maximum(np.abs(self.before), np.abs(self.after)) > SAME * size)
