"""The LaTeX writer, judged by the pages it gives: what they say and where it stands."""

from __future__ import annotations

import re
import unicodedata

import pymupdf
import pytest

from reportgen.base.errors import TypesetterError
from reportgen.base.records import replace
from reportgen.document import (
    Block,
    Cell,
    Column,
    Equation,
    Figure,
    LineBreak,
    List,
    PageBreak,
    Paragraph,
    Plate,
    Reference,
    Section,
    Table,
    Text,
)
from reportgen.drawing import Scene
from reportgen.formula import Chain, Expression, Number, Product, Sum, Symbol, Term, VectorEquation
from reportgen.writers import latex, pdflatex
from reportgen.writers.latex_math import MATHEMATICAL, TEXTUAL, escape
from tests.writers import sample
from tests.writers.pages import MM, by_latex, document, needs_tex, opened, sides


def folded(text: str) -> str:
    """Without line ends, and with one form for what fonts call by two names (… and ..., ⟂ and ⊥)."""
    text = text.replace("⟂", "⊥").replace("ϕ", "φ").replace("µ", "μ").replace("Ω", "Ω")
    return "".join(unicodedata.normalize("NFKC", text).split())


def printed(*blocks: Block) -> str:
    """The body of the pages of a document of these blocks: header and footer cut off."""
    clip = (0, 20 * MM, 1e4, 277 * MM)
    pages = by_latex(*blocks)
    return "\n".join(page.get_text(clip=pymupdf.Rect(clip)) for page in pages)


@pytest.fixture(scope="module")
def compiled() -> pdflatex.Compiled:
    return pdflatex.compile(latex.write(sample.sample()))


# --- text -----------------------------------------------------------------------------------------


@needs_tex
def test_text_reads_back_as_typed() -> None:
    hostile = (Paragraph((Text(sample.HOSTILE),)), Paragraph((Text(sample.VIETNAMESE),)))
    text = printed(*hostile)
    assert folded(sample.HOSTILE) in folded(text)
    # The letters are single code points, not bases with accents, and the spaces between them are real.
    assert sample.VIETNAMESE in " ".join(text.split())


@needs_tex
def test_every_declared_character_prints_in_text_and_in_formulas() -> None:
    spaces = {"\u00a0", "\u2009", "\u202f"}
    chars = "".join(char for char in (*MATHEMATICAL, *TEXTUAL) if char not in spaces) + "–—“”üßŁ"
    units = "".join(TEXTUAL.keys() - spaces)
    rows = [Symbol("x", sub=char) for char in MATHEMATICAL] + [Symbol("đ", "ốc", "Ữ")]
    text = folded(
        printed(Paragraph((Text(chars),)), Equation((Number(1.0, 0, units),)), *(Equation((row,)) for row in rows))
    )
    # The other names of the same glyphs.
    names = str.maketrans({"⋅": "·", "∘": "◦", "‐": "-"})
    missing = {char for char in folded(chars) if char.translate(names) not in text.translate(names)}
    assert not missing
    assert "đ" in text
    assert "ốc" in text


def test_an_unsupported_character_is_named_before_tex_runs() -> None:
    with pytest.raises(TypesetterError, match=r"U\+4E2D"):
        latex.write(document(Paragraph((Text("中"),))))


def test_escape_leaves_no_command() -> None:
    source = escape(sample.HOSTILE)
    commands = set(re.findall(r"\\([A-Za-z]+)", source))
    assert commands <= {
        "textbackslash",
        "textasciicircum",
        "textasciitilde",
        "textless",
        "textgreater",
        "textbar",
        "textquotedbl",
        "textquotesingle",
        "textasciigrave",
    }


# --- the whole document ---------------------------------------------------------------------------


@needs_tex
def test_sample_has_no_overfull_box(compiled: pdflatex.Compiled) -> None:
    assert compiled.overfull == ()
    # Titles are known before TeX runs, so the second pass only confirms the first one's page numbers.
    assert compiled.passes <= 2


