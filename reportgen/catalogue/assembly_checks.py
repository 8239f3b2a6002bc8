"""Check that a linkage can move through its whole travel: groups that do not assemble, dead points, rockers that turn
fully.

A group's clearance is sin² of its transmission angle, as a function of its ends alone.  It becomes negative where the
group does not reach, so that minima between the samples are found, too.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record, replace
from reportgen.base.units import MM, nice_down
from reportgen.machine import GROUND, Crank, Dyad, Group, Guide, Linkage, Triad
from reportgen.machine.kinematics import Motion, course_of, solve_motion
from reportgen.machine.load_laws import FULL_TURN, STEPS, MotionAt, halved
from reportgen.machine.loads import turning_count
from reportgen.machine.rigid_motion import SINGULAR, cross, unit
from reportgen.machine.triads import assemblies, misfit, plate_size, reach, rows_of

HALVINGS = 40
SMALL_TRANSMISSION = 0.3
"""Sine of a transmission angle below which the least clearance is refined."""
ROUND_OF_CLEARANCE = 1e-12
"""A clearance between this value below 0 and 0 is a rounding error."""
ZOOMS, NODES = 4, 41
"""Number of refinements of a neighbourhood, and of places in each: 20⁴ times finer than the samples."""

QUICK = 8
"""Factor by which a first look at a linkage has fewer places."""

SHEET = (1.08, 0.70)
"""Largest extent (m on paper) of a mechanism over all positions on paper A0, landscape or portrait; labels take the
rest.
"""
CLEARLY, FAR = 2.0, 0.5
"""An assembly mode is selected if the next one is this many times as far from the points given, and if it is nearer
than this share of the longest leg.
"""
LEAST_ANGLE = 0.1
"""Transmission angle (degrees) of a group above which its forces are accurate to nine figures or more."""


Clear = Callable[[Floats], Floats]
"""Function that returns a group's clearance [N] at driver coordinates [N]."""


class Member(Record):
    """A group in messages: its links by their letters ("BC, CD"), and the key of the file that is at fault."""

    rods: str
    where: Where


Members = Mapping[Any, Member]
"""The groups in messages, by the tuples of their links."""


class DriverTravel(Record):
    """The driver's coordinates to examine: a whole turn of a crank (rad), or the travel of a slider (m)."""

    start: float = 0.0
    end: float = FULL_TURN
    turning: bool = True

    def printed(self, place: float) -> str:
        """Return a coordinate in degrees, 0…360, or in millimetres, with four figures and two decimals at most."""
        rounded = round(float(np.degrees(place)) % 360 if self.turning else place * 1e3, 2)
        return f"{0.0 if self.turning and rounded == 360 else rounded + 0.0:.4g}"


WHOLE_TURN = DriverTravel()


def findings(linkage: Linkage, members: Members, driven: DriverTravel = WHOLE_TURN) -> Iterator[Finding]:
    """Report the first group that the driver cannot carry through its whole travel, with its links and the driver's
    coordinates.
    """
    places = np.linspace(driven.start, driven.end, STEPS + 1)
    motion = solve_motion(linkage, places, 1.0)
    size = _size(motion)
    of_slide = "" if driven.turning else "-slide"
    for dyad in linkage.groups:
        member = members[dyad.links]
        about = {"group": listed(dyad), "rods": member.rods}
        if isinstance(dyad, Triad):
            finding = _of_triad(linkage, dyad, member, driven)
            if finding is not None:
                yield finding
                return
            continue
        clearances = clearance(dyad, motion, size)
        inside = clearances >= -ROUND_OF_CLEARANCE

        def clear(at: Floats, dyad: Dyad = dyad) -> Floats:
            return clearance(dyad, solve_motion(linkage, at, 1.0), size)

        if driven.turning and not inside.any():
            yield Finding("never-assembled", member.where, about)
            return
        gap = None if inside.all() else _first_gap(clear, driven, places, inside)
        place, least = _least(clear, driven, places, clearances) if gap is None else (0.0, 0.0)
        if least < -ROUND_OF_CLEARANCE:
            step = (driven.end - driven.start) / STEPS
            around = np.array([place - step, place, place + step])
            gap = _gap(clear, around, np.array([True, False, True]))
        if gap is not None:
            ends = dict(zip(("first", "last"), map(driven.printed, gap), strict=True))
            yield Finding(f"no-assembly{of_slide}", member.where, {**about, **ends})
            return
        if least < SINGULAR**2:
            at = {"angle" if driven.turning else "first": driven.printed(place)}
            yield Finding(f"dead-point{of_slide}", member.where, {**about, **at})
            return


