"""Points and loads that are pulled on the machine of a form: which there are, the values that follow, the machine.

Nothing is written. The page puts the values into their fields, and sends them as one change at the release.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from reportgen import catalogue
from reportgen.base.errors import ReportgenError, Where
from reportgen.base.records import replace
from reportgen.base.yaml_source import Node, Scalar, SequenceNode, Source
from reportgen.base.yaml_values import at, put
from reportgen.machine import Crank, Linkage
from reportgen.machine.analysis import Machine, motion_at
from reportgen.page.drag_samples import Resident
from reportgen.page.form_fields import written_at
from reportgen.page.pull_regions import REACH, FileChecks, Requirement, region
from reportgen.page.pulled_anchors import AnchorPull, KnownAnchor, known_anchors
from reportgen.page.pulled_loads import LoadPull, LoadValue, load_values
from reportgen.page.pulled_values import FAR, PlacingValue, Pull, is_locked, placing_values, with_texts

MOST_STEPS = 32
"""Largest number of steps of a region in each direction."""
PAUSE = 0.002
"""Time (s) after which a region looks again whether the pulled machine is ready."""
MACHINE = "machine"
"""The name of the machine's own drawing."""
Asked = Mapping[str, Any]
PlacedBy = tuple[Linkage | None, tuple[PlacingValue, ...]]
LoadedBy = Mapping[str, tuple[LoadValue, ...]]
AnchoredBy = Mapping[str, KnownAnchor]


@dataclass
class PulledPoint:
    """A point while it is pulled: the values that follow, the last differences that gave a machine, its beginning."""

    pull: Pull
    offsets: np.ndarray
    begun: Pull


@dataclass
class PulledLoad:
    """The tip of a load's arrow, or the end of a coil, while it is pulled, and the last differences of its values that
    gave a machine.
    """

    pull: LoadPull | AnchorPull
    offsets: np.ndarray

    @property
    def begun(self) -> AnchorPull | None:
        """The pull of an end of a coil, which has a region; None for a load."""
        return self.pull if isinstance(self.pull, AnchorPull) else None


