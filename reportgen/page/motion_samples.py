"""Sample the moving machine of a page from the solver, with its drawings, curves and numbers: `animation`.

A turn is sampled at 360 equally spaced angles, at the numbered positions, and on both sides of every jump of a load.
Plans have the corners of the report's plans, from the same definitions, so that both agree at a numbered position.
Motion repeats from turn to turn; forces continue through the cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from reportgen.base.records import Record, field
from reportgen.base.units import MM
from reportgen.case import MachineAnalysis
from reportgen.derivation import enter_motion, enter_plans
from reportgen.derivation.kinematic_entries import What, centre_symbol
from reportgen.derivation.load_entries import Polygon
from reportgen.drawing import Circle, Pen, style
from reportgen.drawing.animation import (
    LAYERS,
    Animation,
    BarScale,
    Chart,
    Curve,
    Errors,
    Fitted,
    MomentValue,
    MovingBody,
    MovingItem,
    MovingName,
    MovingVector,
    Pane,
    Spot,
    Track,
    extent,
    fitted,
    lever_items,
    linkage_items,
    path_items,
    plan_items,
)
from reportgen.drawing.vector_plan import Construction
from reportgen.formula import Symbol, ids, vocabulary
from reportgen.formula.vocabulary import KINDS
from reportgen.machine import DRIVER
from reportgen.machine.analysis import Analysis, Machine, analyse, breaks, motion_at
from reportgen.machine.force_analysis import Load, as_single_force
from reportgen.machine.kinematics import Motion
from reportgen.machine.load_laws import FULL_TURN
from reportgen.page import panes
from reportgen.page.straight_lines import errors_between
from reportgen.page.topic_layers import LAYERS as TOPIC_LAYERS
from reportgen.page.topic_layers import Box, LayerHooks
from reportgen.report.context import ReportContext
from reportgen.report.cycle_curves import axis, curves_of_motion, over_a_turn, over_the_cycle, torque_chart
from reportgen.report.mechanism_figures import drawing_scale, looks
from reportgen.report.plan_figures import POLE, force_construction, motion_construction

SAMPLES = 360
"""Number of equally spaced samples per turn."""
SAME_SAMPLE = 1e-7
"""Samples closer than this (rad) are one."""
BESIDE = 2e-5
"""Distance (rad) from a jump of a load at which its two sides are sampled."""
JUMP = 1e-3
"""Share of its largest value by which a load must change at a place to count as a jump."""
ARROW = 34.0
"""Largest length (mm) of the arrows of forces and rates on the machine."""
FAR = 2.5
"""Multiple of the drawing's diagonal beyond which a centre is not drawn."""
FORCES = ("loads", "inertia", "weights", "reactions")
"""Layers of forces, which share one scale."""
LEVER, LONGER = 0.45, 0.2
"""Length of the arrows of forces on the lever, and addition for an arrow in the same place: shares of the lever."""


def plan_of(polygon: Polygon) -> str:
    """Return the name of the pane of a force plan."""
    return f"R{polygon.name}"


def animation(case: MachineAnalysis) -> Animation:
    """Return the animation on the page of a case."""
    return Samples(case).animation()


