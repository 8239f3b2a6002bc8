"""What a page says first, how large its formulas are, and what its numbers stand for."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.template_folders import templates
from reportgen.document import Figure, Paragraph, Section, Table, plain
from reportgen.document.layout import FIGURE_HEIGHT, fits, height, in_parts
from reportgen.formula import Chain, Expression, Symbol
from reportgen.formula.formula_layout import Parenthesis, displayed
from reportgen.formula.plain_text import Plain
from tests.report import built
from tests.report.built import Report, Written
from tests.report.test_report_figures import captions

LEAST = 8.0
"""Points: the smallest letter on a formula's line; its indices are 0.7 of it."""
HEAVY = """
kind: shaper
report: {language: en, worked_positions: [5]}
positions: {count: 12}
parameters:
  {a: 270 mm, b: 52 cm, l3: 550 mm, l4: 100 mm, H: 300 mm, n: 52 rpm, cutting: {F: 1000 N, free: 0.05},
   G2: 30 N, G3: 200 N, J3: 0.6 kg m2, G4: 40 N, J4: 0.1 kg m2, G5: 600 N}
"""
"""A shaper all of whose links have masses: M as a function of the crank's angle has ten terms over ω₁."""


@pytest.fixture(scope="module")
def heavy(tmp_path_factory: pytest.TempPathFactory) -> Report:
    path = tmp_path_factory.mktemp("heavy") / "heavy.yaml"
    path.write_text(HEAVY, encoding="utf-8")
    return built.typeset(built.compose(api.load(path)), "typst")


def least_of_equals(report: Report) -> float:
    """The size (points) of the smallest "=" on a page, all of which stand on the line of a formula or of a text."""
    pages = (page for page in report.pages if not page.is_plate)
    return min(glyph.size for page in pages for glyph in page.body if glyph.char == "=")


def test_no_formula_is_squeezed(report: Report) -> None:
    assert least_of_equals(report) >= LEAST


def test_a_fraction_wider_than_its_line_breaks_at_its_terms(heavy: Report) -> None:
    assert least_of_equals(heavy) >= LEAST


def test_what_is_opened_says_the_same() -> None:
    """(a + b + …)/c as 1/c · (a + b + …): its pieces, read in order, have the value of the fraction."""
    terms = [Symbol("ABCDEFGH"[i]) * Symbol("k", str(i)) for i in range(8)]
    fraction: Expression = sum(terms[1:], terms[0]) / Symbol("ω", "1")
    row = Chain((Symbol("M"), fraction))
    whole, opened = displayed(row, "en"), displayed(row, "en", lambda parts: False)
    assert [len(side) for side in whole] == [1, 1]
    assert [len(side) for side in opened] == [1, len(terms)]
    assert not any(isinstance(part, Parenthesis) for part in whole[1])
    text = "".join(Plain("en").part(piece) for piece in opened[1])
    values = {name: 1.5 + i for i, name in enumerate("ABCDEFGH")} | {"ω_1": 4.0} | {f"k_{i}": 0.1 * i for i in range(8)}
    for name, value in sorted(values.items(), reverse=True):
        text = text.replace(name, repr(value))
    found = eval(text.replace("·", "*").replace("−", "-"))
    expected = sum((1.5 + i) * 0.1 * i for i in range(8)) / 4.0
    assert found == pytest.approx(expected, rel=1e-12)


def test_what_fits_is_left_as_it_is() -> None:
    row = Chain((Symbol("M"), (Symbol("a") + Symbol("b")) / Symbol("c")))
    assert displayed(row, "en", fits) == displayed(row, "en")


def test_no_figure_stands_above_its_heading(report: Report) -> None:
    """A figure is on a later page than the heading that it belongs to, or lower on the same one."""
    word, section = report.document.words.figure, None
    own: dict[str, str] = {}
    for block in report.document.blocks:
        if isinstance(block, Section) and block.number:
            section = block.number
        elif isinstance(block, Figure) and section and not block.turned:
            own.setdefault(block.number, section)
    headings: dict[str, tuple[int, float]] = {}
    figures: dict[str, tuple[int, float]] = {}
    for page in report.pages:
        for line, top in page.lines:
            number = line.split(" ")[0].split("\u2003")[0]
            size = max((glyph.size for glyph in page.body if abs(glyph.box[1] - top) < 6 and glyph.bold), default=0)
            if size > 11.6 and number in own.values():
                headings.setdefault(number, (page.number, top))
        for number, top in captions(page, word).items():
            figures.setdefault(number, (page.number, top))
    seen = {number for number in own if number in figures and own[number] in headings}
    assert len(seen) >= 0.5 * len(own)
    assert [number for number in seen if figures[number] < headings[own[number]]] == []


def test_a_figure_is_in_two_parts_at_most(written: Written) -> None:
    for block in built.walk(written.document.blocks):
        if isinstance(block, Figure) and not block.turned:
            parts = in_parts(block)
            assert len(parts) <= 2 or sum(map(height, parts)) > 2 * FIGURE_HEIGHT, block.number


def test_given_data_stand_as_they_were_typed(heavy: Report) -> None:
    given = next(b for b in heavy.document.blocks if isinstance(b, Table) and b.key == "tab.given")
    values = [plain(row[-1].inlines, "en").replace("\N{NARROW NO-BREAK SPACE}", " ") for row in given.rows]
    for typed in ("270 mm", "52 cm", "550 mm", "100 mm", "300 mm", "1000 N", "200 N", "0.6 kg·m²"):
        assert typed in values


def test_no_vector_is_laid_off_with_a_length_of_nothing() -> None:
    """Where a known force or acceleration is zero, its ends coincide, and the words say so."""
    tree = built.written(built.ROOT / "assignments" / "shaper-02.yaml", "vi")
    told = [plain(block.inlines, "vi") for block in built.walk(tree.document.blocks) if isinstance(block, Paragraph)]
    assert any("h ≡ i" in text for text in told)
    assert not [text for text in told if "= 0\N{NARROW NO-BREAK SPACE}mm" in text]


def test_components_in_a_function_are_defined_before_it(heavy: Report) -> None:
    """M names the components of S4's velocity and acceleration, whose functions stand above it."""
    text = "".join("".join(page.sheet.get_text().split()) for page in heavy.pages)
    assert "componentsofthevelocity" in text
    assert ",," not in text


@pytest.mark.parametrize(
    "word",
    ["coefficient of speed increase", "Mercalov", "thanh truyền thứ hai", "second rod BE", "Véctơ khép kín đa giác"],
)
def test_words_that_the_field_does_not_use(word: str) -> None:
    files = [*Path(templates()).glob("??/*.*"), *Path(templates()).glob("??/catalogue/*.md")]
    assert len(files) > 20
    assert [path.name for path in files if word in path.read_text(encoding="utf-8")] == []
