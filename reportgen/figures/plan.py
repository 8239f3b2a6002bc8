"""Velocity, acceleration and force plans: vectors in mm, true to scale, and the stages of their construction.

A plan is plain data whose lengths are already divided by the scale μ.
"""

from __future__ import annotations

import cmath
import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from reportgen.figures import style
from reportgen.figures.draft import Draft, finish
from reportgen.figures.geometry import bounds, clusters, unit
from reportgen.figures.inset import INVISIBLE, TINY, Tiny, insets
from reportgen.figures.labels import Request, label
from reportgen.figures.scene import Arrow, Circle, Content, Item, Line, Scene, Stroke

Style = Literal["known", "relative", "found"]
PENS: dict[Style, Stroke] = {"known": style.KNOWN, "relative": style.RELATIVE, "found": style.FOUND}

NOTHING = 1e-9
"""A vector below this share of the longest one counts as zero and is not drawn."""
SAME = 0.05
"""Points nearer than this (mm) look like one point and share a label joined by ≡."""
CROWDED = 1.2
"""Points nearer than this share a label joined by commas; an inset tells them apart."""
BEYOND = 6.0
"""How far (mm) an auxiliary direction goes on beyond its ends."""


@dataclass(frozen=True, slots=True)
class PlanVector:
    """An arrow of a plan, in mm; `label` is printed beside it, `name` identifies it to whoever measures."""

    name: str
    start: complex
    end: complex
    style: Style = "known"
    label: Content | None = None
    stage: int = 0


@dataclass(frozen=True, slots=True)
class PlanPoint:
    """A named point of a plan: the pole, the end of a vector, a vertex."""

    label: Content
    at: complex
    stage: int = 0


@dataclass(frozen=True, slots=True)
class PlanLine:
    """An auxiliary direction drawn from `start` through `end` and a little on."""

    start: complex
    end: complex
    stage: int = 0


@dataclass(frozen=True, slots=True)
class Plan:
    """Vectors, named points and auxiliary directions in mm; `points[0]` is the pole where there is one.

    `scale` is printed below, e.g. μ_v = 0.2189 m/(s·mm); `pole` marks the first point by a small circle.
    """

    vectors: tuple[PlanVector, ...]
    points: tuple[PlanPoint, ...] = ()
    lines: tuple[PlanLine, ...] = ()
    scale: Content | None = None
    pole: bool = True

    @property
    def size(self) -> float:
        """The longest vector, mm."""
        return max((abs(v.end - v.start) for v in self.vectors), default=0.0)

    @property
    def last_stage(self) -> int:
        numbers = [v.stage for v in self.vectors] + [p.stage for p in self.points]
        return max(numbers + [k.stage for k in self.lines], default=0)

    def drawn(self) -> tuple[PlanVector, ...]:
        """The vectors that are not zero."""
        return tuple(v for v in self.vectors if abs(v.end - v.start) > NOTHING * self.size)

    def scaled(self, factor: complex) -> Plan:
        """The plan enlarged or reduced; a complex factor also turns it."""
        return replace(
            self,
            vectors=tuple(replace(v, start=v.start * factor, end=v.end * factor) for v in self.vectors),
            points=tuple(replace(p, at=p.at * factor) for p in self.points),
            lines=tuple(replace(k, start=k.start * factor, end=k.end * factor) for k in self.lines),
        )

    def until(self, stage: int) -> Plan:
        """Only what is drawn up to a stage."""
        return replace(
            self,
            vectors=tuple(v for v in self.vectors if v.stage <= stage),
            points=tuple(p for p in self.points if p.stage <= stage),
            lines=tuple(k for k in self.lines if k.stage <= stage),
        )


def plan(drawing: Plan, *, title: str = "") -> Scene:
    """The scene of a plan in true size, vectors under 3 mm repeated in enlarged insets."""
    vectors = drawing.drawn()
    draft = Draft((*_lines(drawing), *_arrows(vectors), *_marks(drawing)), _labels(drawing, vectors, style.LABEL))
    draft += insets(_tiny(drawing, vectors), [(v.start, v.end) for v in vectors], draft)
    return finish(draft, notes=() if drawing.scale is None else (drawing.scale,), title=title)


def stages(drawing: Plan, factor: float = 1.0) -> tuple[Scene, ...]:
    """The construction step by step, `factor` times as large: a panel a stage, what is new in blue.

    All panels have one size.  A stage that would draw nothing new is drawn together with the next one.
    """
    whole = merged(drawing.scaled(factor))
    corner = bounds((*_lines(whole), *_arrows(whole.drawn())))
    pad = complex(4, 4)
    panels = []
    for stage in range(whole.last_stage + 1):
        part = whole.until(stage)
        vectors = tuple(v for v in whole.drawn() if v.stage <= stage)
        items = (
            *_lines(part, stage),
            *(Arrow(v.start, v.end, style.NEW if v.stage == stage else style.OLD, style.HEAD, v.name) for v in vectors),
            *_marks(part),
        )
        title = f"{chr(ord('a') + stage)})"
        draft = Draft(items, _labels(part, vectors, style.SMALL))
        panels.append(finish(draft, title=title, margin=2.0, frame=(corner[0] - pad, corner[1] + pad)))
    width = max(panel.width for panel in panels)
    height = max(panel.height for panel in panels)
    return tuple(replace(panel, width=width, height=height) for panel in panels)


