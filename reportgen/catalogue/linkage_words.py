"""What the words of a declared linkage name: rows of plain values, quantities as they were typed."""

from __future__ import annotations

from collections.abc import Container, Iterator
from dataclasses import dataclass
from typing import Any

from reportgen.catalogue import linkage_file as file
from reportgen.mechanism.structure import DyadKind
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Number
from reportgen.units import Given

UNITS = {"deg": "°", "degree": "°", "N m": "N·m", "kg m2": "kg·m²"}


@dataclass(frozen=True, slots=True)
class GroupRow:
    """A group: its links, kind, joints and the lengths of its rods, each with its ends."""

    links: tuple[int, int]
    kind: DyadKind
    joints: tuple[str, ...]
    lengths: tuple[tuple[str, Number], ...]
    choice: str
    """Which of two ways it is assembled: left, right, far, near, towards, away, or ""."""
    offset: Number | None = None
    across: Number | None = None


@dataclass(frozen=True, slots=True)
class GuideRow:
    """A guide: the link that slides, the link that has it, a point of it, its direction."""

    slider: int
    carrier: int
    x: Number
    y: Number
    angle: Number


@dataclass(frozen=True, slots=True)
class PointRow:
    """A point of a link by its distances from the link's first joint."""

    name: str
    link: int
    along: Number
    across: Number


@dataclass(frozen=True, slots=True)
class LoadRow:
    """A load: its link, how it is given, where and in which direction it acts, its size or its table."""

    id: str
    link: int
    by: str
    torque: bool
    point: str = ""
    direction: Number | None = None
    size: Number | None = None
    against: bool = False
    nodes: tuple[float, ...] = ()
    rows: tuple[tuple[float, ...], ...] = ()
    bore: Number | None = None


@dataclass(frozen=True, slots=True)
class MotionRow:
    """How a link moves: "rotation" about a fixed point, "translation" along a fixed guide,
    "shift" without rotation, or "plane" motion.
    """

    link: int
    kind: str
    point: str = ""


def facts(given: file.Parameters, loads: tuple[str, ...], acting: Container[str]) -> dict[str, Any]:
    """What the words of the kind name; `loads` are the ids of the loads in the order of the file.

    Only those that are `acting` are told of.
    """
    rows = groups(given)
    crank = given.driver
    arms = [f"{crank.centre}{crank.pin}"] if isinstance(crank, file.CrankDriver) else []
    arms += [rod for row in rows for rod, _ in row.lengths]
    origins = _origins(given)
    arms += [f"{origins[point.link]}{name}" for name, point in given.points.items()]
    return {
        "frame": [(vocabulary.point(name), *map(number, at)) for name, at in given.frame.items()],
        "quantities": tuple(_quantities(given, rows)),
        "groups": rows,
        "guides": guides(given),
        "points": points(given),
        "motions": tuple(_motions(given)),
        "arms": arms,
        "bodies": bool(given.masses),
        "loads": tuple(_load(load, name) for load, name in zip(given.loads, loads, strict=True) if name in acting),
        "load_ids": tuple(name for name in loads if name in acting),
    }


def _quantities(given: file.Parameters, rows: tuple[GroupRow, ...]) -> Iterator[tuple[str, str, str]]:
    """Ids of given quantities, what they are, and of which link or between which points."""
    driver = given.driver
    if isinstance(driver, file.CrankDriver):
        yield f"l.{driver.centre}{driver.pin}", "crank", ""
        yield "n", "n", ""
        yield "omega.1", "omega1", ""
    else:
        yield f"v.{driver.pin}", "speed", ""
        yield "span", "span", ""
    for row in rows:
        yield from ((f"l.{rod}", "length", rod) for rod, _ in row.lengths)
    for body in given.masses:
        for id, what in ((f"G{body.link}", "G"), (f"m.{body.link}", "m"), (f"J.{body.link}", "J")):
            yield id, what, str(body.link)
    yield "g", "g", ""


def _origins(given: file.Parameters) -> dict[int, str]:
    """The point that each link's own axes start at."""
    driver = given.driver
    found = {1: driver.centre if isinstance(driver, file.CrankDriver) else driver.pin}
    for group in given.groups:
        first, second = group.links
        names = group.joints
        found[first] = names[0]
        found[second] = names[2] if len(names) == 3 else names[-1]
    return found


