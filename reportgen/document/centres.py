"""Instant centres of velocity: how they lie at a position, and the mechanism drawn with them."""

from __future__ import annotations

import numpy as np

from reportgen.document.figures import A3_ACROSS, A3_UPRIGHT, ROOM, Drawn, drawing_scale, figure, fits, in_text, looks
from reportgen.document.groups import PlaneLink
from reportgen.document.report import Report, function
from reportgen.figures.positions import Centre, PlaneMotion, centre_plan
from reportgen.figures.scene import Scene
from reportgen.ledger.kinematics.centres import NEAREST, PREFIX, centre_symbol
from reportgen.notation.expressions import Symbol


@function
def centre_state(report: Report, link: PlaneLink, k: int) -> str:
    """How a link's centre lies: "found", "shift" (it does not turn), "rest" (at its base), "near" its base, "far"."""
    ledger = report.ledger
    if ledger[link.omega].at(k) == 0:
        return "shift"
    if ledger[f"v.{link.base}"].at(k) == 0:
        return "rest"
    if np.isfinite([ledger[id].at(k) for id in link.distances]).all():
        return "found"
    base = complex(ledger[f"p.{link.base}"].at(k))
    to_base = abs(complex(ledger[f"{PREFIX}{link.link}"].at(k)) - base) / float(ledger["mu.l"].values[0])
    return "near" if to_base < NEAREST else "far"


def _place(report: Report, link: PlaneLink, k: int) -> complex:
    return complex(report.ledger[f"{PREFIX}{link.link}"].at(k)) * drawing_scale(report)


def _sheets(report: Report, k: int) -> list[list[PlaneLink]]:
    """The links whose centres stand on one sheet together with the mechanism; at least one sheet."""
    points = [complex(point.p[k - 1]) * drawing_scale(report) for point in report.analysis.motion.points.values()]
    result: list[list[PlaneLink]] = [[]]
    for link in report.plane_links:
        if centre_state(report, link, k) != "found":
            continue
        for links in result:
            spots = np.array([*points, *(_place(report, one, k) for one in (*links, link))])
            size = float(np.ptp(spots.real)) + ROOM, float(np.ptp(spots.imag)) + ROOM
            if not links or any(fits(*size, paper) for paper in (A3_ACROSS, A3_UPRIGHT)):
                links.append(link)
                break
        else:
            result.append([link])
    return result


@figure("centres")
def centres(report: Report, k: int) -> Drawn:
    """The mechanism at a position, true to μ_l: normals that meet in the centres, velocities and their angles."""
    linkage, scale, motion = report.machine.linkage, drawing_scale(report), report.analysis.motion
    angles = [_motion(report, link, k) for link in report.plane_links]

    def scene(links: list[PlaneLink], first: bool) -> Scene:
        marks = [Centre(centre_symbol(one.link), _place(report, one, k), (one.base, one.point)) for one in links]
        own = angles if first else ()
        return centre_plan(linkage, motion, k - 1, scale, marks, looks(report, scale), own)

    scenes = tuple(scene(links, index == 0) for index, links in enumerate(_sheets(report, k)))
    if all(map(in_text, scenes)):
        return Drawn(scenes)
    papers = (A3_ACROSS, A3_UPRIGHT)
    held = (one for one in papers if all(fits(scene.width, scene.height, one) for scene in scenes))
    return Drawn(scenes, next(held, A3_UPRIGHT))


def _motion(report: Report, link: PlaneLink, k: int) -> PlaneMotion:
    """The velocities of a link's two points and their angles with the line between them."""
    ledger, points = report.ledger, report.analysis.motion.points
    ends = (link.base, link.point)
    moving = [not report.is_zero(f"v.{name}", k) for name in ends]
    return PlaneMotion(
        ends,
        tuple(complex(points[name].v[k - 1]) if there else 0j for name, there in zip(ends, moving, strict=True)),
        tuple(Symbol("v", name, over="vector") for name in ends),
        tuple(ledger.symbol(id) for id in link.angles),
    )
