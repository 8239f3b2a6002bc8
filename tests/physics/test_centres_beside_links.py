"""Mass centres beside their links, given by two coordinates, in the machines of the catalogue."""

from __future__ import annotations

import random
from pathlib import Path

import linkages as made
import newton_euler as ne
import numpy as np
import pytest
from agreement import weights

from reportgen import api
from reportgen.base.yaml_source import read_source
from reportgen.cases import open_case
from reportgen.page.pulled_values import placing_values
from reportgen.report.context import ReportContext
from tests.report import trees
from tests.report.calculator import misses

SAME = 1e-9
"""Of the greatest value over the turn; positions are well conditioned."""

FOUR_BAR = "AB: 120 mm, BC: 340 mm, CD: 280 mm, AD: 400 mm, omega1: 20 rad/s, epsilon1: 30 rad/s2"
SLIDER_CRANK = "r: 150 mm, l: 600 mm, e: 40 mm, guide: 20 deg, n: 300 rpm"
TOGGLE = "OA: 60 mm, AB: 232 mm, BD: 250 mm, D: {x: -300 mm, y: 220 mm}, n: 150 rpm"
SIX_BAR = (
    "AB: 34 mm, AC: 90 mm, CD: 60 mm, CE: 30 mm, EF: 110 mm, D: {x: -10 mm, y: -106 mm}, guide: -73 mm, n: 850 rpm"
)
LEVER = "AB: 40 mm, AC: 80 mm, CD: 150 mm, omega1: 10 rad/s"
V_ENGINE = "AB: 91 mm, BC: 253 mm, BD: 66 mm, DE: 196 mm, alpha: 50 deg, beta: 70 deg, n: 1800 rpm"
KINDS = {
    "four-bar": (FOUR_BAR, (1, 2, 3)),
    "slider-crank": (SLIDER_CRANK, (1, 2)),
    "toggle-press": (TOGGLE, (1, 2, 3, 4)),
    "lever-six-bar": (SIX_BAR, (1, 2, 3, 4)),
    "slotted-lever": (LEVER, (1, 3)),
    "engine-v": (V_ENGINE, (1, 2, 4)),
}
"""Parameters of each kind, and its links with mass centres that may lie beside them."""


