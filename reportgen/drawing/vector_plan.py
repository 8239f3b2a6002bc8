"""Velocity, acceleration and force plans: vectors in mm, true to scale, and the stages of their construction.

A plan is plain data whose lengths are already divided by the scale μ.  Vectors too short to measure are drawn again in
enlarged insets beside it, at a printed ratio.
"""

from __future__ import annotations

import cmath
import math
from bisect import bisect_left
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Generic, Literal, TypeVar

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled
from reportgen.base.units import SERIES
from reportgen.drawing import Arrow, Circle, Content, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.canvas import MARGIN, Canvas, finish, settle
from reportgen.drawing.drawing_description import Description, arrow, direction, fact
from reportgen.drawing.geometry import bounds, clipped, clusters, corners_of, on_one_line, unit
from reportgen.drawing.labels import KEY, Request, label

VectorStyle = Literal["known", "relative", "found"]
Titles = Callable[[range, int], str]
"""Function that returns the title below a panel from its range of stages and its number from 0."""
PENS: dict[VectorStyle, Pen] = {"known": style.KNOWN, "relative": style.RELATIVE, "found": style.FOUND}

SAME_POINT = 0.05
"""Points nearer than this (mm) look like one point and share a label joined by ≡."""
CROWDED, CLOSE_BY = 1.2, 2.4
"""Points nearer than this (mm), the second in small plans, share a label joined by commas; an inset separates them."""
BEYOND = 6.0
"""Length (mm) of an auxiliary direction beyond its ends."""

TINY = 3.0
"""Vectors shorter than this (mm) get an enlarged inset."""
DOT = 0.1
"""Vectors shorter than this (mm), the dot of a pencil, get no inset: it would need more than 100:1."""
INVISIBLE = 0.01
"""Vectors shorter than this (mm), the last digit of a measured length, are not drawn."""
TARGET = 20.0
"""The longest vector of an inset is enlarged to at most this (mm)."""
SPACE = 8.0
"""Gap between the figure and the insets or small mechanism beside it (mm)."""
CLOSE = 2.0
"""The margin of a plan that fills its width (mm)."""
LABELS = 5.0
"""Extent of labels to the right of their points (mm)."""
ROOM = 6.0
"""Padding inside an inset's frame around the enlarged vectors (mm)."""
NEIGHBOUR = 3.0
"""Short vectors nearer than this (mm) share an inset."""
APART = 30.0
"""Largest distance of their middles in a shared inset (mm)."""

Corner = TypeVar("Corner")
Placed = TypeVar("Placed")


class PlanVector(Record, Generic[Corner]):
    """Arrow of a plan; `label` is printed beside it, `name` identifies it for measurements."""

    name: str
    start: Corner
    end: Corner
    style: VectorStyle = "known"
    label: Content | None = None
    stage: int = 0
    lettered: bool = False
    """True if its label is not printed, because the letters of its ends identify it."""

    @property
    def middle(self: PlanVector[complex]) -> complex:
        """Return the middle of the vector (mm)."""
        return (self.start + self.end) / 2

    @property
    def length(self: PlanVector[complex]) -> float:
        """Return its length (mm)."""
        return abs(self.end - self.start)


class PlanPoint(Record, Generic[Corner]):
    """A named point of a plan: the pole, the end of a vector, a vertex."""

    label: Content
    at: Corner
    stage: int = 0


class PlanLine(Record, Generic[Corner]):
    """An auxiliary direction drawn from `start` through `end` and a little beyond."""

    start: Corner
    end: Corner
    stage: int = 0


