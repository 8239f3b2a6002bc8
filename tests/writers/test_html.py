"""The writer of pages: formulas in MathML Core, drawings in millimetres, every text as typed."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from itertools import pairwise
from xml.etree import ElementTree

import pytest

from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.document import Equation, InlineMath, Paragraph, Section, Text
from reportgen.drawing import Arrow, Circle, Label, Line, Scene
from reportgen.drawing.label_size import POINT, SCRIPT, SMALL_CUT, box
from reportgen.formula import (
    Chain,
    Expression,
    Fraction,
    Number,
    Power,
    Product,
    Sum,
    Symbol,
    VectorEquation,
    cos,
    walk,
)
from reportgen.formula.plain_text import formula
from reportgen.page import html
from reportgen.page.svg_elements import MathmlFormulas, Painter, Pens
from tests.writers import sample

SCRIPTED = {"msub": 2, "msup": 2, "msubsup": 3, "mover": 2, "mfrac": 2}
"""Elements with a fixed number of operands."""
PLAIN = {"math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "msqrt", "mtable", "mtr", "mtd"}
SPACES = re.compile(r"[\s\N{NARROW NO-BREAK SPACE}\N{FUNCTION APPLICATION}]+")


def parsed(expression: Expression, language: Language = "vi") -> ElementTree.Element:
    return ElementTree.fromstring(MathmlFormulas(language).content(expression))


def said(element: ElementTree.Element) -> str:
    return SPACES.sub("", "".join(element.itertext()))


@pytest.mark.parametrize("expression", sample.expressions(), ids=str)
def test_formulas_are_mathml_core_without_styles(expression: Expression) -> None:
    for element in parsed(expression).iter():
        assert element.tag in PLAIN | SCRIPTED.keys()
        assert not element.attrib.keys() & {"style", "mathsize", "mathcolor", "href"}
        assert len(element) == SCRIPTED.get(element.tag, len(element)), element.tag


@pytest.mark.parametrize("expression", sample.expressions(), ids=str)
def test_formulas_print_each_of_their_symbols_and_numbers(expression: Expression) -> None:
    printed = said(parsed(expression))
    for node in walk(expression):
        if isinstance(node, (Symbol, Number)):
            for part in (node.base, node.sub, node.sup) if isinstance(node, Symbol) else (formula(node, "vi"),):
                assert set(SPACES.sub("", part).translate(str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789"))) <= set(printed)


def test_parentheses_stand_where_a_line_would_be_misread() -> None:
    a, b, c = (Symbol(letter) for letter in "abc")
    assert said(parsed(Product((Sum((a, b)), c)))) == "(a+b)·c"
    assert said(parsed(Power(Sum((a, b)), Number(2.0)))) == "(a+b)2"
    assert said(parsed(Product((a, Number(-1.5))))) == "a·(−1,5)"
    assert said(parsed(Product((a, Number(-1.5))), "en")) == "a·(−1.5)"


def test_parentheses_stretch_only_about_what_is_high() -> None:
    low, high = Sum((Symbol("x"), Symbol("y"))), Sum((Symbol("x"), Fraction(Symbol("a"), Symbol("b"))))
    for inner, stretched in ((low, False), (high, True)):
        marks = [one for one in parsed(Product((Symbol("k"), inner))).iter("mo") if one.text in ("(", ")")]
        assert len(marks) == 2
        assert all((mark.get("stretchy") != "false") is stretched for mark in marks)


def test_a_function_stands_apart_from_its_letter() -> None:
    assert [one.get("width") for one in parsed(cos(Symbol("α", "2"))).iter("mspace")] == ["0.17em"]
    assert not list(parsed(cos(Sum((Symbol("α"), Symbol("β"))))).iter("mspace"))


def test_displayed_rows_break_where_the_tree_breaks_them() -> None:
    chain = sample.wide_chain()
    left, pieces = MathmlFormulas("vi").row(chain)
    assert left
    assert len(pieces) >= len(chain.parts) - 1
    # A piece begins with its relation or sign, and every piece is a formula by itself.
    for piece in pieces:
        assert ElementTree.fromstring(f"<math>{piece}</math>").tag == "math"
    assert said(ElementTree.fromstring(f"<math>{pieces[0]}</math>")).startswith("=")


def test_vector_equations_have_a_column_a_term() -> None:
    for equation in (sample.velocity_equation(), sample.force_equation()):
        assert isinstance(equation, VectorEquation)
        columns = MathmlFormulas("vi").columns(equation)
        assert all(len(known) == len(equation.rows) for _, known in columns)
        for term, known in columns:
            for part in (f"<math>{term}</math>", *(one for one in known if one.startswith("<math"))):
                ElementTree.fromstring(part)


class Elements(HTMLParser):
    """Elements of a source, in order, with their attributes; all of its text."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(source)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attributes)))

    def handle_data(self, data: str) -> None:
        self.text += data


def test_every_block_is_written_and_every_text_reads_back_as_typed() -> None:
    document = sample.sample()
    read = Elements(html.report(document).body)
    squeezed = " ".join(read.text.split())
    for words in (sample.HOSTILE, sample.VIETNAMESE, "Bảng 2.2.", "Hình 1.1.", "Trường Đại học Mẫu", "(1.4)"):
        assert " ".join(words.split()) in squeezed, words
    tags = [tag for tag, _ in read.found]
    assert {"header", "nav", "details", "table", "figure", "svg", "math", "ol", "ul", "figcaption"} <= set(tags)
    assert not set(tags) & {"b<b>", "script", "style", "img"}
    for _, attributes in read.found:
        assert not any(name == "style" or name.startswith("on") for name in attributes)


