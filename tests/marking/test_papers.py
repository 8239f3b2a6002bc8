"""Task, key, feedback and class page as they are printed: all within the margins, no word over another."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from reportgen import api
from reportgen.base.units import Language
from reportgen.document import Document, text_of
from reportgen.marking.class_page import class_document
from reportgen.marking.feedback import feedback_document
from reportgen.marking.key_files import key_document
from tests.lanes import matrix
from tests.marking.test_feedback import marking
from tests.marking.test_sheet import handout
from tests.report.built import needs_tex
from tests.report.pages import BEARING, INK, Page, outside, overlaps

NAME = "Lê #1 $x_2$ & <b>Hoàng</b> \\input{x} *_`"
"""Markup of every language that a name passes through on its way to the page."""

Paper = Callable[[Language], Document]


def of_a_class(language: Language) -> Document:
    found = [marking(language, student=f"{NAME} {n}") for n in range(30)]
    return class_document(found, "crank", language)


PAPERS: dict[str, Paper] = {
    "task": lambda language: handout("engine-twin-05", language)[1],
    "key": lambda language: key_document(handout("slider-crank-01", language)[0], "Slider-crank"),
    "feedback": lambda language: feedback_document(marking(language, student=NAME), "Crank"),
    "class": of_a_class,
}


@pytest.mark.proof
@pytest.mark.parametrize("engine", matrix(["typst", pytest.param("latex", marks=needs_tex)], ["typst"]))
@pytest.mark.parametrize(("name", "language"), [("task", "vi"), ("key", "en"), ("feedback", "vi"), ("class", "en")])
def test_a_paper_keeps_to_its_page(name: str, language: Language, engine: api.Engine) -> None:
    pymupdf = pytest.importorskip("pymupdf")
    tree = PAPERS[name](language)
    with pymupdf.open(stream=api.typeset(tree, engine)[1]) as pdf:
        for sheet in pdf:
            page = Page(sheet)
            assert overlaps(page, INK) == []
            assert outside(page, BEARING) == []
        text = "".join(sheet.get_text() for sheet in pdf).replace("\n", "").replace(" ", "")
    if name == "feedback":
        assert NAME.replace(" ", "") in text


def test_two_languages_say_as_much() -> None:
    for paper in PAPERS.values():
        vi, en = text_of(paper("vi")), text_of(paper("en"))
        assert vi.count("\n") == en.count("\n")
        assert vi != en


def test_the_order_of_a_class_is_kept() -> None:
    first, second = marking(student="B"), marking(student="A")
    text = text_of(class_document([first, second], "crank", "en"))
    assert text.index("B |") < text.index("A |")
