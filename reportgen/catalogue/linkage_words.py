"""Values for the templates of a declared linkage: rows of plain values, with quantities as typed."""

from __future__ import annotations

from collections.abc import Container, Iterator
from functools import partial
from typing import Any

from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.catalogue import linkage_file as file
from reportgen.catalogue.declared_loads import LoadRow, row_of
from reportgen.catalogue.typed_quantities import as_typed
from reportgen.formula import Number, ids, vocabulary
from reportgen.machine import Guide


@view("drawing")
class GroupRow(Record):
    """A group: its links, kind, joints and the lengths of its rods, each with its ends."""

    links: tuple[int, ...]
    kind: str
    joints: tuple[str, ...]
    lengths: tuple[tuple[str, Number], ...] = ()
    choice: str = ""
    """The chosen one of two ways of assembly: left, right, far, near, towards, away, or ""."""
    offset: Number | None = None
    across: Number | None = None
    near: tuple[tuple[str, Number, Number], ...] = ()
    """The points near which joints of a ternary link lie, which select the assembly mode."""
    near_at: Number | None = None
    """The angle of the crank at which they lie there; None if a slide drives, which is then at its start."""

    @property
    def drawing(self) -> str:
        """Key of the phrases for its drawing."""
        return "RPR-offset" if self.offset else self.kind


class GuideRow(Record):
    """A guide: the link that slides, the link that carries it, a point of it, its direction."""

    slider: int
    carrier: int
    x: Number
    y: Number
    angle: Number


class PointRow(Record):
    """A point of a link by its distances from a joint.

    `way` is the joint towards which the axis points, or "guide" or "slot" for the line to which it is parallel.
    """

    name: str
    link: int
    origin: str
    way: str
    along: Number
    across: Number


@view()
class MotionRow(Record):
    """Motion of a link: "rotation" about a fixed point, "translation" along a fixed guide, "shift" without
    rotation, or "plane" motion.

    `called` is the name of the link in a machine of the atlas.
    """

    link: int
    kind: str
    point: str = ""
    called: str = ""


def facts(given: file.Parameters, loads: tuple[str, ...], acting: Container[str]) -> dict[str, Any]:
    """Return the values that the kind's templates may use; `loads` are the ids of the loads in the order of the file.

    Only the loads in `acting` are included.
    """
    rows = tuple(_group(group, isinstance(given.driver, file.CrankDriver)) for group in given.groups)
    axes = link_axes(given)
    acting_loads = tuple(_load(load, name) for load, name in zip(given.loads, loads, strict=True) if name in acting)
    return {
        "about": "",
        "task": "",
        "called": {},
        "links": {},
        "first": "",
        "derived": False,
        "derived_places": False,
        "parameters": (),
        "frame": [(vocabulary.point(name), *map(as_typed, at)) for name, at in given.frame.items()],
        "quantities": tuple(_quantities(given, rows)),
        "groups": rows,
        "guides": tuple(_guides(given)),
        "points": (
            *(
                PointRow(name, group.plate, *axes[group.plate], *map(as_typed, at))
                for group in given.groups
                if isinstance(group, file.TernaryGroup)
                for name, at in group.at.items()
            ),
            *(
                PointRow(name, point.link, *axes[point.link], *map(as_typed, point.at))
                for name, point in given.points.items()
            ),
        ),
        "motions": tuple(_motions(given)),
        "listed": "given" if given.masses else "massless",
        "loads": acting_loads,
        "declared": (),
        "interpolated": tuple(load for load in acting_loads if load.nodes),
        "two_turns": given.turns == 2,
        "gases": tuple(load for load in acting_loads if load.by == "gas"),
    }


def rods(group: file.GroupSection) -> tuple[str, ...]:
    """Return the rods of a group that have a length, by their ends."""
    return tuple(rod for rod, _ in _group(group).lengths)


def arms(given: file.Parameters) -> Iterator[str]:
    """Yield the lengths that do not change, by their ends: crank, rods, points of the links."""
    if isinstance(given.driver, file.CrankDriver):
        yield f"{given.driver.centre}{given.driver.pin}"
    for group in given.groups:
        yield from rods(group)
    axes = link_axes(given)
    yield from (f"{axes[point.link][0]}{name}" for name, point in given.points.items())


