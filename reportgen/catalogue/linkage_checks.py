"""Checks of a `linkage` file that need several values: names, numbers, order of placing, and assembly."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from reportgen.assignment.common import Draft, Positions
from reportgen.base.errors import Finding, Where
from reportgen.base.units import Given
from reportgen.catalogue import assembly_checks, declared_loads
from reportgen.catalogue import linkage_file as file
from reportgen.catalogue.assembly_checks import Member, Members
from reportgen.catalogue.declared_loads import Constant, OverWay, listed, on_link, pins, table
from reportgen.machine import DRIVER, GROUND, Crank, Linkage, mobility
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.load_laws import FULL_TURN, STEPS
from reportgen.machine.loads import crank_motion

TOP: Where = ("parameters",)
AT_SLOT_END = 1e-9
"""A way (m) beyond a slot by less than this is at its end."""


TURNING = ("parameters", ("turns", "also_at"))
"""Parameters that count or place turns of a crank."""


def check(draft: Draft) -> Iterator[Finding]:
    """Yield faults of names and numbers; a linkage without such faults is also assembled."""
    given: file.Parameters | None = draft.sections.get("parameters")
    if given is None:
        return
    faults = [*_structure(given), *_bodies(given), *_loads(given), *_of_a_crank(draft, given)]
    faults += [] if faults else _declared(given)
    yield from faults
    if faults:
        return
    positions = draft.sections.get("positions") or Positions()
    yield from _assembly(given, positions)


def _of_a_crank(draft: Draft, given: file.Parameters) -> Iterator[Finding]:
    """Yield faults for keys that only a crank has: a sliding driver passes its travel once, from its start.

    Single instants allow no further positions between them.
    """
    if draft.at("positions", "at") is not None and given.also_at:
        yield Finding("both-given", ("parameters", "also_at"), {"first": "at", "second": "also_at"}, at="key")
    if not isinstance(given.driver, file.SlideDriver):
        return
    for section, keys in (("positions", ("start", "direction")), ("drawing", ("crank",)), TURNING):
        for key in keys:
            if draft.at(section, key) is not None:
                yield Finding("no-crank", (section, key), {"key": key}, at="key")


# --- names and numbers ----------------------------------------------------------------------------


@dataclass
class _Placed:
    """The points and links placed so far while the groups are read in their order.

    `passing` are points of a slotted link under a pin, on which nothing may be placed. `coming` are all points that the
    file declares, to tell a point that is used too early from one that does not exist.
    """

    points: set[str] = field(default_factory=set)
    links: set[int] = field(default_factory=lambda: {GROUND, DRIVER})
    passing: set[str] = field(default_factory=set)
    coming: frozenset[str] = frozenset()

    def enter(self, name: str, where: Where) -> Iterator[Finding]:
        """Place a point; yield a fault if its name is taken."""
        if name in self.points:
            yield Finding("point-taken", where, {"text": name})
        self.points.add(name)

    def need(self, name: str, where: Where) -> Iterator[Finding]:
        """Yield a fault unless a point is placed and something may be placed on it."""
        if name in self.passing:
            yield Finding("hangs-on-slide", where, {"text": name})
        elif name not in self.points:
            code = "not-placed" if name in self.coming else "no-such-point"
            yield Finding(code, where, {"text": name, "known": ", ".join(sorted(self.points)) or "–"})

    def carrier(self, link: int, where: Where) -> Iterator[Finding]:
        """Yield a fault unless the link that carries a guide is placed."""
        if link not in self.links:
            yield Finding("link-not-placed", where, {"text": str(link), "known": listed(self.links)})


def _structure(given: file.Parameters) -> Iterator[Finding]:
    """Yield faults unless every point and link is new where it is declared and placed where it is used."""
    later = [name for group in given.groups for name in _placed_by(group)]
    placed = _Placed(coming=frozenset((*later, *given.points)))
    placed.points |= set(given.frame)
    at: Where = (*TOP, "driver")
    driver = given.driver
    if isinstance(driver, file.SlideDriver) and driver.start.si == driver.end.si:
        yield Finding("no-way", (*at, "end"), {"text": driver.end.text})
    if isinstance(driver, file.CrankDriver):
        if driver.centre not in given.frame:
            known = ", ".join(given.frame) or "–"
            yield Finding("no-such-point", (*at, "centre"), {"text": driver.centre, "known": known})
    elif driver.guide.on != GROUND:
        yield Finding("link-not-placed", (*at, "guide", "on"), {"text": str(driver.guide.on), "known": "0"})
    yield from placed.enter(driver.pin, (*at, "pin"))
    yield from _fixed_points(given, DRIVER, placed)
    for index, group in enumerate(given.groups):
        yield from _group(given, group, (*TOP, "groups", index), placed)
    for name, point in given.points.items():
        if point.link not in placed.links:
            where = (*TOP, "points", name, "link")
            yield Finding("no-such-link", where, {"text": str(point.link), "known": listed(placed.links - {GROUND})})
    for index, name in enumerate(given.paths):
        if name not in placed.points:
            yield from placed.need(name, (*TOP, "paths", index))


def _fixed_points(given: file.Parameters, link: int, placed: _Placed) -> Iterator[Finding]:
    for name, point in given.points.items():
        if point.link == link:
            yield from placed.enter(name, (*TOP, "points", name))


def _placed_by(group: file.GroupSection) -> tuple[str, ...]:
    """Return the joints that a group places."""
    if isinstance(group, file.TernaryGroup):
        return group.inner
    return (group.joints[0 if group.type == "PRP" else 1],)


def _new_links(links: Iterable[tuple[int, Where]], placed: _Placed) -> Iterator[Finding]:
    """Yield faults unless the links, each with its place in the file, are new."""
    taken = set(placed.links)
    for link, where in links:
        if link in taken:
            yield Finding("link-taken", where, {"text": str(link)})
        taken.add(link)


def _ternary(given: file.Parameters, group: file.TernaryGroup, at: Where, placed: _Placed) -> Iterator[Finding]:
    """Yield the faults of a triad's names and numbers."""
    plate = group.plate, (*at, "plate")
    yield from _new_links([plate, *((leg.link, (*at, "legs", k, "link")) for k, leg in enumerate(group.legs))], placed)
    for index, leg in enumerate(group.legs):
        yield from placed.need(leg.joints[0], (*at, "legs", index, "joints", 0))
    for index, name in enumerate(group.inner):
        yield from placed.enter(name, (*at, "legs", index, "joints", 1))
    _, second, third = group.inner
    for key, names, known in (("at", group.at, (second, third)), ("near", group.near, group.inner)):
        for name in names:
            if name not in known:
                yield Finding("no-such-point", (*at, key, name), {"text": name, "known": ", ".join(known)}, at="key")
    for name in (second, third):
        if name not in group.at:
            yield Finding("missing-key", (*at, "at"), {"key": name})
    if second in group.at and not (group.at[second][0].si > 0 and group.at[second][1].si == 0):
        yield Finding("plate-axis", (*at, "at", second), {"text": second, "first": group.inner[0]})
    for link in dict.fromkeys(group.links):
        if link not in placed.links:
            placed.links.add(link)
            yield from _fixed_points(given, link, placed)


