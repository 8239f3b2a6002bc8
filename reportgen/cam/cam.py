"""The kind `cam`: its case, faults of impossible cams, and warnings about unusual ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.assignment.common import Draft
from reportgen.base.errors import Finding, Where
from reportgen.base.units import MM
from reportgen.cam import file
from reportgen.cam.file import LawTable, PerPhase, designed, exceeded, motion_of, positions_of, steep, table_of
from reportgen.cam.formulas import lowest_of_face, valued
from reportgen.cam.inverse_design import NoCamError, touch
from reportgen.cam.motion_laws import PHASES, AccelerationGraph, FollowerLaw

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
RUNS_BACK = 0.02
"""Share of the greatest V by which a follower between two nodes of its table may run back: less is not seen."""
MOST_UNCERTAIN = 0.1
"""Share of the greatest acceleration by which rounded displacements may leave the acceleration uncertain."""
SAMPLES = 2001
"""Number of samples of a law over its phase."""
SHORTEST = 1e-3
"""Least share of a phase that a segment of a law takes."""
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


def _laws(given: Parameters) -> Iterator[Finding]:
    """Yield findings about laws by tables and by segments."""
    for key, law in (("rise", given.laws.rise), ("return", given.laws.return_)):
        where = (*TOP, "laws", key)
        if isinstance(law, LawTable):
            yield from _table(law, where) if law.segments is None else _segments(law, (*where, "segments"))


def _table(law: LawTable, where: Where) -> Iterator[Finding]:
    """Yield findings if a graph does not begin at 0, end at 1, or bring the follower to rest at the end of its
    stroke.
    """
    key, row = ("a", law.a) if law.s is None else ("s", law.s)
    if row is None or law.x is None:
        name, known = ("a", "a | s | segments") if row is None else ("x", "x")
        yield Finding("missing-key", (*where, name), {"key": known})
        return
    steps = [after - before for before, after in pairwise(law.x)]
    if len(law.x) != len(row):
        counts = {"key": key, "given": str(len(row)), "other": "x", "wanted": str(len(law.x))}
        yield Finding("row-length", (*where, key), counts)
    elif law.x[0] != 0 or law.x[-1] != 1:
        at = 0 if law.x[0] != 0 else len(law.x) - 1
        yield Finding("table-end", (*where, "x", at), {"key": "x", "end": "0" if at == 0 else "1"})
    elif falls := [i + 1 for i, step in enumerate(steps) if step < 0 or (step == 0 and key == "s")]:
        yield Finding("not-increasing", (*where, "x", falls[0]), {"key": "x"})
    elif key == "s":
        yield from _displacements(row, where)
    else:
        graph = AccelerationGraph(np.array(law.x), np.array(row))
        above, below = graph.areas
        if abs(above - below) > SAME_AREA * max(above, below) or above == 0:
            yield Finding("cam-areas", (*where, "a"), {"above": f"{above:.4g}", "below": f"{below:.4g}"})
        elif graph.displacement <= 0:
            yield Finding("cam-backwards", (*where, "a"))


def _displacements(s: Sequence[float], where: Where) -> Iterator[Finding]:
    """Yield findings if a table of displacements does not begin at 0, or falls, or never rises."""
    if s[0] != 0:
        yield Finding("table-end", (*where, "s", 0), {"key": "s", "end": "0"})
        return
    falls = [i + 1 for i, (before, after) in enumerate(pairwise(s)) if after < before]
    if falls:
        yield Finding("cam-falls", (*where, "s", falls[0]), {"key": "s"})
    elif s[-1] == 0:
        yield Finding("cam-no-rise", (*where, "s", len(s) - 1))


def _segments(law: LawTable, where: Where) -> Iterator[Finding]:
    """Yield findings unless the segments follow one another to the end of the phase and of the stroke."""
    if law.x is not None:
        yield Finding("both-given", (*where[:-1], "x"), {"first": "segments", "second": "x"}, at="key")
        return
    segments = law.segments or ()
    to = s = 0.0
    for index, segment in enumerate(segments):
        reached = s if segment.s is None else segment.s
        if segment.to - to < SHORTEST:
            yield Finding("not-increasing", (*where, index, "to"), {"key": "to"})
            return
        if reached < s:
            yield Finding("cam-falls", (*where, index, "s"), {"key": "s"})
            return
        if (reached > s) != (segment.law is not None):
            yield Finding("cam-segment", (*where, index), {"from": f"{s:g}", "to": f"{reached:g}"})
            return
        to, s = segment.to, reached
    if to != 1:
        yield Finding("table-end", (*where, len(segments) - 1, "to"), {"key": "to", "end": "1"})
    elif s != 1:
        key = ("s",) if segments[-1].s is not None else ()
        yield Finding("table-end", (*where, len(segments) - 1, *key), {"key": "s", "end": "1"})


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
    for look in (_keys, lambda one: (*_phases(one), *_laws(one)), _shape):
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


CHECKS = (
    *(one_of(f"parameters.laws.{phase}", "a", "s", "segments", required=False) for phase in ("rise", "return")),
    of_parameters(check),
    _worked,
)


# --- warnings -----------------------------------------------------------------------------------


def _differences(given: Parameters) -> Iterator[Finding]:
    """Yield warnings about tables of displacements whose differences say less of the acceleration than it needs.

    A displacement rounded to u is uncertain by u/2, its second difference by 2u, so A by 2u/Δx².  If the spline runs
    back between two nodes, the table has a misprint or is too coarse.
    """
    for key, law in (("rise", given.laws.rise), ("return", given.laws.return_)):
        if not isinstance(law, LawTable) or law.s is None or law.x is None:
            continue
        where, unit = (*TOP, "laws", key, "s"), resolution(law.s)
        graph = table_of(law)
        inside = np.linspace(0, 1, SAMPLES)
        V = FollowerLaw("displacements", graph)(inside)[1]
        uncertain = 2 * unit / float(min(np.diff(law.x))) ** 2 / float(np.abs(graph.a).max())
        back = -float(V.min()) / float(V.max())
        if back > RUNS_BACK:
            near = int(np.abs(np.array(law.x) - inside[V.argmin()]).argmin())
            yield Finding("cam-ripple", (*where, near), {"x": f"{inside[V.argmin()]:.3g}"})
        elif uncertain > MOST_UNCERTAIN:
            about = {"unit": f"{unit:g}", "share": f"{uncertain * 100:.0f}"}
            yield Finding("cam-resolution", where, about, at="key")


def resolution(values: Sequence[float]) -> float:
    """Return the unit of the last decimal of a table's values."""
    decimals = (f"{value:.9f}".rstrip("0").partition(".")[2] for value in values)
    return float(10.0 ** -max(map(len, decimals)))


def physics(assignment: Assignment) -> Iterator[Finding]:
    """Yield warnings about rigid impacts, large pressure angles and undercut profiles, with the place and a remedy."""
    given: Parameters = assignment.parameters
    yield from _differences(given)
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
