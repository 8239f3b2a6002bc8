"""Values of a file that place a point of the machine, and new values for a point that is pulled elsewhere: `Pull`.

No kind names its values here. A value is varied a little, and the numbers of the linkage that follow show which pin,
fixed point or point of a link it places. The values that place no other joint are preferred.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Protocol

import numpy as np

from reportgen import catalogue
from reportgen.assignment.fields import RANGE_KEY, UNIT_KEY
from reportgen.assignment.schema import file_schema, places
from reportgen.base.errors import Location, Where
from reportgen.base.records import Record, replace
from reportgen.base.units import NUMBER
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source
from reportgen.base.yaml_values import at, put
from reportgen.machine import Linkage, joints
from reportgen.machine.analysis import Machine
from reportgen.machine.kinematics import solve_motion
from reportgen.page.linkage_numbers import Course, numbers, placed, rebuilt

SHARE, STEP = 0.02, 0.5
"""Share by which a value is varied; a value of 0 is varied by `STEP` in its own unit."""
FAR = 8.0
"""Number of variations beyond which the linkage is made from the file anew."""
COARSE, FINEST, FEWEST = 100, 4, 20
"""Whole numbers from here on have steps of 5; figures of the finest steps; least number of steps in a value."""
ALONG = 0.1
"""Sine of the angle between the ways of a point below which two values move it along one line."""
ROUNDS, CLOSE = 12, 1e-6
"""Largest number of improvements, and the distance (share of the linkage's size) at which a point has arrived."""
SAME = 1e-6
"""Share of a step below which two numbers are equal."""
MOST_VALUES = 120
"""Largest number of values of a file that are examined."""
USUAL_SHARES = "0.50", "0.00"
"""Shares of a link at which a mass centre is if the file does not say it."""
_TYPED = re.compile(rf"\s*({NUMBER}\s*/\s*)?({NUMBER})(.*)", re.DOTALL)


class TypedNumber(Record):
    """A number as typed; of a ratio such as 1/3.6 the lower one, after `over`."""

    over: str
    number: float
    decimals: int
    """Decimals of the steps: those typed, but more for a value of few steps, and not more than four figures."""
    unit: str
    begun: tuple[float, str]
    """The number with which a pull began, and its text."""

    @classmethod
    def of(cls, text: str) -> TypedNumber | None:
        """Return the number of a text; None for other texts and for numbers with an exponent."""
        typed = _TYPED.fullmatch(text)
        if typed is None or "e" in typed[2].lower():
            return None
        number, decimals = float(typed[2]), len(typed[2].partition(".")[2])
        if number:
            size = -math.floor(math.log10(abs(number)))
            decimals = min(decimals, max(size + FINEST - 1, 0))
            while abs(number) < FEWEST * 10.0**-decimals:
                decimals += 1
        return cls(typed[1] or "", number, decimals, typed[3], (number, text))

    @property
    def step(self) -> float:
        """The step of the arrow keys: a unit of the last digit, and five of a large whole number."""
        large = abs(self.number) >= COARSE and not self.decimals
        return float(10.0**-self.decimals * (5 if large else 1))

    def text(self, number: float) -> str:
        """Return a number in the same form; that with which the pull began, as it was typed."""
        begun, typed = self.begun
        if abs(number - begun) < SAME * self.step:
            return typed
        return f"{self.over}{number:.{self.decimals}f}{self.unit}"

    def unrounded(self, number: float) -> str:
        """Return a number in the same form with all its decimals."""
        return f"{self.over}{number:.12g}{self.unit}"

    def stepped(self, number: float, low: float, high: float) -> float:
        """Return the number of whole steps within bounds that is nearest to a number, or the first one if it is."""
        if abs(number - self.begun[0]) < self.step / 2:
            return self.begun[0]
        whole = round(number / self.step) * self.step
        inward = whole + self.step * ((whole < low) - (whole > high))
        return min(max(inward, low), high)


class PlacingValue(Record):
    """A value of a file, the `points` that it places, and how the numbers of the linkage follow it."""

    where: Where
    typed: TypedNumber
    points: frozenset[str]
    course: Course
    low: float
    high: float


def placing_values(
    source: Source, path: Path, only: Sequence[Where] = ()
) -> tuple[Linkage | None, tuple[PlacingValue, ...]]:
    """Return the linkage of a file and the values of its parameters that place points, in the order of the file.

    With `only`, other values are not examined, and the order is that of `only`. The linkage is None if the file gives
    none.
    """
    top, linkage = source.top, catalogue.linkage_of(source, path)
    if linkage is None or not isinstance(top, MappingNode):
        return None, ()
    data = top.find("parameters")
    given = list(leaves(data[1], ("parameters",)))[:MOST_VALUES] if data else []
    given += [] if only else _left_out(source, path, linkage)
    if only:
        nodes = dict(given)
        given = [(where, nodes[where]) for where in only if where in nodes]
    return linkage, tuple(value for leaf in given if (value := _placing(source, path, linkage, *leaf)))


def _left_out(source: Source, path: Path, linkage: Linkage) -> Iterator[tuple[Where, Scalar]]:
    """Yield the places of mass centres that a file may give and leaves out, with the shares at which they then are."""
    top = source.top
    name = top.find("kind") if isinstance(top, MappingNode) else None
    if top is None or name is None or not isinstance(name[1], Scalar):
        return
    heavy = {body.link for body in linkage.inertias}
    for link in getattr(catalogue.kind(name[1].text).base, "links", {}).get("s", ()):
        where: Where = ("parameters", f"s{link}")
        if link not in heavy or at(top, where) is not None:
            continue
        for share in map(Scalar, USUAL_SHARES, [Location("")] * len(USUAL_SHARES)):
            made = catalogue.linkage_of(replace(source, top=put(top, where, share)), path)
            if made is not None and np.array_equal(numbers(made), numbers(linkage)):
                yield where, share
                break


def leaves(node: Node, where: Where) -> Iterator[tuple[Where, Scalar]]:
    """Yield the values at and below a node with their places."""
    match node:
        case Scalar(null=False):
            yield where, node
        case SequenceNode(items):
            for index, item in enumerate(items):
                yield from leaves(item, (*where, index))
        case MappingNode(entries):
            for key, value in entries:
                yield from leaves(value, (*where, key.text))


def _placing(source: Source, path: Path, linkage: Linkage, where: Where, scalar: Scalar) -> PlacingValue | None:
    typed = TypedNumber.of(scalar.text)
    if typed is None:
        return None
    step, here = abs(typed.number) * SHARE or STEP, numbers(linkage)
    varied: list[np.ndarray | None] = []
    for sense in (1, -1):
        text = typed.unrounded(typed.number + sense * step)
        changed = replace(source, top=put(source.top, where, replace(scalar, text=text)) if source.top else None)
        made = catalogue.linkage_of(changed, path)
        new = None if made is None else numbers(made)
        varied.append(None if new is None or new.size != here.size else new - here)
        if varied[0] is not None and not Course(step, varied[0], varied[0], here).moves.any():
            return None
    after, before = varied
    # At an edge of what is possible there are values on one side only.
    if after is None:
        if before is None:
            return None
        after = -before
    course = Course(step, -after if before is None else before, after, here)
    followed = {point for point, moves in zip(placed(linkage), course.moves, strict=True) if moves}
    pins = followed & {joint.point for joint in joints(linkage)}
    if not followed:
        return None
    return PlacingValue(where, typed, frozenset(pins or followed), course, *bounds(source, where, typed))


def bounds(source: Source, where: Where, typed: TypedNumber) -> tuple[float, float]:
    """Return the bounds of the key at a place in the unit that is typed; infinite if that is another unit."""
    kind = source.top.find("kind") if isinstance(source.top, MappingNode) else None
    assert kind is not None, "a linkage has a kind"
    assert isinstance(kind[1], Scalar), "a kind is a name"
    schema = file_schema(catalogue.kind(kind[1].text))
    for about in places(schema, schema, where):
        if about.get(UNIT_KEY, "") == typed.unit.strip():
            limits = about.get(RANGE_KEY, about)
            low = limits.get("minimum", limits.get("exclusiveMinimum", -np.inf))
            high = limits.get("maximum", limits.get("exclusiveMaximum", np.inf))
            return (-np.inf, np.inf) if typed.over else (float(low), float(high))
    return -np.inf, np.inf


class Pull(Record, dict=True):
    """A point that is pulled at one coordinate of the driver (rad, or m of a slide), and the values that follow.

    `start` are the numbers of the values, in their own units, for which the linkage was made.
    """

    linkage: Linkage
    point: str
    driver: float
    values: tuple[PlacingValue, ...]

    @classmethod
    def of(
        cls, linkage: Linkage, known: Collection[PlacingValue], point: str, driver: float, locked: Collection[Where]
    ) -> Pull:
        """Return the pull of a point by one or two values that are not locked: those that place fewest other joints.

        It has no values if none can move the point at this place of the driver.
        """
        free = [value for value in known if point in value.points and not is_locked(value.where, locked)]
        for count in sorted({len(value.points) for value in free}):
            alike = tuple(value for value in free if len(value.points) == count)
            ways = cls(linkage, point, driver, alike).ways(np.zeros(len(alike)))
            greatest = float(np.nanmax(np.abs(ways) * [value.course.step for value in alike], initial=0.0))
            moving = [
                (value, along)
                for value, along in zip(alike, ways, strict=True)
                if abs(along) * value.course.step > ALONG**2 * greatest > 0
            ]
            if moving:
                first = moving[0]
                across = [(value, along) for value, along in moving[1:] if _sine(first[1], along) > ALONG]
                return cls(linkage, point, driver, tuple(value for value, _ in (first, *across[:1])))
        return cls(linkage, point, driver, ())

    def made(self, offsets: np.ndarray) -> Linkage:
        """Return the linkage whose values differ by so much [values]."""
        total = self.here.copy()
        for value, by in zip(self.values, offsets.tolist(), strict=True):
            total += value.course.change(by)
        return rebuilt(self.linkage, total)

    @cached_property
    def here(self) -> np.ndarray:
        """The numbers of the linkage [N]."""
        return numbers(self.linkage)

    def at(self, offsets: np.ndarray) -> complex:
        """Return the place of the point (m) for such values [values]; nan if the linkage does not assemble there."""
        return place_of(self.made(offsets), self.point, self.driver)

    def ways(self, offsets: np.ndarray, here: complex | None = None) -> np.ndarray:
        """Return how far the point goes (m) for a unit of each value [values]; `here` is its place, if known."""
        here, ways = self.at(offsets) if here is None else here, []
        for index, value in enumerate(self.values):
            by = np.zeros(len(self.values))
            by[index] = value.course.step * SHARE
            ways.append((self.at(offsets + by) - here) / by[index])
        return np.array(ways, dtype=np.complex128)

    def to(self, target: complex, guess: np.ndarray) -> np.ndarray:
        """Return the differences of the values [values] that bring the point to a place (m), or as near as they can."""
        offsets, size = guess, max(float(np.abs(self.here).max()), CLOSE)
        here = self.at(offsets)
        if not np.isfinite(here):
            offsets = np.zeros(len(self.values))
            here = self.at(offsets)
        for _ in range(ROUNDS):
            ways = self.ways(offsets, here)
            if not np.isfinite(ways).all():
                break
            equations = np.array([ways.real, ways.imag])
            missing = np.array([(target - here).real, (target - here).imag])
            step = np.linalg.lstsq(equations, missing, rcond=ALONG**2)[0]
            better = None
            for _ in range(ROUNDS):
                there = self.at(offsets + step)
                if abs(there - target) < abs(here - target):
                    better = there
                    break
                step = step / 2
            if better is None:
                break
            arrived = abs(better - here) < CLOSE * size
            offsets, here = offsets + step, better
            if arrived:
                break
        return offsets

    def texts(self, offsets: np.ndarray) -> list[tuple[Where, str]]:
        """Return the values as they are typed, in whole steps within their bounds; unchanged ones as they were."""
        return texts(self.values, offsets)

    def rounded(self, offsets: np.ndarray) -> np.ndarray:
        """Return the differences [values] of numbers in whole steps within their bounds."""
        return rounded(self.values, offsets)


class Stepped(Protocol):
    """A value at a place of a file whose number, as `typed`, has bounds."""

    @property
    def where(self) -> Where: ...
    @property
    def typed(self) -> TypedNumber: ...
    @property
    def low(self) -> float: ...
    @property
    def high(self) -> float: ...


def rounded(values: Sequence[Stepped], offsets: np.ndarray) -> np.ndarray:
    """Return the differences [values] of numbers in whole steps within their bounds."""
    steps = [
        value.typed.stepped(value.typed.number + by, value.low, value.high) - value.typed.number
        if abs(by) >= value.typed.step / 2 or value.typed.number != value.typed.begun[0]
        else 0.0
        for value, by in zip(values, offsets.tolist(), strict=True)
    ]
    return np.array(steps)


def texts(values: Sequence[Stepped], offsets: np.ndarray) -> list[tuple[Where, str]]:
    """Return the values as they are typed, in whole steps within their bounds; unchanged ones as they were."""
    moved = rounded(values, offsets).tolist()
    return [(value.where, value.typed.text(value.typed.number + by)) for value, by in zip(values, moved, strict=True)]


def with_texts(top: Node, typed: Iterable[tuple[Where, str]]) -> Node:
    """Return nodes with other texts at places; a value that the file leaves out is added."""
    for where, text in typed:
        old = at(top, where)
        top = put(top, where, replace(old, text=text) if isinstance(old, Scalar) else Scalar(text, Location("")))
    return top


def varied_machine(
    source: Source, path: Path, leaf: tuple[Where, Scalar], typed: TypedNumber
) -> tuple[Machine, float] | None:
    """Return the machine with a value that is varied a little, and by how much; None at an edge on both sides."""
    where, scalar = leaf
    assert source.top is not None, "a leaf has a file"
    for by in (abs(typed.number) * SHARE or STEP, -(abs(typed.number) * SHARE or STEP)):
        text = typed.unrounded(typed.number + by)
        made = catalogue.machine_of(replace(source, top=put(source.top, where, replace(scalar, text=text))), path)
        if made is not None:
            return made, by
    return None


def is_locked(where: Where, locked: Collection[Where]) -> bool:
    """Return whether a value stays as it is: it, or the list in which it stands, is locked."""
    return any(where[: len(place)] == place for place in locked)


def place_of(linkage: Linkage, point: str, driver: float) -> complex:
    """Return the place (m) of a point at a coordinate of the driver; nan if the linkage does not assemble there."""
    try:
        return complex(solve_motion(linkage, driver, 1.0).points[point].p[0])
    except ValueError:
        return complex(np.nan, np.nan)


def _sine(first: complex, second: complex) -> float:
    """Return |sin| of the angle between two directions."""
    return abs((first.conjugate() * second).imag) / (abs(first) * abs(second))