def _group(given: file.Parameters, group: file.GroupSection, at: Where, placed: _Placed) -> Iterator[Finding]:
    if isinstance(group, file.TernaryGroup):
        yield from _ternary(given, group, at, placed)
        return
    yield from _new_links(((link, (*at, "links", index)) for index, link in enumerate(group.links)), placed)
    joints = (*at, "joints")
    middle = 0 if group.type == "PRP" else 1
    for index, name in enumerate(group.joints):
        if index != middle:
            yield from placed.need(name, (*joints, index))
    for _, guide, where in file.rails(group):
        yield from placed.carrier(guide.on, (*at, *where, "on"))
    yield from placed.enter(group.joints[middle], (*joints, middle))
    if group.type == "RPR":
        placed.passing.add(group.joints[middle])
    for link in dict.fromkeys(group.links):
        if link not in placed.links:
            placed.links.add(link)
            yield from _fixed_points(given, link, placed)


def _bodies(given: file.Parameters) -> Iterator[Finding]:
    """Yield faults unless masses belong to links and their own points, one to a link."""
    points, seen = pins(given.linkage), set[int]()
    for index, body in enumerate(given.masses):
        at = (*TOP, "masses", index)
        yield from on_link(points, body.link, body.at, at)
        if body.link in seen:
            yield Finding("mass-twice", (*at, "link"), {"text": str(body.link)})
        seen.add(body.link)
        if body.G is not None and body.m is not None:
            yield Finding("both-given", (*at, "m"), {"first": "G", "second": "m"}, at="key")
        if body.G is None and body.m is None and body.J is None:
            yield Finding("missing-key", at, {"key": "G | m"})


