"""Instant centres on the ledger's drawing, for made linkages of every kind of group."""

from __future__ import annotations

import numpy as np
import pytest
from books import MACHINES, keep

from reportgen.derivation.equation_sides import scheme
from reportgen.derivation.kinematic_entries import links_in_plane_motion
from reportgen.formula import Chain, Number
from reportgen.machine import Crank, Dyad, Linkage, LinkPoint
from reportgen.marking.toleranced_key import key_of
from reportgen.report.context import ReportContext
from reportgen.report.template_equations import lines
from tests.report import built

SWINGING_BLOCK = Linkage(
    {"A": 0j, "H": 0.5 + 0.1j},
    Crank("A", "B", 0.1),
    (Dyad("RPR", (2, 3), "H", "H3", "B"),),
    (LinkPoint("E", 3, 0.2 + 0.1j),),
)
"""A slotted link hung on the crank pin, its block on a fixed pin."""
LINKAGES = {**MACHINES, "RPR on a fixed pin": SWINGING_BLOCK}
ANGLES = np.radians(np.arange(7.0, 367.0, 24.0))
EXACT = 1e-9


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("name", LINKAGES)
def test_centres_stand_still(name: str, turn: int) -> None:
    book = keep(LINKAGES[name], ANGLES[::turn], turn)
    for one in links_in_plane_motion(scheme(LINKAGES[name])):
        point, link = book.motion.points[one.base], book.motion.links[one.link]
        centre = book.b.value(f"ic.{one.link}")
        near = np.abs(centre - point.p) < 1e3
        left = (point.v + 1j * link.omega * (centre - point.p))[near]
        assert near.any()
        assert np.abs(left).max() < EXACT * np.abs(point.v).max()
        # What is not near turns by nothing.
        assert np.abs(link.omega[~near]).max(initial=0) < 1e-3 * np.abs(point.v).max()


def test_which_links_have_a_centre_that_moves() -> None:
    found = {name: [one.link for one in links_in_plane_motion(scheme(linkage))] for name, linkage in LINKAGES.items()}
    assert found == {
        "RRR": [2],
        "RRP": [2],
        "RPR": [],
        "RPR with offset": [],
        "RPR and PRP": [],
        "RPP": [],
        "RRR and RRP on its rocker": [2, 4],
        "RPR on a fixed pin": [3],
    }


def test_a_slot_on_a_fixed_pin_turns_about_the_corner_of_a_rectangle() -> None:
    """The centre lies on the crank's line, and on the normal of the slot through the pin."""
    book = keep(SWINGING_BLOCK, ANGLES)
    centre, pin = book.b.value("ic.3"), book.motion.points["B"].p
    slot = pin - (0.5 + 0.1j)
    assert np.imag(centre * np.conj(pin)) == pytest.approx(0, abs=EXACT * np.abs(centre * pin).max())
    across = np.real((centre - (0.5 + 0.1j)) * np.conj(slot))
    assert across == pytest.approx(0, abs=EXACT * np.abs(centre * slot).max())


def test_a_velocity_that_is_nothing_has_no_angle_with_the_link() -> None:
    """At its dead centres a slider stands still: the key has no angle there, and no line reckons with one."""
    case = built.case(built.ROOT / "assignments" / "slider-crank-01.yaml", "en")
    rows = {row.id: row for row in key_of(case).rows}
    angle, still = rows["ic.angle.2.C"].values, case.printed["v.C"].values == 0
    assert still.any()
    np.testing.assert_array_equal(np.isnan(angle), still)
    position = 1 + int(np.argmax(still))
    (line,) = lines(ReportContext(case), ["ic.along.2.C"], position).rows
    assert isinstance(line, Chain)
    assert line.parts == (case.printed.symbol("ic.along.2.C"), Number(0.0, None, "m/s"))
    assert line.note