@dataclass
class Pulls:
    """Answers of a form about points and loads that are pulled on the machine of the file at `path`.

    `resident` returns the machine that the page shows, `read` the nodes of the file.
    """

    path: Path
    resident: Callable[[], Resident | None]
    read: Callable[[], Node | None]
    known_of: tuple[Node | None, PlacedBy] | None = None
    loads_of: tuple[Node | None, LoadedBy] | None = None
    anchors_of: tuple[Node | None, AnchoredBy] | None = None
    pulled: tuple[tuple[Any, ...], PulledPoint | PulledLoad] | None = None
    """What is pulled, by the number of the pull, the point or load, the driver's place, the locked, the revision."""
    lock: threading.Lock = field(default_factory=threading.Lock)
    grabbing: threading.Lock = field(default_factory=threading.Lock)
    working: bool = False
    """True while the machine of a pulled point is computed."""

    def grips(self) -> Mapping[str, Any]:
        """Return the places of the values of each point and load that can be pulled, and the driver that is turned.

        Ends of coils at places of the frame are points, too. Points of the frame are in mm of the drawing. The driver
        has the sense in which its angle grows with the cycle, +1 anticlockwise.
        """
        resident = self.resident()
        if resident is None:
            return {}
        machine, scale = resident.samples.machine, resident.samples.scale
        top = self.read()
        _, values = self._known(top)
        points: dict[str, list[list[str | int]]] = {}
        for value in values:
            for point in value.points:
                points.setdefault(point, []).append(list(value.where))
        anchors = self._anchors(top)
        points |= {name: [list(value.where) for value in anchor.values] for name, anchor in anchors.items()}
        driver = machine.linkage.driver
        fixed = dict(machine.linkage.ground) | {name: anchor.place for name, anchor in anchors.items()}
        ground = {name: [p.real * scale, -p.imag * scale] for name, p in fixed.items()}
        turning = {"centre": driver.centre} if isinstance(driver, Crank) else {}
        return {
            "points": points,
            "loads": {name: [list(value.where) for value in of_load] for name, of_load in self._loads(top).items()},
            "ground": ground,
            "driver": {**turning, "pin": driver.pin, "turn": machine.turn, "instants": machine.instants},
        }

    def _known(self, top: Node | None) -> PlacedBy:
        """Return the linkage of the file and the values that place its points, found once for each content."""
        with self.lock:
            if self.known_of is None or self.known_of[0] != top:
                self.known_of = top, placing_values(self._source(top), self.path)
            return self.known_of[1]

    def _loads(self, top: Node | None) -> LoadedBy:
        """Return the values of the loads whose arrows can be pulled, found once for each content."""
        with self.lock:
            if self.loads_of is None or self.loads_of[0] != top:
                self.loads_of = top, load_values(self._source(top), self.path)
            return self.loads_of[1]

    def _anchors(self, top: Node | None) -> AnchoredBy:
        """Return the ends of coils at places of the frame that can be pulled, found once for each content."""
        with self.lock:
            if self.anchors_of is None or self.anchors_of[0] != top:
                self.anchors_of = top, known_anchors(self._source(top), self.path)
            return self.anchors_of[1]

    def _source(self, top: Node | None) -> Source:
        return Source(str(self.path), top=top)

    def drag(self, asked: Asked) -> Mapping[str, Any] | bytes:
        """Return the samples of everything that moves with other `values` at their places; see `EditSession.drag`."""
        resident, top = self.resident(), self.read()
        if resident is None:
            return {}
        for place, text in asked.get("values") or [(asked["where"], asked["value"])]:
            where = asked_place(place)
            old = at(top, where)
            if not isinstance(old, Scalar) or top is None:
                return b""
            top = put(top, where, replace(old, text=str(text), null=False))
        return b"" if top is None else self._sampled(asked, resident, top)

    def _sampled(self, asked: Asked, resident: Resident, changed: Node, **more: Any) -> bytes:
        """Return the samples of the machine of other nodes; no bytes if no machine has these values."""
        assignment, faults = catalogue.understood(self._source(changed), self.path)
        if assignment is None or faults:
            return b""
        try:
            return resident.sampled(assignment, asked_sight(asked), **more)
        except (ReportgenError, ArithmeticError, ValueError, np.linalg.LinAlgError):
            return b""

    def pull(self, asked: Asked) -> Mapping[str, Any] | bytes:
        """Return the machine whose point or tip is as near as possible to a place, as `drag` does, with the `values`.

        The values are in whole steps of their fields and within their bounds; `texts` has each by its own place, for
        `drag`. Where no machine has them, the answer has no values. It is empty for a kind that is not a machine.
        """
        resident = self.resident()
        if resident is None:
            return {}
        top = self.read()
        with self.grabbing:
            grabbed = self.grabbed(asked, resident, top)
        if grabbed is None or top is None:
            return {"values": []}
        self.working = True
        try:
            return self._pulled(asked, resident, grabbed, top)
        finally:
            self.working = False

    def _pulled(
        self, asked: Asked, resident: Resident, grabbed: PulledPoint | PulledLoad, top: Node
    ) -> Mapping[str, Any] | bytes:
        x, y = (float(number) for number in asked["to"])
        target = complex(x, -y) / resident.samples.scale
        offsets = grabbed.pull.to(target, grabbed.offsets)
        texts = grabbed.pull.texts(offsets)
        changed = with_texts(top, texts)
        place = grabbed.pull.at(grabbed.pull.rounded(offsets)) * resident.samples.scale
        answer = {"values": _of_fields(changed, texts), "texts": texts, "at": [place.real, -place.imag]}
        samples = self._sampled(asked, resident, changed, **answer) if np.isfinite(place) else b""
        if samples:
            grabbed.offsets = offsets
            if isinstance(grabbed, PulledPoint):
                self._recentre(grabbed, changed)
        return samples or {"values": []}

    @property
    def takes(self) -> Mapping[str, Callable[[Asked], Mapping[str, Any]]]:
        """The further messages of a page that pulls a point, by names."""
        return {"region.json": self.region, "released.json": self.end}

    def region(self, asked: Asked) -> Mapping[str, Any]:
        """Return the shape (mm of the drawing) of where a point that is pulled leaves a machine that runs.

        `lines` is true if the point can only move along a line. The answer is empty if the pull is over before it is
        ready. Dragging has priority.
        """
        resident, grab, count = self.resident(), asked["grab"], min(int(asked["count"]), MOST_STEPS)
        top = self.read()
        with self.grabbing:
            grabbed = self.grabbed(asked, resident, top) if resident else None
            begun = None if grabbed is None else grabbed.begun
            if resident is None or begun is None:
                return {}
            machine, scale = resident.samples.machine, resident.samples.scale

        def going() -> bool:
            while self.working:
                time.sleep(PAUSE)
            return self.pulled is not None and self.pulled[0][0] == grab

        low, high = resident.samples.kept["box"]
        reach = REACH * max((high - low).real, (high - low).imag) / scale
        checks = FileChecks(self._source(top), self.path, begun)
        shapes = region(begun, Requirement.of(machine), reach, count, going, checks)
        if shapes is None:
            return {}
        lines = len(begun.values) == 1
        return {"path": "".join(_drawn(shape * scale, "" if lines else "Z") for shape in shapes), "lines": lines}

    def end(self, asked: Asked) -> Mapping[str, Any]:
        """End a pull: its region is no longer wanted."""
        if self.pulled is not None and self.pulled[0][0] == asked["grab"]:
            self.pulled = None
        return {}

    def grabbed(self, asked: Asked, resident: Resident, top: Node | None) -> PulledPoint | PulledLoad | None:
        """Return the point or load that a page pulls; None if no value that is not locked moves it."""
        locked = [asked_place(where) for where in asked.get("locked", ())]
        pulled = asked.get("point"), asked.get("load"), float(asked["angle"])
        key = asked["grab"], *pulled, tuple(locked), resident.number
        if self.pulled is None or self.pulled[0] != key:
            grab = self._load if "load" in asked else self._point
            grabbed = grab(asked, resident, top, locked)
            if grabbed is None:
                return None
            self.pulled = key, grabbed
        grabbed = self.pulled[1]
        return grabbed if grabbed.pull.values else None

    def _point(
        self, asked: Asked, resident: Resident, top: Node | None, locked: list[Where]
    ) -> PulledPoint | PulledLoad | None:
        if (anchor := self._anchors(top).get(str(asked["point"]))) is not None:
            end = AnchorPull(anchor.place, tuple(v for v in anchor.values if not is_locked(v.where, locked)))
            return PulledLoad(end, np.zeros(len(end.values)))
        linkage, values = self._known(top)
        if linkage is None:
            return None
        driver = _coordinate(resident.samples.machine, float(asked["angle"]))
        pull = Pull.of(linkage, values, str(asked["point"]), driver, locked)
        return PulledPoint(pull, np.zeros(len(pull.values)), pull)

    def _load(self, asked: Asked, resident: Resident, top: Node | None, locked: list[Where]) -> PulledLoad | None:
        samples, name = resident.samples, str(asked["load"])
        load = next((load for load in samples.machine.applied if load.name == name), None)
        per = samples.kept.get("arrows of forces")
        if load is None or per is None:
            return None
        free = [value for value in self._loads(top).get(name, ()) if not is_locked(value.where, locked)]
        angle = np.array([_cycle_angle(samples.machine, float(asked["angle"]))])
        pull = LoadPull.of(load, free, (angle, motion_at(samples.machine, angle)), per * samples.scale)
        return PulledLoad(pull, np.zeros(len(pull.values)))

    def _recentre(self, grabbed: PulledPoint, changed: Node) -> None:
        """Find anew how the linkage follows the values when they are far from where that was found."""
        pull = grabbed.pull
        steps = np.array([value.course.step for value in pull.values])
        if (np.abs(grabbed.offsets) < FAR * steps).all():
            return
        linkage, values = placing_values(self._source(changed), self.path, [value.where for value in pull.values])
        if linkage is None or len(values) != len(pull.values):
            return
        values = tuple(
            replace(value, typed=replace(value.typed, begun=old.typed.begun))
            for value, old in zip(values, pull.values, strict=True)
        )
        # The numbers are typed in whole steps; what was asked for lies between them.
        moved = [value.typed.number + by for value, by in zip(pull.values, grabbed.offsets.tolist(), strict=True)]
        grabbed.pull = replace(pull, linkage=linkage, values=values)
        grabbed.offsets = np.array([to - value.typed.number for value, to in zip(values, moved, strict=True)])


