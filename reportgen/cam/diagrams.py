"""Diagrams over a turn: the motion with its graphical integration, pressure angle, curvature."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record, replace
from reportgen.base.units import MM, nice_up
from reportgen.cam import cam_ids
from reportgen.cam.ledger import HEIGHT, LEAST_POLE, TURN_ON_PAPER
from reportgen.cam.motion_laws import PHASES
from reportgen.cam.solution import SolvedCam
from reportgen.drawing import (
    Arrow,
    Circle,
    Content,
    Diagram,
    Item,
    Label,
    Line,
    Pen,
    PlottedCurve,
    Polyline,
    Scene,
    style,
)
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.charts import Area, Plotted, plotted
from reportgen.drawing.drawing_description import fact, of_curve
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.label_size import box
from reportgen.drawing.labels import Request, label
from reportgen.formula import Chain, Number, Symbol
from reportgen.formula.vocabulary import KINDS

STEPS = 6
"""Number of integration steps of a phase with motion."""
GAP = 16.0
"""Gap between two of the diagrams (mm)."""
TURN = TURN_ON_PAPER * MM
"""The length of a turn of the report's diagrams (mm)."""
BESIDE = 0.4
"""Least gap between the numbers of positions (mm)."""
DEGREES_PER_MM = (2.5, 2.0, 1.0)
"""Scales of the angle on drawing sheets, the smallest first."""
BEYOND = 6.0
"""Length of an axis beyond its end (mm)."""
RAY, CHORD = Pen(0.1, style.GRAY), Pen(0.2, style.RED)
CURVE = Pen(0.4, style.BLUE)
DIVISION = Pen(0.08, style.PALE)
FARTHEST = 4.0
"""A radius of curvature larger than this many base circles is left out of its diagram."""


class Graph(Record):
    """One diagram of the motion on paper: its ordinates (mm) over the abscissae (mm) of a turn, and its axis."""

    symbol: Symbol
    up: Floats
    zero: float

    def at(self, y: Floats) -> Floats:
        """Return the ordinates on paper (mm) for ordinates of the diagram (mm), any shape."""
        return self.zero + y


class LawScales(Record):
    """The length of a turn on paper (mm), the scales (SI per mm) of s, s′, s″, and the pole distances (mm) of the lower
    two.

    K₁ = μ_s′/(μ_s″ μ_φ) belongs to s″, K₂ = μ_s/(μ_s′ μ_φ) to s′.
    """

    turn: float
    per_mm: tuple[float, float, float]
    poles: tuple[float, float]

    def shrunk(self, times: float) -> LawScales:
        """Return the scales of diagrams that are smaller by the factor `times`."""
        (s, ds, dds), (first, second) = self.per_mm, self.poles
        return LawScales(self.turn / times, (s * times, ds * times, dds * times), (first / times, second / times))

    def across(self, φ: Floats) -> Floats:
        """Return the abscissae (mm) [N] of cam angles [N] (rad)."""
        return φ / (2 * math.pi) * self.turn


def usual_scales(case: SolvedCam) -> LawScales:
    """Return the scales of a report."""
    ids_of = (cam_ids.scale(id.removeprefix("cam.")) for id in case.solution.moved)
    first, second, third = (float(case.printed[id].values[0]) / MM for id in ids_of)
    turn, *poles = (float(case.printed[cam_ids.diagram(name)].values[0]) * MM for name in ("L", 1, 2))
    return LawScales(turn, (first, second, third), (poles[0], poles[1]))


def standard_scales(case: SolvedCam, steps: int) -> LawScales:
    """Return standard scales of a drawing sheet for a turn of its length, with heights as in a report; the poles
    follow.
    """
    turn = 360 / DEGREES_PER_MM[steps]
    profile, μ_φ = case.solution.cam.sampled(), 2 * math.pi / turn
    height = HEIGHT * MM * turn / TURN
    first, second, third = (float(np.ptp(part)) / height for part in (profile.s, profile.ds, profile.dds))
    lowest = nice_up(third or second / μ_φ / height)
    middle = nice_up(max(second, lowest * μ_φ * LEAST_POLE))
    highest = nice_up(max(first, middle * μ_φ * LEAST_POLE))
    return LawScales(turn, (highest, middle, lowest), (middle / lowest / μ_φ, highest / middle / μ_φ))


