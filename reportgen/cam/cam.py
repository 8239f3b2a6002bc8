"""The kind `cam`: its case, faults of impossible cams, and warnings about unusual ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from reportgen.assignment.checks import of_parameters
from reportgen.assignment.common import Draft
from reportgen.base.errors import Finding
from reportgen.base.units import MM
from reportgen.cam import file
from reportgen.cam.file import PerPhase, designed, exceeded, motion_of, positions_of, steep
from reportgen.cam.formulas import lowest_of_face, valued
from reportgen.cam.inverse_design import NoCamError, touch
from reportgen.cam.motion_laws import PHASES, AccelerationGraph

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.cam.case import CamCase

Parameters = file.Parameters
TURNS = 1
HAS_POSITIONS = False
PART = "cam"
TOP = ("parameters",)
SAME_AREA = 0.01
"""The areas of an acceleration table above and below its axis may differ by this share."""
SUM = 1e-6
"""Largest difference of the sum of the phases from a whole turn (degrees)."""


def case(assignment: Assignment) -> CamCase:
    """Return the case of an assignment."""
    from reportgen.cam.case import CamCase

    return CamCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float | None]]:
    """Return the rows that `solve` prints for a position of the results: lengths in mm, pressure angles in degrees."""
    radius, (x, y) = position["curvature_radius"], position["profile"]
    angle, lengths = math.degrees(position["pressure_angle"]), {"ρ": radius, "x": x, "y": y}
    return {
        "follower": _in_mm(position.get("follower", {})),
        "swing": position.get("swing", {}),
        "profile": {"α": angle, **_in_mm(lengths)},
    }


def _in_mm(lengths: Mapping[str, float | None]) -> dict[str, float | None]:
    return {name: None if length is None else length * MM for name, length in lengths.items()}


# --- faults -------------------------------------------------------------------------------------

NEEDED = {"translating": ("h",), "oscillating": ("psi_max", "a")}
IDLE = {"translating": ("psi_max", "arm", "a", "lifts"), "oscillating": ("h", "e")}


def _keys(given: Parameters) -> Iterator[Finding]:
    """Yield findings for lengths that such a follower needs and that are missing, and for lengths that it does not
    have.
    """
    keys_given = given.model_fields_set
    needed, idle = list(NEEDED[given.follower]), list(IDLE[given.follower])
    if given.end != "roller":
        idle.append("roller")
    if given.end == "flat":
        idle += ["e", "arm", "limits"]
    elif not given.translating:
        needed.append("arm")
    for key in needed:
        if key not in keys_given:
            yield Finding("missing-key", (*TOP, key), {"key": key})
    for key in idle:
        if key in keys_given:
            yield Finding("cam-idle-key", (*TOP, key), {"key": key, "of": f"{given.follower}, {given.end}"}, at="key")
    sought = [key for key in ("r0", "e", "a") if given.seeks(key)]
    if given.end == "flat" and given.seeks("a"):
        yield Finding("cam-free", (*TOP, "a"))
    if sought and given.end != "flat" and given.limits is None:
        yield Finding("missing-key", (*TOP, "limits"), {"key": "limits"})
    if sought and sought != ["r0"] and "r0" not in sought:
        yield Finding("cam-find-r0", (*TOP, sought[0]), {"key": sought[0]})


def _phases(given: Parameters) -> Iterator[Finding]:
    first, far, back, near = given.phase_degrees
    total = first + far + back + near
    if near < -SUM or (given.phases.near is not None and abs(total - 360) > SUM):
        phase_sum = first + far + back + max(near, 0.0)
        yield Finding("cam-phases", (*TOP, "phases"), {"sum": f"{phase_sum:g}", "off": f"{360 - phase_sum:+g}"})
    parts = dict(zip(PHASES, (first, far, back, near), strict=True))
    if isinstance(given.positions, PerPhase):
        for key, _ in given.positions.counts:
            if parts[key] <= 0:
                yield Finding("cam-no-phase", (*TOP, "positions", key), {"key": key})


def _tables(given: Parameters) -> Iterator[Finding]:
    """Yield findings if an acceleration graph does not begin at 0, end at 1, or bring the follower to rest."""
    for key, law in (("rise", given.laws.rise), ("return", given.laws.return_)):
        if isinstance(law, str):
            continue
        where = (*TOP, "laws", key)
        if len(law.x) != len(law.a):
            counts = {"key": "a", "given": str(len(law.a)), "other": "x", "wanted": str(len(law.x))}
            yield Finding("row-length", (*where, "a"), counts)
        elif law.x[0] != 0 or law.x[-1] != 1:
            at = 0 if law.x[0] != 0 else len(law.x) - 1
            yield Finding("table-end", (*where, "x", at), {"key": "x", "end": "0" if at == 0 else "1"})
        elif falls := [i + 1 for i in range(len(law.x) - 1) if law.x[i + 1] < law.x[i]]:
            yield Finding("not-increasing", (*where, "x", falls[0]), {"key": "x"})
        else:
            above, below = AccelerationGraph(np.array(law.x), np.array(law.a)).areas
            if abs(above - below) > SAME_AREA * max(above, below) or above == 0:
                yield Finding("cam-areas", (*where, "a"), {"above": f"{above:.4g}", "below": f"{below:.4g}"})
            elif AccelerationGraph(np.array(law.x), np.array(law.a)).displacement <= 0:
                yield Finding("cam-backwards", (*where, "a"))


def _shape(given: Parameters) -> Iterator[Finding]:
    """Yield findings for lengths that make no cam by themselves, then for requested lengths that cannot be found."""
    r0, e, a, arm, roller = (getattr(given, key) for key in ("r0", "e", "a", "arm", "roller"))
    if r0 and e and abs(e.si) >= r0.si:
        yield Finding("cam-offset", (*TOP, "e"), {"e": e.text, "r0": r0.text})
        return
    if r0 and roller and roller.si >= r0.si:
        yield Finding("cam-roller", (*TOP, "roller"), {"roller": roller.text, "r0": r0.text})
        return
    if not given.translating and r0 and a:
        if given.end == "flat":
            if r0.si >= a.si:
                yield Finding("cam-face", (*TOP, "r0"), {"r0": r0.text, "a": a.text})
                return
        elif not abs(a.si - arm.si) < r0.si < a.si + arm.si:
            ends = {"low": f"{abs(a.si - arm.si) * MM:g}", "high": f"{(a.si + arm.si) * MM:g}"}
            yield Finding("cam-triangle", (*TOP, "r0"), {"r0": r0.text, **ends})
            return
    if not given.translating and (faults := list(_swing(given))):
        yield from faults
        return
    try:
        cam = designed(given).cam
    except NoCamError as error:
        yield Finding(error.code, (*TOP, error.key))
        return
    if not cam.translating and cam.psi0 + cam.motion.stroke >= math.pi:
        yield _past(cam.psi0 + cam.motion.stroke)


def _swing(given: Parameters) -> Iterator[Finding]:
    """Yield findings for a swing that is too fast for the cam, or too far for a face, which must stay short of a right
    angle.
    """
    motion, flat = motion_of(given), given.end == "flat"
    # Where k = 1 ± ψ′ becomes 0, the point of contact moves off to infinity along the face.
    if given.lifts == "with":
        fastest = touch(motion, "rise", lambda _, ds: ds).bound
    else:
        fastest = touch(motion, "return", lambda _, ds: -ds).bound if flat else 0.0
    if fastest >= 1:
        yield Finding("cam-overtakes", (*TOP, "phases"))
    if flat:
        start = float(valued(lowest_of_face, given.r0.si, given.a.si)) if given.r0 and given.a else 0.0
        if start + motion.stroke >= math.pi / 2:
            yield _past(start + motion.stroke)


def _past(angle: float) -> Finding:
    return Finding("cam-past", (*TOP, "psi_max"), {"angle": f"{math.degrees(angle):.2f}"})


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of keys, then of phases and tables, then of lengths: each group only if the ones before have
    none.
    """
    for look in (_keys, lambda one: (*_phases(one), *_tables(one)), _shape):
        faults = list(look(given))
        if faults:
            yield from faults
            return


