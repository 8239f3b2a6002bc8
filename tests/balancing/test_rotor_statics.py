"""Rotors by published figures and by the statics of a turning shaft, which knows nothing of the sheet."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from reportgen import load, solve
from reportgen.balancing import rotor_ids
from reportgen.balancing.rotor_calculation import AFTER, BEFORE, RotorCalculation
from reportgen.balancing.rotor_file import BEARINGS, Parameters
from reportgen.base.errors import AssignmentError
from reportgen.cases import opened
from reportgen.document import text_of
from reportgen.formula.array_evaluation import model
from reportgen.formula.calculation import Calculation
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "rotor"
LEAST = 1e-12
"""What may be left, as a share of all unbalance: the rounding of some ten operations on doubles."""


def test_the_reference_rotor() -> None:
    """R4e: planes at 0 and 0.6 m, four masses; 0.08347177 kg·m at 267.25744° in one plane."""
    ledger = built.case(FOLDER / "rotor-two-planes.yaml").ledger
    for plane, size, angle in (("A", 0.09111108, 228.19868), ("B", 0.05880376, 344.76089)):
        assert ledger[rotor_ids.unbalance(plane)].at(1) == pytest.approx(size, abs=0.5e-8)
        assert math.degrees(ledger[rotor_ids.direction(plane)].at(1)) == pytest.approx(angle, abs=0.5e-5)
        assert ledger[rotor_ids.mass(plane)].at(1) == pytest.approx(size / 0.08, abs=1e-7)


def test_the_reference_rotor_in_one_plane() -> None:
    sheet = sheet_of(4, planes={"A": "0 mm"})
    known: dict[str, float] = {}
    for number, (m, r, angle, z) in enumerate(
        ((2, 0.05, 0, 0.1), (1.5, 0.07, 75, 0.25), (3, 0.04, 160, 0.4), (1, 0.06, 260, 0.55)), start=1
    ):
        place = str(number)
        known |= {rotor_ids.mass(place): m, rotor_ids.radius(place): r, rotor_ids.station(place): z}
        known[rotor_ids.angle(place)] = math.radians(angle)
    found = model(sheet, (rotor_ids.unbalance("A"), rotor_ids.direction("A")), **known)
    assert found[rotor_ids.unbalance("A")] == pytest.approx(0.08347177, abs=0.5e-8)
    assert math.degrees(found[rotor_ids.direction("A")]) == pytest.approx(267.25744, abs=0.5e-5)


# --- a thousand rotors ------------------------------------------------------------------------------------

COUNTS, EACH = (1, 2, 3, 5, 8), 200


def sheet_of(count: int, **more: object) -> Calculation:
    """The sheet of some rotor of so many masses; its numbers do not matter."""
    masses = [{"m": "1 kg", "r": f"{50 + k} mm", "angle": f"{37 * k} deg", "z": f"{60 * k} mm"} for k in range(count)]
    given = {"planes": {"A": "30 mm", "B": "500 mm"}, "masses": masses, "correction": {"r": "80 mm"}}
    return RotorCalculation(
        Parameters.model_validate({**given, "bearings": ["0 mm", "600 mm"], "n": "900 rpm", **more})
    ).written()


def drawn(count: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Data of many rotors: planes and bearings anywhere, planes outside of the bearings, too."""
    known: dict[str, np.ndarray] = {}
    for place in map(str, range(1, count + 1)):
        known[rotor_ids.mass(place)] = rng.uniform(0.1, 5, EACH)
        known[rotor_ids.radius(place)] = rng.uniform(0.01, 0.3, EACH)
        known[rotor_ids.angle(place)] = rng.uniform(-math.pi, math.pi, EACH)
        known[rotor_ids.station(place)] = rng.uniform(-1, 1, EACH)
    for left, right in (("A", "B"), BEARINGS):
        known[rotor_ids.station(left)] = rng.uniform(-1, 0.6, EACH)
        known[rotor_ids.station(right)] = known[rotor_ids.station(left)] + rng.uniform(0.05, 1, EACH)
    known["rotor.n"] = rng.uniform(100, 5000, EACH)
    return known


def on_the_shaft(
    known: Mapping[str, np.ndarray], bodies: list[tuple[np.ndarray, np.ndarray, np.ndarray]], t: float
) -> np.ndarray:
    """The reactions [rotors, bearing, axis] at a time, by the equations of a body in space.

    Of each body: m r, its angle on the rotor, its station.  The unknowns are the forces of both bearings in x and y.
    """
    ω = known["rotor.n"] * math.pi / 30
    forces, moments = np.zeros((EACH, 3)), np.zeros((EACH, 3))
    for U, α, z in bodies:
        pull = (U * ω**2)[:, None] * np.stack((np.cos(α + ω * t), np.sin(α + ω * t), 0 * z), axis=1)
        forces += pull
        moments += np.cross(z[:, None] * np.array((0.0, 0.0, 1.0)), pull)
    equations = np.zeros((EACH, 4, 4))
    for unknown in range(4):
        bearing, axis = divmod(unknown, 2)
        along = np.eye(3)[axis]
        equations[:, :2, unknown] = along[:2]
        arm = known[rotor_ids.station(BEARINGS[bearing])][:, None] * np.array((0.0, 0.0, 1.0))
        equations[:, 2:, unknown] = np.cross(arm, along)[:, :2]
    right = -np.concatenate((forces[:, :2], moments[:, :2]), axis=1)
    return np.linalg.solve(equations, right[:, :, None])[:, :, 0].reshape(EACH, 2, 2)