def test_headings_go_down_a_level_at_a_time() -> None:
    read = Elements(html.report(sample.sample()).body)
    levels = [int(tag[1]) for tag, _ in read.found if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))
    # A document without a cover has its first part as its title.
    bare = replace(sample.sample(), blocks=(Section(1, (Text("Bài tập"),)), Paragraph((Text("x"),))))
    assert Elements(html.report(bare).body).found[0][0] == "h1"


def test_drawings_are_in_millimetres() -> None:
    """Ends of lines, tips of arrows, centres of circles are where the scene has them, y turned over."""
    scene = sample.star(100, 24)
    drawn = ElementTree.fromstring(Painter("vi", Pens()).scene(scene, 'a "name" <b>'))
    assert (drawn.get("width"), drawn.get("height")) == (f"{scene.width:g}mm", f"{scene.height:g}mm")
    assert drawn.get("viewBox") == f"0 0 {scene.width:g} {scene.height:g}"
    assert drawn.get("aria-label") == 'a "name" <b>'
    corners = {
        (float(x), float(y))
        for path in drawn.iter("path")
        for x, y in re.findall(r"[ML]([-\d.]+) ([-\d.]+)", str(path.get("d")))
    }
    for item in scene.items:
        if isinstance(item, (Arrow, Line)):
            for end in (item.start, item.end):
                assert any(abs(x - end.real) + abs(scene.height - y - end.imag) < 2e-3 for x, y in corners)
    circles = {(float(str(c.get("cx"))), float(str(c.get("cy")))) for c in drawn.iter("circle")}
    for item in scene.items:
        if isinstance(item, Circle):
            assert any(abs(x - item.centre.real) + abs(scene.height - y - item.centre.imag) < 2e-3 for x, y in circles)


def test_labels_are_text_and_stand_at_their_anchors() -> None:
    items = (
        Label(10 + 10j, sample.HOSTILE, "left"),
        Label(20 + 20j, Symbol("O", "1A", over="vector"), "center"),
        Label(30 + 30j, Number(1.5, 2, "mm"), "bottom-right", background=True),
        Label(5 + 40j, "up", turn=90),
    )
    drawn = ElementTree.fromstring(Painter("vi", Pens()).scene(Scene(60, 60, items), ""))
    texts = list(drawn.iter("text"))
    assert ["".join(text.itertext()) for text in texts] == [
        sample.HOSTILE,
        "O1A",
        "1,50\N{NARROW NO-BREAK SPACE}mm",
        "up",
    ]
    assert [str(text.get("class"))[0] for text in texts] == ["s", "m", "e", "m"]
    assert float(str(texts[0].get("x"))) == 10
    assert float(str(texts[2].get("x"))) == 30
    # The base line of a label that stands on its anchor is at most its depth above it.
    assert 0 <= 60 - 30 - float(str(texts[2].get("y"))) < 1.5
    assert str(texts[3].get("transform")).startswith("rotate(-90")


@pytest.mark.parametrize(("below", "above", "first"), [("CB", "n", "n"), ("1", "τqt", "1"), ("CB", "", "CB")])
def test_an_index_stands_under_an_exponent(below: str, above: str, first: str) -> None:
    """The wider one comes last and begins where the narrower did, so that what follows stands behind both."""
    label = Label(0j, Symbol("a", below, above), size=10.0)
    text = ElementTree.fromstring(Painter("vi", Pens()).label(label))
    letter, *scripts = text.iter("tspan")
    assert letter.text == "a"
    assert scripts[0].text == first
    assert {script.text for script in scripts} == {below, above} - {""}
    assert scripts[0].get("dx") is None
    for script in scripts[1:]:
        # Attributes count in the font size of the script itself.
        narrower = box(Symbol("", first), 10.0).width / SMALL_CUT
        assert float(str(script.get("dx")).removesuffix("em")) * SCRIPT * 10.0 * POINT == pytest.approx(
            -narrower, abs=1e-3 * 10.0
        )


def test_pens_are_classes_that_follow_light_and_dark() -> None:
    written = html.report(sample.sample())
    rules = dict(re.findall(r"\.(p\d+)\{([^}]*)\}", written.rules))
    used = set(re.findall(r'class="(p\d+)"', written.body))
    assert used
    assert used <= rules.keys()
    assert any("var(--" in rule for rule in rules.values())


def test_no_line_begins_with_the_mark_behind_a_formula() -> None:
    chain = InlineMath(Chain((Symbol("v"), Symbol("w"))))
    words = (Text("where ("), InlineMath(Symbol("x")), Text("), "), chain, Text(". And "), Text(". So"))
    document = replace(sample.sample(), blocks=(Paragraph(words),))
    paragraph = ElementTree.fromstring(html.report(document).body.replace("<wbr>", "<wbr/>"))
    kept = [said(one) for one in paragraph if one.tag == "span"]
    # Of a formula that may break, the last piece.
    assert kept == ["(x),", "=w."]
    assert said(paragraph) == "where(x),v=w.And.So"


def test_the_number_of_an_equation_stands_once() -> None:
    rows = (Symbol("a"), Symbol("b"))
    document = replace(sample.sample(), blocks=(Equation(rows, "key", "1.7"), Paragraph((InlineMath(Symbol("c")),))))
    assert Elements(html.report(document).body).text.count("(1.7)") == 1
