"""Figures of the plans of velocity, acceleration and force: worked plans, their construction in stages, and plates of
all positions.

The ledger's plans are in metres on paper (x + iy); `reportgen/drawing/vector_plan.py` draws them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled, significant
from reportgen.base.units import MM, nice_up
from reportgen.derivation.equation_sides import Side, image
from reportgen.derivation.kinematic_entries import POLES, What
from reportgen.derivation.load_entries import Edge, Polygon
from reportgen.document import Inlines
from reportgen.document.figure_placement import A3_ACROSS, FIGURE_ROOM, FigureScenes, on_paper
from reportgen.document.layout import SCENE_GAP
from reportgen.drawing import Scene
from reportgen.drawing.drawing_sheet import sheets
from reportgen.drawing.mirrored_plans import Mirrored, mirrored
from reportgen.drawing.scheme import thumbnail
from reportgen.drawing.vector_plan import (
    Construction,
    Plan,
    PlanLine,
    PlanPoint,
    PlanVector,
    Titles,
    VectorStyle,
    lettered,
    plan,
    stages,
)
from reportgen.formula import Chain, Symbol, ids, vocabulary
from reportgen.report.assur_view import AssurView
from reportgen.report.context import ReportContext
from reportgen.report.link_views import GroupView
from reportgen.report.mechanism_figures import scale_note
from reportgen.report.phrases import counted
from reportgen.report.triad_views import LegView, TriadView

SHEET = (385.0, 232.0)
"""Width and height (mm) of an A3 page (landscape) that plans may fill."""
SCALE_FIGURES = 6
"""Significant figures of the scale of a plan that is drawn smaller."""
SHARES = (1.0, 0.5, 0.4, 0.25, 0.2, 0.1)
"""Factors by which the plans of all positions may be smaller than the worked ones; scales stay in their series."""
LARGEST = 58.0
"""Largest extent of these plans without their labels (mm), so that about three fit side by side."""
ROOM = (78.0, 75.0)
"""Largest width and height of each of them with its labels (mm)."""
LARGEST_OF_FORCES, LEAST_OF_FORCES = 50.0, 25.0
"""Bounds of the longest extent of each force plan without its labels (mm): round scales are at most twofold apart."""
ROOM_OF_FORCES = 78.0
"""The largest width of each of them with its labels (mm)."""
NOTHING_DRAWN = 0.5
"""A force plan smaller than this (mm) belongs to a position without forces."""
FINER = 1e-6
"""Relative step above a scale at which the search for the next coarser scale starts."""
PANELS = 160.0, 60.0
"""Largest width and height (mm) of a row of panels that show the steps of a construction."""
PANEL = 78.0
"""Largest width of one panel (mm)."""
CLOSE_MARGIN = 2.0
"""Margin around each of many plans (mm)."""

POLE = "pole"
"""The corner at which a plan of velocities or accelerations begins; all other corners have ids of the ledger."""
# --- velocity and acceleration


class MotionFigures(Record):
    """Figures of the plan of velocities ("v") or accelerations ("a"): the plan, its stages, the plates of one turn."""

    what: What

    def whole(self, report: ReportContext, k: int) -> FigureScenes:
        """Draw the finished plan at position `k`."""
        return on_paper(_worked(report, self._plan(report, k), k))

    def in_stages(self, report: ReportContext, k: int, group: GroupView | TriadView) -> FigureScenes:
        """Draw the steps of one group's construction, numbered as in the text; earlier steps are gray."""
        number = next(n for n, one in enumerate(report.groups) if one.name == group.name)
        begin = sum(len(_steps(one, self.what)) for one in report.groups[:number])
        bounds = np.cumsum([0, *_steps(group, self.what)])
        names = report.words["figure"]

        def titles(stages: range, number: int) -> str:
            first, last = bounds[stages.start - begin] + 1, bounds[stages.stop - begin]
            return str(names["steps"].format(first, last) if first < last else names["step"].format(last))

        until = self._plan(report, k).until(begin + bounds.size - 2)
        return _stages(report, until, ids.scale(self.what), titles, begin)

    def on_plates(self, report: ReportContext) -> FigureScenes:
        """Draw the plans of all positions of one turn."""
        return self.series(report).figure

    def series(self, report: ReportContext) -> PlanSeries:
        """Return the plans of one turn, without those that mirror others."""
        mirrored_at = positions_mirrored(report, self.what).at
        return PlanSeries(
            report, self._plan, [k for k in one_turn(report) if k not in mirrored_at], ids.scale(self.what)
        )

    def _plan(self, report: ReportContext, k: int) -> Plan:
        return motion_plan(report, self.what, k)