def merged(drawing: Plan) -> Plan:
    """The plan with its stages renumbered, so that each draws an arrow or a line that was not there before."""
    least = NOTHING * drawing.size
    arrows = [(v.stage, v.start, v.end) for v in drawing.drawn()]
    lines = [(k.stage, k.start, k.end) for k in drawing.lines if abs(k.end - k.start) > least]

    def repeats(stage: int, start: complex, end: complex) -> bool:
        return any(s < stage and abs(start - p) + abs(end - q) < SAME for s, p, q in arrows)

    kept = sorted({piece[0] for piece in lines} | {piece[0] for piece in arrows if not repeats(*piece)})

    def number(stage: int) -> int:
        return min(bisect_left(kept, stage), max(len(kept) - 1, 0))

    return replace(
        drawing,
        vectors=tuple(replace(v, stage=number(v.stage)) for v in drawing.vectors),
        points=tuple(replace(p, stage=number(p.stage)) for p in drawing.points),
        lines=tuple(replace(k, stage=number(k.stage)) for k in drawing.lines),
    )


def _lines(drawing: Plan, stage: int | None = None) -> list[Item]:
    result: list[Item] = []
    for line in drawing.lines:
        new = stage is not None and line.stage == stage
        pen = replace(style.CONSTRUCTION, width=0.18, colour=style.NEW.colour) if new else style.CONSTRUCTION
        on = unit(line.end - line.start)
        # Of a line that an arrow covers only the piece beyond the tip is drawn.
        covered = any(abs(v.start - line.start) + abs(v.end - line.end) < SAME for v in drawing.drawn())
        start = line.end if covered else line.start
        result.append(Line(start, line.end + BEYOND * on, pen))
    return result


def _arrows(vectors: Sequence[PlanVector]) -> list[Item]:
    return [Arrow(v.start, v.end, PENS[v.style], style.HEAD, v.name) for v in vectors]


def _marks(drawing: Plan) -> list[Item]:
    if not (drawing.pole and drawing.points):
        return []
    return [Circle(drawing.points[0].at, 0.7, Stroke(0.25), style.PAPER)]


def _labels(drawing: Plan, vectors: Sequence[PlanVector], size: float) -> tuple[Request, ...]:
    """One label for points that nearly coincide, and those of the vectors beside their middles."""
    requests = []
    for group in clusters([p.at for p in drawing.points], CROWDED):
        members = [drawing.points[i] for i in group]
        at = members[0].at
        gap = 1.1 if drawing.pole and 0 in group else 0.7
        requests.append(label(at, *point_names(members), prefer=_outward(at, vectors), gap=gap, size=size))
    for vector in vectors:
        way = vector.end - vector.start
        if vector.label is None or abs(way) < TINY:
            continue
        across = cmath.phase(way) + math.pi / 2
        places = [vector.start + way * share for share in (0.5, 0.64, 0.36, 0.76, 0.24, 0.88, 0.12)]
        requests.append(label(places, vector.label, prefer=(across, across - math.pi), size=size))
    return tuple(requests)


def point_names(points: Sequence[PlanPoint]) -> list[Content]:
    """The parts of one label for several points: a ≡ b where they coincide, else a, b."""
    parts: list[Content] = []
    for n, point in enumerate(points):
        if any(point.label == earlier.label for earlier in points[:n]):
            continue
        if parts:
            parts.append(" ≡ " if abs(point.at - points[0].at) < SAME else ", ")
        parts.append(point.label)
    return parts


def _outward(at: complex, vectors: Sequence[PlanVector]) -> tuple[float, ...]:
    """The direction away from the vectors that meet in a point: where its name reads best."""
    pull = 0j
    for vector in vectors:
        for here, there in ((vector.start, vector.end), (vector.end, vector.start)):
            if abs(here - at) < CROWDED and abs(there - here) > CROWDED:
                pull += unit(there - here)
    return (cmath.phase(-pull),) if abs(pull) > 0.2 else ()


def _tiny(drawing: Plan, vectors: Sequence[PlanVector]) -> list[Tiny]:
    """The vectors under 3 mm that are worth enlarging, with the names of their ends."""

    def names(at: complex) -> tuple[Content, ...]:
        return tuple(point_names([p for p in drawing.points if abs(p.at - at) < SAME]))

    return [
        Tiny(v.start, v.end, PENS[v.style], v.name, v.label, names(v.start), names(v.end))
        for v in vectors
        if INVISIBLE < abs(v.end - v.start) < TINY
    ]