class Construction(Record, Generic[Corner]):
    """Vectors, named points and auxiliary directions between corners: places (mm) or only names.

    `points[0]` is the pole if there is one; `pole` marks it by a small circle.  `scale` is printed below.
    """

    vectors: tuple[PlanVector[Corner], ...]
    points: tuple[PlanPoint[Corner], ...] = ()
    lines: tuple[PlanLine[Corner], ...] = ()
    scale: Content | None = None
    pole: bool = True

    @property
    def last_stage(self) -> int:
        """Return the number of the last stage; 0 if everything is drawn at once."""
        numbers = [v.stage for v in self.vectors] + [p.stage for p in self.points]
        return max(numbers + [k.stage for k in self.lines], default=0)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return all corners, each once."""
        ends = [(v.start, v.end) for v in self.vectors] + [(k.start, k.end) for k in self.lines]
        return tuple(dict.fromkeys((*(p.at for p in self.points), *chain.from_iterable(ends))))

    def placed(self, place: Callable[[Corner], Placed]) -> Construction[Placed]:
        """Return the same construction with its corners mapped by `place`."""
        return Construction(
            tuple(
                PlanVector(v.name, place(v.start), place(v.end), v.style, v.label, v.stage, lettered=v.lettered)
                for v in self.vectors
            ),
            tuple(PlanPoint(p.label, place(p.at), p.stage) for p in self.points),
            tuple(PlanLine(place(k.start), place(k.end), k.stage) for k in self.lines),
            self.scale,
            self.pole,
        )

    def until(self, stage: int) -> Construction[Corner]:
        """Return the part of the construction up to and including a stage."""
        return replace(
            self,
            vectors=tuple(v for v in self.vectors if v.stage <= stage),
            points=tuple(p for p in self.points if p.stage <= stage),
            lines=tuple(k for k in self.lines if k.stage <= stage),
        )

    def drawn(self: Plan) -> tuple[PlanVector[complex], ...]:
        """Return the vectors that are long enough to be visible (mm)."""
        return tuple(v for v in self.vectors if v.length > INVISIBLE)

    @property
    def lettered(self) -> Construction[Corner]:
        """Return the construction with only its points named: the letters of its ends identify a vector."""
        return replace(self, vectors=tuple(replace(v, lettered=True) for v in self.vectors))

    @property
    def extent(self: Plan) -> float:
        """Return the larger of its width and height without labels (mm)."""
        low, high = bounds(_arrows(self.drawn()))
        return max((high - low).real, (high - low).imag)

    def scaled(self: Plan, factor: complex) -> Plan:
        """Return the plan enlarged or reduced; a complex factor also turns it."""
        return self.placed(lambda corner: corner * factor)


Plan = Construction[complex]
"""A construction on paper: its corners are places (mm)."""


def lettered(stages: range, number: int) -> str:
    """Return the title a), b), … of panels that the text describes one after another."""
    return f"{chr(ord('a') + number)})"


def plan(
    drawing: Plan,
    *,
    title: str = "",
    beside: Sequence[Canvas] = (),
    width: float = math.inf,
    enlarged: bool = True,
    margin: float = MARGIN,
) -> Scene:
    """Return the scene of a plan in true size; `enlarged` repeats vectors under 3 mm in insets.

    The drawings `beside` it, whose labels must have been placed, and the insets are stacked to its right.  If that
    would be wider than `width` (mm), they are in rows below it, and the margin is `CLOSE`.
    """
    vectors = drawing.drawn()
    draft = Canvas(
        (*_lines(drawing), *_arrows(vectors), *_marks(drawing)),
        _labels(drawing, vectors, style.LABEL, CROWDED if enlarged else CLOSE_BY),
        vector_facts(vectors),
    )
    notes = () if drawing.scale is None else (drawing.scale,)
    parts, marks = insets(drawing) if enlarged else ((), Canvas())
    further = [*beside, *parts]
    if not further:
        return finish(draft, notes=notes, title=title, margin=margin)
    draft += marks
    scene = finish(draft + _stacked(further, draft), notes=notes, title=title, margin=margin)
    if scene.width <= width:
        return scene
    return finish(draft + _below(further, draft), notes=notes, title=title, margin=CLOSE)


def stages(drawing: Plan, factor: float = 1.0, titles: Titles = lettered, begin: int = 0) -> tuple[Scene, ...]:
    """Draw the construction step by step, `factor` times as large: a panel for each stage, with its additions in blue.

    Only points are named, as on every small plan; `titles` gives the title of each panel.  All panels have one size.  A
    stage without additions is drawn together with the next one; stages before `begin` have no panel.
    """
    scaled = drawing.scaled(factor).lettered
    kept = kept_stages(scaled)
    whole = merged(scaled)
    corner = bounds((*_lines(whole), *_arrows(whole.drawn())))
    pad = complex(4, 4)
    panels: list[Scene] = []
    for stage in range(bisect_left(kept, begin), whole.last_stage + 1):
        part = whole.until(stage)
        vectors = tuple(v for v in whole.drawn() if v.stage <= stage)
        items = (
            *_lines(part, stage),
            *_arrows(vectors, [style.NEW if v.stage == stage else style.OLD for v in vectors]),
            *_marks(part),
        )
        before = kept[stage - 1] if stage else -1
        title = titles(range(max(before + 1, begin), kept[stage] + 1 if kept else 1), len(panels))
        new = tuple(v for v in vectors if v.stage == stage)
        facts = (*(vector_facts(new) if new else ()), *_line_facts(part, stage))
        draft = Canvas(items, _labels(part, vectors, style.SMALL, CLOSE_BY), facts)
        panels.append(finish(draft, title=title, margin=2.0, frame=(corner[0] - pad, corner[1] + pad)))
    width = max(panel.width for panel in panels)
    height = max(panel.height for panel in panels)
    return tuple(replace(panel, width=width, height=height) for panel in panels)


def merged(drawing: Plan) -> Plan:
    """Return the plan with its stages renumbered, so that each adds an arrow or a line."""
    kept = kept_stages(drawing)

    def number(stage: int) -> int:
        return min(bisect_left(kept, stage), max(len(kept) - 1, 0))

    return replace(
        drawing,
        vectors=tuple(replace(v, stage=number(v.stage)) for v in drawing.vectors),
        points=tuple(replace(p, stage=number(p.stage)) for p in drawing.points),
        lines=tuple(replace(k, stage=number(k.stage)) for k in drawing.lines),
    )


def kept_stages(drawing: Plan) -> list[int]:
    """Return the stages that add a line or an arrow that does not repeat an earlier one, in order."""
    arrows = [(v.stage, v.start, v.end) for v in drawing.drawn()]
    lines = [(k.stage, k.start, k.end) for k in drawing.lines if abs(k.end - k.start) > INVISIBLE]

    def repeats(stage: int, start: complex, end: complex) -> bool:
        return any(s < stage and abs(start - p) + abs(end - q) < SAME_POINT for s, p, q in arrows)

    return sorted({piece[0] for piece in lines} | {piece[0] for piece in arrows if not repeats(*piece)})


def vector_facts(vectors: Sequence[PlanVector[complex]]) -> Description:
    """Return the facts of vectors (mm): name, length and direction of each, or that there are none."""
    facts = (arrow(v.name if v.label is None else v.label, v.end - v.start) for v in vectors)
    return tuple(facts) or (fact("no-vectors"),)


def _line_facts(drawing: Plan, stage: int) -> Description:
    """Return the facts of a stage's auxiliary directions: starting point and direction."""
    names = {point.at: point.label for point in drawing.points}
    return tuple(
        fact("direction", names.get(line.start, ""), direction(line.end - line.start))
        for line in drawing.lines
        if line.stage == stage and abs(line.end - line.start) > INVISIBLE
    )


