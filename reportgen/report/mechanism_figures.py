"""Figures of the mechanism: scheme, groups, positions, the gas beside the cylinder, the Coriolis acceleration, instant
centres.

A figure is a function of a report and of what it draws; `named_figures` gives its name in templates.  `drawing_scale`
and `looks` are the scale and the style of all drawings of the mechanism.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial, wraps

import numpy as np

from reportgen.base.records import replace
from reportgen.base.units import MM
from reportgen.derivation.equation_sides import Side
from reportgen.derivation.kinematic_entries import NEAREST, centre_symbol
from reportgen.document.figure_placement import A3_ACROSS, A3_UPRIGHT, FigureScenes, close, fits, in_text, on_paper
from reportgen.document.layout import in_rows
from reportgen.drawing import Scene
from reportgen.drawing import indicator as indicator_figure
from reportgen.drawing import scheme as scheme_figure
from reportgen.drawing.canvas import Canvas
from reportgen.drawing.force_drawings import Sliding, link_and_plan
from reportgen.drawing.force_drawings import coriolis as coriolis_figure
from reportgen.drawing.force_drawings import inclination as inclination_figure
from reportgen.drawing.position_plan import (
    DrawnCentre,
    PlaneMotion,
    PositionPlan,
    SwingMarks,
    centre_plan,
    position_plan,
    swing_marks,
)
from reportgen.drawing.scheme import Looks
from reportgen.formula import Chain, Number, Symbol, ids, vocabulary
from reportgen.formula.constructions import circle_circle
from reportgen.machine import DRIVER, Crank
from reportgen.machine.analysis import Machine, motion_at
from reportgen.machine.cycle_torque import SAME_ANGLE
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.loads import Piston
from reportgen.report.body_views import PlaneLink
from reportgen.report.context import DENSE, ReportContext
from reportgen.report.link_views import GroupView

SCHEME_BOX = (120.0, 75.0)
"""Width and height (mm) in which a scheme must fit."""
HALF_PAGE = 100.0
"""The height (mm) up to which a figure leaves about half a page for the text."""
REDUCTIONS = tuple(1.0 / step for step in (1, 2, 2.5, 4, 5, 6, 10, 20, 25, 40, 50, 100, 1000))
SMALLER = (1.0, 2.0, 2.5, 4.0, 5.0)
"""Factors by which a plan may be reduced from the scales of the text."""
LEGIBLE = 0.4
"""Smallest size of drawn groups, as a share of the scheme's size; smaller ones would be hard to read."""
SHOWN_AT = 1
"""The index of the position at which schemes are drawn: the first one after the start."""


def drawn_once(draw: Callable[[ReportContext], FigureScenes]) -> Callable[[ReportContext], FigureScenes]:
    """Draw a figure of the report alone once: the text asks for its size and its place before it is shown."""

    @wraps(draw)
    def drawn(report: ReportContext) -> FigureScenes:
        if draw.__name__ not in report.drawn:
            report.drawn[draw.__name__] = draw(report)
        return report.drawn[draw.__name__]

    return drawn


def drawing_scale(report: ReportContext) -> float:
    """Return the mm of paper per metre for drawings at the scale μ_l."""
    return MM / float(report.ledger["mu.l"].values[0]) / report.enlarged


def scale_note(report: ReportContext, id: str, factor: float = 1.0, k: int | None = None) -> Chain:
    """Return a scale as printed below a figure; a figure reduced by `factor` < 1 has a scale that is larger by
    1/`factor`.
    """
    number = report.ledger.number(id, k)
    return Chain((report.ledger.symbol(id), short(replace(number, value=number.printed / factor))))


def looks(report: ReportContext, scale: float, factor: float = 1.0) -> Looks:
    """Return the style of a drawing: pistons with their bore, mass centres, its scale note, springs.

    `scale` is in mm of paper per metre; `factor` is the enlargement relative to μ_l.
    """
    blocks = {
        piston.link: (min(0.6 * piston.bore * scale, 24.0), min(piston.bore * scale, 40.0) * 0.5)
        for piston in report.machine.pistons
    }
    jointed = {name for group in report.groups for name in group.pins}
    centres = tuple(body.centre for body in report.machine.linkage.inertias if body.centre not in jointed)
    return Looks(blocks, centres, scale_note(report, "mu.l", factor), report.machine.coils)


