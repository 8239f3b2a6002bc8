"""The same result on every machine: nothing that is written depends on the last bits of floating-point results.

Two processes make the same files, one with the instructions of numpy and OpenBLAS that this processor has, the other
without them: their results differ in the last bits only.
"""

from __future__ import annotations

import itertools
import json
import math
import os
import platform
import subprocess
import sys

import numpy as np
import pytest
from numpy._core import _multiarray_umath

from reportgen.base.stable_digits import first_greatest, first_least, settled, significant
from reportgen.cam.profile import greatest
from reportgen.drawing.drawing_description import direction
from reportgen.drawing.style import decimal
from reportgen.formula.evaluation import FUNCTIONS
from tests.lanes import proof
from tests.report import built

FILES = ("engine-twin-05.yaml", "slider-crank-03.yaml", "cam/roller-01.yaml", "linkage-8.yaml")
"""The report of the first had “< 10⁻¹⁶” on one processor and 0 on another."""
CORES = {"x86_64": "Nehalem", "AMD64": "Nehalem", "aarch64": "ARMV8", "arm64": "ARMV8"}
"""The least kernels of OpenBLAS."""


def _reduced() -> dict[str, str]:
    """Settings that keep numpy and OpenBLAS from all instructions that not every processor has."""
    features = _multiarray_umath.__cpu_features__
    own = [name for name in _multiarray_umath.__cpu_dispatch__ if features[name]]
    core = CORES.get(platform.machine())
    return {"NPY_DISABLE_CPU_FEATURES": " ".join(own)} | ({"OPENBLAS_CORETYPE": core} if core else {})


@proof
@pytest.mark.parametrize("name", FILES)
def test_another_processor_gives_the_same(name: str) -> None:
    path = built.ROOT / "assignments" / name
    command = [sys.executable, "-m", "tests.report.outputs_of", str(path)]
    running = [
        subprocess.Popen(command, cwd=built.ROOT, env=os.environ | how, stdout=subprocess.PIPE, text=True)
        for how in ({}, _reduced())
    ]
    texts = [process.communicate()[0] for process in running]
    assert [process.returncode for process in running] == [0, 0]
    own, reduced = map(json.loads, texts)
    assert own.keys() == reduced.keys()
    for what in own:
        pairs = itertools.zip_longest(own[what].splitlines(), reduced[what].splitlines())
        assert [(a, b) for a, b in pairs if a != b][:5] == [], what


# --- the rules, on numbers that differ in their last bits -------------------------------------------


def test_a_tie_is_rounded_the_same_way() -> None:
    """7.7375 mm is no sum of powers of two: its neighbours are rounded as it is, away from zero."""
    tie = 7.7375
    assert {decimal(value) for value in (np.nextafter(tie, 0), tie, np.nextafter(tie, 9))} == {"7.738"}
    assert {significant(value, 4) for value in (np.nextafter(0.12345, 0), np.nextafter(0.12345, 1))} == {0.1235}
    assert significant(-0.0, 3) == 0
    assert math.copysign(1, significant(-0.0, 3)) == 1


def test_of_equal_values_the_first_is_chosen() -> None:
    values = np.array([1.0, 3.0, 2.0, np.nextafter(3.0, 4)])
    assert (first_greatest(values), first_least(-values)) == (1, 1)
    assert first_greatest(np.array([np.nan, 1.0])) == 1


def test_settled_numbers_have_no_last_bits() -> None:
    exact = np.array([0.1 + 0.2, -1e-17, 2.5]) + 1j * np.array([0.0, 1 / 3, -0.0])
    noisy = exact * (1 + 2e-16)
    assert settled(exact).tobytes() == settled(noisy).tobytes()
    assert abs(settled(exact) - exact).max() < 1e-6
    assert not np.signbit(settled(np.array([-1e-17]))).any()


def test_the_direction_of_nothing_is_not_noise() -> None:
    """Beside a vector of length 1, one of 1e-17 has no direction, no sign and no arm."""
    vectors, noise = np.array([1j, 1e-17 - 1e-17j]), np.array([2.0, -3e-17])
    assert FUNCTIONS["arg"](vectors).tolist() == FUNCTIONS["heading"](vectors).tolist() == [math.pi / 2, 0.0]
    assert FUNCTIONS["sign"](noise).tolist() == [1.0, 0.0]
    assert FUNCTIONS["quotient"](np.array([1.0, 1e-17]), noise).tolist() == [0.5, 0.0]


def test_a_direction_behind_the_axis_has_one_side() -> None:
    assert direction(complex(-1, 1e-17)) == direction(complex(-1, -1e-17))
    assert direction(complex(1, -1e-17)).value == 0
    assert FUNCTIONS["arg"](np.array([complex(-1, -1e-17)])) == pytest.approx(math.pi)


def test_the_place_of_a_flat_top_is_found_beyond_rounding() -> None:
    """sin 2x is greatest at π/4; comparing its values alone finds that to 1e-8."""
    places = [greatest(lambda x, off=off: np.sin(2 * x) * off, 0.0, 1.1)[0] for off in (1.0, 1 + 3e-16, 1 - 2e-16)]
    assert places == pytest.approx([math.pi / 4] * 3, abs=1e-9)
    assert max(places) - min(places) < 1e-12
