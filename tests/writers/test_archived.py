"""What every PDF of typst promises to archives and to whoever has it read aloud, and what is told where it cannot."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import date
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.errors import OutputWarning, TypesetterError
from reportgen.base.pdf_standards import KNOWN, STANDARDS, other_than_usual, titled
from reportgen.base.process_limits import TEMPLATES, call_within
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.document import Cell, Column, Document, Figure, InlineMath, Paragraph, Section, Table, Text
from reportgen.formula import Symbol
from reportgen.writers import typst_compiler
from tests.lanes import matrix, proof
from tests.marking.test_papers import PAPERS
from tests.report import built
from tests.sheets.laid import laid
from tests.writers import sample, tags
from tests.writers.pages import document, opened

HELD = ("ua-1", "a-2a")
"""PDF/UA-1 (ISO 14289-1) and PDF/A-2a (ISO 19005-2)."""
PART_AND_LEVEL = ("1", "2a")
"""How a file names them."""
PRIVATE = "\ue000"
"""A letter without a meaning, which PDF/A forbids and no font is asked for."""


@contextmanager
def nothing_told() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("error", OutputWarning)
        yield


# --- every kind of document -------------------------------------------------------------------------


def sheet(language: Language) -> bytes:
    case = built.case(built.SAMPLE, language)
    return api.typeset_sheet(
        laid("slotted-lever-01", "A2").sheets[0], case.title, case.assignment, case.words["told"], STANDARDS
    )


def on_paper(document: Document) -> bytes:
    return api.typeset(document, "typst")[1]


MADE: dict[str, Callable[[Language], bytes]] = {
    **{name: lambda language, paper=paper: on_paper(paper(language)) for name, paper in PAPERS.items()},
    "report": lambda language: built.report(built.SAMPLE, "typst", language).pdf,
    "other": lambda language: built.report(built.SLIDE, "typst", language).pdf,
    "sample": lambda language: on_paper(replace(sample.sample(), language=language)),
    "sheet": sheet,
}


@cache
def made(name: str, language: Language) -> tags.Archived:
    with nothing_told():
        return tags.read(MADE[name](language))


CASES = matrix(
    [pytest.param(name, language, id=f"{name}-{language}") for name in MADE for language in built.LANGUAGES],
    telling=[("report", "vi"), ("task", "vi"), ("key", "en"), ("feedback", "vi"), ("class", "en"), ("sheet", "vi")],
)
every = pytest.mark.parametrize(("name", "language"), CASES)


@every
def test_a_file_names_the_standards_that_it_keeps(name: str, language: Language) -> None:
    found = made(name, language)
    assert found.standards == PART_AND_LEVEL
    assert found.is_marked
    assert found.shows_title


@every
def test_a_file_says_its_title_its_language_and_a_date(name: str, language: Language) -> None:
    found = made(name, language)
    assert found.title
    assert found.language == language
    assert re.match(r"D:\d{8}", found.date)


@every
def test_each_formula_and_each_figure_has_words(name: str, language: Language) -> None:
    found = made(name, language)
    silent = [tag for tag in found.of("Formula", "Figure") if not tag.alt.strip()]
    assert silent == []
    assert found.of("Formula", "Figure") or name in {"feedback", "class"}


@every
def test_each_head_of_a_table_says_of_what(name: str, language: Language) -> None:
    heads = made(name, language).of("TH")
    assert {tag.scope for tag in heads} <= {"Column"}
    assert heads or name == "sheet"


@every
def test_headings_lead_from_level_to_level(name: str, language: Language) -> None:
    levels = [int(tag.name[1]) for tag in made(name, language).of("H1", "H2", "H3")]
    assert all(level <= before + 1 for before, level in zip((0, *levels), levels, strict=False))


def test_figures_are_told_and_have_no_labels_besides() -> None:
    """Else a reader would say each letter of a plan after its description."""
    figures = made("report", "vi").of("Figure")
    assert len(figures) == len({id(block) for block in figures_of(built.written(built.SAMPLE, "vi").document)})
    assert {tag.name for figure in figures for tag in figure.walk()} == {"Figure"}


def figures_of(document: Document) -> list[Any]:
    return [scene for _, scene in built.scenes(document)]


# --- where and whose it is ---------------------------------------------------------------------------


def test_the_date_is_that_of_the_report_or_a_fixed_one() -> None:
    dated = replace(sample.sample(), date=date(2011, 3, 24))
    assert tags.read(on_paper(dated)).date.startswith("D:20110324")
    undated = [on_paper(replace(dated, date=None)) for _ in range(2)]
    assert undated[0] == undated[1]
    assert built.assignment(built.SAMPLE).report.date == date(2011, 3, 24)
    assert made("report", "vi").date.startswith("D:20110324")
    assert made("sheet", "vi").date.startswith("D:20110324")


def test_the_author_is_the_student_or_nobody() -> None:
    assert tags.read(on_paper(replace(sample.sample(), author="Lê Hoàng"))).author == "Lê Hoàng"
    nobody = tags.read(on_paper(replace(sample.sample(), author="")))
    assert nobody.author == ""
    assert "dc:creator" not in nobody.metadata


def test_a_task_is_called_by_its_own_title(tmp_path: Path) -> None:
    title = made("task", "vi").title
    assert title != "Nguyên lý máy"
    assert title.endswith("engine-twin-05")


# --- what is read, and in which order ----------------------------------------------------------------


def line(words: str, base: str) -> Paragraph:
    return Paragraph((Text(f"{words} "), InlineMath(Symbol(base))))


def test_a_float_is_read_where_it_is_called() -> None:
    """Its page has no room left for it, so what is read behind it is printed before it."""
    above, below = [line("above", "a")] * 25, [line("below", "b")] * 40
    figure = Figure((sample.star(150.0),), (Text("The star"),), "fig.star")
    pdf = on_paper(document(Section(1, (Text("Stars"),)), *above, figure, *below))
    read = ["star" if tag.name == "Figure" else tag.alt for tag in tags.read(pdf).of("Formula", "Figure")]
    assert read == [*["a"] * 25, "star", *["b"] * 40]
    pages = [page.get_text() for page in opened(pdf)]
    assert "below" in pages[0]
    assert "The star" not in pages[0]
    assert "The star" in pages[1]


def table(rows: int) -> Table:
    columns = (Column(30.0), Column(30.0))
    head = tuple(Cell((Text(text),)) for text in ("A", "B"))
    body = tuple(tuple(Cell((Text(f"{row}{column}"),)) for column in range(2)) for row in range(rows))
    return Table(columns, (head,), body, (Text("C"),), "tab.c", "1")


def test_heads_that_a_table_repeats_are_read_once() -> None:
    few, many = (tags.read(on_paper(document(Section(1, (Text("A"),)), table(rows)))) for rows in (70, 140))
    assert len(few.of("TH")) == len(many.of("TH"))
    assert len(few.of("Table")) == len(many.of("Table")) == 1


def test_words_before_an_equation_are_one_paragraph_with_their_formulas() -> None:
    found = made("report", "vi")
    (whole,) = found.tags
    assert not [tag for tag in whole.below if tag.name in {"Span", "Link"}]


def test_running_lines_and_strokes_are_no_content() -> None:
    """Every stroke is within an artifact; so are header and footer, each with its letters."""
    pages = list(opened(MADE["sample"]("vi")))
    for page in pages:
        assert strokes_read(page.read_contents()) == 0
    for page in pages[1:]:
        assert {"Header", "Footer"} <= {kind for kind, letters in artifacts(page.read_contents()) if letters}


TOKENS = re.compile(rb"\((?:\\.|[^\\()])*\)|<<.*?>>|/[^\s/\[\]<>()]*|[^\s/\[\]<>()]+", re.DOTALL)


def operators(content: bytes) -> Iterator[tuple[bytes, bytes, bool]]:
    """Each operator of a page with what the innermost open sequence is, and whether an artifact is open."""
    open_sequences: list[bytes] = []
    before: list[bytes] = []
    for token in TOKENS.findall(content):
        if token in {b"BDC", b"BMC"}:
            open_sequences.append(b"".join(before[-2:]))
        elif token == b"EMC":
            open_sequences.pop()
        else:
            inner = open_sequences[-1] if open_sequences else b""
            yield token, inner, any(b"/Artifact" in one for one in open_sequences)
        before = [*before[-1:], token]


def strokes_read(content: bytes) -> int:
    """How many strokes and fillings are no artifacts."""
    painting = {b"S", b"s", b"f", b"F", b"f*", b"B", b"b", b"B*", b"b*"}
    return sum(token in painting and not is_artifact for token, _, is_artifact in operators(content))


def artifacts(content: bytes) -> set[tuple[str, bool]]:
    """The kinds of running artifacts, and whether they have letters."""
    found: dict[str, bool] = {}
    for token, inner, _ in operators(content):
        if kind := re.search(rb"/Subtype\s*/(\w+)", inner):
            name = kind[1].decode()
            found[name] = found.get(name, False) or token in {b"Tj", b"TJ"}
    return set(found.items())


# --- other standards, and what they refuse ------------------------------------------------------------


DATED = '#set document(title: "x", date: datetime(year: 2000, month: 1, day: 1))\n'


def test_names_of_standards() -> None:
    assert STANDARDS == HELD
    assert titled(("ua-1", "a-2a", "1.7")) == "PDF/UA-1, PDF/A-2a, PDF 1.7"
    assert (other_than_usual(STANDARDS), other_than_usual(()), other_than_usual(("a-2b",))) == ("", "none", "a-2b")


@pytest.mark.parametrize("standard", KNOWN)
def test_the_typesetter_knows_each_of_them(standard: str) -> None:
    """One that it does not know is no error of a document."""
    with warnings.catch_warnings():
        # Some forbid what any document of ours has.
        warnings.simplefilter("ignore", OutputWarning)
        assert typst_compiler.compile(f"{DATED}= A", standards=(standard,)).startswith(b"%PDF-")


def test_none_and_others_are_kept_as_asked() -> None:
    with nothing_told():
        assert tags.read(typst_compiler.compile(f"{DATED}= A", standards=())).standards == ("", "")
        assert tags.read(typst_compiler.compile(f"{DATED}= A", standards=("a-2b",))).standards == ("", "2b")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("= A\n=== B", "skipped from heading level 1 to 3"),
        ("= A $x$", "alt text"),
        (f"= A {PRIVATE}", "e000"),
        ("= A \N{ZERO WIDTH NO-BREAK SPACE}", "feff"),
    ],
)
def test_what_a_standard_refuses_is_told_with_its_reason_and_made(text: str, reason: str) -> None:
    with pytest.warns(typst_compiler.StandardWarning) as warned:
        pdf = typst_compiler.compile(DATED + text)
    (warning,) = (one.message for one in warned)
    assert reason in str(warning)
    assert "PDF/UA-1, PDF/A-2a" in str(warning)
    assert tags.read(pdf).standards == ("", "")


def test_standards_that_contradict_each_other_are_told() -> None:
    with pytest.warns(typst_compiler.StandardWarning, match="PDF/A-4 and PDF/UA-1 are mutually incompatible"):
        typst_compiler.compile(f"{DATED}= A", standards=("a-4", "ua-1"))


def test_what_is_wrong_with_a_source_stays_an_error() -> None:
    with pytest.raises(TypesetterError, match="unknown variable: nothing"):
        typst_compiler.compile("#nothing")


def refused(_: int) -> bytes:
    return typst_compiler.compile(f"{DATED}= A\n=== B")


@proof
def test_it_is_told_from_the_process_of_a_school_too() -> None:
    with pytest.warns(typst_compiler.StandardWarning, match="skipped from heading level"):
        assert call_within(TEMPLATES, refused, 0).startswith(b"%PDF-")