def short(number: Number) -> Number:
    """Return a number rounded to six significant digits and printed without trailing zeros."""
    return replace(number, value=float(f"{number.value:.6g}"), decimals=None)


def line_styles(report: ReportContext) -> FigureScenes:
    """Draw the legend of line styles, with forces, paths and instant centres only if the report has any."""
    drawn = {"path": bool(report.machine.paths), "normal": "centres" in report.sections, "reaction": report.has_forces}
    words = {name: text for name, text in report.words["line_styles"].items() if drawn.get(name, True)}
    return FigureScenes((scheme_figure.line_styles(words),))


# --- the machine at one position and over a turn


def scheme(report: ReportContext) -> FigureScenes:
    """Draw the kinematic scheme at the reduction that fits its box."""
    return FigureScenes((scheme_scene(report, reduction(report)),))


def scheme_scene(report: ReportContext, factor: float) -> Scene:
    """Return the kinematic scheme, enlarged by `factor` relative to μ_l."""
    scale = drawing_scale(report) * factor
    look = looks(report, scale, factor)
    return scheme_figure.scheme(report.machine.linkage, report.analysis.motion, shown_at(report), scale, look)


def groups(report: ReportContext) -> FigureScenes:
    """Draw the driver and each group separately, as large as the scheme, or smaller if they then fit in one row."""
    own = reduction(report)
    drawn = (_groups(report, factor) for factor in REDUCTIONS if own >= factor >= own * LEGIBLE)
    first = next(drawn)
    return FigureScenes(next((row for row in (first, *drawn) if len(in_rows(row)) == 1), first))


def _groups(report: ReportContext, factor: float) -> tuple[Scene, ...]:
    scale, words = drawing_scale(report) * factor, report.words["figure"]
    titles = (words["driver"], *(group.title(words) for group in report.groups))
    look = replace(looks(report, scale, factor), scale=None)
    return scheme_figure.groups(report.machine.linkage, report.analysis.motion, shown_at(report), scale, look, titles)


def shown_at(report: ReportContext) -> int:
    """Return the index of the position that schemes show: the second, or the first if there is only one."""
    return min(SHOWN_AT, report.count - 1)


def reduction(report: ReportContext) -> float:
    """Return the factor 1, 1/2, 1/2.5, … at which the mechanism at μ_l fits the box of a scheme."""
    index, motion = shown_at(report), report.analysis.motion
    hung = [place[index] for coil in report.machine.coils for place in coil.at(motion)]
    points = np.array([*(report.place(name, index + 1) for name in motion.points), *hung])
    size = points[np.isfinite(points)] * drawing_scale(report) * report.enlarged
    needed = max(np.ptp(size.real) / SCHEME_BOX[0], np.ptp(size.imag) / SCHEME_BOX[1], 1.0)
    return next(factor for factor in REDUCTIONS if 1 / factor >= needed)


@drawn_once
def positions(report: ReportContext) -> FigureScenes:
    """Draw the position plan of one turn."""
    return as_large_as_asked(report, partial(positions_scene, report))


def as_large_as_asked(report: ReportContext, draw: Callable[[float], Scene]) -> FigureScenes:
    """Draw at the scale μ_l if the report needs the true size; else at the first reduction that fits half a page.

    If no reduction fits the text, the drawing is turned and made as large as the page allows.  If labels are crowded,
    the next larger size is used.
    """
    if report.parts("true-size"):
        return on_paper(draw(1.0))
    drawn: list[FigureScenes] = []
    for smaller in SMALLER:
        scene = close(draw(1 / smaller))
        drawn.append(replace(on_paper(scene), smaller=smaller))
        if in_text(scene) and scene.height <= HALF_PAGE:
            break
    else:
        turned = next((n for n, one in enumerate(drawn, 1) if one.turned), len(drawn))
        del drawn[turned:]
    return next((shown for shown in reversed(drawn) if not shown.scenes[0].crowded), drawn[-1])


