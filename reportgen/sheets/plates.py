"""What drawing sheets show: series of plates, each of one name, drawn from the report's own figures.

The plates of a series have one scale, which is chosen for the sheet.  A series is drawn from a report whose ledger is
redrawn to that scale (`Case.redrawn`), so that lengths in its tables are those that a ruler finds on the sheet.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import accumulate
from typing import Literal

import numpy as np

from reportgen.base.units import MM, nice_up
from reportgen.drawing import Content, Label, Scene
from reportgen.drawing.charts import Area
from reportgen.drawing.geometry import bounds
from reportgen.drawing.labels import MARGIN
from reportgen.drawing.plan import Plan, plan
from reportgen.drawing.sheet import ENLARGED, USUAL_FORM, Form, grid, lettered, widths
from reportgen.formula import Chain, Number, Symbol, ids
from reportgen.formula.ids import Name
from reportgen.plans.loads import Polygon
from reportgen.plans.motion import What
from reportgen.plans.scales import PER_MM, UNLOADED, extents
from reportgen.report.curves import flywheel_speed, flywheel_torque, flywheel_work, motion, polar, torque, wittenbauer
from reportgen.report.figures import FigureScenes, centre_state, centres, indicator, positions_scene, scheme_scene
from reportgen.report.force_figures import lever, separated, separated_driver
from reportgen.report.plans import force_plan, motion_plan
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

Set = Literal["kinematics", "forces"]
SETS: tuple[Set, ...] = ("kinematics", "forces")
Drawing = tuple[str, Scene]
"""Where it applies, in words, and what is drawn."""
NAMES: dict[What, str] = {"v": "velocity", "a": "acceleration"}
SEGMENT = 2
"""Decimals of lengths on paper, mm."""
CURVE = "curve"
"""In place of a scale's id: the axes of curves have scales of their own."""
FINE = (1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.4, 8)
"""Steps in the height of curves and in the size of plates with their own scales, which are made round afterwards."""
WHOLE, HALF = (1, 2, 2.5, 4, 5), (1, 2, 2.5, 5)
"""The series of round scales, and those that are round when a part is drawn at half the scale."""


@dataclass(frozen=True, slots=True)
class Series:
    """Plates of one name, in a set and on a layer, and how to draw them.

    `scale` is the id of their scale, "" if they have none; series of one `scale` and `key` share it.  `size` is the
    largest width or height of what they show (SI), as it is without a scale.  Plates that differ too much for one scale
    have their own `sizes` and each a scale of its own; they share the size on paper that is chosen for the sheet.
    """

    name: str
    belongs: Set
    layer: str
    draw: Callable[[Report], Iterator[Drawing]]
    scale: str = ""
    key: str = ""
    size: float = 0.0
    steps: Sequence[float] = WHOLE
    sizes: tuple[float, ...] = ()
    """The larger side (SI) of what each position shows, nan where there is nothing."""

    @property
    def scaled(self) -> tuple[str, str]:
        """What tells its scale from others."""
        return self.scale, self.key

    def to_scale(self, report: Report, scale: float) -> Report:
        """The report that the series is drawn from, at its scale on the sheet (SI); of curves 1/scale is the height.

        So it is of plates that have their own scales: each is as large as that or, for a round scale, smaller.  The
        report draws for the enlargement that follows; numbers in tables are those of the sheet itself.
        """
        if self.scale == CURVE:
            height = MM / scale / ENLARGED
            return replace(report, area=Area(report.form.shape * height, height, ENLARGED))
        if not scale:
            return report
        enlarged = 1.0 if self.layer == "tables" else ENLARGED
        own = self.own_scales(scale) if self.sizes else scale
        return replace(report, case=report.case.redrawn({self.scale: own * enlarged}), area=Area(enlarged=ENLARGED))

    def own_scales(self, scale: float) -> np.ndarray:
        """The scale at each position at which what it shows is not larger than 1/scale (m)."""
        largest = max(self.sizes)
        return np.array([nice_up(max(one, UNLOADED * largest) * scale / PER_MM) * PER_MM for one in self.sizes])

    @property
    def has_own_scales(self) -> bool:
        """Whether its plates share a size on paper, from which each has a scale of its own."""
        return self.scale == CURVE or bool(self.sizes)


def all_series(report: Report) -> list[Series]:
    """The series of a report's plates in the order of the work."""
    return [*_kinematics(report), *(_forces(report) if report.has_forces else ())]


# --- motion


