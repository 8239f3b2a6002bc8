"""Diagrams over a turn: the motion one below the other with its graphical integration, pressure angle, curvature."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.base.units import MM
from reportgen.cam.laws import PHASES, Floats
from reportgen.cam.solution import TURN_ON_PAPER
from reportgen.cam.solved import SolvedCam
from reportgen.drawing import Arrow, Circle, Content, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.charts import Plotted, PlottedCurve, plotted
from reportgen.drawing.labels import Canvas, Request, finish, label
from reportgen.formula import Chain, Number, Symbol, ids
from reportgen.formula.vocabulary import KINDS

STEPS = 6
"""A phase with motion is integrated in so many steps."""
GAP = 16.0
"""White between two of the diagrams (mm)."""
TURN = TURN_ON_PAPER * MM
"""The length of a turn of the report's diagrams (mm)."""
BEYOND = 6.0
"""How far an axis goes on (mm)."""
RAY, CHORD = Pen(0.1, style.GRAY), Pen(0.2, style.RED)
CURVE = Pen(0.4, style.BLUE)
DIVISION = Pen(0.08, style.PALE)
FARTHEST = 4.0
"""A radius of curvature of more than so many base circles is left out of its diagram."""


@dataclass(frozen=True)
class Graph:
    """One diagram of the motion on paper: its ordinates (mm) over the abscissae (mm) of a turn, and its axis."""

    symbol: Symbol
    up: Floats
    zero: float
    scale: Chain

    def at(self, y: Floats) -> Floats:
        return self.zero + y


def scale_of(case: SolvedCam, id: str) -> float:
    """A scale of the diagrams (SI per m of paper)."""
    return float(case.printed[id].values[0])


def law_diagrams(case: SolvedCam, larger: float = 1.0, enlarged: float = 1.0) -> Scene:
    """s, s′ and s″ one below the other to their scales, each integrated graphically from the one below.

    They are so many times `larger` than in a report, with the scales that they have once they are `enlarged`, too.
    """
    traced = case.solution.cam.sampled(1440)
    names = case.solution.moved
    graphs: list[Graph] = []
    zero = 0.0
    for id, values in zip(names, (traced.s, traced.ds, traced.dds), strict=True):
        short = id.removeprefix("cam.")
        up = values / scale_of(case, ids.cam_scale(short)) * MM * larger
        if graphs:
            # Below the lowest of the one before.
            zero -= up.max() + GAP - min(float(graphs[-1].up.min()), 0.0)
        chain = Chain(
            (case.printed.symbol(ids.cam_scale(short)), shrunk(case, ids.cam_scale(short), larger * enlarged))
        )
        graphs.append(Graph(case.ledger.symbol(id), up, zero, chain))
    poles = [float(case.printed[ids.cam_diagram(number)].values[0]) * MM * larger for number in (1, 2)]
    width = float(case.printed[ids.cam_diagram("L")].values[0]) * MM * larger
    items: list[Item] = []
    requests: list[Request] = []
    across = traced.φ / (2 * math.pi) * width
    for φ, k in zip(case.solution.φ, range(1, case.count + 1), strict=True):
        x = φ / (2 * math.pi) * width
        low = min(float(graphs[-1].at(graphs[-1].up).min()), graphs[-1].zero)
        items.append(Line(complex(x, low), complex(x, graphs[0].zero + graphs[0].up.max()), DIVISION))
        items.append(Label(complex(x, graphs[0].zero - 2.6), str(k), size=style.SMALL))
    items += _integrated(case, graphs, width, poles)
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
                complex((start + stop) / 2, y), case.ledger.symbol(ids.cam_phase(name)), gap=0.8, prefer=(math.pi / 2,)
            )
        )
    μ_φ = Chain((case.printed.symbol(ids.cam_scale("phi")), shrunk(case, ids.cam_scale("phi"), larger * enlarged)))
    notes: list[Content] = [μ_φ, *(graph.scale for graph in graphs)]
    return finish(Canvas(tuple(items), tuple(requests)), notes=notes, margin=2.0)


