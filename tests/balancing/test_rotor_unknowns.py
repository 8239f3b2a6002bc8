"""Rotors whose second plane, or two of whose masses, are sought: numbers, reports, marks, faults."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.balancing import rotor_ids as ids
from reportgen.balancing.rotor_calculation import AFTER, RotorCalculation
from reportgen.balancing.rotor_case import RotorCase
from reportgen.balancing.rotor_drawings import moments_plan, unbalance_plan
from reportgen.balancing.rotor_file import Parameters
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.document import Table, Text
from reportgen.formula.array_evaluation import model
from reportgen.formula.calculation import Calculation
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.results import results as results_of
from reportgen.sheets import drawing_sheets
from tests.balancing.test_rotor_reports import ROUNDED, arrows, recomputes
from tests.gears.test_train_reports import chains
from tests.marking import students
from tests.marking.designs import named

PLANE = """kind: rotor
parameters:
  planes: {A: 0 mm, B: find}
  correction: {A: {r: 80 mm, angle: 190 deg}, B: {r: 80 mm}}
  masses:
    - {m: 18 kg, r: 60 mm, angle: 0 deg, z: 100 mm}
    - {m: 12.5 kg, r: 60 mm, angle: 100 deg, z: 300 mm}
  bearings: [-50 mm, 500 mm]
  n: 900 rpm
"""
LEFT_PLANE = PLANE.replace("z: 100 mm", "z: -100 mm").replace("z: 300 mm", "z: -300 mm")
MASSES = """kind: rotor
parameters:
  planes: {A: 0 mm}
  correction: {r: 100 mm}
  masses:
    - {m: 7 kg, r: 100 mm, angle: 0 deg, z: 100 mm}
    - {m: find, r: 100 mm, angle: 90 deg, z: 200 mm}
    - {m: find, r: 100 mm, angle: 240 deg, z: 300 mm}
