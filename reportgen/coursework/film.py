"""The parts of a coursework moving together: a part's drawing beside the machine's, at the angles that it then has."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from reportgen.coursework.letters import changed
from reportgen.drawing.film import Film, Track

TURN = 360.0


def joined(film: Film, part: Film, ratio: float, name: str, title: str) -> Film:
    """The film with the stages, numbers and layers of a part that turns `ratio` times as fast.

    Diagrams of the part go by its own angle; they are shown where that is the machine's.
    """
    angles = ratio * _cycle(film)

    def at_machine(track: Track) -> Track:
        return track if len(track.values) == 1 else Track(_at(track.values, _cycle(part), angles))

    def moved(tree: Any) -> Any:
        return changed(tree, Track, at_machine)

    stages = tuple(
        replace(moved(stage), key=f"{name}-{stage.key}", title=title if stage is part.stages[0] else stage.title)
        for stage in part.stages
    )
    together = ratio == 1 and film.turns == part.turns
    return replace(
        film,
        stages=(*film.stages, *stages),
        charts=(*film.charts, *(moved(part.charts) if together else ())),
        values=(*film.values, *moved(part.values)),
        layers=tuple(dict.fromkeys((*film.layers, *part.layers))),
    )


def _cycle(film: Film) -> np.ndarray:
    """The angles of all samples of a cycle (degrees)."""
    return np.concatenate([film.knots[:1], *(film.knots[1:] + TURN * turn for turn in range(film.turns))])


def _at(values: np.ndarray, knots: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Samples over the knots of a cycle at other angles; what has turned by its end goes on from there."""
    length = knots[-1] - knots[0]
    cycles, within = np.divmod(angles - knots[0], length)
    found: np.ndarray = np.interp(within + knots[0], knots, values) + cycles * (values[-1] - values[0])
    return found
