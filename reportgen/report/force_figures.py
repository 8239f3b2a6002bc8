"""Figures of forces on the mechanism: separated links, the driver, Zhukovsky's lever.

The force plans are in `plan_figures`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.units import MM
from reportgen.derivation.load_entries import Polygon
from reportgen.document.figure_placement import FigureScenes, beside_one_another, on_paper
from reportgen.drawing import Circle, Item, Line, Scene
from reportgen.drawing.canvas import Canvas
from reportgen.drawing.force_drawings import ArmOf, Couple, Force
from reportgen.drawing.force_drawings import bodies as bodies_figure
from reportgen.drawing.force_drawings import lever as lever_figure
from reportgen.drawing.labels import label
from reportgen.drawing.style import CONSTRUCTION, PAPER, VISIBLE
from reportgen.drawing.vector_plan import plan
from reportgen.formula import Chain, Expression, Symbol, constructions, ids, size, vocabulary
from reportgen.machine import DRIVER
from reportgen.machine.force_analysis import Load, as_single_force
from reportgen.report import guide_couples, percussion
from reportgen.report.context import ReportContext
from reportgen.report.link_views import GroupView
from reportgen.report.mechanism_figures import drawing_scale, looks
from reportgen.report.plan_figures import force_plan, motion_plan
from reportgen.report.slider_faces import at_ends, face, wide_sliders_of
from reportgen.report.triad_views import LegView, TriadView


class _Bodies(Record):
    """Links of a machine at a position, drawn to a `share` of μ_l, with the forces on them."""

    report: ReportContext
    k: int
    links: tuple[int, ...]
    share: float = 1.0

    @property
    def scale(self) -> float:
        """mm of paper per metre."""
        return drawing_scale(self.report) * self.share

    def at(self, name: str) -> complex:
        """Return the place of a point on paper (mm)."""
        return self.report.place(name, self.k) * self.scale

    def scene(self, forces: Sequence[Force], extra: Canvas | None = None, **more: Any) -> Scene:
        """Draw the links with some forces."""
        report, look = self.report, looks(self.report, self.scale, self.share)
        machine, motion = report.machine.linkage, report.analysis.motion
        drawn = self.wide_sliders() + (extra or Canvas())
        return bodies_figure(
            machine, motion, self.k - 1, self.scale, self.links, forces, looks=look, extra=drawn, **more
        )

    def wide_sliders(self) -> Canvas:
        """Return the faces of the wide sliders among the links, each with the arm to its pin."""
        items: list[Item] = []
        for link in (link for link in self.links if link in wide_sliders_of(self.report)):
            items += face(self.report, link, self.k, self.scale)
        return Canvas(tuple(items))

    def loads(self) -> list[Force]:
        """Return the loads on the links.  A force with a couple acts at the one point where it replaces both."""
        return [
            Force(
                self.report.force_vector(load.name),
                _acts_at(self.report, load, self.k) * self.scale,
                complex(load.force[self.k - 1]),
                "load",
                load.name,
            )
            for load in self.report.analysis.loads
            if load.link in self.links and _has_force(self.report, load, self.k)
        ]

    def couples(self) -> list[Couple]:
        """Return the torques on the links, and the couples without a force."""
        report, index, result = self.report, self.k - 1, []
        for load in report.analysis.loads:
            if load.link not in self.links or load.couple[index] == 0:
                continue
            torque = _is_torque(report, load)
            if torque or report.is_zero(load.name, self.k):
                symbol = report.ledger.symbol(load.name if torque else ids.inertia_couple(load.link))
                label = _of_arc(symbol, float(load.couple[index])) if torque else symbol
                result.append(Couple(label, complex(load.point[index]) * self.scale, float(load.couple[index])))
        return result

    def of_guides(self, group: GroupView) -> list[Couple]:
        """Return the couples of guides without a force on the links of a group.

        The couple between both links is included only if a single link is drawn.
        """
        report, k = self.report, self.k
        return [
            couple
            for slide in group.contacts
            for link in self.links
            if link == slide.link or slide.digits == group.inner
            if slide.digits != group.inner or len(self.links) == 1
            for couple in guide_couples.drawn(report, slide, link, k, self.at(slide.pin))
        ]

    def couples_found_before(self, polygon: Polygon) -> list[Couple]:
        """Return the couples of guides without a force that groups solved before exert on the links."""
        report, k = self.report, self.k
        return [
            couple
            for slide, link in guide_couples.handed_on(report, polygon)
            if link in self.links
            for couple in guide_couples.drawn(report, slide, link, k, self.at(slide.pin))
        ]

    def arms(self, known: Sequence[str], pin: str) -> list[ArmOf]:
        """Return those arms of forces about a pin that are not zero."""
        return [arm_of(self.report, id, self.k, self.at(pin)) for id in known if not self.report.is_zero(id, self.k)]

    # --- reactions

    def reaction(self, name: str, at: complex) -> Force:
        """Return a reaction R12, or its component R12.t, in its true sense at a place (mm)."""
        direction = true_sense(self.report, name, self.k)
        return Force(self.report.force_vector(name), at, direction, "reaction", name)

    def found_before(self, polygon: Polygon) -> list[Force]:
        """Return the reactions that groups solved before exert on the links of a force plan."""
        reactions = []
        for edge in polygon.carried:
            if edge.link in self.links:
                at = complex(self.report.analysis.forces.reactions[edge.name].point[self.k - 1]) * self.scale
                force = self.reaction(edge.name, at)
                reactions.append(force if force.direction and np.isfinite(at) else replace(force, at=0j, direction=0j))
        return reactions

    def outer(self, group: GroupView, link: int) -> list[Force]:
        """Return the reaction in the outer joint of a group's link, by components if moments gave one of them."""
        first = link == group.i
        digits = group.outer if first else group.guide
        pin = group.P if first else group.T or group.Q
        whole, parts = ids.reaction_force(digits), [ids.reaction_force(digits, part) for part in "tn"]
        by_parts = ids.reaction(digits, "t") in self.report.ledger
        if ends := at_ends(self.report, digits, link, self.k):
            return [Force(shown, at * self.scale, way, "reaction", id) for shown, at, way, id in ends]
        return [self.reaction(name, self.at(pin)) for name in (parts if by_parts else [whole])]

    def inner(self, group: GroupView, link: int) -> Force:
        """Return the reaction in the inner joint on one link of the group."""
        # The inner joint of an RPP is the slide of its block, which is drawn at the pin of the block.
        at, on_i = self.at(group.P if group.kind == "RPP" else group.Q), link == group.i
        sense = true_sense(self.report, ids.reaction_force(group.inner), self.k) * (1 if on_i else -1)
        digits = group.inner if on_i else group.across
        return Force(Symbol("R", digits, over="vector"), at, sense, "reaction", ids.reaction_force(digits))


