"""What stays on one line or page: a short equality in text, words with equations, answers with their table."""

from __future__ import annotations

import pytest

from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.document import Block, Cell, Column, Equation, Paragraph, Table, Text, Words, layout
from reportgen.formula import Chain, Fraction, Number, Symbol, Term, VectorEquation
from reportgen.formula.formula_speech import Speech
from reportgen.writers.latex_math import LatexFormulas
from reportgen.writers.typst import _Blocks

LEADS = Paragraph((Text("Projection gives:"),))
CLOSED = Paragraph((Text("The sense is: clockwise."),))
VECTORS = Equation((VectorEquation(((Term(Symbol("v")),), (Term(Symbol("u")),)), ()),))
LINE = Equation((Chain((Symbol("v"), Number(1.0))),))
TABLE = Table((Column(20.0),), (), ((Cell((Text("1"),)),),), (Text("Answers"),), "tab.answers")


@pytest.mark.parametrize(
    ("block", "following", "kept"),
    [(VECTORS, LEADS, True), (VECTORS, CLOSED, False), (LINE, TABLE, True), (LINE, LEADS, False), (LEADS, LINE, True)],
)
def test_what_leads_to_the_next_block(block: Block, following: Block, kept: bool) -> None:
    assert layout.leads(block, following, "en") is kept


PLACE = Chain((Symbol("x"), Number(5.0, None, "mm"), Number(0.005, None, "m")))


def test_the_first_equality_of_a_line_is_not_broken() -> None:
    """A second one may begin a line, as the long formulas of coordinates need it."""
    source = LatexFormulas("en").content(PLACE)
    assert source.count(r"=\nobreak") == 1
    assert source.count(r"\relbreak=") == 1
    words = Words.among(load_words(search_path("en")), "en")
    blocks = _Blocks("en", words, Speech("en", words.speech))
    first, second = blocks.formula(PLACE).split(" #box")
    assert "=" in first
    assert second.startswith('(M("equals 0.005 metres",$= ')


def test_what_is_known_of_a_vector_keeps_to_its_line() -> None:
    half = Fraction(Symbol("v"), Symbol("l"))
    assert r"\frac" in LatexFormulas("en").content(half)
    assert LatexFormulas("en").known(half) == "$v/l$"
    assert LatexFormulas("en").known(None) == "?"