def _coordinate(machine: Machine, degrees: float) -> float:
    """Return the driver's coordinate (rad, or m of a slide) at a cycle angle of the page (degrees)."""
    return float(machine.angles(np.asarray(_cycle_angle(machine, degrees))))


def _cycle_angle(machine: Machine, degrees: float) -> float:
    """Return the cycle angle (rad) of one of the page (degrees); of single instants, that of the nearest."""
    if not machine.instants:
        return float(np.radians(degrees))
    count = machine.cycle_angles.size
    return float(machine.cycle_angles[round(degrees / 360 * count) % count])


def _drawn(corners: np.ndarray, end: str) -> str:
    """Return corners (mm, y upwards) as a path of the drawing."""
    return "M" + "L".join(f"{corner.real:.1f} {-corner.imag:.1f}" for corner in corners.tolist()) + end


def _of_fields(top: Node, texts: list[tuple[Where, str]]) -> list[tuple[Where, str]]:
    """Return values by the places of the fields that show them: a list of values has one field."""
    places = [where[:-1] if isinstance(at(top, where[:-1]), SequenceNode) else where for where, _ in texts]
    return [(place, written_at(at(top, place))) for place in dict.fromkeys(places)]


def asked_sight(asked: Asked) -> frozenset[str] | None:
    """Return the panes and layers that a page has in sight, which include the machine itself; None for all.

    Raise `TypeError` if they are not names.
    """
    seen = asked.get("seen")
    if seen is None:
        return None
    if not isinstance(seen, list) or any(not isinstance(name, str) for name in seen):
        raise TypeError("what is in sight is a list of names")
    return frozenset((MACHINE, *seen))


def asked_place(steps: Any) -> Where:
    """Return a place that a request names; raise `TypeError` for anything else."""
    if not isinstance(steps, list) or any(type(step) not in (str, int) for step in steps):
        raise TypeError("a place is a list of keys and numbers")
    return tuple(steps)
