"""Sample a machine while one of its values is dragged, for the same animation without a new page.

The animation keeps its structure, knots, scales and boxes; data without samples remain those of the original machine.
Only samples that have changed are sent to the page, as four-byte numbers. While a value is dragged, only the panes and
layers that are in sight are sampled, all the others when it rests.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.assignment import Assignment
from reportgen.base.records import replace
from reportgen.case import Case, MachineAnalysis
from reportgen.drawing.animation import (
    MomentValue,
    MovingBody,
    MovingItem,
    MovingName,
    MovingVector,
    Pane,
    Still,
    Track,
)
from reportgen.machine.analysis import Analysis
from reportgen.page.animation_panel import PanelWriter, samples
from reportgen.page.motion_samples import Samples

KEPT = "words", "written", "printed"
"""Members of a case that are computed once and not needed for a dragged value: its words, ledgers, symbols."""


SAME = 1e-6
"""Share of the largest sample below which two samples are equal: four bytes have seven figures."""


TrackGroup = tuple[str, str]
"""The name of a pane, and that of a layer of the machine, `SPOTS`, `FINER` or ""."""
SPOTS, FINER, NUMBERS = "spots", "finer", ("numbers", "")


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
        self.drawn = self._bodies(animation.panes[0])
        self.places = _places(animation.panes[0], self.drawn)
        self.starts = np.concatenate(([0], np.cumsum(lengths))).astype(int)
        self.numbers = {
            group: list(map(writer.tracks.number, own))
            for group, own in grouped(animation.panes, animation.values).items()
        }

    @classmethod
    def of(cls, case: Case, number: int = 0) -> Resident | None:
        """Return the machine of a case, or that of a coursework among its parts; None for a case of another kind."""
        machine = getattr(case, "machine", case)
        return cls(machine, number) if isinstance(machine, MachineAnalysis) and machine.animations() else None

    def _bodies(self, pane: Pane) -> dict[str, list[str]]:
        """Return the drawing of each item of a pane about its own origin, by layers; "" for arrows and names."""
        bodies: dict[str, list[str]] = {}
        for item in pane.items:
            solid = item.items if isinstance(item, MovingBody | Still) else ()
            bodies.setdefault(item.layer, []).append(self.painter.items(solid))
        return bodies

    def sampled(self, assignment: Assignment, seen: frozenset[str] | None = None, **more: Any) -> bytes:
        """Return the changes caused by another assignment: JSON with `more` in it, then samples.

        The JSON has `bodies` of other shape by place, `runs`, and the number `of` the machine that changes. A run is
        the place of a sample among all and the number of samples from it on. The length of the JSON precedes it in four
        bytes; blanks follow it up to a multiple of four. If only some panes and layers are `seen`, the others have no
        runs and no bodies. Return no bytes if the animation would have other parts. Raise the errors of solving for an
        impossible machine.
        """
        case = type(self.case)(replace(assignment, parts=()))
        case.__dict__.update({name: getattr(self.case, name) for name in KEPT})
        sampling = Samples(case, self.samples.kept, seen)
        # The words and symbols are those of the current machine, which has none for a load or topic that comes new.
        if not sampling.reachable or _named(sampling.analysis) != _named(self.samples.analysis):
            return b""
        panes = tuple(sampling.panes())
        moved = grouped(panes, tuple(sampling.values()) if seen is None else ())
        values = self._values(moved)
        if values is None or moved.keys() != {group for group in self.numbers if _is_seen(sampling, group)}:
            return b""
        reshaped: dict[int, str] = {}
        for layer, bodies in self._bodies(panes[0]).items():
            if list(map(bool, bodies)) != list(map(bool, self.drawn.get(layer, ()))):
                return b""
            drawn = zip(self.places[layer], bodies, self.drawn[layer], strict=True)
            reshaped |= {place: body for place, body, before in drawn if body != before}
        runs = self._runs(values)
        changes = {"of": self.number, "bodies": reshaped, "runs": [(run.start, run.stop - run.start) for run in runs]}
        changes |= more
        head = json.dumps(changes, ensure_ascii=False, separators=(",", ":")).encode()
        head += b" " * (-len(head) % 4)
        return b"".join((len(head).to_bytes(4, "little"), head, *(values[run].tobytes() for run in runs)))

    def _values(self, moved: Mapping[TrackGroup, Sequence[Track]]) -> np.ndarray | None:
        """Return all samples, those of tracks that are not among the `moved` as they are.

        Return None if the tracks of a group are others than those of the current machine.
        """
        values, written, placed = self.values.copy(), set[int](), set[tuple[int, str, bytes]]()
        for group, own in moved.items():
            numbers = self.numbers.get(group, ())
            if len(numbers) != len(own):
                return None
            for number, track in zip(numbers, own, strict=True):
                # Most tracks are repeated: many arrows start at the same point.
                place = number, track.values.dtype.char, track.values.tobytes()
                if place not in placed and not self._put(values, written, number, track):
                    return None
                placed.add(place)
        return values

    def _runs(self, values: np.ndarray) -> list[slice]:
        """Return the runs of samples that differ from those of the current machine: whole tracks, adjacent ones
        joined.
        """
        changed = np.logical_or.reduceat(values.view("<u4") != self.values.view("<u4"), self.starts[:-1])
        edges = np.flatnonzero(np.diff(np.concatenate(([False], changed, [False]))))
        return [slice(int(first), int(end)) for first, end in self.starts[edges].reshape(-1, 2)]

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


def _named(analysis: Analysis) -> tuple[frozenset[str], frozenset[str]]:
    """Return the names of the topics of a machine and of its loads."""
    return frozenset(analysis.machine.topics), frozenset(load.name for load in analysis.loads)


def _alike(samples: np.ndarray, others: np.ndarray) -> bool:
    """Return True if samples are equal to the precision of four bytes relative to their greatest."""
    greatest = float(np.nanmax(np.abs(samples), initial=0.0))
    return bool(np.allclose(samples, others, rtol=0.0, atol=SAME * greatest, equal_nan=True))


def _places(pane: Pane, drawn: Mapping[str, Sequence[str]]) -> dict[str, list[int]]:
    """Return the places of the items' elements in the drawing of a pane, by layers.

    A body without anything to draw has no element; its place is that of the next one.
    """
    bodies = {layer: iter(own) for layer, own in drawn.items()}
    places: dict[str, list[int]] = {}
    count = 0
    for item in pane.items:
        places.setdefault(item.layer, []).append(count)
        count += bool(next(bodies[item.layer])) or not isinstance(item, MovingBody | Still)
    return places


def _is_seen(samples: Samples, group: TrackGroup) -> bool:
    """Return True if the tracks of a group are among the samples."""
    pane, layer = group
    return samples.sees(pane) and (layer in (SPOTS, FINER) or samples.sees(layer))


def grouped(panes: Sequence[Pane], values: Sequence[MomentValue]) -> dict[TrackGroup, list[Track]]:
    """Return the tracks of an animation that follow its machine, in a fixed order; its charts keep their curves."""
    groups: dict[TrackGroup, list[Track]] = {}
    for pane in panes:
        for item in pane.items:
            groups.setdefault((pane.key, item.layer), []).extend(_followed(item))
        for spot in pane.spots:
            own = spot.on_stage, spot.place, spot.velocity, spot.acceleration
            groups.setdefault((pane.key, SPOTS), []).extend(own)
        if pane.finer is not None:
            groups[pane.key, FINER] = [pane.finer]
    if values:
        groups[NUMBERS] = [value.values for value in values]
    return groups


def _followed(item: MovingItem) -> Sequence[Track]:
    """Return the tracks that an item follows."""
    match item:
        case MovingBody(_, at, angle):
            return (at,) if angle is None else (at, angle)
        case MovingVector():
            return item.start, item.end
        case MovingName(_, at, neighbours):
            return at, *neighbours
    return ()
