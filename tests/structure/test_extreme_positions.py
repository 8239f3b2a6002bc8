"""Crank-rockers and slider-cranks from K and swing or stroke: known lengths, and random ones analysed as machines."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from reportgen.base.arrays import Flags, Floats
from reportgen.catalogue.extreme_positions import (
    BEFORE,
    BEYOND,
    CrankRocker,
    ExtremePositions,
    PivotPlace,
    SliderCrank,
    crank_angle_between,
)
from reportgen.catalogue.four_bar import proportions
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Guide, Linkage
from reportgen.machine.kinematics import solve_motion

RANDOM = 1000
"""Random syntheses of each of both mechanisms."""
ALONG = 0.05
"""A line to C that is nearer to AD (rad) is left out: the arc cosine of about 1 loses half the digits there."""
INSIDE = 0.1
"""Least transmission angle (rad) of a solution that a scan can find: near 0 the crank hardly turns, and a cell of the
scan has no point inside.
"""


def lengths(task: ExtremePositions, place: PivotPlace) -> tuple[float, float, float, float]:
    """Crank, coupler, frame or offset, and the least transmission angle of a solution."""
    along = np.array(place.along)
    return (
        float(task.crank(along)),
        float(task.coupler(along)),
        float(task.frame(place.side, along)),
        float(task.transmission(place.side, along)),
    )


def test_crank_rocker_of_the_best_transmission() -> None:
    """K 1.3, ψ 42°, c 120 mm: θ 23.478261°, circle 107.941858 mm, γ_min 39.876037°."""
    task = CrankRocker(1.3, math.radians(42), 120.0)
    assert math.degrees(task.angle) == pytest.approx(23.478261, abs=1e-6)
    assert task.radius == pytest.approx(107.941858, abs=1e-6)
    best = task.best(BEFORE)
    beyond = task.best(BEYOND)
    assert best is not None
    assert beyond is not None
    *links, γ = lengths(task, best)
    assert links == pytest.approx((39.52636, 92.17501, 116.46185), abs=2e-5)
    assert math.degrees(γ) == pytest.approx(39.876037, abs=1e-6)
    assert lengths(task, beyond)[-1] < γ


def test_slider_crank() -> None:
    """K 1.4, H 50, e 20 mm: θ 30°, r 22.159093, l 49.910173 mm, γ_min 32.360258°."""
    task = SliderCrank(1.4, 50.0)
    (place,) = task.with_frame(20.0)
    r, rod, e, γ = lengths(task, place)
    assert math.degrees(crank_angle_between(1.4)) == pytest.approx(30)
    assert (r, rod, e) == pytest.approx((22.159093, 49.910173, 20), abs=1e-6)
    assert math.degrees(γ) == pytest.approx(32.360258, abs=1e-6)


@pytest.mark.parametrize("task", [CrankRocker(1.3, 0.7, 0.12), CrankRocker(1.1, 2.0, 0.1), SliderCrank(1.4, 0.05)])
def test_no_place_of_a_scan_is_better_than_the_best(task: ExtremePositions) -> None:
    for side in task.sides:
        best, ends = task.best(side), task.interval(side)
        assert (best is None) == (ends is None)
        if best is None or ends is None:
            continue
        grid = np.linspace(*ends, 20011)[1:-1]
        assert task.works(side, grid).all()
        assert task.transmission(side, grid).max() <= lengths(task, best)[-1] + 1e-9


@pytest.mark.parametrize("K", [1.001, 1.05, 1.2, 1.5, 2.0, 2.5, 3.0])
@pytest.mark.parametrize("swing", [1, 5, 20, 60, 90, 120, 150, 170])
def test_every_swing_has_a_mechanism(K: float, swing: float) -> None:
    """`check` relies on it when it names the lengths with a solution."""
    task = CrankRocker(K, math.radians(swing), 0.1)
    assert task.interval(BEFORE) is not None
    assert task.frames() is not None
    assert task.cranks() is not None


@pytest.mark.parametrize("K", [1.001, 1.05, 1.2, 1.25, 1.5, 2.0, 2.5, 3.0])
@pytest.mark.parametrize("swing", [1, 5, 20, 40, 50, 60, 90, 120, 150, 170])
def test_the_end_of_the_chord_is_no_place(K: float, swing: float) -> None:
    """With d = c, or the crank half the chord, A is at C₂: rounding must not make a mechanism of it."""
    for rocker in (0.0123, 0.1, 0.37):
        task = CrankRocker(K, math.radians(swing), rocker)
        assert task.with_frame(rocker) == []
        assert task.with_crank(task.chord / 2) == []
        assert task.with_crank(rocker * math.sin(math.radians(swing) / 2)) == []


def test_places_beside_the_end_of_the_chord_are_kept() -> None:
    """A hundredth of a millimetre from the end, the lengths are those of a file."""
    task = CrankRocker(1.2, math.radians(50), 0.1)
    crank = task.chord / 2 - 1e-5
    by_frame, by_crank = task.with_frame(0.10001), task.with_crank(crank)
    assert by_frame
    assert by_crank
    for place in by_frame:
        assert lengths(task, place)[2] == pytest.approx(0.10001, abs=1e-12)
    for place in by_crank:
        assert lengths(task, place)[0] == pytest.approx(crank, abs=1e-12)


@pytest.mark.parametrize("K", [2.9, 2.99, 2.999, 2.9999, 2.999999])
def test_slider_cranks_near_the_greatest_ratio(K: float) -> None:
    """0 < e < H/tan θ, however short it is; from K = 3, where θ = 90°, there is no slider-crank."""
    task = SliderCrank(K, 1.0)
    extent = task.frames()
    assert extent is not None
    # The ends are 1e-9 rad inside the arc.
    assert extent == pytest.approx((0, 1 / math.tan(task.angle)), abs=2e-9)
    (place,) = task.with_frame(sum(extent) / 2)
    assert lengths(task, place)[2] == pytest.approx(sum(extent) / 2, abs=1e-12)
    assert task.best(BEYOND) is not None


def test_no_slider_crank_from_the_ratio_three_on() -> None:
    task = SliderCrank(3.0, 1.0)
    assert (task.interval(BEYOND), task.frames(), task.best(BEYOND), task.with_frame(0.001)) == (None, None, None, [])


# --- analysed as machines ---------------------------------------------------------------------------


def drawn_place(task: ExtremePositions, random: np.random.Generator) -> PivotPlace | None:
    """A random place of A that works; None if there is none on the drawn side."""
    side = int(random.choice(list(task.sides)))
    ends = task.interval(side)
    return None if ends is None else PivotPlace(side, ends[0] + random.uniform(0.02, 0.98) * (ends[1] - ends[0]))


def transmission(linkage: Linkage, angles: Floats, path: float | None = None) -> Floats:
    """Transmission angles from the motion: between the coupler and the rocker, or the normal of the guide."""
    motion = solve_motion(linkage, angles, 1.0)
    B, C = motion.points["B"].p, motion.points["C"].p
    across = (C - linkage.ground["D"]) if path is None else np.full_like(C, 1j)
    γ = np.abs(np.angle((B - C) / across))
    return np.minimum(γ, math.pi - γ)


def test_random_crank_rockers_turn_as_wanted() -> None:
    """The four-bar's own formulas give K and ψ back; its motion has the least transmission angle where it should."""
    random = np.random.default_rng(66)
    solved = 0
    dense = np.linspace(0, 2 * math.pi, 73)
    for _ in range(4 * RANDOM):
        if solved == RANDOM:
            break
        task = CrankRocker(random.uniform(1.02, 2.0), math.radians(random.uniform(10, 110)), 1.0)
        place = drawn_place(task, random)
        if place is None:
            continue
        a, b, d, γ = lengths(task, place)
        q = Calculation()
        for id, length in (("l.AB", a), ("l.BC", b), ("l.DC", 1.0), ("l.AD", d)):
            q.give(id, length)
        proportions(q)
        if min(q.si(id) for id in ("alpha.1", "alpha.2", "psi.2")) < ALONG:
            continue
        solved += 1
        assert q.si("K") == pytest.approx(task.K, abs=1e-9)
        assert q.si("swing") == pytest.approx(task.swing, abs=1e-9)
        linkage = Linkage(
            {"A": 0j, "D": complex(d)},
            Crank("A", "B", a),
            (Dyad("RRR", (2, 3), "B", "C", "D", lengths=(b, 1.0), sign=1),),
        )
        assert transmission(linkage, np.array([0.0, math.pi])).min() == pytest.approx(γ, abs=1e-9)
        assert transmission(linkage, dense).min() >= γ - 1e-9
    assert solved == RANDOM


