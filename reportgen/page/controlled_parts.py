"""Find the drawn parts that a value of the file controls, by changing the value a little: `owners`.

The changed machine shows them: lengths of crank and rods, fixed points, guides, masses. A load is controlled by the
value if the linkage does not change.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from reportgen import catalogue
from reportgen.base.errors import Where
from reportgen.base.records import Record, replace
from reportgen.base.units import NUMBER
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source
from reportgen.base.yaml_values import put
from reportgen.machine import Crank, Dyad, Guide, Linkage, TriadLeg
from reportgen.machine.analysis import Machine, analyse

SHARE = 1.01
"""Factor by which a value is changed; a value of 0 is changed by `STEP` in its own unit."""
STEP = 0.5
SAME = 1e-9
"""Relative difference below which nothing has changed."""
SAMPLES = 13
MOST_VALUES = 120
"""Largest number of values of a file that are examined."""
_NUMBER = re.compile(rf"\s*({NUMBER})(| .*|/.*)")

Bar = tuple[str, str]


class ControlledParts(Record):
    """The bars (each by the points at its ends) and the points that one value controls."""

    bars: tuple[Bar, ...] = ()
    points: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.bars or self.points)


def owners(machine: Machine, top: MappingNode, source: Source) -> Iterator[tuple[Where, ControlledParts]]:
    """Yield the bars and points that each value of the machine's data controls, by its place in the file.

    They are empty if the value moves nothing that is drawn.
    """
    data = top.find("parameters")
    leaves = _leaves(data[1], ("parameters",)) if data else iter(())
    for (where, scalar), _ in zip(leaves, range(MOST_VALUES), strict=False):
        for text in variations(scalar.text):
            varied = put(top, where, replace(scalar, text=text))
            if (changed := catalogue.machine_of(replace(source, top=varied), Path(source.file))) is not None:
                yield where, difference(machine, changed)
                break


def _leaves(node: Node, where: Where) -> Iterator[tuple[Where, Scalar]]:
    match node:
        case Scalar(null=False):
            yield where, node
        case SequenceNode(items):
            for index, item in enumerate(items):
                yield from _leaves(item, (*where, index))
        case MappingNode(entries):
            for key, value in entries:
                yield from _leaves(value, (*where, key.text))


def variations(text: str) -> Iterator[str]:
    """Yield values a little different from one, in its own unit: the next is for a kind that refuses the first.

    The first is larger by a hundredth, that of a whole number then by one, the last smaller by a hundredth. There are
    none of a text that is not a number.
    """
    typed = _NUMBER.fullmatch(text)
    if typed is None:
        return
    number = float(typed[1])
    more = [number + 1] if number.is_integer() else []
    for new in (number * SHARE, *more, number / SHARE) if number else (STEP, *more, -STEP):
        yield f"{new:.9g}{typed[2]}"


def difference(machine: Machine, changed: Machine) -> ControlledParts:
    """Return the difference between two machines of one kind, as bars and points."""
    before, after = machine.linkage, changed.linkage
    bars = [*_bars(before, after)]
    points = [*_points(before, after)]
    if not bars and not points:
        if _differ(machine.speed, changed.speed) and isinstance(before.driver, Crank):
            return ControlledParts(bars=((before.driver.centre, before.driver.pin),))
        points = [*_loaded(machine, changed)]
    return ControlledParts(tuple(dict.fromkeys(bars)), tuple(dict.fromkeys(points)))


def _differ(value: complex, other_value: complex) -> bool:
    return abs(value - other_value) > SAME * max(abs(value), abs(other_value))


def _bars(before: Linkage, after: Linkage) -> Iterator[Bar]:
    """Yield the crank and the rods whose length has changed."""
    crank = before.driver
    if isinstance(crank, Crank) and isinstance(after.driver, Crank) and _differ(crank.length, after.driver.length):
        yield crank.centre, crank.pin
    for dyad, changed in zip(before.dyads, after.dyads, strict=False):
        for end, length, new in zip((dyad.start, dyad.end), dyad.lengths, changed.lengths, strict=True):
            if isinstance(end, str) and _differ(length, new):
                yield end, dyad.middle
    for leg, changed_leg in _leg_pairs(before, after):
        if _differ(leg.length, changed_leg.length):
            yield leg.outer, leg.inner


def _leg_pairs(before: Linkage, after: Linkage) -> Iterator[tuple[TriadLeg, TriadLeg]]:
    for triad, changed in zip(before.triads, after.triads, strict=False):
        yield from zip(triad.legs, changed.legs, strict=True)


def _points(before: Linkage, after: Linkage) -> Iterator[str]:
    """Yield the fixed points, points of links, pins of guides and mass centres that have changed."""
    yield from (name for name, at in before.ground.items() if _differ(at, after.ground.get(name, at)))
    for dyad, changed in zip(before.dyads, after.dyads, strict=False):
        if _guides(dyad) != _guides(changed) or _differ(dyad.slide_angle, changed.slide_angle):
            yield dyad.middle
    for triad, changed_triad in zip(before.triads, after.triads, strict=False):
        for leg, at, new_at in zip(triad.legs, triad.locals, changed_triad.locals, strict=True):
            if _differ(at, new_at):
                yield leg.inner
    for point, changed_point in zip(before.points, after.points, strict=False):
        if _differ(point.local, changed_point.local):
            yield point.name
    bodies = {body.link: body for body in before.inertias}
    for body in after.inertias:
        old = bodies.get(body.link)
        if old is None or _differ(old.mass, body.mass) or _differ(old.moment, body.moment):
            yield body.centre


def _guides(dyad: Dyad) -> tuple[Mapping[str, Any], ...]:
    """Return place and direction of the guides of a group, rounded so that floating-point noise does not count."""
    return tuple(
        {"at": complex(np.round(end.at, 12)), "angle": round(end.angle, 12)}
        for end in (dyad.start, dyad.end)
        if isinstance(end, Guide)
    )


def _loaded(machine: Machine, changed: Machine) -> Iterator[str]:
    """Yield a point of each link on which another load acts."""
    angles = np.linspace(0.0, 2 * np.pi * machine.turns, SAMPLES)
    before, after = (analyse(each, angles).applied for each in (machine, changed))
    pins = _pins(machine.linkage)
    for load, new in zip(before, after, strict=False):
        for size, new_size in ((load.force, new.force), (load.couple, new.couple)):
            greatest = float(np.nanmax(np.abs(size), initial=0.0))
            if np.nanmax(np.abs(size - new_size), initial=0.0) > SAME * greatest and load.link in pins:
                yield pins[load.link]


def _pins(linkage: Linkage) -> dict[int, str]:
    """Return a point of each moving link by the link's number: the inner joint of its dyad or leg."""
    pins = {link: dyad.middle for dyad in linkage.dyads for link in dyad.links}
    pins |= {triad.plate: triad.legs[0].inner for triad in linkage.triads}
    pins |= {leg.link: leg.inner for triad in linkage.triads for leg in triad.legs}
    return {1: linkage.driver.pin, **pins}