@pytest.mark.parametrize("count", COUNTS)
def test_random_rotors(count: int) -> None:
    """No force and no couple are left in two planes; reactions are those of the turning shaft, before and after."""
    rng = np.random.default_rng(count)
    known, places = drawn(count, rng), [str(number) for number in range(1, count + 1)]
    two, one = sheet_of(count), sheet_of(count, planes={"A": "30 mm"})
    for sheet, planes in ((two, ("A", "B")), (one, ("A",))):
        wanted = [family(plane) for plane in planes for family in (rotor_ids.unbalance, rotor_ids.direction)]
        wanted += [rotor_ids.bearing_force(when, place) for when in (BEFORE, AFTER) for place in BEARINGS]
        found = model(sheet, wanted, **known)
        bodies = [
            (
                known[rotor_ids.mass(place)] * known[rotor_ids.radius(place)],
                known[rotor_ids.angle(place)],
                known[rotor_ids.station(place)],
            )
            for place in places
        ]
        corrections = [
            (found[rotor_ids.unbalance(plane)], found[rotor_ids.direction(plane)], known[rotor_ids.station(plane)])
            for plane in planes
        ]
        balanced = [*bodies, *corrections]
        every = sum(abs(U) for U, _, _ in balanced)
        assert np.all(np.abs(sum(U * np.exp(1j * α) for U, α, _ in balanced)) <= LEAST * every)
        if len(planes) == 2:
            couple = np.abs(sum(U * np.exp(1j * α) * z for U, α, z in balanced))
            assert np.all(couple <= LEAST * sum(abs(U * z) for U, _, z in balanced))
        ω = known["rotor.n"] * math.pi / 30
        b = known[rotor_ids.station("D")] - known[rotor_ids.station("C")]
        # What a reaction may be off: the rounding of its terms, which the arms about the bearings enlarge.
        dust = 10 * LEAST * every * ω**2 * (1 + 2 / b)
        for when, masses in ((BEFORE, bodies), (AFTER, balanced)):
            reactions = on_the_shaft(known, masses, t=rng.uniform(0, 1))
            for number, place in enumerate(BEARINGS):
                sizes = np.hypot(reactions[:, number, 0], reactions[:, number, 1])
                off = np.abs(found[rotor_ids.bearing_force(when, place)] - sizes)
                assert np.all(off <= dust)


def test_a_pure_couple_is_balanced_statically_only(tmp_path: Path) -> None:
    """Two equal masses on opposite sides, 100 mm apart: no force, a couple m r ω² a, borne by bearings 200 mm apart.

    One plane has nothing to correct; the forces on the bearings stay what they are.
    """
    file = tmp_path / "couple.yaml"
    masses = "[{m: 1 kg, r: 50 mm, angle: 0 deg, z: 0 mm}, {m: 1 kg, r: 50 mm, angle: 180 deg, z: 100 mm}]"
    rest = "planes: {A: 50 mm}, bearings: [-50 mm, 150 mm], n: 900 rpm"
    file.write_text(f"kind: rotor\nreport: {{language: en}}\nparameters: {{masses: {masses}, {rest}}}\n")
    case = opened(load(file))
    (position,) = solve(case.assignment)["positions"]
    ω = 2 * math.pi * 900 / 60
    force = 1 * 0.05 * ω**2 * 0.1 / 0.2
    for forces in position["bearings"].values():
        assert math.hypot(*forces["before"]) == pytest.approx(force)
        assert math.hypot(*forces["after"]) == pytest.approx(force)
    assert case.printed["rotor.U.A"].at(1) == 0
    assert text_of(case.document())


def test_a_rotor_without_any_unbalance_is_refused(tmp_path: Path) -> None:
    """Neither a force nor a couple: there is nothing to do."""
    file = tmp_path / "balanced.yaml"
    masses = "[{m: 1 kg, r: 50 mm, angle: 0 deg}, {m: 1 kg, r: 50 mm, angle: 180 deg}]"
    file.write_text(f"kind: rotor\nparameters: {{masses: {masses}, planes: {{A: 50 mm}}}}\n")
    with pytest.raises(AssignmentError, match="rotor-balanced"):
        load(file)