def one_turn(report: ReportContext) -> list[int]:
    """Return the positions of one turn whose plans are drawn."""
    return sorted({(k - 1) % report.count + 1 for k in report.plates})


def positions_mirrored(report: ReportContext, what: What) -> Mirrored:
    """Return the positions whose plans of velocity ("v") or acceleration ("a") mirror plans that are drawn."""
    return mirrored({k: motion_plan(report, what, k) for k in one_turn(report)})


def mirror_images(report: ReportContext, what: What) -> Inlines:
    """Return the remark on positions whose plans are mirror images and not drawn; () if all are drawn."""
    mirror = positions_mirrored(report, what)
    drawn = ", ".join(str(report.machine.position(k)) for k in mirror.of)
    return counted(report, "mirrored", [report.machine.position(k) for k in mirror.at], drawn=drawn)


def _at(construction: Construction[str], report: ReportContext, k: int) -> Plan:
    """Return a construction on paper (mm) at position `k`."""
    scale = MM / report.enlarged
    return construction.placed(lambda id: 0j if id == POLE else settled(complex(report.ledger[id].at(k)) * scale))


def motion_plan(report: ReportContext, what: What, k: int) -> Plan:
    """Return the plan of velocities ("v") or accelerations ("a") at position `k`, in mm."""
    return _at(motion_construction(report, what), report, k)


def motion_construction(report: ReportContext, what: What) -> Construction[str]:
    """Return the plan of velocities ("v") or accelerations ("a") in stages, with the ids of its corners."""
    sketch = _Sketch(report, what)
    stage = 0
    drawn: set[str] = set()
    for group in report.groups:
        bases = [(side, stage) for side in group.moving]
        if isinstance(group, TriadView):
            bases += [(side, stage + 2) for side in group.later]
        for side, when in bases:
            if side.base in report.driver.names and side.base not in drawn:
                if what == "a" and side.base == report.driver.pin and report.driver.component_lines:
                    sketch.components(side.base, when)
                sketch.absolute(side.base, "known", when)
                drawn.add(side.base)
        if isinstance(group, TriadView):
            sketch.triad(group, stage)
        else:
            sketch.group(group, stage)
        stage += len(_steps(group, what))
    points = (PlanPoint(Symbol(POLES[what]), POLE), *sketch.points)
    return Construction(tuple(sketch.vectors), points, tuple(sketch.lines), _scale(report, ids.scale(what)))


def _worked(report: ReportContext, drawing: Plan, k: int, alone: bool = False) -> Scene:
    """Draw a worked plan with the mechanism beside it, or `alone`."""
    beside = () if alone else (thumbnail(report.machine.linkage, report.analysis.motion, k - 1),)
    return plan(drawing, beside=beside, width=FIGURE_ROOM[0])


def _scale(report: ReportContext, id: str, k: int | None = None) -> Chain:
    """Return a scale as a figure prints it: μ_v = 0.2189 m/(s·mm)."""
    return Chain((report.ledger.symbol(id), report.ledger.number(id, k)))


def _steps(group: GroupView | TriadView, what: What) -> tuple[int, ...]:
    """Return the number of steps, as the text counts them, in each stage of a group's construction.

    The stages of a group of class II are the known vectors, the lines that meet, and further points. One of class III
    has the known vectors and the lines twice: for the special point, then for the joint of the third leg.
    """
    if isinstance(group, TriadView):
        of_pair, of_third = (4, 2) if what == "a" else (0, 0)
        return len(group.moving) + of_pair, 2, len(group.later) + of_third, 2, 1 + bool(group.similar(what))
    bases = 1 if group.kind == "RRP" and group.two.still else len(group.moving)
    known = sum(bool(side.part) for side in group.sides) if what == "a" else 0
    return bases + known, len(group.sides), len(group.carried) + bool(group.similar(what))


