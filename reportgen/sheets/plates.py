"""What drawing sheets show: the report's own figures, to its own scales, with the numbers that it prints.

A figure is drawn small and then enlarged with its letters, so that these are as high as a drawing's are, and its lines
as long as the report says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal

from reportgen.base.units import Language
from reportgen.case import Case, MachineAnalysis
from reportgen.derivation.loads import Polygon
from reportgen.derivation.motion import What
from reportgen.document import Inline, InlineMath, Inlines, Table, Text, Value, plain
from reportgen.document.unspaced import set_out
from reportgen.drawing import Content, Scene
from reportgen.drawing.geometry import unit
from reportgen.drawing.plan import Plan, plan
from reportgen.drawing.plates import DrawingPlate
from reportgen.drawing.scales import FigureSize
from reportgen.drawing.sheet import ENLARGED, grid, lettered, widths
from reportgen.formula import Chain, Number, ids
from reportgen.formula.plain import formula, quantity
from reportgen.report import balancing, curves, running_curves
from reportgen.report import joint_friction as friction
from reportgen.report.chapters import spring_lines
from reportgen.report.figures import centre_state, centres, indicator, positions_scene, scheme
from reportgen.report.force_figures import lever, separated, separated_driver
from reportgen.report.groups import GroupView
from reportgen.report.plans import (
    SHARES,
    ForcePlans,
    MotionFigures,
    PlanSeries,
    force_plan,
    motion_plan,
    one_turn,
    positions_mirrored,
)
from reportgen.report.report import Report
from reportgen.report.result_tables import (
    acceleration_segments,
    accelerations,
    balance,
    gas,
    inertia,
    reactions,
    velocities,
    velocity_segments,
)

Set = Literal["kinematics", "forces", "balancing"]
WIDEST, MOST_ROWS = 180.0, 24
"""A table is so wide (mm) and has so many positions at most; then another stands beside it."""
LARGER_FORCES = (2.0, 3.0)
"""How many times larger than in the report the force plans of all positions may be drawn."""
SEGMENT = 2
"""Decimals of lengths on paper, mm."""
ONE_LINE = 1e-6
"""Directions that differ by no more (radians) are one."""


@dataclass(frozen=True)
class Sources:
    """What plates are drawn from: a report, and the same one whose figures are drawn small, to be enlarged.

    Of `every` plan there is a plate, those of velocities and accelerations to the scales of the worked ones.
    """

    report: Report
    small: Report
    every: bool = False

    @classmethod
    def of(cls, case: MachineAnalysis, every: bool = False) -> Sources:
        return cls(Report(case), Report(case, enlarged=ENLARGED), every)

    @property
    def words(self) -> Mapping[str, Any]:
        words: Mapping[str, Any] = self.report.words["plates"]
        return words

    def called(self, group: GroupView) -> str:
        """Group (2,3)."""
        return str(self.report.words["figure"]["group"]).format(i=group.i, j=group.j)

    def place(self, k: int, of: str = "") -> str:
        """Position 2, or of a part: Group (2,3), position 2."""
        word = f"{self.report.words['table']['position']} {self.report.machine.position(k)}"
        language = self.report.assignment.language
        line = Text(f"{of}, {word[0].lower()}{word[1:]}" if of else word)
        return plain(set_out((line,), language), language)


@dataclass(frozen=True, slots=True)
class Drawn:
    """The scenes of a plate, drawn small: its name among the words, its layer, and as in `DrawingPlate`."""

    name: str
    layer: str
    scenes: Sequence[Scene]
    lines: tuple[Content, ...] = ()
    family: str = ""
    larger: Callable[[], Drawn] | None = None
    """The same at the next larger standard scale, if it may be drawn at one."""


Draw = Callable[[Sources], Iterator[Drawn]]


def plates_of(sources: Sources, chosen: Set) -> Iterator[DrawingPlate]:
    """The plates of a set in the order of the work."""
    for draw in SETS[chosen]:
        for drawn in draw(sources) if sources.every or draw not in FURTHER else ():
            if drawn.scenes:
                yield _plate(sources, drawn, spare=draw in RESULTS and not sources.every)


def _plate(sources: Sources, drawn: Drawn, spare: bool) -> DrawingPlate:
    title, further = sources.words[drawn.name], sources.words["continued"]
    scenes, larger = tuple(map(lettered, drawn.scenes)), drawn.larger
    return DrawingPlate(
        title,
        drawn.lines,
        drawn.layer,
        scenes,
        family=drawn.family,
        spare=spare,
        further=further,
        larger=None if larger is None else lambda: _plate(sources, larger(), spare),
    )


# --- motion


def _scheme(sources: Sources) -> Iterator[Drawn]:
    """The scheme with the dimensions, true and as drawn."""
    yield Drawn("scheme", "scheme", (*scheme(sources.small).scenes, *_dimensions(sources.report)))


def _dimensions(report: Report) -> Iterator[Scene]:
    ledger, words = report.ledger, report.words["plates"]
    rows = [
        [ledger.symbol(id), _bare(report, id, None), _unit(report, id), _bare(report, ids.drawn(line), None)]
        for id, line in ((ids.length(line), line) for line in report.drawn_lines)
    ]
    if rows:
        yield grid([words["dimension-heads"]], rows)


def _positions(sources: Sources) -> Iterator[Drawn]:
    yield Drawn("positions", "positions", (positions_scene(sources.small),))


def _velocities(sources: Sources) -> Iterator[Drawn]:
    yield from _motion_plans(sources, "v", "velocity")


def _accelerations(sources: Sources) -> Iterator[Drawn]:
    yield from _motion_plans(sources, "a", "acceleration")


def _motion_plans(sources: Sources, what: What, name: str) -> Iterator[Drawn]:
    """The worked plans, then those of one turn as large as there is room, or all to the scale of the worked ones."""
    report, label = sources.report, sources.report.machine.position
    for k in report.worked:
        drawing = motion_plan(sources.small, what, k)
        if drawing.drawn():
            yield Drawn(name, name, (plan(drawing),), (sources.place(k),), name)
    if report.parts("velocity-plates"):
        series, mirrored = MotionFigures(what).series(report), positions_mirrored(report, what)
        share = 1.0 if sources.every else series.fitted()[0]
        told: tuple[Content, ...] = ()
        if sources.every:
            series = replace(series, positions=one_turn(report))
        elif mirrored.at:
            pairs = ", ".join(f"{label(at)} ({label(of)})" for at, of in zip(mirrored.at, mirrored.of, strict=True))
            told = (str(sources.words["mirrored"]).format(pairs=pairs),)
        yield _drawn_series(sources, series, share, Drawn(f"{name}-plates", name, (), told, name))


def _drawn_series(sources: Sources, series: PlanSeries, usual: float, of: Drawn, share: float = 0.0) -> Drawn:
    """Plans of one scale, a `usual` share as large as the worked ones or up to as large; they say the report's, too."""
    share = share or usual
    after = min((one for one in SHARES if one > share), default=None)
    (symbol, shown), (_, in_report) = series.note(share).parts, series.note(usual).parts
    assert isinstance(shown, Number)
    assert isinstance(in_report, Number)
    larger = on_sheet(sources.report.case, 1).told(symbol, shown, in_report)
    return replace(
        of,
        scenes=tuple(replace(series, report=sources.small).scenes(share)),
        lines=(*of.lines, series.note(share) if share == usual else larger),
        larger=None if after is None else lambda: _drawn_series(sources, series, usual, of, after),
    )


