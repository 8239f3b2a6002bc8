"""Plans of velocity, acceleration and force: the ledger's points on paper, in the order of construction.

The ledger's plans are metres on paper; how they are drawn is in `reportgen.figures`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from reportgen.document.drawing import A3_ACROSS, HALF, MM, TEXT_BLOCK, Drawn, figure, on_paper
from reportgen.document.groups import GroupView
from reportgen.document.report import Report
from reportgen.figures.draft import sheets
from reportgen.figures.plan import Plan, PlanLine, PlanPoint, PlanVector, Style, plan, stages
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics.sides import Side
from reportgen.notation import symbols
from reportgen.notation.expressions import Chain, Symbol

SHEET = (385.0, 232.0)
"""What of an A3 page (landscape) a plate may fill."""

# --- velocity and acceleration


@figure("velocity", "fig.v")
def velocity(report: Report, k: int) -> Drawn:
    return Drawn((plan(velocity_plan(report, k)),))


@figure("acceleration", "fig.a")
def acceleration(report: Report, k: int) -> Drawn:
    return Drawn((plan(acceleration_plan(report, k)),))


@figure("velocity-stages", "fig.v.stages")
def velocity_stages(report: Report, k: int) -> Drawn:
    return _stages(report, velocity_plan(report, k), "mu.v")


@figure("acceleration-stages", "fig.a.stages")
def acceleration_stages(report: Report, k: int) -> Drawn:
    return _stages(report, acceleration_plan(report, k), "mu.a")


@figure("velocity-plates", "fig.v.plates")
def velocity_plates(report: Report) -> Drawn:
    return _plates(report, velocity_plan, _plates_of_one_turn(report), "mu.v")


@figure("acceleration-plates", "fig.a.plates")
def acceleration_plates(report: Report) -> Drawn:
    return _plates(report, acceleration_plan, _plates_of_one_turn(report), "mu.a")


def velocity_plan(report: Report, k: int) -> Plan:
    """The velocity plan at a position, in mm, its stages in the order of construction."""
    return _motion_plan(report, "v", "p", k)


def acceleration_plan(report: Report, k: int) -> Plan:
    """The acceleration plan at a position, in mm."""
    return _motion_plan(report, "a", "π", k)


def _motion_plan(report: Report, what: str, pole: str, k: int) -> Plan:
    sketch = _Sketch(report.ledger, what, k)
    carried: dict[str, complex] = {name: sketch.at(name) for name in report.driver.names}
    stage = 0
    drawn: set[str] = set()
    for group in report.groups:
        for side in group.moving:
            if side.base in carried and side.base not in drawn:
                sketch.vector(side.base, 0j, carried[side.base], "known", what, side.base, stage)
                drawn.add(side.base)
        stage = sketch.group(group, stage) + 1
    first = PlanPoint(Symbol(pole), 0j)
    scale = _scale(report, f"mu.{what}")
    return Plan(tuple(sketch.vectors), (first, *sketch.points), tuple(sketch.lines), scale)


def _scale(report: Report, id: str) -> Chain:
    """A scale as a figure prints it: μ_v = 0.2189 m/(s·mm)."""
    return Chain((report.ledger.symbol(id), report.ledger.number(id)))


def _stages(report: Report, drawing: Plan, scale: str) -> Drawn:
    """The stages of a plan at half its size, with twice its scale."""
    number = report.ledger.number(scale)
    doubled = replace(number, value=float(f"{number.shown / HALF:.9g}"), decimals=None)
    return Drawn(stages(drawing, HALF), note=Chain((report.ledger.symbol(scale), doubled)))


def _plates_of_one_turn(report: Report) -> list[int]:
    """The positions of one turn that stand for the cycle's positions on the plates."""
    return sorted({(k - 1) % report.count + 1 for k in report.plates})


def _plates(
    report: Report, drawing: Callable[[Report, int], Plan], positions: Sequence[int], scale: str
) -> Drawn:
    """Plans of one scale: as a figure if they fit one text block, else on A3 sheets."""
    word = report.words["table"]["position"]
    scenes = [
        plan(replace(drawing(report, k), scale=None, lines=()), title=f"{word} {report.machine.position(k)}")
        for k in positions
    ]
    note = _scale(report, scale)
    on_page = sheets(scenes, *TEXT_BLOCK, note)
    if len(on_page) == 1 and on_page[0].width <= TEXT_BLOCK[0] and on_page[0].height <= TEXT_BLOCK[1]:
        return Drawn(on_page)
    return Drawn(sheets(scenes, *SHEET, note), A3_ACROSS)


