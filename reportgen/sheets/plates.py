"""Draw the plates of a machine's drawing sheets: the report's figures, at its scales, with its printed numbers.

A figure is drawn small and then enlarged with its letters. So the letters have the height usual on a drawing, and the
lines have the length that the report prints.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.case import Case
from reportgen.derivation.kinematic_entries import What
from reportgen.derivation.load_entries import Polygon
from reportgen.document import Inline, InlineMath, Inlines, Table, Text, Value
from reportgen.drawing import Content, Scene
from reportgen.drawing.drawing_sheet import ENLARGED, grid, lettered
from reportgen.drawing.figure_scale import FigureSize
from reportgen.drawing.geometry import unit
from reportgen.drawing.plates import DrawingPlate
from reportgen.drawing.vector_plan import Plan, plan
from reportgen.formula import Chain, Number, ids
from reportgen.formula.plain_text import formula, quantity
from reportgen.report import cycle_curves
from reportgen.report.context import ReportContext
from reportgen.report.force_figures import lever, separated, separated_driver
from reportgen.report.mechanism_figures import centre_state, centres, indicator, positions_scene, scheme
from reportgen.report.plan_figures import (
    SHARES,
    ForcePlans,
    MotionFigures,
    PlanSeries,
    force_plan,
    motion_plan,
    one_turn,
    positions_mirrored,
)
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
from reportgen.sheets.plate_sources import Drawn, Sources, bare, table_of, unit_of
from reportgen.sheets.topic_plates import PLATES, DrawPlates, PlateHooks

LARGER_FORCES = (2.0, 3.0)
"""Factors by which the force plans of all positions may be larger than in the report."""
ONE_LINE = 1e-6
"""Angle (rad) below which two directions count as one."""


def plates_of(sources: Sources, chosen: str) -> Iterator[DrawingPlate]:
    """Yield the plates of a set in the order of the work."""
    topics = tuple(PLATES.among(sources.report.machine.topics))
    further = FURTHER.union(*(hooks.further for hooks in topics))
    for draw in _set(sources, chosen, topics):
        for drawn in draw(sources) if sources.every or draw not in further else ():
            if drawn.scenes:
                yield _plate(sources, drawn, spare=draw in RESULTS and not sources.every)


def _set(sources: Sources, chosen: str, topics: Sequence[PlateHooks]) -> Iterator[DrawPlates]:
    """Yield the functions that draw the plates of a set; topics add theirs to the set of forces."""
    if chosen == KINEMATICS:
        yield from OF_MOTION
    elif chosen == FORCES:
        yield _indicator
        yield from (draw for hooks in topics for draw in hooks.before_bodies)
        yield _worked_forces
        yield from (draw for hooks in topics for draw in hooks.after_bodies)
        yield from (_force_plates, _torque, _polar)
        yield from (draw for hooks in topics for draw in hooks.curves)
        yield from (_reaction_table, _load_table)
    elif (own := PLATES.of(chosen)) is not None:
        yield from own.own_set


def sets_of(sources: Sources) -> tuple[str, ...]:
    """Return the names of the sets that a machine has: of its motion, of its forces, those of topics."""
    of_topics = (name for name in sources.report.machine.topics if (own := PLATES.of(name)) and own.own_set)
    return KINEMATICS, *((FORCES,) if sources.report.has_forces else ()), *of_topics


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
    """Yield the scheme with its dimensions: true sizes and drawn ones."""
    yield Drawn("scheme", "scheme", (*scheme(sources.small).scenes, *_dimensions(sources.report)))


def _dimensions(report: ReportContext) -> Iterator[Scene]:
    ledger, words = report.ledger, report.words["plates"]
    rows = [
        [ledger.symbol(id), bare(report, id, None), unit_of(report, id), bare(report, ids.drawn(line), None)]
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
    """Yield the worked plans, then those of one turn.

    The latter are as large as fits, or, with `every`, at the scale of the worked plans.
    """
    report, label = sources.report, sources.report.machine.position
    for k in report.worked:
        drawing = motion_plan(sources.small, what, k)
        if drawing.drawn():
            yield Drawn(name, name, (plan(drawing),), (sources.place(k),), name)
    if report.parts("velocity-plates"):
        series, mirrored = MotionFigures(what).series(report), positions_mirrored(report, what)
        share = 1.0 if sources.every else series.fitted()[0]
        notes: tuple[Content, ...] = ()
        if sources.every:
            series = replace(series, positions=one_turn(report))
        elif mirrored.at:
            pairs = ", ".join(f"{label(at)} ({label(of)})" for at, of in zip(mirrored.at, mirrored.of, strict=True))
            notes = (str(sources.words["mirrored"]).format(pairs=pairs),)
        yield _drawn_series(sources, series, share, Drawn(f"{name}-plates", name, (), notes, name))


def _drawn_series(sources: Sources, series: PlanSeries, usual: float, of: Drawn, share: float = 0.0) -> Drawn:
    """Return plans drawn at a `share` of the size of the worked ones, by default the `usual` share.

    Plans at another share also note the scale of the report.
    """
    share = share or usual
    after = min((one for one in SHARES if one > share), default=None)
    (symbol, number), (_, in_report) = series.note(share).parts, series.note(usual).parts
    assert isinstance(number, Number)
    assert isinstance(in_report, Number)
    larger = on_sheet(sources.report.case, 1).compared(symbol, number, in_report)
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
    """Yield the indicator diagram of one cylinder, from which its forces are read."""
    if sources.report.has_gas and len(sources.report.pistons) == 1:
        yield Drawn("indicator", "indicator", indicator(sources.small).scenes)


def _indicator_of_several(sources: Sources) -> Iterator[Drawn]:
    """Yield the indicator diagram of several cylinders, together with their positions: their links fill the force
    sheet.
    """
    if sources.report.has_gas and len(sources.report.pistons) > 1:
        yield Drawn("indicator", "indicator", indicator(sources.small).scenes)


def _worked_forces(sources: Sources) -> Iterator[Drawn]:
    """Yield, in the order of solution, each group's separated links and force plan; those of the driver; the lever."""
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
    """Yield a force plan unless all its forces are on one line."""
    drawing = force_plan(sources.small, polygon, k)
    if not _on_one_line(drawing):
        yield Drawn("forces", "forces", (plan(drawing),), (place,), family)


