"""All PDFs of a class in one: every page of each student, in the order of the class, behind a bookmark."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.errors import TypesetterError
from reportgen.classes.one_pdf import bind_feedback, bind_products
from reportgen.writers import typst_compiler
from reportgen.writers.bound_pdf import page_count
from tests.report.built import needs_tex

pymupdf = pytest.importorskip("pymupdf")


def pdf(text: str, pages: int) -> bytes:
    source = "#pagebreak()".join(f"{text} page {number}" for number in range(1, pages + 1))
    return typst_compiler.compile(f"#set page(width: 100mm, height: 60mm)\n{source}", standards=())


def put(folder: Path, files: dict[str, bytes]) -> None:
    folder.mkdir(parents=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


def test_the_pdfs_of_a_class_are_bound_in_its_order(tmp_path: Path) -> None:
    put(tmp_path / "K2", {"task.pdf": pdf("K2 task", 2), "key.pdf": pdf("K2 key", 1)})
    put(tmp_path / "K1", {"task.pdf": pdf("K1 task", 1), "sheet-10.pdf": pdf("ten", 1), "sheet-2.pdf": pdf("two", 1)})
    students = [("K2", "K2 Nguyễn Văn “An” #b"), ("K1", "K1"), ("K9", "who has none")]
    made = list(bind_products(tmp_path, students, ("task", "report", "key", "sheet", "page")))
    assert [path.name for path in made] == ["tasks.pdf", "keys.pdf", "sheets.pdf"]
    with pymupdf.open(made[0]) as bound:
        texts = [page.get_text().strip() for page in bound]
        assert texts == ["K2 task page 1", "K2 task page 2", "K1 task page 1"]
        assert [(title, page) for _, title, page in bound.get_toc()] == [("K2 Nguyễn Văn “An” #b", 1), ("K1", 3)]
        width, height = bound[0].rect.width, bound[0].rect.height
        assert (width, height) == pytest.approx((100 * 72 / 25.4, 60 * 72 / 25.4), abs=0.01)
    with pymupdf.open(made[2]) as bound:
        assert [page.get_text().split()[0] for page in bound] == ["two", "ten"]


def test_feedback_is_bound_and_a_class_without_any_has_none(tmp_path: Path) -> None:
    assert list(bind_feedback(tmp_path, [("K1", "K1")])) == []
    put(tmp_path / "K1", {"feedback.pdf": pdf("K1", 3)})
    (made,) = bind_feedback(tmp_path, [("K1", "K1")])
    assert (made.name, page_count(made.read_bytes())) == ("feedback.pdf", 3)


@pytest.mark.parametrize("pages", [1, 30, 40])
def test_pages_are_counted_as_a_reader_of_pdf_counts_them(pages: int) -> None:
    data = pdf("x", pages)
    with pymupdf.open(stream=data, filetype="pdf") as document:
        assert page_count(data) == len(document) == pages
        # Written by another program, without packed objects.
        assert page_count(document.tobytes(use_objstms=0)) == pages


@needs_tex
def test_pages_of_latex_are_counted(tmp_path: Path) -> None:
    from reportgen.writers import pdflatex

    source = "\\documentclass{article}\\begin{document}a\\newpage b\\newpage c\\end{document}"
    assert page_count(pdflatex.compile(source).pdf) == 3


def test_what_is_no_pdf_is_refused() -> None:
    with pytest.raises(TypesetterError):
        page_count(b"%PDF-1.7 nothing")