def _worked(draft: Draft) -> Iterator[Finding]:
    """Yield findings if worked positions are not numbers of positions, or are repeated."""
    report, given = draft.sections.get("report"), draft.sections.get("parameters")
    if report is None or given is None or report.worked_positions is None or list(check(given)):
        return
    last = len(positions_of(given))
    for index, position in enumerate(report.worked_positions):
        where = ("report", "worked_positions", index)
        if isinstance(position, str):
            yield Finding("no-such-label", where, {"text": position, "known": f"1 … {last}"})
        elif position > last:
            yield Finding("no-such-position", where, {"text": str(position), "last": str(last)})


CHECKS = (of_parameters(check), _worked)


# --- warnings -----------------------------------------------------------------------------------


def physics(assignment: Assignment) -> Iterator[Finding]:
    """Yield warnings about rigid impacts, large pressure angles and undercut profiles, with the place and a remedy."""
    given: Parameters = assignment.parameters
    design = designed(given)
    cam, motion = design.cam, design.cam.motion
    for impact in motion.impacts:
        if impact.kind == "rigid":
            phase = motion.intervals[int(motion.of(np.array([impact.angle]))[0])].phase
            key = phase if phase in ("rise", "return") else "rise" if phase == "far" else "return"
            yield Finding("cam-impact", (*TOP, "laws", key), {"angle": f"{math.degrees(impact.angle):g}"})
    for phase, angle, at in exceeded(design):
        wanted = design.least
        mend = f"{math.ceil(wanted.r0 * MM * 10) / 10:g}" if wanted is not None else ""
        angles = {"angle": f"{math.degrees(angle):.2f}", "at": f"{math.degrees(at):.1f}"}
        yield Finding("cam-pressure", (*TOP, "limits", phase), angles | ({"r0": mend} if mend else {}))
    for angle, at, usual in steep(design) if given.limits is None else ():
        angles = {"angle": f"{math.degrees(angle):.2f}", "at": f"{math.degrees(at):.1f}"}
        yield Finding("cam-steep", (*TOP, "r0"), angles | {"usual": f"{math.degrees(usual):g}"})
    for angle in cam.undercut[:1]:
        yield Finding("cam-undercut", (*TOP, "roller" if cam.roller else "r0"), {"at": f"{math.degrees(angle):.1f}"})


WARNINGS = (physics,)
