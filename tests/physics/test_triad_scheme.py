"""The scheme of a group of class III, and its numbers as the form pulls them."""

from __future__ import annotations

import numpy as np
from made_triads import DEGREE, R1

from reportgen.base.records import replace
from reportgen.drawing.scheme import Looks, groups, skeleton
from reportgen.machine.kinematics import solve_motion
from reportgen.page.linkage_numbers import numbers, placed, rebuilt


def test_the_plate_has_three_joints_and_each_leg_two() -> None:
    motion = solve_motion(R1, [60 * DEGREE], 20.0)
    bones = skeleton(R1, motion, 0, 1e3)
    assert {link: set(bones.bars[link]) for link in (2, 3, 4, 5)} == {
        2: {"A", "D"},
        3: {"D", "E", "F"},
        4: {"B", "E"},
        5: {"C", "F"},
    }
    assert set(bones.pivots) == {"O", "B", "C"}
    assert len(groups(R1, motion, 0, 1e3, Looks())) == 2


def test_numbers_make_the_linkage_again() -> None:
    given = numbers(R1)
    assert len(given) == len(placed(R1))
    assert rebuilt(R1, given) == R1
    leg = placed(R1).index("E")
    longer = replace(R1.triads[0].legs[1], length=0.2)
    given[leg] = 0.2
    assert rebuilt(R1, np.asarray(given)).triads[0].legs[1] == longer
