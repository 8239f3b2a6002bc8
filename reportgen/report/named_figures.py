"""Registry of the figures of reports by their names in templates; `figure(report, name, …)` draws one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

from reportgen.base.languages import setting_of
from reportgen.base.records import replace
from reportgen.document import Figure, InlineMath, Inlines, Plate, Text
from reportgen.document.figure_placement import FigureScenes, close
from reportgen.machine.analysis import Position
from reportgen.report import (
    cycle_curves,
    force_figures,
    mechanism_figures,
    phrases,
    plan_figures,
    topic_views,
    triad_figures,
)
from reportgen.report.assur_view import AssurView
from reportgen.report.context import ReportContext
from reportgen.report.topic_views import DrawnFigure
from reportgen.report.triad_views import TriadView

VELOCITY, ACCELERATION = plan_figures.MotionFigures("v"), plan_figures.MotionFigures("a")

FIGURES: Mapping[str, tuple[str, Callable[..., FigureScenes]]] = {
    "line-styles": ("fig.line-styles", mechanism_figures.line_styles),
    # the machine
    "scheme": ("fig.scheme", mechanism_figures.scheme),
    "groups": ("fig.groups", mechanism_figures.groups),
    "positions": ("fig.positions", mechanism_figures.positions),
    "extremes": ("fig.extremes", mechanism_figures.extremes),
    "swing": ("fig.swing", mechanism_figures.swing),
    # motion
    "velocity": ("fig.v", VELOCITY.whole),
    "velocity-stages": ("fig.v.stages", VELOCITY.in_stages),
    "velocity-plates": ("fig.v.plates", VELOCITY.on_plates),
    "acceleration": ("fig.a", ACCELERATION.whole),
    "acceleration-stages": ("fig.a.stages", ACCELERATION.in_stages),
    "acceleration-plates": ("fig.a.plates", ACCELERATION.on_plates),
    "coriolis": ("fig.coriolis", mechanism_figures.coriolis),
    "inclination": ("fig.inclination", mechanism_figures.inclination),
    "two-equations": ("fig.twice", mechanism_figures.two_equations),
    "similarity": ("fig.similarity", mechanism_figures.similarity),
    "centres": ("fig.centres", mechanism_figures.centres),
    "motion": ("fig.motion", cycle_curves.motion),
    # forces
    "indicator": ("fig.indicator", mechanism_figures.indicator),
    "bodies": ("fig.bodies", force_figures.bodies),
    "special": ("fig.special", triad_figures.special),
    "assemblies": ("fig.assemblies", triad_figures.assemblies),
    "forces": ("fig.R", plan_figures.forces),
    "force-stages": ("fig.R.stages", plan_figures.force_stages),
    "force-plates": ("fig.R.plates", plan_figures.force_plates),
    "crank": ("fig.crank", force_figures.driver),
    "slide": ("fig.slide", force_figures.driver),
    "lever": ("fig.lever", force_figures.lever),
    "polar": ("fig.polar", cycle_curves.polar),
    "torque": ("fig.M", cycle_curves.torque),
}
"""Beginning of a figure's key, and the function that draws it; its caption is in `words.yaml` under `captions`."""


def figure(report: ReportContext, name: str, *arguments: Any, words: str = "") -> tuple[Figure | Plate, ...]:
    """Return a figure by its name: `figure(name, …)`, or `figure(name, key, caption, …)` with a separate key and
    caption.

    `words` selects another caption of `words.yaml`.  A figure on plates is a block for each plate; the first has key
    and caption.  Raises `KeyError` for an unknown name.
    """
    key, draw = _drawn(report, name)
    at = ""
    if arguments and isinstance(arguments[0], str):
        key, caption, *passed = arguments
    else:
        passed = list(arguments)
        group = next((argument for argument in passed if isinstance(argument, AssurView)), None)
        position = next((argument for argument in passed if isinstance(argument, Position)), None)
        key = ".".join(str(part) for part in (key, group, position) if part is not None)
        at = "" if position is None else str(position)
        links = None
        if group is not None:
            between = ", " if setting_of(report.assignment.language).spaced else "，"
            members = between.join(map(str, group.links))
            links = {"i": group.links[0], "j": group.links[-1], "members": members, "plate": group.plate}
            links["joint"] = group.joint if isinstance(group, TriadView) else ""
        caption = report.words["captions"][words or name].format(k=position, g=links)
    drawn = draw(report, *passed)
    if drawn.paper is None and not drawn.turned and not report.parts("usual-type"):
        drawn = replace(drawn, scenes=tuple(map(close, drawn.scenes)))
    inlines = report.prose.inlines(caption)
    inlines = (*inlines, *phrases.reduction_remark(report, drawn.smaller, "caption"))
    if drawn.note is not None:
        inlines = (*inlines, Text("; "), InlineMath(drawn.note))
    if drawn.paper is None:
        return (Figure(drawn.scenes, inlines, key, turned=drawn.turned, at=at),)
    first, *others = drawn.scenes
    further = (Plate(scene, drawn.paper, continues=True) for scene in others)
    return Plate(first, drawn.paper, inlines, key, at=at), *further


def _drawn(report: ReportContext, name: str) -> DrawnFigure:
    """Return the key of a figure and the function that draws it.  Raises `KeyError` for an unknown name."""
    return FIGURES[name] if name in FIGURES else topic_views.merged(report, attrgetter("figures"))[name]


def smaller(report: ReportContext, name: str) -> Inlines:
    """Return the remark on a named figure that is drawn smaller than the scales of the text say; empty if it is not."""
    return phrases.reduction_remark(report, _drawn(report, name)[1](report).smaller, name)
