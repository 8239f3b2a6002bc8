"""The springs section of a file: springs between a link and the frame, between two links, or about a pin of
the frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Either, Quantity, Reader, Whole, fault, quantity
from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.base.units import Given, measures
from reportgen.catalogue.declared_loads import LAST_LINK, MOST_LOADS, Link, Name, PointName, named, on_link, pins
from reportgen.catalogue.topic_sections import Opening, TopicData, TopicParameters, TopicSection
from reportgen.catalogue.typed_quantities import as_typed
from reportgen.formula import Number, Symbol, ids
from reportgen.machine import GROUND, Linkage
from reportgen.machine.analysis import Machine
from reportgen.machine.analysis import motion_at as motion_of
from reportgen.machine.load_laws import FULL_TURN, STEPS, MotionAt
from reportgen.machine.loads import Applied, Torque
from reportgen.machine.spring_geometry import Anchor
from reportgen.springs.spring_laws import SpringLaw, TorsionLaw, within_half_a_turn

COORDINATE = quantity("mm", above=-1e5, below=1e5, tiny=1e-4)
STIFFNESS = quantity("N/mm", least=0, most=1e9, tiny=1e-9)
TORSION = quantity("N m/rad", least=0, most=1e9, tiny=1e-9)
LENGTH = quantity("mm", least=0, below=1e5, tiny=1e-4)
ROUNDING = 1e-9
"""Rounding tolerance as a share of a turn."""
ANGLE = quantity("deg", least=-360, most=360, tiny=1e-6)


class End(Record):
    """The far end of a spring: a fixed point by name, a place of the frame, or a point of another link."""

    name: str = ""
    link: int = GROUND
    place: tuple[Given, Given] | None = None


class SpringEnd(Reader):
    """`D`, `[300 mm, 420 mm]` or `{link: 2, at: E}`."""

    def read(self, value: object) -> End:
        match value:
            case str():
                return End(PointName().read(value))
            case [x, y]:
                return End(place=(COORDINATE.read(x), COORDINATE.read(y)))
            case {"link": link, "at": at, **others} if not others:
                return End(PointName().read(at), Whole(1, LAST_LINK).read(link))
        raise fault("spring-end")

    def schema(self) -> dict[str, Any]:
        pair = {"type": "array", "items": Quantity("mm").schema(), "minItems": 2, "maxItems": 2}
        keys = {"link": Whole(1, LAST_LINK).schema(), "at": PointName().schema()}
        table = {"type": "object", "properties": keys, "required": [*keys], "additionalProperties": False}
        return {"anyOf": [PointName().schema(), pair, table]}


class Spring(Part):
    """A spring from a point `at` of a link `to` another place, or a torsion spring on a link `about` a fixed pin.

    Its stiffness is `c`; with the `free` length, or at the `free` angle of the link from +x, it is slack.
    """

    link: Link
    at: Name | None = None
    to: Annotated[End, SpringEnd()] | None = None
    about: Name | None = None
    c: Annotated[Given, Either(STIFFNESS, TORSION)]
    free: Annotated[Given, Either(LENGTH, ANGLE)] = Given(0.0, 0.0, "mm", "0 mm")

    @property
    def twists(self) -> bool:
        """True if it is a torsion spring."""
        return self.about is not None


@view("phrase")
class SpringRow(Record):
    """A spring for templates: its number, its ends, its stiffness and free size, the ids of its loads."""

    number: int
    link: int
    point: str
    other: int
    to: str
    x: Number | None
    y: Number | None
    rate: Number
    slack: Number
    loads: tuple[str, ...]
    lines: tuple[str, ...]

    @property
    def twists(self) -> bool:
        """True if it is a torsion spring, which has an angle in place of a length."""
        return len(self.lines) == 1

    @property
    def phrase(self) -> str:
        """Key of the phrase for this spring."""
        return "torsion" if self.twists else "links" if self.other else "point" if self.to else "place"


# --- checks ---------------------------------------------------------------------------------------


LOOKED_AT = 720
"""Number of angles of a turn at which the length of a spring is computed first."""
CLOSER = 12
"""Number of refinements in the search for its least length, each by a factor of eight."""
MEET = 1e-3
"""Ends closer than this share of a spring's greatest length meet: no coil is that short."""


def faults(parameters: TopicParameters, machine: Machine) -> Iterator[Finding]:
    """Yield faults unless the ends of each spring are on existing links and points, and no torsion spring winds up."""
    springs: tuple[Spring, ...] = parameters.section("springs", tuple) or ()
    misplaced = list(misplaced_ends(springs, machine.linkage))
    yield from misplaced or wound_up(springs, machine)