# --- loads ----------------------------------------------------------------------------------------


def _loads(given: file.Parameters) -> Iterator[Finding]:
    points = pins(given.linkage)
    rails = (rail for group in given.groups for rail in file.rails(group))
    sliders = {link for link, guide, _ in rails if guide.on == GROUND}
    slides = isinstance(given.driver, file.SlideDriver)
    end = given.driver.span if isinstance(given.driver, file.SlideDriver) else given.turns * FULL_TURN
    for index, load in enumerate(given.loads):
        at = (*TOP, "loads", index)
        if slides and not isinstance(load, Constant | OverWay):
            yield Finding("needs-a-crank", (*at, "by"))
            continue
        if isinstance(load, OverWay) and not slides:
            yield Finding("needs-a-slide", (*at, "by"))
            continue
        if isinstance(load, file.OverStroke | file.Gas):
            if load.link not in sliders:
                yield Finding("no-slider", (*at, "link"), {"text": str(load.link), "known": listed(sliders) or "–"})
            if isinstance(load, file.OverStroke):
                yield from table(at, "s", load.s, 1.0, inward=load.inward, outward=load.outward)
            elif given.turns != 2:
                yield Finding("gas-needs-two-turns", (*at, "by"))
            continue
        yield from declared_loads.faults(load, points, end, at)


# --- structure as declared ------------------------------------------------------------------------


def _declared(given: file.Parameters) -> Iterator[Finding]:
    """Yield faults unless degree of freedom, class and groups are as the author declares them."""
    declared, at = given.declared, (*TOP, "declared")
    try:
        actual = mobility(given.linkage)
    except (KeyError, ValueError):
        return
    for key, said, is_so in (("W", declared.W, actual.W), ("class", declared.class_, actual.mechanism_class)):
        if said is not None and said != is_so:
            yield Finding("not-as-declared", (*at, key), {"text": str(said), "found": str(is_so)})
    if declared.groups is not None:
        declared_groups = {tuple(sorted(pair)) for pair in declared.groups}
        is_groups = [tuple(sorted(dyad.links)) for dyad in actual.groups]
        if declared_groups != set(is_groups):
            text = ", ".join(map(str, declared.groups))
            yield Finding("not-as-declared", (*at, "groups"), {"text": text, "found": ", ".join(map(str, is_groups))})


# --- assembly -------------------------------------------------------------------------------------


