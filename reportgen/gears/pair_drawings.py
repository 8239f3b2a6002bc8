"""Drawings of a gear pair: teeth in mesh true to scale, the region of possible shifts, specific sliding."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.units import MM, nice_up
from reportgen.drawing import (
    Arc,
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
from reportgen.drawing.drawing_description import Fact, PaperLength, angle, arrow, fact
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import clipped
from reportgen.drawing.labels import Request, label
from reportgen.formula import Chain, Number, Symbol
from reportgen.formula.array_evaluation import model
from reportgen.gears import gears_ids
from reportgen.gears.pair_formulas import WHEELS
from reportgen.gears.pair_ledger import SolvedPair
from reportgen.gears.pair_shifts import GearPair, PairLimits

MESH_ROOM = 150 + 168j
"""Largest width and height of the drawing of the mesh on a page (mm)."""
HIGHEST, LEAST_WITH_ENDS = 50.0, 20.0
"""Largest height of a tooth on paper (mm); if it is reached, both ends of the line of action are drawn."""
SHOWN = (-1, 0, 1)
"""The teeth of each wheel that are drawn, counted from the tooth whose flank touches at the pitch point."""
STEPS = 4
"""Number of points by which an involute is constructed."""
FLANK = Pen(0.45)
LINE_OF_ACTION, ACTIVE = Pen(0.18, style.RED, style.DASHED), Pen(0.7, style.RED, style.DASHED)
WORKING = Pen(0.9, style.BLUE)
INVOLUTE = Pen(0.12, style.GRAY)
TOWARDS = 14.0
"""Length (mm) of the line of action beyond its active part, towards an end that is not drawn."""
BEYOND = 6.0
"""Margin (mm) around the teeth in which the construction is drawn."""
CIRCLES = (
    ("d_a", style.THIN),
    ("d_w", Pen(0.2, style.BLUE, style.CHAIN)),
    ("d", style.AXIS),
    ("d_b", Pen(0.18, style.GRAY, style.DASHED)),
    ("d_f", style.THIN),
)
CIRCLE_PITCHES = 1.375
"""Length of the circles on either side of the line of centres (pitches), past the outer tooth."""
LETTERS = {"d_a": "a", "d_w": "w", "d": "", "d_b": "b", "d_f": "f"}


# --- the mesh -------------------------------------------------------------------------------------


def turned(pair: GearPair, number: int, rolled: float) -> float:
    """Return the angle (rad) of a wheel (0 or 1) whose middle tooth touches where wheel 1's flank has rolled `rolled`
    m.

    Wheel 1 is below, wheel 2 above it; wheel 1 turns anticlockwise and drives with its left flanks.
    """
    first, second = pair.wheel(0), pair.wheel(1)
    base = float(first.half_angle(np.array(first.r_b)))
    angle = rolled / first.r_b - float(pair["alpha_w"]) - base
    if number == 0:
        return math.pi / 2 + angle
    return -math.pi / 2 - second.pitch / 2 - angle * first.z / second.z


def centre(pair: GearPair, number: int) -> complex:
    """Return the centre of wheel 0 or 1 (m), with the pitch point at 0."""
    return (-1j, 1j)[number] * float(pair["d_w"][number]) / 2


def on_line(pair: GearPair, rolled: float) -> complex:
    """Return the point of the line of action at the distance `rolled` (m) from N₁, with the pitch point at 0."""
    at_pitch = float(pair.to_pitch_point[0])
    return complex((rolled - at_pitch) * np.exp(1j * (math.pi - float(pair["alpha_w"]))))


def mesh_scale(case: SolvedPair) -> tuple[float, bool]:
    """Return the scale of the mesh in a report (mm/mm), and True if both ends of the line of action are drawn."""
    pair = case.gears
    paper = [point * MM for point in (*_drawn_teeth(pair)[1], on_line(pair, 0.0), on_line(pair, float(pair["g"])))]
    usual, _ = IN_REPORT.fitting(paper, MESH_ROOM)
    with_ends = tooth(case) / usual >= LEAST_WITH_ENDS
    if not with_ends:
        usual, _ = IN_REPORT.fitting(paper[:-2], MESH_ROOM)
    return max(usual, nice_up(tooth(case) / HIGHEST)), with_ends


def tooth(case: SolvedPair) -> float:
    """Return the height of a tooth (mm)."""
    return float(case.ledger["gears.h"].values[0]) * MM


def _drawn_teeth(pair: GearPair) -> tuple[list[list[Complexes]], Complexes]:
    """Return the drawn teeth of each wheel, and all their points (m)."""
    at_pitch = float(pair.to_pitch_point[0])
    outlines = [list(_teeth(pair, number, at_pitch)) for number in (0, 1)]
    return outlines, np.concatenate([points for teeth in outlines for points in teeth])


def mesh(case: SolvedPair, size: FigureSize = IN_REPORT) -> Scene:
    """Return three teeth of each wheel in contact at the pitch point, constructed as by hand."""
    pair = case.gears
    ends = [on_line(pair, 0.0), on_line(pair, float(pair["g"]))]
    at_pitch = float(pair.to_pitch_point[0])
    outlines, drawn = _drawn_teeth(pair)
    usual, with_ends = mesh_scale(case)
    at = size.per_unit(usual) * MM
    points: Complexes = np.append(drawn, np.array(ends, np.complex128)) if with_ends else drawn
    low, high = _corners(points * at)
    items: list[Item] = []
    requests: list[Request] = []
    for number in (0, 1):
        _circles(case, number, at, (low, high), items, requests)
        items += [Polyline(tuple(points * at), FLANK) for points in outlines[number]]
        _construction(pair, number, at, (low, high), items, requests)
        items += _working_flank(pair, number, at_pitch, at)
    _line_of_action(pair, at, with_ends, items, requests)
    for number, end in enumerate((complex(0, low.imag - 8), complex(0, high.imag + 8))):
        # The centres are outside the drawing, or end the line of centres.
        o = centre(pair, number) * at
        items.append(Line(0j, min(o, end, key=abs), style.AXIS))
        items.append(
            Circle(o, 0.7, None, style.BLACK) if abs(o) <= abs(end) else Arrow(end * 0.9, end, style.DIMENSION)
        )
        requests.append(label(min(o, end, key=abs), Symbol("O", str(number + 1)), gap=1.0, prefer=(0.0, math.pi)))
    note = size.note(Symbol("μ", "l"), usual)
    a_w = Chain((case.printed.symbol("gears.a_w"), case.printed.result("gears.a_w")))
    notes: list[Content] = [note, a_w]
    facts = tuple(_mesh_facts(pair, at))
    return finish(Canvas(tuple(items), tuple(requests), facts), notes=notes, margin=2.0)


def _mesh_facts(pair: GearPair, at: float) -> Iterator[Fact]:
    """Yield the facts of the mesh: numbers of teeth, radii of the circles (mm), the line of action and its active
    part.
    """
    yield fact("mesh", *(Number(int(z)) for z in pair.teeth), Symbol("P"))
    yield angle(Symbol("α", "w"), float(pair["alpha_w"]))
    ends = (on_line(pair, float(rho)) * at for rho in (pair["rho_p"][0], pair["rho_a"][0]))
    start, stop = ends
    yield arrow((Symbol("B", "2"), Symbol("B", "1")), stop - start)
    for number in (0, 1):
        for name, letter in LETTERS.items():
            yield fact("radius", Symbol("r", f"{letter}{number + 1}"), PaperLength(float(pair[name][number]) / 2 * at))


def _corners(points: Complexes) -> tuple[complex, complex]:
    return complex(points.real.min(), points.imag.min()), complex(points.real.max(), points.imag.max())


def _teeth(pair: GearPair, number: int, rolled: float) -> Iterator[Complexes]:
    """Yield three teeth of a wheel from space to space, each as one line."""
    wheel = pair.wheel(number)
    tooth = wheel.tooth()
    turns = [np.exp(1j * (turned(pair, number, rolled) - k * wheel.pitch)) for k in SHOWN]
    yield centre(pair, number) + np.concatenate([tooth * turn for turn in turns])


def _circles(
    case: SolvedPair, number: int, at: float, box: tuple[complex, complex], items: list[Item], requests: list[Request]
) -> None:
    """Add the five circles as far as the drawing reaches, each with its name at its ends."""
    pair, middle = case.gears, (math.pi / 2, -math.pi / 2)[number]
    o = centre(pair, number) * at
    half = max(abs(box[0].real), abs(box[1].real)) + 3.0
    taken: list[float] = []
    for name, pen in CIRCLES:
        radius = float(pair[name][number]) / 2 * at
        if any(abs(radius - other) < 0.01 for other in taken):
            continue
        taken.append(radius)
        to_edge = math.asin(min(half / radius, 1.0))
        beyond_teeth = CIRCLE_PITCHES * 2 * math.pi / pair.teeth[number]
        reach = min(to_edge, beyond_teeth)
        items.append(Arc(o, radius, middle - reach, middle + reach, pen))
        places = [
            o + radius * np.exp(1j * (middle + side * reach * share)) for share in (1.0, 0.97) for side in (-1, 1)
        ]
        requests.append(
            label([complex(place) for place in places], Symbol("r", f"{LETTERS[name]}{number + 1}"), gap=0.5)
        )


def _construction(
    pair: GearPair, number: int, at: float, box: tuple[complex, complex], items: list[Item], requests: list[Request]
) -> None:
    """Draw the involute through the pitch point: equal arcs of the base circle, laid off on the tangents at their ends.

    For a large wheel, only the part in the box of the teeth is drawn.
    """
    low, high = box[0] - BEYOND * (1 + 1j), box[1] + BEYOND * (1 + 1j)
    o, r_b = centre(pair, number), float(pair["d_b"][number]) / 2
    α_w = float(pair["alpha_w"])
    to_n = (1j, -1j)[number] * np.exp(-1j * α_w)
    whole = float(pair.to_pitch_point[number])
    reach = math.sqrt(float(pair["d_a"][number]) ** 2 / 4 - r_b**2)
    for step in range(math.floor(reach / whole * STEPS) + 1):
        rolled = whole * step / STEPS
        foot = to_n * np.exp(1j * (whole - rolled) / r_b) * r_b
        # The unwound string lies on the tangent, back to the beginning of the involute on the base circle.
        start, end = complex((o + foot) * at), complex((o + foot + foot / r_b * 1j * rolled) * at)
        if step and (visible := clipped(start, end, low, high)):
            items.append(Line(*visible, INVOLUTE))
        if all(low.real <= p.real <= high.real and low.imag <= p.imag <= high.imag for p in (start, end)):
            items.append(Circle(start, 0.4, None, style.GRAY))
            items.append(Circle(end, 0.4, Pen(0.12), style.PAPER))
            if step <= STEPS:
                inward = float(np.angle(-foot))
                requests.append(label(start, str(step), size=style.SMALL, gap=0.5, prefer=(inward,)))


def _working_flank(pair: GearPair, number: int, rolled: float, at: float) -> Iterator[Item]:
    """Yield the working part of the touching flank, and the arc of contact on the working circle."""
    wheel, o = pair.wheel(number), centre(pair, number)
    r = np.hypot(wheel.r_b, np.linspace(float(pair["rho_p"][number]), float(pair["rho_a"][number]), 60))
    flank = wheel.flank(r) * np.exp(1j * turned(pair, number, rolled))
    yield Polyline(tuple((o + flank) * at), WORKING)
    pitch_point = float(np.angle(-o))
    rolled_here = float(pair.to_pitch_point[number])
    before, after = ((rolled_here - float(rho[number])) / wheel.r_b for rho in (pair["rho_a"], pair["rho_p"]))
    radius = float(pair["d_w"][number]) / 2 * at
    yield Arc(o * at, radius, pitch_point - before, pitch_point - after, Pen(0.6, style.BLUE))


def _line_of_action(pair: GearPair, at: float, with_ends: bool, items: list[Item], requests: list[Request]) -> None:
    starts = {"N1": 0.0, "B2": float(pair["rho_p"][0]), "B1": float(pair["rho_a"][0]), "N2": float(pair["g"])}
    points = {name: on_line(pair, rolled) * at for name, rolled in starts.items()}
    direction = points["B1"] - points["B2"]
    direction /= abs(direction)
    ends = []
    for number, (name, start, sense) in enumerate((("N1", "B2", -direction), ("N2", "B1", direction))):
        # An arrow points to an end that is outside the drawing, as for the centres.
        if with_ends or abs(points[name] - points[start]) <= TOWARDS:
            foot = points[name] - centre(pair, number) * at
            items.append(Line(points[name], points[name] - foot / abs(foot) * 8, style.CONSTRUCTION))
            ends.append(points[name] + 6 * sense)
        else:
            del points[name]
            far = points[start] + TOWARDS * sense
            items.append(Arrow(far - 5 * sense, far, LINE_OF_ACTION))
            requests.append(label(far, Symbol(name[0], name[1]), gap=1.0, prefer=(float(np.angle(sense)),)))
            ends.append(far)
    items.append(Line(ends[0], ends[1], LINE_OF_ACTION))
    items.append(Line(points["B2"], points["B1"], ACTIVE))
    for name, point in points.items():
        items.append(Circle(point, 0.7, None, style.RED))
        requests.append(label(point, Symbol(name[0], name[1]), gap=1.0))
    items.append(Circle(0j, 0.7, None, style.BLACK))
    requests.append(label(0j, Symbol("P"), gap=1.2))
    items.append(Line(-22 + 0j, 22 + 0j, style.CONSTRUCTION))
    angle = math.pi - float(pair["alpha_w"])
    items.append(Arc(0j, 20.0, angle, math.pi, style.DIMENSION))
    requests.append(label(complex(20.0 * np.exp(1j * (angle + math.pi) / 2)), Symbol("α", "w"), gap=0.6))


# --- the region of shifts ---------------------------------------------------------------------------

GRID = 241
FRAME = 112 + 100j
"""Size of the diagram without its text (mm)."""
LONG = 15.0
"""Shortest line of a limit that gets its name (mm)."""
APART = 8.0
"""Least distance between numbers on an axis (mm)."""
AROUND = 0.15
"""Margin around the region (modules)."""
OUTER = (-1.5, 3.0)
"""Shifts beyond this are not examined."""
HARD_LIMITS = PairLimits(epsilon=1.0, tip=0.0)
"""Limits of any pair: without undercut, not pointed, no interference, ε ≥ 1."""
HARD, SOFT = Pen(0.45), Pen(0.25, style.BLUE, style.DASHED)
ALIKE = Pen(0.25, style.RED, style.CHAIN)


def region(case: SolvedPair, area: Area | None = None) -> Scene:
    """Return the diagram of the shifts that the limits allow, with the chosen ones; in an `area` its scales are
    printed.
    """
    pair, limits = case.gears, case.chosen.limits
    axes = np.linspace(*OUTER, 451)
    allowed = _bounds(_at(pair, axes, axes)).min(axis=0) >= 0
    inner = [axes[allowed.any(axis=side)] if allowed.any() else np.zeros(1) for side in (1, 0)]
    low, high = (
        [float(pick(np.append(inside, x))) + side * AROUND for inside, x in zip(inner, pair.x, strict=True)]
        for pick, side in ((np.min, -1), (np.max, 1))
    )
    x1, x2 = (np.linspace(start, stop, GRID) for start, stop in zip(low, high, strict=True))
    wide, tall = high[0] - low[0], high[1] - low[1]
    notes: list[Content] = []
    per = (FRAME.real / wide, FRAME.imag / tall)
    if area:
        # Both axes have the same scale.
        scale = max(area.per_mm(wide, area.width), area.per_mm(tall, area.height))
        per = (1 / scale / area.enlarged, 1 / scale / area.enlarged)
        notes = [Chain((Symbol("μ", "x"), Number(scale, unit="mm⁻¹")))]
    frame = complex(wide * per[0], tall * per[1])
    grid = _at(pair, x1, x2)

    def paper(place: Complexes) -> Complexes:
        return np.asarray((place.real - low[0]) * per[0] + 1j * (place.imag - low[1]) * per[1])

    items: list[Item] = []
    requests: list[Request] = []
    balance = np.where((grid["rho_p"] > 0).all(axis=0), grid.sliding[0] - grid.sliding[1], np.nan)
    ε = grid["epsilon"]
    lines: list[tuple[Floats, float, Pen, tuple[Content, ...]]] = []
    hard = {(one.name, one.wheel): one.margin for one in grid.conditions(HARD_LIMITS)}
    for i in WHEELS:
        tip = Symbol("s", f"a{i}")
        lines += [
            (hard["undercut", i], 0.0, HARD, (Symbol("x", f"min{i}"),)),
            (hard["tip", i], 0.0, HARD, (tip, " = 0")),
            (hard["interference", i], 0.0, HARD, (Symbol("ρ", f"p{i}"), " = ", Symbol("ρ", f"f{i}"))),
        ]
        if limits.tip:
            lines.append((hard["tip", i], limits.tip, SOFT, (tip, " = ", Number(limits.tip, None), " ", Symbol("m"))))
    lines.append((ε, 1.0, HARD, (Symbol("ε", "α"), " = 1")))
    if limits.epsilon > 1:
        lines.append((ε, limits.epsilon, SOFT, (Symbol("ε", "α"), " = ", Number(limits.epsilon, None))))
    lines.append((balance, 0.0, ALIKE, (Symbol("λ", "1"), " = ", Symbol("λ", "2"))))
    for values, level, pen, name in lines:
        pieces = [paper(piece) for piece in level_lines(x1, x2, values.T, level)]
        items += [Polyline(tuple(piece), pen) for piece in pieces if piece.size > 1]
        for piece in pieces:
            if float(np.abs(np.diff(piece)).sum()) >= LONG:
                places = [complex(piece[int(share * (piece.size - 1))]) for share in (0.9, 0.75, 0.5, 0.25, 0.1)]
                requests.append(label(places, *name, gap=0.6, size=style.SMALL))
    items.append(Polyline((0j, frame.real + 0j, frame, frame.imag * 1j), Pen(0.25), closed=True))
    items += _ticks(low, high, per)
    chosen = complex(paper(np.array([complex(*pair.x)]))[0])
    items.append(Circle(chosen, 1.0, None, style.RED))
    requests.append(label(chosen, "(", Symbol("x", "1"), "; ", Symbol("x", "2"), ")", gap=1.2))
    items.append(Label(complex(frame.real, -6), Symbol("x", "1"), "top-right"))
    items.append(Label(complex(-9, frame.imag), Symbol("x", "2"), "top-right"))
    shifts = [Number(round(float(x), 3)) for x in pair.x]
    facts = [fact("chosen", Symbol("x", "1"), shifts[0], Symbol("x", "2"), shifts[1])]
    facts += (
        fact(phrase, Symbol("x", str(side + 1)), *(Number(round(ends[side], 2)) for ends in (low, high)))
        for side, phrase in enumerate(("across", "up"))
    )
    facts.append(fact("shift-limits", Symbol("ε", "α"), Symbol("λ", "1"), Symbol("λ", "2")))
    return finish(Canvas(tuple(items), tuple(requests), tuple(facts)), notes=notes, margin=2.0)


def level_lines(x: Floats, y: Floats, values: Floats, level: float) -> list[Complexes]:
    """Return the lines x + iy on which values [Y, X] over two axes equal a level; NaN values have no line."""
    from contourpy import contour_generator

    made = contour_generator(x, y, np.ma.masked_invalid(values), line_type="Separate")
    return [np.asarray(line) @ (1, 1j) for line in made.lines(level)]


def _at(pair: GearPair, x1: Floats, x2: Floats) -> GearPair:
    """Return the pairs for all shifts on two axes [X1], [X2]; the first axis of arrays is x₁."""
    return GearPair(pair.rack, pair.m, pair.teeth, np.stack(np.meshgrid(x1, x2, indexing="ij")))


def _bounds(grid: GearPair) -> Floats:
    """Return the margins of the hard limits over a grid of pairs; −1 where no pair exists."""
    margins = [condition.margin for condition in grid.conditions(HARD_LIMITS)]
    return np.asarray(np.nan_to_num(np.array(margins), nan=-1.0))


def _ticks(low: Sequence[float], high: Sequence[float], per: tuple[float, float]) -> Iterator[Item]:
    for side in (0, 1):
        step = nice_up(max((high[side] - low[side]) / 9, APART / per[side]), (1.0, 2.0, 5.0))
        for k in range(math.ceil(low[side] / step), math.floor(high[side] / step) + 1):
            along = (k * step - low[side]) * per[side]
            start, direction = (complex(along, 0), 1j) if side == 0 else (complex(0, along), 1 + 0j)
            far = (high[1 - side] - low[1 - side]) * per[1 - side]
            yield Line(start, start + direction * far, Pen(0.08, style.PALE if k else style.BLACK))
            text = Number(k * step, max(-math.floor(math.log10(step)), 0))
            yield Label(start - direction, text, "top" if side == 0 else "right", style.SMALL)


# --- sliding --------------------------------------------------------------------------------------

DEEPEST = 4.0
"""λ is drawn down to this far below 0."""


def sliding(case: SolvedPair, area: Area | None = None) -> Plotted:
    """Return λ₁ and λ₂ over the distance from N₁; marks show the ends of the active path."""
    pair = case.gears
    g, start, end = float(pair["g"]), float(pair["rho_p"][0]), float(pair["rho_a"][0])
    ρ1 = np.unique(np.concatenate((np.linspace(0, g, 801)[1:-1], [start, end])))
    along = model(
        case.calculation,
        [gears_ids.of_wheel("lambda", wheel) for wheel in WHEELS],
        **{gears_ids.of_wheel("rho", 1): ρ1},
    )
    curves = []
    for wheel, λ in zip(WHEELS, along.values(), strict=True):
        least = max(DEEPEST, 1.2 * float(-pair.sliding.min()))
        visible = np.where(λ >= -least, λ, np.nan)
        marks = tuple(int(np.abs(ρ1 - at).argmin()) for at in (start, end))
        curves.append(PlottedCurve(case.ledger.symbol(gears_ids.of_wheel("lambda", wheel)), ρ1 * MM, visible, marks))
    across = Chain((case.ledger.symbol(gears_ids.of_wheel("rho", 1)),), case.ledger.printed_unit("mm"))
    return plotted(Diagram(tuple(curves), across, Chain((Symbol("λ"),), ""), turn=False), area=area)
