"""Loads declared in a file, on any link of any machine: forces at named points, torques on links.

They are added to the loads that the kind itself has, and are named P (forces) and M (torques) with their link's
number.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import (
    Angle,
    CycleAngles,
    Force,
    ForceUnit,
    Nodes,
    NodeValues,
    Offset,
    Reader,
    UnitOf,
    Whole,
    fault,
    quantity,
)
from reportgen.base.arrays import Floats
from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.base.units import Given
from reportgen.catalogue.typed_quantities import as_typed, size_of
from reportgen.formula import Number, ids
from reportgen.formula.ids import Name as Family
from reportgen.machine import DRIVER, Crank, Guide, Linkage
from reportgen.machine.kinematics import Motion
from reportgen.machine.load_laws import AngleLaw, ConstantLaw, Law, MotionAt, Resistance, TravelLaw, opposing
from reportgen.machine.loads import Applied, Torque, fixed
from reportgen.machine.motion_sense import greatest_speed, moving

MOST_LOADS = LAST_LINK = 40
LEVEL = Given(0.0, 0.0, "deg", "0 deg")
_NAME = re.compile(r"[A-OR-Z][0-9]{0,2}|[PQ][0-9]{1,2}")


class PointName(Reader):
    """A capital letter and at most two digits; P and Q alone are letters of the plans."""

    def read(self, value: object) -> str:
        if not isinstance(value, str) or not _NAME.fullmatch(value):
            raise fault("point-name", text=str(value))
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^({_NAME.pattern})$"}


Name = Annotated[str, PointName()]
Link = Annotated[int, Whole(1, LAST_LINK)]
DriverWays = Annotated[tuple[Offset, ...], Nodes]
TorqueOf = Annotated[Given, quantity("N m", least=-1e9, most=1e9, tiny=1e-6)]


class Constant(Part):
    """A force F at a point in a fixed direction, or a torque M; of a load `against` the motion only the size is
    used.
    """

    by: Literal["constant"]
    link: Link
    at: Name | None = None
    F: Force | None = None
    direction: Angle = LEVEL
    M: TorqueOf | None = None
    against: Literal["motion"] | None = None


class _Listed(Part):
    """A force in a fixed direction or a torque, in a table."""

    by: str
    link: Link
    at: Name | None = None
    direction: Angle = LEVEL
    unit: ForceUnit | None = None
    torque_unit: Annotated[Given, UnitOf("N m")] | None = None


class OverAngle(_Listed):
    """A force or a torque over the driver's turn from the first position."""

    by: Literal["angle"]
    angle: CycleAngles
    values: NodeValues

    message_unit: ClassVar[tuple[float, str]] = (180 / math.pi, " deg")

    @property
    def nodes(self) -> tuple[Given, ...]:
        return self.angle


class OverWay(_Listed):
    """A force or a torque over the way of a sliding driver from its start."""

    by: Literal["way"]
    way: DriverWays
    values: NodeValues

    message_unit: ClassVar[tuple[float, str]] = (1e3, " mm")

    @property
    def nodes(self) -> tuple[Given, ...]:
        return self.way


PlainLoad = Constant | OverAngle | OverWay
CrankLoading = Annotated[Constant | OverAngle, Field(discriminator="by")]
"""Loads of a machine with a crank besides those of its kind."""


# --- checks ---------------------------------------------------------------------------------------


def pins(linkage: Linkage) -> dict[int, set[str]]:
    """Return the points of every moving link: its joints and the points fixed to it."""
    driver = linkage.driver
    points_of = {DRIVER: {driver.pin}}
    if isinstance(driver, Crank):
        points_of[DRIVER].add(driver.centre)
    for dyad in linkage.dyads:
        pinned = {"RPR": (), "RPP": dyad.links[1:]}.get(dyad.kind, dyad.links)
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            points_of[link] = set() if isinstance(end, Guide) else {end}
            points_of[link] |= {dyad.middle} if link in pinned else set()
    for triad in linkage.triads:
        points_of[triad.plate] = {leg.inner for leg in triad.legs}
        points_of |= {leg.link: {leg.outer, leg.inner} for leg in triad.legs}
    for point in linkage.points:
        points_of.setdefault(point.link, set()).add(point.name)
    return points_of