def _quantities(given: file.Parameters, rows: tuple[GroupRow, ...]) -> Iterator[tuple[str, str, str]]:
    """Yield ids of given quantities, their meaning, and their link or the points between which they are measured."""
    driver = given.driver
    if isinstance(driver, file.CrankDriver):
        yield ids.length(driver.centre, driver.pin), "crank", ""
        yield "n", "n", ""
        yield "omega.1", "omega1", ""
        yield "eps.1", "epsilon1", ""
    else:
        yield ids.velocity(driver.pin), "speed", ""
        if driver.rate2:
            yield ids.acceleration(driver.pin), "acceleration", ""
        yield "span", "span", ""
    for row in rows:
        yield from ((ids.length(rod), "length", rod) for rod, _ in row.lengths)
    for body in given.masses:
        for id, what in ((ids.weight(body.link), "G"), (ids.mass(body.link), "m"), (ids.inertia(body.link), "J")):
            yield id, what, str(body.link)
    yield "g", "g", ""


def link_axes(given: file.Parameters) -> dict[int, tuple[str, str]]:
    """Return the origin of each link's axes, and the joint to which they point or the line to which they are parallel
    ("guide", "slot").
    """
    driver = given.driver
    axes = {1: (driver.centre, driver.pin) if isinstance(driver, file.CrankDriver) else (driver.pin, "guide")}
    for group in given.groups:
        if isinstance(group, file.TernaryGroup):
            axes |= {leg.link: (leg.joints[0], leg.joints[1]) for leg in group.legs}
            axes[group.plate] = group.inner[0], group.inner[1]
            continue
        first, last = group.joints[0], group.joints[-1]
        match group:
            case file.RRR():
                ways = group.joints[1], group.joints[1]
            case file.RRP():
                ways = last, "guide"
            case file.RPR():
                ways = "slot", "slot"
            case _:
                ways = "guide", "guide"
        axes |= dict(zip(group.links, zip((first, last), ways, strict=True), strict=True))
    return axes


def _motions(given: file.Parameters) -> Iterator[MotionRow]:
    # Links that do not turn: the frame, a sliding driver, and links that slide on such a link.
    level = {0} if isinstance(given.driver, file.CrankDriver) else {0, 1}
    for group in given.groups:
        if isinstance(group, file.TernaryGroup):
            for leg in group.legs:
                outer = leg.joints[0]
                yield MotionRow(leg.link, "rotation", outer) if outer in given.frame else MotionRow(leg.link, "plane")
            yield MotionRow(group.plate, "plane")
            continue
        dyad = group.dyad
        turns_alike = isinstance(group, file.RPP) and group.guide.on in level
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            slides_level = isinstance(end, Guide) and end.link in level
            if turns_alike or slides_level:
                level.add(link)
            if isinstance(end, Guide):
                yield MotionRow(link, "translation" if end.link == 0 else "shift" if slides_level else "plane")
            elif turns_alike:
                yield MotionRow(link, "shift")
            else:
                yield MotionRow(link, "rotation", end) if end in given.frame else MotionRow(link, "plane")


def _group(group: file.GroupSection, cranked: bool = True) -> GroupRow:
    if isinstance(group, file.TernaryGroup):
        names = tuple(name for leg in group.legs for name in leg.joints)
        rods = tuple(("".join(leg.joints), as_typed(leg.length)) for leg in group.legs)
        near = tuple((name, as_typed(x), as_typed(y)) for name, (x, y) in group.near.items())
        at = Number(0.0, unit="°") if group.near_at is None else as_typed(group.near_at)
        near_at = at if cranked else None
        return GroupRow(group.links, group.type, names, rods, choice="nearest", near=near, near_at=near_at)
    joints = group.joints
    row = partial(GroupRow, group.dyad.links, group.type, joints)
    match group:
        case file.RRR():
            ends = f"{joints[0]}{joints[1]}", f"{joints[2]}{joints[1]}"
            return row(tuple(zip(ends, map(as_typed, group.lengths), strict=True)), group.side)
        case file.RRP():
            return row(((f"{joints[0]}{joints[1]}", as_typed(group.length)),), group.end)
        case file.RPR():
            return row(choice=group.axis, offset=as_typed(group.offset) if group.offset.si else None)
        case file.RPP():
            return row(across=as_typed(group.across))
    return row()


def _guides(given: file.Parameters) -> Iterator[GuideRow]:
    if isinstance(given.driver, file.SlideDriver):
        yield _guide(1, given.driver.guide)
    for group in given.groups:
        yield from (_guide(link, guide) for link, guide, _ in file.rails(group))


def _guide(slider: int, guide: file.GuideSection) -> GuideRow:
    return GuideRow(slider, guide.on, *map(as_typed, (*guide.at, guide.angle)))


def _load(load: file.Loading, name: str) -> LoadRow:
    match load:
        case file.OverStroke():
            return LoadRow(name, load.link, "stroke", False, nodes=load.s, rows=(load.inward, load.outward))
        case file.Gas():
            return LoadRow(name, load.link, "gas", False, bore=as_typed(load.D), intake=load.intake)
    return row_of(load, name)
