"""Drawings of a turning-moment diagram: the torques with the areas between them, and the energy of the flywheel."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import replace
from reportgen.drawing import Content, Diagram, Item, Label, PlottedCurve, Polyline, Scene, style
from reportgen.drawing.charts import Area, Plotted, plotted
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.label_size import box
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.flywheel import turning_ids as names
from reportgen.flywheel.turning_solution import SolvedTurning
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets.plates import on_sheet

SAMPLES = 361
GAIN, LOSS = "#dfe8f5", "#f5dfdf"
"""Fills of areas in which the flywheel takes up energy, and gives it back."""
CLEAR = 1.0
"""Room around the name of an area (mm)."""
AREAS = ((90.0, 45.0), (144.0, 64.0), (180.0, 80.0))
"""Areas of the charts on a drawing sheet (mm), the smallest first."""


def axis(symbol: Symbol, unit: str) -> Content:
    return Chain((symbol,), unit)


def angle_axis(case: SolvedTurning) -> Content:
    return axis(Symbol("φ"), str(case.words["turning-moment"]["degrees"]))


# --- with diagrams ------------------------------------------------------------------------------------


def torques(case: SolvedTurning, half: bool = False, area: Area | None = None) -> Plotted:
    """Draw both torques over the cycle with the areas between them."""
    φ, driving, resisting = case.curves
    degrees = np.degrees(φ)
    wanted = [case.torque_symbol("d"), case.torque_symbol("r")]
    at = np.searchsorted(φ, case.run.points[1:])
    marks = tuple(int(i) for i in at)
    named = tuple(Number(float(k)) for k in range(2, len(marks) + 2))
    curves = (PlottedCurve(wanted[0], degrees, driving, marks, named), PlottedCurve(wanted[1], degrees, resisting))
    up = axis(Symbol("M"), case.ledger.printed_unit("N·m"))
    chart = plotted(Diagram(curves, angle_axis(case), up), half=half, area=area)
    return replace(chart, scene=_shaded(case, chart, φ, driving, resisting, small=half))


def _shaded(
    case: SolvedTurning, chart: Plotted, φ: Floats, driving: Floats, resisting: Floats, small: bool = False
) -> Scene:
    """Return the scene of a chart with its areas filled and named, below its lines."""

    def place(x: Floats, y: Floats) -> Floats:
        size = chart.high - chart.low
        across = (np.degrees(x) - chart.x[0]) / (chart.x[1] - chart.x[0]) * size.real
        up = (y - chart.y[0]) / (chart.y[1] - chart.y[0]) * size.imag
        return chart.low + across + 1j * up

    fills: list[Item] = []
    labels: list[Item] = []
    ends = [*case.run.points, case.cycle]
    for number, (start, stop) in enumerate(pairwise(ends), start=1):
        # At a jump, an area has the torque on its own side of it.
        inside = slice(int(np.searchsorted(φ, start, "right")) - 1, int(np.searchsorted(φ, stop, "left")) + 1)
        if inside.stop - inside.start < 2:
            continue
        upper, lower = place(φ[inside], driving[inside]), place(φ[inside], resisting[inside])
        gain = case.run.areas[number - 1] > 0
        outline = tuple(complex(at) for at in (*upper, *lower[::-1]))
        fills.append(Polyline(outline, None, closed=True, fill=GAIN if gain else LOSS))
        name = case.printed.symbol(names.area(number))
        room = box(name, style.SMALL)
        height = np.abs((upper - lower).imag)
        wide = height > room.height + 2 * CLEAR
        if wide.any() and np.ptp(upper[wide].real) > room.width + 2 * CLEAR and not small:
            across = np.sort(upper[wide].real)
            middle = float(np.average(upper.real, weights=height))
            x = float(np.clip(middle, across[0] + room.width / 2, across[-1] - room.width / 2))
            near = int(np.abs(upper.real - x).argmin())
            y = float((upper[near] + lower[near]).imag / 2)
            labels.append(Label(complex(x, y), name, "center", style.SMALL))
    return replace(chart.scene, items=(*fills, *chart.scene.items, *labels))


def energy(case: SolvedTurning, half: bool = False, area: Area | None = None) -> Plotted:
    """Draw the energy that the flywheel takes up from the start of the cycle, with its extremes."""
    up = axis(Symbol("E"), case.ledger.printed_unit("J"))
    levels = tuple((float(case.ledger[id].values[0]), case.printed.symbol(id)) for id in case.extremes)
    if case.given.areas is not None:
        heights = np.array([*case.energies, case.energies[-1] + case.areas[-1]])
        x = np.arange(1.0, len(heights) + 1)
        curve = PlottedCurve("", x, heights, tuple(range(len(x))))
        across: Content = str(case.words["turning-moment"]["point"])
        return plotted(Diagram((curve,), across, up, turn=False, levels=levels), half=half, area=area)
    φ = case.curves[0]
    at = np.searchsorted(φ, case.run.points[1:])
    marks = tuple(int(i) for i in at)
    named = tuple(Number(float(k)) for k in range(2, len(marks) + 2))
    curve = PlottedCurve("", np.degrees(φ), case.work, marks, named)
    return plotted(Diagram((curve,), angle_axis(case), up, levels=levels), half=half, area=area)


# --- with areas -----------------------------------------------------------------------------------------


def bars(case: SolvedTurning, half: bool = False, area: Area | None = None) -> Plotted:
    """Draw each area as a bar of one width above or below the mean line."""
    edges = np.repeat(np.arange(1.0, len(case.areas) + 2), 2)
    heights = np.concatenate(([0.0], np.repeat(case.areas, 2), [0.0]))
    up = axis(Symbol("A"), case.ledger.printed_unit("J"))
    across = str(case.words["turning-moment"]["point"])
    chart = plotted(Diagram((PlottedCurve("", edges, heights),), across, up, turn=False), half=half, area=area)
    size = chart.high - chart.low

    def place(x: float, y: float) -> complex:
        across = (x - chart.x[0]) / (chart.x[1] - chart.x[0]) * size.real
        return chart.low + complex(across, (y - chart.y[0]) / (chart.y[1] - chart.y[0]) * size.imag)

    fills: list[Item] = []
    labels: list[Item] = []
    for k, height in enumerate(case.areas, start=1):
        corners = (place(k, 0), place(k + 1, 0), place(k + 1, height), place(k, height))
        fills.append(Polyline(corners, None, closed=True, fill=GAIN if height > 0 else LOSS))
        name = case.printed.symbol(names.area(k))
        room, middle = box(name, style.SMALL), (corners[0] + corners[2]) / 2
        wide, high = abs(corners[1] - corners[0]), abs(corners[2] - corners[1])
        if wide > room.width + CLEAR and high > room.height + CLEAR:
            labels.append(Label(middle, name, "center", style.SMALL))
    return replace(chart, scene=replace(chart.scene, items=(*fills, *chart.scene.items, *labels)))


def diagram(case: SolvedTurning, half: bool = False, area: Area | None = None) -> Plotted:
    """Draw the diagram: torques over the angle, or bars for areas alone."""
    return (torques if case.given.areas is None else bars)(case, half, area)


DrawTurning = Callable[..., Plotted]
FIGURES: Mapping[str, DrawTurning] = {"diagram": diagram, "energy": energy}


def plates(case: SolvedTurning) -> Iterator[DrawingPlate]:
    """Yield both figures at round scales."""
    captions = case.words["turning-moment"]["captions"]

    def plate(name: str, draw: DrawTurning, steps: int) -> DrawingPlate:
        size = on_sheet(case, steps)
        area = Area(*AREAS[size.steps], size.enlarged, mm=case.ledger.printed_unit("mm"))
        scenes: Sequence[Scene] = (lettered(draw(case, area=area).scene),)
        return DrawingPlate(captions[f"figure-{name}"], (), "curves", tuple(scenes), axis="φ")

    for name, draw in FIGURES.items():
        yield enlargeable(partial(plate, name, draw), len(AREAS) - 1)
