"""Planetary trains of textbooks; all of them against brute force; assembly by putting the satellites in."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache

import numpy as np
import pytest

from reportgen.gears.tooth_numbers import SCHEMES, Demand, Teeth, Train, choice, mended, power_way, turned, unshifted
from tests.lanes import matrix


def demand(scheme: str, ratio: float, k: int = 3, tolerance: float = 0.0, least: int = 17, most: int = 120) -> Demand:
    return Demand(scheme, ratio, tolerance, k, least, most)


def test_P1() -> None:
    """u = 7: 18/45/108, three satellites as sin(π/3) > 47/63, which k ≤ 3.7 fulfils; (18 + 108)/3 = 42."""
    train = choice(demand("single", 7)).chosen
    assert train.teeth == Teeth(18, 45, 45, 108)
    assert train.ratio == 7
    assert train.turns(3) == 0
    assert train.satellites == (2, 3)
    assert math.pi / math.asin(47 / 63) == pytest.approx(3.7, abs=0.05)


@pytest.mark.parametrize(
    ("ratio", "wheels"), [(5, [(18, 27, 72)]), (6, [(17, 34, 85), (18, 36, 90)]), (4.5, [(20, 25, 70)])]
)
def test_P2(ratio: float, wheels: list[tuple[int, ...]]) -> None:
    found = choice(demand("single", ratio)).sets[:, [0, 1, 3]].tolist()
    assert [tuple(one) for one in found[: len(wheels)]] == wheels


def test_P3() -> None:
    train = Train("double", Teeth(40, 40, 20, 100))
    assert train.ratio == 6
    assert 3 in train.satellites
    assert [*train.teeth] in choice(demand("double", 6)).sets.tolist()


# --- brute force ------------------------------------------------------------------------------------------

RATIOS = {
    "single": [*np.arange(2.2, 5.2, 0.1).round(2), 4.04, 3.2, 3.6, 4.25, 4.125, 3.75, 4.4, 4.75, 5.25, 5.5],
    "double": [*np.arange(3.0, 10.5, 0.25), 3.1, 4.2, 5.4, 6.6, 7.2, 8.4, 9.6, 10.5, 11.25, 12.5],
    "double-outer": [*np.arange(-7.5, -0.5, 0.25), 0.25, 0.5, 0.75, 0.2, 0.4, 0.6, 0.8, -0.5, -0.25, 1.5, -0.75, 0.1],
}
CASES = [(scheme, number) for scheme in RATIOS for number in range(40)]
TELLING = [("single", 18), ("single", 28), ("double", 12), ("double", 20), ("double-outer", 2), ("double-outer", 34)]
MOST = 60


@lru_cache(maxsize=1)
def every(scheme: str) -> list[tuple[int, int, int, int, Fraction]]:
    """All coaxial numbers of teeth up to 60 that mesh without interference, by the sentences of the textbook."""
    return [(*z, ratio(scheme, z)) for z in _every(scheme)]


def ratio(scheme: str, z: tuple[int, int, int, int]) -> Fraction:
    part = Fraction(z[1] * z[3], z[0] * z[2])
    return 1 - part if scheme == "double-outer" else 1 + part


def _every(scheme: str) -> Iterator[tuple[int, int, int, int]]:
    numbers = np.arange(1, MOST + 1)
    for z1 in range(1, MOST + 1):
        z2, other, z3 = (one.ravel() for one in np.meshgrid(numbers, numbers, numbers, indexing="ij"))
        inner = scheme != "double-outer"
        good = (z1 + z2 == z3 - other) if inner else (z1 + z2 == other + z3)
        good &= (z1 >= 17) & (z2 >= 17) & (other >= 17) & ((z3 - other >= 8) if inner else (z3 >= 17))
        if scheme == "single":
            good &= z2 == other
        for row in np.flatnonzero(good):
            yield z1, int(z2[row]), int(other[row]), int(z3[row])


def fits(scheme: str, z: tuple[int, int, int, int], u: Fraction, k: int) -> bool:
    """sin(π/k) > (z₂ + 2)/(z₁ + z₂); u₁H z₁ (1 + kP)/k is whole for a P; of a single satellite (z₁ + z₃)/k."""
    if not math.sin(math.pi / k) > (max(z[1], z[2]) + 2) / (z[0] + z[1]):
        return False
    if scheme == "single":
        return (z[0] + z[3]) % k == 0
    return any((u * z[0] * (1 + k * P) / k).denominator == 1 for P in range(k * z[2]))


@pytest.mark.parametrize(("scheme", "number"), matrix(CASES, TELLING))
def test_all_and_no_others_are_found(scheme: str, number: int) -> None:
    wanted, k = Fraction(str(RATIOS[scheme][number])), (2, 3, 4)[number % 3]
    tolerance = (Fraction(0), Fraction(1, 10))[number % 2]
    expected = {
        tuple(z)
        for *z, u in every(scheme)
        if abs(u - wanted) <= tolerance * abs(wanted) and fits(scheme, tuple(z), u, k)  # type: ignore[arg-type]
    }
    found = choice(demand(scheme, float(wanted), k, float(tolerance), 1, MOST)).sets
    assert len(found) == len(expected)
    assert set(map(tuple, found.tolist())) == expected


def test_the_ratios_find_something() -> None:
    """The comparison above is not of empty sets."""
    found = [len(choice(demand(scheme, u, 3, 0.1, 1, MOST)).sets) for scheme, u in (("single", 4), ("double", 6))]
    assert min(found) > 2


@pytest.mark.parametrize("scheme", matrix(sorted(RATIOS), ["single"]))
def test_the_tolerance_is_one_of_the_ratio_that_is_asked_for(scheme: str) -> None:
    """A carrier drives with u_H1 = 1/u₁H: a train that misses u₁H by 10 % misses u_H1 by 9.1 or by 11.1 %."""
    tenth, differ = Fraction(1, 10), 0
    for number, u1H in enumerate(map(Fraction, map(str, RATIOS[scheme][:12]))):
        wanted, k = 1 / u1H, (2, 3, 4)[number % 3]
        near = [(tuple(z), u) for *z, u in every(scheme) if u and abs(u - u1H) <= abs(u1H) / 5]
        trains = [(z, u) for z, u in near if fits(scheme, z, u, k)]  # type: ignore[arg-type]
        expected = {z for z, u in trains if abs(1 / u - wanted) <= tenth * abs(wanted)}
        differ += expected != {z for z, u in trains if abs(u - u1H) <= tenth * abs(u1H)}
        demand = Demand(scheme, float(1 / wanted), 0.1, k, 1, MOST, by_carrier=True)
        assert set(map(tuple, choice(demand).sets.tolist())) == expected
    assert differ


# --- rules of the field by a second way -------------------------------------------------------------------


def some_trains() -> Iterator[tuple[Train, int]]:
    seed = np.random.default_rng(36)
    for name, scheme in SCHEMES.items():
        for _ in range(60):
            one, two, other, three = map(int, seed.integers(12, 60, 4))
            teeth = Teeth(one, two, two, one + 2 * two) if scheme.single else Teeth(one, two, other, three)
            yield Train(name, teeth), int(seed.integers(2, 6))


def test_assembly_puts_satellites_in() -> None:
    """Where the rule says yes, each satellite fits both wheels tooth in gap; the first always does."""
    said, placed = 0, 0
    for train, k in some_trains():
        _, angles = turned(train, k)
        assert angles[0] is not None
        stands = all(angle is not None for angle in angles)
        # Each satellite put in by itself: (z₁z₂′ ± z₂z₃)/k is a multiple of the common divisor of z₂ and z₂′.
        z = train.teeth
        whole = z.z1 * z.z2_prime + SCHEMES[train.scheme].sign * z.z2 * z.z3
        assert stands == (whole % (k * math.gcd(z.z2, z.z2_prime)) == 0)
        if train.turns(k) is not None:
            assert stands
            said += 1
        placed += stands
    assert 20 < said <= placed


def test_eight_teeth_more_leave_tips_apart() -> None:
    """The usual eight teeth of difference: exactly from 85 teeth of the satellite on, one more from 28 on."""
    satellites = np.arange(18, 151)
    least = {}
    for difference in range(5, 20):
        z = np.array([satellites, satellites, satellites, satellites + difference])
        for satellite, free in zip(satellites, unshifted(SCHEMES["single"], z), strict=True):
            if free:
                least.setdefault(int(satellite), difference)
    assert {least[one] for one in range(85, 151)} == {8}
    assert {least[one] for one in range(28, 65)} == {9}
    assert 18 not in least


@pytest.mark.parametrize("carrier", [False, True])
@pytest.mark.parametrize(
    ("scheme", "teeth"),
    [
        ("single", (18, 45, 45, 108)),
        ("double-outer", (24, 48, 18, 54)),
        ("double-outer", (50, 49, 50, 51)),
        ("double-inner", (56, 26, 27, 57)),
    ],
)
def test_power_is_lost_and_never_won(scheme: str, teeth: tuple[int, ...], carrier: bool) -> None:
    """M₁ + M₃ + M_H = 0; M₃ is less than −u₀M₁ by what the meshes lose, as power flows: what comes out is less."""
    u, η0 = float(Train(scheme, Teeth(*teeth)).ratio), 0.95
    u0, way = 1 - u, power_way(u, carrier)
    M1 = -1.0 if carrier else 1.0
    ω1, ωH = u, 1.0
    M1 = math.copysign(M1, M1 * ω1) if (M1 * ω1 > 0) == (not carrier) else -M1
    M3 = -M1 * u0 * η0**way
    MH = -M1 - M3
    lost = M1 * (ω1 - ωH) + M3 * (0 - ωH)
    assert lost == pytest.approx(M1 * ω1 + MH * ωH)
    assert lost > 0
    # The power of wheel 1 seen from the carrier flows the way that was assumed.
    assert (M1 * (ω1 - ωH) > 0) == (way > 0)


def test_what_would_mend_it() -> None:
    """u = 7 with four satellites: they touch; three and two have room."""
    assert not len(choice(demand("single", 7, 4)).sets)
    assert mended(demand("single", 7, 4)) == (2, 3)
