"""Wide sliders in the figures of a report: their faces, and the reactions at both ends of a slider that tilts."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.drawing import Item, Line, style
from reportgen.drawing.force_drawings import LEAST_ARM
from reportgen.drawing.geometry import unit
from reportgen.formula import Symbol, constructions, ids, vocabulary
from reportgen.machine.loads import carriers
from reportgen.machine.shared_results import FACES
from reportgen.machine.slider_faces import Faces
from reportgen.report.context import ReportContext


def wide_sliders_of(report: ReportContext) -> Mapping[int, Faces]:
    """Return the faces of wide sliders by their links; {} if all sliders are narrow."""
    return FACES.of(report.machine) or {}


def tilts(report: ReportContext, digits: str, k: int) -> bool:
    """Return True if a slider tilts at a position, according to the printed values."""
    first = ids.face_reaction(digits, 1)
    return first in report.ledger and bool(np.isfinite(report.ledger[first].at(k)))


def ends_of(report: ReportContext, link: int, k: int) -> tuple[complex, complex]:
    """Return the places (m, x + iy) of the two ends of a slider's face."""
    wide, motion = wide_sliders_of(report)[link], report.analysis.motion
    along = complex(motion.slides[carriers(report.machine.linkage)[link], link].direction[k - 1])
    first, last = (x - 1j * wide.below for x in (wide.first, wide.last))
    pin = complex(motion.origins[link].p[k - 1])
    return pin + first * along, pin + last * along


def face(report: ReportContext, link: int, k: int, scale: float) -> list[Item]:
    """Draw the face of a slider with the arm to its pin, in mm of paper (`scale` in mm/m)."""
    first, last = (place * scale for place in ends_of(report, link, k))
    pin = complex(report.analysis.motion.origins[link].p[k - 1]) * scale
    foot = complex(constructions.foot(pin, first, unit(last - first)))
    arm = [Line(pin, foot, style.THIN)] if abs(foot - pin) > LEAST_ARM else []
    return [Line(first, last, style.VISIBLE), *arm]


def at_ends(report: ReportContext, digits: str, link: int, k: int) -> list[tuple[Symbol, complex, complex, str]]:
    """Return the reactions at both ends of a slider that tilts: vector symbol, place (m), force (N) as x + iy, id; []
    if it does not tilt.
    """
    if link not in wide_sliders_of(report) or not tilts(report, digits, k):
        return []
    along = complex(report.analysis.motion.slides[carriers(report.machine.linkage)[link], link].direction[k - 1])
    forces = []
    for number, place in enumerate(ends_of(report, link, k), 1):
        id = ids.face_reaction(digits, number)
        size = float(np.real(report.ledger[id].at(k)))
        vector = vocabulary.vector(report.ledger.symbol(id))
        forces.append((vector, place, size * 1j * along, id))
    return forces
