"""Topics on machines with a group of class III: what their rules for rods, engines and swinging links make of it."""

from __future__ import annotations

import numpy as np
import pytest
from made_triads import R1

from reportgen.balancing.counterweights import crank_rods, four_bar, place_on_link
from reportgen.balancing.orders import engine, on_sliders
from reportgen.base.records import replace
from reportgen.machine import Dyad, Guide
from reportgen.machine.kinematics import solve_motion


def test_it_is_neither_an_engine_nor_a_four_bar() -> None:
    """A slider on the crank beside the triad would make an engine of one cylinder, if the triad were not counted."""
    beside = Dyad("RRP", (6, 7), "A", "G", Guide(0j, -np.pi / 2), (0.3, 0.0))
    linkage = replace(R1, groups=(*R1.groups, beside))
    assert crank_rods(replace(linkage, groups=(beside,), points=(), inertias=()))
    assert crank_rods(linkage) == ()
    assert engine(linkage) is None
    assert not on_sliders(linkage)
    assert not on_sliders(R1)
    rocker = Dyad("RRR", (6, 7), "A", "G", "B", (0.3, 0.25))
    assert four_bar(replace(R1, groups=(rocker,), points=(), inertias=()))
    assert four_bar(replace(R1, groups=(*R1.groups, rocker))) is None


@pytest.mark.parametrize(("link", "names"), [(2, "AD"), (3, "DEF"), (4, "BE"), (5, "CF")])
def test_places_on_links(link: int, names: str) -> None:
    motion = solve_motion(R1, [0.3], 1.0)
    origin, angle = motion.origins[link].p, motion.links[link].angle
    for name in names:
        local = (motion.points[name].p - origin) * np.exp(-1j * angle)
        assert abs(place_on_link(R1, link, name) - local[0]) < 1e-12
