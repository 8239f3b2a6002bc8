"""Figures of the mechanism itself and of its course over a turn: scheme, positions, bodies, lever, curves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from reportgen.analysis import FULL_TURN, Analysis, analyse, motion_at
from reportgen.catalogue.machine import Machine, Piston
from reportgen.cycle.indicator import StrokeIndicator
from reportgen.document.facts import BodyView, Facts
from reportgen.document.views import GroupView
from reportgen.figures import charts, indicator
from reportgen.figures.actions import ArmOf, Couple, Force
from reportgen.figures.bodies import bodies
from reportgen.figures.coriolis import Sliding, coriolis
from reportgen.figures.draft import Draft
from reportgen.figures.labels import label
from reportgen.figures.lever import lever
from reportgen.figures.plan import Plan
from reportgen.figures.positions import PositionPlan, position_plan
from reportgen.figures.scene import Circle, Item, Line, Scene
from reportgen.figures.scheme import Looks, groups, scheme
from reportgen.figures.sheet import sheets
from reportgen.figures.style import CONSTRUCTION, PAPER, VISIBLE
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces import Polygon
from reportgen.ledger.kinematics import Slide
from reportgen.ledger.kinematics import scheme as scheme_of
from reportgen.mechanism.loads import Load, as_single_force, percussion_meeting
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.structure import DRIVER, GROUND
from reportgen.notation import symbols
from reportgen.notation.expressions import Chain, Number, Symbol

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
class Pictures:
    """The drawings of one report that show the machine; `velocity_plan` gives the plan the lever is made of."""

    facts: Facts
    words: Mapping[str, Any]
    velocity_plan: Callable[[int], Plan]

    @property
    def figures(self) -> dict[str, Callable[..., Drawn]]:
        return {
            "scheme": self.scheme,
            "groups": self.groups,
            "positions": self.positions,
            "extremes": self.extremes,
            "indicator": self.indicator,
            "coriolis": self.coriolis,
            "bodies": self.bodies,
            "lever": self.lever,
            "motion": self.motion,
            "displacement": self.displacement,
            "torque": self.torque,
            "polar": self.polar,
        }

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
        return Chain((self.ledger.symbol("mu.l"), _short(replace(number, value=number.value / factor))))

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

    # --- the mechanism

    def scheme(self) -> Drawn:
        machine, motion = self.analysis.machine, self.analysis.motion
        factor = self._reduction()
        scale = self.scale * factor
        return Drawn((scheme(machine.linkage, motion, SHOWN_AT, scale, self.looks(scale, factor)),))

    def groups(self) -> Drawn:
        machine, motion = self.analysis.machine, self.analysis.motion
        factor = self._reduction()
        scale = self.scale * factor
        words = self.words["figure"]
        titles = (
            words["driver"],
            *(words["group"].format(i=group.i, j=group.j) for group in self.facts.groups),
        )
        looks = replace(self.looks(scale, factor), scale=None)
        return Drawn(groups(machine.linkage, motion, SHOWN_AT, scale, looks, titles))

    def _reduction(self) -> float:
        """The ratio 1, 1/2, 1/2.5, … at which the mechanism at μ_l fits the box of a scheme."""
        points = [point.p[SHOWN_AT] for point in self.analysis.motion.points.values()]
        size = np.array(points)[np.isfinite(points)] * self.scale
        needed = max(np.ptp(size.real) / SCHEME_BOX[0], np.ptp(size.imag) / SCHEME_BOX[1], 1.0)
        return 1.0 / float(
            next(step for step in (1, 2, 2.5, 4, 5, 10, 20, 25, 40, 50, 100, 1000) if step >= needed)
        )

    @cached_property
    def dense(self) -> Motion:
        """The motion over one turn, finely."""
        machine = self.analysis.machine
        angles = machine.angles(np.linspace(0.0, FULL_TURN, DENSE))
        return solve_motion(machine.linkage, angles, machine.turn * machine.speed)

    @cached_property
    def one_turn(self) -> Motion:
        """The motion at the numbered positions of one turn."""
        machine = self.analysis.machine
        angles = machine.angles(machine.cycle_angles[: machine.count])
        return solve_motion(machine.linkage, angles, machine.turn * machine.speed)

    def positions(self) -> Drawn:
        return on_paper(self._position_plan(None))

    def _position_plan(self, beside: Draft | None) -> Scene:
        machine = self.analysis.machine
        shows = PositionPlan(
            self._numbered,
            machine.paths if beside is None else (),
            self._first_worked(),
            labels=tuple(map(str, machine.numbered(range(1, machine.count + 1)))),
        )
        looks = replace(self.looks(self.scale), blocks={}, centres=())
        return position_plan(
            machine.linkage, self.one_turn, self.dense, self.scale, shows, looks, beside=beside
        )

    @property
    def _numbered(self) -> tuple[str, ...]:
        """Points that carry the positions' numbers: pins of the crank, joints, of a slotted lever its end."""
        centres = {body.centre for body in self.analysis.machine.linkage.inertias}
        names = [*self.facts.crank_pins]
        for group in self.facts.groups:
            ends = [place.name for place in group.points_j if place.name not in centres]
            names += ends if group.kind == "RPR" else [group.Q]
        return tuple(names)

    def extremes(self) -> Drawn:
        """The mechanism where its first slider turns back: I as its stroke begins, II as it ends."""
        machine = self.analysis.machine
        course = machine.sliders[0]
        motion = motion_at(machine, course.dead_centres[:2] - course.phase)
        shows = PositionPlan(self._numbered, machine.paths, labels=("I", "II"))
        looks = replace(self.looks(self.scale), blocks={}, centres=())
        return on_paper(position_plan(machine.linkage, motion, self.dense, self.scale, shows, looks))

    def _first_worked(self) -> int:
        return (self.facts.worked[0] - 1) % self.analysis.machine.count

    # --- the gas

    def indicator(self) -> Drawn:
        """The diagram in line with the first piston's stroke, every piston's positions read from it."""
        machine = self.analysis.machine
        first = machine.pistons[0]
        unit, scale = 1e4, self.scale
        top, bottom = first.top * scale, first.bottom * scale
        highest = max(float(np.max(gas.pressure)) for gas in self.analysis.gas.values())
        highest = max(highest, _highest(first.indicator)) / unit
        side = -1j * (bottom - top) / abs(bottom - top) * -1
        start, end, mu = indicator.beside(top, bottom, side, 75.0, highest)
        symbol = Symbol("μ", "p")
        frame = indicator.Frame(
            start,
            end,
            side,
            mu,
            self.words["figure"]["pressure"],
            Chain((symbol, _short(Number(mu, 6, "N/(cm²·mm)")))),
        )
        branches = [
            indicator.Branch(name, x, tuple(p / unit for p in pressures))
            for name, x, pressures in _branches(first, machine, self.words["strokes"])
        ]
        readings = [
            indicator.Reading(
                Symbol(str(machine.position(k + 1)), "" if len(machine.pistons) == 1 else f"({gas.piston.link})"),
                float(gas.fraction[k]),
                float(gas.pressure[k]) / unit,
                first.top * scale + (bottom - top) * float(gas.fraction[k]),
            )
            for gas in self.analysis.gas.values()
            for k in range(machine.positions)
        ]
        return on_paper(self._position_plan(indicator.indicator(frame, branches, readings)))

    def coriolis(self, k: int, side: Slide) -> Drawn:
        """The relative velocity in a turning guide, turned by 90° in the sense of its ω."""
        ledger, pair = self.ledger, f"{side.point}{side.shown}"
        omega = float(ledger[f"turn.omega.{side.turning}"].at(k).real)
        base = complex(self.analysis.motion.points[side.base].v[k - 1])
        relative = complex(self.analysis.motion.points[side.point].v[k - 1]) - base
        sliding = Sliding(
            symbols.point(side.point),
            (Symbol("v", pair, over="vector"), relative),
            (Symbol("a", pair, "k", "vector"), 1j * omega * relative),
            (ledger.symbol(f"omega.{side.turning}"), float(np.sign(omega))),
        )
        return Drawn((coriolis(sliding),))

    # --- forces

    def bodies(self, k: int, group: GroupView) -> Drawn:
        """The group with all its forces, at half size; then each link that moments are taken of, with the arms."""
        names = self.words["figure"]
        half = self.scale * HALF
        whole = self._bodies(
            k,
            half,
            (group.i, group.j),
            [
                *self._loads((group.i, group.j), k, half),
                *self._carried(group.polygon, (group.i, group.j), k, half),
                *self._outer(group, group.i, k, half),
                *self._outer(group, group.j, k, half),
            ],
            turning=self._couples((group.i, group.j), k, half),
            looks=self._bare_looks(HALF),
            title=names["group"].format(i=group.i, j=group.j),
        )
        return beside_one_another(
            whole, *(self._alone(k, group, link, pin) for link, pin in _moments_of(group))
        )

    def _alone(self, k: int, group: GroupView, link: int, pin: str) -> Scene:
        """One link of a group with all that acts on it and the arms about a pin."""
        scale = self.scale
        about = complex(self.analysis.motion.points[pin].p[k - 1]) * scale
        return self._bodies(
            k,
            scale,
            (link,),
            [
                *self._loads((link,), k, scale),
                *self._carried(group.polygon, (link,), k, scale),
                *self._outer(group, link, k, scale),
                self._inner(group, link, k, scale),
            ],
            arms=[
                ArmOf(self.ledger.symbol(id), about, id.split(".")[1])
                for id in self.facts.arm_ids(group, pin, link)
                if not self.facts.zero(id, k)
            ],
            turning=self._couples((link,), k, scale),
            extra=self._percussion(link, k),
            looks=self._bare_looks(1.0),
            title=f"{self.words['figure']['link']} {link}",
        )

    def _bodies(
        self, k: int, scale: float, links: Sequence[int], acting: Sequence[Force], **more: Any
    ) -> Scene:
        return bodies(
            self.analysis.machine.linkage, self.analysis.motion, k - 1, scale, links, acting, **more
        )

    def _bare_looks(self, factor: float) -> Looks:
        return self.looks(self.scale * factor, factor)

    def _outer(self, group: GroupView, link: int, k: int, scale: float) -> list[Force]:
        """The reaction in the outer joint of a group's link, by components where moments gave one of them."""
        first = link == group.i
        digits = group.outer if first else group.guide
        pin = group.P if first else group.T or group.Q
        parts = (".t", ".n") if f"R.{digits}.t" in self.ledger else ("",)
        return [self._reaction(f"R{digits}{part}", f"R.{digits}{part}", pin, k, scale) for part in parts]

    def _inner(self, group: GroupView, link: int, k: int, scale: float) -> Force:
        """The reaction in the inner joint on one link of the group, as it is read from the plan."""
        read = self._reaction(f"R{group.inner}", f"R.{group.inner}", group.Q, k, scale)
        if link == group.i:
            return read
        name = f"R{group.across}"
        return Force(Symbol("R", group.across, over="vector"), read.at, -read.direction, "reaction", name)

    def _carried(
        self, polygon: Polygon | None, links: Sequence[int], k: int, scale: float
    ) -> list[Force]:
        """Reactions of other groups, found before, on some links of a force plan."""
        assert polygon is not None
        result = []
        for side in polygon.sides:
            if side.unknown or side.link not in links or side.name.endswith(".t") or side.name[0] != "R":
                continue
            at = complex(self.analysis.forces.reactions[side.name].point[k - 1]) * scale
            known = np.isfinite(at) and not self.facts.zero(f"R.{side.name[1:]}", k)
            direction = complex(self.ledger[f"F.{side.name}"].at(k)) if known else 0j
            symbol = symbols.vector(self.ledger.symbol(f"R.{side.name[1:]}"))
            result.append(Force(symbol, at if known else 0j, direction, "reaction", side.name))
        return result

    def crank(self, k: int) -> Scene:
        """The driver with the reactions on it and their arms about its centre."""
        motion, scale = self.analysis.motion, self.scale
        centre = self.facts.driver.centre
        about = complex(motion.points[centre].p[k - 1]) * scale
        acting = self._loads((DRIVER,), k, scale)
        acting += self._carried(self.facts.driver_polygon, (DRIVER,), k, scale)
        acting.append(self._reaction("R01", "R.01", centre, k, scale))
        arms = [
            ArmOf(self.ledger.symbol(id), about, id.split(".")[1])
            for id in self.facts.crank_lines[:-1]
            if not self.facts.zero(id, k)
        ]
        turning = (
            Couple(self.ledger.symbol("M.eq"), about, float(np.sign(self.ledger.number("M.eq", k).value))),
        )
        looks = replace(self.looks(scale), centres=())
        return self._bodies(k, scale, (DRIVER,), acting, arms=arms, turning=turning, looks=looks)

    def _pin_of(self, reaction: str) -> str:
        """The pin of the crank at which a group's reaction acts."""
        link = reaction.removeprefix("R")[: -len(str(DRIVER))]
        return next(group.P for group in self.facts.groups if str(group.i) == link)

    def _reaction(self, name: str, id: str, place: str, k: int, scale: float) -> Force:
        at = complex(self.analysis.motion.points[place].p[k - 1]) * scale
        symbol = symbols.vector(self.ledger.symbol(id))
        direction = 0j if self.facts.zero(id, k) else complex(self.ledger[f"F.{name}"].at(k))
        return Force(symbol, at, direction, "reaction", name)

    def _loads(self, links: Sequence[int], k: int, scale: float) -> list[Force]:
        """Loads on links; a force with a couple acts at the one point where it alone does both."""
        result = []
        for load in self.analysis.loads:
            if load.link not in links or not self._has_force(load, k):
                continue
            symbol = symbols.vector(self.ledger.symbol(load.name))
            at, force = self._acts_at(load, k) * scale, complex(load.force[k - 1])
            result.append(Force(symbol, at, force, "load", load.name))
        return result

    def _acts_at(self, load: Load, k: int) -> complex:
        """Where a load is drawn: an inertia force at the constructed point Q, else where it acts alone."""
        for body in self.facts.couples:
            if load.name == f"Pqt{body.link}" and (points := self._percussion_points(body, k)):
                return points[1]
        single = complex(as_single_force(load)[k - 1])
        return single if np.isfinite(single) else complex(load.point[k - 1])

    def _percussion_points(self, body: BodyView, k: int) -> tuple[complex, complex] | None:
        """The centre of percussion K and the point Q (m); None where their lines do not meet near the link."""
        start, centre = (self.analysis.motion.points[name] for name in (body.start, body.centre))
        l_sk = float(self.ledger.families[body.ids[-1]].values[0])
        s, a = complex(centre.p[k - 1]), complex(start.p[k - 1])
        q = complex(percussion_meeting(start.p, centre.p, start.a, centre.a, l_sk)[k - 1])
        near = abs(s - a) + 2 * l_sk
        return (s + (s - a) / abs(s - a) * l_sk, q) if np.isfinite(q) and abs(q - s) < near else None

    def _percussion(self, link: int, k: int) -> Draft:
        """K on a link, and the two lines of construction that meet in Q."""
        body = next((body for body in self.facts.couples if body.link == link), None)
        points = body and self._percussion_points(body, k)
        if not body or not points or self.facts.zero(f"M.Pqt{body.link}", k):
            return Draft()
        known, meeting = (point * self.scale for point in points)
        centre = complex(self.analysis.motion.points[body.centre].p[k - 1]) * self.scale
        marks: tuple[Item, ...] = (
            Line(centre, meeting, CONSTRUCTION),
            Line(known, meeting, CONSTRUCTION),
            Circle(known, 0.6, VISIBLE, PAPER),
            Circle(meeting, 0.6, VISIBLE, PAPER),
        )
        number = str(link)
        return Draft(
            marks, (label(known, Symbol("K", number), gap=1.2), label(meeting, Symbol("Q", number), gap=1.2))
        )

    def _couples(self, links: Sequence[int], k: int, scale: float) -> list[Couple]:
        """Torques, and couples whose force is nothing."""
        result = []
        for load in self.analysis.loads:
            if load.link not in links or load.couple[k - 1] == 0:
                continue
            torque = load.name in self._torques
            if torque or self.facts.zero(load.name, k):
                symbol = self.ledger.symbol(load.name if torque else f"M.{load.name}")
                at = complex(load.point[k - 1]) * scale
                result.append(Couple(symbol, at, float(load.couple[k - 1])))
        return result

    @property
    def _torques(self) -> frozenset[str]:
        """Loads that have no force by their nature."""
        return frozenset(torque.name for torque in self.analysis.machine.torques)

    def _has_force(self, load: Load, k: int) -> bool:
        return (
            load.name in self.ledger and load.name not in self._torques and not self.facts.zero(load.name, k)
        )

    def lever(self, k: int) -> Drawn:
        """The velocity plan turned by 90° against ω1, every load at its image, arms about the pole."""
        motion, index = self.analysis.motion, k - 1
        turn = self.analysis.machine.turn
        per = -1j * turn * MM / float(self.ledger.families["mu.v"].values[0])
        acting, arms = [], []
        for load in self.analysis.loads:
            if not self._has_force(load, k):
                continue
            at = np.full(motion.driver.shape, self._acts_at(load, k))
            image = complex(motion.of(load.link, at).v[index]) * per
            symbol = symbols.vector(self.ledger.symbol(load.name))
            acting.append(Force(symbol, image, complex(load.force[index]), "load", load.name))
            if not self.facts.zero(f"h.{load.name}.p", k):
                arms.append(ArmOf(self.ledger.symbol(f"h.{load.name}.p"), 0j, load.name))
        drawing = self.velocity_plan(k)
        scale = Chain((self.ledger.symbol("mu.v"), self.ledger.number("mu.v")))
        return on_paper(lever(drawing, acting, arms, sense=-turn, notes=(scale,)))

    # --- curves

    @cached_property
    def dense_cycle(self) -> Analysis:
        """The whole analysis over the cycle, finely, the numbered positions among the samples."""
        machine = self.analysis.machine
        own = machine.cycle_angles
        grid = np.linspace(0.0, machine.turns * FULL_TURN, machine.turns * (DENSE - 1) + 1)
        between = np.abs(grid[:, None] - own).min(axis=1) > SAME
        return analyse(machine, np.sort(np.concatenate((grid[between], own))))

    @property
    def _marks(self) -> tuple[int, ...]:
        """Which samples of `dense_cycle` are the numbered positions."""
        places = np.searchsorted(self.dense_cycle.cycle_angle, self.analysis.machine.cycle_angles)
        return tuple(map(int, places))

    def motion(self) -> Drawn:
        """Velocity and acceleration of what slides on the ground, ω and ε of what turns, over one turn."""
        names, motion, sliding = self.words["figure"], self.dense_cycle.motion, self._sliding
        along = {group.Q: np.exp(1j * _guide_angle(self.analysis, group)) for group in sliding}
        spins = scheme_of(self.analysis.machine.linkage).spins
        turning = [link for link, other in spins.items() if link == other > DRIVER]

        def of_points(base: str) -> list[tuple[Symbol, np.ndarray]]:
            vectors = {name: getattr(motion.points[name], base) for name in along}
            return [(Symbol(base, name), np.real(np.conj(u) * vectors[name])) for name, u in along.items()]

        def of_links(base: str, quantity: str) -> list[tuple[Symbol, np.ndarray]]:
            return [(Symbol(base, str(link)), getattr(motion.links[link], quantity)) for link in turning]

        drawings = (
            (of_points("v"), names["velocity"]),
            (of_points("a"), names["acceleration"]),
            (of_links("ω", "omega"), names["omega"]),
            (of_links("ε", "epsilon"), names["epsilon"]),
        )
        return Drawn(tuple(self._over_a_turn(curves, title) for curves, title in drawings if curves))

    def displacement(self) -> Drawn:
        """The coordinates of what slides on the ground, along its guide, over one turn."""
        slides = self.dense_cycle.motion.slides
        curves = [(Symbol("x", group.Q), MM * slides[GROUND, group.j].s) for group in self._sliding]
        return Drawn((self._over_a_turn(curves, self.words["figure"]["displacement"]),))

    @property
    def _sliding(self) -> tuple[GroupView, ...]:
        """Groups whose inner pin runs along a fixed guide."""
        on_ground = {slider for carrier, slider in self.analysis.motion.slides if carrier == GROUND}
        return tuple(group for group in self.facts.groups if group.kind == "RRP" and group.j in on_ground)

    def _over_a_turn(self, curves: Sequence[tuple[Symbol, np.ndarray]], title: str) -> Scene:
        """Curves over one turn of the driver, the numbered positions marked."""
        fine = self.dense_cycle
        count = int(np.searchsorted(fine.cycle_angle, FULL_TURN + SAME))
        # A sliding driver is told by its way (mm) instead of its angle.
        slides, name = bool(self.analysis.machine.span), self.words["figure"]["angle"]
        x = fine.motion.driver[:count] * MM if slides else np.degrees(fine.cycle_angle[:count])
        marks = self._marks[: self.analysis.machine.count]
        series = [charts.Series(symbol, x, values[:count], marks) for symbol, values in curves]
        return charts.chart(series, self.words["figure"]["way"] if slides else name, title, turn=not slides)

    def torque(self) -> Drawn:
        fine = self.dense_cycle
        names = self.words["figure"]
        degrees = np.degrees(fine.cycle_angle)
        curve = charts.Series(self.ledger.symbol("M.eq"), degrees, fine.torque, self._marks)
        mean = self.ledger.number("M.mean").value
        return Drawn(
            (
                charts.chart(
                    (curve,),
                    names["cycle_angle"],
                    names["torque"],
                    levels=((mean, self.ledger.symbol("M.mean")),),
                ),
            )
        )

    def polar(self) -> Drawn:
        """The load of each crank pin in axes that turn with the crank, its radius upwards."""
        fine, machine = self.dense_cycle, self.analysis.machine
        scenes = []
        for side in self.facts.driver_polygon.sides:
            if side.unknown or not side.name.startswith("R"):
                continue
            pin = self._pin_of(side.name)
            radius = fine.motion.points[pin].p - fine.motion.points[self.facts.driver.centre].p
            load = fine.forces.reactions[side.name].force * np.conj(radius / np.abs(radius)) * 1j
            numbers = tuple(map(str, machine.numbered(range(1, machine.positions + 1))))
            series = charts.Series(
                symbols.vector(self.ledger.symbol(f"R.{side.name[1:]}")),
                load.real,
                load.imag,
                self._marks,
                numbers,
            )
            scenes.append(charts.polar(series, "N", title=f"{self.words['figure']['pin']} {pin}"))
        return Drawn(tuple(scenes))


