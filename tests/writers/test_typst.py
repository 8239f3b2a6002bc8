"""The Typst writer, judged by the pages it gives: what they say, where it stands, where they break."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reportgen.base.errors import TypesetterError
from reportgen.base.records import replace
from reportgen.document import (
    Column,
    Cover,
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
from reportgen.document.layout import in_rows
from reportgen.drawing import Arc, Arrow, Label, Polyline, Scene
from reportgen.formula import Chain, Number, Product, Sum, Symbol, Term, VectorEquation
from reportgen.writers import typst, typst_compiler
from reportgen.writers.typst_math import literal
from tests.writers import sample
from tests.writers.pages import MM, body_of, by_typst, opened, plain, sides, text_of


@cache
def sample_pdf() -> bytes:
    return typst_compiler.compile(typst.write(sample.sample()))


# --- the whole sample -----------------------------------------------------------------------------


def test_every_node_compiles_byte_identically() -> None:
    assert sample_pdf() == typst_compiler.compile(typst.write(sample.sample()))


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
    targets = [link["page"] for page in list(pages)[2:] for link in page.get_links()]
    figure = next(page.number for page in pages if "Hình 1.1." in plain(page.get_text()))
    assert figure in targets


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


@pytest.mark.parametrize("text", [sample.HOSTILE, sample.VIETNAMESE, '"', "\\", "#", "= a", "- b", "+ c", "/ d"])
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
    (page,) = by_typst(Cover((text,) * 2, (text,) * 2, (text,), ((text, text),), text))
    assert plain(page.get_text()).count(plain(text)) == 8
    assert "Trang" not in page.get_text()


def test_a_framed_table_has_sides_that_reach_from_rule_to_rule() -> None:
    table = Table((Column(30), Column(30)), (sample.cells("a", "b"),), (sample.cells("1", "2"),) * 3)
    assert sides(by_typst(table)) == []
    left, right = sides(by_typst(replace(table, framed=True)))
    assert right - left == pytest.approx(60, abs=1)


def test_what_is_empty_stays_quiet() -> None:
    blocks = (
        Paragraph(()),
        Table((Column(30),), (), ()),
        Figure(()),
        List(((),)),
        Equation(()),
        Cover((), (), (), (), ""),
        Figure((Scene(10, 10, (Polyline((1j,)), Arrow(1j, 1j), Arc(5j, 0, 0, 1), Arc(5j, 2, 1, 1, head=2))),)),
    )
    assert by_typst(*blocks).page_count <= 3
    assert by_typst().page_count == 1


def test_a_run_in_heading_stands_in_the_line_of_its_paragraph() -> None:
    printed = text_of(Section(4, (Text("Nhận xét."),), key="k"), Paragraph((Text("Đúng, xem "), Reference("k", "đây"))))
    assert printed == "Nhận xét. Đúng, xem đây"


def test_figures_wider_than_a_row_go_on_below() -> None:
    scenes = [Scene(width, 10) for width in (100, 56, 60, 100, 160)]
    assert [[scene.width for scene in row] for row in in_rows(scenes)] == [[100, 56], [60], [100], [160]]
    assert in_rows(scenes[:2] * 2) == [scenes[:2]] * 2


# --- what a page or line break must not part ----------------------------------------------------------


def last_words(*blocks: Any) -> list[str]:
    return [plain(page.get_text(clip=body_of(page))) for page in by_typst(*blocks)]


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
        for page in by_typst(sample.long_table(rows, "t", "1.1")):
            assert len(re.findall(r"^\d+ *$", page.get_text(clip=body_of(page)), re.MULTILINE)) >= 3


def test_units_and_products_stay_in_one_line() -> None:
    """Behind any number of letters: the line ends everywhere once."""
    product = Product((Number(2), Symbol("ω", "3"), Symbol("v")))
    whole = Text("0 N/cm²"), InlineMath(product), Value(Number(0.5, 1, "m/(s²·mm)"))
    for count in range(1, 90, 2):
        source = Paragraph((Text("i" * count + " "), *(part for item in whole for part in (item, Text(" ")))))
        page = by_typst(source)[0]
        lines = [plain("".join(span["text"] for span in line["spans"])) for line in lines_of(page)]
        assert all(not line.endswith(("/", "·", "⋅")) for line in lines), lines


def lines_of(page: Any) -> list[Any]:
    return [line for block in page.get_text("dict")["blocks"] for line in block.get("lines", ())]


def test_nothing_but_zero_is_no_row_of_its_own() -> None:
    terms = tuple(Product((Symbol("R", f"{index}2"), Symbol("h", f"{index}2"))) for index in range(7))
    for letters in range(1, 14, 2):
        row = Chain((Sum((Symbol("M", "i" * letters), *terms)), Number(0)))
        page = by_typst(Equation((row,)))[0]
        zero = next(word for word in page.get_text("words") if word[4] == "0")
        beside = [word for word in page.get_text("words") if abs(word[3] - zero[3]) < 3]
        assert len(beside) > 2, letters


# --- faults ---------------------------------------------------------------------------------------


def test_a_fault_of_the_typesetter_is_told_in_its_first_lines() -> None:
    with pytest.raises(TypesetterError, match="unknown variable: nothing") as caught:
        typst_compiler.compile("#nothing")
    assert caught.value.exit_code == 3
    assert len(str(caught.value).splitlines()) <= 5
