"""Plans of velocity, acceleration and force: the ledger's points on paper, in the order of construction.

The ledger's plans are metres on paper; how they are drawn is in `reportgen.figures`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from reportgen.document.figures import A3_ACROSS, HALF, MM, TEXT_BLOCK, Drawn, figure, in_text, on_paper
from reportgen.document.groups import GroupView
from reportgen.document.report import Report
from reportgen.figures.draft import sheets
from reportgen.figures.plan import Plan, PlanLine, PlanPoint, PlanVector, Style, plan, stages
from reportgen.figures.scene import Scene
from reportgen.figures.scheme import thumbnail
from reportgen.ledger.forces.polygon import Edge, Polygon
from reportgen.ledger.kinematics.linkage import POLES, What
from reportgen.ledger.kinematics.sides import Side, image
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Chain, Symbol

SHEET = (385.0, 232.0)
"""What of an A3 page (landscape) a plate may fill."""

# --- velocity and acceleration


def _register(name: str, what: What) -> None:
    """Register the figures of the velocity or acceleration plan: the plan, its stages, the plates of one turn."""

    def drawing(report: Report, k: int) -> Plan:
        return motion_plan(report, what, k)

    def whole(report: Report, k: int) -> Drawn:
        return on_paper(_worked(report, drawing(report, k), k))

    def in_stages(report: Report, k: int) -> Drawn:
        return _stages(report, drawing(report, k), f"mu.{what}")

    def on_plates(report: Report) -> Drawn:
        one_turn = sorted({(k - 1) % report.count + 1 for k in report.plates})
        return _plates(report, drawing, one_turn, f"mu.{what}")

    figure(name, f"fig.{what}")(whole)
    figure(f"{name}-stages", f"fig.{what}.stages")(in_stages)
    figure(f"{name}-plates", f"fig.{what}.plates")(on_plates)


_register("velocity", "v")
_register("acceleration", "a")


def motion_plan(report: Report, what: What, k: int) -> Plan:
    """The plan of velocities (v) or accelerations (a) at a position, in mm, its stages in the order of construction."""
    sketch = _Sketch(report, what, k)
    stage = 0
    drawn: set[str] = set()
    for group in report.groups:
        for side in group.moving:
            if side.base in report.driver.names and side.base not in drawn:
                sketch.absolute(side.base, "known", stage)
                drawn.add(side.base)
        stage = sketch.group(group, stage) + 1
    points = (PlanPoint(Symbol(POLES[what]), 0j), *sketch.points)
    return Plan(tuple(sketch.vectors), points, tuple(sketch.lines), _scale(report, f"mu.{what}"))


def _worked(report: Report, drawing: Plan, k: int) -> Scene:
    """A worked plan with the mechanism beside it."""
    small = thumbnail(report.machine.linkage, report.analysis.motion, k - 1)
    return plan(drawing, beside=(small,), width=TEXT_BLOCK[0])


def _scale(report: Report, id: str, k: int | None = None) -> Chain:
    """A scale as a figure prints it: μ_v = 0.2189 m/(s·mm)."""
    return Chain((report.ledger.symbol(id), report.ledger.number(id, k)))


def _stages(report: Report, drawing: Plan, scale: str, k: int | None = None) -> Drawn:
    """The stages of a plan at half its size, with twice its scale."""
    number = report.ledger.number(scale, k)
    doubled = replace(number, value=float(f"{number.shown / HALF:.9g}"), decimals=None)
    return Drawn(stages(drawing, HALF), note=Chain((report.ledger.symbol(scale), doubled)))


def _plates(
    report: Report, drawing: Callable[[Report, int], Plan], positions: Sequence[int], scale: str, at: int | None = None
) -> Drawn:
    """Plans of one scale, that of the position `at`: as a figure if they fit one text block, else on A3 sheets."""
    word = report.words["table"]["position"]
    scenes = [
        plan(replace(drawing(report, k), scale=None, lines=()), title=f"{word} {report.machine.position(k)}")
        for k in positions
    ]
    note = _scale(report, scale, at)
    on_page = sheets(scenes, *TEXT_BLOCK, note)
    return Drawn(on_page) if in_text(*on_page) else Drawn(sheets(scenes, *SHEET, note), A3_ACROSS)


class _Sketch:
    """A velocity or acceleration plan while its vectors are collected."""

    def __init__(self, report: Report, what: What, position: int) -> None:
        self.ledger, self.what, self.k, self.named = report.ledger, what, position, report.named
        self.vectors: list[PlanVector] = []
        self.points: list[PlanPoint] = []
        self.lines: list[PlanLine] = []

    def at(self, name: str) -> complex:
        return complex(self.ledger[f"plan.{self.what}.{name}"].at(self.k)) * MM

    def absolute(self, name: str, style: Style, stage: int) -> None:
        """Enter the vector of a point's own velocity or acceleration, from the pole, with its end."""
        end = self.at(image(name))
        self.vectors.append(PlanVector(name, 0j, end, style, Symbol(self.what, name, over="vector"), stage))
        self.points.append(PlanPoint(vocabulary.on_plan(name, self.what == "a"), end, stage))

    def relative(self, side: Side, part: str, start: complex, end: complex, stage: int) -> None:
        """Enter what a side adds to the velocity or acceleration of its base, or a part of it."""
        label = self.named(Symbol(self.what, side.pair, part, "vector"))
        self.vectors.append(PlanVector(part + side.relative, start, end, "relative", label, stage))

    def group(self, group: GroupView, stage: int) -> int:
        """Enter a group's construction after the stage that shows its outer pins; gives its last stage."""
        for guide in group.under:
            stage += 1
            self.absolute(guide.base, "known", stage)
        end = self.at(image(group.M))
        starts = []
        for side in group.sides:
            stage, start = self._known(side, stage)
            starts.append(start)
        for start in starts:
            stage += 1
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
        return stage + bool(further)

    def _known(self, side: Side, stage: int) -> tuple[int, complex]:
        """Enter the relative acceleration that is known; gives the stage and where the sought part starts."""
        start = 0j if side.still else self.at(image(side.base))
        if self.what == "v" or not side.part:
            return stage, start
        end = self.at(f"{side.part}.{side.relative}")
        self.relative(side, side.part, start, end, stage + 1)
        self.points.append(PlanPoint(Symbol(side.part, side.pair), end, stage + 1))
        return stage + 1, end