def _kinematics(report: Report) -> Iterator[Series]:
    one = partial(Series, belongs="kinematics")
    whole = _extent(report)
    yield one("scheme", layer="scheme", draw=_scheme, scale="mu.l", key="scheme", size=whole)
    yield one("positions", layer="positions", draw=_positions, scale="mu.l", size=whole)
    for what, name in NAMES.items():
        size = _on_plan(report, ids.plan_point.only(what=what), ids.scale(what))
        yield one(name, layer=name, draw=partial(_motion_plans, what=what), scale=ids.scale(what), size=size)
    for k in report.worked if report.parts("centres") else ():
        if any(centre_state(report, link, k) == "found" for link in report.plane_links):
            draw = partial(_centres, k=k)
            yield one("centres", layer="velocity", draw=draw, scale="mu.l", key="centres", size=whole)
    if report.parts("diagrams"):
        yield _curve("motion", "kinematics", motion)
    yield one("dimensions", layer="tables", draw=_dimensions, scale="mu.l")
    yield one("velocities", layer="tables", draw=_table(velocity_segments, velocities), scale="mu.v")
    yield one("accelerations", layer="tables", draw=_table(acceleration_segments, accelerations), scale="mu.a")


def _extent(report: Report, at: slice = slice(None)) -> float:
    """The largest side (m) of the box around all points of the mechanism at some positions together."""
    points = [place for point in report.analysis.motion.points.values() for place in point.p[at]]
    return _largest(extents(np.array(points)[:, None], 1))


def _largest(sizes: np.ndarray) -> float:
    return float(np.nanmax(sizes, initial=0.0))


def _on_plan(report: Report, corners: Name, scale: str) -> float:
    """The largest side (SI) of the plans with these corners, at all positions that are drawn."""
    return _largest(_on_plans(report, corners, scale)[[k - 1 for k in report.plates]])


def _on_plans(report: Report, corners: Name, scale: str) -> np.ndarray:
    """The larger side (SI) of the plan at each position [N]; nothing where the mechanism has no position."""
    families = [family for id, family in report.ledger.families.items() if id in corners]
    count = report.cycle_count
    points = [np.broadcast_to(family.values, (count,)) for family in families]
    sizes = extents([*points, np.zeros(count)], count) * report.ledger[scale].values
    found: np.ndarray = np.nan_to_num(sizes.max(axis=0))
    return found


def _place(report: Report, k: int, of: str = "") -> str:
    """Position 2, or of a part: Group (2,3), position 2."""
    word = report.words["table"]["position"]
    return f"{of}, {word.lower()} {report.machine.position(k)}" if of else f"{word} {report.machine.position(k)}"


def _scheme(report: Report) -> Iterator[Drawing]:
    yield "", scheme_scene(report, 1.0)


def _positions(report: Report) -> Iterator[Drawing]:
    yield "", positions_scene(report)


def _motion_plans(report: Report, what: What) -> Iterator[Drawing]:
    """The plans of one turn; a sheet shows no lines of construction."""
    for k in sorted({(k - 1) % report.count + 1 for k in report.plates}):
        drawing = motion_plan(report, what, k)
        if drawing.drawn():
            yield _place(report, k), _plain(drawing)


def _plain(drawing: Plan) -> Scene:
    return plan(drawing, enlarged=False, margin=MARGIN / 2)


def _centres(report: Report, k: int) -> Iterator[Drawing]:
    for scene in centres(report, k).scenes:
        yield _place(report, k), scene


# --- forces


def _forces(report: Report) -> Iterator[Series]:
    one, whole = partial(Series, belongs="forces", layer="forces"), _extent(report)
    if report.has_gas:
        yield one("indicator", layer="indicator", draw=_indicator, scale="mu.l", key="indicator", size=2 * whole)
    for k in report.worked_forces:
        yield one("bodies", draw=partial(_bodies, k=k), scale="mu.l", key="bodies", size=whole, steps=HALF)
    for group in reversed(report.groups):
        if group.polygon is not None:
            yield _plans_of(report, group.polygon, str(group))
    if report.driver_polygon is not None:
        yield _plans_of(report, report.driver_polygon, "")
    for k in report.worked_forces:
        size = _on_plan(report, ids.plan_point.only(what="v"), "mu.v")
        yield one("lever", draw=partial(_lever, k=k), scale="mu.v", key="lever", size=size)
    yield _curve("torque", "forces", torque)
    if report.loads_crank and report.driver.centre and report.parts("polar"):
        yield _curve("polar", "forces", polar)
    if report.flywheel is not None:
        yield _curve("flywheel-torque", "forces", flywheel_torque)
        yield _curve("flywheel-work", "forces", flywheel_work)
        if report.has_reduced_inertia:
            yield _curve("wittenbauer", "forces", wittenbauer)
        if report.needs_flywheel and report.parts("flywheel-speed"):
            yield _curve("flywheel-speed", "forces", flywheel_speed)
    for name, columns in (("loads", (gas, applied, inertia)), ("reactions", (reactions,)), ("balance", (balance,))):
        yield one(name, layer="tables", draw=_table(*columns, cycle=True))