def listed(group: Group) -> str:
    """Return the numbers of a group's links as text for a message."""
    return ", ".join(map(str, group.links))


def _of_triad(linkage: Linkage, triad: Triad, member: Member, driven: DriverTravel) -> Finding | None:
    """Return the fault of a triad that the driver cannot carry through its travel; None if it can.

    The mode is followed from the place where it is selected; it ends at a dead point, where the lines of the three legs
    meet in one point or are parallel.
    """
    about = {"group": listed(triad), "rods": member.rods}
    course = course_of(linkage, triad, None if driven.turning else _span(linkage, driven))
    if not course.driver.size:
        return Finding("never-assembled", member.where, about)
    if course.closes:
        return None
    if course.whole:
        return Finding("mode-changes", member.where, about)
    dead = course.driver[-1] if course.driver[-1] < course.high else course.driver[0]
    key, code = ("angle", "dead-point") if driven.turning else ("first", "dead-point-slide")
    return Finding(code, member.where, {**about, key: driven.printed(float(dead))})


def _span(linkage: Linkage, driven: DriverTravel) -> tuple[float, float]:
    """Return the least and greatest coordinate (m) of a sliding driver, with the places where modes are selected."""
    ends = (driven.start, driven.end, *(triad.near_at for triad in linkage.triads))
    return min(ends), max(ends)


def unclear_modes(linkage: Linkage, members: Members) -> Iterator[Finding]:
    """Report the first triad whose points `near` do not select exactly one of its assembly modes; list all modes."""
    turning = isinstance(linkage.driver, Crank)
    for index, triad in enumerate(linkage.groups):
        if not isinstance(triad, Triad):
            continue
        before = solve_motion(replace(linkage, groups=linkage.groups[:index]), [triad.near_at], 1.0)
        outer = [complex(before.points[leg.outer].p[0]) for leg in triad.legs]
        if not np.isfinite(outer).all():
            return  # An earlier group does not assemble there.
        modes = sorted(assemblies(triad, outer), key=lambda mode: misfit(triad, mode))
        misfits = [misfit(triad, mode) for mode in modes]
        selected = len(modes) == 1 or (len(modes) > 1 and misfits[1] > CLEARLY * misfits[0])
        if selected and misfits[0] < FAR * reach(triad):
            continue
        at = f"{DriverTravel(turning=turning).printed(triad.near_at)}{'°' if turning else ' mm'}"
        about = {"group": listed(triad), "at": at}
        where = members[triad.links].where
        if not modes:
            yield Finding("no-assembly-at", where, about)
            return
        joints = [leg.inner for leg in triad.legs]
        modes.sort(key=lambda mode: cmath.phase(mode.turn))
        about["known"] = "; ".join(_placed(joints, mode.joints(triad)) for mode in modes)
        yield Finding("no-single-mode", (*where, "near"), about)
        return


def _placed(names: Sequence[str], places: Sequence[complex]) -> str:
    """Return points with their coordinates (mm) as text for a message."""
    return ", ".join(f"{name} ({at.real * MM:.4g}, {at.imag * MM:.4g})" for name, at in zip(names, places, strict=True))


def near_dead_point(linkage: Linkage, driven: DriverTravel, where: Where) -> Iterator[Finding]:
    """Report the first group that comes so close to a dead point that its accelerations and forces are rounding
    errors.
    """
    places = np.linspace(driven.start, driven.end, STEPS + 1)
    motion = solve_motion(linkage, places, 1.0)
    size, of_slide = _size(motion), "" if driven.turning else "-slide"
    limit = np.sin(np.radians(LEAST_ANGLE))
    for dyad in linkage.groups:

        def clear(at: Floats, dyad: Group = dyad) -> Floats:
            return clearance(dyad, solve_motion(linkage, at, 1.0), size)

        place, least = _least(clear, driven, places, clearance(dyad, motion, size))
        if not least < limit**2:
            continue
        sine = float(np.sqrt(max(least, 0.0)))
        about = {"group": listed(dyad), "at": driven.printed(place)}
        if isinstance(dyad, Dyad) and dyad.kind == "RPR" and not dyad.lengths[1]:
            about |= {"near": f"{sine * size * 1e3:.3g}", "least": f"{limit * size * 1e3:.3g}"}
            yield Finding(f"near-pivot{of_slide}", where, about, at="key")
        else:
            about |= {"near": f"{np.degrees(sine):.2g}", "least": f"{LEAST_ANGLE:g}"}
            yield Finding(f"near-dead-point{of_slide}", where, about, at="key")
        return