def _guide_angle(analysis: Analysis, group: GroupView) -> float:
    """The direction in which a slider's course counts: away from the crank along its guide."""
    angle = analysis.motion.links[group.j].angle
    return float(angle[0])


def _moments_of(group: GroupView) -> tuple[tuple[int, str], ...]:
    """The links of a group that the force analysis takes moments of, with the pin it takes them about."""
    if group.kind == "RRR":
        return (group.i, group.Q), (group.j, group.Q)
    if group.kind == "RPR":
        return ((group.j, group.T),)
    return ((group.i, group.Q),) if group.kind == "RRP" else ()


def _highest(table: Any) -> float:
    rows = table.rows if isinstance(table, StrokeIndicator) else (table.pressures,)
    return max(max(row) for row in rows)


def _branches(
    piston: Piston, machine: Machine, names: Sequence[str]
) -> list[tuple[str, tuple[float, ...], tuple[float, ...]]]:
    """Each stroke's line over s/H; a table by crank angle is carried over by the motion of the piston."""
    table = piston.indicator
    if isinstance(table, StrokeIndicator):
        return [(name, table.fractions, row) for name, row in zip(names, table.rows, strict=True)]
    result = []
    edges = (*piston.dead_centres, 2 * FULL_TURN)
    for name, (start, end) in zip(names, pairwise(edges), strict=True):
        angle = np.union1d(np.linspace(start, end, 91), [a for a in table.angles if start < a < end])
        fractions = piston.fraction(motion_at(machine, angle - piston.phase))
        pressure = np.interp(angle, table.angles, table.pressures)
        result.append((name, tuple(map(float, fractions)), tuple(map(float, pressure))))
    return result


def _short(number: Number) -> Number:
    """The number as it is if it has few digits, else with the decimals it came with."""
    tidy = float(f"{number.value:.6g}")
    return replace(number, value=tidy, decimals=None)
