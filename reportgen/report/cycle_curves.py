"""Figures of quantities over the cycle: motion, balancing torque, and the load of each crank pin as a polar diagram.

`axis`, `over_a_turn` and `over_the_cycle` are shared with the topics.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import takewhile

import numpy as np

from reportgen.base.records import replace
from reportgen.base.units import MM
from reportgen.derivation.equation_sides import scheme
from reportgen.document.figure_placement import FigureScenes
from reportgen.document.template_rendering import subscripted
from reportgen.drawing import Diagram, PlottedCurve, Scene, charts
from reportgen.formula import Chain, Symbol, ids
from reportgen.formula.vocabulary import KINDS
from reportgen.machine import DRIVER, GROUND, Crank
from reportgen.machine.cycle_torque import SAME_ANGLE
from reportgen.machine.load_laws import FULL_TURN
from reportgen.report.context import ReportContext
from reportgen.report.table_remarks import sliders
from reportgen.report.template_equations import heading_words

# --- axes


def axis(report: ReportContext, symbol: Symbol, kind: str) -> Chain:
    """Return the label of an axis: the symbol that the text uses, with the unit of the quantity kind in parentheses."""
    return Chain((symbol,), report.ledger.printed_unit(KINDS[kind].unit))


def axis_of(report: ReportContext, id: str) -> Chain:
    """Return the axis label of a quantity of the ledger."""
    return axis(report, report.ledger.symbol(id), report.ledger[id].kind)


def driver_axis(report: ReportContext, angle: str = "cycle_angle") -> Chain:
    """Return the axis label of the driver's motion: its angle, or the travel of a sliding driver."""
    words, slides = report.words["figure"], bool(report.machine.span)
    return Chain((Symbol("s"),), words["way"]) if slides else Chain((Symbol("φ"),), words[angle])


# --- motion over a turn


ShownCurve = tuple[Symbol, np.ndarray]
"""A curve: its symbol and its values [N] in the unit of its axis."""


def motion(report: ReportContext) -> FigureScenes:
    """Draw displacement, velocity and acceleration of the sliders, and ω and ε of the turning links, over one turn."""
    charted = curves_of_motion(report)
    return FigureScenes(
        tuple(over_a_turn(report, curves, title, half=len(charted) > 1).scene for curves, title in charted)
    )


def curves_of_motion(report: ReportContext) -> list[tuple[list[ShownCurve], Chain]]:
    """Return the curves of each chart of the motion, with the label of its axis; charts without a curve are
    left out.
    """
    moved = report.dense_cycle.motion
    along = report.slider_senses
    spins = scheme(report.machine.linkage).spins
    turning = [link for link, spin in spins.items() if link == spin > DRIVER]

    def of_points(base: str) -> list[ShownCurve]:
        vectors = {name: getattr(moved.points[name], base) for name in along}
        return [(Symbol(base, name), np.real(np.conj(u) * vectors[name])) for name, u in along.items()]

    def of_links(base: str, quantity: str) -> list[ShownCurve]:
        return [(Symbol(base, str(link)), getattr(moved.links[link], quantity)) for link in turning]

    directions = headings(report, along.values())
    positive = directions[0] if len(directions) == 1 else ""
    rotation = report.sense(1)
    drawings = (
        (_displacements(report), axis(report, Symbol("s"), "segment")),
        (of_points("v"), _positive(report, axis(report, Symbol("v"), "velocity"), positive)),
        (of_points("a"), _positive(report, axis(report, Symbol("a"), "acceleration"), positive)),
        (of_links("ω", "omega"), _positive(report, axis(report, Symbol("ω"), "angular velocity"), rotation)),
        (of_links("ε", "epsilon"), _positive(report, axis(report, Symbol("ε"), "angular acceleration"), rotation)),
    )
    return [(curves, title) for curves, title in drawings if curves]


def headings(report: ReportContext, vectors: Iterable[complex]) -> list[str]:
    """Return the directions of vectors (x + iy, of any length and unit) in words, each once."""
    return list(dict.fromkeys(heading_words(report, math.degrees(cmath.phase(vector))) for vector in vectors))


def _positive(report: ReportContext, title: Chain, sense: str) -> Chain:
    """Return an axis label with the sense in which its quantity is positive, or unchanged if `sense` is ""."""
    note = str(report.words["figure"]["positive"]).format(title=title.note, sense=sense)
    return replace(title, note=note) if sense else title


def _displacements(report: ReportContext) -> list[ShownCurve]:
    """Return the distance (mm) [N] of each slider from its first dead centre, or from the far end of its guide if it
    has none.
    """
    courses = {course.link: course for course in report.machine.sliders}
    moved, curves = report.dense_cycle.motion, []
    for slider in sliders(report):
        place = moved.slides[GROUND, slider.link].s
        course = courses.get(slider.link)
        travel = place.max() - place if course is None else course.fraction(moved) * course.stroke
        curves.append((Symbol("s", str(slider.link)), MM * travel))
    return curves