def misplaced_ends(springs: Sequence[Spring], linkage: Linkage) -> Iterator[Finding]:
    """Yield faults for springs whose ends are not on existing links and points, or whose sizes have the wrong type."""
    points = pins(linkage)
    for index, spring in enumerate(springs):
        yield from _faults(spring, linkage, points, ("parameters", "springs", index))


def failures(machine: Machine, worked: Sequence[int]) -> Iterator[Finding]:
    """Report a spring whose ends meet on the way: its force would have no direction there, and would jump to the other
    side.

    A spring without a free length is allowed: it pulls with c times the vector between its ends, which is zero there.
    """
    laws = {load.law.number: load.law for load in machine.loads if isinstance(load.law, SpringLaw)}
    if not laws:
        return
    grid = np.linspace(0.0, machine.turns * FULL_TURN, machine.turns * LOOKED_AT, endpoint=bool(machine.span))
    motion = motion_of(machine, grid)
    for law in laws.values():
        along = law.along(motion)
        length = np.abs(along)
        # Between two places of the grid the ends approach by no more than they move there.
        if law.free > 0 and length.min() <= np.abs(np.diff(along)).max():
            angle, least = _nearest(machine, law, float(grid[int(length.argmin())]), float(grid[1] - grid[0]))
            if least < MEET * float(length.max()):
                words = {"angle": f"{math.degrees(angle) % (360 * machine.turns):.1f}"}
                yield Finding("spring-ends-meet", ("parameters", "springs", law.number - 1), words)


def _nearest(machine: Machine, law: SpringLaw, angle: float, step: float) -> tuple[float, float]:
    """Return the cycle angle (rad), within a step of the given one, at which the ends of a spring are closest, and
    their distance (m).
    """
    for _ in range(CLOSER):
        places = np.linspace(angle - step, angle + step, 21)
        if machine.span:
            places = np.clip(places, 0.0, FULL_TURN)
        length = np.abs(law.along(motion_of(machine, places)))
        angle, step = float(places[int(length.argmin())]), step / 8
    return angle, float(length.min())


def _faults(spring: Spring, linkage: Linkage, points: Mapping[int, set[str]], at: Where) -> Iterator[Finding]:
    yield from on_link(dict(points), spring.link, spring.at, at)
    rate, slack = ("N m/rad", "deg") if spring.twists else ("N/mm", "mm")
    for key, given, unit in (("c", spring.c, rate), ("free", spring.free, slack)):
        # The default angle of a torsion spring is 0°.
        if not measures(given.unit, unit) and key in spring.model_fields_set:
            yield Finding("wrong-unit", (*at, key), {"given": given.unit, "unit": unit})
    if spring.twists:
        for key in ("at", "to"):
            if getattr(spring, key) is not None:
                yield Finding("both-given", (*at, key), {"first": "about", "second": key}, at="key")
        if _other_point(linkage, spring) is None:
            known = sorted(end for end in _swinging(linkage) if _swinging(linkage)[end][0] == spring.link)
            words = {"text": str(spring.about), "link": str(spring.link), "known": ", ".join(known) or "–"}
            yield Finding("no-such-pin", (*at, "about"), words)
        return
    for key in ("at", "to"):
        if getattr(spring, key) is None:
            yield Finding("missing-key", at, {"key": key})
    end = spring.to
    if end is None or end.place is not None:
        return
    if end.link == spring.link:
        yield Finding("spring-on-one-link", (*at, "to"), {"link": str(spring.link)})
    elif end.link:
        yield from on_link(dict(points), end.link, end.name, (*at, "to"))
    elif end.name not in linkage.ground:
        fixed = ", ".join(sorted(linkage.ground)) or "–"
        yield Finding("no-such-point", (*at, "to"), {"text": end.name, "known": fixed})


def _swinging(linkage: Linkage) -> dict[str, tuple[int, str]]:
    """Return the fixed pins about which links of groups turn, with the link and the point that gives its angle."""
    legs = (leg for triad in linkage.triads for leg in triad.legs)
    return {leg.outer: (leg.link, leg.inner) for leg in legs if leg.outer in linkage.ground} | {
        end: (link, str(dyad.start) if dyad.kind == "RPR" and end == dyad.end else dyad.middle)
        for dyad in linkage.dyads
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
        if isinstance(end, str) and end in linkage.ground
    }


def _other_point(linkage: Linkage, spring: Spring) -> str | None:
    """Return the point that gives the angle of the link about the spring's pin; None if the link does not turn
    there.
    """
    link, point = _swinging(linkage).get(spring.about or "", (0, ""))
    return point if link == spring.link else None


