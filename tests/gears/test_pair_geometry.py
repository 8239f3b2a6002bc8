"""What is drawn, held to sampled curves and to the rack: where flanks touch, and fillets as the rack's envelope."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.gears.involute import Wheel
from reportgen.gears.pair_formulas import Rack
from reportgen.gears.pair_shifts import GearPair, PairLimits
from tests.lanes import matrix

FINE = 1e-9
"""Chords of the sampled profiles here (m): the gap found between two of them is as exact."""
GAP = 1e-6
RACKS = [
    Rack(math.radians(20)),
    Rack(math.radians(15)),
    Rack(math.radians(25), 0.9, 0.2),
    Rack(math.radians(20), 0.8, 0.3),
]
HUNDREDS = 10


def random_pairs(seed: int, count: int) -> list[GearPair]:
    """Pairs that can run: neither undercut nor pointed, without interference, with ε of at least 1.05."""
    rng = np.random.default_rng(seed)
    found: list[GearPair] = []
    while len(found) < count:
        z1 = int(rng.integers(8, 50))
        z2 = int(rng.integers(z1, 120))
        rack, m = RACKS[rng.integers(len(RACKS))], float(rng.uniform(1, 20)) * 1e-3
        pair = GearPair(rack, m, (z1, z2), rng.uniform(-0.5, 1.0, 2))
        if pair.keeps(PairLimits(epsilon=1.05, tip=0.05)):
            found.append(pair)
    return found


def gaps(pair: GearPair, turned: float) -> tuple[float, complex, complex]:
    """The least gap between the meshing flanks when wheel 1 is turned, where it is, and the normal there.

    Wheel 1 about 0, wheel 2 about a_w; with no turn a tooth of wheel 1 points at a space of wheel 2.
    """
    first, second = pair.wheel(0), pair.wheel(1)
    one = np.concatenate(first.side(FINE)) * np.exp(1j * turned)
    # The mate's flank that faces the left one of the tooth: of the tooth above the space, its own left one.
    tooth = np.concatenate(second.side(FINE))
    other = float(pair["a_w"]) + tooth * np.exp(1j * (math.pi - second.pitch / 2 - turned * first.z / second.z))
    r, θ = np.abs(one), np.unwrap(np.angle(one))
    within = (np.abs(other) >= r[0]) & (np.abs(other) <= r[-1])
    near = other[within]
    apart = np.abs(near) * (np.angle(near) - np.interp(np.abs(near), r, θ))
    k = int(apart.argmin())
    tangent = near[min(k + 1, near.size - 1)] - near[max(k - 1, 0)]
    return float(apart[k]), complex(near[k]), complex(1j * tangent / abs(tangent))


@pytest.mark.parametrize("seed", matrix(list(range(HUNDREDS)), [0]))
def test_flanks_touch_on_the_line_of_action(seed: int) -> None:
    for pair in random_pairs(seed, 100):
        r_b, r_w, α_w = pair["d_b"][0] / 2, pair["d_w"][0] / 2, float(pair["alpha_w"])
        first = pair.wheel(0)
        # With no turn the left flank crosses the base circle at this angle.
        base = float(first.half_angle(np.array(first.r_b)))
        for share in np.linspace(0.001, 0.999, 9):
            ρ = float(pair["rho_p"][0] + share * (pair["rho_a"][0] - pair["rho_p"][0]))
            # Rolled ρ from the base circle, the flank has the line of action for its normal.
            gap, at, normal = gaps(pair, ρ / r_b - α_w - base)
            assert abs(gap) < GAP
            along = np.exp(1j * (math.pi / 2 - α_w))
            line = abs(((at - r_w) * along.conjugate()).imag)
            assert line < 0.02 * pair.m
            assert abs(abs((normal * along.conjugate()).real) - 1) < 1e-3


def inside(rack: Rack, m: float, at: np.ndarray) -> np.ndarray:
    """How far points lie outside a rack's tooth that points down from its datum line; below 0 inside."""
    ρ = m * rack.rounding
    centre = m * rack.land - 1j * (m * (rack.ha + rack.c) - ρ)
    up = np.exp(1j * (math.pi / 2 - rack.alpha)) * 6 * m
    folded = np.abs(at.real) + 1j * at.imag

    def to(start: complex, way: complex) -> np.ndarray:
        share = np.clip(((folded - start) * np.conj(way)).real / abs(way) ** 2, 0, 1)
        return np.asarray(np.abs(folded - start - share * way))

    edge = np.minimum(to(centre, up), to(centre.conjugate().imag * -1j, centre.real + 0j) if centre.real else np.inf)
    # Beyond both edges a point is in the body of the tooth.
    height = folded.imag - centre.imag
    body = (height > 0) & (folded.real < centre.real + height * math.tan(rack.alpha))
    return np.asarray(np.where(body, -edge, edge) - ρ)


@pytest.mark.parametrize(
    ("z", "x"), [(8, 0.0), (10, 0.1), (12, 0.5), (13, 0.3), (17, 0.0), (20, 0.9), (30, -0.3), (60, 0.0), (12, 1.0)]
)
@pytest.mark.parametrize("rack", RACKS[:3], ids=["20°", "15°", "25°"])
def test_the_tooth_is_what_the_rack_leaves(rack: Rack, z: int, x: float) -> None:
    """Rolled off, the rack touches every point of the profile and cuts none, undercut teeth as well."""
    m = 0.005
    wheel = Wheel(rack, m, z, x, m * (z / 2 + x + 0.8 * rack.ha))
    fillet, flank = wheel.side()
    points = np.concatenate((fillet[::8], fillet[-1:], flank[::8]))
    points = points * np.exp(1j * (math.pi / 2 - wheel.pitch / 2))
    rolled = np.linspace(-5 * m, 5 * m, 4001)

    def apart(at: np.ndarray) -> np.ndarray:
        turned = points[:, None] * np.exp(-1j * at / wheel.r) - 1j * wheel.r
        return inside(rack, m, turned - at - 1j * x * m)

    found = apart(np.broadcast_to(rolled, (points.size, rolled.size)))
    nearest = rolled[found.argmin(axis=1)]
    # Once more, a thousand times as fine, around the nearest.
    least = apart(nearest[:, None] + np.linspace(-1, 1, 2001) * (rolled[1] - rolled[0])).min(axis=1)
    assert least.max() < GAP
    assert least.min() > -GAP
    assert wheel.undercut == (x < rack.ha - z * math.sin(rack.alpha) ** 2 / 2)


@pytest.mark.parametrize(("z", "x", "m"), [(8, 0.0, 5), (13, 0.4, 12), (60, 0.0, 3)])
def test_a_polyline_is_as_near_as_it_says(z: int, x: float, m: float) -> None:
    wheel = Wheel(RACKS[0], m * 1e-3, z, x, m * 1e-3 * (z / 2 + x + 1))
    coarse, fine = (np.concatenate(wheel.side(chord)) for chord in (1e-6, 1e-10))
    chords = coarse[1:] - coarse[:-1]
    share = ((fine[:, None] - coarse[:-1]) * chords.conjugate()).real / np.maximum(np.abs(chords), 1e-12) ** 2
    off = np.abs(fine[:, None] - coarse[:-1] - np.clip(share, 0, 1) * chords).min(axis=1)
    assert off.max() < 1.05e-6
    tooth = wheel.tooth()
    assert np.abs(tooth).max() == pytest.approx(wheel.r_a)
    assert np.abs(tooth).min() == pytest.approx(wheel.r_f)
