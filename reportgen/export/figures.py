"""Export the figures of a case as files: those of its report, and the animations of its page.

A figure of the report is named by its key without the prefix of figures: v.4, motion, cam.law. An animation has the
name of its drawing: machine, v, R23; the name of a part precedes it: cam.cam.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cache, partial
from xml.sax.saxutils import escape

import numpy as np

from reportgen.base.errors import NotOfferedError, UnknownNameError
from reportgen.base.output_formats import chosen, names, rows
from reportgen.base.records import Record
from reportgen.base.units import Language
from reportgen.base.words import unknown, word
from reportgen.case import Case, bounded
from reportgen.document.alt_text import sentences
from reportgen.document.named_figures import NamedFigure, named_figures, safe
from reportgen.drawing import Scene
from reportgen.drawing.animation import LAYERS, Animation, Pane, Track
from reportgen.drawing.still_frames import sample_at, stills

FORMATS = names("figures")
"""File formats of figures."""
MOVING = tuple(row.name for row in rows("figures") if row.moves)
"""Formats of animations."""
STILL = tuple(name for name in FORMATS if name not in MOVING)
SHOWN = LAYERS[:1]
"""Layers drawn on a machine by default, as its page first shows it."""
FRAMES = 60
"""Number of frames per turn."""
MOVING_DPI = 110
"""Dots per inch of animations."""


class MovingFigure(Record):
    """A named animation: one pane of an animated panel."""

    name: str
    animation: Animation
    pane: Pane

    def at(self, label: str, layers: Collection[str]) -> Scene:
        """Return its drawing at a position, by the label.

        At the position that the page opens with if `label` is unknown.
        """
        angles = dict(self.animation.positions)
        angle = angles.get(label, self.animation.positions[self.animation.opening][1])
        return next(stills(self.animation, self.pane, [sample_at(self.animation, angle)], layers))

    def frames(self, layers: Collection[str]) -> list[Scene]:
        """Return its drawings through a turn, or through the cycle if the visible items need it."""
        turns = self.animation.turns if self._needs_cycle(layers) else 1
        ends = not self.animation.span
        angles = np.linspace(0.0, 360.0 * turns, FRAMES * turns + (not ends), endpoint=not ends)
        return list(
            stills(self.animation, self.pane, [sample_at(self.animation, float(one)) for one in angles], layers)
        )

    def _needs_cycle(self, layers: Collection[str]) -> bool:
        """Return True if a visible item does not repeat from turn to turn."""
        visible = (item for item in self.pane.items if not item.layer or item.layer in layers)
        return any(
            track.values.size > self.animation.knots.size
            for item in visible
            for track in (getattr(item, name, None) for name in ("at", "start", "end"))
            if isinstance(track, Track)
        )


class FigureQuery(Record):
    """Selection of figures and their form: all without `names`; with `labels`, those of the first matching position.

    Animations also show `layers`; pictures have `dpi` dots per inch, the usual number for 0.
    """

    names: Sequence[str] = ()
    labels: Sequence[str] = ()
    formats: Sequence[str] = STILL[:1]
    dpi: int = 0
    layers: Sequence[str] = SHOWN


def listed(case: Case) -> tuple[tuple[NamedFigure, ...], tuple[MovingFigure, ...]]:
    """Return the figures of the report in their order, and the animations."""
    return named_figures(case.document()), moving(case)


def moving(case: Case) -> tuple[MovingFigure, ...]:
    """Return the animations of all parts."""
    return tuple(
        MovingFigure(f"{animation.name}.{pane.key}" if animation.name else pane.key, animation, pane)
        for animation in case.animations()
        for pane in animation.panes
    )


def figure_files(case: Case, query: FigureQuery) -> Mapping[str, bytes]:
    """Return the requested figures as files, by file name.

    Raise `UnknownNameError` for an unknown figure or layer, `NotOfferedError` for a figure that cannot have the format,
    and `TypesetterError`.
    """
    language = case.assignment.language
    still = [name for name in query.formats if name in STILL]
    moved = [name for name in query.formats if name in MOVING]
    # Opening the animations takes as long as everything else.
    movable = cache(partial(moving, case))
    if query.layers != SHOWN:
        _check_layers(query, movable(), language)
    files: dict[str, bytes] = {}
    if still:
        scenes = dict(drawings(named_figures(case.document()), query, movable, language))
        rendered = bounded(case.assignment, drawn, tuple(scenes.values()), language, still, query.dpi)
        if "svg" in rendered:
            phrases = case.words["told"]
            said = (". ".join(sentences(scene.description, phrases, language)) for scene in scenes.values())
            rendered["svg"] = list(map(_described, rendered["svg"], said))
        for row in chosen("figures", still):
            files |= {f"{name}.{row.suffix}": made for name, made in zip(scenes, rendered[row.name], strict=True)}
    for figure in _wanted(case, query, movable()) if moved else ():
        frames = figure.frames(query.layers)
        for row in chosen("figures", moved):
            made = bounded(case.assignment, animated, frames, language, row.name, query.dpi)
            files[f"{safe(figure.name)}.{row.suffix}"] = made
    return files


def drawn(
    scenes: Sequence[Scene], language: Language, formats: Sequence[str] = STILL[:1], dpi: int = 0
) -> dict[str, list[bytes]]:
    """Return scenes in some of the still formats."""
    return {row.name: row.load()(scenes, language, dpi) for row in chosen("figures", formats)}


def _described(svg: bytes, text: str) -> bytes:
    """Return a picture with a description for readers who do not see it."""
    head, end, rest = svg.partition(b">")
    return head + end + f"<desc>{escape(text)}</desc>".encode() + rest if text else svg


def animated(scenes: Sequence[Scene], language: Language, format: str, dpi: int = 0) -> bytes:
    """Return scenes as successive frames of a file in one of the formats of animations."""
    (row,) = chosen("figures", (format,))
    made: bytes = row.load()(scenes, language, dpi or MOVING_DPI)
    return made


def drawings(
    figures: Sequence[NamedFigure],
    query: FigureQuery,
    movable: Callable[[], Sequence[MovingFigure]],
    language: Language,
) -> Iterator[tuple[str, Scene]]:
    """Yield the requested still drawings, by the names of their files; from `movable` ones if necessary.

    Raises `UnknownNameError`, or `NotOfferedError` if no figure shows the requested position.
    """
    if not query.names:
        at_position = [figure.shown_at(query.labels) for figure in figures] if query.labels else figures
        if not any(at_position):
            raise NotOfferedError(word("no_figure_at", language, label=query.labels[0] if query.labels else ""))
        for figure in filter(None, at_position):
            yield from figure.files.items()
    for name in query.names:
        # With a position v is the plan of that one.
        of_name = [figure for figure in figures if name == figure.name or (query.labels and name == figure.kind)]
        if of_name:
            for figure in of_name:
                yield from ((query.labels and figure.shown_at(query.labels)) or figure).files.items()
        elif moving_figure := next((figure for figure in movable() if figure.name == name), None):
            label = query.labels[0] if query.labels else ""
            yield safe(f"{name}-{label}" if label else name), moving_figure.at(label, query.layers)
        else:
            known = [*(figure.name for figure in figures), *(figure.name for figure in movable())]
            raise UnknownNameError(unknown("no_figure", name, known, language))


def _wanted(case: Case, query: FigureQuery, movable: Sequence[MovingFigure]) -> Iterator[MovingFigure]:
    """Yield the requested animations."""
    language, by_name = case.assignment.language, {one.name: one for one in movable}
    if not by_name:
        raise NotOfferedError(word("nothing_moves", language))
    for name in query.names or by_name:
        if name not in by_name:
            in_report = any(name in (one.name, one.kind) for one in named_figures(case.document()))
            known = list(by_name)
            if in_report:
                raise NotOfferedError(word("figure_stands", language, text=name, known=", ".join(known)))
            raise UnknownNameError(unknown("no_figure", name, known, language))
        yield by_name[name]


def _check_layers(query: FigureQuery, movable: Sequence[MovingFigure], language: Language) -> None:
    known = dict.fromkeys(layer for one in movable for layer in one.animation.layers)
    for layer in query.layers:
        if layer not in known:
            raise UnknownNameError(unknown("no_layer", layer, list(known), language))
