"""Reports in Chinese: the numbers of those in Vietnamese, the marks of Chinese, letters that are on the page."""

from __future__ import annotations

import io
import re
import zipfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.errors import AssignmentError
from reportgen.base.records import field_names
from reportgen.document import Document, text_of
from reportgen.formula import Number
from reportgen.writers import typst_fonts
from tests.lanes import matrix
from tests.report import built

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
CORE = [ASSIGNMENTS / name for name in ("shaper-01.yaml", "slider-crank-01.yaml", "plane-motion/18.yaml")]
OTHERS = [ASSIGNMENTS / name for name in ("four-bar-01.yaml", "engine-twin-05.yaml", "shaper-02.yaml")]
HAN = "\u4e00-\u9fff"
NARROW_MARKS = re.compile(f"[{HAN}][,;:?!]|[{HAN}]\\.(?= |$)|[{HAN}] [{HAN}]|[{HAN}] ?\\((?![\\d.]+\\))", re.MULTILINE)
MM = 72 / 25.4


def document(path: Path, language: str) -> Document:
    return built.document(path, language)  # type: ignore[arg-type]


def numbers(part: Any) -> Iterator[str]:
    """All numbers of a tree, as they are rounded, wherever they stand in it."""
    if isinstance(part, Number):
        yield f"{part.value:.{part.decimals}f}" if part.decimals is not None else f"{part.value!r}"
    elif isinstance(part, tuple):
        for one in part:
            yield from numbers(one)
    else:
        for name in field_names(type(part)):
            yield from numbers(getattr(part, name))


@pytest.mark.parametrize("path", matrix([*CORE, *OTHERS], CORE[:1]), ids=lambda path: path.stem)
def test_every_number_is_that_of_the_report_in_vietnamese(path: Path) -> None:
    chinese, vietnamese = (Counter(numbers(document(path, language).blocks)) for language in ("zh", "vi"))
    # A sentence may tell a number that the other leaves to the table or the figure, none may tell another one.
    assert set(chinese) == set(vietnamese)
    apart = sum(((chinese - vietnamese) + (vietnamese - chinese)).values())
    assert apart <= 0.01 * sum(vietnamese.values())


@pytest.mark.parametrize("path", matrix([*CORE, *OTHERS], CORE), ids=lambda path: path.stem)
def test_marks_are_those_of_chinese_and_no_word_is_of_another_language(path: Path) -> None:
    lines = text_of(document(path, "zh")).splitlines()
    # What is known of the vectors of an equation stands in a table, which plain text alone writes as lines.
    text = "\n".join(line for line in lines if not re.match("(方向|指向|大小):", line))
    assert not NARROW_MARKS.findall(text)
    words = {one for one in re.findall(r"(?<![\w.])[A-Za-zÀ-ỹ]{4,}(?![\w.])", text) if not one.isupper()}
    assert words - {"arcsin", "arccos", "arctan"} <= set(re.findall(r"\w+", path.read_text(encoding="utf-8")))


def test_without_a_font_the_language_is_what_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(typst_fonts, "families", lambda system=True: ["New Computer Modern"])
    file = tmp_path / "a.yaml"
    text = CORE[0].read_text(encoding="utf-8").replace("language: vi", "language: zh")
    file.write_text(text, encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        api.build(file, tmp_path / "out")
    (problem,) = caught.value.problems
    assert (problem.code, problem.location.line) == ("no-letters", text[: text.index("language:")].count("\n") + 1)
    assert "reportgen[zh]" in str(problem)


def test_no_other_language_asks_for_fonts(monkeypatch: pytest.MonkeyPatch) -> None:
    def asked(system: bool = True) -> list[str]:
        raise AssertionError("fonts are asked for")

    monkeypatch.setattr(typst_fonts, "families", asked)
    for language in ("vi", "en"):
        api.letter_of(api.load(CORE[0], language), "typst")


def test_a_page_names_fonts_and_brings_none(tmp_path: Path) -> None:
    page = api.build(CORE[2], tmp_path, language="zh", formats=("html",)).read_text(encoding="utf-8")
    assert '<html lang="zh' in page
    assert "SimSun" in page
    assert "@font-face" not in page


needs_letters = pytest.mark.skipif(not typst_fonts.added(), reason="the extra zh is not installed")


@needs_letters
@pytest.mark.parametrize("path", matrix(CORE, CORE[2:]), ids=lambda path: path.stem)
def test_pages_have_every_letter_within_their_margins(path: Path, tmp_path: Path, recwarn: Any) -> None:
    pymupdf = pytest.importorskip("pymupdf")
    pdf = api.build(path, tmp_path, language="zh")
    assert not [one for one in recwarn if isinstance(one.message, typst_fonts.MissingLettersWarning)]
    written = text_of(document(path, "zh"))
    with pymupdf.open(pdf) as pages:
        shown = "".join(page.get_text() for page in pages)
        # A mark at the end of a line takes half of its width: its ink is in the other half.
        ends = [
            (word[2], page.rect.width, word[4].rstrip("，。：；、）”"))
            for page in pages
            if page.number and page.rect.width < 596
            for word in page.get_text("words")
        ]
    assert set(re.findall(f"[{HAN}]", written)) <= set(shown)
    assert not [one for right, width, one in ends if right > width - 20 * MM + 3 + 12 or not right]
    line = next(one for one in written.splitlines() if len(re.findall(f"[{HAN}]", one)) > 30)
    letters = "".join(re.findall(f"[{HAN}]", line))
    assert letters in "".join(re.findall(f"[{HAN}]", shown)), "text is read back in order"


@needs_letters
def test_a_word_file_names_the_font_of_chinese(tmp_path: Path) -> None:
    data = api.build(CORE[2], tmp_path, language="zh", formats=("docx",)).read_bytes()
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        styles = package.read("word/styles.xml").decode()
    assert 'w:eastAsia="SimSun"' in styles
    assert 'w:eastAsia="zh-CN"' in styles