def _stages(
    report: ReportContext, drawing: Plan, scale: str, titles: Titles = lettered, begin: int = 0, k: int | None = None
) -> FigureScenes:
    """Draw the stages of a plan at half its size, or smaller for a large plan, and note the resulting scale."""
    number = report.ledger.number(scale, k)
    for share in SHARES[1:-1]:
        scenes = stages(drawing, share, titles, begin)
        across = sum(scene.width for scene in scenes) + SCENE_GAP * (len(scenes) - 1)
        widest, highest = max(scene.width for scene in scenes), max(scene.height for scene in scenes)
        if widest <= PANEL and across <= PANELS[0] and highest <= PANELS[1]:
            break
    smaller = replace(number, value=significant(number.printed / share, SCALE_FIGURES), decimals=None)
    return FigureScenes(scenes, note=Chain((report.ledger.symbol(scale), smaller)))


class PlanSeries(Record):
    """Plans of several positions at one `scale`, in rows; without the mechanism beside them."""

    report: ReportContext
    drawing: Callable[[ReportContext, int], Plan]
    positions: Sequence[int]
    scale: str

    @property
    def figure(self) -> FigureScenes:
        """The plans in the text, or on A3 sheets if they have no room there."""
        share, scenes = self.fitted()
        note = self.note(share)
        if scenes:
            return FigureScenes(tuple(scenes), note=note)
        return FigureScenes(sheets(tuple(self.scenes(share)), *SHEET, note, trim=0.0), A3_ACROSS)

    def note(self, share: float) -> Chain:
        """Return the scale of the plans when they are drawn a `share` as large as the worked ones."""
        return scale_note(self.report, self.scale, share)

    def fitted(self) -> tuple[float, list[Scene]]:
        """Return the largest share at which every plan fits in the text, and the scenes; [] if none fits."""
        largest = max(self.drawing(self.report, k).extent for k in self.positions)
        for share in SHARES:
            last = share == SHARES[-1]
            room = FIGURE_ROOM if last else ROOM
            if share * largest > LARGEST and not last:
                continue
            drawn: list[Scene] = []
            for scene in self.scenes(share):
                if scene.width > room[0] or scene.height > room[1]:
                    break
                drawn.append(scene)
            else:
                return share, drawn
        return share, []

    def scenes(self, share: float) -> Iterator[Scene]:
        """Yield the plans, a `share` as large as the worked ones."""
        word = self.report.words["table"]["position"]
        for k in self.positions:
            drawing = replace(self.drawing(self.report, k).lettered, scale=None, lines=()).scaled(share)
            at = str(self.report.machine.position(k))
            yield replace(plan(drawing, title=f"{word} {at}", enlarged=False, margin=CLOSE_MARGIN), at=at)


