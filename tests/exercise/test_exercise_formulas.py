"""Formulas in an exercise's file: the schema that editors use and the reader take and refuse the same text."""

from __future__ import annotations

import math
from typing import Any

import jsonschema
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pydantic_core import PydanticCustomError

from reportgen.assignment.fields import quantity
from reportgen.exercise.literal_symbols import MOST_NESTED, Stated, SymbolValue, Told, parsed
from reportgen.formula.evaluation import evaluate

LENGTH = Told(quantity("mm", least=0.1, below=1e5))
SYMBOLS = {name: SymbolValue().read(text) for name, text in {"r": "0.2 m", "l1": "1 m", "lambda": "2 m"}.items()}
NUMBERS, FORMULAS = LENGTH.schema()["anyOf"]

GOOD = [
    "300 mm",
    "0.3 m",
    "r",
    "-l1 + 2*r",
    "2*r+l1/3",
    " r - .5*l1 ",
    "sqrt(r**2 + l1^2)",
    "sqrt (2)*r",
    "r*(1 + sqrt(3)/2)",
    "((r + l1))/(2*(1 + 1))",
    "lambda/2 − r",
    "2*-r + l1",
    "r*(l1**3/l1^3)",
]
BAD = [
    "",
    "r l1",
    "2r",
    "2*r +",
    "(r",
    "r)",
    "()",
    "r + 100 mm",
    "r**4",
    "r**2**2",
    "r^0.5",
    "r^r",
    "2**3",
    "sqrt(2)",
    "sqrt",
    "sqrt(r",
    "sqrt(r, l1)",
    "exp(r)",
    "r(2)",
    "+r",
    "r // l1",
    "r % l1",
    "r == l1",
    "1e3*r",
    "0x10*r",
    "007*r",
    "1_0*r",
    "10000000*r",
    "rrrrrrrrrrrr",
    "r.real",
    "r[0]",
    "r; l1",
    "+".join(["r"] * 50),
    "(" * (MOST_NESTED + 1) + "r" + ")" * (MOST_NESTED + 1),
]


def accepts(schema: dict[str, Any], text: str) -> bool:
    return jsonschema.Draft7Validator(schema).is_valid(text)


def code(text: str) -> str:
    """The fault that the reader finds; "" for none."""
    try:
        LENGTH.read(Stated(text, SYMBOLS))
    except PydanticCustomError as fault:
        return str(fault)
    return ""


@pytest.mark.parametrize("text", GOOD)
def test_schema_and_reader_take_the_same(text: str) -> None:
    assert accepts(FORMULAS, text) != accepts(NUMBERS, text)
    assert code(text) in ("", "out-of-range")


@pytest.mark.parametrize("text", BAD)
def test_schema_and_reader_refuse_the_same(text: str) -> None:
    assert not accepts(FORMULAS, text)
    assert code(text) in ("no-formula", "not-a-number", "missing-unit", "unknown-unit")


@settings(max_examples=400, deadline=None)
@given(st.text("rl1 2.0+-*/^()sqt,m", max_size=14))
def test_schema_and_reader_agree_on_anything(text: str) -> None:
    """What the schema takes for a formula the reader does, too, and reads nothing else but quantities."""
    if accepts(FORMULAS, text):
        assert code(text) in ("", "no-such-symbol", "unlike-terms", "wrong-unit", "out-of-range", "not-finite")
    else:
        assert code(text) or accepts(NUMBERS, text)


@pytest.mark.parametrize("text", ["r/0", "r**2/(r - r)", "sqrt(r**2 - l1**2)", "0*r/0"])
def test_what_no_number_is_is_a_fault(text: str) -> None:
    assert code(text) == "not-finite"


SUMS = st.recursive(
    st.sampled_from(["r", "l1", "lambda", "2*r", "r/0.5"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from([" + ", "-", "*", " / "]), inner).map("".join),
        inner.map(lambda one: f"sqrt({one})**2" if "(" not in one else one),
    ),
    max_leaves=6,
)


@given(SUMS)
def test_a_formula_comes_to_what_it_says(text: str) -> None:
    """Against Python's own arithmetic, with the dimensions left out."""
    assume(code(text) in ("", "out-of-range"))
    values = {name: one.given.si for name, one in SYMBOLS.items()}
    names = {"sqrt": math.sqrt, "r": values["r"], "l1": values["l1"], "lambda_": values["lambda"]}
    formula, _ = parsed(text, SYMBOLS)
    assert float(evaluate(formula, values)) == pytest.approx(eval(text.replace("lambda", "lambda_"), names))
