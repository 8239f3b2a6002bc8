"""The plates of a report as they are drawn, and about how large they would be at other scales."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace

from reportgen.document.plates import CURVE, Series, all_series
from reportgen.document.report import Report
from reportgen.figures.geometry import bounds
from reportgen.figures.grid import USUAL_FORM, Form
from reportgen.figures.lettering import lettered
from reportgen.figures.scene import Label, Scene
from reportgen.ledger.scales import PER_MM
from reportgen.notation.expressions import Chain, Number, Symbol
from reportgen.notation.numbers import nice_up

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
