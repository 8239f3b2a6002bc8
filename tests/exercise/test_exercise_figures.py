"""Printed figures of exercises with data of their own: right to a unit of the last decimal, given symbols as given."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from reportgen.base.errors import AssignmentError
from reportgen.cases import open_case
from reportgen.exercise.case import ExerciseCase
from reportgen.formula import vocabulary
from tests.lanes import matrix

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))
TELLING = ["08", "09", "14"]
QUANTITY = re.compile(r"(?<![\w.])(-?[0-9.]+) (mm|cm|m|rad/s2|rad/s|m/s2|m/s|rpm)(?![\w/])")


def redrawn(name: str, rng: np.random.Generator, equations: bool) -> str:
    """An exercise on another scale and with other speeds; lengths are exact, so that what touches goes on to."""
    text = re.sub(r"\n  methods:.*", "", (FOLDER / f"{name}.yaml").read_text(encoding="utf-8"))
    scale = round(float(rng.uniform(0.4, 2.2)), 2)

    def other(found: re.Match[str]) -> str:
        length = found[2] in ("mm", "cm", "m")
        value = float(found[1]) * (scale if length else float(rng.uniform(0.5, 1.9)))
        return f"{value:.{15 if length else 3}g} {found[2]}"

    return QUANTITY.sub(other, text) + ("\n  methods: [equations]\n" if equations else "")


@pytest.mark.parametrize("name", matrix(NAMES, TELLING))
def test_what_is_printed_is_right_to_a_unit_of_its_last_decimal(name: str, tmp_path: Path) -> None:
    rng, checked = np.random.default_rng(int(name)), 0
    for equations in (False, True, False, True):
        file = tmp_path / "exercise.yaml"
        file.write_text(redrawn(name, rng, equations), encoding="utf-8")
        try:
            case = open_case(file, "en")
        except AssignmentError:
            continue  # a system that these lengths cannot make, or one with more coordinates
        assert isinstance(case, ExerciseCase)
        for id, family in case.worked.ledger.families.items():
            if family.hidden or family.is_plane:
                continue
            number, exact = case.worked.printed.number(id), family.values / family.how.scale
            unit = 10.0 ** -(number.decimals or 0) if number.value else 10.0 ** -(case.worked.printed.decimals[id] or 9)
            apart = vocabulary.distance(id, np.radians(number.printed), np.radians(exact)) * 180 / math.pi
            assert float(apart[0]) <= unit * (1 + 1e-6) if number.decimals is not None else 1e-9, id
            checked += 1
    assert checked > 5


def test_a_given_symbol_has_its_own_value(tmp_path: Path) -> None:
    """ε₁ l = a is 4.4 where 4.4 is given, and not what is left of it by way of ε₁."""
    text = (FOLDER / "14.yaml").read_text(encoding="utf-8")
    assert "r: 300 mm, v: 2 m/s, a: 3 m/s2" in text
    file = tmp_path / "exercise.yaml"
    for r, v, a in ((370, 1.7, 4.4), (310, 2.3, 4.7), (270, 0.7, 1.9)):
        data = text.replace("r: 300 mm, v: 2 m/s, a: 3 m/s2", f"r: {r} mm, v: {v} m/s, a: {a} m/s2")
        file.write_text(f"{data}\n  methods: [equations]\n", encoding="utf-8")
        case = open_case(file, "en")
        assert isinstance(case, ExerciseCase)
        printed = case.worked.printed
        shown = {abs(printed.number(id).value) for id in printed.families if not printed[id].hidden}
        assert {r / 1e3, v, a} <= shown
        near = [one for one in shown for given in (v, a) if one != given and math.isclose(one, given, rel_tol=1e-4)]
        assert near == []
