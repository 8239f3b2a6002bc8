"""Instant centres of velocity: how they lie at a position, and the mechanism drawn with them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.document.figures import A3_ACROSS, A3_UPRIGHT, Drawn, drawing_scale, fits, looks, on_paper
from reportgen.document.groups import PlaneLink
from reportgen.document.report import Report
from reportgen.figures.positions import Centre, PlaneMotion, centre_plan
from reportgen.figures.scene import Scene
from reportgen.ledger.kinematics.centres import NEAREST, centre_symbol
from reportgen.notation import ids
from reportgen.notation.expressions import Symbol


def centre_state(report: Report, link: PlaneLink, k: int) -> str:
    """How a link's centre lies: "found", "shift" (it does not turn), "rest" (at its base), "near" its base, "far"."""
    ledger = report.ledger
    if ledger[link.omega].at(k) == 0:
        return "shift"
    if ledger[ids.velocity(link.base)].at(k) == 0:
        return "rest"
    if np.isfinite([ledger[id].at(k) for id in link.distances]).all():
        return "found"
    base = complex(ledger[ids.place(link.base)].at(k))
    to_base = abs(complex(ledger[ids.centre(link.link)].at(k)) - base) / float(ledger["mu.l"].values[0])
    return "near" if to_base < NEAREST else "far"


def _place(report: Report, link: PlaneLink, k: int) -> complex:
    return complex(report.ledger[ids.centre(link.link)].at(k)) * drawing_scale(report)


def centres(report: Report, k: int) -> Drawn:
    """The mechanism at a position, true to μ_l: normals that meet in the centres, velocities and their angles.

    Centres stand together on a sheet as far as one holds them.
    """
    linkage, scale, motion = report.machine.linkage, drawing_scale(report), report.analysis.motion
    angles = [_plane_motion(report, link, k) for link in report.plane_links]

    def scene(links: Sequence[PlaneLink], first: bool) -> Scene:
        marks = [Centre(centre_symbol(one.link), _place(report, one, k), (one.base, one.point)) for one in links]
        own = angles if first else ()
        return centre_plan(linkage, motion, k - 1, scale, centres=marks, looks=looks(report, scale), moving=own)

    sheets: list[list[PlaneLink]] = [[]]
    for link in (link for link in report.plane_links if centre_state(report, link, k) == "found"):
        for index, links in enumerate(sheets):
            if not links or _has_a_sheet(scene([*links, link], index == 0)):
                links.append(link)
                break
        else:
            sheets.append([link])
    return on_paper(*(scene(links, index == 0) for index, links in enumerate(sheets)))


def _has_a_sheet(scene: Scene) -> bool:
    return any(fits(scene.width, scene.height, paper) for paper in (A3_ACROSS, A3_UPRIGHT))


def _plane_motion(report: Report, link: PlaneLink, k: int) -> PlaneMotion:
    """The velocities of a link's two points and their angles with the line between them."""
    ledger, points = report.ledger, report.analysis.motion.points
    ends = (link.base, link.point)
    moving = [not report.is_zero(ids.velocity(name), k) for name in ends]
    return PlaneMotion(
        ends,
        tuple(complex(points[name].v[k - 1]) if there else 0j for name, there in zip(ends, moving, strict=True)),
        tuple(Symbol("v", name, over="vector") for name in ends),
        tuple(ledger.symbol(id) for id in link.angles),
    )
