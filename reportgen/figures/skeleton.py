"""Any linkage at one position as plain geometry in mm: bars between joints, slides on guides, pivots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.figures.geometry import Complexes, Floats
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Dyad, Guide, Linkage, SlidingDriver

Line = tuple[Floats, Complexes]
"""A line at all positions: its direction (radians) and a point of it."""


@dataclass(frozen=True, slots=True)
class Slide:
    """A block of `link` at its point `name` on a guide of link `on`, along `angle` from `low` to `high`."""

    link: int
    name: str
    on: int
    at: complex
    angle: float
    low: complex
    high: complex
    turns: bool
    """Whether the block is a link of its own, pinned at its middle, and not an end of a longer one."""


@dataclass(frozen=True, slots=True)
class Skeleton:
    """Points in mm by name, joints of each moving link, slides, ground pivots.

    `owners` gives the link of each further point (mass centres, coupler points); `reached` is false where the
    mechanism cannot take the position.
    """

    points: Mapping[str, complex]
    bars: Mapping[int, tuple[str, ...]]
    slides: tuple[Slide, ...]
    pivots: tuple[str, ...]
    joints: tuple[str, ...]
    owners: Mapping[str, int]
    reached: bool

    def slide_of(self, link: int) -> Slide | None:
        """The slide whose block is the link."""
        return next((slide for slide in self.slides if slide.link == link), None)


def skeleton(linkage: Linkage, motion: Motion, index: int, scale: float) -> Skeleton:
    """The mechanism at position `index`, `scale` mm of paper per m; guides as long as the motion needs."""
    points = {name: complex(point.p[index]) * scale for name, point in motion.points.items()}
    bars: dict[int, list[str]] = {link: [] for link in linkage.links}
    slides: list[Slide] = []
    pivots: list[str] = []
    joints: list[str] = []
    owners = {point.name: point.link for point in linkage.points}

    def pin(name: str, link: int) -> None:
        """A revolute joint of `link` at a point that another link carries."""
        if name in linkage.ground and name not in pivots:
            pivots.append(name)
        for number in (link, owners.get(name, GROUND)):
            if number in bars and name not in bars[number]:
                bars[number].append(name)
        if name not in joints:
            joints.append(name)

    def slide(link: int, name: str, guide: Guide, turns: bool) -> None:
        line = _of_guide(motion, guide)
        slides.append(_slide(motion, index, scale, link, name, guide.link, turns, line))

    def slide_on_link(dyad: Dyad, name: str) -> None:
        line = _of_link(motion, dyad)
        slides.append(_slide(motion, index, scale, dyad.links[0], name, dyad.links[1], True, line))

    driver = linkage.driver
    if isinstance(driver, Crank):
        pin(driver.centre, DRIVER)
        pin(driver.pin, DRIVER)
    elif isinstance(driver, SlidingDriver):
        slide(DRIVER, driver.pin, driver.guide, True)
        pin(driver.pin, DRIVER)
    for dyad in linkage.dyads:
        i, j = dyad.links
        if isinstance(dyad.start, str):
            pin(dyad.start, i)
        if isinstance(dyad.end, str):
            pin(dyad.end, j)
        if dyad.kind in ("RRR", "RRP"):
            pin(dyad.middle, i)
        match dyad.kind, dyad.start, dyad.end:
            case "RRR", _, _:
                pin(dyad.middle, j)
            case "RRP", _, Guide() as guide:
                slide(j, dyad.middle, guide, True)
            case "RPR", str(start), _:
                slide_on_link(dyad, start)
            case "PRP", Guide() as first, Guide() as second:
                slide(i, dyad.middle, first, True)
                slide(j, dyad.middle, second, True)
                joints.append(dyad.middle)
            case "RPP", str(start), Guide() as guide:
                slide_on_link(dyad, start)
                slide(j, dyad.middle, guide, False)
    return Skeleton(
        points,
        {link: tuple(names) for link, names in bars.items()},
        tuple(slides),
        tuple(pivots),
        tuple(joints),
        owners,
        bool(motion.reachable[index]),
    )


def _slide(
    motion: Motion, index: int, scale: float, link: int, name: str, on: int, turns: bool, line: Line
) -> Slide:
    """The block of a link at a point on a line of link `on`, between the ends of the point's way on it."""
    angle, base = line
    p, direction = motion.points[name].p, np.exp(1j * angle)
    along = ((p - base) * direction.conj()).real
    along = along[np.isfinite(along)] * scale
    low, high = (float(along.min()), float(along.max())) if along.size else (0.0, 0.0)
    foot, u = complex(base[index]) * scale, complex(direction[index])
    return Slide(link, name, on, complex(p[index]) * scale, float(angle[index]), foot + low * u, foot + high * u, turns)


def _of_guide(motion: Motion, guide: Guide) -> Line:
    if guide.link == GROUND:
        return np.full(motion.driver.shape, guide.angle), np.full(motion.driver.shape, guide.at)
    carrier = motion.links[guide.link].angle
    return carrier + guide.angle, motion.origins[guide.link].p + guide.at * np.exp(1j * carrier)


def _of_link(motion: Motion, dyad: Dyad) -> Line:
    """The line of link j on which the block i slides at its pin P (RPR through the side of T, RPP through Q)."""
    link = dyad.links[1]
    if dyad.kind == "RPP":
        return motion.links[link].angle + dyad.slide_angle, motion.origins[link].p
    angle = motion.links[link].angle
    return angle, motion.origins[link].p + 1j * dyad.lengths[1] * np.exp(1j * angle)