def listed(numbers: Collection[int]) -> str:
    """Return the numbers of links as text for a message."""
    return ", ".join(map(str, sorted(numbers)))


def on_link(points: Mapping[int, set[str]], link: int, name: str | None, at: Where) -> Iterator[Finding]:
    """Yield faults unless a link exists and has the point `name`; `points` are the points by link."""
    if link not in points:
        yield Finding("no-such-link", (*at, "link"), {"text": str(link), "known": listed(points)})
    elif name is not None and name not in points[link]:
        words = {"text": name, "link": str(link), "known": ", ".join(sorted(points[link]))}
        yield Finding("not-on-link", (*at, "at"), words)


def faults(load: PlainLoad, points: Mapping[int, set[str]], end: float, at: Where) -> Iterator[Finding]:
    """Yield faults unless a load is on an existing link and point (`points` by link), with the values of its type.

    The driver goes from 0 to `end` (rad or m).
    """
    yield from on_link(points, load.link, load.at, at)
    if not isinstance(load, Constant):
        factor, unit = load.message_unit
        nodes = tuple(node.si * factor for node in load.nodes)
        yield from table(at, load.by, nodes, end * factor, unit, values=load.values)
    yield from sized(load, at)


def sized(load: PlainLoad, at: Where) -> Iterator[Finding]:
    """Yield faults unless a force has a point and a size in newtons, and a torque has its own size and no point."""
    if isinstance(load, Constant):
        wanted, forbidden = ("F", "M") if load.at else ("M", "F")
        if getattr(load, wanted) is None:
            yield Finding("missing-key", at, {"key": wanted if load.at or load.F is None else "at"})
        if getattr(load, forbidden) is not None and getattr(load, wanted) is not None:
            yield Finding("force-or-torque", (*at, forbidden), at="key")
        return
    key, forbidden = ("unit", "torque_unit") if load.at else ("torque_unit", "unit")
    if getattr(load, key) is None:
        yield Finding("missing-key", at, {"key": key})
    if getattr(load, forbidden) is not None:
        yield Finding("force-or-torque", (*at, forbidden), at="key")


def table(
    at: Where, key: str, nodes: tuple[float, ...], last: float, unit: str = "", **rows: tuple[float, ...]
) -> Iterator[Finding]:
    """Yield faults unless the nodes (in `unit`) increase from 0 to `last` and every row has a value for each."""
    for name, row in rows.items():
        if len(row) != len(nodes):
            counts = {"key": name, "given": str(len(row)), "other": key, "wanted": str(len(nodes))}
            yield Finding("row-length", (*at, name), counts)
    fall = next((index for index, (one, other) in enumerate(pairwise(nodes), 1) if other <= one), None)
    if fall is not None:
        yield Finding("not-increasing", (*at, key, fall), {"key": key})
        return
    for index, wanted in ((0, 0.0), (len(nodes) - 1, last)):
        if abs(nodes[index] - wanted) > 1e-9 * last:
            yield Finding("table-end", (*at, key, index), {"key": key, "end": f"{wanted:g}{unit}"})


# --- loads ----------------------------------------------------------------------------------------


def named(family: Family, link: int, others: Iterable[Applied | Torque]) -> str:
    """Return the name of a load: P3; a second one on the same link is P3a, then P3b."""
    count = sum(one.link == link and one.name in family for one in others)
    return family(link, chr(ord("a") + count - 1)) if count else family(link)


def loads(
    declared: Sequence[Constant | OverAngle],
    linkage: Linkage,
    motion_at: MotionAt,
    others: Iterable[Applied | Torque] = (),
    *,
    through: bool = True,
) -> tuple[Applied | Torque, ...]:
    """Return the loads in the order of the file; `others` are those of the kind.  Faulty loads, which checks report,
    are left out.

    If `through` is True, the driver passes through the whole cycle; else it is at single instants.
    """
    points, before, made = pins(linkage), tuple(others), list[Applied | Torque]()
    for load in declared:
        if not [*on_link(points, load.link, load.at, ()), *sized(load, ())]:
            law = law_of(load, motion_at, through=through)
            made.append(applied(load, law, (*before, *made)))
    return tuple(made)


