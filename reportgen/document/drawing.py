"""What all figures of a report share: their names, the paper they stand on, the scale μ_l, how links look.

A figure is a function of a report and of what it shows.  Registered under a name it is called as
`figure(name, …)`, with the caption that `words.yaml` has for it under `captions`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from reportgen.catalogue.machine import Position
from reportgen.document.groups import GroupView
from reportgen.document.report import FUNCTIONS, Report
from reportgen.document.tree import Figure, InlineMath, Plate, Text
from reportgen.figures.draft import sheets
from reportgen.figures.scene import Scene
from reportgen.figures.scheme import Looks
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


@dataclass(frozen=True, slots=True)
class Drawn:
    """The scenes of a figure; `paper` (mm) asks for a page of its own for each."""

    scenes: tuple[Scene, ...]
    paper: tuple[float, float] | None = None
    note: Chain | None = None
    """A scale to print behind the caption."""


FIGURES: dict[str, tuple[str, Callable[..., Drawn]]] = {}


def figure(name: str, key: str = "") -> Callable[[Callable[..., Drawn]], Callable[..., Drawn]]:
    """Register a figure under the name by which templates call it; `key` is what its references begin with."""

    def register(draw: Callable[..., Drawn]) -> Callable[..., Drawn]:
        FIGURES[name] = key or f"fig.{name}", draw
        return draw

    return register


def insert_figure(report: Report, name: str, *arguments: Any) -> tuple[Figure | Plate, ...]:
    """A registered figure: `figure(name, …)`, or `figure(name, key, caption, …)` with words of its own.

    A figure on plates is a block for each of them, and the key names the first.  Raises `KeyError` for a
    name that nobody draws.
    """
    key, draw = FIGURES[name]
    if arguments and isinstance(arguments[0], str):
        key, caption, *shown = arguments
    else:
        shown = list(arguments)
        group = next((one for one in shown if isinstance(one, GroupView)), None)
        position = next((one for one in shown if isinstance(one, Position)), None)
        key = ".".join(str(part) for part in (key, group, position) if part is not None)
        caption = report.words["captions"][name].format(k=position, g=group)
    drawn = draw(report, *shown)
    inlines = report.prose.inlines(caption)
    if drawn.note is not None:
        inlines = (*inlines, Text("; "), InlineMath(drawn.note))
    if drawn.paper is None:
        return (Figure(drawn.scenes, inlines, key),)
    count = len(drawn.scenes)
    return tuple(
        Plate(
            scene,
            drawn.paper,
            inlines if count == 1 else (*inlines, Text(f" ({index}/{count})")),
            key if index == 1 else f"{key}.{index}",
        )
        for index, scene in enumerate(drawn.scenes, start=1)
    )


FUNCTIONS["figure"] = insert_figure


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


def drawing_scale(report: Report) -> float:
    """mm of paper for a metre, of drawings to μ_l."""
    return MM / float(report.ledger["mu.l"].values[0])


def scale_note(report: Report, id: str, factor: float = 1.0) -> Chain:
    """A scale as printed below a figure; a figure drawn smaller by `factor` has a scale that much larger."""
    number = report.ledger.number(id)
    return Chain((report.ledger.symbol(id), short(replace(number, value=number.value / factor))))


def looks(report: Report, scale: float, factor: float = 1.0) -> Looks:
    """Pistons with their bore, mass centres, the figure's scale."""
    blocks = {
        piston.link: (min(0.6 * piston.bore * scale, 24.0), min(piston.bore * scale, 40.0) * 0.5)
        for piston in report.machine.pistons
    }
    jointed = {name for group in report.groups for name in (group.P, group.Q)}
    names = report.analysis.motion.points.keys() - jointed
    centres = tuple(body.centre for body in report.machine.linkage.inertias if body.centre in names)
    return Looks(blocks=blocks, centres=centres, scale=scale_note(report, "mu.l", factor))


def short(number: Number) -> Number:
    """The number as it is, to six digits at most."""
    return replace(number, value=float(f"{number.value:.6g}"), decimals=None)
