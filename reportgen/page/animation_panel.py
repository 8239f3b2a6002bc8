"""Write the animated machine as elements of a page, and its samples as compact data: `panel` returns both.

Everything that moves is drawn once here, about its own origin, and has a number (`data-i`). The data give for each
number the tracks that it follows. The script of the page only reads tracks between two samples.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from reportgen.base.languages import decimal_mark
from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import ALIKE, settled, significant
from reportgen.base.units import Language, rounded, write
from reportgen.document.alt_text import sentences, within
from reportgen.drawing import Content, Label
from reportgen.drawing.animation import (
    LAYERS,
    Animation,
    Chart,
    MovingBody,
    MovingItem,
    MovingName,
    MovingVector,
    Pane,
    Still,
    TimedRun,
    Track,
    scale_bars,
)
from reportgen.drawing.geometry import frame
from reportgen.drawing.label_size import POINT
from reportgen.drawing.style import HEAD_SLENDERNESS, LABEL, SMALL, decimal
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import KINDS
from reportgen.page.html import Panel, data, save_buttons, template
from reportgen.page.svg_elements import MathmlFormulas, Painter, Pens

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0)
"""Speeds of playback, as shares of the usual one."""
LINE = 0.42
"""Half the height of a line of letters, in font sizes."""
HIT = 4.0
"""Largest distance (mm) from the pointer to a point that it selects."""
HEADS = ("x (m)", "y (m)", "v_x (m/s)", "v_y (m/s)", "v (m/s)", "a_x (m/s²)", "a_y (m/s²)", "a (m/s²)")
"""Headings of the table of a point's motion, after that of the driver's travel."""


def panel(animation: Animation, language: Language, words: Mapping[str, Any]) -> Panel:
    """Return the panel of a machine or a part; `words` is the whole content of `words.yaml`."""
    return PanelWriter(animation, language, words).panel()


SAMPLE = 2.0**-22
"""Step of samples as a share of the greatest one: the resolution of numbers of four bytes."""
AXIS_DIGITS = 9
"""Significant figures of the ends of an axis."""
NOTHING = 2.0**-20
"""Largest sample (mm, or SI units) of a track in which everything below its step is rounding."""


def samples(track: Track) -> tuple[np.ndarray, ...]:
    """Return the real part of a track, and the imaginary part if it has one, as four-byte numbers [N].

    They are in the track's unit (mm, or SI). They are `settled`: otherwise samples would be most of what differs
    between the pages of two processors.
    """
    plane = np.iscomplexobj(track.values)
    # Both parts together: real and imaginary parts alternate.
    numbers = np.ascontiguousarray(track.values, dtype=np.complex128 if plane else np.float64).view(np.float64)
    sizes = np.abs(numbers)
    greatest = float(sizes.max(initial=0.0))
    if not math.isfinite(greatest):
        greatest = float(sizes.max(initial=0.0, where=np.isfinite(sizes)))
    written = settled(numbers, _step(greatest)).astype("<f4")
    return (written[::2], written[1::2]) if plane else (written,)


def _step(greatest: float) -> float:
    """Return the step of samples that are not larger than `greatest`, in the same unit."""
    # A power of two that rounding errors have changed is that power.
    return SAMPLE * 2.0 ** math.frexp(max(greatest, NOTHING) * (1 + ALIKE))[1]


class Tracks:
    """The tracks of a page, each stored once: numbers of its parts, and their values one after the other."""

    def __init__(self) -> None:
        self._numbers: dict[tuple[bytes, ...], int] = {}
        self.lengths: list[int] = []
        self._values: list[bytes] = []

    def number(self, track: Track) -> int:
        """Return the number of a track; for a complex one that of its real part, which the imaginary part follows."""
        parts = samples(track)
        packed = tuple(part.tobytes() for part in parts)
        if packed not in self._numbers:
            self._numbers[packed] = len(self.lengths)
            self.lengths += [part.size for part in parts]
            self._values += packed
        return self._numbers[packed]

    @property
    def values(self) -> np.ndarray:
        """All values [N], one track after the other, as four-byte numbers."""
        return np.frombuffer(b"".join(self._values), "<f4")

    def packed(self) -> str:
        """Return all values as numbers of four bytes, in base 64."""
        return base64.b64encode(b"".join(self._values)).decode()


class _Drawn(Record):
    """A pane as the template prints it; lengths are mm, texts are escaped for attributes."""

    key: str
    title: str
    width: str
    height: str
    box: str
    room: str
    """Left, upper, right and lower edge of the area for labels."""
    body: str
    spots: tuple[str, ...]
    reach: str


class _Charted(Record):
    """A chart as the template prints it."""

    text: str
    """Text alternative for readers who do not see the chart."""
    width: str
    height: str
    body: str
    symbols: tuple[str, ...]


class PanelWriter:
    """Writer of one animated panel: its elements, and the data that its script reads."""

    def __init__(self, animation: Animation, language: Language, words: Mapping[str, Any]) -> None:
        self.animation, self.language, self.words = animation, language, words["page"]
        self.phrases: Mapping[str, str] = words["told"]
        """Phrases of the descriptions of drawings."""
        self.own = f"{animation.name}-" if animation.name else ""
        self.pens, self.tracks = Pens(f"{self.own}m"), Tracks()
        self.painter, self.formulas = Painter(language, self.pens), MathmlFormulas(language)
        self.items: list[dict[str, Any]] = []
        """Data of each numbered element with the tracks that it follows."""
        self.enlargement = 1.0
        """Factor by which letters, arrowheads and pens of arrows are larger than in figures."""

    def unit(self, unit: str) -> str:
        return self.animation.units.get(unit, unit)

    def panel(self) -> Panel:
        animation, formula = self.animation, self.formulas.content
        machine, *plans = animation.panes
        body = template("moving.html.j2").render(
            words=self.words,
            animation=animation,
            own=self.own,
            save=partial(save_buttons, label=self.words["save_figure"]),
            speeds=[(speed, write(speed, None, self.language)) for speed in SPEEDS],
            shown_layer=LAYERS[0],
            machine=self.pane(machine),
            plans=list(map(self.pane, plans)),
            rates=[
                ("v", formula(Symbol("v")), self.unit(KINDS["velocity"].unit)),
                ("a", formula(Symbol("a")), self.unit(KINDS["acceleration"].unit)),
            ],
            runs=[run.key for run in animation.runs],
            numbers=[(formula(value.symbol), self.unit(value.unit)) for value in animation.values],
            charts=list(map(self.chart, animation.charts)),
            accuracy=self.accuracy(),
        )
        title = animation.title or self.words["moving"]
        return Panel(self.own, title, body, self.pens.rules(), data(self.data()))

    def data(self) -> Mapping[str, Any]:
        """Return the data that the script reads; numbers are those of tracks."""
        animation, words, number = self.animation, self.words, self.tracks.number
        return {
            "knots": [float(f"{knot:.8g}") for knot in animation.knots],
            "turns": animation.turns,
            "span": animation.span,
            **({"instants": self.instants()} if animation.instants else {}),
            "decimal": decimal_mark(self.language),
            "positions": [[label, float(f"{angle:.9g}")] for label, angle in animation.positions],
            "shown": animation.opening,
            "items": self.items,
            "spots": [
                {
                    "name": spot.name,
                    "at": number(spot.on_stage),
                    "p": number(spot.place),
                    "v": number(spot.velocity),
                    "a": number(spot.acceleration),
                }
                for spot in animation.panes[0].spots
            ],
            "finer": {
                pane.key: {"at": number(pane.finer), "times": [pane.scales[0].per / scale.per for scale in pane.scales]}
                for pane in animation.panes
                if pane.finer
            },
            "charts": list(map(self.axes, animation.charts)),
            **({"runs": list(map(_timed, animation.runs))} if animation.runs else {}),
            "values": [[number(value.values), value.decimals] for value in animation.values],
            "heads": [f"{words['way']} ({self.unit('mm')})" if animation.span else f"{words['angle']} (°)", *HEADS],
            "words": {key: words[key] for key in ("play", "pause", "keep", "release", "copied", "run_told")},
            "lengths": self.tracks.lengths,
            "tracks": self.tracks.packed(),
        }

    def instants(self) -> list[tuple[str, float]]:
        """Return the label of each single instant, and the place of the driver: degrees, or mm for a slide."""
        unit = " mm" if self.animation.span else "°"
        places = [float(f"{place:.9g}") for place in self.animation.instants]
        labels = (label for label, _ in self.animation.positions)
        return [
            (f"{label}: {write(place, None, self.language)}{unit}", place)
            for label, place in zip(labels, places, strict=True)
        ]

    def accuracy(self) -> str:
        """Return the errors from straight lines between samples, in words."""
        errors = self.animation.errors
        if self.animation.instants:
            return str(self.words["instants"])
        printed = {
            "count": len(self.animation.knots) - 1,
            "place": rounded_up(errors.place, self.language),
            "crank": rounded_up(100 * errors.place / errors.crank, self.language),
            "share": rounded_up(100 * errors.share, self.language),
        }
        return str(self.words["accuracy"].format(**printed))

    # --- drawings

    def pane(self, pane: Pane) -> _Drawn:
        """Draw a pane in the box of everything that it ever shows, about its origin, y downwards.

        Its bars are below it.
        """
        self.enlargement = pane.enlargement
        size = pane.high - scale_bars(pane, self.animation.units)[0]
        width, height = decimal(size.real), decimal(size.imag)
        return _Drawn(
            key=pane.key,
            title=pane.title,
            width=width,
            height=height,
            box=f"{decimal(pane.low.real)} {decimal(-pane.high.imag)} {width} {height}",
            room=" ".join(map(decimal, (pane.low.real, -pane.high.imag, pane.high.real, -pane.low.imag))),
            body="".join(map(self.item, pane.items)) + "".join(self.bars(pane)),
            spots=tuple(spot.name for spot in pane.spots),
            reach=decimal(HIT * self.enlargement),
        )

    def bars(self, pane: Pane) -> Iterator[str]:
        """Yield a bar for each scale with its value above it; scales that are used in turns share one place."""
        for number, (scale, bar) in enumerate(scale_bars(pane, self.animation.units)[1]):
            attributes = f' data-bar="{number}"'
            if pane.finer:
                attributes += f' data-scale="{number}"' + " hidden" * bool(number)
            if scale.layers:
                attributes += f' data-of-layer="{" ".join(scale.layers)}" hidden'
            yield f"<g{attributes}>{self.painter.items(bar)}</g>"

    def item(self, item: MovingItem) -> str:
        """Return the element of an item; a moving one gets a number.

        The tracks that it follows go into the data.
        """
        match item:
            case Still(items):
                return self.element(self.painter.items(items), item.layer)
            case MovingBody(items, at, angle):
                follows = {"at": self.tracks.number(at)}
                if angle is not None:
                    follows["turn"] = self.tracks.number(angle)
                return self.element(self.painter.items(items), item.layer, follows)
            case MovingVector():
                return self.vector(item)
            case MovingName(content, at, neighbours, gap):
                return self.element(
                    self.label(content, LABEL),
                    item.layer,
                    {
                        "label": self.tracks.number(at),
                        "off": list(map(self.tracks.number, neighbours)),
                        "gap": round(gap * self.enlargement, 3),
                        "size": self.size(content, LABEL),
                    },
                )

    def element(self, body: str, layer: str, follows: Mapping[str, Any] | None = None) -> str:
        """Return a group that may move and that may be switched on and off with its layer."""
        attributes = ""
        if follows is not None:
            attributes += f' data-i="{len(self.items)}"'
            self.items.append(dict(follows))
        if layer:
            attributes += f' data-of-layer="{layer}"' + (" hidden" if layer != LAYERS[0] else "")
        return f"<g{attributes}>{body}</g>" if body else ""

    def vector(self, item: MovingVector) -> str:
        follows: dict[str, Any] = {"from": self.tracks.number(item.start), "to": self.tracks.number(item.end)}
        stroke = item.stroke
        dash = tuple(round(part * self.enlargement, 3) for part in stroke.dash)
        pen = self.pens.name(replace(stroke, width=round(stroke.width * self.enlargement, 3), dash=dash))
        parts = f'<path class="{pen}"/>'
        if item.head:
            follows |= {"head": round(item.head * self.enlargement, 3), "slender": HEAD_SLENDERNESS}
            parts += f'<path class="{self.pens.name(None, stroke.colour)}"/>'
        if item.beyond:
            follows["beyond"] = item.beyond
        if item.name:
            follows["name"] = item.name
        if item.label is not None:
            follows["size"] = self.size(item.label, SMALL)
            parts += f"<g>{self.label(item.label, SMALL)}</g>"
        return self.element(parts, item.layer, follows)

    def label(self, content: Content, size: float) -> str:
        """Return a label of a size (points) centred on its own place."""
        return self.painter.label(Label(0j, content, size=size * self.enlargement))

    def size(self, content: Content, size: float) -> list[float]:
        """Return half the width and height (mm) of a label, which is at least one line high, and its font size (mm)."""
        _, half = frame(Label(0j, content, size=size * self.enlargement))
        em = size * self.enlargement * POINT
        return [round(half.real, 2), round(max(half.imag, LINE * em), 2), round(em, 3)]

    # --- curves

    def chart(self, chart: Chart) -> _Charted:
        scene = chart.plotted.scene
        return _Charted(
            within(self.words["curves"], sentences(scene.description, self.phrases, self.language), self.language),
            decimal(scene.width),
            decimal(scene.height),
            self.painter.items(scene.items, scene.height),
            tuple(self.formulas.content(curve.label) for curve in chart.curves),
        )

    def axes(self, chart: Chart) -> Mapping[str, Any]:
        """Return the box of a chart's axes (mm, y downwards), their ranges, and the tracks of its curves."""
        drawn = chart.plotted
        return {
            "box": list(_rounded(_turned_over(drawn.low, drawn.high, drawn.scene.height))),
            "x": [significant(end, AXIS_DIGITS) for end in drawn.x],
            "y": [significant(end, AXIS_DIGITS) for end in drawn.y],
            **({"run": True} if chart.of_run else {}),
            "curves": [self.tracks.number(curve.values) for curve in chart.curves],
        }


def _timed(run: TimedRun) -> Mapping[str, Any]:
    """Return a run as the script plays it: its key and its samples."""
    samples = {"time": run.time, "angle": run.angle, "speed": run.speed, "drive": run.drive}
    steps = {name: _step(float(np.max(np.abs(values), initial=0.0))) for name, values in samples.items()}
    rounded = {name: [float(f"{settled(float(one), steps[name]):.6g}") for one in samples[name]] for name in samples}
    return {"key": run.key, **rounded}


def rounded_up(value: float, language: Language, figures: int = 2) -> str:
    """Return a bound as printed, in its unit, with `figures` significant figures; never below the value."""
    if value <= 0:
        return write(0.0, None, language)
    step = 10.0 ** (math.floor(math.log10(value)) - figures + 1)
    return write(float(f"{math.ceil(value / step * (1 - 1e-12)) * step:.{figures}g}"), None, language)


def _turned_over(low: complex, high: complex, height: float) -> tuple[float, ...]:
    return low.real, height - low.imag, high.real, height - high.imag


def _rounded(values: tuple[float, ...]) -> Iterator[float]:
    return (rounded(value, 3) for value in values)