class Samples(Record, dict=True):
    """A case at the samples of its cycle.

    Values in `kept` (angles, scales, boxes) are chosen once, by name. A slightly changed machine is sampled with the
    values of the original one, so that its changes are visible. Only what is `seen` is sampled: the panes and the
    layers of the machine with these names, or everything if it is None.
    """

    case: MachineAnalysis
    kept: dict[str, Any] = field(default_factory=dict)
    seen: frozenset[str] | None = None

    def sees(self, *names: str) -> bool:
        """Return True if any of the panes or layers with these names is sampled; "" is the layer of the machine."""
        return self.seen is None or any(not name or name in self.seen for name in names)

    def chosen(self, name: str, choice: Callable[[], Any]) -> Any:
        """Return the value kept under this name, or else make and keep it."""
        if name not in self.kept:
            self.kept[name] = choice()
        return self.kept[name]

    @property
    def scale(self) -> float:
        """mm of the drawing for a metre."""
        return float(self.chosen("scale", lambda: drawing_scale(self.report)))

    @property
    def machine(self) -> Machine:
        return self.case.analysis.machine

    @cached_property
    def knots(self) -> np.ndarray:
        """The samples of one turn (rad) [knots], from 0 to a whole turn."""
        angles: np.ndarray = self.chosen("knots", self._own_knots)
        return angles

    def _own_knots(self) -> np.ndarray:
        machine = self.machine
        if machine.instants:
            return np.linspace(0.0, FULL_TURN, machine.count + 1)
        own = np.mod(machine.cycle_angles[: machine.count], FULL_TURN * (1 + SAME_SAMPLE))
        wanted = np.concatenate((own, self._jumps()))
        grid = np.linspace(0.0, FULL_TURN, SAMPLES + 1)
        near = np.abs(grid[:, None] - wanted).min(axis=1) <= SAME_SAMPLE
        # The ends stay where they are; a position there is one of them.
        near[[0, -1]] = False
        angles = np.sort(np.concatenate((grid[~near], wanted)))
        return angles[np.concatenate(([True], np.diff(angles) > SAME_SAMPLE))]

    def _jumps(self) -> np.ndarray:
        """Return both sides of the angles (rad) [2 M] at which a load jumps, as friction does where a slider turns."""
        corners = breaks(self.machine)
        if not corners.size:
            return corners
        sides = [analyse(self.machine, corners + side * BESIDE) for side in (-1.0, 1.0)]
        jumping = np.zeros(corners.shape, dtype=bool)
        for before, after in zip(sides[0].applied, sides[1].applied, strict=True):
            for before_jump, after_jump in ((before.force, after.force), (before.couple, after.couple)):
                jumping |= np.abs(before_jump - after_jump) > JUMP * max(float(np.nanmax(np.abs(before_jump))), 1e-300)
        return np.mod(np.concatenate((corners[jumping] - BESIDE, corners[jumping] + BESIDE)), FULL_TURN)

    @cached_property
    def angles(self) -> np.ndarray:
        """The cycle angles (rad) [N] of all samples: those of a turn, turn after turn, to the end of the last."""
        if self.machine.instants:
            # The last sample closes the round that the page makes from the last instant to the first.
            return np.append(self.machine.cycle_angles, self.machine.cycle_angles[0])
        turns = np.arange(self.machine.turns)[:, None] * FULL_TURN
        return np.append((turns + self.knots[:-1]).ravel(), self.machine.turns * FULL_TURN)

    @cached_property
    def analysis(self) -> Analysis:
        return analyse(self.machine, self.angles)

    @cached_property
    def report(self) -> ReportContext:
        """The report, whose curves have these samples if they are all sampled."""
        return ReportContext(self.case, samples=self.analysis if self.seen is None else None)

    @cached_property
    def corners(self) -> dict[str, np.ndarray]:
        """The corners of the plans that are seen (mm) at the samples [N], and their scales (SI per mm), by id."""
        # Each plan is drawn as large as fits its panel.
        if self.sees(*(plan_of(polygon) for polygon in self.case.polygons)):
            calculation, _ = enter_plans(self.analysis, scaled=False)
        else:
            calculation = enter_motion(self.machine, self.angles, scaled=False)
        drawn = ids.plan_point, ids.force_corner, ids.force_scale, ids.centre
        scales = [ids.scale("v"), ids.scale("a")]
        stored = (id for id in calculation.families if id in scales or any(id in name for name in drawn))
        return {id: calculation.value(id) for id in stored}

    def _sample(self, k: int) -> int:
        """Return the index of the sample at the numbered position `k`."""
        return int(np.abs(self.angles - self.machine.cycle_angles[k - 1]).argmin())

    def animation(self) -> Animation:
        machine = self.machine
        panes = tuple(self.panes())
        layers = {item.layer for item in panes[0].items}
        of_topics = (layer for hooks in self._topics for layer in hooks.layers)
        places = self.knots[:-1] if machine.instants else machine.cycle_angles
        instants = machine.angles(machine.cycle_angles) if machine.instants else np.empty(0)
        return Animation(
            knots=np.degrees(self.knots),
            turns=1 if machine.instants else machine.turns,
            span=machine.span * MM,
            positions=tuple((str(machine.position(k + 1)), float(angle)) for k, angle in enumerate(np.degrees(places))),
            instants=tuple(map(float, instants * MM if machine.span else np.degrees(instants))),
            opening=self.case.assignment.worked_positions[0] - 1,
            panes=panes,
            charts=() if machine.instants else tuple(self.charts()),
            values=tuple(self.values()),
            units=self.report.ledger.units,
            errors=Errors(0.0, 1.0, 0.0) if machine.instants else errors_between(self.analysis, self.scale, BESIDE),
            layers=tuple(layer for layer in (*LAYERS, *of_topics) if layer in layers),
            runs=tuple(run for hooks in self._topics for run in hooks.runs(self.report)),
        )

    def turn(self, values: np.ndarray) -> Track:
        """Return a track that repeats from turn to turn, from its first turn [knots]."""
        return Track(values[: self.knots.size] if values.size > 1 else values)

    # --- drawings

    def panes(self) -> Iterator[Pane]:
        """Yield the panes that are seen, first that of the machine, which always is."""
        report, words = self.report, self.report.words["page"]
        yield self.mechanism()
        if self.sees("v"):
            yield self._plan_of_motion("v", words["velocity_plan"], "velocity")
        if self.sees("a"):
            yield self._plan_of_motion("a", words["acceleration_plan"], "acceleration")
        titles = {group.polygon.name: group.members for group in report.groups if group.polygon is not None}
        for polygon in self.case.polygons:
            if self.sees(plan_of(polygon)):
                of = titles.get(polygon.name)
                yield self._plan_of_forces(polygon, words["force_plan"].format(name=of) if of else words["driver_plan"])
        if self.sees("lever") and report.arms_about("p"):
            yield self._lever(words["lever"])

    def mechanism(self) -> Pane:
        """Return the pane of the machine itself, true to shape."""
        report, motion = self.report, self._one_turn
        linkage, scale = self.machine.linkage, self.scale
        look = looks(report, scale)
        sample = self._sample(self.case.assignment.worked_positions[0]) % (self.knots.size - 1)
        items = linkage_items(linkage, motion, sample, scale, look)
        low, high = self.chosen("box", lambda: self._room(motion, scale, extent(items)))
        names = self.machine.paths or tuple(n for n in motion.points if n not in linkage.ground)
        items = ([] if self.machine.instants else path_items(linkage, motion, names, scale)) + items
        scales = [BarScale(1 / scale, "segment")]
        for kind, rate, layer in (("velocity", "v", "velocities"), ("acceleration", "a", "accelerations")):
            arrows, per = self._rates(rate, layer, scale) if self.sees(layer) else ([], 0.0)
            items += arrows
            scales += [BarScale(per, kind, (layer,))] if arrows else []
        items += self._centres(scale, low, high) if self.sees("centres") else []
        layers = (*FORCES, *(layer for hooks in self._topics for layer in hooks.force_layers))
        if self.sees(*layers):
            forces, per = self._forces(scale)
            items += forces
            for hooks in self._topics:
                items += hooks.with_forces(report, self.analysis, scale, per, self.knots.size)
            scales += [BarScale(per, "force", layers)] if forces else []
        for hooks in self._topics:
            if self.sees(*(hooks.layers or ("",))):
                more, bars = hooks.with_bars(report, motion, scale, ARROW, self.chosen)
                items += more
                scales += bars
        spots = tuple(
            Spot(
                name,
                Track(motion.points[name].p * scale),
                Track(motion.points[name].p),
                Track(motion.points[name].v),
                Track(motion.points[name].a),
            )
            for name in motion.points
            if name not in linkage.ground
        )
        return Pane(
            "machine",
            report.words["page"]["machine"],
            items=tuple(item for item in items if self.sees(item.layer)),
            low=low,
            high=high,
            scales=tuple(scales),
            spots=spots,
        )

    def _room(self, motion: Motion, scale: float, box: Box) -> Box:
        """Return the corners (mm) of the drawing of the machine, with room for the items of topics."""
        for hooks in self._topics:
            box = hooks.room(self.report, motion, scale, box)
        return box

    @cached_property
    def _topics(self) -> tuple[LayerHooks, ...]:
        return tuple(TOPIC_LAYERS.among(self.machine.topics))

    @property
    def reachable(self) -> bool:
        """True if the machine assembles at all samples."""
        return bool(self._one_turn.reachable.all())

    @cached_property
    def _one_turn(self) -> Motion:
        """The motion at the samples of one turn."""
        return motion_at(self.machine, self.angles if self.machine.instants else self.knots)

    def _rates(self, rate: str, layer: str, scale: float) -> tuple[list[MovingItem], float]:
        """Return velocities or accelerations as arrows at their points, and the value of a millimetre of arrow.

        The longest arrow is `ARROW` long.
        """
        points = {n: p for n, p in self._one_turn.points.items() if n not in self.machine.linkage.ground}
        greatest = max(float(np.nanmax(np.abs(getattr(p, rate)))) for p in points.values())
        if not greatest:
            return [], 0.0
        per = self.chosen(f"arrows {rate}", lambda: greatest / ARROW)
        return [
            MovingVector(
                Track(p.p * scale),
                Track(p.p * scale + getattr(p, rate) / per),
                style.RELATIVE if rate == "v" else style.FOUND,
                label=Symbol(rate, name, over="vector"),
                name=ids.POINT_RATE[rate](name),
                layer=layer,
            )
            for name, p in points.items()
        ], per

    def _centres(self, scale: float, low: complex, high: complex) -> list[MovingItem]:
        """Return the instant centres near enough to be drawn, with the normals that meet in them."""
        items: list[MovingItem] = []
        middle, reach = (low + high) / 2, FAR * abs(high - low)
        for link in self.report.plane_links:
            with np.errstate(invalid="ignore"):
                at = self.corners[ids.centre(link.link)][: self.knots.size] * scale
            at = np.where(np.abs(at - middle) < reach, at, complex(np.nan, np.nan))
            centre = Track(at)
            for name in (link.base, link.point):
                start = Track(self._one_turn.points[name].p * scale)
                items.append(MovingVector(start, centre, style.NORMAL, 0.0, layer="centres"))
            dot = Circle(0j, 0.55, Pen(0.2, style.RED), style.PAPER)
            items.append(MovingBody((dot,), centre, layer="centres"))
            items.append(MovingName(centre_symbol(link.link), centre, (), 1.0, "centres"))
        return items

    def _forces(self, scale: float) -> tuple[list[MovingItem], float]:
        """Return all forces as arrows at their points, and their scale (N/mm); reactions each once."""
        analysis = self.analysis
        arrows: list[tuple[str, str, np.ndarray, np.ndarray]] = []
        groups: tuple[tuple[str, Sequence[Load]], ...] = (
            ("loads", analysis.applied),
            ("inertia", analysis.inertia),
            ("weights", analysis.weights),
        )
        for layer, loads in groups:
            arrows += [(layer, load.name, load.force, load.point) for load in loads]
        for name in self._reactions:
            reaction = analysis.forces.reactions[name]
            arrows.append(("reactions", name, reaction.force, reaction.point))
        sizes = {name: np.abs(force) for _, name, force, _ in arrows}
        greatest = max((float(np.nanmax(size, initial=0.0)) for size in sizes.values()), default=0.0)
        if not greatest:
            return [], 0.0
        per = self.chosen("arrows of forces", lambda: greatest / ARROW)
        return [
            MovingVector(
                Track(at * scale),
                Track(at * scale + force / per),
                style.REACTION if layer == "reactions" else style.ACTIVE,
                label=self._force_symbol(name),
                name=name,
                layer=layer,
            )
            for layer, name, force, at in arrows
            if np.nanmax(sizes[name], initial=0.0) > 1e-9 * greatest
        ], per

    def _force_symbol(self, name: str) -> Symbol:
        entered = ids.force_vector(name) in self.report.ledger
        return self.report.force_vector(name) if entered else vocabulary.vector(vocabulary.symbol(ids.of_force(name)))

    @cached_property
    def _reactions(self) -> list[str]:
        """The reactions, each once, as the force plans find them: R54 where the force of link 5 on link 4 is read."""
        reactions = self.analysis.forces.reactions
        edges = (edge for polygon in self.case.polygons for edge in (*polygon.edges, *polygon.reads))
        return list(dict.fromkeys(edge.name for edge in edges if edge.unknown and edge.name in reactions))

    def _plan_of_motion(self, what: What, title: str, kind: str) -> Pane:
        """Return the pane of the plan of velocities or accelerations."""
        plan = motion_construction(self.report, what)
        plan_fitted = self._fitted(what, self._rates_on(plan, what), kind, self.knots.size)
        return panes.plan(what, title, plan_items(plan, plan_fitted.tracks), plan_fitted)

    def _fitted(self, plan: str, corners: dict[str, np.ndarray], kind: str, turn: int) -> Fitted:
        """Return the corners of a plan in its panel, at its scale."""
        placed = fitted(corners, kind, turn, self.kept.get(f"plan {plan}"))
        self.kept.setdefault(f"plan {plan}", placed.scales[0].per)
        return placed

    def _rates_on(self, plan: Construction[str], what: What) -> dict[str, np.ndarray]:
        """Return the corners of a plan of velocities or accelerations, in SI units, at the samples [N]."""
        per = float(self.corners[ids.scale(what)].flat[0])
        return {id: np.zeros(1, complex) if id == POLE else self.corners[id] * per for id in plan.corners}

    def _plan_of_forces(self, polygon: Polygon, title: str) -> Pane:
        plan, per = force_construction(self.report, polygon), self.corners[ids.force_scale(polygon.name)]
        plan_fitted = self._fitted(
            polygon.name, {id: self.corners[id] * per for id in plan.corners}, "force", self.angles.size
        )
        return panes.plan(plan_of(polygon), title, plan_items(plan, plan_fitted.tracks), plan_fitted)

    def _lever(self, title: str) -> Pane:
        """Return Zhukovsky's lever: the velocity plan turned by 90° against ω₁, each load acting at its image.

        All arrows have one length unless one would cover another, because only arms count, with the force's size.
        """
        plan, quarter = motion_construction(self.report, "v"), -1j * self.machine.turn
        corners = {id: place * quarter for id, place in self._rates_on(plan, "v").items()}
        reach = max(float(np.nanmax(np.abs(place))) for place in corners.values())
        motion = self.analysis.motion
        drawn: list[str] = []
        acting = [(load.name, load.force, load.link, as_single_force(load)) for load in self.analysis.loads]
        if self.machine.span:
            pin = motion.points[self.report.driver.pin]
            acting.append(("Rcb", self.analysis.torque * pin.v, DRIVER, pin.p))
        for name, force, link, at in acting:
            size = np.abs(force)
            if not np.nanmax(size, initial=0.0):
                continue
            image = motion.of(link, at).v * quarter
            # A force that is nearly nothing may act alone far away: with its couple it has no place on the sheet.
            acts = size > 1e-9 * np.nanmax(size)
            image = np.where(acts & (np.abs(image) < FAR * reach), image, complex(np.nan, np.nan))
            before = sum(np.allclose(image, corners[other], equal_nan=True) for other in drawn)
            start, end = f"{name} start", f"{name} end"
            corners[start] = image
            with np.errstate(invalid="ignore"):
                corners[end] = image + (LEVER + LONGER * before) * reach * force / size
            drawn.append(start)
        lever = self._fitted("lever", corners, "velocity", self.angles.size)
        items = lever_items(plan, lever.tracks)
        for start in drawn:
            name = start.removesuffix(" start")
            ends = lever.tracks[start], lever.tracks[f"{name} end"]
            balance = name == "Rcb"
            items.append(MovingVector(*ends, style.REACTION if balance else style.ACTIVE, name=name))
            symbol = vocabulary.vector(self.report.balance_symbol()) if balance else self._force_symbol(name)
            items.append(MovingName(symbol, ends[1], ends[:1], 0.6))
        return panes.plan("lever", title, items, lever)

    # --- curves and numbers

    def charts(self) -> Iterator[Chart]:
        report = self.report
        for curves, title in curves_of_motion(report):
            tracks = tuple(Curve(symbol, self.turn(values)) for symbol, values in curves)
            yield Chart(over_a_turn(report, curves, title, half=True), tracks)
        if not report.has_forces:
            return
        torque = torque_chart(report, half=True)
        balance_symbol = report.balance_symbol()
        yield Chart(torque, (Curve(balance_symbol, Track(self.analysis.torque)),))
        if gases := self.analysis.gas:
            unit = KINDS["pressure"].scale
            pressures = [(Symbol("p", str(gas.piston.link)), gas.pressure / unit) for gas in gases.values()]
            title = axis(report, Symbol("p"), "pressure")
            tracks = tuple(Curve(symbol, Track(values)) for symbol, values in pressures)
            yield Chart(over_the_cycle(report, pressures, title, half=True), tracks)
        for hooks in self._topics:
            yield from hooks.charts(report)

    def values(self) -> Iterator[MomentValue]:
        """Yield the numbers below the drawing: positions, rates and rotations, forces, and the balancing load."""
        motion, analysis, ledger = self._one_turn, self.analysis, self.report.ledger
        moving = [name for name in motion.points if name not in self.machine.linkage.ground]
        for base, kind in (("v", "velocity"), ("a", "acceleration")):
            for name in moving:
                yield panes.value(Symbol(base, name), kind, np.abs(getattr(motion.points[name], base)))
        for base, attribute, kind in (("ω", "omega", "angular velocity"), ("ε", "epsilon", "angular acceleration")):
            for link in self.machine.linkage.links:
                rates = getattr(motion.links[link], attribute)
                if np.nanmax(np.abs(rates)) > 0:
                    yield panes.value(Symbol(base, str(link)), kind, rates)
        if not analysis.loads:
            return
        for gas in analysis.gas.values():
            yield panes.value(Symbol("p", str(gas.piston.link)), "pressure", gas.pressure)
        for load in analysis.applied:
            if np.nanmax(np.abs(load.force)) > 0:
                yield panes.value(panes.scalar(self._force_symbol(load.name)), "force", np.abs(load.force))
        for name in self._reactions:
            yield panes.value(
                panes.scalar(self._force_symbol(name)), "force", np.abs(analysis.forces.reactions[name].force)
            )
        yield panes.value(self.report.balance_symbol(), ledger["M.eq"].kind, analysis.torque)
        for hooks in self._topics:
            yield from (panes.value(*shown) for shown in hooks.values(self.report, motion))
