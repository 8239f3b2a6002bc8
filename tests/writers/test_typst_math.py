"""Formulas as Typst mathematics: what they mean, how they read, where their rows break."""

from __future__ import annotations

import math
import re

import pymupdf
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen.base.errors import TypesetterError
from reportgen.document import Equation, InlineMath, Paragraph
from reportgen.formula import (
    Call,
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    Symbol,
    Term,
    VectorEquation,
)
from reportgen.formula.evaluation import evaluate
from reportgen.writers.latex_math import LatexFormulas
from reportgen.writers.typst_math import TypstFormulas
from tests.writers import sample
from tests.writers.pages import MM, body_of, by_typst, plain, text_of

VIETNAMESE = TypstFormulas("vi")
NUMBERS = st.builds(Number, st.integers(-99, 99).map(lambda n: n / 4), st.just(2), st.sampled_from(["", "mm"]))
EXPRESSIONS: st.SearchStrategy[Expression] = st.recursive(
    NUMBERS,
    lambda inner: st.one_of(
        st.lists(inner, min_size=1, max_size=3).map(lambda terms: Sum(tuple(terms))),
        st.lists(inner, min_size=1, max_size=3).map(lambda factors: Product(tuple(factors))),
        inner.map(Negative),
        st.builds(Fraction, inner, NUMBERS.filter(lambda number: number.printed != 0)),
        inner.map(lambda base: Power(base, Number(2))),
        inner.map(lambda of: Root(Power(of, Number(2)))),
        st.builds(lambda name, of: Call(name, (of,)), st.sampled_from(["sin", "cos", "abs"]), inner),
    ),
    max_leaves=8,
)


def reread(source: str) -> float:
    """The value of a written formula by the rules of reading: powers, then products, then sums."""
    text = re.sub(r' thin "mm"', "", source)
    text = re.sub(r'"([^"]*)"', lambda found: found[1].replace(",", ".").replace("−", "-"), text)
    text = re.sub(r"\b(sin|cos)\^\(2\) (\([^()]*\)|-?[\d.]+)", r"(\1(\2))**2", text)
    text = re.sub(r"\b(sin|cos) (-?[\d.]+)", r"\1(\2)", text)
    text = text.replace("dot.c", "*").replace("−", "-").replace("^", "**")
    text = text.replace("frac(", "quotient(").replace("sqrt (", "sqrt(")
    names = {
        "sin": math.sin,
        "cos": math.cos,
        "abs": abs,
        "sqrt": math.sqrt,
        "quotient": lambda top, bottom: top / bottom,
    }
    return float(eval(text, {"__builtins__": {}}, names))


def nested_call_powers(node: Expression) -> bool:
    """sin²(…) with inner parentheses, which the simple reader above does not follow."""
    return "sin^" in VIETNAMESE.math(node) or "cos^" in VIETNAMESE.math(node)


@settings(max_examples=200, deadline=None)
@given(EXPRESSIONS)
def test_a_written_expression_means_what_it_evaluates_to(node: Expression) -> None:
    source = VIETNAMESE.math(node)
    assert not re.search(r'(dot\.c|[+−]) ("?−)', source), "two signs in a row"
    if not nested_call_powers(node):
        assert reread(source) == pytest.approx(float(evaluate(node)), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("node", "printed"),
    [
        (2 * (Symbol("a") + Symbol("b")), "2 · (a + b)"),
        (Product((Symbol("a"), Number(-1.5, 1))), "a · (−1,5)"),
        (Symbol("a") - (Symbol("b") + Symbol("c")), "a − (b + c)"),
        (Negative(Negative(Symbol("a"))), "−(−a)"),
        (Power(Number(-3.0, 1), Number(2)), "(−3,0)2"),
        (Number(-0.2189, 4, "m/s"), "−0,2189 m/s"),
        (Number(60, None, "°"), "60°"),
        (Number(-0.00001, 2), "0,00"),
        (Call("sin", (Number(35.26, 2, "°"),)), "sin 35,26°"),
        (Call("cos", (Symbol("a") + Symbol("b"),)), "cos(a + b)"),
        (sample.expressions()[-1], "vA = ω1 · R = 230,3835 · 0,0475 = 10,943 m/s"),
    ],
)
def test_formulas_read_in_order(node: Expression, printed: str) -> None:
    """pdf text drops some of the small gaps, so gaps do not count here."""
    found = text_of(Paragraph((InlineMath(node),)))
    assert found.replace(" ", "") == printed.replace(" ", "")


