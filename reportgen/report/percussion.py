"""The single force that replaces a link's inertia force and couple: its centre of percussion K, the point Q, and its
line.

The construction depends on the position: Q needs two lines that meet on the sheet.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from reportgen.base.records import Record
from reportgen.drawing import Circle, Item, Line
from reportgen.drawing.canvas import Canvas
from reportgen.drawing.force_drawings import LEAST_ARM, TOGETHER
from reportgen.drawing.labels import joined, label
from reportgen.drawing.style import CONSTRUCTION, PAPER, VISIBLE
from reportgen.formula import Symbol, constructions, ids
from reportgen.formula.calculation import ZERO
from reportgen.machine.force_analysis import as_single_force, percussion_points
from reportgen.report.body_views import BodyView
from reportgen.report.context import ReportContext

PercussionCase = Literal["none", "couple", "still", "pivot", "meet", "parallel", "far"]


class Percussion(Record):
    """Construction of the line of a link's single inertia force at a position; points in m (x + iy).

    `state`: "none" if there is no couple, so that the force acts at S; "couple" if there is no force; "still" if the
    pin is fixed, "pivot" if it has no acceleration, so that the force passes through `K`.  Otherwise the lines through
    S and K "meet" in `at`, are "parallel", or meet too "far" away; then `at` is the foot of S on the line, at the
    computed distance.
    """

    state: PercussionCase
    K: complex
    at: complex


def percussion(report: ReportContext, body: BodyView, k: int) -> Percussion:
    """Return the construction of the single inertia force of a link at position `k`."""
    motion, index = report.analysis.motion, k - 1
    start, centre = (motion.points[name] for name in (body.start, body.centre))
    l_sk = float(report.ledger[ids.percussion(body.centre, body.link)].values[0])
    known, meeting = (complex(at[index]) for at in percussion_points(start.p, centre.p, start.a, centre.a, l_sk))
    load = next(load for load in report.analysis.loads if load.name == body.force)
    s, foot = complex(centre.p[index]), complex(as_single_force(load)[index])
    if report.is_zero(body.couple, k):
        return Percussion("none", known, s)
    if report.is_zero(body.force, k):
        return Percussion("couple", known, s)
    of_pin, turning = complex(start.a[index]), complex(centre.a[index] - start.a[index])
    if body.still or abs(of_pin) < ZERO * np.abs(start.a).max():
        return Percussion("still" if body.still else "pivot", known, known)
    if not np.isfinite(meeting) or abs(constructions.cross(of_pin, turning)) < ZERO * abs(of_pin) * abs(turning):
        return Percussion("parallel", known, foot)
    near = abs(s - complex(start.p[index])) + 2 * l_sk
    return Percussion("meet", known, meeting) if abs(meeting - s) < near else Percussion("far", known, foot)


def percussion_state(report: ReportContext, body: BodyView, k: int) -> PercussionCase:
    """Return the key of the phrase for this construction, which is its `state`."""
    return percussion(report, body, k).state


def drawn(report: ReportContext, link: int, k: int, scale: float) -> Canvas:
    """Draw K on a link, with the lines that meet in Q or the distance of S from the line, at `scale` (mm/m)."""
    body = next((body for body in report.couples if body.link == link), None)
    if body is None:
        return Canvas()
    how = percussion(report, body, k)
    if how.state in ("none", "couple"):
        return Canvas()
    centre, known, at = (place * scale for place in (report.place(body.centre, k), how.K, how.at))
    K, Q = Symbol("K", str(link)), Symbol("Q", str(link))
    mark = Circle(known, 0.6, VISIBLE, PAPER)
    if how.state == "meet":
        items: list[Item] = [Line(centre, at, CONSTRUCTION), Line(known, at, CONSTRUCTION), mark]
        if abs(known - at) < TOGETHER:
            return Canvas((*items,), (label(known, *joined((K, Q)), gap=1.2),))
        return Canvas((*items, Circle(at, 0.6, VISIBLE, PAPER)), (label(known, K, gap=1.2), label(at, Q, gap=1.2)))
    names = [label(known, K, gap=1.2)]
    if how.state in ("still", "pivot") or abs(at - centre) < LEAST_ARM:
        return Canvas((Line(centre, known, CONSTRUCTION), mark), tuple(names))
    e = report.ledger.symbol(ids.inertia_offset(link))
    names.append(label([centre + (at - centre) * share for share in (0.5, 0.7, 0.3)], e, gap=0.8))
    return Canvas((Line(centre, known, CONSTRUCTION), Line(centre, at, CONSTRUCTION), mark), tuple(names))