def _lines(drawing: Plan, stage: int | None = None) -> list[Item]:
    result: list[Item] = []
    for line in drawing.lines:
        if abs(line.end - line.start) <= INVISIBLE:
            # Its direction would only be a rounding error.
            continue
        new = stage is not None and line.stage == stage
        pen = replace(style.CONSTRUCTION, width=0.18, colour=style.NEW.colour) if new else style.CONSTRUCTION
        on = unit(line.end - line.start)
        # Of a line that an arrow covers, only the piece beyond the tip is drawn.
        covered = any(abs(v.start - line.start) + abs(v.end - line.end) < SAME_POINT for v in drawing.drawn())
        start = line.end if covered else line.start
        result.append(Line(start, line.end + BEYOND * on, pen))
    return result


def _arrows(vectors: Sequence[PlanVector[complex]], pens: Sequence[Pen] = ()) -> list[Item]:
    """Return the arrows; one that would lie on an earlier one is drawn beside it, with thin lines to its true ends."""
    result: list[Item] = []
    pens = pens or [PENS[v.style] for v in vectors]
    for v, by, pen in zip(vectors, set_apart(vectors), pens, strict=True):
        if by:
            result += (Line(end, end + by, style.LEADER) for end in (v.start, v.end))
        result.append(Arrow(v.start + by, v.end + by, pen, style.HEAD, v.name))
    return result


def set_apart(vectors: Sequence[PlanVector[complex]]) -> list[complex]:
    """Return the offsets (mm) at which vectors are drawn beside their places, so that none overlaps an earlier one."""
    shifts: list[complex] = []
    for n, vector in enumerate(vectors):
        length = vector.end - vector.start
        on = {round(abs(shifts[m]) / style.BESIDE) for m in range(n) if _on_one_line(vector, vectors[m])}
        free = next(step for step in range(n + 1) if step not in on)
        shifts.append(-1j * unit(length) * style.BESIDE * free)
    return shifts