def _plans_of(report: Report, polygon: Polygon, group: str) -> Series:
    """The force plans of one group at all positions, each at its own scale; the driver has no name.

    Forces of combustion are many times those of the other strokes: at one scale those would be points.
    """
    scale = ids.force_scale(polygon.name)

    def drawings(report: Report) -> Iterator[Drawing]:
        for k in report.plates:
            drawing = force_plan(report, polygon, k)
            if drawing.drawn():
                yield _place(report, k, _of(report, group)), _plain(drawing)

    sizes = _on_plans(report, ids.force_corner.only(group=polygon.name), scale)
    return Series(
        "forces",
        belongs="forces",
        layer="forces",
        draw=drawings,
        scale=scale,
        key="own",
        size=1.0,
        steps=FINE,
        sizes=tuple(sizes.tolist()),
    )


def _of(report: Report, group: str) -> str:
    words = report.words["figure"]
    return str(words["group"]).format(i=group[0], j=group[1]) if group else str(words["driver"])


def _indicator(report: Report) -> Iterator[Drawing]:
    yield "", indicator(report).scenes[0]


def _bodies(report: Report, k: int) -> Iterator[Drawing]:
    for group in reversed(report.groups):
        if group.polygon is not None:
            for scene in separated(report, k, group):
                yield _place(report, k, scene.title), scene
    yield _place(report, k, _of(report, "")), separated_driver(report, k)


def _lever(report: Report, k: int) -> Iterator[Drawing]:
    yield _place(report, k), lever(report, k).scenes[0]


def applied(report: Report) -> list[str]:
    """The loads other than of gas."""
    return report.known(load.name for load in report.loads)


# --- curves and tables


def _curve(name: str, belongs: Set, draw: Callable[[Report], FigureScenes]) -> Series:
    """A figure with curves, whose height can be chosen."""

    def drawings(report: Report) -> Iterator[Drawing]:
        for scene in draw(report).scenes:
            yield scene.title, scene

    return Series(name, belongs=belongs, layer="curves", draw=drawings, scale=CURVE, key=name, size=1.0, steps=FINE)


def _table(*listed: Callable[[Report], Sequence[str]], cycle: bool = False) -> Callable[[Report], Iterator[Drawing]]:
    """Quantities at the positions of one turn or of the cycle, as many tables as they need."""

    def drawings(report: Report) -> Iterator[Drawing]:
        at = report.all_positions if cycle else report.positions
        found = dict.fromkeys(id for columns in listed for id in columns(report))
        shown = [id for id in found if not all(report.is_zero(id, k) for k in at)]
        while shown:
            count = _columns(report, shown, at)
            for some in report.form.broken(at):
                yield "", grid(*_quantities(report, shown[:count], some))
            shown = shown[count:]

    return drawings


def _columns(report: Report, quantities: Sequence[str], positions: Sequence[int]) -> int:
    """How many of the quantities a table has room for, beside the column of positions."""
    head, rows = _quantities(report, quantities, positions)
    right = accumulate(widths([*head, *rows]))
    return max(sum(ENLARGED * one <= report.form.widest for one in right) - 1, 1)


def _quantities(
    report: Report, quantities: Sequence[str], positions: Sequence[int]
) -> tuple[list[list[Content]], list[list[Content]]]:
    """The head of a table of quantities and its rows."""
    head: list[list[Content]] = [
        [report.words["table"]["position"], *(report.ledger.symbol(id) for id in quantities)],
        ["", *(_unit(report, id) for id in quantities)],
    ]
    return head, [[str(report.machine.position(k)), *(_bare(report, id, k) for id in quantities)] for k in positions]


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


def _dimensions(report: Report) -> Iterator[Drawing]:
    """True lengths with those drawn at the scale of the position plan."""
    ledger, words = report.ledger, report.words["plates"]
    rows = [
        [ledger.symbol(id), _bare(report, id, None), _unit(report, id), _bare(report, ids.drawn(line), None)]
        for id, line in ((ids.length(line), line) for line in report.drawn_lines)
    ]
    if rows:
        yield "", grid([words["dimension-heads"]], rows)


# --- the plates of a report as they are drawn -----------------------------------------------------
# And about how large they would be at other scales.

FITTING = 0.985
"""What of a drawn plate is measured by its scale; the rest are heads of arrows and marks."""


