"""The Typst writer, judged by the PDF it gives: what it says, where it stands, how true the drawings are."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen.document.tree import (
    Column,
    Cover,
    Document,
    Equation,
    Figure,
    InlineMath,
    List,
    Paragraph,
    Reference,
    Section,
    Table,
    Text,
    Value,
)
from reportgen.errors import TypesetterError
from reportgen.figures.scene import Arc, Arrow, Label, Line, Polyline, Scene, Stroke
from reportgen.notation.evaluation import evaluate
from reportgen.notation.expressions import (
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
from reportgen.paint.geometry import arc_to_beziers, arrow_head, clip_hatch
from reportgen.writers import typst
from reportgen.writers.typst_math import literal
from reportgen.writers.typst_math import math as formula
from tests.writers import sample

pymupdf = pytest.importorskip("pymupdf")

MM = 72 / 25.4
"""PDF points in a millimetre."""


def opened(pdf: bytes) -> Any:
    return pymupdf.open(stream=pdf, filetype="pdf")


@cache
def sample_pdf() -> bytes:
    return typst.render(sample.sample())


def document(*blocks: Any) -> Document:
    return replace(sample.sample(), blocks=blocks)


def plain(text: str) -> str:
    """Text as a reader sees it: mathematical italics and presentation forms folded, spaces equal."""
    return " ".join(unicodedata.normalize("NFKC", text).replace("\N{WORD JOINER}", "").split())


def text_of(*blocks: Any) -> str:
    return plain(
        "\n".join(page.get_text(clip=body_of(page)) for page in opened(typst.render(document(*blocks))))
    )


def body_of(page: Any) -> Any:
    """The page without its header and footer."""
    return pymupdf.Rect(0, 24 * MM, page.rect.width, page.rect.height - 24 * MM)


# --- the whole sample -----------------------------------------------------------------------------


def test_every_node_compiles_byte_identically() -> None:
    assert sample_pdf() == typst.render(sample.sample())


def test_source_needs_no_other_file() -> None:
    source = typst.write(sample.sample())
    assert "#import" not in source
    assert "#include" not in source


def test_nothing_stands_outside_the_margins() -> None:
    """Left 30, right 20 mm; half a point of tolerance for side bearings of letters."""
    pages = opened(sample_pdf())
    assert pages.page_count > 5
    for page in list(pages)[1:]:
        if page.rect.width > 600:  # the plate has margins of its own
            continue
        left, right = 30 * MM - 0.5, page.rect.width - 20 * MM + 0.5
        for x0, y0, x1, y1, word, *_ in page.get_text("words"):
            assert left <= x0 <= x1 <= right, word
            assert 10 * MM <= y0 <= y1 <= page.rect.height - 10 * MM, word
        for drawing in page.get_drawings():
            assert left <= drawing["rect"].x0 <= drawing["rect"].x1 <= right


def test_contents_give_true_pages() -> None:
    pages = opened(sample_pdf())
    contents = plain(pages[1].get_text())
    titles = ("Lời nói đầu", "1 Động học", "1.1.1 Các bước dựng", "2 Mọi biểu thức", "Kết luận")
    found = {title: int(re.search(rf"{re.escape(title)} [. ]+ (\d+)", contents)[1]) for title in titles}
    for title, number in found.items():
        assert title in plain(pages[number - 1].get_text())
        assert f"Trang {number}" in plain(pages[number - 1].get_text())


def test_references_are_links_to_their_blocks() -> None:
    pages = opened(sample_pdf())
    targets = [link["page"] for link in pages[3].get_links()]
    figure = next(page.number for page in pages if "Hình 1.1." in plain(page.get_text()))
    assert {3, figure} <= set(targets)


def test_table_head_repeats_and_caption_stays_with_the_first_row() -> None:
    pages = [page for page in opened(sample_pdf()) if "Vị trí" in page.get_text() and page.number > 2]
    assert len(pages) == 2
    first = plain(pages[0].get_text())
    assert "Bảng 2.2. Vận tốc và gia tốc" in first
    assert first.index("Bảng 2.2.") < first.index("841,47")
    assert all("Vận tốc" in page.get_text() and "Gia tốc" in page.get_text() for page in pages)


def test_plate_has_its_own_paper_and_true_size() -> None:
    (page,) = (page for page in opened(sample_pdf()) if page.rect.width > 600)
    assert page.rect.width == pytest.approx(420 * MM, abs=0.1)
    assert page.rect.height == pytest.approx(297 * MM, abs=0.1)
    assert "Đặng Thị Ẩn" in page.get_text()


# --- text -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text", [sample.HOSTILE, sample.VIETNAMESE, '"', "\\", "#", "= a", "- b", "+ c", "/ d"]
)
def test_text_appears_as_typed(text: str) -> None:
    assert plain(text) in text_of(Paragraph((Text("("), Text(text), Text(")"))))


def test_hostile_text_in_every_other_place() -> None:
    text = r"A_B & 100% #1 $x$ \input{…} *y*"
    printed = text_of(
        sample.cover(text),
        Section(1, (Text(text),), number=text),
        Figure((Scene(150, 20, (Label(75 + 10j, text),), text),), (Text(text),), key=text, number=text),
        Equation((Chain((Symbol("a"), Number(1)), note=text),), key="e", number=text),
        Equation((VectorEquation(((Term(Symbol("v"), (text,)),),), (text,)),)),
    )
    assert printed.count(plain(text)) == 11


@given(st.text(st.characters(codec="utf-8", exclude_categories=("C",)), max_size=30))
def test_literals_read_back(text: str) -> None:
    written = literal(text)
    assert re.fullmatch(r'"(?:[^"\\]|\\.)*"', written, re.DOTALL)
    assert re.sub(r"\\(.)", r"\1", written[1:-1]) == text


def test_the_cover_says_everything_as_typed() -> None:
    text = r"A_B & 100% #1 $x$ \input{…} *y*"
    (page,) = opened(typst.render(document(Cover((text,) * 2, (text,) * 2, (text,), ((text, text),), text))))
    assert plain(page.get_text()).count(plain(text)) == 8
    assert "Trang" not in page.get_text()


def test_what_is_empty_stays_quiet() -> None:
    blocks = (
        Paragraph(()),
        Table((Column(30),), (), ()),
        Figure(()),
        List(((),)),
        Equation(()),
        Cover((), (), (), (), ""),
        Figure(
            (Scene(10, 10, (Polyline((1j,)), Arrow(1j, 1j), Arc(5j, 0, 0, 1), Arc(5j, 2, 1, 1, head=2))),)
        ),
    )
    assert opened(typst.render(document(*blocks))).page_count <= 3
    assert opened(typst.render(document())).page_count == 1


def test_a_run_in_heading_stands_in_the_line_of_its_paragraph() -> None:
    printed = text_of(
        Section(4, (Text("Nhận xét."),), key="k"), Paragraph((Text("Đúng, xem "), Reference("k", "đây")))
    )
    assert printed == "Nhận xét. Đúng, xem đây"


def test_figures_wider_than_a_row_go_on_below() -> None:
    scenes = [Scene(width, 10) for width in (100, 56, 60, 100, 160)]
    assert [[scene.width for scene in row] for row in typst.in_rows(scenes)] == [
        [100, 56],
        [60],
        [100],
        [160],
    ]
    assert typst.in_rows(scenes[:2] * 2) == [scenes[:2]] * 2


# --- what a page or line break must not part ----------------------------------------------------------


def last_words(*blocks: Any) -> list[str]:
    return [plain(page.get_text(clip=body_of(page))) for page in opened(typst.render(document(*blocks)))]


def listed(inlines: Any) -> List:
    return List(((Paragraph((Text("Một."),)),), (Paragraph(inlines),)))


@pytest.mark.parametrize("opening", [Paragraph, listed])
def test_words_stand_on_the_page_of_the_formula_they_lead_to(opening: Any) -> None:
    """Whatever number of lines stands above, so that the page ends anywhere."""
    formula = Equation((Number(1234),) * 3)
    for count in range(24, 42):
        lines = (Paragraph((Text("Dòng."),)),) * count
        for page in last_words(*lines, opening((Text("Ta có:"),)), formula):
            assert not page.endswith("Ta có:"), count


def test_three_rows_at_least_of_a_long_table_stand_on_a_page() -> None:
    for rows in range(42, 52):
        for page in opened(typst.render(document(sample.long_table(rows, "t", "1.1")))):
            assert len(re.findall(r"^\d+ *$", page.get_text(clip=body_of(page)), re.MULTILINE)) >= 3


def test_units_and_products_stay_in_one_line() -> None:
    """Behind any number of letters: the line ends everywhere once."""
    product = Product((Number(2), Symbol("ω", "3"), Symbol("v")))
    whole = Text("0 N/cm²"), InlineMath(product), Value(Number(0.5, 1, "m/(s²·mm)"))
    for count in range(1, 90, 2):
        source = Paragraph((Text("i" * count + " "), *(part for item in whole for part in (item, Text(" ")))))
        page = opened(typst.render(document(source)))[0]
        lines = [plain("".join(span["text"] for span in line["spans"])) for line in lines_of(page)]
        assert all(not line.endswith(("/", "·", "⋅")) for line in lines), lines


def lines_of(page: Any) -> list[Any]:
    return [line for block in page.get_text("dict")["blocks"] for line in block.get("lines", ())]


def test_nothing_but_zero_is_no_row_of_its_own() -> None:
    terms = tuple(Product((Symbol("R", f"{index}2"), Symbol("h", f"{index}2"))) for index in range(7))
    for letters in range(1, 14, 2):
        row = Chain((Sum((Symbol("M", "i" * letters), *terms)), Number(0)))
        page = opened(typst.render(document(Equation((row,)))))[0]
        zero = next(word for word in page.get_text("words") if word[4] == "0")
        beside = [word for word in page.get_text("words") if abs(word[3] - zero[3]) < 3]
        assert len(beside) > 2, letters


# --- expressions ----------------------------------------------------------------------------------

NUMBERS = st.builds(
    Number, st.integers(-99, 99).map(lambda n: n / 4), st.just(2), st.sampled_from(["", "mm"])
)
EXPRESSIONS: st.SearchStrategy[Expression] = st.recursive(
    NUMBERS,
    lambda inner: st.one_of(
        st.lists(inner, min_size=1, max_size=3).map(lambda terms: Sum(tuple(terms))),
        st.lists(inner, min_size=1, max_size=3).map(lambda factors: Product(tuple(factors))),
        inner.map(Negative),
        st.builds(Fraction, inner, NUMBERS.filter(lambda number: number.shown != 0)),
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
    return "sin^" in formula(node, "vi") or "cos^" in formula(node, "vi")


@settings(max_examples=200, deadline=None)
@given(EXPRESSIONS)
def test_a_written_expression_means_what_it_evaluates_to(node: Expression) -> None:
    source = formula(node, "vi")
    assert not re.search(r'(dot\.c|[+−]) ("?−)', source), "two signs in a row"
    if not nested_call_powers(node):
        assert reread(source) == pytest.approx(float(evaluate(node)), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("node", "printed"),
    [
        (sample.multiply(2, sample.add(Symbol("a"), Symbol("b"))), "2 · (a + b)"),
        (Product((Symbol("a"), Number(-1.5, 1))), "a · (−1,5)"),
        (sample.subtract(Symbol("a"), sample.add(Symbol("b"), Symbol("c"))), "a − (b + c)"),
        (Negative(Negative(Symbol("a"))), "−(−a)"),
        (Power(Number(-3.0, 1), Number(2)), "(−3,0)2"),
        (Number(-0.2189, 4, "m/s"), "−0,2189 m/s"),
        (Number(60, None, "°"), "60°"),
        (Number(-0.00001, 2), "0,00"),
        (Call("sin", (Number(35.26, 2, "°"),)), "sin 35,26°"),
        (Call("cos", (sample.add(Symbol("a"), Symbol("b")),)), "cos(a + b)"),
        (sample.expressions()[-1], "vA = ω1 · R = 230,3835 · 0,0475 = 10,943 m/s"),
    ],
)
def test_formulas_read_in_order(node: Expression, printed: str) -> None:
    """pdf text drops some of the small gaps, so gaps do not count here."""
    found = text_of(Paragraph((InlineMath(node),)))
    assert found.replace(" ", "") == printed.replace(" ", "")


def test_decimal_mark_follows_the_language() -> None:
    assert formula(Number(1.5, 1), "vi") == '"1,5"'
    assert formula(Number(1.5, 1), "en") == '"1.5"'


def test_a_reference_without_substitute_is_refused() -> None:
    with pytest.raises(TypesetterError, match="v_a"):
        formula(sample.add(Ref("v_a"), 1.0), "vi")


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
    (page,) = opened(
        typst.render(document(Equation((row, sample.expressions()[-1]), key="k", number="12.34")))
    )
    words = page.get_text("words", clip=body_of(page))
    assert min(word[0] for word in words) >= 30 * MM - 0.5
    assert max(word[2] for word in words) <= page.rect.width - 20 * MM + 0.5
    boxes = [pymupdf.Rect(word[0], word[1] + 3, word[2], word[3] - 3) for word in words if "12.34" in word[4]]
    assert len(boxes) == 1
    assert not [word[4] for word in words if boxes[0].intersects(word[:4]) and "12.34" not in word[4]]


def test_unknowns_of_a_vector_equation_stand_under_their_terms() -> None:
    (page,) = opened(typst.render(document(Equation((sample.velocity_equation(),)))))
    words = [
        (plain(word[4]), (word[0] + word[2]) / 2, word[1])
        for word in page.get_text("words", clip=body_of(page))
    ]
    marks = sorted((y, x) for word, x, y in words if word == "?")
    assert len(marks) == 4
    relation = next(x for word, x, _ in words if "=" in word)
    assert sum(x < relation for _, x in marks) == 2


# --- drawings -------------------------------------------------------------------------------------


def drawn(scene: Scene) -> tuple[complex, list[dict[str, Any]]]:
    """(PDF position of the scene's lower left corner, its drawings), found by a red frame around it."""
    w, h = scene.width, scene.height
    frame = Polyline((0j, complex(w, 0), complex(w, h), complex(0, h)), Stroke(0.1, "#ff0000"), closed=True)
    page = opened(typst.render(document(Figure((replace(scene, items=(frame, *scene.items)),)))))[0]
    drawings = [drawing for drawing in page.get_drawings() if drawing["rect"].y0 > 24 * MM]
    (red,) = (drawing for drawing in drawings if drawing["color"] == (1.0, 0.0, 0.0))
    return complex(red["rect"].x0, red["rect"].y1), [drawing for drawing in drawings if drawing is not red]


def on_sheet(point: Any, corner: complex) -> complex:
    """A PDF point as a point of the scene, mm."""
    return complex(point.x - corner.real, corner.imag - point.y) / MM


def vertices(drawing: dict[str, Any], corner: complex) -> list[complex]:
    return [on_sheet(point, corner) for item in drawing["items"] for point in item[1:] if hasattr(point, "x")]


def heads(drawings: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    return (drawing for drawing in drawings if drawing["type"] == "f" and drawing["fill"] == (0.0, 0.0, 0.0))


def test_arrows_are_true_in_the_pdf() -> None:
    """Coordinates are written to 0.001 mm; 0.02 mm leaves room for the PDF's own rounding."""
    scene = sample.star(100, 24)
    arrows = [item for item in scene.items if isinstance(item, Arrow)]
    corner, drawings = drawn(scene)
    tips = [vertices(drawing, corner)[0] for drawing in heads(drawings)]
    starts = [vertices(drawing, corner)[0] for drawing in drawings if drawing["type"] == "s"]
    assert len(tips) == len(starts) == len(arrows)
    for arrow, tip, start in zip(arrows, tips, starts, strict=True):
        assert abs(tip - arrow.end) < 0.02
        assert abs(start - arrow.start) < 0.02


def test_a_short_arrow_keeps_its_tip_and_its_head_within() -> None:
    arrow = Arrow(10 + 10j, 11 + 10j)
    corner, drawings = drawn(Scene(20, 20, (arrow,)))
    (head,) = heads(drawings)
    points = vertices(head, corner)
    assert abs(max(points, key=lambda point: point.real) - arrow.end) < 0.02
    assert min(point.real for point in points) >= arrow.start.real


def test_arc_keeps_its_radius_and_ends_at_its_stop() -> None:
    arc = Arc(30 + 30j, 20, 0.3, 4.0, head=2.5)
    corner, drawings = drawn(Scene(60, 60, (arc,)))
    (head,) = heads(drawings)
    tip = arc.centre + 20 * complex(math.cos(4.0), math.sin(4.0))
    assert min(abs(point - tip) for point in vertices(head, corner)) < 0.02
    (curve,) = (drawing for drawing in drawings if drawing["type"] == "s")
    ends = [on_sheet(item[4], corner) for item in curve["items"] if item[0] == "c"]
    assert all(abs(abs(end - arc.centre) - arc.radius) < 0.02 for end in ends)


@pytest.mark.parametrize(
    ("anchor", "inside"),
    [("bottom-left", 1 + 1j), ("top-right", -1 - 1j), ("top-left", 1 - 1j), ("bottom-right", -1 + 1j)],
)
@pytest.mark.parametrize("turn", [0, 90])
def test_a_label_stands_on_the_named_corner_of_its_ink(anchor: Any, inside: complex, turn: int) -> None:
    """Ink measured on a picture of the page at 20 dots a mm; a letter without side bearings to speak of."""
    scene = Scene(60, 60, (Label(30 + 30j, "HHHH", anchor, 12.0, turn), Line(0j, 60 + 0j)))
    page = opened(typst.render(document(Figure((scene,)))))[0]
    (axis,) = (drawing["rect"] for drawing in page.get_drawings() if abs(drawing["rect"].width - 60 * MM) < 1)
    corner = complex(axis.x0, (axis.y0 + axis.y1) / 2)
    # Ten millimetres of paper on each side of the point.
    middle = corner + (30 - 30j) * MM
    clip = pymupdf.Rect(middle.real - 40, middle.imag - 40, middle.real + 40, middle.imag + 40)
    picture = page.get_pixmap(dpi=508, clip=clip, colorspace="gray")
    width = picture.width
    dark = [divmod(index, picture.stride) for index, value in enumerate(picture.samples) if value < 128]
    rows, columns = [row for row, _ in dark], [column for _, column in dark]
    near_x = min(columns) if inside.real > 0 else max(columns) + 1
    near_y = max(rows) + 1 if inside.imag > 0 else min(rows)
    # The side bearing of H is 0.03 em, 0.13 mm here, at its ends only; across it the ink is exact.
    assert abs(near_x - width / 2) / 20 < 0.25
    assert abs(near_y - picture.height / 2) / 20 < 0.25


# --- geometry -------------------------------------------------------------------------------------

ANGLES = st.floats(-7, 7)


@given(ANGLES, st.floats(0.1, 6.2), st.sampled_from([1, -1]))
def test_beziers_follow_their_circle(start: float, sweep: float, sense: int) -> None:
    """The best cubic over 45° errs by 4.2e-6 of the radius at its worst."""
    for p, q, r, s in arc_to_beziers(1 + 2j, 10, start, start + sense * sweep):
        for t in (0.0, 0.2, 0.5, 0.8, 1.0):
            point = p * (1 - t) ** 3 + 3 * q * t * (1 - t) ** 2 + 3 * r * t**2 * (1 - t) + s * t**3
            assert abs(abs(point - 1 - 2j) - 10) < 1e-4


@given(st.complex_numbers(max_magnitude=100), st.complex_numbers(max_magnitude=100), st.floats(0.1, 5))
def test_a_head_ends_at_the_tip_and_covers_the_end_of_the_shaft(
    a: complex, b: complex, length: float
) -> None:
    shaft_end, head = arrow_head(a, b, length)
    if abs(b - a) < 1e-6:
        return
    assert head is not None
    assert head[0] == b
    along = (b - a) / abs(b - a)
    back = ((head[1] - b) / along).real
    assert back == pytest.approx(-min(length, 0.75 * abs(b - a)))
    assert back < ((shaft_end - b) / along).real < 0


@given(st.floats(1, 40), st.floats(1, 40), ANGLES, st.floats(0.5, 3))
def test_hatch_lies_inside_and_has_its_spacing(
    width: float, height: float, turn: float, spacing: float
) -> None:
    """The strokes of a rectangle, moved along by the spacing, cover its area to within a stroke's share."""
    by = complex(math.cos(turn), math.sin(turn))
    points = [corner * by for corner in (0j, width + 0j, width + height * 1j, height * 1j)]
    strokes = clip_hatch(points, spacing)
    for start, end in strokes:
        assert ((end - start) / (1 + 1j)).imag == pytest.approx(0, abs=1e-6)
        for point in (start / by, end / by):
            assert -1e-6 <= point.real <= width + 1e-6
            assert -1e-6 <= point.imag <= height + 1e-6
    area = spacing * sum(abs(end - start) for start, end in strokes)
    assert abs(area - width * height) <= spacing * 2 * math.hypot(width, height)


def test_hatch_refuses_no_spacing() -> None:
    with pytest.raises(ValueError, match="spacing"):
        clip_hatch([0j, 1 + 0j, 1j], 0.0)


# --- faults ---------------------------------------------------------------------------------------


def test_a_fault_of_the_typesetter_is_told_in_its_first_lines() -> None:
    with pytest.raises(TypesetterError, match="unknown variable: nothing") as caught:
        typst.compile("#nothing")
    assert caught.value.exit_code == 3
    assert len(str(caught.value).splitlines()) <= 5
