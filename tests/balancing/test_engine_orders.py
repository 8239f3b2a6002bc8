"""Engines by orders: published factors and sums, and the exact forces of all pistons, Fourier-analysed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import load
from reportgen.balancing import orders_ids
from reportgen.balancing.engine_calculation import FACTORS, ORDERS, EngineCalculation
from reportgen.balancing.engine_drawings import scheme
from reportgen.balancing.engine_file import Parameters
from reportgen.cases import opened
from reportgen.drawing import Polyline
from reportgen.formula.calculation import Calculation
from tests.lanes import proof

PITCH = 0.1
"""From one cylinder, or one pair of them, to the next (m)."""
Layout = list[tuple[float, float, float]]
"""Of each cylinder: its crank (°), its place (pitches), its bank (°)."""


def sheet_of(layout: Layout, l: float = 160.0) -> Calculation:  # noqa: E741
    cylinders = [
        {"crank": f"{math.fmod(θ, 360):.12g} deg", "at": f"{z * PITCH * 1e3:.12g} mm", "bank": f"{ψ:.12g} deg"}
        for θ, z, ψ in layout
    ]
    given = {"r": "40 mm", "l": f"{l} mm", "n": "3000 rpm", "m3": "0.5 kg", "m2": "0.6 kg"}
    return EngineCalculation(Parameters.model_validate({**given, "s": "0.35", "cylinders": cylinders})).written()


@pytest.mark.parametrize(
    ("l", "factors"),
    [
        (40 * 4, (0.25402504, -0.00409811, 0.00007438)),
        (40 * 3.6, (0.28333914, -0.00568698, 0.00012842)),
        (40 / 0.3, (0.30705066, -0.00723769, 0.00019194)),
    ],
)
def test_the_factors_of_the_orders(l: float, factors: tuple[float, ...]) -> None:  # noqa: E741
    """R4a; the first terms of the series are as near as their next one is small."""
    sheet = sheet_of([(0, 0, 0)], l)
    λ = 40 / l
    for order, factor in zip(FACTORS, factors, strict=True):
        assert sheet.si(orders_ids.factor(order)) == pytest.approx(factor, abs=0.5e-8)
        assert abs(sheet.si(orders_ids.series(order)) - factor) < λ**7


KNOWN: dict[str, tuple[Layout, tuple[float, ...], tuple[float, ...]]] = {
    "twin at 180°": ([(0, 0, 0), (180, 1, 0)], (0, 2, 2), (1, 0, 0)),
    "twin at 360°": ([(0, 0, 0), (0, 1, 0)], (2, 2, 2), (0, 0, 0)),
    "twin at 270°": ([(0, 0, 0), (270, 1, 0)], (math.sqrt(2), 0, 2), (0.5 * math.sqrt(2), 1, 0)),
    "in-line three": ([(0, 0, 0), (120, 1, 0), (240, 2, 0)], (0, 0, 0), (math.sqrt(3),) * 3),
    "in-line four": ([(0, 0, 0), (180, 1, 0), (180, 2, 0), (0, 3, 0)], (0, 4, 4), (0, 0, 0)),
    "in-line six": ([(θ, z, 0) for z, θ in enumerate((0, 120, 240, 240, 120, 0))], (0, 0, 0), (0, 0, 0)),
    "boxer twin": ([(0, 0, 0), (180, 1, 180)], (0, 0, 0), (1, 1, 1)),
    "V 90°": ([(0, 0, 45), (0, 0, -45)], (1, math.sqrt(2), math.sqrt(2)), (0, 0, 0)),
    "V 60°": ([(0, 0, 30), (0, 0, -30)], (1.5, 0.5 * math.sqrt(3), 0.5 * math.sqrt(3)), (0, 0, 0)),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_engines(name: str) -> None:
    """R4c: greatest forces over m r ω² Aₙ, greatest couples over that and the pitch."""
    layout, forces, couples = KNOWN[name]
    sheet = sheet_of(layout)
    for n, force, couple in zip(ORDERS, forces, couples, strict=True):
        unit = sheet.si("orders.K") * (1.0 if n == 1 else abs(sheet.si(orders_ids.factor(n))))
        assert sheet.si(orders_ids.force(n)) / unit == pytest.approx(force, abs=1e-12)
        if orders_ids.couple(n) in sheet:
            assert sheet.si(orders_ids.couple(n)) / unit / PITCH == pytest.approx(couple, abs=1e-12)
        else:
            assert couple == 0


def test_a_counterweight_takes_the_first_order_of_a_right_angled_v() -> None:
    """Both rods on one pin: U = (m_A + m_rec/2) r f₁, and nothing of the first order is left."""
    sheet = sheet_of(KNOWN["V 90°"][0])
    assert sheet.si("orders.U") == pytest.approx((0.39 + 0.71 / 2) * 0.04 * 2)
    assert abs(sheet.si("orders.left")) < 1e-9 * sheet.si("orders.K")


# --- against the sum of exact piston forces ---------------------------------------------------------------

SAMPLES = 256


def extremes(layout: Layout, l: float, arms: bool) -> dict[int, tuple[float, float]]:  # noqa: E741
    """The greatest and the least force, or couple about the middle, of each order (N, N·m), from exact positions."""
    r, ω, m = 0.04, 3000 * math.pi / 30, 0.71
    φ = np.arange(SAMPLES) * math.tau / SAMPLES
    middle = (min(z for _, z, _ in layout) + max(z for _, z, _ in layout)) / 2
    whole = np.zeros(SAMPLES, complex)
    for θ, z, ψ in layout:
        turned = φ + math.radians(θ - ψ)
        x = r * np.cos(turned) + np.sqrt((l / 1e3) ** 2 - (r * np.sin(turned)) ** 2)
        # Twice differentiated by its spectrum, which ends far below the highest of so many samples.
        orders = np.fft.fftfreq(SAMPLES, 1 / SAMPLES)
        acceleration = np.fft.ifft(-((orders * ω) ** 2) * np.fft.fft(x)).real
        whole += -m * acceleration * np.exp(1j * math.radians(ψ)) * ((z - middle) * PITCH if arms else 1.0)
    spectrum = np.fft.fft(whole) / SAMPLES
    turning = {n: (float(abs(spectrum[n])), float(abs(spectrum[-n]))) for n in ORDERS}
    return {n: (one + other, abs(one - other)) for n, (one, other) in turning.items()}


def layouts(many: int) -> list[Layout]:
    """In-line engines, boxers, V engines, and so many that nobody builds."""
    found: list[Layout] = [[(720 * k / count, k, 0) for k in range(count)] for count in (1, 2, 3, 4, 5, 6, 8)]
    for count in (2, 4, 6):
        found.append([(360 * (k // 2) / count + 180 * (k % 2), k, 180 * (k % 2)) for k in range(count)])
    for bank in (60, 90):
        for pairs in range(1, 7):
            found.append([(720 * (k // 2) / pairs, k // 2, bank / 2 - bank * (k % 2)) for k in range(2 * pairs)])
    rng = np.random.default_rng(4)
    for _ in range(many):
        count = int(rng.integers(1, 13))
        found.append(
            [
                (float(rng.uniform(-360, 360)), k + float(rng.uniform(0, 0.9)), float(rng.choice((0, 45, -60, 180))))
                for k in range(count)
            ]
        )
    return found


@pytest.mark.parametrize("many", [10, pytest.param(200, marks=proof)])
def test_layouts_against_exact_piston_forces(many: int) -> None:
    rng = np.random.default_rng(5)
    for layout in layouts(many):
        l = float(round(rng.uniform(120, 220), 3))  # noqa: E741
        sheet = sheet_of(layout, l)
        forces, couples = extremes(layout, l, False), extremes(layout, l, True)
        most = len(layout) * sheet.si("orders.K")
        for n in ORDERS:
            of_couples = orders_ids.couple(n), orders_ids.least_couple(n)
            inline = len({ψ for _, _, ψ in layout}) == 1
            for ids, values, off in (
                ((orders_ids.force(n), orders_ids.least_force(n)), forces[n], 1e-9 * most),
                (of_couples, couples[n], 1e-9 * most * len(layout) * PITCH),
            ):
                for id, value in zip(ids, values, strict=True):
                    assert abs((sheet.si(id) if id in sheet else 0.0) - value) <= off
                assert ids[0] not in sheet or (ids[1] in sheet) is not inline


V8: Layout = [(θ, z, ψ) for θ, z in ((0, 0), (90, 1), (270, 2), (180, 3)) for ψ in (45, -45)]
"""A cross-plane crankshaft, both cylinders of a pair on one pin."""


@pytest.mark.parametrize(("layout", "left"), [(V8, False), (KNOWN["in-line three"][0], True)], ids=["V8", "three"])
def test_the_couple_of_the_rotating_masses(layout: Layout, left: bool) -> None:
    """Couples of pistons, of the first order, and of rotating masses by cylinders over a turn, less counterweights.

    On a cross-plane V8 the counterweights take all of it; in line they leave half of the first order, turning against.
    """
    sheet = sheet_of(layout)
    r, ω, m_A, m = (sheet.si(f"orders.{name}") for name in ("r", "omega", "mA", "m"))
    φ = np.radians(np.arange(360.0))[:, None]
    θ, ψ = (np.radians([row[column] for row in layout]) for column in (0, 2))
    z = np.array([row[1] for row in layout]) * PITCH
    arm = z - (z.min() + z.max()) / 2
    rotating = (arm * m_A * r * ω**2 * np.exp(1j * (φ + θ))).sum(axis=1)
    pistons = (arm * m * r * ω**2 * np.cos(φ + θ - ψ) * np.exp(1j * ψ)).sum(axis=1)
    assert np.abs(rotating) == pytest.approx(sheet.si("orders.rotating.M"))
    # The counterweights turn with the crank, opposite to the rotating couple.
    balance = sheet.si("orders.U.M") * ω**2 * rotating / np.abs(rotating)
    rest = np.abs(rotating + pistons - balance)
    greatest = float(np.abs(rotating + pistons).max())
    assert rest.max() == pytest.approx(sheet.si("orders.left.M"), abs=1e-9 * greatest)
    assert bool(rest.max() > 1e-9 * greatest) is left


@pytest.mark.parametrize("pitch", ["40 mm", "88 mm", "90 mm", "200 mm"])
def test_every_throw_of_the_shaft_is_drawn(tmp_path: Path, pitch: str) -> None:
    """Each throw has four corners, the first too where its webs are wide."""
    far = f"{2 * float(pitch.split()[0]):g} mm"
    cylinders = f"[{{crank: 0 deg, at: 0 mm}}, {{crank: 120 deg, at: {pitch}}}, {{crank: 240 deg, at: {far}}}]"
    file = tmp_path / "three.yaml"
    data = "r: 38 mm, l: 130 mm, n: 4200 rpm, m3: 0.42 kg, m2: 0.55 kg, s: 0.33"
    file.write_text(f"kind: engine-balance\nparameters: {{{data}, cylinders: {cylinders}}}\n")
    drawing = scheme(opened(load(file)))
    shaft = max((item for item in drawing.items if isinstance(item, Polyline)), key=lambda item: len(item.points))
    assert len(shaft.points) == 2 + 4 * 3
    assert [point.real for point in shaft.points] == sorted(point.real for point in shaft.points)
