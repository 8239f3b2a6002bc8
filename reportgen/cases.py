"""Open the case of an assignment (`open_case`): a machine's, unless its kind defines another one.

A kind's module defines either `machine`, which makes a `Machine` of an assignment, or `case`, which makes a `Case`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.assignment.common import Drawing
from reportgen.base.records import replace
from reportgen.base.template_folders import REFERENCE
from reportgen.base.topics import topics
from reportgen.base.translation_coverage import is_topic_whole
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.base.yaml_source import read_text
from reportgen.case import AskedFor, Case, DriverMotion, MachineAnalysis, Misconceptions
from reportgen.case.answer_key import Span
from reportgen.case.missing_chapters import MissingChapter, heading_of
from reportgen.case.quantity_wording import positive_sense
from reportgen.case.shafts import Shaft
from reportgen.catalogue.optional_chapters import lacking
from reportgen.catalogue.topic_sections import section_of
from reportgen.derivation.topic_ledger import LEDGER
from reportgen.document import Block, Document, Paragraph, Strong, Text
from reportgen.formula import Symbol, ids, vocabulary
from reportgen.formula.calculation import Family
from reportgen.machine.analysis import Analysis, Machine, motion_at
from reportgen.machine.load_laws import FULL_TURN, STEPS

if TYPE_CHECKING:
    from reportgen.drawing.animation import Animation
    from reportgen.drawing.plates import DrawingPlate
    from reportgen.report.context import ReportContext


GENERAL, HEIGHT = "vasntωεφαl", "y"
"""Letters without an index that denote any point, link, length or angle, or count links; and that of a diagram."""


def opened(assignment: Assignment) -> Case:
    """Return the case of an assignment; that of a coursework if it has parts."""
    case: Case = getattr(catalogue.module(assignment.kind), "case", MachineCase)(assignment)
    if not assignment.parts:
        return case
    # Coursework loads the template renderer, which most commands for a single part do not need.
    from reportgen.coursework.case import Coursework

    return Coursework.of(case, [opened(part.within(assignment)) for part in assignment.parts])


def open_case(path: Path | str, language: Language | None = None, whole: Path | None = None) -> Case:
    """Return the case of an assignment file, in its own language or in `language`.

    For a part, `whole` is the file from which it takes data. Raises `AssignmentError` with all faults of the file,
    located.
    """
    return opened(catalogue.load(path, language, whole))


def starter_case(kind: str, language: Language = REFERENCE) -> Case:
    """Return the case of the starter file of a kind.  Raises `AssignmentError`, and `KeyError` for an unknown kind."""
    assignment, faults = catalogue.assess(read_text(catalogue.starter(kind, language)), Path())
    if assignment is None:
        raise as_error(faults, language)
    return opened(assignment)


def opener() -> Callable[..., Case]:
    """Return a function like `open_case` for repeated opening; unchanged parts are not computed again."""
    from reportgen.coursework.case import Coursework

    earlier: Case | None = None

    def reopened(path: Path | str, language: Language | None = None, whole: Path | None = None) -> Case:
        nonlocal earlier
        case = open_case(path, language, whole)
        if whole:
            return case
        earlier = case.after(earlier) if isinstance(case, Coursework) else case
        return earlier

    return reopened


@dataclass(frozen=True)
class MachineCase(MachineAnalysis):
    """The case of a machine: its analysis, ledger, document, plates and animation."""

    @cached_property
    def families(self) -> Mapping[str, Family]:
        from reportgen.derivation import enter_plans

        return enter_plans(self.analysis, (), self.analysis.machine.closed_formulas.write)[0].families

    @property
    def used(self) -> frozenset[Symbol]:
        """The symbols of its numbers, of its points with images and coordinates, and of the corners of its plans."""
        from reportgen.derivation.kinematic_entries import POLES

        names, bodies = list(self.analysis.motion.points), self.analysis.machine.linkage.inertias
        images = {vocabulary.on_plan(name, prime) for name in names for prime in (False, True)}
        # Views load the template renderer, which most commands do not need.
        from reportgen.report.topic_views import VIEWS

        further = "".join(hooks.letters for hooks in VIEWS.among(self.analysis.machine.topics))
        corners = {corner for polygon in self.polygons for edge in polygon.edges for corner in (edge.start, edge.end)}
        return frozenset(
            {family.symbol for family in self.printed.families.values()}
            | {vocabulary.point(name) for name in names}
            | {Symbol(name, label) for name in names for label in self.assignment.labels}
            | {Symbol("K", str(one.link)) for one in bodies if ids.percussion(one.centre, one.link) in self.ledger}
            | images
            | {Symbol(axis, name) for axis in "xys" for name in names}
            | {
                Symbol(letter)
                for letter in (*corners, *POLES.values(), *GENERAL, *(HEIGHT if self.analysis.gas else ""), *further)
            }
        )

    @property
    def span(self) -> Span:
        machine, report = self.analysis.machine, self._report
        labels = tuple(str(machine.position(k)) for k in range(1, machine.positions + 1))
        printed = report.all_positions if report.thinned else ()
        return Span(labels, machine.count, tuple(self.assignment.worked_positions), printed)

    def sense(self, id: str) -> str:
        return positive_sense(id, self.ledger, self.words, self._slide_directions)

    @property
    def _report(self) -> ReportContext:
        """The case as its templates see it."""
        # It loads the template renderer, which most commands do not need.
        from reportgen.report.context import ReportContext

        return ReportContext(self)

    @cached_property
    def _slide_directions(self) -> Mapping[str, str]:
        """The positive directions of the motion of its sliders, in words, by their points."""
        from reportgen.report.template_equations import heading_words

        report = self._report
        senses = report.slider_senses.items()
        return {point: heading_words(report, float(np.degrees(np.angle(sense)))) for point, sense in senses}

    @property
    def speed(self) -> float:
        """The driver's speed (rad/s), or that of a slide (m/s)."""
        return self.analysis.machine.speed

    @property
    def driver_motion(self) -> DriverMotion:
        """The driver's motion; sliders on the frame have signed velocities and accelerations, as in the curves."""

        machine, points = self.analysis.machine, self.analysis.motion.points
        signed = {
            name(pin): (np.real(np.conj(direction) * getattr(points[pin], rate)), direction)
            for pin, direction in self._report.slider_senses.items()
            for rate, name in ids.POINT_RATE.items()
        }
        slides = bool(machine.span)
        gone = machine.cycle_angles * (machine.cycle_travel / (machine.turns * FULL_TURN) if slides else 1.0)
        called = self.words["figure"]["way" if slides else "cycle_angle"]
        # A speed given separately for each position determines no time.
        speed = None if machine.acceleration else abs(machine.speed)
        return DriverMotion(gone, machine.cycle_travel, called, speed, slides=slides, signed=signed)

    @property
    def balance(self) -> np.ndarray | None:
        """The balancing torque (N·m) [N], or the force (N) of a slide; None without loads."""
        return np.real(self.analysis.torque) if self.analysis.loads else None

    @property
    def misconceptions(self) -> Misconceptions:
        analysis = self.analysis
        return Misconceptions(
            frozenset(load.name for load in analysis.applied),
            tuple(load.name for load in analysis.loads),
            _wrong_readings(analysis),
            _whole_rods(analysis.machine, tuple(self.ledger.families)),
            changed={
                id: definition
                for hooks in LEDGER.among(analysis.machine.topics)
                for id, definition in hooks.mistakes(self.ledger, analysis.machine).items()
            },
        )

    def fault(self) -> str:
        try:
            machine = self.analysis.machine
            if not (machine.instants or _turns(machine)):
                return "not-turning"
            return "" if _finite(self.analysis) else "not-finite-results"
        except np.linalg.LinAlgError:
            return "not-finite-results"

    def document(self) -> Document:
        from reportgen.report.composing import compose

        return self.bounded(compose)

    @property
    def missing_chapters(self) -> Sequence[MissingChapter]:
        machine, language = self.analysis.machine, self.assignment.language
        listing = () if self.assignment.report.listing else (("listing", ((("report", "listing"),),)),)
        rows = dict([*lacking(machine, self.assignment.parameters), *listing])
        untold = {topic: section_of(topic).chapter for topic in topics() if not is_topic_whole(language, topic)}
        return [
            MissingChapter(heading_of(section, self.places), rows[section])
            for section in self._report.parts(*rows)
            if section not in untold.values()
        ]

    def question(self, asked: AskedFor) -> tuple[Sequence[Block], Sequence[Block]]:
        from reportgen.report.template_names import names

        report = self._report
        prose = report.prose
        known = names(report) | {
            "answer_tables": asked.answers,
            "asks_scales": asked.scales,
            "sheet_apart": asked.by_section,
            "self_check": asked.self_check,
            "asked": asked.positions,
            "known_tables": asked.known,
        }
        title, *given = prose.render("given", known)
        kind = Paragraph((Strong((Text(self.title),)),), "center")
        return (title, kind), (*given, *prose.render("task", known))

    def animations(self) -> tuple[Animation, ...]:
        from reportgen.page.motion_samples import animation

        return (animation(self),)

    @property
    def shafts(self) -> Sequence[Shaft]:
        """The driver's shaft, if it turns."""
        if self.analysis.machine.span:
            return ()
        turn = self.assignment.positions.sign
        return (Shaft(self.words["coursework"]["driver"], abs(self.speed), turn, fixed=True, datum="n"),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        from reportgen.sheets import plates_by_set

        return plates_by_set(self, sets, every)

    @property
    def redrawn(self) -> tuple[float, Callable[[float], Case]] | None:
        """The length (mm) of the drawn crank, and a function that returns the case with another one."""
        crank = self._report.drawn_crank
        return (crank, self._with_crank) if crank else None

    def _with_crank(self, length: float) -> Case:
        drawing = Drawing.model_validate({"crank": f"{length:g} mm"})
        return MachineCase(replace(self.assignment, drawing=drawing))


def _turns(machine: Machine) -> bool:
    """Return True if the mechanism assembles over the full turn (or stroke, for a sliding driver)."""
    return bool(motion_at(machine, np.linspace(0.0, 2 * np.pi, STEPS, endpoint=bool(machine.span))).reachable.all())


def _finite(analysis: Analysis) -> bool:
    """Return True if motion, reactions and both torques are finite at every position."""
    motion = analysis.motion
    arrays = [part for link in motion.links.values() for part in (link.angle, link.omega, link.epsilon)]
    if analysis.loads:
        arrays += [analysis.torque, analysis.torque_by_work]
        arrays += [np.abs(reaction.force) for reaction in analysis.forces.reactions.values()]
    return bool(motion.reachable.all()) and all(bool(np.isfinite(array).all()) for array in arrays)


def _wrong_readings(analysis: Analysis) -> Mapping[str, list[tuple[str, np.ndarray]]]:
    """Return wrong pressure readings: of another piston, or of another stroke at the piston's own place."""
    readings: dict[str, list[tuple[str, np.ndarray]]] = {}
    for here in analysis.gas.values():
        piston = here.piston
        others = [("other-piston", state.pressure) for state in analysis.gas.values() if state is not here]
        strokes = (here.angle + 2 * np.pi, -here.angle, 2 * np.pi - here.angle)
        table = piston.law.table
        readings[ids.pressure(piston.link)] = others + [
            ("wrong-stroke", table.pressure(angle, here.fraction, piston.dead_centres)) for angle in strokes
        ]
    return readings


def _whole_rods(machine: Machine, entered: tuple[str, ...]) -> Mapping[str, str]:
    """Return the length of the rod on which `l.AS2` places a mass centre; it precedes that id in `entered`."""
    centres = {body.centre for body in machine.linkage.inertias}
    rods: dict[str, str] = {}
    ends = [(end, dyad.middle) for dyad in machine.linkage.dyads for end in (dyad.start, dyad.end)]
    ends += [(leg.outer, leg.inner) for triad in machine.linkage.triads for leg in triad.legs]
    for end, middle in ends:
        names = {ids.length(end, middle), ids.length(middle, end)}
        for id in (ids.length(end, centre) for centre in centres):
            rod = next((name for name in takewhile(id.__ne__, entered) if name in names), "")
            if id in entered and rod:
                rods.setdefault(id, rod)
    return rods