def plan_in_text(report: ReportContext) -> bool:
    """Return True if the position plan is in the text, False if it has a separate page."""
    return positions(report).paper is None


def positions_scene(report: ReportContext, factor: float = 1.0, beside: Canvas | None = None) -> Scene:
    """Return the numbered positions of one turn, enlarged by `factor`; paths are drawn unless the plan is `beside`
    another drawing.
    """
    machine = report.machine
    shows = PositionPlan(
        _numbered(report),
        machine.paths if beside is None else (),
        report.positions.index(report.worked[0]),
        labels=tuple(map(str, report.positions)),
        enlarged=report.enlarged,
    )
    one_turn = _motion(machine, machine.cycle_angles[[k - 1 for k in report.positions]])
    return _position_plan(report, one_turn, shows, beside, factor)


def extremes(report: ReportContext) -> FigureScenes:
    """Draw the mechanism where its first slider reverses (I and II: its stroke begins and ends), as large as the
    scheme.
    """
    course = report.machine.sliders[0]
    motion = motion_at(report.machine, course.dead_centres[:2] - course.phase)
    shows = PositionPlan(_numbered(report), report.machine.paths, labels=("I", "II"))
    factor = reduction(report)
    return replace(on_paper(_position_plan(report, motion, shows, factor=factor)), smaller=1 / factor)


def swing(report: ReportContext) -> FigureScenes:
    """Draw both extreme positions of the first group's rocker or slider, with the arcs that construct them."""
    machine, ledger = report.machine, report.ledger
    linkage, first = machine.linkage, machine.linkage.dyads[0]
    assert isinstance(linkage.driver, Crank)
    centre = linkage.ground[linkage.driver.centre]
    pivot = linkage.ground[first.end] if isinstance(first.end, str) else None
    if pivot is None:
        ends = machine.sliders[0].top, machine.sliders[0].bottom
    else:
        crank, (coupler, rocker) = linkage.driver.length, first.lengths
        ends = (
            complex(circle_circle(centre, coupler + crank, pivot, rocker, first.sign)),
            complex(circle_circle(centre, coupler - crank, pivot, rocker, first.sign)),
        )
    # Folded over the coupler the crank points away from the end.
    angles = np.angle([ends[0] - centre, centre - ends[1]])
    circle = None
    angles_between = [ledger.symbol("theta")]
    if pivot is None:
        circle = _above_guide(report, centre, ends), Symbol("ρ")
    else:
        angles_between.append(ledger.symbol("swing"))
    if pivot is not None and "rho" in ledger:
        bisector = sum((end - pivot) / abs(end - pivot) for end in ends)
        at = pivot + float(ledger["l.DO"].values[0]) * bisector / abs(bisector)
        circle = at, Symbol("ρ")
    marks = SwingMarks(centre, pivot, ends, tuple(angles_between), circle)
    scale = drawing_scale(report)
    points = tuple(point for point in linkage.points if point.link in (DRIVER, *first.links))
    four_bar = replace(linkage, groups=(first,), points=points)
    motion = solve_motion(four_bar, angles, machine.turn * machine.speed)
    dense = _motion(machine, np.linspace(0.0, FULL_TURN, DENSE))
    shows = PositionPlan((linkage.driver.pin, first.middle), (first.middle,), labels=("1", "2"))
    notes = looks(report, scale).notes
    return on_paper(position_plan(four_bar, motion, dense, scale, shows, notes, beside=swing_marks(marks, scale)))


def _above_guide(report: ReportContext, centre: complex, ends: tuple[complex, complex]) -> complex:
    """Return the centre of the circle (m) from which a slider's stroke is seen under θ, on the side of the crank."""
    middle, along = (ends[0] + ends[1]) / 2, (ends[0] - ends[1]) / abs(ends[0] - ends[1])
    ρ, θ = (float(report.ledger[id].values[0]) for id in ("rho", "theta"))
    side = np.sign(((centre - middle) / along).imag)
    return complex(middle + 1j * side * ρ * np.cos(θ) * along)