def _centres(sources: Sources) -> Iterator[Drawn]:
    report = sources.report
    for k in report.worked if report.parts("centres") else ():
        if any(centre_state(report, link, k) == "found" for link in report.plane_links):
            yield Drawn("centres", "velocity", centres(sources.small, k).scenes, (sources.place(k),))


# --- forces


def _indicator(sources: Sources) -> Iterator[Drawn]:
    """The diagram of one cylinder, from which its forces are read."""
    if sources.report.has_gas and len(sources.report.pistons) == 1:
        yield Drawn("indicator", "indicator", indicator(sources.small).scenes)


def _indicator_of_several(sources: Sources) -> Iterator[Drawn]:
    """That of several cylinders, which stands with their positions: their links alone fill the sheet of forces."""
    if sources.report.has_gas and len(sources.report.pistons) > 1:
        yield Drawn("indicator", "indicator", indicator(sources.small).scenes)


def _springs(sources: Sources) -> Iterator[Drawn]:
    """The machine with its springs, their loads over the cycle, and their lengths at the positions."""
    if sources.report.machine.coils:
        over_cycle = curves.springs(sources.small).scenes if sources.report.parts("spring-curves") else ()
        lengths = _grids(sources.report, (spring_lines,), cycle=True)
        yield Drawn("springs", "scheme", (*scheme(sources.small).scenes, *over_cycle, *lengths))