def test_random_slider_cranks_have_stroke_and_k() -> None:
    """The extreme places of the slider in its motion have the wanted distance and times; γ likewise."""
    random = np.random.default_rng(67)
    for _ in range(RANDOM):
        task = SliderCrank(random.uniform(1.02, 2.8), 1.0)
        place = drawn_place(task, random)
        assert place is not None
        r, rod, e, γ = lengths(task, place)
        linkage = Linkage(
            {"A": 0j, "D": 0j},
            Crank("A", "B", r),
            (Dyad("RRP", (2, 3), "B", "C", Guide(-1j * e, 0.0), lengths=(rod, 0.0), sign=1),),
        )
        stretched, folded = -math.asin(e / (rod + r)), math.pi - math.asin(e / (rod - r))
        motion = solve_motion(linkage, np.array([stretched, folded]), 1.0)
        places, speeds = motion.points["C"].p.real, motion.points["C"].v.real
        assert places[0] - places[1] == pytest.approx(1.0, abs=1e-9)
        assert speeds == pytest.approx([0, 0], abs=1e-9)
        slow = max(folded - stretched, 2 * math.pi - (folded - stretched))
        assert slow / (2 * math.pi - slow) == pytest.approx(task.K, abs=1e-9)
        assert transmission(linkage, np.array([math.pi / 2]), 0.0)[0] == pytest.approx(γ, abs=1e-9)