def _marks(report: ReportContext) -> tuple[int, ...]:
    """Return the indices of the samples of the dense cycle at which numbered positions are marked."""
    angles = report.machine.cycle_angles[[k - 1 for k in report.all_positions]]
    places = np.searchsorted(report.dense_cycle.cycle_angle, angles)
    return tuple(map(int, places))


def _across(report: ReportContext) -> np.ndarray:
    """Return the abscissae of the samples [N]: the angle turned (°), or the travel of a sliding driver (mm)."""
    angle, span = report.dense_cycle.cycle_angle, report.machine.span
    return angle * (span * MM / FULL_TURN) if span else np.degrees(angle)


def over_a_turn(
    report: ReportContext, curves: Sequence[ShownCurve], title: Chain, half: bool = False
) -> charts.Plotted:
    """Plot curves over one turn of the driver, with marks at the numbered positions."""
    count = int(np.searchsorted(report.dense_cycle.cycle_angle, FULL_TURN + SAME_ANGLE))
    slides = bool(report.machine.span)
    x, marks = _across(report)[:count], _marks(report)[: len(report.positions)]
    series = tuple(PlottedCurve(shown, x, values[:count], marks) for shown, values in curves)
    diagram = Diagram(series, driver_axis(report, "angle"), title, turn=not slides)
    return charts.plotted(diagram, half=half, area=report.area)


def over_the_cycle(
    report: ReportContext, curves: Sequence[ShownCurve], title: Chain, half: bool = False
) -> charts.Plotted:
    """Plot curves over the whole cycle, with marks at the numbered positions."""
    series = tuple(PlottedCurve(shown, _across(report), values, _marks(report)) for shown, values in curves)
    diagram = Diagram(series, driver_axis(report), title, turn=not report.machine.span)
    return charts.plotted(diagram, half=half, area=report.area)


# --- torque and forces over the cycle


def torque(report: ReportContext) -> FigureScenes:
    """Draw the balancing torque over the crank angle, or the balancing force over the travel of a slider."""
    return FigureScenes((torque_chart(report).scene,))


def torque_chart(report: ReportContext, half: bool = False) -> charts.Plotted:
    """Plot the balancing torque or force over the cycle, with its mean."""
    ledger, slides = report.ledger, bool(report.machine.span)
    curve = PlottedCurve(report.balance_symbol(), _across(report), report.dense_cycle.torque, _marks(report))
    levels = ((ledger.number("M.mean").value, ledger.symbol("M.mean")),) if report.cyclic else ()
    driver = report.machine.linkage.driver
    sense = report.sense(1) if isinstance(driver, Crank) else headings(report, [cmath.exp(1j * driver.guide.angle)])[0]
    title = _positive(report, axis_of(report, "M.eq"), sense)
    across = driver_axis(report)
    height = charts.HEIGHT if report.parts("high-curves") else charts.LOW
    diagram = Diagram((curve,), across, title, turn=not slides, levels=levels)
    return charts.plotted(diagram, half=half, height=height, area=report.area)


def polar(report: ReportContext) -> FigureScenes:
    """Draw the load of each crank pin in axes that turn with the crank, with the crank's radius upwards.

    If several links share a pin, each of their reactions has its own diagram, and so has their resultant.
    """
    fine, names = report.dense_cycle, report.words["figure"]
    numbers = tuple(map(str, report.all_positions))
    assert report.driver_polygon is not None
    loads: dict[str, dict[str, np.ndarray]] = {}
    for edge in report.driver_polygon.edges:
        if edge.unknown or not edge.is_reaction:
            continue
        hung = (end for group in report.groups for end in group.hung)
        pin = next(pin for link, pin in hung if edge.name == ids.reaction_force(ids.joint(link, DRIVER)))
        radius = fine.motion.points[pin].p - fine.motion.points[report.driver.centre].p
        load = fine.forces.reactions[edge.name].force * np.conj(radius / np.abs(radius)) * 1j
        loads.setdefault(pin, {})[subscripted(edge.name)] = load
    diagrams: list[Callable[..., Scene]] = []
    for name, parts in loads.items():
        drawn = dict(parts)
        if len(parts) > 1:
            drawn[" + ".join(parts)] = np.sum(list(parts.values()), axis=0)
        along = names["along_crank"].format(arm=subscripted(f"{report.driver.centre}{name}"))
        for forces, load in drawn.items():
            series = PlottedCurve("", load.real, load.imag, _marks(report), numbers)
            title = f"{names['pin']} {subscripted(name)}: {forces}"
            diagram = Diagram((series,), names["across_crank"], along, turn=False, equal=True, title=title)
            diagrams.append(partial(charts.polar, diagram, area=report.area))
    if len(diagrams) == 1 or report.area is not None:
        return FigureScenes(tuple(draw() for draw in diagrams))
    for size in charts.POLAR_PAIRS:
        scenes = (draw(size=size) for draw in diagrams)
        narrow = tuple(takewhile(lambda scene: scene.width <= charts.HALF_WIDTH, scenes))
        if len(narrow) == len(diagrams):
            return FigureScenes(narrow)
    return FigureScenes(tuple(draw() for draw in diagrams))
