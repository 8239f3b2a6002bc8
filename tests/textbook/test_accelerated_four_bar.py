"""A four-bar whose crank has ω₁ and ε₁, in a horizontal plane: figures of a second computation, to the printed digits.

AB 120, BC 350, CD 300, AD 400 mm, φ₁ 50°, ω₁ 12 rad/s, ε₁ 60 rad/s²; masses 3, 5, 4 kg as uniform bars; 200 N·m on
link 3 against its motion.
"""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import numpy as np
import pytest

import reportgen
from reportgen.cases import MachineCase, open_case
from reportgen.marking.toleranced_key import Ask, key_of

FILE = Path(__file__).parents[2] / "assignments" / "four-bar-03.yaml"
LAST_DIGIT = 0.5e-6
"""Half a unit of the sixth decimal; angles are given with five or six."""


@pytest.fixture(scope="module")
def case() -> MachineCase:
    opened = open_case(FILE)
    assert isinstance(opened, MachineCase)
    return opened


def test_motion(case: MachineCase) -> None:
    motion = case.analysis.motion
    C = complex(motion.points["C"].p[0]) * 1e3
    assert (C.real, C.imag) == pytest.approx((360.482304, 297.385863), abs=LAST_DIGIT)
    angles = [math.degrees(motion.links[link].angle[0]) for link in (2, 3)]
    assert angles == pytest.approx([35.946536, 97.569323], abs=LAST_DIGIT)
    rates = [float(getattr(motion.links[link], rate)[0]) for rate in ("omega", "epsilon") for link in (2, 3)]
    assert rates == pytest.approx([-3.451467, 1.324756, 25.328118, 84.979112], abs=LAST_DIGIT)
    accelerations = [abs(motion.points[point].a[0]) for point in "BC"]
    assert accelerations == pytest.approx([18.72, 25.499169], abs=LAST_DIGIT)


def test_reactions_and_torque(case: MachineCase) -> None:
    """M_cb holds the crank's own inertia, J₁ε₁ too."""
    analysis = case.analysis
    wanted = {
        "R12": (911.188772, -144.95637),
        "R32": (808.388838, 37.48799),
        "R03": (764.064545, 39.32689),
        "R01": (939.025437, -145.18485),
    }
    for name, (size, angle) in wanted.items():
        force = complex(analysis.forces.reactions[name].force[0])
        assert abs(force) == pytest.approx(size, abs=LAST_DIGIT), name
        assert math.degrees(cmath.phase(force)) == pytest.approx(angle, abs=10 * LAST_DIGIT), name
    assert analysis.torque[0] == pytest.approx(29.083520, abs=LAST_DIGIT)
    assert analysis.torque_by_work[0] == pytest.approx(analysis.torque[0], rel=1e-9)


def test_the_plan_gives_what_the_motion_is(case: MachineCase) -> None:
    """aⁿ and aᵗ of the crank pin; the plan's ε, the closed formulas and both torques are those of the analysis."""
    values = {id: family.values for id, family in case.ledger.families.items()}
    assert values["a.B.n"][0] == pytest.approx(12**2 * 0.12)
    assert values["a.B.t"][0] == pytest.approx(60 * 0.12)
    for link in (1, 2, 3):
        epsilon = case.analysis.motion.links[link].epsilon[0]
        assert values[f"turn.eps.{link}"][0] == pytest.approx(epsilon)
    assert values["f.eps.3"][0] == pytest.approx(values["turn.eps.3"][0])
    assert [values["M.eq"][0], values["M.vw"][0]] == pytest.approx([case.analysis.torque[0]] * 2)


def test_nothing_is_said_of_a_cycle(case: MachineCase) -> None:
    """No mean, no power, no weights; the key asks at the one instant, and for the components of a_B."""
    assert not {"M.mean", "power", "W", "M.energy", "G2"} & {*case.ledger.families}
    assert case.span.labels == ("I",)
    key = Ask().of(key_of(case))
    rows = {id for id in ("a.B.n", "a.B.t", "eps.2", "M.eq") if key.find(id)}
    assert rows == {"a.B.n", "a.B.t", "eps.2", "M.eq"}


TEXT = """
kind: slider-crank
parameters: {r: 100 mm, l: 400 mm, omega1: 12 rad/s, epsilon1: -30 rad/s2, m3: 4 kg, s1: 0%s}
"""


def test_a_crank_on_its_axis_needs_the_torque_of_its_inertia() -> None:
    """M_cb grows by J₁ε₁ at every position, by both methods, with S₁ on the axis: ε₁ against a rotation to the left."""
    light, heavy = (MachineCase(reportgen.open(TEXT % more).assignment) for more in ("", ", J1: 0.3 kg m2"))
    for method in ("M.eq", "M.vw"):
        more = heavy.ledger.families[method].values - light.ledger.families[method].values
        assert more == pytest.approx(np.full(8, 0.3 * -30.0))
    assert heavy.analysis.torque - light.analysis.torque == pytest.approx(np.full(8, 0.3 * -30.0))
