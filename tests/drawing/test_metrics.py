"""Label boxes against what a typesetter measures of the same labels."""

from __future__ import annotations

from collections.abc import Sequence

import pymupdf
import pytest
import typst

from reportgen.drawing.label_candidates import CLEAR
from reportgen.drawing.label_size import box
from reportgen.formula import Call, Chain, Expression, Fraction, Number, Symbol, cos, sin
from reportgen.writers.typst_fonts import added
from reportgen.writers.typst_math import TypstFormulas

LABELS: tuple[Expression | str, ...] = (
    Symbol("p"),
    Symbol("A", "12"),
    Symbol("b", sup="′"),
    Symbol("s", "2", "′"),
    Symbol("R", "14", "n"),
    Symbol("P", "qt4"),
    Symbol("R", "05", over="vector"),
    Symbol("ω", "1"),
    Symbol("n", "BA"),
    Number(-28.27, 2, "mm"),
    Chain((Symbol("μ", "v"), Number(0.2189, 4, "m/(s·mm)"))),
    Chain((Symbol("p"),), "N/cm²"),
    Fraction(Symbol("a"), Symbol("b", "1")),
    "10:1",
    "Quá trình nạp",
    Symbol("M", "ур"),
    Symbol("F", "и4"),
    Chain((Symbol("μ", "V"), Number(0.2189, 4, "м/(с·мм)"))),
    "Рабочий ход",
)


T_2 = Chain((Symbol("t", "2"), Symbol("T") - Symbol("t", "1"), Number(0.6742) - Number(0.4211), Number(0.253, 4, "s")))
OMEGA, L, PHI, BETA = Symbol("ω", "1"), Symbol("l", "AB"), Symbol("φ"), Symbol("β")


def measured(pages: Sequence[str], points: int) -> list[tuple[float, float]]:
    """Width and height (mm) of what the typesetter makes of each page at a font size."""
    source = (
        "#set page(width: auto, height: auto, margin: 0mm)\n"
        f'#set text({points}pt, font: "New Computer Modern", top-edge: "bounds", bottom-edge: "bounds")\n'
        '#show math.equation: set text(font: "New Computer Modern Math")\n' + "\n".join(pages)
    )
    with pymupdf.open(stream=typst.compile(source.encode())) as document:
        return [(page.rect.width * 25.4 / 72, page.rect.height * 25.4 / 72) for page in document]


def test_boxes_agree_with_the_typesetter() -> None:
    pages = [
        f'#page(text("{label}"))' if isinstance(label, str) else f"#page(${TypstFormulas('en').math(label)}$)"
        for label in LABELS
    ]
    for label, (width, height) in zip(LABELS, measured(pages, 9), strict=True):
        ours = box(label, 9.0)
        # What placement keeps clear on both sides takes up the difference of two typesetters; a long
        # line's spaces stretch by a tenth.
        assert ours.width == pytest.approx(width, abs=2 * CLEAR, rel=0.12), label
        assert ours.height + ours.depth == pytest.approx(height, abs=2 * CLEAR), label


@pytest.mark.parametrize("label", ["机构运动简图", "位置6的速度多边形", "表4（续）末", "力臂，mm", "a点"])
def test_boxes_of_chinese_agree_with_the_typesetter(label: str) -> None:
    if not (folders := added()):
        pytest.skip("the extra zh is not installed")
    source = (
        "#set page(width: auto, height: auto, margin: 0mm)\n"
        '#set text(9pt, font: ("New Computer Modern", "Noto Serif SC"), top-edge: "bounds", bottom-edge: "bounds")\n'
        f'#page(text("{label}"))'
    )
    with pymupdf.open(stream=typst.compile(source.encode(), font_paths=[*folders])) as document:
        width, height = (size * 25.4 / 72 for size in (document[0].rect.width, document[0].rect.height))
    ours = box(label, 9.0)
    assert ours.width == pytest.approx(width, abs=0.15)
    assert height <= ours.height + ours.depth + 0.05 <= height + 1.0


def test_boxes_grow_with_the_font() -> None:
    small, large = box(Symbol("s", "2", "′"), 8.0), box(Symbol("s", "2", "′"), 16.0)
    assert large.width == pytest.approx(2 * small.width)
    assert large.depth == pytest.approx(2 * small.depth)


@pytest.mark.parametrize(
    "row",
    [
        T_2,
        Chain((Symbol("l", "AE"), Number(0.09) - Number(0.03), Number(0.06, 2, "m"))),
        -OMEGA * L * sin(PHI) + OMEGA * L * sin(BETA),
        Symbol("S") * cos(PHI - BETA) - (L + OMEGA) * cos(BETA) ** 2,
        Chain((BETA, Call("arcsin", (L / Symbol("r"),)), Number(30.0, 3, "°"))),
    ],
    ids=str,
)
def test_a_displayed_row_is_as_wide_as_the_typesetter_sets_it(row: Expression) -> None:
    ((width, _),) = measured([f"#page($ {TypstFormulas('en').math(row)} $)"], 12)
    assert box(row, 12.0, displayed=True).width == pytest.approx(width, abs=3.0)


def test_a_minus_is_as_wide_as_a_plus() -> None:
    plus, minus = L + OMEGA + BETA, L - OMEGA - BETA
    assert box(minus).width == pytest.approx(box(plus).width)


def test_an_empty_label_takes_no_room() -> None:
    assert box("") == box("", 20.0)
