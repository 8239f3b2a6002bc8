"""The literal answers of the worked examples: the published expressions, and values at random against the numbers.

The expressions are put out by the solution with symbols; the numbers are those of the linear system of the file with
other values for its symbols, which knows nothing of symbols.
"""

# ruff: noqa: E741 - l is what the source calls its lengths.

from __future__ import annotations

import random
import re
from functools import cache
from math import isclose, sqrt
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.exercise.case import ExerciseCase
from reportgen.formula import Expression
from reportgen.formula.evaluation import evaluate

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
NAMES = ["02", "05", "06", "09", "10", "12", "13", "14", "15", "16"]
UNITS = {"omega": "rad/s", "eps": "rad/s2", "v": "m/s", "v1": "m/s", "v2": "m/s"}
TIMES = 3

PUBLISHED = {
    "02": {
        "omega.2": lambda omega, r1, r2: omega * (r1 + r2) / r2,
        "v.B": lambda omega, r1, r2: sqrt(2) * omega * (r1 + r2),
        "v.C": lambda omega, r1, r2: 2 * omega * (r1 + r2),
    },
    "05": {
        "v.A1": lambda v, r: 0,
        "v.A2": lambda v, r: sqrt(2) * v,
        "v.A3": lambda v, r: 2 * v,
        "v.A4": lambda v, r: sqrt(2) * v,
    },
    "06": {
        "omega.2": lambda omega, l: 2 * omega / 3,
        "v.B": lambda omega, l: l * omega,
        "v.D": lambda omega, l: sqrt(5) * l * omega / 2,
    },
    "09": {
        "v.B": lambda omega, r: sqrt(3) * r * omega,
        "omega.4": lambda omega, r: sqrt(3) * omega / 3,
        "v.C": lambda omega, r: r * omega,
    },
    "10": {
        "omega.2": lambda omega, r, l: 2 * sqrt(3) * r * omega / (3 * l),
        "v.B": lambda omega, r, l: sqrt(3) * r * omega / 3,
        "v.C": lambda omega, r, l: sqrt(3) * r * omega / 3,
        "omega.4": lambda omega, r, l: sqrt(3) * r * omega / (3 * l),
    },
    "12": {"omega.1": lambda a1, a2, b1, b2, r1, r2, v, c, h: (b1 + b2) * r2 * v / (a1 * b2 * r2 - a2 * b1 * r1)},
    "13": {
        "omega.4": lambda v1, v2, x, y, a: (v1 * y - v2 * x) / (x**2 + y**2),
        "v.C": lambda v1, v2, x, y, a: (a * v1 * y + x * (x - a) * v2) / x**2,
    },
    "14": {"omega.1": lambda v, a, r: v / r, "eps.1": lambda v, a, r: a / r},
    "15": {"a.A1": lambda v, a, r: v**2 / r},
    "16": {
        "omega.3": lambda r, omega, eps: 0,
        "a.B": lambda r, omega, eps: 5 * r * omega**2 / 2,
        "eps.3": lambda r, omega, eps: sqrt(3) * omega**2 / 2,
    },
}


@cache
def case(name: str) -> ExerciseCase:
    return ExerciseCase(catalogue.load(FOLDER / f"{name}.yaml"))


def literal(name: str, id: str) -> Expression:
    derivation = case(name).literal
    assert derivation is not None
    found = derivation[id]
    assert found is not None
    return found


def symbols(name: str) -> dict[str, float]:
    return {one: value.given.si for one, value in case(name).exercise.given.symbols.items()}


@pytest.mark.parametrize(("name", "id"), [(name, id) for name in NAMES for id in PUBLISHED[name]])
def test_published_expressions(name: str, id: str) -> None:
    """The same function of the symbols, near the values of the file, where senses are the same."""
    chance = random.Random(f"{name}{id}")
    for _ in range(TIMES):
        values = {one: value * chance.uniform(0.9, 1.1) for one, value in symbols(name).items()}
        assert evaluate(literal(name, id), values) == pytest.approx(PUBLISHED[name][id](**values), rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_expressions_are_what_the_numbers_come_to(name: str, tmp_path: Path) -> None:
    """Every quantity in the derivation that is known by symbols, at random values of theirs."""
    derivation, chance = case(name).literal, random.Random(name)
    assert derivation is not None
    ids = [id for id in case(name).ledger.families if not id.startswith(("turn.", "centre.", "alpha."))]
    text = (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
    for index in range(TIMES):
        values = {one: value * chance.uniform(0.9, 1.1) for one, value in symbols(name).items()}
        other = ", ".join(f"{one}: {value!r} {_unit(name, one)}" for one, value in values.items())
        path = tmp_path / f"{name}-{index}.yaml"
        path.write_text(re.sub(r"symbols: \{.*\}", f"symbols: {{{other}}}", text), encoding="utf-8")
        ledger = ExerciseCase(catalogue.load(path)).ledger
        compared = 0
        for id in ids:
            found = derivation[id]
            if found is not None and id in ledger:
                number = float(ledger[id].values[0])
                assert isclose(float(evaluate(found, values)), number, rel_tol=1e-9, abs_tol=1e-9), id
                compared += 1
        assert compared >= len(PUBLISHED[name])


def _unit(name: str, symbol: str) -> str:
    if symbol == "a":
        return "m" if name == "13" else "m/s2"
    return UNITS.get(symbol, "m")


@pytest.mark.parametrize("name", NAMES)
def test_every_answer_is_an_expression(name: str) -> None:
    derivation = case(name).literal
    assert derivation is not None
    assert [one.id for one in case(name).exercise.asked if one.what != "centre" and derivation[one.id] is None] == []