def test_decimal_mark_follows_the_language() -> None:
    assert VIETNAMESE.math(Number(1.5, 1)) == '"1,5"'
    assert TypstFormulas("en").math(Number(1.5, 1)) == '"1.5"'


def test_a_reference_without_substitute_is_refused() -> None:
    with pytest.raises(TypesetterError, match="v_a"):
        VIETNAMESE.math(Ref("v_a") + 1.0)


def long_sum(count: int) -> Expression:
    return Sum(tuple(Product((Symbol("R", str(index)), Number(-12.75, 2))) for index in range(count)))


@pytest.mark.parametrize(
    "row",
    [
        sample.wide_chain(),
        Chain((long_sum(14), Number(0))),
        Chain((Symbol("M"), long_sum(30), Number(-3.5, 1, "N·m")), note="vì một lý do dài dòng " * 2),
        Chain((Symbol("M"), Product(tuple(Number(-1234.5, 1) for _ in range(20))), Number(1))),
        Chain((Symbol("M"), Fraction(long_sum(12), Symbol("l")), Number(1.25, 2))),
        Sum(tuple(Symbol("x", str(index)) for index in range(60))),
        VectorEquation(
            (tuple(Term(Symbol("R", str(index), over="vector"), ("∥ AB", None)) for index in range(25)),),
            ("phương", "độ lớn"),
        ),
    ],
)
def test_a_wide_row_breaks_within_the_margins(row: Expression) -> None:
    (page,) = by_typst(Equation((row, sample.expressions()[-1]), key="k", number="12.34"))
    words = page.get_text("words", clip=body_of(page))
    assert min(word[0] for word in words) >= 30 * MM - 0.5
    assert max(word[2] for word in words) <= page.rect.width - 20 * MM + 0.5
    boxes = [pymupdf.Rect(word[0], word[1] + 3, word[2], word[3] - 3) for word in words if "12.34" in word[4]]
    assert len(boxes) == 1
    assert not [word[4] for word in words if boxes[0].intersects(word[:4]) and "12.34" not in word[4]]


def test_unknowns_of_a_vector_equation_stand_under_their_terms() -> None:
    (page,) = by_typst(Equation((sample.velocity_equation(),)))
    words = [(plain(word[4]), (word[0] + word[2]) / 2, word[1]) for word in page.get_text("words", clip=body_of(page))]
    marks = sorted((y, x) for word, x, y in words if word == "?")
    assert len(marks) == 4
    relation = next(x for word, x, _ in words if "=" in word)
    assert sum(x < relation for _, x in marks) == 2


def test_slashed_fractions_keep_what_they_divide_by_together() -> None:
    a, b, c = Symbol("a"), Symbol("b"), Symbol("c")
    for writer, mark in ((TypstFormulas("en"), '"/"'), (LatexFormulas("en"), "/")):
        assert writer.math(Fraction(a, b), slashed=True) == f"{writer.math(a)}{mark}{writer.math(b)}"
        assert writer.math(Fraction(a, Product((b, c))), slashed=True).endswith(
            f"{mark}({writer.math(Product((b, c)))})"
        )
        assert (
            writer.math(Fraction(Sum((a, b)), c), slashed=True) == f"({writer.math(Sum((a, b)))}){mark}{writer.math(c)}"
        )
