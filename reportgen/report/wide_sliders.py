"""Sliders as wide as they are: the views that templates name, their states, table and reactions in figures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.base.shown import view
from reportgen.document.prose import NamedPoint
from reportgen.drawing import Item, Line, style
from reportgen.drawing.forces import LEAST_ARM
from reportgen.drawing.geometry import unit
from reportgen.formula import Symbol, constructions, ids, vocabulary
from reportgen.machine.loads import carriers
from reportgen.report.report import Report
from reportgen.report.tables import bare


@view("lines", "ends")
@dataclass(frozen=True, slots=True)
class WideSlider:
    """A slider with its face: its reaction's `digits`, its pin, the ids of the given ends of the face.

    `lines` are those of the reaction and of where it acts, `ends` of the reactions at both ends where it tilts.
    """

    link: int
    digits: str
    pin: NamedPoint
    first: str
    last: str
    below: str

    def __str__(self) -> str:
        return self.digits

    @property
    def lines(self) -> list[str]:
        return [ids.normal_reaction(self.digits), ids.normal_place(self.digits)]

    @property
    def ends(self) -> list[str]:
        return [ids.face_reaction(self.digits, number) for number in (1, 2)]


def wide_sliders(report: Report) -> tuple[WideSlider, ...]:
    """The sliders whose faces are given, in the order of the file."""
    linkage, sliders = report.machine.linkage, []
    pins = {link: dyad.middle for dyad in linkage.dyads for link in dyad.links}
    for link in report.machine.faces:
        digits = ids.joint(carriers(linkage)[link], link)
        below = ids.face_below(link) if ids.face_below(link) in report.ledger else ""
        pin = NamedPoint(pins[link])
        sliders.append(WideSlider(link, digits, pin, ids.face_from(link), ids.face_to(link), below))
    return tuple(sliders)


def tilts(report: Report, digits: str, k: int) -> bool:
    """Whether a slider tilts at a position, as it is printed."""
    first = ids.face_reaction(digits, 1)
    return first in report.ledger and bool(np.isfinite(report.ledger[first].at(k)))


def face_state(report: Report, slider: WideSlider, k: int) -> str:
    """The key of the words for how a slider lies in its guide."""
    return "tilts" if tilts(report, slider.digits, k) else "within"


def rows(report: Report, digits: str) -> Iterator[Sequence[object]]:
    """At each position the reaction, where it acts, whether the slider tilts, and both ends if it does."""
    words = report.words["tables"]["faces"]
    ends = [ids.face_reaction(digits, number) for number in (1, 2)]
    for k in report.all_positions:
        tilting = tilts(report, digits, k)
        at_ends = [bare(report, id, k) for id in ends] if tilting else ["–", "–"]
        shown = [bare(report, name(digits), k) for name in (ids.normal_reaction, ids.normal_place)]
        yield str(k), *shown, words["tilts" if tilting else "within"], *at_ends


def ends_of(report: Report, link: int, k: int) -> tuple[complex, complex]:
    """Where the face of a slider begins and ends (m)."""
    faces, motion = report.machine.faces[link], report.analysis.motion
    along = complex(motion.slides[carriers(report.machine.linkage)[link], link].direction[k - 1])
    first, last = (x - 1j * faces.below for x in (faces.first, faces.last))
    pin = complex(motion.origins[link].p[k - 1])
    return pin + first * along, pin + last * along


def face(report: Report, link: int, k: int, scale: float) -> list[Item]:
    """The face of a slider with what holds it at its pin, in paper millimetres."""
    first, last = (place * scale for place in ends_of(report, link, k))
    pin = complex(report.analysis.motion.origins[link].p[k - 1]) * scale
    foot = complex(constructions.foot(pin, first, unit(last - first)))
    arm = [Line(pin, foot, style.THIN)] if abs(foot - pin) > LEAST_ARM else []
    return [Line(first, last, style.VISIBLE), *arm]


def at_ends(report: Report, digits: str, link: int, k: int) -> list[tuple[Symbol, complex, complex, str]]:
    """The reactions at both ends of a slider that tilts: vector, place (m), direction, id."""
    if link not in report.machine.faces or not tilts(report, digits, k):
        return []
    along = complex(report.analysis.motion.slides[carriers(report.machine.linkage)[link], link].direction[k - 1])
    found = []
    for number, place in enumerate(ends_of(report, link, k), 1):
        id = ids.face_reaction(digits, number)
        size = float(np.real(report.ledger[id].at(k)))
        shown = vocabulary.vector(report.ledger.symbol(id))
        found.append((shown, place, size * 1j * along, id))
    return found
