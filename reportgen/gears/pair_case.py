"""`PairCase`: a gear pair with its documents, key, results, animation and drawing sheets."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.units import MM
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.drawing import Circle, Line, Pen, Polyline, Scene, style
from reportgen.drawing.animation import (
    Animation,
    BarScale,
    Errors,
    MomentValue,
    MovingBody,
    MovingItem,
    MovingName,
    Pane,
    Still,
    Track,
    extent,
)
from reportgen.drawing.charts import Area
from reportgen.drawing.drawing_description import PaperLength, fact
from reportgen.drawing.drawing_sheet import DrawingSheet, PlacedScene, lettered
from reportgen.drawing.figure_scale import FigureSize
from reportgen.drawing.plates import MOST_STEPS, DrawingPlate, enlargeable
from reportgen.formula import Symbol
from reportgen.gears import gears_ids, pair_views
from reportgen.gears.pair_drawings import (
    FLANK,
    HIGHEST,
    centre,
    mesh,
    mesh_scale,
    on_line,
    region,
    sliding,
    tooth,
    turned,
)
from reportgen.gears.pair_formulas import WHEELS
from reportgen.gears.pair_ledger import SolvedPair
from reportgen.gears.pair_shifts import GearPair
from reportgen.sheets.plates import drawn, on_sheet


@dataclass(frozen=True)
class PairCase(SolvedPair):
    """A solved gear pair, as a `Case`."""

    PAGE = pair_views.PairPage

    def fault(self) -> str:
        return "gear-limits" if any(self.chosen.broken()) else ""

    @property
    def shafts(self) -> Sequence[Shaft]:
        """Return the two shafts, without a speed: wheels of an external mesh turn in opposite senses."""
        return tuple(Shaft(name, None, turn) for name, turn in zip(self.words["pair"]["shafts"], (1, -1), strict=True))

    @cached_property
    def entries(self) -> ResultEntries:
        """Return the pair and its wheels, then contact and sliding at the points of the active path from its
        beginning.
        """
        ledger = self.ledger
        own = sorted({parts["quantity"] for id in ledger.families if (parts := gears_ids.of_wheel.read(id))})
        single = [one for one in own if len(ledger[gears_ids.of_wheel(one, 1)].values) == 1]
        wheels = [{one: ledger[gears_ids.of_wheel(one, wheel)].values[0] for one in single} for wheel in WHEELS]
        pair = {
            id.removeprefix("gears."): family.values[0]
            for id, family in ledger.families.items()
            if not gears_ids.of_wheel.read(id) and len(family.values) == 1
        }
        along = ("rho.1", "rho.2", "lambda.1", "lambda.2")
        positions = [
            {"number": k + 1, "contact": {one: ledger[f"gears.{one}"].values[k] for one in along}}
            for k in range(self.count)
        ]
        broken = [{"check": name, "wheel": wheel} for name, wheel, _, _ in self.chosen.broken()]
        return ResultEntries(positions, {"pair": pair, "wheels": wheels, "broken": broken})

    def animations(self) -> tuple[Animation, ...]:
        return (_animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the drawings; there are no sets to choose from."""
        return {"pair": list(_plates(self))}

    def true_sizes(self) -> Sequence[DrawingSheet]:
        return [_true_size(self, number) for number in (0, 1)]


# --- the animation ---------------------------------------------------------------------

SAMPLES = 720
FILM_ROOM = 120 + 110j
"""Largest width and height of both wheels (mm)."""
NEAR_ROOM, PITCHES = 90.0, 4.0
"""Width (mm) of the enlarged mesh, and the number of pitches that it shows."""
SHARP = 0.02
"""Largest error of polylines in the enlarged mesh (mm)."""


def _animation(case: PairCase) -> Animation:
    """Return both wheels over a turn of wheel 1, starting with contact at the pitch point, and their mesh enlarged."""
    pair = case.gears
    φ = np.linspace(0, 2 * math.pi, SAMPLES + 1)
    size = complex(pair["d_a"].max(), float(pair["a_w"]) + pair["d_a"].sum() / 2) * MM
    at = MM / max(size.real / FILM_ROOM.real, size.imag / FILM_ROOM.imag)
    whole, touching = _moving(pair, φ, at)
    low, high = extent(whole)
    near = NEAR_ROOM / (PITCHES * math.pi * pair.m)
    half = NEAR_ROOM / 2 * (1 + 0.8j)
    panes = [Pane("pair", case.title, tuple(whole), low=low, high=high, scales=(BarScale(1 / at, "segment"),))]
    if near > at:
        close, _ = _moving(pair, φ, near)
        scale = BarScale(1 / near, "segment")
        panes.append(Pane("mesh", str(case.words["pair"]["near"]), tuple(close), low=-half, high=half, scales=(scale,)))
    ratio = pair.teeth[0] / pair.teeth[1]
    return Animation(
        units=case.ledger.units,
        knots=np.degrees(φ),
        turns=1,
        span=0.0,
        positions=(("1", 0.0),),
        opening=0,
        panes=tuple(panes),
        charts=(),
        values=(
            MomentValue(Symbol("φ", "2"), "°", Track(np.degrees(ratio * φ)), 2),
            MomentValue(str(case.words["pair"]["touching"]), "", Track(touching), 0),
        ),
        # Angles and travel along the line of action are linear over a turn, so interpolation between samples is exact.
        errors=Errors(SHARP, float(pair["d_w"][0]) / 2 * at, 0.0),
    )