def rows(
    declared: Sequence[Constant | OverAngle], made: Sequence[Applied | Torque], idle: Collection[str]
) -> tuple[LoadRow, ...]:
    """Return the acting loads as rows for templates; an empty tuple if some load is faulty."""
    if len(declared) != len(made):
        return ()
    pairs = zip(declared, made, strict=True)
    return tuple(row_of(load, one.name) for load, one in pairs if one.name not in idle)


def applied(load: PlainLoad, law: Law, others: Iterable[Applied | Torque]) -> Applied | Torque:
    """Return a force at the load's point, or a torque where it has none."""
    if load.at is None:
        return Torque(named(ids.applied_torque, load.link, others), load.link, law)
    along = fixed(cmath.exp(1j * load.direction.si))
    return Applied(named(ids.applied_force, load.link, others), load.link, load.at, along, law)


def law_of(load: PlainLoad, motion_at: MotionAt, *, through: bool = True, span: float = 0.0) -> Law:
    """Return the law of a force along its direction, or of a torque if the load has no point; `span` (m) is a slider's
    travel.
    """
    if not isinstance(load, Constant):
        unit = load.torque_unit if load.at is None else load.unit
        assert unit is not None, "a table without its unit is refused by the kind's checks"
        nodes, sizes = tuple(node.si for node in load.nodes), tuple(value * unit.si for value in load.values)
        return TravelLaw(nodes, sizes, span) if isinstance(load, OverWay) else AngleLaw(nodes, sizes)
    size = load.M if load.at is None else load.F
    assert size is not None, "a load without its size is refused by the kind's checks"
    if not load.against:
        return ConstantLaw(size.si)
    direction = cmath.exp(1j * load.direction.si)

    def rate(motion: Motion) -> Floats:
        if load.at is None:
            return moving(motion.links[load.link].omega, greatest_speed(motion, "R"))
        return moving(np.real(np.conj(direction) * motion.points[load.at].v), greatest_speed(motion, "P"))

    return against(abs(size.si), rate, motion_at, through=through)


def against(size: float, rate: Callable[[Motion], Floats], motion_at: MotionAt, *, through: bool) -> Law:
    """Return a law of constant `size` (N, or N·m for a torque) that opposes a `rate` [N] of the motion."""
    if not through:
        return Resistance(size, rate, ())
    resistance = opposing(size, lambda angle: rate(motion_at(angle)))
    # A crank has an angular velocity, a slide has none.
    turns = bool(np.any(motion_at(np.zeros(1)).links[DRIVER].omega))
    return resistance if turns else Resistance(size, rate, resistance.reversals)


# --- values for templates -------------------------------------------------------------------------


@view("phrase", "table")
class LoadRow(Record):
    """A load for templates: its link, form, place and direction, and its size or table."""

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
    intake: str = ""

    @property
    def phrase(self) -> str:
        """Key of the phrase for this load: by its type, its variable, and whether it opposes the motion."""
        acting = "torque" if self.torque else "force"
        match self.by:
            case "constant":
                return f"{acting}-against" if self.against else acting
            case "gas":
                return f"gas-{self.intake}".replace(" ", "-")
            case "stroke":
                return "stroke"
        return f"{acting}-{self.by}"

    @property
    def table(self) -> str:
        """The key of the table of its values."""
        return f"tab.gas.law.{self.id}" if self.by == "gas" else f"tab.law.{self.id}"


def row_of(load: PlainLoad, name: str) -> LoadRow:
    """Return a load as a row for templates."""
    acting, direction = partial(LoadRow, name, load.link, load.by, load.at is None), as_typed(load.direction)
    row = partial(acting, load.at or "", direction)
    if not isinstance(load, Constant):
        return row(nodes=tuple(node.value for node in load.nodes), rows=(load.values,))
    size = load.F or load.M
    assert size is not None, "a load without its size is refused by the kind's checks"
    return row(size=as_typed(size_of(size) if load.against else size), against=load.against is not None)