def _position_plan(
    report: ReportContext, motion: Motion, shows: PositionPlan, beside: Canvas | None = None, factor: float = 1.0
) -> Scene:
    dense = _motion(report.machine, np.linspace(0.0, FULL_TURN, DENSE))
    scale = drawing_scale(report) * factor
    notes = looks(report, scale).notes if factor == 1.0 else ()
    return position_plan(report.machine.linkage, motion, dense, scale, shows, notes, beside=beside)


def _motion(machine: Machine, cycle_angle: np.ndarray) -> Motion:
    return solve_motion(machine.linkage, machine.angles(cycle_angle), machine.turn * machine.speed)


def _numbered(report: ReportContext) -> tuple[str, ...]:
    """Return the points that carry the positions' numbers: pins of the crank, joints, and the end of a slotted
    lever.
    """
    centres = {body.centre for body in report.machine.linkage.inertias}
    names = [*report.crank_pins]
    for group in report.groups:
        if isinstance(group, GroupView) and group.kind == "RPR":
            names += [place.name for place in group.points_j if place.name not in centres]
        else:
            names += [group.Q] if isinstance(group, GroupView) else group.found_joints
    return tuple(names)


# --- the gas


@drawn_once
def indicator(report: ReportContext) -> FigureScenes:
    """Draw the indicator diagram in line with the first piston's stroke, with the readings of every piston."""
    return as_large_as_asked(report, partial(_indicator, report))


def _indicator(report: ReportContext, factor: float) -> Scene:
    machine, gases, printed_unit = report.machine, report.analysis.gas, report.ledger.printed_unit
    first = machine.pistons[0]
    unit, scale = 1e4, drawing_scale(report) * factor
    top, bottom = first.top * scale, first.bottom * scale
    read = [float(pressure) for gas in gases.values() for pressure in gas.pressure]
    read += [float(pressure) for row in first.indicator.rows for pressure in row]
    lowest, highest = min(read) / unit, max(read) / unit
    # Values below zero are drawn between diagram and cylinder, where there is half the room.
    highest = max(highest, -2 * lowest)
    side = _free_side(machine)
    start, end, mu = indicator_figure.beside(top, bottom, side, highest, report.enlarged)
    note = Chain((Symbol("μ", "p"), short(Number(mu, 6, printed_unit("N/(cm²·mm)")))))
    frame = indicator_figure.ChartFrame(
        start, end, side, mu * report.enlarged, Chain((Symbol("p"),), printed_unit("N/cm²")), note
    )
    share_at = first.share_at(partial(motion_at, machine))
    lines = first.indicator.branches(share_at, first.dead_centres)
    branches = [
        indicator_figure.Branch(name, x, tuple(p / unit for p in pressures))
        for name, (x, pressures) in zip(report.words["strokes"], lines, strict=True)
    ]
    readings = [
        indicator_figure.Reading(
            Symbol(str(k), "" if len(machine.pistons) == 1 else f"({gas.piston.link})"),
            float(gas.fraction[k - 1]),
            float(gas.pressure[k - 1]) / unit,
            top + (bottom - top) * float(gas.fraction[k - 1]) if _in_line(first, gas.piston) else None,
        )
        for gas in gases.values()
        for k in report.all_positions
    ]

    def drawn(groups: Sequence[indicator_figure.ReadingGroup]) -> Scene:
        return positions_scene(report, factor, indicator_figure.indicator(frame, branches, readings, groups))

    return indicator_figure.all_numbered(drawn, frame, readings)


def _free_side(machine: Machine) -> complex:
    """Return the direction (a unit vector) of the first cylinder's side that is free for its diagram: away from other
    cylinders, else to its right.
    """
    first = machine.pistons[0]
    right = 1j * first.inward
    sides = [((one.top + one.bottom) / 2 - first.bottom) / right for one in machine.pistons]
    return right if sum(side.real for side in sides) <= SAME_ANGLE else -right


def _in_line(first: Piston, piston: Piston) -> bool:
    """Return True if a piston moves on the line of the `first` one, from which its positions are projected."""
    return abs(((piston.top - first.top) / first.inward).imag) + abs((piston.inward / first.inward).imag) < SAME_ANGLE


# --- Coriolis acceleration


