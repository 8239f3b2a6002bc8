"""The machine in motion as elements of a page, and its samples as compact data.

Everything that moves is drawn here once, about its own origin, and named by its number (`data-i`); the data say for
each number which tracks it follows.  The script of the frame does nothing but read tracks between two samples.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from reportgen.figures.geometry import frame
from reportgen.figures.moving import Carried, Chart, Film, MovingItem, Name, Stage, Still, Track, Vector
from reportgen.figures.scene import Content, Label, Stroke
from reportgen.figures.style import LABEL, SMALL
from reportgen.notation.numbers import Language, write
from reportgen.notation.vocabulary import KINDS
from reportgen.writers.drawing import HEAD_SLENDERNESS, decimal
from reportgen.writers.html import Panel
from reportgen.writers.mathml import MathmlFormulas, escape
from reportgen.writers.svg import Painter, Pens

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0)
"""Of the motion shown: shares of its usual one."""
OPEN = ("v", "a", "curves", "values")
"""What stands open below the machine from the start."""
MACHINE, PLAN = (120.0, 110.0), (75.0, 75.0)
"""What a machine and a plan take of a screen, about (mm): in a larger drawing letters and pens grow as it is reduced."""
MOST = 4.0
"""They never grow more than so many times."""
HIT = 4.0
"""How near (mm) a pointer must come to a point."""
POINTS = ("", "x", "y", "v_x", "v_y", "v", "a_x", "a_y", "a")
"""Heads of the table of a point's motion, behind that of the driver's way."""


class Tracks:
    """All tracks of a page, each once: numbers of its parts, and their values one behind the other."""

    def __init__(self) -> None:
        self._numbers: dict[bytes, int] = {}
        self.lengths: list[int] = []
        self.values: list[np.ndarray] = []

    def number(self, track: Track) -> int:
        """The number of a real track; of a complex one that of its first part, the second follows."""
        values = track.values
        parts = [values.real, values.imag] if np.iscomplexobj(values) else [values]
        packed = [np.ascontiguousarray(part, dtype="<f4") for part in parts]
        # A negative zero is nothing else than zero.
        packed = [part + np.float32(0) for part in packed]
        key = b"|".join(part.tobytes() for part in packed) + b"c" * len(packed)
        if key not in self._numbers:
            self._numbers[key] = len(self.lengths)
            self.lengths += [part.size for part in packed]
            self.values += packed
        return self._numbers[key]

    def packed(self) -> str:
        joined = np.concatenate(self.values) if self.values else np.zeros(0, dtype="<f4")
        return base64.b64encode(joined.astype("<f4").tobytes()).decode()


def panel(film: Film, language: Language, words: Mapping[str, Any]) -> Panel:
    """The panel of a machine; `words` are those of pages (`page` in `words.yaml`)."""
    return _Writer(film, language, words).panel()


class _Writer:
    def __init__(self, film: Film, language: Language, words: Mapping[str, Any]) -> None:
        self.film, self.language, self.words = film, language, words
        self.pens, self.tracks = Pens("m"), Tracks()
        self.painter, self.formulas = Painter(language, self.pens), MathmlFormulas(language)
        self.items: list[dict[str, Any]] = []
        self.grown = 1.0
        """How much larger letters, arrowheads and pens of arrows are than in figures."""

    def panel(self) -> Panel:
        film = self.film
        machine, *plans = film.stages
        spots = [
            {
                "name": spot.name,
                "at": self.tracks.number(spot.on_stage),
                "p": self.tracks.number(spot.place),
                "v": self.tracks.number(spot.velocity),
                "a": self.tracks.number(spot.acceleration),
            }
            for spot in machine.spots
        ]
        body = "\n".join(
            (
                self.head(),
                f'<div class="theatre"><div class="machine">{self.stage(machine, MACHINE)}',
                f'<div class="beside">{self.switches()}{self.point()}</div></div>',
                '<div class="plans">',
                *(self.folding(stage.key, stage.title, self.stage(stage, PLAN)) for stage in plans),
                "</div></div>",
                self.folding("values", self.words["values"], self.numbers()),
                *([self.folding("curves", self.words["curves"], self.curves())] if film.charts else []),
                f'<p class="accuracy">{escape(self.accuracy())}</p>',
            )
        )
        data = {
            "knots": [float(f"{knot:.7g}") for knot in film.knots],
            "turns": film.turns,
            "span": film.span,
            "language": self.language,
            "positions": [[label, float(f"{angle:.9g}")] for label, angle in film.positions],
            "shown": film.shown,
            "items": self.items,
            "spots": spots,
            "charts": self.chart_data,
            "values": [[self.tracks.number(value.values), value.decimals] for value in film.values],
            "heads": [self.words["way" if film.span else "angle"], *POINTS[1:]],
            "words": {key: self.words[key] for key in ("play", "pause", "keep", "release", "copied", "none")},
            "motion_of": self.words["motion_of"],
            "lengths": self.tracks.lengths,
            "tracks": self.tracks.packed(),
        }
        # In a script element "<" could end it, whatever it stands in.
        packed = json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")
        return Panel(body, self.pens.rules(), packed)

    # --- controls

    def head(self) -> str:
        words, film = self.words, self.film
        speeds = "".join(
            f'<option value="{speed:g}"{" selected" if speed == 1 else ""}>{escape(write(speed, None, self.language))}×</option>'
            for speed in SPEEDS
        )
        buttons = "".join(
            f'<button type="button" data-position="{index}" aria-label="{escape(words["at"])} {escape(label)}">'
            f"{escape(label)}</button>"
            for index, (label, _) in enumerate(film.positions)
        )
        whole = 360 * film.turns
        shown = film.positions[film.shown][1]
        about = escape(words["way" if film.span else "angle"])
        return (
            f'<h2 id="moving-title">{escape(words["moving"])}</h2>'
            f'<div class="controls"><button type="button" id="play" aria-pressed="false">{escape(words["play"])}</button>'
            f'<label>{escape(words["speed"])} <select id="speed">{speeds}</select></label>'
            f'<label class="slide"><span>{about}</span> <input id="angle" type="range" min="0" max="{whole}" step="any" '
            f'value="{shown:g}"><output id="told" for="angle"></output></label>'
            f'<button type="button" id="keep" aria-pressed="false">{escape(words["keep"])}</button></div>'
            f'<div class="positions" role="group" aria-label="{escape(words["positions"])}">{buttons}</div>'
        )

    def switches(self) -> str:
        boxes = "".join(
            f'<label><input type="checkbox" data-layer="{layer}"{" checked" if layer == "paths" else ""}> '
            f"{escape(self.words['layers'][layer])}</label>"
            for layer in self.film.layers
        )
        return f'<fieldset class="layers"><legend>{escape(self.words["show"])}</legend>{boxes}</fieldset>'

    def point(self) -> str:
        """What is told of one point, and its values over the turn."""
        words = self.words
        names = "".join(
            f'<option value="{index}">{escape(spot.name)}</option>'
            for index, spot in enumerate(self.film.stages[0].spots)
        )
        rows = "".join(
            f'<div><dt>{self.formulas.content(symbol)}</dt><dd><output data-of="{name}"></output> {escape(unit)}</dd></div>'
            for name, symbol, unit in (("v", "v", KINDS["velocity"].unit), ("a", "a", KINDS["acceleration"].unit))
        )
        return (
            f'<div class="point"><label>{escape(words["point"])} <select id="point">'
            f'<option value="">{escape(words["none"])}</option>{names}</select></label>'
            f'<dl id="motion" hidden>{rows}</dl><p id="tools" hidden>'
            f'<button type="button" id="copy">{escape(words["copy"])}</button> '
            f'<button type="button" id="save">{escape(words["save"])}</button> <span id="copied" role="status"></span></p></div>'
        )

    def folding(self, key: str, title: str, body: str) -> str:
        opened = " open" if key in OPEN or key.startswith("R") else ""
        return f'<details data-panel="{escape(key)}"{opened}><summary>{escape(title)}</summary>{body}</details>'

    def accuracy(self) -> str:
        errors = self.film.errors

        def rounded_up(value: float, digits: int = 2) -> str:
            """So many figures, never less than the value."""
            step = 10.0 ** (np.floor(np.log10(max(value, 1e-9))) - digits + 1)
            return write(float(f"{np.ceil(value / step) * step:.6g}"), None, self.language)

        return str(
            self.words["accuracy"].format(
                count=len(self.film.knots) - 1,
                place=rounded_up(errors.place),
                crank=rounded_up(100 * errors.place / errors.crank),
                share=rounded_up(100 * errors.share),
            )
        )

    # --- drawings

    def stage(self, stage: Stage, room: tuple[float, float]) -> str:
        """A drawing in the box of all that it ever shows; y is turned over by a reflection of each place."""
        low, high = stage.low, stage.high
        size = high - low
        self.grown = min(max(size.real / room[0], size.imag / room[1], 1.0), MOST)
        # Places are counted from the upper left corner.
        body = "".join(markup for item in stage.items for markup in self.item(item))
        spots = "".join(
            f'<g class="spot" data-spot="{index}" tabindex="0" role="button" '
            f'aria-label="{escape(self.words["point"])} {escape(spot.name)}"><circle r="{HIT * self.grown:.3g}"/></g>'
            for index, spot in enumerate(stage.spots)
        )
        width, height = decimal(size.real), decimal(size.imag)
        scales = ", ".join(self.formulas.content(scale) for scale in stage.scale)
        return (
            f'<figure class="stage" data-stage="{escape(stage.key)}"><svg role="group" aria-label="{escape(stage.title)}" '
            f'width="{width}mm" height="{height}mm" viewBox="{decimal(low.real)} {decimal(-high.imag)} {width} {height}">'
            f"{body}{spots}</svg>{f'<figcaption>{scales}</figcaption>' if scales else ''}</figure>"
        )

    def item(self, item: MovingItem) -> Iterator[str]:
        """The elements of an item; those that move get a number, and what they follow goes into the data."""
        layer = f' data-of-layer="{item.layer}"' if item.layer else ""
        hidden = " hidden" if item.layer and item.layer != "paths" else ""
        match item:
            case Still(items):
                if items:
                    yield f"<g{layer}{hidden}>{self.painter.items(items)}</g>" if layer else self.painter.items(items)
            case Carried(items, at, angle):
                follows = {"at": self.tracks.number(at)}
                if angle is not None:
                    follows["turn"] = self.tracks.number(angle)
                yield f"<g{self.moving(follows)}{layer}{hidden}>{self.painter.items(items)}</g>"
            case Vector(stroke=stroke, label=label):
                yield self.vector(item, stroke, label, layer + hidden)
            case Name(content, at, neighbours, gap):
                follows = {
                    "label": self.tracks.number(at),
                    "off": [self.tracks.number(one) for one in neighbours],
                    "gap": round(gap * self.grown, 3),
                    "size": self.size(content, LABEL),
                }
                text = self.painter.label(Label(0j, content, size=LABEL * self.grown))
                yield f"<g{self.moving(follows)}{layer}{hidden}>{text}</g>"

    def vector(self, item: Vector, stroke: Stroke, label: Content | None, layer: str) -> str:
        follows: dict[str, Any] = {"from": self.tracks.number(item.start), "to": self.tracks.number(item.end)}
        dash = tuple(round(part * self.grown, 3) for part in stroke.dash)
        stroke = replace(stroke, width=round(stroke.width * self.grown, 3), dash=dash)
        if item.head:
            follows |= {"head": round(item.head * self.grown, 3), "slender": HEAD_SLENDERNESS}
        if item.beyond:
            follows["beyond"] = item.beyond
        if item.name:
            follows["name"] = item.name
        parts = f'<path class="{self.pens.name(stroke)}"/>'
        if item.head:
            parts += f'<path class="{self.pens.name(None, stroke.colour)}"/>'
        if label is not None:
            follows["size"] = self.size(label, SMALL)
            parts += f"<g>{self.painter.label(Label(0j, label, size=SMALL * self.grown))}</g>"
        return f"<g{self.moving(follows)}{layer}>{parts}</g>"

    def size(self, content: Content, size: float) -> list[float]:
        """Half the width and height of a label (mm)."""
        _, half = frame(Label(0j, content, size=size * self.grown))
        return [round(half.real, 2), round(half.imag, 2)]

    def moving(self, follows: dict[str, Any]) -> str:
        self.items.append(follows)
        return f' data-i="{len(self.items) - 1}"'

    # --- numbers and curves

    def numbers(self) -> str:
        rows = "".join(
            f'<div><dt>{self.formulas.content(value.symbol)}</dt>'
            f'<dd><output data-value="{index}"></output> <span class="unit">{escape(value.unit)}</span></dd></div>'
            for index, value in enumerate(self.film.values)
        )
        return f'<dl class="numbers">{rows}</dl>'

    def curves(self) -> str:
        self.chart_data = [self.follow(chart) for chart in self.film.charts]
        return f'<div class="charts">{"".join(self.chart(index, one) for index, one in enumerate(self.film.charts))}</div>'

    def follow(self, chart: Chart) -> dict[str, Any]:
        drawn = chart.plotted
        height = drawn.scene.height
        return {
            "box": [round(v, 3) for v in (drawn.low.real, height - drawn.low.imag, drawn.high.real, height - drawn.high.imag)],
            "x": list(drawn.x),
            "y": list(drawn.y),
            "curves": [self.tracks.number(curve.values) for curve in chart.curves],
        }

    def chart(self, index: int, chart: Chart) -> str:
        scene = chart.plotted.scene
        width, height = decimal(scene.width), decimal(scene.height)
        body = self.painter.items(scene.items, scene.height)
        dots = "".join('<circle class="dot" r="1.1"/>' for _ in chart.curves)
        cursor = '<path class="cursor"/>'
        outputs = "".join(
            f'<span>{self.formulas.content(curve.label)} = <output data-curve="{number}"></output></span> '
            for number, curve in enumerate(chart.curves)
        )
        name = f"{self.words['curves']}: {chart.title}"
        return (
            f'<div class="chart" data-chart="{index}"><svg role="img" aria-label="{escape(name)}" width="{width}mm" '
            f'height="{height}mm" viewBox="0 0 {width} {height}">{body}{cursor}{dots}</svg><p>{outputs}</p></div>'
        )

    chart_data: Sequence[dict[str, Any]] = ()

