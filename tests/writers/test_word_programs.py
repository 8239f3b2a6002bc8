"""What other programs make of the Word file: python-docx reads it, LibreOffice lays it out."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from reportgen.document import Cell, Section, Table, plain
from reportgen.writers import picture_files as drawn
from reportgen.writers import word
from tests.lanes import matrix, proof
from tests.report import built
from tests.writers import sample
from tests.writers.pages import MM, opened
from tests.writers.word_file import letters_of, squash

needs_office = pytest.mark.skipif(shutil.which("soffice") is None, reason="LibreOffice Writer is not installed")
CRANK = built.ROOT / "assignments" / "slider-crank-01.yaml"
PAGES = 0.15
"""By so much the pages of LibreOffice may differ from ours: figures do not float there, and type is larger."""
LARGEST = 4_000_000
"""Bytes of a report that mails take without a word."""
RULER = 0.2
"""What is seen of a ruler laid on a printed figure (mm)."""


def has_times() -> bool:
    """Whether there is a font whose letters are as wide as those of Times New Roman."""
    if shutil.which("fc-match") is None:
        return False
    found = subprocess.run(["fc-match", "Times New Roman"], capture_output=True, text=True, check=False).stdout
    return any(name in found for name in ("Times New Roman", "Liberation Serif", "Tinos", "Termes"))


def written(folder: Path, document: Any, language: Any) -> Path:
    path = folder / "report.docx"
    path.write_bytes(word.write(document, lambda scenes: drawn.for_word(scenes, language)))
    return path


# --- python-docx ----------------------------------------------------------------------------------


@pytest.mark.parametrize("file", matrix([built.SAMPLE, CRANK], [CRANK]), ids=lambda file: file.stem)
def test_python_docx_finds_headings_and_tables(tmp_path: Path, file: Path) -> None:
    docx = pytest.importorskip("docx")
    document = built.written(file, "en").document
    path = written(tmp_path, document, "en")
    assert path.stat().st_size < LARGEST
    read = docx.Document(str(path))
    headings = [(one.style.name, squash(letters_of(one._p))) for one in read.paragraphs if one.style.name[:3] == "Hea"]
    assert headings == [
        (f"Heading {block.level}", squash(plain(block.title, "en")).replace("_", ""))
        for block in document.blocks
        if isinstance(block, Section) and block.level <= 3
    ]
    tables = [one for one in read.tables if one.style.name == "Report Table"]
    ours = [one for one in document.blocks if isinstance(one, Table)]
    assert len(ours) > 10
    for table, block in zip(tables, ours, strict=True):
        for row, cells in zip(table.rows, (*block.head, *block.rows), strict=True):
            shown = [squash(letters_of(cell._tc)) for cell in row.cells]
            assert bare(shown) == bare(list(spread(cells)))
    assert read.core_properties.title == document.title


def spread(cells: tuple[Cell, ...]) -> Iterator[str]:
    """The text of cells in each column that they cover."""
    for cell in cells:
        yield from [squash(plain(cell.inlines, "en"))] * cell.span


def bare(texts: list[str]) -> list[str]:
    """Texts without what the plain notation of a formula has beside its letters."""
    return [re.sub(r"[_^()|/√]", "", text) for text in texts]


# --- LibreOffice ----------------------------------------------------------------------------------


def laid_out(path: Path) -> Any:
    """The open PDF that LibreOffice makes of a file."""
    home = {**os.environ, "HOME": str(path.parent)}
    command = ["soffice", "--headless", "--convert-to", "pdf", "--outdir", str(path.parent), str(path)]
    done = subprocess.run(command, env=home, capture_output=True, text=True, timeout=300, check=True)
    pdf = path.with_suffix(".pdf")
    assert pdf.exists(), done.stderr
    return opened(pdf.read_bytes())


def figures(pdf: Any) -> list[tuple[float, float]]:
    """Width and height of the pictures on the pages (mm), in order."""
    return [
        ((box[2] - box[0]) / MM, (box[3] - box[1]) / MM)
        for page in pdf
        for box in sorted((one["bbox"] for one in page.get_image_info()), key=lambda box: (round(box[3]), box[0]))
    ]


@pytest.mark.proof
@needs_office
def test_libreoffice_opens_it_with_figures_true_to_scale(tmp_path: Path) -> None:
    made = sample.sample()
    pdf = laid_out(written(tmp_path, made, "vi"))
    text = "".join(page.get_text() for page in pdf)
    # What LibreOffice cannot read of a formula it marks so.
    assert "¿" not in text
    assert "Error" not in text
    scenes = [scene for _, scene in built.scenes(made)]
    sizes = figures(pdf)
    assert len(sizes) == len(scenes)
    for size in sorted((scene.width, scene.height) for scene in scenes):
        assert any(size == pytest.approx(found, abs=RULER) for found in sizes), size


@proof
@needs_office
@pytest.mark.skipif(not has_times(), reason="no font is as wide as Times New Roman")
@pytest.mark.parametrize("language", built.LANGUAGES)
def test_the_sample_has_about_as_many_pages_as_the_pdf(tmp_path: Path, language: Any) -> None:
    document = built.written(built.SAMPLE, language).document
    pdf = laid_out(written(tmp_path, document, language))
    ours = built.report(built.SAMPLE, "typst", language)
    assert len(pdf) == pytest.approx(len(ours.pages), rel=PAGES)
    assert "¿" not in "".join(page.get_text() for page in pdf)
    scenes = [(scene.width, scene.height) for _, scene in built.scenes(document)]
    found = figures(pdf)
    assert len(found) == len(scenes)
    for size, shown in zip(scenes, found, strict=True):
        assert shown == pytest.approx(size, abs=RULER)