class _Sketch:
    """A velocity or acceleration plan while its vectors are collected."""

    def __init__(self, ledger: Ledger, what: str, position: int) -> None:
        self.ledger, self.what, self.k = ledger, what, position
        self.vectors: list[PlanVector] = []
        self.points: list[PlanPoint] = []
        self.lines: list[PlanLine] = []

    def at(self, name: str) -> complex:
        return complex(self.ledger[f"plan.{self.what}.{name.lower()}"].at(self.k)) * MM

    def vector(
        self,
        name: str,
        start: complex,
        end: complex,
        style: Style,
        base: str,
        sub: str,
        stage: int,
        sup: str = "",
    ) -> None:
        label = Symbol(base, sub, sup, "vector")
        self.vectors.append(PlanVector(name, start, end, style, label, stage))
        if style != "relative":
            self.points.append(PlanPoint(symbols.on_plan(name, self.what == "a"), end, stage))

    def group(self, group: GroupView, stage: int) -> int:
        """Enter a group's construction after the stage that shows its outer pins; gives its last stage."""
        for guide in group.under:
            stage += 1
            self.vector(guide.base, 0j, self.at(guide.base), "known", self.what, guide.base, stage)
        end = self.at(group.M)
        starts = []
        for side in group.sides:
            stage, start = self._known(side, stage)
            starts.append(start)
        for start in starts:
            stage += 1
            self.lines.append(PlanLine(start, end, stage))
        for side, start in zip(group.sides, starts, strict=True):
            sought = not side.still if self.what == "v" else bool(side.sought)
            if sought:
                sup = "" if self.what == "v" else "τ" if side.turns else "r"
                self.vector(side.relative, start, end, "relative", self.what, side.pair, stage, sup)
        self.vector(group.M, 0j, end, "found", self.what, group.M, stage)
        further = [place.name for place in group.points]
        if group.M != group.Q:
            further.insert(0, group.Q)
        if further:
            stage += 1
            for name in further:
                self.vector(name, 0j, self.at(name), "found", self.what, name, stage)
        return stage

    def _known(self, side: Side, stage: int) -> tuple[int, complex]:
        """Enter the relative acceleration that is known; gives the stage and where the sought part starts."""
        start = 0j if side.still else self.at(side.base)
        part = side.part
        if self.what == "v" or not part:
            return stage, start
        end = complex(self.ledger[f"plan.a.{part}.{side.relative}"].at(self.k)) * MM
        self.vector(f"{part}{side.relative}", start, end, "relative", "a", side.pair, stage + 1, part)
        self.points.append(PlanPoint(Symbol(part, side.pair), end, stage + 1))
        return stage + 1, end


# --- forces


@figure("forces", "fig.R")
def forces(report: Report, k: int, group: GroupView) -> Drawn:
    assert group.polygon is not None
    return on_paper(plan(force_plan(report, group.polygon, k)))


@figure("force-stages", "fig.R.stages")
def force_stages(report: Report, k: int, group: GroupView) -> Drawn:
    """The force plan step by step: loads, components found by moments, closing sides, what is read."""
    assert group.polygon is not None
    drawing = force_plan(report, group.polygon, k)
    sides = group.polygon.sides
    known = sum(not side.unknown for side in sides)
    by_moments = [not side.unknown and side.name.endswith(".t") for side in sides]

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
    return _stages(report, steps, group.scale)


@figure("force-plates", "fig.R.plates")
def force_plates(report: Report, group: GroupView) -> Drawn:
    polygon = group.polygon
    assert polygon is not None
    return _plates(report, lambda report, k: force_plan(report, polygon, k), report.plates, group.scale)


def force_plan(report: Report, polygon: Polygon, k: int) -> Plan:
    """A force plan in mm: known sides one by one, then what closing it gives, then what is read from it."""

    def corner(letter: str) -> complex:
        return complex(report.ledger[f"plan.R{polygon.name}.{letter}"].at(k)) * MM

    known = sum(not side.unknown for side in polygon.sides)
    first = polygon.sides[0].start
    sides: list[tuple[int, Style]] = [
        (known, "found") if side.unknown else (number, "known") for number, side in enumerate(polygon.sides)
    ]
    drawn = [
        *zip(polygon.sides, sides, strict=True),
        *((read, (known + 1, "relative")) for read in polygon.reads),
    ]
    vectors = tuple(
        PlanVector(
            side.start + side.end,
            corner(side.start),
            corner(side.end),
            style,
            report.force_vector(side.name),
            stage,
        )
        for side, (stage, style) in drawn
    )
    stage_of = {first: 0}
    for side, (stage, _) in zip(polygon.sides, sides, strict=True):
        stage_of.setdefault(side.end, stage)
    points = tuple(PlanPoint(Symbol(letter), corner(letter), stage) for letter, stage in stage_of.items())
    return Plan(vectors, points, (), _scale(report, f"mu.R{polygon.name}"), pole=False)
