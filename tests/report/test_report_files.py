"""Every assignment file end to end: the PDF as a reader holds it."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.provenance import RECORD
from reportgen.base.records import replace
from reportgen.document import Contents, Section, plain
from tests.lanes import matrix, proof
from tests.report import built, pages
from tests.report.built import Report
from tests.report.pages import Glyph, Page, squash

pymupdf = pytest.importorskip("pymupdf")


def test_a_report_of_the_engine_has_forty_to_fifty_five_pages(report: Report) -> None:
    if report.written.case.assignment.kind != "engine-twin":
        pytest.skip("the number of pages is given for the engine only")
    assert 40 <= len(report.pages) <= 55


def test_no_page_is_empty(report: Report) -> None:
    for page in report.pages:
        assert page.body or page.drawings, page.number + 1


def headings(report: Report) -> list[tuple[str, int]]:
    """(number and title, page) of each heading of the contents, found where it stands in bold print."""
    sections = [
        squash(f"{block.number}{plain(block.title, report.language)}")
        for block in report.document.blocks
        if isinstance(block, Section) and block.level <= 3
    ]
    printed = [pages.text(glyph for glyph in found if glyph.bold) for found in without_contents(report)]
    found: list[tuple[str, int]] = []
    at = 0
    for title in sections:
        at = next(page for page in range(at, len(printed)) if title in printed[page])
        found.append((title, at + 1))
    return found


def contents(report: Report) -> dict[int, list[Glyph]]:
    """The glyphs of the contents by the index of their page: from the title down to the last line that ends an entry.

    Short contents share their page with what follows them.
    """
    (title,) = (block.title for block in report.document.blocks if isinstance(block, Contents))
    start = next(index for index, found in enumerate(report.bodies) if pages.text(found).startswith(squash(title)))
    found: dict[int, list[Glyph]] = {}
    for index, body in enumerate(report.bodies[start:], start):
        lines: dict[int, list[Glyph]] = {}
        for glyph in body:
            lines.setdefault(round(glyph.origin[1]), []).append(glyph)
        ends = [base for base, line in lines.items() if re.search(r"\.{5}\d+$", pages.text(line))]
        if not ends:
            break
        found[index] = [glyph for glyph in body if glyph.origin[1] < max(ends) + 1]
    return found


def without_contents(report: Report) -> list[list[Glyph]]:
    """The glyphs of each page's body that are none of the contents."""
    own = {id(glyph) for found in contents(report).values() for glyph in found}
    return [[glyph for glyph in found if id(glyph) not in own] for found in report.bodies]


def test_contents_tell_the_page_on_which_each_heading_stands(report: Report) -> None:
    (title,) = (block.title for block in report.document.blocks if isinstance(block, Contents))
    printed = "".join(map(pages.text, contents(report).values()))
    entries = (re.escape(heading) + r"\.*" + str(page) for heading, page in headings(report))
    assert re.fullmatch(re.escape(squash(title)) + "".join(entries), printed)


def test_pages_are_numbered_as_they_lie(report: Report) -> None:
    word = squash(report.document.words.page)
    for page in report.pages[1:]:
        foot = pages.text(glyph for glyph in page.glyphs if glyph.origin[1] > page.rect.height - 17 * pages.MM)
        assert foot.endswith(f"{word}{page.number + 1}")


def test_no_glyph_stands_outside_the_margins(report: Report) -> None:
    assert [fault for page in report.pages[1:] for fault in pages.outside(page, pages.BEARING)] == []


def test_no_words_intersect(report: Report) -> None:
    assert [fault for page in report.pages for fault in pages.overlaps(page, pages.INK)] == []


def test_intersecting_words_are_seen() -> None:
    """The measure itself: two words set half a letter apart are told, side by side they are not."""
    sheet = pymupdf.open().new_page()
    sheet.insert_text((100, 100), "mm")
    sheet.insert_text((125, 100), "nn")
    assert pages.overlaps(Page(sheet), pages.INK) == []
    sheet.insert_text((103, 103), "kk")
    assert pages.overlaps(Page(sheet), pages.INK) != []