def law_diagrams(case: SolvedCam, size: FigureSize = IN_REPORT) -> Scene:
    """Return s, s′ and s″ one below the other to their scales, each integrated graphically from the one below."""
    profile = case.solution.cam.sampled(1440)
    names = case.solution.moved
    scales = standard_scales(case, size.steps) if size.beside else usual_scales(case)
    notes = list(_notes(case, scales, size))
    scales = scales.shrunk(size.enlarged)
    graphs: list[Graph] = []
    zero = 0.0
    for id, values, per_mm in zip(names, (profile.s, profile.ds, profile.dds), scales.per_mm, strict=True):
        up = values / per_mm
        if graphs:
            # Below the lowest diagram so far.
            zero -= up.max() + GAP - min(float(graphs[-1].up.min()), 0.0)
        graphs.append(Graph(case.ledger.symbol(id), up, zero))
    poles, width = scales.poles, scales.turn
    items: list[Item] = []
    requests: list[Request] = []
    across = scales.across(profile.φ)
    taken = -math.inf
    for φ, k in zip(case.solution.φ, range(1, case.count + 1), strict=True):
        x = φ / (2 * math.pi) * width
        low = min(float(graphs[-1].at(graphs[-1].up).min()), graphs[-1].zero)
        items.append(Line(complex(x, low), complex(x, graphs[0].zero + graphs[0].up.max()), DIVISION))
        half = box(str(k), style.SMALL).width / 2
        # Of positions close to each other, not all have room for their numbers.
        if x - half > taken:
            items.append(Label(complex(x, graphs[0].zero - 2.6), str(k), size=style.SMALL, background=True))
            taken = x + half + BESIDE
    items += _integrated(case, graphs, scales)
    for number, graph in enumerate(graphs):
        requests += _axes(graph, width, poles[2 - number] if number else 0.0, 3 - number, items)
        points = tuple(complex(x, y) for x, y in zip(across, graph.at(graph.up), strict=True))
        items.append(Polyline(points, CURVE))
    for name, x in _phase_ends(case):
        start = x[0] / 360 * width
        stop = x[1] / 360 * width
        y = graphs[0].zero + float(graphs[0].up.max()) + 6.0
        items += [Arrow(complex((start + stop) / 2, y), complex(end, y), style.DIMENSION, 1.6) for end in (start, stop)]
        requests.append(
            label(
                complex((start + stop) / 2, y), case.ledger.symbol(cam_ids.phase(name)), gap=0.8, prefer=(math.pi / 2,)
            )
        )
    facts = [fact("graph", axis(symbol, unit)) for symbol, unit, _ in motion_charts(case)]
    for symbol, _, values in motion_charts(case):
        facts += of_curve(PlottedCurve(symbol, np.degrees(case.solution.cam.sampled().φ), values), "°")
    return finish(Canvas(tuple(items), tuple(requests), tuple(facts)), notes=notes, margin=2.0)


def _notes(case: SolvedCam, scales: LawScales, size: FigureSize) -> Iterator[Content]:
    """Yield the notes of scales; on a sheet with those of the report and the pole distances."""
    phi = cam_ids.scale("phi")
    drawn = _printed_scale(case, phi, 2 * math.pi / scales.turn)
    note = size.compared(case.printed.symbol(phi), drawn, case.printed.number(phi))
    if size.beside:
        degrees = Number(DEGREES_PER_MM[size.steps], unit="°/mm")
        note = replace(note, parts=(note.parts[0], degrees, drawn))
    yield note
    for id, per_mm in zip(case.solution.moved, scales.per_mm, strict=True):
        of = cam_ids.scale(id.removeprefix("cam."))
        yield size.compared(case.printed.symbol(of), _printed_scale(case, of, per_mm), case.printed.number(of))
    if size.beside:
        for number, pole in enumerate(scales.poles, start=1):
            K = cam_ids.diagram(number)
            yield size.compared(
                case.printed.symbol(K), Number(pole, 2, case.printed.printed_unit("mm")), case.printed.number(K)
            )


def _printed_scale(case: SolvedCam, id: str, per_mm: float) -> Number:
    """Return a scale (SI per mm) as the report prints it."""
    number = case.printed.number(id)
    usual = float(case.printed[id].values[0]) / MM
    if math.isclose(per_mm, usual, rel_tol=1e-12):
        return number
    return Number(float(f"{number.value * per_mm / usual:.6g}"), None, number.unit)


