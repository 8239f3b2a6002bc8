"""A planetary train as a case: what every output of it is made of; its page and its drawing sheet."""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from reportgen.drawing import Circle, Line, Pen, style
from reportgen.drawing.film import BarScale, Carried, Errors, Film, MomentValue, MovingItem, Stage, Track, extent
from reportgen.drawing.sheet import DrawingSheet
from reportgen.formula import ids, vocabulary
from reportgen.formula.sheet import Family
from reportgen.formula.vocabulary import KINDS
from reportgen.gears import train_views
from reportgen.gears.train import Train, turned
from reportgen.gears.train_drawings import radii, toothed
from reportgen.gears.train_solution import OTHER, SolvedTrain
from reportgen.report import Document
from reportgen.report.case import Key

if TYPE_CHECKING:
    from reportgen.drawing import Item

SAMPLES = 360
FILMED = 110.0
"""What the wheels may fill on a page (mm)."""
SHOWN_SETS = 500
"""So many of the tooth numbers that are found stand in the results."""


@dataclass(frozen=True)
class TrainCase(SolvedTrain):
    """A planetary train, as a `Case`."""

    @property
    def families(self) -> Mapping[str, Family]:
        return self.ledger.families

    @property
    def positions_of_a_turn(self) -> int:
        return 1

    @property
    def balance(self) -> None:
        """It has no forces."""

    def fault(self) -> str:
        return "" if self.choice.free[self.choice.first] else "train-shift"

    def document(self) -> Document:
        return self.bounded(train_views.report)

    def key(self) -> Key:
        from reportgen.marking.key import make_key

        return make_key(self, self.ledger, self.printed, sense_of=self._sense)

    def _sense(self, id: str) -> str:
        family = self.ledger[id]
        return str(next(vocabulary.words_of(self.words["positive"], id, family.kind, family.symbol), ""))

    def task(self, key: Key, by_section: bool = False) -> Document:
        return self.bounded(partial(train_views.task, key=key, by_section=by_section))

    def results(self) -> dict[str, Any]:
        """All tooth numbers that fulfil the conditions, by size; the chosen ones, their ratio and their rates."""
        from reportgen.marking.results import results

        found = self.choice
        omega = {id.rpartition(".")[2]: self.ledger[id].at(1) for id in self.ledger.families if id in ids.train_omega}
        shown = range(min(len(found.sets), SHOWN_SETS))
        sets = [{**_told(found.train(n)), "unshifted": bool(found.free[n])} for n in shown]
        return results(
            self,
            [{"number": 1, "wheels": {wheel: {"omega": float(rate)} for wheel, rate in omega.items()}}],
            train={**_told(self.train), "satellites": self.given.k, "possible": list(self.train.satellites)},
            found=len(found.sets),
            sets=sets,
        )

    # --- the page

    def film(self) -> Film:
        """One turn of the carrier, however many the wheels make of it."""
        knots = np.linspace(0, math.tau, SAMPLES + 1)
        stage = self._stage(knots)
        a = radii(self)["H"] * self._at
        sagitta = a * (1 - math.cos(math.pi / SAMPLES))
        return Film(
            knots=np.degrees(knots),
            turns=1,
            span=0.0,
            positions=(("1", 0.0),),
            shown=0,
            stages=(stage,),
            charts=(),
            values=tuple(self._values()),
            errors=Errors(sagitta, a, 0.0),
        )

    @property
    def _at(self) -> float:
        """Millimetres of the drawing for a metre."""
        r = radii(self)
        return FILMED / 2 / max(r["1"], r["3"], r["H"] + max(r["2"], r[OTHER]))

    def _stage(self, knots: np.ndarray) -> Stage:
        train, r, at = self.train, radii(self), self._at
        z, (inner1, inner3) = train.teeth, self.scheme.inner
        sense = math.copysign(1, self.ledger[ids.train_omega("H")].at(1))
        θ = sense * knots
        one, satellite = train.omega(1.0, float(train.ratio))
        still, placed = turned(train, self.given.k)
        items: list[MovingItem] = []
        centre = Track(np.zeros(1, complex))

        def marked(teeth: int, wheel: str, inner: bool = False) -> tuple[Item, ...]:
            radius = r[wheel] * at
            pen = Pen(0.35, style.RED)
            mark = Line(complex(radius * (1 if inner else 0.25), 0), complex(radius * (1.08 if inner else 0.8), 0), pen)
            rim = (Circle(0j, radius * 1.08 + 2, style.VISIBLE),) if inner else ()
            return (*rim, toothed(teeth, radius, inner), mark)

        fixed = Track(np.array([still]))
        items += [Carried(marked(z.three, "3", True), centre, fixed)] * inner3
        items += [Carried(marked(z.one, "1", True), centre, Track(one * θ))] * inner1
        for number, ψ in enumerate(placed):
            assert ψ is not None, "it can be assembled"
            γ = number * math.tau / self.given.k
            place = Track(r["H"] * at * np.exp(1j * (γ + θ)))
            wheels = [("2", z.two)] if self.scheme.single else [("2", z.two), (OTHER, z.other)]
            # The larger wheel is drawn below the smaller one.
            for wheel, teeth in sorted(wheels, key=lambda pair: -r[pair[0]]):
                items.append(Carried(marked(teeth, wheel), place, Track(ψ + satellite * θ)))
        for inner, wheel, teeth, angle in ((inner3, "3", z.three, fixed), (inner1, "1", z.one, Track(one * θ))):
            if not inner:
                items.append(Carried(marked(teeth, wheel), centre, angle))
        arms = [r["H"] * at * cmath.rect(1, number * math.tau / self.given.k) for number in range(self.given.k)]
        arm = tuple(part for tip in arms for part in (Line(0j, tip, Pen(0.6, style.RED)), style.joint(tip)))
        items += [Carried((*arm, style.joint(0j)), centre, Track(θ))]
        low, high = extent(items)
        return Stage("train", self.title, tuple(items), low=low, high=high, scales=(BarScale(1 / at, "segment"),))

    def _values(self) -> Iterator[MomentValue]:
        for id in self.ledger.families:
            if id in ids.train_omega:
                number = self.printed.number(id)
                shown = self.ledger[id].at(1) / KINDS["angular velocity"].scale
                yield MomentValue(self.ledger.symbol(id), number.unit, Track(np.array([shown])), number.decimals or 2)

    # --- sheets

    def sheets(self, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[DrawingSheet]:
        return train_views.drawing_sheets(self, size, block)


def _told(train: Train) -> dict[str, Any]:
    z = train.teeth
    return {"z": [z.one, z.two, z.other, z.three], "ratio": float(train.ratio)}
