"""The LaTeX writer: what stands on the pages, where the strokes lie, and how it fails."""

from __future__ import annotations

import re
import shutil
import unicodedata
from dataclasses import replace
from pathlib import Path

import pytest

from reportgen.document.tree import (
    Block,
    Column,
    Document,
    Equation,
    Figure,
    LineBreak,
    List,
    PageBreak,
    Paragraph,
    Reference,
    Section,
    Table,
    Text,
)
from reportgen.errors import TypesetterError
from reportgen.figures.scene import Arc, Arrow, Circle, Hatch, Label, Line, Polyline, Scene, Stroke
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Number,
    Product,
    Ref,
    Sum,
    Symbol,
    Term,
    VectorEquation,
    divide,
    multiply,
    negative,
    power,
    subtract,
)
from reportgen.paint.tex import paint
from reportgen.writers import latex, pdflatex
from reportgen.writers.latex_math import aligned, mathematics
from reportgen.writers.latex_text import MATHEMATICAL, TEXTUAL, escape
from tests.writers import sample

pymupdf = pytest.importorskip("pymupdf")

needs_tex = pytest.mark.skipif(
    shutil.which("pdflatex") is None, reason="pdflatex is not installed; install it with " + pdflatex.INSTALL
)

POINTS_PER_MM = 72 / 25.4


def document(*blocks: Block) -> Document:
    return replace(sample.sample(), blocks=blocks)


def opened(pdf: bytes) -> pymupdf.Document:
    return pymupdf.open(stream=pdf, filetype="pdf")


def folded(text: str) -> str:
    """Without line ends, and with one form for what fonts call by two names (… and ..., ⟂ and ⊥)."""
    text = text.replace("⟂", "⊥").replace("ϕ", "φ").replace("µ", "μ").replace("Ω", "Ω")
    return "".join(unicodedata.normalize("NFKC", text).split())


def printed(*blocks: Block) -> str:
    """The body of the pages of a document of these blocks: header and footer cut off."""
    clip = (0, 20 * POINTS_PER_MM, 1e4, 277 * POINTS_PER_MM)
    pages = opened(latex.render(document(*blocks)))
    return "\n".join(page.get_text(clip=pymupdf.Rect(clip)) for page in pages)


@pytest.fixture(scope="module")
def compiled() -> pdflatex.Compiled:
    return latex.compile(latex.write(sample.sample()))


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
        printed(
            Paragraph((Text(chars),)),
            Equation((Number(1.0, 0, units),)),
            *(Equation((row,)) for row in rows),
        )
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


# --- mathematics ----------------------------------------------------------------------------------

A, B, C = Symbol("a"), Symbol("b"), Symbol("c")


def plain(source: str) -> str:
    """A formula without the marks that only lines and gaps need."""
    return re.sub(r"\\(relbreak|binbreak|dotbreak|mathopen\{\})|\s+", "", source)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (subtract(A, Sum((B, C))), "a-(b+c)"),
        (multiply(Sum((A, B)), C), r"(a+b)\cdotc"),
        (Product((A, Number(-1.5, 1))), r"a\cdot(-1{,}5)"),
        (Sum((A, Number(-1.5, 1))), "a+(-1{,}5)"),
        (negative(negative(A)), "-(-a)"),
        (power(negative(A), 2), "(-a)^{2}"),
        (power(power(A, 2), 3), "(a^{2})^{3}"),
        (power(divide(A, B), 2), r"\left(\frac{a}{b}\right)^{2}"),
        (divide(Sum((A, B)), C), r"\frac{a+b}{c}"),
        (Symbol("a", "BA", "n", "vector"), r"\vec{a}_{\mathrm{BA}}^{\mathrm{n}}"),
        (Symbol("pb", over="segment"), r"\overline{\mathit{pb}}"),
        (Symbol("p", "3", "′"), r"p_{3}^{\prime}"),
        (Number(10.943, 3, "m/s"), r"10{,}943\,\text{m/s}"),
        (Number(60, None, "°"), r"60\text{°}"),
        (Number(-0.0001, 2, "N"), r"0{,}00\,\text{N}"),
    ],
)
def test_formulas(expression: Expression, expected: str) -> None:
    assert plain(mathematics(expression, "vi")) == expected


def test_english_numbers_have_a_point() -> None:
    assert mathematics(Number(1.5, 1), "en") == "1.5"


def test_a_chain_is_cut_at_its_first_relation() -> None:
    left, rest = aligned(Chain((A, B, C)), "vi")
    assert (plain(left), plain(rest)) == ("a", "=b=c")


def test_a_reference_nobody_substituted_is_refused() -> None:
    with pytest.raises(TypesetterError, match="v_A"):
        mathematics(Ref("v_A"), "vi")


# --- the whole document ---------------------------------------------------------------------------


