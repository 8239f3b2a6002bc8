"""Formulas, numbers and blocks as plain text."""

from __future__ import annotations

import pytest

from reportgen.document import (
    BlankLine,
    Contents,
    Cover,
    Document,
    InlineMath,
    LineBreak,
    PageBreak,
    Text,
    Value,
    Words,
    plain,
    text_of,
)
from reportgen.formula import PI, Chain, Expression, Negative, Number, Symbol, Term, VectorEquation, call, sqrt
from reportgen.formula.plain_text import formula

A, B, C = Symbol("a"), Symbol("b", "2"), Symbol("c", "BA", "n")


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (C, "c_BA^n"),
        (A + Negative(B) + -2.0, "a − b_2 + (−2)"),
        (A - (B + C), "a − (b_2 + c_BA^n)"),
        (A * (B + C) * 3, "a·(b_2 + c_BA^n)·3"),
        (A * B / (B * C), "a·b_2/(b_2·c_BA^n)"),
        (A / (B / C), "a/(b_2/(c_BA^n))"),
        ((-A) ** 2, "(−a)^2"),
        (-(A + B), "−(a + b_2)"),
        (sqrt(A + PI), "√(a + π)"),
        (call("arctan2", A, B), "arctan2(a; b_2)"),
        (Chain((A, Number(0.0, 2, "m/s")), "dead centre"), "a = 0,00 m/s (dead centre)"),
        (Negative(Number(12.345, 2, "°")), "−12,35°"),
        (
            VectorEquation(((Term(A, ("x", A)),), (Term(B, (None,)), Term(C, (), -1))), ("line", "size")),
            "a = b_2 − c_BA^n\nline: x | ? | \nsize: a |  | ",
        ),
    ],
)
def test_a_formula_reads_without_ambiguity(expression: Expression, text: str) -> None:
    assert formula(expression, "vi") == text


def test_inlines_read_as_one_line() -> None:
    line = (Text("v"), LineBreak(), InlineMath(A), Text(" = "), Value(Number(-0.5, 1, "mm")))
    assert plain(line, "en") == "v a = −0.5 mm"


def test_the_front_matter_is_text_too() -> None:
    cover = Cover(("University",), ("Title",), ("Sub",), (("Student", "N"), ("Class", "")), "Place, 2011")
    blocks = (cover, Contents("Contents"), PageBreak(), BlankLine("Name"))
    document = Document("en", "T", "A", ("", ""), ("", ""), Words("F", "T", "C", "p", "c", "n", "s"), blocks)
    assert text_of(document).splitlines() == [
        *("University", "Title", "Sub", "Student: N", "Class: …", "Place, 2011", "Contents", "Name …")
    ]
