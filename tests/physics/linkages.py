"""Linkages to test with: made by Hypothesis, and told as plain bodies and joints to the witness.

A made linkage is assembled at a reference position by choice of its points; lengths, offsets and
signs follow from them, so that every linkage exists there.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import newton_euler as ne
import numpy as np
from hypothesis import strategies as st

from reportgen.base.records import replace
from reportgen.machine import Crank, Dyad, DyadKind, Guide, Inertia, Linkage, LinkPoint, SlidingDriver, Triad
from reportgen.machine.force_analysis import Load, reaction_name
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.rigid_motion import cross, dot

KINDS: tuple[DyadKind, ...] = ("RRR", "RRP", "RPR", "PRP", "RPP")
REFERENCE = 0.7
"""Driver coordinate (rad or m) where made linkages are assembled."""


# --- told as bodies and joints ---------------------------------------------------------------------


def bodies(linkage: Linkage) -> dict[int, ne.Body]:
    found = {link: ne.Body(0.0, 0.0, 0j) for link in linkage.links}
    for body in linkage.inertias:
        found[body.link] = ne.Body(body.mass, body.moment, _on(linkage, body.link, body.centre))
    return found


def _on(linkage: Linkage, link: int, name: str) -> complex:
    """The local coordinate of a point on a link: its own, or a joint that is named for the other link in it."""
    owner, local = locals_of(linkage)[name]
    if owner == link:
        return local
    if link == 1:
        # The crank's own axis, a point of the ground.
        return 0j
    legs = {leg.link: leg for triad in linkage.triads for leg in triad.legs}
    if link in legs:
        return complex(legs[link].length) if name == legs[link].inner else 0j
    dyad = next(dyad for dyad in linkage.dyads if link in dyad.links)
    return complex(dyad.lengths[1]) if name == dyad.middle else 0j


def locals_of(linkage: Linkage) -> dict[str, tuple[int, complex]]:
    """(link, local coordinate) of every named point, from the description alone."""
    places = {name: (0, p) for name, p in linkage.ground.items()}
    driver = linkage.driver
    places[driver.pin] = (1, complex(driver.length) if isinstance(driver, Crank) else 0j)
    for dyad in linkage.dyads:
        i, j = dyad.links
        if dyad.kind in ("RRR", "RRP"):
            places[dyad.middle] = (i, complex(dyad.lengths[0]))
        elif dyad.kind == "PRP":
            places[dyad.middle] = (i, 0j)
        elif dyad.kind == "RPP":
            places[dyad.middle] = (j, 0j)
    for triad in linkage.triads:
        for leg, local in zip(triad.legs, (0j, *triad.at), strict=True):
            places[leg.inner] = (triad.plate, local)
    return places | {point.name: (point.link, point.local) for point in linkage.points}


def joints(linkage: Linkage) -> list[ne.Pin | ne.Slot]:
    """Driver's joint, then those of the groups: start, inner and end of a dyad, outer and inner of a triad's legs."""
    at = locals_of(linkage)
    driver = linkage.driver
    found: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, linkage.ground[driver.centre], 1, 0j)
        if isinstance(driver, Crank)
        else ne.Slot(0, driver.guide.at, driver.guide.angle, 1, 0j, driver.guide.angle)
    ]

    def outer(end: str | Guide, link: int) -> ne.Pin | ne.Slot:
        if isinstance(end, Guide):
            return ne.Slot(end.link, end.at, end.angle, link, 0j, end.angle)
        return ne.Pin(*at[end], link, 0j)

    for dyad in linkage.groups:
        if isinstance(dyad, Triad):
            for leg in dyad.legs:
                found += [ne.Pin(*at[leg.outer], leg.link, 0j), ne.Pin(leg.link, leg.length, *at[leg.inner])]
            continue
        i, j = dyad.links
        inner: dict[str, ne.Pin | ne.Slot] = {
            "RRR": ne.Pin(i, dyad.lengths[0], j, dyad.lengths[1]),
            "RRP": ne.Pin(i, dyad.lengths[0], j, 0j),
            "PRP": ne.Pin(i, 0j, j, 0j),
            "RPR": ne.Slot(j, 1j * dyad.lengths[1], 0.0, i, 0j, 0.0),
            "RPP": ne.Slot(j, 0j, dyad.slide_angle, i, 0j, 0.0),
        }
        found += [outer(dyad.start, i), inner[dyad.kind], outer(dyad.end, j)]
    return found


def reaction_keys(linkage: Linkage) -> list[str]:
    """Names of the reactions on the second body of each joint of `joints`."""
    return [reaction_name(joint.a, joint.b) for joint in joints(linkage)]


def told(linkage: Linkage) -> tuple[dict[int, ne.Body], list[ne.Pin | ne.Slot], list[str]]:
    """Bodies, joints, and the names of the reactions in them."""
    return bodies(linkage), joints(linkage), reaction_keys(linkage)


def poses(motion: Motion) -> Iterator[dict[int, tuple[complex, float]]]:
    """The poses of the moving bodies, position by position."""
    for k in range(motion.driver.size):
        yield {
            link: (complex(motion.origins[link].p[k]), float(motion.links[link].angle[k]))
            for link in motion.origins
            if link
        }


# --- made --------------------------------------------------------------------------------------------


def hundredths(first: int, last: int) -> st.SearchStrategy[float]:
    """Numbers of the size a drawing has, rather than the 1e-300 that Hypothesis likes to try."""
    return st.integers(first, last).map(lambda n: n / 100)


LENGTH = hundredths(10, 100)
ANGLE = hundredths(0, 628)
SHORTEST = 0.02
PLACE = st.builds(complex, hundredths(-100, 100), hundredths(-100, 100))
RATE = st.sampled_from((7.0, -7.0))


@st.composite
def linkages(draw: Any, kinds: tuple[DyadKind, ...], sliding: bool = False) -> Linkage:
    """A driver and one dyad of each of `kinds`, each on points or guides of any link before it."""
    ground = {"O": draw(PLACE), "E": draw(PLACE)}
    driver = SlidingDriver("A", Guide(draw(PLACE), draw(ANGLE))) if sliding else Crank("O", "A", draw(LENGTH))
    linkage = Linkage(ground, driver, (), (LinkPoint("T1", 1, draw(PLACE)),))
    hanging = ["A", "T1", "E"]
    for number, kind in enumerate(kinds):
        links = (2 + 2 * number, 3 + 2 * number)
        linkage = draw(_with_dyad(linkage, kind, links, hanging))
        tips = tuple(LinkPoint(f"T{link}", link, draw(PLACE)) for link in links)
        linkage = replace(linkage, points=(*linkage.points, *tips))
        hanging += [tip.name for tip in tips]
        if kind != "RPR":
            hanging.append(f"M{number}")
    masses = tuple(
        Inertia(link, f"T{link}", draw(hundredths(50, 200)), draw(hundredths(5, 50))) for link in linkage.links
    )
    return replace(linkage, inertias=masses)


@st.composite
def _with_dyad(draw: Any, linkage: Linkage, kind: DyadKind, links: tuple[int, int], hanging: list[str]) -> Linkage:
    now = solve_motion(linkage, REFERENCE, 1.0)

    def point() -> tuple[str, complex]:
        name = draw(st.sampled_from(hanging))
        return name, complex(now.points[name].p[0])

    def guide() -> tuple[Guide, complex, complex]:
        link = draw(st.sampled_from((0, *linkage.links)))
        made = Guide(draw(PLACE), draw(ANGLE), link)
        origin = complex(now.origins[link].p[0])
        turned = np.exp(1j * now.links[link].angle[0]) if link else 1.0
        return made, origin + made.at * turned, turned * np.exp(1j * made.angle)

    middle = f"M{(links[0] - 2) // 2}"
    if kind == "RRR":
        (start, p), (end, t) = point(), point()
        q = draw(PLACE.filter(lambda q: min(abs(q - p), abs(q - t)) > SHORTEST))
        sign = 1 if cross(t - p, q - p) >= 0 else -1
        dyad = Dyad(kind, links, start, middle, end, (abs(q - p), abs(q - t)), sign)
    elif kind == "RRP":
        (start, p), (rail, at, d) = point(), guide()
        q = at + draw(hundredths(-100, 100).filter(lambda s: abs(at + s * d - p) > SHORTEST)) * d
        sign = 1 if dot(d, q - p) >= 0 else -1
        dyad = Dyad(kind, links, start, middle, rail, (abs(q - p), 0.0), sign)
    elif kind == "RPR":
        (start, p), (end, t) = point(), point()
        offset = draw(hundredths(-90, 90)) * abs(p - t)
        dyad = Dyad(kind, links, start, middle, end, (0.0, offset), draw(st.sampled_from((1, -1))))
    elif kind == "PRP":
        dyad = Dyad(kind, links, guide()[0], middle, guide()[0])
    else:
        dyad = Dyad(kind, links, point()[0], middle, guide()[0], slide_angle=draw(hundredths(30, 284)))
    return replace(linkage, groups=(*linkage.groups, dyad))


@st.composite
def applied(draw: Any, linkage: Linkage) -> list[tuple[int, complex, complex, float]]:
    """A force at a point fixed on the paper and a couple on every link."""
    return [(link, 50 * draw(PLACE), draw(PLACE), draw(hundredths(-2000, 2000))) for link in linkage.links]


def as_loads(given: list[tuple[int, complex, complex, float]], motion: Motion) -> tuple[Load, ...]:
    still = np.zeros_like(motion.driver)
    return tuple(
        Load(f"F{link}", link, still + force, still + point, still + couple) for link, force, point, couple in given
    )