def arm_of(report: ReportContext, id: str, k: int, about: complex) -> ArmOf:
    """Return an arm with its printed length; its foot is `about`, a point of the paper (mm)."""
    length = report.ledger.number(id, k, size=True).value / report.enlarged
    return ArmOf(report.ledger.symbol(id), about, report.ledger[id].of, length)


def true_sense(report: ReportContext, name: str, k: int) -> complex:
    """Return the unit vector of a reaction on a separated link, as it is drawn; 0 if the reaction is zero."""
    vector = report.ledger[ids.force_vector(name)]
    return 0j if report.is_zero(vector.of, k) else complex(vector.at(k))


# --- groups and the driver


def bodies(report: ReportContext, k: int, group: GroupView | TriadView) -> FigureScenes:
    """Draw the group with all its forces at half size, then each link whose moments are taken, with the arms.

    If both links are drawn separately, the whole group is drawn only if the report has room for both.
    """
    return beside_one_another(*separated(report, k, group))


def separated(report: ReportContext, k: int, group: GroupView | TriadView) -> list[Scene]:
    """Return the scenes of a group's separated links."""
    assert group.polygon is not None
    if isinstance(group, TriadView):
        return _separated_triad(report, k, group)
    both = _Bodies(report, k, (group.i, group.j), share=0.5)
    forces = [
        *both.loads(),
        *both.found_before(group.polygon),
        *both.outer(group, group.i),
        *both.outer(group, group.j),
    ]
    title = group.title(report.words["figure"])
    alone = _moments(report, group, k)
    scenes = []
    if report.parts("links-together") or {link for link, _ in alone} != {group.i, group.j}:
        turning = [*both.couples(), *both.of_guides(group), *both.couples_found_before(group.polygon)]
        others = {group.i, group.j} - {link for link, _ in alone}
        marks = sum((percussion.drawn(report, link, k, both.scale) for link in sorted(others)), Canvas())
        scenes.append(both.scene(forces, marks, turning=turning, title=title))
    for link, pin in alone:
        bodies = _Bodies(report, k, (link,))
        forces = [
            *bodies.loads(),
            *bodies.found_before(group.polygon),
            *bodies.outer(group, link),
            bodies.inner(group, link),
        ]
        arms, title = bodies.arms(group.arms(pin, link), pin), f"{report.words['figure']['link']} {link}"
        extra = percussion.drawn(report, link, k, bodies.scale) + _foot(report, group, link, k)
        turning = [*bodies.couples(), *bodies.of_guides(group), *bodies.couples_found_before(group.polygon)]
        scenes.append(bodies.scene(forces, arms=arms, turning=turning, extra=extra, title=title))
    return scenes


