"""Letters of other scripts: the system's fonts where they have them, a warning where none has."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.pdf_standards import STANDARDS, titled
from reportgen.writers import typst_compiler
from reportgen.writers.typst_fonts import MissingLettersWarning, added, lacking, sought, uncommon
from tests.commands import reportgen

VIETNAMESE = "Nguyễn Thị Ánh Tuyết, lớp 59CĐT – μ_v = 0,2189 m/(s·mm), ⊥ O₁A ∥ x, Щукин"
RARE = "\U00012000\U00014400\U00017000\U0001b170\U0001d800\U00016800\U00011a00\U000118a0"
"""Cuneiform, Anatolian hieroglyphs, Tangut, Nushu, sign writing and others: no system has fonts for all of them."""


def nowhere() -> str:
    found = lacking(RARE, system=True)
    if not found:
        pytest.skip("this system has a font for every script")
    return found


def test_what_the_fonts_are_made_for_is_never_asked_for() -> None:
    assert uncommon(VIETNAMESE) == ""
    assert uncommon("王小明 and ไทย, 王\u200f") == "王小明ไทย"


def test_its_own_fonts_have_latin_and_no_chinese() -> None:
    assert lacking("aệΩЩ∥", system=False) == ""
    assert lacking("a王Ω小", system=False) == "王小"


def test_letters_that_no_font_has_are_named() -> None:
    missing = nowhere()
    with pytest.warns(MissingLettersWarning) as told:
        typst_compiler.compile(f"A {missing} B", standards=())
    assert told[0].message.letters == missing


def test_a_text_in_the_usual_letters_is_set_with_the_fonts_it_brings() -> None:
    assert sought(VIETNAMESE) == ((), False, "")


def test_the_fonts_of_the_extra_go_before_those_of_the_system() -> None:
    if not added():
        pytest.skip("the extra zh is not installed")
    assert sought("王小明：机构运动简图") == (added(), False, "")


def test_what_the_system_has_is_printed() -> None:
    pymupdf = pytest.importorskip("pymupdf")
    wanted = lacking("ไทย王小日本語한국ພາສາ", system=False)
    there = [letter for letter in wanted if letter not in lacking(wanted, system=True)]
    if not there:
        pytest.skip("this system has no further fonts")
    pdf = typst_compiler.compile(f'#set text(font: "New Computer Modern")\n{"".join(there)}', standards=())
    printed = pymupdf.open(stream=pdf, filetype="pdf")[0].get_text()
    assert set(there) <= set(printed)


def test_the_command_line_says_it_in_one_line(tmp_path: Path) -> None:
    missing = nowhere()[0]
    file = tmp_path / "a.yaml"
    text = Path("assignments/slotted-lever-01.yaml").read_text(encoding="utf-8")
    file.write_text(text.replace("course: Nguyên lý máy", f"course: X {missing} Y"), encoding="utf-8")
    done = reportgen("build", file, "--out", tmp_path / "out")
    assert done.returncode == 0
    (line,) = done.stderr.splitlines()
    assert missing in line
    assert titled(STANDARDS) in line
