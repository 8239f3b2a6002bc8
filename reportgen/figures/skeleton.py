"""Any linkage at one position as plain geometry in mm: bars between joints, slides on guides, pivots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.figures.geometry import Complexes, polar
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Dyad, Guide, Linkage, SlidingDriver


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
        slides.append(_on_guide(motion, index, scale, link, name, guide, turns))

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
                slides.append(_on_link(motion, index, scale, dyad, start))
            case "PRP", Guide() as first, Guide() as second:
                slide(i, dyad.middle, first, True)
                slide(j, dyad.middle, second, True)
                joints.append(dyad.middle)
            case "RPP", str(start), Guide() as guide:
                slides.append(_on_link(motion, index, scale, dyad, start))
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


def _span(along: np.ndarray, scale: float) -> tuple[float, float]:
    finite = along[np.isfinite(along)]
    return (float(finite.min()) * scale, float(finite.max()) * scale) if finite.size else (0.0, 0.0)


def _stretch(
    index: int, scale: float, p: Complexes, base: Complexes, direction: Complexes
) -> tuple[complex, complex]:
    """The ends (mm, at this position) of the part of a line that a point travels on."""
    low, high = _span(((p - base) * direction.conj()).real, scale)
    foot, u = complex(base[index]) * scale, complex(direction[index])
    return foot + low * u, foot + high * u


def _on_guide(
    motion: Motion, index: int, scale: float, link: int, name: str, guide: Guide, turns: bool
) -> Slide:
    carrier = motion.links[guide.link].angle if guide.link != GROUND else np.zeros_like(motion.driver)
    origin = motion.origins[guide.link].p if guide.link != GROUND else np.zeros(len(carrier), complex)
    turned = np.exp(1j * carrier)
    direction = turned * polar(guide.angle)
    p = motion.points[name].p
    low, high = _stretch(index, scale, p, origin + guide.at * turned, direction)
    angle = float(carrier[index]) + guide.angle
    return Slide(link, name, guide.link, complex(p[index]) * scale, angle, low, high, turns)


def _on_link(motion: Motion, index: int, scale: float, dyad: Dyad, start: str) -> Slide:
    """The block i at its pin P on the line of link j (RPR through the side of T, RPP through Q)."""
    i, j = dyad.links
    angle = motion.links[j].angle + (dyad.slide_angle if dyad.kind == "RPP" else 0.0)
    direction = np.exp(1j * angle)
    p, base = motion.points[start].p, motion.origins[j].p
    if dyad.kind == "RPR":
        base = base + 1j * dyad.lengths[1] * direction
    low, high = _stretch(index, scale, p, base, direction)
    return Slide(i, start, j, complex(p[index]) * scale, float(angle[index]), low, high, True)