def _separated_triad(report: ReportContext, k: int, group: TriadView) -> list[Scene]:
    """Return a whole group of class III with the arms about its special point, and each leg with those about its joint.

    Reactions that moments give are drawn by components; the plan finds the normal ones of the pair.
    """
    assert group.polygon is not None

    def forces(bodies: _Bodies, legs: Sequence[LegView]) -> list[Force]:
        assert group.polygon is not None
        parts = [(ids.reaction_force(leg.outer, part), leg.P) for leg in legs for part in "tn"]
        reactions = (bodies.reaction(name, bodies.at(pin)) for name, pin in parts)
        return [*bodies.loads(), *bodies.found_before(group.polygon), *reactions]

    whole = _Bodies(report, k, group.links)
    arms = whole.arms([id for id in group.axial_lines if id in ids.arm], group.S)
    extra = _special_lines(report, k, group, whole)
    turning = [*whole.couples(), *whole.couples_found_before(group.polygon)]
    title = group.title(report.words["figure"])
    scenes = [whole.scene(forces(whole, group.legs), extra, arms=arms, turning=turning, title=title)]
    for leg in group.legs:
        alone = _Bodies(report, k, (leg.link,))
        inner = alone.reaction(ids.reaction_force(leg.inner), alone.at(leg.Q))
        arms = alone.arms([id for id in leg.lines if id in ids.arm], leg.Q)
        extra = percussion.drawn(report, leg.link, k, alone.scale)
        turning = [*alone.couples(), *alone.couples_found_before(group.polygon)]
        title = f"{report.words['figure']['link']} {leg.link}"
        scenes.append(alone.scene([*forces(alone, [leg]), inner], extra, arms=arms, turning=turning, title=title))
    return scenes


def _special_lines(report: ReportContext, k: int, group: TriadView, bodies: _Bodies) -> Canvas:
    """Draw the special point of a group, where the lines of two legs meet, and the construction of single forces."""
    at = bodies.at(group.S)
    lines: list[Item] = [Line(bodies.at(leg.Q), at, CONSTRUCTION) for leg in group.pair]
    mark = Canvas((*lines, Circle(at, 0.6, VISIBLE, PAPER)), (label(at, vocabulary.point(group.S), gap=1.2),))
    return mark + percussion.drawn(report, group.plate, k, bodies.scale)


def _moments(report: ReportContext, group: GroupView, k: int) -> tuple[tuple[int, str], ...]:
    """Return the links of a group for which the force analysis takes moments, each with the pin about which it does."""
    solved: dict[str, tuple[tuple[int, str], ...]] = {
        "RRR": ((group.i, group.Q), (group.j, group.Q)),
        "RPR": ((group.j, group.T),),
        "RRP": ((group.i, group.Q),),
    }
    # A slide's reaction is placed by moments about its pin, whose arms are measured too.
    placed = [
        (slide.link, str(slide.pin))
        for slide in group.contacts
        if not all(report.is_zero(arm, k) for arm in group.arms(slide.pin, slide.link))
    ]
    return tuple(dict.fromkeys((*solved.get(group.kind, ()), *placed)))


def driver(report: ReportContext, k: int) -> FigureScenes:
    """Draw the driver with its reactions and its balancing load, with arms about the centre of a crank; beside it, the
    force plan.
    """
    polygon = report.driver_polygon
    assert polygon is not None
    return beside_one_another(separated_driver(report, k), plan(force_plan(report, polygon, k)))