def at_instants(linkage: Linkage, places: Floats, turning: bool) -> Iterator[Finding]:
    """Report the instants at which a group does not assemble, or is too close to a dead point for accurate forces.

    `places` [N] are crank angles (rad), or displacements of a slider (m) unless `turning`.
    """
    motion, printed = solve_motion(linkage, places, 1.0), DriverTravel(turning=turning).printed
    size, limit = _size(motion), np.sin(np.radians(LEAST_ANGLE))
    for index, place in enumerate(map(float, places)):
        where = ("positions", "at", index)
        for dyad in linkage.groups:
            least = float(clearance(dyad, motion, size)[index])
            if not least >= limit**2:
                at = f"{printed(place)}{'°' if turning else ' mm'}"
                about = {"group": listed(dyad), "at": at}
                yield Finding("no-assembly-at" if least < 0 else "dead-point-at", where, about)
                break


def goes_through(linkage: Linkage, driven: DriverTravel = WHOLE_TURN) -> bool:
    """Return True if the driver carries all groups through its whole travel, without dead points."""
    for steps in (STEPS // QUICK, STEPS):
        # Most linkages that do not go through are told from few places.
        if not solve_motion(linkage, np.linspace(driven.start, driven.end, steps + 1), 1.0).reachable.all():
            return False
    nowhere = {group.links: Member("", ()) for group in linkage.groups}
    return next(findings(linkage, nowhere, driven), None) is None


def turns(linkage: Linkage) -> bool:
    """Return True if the crank carries all groups through a whole turn."""
    return bool(solve_motion(linkage, np.linspace(0.0, FULL_TURN, STEPS + 1), 1.0).reachable.all())


def room(linkage: Linkage, angles: Floats) -> tuple[float, float]:
    """Return width and height (m) of the area that the points of a linkage reach at angles [N] of its driver; 0 if
    none.

    Only positions at which all groups assemble count.
    """
    motion = solve_motion(linkage, angles, 1.0)
    places = np.array([point.p for point in motion.points.values()])[:, motion.reachable]
    return (float(np.ptp(places.real)), float(np.ptp(places.imag))) if places.size else (0.0, 0.0)


def too_large(linkage: Linkage, angles: Floats, drawn: float, where: Where) -> Iterator[Finding]:
    """Report a mechanism too large for a sheet A0 at angles [N] of its crank, drawn with the length `drawn` (m on
    paper).
    """
    assert isinstance(linkage.driver, Crank)
    scale = drawn / linkage.driver.length
    width, height = (size * scale for size in room(linkage, angles))
    excess = min(max(width / across, height / up) for across, up in (SHEET, SHEET[::-1]))
    if excess > 1:
        sizes = {
            "width": f"{width * MM:.0f}",
            "height": f"{height * MM:.0f}",
            "most": f"{nice_down(drawn * MM / excess):g}",
        }
        yield Finding("too-large-to-draw", where, {"text": f"{drawn * MM:g} mm", **sizes})


def to_and_fro(linkage: Linkage, slider: int, motion_at: MotionAt, where: Where) -> Iterator[Finding]:
    """Yield faults unless a slider with dead centres moves to and fro once in a turn, so that it reverses twice."""
    count = turning_count(linkage, slider, motion_at)
    if count != 2:
        yield Finding("not-to-and-fro", where, {"text": str(slider), "count": str(count)})


def turns_fully(linkage: Linkage, link: int) -> bool:
    """Return True if a link makes whole turns with the crank, rather than swinging."""
    angle = solve_motion(linkage, np.linspace(0.0, FULL_TURN, STEPS + 1), 1.0).links[link].angle
    return bool(abs(angle[-1] - angle[0]) > np.pi)


def clearance(dyad: Group, motion: Motion, size: float) -> Floats:
    """Return the clearance of a group from a dead point [N], from its ends: negative where it does not assemble.

    It is sin² of the angle between the rods (RRR), between a rod and the guide's normal (RRP), between the pin's path
    and the slot (RPR with an offset; without one the square of the pin's distance from the pivot over the linkage's
    `size` in m), or between the two slides (PRP, RPP). For a triad it is the square of the determinant of its legs over
    the size of the plate, −1 where it does not assemble.
    """
    if isinstance(dyad, Triad):
        outer, inner = ([motion.points[name].p for name in names] for names in zip(*_ends(dyad), strict=True))
        turn = unit(motion.links[dyad.plate].angle)
        determinant = rows_of(dyad, outer, inner[0], turn).determinant / plate_size(dyad)
        return np.asarray(np.where(motion.reachable, determinant**2, -1.0))
    l1, two = dyad.lengths
    match dyad.kind, dyad.start, dyad.end:
        case "RRR", str(p), str(t):
            span = np.abs(motion.points[p].p - motion.points[t].p)
            return np.asarray(1 - ((l1**2 + two**2 - span**2) / (2 * l1 * two)) ** 2)
        case "RRP", str(p), Guide() as guide:
            at, along = _rail(guide, motion)
            return np.asarray(1 - (cross(motion.points[p].p - at, along) / l1) ** 2)
        case "RPR", str(p), str(t):
            reach = np.abs(motion.points[p].p - motion.points[t].p)
            if two:
                return np.asarray(1 - (two / np.maximum(reach, ROUND_OF_CLEARANCE * size)) ** 2)
            return np.asarray((reach / size) ** 2)
        case "PRP", Guide() as first, Guide() as second:
            return np.asarray(cross(_rail(first, motion)[1], _rail(second, motion)[1]) ** 2)
        case _:
            return np.full(motion.driver.shape, np.sin(dyad.slide_angle) ** 2)


def _ends(triad: Triad) -> Iterator[tuple[str, str]]:
    yield from ((leg.outer, leg.inner) for leg in triad.legs)


def _rail(guide: Guide, motion: Motion) -> tuple[Complexes | complex, Complexes]:
    """Return a point of a guide and its direction."""
    if guide.link == GROUND:
        return guide.at, unit(guide.angle)
    turned = unit(motion.links[guide.link].angle)
    return motion.origins[guide.link].p + guide.at * turned, turned * unit(guide.angle)


def _size(motion: Motion) -> float:
    """Return the greatest extent of the paths of the linkage's points (m)."""
    places = np.concatenate([point.p for point in motion.points.values()])
    places = places[np.isfinite(places)]
    return max(float(np.ptp(places.real)), float(np.ptp(places.imag)))


def _first_gap(clear: Clear, driven: DriverTravel, places: Floats, inside: np.ndarray) -> tuple[float, float]:
    """Return the ends of the first range in which the group does not assemble; in a turn, the first after it
    assembles.
    """
    if driven.turning:
        places = places + places[int(np.flatnonzero(inside)[0])] - driven.start
        inside = clear(places) >= -ROUND_OF_CLEARANCE
    return _gap(clear, places, inside)


def _gap(clear: Clear, places: Floats, inside: np.ndarray) -> tuple[float, float]:
    """Return the ends of the first run of places that are not `inside`."""
    first = int(np.flatnonzero(~inside)[0])
    later = np.flatnonzero(inside[first:])
    last = first + int(later[0]) - 1 if later.size else places.size - 1
    start, end = float(places[first]), float(places[last])
    if first > 0:
        start = _edge(clear, float(places[first - 1]), start)
    if last < places.size - 1:
        end = _edge(clear, float(places[last + 1]), end)
    return start, end


def _edge(clear: Clear, inside: float, outside: float) -> float:
    """Return the place between a reachable and an unreachable one at which the links just reach."""

    def assembles(places: Floats) -> Flags:
        return np.asarray(clear(places.ravel()).reshape(places.shape) >= 0)

    reached, _ = halved(np.array([inside]), np.array([outside]), assembles, HALVINGS)
    return float(reached[0])


def _least(clear: Clear, driven: DriverTravel, places: Floats, clearances: Floats) -> tuple[float, float]:
    """Return the place and the value of the group's least clearance; small clearances are refined."""
    best = float(places[np.argmin(clearances)]), float(clearances.min())
    before, after = np.roll(clearances[:-1], 1), np.roll(clearances[:-1], -1)
    if not driven.turning:
        before[0], after[-1] = np.inf, clearances[-1]
    low = (clearances[:-1] < before) & (clearances[:-1] <= after) & (clearances[:-1] < SMALL_TRANSMISSION**2)
    for k in np.flatnonzero(low):
        place, half = float(places[k]), abs(driven.end - driven.start) / STEPS
        for _ in range(ZOOMS):
            near = np.linspace(place - half, place + half, NODES)
            if not driven.turning:
                near = np.clip(near, min(driven.start, driven.end), max(driven.start, driven.end))
            there = clear(near)
            place, half = float(near[np.argmin(there)]), 2 * half / (NODES - 1)
            best = min(best, (place, float(there.min())), key=lambda pair: pair[1])
    return best