@needs_tex
def test_sample_has_no_overfull_box(compiled: pdflatex.Compiled) -> None:
    assert compiled.overfull == ()
    # Titles are known before TeX runs, so the second pass only confirms the first one's page numbers.
    assert compiled.passes <= 3


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
    done = latex.compile(source)
    assert done.overfull == ()
    text = folded(opened(done.pdf)[0].get_text())
    for words in ("[f] xem (9.9)", "[g]", "*[h]", "[2mm]", "[k] dưới"):
        assert folded(words) in text


@needs_tex
def test_wide_rows_break_and_stay_inside_the_margins() -> None:
    chain = sample.wide_chain()
    many = VectorEquation(
        (tuple(Term(sample.vector("R", f"{index}"), ("∥ AB và CD", None)) for index in range(12)),),
        ("phương", "độ lớn"),
    )
    long = Chain((Sum(chain.parts), Symbol("M")))
    rows: tuple[Expression, ...] = (chain, long, Product(chain.parts * 3), many)
    done = latex.compile(latex.write(document(*(Equation((row,), number="1.1") for row in rows))))
    assert done.overfull == ()
    page = opened(done.pdf)[0]
    right = page.rect.width - 20 * POINTS_PER_MM
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
    for page in opened(latex.render(document(*blocks))):
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
    sizes = [(paper.width / POINTS_PER_MM, paper.height / POINTS_PER_MM) for paper in papers]
    # TeX rounds a page's size to 0.001 bp.
    assert [pytest.approx((420, 297), abs=0.01)] == [size for size in sizes if size[0] > 211]
    assert sizes[-1] == pytest.approx((210, 297), abs=0.01)


@needs_tex
def test_nothing_stands_outside_the_margins(compiled: pdflatex.Compiled) -> None:
    for page in list(opened(compiled.pdf))[1:]:
        right = 20 if page.rect.width < 600 else 15
        left = 30 if page.rect.width < 600 else 15
        for word in page.get_text("words"):
            # Half a millimetre for the side bearings of glyphs.
            assert word[0] / POINTS_PER_MM > left - 0.5, word
            assert word[2] / POINTS_PER_MM < page.rect.width / POINTS_PER_MM - right + 0.5, word


@needs_tex
def test_english_reads_as_english() -> None:
    row = Equation((Chain((Symbol("v"), Number(-1.25, 2, "m/s"))),))
    english = replace(document(row), language="en", footer=("Theory of Machines", "Page"))
    text = folded(opened(latex.render(english))[0].get_text())
    assert "v=−1.25m/s" in text
    assert "Page1" in text


@needs_tex
def test_two_builds_are_identical(compiled: pdflatex.Compiled) -> None:
    assert latex.render(sample.sample()) == compiled.pdf


# --- drawings -------------------------------------------------------------------------------------


def drawn(scene: Scene) -> tuple[pymupdf.Page, complex]:
    """The page with one scene alone, and the scene's origin on it in points (y up)."""
    frame = Polyline(
        (0j, complex(scene.width), complex(scene.width, scene.height), 1j * scene.height),
        Stroke(0.1, "#00ff00"),
        closed=True,
    )
    page = opened(latex.render(document(Figure((replace(scene, items=(frame, *scene.items)),)))))[0]
    (box,) = (path["rect"] for path in page.get_drawings() if path.get("color") == (0, 1, 0))
    return page, complex(box.x0, page.rect.height - box.y1)


@needs_tex
def test_arrow_tips_lie_where_the_scene_says() -> None:
    scene = sample.star()
    page, origin = drawn(scene)
    heads = [path for path in page.get_drawings() if path["type"] == "f"]
    arrows = [item for item in scene.items if isinstance(item, Arrow)]
    assert len(heads) == len(arrows)
    for arrow, head in zip(arrows, heads, strict=True):
        tip = head["items"][0][1]
        at = (complex(tip.x, page.rect.height - tip.y) - origin) / POINTS_PER_MM
        # 0.1 mm is what a ruler shows; the operators carry 0.001 mm.
        assert abs(at - arrow.end) < 0.1, arrow.name