def coriolis(report: ReportContext, k: int, group: GroupView, side: Side) -> FigureScenes:
    """Draw the relative velocity in a turning guide and that velocity turned by 90° in the sense of the guide's ω."""
    ledger, points = report.ledger, report.analysis.motion.points
    omega = float(ledger[ids.signed("omega", side.turning)].at(k).real)
    relative = complex(points[side.point].v[k - 1]) - complex(points[side.base].v[k - 1])
    sliding = Sliding(
        vocabulary.point(side.point),
        (Symbol("v", side.pair, over="vector"), relative),
        (report.named(Symbol("a", side.pair, "k", "vector")), 1j * omega * relative),
        (ledger.symbol(side.omega), float(np.sign(omega))),
    )
    return FigureScenes((coriolis_figure(sliding),))


def inclination(report: ReportContext) -> FigureScenes:
    """Draw the angle between an acceleration and the line to the centre."""
    return FigureScenes((inclination_figure(),))


def two_equations(report: ReportContext) -> FigureScenes:
    """Draw a link and the velocities of its points, for the theory."""
    return FigureScenes(link_and_plan("v"))


def similarity(report: ReportContext) -> FigureScenes:
    """Draw a link and the accelerations of its points, for the theory."""
    return FigureScenes(link_and_plan("a"))


# --- instant centres of velocity ------------------------------------------------------------------
# How they lie at a position, and the mechanism drawn with them.


def centre_state(report: ReportContext, link: PlaneLink, k: int) -> str:
    """Return the location of a link's instant centre: "found", "shift" (the link does not turn), "rest" (at its base),
    "near" its base, or "far".
    """
    ledger = report.ledger
    if ledger[link.omega].at(k) == 0:
        return "shift"
    if ledger[ids.velocity(link.base)].at(k) == 0:
        return "rest"
    if np.isfinite([ledger[id].at(k) for id in link.distances]).all():
        return "found"
    base = complex(ledger[ids.place(link.base)].at(k))
    to_base = abs(complex(ledger[ids.centre(link.link)].at(k)) - base) / float(ledger["mu.l"].values[0])
    return "near" if to_base < NEAREST else "far"


def _place(report: ReportContext, link: PlaneLink, k: int) -> complex:
    return complex(report.ledger[ids.centre(link.link)].at(k)) * drawing_scale(report)


def centres(report: ReportContext, k: int) -> FigureScenes:
    """Draw the mechanism at a position at the scale μ_l: normals that meet in the instant centres, velocities and their
    angles.

    As many centres share a sheet as there is room for.
    """
    linkage, scale, motion = report.machine.linkage, drawing_scale(report), report.analysis.motion
    angles = [_plane_motion(report, link, k) for link in report.plane_links]

    def scene(links: Sequence[PlaneLink], first: bool) -> Scene:
        marks = [DrawnCentre(centre_symbol(one.link), _place(report, one, k), (one.base, one.point)) for one in links]
        own = angles if first else ()
        return centre_plan(linkage, motion, k - 1, scale, centres=marks, looks=looks(report, scale), moving=own)

    sheets: list[list[PlaneLink]] = [[]]
    for link in (link for link in report.plane_links if centre_state(report, link, k) == "found"):
        for index, links in enumerate(sheets):
            if not links or _has_a_sheet(scene([*links, link], index == 0)):
                links.append(link)
                break
        else:
            sheets.append([link])
    return on_paper(*(scene(links, index == 0) for index, links in enumerate(sheets)))


def _has_a_sheet(scene: Scene) -> bool:
    return any(fits(scene.width, scene.height, paper) for paper in (A3_ACROSS, A3_UPRIGHT))


def _plane_motion(report: ReportContext, link: PlaneLink, k: int) -> PlaneMotion:
    """Return the velocities of a link's two points and their angles with the line between the points."""
    ledger, points = report.ledger, report.analysis.motion.points
    ends = (link.base, link.point)
    moving = [not report.is_zero(ids.velocity(name), k) for name in ends]
    return PlaneMotion(
        ends,
        tuple(complex(points[name].v[k - 1]) if there else 0j for name, there in zip(ends, moving, strict=True)),
        tuple(Symbol("v", name, over="vector") for name in ends),
        tuple(ledger.symbol(id) for id in link.angles),
    )