def _worked_forces(sources: Sources) -> Iterator[Drawn]:
    """Of each group, as they are solved, its separated links and its force plan; the same of the driver; the lever."""
    report, small = sources.report, sources.small
    for k in report.worked_forces:
        for group in reversed(report.groups):
            if group.polygon is not None:
                place, family = sources.place(k, sources.called(group)), f"{group}, {k}"
                yield Drawn("bodies", "forces", separated(small, k, group), (place,), family)
                yield from _force_plan(sources, group.polygon, k, place, family)
        if report.driver_polygon is not None:
            place, family = sources.place(k, report.words["figure"]["driver"]), f"{k}"
            yield Drawn("bodies", "forces", (separated_driver(small, k),), (place,), family)
            yield from _force_plan(sources, report.driver_polygon, k, place, family)
        yield Drawn("lever", "forces", lever(small, k).scenes, (sources.place(k),))


def _force_plan(sources: Sources, polygon: Polygon, k: int, place: str, family: str) -> Iterator[Drawn]:
    """A force plan, unless all its forces are on one line."""
    drawing = force_plan(sources.small, polygon, k)
    if not _on_one_line(drawing):
        yield Drawn("forces", "forces", (plan(drawing),), (place,), family)


def _on_one_line(drawing: Plan) -> bool:
    ways = [unit(vector.end - vector.start) for vector in drawing.drawn()]
    return all(abs((way * ways[0].conjugate()).imag) < ONE_LINE for way in ways)


def _friction(sources: Sources) -> Iterator[Drawn]:
    """At the worked positions the machine with its friction circles, and each of them enlarged."""
    report, small = sources.report, sources.small
    if not friction.rubbing(report):
        return
    for k in report.worked_forces:
        scenes = (friction.scheme_scene(small, k), *friction.joints(small, k).scenes)
        yield Drawn("friction", "forces", scenes, (sources.place(k),))


def _friction_plans(sources: Sources) -> Iterator[Drawn]:
    """The force plans with friction of the worked positions."""
    report, small = sources.report, sources.small
    for k in report.worked_forces if friction.rubbing(report) else ():
        polygons = [(sources.called(group), group.polygon) for group in reversed(report.groups)]
        for called, polygon in (*polygons, (str(report.words["figure"]["driver"]), report.driver_polygon)):
            if polygon is not None:
                scene = plan(friction.force_plan_with_friction(small, polygon, k))
                yield Drawn("friction-plan", "forces", (scene,), (sources.place(k, called),))


def _force_plates(sources: Sources) -> Iterator[Drawn]:
    """The force plans of each group at all positions, as the report has them."""
    for group in reversed(sources.report.groups if sources.report.parts("force-plates") else ()):
        if group.polygon is not None:
            yield _drawn_forces(sources, ForcePlans(sources.small, group.polygon), sources.called(group))


