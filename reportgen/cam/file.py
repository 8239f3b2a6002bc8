"""The `parameters` of a cam, and the cam that they describe, with unknown lengths found and rounded (`designed`)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from reportgen.assignment.common import FEWEST_POSITIONS, MOST_POSITIONS, Part
from reportgen.assignment.fields import (
    Decimal,
    Interval,
    Length,
    Reader,
    RotationalSpeed,
    Sought,
    Whole,
    fault,
    quantity,
)
from reportgen.base.records import Record, replace
from reportgen.base.template_access import view
from reportgen.base.units import MM, Given
from reportgen.cam import inverse_design
from reportgen.cam.inverse_design import CamLimits, Least, NoCamError
from reportgen.cam.motion_laws import (
    PHASES,
    AccelerationGraph,
    FollowerLaw,
    FollowerMotion,
    Segment,
    graph_of_displacements,
    law,
)
from reportgen.cam.profile import Cam

ALLOWED = 1e-9
"""A pressure angle may exceed its limit by this rounding error (rad)."""


class PerPhase(Record):
    """Number of steps of each phase."""

    counts: tuple[tuple[str, int], ...]


class Steps(Reader):
    """Reader of the positions: a number per turn, a step in degrees, or a number for each phase."""

    def read(self, value: object) -> int | Given | PerPhase:
        if isinstance(value, dict):
            for key in value:
                if key not in PHASES:
                    raise fault("unknown-key", key=str(key), known=", ".join(PHASES))
            return PerPhase(tuple((key, Whole(1, 72).read(one)) for key, one in value.items()))
        if isinstance(value, str) and value.strip().isdigit():
            return Whole(FEWEST_POSITIONS, MOST_POSITIONS).read(value)
        return quantity("deg", least=1, most=90).read(value)

    def schema(self) -> dict[str, Any]:
        whole = {"type": "integer", "minimum": FEWEST_POSITIONS, "maximum": MOST_POSITIONS}
        parts = {"type": "object", "properties": {phase: Whole(1, 72).schema() for phase in PHASES}}
        return {"anyOf": [whole, quantity("deg").schema(), {**parts, "additionalProperties": False}]}


Moving = Annotated[Given, quantity("deg", least=1, below=360)]
Resting = Annotated[Given, quantity("deg", least=0, below=360)]
Permissible = Annotated[Given, quantity("deg", least=5, most=85)]
ShareOfPhase = Annotated[float, Decimal(Interval(least=0, most=1))]
Ordinate = Annotated[float, Decimal(Interval(least=-1e6, most=1e6))]
LawNodes = Field(min_length=2, max_length=60)
Roller = quantity("mm", least=0.1, below=1e4)


class Phases(Part):
    """The cam angles of the four phases; the near dwell is the rest of the turn."""

    rise: Moving
    far: Resting = Given(0.0, 0.0, "deg", "0 deg")
    return_: Moving = Field(alias="return")
    near: Resting | None = None


LawName = Literal["uniform", "parabolic", "cosine", "sine", "3-4-5", "4-5-6-7", "trapezoidal"]


class LawSegment(Part):
    """A part of a phase, from the end of the one before to the share `to` of the phase and the share `s` of the stroke.

    Without a law the follower rests, and `s` is that of the segment before.
    """

    to: ShareOfPhase
    s: ShareOfPhase | None = None
    law: Literal["uniform", "parabolic", "cosine", "sine", "3-4-5", "4-5-6-7"] | None = None


class LawTable(Part):
    """An acceleration graph, a table of displacements, or segments.

    A table has ordinates in any unit over `x` from 0 to 1.  In an acceleration graph a repeated x is a jump; in a table
    of displacements equal neighbours are a dwell.
    """

    x: Annotated[tuple[ShareOfPhase, ...], LawNodes] | None = None
    a: Annotated[tuple[Ordinate, ...], LawNodes] | None = None
    s: Annotated[tuple[Ordinate, ...], LawNodes] | None = None
    segments: Annotated[tuple[LawSegment, ...], Field(min_length=1, max_length=12)] | None = None


LawOrTable = Annotated[
    Annotated[LawName, Tag("name")] | Annotated[LawTable, Tag("table")],
    Discriminator(lambda content: "table" if isinstance(content, dict | LawTable) else "name"),
]


class Laws(Part):
    """The laws of motion of rise and return."""

    rise: LawOrTable
    return_: LawOrTable = Field(alias="return")


class PermissibleAngles(Part):
    """The permissible pressure angles of rise and return."""

    rise: Permissible
    return_: Permissible | None = Field(default=None, alias="return")


class Parameters(Part):
    """A cam with its follower; `find` requests that a length is designed."""

    follower: Literal["translating", "oscillating"]
    end: Literal["roller", "flat", "knife"]
    h: Length | None = None
    psi_max: Annotated[Given, quantity("deg", least=0.1, most=120)] | None = None
    arm: Length | None = None
    a: Annotated[Given | None, Sought(quantity("mm", least=0.1, below=1e5))] = None
    lifts: Literal["against", "with"] = "against"
    n: RotationalSpeed | None = None
    direction: Literal["anticlockwise", "clockwise"] = "anticlockwise"
    phases: Phases
    laws: Laws
    limits: PermissibleAngles | None = None
    closed_by: Literal["spring", "form"] = "spring"
    r0: Annotated[Given | None, Sought(quantity("mm", least=0.1, below=1e5))]
    e: Annotated[Given | None, Sought(quantity("mm", above=-1e4, below=1e4))] = Given(0.0, 0.0, "mm", "0 mm")
    roller: Annotated[Given | None, Sought(Roller)] = None
    rho: Length = Given(0.003, 3.0, "mm", "3 mm")
    positions: Annotated[int | Given | PerPhase, Steps()] = 12

    @property
    def translating(self) -> bool:
        return self.follower == "translating"

    @property
    def stroke(self) -> Given | None:
        return self.h if self.translating else self.psi_max

    @property
    def phase_degrees(self) -> tuple[float, float, float, float]:
        """Return the four phases as typed (degrees)."""
        given = (self.phases.rise, self.phases.far, self.phases.return_)
        first, far, back = (round(math.degrees(one.si), 9) for one in given)
        near = self.phases.near
        rest = 360 - first - far - back if near is None else math.degrees(near.si)
        return first, far, back, round(rest, 9)

    def seeks(self, key: str) -> bool:
        """Return True if a length is to be found, including the radius of a roller that is not given."""
        named = key in self.model_fields_set or (key == "roller" and self.end == "roller")
        return named and getattr(self, key) is None

    @property
    def finds(self) -> tuple[str, ...]:
        """Return the keys of the lengths that are to be found."""
        return tuple(key for key in ("r0", "e", "a", "roller") if self.seeks(key))


# --- the cam of a file ----------------------------------------------------------------------------


class Designed(Record):
    """A cam with the choices behind it: the limits, and the least cam within them or None."""

    cam: Cam
    limits: CamLimits
    least: Least | None
    least_r0: float = 0.0
    """The least base circle under a flat face (m)."""
    by_form: bool = False
    """True if the follower is form-closed, so that the cam drives the return, too."""
    usual: bool = False
    """True if the limit of the return is not from the file but the usual one with a spring."""


def table_of(given: LawTable) -> AccelerationGraph:
    """Return the table for a law, with areas above and below the axis made exactly equal."""
    x = np.array(given.x)
    if given.s is not None:
        return graph_of_displacements(x, np.array(given.s))
    a = np.array(given.a)
    above, below = AccelerationGraph(x, a).areas
    return AccelerationGraph(x, np.where(a < 0, a * above / below, a)) if below > 0 else AccelerationGraph(x, a)


def law_of(given: str | LawTable) -> FollowerLaw:
    if isinstance(given, str):
        return law(given)
    if given.segments is None:
        return FollowerLaw("displacements" if given.s is not None else "table", table_of(given))
    segments: list[Segment] = []
    for each in given.segments:
        start, low = (segments[-1].stop, segments[-1].high) if segments else (0.0, 0.0)
        segments.append(Segment(start, each.to, low, low if each.s is None else each.s, each.law or ""))
    return FollowerLaw("segments", segments=tuple(segments))


@lru_cache(maxsize=64)
def _motion(stroke: float, phases: tuple[float, ...], rise: Any, back: Any) -> FollowerMotion:
    first, far, behind, near = (math.radians(phase) for phase in phases)
    return FollowerMotion(stroke, (first, far, behind, near), law_of(rise), law_of(back))


def motion_of(given: Parameters) -> FollowerMotion:
    assert given.stroke is not None, "a check asks for it"
    return _motion(given.stroke.si, given.phase_degrees, given.laws.rise, given.laws.return_)


def limits_of(given: Parameters) -> CamLimits:
    """Return the limits; a form-closed follower without a limit of its return takes that of the rise."""
    rise = given.limits.rise.si if given.limits else None
    back = given.limits.return_.si if given.limits and given.limits.return_ else None
    return CamLimits(rise, rise if back is None and given.closed_by == "form" else back, given.rho.si)


@lru_cache(maxsize=64)
def designed(given: Parameters) -> Designed:
    """Return the cam of a file, with requested lengths found and rounded.

    Raises `NoCamError` if there is none.
    """
    motion, limits = motion_of(given), limits_of(given)

    def size(name: str) -> float:
        length: Given | None = getattr(given, name)
        return 0.0 if length is None else length.si

    cam = Cam(
        motion,
        given.translating,
        given.end == "flat",
        r0=size("r0"),
        e=size("e"),
        a=size("a"),
        arm=size("arm"),
        opposite=1 if given.lifts == "against" else -1,
        roller=size("roller") if given.end == "roller" else 0.0,
        turn=1 if given.direction == "anticlockwise" else -1,
    )
    least, flat = None, 0.0
    if cam.flat:
        flat = inverse_design.least_flat(cam, limits.rho)
        if given.seeks("r0"):
            rounded = (replace(cam, r0=r0) for r0 in inverse_design.round_ups(flat))
            cam = next(one for one in rounded if cam.translating or inverse_design.reaches(one))
    elif limits.rise is not None:
        least, cam = _within(given, cam, limits)
    usual = limits.back is None and least is not None and least.back is not None
    if usual:
        limits = replace(limits, back=inverse_design.USUAL_BY_SPRING)
    return Designed(
        _with_roller(given, cam, limits.rho), limits, least, flat, by_form=given.closed_by == "form", usual=usual
    )


def _with_roller(given: Parameters, cam: Cam, rho: float) -> Cam:
    """Return the cam with the requested roller; a base circle to be found grows as the curvature `rho` (m) requires."""
    if cam.flat:
        return cam
    if not given.seeks("roller"):
        convex = NoCamError("cam-not-convex", "r0")
        return (
            inverse_design.enlarged_until(
                cam, lambda one: inverse_design.least_convex_radius(one) >= rho - 1e-12, convex
            )
            if given.seeks("r0")
            else cam
        )
    none = NoCamError("cam-no-roller", "roller")
    if given.seeks("r0"):
        cam = inverse_design.enlarged_until(cam, lambda one: inverse_design.largest_roller(one, rho) > 0, none)
    if (roller := inverse_design.largest_roller(cam, rho)) <= 0:
        raise none
    return replace(cam, roller=roller)


def _within(given: Parameters, cam: Cam, limits: CamLimits) -> tuple[Least | None, Cam]:
    """Return the least cam within the limits or None, and a cam with the requested lengths rounded."""
    motion = cam.motion
    if cam.translating:
        least = inverse_design.least_translating(motion, limits, None if given.seeks("e") else cam.e)
        e = round(least.e * MM) / MM if given.seeks("e") else cam.e
        if not given.seeks("r0"):
            return least, replace(cam, e=e)
        needed = inverse_design.least_translating(motion, limits, e).r0
        return least, replace(cam, e=e, r0=inverse_design.rounded_up(needed))

    def at(a: float) -> Least | None:
        return inverse_design.least_oscillating(motion, limits, cam.arm, cam.opposite, a)

    if given.seeks("a"):
        best = inverse_design.best_distance(motion, limits, cam.arm, cam.opposite).a
        cam = replace(cam, a=next(a for a in inverse_design.round_ups(best) if at(a) is not None))
    least_cam = at(cam.a)
    if not given.seeks("r0"):
        return least_cam, cam
    if least_cam is None:
        raise NoCamError("cam-no-centre", "limits")
    chosen = (replace(cam, r0=r0) for r0 in inverse_design.round_ups(least_cam.r0))
    return least_cam, next(one for one in chosen if one.psi0 <= least_cam.most + ALLOWED)


def positions_of(given: Parameters) -> tuple[float, ...]:
    """Return the cam angles (degrees, to hundredths) from the start of the rise: equal steps, with the ends of every
    phase.
    """
    phases = given.phase_degrees
    ends = [sum(phases[:number]) for number in range(4)]
    match given.positions:
        case PerPhase(per_phase):
            counts = dict(per_phase)
            even = [
                start + angle * step / counts.get(phase, 1)
                for phase, start, angle in zip(PHASES, ends, phases, strict=True)
                for step in range(counts.get(phase, 1))
            ]
        case Given() as step:
            even = list(np.arange(0, 360 - 1e-9, math.degrees(step.si)))
        case count:
            even = [360 * step / count for step in range(count)]
    return tuple(sorted({round(one, 2) % 360 for one in (*even, *ends)}))


# --- extreme values ------------------------------------------------------------------------------


def exceeded(design_found: Designed) -> Iterator[tuple[str, float, float]]:
    """Yield the phases in which the pressure angle exceeds its limit, with its largest value and its cam angle
    (rad).
    """
    cam, limits = design_found.cam, design_found.limits
    for phase, limit, sign in (("rise", limits.rise, 1), ("return", limits.back, -1)):
        if limit is None or cam.flat:
            continue
        at, angle = extreme(cam, phase, sign)
        if angle > limit + ALLOWED:
            yield phase, angle, at


def steep(design_found: Designed) -> Iterator[tuple[float, float, float]]:
    """Yield, without given limits, pressure angles beyond the usual, the largest first: value, cam angle and usual
    limit (rad).
    """
    cam = design_found.cam
    if cam.flat:
        return
    rise = inverse_design.USUAL_RISE[cam.translating]
    for phase, usual in (("rise", rise), ("return", rise if design_found.by_form else inverse_design.USUAL_BY_SPRING)):
        at, angle = max((extreme(cam, phase, sign) for sign in (1, -1)), key=lambda one: one[1])
        if angle > usual + ALLOWED:
            yield angle, at, usual


def extreme(cam: Cam, phase: str, sign: int) -> tuple[float, float]:
    """Return the cam angle (rad) in a phase where ±α is greatest, and its value (rad)."""
    numbers = [number for number, one in enumerate(cam.motion.intervals) if one.phase == phase]
    return max((cam.worst(number, lambda one: sign * one.alpha) for number in numbers), key=lambda one: one[1])


@view()
class Judged(Record):
    """The largest pressure angles (rad) with their cam angles, the least radii of curvature (m) and the largest one."""

    rise: tuple[float, float]
    back: tuple[float, float]
    least_rho: tuple[float, float]
    least_working: tuple[float, float]
    largest: float
    aside: tuple[float, float]
    """For a flat face the largest s′ (m) and the largest −s′ (m); for an oscillating face the nearest and farthest
    contact.
    """


def judged(cam: Cam) -> Judged:
    every = range(len(cam.motion.intervals))

    def least(of: str) -> tuple[float, float]:
        minima = []
        for number in every:
            if of == "working":
                φ, value = cam.worst(number, lambda one: -one.effective)
            else:
                φ, value = cam.worst(number, lambda one: np.where(one.rho > 0, -one.rho, -np.inf))
            minima.append((φ, -value))
        return min(minima, key=lambda one: one[1])

    profile = cam.sampled()
    aside = (float(profile.ds.max()), float(-profile.ds.min()))
    if not cam.translating:
        contact = np.abs(profile.at - complex(cam.opposite * cam.turn * cam.a, 0))
        aside = (float(contact.min()), float(contact.max()))
    return Judged(
        extreme(cam, "rise", 1),
        extreme(cam, "return", -1),
        least("rho"),
        least("working"),
        float(np.abs(profile.pitch).max()),
        aside,
    )
