"""The report's figures by name: what of the ledger each one shows.

Numbers come from the ledger's plans (metres on paper → mm); how things are drawn is `reportgen.figures`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from reportgen.assignment import Assignment
from reportgen.document.acting import ForcePictures
from reportgen.document.centres import CentrePictures
from reportgen.document.curves import Curves
from reportgen.document.facts import Facts
from reportgen.document.flywheel import FlywheelFigures
from reportgen.document.pictured import TEXT_BLOCK, Drawn, beside_one_another, on_paper
from reportgen.document.pictures import MachinePictures
from reportgen.document.views import GroupView, known_part, sought_part
from reportgen.figures.draft import sheets
from reportgen.figures.plan import Plan, PlanLine, PlanPoint, PlanVector, Style, plan, stages
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics.sides import Side, Turn
from reportgen.notation import symbols
from reportgen.notation.expressions import Chain, Symbol

MM = 1e3
A3 = (420.0, 297.0)
SHEET = (385.0, 232.0)
"""What of an A3 page (landscape) a plate may fill."""
HALF = 0.5
"""Stages are drawn at half the size of the plan, with twice its scale."""


@dataclass(frozen=True)
class Drawings:
    """The figures of one report; `plates` are the positions whose plans are drawn."""

    assignment: Assignment
    facts: Facts
    words: Mapping[str, Any]
    plates: tuple[int, ...]

    @property
    def ledger(self) -> Ledger:
        return self.facts.ledger

    def draw(self, name: str, *arguments: Any) -> Drawn:
        """A figure by the name templates use; raises `KeyError` for a name nobody draws."""
        figures: dict[str, Callable[..., Drawn]] = {
            "velocity": self.velocity,
            "velocity-stages": self.velocity_stages,
            "velocity-plates": self.velocity_plates,
            "acceleration": self.acceleration,
            "acceleration-stages": self.acceleration_stages,
            "acceleration-plates": self.acceleration_plates,
            "forces": self.forces,
            "force-stages": self.force_stages,
            "force-plates": self.force_plates,
            "crank": self.crank,
            "slide": self.slide,
            **self.machine.figures,
            **self.centres.figures,
            **self.acting.figures,
            **self.curves.figures,
            **FlywheelFigures(self.facts.case.flywheel, self.ledger, self.words).figures,
        }
        return figures[name](*arguments)

    @cached_property
    def machine(self) -> MachinePictures:
        return MachinePictures(self.facts, self.words, self.velocity_plan)

    @cached_property
    def centres(self) -> CentrePictures:
        return CentrePictures(self.facts, self.words, self.velocity_plan)

    @cached_property
    def acting(self) -> ForcePictures:
        return ForcePictures(self.facts, self.words, self.velocity_plan)

    @cached_property
    def curves(self) -> Curves:
        return Curves(self.facts, self.words, self.velocity_plan)

    # --- plans of velocity and acceleration

    def velocity(self, k: int) -> Drawn:
        return Drawn((plan(self.velocity_plan(k)),))

    def acceleration(self, k: int) -> Drawn:
        return Drawn((plan(self.acceleration_plan(k)),))

    def velocity_stages(self, k: int) -> Drawn:
        return self._stages(self.velocity_plan(k), "mu.v")

    def acceleration_stages(self, k: int) -> Drawn:
        return self._stages(self.acceleration_plan(k), "mu.a")

    def _stages(self, drawing: Plan, scale: str) -> Drawn:
        number = self.ledger.number(scale)
        doubled = replace(number, value=float(f"{number.shown / HALF:.9g}"), decimals=None)
        return Drawn(stages(drawing, HALF), note=Chain((self.ledger.symbol(scale), doubled)))

    def velocity_plates(self) -> Drawn:
        return self._plates(self.velocity_plan, "mu.v")

    def acceleration_plates(self) -> Drawn:
        return self._plates(self.acceleration_plan, "mu.a")

    def _plates(self, drawing: Callable[[int], Plan], scale: str) -> Drawn:
        kept = positions_kept(self.plates, self.facts.analysis.machine.count)
        return self._laid_out(drawing, kept, scale)

    def _laid_out(self, drawing: Callable[[int], Plan], positions: Sequence[int], scale: str) -> Drawn:
        """Plans of one scale: as a figure if they fit one text block, else on A3 sheets."""
        scenes = [
            plan(replace(drawing(k), scale=None, lines=()), title=self.at_position(k)) for k in positions
        ]
        note = self.scale(scale)
        on_page = sheets(scenes, *TEXT_BLOCK, note)
        if len(on_page) == 1 and on_page[0].width <= TEXT_BLOCK[0] and on_page[0].height <= TEXT_BLOCK[1]:
            return Drawn(on_page)
        return Drawn(sheets(scenes, *SHEET, note), A3)

    def at_position(self, k: int) -> str:
        return f"{self.words['table']['position']} {self.facts.analysis.machine.position(k)}"

    def velocity_plan(self, k: int) -> Plan:
        """The velocity plan at a position, in mm, its stages in the order of construction."""
        return self._plan("v", "p", k)

    def acceleration_plan(self, k: int) -> Plan:
        """The acceleration plan at a position, in mm."""
        return self._plan("a", "π", k)

    def _plan(self, what: str, pole: str, k: int) -> Plan:
        sketch = _Sketch(self.ledger, what, k)
        driver = self.facts.driver
        places = [driver.pin, *(place.name for place in driver.others)]
        carried = {name: sketch.at(name) for name in places}
        stage = 0
        drawn: set[str] = set()
        for group in self.facts.groups:
            for side in group.moving:
                if side.base in carried and side.base not in drawn:
                    sketch.vector(side.base, 0j, carried[side.base], "known", what, side.base, stage)
                    drawn.add(side.base)
            stage = sketch.group(group, stage) + 1
        return sketch.finish(pole, self.scale(f"mu.{what}"))

    def scale(self, id: str) -> Chain:
        """A scale as a figure prints it: μ_v = 0.2189 m/(s·mm)."""
        return Chain((self.ledger.symbol(id), self.ledger.number(id)))

    # --- force plans

    def forces(self, k: int, group: GroupView) -> Drawn:
        assert group.polygon is not None
        return on_paper(plan(self.force_plan(group.polygon, k)))

    def force_stages(self, k: int, group: GroupView) -> Drawn:
        """The force plan step by step: loads, components found by moments, closing sides, what is read."""
        assert group.polygon is not None
        drawing = self.force_plan(group.polygon, k)
        sides = group.polygon.sides
        known = sum(not side.unknown for side in sides)
        by_moments = [not side.unknown and side.name.endswith(".t") for side in sides]

        def step(stage: int) -> int:
            return 2 + stage - known if stage >= known else int(by_moments[stage])

        def reached(corner: complex) -> int:
            """The first step that draws an arrow to or from a corner."""
            ends = [v for v in drawing.vectors if corner in (v.start, v.end)]
            return min(step(v.stage) for v in ends)

        steps = replace(
            drawing,
            vectors=tuple(replace(v, stage=step(v.stage)) for v in drawing.vectors),
            points=tuple(replace(p, stage=reached(p.at)) for p in drawing.points),
        )
        return self._stages(steps, f"mu.R{group.polygon.name}")

    def slide(self, k: int) -> Drawn:
        """A sliding driver with its forces, and their polygon."""
        polygon = plan(self.force_plan(self.facts.driver_polygon, k))
        return beside_one_another(self.acting.slider(k), polygon)

    def crank(self, k: int) -> Drawn:
        """The driver with its forces, and their polygon."""
        polygon = plan(self.force_plan(self.facts.driver_polygon, k))
        return beside_one_another(self.acting.crank(k), polygon)

    def force_plates(self, group: GroupView) -> Drawn:
        polygon = group.polygon
        assert polygon is not None
        return self._laid_out(lambda k: self.force_plan(polygon, k), self.plates, f"mu.R{polygon.name}")

    def force_plan(self, polygon: Polygon, k: int) -> Plan:
        """A force plan in mm: known sides one by one, then what closing it gives, then what is read from it."""

        def corner(letter: str) -> complex:
            return complex(self.ledger[f"plan.R{polygon.name}.{letter}"].at(k)) * MM

        known = sum(not side.unknown for side in polygon.sides)
        vectors, points = [], [PlanPoint(Symbol(polygon.sides[0].start), corner(polygon.sides[0].start))]
        for number, side in enumerate(polygon.sides):
            stage = known if side.unknown else number
            style: Style = "found" if side.unknown else "known"
            vectors.append(
                PlanVector(
                    side.start + side.end,
                    corner(side.start),
                    corner(side.end),
                    style,
                    self._force(side.name),
                    stage,
                )
            )
            if side.end != polygon.sides[0].start and not any(
                point.label == Symbol(side.end) for point in points
            ):
                points.append(PlanPoint(Symbol(side.end), corner(side.end), stage))
        vectors += [
            PlanVector(
                read.start + read.end,
                corner(read.start),
                corner(read.end),
                "relative",
                self._force(read.name),
                known + 1,
            )
            for read in polygon.reads
        ]
        return Plan(tuple(vectors), tuple(points), (), self.scale(f"mu.R{polygon.name}"), pole=False)

    def _force(self, name: str) -> Symbol:
        known = name in self.ledger
        return symbols.vector(self.ledger.symbol(name if known else f"R.{name.removeprefix('R')}"))


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
            self.point(name, end, stage)

    def point(self, name: str, at: complex, stage: int) -> None:
        self.points.append(PlanPoint(symbols.on_plan(name, self.what == "a"), at, stage))

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
            sought = not side.still if self.what == "v" else bool(sought_part(side))
            if sought:
                sup = "" if self.what == "v" else "τ" if isinstance(side, Turn) else "r"
                name = f"{side.point}{side.shown}"
                self.vector(side.relative, start, end, "relative", self.what, name, stage, sup)
        self.vector(group.M, 0j, end, "found", self.what, group.M, stage)
        further = [place.name for place in (*group.points, *group.points_j)]
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
        part = known_part(side)
        if self.what == "v" or not part:
            return stage, start
        end = complex(self.ledger[f"plan.a.{part}.{side.relative}"].at(self.k)) * MM
        name = f"{side.point}{side.shown}"
        self.vector(f"{part}{side.relative}", start, end, "relative", "a", name, stage + 1, part)
        self.points.append(PlanPoint(Symbol(part, name), end, stage + 1))
        return stage + 1, end

    def finish(self, pole: str, scale: Chain) -> Plan:
        first = PlanPoint(Symbol(pole), 0j)
        return Plan(tuple(self.vectors), (first, *self.points), tuple(self.lines), scale)


def positions_kept(plates: Sequence[int], count: int) -> list[int]:
    """The positions of one turn that stand for the cycle's positions in `plates`."""
    return sorted({(k - 1) % count + 1 for k in plates})