def _drawn_forces(sources: Sources, plans: ForcePlans, called: str, times: float = 1.0) -> Drawn:
    """Force plans, each with its scale, so many times as large as in the report or as there is room for."""
    after = next((one for one in LARGER_FORCES if one > times), None)
    return Drawn(
        "force-plates",
        "forces",
        tuple(plans.scenes(times)),
        (called,),
        larger=None if after is None else lambda: _drawn_forces(sources, plans, called, after),
    )


# --- curves and tables


def _motion(sources: Sources) -> Iterator[Drawn]:
    if sources.report.parts("diagrams"):
        yield Drawn("motion", "curves", curves.motion(sources.small).scenes)


def _torque(sources: Sources) -> Iterator[Drawn]:
    if sources.report.parts("torque-curve"):
        yield Drawn("torque", "curves", curves.torque(sources.small).scenes)


def _polar(sources: Sources) -> Iterator[Drawn]:
    report = sources.report
    if report.loads_crank and report.driver.centre and report.parts("polar"):
        yield Drawn("polar", "curves", curves.polar(sources.small).scenes)


def _flywheel(sources: Sources) -> Iterator[Drawn]:
    small = sources.small
    if small.flywheel is not None:
        yield Drawn("flywheel-torque", "curves", curves.flywheel_torque(small).scenes)
        yield Drawn("flywheel-work", "curves", curves.flywheel_work(small).scenes)
        if small.has_reduced_inertia:
            yield Drawn("wittenbauer", "curves", curves.wittenbauer(small).scenes)


def _flywheel_speed(sources: Sources) -> Iterator[Drawn]:
    report = sources.report
    if report.flywheel is not None and report.needs_flywheel and report.parts("flywheel-speed"):
        yield Drawn("flywheel-speed", "curves", curves.flywheel_speed(sources.small).scenes)


def _balancing(sources: Sources) -> Iterator[Drawn]:
    """The hodographs of the force on the frame, and what the crank sees of it."""
    small = sources.small
    if small.case.balanced is None:
        return
    yield Drawn("hodograph", "curves", balancing.hodograph(small).scenes)
    if small.case.balanced.products:
        yield Drawn("seen", "curves", balancing.seen_curve(small).scenes)
    if small.case.balanced.weights:
        yield Drawn("counterweights", "scheme", balancing.discs(small).scenes)
    if small.case.balanced.products and small.case.balanced.weights:
        yield Drawn("balanced", "curves", balancing.balanced_hodograph(small).scenes)


def _balancing_table(sources: Sources) -> Iterator[Drawn]:
    if sources.report.case.balanced is not None:
        yield from _table(sources, "balancing", (balancing.shaking_lines, balancing.balanced_table), cycle=True)


def _true_motion(sources: Sources) -> Iterator[Drawn]:
    if sources.report.case.true_motion is not None:
        yield Drawn("run", "curves", tuple(running_curves.sheet(sources.small)))
        if sources.report.case.true_motion.drive.governs:
            yield Drawn("run-characteristic", "curves", running_curves.characteristic(sources.small).scenes)


def _velocity_table(sources: Sources) -> Iterator[Drawn]:
    yield from _table(sources, "velocities", (velocity_segments, velocities))


def _acceleration_table(sources: Sources) -> Iterator[Drawn]:
    yield from _table(sources, "accelerations", (acceleration_segments, accelerations))


def _reaction_table(sources: Sources) -> Iterator[Drawn]:
    yield from _table(sources, "reactions", (reactions, balance), cycle=True)


def _load_table(sources: Sources) -> Iterator[Drawn]:
    yield from _table(sources, "loads", (gas, applied, inertia), cycle=True)


def applied(report: Report) -> list[str]:
    """The loads other than of gas."""
    return report.known(load.name for load in report.loads)


Listed = Callable[[Report], Sequence[str]]


def _table(sources: Sources, name: str, listed: Sequence[Listed], cycle: bool = False) -> Iterator[Drawn]:
    yield Drawn(name, "tables", _grids(sources.report, listed, cycle))


