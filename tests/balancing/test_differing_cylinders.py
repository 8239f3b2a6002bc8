"""Engines whose cylinders have masses and cranks of their own, against the sum of the forces of all cylinders."""

from __future__ import annotations

import cmath
import math
import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.balancing import orders_ids as ids
from reportgen.balancing.engine_calculation import ORDERS, EngineCalculation
from reportgen.balancing.engine_case import EngineCase
from reportgen.balancing.engine_file import Parameters
from reportgen.base.template_folders import languages
from reportgen.cases import open_case
from reportgen.formula.array_evaluation import model
from reportgen.formula.calculation import Calculation
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import key_of
from tests.balancing.test_rotor_reports import recomputes
from tests.gears.test_train_reports import chains
from tests.marking import students
from tests.marking.designs import named

TEXT = """kind: engine-balance
parameters:
  r: 40 mm
  l: 160 mm
  n: 3000 rpm
  m3: 0.5 kg
  m2: 0.6 kg
  m1: 0.8 kg
  s: 0.35
  cylinders:
    - {crank: 0 deg, at: 0 mm, bank: 30 deg, r: 50 mm}
    - {crank: 100 deg, at: 100 mm, bank: -30 deg, m3: 0.7 kg, m1: 0.3 kg}
    - {crank: 200 deg, at: 220 mm, bank: 30 deg, m2: 0.4 kg}
"""
EACH = 125
"""Random engines of each number of cylinders."""
SAMPLES = 64


@pytest.fixture(scope="module", name="file")
def _file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("own") / "own.yaml"
    file.write_text(TEXT, encoding="utf-8")
    return file


def sheet_of(count: int) -> Calculation:
    """The sheet of a V engine of which each cylinder differs; its numbers do not matter, but for the largest r/l."""
    own = {"m1": "1 kg", "m2": "1 kg", "m3": "1 kg", "r": "90 mm"}
    cylinders = [
        {"crank": f"{50 * k} deg", "at": f"{90 * k} mm", "bank": f"{30 - 60 * (k % 2)} deg", **own}
        for k in range(count)
    ]
    given = {"r": "90 mm", "l": "200 mm", "n": "900 rpm", "m1": "1 kg", "m2": "1 kg", "m3": "1 kg", "s": "0.3"}
    return EngineCalculation(Parameters.model_validate({**given, "cylinders": cylinders})).written()


@pytest.mark.parametrize("count", [2, 3, 4, 6])
def test_random_engines(count: int) -> None:
    """Greatest and least forces and couples of all orders, and both sums that turn with the crank, to 1e-9."""
    rng, places = np.random.default_rng(count), [str(k + 1) for k in range(count)]

    def drawn(low: float, high: float) -> np.ndarray:
        return rng.uniform(low, high, EACH)

    known = {f"orders.{key}": drawn(0.2, 2) for key in ("m1", "m2", "m3")}
    known |= {"orders.r": drawn(0.03, 0.09), "orders.l": drawn(0.2, 0.4), "orders.s": drawn(0.1, 0.9)}
    known["orders.n"] = drawn(300, 6000)
    for k, place in enumerate(places):
        known |= {ids.own_mass(link, place): drawn(0.2, 2) for link in "123"}
        known |= {
            ids.own_radius(place): drawn(0.03, 0.09),
            ids.crank(place): drawn(-6, 6),
            ids.bank(place): drawn(-3, 3),
        }
        # In this order, so that the first and the last cylinder stay the outermost.
        known[ids.station(place)] = 0.1 * k + drawn(0, 0.05)
    sheet = sheet_of(count)
    extremes = [(ids.force, ids.least_force), (ids.couple, ids.least_couple)]
    wanted = [family(n) for pair in extremes for family in pair for n in ORDERS]
    sums = [f"orders.{name}{of}" for name in ("rotating", "U") for of in ("", ".M")]
    found = model(sheet, [*wanted, *sums], **known)
    ω, s = known["orders.n"] * math.pi / 30, known["orders.s"]
    z = [known[ids.station(place)] for place in places]
    middle = (z[0] + z[-1]) / 2
    φ = np.arange(SAMPLES)[:, None] * math.tau / SAMPLES
    spectra = {ids.force: 0j, ids.couple: 0j}
    turning = dict.fromkeys(sums, 0j)
    most = 0.0
    for place, at in zip(places, z, strict=True):
        m1, m2, m3 = (known[ids.own_mass(link, place)] for link in "123")
        r, θ, ψ = (known[family(place)] for family in (ids.own_radius, ids.crank, ids.bank))
        m, m_A = m3 + m2 * s, m1 + m2 * (1 - s)
        turned = φ + θ - ψ
        x = r * np.cos(turned) + np.sqrt(known["orders.l"] ** 2 - (r * np.sin(turned)) ** 2)
        of_orders = np.fft.fftfreq(SAMPLES, 1 / SAMPLES)[:, None] ** 2
        pull = m * ω**2 * of_orders * np.fft.fft(x, axis=0) / SAMPLES * np.exp(1j * ψ)
        spectra[ids.force] = spectra[ids.force] + pull
        spectra[ids.couple] = spectra[ids.couple] + pull * (at - middle)
        for of, arm in (("", 1.0), (".M", at - middle)):
            turning[f"orders.rotating{of}"] = turning[f"orders.rotating{of}"] + m_A * r * ω**2 * np.exp(1j * θ) * arm
            turning[f"orders.U{of}"] = turning[f"orders.U{of}"] + (m_A + m / 2) * r * np.exp(1j * θ) * arm
        most = most + (m + m_A) * r * ω**2
    for greatest, least in extremes:
        for n in ORDERS:
            with_crank, against = abs(spectra[greatest][n]), abs(spectra[greatest][-n])
            assert np.all(np.abs(found[greatest(n)] - (with_crank + against)) <= 1e-9 * most)
            assert np.all(np.abs(found[least(n)] - np.abs(with_crank - against)) <= 1e-9 * most)
    for id in sums:
        assert np.all(np.abs(found[id] - np.abs(turning[id])) <= 1e-9 * most)


