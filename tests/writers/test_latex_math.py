"""Formulas as LaTeX mathematics: their parentheses, marks and breaks."""

from __future__ import annotations

import re

import pytest

from reportgen.base.errors import TypesetterError
from reportgen.formula import Chain, Expression, Negative, Number, Product, Ref, Sum, Symbol
from reportgen.writers.latex_math import LatexFormulas

A, B, C = Symbol("a"), Symbol("b"), Symbol("c")
VIETNAMESE = LatexFormulas("vi")


def plain(source: str) -> str:
    """A formula without the marks that only lines and gaps need."""
    return re.sub(r"\\(relbreak|binbreak|dotbreak|mathopen\{\})|\s+", "", source)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (A - (B + C), "a-(b+c)"),
        ((A + B) * C, r"(a+b)\cdotc"),
        (Product((A, Number(-1.5, 1))), r"a\cdot(-1{,}5)"),
        (Sum((A, Number(-1.5, 1))), "a+(-1{,}5)"),
        (Negative(Negative(A)), "-(-a)"),
        ((-A) ** 2, "(-a)^{2}"),
        ((A**2) ** 3, "(a^{2})^{3}"),
        ((A / B) ** 2, r"\left(\frac{a}{b}\right)^{2}"),
        ((A + B) / C, r"\frac{a+b}{c}"),
        (Symbol("a", "BA", "n", "vector"), r"\vec{a}_{\mathrm{BA}}^{\mathrm{n}}"),
        (Symbol("pb", over="segment"), r"\overline{\mathit{pb}}"),
        (Symbol("ps", "2", over="segment"), r"\overline{\mathit{ps}_{2}}"),
        (Symbol("πa", sup="′", over="segment"), r"\overline{\mathit{πa}^{\prime}}"),
        (Symbol("l", "O1A"), r"l_{\mathrm{O}_{\scriptstyle{1}}\mathrm{A}}"),
        (Symbol("p", "3", "′"), r"p_{3}^{\prime}"),
        (Number(10.943, 3, "m/s"), r"10{,}943\,\text{m/s}"),
        (Number(60, None, "°"), r"60\text{°}"),
        (Number(-0.0001, 2, "N"), r"0{,}00\,\text{N}"),
    ],
)
def test_formulas(expression: Expression, expected: str) -> None:
    assert plain(VIETNAMESE.math(expression)) == expected


def test_english_numbers_have_a_point() -> None:
    assert LatexFormulas("en").math(Number(1.5, 1)) == "1.5"


def test_a_chain_is_cut_at_its_first_relation() -> None:
    left, rest = VIETNAMESE.aligned(Chain((A, B, C)))
    assert (plain(left), plain(rest)) == ("a", "=b=c")


def test_a_reference_nobody_substituted_is_refused() -> None:
    with pytest.raises(TypesetterError, match="v_A"):
        VIETNAMESE.math(Ref("v_A"))