# --- where there is none ------------------------------------------------------------------------------

Residues = Callable[[Floats, Floats], tuple[Floats, Floats]]


def roots(residues: Residues, crank: Floats, coupler: Floats) -> int:
    """The number of cells of a grid of cranks and couplers from which Newton's method reaches a common zero."""
    a, b = np.meshgrid(crank, coupler)

    def changes(values: Floats) -> Flags:
        """Cells of 3 × 3 points with values of both signs."""
        rows, columns = values.shape
        near = np.stack([values[i : rows - 2 + i, k : columns - 2 + k] for i in range(3) for k in range(3)])
        return (np.nanmin(near, axis=0) < 0) & (np.nanmax(near, axis=0) > 0)

    cells = np.logical_and(*map(changes, residues(a, b)))
    x, y = a[1:-1, 1:-1][cells], b[1:-1, 1:-1][cells]
    step = 1e-7
    for _ in range(30):
        f, g = residues(x, y)
        fx, gx = ((one - zero) / step for one, zero in zip(residues(x + step, y), (f, g), strict=True))
        fy, gy = ((one - zero) / step for one, zero in zip(residues(x, y + step), (f, g), strict=True))
        det = fx * gy - fy * gx
        x, y = x - (f * gy - fy * g) / det, y - (fx * g - f * gx) / det
    f, g = residues(x, y)
    return int((np.hypot(f, g) < 1e-10).sum())


def with_margin(task: ExtremePositions, places: list[PivotPlace]) -> bool | None:
    """True if there is a solution, None if all are so near to a border that a scan may miss them."""
    if any(lengths(task, place)[-1] > INSIDE for place in places):
        return True
    return None if places else False


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_scan_finds_a_crank_rocker_exactly_where_there_is_one() -> None:
    """All cranks and couplers that turn, with the swing and θ of their extreme positions, for a given frame."""
    random = np.random.default_rng(68)
    found = {True: 0, False: 0}
    for _ in range(60):
        task = CrankRocker(random.uniform(1.1, 2.0), math.radians(random.uniform(20, 100)), 1.0)
        d = random.uniform(0.4, 2.5)

        def residues(a: Floats, b: Floats, d: float = d, task: CrankRocker = task) -> tuple[Floats, Floats]:
            shortest = (a < b) & (a < 1) & (a < d)
            longest = np.maximum(np.maximum(b, 1), d)
            turns = shortest & (2 * a + 2 * longest < a + b + 1 + d)
            far, near = b + a, b - a
            ψ = np.arccos((d**2 + 1 - far**2) / (2 * d)) - np.arccos((d**2 + 1 - near**2) / (2 * d))
            at_A = [np.arccos((d**2 + side**2 - 1) / (2 * d * side)) for side in (far, near)]
            θ = np.abs(at_A[0] - at_A[1])
            return np.where(turns, ψ - task.swing, np.nan), np.where(turns, θ - task.angle, np.nan)

        some = with_margin(task, task.with_frame(d))
        if some is None:
            continue
        found[some] += 1
        assert bool(roots(residues, np.linspace(0.003, 1, 500), np.linspace(0.003, 3.6, 1200))) == some
    assert min(found.values()) > 5


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_scan_finds_a_slider_crank_exactly_where_there_is_one() -> None:
    random = np.random.default_rng(69)
    found = {True: 0, False: 0}
    for _ in range(60):
        task, e = SliderCrank(random.uniform(1.1, 2.5), 1.0), random.uniform(0.05, 2.5)

        def residues(r: Floats, rod: Floats, e: float = e, task: SliderCrank = task) -> tuple[Floats, Floats]:
            turns = r + e < rod
            H = np.sqrt((rod + r) ** 2 - e**2) - np.sqrt((rod - r) ** 2 - e**2)
            θ = np.arccos(e / (rod + r)) - np.arccos(e / (rod - r))
            return np.where(turns, H - 1, np.nan), np.where(turns, θ - task.angle, np.nan)

        some = with_margin(task, task.with_frame(e))
        if some is None:
            continue
        found[some] += 1
        assert bool(roots(residues, np.linspace(0.002, 0.7, 500), np.linspace(0.01, 6, 1500))) == some
    assert min(found.values()) > 5