def test_lines_and_moving_forces(file: Path) -> None:
    """Every line recomputes in four languages; turned on the page, forces are as great as the stars say."""
    for language in languages():
        case = open_case(file, language)
        checked = [recomputes(chain) for chain in chains(case.document().blocks)]
        assert checked.count(True) >= 30
        assert False not in checked
        rows = key_of(case).rows
        # The number of the cylinder or of the order alone, not its index in print.
        assert [row.id for row in rows if not row.what or re.search(r",(min|\d)", row.what)] == []
    assert isinstance(case, EngineCase)
    φ = np.arange(3600) * math.tau / 3600
    for by_order, greatest, least in (
        (case.forces(φ), ids.force, ids.least_force),
        (case.couples(φ), ids.couple, ids.least_couple),
    ):
        for n, values in by_order.items():
            natural = case.ledger[greatest(n)].scale
            assert abs(values).max() == pytest.approx(case.ledger[greatest(n)].at(1), abs=1e-5 * natural)
            assert abs(values).min() == pytest.approx(case.ledger[least(n)].at(1), abs=5e-3 * natural)
    assert abs(case.rotating(0.0)) == pytest.approx(case.ledger["orders.rotating"].at(1))
    case.animations(), case.plates()
    # The counterweight stands opposite to what it balances.
    given = case.given
    turning = sum(
        (given.of_cylinder(p, "m1") + 0.65 * given.of_cylinder(p, "m2"))
        * given.of_cylinder(p, "r")
        * cmath.rect(1, given.cylinders[int(p) - 1].crank.si)
        + case.ledger[ids.reciprocating(p)].at(1)
        / 2
        * given.of_cylinder(p, "r")
        * cmath.rect(1, given.cylinders[int(p) - 1].crank.si)
        for p in case.cylinders
    )
    U = cmath.rect(case.ledger["orders.U"].at(1), case.ledger["orders.U.dir"].at(1))
    assert abs(turning + U) <= 1e-12


def test_data_of_one_cylinder_that_repeat_those_of_all_change_nothing(tmp_path: Path) -> None:
    same = TEXT.replace(", r: 50 mm", "").replace(", m3: 0.7 kg, m1: 0.3 kg", "").replace(", m2: 0.4 kg", "")
    ledgers = []
    for name, text in {
        "alike": same,
        "own": same.replace("bank: -30 deg", "bank: -30 deg, m3: 0.5 kg, r: 40 mm"),
    }.items():
        (tmp_path / f"{name}.yaml").write_text(text, encoding="utf-8")
        ledgers.append(open_case(tmp_path / f"{name}.yaml", "en").ledger)
    for id in (*(f(n) for f in (ids.force, ids.least_force, ids.couple) for n in ORDERS), "orders.U", "orders.left.M"):
        assert ledgers[0][id].at(1) == pytest.approx(ledgers[1][id].at(1), rel=1e-12)


def test_a_star_with_single_angles_has_its_name(file: Path) -> None:
    scheme = marking_scheme(open_case(file, "en"))
    where = ids.resultant("f", 2)
    sheet = students.written(scheme, students.worked_out(scheme, named(scheme, "orders-single-angle", where)))
    assert {(cell.id, cell.mistake) for cell in mark(scheme, sheet).first_errors} == {(where, "orders-single-angle")}


@pytest.mark.parametrize(
    ("old", "new", "faults"),
    [
        ("r: 50 mm}", "r: 150 mm}", ["4:6 rod-too-short"]),
        ("  s: 0.35\n", "", ["7:3 needs-besides", "12:50 needs-besides"]),
        ("m3: 0.7 kg", "m3: 0 kg", ["12:55 out-of-range"]),
    ],
)
def test_faults_of_a_cylinder_are_located(old: str, new: str, faults: list[str], tmp_path: Path) -> None:
    assert TEXT.count(old) == 1
    (tmp_path / "own.yaml").write_text(TEXT.replace(old, new), encoding="utf-8")
    found = api.check(tmp_path / "own.yaml", "en")
    assert [f"{one.location.line}:{one.location.column} {one.code}" for one in found] == faults


def test_a_v_twin_on_one_throw_has_its_report(tmp_path: Path) -> None:
    """Without places along the crankshaft there are no couples."""
    text = "{r: 50 mm, l: 180 mm, n: 1500 rpm, m3: 1 kg, cylinders: [{crank: 0 deg, bank: 45 deg}, "
    text += "{crank: 0 deg, bank: -45 deg, m3: 1.4 kg}]}"
    (tmp_path / "twin.yaml").write_text(f"kind: engine-balance\nparameters: {text}\n", encoding="utf-8")
    for language in languages():
        assert open_case(tmp_path / "twin.yaml", language).document().blocks
