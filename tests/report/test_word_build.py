"""The Word file as a format of a report and a product of a batch: asked for by name, the same beside any others."""

from __future__ import annotations

import io
from itertools import combinations
from pathlib import Path

import pytest

from reportgen import api
from reportgen.classes.batch_run import Order, run_batch
from tests.lanes import matrix
from tests.report import built
from tests.writers.word_file import W, WordFile

EXERCISE = built.ROOT / "assignments" / "plane-motion" / "01.yaml"
COMBINED = [",".join(("docx", *others)) for count in range(3) for others in combinations(("pdf", "html"), count)]


@pytest.mark.parametrize("formats", matrix(COMBINED, COMBINED[-1:]))
def test_it_does_not_depend_on_other_formats(tmp_path: Path, formats: str) -> None:
    paths = api.build_each(EXERCISE, tmp_path, "typst", None, False, formats.split(",")).paths
    assert [path.name for path in paths] == [f"report.{name}" for name in formats.split(",")]
    shown = {path.name for path in (tmp_path / "01").iterdir() if not path.name.startswith(".")}
    assert shown == {path.name for path in paths}
    alone = api.word_files(EXERCISE, "latex", None)["report.docx"]
    assert paths[0].read_bytes() == alone


def test_a_file_that_a_student_writes_on_in_stays_when_the_pdf_is_made_anew(tmp_path: Path) -> None:
    (path,) = api.build_each(EXERCISE, tmp_path, "typst", None, False, ("docx",)).paths
    path.write_bytes(b"edited")
    api.build_each(EXERCISE, tmp_path, "typst", None, False, ("pdf",))
    assert path.read_bytes() == b"edited"


def test_a_batch_makes_it(tmp_path: Path) -> None:
    (tmp_path / "roster.csv").write_text("id,name\n01,A B\n", encoding="utf-8")
    order = Order(
        tmp_path / "roster.csv", assignments=EXERCISE.parent, out=tmp_path / "out", products=("docx",), jobs=1
    )
    result = run_batch(order, io.StringIO())
    assert (result.made, result.failures) == (1, [])
    (path,) = (tmp_path / "out").rglob("report.docx")
    assert path.read_bytes() == api.word_files(EXERCISE, "typst", None)["report.docx"]


@pytest.mark.parametrize(
    ("given", "size"), [("", "26"), ("\nreport: {size: 12 pt}\n", "24"), ("\nreport: {font: Arial}\n", "26")]
)
def test_the_letter_is_that_of_the_file(tmp_path: Path, given: str, size: str) -> None:
    """Without one it is 13 in Vietnamese; a font is taken by its name, since the reader's Word has it or has not."""
    path = tmp_path / "mine.yaml"
    path.write_text(EXERCISE.read_text(encoding="utf-8") + given, encoding="utf-8")
    styles = WordFile(api.word_files(path, "typst", None)["report.docx"]).xml("word/styles.xml")
    normal = next(one for one in styles.iter(f"{W}style") if one.get(f"{W}styleId") == "Normal")
    fonts, points = (normal.find(f"{W}rPr/{W}{name}") for name in ("rFonts", "sz"))
    assert fonts is not None
    assert points is not None
    assert points.get(f"{W}val") == size
    assert fonts.get(f"{W}ascii") == ("Arial" if "Arial" in given else "Times New Roman")