def shrunk(case: SolvedCam, id: str, larger: float) -> Number:
    """A scale as a diagram has it that is so many times as large."""
    number = case.printed.number(id)
    return number if larger == 1 else Number(float(f"{number.shown / larger:.6g}"), None, number.unit)


def _phase_ends(case: SolvedCam) -> Iterator[tuple[str, tuple[float, float]]]:
    """Where the phases begin and end (degrees)."""
    start = 0.0
    for phase, angle in zip(PHASES, case.solution.given.phase_degrees, strict=True):
        if angle > 0:
            yield phase, (start, start + angle)
        start += angle


def _axes(graph: Graph, width: float, pole: float, order: int, items: list[Item]) -> Iterator[Request]:
    """The axes of a diagram, and the pole that it is integrated from."""
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


def _integrated(case: SolvedCam, graphs: Sequence[Graph], width: float, poles: Sequence[float]) -> Iterator[Item]:
    """Rays from the poles to mean ordinates, and the chords parallel to them, step by step of each moving phase.

    The mean ordinate of a step, at which the eye makes two areas equal, is what the diagram above rises by in it.
    """
    motion, scales = case.solution.motion, [ids.cam_scale(id.removeprefix("cam.")) for id in case.solution.moved]
    for number, K in zip((2, 1), poles, strict=True):
        lower, upper = graphs[number], graphs[number - 1]
        for phase in ("rise", "return"):
            start = motion.starts[phase]
            φ = np.linspace(start, start + motion.phases[PHASES.index(phase)], STEPS + 1)
            x = φ / (2 * math.pi) * width
            up = motion(φ)[number - 1] / scale_of(case, scales[number - 1]) * MM * width / TURN
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


def pressure_chart(case: SolvedCam, half: bool = False) -> Plotted:
    """The pressure angle over a turn, with its limits."""
    traced, limits = case.solution.cam.sampled(), case.solution.designed.limits
    levels = [
        (
            sign * math.degrees(limit),
            case.ledger.symbol(ids.cam_limit(phase)) if sign > 0 else -case.ledger.symbol(ids.cam_limit(phase)),
        )
        for phase, limit, sign in (("rise", limits.rise, 1), ("return", limits.back, -1))
        if limit is not None
    ]
    shown = PlottedCurve(Symbol("α"), np.degrees(traced.φ), np.degrees(traced.alpha))
    return plotted((shown,), angle_axis(case), axis(Symbol("α"), "°"), levels=levels, half=half)


def curvature_chart(case: SolvedCam, half: bool = False) -> Plotted:
    """The radius of curvature of the pitch curve, and of the working profile under a roller, over a turn."""
    cam = case.solution.cam
    traced = cam.sampled()
    most = FARTHEST * max(cam.r0, float(np.abs(traced.pitch).max()) / 2)

    def drawn(values: Floats) -> Floats:
        return np.where(np.abs(values) <= most, values * MM, np.nan)

    series = [PlottedCurve(Symbol("ρ"), np.degrees(traced.φ), drawn(traced.rho))]
    if cam.roller:
        inner = np.where(np.isfinite(drawn(traced.rho)), traced.rho - cam.roller, np.nan)
        series.append(PlottedCurve(case.ledger.symbol("cam.rho.working"), np.degrees(traced.φ), inner * MM))
    limit = case.ledger["cam.limit.rho"].values[0] * MM
    levels = [(float(limit), case.ledger.symbol("cam.limit.rho"))]
    return plotted(series, angle_axis(case), axis(Symbol("ρ"), "mm"), levels=levels, half=half)


def motion_charts(case: SolvedCam) -> Iterator[tuple[Symbol, str, Floats]]:
    """s, s′ and s″ (or those of the swing) with their printed units, over `Cam.sampled`."""
    traced = case.solution.cam.sampled()
    for id, values in zip(case.solution.moved, (traced.s, traced.ds, traced.dds), strict=True):
        how = KINDS[case.ledger[id].kind]
        yield case.ledger.symbol(id), how.unit, values / how.scale