def separated_driver(report: ReportContext, k: int) -> Scene:
    """Draw the driver with all forces and torques on it."""
    polygon, centre, body = report.driver_polygon, report.driver.centre, _Bodies(report, k, (DRIVER,))
    assert polygon is not None
    pin = body.at(centre or report.driver.pin)
    closing = (body.reaction(edge.name, pin) for edge in polygon.edges if edge.unknown)
    forces = [*body.loads(), *body.found_before(polygon), *closing]
    if centre:
        torque = 0.0 if report.is_zero("M.eq", k) else float(report.ledger["M.eq"].at(k).real)
        balance = Couple(_of_arc(report.balance_symbol(), torque), pin, torque)
        turning = (balance, *body.couples_found_before(polygon))
        marks = percussion.drawn(report, DRIVER, k, body.scale)
        return body.scene(forces, marks, arms=body.arms(report.crank_arms, centre), turning=turning)
    return body.scene(forces, turning=body.couples_found_before(polygon))


# --- loads


def _of_arc(torque: Symbol, value: float) -> Expression:
    """Return the label at the arc of a torque.  The arc shows the true sense, so the label of a negative torque is its
    size.
    """
    return size(torque) if value < 0 else torque


def _has_force(report: ReportContext, load: Load, k: int) -> bool:
    return load.name in report.ledger and not _is_torque(report, load) and not report.is_zero(load.name, k)


def _is_torque(report: ReportContext, load: Load) -> bool:
    """Return True if a load is a torque, without a force."""
    return any(torque.name == load.name for torque in report.machine.torques)


def _acts_at(report: ReportContext, load: Load, k: int) -> complex:
    """Return the place (m) where a load is drawn: the constructed point Q for an inertia force, else its point of
    action.
    """
    for body in report.couples:
        if load.name == body.force:
            return percussion.percussion(report, body, k).at
    single = complex(as_single_force(load)[k - 1])
    return single if np.isfinite(single) else complex(load.point[k - 1])


def _foot(report: ReportContext, group: GroupView, link: int, k: int) -> Canvas:
    """Draw H on a slotted link whose slot passes beside its pin T: the foot of T on the slot's line, from which the
    block is measured.
    """
    if not (group.offset and link == group.j):
        return Canvas()
    scale, ledger = drawing_scale(report), report.ledger
    pivot, block = (report.place(name, k) * scale for name in (group.T, group.Q))
    along = complex(ledger[ids.slot(link)].at(k))
    at = complex(constructions.foot(pivot, block, along))
    marks = (Line(pivot, at, CONSTRUCTION), Line(at, block, CONSTRUCTION), Circle(at, 0.6, VISIBLE, PAPER))
    return Canvas(marks, (label(at, Symbol("H", str(link)), gap=1.2),))


# --- Zhukovsky's lever


def lever(report: ReportContext, k: int) -> FigureScenes:
    """Draw Zhukovsky's lever: the velocity plan turned by 90° against ω1, with each load at its image and arms about
    the pole.
    """
    ledger, machine, motion, index = report.ledger, report.machine, report.analysis.motion, k - 1
    per = -1j * machine.turn * MM / float(ledger["mu.v"].values[0]) / report.enlarged
    forces, arms = [], []
    for load in report.analysis.loads:
        if not _has_force(report, load, k):
            continue
        at = np.full(motion.driver.shape, _acts_at(report, load, k))
        image = complex(motion.of(load.link, at).v[index]) * per
        vector = report.force_vector(load.name)
        forces.append(Force(vector, image, complex(load.force[index]), "load", load.name))
        if not report.is_zero(ids.lever_arm(load.name), k):
            arms.append(arm_of(report, ids.lever_arm(load.name), k, 0j))
    if machine.span and not report.is_zero("R.cb", k):
        # The force that balances a sliding driver acts on the lever too; that of a crank is a torque.
        image = complex(motion.points[report.driver.pin].v[index]) * per
        vector = vocabulary.vector(report.balance_symbol())
        forces.append(Force(vector, image, true_sense(report, "Rcb", k), "reaction", "Rcb"))
        arms.append(ArmOf(ledger.symbol(report.driver.velocity_segment), 0j, "Rcb"))
    scale = Chain((ledger.symbol("mu.v"), ledger.number("mu.v")))
    drawing = motion_plan(report, "v", k)
    return on_paper(lever_figure(drawing, forces, arms, sense=-machine.turn, notes=(scale,)))
