"""Formulas in words: what sounds alike prints alike, units go with their numbers, letters are told apart."""

from __future__ import annotations

from typing import Any

import pytest

from reportgen.base.errors import TemplateError
from reportgen.base.template_folders import languages, search_path
from reportgen.base.units import PLAIN, Language, write
from reportgen.base.words import load_words
from reportgen.document import Words
from reportgen.formula import (
    Call,
    Chain,
    Expression,
    Fraction,
    Matrix,
    Negative,
    Number,
    Power,
    Product,
    Root,
    Sum,
    Symbol,
    Term,
    VectorEquation,
    cos,
    inv,
)
from reportgen.formula.formula_speech import Speech
from reportgen.formula.vocabulary import KINDS
from tests.formula.drawn import drawn, in_units
from tests.formula.spoken_reader import Listener, Misheard

LANGUAGES: tuple[Language, ...] = languages()
A, B, C = map(Symbol, "abc")
HALF = Number(0.5)


def words(language: Language) -> Any:
    return Words.among(load_words(search_path(language)), language).speech


def said(node: Expression, language: Language = "en", slashed: bool = False) -> str:
    return Speech(language, words(language)).math(node, slashed)


def listener(language: Language) -> Listener:
    return Listener(words(language), write(0.5, 1, language)[1])


# --- what is printed differently sounds differently -------------------------------------------------

ALIKE: list[Expression] = [
    Fraction(Negative(A), B),
    Negative(Fraction(A, B)),
    Fraction(Number(-3.0), B),
    Negative(Fraction(Number(3.0), B)),
    Fraction(A, Negative(B)),
    Product((A, Fraction(B, C))),
    Fraction(Product((A, B)), C),
    Product((Fraction(A, B), C)),
    Fraction(Fraction(A, B), C),
    Fraction(A, Fraction(B, C)),
    Sum((A, Fraction(B, C))),
    Fraction(Sum((A, B)), C),
    Sum((A, Negative(Fraction(B, C)))),
    Sum((A, Number(-3.0))),
    Sum((A, Negative(Number(3.0)))),
    Sum((A, Negative(Sum((B, C))))),
    Sum((A, Negative(B), C)),
    Power(Negative(A), Number(2.0)),
    Negative(Power(A, Number(2.0))),
    Power(Fraction(A, B), Number(2.0)),
    Fraction(A, Power(B, Number(2.0))),
    Power(A, Fraction(B, C)),
    Fraction(Power(A, B), C),
    Power(A, Sum((B, C))),
    Sum((Power(A, B), C)),
    Root(Sum((A, B))),
    Sum((Root(A), B)),
    Root(Power(A, Number(2.0))),
    Power(Root(A), Number(2.0)),
    Product((cos(A), B)),
    cos(Product((A, B))),
    Power(cos(A), Number(2.0)),
    cos(Power(A, Number(2.0))),
    Power(inv(A), Number(2.0)),
    Call("abs", (Sum((A, B)),)),
    Sum((Call("abs", (A,)), B)),
    Call("arctan2", (A, B)),
    Matrix(((A, B), (C, HALF))),
    Matrix(((A,), (B,), (C,))),
    Number(1.5e12, None, "N"),
    Number(-2e-9, None, "m"),
    Power(Number(3.0, None, "mm"), Number(2.0)),
    Symbol("J", "r2", "′"),
    Symbol("u", "13", "(H)"),
    Symbol("[s/m]"),
    Symbol("ω", "b", "+"),
    Symbol("a", "∥"),
    Symbol("b′s", "2", "′", "segment"),
    Symbol("R", "12", "", "vector"),
    Symbol("ȧ"),
]
"""Formulas that a careless speaker would say in the same words as another one of them, or as nothing at all."""


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_heard_is_drawn_again(language: Language) -> None:
    heard = {said(node, language): node for node in ALIKE}
    assert len(heard) == len(ALIKE)
    for words_of, node in heard.items():
        assert listener(language).read(words_of) == (in_units(drawn(node), language), "")


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_slash_is_heard_as_it_is_printed(language: Language) -> None:
    """In a line (−a)/b has its parenthesis, −a/b has none, and a · b/c is printed alike, whichever it means."""
    slashed = [
        Fraction(Negative(A), B),
        Negative(Fraction(A, B)),
        Fraction(A, Product((B, C))),
        Fraction(Sum((A, B)), C),
    ]
    heard = [said(node, language, slashed=True) for node in slashed]
    assert len(set(heard)) == len(slashed)
    assert [listener(language).read(one)[0] for one in heard] == [drawn(node, slashed=True) for node in slashed]
    either = Fraction(Product((A, B)), C), Product((A, Fraction(B, C)))
    assert len({said(node, language, slashed=True) for node in either}) == 1


def test_ends_are_said_where_they_could_be_missed() -> None:
    assert said(Fraction(A, B)) == "a over b"
    assert said(Fraction(Sum((A, B)), C)) == "fraction a plus b all over c end fraction"
    assert said(Root(A)) == "the square root of a"
    assert said(Sum((Root(Sum((A, B))), C))) == "the square root of all a plus b end root plus c"
    assert said(cos(Sum((A, B))), "vi") == "cô-sin của mở ngoặc a cộng b đóng ngoặc"
    assert said(Fraction(Negative(A), B), "vi") == "phân số tử âm a mẫu b hết phân số"
    assert said(Negative(Fraction(A, B)), "vi") == "âm a trên b"