def _phase_ends(case: SolvedCam) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield the phases with their beginnings and ends (degrees)."""
    start = 0.0
    for phase, angle in zip(PHASES, case.solution.given.phase_degrees, strict=True):
        if angle > 0:
            yield phase, (start, start + angle)
        start += angle


def _axes(graph: Graph, width: float, pole: float, order: int, items: list[Item]) -> Iterator[Request]:
    """Add the axes of a diagram, and yield the label of the pole from which it is integrated."""
    low, high = graph.zero + min(float(graph.up.min()), 0.0), graph.zero + float(graph.up.max())
    left = -pole - 3.0 if pole else -3.0
    items.append(Arrow(complex(left, graph.zero), complex(width + BEYOND, graph.zero), style.DIMENSION, 1.8))
    items.append(Arrow(complex(0, low - 1.0), complex(0, high + BEYOND), style.DIMENSION, 1.8))
    yield label(complex(width + BEYOND, graph.zero), Symbol("φ"), gap=0.8, prefer=(math.pi / 2, 0.0))
    yield label(complex(0, high + BEYOND), graph.symbol, gap=0.8, prefer=(math.pi, 0.0))
    if pole:
        number = 1 if order == 1 else 2
        at = complex(-pole, graph.zero)
        items.append(Circle(at, style.POINT, Pen(0.2), style.PAPER))
        yield label(at, Symbol("P", str(number)), gap=1.0, prefer=(-math.pi / 2, math.pi))
        below = at - 5.5j
        items += [Arrow(below + pole / 2, below + end, style.DIMENSION, 1.6) for end in (0.0, pole)]
        items.append(Line(at, below, style.LEADER))
        yield label(below + pole / 2, Symbol("K", str(number)), gap=0.8, prefer=(-math.pi / 2,))


def _integrated(case: SolvedCam, graphs: Sequence[Graph], scales: LawScales) -> Iterator[Item]:
    """Yield rays from the poles to mean ordinates, and the chords parallel to them, for each step of a moving phase.

    The mean ordinate of a step, which makes two areas equal by eye, is the rise of the diagram above over that step.
    """
    motion = case.solution.motion
    for number, K in zip((2, 1), scales.poles, strict=True):
        lower, upper = graphs[number], graphs[number - 1]
        for phase in ("rise", "return"):
            start = motion.starts[phase]
            φ = np.linspace(start, start + motion.phases[PHASES.index(phase)], STEPS + 1)
            x = scales.across(φ)
            up = motion(φ)[number - 1] / scales.per_mm[number - 1]
            mean = np.diff(up) / np.diff(x) * K
            corners = x + 1j * upper.at(up)
            for step in range(STEPS):
                foot = complex(0, lower.zero + mean[step])
                yield Line(complex(-K, lower.zero), foot, RAY)
                yield Line(foot, complex((x[step] + x[step + 1]) / 2, foot.imag), DIVISION)
                yield Line(complex(corners[step]), complex(corners[step + 1]), CHORD)


# --- curves ---------------------------------------------------------------------------------------


def axis(symbol: Symbol, unit: str) -> Chain:
    return Chain((symbol,), unit)


def angle_axis(case: SolvedCam) -> Chain:
    return axis(Symbol("φ"), str(case.words["cam"]["angle"]))


def pressure_chart(case: SolvedCam, half: bool = False, area: Area | None = None) -> Plotted:
    """Return the pressure angle over a turn, with its limits."""
    profile, limits = case.solution.cam.sampled(), case.solution.designed.limits
    levels = [
        (
            sign * math.degrees(limit),
            case.ledger.symbol(cam_ids.limit(phase)) if sign > 0 else -case.ledger.symbol(cam_ids.limit(phase)),
        )
        for phase, limit, sign in (("rise", limits.rise, 1), ("return", limits.back, -1))
        if limit is not None
    ]
    curve = PlottedCurve(Symbol("α"), np.degrees(profile.φ), np.degrees(profile.alpha))
    return plotted(
        Diagram((curve,), angle_axis(case), axis(Symbol("α"), "°"), levels=tuple(levels)), half=half, area=area
    )


def curvature_chart(case: SolvedCam, half: bool = False) -> Plotted:
    """Return the radius of curvature over a turn, of the pitch curve and, under a roller, of the working profile."""
    cam = case.solution.cam
    profile = cam.sampled()
    most = FARTHEST * max(cam.r0, float(np.abs(profile.pitch).max()) / 2)

    def drawn(values: Floats) -> Floats:
        return np.where(np.abs(values) <= most, values * MM, np.nan)

    series = [PlottedCurve(Symbol("ρ"), np.degrees(profile.φ), drawn(profile.rho))]
    if cam.roller:
        inner = np.where(np.isfinite(drawn(profile.rho)), profile.rho - cam.roller, np.nan)
        series.append(PlottedCurve(case.ledger.symbol("cam.rho.working"), np.degrees(profile.φ), inner * MM))
    limit = case.ledger["cam.limit.rho"].values[0] * MM
    levels = [(float(limit), case.ledger.symbol("cam.limit.rho"))]
    return plotted(
        Diagram(
            tuple(series), angle_axis(case), axis(Symbol("ρ"), case.ledger.printed_unit("mm")), levels=tuple(levels)
        ),
        half=half,
    )


def motion_charts(case: SolvedCam) -> Iterator[tuple[Symbol, str, Floats]]:
    """Yield s, s′ and s″ (or those of the swing) as symbol, printed unit and values [N], over `Cam.sampled`."""
    profile = case.solution.cam.sampled()
    for id, values in zip(case.solution.moved, (profile.s, profile.ds, profile.dds), strict=True):
        how = KINDS[case.ledger[id].kind]
        yield case.ledger.symbol(id), case.ledger.printed_unit(how.unit), values / how.scale