class _Sketch:
    """A velocity or acceleration plan during its construction."""

    def __init__(self, report: ReportContext, what: What) -> None:
        self.what, self.named = what, report.named
        self.vectors: list[PlanVector[str]] = []
        self.points: list[PlanPoint[str]] = []
        self.lines: list[PlanLine[str]] = []

    def at(self, name: str) -> str:
        return ids.plan_point(self.what, name)

    def absolute(self, name: str, style: VectorStyle, stage: int) -> None:
        """Enter the vector from the pole for a point's velocity or acceleration, with its end."""
        end = self.at(image(name))
        self.vectors.append(PlanVector(name, POLE, end, style, Symbol(self.what, name, over="vector"), stage))
        self.points.append(PlanPoint(vocabulary.on_plan(name, self.what == "a"), end, stage))

    def components(self, pin: str, stage: int) -> None:
        """Enter the normal and the tangential acceleration of the pin of a crank, head to tail from the pole."""
        corner, end = self.at(ids.relative_corner("n", pin)), self.at(image(pin))
        for part, ends in (("n", (POLE, corner)), ("τ", (corner, end))):
            label = self.named(Symbol(self.what, pin, part, "vector"))
            self.vectors.append(PlanVector(part + pin, *ends, "relative", label, stage))
        self.points.append(PlanPoint(Symbol("n", pin), corner, stage))

    def relative(self, side: Side, part: str, start: str, end: str, stage: int) -> None:
        """Enter the vector that a side adds to the velocity or acceleration of its base, or one component of it."""
        label = self.named(Symbol(self.what, side.pair, part, "vector"))
        self.vectors.append(PlanVector(part + side.relative, start, end, "relative", label, stage))

    def group(self, group: GroupView, stage: int) -> None:
        """Enter a group's construction in three stages: known vectors, the lines that meet, further points."""
        for guide in group.under:
            self.absolute(guide.base, "known", stage)
        end = self.at(image(group.M))
        starts = [self._known(side, stage) for side in group.sides]
        stage += 1
        for start in starts:
            self.lines.append(PlanLine(start, end, stage))
        for side, start in zip(group.sides, starts, strict=True):
            if self.what == "a" and side.sought:
                self.relative(side, "τ" if side.turns else "r", start, end, stage)
            elif self.what == "v" and not side.still:
                self.relative(side, "", start, end, stage)
        self.absolute(group.M, "found", stage)
        further = [name for name in (group.Q, *(place.name for place in group.points)) if name != group.M]
        for name in further:
            self.absolute(name, "found", stage + 1)

    def triad(self, group: TriadView, stage: int) -> None:
        """Enter the construction of a group of class III: its special point, the third joint, the other points."""
        S, third = self.at(image(group.S)), group.third
        self.meeting(group.S, [self._leg(leg, stage) for leg in group.pair], stage + 1)
        if self.what == "v":
            for leg in group.pair:
                if not leg.side.still:
                    self.relative(leg.special, "", self.at(image(leg.P)), S, stage + 1)
        starts = S, POLE if third.side.still else self.at(image(third.P))
        if self.what == "a":
            starts = (
                self._laid(group.about, "n", starts[0], stage + 2),
                self._laid(third.side, "n", starts[1], stage + 2),
            )
        self.meeting(third.Q, starts, stage + 3)
        for side, start in zip((group.about, third.side), starts, strict=True):
            if self.what == "a" or not side.still:
                self.relative(side, "τ" if self.what == "a" else "", start, self.at(image(third.Q)), stage + 3)
        for leg in group.pair:
            self.absolute(leg.Q, "found", stage + 4)
            if self.what == "a":
                start = self.at(ids.relative_corner("n", leg.side.relative))
                self.relative(leg.side, "τ", start, self.at(image(leg.Q)), stage + 4)
            elif not leg.side.still:
                self.relative(leg.side, "", self.at(image(leg.P)), self.at(image(leg.Q)), stage + 4)
        for place in group.points:
            self.absolute(place.name, "found", stage + 4)

    def meeting(self, name: str, starts: Sequence[str], stage: int) -> None:
        """Enter the lines from two corners that meet in the image of a point, and the vector of this point."""
        end = self.at(image(name))
        self.lines += [PlanLine(start, end, stage) for start in starts]
        self.absolute(name, "found", stage)

    def _leg(self, leg: LegView, stage: int) -> str:
        """Enter the known accelerations of the special point on the line of a leg; return where its line starts."""
        start = POLE if leg.side.still else self.at(image(leg.P))
        if self.what == "v":
            return start
        return self._laid(leg.across, "n", self._laid(leg.side, "n", start, stage), stage)

    def _laid(self, side: Side, part: str, start: str, stage: int) -> str:
        """Enter a known relative acceleration from a corner; return the corner at its end."""
        end = self.at(ids.relative_corner(part, side.relative))
        self.relative(side, part, start, end, stage)
        self.points.append(PlanPoint(Symbol(part, side.pair), end, stage))
        return end

    def _known(self, side: Side, stage: int) -> str:
        """Enter the known relative acceleration and return the corner at which the unknown part starts."""
        start = POLE if side.still else self.at(image(side.base))
        if self.what == "v" or not side.part:
            return start
        end = self.at(ids.relative_corner(side.part, side.relative))
        self.relative(side, side.part, start, end, stage)
        self.points.append(PlanPoint(Symbol(side.part, side.pair), end, stage))
        return end


# --- forces


def forces(report: ReportContext, k: int, group: AssurView) -> FigureScenes:
    """Draw the force plan of a group at position `k`."""
    assert group.polygon is not None
    # The separated links, too, show the directions on the mechanism.
    alone = not report.parts("mechanism-beside-forces")
    return on_paper(_worked(report, force_plan(report, group.polygon, k), k, alone))


