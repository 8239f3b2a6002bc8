"""What all drawings of a machine share: paper, the report's facts, μ_l and what is drawn of each link."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from reportgen.analysis import Analysis
from reportgen.document.facts import Facts
from reportgen.figures.draft import sheets
from reportgen.figures.plan import Plan
from reportgen.figures.scene import Scene
from reportgen.figures.scheme import Looks
from reportgen.ledger.core import Ledger
from reportgen.mechanism.structure import DRIVER
from reportgen.notation.expressions import Chain, Number

MM = 1e3
A3_UPRIGHT, A3_ACROSS = (297.0, 420.0), (420.0, 297.0)
TEXT_BLOCK = (160.0, 225.0)
"""What of an A4 page a figure may fill with its caption."""
WHITE = (40.0, 64.0)
"""What of a plate's page (mm) its margins, header and caption take."""
HALF = 0.5
CLOSE = 5.5
"""What of their margins (mm) scenes of one figure give up to stand side by side."""
SCHEME_BOX = (120.0, 130.0)
DENSE = 361
SAME = 1e-9
"""Cycle angles nearer than this are one."""
SHOWN_AT = 1
"""The position (from 0) at which schemes are drawn: the first one away from the start."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """The scenes of a figure; `paper` (mm) asks for a page of its own for each."""

    scenes: tuple[Scene, ...]
    paper: tuple[float, float] | None = None
    note: Chain | None = None
    """A scale to print behind the caption."""


def on_paper(scene: Scene) -> Drawn:
    """A scene in the text if it fits there in true size, else on a page large enough for it."""
    if scene.width <= TEXT_BLOCK[0] and scene.height <= TEXT_BLOCK[1]:
        return Drawn((scene,))
    for paper in (A3_ACROSS, A3_UPRIGHT):
        if scene.width <= paper[0] - WHITE[0] and scene.height <= paper[1] - WHITE[1]:
            return Drawn((scene,), paper)
    return Drawn((scene,), (max(scene.width + WHITE[0], 297.0), max(scene.height + WHITE[1], 210.0)))


def beside_one_another(*scenes: Scene) -> Drawn:
    """Scenes close together if they fit a text block so, else as they are; on pages of their own if they must."""
    together = sheets(scenes, *TEXT_BLOCK, trim=CLOSE)
    if len(together) == 1 and together[0].width <= TEXT_BLOCK[0] and together[0].height <= TEXT_BLOCK[1]:
        return Drawn(together)
    large = any(scene.width > TEXT_BLOCK[0] or scene.height > TEXT_BLOCK[1] for scene in scenes)
    return Drawn(scenes, A3_ACROSS if large else None)


@dataclass(frozen=True)
class Pictured:
    """A report whose machine is drawn; `velocity_plan` gives the plan that the lever is made of."""

    facts: Facts
    words: Mapping[str, Any]
    velocity_plan: Callable[[int], Plan]

    @property
    def ledger(self) -> Ledger:
        return self.facts.ledger

    @property
    def analysis(self) -> Analysis:
        return self.facts.analysis

    @property
    def scale(self) -> float:
        """mm of paper for a metre, of drawings to μ_l."""
        return MM / float(self.ledger.families["mu.l"].values[0])

    def length_scale(self, factor: float = 1.0) -> Chain:
        """μ_l as printed below a figure; a figure drawn smaller by `factor` has a scale that much larger."""
        number = self.ledger.number("mu.l")
        return Chain((self.ledger.symbol("mu.l"), short(replace(number, value=number.value / factor))))

    def looks(self, scale: float, factor: float = 1.0) -> Looks:
        """Pistons with their bore, mass centres, the figure's scale."""
        machine = self.analysis.machine
        blocks = {
            piston.link: (min(0.6 * piston.bore * scale, 24.0), min(piston.bore * scale, 40.0) * 0.5)
            for piston in machine.pistons
        }
        names = {*self.analysis.motion.points}
        jointed = {group.Q for group in self.facts.groups} | {group.P for group in self.facts.groups}
        centres = tuple(
            body.centre
            for body in machine.linkage.inertias
            if body.centre in names and body.centre not in jointed
        )
        return Looks(blocks=blocks, centres=centres, scale=self.length_scale(factor))

    def pin_of(self, reaction: str) -> str:
        """The pin of the crank at which a group's reaction acts."""
        link = reaction.removeprefix("R")[: -len(str(DRIVER))]
        return next(group.P for group in self.facts.groups if str(group.i) == link)


def short(number: Number) -> Number:
    """The number as it is if it has few digits, else with the decimals it came with."""
    tidy = float(f"{number.value:.6g}")
    return replace(number, value=tidy, decimals=None)