@needs_tex
def test_every_block_prints(compiled: pdflatex.Compiled) -> None:
    text = folded("".join(page.get_text() for page in opened(compiled.pdf)))
    for words in (
        "Trường Đại học Mẫu",
        "Mã số: A_B-01 & 100%",
        "Mục lục",
        "1.1.1 Các bước dựng",
        "Chữ ký",
        "Bảng 2.2. Vận tốc và gia tốc",
        "Hình 1.1. Lược đồ",
        "Nhận xét. Mục này chạy cùng dòng",
        "(1.4)",
        "vì tay quay quay đều",
        "phương",
        "h)",
        "4. dựng đoạn",
    ):
        assert folded(words) in text, words


@needs_tex
def test_contents_give_true_pages_and_links(compiled: pdflatex.Compiled) -> None:
    pages = opened(compiled.pdf)
    outline = {title: page for _, title, page in pages.get_toc()}
    contents = pages[1].get_text()
    for title in ("Lời nói đầu", "Mọi biểu thức", "Kết luận"):
        (page,) = (page for words, page in outline.items() if words.endswith(title))
        assert title in pages[page - 1].get_text()
        assert re.search(rf"{title}[ .\n]*{page}\b", contents), title
    targets = {link.get("page") for link in pages[1].get_links()}
    assert outline["Kết luận"] - 1 in targets


@needs_tex
def test_references_lead_to_their_blocks(compiled: pdflatex.Compiled) -> None:
    pages = opened(compiled.pdf)
    cases = (("Theo (1.1) và", "(1.1)"), ("Xem Kết luận", "Kết luận"), ("Xem Kết luận", "Hình 2.2."))
    for words, target in cases:
        (page,) = (page for page in pages if words in page.get_text())
        reached = [pages[link["page"]].get_text() for link in page.get_links()]
        assert any(target in text for text in reached), target


@needs_tex
def test_blocks_inside_a_list_and_texts_that_look_like_options() -> None:
    inner = Equation((sample.expressions()[-1], sample.wide_chain()), key="inner", number="9.9")
    bare = replace(inner, key="")
    items = List(((Paragraph((Text("[f] xem "), Reference("inner", "(9.9)"))), inner), (List(((bare,),)),)))
    table = Table((Column(30), Column(30)), (sample.cells("[g]", "*"),), (sample.cells("*[h]", "[2mm]"),) * 2)
    centred = Paragraph((Text("trên"), LineBreak(), Text("[k] dưới")), "center")
    source = latex.write(document(items, table, centred))
    done = pdflatex.compile(source)
    assert done.overfull == ()
    text = folded(opened(done.pdf)[0].get_text())
    for words in ("[f] xem (9.9)", "[g]", "*[h]", "[2mm]", "[k] dưới"):
        assert folded(words) in text


@needs_tex
def test_a_framed_table_has_sides_that_reach_from_rule_to_rule() -> None:
    table = Table((Column(30), Column(30)), (sample.cells("a", "b"),), (sample.cells("1", "2"),) * 3)
    assert sides(opened(pdflatex.compile(latex.write(document(table))).pdf)) == []
    left, right = sides(opened(pdflatex.compile(latex.write(document(replace(table, framed=True)))).pdf))
    assert right - left == pytest.approx(60, abs=1)


@needs_tex
def test_wide_rows_break_and_stay_inside_the_margins() -> None:
    chain = sample.wide_chain()
    many = VectorEquation(
        (tuple(Term(sample.vector("R", f"{index}"), ("∥ AB và CD", None)) for index in range(12)),),
        ("phương", "độ lớn"),
    )
    long = Chain((Sum(chain.parts), Symbol("M")))
    rows: tuple[Expression, ...] = (chain, long, Product(chain.parts * 3), many)
    done = pdflatex.compile(latex.write(document(*(Equation((row,), number="1.1") for row in rows))))
    assert done.overfull == ()
    page = opened(done.pdf)[0]
    right = page.rect.width - 20 * MM
    # A number ends at the margin, but for the side bearing of its parenthesis.
    assert [place.x1 for place in page.search_for("(1.1)")] == pytest.approx([right] * 4, abs=0.5)
    # Broken lines begin with the relation or the sign, never end with it.
    lines = [line for line in page.get_text().splitlines() if line.strip()]
    assert not any(line.rstrip().endswith(("=", "+")) for line in lines)


@needs_tex
def test_long_table_repeats_its_head(compiled: pdflatex.Compiled) -> None:
    heads = [page.get_text().count("Gia tốc") for page in opened(compiled.pdf)]
    assert sum(count > 0 for count in heads) >= 2


