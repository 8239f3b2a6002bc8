"""The loads of a declared linkage as laws over the cycle, and the ways of its sliders."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from reportgen.catalogue import linkage_file as file
from reportgen.catalogue import resistance
from reportgen.catalogue.course import FULL_TURN, Course, Floats
from reportgen.catalogue.laws import AngleLaw, Law, MotionAt, TableLaw, WayLaw, by_stroke
from reportgen.catalogue.machine import Applied, Torque
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import DRIVER, GROUND, Dyad, Guide, Linkage

ROUND = 1e-9
"""A slider this near (rad of the driver) to its top stands there."""


@dataclass(frozen=True)
class Resistance:
    """−`size`·sgn(rate) over the way of a sliding driver, which does not come back to its start."""

    size: float
    rate: Callable[[Motion], Floats]
    reversals: tuple[float, ...]

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return -self.size * np.sign(self.rate(motion))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.reversals


class NotToAndFro(ValueError):
    """A slider that does not go once to and fro in a turn of the driver; carries its number of reversals."""

    def __init__(self, reversals: int) -> None:
        self.reversals = reversals
        super().__init__(f"{reversals} reversals")


def rails(linkage: Linkage) -> dict[int, tuple[Dyad, Guide]]:
    """The sliders on guides of the frame, by link: their group and guide."""
    found = {}
    for dyad in linkage.dyads:
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            if isinstance(end, Guide) and end.link == GROUND:
                found[link] = dyad, end
    return found


def course(linkage: Linkage, link: int, motion_at: MotionAt, turns: int = 1, top: int = 1) -> Course:
    """The way of a slider on the frame; its top is the end farther along the guide.

    Intake starts at the passage number `top` of the top.  Raises `NotToAndFro` for a slider that turns
    back more than twice in a turn of the driver.
    """
    dyad, guide = rails(linkage)[link]
    along = cmath.exp(1j * guide.angle)

    def rate(angle: Floats) -> Floats:
        return np.asarray(np.real(np.conj(along) * motion_at(angle).points[dyad.middle].v))

    reversals = resistance.opposing(1.0, rate).reversals
    if len(reversals) != 2:
        raise NotToAndFro(len(reversals))
    ends = motion_at(np.array(reversals)).points[dyad.middle].p
    high = int(np.argmax(np.real(np.conj(along) * ends)))
    first = float(np.mod(reversals[high] + ROUND, FULL_TURN) - ROUND)
    way = (reversals[1 - high] - reversals[high]) % FULL_TURN
    whole = turns * FULL_TURN
    phase = (-(first + FULL_TURN * (top - 1)) + ROUND) % whole - ROUND
    crank_pin = dyad.start if isinstance(dyad.start, str) else dyad.middle
    other = dyad.links[0] if dyad.links[1] == link else dyad.links[1]
    return Course(
        link, other, dyad.middle, crank_pin, complex(ends[high]), complex(ends[1 - high]), 0.0, way, phase
    )


def laid_on(given: file.Parameters, linkage: Linkage, motion_at: MotionAt) -> tuple[Applied | Torque, ...]:
    """The loads in the order of the file, named P (forces) and M (torques) with their link's number."""
    found: list[Applied | Torque] = []
    for load in given.loads:
        link = load.link
        if isinstance(load, file.OverStroke | file.Gas):
            found.append(_on_slider(load, given, linkage, motion_at, _name("P", link, found)))
        elif load.at is None:
            found.append(Torque(_name("M", link, found), link, _turning(load, given.driver, motion_at)))
        else:
            direction = cmath.exp(1j * load.direction.si)
            law = _pushing(load, load.at, direction, given.driver, motion_at)
            found.append(Applied(_name("P", link, found), link, load.at, direction, law))
    return tuple(found)


def _name(letter: str, link: int, others: Iterable[Applied | Torque]) -> str:
    """P3; a second one on the same link P3a, then P3b."""
    count = sum(one.link == link and one.name[0] == letter for one in others)
    return f"{letter}{link}{chr(ord('a') + count - 1) if count else ''}"


def _on_slider(
    load: file.OverStroke | file.Gas, given: file.Parameters, linkage: Linkage, motion_at: MotionAt, name: str
) -> Applied:
    dyad, guide = rails(linkage)[load.link]
    if isinstance(load, file.Gas):
        top = 1 if load.intake == "first top" else 2
        way = course(linkage, load.link, motion_at, given.turns, top)
        area = float(np.pi * load.D.si**2 / 4)
        return Applied(name, load.link, dyad.middle, way.inward, TableLaw(way, load.diagram.table, area))
    one = load.unit.si
    table = by_stroke(load.s, *(tuple(value * one for value in row) for row in (load.inward, load.outward)))
    way = course(linkage, load.link, motion_at)
    return Applied(name, load.link, dyad.middle, cmath.exp(1j * guide.angle), TableLaw(way, table, turns=1))


def _pushing(
    load: file.Constant | file.OverAngle | file.OverWay,
    point: str,
    direction: complex,
    driver: file.Driver,
    motion_at: MotionAt,
) -> Law:
    if not isinstance(load, file.Constant):
        return _by_driver(load, load.unit.si if load.unit else 1.0, driver)
    assert load.F is not None

    def rate(motion: Motion) -> Floats:
        return np.asarray(np.real(np.conj(direction) * motion.points[point].v))

    return _constant(load, load.F.si, rate, motion_at)


def _turning(
    load: file.Constant | file.OverAngle | file.OverWay, driver: file.Driver, motion_at: MotionAt
) -> Law:
    if not isinstance(load, file.Constant):
        return _by_driver(load, load.torque_unit.si if load.torque_unit else 1.0, driver)
    assert load.M is not None
    return _constant(load, load.M.si, lambda motion: motion.links[load.link].omega, motion_at)


def _constant(
    load: file.Constant, size: float, rate: Callable[[Motion], Floats], motion_at: MotionAt
) -> Law:
    if not load.against:
        return resistance.Constant(size)
    found = resistance.opposing(abs(size), lambda angle: rate(motion_at(angle)))
    # A crank has an angular velocity of its own, a slide has none.
    turns = bool(np.any(motion_at(np.zeros(1)).links[DRIVER].omega))
    return found if turns else Resistance(abs(size), rate, found.reversals)


def _by_driver(load: file.OverAngle | file.OverWay, one: float, driver: file.Driver) -> Law:
    values = tuple(value * one for value in load.values)
    if isinstance(load, file.OverAngle):
        return AngleLaw(tuple(angle.si for angle in load.angle), values)
    assert isinstance(driver, file.SlideDriver), "a file with another driver is refused by the kind's checks"
    return WayLaw(tuple(way.si for way in load.way), values, driver.span)