@dataclass(frozen=True, slots=True)
class _Plate:
    """A plate as it was drawn at a scale, without its heading: its geometry grows with a finer scale, letters do not.

    `printed` are the scales that it shows; those of a plate that has its own are made round for a size on paper.
    """

    place: str
    scene: Scene
    geometry: complex
    printed: tuple[float, ...]

    @classmethod
    def of(cls, place: str, drawn: Scene) -> _Plate:
        scene = lettered(drawn)
        low, high = bounds(item for item in scene.items if not isinstance(item, Label))
        return cls(place, scene, high - low, tuple(_printed(scene)))

    def finer(self, times: float) -> Scene:
        """About what it is at a scale so many times as fine."""
        return self._grown(complex(times, times))

    def sized(self, width: float, height: float) -> Scene:
        """About what it is at the largest round scales with which its geometry fits a width and a height (mm)."""
        across, up = self.printed[0], self.printed[-1]
        size = self.geometry * FITTING
        if len(self.printed) > 1:
            finer = (across / nice_up(across * size.real / width), up / nice_up(up * size.imag / height))
            return self._grown(complex(*finer))
        times = across / nice_up(across * max(size.real / width, size.imag / height))
        return self._grown(complex(times, times))

    def _grown(self, times: complex) -> Scene:
        wide, high = self.geometry.real * (times.real - 1), self.geometry.imag * (times.imag - 1)
        return Scene(self.scene.width + wide, self.scene.height + high)


def _printed(scene: Scene) -> Iterator[float]:
    for item in scene.items:
        match item:
            case Label(_, Chain((Symbol("μ"), Number(value)))):
                yield value


@dataclass
class Plates:
    """The plates of a report, each drawn once at each scale that is asked for, for any size of paper."""

    report: Report
    series: Sequence[Series]
    _drawn: dict[tuple[int, Form, float], list[_Plate]] = field(default_factory=dict)

    @classmethod
    def of(cls, report: Report) -> Plates:
        return cls(report, all_series(report))

    def of_sets(self, sets: Collection[str]) -> list[int]:
        """The numbers of the series of some sets, of all if none is named."""
        return [index for index, one in enumerate(self.series) if not sets or one.belongs in sets]

    def form(self, index: int, form: Form) -> Form:
        """What of a form matters to a series, so that what does not is not drawn anew for it."""
        one = self.series[index]
        if one.layer == "tables":
            return form
        return Form(shape=form.shape) if one.scale == CURVE else USUAL_FORM

    def draw(self, index: int, scale: float, form: Form) -> list[_Plate]:
        """The plates of a series at a scale, tables in a form."""
        one, form = self.series[index], self.form(index, form)
        key = index, form, scale
        if key not in self._drawn:
            report = one.to_scale(replace(self.report, form=form), scale)
            self._drawn[key] = [_Plate.of(place, scene) for place, scene in one.draw(report)]
        return self._drawn[key]


@dataclass
class Estimates:
    """About how large plates are, from those that one search has seen drawn: no other one changes its result."""

    plates: Plates
    _seen: dict[tuple[int, Form], dict[float, list[_Plate]]] = field(default_factory=dict)
    _estimated: dict[tuple[int, Form, float], list[tuple[str, Scene]]] = field(default_factory=dict)

    def draw(self, index: int, scale: float, form: Form) -> list[_Plate]:
        """The plates of a series as they are; the next estimates are made from them."""
        seen = self._seen.setdefault((index, self.plates.form(index, form)), {})
        if scale not in seen:
            seen[scale] = self.plates.draw(index, scale, form)
            for key in [key for key in self._estimated if key[0] == index]:
                del self._estimated[key]
        return seen[scale]

    def estimate(self, index: int, scale: float, form: Form) -> list[tuple[str, Scene]]:
        """Places and plates about as large as they will be, from those drawn at the next scale."""
        one, form = self.plates.series[index], self.plates.form(index, form)
        key = index, form, scale
        if key not in self._estimated:
            seen = self._seen.get((index, form)) or {scale: self.draw(index, scale, form)}
            at = min(seen, key=lambda other: abs(math.log(other / scale)) if scale else 0.0)
            self._estimated[key] = [(plate.place, _estimated(plate, one, at, scale, form.shape)) for plate in seen[at]]
        return self._estimated[key]


def _estimated(plate: _Plate, one: Series, at: float, scale: float, shape: float) -> Scene:
    if at == scale or not one.size:
        return plate.scene
    if one.has_own_scales and plate.printed:
        size = PER_MM / scale
        return plate.sized(shape * size if one.scale == CURVE else size, size)
    return plate.finer(at / scale)