"""
TEXTS = {"plane": PLANE, "left": LEFT_PLANE, "masses": MASSES}
MANY = 250
"""Random rotors of each kind."""


def case_of(name: str, folder: Path, language: Language = "en") -> RotorCase:
    file = folder / f"{name}.yaml"
    file.write_text(TEXTS[name], encoding="utf-8")
    case = open_case(file, language)
    assert isinstance(case, RotorCase)
    return case


def sheet_of(text: dict[str, object]) -> Calculation:
    return RotorCalculation(Parameters.model_validate(text)).written()


def rows(count: int, *sought: int) -> list[dict[str, str]]:
    angles = (0, 90, 240, 100)
    return [
        {
            "m": "find" if k in sought else f"{1 + k} kg",
            "r": "60 mm",
            "angle": f"{angles[k]} deg",
            "z": f"{100 + 100 * k} mm",
        }
        for k in range(count)
    ]


def entered(known: dict[str, np.ndarray], place: str, U: np.ndarray, z: np.ndarray, r: np.ndarray) -> None:
    known |= {
        ids.mass(place): np.abs(U) / r,
        ids.radius(place): r,
        ids.angle(place): np.angle(U),
        ids.station(place): z,
    }


def test_random_rotors_with_a_sought_plane() -> None:
    """Balanced rotors, drawn from their corrections: those are found again to 1e-9, right of A and left of it."""
    rng = np.random.default_rng(1)
    for sense, text in ((1, "190 deg"), (-1, "190 deg")):
        masses = [{**row, "z": f"{sense * (100 + 200 * k)} mm"} for k, row in enumerate(rows(2))]
        masses[0] |= {"m": "18 kg"}
        masses[1] |= {"m": "12.5 kg", "angle": "100 deg"}
        correction = {"A": {"r": "80 mm", "angle": text}, "B": {"r": "80 mm"}}
        sheet = sheet_of({"planes": {"A": "0 mm", "B": "find"}, "correction": correction, "masses": masses})
        U_A, U_B, L = (rng.uniform(0.05, 1, MANY // 2) for _ in range(3))
        α, β = (rng.uniform(-math.pi, math.pi, MANY // 2) for _ in range(2))
        z_A, z_1 = rng.uniform(-1, 1, MANY // 2), rng.uniform(-1, 1, MANY // 2)
        z_2 = z_1 + rng.uniform(0.1, 1, MANY // 2)
        z_B = z_A + sense * L
        # Both masses balance what is drawn.
        F = U_A * np.exp(1j * α) + U_B * np.exp(1j * β)
        M = U_A * np.exp(1j * α) * z_A + U_B * np.exp(1j * β) * z_B
        second = -(M - F * z_1) / (z_2 - z_1)
        first = -F - second
        known: dict[str, np.ndarray] = {ids.station("A"): z_A, ids.direction("A"): α}
        known |= {ids.radius(plane): np.full(MANY // 2, 0.08) for plane in "AB"}
        for place, U, z in (("1", first, z_1), ("2", second, z_2)):
            entered(known, place, U, z, rng.uniform(0.02, 0.2, MANY // 2))
        wanted = {
            ids.unbalance("A"): U_A,
            ids.unbalance("B"): U_B,
            ids.station("B"): z_B,
            ids.by_components("U", "A"): U_A,
            ids.by_components("z", "B"): z_B,
        }
        # Nearly parallel lines lose figures.
        firm = np.abs(np.sin(α - β)) > 0.01
        found = model(sheet, [*wanted, ids.direction("B")], **known)
        for id, values in wanted.items():
            assert np.all(np.abs(found[id] - values)[firm] <= 1e-9), id
        off = np.exp(1j * (found[ids.direction("B")] - β)) - 1
        assert np.all(np.abs(off)[firm] <= 1e-9)


def test_random_rotors_with_sought_masses() -> None:
    """Two masses at their angles, with which a third mass and a correction in plane A are in balance."""
    rng = np.random.default_rng(2)
    sheet = sheet_of({"planes": {"A": "0 mm"}, "correction": {"r": "80 mm"}, "masses": rows(3, 1, 2)})
    z_A = rng.uniform(-1, 0, MANY)
    z = {place: z_A + rng.uniform(0.1, 1, MANY) for place in "123"}
    U = {place: rng.uniform(0.05, 1, MANY) * np.exp(1j * rng.uniform(-3, 3, MANY)) for place in "23"}
    U["1"] = -sum(U[place] * (z[place] - z_A) for place in "23") / (z["1"] - z_A)
    r = {place: rng.uniform(0.02, 0.2, MANY) for place in "123"}
    known: dict[str, np.ndarray] = {ids.station("A"): z_A, ids.radius("A"): np.full(MANY, 0.08)}
    for place in "123":
        entered(known, place, U[place], z[place], r[place])
    answers = {place: known.pop(ids.mass(place)) for place in "23"}
    whole = -sum(U.values())
    wanted = [ids.unbalance("A"), ids.direction("A"), ids.by_components("U", "A")]
    wanted += [family(place) for place in "23" for family in (ids.mass, lambda at: ids.by_components("m", at))]
    found = model(sheet, wanted, **known)
    firm = np.abs(np.sin(np.angle(U["2"]) - np.angle(U["3"]))) > 0.01
    for place, m in answers.items():
        for id in (ids.mass(place), ids.by_components("m", place)):
            assert np.all(np.abs(found[id] - m)[firm] <= 1e-9 * m.max())
    A = found[ids.unbalance("A")] * np.exp(1j * found[ids.direction("A")])
    assert np.all(np.abs(A - whole)[firm] <= 1e-9)
    assert np.all(np.abs(found[ids.by_components("U", "A")] - np.abs(whole))[firm] <= 1e-9)


@pytest.mark.parametrize("name", TEXTS)
def test_reports_in_four_languages(name: str, tmp_path: Path) -> None:
    """Lines recompute, plans close, rows of the key have words, and the task holds no answer."""
    for language in languages():
        case = case_of(name, tmp_path, language)
        checked = [recomputes(chain) for chain in chains(case.document().blocks)]
        assert checked.count(True) >= 12
        assert False not in checked
        assert [row.id for row in key_of(case).rows if not row.what] == []
    for draw in (moments_plan, unbalance_plan):
        assert abs(sum(arrows(draw(case)).values())) <= 2 * ROUNDED
    case.animations()
    drawing_sheets(case)
    (position,) = results_of(case)["positions"]
    if name == "masses":
        masses = next(one for one in case.document().blocks if isinstance(one, Table) and one.key == "tab.masses")
        assert [row[1].inlines for row in masses.rows][1:] == [(Text("?"),)] * 2
        assert position["masses"]["3"] == pytest.approx(14 / 3)
    else:
        assert position["corrections"]["B"]["place"] == pytest.approx(-0.36669 if name == "left" else 0.36669, abs=1e-5)
        forces = [case.printed[ids.bearing_force(AFTER, place)].at(1) for place in "CD"]
        assert max(forces) < 0.02 * case.ledger[ids.bearing_force("before", "C")].at(1)


def test_what_the_sheets_ask_for(tmp_path: Path) -> None:
    asked = {name: {row.id for row in Ask().of(marking_scheme(case_of(name, tmp_path)).key).asked} for name in TEXTS}
    assert {ids.station("B"), ids.unbalance("A"), ids.direction("B"), ids.mass("B")} <= asked["plane"]
    assert ids.direction("A") not in asked["plane"]
    assert {ids.mass("2"), ids.mass("3"), ids.mass("A"), ids.direction("A")} <= asked["masses"]


@pytest.mark.parametrize(
    ("name", "mistake", "where"),
    [
        ("plane", "rotor-plane-side", ids.station("B")),
        ("left", "rotor-plane-side", ids.station("B")),
        ("plane", "rotor-wrong-side", ids.direction("B")),
        ("masses", "rotor-wrong-side", ids.direction("A")),
    ],
)
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: str, tmp_path: Path) -> None:
    scheme = marking_scheme(case_of(name, tmp_path))
    sheet = students.written(scheme, students.worked_out(scheme, named(scheme, mistake, where)))
    assert {(cell.id, cell.mistake) for cell in mark(scheme, sheet).first_errors} == {(where, mistake)}
    for language in languages():
        words = case_of(name, tmp_path, language).words
        assert "{symbol}" in words["mistakes"][mistake]
        assert words["mistake_names"][mistake]


FAULTS = [
    ("plane", ", angle: 190 deg", "", ["3:24 needs-besides"]),
    ("plane", "B: {r: 80 mm}", "B: {r: 80 mm, angle: 20 deg}", ["4:61 unknown-key"]),
    ("plane", "B: find", "B: 400 mm", ["4:30 rotor-angle-known"]),
    ("plane", "angle: 190 deg", "angle: 10 deg", ["4:37 rotor-other-side"]),
    ("plane", "angle: 100 deg, z", "angle: 0 deg, z", ["4:37 rotor-one-suffices"]),
    ("plane", "m: 18 kg", "m: find", ["6:11 rotor-sought"]),
    ("masses", "{A: 0 mm}", "{A: 0 mm, B: 500 mm}", ["7:11 rotor-sought"]),
    ("masses", "m: 7 kg", "m: find", ["6:11 rotor-sought"]),
    ("masses", "z: 200 mm", "z: 0 mm", ["7:11 rotor-sought"]),
    ("masses", "angle: 240 deg", "angle: 60 deg", ["8:35 rotor-other-side"]),
    ("masses", "angle: 240 deg", "angle: 270 deg", ["8:35 rotor-sought-parallel"]),
    ("masses", "angle: 0 deg", "angle: 270 deg", ["8:35 rotor-sought-none"]),
    ("masses", "m: 7 kg", "m: seek", ["6:11 not-a-number"]),
]


@pytest.mark.parametrize(("name", "old", "new", "faults"), FAULTS)
def test_faults_are_located(name: str, old: str, new: str, faults: list[str], tmp_path: Path) -> None:
    assert TEXTS[name].count(old) == 1
    (tmp_path / "rotor.yaml").write_text(TEXTS[name].replace(old, new), encoding="utf-8")
    for language in languages():
        found = api.check(tmp_path / "rotor.yaml", language)
        assert [f"{one.location.line}:{one.location.column} {one.code}" for one in found] == faults


def test_one_correction_that_suffices_is_named_with_its_plane(tmp_path: Path) -> None:
    """Masses of one direction have one resultant, at (2·100 + 3·200)/5 = 160 mm."""
    file = tmp_path / "rotor.yaml"
    masses = "[{m: 2 kg, r: 50 mm, angle: 30 deg, z: 100 mm}, {m: 3 kg, r: 50 mm, angle: 30 deg, z: 200 mm}]"
    correction = "{A: {r: 80 mm, angle: 190 deg}, B: {r: 80 mm}}"
    file.write_text(
        f"kind: rotor\nparameters:\n  planes: {{A: 0 mm, B: find}}\n  correction: {correction}\n  masses: {masses}\n",
        encoding="utf-8",
    )
    (problem,) = api.check(file, "en")
    assert problem.code == "rotor-one-suffices"
    assert "160 mm" in problem.message


def test_a_known_correction_in_a_third_plane_is_one_more_mass() -> None:
    """Three planes, of which two correct: all three, with the masses, are in balance."""
    masses = [*rows(2), {"m": "2 kg", "r": "70 mm", "angle": "200 deg", "z": "250 mm"}]
    sheet = sheet_of({"planes": {"A": "0 mm", "B": "600 mm"}, "masses": masses})
    places = ["1", "2", "3"]
    bodies = [(sheet.si(ids.unbalance(p)), sheet.si(ids.angle(p)), sheet.si(ids.station(p))) for p in places]
    bodies += [(sheet.si(ids.unbalance(p)), sheet.si(ids.direction(p)), sheet.si(ids.station(p))) for p in "AB"]
    for arm in (0, 1):
        assert abs(sum(U * np.exp(1j * α) * z**arm for U, α, z in bodies)) < 1e-15