def _moving(pair: GearPair, φ: Floats, at: float) -> tuple[list[MovingItem], Floats]:
    """Return wheels, line of action and points of contact at angles φ [N] (rad), and how many pairs touch [N].

    `at` is the scale, in mm of paper per m.
    """
    at_pitch = float(pair.to_pitch_point[0])
    ratio = pair.teeth[0] / pair.teeth[1]
    items: list[MovingItem] = []
    for number, turns in ((0, φ), (1, -ratio * φ)):
        o, wheel = centre(pair, number) * at, pair.wheel(number)
        mark = Line(0j, 0.8 * wheel.r_f * at + 0j, style.THIN)
        body = Polyline(tuple(wheel.outline(SHARP / at) * at), FLANK, closed=True, fill=style.TINT)
        place = Track(np.array([o]))
        items += [
            MovingBody((body, mark), place, Track(turned(pair, number, at_pitch) + turns)),
            Still((Circle(o, float(pair["d_w"][number]) / 2 * at, style.THIN), *style.pivot(o))),
            MovingName(Symbol("O", str(number + 1)), place, (Track(np.array([o - 5j])),), 1.6),
        ]
    ends = [on_line(pair, rolled) * at for rolled in (0.0, float(pair["g"]))]
    items.append(Still((Line(ends[0], ends[1], style.NORMAL),)))
    start, end = float(pair["rho_p"][0]), float(pair["rho_a"][0])
    slots = math.ceil(float(pair["epsilon"]))
    touching = np.zeros(φ.size)
    for slot in range(slots):
        # Each tooth is in contact on the active path, and out of contact for the rest of its period.
        along = np.mod(float(pair["d_b"][0]) / 2 * φ + at_pitch - start + slot * pair["p_b"], slots * pair["p_b"])
        touching += along <= end - start
        places = np.array([on_line(pair, start + one) * at for one in along])
        visible = Track(np.where(along <= end - start, places, complex(np.nan, np.nan)))
        items.append(MovingBody((Circle(0j, 0.8, None, style.RED),), visible))
    return items, touching


DrawPair = Callable[[PairCase, FigureSize], Scene]


# --- drawing sheets ---------------------------------------------------------------------------------

AREAS = ((90.0, 80.0), (120.0, 110.0), (180.0, 150.0))
"""Areas of the curves of sliding and the diagram of shifts (mm), the smallest first."""
MARGIN = 15.0
"""Margin around a wheel in true size (mm)."""
AXES = Pen(0.18, style.GRAY, (5.0, 1.0, 0.8, 1.0))


def _plates(case: PairCase) -> Iterator[DrawingPlate]:
    """Yield the plates: the mesh, the curves, the tables."""
    captions, page = case.words["pair"]["captions"], pair_views.PairPage(case)

    def of_area(draw: Callable[[PairCase, Area], Scene]) -> DrawPair:
        return lambda case, size: draw(case, Area(*AREAS[size.steps], size.enlarged, mm=case.ledger.printed_unit("mm")))

    def plate(name: str, layer: str, draw: DrawPair, steps: int) -> DrawingPlate:
        return DrawingPlate(str(captions[f"figure-{name}"]), (), layer, (lettered(draw(case, on_sheet(case, steps))),))

    drawings: list[tuple[str, str, DrawPair, int]] = [
        ("mesh", "profile", mesh, _mesh_steps(case)),
        ("sliding", "curves", of_area(lambda case, area: sliding(case, area).scene), len(AREAS) - 1),
        ("region", "scheme", of_area(region), len(AREAS) - 1),
    ]
    for name, layer, draw, most in drawings:
        yield enlargeable(partial(plate, name, layer, draw), most)
    for name, table, spare in (("pair", page.pair_table, False), ("checks", page.checks, True)):
        scene = drawn(table, case.assignment.language)
        yield DrawingPlate(str(captions[name]), (), "tables", (scene,), spare=spare)


def _mesh_steps(case: PairCase) -> int:
    """Return how many standard scales larger than in the report the mesh may be: a tooth is at most `HIGHEST` high."""
    usual, _ = mesh_scale(case)
    sizes = (on_sheet(case, steps).scale(usual) for steps in range(1, MOST_STEPS + 1))
    return sum(tooth(case) / scale <= HIGHEST for scale in sizes)


def _true_size(case: PairCase, number: int) -> DrawingSheet:
    """Return a drawing sheet with a wheel 1:1 with its axes, one tooth upright, on paper as large as it needs."""
    outline = case.gears.wheel(number).outline() * 1j * MM
    half = math.ceil(float(np.abs(outline).max()) + MARGIN)
    middle, size = half * (1 + 1j), 2.0 * half
    axes = (Line(1j * half, size + 1j * half, AXES), Line(half + 0j, half + 1j * size, AXES))
    profile = Polyline(tuple(outline + middle), style.HEAVY, closed=True, smooth=True)
    farthest = fact("profile", PaperLength(float(np.abs(outline).max())))
    parts = (
        PlacedScene("axes", "axes", Scene(size, size, axes)),
        PlacedScene("profile", "profile", Scene(size, size, (profile,), description=(farthest,))),
    )
    return DrawingSheet(f"1:1 ({WHEELS[number]})", size, size, parts)