def _on_one_line(first: PlanVector[complex], second: PlanVector[complex]) -> bool:
    """Return True if two vectors, long enough to see, share a part of one line that is longer than an arrow's head."""
    shorter, longer = sorted((abs(first.end - first.start), abs(second.end - second.start)))
    if shorter < TINY or _across(first, second) > 2 * style.ON_LINE * longer:
        return False
    # Two vectors with one start and one end are one arrow with two names.
    if abs(first.start - second.start) + abs(first.end - second.end) < SAME_POINT:
        return False
    return on_one_line((first.start, first.end), (second.start, second.end), style.ON_LINE, style.HEAD)


def _across(vector: PlanVector[complex], along: PlanVector[complex]) -> float:
    """Return the distance of one vector's end from the line of another, times the length of the other."""
    return abs(((vector.end - vector.start).conjugate() * (along.end - along.start)).imag)


def _marks(drawing: Plan) -> list[Item]:
    if not (drawing.pole and drawing.points):
        return []
    return [Circle(drawing.points[0].at, 0.7, Pen(0.25), style.PAPER)]


def _labels(
    drawing: Plan, vectors: Sequence[PlanVector[complex]], size: float, reach: float = CROWDED
) -> tuple[Request, ...]:
    """Return one label for points that nearly coincide, and those of the vectors beside their middles."""
    requests = []
    for group in clusters(drawing.points, reach, lambda point: point.at):
        at = group[0].at
        gap = 1.1 if drawing.pole and drawing.points[0] in group else 0.7
        ends, prefer = tuple(dict.fromkeys(point.at for point in group)), _outward(at, vectors)
        short = KEY if reach == CLOSE_BY else None
        requests.append(label(ends, *point_names(group), prefer=prefer, gap=gap, size=size, each=True, short=short))
    for vector, by in zip(vectors, set_apart(vectors), strict=True):
        length = vector.end - vector.start
        if vector.label is None or vector.lettered or abs(length) < TINY:
            continue
        across = cmath.phase(length) + math.pi / 2
        places = [vector.start + length * share for share in (0.5, 0.64, 0.36, 0.76, 0.24, 0.88, 0.12)]
        sides = (cmath.phase(by),) if by else (across, across - math.pi)
        requests.append(label([at + by for at in places], vector.label, prefer=sides, size=size))
    return tuple(requests)


def point_names(points: Sequence[PlanPoint[complex]]) -> list[Content]:
    """Return the parts of one label for several points (mm): a ≡ b if they coincide, otherwise a, b."""
    parts: list[Content] = []
    for n, point in enumerate(points):
        if any(point.label == earlier.label for earlier in points[:n]):
            continue
        if parts:
            parts.append(" ≡ " if abs(point.at - points[0].at) < SAME_POINT else ", ")
        parts.append(point.label)
    return parts


def _outward(at: complex, vectors: Sequence[PlanVector[complex]]) -> tuple[float, ...]:
    """Return the direction (rad) away from the vectors that meet in a point, where its name reads best."""
    pull = 0j
    for vector in vectors:
        for here, there in ((vector.start, vector.end), (vector.end, vector.start)):
            if abs(here - at) < CROWDED and abs(there - here) > CROWDED:
                pull += unit(there - here)
    return (cmath.phase(-pull),) if abs(pull) > 0.2 else ()


# --- insets ---------------------------------------------------------------------------------------


def insets(drawing: Plan) -> tuple[list[Canvas], Canvas]:
    """Return insets of groups of short vectors, each about its own middle, and circles around those groups.

    Vectors shorter than `DOT` get none.  Each inset prints its ratio (e.g. 10:1) and draws the other vectors of the
    plan that pass through its frame.
    """
    groups = _groups([vector for vector in drawing.drawn() if DOT <= vector.length < TINY])
    return [_inset(group, drawing) for group in groups], Canvas(tuple(map(_mark, groups)))


def _stacked(parts: Sequence[Canvas], figure: Canvas) -> Canvas:
    """Return the parts in a column to the right of a figure."""
    # The figure's own labels are placed later; they rarely extend farther than LABELS.
    high = bounds(figure.items)[1]
    top = complex(high.real + LABELS + SPACE, high.imag)
    result = Canvas()
    for part in parts:
        floor, ceiling = bounds(part.items)
        result += part.moved(top - complex(floor.real, ceiling.imag))
        top -= 1j * ((ceiling - floor).imag + SPACE / 2)
    return result