@needs_tex
def test_three_rows_at_least_stand_on_a_page_and_no_colour_runs_on() -> None:
    # Tables of many lengths, so that some end just where a page does.
    tables = [sample.long_table(rows, f"t{rows}", "1.1") for rows in range(38, 46)]
    blocks = (block for table in tables for block in (PageBreak(), table))
    for page in by_latex(*blocks):
        rows = re.findall(r"^(\d+) *$", page.get_text(), re.MULTILINE)
        assert len(rows) == 0 or len(rows) >= 3
        colours = {
            span["color"]
            for block in page.get_text("dict")["blocks"]
            for line in block["lines"]
            for span in line["spans"]
            if span["text"].strip()
        }
        assert colours == {0}


@needs_tex
def test_plate_has_its_own_paper(compiled: pdflatex.Compiled) -> None:
    papers = [page.rect for page in opened(compiled.pdf)]
    sizes = [(paper.width / MM, paper.height / MM) for paper in papers]
    # TeX rounds a page's size to 0.001 bp.
    assert [pytest.approx((420, 297), abs=0.01)] == [size for size in sizes if size[0] > 211]


@needs_tex
def test_after_a_plate_the_pages_are_of_the_usual_size() -> None:
    (plate,) = (block for block in sample.blocks() if isinstance(block, Plate))
    before, after = Paragraph(sample.text("Before.")), Paragraph(sample.text("After."))
    sizes = [round(page.rect.width / MM) for page in by_latex(before, plate, PageBreak(), after)]
    assert sizes == [210, 420, 210]


@needs_tex
def test_nothing_stands_outside_the_margins(compiled: pdflatex.Compiled) -> None:
    for page in list(opened(compiled.pdf))[1:]:
        right = 20 if page.rect.width < 600 else 15
        left = 30 if page.rect.width < 600 else 15
        for word in page.get_text("words"):
            # Half a millimetre for the side bearings of glyphs.
            assert word[0] / MM > left - 0.5, word
            assert word[2] / MM < page.rect.width / MM - right + 0.5, word


@needs_tex
def test_english_reads_as_english() -> None:
    row = Equation((Chain((Symbol("v"), Number(-1.25, 2, "m/s"))),))
    english = replace(document(row), language="en", footer=("Theory of Machines", "Page"))
    text = folded(opened(pdflatex.compile(latex.write(english)).pdf)[0].get_text())
    assert "v=−1.25m/s" in text
    assert "Page1" in text


@needs_tex
def test_two_builds_are_identical(compiled: pdflatex.Compiled) -> None:
    assert pdflatex.compile(latex.write(sample.sample())).pdf == compiled.pdf


@needs_tex
def test_no_figure_passes_a_long_table() -> None:
    """The page has room for neither; the figure, which is called first, stands above the table on the next one."""
    filling = tuple(Paragraph((Text(f"Line {n}."),)) for n in range(30))
    figure = Figure((Scene(100.0, 80.0, ()),), (Text("waits"),), "fig.waits", "1")
    rows = tuple((Cell((Text(f"row {n}"),)),) for n in range(40))
    table = Table((Column(40.0),), (), rows, (Text("long"),), "tab.long", number="2")
    pages = by_latex(*filling, figure, table)
    where = [(number, page.search_for(words)) for number, page in enumerate(pages) for words in ("waits", "row 0")]
    found = [(number, places[0].y0) for number, places in where if places]
    assert [number for number, _ in found] == [1, 1]
    assert found[0][1] < found[1][1]


@needs_tex
def test_a_part_begins_below_the_text_that_follows_a_figure() -> None:
    """A figure and the last lines before a heading have gone to the next page: the part has its beginning there."""
    filling = tuple(Paragraph((Text(f"Line {n}."),)) for n in range(38))
    figure = Figure((Scene(100.0, 80.0, ()),), (Text("waits"),), "fig.waits", "1")
    overrunning = Paragraph((Text("More words than this page has room for. " * 6),))  # three lines do not part
    part = Section(1, (Text("Conclusion"),))
    pages = by_latex(*filling[:30], figure, *filling[30:], overrunning, part, Paragraph((Text("Last words."),)))
    assert ["waits" in page.get_text() for page in pages] == [False, True]
    assert "Last words." in pages[1].get_text()