@needs_tex
def test_labels_stand_at_their_anchors() -> None:
    anchors = ("left", "right", "center", "top", "bottom")
    items = tuple(Label(complex(30, 15 * row), "HHH", anchor) for row, anchor in enumerate(anchors, 1))
    page, origin = drawn(Scene(60, 90, (*items, Label(50 + 40j, "TTT", turn=90))))
    spans = [
        span
        for block in page.get_text("dict")["blocks"]
        for line in block["lines"]
        for span in line["spans"]
        if span["text"] == "HHH"
    ]
    found = {}
    for span in spans:
        x0, _, x1, _ = ((x - origin.real) / POINTS_PER_MM for x in span["bbox"])
        base = (page.rect.height - span["origin"][1] - origin.imag) / POINTS_PER_MM
        found[round(base / 15)] = (x0, x1, base)
    left, right, centre, top, bottom = (found[row] for row in range(1, 6))
    # The boxes are those of TeX; a PDF's widths are rounded to a thousandth of the size, here 0.01 mm.
    assert left[0] == pytest.approx(30, abs=0.02)
    assert right[1] == pytest.approx(30, abs=0.02)
    for x0, x1, _ in (centre, top, bottom):
        assert (x0 + x1) / 2 == pytest.approx(30, abs=0.02)
    # Capitals of Latin Modern are 0.683 of the size high and have no depth; TeX's metrics hold
    # only 16 heights for a font, so that of a letter may be 0.05 mm off.
    height = 0.683 * 9 / 72.27 * 25.4
    for row, share in enumerate((0.5, 0.5, 0.5, 1, 0), 1):
        assert found[row][2] == pytest.approx(15 * row - share * height, abs=0.06)
    (turned,) = (word for word in page.get_text("words") if word[4] == "TTT")
    assert turned[3] - turned[1] > turned[2] - turned[0]
    height = page.rect.height - (turned[1] + turned[3]) / 2 - origin.imag
    assert height / POINTS_PER_MM == pytest.approx(40, abs=0.05)


@needs_tex
def test_pens_are_as_wide_and_coloured_as_said() -> None:
    items = (
        Line(5 + 5j, 55 + 5j, Stroke(0.5, "#ff0000", (2.0, 1.0))),
        Circle(30 + 20j, 8, None, "#0000ff"),
        Arc(30 + 20j, 10, 0.0, 3.0, Stroke(0.35, "#800000"), head=2.0),
        Hatch((5 + 35j, 25 + 35j, 25 + 45j, 5 + 45j), 2.0),
    )
    page, origin = drawn(Scene(60, 60, items))
    paths = page.get_drawings()
    (line,) = (path for path in paths if path.get("color") == (1, 0, 0))
    assert line["width"] == pytest.approx(0.5 * POINTS_PER_MM, abs=0.01)
    assert line["dashes"].startswith("[")
    (disc,) = (path for path in paths if path.get("fill") == (0, 0, 1))
    centre = (disc["rect"].tl + disc["rect"].br) / 2
    at = (complex(centre.x, page.rect.height - centre.y) - origin) / POINTS_PER_MM
    assert abs(at - (30 + 20j)) < 0.02
    assert disc["rect"].width == pytest.approx(16 * POINTS_PER_MM, abs=0.05)


def test_a_painted_scene_is_ascii_operators_and_labels() -> None:
    source = paint(Scene(10, 10, (Line(0j, 10 + 10j), Label(5 + 5j, "a_b", background=True))), "vi")
    assert source.startswith(r"\scene{10}{10}{")
    assert "0 0 m 10 10 l S" in source
    assert r"\lb{5}{5}{.5}{.5}{\lbpaper{a\_b}}" in source


# --- faults ---------------------------------------------------------------------------------------


def test_missing_tex_names_the_remedy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(TypesetterError, match="apt-get install --no-install-recommends") as caught:
        latex.compile(latex.write(document(Section(1, (Text("a"),)))))
    assert caught.value.exit_code == 3


@needs_tex
def test_missing_package_names_the_remedy() -> None:
    with pytest.raises(TypesetterError, match=r"no-such-package[\s\S]*apt-get install"):
        latex.compile(r"\documentclass{article}\usepackage{no-such-package}\begin{document}a\end{document}")


@needs_tex
def test_a_fault_gives_the_lines_of_the_log() -> None:
    with pytest.raises(TypesetterError, match=r"Undefined control sequence[\s\S]*nonsense"):
        latex.compile(r"\documentclass{article}\begin{document}\nonsense\end{document}")


@needs_tex
def test_a_run_without_end_is_stopped() -> None:
    with pytest.raises(TypesetterError, match="stopped after 1 s"):
        latex.compile(r"\documentclass{article}\begin{document}\def\a{\a}\a\end{document}", timeout=1)


@needs_tex
def test_files_outside_stay_closed(tmp_path: Path) -> None:
    secret = tmp_path / "secret.tex"
    secret.write_text("secret words", encoding="utf-8")
    with pytest.raises(TypesetterError):
        latex.compile(rf"\documentclass{{article}}\begin{{document}}\input{{{secret}}}\end{{document}}")


def test_overfull_boxes_are_read_from_the_log() -> None:
    log = (
        "Overfull \\hbox (0.5pt too wide) in paragraph at lines 1--2\n"
        "Overfull \\hbox (12.75pt too wide) in paragraph at lines 3--4\n"
        "Overfull \\vbox (3.0pt too high) has occurred while \\output is active []\n"
    )
    assert [line[10:24] for line in latex.overfull(log)] == ["hbox (12.75pt ", "vbox (3.0pt to"]
