"""Whether a declared linkage assembles over its driver's turn or way, and its blocks stay in their slots."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

import numpy as np

from reportgen.assignment.common import Positions
from reportgen.assignment.faults import Finding, Where
from reportgen.catalogue import linkage_file as file
from reportgen.catalogue import linkage_loads, reach
from reportgen.catalogue.linkage_build import linkage
from reportgen.catalogue.reach import Member
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.structure import Crank, Linkage
from reportgen.units import Given

TOP: Where = ("parameters",)
STEPS = 720
SAME = 1e-9
"""A way (m) beyond a slot by less than this is at its end."""


def guides(group: file.Group, at: Where) -> list[tuple[file.Guide, Where]]:
    """The guides of a group, each with its place in the file."""
    if isinstance(group, file.PRP):
        return [(guide, (*at, "guides", index)) for index, guide in enumerate(group.guides)]
    return [(group.guide, (*at, "guide"))] if isinstance(group, file.RRP | file.RPP) else []


def assembly(given: file.Parameters, positions: Positions) -> Iterator[Finding]:
    """The first group that does not follow the driver; else blocks that leave their slots, sliders of tables."""
    made = linkage(given)
    members = {
        (group.links[0], group.links[1]): Member(_rods(group), (*TOP, "groups", index))
        for index, group in enumerate(given.groups)
    }
    if isinstance(given.driver, file.SlideDriver):
        yield from _along_the_way(given, given.driver, made, members)
        return
    found = list(reach.findings(made, members))
    yield from found
    if found:
        return
    start = 0.0 if positions.start is None else positions.start.si

    def motion_at(angle: np.ndarray) -> Motion:
        return solve_motion(made, start + positions.sign * angle, positions.sign * 1.0)

    yield from _slots(given, made, motion_at(np.linspace(0.0, 2 * np.pi, STEPS + 1)))
    for index, load in enumerate(given.loads):
        if isinstance(load, file.OverStroke | file.Gas):
            try:
                linkage_loads.course(made, load.link, motion_at)
            except linkage_loads.NotToAndFro as fault:
                words = {"text": str(load.link), "count": str(fault.reversals)}
                yield Finding("not-to-and-fro", (*TOP, "loads", index, "link"), words)


def _along_the_way(
    given: file.Parameters, driver: file.SlideDriver, made: Linkage, members: dict[tuple[int, int], Member]
) -> Iterator[Finding]:
    start, end = driver.start, driver.end
    slot = driver.guide.slot
    for key, at in (("start", start), ("end", end)):
        if slot is not None and not slot[0].si - SAME <= at.si <= slot[1].si + SAME:
            words = {"text": at.text, "slot": f"{slot[0].text} … {slot[1].text}"}
            yield Finding("driver-out-of-slot", (*TOP, "driver", key), words)
    found = list(reach.findings(made, members, reach.Way(start.si, end.si, turning=False)))
    yield from found
    if not found:
        yield from _slots(given, made, solve_motion(made, np.linspace(start.si, end.si, STEPS + 1), driver.rate))


def _rods(group: file.Group) -> str:
    """A group's links by the letters of their joints."""
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
    """Every block stays in its slot, where a slot's ends are given."""
    for index, group in enumerate(given.groups):
        at = (*TOP, "groups", index)
        i, j = group.links
        watched = [
            (guide, where, (guide.on, link))
            for (guide, where), link in zip(
                guides(group, at), group.links if group.type == "PRP" else (j,), strict=False
            )
        ]
        ways = [(guide.slot, (*where, "slot"), key) for guide, where, key in watched]
        if isinstance(group, file.RPR):
            ways.append((group.slot, (*at, "slot"), (j, i)))
        for slot, where, key in ways:
            if slot is not None:
                yield from _stays(slot, where, key, motion, f"({i}, {j})", isinstance(made.driver, Crank))


def _stays(
    slot: tuple[Given, ...], where: Where, key: tuple[int, int], motion: Motion, group: str, turns: bool
) -> Iterator[Finding]:
    way = motion.slides[key].s
    beyond = np.maximum(slot[0].si - way, way - slot[1].si)
    worst = int(np.argmax(beyond))
    if beyond[worst] > SAME:
        driver = float(motion.driver[worst])
        words = {
            "block": str(key[1]),
            "link": str(key[0]),
            "group": group,
            "at": f"{math.degrees(cmath.phase(cmath.exp(1j * driver))) if turns else driver * 1e3:.4g}",
            "way": f"{way[worst] * 1e3:.4g}",
        }
        yield Finding("out-of-slot" if turns else "out-of-slot-slide", where, words)
