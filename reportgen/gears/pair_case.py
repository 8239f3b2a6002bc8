"""A gear pair as a case: its documents, key, results, the page on which it turns, and its drawing sheets."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from reportgen.base.units import MM
from reportgen.drawing import Circle, Content, Line, Polyline, Scene, style
from reportgen.drawing.film import (
    BarScale,
    Carried,
    Errors,
    Film,
    MomentValue,
    MovingItem,
    MovingName,
    Stage,
    Still,
    Track,
    extent,
)
from reportgen.drawing.geometry import moved
from reportgen.drawing.sheet import ENLARGED, GAP, DrawingSheet, grid
from reportgen.formula import Symbol, ids, vocabulary
from reportgen.formula.plain import formula
from reportgen.formula.sheet import Family
from reportgen.gears import pair_views as views
from reportgen.gears.involute import Floats
from reportgen.gears.pair import GearPair
from reportgen.gears.pair_drawings import FLANK, FRAME, MESH_ROOM, centre, mesh, on_line, region, sliding, turned
from reportgen.gears.pair_solution import WHEELS, SolvedPair
from reportgen.report import Document, InlineMath, Inlines, Value
from reportgen.report.case import Key, Span
from reportgen.sheets.columns import Plate, in_columns, titled, true_size


@dataclass(frozen=True)
class PairCase(SolvedPair):
    """A gear pair, as a `Case`."""

    @property
    def families(self) -> Mapping[str, Family]:
        return self.ledger.families

    @property
    def positions_of_a_turn(self) -> int:
        return self.count

    @property
    def balance(self) -> None:
        """It has no forces."""

    @property
    def speed(self) -> None:
        """It has no speed."""

    def fault(self) -> str:
        return next((f"gear-{name}" for name, *_ in self.chosen.broken()), "")

    def document(self) -> Document:
        return self.bounded(views.report)

    def key(self) -> Key:
        from reportgen.marking.key import make_key

        labels = tuple(map(str, range(1, self.count + 1)))
        return make_key(self, self.ledger, self.printed, Span(labels, self.count, self.worked), self._sense)

    def _sense(self, id: str) -> str:
        family = self.ledger[id]
        return str(next(vocabulary.words_of(self.words["positive"], id, family.kind, family.symbol), ""))

    def task(self, key: Key, by_section: bool = False) -> Document:
        return self.bounded(partial(views.task, key=key, by_section=by_section))

    def results(self) -> dict[str, Any]:
        """The pair and its wheels, then contact and sliding along the active path, from its beginning on."""
        from reportgen.marking.results import results

        ledger = self.ledger
        own = sorted({parts["quantity"] for id in ledger.families if (parts := ids.gear.read(id))})
        single = [one for one in own if len(ledger[ids.gear(one, 1)].values) == 1]
        wheels = [{one: float(ledger[ids.gear(one, wheel)].values[0]) for one in single} for wheel in WHEELS]
        pair = {
            id.removeprefix("gears."): float(family.values[0])
            for id, family in ledger.families.items()
            if not ids.gear.read(id) and len(family.values) == 1
        }
        along = ("rho.1", "rho.2", "lambda.1", "lambda.2")
        positions = [
            {"number": k + 1, "contact": {one: float(ledger[f"gears.{one}"].values[k]) for one in along}}
            for k in range(self.count)
        ]
        broken = [{"check": name, "wheel": wheel} for name, wheel, _, _ in self.chosen.broken()]
        return results(self, positions, pair=pair, wheels=wheels, broken=broken)

    def film(self) -> Film:
        return _film(self)

    def sheets(self, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[DrawingSheet]:
        return _drawing_sheets(self, size, block)


# --- the page on which it turns ---------------------------------------------------------------------

SAMPLES = 720
FILM_ROOM = 120 + 110j
"""What both wheels may fill (mm)."""
NEAR_ROOM, PITCHES = 90.0, 4.0
"""The mesh from near: so wide (mm), with so many pitches across."""
SHARP = 0.02
"""How far their polylines may be off there (mm)."""


def _film(case: PairCase) -> Film:
    """Both wheels through a turn of wheel 1, from contact at the pitch point, and their mesh from near."""
    pair = case.gears
    φ = np.linspace(0, 2 * math.pi, SAMPLES + 1)
    size = complex(pair.d_a.max(), float(pair.a_w) + pair.d_a.sum() / 2) * MM
    at = MM / max(size.real / FILM_ROOM.real, size.imag / FILM_ROOM.imag)
    whole, touching = _moving(pair, φ, at)
    low, high = extent(whole)
    near = NEAR_ROOM / (PITCHES * math.pi * pair.m)
    half = NEAR_ROOM / 2 * (1 + 0.8j)
    stages = [Stage("pair", case.title, tuple(whole), low=low, high=high, scales=(BarScale(1 / at, "segment"),))]
    if near > at:
        close, _ = _moving(pair, φ, near)
        scale = BarScale(1 / near, "segment")
        stages.append(
            Stage("mesh", str(case.words["pair"]["near"]), tuple(close), low=-half, high=half, scales=(scale,))
        )
    ratio = pair.teeth[0] / pair.teeth[1]
    return Film(
        knots=np.degrees(φ),
        turns=1,
        span=0.0,
        positions=(("1", 0.0),),
        shown=0,
        stages=tuple(stages),
        charts=(),
        values=(
            MomentValue(Symbol("φ", "2"), "°", Track(np.degrees(ratio * φ)), 2),
            MomentValue(str(case.words["pair"]["touching"]), "", Track(touching), 0),
        ),
        # Angles and the way along the line of action are straight over a turn: nothing is lost between samples.
        errors=Errors(SHARP, float(pair.d_w[0]) / 2 * at, 0.0),
    )


def _moving(pair: GearPair, φ: Floats, at: float) -> tuple[list[MovingItem], Floats]:
    """Wheels, line of action and points of contact, so many mm of paper a metre; and how many pairs touch."""
    at_pitch = float(pair.d_b[0]) / 2 * math.tan(float(pair.alpha_w))
    ratio = pair.teeth[0] / pair.teeth[1]
    items: list[MovingItem] = []
    for number, turns in ((0, φ), (1, -ratio * φ)):
        o, wheel = centre(pair, number) * at, pair.wheel(number)
        mark = Line(0j, 0.8 * wheel.r_f * at + 0j, style.THIN)
        body = Polyline(tuple(wheel.outline(SHARP / at) * at), FLANK, closed=True, fill=style.TINT)
        place = Track(np.array([o]))
        items += [
            Carried((body, mark), place, Track(turned(pair, number, at_pitch) + turns)),
            Still((Circle(o, float(pair.d_w[number]) / 2 * at, style.THIN), *style.pivot(o))),
            MovingName(Symbol("O", str(number + 1)), place, (Track(np.array([o - 5j])),), 1.6),
        ]
    ends = [on_line(pair, rolled) * at for rolled in (0.0, float(pair.path))]
    items.append(Still((Line(ends[0], ends[1], style.NORMAL),)))
    start, end = float(pair.rho_p[0]), float(pair.rho_a[0])
    slots = math.ceil(float(pair.epsilon))
    touching = np.zeros(φ.size)
    for slot in range(slots):
        # Each of so many teeth is in contact on the active path, and out of it for the rest of its period.
        along = np.mod(float(pair.d_b[0]) / 2 * φ + at_pitch - start + slot * pair.p_b, slots * pair.p_b)
        touching += along <= end - start
        places = np.array([on_line(pair, start + one) * at for one in along])
        shown = Track(np.where(along <= end - start, places, complex(np.nan, np.nan)))
        items.append(Carried((Circle(0j, 0.8, None, style.RED),), shown))
    return items, touching


# --- drawing sheets ---------------------------------------------------------------------------------

USUAL_SIZES = ("A2", "A1", "A0")
LARGER = {"A3": 0.7, "A2": 1.0, "A1": 1.4, "A0": 2.0}
"""How many times as large plates are on a sheet as on one of size A2."""
SHARES = (2.4, 2.0, 1.7, 1.4, 1.2, 1.0, 0.8)
"""So many times as large meshes are tried."""


def _drawing_sheets(case: PairCase, size: str, block: Path | None) -> list[DrawingSheet]:
    """The pair with its tables and curves, and each wheel in true size.  Raises `SheetError` without room."""
    wanted = size or case.assignment.report.sheets or ""

    def drawn(paper: str) -> Iterator[Iterable[Plate]]:
        return (_plates(case, LARGER[paper], share) for share in SHARES)

    title = str(case.words["pair"]["sheet"])
    sheet = in_columns(case, title, (wanted,) if wanted else USUAL_SIZES, block, drawn, "gear_sheet")
    wheels = [true_size(case.gears.wheel(i).outline() * 1j, f"1:1 ({WHEELS[i]})") for i in (0, 1)]
    return [sheet, *wheels]


def _plates(case: PairCase, larger: float, share: float) -> Iterator[Plate]:
    captions, page = case.words["pair"]["captions"], views.PairPage(case)
    room = share * larger * MESH_ROOM / ENLARGED
    λ = titled(sliding(case, half=larger <= 1).scene, str(captions["figure-sliding"]))
    shifts = titled(region(case, 0.6 * larger * FRAME), str(captions["figure-region"]))
    yield "mesh", "profile", titled(mesh(case, room, ENLARGED), str(captions["figure-mesh"]))
    yield "curves", "curves", _side_by_side(λ, shifts)
    for name, table in (("pair", page.pair_table), ("checks", page.checks)):
        cells = [[_content(case, cell.inlines) for cell in row] for row in (*table.head, *table.rows)]
        yield name, "tables", titled(grid(cells[:1], cells[1:]), str(captions[name]))


def _side_by_side(left: Scene, right: Scene) -> Scene:
    items = (*left.items, *(moved(item, complex(left.width + GAP, 0)) for item in right.items))
    return Scene(left.width + GAP + right.width, max(left.height, right.height), items)


def _content(case: PairCase, inlines: Inlines) -> Content:
    """What stands in a cell, as a label has it."""
    match inlines:
        case (InlineMath(expression),):
            return expression
        case (Value(number),):
            return number
        case _:
            return "".join(
                formula(one.number, case.assignment.language) if isinstance(one, Value) else getattr(one, "text", "")
                for one in inlines
            )
