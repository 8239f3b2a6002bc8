"""Sample a machine while one of its values is dragged, for the same animation without a new page.

The animation keeps its structure, knots, scales and boxes; data without samples remain those of the original machine.
Only samples that have changed are sent to the page, as four-byte numbers.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from reportgen.assignment import Assignment
from reportgen.case import Case, MachineAnalysis
from reportgen.drawing.animation import MomentValue, MovingBody, MovingName, MovingVector, Pane, Still, Track
from reportgen.page.animation_panel import PanelWriter, samples
from reportgen.page.motion_samples import Samples

KEPT = "words", "written", "printed"
"""Members of a case that are computed once and not needed for a dragged value: its words, ledgers, symbols."""


SAME = 1e-6
"""Share of the largest sample below which two samples are equal: four bytes have seven figures."""


class Resident:
    """The machine of a case, ready to be sampled with other values, with the number of its revision."""

    def __init__(self, case: MachineAnalysis, number: int = 0) -> None:
        self.case, self.number = case, number
        self.samples = Samples(case)
        animation = self.samples.animation()
        writer = PanelWriter(animation, case.assignment.language, case.words)
        writer.panel()
        lengths = writer.tracks.lengths
        self.values = writer.tracks.values
        self.painter = writer.painter
        self.drawn = self.bodies(animation.panes[0])
        self.starts = np.concatenate(([0], np.cumsum(lengths))).astype(int)
        self.numbers = [writer.tracks.number(track) for track in tracks(animation.panes, animation.values)]

    @classmethod
    def of(cls, case: Case, number: int = 0) -> Resident | None:
        """Return the machine of a case, or that of a coursework among its parts; None for a case of another kind."""
        machine = getattr(case, "machine", case)
        return cls(machine, number) if isinstance(machine, MachineAnalysis) and machine.animations() else None

    def bodies(self, pane: Pane) -> list[str]:
        """Return the drawing of each item of a pane about its own origin; "" for arrows and names."""
        solid = (item.items if isinstance(item, MovingBody | Still) else () for item in pane.items)
        return list(map(self.painter.items, solid))

    def sampled(self, assignment: Assignment, **more: Any) -> bytes:
        """Return the changes caused by another assignment: JSON with `more` in it, then samples.

        The JSON has `bodies` of other shape by place, `runs`, and the number `of` the machine that changes. A run is
        the place of a sample among all and the number of samples from it on. The length of the JSON precedes it in four
        bytes; blanks follow it up to a multiple of four. Return no bytes if the animation would have other parts. Raise
        the errors of solving for an impossible machine.
        """
        case = type(self.case)(replace(assignment, parts=()))
        case.__dict__.update({name: getattr(self.case, name) for name in KEPT})
        sampling = Samples(case, self.samples.kept)
        if not sampling.analysis.motion.reachable.all():
            return b""
        values, written, placed = self.values.copy(), set[int](), set[tuple[int, str, bytes]]()
        panes = tuple(sampling.panes())
        moved = list(tracks(panes, tuple(sampling.values())))
        if len(moved) != len(self.numbers):
            return b""
        for number, track in zip(self.numbers, moved, strict=True):
            # Most tracks are repeated: many arrows start at the same point.
            place = number, track.values.dtype.char, track.values.tobytes()
            if place not in placed and not self._put(values, written, number, track):
                return b""
            placed.add(place)
        bodies = self.bodies(panes[0])
        if list(map(bool, bodies)) != list(map(bool, self.drawn)):
            return b""
        before = dict(self._by_place(panes[0], self.drawn))
        reshaped = {place: body for place, body in self._by_place(panes[0], bodies) if body != before[place]}
        runs = self._runs(values)
        changes = {"of": self.number, "bodies": reshaped, "runs": [(run.start, run.stop - run.start) for run in runs]}
        changes |= more
        head = json.dumps(changes, ensure_ascii=False, separators=(",", ":")).encode()
        head += b" " * (-len(head) % 4)
        return b"".join((len(head).to_bytes(4, "little"), head, *(values[run].tobytes() for run in runs)))

    def _runs(self, values: np.ndarray) -> list[slice]:
        """Return the runs of samples that differ from those of the current machine: whole tracks, adjacent ones
        joined.
        """
        changed = np.logical_or.reduceat(values.view("<u4") != self.values.view("<u4"), self.starts[:-1])
        edges = np.flatnonzero(np.diff(np.concatenate(([False], changed, [False]))))
        return [slice(int(first), int(end)) for first, end in self.starts[edges].reshape(-1, 2)]

    def _by_place(self, pane: Pane, bodies: list[str]) -> Iterator[tuple[int, str]]:
        """Yield the bodies by the places of their elements; an item without anything to draw has no element."""
        place = 0
        for item, body in zip(pane.items, bodies, strict=True):
            if isinstance(item, MovingBody | Still):
                if body:
                    yield place, body
                    place += 1
            else:
                place += 1

    def _put(self, values: np.ndarray, written: set[int], number: int, track: Track) -> bool:
        """Put the samples of a track in place.

        Return False if they have another length, or share their place with different samples.
        """
        for index, part in enumerate(samples(track)):
            place = slice(*self.starts[number + index : number + index + 2])
            if values[place].size != part.size:
                return False
            if number + index not in written:
                values[place] = part
                written.add(number + index)
            elif values[place].tobytes() != part.tobytes() and not _alike(values[place], part):
                return False
        return True


def _alike(samples: np.ndarray, others: np.ndarray) -> bool:
    """Return True if samples are equal to the precision of four bytes relative to their greatest."""
    greatest = float(np.nanmax(np.abs(samples), initial=0.0))
    return bool(np.allclose(samples, others, rtol=0.0, atol=SAME * greatest, equal_nan=True))


def tracks(panes: tuple[Pane, ...], values: tuple[MomentValue, ...]) -> Iterator[Track]:
    """Yield the tracks of an animation that follow its machine, in a fixed order; its charts keep their curves."""
    for pane in panes:
        for item in pane.items:
            match item:
                case MovingBody(_, at, angle):
                    yield at
                    yield from () if angle is None else (angle,)
                case MovingVector():
                    yield from (item.start, item.end)
                case MovingName(_, at, neighbours):
                    yield from (at, *neighbours)
        for spot in pane.spots:
            yield from (spot.on_stage, spot.place, spot.velocity, spot.acceleration)
        yield from () if pane.finer is None else (pane.finer,)
    for value in values:
        yield value.values