def force_stages(report: ReportContext, k: int, group: GroupView | TriadView) -> FigureScenes:
    """Draw the force plan step by step: loads, forces that moments gave, closing edges, measured forces."""
    assert group.polygon is not None
    drawing = force_plan(report, group.polygon, k)
    edges, reads = group.polygon.edges, group.polygon.reads
    known = sum(not edge.unknown for edge in edges)
    by_moments = {edge.start + edge.end for edge in edges if not edge.unknown and edge.part}
    if isinstance(group, GroupView) and group.across_by_moments:
        by_moments |= {edge.start + edge.end for edge in reads if edge.name == ids.reaction_force(group.inner)}

    def step(vector: PlanVector[complex]) -> int:
        if vector.name in by_moments:
            return 1
        return 0 if vector.stage < known else 2 + vector.stage - known

    def reached(corner: complex) -> int:
        """Return the first step that draws an arrow to or from a corner (mm)."""
        return min(step(v) for v in drawing.vectors if corner in (v.start, v.end))

    steps = replace(
        drawing,
        vectors=tuple(replace(v, stage=step(v)) for v in drawing.vectors),
        points=tuple(replace(p, stage=reached(p.at)) for p in drawing.points),
    )
    return _stages(report, steps, group.scale, k=k)


def force_plates(report: ReportContext, group: AssurView) -> FigureScenes:
    """Draw the force plans of all positions."""
    assert group.polygon is not None
    return FigureScenes(tuple(ForcePlans(report, group.polygon).scenes()))


class ForcePlans(Record):
    """Force plans of all positions, each at a separate round scale, which is printed below it.

    The forces of a cycle differ by orders of magnitude: at one common scale some plans would be dots.
    """

    report: ReportContext
    polygon: Polygon

    def scenes(self, times: float = 1.0) -> Iterator[Scene]:
        """Yield the plans, up to `times` as large as in the text."""
        word = self.report.words["table"]["position"]
        for k in self.report.plates:
            at = str(self.report.machine.position(k))
            yield replace(self._scene(k, f"{word} {at}", times), at=at)

    def _scene(self, k: int, title: str, times: float) -> Scene:
        """Draw one plan, at the next coarser scale if its labels would not fit beside other plans."""
        report = self.report
        drawing = replace(force_plan(report, self.polygon, k).lettered, scale=None, lines=())
        extent = drawing.extent * report.enlarged
        if extent < NOTHING_DRAWN:
            return plan(drawing, title=title, enlarged=False, margin=CLOSE_MARGIN)
        scale = ids.force_scale(self.polygon.name)
        own, room = report.ledger.number(scale, k), times * ROOM_OF_FORCES / report.enlarged
        μ = nice_up(own.printed * extent / (times * LARGEST_OF_FORCES))
        while True:
            note = Chain((report.ledger.symbol(scale), replace(own, value=μ, decimals=None)))
            scaled = replace(drawing.scaled(own.printed / μ), scale=note)
            scene = plan(scaled, title=title, enlarged=False, margin=CLOSE_MARGIN)
            coarser = nice_up(μ * (1 + FINER))
            if scene.width <= room or extent * own.printed / coarser < LEAST_OF_FORCES:
                return scene
            μ = coarser


def force_plan(report: ReportContext, polygon: Polygon, k: int) -> Plan:
    """Return a force plan at position `k`, in mm."""
    return replace(
        _at(force_construction(report, polygon), report, k), scale=_scale(report, ids.force_scale(polygon.name), k)
    )


def force_construction(report: ReportContext, polygon: Polygon) -> Construction[str]:
    """Return a force plan with the ids of its corners: known edges in order, the closing edges, the measured forces."""

    def corner(letter: str) -> str:
        return ids.force_corner(polygon.name, letter)

    known = sum(not edge.unknown for edge in polygon.edges)
    drawn: list[tuple[Edge, int, VectorStyle]] = [
        (edge, known, "found") if edge.unknown else (edge, number, "known") for number, edge in enumerate(polygon.edges)
    ]
    drawn += [(read, known + 1, "relative") for read in polygon.reads]
    vectors = []
    stage_of = {polygon.edges[0].start: 0}
    for edge, stage, style in drawn:
        start, end, label = corner(edge.start), corner(edge.end), report.force_vector(edge.name)
        vectors.append(PlanVector(edge.start + edge.end, start, end, style, label, stage))
        stage_of.setdefault(edge.end, stage)
    points = tuple(PlanPoint(Symbol(letter), corner(letter), stage) for letter, stage in stage_of.items())
    return Construction(tuple(vectors), points, pole=False)