def _on_one_line(drawing: Plan) -> bool:
    directions = [unit(vector.end - vector.start) for vector in drawing.drawn()]
    return all(abs((direction * directions[0].conjugate()).imag) < ONE_LINE for direction in directions)


def _force_plates(sources: Sources) -> Iterator[Drawn]:
    """Yield the force plans of each group at all positions, as in the report."""
    for group in reversed(sources.report.groups if sources.report.parts("force-plates") else ()):
        if group.polygon is not None:
            yield _drawn_forces(sources, ForcePlans(sources.small, group.polygon), sources.called(group))


def _drawn_forces(sources: Sources, plans: ForcePlans, called: str, times: float = 1.0) -> Drawn:
    """Return force plans with their scales, `times` as large as in the report, or as large as fits."""
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
        yield Drawn("motion", "curves", cycle_curves.motion(sources.small).scenes)


def _torque(sources: Sources) -> Iterator[Drawn]:
    if sources.report.parts("torque-curve"):
        yield Drawn("torque", "curves", cycle_curves.torque(sources.small).scenes)


def _polar(sources: Sources) -> Iterator[Drawn]:
    report = sources.report
    if report.loads_crank and report.driver.centre and report.parts("polar"):
        yield Drawn("polar", "curves", cycle_curves.polar(sources.small).scenes)


def _velocity_table(sources: Sources) -> Iterator[Drawn]:
    yield from table_of(sources, "velocities", (velocity_segments, velocities))


def _acceleration_table(sources: Sources) -> Iterator[Drawn]:
    yield from table_of(sources, "accelerations", (acceleration_segments, accelerations))


def _reaction_table(sources: Sources) -> Iterator[Drawn]:
    yield from table_of(sources, "reactions", (reactions, balance), cycle=True)


def _load_table(sources: Sources) -> Iterator[Drawn]:
    yield from table_of(sources, "loads", (gas, applied, inertia), cycle=True)


def applied(report: ReportContext) -> list[str]:
    """Return the names of the loads other than gas forces."""
    return report.known(load.name for load in report.loads)


def on_sheet(case: Case, steps: int) -> FigureSize:
    """Return the size of a figure of a report on a sheet, larger by a number of standard scales."""
    return FigureSize(steps, ENLARGED, case.words["plates"]["report"], case.assignment.language)


def drawn(table: Table, language: Language) -> Scene:
    """Return a table of a report as a scene."""
    rows = [[_content(cell.inlines, language) for cell in row] for row in (*table.head, *table.rows)]
    return lettered(grid(rows[: len(table.head)], rows[len(table.head) :]))


def _content(inlines: Inlines, language: Language) -> Content:
    """Return the content of a cell as a label."""
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


KINEMATICS, FORCES = "kinematics", "forces"
OF_MOTION: tuple[DrawPlates, ...] = (
    *(_scheme, _positions, _indicator_of_several, _velocities, _centres, _accelerations, _motion),
    *(_velocity_table, _acceleration_table),
)
"""Plates of the set of motion, in the order of the work."""
FURTHER = frozenset({_centres, _force_plates, _polar})
"""Plates that appear only if every plate is requested."""
RESULTS = frozenset({_velocity_table, _acceleration_table, _reaction_table, _load_table})
"""Tables that only fill the remaining room of a sheet, unless every plate is requested."""