def written(folder: Path, kind: str, parameters: str, direction: str = "anticlockwise") -> Path:
    """Return a file of a kind with these parameters."""
    path = folder / f"{kind}.yaml"
    text = f"kind: {kind}\nreport: {{language: en}}\npositions: {{count: 8, direction: {direction}}}\n"
    path.write_text(f"{text}parameters: {{{parameters}}}\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("kind", KINDS)
def test_forces_against_a_witness(kind: str, tmp_path: Path) -> None:
    """Random centres, in front of, behind and beside the link: torque and velocities of the witness, both senses."""
    chance, (parameters, links) = random.Random(kind), KINDS[kind]
    for direction in ("anticlockwise", "clockwise"):
        at = {link: (chance.randint(-40, 90), chance.choice((-1, 1)) * chance.randint(5, 60)) for link in links}
        bodies = "".join(
            f", S{link}: [{x} mm, {y} mm], m{link}: {chance.randint(5, 40) / 10} kg, J{link}: 0.01 kg m2"
            for link, (x, y) in at.items()
        )
        case = open_case(written(tmp_path, kind, parameters + bodies, direction), "en")
        analysis = case.analysis
        linkage = analysis.machine.linkage
        parts, joints, _ = made.told(linkage)
        for link, (x, y) in at.items():
            assert parts[link].centre == pytest.approx(complex(x, y) / 1e3, abs=1e-15)
        torques, speeds = [], {link: [] for link in links}
        for k, pose in enumerate(made.poses(analysis.motion)):
            loads = weights(parts, pose, linkage.gravity)
            rate = float(analysis.motion.rate[k])
            acceleration = analysis.machine.turn * analysis.machine.acceleration
            answer = ne.solve(parts, joints, True, rate, pose, loads, 1e4, acceleration)
            assert answer is not None
            torques.append(answer.effort)
            for link in links:
                origin, omega = answer.velocity[link]
                arm = parts[link].centre * np.exp(1j * pose[link][1])
                speeds[link].append(abs(origin + 1j * omega * arm))
        scale = max(map(abs, torques))
        np.testing.assert_allclose(case.ledger["M.eq"].values, torques, rtol=0, atol=SAME * scale)
        for link in links:
            found = np.broadcast_to(case.ledger[f"v.S{link}"].values, (len(torques),))
            np.testing.assert_allclose(found, speeds[link], rtol=SAME, atol=SAME)


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize("across", [-60, 0, 25])
@pytest.mark.parametrize("along", [-70, 90])
def test_closed_formulas_agree_with_plans(along: int, across: int, direction: str, tmp_path: Path) -> None:
    place = f"[{along} mm, {across} mm]"
    for kind, more in (("four-bar", f", E: {{along: {along} mm, across: {across} mm}}"), ("slider-crank", "")):
        path = written(tmp_path, kind, f"{KINDS[kind][0]}, m2: 3 kg, S2: {place}{more}", direction)
        ledger = open_case(path, "en").ledger
        for id in ("v.S2", "a.S2", *(("v.E", "a.E") if more else ())):
            np.testing.assert_allclose(ledger[f"f.{id}"].values, ledger[id].values, rtol=SAME)


@pytest.mark.parametrize(
    ("kind", "share", "place"), [("four-bar", "s2: 0.5", "170"), ("slider-crank", "s: 0.25", "150")]
)
def test_a_centre_on_the_link_in_both_forms(kind: str, share: str, place: str, tmp_path: Path) -> None:
    forms = (f"{share}, m2: 3 kg", f"S2: [{place} mm, 0 mm], m2: 3 kg")
    results = [api.solve(api.load(written(tmp_path, kind, f"{KINDS[kind][0]}, {form}"))) for form in forms]
    np.testing.assert_allclose(
        *([one["points"]["S2"]["a"] for one in each["positions"]] for each in results), rtol=SAME
    )
    first, second = ([one["balancing_torque"]["equilibrium"] for one in each["positions"]] for each in results)
    assert first == pytest.approx(second)


def test_faults_of_a_place_given_twice(tmp_path: Path) -> None:
    for kind, share in (("four-bar", "s2: 0.5"), ("slider-crank", "s: 0.5"), ("toggle-press", "s4: 0.5")):
        link = 4 if "4" in share else 2
        path = written(tmp_path, kind, f"{KINDS[kind][0]}, {share}, S{link}: [80 mm, 20 mm]")
        (fault,) = api.check(path)
        assert (fault.code, fault.location.line) == ("both-given", 4)
    (fault,) = api.check(written(tmp_path, "four-bar", f"{FOUR_BAR}, S2: [80 mm]"))
    assert fault.code == "too-few"


@pytest.mark.parametrize("language", ["vi", "en", "ru", "zh"])
def test_the_task_gives_the_coordinates(language: str, tmp_path: Path) -> None:
    path = written(tmp_path, "four-bar", f"{FOUR_BAR}, m2: 3 kg, S2: [80 mm, -20 mm], m1: 1 kg, S1: [10 mm, 5 mm]")
    report = ReportContext(open_case(path, language))
    rows = {id: name for id, name in report.given_names.items() if id in report.ledger}
    assert {"S1.along", "S1.across", "S2.along", "S2.across"} <= rows.keys()
    assert "BC" in rows["S2.across"]
    assert "AB" in rows["S1.along"]


def test_a_pulled_centre_changes_its_coordinates(tmp_path: Path) -> None:
    path = written(tmp_path, "four-bar", f"{FOUR_BAR}, m2: 3 kg, S2: [80 mm, 20 mm]")
    _, values = placing_values(read_source(path), path)
    followed = [value.where for value in values if "S2" in value.points]
    assert followed == [("parameters", "S2", 0), ("parameters", "S2", 1)]


@pytest.mark.parametrize("kind", ["four-bar", "slider-crank"])
def test_printed_lines_recompute(kind: str, tmp_path: Path) -> None:
    """The printed formulas give the printed results, so a student's own values are followed through them, too."""
    parameters, links = KINDS[kind]
    bodies = "".join(f", S{link}: [7{link} mm, {30 - 7 * link} mm], m{link}: 2 kg" for link in links)
    case = open_case(written(tmp_path, kind, parameters + bodies, "clockwise"), "en")
    lines = trees.lines(trees.every_chain(case.printed), "en")
    assert len(lines) > 100
    assert misses(lines) == []


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
def test_the_torque_of_a_shaper_by_its_formula(direction: str, tmp_path: Path) -> None:
    """The crank's weight acts beside its line: the closed formula against the equilibrium of the groups."""
    lengths = "a: 270 mm, b: 520 mm, l3: 550 mm, l4: 100 mm, H: 420 mm, n: 89 rpm, epsilon1: 5 rad/s2"
    path = written(tmp_path, "shaper", f"{lengths}, m1: 4 kg, S1: [30 mm, 40 mm], cutting: {{F: 1000 N}}", direction)
    ledger = open_case(path, "en").ledger
    scale = float(abs(ledger["M.eq"].values).max())
    np.testing.assert_allclose(ledger["f.M"].values, ledger["M.eq"].values, rtol=0, atol=SAME * scale)
