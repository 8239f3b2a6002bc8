"""The chapter on instant centres: which links have one, how it lies at a position, and its drawing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from reportgen.document.facts import Facts
from reportgen.document.pictured import A3_ACROSS, A3_UPRIGHT, WHITE, Drawn, Pictured, on_paper
from reportgen.figures.positions import Centre, centre_plan
from reportgen.ledger.kinematics.centres import PREFIX, centre_symbol, links_in_plane_motion
from reportgen.ledger.kinematics.sides import scheme
from reportgen.mechanism.structure import DRIVER, GROUND

ROOM = 24.0
"""What margins, labels and the scale take of a drawing's page (mm), across and upwards."""


@dataclass(frozen=True, slots=True)
class PlaneLink:
    """A link in plane motion: its number, its points with drawn velocities, their `rod` and their `group`."""

    link: int
    base: str
    point: str
    rod: str
    group: str


def plane_links(facts: Facts) -> tuple[PlaneLink, ...]:
    """The links that turn about no fixed point and are no mere sliders, in the order of assembly."""
    turns = links_in_plane_motion(scheme(facts.analysis.machine.linkage))
    names = {link: group.name for group in facts.groups for link in (group.i, group.j)}
    return tuple(PlaneLink(turn.link, turn.base, turn.point, turn.rod, names[turn.link]) for turn in turns)


def with_centres(outline: tuple[str, ...], links: tuple[PlaneLink, ...]) -> Iterator[str]:
    """The sections of a report, the one on instant centres behind the velocities if any link has one."""
    last = max((outline.index(name) for name in ("velocity", "summary") if name in outline), default=-1)
    for index, section in enumerate(outline):
        yield section
        if links and index == last:
            yield "centres"


@dataclass(frozen=True)
class CentrePictures(Pictured):
    """The mechanism with the instant centres of its links."""

    @property
    def figures(self) -> dict[str, Callable[..., Drawn]]:
        return {"centres": self.centres}

    def state(self, link: PlaneLink, k: int) -> str:
        """How a link's centre lies: "found", "shift" (the link does not turn), "rest" (at its base), "far"."""
        ledger = self.ledger
        if ledger[f"omega.{link.link}"].at(k) == 0:
            return "shift"
        if ledger[f"v.{link.base}"].at(k) == 0:
            return "rest"
        lengths = [ledger[f"{PREFIX}seg.{link.link}.{name}"].at(k) for name in (link.base, link.point)]
        return "found" if np.isfinite(lengths).all() else "far"

    def drawn(self, k: int) -> tuple[PlaneLink, ...]:
        """The links whose centres stand on the sheet together with the mechanism."""
        motion = self.analysis.motion
        spots = [complex(point.p[k - 1]) * self.scale for point in motion.points.values()]
        kept: list[PlaneLink] = []
        for link in plane_links(self.facts):
            if self.state(link, k) != "found":
                continue
            spots.append(self._place(link, k))
            if _fits(np.array(spots)):
                kept.append(link)
            else:
                spots.pop()
        return tuple(kept)

    def _place(self, link: PlaneLink, k: int) -> complex:
        return complex(self.ledger[f"{PREFIX}{link.link}"].at(k)) * self.scale

    def centres(self, k: int) -> Drawn:
        """The mechanism at a position, true to μ_l, with the normals that meet in the centres."""
        machine = self.analysis.machine
        marks = [
            Centre(centre_symbol(link.link), self._place(link, k), (link.base, link.point)) for link in self.drawn(k)
        ]
        links = (GROUND, DRIVER, *(link for link in machine.linkage.links if link != DRIVER))
        looks = self.looks(self.scale)
        return on_paper(centre_plan(machine.linkage, self.analysis.motion, k - 1, self.scale, links, marks, looks))


def _fits(spots: np.ndarray) -> bool:
    """Whether a drawing of these spots (mm) has room on a page, upright or across."""
    wide, high = float(np.ptp(spots.real)) + ROOM, float(np.ptp(spots.imag)) + ROOM
    return any(wide <= paper[0] - WHITE[0] and high <= paper[1] - WHITE[1] for paper in (A3_ACROSS, A3_UPRIGHT))
