"""`ReportContext`: the data that all templates (`template_names`), tables and figures of one report share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from reportgen.assignment import Assignment
from reportgen.base.records import Record, replace
from reportgen.base.units import MM
from reportgen.case import MachineAnalysis
from reportgen.catalogue.topic_sections import sections_of
from reportgen.derivation.equation_sides import scheme
from reportgen.derivation.kinematic_entries import links_in_plane_motion
from reportgen.derivation.load_entries import Polygon
from reportgen.document.figure_placement import FigureScenes
from reportgen.document.template_rendering import Prose
from reportgen.drawing.charts import Area
from reportgen.formula import Symbol, ids, vocabulary
from reportgen.formula.ledger import Ledger
from reportgen.machine import DRIVER, GROUND, Crank, Mobility, Triad, mobility
from reportgen.machine.analysis import Analysis, Machine, Position, analyse
from reportgen.machine.cycle_torque import SAME_ANGLE
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.loads import Applied, Piston, Torque
from reportgen.report.body_views import BodyView, PlaneLink, displaced_inertia
from reportgen.report.driver_view import DriverView
from reportgen.report.given_names import given_names
from reportgen.report.link_views import GroupView
from reportgen.report.report_extents import LEFT_OUT, OF_A_TURN, OPENING
from reportgen.report.triad_views import TriadView

PLATES_UP_TO = 24
"""Above this many positions of a turn, plates show the worked positions only, and tables leave out some positions."""
DENSE = 361
"""Number of samples of a turn from which curves are drawn."""


class ReportContext(Record, dict=True):
    """A case together with the data and phrases that its report needs.

    Figures are drawn smaller by the factor `enlarged`, by which a drawing sheet enlarges them with their letters, and
    curves from `samples` of the cycle if there are any.  `used_symbols` are None until the text is written.
    """

    case: MachineAnalysis
    enlarged: float = 1.0
    samples: Analysis | None = None
    used_symbols: frozenset[Symbol] | None = None

    # --- its parts

    @cached_property
    def drawn(self) -> dict[str, FigureScenes]:
        """The figures kept by `drawn_once`."""
        return {}

    @cached_property
    def prose(self) -> Prose:
        return Prose(self.case.places)

    @property
    def words(self) -> Mapping[str, Any]:
        return self.case.words

    @property
    def assignment(self) -> Assignment:
        return self.case.assignment

    @property
    def analysis(self) -> Analysis:
        return self.case.analysis

    @property
    def machine(self) -> Machine:
        return self.analysis.machine

    @property
    def ledger(self) -> Ledger:
        """The quantities with every number as the report prints it."""
        return self.case.printed

    @cached_property
    def groups(self) -> tuple[GroupView | TriadView, ...]:
        """The groups in the order of assembly."""
        plan, polygons = scheme(self.machine.linkage), self.case.polygons
        of, shared = self.machine.linkage.groups, (plan, self.driver, polygons, self.ledger)
        return tuple(TriadView(g, *shared) if isinstance(g, Triad) else GroupView(g, *shared) for g in of)

    @property
    def dyads(self) -> tuple[GroupView, ...]:
        """The groups of class II in the order of assembly."""
        return tuple(group for group in self.groups if isinstance(group, GroupView))

    @property
    def triads(self) -> tuple[TriadView, ...]:
        """The groups of class III in the order of assembly."""
        return tuple(group for group in self.groups if isinstance(group, TriadView))

    @cached_property
    def driver(self) -> DriverView:
        return DriverView(self.machine.linkage, self.ledger)

    @property
    def area(self) -> Area | None:
        """The room for curves on a drawing sheet, where their scales are round and printed; None in the report."""
        return None if self.enlarged == 1.0 else Area(enlarged=self.enlarged, mm=self.ledger.printed_unit("mm"))

    @cached_property
    def dense_cycle(self) -> Analysis:
        """The analysis at closely spaced angles of the cycle; the numbered positions are among them."""
        if self.samples is not None:
            return self.samples
        own = self.machine.cycle_angles
        turns = self.machine.turns
        grid = np.linspace(0.0, turns * FULL_TURN, turns * (DENSE - 1) + 1)
        between = np.abs(grid[:, None] - own).min(axis=1) > SAME_ANGLE
        return analyse(self.machine, np.sort(np.concatenate((grid[between], own))))

    # --- its extent

    def parts(self, *names: str) -> list[str]:
        """Return those of the given sections and parts of sections that a report of this extent contains, in order."""
        return [name for name in names if name not in self._left_out]

    @cached_property
    def _left_out(self) -> frozenset[str]:
        """The sections and parts that a report of this extent leaves out."""
        topics = tuple(sections_of(self.machine.topics))
        extent = self.assignment.report.extent
        left_out = LEFT_OUT[extent]
        if extent == "short":
            left_out = left_out.union(*(section.not_in_short for section in topics))
        left_out = left_out.difference(self.machine.essential)
        return left_out.union(OF_A_TURN, *(section.of_a_turn for section in topics)) if self.instants else left_out

    @property
    def sections(self) -> list[str]:
        """The sections in order."""
        every = tuple(self._outline())
        opening = [name for name in OPENING[self.assignment.report.extent] if name in every]
        return self.parts(*dict.fromkeys([*opening, *every]))

    def _outline(self) -> Iterator[str]:
        """Yield the machine's outline, with the section on instant centres after the velocities if a link has one."""
        for section in self.machine.outline:
            yield section
            if self.plane_links and section == "velocity":
                yield "centres"
        if self.assignment.report.listing:
            yield "listing"

    @property
    def extent_words(self) -> str:
        """Name of the requested extent, for use in a sentence."""
        return str(self.words["extents"][self.assignment.report.extent])

    # --- the assignment in words

    @property
    def machine_title(self) -> str:
        title = self.case.title
        return title[:1].lower() + title[1:] if title[1:2].islower() else title

    @property
    def variant(self) -> str:
        return self.assignment.variant

    @property
    def turn_words(self) -> str:
        """The phrase for the sense of the driver's rotation."""
        return self.sense(self.machine.turn)

    def sense(self, value: float) -> str:
        """Return the phrase for the sense of a rotation (of any unit): anticlockwise if positive, a dash for 0."""
        words = self.words["sense"]
        return str(words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"])

    @property
    def place_and_date(self) -> str:
        return self.case.place_and_date

    # --- positions

    @property
    def instants(self) -> bool:
        """Return True if the positions are single instants."""
        return self.machine.instants

    @property
    def accelerated(self) -> bool:
        """Return True if the driver is accelerated at the positions."""
        return self.machine.acceleration != 0

    @property
    def cyclic(self) -> bool:
        """Return True if the driver runs through the whole cycle at constant speed, so that its means are known."""
        return self.machine.cyclic

    @property
    def weighed(self) -> bool:
        """Return True if weights act, False in a horizontal plane."""
        return self.machine.linkage.gravity != 0

    @property
    def count(self) -> int:
        """Number of positions of one turn."""
        return self.machine.count

    @property
    def cycle_count(self) -> int:
        return self.machine.positions

    @property
    def even_count(self) -> int:
        """Number of evenly spaced positions of one turn."""
        return self.assignment.positions.number

    @property
    def even_cycle_count(self) -> int:
        """Number of evenly spaced positions of the cycle."""
        return int(self.machine.even.sum())

    @property
    def thinned(self) -> int:
        """Tables and drawings show every n-th evenly spaced position and the worked ones: n, or 0 if they show all."""
        step = -(-self.even_count // PLATES_UP_TO)
        return step if step > 1 else 0

    @property
    def positions(self) -> tuple[Position, ...]:
        """The positions of one turn that are shown."""
        return tuple(k for k in self.all_positions if k <= self.machine.count)

    @property
    def all_positions(self) -> tuple[Position, ...]:
        """The positions of the cycle that are shown."""
        evenly = range(1, self.machine.positions + 1, self.thinned or 1)
        return self.machine.numbered(sorted({*evenly, *self.worked, *self.worked_forces}))

    @property
    def load_positions(self) -> tuple[Position, ...]:
        """The positions at which the loads are given: all that are shown, or only the worked ones in a short report."""
        return self.all_positions if self.parts("loads-everywhere") else self.worked_forces

    @property
    def worked(self) -> tuple[Position, ...]:
        """The positions of one turn whose motion is calculated in full."""
        count = self.machine.count
        return self.machine.numbered(dict.fromkeys((k - 1) % count + 1 for k in self.assignment.worked_positions))

    @property
    def worked_forces(self) -> tuple[Position, ...]:
        """The positions of the cycle whose forces are calculated in full."""
        return self.machine.numbered(self.assignment.worked_positions)

    @property
    def plates(self) -> tuple[int, ...]:
        """The positions whose plans are drawn: all, or the worked ones if the report is short or they are many."""
        if self.assignment.positions.number <= PLATES_UP_TO and self.parts("velocity-plates"):
            return tuple(range(1, self.assignment.cycle_positions + 1))
        return self.assignment.worked_positions

    def first_turn(self, k: Position) -> Position | None:
        """Return the position of the first turn that a position of a later turn repeats; None in the first turn."""
        return self.machine.position((k - 1) % self.count + 1) if k > self.count else None

    # --- the machine

    @property
    def own(self) -> Mapping[str, Any]:
        """Values that only the templates of this kind of machine use."""
        return self.machine.facts

    @cached_property
    def sheet(self) -> Mapping[str, list[str]]:
        """Ids of the lines that the calculation prints together, by name: `lines(sheet.velocity, k)`."""
        return {name: self.known(lines) for name, lines in self.ledger.lines.items()}

    @property
    def given_names(self) -> Mapping[str, str]:
        """Descriptions of the given quantities by their ids."""
        return given_names(self.words, self.own, self.ledger.families, self.machine.linkage)

    @property
    def mobility(self) -> Mobility:
        return mobility(self.machine.linkage)

    @property
    def lengths(self) -> list[str]:
        """Ids of the true lengths that have a drawn one, in the kind's order if it has one; then the mass centres."""
        own, places = (self.sheet.get(name, ()) for name in ("lengths", "places"))
        single = [id for id, family in self.ledger.families.items() if len(family.values) == 1]
        drawn = [id for id in single if (found := ids.length.read(id)) and ids.drawn.of(found) in single]
        return [*own, *(id for id in drawn if id in places and id not in own)] if own else drawn

    @property
    def drawn_lines(self) -> list[str]:
        """Names of the lines with those lengths, by their end points."""
        return [found["line"] for id in self.lengths if (found := ids.length.read(id))]

    @property
    def drawn_crank(self) -> float | None:
        """The length of the crank on paper (mm); None if the driver slides."""
        driver = self.machine.linkage.driver
        return driver.length / float(self.ledger["mu.l"].values[0]) * MM if isinstance(driver, Crank) else None

    @property
    def pistons(self) -> tuple[Piston, ...]:
        return self.machine.pistons

    @property
    def turn_sense(self) -> str:
        """The key of the phrase for the sense of the driver's rotation."""
        return "anticlockwise" if self.machine.turn > 0 else "clockwise"

    @property
    def loads(self) -> tuple[Applied | Torque, ...]:
        """The forces and torques applied to the machine."""
        return self.machine.loads

    @property
    def speed_in_rpm(self) -> bool:
        """Return True if the driver's angular velocity follows from its speed in revolutions per minute."""
        return "omega.1" in self.computed

    @property
    def has_gas(self) -> bool:
        """Return True if the pressure in any cylinder differs from the ambient pressure."""
        return any(piston.name not in self.machine.idle for piston in self.pistons)

    @property
    def all_zero(self) -> bool:
        """Return True if masses or loads are given but all of them are zero."""
        given = any(id in ids.weight or id in ids.mass for id in self.ledger.families)
        return not self.has_forces and (bool(self.machine.idle) or given)

    @property
    def loads_crank(self) -> bool:
        """Return True if any group transmits a force to the crank, at any position."""
        edges = self.driver_polygon.edges if self.driver_polygon else ()
        reactions = (self.ledger[ids.of_force(edge.name)] for edge in edges if edge.is_reaction and not edge.unknown)
        return any(one.at(k) != 0 for one in reactions for k in range(1, self.cycle_count + 1))

    @property
    def synthesised(self) -> bool:
        return "synthesis" in self.machine.outline

    @property
    def further(self) -> frozenset[str]:
        """Ids of the loads that the file or a topic adds to those of the kind."""
        return frozenset((*(row.id for row in self.own.get("declared", ())), *self.machine.beside))

    @property
    def has_own_load(self) -> bool:
        """Return True if a force or torque of the kind itself acts, so that others are further ones."""
        return any(load.name not in self.further for load in self.loads)

    @property
    def has_force(self) -> bool:
        """Return True if a working force of the kind itself acts, constant or not."""
        return any(force.name not in self.further for force in self.machine.applied)

    @property
    def has_forces(self) -> bool:
        """Return True if any load acts, weights and inertia included, so that there is a force analysis."""
        return "M.eq" in self.ledger

    @property
    def has_turning_links(self) -> bool:
        """Return True if any link of the groups turns, rather than all being in translation."""
        return any(ids.signed("omega", link) in self.ledger for link in self.machine.linkage.links)

    @property
    def has_formulas(self) -> bool:
        """Return True if closed formulas check the plans, and the report shows them."""
        return bool(self.machine.closed_formulas.compared) and bool(self.parts("formulas-velocity"))

    @cached_property
    def computed(self) -> frozenset[str]:
        """Ids of the quantities that a formula gives."""
        return frozenset(id for id, family in self.ledger.families.items() if family.definition is not None)

    # --- motion

    def place(self, point: str, k: int) -> complex:
        """Return the place of a point at position `k` (m, as x + iy)."""
        return complex(self.ledger[ids.place(point)].at(k))

    def known(self, quantities: Iterable[str]) -> list[str]:
        """Return those of the given ids that the ledger contains, each once."""
        return self.ledger.known(quantities)

    @cached_property
    def plane_links(self) -> tuple[PlaneLink, ...]:
        """The links in plane motion, in assembly order: they neither turn about a fixed point nor only slide."""
        owner = {link: group.name for group in self.groups for link in group.links}
        turns = links_in_plane_motion(scheme(self.machine.linkage))
        return tuple(PlaneLink(turn, owner[turn.link]) for turn in turns)

    @property
    def sliding(self) -> tuple[GroupView, ...]:
        """Groups whose last link slides along a fixed guide."""
        slides = (group for group in self.dyads if group.kind in ("RRP", "RPP"))
        return tuple(group for group in slides if group.guide == ids.joint(GROUND, group.j))

    @property
    def slider_senses(self) -> Mapping[str, complex]:
        """Unit vectors along which the motion of sliders on the frame counts as positive, by the sliders' pins."""
        guides = {group.Q: complex(self.ledger[ids.guide(group.j)].values[0]) for group in self.sliding}
        return {pin: self.machine.positive.get(pin, along) for pin, along in guides.items()}

    # --- forces

    @property
    def bodies(self) -> list[str]:
        """Numbers of the links that have mass."""
        return [str(body.link) for body in self.machine.linkage.inertias]

    @property
    def mass_lines(self) -> list[str]:
        return self.known(name(link) for name in (ids.mass, ids.inertia) for link in self.bodies)

    @property
    def inertia_lines(self) -> list[str]:
        return self.known(name(link) for name in (ids.inertia_force, ids.inertia_couple) for link in self.bodies)

    @cached_property
    def couples(self) -> tuple[BodyView, ...]:
        """The links whose inertia is a force and a couple, replaced by a single force off the mass centre."""
        return displaced_inertia(self.machine.linkage, self.groups, self.ledger)

    @property
    def displaced_reactions(self) -> bool:
        """Return True if the reaction of any slide may act at a distance from its pin."""
        joints = [joint for group in self.dyads for joint in (group.outer, group.inner, group.guide)]
        return any(ids.reaction_couple(joint) in self.computed for joint in joints)

    @property
    def has_slides(self) -> bool:
        return any(group.kind != "RRR" for group in self.dyads)

    @property
    def driver_polygon(self) -> Polygon | None:
        return self.case.polygons[-1] if self.case.polygons else None

    @property
    def on_crank(self) -> frozenset[str]:
        """Names of the forces in the driver's force plan."""
        return frozenset(edge.name for edge in self.driver_polygon.edges) if self.driver_polygon else frozenset()

    @property
    def joined(self) -> list[GroupView | TriadView]:
        """The groups that are joined to the driver."""
        return [group for group in self.groups if DRIVER in group.carriers]

    def arms_about(self, point: str) -> list[str]:
        """Return the ids of the arms of forces about a point."""
        return [id for id, family in self.ledger.families.items() if family.arm and family.about == point]

    @property
    def crank_arms(self) -> list[str]:
        """Ids of the arms of the forces on the driver about its centre."""
        return self.arms_about(self.driver.centre)

    @property
    def crank_pins(self) -> list[str]:
        """Names of the crank's pin and of further points of the crank to which groups are joined."""
        hung = {pin for group in self.groups for _, pin in group.hung}
        return [self.driver.pin, *(place.name for place in self.driver.others if place.name in hung)]

    @property
    def has_reduced_inertia(self) -> bool:
        """Return True if moving links have mass, so that the ledger has the reduced moment of inertia."""
        return "J.r" in self.ledger

    # --- quantities and points by name

    def force_symbol(self, name: str) -> Symbol:
        """Return the symbol of a force of a plan: a load, or a reaction such as R12 or its component R12.t."""
        return self.ledger.symbol(self.ledger[ids.force_vector(name)].of)

    def force_vector(self, name: str) -> Symbol:
        """Return the symbol of a force of a plan with an arrow."""
        return vocabulary.vector(self.force_symbol(name))

    def balance_symbol(self) -> Symbol:
        """Return M_cb or P_cb, without the index of the method that gives it."""
        return replace(self.ledger.symbol("M.eq"), sup="")

    def named(self, symbol: Symbol) -> Symbol:
        """Return a symbol that does not belong to a quantity, with its indices in the report's language."""
        return vocabulary.in_language(symbol, self.words["symbols"])

    def is_zero(self, id: str, k: int | None = None) -> bool:
        """Return True if a quantity, as printed, is zero at position `k`, or at all if it is constant."""
        return bool(self.ledger.number(id, k).value == 0)