def _grids(report: Report, listed: Sequence[Listed], cycle: bool = False) -> list[Scene]:
    """Quantities at the positions of one turn or of the cycle, as many tables as they need."""
    at = report.all_positions if cycle else report.positions
    tabulated = dict.fromkeys(id for columns in listed for id in columns(report))
    shown = [id for id in tabulated if not all(report.is_zero(id, k) for k in at)]
    parts = -(-len(at) // MOST_ROWS)
    rows = [at[len(at) * n // parts : len(at) * (n + 1) // parts] for n in range(parts)]
    head, every = _quantities(report, shown, at)
    first, *across = widths([*head, *every])
    columns: list[list[str]] = []
    right = math.inf
    for id, width in zip(shown, across, strict=True):
        right += ENLARGED * width
        if right > WIDEST:
            columns.append([])
            right = ENLARGED * (first + width)
        columns[-1].append(id)
    return [grid(*_quantities(report, some, at)) for some in columns for at in rows]


def _quantities(
    report: Report, quantities: Sequence[str], positions: Sequence[int]
) -> tuple[list[list[Content]], list[list[Content]]]:
    """The head of a table of quantities and its rows."""
    head: list[list[Content]] = [
        [report.words["table"]["position"], *(report.ledger.symbol(id) for id in quantities)],
        ["", *(_unit(report, id) for id in quantities)],
    ]
    return head, [[str(report.machine.position(k)), *(_bare(report, id, k) for id in quantities)] for k in positions]


def on_sheet(case: Case, steps: int) -> FigureSize:
    """How large a sheet shows a figure of a report, by so many standard scales larger."""
    return FigureSize(steps, ENLARGED, case.words["plates"]["report"], case.assignment.language)


def drawn(table: Table, language: Language) -> Scene:
    """A table of a report as a sheet shows it."""
    rows = [[_content(cell.inlines, language) for cell in row] for row in (*table.head, *table.rows)]
    return lettered(grid(rows[: len(table.head)], rows[len(table.head) :]))


def _content(inlines: Inlines, language: Language) -> Content:
    """What stands in a cell, as a label has it."""
    match inlines:
        case (InlineMath(expression),):
            return expression
        case (Value(number),):
            return number
        case (InlineMath(expression), Text(" = "), InlineMath(of) | Value(of)):
            return Chain((expression, of))
        case _:
            return "".join(map(partial(_plain, language=language), inlines))


def _plain(inline: Inline, language: Language) -> str:
    match inline:
        case InlineMath(expression):
            return formula(expression, language)
        case Value(number):
            return quantity(number, language)
        case _:
            return str(getattr(inline, "text", ""))


def _unit(report: Report, id: str) -> str:
    unit = report.ledger[id].how.unit
    return str(report.ledger.units.get(unit, unit))


def _bare(report: Report, id: str, k: int | None) -> Content:
    """A number without its unit, a dash for what does not exist."""
    family, number = report.ledger[id], report.ledger.number(id, k)
    if family.kind == "segment" and number.value:
        return Number(number.value, SEGMENT)
    if math.isnan(number.value) or (family.is_of_vector and report.is_zero(family.of, k)):
        return "–"
    return Number(number.value, number.decimals)


SETS: Mapping[Set, tuple[Draw, ...]] = {
    "kinematics": (
        *(_scheme, _positions, _indicator_of_several, _velocities, _centres, _accelerations, _motion),
        *(_velocity_table, _acceleration_table),
    ),
    "forces": (
        *(
            _indicator,
            _springs,
            _worked_forces,
            _friction,
            _friction_plans,
            _force_plates,
            _torque,
            _polar,
            _flywheel,
            _flywheel_speed,
        ),
        _true_motion,
        *(_reaction_table, _load_table),
    ),
    "balancing": (_balancing, _balancing_table),
}
"""What each set shows, in the order of the work."""
FURTHER = frozenset({_centres, _friction_plans, _force_plates, _polar, _flywheel_speed})
"""What is shown only where every plate is asked for."""
RESULTS = frozenset({_velocity_table, _acceleration_table, _reaction_table, _load_table})
"""Tables that else fill what is left of a sheet."""