@pytest.mark.parametrize(
    ("right", "down", "size", "may"),
    [(5.4, 2.5, 7, True), (4, 2.5, 7, False), (5.4, 0, 7, False), (5.4, 2.5, 10, False)],
)
def test_an_index_may_begin_under_the_overhang_of_its_letter(right: float, down: float, size: float, may: bool) -> None:
    """Below the line only, and a little: an italic P in 10 points is 6.4 wide.  So it is in turned text."""
    letter = Glyph("P", (0, -6.8, 6.4, 0), 10, (0, 0), False, True, 1)
    index = Glyph("b", (right, down - 4.9, right + 3.9, down + 0.1), size, (right, down), False, False, 2)
    assert pages.tucked(letter, index) is may
    turned = replace(letter, box=(-6.8, -6.4, 0, 0), along=-1j)
    assert pages.tucked(turned, replace(index, origin=(down, -right))) is may


def test_no_box_is_overfull(report: Report) -> None:
    assert report.overfull == ()


IN_TURN = cycle(built.ENGINES if shutil.which("pdflatex") else ("typst",))


@proof
@pytest.mark.parametrize(
    ("path", "engine"), list(zip(built.SIBLINGS, IN_TURN, strict=False)), ids=[path.stem for path in built.SIBLINGS]
)
def test_further_files_of_a_kind_keep_their_pages_in_order(path: Path, engine: api.Engine) -> None:
    """By the writers in turn, in the file's own language: margins, intersecting words, overfull boxes."""
    report = built.report(path, engine, built.own_language(path))
    assert report.overfull == ()
    for page in report.pages[1:]:
        assert [*pages.outside(page, pages.BEARING), *pages.overlaps(page, pages.INK)] == []


# --- from a shell ---------------------------------------------------------------------------------


def compiled_as_it_stands(source: Path, engine: api.Engine) -> bytes:
    """The PDF that a user's own typesetter makes of a kept source, alone in its folder."""
    if engine == "typst":
        import typst

        return bytes(typst.compile(str(source)))
    for _ in range(3):
        subprocess.run(
            ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", source.name],
            cwd=source.parent,
            check=True,
            stdout=subprocess.DEVNULL,
            timeout=120,
        )
    return source.with_suffix(".pdf").read_bytes()


def text_of(pdf: bytes) -> list[Any]:
    return [page.get_text() for page in pymupdf.open(stream=pdf, filetype="pdf")]


COLD = matrix(
    [
        pytest.param(path, engine, marks=built.MARKS[engine], id=f"{path.stem}-{engine}")
        for path, engines in ((built.SAMPLE, built.ENGINES), (built.SLIDE, ("typst",)))
        for engine in engines
    ],
    telling=[(built.SLIDE, "typst")],
)
"""The sample by both writers, and a machine of the user's own: a new process takes seconds."""


@proof
@pytest.mark.parametrize(("path", "engine"), COLD)
def test_a_new_process_gives_the_same_bytes_and_a_source_that_compiles(
    path: Path, engine: api.Engine, tmp_path: Path
) -> None:
    command = [sys.executable, "-m", "reportgen.cli", "build", str(path), "--out", str(tmp_path)]
    command += ["--engine", engine, "--keep-source"]
    done = subprocess.run(command, cwd=built.ROOT, check=True, capture_output=True, text=True, timeout=300)
    folder = tmp_path / path.stem
    assert done.stdout.splitlines() == [str(folder / "report.pdf")]
    kept, record = folder / f"report{api.SUFFIX[engine]}", folder / RECORD
    assert set(folder.iterdir()) == {folder / "report.pdf", kept, record}
    pdf = (folder / "report.pdf").read_bytes()
    report = built.report(path, engine, built.own_language(path))
    assert pdf == report.pdf
    alone = tmp_path / "alone"
    alone.mkdir()
    assert text_of(compiled_as_it_stands(kept.rename(alone / kept.name), engine)) == text_of(pdf)