def _below(parts: Sequence[Canvas], figure: Canvas) -> Canvas:
    """Return the parts in rows below a figure, no wider than it."""
    low, high = bounds(figure.items)
    left = place = low - 1j * (LABELS + SPACE)
    deepest, result = 0.0, Canvas()
    for part in parts:
        floor, ceiling = bounds(part.items)
        size = ceiling - floor
        if place != left and (place + size).real > high.real + LABELS:
            left -= 1j * (deepest + SPACE / 2)
            place, deepest = left, 0.0
        result += part.moved(place - complex(floor.real, ceiling.imag))
        place, deepest = place + size.real + SPACE / 2, max(deepest, size.imag)
    return result


def enlargement(longest: float) -> float:
    """Return the ratio of an inset: the largest of the series that draws `longest` mm within the target."""
    most = TARGET / longest
    decade = math.floor(math.log10(most) + 1e-12)
    ratios = (float(f"{step}e{power}") for power in (decade, decade - 1) for step in reversed(SERIES))
    # A ratio that exceeds the target only by rounding errors is accepted.
    return next(ratio for ratio in ratios if ratio <= most * (1 + 1e-12))


def _groups(tiny: Sequence[PlanVector[complex]]) -> list[list[PlanVector[complex]]]:
    """Return groups of vectors with neighbouring middles, an inset each.

    A vector that would still be short, or too far away, at the ratio of the longest one goes to another inset.
    """
    result: list[list[PlanVector[complex]]] = []
    for rest in clusters(tiny, NEIGHBOUR, lambda vector: vector.middle):
        while rest:
            longest = max(rest, key=lambda vector: settled(vector.length))
            ratio = enlargement(longest.length)
            group = [
                vector
                for vector in rest
                if vector.length * ratio >= TINY and abs(vector.middle - longest.middle) * ratio <= APART
            ]
            result.append(group)
            rest = [vector for vector in rest if vector not in group]
    return result


def _mark(group: Sequence[PlanVector[complex]]) -> Item:
    ends = [end for vector in group for end in (vector.start, vector.end)]
    low, high = corners_of(ends)
    centre = (low + high) / 2
    return Circle(centre, max(abs(end - centre) for end in ends) + 1.2, Pen(0.1, style.GRAY), None)


def _inset(group: Sequence[PlanVector[complex]], drawing: Plan) -> Canvas:
    """Draw an inset with its labels placed, in coordinates about its own middle."""
    ratio = enlargement(max(vector.length for vector in group))
    low, high = corners_of([end for vector in group for end in (vector.start, vector.end)])
    middle = (low + high) / 2
    half = (high - low) / 2 * ratio + complex(ROOM, ROOM)

    def enlarged(p: complex) -> complex:
        return (p - middle) * ratio

    own = {(vector.start, vector.end) for vector in group}
    others = (v for v in drawing.drawn() if (v.start, v.end) not in own)
    parts = (clipped(enlarged(v.start), enlarged(v.end), -half, half) for v in others)
    items: list[Item] = [Line(*part, Pen(0.15, style.PALE)) for part in parts if part]
    items += (
        Arrow(enlarged(v.start), enlarged(v.end), PENS[v.style], style.HEAD, f"{v.name} ×{ratio:g}") for v in group
    )
    items.append(Polyline((-half, half.conjugate(), half, -half.conjugate()), style.THIN, closed=True))
    items.append(Label(half.imag * 1j + 1.2j, f"{ratio:g}:1", "bottom", style.SMALL))
    requests: list[Request] = []
    seen: list[list[Content]] = []
    for vector in group:
        arrow = vector.end - vector.start
        for at, side in ((vector.start, -1), (vector.end, 1)):
            names = point_names([point for point in drawing.points if abs(point.at - at) < SAME_POINT])
            if names and names not in seen:
                seen.append(names)
                requests.append(label(enlarged(at), *names, prefer=(cmath.phase(side * arrow),), size=style.SMALL))
        if vector.label is not None and not vector.lettered:
            across = cmath.phase(arrow) + math.pi / 2
            sides = (across, across - math.pi)
            requests.append(label(enlarged(vector.middle), vector.label, prefer=sides, size=style.SMALL))
    return settle(Canvas(tuple(items), tuple(requests), (fact("inset", f"{ratio:g}"),)))