def _motions(given: file.Parameters) -> Iterator[MotionRow]:
    # Links that do not turn: the frame, a sliding driver, and what slides on such a link.
    level = {0} if isinstance(given.driver, file.CrankDriver) else {0, 1}
    for group in given.groups:
        names = group.joints
        ends: list[str | file.GuideSection]
        match group:
            case file.RRR() | file.RPR():
                ends = [names[0], names[2]]
            case file.PRP():
                ends = list(group.guides)
            case _:
                ends = [names[0], group.guide]
        turns_alike = isinstance(group, file.RPP) and group.guide.on in level
        for link, end in zip(group.links, ends, strict=True):
            slides_level = isinstance(end, file.GuideSection) and end.on in level
            if turns_alike or slides_level:
                level.add(link)
            if isinstance(end, file.GuideSection):
                yield MotionRow(link, "translation" if end.on == 0 else "shift" if slides_level else "plane")
            elif turns_alike:
                yield MotionRow(link, "shift")
            else:
                yield MotionRow(link, "rotation", end) if end in given.frame else MotionRow(link, "plane")


def number(given: Given) -> Number:
    """A quantity as typed."""
    return Number(given.value, unit=UNITS.get(given.unit, given.unit))


def groups(given: file.Parameters) -> tuple[GroupRow, ...]:
    return tuple(map(_group, given.groups))


def _group(group: file.Group) -> GroupRow:
    links, joints = (group.links[0], group.links[1]), group.joints
    match group:
        case file.RRR():
            ends = f"{joints[0]}{joints[1]}", f"{joints[2]}{joints[1]}"
            lengths = tuple(zip(ends, map(number, group.lengths), strict=True))
            return GroupRow(links, "RRR", joints, lengths, group.side)
        case file.RRP():
            rod = f"{joints[0]}{joints[1]}", number(group.length)
            return GroupRow(links, "RRP", joints, (rod,), group.end)
        case file.RPR():
            offset = number(group.offset) if group.offset.si else None
            return GroupRow(links, "RPR", joints, (), group.axis, offset=offset)
        case file.RPP():
            return GroupRow(links, "RPP", joints, (), "", across=number(group.across))
    return GroupRow(links, "PRP", joints, (), "")


def guides(given: file.Parameters) -> tuple[GuideRow, ...]:
    return tuple(_guides(given))


def _guides(given: file.Parameters) -> Iterator[GuideRow]:
    if isinstance(given.driver, file.SlideDriver):
        yield _guide(1, given.driver.guide)
    for group in given.groups:
        if isinstance(group, file.PRP):
            yield from (_guide(link, guide) for link, guide in zip(group.links, group.guides, strict=True))
        elif isinstance(group, file.RRP | file.RPP):
            yield _guide(group.links[1], group.guide)


def _guide(slider: int, guide: file.GuideSection) -> GuideRow:
    return GuideRow(slider, guide.on, number(guide.at[0]), number(guide.at[1]), number(guide.angle))


def points(given: file.Parameters) -> tuple[PointRow, ...]:
    return tuple(
        PointRow(name, point.link, number(point.at[0]), number(point.at[1])) for name, point in given.points.items()
    )


def _load(load: file.Loading, name: str) -> LoadRow:
    match load:
        case file.OverStroke():
            return LoadRow(name, load.link, "stroke", False, nodes=load.s, rows=(load.inward, load.outward))
        case file.Gas():
            return LoadRow(name, load.link, "gas", False, bore=number(load.D))
        case file.OverAngle() | file.OverWay():
            given = load.angle if isinstance(load, file.OverAngle) else load.way
            nodes = tuple(node.value for node in given)
            torque, way = load.at is None, number(load.direction)
            return LoadRow(name, load.link, load.by, torque, load.at or "", way, nodes=nodes, rows=(load.values,))
    size = load.F or load.M
    assert size is not None
    return LoadRow(
        name,
        load.link,
        "constant",
        load.at is None,
        load.at or "",
        number(load.direction),
        number(size),
        load.against is not None,
    )
