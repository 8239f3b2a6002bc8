"""Torques and power of planetary trains against equilibrium and energy; fewer teeth than 17, with a warning."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from reportgen import api
from reportgen.cases import open_case
from reportgen.gears import train_ids
from reportgen.gears.tooth_numbers import Demand, Teeth, choice
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from tests.marking import students
from tests.marking.designs import named
from tests.report import built, trees
from tests.report.calculator import misses

SAME = 1e-9
TRAINS = {
    "single": "scheme: single, u: 6",
    "double": "scheme: double, u: 10, tolerance: 0.02",
    "double-outer": "scheme: double-outer, u: -5, tolerance: 0.02",
    "double-inner": "scheme: double-inner, u: 40, tolerance: 0.05, drives: carrier",
    "inner-by-wheel": "scheme: double-inner, u: 0.4, tolerance: 0.05",
}
ROWS: tuple[tuple[list[list[int]], list[list[int]]], ...] = (
    ([], []),
    ([[19, 40], [20, 30]], [[18, 36]]),
    ([[18, -72]], [[20, 50], [25, -60], [-90, 30]]),
)
"""Rows of ordinary wheels before and behind the train; a negative number is an inner wheel."""


def written(folder: Path, text: str) -> Path:
    path = folder / "train.yaml"
    begin = "kind: planetary-train\nreport: {language: en}\n"
    path.write_text(f"{begin}parameters: {{{text}, k: 2, m: 2 mm, n_in: 960 rpm}}\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("known", ["driving", "driven", "fixed"])
@pytest.mark.parametrize("train", TRAINS)
def test_equilibrium_and_energy(train: str, known: str, tmp_path: Path) -> None:
    """The members are in equilibrium; seen from the carrier, what leaves the meshes is η₀ of what enters them."""
    chance = random.Random(train + known)
    M = chance.randint(5, 400)
    for loss in (True, False):
        for before, behind in ROWS:
            text = f"{TRAINS[train]}, before: {before}, behind: {behind}, torque: {{M: {M} N m, of: {known}}}"
            text += ", efficiency: {outer: 0.995, inner: 0.998}" if loss else ""
            case = open_case(written(tmp_path, text), "en")
            value = {id: float(family.values[0]) for id, family in case.ledger.families.items() if family.values.size}
            ω = {name: value[train_ids.omega(name)] for name in ("1", "H")}
            T = {name: value[train_ids.torque(name)] for name in ("1", "H", "3")}
            scale = max(map(abs, T.values()))
            assert sum(T.values()) == pytest.approx(0, abs=SAME * scale)
            powers = T["1"] * (ω["1"] - ω["H"]), T["3"] * (0 - ω["H"])
            entering, leaving = max(powers), min(powers)
            η0 = value[train_ids.efficiency("0")] if loss else 1.0
            assert -leaving == pytest.approx(η0 * entering, rel=SAME)
            driver, driven = ("H", "1") if "carrier" in TRAINS[train] else ("1", "H")
            assert T[driver] * ω[driver] > 0 > T[driven] * ω[driven]
            # The whole drive, by its ends: what comes in, less the losses, is what goes out.
            η_before, η_behind = (
                math.prod((0.998 if min(row) < 0 else 0.995) if loss else 1.0 for row in rows)
                for rows in (before, behind)
            )
            rates = [value[id] * math.pi / 30 for id in ("train.n.in", "train.n.reached")]
            first = T[driver] * ω[driver] / η_before / rates[0]
            last = T[driven] * ω[driven] * η_behind / rates[1]
            given = {"driving": first, "driven": abs(last), "fixed": abs(T["3"])}[known]
            assert given == pytest.approx(M, rel=SAME)
            for name, torque in (("in", first), ("out", last)):
                assert value.get(train_ids.torque(name), torque) == pytest.approx(torque, rel=SAME)
            assert value["train.P.mesh"] == pytest.approx(powers[0], rel=SAME)
            share = abs(powers[0]) / (T[driver] * ω[driver])
            assert value["train.share"] == pytest.approx(share, rel=SAME)
            # Both powers meet at wheel 1; if they have opposite signs, the smaller one circulates.
            coupled = T["1"] * ω["H"]
            circle = min(abs(powers[0]), abs(coupled)) if powers[0] * coupled < 0 else None
            assert value.get("train.P.circulating") == (None if circle is None else pytest.approx(circle, rel=SAME))


def test_a_sun_and_a_ring_of_textbooks(tmp_path: Path) -> None:
    """Ring at rest, without losses: the carrier has 1 + z₃/z₁ times the torque of the sun, the ring z₃/z₁ times."""
    case = open_case(written(tmp_path, "scheme: single, u: 5, z: {from: 18}, torque: {M: 10 N m}"), "en")
    assert case.train.teeth == Teeth(18, 27, 27, 72)  # type: ignore[attr-defined]
    torques = [float(case.ledger[train_ids.torque(name)].values[0]) for name in ("1", "H", "3")]
    assert torques == pytest.approx([10, -50, 40])


@pytest.mark.parametrize("language", ["vi", "en", "ru", "zh"])
def test_the_report_has_torques_in_every_language(language: str, tmp_path: Path) -> None:
    text = "scheme: single, u: 6, least_teeth: 14, before: [[15, 30]], torque: {M: 10 N m, of: fixed}"
    path = written(tmp_path, text)
    case = open_case(path, language)
    assert case.document().blocks
    ids = {"train.M.1", "train.M.H", "train.M.3", "train.M.in", "train.P.mesh", "train.x.1", "train.x.4"}
    assert ids <= case.ledger.families.keys()
    assert misses(trees.lines(trees.every_chain(case.printed), language)) == []
    assert ids <= set(marking_scheme(case).rows)


@pytest.mark.parametrize(
    ("mistake", "where"), [("train-torque-inverse", "train.M.H"), ("train-torque-support", "train.M.3")]
)
def test_usual_mistakes_have_names(mistake: str, where: str, tmp_path: Path) -> None:
    scheme = marking_scheme(built.case(written(tmp_path, "scheme: single, u: 6, torque: {M: 10 N m}"), "en"))
    sheet = students.written(scheme, students.worked_out(scheme, named(scheme, mistake, where)))
    assert {cell.mistake for cell in mark(scheme, sheet).first_errors} == {mistake}


def test_an_inner_wheel_of_a_row_keeps_the_sense(tmp_path: Path) -> None:
    """960 rpm through 1:4 without reversal, then u = 6: 40 rpm in the same sense, as the speed that is asked for."""
    case = open_case(written(tmp_path, "scheme: single, n_out: 40 rpm, before: [[18, -72]]"), "en")
    assert [float(case.ledger[id].values[0]) for id in ("train.u", "train.n.reached")] == pytest.approx([6, 40])


# --- fewer teeth ------------------------------------------------------------------------------------------


def test_least_teeth_allows_undercut_wheels() -> None:
    """u = 6 with two satellites: z₂ = 2 z₁, z₃ = 5 z₁; from 14 teeth on, 14/28/70 is the smallest that fits."""
    few = choice(Demand("single", 6, 0.0, 2, 14, 120, outer=14))
    usual = choice(Demand("single", 6, 0.0, 2, 14, 120))
    assert tuple(few.sets[0]) == (14, 28, 28, 70)
    assert [row[0] for row in few.sets.tolist()] == [*range(14, 25)]
    assert [row[0] for row in usual.sets.tolist()] == [*range(17, 25)]
    assert few.chosen.undercut == ({"1": few.chosen.teeth.z1} if few.chosen.teeth.z1 < 17 else {})


def test_undercut_is_a_warning(tmp_path: Path) -> None:
    """The shift that avoids it is (17 − z)/17."""
    (warning,) = api.examine(written(tmp_path, "scheme: single, u: 6, least_teeth: 14"))
    assert (warning.code, warning.level) == ("train-undercut", "warning")
    assert "z1 = 14" in warning.message
    assert "0.176" in warning.message
    assert api.examine(written(tmp_path, "scheme: single, u: 6")) == []


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("scheme: single, u: 6, before: [[14, 30]]", ["out-of-range"]),
        ("scheme: single, u: 6, before: [[18, 30], [18, -20]]", ["out-of-range"]),
        ("scheme: single, u: 6, behind: [[-18, -60]]", ["out-of-range"]),
        ("scheme: single, u: 6, before: [[18, -26]]", []),
        ("scheme: single, u: 6, least_teeth: 7", ["out-of-range"]),
        ("scheme: single, u: 6, torque: {M: 0 N m}", ["out-of-range"]),
        (
            "scheme: double-inner, u: 0.02, tolerance: 0.05, efficiency: {inner: 0.9}, torque: {M: 2 N m}",
            ["train-locked"],
        ),
    ],
)
def test_faults(text: str, codes: list[str], tmp_path: Path) -> None:
    assert [fault.code for fault in api.check(written(tmp_path, text))] == codes