def _assembly(given: file.Parameters, positions: Positions) -> Iterator[Finding]:
    """Report the first group that does not follow the driver; else blocks that leave their slots, sliders of tables.

    At single instants the crank need not make a whole turn, unless a load depends on the stroke of a slider.
    """
    made = given.linkage
    members: Members = {
        tuple(group.links): Member(_rods(group), (*TOP, "groups", index)) for index, group in enumerate(given.groups)
    }
    for index, group in enumerate(given.groups):
        if isinstance(group, file.TernaryGroup) and group.near_at and isinstance(given.driver, file.SlideDriver):
            yield Finding("no-crank", (*TOP, "groups", index, "near_at"), {"key": "near_at"}, at="key")
            return
    unclear = list(assembly_checks.unclear_modes(made, members))
    yield from unclear
    if unclear:
        return
    if isinstance(given.driver, file.SlideDriver):
        if not positions.at:
            yield from _along_travel(given, given.driver, made, members)
        return
    by_stroke = {
        index: load.link for index, load in enumerate(given.loads) if isinstance(load, file.OverStroke | file.Gas)
    }
    if positions.at and not by_stroke:
        return
    obstacles = list(assembly_checks.findings(made, members))
    yield from obstacles
    if obstacles:
        return
    motion_at = crank_motion(made, positions, positions.start_or())
    if not positions.at:
        yield from _slots(given, made, motion_at(np.linspace(0.0, 2 * np.pi, STEPS + 1)))
    for index, slider in by_stroke.items():
        yield from assembly_checks.to_and_fro(made, slider, motion_at, (*TOP, "loads", index, "link"))


def _along_travel(
    given: file.Parameters, driver: file.SlideDriver, made: Linkage, members: Members
) -> Iterator[Finding]:
    start, end = driver.start, driver.end
    slot = driver.guide.slot
    for key, at in (("start", start), ("end", end)):
        if slot is not None and not slot[0].si - AT_SLOT_END <= at.si <= slot[1].si + AT_SLOT_END:
            words = {"text": at.text, "slot": f"{slot[0].text} … {slot[1].text}"}
            yield Finding("driver-out-of-slot", (*TOP, "driver", key), words)
    obstacles = list(
        assembly_checks.findings(made, members, assembly_checks.DriverTravel(start.si, end.si, turning=False))
    )
    yield from obstacles
    if not obstacles:
        yield from _slots(given, made, solve_motion(made, np.linspace(start.si, end.si, STEPS + 1), driver.rate))


def _rods(group: file.GroupSection) -> str:
    """Return a group's links by the letters of their joints."""
    if isinstance(group, file.TernaryGroup):
        return ", ".join("".join(leg.joints) for leg in group.legs)
    names = group.joints
    match group.type:
        case "RRR":
            return f"{names[0]}{names[1]}, {names[1]}{names[2]}"
        case "RRP" | "RPP":
            return f"{names[0]}{names[1]}"
        case "RPR":
            return f"{names[0]}{names[2]}"
        case _:
            return names[0]


def _slots(given: file.Parameters, made: Linkage, motion: Motion) -> Iterator[Finding]:
    """Yield faults unless every block stays in its slot, where a slot's ends are given."""
    for index, group in enumerate(given.groups):
        if isinstance(group, file.TernaryGroup):
            continue
        at = (*TOP, "groups", index)
        i, j = group.links
        slots = [(guide.slot, (*at, *where, "slot"), (guide.on, link)) for link, guide, where in file.rails(group)]
        if isinstance(group, file.RPR):
            slots.append((group.slot, (*at, "slot"), (j, i)))
        for slot, where, key in slots:
            if slot is not None:
                yield from _stays(slot, where, key, motion, f"({i}, {j})", isinstance(made.driver, Crank))


def _stays(
    slot: tuple[Given, ...], where: Where, key: tuple[int, int], motion: Motion, group: str, turns: bool
) -> Iterator[Finding]:
    s = motion.slides[key].s
    beyond = np.maximum(slot[0].si - s, s - slot[1].si)
    worst = int(np.argmax(beyond))
    if beyond[worst] > AT_SLOT_END:
        driver = float(motion.driver[worst])
        words = {
            "block": str(key[1]),
            "link": str(key[0]),
            "group": group,
            "at": f"{math.degrees(cmath.phase(cmath.exp(1j * driver))) if turns else driver * 1e3:.4g}",
            "way": f"{s[worst] * 1e3:.4g}",
        }
        yield Finding("out-of-slot" if turns else "out-of-slot-slide", where, words)