# --- loads ----------------------------------------------------------------------------------------


def swing(link: int, motion_at: MotionAt) -> tuple[float, float]:
    """Return the middle and the range (rad) of a link's angles over the whole travel of the driver."""
    angle = motion_at(np.linspace(0.0, FULL_TURN, STEPS + 1)).links[link].angle
    low, high = (float(extreme(angle)) for extreme in (np.nanmin, np.nanmax))
    return (low + high) / 2, high - low


def wound_up(springs: Sequence[Spring], machine: Machine) -> Iterator[Finding]:
    """Yield faults for torsion springs on links that make whole turns, and so wind the spring up; not at instants."""
    for index, spring in enumerate(() if machine.instants else springs):
        if spring.twists and spring.link in machine.linkage.links:
            _, range_ = swing(spring.link, partial(motion_of, machine))
            if not range_ < FULL_TURN * (1 - ROUNDING):
                yield Finding("spring-winds-up", ("parameters", "springs", index), {"link": str(spring.link)})


def enter(opening: Opening) -> TopicData:
    """Enter the data of the springs; faulty ones, which the file's checks report, are left out.

    The subject of the topic are their rows for templates; their loads are added to those of the kind.
    """
    springs: tuple[Spring, ...] = opening.given.section("springs", tuple) or ()
    linkage, datum = opening.linkage, opening.datum
    made: list[Applied | Torque] = []
    rows: list[SpringRow] = []
    for number, spring in enumerate(springs, 1):
        if list(misplaced_ends([spring], linkage)) or not spring.c.si:
            continue
        kinds = ("torsional stiffness", "angle") if spring.twists else ("stiffness", "length")
        datum(ids.spring_rate(number), spring.c, Symbol("c", str(number)), kinds[0])
        slack = Symbol("φ" if spring.twists else "l", f"0{number}")
        datum(ids.spring_free(number), spring.free, slack, kinds[1])
        own = _loads(number, spring, linkage, (*opening.loads, *made), opening.motion_at)
        made += own
        rows.append(_row(number, spring, tuple(load.name for load in own)))
    return TopicData(tuple(rows), tuple(made))


def _loads(
    number: int, spring: Spring, linkage: Linkage, others: Sequence[Applied | Torque], motion_at: MotionAt
) -> list[Applied | Torque]:
    if spring.about is not None:
        point = _other_point(linkage, spring)
        assert point is not None, "a spring without its pin is refused by the file's checks"
        middle, range_ = swing(spring.link, motion_at)
        deflected = float(within_half_a_turn(middle - spring.free.si))
        beyond = np.pi <= abs(deflected) + range_ / 2 < 2 * np.pi
        wound = deflected if beyond else 0.0
        law = TorsionLaw(number, spring.link, spring.about, point, spring.c.si, spring.free.si, wound=wound)
        return [Torque(named(ids.applied_torque, spring.link, others), spring.link, law)]
    at, to = spring.at, spring.to
    assert at is not None
    assert to is not None, "a spring without its ends is refused by the file's checks"
    far = Anchor(to.name) if to.place is None else Anchor(place=complex(to.place[0].si, to.place[1].si))
    pulling = SpringLaw(number, (Anchor(at), far), spring.c.si, spring.free.si)
    made: list[Applied | Torque] = [
        Applied(named(ids.applied_force, spring.link, others), spring.link, at, pulling.towards(0), pulling)
    ]
    if to.link:
        name = named(ids.applied_force, to.link, (*others, *made))
        made.append(Applied(name, to.link, to.name, pulling.towards(1), pulling))
    return made


def _row(number: int, spring: Spring, made: tuple[str, ...]) -> SpringRow:
    to = spring.to or End()
    x, y = (None, None) if to.place is None else map(as_typed, to.place)
    lengths = ids.spring_on_paper(number), ids.spring_length(number)
    lines = (ids.spring_turn(number),) if spring.twists else lengths
    point = spring.about or spring.at or ""
    return SpringRow(
        number,
        link=spring.link,
        point=point,
        other=to.link,
        to=to.name,
        x=x,
        y=y,
        rate=as_typed(spring.c),
        slack=as_typed(spring.free),
        loads=made,
        lines=lines,
    )


HOOKS = TopicSection(
    annotation=Annotated[tuple[Spring, ...], Field(max_length=MOST_LOADS)],
    default=(),
    order=10,
    chapter="springs",
    place="loads",
    acts=True,
    enter=enter,
    faults=faults,
    failures=failures,
    of_a_turn=frozenset(("spring-curves",)),
)
