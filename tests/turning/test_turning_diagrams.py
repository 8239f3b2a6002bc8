"""Random diagrams against an independent quadrature, a load that follows the speed against steps of Runge and Kutta."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.document import text_of
from reportgen.drawing import Label
from reportgen.flywheel import turning_ids as names
from reportgen.flywheel.turning_file import Parameters
from reportgen.flywheel.turning_torques import both_torques, steady_run
from reportgen.formula import Chain, Symbol
from reportgen.sheets import drawing_sheets
from tests.report import trees

FOLDER = Path(__file__).parents[2] / "assignments" / "turning-moment"
RANDOM = 500
X, W = np.polynomial.legendre.leggauss(12)


def drawn(random: np.random.Generator) -> dict[str, Any]:
    """Return random torques: harmonics, a table, or both against each other, over 360° or 720°."""
    cycle = int(random.choice([360, 720]))

    def table() -> dict[str, Any]:
        inner = np.sort(random.choice(np.arange(1, cycle), random.integers(2, 14), replace=False))
        angles = [0, *map(int, inner), cycle]
        if random.random() < 0.4:
            k = int(random.integers(1, len(angles) - 1))
            angles.insert(k, angles[k])
        torques = random.normal(400, 300, len(angles)).round(1)
        torques += max(0.0, 50 - 1.01 * torques.min())
        return {"phi": [f"{a} deg" for a in angles], "M": [f"{M:.1f}" for M in torques], "unit": "N m"}

    def curve() -> dict[str, Any]:
        step = 1.0 if cycle == 360 else 0.5
        orders = {step, *(step * random.integers(1, 9, random.integers(1, 4))).tolist()}
        terms = [
            {"order": f"{n:g}", "sin": f"{random.normal(0, 200):.1f} N m", "cos": f"{random.normal(0, 200):.1f} N m"}
            for n in orders
        ]
        return {"mean": f"{random.uniform(50, 800):.1f} N m", "terms": terms}

    makes = [table, curve]
    given: dict[str, Any] = {"n": "300 rpm", "delta": "0.02"}
    sides = [["driving"], ["resisting"], ["driving", "resisting"]][random.integers(3)]
    return given | {side: makes[random.integers(2)]() for side in sides}


def excess_of(given: dict[str, Any]) -> tuple[Any, list[float], float]:
    """Return the excess torque as a function of angles within a piece, the corners, and the cycle, all by hand."""
    corners, cycle, parts = set[float](), 720.0, list[Any]()
    for side, sign in (("driving", 1.0), ("resisting", -1.0)):
        if (torques := given.get(side)) is None:
            continue
        if "phi" in torques:
            x = np.radians([float(a.split()[0]) for a in torques["phi"]])
            y = np.array([float(M) for M in torques["M"]])
            corners.update(x)
            mean = np.sum((y[1:] + y[:-1]) / 2 * np.diff(x)) / x[-1]
            parts.append((sign, mean, x, y, []))
        else:
            waves = [(float(t["order"]), *(float(t[f].split()[0]) for f in ("cos", "sin"))) for t in torques["terms"]]
            parts.append((sign, float(torques["mean"].split()[0]), None, None, waves))
    if not corners:
        cycle = math.degrees(4 * math.pi / math.gcd(*(round(2 * n) for *_, waves in parts for n, _, _ in waves)))
    cycle = max(corners) if corners else math.radians(cycle)
    level = parts[0][1]

    def excess(φ: np.ndarray, middle: float) -> np.ndarray:
        total = np.zeros_like(φ)
        for sign, mean, x, y, waves in parts:
            if x is None:
                own = sum((a * np.cos(n * φ) + b * np.sin(n * φ) for n, a, b in waves), np.zeros_like(φ))
            else:
                i = int(np.searchsorted(x, middle)) - 1
                own = y[i] + (y[i + 1] - y[i]) * (φ - x[i]) / (x[i + 1] - x[i]) - mean
            total += sign * own * (level / mean)
        return total

    return excess, sorted({0.0, cycle, *corners}), cycle


def test_random_diagrams_have_the_areas_of_a_quadrature() -> None:
    """Work by Gauss nodes over short panels: its steps from point to point are the areas, its extremes there."""
    random = np.random.default_rng(64)
    for _ in range(RANDOM):
        given = drawn(random)
        run = steady_run(Parameters.model_validate(given))
        excess, corners, cycle = excess_of(given)
        ends = np.unique([*corners, *run.points, *np.linspace(0.0, cycle, 121)])
        starts, widths = ends[:-1], np.diff(ends)
        at = starts[:, None] + widths[:, None] * (X + 1) / 2
        values = np.array([excess(row, float(row.mean())) for row in at])
        work = np.concatenate(([0.0], np.cumsum(values @ W * widths / 2)))
        there = work[np.searchsorted(ends, [*run.points, cycle])]
        size = float(np.abs(values).max()) * cycle
        assert np.diff(there) == pytest.approx(run.areas, abs=1e-9 * size), given
        assert np.ptp(work) <= np.ptp(there) + 1e-9 * size, given


def test_the_ledger_has_the_same_areas() -> None:
    """Each definition of the ledger, with its own formulas, gives the area of the run; printed lines as well."""
    for file in sorted(FOLDER.glob("*.yaml")):
        case: Any = open_case(file, "en")
        if case.given.areas is None:
            assert case.areas == pytest.approx(case.run.areas, rel=1e-9, abs=1e-9)
        size = max(map(abs, case.areas))
        for k, area in enumerate(case.areas, start=1):
            printed = case.printed[names.area(k)].at(1)
            assert printed == pytest.approx(area, abs=2e-3 * size)
        assert sum(case.areas) == pytest.approx(0, abs=1e-9 * size)


def test_a_load_that_follows_the_speed_comes_round_again() -> None:
    """dω/dφ = (M_d − cω)/(Jω), in steps of Runge and Kutta from ω at point 1, returns to it with the mean speed."""
    case: Any = open_case(FOLDER / "by-speed.yaml", "en")
    J, c, torques = 12.0, case.run.per_speed, case.given.driving.nodes
    wheel = case.entries.positions[0]["wheel"]
    start = math.sqrt(wheel["fastest"] ** 2 - 2 * max(case.energies) / J)
    ω, met = start, [start]
    for (x0, y0), (x1, y1) in pairwise(torques):
        steps = round((x1 - x0) / math.radians(0.25))
        for k in range(steps):
            h, φ = (x1 - x0) / steps, x0 + (x1 - x0) * k / steps

            def rate(φ: float, ω: float, line: tuple[float, ...] = (x0, y0, x1, y1)) -> float:
                a, b, end, top = line
                return float((b + (top - b) * (φ - a) / (end - a) - c * ω) / (J * ω))

            k1 = rate(φ, ω)
            k2 = rate(φ + h / 2, ω + h / 2 * k1)
            k3 = rate(φ + h / 2, ω + h / 2 * k2)
            ω += h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(φ + h, ω + h * k3))
            met.append(ω)
    assert ω == pytest.approx(start, rel=1e-9)
    assert max(met) == pytest.approx(wheel["fastest"], rel=1e-6)
    assert min(met) == pytest.approx(wheel["slowest"], rel=1e-6)
    assert wheel["fastest"] + wheel["slowest"] == pytest.approx(2 * case.speed)


def test_drawn_torques_meet_at_the_points() -> None:
    """Between the points one torque is the larger one, on the side that the sign of the area says."""
    for file in sorted(FOLDER.glob("*.yaml")):
        case: Any = open_case(file, "en")
        if case.given.areas is not None:
            continue
        φ, driving, resisting = both_torques(case.given, case.run)
        for (start, stop), area in zip(pairwise([*case.run.points, case.cycle]), case.run.areas, strict=True):
            inside = (φ > start + 1e-9) & (φ < stop - 1e-9)
            assert np.all(np.sign((driving - resisting)[inside]) == np.sign(area)), file.name


@pytest.mark.parametrize("language", languages())
def test_the_mean_of_a_short_table_is_a_sum_of_trapezoids(language: Language) -> None:
    """(40·90 + 1000·45 + 700·15 + 40·210)/360 = 187.5 N·m; the two jumps of the press have no width."""
    document = open_case(FOLDER / "press.yaml", language).document()
    (line,) = (line for line in trees.lines(trees.chains(document), "en") if line.result.startswith("187.5"))
    assert line.holds
    assert line.substitution.count("°") == 10
    assert "t1" in text_of(document)


def test_the_mean_of_a_long_table_is_only_its_result(tmp_path: Path) -> None:
    angles = ", ".join(f"{angle} deg" for angle in range(0, 361, 30))
    torques = ", ".join(str(100 + 90 * (number % 3)) for number in range(13))
    file = tmp_path / "long.yaml"
    file.write_text(
        "kind: turning-moment\nreport: {language: en}\nparameters:\n  n: 120 rpm\n  delta: 0.02\n"
        f"  driving: {{phi: [{angles}], M: [{torques}], unit: N m}}\n"
    )
    case = open_case(file)
    assert case.printed[names.MEAN].written is None
    assert "rows of the table" not in text_of(case.document())


@pytest.mark.parametrize("name", ["curve", "two-curves", "press"])
def test_both_diagrams_of_a_sheet_have_one_scale_of_angles(name: str) -> None:
    """Otherwise extremes of the energy do not lie below the points at which the torques are equal."""
    parts = [part for sheet in drawing_sheets(open_case(FOLDER / f"{name}.yaml")) for part in sheet.parts]
    labels = [item.content for part in parts for item in part.scene.items if isinstance(item, Label)]
    chains = [content.parts for content in labels if isinstance(content, Chain)]
    scales = [chain[1] for chain in chains if chain[0] == Symbol("μ", "φ")]
    assert len(scales) == 2
    assert scales[0] == scales[1]


@pytest.mark.parametrize("name", sorted(path.stem for path in FOLDER.glob("*.yaml")))
def test_areas_and_energies_have_one_number_of_decimals(name: str) -> None:
    """An energy is a sum of areas, so equal energies, such as those of points 2 and 4 of two curves, look equal."""
    case = open_case(FOLDER / f"{name}.yaml")
    together = [id for id in case.printed.families if id.startswith(("turning.A.", "turning.E."))]
    decimals = {case.printed.decimals[id] for id in together} - {None}
    assert len(decimals) == 1
    exact, shown = ([one[id].values[0] for id in together] for one in (case.ledger, case.printed))
    for first, at_first in zip(exact, shown, strict=True):
        for second, at_second in zip(exact, shown, strict=True):
            if first == pytest.approx(second, rel=1e-9):
                assert at_first == at_second