def test_a_reason_is_heard_in_its_parentheses() -> None:
    line = said(Chain((A, Number(0.0)), "since ω₁ is constant"))
    assert line == "a equals 0 open parenthesis since omega 1 is constant close parenthesis"


def test_what_is_known_of_vectors_follows_their_line() -> None:
    rows = ("Direction", "Magnitude")
    v_B = Term(Symbol("v", "B", over="vector"), ("∥ guide", None))
    v_A = Term(Symbol("v", "A", over="vector"), ("⊥ O₁A", Fraction(Symbol("v", "A"), Symbol("μ", "v"))))
    zero = Term(Symbol("0", over="vector"), ("", ""))
    equation = VectorEquation(((v_B, v_A), (zero,)), rows)
    assert Speech("en", words("en")).vector_equation(equation) == (
        "vector v B plus vector v A equals vector 0. vector v B: Direction parallel to guide, Magnitude unknown. "
        "vector v A: Direction perpendicular to O 1 A, Magnitude v A divided by mu v"
    )


# --- numbers with units ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "decimals", "unit", "language", "heard"),
    [
        (1.0, None, "N", "en", "1 newton"),
        (-1.0, None, "mm", "en", "minus 1 millimetre"),
        (1.0, 1, "m/s", "en", "1.0 metres per second"),
        (21.0, None, "rpm", "en", "21 revolutions per minute"),
        (2.5, None, "vg/ph", "vi", "2,5 vòng trên phút"),
        (-0.5, None, "m/s²", "vi", "âm 0,5 mét trên giây bình phương"),
        (3.0, None, "furlong", "en", "3 furlong"),
    ],
)
def test_a_unit_goes_with_its_number(
    value: float, decimals: int | None, unit: str, language: Language, heard: str
) -> None:
    assert said(Number(value, decimals, unit), language) == heard


def test_forms_of_a_unit_follow_the_counts_of_a_language() -> None:
    """Where there are three forms, as in 1 рубль, 2 рубля, 5 рублей, the patterns of counts choose among them."""
    three = words("en") | {"counts": r"(.*[^1])?1 (.*[^1])?[2-4]", "units": {"N": "a | b | c"}}
    speech = Speech("en", three)
    heard = {count: speech.math(Number(float(count), None, "N"))[-1] for count in (1, 2, 4, 5, 11, 12, 20, 21, 33, 100)}
    assert heard == {1: "a", 2: "b", 4: "b", 5: "c", 11: "c", 12: "c", 20: "c", 21: "a", 33: "b", 100: "c"}


def test_counts_of_a_school_that_are_no_patterns_are_a_fault_of_its_template() -> None:
    with pytest.raises(TemplateError, match="counts"):
        Speech("en", words("en") | {"counts": "(1"})


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_unit_of_a_quantity_has_words_of_its_own(language: Language) -> None:
    units = load_words(search_path(language))["speech"]["units"]
    assert {kind.unit for kind in KINDS.values()} - {""} <= units.keys()
    forms = [form for forms in units.values() for form in set(forms.split(" | "))]
    assert len(forms) == len(set(forms))
    assert {"m", "cm", "mm", "rad", "kg", "N", "s"} <= PLAIN.keys() & units.keys()


# --- letters --------------------------------------------------------------------------------------


def test_a_capital_is_said_beside_its_small_letter() -> None:
    large, small, other = Symbol("B"), Symbol("b"), Symbol("D")
    speech = Speech("en", words("en"), (large, small, other))
    assert [speech.math(one) for one in (large, small, other)] == ["capital B", "b", "D"]
    assert Speech("vi", words("vi"), (large, small)).math(large) == "B hoa"
    assert Speech("en", words("en"), (Symbol("Ω"), Symbol("ω"))).math(Symbol("Ω")) == "capital Omega"


def test_an_index_is_said_to_be_one_beside_the_same_letters_in_a_line() -> None:
    beside, below = Symbol("ab"), Symbol("a", "b")
    speech = Speech("en", words("en"), (beside, below))
    assert (speech.math(beside), speech.math(below)) == ("a b", "a sub b")
    assert Speech("en", words("en"), (below,)).math(below) == "a b"


def test_letters_of_an_index_are_a_word_or_said_one_by_one() -> None:
    assert said(Symbol("M", "cb,max", "(1)")) == "M c b, max superscript open parenthesis 1 close parenthesis"
    assert said(Symbol("l", "O1A")) == "l O 1 A"
    assert said(Symbol("P₂A", over="segment"), "vi") == "đoạn P 2 A"


@pytest.mark.parametrize("nonsense", ["a plus", "fraction a all over b", "a over", "end root", "a open parenthesis b"])
def test_a_listener_refuses_what_is_no_formula(nonsense: str) -> None:
    with pytest.raises((Misheard, IndexError)):
        listener("en").read(nonsense)
