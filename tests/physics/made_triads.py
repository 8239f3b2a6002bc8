"""Linkages with groups of class III to test with: the reference case R1, and random ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from reportgen.base.records import replace
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint, SlidingDriver, Triad, TriadLeg
from reportgen.machine.kinematics import course_of, solve_motion

DEGREE = math.pi / 180

PLATE = 0.1 + 0j, 0.06 + 0.14j
R1 = Linkage(
    ground={"O": 0j, "B": 0.3 - 0.03j, "C": 0.07 + 0.3j},
    driver=Crank("O", "A", 0.05),
    groups=(
        Triad(
            plate=3,
            legs=(TriadLeg(2, "A", "D", 0.13), TriadLeg(4, "B", "E", 0.19), TriadLeg(5, "C", "F", 0.15)),
            at=PLATE,
            near=(("D", 0.083 + 0.16j),),
            near_at=60 * DEGREE,
        ),
    ),
    points=(
        LinkPoint("S2", 2, 0.065),
        LinkPoint("S3", 3, sum(PLATE) / 3),
        LinkPoint("S4", 4, 0.095),
        LinkPoint("S5", 5, 0.075),
    ),
    inertias=(
        Inertia(2, "S2", 1.2, 1.2 * 0.13**2 / 12),
        Inertia(3, "S3", 4.0, 0.012),
        Inertia(4, "S4", 1.6, 1.6 * 0.19**2 / 12),
        Inertia(5, "S5", 1.3, 1.3 * 0.15**2 / 12),
    ),
)

CLEAR = 0.05
"""Determinant of the legs over the plate's size below which a position counts as near a dead point."""


def random_places(rng: np.random.Generator, count: int) -> list[complex]:
    return [complex(x, y) for x, y in rng.uniform(-1, 1, (count, 2))]


def triad(rng: np.random.Generator, links: Sequence[int], outer: Sequence[tuple[str, complex]], at: float) -> Triad:
    """A triad on placed points, with its inner joints anywhere, assembled at the driver's coordinate `at`."""
    while True:
        inner = random_places(rng, 3)
        if min(abs(q - p) for q, (_, p) in zip(inner, outer, strict=True)) > 0.1 and abs(inner[1] - inner[0]) > 0.1:
            break
    first, plate, *others = links
    axis = (inner[1] - inner[0]) / abs(inner[1] - inner[0])
    names = [f"Q{link}" for link in (first, *others)]
    legs = tuple(
        TriadLeg(link, name, q, abs(place - p))
        for link, (name, p), q, place in zip((first, *others), outer, names, inner, strict=True)
    )
    local = tuple((place - inner[0]) / axis for place in inner[1:])
    return Triad(plate, legs, local, tuple(zip(names, inner, strict=True)), at)


def placed(linkage: Linkage, at: float, names: Sequence[str]) -> list[tuple[str, complex]]:
    """The points of a linkage with their places at the driver's coordinate `at`."""
    points = solve_motion(linkage, [at], 1.0).points
    return [(name, complex(points[name].p[0])) for name in names]


def random_linkages(count: int, rng: np.random.Generator, chained: bool = False) -> Iterator[Linkage]:
    """Cranks or slides with a triad; `chained` ones have a dyad before it, a dyad and a triad after it."""
    for number in range(count):
        at = float(rng.uniform(-3, 3))
        o, e, b, c = random_places(rng, 4)
        sliding = chained and number % 2 == 1
        driver = SlidingDriver("A", Guide(o, 0.4)) if sliding else Crank("O", "A", float(rng.uniform(0.1, 0.5)))
        linkage = Linkage({"O": o, "E": e, "B": b, "C": c}, driver, (), (LinkPoint("T1", 1, 0.1 + 0.2j),))
        hanging = ["A", "B", "C"]
        if chained:
            (_, p), (_, t) = placed(linkage, at, ("A", "E"))
            (q,) = random_places(rng, 1)
            sign = 1 if (np.conj(t - p) * (q - p)).imag > 0 else -1
            dyad = Dyad("RRR", (6, 7), "A", "M", "E", (abs(q - p), abs(q - t)), sign)
            linkage = replace(linkage, groups=(dyad,))
            hanging = ["T1", "M", "B"]
        linkage = replace(linkage, groups=(*linkage.groups, triad(rng, (2, 3, 4, 5), placed(linkage, at, hanging), at)))
        if chained:
            second = triad(rng, (8, 9, 10, 11), placed(linkage, at, ("Q2", "C", "Q5")), at)
            linkage = replace(linkage, groups=(*linkage.groups, second))
        tips = tuple(LinkPoint(f"S{link}", link, complex(*rng.uniform(-0.5, 0.5, 2))) for link in linkage.links)
        masses = tuple(Inertia(link, f"S{link}", *map(float, rng.uniform(0.1, 2, 2))) for link in linkage.links)
        yield replace(linkage, points=(*linkage.points, *tips), inertias=masses)


def clear_places(linkage: Linkage, rng: np.random.Generator, count: int) -> np.ndarray:
    """Random coordinates of the driver within the courses of all triads, away from dead points."""
    near = linkage.triads[0].near_at
    if isinstance(linkage.driver, Crank):
        places = near + rng.uniform(-math.pi, math.pi, 8 * count)
    else:
        places = near + rng.uniform(-0.1, 0.1, 8 * count)
    clear = solve_motion(linkage, places, 1.0).reachable
    ends = [*places, near]
    travel = None if isinstance(linkage.driver, Crank) else (min(ends), max(ends))
    for group in linkage.triads:
        course = course_of(linkage, group, travel)
        if not course.driver.size:
            return places[:0]
        at, inside = course.inside(places)
        clear &= inside & (np.abs(np.interp(at, course.driver, course.determinant)) > CLEAR)
    return np.sort(places[clear])[:count]