# --- forces


@figure("forces", "fig.R")
def forces(report: Report, k: int, group: GroupView) -> Drawn:
    assert group.polygon is not None
    return on_paper(_worked(report, force_plan(report, group.polygon, k), k))


@figure("force-stages", "fig.R.stages")
def force_stages(report: Report, k: int, group: GroupView) -> Drawn:
    """The force plan step by step: loads, components found by moments, closing edges, what is read."""
    assert group.polygon is not None
    drawing = force_plan(report, group.polygon, k)
    edges = group.polygon.edges
    known = sum(not edge.unknown for edge in edges)
    by_moments = [not edge.unknown and edge.part == "t" for edge in edges]

    def step(stage: int) -> int:
        return 2 + stage - known if stage >= known else int(by_moments[stage])

    def reached(corner: complex) -> int:
        """The first step that draws an arrow to or from a corner."""
        return min(step(v.stage) for v in drawing.vectors if corner in (v.start, v.end))

    steps = replace(
        drawing,
        vectors=tuple(replace(v, stage=step(v.stage)) for v in drawing.vectors),
        points=tuple(replace(p, stage=reached(p.at)) for p in drawing.points),
    )
    return _stages(report, steps, group.scale, k)


@figure("force-plates", "fig.R.plates")
def force_plates(report: Report, group: GroupView) -> Drawn:
    """The force plans of all positions at one scale: the largest of those that they have by themselves."""
    polygon = group.polygon
    assert polygon is not None
    scales = {k: float(report.ledger[group.scale].at(k)) for k in report.plates}
    common = max(scales, key=lambda k: scales[k])

    def drawing(report: Report, k: int) -> Plan:
        return force_plan(report, polygon, k).scaled(scales[k] / scales[common])

    return _plates(report, drawing, report.plates, group.scale, common)


def force_plan(report: Report, polygon: Polygon, k: int) -> Plan:
    """A force plan in mm: known edges one by one, then what closing it gives, then what is read from it."""

    def corner(letter: str) -> complex:
        return complex(report.ledger[f"plan.R{polygon.name}.{letter}"].at(k)) * MM

    known = sum(not edge.unknown for edge in polygon.edges)
    drawn: list[tuple[Edge, int, Style]] = [
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
    return Plan(tuple(vectors), points, (), _scale(report, f"mu.R{polygon.name}", k), pole=False)
