"""Small mechanisms with friction against balances of forces that are solved as two equations with two unknowns."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from reportgen.friction import exercise_calculations as calculations
from reportgen.friction.friction_file import Parameters

CALCULATIONS = {
    "incline": calculations.incline_calculation,
    "wedge": calculations.wedge_calculation,
    "screw": calculations.screw_calculation,
    "belt": calculations.belt_calculation,
    "band": calculations.band_calculation,
    "shoe": calculations.shoe_calculation,
}
EXACT = 1e-9


def worked(task: str, data: Mapping[str, Any]) -> dict[str, float]:
    """All values (SI) of a task by the ends of their ids."""
    given = getattr(Parameters.model_validate({task: data}), task)
    families = CALCULATIONS[task](given).families
    return {id.removeprefix(f"friction.{task}."): float(family.values[0]) for id, family in families.items()}


def balance(first: complex, second: complex, load: complex) -> tuple[float, float]:
    """The sizes of two forces along given directions that carry a load: x first + y second + load = 0."""
    matrix = [[first.real, second.real], [first.imag, second.imag]]
    x, y = np.linalg.solve(matrix, [-load.real, -load.imag])
    return float(x), float(y)


def close(value: float, wanted: float, size: float = 0.0) -> bool:
    """Equal but for floats; `size` is what a difference is small against."""
    return value == pytest.approx(wanted, rel=EXACT, abs=EXACT * size)


@pytest.mark.parametrize("seed", range(20))
def test_an_inclined_plane_is_in_balance(seed: int) -> None:
    """Q, P, N along the normal and f N along the plane, in both senses of the motion; η as the ratio of powers."""
    draw = random.Random(seed)
    α, f, Q = draw.uniform(2, 50), draw.uniform(0.02, 0.5), draw.uniform(10, 5000)
    β = draw.choice([0.0, -α, draw.uniform(-20, 20)])
    data = {"Q": f"{Q!r} N", "alpha": f"{α!r} deg", "f": f"{f!r}"}
    q = worked("incline", data | ({"beta": "horizontal"} if β == -α else {"beta": f"{β!r} deg"}))
    up = np.exp(1j * math.radians(α))
    pull = up * np.exp(1j * math.radians(β))
    for end, sense in (("", 1), ("lowering.", -1)):
        P, N = balance(pull, 1j * up - sense * f * up, -1j * Q)
        assert close(q[f"{end}P"], P, Q)
        assert close(q[f"{end}N"], N)
        assert close(q[f"{end}F"], f * N)
        assert N > 0
    # A unit of way along the plane: what raises the load over what the force puts in.
    assert close(q["eta"], Q * up.imag / (q["P"] * (pull * up.conjugate()).real))


@pytest.mark.parametrize("seed", range(20))
def test_a_wedge_and_its_load_are_in_balance(seed: int) -> None:
    """Load and wedge each by two equations, driven and going back, whichever side of the guide the load leans on."""
    draw = random.Random(seed)
    α, Q = draw.uniform(1, 30), draw.uniform(100, 9000)
    f1, f2, f3 = (draw.uniform(0.03, 0.4) for _ in range(3))
    f3 = draw.choice([0.0, f3])
    data = {"Q": f"{Q!r} N", "alpha": f"{α!r} deg", "f1": f"{f1!r}", "f2": f"{f2!r}", "f3": f"{f3!r}"}
    q = worked("wedge", data)
    normal = np.exp(1j * (math.pi / 2 - math.radians(α)))
    for end, sense in (("", 1), ("lowering.", -1)):
        # Friction on the load goes along the face with the wedge; that of the guide is against the load.
        on_load = normal - sense * f1 * 1j * normal
        leaning = 1 if on_load.real > 0 else -1
        R1, N3 = balance(on_load, -leaning - sense * f3 * 1j, -1j * Q)
        assert R1 > 0
        assert N3 >= 0
        P, N2 = balance(1 + 0j, 1j - sense * f2, -R1 * on_load)
        assert N2 > 0
        assert close(q[f"{end}P"], P, Q)
        assert close(q[f"{end}R1"], R1 * abs(on_load))
        assert close(q[f"{end}R2"], N2 * math.hypot(1, f2))
        assert close(q[f"{end}R3"], N3 * math.hypot(1, f3), Q)
    # While the wedge goes on by 1, the load rises by tan α.
    assert close(q["eta"], Q * math.tan(math.radians(α)) / q["P"])


@pytest.mark.parametrize("seed", range(12))
def test_a_screw_in_balance_turns_and_lifts(seed: int) -> None:
    """The unrolled thread by two equations, the normal force enlarged by the profile; η by the work of one turn."""
    draw = random.Random(seed)
    d, p, n = draw.uniform(10, 80), draw.uniform(1, 12), draw.randint(1, 4)
    f, profile, Q = draw.uniform(0.03, 0.3), draw.choice([0.0, 15.0, 30.0]), draw.uniform(100, 50000)
    collar = draw.choice([None, (draw.uniform(0.03, 0.3), draw.uniform(20, 100))])
    data: dict[str, Any] = {"Q": f"{Q!r} N", "d": f"{d!r} mm", "p": f"{p!r} mm", "n": f"{n}", "f": f"{f!r}"}
    data["beta"] = f"{profile!r} deg"
    if collar is not None:
        data["collar"] = {"f": f"{collar[0]!r}", "d": f"{collar[1]!r} mm"}
    q = worked("screw", data)
    on_collar = 0.0 if collar is None else collar[0] * Q * collar[1] / 2e3
    up = complex(math.pi * d, n * p)
    up /= abs(up)
    for end, sense in (("", 1), ("lowering.", -1)):
        # The faces press each other with more than what they carry along the axis of the profile's cut.
        rough = f / math.cos(math.radians(profile))
        force, _ = balance(1 + 0j, 1j * up - sense * rough * up, -1j * Q)
        assert close(q[f"{end}M"], sense * force * d / 2e3 + on_collar, Q * d / 1e3)
    assert close(q["eta"], Q * n * p / 1e3 / (2 * math.pi * q["M"]))


@pytest.mark.parametrize("known", ["S1", "S2", "M"])
@pytest.mark.parametrize("θ", [150.0, 210.0, 720.0])
def test_a_belt_element_by_element(known: str, θ: float) -> None:
    """dS = f S dθ integrated by small steps; forces on the axle as the sum of all pressure and friction."""
    f, r = 0.25, 0.15
    q = worked("belt", {"d": "300 mm", "theta": f"{θ} deg", "f": f"{f}", known: "90 N m" if known == "M" else "500 N"})
    steps = 20000
    dθ = math.radians(θ) / steps
    S, force, moment = q["S2"], 0j, 0.0
    for k in range(steps):
        middle = S * (1 + f * dθ / 2 + (f * dθ) ** 2 / 8)
        at = np.exp(1j * dθ * (k + 0.5))
        force += middle * dθ * (-at + f * 1j * at)
        moment += f * middle * dθ * r
        S *= math.exp(f * dθ)
    # Midpoints err by dθ²/24.
    assert pytest.approx(q["S1"], rel=1e-9) == S
    assert abs(force) == pytest.approx(q["R"], rel=1e-5, abs=1e-5 * q["S1"])
    assert moment == pytest.approx(q["M"], rel=1e-6)


def test_brakes_balance_about_their_pivots() -> None:
    """Moments of all forces on the lever, as forces at places; both senses of rotation."""
    band = {"M": "120 N m", "d": "320 mm", "theta": "230 deg", "f": "0.3", "l": "500 mm", "a": "-25 mm", "b": "100 mm"}
    q = worked("band", band)
    assert close((q["S1"] - q["S2"]) * 0.16, 120)
    assert close(math.log(q["S1"] / q["S2"]), 0.3 * math.radians(230))
    for P, at_a, at_b in (("P", "S1", "S2"), ("backward.P", "S2", "S1")):
        assert close(q[at_a] * -0.025 + q[at_b] * 0.1, q[P] * 0.5)
    shoe = {"M": "90 N m", "d": "240 mm", "f": "0.35", "l": "600 mm", "a": "220 mm", "c": "60 mm"}
    q = worked("shoe", shoe)
    pivot, under_shoe, end = 0j, complex(0.22, -0.06), complex(0.6, 0)
    for P, friction in (("P", -1), ("backward.P", 1)):
        on_shoe = complex(friction * q["F"], q["N"])
        moments = ((under_shoe - pivot).conjugate() * on_shoe).imag + ((end - pivot).conjugate() * -1j * q[P]).imag
        assert moments == pytest.approx(0, abs=EXACT * q["N"])
    assert close(q["F"], 0.35 * q["N"])
    assert close(q["F"] * 0.12, 90)


@pytest.mark.parametrize(("c", "locks"), [(628.0, False), (629.0, True)])
def test_a_shoe_brake_locks_where_its_pivot_is_high(c: float, locks: bool) -> None:
    """a = f c, which is 220 mm/0.35 = 628.57 mm."""
    shoe = {"M": "90 N m", "d": "240 mm", "f": "0.35", "l": "600 mm", "a": "220 mm", "c": f"{c} mm"}
    assert (worked("shoe", shoe)["P"] < 0) is locks


def test_efficiency_below_a_half_locks() -> None:
    """A plane with a force along its base: η ≤ 1/2 where α ≤ φ, nearly; at α = φ exactly nothing holds the body."""
    φ = math.degrees(math.atan(0.2))
    q = worked("incline", {"Q": "1000 N", "alpha": f"{φ!r} deg", "f": "0.2", "beta": "horizontal"})
    assert q["lowering.P"] == pytest.approx(0, abs=1e-9)
    # tan φ / tan 2φ = (1 − tan² φ)/2
    assert q["eta"] == pytest.approx((1 - 0.2**2) / 2, rel=EXACT)
